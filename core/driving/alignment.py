"""The alignment that the lanes of a road have in common, the smooth courses of lanes through it, and the elements of their curves."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from heapq import heappop, heappush
from typing import Any

import numpy as np

from ..common.parallel import check_cancelled
from ..countries.catalogue import NEUTRAL, Country
from ..curves.base import Arc, CurveFit
from ..curves.model_selection import fit_curves
from ..curves.segmentation import element_ranges
from ..execution.in_step import Asked, Work
from ..execution.phase import NoSource, Phase
from ..io.crs import FOOT
from ..markings.cross_section.sections import STATION_STEP
from ..survey.frame.road import Road
from .lane_track import BRIDGED, LANE_STATUS, LaneTrack, spans_of
from .weights import ALIGNMENT


@dataclass(frozen=True)
class Element:
    """An arc or a straight of one lane, from station `start` to `end`."""

    start: float
    end: float
    arc: Arc   # Arc in the road's direction, local metres
    rmse: float   # of the lane's places to it, metres
    complete: bool   # False where the lane or the road's lines end before the element does


@dataclass
class Course:
    """A lane's line."""

    x: np.ndarray   # (V,) vertices in local metres and their stations, s rising
    y: np.ndarray
    s: np.ndarray
    curve: object   # the fitted curve
    rmse: float   # of the lane's places to it, metres


@dataclass(frozen=True)
class LanesOfRoad:
    """The lanes of a road, the (K,) grid stations on which they run, and the lanes on its asphalt that other roads have."""

    tracks: list[LaneTrack]
    s: np.ndarray
    road: Road
    of_others: Sequence[LaneTrack] = ()


def fitted_lanes(roads: Sequence[LanesOfRoad]) -> Work:
    """The work that gives the courses of the lanes of each road, and the arcs and straights of every lane, in order of station.

    Lanes of a road run parallel, so that their bends are concentric: what they have in common (the mean of their offsets, each less its own) is
    divided into elements once, with all of their evidence, and each lane's elements are the parallels. A lane that is not parallel to the others is
    divided alone.
    """
    groups = [_parallel_groups(lanes) for lanes in roads]
    long = [axis for of_road in groups for _, axis in of_road if len(axis.at) >= ALIGNMENT.min_places_per_fit]
    curves = Phase(curves_of_lanes, NoSource(), (), lambda item: "the courses of lanes", listed=ALIGNMENT.fitted_together)
    places = [_known_places(track, lanes) for lanes in roads for track in lanes.tracks]
    asked = [*((*axis.thinned, "divided") for axis in long), *((x, y, "whole") for _, x, y in places)]
    known = yield Asked(curves, asked, 0.6)
    parts, courses = {id(axis): cuts for axis, cuts in zip(long, known)}, iter(known[len(long):])
    elements_of = [(*axis.part(first, last), "element") for axis in long for first, last, _ in parts[id(axis)]]
    fits = iter((yield Asked(curves, elements_of, 1.0)))
    divided = {key: [(first, last, next(fits).curve) for first, last, _ in cuts] for key, cuts in parts.items()}
    elements: list[list[list[Element]]] = [[[] for _ in lanes.tracks] for lanes in roads]
    for lanes, of_road, of_lane in zip(roads, groups, elements):
        for members, axis in of_road:
            cuts = [(*map(float, np.interp([first, last], axis.u, axis.at)), curve) for first, last, curve in divided.get(id(axis), ())]
            for i, offset in members:
                of_lane[i] = _of_lane(lanes.tracks[i], offset, cuts, lanes.s, lanes.road)
    fitted = zip(courses, places)
    return [(_courses([(fit, *place) for _, (fit, place) in zip(lanes.tracks, fitted)], lanes.road, of_lane), of_lane)
            for lanes, of_lane in zip(roads, elements)]


def curves_of_lanes(source: NoSource, lines: Sequence[tuple[np.ndarray, np.ndarray, str]]) -> list[CurveFit | list[tuple[float, float, str]]]:
    """The phase that fits curves to lines, (x, y, kind): what `fit_curves` fits to a "whole" line or to one "element" of an alignment.

    Of a line that is to be "divided" into elements these are its `element_ranges`.
    """
    fits: dict[int, Any] = {}
    for kind, fit in (("whole", fit_curves), ("element", partial(fit_curves, elements=True)), ("divided", element_ranges)):
        rows = [k for k, line in enumerate(lines) if line[2] == kind]
        fits.update(zip(rows, fit([lines[k][:2] for k in rows])))
    return [fits[k] for k in range(len(lines))]


