"""One estimate of the lines and lanes of a road: the most probable sequence of cross-sections."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

import numpy as np

from ...common.parallel import check_cancelled
from ...common.progress import Progress
from ...countries.catalogue import NEUTRAL
from ...execution.phase import Executor, NoSource, Phase
from .beside import NATS, SECOND_WIDTH, SURE
from .candidates import Candidates
from .evidence import Evidence
from .sequence import (
    FIRST,
    REST_FIRST,
    REST_SECOND,
    SECOND,
    Sections,
    behind_best,
    beside_island,
    beside_of,
    best_sections,
    best_sequence,
    lane_places,
    lane_strips,
    probabilities,
    separated_kinds,
    strip_costs,
    strips_before,
    transitions,
    ways,
)
from .weights import BARE, CENTRE_LINE, DOUBLE, EDGE_LINE, LANE_LINE, SAME_LANE, SOLID, UNPAINTED, EstimateWeights, Reading, confidence_of

FARTHEST_BEHIND = 30.0   # derived: nats at most by which one direction is less probable than the other
LENGTH_OF_STRETCH = 500   # derived: stations that are looked at together, 250 m of road: what is chosen from takes 0.2 MB for each interval


@dataclass
class RoadEstimate:
    """The cross-sections of one road for one side of traffic.

    lined : (N,) int, the intervals of which something is known
    costs : (2, N, K) nats of their cross-sections, and of these what was seen here: what is laid out alike counts once
    transition, least : as of `ways` of these costs, the most probable ones
    once : (I, K) nats of the most probable sequence through each as far as it was seen here; inf where nothing is known
    other, behind : the estimate for the other side of traffic where either may be, else None, and by how many nats it is less probable
    """

    candidates: Candidates
    lane_width: float   # metres, the usual width of a lane
    sections: Sections
    choice: np.ndarray   # (I,) which of them
    total: float   # nats of them
    once_total: float   # nats of the best sequence as far as it was seen here
    first_direction: int   # of the lanes met first from the left
    evidence: Evidence   # that it is made from
    weights: EstimateWeights
    lined: np.ndarray
    costs: np.ndarray
    transition: np.ndarray
    least: np.ndarray
    once: np.ndarray
    other: RoadEstimate | None = None
    behind: float = 0.0
    opposite: RoadEstimate | None = None   # the same as far as it is a second reading, in nats as of `second`
    opposite_behind: float = 0.0

    @cached_property
    def probability(self) -> np.ndarray:
        """(2, I, K) how probable each cross-section is, by all that is known, and as far as it was seen here."""
        result = np.zeros((2, *self.sections.cost.shape))
        result[:, self.lined] = probabilities(self.costs, self.transition)
        return result

    @cached_property
    def second(self) -> np.ndarray:
        """(I, K) by how many nats the most probable sequence through each is behind the best one; inf where nothing is known."""
        result = np.full(self.sections.cost.shape, np.inf)
        if len(self.lined):
            best, length = best_sequence(self.least[0, 0], self.transition), self.candidates.length[self.lined]
            result[self.lined] = behind_best(self.costs[0], self.transition, self.least[:, 0], best, length, self.weights.repeats)
        return result


def estimates_of_roads(roads: Sequence[tuple[Candidates, Evidence, int, int]], lane_width: float, weights: EstimateWeights, executor: Executor,
                       progress: Progress = Progress()) -> Iterator[RoadEstimate]:
    """The estimates of roads: cross-sections are chosen stretch by stretch, the sequence of them for a road as a whole.

    roads : what may bound the lanes of each and what is seen beside it; 1 or -1, the direction of the lanes that are met first from the left: -1
        with traffic on the right; and how many stations its grid begins behind station 0
    lane_width : m, the usual one
    """
    pieces, counts = [], []
    for candidates, evidence, first_direction, begin in roads:
        # a line that begins earlier changes no stretch farther on
        stretches, (lined, left) = _stretches(candidates, begin), _remembered(candidates, evidence, weights)
        counts.append(len(stretches))
        for part in stretches:
            first, last = np.searchsorted(lined, [part.start, part.stop]).tolist()
            # from the last interval of which something is known it leads to the first such one beyond the stretch
            known = lined[first:last + (last > first)]
            end = max(part.stop, *(known[-1:] + 1).tolist(), 0)
            piece = candidates[part.start:end]
            # which rows and columns of a table they are does not matter
            piece = replace(piece, rows=np.zeros_like(piece.rows), first=piece.first - piece.first[0], last=piece.last - piece.first[0])
            pieces.append((piece, evidence.part(part.start, end), first_direction, part.stop - part.start,
                           known - part.start, left[:, first:first + max(len(known) - 1, 0)]))
    phase = Phase(sections_of_stretch, NoSource(), (lane_width, weights), lambda item: "the lanes of a road")
    chosen = executor.run(phase, pieces, progress)
    for road, count in zip(roads, counts):
        check_cancelled()
        yield _estimate_of_road(*road[:3], list(islice(chosen, count)), lane_width, weights)


def _remembered(candidates, evidence, weights):
    """(N,) int, intervals of which something is known, and (2, N - 1) what of lanes, and of directions, is left at the next one, 0 to 1."""
    # where no line is seen, as on a crossing, much may change; where no line is known nothing can be said
    paint = candidates.painted
    shown, lined = (paint * candidates.seen).sum(1) / np.maximum(paint.sum(1), 1), np.flatnonzero(paint.any(1) | evidence.bare)
    hidden, unseen = np.r_[0.0, np.cumsum(candidates.length)], candidates.length * (1 - shown)
    gap = hidden[lined[1:]] - hidden[lined[:-1] + 1] + (unseen[lined[1:]] + unseen[lined[:-1]]) / 2
    return lined, np.stack([np.exp(-gap / remembered) for remembered in (weights.lanes_remembered, weights.directions_remembered)])


def sections_of_stretch(source: NoSource, item: tuple[Candidates, Evidence, int, int, np.ndarray, np.ndarray], lane_width: float,
                        weights: EstimateWeights) -> tuple[Sections, np.ndarray]:
    """The phase that chooses the cheapest cross-sections of the intervals of a stretch, and those beyond it up to the next that it leads to.

    item : what is known of the intervals, as of `estimates_of_roads`, how many of them are its own, and `known` and `left` as of `transitions`

    Returns the Sections of its own intervals, and `transitions`
    """
    candidates, evidence, first_direction, count, known, left = item
    costs = strip_costs(candidates, evidence, weights, lane_width, first_direction)
    sections = best_sections(candidates, costs, evidence.stops, first_direction, weights)
    sections.cost += _roads_of_many_lanes(candidates, sections, evidence, weights)
    return sections[:count], transitions(candidates, sections, known, lane_width, left, weights)


def _estimate_of_road(candidates, evidence, first_direction, parts, lane_width, weights):
    """The RoadEstimate of the most probable sequence of cross-sections of one road, of whose stretches `sections_of_stretch` gave the parts."""
    of_stretches, of_gaps = zip(*parts)
    sections, transition = Sections.join(of_stretches), np.concatenate(of_gaps)
    _hold_to_taken(candidates, evidence, sections, lane_width, first_direction, weights)
    lined = np.flatnonzero(candidates.painted.any(1) | evidence.bare)
    # what is laid out alike along the road was seen once
    seen_once = sections.cost * weights.correlation / np.clip(candidates.length.sum(), weights.correlation, weights.laid_out)
    costs = np.stack([sections.cost, seen_once])[:, lined]
    least, choice, totals = ways(costs, transition, np.min), np.argmin(sections.cost, axis=1), (0.0, 0.0)
    once = np.full(sections.cost.shape, np.inf)
    once[lined] = least[:, 1].sum(axis=0)
    if len(lined):
        choice[lined], total = best_sequence(least[0, 0], transition)
        totals = total, float(once.min())
    return RoadEstimate(candidates, lane_width, sections, choice, *totals, first_direction, evidence, weights, lined, costs, transition, least, once)


def _stretches(candidates, begin=0):
    """Intervals by the stretch of road that they begin in; those of a stretch are looked at together."""
    bounds = [0, *(np.flatnonzero(np.diff((begin + candidates.first) // LENGTH_OF_STRETCH)) + 1).tolist(), len(candidates.first)]
    return [slice(first, end) for first, end in zip(bounds, bounds[1:])]


def _hold_to_taken(candidates, evidence, sections, lane_width, first_direction, weights):
    """Make cross-sections improbable, in place, that have not the lanes that an analyst took."""
    for interval, former, wanted in evidence.taken:
        strips = lane_strips(sections[interval:interval + 1])
        lanes = _lanes(candidates, lane_width, first_direction, replace(strips, interval=strips.interval + interval))
        overlapping = np.abs(lanes.d - former) < SAME_LANE
        for d, width, _ in wanted:
            overlapping |= np.abs(lanes.d - d) < width / 2
        numbers = np.arange(sections.cost.shape[1])
        fits = np.bincount(lanes.section[overlapping], minlength=len(numbers)) == len(wanted)
        for d, _, way in wanted:
            fits &= np.isin(numbers, lanes.section[(np.abs(lanes.d - d) < 2 * SAME_LANE) & (lanes.way == way)])
        sections.cost[interval] += np.where(fits, 0.0, weights.not_taken)


def _roads_of_many_lanes(c, sections, evidence, weights):
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
    cost = np.where(evidence.divided[:, None], np.where(one_way | (total == 0), 0.0, weights.two_way_carriageway), cost)
    cost += np.where(evidence.again_one_way[:, None] & ~one_way & (total > 0), weights.never_back, 0.0)
    # what nobody drives on between lines of lanes, as a median, parts the directions, above all what is too narrow for a lane
    before = strips_before(sections)
    i, k, m = np.nonzero(np.isin(sections.strip, (REST_FIRST, REST_SECOND)) & np.isin(before, (FIRST, SECOND)))
    end, lane = sections.right[i, k, m], before[i, k, m]
    narrow, beyond, made_of = c.right[i, m] - c.left[i, end] < NEUTRAL.narrowest_lane, sections.strip[i, k, end], c.made_of[i[:, None], np.c_[m, end]]
    parting = (beyond == FIRST + SECOND - lane) & (made_of <= DOUBLE).all(axis=1)
    # roads that have medians have lanes beside each other either way
    median = (beyond == FIRST + SECOND - lane) & (np.minimum(ahead, total - ahead) > 1)[i, k]
    closed = median & (made_of == SOLID).all(axis=1)
    np.add.at(cost, (i, k), np.where(narrow, weights.median_within * (beyond == lane), -np.where(closed, *weights.median_between[::-1]) * parting))
    # where one border of it has no line, the other one often has none either
    np.add.at(cost, (i, k), (weights.bare_too - weights.bare[EDGE_LINE]) * median * (made_of == BARE).all(axis=1))
    return cost * c.observations(weights)[:, None]


@dataclass
class LaneSpan:
    """One lane over one interval.

    direction : 1 or -1, of the most probable sequence
    second : Reading, the most probable one of those without such a lane in that direction there; None where that is not known
    """

    interval: int   # number
    left: int   # rows of Boundaries
    right: int
    place: int   # from the right, of `count` lanes between them
    count: int
    beside: np.ndarray   # (5,) as of `lanes_beside`, of a lane that lies alone beside the one of them that is painted
    direction: int
    probability: float   # 0 to 1, of a lane of either direction there, with the posterior of RoadEstimate
    confidence: float   # 0 to 1, how often such lanes are right, see `confidence_of`
    left_border: int   # what the two separate, LANE_LINE ... OTHER_LINE
    right_border: int
    second: Reading | None = None


def lane_spans(estimate: RoadEstimate) -> list[LaneSpan]:
    """The lanes of the best sequence, interval by interval, from left to right."""
    return [span for part in _stretches(estimate.candidates) for span in _lane_spans(estimate, part)]


def _lane_spans(estimate, part):
    """Those of some intervals."""
    check_cancelled()
    spans = []
    c, strips = estimate.candidates, _strips_of(estimate, part)
    borders = separated_kinds(estimate.sections[part].chosen(estimate.choice[part]))[:, 0]
    best = np.flatnonzero(strips.section == estimate.choice[strips.interval])
    lanes = _lanes_of(estimate, strips)
    lane_rows, shares = _place_shares(estimate, lanes, best, part)
    way = lanes.way[lane_rows]
    seconds = [min((reading for reading in readings if reading is not None), key=lambda reading: reading.nats, default=None) for readings in zip(
        _second_readings(estimate, lanes, lane_rows, way, part), _second_places(estimate, lanes, strips, lane_rows, way))]
    k = 0
    of_best = [values[best].tolist() for values in (strips.interval, strips.left, strips.right, strips.number, strips.first)]
    beside = beside_of(c, strips)[best]
    # a lane alone beside one painted border is no surer than its width, which an island shows
    made_of = c.made_of[strips.interval[best], [strips.left[best], strips.right[best]]]
    loose = (UNPAINTED[made_of].sum(axis=0) == 1) & ~beside_island(*made_of)
    sure = np.where(loose & (strips.number[best] == 1), beside[:, SURE], 1.0)
    shares[:, 1] = (shares[:, 1] * np.repeat(sure, strips.number[best])).round(6)
    for row, (i, m, end, number, first) in enumerate(zip(*of_best)):
        # what the borders of its lanes separate, from left to right
        uses = [CENTRE_LINE if inner == first else LANE_LINE for inner in range(number + 1)]
        uses[0], uses[-1] = borders[i - part.start, [m, end]].tolist()
        for lane in range(number):
            direction = estimate.first_direction if lane < first else -estimate.first_direction
            spans.append(LaneSpan(i, int(c.rows[i, m, 1]), int(c.rows[i, end, 0]), number - 1 - lane, number, beside[row], direction,
                                  *shares[k].tolist(), uses[lane], uses[lane + 1], seconds[k]))
            k += 1
    return spans


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
    strips = lane_strips(estimate.sections[part])
    return replace(strips, interval=strips.interval + part.start)


def _lanes_of(estimate, strips):
    """Every lane of some strips of an estimate."""
    return _lanes(estimate.candidates, estimate.lane_width, estimate.first_direction, strips)


def _lanes(c, lane_width, first_direction, strips):
    row = strips.interval
    d_left, width_each = lane_places(c.right[row, strips.left], c.left[row, strips.right], c.made_of[row, strips.left], c.made_of[row, strips.right],
                                     strips.number, lane_width, beside_of(c, strips))
    of = np.repeat(np.arange(len(row)), strips.number)
    place = np.arange(len(of)) - (np.cumsum(strips.number) - strips.number)[of]
    way = np.where(place < strips.first[of], first_direction, -first_direction)
    return _Lanes(row[of], strips.section[of], of, d_left[of] - width_each[of] * (place + 0.5), width_each[of], way)


def _place_shares(estimate, lanes, chosen, part):
    """The rows of the lanes of the chosen strips, from left to right, and (L, 2) of them: probability and confidence of LaneSpan.

    That is of all cross-sections that have a lane within SAME_LANE, whatever bounds it and whatever lies beside it, and of those of its direction
    among them. Of directions the most probable sequences are weighed against each other where the other side of traffic counts too: a road that is
    one way is the same reading on both. In millionths: what is known of the far end of a road changes the digits behind.
    """
    other = estimate.other
    best = estimate.once_total
    parts = [(lanes.interval, lanes.d, lanes.way, *estimate.probability[:, lanes.interval, lanes.section],
              estimate.once[lanes.interval, lanes.section] - best)]
    if other is not None:
        more = _lanes_of(other, _strips_of(other, part))
        behind = other.once[more.interval, more.section] - other.once_total + estimate.behind
        parts.append((more.interval, more.d, more.way, *np.zeros((2, len(more.d))), behind))
    joined = [np.concatenate(values) for values in zip(*parts)]
    order = np.argsort(joined[0], kind="stable")
    interval, d, way, posterior, sureness, nats = (values[order] for values in joined)
    first, last = (np.searchsorted(interval, np.arange(part.stop), side=side) for side in ("left", "right"))
    chosen_lanes = np.flatnonzero(np.isin(lanes.strip, chosen))
    size = (last - first)[lanes.interval[chosen_lanes]]
    lane = np.repeat(chosen_lanes, size)
    compared = np.arange(len(lane)) - np.repeat(np.cumsum(size) - size, size) + first[lanes.interval[lane]]
    same_place = np.abs(d[compared] - lanes.d[lane]) < SAME_LANE
    alike = same_place & (way[compared] == lanes.way[lane])
    probability, sure, either = (np.bincount(lane[rows], values[compared[rows]], minlength=len(lanes.d)) for values, rows in (
        (posterior, same_place), (sureness, alike), (sureness, same_place)))
    directed = sure / np.where(either > 0, either, 1.0)
    if other is not None:
        least_nats = np.full((2, len(lanes.d)), FARTHEST_BEHIND)
        for values, rows in zip(least_nats, (alike, same_place & ~alike)):
            np.minimum.at(values, lane[rows], nats[compared[rows]])
        directed = 1 / (1 + np.exp(least_nats[0] - least_nats[1]))
    # that it leads this way is no less probable than the other by all that is known
    sure = confidence_of(either, np.maximum(directed, 0.5), estimate.weights)
    return chosen_lanes, np.stack([probability, sure], axis=1)[chosen_lanes].round(6)


def _second_readings(estimate, lanes, rows, way, part):
    """The second Reading of each of the lanes `rows`, which lead the way `way`, (L,); None where nothing is known of others."""
    sides = [(lanes, estimate.second)]
    if estimate.opposite is not None:
        sides.append((_lanes_of(estimate.opposite, _strips_of(estimate.opposite, part)), estimate.opposite.second + estimate.opposite_behind))
    nats = np.concatenate([behind for _, behind in sides], axis=1)
    slots = np.cumsum([0] + [behind.shape[1] for _, behind in sides[:-1]])
    slot = np.concatenate([side.section + first for (side, _), first in zip(sides, slots)])
    interval, d, width, direction = (np.concatenate([getattr(side, name) for side, _ in sides]) for name in ("interval", "d", "width", "way"))
    order = np.argsort(interval, kind="stable")
    begin, end = (np.searchsorted(interval[order], lanes.interval[rows], side=side) for side in ("left", "right"))
    readings = []
    for row, facing, first, last in zip(rows.tolist(), way.tolist(), begin.tolist(), end.tolist()):
        candidates, of_place = order[first:last], nats[lanes.interval[row]]
        alike = (np.abs(d[candidates] - lanes.d[row]) < SAME_LANE) & (direction[candidates] == facing)
        without = np.ones(len(of_place), bool)
        without[slot[candidates[alike]]] = False
        second = int(np.argmin(np.where(without, of_place, np.inf)))
        best_nats = of_place[~without].min(initial=np.inf)
        if not np.isfinite(of_place[second]) or not without[second] or not np.isfinite(best_nats):
            readings.append(None)
            continue
        overlapping = candidates[(slot[candidates] == second)
                                 & (np.abs(d[candidates] - lanes.d[row]) < (width[candidates] + lanes.width[row]) / 2 - SAME_LANE)]
        second_lanes = tuple(zip(d[overlapping].tolist(), width[overlapping].tolist(), direction[overlapping].tolist()))
        readings.append(Reading(max(round(float(of_place[second] - best_nats), 6), 0.0), second_lanes))
    return readings


def _second_places(estimate, lanes, strips, rows, way):
    """The Reading of another width for those of the lanes `rows` that lie alone between a line and a curb or edge; None for most others.

    Between two borders without paint there may be one lane or two, where these have room.
    """
    c, intervals, strip = estimate.candidates, lanes.interval[rows], lanes.strip[rows]
    left, right = strips.left[strip], strips.right[strip]
    open_left, open_right = UNPAINTED[c.made_of[intervals, left]], UNPAINTED[c.made_of[intervals, right]]
    beside = beside_of(c, strips)[strip]
    d = np.where(open_left, c.left[intervals, right] + beside[:, SECOND_WIDTH] / 2, c.right[intervals, left] - beside[:, SECOND_WIDTH] / 2)
    known = (open_left ^ open_right) & (strips.number[strip] == 1) & np.isfinite(beside[:, NATS]) & (np.abs(d - lanes.d[rows]) > SAME_LANE)
    result = [Reading(max(float(beside[k, NATS]), 0.0), ((float(d[k]), float(beside[k, SECOND_WIDTH]), int(way[k])),)) if known[k] else None
              for k in range(len(rows))]
    begin, room = c.right[intervals, left], c.right[intervals, left] - c.left[intervals, right]
    number = np.where(strips.number[strip] == 1, 2, 1)
    for k in np.flatnonzero(open_left & open_right & (room / number >= NEUTRAL.narrowest_lane)).tolist():
        width = float(room[k] / number[k])
        lanes_there = tuple((float(begin[k]) - width * (place + 0.5), width, int(way[k])) for place in range(number[k]))
        if number[k] == 2:
            lanes_there = tuple((middle, wide, estimate.first_direction * sign) for (middle, wide, _), sign in zip(lanes_there, (1, -1)))
        result[k] = Reading(estimate.weights.unpainted_divider, lanes_there)
    return result
