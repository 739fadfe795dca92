"""What was seen in the gaps of a line beside the road: a vehicle hides what stands behind it, through a gate one sees what lies beyond."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...common.arrays import Rows
from .uprights import BEHIND, FIRST_BIN, HEIGHT_BIN, SIGHT_MARGIN, UPRIGHT_SLICE, Uprights

TOLD_GAP = 3             # slices (1.5 m) without an upright of a gap that is told; shorter ones belong to the line
END_UPRIGHTS = 3         # at the end of a piece, whose median offset and heights count
MIN_PASSED = 3           # pulses seen through a slice of a gap, from which it may be open
EXPECTED, FEWER = 10.0, 0.25  # pulses that would have met the thing there, from which it is open where at most this share did
MIN_STOPPED = 3          # pulses that something before it stopped, from which a slice is hidden
MIN_HIDDEN = 0.8         # share of the slices of a gap that are hidden, where no opening is
SIGHT_REACH = 12.0       # m along the road from a gap of points whose line of sight may pass it: planes of scanners are turned by 45 degrees


@dataclass
class Gaps(Rows):
    """G gaps between two uprights of what may be one line.

    before, after : (G,) int, rows of the uprights
    first, last : (G,) int, the first and the last slice without one
    d, low, high : (G, 2) m, offset and heights of the lower and upper end of the line before and after the gap; local z, or above the road
    share : (G,) share of the pulses that reach the line which it stops
    empty : (G,) number of slices that show what lies beyond
    hidden : (G,) number of slices that something before the line hides
    """

    before: np.ndarray
    after: np.ndarray
    first: np.ndarray
    last: np.ndarray
    d: np.ndarray
    low: np.ndarray
    high: np.ndarray
    share: np.ndarray
    empty: np.ndarray
    hidden: np.ndarray

    @property
    def covered(self) -> np.ndarray:
        """(G,) bool, whether the gap is hidden, as far as one can tell."""
        return (self.empty < TOLD_GAP) & (self.hidden >= MIN_HIDDEN * (self.last - self.first + 1))


def gaps_between(uprights: Uprights, ends: list[np.ndarray], begins: list[np.ndarray]) -> Gaps:
    """Gaps between pieces of lines.

    Parameters
    ----------
    uprights : Uprights
    ends, begins : G times rows of the last uprights before a gap, and of the first after it, in order
    """
    sides = [[_end(uprights[rows]) for rows in some] for some in (ends, begins)]
    d, low, high, points, behind = np.array(sides, float).reshape(2, len(ends), 5).transpose(2, 1, 0)
    before, after = (np.array([rows[k] for rows in some], np.int64) for some, k in ((ends, -1), (begins, 0)))
    points, behind = points.sum(axis=1), behind.sum(axis=1)
    none = np.zeros(len(ends), np.int64)
    return Gaps(before, after, uprights.slice[before] + 1, uprights.slice[after] - 1, d, low, high, points / np.maximum(points + behind, 1.0),
                none, none)


def _end(uprights):
    top = float(np.median(uprights.ground + uprights.top))
    low = float(np.median(uprights.ground)) + FIRST_BIN * HEIGHT_BIN
    return float(np.median(uprights.d)), low, top - SIGHT_MARGIN, uprights.points.sum(), uprights.behind.sum()


def gaps_by_window(gaps: Gaps, length: float) -> dict[int, list[int]]:
    """Rows of the gaps of which the points of windows may tell, by the number of the window, of a length in m, counted from station 0."""
    first, last = (gaps.first - 1) * UPRIGHT_SLICE - SIGHT_REACH, (gaps.last + 2) * UPRIGHT_SLICE + SIGHT_REACH
    found: dict[int, list[int]] = {}
    for k, (a, b) in enumerate(zip(first // length, last // length)):
        for window in range(int(a), int(b) + 1):
            found.setdefault(window, []).append(k)
    return found


def pulses_at(gaps: Gaps, side: int, s: np.ndarray, d: np.ndarray, h: np.ndarray, across: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Pulses that reached the places of gaps, or would have.

    Parameters
    ----------
    gaps : Gaps, of one side of a road
    side : 1 left, -1 right
    s, d, h : (N,) m, station (rising), offset and height of points of that side, which count as those of the gaps
    across : (2, N) m from the point to the scanner, ahead and left along the road
    up : (N,) m that the scanner is higher above the road

    Returns
    -------
    (3, K) pulses that passed each slice of all gaps, one after the other, that met something there, and that something before it stopped
    """
    length = gaps.last - gaps.first + 1
    start = np.cumsum(length) - length
    counts = np.zeros((3, int(length.sum())), np.int64)
    for k in range(len(gaps)):
        s0, s1 = (gaps.first[k] - 0.5) * UPRIGHT_SLICE, (gaps.last[k] + 1.5) * UPRIGHT_SLICE
        near = slice(*np.searchsorted(s, (s0 - SIGHT_REACH, s1 + SIGHT_REACH)))
        ds, dd = s1 - s0, float(gaps.d[k, 1] - gaps.d[k, 0])
        ahead, left = across[:, near]
        away = (s[near] - s0) * dd - (d[near] - gaps.d[k, 0]) * ds
        with np.errstate(divide="ignore", invalid="ignore"):
            part = -away / (ahead * dd - left * ds)   # of the way from the point to the scanner, where it crosses the line
        place = s[near] + part * ahead
        row = np.floor(place / UPRIGHT_SLICE)
        share = (place - s0) / ds
        height = h[near] + part * up[near]
        low, high = (ends[k, 0] + share * (ends[k, 1] - ends[k, 0]) for ends in (gaps.low, gaps.high))
        there = (row >= gaps.first[k]) & (row <= gaps.last[k]) & (height > low) & (height < high)
        beyond = -side * away / np.hypot(ds, dd)
        for kind, of in enumerate(((beyond > BEHIND[0]) & (part < 1.0), np.abs(beyond) <= BEHIND[0], (beyond < -BEHIND[0]) & (part < 0.0))):
            slices = row[there & of].astype(np.int64) - gaps.first[k]
            counts[kind, start[k]:start[k] + length[k]] += np.bincount(slices, minlength=length[k])
    return counts


def judged(gaps: Gaps, parts: Iterable[tuple[list[int], np.ndarray]]) -> Gaps:
    """Gaps with what pulses tell of them.

    Parameters
    ----------
    gaps : Gaps
    parts : rows of some of the gaps and their pulses as `pulses_at` counts them
    """
    length = gaps.last - gaps.first + 1
    owner = np.repeat(np.arange(len(gaps)), length)
    start = np.cumsum(length) - length
    passed, met, stopped = counts = np.zeros((3, len(owner)), np.int64)
    for rows, some in parts:
        counts[:, np.concatenate([start[k] + np.arange(length[k]) for k in rows])] += some
    odds = np.clip(gaps.share, 0.05, 0.95)[owner]
    expected = passed * odds / (1.0 - odds)
    empty = (passed >= MIN_PASSED) & (expected >= EXPECTED) & (met < FEWER * expected)
    hidden = ~empty & (stopped >= MIN_STOPPED)
    return replace(gaps, empty=np.bincount(owner[empty], minlength=len(gaps)), hidden=np.bincount(owner[hidden], minlength=len(gaps)))
