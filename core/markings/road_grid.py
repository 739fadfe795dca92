"""A window of the road as a grid of cells, along the road and across it, so that a bend is straight.

Points are put into the cells piece by piece: no array of all points is made.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..common.arrays import linked_groups, order_by, stretch_of
from ..io.geotiff import IntensityImage
from ..lazy import cv2
from ..survey.frame.road_frame import RoadFrame
from ..survey.store.columns import Columns
from ..survey.store.records import COORDINATE_SCALE, Points
from ..survey.store.road_points import RoadPoints
from .weights import TRACKS

CELL_SIZE = 0.04   # derived: m, along and across the road: the cells in which points and paint are put
CELL_UNITS = 400   # derived: the same in units of 0.1 mm
ROWS_PER_PIECE = 125   # derived: rows of cells: 5 m of road at a time


class RoadGrid:
    """A window of the road in cells of 4 cm: rows along the road, columns across it."""

    def __init__(self, first: int, last: int, low: int, high: int) -> None:
        self.first, self.last, self.low, self.high = first, last, low, high

    @property
    def shape(self) -> tuple[int, int]:
        return self.last - self.first, self.high - self.low

    def offsets(self) -> np.ndarray:
        return (np.arange(self.low, self.high) + 0.5) * CELL_UNITS * COORDINATE_SCALE

    def read(self, image: IntensityImage, frame: RoadFrame, road: int) -> np.ndarray:
        """(rows, columns) float32 brightness, NaN where nothing was scanned."""
        stations = (np.arange(self.first, self.last) + 0.5) * CELL_UNITS * COORDINATE_SCALE
        x, y = frame.road(road).to_map(stations[:, None], self.offsets())
        return np.asarray(image.sample(x.ravel(), y.ravel(), frame.origin), np.float32).reshape(self.shape)


@dataclass(frozen=True)
class PieceOfRoad:
    """The N points of a few metres of road in cells."""

    grid: RoadGrid   # of these rows alone, as wide as the points lie
    cell: np.ndarray   # (N,) int32 flat number in it
    occupied: np.ndarray   # (rows, columns) bool, cells that points lie in
    half_width: np.ndarray   # (2, rows) uint16, mm to the road's edge on the left and on the right, 0 where it is not known
    offsets: np.ndarray   # (M,) int32, units of 0.1 mm, of an evenly spaced sample of the points

    @classmethod
    def of(cls, points: Points, first: int, last: int, step: int = 1) -> PieceOfRoad:
        """The points of rows `first` to before `last`; one of `step` gives the offsets."""
        records = points.records
        d = records["d"]
        grid = RoadGrid(first, last, int(d.min()) // CELL_UNITS - 1, int(d.max()) // CELL_UNITS + 2)
        cell, occupied = cell_numbers(records, grid), np.zeros(grid.shape, bool)
        occupied.ravel()[cell] = True
        return cls(grid, cell, occupied, _half_widths(records, first, last), d[::step].copy())

    def within(self, grid: RoadGrid) -> tuple[slice, slice]:
        """Where this piece lies in a larger grid: slices of its rows and columns."""
        return slice(self.grid.first - grid.first, self.grid.last - grid.first), slice(self.grid.low - grid.low, self.grid.high - grid.low)

    def numbers_in(self, grid: RoadGrid, cell: np.ndarray) -> np.ndarray:
        """Flat numbers in a larger grid of some cells of this one, by their flat numbers here; (N,) int32 each."""
        own_grid = self.grid
        width, wider = own_grid.shape[1], grid.shape[1]
        # numpy's divmod takes four times as long as its division
        number = cell // np.int32(width)
        number *= np.int32(wider - width)
        number += cell
        number += np.int32((own_grid.first - grid.first) * wider + own_grid.low - grid.low)
        return number

    def points_on(self, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ascending indices of the points whose cells are on in (rows, columns) of a mask, and the numbers of their cells."""
        rows = np.flatnonzero(mask.ravel().take(self.cell))
        return rows, self.cell.take(rows)


