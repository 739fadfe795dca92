"""The points and the outline of the road surface."""

from ...core.common.features import ROAD_EDGES, ROAD_SURFACE
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import SURVEY_SETTINGS, check_layers_on_roads, open_survey_of
from ..texts import tr

SURFACE = "core.road.surface.extract:SurfaceSettings"

SURFACE_SETTINGS = (
    SettingSpec("MAX_WIDTH", SURFACE, "max_width", tr("Farthest surface from the trajectory (m)"),
                tr("On a side without an edge the surface grows outward while it stays smooth, at most this far. Wider reaches the far lanes of a "
                   "broad road, but also yards and forecourts.")),
)


class ExtractRoadSurface(Algorithm):
    ID, TITLE, GROUP = "extractroadsurface", "Extract road surface", "Road"
    SUMMARY = "Keeps the points of the road surface: between the road edges, or as far as the ground stays smooth."
    TAGS = ("road surface", "ground")
    RETIRED = ("HEIGHT_TOLERANCE",)

    def declare(self):
        self.add_survey()
        self.add_input("layer", "ROAD_EDGES", tr("Road edges"),
                       tr("The layer written by Fit road edges. Without it the surface is grown on both sides."), "LineStringZ", optional=True)
        self.add_settings(SURFACE_SETTINGS)
        self.add_settings(SURVEY_SETTINGS)
        self.add_output("cloud", "ROAD_POINTS", tr("Road points"),
                        tr("Class 11, with the extra fields road, pass, station_m, offset_m, half_width and covered for the stages that follow."))
        self.add_sink("ROAD_SURFACE", tr("Road surface"), fields=ROAD_SURFACE, geometry="PolygonZ", optional=True)

    def work(self, call, progress):
        from ...core.road.edges.road_edges import RoadEdges
        from ...core.road.surface.extract import extract_road_surface
        from ...core.survey.road_points_las import write_road_points

        layer = call.features("ROAD_EDGES", ROAD_EDGES, "LineStringZ")
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        edges = None
        if layer is not None:
            check_layers_on_roads(call, {"ROAD_EDGES": layer}, survey.frame, progress)
            edges = RoadEdges.from_features(layer, survey.frame)
        road_points, surface = extract_road_surface(survey, edges, call.settings(SURFACE_SETTINGS), progress.part(0.5, 0.9))
        write_road_points(road_points, call.new_file("ROAD_POINTS"), progress.part(0.9, 1.0))
        road_points.close()
        call.layer("ROAD_SURFACE", surface.to_features(survey.frame))
