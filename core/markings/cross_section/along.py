"""The most probable sequence of cross-sections along a road, and how sure each is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...common.parallel import check_cancelled
from .across import Sections, lane_strips
from .candidates import FAR, Candidates
from .lane_width import lane_places
from .strips import FIRST, SECOND
from .weights import EstimateWeights

PLACE = 0.5      # m across at which cross-sections are compared
INTERVALS_AT_ONCE = 32   # of which cross-sections are compared with each other
SAME_DIVIDER = 1 # places by which the same border between lanes may lie elsewhere


def transitions(candidates: Candidates, sections: Sections, known: np.ndarray, lane_width: float, left: Sequence[np.ndarray],
                weights: EstimateWeights) -> np.ndarray:
    """Nats of going from each cross-section of an interval to each of the next of those of which something is known.

    Parameters
    ----------
    candidates, sections : of all intervals
    known : (N,) int, intervals, ascending
    lane_width : metres, usual
    left : of what was known of lanes, and of directions, what is left after the way to the next one, (N - 1,) 0 to 1 each
    weights : EstimateWeights

    Returns
    -------
    (N - 1, K, K)
    """
    kept = sections.cost.shape[1]
    found = np.empty((max(len(known) - 1, 0), kept, kept))
    # what is compared is larger than the costs
    for first in range(0, len(found), INTERVALS_AT_ONCE):
        check_cancelled()
        some = known[first:first + INTERVALS_AT_ONCE + 1]
        own = slice(first, first + len(some) - 1)
        costs = _transition_costs(*occupancy(candidates.take(some), sections.take(some), lane_width), weights)
        found[own] = sum(cost * share[own, None, None] for cost, share in zip(costs, left))
    return found


def occupancy(candidates: Candidates, sections: Sections, lane_width: float) -> tuple[np.ndarray, np.ndarray]:
    """What lies where across the road.

    Returns
    -------
    area : (2, I, K, B) whether lanes of the first and of the second direction lie at a place across
    divider : (I, K, B) whether a border between two lanes lies there
    """
    count, kept, size = sections.strip.shape
    bins = int(2 * FAR / PLACE)
    area, divider = np.zeros((2, count, kept, bins + 1)), np.zeros((count, kept, bins), bool)
    strips = lane_strips(sections)
    i, k, m, end, number = strips.interval, strips.section, strips.left, strips.right, strips.number
    d_left, each = lane_places(candidates.right[i, m], candidates.left[i, end], candidates.made_of[i, m], candidates.made_of[i, end], number,
                               lane_width, candidates.bend[i])
    d_right = d_left - number * each
    split = d_left - each * strips.first
    for which, (high, low) in enumerate(((d_left, split), (split, d_right))):
        some = high - low > 1e-6
        a, b = (np.clip(np.rint((v[some] + FAR) / PLACE).astype(int), 0, bins) for v in (low, high))
        np.add.at(area[which], (i[some], k[some], a), 1.0)
        np.add.at(area[which], (i[some], k[some], b), -1.0)
    area = np.cumsum(area, axis=-1)[..., :-1]
    for place in range(1, int(number.max(initial=1))):
        some = number > place
        d = d_left[some] - each[some] * place
        divider[i[some], k[some], np.clip(np.rint((d + FAR) / PLACE).astype(int), 0, bins - 1)] = True
    # painted borders with a lane on both sides
    lane = (sections.strip >= FIRST) & (sections.strip <= SECOND)
    ends = np.zeros(sections.strip.shape, bool)
    ends[i, k, end] = True
    i, k, m = np.nonzero(lane & ends)
    d = (candidates.left[i, m] + candidates.right[i, m]) / 2
    divider[i, k, np.clip(np.rint((d + FAR) / PLACE).astype(int), 0, bins - 1)] = True
    return area, divider


def _transition_costs(area, divider, weights):
    """Nats of going from a cross-section to one of the next interval: of lanes that begin, end or divide, and of those that change direction."""
    first, second = area.astype(np.float32)
    wide = np.zeros(divider.shape, np.float32)
    for shift in range(-SAME_DIVIDER, SAME_DIVIDER + 1):
        wide = np.maximum(wide, np.roll(divider, shift, axis=-1))
    marks = divider.astype(np.float32)
    change, turn = weights.change * PLACE, weights.turn * PLACE

    def product(a, b):
        return np.einsum("ikb,ilb->ikl", a[:-1], b[1:], optimize=True)

    def core(values):
        # borders that move by a place across are no change
        return np.minimum(np.minimum(np.roll(values, 1, -1), np.roll(values, -1, -1)), values)

    lane = first + second
    inner, ahead, back = core(lane), core(first), core(second)
    size = inner.sum(-1)
    differs = size[:-1, :, None] + size[1:, None, :] - product(inner, lane) - product(lane, inner)
    turned = product(ahead, second) + product(back, first)
    number = marks.sum(-1)
    lost = number[:-1, :, None] + number[1:, None, :] - product(marks, wide) - product(wide, marks)
    return change * differs + weights.divider_change * np.clip(lost, 0, None), turn * turned


def best_sequence(cost: np.ndarray, transition: np.ndarray) -> tuple[np.ndarray, float]:
    """The most probable sequence (Viterbi).

    Parameters
    ----------
    cost : (I, K) nats, inf where there is no cross-section
    transition : (I - 1, K, K) nats

    Returns
    -------
    choice : (I,) the cross-section of each interval; total : nats of the whole
    """
    count, kept = cost.shape
    best, came = cost[0].copy(), np.zeros((count, kept), int)
    for i in range(1, count):
        step = best[:, None] + transition[i - 1]
        came[i] = np.argmin(step, axis=0)
        best = step[came[i], np.arange(kept)] + cost[i]
    choice = np.zeros(count, int)
    choice[-1] = int(np.argmin(best))
    for i in range(count - 1, 0, -1):
        choice[i - 1] = came[i, choice[i]]
    return choice, float(best.min())


def probabilities(cost: np.ndarray, transition: np.ndarray) -> np.ndarray:
    """(I, K) how probable each cross-section is among all sequences (forward-backward); parameters as of `best_sequence`."""
    forward, backward = np.zeros((2, *cost.shape))
    forward[0] = -cost[0]
    for i in range(1, len(cost)):
        forward[i] = _log_sum(forward[i - 1][:, None] - transition[i - 1], 0) - cost[i]
    for i in range(len(cost) - 1, 0, -1):
        backward[i - 1] = _log_sum(backward[i][None, :] - transition[i - 1] - cost[i][None, :], 1)
    log = forward + backward
    posterior = np.exp(log - log.max(axis=1, keepdims=True))
    return posterior / posterior.sum(axis=1, keepdims=True)


def best_through(cost: np.ndarray, transition: np.ndarray) -> np.ndarray:
    """(I, K) nats of the most probable sequence through each cross-section; parameters as of `best_sequence`."""
    forward, backward = cost.copy(), np.zeros(cost.shape)
    for i in range(1, len(cost)):
        forward[i] += (forward[i - 1][:, None] + transition[i - 1]).min(0)
    for i in range(len(cost) - 1, 0, -1):
        backward[i - 1] = (transition[i - 1] + (cost[i] + backward[i])[None, :]).min(1)
    return forward + backward


def behind_best(cost: np.ndarray, transition: np.ndarray, length: np.ndarray, repeats: float) -> np.ndarray:
    """By how many nats the most probable sequence through each cross-section is behind the most probable one of all.

    Where the two differ over a longer way than `repeats`, they differ in how the whole road is laid out. What is seen there again and again was
    laid out and driven once, so it counts as on a way of that length.

    Parameters
    ----------
    cost, transition : as of `best_sequence`
    length : (I,) metres of each interval
    repeats : metres

    Returns
    -------
    (I, K) nats, 0 for the most probable sequence; inf for cross-sections that are none
    """
    choice, total = best_sequence(cost, transition)
    apart = np.repeat(length[:, None].astype(float), cost.shape[1], axis=1)
    apart[np.arange(len(choice)), choice] = 0.0
    # metres for which a sequence has been apart from the best one, up to a cross-section and from it on
    before, after = apart.copy(), apart.copy()
    forward, backward = cost.copy(), np.zeros(cost.shape)
    for i in range(1, len(cost)):
        step = forward[i - 1][:, None] + transition[i - 1]
        forward[i] += step.min(0)
        before[i] = np.where(apart[i] > 0, before[i] + before[i - 1][step.argmin(0)], 0.0)
    for i in range(len(cost) - 1, 0, -1):
        step = transition[i - 1] + (cost[i] + backward[i])[None, :]
        backward[i - 1] = step.min(1)
        after[i - 1] = np.where(apart[i - 1] > 0, after[i - 1] + after[i][step.argmin(1)], 0.0)
    return (forward + backward - total) * np.minimum(1.0, repeats / np.maximum(before + after - apart, 1e-9))


def _log_sum(values, axis):
    highest = values.max(axis=axis, keepdims=True)
    highest = np.where(np.isfinite(highest), highest, 0.0)
    with np.errstate(divide="ignore"):
        return np.squeeze(highest, axis) + np.log(np.exp(values - highest).sum(axis=axis))

