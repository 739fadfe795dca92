"""Strands of paint linked along the road to whole lines: dashes over their gaps, worn lines over their holes.

Linking looks along the road, never across it. What helps most is that painted lines
run parallel: the vehicle's weaving shows in all of them alike, and once it is
taken out (`CommonTrend`) a line is nearly a constant offset, so that the next dash is
searched where the line is, not where its last metre happened to point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...common.arrays import linked_groups
from ...common.parallel import check_cancelled
from ...curves.robust import median
from .common_trend import MAX_LINE_SLOPE, CommonTrend, weighted_medians
from .lines_beside import lines_beside
from .strands import LinkedLine

if TYPE_CHECKING:
    from .edges_beside import EdgesBeside

END_WINDOW = 6.0                           # m of a strand's end that say where it goes
MIN_PAINT_BESIDE_GAP = 3.0                 # m that either side of a long gap must have
MAX_STRAND_OVERLAP = 0.6                   # m that two strands of one line may overlap
STRAY_WINDOW = 20.0                        # m before and after a strand that say where it should lie
MAX_STRAY_LENGTH = 4.0                     # m: longer strands make their own case
MAX_STRAY_OFFSET = 0.10                    # m across
DOUBLE_LINE_SPACING = (0.19, 0.50)         # m between the middles of the two lines of a double line
TWIN_REACH = 2.0                           # m before and after a place at which the other line of a double line is looked for
MIDDLE_SHARE = (0.25, 0.75)                # of the way from one line of a double to the other: its middle
COST_WITHOUT_LINK = 2.01                   # the worst possible link costs 1 for its mismatch and 1 for its gap


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
    level = weighted_medians(d[order], weight[order], starts)
    away = s - np.repeat(middle, count)
    squares = np.add.reduceat(weight * away**2, starts) if len(owner) else s
    slope = np.add.reduceat(weight * away * (d - np.repeat(offset, count)), starts) / np.where(span < 1.0, 1.0, squares) if len(owner) else s
    slope = np.where(span < 1.0, 0.0, np.clip(slope, -MAX_LINE_SLOPE, MAX_LINE_SLOPE))
    found = [_End(float(tip), float("nan"), 0.0, 0.0) for tip in tips]
    for k, lv, sl, m, reached in zip(owner[starts].tolist(), level.tolist(), slope.tolist(), middle.tolist(), span.tolist()):
        tip = float(tips[k])
        found[k] = _End(tip, lv + sl * (tip - m), sl, reached)
    return found


def lateral_mismatch(before: _End, after: _End) -> float:
    """Metres across by which the end of one line misses the start of the next, at the middle of the gap.

    The better of two views counts: the lines go on as they pointed, or parallel to
    the others (a short dash hardly knows its own slope).
    """
    middle = (before.s + after.s) / 2
    return min(abs(before.offset_at(middle, trust) - after.offset_at(middle, trust))
               for trust in (0.0, _trust(before, after)))


def _miss(before: _End, after: _End, trend: CommonTrend, edges: EdgesBeside, ends: LinkedLine, begins: LinkedLine) -> float:
    """The same, or less where both run along one edge of the road and keep their distance from it.

    The better of two views counts again: the distance of their tips, where they lead straight, or where they are painted, as along a taper
    on which they bend; that view is of gaps, and says nothing of pieces that touch.
    """
    miss = lateral_mismatch(before, after)
    s = np.array([before.s, after.s])
    d = np.array([before.d, after.d]) + trend.at(s)
    edge = edges.between((s[0], d[0]), (s[1], d[1]))
    if edge is None:
        return miss
    miss = min(miss, float(np.ptp(d - edge(s))))
    if after.s - before.s <= MAX_STRAND_OVERLAP:
        return miss
    beside = [median(own_d - edge(own_s)) for own_s, own_d in (ends.end_places(False), begins.end_places(True))]
    return min(miss, abs(beside[1] - beside[0]))


def _trust(before, after):
    reach = min(before.reach, after.reach)
    return reach**2 / (reach**2 + 4.0)


def link_lines(lines: list[LinkedLine], trend: CommonTrend, edges: EdgesBeside, max_gap: float, allowed: float = 0.30) -> list[LinkedLine]:
    """Lines linked over gaps up to `max_gap`, each end once, at the least cost of all links together.

    Parameters
    ----------
    lines : list of LinkedLine
    trend : CommonTrend
    edges : EdgesBeside of the road
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
        check_cancelled()
        low, high = np.searchsorted(stations, [before.s - MAX_STRAND_OVERLAP, before.s + max_gap])
        for b in by_start[low:high]:
            after, gap = starts[b], starts[b].s - before.s
            if b == a or lines[b].last <= lines[a].last:
                continue
            if abs(before.slope - after.slope) > MAX_LINE_SLOPE and min(before.reach, after.reach) > 3.0:
                continue
            miss, limit = _miss(before, after, trend, edges, lines[a], lines[b]), allowed * (0.5 + 0.5 * max(gap, 0.0) / max(max_gap, 1e-6))
            if _between_twins(twin_ends[a], twin_starts[b], before, after):
                continue
            if miss <= limit:
                pairs.append(((miss / limit) ** 2 + max(gap, 0.0) / max_gap, a, int(b)))
    return _joined(lines, assigned_links(pairs))


