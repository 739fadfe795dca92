"""Sheets along the axes of roads: rectangles of one size, each turned so that the road runs along it from left to right."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from .axes import Axis

OVERLAP = 0.08        # of a sheet that the next one shows again
MOST_HEIGHT = 0.9     # of a sheet's height that the road may take
SHORTEST_REST = 1.0   # m of an axis that may lie on no sheet
SHORTENED = 0.8       # by which the stretch of a sheet is shortened until it fits
LEAST_REACH = 0.15    # of a sheet's width that it shows at least, however tight the bend


@dataclass(frozen=True)
class Match:
    """Where a sheet ends and its neighbour goes on: a place on the axis, the axis's heading (radians from east), and the neighbour's number."""

    x: float
    y: float
    heading: float
    neighbour: int


@dataclass
class Sheet:
    """One sheet: its number, and the ground that it shows, metres; `heading` is the direction of the page's right side, radians from east."""

    number: int
    x: float
    y: float
    heading: float
    width: float
    height: float
    matches: list[Match] = field(default_factory=list)

    def on_page(self, places: np.ndarray) -> np.ndarray:
        """(N, 2) metres right of and below the upper left corner of the map, of (N, 2) places."""
        delta = np.asarray(places, float)[:, :2] - (self.x, self.y)
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return np.c_[delta @ (cos, sin) + self.width / 2, self.height / 2 - delta @ (-sin, cos)]

    def outline(self, shrunk: float = 0.0) -> Polygon:
        """On the map, `shrunk` by a share of its width on all sides."""
        w, h = self.width * (0.5 - shrunk), self.height / 2 - min(self.width * shrunk, self.height / 4)
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return Polygon([(self.x + u * cos - v * sin, self.y + u * sin + v * cos) for u, v in ((-w, -h), (w, -h), (w, h), (-w, h))])


def sheets_along(axes: list[Axis], width: float, height: float) -> list[Sheet]:
    """Sheets on which every metre of the axes lies; each overlaps those that show how the road goes on.

    width, height : of the ground that a sheet shows, metres
    """
    sheets: list[Sheet] = []
    for axis in axes:
        left = [LineString(axis.places[:, :2])]
        while left:
            line = left.pop(0)
            inner = shapely.union_all([sheet.outline(OVERLAP / 2) for sheet in sheets])
            outer = shapely.union_all([sheet.outline() for sheet in sheets])
            rest = max(_parts(line.difference(outer)), key=lambda part: part.length, default=None)
            if rest is None or rest.length < SHORTEST_REST:
                continue
            shown = next(part for part in _parts(line.difference(inner)) if part.intersects(rest.interpolate(0.5, normalized=True).buffer(1e-6)))
            new = _walk(shown, axis, axes, width, height, len(sheets) + 1)
            _join(sheets, new, shown)
            sheets += new
            left = sorted(_parts(line.difference(shapely.union_all([sheet.outline() for sheet in new]))), key=lambda part: -part.length) + left
    return sheets


def _parts(geometry):
    return [part for part in shapely.get_parts(geometry) if part.length > 0]


def _walk(line, axis, axes, width, height, number):
    """Sheets along one line of an axis; each reaches as far as the road stays on it, and all about as far."""
    sheets, begin = [], 0.0
    while begin < line.length - 1e-6:
        reach = (line.length - begin) / math.ceil((line.length - begin) / (width * (1 - OVERLAP)) - 1e-9)
        while True:
            end = min(begin + reach, line.length)
            places = np.array([line.interpolate(at).coords[0][:2] for at in np.linspace(begin, end, 41)])
            sheet, fits = _sheet(places, axis, axes, width, height, number + len(sheets))
            if fits or reach < LEAST_REACH * width:
                break
            reach *= SHORTENED
        if sheets:
            here = _heading(line, begin)
            sheets[-1].matches.append(Match(*here, sheet.number))
            sheet.matches.append(Match(*here, sheets[-1].number))
        sheets.append(sheet)
        begin = end
    return sheets


def _sheet(places, axis, axes, width, height, number):
    """The sheet turned by the chord of a stretch, and whether the road fits on it; roads beside it are shown as a whole where there is room."""
    chord = places[-1] - places[0]
    heading = math.atan2(chord[1], chord[0])
    turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    turned = places @ turn
    (u, low), (u2, high) = turned.min(0), turned.max(0)
    side = min(axis.half_width, 0.3 * height)
    low, high = low - side, high + side
    fits = u2 - u <= width * (1 - OVERLAP / 2) and high - low <= height * MOST_HEIGHT
    for other in axes:
        beside = other.places[:, :2] @ turn
        beside = beside[(beside[:, 0] > u) & (beside[:, 0] < u2), 1]
        if len(beside) > 1:
            lower, upper = min(low, beside.min() - other.half_width), max(high, beside.max() + other.half_width)
            if upper - lower <= height * MOST_HEIGHT:
                low, high = lower, upper
    x, y = turn @ ((u + u2) / 2, (low + high) / 2)
    return Sheet(number, float(x), float(y), heading, width, height), fits


def _heading(line, at):
    """x, y and heading of a line at a length along it."""
    x, y = line.interpolate(at).coords[0][:2]
    first, last = (np.array(line.interpolate(min(max(at + step, 0.0), line.length)).coords[0][:2]) for step in (-1.0, 1.0))
    return x, y, math.atan2(*(last - first)[::-1])


def _join(sheets, new, line):
    """Match lines where the ends of a new stretch lie on an earlier sheet."""
    for sheet, at in ((new[0], 0.0), (new[-1], line.length)) if new else ():
        here = _heading(line, at)
        place = shapely.Point(here[:2])
        around = [earlier for earlier in sheets if earlier.outline().covers(place)]
        if around:
            neighbour = max(around, key=lambda one: one.outline().exterior.distance(place))
            neighbour.matches.append(Match(*here, sheet.number))
            sheet.matches.append(Match(*here, neighbour.number))
