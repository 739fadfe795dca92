"""Level ground that is connected with the driven track, and where the ground is stepped."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....lazy import cv2
from .raster import PLAN_CELL, GroundRaster

OUT_OF_RANGE_HEIGHT = 1e6     # m, farther up and down than any ground
LEVEL_WINDOW_CELLS = 5        # cells, side of the square in which ground is tested for being level
MAX_LEVEL_SHARE = 0.7         # share of the least step that level ground may differ within that square
SLOPE_BLOCK_CELLS = 5         # cells, side of a block, and
SLOPE_WINDOW_BLOCKS = 5       # blocks, side of the window from which the slope of the ground is estimated
MAX_GROUND_SLOPE = 0.12       # rise over run of a road
DRIVEN_HALF_WIDTH = 0.75      # m beside a driven track that is certainly road
MAX_BRIDGED_CELLS = 3         # cells without points that count as drivable between others: scan lines lie apart


def ground_slopes(low: np.ndarray) -> list[np.ndarray]:
    """Slope of the ground about every cell.

    It is the median over a few metres, so that steps do not contribute, and no more than a road's, so that banks are not level.

    Parameters
    ----------
    low : (rows, columns) m

    Returns
    -------
    two (rows, columns) arrays, m per m along columns and along rows
    """
    rows, columns = low.shape
    padded = np.pad(low, ((0, -rows % SLOPE_BLOCK_CELLS), (0, -columns % SLOPE_BLOCK_CELLS)), constant_values=np.nan)
    blocks = padded.reshape(padded.shape[0] // SLOPE_BLOCK_CELLS, SLOPE_BLOCK_CELLS, padded.shape[1] // SLOPE_BLOCK_CELLS, SLOPE_BLOCK_CELLS)
    there = np.isfinite(blocks)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.where(there, blocks, 0.0).sum((1, 3)) / there.sum((1, 3))
    found = []
    for axis in (1, 0):
        slope = np.full(mean.shape, np.nan)
        ahead, behind = (slice(None), slice(1, None)), (slice(None), slice(None, -1))
        if axis == 0:
            ahead, behind = ahead[::-1], behind[::-1]
        slope[behind] = (mean[ahead] - mean[behind]) / (SLOPE_BLOCK_CELLS * PLAN_CELL)
        slope = np.clip(_median_about(slope, SLOPE_WINDOW_BLOCKS), -MAX_GROUND_SLOPE, MAX_GROUND_SLOPE)
        found.append(np.repeat(np.repeat(slope, SLOPE_BLOCK_CELLS, 0), SLOPE_BLOCK_CELLS, 1)[:rows, :columns])
    return found


def _median_about(values, size):
    """Median of a square of cells about each one, without NaN; 0 where there is nothing else."""
    around = np.lib.stride_tricks.sliding_window_view(np.pad(values, size // 2, constant_values=np.nan), (size, size))
    count = cv2.boxFilter(np.isfinite(values).astype(np.uint8), cv2.CV_32S, (size, size), normalize=False, borderType=cv2.BORDER_CONSTANT)
    middle = np.zeros(values.shape)
    full, some = count == size * size, (count > 0) & (count < size * size)
    middle[full] = np.partition(around[full].reshape(-1, size * size), size * size // 2, axis=1)[:, size * size // 2]
    ordered = np.sort(around[some].reshape(-1, size * size), axis=1)
    middle[some] = ordered[np.arange(len(ordered)), (count[some] - 1) // 2]
    return middle


def driven_ground(raster: GroundRaster, slopes: Sequence[np.ndarray], track_x: np.ndarray, track_y: np.ndarray,
                  inner: Sequence[np.ndarray], barrier_x: np.ndarray, barrier_y: np.ndarray,
                  min_height: float) -> tuple[np.ndarray, np.ndarray]:
    """Level ground connected with the driven track, and where the ground is stepped.

    Parameters
    ----------
    raster : GroundRaster
    slopes : result of `ground_slopes`
    track_x, track_y : (N,) local m, places along the driven tracks, less than PLAN_CELL apart
    inner : (x, y), each (K,) local m, places between the road's own curbs
    barrier_x, barrier_y : (L,) local m, places along lines that are known to bound the road
    min_height : m, the least step

    Returns
    -------
    driven : (rows, columns) bool
    stepped : (rows, columns) bool, occupied cells about which the ground rises more than its slope explains
    """
    there = np.isfinite(raster.low)
    window = np.ones((LEVEL_WINDOW_CELLS, LEVEL_WINDOW_CELLS), np.uint8)
    span = cv2.dilate(np.where(there, raster.low, -OUT_OF_RANGE_HEIGHT), window) - cv2.erode(np.where(there, raster.low, OUT_OF_RANGE_HEIGHT), window)
    level = span <= MAX_LEVEL_SHARE * min_height + (np.abs(slopes[0]) + np.abs(slopes[1])) * (LEVEL_WINDOW_CELLS - 1) * PLAN_CELL
    passable = level & grown(there, diamond(MAX_BRIDGED_CELLS))
    barrier = np.zeros(there.shape, bool)
    barrier[raster.inside(barrier_x, barrier_y)] = True
    passable &= ~grown(barrier, np.ones((3, 3), np.uint8))
    count, label = cv2.connectedComponents(passable.view(np.uint8), connectivity=4)
    track = np.zeros(there.shape, bool)
    track[raster.inside(track_x, track_y)] = True
    track = grown(track, diamond(int(round(DRIVEN_HALF_WIDTH / PLAN_CELL))))
    track[raster.inside(*inner)] = True
    wanted = np.zeros(count, bool)
    wanted[label[track & passable]] = True
    wanted[0] = False
    return wanted[label], there & ~level


def grown(mask: np.ndarray, about: np.ndarray) -> np.ndarray:
    """(rows, columns) bool: is a cell of the mask, (rows, columns) bool, among those about each one, (K, K) uint8 with K odd?"""
    return cv2.dilate(mask.view(np.uint8), about).view(bool)


def diamond(reach: int) -> np.ndarray:
    """(2 reach + 1, 2 reach + 1) uint8: 1 in cells up to `reach` away, counted along rows and columns."""
    away = np.abs(np.arange(-reach, reach + 1))
    return (away[:, None] + away <= reach).astype(np.uint8)
