"""Points of paint."""

from ..algorithm import Algorithm
from ..parameters import ChoiceSpec, SettingSpec
from ..survey_input import bright_road_points_of, frame_of
from ..texts import tr

EXTRACTION = "core.markings.paint.settings:MarkingSettings"
PEAKS = "products.published_markings:IntensityPeaks"
SEGMENTS = "products.published_markings:PointSegments"

METHOD = ChoiceSpec(
    "METHOD", tr("Method"),
    tr("multi-threshold sets a threshold for every strip along the road on the intensity image: the one to map with. The "
       "other two are published methods to compare with. intensity-peaks looks for narrow peaks in profiles across the "
       "road and finds lines only; point-segments sets thresholds on the points and keeps the dense ones. Neither "
       "tells concrete gutters from paint."),
    value="multi-threshold", choices=("multi-threshold", "intensity-peaks", "point-segments"),
)

MARKING_SETTINGS = (
    SettingSpec(
        "SEPARATION", EXTRACTION, "separation", tr("Multi-threshold: least distance of paint from asphalt (σ)"),
        tr("How many spreads of asphalt the paint of a strip must lie above it before the strip counts as painted. Lower "
           "finds fainter paint, but also gutters, patches and noise."),
        advanced=True,
    ),
    SettingSpec(
        "SHORTEST_PAINT", EXTRACTION, "shortest", tr("Multi-threshold: shortest run of paint along the road (m)"),
        tr("Longer removes specks, but also worn remains of dashes."), advanced=True,
    ),
    SettingSpec(
        "CLOSE", EXTRACTION, "close", tr("Multi-threshold: gap in paint closed along the road (m)"),
        tr("Longer joins worn paint, but also neighbouring bars and letters."), advanced=True,
    ),
)

PEAK_SETTINGS = (
    SettingSpec(
        "PROFILE_LENGTH", PEAKS, "profile_length", tr("Intensity peaks: length of a profile (m)"),
        tr("Longer holds more points and less noise, but blurs lines that are not parallel to the road. It should hold a "
           "scan line or two."), advanced=True,
    ),
    SettingSpec(
        "PROMINENCE", PEAKS, "prominence", tr("Intensity peaks: least prominence of a peak (MAD)"),
        tr("How far a peak must rise above both its feet, in median absolute deviations of its profile. Lower finds fainter "
           "and worn lines, but also seams and noise."), advanced=True,
    ),
    SettingSpec(
        "NARROWEST", PEAKS, "narrowest", tr("Intensity peaks: narrowest line (m)"),
        tr("Narrower peaks are no lines. Lower finds worn lines, but also cracks filled with light sealant."),
        advanced=True,
    ),
    SettingSpec(
        "WIDEST", PEAKS, "widest", tr("Intensity peaks: widest line (m)"),
        tr("Broader peaks are no lines. Higher finds broad lines and zebra bars, but also pale repairs and gutters."),
        advanced=True,
    ),
    SettingSpec(
        "JUMP", PEAKS, "jump", tr("Intensity peaks: shift between profiles (m)"),
        tr("How far across a peak may lie from the last one of its line. Larger follows slanting lines, but also joins "
           "what only happens to lie near."), advanced=True,
    ),
    SettingSpec(
        "PEAK_GAP", PEAKS, "gap", tr("Intensity peaks: gap along a line (m)"),
        tr("Longer follows worn lines, but also joins specks. At least the length of a profile."),
        advanced=True,
    ),
    SettingSpec(
        "SHORTEST_LINE", PEAKS, "shortest", tr("Intensity peaks: shortest line (m)"),
        tr("Longer removes specks, but also short and worn dashes."), advanced=True,
    ),
)

SEGMENT_SETTINGS = (
    SettingSpec(
        "SEGMENT_LENGTH", SEGMENTS, "length", tr("Point segments: length of a segment (m)"),
        tr("Longer holds more asphalt and steadies the threshold, but averages over patches and worn stretches."),
        advanced=True,
    ),
    SettingSpec(
        "SEGMENT_WIDTH", SEGMENTS, "width", tr("Point segments: width of a segment (m)"),
        tr("Narrower is scanned more alike, but may hold little asphalt beside the paint."),
        advanced=True,
    ),
    SettingSpec(
        "SEGMENT_SEPARATION", SEGMENTS, "separation", tr("Point segments: least distance of paint from asphalt (σ)"),
        tr("How many spreads of asphalt the bright points of a segment must lie above the rest before it counts as "
           "painted. Lower finds fainter paint, but takes patches and noise for it."), advanced=True,
    ),
    SettingSpec(
        "NEIGHBOUR_RADIUS", SEGMENTS, "radius", tr("Point segments: radius in which bright points are counted (m)"),
        tr("Larger suits sparse surveys; smaller keeps narrow paint beside asphalt."),
        advanced=True,
    ),
)


def marking_settings(call):
    """MarkingSettings with the method that the user chose and its own settings."""
    published = {"intensity-peaks": PEAK_SETTINGS, "point-segments": SEGMENT_SETTINGS}.get(call.choice("METHOD"))
    return call.settings(MARKING_SETTINGS, method=None if published is None else call.settings(published))


class ExtractMarkings(Algorithm):
    ID, TITLE, GROUP = "extractmarkings", "Extract markings", "Markings"
    SUMMARY = "Separates paint from asphalt by intensity and keeps the points of the paint."
    TAGS = ("road marking", "lane marking", "paint", "threshold", "otsu", "intensity peak", "density")

    def declare(self):
        self.add_cloud("ROAD_POINTS", tr("Road points"), tr("The file that the intensity image was made from."))
        self.add_layer_raster("INTENSITY_IMAGE", tr("Intensity image"), tr("The GeoTIFF written by Intensity image."))
        self.add_trajectory()
        self.add(METHOD)
        for specs in (MARKING_SETTINGS, PEAK_SETTINGS, SEGMENT_SETTINGS):
            self.add_settings(specs)
        self.add_laz("MARKING_POINTS", tr("Marking points"))
        self.add_raster(
            "MARKING_MASK", tr("Marking mask"), tr("1 where a pixel is paint, 0 where it is not."), optional=True, by_default=False
        )

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
            road_points, image, frame, marking_settings(call), progress.part(0.2, 0.95),
            mask_path=call.new_file("MARKING_MASK") or None,
        )
        write_road_points(markings, call.new_file("MARKING_POINTS"), progress.part(0.95, 1.0))
