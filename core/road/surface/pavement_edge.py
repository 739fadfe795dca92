"""Where a road without a curb ends: its edge towards verge, ditch or yard, told from height, roughness and brightness."""

from dataclasses import dataclass

import numpy as np

from .ground_grid import ground_cells, known_median
from .region_growing import MAX_HEIGHT_DEVIATION

PROFILE_ROW, PROFILE_COLUMN = 1.0, 0.1   # m, cells of the profile across the side
ROWS_PER_PROFILE = 5                # rows that make one profile: 5 m
CERTAIN_ROAD = 1.2                 # m beside the track that are road in any case: the vehicle drove there
MIN_CHANGE_CELLS = 4               # cells over which a change must last
MAX_HEIGHT_CHANGE = 0.025  # m off the height of the cells before, within 0.2 m
UNEVENNESS_FACTOR = 2.0               # times the road's own unevenness on top of either
ROUGHNESS_FACTOR, ROUGHNESS_FLOOR = 1.6, 0.0025  # times the road's roughness, and m on top
MIN_TILT_CHANGE = 0.10                # change of tilt that begins a bank or a ditch
MAX_EMPTY_CELLS = 5                  # cells without a point at which the road is lost sight of,
MAX_BLIND_CELLS = 12                 # unless no more are empty and road lies behind: where a scanner does not look beside its own vehicle
MAX_STRIP_CELLS = 8                  # cells before the verge in which a strip of gravel is looked for
INNER_CELLS = 3                 # cells of road that such a strip is compared with
MIN_STRIP_CONTRAST, MAX_STRIP_CONTRAST = 0.4, 2.0  # times the points' scatter by which its brightness differs at least; at most, or it is paint
TREND_CELLS = 12                 # cells of road that tell how brightness falls with the distance
MAX_LINE_CELLS = 3                   # cells that a line painted along the road is wide at most
EDGE_INSET = 0.05               # m kept off a limit: too wide a road takes verge for paint, too narrow a one loses nothing
PROFILES_AROUND, PROFILE_RANK = 2, 1        # profiles either side, the second nearest of which counts: a missed verge is no wider road
MIN_WIDENING = 3.0                # m by which two profiles side by side say the road is wider: a junction or a square, no missed verge


@dataclass
class SurfaceProfiles:
    """What the ground is like across the road, one row for 5 m, one column for 0.1 m.

    stations : (P,) middles; offsets : (K,) middles, ascending
    height : (P, K) m above the road's height under the vehicle as known beforehand
    rough, brightness, scatter : (P, K) as in GroundCells; all NaN where nothing is seen
    """

    stations: np.ndarray
    offsets: np.ndarray
    height: np.ndarray
    rough: np.ndarray
    brightness: np.ndarray
    scatter: np.ndarray

    NAMES = ("height", "rough", "brightness", "scatter")

    @classmethod
    def of(cls, points, start, length, reach, road_height):
        """Profiles of a window of the road from station `start` on, both whole metres and a multiple of 5 m long."""
        first_row, rows = int(round(start / PROFILE_ROW)), int(round(length / PROFILE_ROW))
        cells = ground_cells(points, first_row, rows, reach, road_height, PROFILE_ROW, PROFILE_COLUMN)
        above = cells.height - road_height(cells.stations)[:, None]
        pooled = (known_median(values.reshape(-1, ROWS_PER_PROFILE, values.shape[1]), 1)
                  for values in (above, cells.rough, cells.brightness, cells.scatter))
        return cls(cells.stations.reshape(-1, ROWS_PER_PROFILE).mean(axis=1), cells.offsets, *(v.astype(np.float32) for v in pooled))

    @classmethod
    def joined(cls, parts):
        """The profiles of several windows."""
        return cls(np.concatenate([part.stations for part in parts]), parts[0].offsets,
                   *(np.concatenate([getattr(part, name) for part in parts]) for name in cls.NAMES))


