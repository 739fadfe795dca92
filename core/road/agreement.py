"""How far apart two sets of road edges lie where both follow one curb, and which of the two to draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..common.arrays import mask_runs, stretch_of
from ..survey.frame.road_frame import RoadFrame
from .common.corners import CANDIDATE_HEIGHT_SHARE
from .common.curb_limits import LEAST_HEIGHT
from .common.curb_points import CurbPoints
from .common.occlusion import OcclusionGrid
from .common.side_chains import SideChains
from .common.sides import SIDE_SIGNS
from .edges.road_edges import EdgePiece, RoadEdges, joined_pieces

COMPARISON_STEP = 0.5             # m along the road between places that are compared
MAX_SAME_CURB_DISTANCE = 0.25     # m across within which two lines follow one curb
MIN_REPORTED_DIFFERENCE = 0.05    # m across above which a stretch is reported
AGREEMENT_QUANTILE = 0.95         # quantile of the distances that stands for a piece
MIN_REPORTED_LENGTH = 1.0         # m of a stretch that is reported
MIN_SINGLE_METHOD_LENGTH = 2.0    # m that one line must continue beyond the other to be drawn in its place
MIN_RISE = CANDIDATE_HEIGHT_SHARE * LEAST_HEIGHT  # m from one side of a place to the other below which ground is level
SURE_SUPPORT = 80.0               # points per metre of road that show a step beyond doubt
SECOND_METHOD_CHAIN_OFFSET = 100_000  # added to the chain numbers of the second method, to keep both apart


@dataclass(frozen=True)
class CurbEvidence:
    """What a method saw beside the roads.

    Attributes
    ----------
    chains : (number of the road, side) -> SideChains
    beside : number of the road -> side -> OcclusionGrid
    """

    chains: Mapping[tuple[int, str], SideChains] = field(default_factory=dict)
    beside: Mapping[int, Mapping[str, OcclusionGrid]] = field(default_factory=dict)


@dataclass
class EdgeSamples:
    """The edges of one side of a road at N places COMPARISON_STEP apart.

    Attributes
    ----------
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


def sample_edges(edges: RoadEdges, frame: RoadFrame, road: int, side: str) -> EdgeSamples:
    """The edges of one side of a road at regular stations.

    Parameters
    ----------
    edges : RoadEdges
    frame : RoadFrame
    road : number of the road
    side : "left" or "right"
    """
    line = frame.road(road)
    first, last = int(np.floor(line.start / COMPARISON_STEP)), int(np.ceil(line.end / COMPARISON_STEP))
    s = np.arange(first, last + 1) * COMPARISON_STEP
    samples = EdgeSamples(s, np.full(len(s), np.nan), np.full(len(s), np.nan), np.zeros(len(s), bool), np.full(len(s), np.inf))
    course = edges.course
    for k in np.flatnonzero((edges.road == road) & (edges.side == side) & (edges.status != "inferred") & (edges.part == "bottom")
                            & edges.of_main_curb):
        vertices = course.line(k)
        good = np.isfinite(course.s[vertices])
        at, d, z = (values[vertices][good] for values in (course.s, course.d, course.z))
        if len(at) < 2:
            continue
        order = np.argsort(at, kind="stable")
        at, d, z = at[order], d[order], z[order]
        inside = stretch_of(s, at[0] - COMPARISON_STEP / 2, at[-1] + COMPARISON_STEP / 2)
        samples.d[inside], samples.z[inside] = np.interp(s[inside], at, d), np.interp(s[inside], at, z)
        samples.measured[inside] = edges.status[k] == "measured"
        samples.scatter[inside] = edges.rmse[k]
    return samples


def select_curb_points(points: CurbPoints, others: CurbPoints, edges: RoadEdges, other_edges: RoadEdges, frame: RoadFrame,
                       seen: CurbEvidence = CurbEvidence(), others_seen: CurbEvidence = CurbEvidence()) -> CurbPoints:
    """At every place the curb points of that method whose edge measures better there.

    Where one method alone measured, its points are taken, unless the other saw level ground
    there: the fewer points show a curb (SURE_SUPPORT), the more must the ground rise that the other
    saw, up to MIN_RISE. Where both measured one curb (MAX_SAME_CURB_DISTANCE), each such stretch
    takes the points that scatter less about their line. Where they found different curbs,
    those of the first method are taken.

    Parameters
    ----------
    points, others : CurbPoints of two methods, the one with the stricter model of a curb first
    edges, other_edges : RoadEdges fitted through each
    frame : RoadFrame
    seen, others_seen : what each method saw beside the roads

    Returns
    -------
    CurbPoints
    """
    # the chains of both methods keep apart
    others = replace(others, chain=np.where(others.chain < 0, others.chain, others.chain + SECOND_METHOD_CHAIN_OFFSET))
    found = []
    for road in frame.roads:
        for side in SIDE_SIGNS:
            first, second = (sample_edges(e, frame, road.number, side) for e in (edges, other_edges))
            take_second = _second_is_better(first, second)
            level = [_level(measured, other, shown.chains.get((road.number, side)), known.beside.get(road.number, {}).get(side), SIDE_SIGNS[side])
                     for measured, other, shown, known in ((first, second, seen, others_seen), (second, first, others_seen, seen))]
            for curbs, better in ((points, ~take_second & ~level[0]), (others, take_second & ~level[1])):
                own = curbs[(curbs.road == road.number) & (curbs.side == side)]
                found.append(own[better[_node(first.s, own.station)]])
    return CurbPoints.join(found, points.crs)