def _parallel_groups(lanes):
    """[([(number of a lane, its offset from the axis)], _Axis)] of the parallel lanes of a road."""
    order = sorted(range(len(lanes.tracks)), key=lambda i: (-len(lanes.tracks[i]), i))
    by_length = [lanes.tracks[i] for i in order]
    waiting, spans = set(range(len(order))), spans_of(by_length)
    groups = []
    for rank in range(len(order)):
        if rank in waiting:
            members, axis, first = _parallel_lanes(rank, by_length, waiting, spans)
            groups.append(([(order[k], offset) for k, offset in members], _Axis.of(lanes.s, axis, first, lanes.road)))
            check_cancelled()
    return groups


def _parallel_lanes(longest, tracks, waiting, spans):
    """The longest waiting lane of some in order of length, and all that are parallel to it, directly or through others; they wait no longer.

    Returns (index, offset from the axis) of each, (N,) offset of the common axis, and the grid station that this begins at.
    """
    common = _CommonAxis(tracks[longest], spans.stations)
    members = [(longest, common.offset)]
    waiting.remove(longest)
    added = True
    while added:
        added = False
        # in order of length; where the axis grows more lanes come into its reach
        queue = [k for k in spans.near(common.low, common.high).tolist() if k in waiting]
        queued = set(queue)
        while queue:
            k = heappop(queue)
            offset = common.offset_of(tracks[k])
            if offset is None:
                continue
            low, high = common.low, common.high
            common.add(tracks[k], offset)
            members.append((k, offset))
            waiting.remove(k)
            added = True
            for more in (spans.near(common.low, low), spans.near(high, common.high)):
                for neighbour in more.tolist():
                    if neighbour > k and neighbour in waiting and neighbour not in queued:
                        heappush(queue, neighbour)
                        queued.add(neighbour)
    reach = slice(common.low, common.high + 1)
    return members, common.total[reach] / common.weight[reach], common.low


class _CommonAxis:
    """The weighted mean of the offsets of parallel lanes, each less its own offset from the axis, from grid station `low` to `high`.

    total, weight : (K,) of all stations of the road
    """

    def __init__(self, track, stations):
        # rounded, as are those of others, so that a lane that is corrected somewhere moves the axis of a long road nowhere else
        self.low, self.high, self.offset = track.first, track.last, round(float(np.median(track.d)), 1)
        self.total, self.weight = np.zeros(stations), np.zeros(stations)
        self.add(track, self.offset)

    def add(self, track, offset):
        self.low, self.high = min(self.low, track.first), max(self.high, track.last)
        # a bridged place says little, but more than nothing where it is alone
        w = np.where(track.status == BRIDGED, 1e-3, 1.0)
        self.total[track.stations] += w * (track.d - offset)
        self.weight[track.stations] += w

    def offset_of(self, track):
        """By how much a lane lies beside the axis; None where it is not parallel to it, or where they hardly run together."""
        total, weight = self.total[track.stations], self.weight[track.stations]
        shared = weight > 0
        if shared.sum() * STATION_STEP < min(ALIGNMENT.min_shared_lane_length, 0.5 * len(track) * STATION_STEP):
            return None
        apart = track.d[shared] - total[shared] / weight[shared]
        offset = round(float(np.median(apart)), 2)
        return None if np.percentile(np.abs(apart - offset), 95) > ALIGNMENT.max_parallel_deviation else offset


@dataclass(frozen=True)
class _Axis:
    """Places x, y (N,) of what lanes have in common, their stations and lengths `u` along it."""

    at: np.ndarray
    x: np.ndarray
    y: np.ndarray
    u: np.ndarray

    @classmethod
    def of(cls, s, d, first, road):
        stations = s[first:first + len(d)]
        x, y = road.to_map(stations, d)
        return cls(stations, x, y, _lengths(x, y))

    @property
    def thinned(self):
        """x, y of places a metre apart."""
        rows = np.unique(np.r_[np.arange(0, len(self.x), int(ALIGNMENT.division_spacing / STATION_STEP)), len(self.x) - 1])
        return self.x[rows], self.y[rows]

    def part(self, first, last):
        """x, y of the places between two lengths."""
        inside = slice(np.searchsorted(self.u, first), np.searchsorted(self.u, last, side="right"))
        return self.x[inside], self.y[inside]


def _of_lane(track, offset, divided, s, road):
    stations = s[track.first:track.last + 1]
    x, y = road.to_map(stations, track.d)
    elements = []
    ends = [end for _, end, _ in divided]
    for k in range(bisect_left(ends, stations[0]), len(divided)):
        start, end, curve = divided[k]
        if start > stations[-1]:
            break
        a, b = max(start, stations[0]), min(end, stations[-1])
        inside = slice(np.searchsorted(stations, a), np.searchsorted(stations, b, side="right"))
        if not isinstance(curve, Arc) or inside.stop - inside.start < ALIGNMENT.min_places_per_fit:
            continue
        u, e = curve.parallel(offset).project(x[inside], y[inside])
        arc = curve.parallel(offset + float(np.median(e)))
        u, e = arc.project(x[inside], y[inside])
        complete = 0 < k < len(divided) - 1 and start >= stations[0] and end <= stations[-1]
        elements.append(Element(a, b, _cut(arc, float(u[0]), float(u[-1])), float(np.sqrt(np.mean(e**2))), complete))
    return elements


