"""Collects the markings and objects of a simulated street."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..parts.axis import RoadAxis, winding_road
from ..parts.beside import PIECE, RAIL_PIECE, USUAL, RunningThing, rail_of, straight_pieces
from ..parts.materials import Texture
from ..parts.obstacles import Rail, standing
from ..parts.paint import Marking, Paint, PaintedFigure, PaintedLine
from ..parts.sides import Side
from .street import Lane, Scene

MODULE = 120.0  # m, length after which the objects of a street repeat
_RUN_IN = 70.0   # m of road before station 0


class SceneBuilder:
    """Collects markings and objects of one road; everything follows from the seed."""

    def __init__(self, length: float, seed: int, radius: float):
        self.length = length
        self.random = np.random.default_rng([seed, 1])
        self.axis = RoadAxis(winding_road(length, radius, run_in=_RUN_IN), -_RUN_IN, np.radians(68.0))
        self.texture = Texture(seed)
        self.markings: list[Marking] = []
        self.manholes: list[tuple[float, float, float]] = []
        self.repairs: list[tuple[float, float, float, float, float]] = []
        self.objects: list[tuple[str, float, float, tuple[float, ...]]] = []
        self.lanes: list[Lane] = []
        self.running: list[tuple[str, float, float, float, float]] = []

    def modules(self) -> np.ndarray:
        """Stations at which the objects of the street repeat, m."""
        return np.arange(0.0, self.length, MODULE)

    def line(self, kind: str, line: int, offset: float, start: float, end: float, width: float = 0.15,
             dash: tuple[float, float] | None = None) -> None:
        """Add a line along the road, cut at its ends."""
        start, end = max(start, 0.0), min(end, self.length)
        if end - start > 0.5:
            self.markings.append(PaintedLine(kind, line, ((start, offset), (end, offset)), width, dash, self.random.uniform(0.05, 0.22)))

    def tapered(self, kind: str, line: int, places: Sequence[tuple[float, float]], width: float = 0.12) -> None:
        """Add a solid line through (station, offset) places, cut at the end of the road."""
        places = [place for place in places if 0.0 <= place[0] <= self.length]
        if len(places) > 1:
            self.markings.append(PaintedLine(kind, line, tuple(places), width, None, self.random.uniform(0.05, 0.22)))

    def figure(self, kind: str, *polygons: np.ndarray) -> None:
        """Add those polygons of a marking that lie on the road."""
        inside = tuple(p for p in polygons if p[:, 0].min() >= 0 and p[:, 0].max() <= self.length)
        if inside:
            self.markings.append(PaintedFigure(kind, None, inside, self.random.uniform(0.08, 0.25)))

    def lane(self, number: int, direction: int, *places: tuple[float, float, float]) -> None:
        """Add a lane through (station, offset, width) places, cut at the end of the road."""
        stations, offsets, widths = np.array(places, dtype=float).T
        end = min(stations[-1], self.length)
        if end - stations[0] < 2.0:
            return
        before = stations < end
        self.lanes.append(Lane(number, direction, np.append(stations[before], end),
                               *(np.append(values[before], np.interp(end, stations, values)) for values in (offsets, widths))))

    def manhole(self, station: float, offset: float, radius: float = 0.35) -> None:
        """Add a cover of cast iron."""
        if station < self.length:
            self.manholes.append((station, offset, radius))

    def repair(self, start: float, end: float, right: float, left: float, factor: float) -> None:
        """Add a patch of asphalt that is so many times as bright."""
        self.repairs.append((start, end, right, left, factor))

    def parked_cars(self, start: float, end: float, curb_offset: float, taken: float = 0.75) -> None:
        """Add a row of cars beside the curb at `curb_offset`, with some places empty."""
        sign, station = np.sign(curb_offset), start
        while station + 5.2 < min(end, self.length):
            length, width = self.random.uniform(3.9, 4.8), self.random.uniform(1.70, 1.86)
            gap, brightness, height = self.random.uniform(0.15, 0.40), self.random.uniform(0.10, 0.55), self.random.uniform(1.42, 1.62)
            if self.random.random() < taken:
                self.objects.append(("car", station + 2.6, curb_offset - sign * (gap + width / 2), (length, width, height, brightness)))
            station += length + self.random.uniform(0.8, 2.0)

    def trees(self, start: float, end: float, offset: float, spacing: float, crown: tuple[float, float] = (1.5, 2.2)) -> None:
        """Add a row of trees whose crowns have radii in a range, m."""
        for station in np.arange(start, min(end, self.length), spacing):
            tree_offset = offset + self.random.uniform(-0.2, 0.2)
            shape = (self.random.uniform(0.10, 0.17), self.random.uniform(*crown), self.random.uniform(1.2, 1.7), self.random.uniform(3.6, 4.4))
            self.objects.append(("tree", station + self.random.uniform(-1.0, 1.0), tree_offset, shape))

    def poles(self, start: float, end: float, offset: float, spacing: float, height: float = 6.0) -> None:
        """Add a row of poles."""
        for station in np.arange(start, min(end, self.length), spacing):
            self.objects.append(("pole", station, offset, (0.09, height)))

    def running_along(self, kind: str, start: float, end: float, offset: float, height: float = 0.0) -> None:
        """Add a guard_rail, or a thing of USUAL, whose face towards the road has an offset; cut at the end of the road, 0 is its usual height."""
        end = min(end, self.length)
        if end - start > 2 * PIECE:
            self.running.append((kind, start, end, offset, Rail.high if kind == "guard_rail" else height or USUAL[kind][0]))

    def scene(self, name: str, left: Side, right: Side, passes: list[tuple[int, float, float]], gutter: float) -> Scene:
        """The Scene of what was collected, between two sides."""
        paint = Paint(self.markings, self.texture)
        scene = Scene(name, self.axis, self.length, left, right, paint, self.texture, [], self.lanes, passes, gutter_width=gutter)
        scene.manholes = np.array(self.manholes).reshape(-1, 3)
        scene.repairs = np.array(self.repairs).reshape(-1, 5)
        for kind, s, d, shape in self.objects:
            x, y, z = (float(value[0]) for value in scene.to_map(np.array([s]), np.array([d])))
            scene.obstacles += standing(kind, x, y, z, float(self.axis.heading(np.array([s]))[0]), shape)
        for kind, start, end, offset, height in self.running:
            count = int(round((end - start) / (RAIL_PIECE if kind == "guard_rail" else PIECE)))
            stations = np.linspace(start, end, max(count, 1) + 1)
            foot = np.column_stack(scene.to_map(stations, offset))
            scene.obstacles += rail_of(foot) if kind == "guard_rail" else straight_pieces(kind, foot, 1 if offset > 0 else -1, height)
            scene.running.append(RunningThing(kind, foot, height, Rail.low if kind == "guard_rail" else 0.0, (start, end)))
        return scene