def cells_of_road(road_points: RoadPoints, road: int, first: int, last: int, step: int = 1) -> list[PieceOfRoad]:
    """[PieceOfRoad] of the rows from `first` to before `last`, in order; those without points are left out."""
    cuts = [first, *range((first // ROWS_PER_PIECE + 1) * ROWS_PER_PIECE, last, ROWS_PER_PIECE), last]
    pieces = ((begin, end, road_points.window(road, begin * CELL_UNITS * COORDINATE_SCALE, end * CELL_UNITS * COORDINATE_SCALE))
              for begin, end in zip(cuts[:-1], cuts[1:]))
    return [PieceOfRoad.of(points, begin, end, step) for begin, end, points in pieces if len(points)]


@dataclass(frozen=True)
class RoadCells:
    """A window of the road in cells; columns as of PieceOfRoad."""

    grid: RoadGrid
    occupied: np.ndarray
    half_width: np.ndarray

    @classmethod
    def of(cls, parts: Sequence[PieceOfRoad], first: int, last: int) -> RoadCells | None:
        """RoadCells of the rows from `first` to before `last`, in which the parts lie; None without a part."""
        if not parts:
            return None
        grid = RoadGrid(first, last, min(part.grid.low for part in parts), max(part.grid.high for part in parts))
        occupied, half_width = np.zeros(grid.shape, bool), np.zeros((2, last - first), np.uint16)
        for part in parts:
            rows, columns = part.within(grid)
            occupied[rows, columns], half_width[:, rows] = part.occupied, part.half_width
        return cls(grid, occupied, half_width)


def cell_numbers(records: np.ndarray | Columns, grid: RoadGrid) -> np.ndarray:
    """(N,) int32 flat numbers of the cells of records in a grid."""
    cell = records["s"] // np.int32(CELL_UNITS)
    cell -= np.int32(grid.first)
    cell *= np.int32(grid.shape[1])
    cell += records["d"] // np.int32(CELL_UNITS)
    cell -= np.int32(grid.low)
    return cell


def _half_widths(records, first, last):
    """(2, rows) uint16 mm, the widest of each row of cells on the left and on the right."""
    starts = np.searchsorted(records["s"], (np.arange(first, last + 1) * CELL_UNITS).astype(np.int32))
    widest = np.zeros((2, last - first), np.uint16)
    filled = np.flatnonzero(np.diff(starts))
    if len(filled):
        for row, on_side in zip(widest, (records["d"] > 0, records["d"] < 0)):
            row[filled] = np.maximum.reduceat(records["half_width"] * on_side, starts[filled])
    return widest


# Which occupied cells of a grid belong together: those that touch, and those whose points lie near enough.


def occupied(row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The cells (K, 2) int64 that points lie in, different ones in order, and (N,) int the cell of each point; `row`, `column` : (N,) int32."""
    if not len(row):
        return np.empty((0, 2), np.int64), np.empty(0, np.int64)
    order = order_by(column, row)
    row, column = row.take(order), column.take(order)
    new = np.append(True, (row[1:] != row[:-1]) | (column[1:] != column[:-1]))
    member = np.empty(len(row), np.int64)
    member[order] = np.cumsum(new) - 1
    return np.stack([row[new], column[new]], axis=1).astype(np.int64), member


def components(cells: np.ndarray, places: np.ndarray, size: tuple[float, float], distance: float) -> np.ndarray:
    """(K,) int32, connected components of cells whose places lie within a distance, numbered in the order of the cells.

    Exact, and without measuring every pair: where places of cells that touch are near enough wherever they lie, an image of the cells gives the
    patches that are connected, and pairs are measured between patches only.

    cells : (K, 2) int, row and column, different ones, sorted; places : (K, 2) m, a place in each
    size : (2,) m, of a cell in the units of the places
    distance : m between places that belong together
    """
    if not len(cells):
        return np.empty(0, np.int32)
    rows, columns = (int(distance / length) + 1 for length in size)
    low = cells.min(axis=0)
    height, width = (cells.max(axis=0) - low + 1 + [rows, 2 * columns]).tolist()
    index = (cells[:, 0] - low[0]) * width + cells[:, 1] - low[1] + columns
    touching = 2 * np.hypot(*size) <= distance
    patch = _patches(index, (height, width)) if touching else np.arange(len(index), dtype=np.int32)
    image = np.full(height * width + width, -1, np.int32)
    image[index] = patch
    count = int(patch.max()) + 1
    linked = [np.empty(0, np.int64)]
    for row in range(rows + 1):
        for column in range(-columns if row else 1, columns + 1):
            step = row * width + column
            if touching and row <= 1 and abs(column) <= 1:
                continue
            label = image.take(index + step)
            apart = np.flatnonzero((label >= 0) & (label != patch))
            if len(apart):
                neighbours = np.searchsorted(index, index[apart] + step)
                apart = apart[((places[apart] - places[neighbours]) ** 2).sum(axis=1) <= distance**2]
                linked.append(patch[apart].astype(np.int64) * count + image[index[apart] + step])
    first, second = np.divmod(np.unique(np.concatenate(linked)), count)
    return linked_groups(first, second, count)[patch]


def _patches(at, shape):
    """(K,) int32, the patch of touching cells that each of some cells of an image belongs to, numbered in their order."""
    image = np.zeros(shape, np.uint8)
    image.ravel()[at] = 1
    count, labels = cv2.connectedComponents(image, connectivity=8, ltype=cv2.CV_32S)
    labels = labels.ravel()[at]
    first = np.full(count, len(at))
    first[labels[::-1]] = np.arange(len(at))[::-1]
    number = np.empty(count, np.int32)
    number[np.argsort(first, kind="stable")] = np.arange(count)
    return number[labels]


# Between two tracks of the scan, which may lie three decimetres apart, no gap was seen where both show paint: the cells between them belong to the
# marking.

ROWS_AT_ONCE = 2500   # derived: of cells, along the road, that are filled together: 100 m


def fill_gaps(mask: np.ndarray, limit: int, axis: int = 0) -> np.ndarray:
    """Close runs of at most `limit` cells that are off between two that are on, along one axis."""
    if limit < 1:
        return mask.copy()
    length = limit + 1
    size, behind = ((1, length), (0, length - 1)) if axis == 0 else ((length, 1), (length - 1, 0))
    kernel = np.ones(size[::-1], np.uint8)
    margin = [length, length, 0, 0] if axis == 0 else [0, 0, length, length]
    # off beyond the rim, so that nothing is closed towards it
    grown = cv2.dilate(cv2.copyMakeBorder(mask.astype(np.uint8), *margin, cv2.BORDER_CONSTANT, value=0), kernel, anchor=(0, 0))
    closed = cv2.erode(grown, kernel, anchor=behind)
    return closed[margin[0]:margin[0] + mask.shape[0], margin[2]:margin[2] + mask.shape[1]].astype(bool)


def closed_mask(cells: np.ndarray, gaps: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """(A, B) bool mask of (K, 2) cells with gaps of so many cells along either axis closed, and the (2,) int cell of mask[0, 0]."""
    first = cells.min(axis=0)
    mask = np.zeros(cells.max(axis=0) - first + 1, bool)
    mask[tuple((cells - first).T)] = True
    for axis, limit in enumerate(gaps):
        mask = fill_gaps(mask, limit, axis)
    return mask, first


def track_reach(spacing: np.ndarray) -> np.ndarray:
    """(N,) m that points of one marking may lie apart across the road for the spacing of the scan alone, 0 where points lie close together.

    `spacing` : (N,) int, mm across the road between the tracks of the scan.
    """
    reach = spacing * 1e-3 + TRACKS.track_width
    return np.where(reach > TRACKS.min_track_gap, reach, 0.0)


def filled_between_tracks(cells: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells of a marking with those between neighbouring tracks of the scan.

    `cells` : (K, 2) int, along the road and across it, different ones; `reach` : (K,) m of `track_reach`. Returns an (A, B) bool mask, first axis
    along the road, with a rim of cells that are off, and the (2,) int cell of mask[0, 0].
    """
    first = cells.min(axis=0) - 1
    shape = cells.max(axis=0) - first + 2
    mask = np.zeros(shape, bool)
    mask[tuple((cells - first).T)] = True
    gaps = np.rint(reach / CELL_SIZE).astype(int)
    wide = gaps > 0
    if not wide.any():
        return mask, first
    (row, column), gaps = (cells[wide] - first).T, gaps[wide]
    order = np.argsort(row, kind="stable")
    row, column, gaps = np.ascontiguousarray(row[order]), column[order], gaps[order]
    longest = int(round(TRACKS.max_gap_on_track / CELL_SIZE))
    # a marking may be as long as the road
    for begin in range(0, len(mask), ROWS_AT_ONCE):
        window = stretch_of(row, begin - longest, begin + ROWS_AT_ONCE + longest - 1)
        if window.stop > window.start:
            _fill(mask[begin:begin + ROWS_AT_ONCE], row[window] - begin, column[window], gaps[window], longest)
    return mask, first


def _fill(mask, row, column, gaps, longest):
    """Turn on, in some rows of a mask, the cells between those at (N,) places with gaps, of these rows and `longest` rows before and behind them."""
    # along each track first: two tracks rarely show points at the same station
    sparse = np.zeros((len(mask) + 2 * longest, mask.shape[1]), np.int16)
    inside = row < len(mask) + longest
    sparse[row[inside] + longest, column[inside]] = gaps[inside]
    on_track = fill_gaps(sparse > 0, longest, 0)
    inner = slice(longest, longest + len(mask))
    met = np.maximum.accumulate(np.where(sparse > 0, np.arange(len(sparse))[:, None], 0), axis=0)   # row of the value last met
    widest = np.where(on_track & (sparse == 0), np.take_along_axis(sparse, met, axis=0), sparse)[inner]
    mask |= on_track[inner]
    for gap in np.unique(gaps).tolist():
        mask |= fill_gaps(widest >= gap, gap, 1)
