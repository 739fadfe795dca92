"""Road edges as smooth lines through curb points."""

from ...core.common.features import CURB_POINTS, ROAD_EDGES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import frame_of
from ..texts import tr

EDGES = "core.road.edges.fit:EdgeSettings"

EDGE_SETTINGS = (
    SettingSpec("MAX_GAP", EDGES, "max_gap", tr("Longest gap bridged (m)"),
                tr("Longer carries the edge past rows of parked cars, flagged as bridged; shorter breaks it there. Where both parts of the curb lie "
                   "in one line, gaps up to twice as long are bridged.")),
    SettingSpec("FALLBACK_WIDTH", EDGES, "fallback_width", tr("Assumed road width where no curb is seen, 0 = none (m)"),
                tr("0 draws no edge where none was found. A width draws one at half of it either side of the road's reference line, flagged as "
                   "inferred."), advanced=True),
)


class FitRoadEdges(Algorithm):
    ID, TITLE, GROUP = "fitroadedges", "Fit road edges", "Road"
    SUMMARY = "Draws the road edges through curb points as smoothing splines, bridging short gaps and saying so."
    TAGS = ("curb", "kerb", "road edge", "spline")

    def declare(self):
        self.add_input("layer", "CURB_POINTS", tr("Curb points"), tr("The layer written by Detect curbs."), "PointZ")
        self.add_trajectory()
        self.add_settings(EDGE_SETTINGS)
        self.add_sink("ROAD_EDGES", tr("Road edges"), fields=ROAD_EDGES, geometry="LineStringZ")

    def work(self, call, progress):
        from ...core.road.common.curb_points import CurbPoints
        from ...core.road.edges.fit import fit_road_edges

        layer = call.features("CURB_POINTS", CURB_POINTS, "PointZ")
        frame = frame_of(call, layer.crs, progress, layers={"CURB_POINTS": layer})
        edges = fit_road_edges(CurbPoints.from_features(layer, frame), frame, call.settings(EDGE_SETTINGS), progress)
        call.layer("ROAD_EDGES", edges.to_features(frame))
