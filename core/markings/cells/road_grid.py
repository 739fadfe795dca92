"""A window of the road as a grid of cells, along the road and across it, so that a bend is straight.

Points are put into the cells piece by piece: no array of all points is made.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...survey.store.records import COORDINATE_SCALE

if TYPE_CHECKING:
    from ...io.geotiff import IntensityImage
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.store.columns import Columns
    from ...survey.store.records import Points
    from ...survey.store.road_points import RoadPoints


CELL_SIZE = 0.04  # m, along and across the road: the cells in which points and paint are put
CELL_UNITS = 400  # the same in units of 0.1 mm
ROWS_PER_PIECE = 125             # rows of cells: 5 m of road at a time
POINTS_PER_CELL_BLOCK = 1 << 15  # points put into cells at a time: what fits the processor's cache


class RoadGrid:
    """A window of the road in cells of 4 cm: rows along the road, columns across it."""

    def __init__(self, first: int, last: int, low: int, high: int) -> None:
        self.first, self.last, self.low, self.high = first, last, low, high

    @property
    def shape(self) -> tuple[int, int]:
        return self.last - self.first, self.high - self.low

    def stations(self) -> np.ndarray:
        return (np.arange(self.first, self.last) + 0.5) * CELL_UNITS * COORDINATE_SCALE

    def offsets(self) -> np.ndarray:
        return (np.arange(self.low, self.high) + 0.5) * CELL_UNITS * COORDINATE_SCALE

    def read(self, image: IntensityImage, frame: RoadFrame, road: int) -> np.ndarray:
        """(rows, columns) float32 brightness, NaN where nothing was scanned."""
        x, y = frame.road(road).to_map(self.stations()[:, None], self.offsets())
        return np.asarray(image.sample(x.ravel(), y.ravel(), frame.origin), np.float32).reshape(self.shape)


@dataclass(frozen=True)
class PieceOfRoad:
    """The points of a few metres of road in cells.

    grid : RoadGrid of these rows alone, as wide as the points lie
    cell : (N,) int32 flat number in it of each point
    occupied : (rows, columns) bool, cells that points lie in
    half_width : (2, rows) uint16, mm to the road's edge on the left and on the right, 0 where it is not known
    offsets : (M,) int32, units of 0.1 mm, of an evenly spaced sample of the points
    """

    grid: RoadGrid
    cell: np.ndarray
    occupied: np.ndarray
    half_width: np.ndarray
    offsets: np.ndarray

    @classmethod
    def of(cls, points: Points, first: int, last: int, step: int = 1) -> PieceOfRoad:
        """The points of rows `first` to before `last`; one of `step` gives the offsets."""
        records = points.records
        d = records["d"]
        grid = RoadGrid(first, last, int(d.min()) // CELL_UNITS - 1, int(d.max()) // CELL_UNITS + 2)
        number, occupied = np.empty(len(d), np.int32), np.zeros(grid.shape, bool)
        for some, cell in cell_numbers(records, grid):
            number[some] = cell
            occupied.ravel()[cell] = True
        return cls(grid, number, occupied, _half_widths(records, first, last), d[::step].copy())

    def within(self, grid: RoadGrid) -> tuple[slice, slice]:
        """Where this piece lies in a larger grid: slices of its rows and columns."""
        mine = self.grid
        return slice(mine.first - grid.first, mine.last - grid.first), slice(mine.low - grid.low, mine.high - grid.low)

    def numbers_in(self, grid: RoadGrid, cell: np.ndarray) -> np.ndarray:
        """Flat numbers in a larger grid of some cells of this one, by their flat numbers here; (N,) int32 each."""
        mine = self.grid
        width, wider = mine.shape[1], grid.shape[1]
        # numpy's divmod takes four times as long as its division
        number = cell // np.int32(width)
        number *= np.int32(wider - width)
        number += cell
        number += np.int32((mine.first - grid.first) * wider + mine.low - grid.low)
        return number

    def points_on(self, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ascending indices of the points whose cells are on in (rows, columns) of a mask, and the numbers of their cells."""
        mask, rows, cells = mask.ravel(), [], []
        for k in range(0, len(self.cell), POINTS_PER_CELL_BLOCK):
            cell = self.cell[k:k + POINTS_PER_CELL_BLOCK]
            found = np.flatnonzero(mask.take(cell))
            rows.append(found + k)
            cells.append(cell.take(found))
        return np.concatenate(rows), np.concatenate(cells)


