"""Pavement edges: where a road without a curb ends at a verge, a ditch or a yard.

The edge is a change of height, tilt, roughness or brightness across profiles of 5 m of road that continues along it. The rules
are our own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...survey.store.records import Points
from .edge_path import cheapest_path
from .ground_grid import GroundCells, ground_cells, known_median
from .pavement_limit import pavement_limits
from .region_growing import MAX_HEIGHT_DEVIATION

PROFILE_ROW, PROFILE_COLUMN = 1.0, 0.1  # m along and across the road, size of a cell
POOLED_ROWS, ROWS_PER_STEP = 5, 2  # rows of cells that make one profile, and rows from one profile to the next: 5 m every 2 m
CERTAIN_ROAD = 1.2           # m beside the track that belong to the road: the vehicle drove there
MIN_CHANGE_CELLS = 4         # cells over which a change must last
MAX_HEIGHT_CHANGE = 0.025    # m from the median height of the cells before
UNEVENNESS_FACTOR = 2.0      # times the unevenness of the road, added to either height limit
ROUGHNESS_FACTOR, ROUGHNESS_FLOOR = 1.6, 0.0025  # times the roughness of the road, and m added to it
MIN_TILT_CHANGE = 0.10       # m per m: change of tilt at which a bank or a ditch begins
MAX_EMPTY_GROUND_CELLS = 5   # consecutive cells without points at which the road ends,
MAX_BLIND_CELLS = 12         # unless at most so many are empty and road follows: the blind zone beside the vehicle
OBSTACLE_HEIGHT = 0.25       # m above the road of a cell that hides the road behind it, such as the side of a car,
OBSTACLE_CELLS = 5           # where road follows within so many cells
MIN_AGREEING_SHARE = 0.7     # of the cells ahead that must show the change
MAX_MISS = 1.5               # m by which a profile may miss the edge and say so, farther is no worse
BLIND_SHARE = 0.3            # of the miss of a limit farther out than a profile that ends where nothing was measured
WIDENING_COST = 1.5            # m of misses that a change of the edge by 1 m must save: three profiles (6 m) in a row
LARGEST_WIDENING_COST = 3.0    # m of misses that any change must save: a street joins over at least five profiles (10 m)


@dataclass
class SurfaceProfiles:
    """The ground across the road: P rows of 1 m length with K cells of 0.1 m.

    Attributes
    ----------
    stations : (P,) m, middles of the rows
    offsets : (K,) m, middles of the cells, ascending
    height : (P, K) m above the expected height of the road under the vehicle
    rough : (P, K) m
    brightness, scatter : (P, K) raw counts, as in GroundCells; NaN where nothing was measured
    """

    stations: np.ndarray
    offsets: np.ndarray
    height: np.ndarray
    rough: np.ndarray
    brightness: np.ndarray
    scatter: np.ndarray

    NAMES = ("height", "rough", "brightness", "scatter")

    @classmethod
    def of(cls, points: Points, start: float, length: float, reach: float,
           road_height: Callable[[np.ndarray], np.ndarray]) -> SurfaceProfiles:
        """The rows of a window of the road.

        Parameters
        ----------
        points : Points of the window
        start, length : m, station at which it begins, and its length, whole numbers
        reach : m either side of the reference line
        road_height : function of (N,) stations in m; (N,) local z of the road under the vehicle, accurate to decimetres

        Returns
        -------
        SurfaceProfiles
        """
        first_row, rows = int(round(start / PROFILE_ROW)), int(round(length / PROFILE_ROW))
        cells = ground_cells(points, first_row, rows, reach, road_height, PROFILE_ROW, PROFILE_COLUMN)
        above = cells.height - road_height(cells.stations)[:, None]
        return cls(cells.stations, cells.offsets, *(v.astype(np.float32) for v in (above, cells.rough, cells.brightness, cells.scatter)))

    @classmethod
    def joined(cls, parts: Sequence[SurfaceProfiles]) -> SurfaceProfiles:
        """The rows of several windows."""
        return cls(np.concatenate([part.stations for part in parts]), parts[0].offsets,
                   *(np.concatenate([getattr(part, name) for part in parts]) for name in cls.NAMES))

    def side(self, sign: int | float) -> SurfaceProfiles:
        """The cells of one side, 1 left or -1 right, outward from the reference line; offsets count outward."""
        u = sign * self.offsets
        outward = np.argsort(u, kind="stable")[np.count_nonzero(u < 0):]
        return SurfaceProfiles(self.stations, u[outward], *(getattr(self, name)[:, outward] for name in self.NAMES))

    def pooled(self) -> SurfaceProfiles:
        """Profiles of POOLED_ROWS rows every ROWS_PER_STEP rows: medians of the cells."""
        half = POOLED_ROWS // 2
        return SurfaceProfiles(self.stations[::ROWS_PER_STEP], self.offsets, *(
            known_median(np.lib.stride_tricks.sliding_window_view(
                np.pad(getattr(self, name), ((half, half), (0, 0)), constant_values=np.nan), POOLED_ROWS, axis=0)[::ROWS_PER_STEP], 2)
            for name in self.NAMES))


@dataclass(frozen=True)
class GrownLimit:
    """The limit of a road on a side without an edge, on R rows.

    offset : (R,) m, of the edge of the pavement
    shown : (R,) bool, whether it was measured as an edge; where it is not, the road ends there for want of better
    likely : (R,) bool, whether it is rather an edge than not
    hidden : (R,) bool, whether hardly anything was measured right behind it
    """

    offset: np.ndarray
    shown: np.ndarray
    likely: np.ndarray
    hidden: np.ndarray


def grown_limit(profiles: SurfaceProfiles, cells: GroundCells, above: np.ndarray, sign: int | float, track: np.ndarray,
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
    above : (R, C) m, height of the road above its expected height
    sign : 1 for the left side, -1 for the right
    track : (R,) m, offset of the outermost track on that side
    max_width : m from the track

    Returns
    -------
    GrownLimit
    """
    stations = cells.stations
    nowhere = np.zeros(len(stations), bool)
    rows = replace(profiles, height=profiles.height - _at(above, cells, profiles.stations, profiles.offsets)).side(sign)
    pooled = rows.pooled()
    beside = sign * np.interp(pooled.stations, stations, track)
    halves = [HalfProfile(pooled.offsets, pooled.height[k], pooled.rough[k]) for k in range(len(beside))]
    changes = np.array([half.change(at, max_width) for half, at in zip(halves, beside)])
    known = np.flatnonzero(changes >= 0)
    if not len(known):
        return GrownLimit(track + sign * max_width, nowhere, nowhere, ~nowhere)
    blind = np.array([half.blind_from(change) for half, change in zip(halves, changes)])
    changes = np.interp(rows.stations, pooled.stations[known], _agreed(changes[known], blind[known], len(pooled.offsets)))
    found = pavement_limits(rows, changes)
    outward = np.interp(stations, rows.stations, rows.offsets[0] + (found.cell - 0.5) * PROFILE_COLUMN)
    row = np.clip(np.searchsorted(rows.stations + 0.5 * PROFILE_ROW, stations), 0, len(rows.stations) - 1)
    farthest = sign * track + max_width
    return GrownLimit(sign * np.minimum(outward, farthest), found.shown[row] & (outward < farthest),
                      found.likely[row] & (outward < farthest), found.hidden[row])


