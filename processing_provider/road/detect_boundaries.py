"""Road edges from the point clouds in one step, by either method."""

from qgis.core import QgsProcessingParameterEnum

from ...core.schemas import ROAD_EDGES
from ..algorithm import LanewrightAlgorithm
from ..survey_input import SURVEY_KNOBS, open_survey_of
from ..texts import tr
from .detect_curbs import CURB_KNOBS
from .fit_road_edges import EDGE_KNOBS

METHODS = ("profiles",)


def add_boundary_method(algorithm):
    algorithm.add(
        QgsProcessingParameterEnum(
            "BOUNDARY_METHOD", tr("Boundary method"), list(METHODS), defaultValue=METHODS[0], usesStaticStrings=True
        ),
        tr("Profiles looks for the curb in slices across the road and needs no knowledge of the scanner."),
    )


class DetectBoundaries(LanewrightAlgorithm):
    ID, TITLE, ROOM = "detectboundaries", "Detect road boundaries", "Road"
    SUMMARY = "Road edges straight from the point clouds: one door to every way of finding them."
    TAGS = ("curb", "kerb", "road edge", "boundary")

    def initAlgorithm(self, configuration=None):
        self.add_survey()
        add_boundary_method(self)
        self.add_knobs(CURB_KNOBS)
        self.add_knobs(EDGE_KNOBS)
        self.add_knobs(SURVEY_KNOBS)
        self.add_sink("ROAD_EDGES", tr("Road edges"), fields=ROAD_EDGES, geometry="LineStringZ")

    def work(self, call, progress):
        from ...core.road.curbs import detect_curbs
        from ...core.road.edges import fit_road_edges

        survey = open_survey_of(call, progress.part(0.0, 0.5))
        curbs = detect_curbs(survey, call.settings(CURB_KNOBS), progress.part(0.5, 0.95))
        call.layer("ROAD_EDGES", fit_road_edges(curbs, survey.frame, call.settings(EDGE_KNOBS), progress.part(0.95, 1.0)))
