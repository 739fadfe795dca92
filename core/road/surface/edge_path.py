"""The path of an edge along the road through what every profile says, by dynamic programming."""

from __future__ import annotations

import numpy as np

from ...common.parallel import check_cancelled


def cheapest_path(costs: np.ndarray, cost_per_place: float, largest_change: float) -> np.ndarray:
    """The place on every profile so that the costs of the places and of the changes between profiles are least together.

    A change costs in proportion to its size, so an even widening costs no more than a sudden one, up to a limit, so that a
    street that joins is followed.

    Parameters
    ----------
    costs : (P, K) of each place on each profile
    cost_per_place : of a change by one place from one profile to the next
    largest_change : cost of any larger change

    Returns
    -------
    (P,) indices of places
    """
    count = costs.shape[1]
    places = np.arange(count)
    change = np.minimum(cost_per_place * np.abs(places[:, None] - places), largest_change)
    total, before = costs[0].astype(float), np.zeros(costs.shape, np.int32)
    for k in range(1, len(costs)):
        check_cancelled()
        reached = total[:, None] + change
        before[k] = reached.argmin(axis=0)
        total = reached[before[k], places] + costs[k]
    path = np.empty(len(costs), np.int64)
    path[-1] = total.argmin()
    for k in range(len(costs) - 1, 0, -1):
        path[k - 1] = before[k, path[k]]
    return path
