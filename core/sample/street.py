"""The simulated street: the strips on both sides, its surface over station and offset, and its materials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .paint import Paint
    from .scanner import Hits
    from .streets.axis import RoadAxis
    from .truth import Truth

LOWERED_CURB_HEIGHT = 0.02  # m, height of a curb at a driveway or crossing
_RAMP = 1.0      # m along the road from full to lowered curb
_SIZE = 512      # nodes per side of a texture, a power of two

# Objects and materials that return a pulse; their numbers are the labels of the points.
LABELS = ("nothing", "road", "paint", "worn paint", "manhole", "gutter", "curb face", "curb stone", "sidewalk",
          "shoulder", "verge", "car", "tree", "pole", "stray", "rail")
LABEL = {name: number for number, name in enumerate(LABELS)}
CARRIAGEWAY_LABELS = tuple(LABEL[name] for name in ("road", "paint", "worn paint", "manhole", "gutter"))


@dataclass(frozen=True)
class Side:
    """Strips of ground beside the carriageway, on one side of the road; each is straight across between two borders.

    Attributes
    ----------
    sign : 1 left, -1 right
    borders : (K + 1,) m from the axis, increasing; the first is the edge of the carriageway
    rises : (K + 1,) m, heights of the borders above the edge of the carriageway, without the curb
    on_curb : (K + 1,) 0 or 1, share of the height of the curb at each border
    strips : K names of the ground
    curb_height : m, 0 where there is no curb
    lowered : (start, end) stations of lowered curbs, m
    """

    sign: int
    borders: np.ndarray
    rises: np.ndarray
    on_curb: np.ndarray
    strips: tuple[str, ...]
    curb_height: float = 0.0
    lowered: tuple[tuple[float, float], ...] = ()

    @property
    def edge(self) -> float:
        """Distance of the edge of the carriageway (the curb bottom) from the axis, m."""
        return float(self.borders[0])

    def curb(self, s: np.ndarray) -> np.ndarray:
        """Height of the curb at (N,) stations, (N,) m."""
        height = np.full(np.shape(s), self.curb_height)
        for start, end in self.lowered:
            way = np.clip(np.maximum(start - s, s - end) / _RAMP, 0.0, 1.0)
            height = np.minimum(height, LOWERED_CURB_HEIGHT + (self.curb_height - LOWERED_CURB_HEIGHT) * way * way * (3 - 2 * way))
        return height

    def border_rise(self, k: np.ndarray | int, s: np.ndarray) -> np.ndarray:
        """Height of border `k` (a number or one per point) above the edge of the carriageway."""
        return self.rises[k] + self.on_curb[k] * self.curb(s)

    def rise(self, s: np.ndarray, away: np.ndarray) -> np.ndarray:
        """Height above the edge of the carriageway at distances `away` from the axis, beyond the edge."""
        strip = np.clip(np.searchsorted(self.borders, away, side="right") - 1, 0, len(self.strips) - 1)
        return self.rise_in_strip(strip, s, away)

    def rise_in_strip(self, strip: np.ndarray, s: np.ndarray, away: np.ndarray) -> np.ndarray:
        """The same on the plane of a given strip, also a little beyond its borders."""
        curb = self.curb(s)
        inner = self.rises[strip] + self.on_curb[strip] * curb
        outer = self.rises[strip + 1] + self.on_curb[strip + 1] * curb
        share = (away - self.borders[strip]) / (self.borders[strip + 1] - self.borders[strip])
        return inner + (outer - inner) * share

    def steepness(self, strip: np.ndarray | int, s: np.ndarray) -> np.ndarray:
        """Outward slope of strips at stations, m per m."""
        rise = self.border_rise(strip + 1, s) - self.border_rise(strip, s)
        return rise / (self.borders[strip + 1] - self.borders[strip])


def sidewalk(sign: int, edge: float, curb_height: float, lowered: Sequence[tuple[float, float]] = (), width: float = 3.6,
             reach: float = 24.0, face: float = 0.025) -> Side:
    """A raised curb with an inclined face, curb stone, sidewalk and verge.

    Where the curb is lowered, the sidewalk ramps down to it over its first metre.

    Parameters
    ----------
    sign : 1 left, -1 right
    edge : m from the axis to the curb bottom
    curb_height : m
    lowered : (start, end) stations of lowered curbs, m
    width : m, curb and sidewalk
    reach : m from the axis to the end of the verge
    face : m across the face of the curb

    Returns
    -------
    Side
    """
    top = edge + face
    borders = np.array([edge, top, top + 0.15, top + 1.2, edge + width, reach])
    level = curb_height + 0.02 * 1.2
    rises = np.array([0.0, 0.0, 0.003, level, curb_height + 0.02 * width, curb_height + 0.02 * width + 0.15])
    on_curb = np.array([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    strips = ("curb face", "curb stone", "sidewalk", "sidewalk", "verge")
    return Side(sign, borders, rises, on_curb, strips, curb_height, tuple(lowered))


def ditch(sign: int, edge: float, depth: float = 0.6, reach: float = 24.0) -> Side:
    """No curb: a falling shoulder, a verge, a ditch and a field.

    Parameters
    ----------
    sign : 1 left, -1 right
    edge : m from the axis to the edge of the carriageway
    depth : m of the ditch
    reach : m from the axis to the end of the field

    Returns
    -------
    Side
    """
    borders = edge + np.array([0.0, 0.8, 2.2, 3.6, 4.1, 5.6, 0.0])
    borders[-1] = reach
    rises = np.array([0.0, -0.05, -0.12, -0.12 - depth, -0.12 - depth, 0.05, 0.25])
    return Side(sign, borders, rises, np.zeros(7), ("shoulder", "verge", "verge", "verge", "verge", "verge"))


class Texture:
    """Deterministic smooth noise of mean 0 and standard deviation about 1, for worn paint and patchy asphalt.

    Parameters
    ----------
    seed : equal seeds give equal noise
    """

    def __init__(self, seed: int):
        self._tile = np.random.default_rng([seed, 7]).standard_normal((_SIZE, _SIZE)).astype(np.float32).ravel()

    def at(self, s: np.ndarray, d: np.ndarray, cell: float) -> np.ndarray:
        """Noise at places, bilinear between nodes.

        Parameters
        ----------
        s, d : (N,) m, stations and offsets
        cell : m between nodes

        Returns
        -------
        (N,) float32
        """
        u, v = s / cell, d / cell + 131.7
        left, low = np.floor(u), np.floor(v)
        fu, fv = (u - left).astype(np.float32), (v - low).astype(np.float32)
        i, j = left.astype(np.int32), low.astype(np.int32)
        mask, tile = _SIZE - 1, self._tile
        row, next_row = (i & mask) * _SIZE, ((i + 1) & mask) * _SIZE
        column, next_column = j & mask, (j + 1) & mask
        near = tile[row + column] * (1 - fv) + tile[row + next_column] * fv
        far = tile[next_row + column] * (1 - fv) + tile[next_row + next_column] * fv
        # averaging reduces the standard deviation to 2/3 over a cell
        return np.float32(1.5) * (near * (1 - fu) + far * fu)


@dataclass(frozen=True)
class Lane:
    """A lane and the offset of its middle, linear between stations.

    Attributes
    ----------
    number : of the lane
    direction : 1 along the axis, -1 against it
    stations, offsets : (K,) m
    """

    number: int
    direction: int
    stations: np.ndarray
    offsets: np.ndarray


@dataclass
class Scene:
    """A road along an axis, with all objects beside and on it.

    On the carriageway the height is grade_line(s) + fall(d). Beyond its edges the strips of each Side continue it.

    Attributes
    ----------
    name : of the scene
    axis : RoadAxis
    length : m from station 0
    left, right : Side
    paint : Paint
    texture : Texture
    obstacles : list of Car, Post and Crown
    lanes : list of Lane
    passes : list of (direction, offset in m, speed factor)
    crown : m per m, fall to both sides
    gutter_width : m, concrete strip along the curb
    manholes : (M, 3) m, station, offset and radius
    repairs : (R, 5) start, end, right, left (m) and factor of the brightness
    """

    name: str
    axis: RoadAxis
    length: float
    left: Side
    right: Side
    paint: Paint
    texture: Texture
    obstacles: list[Any]
    lanes: list[Lane]
    passes: list[tuple[int, float, float]]
    crown: float = 0.02
    gutter_width: float = 0.0
    manholes: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    repairs: np.ndarray = field(default_factory=lambda: np.zeros((0, 5)))

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
        """Intersect pulses with the ground."""
        from .streets.trace import cast_ground

        return cast_ground(self, origin, direction, station, reach)

    def labels(self, strip: np.ndarray, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) uint8 labels of places on the ground, whose strips are known: 0 the carriageway, k left and -k right of it."""
        label = np.zeros(len(strip), dtype=np.uint8)
        road = strip == 0
        label[road] = self.carriageway_labels(s[road], d[road])
        for side in (self.left, self.right):
            names = np.array([0] + [LABEL[name] for name in side.strips], dtype=np.uint8)
            beside = strip * side.sign > 0
            label[beside] = names[np.abs(strip[beside])]
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
        from .truth import truth_of_street

        return truth_of_street(self, origin, crs)
