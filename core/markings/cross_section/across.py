"""The best cross-sections of each interval, by dynamic programming from left to right."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .candidates import Candidates
from .strips import BOTH, FIRST, REST_FIRST, REST_SECOND, SECOND, STRIPS, StripCosts
from .weights import CENTRE_LINE, DOUBLE, EDGE_LINE, LANE_LINE, OTHER_LINE, EstimateWeights

KEPT = 32     # cross-sections of an interval that are kept

# What a boundary between two strips separates, -1 where the two cannot follow each other, and whether traffic is on the wrong side there
SEPARATES = np.full((len(STRIPS), len(STRIPS)), -1)
for _left, _right, _what in (
        (REST_FIRST, REST_FIRST, OTHER_LINE), (REST_FIRST, FIRST, EDGE_LINE), (REST_FIRST, BOTH, EDGE_LINE), (REST_FIRST, SECOND, EDGE_LINE),
        (FIRST, FIRST, LANE_LINE), (FIRST, BOTH, LANE_LINE), (FIRST, SECOND, CENTRE_LINE), (FIRST, REST_FIRST, EDGE_LINE),
        (BOTH, SECOND, LANE_LINE), (BOTH, REST_SECOND, EDGE_LINE), (SECOND, SECOND, LANE_LINE), (SECOND, REST_SECOND, EDGE_LINE),
        (REST_SECOND, REST_SECOND, OTHER_LINE), (REST_SECOND, SECOND, EDGE_LINE), (REST_SECOND, FIRST, EDGE_LINE), (SECOND, FIRST, CENTRE_LINE)):
    SEPARATES[_left, _right] = _what
_WRONG_SIDE = {(REST_SECOND, FIRST), (SECOND, FIRST)}


@dataclass
class Sections:
    """The best cross-sections of each interval, the best one first.

    cost : (I, K) nats; inf where there are fewer than K
    strip : (I, K, M) kind of the strip to the right of each boundary, -1 where a boundary bounds nothing
    right : (I, K, M) the boundary that the strip ends at
    """

    cost: np.ndarray
    strip: np.ndarray
    right: np.ndarray


def best_sections(candidates: Candidates, costs: StripCosts, weights: EstimateWeights, kept: int = KEPT) -> Sections:
    """The `kept` best cross-sections of each interval."""
    count, size = candidates.left.shape
    kinds = len(STRIPS)
    between = _boundary_costs(candidates, weights)
    best = np.full((count, size, kinds, kept), np.inf)
    back = np.full((count, size, kinds, kept), -1)
    # to the left of everything nobody drives
    best[:, 0, REST_FIRST, 0] = 0.0
    for j in range(1, size):
        # (I, i, kind, kept): up to boundary j with a strip of a kind between i and j
        reach = best[:, :j] + costs.cost[:, :, :j, j].transpose(1, 2, 0)[..., None]
        if j == size - 1:
            reach[:, :, [FIRST, BOTH, SECOND]] = np.inf
            flat = reach.reshape(count, -1)
            chosen, value = _lowest(flat, kept)
            return _traced(candidates, best, back, chosen, value, kinds, kept)
        for kind in STRIPS:
            flat = (reach + between[:, j, :, kind][:, None, :, None]).reshape(count, -1)
            back[:, j, kind], best[:, j, kind] = _lowest(flat, kept)
        best[:, j][~candidates.valid[:, j]] = np.inf
    raise AssertionError("unreachable")


def _lowest(flat, kept):
    """(I, kept) places and values of the lowest of each row."""
    if flat.shape[1] > kept:
        place = np.argpartition(flat, kept - 1, axis=1)[:, :kept]
    else:
        place = np.arange(flat.shape[1])[None].repeat(len(flat), axis=0)
        extra = kept - place.shape[1]
        if extra:
            place = np.concatenate([place, np.zeros((len(flat), extra), int)], axis=1)
    value = np.take_along_axis(flat, place, axis=1)
    if flat.shape[1] < kept:
        value[:, flat.shape[1]:] = np.inf
    order = np.argsort(value, axis=1, kind="stable")
    return np.take_along_axis(place, order, axis=1), np.take_along_axis(value, order, axis=1)


def _boundary_costs(c, w):
    """(I, M, 5, 5) nats of a boundary between a strip on its left and one on its right."""
    scale = (c.length / w.correlation)[:, None]
    paint = c.made_of <= DOUBLE
    table = w.boundary[c.made_of]
    extra = np.where(paint, w.short * (1 - c.trust) + w.bridged * (1 - c.seen), w.bridged * (1 - c.seen))
    cost = np.full((*c.left.shape, len(STRIPS), len(STRIPS)), np.inf)
    for left in STRIPS:
        for right in STRIPS:
            what = SEPARATES[left, right]
            if what >= 0:
                misnamed = w.named * ((c.named >= 0) & (c.named != what) & (what != OTHER_LINE))
                wrong = w.wrong_side if (left, right) in _WRONG_SIDE else 0.0
                cost[:, :, left, right] = scale * (table[:, :, what] + wrong + misnamed + (extra if what != OTHER_LINE else 0.0))
    return cost


def _traced(c, best, back, chosen, value, kinds, kept):
    """Sections from the ends of the chains."""
    count, size = c.left.shape
    strip, right = np.full((2, count, chosen.shape[1], size), -1)
    row = np.arange(count)[:, None]
    column = np.arange(chosen.shape[1])[None]
    at = np.full(chosen.shape, size - 1)
    place = np.where(np.isfinite(value), chosen, -1)
    alive = place >= 0
    while alive.any():
        boundary, rest = place // (kinds * kept), place % (kinds * kept)
        kind, rank = rest // kept, rest % kept
        r, k = np.nonzero(alive)
        strip[r, k, boundary[alive]] = kind[alive]
        right[r, k, boundary[alive]] = at[alive]
        at = np.where(alive, boundary, at)
        previous = back[row, boundary.clip(0), kind.clip(0), rank.clip(0)]
        place = np.where(alive & (boundary > 0), previous, -1)
        alive = place >= 0
    del column
    return Sections(value, strip, right)
