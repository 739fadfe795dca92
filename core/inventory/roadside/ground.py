"""The ground beside the road: what is left when everything that stands on it is taken away."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import grey_opening, median_filter, minimum_filter1d

from ...common.arrays import order_by
from ...road.common.pseudo_scanlines import lowest_layers

GROUND_SLICE, GROUND_CELL = 1.0, 0.20   # m along and across
STANDING_WIDTH = 2.5      # m: narrower humps of the lowest layer stand on the ground (parked cars, hedges)
GROUND_SHARE = 0.1        # quantile of the lowest layer: at the foot of a wall it reaches up the face
GROUND_JUMP = 0.10        # m of height between two layers
MIN_GROUND_POINTS = 3     # of a lowest layer, with those as high in the slices before and after it
UNSEEN_REACH = 1.0        # m across a gap in the ground that is bridged
FOOT_REACH = 0.4          # m across from a face, within which the ground lies at its foot
SHADOW_SLICES = 3          # slices along within which the foot of a face is seen that a shadow hides
RIM_STEP = 0.3            # m of height within a cell from which it holds a face; between neighbouring cells, from which the higher one stands on the
#                           ground, where nothing was seen beyond it


@dataclass(frozen=True)
class LocalGround:
    """Heights of the ground in cells of a stretch of road.

    start, origin : m, station and offset of the corner
    height : (I, J) m above the line that the points' heights count from; NaN where the ground is not known
    """

    start: float
    origin: float
    height: np.ndarray

    def at(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) heights of the ground at (N,) stations and offsets; NaN where it is not known."""
        i = np.clip(np.floor((s - self.start) / GROUND_SLICE).astype(np.int64), 0, self.height.shape[0] - 1)
        at = np.clip((d - self.origin) / GROUND_CELL - 0.5, 0.0, self.height.shape[1] - 1.0)
        j = np.minimum(at.astype(np.int64), self.height.shape[1] - 2)
        low, high = self.height[i, j], self.height[i, j + 1]
        both = low + (at - j) * (high - low)
        return np.where(np.isfinite(both), both, np.where(np.isfinite(low), low, high))


def local_ground(s: np.ndarray, d: np.ndarray, h: np.ndarray, start: float, slices: int, offsets: tuple[float, float]) -> LocalGround:
    """The ground under points.

    Parameters
    ----------
    s, d, h : (N,) m, stations, offsets and heights above the expected road
    start : m, station of the first slice
    slices : number of slices along the road
    offsets : (right, left) m
    """
    columns = max(int(np.ceil((offsets[1] - offsets[0]) / GROUND_CELL)), 2)
    i, j = np.floor((s - start) / GROUND_SLICE).astype(np.int64), np.floor((d - offsets[0]) / GROUND_CELL).astype(np.int64)
    inside = np.flatnonzero((i >= 0) & (i < slices) & (j >= 0) & (j < columns))
    place, h = (i * columns + j)[inside], h[inside]
    order = order_by(np.rint((h + 100.0) * 1e3).astype(np.int32), place)
    place, h = place[order], h[order]
    _, first, count = lowest_layers(place, h, GROUND_JUMP)
    solid = _supported(place[first], h[first], count, (slices, columns))
    first, count = first[solid], count[solid]
    low, least = np.full((2, slices, columns), np.nan)
    low.flat[place[first]] = h[first + np.rint(GROUND_SHARE * (count - 1)).astype(np.int64)]
    least.flat[place[first]] = h[first + np.minimum(count, MIN_GROUND_POINTS) - 1]
    face = np.zeros((slices, columns), bool)
    face.flat[place[first]] = h[first + count - 1] - h[first] > RIM_STEP
    low = _feet_in_shadow(_feet_beside(low, face), least)
    filled = _filled(low)
    low = _let_down(filled, _rims(low) | _rims(filled))
    known = np.isfinite(low)
    if not known.any():
        return LocalGround(start, offsets[0], low)
    # beyond what is known the ground neither rises nor falls
    level = np.where(known, low, np.inf)
    cells = int(round(STANDING_WIDTH / GROUND_CELL)) | 1
    smooth = median_filter(np.where(known, level, 1e3), size=(3, 1), mode="nearest")
    opened = grey_opening(np.where(smooth > 500.0, level.clip(max=1e3), smooth), size=(1, cells), mode="nearest")
    ground = np.where(known & (opened < 500.0), opened, np.nan)
    return LocalGround(start, offsets[0], _let_down(ground, smooth - ground > RIM_STEP))


