"""Road edges from the point clouds in one step, by either method."""

from ...core.common.features import ROAD_EDGES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import SURVEY_SETTINGS, add_execution, open_survey_of
from ..texts import tr
from .boundaries_from_scanlines import BOUNDARY_SETTINGS
from .detect_curbs import CURB_SETTINGS
from .fit_road_edges import EDGE_SETTINGS

METHOD_SETTING = SettingSpec(
    "BOUNDARY_METHOD", "core.road.detect_boundaries:BoundarySettings", "method", tr("Boundary method"),
    tr("Profiles looks for the curb in slices across the road; scanlines meets the planes of road, curb face and sidewalk; both "
       "lets the two check each other: at every place the one that measures better is drawn, agree_cm says how far apart they are, "
       "and it takes as long as the two together."),
    choices=("profiles", "scanlines", "both"))
# Both methods ask for one least height
SCANLINE_METHOD_SETTINGS = tuple(spec for spec in BOUNDARY_SETTINGS if spec.name == "MIN_HEIGHT")
OFFERED = ("BLOCK_LENGTH", "SLOPE", "MIN_HEIGHT", "MAX_HEIGHT")


class DetectBoundaries(Algorithm):
    ID, TITLE, GROUP = "detectboundaries", "Detect road boundaries", "Road"
    SUMMARY = "Road edges straight from the point clouds, by profiles, by scanlines or by both."
    HELP = ("Where there is no curb the edge of the pavement is drawn: where asphalt ends at gravel, grass or a ditch, which are rougher, brighter, "
            "higher or lower than the road before them. The field edge distinguishes the two (curb, pavement). Where nothing separates the "
            "road from what lies beside it, no edge is made up.")
    TAGS = ("curb", "kerb", "road edge", "boundary", "scanline")
    RETIRED = ("PROFILE_WIDTH", "POINT_SPACING", "LAYER_JUMP", "INTERVAL", "ROTATION_FREQUENCY", "SCANLINE_MIN_HEIGHT", "SEARCH_WIDTH",
               "SENSOR_HEIGHT", "CLIPPING_HEIGHT", "DISTANCE_ACROSS", "DISTANCE_ALONG", "RANSAC_DISTANCE", "VERTICAL_ANGLE", "HORIZONTAL_ANGLE")

    def declare(self):
        self.add_survey()
        self.add_settings((METHOD_SETTING,))
        self.add_settings(CURB_SETTINGS, only=OFFERED)
        self.add_settings(EDGE_SETTINGS)
        self.add_settings(SURVEY_SETTINGS)
        add_execution(self)
        self.add_sink("ROAD_EDGES", tr("Road edges"), fields=ROAD_EDGES, geometry="LineStringZ")

    def work(self, call, progress):
        from ...core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
        from ...core.road.surface.ground_grid import MeasuredGround

        settings = BoundarySettings(call.value("BOUNDARY_METHOD"), call.settings(CURB_SETTINGS), call.settings(SCANLINE_METHOD_SETTINGS))
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        ground = MeasuredGround(survey)
        curbs = find_curb_points(survey, settings, progress.part(0.5, 0.95), ground)
        boundaries = draw_boundaries(curbs, survey.frame, call.settings(EDGE_SETTINGS), progress.part(0.95, 1.0), survey, ground)
        call.layer("ROAD_EDGES", boundaries.edges.to_features(survey.frame))
