"""The most probable sequence of cross-sections along a road, by dynamic programming.

First what it costs to take a strip between two boundaries for lanes, then the best cross-sections of one interval, from left to right, then
the best sequence of them along the road.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import softmax

from ...common.arrays import Rows
from ...common.parallel import check_cancelled
from ...countries.catalogue import NEUTRAL
from ...survey.store.records import BIN, FAR
from ..weights import EVIDENCE, LANES
from .beside import BEYOND, WIDTH
from .candidates import Candidates
from .evidence import Evidence
from .weights import (
    BARE,
    CENTRE_LINE,
    CURB,
    DASHED,
    DOUBLE,
    EDGE_LINE,
    HATCHING,
    ISLAND,
    LANE_LINE,
    OTHER_LINE,
    OUTSIDE,
    PAVEMENT,
    SAME_LANE,
    SOLID,
    SURFACE,
    SURFACE_END,
    UNPAINTED,
    EstimateWeights,
)

# How wide lanes are in the strip between two boundaries, and where they begin.


def lane_places(left: np.ndarray, right: np.ndarray, made_left: np.ndarray, made_right: np.ndarray, number: np.ndarray | int, usual: float,
                beside: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Offset of the left border of the leftmost lane, and width of each lane, in strips between two boundaries; arrays broadcast together.

    Between two lines lanes share the strip. Beside a curb, or an edge of the pavement that was seen, one lane is as wide as `lanes_beside` says, and
    several are no wider than usual; beside an island, where nothing else has room, they share the strip too, but are as wide as usual where it
    reaches somewhat into them. Elsewhere the surface may end at what hides it, and reach into side streets: beside its end the room says nothing.

    left, right : m, offsets of the two boundaries of each strip; made_left, made_right : SOLID ... ISLAND, what they are made of
    number : lanes in the strip; usual : m, the usual width of a lane
    beside : (..., 5) as of `lanes_beside`, of one lane beside the one of the two that is painted
    """
    open_left, open_right = UNPAINTED[made_left], UNPAINTED[made_right]
    loose = open_left ^ open_right
    each_width = (left - right) / number
    alone = np.where(np.equal(number, 1) & (beside[..., BEYOND] != 0), beside[..., WIDTH], usual)
    hidden = loose & (SURFACE_END[made_left] | SURFACE_END[made_right])
    # the room of an interval is not quite the same at all its places
    full = np.abs(each_width - alone) < SAME_LANE
    likely = beside_island(made_left, made_right) & (each_width > LANES.likely_share[0] * usual) & (each_width < LANES.likely_share[1] * usual)
    each_width = np.select([hidden, loose & likely, loose & ~full], [alone, np.maximum(each_width, usual), np.minimum(each_width, alone)], each_width)
    begin = np.where(loose & open_left, right + number * each_width, left)
    apart = loose & np.equal(number, 1) & (beside[..., BEYOND] >= 0)
    return np.where(apart, np.where(open_left, left - beside[..., BEYOND], right + beside[..., BEYOND] + each_width), begin), each_width


def beside_of(c: Candidates, strips: LaneStrips) -> np.ndarray:
    """(S, 5) of `lanes_beside` for some strips, on the inner side of their boundary that is painted; beyond one aside is no room."""
    interval, left, right = strips.interval, strips.left, strips.right
    beside = np.where(UNPAINTED[c.made_of[interval, left]][:, None], c.beside[interval, right, 0], c.beside[interval, left, 1])
    beside[strips.aside, BEYOND] = 0.0
    return beside


def beside_island(made_left: np.ndarray, made_right: np.ndarray) -> np.ndarray:
    """Bool, whether a strip reaches to the curb of an island."""
    return (made_left == ISLAND) | (made_right == ISLAND)


# What it costs to take the strip between two boundaries for a lane, for several lanes, or for what nobody drives on.

# Strips from left to right: what nobody drives on, lanes of the direction that is met first, lanes of both directions without
# paint between them, most of them of the first direction, as many of either, or most of the other, lanes of the other direction,
# and again what nobody drives on
REST_FIRST, FIRST, MOST_FIRST, BOTH, MOST_SECOND, SECOND, REST_SECOND = STRIPS = range(7)
TWO_WAY = MOST_FIRST, BOTH, MOST_SECOND
# one lane of either direction that lies beside the border without paint of a strip, and not beside its line, is another kind to choose from
KINDS = np.array([*STRIPS, FIRST, SECOND])
FIRST_ASIDE, SECOND_ASIDE = range(len(STRIPS), len(KINDS))


@dataclass
class _StripCosts:
    """Costs of all strips."""

    cost: np.ndarray   # (9, I, M, M) nats, of a strip of one kind between two boundaries; inf where it cannot be
    lanes: np.ndarray   # (9, I, M, M) int8, how many lanes it holds at that cost, and how many of them are of the direction that is met first
    first_lanes: np.ndarray
    lane_width: float


