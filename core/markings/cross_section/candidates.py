"""What may bound lanes at each place along a road: painted lines, curbs and the ends of the road surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .sections import STATION_STEP, CrossSections
from .weights import CENTRE_LINE, CURB, DASHED, DOUBLE, EDGE_LINE, HATCHING, OPEN, OUTSIDE, SOLID, SURFACE, EstimateWeights

NAMES = {"edge": EDGE_LINE, "centre": CENTRE_LINE}   # a line called lane line may have been called nothing better
STATIONS_OF_CELL = 5                       # stations of the grid that are always in one interval: 2.5 m
MAX_INTERVAL = 4               # cells: longer intervals are divided
DOUBLE_SPACING = 0.22, 0.6     # m between the two lines of a double line; nearer ones are one line
WEAK_TWIN = 0.25               # of the paint of the line beside it: less is a frayed edge, no second line
FRAYED_LENGTH = 6.0             # m of paint at most of such an edge
MAX_BOUNDARIES = 16            # at one place
FAR = 30.0                     # m: beyond any road
LIKELY_SHARE = 0.8, 1.5         # of the usual width of a lane: lanes in bends
SURFACE_MERGE = 0.8               # m: the surface ends at the line or curb that lies this near


@dataclass
class Boundaries:
    """All rows that may bound lanes on one grid of stations: lines, then curbs, then ends of the surface.

    s : (K,) stations; d : (R, K) offsets, NaN where a row is not; seen : (R, K); made_of : (R,) of SOLID ... SURFACE
    patterns : (R, K) what paint is made of at each place; paint : (R,) m of paint of each row
    named : (R,) what a row separates by its layer, -1 where that is not said
    bend : (K,) whether the road bends so much that lanes are widened
    """

    s: np.ndarray
    d: np.ndarray
    seen: np.ndarray
    made_of: np.ndarray
    patterns: np.ndarray
    paint: np.ndarray
    named: np.ndarray
    bend: np.ndarray

    @property
    def bounding(self) -> np.ndarray:
        """(R,) bool, whether a row is paint that bounds lanes: a line, or the border of a hatched area."""
        return self.painted | (self.made_of == HATCHING)

    @property
    def painted(self) -> np.ndarray:
        """(R,) bool, whether a row is a painted line."""
        return self.made_of <= DOUBLE


def gather_boundaries(lines: CrossSections, curbs: CrossSections | None = None, surface: np.ndarray | None = None,
                      open_ends: np.ndarray | None = None, bend: np.ndarray | None = None, hatching: np.ndarray | None = None) -> Boundaries:
    """Lines, curbs and the two ends of the surface or, where that is unknown, open ends, (2, K) offsets each or None, on the grid of the lines."""
    rows, count = len(lines.d), len(lines.s)
    of_name = np.array([_made_of(name) for name in lines.names] + [SOLID], int)
    usual = np.array([_made_of(name) for name in lines.patterns], int)
    patterns = np.where(lines.drawn >= 0, of_name[lines.drawn], usual[:, None]) if rows else np.empty((0, count), int)
    d, seen = [lines.d], [lines.seen & np.isfinite(lines.d)]
    made_of = [np.full(rows, SOLID)]
    if curbs is not None:
        at = np.rint((lines.s - curbs.s[0]) / STATION_STEP).astype(int)
        inside = (at >= 0) & (at < len(curbs.s))
        at = np.clip(at, 0, len(curbs.s) - 1)
        d.append(np.where(inside, curbs.d[:, at], np.nan))
        seen.append(curbs.seen[:, at] & inside & np.isfinite(curbs.d[:, at]))
        made_of.append(np.full(len(curbs.d), CURB))
    for ends, made in ((surface, SURFACE), (open_ends, OPEN), (hatching, HATCHING)):
        if ends is not None:
            d.append(ends)
            seen.append(np.isfinite(ends))
            made_of.append(np.full(len(ends), made))
    found_d, found_seen, found_made = np.concatenate(d), np.concatenate(seen), np.concatenate(made_of)
    other = np.repeat(found_made[rows:, None], count, axis=1)
    return Boundaries(lines.s, found_d, found_seen, found_made, np.concatenate([patterns, other]), STATION_STEP * found_seen.sum(1),
                      np.r_[[NAMES.get(kind, -1) for kind in lines.kinds], np.full(len(other), -1)].astype(int),
                      np.zeros(count, bool) if bend is None else bend)


def surface_lane_width(width: np.ndarray, number: int, usual: float, bend: np.ndarray) -> np.ndarray:
    """Metres, of each of `number` lanes between a line and the end of the surface: the usual width, in bends what there is.

    The surface may end at what hides it, and reach into side streets; but lanes are widened in bends.
    """
    each = width / number
    return np.where(bend & (each > LIKELY_SHARE[0] * usual) & (each < LIKELY_SHARE[1] * usual), each, usual)


def _made_of(pattern):
    if "double" in pattern:
        return DOUBLE
    return DASHED if pattern.startswith("dash") else SOLID


@dataclass
class Candidates:
    """Boundaries by interval, from left to right; the first and the last stand for what lies outside.

    first, last : (I,) stations of the grid that an interval begins and ends with
    left, right : (I, M) m, offsets of the leftmost and the rightmost line of a boundary (a double line is one boundary)
    made_of : (I, M) of SOLID ... OUTSIDE; trust, seen : (I, M) 0 to 1
    rows : (I, M, 2) the rows of Boundaries that lie leftmost and rightmost; -1 outside
    valid : (I, M) False where there are fewer boundaries than M
    named : (I, M) what the layer says that a boundary separates, -1 where it does not
    bend : (I,) as in Boundaries
    """

    first: np.ndarray
    last: np.ndarray
    left: np.ndarray
    right: np.ndarray
    made_of: np.ndarray
    trust: np.ndarray
    seen: np.ndarray
    rows: np.ndarray
    valid: np.ndarray
    named: np.ndarray
    bend: np.ndarray

    @property
    def length(self) -> np.ndarray:
        """(I,) metres."""
        return STATION_STEP * (self.last - self.first + 1)


def boundary_candidates(boundaries: Boundaries, weights: EstimateWeights) -> Candidates:
    """Cut the road into intervals of the same boundaries, of at most 10 m."""
    cell = np.floor(boundaries.s / (STATION_STEP * STATIONS_OF_CELL) + 1e-6).astype(int)
    starts = np.flatnonzero(np.r_[True, np.diff(cell) != 0])
    present = np.isfinite(boundaries.d)
    inside = np.add.reduceat(present, starts, axis=1)
    size = np.diff(np.r_[starts, len(cell)])
    in_cell = 2 * inside >= size
    cut = np.r_[True, (in_cell[:, 1:] != in_cell[:, :-1]).any(0)]
    run = np.cumsum(cut) - 1
    within = np.arange(len(starts)) - np.flatnonzero(cut)[run]
    cut |= within % MAX_INTERVAL == 0
    first = starts[cut]
    last = np.r_[first[1:], len(cell)] - 1
    in_interval = in_cell[:, cut]
    stations = np.maximum(np.add.reduceat(present, first, axis=1), 1)
    d = np.add.reduceat(np.where(present, boundaries.d, 0.0), first, axis=1) / stations
    seen = np.add.reduceat(boundaries.seen, first, axis=1) / (last - first + 1)
    dashed, double = (np.add.reduceat((boundaries.patterns == kind) & present, first, axis=1) / stations for kind in (DASHED, DOUBLE))
    row, interval = np.nonzero(in_interval)
    made = np.where(boundaries.painted[row], np.select([double[row, interval] > 0.5, dashed[row, interval] > 0.5], [DOUBLE, DASHED], SOLID),
                    boundaries.made_of[row])
    return _grouped(first, last, interval, row, d[row, interval], made, np.minimum(seen[row, interval], 1.0), boundaries, weights)


def _grouped(first, last, interval, row, d, made, seen, boundaries, weights):
    """Candidates of entries: two lines beside each other are one boundary."""
    trust = np.where(made <= DOUBLE, np.clip((boundaries.paint[row] - weights.stroke) / (weights.long_line - weights.stroke), 0.02, 1.0), 1.0)
    order = np.lexsort((-d, interval))
    interval, row, d, made, seen, trust = (values[order] for values in (interval, row, d, made, seen, trust))
    paint = made <= DOUBLE
    near = np.r_[False, (np.diff(interval) == 0) & (-np.diff(d) < DOUBLE_SPACING[1]) & paint[1:] & paint[:-1]]
    # a sliver beside a line is that line's frayed edge; the surface ends at its curb
    drop = np.zeros(len(d), bool)
    for step in (-1, 1):
        beside = np.roll(near, -1) if step > 0 else near
        drop |= beside & (np.roll(boundaries.paint[row], -step) * WEAK_TWIN > boundaries.paint[row]) & (boundaries.paint[row] < FRAYED_LENGTH)
        close = np.abs(np.roll(d, -step) - d) < SURFACE_MERGE
        drop |= (made == HATCHING) & (np.roll(interval, -step) == interval) & close & (np.roll(made, -step) <= DOUBLE)
        drop |= (made == SURFACE) & (np.roll(interval, -step) == interval) & close & (np.roll(made, -step) != SURFACE)
    interval, row, d, made, seen, trust, paint = (values[~drop] for values in (interval, row, d, made, seen, trust, paint))
    near = np.r_[False, (np.diff(interval) == 0) & (-np.diff(d) < DOUBLE_SPACING[1]) & paint[1:] & paint[:-1]]
    begin = np.flatnonzero(~near)
    count = np.diff(np.r_[begin, len(d)])
    end = begin + count - 1
    of = interval[begin]
    strength, shown_there = (np.maximum.reduceat(values, begin) if len(begin) else values for values in (trust, seen))
    solid = np.minimum.reduceat(made, begin) if len(begin) else made
    # two lines closer than that are the two sides of one broad line
    made_of = np.where((count > 1) & (d[begin] - d[end] > DOUBLE_SPACING[0]) & (solid <= DOUBLE), DOUBLE, np.where(solid == DOUBLE, SOLID, solid))
    rank = np.arange(len(of)) - np.searchsorted(of, of)
    most = np.bincount(of, minlength=len(first))
    if most.max(initial=0) > MAX_BOUNDARIES:
        weak = np.lexsort((-strength, of))
        place = np.empty(len(of), int)
        place[weak] = np.arange(len(of)) - np.searchsorted(of[weak], of[weak])
        keep = place < MAX_BOUNDARIES
        begin, end, of, strength, made_of, shown_there = (values[keep] for values in (begin, end, of, strength, made_of, shown_there))
        rank = np.arange(len(of)) - np.searchsorted(of, of)
        most = np.bincount(of, minlength=len(first))
    wide = int(most.max(initial=0)) + 2
    shape = (len(first), wide)
    left, right = np.full(shape, -FAR), np.full(shape, -FAR)
    left[:, 0] = right[:, 0] = FAR
    kinds, sure, shown = np.full(shape, OUTSIDE), np.zeros(shape), np.zeros(shape)
    rows, valid = np.full((*shape, 2), -1), np.zeros(shape, bool)
    valid[:, 0] = valid[:, -1] = True
    at = of, rank + 1
    left[at], right[at], kinds[at], sure[at] = d[begin], d[end], made_of, strength
    shown[at] = shown_there
    rows[at] = np.stack([row[begin], row[end]], axis=1)
    valid[at] = True
    named = np.full(shape, -1)
    named[at] = boundaries.named[row[begin]]
    return Candidates(first, last, left, right, kinds, sure, shown, rows, valid, named, boundaries.bend[(first + last) // 2])
