"""The road's own height, followed outward from the vehicle's track, and where it ends when no edge says so."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import correlate1d, uniform_filter1d

from .ground_grid import COLUMN_WIDTH, ROW_LENGTH, known_median

MAX_HEIGHT_DEVIATION = 0.035          # m off the height that the road promised: a curb, a car, an island
NOISE_FACTOR = 2.0           # times the error of a cell's height on top
TOLERANCE_GAIN, MAX_TOLERANCE_GAIN = 0.02, 0.05  # m on top per metre passed over unseen, at most: behind an island the promise is less sure
TRACK_HALF_WIDTH = 0.6           # m either side of the reference line from which the road starts
HEIGHT_GAIN, TILT_GAIN = 0.5, 0.15   # how fast height and tilt follow what is seen
MAX_CROSS_SLOPE = 0.12       # m per m across a road
ROW_SMOOTHING_SIGMA = 1.0           # m, sigma: neighbouring rows are one road


@dataclass
class RoadHeight:
    """`height` (rows, columns): the road's local z, also under what stands on it; `ground` where the cell shows it;
    `noise` (m): the usual scatter of a cell's points about the road."""

    height: np.ndarray
    ground: np.ndarray
    noise: float


def follow_road(cells, prior):
    """Follow the road outward from the reference line, column by column.

    A cell that lies where its inner neighbours point belongs to the road and
    teaches the next ones; one that does not (a car, an island, nothing at all)
    is passed over on the way they point. Rows learn from the rows beside them.

    Parameters
    ----------
    cells : GroundCells of a road
    prior : (rows,) the road's local z under the vehicle, good to decimetres

    Returns
    -------
    RoadHeight, or None where nothing lies near the track
    """
    offsets = cells.offsets
    track = np.abs(offsets) < TRACK_HALF_WIDTH
    base = known_median(cells.height[:, track] - prior[:, None], 1)
    noise = float(known_median(cells.rough[:, np.abs(offsets) < 3.0].ravel(), 0))
    if not np.isfinite(base).any():
        return None
    noise = noise if np.isfinite(noise) else 0.01
    base = prior + _running_median(base, 5)
    relative = cells.height - base[:, None]
    height, ground = np.full(relative.shape, np.nan), np.zeros(relative.shape, bool)
    middle = int(np.flatnonzero(offsets > 0)[0])
    start = _starting_tilt(relative, offsets)
    # both sides at once, as far as both go
    both = min(middle, len(offsets) - middle)
    columns = np.stack([middle + np.arange(both), middle - 1 - np.arange(both)], axis=1)
    _walk(relative, cells.count, columns, start, noise, height, ground)
    return RoadHeight((height + base[:, None]).astype(np.float32), ground, noise)


def _running_median(values, reach):
    """Median over 2 reach + 1 rows; gaps are filled from the nearest rows."""
    rows = np.arange(len(values))
    known = np.isfinite(values)
    filled = np.interp(rows, rows[known], values[known])
    padded = np.pad(filled, reach, mode="edge")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1), axis=1)


def _starting_tilt(relative, offsets):
    """Tilt across under the vehicle, (rows,)."""
    near = np.abs(offsets) < 2 * TRACK_HALF_WIDTH
    left = known_median(relative[:, near & (offsets > 0)], 1)
    right = known_median(relative[:, near & (offsets < 0)], 1)
    tilt = (left - right) / (2 * TRACK_HALF_WIDTH)
    return np.clip(_running_median(tilt, 5), -MAX_CROSS_SLOPE, MAX_CROSS_SLOPE) if np.isfinite(tilt).any() else np.zeros(len(tilt))


def _walk(relative, count, columns, start, noise, height, ground):
    """Follow both sides outward, (K, 2) columns; fills `height` and `ground` in place."""
    tilt = np.stack([start, -start])
    z, unseen = np.zeros_like(tilt), np.zeros_like(tilt)
    count = np.nan_to_num(count)
    error, most = NOISE_FACTOR * noise / np.sqrt(np.clip(count, 1.0, 25.0)), np.minimum(count, 20.0)
    kernel = _bell(ROW_SMOOTHING_SIGMA / ROW_LENGTH)
    for k, pair in enumerate(columns):
        promised = z + tilt * (0.5 * COLUMN_WIDTH if k == 0 else COLUMN_WIDTH)
        there = relative[:, pair].T
        off = there - promised
        tolerance = MAX_HEIGHT_DEVIATION + error[:, pair].T + np.minimum(TOLERANCE_GAIN * np.maximum(unseen - 0.5, 0.0), MAX_TOLERANCE_GAIN)
        seen = np.abs(off) < tolerance   # not where there is nothing
        off = np.where(seen, off, 0.0)
        # what is nearly off the road teaches little: a low curb must not be climbed
        weight = np.where(seen, (1.0 - (off / tolerance) ** 2) ** 2, 0.0) * most[:, pair].T
        # what the rows around see, weighed by their points: one row's gap is filled by its neighbours
        total, around = correlate1d(np.stack([weight, off * weight]), kernel, mode="nearest")
        around /= np.maximum(total, 1e-9)
        certainty = np.minimum(total / 3.0, 1.0)
        # found again behind something, the height is taken as it is seen
        z = promised + np.where(unseen > 0.5, 1.0, HEIGHT_GAIN) * certainty * around
        tilt = np.clip(tilt + TILT_GAIN * certainty * around / COLUMN_WIDTH, -MAX_CROSS_SLOPE, MAX_CROSS_SLOPE)
        tilt = correlate1d(tilt, kernel, mode="nearest")
        unseen = np.where(certainty > 0.5, 0.0, unseen + COLUMN_WIDTH)
        height[:, pair] = z.T
        ground[:, pair] = (np.abs(there - z) < tolerance).T


def _bell(sigma):
    """Weights of a normal distribution, out to four sigmas."""
    reach = int(4.0 * sigma + 0.5)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return weights / weights.sum()


def smooth_road(road, cells):
    """The road's height where ground is seen, smoothed over the cells around; elsewhere as it was followed.

    Following lags behind on a crown; with the ground known, a mean of plain cells does not.
    """
    weight = np.where(road.ground, np.minimum(cells.count, 20.0), 0.0)
    off = np.where(road.ground, np.nan_to_num(cells.height - road.height), 0.0)

    def blurred(values):
        return uniform_filter1d(uniform_filter1d(values, 5, axis=0, mode="nearest"), 3, axis=1, mode="nearest")

    total = blurred(weight)
    return road.height + np.where(total > 1e-6, blurred(off * weight) / np.maximum(total, 1e-9), 0.0)
