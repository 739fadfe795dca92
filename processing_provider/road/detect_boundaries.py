"""Road edges from the point clouds in one step, by either method."""

from dataclasses import replace

from ...core.common.schemas import ROAD_EDGES
from ..algorithm import LanewrightAlgorithm
from ..knobs import Knob
from ..survey_input import SURVEY_KNOBS, open_survey_of
from ..texts import tr
from .boundaries_from_scanlines import DOOR_KNOBS
from .detect_curbs import CURB_KNOBS
from .fit_road_edges import EDGE_KNOBS
from .normalized_scanlines import SCANLINE_KNOBS

METHOD_KNOB = Knob(
    "BOUNDARY_METHOD", "road.detect_boundaries:BoundarySettings", "method", tr("Boundary method"),
    tr("Profiles looks for the curb in slices across the road; scanlines meets the planes of road, curb face and sidewalk; both "
       "lets the two check each other: at every place the one that measures better is drawn, agree_cm says how far apart they are, "
       "and it takes as long as the two together."),
    choices=("profiles", "scanlines", "both"),
)
# Where scanlines lie; their corridor is the survey's
PLANE_KNOBS = tuple(replace(knob, advanced=True) for knob in SCANLINE_KNOBS if knob.name != "CORRIDOR")


class DetectBoundaries(LanewrightAlgorithm):
    ID, TITLE, ROOM = "detectboundaries", "Detect road boundaries", "Road"
    SUMMARY = "Road edges straight from the point clouds: one door to every way of finding them."
    TAGS = ("curb", "kerb", "road edge", "boundary", "scanline")

    def initAlgorithm(self, configuration=None):
        self.add_survey()
        self.add_knobs((METHOD_KNOB,))
        self.add_knobs(CURB_KNOBS)
        self.add_knobs(EDGE_KNOBS)
        self.add_knobs(PLANE_KNOBS)
        self.add_knobs(DOOR_KNOBS)
        self.add_knobs(SURVEY_KNOBS)
        self.add_sink("ROAD_EDGES", tr("Road edges"), fields=ROAD_EDGES, geometry="LineStringZ")

    def work(self, call, progress):
        from ...core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points

        settings = BoundarySettings(call.knob(METHOD_KNOB), call.settings(CURB_KNOBS), call.settings(DOOR_KNOBS),
                                    call.settings(PLANE_KNOBS))
        survey = open_survey_of(call, progress.part(0.0, 0.5))
        found = find_curb_points(survey, settings, progress.part(0.5, 0.95))
        boundaries = draw_boundaries(found, survey.frame, call.settings(EDGE_KNOBS), progress.part(0.95, 1.0))
        call.layer("ROAD_EDGES", boundaries.edges)
