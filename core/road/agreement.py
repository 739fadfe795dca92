"""How far apart two sets of road edges lie where both follow one curb, and which of the two to draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from ..common.features import Features
from ..common.schemas import AGREE, END, LENGTH, ROAD, SIDE, STATION, of_main_curb
from ..survey.frame.road_frame import RoadFrame
from .common.sides import SIDE_SIGNS

COMPARISON_STEP = 0.5             # m along the road between places that are compared
MAX_SAME_CURB_DISTANCE = 0.25     # m across within which two lines follow one curb
MIN_REPORTED_DIFFERENCE = 0.05    # m across above which a stretch is reported
AGREEMENT_QUANTILE = 0.95         # quantile of the distances that stands for a piece
MIN_REPORTED_LENGTH = 1.0         # m of a stretch that is reported
MIN_SINGLE_METHOD_LENGTH = 2.0    # m that one line must continue beyond the other to be drawn in its place
SECOND_METHOD_CHAIN_OFFSET = 100_000  # added to the chain numbers of the second method, to keep both apart

BOUNDARY_DIFFERENCES = [ROAD, SIDE, STATION, END, AGREE, LENGTH]


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


def sample_edges(edges: Features, frame: RoadFrame, road: int, side: str) -> EdgeSamples:
    """The edges of one side of a road at regular stations.

    Parameters
    ----------
    edges : Features ROAD_EDGES
    frame : RoadFrame
    road : number of the road
    side : "left" or "right"
    """
    line = frame.road(road)
    first, last = int(np.floor(line.start / COMPARISON_STEP)), int(np.ceil(line.end / COMPARISON_STEP))
    s = np.arange(first, last + 1) * COMPARISON_STEP
    samples = EdgeSamples(s, np.full(len(s), np.nan), np.full(len(s), np.nan), np.zeros(len(s), bool), np.full(len(s), np.inf))
    for geometry, row in edges:
        if row["road"] != road or row["side"] != side or row["status"] == "inferred" or row.get("part", "bottom") != "bottom" \
                or not of_main_curb(row):
            continue
        x, y, z = shapely.get_coordinates(geometry, include_z=True).T
        x, y, z = frame.to_local(x, y, z)
        at, d = line.locate(x, y)
        good = np.isfinite(at)
        at, d, z = at[good], d[good], z[good]
        if len(at) < 2:
            continue
        order = np.argsort(at, kind="stable")
        at, d, z = at[order], d[order], z[order]
        inside = np.flatnonzero((s >= at[0] - COMPARISON_STEP / 2) & (s <= at[-1] + COMPARISON_STEP / 2))
        samples.d[inside], samples.z[inside] = np.interp(s[inside], at, d), np.interp(s[inside], at, z)
        samples.measured[inside] = row["status"] == "measured"
        samples.scatter[inside] = row["rmse_m"]
    return samples


def select_curb_points(points: Features, others: Features, edges: Features, other_edges: Features, frame: RoadFrame) -> Features:
    """At every place the curb points of that method whose edge measures better there.

    Where one method alone measured, its points are taken. Where both measured one curb
    (MAX_SAME_CURB_DISTANCE), each such stretch takes the points that scatter less about their
    line. Where they found different curbs, those of the first method are taken.

    Parameters
    ----------
    points, others : Features CURB_POINTS of two methods, the one with the stricter model of a curb first
    edges, other_edges : Features ROAD_EDGES fitted through each
    frame : RoadFrame

    Returns
    -------
    Features CURB_POINTS
    """
    found = Features(points.geometry_type, list(points.schema), crs=points.crs)
    for road in frame.roads:
        for side in SIDE_SIGNS:
            first, second = (sample_edges(e, frame, road.number, side) for e in (edges, other_edges))
            take_second = _second_is_better(first, second)
            for number, features in enumerate((points, others)):
                better = take_second if number else ~take_second
                for geometry, row in features:
                    if row["road"] == road.number and row["side"] == side and better[_node(first.s, row["station_m"])]:
                        chain = row.get("chain")
                        found.add(geometry, **dict(row, chain=None if chain is None else chain + number * SECOND_METHOD_CHAIN_OFFSET))
    return found


def _node(s, station):
    return int(np.clip(np.rint((station - s[0]) / COMPARISON_STEP), 0, len(s) - 1))


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


def mask_runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """(first, last + 1) of every run of True in (N,) bool."""
    change = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(np.int8)))
    return list(zip(change[::2].tolist(), change[1::2].tolist()))


def measure_agreement(edges: Features, first_edges: Features, second_edges: Features, frame: RoadFrame) -> Features:
    """Write into `agree_cm` of every edge how far apart two sets of edges lie beside it, and report where that is much.

    The number is the distance that 95 % of the piece does not exceed, NULL where one of the
    two sets has no line. It is measured across the road, every COMPARISON_STEP metres.

    Parameters
    ----------
    edges : Features ROAD_EDGES that are drawn; `agree_cm` is filled in
    first_edges, second_edges : Features ROAD_EDGES of two methods
    frame : RoadFrame

    Returns
    -------
    Features BOUNDARY_DIFFERENCES: LineStringZ along the drawn edges, one for every stretch where
    the two lie more than MIN_REPORTED_DIFFERENCE apart, `agree_cm` their largest distance there
    """
    differences = Features("LineStringZ", list(BOUNDARY_DIFFERENCES), crs=edges.crs)
    for road in frame.roads:
        for side in SIDE_SIGNS:
            first, second, drawn = (sample_edges(e, frame, road.number, side) for e in (first_edges, second_edges, edges))
            apart = np.abs(first.d - second.d)
            for row in edges.rows:
                if row["road"] == road.number and row["side"] == side:
                    beside = apart[(first.s >= row["station_m"]) & (first.s <= row["end_m"])]
                    beside = beside[np.isfinite(beside)]
                    if len(beside):
                        row["agree_cm"] = round(100 * float(np.quantile(beside, AGREEMENT_QUANTILE)), 1)
            with np.errstate(invalid="ignore"):
                differing = (apart > MIN_REPORTED_DIFFERENCE) & np.isfinite(drawn.d)
            for a, b in mask_runs(differing):
                if (b - a) * COMPARISON_STEP < MIN_REPORTED_LENGTH:
                    continue
                x, y, z = frame.to_map(road.number, first.s[a:b], drawn.d[a:b], drawn.z[a:b])
                line = shapely.linestrings(np.round(np.c_[x, y, z], 4))
                differences.add(line, road=road.number, side=side, station_m=float(first.s[a]), end_m=float(first.s[b - 1]),
                                agree_cm=round(100 * float(apart[a:b].max()), 1), length_m=round(line.length, 3))
    return differences
