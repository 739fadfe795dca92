"""The geo-referenced intensity image."""

from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import bright_road_points_of
from ..texts import tr

IMAGE = "core.intensity.image:ImageSettings"

IMAGE_SETTINGS = (
    SettingSpec("CELL_SIZE", IMAGE, "cell_size", tr("Cell size (m)"),
                tr("Smaller shows narrow lines more sharply while the cloud is dense enough; larger fills gaps and makes smaller files.")),
)


class IntensityImage(Algorithm):
    ID, TITLE, GROUP = "intensityimage", "Intensity image", "Markings"
    SUMMARY = "Interpolates the intensity of road points into a GeoTIFF: near and bright points count more."
    TAGS = ("intensity", "image", "raster", "orthophoto")
    RETIRED = ("POWER", "BETA", "RADIUS_CELLS")

    def declare(self):
        self.add_input("cloud", "ROAD_POINTS", tr("Road points"),
                       tr("The file written by Correct intensity, or by Extract road surface for the raw intensity."))
        self.add_settings(IMAGE_SETTINGS)
        self.add_output("raster", "INTENSITY_IMAGE", tr("Intensity image"))
        self.add_output("raster", "DISPLAY_IMAGE", tr("Intensity image, 8 bit"),
                        tr("The same for viewing: stretched to 256 grey values, for programs that show no floating-point images."), optional=True,
                        by_default=False)

    def work(self, call, progress):
        from ...core.intensity.image import write_intensity_image
        from ...core.io.geotiff import write_display_image

        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        path = call.new_file("INTENSITY_IMAGE")
        write_intensity_image(road_points, path, call.settings(IMAGE_SETTINGS), progress.part(0.2, 0.9))
        if call.wants("DISPLAY_IMAGE"):
            write_display_image(path, call.new_file("DISPLAY_IMAGE"), progress.part(0.9, 1.0))
