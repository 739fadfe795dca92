"""The simulated street: its surface over station and offset, and what lies and stands on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..parts.materials import LABEL, Texture
from ..parts.sides import Side
from .trace import cast_ground

if TYPE_CHECKING:
    from ..parts.axis import RoadAxis
    from ..parts.beside import RunningThing
    from ..parts.paint import Paint
    from ..parts.scene import Hits
    from ..parts.truth import Truth


@dataclass(frozen=True)
class Lane:
    """A lane and the offset of its middle, linear between stations.

    Attributes
    ----------
    number : of the lane
    direction : 1 along the axis, -1 against it
    stations, offsets : (K,) m
    widths : (K,) m, between the middles of its border lines
    """

    number: int
    direction: int
    stations: np.ndarray
    offsets: np.ndarray
    widths: np.ndarray


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
    obstacles : list of Car, Post, Crown, Rail and Piece
    lanes : list of Lane
    passes : list of (direction, offset in m, speed factor)
    crown : m per m, fall to both sides
    gutter_width : m, concrete strip along the curb
    manholes : (M, 3) m, station, offset and radius
    repairs : (R, 5) start, end, right, left (m) and factor of the brightness
    running : list of RunningThing, what runs along the road beside it
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
    running: list[RunningThing] = field(default_factory=list)

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
