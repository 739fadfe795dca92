"""A raster of the ground in plan: cells of local map coordinates, with the points of the lowest layer in each.

Profiles across the road show a curb that runs along it. A curb that turns into a side
street, or goes around an island, may have any direction: it is looked for in plan, where level
ground that is connected with the driven track ends at a rise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....common.arrays import order_by
from ...common.pseudo_scanlines import DEFAULT_SCANNER_NOISE, MIN_SCANNER_NOISE, lowest_layers

PLAN_CELL = 0.10              # m
PLAN_GROUND_DEPTH = 1.0       # m below, and
PLAN_GROUND_HEIGHT = 1.0      # m above the expected road within which ground is looked for
AVERAGING_CELL = 0.05         # m, cells whose points are averaged for a noisy scanner
MIN_NOISE_POINTS = 4          # points of a cell, and
MIN_NOISE_CELLS = 50          # such cells that an estimate of the scanner's noise needs
NOISE_QUANTILE = 0.3          # quantile of the cells' spreads that is the estimate


@dataclass
class GroundRaster:
    """Ground of a stretch of road on a grid of local map coordinates.

    Attributes
    ----------
    x0, y0 : m, the grid's corner, a whole number of cells from 0
    x, y, h : (N,) m, the points of the lowest layer; h above the expected road
    place : (N,) the cell of each, row * columns + column
    low : (rows, columns) m, mean height of the lowest layer, NaN where there is no point
    noise : m, spread of heights within a cell of level ground
    """

    x0: float
    y0: float
    x: np.ndarray
    y: np.ndarray
    h: np.ndarray
    place: np.ndarray
    low: np.ndarray
    noise: float

    @property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """(2,) m each, local corners of the grid and of a cell about it."""
        corner = np.array([self.x0, self.y0])
        return corner - PLAN_CELL, corner + PLAN_CELL * (np.array(self.low.shape[::-1]) + 1)

    def inside(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of those local places, (N,) m, that lie on the grid."""
        row, column = self.cells_at(x, y)
        on = (row >= 0) & (column >= 0) & (row < self.low.shape[0]) & (column < self.low.shape[1])
        return row[on], column[on]

    def cells_at(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of local places, also of those beyond the grid."""
        row, column = (np.floor(np.asarray(v) / PLAN_CELL - np.rint(v0 / PLAN_CELL)).astype(np.int64)
                       for v, v0 in ((y, self.y0), (x, self.x0)))
        return row, column

    def nearest_cells(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of the cells of the grid that are nearest to local places."""
        row, column = self.cells_at(x, y)
        return np.clip(row, 0, self.low.shape[0] - 1), np.clip(column, 0, self.low.shape[1] - 1)

    def middle(self, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Local x, y of the middle of cells."""
        return self.x0 + (column + 0.5) * PLAN_CELL, self.y0 + (row + 0.5) * PLAN_CELL

    @cached_property
    def by_cell(self) -> tuple[np.ndarray, ...]:
        """The points sorted by cell.

        Returns
        -------
        x, y, h : (N,) m, the points
        starts : (rows * columns + 1,) index of the first point of every cell
        """
        order = order_by(self.place)
        starts = np.zeros(self.low.size + 1, np.int64)
        np.cumsum(np.bincount(self.place, minlength=self.low.size), out=starts[1:])
        return self.x.take(order), self.y.take(order), self.h.take(order), starts


def ground_raster(x: np.ndarray, y: np.ndarray, h: np.ndarray, layer_jump: float) -> GroundRaster | None:
    """The ground of points, cell by cell; None where there are none.

    Parameters
    ----------
    x, y : (N,) local m
    h : (N,) m above the expected road
    layer_jump : m of height between ground and what is above it
    """
    near = np.flatnonzero((h > -PLAN_GROUND_DEPTH) & (h < PLAN_GROUND_HEIGHT))
    if not len(near):
        return None
    x, y, h = (v if len(near) == len(h) else v.take(near) for v in (x, y, h))
    column, row = np.floor(x / PLAN_CELL).astype(np.int32), np.floor(y / PLAN_CELL).astype(np.int32)
    first_column, first_row = int(column.min()), int(row.min())
    columns, rows = int(column.max()) - first_column + 1, int(row.max()) - first_row + 1
    row -= first_row
    row *= columns
    column -= first_column
    place = row
    place += column
    n, total, squares = _sums(place, h, rows * columns)
    parted, above = _above_ground(place, h, n, total, squares, layer_jump)
    if above.any():
        ground = np.flatnonzero(~above)
        x, y, h, place = (v.take(ground) for v in (x, y, h, place))
        # in the other cells all points are ground
        again = np.flatnonzero(parted.take(place))
        for old, new in zip((n, total, squares), _sums(place.take(again), h.take(again), rows * columns)):
            np.copyto(old, new, where=parted)
    with np.errstate(invalid="ignore", divide="ignore"):
        low = total / n
        spread = np.sqrt(np.maximum(squares - total * low, 0.0) / (n - 1))
    # curbs and grass are rough to any scanner, so the smoother cells give the estimate
    spread = spread[n >= MIN_NOISE_POINTS]
    noise = max(float(np.quantile(spread, NOISE_QUANTILE)), MIN_SCANNER_NOISE) if len(spread) >= MIN_NOISE_CELLS else DEFAULT_SCANNER_NOISE
    return GroundRaster(first_column * PLAN_CELL, first_row * PLAN_CELL, x, y, h, place, low.reshape(rows, columns), noise)


def _above_ground(place, h, n, total, squares, layer_jump):
    """Which cells may have several layers, and (N,) bool: does a point lie in another layer than the lowest of its cell?"""
    with np.errstate(invalid="ignore", divide="ignore"):
        # heights on either side of a gap have at least this sum of squares about their mean
        parted = squares - total * total / n > 0.99 * layer_jump**2 * (n - 1) / n
    above = np.zeros(len(h), bool)
    own = np.flatnonzero(parted.take(place))
    if len(own):
        order = own.take(order_by(np.rint((h.take(own) + PLAN_GROUND_DEPTH) * 1e4).astype(np.int32), place.take(own)))
        ground, _, _ = lowest_layers(place.take(order), h.take(order), layer_jump)
        above[order] = ~ground
    return parted, above


def _sums(place, h, cells):
    """Of every cell the number of points, the sum of their heights, and of the squares of these."""
    place = place.astype(np.intp)
    return np.bincount(place, minlength=cells), np.bincount(place, h, cells), np.bincount(place, h * h, cells)


def averaged(raster: GroundRaster | None, layer_jump: float) -> GroundRaster | None:
    """A raster of the mean points of cells AVERAGING_CELL wide, which reduces the noise; `noise` is what remains of it.

    None where there are no points.
    """
    if raster is None:
        return None
    column, row = np.floor(raster.x / AVERAGING_CELL).astype(np.int64), np.floor(raster.y / AVERAGING_CELL).astype(np.int64)
    cell = (row - row.min()) * (column.max() - column.min() + 1) + column - column.min()
    count = np.bincount(cell)
    held = np.flatnonzero(count)
    count = count[held]
    x, y, h = (np.bincount(cell, v)[held] / count for v in (raster.x, raster.y, raster.h))
    mean = ground_raster(x, y, h, layer_jump)
    if mean is None:
        raise ValueError("a raster with points has an average")
    mean.noise = max(raster.noise / np.sqrt(np.median(count)), MIN_SCANNER_NOISE)
    return mean