def strip_costs(candidates: Candidates, evidence: Evidence, weights: EstimateWeights, lane_width: float, first_direction: int) -> _StripCosts:
    """Costs of all strips, the lanes of `first_direction` (1 or -1) being met first from the left."""
    c, w = candidates, weights
    count, size = c.left.shape
    scale = c.observations(w)[:, None, None]
    d_left, d_right = c.right[:, :, None], c.left[:, None, :]
    width = d_left - d_right
    ordered = c.valid[:, :, None] & c.valid[:, None, :] & (np.arange(size)[:, None] < np.arange(size))
    outside = (c.made_of == OUTSIDE)[:, :, None] | (c.made_of == OUTSIDE)[:, None, :]
    through = _passed_over(c, w)
    hatched = _share_between(evidence.hatched, c, width) > LANES.hatched_share if evidence.hatched is not None else np.zeros(width.shape, bool)
    paint = c.painted | (c.made_of == HATCHING)
    both_paint, any_paint = paint[:, :, None] & paint[:, None, :], paint[:, :, None] | paint[:, None, :]
    asphalt = width * _share_between(evidence.asphalt, c, width) if evidence.asphalt is not None else np.where(both_paint, width, 0.0)
    arrows_in, arrows = _arrows(c, evidence.arrows)

    cost = np.full((len(KINDS), count, size, size), np.inf)
    lanes, first_lanes = np.zeros((2, len(KINDS), count, size, size), np.int8)
    between = np.where(width > NEUTRAL.widest_lane, w.unused_wide, w.unused_asphalt[0])
    # beside a line bare asphalt is the lane that ends there
    beside_bare = any_paint & ((c.made_of == BARE)[:, None, :] | (c.made_of == BARE)[:, :, None])
    unused = np.where(both_paint, _unused(asphalt, between, LANES.asphalt_of_a_lane[0]), _unused(asphalt, np.where(beside_bare, *w.unused_asphalt)))
    # two lines on both sides are the border of a painted median: each is drawn as between the directions
    double = c.made_of == DOUBLE
    unused = np.where(double[:, :, None] & double[:, None, :], 2 * (w.double[CENTRE_LINE] - w.double[EDGE_LINE]), unused)
    inside = _inside(evidence.driven, c)
    at_stop = _at_stop(evidence.stops)
    idle = scale * (np.where(hatched, 0.0, unused) + w.driven_rest * inside[:evidence.own].sum(0)) + arrows_in * w.arrow_outside \
        + w.rest_at_stop * _lanes_stopped(at_stop, d_left, d_right, lane_width)
    # each boundary in what nobody drives on ends a strip of it, so that the same lanes are the same cross-section
    number = np.cumsum(c.valid, axis=1)
    cost[REST_FIRST] = cost[REST_SECOND] = np.where(ordered & (number[:, None, :] - number[:, :, None] == 1), idle, np.inf)

    made_left, made_right = c.made_of[:, :, None], c.made_of[:, None, :]
    # strips with paint on one side only, and of those the ones whose other side may be hidden
    loose = any_paint & ~both_paint
    hidden = loose & (SURFACE_END[made_left] | SURFACE_END[made_right])
    uncovered = np.clip(1 - asphalt / np.maximum(width, 0.1), 0, 1) if evidence.asphalt is not None else 0.0
    # a street that was driven between two borders has a lane without any paint
    border = np.isin(c.made_of, (CURB, PAVEMENT)) & evidence.bare[:, None]
    bare = border[:, :, None] & border[:, None, :] & inside[:evidence.own].any(0)
    possible = ordered & ~outside & (any_paint | bare) & (width < LANES.max_lanes * NEUTRAL.widest_lane)
    base = scale * (through + hatched * w.hatched_lane + uncovered * w.off_asphalt)
    driven_there = inside.any(0)
    beside = np.where(UNPAINTED[made_left][..., None], c.beside[:, None, :, 0], c.beside[:, :, None, 1])
    aside = np.concatenate([beside[..., :BEYOND], np.zeros_like(beside[..., BEYOND:])], axis=-1)
    for number, beside_there in [(1, aside), *((number, beside) for number in range(1, LANES.max_lanes + 1))]:
        begin, width_each = lane_places(d_left, d_right, made_left, made_right, number, lane_width, beside_there)
        fits = _width_cost(np.where(loose, np.minimum(width_each, lane_width), width_each), lane_width, w) \
            + _unused(asphalt - number * lane_width, w.unused_asphalt[1]) * loose
        if number == 1:
            fits += w.driven_astride * (loose & (beside_there[..., BEYOND] >= 0))
        # what lies beyond the end of the surface
        beyond = np.clip(1 - width / np.maximum(number * width_each, 0.1), 0, 1) * (hidden & ~beside_bare)
        total = base + scale * (fits + beyond * w.off_asphalt)
        scanned = ~hidden | (width > LANES.min_scanned_share * number * lane_width)
        # only where somebody drove is a lane known to be wider than lanes are built: elsewhere nothing tells its place in the strip
        built = (width_each >= NEUTRAL.narrowest_lane) & ((width_each <= NEUTRAL.widest_lane) | driven_there | loose)
        if beside_there is aside:
            built &= loose & ~hidden & np.isnan(beside[..., BEYOND]) & (width - width_each > w.driven_sigma)
        total = np.where(possible & scanned & built & ((number == 1) | ~beside_bare), total, np.inf)
        for split in range(number + 1):
            kind = SECOND if split == 0 else FIRST if split == number else TWO_WAY[1 + int(np.sign(number - 2 * split))]
            if beside_there is aside:
                kind = FIRST_ASIDE if kind == FIRST else SECOND_ASIDE
            alike = max(split - 1, 0) + max(number - split - 1, 0)
            unpainted = (0 < split < number) * w.unpainted_divider + alike * w.unpainted_lane_line
            driven = total + scale * (unpainted + _driven_cost(evidence, inside, begin, width_each, number, split, first_direction, w)) \
                + _arrow_cost(arrows, width_each, number, split, first_direction, begin, w)
            if kind in TWO_WAY:
                driven += w.split_stop * _stops_across(at_stop, begin - split * width_each)
            better = driven < cost[kind]
            cost[kind][better], lanes[kind][better], first_lanes[kind][better] = driven[better], number, split
    return _StripCosts(cost, lanes, first_lanes, lane_width)


