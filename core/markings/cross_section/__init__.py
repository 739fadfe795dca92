"""One estimate of lines and lanes.

In: marking lines, with curbs, the road surface, markings and the drive. Out: `RoadEstimates`, the most probable cross-section of each road
from interval to interval, from which lines get their kinds and lanes their places, directions and confidence.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "roads": ("EstimatedRoad", "RoadEstimates", "estimate_roads"),
    "sections": ("CrossSections", "sections_of_edges", "sections_of_lines", "sections_of_pavement"),
    "weights": ("EstimateWeights",),
})
