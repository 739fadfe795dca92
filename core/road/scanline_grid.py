"""Normalized scanlines of one side of the road, walked outward: resampled, and on a grid for the search of steps."""

from dataclasses import dataclass

import numpy as np

SPACING = 0.02      # m along a scanline between resampled vertices, and across between cells
UPRIGHT = 2.0       # m that a metre of height counts as, so that low faces keep vertices enough
DEPTH = 1.0         # m below the road to which ground is sought
FAR = 1e3           # m: parts lines that follow on each other in one array


@dataclass
class SideScanlines:
    """Resampled scanlines of one side, pass and scanner.

    Rows are section planes, row r at station (first + r) * interval; offsets count
    outward from the reference line, heights from the expected road.

    Attributes
    ----------
    first, interval, origin : number of the first row, m between rows, least offset
    low : (R, C) float64, height where each row passes the middle of a cell, the lowest of
        several lines; NaN where there is none
    row, u, h : (N,) vertices SPACING apart along the lines, sorted by row and offset
    steep : (N,) m of height per m across between the neighbours of each
    """

    first: int
    interval: float
    origin: float
    low: np.ndarray
    row: np.ndarray
    u: np.ndarray
    h: np.ndarray
    steep: np.ndarray

    @property
    def shape(self):
        return self.low.shape

    def part(self, first, last):
        """The grid of the rows from index `first` to before `last`; the vertices are left out."""
        none = np.empty(0)
        return SideScanlines(self.first + first, self.interval, self.origin, self.low[first:last], none, none, none, none)

    def offset(self, cell):
        """Outward offset of the middle of cells, metres."""
        return self.origin + (np.asarray(cell) + 0.5) * SPACING


@dataclass
class Samples:
    """(N,) vertices at equal steps along scanlines, in the order of the lines: their line and row (from 0), offset,
    height above the expected road, and rise over run there."""

    line: np.ndarray
    row: np.ndarray
    d: np.ndarray
    h: np.ndarray
    steep: np.ndarray

    def __getitem__(self, which):
        return Samples(self.line[which], self.row[which], self.d[which], self.h[which], self.steep[which])


def resampled(lines, heights, rows, interval, clipping_height):
    """Vertices SPACING apart along the scanlines, those at the height of the road.

    Parameters
    ----------
    lines : Scanlines of one pass and scanner
    heights : (V,) m of their vertices above the expected road
    rows : (first, last + 1) numbers of the section planes
    interval : metres
    clipping_height : m above the expected road up to which ground is looked for

    Returns
    -------
    Samples
    """
    row_of_line = np.rint(lines.station / interval).astype(np.int64) - rows[0]
    line, d, h = _at_equal_steps(lines, lines.d, heights)
    samples = Samples(line, row_of_line[line], d, h, _steepness(line, d, h))
    return samples[np.flatnonzero((samples.row >= 0) & (samples.row < rows[1] - rows[0]) & (h > -DEPTH) & (h <= clipping_height))]


def side_scanlines(samples, sign, rows, interval, origin, reach):
    """The scanlines of one side, walked outward.

    Parameters
    ----------
    samples : Samples
    sign : 1 for the left side, -1 for the right
    rows : (first, last + 1) numbers of the section planes
    interval, origin, reach : metres

    Returns
    -------
    SideScanlines
    """
    u = sign * samples.d
    kept = np.flatnonzero((u >= origin) & (u < reach))
    samples, u = samples[kept[::sign]], u[kept[::sign]]
    cells = max(int(np.ceil((reach - origin) / SPACING)), 1)
    low = _on_grid(samples.line, samples.row, (u - origin) / SPACING - 0.5, samples.h, rows[1] - rows[0], cells)
    order = np.argsort(samples.row * FAR + (u - origin), kind="stable")
    return SideScanlines(rows[0], interval, origin, low, samples.row[order], u[order], samples.h[order], samples.steep[order])


def _at_equal_steps(lines, d, h):
    """(line, d, h) at equal steps along every line, a metre of height counted as UPRIGHT metres."""
    if not len(lines):
        return np.empty(0, np.int64), np.empty(0), np.empty(0)
    counts = np.diff(lines.first)
    step = np.abs(np.diff(d)) + UPRIGHT * np.abs(np.diff(h))
    step[lines.first[1:-1] - 1] = 0.0
    along = np.r_[0.0, np.cumsum(step)]
    along -= np.repeat(along[lines.first[:-1]], counts)
    number = np.floor(along[lines.first[1:] - 1] / SPACING).astype(np.int64) + 1
    start = np.cumsum(number) - number
    line = np.repeat(np.arange(len(counts)), number)
    at = (np.arange(number.sum()) - np.repeat(start, number)) * SPACING
    # the vertex before every sample: counted up where each vertex comes to lie among the samples
    ahead = np.repeat(start, counts) + np.ceil(along / SPACING - 1e-9).astype(np.int64)
    before = np.cumsum(np.bincount(ahead, minlength=len(at) + 1))[:len(at)] - 1
    after = np.minimum(before + 1, np.repeat(lines.first[1:] - 1, number))
    share = np.clip((at - along[before]) / np.maximum(along[after] - along[before], 1e-9), 0.0, 1.0)
    return line, d[before] + share * (d[after] - d[before]), h[before] + share * (h[after] - h[before])


def _steepness(line, u, h):
    """(N,) rise over run, without sign, from the vertex before to the one after on the same line."""
    if len(line) < 2:
        return np.zeros(len(line))
    before, after = np.arange(-1, len(line) - 1), np.arange(1, len(line) + 1)
    before[0], after[-1] = 0, len(line) - 1
    before += line[before] != line
    after -= line[after] != line
    return np.abs(h[after] - h[before]) / np.maximum(np.abs(u[after] - u[before]), 1e-6)


def _on_grid(line, row, column, h, rows, cells):
    """(rows, cells) heights where lines pass the middles of cells, the lowest of several."""
    low = np.full((rows, cells), np.nan)
    if len(line) < 2:
        return low
    a, b = column[:-1], column[1:]
    cell = np.floor(np.maximum(a, b)).astype(np.int64)
    # vertices are nearer than a cell, so that no two middles lie between them
    passes = (line[:-1] == line[1:]) & (cell >= np.minimum(a, b)) & (np.abs(b - a) < 2.0) & (cell >= 0) & (cell < cells)
    k = np.flatnonzero(passes)
    share = (cell[k] - a[k]) / np.where(b[k] == a[k], 1.0, b[k] - a[k])
    height = h[k] + share * (h[k + 1] - h[k])
    place = row[k] * cells + cell[k]
    flat = low.reshape(-1)
    flat[place] = height
    # of several heights for one place the lowest shall stay
    while len(lower := np.flatnonzero(height < flat[place])):
        place, height = place[lower], height[lower]
        flat[place] = height
    return low
