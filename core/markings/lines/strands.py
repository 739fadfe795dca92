"""From paint points to strands: stretches of one painted line without a gap, traced as d(s)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import shapely

from ...common.arrays import linked_groups, order_by
from ...common.parallel import check_cancelled
from ...curves.robust import median, percentiles
from ...road.edges.road_edges import RoadEdges
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE
from ..cross_section.sections import EdgeSections
from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects
from ..objects.shape import middle_line
from ..road_grid import track_reach
from ..weights import SELECTION, STRANDS


@dataclass
class Strand:
    """One stretch of painted line, stations `first` to `last`, m."""

    first: float
    last: float
    s: np.ndarray   # (K,) its places, one per 0.25 m of station, z local
    d: np.ndarray
    z: np.ndarray
    weight: np.ndarray   # (K,) points in each place
    width: float   # metres
    classes: dict   # {class of marking: painted length, metres}
    open: float = 0.0   # m across that its ends may be off by: each of few tracks shows a line at one place of its width, and crosses it obliquely

    @property
    def length(self) -> float:
        return self.last - self.first


@dataclass
class LinkedLine:
    """Strands of one painted line in order of station."""

    strands: list[Strand]

    @property
    def first(self) -> float:
        return self.strands[0].first

    @property
    def last(self) -> float:
        return self.strands[-1].last

    @cached_property
    def painted(self) -> float:
        """Metres of paint."""
        return sum(strand.length for strand in self.strands)

    @cached_property
    def by_station(self) -> tuple[np.ndarray, np.ndarray]:
        """s, d of all places in order of station."""
        s, d, *_ = self.places
        order = np.argsort(s, kind="stable")
        return s[order], d[order]

    @cached_property
    def mean_width(self) -> float:
        """Metres of paint across, on average."""
        return float(np.average([strand.width for strand in self.strands], weights=[strand.length for strand in self.strands]))

    @cached_property
    def _ends_of_strands(self):
        """Where strands begin, and how far they and those before them reach."""
        return np.array([strand.first for strand in self.strands]), np.maximum.accumulate([strand.last for strand in self.strands])

    def strands_between(self, first: float, last: float) -> list[Strand]:
        """Its strands from the first to the last one that reach into the road between two stations."""
        begin, reach = self._ends_of_strands
        return self.strands[int(np.searchsorted(reach, first)):int(np.searchsorted(begin, last, side="right"))]

    def near(self, first: float, last: float) -> tuple[np.ndarray, np.ndarray]:
        """s, d of the places from one station to another, in order of station."""
        s, d = self.by_station
        inside = slice(np.searchsorted(s, first), np.searchsorted(s, last, side="right"))
        return s[inside], d[inside]

    @cached_property
    def places(self) -> tuple[np.ndarray, ...]:
        """s, d, z, weight of all places."""
        return tuple(np.concatenate([getattr(strand, name) for strand in self.strands]) for name in ("s", "d", "z", "weight"))

    @cached_property
    def end_places(self) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """s, d of the places within `level_reach` of the last, and of the first point, the outermost place at least."""
        s, d, *_ = self.places
        at_end, at_start = s.max() - s <= STRANDS.level_reach, s - s.min() <= STRANDS.level_reach
        return (s[at_end], d[at_end]), (s[at_start], d[at_start])


def line_paint(records: Columns, markings: MarkingObjects, road: int) -> tuple[Columns, np.ndarray]:
    """The points that may belong to a painted line, and the class of each as an index into LINE_KINDS, or their number for a mixed marking.

    Those of markings of use keep; of other long markings (a line that touches a stop line or a hatched area is clustered with it) those places
    where the marking is no wider across than a double line. `records` : points of one road with `cluster`.
    """
    rows = np.flatnonzero(markings.road == road)
    if not len(rows) or not len(records):
        return records[:0], np.empty(0, np.int64)
    # of a marking of several parts the last one counts
    clusters, last = np.unique(markings.cluster[rows][::-1], return_index=True)
    rows = rows[::-1][last]
    ranks = np.full(len(clusters), len(LINE_KINDS), np.int8)
    for k, name in enumerate(LINE_KINDS):
        ranks[markings.keep[rows] & (markings.kind[rows] == name)] = k
    mixed_ones = (ranks == len(LINE_KINDS)) & (markings.length[rows] > STRANDS.min_mixed_marking)
    number = records["cluster"]
    index = np.clip(np.searchsorted(clusters, number), 0, len(clusters) - 1)
    listed, rank = clusters[index] == number, ranks[index]
    is_line = listed & (rank < len(LINE_KINDS))
    mixed = listed & mixed_ones[index]
    keep = is_line | (mixed & _narrow_there(records, number, mixed))
    return records[keep], rank[keep]


def _narrow_there(records, number, mixed):
    """Points of mixed markings in bins where the marking is narrow, and its neighbours are too."""
    rows = np.flatnonzero(mixed)
    result = np.zeros(len(records), bool)
    if not len(rows):
        return result
    bins = records["s"][rows] // STRANDS.run_bin_units
    order = order_by(bins, number[rows])
    rows, bins = rows[order], bins[order]
    starts = np.flatnonzero(np.r_[True, (np.diff(bins) != 0) | (np.diff(number[rows]) != 0)])
    d = records["d"][rows].astype(np.int64)
    narrow = np.maximum.reduceat(d, starts) - np.minimum.reduceat(d, starts) <= STRANDS.max_mixed_width_units
    owner, station_bin = number[rows][starts], bins[starts]
    # the tip of a hatched area is narrow too: keep a metre away from what is wide
    beside_wide = np.zeros(len(starts), bool)
    for shift in (-2, -1, 1, 2):
        same_marking = np.roll(owner, shift) == owner
        beside_wide |= same_marking & (np.abs(np.roll(station_bin, shift) - station_bin) <= 2) & ~np.roll(narrow, shift)
    group = np.cumsum(np.r_[False, np.diff(bins) != 0] | np.r_[False, np.diff(number[rows]) != 0])
    result[rows] = (narrow & ~beside_wide)[group]
    return result


def trace_strands(records: Columns, rank: np.ndarray) -> list[Strand]:
    """Strands of painted line among the N points of one road, by station; `rank` : (N,) class of each as `line_paint` gives it."""
    if not len(records):
        return []
    d, bins = records["d"], records["s"] // STRANDS.run_bin_units
    order = order_by(d, bins)
    run = _runs(bins[order], d[order], records["spacing"][order])
    run = np.where((np.bincount(run) >= STRANDS.min_points_per_run)[run], run, np.int32(-1))   # runs of too few points are none
    inside = np.flatnonzero(run >= 0)
    check_cancelled()
    if not len(inside):
        return []
    run, order = run[inside], order[inside]
    del inside
    starts = np.flatnonzero(np.append(True, run[1:] != run[:-1]))
    node_d, width = _middle_and_width(d[order], starts)
    label = _chains(bins[order[starts]], node_d, width <= STRANDS.max_line_width_units)
    check_cancelled()
    of_point = np.repeat(label, np.diff(np.append(starts, len(run))))
    del run
    used = np.flatnonzero(of_point >= 0)
    order, of_point = order[used], of_point[used]
    step = records["s"][order] // STRANDS.place_step_units
    # within a step points keep their order, which is across
    by_step = order_by(step, of_point)
    order, of_point, step = order[by_step], of_point[by_step], step[by_step]
    del used, by_step
    return _strands(step, [rank[order], *(records[name][order] for name in ("s", "d", "z"))], of_point)


def _runs(bins, across, spacing):
    """(N,) int32, number of the run of paint of each point; points sorted by bin, then across; `spacing` : mm between tracks of the scan."""
    cut = np.r_[True, (np.diff(bins) != 0) | (np.diff(across) > STRANDS.run_gap_units)]
    starts = np.flatnonzero(cut)
    before, after = starts[1:] - 1, starts[1:]
    unseen = track_reach(np.maximum(spacing[before], spacing[after])) / COORDINATE_SCALE
    seen = (bins[after] == bins[before]) & (across[after] - across[before] > unseen)
    lasting = _lasting(bins[after], (across[after] + across[before]) / 2, seen)
    for _ in range(8):
        last = np.r_[starts[1:], len(bins)] - 1
        joins = (bins[starts[1:]] == bins[starts[:-1]]) & (across[last[1:]] - across[starts[:-1]] <= STRANDS.max_worn_line_width_units)
        joins &= ~lasting
        # one join at a time per neighbourhood: the first of a row of joins
        joins &= ~np.r_[False, joins[:-1]]
        if not joins.any():
            break
        starts, lasting = np.delete(starts, np.flatnonzero(joins) + 1), lasting[~joins]
    run = np.zeros(len(bins), np.int32)
    run[starts[1:]] = 1
    return np.cumsum(run, out=run)


def _lasting(bins, middle, inside):
    """(G,) bool, whether a gap in paint goes on along the road at one offset: so it does between two lines, and not where one line is worn.

    `bins`, `middle` : of the gaps, in order; `inside` : whether paint of one bin lies on either side, farther apart than tracks of the scan
    """
    gaps = np.flatnonzero(inside)
    span = float(np.ptp(middle)) + 10 * STRANDS.run_bin_units if len(gaps) else 1.0
    key, count = bins[gaps] * span + middle[gaps], np.zeros(len(gaps), int)
    for step in range(-STRANDS.gap_bins, STRANDS.gap_bins + 1):
        reach = STRANDS.run_gap_units / 2 + abs(step) * STRANDS.gap_drift_units
        count += np.searchsorted(key, key + step * span + reach) > np.searchsorted(key, key + step * span - reach)
    result = np.zeros(len(inside), bool)
    result[gaps] = count > STRANDS.gap_bins
    return result


def _middle_and_width(across, starts):
    """Middle between the outer eighths, and 95 % width, of sorted runs."""
    count = np.diff(np.r_[starts, len(across)])
    low, high = across[starts + count // 8], across[starts + count - 1 - count // 8]
    outer = across[starts + count - 1 - count // 40] - across[starts + count // 40]
    return (low.astype(float) + high) / 2, outer


def _chains(node_bin, node_d, good):
    """(M,) number of the chain of each run, -1 where it is in none."""
    count = len(node_bin)
    follows = np.full(count, -1)
    preceded = np.zeros(count, bool)
    span = float(np.ptp(node_d)) + 10 * STRANDS.run_bin_units
    for leap in range(1, STRANDS.max_bin_step + 1):
        check_cancelled()
        open_end = np.flatnonzero(good & (follows < 0))
        open_start = np.flatnonzero(good & ~preceded)
        if not len(open_end) or not len(open_start):
            break
        a, b = _mutual(node_bin, node_d, open_end, open_start, leap, span)
        close = np.abs(node_d[a] - node_d[b]) <= STRANDS.lateral_step_units + STRANDS.lateral_step_per_bin_units * leap
        follows[a[close]] = b[close]
        preceded[b[close]] = True
    linked = np.flatnonzero(follows >= 0)
    return np.where(good, linked_groups(linked, follows[linked], count), -1)


def _mutual(node_bin, node_d, ends, starts, leap, span):
    """Pairs (end, start), `leap` bins apart, each the other's nearest across."""
    def nearest(a, b, shift):
        key_a, key_b = (node_bin[a] + shift) * span + node_d[a], node_bin[b] * span + node_d[b]
        order = np.argsort(key_b, kind="stable")
        spot = np.searchsorted(key_b[order], key_a)
        best, gap = np.full(len(a), -1), np.full(len(a), np.inf)
        for side in (-1, 0):
            j = np.clip(spot + side, 0, len(b) - 1)
            distance = np.abs(key_b[order][j] - key_a)
            closer = distance < gap
            best[closer], gap[closer] = order[j][closer], distance[closer]
        best[gap > 4 * STRANDS.lateral_step_units] = -1
        return best

    onward, back = nearest(ends, starts, leap), nearest(starts, ends, -leap)
    rows = np.flatnonzero(onward >= 0)
    rows = rows[back[onward[rows]] == rows]
    return ends[rows], starts[onward[rows]]


