"""Points of paint."""

from ..algorithm import LanewrightAlgorithm
from ..knobs import Knob
from ..survey_input import bright_road_points_of, frame_of
from ..texts import tr

EXTRACTION = "markings.extraction:MarkingSettings"

MARKING_KNOBS = (
    Knob(
        "METHOD", EXTRACTION, "method", tr("Method"),
        tr("Multi-threshold sets a threshold for every strip along the road, so that paint far from the scanner is found too."),
        choices=("multi-threshold",),
    ),
    Knob(
        "SEPARATION", EXTRACTION, "separation", tr("Least distance of paint from asphalt (σ)"),
        tr("How many spreads of asphalt the paint of a strip must lie above it before the strip counts as painted. Lower "
           "finds fainter paint, but also gutters, patches and noise."),
        minimum=0.5, maximum=20.0, advanced=True,
    ),
    Knob(
        "SHORTEST_PAINT", EXTRACTION, "shortest", tr("Shortest run of paint along the road (m)"),
        tr("Longer removes specks, but also worn remains of dashes."), minimum=0.0, maximum=2.0, advanced=True,
    ),
    Knob(
        "CLOSE", EXTRACTION, "close", tr("Gap in paint closed along the road (m)"),
        tr("Longer joins worn paint, but also neighbouring bars and letters."), minimum=0.0, maximum=2.0, advanced=True,
    ),
)


class ExtractMarkings(LanewrightAlgorithm):
    ID, TITLE, ROOM = "extractmarkings", "Extract markings", "Markings"
    SUMMARY = "Tells paint from asphalt by thresholds of the intensity image and takes the points of it."
    TAGS = ("road marking", "threshold", "otsu")

    def initAlgorithm(self, configuration=None):
        self.add_cloud("ROAD_POINTS", tr("Road points"), tr("The file that the intensity image was made from."))
        self.add_layer_raster("INTENSITY_IMAGE", tr("Intensity image"), tr("The GeoTIFF written by Intensity image."))
        self.add_trajectory()
        self.add_knobs(MARKING_KNOBS)
        self.add_laz("MARKING_POINTS", tr("Marking points"))
        self.add_raster(
            "MARKING_MASK", tr("Marking mask"), tr("1 where a pixel is paint, 0 where it is not."), optional=True, by_default=False
        )

    def work(self, call, progress):
        from ...core.markings.extraction import extract_markings
        from ...core.markings.image import IntensityImage
        from ...core.markings.image_cover import check_image_shows
        from ...core.survey.road_points_file import write_road_points

        road_points = bright_road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, road_points.crs, progress, road_points)
        image = IntensityImage.open(call.raster("INTENSITY_IMAGE"))
        check_image_shows(image, road_points)
        markings = extract_markings(
            road_points, image, frame, call.settings(MARKING_KNOBS), progress.part(0.2, 0.95),
            mask_path=call.new_file("MARKING_MASK") or None,
        )
        write_road_points(markings, call.new_file("MARKING_POINTS"), progress.part(0.95, 1.0))
