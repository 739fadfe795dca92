"""Points of paint."""

from ..algorithm import Algorithm
from ..parameters import ParameterSpec, SettingSpec
from ..survey_input import bright_road_points_of, frame_of
from ..texts import tr

EXTRACTION = "core.markings.paint.settings:MarkingSettings"

METHOD = ParameterSpec(
    "choice", "METHOD", tr("Method"),
    tr("multi-threshold sets a threshold for every strip along the road on the intensity image: the one to map with. The other two are published "
       "methods to compare with. intensity-peaks looks for narrow peaks in profiles across the road and finds lines only; point-segments sets "
       "thresholds on the points and keeps the dense ones. Neither tells concrete gutters from paint."),
    default="multi-threshold", choices=("multi-threshold", "intensity-peaks", "point-segments"))

MARKING_SETTINGS = (
    SettingSpec("SEPARATION", EXTRACTION, "separation", tr("Multi-threshold: least distance of paint from asphalt (σ)"),
                tr("How many spreads of asphalt the paint of a strip must lie above it before the strip counts as painted. Lower finds fainter "
                   "paint, but also gutters, patches and noise."), advanced=True),
)


def marking_settings(call):
    """MarkingSettings with the method that the user chose."""
    from ...products.published_markings import METHODS

    return call.settings(MARKING_SETTINGS, method=METHODS[call.value("METHOD")])


class ExtractMarkings(Algorithm):
    ID, TITLE, GROUP = "extractmarkings", "Extract markings", "Markings"
    SUMMARY = "Separates paint from asphalt by intensity and keeps the points of the paint."
    TAGS = ("road marking", "lane marking", "paint", "threshold", "otsu", "intensity peak", "density")
    RETIRED = ("SHORTEST_PAINT", "CLOSE", "PROFILE_LENGTH", "PROMINENCE", "NARROWEST", "WIDEST", "JUMP", "PEAK_GAP", "SHORTEST_LINE",
               "SEGMENT_LENGTH", "SEGMENT_WIDTH", "SEGMENT_SEPARATION", "NEIGHBOUR_RADIUS")

    def declare(self):
        self.add_input("cloud", "ROAD_POINTS", tr("Road points"), tr("The file that the intensity image was made from."))
        self.add_input("raster", "INTENSITY_IMAGE", tr("Intensity image"), tr("The GeoTIFF written by Intensity image."))
        self.add_trajectory()
        self.add(METHOD)
        self.add_settings(MARKING_SETTINGS)
        self.add_output("cloud", "MARKING_POINTS", tr("Marking points"))
        self.add_output("raster", "MARKING_MASK", tr("Marking mask"), tr("1 where a pixel is paint, 0 where it is not."), optional=True,
                        by_default=False)

    def work(self, call, progress):
        from ...core.intensity.image import check_image_shows
        from ...core.io.geotiff import IntensityImage
        from ...core.markings.paint.extract import extract_markings
        from ...core.survey.road_points_las import write_road_points

        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, road_points.crs, progress, road_points)
        image = IntensityImage.open(call.raster("INTENSITY_IMAGE"))
        check_image_shows(image, road_points)
        markings = extract_markings(
            road_points, image, frame, marking_settings(call), progress.part(0.2, 0.95), mask_path=call.new_file("MARKING_MASK") or None)
        write_road_points(markings, call.new_file("MARKING_POINTS"), progress.part(0.95, 1.0))
