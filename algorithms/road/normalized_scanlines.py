"""Normalized scanlines of a survey as a layer, and as evenly spaced points."""

from contextlib import nullcontext

from ...core.common.features import SCANLINES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import SURVEY_SETTINGS, add_execution, open_survey_of
from ..texts import tr

PLANES = "core.road.scanlines.section_planes:ScanlineSettings"

SCANLINE_SETTINGS = (
    SettingSpec("INTERVAL", PLANES, "interval", tr("Interval of section planes along the road (m)"),
                tr("Smaller gives more scanlines, and more of them than were measured where scan lines lie far apart; larger is quicker.")),
    SettingSpec("CORRIDOR", PLANES, "corridor", tr("Corridor either side of the road's reference line (m)"),
                tr("Wider reaches the far side of a broad avenue, but takes longer.")),
    SettingSpec("ROTATION_FREQUENCY", PLANES, "rotation_frequency", tr("Scan lines of each scanner, 0 = from the data (per second)"),
                tr("The data know it well. Give it where they are said to show no regular scan lines although the scanner has a rotating mirror; the "
                   "direction of rotation is found anyway."), advanced=True),
)
LAYER_SETTINGS = (
    SettingSpec("SIMPLIFY", "products.scanline_layer:ScanlineLayerSettings", "simplify", tr("Deviation allowed in thinning the scanlines (m)"),
                tr("Larger draws and writes faster and shows less of the surface; 0 keeps every vertex.")),
)
POINT_SETTINGS = (
    SettingSpec("RESAMPLED_SPACING", "products.scanline_layer:ResamplingSettings", "spacing", tr("Spacing of resampled points along a scanline (m)"),
                tr("Smaller gives more points, without more being known of the surface."), advanced=True),
)


class NormalizedScanlines(Algorithm):
    ID, TITLE, GROUP = "normalizedscanlines", "Normalized scanlines", "Road"
    SUMMARY = "Cuts the measured surface by planes across the road, one scanline for every plane, pass and scanner."
    HELP = ("The lines of a rotating scanner are distinguished by the times and places of the points alone; neighbouring lines make the "
            "surface that is cut. Where it is interrupted, behind a car say, a new scanline begins. Points without times, or of a "
            "head with many beams, have no such lines: there the points near each plane make the scanline, and the log says so.")
    TAGS = ("scanline", "profile", "cross section", "resample")

    def declare(self):
        self.add_survey()
        self.add_settings(SCANLINE_SETTINGS)
        self.add_settings(LAYER_SETTINGS)
        self.add_settings(POINT_SETTINGS)
        self.add_settings(SURVEY_SETTINGS, only=("SCANNER_FIELD", "TIME", "INTENSITY_FROM", "FIT_PASSES", "TRAJECTORY_SIGMA"))
        add_execution(self)
        self.add_sink("SCANLINES", tr("Normalized scanlines"),
                      tr("Lines with height (Z) and intensity (M)."), fields=SCANLINES, geometry="LineStringZM", optional=True)
        self.add_output("cloud", "RESAMPLED_POINTS", tr("Resampled points"), tr(
            "Points at equal steps along the scanlines, with intensity, station and offset: a cloud of even density."),
            optional=True, by_default=False)

    def work(self, call, progress):
        from ...products.scanline_layer import ResampledPoints, write_scanlines

        survey = open_survey_of(call, progress.part(0.0, 0.5))
        points = nullcontext()
        if call.wants("RESAMPLED_POINTS"):
            points = ResampledPoints(call.new_file("RESAMPLED_POINTS"), survey.frame.origin, survey.crs, call.settings(POINT_SETTINGS),
                                     survey.frame.farthest)
        layer = call.settings(LAYER_SETTINGS) if call.wants("SCANLINES") else None
        with points as opened:
            scanlines, _ = write_scanlines(survey, call.settings(SCANLINE_SETTINGS), layer, opened, progress.part(0.5, 1.0))
        call.layer("SCANLINES", scanlines)
