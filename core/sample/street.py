"""The centre line of the made road: straights, clothoids and arcs, and the way back from x, y."""

from dataclasses import dataclass, field

import numpy as np

# Fields of deterministic noise over the road: worn paint, patchy asphalt.

_SIZE = 512


class Texture:
    """Smooth noise of mean 0 and standard deviation about 1, the same for the same seed."""

    def __init__(self, seed):
        self._tile = np.random.default_rng([seed, 7]).standard_normal((_SIZE, _SIZE)).astype(np.float32).ravel()

    def at(self, s, d, cell):
        """Noise at stations and offsets, bilinear on a lattice of `cell` metres; float32 array."""
        u, v = s / cell, d / cell + 131.7
        left, low = np.floor(u), np.floor(v)
        fu, fv = (u - left).astype(np.float32), (v - low).astype(np.float32)
        i, j = left.astype(np.int32), low.astype(np.int32)
        mask, tile = _SIZE - 1, self._tile
        row, next_row = (i & mask) * _SIZE, ((i + 1) & mask) * _SIZE
        column, next_column = j & mask, (j + 1) & mask
        near = tile[row + column] * (1 - fv) + tile[row + next_column] * fv
        far = tile[next_row + column] * (1 - fv) + tile[next_row + next_column] * fv
        # 1.5 restores the standard deviation that averaging takes away (2/3 over a cell).
        return np.float32(1.5) * (near * (1 - fu) + far * fu)


# One side of the road across: from the edge of the carriageway outwards.

LOWERED_CURB_HEIGHT = 0.02  # m, what is left of a curb at a driveway or crossing
_RAMP = 1.0     # m along the road from full to lowered curb


@dataclass(frozen=True)
class Side:
    """Strips beside the carriageway, each straight across between two borders.

    Attributes
    ----------
    sign : 1 left, -1 right
    borders : (K+1,) distances from the axis, m, increasing; the first is the edge of the carriageway
    rises : (K+1,) heights at the borders above the edge of the carriageway, m, without the curb
    on_curb : (K+1,) how much of the curb's height each border has, 0 or 1
    strips : K names of the ground
    curb_height : m, 0 where there is none
    lowered : list of (start, end) stations at which the curb is lowered
    """

    sign: int
    borders: np.ndarray
    rises: np.ndarray
    on_curb: np.ndarray
    strips: tuple
    curb_height: float = 0.0
    lowered: tuple = ()

    @property
    def edge(self):
        """Distance of the edge of the carriageway (the curb bottom) from the axis."""
        return float(self.borders[0])

    def curb(self, s):
        """Height of the curb at stations `s`, m."""
        height = np.full(np.shape(s), self.curb_height)
        for start, end in self.lowered:
            way = np.clip(np.maximum(start - s, s - end) / _RAMP, 0.0, 1.0)
            height = np.minimum(height, LOWERED_CURB_HEIGHT + (self.curb_height - LOWERED_CURB_HEIGHT) * way * way * (3 - 2 * way))
        return height

    def border_rise(self, k, s):
        """Height of border `k` (a number or one per point) above the edge of the carriageway."""
        return self.rises[k] + self.on_curb[k] * self.curb(s)

    def rise(self, s, away):
        """Height above the edge of the carriageway at distances `away` from the axis, beyond the edge."""
        strip = np.clip(np.searchsorted(self.borders, away, side="right") - 1, 0, len(self.strips) - 1)
        return self.rise_in_strip(strip, s, away)

    def rise_in_strip(self, strip, s, away):
        """The same on the plane of a given strip, also a little beyond its borders."""
        curb = self.curb(s)
        inner = self.rises[strip] + self.on_curb[strip] * curb
        outer = self.rises[strip + 1] + self.on_curb[strip + 1] * curb
        share = (away - self.borders[strip]) / (self.borders[strip + 1] - self.borders[strip])
        return inner + (outer - inner) * share

    def steepness(self, strip, s):
        """Slope of strips outwards, metres per metre."""
        rise = self.border_rise(strip + 1, s) - self.border_rise(strip, s)
        return rise / (self.borders[strip + 1] - self.borders[strip])


