"""The best cross-sections of each interval, by dynamic programming from left to right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .candidates import Candidates
from .strips import FIRST, REST_FIRST, REST_SECOND, SECOND, STRIPS, TWO_WAY, StripCosts, stops_across
from .weights import CENTRE_LINE, DASHED, EDGE_LINE, LANE_LINE, OTHER_LINE, SOLID, EstimateWeights

KEPT = 32     # cross-sections of an interval that are kept

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
class Sections:
    """The best cross-sections of each interval, the best one first.

    cost : (I, K) nats; inf where there are fewer than K
    strip : (I, K, M) int8, kind of the strip to the right of each boundary, -1 where a boundary bounds nothing
    right : (I, K, M) int8, the boundary that the strip ends at
    lanes, first_lanes : (I, K, M) int8, how many lanes the strip holds, and how many of them are of the direction that is met first
    """

    cost: np.ndarray
    strip: np.ndarray
    right: np.ndarray
    lanes: np.ndarray
    first_lanes: np.ndarray

    def take(self, intervals: slice | np.ndarray) -> Sections:
        """Those of some intervals."""
        return Sections(**{name: values[intervals] for name, values in vars(self).items()})

    def chosen(self, choice: np.ndarray) -> Sections:
        """One of each interval."""
        rows = np.arange(len(choice))
        return Sections(**{name: values[rows, choice][:, None] for name, values in vars(self).items()})

    @staticmethod
    def joined(parts: Sequence[Sections]) -> Sections:
        """The cross-sections of intervals that follow each other."""
        return Sections(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in vars(parts[0])})


@dataclass
class LaneStrips:
    """The strips of cross-sections that hold lanes.

    interval, section, left, right : (S,) int, where they are and the boundaries they lie between
    kind : (S,) FIRST ... SECOND; number, first : (S,) lanes in them, and how many of these are of the direction that is met first
    """

    interval: np.ndarray
    section: np.ndarray
    left: np.ndarray
    right: np.ndarray
    kind: np.ndarray
    number: np.ndarray
    first: np.ndarray


def lane_strips(sections: Sections) -> LaneStrips:
    """The LaneStrips of all cross-sections, in order of interval, cross-section and from left to right."""
    i, k, m = np.nonzero((sections.strip >= FIRST) & (sections.strip <= SECOND))
    return LaneStrips(i, k, m, *(values[i, k, m].astype(int) for values in (sections.right, sections.strip, sections.lanes, sections.first_lanes)))


def separated_kinds(sections: Sections) -> np.ndarray:
    """(I, K, M) what each boundary separates, LANE_LINE ... OTHER_LINE; -1 where it bounds nothing."""
    strip = sections.strip
    before = np.full(strip.shape, -1, np.int8)
    i, k, m = np.nonzero(strip >= 0)
    before[i, k, sections.right[i, k, m]] = strip[i, k, m]
    return np.where((strip >= 0) & (before >= 0), SEPARATES[before, strip], np.int8(-1))


def misnamed_costs(candidates: Candidates, sections: Sections, weights: EstimateWeights) -> np.ndarray:
    """(I, K) nats of lines that separate something else than their layer says."""
    what, named = separated_kinds(sections), candidates.named[:, None, :]
    return weights.named * _misnamed(what, named).sum(2) * candidates.observations(weights)[:, None]


def _misnamed(what, named):
    return (what >= 0) & (named >= 0) & (named != what) & (what != OTHER_LINE)


def best_sections(candidates: Candidates, costs: StripCosts, stops: np.ndarray, weights: EstimateWeights, kept: int = KEPT) -> Sections:
    """The `kept` best cross-sections of each interval; `stops` are those of Evidence."""
    count, size = candidates.left.shape
    kinds = len(STRIPS)
    between = _boundary_costs(candidates, stops, weights)
    best = np.full((count, size, kinds, kept), np.inf)
    back = np.full((count, size, kinds, kept), -1, np.int32)
    # to the left of everything nobody drives
    best[:, 0, REST_FIRST, 0] = 0.0
    for j in range(1, size - 1):
        reach = _reach(best, costs, j)
        for kind in STRIPS:
            back[:, j, kind], best[:, j, kind] = _lowest(reach + between[:, j, :, kind][:, None, :, None], kept)
        best[:, j][~candidates.valid[:, j]] = np.inf
    reach = _reach(best, costs, size - 1)
    reach[:, :, FIRST:SECOND + 1] = np.inf
    return _traced(back, _lowest(reach, kept), costs)


def _reach(best, costs, j):
    """(I, j, 7, kept) nats up to boundary j with a strip of a kind that begins at an earlier boundary."""
    return best[:, :j] + costs.cost[:, :, :j, j].transpose(1, 2, 0)[..., None]


def _lowest(values, kept):
    """(I, kept) places, in the flattened rows, and values of the lowest of each of I rows; inf where there are fewer."""
    flat = values.reshape(len(values), -1)
    flat = np.pad(flat, ((0, 0), (0, max(kept - flat.shape[1], 0))), constant_values=np.inf)
    place = np.argpartition(flat, kept - 1, axis=1)[:, :kept]
    lowest = np.take_along_axis(flat, place, axis=1)
    order = np.argsort(lowest, axis=1, kind="stable")
    return np.take_along_axis(place, order, axis=1), np.take_along_axis(lowest, order, axis=1)


def _boundary_costs(c, stops, w):
    """(I, M, 7, 7) nats of a boundary between a strip on its left and one on its right."""
    scale = c.observations(w)[:, None]
    table = w.boundary[c.made_of]
    stopped = stops_across(stops, (c.left + c.right) / 2)
    for share, costs in ((c.short, np.array(w.short_dashed)), (c.wide, w.wide_line[c.made_of.clip(SOLID, DASHED)])):
        share = np.nan_to_num(share)[..., None]
        table = np.where(share > 0, (1 - share) * table + share * costs, table)
    cost = np.full((*c.left.shape, len(STRIPS), len(STRIPS)), np.inf)
    for left in STRIPS:
        for right in STRIPS:
            what = SEPARATES[left, right]
            if what >= 0:
                misnamed = w.named * _misnamed(what, c.named)
                wrong = w.wrong_side if (left, right) in _WRONG_SIDE else 0.0
                cost[:, :, left, right] = scale * (table[:, :, what] + wrong + misnamed) \
                    + w.split_stop * stopped * (what == CENTRE_LINE)
    return cost


def _traced(back, ends, costs):
    """Sections from the ends of the chains: `back` tells from where each chain came."""
    count, size, kinds, kept = back.shape
    chosen, value = ends
    strip, right, lanes, first_lanes = np.full((4, *chosen.shape, size), -1, np.int8)
    row = np.arange(count)[:, None]
    at, place = np.full(chosen.shape, size - 1), np.where(np.isfinite(value), chosen, -1)
    while (alive := place >= 0).any():
        boundary, rest = np.divmod(place, kinds * kept)
        kind, rank = np.divmod(rest, kept)
        r, k = np.nonzero(alive)
        strip[r, k, boundary[alive]] = kind[alive]
        right[r, k, boundary[alive]] = at[alive]
        for values, of_strip in ((lanes, costs.lanes), (first_lanes, costs.first_lanes)):
            values[r, k, boundary[alive]] = of_strip[kind[alive], r, boundary[alive], at[alive]]
        at = np.where(alive, boundary, at)
        place = np.where(alive & (boundary > 0), back[row, boundary.clip(0), kind, rank], -1)
    return Sections(value, strip, right, lanes, first_lanes)
