"""Strands of paint linked along the road to whole lines: dashes over their gaps, worn lines over their holes.

Painted lines run parallel: the vehicle's weaving shows in all of them alike. Once it is taken out (`CommonTrend`) a line is nearly a constant
offset, so the next dash is searched where the line is, not where its last metre happened to point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from scipy.optimize import linear_sum_assignment

from ...common.arrays import linked_groups, mask_runs
from ...common.parallel import check_cancelled
from ...curves.robust import median
from ...survey.store.road_points import RoadPoints
from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects, Outlines
from ..weights import LINKS, TRACKS, TREND
from .painted_lines import PaintedLines
from .strands import EdgesBeside, LinkedLine, Strand


@dataclass(frozen=True)
class _End:
    """Where a line ends and how it goes on there: offset less drift at the end, and slope of that."""

    s: float
    d: float
    slope: float
    reach: float   # m of paint the slope is from
    open: float   # m across that it may be off by: where tracks are few, and where so short a piece shows no slope, from its middle on


def _line_ends(lines: list[LinkedLine], trend: CommonTrend, at_start: bool, reach: float = LINKS.end_window) -> list[_End]:
    """The `_End` at the start or the end of every line, from its last `reach` metres of station."""
    if not lines:
        return []
    places = [line.places for line in lines]
    owner = np.repeat(np.arange(len(lines)), [len(s) for s, *_ in places])
    s, d, weight = (np.concatenate([columns[k] for columns in places]) for k in (0, 1, 3))
    tips = np.array([line.first if at_start else line.last for line in lines])
    # every line has a place near its tip
    close = np.flatnonzero(np.abs(s - tips[owner]) <= reach)
    owner, s, weight = owner[close], s[close], np.minimum(weight[close], 10.0)
    d = d[close] - trend.at(s)
    starts = np.flatnonzero(np.diff(owner, prepend=-1))
    count = np.diff(np.append(starts, len(owner)))
    middle, offset = (np.add.reduceat(v * weight, starts) / np.add.reduceat(weight, starts) for v in (s, d))
    span = np.maximum.reduceat(s, starts) - np.minimum.reduceat(s, starts)
    order = np.lexsort((d, owner))
    level = weighted_medians(d[order], weight[order], starts)
    lever = s - np.repeat(middle, count)
    short = span < 1.0   # m: too short to show a slope
    squares = np.where(short, 1.0, np.add.reduceat(weight * lever**2, starts))
    slope = np.add.reduceat(weight * lever * (d - np.repeat(offset, count)), starts) / squares
    slope = np.where(short, 0.0, np.clip(slope, -TREND.max_line_slope, TREND.max_line_slope))
    unknown = np.where(short, TREND.max_line_slope * np.abs(tips - middle), 0.0) + [line.strands[0 if at_start else -1].open for line in lines]
    return [_End(*end) for end in np.column_stack([tips, level + slope * (tips - middle), slope, span, unknown]).tolist()]


def _misses(pairs: Sequence[tuple[int, int]], ends: list[_End], starts: list[_End], lines: list[LinkedLine], trend: CommonTrend, edges: EdgesBeside,
            limit: np.ndarray | float) -> np.ndarray:
    """(P,) metres across by which the ends of lines miss the starts of the next, at the middle of the gap: the least of several views.

    Lines go on as they pointed, or parallel to the others, since a short dash hardly knows its own slope; those of another carriageway may lead
    away. Or both keep their distance from one edge of the road: at their tips, or where they are painted, as along a taper on which they bend. That
    last view is of gaps alone. No line leads across an island: there, and above the `limit`, m, it is inf.

    pairs : number of the line that ends, and of that which begins
    """
    if not pairs:
        return np.empty(0)
    tips = [np.array([(tip.s, tip.d, tip.slope, tip.reach) for tip in of])[list(rows)] for of, rows in zip((ends, starts), zip(*pairs))]
    s, beside, slope, reach = np.stack(tips, axis=-1).swapaxes(0, 1)
    ahead, least = s.mean(axis=1, keepdims=True) - s, reach.min(axis=1, keepdims=True)
    back, level = reach * [-1, 1], trend.at(s)
    d, pointed = beside + level, slope + (trend.at(s + back) - level) / np.where(back == 0, 1.0, back)
    views = [d + least**4 / (least**4 + 4.0) * pointed * ahead, *(beside + trust * slope * ahead for trust in (0.0, least**2 / (least**2 + 4.0)))]
    miss = np.min([np.abs(np.diff(view)[:, 0]) for view in views], axis=0)
    edge = edges.along(s, d)
    for number in np.unique(edge[edge >= 0]).tolist():
        rows = np.flatnonzero(edge == number)
        miss[rows] = np.minimum(miss[rows], np.ptp(d[rows] - np.interp(s[rows], *edges.edges[number]), axis=1))
        for k in rows[s[rows, 1] - s[rows, 0] > LINKS.max_strand_overlap].tolist():
            before, after = (lines[line].end_places[side] for side, line in enumerate(pairs[k]))
            clearances = [median(painted_d - np.interp(painted_s, *edges.edges[number])) for painted_s, painted_d in (before, after)]
            miss[k] = min(miss[k], abs(clearances[1] - clearances[0]))
    near = np.flatnonzero(miss <= limit)
    return np.where(np.isin(np.arange(len(miss)), near[~edges.bars(s[near], d[near])]), miss, np.inf)


def link_lines(lines: list[LinkedLine], trend: CommonTrend, edges: EdgesBeside, max_gap: float) -> list[LinkedLine]:
    """Lines linked over gaps up to `max_gap`, m, each end once, at the least cost of all links together."""
    starts, ends = (_line_ends(lines, trend, at_start) for at_start in (True, False))
    twin_ends, twin_starts = (twin_offsets(lines, trend, tips, at_start) for tips, at_start in ((ends, False), (starts, True)))
    pairs = [(a, b) for a, b in _facing(starts, ends, -LINKS.max_strand_overlap, max_gap)
             if lines[b].last > lines[a].last and not _between_twins(twin_ends[a], twin_starts[b], ends[a], starts[b])
             and (abs(ends[a].slope - starts[b].slope) <= TREND.max_line_slope or min(ends[a].reach, starts[b].reach) <= 3.0)]
    gap = np.array([max(starts[b].s - ends[a].s, 0.0) for a, b in pairs])
    limit = LINKS.max_miss * (0.5 + 0.5 * gap / max_gap) + np.array([ends[a].open + starts[b].open for a, b in pairs])
    cost = (_misses(pairs, ends, starts, lines, trend, edges, limit) / limit) ** 2 + gap / max_gap
    return _joined(lines, assigned_links([(cost[k], *pairs[k]) for k in np.flatnonzero(np.isfinite(cost)).tolist()]))


def _facing(starts, ends, least, most):
    """Pairs (line that ends, line that begins) of some `_End` with a gap of `least` to `most`, m, between them."""
    by_start = np.argsort([start.s for start in starts], kind="stable")
    stations = np.array([starts[k].s for k in by_start])
    for a, before in enumerate(ends):
        check_cancelled()
        yield from ((a, b) for b in by_start[slice(*np.searchsorted(stations, [before.s + least, before.s + most]))].tolist() if b != a)


def twin_offsets(lines: list[LinkedLine], trend: CommonTrend, tips: list[_End], at_start: bool) -> np.ndarray:
    """(N,) signed distance across to the other line of a double line at each start (or end), of which `tips` tell; 0 where there is none."""
    spans = np.array([(line.first, line.last) for line in lines]).reshape(-1, 2)
    inner = np.array([tip.s for tip in tips]) + (1.0 if at_start else -1.0) * np.minimum(2.0, (spans[:, 1] - spans[:, 0]) / 2)
    neighbours, result = lines_beside(lines), np.zeros(len(lines))
    lowest, highest = _level_ranges(lines, trend)
    for k, tip in enumerate(tips):
        beside = neighbours.between(inner[k], inner[k])
        within = np.maximum(lowest[beside] - tip.d, tip.d - highest[beside]) <= LINKS.double_line_spacing[1] + 1e-9   # the others lie farther away
        for j in beside[within & (beside != k)].tolist():
            s, d = lines[j].near(inner[k] - LINKS.twin_reach, inner[k] + LINKS.twin_reach)
            if len(s):
                offset = median(d - trend.at(s)) - tip.d
                if LINKS.double_line_spacing[0] <= abs(offset) <= LINKS.double_line_spacing[1]:
                    result[k] = offset
    return result


def _level_ranges(lines, trend):
    """(2, N) m, the least and the greatest offset of each line, less drift."""
    levels = [line.places[1] - trend.at(line.places[0]) for line in lines]
    return np.array([(level.min(), level.max()) for level in levels]).reshape(-1, 2).T


def _between_twins(twin_before, twin_after, before, after):
    """Whether a double line meets a single one in its middle: it ends there. Where only wear hides a twin, the other goes straight on."""
    if (twin_before == 0.0) == (twin_after == 0.0):
        return False
    step = after.d - before.d
    share = step / twin_before if twin_before else -step / twin_after
    return LINKS.middle_share[0] < share < LINKS.middle_share[1]


def assigned_links(pairs: list[tuple[float, int, int]]) -> dict[int, int]:
    """{line that ends: line that begins}, of `pairs` (cost up to COST_WITHOUT_LINK, line that ends, line that begins), at the least sum of all costs.

    A line that is not linked costs as much as the worst link that is possible, so that links are made rather than left out. Lines that compete for
    the same links are assigned together (Hungarian method, as in `scipy.optimize.linear_sum_assignment`).
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
        gain[i, j] = LINKS.cost_without_link - cost[of_group]
        for u, v in zip(*linear_sum_assignment(gain, maximize=True)):
            if gain[u, v] > 0:
                links[int(ends[rows[u]])] = int(starts[columns[v]])
    return links


