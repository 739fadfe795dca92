"""From the lines of a road map to sheets: the axes of its roads, with stations and heights of the ground, whatever way the vehicle took."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely
from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsMapLayer, QgsProject, QgsVectorLayer
from scipy.ndimage import median_filter
from shapely.geometry import LineString, Polygon

from ...processing_provider.texts import tr

STEP = 1.0             # m of station between places of an axis
SMOOTHED = 3.0         # m, sigma of the smoothing along the axis, which moves it by SMOOTHED² / 2 radius
CENTRED = 40.0         # m, sigma of the smoothing by which it comes back to the middle of its lines: a lane that begins turns it by a degree
LONGEST_GAP = 60.0     # m without any line that an axis bridges
SHORTEST_LINE = 5.0    # m
STRETCH = (0.8, 1.25)  # length of a line per length of its stations: others run across the road, as at a corner
USUAL = 75.0           # %: the half width of a road is that of so many of its stations; others are wider, as at a junction
ON_AXIS = 1.0          # m within which a line to one side alone tells the height on the axis
BESIDE = 25.0          # m from the axis to lines that tell the height of the ground
TIGHTEST = 8.0         # m, radius: no road turns more tightly, but lines around the corner of a junction do


@dataclass(frozen=True)
class RoadLine:
    """A line along a road.

    road : number of the road; rank : 0 for lines that lead the axis, higher for those asked where there are none
    stations : (N,) m along the road, rising; places : (N, 3) metres in the CRS of the map, z may be NaN
    """

    road: int
    rank: int
    stations: np.ndarray
    places: np.ndarray


@dataclass(frozen=True)
class Axis:
    """stations : (N,) m, rising; places : (N, 3) metres, z of the ground or NaN; half_width : m to either side that belongs to the road."""

    road: int
    stations: np.ndarray
    places: np.ndarray
    half_width: float

    def at(self, stations: np.ndarray) -> np.ndarray:
        """(K, 3) places at stations."""
        return np.stack([np.interp(stations, self.stations, column) for column in self.places.T], axis=-1)

    def with_heights(self) -> Axis | None:
        """The stretch along which the height is known; None where it is shorter than a line."""
        known = np.isfinite(self.places[:, 2])
        return replace(self, stations=self.stations[known], places=self.places[known]) if known.sum() * STEP > SHORTEST_LINE else None

    def heading(self, station: float) -> float:
        """Radians from east, anticlockwise, in which the stations rise."""
        low, high = np.clip([station - STEP, station + STEP], self.stations[0], self.stations[-1])
        (x, y, _), (x2, y2, _) = self.at(np.array([low, high]))
        return float(np.arctan2(y2 - y, x2 - x))

    @property
    def length(self) -> float:
        return float(self.stations[-1] - self.stations[0])


def road_line(road: int, rank: int, places: np.ndarray, first: float, last: float) -> RoadLine | None:
    """A line whose ends lie at stations `first` and `last`; None where it is short or runs across the road."""
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(places[:, :2], axis=0).T)))
    reach = last - first
    if reach < SHORTEST_LINE or not STRETCH[0] < along[-1] / reach < STRETCH[1]:
        return None
    return RoadLine(road, rank, first + along * reach / along[-1], places)


def axes_of(lines: Iterable[RoadLine]) -> list[Axis]:
    """One axis for every stretch of road that has lines, the longest first.

    The axis keeps its distance from every line that goes on, so that a lane which begins or ends does not move it at once; it comes back to the
    middle of its lines over some hundred metres.
    """
    lines = list(lines)
    axes = [axis for road in sorted({line.road for line in lines}) for axis in _axes_of_road(road, [one for one in lines if one.road == road])]
    return sorted(axes, key=lambda axis: -axis.length)


def _axes_of_road(road, lines):
    first = math.floor(min(line.stations[0] for line in lines) / STEP)
    samples = [_samples(line, first) for line in lines]
    rows = np.concatenate([rows for rows, _ in samples])
    places = np.concatenate([on_line for _, on_line in samples])
    line = np.repeat(np.arange(len(lines)), [len(rows) for rows, _ in samples])
    axis = _led(rows, places[:, :2], line, np.array([one.rank for one in lines])[line])
    known = np.flatnonzero(np.isfinite(axis[:, 0]))
    for part in np.split(known, np.flatnonzero(np.diff(known) * STEP > LONGEST_GAP) + 1):
        if len(part) * STEP < SHORTEST_LINE:
            continue
        part = np.arange(part[0], part[-1] + 1)
        course = _course(part, known, axis)
        inside = (rows >= part[0]) & (rows <= part[-1])
        heights, half_width = _across(rows[inside] - part[0], places[inside], course)
        yield Axis(road, (first + part) * STEP, np.c_[course, heights], half_width)


def _course(part, known, axis):
    """(S, 2) the axis smoothed; places beside which it would fold are left out."""
    while True:
        course = np.stack([_smooth(np.interp(part, known, axis[known, column]), SMOOTHED) for column in (0, 1)], axis=-1)
        headings = np.unwrap(np.arctan2(*np.diff(course, axis=0).T[::-1]))
        folded = part[1:-1][np.abs(np.diff(headings)) > STEP / TIGHTEST]
        kept = known[(np.abs(known[:, None] - folded) > SMOOTHED).all(axis=1) | np.isin(known, part[[0, -1]])]
        if len(kept) == len(known):
            return course
        known = kept


def _samples(line, first):
    """(rows of stations counted from the first one of the road, (K, 3) places there) of a line."""
    low, high = math.ceil(line.stations[0] / STEP - 0.5), math.floor(line.stations[-1] / STEP + 0.5)
    rows = np.arange(low, high + 1)
    return rows - first, np.stack([np.interp(rows * STEP, line.stations, column) for column in line.places.T], axis=-1)


def _led(rows, places, line, ranks):
    """(S, 2) the axis before it is smoothed, from places of lines at rows of stations; NaN where there is none."""
    count = int(rows.max()) + 2
    steps = np.flatnonzero(line[:-1] == line[1:])   # from a place to the next of its line
    free, led = np.ones(count, bool), np.zeros(len(steps), bool)
    for rank in np.unique(ranks):   # where better lines break off for no longer than a junction, worse ones would lead around its corners
        led |= (ranks[steps] == rank) & free[rows[steps]]
        there = np.unique(rows[steps[led]])
        for before, after in zip(there[:-1], there[1:]):
            if (after - before) * STEP <= LONGEST_GAP:
                free[before:after + 1] = False
        free[there] = False
    steps = steps[led][np.argsort(rows[steps[led]], kind="stable")]
    starts = np.searchsorted(rows[steps], np.arange(count + 1))
    axis, middles, lefts = (np.full((count, 2), np.nan) for _ in range(3))
    for row in range(count - 1):
        here = steps[starts[row]:starts[row + 1]]
        ahead = places[here + 1] - places[here]
        ahead = (ahead / np.maximum(np.hypot(*ahead.T), 1e-9)[:, None]).sum(0)
        if not ahead.any():
            continue
        left = np.array([-ahead[1], ahead[0]]) / np.hypot(*ahead)
        if np.isnan(axis[row, 0]):
            axis[row] = places[here].mean(0)
        offsets = (places[here] - axis[row]) @ left
        axis[row + 1] = np.mean(places[here + 1] - np.outer(offsets, left), axis=0)
        middles[row:row + 2], lefts[row:row + 2] = (offsets.min() + offsets.max()) / 2, left
    known = np.flatnonzero(np.isfinite(axis[:, 0]))
    for part in np.split(known, np.flatnonzero(np.diff(known) > 1) + 1) if len(known) else ():
        usual = median_filter(middles[part, 0], int(2 * CENTRED / STEP) + 1, mode="mirror")   # not of the lanes left at a stop line
        axis[part] += _smooth(usual, CENTRED)[:, None] * lefts[part]
    return axis


def _smooth(values, sigma):
    """Smoothed along by so many metres; beyond an end a course (`SMOOTHED`) goes on turned about it, an offset (`CENTRED`) mirrored."""
    reach = min(int(3 * sigma / STEP), len(values) - 1)
    if reach < 1:
        return values
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) * STEP / sigma) ** 2)
    beyond = np.pad(values, reach, "reflect", reflect_type="odd" if sigma == SMOOTHED else "even")
    return np.convolve(beyond, weights / weights.sum(), "valid")


def _across(rows, places, course):
    """(S,) height of the ground on the course between the lines to its left and right, and m to its sides within which the lines lie."""
    ahead = np.gradient(course, axis=0)
    ahead /= np.maximum(np.hypot(*ahead.T), 1e-9)[:, None]
    delta = places[:, :2] - course[rows]
    offsets = delta[:, 1] * ahead[rows, 0] - delta[:, 0] * ahead[rows, 1]
    near = np.abs(offsets) < BESIDE
    sides, heights = np.zeros(len(course)), np.full(len(course), np.nan)
    np.maximum.at(sides, rows[near], np.abs(offsets[near]))
    near &= np.isfinite(places[:, 2])
    order = np.flatnonzero(near)[np.lexsort((offsets[near], rows[near]))]
    starts = np.searchsorted(rows[order], np.arange(len(course) + 1))
    for row in range(len(course)):
        here = order[starts[row]:starts[row + 1]]
        across = offsets[here]
        if len(here) and (np.abs(across).min() < ON_AXIS or across[0] < 0 < across[-1]):
            heights[row] = np.interp(0.0, across, places[here, 2])
    known = np.isfinite(heights)
    if known.any():
        first, last = np.flatnonzero(known)[[0, -1]]
        heights[first:last + 1] = _smooth(np.interp(np.arange(first, last + 1), np.flatnonzero(known), heights[known]), SMOOTHED)
    return heights, float(np.percentile(sides, USUAL))


# The lines of a road map's layers as numbers: places in metres, heights, stations; and how well they are known.

LEADING = ("DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES")   # lines that lead an axis, best first


@dataclass(frozen=True)
class MapLine:
    """output : the result that it is of, such as ROAD_EDGES; places : (N, 3) metres, z may be NaN; row : its fields by name."""

    output: str
    places: np.ndarray
    row: dict[str, Any]

    def number(self, name: str) -> float:
        """A field of that name, or a length in metres, of a layer in feet too; NaN where it has none."""
        for column, unit in ((f"{name}_m", 1.0), (f"{name}_ft", 0.3048), (name, 1.0)):
            value = self.row.get(column)
            if isinstance(value, (int, float)):
                return value * unit
        return math.nan


def lines_of(layers: dict[str, QgsMapLayer], crs: QgsCoordinateReferenceSystem, project: QgsProject, unit: float) -> list[MapLine]:
    """The lines of the layers of lines, in a CRS whose unit is so many metres; what cannot be transformed is left out."""
    lines = []
    for output, layer in layers.items():
        if not isinstance(layer, QgsVectorLayer) or layer.geometryType() != Qgis.GeometryType.Line:
            continue
        transform = QgsCoordinateTransform(layer.crs(), crs, project) if layer.crs().isValid() and layer.crs() != crs else None
        names = [field.name() for field in layer.fields()]
        for feature in layer.getFeatures():
            geometry = feature.geometry()
            try:
                if geometry.isEmpty() or (transform is not None and geometry.transform(transform) != Qgis.GeometryOperationResult.Success):
                    continue
            except QgsCsException:
                continue
            row = dict(zip(names, feature.attributes()))
            for part in shapely.get_parts(shapely.from_wkb(bytes(geometry.asWkb()))):
                places = shapely.get_coordinates(part, include_z=True) * unit
                if len(places) > 1:
                    lines.append(MapLine(output, places, row))
    return lines


def road_lines(lines: list[MapLine]) -> list[RoadLine]:
    """Those that run along a road, by the stations in their fields; where none is, the longest line alone, pieces of one line joined."""
    result = []
    for line in lines:
        first, last = line.number("station"), line.number("end")
        if line.output not in LEADING or not (math.isfinite(first) and math.isfinite(last)):
            continue
        places = line.places[::-1] if line.row.get("direction") == -1 else line.places   # driving lines run with the traffic
        road = line.row.get("road")
        made = road_line(road if isinstance(road, int) else 0, LEADING.index(line.output), places, min(first, last), max(first, last))
        result += [made] if made is not None else []
    if result or not lines:
        return result
    best = min(LEADING.index(line.output) if line.output in LEADING else len(LEADING) for line in lines)
    candidates = [line.places for line in lines if (LEADING.index(line.output) if line.output in LEADING else len(LEADING)) == best]
    joined = shapely.get_parts(shapely.line_merge(shapely.multilinestrings([shapely.linestrings(places) for places in candidates])))
    longest = shapely.get_coordinates(max(joined, key=lambda line: line.length), include_z=True)
    made = road_line(0, 0, longest, 0.0, float(np.hypot(*np.diff(longest[:, :2], axis=0).T).sum()))
    return [made] if made is not None else []


def accuracy_of(layers: dict[str, QgsMapLayer]) -> str:
    """What the layers themselves say of their accuracy: the median along the lines of their sigma, and the confidence of the driving lines."""
    sentences = []
    for output, label in (("ROAD_EDGES", tr("road edges")), ("DRIVING_LINES", tr("driving lines"))):
        sigma = _along(layers.get(output), "sigma_m", 0.5)
        if math.isfinite(sigma):
            sentences.append(tr("{what} {number:.1f} cm").format(what=label, number=100 * sigma))
    trust = _along(layers.get("DRIVING_LINES"), "confidence", None)
    if math.isfinite(trust):
        sentences.append(tr("confidence {number:.2f}").format(number=trust))
    return ", ".join(sentences) or tr("not stated")


def _along(layer, name, quantile):
    """The quantile (None: the mean) of a field along the lines of a layer; NaN where there is none."""
    if layer is None or layer.fields().indexOf(name) < 0:
        return math.nan
    rows = [(value, feature.geometry().length()) for feature in layer.getFeatures() if isinstance(value := feature[name], (int, float))]
    rows = sorted(row for row in rows if math.isfinite(row[0]) and row[1] > 0)
    if not rows:
        return math.nan
    values, lengths = np.array(rows, float).T
    if quantile is None:
        return float(np.average(values, weights=lengths))
    return float(values[np.searchsorted(np.cumsum(lengths), quantile * lengths.sum())])


# Sheets along the axes of roads: rectangles of one size, each turned so that the road runs along it from left to right.

OVERLAP = 0.08        # of a sheet that the next one shows again
MOST_HEIGHT = 0.9     # of a sheet's height that the road may take
SHORTEST_REST = 1.0   # m of an axis that may lie on no sheet
SHORTENED = 0.8       # by which the stretch of a sheet is shortened until it fits
LEAST_REACH = 0.15    # of a sheet's width that it shows at least, however tight the bend
CUTS = (1.0, 0.94, 1.06, 0.88, 1.12, 0.82, 1.18, 0.76, 1.24, 0.7)   # of a stretch: the first that ends at no junction
CORNER = 5.0          # m from the edges of a road to where those of a junction begin


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

    def shown(reach):
        """(where it ends, the sheet, whether the road fits on it) of a stretch."""
        end = min(begin + reach, line.length)
        places = np.array([line.interpolate(at).coords[0][:2] for at in np.linspace(begin, end, 41)])
        return end, *_sheet(places, axis, axes, width, height, number + len(sheets))

    while begin < line.length - 1e-6:
        reach = (line.length - begin) / math.ceil((line.length - begin) / (width * (1 - OVERLAP)) - 1e-9)
        while not (stretch := shown(reach))[2] and reach >= LEAST_REACH * width:
            reach *= SHORTENED
        if stretch[0] < line.length:   # at no junction, where that takes no further sheet
            most = round((line.length - begin) / reach - 1) * width * (1 - OVERLAP)
            cuts = (shown(share * reach) for share in CUTS)
            stretch = next((cut for cut in cuts if cut[2] and line.length - cut[0] <= most
                            and not _in_junction(line.interpolate(cut[0]), axis, axes)), stretch)
        end, sheet, _ = stretch
        if sheets:
            here = _heading(line, begin)
            sheets[-1].matches.append(Match(*here, sheet.number))
            sheet.matches.append(Match(*here, sheets[-1].number))
        sheets.append(sheet)
        begin = end
    return sheets


def _in_junction(place, axis, axes):
    """Whether another road meets the axis there."""
    return any(place.distance(LineString(other.places[:, :2])) < math.hypot(axis.half_width + CORNER, other.half_width + CORNER)
               for other in axes if other is not axis)


def _sheet(places, axis, axes, width, height, number):
    """The sheet turned by the chord of a stretch, and whether the road fits on it; roads beside it are shown as a whole where there is room.

    A stretch that is shorter than the sheet lies where the sheet shows most of what goes on from it.
    """
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
    free = max(width * (1 - OVERLAP / 2) - (u2 - u), 0.0) / 2
    around = np.concatenate([other.places[:, :2] for other in axes]) @ turn
    around = around[(np.abs(around[:, 1] - (low + high) / 2) < height / 2) & (around[:, 0] > u - 2 * free) & (around[:, 0] < u2 + 2 * free), 0]
    middle = np.clip((around.min() + around.max()) / 2, (u + u2) / 2 - free, (u + u2) / 2 + free)
    x, y = turn @ (middle, (low + high) / 2)
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
