"""The strip about a driven track in which the ground is level beyond doubt: no curb lies in it, and nothing that hides one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...survey.store.records import COORDINATE_SCALE

MAX_STRIP_OFFSET = 8.0        # m from the reference line within which the strip lies
MIN_LEVEL_POINTS = 4          # points that a cell needs for a statement whether it is level
# A step rises within this width, m, even one that runs at an angle to the road, so its height shows in the means of cells so far apart.
MAX_STEP_WIDTH = 0.20
LEVEL_STEP_SHARE = 0.4        # share of the least step height that such means may differ
MAX_STRIP_STD = 0.016         # m, standard deviation of heights in a cell, above which it is not level
MIN_UNEVEN_NEIGHBOURS = 5     # of 15 cells that a step changes; a bird, a drop of rain or a ghost point changes one
BLIND_HALF_WIDTH = 1.5        # m beside the track that may be without points: scanners do not see the ground beneath their vehicle
NO_OFFSET = 1 << 28           # 0.1 mm, farther than any offset
MIN_STRIP_WIDTH = 1.0         # m; to leave a narrower strip out saves nothing


@dataclass
class LevelStrip:
    """Offsets between which the ground of profiles is level; low > high where it is not.

    Attributes
    ----------
    first : number of the first profile
    width : m of road per profile
    low, high : (P,) int32, offsets in 0.1 mm
    height : (P,) m, mean local z of the ground in the strip
    """

    first: int
    width: float
    low: np.ndarray
    high: np.ndarray
    height: np.ndarray

    @classmethod
    def empty(cls, first: int, count: int, width: float) -> LevelStrip:
        """A strip without level ground over `count` profiles."""
        return cls(first, width, np.full(count, NO_OFFSET, np.int32), np.full(count, -NO_OFFSET, np.int32), np.zeros(count))

    def shrunk(self, across: float, along: float) -> LevelStrip:
        """The part that keeps a distance from ground that is not level.

        Parameters
        ----------
        across : m from both ends of every profile
        along : m along the road; the result is shorter by as many profiles at both ends
        """
        around = int(np.ceil(along / self.width))

        def widest(values: np.ndarray) -> np.ndarray:
            return np.lib.stride_tricks.sliding_window_view(values, 2 * around + 1).max(axis=1)

        margin = int(round(across / COORDINATE_SCALE))
        low, high = widest(self.low) + margin, -widest(-self.high) - margin
        narrow = high - low < MIN_STRIP_WIDTH / COORDINATE_SCALE
        own = slice(around, len(self.height) - around)
        return LevelStrip(self.first + around, self.width, np.where(narrow, NO_OFFSET, low).astype(np.int32),
                          np.where(narrow, -NO_OFFSET, high).astype(np.int32), self.height[own])

    def contains(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) bool: does a point lie in the strip? s : (N,) stations, ascending; d : (N,) offsets; both in 0.1 mm."""
        edges = np.ceil((self.first + np.arange(1, len(self.low))) * (self.width / COORDINATE_SCALE) - 0.5).astype(np.int32)
        cuts = [0, *np.searchsorted(s, edges).tolist(), len(s)]
        inside = np.empty(len(d), bool)
        # stations ascend, so a profile is a range of points
        for low, high, first, end in zip(self.low, self.high, cuts[:-1], cuts[1:]):
            own = d[first:end]
            np.logical_and(own > low, own < high, out=inside[first:end])
        return inside

    def at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Low and high offset and height, m, each (N,), at stations s, (N,) m."""
        k = np.clip(np.floor(np.asarray(s) / self.width).astype(np.int64) - self.first, 0, len(self.low) - 1)
        return self.low[k] * COORDINATE_SCALE, self.high[k] * COORDINATE_SCALE, self.height[k]


def find_level_strip(track: np.ndarray, count: np.ndarray, total: np.ndarray, squares: np.ndarray, size: int,
                     min_height: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How far the ground about a track is level, profile by profile.

    Parameters
    ----------
    track : (P,) offset of the vehicle's track, 0.1 mm
    count : (P, 2, C) points of every cell of the left and of the right side, from the reference line outward
    total : (P, 2, C) sum of their heights, 0.1 mm
    squares : (P, 2, C) sum of the squared deviations from their mean height, (0.1 mm)²
    size : width of a cell, 0.1 mm
    min_height : the least step, 0.1 mm

    Returns
    -------
    low, high, height : as of LevelStrip
    """
    half = min(int(MAX_STRIP_OFFSET / COORDINATE_SCALE) // size, count.shape[2])
    count, total, squares = (np.concatenate([v[:, 1, :half][:, ::-1], v[:, 0, :half]], axis=1) for v in (count, total, squares))
    seen = count > 0
    mean = np.where(seen, total / np.maximum(count, 1), np.nan)
    uneven = seen & ((count < MIN_LEVEL_POINTS) | (squares > count * (MAX_STRIP_STD / COORDINATE_SCALE) ** 2))
    apart = max(int(round(MAX_STEP_WIDTH * 0.5 / COORDINATE_SCALE / size)), 1)
    with np.errstate(invalid="ignore"):
        uneven[:, apart:-apart] |= np.abs(mean[:, 2 * apart:] - mean[:, :-2 * apart]) > LEVEL_STEP_SHARE * min_height
    uneven &= _count_about(uneven) >= MIN_UNEVEN_NEIGHBOURS
    own = np.clip(track // size + half, 0, 2 * half - 1).astype(np.int64)
    left, right = (_level_cells_from(own, sign, uneven, seen, size) for sign in (1, -1))
    column = np.arange(2 * half)
    inside = (column > (own - right)[:, None]) & (column < (own + left)[:, None])
    points = (count * inside).sum(axis=1)
    known = (left > 0) & (right > 0) & (points > 0)
    low = np.where(known, (own - right + 1 - half) * size, NO_OFFSET)
    high = np.where(known, (own + left - half) * size, -NO_OFFSET)
    return low, high, (total * inside).sum(axis=1) / np.maximum(points, 1) * COORDINATE_SCALE


def _count_about(mask):
    """(P, C) how many of 3 profiles by 5 cells about each cell are set; the outermost cells stand for what lies beyond them."""
    wide = np.pad(mask, ((1, 1), (2, 2)), mode="edge").astype(np.uint8)
    rows = wide[:-2] + wide[1:-1] + wide[2:]
    return sum(rows[:, k:k + mask.shape[1]] for k in range(5))


def _level_cells_from(own, sign, uneven, seen, size):
    """(P,) number of cells from the track's own up to the first in which the ground is not level or was not seen."""
    last = uneven.shape[1] - 1
    away = np.arange(last + 1)
    column = own[:, None] + sign * away
    on = (column >= 0) & (column <= last)
    column = np.clip(column, 0, last)
    there = np.take_along_axis(seen, column, axis=1)
    ends = ~on | np.take_along_axis(uneven, column, axis=1) \
        | ~there & (np.logical_or.accumulate(there, axis=1) | (away * size * COORDINATE_SCALE > BLIND_HALF_WIDTH))
    return np.argmax(ends, axis=1)