def _joined(lines, follows):
    joined, preceded = [], set(follows.values())
    for k in range(len(lines)):
        if k in preceded:
            continue
        strands = list(lines[k].strands)
        while k in follows:
            k = follows[k]
            strands += lines[k].strands
        joined.append(LinkedLine(sorted(strands, key=lambda strand: strand.first)))
    return sorted(joined, key=lambda line: (line.first, line.strands[0].d[0]))


def link_over_long_gaps(lines: list[LinkedLine], trend: CommonTrend, edges: EdgesBeside, max_gap: float, max_bridge: float,
                        same_dash_pattern: Callable[[LinkedLine, LinkedLine], bool]) -> list[LinkedLine]:
    """Link over longer gaps, up to `max_bridge`, m, where something carries over.

    Either both sides have one dash pattern and the gap is a whole multiple of it (`same_dash_pattern(before, after)`), or another line runs on
    beside the gap without one, so that the road does not end there.
    """
    while True:
        ends, starts = (_line_ends(lines, trend, at_start, 3 * LINKS.end_window) for at_start in (False, True))
        facing, neighbours = _facing(starts, ends, max_gap - LINKS.max_strand_overlap, max_bridge), lines_beside(lines)
        possible = [(a, b) for a, b in facing if min(lines[a].painted, lines[b].painted) >= LINKS.min_paint_beside_gap]
        misses = _misses(possible, ends, starts, lines, trend, edges, LINKS.max_long_miss)
        pairs = [((miss / LINKS.max_long_miss) ** 2 + (starts[b].s - ends[a].s) / max_bridge, a, b) for (a, b), miss in zip(possible, misses.tolist())
                 if np.isfinite(miss) and (same_dash_pattern(lines[a], lines[b])
                                           or _runs_beside(lines, neighbours, (a, b), ends[a], starts[b], trend))]
        if not pairs:
            return lines
        # the pattern and the course of a longer line are known better: search again
        lines = _joined(lines, assigned_links(pairs))


