"""How all painted lines of a road change their offset together: the vehicle's weaving shows in all of them alike."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .strands import Strand

TREND_STEP = 0.5      # m, nodes of the drift
SLOPE_WINDOW = 5.0    # m that slopes are averaged over
GENTLE_TAPER = 0.05   # m across for each m along: a line that runs as askew as that to the others counts half (tapers are 1 in 20 and steeper)
MAX_LINE_SLOPE = np.tan(np.radians(10.0))  # across per along by which two strands may differ


class CommonTrend:
    """How the offset of all lines of a road changes together: d(s) of a line minus this is nearly constant.

    That is the median of the lines that are seen at a place. A line that leaves the others where more of them are seen, as along a taper, counts
    little where it is one of two.
    """

    def __init__(self, strands: list[Strand]) -> None:
        self.s, self.value = np.zeros(1), np.zeros(1)
        long = [strand for strand in strands if strand.length >= 1.5]
        if not long:
            return
        s, slope, weight, strand = _slopes(long)
        bins = np.floor(s / TREND_STEP).astype(np.int64)
        order = np.lexsort((slope, bins))
        starts = np.flatnonzero(np.r_[True, np.diff(bins[order]) != 0])
        first = bins.min()
        nodes = np.arange(first, bins.max() + 1)
        mean = np.bincount(bins - first, weight * slope) / np.bincount(bins - first, weight).clip(1e-9)
        askew = np.bincount(strand, weight * np.abs(slope - mean[bins - first])) / np.bincount(strand, weight).clip(1e-9)
        weight = weight / (1.0 + (askew[strand] / GENTLE_TAPER) ** 2)
        middle = np.full(len(nodes), np.nan)
        middle[bins[order[starts]] - first] = weighted_medians(slope[order], weight[order], starts)
        known = np.isfinite(middle)
        at = (nodes + 0.5) * TREND_STEP
        # where nothing is painted for long the lines are taken to follow the reference
        middle = np.interp(at, at[known], middle[known])
        away = np.abs(at - at[known][np.clip(np.searchsorted(at[known], at), 0, known.sum() - 1)])
        behind = np.abs(at - at[known][np.clip(np.searchsorted(at[known], at) - 1, 0, known.sum() - 1)])
        middle *= np.exp(-np.minimum(away, behind) / 10.0)
        reach = int(SLOPE_WINDOW / TREND_STEP / 2)
        middle = np.convolve(np.pad(middle, reach, mode="edge"), np.full(2 * reach + 1, 1 / (2 * reach + 1)), "valid")
        self.s = np.r_[at[0] - TREND_STEP / 2, at + TREND_STEP / 2]
        self.value = np.r_[0.0, np.cumsum(middle * TREND_STEP)]

    def at(self, s: np.ndarray) -> np.ndarray:
        """(N,) metres at stations s; flat beyond the painted part."""
        return np.interp(s, self.s, self.value)


def _slopes(strands):
    """Station, dd/ds, weight and strand every half metre of some strands, each from the places within 2.5 m on the strand."""
    counts = np.array([len(strand.s) for strand in strands])
    starts = np.cumsum(counts) - counts
    owner = np.repeat(np.arange(len(strands)), counts)
    own_s, own_d = (np.concatenate([getattr(strand, name) for strand in strands]) for name in ("s", "d"))
    at = [np.arange(strand.first + TREND_STEP / 2, strand.last, TREND_STEP) for strand in strands]
    of = np.repeat(np.arange(len(strands)), [len(some) for some in at])
    at = np.concatenate(at)
    # strands one after the other, so far apart that none reaches into the next
    far = owner * (float(max(strand.last for strand in strands) - min(strand.first for strand in strands)) + 4 * SLOPE_WINDOW)
    shift = far[starts]
    low, high = (np.searchsorted(own_s + far, at + shift[of] + side * SLOPE_WINDOW / 2) for side in (-1, 1))
    # from the strand's own start, so that sums keep their digits
    s, d = own_s - own_s[starts][owner], own_d - own_d[starts][owner]
    n = high - low
    ms, md, mss, msd = (sums[high] - sums[low] for sums in (np.append(0.0, np.cumsum(v)) for v in (s, d, s * s, s * d)))
    spread = n * mss - ms * ms
    good = (n >= 5) & (spread > 0.2 * n * n)
    slope = np.where(good, (n * msd - ms * md) / np.where(good, spread, 1.0), 0.0)
    # a slope beyond any lane change is a false strand's
    good &= np.abs(slope) < MAX_LINE_SLOPE
    return at[good], slope[good], (spread / np.maximum(n, 1))[good], of[good]


def weighted_medians(values: np.ndarray, weight: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(G,) weighted medians of groups of (N,) values, ascending within each group, that begin at `starts`."""
    if not len(starts):
        return np.empty(0)
    count = np.diff(np.append(starts, len(values)))
    # a row for every group, so that each sums its own weights and nothing else
    table = np.zeros((len(starts), int(count.max())))
    column = np.arange(len(values)) - np.repeat(starts, count)
    table[np.repeat(np.arange(len(starts)), count), column] = weight
    share = np.cumsum(table, axis=1)
    return values[starts + (share < share[:, -1:] / 2).sum(axis=1)]
