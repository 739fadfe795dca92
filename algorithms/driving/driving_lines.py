"""Driving lines and their curve elements."""

from ...core.common.features import CURVE_ELEMENTS, DRIVING_LINES, LANES, MARKING_LINES, MARKINGS, ROAD_EDGES
from ...core.countries.catalogue import COUNTRIES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import frame_of, road_points_of
from ..texts import tr

DRIVING = "core.driving.settings:DrivingSettings"

DRIVING_SETTINGS = (
    SettingSpec("COUNTRY", DRIVING, "country", tr("Country"),
                tr("Whose dashes are looked for, whose usual lane is assumed where the data do not decide, and whose design code curves are checked "
                   "against. It is never guessed; neutral holds for roads of all countries of the catalogue and checks curves against CJJ 37-2012."),
                choices=tuple(COUNTRIES), advanced=True),
    SettingSpec("LANE_WIDTH", DRIVING, "lane_width", tr("Lane width, 0 = as seen on the road (m)"),
                tr("0 takes the width that is seen between lines. A width named here is held to: where only the outer lines are painted, their "
                   "distance and this width give the number of lanes. Wider makes fewer lanes.")),
    SettingSpec("LINE_DISTANCE", DRIVING, "line_distance", tr("Distance from a line without partner, 0 = half a lane (m)"),
                tr("How far beside a painted line the driving line runs where the lane has no second line."), advanced=True),
    SettingSpec("TRAFFIC_SIDE", DRIVING, "traffic_side", tr("Side of traffic"),
                tr("The side one drives on; it gives lanes that nobody drove their direction. Automatic goes by where and which way the vehicle "
                   "drove, by lines that part the directions, and a little by the country where the survey lies. A driven lane leads the way it "
                   "was driven, whatever is named here."),
                choices=("automatic", "right", "left")),
)


class DrivingLines(Algorithm):
    ID, TITLE, GROUP = "drivinglines", "Driving lines", "Driving"
    SUMMARY = "Draws the line to drive in every lane, in the direction of travel, and tabulates the elements of its curves."
    TAGS = ("lane", "centre line", "hd map", "curve elements", "radius")
    RETIRED = ("MAX_BRIDGE", "MAX_INFERRED", "SHORTEST")

    def declare(self):
        self.add_input("layer", "MARKING_LINES", tr("Marking lines"), tr("The layer written by Fit marking lines."), "LineStringZ")
        self.add_trajectory()
        self.add_input("layer", "MARKINGS", tr("Markings"),
                       tr("With it a lane continues through zebra crossings and past stop lines, and kinds of gaps are distinguished."), "PolygonZ",
                       optional=True)
        self.add_input("layer", "ROAD_EDGES", tr("Road edges"), tr("With it lanes without an outer line end at the edge."), "LineStringZ",
                       optional=True)
        self.add_input("cloud", "ROAD_POINTS", tr("Road points"), tr("With it heights are the road's own."), optional=True)
        self.add_settings(DRIVING_SETTINGS)
        self.add_sink("DRIVING_LINES", tr("Driving lines"), fields=DRIVING_LINES, geometry="LineStringZ")
        self.add_sink("LANES", tr("Lanes"), fields=LANES, geometry="PolygonZ", optional=True,
                      text=tr("The area of each lane between its borders, with what follows it. Exports to HD maps are made from this layer."))
        self.add_sink("CURVE_ELEMENTS", tr("Curve elements"), fields=CURVE_ELEMENTS, geometry="None", optional=True)

    def work(self, call, progress):
        from ...core.driving.driving_lines import make_driving_lines
        from ...core.markings.lines.painted_lines import PaintedLines
        from ...core.markings.objects.marking_objects import MarkingObjects
        from ...core.road.edges.road_edges import RoadEdges

        marking_lines = call.features("MARKING_LINES", MARKING_LINES, "LineStringZ")
        markings = call.features("MARKINGS", MARKINGS, "PolygonZ")
        edges = call.features("ROAD_EDGES", ROAD_EDGES, "LineStringZ")
        road_points = road_points_of(call, "ROAD_POINTS", progress.part(0.0, 0.3)) if call.cloud("ROAD_POINTS") else None
        layers = {"MARKING_LINES": marking_lines, "MARKINGS": markings, "ROAD_EDGES": edges}
        frame = frame_of(call, marking_lines.crs, progress, road_points, layers)
        lines, elements, lanes = make_driving_lines(
            PaintedLines.from_features(marking_lines, frame), frame, call.settings(DRIVING_SETTINGS), progress.part(0.3, 1.0),
            markings=None if markings is None else MarkingObjects.from_features(markings, frame),
            edges=None if edges is None else RoadEdges.from_features(edges, frame).densified(frame), road_points=road_points)
        call.layer("DRIVING_LINES", lines.to_features(frame))
        call.layer("LANES", lanes.to_features(frame))
        call.layer("CURVE_ELEMENTS", elements.to_features(frame))
