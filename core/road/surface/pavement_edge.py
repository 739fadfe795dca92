"""Pavement edges: where a road without a curb ends at a verge, a ditch or a yard.

The edge is a change of height, tilt, roughness or brightness across profiles of 5 m of road. The rules are our own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...survey.store.records import Points
from .ground_grid import GroundCells, ground_cells, known_median
from .region_growing import MAX_HEIGHT_DEVIATION

PROFILE_ROW, PROFILE_COLUMN = 1.0, 0.1  # m along and across the road, size of a cell
ROWS_PER_PROFILE = 5         # rows of cells that make one profile: 5 m
CERTAIN_ROAD = 1.2           # m beside the track that belong to the road: the vehicle drove there
MIN_CHANGE_CELLS = 4         # cells over which a change must last
MAX_HEIGHT_CHANGE = 0.025    # m from the median height of the cells before
UNEVENNESS_FACTOR = 2.0      # times the unevenness of the road, added to either height limit
ROUGHNESS_FACTOR, ROUGHNESS_FLOOR = 1.6, 0.0025  # times the roughness of the road, and m added to it
MIN_TILT_CHANGE = 0.10       # m per m: change of tilt at which a bank or a ditch begins
MAX_EMPTY_GROUND_CELLS = 5   # consecutive cells without points at which the road ends,
MAX_BLIND_CELLS = 12         # unless at most so many are empty and road follows: the blind zone beside the vehicle
MAX_STRIP_CELLS = 8          # cells before the edge in which a strip of gravel is searched
INNER_CELLS = 3              # cells of road with which the strip is compared
MIN_STRIP_CONTRAST, MAX_STRIP_CONTRAST = 0.4, 2.0  # times the scatter of single points; a higher contrast is paint
TREND_CELLS = 12             # cells of road from which the decrease of brightness with the distance is estimated
MAX_LINE_CELLS = 3           # cells across a painted line
EDGE_INSET = 0.05            # m subtracted from the edge: on a road that is too wide, verge is extracted as paint
PROFILES_AROUND, PROFILE_RANK = 2, 1  # profiles either side, and the rank (from 0) of the edge that counts: the second nearest
MIN_AGREEING_SHARE = 0.7     # of the cells ahead that must show the change
MIN_WIDENING = 3.0           # m by which two consecutive profiles must be wider to be a junction or a square


@dataclass
class SurfaceProfiles:
    """The ground across the road: P profiles of 5 m length with K cells of 0.1 m.

    Attributes
    ----------
    stations : (P,) m, middles of the profiles
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
        """The profiles of a window of the road.

        Parameters
        ----------
        points : Points of the window
        start : m, station at which it begins, a whole number
        length : m, a multiple of 5
        reach : m either side of the reference line
        road_height : function of (N,) stations in m; (N,) local z of the road under the vehicle, accurate to decimetres

        Returns
        -------
        SurfaceProfiles
        """
        first_row, rows = int(round(start / PROFILE_ROW)), int(round(length / PROFILE_ROW))
        cells = ground_cells(points, first_row, rows, reach, road_height, PROFILE_ROW, PROFILE_COLUMN)
        above = cells.height - road_height(cells.stations)[:, None]
        pooled = (known_median(values.reshape(-1, ROWS_PER_PROFILE, values.shape[1]), 1)
                  for values in (above, cells.rough, cells.brightness, cells.scatter))
        return cls(cells.stations.reshape(-1, ROWS_PER_PROFILE).mean(axis=1), cells.offsets, *(v.astype(np.float32) for v in pooled))

    @classmethod
    def joined(cls, parts: Sequence[SurfaceProfiles]) -> SurfaceProfiles:
        """The profiles of several windows."""
        return cls(np.concatenate([part.stations for part in parts]), parts[0].offsets,
                   *(np.concatenate([getattr(part, name) for part in parts]) for name in cls.NAMES))


def grown_offsets(profiles: SurfaceProfiles, cells: GroundCells, above: np.ndarray, sign: int | float, track: np.ndarray,
                  max_width: float) -> np.ndarray:
    """Offsets of the limit of the road on a side without an edge.

    Every profile is searched outward from the track. The road ends where, over 0.4 m, the ground is off the height of the
    road, tilts away, or is rougher than the road before it. A strip of another brightness before that place (gravel along
    the asphalt) does not belong to the road either.

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
    (R,) m, offsets
    """
    stations = cells.stations
    u = sign * profiles.offsets
    outward = np.argsort(u, kind="stable")[np.count_nonzero(u < 0):]
    off = profiles.height - _at(above, cells, profiles.stations, profiles.offsets)
    beside = sign * np.interp(profiles.stations, stations, track)
    ends = np.full(len(off), np.nan)
    for k in range(len(off)):
        profile = HalfProfile(u[outward], off[k, outward], profiles.rough[k, outward],
                          profiles.brightness[k, outward], profiles.scatter[k, outward])
        ends[k] = profile.end(beside[k], max_width)
    known = np.isfinite(ends)
    if not known.any():
        return track + sign * max_width
    return sign * (np.interp(stations, profiles.stations[known], _reliable(ends[known])) - EDGE_INSET)