def _supported(place, height, count, shape):
    """(L,) bool, which lowest layers have enough points together with those of the slices before and after at their height."""
    number, lowest = np.zeros(shape), np.full(shape, np.nan)
    number.flat[place], lowest.flat[place] = count, height
    number, lowest = np.pad(number, ((1, 1), (0, 0))), np.pad(lowest, ((1, 1), (0, 0)), constant_values=np.nan)
    support = number[1:-1].copy()
    for beside in (slice(None, -2), slice(2, None)):
        support += np.where(np.abs(lowest[beside] - lowest[1:-1]) < GROUND_JUMP, number[beside], 0.0)
    return support.flat[place] >= MIN_GROUND_POINTS


def _feet_beside(low, face):
    """Heights where the foot of a face is no higher than the ground beside it."""
    return np.where(face, np.fmin(low, _continued(np.where(face, np.nan, low), FOOT_REACH)), low)


def _feet_in_shadow(low, least):
    """Heights where the foot of a face that a shadow hides, as of a parked car, is the least that nearby slices see of it."""
    beside = np.pad(low, ((0, 0), (1, 1)), constant_values=np.nan)
    right, left = beside[:, :-2], beside[:, 2:]
    with np.errstate(invalid="ignore"):
        shadowed = np.isnan(right) & ~(left - low < RIM_STEP) | np.isnan(left) & ~(right - low < RIM_STEP)
    seen = np.where(np.isnan(low), np.inf, np.where(shadowed, least, low))
    foot = minimum_filter1d(seen, 2 * SHADOW_SLICES + 1, axis=0, mode="constant", cval=np.inf)
    return np.where(shadowed & (low - foot > GROUND_JUMP), foot, low)


def _filled(low):
    """Gaps across of up to UNSEEN_REACH to either side take the lower of their two ends."""
    left, right = low.copy(), low.copy()
    for _ in range(int(round(UNSEEN_REACH / GROUND_CELL))):
        left[:, 1:] = np.where(np.isnan(left[:, 1:]), left[:, :-1], left[:, 1:])
        right[:, :-1] = np.where(np.isnan(right[:, :-1]), right[:, 1:], right[:, :-1])
    return np.where(np.isnan(low), np.fmin(left, right), low)


def _let_down(low, standing):
    """Heights where what stands has that of the ground beside it; the cells beside it may hold the foot of its face, and are let down too."""
    beside = np.pad(standing, ((0, 0), (1, 1)))
    standing = (standing | beside[:, :-2] | beside[:, 2:]) & np.isfinite(low)
    return np.where(standing, _continued(np.where(standing, np.nan, low), STANDING_WIDTH), low)


def _continued(low, reach):
    """Gaps across take the height of the nearest cell within `reach` (m), of two as near the lower one."""
    low = low.copy()
    for _ in range(int(round(reach / GROUND_CELL))):
        beside = np.pad(low, ((0, 0), (1, 1)), constant_values=np.nan)
        low = np.where(np.isnan(low), np.fmin(beside[:, :-2], beside[:, 2:]), low)
    return low


def _rims(low):
    """(I, J) narrow tops beyond which nothing was seen, as of a wall that hides what lies behind it."""
    rows, columns = low.shape
    cells = np.column_stack([np.full(rows, np.nan), low]).ravel()   # a gap between the rows
    known = np.isfinite(cells)
    step = np.diff(cells, append=np.nan)
    with np.errstate(invalid="ignore"):
        breaks = ~(np.abs(step) < RIM_STEP)          # after a cell: a step, or nothing known on one side
        up, down = step >= RIM_STEP, step <= -RIM_STEP
    group = np.cumsum(np.r_[True, breaks[:-1]]) - 1
    first = np.flatnonzero(np.r_[True, breaks[:-1]])
    last = np.r_[first[1:] - 1, len(cells) - 1]
    unseen = ~known
    before, after = np.maximum(first - 1, 0), np.minimum(last + 1, len(cells) - 1)
    rim = up[before] & unseen[after] | down[last] & unseen[before]
    standing = rim & known[first] & ((last - first + 1) * GROUND_CELL < STANDING_WIDTH)
    return standing[group].reshape(rows, columns + 1)[:, 1:]
