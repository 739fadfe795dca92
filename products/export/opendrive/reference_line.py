"""A reference line of straight lines, arcs and spirals through the places of a border."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....core.curves.clothoid import GAUSS_RULES, gauss_rule
from ..sources import wrapped
from .geometry import STRAIGHT_BEND, PlanElement, PlanView

LEAST_PIECE = 1.0       # m of an element: shorter ones follow noise
LEAST_STRAIGHT = 20.0   # m of a straight line that is looked for first: it may bend by a radius of 10 km at a tolerance of 1 cm
STRAIGHT_SHARE = 0.25   # of the tolerance by which a place may lie beside it
TRIMMED = 1.0           # m that it loses at its ends, where the bend begins within the tolerance
WINDOWS = (12.0, 6.0, 3.0, 1.5)   # m before and after a place from which its direction is taken: as much as a cubic follows
FEWEST_PLACES = 7       # of a cubic for a direction
NOISE_TIMES = 4.0       # standard deviations of noise that a place may lie beside such a cubic
EXACT_SHARE = 0.05      # of the tolerance that it may beside noise
NOISE_PLACES = 15       # at which the noise is measured
PLAINER_TURN = 0.002    # rad by which an arc or a line may miss the direction at its end, in place of a spiral that does not
SAME_DIRECTION = 1e-7   # rad
PLAINER_REACH = 0.7     # of a spiral's length from which an arc or a line is taken in its place
MOST_ANGLE = 2.0        # rad between the ends of an element and its chord
NEWTON_ROUNDS = 8
FIRST_STEP = 4          # places by which the search for the farthest one begins


class _Pose(NamedTuple):
    x: float
    y: float
    heading: float


def fit_reference(points: np.ndarray, tolerance: float, ends: tuple[float | None, float | None] = (None, None),
                  turn_tolerance: float = 0.01) -> PlanView | None:
    """Lines, arcs and spirals that join without a gap or a kink, each as long as the tolerance allows.

    Long straight lines are found first. Between them every element leads from the place and direction where the last one ends to the farthest
    place, in its direction there, that a spiral reaches within the tolerance [1]_; an arc or a line is taken where it reaches about as far. Places
    and directions are those of a cubic through the places around, so that noise does not turn them. The work grows with the number of places.

    Parameters
    ----------
    points : (N, 2) metres in order
    tolerance : metres that a point may lie beside it
    ends : radians, headings that it has at its start and end, None for any
    turn_tolerance : radians by which an arc or a line may miss that at the end

    Returns
    -------
    PlanView from the first point to the last one; None where even short elements miss the points

    References
    ----------
    .. [1] Bertolazzi and Frego (2015), G1 fitting with clothoids, Mathematical Methods in the Applied Sciences 38(5), 881-897.
    """
    points = np.asarray(points, float)
    fit, after = _Fit(points, tolerance, ends, turn_tolerance), None
    if ends[1] is not None and abs(wrapped(fit.natural_heading(fit.last) - ends[1])) > turn_tolerance:
        # a road that turns at its end does so along the longest element that leads there, which is found from the end backwards
        back = _Fit(points[::-1], tolerance, (ends[1] + np.pi, None), turn_tolerance)
        last = back.farthest(0, back.pose(0), back.last)
        if last is None:
            return None
        reached, element, pose = last
        if reached < back.last:
            pose = pose._replace(heading=pose.heading + np.pi)
            points = np.concatenate([points[:back.last - reached], [pose[:2]]])
            fit = _Fit(points, tolerance, (ends[0], pose.heading), turn_tolerance)
            after = PlanElement(0.0, pose.x, pose.y, pose.heading, element.length, element.kind, tuple(-value for value in element.values[::-1]))
    elements = fit.run()
    return PlanView(_in_order([*elements, after] if after is not None else elements)) if elements is not None else None


class _Fit:
    """One line of points on its way to elements."""

    def __init__(self, points, tolerance, ends, turn_tolerance):
        self.points, self.tolerance, self.ends, self.turn_tolerance = points, tolerance, ends, turn_tolerance
        self.along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
        self.last = len(points) - 1
        self.known = {}
        self.noise = 0.0
        places = np.unique(np.linspace(0, self.last, NOISE_PLACES).astype(int))
        self.noise = float(np.median([self._local(k, WINDOWS[-1])[1] for k in places])) if self.last >= FEWEST_PLACES else 0.0
        self.straight = self._straight_lines()

    def run(self):
        """The elements in order, None where even short ones miss the points."""
        elements, start, pose = [], 0, self.pose(0)
        starts = sorted(self.straight)
        while start < self.last:
            end = self.straight.get(start)
            if end is not None:
                reached = end, *self._line(pose, end)
            else:
                limit = next((k for k in starts if k > start), self.last)
                reached = self.farthest(start, pose, limit)
            if reached is None:
                return None
            start, element, pose = reached
            elements.append(element)
        return elements

    def farthest(self, here, pose, limit):
        """(place, element, pose at its end) of the element from a place that reaches farthest, None where none does."""
        spiral = self._reach(here, pose, limit)
        if spiral is None:
            return None
        length = self.along[spiral[0]] - self.along[here]
        if spiral[0] < limit and length < LEAST_PIECE:
            return None
        nearer = int(np.searchsorted(self.along, self.along[here] + PLAINER_REACH * length))
        for end in (spiral[0], nearer):
            if end == limit or self.along[end] - self.along[here] >= LEAST_PIECE <= self.along[limit] - self.along[end]:
                for plainer in (self._line, self._arc):
                    fitted = self._good(plainer, here, pose, end)
                    if fitted is not None:
                        return end, *fitted
        return spiral

    def _reach(self, here, pose, limit):
        """The spiral that ends at the farthest place, by doubling steps and halving; no rest shorter than LEAST_PIECE is left."""
        good, bad, step = None, limit + 1, FIRST_STEP
        tried = min(int(np.searchsorted(self.along, self.along[here] + LEAST_PIECE)), limit)
        while True:
            fitted = self._good(self._spiral, here, pose, tried)
            if fitted is None:
                bad = tried
            else:
                good = tried, *fitted
                if tried == limit:
                    return good
            if good is None:
                # a piece that is shorter than the least one ends only where the line does
                return None
            if bad > limit:
                step *= 2
                tried = min(tried + step, limit)
            elif bad - good[0] > 1 + (good[0] - here) // 16:   # a sixteenth of an element is not worth the search
                tried = (good[0] + bad) // 2
            else:
                break
        if self.along[limit] - self.along[good[0]] < LEAST_PIECE:
            back = int(np.searchsorted(self.along, (self.along[here] + self.along[limit]) / 2))
            fitted = self._good(self._spiral, here, pose, back) if here < back < limit else None
            return (back, *fitted) if fitted is not None else good
        return good

    def _good(self, make, here, pose, there):
        """(element, pose at its end) if no place between misses it by more than the tolerance, else None."""
        fitted = make(pose, there)
        if fitted is None:
            return None
        element, end = fitted
        places = self.points[here:there + 1]
        u = (self.along[here:there + 1] - self.along[here]) * (element.length / (self.along[there] - self.along[here]))
        for _ in range(2):
            on, heading, bend = element.at(u)
            offsets = places - on
            c, s = np.cos(heading), np.sin(heading)
            offset = offsets[:, 1] * c - offsets[:, 0] * s
            u = u + (offsets[:, 0] * c + offsets[:, 1] * s) / np.clip(1 - bend * offset, 0.2, 5.0)
        return fitted if np.abs(offset).max() <= self.tolerance and (u[1:] > u[:-1] - self.tolerance).all() else None

    # elements from a pose to a place

    def _spiral(self, pose, there):
        end = self.pose(there)
        element = _spiral_between(pose, end)
        return (element, end) if element is not None else None

    def _arc(self, pose, there):
        end = self.pose(there)
        dx, dy = end.x - pose.x, end.y - pose.y
        angle = wrapped(np.arctan2(dy, dx) - pose.heading)
        if abs(angle) > MOST_ANGLE or abs(wrapped(pose.heading + 2 * angle - end.heading)) > self._turn(there):
            return None
        chord = float(np.hypot(dx, dy))
        bend = 2 * float(np.sin(angle)) / max(chord, 1e-9)
        if abs(bend) < STRAIGHT_BEND * 1e-3:
            return None
        element = PlanElement(0.0, *pose, 2 * float(angle) / bend, "arc", (bend,))
        return element, _Pose(*element.end())

    def _line(self, pose, there):
        end = self.pose(there)
        length = (end.x - pose.x) * np.cos(pose.heading) + (end.y - pose.y) * np.sin(pose.heading)
        if length <= 0 or abs(wrapped(pose.heading - end.heading)) > self._turn(there):
            return None
        element = PlanElement(0.0, *pose, float(length))
        return element, _Pose(*element.end())

    def _turn(self, there):
        if there in self.straight:   # a long straight line goes on in its own direction
            return SAME_DIRECTION
        return min(PLAINER_TURN, self.turn_tolerance) if there == self.last and self.ends[1] is not None else PLAINER_TURN

    # places and directions

    def pose(self, k):
        """The smoothed place and direction at a point; the first and last place are met, and the directions given there."""
        if k not in self.known:
            self.known[k] = self._pose(k)
        return self.known[k]

    def natural_heading(self, k):
        """Radians of the points' own direction."""
        return self._smoothed(k)[2]

    def _smoothed(self, k):
        allowed = NOISE_TIMES * self.noise + EXACT_SHARE * self.tolerance
        for window in WINDOWS:
            pose, _, worst = self._local(k, window)
            if worst <= allowed:
                break
        return pose

    def _pose(self, k):
        x, y, heading = self._smoothed(k)
        if k in (0, self.last):
            x, y = self.points[k]
            given = self.ends[0 if k == 0 else 1]
            heading = given if given is not None else heading
        return _Pose(float(x), float(y), float(heading))

    def _local(self, k, window):
        """(pose, standard deviation, largest distance) of a cubic through the places around a point."""
        station = self.along[k]
        first = min(self.along.searchsorted(station - window), max(k - FEWEST_PLACES // 2, 0))
        last = max(self.along.searchsorted(station + window + 1e-9), min(k + FEWEST_PLACES // 2 + 1, self.last + 1))
        s, offsets, count = self.along[first:last] - station, self.points[first:last] - self.points[k], last - first
        degree = min(3, count - 2) if count > 2 else 1
        s /= max(-s[0], s[-1], 1e-9)
        powers = np.ones((degree + 1, count))
        for power in range(1, degree + 1):
            powers[power] = powers[power - 1] * s
        square = powers @ powers.T
        square.flat[::degree + 2] += np.finfo(float).eps * count   # places may coincide
        coefficients = np.linalg.solve(square, powers @ offsets)
        dx, dy = coefficients[1]
        aside = np.array([-dy, dx]) / max(np.hypot(dx, dy), 1e-12)
        missed = offsets @ aside - (coefficients @ aside) @ powers
        spread = float(np.sqrt(missed @ missed / max(count - degree - 1, 1)))
        return (*(self.points[k] + coefficients[0]), float(np.arctan2(dy, dx))), spread, float(np.abs(missed).max())

    def _straight_lines(self):
        """{first place: last place} of long straight lines, whose places get a pose on them."""
        lines, start = {}, 0
        while start < self.last:
            if self.along[self.last] - self.along[start] < LEAST_STRAIGHT:
                break
            least = int(np.searchsorted(self.along, self.along[start] + LEAST_STRAIGHT))
            if not self._is_straight(start, least):
                start = max(start + 1, int(np.searchsorted(self.along, self.along[start] + LEAST_STRAIGHT / 8)))
                continue
            good, bad, step = least, self.last + 1, least - start
            while good < self.last and bad - good > 1:
                tried = min(good + step, self.last) if bad > self.last else (good + bad) // 2
                if self._is_straight(start, tried):
                    good, step = tried, 2 * step
                else:
                    bad = tried
            first = start if start == 0 else int(np.searchsorted(self.along, self.along[start] + TRIMMED))
            last = good if good == self.last else int(np.searchsorted(self.along, self.along[good] - TRIMMED))
            if self.along[last] - self.along[first] >= LEAST_STRAIGHT / 2 and self._lay_on_line(first, last):
                lines[first] = last
            start = good + 1
        return lines

    def _is_straight(self, first, last):
        return bool(np.abs(_beside_line(self.points[first:last + 1])[0]).max() <= max(STRAIGHT_SHARE * self.tolerance, NOISE_TIMES * self.noise))

    def _lay_on_line(self, first, last):
        """Give the ends of a straight line their poses; False where a direction that is given at an end is another."""
        _, middle, way = _beside_line(self.points[first:last + 1])
        heading = float(np.arctan2(way[1], way[0]))
        for k, given in ((0, self.ends[0]), (self.last, self.ends[1])):
            if k in (first, last) and given is not None:
                if abs(wrapped(given - heading)) > self.turn_tolerance:
                    return False
        places = [middle + way * ((self.points[k] - middle) @ way) for k in (first, last)]
        for k, point in zip((first, last), places):
            self.known[k] = _Pose(float(point[0]), float(point[1]), heading)
        return True


def _beside_line(points):
    """((N,) metres of places beside the straight line through them, a place of it, its direction)."""
    middle = points.mean(0)
    offsets = points - middle
    _, vectors = np.linalg.eigh(offsets.T @ offsets)
    way = vectors[:, 1] * (1.0 if (points[-1] - points[0]) @ vectors[:, 1] > 0 else -1.0)
    return offsets[:, 1] * way[0] - offsets[:, 0] * way[1], middle, way


def _spiral_between(start, end):
    """The spiral from one pose to another, None where it would turn too far."""
    dx, dy = end.x - start.x, end.y - start.y
    chord, way = float(np.hypot(dx, dy)), float(np.arctan2(dy, dx))
    first, last = wrapped(start.heading - way), wrapped(end.heading - way)
    if chord < 1e-6 or max(abs(first), abs(last)) > MOST_ANGLE:
        return None
    turn, change = last - first, 3 * (first + last)
    nodes, weights = GAUSS_RULES[gauss_rule(abs(turn) + abs(change))]
    for _ in range(NEWTON_ROUNDS):   # the unit spiral from `first` shall end on the chord
        angles = change * nodes**2 + (turn - change) * nodes + first
        aside, slope = np.sin(angles) @ weights, (np.cos(angles) * (nodes**2 - nodes)) @ weights
        if abs(slope) < 1e-12:
            return None
        step = aside / slope
        change -= step
        if abs(step) < 1e-13:
            break
    forth = float(np.cos(change * nodes**2 + (turn - change) * nodes + first) @ weights)
    if abs(aside) > 1e-9 or forth <= 0.1:
        return None
    length = chord / forth
    return _element(start, length, (turn - change) / length, (turn + change) / length)


def _element(pose, length, first, last):
    if abs(first) < STRAIGHT_BEND * 1e-3 and abs(last) < STRAIGHT_BEND * 1e-3:
        return PlanElement(0.0, *pose, length)
    if abs(first - last) < 1e-9:
        return PlanElement(0.0, *pose, length, "arc", (float(first + last) / 2,))
    return PlanElement(0.0, *pose, length, "spiral", (float(first), float(last)))


def _in_order(elements):
    """The elements with their s; neighbours that are one line as one."""
    result: list[PlanElement] = []
    s = 0.0
    for element in elements:
        before = result[-1] if result else None
        if before is not None and before.kind == element.kind == "line" and abs(wrapped(before.heading - element.heading)) < 1e-9:
            result[-1] = PlanElement(before.s, before.x, before.y, before.heading, before.length + element.length)
        else:
            result.append(PlanElement(s, element.x, element.y, element.heading, element.length, element.kind, element.values))
        s += element.length
    return tuple(result)


def polynomial_reference(points: np.ndarray) -> PlanView:
    """A line of parametric cubics through (N, 2) points, joined without a kink: for borders that no other element follows."""
    from scipy.interpolate import CubicSpline

    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    curve = CubicSpline(along, points)
    elements, s = [], 0.0
    for k in range(len(along) - 1):
        d, c, b, a = curve.c[:, k]
        heading = float(np.arctan2(b[1], b[0]))
        cosine, sine = np.cos(heading), np.sin(heading)
        span = along[k + 1] - along[k]
        local = [np.array([cosine * p[0] + sine * p[1], -sine * p[0] + cosine * p[1]]) for p in (b, c, d)]
        u = np.linspace(0.0, span, 17)
        slope = local[0][:, None] + 2 * local[1][:, None] * u + 3 * local[2][:, None] * u**2
        speed = np.hypot(*slope)
        length = float(((speed[1:] + speed[:-1]) / 2 * np.diff(u)).sum())
        stretch = span / length
        values = (0.0, *(float(p[0] * stretch**power) for power, p in enumerate(local, start=1)),
                  0.0, *(float(p[1] * stretch**power) for power, p in enumerate(local, start=1)))
        elements.append(PlanElement(s, float(a[0]), float(a[1]), heading, length, "paramPoly3", values))
        s += length
    return PlanView(tuple(elements))
