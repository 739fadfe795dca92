"""Curb points on profiles across the driven road."""

from ...core.common.features import CURB_POINTS
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import SURVEY_SETTINGS, open_survey_of
from ..texts import tr

CURBS = "core.road.profiles.detect:CurbSettings"

CURB_SETTINGS = (
    SettingSpec("BLOCK_LENGTH", CURBS, "block_length", tr("Block length along the road, 0 = automatic (m)"),
                tr("Automatic takes 0.5 m in sharp curves and up to 2 m on straights. Shorter follows a bend more closely but has fewer points to go "
                   "by.")),
    SettingSpec("PROFILE_WIDTH", CURBS, "profile_width", tr("Profile width along the road (m)"),
                tr("Wider finds curbs far from the scanner, where points are sparse, but blurs them in bends.")),
    SettingSpec("POINT_SPACING", CURBS, "point_spacing", tr("Cell across the road (m)"),
                tr("Finer places the curb more exactly; coarser fills gaps in sparse clouds, but misses low curbs."), advanced=True),
    SettingSpec("LAYER_JUMP", CURBS, "layer_jump", tr("Height gap between layers (m)"),
                tr("Points of a cell this far apart in height belong to different things: the road and a car above it. Smaller cuts the curb off "
                   "grass and cars, but also splits noisy ground."), advanced=True),
    SettingSpec("SLOPE", CURBS, "slope", tr("Smallest slope of the curb face, 0 = as the data allow (°)"),
                tr("As the data allow, faces of 60° count, and less steep ones, down to 25°, where they keep their line for 10 m. A number is your "
                   "own limit: lower accepts short bevelled and worn curbs, but also verges and ramps.")),
    SettingSpec("MIN_HEIGHT", CURBS, "min_height", tr("Minimum curb height, 0 = as the data allow (m)"),
                tr("As the data allow, curbs of 5 cm count, and lower ones, down to 2 cm, where they stand out from the noise and continue for 5 m. "
                   "With a noisy scanner, curbs dropped to 1 cm are followed from the end of a sure one. A number is your own limit: lower finds "
                   "dropped curbs at driveways, but also tar seams and gutters.")),
    SettingSpec("MAX_HEIGHT", CURBS, "max_height", tr("Maximum curb height (m)"), tr("Higher accepts platforms and low walls as the road's edge.")),
)


class DetectCurbs(Algorithm):
    ID, TITLE, GROUP = "detectcurbs", "Detect curbs", "Road"
    SUMMARY = "Finds the curb nearest to the driven track on each side, on profiles across the road."
    HELP = ("Where there is no curb none is made up; a curb hidden behind parked cars becomes a point of status occluded. The field "
            "kind tells the road's own curbs (main) from those of corners, side streets and islands, which are found in plan.")
    TAGS = ("curb", "kerb", "road edge")

    def declare(self):
        self.add_survey()
        self.add_settings(CURB_SETTINGS)
        self.add_settings(SURVEY_SETTINGS)
        self.add_sink("CURB_POINTS", tr("Curb points"), fields=CURB_POINTS, geometry="PointZ")
        self.add_sink("PRINCIPAL_POINTS", tr("Principal points"),
                      tr("The highest point of the lowest layer of every cell: what the curbs were looked for on."), geometry="PointZ", optional=True,
                      by_default=False)

    def work(self, call, progress):
        from ...core.road.profiles.detect import detect_curbs

        survey = open_survey_of(call, progress.part(0.0, 0.5))
        settings = call.settings(CURB_SETTINGS)
        if call.wants("PRINCIPAL_POINTS"):
            from ...core.road.profiles.detect import find_principal_points

            call.layer("PRINCIPAL_POINTS", find_principal_points(survey, settings, progress.part(0.5, 0.6)))
        points = detect_curbs(survey, settings, progress.part(0.6, 1.0))
        call.layer("CURB_POINTS", points.to_features(survey.frame))
