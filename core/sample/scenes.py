"""The three simulated streets: an ordinary street, a country road and a wide city street."""

from __future__ import annotations

import numpy as np

from .obstacles import Car, Crown, Post, car_bodies
from .paint import Paint, PaintedFigure, PaintedLine, hatching, rectangle, straight_arrow, turn_arrow, zebra_bars
from .street import LABEL, Lane, RoadAxis, Scene, Texture, ditch, sidewalk, winding_road

_MODULE = 120.0  # m, length after which the objects of a street repeat
_RUN_IN = 70.0   # m of road before station 0


def build_scene(name: str, length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """Build a scene.

    Parameters
    ----------
    name : street, rural or urban
    length : m of road
    seed : of all random numbers
    radius : m, of the bends
    curb_height : m
    gutter : m, width of a concrete gutter along the curbs

    Returns
    -------
    Scene
    """
    return {"street": _street, "rural": _rural, "urban": _urban}[name](length, seed, radius, curb_height, gutter)


class _SceneBuilder:
    """Collects markings and objects of one road; everything follows from the seed."""

    def __init__(self, length: float, seed: int, radius: float):
        self.length = length
        self.random = np.random.default_rng([seed, 1])
        self.axis = RoadAxis(winding_road(length, radius, run_in=_RUN_IN), -_RUN_IN, np.radians(68.0))
        self.texture = Texture(seed)
        self.markings: list[PaintedLine | PaintedFigure] = []
        self.manholes: list[tuple[float, float, float]] = []
        self.repairs: list[tuple[float, float, float, float, float]] = []
        self.objects: list[tuple[str, float, float, tuple[float, ...]]] = []
        self.lanes: list[Lane] = []

    def modules(self):
        return np.arange(0.0, self.length, _MODULE)

    def line(self, kind, line, offset, start, end, width=0.15, dash=None):
        start, end = max(start, 0.0), min(end, self.length)
        if end - start > 0.5:
            self.markings.append(PaintedLine(kind, line, offset, width, start, end, dash, self.random.uniform(0.05, 0.22)))

    def figure(self, kind, *polygons):
        inside = tuple(p for p in polygons if p[:, 0].min() >= 0 and p[:, 0].max() <= self.length)
        if inside:
            self.markings.append(PaintedFigure(kind, None, inside, self.random.uniform(0.08, 0.25)))

    def lane(self, number, direction, *places):
        """Add a lane through (station, offset) places, cut at the end of the road."""
        stations, offsets = np.array(places, dtype=float).T
        end = min(stations[-1], self.length)
        if end - stations[0] < 2.0:
            return
        before = stations < end
        self.lanes.append(Lane(number, direction, np.append(stations[before], end),
                               np.append(offsets[before], np.interp(end, stations, offsets))))

    def manhole(self, station, offset, radius=0.35):
        if station < self.length:
            self.manholes.append((station, offset, radius))

    def repair(self, start, end, right, left, factor):
        self.repairs.append((start, end, right, left, factor))

    def parked_cars(self, start, end, curb_offset, taken=0.75):
        """Add a row of cars beside the curb at `curb_offset`, with some places empty."""
        sign, at = np.sign(curb_offset), start
        while at + 5.2 < min(end, self.length):
            length, width = self.random.uniform(3.9, 4.8), self.random.uniform(1.70, 1.86)
            gap, brightness, height = self.random.uniform(0.15, 0.40), self.random.uniform(0.10, 0.55), self.random.uniform(1.42, 1.62)
            if self.random.random() < taken:
                self.objects.append(("car", at + 2.6, curb_offset - sign * (gap + width / 2), (length, width, height, brightness)))
            at += length + self.random.uniform(0.8, 2.0)

    def trees(self, start, end, offset, spacing, crown=(1.5, 2.2)):
        for station in np.arange(start, min(end, self.length), spacing):
            place = offset + self.random.uniform(-0.2, 0.2)
            shape = (self.random.uniform(0.10, 0.17), self.random.uniform(*crown), self.random.uniform(1.2, 1.7), self.random.uniform(3.6, 4.4))
            self.objects.append(("tree", station + self.random.uniform(-1.0, 1.0), place, shape))

    def poles(self, start, end, offset, spacing, height=6.0):
        for station in np.arange(start, min(end, self.length), spacing):
            self.objects.append(("pole", station, offset, (0.09, height)))

    def scene(self, name, left, right, passes, gutter):
        paint = Paint(self.markings, self.texture)
        scene = Scene(name, self.axis, self.length, left, right, paint, self.texture, [], self.lanes, passes, gutter_width=gutter)
        scene.manholes = np.array(self.manholes).reshape(-1, 3)
        scene.repairs = np.array(self.repairs).reshape(-1, 5)
        for kind, s, d, shape in self.objects:
            x, y, z = (float(value[0]) for value in scene.to_map(np.array([s]), np.array([d])))
            if kind == "car":
                scene.obstacles.append(Car(x, y, z, float(self.axis.heading(np.array([s]))[0]), car_bodies(*shape)))
            elif kind == "pole":
                scene.obstacles.append(Post(x, y, z, z + shape[1], shape[0], LABEL["pole"], 0.35))
            else:
                trunk, reach, half, middle = shape
                scene.obstacles.append(Post(x, y, z, z + middle, trunk, LABEL["tree"], 0.18))
                scene.obstacles.append(Crown(x, y, z + middle, reach, half, z + middle + half))
        return scene


def _street(length, seed, radius, curb_height, gutter):
    """Two lanes, parked cars on the right; from 72 m of each module on a third lane replaces the cars."""
    road = _SceneBuilder(length, seed, radius)
    left_edge, right_edge, zebra = 4.0, 6.0, (24.0, 28.0)
    lowered_left, lowered_right = [], []
    for base in road.modules():
        z0, z1 = base + zebra[0], base + zebra[1]
        stop_right, stop_left = z0 - 2.0, z1 + 2.0
        lowered_left += [(z0 - 0.5, z1 + 0.5), (base + 42.0, base + 47.0)]
        lowered_right += [(z0 - 0.5, z1 + 0.5), (base + 96.0, base + 101.0)]
        road.line("edge line", 1, 3.5, base, z0 - 0.5)
        road.line("edge line", 1, 3.5, stop_left + 0.4, base + _MODULE)
        road.line("centre line", 2, 0.15, base, stop_right)
        road.line("centre line", 3, -0.15, base, stop_right)
        road.line("centre line", 4, 0.0, stop_left + 0.4, base + _MODULE, dash=(4.0, 6.0))
        road.line("edge line", 5, -3.5, base, stop_right)
        road.line("edge line", 5, -3.5, z1 + 0.5, base + 68.0)
        road.line("lane line", 6, -2.95, base + 72.0, base + 114.0, dash=(2.0, 4.0))
        road.line("edge line", 7, -5.75, base + 72.0, base + 114.0)
        road.figure("stop line", rectangle(stop_right, stop_right + 0.4, -3.4, -0.3))
        road.figure("stop line", rectangle(stop_left, stop_left + 0.4, 0.15, 3.4))
        road.figure("zebra crossing", *zebra_bars(z0, z1, -right_edge + 0.3, left_edge - 0.3))
        road.figure("arrow", turn_arrow(base + 82.0, -4.35, 1))
        road.figure("arrow", straight_arrow(base + 82.0, -1.5, 1))
        road.lane(2, 1, (base, -1.825), (stop_right, -1.825), (z1 + 0.5, -1.75), (base + 68.0, -1.75))
        road.lane(2, 1, (base + 72.0, -1.475), (base + 114.0, -1.475))
        road.lane(3, 1, (base + 72.0, -4.35), (base + 114.0, -4.35))
        road.manhole(base + 14.0, -1.0)
        road.manhole(base + 54.0, 2.1)
        road.manhole(base + 91.0, -4.6, 0.40)
        road.repair(base + 34.0, base + 43.5, 0.6, 2.4, 1.45)
        road.repair(base + 57.0, base + 63.0, -3.2, -2.1, 0.68)
        road.repair(base + 99.0, base + 111.0, -5.2, -3.6, 1.25)
        road.parked_cars(base + 2.0, base + 17.5, -right_edge)
        road.parked_cars(base + 33.0, base + 69.0, -right_edge)
        road.trees(base + 6.0, base + _MODULE - 3.0, left_edge + 2.6, 12.0)
        road.trees(base + 10.0, base + _MODULE - 3.0, -right_edge - 2.8, 16.0)
        road.poles(base + 12.0, base + _MODULE, left_edge + 0.55, 30.0)
        road.poles(base + 31.0, base + _MODULE, -right_edge - 0.55, 35.0)
    _through_lane(road, -1, 1.825, 1.75, zebra)
    left = sidewalk(1, left_edge, curb_height - 0.01, lowered_left)
    right = sidewalk(-1, right_edge, curb_height + 0.01, lowered_right)
    return road.scene("street", left, right, [(1, -1.8, 1.0)], gutter)


def _through_lane(road, direction, beside_double, beside_single, zebra):
    """The left lane, through all crossings; the line beside it changes between double and single."""
    places = [(0.0, beside_double)]
    for base in road.modules():
        places += [(base + 4.0, beside_double), (base + zebra[0] - 2.0, beside_double),
                   (base + zebra[1] + 2.4, beside_single), (base + _MODULE - 4.0, beside_single)]
    road.lane(1, direction, *places, (places[-1][0] + 4.0, beside_single))


def _rural(length, seed, radius, curb_height, gutter):
    """A country road: edge lines only, a shoulder and a ditch on both sides."""
    road = _SceneBuilder(length, seed, 1.5 * radius)
    road.line("edge line", 1, 3.10, 0.0, length, width=0.12)
    road.line("edge line", 2, -3.10, 0.0, length, width=0.12)
    road.lane(1, -1, (0.0, 1.55), (length, 1.55))
    road.lane(2, 1, (0.0, -1.55), (length, -1.55))
    for base in road.modules():
        road.repair(base + 20.0, base + 31.0, -2.6, -0.6, 1.35)
        road.repair(base + 70.0, base + 76.0, 0.4, 2.3, 0.70)
        road.trees(base + 9.0, base + _MODULE, 9.6, 17.0, crown=(1.9, 2.9))
        road.trees(base + 3.0, base + _MODULE, -10.2, 23.0, crown=(1.9, 2.9))
        road.poles(base + 15.0, base + _MODULE, -4.7, 50.0, height=1.0)  # delineators
        road.poles(base + 15.0, base + _MODULE, 4.7, 50.0, height=1.0)
    return road.scene("rural", ditch(1, 3.5), ditch(-1, 3.5), [(1, -1.5, 1.0)], 0.0)


def _urban(length, seed, radius, curb_height, gutter):
    """Four lanes with a double centre line, driven in both directions; parked cars on the right."""
    road = _SceneBuilder(length, seed, radius)
    left_edge, right_edge, zebra = 7.0, 9.2, (52.0, 57.0)
    lowered = []
    for base in road.modules():
        z0, z1, end = base + zebra[0], base + zebra[1], base + _MODULE
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
    for number, direction, offset in ((1, -1, 4.975), (2, -1, 1.75), (3, 1, -1.75), (4, 1, -4.975)):
        road.lane(number, direction, (0.0, offset), (length, offset))
    left = sidewalk(1, left_edge, curb_height, lowered)
    right = sidewalk(-1, right_edge, curb_height, lowered)
    return road.scene("urban", left, right, [(1, -1.7, 1.0), (-1, 4.9, 1.12)], gutter)