def _reliable(ends):
    """Edges of consecutive profiles without single outliers, where an edge was missed.

    The second nearest edge of five profiles counts. Where a profile and one next to it are both wider by metres, a street
    joins and the wider edge counts.
    """
    padded = np.pad(ends, PROFILES_AROUND, mode="reflect") if len(ends) > PROFILES_AROUND else np.pad(ends, PROFILES_AROUND, mode="edge")
    held = np.sort(np.lib.stride_tricks.sliding_window_view(padded, 2 * PROFILES_AROUND + 1), axis=1)[:, PROFILE_RANK]
    beside = np.maximum(np.r_[-np.inf, ends[:-1]], np.r_[ends[1:], -np.inf])
    both = np.minimum(ends, beside)
    return np.where(both > held + MIN_WIDENING, both, held)


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
    off : (K,) m above the height of the road
    rough : (K,) m
    brightness, scatter : (K,) raw counts, and their standard deviation for single points; NaN where nothing was measured
    """

    def __init__(self, u: np.ndarray, off: np.ndarray, rough: np.ndarray, brightness: np.ndarray, scatter: np.ndarray):
        self.u, self.off, self.rough, self.brightness, self.scatter = u, off, rough, brightness, scatter

    def end(self, beside: float, max_width: float) -> float:
        """Outward offset at which the road ends.

        Parameters
        ----------
        beside : m, outward offset of the track
        max_width : m from the track

        Returns
        -------
        m, at most beside + max_width; NaN where nothing was measured between the reference line and that offset
        """
        reach = beside + max_width
        start = int(np.searchsorted(self.u, beside + CERTAIN_ROAD))
        stop = min(int(np.searchsorted(self.u, reach)), len(self.u))
        if not np.isfinite(self.off[:stop]).any():
            return np.nan
        inside = np.diff(self.off[:max(start, 8)])
        inside = inside[np.isfinite(inside)]
        uneven = float(np.median(np.abs(inside))) if len(inside) else 0.0
        blind = 0
        for k in range(start, stop):
            ahead = slice(k, k + MIN_CHANGE_CELLS)
            if k >= blind and np.isnan(self.off[k:k + MAX_EMPTY_GROUND_CELLS]).all():
                blind = self._road_behind(k, uneven)
                if not blind:
                    return self.u[k] - PROFILE_COLUMN / 2
            if self._differs(k, ahead, uneven):
                return self._before_strip(k)
        return reach

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
        # the bank begins farther out
        if abs(after[0] - np.polyval(line, self.u[k])) < 0.5 * MIN_TILT_CHANGE * PROFILE_COLUMN + UNEVENNESS_FACTOR * uneven:
            return False
        return abs(np.polyfit(self.u[k:k + 6][a], after[a], 1)[0] - line[0]) > MIN_TILT_CHANGE

    def _before_strip(self, k):
        """Near side of a strip of another brightness that ends at cell k, or cell k itself.

        Its contrast is lower than that of paint: a line painted along the verge belongs to the road.
        """
        best, at = 0.0, k
        scatter = self.scatter[max(k - 20, 0):k]
        scatter = np.median(scatter[np.isfinite(scatter)]) if np.isfinite(scatter).any() else np.nan
        painted = self._painted(k, scatter)
        for first in range(max(k - MAX_STRIP_CELLS, INNER_CELLS), k - 1):
            inside, strip = self.brightness[first - INNER_CELLS:first], self.brightness[first:k]
            if painted[first:k].any() or not (np.isfinite(inside).all() and np.isfinite(strip).all()):
                continue
            differs = (strip - np.median(inside)) / max(scatter, 1e-6)
            contrast = abs(np.median(differs))
            one_way = (np.sign(differs) == np.sign(np.median(differs))).all()
            before = np.flatnonzero(~painted[:first])[-TREND_CELLS:]
            if one_way and MIN_STRIP_CONTRAST < contrast < MAX_STRIP_CONTRAST and contrast > best and self._breaks(before, first, k, scatter):
                best, at = contrast, first
        return self.u[at] - PROFILE_COLUMN / 2

    def _breaks(self, before, first, k, scatter):
        """Whether cells first to k all deviate in one direction from the trend of brightness over the cells `before`."""
        values = self.brightness[before]
        before, values = before[np.isfinite(values)], values[np.isfinite(values)]
        i, j = np.triu_indices(len(before), 1)
        slope = np.median((values[j] - values[i]) / (before[j] - before[i])) if len(i) else 0.0
        off = self.brightness[first:k] - slope * np.arange(first, k) - np.median(values - slope * before)
        return abs(np.median(off)) > MIN_STRIP_CONTRAST * scatter and (np.sign(off) == np.sign(np.median(off))).all()

    def _painted(self, k, scatter):
        """Cells before cell k that lie in or beside a painted line, brighter than the cells on either side."""
        at = np.arange(k)
        beside = np.maximum(self.brightness[np.maximum(at - MAX_LINE_CELLS, 0)], self.brightness[np.minimum(at + MAX_LINE_CELLS, k - 1)])
        return np.convolve(self.brightness[:k] - beside > MAX_STRIP_CONTRAST * scatter, np.ones(3), "same") > 0
