"""The limits of the road from its edges, as offsets at given stations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...common.arrays import stretch_of
from ..edges.fit import MAX_EDGE_JUMP
from .ground_grid import GroundCells
from .pavement_edge import GrownLimit

if TYPE_CHECKING:
    from ..edges.road_edges import RoadEdges

MAX_OPENING = 30.0       # m of missing edge that is closed by a straight line
EDGE_CONTINUATION = 5.0  # m by which the offset of an edge holds before its first and after its last vertex
MAX_BRIDGED_SKEW = 0.15  # m across per m along of a gap, beside MAX_EDGE_JUMP: tapers widen by 1 in 10 and less


@dataclass
class Carriageway:
    """The surface of one road in rows of station.

    Attributes
    ----------
    cells : GroundCells of the road, R rows and C columns
    height : (R, C) float32 m, local z of the smoothed road
    ground : (R, C) bool, cells that show the road itself
    right, left : (R,) m, offsets of its limits; NaN in rows without road
    right_bounded, left_bounded : (R,) bool, rows in which a measured or bridged edge is the limit
    tolerance : m above or below the height
    grown : {side: GrownLimit} of the sides on which edges are missing
    """

    cells: GroundCells
    height: np.ndarray
    ground: np.ndarray
    right: np.ndarray
    left: np.ndarray
    right_bounded: np.ndarray
    left_bounded: np.ndarray
    tolerance: float
    grown: dict[str, GrownLimit] = field(default_factory=dict)


def edge_offsets(edges: RoadEdges | None, road: int, stations: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Offsets of the road edges at stations.

    Parameters
    ----------
    edges : RoadEdges or None
    road : number of the road
    stations : (N,) m, ascending

    Returns
    -------
    dict of side (left, right) to (offset, measured): `offset` is (N,) m, NaN where there is no edge;
    `measured` is (N,) bool, True where a measured or bridged edge gives the offset. It is False for inferred
    edges and for closed openings. Edges of the pavement count where there is no curb; short openings between them, and beside
    curbs, are closed too.
    """
    found = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        offset = np.full(len(stations), np.nan)
        measured = np.zeros(len(stations), bool)
        for s, d, status in () if edges is None else _lines_of(edges, road, side, edges.of_curb):
            beside = stretch_of(stations, s[0], s[-1])
            here = np.interp(stations[beside], s, d)
            # of two parallel lines the outer one is the limit of the road
            take = ~(sign * offset[beside] > sign * here)
            offset[beside][take] = here[take]
            measured[beside][take] = status != "inferred"
        offset = _continued(stations, offset)
        for s, d, _ in () if edges is None else _lines_of(edges, road, side, ~edges.of_curb):
            beside = stretch_of(stations, s[0], s[-1])
            take = np.isnan(offset[beside])
            offset[beside][take] = np.interp(stations[beside][take], s, d)
            measured[beside][take] = True
        found[side] = _closed(stations, offset), measured
    return found


def rows_with_edge(edges: RoadEdges | None, road: int, stations: np.ndarray, curb: bool) -> dict[str, np.ndarray]:
    """Side (left, right) to (N,) bool, stations (ascending, m) beside which an edge was drawn at a curb, or one of the pavement without a curb."""
    found = {}
    for side in ("left", "right"):
        found[side] = np.zeros(len(stations), bool)
        for s, _, _ in () if edges is None else _lines_of(edges, road, side, edges.of_curb == curb):
            found[side][stretch_of(stations, s[0], s[-1])] = True
    return found


def _lines_of(edges, road, side, wanted):
    """(stations, offsets, status) of those main edges of one side that are wanted, by station."""
    course = edges.course
    for k in np.flatnonzero((edges.road == road) & (edges.side == side) & (edges.part == "bottom") & edges.of_main_curb & wanted):
        s, d = course.s[course.line(k)], course.d[course.line(k)]
        good = np.isfinite(s)
        s, d = s[good], d[good]
        order = np.argsort(s, kind="stable")
        if len(s) > 1:
            yield s[order], d[order], edges.status[k]


def _closed(stations, offset):
    """Offsets with openings closed that the edges before and after them reach across: each holds for EDGE_CONTINUATION beyond its end."""
    known = np.flatnonzero(np.isfinite(offset))
    before, after = known[:-1], known[1:]
    length, shift = stations[after] - stations[before], np.abs(offset[after] - offset[before])
    reached = np.r_[False, (length <= 2 * EDGE_CONTINUATION) & (shift <= MAX_EDGE_JUMP + MAX_BRIDGED_SKEW * length), False]
    if not reached.any():
        return offset
    inside = np.isnan(offset) & reached[np.searchsorted(stations[known], stations)]
    return np.where(inside, np.interp(stations, stations[known], offset[known]), offset)


def _continued(stations, offset):
    """Offsets with short openings closed by a straight line and the ends continued."""
    known = np.flatnonzero(np.isfinite(offset))
    if not len(known):
        return offset
    filled = np.interp(stations, stations[known], offset[known])
    after = np.searchsorted(stations[known], stations)
    s0 = stations[known][np.maximum(after - 1, 0)]
    s1 = stations[known][np.minimum(after, len(known) - 1)]
    between = (after > 0) & (after < len(known))
    near = np.minimum(np.abs(stations - s0), np.abs(stations - s1)) <= EDGE_CONTINUATION
    return np.where(np.isfinite(offset), offset, np.where((between & (s1 - s0 <= MAX_OPENING)) | near, filled, np.nan))
