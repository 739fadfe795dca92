"""A raster of the ground in plan: cells of local map coordinates, with the points of the lowest layer in each.

Profiles across the road show a curb that runs along it. A curb that turns into a side street, or goes around an island, may have any direction: it is
looked for in plan, where level ground that is connected with the driven track ends at a rise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...common.arrays import order_by
from ...lazy import cv2
from ..common.pseudo_scanlines import lowest_layers
from ..weights import CURBS, RETURN


@dataclass
class GroundRaster:
    """Ground of a stretch of road on a grid of local map coordinates."""

    x0: float   # x0, y0: m, the grid's corner, a whole number of cells from 0
    y0: float
    x: np.ndarray   # x, y, h: (N,) m, the points of the lowest layer; h above the expected road
    y: np.ndarray
    h: np.ndarray
    place: np.ndarray   # (N,) the cell of each, row * columns + column
    low: np.ndarray   # (rows, columns) m, mean height of the lowest layer, NaN where there is no point
    noise: float   # m, spread of heights within a cell of level ground

    @property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """(2,) m each, local corners of the grid and of a cell about it."""
        corner = np.array([self.x0, self.y0])
        return corner - RETURN.plan_cell, corner + RETURN.plan_cell * (np.array(self.low.shape[::-1]) + 1)

    def inside(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of those local places, (N,) m, that lie on the grid."""
        row, column = self.cells_at(x, y)
        on = (row >= 0) & (column >= 0) & (row < self.low.shape[0]) & (column < self.low.shape[1])
        return row[on], column[on]

    def cells_at(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of local places, also of those beyond the grid."""
        row, column = (np.floor(np.asarray(v) / RETURN.plan_cell - np.rint(v0 / RETURN.plan_cell)).astype(np.int64)
                       for v, v0 in ((y, self.y0), (x, self.x0)))
        return row, column

    def nearest_cells(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of the cells of the grid that are nearest to local places."""
        row, column = self.cells_at(x, y)
        return np.clip(row, 0, self.low.shape[0] - 1), np.clip(column, 0, self.low.shape[1] - 1)

    def middle(self, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Local x, y of the middle of cells."""
        return self.x0 + (column + 0.5) * RETURN.plan_cell, self.y0 + (row + 0.5) * RETURN.plan_cell

    @cached_property
    def by_cell(self) -> tuple[np.ndarray, ...]:
        """The points sorted by cell.

        Returns
            x, y, h : (N,) m, the points
            starts : (rows * columns + 1,) index of the first point of every cell
        """
        order = order_by(self.place)
        starts = np.zeros(self.low.size + 1, np.int64)
        np.cumsum(np.bincount(self.place, minlength=self.low.size), out=starts[1:])
        return self.x.take(order), self.y.take(order), self.h.take(order), starts


def ground_raster(x: np.ndarray, y: np.ndarray, h: np.ndarray, layer_jump: float) -> GroundRaster | None:
    """The ground of points, cell by cell; None where there are none.

    x, y : (N,) local m
    h : (N,) m above the expected road
    layer_jump : m of height between ground and what is above it
    """
    near = np.flatnonzero((h > -RETURN.plan_ground_depth) & (h < RETURN.plan_ground_height))
    if not len(near):
        return None
    x, y, h = (v if len(near) == len(h) else v.take(near) for v in (x, y, h))
    column, row = np.floor(x / RETURN.plan_cell).astype(np.int32), np.floor(y / RETURN.plan_cell).astype(np.int32)
    first_column, first_row = int(column.min()), int(row.min())
    columns, rows = int(column.max()) - first_column + 1, int(row.max()) - first_row + 1
    row -= first_row
    row *= columns
    column -= first_column
    cell = row
    cell += column
    n, total, squares = _sums(cell, h, rows * columns)
    parted, above = _above_ground(cell, h, n, total, squares, layer_jump)
    if above.any():
        ground = np.flatnonzero(~above)
        x, y, h, cell = (v.take(ground) for v in (x, y, h, cell))
        # in the other cells all points are ground
        in_parted = np.flatnonzero(parted.take(cell))
        for old, new in zip((n, total, squares), _sums(cell.take(in_parted), h.take(in_parted), rows * columns)):
            np.copyto(old, new, where=parted)
    with np.errstate(invalid="ignore", divide="ignore"):
        low = total / n
        spread = np.sqrt(np.maximum(squares - total * low, 0.0) / (n - 1))
    # curbs and grass are rough to any scanner, so the smoother cells give the estimate
    spread = spread[n >= RETURN.min_noise_points]
    enough = len(spread) >= RETURN.min_noise_cells
    noise = max(float(np.quantile(spread, RETURN.noise_quantile)), CURBS.min_scanner_noise) if enough else CURBS.default_scanner_noise
    return GroundRaster(first_column * RETURN.plan_cell, first_row * RETURN.plan_cell, x, y, h, cell, low.reshape(rows, columns), noise)


def _above_ground(place, h, n, total, squares, layer_jump):
    """Which cells may have several layers, and (N,) bool: does a point lie in another layer than the lowest of its cell?"""
    with np.errstate(invalid="ignore", divide="ignore"):
        # heights on either side of a gap have at least this sum of squares about their mean
        parted = squares - total * total / n > 0.99 * layer_jump**2 * (n - 1) / n
    above = np.zeros(len(h), bool)
    indices = np.flatnonzero(parted.take(place))
    if len(indices):
        order = indices.take(order_by(np.rint((h.take(indices) + RETURN.plan_ground_depth) * 1e4).astype(np.int32), place.take(indices)))
        ground, _, _ = lowest_layers(place.take(order), h.take(order), layer_jump)
        above[order] = ~ground
    return parted, above


def _sums(place, h, cells):
    """Of every cell the number of points, the sum of their heights, and of the squares of these."""
    place = place.astype(np.intp)
    return np.bincount(place, minlength=cells), np.bincount(place, h, cells), np.bincount(place, h * h, cells)


def averaged(raster: GroundRaster | None, layer_jump: float) -> GroundRaster | None:
    """A raster of the mean points of cells RETURN.averaging_cell wide, which reduces the noise; `noise` is what remains of it.

    None where there are no points.
    """
    if raster is None:
        return None
    column, row = np.floor(raster.x / RETURN.averaging_cell).astype(np.int64), np.floor(raster.y / RETURN.averaging_cell).astype(np.int64)
    cell = (row - row.min()) * (column.max() - column.min() + 1) + column - column.min()
    count = np.bincount(cell)
    occupied = np.flatnonzero(count)
    count = count[occupied]
    x, y, h = (np.bincount(cell, v)[occupied] / count for v in (raster.x, raster.y, raster.h))
    mean = ground_raster(x, y, h, layer_jump)
    if mean is None:
        raise ValueError("a raster with points has an average")
    mean.noise = max(raster.noise / np.sqrt(np.median(count)), CURBS.min_scanner_noise)
    return mean


# Level ground that is connected with the driven track, and where the ground is stepped.

OUT_OF_RANGE_HEIGHT = 1e6   # derived: m, farther up and down than any ground


def ground_slopes(low: np.ndarray) -> list[np.ndarray]:
    """Slope of the ground about every cell.

    It is the median over a few metres, so that steps do not contribute, and no more than a road's, so that banks are not level.

    low : (rows, columns) m

    Returns two (rows, columns) arrays, m per m along columns and along rows
    """
    rows, columns = low.shape
    padded = np.pad(low, ((0, -rows % RETURN.slope_block_cells), (0, -columns % RETURN.slope_block_cells)), constant_values=np.nan)
    blocks = padded.reshape(padded.shape[0] // RETURN.slope_block_cells, RETURN.slope_block_cells, -1, RETURN.slope_block_cells)
    filled = np.isfinite(blocks)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.where(filled, blocks, 0.0).sum((1, 3)) / filled.sum((1, 3))
    result = []
    for axis in (1, 0):
        slope = np.full(mean.shape, np.nan)
        ahead, behind = (slice(None), slice(1, None)), (slice(None), slice(None, -1))
        if axis == 0:
            ahead, behind = ahead[::-1], behind[::-1]
        slope[behind] = (mean[ahead] - mean[behind]) / (RETURN.slope_block_cells * RETURN.plan_cell)
        slope = np.clip(_median_about(slope, RETURN.slope_window_blocks), -RETURN.max_ground_slope, RETURN.max_ground_slope)
        result.append(np.repeat(np.repeat(slope, RETURN.slope_block_cells, 0), RETURN.slope_block_cells, 1)[:rows, :columns])
    return result


def _median_about(values, size):
    """Median of a square of cells about each one, without NaN; 0 where there is nothing else."""
    around = np.lib.stride_tricks.sliding_window_view(np.pad(values, size // 2, constant_values=np.nan), (size, size))
    count = cv2.boxFilter(np.isfinite(values).astype(np.uint8), cv2.CV_32S, (size, size), normalize=False, borderType=cv2.BORDER_CONSTANT)
    middle = np.zeros(values.shape)
    full, partial = count == size * size, (count > 0) & (count < size * size)
    middle[full] = np.partition(around[full].reshape(-1, size * size), size * size // 2, axis=1)[:, size * size // 2]
    ordered = np.sort(around[partial].reshape(-1, size * size), axis=1)
    middle[partial] = ordered[np.arange(len(ordered)), (count[partial] - 1) // 2]
    return middle


def driven_ground(raster: GroundRaster, slopes: Sequence[np.ndarray], track_x: np.ndarray, track_y: np.ndarray,
                  behind: np.ndarray, barrier_x: np.ndarray, barrier_y: np.ndarray,
                  min_height: float) -> tuple[np.ndarray, np.ndarray]:
    """Level ground connected with the driven track, and where the ground is stepped.

    slopes : result of `ground_slopes`
    track_x, track_y : (N,) local m, places along the driven tracks, less than RETURN.plan_cell apart
    behind : (2, K) local m, x and y of places that are road although an island stands between them and the track
    barrier_x, barrier_y : (L,) local m, places along lines that are known to bound the road
    min_height : m, the least step

    Returns
        driven : (rows, columns) bool
        stepped : (rows, columns) bool, occupied cells about which the ground rises more than its slope explains
    """
    filled = np.isfinite(raster.low)
    window = np.ones((RETURN.level_window_cells, RETURN.level_window_cells), np.uint8)
    span = cv2.dilate(np.where(filled, raster.low, -OUT_OF_RANGE_HEIGHT), window) \
        - cv2.erode(np.where(filled, raster.low, OUT_OF_RANGE_HEIGHT), window)
    level = span <= RETURN.max_level_share * min_height + (np.abs(slopes[0]) + np.abs(slopes[1])) * (RETURN.level_window_cells - 1) * RETURN.plan_cell
    track = np.zeros(filled.shape, bool)
    track[raster.inside(track_x, track_y)] = True
    # what lies next to the ground that the vehicle itself hides is connected with the track
    passable = level & grown(filled, diamond(RETURN.max_bridged_cells)) | ~filled & grown(track, diamond(RETURN.blind_cells))
    barrier = np.zeros(filled.shape, bool)
    barrier[raster.inside(barrier_x, barrier_y)] = True
    passable &= ~grown(barrier, np.ones((3, 3), np.uint8))
    count, label = cv2.connectedComponents(passable.view(np.uint8), connectivity=4)
    track[raster.inside(*behind)] = True
    wanted = np.zeros(count, bool)
    wanted[label[track & passable]] = True
    wanted[0] = False
    return wanted[label], filled & ~level


def grown(mask: np.ndarray, about: np.ndarray) -> np.ndarray:
    """(rows, columns) bool: is a cell of the mask, (rows, columns) bool, among those about each one, (K, K) uint8 with K odd?"""
    return cv2.dilate(mask.view(np.uint8), about).view(bool)


def diamond(reach: int) -> np.ndarray:
    """(2 reach + 1, 2 reach + 1) uint8: 1 in cells up to `reach` away, counted along rows and columns."""
    distance = np.abs(np.arange(-reach, reach + 1))
    return (distance[:, None] + distance <= reach).astype(np.uint8)