def _cut(arc, first, last):
    (x, y), = arc.at(np.array([first]))
    return Arc(float(x), float(y), float(arc.heading(first)), arc.bend, last - first)


# The smooth course of a lane, its pieces by status, and the arcs in it.


def _courses(fits, road, elements):
    """The Courses of lanes of a road: of each its fit, and the stations, x and y of its known places. On an Element it is the arc or straight itself.

    So lanes of a bend are concentric. A place lies near two stretches of a road that turns back, and the lane tells of which it is.
    """
    drawn = [fit.curve.sample(STATION_STEP) for fit, *_ in fits]
    near = [np.interp(_lengths(*places.T), _lengths(x, y), s) for places, (_, s, x, y) in zip(drawn, fits)]
    stations = road.locate(*np.concatenate(drawn).T, np.concatenate(near))[0] if drawn else np.empty(0)
    courses, first = [], 0
    for (fit, *_), places, of_lane in zip(fits, drawn, elements):
        station = stations[first:first + len(places)]
        first += len(places)
        rising = np.isfinite(station)
        rising[rising] &= station[rising] > np.r_[-np.inf, np.maximum.accumulate(station[rising])[:-1]]
        places, station = places[rising], station[rising]
        for element in of_lane:
            if element.rmse < ALIGNMENT.max_shared_arc_rmse:
                _draw_to(element, places, station)
        check_cancelled()
        courses.append(Course(places[:, 0], places[:, 1], station, fit.curve, fit.rmse))
    return courses


def _known_places(track, lanes):
    """Stations, x, y of a lane where it is not bridged, of all of it where little is known."""
    measured = track.status != BRIDGED
    if measured.sum() < ALIGNMENT.min_places_per_fit:
        measured = np.ones(len(track), bool)
    stations = lanes.s[track.first:track.last + 1][measured]
    return stations, *lanes.road.to_map(stations, track.d[measured])


def _lengths(x, y):
    return np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]


def _draw_to(element, places, station):
    """Move places onto an element, less and less towards its ends unless the lane ends there."""
    inside = slice(np.searchsorted(station, element.start), np.searchsorted(station, element.end, side="right"))
    stations = station[inside]
    if not len(stations):
        return
    share = np.ones(len(stations))
    if element.start - station[0] > STATION_STEP:
        share = np.minimum(share, (stations - element.start) / ALIGNMENT.arc_blend_length)
    if station[-1] - element.end > STATION_STEP:
        share = np.minimum(share, (element.end - stations) / ALIGNMENT.arc_blend_length)
    u, e = element.arc.project(places[inside, 0], places[inside, 1])
    heading = element.arc.heading(u)
    places[inside] -= (np.clip(share, 0.0, 1.0) * e)[:, None] * np.c_[-np.sin(heading), np.cos(heading)]


def without_short_status(status: np.ndarray) -> np.ndarray:
    """Status along a lane without changes shorter than 5 m: these take the worse of their neighbours, the shortest first."""
    begins = np.flatnonzero(np.append(True, np.diff(status) != 0))
    codes, lengths = status[begins], np.diff(np.append(begins, len(status)))
    while len(codes) > 1 and lengths.min() < int(ALIGNMENT.min_status_length / STATION_STEP):
        k = int(np.argmin(lengths))
        codes[k] = max(codes[i] for i in (k - 1, k + 1) if 0 <= i < len(codes))
        begins = np.flatnonzero(np.append(True, np.diff(codes) != 0))
        codes, lengths = codes[begins], np.add.reduceat(lengths, begins)
    return np.repeat(codes, lengths)


def track_pieces(track: LaneTrack, s: np.ndarray) -> list[tuple[int, float, float]]:
    """(status, start station, end station) of the pieces of a lane, cut where its status changes and where doubt begins or ends; ends touch."""
    kinds = len(LANE_STATUS)
    status = without_short_status(track.status + kinds * track.in_doubt)
    cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
    bounds = s[track.first + np.append(cuts[:-1], len(status) - 1)].tolist()
    return [(int(status[cut]) % kinds, begin, end) for cut, begin, end in zip(cuts[:-1], bounds[:-1], bounds[1:])]


