"""Marking lines named by what they separate in the estimate of their road."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .estimate import boundary_uses
from .weights import CENTRE_LINE, EDGE_LINE, LANE_LINE

if TYPE_CHECKING:
    from .roads import RoadEstimates

KINDS = {EDGE_LINE: "edge", LANE_LINE: "lane", CENTRE_LINE: "centre"}


def line_kinds(estimates: RoadEstimates) -> dict[int, str]:
    """{number of a marking line: edge, lane or centre}, by what most of it separates; lines that bound no lane are not in it."""
    votes: dict[int, np.ndarray] = {}
    for road in estimates.roads.values():
        c, uses = road.estimate.candidates, boundary_uses(road.estimate)
        for i, m in zip(*np.nonzero((uses >= 0) & np.isin(uses, list(KINDS)))):
            for row in set(c.rows[i, m].tolist()) - {-1}:
                if not road.boundaries.painted[row]:
                    continue
                numbers = road.lines.number[row, c.first[i]:c.last[i] + 1]
                for number, count in zip(*np.unique(numbers[numbers >= 0], return_counts=True)):
                    votes.setdefault(int(number), np.zeros(len(KINDS)))[uses[i, m]] += count
    return {number: KINDS[int(np.argmax(found))] for number, found in votes.items()}
