"""The simulated street: its surface over station and offset, and what lies and stands on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..parts.materials import LABEL, Texture
from ..parts.scanner import LONGEST
from ..parts.scene import Hits
from ..parts.sides import Side
from ..parts.truth import VERTEX_STEP, TruePlaces, Truth, densified

if TYPE_CHECKING:
    from ..parts.axis import RoadAxis
    from ..parts.beside import RunningThing
    from ..parts.paint import Paint


@dataclass(frozen=True)
class Lane:
    """A lane and the offset of its middle, linear between stations."""

    number: int   # of the lane
    direction: int   # 1 along the axis, -1 against it
    stations: np.ndarray   # stations, offsets: (K,) m
    offsets: np.ndarray
    widths: np.ndarray   # (K,) m, between the middles of its border lines


@dataclass
class Scene:
    """A road along an axis, with all objects beside and on it.

    On the carriageway the height is grade_line(s) + fall(d). Beyond its edges the strips of each Side continue it.
    """

    name: str   # of the scene
    axis: RoadAxis
    length: float   # m from station 0
    left: Side   # left, right: Side
    right: Side
    paint: Paint
    texture: Texture
    obstacles: list[Any]   # list of Solid, Post, Crown and Rail
    lanes: list[Lane]
    passes: list[tuple[int, float, float]]   # list of (direction, offset in m, speed factor)
    crown: float = 0.02   # m per m, fall to both sides
    gutter_width: float = 0.0   # m, concrete strip along the curb
    manholes: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))   # (M, 3) m, station, offset and radius
    repairs: np.ndarray = field(default_factory=lambda: np.zeros((0, 5)))   # (R, 5) start, end, right, left (m) and factor of the brightness
    running: list[RunningThing] = field(default_factory=list)   # list of RunningThing, what runs along the road beside it

    def grade_line(self, s: np.ndarray | float) -> np.ndarray:
        """Height of the axis at stations, m: a steady climb with gentle waves."""
        return 0.006 * s + 0.25 * np.sin(s / 60.0)

    def grade(self, s: np.ndarray) -> np.ndarray:
        """Slope of the axis at stations, m per m."""
        return 0.006 + 0.25 / 60.0 * np.cos(s / 60.0)

    def fall(self, d: np.ndarray | np.float64) -> np.ndarray:
        """Height of the crowned carriageway relative to the axis at offsets, m (negative), rounded over half a metre."""
        return -self.crown * (np.sqrt(d * d + 0.25) - 0.5)

    def cross_slope(self, d: np.ndarray) -> np.ndarray:
        """Slope of the carriageway to the left at offsets, m per m."""
        return -self.crown * d / np.sqrt(d * d + 0.25)

    def carriageway(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Height of the carriageway, continued beyond its edges, m."""
        return self.grade_line(s) + self.fall(d)

    def edge_height(self, side: Side, s: np.ndarray) -> np.ndarray:
        """Height of the edge of the carriageway on one Side at stations, m."""
        return self.grade_line(s) + self.fall(np.float64(side.edge))

    def height(self, s: np.ndarray, d: np.ndarray | float) -> np.ndarray:
        """True height of the ground at stations and offsets, m."""
        s, d = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(d, dtype=float))
        z = self.carriageway(s, d)
        for side in (self.left, self.right):
            beyond = side.sign * d > side.edge
            z[beyond] = self.edge_height(side, s[beyond]) + side.rise(s[beyond], side.sign * d[beyond])
        return z

    def to_map(self, s: np.ndarray, d: np.ndarray | float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """x, y and z (m, local) of places on the ground."""
        s, d = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(d, dtype=float))
        x, y = self.axis.to_map(s, d)
        return x, y, self.height(s, d)

    def carriageway_labels(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) uint8 labels of places on the carriageway: asphalt, gutter, manhole cover, paint or worn paint."""
        label = np.full(len(s), LABEL["road"], dtype=np.uint8)
        if self.gutter_width:
            gutter = (d > self.left.edge - self.gutter_width) | (d < self.gutter_width - self.right.edge)
            label[gutter] = LABEL["gutter"]
        number, fresh = self.paint.at(s, d)
        label[number >= 0] = LABEL["worn paint"]
        label[fresh] = LABEL["paint"]
        if len(s):
            near = (self.manholes[:, 0] > s.min() - 1) & (self.manholes[:, 0] < s.max() + 1)
            for station, offset, radius in self.manholes[near]:
                label[(s - station) ** 2 + (d - offset) ** 2 <= radius**2] = LABEL["manhole"]
        return label

    def passes_driven(self) -> list[tuple[Scene, int, float, float]]:
        """(what is followed, direction, offset in m, factor of the speed) of each pass."""
        return [(self, *how) for how in self.passes]

    def place(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and y (m, local) at stations and offsets."""
        return self.axis.to_map(s, d)

    def under(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Height of the carriageway (m), its slope along the axis and its slope to the left (m per m)."""
        return self.carriageway(s, d), self.grade(s), self.cross_slope(d)

    def meet(self, origin: np.ndarray, direction: np.ndarray, station: float, reach: float) -> Hits:
        """Intersect pulses with the ground; the station of the scanner is accurate to 15 m, ground farther than `reach` from the axis is left out."""
        count = direction.shape[1]
        hits = Hits(np.full(count, np.inf), np.full(count, station), np.zeros(count), np.zeros(count),
                    np.zeros(count, dtype=np.int8), np.zeros(count, dtype=np.uint8), np.zeros(count))
        down = np.flatnonzero(direction[2] < -_GRAZING)
        rays = _Rays(self.axis, origin[:, down], direction[:, down])
        t = (rays.oz - self.grade_line(station)) / -rays.vz
        s, d = rays.at(t, np.full(len(t), station), steps=2)
        # only pulses that reach the ground on the surveyed stretch are traced further
        on_road = (t < LONGEST) & (s > -4.0) & (s < self.length + 4.0)
        on_road &= np.abs(d) < reach + 25.0
        rays, down, t, s, d = rays.some(on_road), down[on_road], t[on_road], s[on_road], d[on_road]
        for _ in range(3):
            # Newton step; the slope of the road along the ray follows from its grade and cross slope
            error = rays.oz + t * rays.vz - self.carriageway(s, d)
            ahead = rays.vx * rays.cos + rays.vy * rays.sin
            aside = rays.vy * rays.cos - rays.vx * rays.sin
            t = t - error / (rays.vz - self.grade(s) * ahead - self.cross_slope(d) * aside)
            s, d = rays.at(t, s, steps=1)
        strip = np.zeros(len(t), dtype=np.int8)
        for side in (self.left, self.right):
            beyond = np.flatnonzero(side.sign * d > side.edge)
            t[beyond], s[beyond], d[beyond], strip[beyond] = _beyond_edge(
                self, side, rays.some(beyond), t[beyond], s[beyond], d[beyond])
        good = np.flatnonzero((t < LONGEST) & (np.abs(d) <= reach) & (s > -_MARGIN) & (s < self.length + _MARGIN))
        down, strip = down[good], strip[good]
        hits.distance[down], hits.station[down], hits.offset[down] = t[good], s[good], d[good]
        hits.strip[down] = strip
        hits.cosine[down] = _incidence(self, rays.some(good), s[good], d[good], strip)
        return hits

    def labels(self, strip: np.ndarray, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) uint8 labels of places on the ground, whose strips are known: 0 the carriageway, k left and -k right of it."""
        label = np.zeros(len(strip), dtype=np.uint8)
        road = strip == 0
        label[road] = self.carriageway_labels(s[road], d[road])
        for side in (self.left, self.right):
            names = np.array([0] + [LABEL[name] for name in side.strips], dtype=np.uint8)
            off_road = strip * side.sign > 0
            label[off_road] = names[np.abs(strip[off_road])]
        return label

    def repaired(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) factors of the brightness of asphalt."""
        factors = np.ones(len(s), dtype=np.float32)
        if len(s):
            near = (self.repairs[:, 1] > s.min()) & (self.repairs[:, 0] < s.max())
            for start, end, right, left, factor in self.repairs[near]:
                factors[(s >= start) & (s <= end) & (d >= right) & (d <= left)] *= factor
        return factors

    def located(self, x: np.ndarray, y: np.ndarray, station: float) -> tuple[np.ndarray, np.ndarray]:
        """Station and offset of places near a station, m."""
        s, d, *_ = self.axis.locate(x, y, np.full(len(x), station), steps=3)
        return s, d

    def surveyed(self, s: np.ndarray, d: np.ndarray, reach: float) -> np.ndarray:
        """(N,) bool, places that belong to the survey."""
        return (s >= 0) & (s <= self.length) & (np.abs(d) <= reach)

    def truth(self, origin: Sequence[float], crs: str) -> Truth:
        """The true layers, in map coordinates."""
        def on_map(s, d):
            return np.column_stack(self.to_map(s, d)) + origin

        s = _stations(0.0, self.length)
        surface = np.vstack([on_map(s, self.left.edge), on_map(s[::-1], -self.right.edge)])
        return TruePlaces(_boundaries(self, on_map), _markings(self, on_map), _driving_lines(self, on_map), [(surface, [])],
                          _lanes(self, on_map), _roadside(self, origin)).layers(crs)


# The intersection of pulses with the ground of a simulated street.
#
# A pulse is traced to the carriageway, continued beyond its edges, by three Newton steps. If it arrives beyond an edge, the borders of the strips
# there (curb bottom, curb top and so on) are passed one after the other. The pulse hits the first strip whose outer border it reaches below the
# ground, at a place found by the secant rule. So the faces of curbs are hit, and a raised sidewalk hides the ground behind it.

_GRAZING = 0.02    # sine of the flattest downward direction that is traced
_MARGIN = 1.0      # m around the surveyed stretch, within which the ground is computed


def _beyond_edge(scene, side, rays, t, s, d):
    """Hits on the strips of one side, of pulses that pass its edge above the ground.

    Returns t, s, d and the signed number of the strip; t is inf where a pulse passes the last border above the ground.
    """
    hit_t, hit_s, hit_d = np.full(len(t), np.inf), s.copy(), d.copy()
    hit_strip = np.zeros(len(t), dtype=np.int8)
    outward = side.sign * (rays.vy * rays.cos - rays.vx * rays.sin)
    live = np.flatnonzero(outward > 0.02)
    t, s, distance, ray = t[live], s[live], side.sign * d[live], rays.some(live)
    t, s, distance = ray.reach(side, side.edge, t, s, distance, times=3)
    passing = np.flatnonzero((t > 0) & (np.abs(distance - side.edge) < 0.01))
    live, ray, t, s, distance = live[passing], ray.some(passing), t[passing], s[passing], distance[passing]
    above = ray.oz + t * ray.vz - scene.edge_height(side, s)
    for k in range(1, len(side.borders)):
        next_t, next_s, next_distance = ray.reach(side, side.borders[k], t, s, distance, times=2 if k < 3 else 3)
        # in a bend a few pulses run along a border without passing it; they are left out
        passed = (next_t >= t) & (np.abs(next_distance - side.borders[k]) < 0.01)
        ground = scene.edge_height(side, next_s) + side.border_rise(k, next_s)
        next_above = ray.oz + next_t * ray.vz - ground
        landing = np.flatnonzero(passed & (next_above <= 0))
        if len(landing):
            hits = live[landing]
            hit_t[hits], hit_s[hits], hit_d[hits] = _within_strip(
                scene, side, k - 1, ray.some(landing), (t[landing], above[landing]), (next_t[landing], next_above[landing]), s[landing])
            hit_strip[hits] = side.sign * k
        passing = np.flatnonzero(passed & (next_above > 0))
        live, ray = live[passing], ray.some(passing)
        t, s, distance, above = next_t[passing], next_s[passing], next_distance[passing], next_above[passing]
        if len(live) == 0:
            break
    return hit_t, hit_s, hit_d, hit_strip


def _within_strip(scene, side, strip, rays, near, far, s):
    """Hits of pulses on one strip, between a place above it and a place below it.

    The strip is plane except for the bend of the road and a lowered curb, so four secant steps inside the bracket leave an
    error below 0.1 mm.
    """
    (low, f0), (high, f1) = near, far
    t0, t = high, low + (high - low) * f0 / np.where(f0 > f1, f0 - f1, 1.0)
    error0, steps = f1, 2
    for _ in range(4):
        s, d = rays.at(t, s, steps)
        ground = scene.edge_height(side, s) + side.rise_in_strip(strip, s, side.sign * d)
        error = rays.oz + t * rays.vz - ground
        change = error - error0
        usable = np.abs(change) > 1e-13
        step = np.where(usable, error * (t - t0) / np.where(usable, change, 1.0), 0.0)
        t0, error0, steps = t, error, 1
        t = np.clip(t - step, low, high)
    s, d = rays.at(t, s, 1)
    return t, s, d


def _incidence(scene, rays, s, d, strip):
    """Cosine of the angle between a pulse and the normal of the ground."""
    slope = scene.cross_slope(d)
    for side in (scene.left, scene.right):
        beyond = np.flatnonzero(strip * side.sign > 0)
        slope[beyond] = side.sign * side.steepness(np.abs(strip[beyond]) - 1, s[beyond])
    grade = scene.grade(s)
    ahead = rays.vx * rays.cos + rays.vy * rays.sin
    aside = rays.vy * rays.cos - rays.vx * rays.sin
    return (grade * ahead + slope * aside - rays.vz) / np.sqrt(1.0 + slope * slope + grade * grade)


class _Rays:
    """Pulses, with the direction of the road below the place to which they were traced last."""

    def __init__(self, axis, origin, direction, cos=None, sin=None):
        self.axis, self.cos, self.sin = axis, cos, sin
        self.ox, self.oy, self.oz = origin
        self.vx, self.vy, self.vz = direction

    def some(self, which):
        """Some of the pulses, by indices or a mask."""
        if isinstance(which, np.ndarray) and which.dtype == bool:
            which = np.flatnonzero(which)
        return _Rays(self.axis, (self.ox[which], self.oy[which], self.oz[which]),
                     (self.vx[which], self.vy[which], self.vz[which]), self.cos[which], self.sin[which])

    def at(self, t, s, steps):
        """Station and offset at the distance t, from approximate stations."""
        s, d, self.cos, self.sin = self.axis.locate(self.ox + t * self.vx, self.oy + t * self.vy, s, steps)
        return s, d

    def reach(self, side, distance, t, s, away, times):
        """Distance, station and distance from the axis where pulses pass a border, from a place near it."""
        for _ in range(times):
            outward = side.sign * (self.vy * self.cos - self.vx * self.sin)
            t = t + (distance - away) / np.maximum(outward, 0.01)
            s, d = self.at(t, s, steps=2 if times > 2 else 1)
            away = side.sign * d
        return t, s, away


# The truth of the simulated street, as layers in map coordinates.

_DROPPED = 0.05   # m: lower curbs are of the kind "dropped"


def _stations(start, end):
    return np.linspace(start, end, max(2, int(np.ceil((end - start) / VERTEX_STEP)) + 1))


def _boundaries(scene, on_map):
    """Bottoms and tops of the curbs, in pieces of one kind, and the edges of the pavement where there is no curb."""
    for side, name in ((scene.left, "left"), (scene.right, "right")):
        for start, end, edge in _edge_pieces(side, scene.length):
            s = _stations(start, end)
            height = float(np.median(side.curb(s)))
            parts = [("bottom", side.borders[0]), ("top", side.borders[1])]
            for part, distance in parts[:1] if edge == "pavement" else parts:
                yield on_map(s, side.sign * distance), dict(side=name, part=part, kind="main", edge=edge, station_m=float(start), end_m=float(end),
                                                            height_m=height)


def _edge_pieces(side, length):
    if not side.curb_height:
        return [(0.0, length, "pavement")]
    s = np.arange(0.0, length + 1e-9, 0.01)
    dropped = side.curb(s) < _DROPPED
    cuts = np.concatenate([[0], np.flatnonzero(np.diff(dropped)) + 1, [len(s) - 1]])
    return [(s[a], s[b], "dropped" if dropped[a] else "curb") for a, b in zip(cuts[:-1], cuts[1:]) if b > a]


def _markings(scene, on_map):
    """Every marking as it was painted, including worn places."""
    for marking in scene.paint.markings:
        dash = getattr(marking, "dash", None)
        pattern = None if marking.line is None else "solid" if dash is None else "dashed"
        for outline in marking.outlines():
            yield on_map(*densified(outline).T), {
                "class": marking.kind, "line": marking.line, "pattern": pattern, "width_m": getattr(marking, "width", None),
                "wear": float(marking.wear), "station_m": float(outline[:, 0].min()), "end_m": float(outline[:, 0].max())}


def _about(lane, s):
    return dict(road=1, lane=lane.number, direction=lane.direction, station_m=float(s[0]), end_m=float(s[-1]))


def _driving_lines(scene, on_map):
    """Middles of the lanes."""
    for lane in scene.lanes:
        s = _stations(lane.stations[0], lane.stations[-1])
        d = np.interp(s, lane.stations, lane.offsets)
        bend = scene.axis.curvature(s)
        yield on_map(s, d), float(np.abs(bend / (1.0 - bend * d)).max()), _about(lane, s)


def _lanes(scene, on_map):
    """Lanes between the middles of their border lines."""
    for lane in scene.lanes:
        s = _stations(lane.stations[0], lane.stations[-1])
        middle, half = np.interp(s, lane.stations, lane.offsets), np.interp(s, lane.stations, lane.widths) / 2
        yield on_map(s, middle + half), on_map(s, middle - half), _about(lane, s)


def _roadside(scene, origin):
    """Walls, fences and the like; buildings are none of what is looked for along a road."""
    for structure in scene.running:
        if structure.kind != "building":
            offset = scene.axis.locate(*structure.foot[:1, :2].T, np.array([structure.stations[0]]), steps=3)[1]
            yield structure.foot + origin, dict(side="left" if offset[0] > 0 else "right", **structure.about())