def _strands(place, columns, label):
    """Strands of points that lie by chain, place and across: their place, columns rank, s, d and z, and the chain of each point, (N,) each."""
    bounds = np.flatnonzero(np.r_[True, np.diff(label) != 0, True]) if len(label) else np.zeros(1, int)
    strands = []
    for a, b in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        strand = _strand(place[a:b], *(column[a:b] for column in columns))
        mixed = strand.classes.get("mixed", 0.0) > 0.5 * strand.length
        if strand.length >= (STRANDS.min_mixed_strand if mixed else STRANDS.min_strand_length):
            strands.append(strand)
    return sorted(strands, key=lambda strand: (strand.first, strand.d[0]))


def _strand(place, rank, along, across, height):
    """A Strand of points sorted by place, then across; all columns (N,), lengths in units."""
    starts = np.flatnonzero(np.append(True, place[1:] != place[:-1]))
    count = np.diff(np.append(starts, len(place)))
    middle, outer = _middle_and_width(across, starts)
    # where a line runs into other paint it is wider than itself, and its middle is not its own
    narrow = outer <= 1.5 * median(outer) + 400
    if not narrow.all():
        inside = np.repeat(narrow, count)
        return _strand(*(column[inside] for column in (place, rank, along, across, height)))
    first, last = float(along.min() * COORDINATE_SCALE), float(along.max() * COORDINATE_SCALE)
    s, z = (np.add.reduceat(values, starts, dtype=np.int64) / count * COORDINATE_SCALE for values in (along, height))
    d = middle * COORDINATE_SCALE
    offset = across * COORDINATE_SCALE
    low, high = percentiles(offset - np.repeat(d, count), (2.5, 97.5))
    share = np.bincount(rank, minlength=len(LINE_KINDS) + 1) / len(rank) * (last - first)
    classes = {name: float(share[k]) for k, name in enumerate(LINE_KINDS + ("mixed",)) if share[k] > 0}
    return Strand(first, last, s, d, z, count.astype(float), (high - low) / 0.95, classes)


