"""One estimate of lines and lanes.

In: marking lines, with curbs, the road surface, markings and the drive. Out: `RoadEstimates`, the most probable cross-section of each road
from interval to interval, from which lines get their kinds and lanes their places, directions and confidence.
"""
