"""A road laid out in the plane, with all objects on and beside it, for the scanners and for the truth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely

from ..parts.materials import LABEL, Texture
from ..parts.scene import Hits
from ..parts.truth import VERTEX_STEP, TruePlaces, Truth, densified
from .ground import Ground
from .marks import Areas, PlanPaint
from .path import Path
from .trace import trace

_OBLIQUE = 1.45   # m over the ground to the scanner, per m from the track: planes turned by 45 degrees


@dataclass(frozen=True)
class PlanLane:
    """A lane along a path, between two borders."""

    number: int   # number, road: of the lane, and of the road it belongs to
    road: int
    path: Path
    direction: int   # 1 along the path, -1 against it
    stations: np.ndarray   # (K,) m along the path
    left: np.ndarray   # left, right: (K,) m, offsets of its borders from the path, left and right of the path
    right: np.ndarray


@dataclass(frozen=True)
class Track:
    """What a vehicle follows: a path over the terrain."""

    path: Path   # Path, driven from station 0
    ground: Ground

    @property
    def length(self) -> float:
        """m, of the surveyed stretch."""
        return self.path.end

    def place(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and y (m, local) at stations and offsets."""
        x, y = self.path.at(s, d).T
        return x, y

    def under(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Height of the terrain (m), its slope ahead and its slope to the left (m per m)."""
        z, east, north = self.ground.terrain.at(*self.place(s, d))
        heading = self.path.heading(s)
        return z, east * np.cos(heading) + north * np.sin(heading), north * np.cos(heading) - east * np.sin(heading)


@dataclass
class PlanScene:
    """A plan. Its points have x and y (m, local) in the place of station and offset.

    rails : ((K, 2) m, places along a guard rail; heights of its top and of its lower edge above the ground, m) of each
    """

    name: str   # of the scene
    ground: Ground
    carriageway: shapely.Polygon   # polygon, m, local
    area: shapely.Polygon   # polygon of the surveyed area
    where: list[np.ndarray]   # (K,) for each ring of the ground: main, side_street, corner or island
    edges: list[np.ndarray]   # (K,) for each ring: curb, dropped or pavement
    paint: PlanPaint
    texture: Texture
    lanes: list[PlanLane]
    ways: list[tuple[Track, float]]   # list of (Track, factor of the speed), one for each pass
    obstacles: list[Any]   # list of Solid, Post, Crown and Rail
    patches: list[np.ndarray] = field(default_factory=list)   # (n, 2) outlines of repaired asphalt
    patch_factors: list[float] = field(default_factory=list)   # of its brightness
    manholes: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))   # (M, 3) m, x, y and radius
    gutter_width: float = 0.0   # m, concrete strip along the curb
    rails: list[tuple[np.ndarray, float, float]] = field(default_factory=list)

    def __post_init__(self):
        self._patches = Areas(self.patches, np.arange(len(self.patches), dtype=np.int16))
        self._kept = shapely.buffer(self.area, 0.3)
        shapely.prepare(self._kept)

    def passes_driven(self) -> list[tuple[Track, int, float, float]]:
        """(what is followed, direction, offset in m, factor of the speed) of each pass."""
        return [(way, 1, 0.0, haste) for way, haste in self.ways]

    def meet(self, origin: np.ndarray, direction: np.ndarray, station: float, reach: float) -> Hits:
        """Intersect pulses with the ground: (3, N) local origins, m, and unit directions; `station` is not needed."""
        distance = trace(self.ground, origin, direction, _OBLIQUE * reach)
        count = len(distance)
        hits = Hits(distance, np.zeros(count), np.zeros(count), np.zeros(count), np.zeros(count, dtype=np.int16),
                    np.zeros(count, dtype=np.uint8), np.zeros(count))
        returns = np.flatnonzero(np.isfinite(distance))
        x, y, _ = origin[:, returns] + distance[returns] * direction[:, returns]
        surface = self.ground.at(x, y)
        hits.station[returns], hits.offset[returns], hits.strip[returns] = x, y, surface.strip
        facing = surface.slope_x * direction[0, returns] + surface.slope_y * direction[1, returns] - direction[2, returns]
        hits.cosine[returns] = facing / np.sqrt(1.0 + surface.slope_x**2 + surface.slope_y**2)
        return hits

    def labels(self, strip: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) uint8 labels of places on the ground, whose strips are known."""
        label = self.ground.labels[strip]
        road = np.flatnonzero(strip == 0)
        number, fresh = self.paint.at(x[road], y[road])
        if self.gutter_width:
            label[road[self.ground.beyond_edge(x[road], y[road])[0] > -self.gutter_width]] = LABEL["gutter"]
        label[road[number >= 0]] = LABEL["worn paint"]
        label[road[fresh]] = LABEL["paint"]
        for at_x, at_y, radius in self.manholes:
            label[road[(x[road] - at_x) ** 2 + (y[road] - at_y) ** 2 <= radius**2]] = LABEL["manhole"]
        return label

    def repaired(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) factors of the brightness of asphalt."""
        return np.append(self.patch_factors, 1.0)[self._patches.number(x, y)]

    def located(self, x: np.ndarray, y: np.ndarray, station: float) -> tuple[np.ndarray, np.ndarray]:
        """The coordinates of places in the scene: x and y themselves."""
        return x, y

    def surveyed(self, x: np.ndarray, y: np.ndarray, reach: float) -> np.ndarray:
        """(N,) bool, places that belong to the survey."""
        return shapely.contains_xy(self._kept, x, y)

    def height(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """True height of the ground at (N,) places, m."""
        return self.ground.height(x, y)

    def truth(self, origin: Sequence[float], crs: str) -> Truth:
        """The true layers, in map coordinates, as far as the plan is surveyed."""
        def on_map(places, rise=0.0):
            return np.column_stack([places, self.ground.height(*places.T) + rise]) + origin

        return TruePlaces(_boundaries(self, on_map), _markings(self, on_map), _driving_lines(self, on_map), _surface(self, on_map),
                          _lanes(self, on_map), _roadside(self, on_map)).layers(crs)


# The truth of a plan, as layers in map coordinates.

_FACE = 0.025    # m across the face of a curb
_LEAST = 4       # vertices of an edge that is worth a line


def _boundaries(scene, on_map):
    """Bottoms and tops of curbs, and edges of the pavement, in pieces of one kind."""
    for ring, height, kinds, edge in zip(scene.ground.rings, scene.ground.heights, scene.where, scene.edges):
        for rows in _runs(ring, kinds, edge, scene.area):
            bottom, tall = ring[rows], height[rows]
            side = _side(scene, bottom[len(bottom) // 2])
            lines = [("bottom", on_map(bottom))]
            if edge[rows[0]] != "pavement":
                top = bottom + _FACE * _outward(ring)[rows]
                lines.append(("top", np.column_stack([on_map(top)[:, :2], lines[0][1][:, 2] + tall])))
            for part, places in lines:
                yield places, dict(side=side, part=part, kind=str(kinds[rows[0]]), edge=str(edge[rows[0]]), height_m=float(np.median(tall)))


def _outward(ring):
    """(K, 2) unit vectors away from the carriageway, at the vertices of a ring."""
    way = np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0)
    return np.column_stack([way[:, 1], -way[:, 0]]) / np.hypot(way[:, 0], way[:, 1])[:, None]


def _runs(ring, where, edge, area):
    """Indices of neighbouring vertices in the area with one kind of edge; where two kinds meet, both have the vertex between."""
    count = len(ring)
    inside = shapely.contains_xy(area, ring)
    name = np.array([f"{a}|{b}" if in_area else "" for a, b, in_area in zip(where, edge, inside)])
    changes = np.flatnonzero(name != np.roll(name, 1))
    if len(changes) == 0:
        return [np.append(np.arange(count), 0)] if inside.all() else []
    runs = []
    for start, end in zip(changes, np.append(changes[1:], changes[0] + count)):
        if inside[start]:
            last = end if inside[end % count] else end - 1
            if last - start >= _LEAST:
                runs.append(np.arange(start, last + 1) % count)
    return runs


def _side(scene, place):
    """Side of a place as seen from the pass that drove nearest, in its direction of travel."""
    nearest = min((way.path.locate(place[None]) for way, _ in scene.ways), key=lambda place: abs(place[1][0]))
    return "left" if nearest[1][0] > 0 else "right"


def _markings(scene, on_map):
    for mark in scene.paint.markings:
        for outline in mark.outlines:
            yield on_map(densified(outline)), {
                "class": mark.kind, "line": mark.line, "pattern": mark.pattern, "width_m": mark.width, "wear": float(mark.wear)}


def _about(lane):
    return dict(road=lane.road, lane=lane.number, direction=lane.direction, station_m=float(lane.stations[0]), end_m=float(lane.stations[-1]))


def _driving_lines(scene, on_map):
    for lane in scene.lanes:
        middle = (lane.left + lane.right) / 2
        bend = lane.path.curvature(lane.stations)
        yield on_map(lane.path.at(lane.stations, middle)), float(np.abs(bend / (1.0 - bend * middle)).max()), _about(lane)


def _surface(scene, on_map):
    for part in shapely.get_parts(shapely.intersection(scene.carriageway, scene.area)):
        ring, *holes = (on_map(densified(shapely.get_coordinates(ring)[:-1])) for ring in (part.exterior, *part.interiors))
        yield ring, holes


def _lanes(scene, on_map):
    for lane in scene.lanes:
        yield *(on_map(lane.path.at(lane.stations, border)) for border in (lane.left, lane.right)), _about(lane)


def _roadside(scene, on_map):
    """Guard rails, as far as they stand in the surveyed area."""
    for places, height, low in scene.rails:
        for part in shapely.get_parts(shapely.line_merge(shapely.intersection(shapely.linestrings(places), scene.area))):
            foot = shapely.get_coordinates(shapely.segmentize(part, VERTEX_STEP))
            yield on_map(foot), dict(kind="guard_rail", side=_side(scene, foot[len(foot) // 2]), height_m=height, foot_m=low)
