"""One estimate of the lines and lanes of a road: the most probable sequence of cross-sections."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...common.parallel import check_cancelled
from .candidates import Candidates
from .evidence import Evidence
from .sequence import (
    FIRST,
    INTERVALS_AT_ONCE,
    SECOND,
    UNPAINTED,
    Sections,
    behind_best,
    beside_surface_end,
    best_sections,
    best_sequence,
    best_through,
    lane_places,
    lane_strips,
    misnamed_costs,
    probabilities,
    separated_kinds,
    strip_costs,
    transitions,
    width_cost,
)
from .weights import CENTRE_LINE, DASHED, LANE_LINE, SAME_LANE, EstimateWeights, Reading

FARTHEST_BEHIND = 30.0   # derived: nats at most by which one direction is less probable than the other
INTERVALS_OF_STRETCH = 256   # derived: intervals that are looked at together, 1 to 2 km of road: what they are chosen from takes 0.2 MB for each


@dataclass
class RoadEstimate:
    """The cross-sections of one road for one side of traffic.

    sureness : (I, K) the same as far as it was seen here, where what is laid out alike along the road counts once, and so do the same lanes
    once : (I, K) nats of the most probable sequence through each as far as it was seen here, as `sureness` counts that; inf where nothing is known
    second : (I, K) by how many nats the most probable sequence through each is behind the best one, without names, see `behind_best`; inf where
        nothing is known
    other, behind : the estimate for the other side of traffic where either may be, else None, and by how many nats it is less probable
    """

    candidates: Candidates
    lane_width: float   # metres, the usual width of a lane
    sections: Sections
    choice: np.ndarray   # (I,) which of them
    posterior: np.ndarray   # (I, K) how probable each is
    sureness: np.ndarray
    total: float   # nats of them
    first_direction: int   # of the lanes met first from the left
    evidence: Evidence   # that it is made from
    weights: EstimateWeights
    unnamed: np.ndarray   # (I,) which cross-sections would have been chosen without the names of the lines; -1 where these decide
    unnamed_total: float   # nats of them
    once: np.ndarray
    second: np.ndarray
    other: RoadEstimate | None = None
    behind: float = 0.0
    opposite: RoadEstimate | None = None   # the same as far as it is a second reading, in nats as of `second`
    opposite_behind: float = 0.0

    @property
    def once_total(self) -> float:
        """Nats of the most probable sequence as far as it was seen here."""
        known = self.once[np.isfinite(self.once)]
        return float(known.min()) if len(known) else 0.0


def estimate_road(candidates: Candidates, evidence: Evidence, first_direction: int, lane_width: float,
                  weights: EstimateWeights = EstimateWeights()) -> RoadEstimate:
    """The most probable sequence of cross-sections of one road.

    `first_direction` : 1 or -1, of the lanes that are met first from the left: -1 with traffic on the right; `lane_width` : m, the usual one.
    """
    sections = _best_sections(candidates, evidence, weights, lane_width, first_direction)
    # where no line is seen, as on a crossing, much may change; where no line is known nothing can be said
    paint = candidates.painted
    shown = (paint * candidates.seen).sum(1) / np.maximum(paint.sum(1), 1)
    choice, (posterior, sureness) = np.argmin(sections.cost, axis=1), np.zeros((2, *sections.cost.shape))
    known, total, unnamed_total = np.flatnonzero(paint.any(1)), 0.0, 0.0
    # what named the lines is the same evidence
    cost = sections.cost - _by_stretch(lambda part: misnamed_costs(candidates.take(part), sections.take(part), weights), len(sections.cost))
    unnamed, (once, second) = np.argmin(cost, axis=1), np.full((2, *cost.shape), np.inf)
    if len(known):
        between = np.r_[0.0, np.cumsum(candidates.length)]
        gap = between[known[1:]] - between[known[:-1] + 1]
        both = np.minimum(shown[known[:-1]], shown[known[1:]])
        left = [both * np.exp(-gap / remembered) for remembered in (weights.lanes_remembered, weights.directions_remembered)]
        transition = transitions(candidates, sections, known, lane_width, left, weights)
        choice[known], total = best_sequence(sections.cost[known], transition)
        posterior[known] = probabilities(sections.cost[known], transition)
        unnamed[known], unnamed_total = best_sequence(cost[known], transition)
        second[known] = behind_best(cost[known], transition, candidates.length[known], weights.repeats)
        seen_once = _seen_once(candidates, sections, cost, weights)[known]
        sureness[known], once[known] = probabilities(seen_once, transition), best_through(seen_once, transition)
    return RoadEstimate(candidates, lane_width, sections, choice, posterior, sureness, total, first_direction, evidence, weights, unnamed,
                        unnamed_total, once, second)


def _stretches(count):
    """Intervals by stretches of road, of which so many are looked at together."""
    return [slice(first, min(first + INTERVALS_OF_STRETCH, count)) for first in range(0, count, INTERVALS_OF_STRETCH)]


def _by_stretch(function, count):
    return np.concatenate([function(part) for part in _stretches(count)])


def _best_sections(candidates, evidence, weights, lane_width, first_direction):
    """Sections of all intervals; their costs are worked out stretch by stretch, for they are many times as large."""
    found = []
    for part in _stretches(len(candidates.first)):
        check_cancelled()
        own, seen = candidates.take(part), evidence.part(part.start, part.stop)
        sections = best_sections(own, strip_costs(own, seen, weights, lane_width, first_direction), seen.stops, weights)
        sections.cost += _roads_of_many_lanes(own, sections, seen.divided, weights)
        found.append(sections)
    joined = Sections.joined(found)
    _hold_to_taken(candidates, evidence, joined, lane_width, first_direction, weights)
    return joined


def _hold_to_taken(candidates, evidence, sections, lane_width, first_direction, weights):
    """Make cross-sections improbable, in place, that have not the lanes that an analyst took."""
    for interval, former, wanted in evidence.taken:
        own = lane_strips(sections.take(slice(interval, interval + 1)))
        lanes = _lanes(candidates, lane_width, first_direction, replace(own, interval=own.interval + interval))
        there = np.abs(lanes.d - former) < SAME_LANE
        for d, width, _ in wanted:
            there |= np.abs(lanes.d - d) < width / 2
        kept = np.arange(sections.cost.shape[1])
        fits = np.bincount(lanes.section[there], minlength=len(kept)) == len(wanted)
        for d, _, way in wanted:
            fits &= np.isin(kept, lanes.section[(np.abs(lanes.d - d) < 2 * SAME_LANE) & (lanes.way == way)])
        sections.cost[interval] += np.where(fits, 0.0, weights.not_taken)


def _seen_once(c, sections, cost, weights):
    """(I, K) nats that tell how sure a cross-section is, from the costs without names: what is laid out alike along the road was seen once."""
    cost = cost / (np.clip(c.length.sum(), weights.correlation, weights.laid_out) / weights.correlation)
    return np.where(_by_stretch(lambda part: _told_before(sections.take(part), cost[part]), len(cost)), np.inf, cost)


def _told_before(sections, cost):
    """(I, K) bool, whether a cheaper cross-section of the interval has the same lanes: what bounds strips where nobody drives is no other reading."""
    check_cancelled()
    lane = (sections.strip >= FIRST) & (sections.strip <= SECOND)
    lanes = np.where(lane, sections.strip.astype(np.int16) * lane.shape[2] + sections.right, -1)
    order = np.arange(cost.shape[1])
    before, told = order < order[:, None], np.empty(cost.shape, bool)
    # every cross-section is compared with every other one
    for first in range(0, len(cost), INTERVALS_AT_ONCE):
        some = slice(first, first + INTERVALS_AT_ONCE)
        own, strips = cost[some], lanes[some]
        same = (strips[:, :, None] == strips[:, None]).all(-1)
        cheaper = (own[:, None] < own[:, :, None]) | (own[:, None] == own[:, :, None]) & before
        told[some] = (same & cheaper & np.isfinite(own)[:, None]).any(2)
    return told


def _roads_of_many_lanes(c, sections, divided, weights):
    """(I, K) nats of how many lanes lead which way."""
    strips = lane_strips(sections)
    total, ahead = np.zeros((2, *sections.cost.shape))
    for values, numbers in ((total, strips.number), (ahead, strips.first)):
        np.add.at(values, (strips.interval, strips.section), numbers)
    # a lane beyond a wide line is one more, for buses, cycles or an exit
    kinds = separated_kinds(sections)
    special = np.where(kinds == LANE_LINE, np.nan_to_num(c.wide)[:, None], 0.0) > 0.5
    total, ahead = total - special.sum(2), ahead - (special & (sections.strip == FIRST)).sum(2)
    one_way = (total > 0) & ((ahead == 0) | (ahead == total))
    cost = np.where(one_way, np.array(weights.one_way)[np.clip(total, 1, len(weights.one_way)).astype(int) - 1], 0.0)
    cost = np.where(~one_way & (np.abs(2 * ahead - total) > 1), weights.uneven, cost)
    cost = np.where(~one_way & (total == 3), weights.two_and_one, cost)
    cost = np.where(divided[:, None], np.where(one_way | (total == 0), 0.0, weights.two_way_carriageway), cost)
    # where there are more than two lanes, dashes do not part the directions
    kind_right = np.where(sections.right >= 0, np.take_along_axis(sections.strip, np.maximum(sections.right, 0), axis=2), -1)
    parts = (sections.strip == FIRST) & (kind_right == SECOND)
    drawn = np.take_along_axis(np.broadcast_to(c.made_of[:, None, :], sections.strip.shape), np.maximum(sections.right, 0), axis=2)
    cost = cost + np.where((total > 2) & (parts & (drawn == DASHED)).any(2), weights.dashed_between_many, 0.0)
    return cost * c.observations(weights)[:, None]


@dataclass
class LaneSpan:
    """One lane over one interval.

    direction : 1 or -1, of the most probable sequence; where that is the less probable one of a lane there, the other, unless names of lines decided
        that, or the drive
    second : Reading, the most probable one of those without such a lane in that direction there; None where that is not known
    """

    interval: int   # number
    left: int   # rows of Boundaries
    right: int
    place: int   # from the right, of `count` lanes between them
    count: int
    direction: int
    probability: float   # 0 to 1, of a lane of either direction there, with the posterior of RoadEstimate
    confidence: float   # 0 to 1, of a lane of either direction there, with the sureness of RoadEstimate
    directed: float   # 0 to 1, of those of this direction among them, on both sides of traffic where the survey leaves that open
    left_border: int   # what the two separate, LANE_LINE ... OTHER_LINE
    right_border: int
    second: Reading | None = None


def lane_spans(estimate: RoadEstimate) -> list[LaneSpan]:
    """The lanes of the best sequence, interval by interval, from left to right."""
    return [span for part in _stretches(len(estimate.choice)) for span in _lane_spans(estimate, part)]


def _lane_spans(estimate, part):
    """Those of some intervals."""
    check_cancelled()
    found = []
    c, strips = estimate.candidates, _strips_of(estimate, part)
    borders = _uses(estimate.sections.take(part), estimate.choice[part])
    best = np.flatnonzero(strips.section == estimate.choice[strips.interval])
    lanes = _lanes_of(estimate, strips)
    own, shares = _place_shares(estimate, lanes, best, part)
    way = np.where(shares[:, 3] > 0, -lanes.way[own], lanes.way[own])
    seconds = [min((one for one in both if one is not None), key=lambda one: one.nats, default=None) for both in zip(
        _second_readings(estimate, lanes, own, way, part), _second_places(estimate, lanes, strips, own, way))]
    k = 0
    of_best = (values[best].tolist() for values in (strips.interval, strips.left, strips.right, strips.number, strips.first))
    for i, m, end, number, first in zip(*of_best):
        # what the borders of its lanes separate, from left to right
        uses = [CENTRE_LINE if inner == first else LANE_LINE for inner in range(number + 1)]
        uses[0], uses[-1] = borders[i - part.start, [m, end]].tolist()
        for place in range(number):
            direction = estimate.first_direction if place < first else -estimate.first_direction
            probability, confidence, directed, turned = shares[k].tolist()
            found.append(LaneSpan(i, int(c.rows[i, m, 1]), int(c.rows[i, end, 0]), number - 1 - place, number, -direction if turned else direction,
                                  probability, confidence, 1 - directed if turned else directed, uses[place], uses[place + 1], seconds[k]))
            k += 1
    return found


@dataclass
class _Lanes:
    """Every lane of every strip of an estimate, in order of interval: where it is and which way it leads."""

    interval: np.ndarray   # (N,) int
    section: np.ndarray
    strip: np.ndarray   # row of LaneStrips
    d: np.ndarray   # (N,) m
    width: np.ndarray
    way: np.ndarray   # (N,) 1 or -1


def _strips_of(estimate, part):
    """The LaneStrips of all cross-sections of some intervals."""
    found = lane_strips(estimate.sections.take(part))
    return replace(found, interval=found.interval + part.start)


def _lanes_of(estimate, strips):
    """Every lane of some strips of an estimate."""
    return _lanes(estimate.candidates, estimate.lane_width, estimate.first_direction, strips)


def _lanes(c, lane_width, first_direction, strips):
    at = strips.interval
    d_left, each = lane_places(c.right[at, strips.left], c.left[at, strips.right], c.made_of[at, strips.left], c.made_of[at, strips.right],
                               strips.number, lane_width, c.bend[at])
    of = np.repeat(np.arange(len(at)), strips.number)
    place = np.arange(len(of)) - (np.cumsum(strips.number) - strips.number)[of]
    way = np.where(place < strips.first[of], first_direction, -first_direction)
    return _Lanes(at[of], strips.section[of], of, d_left[of] - each[of] * (place + 0.5), each[of], way)


def _place_shares(estimate, lanes, chosen, part):
    """The rows of the lanes of the chosen strips, from left to right, and (L, 4) of them: probability, confidence and directed of LaneSpan, turned.

    That is of all cross-sections that have a lane within SAME_LANE, whatever bounds it and whatever lies beside it. Of directions the most probable
    sequences are weighed against each other where the other side of traffic counts too: a road that is one way is the same reading on both.
    """
    other = estimate.other
    best = estimate.once_total
    known = [(lanes.interval, lanes.d, lanes.way, estimate.posterior[lanes.interval, lanes.section], estimate.sureness[lanes.interval, lanes.section],
              estimate.once[lanes.interval, lanes.section] - best, estimate.unnamed[lanes.interval] == lanes.section)]
    if other is not None:
        more = _lanes_of(other, _strips_of(other, part))
        nothing = np.zeros(len(more.d))
        known.append((more.interval, more.d, more.way, nothing, nothing, other.once[more.interval, more.section] - other.once_total + estimate.behind,
                      nothing > 0))
    joined = [np.concatenate(values) for values in zip(*known)]
    order = np.argsort(joined[0], kind="stable")
    interval, d, way, posterior, sureness, nats, unnamed = (values[order] for values in joined)
    first, last = (np.searchsorted(interval, np.arange(part.stop), side=side) for side in ("left", "right"))
    own = np.flatnonzero(np.isin(lanes.strip, chosen))
    size = (last - first)[lanes.interval[own]]
    one = np.repeat(own, size)
    beside = np.arange(len(one)) - np.repeat(np.cumsum(size) - size, size) + first[lanes.interval[one]]
    there = np.abs(d[beside] - lanes.d[one]) < SAME_LANE
    alike = there & (way[beside] == lanes.way[one])
    probability, sure, either, as_unnamed = (np.bincount(one[which], values[beside[which]], minlength=len(lanes.d)) for values, which in (
        (posterior, there), (sureness, alike), (sureness, there), (unnamed, alike)))
    directed = sure / np.where(either > 0, either, 1.0)
    if other is not None:
        least = np.full((2, len(lanes.d)), FARTHEST_BEHIND)
        for values, which in zip(least, (alike, there & ~alike)):
            np.minimum.at(values, one[which], nats[beside[which]])
        directed = 1 / (1 + np.exp(least[0] - least[1]))
    turned = (either > 0) & (directed < 0.5) & (as_unnamed > 0) & ~_driven_along(estimate.evidence, lanes)
    return own, np.stack([probability, either, directed, turned], axis=1)[own]


def _second_readings(estimate, lanes, own, way, part):
    """The second Reading of each of the lanes `own`, which lead the way `way`, (L,); None where nothing is known of others."""
    sides = [(lanes, estimate.second)]
    if estimate.opposite is not None:
        sides.append((_lanes_of(estimate.opposite, _strips_of(estimate.opposite, part)), estimate.opposite.second + estimate.opposite_behind))
    nats = np.concatenate([behind for _, behind in sides], axis=1)
    slots = np.cumsum([0] + [behind.shape[1] for _, behind in sides[:-1]])
    slot = np.concatenate([side.section + first for (side, _), first in zip(sides, slots)])
    interval, d, width, direction = (np.concatenate([getattr(side, name) for side, _ in sides]) for name in ("interval", "d", "width", "way"))
    order = np.argsort(interval, kind="stable")
    begin, end = (np.searchsorted(interval[order], lanes.interval[own], side=side) for side in ("left", "right"))
    found = []
    for row, facing, first, last in zip(own.tolist(), way.tolist(), begin.tolist(), end.tolist()):
        beside, of_place = order[first:last], nats[lanes.interval[row]]
        alike = (np.abs(d[beside] - lanes.d[row]) < SAME_LANE) & (direction[beside] == facing)
        without = np.ones(len(of_place), bool)
        without[slot[beside[alike]]] = False
        second = int(np.argmin(np.where(without, of_place, np.inf)))
        least = of_place[~without].min(initial=np.inf)
        if not np.isfinite(of_place[second]) or not without[second] or not np.isfinite(least):
            found.append(None)
            continue
        there = beside[(slot[beside] == second) & (np.abs(d[beside] - lanes.d[row]) < (width[beside] + lanes.width[row]) / 2 - SAME_LANE)]
        second_lanes = tuple(zip(d[there].tolist(), width[there].tolist(), direction[there].tolist()))
        found.append(Reading(max(float(of_place[second] - least), 0.0), second_lanes))
    return found


def _second_places(estimate, lanes, strips, own, way):
    """The Reading in which the lanes `own` share all the room up to the curb or edge beside them; None for those that do, or lie between lines.

    What the width of a lane says is laid out once, so it counts as one observation however long the road is, and so does where one drove.
    """
    c, w, at, strip = estimate.candidates, estimate.weights, lanes.interval[own], lanes.strip[own]
    left, right = strips.left[strip], strips.right[strip]
    made_left, made_right = c.made_of[at, left], c.made_of[at, right]
    begin, number = c.right[at, left], strips.number[strip]
    shared = (begin - c.left[at, right]) / number
    place = np.arange(len(own)) - np.searchsorted(strip, strip)
    d = begin - shared * (place + 0.5)
    open_room = (UNPAINTED[made_left] ^ UNPAINTED[made_right]) & ~beside_surface_end(made_left, made_right) & (shared > lanes.width[own]) \
        & (np.abs(d - lanes.d[own]) > SAME_LANE)
    widths = np.stack([shared, lanes.width[own]])
    nats = width_cost(widths, estimate.lane_width, w)
    driven = estimate.evidence.driven[:, at]
    with np.errstate(invalid="ignore"):
        inside = np.abs(driven - d) < shared / 2
        off = [np.where(inside, np.minimum(0.5 * ((driven - middle) / w.driven_sigma) ** 2, w.driven_astride), 0.0).sum(0)
               for middle in (d, lanes.d[own])]
    behind = nats[0] - nats[1] + off[0] - off[1]
    return [Reading(max(float(behind[k]), 0.0), ((float(d[k]), float(shared[k]), int(way[k])),)) if open_room[k] and np.isfinite(behind[k]) else None
            for k in range(len(own))]


def _driven_along(evidence, lanes):
    """(N,) bool, whether somebody drove in a lane the way it leads."""
    with np.errstate(invalid="ignore"):
        inside = np.abs(evidence.driven[:, lanes.interval] - lanes.d) < lanes.width / 2
    return (inside & (evidence.directions[:, None] == lanes.way)).any(0)


def boundary_uses(estimate: RoadEstimate) -> np.ndarray:
    """(I, M) what each boundary separates in the best sequence, LANE_LINE ... OTHER_LINE; -1 where it bounds nothing."""
    return _uses(estimate.sections, estimate.choice)


def _uses(sections, choice):
    return separated_kinds(sections.chosen(choice))[:, 0]
