"""Road boundaries by either method or by both; the road map and the algorithms use this file alone."""

from __future__ import annotations

from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from ..common.errors import RoadExtractionError
from ..common.parallel import InBackground
from ..common.progress import Progress
from ..survey.lattice.scan_lattice import find_lattice
from .agreement import CurbEvidence, measure_agreement, select_curb_points
from .common.curb_limits import CurbSettings
from .common.curb_points import CurbPoints
from .common.decimation import LevelGround, PointDecimation
from .common.occlusion import OcclusionGrid
from .common.tracking import SideChains
from .curb_returns.detect import with_curb_returns
from .edges.fit import EdgeSettings, fit_road_edges
from .edges.road_edges import RoadEdges
from .in_line_of_both import with_pieces_of_both
from .profiles.detect import detect_curbs
from .scanlines.candidates import GAP_FILL_REACH, ScanlineBoundarySettings
from .scanlines.detect import curbs_from_scanlines
from .scanlines.section_planes import ScanlineSettings
from .scanlines.source import SurveyScanlines
from .surface.ground_grid import MeasuredGround
from .surface.pavement_lines import with_pavement_edges

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame
    from ..survey.open_survey import Survey

BOUNDARY_METHODS = ("profiles", "scanlines", "both")
PROFILES_PROGRESS = 0.3       # share of the work that profiles are, with both methods; of the rest,
LATTICE_PROGRESS = 0.1        # share at which the scan lattice is known, and
RETURNS_PROGRESS = 0.85       # share at which the search for curb returns begins
CURB_EDGES_PROGRESS = 0.1     # share of the edges that those at curbs are; the others need the ground beside the road
LEVEL_STRIP_MARGIN = 0.20     # m beyond the points from which corners are measured, in which scanlines still continue


@dataclass(frozen=True)
class BoundarySettings:
    """How road boundaries are found.

    Attributes
    ----------
    method : "profiles", "scanlines", or "both": the two check each other
    curbs : settings of the profiles method
    scanlines : settings of the scanlines method
    planes : settings of the planes in which scanlines lie
    """

    method: str = "both"
    curbs: CurbSettings = CurbSettings()
    scanlines: ScanlineBoundarySettings = ScanlineBoundarySettings()
    planes: ScanlineSettings = ScanlineSettings()

    def __post_init__(self) -> None:
        if self.method not in BOUNDARY_METHODS:
            raise RoadExtractionError(f"The boundary method {self.method!r} is not known; "
                                      f"choose {', '.join(BOUNDARY_METHODS[:-1])} or {BOUNDARY_METHODS[-1]}.")


@dataclass
class RoadBoundaries:
    """Curb points and the edges through them.

    Attributes
    ----------
    curb_points : CurbPoints
    edges : RoadEdges
    differences : RoadEdges, where the edges of the two methods lie apart; None with one method
    length_by_method : method -> m of measured edges; empty with one method
    ground : MeasuredGround in which edges of the pavement were looked for; None without
    """

    curb_points: CurbPoints
    edges: RoadEdges
    differences: RoadEdges | None = None
    length_by_method: dict = field(default_factory=dict)
    ground: MeasuredGround | None = None


def find_curb_points(survey: Survey, settings: BoundarySettings = BoundarySettings(), progress: Progress = Progress()) -> dict[str, CurbPoints]:
    """Curb points of the methods that the settings name.

    Parameters
    ----------
    survey : Survey
    settings : BoundarySettings
    progress : Progress

    Returns
    -------
    {method: CurbPoints}; with both methods, "profiles" and "scanlines" hold the road's own
    curbs and "both" those of the two that measure better (`select_curb_points`). Corners, side streets
    and islands are found in plan, once, and belong to the curbs that are drawn.
    """
    least = settings.scanlines.limits.least_height
    with (closing(PointDecimation(survey, settings.curbs.profile_width, settings.curbs.point_spacing, least)) as decimation,
          _lattice_meanwhile(survey, settings) as lattice):
        return _find_curb_points(decimation, lattice, settings, progress)


@contextmanager
def _lattice_meanwhile(survey, settings):
    """A function of a Progress that gives the scan lattice; with both methods this process finds it while others find the curbs on profiles."""
    find = partial(find_lattice, survey, settings.planes.rotation_frequency)
    # points that are not yet where others see them are moved there as the phase begins: nobody may read them meanwhile
    if settings.method == "both" and survey.executor.folder is not None and survey.folder is not None:
        with InBackground(find) as finding:
            yield finding.result
    else:
        yield find


