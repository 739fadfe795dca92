"""Uprights that repeat along the road at a steady offset and height, as chains."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from ...common.groups import linked_groups
from .uprights import UPRIGHT_SLICE, Uprights

STEADY_OFFSET, STEADY_PER_SLICE = 0.30, 0.02   # m across from one slice to a later one, and more for each slice between
HEWN, STEADY_TALL = 1.8, 1.00           # m: what is higher may be rock, which is hewn, not built; m across from one slice to the next
SAME_TOP = 0.35                         # m of height of the tops
MIN_CHAIN_FILLED = 0.8                        # share of the slices of a chain that hold an upright of it
SMOOTHED_SLICES = 9                     # over which offsets and heights of a chain are smoothed (median)


@dataclass(frozen=True)
class Chain:
    """Uprights of one line along a road, in order of station.

    road, side : number; 1 left, -1 right
    members : Uprights
    d, ground, top : (N,) m, smoothed
    """

    road: int
    side: int
    members: Uprights
    d: np.ndarray
    ground: np.ndarray
    top: np.ndarray

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
        return replace(self, members=self.members[rows], d=self.d[rows], ground=self.ground[rows], top=self.top[rows])


def find_chains(uprights: Uprights, road: int, side: int, max_gap: float, min_length: float) -> list[Chain]:
    """Chains of the uprights on one side of a road.

    Parameters
    ----------
    uprights : sorted by slice and offset
    road, side : as in Chain
    max_gap, min_length : m along the road
    """
    if len(uprights) < 2:
        return []
    pairs = _linked(uprights, max(int(round(max_gap / UPRIGHT_SLICE)), 1))
    label = linked_groups(pairs[:, 0], pairs[:, 1], len(uprights))
    order = np.lexsort((uprights.slice, label))
    found = []
    for rows in np.split(order, np.flatnonzero(np.diff(label[order])) + 1):
        members = uprights[rows]
        length = (members.slice[-1] - members.slice[0] + 1) * UPRIGHT_SLICE
        if length < min_length or len(rows) * UPRIGHT_SLICE < MIN_CHAIN_FILLED * length:
            continue
        d, ground, top = (median_filter(values, SMOOTHED_SLICES, mode="nearest") for values in (members.d, members.ground, members.top))
        found.append(Chain(road, side, members, d, ground, top))
    return found


def _linked(uprights, reach):
    """(P, 2) pairs of uprights that follow one another; each has one successor and one predecessor at most."""
    n = len(uprights)
    key = uprights.slice * 1e4 + uprights.d
    taken_next, taken_before = np.zeros(n, bool), np.zeros(n, bool)
    pairs = [np.empty((0, 2), np.int64)]
    for lag in range(1, reach + 1):
        one = np.flatnonzero(~taken_next)
        wanted = key[one] + lag * 1e4
        right = np.clip(np.searchsorted(key, wanted), 0, n - 1)
        left = np.maximum(right - 1, 0)
        other = np.where(np.abs(key[left] - wanted) <= np.abs(key[right] - wanted), left, right)
        apart = np.abs(key[other] - wanted)
        lower, higher = np.minimum(uprights.top[one], uprights.top[other]), np.maximum(uprights.top[one], uprights.top[other])
        fits = np.where(lower > HEWN, apart < STEADY_TALL, (apart < STEADY_OFFSET + STEADY_PER_SLICE * (lag - 1)) & (higher - lower < SAME_TOP))
        fits &= (uprights.slice[other] == uprights.slice[one] + lag) & ~taken_before[other]
        one, other, apart = one[fits], other[fits], apart[fits]
        # of several that want the same successor the nearest has it
        order = np.lexsort((apart, other))
        first = np.r_[True, np.diff(other[order]) > 0] if len(order) else np.empty(0, bool)
        one, other = one[order][first], other[order][first]
        taken_next[one], taken_before[other] = True, True
        pairs.append(np.c_[one, other])
    return np.concatenate(pairs)
