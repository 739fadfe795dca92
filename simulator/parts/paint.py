"""Markings of the simulated road, in stations and offsets."""

from __future__ import annotations

from dataclasses import dataclass, field
from statistics import NormalDist
from typing import TYPE_CHECKING, Union

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .materials import Texture


@dataclass(frozen=True)
class PaintedLine:
    """A line along the road, or one whose offset changes, such as the border of a hatched island."""

    kind: str   # class of the marking
    line: int   # number of the line
    places: tuple[tuple[float, float], ...]   # (K, 2) m, station and offset, stations increasing; straight between them
    width: float   # m
    dash: tuple[float, float] | None = None   # (painted, gap) in m of a line with one offset, None for a solid line
    wear: float = 0.1   # 0 to 1, share of the paint that is worn off

    @property
    def start(self) -> float:
        """Station of its beginning, m."""
        return self.places[0][0]

    @property
    def end(self) -> float:
        """Station of its end, m."""
        return self.places[-1][0]

    def covers(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) bool, places within the marking, at (N,) stations and offsets."""
        inside = (np.abs(d - np.interp(s, *np.transpose(self.places))) <= self.width / 2) & (s >= self.start) & (s <= self.end)
        if self.dash is not None:
            inside &= (s - self.start) % sum(self.dash) <= self.dash[0]
        return inside

    def outlines(self) -> list[np.ndarray]:
        """Outlines of its painted pieces, (n, 2) m of station and offset each."""
        pieces = [np.array(self.places)]
        if self.dash is not None:
            starts, offset = np.arange(self.start, self.end, sum(self.dash)), self.places[0][1]
            pieces = [np.array([(s, offset), (min(s + self.dash[0], self.end), offset)]) for s in starts]
        aside = np.array([0.0, self.width / 2])
        return [np.concatenate([piece - aside, (piece + aside)[::-1]]) for piece in pieces]


@dataclass(frozen=True)
class PaintedFigure:
    """Polygons of one marking: a zebra crossing, an arrow or a hatched area."""

    kind: str   # class of the marking
    line: int | None   # None
    polygons: tuple[np.ndarray, ...]   # (n, 2) m of station and offset each, not overlapping
    wear: float = 0.1   # 0 to 1, share of the paint that is worn off
    start: float = field(init=False)   # start, end: m, stations
    end: float = field(init=False)

    def __post_init__(self):
        stations = np.concatenate([polygon[:, 0] for polygon in self.polygons])
        object.__setattr__(self, "start", float(stations.min()))
        object.__setattr__(self, "end", float(stations.max()))

    def covers(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) bool, places within the marking, at (N,) stations and offsets."""
        inside = np.zeros(len(s), dtype=bool)
        near = np.flatnonzero((s >= self.start) & (s <= self.end))
        for polygon in self.polygons:
            (s0, d0), (s1, d1) = polygon.min(0), polygon.max(0)
            local = near[(s[near] >= s0) & (s[near] <= s1) & (d[near] >= d0) & (d[near] <= d1)]
            inside[local] |= _inside(polygon, s[local], d[local])
        return inside

    def outlines(self) -> list[np.ndarray]:
        """Outlines of its painted pieces, (n, 2) m of station and offset each."""
        return list(self.polygons)


