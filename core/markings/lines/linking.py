"""Strands of paint linked along the road to whole lines: dashes over their gaps, worn lines over their holes.

Linking looks along the road, never across it. What helps most is that painted lines
run parallel: the vehicle's weaving shows in all of them alike, and once it is
taken out (`CommonTrend`) a line is nearly a constant offset, so that the next dash is
searched where the line is, not where its last metre happened to point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ...curves.robust import median

if TYPE_CHECKING:
    from .strands import Strand

TREND_STEP = 0.5                           # m, nodes of the drift
SLOPE_WINDOW = 5.0                         # m that slopes are averaged over
END_WINDOW = 6.0                           # m of a strand's end that say where it goes
MIN_PAINT_BESIDE_GAP = 3.0                 # m that either side of a long gap must have
MAX_STRAND_OVERLAP = 0.6                   # m that two strands of one line may overlap
STRAY_WINDOW = 20.0                        # m before and after a strand that say where it should lie
MAX_STRAY_LENGTH = 4.0                     # m: longer strands make their own case
MAX_STRAY_OFFSET = 0.10                    # m across
DOUBLE_LINE_SPACING = (0.19, 0.50)         # m between the middles of the two lines of a double line
MIDDLE_SHARE = (0.25, 0.75)                # of the way from one line of a double to the other: its middle
MAX_LINE_SLOPE = np.tan(np.radians(10.0))  # across per along by which two strands may differ


class CommonTrend:
    """How the offset of all lines of a road changes together: d(s) of a line minus this is nearly constant."""

    def __init__(self, strands: list[Strand]) -> None:
        self.s, self.value = np.zeros(1), np.zeros(1)
        long = [strand for strand in strands if strand.length >= 1.5]
        if not long:
            return
        s, slope, weight = _slopes(long)
        bins = np.floor(s / TREND_STEP).astype(np.int64)
        order = np.lexsort((slope, bins))
        starts = np.flatnonzero(np.r_[True, np.diff(bins[order]) != 0])
        first = bins.min()
        nodes = np.arange(first, bins.max() + 1)
        middle = np.full(len(nodes), np.nan)
        middle[bins[order[starts]] - first] = _weighted_medians(slope[order], weight[order], starts)
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
    """Station, dd/ds and weight every half metre of some strands, each from the places within 2.5 m on the strand."""
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
    return at[good], slope[good], (spread / np.maximum(n, 1))[good]


@dataclass
class LinkedLine:
    """Strands of one painted line in order of station."""

    strands: list

    @property
    def first(self) -> float:
        return self.strands[0].first

    @property
    def last(self) -> float:
        return self.strands[-1].last

    @property
    def painted(self) -> float:
        """Metres of paint."""
        return sum(strand.length for strand in self.strands)

    def places(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """s, d, z, weight of all places."""
        return self._places

    @cached_property
    def _places(self):
        return tuple(np.concatenate([getattr(strand, name) for strand in self.strands])
                     for name in ("s", "d", "z", "weight"))


@dataclass(frozen=True)
class _End:
    """Where a line ends and how it goes on there: offset less drift at the end, and slope of that."""

    s: float
    d: float
    slope: float
    reach: float   # m of paint the slope is from

    def offset_at(self, s, trust):
        return self.d + trust * self.slope * (s - self.s)


def line_ends(lines: list[LinkedLine], trend: CommonTrend, at_start: bool, reach: float = END_WINDOW) -> list[_End]:
    """The `_End` at the start or the end of every line, from its last `reach` metres of station."""
    if not lines:
        return []
    places = [line.places() for line in lines]
    counts = [len(s) for s, *_ in places]
    owner = np.repeat(np.arange(len(lines)), counts)
    s, d, weight = (np.concatenate([columns[k] for columns in places]) for k in (0, 1, 3))
    tips = np.array([line.first if at_start else line.last for line in lines])
    near = np.flatnonzero(np.abs(s - tips[owner]) <= reach)
    owner, s, weight = owner[near], s[near], np.minimum(weight[near], 10.0)
    d = d[near] - trend.at(s)
    starts = np.flatnonzero(np.r_[True, np.diff(owner) != 0]) if len(owner) else np.empty(0, int)
    count = np.diff(np.append(starts, len(owner)))
    total = np.add.reduceat(weight, starts) if len(owner) else weight
    middle, offset = (np.add.reduceat(v * weight, starts) / total if len(owner) else v for v in (s, d))
    span = np.maximum.reduceat(s, starts) - np.minimum.reduceat(s, starts) if len(owner) else s
    order = np.lexsort((d, owner))
    level = _weighted_medians(d[order], weight[order], starts)
    away = s - np.repeat(middle, count)
    squares = np.add.reduceat(weight * away**2, starts) if len(owner) else s
    slope = np.add.reduceat(weight * away * (d - np.repeat(offset, count)), starts) / np.where(span < 1.0, 1.0, squares) if len(owner) else s
    slope = np.where(span < 1.0, 0.0, np.clip(slope, -MAX_LINE_SLOPE, MAX_LINE_SLOPE))
    found = [_End(float(tip), float("nan"), 0.0, 0.0) for tip in tips]
    for k, lv, sl, m, reached in zip(owner[starts].tolist(), level.tolist(), slope.tolist(), middle.tolist(), span.tolist()):
        tip = float(tips[k])
        found[k] = _End(tip, lv + sl * (tip - m), sl, reached)
    return found


def _weighted_medians(values, weight, starts):
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


def lateral_mismatch(before: _End, after: _End) -> float:
    """Metres across by which the end of one line misses the start of the next, at the middle of the gap.

    The better of two views counts: the lines go on as they pointed, or parallel to
    the others (a short dash hardly knows its own slope).
    """
    middle = (before.s + after.s) / 2
    return min(abs(before.offset_at(middle, trust) - after.offset_at(middle, trust))
               for trust in (0.0, _trust(before, after)))


def _trust(before, after):
    reach = min(before.reach, after.reach)
    return reach**2 / (reach**2 + 4.0)


def link_lines(lines: list[LinkedLine], trend: CommonTrend, max_gap: float, allowed: float = 0.30) -> list[LinkedLine]:
    """Lines linked over gaps up to `max_gap`, each end once, the best match first.

    Parameters
    ----------
    lines : list of LinkedLine
    trend : CommonTrend
    max_gap : metres
    allowed : metres across at the longest gap; half of it where lines touch

    Returns
    -------
    list of LinkedLine
    """
    starts, ends = (line_ends(lines, trend, at_start) for at_start in (True, False))
    by_start = np.argsort([e.s for e in starts], kind="stable")
    stations = np.array([starts[k].s for k in by_start])
    twin_ends, twin_starts = (twin_offsets(lines, trend, tips, at_start) for tips, at_start in ((ends, False), (starts, True)))
    pairs = []
    for a, before in enumerate(ends):
        low, high = np.searchsorted(stations, [before.s - MAX_STRAND_OVERLAP, before.s + max_gap])
        for b in by_start[low:high]:
            after, gap = starts[b], starts[b].s - before.s
            if b == a or lines[b].last <= lines[a].last:
                continue
            if abs(before.slope - after.slope) > MAX_LINE_SLOPE and min(before.reach, after.reach) > 3.0:
                continue
            miss, limit = lateral_mismatch(before, after), allowed * (0.5 + 0.5 * max(gap, 0.0) / max(max_gap, 1e-6))
            if _between_twins(twin_ends[a], twin_starts[b], before, after):
                continue
            if miss <= limit:
                pairs.append(((miss / limit) ** 2 + max(gap, 0.0) / max_gap, before.s, a, int(b)))
    follows, preceded = {}, set()
    for _, _, a, b in sorted(pairs):
        if a not in follows and b not in preceded:
            follows[a] = b
            preceded.add(b)
    return _joined(lines, follows, preceded)


def twin_offsets(lines: list[LinkedLine], trend: CommonTrend, tips: list[_End], at_start: bool) -> np.ndarray:
    """(N,) signed distance across to the other line of a double line at each start (or end), of which `tips` tell; 0 where there is none."""
    spans = np.array([(line.first, line.last) for line in lines]).reshape(-1, 2)
    inner = np.array([tip.s for tip in tips]) + (1.0 if at_start else -1.0) * np.minimum(2.0, (spans[:, 1] - spans[:, 0]) / 2)
    by_start = np.argsort(spans[:, 0], kind="stable")
    longest = float((spans[:, 1] - spans[:, 0]).max(initial=0.0))
    low = np.searchsorted(spans[by_start, 0], inner - longest)
    high = np.searchsorted(spans[by_start, 0], inner, side="right")
    result, levels = np.zeros(len(lines)), {}
    for k, tip in enumerate(tips):
        around = by_start[low[k]:high[k]]
        for j in sorted(around[spans[around, 1] >= inner[k]].tolist()):
            if j == k:
                continue
            if j not in levels:
                s, d, *_ = lines[j].places()
                levels[j] = s, d - trend.at(s)
            s, level = levels[j]
            near = np.abs(s - inner[k]) <= 2.0
            if near.any():
                away = median(level[near]) - tip.d
                if DOUBLE_LINE_SPACING[0] <= abs(away) <= DOUBLE_LINE_SPACING[1]:
                    result[k] = away
    return result


def _between_twins(twin_before, twin_after, before, after):
    """Whether a double line meets a single one in its middle: it ends there.

    Where only wear hides a twin, the other goes straight on and is no line between the two.
    """
    if (twin_before == 0.0) == (twin_after == 0.0):
        return False
    middle = (before.s + after.s) / 2
    step = after.offset_at(middle, 0.0) - before.offset_at(middle, 0.0)
    share = step / twin_before if twin_before else -step / twin_after
    return MIDDLE_SHARE[0] < share < MIDDLE_SHARE[1]


def _joined(lines, follows, preceded):
    found = []
    for k in range(len(lines)):
        if k in preceded:
            continue
        strands = list(lines[k].strands)
        while k in follows:
            k = follows[k]
            strands += lines[k].strands
        found.append(LinkedLine(sorted(strands, key=lambda strand: strand.first)))
    return sorted(found, key=lambda line: (line.first, line.strands[0].d[0]))


def link_over_long_gaps(lines: list[LinkedLine], trend: CommonTrend, max_gap: float, max_bridge: float,
                        same_dash_pattern: Callable[[LinkedLine, LinkedLine], bool], allowed: float = 0.25) -> list[LinkedLine]:
    """Link over longer gaps, up to `max_bridge`, where something carries over.

    Either both sides have one dash pattern and the gap is a whole multiple of
    it (`same_dash_pattern(before, after)`), or another line runs on beside the gap
    without one, so that the road does not end there.
    """
    while True:
        ends, starts = (line_ends(lines, trend, at_start, 3 * END_WINDOW) for at_start in (False, True))
        by_start = np.argsort([e.s for e in starts], kind="stable")
        stations = np.array([starts[k].s for k in by_start])
        pairs = []
        for a, before in enumerate(ends):
            low, high = np.searchsorted(stations, [before.s + max_gap - MAX_STRAND_OVERLAP, before.s + max_bridge])
            for b in by_start[low:high]:
                after = starts[b]
                if min(lines[a].painted, lines[b].painted) < MIN_PAINT_BESIDE_GAP or lateral_mismatch(before, after) > allowed:
                    continue
                if same_dash_pattern(lines[a], lines[b]) or _runs_beside(lines, (a, b), before, after, trend):
                    score = (lateral_mismatch(before, after) / allowed) ** 2 + (after.s - before.s) / max_bridge
                    pairs.append((score, before.s, a, int(b)))
        if not pairs:
            return lines
        follows, preceded = {}, set()
        for _, _, a, b in sorted(pairs):
            if a not in follows and b not in preceded:
                follows[a] = b
                preceded.add(b)
        # the pattern and the course of a longer line are known better: search again
        lines = _joined(lines, follows, preceded)


def without_strays(line: LinkedLine, trend: CommonTrend) -> LinkedLine:
    """The line less short strands that lie off the course of the paint before and after them."""
    if len(line.strands) < 3:
        return line
    s, d, _, weight = line.places()
    level = d - trend.at(s)
    owner = np.repeat(np.arange(len(line.strands)), [len(strand.s) for strand in line.strands])
    order = np.argsort(s, kind="stable")
    s, level, weight, owner = s[order], level[order], weight[order], owner[order]
    kept = []
    for k, strand in enumerate(line.strands):
        middle = (strand.first + strand.last) / 2
        window = np.arange(*np.searchsorted(s, [middle - STRAY_WINDOW, middle + STRAY_WINDOW]))
        others, own = window[owner[window] != k], window[owner[window] == k]
        both = (s[others] < middle).any() and (s[others] > middle).any()
        if strand.length > MAX_STRAY_LENGTH and strand.length > 0.1 * line.painted or not both:
            kept.append(strand)
            continue
        expected = _robust_level(s[others] - middle, level[others], np.minimum(weight[others], 10.0))
        if abs(median(level[own]) - expected) <= MAX_STRAY_OFFSET:
            kept.append(strand)
    return LinkedLine(kept)


def _robust_level(s, level, weight):
    """Value at 0 of a straight line through (s, level), strays counting little."""
    base = weight
    design = np.c_[np.ones(len(s)), s / STRAY_WINDOW]
    for _ in range(6):
        root = np.sqrt(weight)
        found = np.linalg.lstsq(design * root[:, None], level * root, rcond=None)[0]
        weight = base / np.sqrt(1.0 + ((level - design @ found) / 0.03) ** 2)
    return found[0]


def _runs_beside(lines, pair, before, after, trend):
    """Another line within 8 m painted over most of the gap, with holes of at most 5 m, while keeping its distance."""
    for k, other in enumerate(lines):
        if k in pair:
            continue
        s, d, *_ = other.places()
        there = (s > before.s - 5) & (s < after.s + 5)
        if not there.any() or np.abs(median(d[there]) - trend.at(before.s) - before.d) > 8.0:
            continue
        covered = np.r_[before.s, np.sort(s[(s > before.s) & (s < after.s)]), after.s]
        if np.diff(covered).max() <= 5.0:
            return True
    return False