# The edges of the road beside painted lines: an edge line keeps its distance from the edge, also where the road widens.

LINE_TO_EDGE = 4.0   # source: m between a line and the edge that it runs along: the widest paved shoulders are 12 ft (AASHTO, Green Book, 4.4.2)


@dataclass
class EdgesBeside:
    """The edges along one road: the stations and offsets of each; and islands and hatched areas, (V, 2) outlines by station and offset, m."""

    edges: list[tuple[np.ndarray, np.ndarray]]
    islands: Sequence[np.ndarray] = ()   # plain values: what a process is sent, and a run is known by, holds no shapes
    hatched: Sequence[np.ndarray] = ()

    @cached_property
    def _inner(self):
        """Islands, and hatched areas, without their rims: of what is narrow, such as a line that touches a bar, nothing is left."""
        return [shapely.STRtree(shapely.buffer(list(map(shapely.Polygon, areas)), -SELECTION.max_bar_end_offset))
                for areas in (self.islands, self.hatched)]

    def bars(self, s: np.ndarray, d: np.ndarray, hatching: bool = False) -> np.ndarray:
        """(N,) bool, whether an island, or else a hatched area, lies between two places, (N, 2) m each."""
        between, _ = self._inner[hatching].query(shapely.linestrings(np.stack([s, d], axis=-1)), predicate="intersects")
        return np.isin(np.arange(len(s)), between)

    def framed(self, line: LinkedLine) -> bool:
        """Whether a line is the outline of hatched areas along most of its paint; an edge line beside one goes on after it."""
        s, d, *_ = line.places
        near, _ = self._inner[1].query(shapely.points(s, d), "dwithin", 2 * SELECTION.max_bar_end_offset)
        return len(np.unique(near)) > SELECTION.min_shared_paint * len(s)

    @cached_property
    def _spans(self):
        return np.array([(s[0], s[-1]) for s, _ in self.edges]).reshape(-1, 2).T

    def along(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) the nearest edge that leads along both of two places, (N, 2) m each; -1 without one."""
        order, result, nearest = np.argsort(s.min(axis=1)), np.full(len(s), -1), np.full(len(s), np.inf)
        low, high = s.min(axis=1)[order], s.max(axis=1)[order]
        for k in np.flatnonzero((self._spans[0] <= low.max(initial=-np.inf)) & (self._spans[1] >= high.min(initial=np.inf))).tolist():
            edge, first, last = self.edges[k], *(ends[k] for ends in self._spans)
            inside = np.arange(*np.searchsorted(low, [first, np.nextafter(last, np.inf)]))
            rows = order[inside[high[inside] <= last]]
            farthest = np.abs(np.interp(s[rows], *edge) - d[rows]).max(axis=1)
            nearer = farthest < nearest[rows]
            result[rows[nearer]], nearest[rows[nearer]] = k, farthest[nearer]
        return np.where(nearest <= LINE_TO_EDGE, result, -1)

    def between(self, before: tuple[float, float], after: tuple[float, float]) -> Callable[[np.ndarray], np.ndarray] | None:
        """The nearest edge that leads along both of two places, (station, offset) in m: a function of stations (N,), its offset; None without one."""
        number, = self.along(*(np.array([pair]) for pair in zip(before, after)))
        if number < 0:
            return None
        s, d = self.edges[number]
        return partial(np.interp, xp=s, fp=d)


def _edges(sections):
    """(stations, offsets) of the edges of CrossSections; where one is interrupted another begins."""
    for k, first in enumerate(sections.d.spans.first.tolist()):
        d = sections.d.row(k)
        finite = np.flatnonzero(np.isfinite(d))
        for part in np.split(finite, np.flatnonzero(np.diff(finite) > 1) + 1):
            if len(part) > 1:
                yield sections.s[first + part], d[part]


def edges_beside(edges: RoadEdges | EdgeSections | None, hatched: dict[int, list[np.ndarray]]) -> dict[int, EdgesBeside]:
    """EdgesBeside of every road, of which `hatched` holds its areas; without edges, or where none are known, there are none."""
    kinds = EdgeSections.of(edges)
    return {road: EdgesBeside([edge for sections in kinds if sections and road in sections for edge in _edges(sections[road])],
                              _islands(kinds.curbs[road]) if kinds.curbs and road in kinds.curbs else (), areas)
            for road, areas in hatched.items()}


def _islands(curbs):
    """Outlines of the islands of CrossSections, whose sides share a number."""
    of_island = np.array(curbs.kinds, object)[curbs.d.spans.owner] == "island"
    number, station, d = (values[of_island & np.isfinite(curbs.d.values)] for values in (curbs.number.values, curbs.d.spans.station, curbs.d.values))
    return [_area_between(curbs.s[station[number == island]], d[number == island]) for island in np.unique(number)]


def _area_between(s, d):
    """(V, 2) outline of the area between the least and the greatest offset at each station, of (N,) places."""
    stations, of = np.unique(s, return_inverse=True)
    low, high = np.full(len(stations), np.inf), np.full(len(stations), -np.inf)
    np.minimum.at(low, of, d)
    np.maximum.at(high, of, d)
    return np.r_[np.c_[stations, low], np.c_[stations, high][::-1]] if len(stations) > 1 else np.empty((0, 2))


# Lines that few tracks of the scan met: each track shows such a line at one place of its width.

LONGEST_HOLE_UNITS = STRANDS.max_bin_step * STRANDS.run_bin_units   # derived: of wear in one strand


def painted_strands(records: Columns, rank: np.ndarray) -> list[Strand]:
    """Strands of painted line, by station: traced place by place where points lie close together, else along the middle line of their marking.

    `records` : N points with `cluster` and `spacing`; `rank` : (N,) class of each as `line_paint` gives it.
    """
    cluster = records["cluster"]
    # most points of the marking, which is a line
    apart = (records["spacing"] >= STRANDS.few_tracks * 1e3) & (rank < len(LINE_KINDS))
    sparse = (2 * np.bincount(cluster[apart], minlength=int(cluster.max(initial=-1)) + 1) > np.bincount(cluster))[cluster]
    few = np.flatnonzero(sparse)
    check_cancelled()
    few = few[np.lexsort((records["s"][few], cluster[few]))]
    strands = trace_strands(records[~sparse], rank[~sparse]) if len(few) else trace_strands(records, rank)
    s_of_few = records["s"][few]
    new = np.r_[True, (np.diff(cluster[few]) != 0) | (np.diff(s_of_few) > LONGEST_HOLE_UNITS)] if len(few) else np.empty(0, bool)
    bounds = np.append(np.flatnonzero(new), len(few))
    columns = [records[name][few] for name in ("s", "d", "z", "spacing")]
    for a, b in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        if (s_of_few[b - 1] - s_of_few[a]) * COORDINATE_SCALE >= STRANDS.min_strand_length:
            s, d, z, spacing = (values[a:b] for values in columns)
            strands.append(_strand_of_marking(s, d, z, spacing, LINE_KINDS[int(rank[few[a]])]))
    return sorted(strands, key=lambda strand: (strand.first, strand.d[0]))


def _strand_of_marking(along, across, height, spacing, kind):
    """The Strand of the points of one marking, by station; lengths in units, the spacing in mm."""
    nodes, offsets = middle_line(along, across, median(spacing) * 1e-3)
    if len(nodes) < 3:
        # too short to be followed: straight
        nodes = along[[0, -1]]
        offsets = np.polyval(np.polyfit(along - along[0], across, 1), nodes - along[0])
    starts = np.flatnonzero(np.r_[True, np.diff(along // STRANDS.place_step_units) != 0])
    count = np.diff(np.append(starts, len(along)))
    s, z = (np.add.reduceat(values, starts, dtype=np.int64) / count for values in (along, height))
    low, high = percentiles((across - np.interp(along, nodes, offsets)) * COORDINATE_SCALE, (2.5, 97.5))
    first, last = (float(along[k]) * COORDINATE_SCALE for k in (0, -1))
    return Strand(first, last, s * COORDINATE_SCALE, np.interp(s, nodes, offsets) * COORDINATE_SCALE, z * COORDINATE_SCALE, count.astype(float),
                  (high - low) / 0.95, {kind: last - first}, min(median(spacing) * 1e-3, STRANDS.max_line_width_units * COORDINATE_SCALE) / 2)
