"""Markings as curves."""

from ...core.common.features import MARKING_LINES, MARKINGS, ROAD_EDGES
from ...core.countries.catalogue import COUNTRIES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import check_layers_on_roads, frame_of, paint_of, road_points_of
from ..texts import tr

LINES = "core.markings.lines.fit:MarkingLineSettings"

LINE_SETTINGS = (
    SettingSpec("COUNTRY", LINES, "country", tr("Country"),
                tr("Whose dashes are looked for. It is never guessed; neutral holds for roads of all countries of the catalogue."),
                choices=tuple(COUNTRIES), advanced=True),
    SettingSpec("CURVE", LINES, "curve", tr("Curve fitted to marking lines"),
                tr("Automatic takes the simplest curve that fits (Bayesian information criterion). Choose one to force it on every line."),
                choices=("automatic", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline")),
    SettingSpec("DEGREE", LINES, "degree", tr("Degree of the polynomial (0-9)"),
                tr("Used with polynomial only. Higher follows more bends, but swings between its points.")),
)


class FitMarkingLines(Algorithm):
    ID, TITLE, GROUP = "fitmarkinglines", "Fit marking lines", "Markings"
    SUMMARY = "Links dashes along the road and fits a curve to every painted line."
    LOOKS = {"NAMED_MARKINGS": "MARKINGS"}
    TAGS = ("lane line", "curve fitting", "circle", "clothoid", "spline")
    RETIRED = ("LINK_GAP", "LINK_BRIDGE", "MIN_PAINT")

    def declare(self):
        self.add_input("cloud", "CLUSTERED_POINTS", tr("Clustered points"), tr("The file written by Cluster markings."))
        self.add_input("layer", "MARKINGS", tr("Markings"), tr("The layer written by Cluster markings together with the points."), "PolygonZ")
        self.add_trajectory()
        self.add_input("layer", "ROAD_EDGES", tr("Road edges"), tr("With it curbs help to tell edge lines from lane lines."),
                       "LineStringZ", optional=True)
        self.add_input("cloud", "ROAD_POINTS", tr("Road points"),
                       tr("With it the width of the road helps to tell what a line separates."), optional=True)
        self.add_settings(LINE_SETTINGS)
        self.add_sink("MARKING_LINES", tr("Marking lines"), fields=MARKING_LINES, geometry="LineStringZ")
        self.add_sink("NAMED_MARKINGS", tr("Markings named by their lines"), fields=MARKINGS, geometry="PolygonZ", optional=True, by_default=False,
                      text=tr("The markings again, each dash and piece of a line with the class of the line that runs along it: alone, a dash of a "
                              "centre line looks like any other."))

    def work(self, call, progress):
        from ...core.markings.lines.fit import fit_marking_lines, named_by_lines
        from ...core.markings.objects.marking_objects import MarkingObjects, with_kinds_of
        from ...core.road.edges.road_edges import RoadEdges

        layer = call.features("MARKINGS", MARKINGS, "PolygonZ")
        points = paint_of(call, "CLUSTERED_POINTS", progress.part(0.0, 0.2))
        frame = frame_of(call, points.crs, progress, points, {"MARKINGS": layer})
        markings = MarkingObjects.from_features(layer, frame)
        edges = call.features("ROAD_EDGES", ROAD_EDGES, "LineStringZ")
        check_layers_on_roads(call, {"ROAD_EDGES": edges}, frame, progress)
        road_points = road_points_of(call, "ROAD_POINTS", progress.part(0.2, 0.3)) if call.cloud("ROAD_POINTS") else None
        lines = fit_marking_lines(points, markings, frame, call.settings(LINE_SETTINGS), progress.part(0.3, 1.0),
                                  edges=None if edges is None else RoadEdges.from_features(edges, frame).densified(frame), road_points=road_points)
        call.layer("MARKING_LINES", lines.to_features(frame))
        if call.wants("NAMED_MARKINGS"):
            call.layer("NAMED_MARKINGS", with_kinds_of(layer, named_by_lines(markings, lines), frame))
