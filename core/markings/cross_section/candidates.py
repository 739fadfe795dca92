"""What may bound lanes at each place along a road: painted lines, curbs and the ends of the road surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...common.arrays import Rows, mask_runs
from ...countries.catalogue import NEUTRAL
from ...survey.frame.row_table import RowTable, stacked
from ...survey.store.records import FAR
from ..weights import LANES
from .sections import STATION_STEP, CrossSections
from .weights import BARE, CENTRE_LINE, CURB, DASHED, DOUBLE, EDGE_LINE, HATCHING, ISLAND, OPEN, OUTSIDE, PAVEMENT, SOLID, SURFACE, EstimateWeights

NAMES = {"edge": EDGE_LINE, "centre": CENTRE_LINE}   # a line called lane line may have been called nothing better
STATIONS_OF_CELL = 5   # derived: stations of the grid that are always in one interval: 2.5 m
MAX_BOUNDARIES = 16   # derived: at one place
USUAL_WIDTH = 0.10, 0.20   # source: m, of lines of usual breadth in all countries of the catalogue
ENDS = SURFACE, PAVEMENT       # ends of the surface


class _MadeOf:
    """What has `made_of`, of SOLID ... BARE."""

    made_of: np.ndarray

    @cached_property
    def bounding(self) -> np.ndarray:
        """Bool, whether each is paint that bounds lanes: a line, or the border of a hatched area."""
        return self.painted | (self.made_of == HATCHING)

    @cached_property
    def painted(self) -> np.ndarray:
        """Bool, whether each is a painted line."""
        return self.made_of <= DOUBLE


@dataclass
class Boundaries(_MadeOf):
    """All rows that may bound lanes on one grid of stations: lines, then curbs, then ends of the surface.

    patterns : (R, K) what a row is made of at each place: lines are solid here and dashed there, and where the surface ends an edge of the pavement
        is seen (PAVEMENT) or not
    """

    s: np.ndarray   # (K,) stations
    d: RowTable   # RowTable of (R, K) offsets, NaN where a row is not
    seen: RowTable   # (R, K)
    made_of: np.ndarray   # (R,) of SOLID ... ISLAND
    patterns: RowTable
    paint: np.ndarray   # (R,) m of paint of each row
    named: np.ndarray   # (R,) what a row separates by its layer, -1 where that is not said
    wide: RowTable   # (R, K) 0 to 1, whether a row is a wide line, which is at least twice as broad as the usual lines of its road


def gather_boundaries(lines: CrossSections, curbs: CrossSections | None = None, surface: np.ndarray | None = None,
                      open_ends: np.ndarray | None = None, hatching: RowTable | None = None,
                      pavement: CrossSections | None = None) -> Boundaries:
    """Lines, curbs and the two ends of the surface or, where that is unknown, open ends, (2, K) offsets each or None, on the grid of the lines.

    Where an edge of the pavement was seen beside an end of the surface, the surface ends at it. A line that goes on behind a hatched area may bound
    lanes beside the area, too, unseen.
    """
    count = len(lines.s)
    if hatching is not None:
        lines = replace(lines, d=_up_to_areas(_over_areas(lines.d, hatching), lines.number, hatching))
    of_name = np.array([_made_of(name) for name in lines.names] + [SOLID], np.int8)
    usual = np.array([_made_of(name) for name in lines.patterns], np.int8)
    drawn, owner = lines.drawn.values, lines.d.spans.owner
    # offsets, where they were seen, what rows are made of, as a whole and at each place
    tables = [(lines.d, lines.seen.values, np.full(len(lines.d), SOLID), lines.d.like(np.where(drawn >= 0, of_name[drawn], usual[owner]), usual))]
    if curbs is not None:
        made_of = np.where(np.array(curbs.kinds, object) == "island", ISLAND, CURB).astype(np.int8)
        d, seen = _on_stations(curbs, lines.s)
        tables.append((d, seen.values, made_of, d.like(made_of[d.spans.owner], made_of)))
    ends: list[tuple[RowTable, int, np.ndarray | int]] = []
    if surface is not None:
        surface, at_edge = _at_edges(surface, pavement, lines.s)
        ends.append((RowTable.of_rows([(0, row) for row in surface], count), SURFACE, np.where(at_edge, PAVEMENT, SURFACE).ravel()))
    if open_ends is not None:
        ends.append((RowTable.of_rows([(0, row) for row in open_ends], count), OPEN, OPEN))
    if hatching is not None:
        ends.append((hatching, HATCHING, HATCHING))
    ends.append((_bare_borders(lines.d), BARE, BARE))
    for d, end_kind, at_places in ends:
        patterns = np.empty(d.spans.size, np.int8)
        patterns[:] = at_places
        tables.append((d, np.ones(d.spans.size, bool), np.full(len(d), end_kind), d.like(patterns, end_kind)))
    found_d, all_patterns = stacked([d for d, *_ in tables]), stacked([made_of for *_, made_of in tables])
    found_seen = np.isfinite(found_d.values) & np.concatenate([seen for _, seen, *_ in tables])
    unpainted = len(found_d) - len(lines.d)
    paint = STATION_STEP * np.bincount(found_d.spans.owner, found_seen, len(found_d))
    return Boundaries(lines.s, found_d, found_d.like(found_seen, False), np.concatenate([made_of for _, _, made_of, _ in tables]), all_patterns,
                      paint, np.r_[[NAMES.get(kind, -1) for kind in lines.kinds], np.full(unpainted, -1)].astype(int),
                      found_d.like(np.append(wide := _wide_share(lines), np.full(found_d.spans.size - len(wide), np.nan)), np.nan))


def _up_to_areas(d, number, hatching):
    """Offsets of lines without what stands for the next dash at their ends, `number` -1, on hatched areas: these show at once that lines end."""
    values, station, owner, seen = d.values.copy(), d.spans.station, d.spans.owner, number.values >= 0
    begin, last = np.full(len(d), d.spans.stations), np.full(len(d), -1)
    np.minimum.at(begin, owner[seen], station[seen])
    np.maximum.at(last, owner[seen], station[seen])
    beyond = np.flatnonzero((station < begin[owner]) | (station > last[owner]))
    beyond = beyond[np.argsort(station[beyond], kind="stable")]
    stations = station[beyond]
    for left in range(0, len(hatching), 2):
        first = hatching.spans.first[left]
        rows = beyond[slice(*np.searchsorted(stations, [first, hatching.spans.end[left]]))]
        high, low = (hatching.row(side)[station[rows] - first] for side in (left, left + 1))
        values[rows[(values[rows] < high) & (values[rows] > low)]] = np.nan
    return d.like(values, np.nan)


def _over_areas(d, hatching):
    """Offsets of lines, led over the hatched areas on which they are interrupted as the lines lie that are not."""
    values = d.values.copy()
    for first, end in mask_runs(np.isnan(values)):
        stations = np.append(station := d.spans.station[first - 1:end], station[-1] + 1)
        borders = hatching[hatching.spans.near(stations[1], stations[-2])[:, None], stations[1:-1]]
        if len(borders):
            beside = d[d.spans.near(stations[0], stations[-1])[:, None], stations]
            beside = beside[np.isfinite(beside).all(axis=1)]
            course = beside.mean(axis=0) if len(beside) else np.zeros(len(stations))
            led = (course + np.interp(stations, stations[[0, -1]], values[[first - 1, end]] - course[[0, -1]]))[1:-1]
            if ((led < borders[::2] + LANES.surface_merge) & (led > borders[1::2] - LANES.surface_merge)).any():
                values[first:end] = led
    return d.like(values, np.nan)


def _bare_borders(d):
    """Where lanes beside lines may end on bare asphalt, as there is too much room up to the next line; as wide as others beside it or on the road.

    They tell it in whole centimetres: a line that moves a little somewhere on a long road moves no border elsewhere.
    """
    row, station = d.spans.owner, d.spans.station
    order = np.lexsort((-d.values, station))
    order = order[np.isfinite(d.values[order])]
    pairs = np.stack([order[:-1], order[1:]])[:, np.diff(station[order]) == 0]
    room = -np.diff(d.values[pairs], axis=0)[0]
    lane = (room >= NEUTRAL.narrowest_lane) & (room <= NEUTRAL.widest_lane)
    count, total = (np.bincount(row[pairs[:, lane]].ravel(), np.tile(values, 2), len(d)) for values in (np.ones(lane.sum()), room[lane]))
    width = np.round(np.where(count > 0, total / np.maximum(count, 1), np.median(room[lane]) if lane.any() else np.nan), 2)[row]
    borders = []
    for beside, sign in zip(pairs, (-1, 1)):
        usual_there = width[beside]
        beside = beside[(room > usual_there + LANES.least_left_over) & (room < LANES.max_lanes * usual_there)]
        values = np.full(len(row), np.nan)
        values[beside] = d.values[beside] + sign * width[beside]
        borders += [(int(d.spans.first[k]), values[d.spans.values_of(k)]) for k in np.unique(row[beside]).tolist()]
    return RowTable.of_rows(borders, d.spans.stations)


def _on_stations(sections, s):
    """Offsets of CrossSections at (K,) stations, NaN where they are not, and where they were seen."""
    by = int(np.rint((s[0] - sections.s[0]) / STATION_STEP))
    return sections.d.shifted(by, len(s)), sections.seen.shifted(by, len(s))


def _at_edges(surface, pavement, s):
    """The ends of the surface moved to the edges of the pavement that were seen there, and where that is, (2, K) bool."""
    nearest = np.full(surface.shape, np.nan)
    if pavement is not None and len(pavement.d):
        d, seen = _on_stations(pavement, s)
        for of_side, ends in zip(nearest, surface):
            offset = d.values - ends[d.spans.station]
            near = np.flatnonzero(seen.values & (np.abs(offset) < LANES.surface_merge))
            near = near[np.argsort(-np.abs(offset[near]), kind="stable")]   # the nearest is written last
            of_side[d.spans.station[near]] = offset[near]
    at_edge = np.isfinite(nearest)
    return np.where(at_edge, surface + nearest, surface), at_edge


def _wide_share(lines):
    """Of each place of lines, 0 to 1, whether they are wide against the usual ones of their road, which the narrower of its painted length tells."""
    d, seen, width = (table.values for table in (lines.d, lines.seen, lines.width))
    measured = seen & np.isfinite(d) & (width > 0)
    if not measured.any():
        return np.full(len(d), np.nan)
    usual = np.clip(np.quantile(width[measured], LANES.usual_lines), *USUAL_WIDTH)
    return np.where(measured, 1 / (1 + np.exp(-(np.where(measured, width, usual) / usual - LANES.wide_line) / LANES.wide_softness)), np.nan)


def _made_of(pattern):
    if "double" in pattern:
        return DOUBLE
    return DASHED if pattern.startswith("dash") else SOLID


@dataclass
class Candidates(Rows, _MadeOf):
    """Boundaries by interval, from left to right; the first and the last stand for what lies outside."""

    first: np.ndarray   # (I,) stations of the grid that an interval begins and ends with
    last: np.ndarray
    left: np.ndarray   # (I, M) m, offsets of the leftmost and the rightmost line of a boundary (a double line is one boundary)
    right: np.ndarray
    made_of: np.ndarray   # (I, M) of SOLID ... ISLAND
    trust: np.ndarray   # (I, M) 0 to 1
    seen: np.ndarray
    rows: np.ndarray   # (I, M, 2) the rows of Boundaries that lie leftmost and rightmost; -1 outside
    valid: np.ndarray   # (I, M) False where there are fewer boundaries than M
    named: np.ndarray   # (I, M) what the layer says that a boundary separates, -1 where it does not
    wide: np.ndarray   # (I, M) as there, NaN of double lines
    drift: np.ndarray   # (I, M, 2) m, how far left of those offsets a boundary lies where an interval begins and where it ends
    beside: np.ndarray   # (I, M, 2, 5) as `lanes_beside` gives it; NaN before

    def at_end(self, end: int, which: np.ndarray) -> Candidates:
        """The boundaries where the intervals begin, 0, or where they end, 1, in those of them that are meant, (I,) bool."""
        moved = which[:, None] * self.drift[..., end]
        return replace(self, left=self.left + moved, right=self.right + moved)

    @property
    def length(self) -> np.ndarray:
        """(I,) metres."""
        return STATION_STEP * (self.last - self.first + 1)

    def observations(self, weights: EstimateWeights) -> np.ndarray:
        """(I,) how many observations each interval is, of what goes on along the road."""
        return self.length / weights.correlation


def boundary_candidates(boundaries: Boundaries, weights: EstimateWeights) -> Candidates:
    """Cut the road into intervals of the same boundaries, of at most 10 m."""
    cell = np.floor(boundaries.s / (STATION_STEP * STATIONS_OF_CELL) + 1e-6).astype(int)
    starts = np.flatnonzero(np.r_[True, np.diff(cell) != 0])
    number = np.cumsum(np.r_[0, np.diff(cell) != 0])   # of the cell of each station
    size = np.diff(np.r_[starts, len(cell)])
    cells = _Stretches(boundaries.d, number)
    in_cell = 2 * cells.sums(np.isfinite(boundaries.d.values)) >= size[cells.of]
    # what a row is in one cell and in the next, in the first and after the last of those that it reaches too
    begins = np.r_[True, np.diff(cells.row) != 0] if len(cells.row) else np.empty(0, bool)
    before = np.where(begins, False, np.roll(in_cell, 1))
    behind = in_cell & np.roll(begins, -1)
    cut = np.zeros(len(starts) + 1, bool)
    cut[0] = cut[cells.of[in_cell != before]] = cut[cells.of[behind] + 1] = True
    cut = cut[:-1]
    run = np.cumsum(cut) - 1
    within = np.arange(len(starts)) - np.flatnonzero(cut)[run]
    cut |= within % LANES.max_interval == 0
    first = starts[cut]
    last = np.r_[first[1:], len(cell)] - 1
    intervals = _Stretches(boundaries.d, (np.cumsum(cut) - 1)[number])
    entries = _entries(boundaries, intervals, last - first + 1, weights)
    entries = _rows(entries, np.flatnonzero(_in_first_cell(cells, intervals, np.flatnonzero(cut), in_cell)))
    entries = _rows(entries, np.lexsort((-entries["d"], entries["interval"])))
    return _table(_grouped(_rows(entries, ~_superfluous(entries, boundaries))), boundaries, first, last)


class _Stretches:
    """Stretches of the rows of a table, each within one cell or interval: its row, and `of` which cell it is, row after row.

    of_station : (K,) int, ascending, the cell of each station
    """

    def __init__(self, table, of_station):
        self.row, self.of = table.spans.owner, of_station[table.spans.station]
        self.begin = np.flatnonzero(np.r_[True, (np.diff(self.row) != 0) | (np.diff(self.of) != 0)]) if len(self.of) else np.empty(0, int)
        self.row, self.of = self.row[self.begin], self.of[self.begin]

    def sums(self, values):
        """Sums over the places of each stretch of what is known of all of them."""
        return np.add.reduceat(values, self.begin, dtype=float if values.dtype.kind == "f" else int) if len(self.begin) else np.empty(0)

    def means(self, share):
        """The same as means of what is not NaN."""
        finite = np.isfinite(share)
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.sums(np.where(finite, share, 0.0)) / self.sums(finite)


def _in_first_cell(cells, intervals, first_cell, in_cell):
    """(N,) bool, whether rows are in the first cell of their intervals, and so in all cells of them."""
    count = int(cells.of.max(initial=0)) + int(first_cell.max(initial=0)) + 1
    return np.isin(intervals.row * count + first_cell[intervals.of], (cells.row * count + cells.of)[in_cell])


def _entries(boundaries, intervals, size, weights):
    """What is known of rows in intervals: a dict of (N,) columns. `size` of intervals, in stations."""
    present, row = np.isfinite(boundaries.d.values), intervals.row
    stations = np.maximum(intervals.sums(present), 1)
    dashed, double, edge = (intervals.sums((boundaries.patterns.values == kind) & present) / stations for kind in (DASHED, DOUBLE, PAVEMENT))
    made_of = np.where(boundaries.painted[row], np.select([double > 0.5, dashed > 0.5], [DOUBLE, DASHED], SOLID),
                       np.where(edge > 0.5, PAVEMENT, boundaries.made_of[row]))
    trust = np.clip((boundaries.paint[row] - weights.stroke) / (weights.long_line - weights.stroke), 0.02, 1.0)
    d = intervals.sums(np.where(present, boundaries.d.values, 0.0)) / stations
    head, tail = (np.nan_to_num(boundaries.d.values[places] - d) for places in (intervals.begin, np.append(intervals.begin[1:], len(present)) - 1))
    return dict(interval=intervals.of, row=row, d=d, head=head, tail=tail, made=made_of,
                wide=intervals.means(boundaries.wide.values),
                seen=np.minimum(intervals.sums(boundaries.seen.values) / size[intervals.of], 1.0), trust=np.where(made_of <= DOUBLE, trust, 1.0))


def _rows(entries, which):
    return {name: values[which] for name, values in entries.items()}


def _twins(entries):
    """(N,) bool, whether an entry is paint right beside the paint before it."""
    paint = entries["made"] <= DOUBLE
    return np.r_[False, (np.diff(entries["interval"]) == 0) & (-np.diff(entries["d"]) < LANES.double_spacing[1]) & paint[1:] & paint[:-1]]


def _superfluous(entries, boundaries):
    """(N,) bool: a sliver beside a line is that line's ragged edge; the surface ends at its line or curb, and so does a hatched area at its line."""
    interval, d, made_of = entries["interval"], entries["d"], entries["made"]
    paint, twins = boundaries.paint[entries["row"]], _twins(entries)
    result = np.zeros(len(d), bool)
    for step in (-1, 1):
        neighbour, twin = np.roll(made_of, -step), np.roll(twins, -1) if step > 0 else twins
        result |= twin & (np.roll(paint, -step) * LANES.weak_twin > paint) & (paint < LANES.ragged_length)
        close = (np.roll(interval, -step) == interval) & (np.abs(np.roll(d, -step) - d) < LANES.surface_merge)
        result |= close & ((made_of == HATCHING) & (neighbour <= DOUBLE) | np.isin(made_of, ENDS) & ~np.isin(neighbour, ENDS))
    return result


