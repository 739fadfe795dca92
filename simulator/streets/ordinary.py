"""Three simulated streets: an ordinary street, a country road and a wide city street."""

from __future__ import annotations

from ..parts.paint import hatching, rectangle, straight_arrow, turn_arrow, zebra_bars
from ..parts.sides import ditch, sidewalk
from .builder import MODULE, SceneBuilder
from .street import Scene


def street(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """Two lanes, parked cars on the right; from 72 m of each module on a third lane replaces the cars."""
    road = SceneBuilder(length, seed, radius)
    left_edge, right_edge, zebra = 4.0, 6.0, (24.0, 28.0)
    lowered_left, lowered_right = [], []
    for base in road.modules():
        z0, z1 = base + zebra[0], base + zebra[1]
        stop_right, stop_left = z0 - 2.0, z1 + 2.0
        lowered_left += [(z0 - 0.5, z1 + 0.5), (base + 42.0, base + 47.0)]
        lowered_right += [(z0 - 0.5, z1 + 0.5), (base + 96.0, base + 101.0)]
        road.line("edge line", 1, 3.5, base, z0 - 0.5)
        road.line("edge line", 1, 3.5, stop_left + 0.4, base + MODULE)
        road.line("centre line", 2, 0.15, base, stop_right)
        road.line("centre line", 3, -0.15, base, stop_right)
        road.line("centre line", 4, 0.0, stop_left + 0.4, base + MODULE, dash=(4.0, 6.0))
        road.line("edge line", 5, -3.5, base, stop_right)
        road.line("edge line", 5, -3.5, z1 + 0.5, base + 68.0)
        road.line("lane line", 6, -2.95, base + 72.0, base + 114.0, dash=(2.0, 4.0))
        road.line("edge line", 7, -5.75, base + 72.0, base + 114.0)
        road.figure("stop line", rectangle(stop_right, stop_right + 0.4, -3.4, -0.3))
        road.figure("stop line", rectangle(stop_left, stop_left + 0.4, 0.15, 3.4))
        road.figure("zebra crossing", *zebra_bars(z0, z1, -right_edge + 0.3, left_edge - 0.3))
        road.figure("arrow", turn_arrow(base + 82.0, -4.35, 1))
        road.figure("arrow", straight_arrow(base + 82.0, -1.5, 1))
        road.lane(2, 1, (base, -1.825, 3.35), (stop_right, -1.825, 3.35), (z1 + 0.5, -1.75, 3.5), (base + 68.0, -1.75, 3.5))
        road.lane(2, 1, (base + 72.0, -1.475, 2.95), (base + 114.0, -1.475, 2.95))
        road.lane(3, 1, (base + 72.0, -4.35, 2.8), (base + 114.0, -4.35, 2.8))
        road.manhole(base + 14.0, -1.0)
        road.manhole(base + 54.0, 2.1)
        road.manhole(base + 91.0, -4.6, 0.40)
        road.repair(base + 34.0, base + 43.5, 0.6, 2.4, 1.45)
        road.repair(base + 57.0, base + 63.0, -3.2, -2.1, 0.68)
        road.repair(base + 99.0, base + 111.0, -5.2, -3.6, 1.25)
        road.parked_cars(base + 2.0, base + 17.5, -right_edge)
        road.parked_cars(base + 33.0, base + 69.0, -right_edge)
        road.trees(base + 6.0, base + MODULE - 3.0, left_edge + 2.6, 12.0)
        road.trees(base + 10.0, base + MODULE - 3.0, -right_edge - 2.8, 16.0)
        road.poles(base + 12.0, base + MODULE, left_edge + 0.55, 30.0)
        road.poles(base + 31.0, base + MODULE, -right_edge - 0.55, 35.0)
    _through_lane(road, -1, 1.825, 1.75, zebra)
    left = sidewalk(1, left_edge, curb_height - 0.01, lowered_left)
    right = sidewalk(-1, right_edge, curb_height + 0.01, lowered_right)
    return road.scene("street", left, right, [(1, -1.8, 1.0)], gutter)


def _through_lane(road, direction, beside_double, beside_single, zebra):
    """The left lane, through all crossings; the line beside it changes between double and single."""
    places = [(0.0, beside_double)]
    for base in road.modules():
        places += [(base + 4.0, beside_double), (base + zebra[0] - 2.0, beside_double),
                   (base + zebra[1] + 2.4, beside_single), (base + MODULE - 4.0, beside_single)]
    # from the line beside it to the edge line at 3.5 m
    road.lane(1, direction, *((s, d, 2 * (3.5 - d)) for s, d in [*places, (places[-1][0] + 4.0, beside_single)]))


def rural(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """A country road: edge lines only, a shoulder and a ditch on both sides."""
    road = SceneBuilder(length, seed, 1.5 * radius)
    road.line("edge line", 1, 3.10, 0.0, length, width=0.12)
    road.line("edge line", 2, -3.10, 0.0, length, width=0.12)
    road.lane(1, -1, (0.0, 1.55, 3.1), (length, 1.55, 3.1))
    road.lane(2, 1, (0.0, -1.55, 3.1), (length, -1.55, 3.1))
    for base in road.modules():
        road.repair(base + 20.0, base + 31.0, -2.6, -0.6, 1.35)
        road.repair(base + 70.0, base + 76.0, 0.4, 2.3, 0.70)
        road.trees(base + 9.0, base + MODULE, 9.6, 17.0, crown=(1.9, 2.9))
        road.trees(base + 3.0, base + MODULE, -10.2, 23.0, crown=(1.9, 2.9))
        road.poles(base + 15.0, base + MODULE, -4.7, 50.0, height=1.0)  # delineators
        road.poles(base + 15.0, base + MODULE, 4.7, 50.0, height=1.0)
    return road.scene("rural", ditch(1, 3.5), ditch(-1, 3.5), [(1, -1.5, 1.0)], 0.0)


def urban(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """Four lanes with a double centre line, driven in both directions; parked cars on the right."""
    road = SceneBuilder(length, seed, radius)
    left_edge, right_edge, zebra = 7.0, 9.2, (52.0, 57.0)
    lowered = []
    for base in road.modules():
        z0, z1, end = base + zebra[0], base + zebra[1], base + MODULE
        before, after = z0 - 2.4, z1 + 2.4
        lowered.append((z0 - 0.5, z1 + 0.5))
        for number, offset, kind in ((1, 6.6, "edge line"), (3, 0.15, "centre line"), (4, -0.15, "centre line"), (6, -6.6, "edge line")):
            road.line(kind, number, offset, base, before)
            road.line(kind, number, offset, after, end)
        for number, offset in ((2, 3.35), (5, -3.35)):
            road.line("lane line", number, offset, base, before - 20.0, dash=(2.0, 4.0))
            road.line("lane line", number, offset, before - 18.0 if offset < 0 else after + 20.0, before if offset < 0 else end,
                      dash=None if offset < 0 else (2.0, 4.0))
            road.line("lane line", number, offset, after if offset > 0 else after + 2.0, after + 18.0 if offset > 0 else end,
                      dash=None if offset > 0 else (2.0, 4.0))
        road.figure("stop line", rectangle(before, before + 0.4, -6.5, -0.3))
        road.figure("stop line", rectangle(after - 0.4, after, 0.3, 6.5))
        road.figure("zebra crossing", *zebra_bars(z0, z1, -right_edge + 0.4, left_edge - 0.4))
        for offset, shape in ((-1.75, straight_arrow), (-4.975, turn_arrow)):
            road.figure("arrow", shape(before - 14.0, offset, 1))
            road.figure("arrow", shape(after + 14.0, -offset, -1))
        road.figure("hatching", *hatching(base + 30.0, base + 49.0, -right_edge + 0.5, -6.8))
        road.manhole(base + 12.0, -4.4)
        road.manhole(base + 41.0, 1.9)
        road.manhole(base + 88.0, -1.2, 0.40)
        road.repair(base + 16.0, base + 27.0, -6.0, -4.2, 1.4)
        road.repair(base + 71.0, base + 84.0, 0.8, 2.6, 0.7)
        road.parked_cars(base + 2.0, base + 29.0, -right_edge)
        road.parked_cars(base + 66.0, base + 116.0, -right_edge)
        road.trees(base + 8.0, end - 3.0, left_edge + 2.4, 13.0)
        road.trees(base + 11.0, end - 3.0, -right_edge - 2.4, 17.0)
        road.poles(base + 20.0, end, left_edge + 0.6, 30.0, height=8.0)
        road.poles(base + 5.0, end, -right_edge - 0.6, 30.0, height=8.0)
    for number, direction, offset, width in ((1, -1, 4.975, 3.25), (2, -1, 1.75, 3.2), (3, 1, -1.75, 3.2), (4, 1, -4.975, 3.25)):
        road.lane(number, direction, (0.0, offset, width), (length, offset, width))
    left = sidewalk(1, left_edge, curb_height, lowered)
    right = sidewalk(-1, right_edge, curb_height, lowered)
    return road.scene("urban", left, right, [(1, -1.7, 1.0), (-1, 4.9, 1.12)], gutter)