def _agreed(changes, blind, cells):
    """(P,) cell at which the ground changes, along the path that most profiles agree with."""
    miss = (np.arange(cells + 1) - changes[:, None]) * PROFILE_COLUMN
    cost = np.minimum(np.abs(miss), MAX_MISS)
    return cheapest_path(np.where(blind[:, None] & (miss > 0), BLIND_SHARE * cost, cost), WIDENING_COST * PROFILE_COLUMN, LARGEST_WIDENING_COST)


def _at(grid, cells, stations, offsets):
    """Bilinear values of a grid of cells at stations and offsets."""
    row = np.clip(stations / cells.row_size - cells.first_row - 0.5, 0, len(grid) - 1)
    column = np.clip(offsets / cells.column_size - cells.first_column - 0.5, 0, grid.shape[1] - 1)
    i, j = np.minimum(row.astype(int), len(grid) - 2), np.minimum(column.astype(int), grid.shape[1] - 2)
    a, b = (row - i)[:, None], (column - j)[None, :]
    return ((1 - a) * ((1 - b) * grid[np.ix_(i, j)] + b * grid[np.ix_(i, j + 1)])
            + a * ((1 - b) * grid[np.ix_(i + 1, j)] + b * grid[np.ix_(i + 1, j + 1)]))


class HalfProfile:
    """Cells of one profile from the reference line outward.

    Attributes
    ----------
    u : (K,) m, outward offsets of the middles of the cells, ascending
    off : (K,) m above the height of the road; NaN where nothing was measured
    rough : (K,) m
    """

    def __init__(self, u: np.ndarray, off: np.ndarray, rough: np.ndarray):
        low = np.isfinite(off) & (np.abs(off) < MAX_HEIGHT_DEVIATION)
        follows = np.convolve(low, np.ones(OBSTACLE_CELLS), "full")[OBSTACLE_CELLS:]
        hides = (off > OBSTACLE_HEIGHT) & (np.append(follows, 0.0) > 0)
        self.u, self.off, self.rough = u, np.where(hides, np.nan, off), rough

    def change(self, beside: float, max_width: float) -> int:
        """The first cell of other ground, or the one at the largest width; -1 where nothing was measured before it.

        Parameters
        ----------
        beside : m, outward offset of the track
        max_width : m from the track
        """
        start = int(np.searchsorted(self.u, beside + CERTAIN_ROAD))
        stop = min(int(np.searchsorted(self.u, beside + max_width)), len(self.u))
        if not np.isfinite(self.off[:stop]).any():
            return -1
        inside = np.diff(self.off[:max(start, 8)])
        inside = inside[np.isfinite(inside)]
        uneven = float(np.median(np.abs(inside))) if len(inside) else 0.0
        blind = 0
        for k in range(start, stop):
            ahead = slice(k, k + MIN_CHANGE_CELLS)
            if k >= blind and np.isnan(self.off[k:k + MAX_EMPTY_GROUND_CELLS]).all():
                blind = self._road_behind(k, uneven)
                if not blind:
                    return k
            if self._differs(k, ahead, uneven):
                return k
        return stop

    def blind_from(self, k: int) -> bool:
        """Whether nothing was measured in the cells from cell k on."""
        return 0 <= k < len(self.off) and bool(np.isnan(self.off[k:k + MAX_EMPTY_GROUND_CELLS]).all())

    def _road_behind(self, k, uneven):
        """The first cell behind a blind zone that begins at cell k, or 0 where no road follows.

        The ground behind must be at the height of the road and as smooth. Its brightness is not compared, because it was
        measured in another part of the scanner's turn.
        """
        measured = np.flatnonzero(np.isfinite(self.off[k:k + MAX_BLIND_CELLS + 1]))
        if not len(measured):
            return 0
        again = k + int(measured[0])
        behind, inner = slice(again, again + 2 * MIN_CHANGE_CELLS), slice(max(k - 10, 0), k)
        if np.isfinite(self.off[behind]).mean() < 0.75 or (np.abs(self.off[behind]) > MAX_HEIGHT_DEVIATION + UNEVENNESS_FACTOR * uneven).any():
            return 0
        with np.errstate(invalid="ignore"):
            smooth = known_median(self.rough[behind], 0) <= ROUGHNESS_FACTOR * known_median(self.rough[inner], 0) + ROUGHNESS_FLOOR
        return again if smooth else 0

    def _differs(self, k, ahead, uneven):
        """Whether the ground from cell k on is no longer that of the road."""
        off, before = self.off[ahead], self.off[max(k - MIN_CHANGE_CELLS, 0):k]
        off, before = off[np.isfinite(off)], before[np.isfinite(before)]
        limit = MAX_HEIGHT_DEVIATION + UNEVENNESS_FACTOR * uneven
        if len(off) > 1 and abs(self.off[k]) > limit and (np.abs(off) > limit).mean() > MIN_AGREEING_SHARE:
            return True
        # the step may cut the first cell
        if len(off) > 2 and len(before) > 2 and (np.abs(off[1:] - np.median(before)) > MAX_HEIGHT_CHANGE + UNEVENNESS_FACTOR * uneven).all():
            return True
        inner = slice(max(k - 15, 0), k)
        rough, usual = self.rough[ahead], self.rough[inner]
        rough, usual = rough[np.isfinite(rough)], usual[np.isfinite(usual)]
        if len(rough) > 1 and len(usual) > 3:
            limit = ROUGHNESS_FACTOR * np.median(usual) + ROUGHNESS_FLOOR
            if self.rough[k] > limit and (rough > limit).mean() > MIN_AGREEING_SHARE:
                return True
        return self._turns(k, uneven)

    def _turns(self, k, uneven):
        """Whether the ground from cell k on tilts away, over 0.6 m, from the metre before."""
        inner = slice(max(k - 10, 0), k)
        after, before = self.off[k:k + 6], self.off[inner]
        a, b = np.isfinite(after), np.isfinite(before)
        if a.sum() < 4 or b.sum() < 5 or not a[0]:
            return False
        line = np.polyfit(self.u[inner][b], before[b], 1)
        outward = self.u[k:k + 6][a]
        off = after[a] - np.polyval(line, outward)
        # the bank begins farther out
        if abs(off[0]) < 0.5 * MIN_TILT_CHANGE * PROFILE_COLUMN + UNEVENNESS_FACTOR * uneven:
            return False
        # most cells, not a single one beside an obstacle
        most = np.median(off / (outward - self.u[k] + 0.5 * PROFILE_COLUMN))
        return min(abs(most), abs(np.polyfit(outward, off, 1)[0])) > MIN_TILT_CHANGE
