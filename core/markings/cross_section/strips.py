"""What it costs to take the strip between two boundaries for a lane, for several lanes, or for what nobody drives on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...countries.neutral import NEUTRAL
from .candidates import FAR, Candidates
from .evidence import BIN, Evidence
from .lane_width import beside_surface_end, lane_places
from .weights import CURB, HATCHING, ISLAND, OUTSIDE, PAVEMENT, SURFACE, EstimateWeights

# Strips from left to right: what nobody drives on, lanes of the direction that is met first, lanes of both directions without
# paint between them, most of them of the first direction, as many of either, or most of the other, lanes of the other direction,
# and again what nobody drives on
REST_FIRST, FIRST, MOST_FIRST, BOTH, MOST_SECOND, SECOND, REST_SECOND = STRIPS = range(7)
TWO_WAY = MOST_FIRST, BOTH, MOST_SECOND
MAX_LANES = 4              # between two boundaries without paint between them
HATCHED_SHARE = 0.12       # of a strip that is covered by hatching: its bars leave most of it free
ASPHALT_OF_A_LANE = 2.2, 3.0   # m of asphalt that could be a lane: between two lines, and elsewhere
ASPHALT_SOFTNESS = 0.2     # m by which that is uncertain
OTHER_SIGMA = 0.8          # m, scatter of lane widths from road to road
STOP_MARGIN = 0.5          # m by which a stop line may reach beyond the lanes that it is for
MIN_SCANNED_SHARE = 0.6    # of a lane's width that must be seen of a lane beside the end of the surface


@dataclass
class StripCosts:
    """Costs of all strips.

    cost : (7, I, M, M) nats, of a strip of one kind between two boundaries; inf where it cannot be
    lanes, first_lanes : (7, I, M, M) int8, how many lanes it holds at that cost, and how many of them are of the direction that is met first
    lane_width : metres, the usual width of a lane; beside a curb or the end of the surface no lane is wider
    """

    cost: np.ndarray
    lanes: np.ndarray
    first_lanes: np.ndarray
    lane_width: float


def strip_costs(candidates: Candidates, evidence: Evidence, weights: EstimateWeights, lane_width: float, first_direction: int) -> StripCosts:
    """Costs of all strips, the lanes of `first_direction` (1 or -1) being met first from the left."""
    c, w = candidates, weights
    count, size = c.left.shape
    scale = c.observations(w)[:, None, None]
    d_left, d_right = c.right[:, :, None], c.left[:, None, :]
    width = d_left - d_right
    ordered = c.valid[:, :, None] & c.valid[:, None, :] & (np.arange(size)[:, None] < np.arange(size))
    outside = (c.made_of == OUTSIDE)[:, :, None] | (c.made_of == OUTSIDE)[:, None, :]
    through, rest = _passed_over(c, w)
    hatched = _share_between(evidence.hatched, c, width) > HATCHED_SHARE if evidence.hatched is not None else np.zeros(width.shape, bool)
    paint = c.painted | (c.made_of == HATCHING)
    both_paint, any_paint = paint[:, :, None] & paint[:, None, :], paint[:, :, None] | paint[:, None, :]
    asphalt = width * _share_between(evidence.asphalt, c, width) if evidence.asphalt is not None else np.where(both_paint, width, 0.0)
    arrows_in, arrows = _arrows(c, evidence.arrows)

    cost = np.full((len(STRIPS), count, size, size), np.inf)
    lanes, first_lanes = np.zeros((2, len(STRIPS), count, size, size), np.int8)
    between = np.where(width > NEUTRAL.widest_lane, w.unused_wide, w.unused_asphalt[0])
    # beyond short dashes the bay that they open, however it is bounded
    opened = np.nan_to_num(c.short) > 0.5
    lined = both_paint & ~(opened[:, :, None] | opened[:, None, :])
    unused = np.where(lined, _unused(asphalt, between, ASPHALT_OF_A_LANE[0]), _unused(asphalt, w.unused_asphalt[1]))
    inside = _inside(evidence.driven, c)
    idle = scale * (np.where(hatched, 0.0, unused) + rest) + arrows_in * w.arrow_outside + scale * w.driven_rest * inside.sum(0)
    cost[REST_FIRST] = cost[REST_SECOND] = np.where(ordered, idle, np.inf)

    made_left, made_right = c.made_of[:, :, None], c.made_of[:, None, :]
    # strips with paint on one side only, and of those the ones whose other side may be hidden
    loose = any_paint & ~both_paint
    hidden = loose & beside_surface_end(made_left, made_right)
    off = np.clip(1 - asphalt / np.maximum(width, 0.1), 0, 1) if evidence.asphalt is not None else 0.0
    possible = ordered & ~outside & any_paint & (width < MAX_LANES * NEUTRAL.widest_lane)
    base = scale * (through + hatched * w.hatched_lane + off * w.off_asphalt)
    driven_there = inside.any(0)
    for number in range(1, MAX_LANES + 1):
        begin, each = lane_places(d_left, d_right, made_left, made_right, number, lane_width, c.bend[:, None, None])
        fits = width_cost(each, lane_width, w) + _unused(asphalt - number * lane_width, w.unused_asphalt[1]) * loose
        # what lies beyond the end of the surface
        beyond = np.clip(1 - width / np.maximum(number * each, 0.1), 0, 1) * hidden
        total = base + scale * (fits + beyond * w.off_asphalt)
        scanned = ~hidden | (width > MIN_SCANNED_SHARE * number * lane_width)
        # only where somebody drove is a lane known to be wider than lanes are built: elsewhere nothing tells its place in the strip
        built = (each >= NEUTRAL.narrowest_lane) & ((each <= NEUTRAL.widest_lane) | driven_there)
        total = np.where(possible & scanned & built, total, np.inf)
        for split in range(number + 1):
            kind = SECOND if split == 0 else FIRST if split == number else TWO_WAY[1 + int(np.sign(number - 2 * split))]
            alike = max(split - 1, 0) + max(number - split - 1, 0)
            unpainted = (0 < split < number) * w.unpainted_divider + alike * w.unpainted_lane_line
            driven = total + scale * (unpainted + _driven_cost(evidence, inside, begin, each, number, split, first_direction, w)) \
                + _arrow_cost(arrows, each, number, split, first_direction, begin, w)
            if kind in TWO_WAY:
                driven += w.split_stop * stops_across(evidence.stops, begin - split * each)
            better = driven < cost[kind]
            cost[kind][better], lanes[kind][better], first_lanes[kind][better] = driven[better], number, split
    return StripCosts(cost, lanes, first_lanes, lane_width)


def _unused(asphalt, cost, enough=ASPHALT_OF_A_LANE[1]):
    """Nats of some metres of asphalt where no lane is."""
    return cost / (1 + np.exp(-(asphalt - enough) / ASPHALT_SOFTNESS))


def width_cost(width: np.ndarray, usual: float, w: EstimateWeights) -> np.ndarray:
    """Nats of a lane of some width, m, against one of the usual width: most lanes of a road are alike, some as on other roads, few are odd."""
    own = np.exp(-0.5 * ((width - usual) / w.width_sigma) ** 2)
    other = np.exp(-0.5 * ((width - NEUTRAL.usual_lane) / OTHER_SIGMA) ** 2)
    share = (1 - w.other_width - w.odd_width) * own + w.other_width * other + w.odd_width
    return np.where((width >= NEUTRAL.narrowest_lane) & (width <= w.widest_odd), -np.log(share), np.inf)


def _passed_over(c, w):
    """(I, M, M) costs of the boundaries that lie between two others, inside a lane and where nobody drives; per observation."""
    paint = c.painted
    there = c.valid & (c.made_of != OUTSIDE)
    shown = 0.5 + 0.5 * c.seen
    lane = np.where(paint, w.lane_through_paint * c.trust * shown,
                    np.select([np.isin(c.made_of, (CURB, ISLAND)), np.isin(c.made_of, (SURFACE, PAVEMENT)), c.made_of == HATCHING],
                              [w.lane_through_curb * c.seen, w.lane_through_surface, w.lane_through_hatching], 0.0)) * there
    rest = np.where(paint, w.paint_in_rest * c.trust * shown, 0.0) * there
    found = []
    for values in (lane, rest):
        total = np.cumsum(values, axis=1)
        found.append(np.maximum(total[:, None, :] - values[:, None, :] - total[:, :, None], 0.0))
    return found


def _share_between(shares, c, width):
    """(I, M, M) share of the strip between two boundaries that is covered."""
    total = np.concatenate([np.zeros((len(shares), 1)), np.cumsum(shares, axis=1)], axis=1) * BIN

    def up_to(d):
        at = np.clip((d + FAR) / BIN, 0, shares.shape[1] - 1e-6)
        k = at.astype(int)
        row = np.arange(len(shares))[:, None]
        return total[row, k] + (at - k) * (total[row, k + 1] - total[row, k])

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
            place = (d_left - evidence.driven[p][:, None, None]) / np.maximum(each, 0.1)
        lane = np.clip(np.floor(np.nan_to_num(place)), 0, number - 1)
        off = (np.nan_to_num(place) - lane - 0.5) * each
        way = np.where(lane < split, first_direction, -first_direction)
        cost += inside[p] * (np.minimum(0.5 * (off / w.driven_sigma) ** 2, w.driven_astride) + np.where(way == -direction, w.driven_against, 0.0))
    return cost


def _arrows(c, arrows):
    """(I, M, M) number of arrows between two boundaries, and a list of (interval, offset, way, which boundaries it lies between)."""
    number = np.zeros((*c.left.shape, c.left.shape[1]))
    found = []
    for interval, d, way in arrows:
        k = int(interval)
        inside = (d < c.right[k][:, None]) & (d > c.left[k][None, :])
        number[k] += inside
        found.append((k, float(d), float(way), inside))
    return number, found


def _arrow_cost(arrows, each, count, split, first_direction, d_left, w):
    """(I, M, M) nats of arrows beside the middle of their lanes, and of arrows that point against them."""
    cost = np.zeros(each.shape)
    for k, d, way, inside in arrows:
        place = (d_left[k] - d) / np.maximum(each[k], 0.1)
        lane = np.clip(np.floor(place), 0, count - 1)
        against = np.maximum(-way * np.where(lane < split, first_direction, -first_direction), 0.0)
        cost[k] += inside * (np.minimum(0.5 * ((place - lane - 0.5) * each[k] / w.arrow_sigma) ** 2, w.arrow_outside) + against * w.arrow_against)
    return cost


def stops_across(stops: np.ndarray, divider: np.ndarray) -> np.ndarray:
    """(I, ...) how many stop lines, as in Evidence, cross the border between the two directions, which lies at `divider`, (I, ...) m."""
    number = np.zeros(divider.shape)
    for interval, low, high in stops:
        k = int(interval)
        number[k] += (divider[k] > low + STOP_MARGIN) & (divider[k] < high - STOP_MARGIN)
    return number
