"""The height of the road, followed outward from the track of the vehicle, cell by cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import correlate1d, uniform_filter1d

from ...common.parallel import by_rows, check_cancelled
from .ground_grid import COLUMN_WIDTH, ROW_LENGTH, GroundCells, known_median

MAX_HEIGHT_DEVIATION = 0.035  # m from the predicted height: more is a curb, a car or an island
NOISE_FACTOR = 2.0            # times the standard error of the height of a cell, added to it
TOLERANCE_GAIN, MAX_TOLERANCE_GAIN = 0.02, 0.05  # m per m without ground, and m at most: behind an island the prediction is uncertain
TRACK_HALF_WIDTH = 0.6        # m either side of the reference line, where the road is known to be
HEIGHT_GAIN, TILT_GAIN = 0.5, 0.15  # share of a deviation by which predicted height and tilt are corrected
MAX_CROSS_SLOPE = 0.12        # m per m across the road
ROW_SMOOTHING_SIGMA = 1.0     # m along the road
SMOOTHED_COLUMNS = 16         # columns smoothed along the road at a time
CELLS_BETWEEN_QUESTIONS = 100_000   # followed until Cancel is asked for: some 50 ms


@dataclass
class RoadHeight:
    """The height of a road on a grid of R rows and C columns.

    Attributes
    ----------
    height : (R, C) float32 m, local z of the road, also under obstacles
    ground : (R, C) bool, cells that show the road itself
    noise : m, median standard deviation of the points of a cell
    """

    height: np.ndarray
    ground: np.ndarray
    noise: float


def follow_road(cells: GroundCells, prior: np.ndarray) -> RoadHeight | None:
    """Follow the road outward from the reference line, column by column.

    Each column is predicted from the height and the tilt of the one before it. Cells near the prediction belong to the
    road and correct height and tilt. Other cells (a car, an island, no ground) are skipped, and the prediction is
    continued. Corrections are averaged over neighbouring rows. The method is our own.

    Parameters
    ----------
    cells : GroundCells of a road, R rows
    prior : (R,) m, local z of the road under the vehicle, accurate to decimetres

    Returns
    -------
    RoadHeight, or None where no ground was measured near the track
    """
    offsets = cells.offsets
    track = np.abs(offsets) < TRACK_HALF_WIDTH
    base = known_median(cells.height[:, track] - prior[:, None], 1)
    noise = float(known_median(cells.rough[:, np.abs(offsets) < 3.0].ravel(), 0))
    if not np.isfinite(base).any():
        return None
    noise = noise if np.isfinite(noise) else 0.01
    base = prior + _running_median(base, 5)
    height, ground = np.full(cells.height.shape, np.nan, np.float32), np.zeros(cells.height.shape, bool)
    middle = int(np.flatnonzero(offsets > 0)[0])
    start = _starting_tilt(cells.height, base, offsets)
    # both sides at once, as far as the narrower one
    both = min(middle, len(offsets) - middle)
    columns = np.stack([middle + np.arange(both), middle - 1 - np.arange(both)], axis=1)
    _walk(cells, base, columns, start, noise, height, ground)
    return RoadHeight(height, ground, noise)


def _running_median(values, reach):
    """Median over 2 * reach + 1 rows; gaps are interpolated before."""
    rows = np.arange(len(values))
    known = np.isfinite(values)
    filled = np.interp(rows, rows[known], values[known])
    padded = np.pad(filled, reach, mode="edge")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1), axis=1)


def _starting_tilt(height, base, offsets):
    """(R,) m per m, cross slope under the vehicle."""
    near = np.abs(offsets) < 2 * TRACK_HALF_WIDTH
    left, right = (known_median(height[:, near & side] - base[:, None], 1) for side in (offsets > 0, offsets < 0))
    tilt = (left - right) / (2 * TRACK_HALF_WIDTH)
    return np.clip(_running_median(tilt, 5), -MAX_CROSS_SLOPE, MAX_CROSS_SLOPE) if np.isfinite(tilt).any() else np.zeros(len(tilt))


def _walk(cells, base, columns, start, noise, height, ground):
    """Follow both sides outward from the heights `base` under the vehicle, (K, 2) columns; fills `height` and `ground` in place."""
    tilt = np.stack([start, -start])
    z, skipped = np.zeros_like(tilt), np.zeros_like(tilt)
    kernel = _bell(ROW_SMOOTHING_SIGMA / ROW_LENGTH)
    step = max(CELLS_BETWEEN_QUESTIONS // tilt.size, 1)
    # one pair of columns after the other: of the whole road nothing is there but what comes in and goes out
    for k, pair in enumerate(columns):
        if k % step == step - 1:
            check_cancelled()
        predicted = z + tilt * (0.5 * COLUMN_WIDTH if k == 0 else COLUMN_WIDTH)
        there, count = (cells.height[:, pair] - base[:, None]).T, np.nan_to_num(cells.count[:, pair]).T
        off = there - predicted
        tolerance = MAX_HEIGHT_DEVIATION + NOISE_FACTOR * noise / np.sqrt(np.clip(count, 1.0, 25.0)) \
            + np.minimum(TOLERANCE_GAIN * np.maximum(skipped - 0.5, 0.0), MAX_TOLERANCE_GAIN)
        near = np.abs(off) < tolerance   # False where there is no ground
        off = np.where(near, off, 0.0)
        # cells near the tolerance have little weight: the surface must not climb a low curb
        weight = np.where(near, (1.0 - (off / tolerance) ** 2) ** 2, 0.0) * np.minimum(count, 20.0)
        # weighted mean over neighbouring rows, which fill the gaps of a row
        total, around = correlate1d(np.stack([weight, off * weight]), kernel, mode="nearest")
        around /= np.maximum(total, 1e-9)
        certainty = np.minimum(total / 3.0, 1.0)
        # behind a gap the measured height replaces the prediction
        z = predicted + np.where(skipped > 0.5, 1.0, HEIGHT_GAIN) * certainty * around
        tilt = np.clip(tilt + TILT_GAIN * certainty * around / COLUMN_WIDTH, -MAX_CROSS_SLOPE, MAX_CROSS_SLOPE)
        tilt = correlate1d(tilt, kernel, mode="nearest")
        skipped = np.where(certainty > 0.5, 0.0, skipped + COLUMN_WIDTH)
        height[:, pair] = (z + base).T
        ground[:, pair] = (np.abs(there - z) < tolerance).T


def _bell(sigma):
    """Weights of a normal distribution up to four sigma."""
    reach = int(4.0 * sigma + 0.5)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return weights / weights.sum()


def smooth_road(road: RoadHeight, cells: GroundCells) -> np.ndarray:
    """The height of the road smoothed over the cells that show ground; elsewhere as it was followed.

    Following lags behind on a crowned road. A mean over 5 rows and 3 columns, weighted by points, does not.

    Parameters
    ----------
    road : RoadHeight
    cells : GroundCells of the same grid

    Returns
    -------
    (R, C) m, local z
    """
    # a running mean along the road depends on its rows, and not on other columns
    total, rise = np.empty((2, *road.height.shape), np.float32)
    for first in range(0, road.height.shape[1], SMOOTHED_COLUMNS):
        some = slice(first, first + SMOOTHED_COLUMNS)
        ground = road.ground[:, some]
        weight = np.where(ground, np.minimum(cells.count[:, some], 20.0), 0.0)
        off = np.where(ground, np.nan_to_num(cells.height[:, some] - road.height[:, some]), 0.0)
        for values, whole in ((weight, total), (off * weight, rise)):
            uniform_filter1d(values, 5, axis=0, mode="nearest", output=whole[:, some])

    def smoothed(some):
        about, above = (uniform_filter1d(values[some], 3, axis=1, mode="nearest") for values in (total, rise))
        return road.height[some] + np.where(about > 1e-6, above / np.maximum(about, 1e-9), 0.0)

    return by_rows(smoothed, len(road.height))