def _find_curb_points(decimation, lattice, settings, progress):
    """`find_curb_points` with the points of a PointDecimation and a function that gives the lattice."""
    survey, both, found = decimation.survey, settings.method == "both", {}
    beside: dict[int, dict[str, OcclusionGrid]] = {}
    beside_of_scanlines: dict[int, dict[str, OcclusionGrid]] = {}
    chains: list[dict[tuple[int, str], SideChains]] = [{}, {}]
    if settings.method != "scanlines":
        part = progress.part(0.0, PROFILES_PROGRESS) if both else progress
        found["profiles"] = detect_curbs(survey, settings.curbs, part, not both, decimation, beside, chains[0])
    if settings.method != "profiles":
        part = progress.part(PROFILES_PROGRESS if both else 0.0, 1.0)
        source = SurveyScanlines(survey, settings.planes, settings.scanlines.sensor_height, lattice(part.part(0.0, LATTICE_PROGRESS)),
                                 level=_level_for(decimation, settings.scanlines))
        found["scanlines"] = curbs_from_scanlines(source, settings.scanlines, settings.curbs.block_length,
                                                  part.part(LATTICE_PROGRESS, RETURNS_PROGRESS), beside_of_scanlines if both else beside, chains[1])
        drawn = "both" if both else "scanlines"
        if both:
            chosen = _better_points(found, survey.frame, CurbEvidence(chains[1], beside_of_scanlines), CurbEvidence(chains[0], beside))
            beside_of_scanlines.clear()   # planes lie close: along a long road their grids are large
            found["both"] = with_pieces_of_both(chosen, chains, beside, survey)
        found[drawn] = with_curb_returns(found[drawn], decimation, settings.curbs, part.part(RETURNS_PROGRESS, 1.0), beside)
    return found


def _level_for(decimation, settings):
    """The ground that SurveyScanlines leaves out, which can have no corner."""
    along = settings.distance_along + GAP_FILL_REACH + LEVEL_STRIP_MARGIN
    return LevelGround(decimation, settings.distance_across + LEVEL_STRIP_MARGIN, along)


def _better_points(found, frame, *seen):
    """At every place the curb points of that method which measures better."""
    # scanlines first: three planes are a stricter model of a curb than a profile
    methods = ("scanlines", "profiles")
    edges = (fit_road_edges(found[method], frame, led_across=False) for method in methods)
    return select_curb_points(*(found[method] for method in methods), *edges, frame, *seen)


def draw_boundaries(found: dict[str, CurbPoints], frame: RoadFrame, settings: EdgeSettings = EdgeSettings(),
                    progress: Progress = Progress(), survey: Survey | None = None) -> RoadBoundaries:
    """Edges through the curb points of one method, or of two that check each other, and edges of the pavement where there is no curb.

    With both methods, the one that measures better is drawn at every place
    (`select_curb_points`), and `agree` of every piece says how far apart they lie.

    Parameters
    ----------
    found : result of `find_curb_points`
    frame : RoadFrame
    settings : EdgeSettings
    progress : Progress
    survey : Survey, in which edges of the pavement are looked for; None leaves them out

    Returns
    -------
    RoadBoundaries
    """
    boundaries = _drawn(found, frame, settings, progress if survey is None else progress.part(0.0, CURB_EDGES_PROGRESS))
    if survey is not None:
        boundaries.ground = MeasuredGround(survey)
        boundaries.edges = with_pavement_edges(survey, boundaries.edges, settings, progress=progress.part(CURB_EDGES_PROGRESS, 1.0),
                                               ground=boundaries.ground)
    return boundaries


def _drawn(found, frame, settings, progress):
    """The edges at curbs alone."""
    if "both" not in found:
        points, = found.values()
        return RoadBoundaries(points, fit_road_edges(points, frame, settings, progress))
    single = {method: fit_road_edges(found[method], frame, settings) for method in ("scanlines", "profiles")}
    edges = fit_road_edges(found["both"], frame, settings, progress)
    edges, differences = measure_agreement(edges, single["scanlines"], single["profiles"], frame)
    lengths = {method: float(lines.length[lines.status == "measured"].sum()) for method, lines in single.items()}
    differing = differences.length.sum()
    if any(lengths.values()):
        progress.info(f"Profiles measured {lengths['profiles']:.0f} m of edges and scanlines {lengths['scanlines']:.0f} m; "
                     f"they lie more than 5 cm apart along {differing:.0f} m.")
    return RoadBoundaries(found["both"], edges, differences, lengths)
