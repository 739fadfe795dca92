"""Uprights that repeat along the road at a steady offset and height, as chains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from ...common.arrays import linked_groups, members_of
from .gaps import END_UPRIGHTS, TOLD_GAP, Gaps, gaps_between
from .uprights import UPRIGHT_SLICE, Uprights

STEADY_OFFSET, STEADY_PER_SLICE = 0.30, 0.02   # m across from one slice to a later one, and more for each slice between
HEWN, STEADY_TALL = 1.8, 1.00           # m: what is higher may be rock, which is hewn, not built; m across from one slice to the next
SAME_TOP = 0.35                         # m of height of the tops above the ground, which may be hidden, or of their level
MIN_CHAIN_FILLED = 0.8                  # share of the slices of a chain, but for hidden ones, that hold an upright of it
MIN_PIECE = 3                           # uprights before and after a hidden gap
MAX_HIDDEN = 12.0                       # m along the road that vehicles hide: a lorry, or two cars
SMOOTHED_SLICES = 9                     # over which offsets and heights of a chain are smoothed (median)


@dataclass(frozen=True)
class Chain:
    """Uprights of one line along a road, in order of station.

    road, side : number; 1 left, -1 right
    members : Uprights
    d, ground, top : (N,) m, smoothed
    empty : (N,) number of slices after each of them, before the next, that show what lies beyond the line
    """

    road: int
    side: int
    members: Uprights
    d: np.ndarray
    ground: np.ndarray
    top: np.ndarray
    empty: np.ndarray

    @property
    def s(self) -> np.ndarray:
        """(N,) stations, m."""
        return (self.members.slice + 0.5) * UPRIGHT_SLICE

    @property
    def length(self) -> float:
        """m along the road"""
        return float(self.members.slice[-1] - self.members.slice[0] + 1) * UPRIGHT_SLICE

    @property
    def wobble(self) -> float:
        """m, median distance of its uprights from the smoothed line across"""
        return float(np.median(np.abs(self.members.d - self.d)))

    @property
    def roughness(self) -> float:
        """m, median distance of its uprights across from the middle between the two beside them: 0 where it is straight from kink to kink"""
        d = self.members.d
        return float(np.median(np.abs(d[1:-1] - 0.5 * (d[:-2] + d[2:])))) if len(d) > 2 else 0.0

    def part(self, rows: np.ndarray) -> Chain:
        """The Chain of some of its uprights."""
        return replace(self, members=self.members[rows], d=self.d[rows], ground=self.ground[rows], top=self.top[rows], empty=self.empty[rows])

    def pieces(self) -> list[tuple[str, Chain]]:
        """Its measured pieces and, between them, of status bridged and from the last upright before to the first after it, what was not seen of it;
        where it is seen to be open there is none."""
        gaps = np.flatnonzero(np.diff(self.members.slice) > TOLD_GAP)
        found = []
        for first, last in zip([0, *(gaps + 1)], [*gaps, len(self.d) - 1]):
            found.append(("measured", self.part(np.arange(first, last + 1))))
            if last < len(self.d) - 1 and self.empty[last] < TOLD_GAP:
                found.append(("bridged", self.part(np.arange(last, last + 2))))
        return found


def find_chains(uprights: Uprights, road: int, side: int, max_gap: float, min_length: float,
                look: Callable[[Gaps], Gaps] | None = None) -> list[Chain]:
    """Chains of the uprights on one side of a road.

    Parameters
    ----------
    uprights : sorted by slice and offset
    road, side : as in Chain
    max_gap, min_length : m along the road
    look : gives gaps with what was seen in them; without it nothing is bridged beyond `max_gap`
    """
    if len(uprights) < 2:
        return []
    reach = max(int(round(max_gap / UPRIGHT_SLICE)), 1)
    pairs = _linked(uprights, uprights, range(1, reach + 1))
    hidden, empty = np.zeros((2, len(uprights)), np.int64)
    if look is not None:
        gaps = _gaps(uprights, list(_groups(uprights, pairs)), range(reach + 1, int(round(MAX_HIDDEN / UPRIGHT_SLICE)) + 1))
        gaps = look(gaps) if len(gaps) else gaps
        gaps = gaps[(gaps.last - gaps.first + 1 < reach) | gaps.covered]
        hidden[gaps.before], empty[gaps.before] = gaps.hidden, gaps.empty
        pairs = np.concatenate([pairs, np.c_[gaps.before, gaps.after]])
    found = []
    for rows in _groups(uprights, pairs):
        for own in _filled(rows, uprights.slice[rows], hidden[rows], empty[rows], min_length):
            members = uprights[own]
            found.append(Chain(road, side, members, *along_the_chain(members), empty[own]))
    return found


def along_the_chain(members: Uprights) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offsets, ground and tops of a chain's uprights, (N,) m each, smoothed along it."""
    d, ground, top = (median_filter(values, SMOOTHED_SLICES, mode="nearest") for values in (members.d, members.ground, members.top))
    return d, ground, top


