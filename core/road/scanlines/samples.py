"""Vertices at equal steps along normalized scanlines, about the places where a curb may be."""

from dataclasses import dataclass

import cv2
import numpy as np

from .grid import DEPTH, FAR, SPACING, row_of_lines

UPRIGHT = 2.0       # m that a metre of height counts as, so that low faces keep vertices enough
CELL = 0.10         # m across: the grain in which places are marked


@dataclass
class Samples:
    """Vertices SPACING apart along scanlines, in the order of the lines or, of one side, by row and outward offset.

    Attributes
    ----------
    first, interval : number of the first row, m between rows
    rows : number of rows
    row, u, h : (N,) row from 0, offset, height above the expected road
    steep : (N,) m of height per m across between the neighbours of each
    """

    first: int
    interval: float
    rows: int
    row: np.ndarray
    u: np.ndarray
    h: np.ndarray
    steep: np.ndarray

    def outward(self, sign):
        """Those of one side, 1 left or -1 right, sorted by row and outward offset."""
        u = sign * self.u[::sign]
        row = self.row[::sign]
        order = np.argsort(row * FAR + u, kind="stable")
        return Samples(self.first, self.interval, self.rows, row[order], u[order], self.h[::sign][order], self.steep[::sign][order])


def samples_near(lines, heights, rows, interval, places, across, along, clipping_height):
    """Vertices along the scanlines near some places, those at the height of the road.

    A vertex lies where it does whatever places are asked for: steps count from the beginning of its line.

    Parameters
    ----------
    lines : Scanlines of one pass and scanner
    heights : (V,) m of their vertices above the expected road
    rows : (first, last + 1) numbers of the section planes
    interval : metres
    places : (row, d) arrays
    across, along : m and rows about them
    clipping_height : m above the expected road up to which ground is looked for

    Returns
    -------
    Samples: all that lie so near, and some that do not
    """
    row = row_of_lines(lines, rows, interval)
    segments, line = _segments_near(lines, row, rows[1] - rows[0], *places, across, along)
    line, d, h, steep = _at_equal_steps(lines, heights, segments, line)
    kept = np.flatnonzero((h > -DEPTH) & (h <= clipping_height))
    return Samples(rows[0], interval, rows[1] - rows[0], row[line[kept]], d[kept], h[kept], steep[kept])


def _segments_near(lines, row, count, place_row, place_d, across, along):
    """Vertices, and their lines, from which a line goes on past marked cells."""
    low, high = lines.d.min(), lines.d.max()
    cells = int((high - low) / CELL) + 1
    marked = np.zeros((count, cells), np.uint8)
    marked[place_row, np.clip(((place_d - low) / CELL).astype(np.int64), 0, cells - 1)] = 1
    # a cell more than asked for, so that every vertex has the neighbours that tell its steepness
    aside = int(np.ceil(across / CELL)) + 2
    marked = cv2.dilate(marked, np.ones((2 * along + 1, 2 * aside + 1), np.uint8))
    before = np.zeros((count, cells + 1), np.int32)
    np.cumsum(marked, axis=1, out=before[:, 1:])
    cell = ((lines.d - low) * (1.0 / CELL)).astype(np.int32)
    inside = (row >= 0) & (row < count)
    line = np.repeat(np.arange(len(lines), dtype=np.int32), np.diff(lines.first))
    cell += (np.where(inside, row, 0) * (cells + 1)).astype(np.int32)[line]
    flat = before.reshape(-1)
    near = flat[cell[1:] + 1] > flat[cell[:-1]]
    near &= (line[1:] == line[:-1]) & inside[line[:-1]]
    segments = np.flatnonzero(near)
    return segments, line[segments]


def _at_equal_steps(lines, heights, segment, line):
    """(line, d, h, steepness) at equal steps along lines on some of their segments; a metre of height counts as UPRIGHT metres."""
    step = np.abs(np.diff(lines.d))
    step += UPRIGHT * np.abs(np.diff(heights))
    step[lines.first[1:-1] - 1] = 0.0
    along = np.concatenate([[0.0], np.cumsum(step)])
    begin, end = along[segment], along[segment + 1]
    start = along[lines.first[:-1]][line]
    begin, end = begin - start, end - start
    first = np.ceil(begin / SPACING - 1e-9).astype(np.int64)
    last = np.ceil(end / SPACING - 1e-9).astype(np.int64)
    # the end of a line is a vertex too where a step falls on it
    closing = (segment + 2 == lines.first[1:][line]) & (last * SPACING <= end)
    number = last + closing - first
    which = np.repeat(np.arange(len(segment), dtype=np.int32), number)
    count = np.arange(len(which)) + (first - (np.cumsum(number) - number))[which]
    share = np.clip((count * SPACING - begin[which]) / np.maximum(end - begin, 1e-9)[which], 0.0, 1.0)
    d0, h0 = lines.d[segment], heights[segment]
    d = d0[which] + share * (lines.d[segment + 1] - d0)[which]
    h = h0[which] + share * (heights[segment + 1] - h0)[which]
    line = line[which]
    return line, d, h, _steepness(line, count, d, h)


def _steepness(line, count, d, h):
    """(N,) rise over run, without sign, from the vertex before to the one after on the same line."""
    if len(line) < 2:
        return np.zeros(len(line))
    parted = (np.diff(line) != 0) | (np.diff(count) != 1)
    before, after = np.arange(-1, len(line) - 1), np.arange(1, len(line) + 1)
    before[0], after[-1] = 0, len(line) - 1
    before[1:] += parted
    after[:-1] -= parted
    return np.abs(h[after] - h[before]) / np.maximum(np.abs(d[after] - d[before]), 1e-6)
