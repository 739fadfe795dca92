"""The made street: its surface as a height over station and offset, and what it is made of."""

from dataclasses import dataclass, field

import numpy as np

# What a return came from; the numbers are the labels of the points.
LABELS = ("nothing", "road", "paint", "worn paint", "manhole", "gutter", "curb face", "curb stone", "sidewalk",
          "shoulder", "verge", "car", "tree", "pole", "stray")
LABEL = {name: number for number, name in enumerate(LABELS)}
CARRIAGEWAY = tuple(LABEL[name] for name in ("road", "paint", "worn paint", "manhole", "gutter"))


@dataclass(frozen=True)
class Lane:
    """A lane with the offset of its middle at stations (linear between them)."""

    number: int
    direction: int  # 1 along the axis, -1 against it
    stations: np.ndarray
    offsets: np.ndarray


@dataclass
class Scene:
    """A road along an axis, with all that stands on it.

    Heights: z(s, d) = grade line(s) + crown(d) on the carriageway, continued by
    the strips of each Side beyond its edges.
    """

    name: str
    axis: object
    length: float
    left: object
    right: object
    paint: object
    texture: object
    obstacles: list
    lanes: list
    passes: list                      # of (direction, offset, speed factor)
    crown: float = 0.02               # fall to both sides, m per m
    gutter_width: float = 0.0         # concrete strip along the curb, m
    manholes: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))  # station, offset, radius
    repairs: np.ndarray = field(default_factory=lambda: np.zeros((0, 5)))   # start, end, right, left, brightness

    def grade_line(self, s):
        """Height of the axis: a steady climb with gentle waves."""
        return 0.006 * s + 0.25 * np.sin(s / 60.0)

    def grade(self, s):
        return 0.006 + 0.25 / 60.0 * np.cos(s / 60.0)

    def fall(self, d):
        """Height of the crowned carriageway below the axis, rounded over half a metre; negative."""
        return -self.crown * (np.sqrt(d * d + 0.25) - 0.5)

    def cross_slope(self, d):
        return -self.crown * d / np.sqrt(d * d + 0.25)

    def carriageway(self, s, d):
        """The carriageway's surface, continued beyond its edges."""
        return self.grade_line(s) + self.fall(d)

    def edge_height(self, side, s):
        """Height of the edge of the carriageway on one Side."""
        return self.grade_line(s) + self.fall(np.float64(side.edge))

    def height(self, s, d):
        """The true ground at stations and offsets, m."""
        s, d = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(d, dtype=float))
        z = self.carriageway(s, d)
        for side in (self.left, self.right):
            beyond = side.sign * d > side.edge
            z[beyond] = self.edge_height(side, s[beyond]) + side.rise(s[beyond], side.sign * d[beyond])
        return z

    def to_map(self, s, d):
        """x, y, z of places on the ground."""
        s, d = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(d, dtype=float))
        x, y = self.axis.to_map(s, d)
        return x, y, self.height(s, d)

    def carriageway_labels(self, s, d):
        """Label of places on the carriageway: asphalt, gutter, manhole cover, paint or worn paint."""
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