def _groups(uprights, pairs):
    """Rows of the uprights that hang together, in order of station."""
    return (rows for _, rows in members_of(linked_groups(pairs[:, 0], pairs[:, 1], len(uprights))))


def _gaps(uprights, groups, lags):
    """Gaps within groups of uprights, and those to other groups that follow so many slices later in line with them."""
    ends, begins = [], []
    for rows in groups:
        for k in np.flatnonzero(np.diff(uprights.slice[rows]) > 1).tolist():
            ends.append(rows[max(k + 1 - END_UPRIGHTS, 0):k + 1])
            begins.append(rows[k + 1:k + 1 + END_UPRIGHTS])
    long = [rows for rows in groups if len(rows) >= MIN_PIECE]
    if long:
        last, first = ([rows[part] for rows in long] for part in (slice(-END_UPRIGHTS, None), slice(END_UPRIGHTS)))
        starts = _middles(uprights, first, 0)
        order = np.lexsort((starts.d, starts.slice))
        before, after = _linked(_middles(uprights, last, -1), starts[order], lags).T
        ends += [last[k] for k in before]
        begins += [first[k] for k in order[after]]
    return gaps_between(uprights, ends, begins)


def _middles(uprights, rows, place):
    """Uprights at one end of pieces, with the median offset and heights of the last ones there."""
    ends = uprights[np.array([some[place] for some in rows])]
    ends.d, ends.ground, ends.top = (np.array([np.median(values[some]) for some in rows]) for values in (uprights.d, uprights.ground, uprights.top))
    return ends


def _filled(rows, slices, hidden, empty, min_length):
    """Those rows of a chain, or of its parts between openings, that fill what was seen of it."""
    count = int(slices[-1] - slices[0] + 1)
    seen = count - int(hidden[:-1].sum())
    if count * UPRIGHT_SLICE >= min_length and len(rows) >= MIN_CHAIN_FILLED * max(seen, min_length / UPRIGHT_SLICE):
        return [rows]
    cuts = np.flatnonzero(empty[:-1] >= TOLD_GAP) + 1
    if not len(cuts):
        return []
    parts = zip(*(np.split(values, cuts) for values in (rows, slices, hidden, empty)))
    return [own for part in parts for own in _filled(*part, min_length)]


def _linked(ends, begins, lags):
    """(P, 2) pairs of uprights of which the second follows the first so many slices later, each with one successor and one predecessor at most;
    `begins` in order of slice and offset."""
    key = begins.slice * 1e4 + begins.d
    taken_next, taken_before = np.zeros(len(ends), bool), np.zeros(len(begins), bool)
    pairs = [np.empty((0, 2), np.int64)]
    for lag in lags:
        one = np.flatnonzero(~taken_next)
        wanted = (ends.slice[one] + lag) * 1e4 + ends.d[one]
        right = np.clip(np.searchsorted(key, wanted), 0, len(key) - 1)
        left = np.maximum(right - 1, 0)
        other = np.where(np.abs(key[left] - wanted) <= np.abs(key[right] - wanted), left, right)
        apart = np.abs(key[other] - wanted)
        lower, higher = np.minimum(ends.top[one], begins.top[other]), np.maximum(ends.top[one], begins.top[other])
        level = np.abs(begins.top[other] + begins.ground[other] - ends.top[one] - ends.ground[one])
        steady = (apart < STEADY_OFFSET + STEADY_PER_SLICE * (lag - 1)) & (np.minimum(higher - lower, level) < SAME_TOP)
        fits = np.where(lower > HEWN, apart < STEADY_TALL, steady)
        fits &= (begins.slice[other] == ends.slice[one] + lag) & ~taken_before[other]
        one, other, apart = one[fits], other[fits], apart[fits]
        # of several that want the same successor the nearest has it
        order = np.lexsort((apart, other))
        first = np.r_[True, np.diff(other[order]) > 0] if len(order) else np.empty(0, bool)
        one, other = one[order][first], other[order][first]
        taken_next[one], taken_before[other] = True, True
        pairs.append(np.c_[one, other])
    return np.concatenate(pairs)
