"""A motorway: two lanes and a hard shoulder each way, a grass median with guard rails, and an exit with its gore; driven both ways."""

from __future__ import annotations

import numpy as np
import shapely

from ..parts.paint import hatched_area
from ..parts.sides import Side
from .builder import PlanBuilder, strip
from .path import Path, path_of_elements
from .scene import PlanScene

# Offsets from the middle of the median, m: a cross-section like RQ 31 of the German guideline for motorways (RAA 2008)
_MEDIAN = 2.0        # half the median: edge of the pavement
_INNER = 2.50        # middle of the inner edge line
_BETWEEN = 6.40      # lane line
_OUTER = 10.30       # middle of the outer edge line
_SHOULDER = 12.95    # outer edge of the pavement
_BROAD, _NARROW = 0.30, 0.15   # m, widths of edge lines and of lane lines
_EXIT_LANE = 3.90    # m between the middles of the lines of the exit lane
_RAMP_SHOULDER = 1.6  # m from the middle of the ramp's edge line to the edge of its pavement
_TAPER = 40.0        # m, over which the exit lane opens
_GORE = 4.0          # m between the lines where the pavement divides
_RAMP_RADIUS = 260.0  # m, of the ramp against the motorway
_WEDGE = 0.9         # m from the ramp's left line to the edge of its pavement
_BEND = 1100.0       # m, radius
_FALL = 0.025        # m per m, away from the median
_DRIVEN = (_BETWEEN + _OUTER) / 2  # m, the outer lane each way
_REACH = 16.0        # m beside the passes that are surveyed
_RUN = 40.0          # m of road beyond both ends


