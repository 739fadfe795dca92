"""Normalized scanlines of one pass and scanner on a grid of section planes and cells across, for the search of steps."""

from dataclasses import dataclass

import numpy as np

SCANLINE_RESOLUTION = 0.02      # m across between cells, and along a scanline between resampled vertices
MAX_GROUND_DEPTH = 1.0         # m below the road to which ground is sought
LINE_SEPARATION = 1e3           # m: parts lines that follow on each other in one array


@dataclass
class HeightGrid:
    """Heights of scanlines where they pass the middles of cells.

    Rows are section planes, row r at station (first + r) * interval; cells count from `origin`,
    heights from the expected road.

    Attributes
    ----------
    first, interval, origin : number of the first row, m between rows, least offset
    low : (R, C) float32, the lowest of several lines; NaN where there is none
    """

    first: int
    interval: float
    origin: float
    low: np.ndarray

    @property
    def shape(self):
        return self.low.shape

    def part(self, first, last):
        """The rows from index `first` to before `last`."""
        return HeightGrid(self.first + first, self.interval, self.origin, self.low[first:last])

    def offset(self, cell):
        """Offset of the middle of cells, metres."""
        return self.origin + (np.asarray(cell) + 0.5) * SCANLINE_RESOLUTION

    def outward(self, sign, origin):
        """The grid of one side, 1 left or -1 right: from `origin` (whole cells from the reference line) outward."""
        low = self.low[:, ::sign]
        skipped = int(round((origin - self.origin) / SCANLINE_RESOLUTION))
        if skipped < 0:
            low = np.concatenate([np.full((len(low), -skipped), np.nan, np.float32), low], axis=1)
        return HeightGrid(self.first, self.interval, origin, np.ascontiguousarray(low[:, max(skipped, 0):]))

    def closed(self, reach):
        """The gaps of every scanline closed by its neighbours, up to `reach` rows away: lost pulses and shadows leave different ones."""
        closed = self.low.copy()
        for ahead in range(1, min(reach, len(closed) - 1) + 1):
            for shifted, own in ((self.low[ahead:], closed[:-ahead]), (self.low[:-ahead], closed[ahead:])):
                np.copyto(own, shifted, where=np.isnan(own))
        return HeightGrid(self.first, self.interval, self.origin, closed)


def height_grid(lines, heights, rows, interval, reach, clipping_height):
    """Heights of scanlines across the whole road.

    Parameters
    ----------
    lines : Scanlines of one pass and scanner
    heights : (V,) m of their vertices above the expected road
    rows : (first, last + 1) numbers of the section planes
    interval : metres
    reach : m to either side of the reference line
    clipping_height : m above the expected road up to which ground is looked for

    Returns
    -------
    HeightGrid, its origin -reach or up to a cell less
    """
    half = int(np.ceil(reach / SCANLINE_RESOLUTION))
    low = np.full((rows[1] - rows[0], 2 * half), np.nan, np.float32)
    found = HeightGrid(rows[0], interval, -half * SCANLINE_RESOLUTION, low)
    row = row_of_lines(lines, rows, interval)
    if len(heights) < 2:
        return found
    column = lines.d * (1.0 / SCANLINE_RESOLUTION)
    column += half - 0.5
    cell = np.clip(np.floor(column), -1, 2 * half - 1).astype(np.int32)
    number = np.diff(cell)
    number[lines.first[1:-1] - 1] = 0
    number[np.minimum(heights[1:], heights[:-1]) > clipping_height] = 0
    number *= np.repeat((row >= 0) & (row < len(low)), np.diff(lines.first))[:-1]
    segment = np.flatnonzero(number)
    number = number[segment]
    slope = (heights[segment + 1] - heights[segment]) / (column[segment + 1] - column[segment])
    start = np.cumsum(number) - number
    line = np.searchsorted(lines.first, segment, side="right") - 1
    # the cell that the first height of a segment comes to lie in, in the order of the grid, less its own number among the heights
    ahead = row[line] * (2 * half) + cell[segment] + 1 - start
    which = np.repeat(np.arange(len(segment), dtype=np.int32), number)
    place = ahead.take(which)
    place += np.arange(len(which))
    base = heights[segment] - slope * (column[segment] + row[line] * (2 * half))
    height = slope.take(which)
    height *= place
    height += base.take(which)
    height = height.astype(np.float32)
    flat = low.reshape(-1)
    flat[place] = height
    # of several heights for one place the lowest shall stay
    if (np.diff(place) <= 0).any():
        while len(lower := np.flatnonzero(height < flat[place])):
            place, height = place[lower], height[lower]
            flat[place] = height
    with np.errstate(invalid="ignore"):
        flat[(flat > clipping_height) | (flat <= -MAX_GROUND_DEPTH)] = np.nan
    return found


def row_of_lines(lines, rows, interval):
    """(L,) row of every scanline on a grid of section planes (first, last + 1)."""
    return np.rint(lines.station / interval).astype(np.int64) - rows[0]
