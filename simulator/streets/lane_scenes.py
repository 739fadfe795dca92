"""Simulated streets whose lanes cannot be told from the width alone: one broad lane, no centre line, an island of paint."""

from __future__ import annotations

from functools import partial

import numpy as np

from ..parts.paint import hatched_area, straight_arrow
from ..parts.sides import sidewalk
from .builder import MODULE, SceneBuilder

_PARKING = 2.3       # m from an edge line to the curb beyond the parked cars
_MARGIN = 0.45       # m from an edge line to a curb without parking
_LINE = 0.12         # m, width of the lines
_ISLAND = (34.0, 48.0, 76.0, 90.0)  # m in each module: the island of paint opens, is full, begins to close, is closed
_ISLAND_HALF = 1.0   # m, half the width of the island, to the middle of its border
_WARNING = 15.0      # m of solid centre line before and after the island


def _between_edge_lines(name, width, one_way, track, length, seed, radius, curb_height, gutter, centre=None):
    """A street between two edge lines, driven at an offset; `centre` are the (painted, gap) m of a line in its middle."""
    road = SceneBuilder(length, seed, radius)
    half = width / 2
    left_edge, right_edge = half + _MARGIN, half + _PARKING
    lowered_left, lowered_right = [], []
    road.line("edge line", 1, half, 0.0, length, width=_LINE)
    road.line("edge line", 2, -half, 0.0, length, width=_LINE)
    if centre:
        road.line("centre line", 3, 0.0, 0.0, length, width=_LINE, dash=centre if centre[1] else None)
    for base in road.modules():
        lowered_left.append((base + 63.0, base + 68.0))
        lowered_right.append((base + 96.0, base + 101.0))
        if one_way and not track:
            for station in (18.0, 58.0, 98.0):
                road.figure("arrow", straight_arrow(base + station, 0.0, 1))
        road.manhole(base + 31.0, 0.9)
        road.manhole(base + 77.0, -1.6)
        road.repair(base + 24.0, base + 33.5, -2.4, -0.9, 1.40)
        road.repair(base + 82.0, base + 90.0, 0.6, 2.2, 0.70)
        road.parked_cars(base + 4.0, base + 54.0, -right_edge)
        road.parked_cars(base + 70.0, base + 94.0, -right_edge)
        road.trees(base + 9.0, base + MODULE - 3.0, left_edge + 2.5, 14.0)
        road.trees(base + 5.0, base + MODULE - 3.0, -right_edge - 2.6, 18.0)
        road.poles(base + 20.0, base + MODULE, left_edge + 0.6, 32.0)
    if one_way:
        road.lane(1, 1, (0.0, 0.0, width), (length, 0.0, width))
    else:
        road.lane(1, -1, (0.0, half / 2, half), (length, half / 2, half))
        road.lane(2, 1, (0.0, -half / 2, half), (length, -half / 2, half))
    return road.scene(name, sidewalk(1, left_edge, curb_height, lowered_left), sidewalk(-1, right_edge, curb_height, lowered_right),
                      [(1, track, 1.0)], gutter)


def _around_island(name, island, sides, bar, gap, length, seed, radius, curb_height, gutter):
    """A lane each way about an island whose borders leave the middle by shares of _ISLAND_HALF to the left and to the right."""
    road = SceneBuilder(length, seed, radius)
    half = 4.2
    edge = half + _MARGIN
    opens, full, closing, closed = island
    tip = _LINE / 2      # where the two borders lie side by side
    lowered = []
    middles: tuple[list[tuple[float, float]], list[tuple[float, float]]] = ([(0.0, 0.0)], [(0.0, 0.0)])
    for base in road.modules():
        lowered.append((base + 12.0, base + 17.0))
        road.line("centre line", 1, 0.0, base, base + opens - _WARNING, width=_LINE, dash=(4.0, 6.0))
        road.line("centre line", 2, 0.0, base + opens - _WARNING, base + opens, width=_LINE)
        road.line("centre line", 5, 0.0, base + closed, base + closed + _WARNING, width=_LINE)
        road.line("centre line", 6, 0.0, base + closed + _WARNING, base + MODULE, width=_LINE, dash=(4.0, 6.0))
        left, right = (_cut([(base + opens, tip), (base + full, max(side * _ISLAND_HALF, tip)), (base + closing, max(side * _ISLAND_HALF, tip)),
                             (base + closed, tip)], length) for side in sides)
        if len(left) > 1:
            road.tapered("centre line", 3, left, width=_LINE)
            road.tapered("centre line", 4, [(s, -d) for s, d in right], width=_LINE)
            inside, below = (np.array([(s, d - tip) for s, d in border]) for border in (left, right))
            road.figure("hatching", *hatched_area(np.concatenate([inside, (below * [1, -1])[::-1]]), bar, gap))
        for middle, border in zip(middles, (left, right)):
            middle += [(base + opens, 0.0), *border, (base + closed, 0.0)]
        road.manhole(base + 24.0, -1.9)
        road.manhole(base + 84.0, 2.6)
        road.repair(base + 50.0, base + 60.0, -3.6, -1.9, 1.35)
        road.repair(base + 100.0, base + 108.0, 0.9, 2.6, 0.70)
        road.trees(base + 6.0, base + MODULE - 3.0, edge + 2.6, 13.0)
        road.trees(base + 11.0, base + MODULE - 3.0, -edge - 2.6, 17.0)
        road.poles(base + 22.0, base + MODULE, -edge - 0.6, 34.0)
    road.line("edge line", 7, half, 0.0, length, width=_LINE)
    road.line("edge line", 8, -half, 0.0, length, width=_LINE)
    left, right = (_cut([*middle, (middle[-1][0] + MODULE, 0.0)], length) for middle in middles)
    road.lane(1, -1, *((s, (d + half) / 2, half - d) for s, d in left))
    road.lane(2, 1, *((s, -(d + half) / 2, half - d) for s, d in right))
    return road.scene(name, sidewalk(1, edge, curb_height, lowered), sidewalk(-1, edge, curb_height, lowered),
                      [(1, -2.35, 1.0), (-1, 2.35, 1.1)], gutter)


def _cut(places, end):
    """(station, offset) places with increasing stations, cut at a station."""
    stations, offsets = np.array(places).T
    kept = [(s, d) for s, d in places if s < end]
    return [*kept, (end, float(np.interp(end, stations, offsets)))] if len(kept) < len(places) else kept


# A lane of 5.8 m between two edge lines, driven in its middle, with arrows there; one of 7 m, as broad as two; the same without arrows, driven half a
# metre right of its middle: it might as well be two lanes
one_lane = partial(_between_edge_lines, "one-lane", 5.8, True, 0.0)
wide_lane = partial(_between_edge_lines, "wide-lane", 7.0, True, 0.0)
beside_middle = partial(_between_edge_lines, "beside-middle", 7.0, True, -0.5)
# Two lanes, one each way, of which only the right one was driven: without a line between, and parted by a solid one
no_centre_line = partial(_between_edge_lines, "no-centre-line", 7.0, False, -1.75)
solid_centre_line = partial(_between_edge_lines, "solid-centre-line", 7.0, False, -1.75, centre=(1.0, 0.0))
# A lane each way, held apart by an island of paint that opens from the centre line and closes again; an island on one side of the middle alone, with
# thin bars far apart
hatched_island = partial(_around_island, "hatched-island", _ISLAND, (1.0, 1.0), 0.5, 1.0)
one_sided_island = partial(_around_island, "one-sided-island", (34.0, 50.0, 66.0, 94.0), (1.7, 0.0), 0.3, 1.7)