def _node(s, station):
    """(N,) int, the place among the samples at (N,) stations."""
    return np.clip(np.rint((station - s[0]) / COMPARISON_STEP), 0, len(s) - 1).astype(int)


def _second_is_better(first, second):
    """(N,) bool: is the second edge the one to draw? False where there is neither."""
    both = first.measured & second.measured
    with np.errstate(invalid="ignore"):
        one_curb = both & (np.abs(first.d - second.d) <= MAX_SAME_CURB_DISTANCE)
    better = second.measured & ~first.measured
    # where neither measured, the one that bridges
    better |= ~first.measured & ~second.measured & np.isfinite(second.d) & np.isnan(first.d)
    for a, b in mask_runs(one_curb):
        better[a:b] = second.scatter[a:b].mean() < first.scatter[a:b].mean()
    # no change of method for a line that begins a little before the other
    for a, b in mask_runs(first.measured ^ second.measured):
        if (b - a) * COMPARISON_STEP < MIN_SINGLE_METHOD_LENGTH:
            if a > 0 and one_curb[a - 1]:
                better[a:b] = better[a - 1]
            elif b < len(better) and one_curb[b]:
                better[a:b] = better[b]
    return better


def _slopes(d):
    """(N,) m per m along of offsets at regular stations, from those of its neighbours that are known; 0 where there are none."""
    steps = np.diff(d) / COMPARISON_STEP
    before, after = np.r_[np.nan, steps], np.r_[steps, np.nan]
    return np.nan_to_num(np.where(np.isnan(before), after, np.where(np.isnan(after), before, 0.5 * (before + after))))


def _level(measured, other, chains, grid, sign):
    """(N,) bool: did one method, whose SideChains are given, measure an edge where the other, whose OcclusionGrid is given, saw level ground?"""
    level, doubtful = np.zeros((2, len(measured.s)), bool)
    alone = np.flatnonzero(measured.measured & ~other.measured)
    if grid is None or not len(alone):
        return level
    line = measured.s[alone], sign * measured.d[alone], sign * _slopes(measured.d)[alone]
    rise, support = grid.rise(*line), 0.0 if chains is None else chains.support_along(*line)
    doubt = np.clip(1.0 - support / SURE_SUPPORT, 0.0, 1.0)
    with np.errstate(invalid="ignore"):
        level[alone] = np.abs(rise) < doubt * MIN_RISE   # a fall is something else: the roof of a car, say
        doubtful[alone] = (doubt > 0) & ~(level[alone] | (rise >= LEAST_HEIGHT))
    # what is left beside such places is too short to be a curb on such evidence
    for a, b in mask_runs(doubtful):
        if (b - a) * COMPARISON_STEP < MIN_SINGLE_METHOD_LENGTH and (level[max(a - 1, 0)] or level[min(b, len(level) - 1)]):
            level[a:b] = True
    # a place alone says nothing of a curb that goes on on both sides of it
    for a, b in mask_runs(level):
        if b - a == 1:
            level[a:b] = False
    return level


def measure_agreement(edges: RoadEdges, first_edges: RoadEdges, second_edges: RoadEdges, frame: RoadFrame) -> tuple[RoadEdges, RoadEdges]:
    """How far apart two sets of edges lie beside every edge, and where that is much.

    The number is the distance that 95 % of the piece does not exceed, NaN where one of the
    two sets has no line. It is measured across the road, every COMPARISON_STEP metres.

    Parameters
    ----------
    edges : RoadEdges that are drawn
    first_edges, second_edges : RoadEdges of two methods
    frame : RoadFrame

    Returns
    -------
    edges : RoadEdges with `agree`
    differences : RoadEdges, lines along the drawn edges, one for every stretch where the two lie more
        than MIN_REPORTED_DIFFERENCE apart, `agree` their largest distance there
    """
    agree = edges.agree.copy()
    differences: list[EdgePiece] = []
    for road in frame.roads:
        for side in SIDE_SIGNS:
            first, second, drawn = (sample_edges(e, frame, road.number, side) for e in (first_edges, second_edges, edges))
            apart = np.abs(first.d - second.d)
            for k in np.flatnonzero((edges.road == road.number) & (edges.side == side)):
                beside = apart[stretch_of(first.s, edges.station[k], edges.end[k])]
                beside = beside[np.isfinite(beside)]
                if len(beside):
                    agree[k] = round(100 * float(np.quantile(beside, AGREEMENT_QUANTILE)), 1)
            with np.errstate(invalid="ignore"):
                differing = (apart > MIN_REPORTED_DIFFERENCE) & np.isfinite(drawn.d)
            for a, b in mask_runs(differing):
                if (b - a) * COMPARISON_STEP < MIN_REPORTED_LENGTH:
                    continue
                x, y, z = frame.to_map(road.number, first.s[a:b], drawn.d[a:b], drawn.z[a:b])
                differences.append(EdgePiece(
                    np.c_[x, y, z], road.number, side, "measured", len(differences), float(first.s[a]), float(first.s[b - 1]),
                    float(np.hypot(np.diff(x), np.diff(y)).sum()), agree=100 * float(apart[a:b].max())))
    return replace(edges, agree=agree), joined_pieces(differences, frame, edges.crs)