def _inside(polygon, s, d):
    """Even-odd rule for (N,) places in a polygon."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        crosses = (a[:, 1] > d[:, None]) != (b[:, 1] > d[:, None])
        crossing = a[:, 0] + (d[:, None] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return (np.sum(crosses & (s[:, None] < crossing), axis=1) % 2).astype(bool)


def rectangle(start: float, end: float, right: float, left: float) -> np.ndarray:
    """(4, 2) polygon between two stations and two offsets, m."""
    return np.array([(start, right), (end, right), (end, left), (start, left)])


def zebra_bars(start: float, end: float, right: float, left: float, bar: float = 0.45, gap: float = 0.60) -> tuple[np.ndarray, ...]:
    """Bars along the road between two stations, evenly distributed between two offsets, m."""
    count = int((left - right + gap) // (bar + gap))
    first = (left + right) / 2 - (count * (bar + gap) - gap) / 2
    return tuple(rectangle(start, end, d, d + bar) for d in first + np.arange(count) * (bar + gap))


def straight_arrow(tail: float, offset: float, direction: int, length: float = 4.5) -> np.ndarray:
    """(7, 2) outline of an arrow from station `tail`, along (1) or against (-1) the road, m."""
    shaft, head, neck = 0.10, 0.40, length - 1.6
    shape = np.array([(0, -shaft), (neck, -shaft), (neck, -head), (length, 0), (neck, head), (neck, shaft), (0, shaft)])
    return np.column_stack([tail + direction * shape[:, 0], offset + direction * shape[:, 1]])


def turn_arrow(tail: float, offset: float, direction: int, length: float = 4.5) -> np.ndarray:
    """(15, 2) outline of an arrow for straight on and right turn, m."""
    shaft, neck, root = 0.10, length - 1.6, 1.3
    shape = np.array([
        (0, -shaft), (root, -shaft), (root + 0.45, -0.38), (root + 0.20, -0.38), (root + 0.75, -0.80), (root + 1.30, -0.38),
        (root + 1.05, -0.38), (root + 0.55, -shaft), (neck, -shaft), (neck, -0.40), (length, 0), (neck, 0.40), (neck, shaft), (0, shaft)])
    return np.column_stack([tail + direction * shape[:, 0], offset + direction * shape[:, 1]])


def left_arrow(tail: float, offset: float, direction: int, length: float = 4.5) -> np.ndarray:
    """(9, 2) outline of an arrow for a left turn, m."""
    shaft, neck = 0.10, length - 1.1
    shape = np.array([
        (0, -shaft), (neck, -shaft), (neck + 0.55, 0.55), (neck + 0.95, 0.55), (neck + 0.40, 1.05), (neck - 0.15, 0.55), (neck + 0.25, 0.55),
        (neck - 0.15, shaft), (0, shaft)])
    return np.column_stack([tail + direction * shape[:, 0], offset + direction * shape[:, 1]])


def hatching(start: float, end: float, right: float, left: float, bar: float = 0.45, gap: float = 1.0) -> tuple[np.ndarray, ...]:
    """Bars at 45 degrees across a strip between two stations and two offsets, m."""
    width = left - right
    starts = np.arange(start, end - width - bar, bar + gap)
    return tuple(np.array([(s, right), (s + bar, right), (s + bar + width, left), (s + width, left)]) for s in starts)


def hatched_area(outline: np.ndarray, bar: float = 0.5, gap: float = 1.0) -> tuple[np.ndarray, ...]:
    """Bars at 45 degrees, polygons, within an outline of (n, 2) stations and offsets; `bar` and `gap` in m along the road."""
    import shapely

    area = shapely.Polygon(outline)
    low, right, high, left = area.bounds
    bars = []
    for s in np.arange(low - (left - right), high, bar + gap):
        slanted = np.array([(s, right), (s + bar, right), (s + bar + left - right, left), (s + left - right, left)])
        for piece in shapely.get_parts(shapely.intersection(area, shapely.Polygon(slanted))):
            if piece.geom_type == "Polygon" and piece.area > 0.02:
                bars.append(shapely.get_coordinates(piece.exterior)[:-1])
    return tuple(bars)


Marking = Union[PaintedLine, PaintedFigure]


class Paint:
    """All markings of a road, PaintedLine and PaintedFigure, with the Texture of their wear."""

    def __init__(self, markings: Sequence[Marking], texture: Texture):
        self.markings = list(markings)
        self._texture = texture

    def at(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(number of the marking, -1 where there is none; whether its paint is not worn off), (N,) each, at (N,) stations and offsets, m."""
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
