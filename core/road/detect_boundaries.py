"""Road boundaries by either method or by both; the road map and the algorithms use this file alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..common.arrays import mask_runs, stretch_of
from ..common.errors import RoadExtractionError
from ..common.parallel import InBackground
from ..common.progress import Progress
from ..execution.phase import THREADS, NoSource, Phase
from ..survey.frame.road_frame import RoadFrame
from ..survey.lattice.scan_lattice import find_lattice
from .common.curb_limits import CurbSettings
from .common.curb_points import CurbPoints
from .common.decimation import LevelGround, PointDecimation
from .common.occlusion import OcclusionGrid
from .common.side_curbs import SideChains, points_of_rows
from .common.sides import SIDE_SIGNS, expected_height, hidden_beside
from .common.tracking import PieceInLine, StepsByStation, pieces_between
from .curb_returns.detect import with_curb_returns
from .curb_returns.main_curbs import main_curbs_of
from .edges.fit import EdgeSettings, edges_through, fit_road_edges, tell_edges
from .edges.road_edges import EdgePiece, RoadEdges, joined_pieces
from .profiles.detect import detect_curbs
from .scanlines.candidates import ScanlineBoundarySettings
from .scanlines.detect import SurveyScanlines, curbs_from_scanlines
from .scanlines.section_planes import ScanlineSettings
from .surface.ground_grid import MeasuredGround
from .surface.pavement_lines import with_pavement_edges
from .weights import BOUNDARY, CURBS, SCANLINE

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
    curbs and "both" those of the two that measure better (`select_curb_points`). Corners, side streets
    and islands are found in plan, once, and belong to the curbs that are drawn.
    """
    least = settings.scanlines.limits.least_height
    with (closing(PointDecimation(survey, settings.curbs.profile_width, settings.curbs.point_spacing, least)) as decimation,
          _lattice_meanwhile(survey, settings) as lattice):
        return _find_curb_points(decimation, lattice, settings, progress, ground or MeasuredGround(survey))


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


def _find_curb_points(decimation, lattice, settings, progress, ground):
    """`find_curb_points` with the points of a PointDecimation and a function that gives the lattice."""
    survey, both_methods, points = decimation.survey, settings.method == "both", {}
    occlusion: dict[int, dict[str, OcclusionGrid]] = {}
    occlusion_of_scanlines: dict[int, dict[str, OcclusionGrid]] = {}
    chains: list[dict[tuple[int, str], SideChains]] = [{}, {}]
    if settings.method != "scanlines":
        part = progress.part(0.0, BOUNDARY.profiles_progress) if both_methods else progress
        points["profiles"] = detect_curbs(survey, settings.curbs, part, not both_methods, decimation, occlusion, chains[0], ground)
    if settings.method != "profiles":
        part = progress.part(BOUNDARY.profiles_progress if both_methods else 0.0, 1.0)
        source = SurveyScanlines(survey, settings.planes, settings.scanlines.sensor_height, lattice(part.part(0.0, BOUNDARY.lattice_progress)),
                                 level=_level_for(decimation, settings.scanlines))
        corners = part.part(BOUNDARY.lattice_progress, BOUNDARY.returns_progress)
        points["scanlines"] = curbs_from_scanlines(source, settings.scanlines, settings.curbs.block_length, corners,
                                                   occlusion_of_scanlines if both_methods else occlusion, chains[1], ground)
        drawn = "both" if both_methods else "scanlines"
        if both_methods:
            # at every place the curb points of that method which measures better
            methods = [points[method] for method in METHODS]
            edges = _edges_through(methods, survey.frame, survey.executor.passing(), led_across=False)
            seen = CurbEvidence(chains[1], occlusion_of_scanlines), CurbEvidence(chains[0], occlusion)
            chosen = select_curb_points(*methods, *edges, survey.frame, *seen)
            occlusion_of_scanlines.clear()   # planes lie close: along a long road their grids are large
            points["both"] = with_pieces_of_both(chosen, chains, occlusion, survey)
        points[drawn] = with_curb_returns(points[drawn], decimation, settings.curbs, part.part(BOUNDARY.returns_progress, 1.0), occlusion,
                                           ground)
    return points


