"""Road boundaries by either method or by both; the road map and the algorithms use this file alone."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from ..common.arrays import mask_runs, stretch_of
from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..execution.phase import THREADS, NoSource, Phase
from ..survey.frame.road_frame import RoadFrame
from ..survey.lattice.scan_lattice import find_lattice
from .common.curb_limits import CurbSettings
from .common.curb_points import CurbPoints
from .common.decimation import LevelGround, PointDecimation
from .common.occlusion import OcclusionGrid
from .common.side_curbs import SideChains, points_of_side
from .common.sides import SIDE_SIGNS
from .curb_returns.detect import with_curb_returns
from .edges.fit import EdgeSettings, edges_through, fit_road_edges, tell_edges
from .edges.road_edges import EdgePiece, RoadEdges, joined_pieces
from .profiles.detect import detect_curbs
from .scanlines.candidates import ScanlineBoundarySettings
from .scanlines.detect import SurveyScanlines, curbs_from_scanlines
from .scanlines.section_planes import ScanlineSettings
from .surface.ground_grid import MeasuredGround
from .surface.pavement_lines import with_pavement_edges
from .weights import BOUNDARY, SCANLINE

if TYPE_CHECKING:
    from ..survey.open_survey import Survey

BOUNDARY_METHODS = ("profiles", "scanlines", "both")
METHODS = ("scanlines", "profiles")   # in the order of trust: three planes are a stricter model of a curb than a profile


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
    """

    curb_points: CurbPoints
    edges: RoadEdges
    differences: RoadEdges | None = None
    length_by_method: dict = field(default_factory=dict)


def find_curb_points(survey: Survey, settings: BoundarySettings = BoundarySettings(), progress: Progress = Progress(),
                     ground: MeasuredGround | None = None) -> dict[str, CurbPoints]:
    """Curb points of the methods that the settings name.

    ground : MeasuredGround of the survey, which keeps what is measured here, or None

    Returns
    -------
    {method: CurbPoints}; with both methods, "profiles" and "scanlines" hold the road's own
    curbs as each sees them alone, and "both" those of the best path through the chains of the two. Corners, side streets
    and islands are found in plan, once, and belong to the curbs that are drawn.
    """
    least = settings.scanlines.limits.least_height
    with closing(PointDecimation(survey, settings.curbs.profile_width, settings.curbs.point_spacing, least)) as decimation:
        return _find_curb_points(decimation, settings, progress, ground or MeasuredGround(survey))


def _find_curb_points(decimation, settings, progress, ground):
    """`find_curb_points` with the points of a PointDecimation."""
    survey, both_methods, points = decimation.survey, settings.method == "both", {}
    occlusion: dict[int, dict[str, OcclusionGrid]] = {}
    chains: list[dict[tuple[int, str], SideChains]] = [{}, {}]
    if settings.method != "scanlines":
        part = progress.part(0.0, BOUNDARY.profiles_progress) if both_methods else progress
        points["profiles"] = detect_curbs(survey, settings.curbs, part, not both_methods, decimation, occlusion, chains[0], ground)
    if settings.method != "profiles":
        part = progress.part(BOUNDARY.profiles_progress if both_methods else 0.0, 1.0)
        lattice = find_lattice(survey, settings.planes.rotation_frequency, part.part(0.0, BOUNDARY.lattice_progress))
        source = SurveyScanlines(survey, settings.planes, settings.scanlines.sensor_height, lattice,
                                 level=_level_for(decimation, settings.scanlines))
        corners = part.part(BOUNDARY.lattice_progress, BOUNDARY.returns_progress)
        points["scanlines"] = curbs_from_scanlines(source, settings.scanlines, settings.curbs.block_length, corners,
                                                   None if both_methods else occlusion, chains[1], ground)
        drawn = "both" if both_methods else "scanlines"
        if both_methods:
            points["both"] = _points_of_both(chains[::-1], occlusion, survey)
        points[drawn] = with_curb_returns(points[drawn], decimation, settings.curbs, part.part(BOUNDARY.returns_progress, 1.0), occlusion,
                                           ground)
    return points


def _level_for(decimation, settings):
    """The ground that SurveyScanlines leaves out, which can have no corner."""
    along = settings.distance_along + SCANLINE.gap_fill_reach + BOUNDARY.level_strip_margin
    return LevelGround(decimation, settings.distance_across + BOUNDARY.level_strip_margin, along)


def _points_of_both(chains, occlusion, survey):
    """The curb points along the best path through the chains of all methods; those of the stricter model of a curb come first."""
    parts = []
    for road in survey.store.roads():
        for side in SIDE_SIGNS:
            of_side = [of_method[road, side] for of_method in chains if (road, side) in of_method]
            if of_side:
                parts.append(points_of_side(survey, road, side, of_side, occlusion[road][side]))
    return CurbPoints.join(parts, survey.crs)


