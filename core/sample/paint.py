"""What is painted on the made road, in stations and offsets."""

from dataclasses import dataclass, field
from statistics import NormalDist

import numpy as np


@dataclass(frozen=True)
class PaintedLine:
    """A line along the road; `dash` is (painted, gap) in metres, None for solid."""

    kind: str
    line: int
    offset: float
    width: float
    start: float
    end: float
    dash: tuple = None
    wear: float = 0.1

    def pieces(self):
        """Start and end stations of its painted pieces."""
        if self.dash is None:
            return [(self.start, self.end)]
        painted, gap = self.dash
        starts = np.arange(self.start, self.end, painted + gap)
        return [(s, min(s + painted, self.end)) for s in starts]

    def covers(self, s, d):
        there = (np.abs(d - self.offset) <= self.width / 2) & (s >= self.start) & (s <= self.end)
        if self.dash is not None:
            there &= (s - self.start) % sum(self.dash) <= self.dash[0]
        return there

    def outlines(self):
        low, high = self.offset - self.width / 2, self.offset + self.width / 2
        return [np.array([(s0, low), (s1, low), (s1, high), (s0, high)]) for s0, s1 in self.pieces()]


@dataclass(frozen=True)
class PaintedFigure:
    """Polygons that belong together: a zebra crossing, an arrow, a hatched area."""

    kind: str
    line: int
    polygons: tuple  # of (n, 2) arrays of station, offset; not overlapping
    wear: float = 0.1
    start: float = field(init=False)
    end: float = field(init=False)

    def __post_init__(self):
        stations = np.concatenate([polygon[:, 0] for polygon in self.polygons])
        object.__setattr__(self, "start", float(stations.min()))
        object.__setattr__(self, "end", float(stations.max()))

    def covers(self, s, d):
        there = np.zeros(len(s), dtype=bool)
        near = np.flatnonzero((s >= self.start) & (s <= self.end))
        for polygon in self.polygons:
            (s0, d0), (s1, d1) = polygon.min(0), polygon.max(0)
            local = near[(s[near] >= s0) & (s[near] <= s1) & (d[near] >= d0) & (d[near] <= d1)]
            there[local] |= _inside(polygon, s[local], d[local])
        return there

    def outlines(self):
        return list(self.polygons)


def _inside(polygon, s, d):
    """Even-odd rule, points against all edges at once."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        crosses = (a[:, 1] > d[:, None]) != (b[:, 1] > d[:, None])
        at = a[:, 0] + (d[:, None] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return (np.sum(crosses & (s[:, None] < at), axis=1) % 2).astype(bool)


def rectangle(start, end, right, left):
    """A polygon between two stations and two offsets."""
    return np.array([(start, right), (end, right), (end, left), (start, left)])


def zebra_bars(start, end, right, left, bar=0.45, gap=0.60):
    """Bars along the road, evenly set between two offsets."""
    count = int((left - right + gap) // (bar + gap))
    first = (left + right) / 2 - (count * (bar + gap) - gap) / 2
    return tuple(rectangle(start, end, d, d + bar) for d in first + np.arange(count) * (bar + gap))


def straight_arrow(tail, offset, direction, length=4.5):
    """An arrow whose tail lies at station `tail`, pointing along (1) or against (-1) the road."""
    shaft, head, neck = 0.10, 0.40, length - 1.6
    shape = np.array([(0, -shaft), (neck, -shaft), (neck, -head), (length, 0), (neck, head), (neck, shaft), (0, shaft)])
    return np.column_stack([tail + direction * shape[:, 0], offset + direction * shape[:, 1]])


def turn_arrow(tail, offset, direction, length=4.5):
    """An arrow for straight on and right: the straight one with a branch to its right."""
    shaft, neck, root = 0.10, length - 1.6, 1.3
    shape = np.array([
        (0, -shaft), (root, -shaft), (root + 0.45, -0.38), (root + 0.20, -0.38), (root + 0.75, -0.80), (root + 1.30, -0.38),
        (root + 1.05, -0.38), (root + 0.55, -shaft), (neck, -shaft), (neck, -0.40), (length, 0), (neck, 0.40), (neck, shaft), (0, shaft)])
    return np.column_stack([tail + direction * shape[:, 0], offset + direction * shape[:, 1]])


def hatching(start, end, right, left, bar=0.45, gap=1.0):
    """Bars aslant at 45 degrees across a strip of road."""
    width = left - right
    starts = np.arange(start, end - width - bar, bar + gap)
    return tuple(np.array([(s, right), (s + bar, right), (s + bar + width, left), (s + width, left)]) for s in starts)


class Paint:
    """All markings of a road; answers which of them, if any, covers a place."""

    def __init__(self, markings, texture):
        self.markings = list(markings)
        self._texture = texture

    def at(self, s, d):
        """What is painted at stations and offsets.

        Returns the number of the marking at each place, -1 for none, and
        whether its paint is still there, False where it is worn away.
        """
        number = np.full(len(s), -1, dtype=np.int16)
        if len(s) == 0:
            return number, np.zeros(0, dtype=bool)
        low, high = s.min(), s.max()
        for index, marking in enumerate(self.markings):
            if marking.end >= low and marking.start <= high:
                number[marking.covers(s, d)] = index
        fresh = np.zeros(len(s), dtype=bool)
        painted = np.flatnonzero(number >= 0)
        s, d = s[painted], d[painted]
        limits = np.array([NormalDist().inv_cdf(marking.wear) for marking in self.markings] or [0.0])
        chips = 0.8 * self._texture.at(s, d, 0.035) + 0.6 * self._texture.at(s, d, 0.9)
        fresh[painted] = chips > limits[number[painted]]
        return number, fresh
