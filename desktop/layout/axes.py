"""The axes of the roads of a map, from its lines alone: smooth, with stations and heights of the ground, whatever way the vehicle took."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

STEP = 1.0             # m of station between places of an axis
SMOOTHED = 3.0         # m, sigma of the smoothing along the axis, which moves it by SMOOTHED² / 2 radius
CENTRED = 40.0         # m, sigma of the smoothing by which it comes back to the middle of its lines: a lane that begins turns it by a degree
LONGEST_GAP = 60.0     # m without any line that an axis bridges
SHORTEST_LINE = 5.0    # m
STRETCH = (0.8, 1.25)  # length of a line per length of its stations: others run across the road, as at a corner
USUAL = 75.0           # %: the half width of a road is that of so many of its stations; others are wider, as at a junction
ON_AXIS = 1.0          # m within which a line to one side alone tells the height on the axis
BESIDE = 25.0          # m from the axis to lines that tell the height of the ground


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
        course = np.stack([_smooth(np.interp(part, known, axis[known, column]), SMOOTHED) for column in (0, 1)], axis=-1)
        inside = (rows >= part[0]) & (rows <= part[-1])
        heights, half_width = _across(rows[inside] - part[0], places[inside], course)
        yield Axis(road, (first + part) * STEP, np.c_[course, heights], half_width)


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