def _level_for(decimation, settings):
    """The ground that SurveyScanlines leaves out, which can have no corner."""
    along = settings.distance_along + SCANLINE.gap_fill_reach + BOUNDARY.level_strip_margin
    return LevelGround(decimation, settings.distance_across + BOUNDARY.level_strip_margin, along)


def draw_boundaries(found: dict[str, CurbPoints], frame: RoadFrame, settings: EdgeSettings = EdgeSettings(),
                    progress: Progress = Progress(), survey: Survey | None = None, ground: MeasuredGround | None = None) -> RoadBoundaries:
    """Edges through the curb points of one method, or of two that check each other, and edges of the pavement where there is no curb.

    With both methods, the one that measures better is drawn at every place
    (`select_curb_points`), and `agree` of every piece says how far apart they lie.

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


def _edges_through(points, frame, executor, settings=EdgeSettings(), led_across=True):
    """[RoadEdges] through the curb points of each method."""
    return list(executor.run(Phase(edges_through, NoSource(), (frame, settings, led_across), lambda item: "the edges of all roads"), points))


def _drawn(found, frame, settings, executor, progress):
    """The edges at curbs alone."""
    if "both" not in found:
        points, = found.values()
        return RoadBoundaries(points, fit_road_edges(points, frame, settings, progress))
    scanlines, profiles, edges = _edges_through([found[method] for method in (*METHODS, "both")], frame, executor, settings)
    tell_edges(edges, progress)
    edges, differences = measure_agreement(edges, scanlines, profiles, frame)
    lengths = {method: float(lines.length[lines.status == "measured"].sum()) for method, lines in zip(METHODS, (scanlines, profiles))}
    differing = differences.length.sum()
    if any(lengths.values()):
        progress.info(f"Profiles measured {lengths['profiles']:.0f} m of edges and scanlines {lengths['scanlines']:.0f} m; "
                     f"they lie more than 5 cm apart along {differing:.0f} m.")
    return RoadBoundaries(found["both"], edges, differences, lengths)


# How far apart two sets of road edges lie where both follow one curb, and which of the two to draw.

MIN_RISE = CURBS.candidate_height_share * CURBS.least_height  # m from one side of a place to the other below which ground is level
SECOND_METHOD_CHAIN_OFFSET = 100_000   # derived: more chains than a method finds; keeps those of both apart


@dataclass(frozen=True)
class CurbEvidence:
    """What a method saw beside the roads.

    chains : (number of the road, side) -> SideChains
    beside : number of the road -> side -> OcclusionGrid
    """

    chains: Mapping[tuple[int, str], SideChains] = field(default_factory=dict)
    beside: Mapping[int, Mapping[str, OcclusionGrid]] = field(default_factory=dict)


@dataclass
class _EdgeSamples:
    """The edges of one side of a road at N places BOUNDARY.comparison_step apart.

    s : (N,) m, station
    d, z : (N,) m, offset and local height, NaN where there is no edge
    measured : (N,) bool
    scatter : (N,) m, of the curb points about the piece of edge
    """

    s: np.ndarray
    d: np.ndarray
    z: np.ndarray
    measured: np.ndarray
    scatter: np.ndarray


def sample_edges(edges: RoadEdges, frame: RoadFrame, road: int, side: str) -> _EdgeSamples:
    """The edges of one side of a road at regular stations.

    side : "left" or "right"
    """
    line = frame.road(road)
    first, last = int(np.floor(line.start / BOUNDARY.comparison_step)), int(np.ceil(line.end / BOUNDARY.comparison_step))
    s = np.arange(first, last + 1) * BOUNDARY.comparison_step
    samples = _EdgeSamples(s, np.full(len(s), np.nan), np.full(len(s), np.nan), np.zeros(len(s), bool), np.full(len(s), np.inf))
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
        samples.measured[inside] = edges.status[k] == "measured"
        samples.scatter[inside] = edges.rmse[k]
    return samples


def select_curb_points(points: CurbPoints, others: CurbPoints, edges: RoadEdges, other_edges: RoadEdges, frame: RoadFrame,
                       seen: CurbEvidence = CurbEvidence(), others_seen: CurbEvidence = CurbEvidence()) -> CurbPoints:
    """At every place the curb points of that method whose edge measures better there.

    Where one method alone measured, its points are taken, unless the other saw level ground
    there: the fewer points show a curb (BOUNDARY.sure_support), the more must the ground rise that the other
    saw, up to MIN_RISE. Where both measured one curb (BOUNDARY.max_same_curb_distance), each such stretch
    takes the points that scatter less about their line. Where they found different curbs,
    those of the first method are taken.

    points, others : CurbPoints of two methods, the one with the stricter model of a curb first
    edges, other_edges : RoadEdges fitted through each
    seen, others_seen : what each method saw beside the roads
    """
    # the chains of both methods keep apart
    others = replace(others, chain=np.where(others.chain < 0, others.chain, others.chain + SECOND_METHOD_CHAIN_OFFSET))
    parts = []
    for road in frame.roads:
        for side in SIDE_SIGNS:
            first, second = (sample_edges(e, frame, road.number, side) for e in (edges, other_edges))
            take_second = _second_is_better(first, second)
            level = [_level(measured, compared, evidence.chains.get((road.number, side)),
                            compared_evidence.beside.get(road.number, {}).get(side), SIDE_SIGNS[side])
                     for measured, compared, evidence, compared_evidence in ((first, second, seen, others_seen), (second, first, others_seen, seen))]
            for curbs, better in ((points, ~take_second & ~level[0]), (others, take_second & ~level[1])):
                of_side = curbs[(curbs.road == road.number) & (curbs.side == side)]
                parts.append(of_side[better[_node(first.s, of_side.station)]])
    return CurbPoints.join(parts, points.crs)


def _node(s, station):
    """(N,) int, the place among the samples at (N,) stations."""
    return np.clip(np.rint((station - s[0]) / BOUNDARY.comparison_step), 0, len(s) - 1).astype(int)


def _second_is_better(first, second):
    """(N,) bool: is the second edge the one to draw? False where there is neither."""
    measured_by_both = first.measured & second.measured
    with np.errstate(invalid="ignore"):
        one_curb = measured_by_both & (np.abs(first.d - second.d) <= BOUNDARY.max_same_curb_distance)
    better = second.measured & ~first.measured
    # where neither measured, the one that bridges
    better |= ~first.measured & ~second.measured & np.isfinite(second.d) & np.isnan(first.d)
    for a, b in mask_runs(one_curb):
        better[a:b] = second.scatter[a:b].mean() < first.scatter[a:b].mean()
    # no change of method for a line that begins a little before the other
    for a, b in mask_runs(first.measured ^ second.measured):
        if (b - a) * BOUNDARY.comparison_step < BOUNDARY.min_single_method_length:
            if a > 0 and one_curb[a - 1]:
                better[a:b] = better[a - 1]
            elif b < len(better) and one_curb[b]:
                better[a:b] = better[b]
    return better


def _slopes(d):
    """(N,) m per m along of offsets at regular stations, from those of its neighbours that are known; 0 where there are none."""
    steps = np.diff(d) / BOUNDARY.comparison_step
    before, after = np.r_[np.nan, steps], np.r_[steps, np.nan]
    return np.nan_to_num(np.where(np.isnan(before), after, np.where(np.isnan(after), before, 0.5 * (before + after))))


def _level(measured, other, chains, grid, sign):
    """(N,) bool: did one method, whose SideChains are given, measure an edge where the other, whose OcclusionGrid is given, saw level ground?"""
    level, doubtful = np.zeros((2, len(measured.s)), bool)
    unmatched = np.flatnonzero(measured.measured & ~other.measured)
    if grid is None or not len(unmatched):
        return level
    line = measured.s[unmatched], sign * measured.d[unmatched], sign * _slopes(measured.d)[unmatched]
    rise, support = grid.rise(*line), 0.0 if chains is None else chains.support_along(*line)
    doubt = np.clip(1.0 - support / BOUNDARY.sure_support, 0.0, 1.0)
    with np.errstate(invalid="ignore"):
        level[unmatched] = np.abs(rise) < doubt * MIN_RISE   # a fall is something else: the roof of a car, say
        doubtful[unmatched] = (doubt > 0) & ~(level[unmatched] | (rise >= CURBS.least_height))
    # what is left beside such places is too short to be a curb on such evidence
    for a, b in mask_runs(doubtful):
        if (b - a) * BOUNDARY.comparison_step < BOUNDARY.min_single_method_length and (level[max(a - 1, 0)] or level[min(b, len(level) - 1)]):
            level[a:b] = True
    # a place alone says nothing of a curb that goes on on both sides of it
    for a, b in mask_runs(level):
        if b - a == 1:
            level[a:b] = False
    return level


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


# Pieces of curb of either method in line with what both methods chose.
#
# Between parked cars a curb is seen in pieces of a metre. Which method sees a piece well enough depends on where its profiles lie, so each may choose
# the curb before a gap, behind it, or neither. Together they know more ends of curbs than each alone, and between these a piece of either of them
# may lie.

@dataclass(frozen=True)
class _Ends:
    """Curb points before or behind a gap: (N,) m, station, outward offset, height above the expected road and of the curb."""

    s: np.ndarray
    u: np.ndarray
    h: np.ndarray
    height: np.ndarray

    def __getitem__(self, rows: np.ndarray | slice) -> _Ends:
        return _Ends(self.s[rows], self.u[rows], self.h[rows], self.height[rows])


def with_pieces_of_both(points: CurbPoints, chains: Sequence[Mapping[tuple[int, str], SideChains]],
                        beside: Mapping[int, Mapping[str, OcclusionGrid]], survey: Survey) -> CurbPoints:
    """The curb points, and between them pieces of chains that lie in their line, with the places beside these that are hidden.

    points : CurbPoints of the main curbs
    chains : of each method, (number of the road, side) -> SideChains
    beside : number of the road -> side -> OcclusionGrid
    """
    result = [points]
    for road in survey.store.roads():
        main, number = main_curbs_of(points, survey, road)
        pieces = CurbPoints.filled(0, points.crs)
        for side in SIDE_SIGNS:
            of_side = [of_method[road, side] for of_method in chains if (road, side) in of_method]
            pieces = CurbPoints.join([pieces, _pieces_of_side(points, of_side, survey, road, side, number + len(pieces))], points.crs)
        if len(pieces):
            result += [pieces, hidden_beside(pieces[pieces.part == "bottom"], main, beside[road], survey, road)]
    return CurbPoints.join(result, points.crs)


def _pieces_of_side(points, chains, survey, road, side, number):
    """CurbPoints of the pieces in the gaps of one main curb, their chains numbered from `number` on."""
    frame, sign = survey.frame, SIDE_SIGNS[side]
    measured = points[(points.road == road) & (points.side == side) & points.of_main_curb & (points.part == "bottom") & (points.status == "measured")]
    measured = measured[np.argsort(measured.station, kind="stable")]
    curb = _Ends(measured.station, sign * measured.offset, measured.z - expected_height(survey, road, measured.station), measured.height)
    rows: list[dict] = []
    gap = np.diff(curb.s)
    begin = np.flatnonzero((gap > CURBS.max_joined_gap) & (gap <= CURBS.max_line_gap))
    gaps = np.column_stack([curb.s[begin], curb.s[begin + 1]])
    of_methods = [StepsByStation(side_chains.steps) for side_chains in chains]

    def to_plan(s, u):
        return frame.road(road).to_map(s, sign * u)

    for a, b in gaps.tolist():
        before, after = curb[stretch_of(curb.s, a - CURBS.line_fit_length, a)], curb[stretch_of(curb.s, b, b + CURBS.line_fit_length)]
        pieces = [(side_chains, piece) for side_chains, by_station in zip(chains, of_methods)
                  for piece in pieces_between(before, after, by_station, to_plan)]
        # of pieces beside each other the one nearest to the line
        chosen: list[PieceInLine] = []
        for side_chains, piece in sorted(pieces, key=lambda found: found[1].off):
            if all(piece.end < kept.start or piece.start > kept.end for kept in chosen):
                chosen.append(piece)
                rows += side_chains.points(piece.steps, number + len(rows))
    return points_of_rows(survey, road, side, rows, points.crs)