def _unused(asphalt, cost, enough=LANES.asphalt_of_a_lane[1]):
    """Nats of some metres of asphalt where no lane is."""
    return cost / (1 + np.exp(-(asphalt - enough) / LANES.asphalt_softness))


def _width_cost(width: np.ndarray, usual: float, w: EstimateWeights) -> np.ndarray:
    """Nats of a lane of some width, m, against one of the usual width: most lanes of a road are alike, some as on other roads, few are odd."""
    as_usual = np.exp(-0.5 * ((width - usual) / w.width_sigma) ** 2)
    as_elsewhere = np.exp(-0.5 * ((width - NEUTRAL.usual_lane) / LANES.other_sigma) ** 2)
    share = (1 - w.other_width - w.odd_width) * as_usual + w.other_width * as_elsewhere + w.odd_width
    return np.where((width >= NEUTRAL.narrowest_lane) & (width <= w.widest_odd), -np.log(share), np.inf)


def _passed_over(c, w):
    """(I, M, M) costs of the boundaries that lie between two others inside a lane; per observation."""
    lane = np.where(c.painted, w.lane_through_paint * _told(c),
                    np.select([np.isin(c.made_of, (CURB, ISLAND)), np.isin(c.made_of, (SURFACE, PAVEMENT)), c.made_of == HATCHING],
                              [w.lane_through_curb * c.seen, w.lane_through_surface, w.lane_through_hatching], 0.0))
    lane = lane * (c.valid & (c.made_of != OUTSIDE))
    total = np.cumsum(lane, axis=1)
    return np.maximum(total[:, None, :] - lane[:, None, :] - total[:, :, None], 0.0)


def _told(c):
    """(I, M) how surely boundaries are painted lines."""
    return c.trust * (0.5 + 0.5 * c.seen)


def _share_between(shares, c, width):
    """(I, M, M) share of the strip between two boundaries that is covered."""
    total = np.concatenate([np.zeros((len(shares), 1)), np.cumsum(shares, axis=1)], axis=1) * BIN

    def up_to(d):
        cells = np.clip((d + FAR) / BIN, 0, shares.shape[1] - 1e-6)
        k = cells.astype(int)
        row = np.arange(len(shares))[:, None]
        return total[row, k] + (cells - k) * (total[row, k + 1] - total[row, k])

    return np.clip(up_to(c.right)[:, :, None] - up_to(c.left)[:, None, :], 0, None) / np.maximum(width, 0.1)


def _inside(driven, c):
    """(P, I, M, M) whether a pass drove between two boundaries."""
    d = driven[:, :, None, None]
    with np.errstate(invalid="ignore"):
        return (d < c.right[None, :, :, None]) & (d >= c.left[None, :, None, :])


def _driven_cost(evidence, inside, d_left, each, number, split, first_direction, w):
    """Nats per observation of where and which way the vehicle drove in strips of `number` lanes, of which `split` are of the first direction."""
    cost = np.zeros(each.shape)
    for p, direction in enumerate(evidence.directions.tolist()):
        if not inside[p].any():
            continue
        with np.errstate(invalid="ignore", divide="ignore"):
            position = (d_left - evidence.driven[p][:, None, None]) / np.maximum(each, 0.1)
        lane = np.clip(np.floor(np.nan_to_num(position)), 0, number - 1)
        offset = (np.nan_to_num(position) - lane - 0.5) * each
        way = np.where(lane < split, first_direction, -first_direction)
        # beside the lanes of a strip other roads have theirs
        there = inside[p] if evidence.own is None or p < evidence.own else inside[p] & (position >= 0) & (position < number)
        cost += there * (np.minimum(0.5 * (offset / w.driven_sigma) ** 2, w.driven_astride) + np.where(way == -direction, w.driven_against, 0.0))
    return cost


