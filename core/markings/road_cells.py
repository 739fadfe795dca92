"""The points of a window of the road in cells, gone through piece by piece: no array of all of them is made."""

from dataclasses import dataclass

import numpy as np

from ..survey.points import UNIT
from .road_grid import CELL, RoadGrid

PIECE = 125        # cells: 5 m of road at a time
AT_ONCE = 1 << 15  # points put into cells at a time: what fits the processor's cache


@dataclass(frozen=True)
class RoadCells:
    """A window of the road in cells.

    grid : RoadGrid
    occupied : (rows, columns) bool, cells that points lie in
    half_width : (2, rows) uint16, mm to the road's edge on the left and on the right, 0 where no point says
    """

    grid: RoadGrid
    occupied: np.ndarray
    half_width: np.ndarray

    @classmethod
    def of(cls, road_points, road, first, last):
        """RoadCells of the rows from `first` to before `last`; None where there are no points."""
        parts, half_width = [], np.zeros((2, last - first), np.uint16)
        for begin, end, points in pieces(road_points, road, first, last):
            records = points.records
            low, high = int(records["d"].min()) // CELL - 1, int(records["d"].max()) // CELL + 2
            grid = RoadGrid(begin, end, low, high)
            occupied = np.zeros(grid.shape, bool)
            for _, cell in cell_numbers(records, grid):
                occupied.ravel()[cell] = True
            parts.append((grid, occupied))
            half_width[:, begin - first:end - first] = _half_widths(records, begin, end)
        if not parts:
            return None
        grid = RoadGrid(first, last, min(part.low for part, _ in parts), max(part.high for part, _ in parts))
        occupied = np.zeros(grid.shape, bool)
        for part, seen in parts:
            occupied[part.first - first:part.last - first, part.low - grid.low:part.high - grid.low] = seen
        return cls(grid, occupied, half_width)


def pieces(road_points, road, first, last):
    """Yield (first row, end, Points) of the rows of cells from `first` to before `last`, in order; those without points are left out."""
    cuts = [first, *range((first // PIECE + 1) * PIECE, last, PIECE), last]
    for begin, end in zip(cuts[:-1], cuts[1:]):
        points = road_points.window(road, begin * CELL * UNIT, end * CELL * UNIT)
        if len(points):
            yield begin, end, points


def cell_numbers(records, grid):
    """Yield (slice of the records, (n,) int32 flat numbers of their cells in a grid), some thousand at a time."""
    s, d = records["s"], records["d"]
    width = np.int32(grid.shape[1])
    for k in range(0, len(s), AT_ONCE):
        some = slice(k, k + AT_ONCE)
        cell = s[some] // np.int32(CELL)
        cell -= np.int32(grid.first)
        cell *= width
        cell += d[some] // np.int32(CELL)
        cell -= np.int32(grid.low)
        yield some, cell


def _half_widths(records, first, last):
    """(2, rows) uint16 mm, the widest of each row of cells on the left and on the right."""
    starts = np.searchsorted(records["s"], (np.arange(first, last + 1) * CELL).astype(np.int32))
    found = np.zeros((2, last - first), np.uint16)
    filled = np.flatnonzero(np.diff(starts))
    if len(filled):
        for row, beside in zip(found, (records["d"] > 0, records["d"] < 0)):
            row[filled] = np.maximum.reduceat(records["half_width"] * beside, starts[filled])
    return found
