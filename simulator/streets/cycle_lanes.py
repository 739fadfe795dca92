"""A simulated street with lanes for cycles and buses."""

from __future__ import annotations

from ..parts.paint import straight_arrow
from ..parts.sides import sidewalk
from ..parts.symbols import bicycle, bus_word
from .builder import MODULE, SceneBuilder
from .street import Scene

_LANE = 3.4      # m from the centre line to the line of the cycle lane
_EDGE = 5.4      # m from the centre line to the curb
_LINE = 0.15     # m, width of the lines
_CYCLES = _LANE + 0.95                                # m, the middle of a cycle lane
_BICYCLES = (12.0, 42.0, 72.0, 104.0)                 # m in each module: where bicycles are painted
_WORDS = ((26.0, 2.4, 1.7), (60.0, 4.0, 1.9), (92.0, 1.6, 1.8))   # m in each module: where BUS is painted, how long and how wide


def cycle_lanes(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """A lane each way with the word BUS, read along the lane, and a cycle lane with bicycles beside it; driven both ways."""
    road = SceneBuilder(length, seed, radius)
    lowered = []
    for number, offset in ((2, _LANE), (3, -_LANE)):
        road.line("edge line", number, offset, 0.0, length, width=_LINE)
    road.line("centre line", 1, 0.0, 0.0, length, width=_LINE, dash=(4.0, 6.0))
    for base in road.modules():
        lowered.append((base + 33.0, base + 38.0))
        for side in (1, -1):
            for station in _BICYCLES:
                road.figure("bicycle", *bicycle(base + station, side * _CYCLES, -side, 1.4 if station < 60.0 else 2.0, 1.1))
            for station, long, wide in _WORDS:
                road.figure("bus", *bus_word(base + station + 9.0 * (side > 0), side * _LANE / 2, -side, long, wide))
            road.figure("arrow", straight_arrow(base + 80.0, side * _LANE / 2, -side))
        road.manhole(base + 20.0, 1.4)
        road.manhole(base + 51.0, -1.9)
        road.manhole(base + 88.0, -_CYCLES, 0.30)
        road.repair(base + 66.0, base + 76.0, -3.0, -1.2, 1.3)
        road.trees(base + 8.0, base + MODULE - 3.0, _EDGE + 2.6, 15.0)
        road.poles(base + 18.0, base + MODULE, -_EDGE - 0.6, 32.0)
    for number, side in ((1, 1), (2, -1)):
        road.lane(number, -side, (0.0, side * _LANE / 2, _LANE), (length, side * _LANE / 2, _LANE))
    return road.scene("cycle-lanes", sidewalk(1, _EDGE, curb_height, lowered), sidewalk(-1, _EDGE, curb_height, lowered),
                      [(1, -_LANE / 2, 1.0), (-1, _LANE / 2, 1.1)], gutter)