def _arrows(c, arrows):
    """(I, M, M) number of arrows between two boundaries, and a list of (interval, offset, way, which boundaries it lies between)."""
    number = np.zeros((*c.left.shape, c.left.shape[1]))
    placed = []
    for interval, d, way in arrows:
        k = int(interval)
        inside = (d < c.right[k][:, None]) & (d > c.left[k][None, :])
        number[k] += inside
        placed.append((k, float(d), float(way), inside))
    return number, placed


def _arrow_cost(arrows, each, count, split, first_direction, d_left, w):
    """(I, M, M) nats of arrows beside the middle of their lanes, and of arrows that point against them."""
    cost = np.zeros(each.shape)
    for k, d, way, inside in arrows:
        position = (d_left[k] - d) / np.maximum(each[k], 0.1)
        lane = np.clip(np.floor(position), 0, count - 1)
        against = np.maximum(-way * np.where(lane < split, first_direction, -first_direction), 0.0) * ((position >= 0) & (position < count))
        cost[k] += inside * (np.minimum(0.5 * ((position - lane - 0.5) * each[k] / w.arrow_sigma) ** 2, w.arrow_outside) + against * w.arrow_against)
    return cost


def _at_stop(stops):
    """Those stop lines of Evidence that lie in the interval or right before or behind it."""
    return stops[np.abs(stops[:, 3]) <= EVIDENCE.stop_reach]


def _lanes_stopped(stops, left, right, lane_width):
    """(I, M, M) how much of a lane lies under stop lines, 1 at most, in the strips between `left` and `right`, m."""
    share = np.zeros(np.broadcast_shapes(left.shape, right.shape))
    for interval, low, high, _ in stops:
        k = int(interval)
        under = np.minimum(left[k], high - LANES.stop_margin) - np.maximum(right[k], low + LANES.stop_margin)
        share[k] = np.maximum(share[k], np.clip(under / lane_width, 0.0, 1.0))
    return share


def _stops_across(stops: np.ndarray, divider: np.ndarray) -> np.ndarray:
    """(I, ...) how many stop lines, as in Evidence, cross the border between the two directions, which lies at `divider`, (I, ...) m."""
    number = np.zeros(divider.shape)
    for interval, low, high, _ in stops:
        k = int(interval)
        number[k] += (divider[k] > low + LANES.stop_margin) & (divider[k] < high - LANES.stop_margin)
    return number


KEPT = 32   # derived: cross-sections of an interval that are kept

# What a boundary between two strips separates, -1 where the two cannot follow each other, and whether traffic is on the wrong side there
SEPARATES = np.full((len(STRIPS), len(STRIPS)), -1, np.int8)
for _left, _right, _what in (
        (REST_FIRST, REST_FIRST, OTHER_LINE), (REST_FIRST, FIRST, EDGE_LINE), (REST_FIRST, SECOND, EDGE_LINE),
        *((before, both, what) for both in TWO_WAY for before, what in ((REST_FIRST, EDGE_LINE), (FIRST, LANE_LINE))),
        *((both, after, what) for both in TWO_WAY for after, what in ((SECOND, LANE_LINE), (REST_SECOND, EDGE_LINE))),
        (FIRST, FIRST, LANE_LINE), (FIRST, SECOND, CENTRE_LINE), (FIRST, REST_FIRST, EDGE_LINE),
        (SECOND, SECOND, LANE_LINE), (SECOND, REST_SECOND, EDGE_LINE),
        (REST_SECOND, REST_SECOND, OTHER_LINE), (REST_SECOND, SECOND, EDGE_LINE), (REST_SECOND, FIRST, EDGE_LINE), (SECOND, FIRST, CENTRE_LINE)):
    SEPARATES[_left, _right] = _what
_WRONG_SIDE = {(REST_SECOND, FIRST), (SECOND, FIRST)}


@dataclass
class Sections(Rows):
    """The best cross-sections of each interval, the best one first."""

    cost: np.ndarray   # (I, K) nats; inf where there are fewer than K
    strip: np.ndarray   # (I, K, M) int8, kind of the strip to the right of each boundary, -1 where a boundary bounds nothing
    right: np.ndarray   # (I, K, M) int8, the boundary that the strip ends at
    lanes: np.ndarray   # (I, K, M) int8, how many lanes the strip holds, and how many of them are of the direction that is met first
    first_lanes: np.ndarray
    aside: np.ndarray   # (I, K, M) bool, whether its lane lies beside the border without paint

    def chosen(self, choice: np.ndarray) -> Sections:
        """One of each interval."""
        return self[np.arange(len(choice))[:, None], choice[:, None]]