def _runs_beside(lines, beside, pair, before, after, trend):
    """Another line within 8 m painted over most of the gap, with holes of at most 5 m, while keeping its distance."""
    for k in beside.between(before.s - 5, after.s + 5).tolist():
        if k in pair:
            continue
        s, d = lines[k].near(before.s - 5, after.s + 5)
        in_gap = (s > before.s - 5) & (s < after.s + 5)
        if not in_gap.any() or np.abs(median(d[in_gap]) - trend.at(before.s) - before.d) > 8.0:
            continue
        covered = np.r_[before.s, s[(s > before.s) & (s < after.s)], after.s]
        if np.diff(covered).max() <= 5.0:
            return True
    return False


# How all painted lines of a road change their offset together: the vehicle's weaving shows in all of them alike.


class CommonTrend:
    """How the offset of all lines of a road changes together: d(s) of a line minus this is nearly constant.

    That is the median of the lines that are seen at a place. A line that leaves the others where more of them are seen, as along a taper, counts
    little where it is one of two.
    """

    def __init__(self, strands: list[Strand]) -> None:
        self.s, self.value = np.zeros(1), np.zeros(1)
        long = [strand for strand in strands if strand.length >= 1.5]
        s, slope, weight, strand = _slopes(long) if long else [np.empty(0)] * 4
        if not len(s):
            return
        bins = np.floor(s / TREND.trend_step).astype(np.int64)
        order = np.lexsort((slope, bins))
        starts = np.flatnonzero(np.r_[True, np.diff(bins[order]) != 0])
        first = bins.min()
        nodes = np.arange(first, bins.max() + 1)
        mean = np.bincount(bins - first, weight * slope) / np.bincount(bins - first, weight).clip(1e-9)
        oblique = np.bincount(strand, weight * np.abs(slope - mean[bins - first])) / np.bincount(strand, weight).clip(1e-9)
        weight = weight / (1.0 + (oblique[strand] / TREND.gentle_taper) ** 2)
        middle = np.full(len(nodes), np.nan)
        middle[bins[order[starts]] - first] = weighted_medians(slope[order], weight[order], starts)
        finite = np.isfinite(middle)
        stations = (nodes + 0.5) * TREND.trend_step
        # where nothing is painted for long the lines are taken to follow the reference
        middle = np.interp(stations, stations[finite], middle[finite])
        ahead = np.abs(stations - stations[finite][np.clip(np.searchsorted(stations[finite], stations), 0, finite.sum() - 1)])
        behind = np.abs(stations - stations[finite][np.clip(np.searchsorted(stations[finite], stations) - 1, 0, finite.sum() - 1)])
        middle *= np.exp(-np.minimum(ahead, behind) / 10.0)
        reach = int(TREND.slope_window / TREND.trend_step / 2)
        middle = np.convolve(np.pad(middle, reach, mode="edge"), np.full(2 * reach + 1, 1 / (2 * reach + 1)), "valid")
        self.s = np.r_[stations[0] - TREND.trend_step / 2, stations + TREND.trend_step / 2]
        self.value = np.r_[0.0, np.cumsum(middle * TREND.trend_step)]

    def at(self, s: np.ndarray) -> np.ndarray:
        """(N,) metres at stations s; flat beyond the painted part."""
        return np.interp(s, self.s, self.value)


