"""The strip about a track in which the ground is level beyond doubt: no curb is there, and nothing that hides one.

Half of what a survey measures lies there, on a few metres of asphalt about the vehicle. Who
looks for steps alone may leave it out.
"""

from dataclasses import dataclass

import numpy as np

from ...survey.points import UNIT

REACH = 8.0        # m from the reference line within which the strip lies
TOLD = 4           # points of a cell that tell whether it is level
WITHIN = 0.20      # m across within which a step rises, one that runs askew, too: its height shows in the means of cells so far apart
SHARE = 0.4        # of the least step that such means may differ
ROUGH = 0.016      # m, standard deviation of heights in a cell, beyond which it is not level
STEADY = 5         # of 15 cells that a step changes: a bird, a drop of rain or a ghost lies in one
BLIND = 1.5        # m beside the track that may not have been seen: scanners do not look beneath their vehicle
NOWHERE = 1 << 28  # 0.1 mm: farther than any offset
NARROWEST = 1.0    # m: leaving a narrower strip out is not worth it


@dataclass
class LevelStrip:
    """Offsets between which the ground of profiles is level, in 0.1 mm; low > high where it is not.

    first, width : number of the first profile, metres of road of each
    low, high : (P,) int32
    height : (P,) mean local z of the ground there, metres
    """

    first: int
    width: float
    low: np.ndarray
    high: np.ndarray
    height: np.ndarray

    @classmethod
    def none(cls, first, count, width):
        return cls(first, width, np.full(count, NOWHERE, np.int32), np.full(count, -(NOWHERE), np.int32), np.zeros(count))

    def within(self, across, along):
        """The part that lies `across` metres inside and whose ends `along` metres up and down the road do, too."""
        around = int(np.ceil(along / self.width))

        def widest(values):
            return np.lib.stride_tricks.sliding_window_view(values, 2 * around + 1).max(axis=1)

        margin = int(round(across / UNIT))
        low, high = widest(self.low) + margin, -widest(-self.high) - margin
        narrow = high - low < NARROWEST / UNIT
        own = slice(around, len(self.height) - around)
        return LevelStrip(self.first + around, self.width, np.where(narrow, NOWHERE, low).astype(np.int32),
                          np.where(narrow, -(NOWHERE), high).astype(np.int32), self.height[own])

    def holds(self, s, d):
        """(N,) bool: is a point in the strip? Stations s (ascending) and offsets d in 0.1 mm."""
        edges = np.ceil((self.first + np.arange(1, len(self.low))) * (self.width / UNIT) - 0.5).astype(np.int32)
        counts = np.diff(np.searchsorted(s, edges), prepend=0, append=len(s))
        inside = d > np.repeat(self.low, counts)
        inside &= d < np.repeat(self.high, counts)
        return inside

    def at(self, s):
        """Low and high offset, metres, and height at (N,) stations."""
        k = np.clip(np.floor(np.asarray(s) / self.width).astype(np.int64) - self.first, 0, len(self.low) - 1)
        return self.low[k] * UNIT, self.high[k] * UNIT, self.height[k]


def strip_about(track, held, total, squares, size, least):
    """How far the ground about a track is level, profile by profile.

    Parameters
    ----------
    track : (P,) offset of the vehicle's track, 0.1 mm
    held, total, squares : (P, 2, C) points of every cell, the sum of their heights in 0.1 mm, and that of the squares of
        what these lie off their mean: cells of the left and of the right side, from the reference line outward
    size : width of a cell, 0.1 mm
    least : the least step, 0.1 mm

    Returns
    -------
    (low, high, height) of a LevelStrip
    """
    half = min(int(REACH / UNIT) // size, held.shape[2])
    held, total, squares = (np.concatenate([v[:, 1, :half][:, ::-1], v[:, 0, :half]], axis=1) for v in (held, total, squares))
    seen = held > 0
    mean = np.where(seen, total / np.maximum(held, 1), np.nan)
    bad = seen & ((held < TOLD) | (squares > held * (ROUGH / UNIT) ** 2))
    apart = max(int(round(WITHIN * 0.5 / UNIT / size)), 1)
    with np.errstate(invalid="ignore"):
        bad[:, apart:-apart] |= np.abs(mean[:, 2 * apart:] - mean[:, :-2 * apart]) > SHARE * least
    bad &= _together(bad) >= STEADY
    own = np.clip(track // size + half, 0, 2 * half - 1).astype(np.int64)
    left, right = (_cells_from(own, sign, bad, seen, size) for sign in (1, -1))
    column = np.arange(2 * half)
    inside = (column > (own - right)[:, None]) & (column < (own + left)[:, None])
    count = (held * inside).sum(axis=1)
    known = (left > 0) & (right > 0) & (count > 0)
    low = np.where(known, (own - right + 1 - half) * size, NOWHERE)
    high = np.where(known, (own + left - half) * size, -(NOWHERE))
    return low, high, (total * inside).sum(axis=1) / np.maximum(count, 1) * UNIT


def _together(bad):
    """(P, C) how many of the cells about each one are bad, of 3 profiles and 5 cells of each; the ends count for what lies beyond them."""
    wide = np.pad(bad, ((1, 1), (2, 2)), mode="edge").astype(np.uint8)
    rows = wide[:-2] + wide[1:-1] + wide[2:]
    return sum(rows[:, k:k + bad.shape[1]] for k in range(5))


def _cells_from(own, sign, bad, seen, size):
    """(P,) number of cells from the track's own to before the first in which the ground is not level or was not seen."""
    last = bad.shape[1] - 1
    away = np.arange(last + 1)
    column = own[:, None] + sign * away
    on = (column >= 0) & (column <= last)
    column = np.clip(column, 0, last)
    there = np.take_along_axis(seen, column, axis=1)
    ends = ~on | np.take_along_axis(bad, column, axis=1) | ~there & (np.logical_or.accumulate(there, axis=1) | (away * size * UNIT > BLIND))
    return np.argmax(ends, axis=1)