@dataclass
class LaneStrips:
    """The strips of cross-sections that hold lanes."""

    interval: np.ndarray   # (S,) int, where they are and the boundaries they lie between
    section: np.ndarray
    left: np.ndarray
    right: np.ndarray
    aside: np.ndarray   # (S,) as of Sections
    number: np.ndarray   # (S,) lanes in them, and how many of these are of the direction that is met first
    first: np.ndarray


def lane_strips(sections: Sections) -> LaneStrips:
    """The LaneStrips of all cross-sections, in order of interval, cross-section and from left to right."""
    i, k, m = np.nonzero((sections.strip >= FIRST) & (sections.strip <= SECOND))
    right, number, first = (values[i, k, m].astype(int) for values in (sections.right, sections.lanes, sections.first_lanes))
    return LaneStrips(i, k, m, right, sections.aside[i, k, m], number, first)


def separated_kinds(sections: Sections) -> np.ndarray:
    """(I, K, M) what each boundary separates, LANE_LINE ... OTHER_LINE; -1 where it bounds nothing."""
    before = strips_before(sections)
    return np.where((sections.strip >= 0) & (before >= 0), SEPARATES[before, sections.strip], np.int8(-1))


def strips_before(sections: Sections) -> np.ndarray:
    """(I, K, M) the kind of the strip to the left of each boundary; -1 where it bounds nothing."""
    before = np.full(sections.strip.shape, -1, np.int8)
    i, k, m = np.nonzero(sections.strip >= 0)
    before[i, k, sections.right[i, k, m]] = sections.strip[i, k, m]
    return before