def _slopes(strands):
    """Station, dd/ds, weight and strand every half metre of some strands, each from the places within 2.5 m on the strand."""
    counts = np.array([len(strand.s) for strand in strands])
    starts = np.cumsum(counts) - counts
    owner = np.repeat(np.arange(len(strands)), counts)
    own_s, own_d = (np.concatenate([getattr(strand, name) for strand in strands]) for name in ("s", "d"))
    stations = [np.arange(strand.first + TREND.trend_step / 2, strand.last, TREND.trend_step) for strand in strands]
    strand_of_step = np.repeat(np.arange(len(strands)), list(map(len, stations)))
    stations = np.concatenate(stations)
    # strands one after the other, so far apart that none reaches into the next
    separation = owner * (float(max(strand.last for strand in strands) - min(strand.first for strand in strands)) + 4 * TREND.slope_window)
    shift = separation[starts]
    low, high = (np.searchsorted(own_s + separation, stations + shift[strand_of_step] + side * TREND.slope_window / 2) for side in (-1, 1))
    # from the strand's own start, so that sums keep their digits
    s, d = own_s - own_s[starts][owner], own_d - own_d[starts][owner]
    n = high - low
    ms, md, mss, msd = (sums[high] - sums[low] for sums in (np.append(0.0, np.cumsum(v)) for v in (s, d, s * s, s * d)))
    spread = n * mss - ms * ms
    valid = (n >= 5) & (spread > 0.2 * n * n)
    slope = np.where(valid, (n * msd - ms * md) / np.where(valid, spread, 1.0), 0.0)
    # a slope beyond any lane change is a false strand's
    valid &= np.abs(slope) < TREND.max_line_slope
    return stations[valid], slope[valid], (spread / np.maximum(n, 1))[valid], strand_of_step[valid]