def motorway(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> PlanScene:
    """Build the scene; its bends are those of a motorway and it has no curbs, so `radius`, `curb_height` and `gutter` are not used."""
    straight = length / 3
    axis = path_of_elements((0.0, 0.0), np.radians(12.0), [(_RUN + straight, 0, 0), (60.0, 0, 1 / _BEND), (length + _RUN, 1 / _BEND, 1 / _BEND)],
                            -_RUN)
    s = np.arange(0.0, length + 0.1, 0.25)
    passes = [(Path(axis.at(s, -_DRIVEN)), 2.0), (Path(axis.at(s, _DRIVEN)).reversed(), 2.0)]
    area = strip(axis, 0.0, length, -_DRIVEN - _REACH, _DRIVEN + _REACH)
    road = PlanBuilder("motorway", seed, area)
    opens, nose = 0.10 * length, 0.72 * length
    tip = nose - np.sqrt(2 * _RAMP_RADIUS * _GORE)
    ramp = _Ramp(axis, opens, tip, nose)
    _lines(road, axis, ramp, length)
    _lanes(road, axis, ramp, length)
    _objects(road, axis, ramp, length)
    whole = -_RUN, length + _RUN
    right = shapely.union_all([strip(axis, *whole, -_SHOULDER, -_MEDIAN), strip(axis, opens - 30.0, nose, ramp.pavement, -_OUTER),
                               strip(axis, nose - 3.0, whole[1], ramp.pavement, ramp.inner_pavement)])
    left = strip(axis, *whole, _MEDIAN, _SHOULDER)
    wedge = shapely.buffer(shapely.buffer(right, 0.25), -0.25)   # the nose between motorway and ramp is round
    carriageway = _joined(wedge, left, axis, length)
    median = Side(1, np.array([0.0, 0.3, 24.0]), np.array([0.0, -0.01, 0.03]), np.zeros(3), ("verge", "verge"))
    verge = Side(1, np.array([0.0, 1.0, 2.6, 4.4, 5.0, 6.8, 24.0]), np.array([0.0, -0.05, -0.14, -0.75, -0.75, 0.0, 0.2]), np.zeros(7),
                 ("shoulder", "verge", "verge", "verge", "verge", "verge"))

    def height(places):
        s, d = axis.locate(places)
        return 0.012 * s + 0.2 * np.sin(s / 90.0) - _FALL * np.maximum(np.abs(d) - _MEDIAN, 0.0)

    def outside(ring, k):
        d = axis.locate(ring)[1]
        return ((d > _OUTER) | (d < ramp.pavement(axis.locate(ring)[0]) + 0.5) | (d < -_SHOULDER - 0.5)).astype(int)

    return road.scene(carriageway, height, [median, verge], outside, lambda ring, k: np.where(
        np.abs(axis.locate(ring)[1]) < _MEDIAN + 0.5, "island", "main"), passes)


class _Ramp:
    """Offsets of the exit from the axis of the motorway, at stations of the motorway."""

    def __init__(self, axis, opens, tip, nose):
        self.axis, self.opens, self.tip, self.nose = axis, opens, tip, nose

    def gap(self, s):
        """Distance of the ramp's left line from the outer line of the motorway."""
        return np.maximum(s - self.tip, 0.0) ** 2 / (2 * _RAMP_RADIUS)

    def left(self, s):
        return -_OUTER - self.gap(s)

    def right(self, s):
        share = np.clip((s - self.opens) / _TAPER, 0.0, 1.0)
        return -_OUTER - _EXIT_LANE * share - self.gap(s)

    def pavement(self, s):
        share = np.clip((s - self.opens) / _TAPER, 0.0, 1.0)
        return -_SHOULDER + (_SHOULDER - _OUTER - _EXIT_LANE - _RAMP_SHOULDER) * share - self.gap(s)

    def inner_pavement(self, s):
        return self.left(s) + _WEDGE


def _joined(right, left, axis, length):
    """One polygon of both carriageways, which meet far beyond the end of the survey, so that the median is a ring of its own."""
    ends = [shapely.buffer(shapely.LineString(axis.at(np.array([s, s]), np.array([-_SHOULDER, _SHOULDER]))), 2.0, cap_style="flat")
            for s in (-_RUN + 3.0, length + _RUN - 3.0)]
    return shapely.union_all([right, left, *ends])


def _lines(road, axis, ramp, length):
    end = length
    for side in (1, -1):
        road.line("edge line", axis, 0.0, end, side * _INNER, _BROAD)
        road.line("lane line", axis, 0.0, end, side * _BETWEEN, _NARROW, dash=(6.0, 12.0))
    road.line("edge line", axis, 0.0, end, _OUTER, _BROAD)
    road.line("edge line", axis, 0.0, ramp.opens, -_OUTER, _BROAD)
    road.line("lane line", axis, ramp.opens + 8.0, ramp.tip - 20.0, -_OUTER, _BROAD, dash=(6.0, 6.0))
    road.line("lane line", axis, ramp.tip - 19.0, ramp.tip, -_OUTER, _BROAD)
    road.line("edge line", axis, ramp.opens, end, ramp.right, _BROAD)
    # in the gore, each line begins where the two lie side by side
    apart = ramp.tip + np.sqrt(2 * _RAMP_RADIUS * _BROAD)
    road.line("edge line", axis, ramp.tip, end, -_OUTER, _BROAD)
    road.line("edge line", axis, apart, end, ramp.left, _BROAD)
    s = np.linspace(apart, ramp.nose - 1.0, 60)
    gore = np.concatenate([np.column_stack([s, ramp.left(s) + _BROAD / 2]), np.column_stack([s, np.full(60, -_OUTER - _BROAD / 2)])[::-1]])
    road.figure("hatching", hatched_area(gore, bar=1.0, gap=2.0), axis)


def _lanes(road, axis, ramp, length):
    for number, low, high in ((1, _BETWEEN, _OUTER), (2, _INNER, _BETWEEN)):
        road.lane(1, number, axis, 0.0, length, low, high, -1)
    for number, low, high in ((3, _INNER, _BETWEEN), (4, _BETWEEN, _OUTER)):
        road.lane(2, number, axis, 0.0, length, -high, -low, 1)
    road.lane(2, 5, axis, ramp.opens + _TAPER, length, ramp.right, ramp.left, 1)


def _objects(road, axis, ramp, length):
    for offset in (0.6, -0.6):
        road.rail(axis, -10.0, length + 10.0, offset)
    road.rail(axis, -10.0, length + 10.0, _SHOULDER + 1.0)
    for place in road.along(axis, 5.0, length, 50.0, -_SHOULDER - 5.0):
        road.pole(place, 1.0)
    for place in road.along(axis, 12.0, length, 21.0, _SHOULDER + 9.0):
        road.tree(place)
    for place in road.along(axis, 20.0, length, 33.0, -_SHOULDER - 11.0):
        road.tree(place)
    # a van that broke down on the hard shoulder, and one on the other side
    for station, offset, turn in ((0.86 * length, -_OUTER - 1.5, 0.0), (0.3 * length, _OUTER + 1.5, np.pi)):
        road.car(axis.at(station, offset)[0], float(axis.heading(station)[0]) + turn, (4.9, 1.9, 1.95))
    road.patch(axis, 0.2 * length, 0.2 * length + 18.0, -_BETWEEN + 0.2, -_INNER - 0.4, 1.35)
    road.patch(axis, 0.5 * length, 0.5 * length + 12.0, _BETWEEN + 0.3, _OUTER - 0.4, 0.72)
