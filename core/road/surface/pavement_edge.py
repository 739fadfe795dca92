"""Pavement edges: where a road without a curb ends at a verge, a ditch or a yard.

The edge is a change of height, tilt, roughness or brightness across profiles of 5 m of road that continues along it. The rules
are our own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...common.parallel import by_rows
from .edge_path import cheapest_path
from .ground_change import HalfProfiles, other_ground_begins
from .ground_grid import PROFILE_COLUMN, PROFILE_ROW, GroundCells, SurfaceProfiles, known_median
from .pavement_limit import pavement_limits

POOLED_ROWS, ROWS_PER_STEP = 5, 2  # rows of cells that make one profile, and rows from one profile to the next: 5 m every 2 m
MAX_MISS = 1.5               # m by which a profile may miss the edge and say so, farther is no worse
BLIND_SHARE = 0.3            # of the miss of a limit farther out than a profile that ends where nothing was measured
WIDENING_COST = 1.5            # m of misses that a change of the edge by 1 m must save: three profiles (6 m) in a row
LARGEST_WIDENING_COST = 3.0    # m of misses that any change must save: a street joins over at least five profiles (10 m)


@dataclass(frozen=True)
class PooledProfiles:
    """The ground across the road every ROWS_PER_STEP rows of SurfaceProfiles: medians of the cells of POOLED_ROWS rows.

    stations : (Q,) m; height, rough, brightness : (Q, K)
    """

    stations: np.ndarray
    height: np.ndarray
    rough: np.ndarray
    brightness: np.ndarray

    @classmethod
    def of(cls, rows: SurfaceProfiles) -> PooledProfiles:
        """Those of P rows."""
        return cls(rows.stations[::ROWS_PER_STEP], *(_pooled(values) for values in (rows.height, rows.rough, rows.brightness)))


def _pooled(values):
    """(Q, K) medians of (P, K) cells."""
    half = POOLED_ROWS // 2

    def medians(some):
        first, end = some.start * ROWS_PER_STEP - half, (some.stop - 1) * ROWS_PER_STEP + half + 1
        here = np.pad(values[max(first, 0):end], ((max(-first, 0), max(end - len(values), 0)), (0, 0)), constant_values=np.nan)
        return known_median(np.lib.stride_tricks.sliding_window_view(here, POOLED_ROWS, axis=0)[::ROWS_PER_STEP], 2)

    return by_rows(medians, -(-len(values) // ROWS_PER_STEP))


@dataclass(frozen=True)
class GrownLimit:
    """The limit of a road on a side without an edge, on R rows.

    offset : (R,) m, of the edge of the pavement
    sigma : (R,) m, one sigma of a single row, of places that are known to the gap between two measured cells
    shown : (R,) bool, whether it was measured as an edge; where it is not, the road ends there for want of better
    likely : (R,) bool, whether it is rather an edge than not
    hidden : (R,) bool, whether hardly anything was measured right behind it
    """

    offset: np.ndarray
    sigma: np.ndarray
    shown: np.ndarray
    likely: np.ndarray
    hidden: np.ndarray


def grown_limit(profiles: SurfaceProfiles, cells: GroundCells, height: np.ndarray, prior: np.ndarray, sign: int | float, track: np.ndarray,
                max_width: float) -> GrownLimit:
    """The limit of the road on a side without an edge.

    Every profile is searched outward from the track. The ground changes where, over 0.4 m, it is off the height of the
    road, tilts away, or is rougher than the road before it. The path along the road that most profiles agree with is
    the limit. Where nothing was measured beyond, the limit may lie farther out. A strip of another brightness before the change
    (gravel along the asphalt) does not belong to the road either.

    Parameters
    ----------
    profiles : SurfaceProfiles
    cells : GroundCells of the road, R rows and C columns
    height : (R, C) m, local z of the road
    prior : (R,) m, its expected height, above which that of profiles counts
    sign : 1 for the left side, -1 for the right
    track : (R,) m, offset of the outermost track on that side
    max_width : m from the track

    Returns
    -------
    GrownLimit
    """
    stations = cells.stations
    nowhere = np.zeros(len(stations), bool)
    rows = profiles.side(sign)
    above = by_rows(lambda some: rows.height[some] - _rise(height, prior, cells, rows.stations[some], sign * rows.offsets), len(rows.stations))
    rows = replace(rows, height=above)
    pooled = PooledProfiles.of(rows)
    beside = sign * np.interp(pooled.stations, stations, track)
    halves = HalfProfiles(rows.offsets, pooled.height, pooled.rough)
    changes = halves.changes(beside, max_width)
    known = np.flatnonzero(changes >= 0)
    if not len(known):
        return GrownLimit(track + sign * max_width, np.full(len(track), np.inf), nowhere, nowhere, ~nowhere)
    # at the last cell, nothing beyond it was looked for
    blind = np.pad(halves.blind(), ((0, 0), (0, 1)))[np.arange(len(changes)), changes]
    changes = np.interp(pooled.stations, pooled.stations[known], _agreed(changes[known], blind[known], len(rows.offsets)))
    other = other_ground_begins(pooled.brightness, pooled.stations, (beside - rows.offsets[0]) / PROFILE_COLUMN, changes)
    changes = np.interp(rows.stations, pooled.stations, np.where(np.isfinite(other), other, changes))
    found = pavement_limits(rows, changes)
    outward = np.interp(stations, rows.stations, rows.offsets[0] + (found.cell - 0.5) * PROFILE_COLUMN)
    row = np.clip(np.searchsorted(rows.stations + 0.5 * PROFILE_ROW, stations), 0, len(rows.stations) - 1)
    farthest = sign * track + max_width
    return GrownLimit(sign * np.minimum(outward, farthest), found.gap[row] * PROFILE_COLUMN / np.sqrt(12.0), found.shown[row] & (outward < farthest),
                      found.likely[row] & (outward < farthest), found.hidden[row])


def _agreed(changes, blind, cells):
    """(P,) cell at which the ground changes, along the path that most profiles agree with."""
    miss = (np.arange(cells + 1) - changes[:, None]) * PROFILE_COLUMN
    cost = np.minimum(np.abs(miss), MAX_MISS)
    return cheapest_path(np.where(blind[:, None] & (miss > 0), BLIND_SHARE * cost, cost), WIDENING_COST * PROFILE_COLUMN, LARGEST_WIDENING_COST)


def _rise(height, prior, cells, stations, offsets):
    """Bilinear height of the road above its expected one at stations and offsets."""
    row = np.clip(stations / cells.row_size - cells.first_row - 0.5, 0, len(height) - 1)
    column = np.clip(offsets / cells.column_size - cells.first_column - 0.5, 0, height.shape[1] - 1)
    i, j = np.minimum(row.astype(int), len(height) - 2), np.minimum(column.astype(int), height.shape[1] - 2)
    first, end = int(i.min()), int(i.max()) + 2
    grid = height[first:end] - prior[first:end, None]
    a, b = (row - i)[:, None], (column - j)[None, :]
    i = i - first
    return ((1 - a) * ((1 - b) * grid[np.ix_(i, j)] + b * grid[np.ix_(i, j + 1)])
            + a * ((1 - b) * grid[np.ix_(i + 1, j)] + b * grid[np.ix_(i + 1, j + 1)]))