def weighted_medians(values: np.ndarray, weight: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(G,) weighted medians of groups of (N,) values, ascending within each group, that begin at `starts`."""
    count = np.diff(np.append(starts, len(values)))
    # a row for every group, so that each sums its own weights and nothing else
    table = np.zeros((len(starts), int(count.max(initial=0))))
    column = np.arange(len(values)) - np.repeat(starts, count)
    table[np.repeat(np.arange(len(starts)), count), column] = weight
    share = np.cumsum(table, axis=1)
    return values[starts + (share < share[:, -1:] / 2).sum(axis=1)]


# What lies beside a line, strand or crossing along the road.

@dataclass(frozen=True)
class StretchLookup:
    """Stretches of road looked up by station; `first`, `last` : (N,) metres."""

    first: np.ndarray
    last: np.ndarray

    def between(self, first: float, last: float) -> np.ndarray:
        """Numbers of those that reach into the road between two stations, ascending."""
        return np.flatnonzero((self.first <= last) & (self.last >= first))


def lines_beside(lines: Sequence[LinkedLine]) -> StretchLookup:
    """StretchLookup of lines."""
    return StretchLookup(np.array([line.first for line in lines]), np.array([line.last for line in lines]))


# Paint between two tracks of the scan. Far from the vehicle the tracks lie farther apart than a line is broad and cross it obliquely: it shows on
# one track, on none, on the next. Where it shows on none, no gap was seen; where a track on its course is asphalt, the line is worn or ends.

UNKNOWN, BARE, FREE = 0, 1, 2


def with_unseen_paint(lines: PaintedLines, markings: MarkingObjects, paint: RoadPoints, road_points: RoadPoints) -> PaintedLines:
    """Lines that know, in `unseen`, where in their gaps they lie between two tracks of the scan.

    `markings` : they were made of; `paint` : points of these, with `spacing`.
    """
    unseen = [np.empty((0, 3)) for _ in range(len(lines))]
    if not paint.has_spacing:
        return replace(lines, unseen=unseen)
    marked = _MarkedLines(lines, markings)
    for k in np.flatnonzero((lines.status == "bridged") & (lines.pattern == "solid")).tolist():
        check_cancelled()
        road, (course, members) = int(lines.course.road[k]), marked.of_piece(k)
        piece = lines.course.s[lines.course.line(k)]
        first, last = float(np.nanmin(piece)), float(np.nanmax(piece))
        # few tracks show less of the width of a line and never more
        width = float(markings.width[members][markings.length[members] >= TREND.min_seen_length].max(initial=0.0))
        points = paint.window(road, first - TREND.beside_gap, last + TREND.beside_gap)
        on_line = (points.cluster > 0) & (np.abs(points.d - np.interp(points.s, *course)) <= max(width / 2, TRACKS.min_track_gap / 2))
        if not on_line.any() or not width or median(points.spacing[on_line].astype(float)) < TRACKS.min_track_gap:
            continue
        brightness = median(points.value[on_line].astype(float))
        near_gap = members[(markings.extent[members, 0] <= last) & (markings.extent[members, 1] >= first)]
        gaps = _less(first, last, markings.extent[near_gap, :2])
        steps = [np.linspace(a, b, int(np.ceil((b - a) / TREND.step)) + 1) for a, b in gaps]
        states = [_states(road_points, road, course, stations, width, brightness) for stations in steps]
        state_of_steps = np.concatenate([*states, np.empty(0, int)])
        if np.count_nonzero(state_of_steps == BARE) <= TREND.max_bare_share * np.count_nonzero(state_of_steps != UNKNOWN):
            free = [(stations[a], stations[b]) for stations, state in zip(steps, states) for a, b in mask_runs(state == FREE)]
            unseen[k] = np.array([(a, b, width) for a, b in free if b - a >= TREND.shortest_unseen]).reshape(-1, 3)
    return replace(lines, unseen=unseen)


class _MarkedLines:
    """The courses of lines and the markings on them, looked up once for each line."""

    def __init__(self, lines, markings):
        self.lines, self.markings, self.known = lines, markings, {}
        of_lines = np.flatnonzero(markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS) & np.isfinite(markings.extent[:, 0]))
        self.markings_of = {road: of_lines[markings.road[of_lines] == road] for road in np.unique(lines.course.road).tolist()}
        self.lookup = {road: StretchLookup(*markings.extent[rows, :2].T) for road, rows in self.markings_of.items()}

    def of_piece(self, k):
        """Of the line of a piece: (2, N) stations and offsets by station, and the numbers of the markings that lie on its course."""
        course = self.lines.course
        key = road, number = int(course.road[k]), int(self.lines.line[k])
        if key not in self.known:
            rows = np.concatenate([np.arange(*course.start[j:j + 2]) for j in np.flatnonzero(self.lines.line == number)])
            rows = rows[np.isfinite(course.s[rows])]
            rows = rows[np.argsort(course.s[rows], kind="stable")]
            s, d = course.s[rows], course.d[rows]
            candidates = self.markings_of[road][self.lookup[road].between(s[0], s[-1])]
            first, last, *_ = self.markings.extent[candidates].T
            distance = np.abs(self.markings.offset[candidates] - np.interp((first + last) / 2, s, d))
            self.known[key] = (s, d), candidates[(distance <= TREND.on_line) & (last > s[0]) & (first < s[-1])]
        return self.known[key]


def _less(first, last, spans):
    """[[first, last]] of what is left of an interval without some others, (K, 2)."""
    spans = spans[np.argsort(spans[:, 0], kind="stable")]
    reached = np.maximum.accumulate(np.append(first, spans[:, 1]))
    left = np.column_stack([reached, np.minimum(np.append(spans[:, 0], last), last)])
    return left[left[:, 1] - left[:, 0] >= TREND.shortest_unseen].tolist()


def _states(road_points, road, course, steps, width, brightness):
    """(N,) FREE, BARE or UNKNOWN of each of the N steps of a gap, whose N + 1 stations are given, in a line of some width (m) and brightness."""
    points = road_points.window(road, steps[0] - TREND.step_reach, steps[-1] + TREND.step_reach)
    s, offset, value = points.s, points.d - np.interp(points.s, *course), points.value
    close = np.abs(offset) <= TRACKS.max_track_gap
    s, offset, value = s[close], offset[close], value[close]
    clear = np.abs(offset) > width / 2 + TRACKS.min_track_gap
    if not clear.any():
        return np.full(len(steps) - 1, UNKNOWN)
    dark = value < (median(value[clear].astype(float)) + brightness) / 2
    count = len(steps) - 1
    low, high, painted = np.full(count, -np.inf), np.full(count, np.inf), np.zeros(count, bool)
    # a point counts for the step that it lies in and for those that it lies near
    for reach in (-TREND.step_reach, 0.0, TREND.step_reach):
        step = np.searchsorted(steps, s + reach, side="right") - 1
        inside = (step >= 0) & (step < count)
        below, above, on_paint = inside & dark & (offset <= 0), inside & dark & (offset >= 0), inside & ~dark & (np.abs(offset) <= width / 2)
        np.maximum.at(low, step[below], offset[below])
        np.minimum.at(high, step[above], offset[above])
        painted[step[on_paint]] = True
    room, nearest = high - low, np.minimum(high, -low)
    bare = (room < TREND.min_free_share * width) | (nearest < TREND.core_share * width)
    return np.where(bare, BARE, np.where(painted | (room <= TRACKS.max_track_gap), FREE, UNKNOWN))


def with_paint_between_tracks(markings: MarkingObjects, lines: PaintedLines) -> MarkingObjects:
    """Markings, and behind them the paint of lines that lies between two tracks of the scan, as `with_unseen_paint` gives it.

    Each stretch has the number and the class of the piece of the line that is nearest along it, and no points.
    """
    templates, spans, polygons = [], [], []
    marked = _MarkedLines(lines, markings)
    for k, stretches in enumerate(lines.unseen or ()):
        if not len(stretches):
            continue
        members = marked.of_piece(k)[1]
        for first, last, width in stretches.tolist() if len(members) else ():
            gap = np.maximum(markings.extent[members, 0] - last, first - markings.extent[members, 1])
            templates.append(members[np.argmin(gap)])
            polygon, offsets = _strip(lines, k, first, last, width)
            polygons.append(polygon)
            spans.append((first, last, offsets.min() - width / 2, offsets.max() + width / 2, median(offsets), width))
    if not polygons:
        return markings
    first, last, _, _, offset, width = np.array(spans).T
    more = replace(markings[np.array(templates)], outlines=Outlines.of(polygons), station=first, offset=offset, length=last - first, width=width,
                   elongation=(last - first) / width, points=np.zeros(len(templates)), extent=np.array(spans)[:, :4])
    columns = {name: np.concatenate([values, getattr(more, name)]) for name, values in vars(markings).items() if isinstance(values, np.ndarray)}
    return replace(markings, **columns, outlines=Outlines.of(np.concatenate([markings.outlines.polygons(), more.outlines.polygons()])))


def _strip(lines, k, first, last, width):
    """The polygon of a stretch of a piece of a line, and the offsets of its middle."""
    course = lines.course
    rows = course.line(k)
    order = np.argsort(course.s[rows], kind="stable")
    s, *columns = (values[rows][order] for values in (course.s, course.x, course.y, course.z, course.d))
    stations = np.r_[first, s[(s > first) & (s < last)], last]
    x, y, z, d = (np.interp(stations, s, values) for values in columns)
    direction = np.gradient(np.column_stack([x, y]), axis=0)
    direction /= np.hypot(*direction.T)[:, None]
    aside = np.column_stack([-direction[:, 1], direction[:, 0]]) * width / 2
    sides = [np.column_stack([x, y, z]) + np.column_stack([sign * aside, np.zeros(len(x))]) for sign in (1.0, -1.0)]
    return shapely.Polygon(np.concatenate([sides[0], sides[1][::-1]])), d