def grown_offsets(profiles, cells, above, sign, track, max_width):
    """How far the road reaches on a side where no edge says so.

    SurfaceProfiles of 5 m are followed outward from the track. The road ends where for
    0.4 m the ground is off its height, tilts away, or is rougher than the road
    so far; a strip of another brightness before that (gravel along the asphalt)
    is left out too.

    Parameters
    ----------
    profiles : SurfaceProfiles
    cells : GroundCells of the road, whose rows the result has
    above : (rows, columns) the followed road's height above its height known beforehand
    sign : 1 for the left side, -1 for the right
    track : (rows,) offset of the outermost track on that side
    max_width : m from the track

    Returns
    -------
    (rows,) offsets
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
    """Where profiles end, one after the other, freed of single profiles that ran on over a verge.

    A profile is held back to the second nearest of the five about it, unless it
    and one beside it both reach metres farther: there a street joins.
    """
    padded = np.pad(ends, PROFILES_AROUND, mode="reflect") if len(ends) > PROFILES_AROUND else np.pad(ends, PROFILES_AROUND, mode="edge")
    held = np.sort(np.lib.stride_tricks.sliding_window_view(padded, 2 * PROFILES_AROUND + 1), axis=1)[:, PROFILE_RANK]
    beside = np.maximum(np.r_[-np.inf, ends[:-1]], np.r_[ends[1:], -np.inf])
    both = np.minimum(ends, beside)
    return np.where(both > held + MIN_WIDENING, both, held)


def _at(grid, cells, stations, offsets):
    """A grid of cells at the middles of finer ones."""
    row = np.clip(stations / cells.row_size - cells.first_row - 0.5, 0, len(grid) - 1)
    column = np.clip(offsets / cells.column_size - cells.first_column - 0.5, 0, grid.shape[1] - 1)
    i, j = np.minimum(row.astype(int), len(grid) - 2), np.minimum(column.astype(int), grid.shape[1] - 2)
    a, b = (row - i)[:, None], (column - j)[None, :]
    return ((1 - a) * ((1 - b) * grid[np.ix_(i, j)] + b * grid[np.ix_(i, j + 1)])
            + a * ((1 - b) * grid[np.ix_(i + 1, j)] + b * grid[np.ix_(i + 1, j + 1)]))


class HalfProfile:
    """Cells of PROFILE_COLUMN metres from the reference line outward.

    u : middles, ascending; off : height off the followed road; rough; brightness and the scatter of single
        points about it: NaN where a cell shows nothing
    """

    def __init__(self, u, off, rough, brightness, scatter):
        self.u, self.off, self.rough, self.brightness, self.scatter = u, off, rough, brightness, scatter

    def end(self, beside, max_width):
        """Distance at which the road ends, at most `max_width` beyond `beside`, the track's own distance."""
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
            if k >= blind and np.isnan(self.off[k:k + MAX_EMPTY_CELLS]).all():
                blind = self._road_behind(k, uneven)
                if not blind:
                    return self.u[k] - PROFILE_COLUMN / 2
            if self._differs(k, ahead, uneven):
                return self._before_strip(k)
        return reach

    def _road_behind(self, k, uneven):
        """The cell at which the road is seen again after the blind strip that begins at cell k; 0 where it is not.

        What is behind must be at the road's height and as smooth. Its brightness says nothing: it was seen
        from another part of the scanner's turn.
        """
        seen = np.flatnonzero(np.isfinite(self.off[k:k + MAX_BLIND_CELLS + 1]))
        if not len(seen):
            return 0
        again = k + int(seen[0])
        behind, inner = slice(again, again + 2 * MIN_CHANGE_CELLS), slice(max(k - 10, 0), k)
        if np.isfinite(self.off[behind]).mean() < 0.75 or (np.abs(self.off[behind]) > MAX_HEIGHT_DEVIATION + UNEVENNESS_FACTOR * uneven).any():
            return 0
        with np.errstate(invalid="ignore"):
            smooth = known_median(self.rough[behind], 0) <= ROUGHNESS_FACTOR * known_median(self.rough[inner], 0) + ROUGHNESS_FLOOR
        return again if smooth else 0

    def _differs(self, k, ahead, uneven):
        """Whether from cell k on the ground is no longer the road's."""
        off, before = self.off[ahead], self.off[max(k - MIN_CHANGE_CELLS, 0):k]
        off, before = off[np.isfinite(off)], before[np.isfinite(before)]
        limit = MAX_HEIGHT_DEVIATION + UNEVENNESS_FACTOR * uneven
        if len(off) > 1 and abs(self.off[k]) > limit and (np.abs(off) > limit).mean() > 0.7:
            return True
        # the first cell may lie half on the step
        if len(off) > 2 and len(before) > 2 and (np.abs(off[1:] - np.median(before)) > MAX_HEIGHT_CHANGE + UNEVENNESS_FACTOR * uneven).all():
            return True
        inner = slice(max(k - 15, 0), k)
        rough, usual = self.rough[ahead], self.rough[inner]
        rough, usual = rough[np.isfinite(rough)], usual[np.isfinite(usual)]
        if len(rough) > 1 and len(usual) > 3:
            limit = ROUGHNESS_FACTOR * np.median(usual) + ROUGHNESS_FLOOR
            if self.rough[k] > limit and (rough > limit).mean() > 0.7:
                return True
        return self._turns(k, uneven)

    def _turns(self, k, uneven):
        """Whether the ground tilts away from cell k on, over 0.6 m, against the metre before."""
        inner = slice(max(k - 10, 0), k)
        after, before = self.off[k:k + 6], self.off[inner]
        a, b = np.isfinite(after), np.isfinite(before)
        if a.sum() < 4 or b.sum() < 5 or not a[0]:
            return False
        line = np.polyfit(self.u[inner][b], before[b], 1)
        # a bank that begins further out has not begun here
        if abs(after[0] - np.polyval(line, self.u[k])) < 0.5 * MIN_TILT_CHANGE * PROFILE_COLUMN + UNEVENNESS_FACTOR * uneven:
            return False
        return abs(np.polyfit(self.u[k:k + 6][a], after[a], 1)[0] - line[0]) > MIN_TILT_CHANGE

    def _before_strip(self, k):
        """The near side of a strip of another brightness that ends at cell k, or k itself.

        It is told from asphalt by less than paint is: a line painted along the verge stays on the road.
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
        """Whether cells first to k differ, all one way, from what cells `before` promise: brightness falls with the distance, too."""
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