def _grouped(entries):
    """Entries by boundary, from left to right: two lines beside each other are one."""
    begin = np.flatnonzero(~_twins(entries))
    if not len(begin):
        return {**entries, "right_row": entries["row"], "right": entries["d"]}
    end = np.r_[begin[1:], len(entries["d"])] - 1
    groups = _rows(entries, begin)
    for name in ("trust", "seen", "wide"):
        groups[name] = np.maximum.reduceat(entries[name], begin)
    made_of, right = np.minimum.reduceat(entries["made"], begin), entries["d"][end]
    # two lines closer than that are the two sides of one broad line, unless their layer knows better
    double = np.logical_or.reduceat(entries["made"] == DOUBLE, begin) | (end > begin) & (groups["d"] - right > LANES.double_spacing[0])
    groups["made"] = np.where(double & (made_of <= DOUBLE), DOUBLE, made_of)
    groups["wide"] = np.where(double, np.nan, groups["wide"])
    return {**groups, "right_row": entries["row"][end], "right": right}


def _table(groups, boundaries, first, last):
    """Candidates of boundaries in order of interval, from left to right; where there are too many, of the surest."""
    interval = groups["interval"]
    surest = np.lexsort((-groups["trust"], interval))
    rank = np.empty(len(interval), int)
    rank[surest] = np.arange(len(interval)) - np.searchsorted(interval[surest], interval[surest])
    groups = _rows(groups, rank < MAX_BOUNDARIES)
    interval = groups["interval"]
    shape = len(first), int(np.bincount(interval, minlength=len(first)).max(initial=0)) + 2
    cell = interval, np.arange(len(interval)) - np.searchsorted(interval, interval) + 1

    def column(values, missing):
        table = np.full(shape, missing)
        table[cell] = values
        return table

    left, right = column(groups["d"], -FAR), column(groups["right"], -FAR)
    left[:, 0] = right[:, 0] = FAR
    valid = column(True, False)
    valid[:, [0, -1]] = True
    rows = np.stack([column(groups[name], -1) for name in ("row", "right_row")], axis=2)
    return Candidates(first, last, left, right, column(groups["made"], OUTSIDE), column(groups["trust"], 0.0), column(groups["seen"], 0.0), rows,
                      valid, column(boundaries.named[groups["row"]], -1), column(groups["wide"], np.nan),
                      np.stack([column(groups[name], 0.0) for name in ("head", "tail")], axis=2), np.full((*shape, 2, 5), np.nan))