def draw_boundaries(found: dict[str, CurbPoints], frame: RoadFrame, settings: EdgeSettings = EdgeSettings(),
                    progress: Progress = Progress(), survey: Survey | None = None, ground: MeasuredGround | None = None) -> RoadBoundaries:
    """Edges through the curb points of one method, or of two that check each other, and edges of the pavement where there is no curb.

    With both methods, `agree` of every piece says how far apart they lie.

    Parameters
    ----------
    found : result of `find_curb_points`
    survey : Survey, in which edges of the pavement are looked for; None leaves them out
    ground : MeasuredGround of it that an earlier stage kept, or None
    """
    executor = THREADS if survey is None else survey.executor.passing()
    boundaries = _drawn(found, frame, settings, executor, progress if survey is None else progress.part(0.0, BOUNDARY.curb_edges_progress))
    if survey is not None:
        boundaries.edges = with_pavement_edges(survey, boundaries.edges, settings, progress=progress.part(BOUNDARY.curb_edges_progress, 1.0),
                                               ground=ground)
    return boundaries


def _drawn(found, frame, settings, executor, progress):
    """The edges at curbs alone."""
    if "both" not in found:
        points, = found.values()
        return RoadBoundaries(points, fit_road_edges(points, frame, settings, progress))
    fitting = Phase(edges_through, NoSource(), (frame, settings), lambda item: "the edges of all roads")
    scanlines, profiles, edges = executor.run(fitting, [found[method] for method in (*METHODS, "both")])
    tell_edges(edges, progress)
    edges, differences = measure_agreement(edges, scanlines, profiles, frame)
    lengths = {method: float(lines.length[lines.status == "measured"].sum()) for method, lines in zip(METHODS, (scanlines, profiles))}
    differing = differences.length.sum()
    if any(lengths.values()):
        progress.info(f"Profiles measured {lengths['profiles']:.0f} m of edges and scanlines {lengths['scanlines']:.0f} m; "
                     f"they lie more than 5 cm apart along {differing:.0f} m.")
    return RoadBoundaries(found["both"], edges, differences, lengths)


# How far apart two sets of road edges lie where both follow one curb.


@dataclass
class _EdgeSamples:
    """The edges of one side of a road at N places BOUNDARY.comparison_step apart.

    s : (N,) m, station
    d, z : (N,) m, offset and local height, NaN where there is no edge
    """

    s: np.ndarray
    d: np.ndarray
    z: np.ndarray


def sample_edges(edges: RoadEdges, frame: RoadFrame, road: int, side: str) -> _EdgeSamples:
    """The edges of one side of a road at regular stations.

    side : "left" or "right"
    """
    line = frame.road(road)
    first, last = int(np.floor(line.start / BOUNDARY.comparison_step)), int(np.ceil(line.end / BOUNDARY.comparison_step))
    s = np.arange(first, last + 1) * BOUNDARY.comparison_step
    samples = _EdgeSamples(s, np.full(len(s), np.nan), np.full(len(s), np.nan))
    course = edges.course
    for k in np.flatnonzero((edges.road == road) & (edges.side == side) & (edges.status != "inferred") & (edges.part == "bottom")
                            & edges.of_main_curb):
        vertices = course.line(k)
        good = np.isfinite(course.s[vertices])
        station, d, z = (values[vertices][good] for values in (course.s, course.d, course.z))
        if len(station) < 2:
            continue
        order = np.argsort(station, kind="stable")
        station, d, z = station[order], d[order], z[order]
        inside = stretch_of(s, station[0] - BOUNDARY.comparison_step / 2, station[-1] + BOUNDARY.comparison_step / 2)
        samples.d[inside], samples.z[inside] = np.interp(s[inside], station, d), np.interp(s[inside], station, z)
    return samples


def measure_agreement(edges: RoadEdges, first_edges: RoadEdges, second_edges: RoadEdges, frame: RoadFrame) -> tuple[RoadEdges, RoadEdges]:
    """How far apart two sets of edges lie beside every edge, and where that is much.

    The number is the distance that 95 % of the piece does not exceed, NaN where one of the
    two sets has no line. It is measured across the road, every BOUNDARY.comparison_step metres.

    edges : RoadEdges that are drawn
    first_edges, second_edges : RoadEdges of two methods

    Returns
    -------
    edges : RoadEdges with `agree`
    differences : RoadEdges, lines along the drawn edges, one for every stretch where the two lie more
        than BOUNDARY.min_reported_difference apart, `agree` their largest distance there
    """
    agree = edges.agree.copy()
    differences: list[EdgePiece] = []
    for road in frame.roads:
        for side in SIDE_SIGNS:
            first, second, drawn = (sample_edges(e, frame, road.number, side) for e in (first_edges, second_edges, edges))
            difference = np.abs(first.d - second.d)
            for k in np.flatnonzero((edges.road == road.number) & (edges.side == side)):
                distances = difference[stretch_of(first.s, edges.station[k], edges.end[k])]
                distances = distances[np.isfinite(distances)]
                if len(distances):
                    agree[k] = round(100 * float(np.quantile(distances, BOUNDARY.agreement_quantile)), 1)
            with np.errstate(invalid="ignore"):
                differing = (difference > BOUNDARY.min_reported_difference) & np.isfinite(drawn.d)
            for a, b in mask_runs(differing):
                if (b - a) * BOUNDARY.comparison_step < BOUNDARY.min_reported_length:
                    continue
                x, y, z = frame.to_map(road.number, first.s[a:b], drawn.d[a:b], drawn.z[a:b])
                differences.append(EdgePiece(
                    np.c_[x, y, z], road.number, side, "measured", len(differences), float(first.s[a]), float(first.s[b - 1]),
                    agree=100 * float(difference[a:b].max())))
    return replace(edges, agree=agree), joined_pieces(differences, frame, edges.crs)