def twin_offsets(lines: list[LinkedLine], trend: CommonTrend, tips: list[_End], at_start: bool) -> np.ndarray:
    """(N,) signed distance across to the other line of a double line at each start (or end), of which `tips` tell; 0 where there is none."""
    spans = np.array([(line.first, line.last) for line in lines]).reshape(-1, 2)
    inner = np.array([tip.s for tip in tips]) + (1.0 if at_start else -1.0) * np.minimum(2.0, (spans[:, 1] - spans[:, 0]) / 2)
    beside = lines_beside(lines)
    result = np.zeros(len(lines))
    for k, tip in enumerate(tips):
        for j in beside.between(inner[k], inner[k]).tolist():
            if j == k:
                continue
            s, d = lines[j].near(inner[k] - TWIN_REACH, inner[k] + TWIN_REACH)
            if len(s):
                away = median(d - trend.at(s)) - tip.d
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


def assigned_links(pairs: list[tuple[float, int, int]]) -> dict[int, int]:
    """Which line goes on as which other, so that the sum of all costs is least.

    A line that is not linked costs as much as the worst link that is possible, so that links are made rather than left out. Lines that
    compete for the same links are assigned together (Hungarian method, as in `scipy.optimize.linear_sum_assignment`).

    Parameters
    ----------
    pairs : list of (cost, line that ends, line that begins), costs from 0 to COST_WITHOUT_LINK

    Returns
    -------
    {line that ends: line that begins}
    """
    if not pairs:
        return {}
    cost, a, b = (np.array(values) for values in zip(*pairs))
    ends, row = np.unique(a, return_inverse=True)
    starts, column = np.unique(b, return_inverse=True)
    group = linked_groups(row, len(ends) + column, len(ends) + len(starts))
    order = np.argsort(group[row], kind="stable")
    links = {}
    for of_group in np.split(order, np.searchsorted(group[row][order], np.arange(1, group.max() + 1))):
        rows, i = np.unique(row[of_group], return_inverse=True)
        columns, j = np.unique(column[of_group], return_inverse=True)
        gain = np.zeros((len(rows), len(columns)))
        gain[i, j] = COST_WITHOUT_LINK - cost[of_group]
        for u, v in zip(*linear_sum_assignment(gain, maximize=True)):
            if gain[u, v] > 0:
                links[int(ends[rows[u]])] = int(starts[columns[v]])
    return links


def _joined(lines, follows):
    found, preceded = [], set(follows.values())
    for k in range(len(lines)):
        if k in preceded:
            continue
        strands = list(lines[k].strands)
        while k in follows:
            k = follows[k]
            strands += lines[k].strands
        found.append(LinkedLine(sorted(strands, key=lambda strand: strand.first)))
    return sorted(found, key=lambda line: (line.first, line.strands[0].d[0]))


def link_over_long_gaps(lines: list[LinkedLine], trend: CommonTrend, edges: EdgesBeside, max_gap: float, max_bridge: float,
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
        beside = lines_beside(lines)
        for a, before in enumerate(ends):
            check_cancelled()
            low, high = np.searchsorted(stations, [before.s + max_gap - MAX_STRAND_OVERLAP, before.s + max_bridge])
            for b in by_start[low:high]:
                after = starts[b]
                if min(lines[a].painted, lines[b].painted) < MIN_PAINT_BESIDE_GAP:
                    continue
                if (miss := _miss(before, after, trend, edges, lines[a], lines[b])) > allowed:
                    continue
                if same_dash_pattern(lines[a], lines[b]) or _runs_beside(lines, beside, (a, b), before, after, trend):
                    score = (miss / allowed) ** 2 + (after.s - before.s) / max_bridge
                    pairs.append((score, a, int(b)))
        if not pairs:
            return lines
        # the pattern and the course of a longer line are known better: search again
        lines = _joined(lines, assigned_links(pairs))


def without_strays(line: LinkedLine, trend: CommonTrend, edges: EdgesBeside) -> LinkedLine:
    """The line less short strands that lie off the course of the paint before and after them, be that with the other lines or along an edge."""
    if len(line.strands) < 3:
        return line
    s, d, _, weight = line.places()
    owner = np.repeat(np.arange(len(line.strands)), [len(strand.s) for strand in line.strands])
    order = np.argsort(s, kind="stable")
    s, d, weight, owner = s[order], d[order], weight[order], owner[order]
    kept = []
    for k, strand in enumerate(line.strands):
        middle = (strand.first + strand.last) / 2
        window = np.arange(*np.searchsorted(s, [middle - STRAY_WINDOW, middle + STRAY_WINDOW]))
        others, own = window[owner[window] != k], window[owner[window] == k]
        both = (s[others] < middle).any() and (s[others] > middle).any()
        if strand.length > MAX_STRAY_LENGTH and strand.length > 0.1 * line.painted or not both:
            kept.append(strand)
            continue
        edge = edges.between(*((float(s[j]), float(d[j])) for j in window[[0, -1]]))
        for course in [trend.at] + ([] if edge is None else [edge]):
            expected = _robust_level(s[others] - middle, d[others] - course(s[others]), np.minimum(weight[others], 10.0))
            if abs(median(d[own] - course(s[own])) - expected) <= MAX_STRAY_OFFSET:
                kept.append(strand)
                break
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


def _runs_beside(lines, beside, pair, before, after, trend):
    """Another line within 8 m painted over most of the gap, with holes of at most 5 m, while keeping its distance."""
    for k in beside.between(before.s - 5, after.s + 5).tolist():
        if k in pair:
            continue
        s, d = lines[k].near(before.s - 5, after.s + 5)
        there = (s > before.s - 5) & (s < after.s + 5)
        if not there.any() or np.abs(median(d[there]) - trend.at(before.s) - before.d) > 8.0:
            continue
        covered = np.r_[before.s, s[(s > before.s) & (s < after.s)], after.s]
        if np.diff(covered).max() <= 5.0:
            return True
    return False