def sidewalk(sign, edge, curb_height, lowered=(), width=3.6, reach=24.0, face=0.025):
    """A raised curb with a battered face, curb stone, sidewalk and a verge up to `reach`.

    Where the curb is lowered the sidewalk ramps down to it over its first metre.
    """
    top = edge + face
    borders = np.array([edge, top, top + 0.15, top + 1.2, edge + width, reach])
    level = curb_height + 0.02 * 1.2
    rises = np.array([0.0, 0.0, 0.003, level, curb_height + 0.02 * width, curb_height + 0.02 * width + 0.15])
    on_curb = np.array([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    strips = ("curb face", "curb stone", "sidewalk", "sidewalk", "verge")
    return Side(sign, borders, rises, on_curb, strips, curb_height, tuple(lowered))


def ditch(sign, edge, depth=0.6, reach=24.0):
    """No curb: a falling shoulder, a verge, a ditch and the field behind."""
    borders = edge + np.array([0.0, 0.8, 2.2, 3.6, 4.1, 5.6, 0.0])
    borders[-1] = reach
    rises = np.array([0.0, -0.05, -0.12, -0.12 - depth, -0.12 - depth, 0.05, 0.25])
    return Side(sign, borders, rises, np.zeros(7), ("shoulder", "verge", "verge", "verge", "verge", "verge"))

_SPACING = 0.25  # m between nodes: a cubic through a node is then true to a micrometre


class RoadAxis:
    """A horizontal alignment of elements whose curvature changes linearly.

    Parameters
    ----------
    elements : list of (length, curvature at start, curvature at end), m and 1/m, left positive
    start : float, station at which the first element begins (may be negative)
    heading : float, radians counter-clockwise from east, at `start`

    The axis passes through (0, 0) at station 0. Evaluation and its inverse
    agree to a few micrometres for |offset| below 0.6 of the radius.
    """

    def __init__(self, elements, start, heading):
        lengths, curvature_from, curvature_to = (np.array(column, dtype=float) for column in zip(*elements))
        borders = start + np.concatenate([[0.0], np.cumsum(lengths)])
        self.start, self.end = borders[0], borders[-1]
        self._nodes = np.arange(self.start, self.end + _SPACING, _SPACING)
        element = np.clip(np.searchsorted(borders, self._nodes, side="right") - 1, 0, len(lengths) - 1)
        self._bend_rate = ((curvature_to - curvature_from) / lengths)[element]
        self._bend = curvature_from[element] + self._bend_rate * (self._nodes - borders[element])
        step = np.full(len(self._nodes) - 1, _SPACING)
        turned = step * (self._bend[:-1] + self._bend[1:]) / 2
        theta = heading + np.concatenate([[0.0], np.cumsum(turned)])
        self._theta = theta
        # Three-point Gauss quadrature of the tangent over each step.
        points, weights = np.polynomial.legendre.leggauss(3)
        along = (points[:, None] + 1) / 2 * step
        angle = theta[:-1] + self._bend[:-1] * along + self._bend_rate[:-1] * along**2 / 2
        x = np.concatenate([[0.0], np.cumsum((weights[:, None] * np.cos(angle)).sum(0) * step / 2)])
        y = np.concatenate([[0.0], np.cumsum((weights[:, None] * np.sin(angle)).sum(0) * step / 2)])
        self._x, self._y, self._cos, self._sin = x, y, np.cos(theta), np.sin(theta)
        zero_x, zero_y = self.to_map(np.zeros(1), np.zeros(1))
        self._x, self._y = x - zero_x, y - zero_y

    def _node(self, s):
        return np.clip(np.rint((s - self.start) / _SPACING), 0, len(self._nodes) - 1).astype(np.intp)

    def heading(self, s):
        """Direction of the axis, radians counter-clockwise from east."""
        k = self._node(s)
        u = s - self._nodes[k]
        return self._theta[k] + self._bend[k] * u + self._bend_rate[k] * u**2 / 2

    def curvature(self, s):
        """1/m, positive in a left bend."""
        k = self._node(s)
        return self._bend[k] + self._bend_rate[k] * (s - self._nodes[k])

    def to_map(self, s, d):
        """x, y of stations and offsets (left positive), arrays of one shape."""
        k = self._node(s)
        u = s - self._nodes[k]
        bend, rate = self._bend[k], self._bend_rate[k]
        ahead = u - bend**2 * u**3 / 6
        aside = bend * u**2 / 2 + rate * u**3 / 6
        turn = bend * u + rate * u**2 / 2
        ahead = ahead - d * np.sin(turn)
        aside = aside + d * np.cos(turn)
        cos, sin = self._cos[k], self._sin[k]
        return self._x[k] + ahead * cos - aside * sin, self._y[k] + ahead * sin + aside * cos

    def locate(self, x, y, s, steps=2):
        """Station and offset of points, given a rough station.

        One step is enough from a start within half a metre, two from within
        30 m. Returns s, d and the cosine and sine of the axis there.
        """
        for _ in range(steps):
            k = self._node(s)
            cos, sin, bend = self._cos[k], self._sin[k], self._bend[k]
            dx, dy = x - self._x[k], y - self._y[k]
            ahead = dx * cos + dy * sin
            aside = dy * cos - dx * sin
            shrink = 1.0 - bend * aside
            u = ahead / shrink
            s = self._nodes[k] + u
        return s, aside - bend * ahead * u / 2, cos, sin


def winding_road(length, radius, straight=30.0, transition=20.0, arc=45.0, run_in=70.0):
    """Elements of a road that bends left and right in turn, for any length.

    It starts with `straight` metres at station 0 (after a straight of `run_in`),
    then clothoid, arc, clothoid, a half straight, and the same to the other
    side. Heading comes back, so that the road never meets itself.
    """
    elements, reached, sign = [(run_in + straight, 0.0, 0.0)], straight, 1.0
    while reached < length + run_in:
        bend = sign / radius
        elements += [
            (transition, 0.0, bend), (arc, bend, bend), (transition, bend, 0.0), (straight / 2, 0.0, 0.0)]
        reached += 2 * transition + arc + straight / 2
        sign = -sign
    return elements


# The made street: its surface as a height over station and offset, and what it is made of.

# What a return came from; the numbers are the labels of the points.
LABELS = ("nothing", "road", "paint", "worn paint", "manhole", "gutter", "curb face", "curb stone", "sidewalk",
          "shoulder", "verge", "car", "tree", "pole", "stray")
LABEL = {name: number for number, name in enumerate(LABELS)}
CARRIAGEWAY_LABELS = tuple(LABEL[name] for name in ("road", "paint", "worn paint", "manhole", "gutter"))


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