def element_of(elements: list[Element], start: float, end: float) -> Element | None:
    """The arc or straight that covers nine tenths of a piece between two stations, or None."""
    for element in elements[bisect_left([candidate.end for candidate in elements], start):]:
        if element.start > end:
            break
        if min(end, element.end) - max(start, element.start) >= ALIGNMENT.min_element_share * (end - start):
            return element
    return None


# Elements of the curves along driving lines, in metres and feet, and their check against the design code.


def circular_curve_elements(radius: float, delta: float) -> dict[str, float]:
    """The elements of a circular curve of `radius`, m, and deflection angle `delta`, radians between 0 and pi, as fields of CURVE_ELEMENTS.

    ::

        L = R delta              T = R tan(delta/2)      LC = 2 R sin(delta/2)
        M = R (1 - cos(delta/2)) E = R (sec(delta/2) - 1)
        D = 5729.578 / R         (arc definition: degrees per 100 m or per 100 ft)

    so that M = E cos(delta/2) < E.
    """
    half = delta / 2
    lengths = dict(radius=radius, length=radius * delta, tangent=radius * np.tan(half),
                   middle=radius * (1 - np.cos(half)), chord=2 * radius * np.sin(half),
                   ext=radius * (1 / np.cos(half) - 1))
    result = {}
    for name, metres in lengths.items():
        result[f"{name}_m"], result[f"{name}_ft"] = float(metres), float(metres / FOOT)
    result["delta_deg"] = float(np.degrees(delta))
    result["degree_m"] = float(np.degrees(100.0 / radius))
    result["degree_ft"] = float(np.degrees(100.0 / (radius / FOOT)))
    return result


def curve_points(start: Sequence[float], heading: float, radius: float, delta: float, left: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of curvature, of intersection and of tangency of a circular curve, (2,) m each.

    `heading` : radians counter-clockwise from east, its direction where it begins; `delta` : radians, its deflection angle.
    """
    turn = delta if left else -delta
    tangent = radius * np.tan(delta / 2)
    pc = np.asarray(start, float)
    pi = pc + tangent * np.array([np.cos(heading), np.sin(heading)])
    pt = pi + tangent * np.array([np.cos(heading + turn), np.sin(heading + turn)])
    return pc, pi, pt


def design_check(radius: float, length: float, complete: bool = True, code: Country = NEUTRAL) -> tuple[int | None, str]:
    """The highest design speed, km/h, that the design code of a country allows for a curve, None where it allows none, and a sentence on it.

    `complete` : False where the arc runs on beyond the line, so that its length is not known.
    """
    slowest = code.design_speeds[0]
    by_radius = max((row.speed for row in code.design_speeds if radius >= row.radius), default=0)
    by_length = max((row.speed for row in code.design_speeds if length >= row.length), default=0)
    speed = min(by_radius, by_length) if complete else by_radius
    if not by_radius:
        return None, f"{code.design_code}: radius {radius:.0f} m is below {slowest.radius:.0f} m, the least for {slowest.speed} km/h"
    text = f"{code.design_code}: radius allows {by_radius} km/h"
    if not complete:
        return speed, text + "; the curve goes on beyond the line"
    if not any(row.length for row in code.design_speeds):
        return speed, text
    if not by_length:
        return None, text + f", length {length:.0f} m is below {slowest.length:.0f} m, the least for {slowest.speed} km/h"
    return speed, text + f", length {by_length} km/h"


def is_curve(arc: Arc) -> bool:
    """Whether an arc is a curve with elements: no straight, and no turn so small or so large that its elements mean nothing."""
    return bool(arc.bend and arc.radius <= ALIGNMENT.max_curve_radius and ALIGNMENT.min_turn < abs(arc.bend) * arc.length < ALIGNMENT.max_turn)


def element_row(arc: Arc, complete: bool, rmse: float, origin: np.ndarray, code: Country = NEUTRAL) -> dict[str, Any]:
    """Fields of CURVE_ELEMENTS of an arc for which `is_curve` holds, local metres, in the direction of travel.

    `complete` : False where the arc runs on beyond the line; `rmse` : m, of the line from the arc; `origin` : map coordinates of the local origin.
    """
    delta, left = abs(arc.bend) * arc.length, arc.bend > 0
    pc, pi, pt = curve_points((arc.x + origin[0], arc.y + origin[1]), arc.direction, arc.radius, delta, left)
    speed, text = design_check(arc.radius, arc.length, complete, code)
    return dict(circular_curve_elements(arc.radius, delta), turn="left" if left else "right", pc_x=float(pc[0]), pc_y=float(pc[1]),
                pi_x=float(pi[0]), pi_y=float(pi[1]), pt_x=float(pt[0]), pt_y=float(pt[1]), rmse_m=float(rmse),
                speed_kmh=speed, code=text)
