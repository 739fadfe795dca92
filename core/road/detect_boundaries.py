"""Road boundaries by either method or by both: the one door that the road map and its dialogs use."""

from contextlib import closing
from dataclasses import dataclass, field

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.features import Features
from ..common.progress import Progress
from .agreement import chosen_points, note_agreement
from .common.decimation import Crowds
from .common.nearest_pass import name_passes
from .curb_returns.detect import add_turned_curbs
from .edges.fit import EdgeSettings, fit_road_edges
from .profiles.detect import CurbSettings, detect_curbs
from .scanlines.candidates import GAP_FILL_REACH
from .scanlines.detect import ScanlineBoundarySettings, curbs_from_scanlines
from .scanlines.section_planes import ScanlineSettings
from .scanlines.source import SurveyScanlines

METHODS = ("profiles", "scanlines", "both")
PROFILES = 0.3    # of the work with both methods; of the rest,
LATTICE = 0.1     # the lattice ends here,
TURNED = 0.85     # and what turns away begins here
CLEAR = 0.20      # m about what corners are measured from in which scanlines still go on


@dataclass(frozen=True)
class BoundarySettings:
    """How road boundaries are found.

    method : "profiles", "scanlines", or "both": the two check each other
    curbs, scanlines : settings of the one and of the other
    planes : where the scanlines lie
    """

    method: str = "both"
    curbs: CurbSettings = CurbSettings()
    scanlines: ScanlineBoundarySettings = ScanlineBoundarySettings()
    planes: ScanlineSettings = ScanlineSettings()

    def __post_init__(self):
        if self.method not in METHODS:
            raise RoadExtractionError(f"The boundary method {self.method!r} is not known; choose {', '.join(METHODS[:-1])} or {METHODS[-1]}.")


@dataclass
class Boundaries:
    """Curb points and the edges through them; with both methods also where these lie apart (else None)."""

    curb_points: Features
    edges: Features
    differences: Features = None
    length_by_method: dict = field(default_factory=dict)


def find_curb_points(survey, settings=BoundarySettings(), progress=Progress()):
    """Curb points of the methods asked for.

    Returns
    -------
    {method: Features CURB_POINTS}; with both, "profiles" and "scanlines" hold the road's own
    curbs and "both" those of the two that measure better (`chosen_points`). Corners, side streets and
    islands are found in plan, once, from the curbs that are drawn.
    """
    with closing(Crowds(survey, settings.curbs.profile_width, settings.curbs.point_spacing, settings.scanlines.min_height)) as crowds:
        return _curb_points_from(crowds, settings, progress)


def _curb_points_from(crowds, settings, progress):
    """`find_curb_points`, points taken from Crowds."""
    survey, both, found = crowds.survey, settings.method == "both", {}
    if settings.method != "scanlines":
        part = progress.part(0.0, PROFILES) if both else progress
        found["profiles"] = detect_curbs(survey, settings.curbs, part, turned=not both, crowds=crowds)
    if settings.method != "profiles":
        part = progress.part(PROFILES if both else 0.0, 1.0)
        source = SurveyScanlines(survey, settings.planes, settings.scanlines.sensor_height, progress=part.part(0.0, LATTICE),
                                 level=_level_for(crowds, settings.scanlines))
        found["scanlines"] = curbs_from_scanlines(source, settings.scanlines, settings.curbs.block_length, part.part(LATTICE, TURNED))
        drawn = found["scanlines"]
        if both:
            drawn = found["both"] = _better_points(found, survey.frame)
        add_turned_curbs(drawn, crowds, settings.curbs, part.part(TURNED, 1.0))
        name_passes(drawn, survey.frame)
    return found


def _level_for(crowds, settings):
    """The function by which SurveyScanlines leaves out where no corner can be."""
    across, along = (distance + CLEAR for distance in (settings.distance_across, settings.distance_along + GAP_FILL_REACH))

    def level(road, number, start, end):
        profiles = int(np.floor(start / crowds.width)), int(np.ceil(end / crowds.width))
        return crowds.level_strip(road, number, profiles, across, along)

    return level


def _better_points(found, frame):
    """Of scanlines and profiles, at every place the curb points that measure better."""
    # scanlines first: three planes ask more of a curb than a profile does
    methods = ("scanlines", "profiles")
    return chosen_points(*(found[method] for method in methods), *(fit_road_edges(found[method], frame) for method in methods), frame)


def draw_boundaries(found, frame, settings=EdgeSettings(), progress=Progress()):
    """Edges through the curb points of one method, or of two that check each other.

    Of two, the one that measures better is drawn at every place (`chosen_points`), and
    `agree_cm` of every piece says how far apart they are.

    Parameters
    ----------
    found : what `find_curb_points` gave
    frame : RoadFrame
    settings : EdgeSettings

    Returns
    -------
    Boundaries
    """
    if "both" not in found:
        points, = found.values()
        return Boundaries(points, fit_road_edges(points, frame, settings, progress))
    alone = {method: fit_road_edges(found[method], frame, settings) for method in ("scanlines", "profiles")}
    edges = fit_road_edges(found["both"], frame, settings, progress)
    differences = note_agreement(edges, alone["scanlines"], alone["profiles"], frame)
    lengths = {method: sum(row["length_m"] for row in lines.rows if row["status"] == "measured") for method, lines in alone.items()}
    doubtful = sum(row["length_m"] for row in differences.rows)
    if any(lengths.values()):
        progress.say(f"Profiles measured {lengths['profiles']:.0f} m of edges and scanlines {lengths['scanlines']:.0f} m; "
                     f"they lie more than 5 cm apart along {doubtful:.0f} m.")
    return Boundaries(found["both"], edges, differences, lengths)
