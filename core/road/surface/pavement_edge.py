"""Pavement edges: where a road without a curb ends at a verge, a ditch or a yard.

The edge is a change of height, tilt, roughness or brightness across profiles of 5 m of road that continues along it. The rules are our own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.ndimage import map_coordinates, uniform_filter1d

from ...common.arrays import stretch_of
from ...common.parallel import by_rows
from ..edges.road_edges import RoadEdges
from ..weights import EDGE, SURFACE
from .ground_change import HalfProfiles, other_ground_begins
from .ground_grid import GroundCells, SurfaceProfiles, known_median, roughness_of_rows, sum_about
from .pavement_limit import cheapest_path, pavement_limits


def _pooled(values):
    """(Q, K) medians of the cells of SURFACE.pooled_rows of (P, K) rows, every SURFACE.rows_per_step rows."""
    half = SURFACE.pooled_rows // 2

    def medians(some):
        first, end = some.start * SURFACE.rows_per_step - half, (some.stop - 1) * SURFACE.rows_per_step + half + 1
        padded = np.pad(values[max(first, 0):end], ((max(-first, 0), max(end - len(values), 0)), (0, 0)), constant_values=np.nan)
        return known_median(np.lib.stride_tricks.sliding_window_view(padded, SURFACE.pooled_rows, axis=0)[::SURFACE.rows_per_step], 2)

    return by_rows(medians, -(-len(values) // SURFACE.rows_per_step))


@dataclass(frozen=True)
class _GrownLimit:
    """The limit of a road on a side without an edge, on R rows."""

    offset: np.ndarray   # (R,) m, of the edge of the pavement
    sigma: np.ndarray   # (R,) m, one sigma of a single row, of places that are known to the gap between two measured cells
    shown: np.ndarray   # (R,) bool, whether it was measured as an edge; where it is not, the road ends there for want of better
    likely: np.ndarray   # (R,) bool, whether it is rather an edge than not
    hidden: np.ndarray   # (R,) bool, whether hardly anything was measured right behind it
    guess: np.ndarray   # (R,) m, one sigma of where the pavement ends as height alone shows: anywhere from there to the drive
    inferred: np.ndarray   # (R,) bool, whether height alone shows it on most rows about it


def grown_limit(profiles: SurfaceProfiles, cells: GroundCells, height: np.ndarray, prior: np.ndarray, sign: int | float, track: np.ndarray,
                max_width: float) -> _GrownLimit:
    """The limit of the road on a side without an edge.

    Every profile is searched outward from the track. The ground changes where, over 0.4 m, it is off the height of the road, tilts away, or is
    rougher than the road before it. The path along the road that most profiles agree with is the limit. Where nothing was measured beyond, the limit
    may lie farther out. A strip of another brightness before the change (gravel along the asphalt) does not belong to the road either.

    cells : GroundCells of the road, R rows and C columns
    height : (R, C) m, local z of the road
    prior : (R,) m, its expected height, above which that of profiles counts
    sign : 1 for the left side, -1 for the right
    track : (R,) m, offset of the outermost track on that side
    max_width : m from the track

    Returns _GrownLimit
    """
    stations = cells.stations
    nowhere = np.zeros(len(stations), bool)
    rows = profiles.side(sign)
    above = by_rows(lambda some: rows.height[some] - _rise(height, prior, cells, rows.stations[some], sign * rows.offsets), len(rows.stations))
    rows = replace(rows, height=above)
    places = rows.stations[::SURFACE.rows_per_step]
    pooled_height, brightness = _pooled(rows.height), _pooled(rows.brightness)
    rough = roughness_of_rows(rows.rough, rows.freedom, _pooled, lambda values: sum_about(values, SURFACE.pooled_rows // 2)[::SURFACE.rows_per_step])
    track_offset = sign * np.interp(places, stations, track)
    halves = HalfProfiles(rows.offsets, pooled_height, rough)
    changes = halves.changes(track_offset, max_width)
    measured = np.flatnonzero(changes >= 0)
    if not len(measured):
        return _GrownLimit(track + sign * max_width, np.full(len(track), np.inf), nowhere, nowhere, ~nowhere, 0.0 * track, nowhere)
    # at the last cell, nothing beyond it was looked for
    blind = np.pad(halves.blind(), ((0, 0), (0, 1)))[np.arange(len(changes)), changes]
    changes = np.interp(places, places[measured], _agreed(changes[measured], blind[measured], len(rows.offsets)))
    brighter = other_ground_begins(brightness, (track_offset - rows.offsets[0]) / SURFACE.profile_column, changes)
    changes = np.interp(rows.stations, places, np.where(np.isfinite(brighter), brighter, changes))
    limits = pavement_limits(rows, changes)
    outward = np.interp(stations, rows.stations, rows.offsets[0] + (limits.cell - 0.5) * SURFACE.profile_column)
    row = np.clip(np.searchsorted(rows.stations + 0.5 * SURFACE.profile_row, stations), 0, len(rows.stations) - 1)
    farthest = sign * track + max_width
    within = outward < farthest
    # derived: root mean square of places that are evenly probable, from the outermost one
    guess = np.maximum(outward - sign * track - SURFACE.certain_road, 0.0) / np.sqrt(3.0)
    by_height = uniform_filter1d((~limits.look[row]).astype(float), int(SURFACE.agreeing_length / SURFACE.row_length) | 1) > 0.5
    return _GrownLimit(sign * np.minimum(outward, farthest), limits.gap[row] * SURFACE.profile_column / np.sqrt(12.0),
                       limits.shown[row] & within, limits.likely[row] & within, limits.hidden[row], guess, by_height)


def _agreed(changes, blind, cells):
    """(P,) cell at which the ground changes, along the path that most profiles agree with."""
    miss = (np.arange(cells + 1) - changes[:, None]) * SURFACE.profile_column
    cost = np.minimum(np.abs(miss), SURFACE.max_miss)
    return cheapest_path(np.where(blind[:, None] & (miss > 0), SURFACE.blind_share * cost, cost), SURFACE.widening_cost * SURFACE.profile_column,
                         SURFACE.largest_widening_cost)


def _rise(height, prior, cells, stations, offsets):
    """Bilinear height of the road above its expected one at stations and offsets."""
    row, column = stations / cells.row_size - cells.first_row - 0.5, offsets / cells.column_size - cells.first_column - 0.5
    first = max(int(row.min()), 0)
    part = slice(first, int(row.max()) + 2)
    return map_coordinates(height[part] - prior[part, None], np.meshgrid(row - first, column, indexing="ij"), order=1, mode="nearest")


# The limits of the road from its edges, as offsets at given stations.


@dataclass
class Carriageway:
    """The surface of one road in rows of station."""

    cells: GroundCells   # GroundCells of the road, R rows and C columns
    height: np.ndarray   # (R, C) float32 m, local z of the smoothed road
    ground: np.ndarray   # (R, C) bool, cells that show the road itself
    right: np.ndarray   # right, left: (R,) m, offsets of its limits; NaN in rows without road
    left: np.ndarray
    right_bounded: np.ndarray   # right_bounded, left_bounded: (R,) bool, rows in which a measured or bridged edge is the limit
    left_bounded: np.ndarray
    tolerance: float   # m above or below the height
    grown: dict[str, _GrownLimit] = field(default_factory=dict)   # {side: _GrownLimit} of the sides on which edges are missing


def edge_offsets(edges: RoadEdges | None, road: int, stations: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Offsets of the road edges at stations.

    stations : (N,) m, ascending

    Returns dict of side (left, right) to (offset, measured): `offset` is (N,) m, NaN where there is no edge; `measured` is (N,) bool, True where a
    measured or bridged edge gives the offset. It is False for inferred edges and for closed openings. Edges of the pavement count where there is no
    curb; short openings between them, and beside curbs, are closed too.
    """
    result = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        offset = np.full(len(stations), np.nan)
        measured = np.zeros(len(stations), bool)
        for s, d, status in () if edges is None else _lines_of(edges, road, side, edges.of_curb):
            inside = stretch_of(stations, s[0], s[-1])
            line_offset = np.interp(stations[inside], s, d)
            # of two parallel lines the outer one is the limit of the road
            take = ~(sign * offset[inside] > sign * line_offset)
            offset[inside][take] = line_offset[take]
            measured[inside][take] = status != "inferred"
        offset = _continued(stations, offset)
        for s, d, status in () if edges is None else _lines_of(edges, road, side, ~edges.of_curb):
            inside = stretch_of(stations, s[0], s[-1])
            take = np.isnan(offset[inside])
            offset[inside][take] = np.interp(stations[inside][take], s, d)
            measured[inside][take] = status != "inferred"
        result[side] = _closed(stations, offset), measured
    return result


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
    """Offsets with openings closed that the edges before and after them reach across: each holds for SURFACE.edge_continuation beyond its end."""
    rows = np.flatnonzero(np.isfinite(offset))
    before, after = rows[:-1], rows[1:]
    length, shift = stations[after] - stations[before], np.abs(offset[after] - offset[before])
    reached = np.r_[False, (length <= 2 * SURFACE.edge_continuation) & (shift <= EDGE.max_edge_jump + SURFACE.max_bridged_skew * length), False]
    if not reached.any():
        return offset
    inside = np.isnan(offset) & reached[np.searchsorted(stations[rows], stations)]
    return np.where(inside, np.interp(stations, stations[rows], offset[rows]), offset)


def _continued(stations, offset):
    """Offsets with short openings closed by a straight line and the ends continued."""
    rows = np.flatnonzero(np.isfinite(offset))
    if not len(rows):
        return offset
    filled = np.interp(stations, stations[rows], offset[rows])
    after = np.searchsorted(stations[rows], stations)
    s0 = stations[rows][np.maximum(after - 1, 0)]
    s1 = stations[rows][np.minimum(after, len(rows) - 1)]
    between = (after > 0) & (after < len(rows))
    near = np.minimum(np.abs(stations - s0), np.abs(stations - s1)) <= SURFACE.edge_continuation
    return np.where(np.isfinite(offset), offset, np.where((between & (s1 - s0 <= SURFACE.max_opening)) | near, filled, np.nan))