def best_sections(candidates: Candidates, costs: _StripCosts, stops: np.ndarray, first_direction: int, weights: EstimateWeights,
                  kept: int = KEPT) -> Sections:
    """The `kept` best cross-sections of each interval; `stops` are those of Evidence, `first_direction` is that of the lanes met first."""
    count, size = candidates.left.shape
    kinds = len(KINDS)
    between = _boundary_costs(candidates, stops, first_direction, weights)
    best = np.full((count, size, kinds, kept), np.inf)
    back = np.full((count, size, kinds, kept), -1, np.int32)
    # to the left of everything nobody drives
    best[:, 0, REST_FIRST, 0] = 0.0
    for j in range(1, size - 1):
        # what a boundary costs depends on the kinds of strips beside it: of each kind on its left the lowest ones are enough
        places, reach = (values.reshape(count, kinds, kept) for values in _lowest(_reach(best, costs, j).swapaxes(1, 2).reshape(-1, j, kept), kept))
        places += (kinds - 1) * kept * (places // kept) + kept * np.arange(kinds)[:, None]
        chosen, lowest = _lowest((reach[:, None] + between[:, j].swapaxes(1, 2)[..., None]).reshape(-1, kinds, kept), kept)
        best[:, j], chosen = lowest.reshape(count, kinds, kept), chosen.reshape(count, -1)
        back[:, j] = np.take_along_axis(places.reshape(count, -1), chosen, axis=1).reshape(count, kinds, kept)
        best[:, j][~candidates.valid[:, j]] = np.inf
    reach = _reach(best, costs, size - 1)
    reach[:, :, (KINDS >= FIRST) & (KINDS <= SECOND)] = np.inf
    return _traced(back, _lowest(reach, kept), costs)


def _reach(best, costs, j):
    """(I, j, 9, kept) nats up to boundary j with a strip of a kind that begins at an earlier boundary."""
    return best[:, :j] + costs.cost[:, :, :j, j].transpose(1, 2, 0)[..., None]


def _lowest(values, kept):
    """(I, kept) places, in the flattened rows, and values of the lowest of each of I rows; inf where there are fewer."""
    flat = values.reshape(len(values), -1)
    flat = np.pad(flat, ((0, 0), (0, max(kept - flat.shape[1], 0))), constant_values=np.inf)
    indices = np.argpartition(flat, kept - 1, axis=1)[:, :kept]
    lowest = np.take_along_axis(flat, indices, axis=1)
    order = np.argsort(lowest, axis=1, kind="stable")
    return np.take_along_axis(indices, order, axis=1), np.take_along_axis(lowest, order, axis=1)


def _boundary_costs(c, stops, first_direction, w):
    """(I, M, 9, 9) nats of a boundary between a strip on its left and one on its right."""
    scale = c.observations(w)[:, None]
    table = w.boundary[c.made_of]
    middle = (c.left + c.right) / 2
    half = NEUTRAL.narrowest_lane / 2
    stopped, on_left, on_right = (_stops_across(_at_stop(stops), middle + aside) for aside in (0.0, half, -half))
    # the lane on the outer side has a stop line, the one on the inner side has none
    outer_alone = {FIRST: (on_left > 0) & (on_right == 0), SECOND: (on_right > 0) & (on_left == 0)}
    wide = np.nan_to_num(c.wide)[..., None]
    table = np.where(wide > 0, (1 - wide) * table + wide * w.wide_line[c.made_of.clip(SOLID, DASHED)], table)
    solid = (c.made_of == SOLID)[..., None]
    before = {kind: np.where(solid & (_stops_across(stops[way * stops[:, 3] > -EVIDENCE.stop_reach], middle) > 0)[..., None],
                             np.minimum(table, w.solid_at_stop), table) for kind, way in ((FIRST, first_direction), (SECOND, -first_direction))}
    cost = np.full((*c.left.shape, len(STRIPS), len(STRIPS)), np.inf)
    for left in STRIPS:
        for right in STRIPS:
            use = SEPARATES[left, right]
            if use >= 0:
                misnamed = w.named * ((c.named >= 0) & (c.named != use) & (use != OTHER_LINE))
                wrong = w.wrong_side if (left, right) in _WRONG_SIDE else 0.0
                as_drawn = before[left] if {left, right} <= {FIRST, SECOND} else table
                cost[:, :, left, right] = scale * (as_drawn[:, :, use] + wrong + misnamed) \
                    + w.split_stop * stopped * (use == CENTRE_LINE) + w.outer_stopped * outer_alone.get(left, 0.0) * (left == right)
    # other lines may be none, and what else lies where nobody drives bounds nothing
    cost[:, :, REST_FIRST, REST_FIRST] = cost[:, :, REST_SECOND, REST_SECOND] = scale * np.where(
        c.painted, np.minimum(table[:, :, OTHER_LINE], w.paint_in_rest * _told(c)), 0.0)
    return cost[:, :, KINDS][..., KINDS]


def _traced(back, ends, costs):
    """Sections from the ends of the chains: `back` tells from where each chain came."""
    count, size, kinds, kept = back.shape
    chosen, value = ends
    strip, right, lanes, first_lanes = np.full((4, *chosen.shape, size), -1, np.int8)
    aside = np.zeros(strip.shape, bool)
    row = np.arange(count)[:, None]
    end_boundary, pointer = np.full(chosen.shape, size - 1), np.where(np.isfinite(value), chosen, -1)
    while (alive := pointer >= 0).any():
        boundary, remainder = np.divmod(pointer, kinds * kept)
        kind, rank = np.divmod(remainder, kept)
        r, k = np.nonzero(alive)
        strip[r, k, boundary[alive]], aside[r, k, boundary[alive]] = KINDS[kind[alive]], kind[alive] >= len(STRIPS)
        right[r, k, boundary[alive]] = end_boundary[alive]
        for values, of_strip in ((lanes, costs.lanes), (first_lanes, costs.first_lanes)):
            values[r, k, boundary[alive]] = of_strip[kind[alive], r, boundary[alive], end_boundary[alive]]
        end_boundary = np.where(alive, boundary, end_boundary)
        pointer = np.where(alive & (boundary > 0), back[row, boundary.clip(0), kind, rank], -1)
    return Sections(value, strip, right, lanes, first_lanes, aside)


# The most probable sequence of cross-sections along a road, and how sure each is.

PLACE = 0.5   # derived: m across at which cross-sections are compared
INTERVALS_AT_ONCE = 32   # derived: of which cross-sections are compared with each other


def transitions(candidates: Candidates, sections: Sections, known: np.ndarray, lane_width: float, left: np.ndarray,
                weights: EstimateWeights) -> np.ndarray:
    """(N - 1, K, K) nats of going from each cross-section of an interval to each of the next of those of which something is known.

    known : (N,) int, intervals, ascending, of the candidates and sections of all intervals
    lane_width : m, usual
    left : (2, N - 1) of what was known of lanes, and of directions, what is left after the way to the next one, 0 to 1
    """
    kept = sections.cost.shape[1]
    result = np.empty((max(len(known) - 1, 0), kept, kept))
    # what is compared is larger than the costs
    for first in range(0, len(result), INTERVALS_AT_ONCE):
        check_cancelled()
        intervals = known[first:first + INTERVALS_AT_ONCE + 1]
        window = slice(first, first + len(intervals) - 1)
        # over a gap they do not meet
        before, behind = (_occupancy(candidates[of].at_end(end, np.diff(intervals) == 1), sections[of], lane_width) for of, end in (
            (intervals[:-1], 1), (intervals[1:], 0)))
        changed, turned = _transition_costs(before, behind, weights)
        lanes, directions = (share[window, None, None] for share in left)
        # a lane that leads the other way behind a gap has turned, or it is another one that begins where the first ended
        with np.errstate(divide="ignore"):
            other = np.log(1 - directions) - turned * (2 * weights.change / weights.turn)
            result[window] = changed * lanes - np.logaddexp(np.log(directions) - turned, other)
    return result


def _occupancy(candidates: Candidates, sections: Sections, lane_width: float) -> tuple[np.ndarray, np.ndarray]:
    """Where lanes of the first and of the second direction lie, (2, I, K, B) bool, and borders between two lanes, (I, K, B) bool."""
    count, kept, size = sections.strip.shape
    bins = int(2 * FAR / PLACE)
    area, divider = np.zeros((2, count, kept, bins + 1)), np.zeros((count, kept, bins), bool)
    strips = lane_strips(sections)
    i, k, m, end, number = strips.interval, strips.section, strips.left, strips.right, strips.number
    d_left, width_each = lane_places(candidates.right[i, m], candidates.left[i, end], candidates.made_of[i, m], candidates.made_of[i, end], number,
                                     lane_width, beside_of(candidates, strips))
    d_right = d_left - number * width_each
    split = d_left - width_each * strips.first
    for direction, (high, low) in enumerate(((d_left, split), (split, d_right))):
        rows = high - low > 1e-6
        a, b = (np.clip(np.rint((v[rows] + FAR) / PLACE).astype(int), 0, bins) for v in (low, high))
        np.add.at(area[direction], (i[rows], k[rows], a), 1.0)
        np.add.at(area[direction], (i[rows], k[rows], b), -1.0)
    area = np.cumsum(area, axis=-1)[..., :-1]
    for inner in range(1, int(number.max(initial=1))):
        rows = number > inner
        d = d_left[rows] - width_each[rows] * inner
        divider[i[rows], k[rows], np.clip(np.rint((d + FAR) / PLACE).astype(int), 0, bins - 1)] = True
    # painted borders with a lane on both sides
    lane = (sections.strip >= FIRST) & (sections.strip <= SECOND)
    ends = np.zeros(sections.strip.shape, bool)
    ends[i, k, end] = True
    i, k, m = np.nonzero(lane & ends)
    d = (candidates.left[i, m] + candidates.right[i, m]) / 2
    divider[i, k, np.clip(np.rint((d + FAR) / PLACE).astype(int), 0, bins - 1)] = True
    return area, divider


def _transition_costs(before, behind, weights):
    """Nats of going from a cross-section to one of the next interval: of lanes that begin, end or divide, and of those that change direction.

    `before`, `behind` : the one and the other as of `_occupancy`, where the intervals meet
    """
    change, turn = weights.change * PLACE, weights.turn * PLACE
    (ahead, back, lane, marks, wide), (ahead_behind, back_behind, lane_behind, marks_behind, wide_behind) = map(_compared, (before, behind))

    def product(a, b):
        return a @ b.swapaxes(1, 2)   # of whole numbers, which are the same in any order

    inner, inner_behind = _core(lane), _core(lane_behind)
    differs = inner.sum(-1)[:, :, None] + inner_behind.sum(-1)[:, None, :] - product(inner, lane_behind) - product(lane, inner_behind)
    turned = product(_core(ahead), back_behind) + product(_core(back), ahead_behind)
    lost = marks.sum(-1)[:, :, None] + marks_behind.sum(-1)[:, None, :] - product(marks, wide_behind) - product(wide, marks_behind)
    return change * differs + weights.divider_change * np.clip(lost, 0, None), turn * turned


def _compared(occupancy):
    """Lanes of either direction, both together, borders between lanes, and these with the places where they are the same."""
    (first, second), divider = occupancy[0].astype(np.float32), occupancy[1]
    wide = np.zeros(divider.shape, np.float32)
    for shift in range(-LANES.same_divider, LANES.same_divider + 1):
        wide = np.maximum(wide, np.roll(divider, shift, axis=-1))
    return first, second, first + second, divider.astype(np.float32), wide


def _core(values):
    """Borders that move by a place across are no change."""
    return np.minimum(np.minimum(np.roll(values, 1, -1), np.roll(values, -1, -1)), values)


def ways(cost: np.ndarray, transition: np.ndarray, joined: Callable[..., np.ndarray]) -> np.ndarray:
    """(2, ..., I, K) nats of the ways up to each cross-section and with it, and on from it.

    cost : (..., I, K) nats, inf where there is no cross-section; transition : (I - 1, K, K) nats
    joined : makes one of several ways, given them and an axis: np.min the most probable one
    """
    forward, backward = both = np.stack([cost, np.zeros(cost.shape)])
    for i in range(1, cost.shape[-2]):
        forward[..., i, :] += joined(forward[..., i - 1, :, None] + transition[i - 1], -2)
    for i in range(cost.shape[-2] - 1, 0, -1):
        backward[..., i - 1, :] = joined(transition[i - 1] + (cost[..., i, :] + backward[..., i, :])[..., None, :], -1)
    return both


def _sum_of(nats, axis):
    """Nats of all of several ways together."""
    least = nats.min(axis, keepdims=True)
    least[~np.isfinite(least)] = 0.0
    with np.errstate(divide="ignore"):
        return least.squeeze(axis) - np.log(np.exp(least - nats).sum(axis))


def best_sequence(forward: np.ndarray, transition: np.ndarray) -> tuple[np.ndarray, float]:
    """The most probable sequence (Viterbi): the (I,) cross-section of each interval, and nats of the whole; `forward` : the first of `ways`."""
    choice = np.full(len(forward), np.argmin(forward[-1]))
    for i in range(len(forward) - 1, 0, -1):
        choice[i - 1] = np.argmin(forward[i - 1] + transition[i - 1][:, choice[i]])
    return choice, float(forward[-1].min())


def probabilities(cost: np.ndarray, transition: np.ndarray) -> np.ndarray:
    """(..., I, K) how probable each cross-section is among all sequences (forward-backward); parameters as of `ways`."""
    return softmax(-ways(cost, transition, _sum_of).sum(axis=0), axis=-1)


def behind_best(cost: np.ndarray, transition: np.ndarray, least: np.ndarray, best: tuple[np.ndarray, float], length: np.ndarray,
                repeats: float) -> np.ndarray:
    """(I, K) nats by which the most probable sequence through each cross-section is behind the most probable one of all; inf where there is none.

    Where the two differ over a longer way than `repeats`, m, they differ in how the whole road is laid out. What is seen there again and again was
    laid out and driven once, so it counts as on a way of that length.

    cost, transition : as of `ways`, of which `least` are the most probable; best : as of `best_sequence`; length : (I,) m of each interval
    """
    all_along = min(1.0, repeats / max(float(length.sum()), 1e-9))
    # the most probable one may differ for metres, where one that differs all along the road is more probable by what counts
    either = [_sequences_through(cost, transition, share, of)
              for share, of in ((1.0, least), (all_along, ways(all_along * cost, transition, np.min)))]
    results = [_behind(through, *best, length, repeats) for through in either]
    # what such a one has besides on a short way is seen there alone, and does not count less for the rest of the road
    nats, came, goes_on = either[1]
    apart = np.where(results[1][1] > 0, results[1][0], np.inf)
    i, k = np.unravel_index(apart.argmin(), apart.shape)
    if np.isfinite(apart[i, k]):
        choice = np.full(len(cost), k)
        for at in range(i, 0, -1):
            choice[at - 1] = came[at - 1, choice[at]]
        for at in range(i, len(cost) - 1):
            choice[at + 1] = goes_on[at, choice[at]]
        besides = [_behind(through, choice, nats[i, k], length, repeats) for through in either]
        results = [(np.where(over < metres, np.maximum(behind, apart[i, k] + more), behind), metres)
                   for (behind, metres), (more, over) in zip(results, besides)]
    return np.minimum(results[0][0], results[1][0])


def _sequences_through(cost, transition, share, least):
    """(I, K) nats of sequences through each cross-section, the `least` ones with a share of its cost, and (I - 1, K) which come before and after."""
    forward, backward = least
    nats, on, columns = cost.copy(), np.zeros(cost.shape), np.arange(cost.shape[1])
    came, goes_on = np.zeros((2, max(len(cost) - 1, 0), cost.shape[1]), int)
    for i in range(1, len(cost)):
        came[i - 1] = (forward[i - 1][:, None] + transition[i - 1]).argmin(0)
        nats[i] += nats[i - 1][came[i - 1]] + transition[i - 1][came[i - 1], columns]
    for i in range(len(cost) - 1, 0, -1):
        goes_on[i - 1] = (transition[i - 1] + (share * cost[i] + backward[i])[None, :]).argmin(1)
        on[i - 1] = transition[i - 1][columns, goes_on[i - 1]] + (cost[i] + on[i])[goes_on[i - 1]]
    return nats + on, came, goes_on


def _behind(through, choice, total, length, repeats):
    """(I, K) nats that count, by which such sequences are behind another one of `total` nats, and metres for which they are apart from it."""
    nats, came, goes_on = through
    apart = np.repeat(length[:, None].astype(float), nats.shape[1], axis=1)
    apart[np.arange(len(choice)), choice] = 0.0
    before, after = apart.copy(), apart.copy()   # up to a cross-section and from it on
    for i in range(1, len(nats)):
        before[i] = np.where(apart[i] > 0, before[i] + before[i - 1][came[i - 1]], 0.0)
    for i in range(len(nats) - 1, 0, -1):
        after[i - 1] = np.where(apart[i - 1] > 0, after[i - 1] + after[i][goes_on[i - 1]], 0.0)
    metres = before + after - apart
    return (nats - total) * np.minimum(1.0, repeats / np.maximum(metres, 1e-9)), metres
