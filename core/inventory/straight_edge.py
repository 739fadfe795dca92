"""Rut depth under a straight edge."""

from __future__ import annotations

import numpy as np

from .surface_grid import CROSS_CELL

EDGE_LENGTH = 2.0           # m of the straight edge (EN 13036-7)
EDGE_STEP = 0.10            # m between the places where it is laid
SMOOTHING_CELLS = 3         # cells of the profile that are averaged: less than the width of a tyre
# slopes against the profile's own of the lines that make its upper hull, m/m: fine where most lie, 0.5 mm of depth at most; coarse up to those of
# the steepest ridges, where a road falls to both sides by as much as it may anywhere (8 %), since there an edge laid askew would show a rut
FINE_SLOPE, FINE_STEP = 0.03, 0.001
STEEPEST, COARSE_STEP = 0.18, 0.005
MAX_STEP_PER_CELL = 0.02    # m from one cell to the next: more is a curb or an island, on which no edge is laid
MAX_GAP_CELLS = 3           # unseen cells that the edge may bridge
MIN_SEEN = 0.8              # share of the cells under the edge that must be measured
WHEEL_REACH = 0.3           # m that the edge may reach beyond the lane, where the carriageway goes on


def rut_depths(d: np.ndarray, profiles: np.ndarray, lane: tuple[float, float], carriageway: tuple[float, float],
               sigma: np.ndarray) -> np.ndarray:
    """Rut depth of the two wheel paths of a lane: the greatest distance of the profile below the straight edge, less what noise adds.

    The edge is laid over the profile everywhere within the lane. It rests on the upper convex hull of what is under it. Noise lifts the
    largest of n distances by about ``sigma sqrt(2 ln n)``, with sigma that of a smoothed cell, which is subtracted.

    Parameters
    ----------
    d : (J,) m, offsets of the cells, CROSS_CELL apart, ascending
    profiles : (I, J) m, heights of I profiles; NaN where the road was not seen
    lane, carriageway : (right, left) m, between whose borders the edge is laid
    sigma : (I,) m, of the height of one cell

    Returns
    -------
    (2, I) m, >= 0, of the right and the left wheel path, seen along the road; NaN where the profile has gaps

    References
    ----------
    Straight edge: EN 13036-7. Largest of n normal deviates: sigma sqrt(2 ln n), an upper bound of its expectation.
    """
    count = int(round(EDGE_LENGTH / CROSS_CELL)) + 1
    low = max(lane[0] - WHEEL_REACH, carriageway[0])
    high = min(lane[1] + WHEEL_REACH, carriageway[1])
    smooth = smoothed(profiles)
    found = np.full((2, len(profiles)), np.nan)
    first, last = int(np.searchsorted(d, low)), int(np.searchsorted(d, high)) - count
    if last < first:
        return found
    middle = 0.5 * (lane[0] + lane[1])
    broken = _breaks(profiles)
    for start in range(first, last + 1, max(int(round(EDGE_STEP / CROSS_CELL)), 1)):
        under, heights = d[start:start + count], smooth[:, start:start + count]
        known = np.isfinite(heights)
        depth = hull_height(under, heights) - heights
        depth[(known.mean(axis=1) < MIN_SEEN) | broken[:, start:start + count].any(axis=1)] = np.nan
        for half, own in enumerate((under < middle, under >= middle)):
            if own.any():
                found[half] = np.fmax(found[half], np.where(known[:, own], depth[:, own], -np.inf).max(axis=1) + np.where(
                    np.isfinite(depth).any(axis=1), 0.0, np.nan))
    found[~np.isfinite(found)] = np.nan
    return np.maximum(found - noise_of_largest(sigma), 0.0)


def _breaks(profiles):
    """(I, J) whether the road breaks off beside a cell: at a step up or down, or where too many cells are unseen."""
    found = np.zeros(profiles.shape, bool)
    for lag in range(1, MAX_GAP_CELLS + 2):
        apart = np.abs(profiles[:, lag:] - profiles[:, :-lag])
        found[:, :profiles.shape[1] - lag] |= apart > MAX_STEP_PER_CELL * lag
    unseen = np.cumsum(np.pad(np.isnan(profiles), ((0, 0), (1, MAX_GAP_CELLS + 1)), constant_values=False), axis=1)
    return found | (unseen[:, MAX_GAP_CELLS + 1:-1] - unseen[:, :-MAX_GAP_CELLS - 2] > MAX_GAP_CELLS)


def noise_of_largest(sigma: np.ndarray) -> np.ndarray:
    """(I,) m that noise of (I,) m in every cell adds to the largest distance below the edge."""
    independent = EDGE_LENGTH / (SMOOTHING_CELLS * CROSS_CELL)
    return np.asarray(sigma) / np.sqrt(SMOOTHING_CELLS) * np.sqrt(2.0 * np.log(independent))


def smoothed(profiles: np.ndarray) -> np.ndarray:
    """(I, J) means over SMOOTHING_CELLS neighbours, across gaps of up to MAX_GAP_CELLS; NaN at wider ones."""
    filled = _bridged(profiles)
    reach = SMOOTHING_CELLS // 2
    padded = np.pad(filled, ((0, 0), (reach, reach)), constant_values=np.nan)
    means = np.lib.stride_tricks.sliding_window_view(padded, SMOOTHING_CELLS, axis=1).mean(axis=2)
    return np.where(np.isnan(means), filled, means)


def _bridged(profiles):
    """Profiles whose short gaps are filled along straight lines."""
    columns = np.arange(profiles.shape[1])
    known = np.isfinite(profiles)
    before = np.maximum.accumulate(np.where(known, columns, -1), axis=1)
    after = np.minimum.accumulate(np.where(known, columns, profiles.shape[1])[:, ::-1], axis=1)[:, ::-1]
    gap = ~known & (before >= 0) & (after < profiles.shape[1]) & (after - before <= MAX_GAP_CELLS + 1)
    i, j = np.nonzero(gap)
    low, high = before[i, j], after[i, j]
    filled = profiles.copy()
    filled[i, j] = profiles[i, low] + (j - low) / (high - low) * (profiles[i, high] - profiles[i, low])
    return filled


def hull_height(x: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """(I, K) upper convex hull of I profiles at (K,) x: the lowest of the lines of all slopes that lie on top of a profile.

    NaN heights carry nothing. A profile without heights gives -inf.
    """
    known = np.isfinite(heights)
    at = x - x.mean()
    level = np.where(known, heights, 0.0)
    n = np.maximum(known.sum(axis=1), 1)
    mean_x, mean_z = (known * at).sum(axis=1) / n, level.sum(axis=1) / n
    off = np.where(known, at - mean_x[:, None], 0.0)
    own = (off * level).sum(axis=1) / np.maximum((off**2).sum(axis=1), 1e-9)
    flat = np.where(known, heights - mean_z[:, None] - own[:, None] * (at - mean_x[:, None]), -np.inf)
    steep = np.arange(FINE_SLOPE + COARSE_STEP, STEEPEST + COARSE_STEP / 2, COARSE_STEP)
    slopes = np.r_[-steep, np.arange(-FINE_SLOPE, FINE_SLOPE + FINE_STEP / 2, FINE_STEP), steep]
    top = (flat[:, None, :] - slopes[:, None] * at).max(axis=2)
    hull = (top[:, :, None] + slopes[:, None] * at).min(axis=1)
    return hull + mean_z[:, None] + own[:, None] * (at - mean_x[:, None])
