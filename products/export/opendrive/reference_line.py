"""A reference line of straight lines, arcs and spirals through the places of a border."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Generator, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ....core.common.progress import Progress
from ....core.curves.clothoid import GAUSS_RULES, gauss_rule
from ..sources import wrapped
from .geometry import STRAIGHT_BEND, PlanElement, PlanView, on_spirals

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


def fit_reference(points: np.ndarray, tolerance: float, ends: tuple[float | None, float | None] = (None, None)) -> PlanView | None:
    """Lines, arcs and spirals that join without a gap or a kink, each as long as the tolerance allows.

    Long straight lines are found first. Between them every element leads from the place and direction where the last one ends to the farthest
    place, in its direction there, that a spiral reaches within the tolerance [1]_; an arc or a line is taken where it reaches about as far. Places
    and directions are those of a cubic through the places around, so that noise does not turn them. The work grows with the number of places.

    points : (N, 2) metres in order
    tolerance : metres that a point may lie beside it
    ends : radians, headings that it has at its start and end, None for any
    Returns PlanView from the first point to the last one; None where even short elements miss the points

    .. [1] Bertolazzi and Frego (2015), G1 fitting with clothoids, Mathematical Methods in the Applied Sciences 38(5), 881-897.
    """
    return side_by_side([reference_steps(points, tolerance, ends)])[0]


def reference_steps(points: np.ndarray, tolerance: float, ends: tuple[float | None, float | None] = (None, None),
                    turn_tolerance: float = 0.01) -> Steps[PlanView | None]:
    """`fit_reference` as a task, so that many lines are fitted side by side.

    turn_tolerance : radians by which an arc or a line may miss the heading at the end
    """
    points = np.asarray(points, float)
    fit, goal = (yield from _fit_of(points, tolerance, ends, turn_tolerance)), None
    if ends[1] is not None and abs(wrapped((yield _smoothed, (fit, fit.last))[2] - ends[1])) > turn_tolerance:
        # a road that turns at its end does so along the longest element that leads there, which is found from the end backwards
        back = yield from _fit_of(points[::-1], tolerance, (ends[1] + np.pi, None), turn_tolerance)
        last = yield from back.farthest(0, (yield from back.pose(0)), back.last)
        if last is None:
            return None
        reached, _, pose = last
        if reached < back.last:
            goal = _Pose(points[-1, 0], points[-1, 1], ends[1])
            points = np.concatenate([points[:back.last - reached], [pose[:2]]])
            fit = yield from _fit_of(points, tolerance, (ends[0], pose.heading + np.pi), turn_tolerance)
    elements = yield from fit.run()
    if elements is not None and goal is not None:   # from where the others end, which may miss the pose by what an arc or a line may
        after = _spiral_between(_Pose(*elements[-1].end()), goal)
        elements = [*elements, after] if after is not None else None
    return PlanView(_in_order(elements)) if elements is not None else None


def _fit_of(points, tolerance, ends, turn_tolerance):
    """A _Fit that knows its noise and its straight lines."""
    fit = _Fit(points, tolerance, ends, turn_tolerance)
    if fit.last >= FEWEST_PLACES:
        fit.noise = yield _noise_of, fit
    fit.straight = fit.straight_lines()
    return fit


class _Fit:
    """One line of points on its way to elements; its methods with steps are tasks of `side_by_side`."""

    def __init__(self, points, tolerance, ends, turn_tolerance):
        self.points, self.tolerance, self.ends, self.turn_tolerance = points, tolerance, ends, turn_tolerance
        self.along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
        self.last = len(points) - 1
        self.known, self.noise, self.straight = {}, 0.0, {}

    def run(self):
        """The elements in order, None where even short ones miss the points."""
        elements, start, pose = [], 0, (yield from self.pose(0))
        starts = sorted(self.straight)
        while start < self.last:
            end = self.straight.get(start)
            if end is not None:
                reached = end, *self._line(pose, end, self.known[end])
            else:
                limit = next((k for k in starts if k > start), self.last)
                reached = yield from self.farthest(start, pose, limit)
            if reached is None:
                return None
            start, element, pose = reached
            elements.append(element)
        return elements

    def farthest(self, here, pose, limit):
        """(place, element, pose at its end) of the element from a place that reaches farthest, None where none does."""
        spiral = yield from self._reach(here, pose, limit)
        if spiral is None:
            return None
        length = self.along[spiral[0]] - self.along[here]
        if spiral[0] < limit and length < LEAST_PIECE:
            return None
        nearer = int(np.searchsorted(self.along, self.along[here] + PLAINER_REACH * length))
        for end in (spiral[0], nearer):
            if end == limit or self.along[end] - self.along[here] >= LEAST_PIECE <= self.along[limit] - self.along[end]:
                for plainer in (self._line, self._arc):
                    fitted = yield from self._good(plainer, here, pose, end)
                    if fitted is not None:
                        return end, *fitted
        return spiral

    def _reach(self, here, pose, limit):
        """The spiral that ends at the farthest place, by doubling steps and halving; no rest shorter than LEAST_PIECE is left."""
        good, bad, step = None, limit + 1, FIRST_STEP
        tried = min(int(np.searchsorted(self.along, self.along[here] + LEAST_PIECE)), limit)
        while True:
            fitted = yield from self._good(self._spiral, here, pose, tried)
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
            fitted = (yield from self._good(self._spiral, here, pose, back)) if here < back < limit else None
            return (back, *fitted) if fitted is not None else good
        return good

    def _good(self, make, here, pose, there):
        """(element, pose at its end) if no place between misses it by more than the tolerance, else None."""
        fitted = make(pose, there, (yield from self.pose(there)))
        if fitted is None:
            return None
        u = (self.along[here:there + 1] - self.along[here]) * (fitted[0].length / (self.along[there] - self.along[here]))
        return fitted if (yield _follow, (fitted[0], self.points[here:there + 1], u, self.tolerance)) else None

    # elements from a pose to a place

    def _spiral(self, pose, there, end):
        element = _spiral_between(pose, end)
        return (element, end) if element is not None else None

    def _arc(self, pose, there, end):
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

    def _line(self, pose, there, end):
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
            x, y, heading = yield _smoothed, (self, k)
            if k in (0, self.last):
                x, y = self.points[k]
                given = self.ends[0 if k == 0 else 1]
                heading = given if given is not None else heading
            self.known[k] = _Pose(float(x), float(y), float(heading))
        return self.known[k]

    def around(self, k, window):
        """(first, last + 1) of the places around a point, FEWEST_PLACES at least."""
        station, half = self.along[k], FEWEST_PLACES // 2
        return (min(int(self.along.searchsorted(station - window)), max(k - half, 0)),
                max(int(self.along.searchsorted(station + window + 1e-9)), min(k + half + 1, self.last + 1)))

    def straight_lines(self):
        """{first place: last place} of long straight lines, whose places get a pose on them."""
        lines, start = {}, 0
        while start < self.last:
            if self.along[self.last] - self.along[start] < LEAST_STRAIGHT:
                break
            least = int(np.searchsorted(self.along, self.along[start] + LEAST_STRAIGHT))
            if not self._is_straight(start, least):
                start = max(start + 1, int(np.searchsorted(self.along, self.along[start] + LEAST_STRAIGHT / 8)))
                continue
            good = farthest(least, self.last, lambda k: self._is_straight(start, k), least - start)
            first = start if start == 0 else int(np.searchsorted(self.along, self.along[start] + TRIMMED))
            last = good if good == self.last else int(np.searchsorted(self.along, self.along[good] - TRIMMED))
            if self.along[last] - self.along[first] >= LEAST_STRAIGHT / 2 and self._lay_on_line(first, last):
                lines[first] = last
            start = good + 1
        return lines

    def _is_straight(self, first, last):
        allowed = max(STRAIGHT_SHARE * self.tolerance, NOISE_TIMES * self.noise)
        # a place that lies farther beside the chord than twice that leaves no such line
        start, middle, end = self.points[first], self.points[(first + last) // 2], self.points[last]
        aside = (middle[0] - start[0]) * (end[1] - start[1]) - (middle[1] - start[1]) * (end[0] - start[0])
        if abs(aside) > 3 * allowed * np.hypot(*(end - start)):
            return False
        return bool(np.abs(_beside_line(self.points[first:last + 1])[0]).max() <= allowed)

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


def farthest(good: int, last: int, holds: Callable[[int], bool], step: int = 1) -> int:
    """The farthest place up to `last` for which a condition holds, by doubling steps and halving; for `good` it does."""
    bad = last + 1
    while bad - good > 1:
        tried = min(good + step, last) if bad > last else (good + bad) // 2
        good, bad, step = (tried, bad, 2 * step) if holds(tried) else (good, tried, step)
    return good


def _noise_of(fits):
    """For each of the fits the metres, standard deviation, by which its places lie beside short cubics."""
    places = [np.unique(np.linspace(0, fit.last, NOISE_PLACES).astype(int)) for fit in fits]
    spreads = iter([spread for _, spread, _ in _cubics_around([(fit, k, WINDOWS[-1]) for fit, rows in zip(fits, places) for k in rows])])
    return [float(np.median([next(spreads) for _ in rows])) for rows in places]


def _smoothed(asked):
    """For each (fit, number of a place) the (x, y, heading) of a cubic through the places around, as many as it follows but for noise."""
    poses: dict[int, tuple[float, float, float]] = {}
    for windows in (WINDOWS[:1], WINDOWS[1:]):   # the first one mostly does
        left = [number for number in range(len(asked)) if number not in poses]
        cubics = _cubics_around([(*asked[number], window) for number in left for window in windows])
        for row, number in enumerate(left):
            fit, tried = asked[number][0], cubics[row * len(windows):(row + 1) * len(windows)]
            followed = [pose for pose, _, worst in tried if worst <= NOISE_TIMES * fit.noise + EXACT_SHARE * fit.tolerance]
            if followed or windows != WINDOWS[:1]:
                poses[number] = [*followed, tried[-1][0]][0]
    return [poses[number] for number in range(len(asked))]


def _cubics_around(asked):
    """For each (fit, number of a place, window) the (pose, standard deviation, largest distance) of a cubic through the places around it."""
    if not asked:
        return []
    bounds = [fit.around(k, window) for fit, k, window in asked]
    count = np.array([last - first for first, last in bounds])
    s, offsets = np.zeros((len(asked), count.max())), np.zeros((len(asked), count.max(), 2))
    for row, ((fit, k, _), (first, last)) in enumerate(zip(asked, bounds)):
        s[row, :last - first], offsets[row, :last - first] = fit.along[first:last] - fit.along[k], fit.points[first:last] - fit.points[k]
    degree, power = np.where(count > 2, np.minimum(3, count - 2), 1), np.arange(4)
    s /= np.maximum(np.abs(s).max(1), 1e-9)[:, None]
    used = power <= degree[:, None]
    powers = np.stack([np.ones(s.shape), s, s * s, s * s * s], axis=1) * used[:, :, None] * (np.arange(count.max()) < count[:, None])[:, None, :]
    square = powers @ powers.transpose(0, 2, 1)
    square[:, power, power] += np.where(used, np.finfo(float).eps * count[:, None], 1.0)   # places may coincide
    coefficients = np.linalg.solve(square, powers @ offsets)
    heading = np.arctan2(coefficients[:, 1, 1], coefficients[:, 1, 0])
    aside = np.stack([-np.sin(heading), np.cos(heading)], axis=1)[:, :, None]
    missed = (offsets @ aside)[:, :, 0] - ((coefficients @ aside).transpose(0, 2, 1) @ powers)[:, 0]
    spread, worst = np.sqrt((missed**2).sum(1) / np.maximum(count - degree - 1, 1)), np.abs(missed).max(1)
    places = [fit.points[k] for fit, k, _ in asked] + coefficients[:, 0]
    return [((x, y, way), deviation, largest) for (x, y), way, deviation, largest in zip(places.tolist(), heading.tolist(), spread, worst)]


def _follow(asked):
    """For each (element, (n, 2) places, (n,) metres along it nearby, tolerance) whether no place misses it by more than the tolerance."""
    count = np.array([len(u) for _, _, u, _ in asked])
    table = np.repeat(np.array([(element.x, element.y, element.heading, *element.bends()) for element, *_ in asked]).T, count, axis=1)
    places, u = (np.concatenate([row[column] for row in asked]) for column in (1, 2))
    for _ in range(2):
        foot, heading, bend = on_spirals(u, *table)
        offsets = places - foot
        c, s = np.cos(heading), np.sin(heading)
        offset = offsets[:, 1] * c - offsets[:, 0] * s
        u = u + (offsets[:, 0] * c + offsets[:, 1] * s) / np.clip(1 - bend * offset, 0.2, 5.0)
    tolerance, first = np.repeat([row[3] for row in asked], count), np.cumsum(count) - count
    good = (np.abs(offset) <= tolerance) & (np.diff(u, prepend=u[0]) > -tolerance)
    good[first] = np.abs(offset[first]) <= tolerance[first]   # the first place follows none
    return np.logical_and.reduceat(good, first).tolist()


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
    bends = (turn - change) / length, (turn + change) / length
    kind, values = "spiral", tuple(map(float, bends))
    if max(map(abs, bends)) < STRAIGHT_BEND * 1e-3:
        kind, values = "line", ()
    elif abs(bends[0] - bends[1]) < 1e-9:
        kind, values = "arc", (float(sum(bends)) / 2,)
    return PlanElement(0.0, *start, length, kind, values)


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
    from scipy.integrate import trapezoid
    from scipy.interpolate import CubicSpline

    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    curve, elements, s = CubicSpline(along, points), [], 0.0
    for k, (span, (x, y)) in enumerate(zip(np.diff(along), points.tolist())):
        coefficients = curve.c[-2::-1, k]   # of the first to the third power, each of x and y
        heading = float(np.arctan2(*coefficients[0, ::-1]))
        c, d = np.cos(heading), np.sin(heading)
        u = np.linspace(0.0, span, 17)
        length = float(trapezoid(np.hypot(*curve(along[k] + u, 1).T), u))
        along_u, across_v = (coefficients @ np.array([[c, -d], [d, c]]) * (span / length) ** np.arange(1, 4)[:, None]).T.tolist()
        elements.append(PlanElement(s, x, y, heading, length, "paramPoly3", (0.0, *along_u, 0.0, *across_v)))
        s += length
    return PlanView(tuple(elements))


# Tasks that take turns, so that what they ask for at the same time is computed for all of them at once.

Result = TypeVar("Result")
# A task yields (function, argument) and is sent the answer; the function takes the arguments of all tasks and returns their answers.
Steps = Generator[tuple[Callable[[list[Any]], Sequence[Any]], Any], Any, Result]

MOST_AT_ONCE = 200   # source: measured on maps of 80 to 300 roads: more tasks save no time, and cost memory


def side_by_side(tasks: Sequence[Steps[Result]], progress: Progress = Progress()) -> list[Result]:
    """The results of tasks.

    A fit of one road is many small steps, each of which costs numpy more to begin than to do. As the steps of all roads are made together, the
    cost of beginning is shared.
    """
    results: dict[int, Result] = {}
    waiting: dict[int, tuple[Callable[[list[Any]], Sequence[Any]], Any]] = {}

    def resume(number: int, answer: Any) -> None:
        try:
            waiting[number] = tasks[number].send(answer)
        except StopIteration as finished:
            results[number] = finished.value

    later = iter(range(len(tasks)))
    while len(results) < len(tasks):
        for number in (number for number, _ in zip(later, range(MOST_AT_ONCE - len(waiting)))):
            resume(number, None)
        asked: dict[Callable[[list[Any]], Sequence[Any]], dict[int, Any]] = defaultdict(dict)
        for number, (function, argument) in waiting.items():
            asked[function][number] = argument
        waiting.clear()
        for function, arguments in asked.items():
            for number, answer in zip(arguments, function(list(arguments.values()))):
                resume(number, answer)
        progress.report(len(results) / len(tasks))
    return [results[number] for number in range(len(tasks))]