def cells_of_road(road_points: RoadPoints, road: int, first: int, last: int, step: int = 1) -> list[PieceOfRoad]:
    """[PieceOfRoad] of the rows from `first` to before `last`."""
    return [PieceOfRoad.of(points, begin, end, step) for begin, end, points in road_pieces(road_points, road, first, last)]


@dataclass(frozen=True)
class RoadCells:
    """A window of the road in cells.

    grid : RoadGrid
    occupied : (rows, columns) bool, cells that points lie in
    half_width : (2, rows) uint16, mm to the road's edge on the left and on the right, 0 where it is not known
    """

    grid: RoadGrid
    occupied: np.ndarray
    half_width: np.ndarray

    @classmethod
    def of(cls, parts: Iterable[PieceOfRoad], first: int, last: int) -> RoadCells | None:
        """RoadCells of the rows from `first` to before `last` of some PieceOfRoad; None where no point lies in them."""
        parts = [part for part in parts if part.grid.first < last and part.grid.last > first]
        if not parts:
            return None
        low, high = min(part.grid.low for part in parts), max(part.grid.high for part in parts)
        occupied, half_width = np.zeros((last - first, high - low), bool), np.zeros((2, last - first), np.uint16)
        for part in parts:
            begin, end = max(part.grid.first, first), min(part.grid.last, last)
            rows = slice(begin - part.grid.first, end - part.grid.first)
            occupied[begin - first:end - first, part.grid.low - low:part.grid.high - low] = part.occupied[rows]
            half_width[:, begin - first:end - first] = part.half_width[:, rows]
        # a part may reach farther across beyond these rows
        columns = np.flatnonzero(occupied.any(axis=0))
        if not len(columns):
            return None
        begin, end = int(columns[0]) - 1, int(columns[-1]) + 2
        return cls(RoadGrid(first, last, low + begin, low + end), np.ascontiguousarray(occupied[:, begin:end]), half_width)


def road_pieces(road_points: RoadPoints, road: int, first: int, last: int) -> Iterator[tuple[int, int, Points]]:
    """Yield (first row, end, Points) of the rows of cells from `first` to before `last`, in order; those without points are left out."""
    cuts = [first, *range((first // ROWS_PER_PIECE + 1) * ROWS_PER_PIECE, last, ROWS_PER_PIECE), last]
    for begin, end in zip(cuts[:-1], cuts[1:]):
        points = road_points.window(road, begin * CELL_UNITS * COORDINATE_SCALE, end * CELL_UNITS * COORDINATE_SCALE)
        if len(points):
            yield begin, end, points


def cell_numbers(records: np.ndarray | Columns, grid: RoadGrid) -> Iterator[tuple[slice, np.ndarray]]:
    """Yield (slice of the records, (n,) int32 flat numbers of their cells in a grid), some thousand at a time."""
    s, d = records["s"], records["d"]
    width = np.int32(grid.shape[1])
    for k in range(0, len(s), POINTS_PER_CELL_BLOCK):
        some = slice(k, k + POINTS_PER_CELL_BLOCK)
        cell = s[some] // np.int32(CELL_UNITS)
        cell -= np.int32(grid.first)
        cell *= width
        cell += d[some] // np.int32(CELL_UNITS)
        cell -= np.int32(grid.low)
        yield some, cell


def _half_widths(records, first, last):
    """(2, rows) uint16 mm, the widest of each row of cells on the left and on the right."""
    starts = np.searchsorted(records["s"], (np.arange(first, last + 1) * CELL_UNITS).astype(np.int32))
    found = np.zeros((2, last - first), np.uint16)
    filled = np.flatnonzero(np.diff(starts))
    if len(filled):
        for row, beside in zip(found, (records["d"] > 0, records["d"] < 0)):
            row[filled] = np.maximum.reduceat(records["half_width"] * beside, starts[filled])
    return found
