"""Curbs of side streets continued beyond the corridor of the road.

Some tens of metres from the vehicle a metre of curb holds a few points, too few for any step to be seen by itself. But the two levels beside it still
differ by its whole height. Therefore the straight course of a curb that leaves the corridor, or one that bends evenly, is fitted to all points about
it from its end on, metre by metre farther out: the arc along which two levels with the curb's own height between them explain the heights best, and
then the mean of all arcs about it that do so, each with its likelihood, whose spread is how uncertain the place is. It ends where less than
RETURN.min_side_points lie on either side of it along RETURN.led_length metres, or where they no longer show half of the curb's height.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...execution.in_step import Asked, Work
from ...execution.phase import Phase
from ...survey.frame.road import NODE_SPACING
from ...survey.store.records import road_of
from ..common.decimation import PointDecimation
from ..common.sides import expected_height
from ..weights import CURBS, RETURN
from .classify import CurbReturn
from .main_curbs import KnownPlaces
from .steps import PlanSteps

BEYOND_KINDS = "corner", "side_street"
SPREAD_GRID = np.stack(np.meshgrid(*3 * [RETURN.spread_grid], indexing="ij"), axis=-1).reshape(-1, 3)   # derived: all combinations at three places
@dataclass
class _CurbCourse:
    """An arc: shift (m), turn (radians) and bend (1/m), positive uphill; `levels`: bottom (m), grade, height (m), crossfall; from and to (m) it was
    seen; points on either side, and their scatter (m); `spread`: (3, 3) covariance of the arc."""

    arc: Arc
    levels: np.ndarray
    start: float
    end: float
    support: tuple[int, int]
    scatter: float
    spread: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))

    def sigma(self, t: np.ndarray) -> np.ndarray:
        """(N,) m, one sigma across at (N,) m along."""
        powers = np.stack([np.ones_like(t), t, 0.5 * t * t], axis=1)
        return np.sqrt(np.einsum("ni,ij,nj->n", powers, self.spread, powers))


def with_curbs_beyond(curbs: Sequence[CurbReturn], decimation: PointDecimation, road: int, known: KnownPlaces) -> Work:
    """Part of a work: the curbs away from main curbs, those that leave the corridor continued beyond it.

    known : places of the main curbs

    Returns a list of CurbReturn; places that have no station get that of the end that they lead on from
    """
    survey = decimation.survey
    if not any(number < 0 for number in survey.store.numbers()):
        return list(curbs)
    met = known.and_steps([curb.steps for curb in curbs])
    ends = [(curb, at_tail, _end_of(curb, at_tail, survey, road)) for curb in curbs if not curb.closed and curb.kind in BEYOND_KINDS
            for at_tail in (True, False)]
    open_ends = [(end, curb, at_tail) for curb, at_tail, end in ends if end is not None and _leaves(end, survey.frame.roads)
                 and not met.within(np.array([end.x + end.tx]), np.array([end.y + end.ty]), 0.5).any()]
    phase = Phase(_course_beyond, decimation, (), lambda end: "the curbs of side streets")
    courses = yield Asked(phase, [end for end, *_ in open_ends], 1.0)
    line = survey.frame.road(road)
    led = [_led(course, *of_end, survey, road, line) for course, of_end in zip(courses, open_ends) if course is not None]
    return [*curbs, *sorted(led, key=lambda curb: -len(curb.steps))]


def _course_beyond(decimation: PointDecimation, end: CurbEnd) -> _CurbCourse | None:
    """The phase that follows a curb beyond the corridor from its end: its course, None where it is not seen."""
    t, u, z = _ground(decimation, end)
    return led_beyond(t, u, z, end)


def _end_of(curb, at_tail, survey, road):
    """The end of a curb; None where it is too short for a direction."""
    steps, order = curb.steps, slice(None) if at_tail else slice(None, None, -1)
    x, y = steps.x[order], steps.y[order]
    near = np.hypot(x - x[-1], y - y[-1]) <= RETURN.trail_length
    x, y = x[near], y[near]
    if np.hypot(x[-1] - x[0], y[-1] - y[0]) < RETURN.line_direction_length:
        return None
    tx, ty = np.linalg.svd(np.c_[x - x.mean(), y - y.mean()])[2][0]
    out = np.sign(tx * (x[-1] - x[0]) + ty * (y[-1] - y[0]))
    z = steps.h[order][near] + expected_height(survey, road, curb.s[order][near])
    end = CurbEnd(float(x[-1]), float(y[-1]), float(np.median(z[-3:])), float(out * tx), float(out * ty), 1.0 if at_tail else -1.0,
                  float(np.median(steps.height)), np.empty((3, 0)))
    end.trail = np.stack([*end.beside(x, y), z])
    return end


def _leaves(end, roads):
    """Does the curb leave the corridors of all roads where it leads straight on?"""
    t = np.arange(0.0, RETURN.max_corridor_distance + 0.1, 1.0)
    inside = np.any([np.isfinite(road.locate(*end.ahead(t))[0]) for road in roads], axis=0)
    return not inside.all()


def _ground(decimation, end):
    """Points about the straight continuation of a curb: metres along and uphill, and heights, averaged in cells."""
    parts_beside = [_beside(part, end) for parts in (_in_corridors(decimation, end), _beyond_corridors(decimation.survey, end)) for part in parts]
    t, u, z = (np.concatenate(column) for column in zip(*parts_beside)) if parts_beside else np.empty((3, 0))
    return _cell_means(t, u, z)


def _in_corridors(decimation, end):
    """Points of all roads beside a continuation."""
    survey, width = decimation.survey, decimation.width
    x, y = end.ahead(np.arange(0.0, RETURN.max_corridor_distance + RETURN.led_length + 0.1, 0.5))
    for road in survey.store.roads():
        s, _ = survey.frame.road(road).locate(x, y)
        if np.isfinite(s).any():
            low, high = np.nanmin(s) - RETURN.ground_half_width, np.nanmax(s) + RETURN.ground_half_width
            profiles = int(np.floor(low / width)), int(np.ceil(high / width)) + 1
            yield from decimation.decimated_points(road, profiles, CURBS.points_per_level_cell_in_plan)


def _beyond_corridors(survey, end):
    """Points beside roads that lie beyond their corridors, within reach of a continuation."""
    reach, length = RETURN.max_beyond_length + 2 * RETURN.max_corridor_distance, survey.store.section_length
    for number in [number for number in survey.store.numbers() if number < 0]:
        line = survey.frame.road(road_of(number))
        near = np.flatnonzero(np.hypot(line.x - end.x, line.y - end.y) < reach)
        if len(near):
            low, high = (line.start + NODE_SPACING * k for k in (near[0], near[-1]))
            yield from (survey.section(number, section) for section in survey.store.sections(number) if low - length <= section * length <= high)


def _beside(points, end):
    x, y, z = points.x, points.y, points.z
    t, u = end.beside(x, y)
    inside = np.flatnonzero((t > -0.5) & (t < RETURN.max_beyond_length) & (np.abs(u) < RETURN.ground_half_width + 0.1 * np.maximum(t, 0.0) + 0.1)
                            & (np.abs(z - end.z) < RETURN.max_layer_height + 0.05 * np.maximum(t, 0.0)))
    return t[inside], u[inside], z[inside]


def _cell_means(t, u, z):
    if not len(t):
        return t, u, z
    key = np.floor(t / RETURN.cell_along).astype(np.int64) * 1000 + np.floor(u / RETURN.cell_across).astype(np.int64)
    _, cell, count = np.unique(key, return_inverse=True, return_counts=True)
    return tuple(np.bincount(cell, v) / count for v in (t, u, z))


def led_beyond(t: np.ndarray, u: np.ndarray, z: np.ndarray, end: CurbEnd) -> _CurbCourse | None:
    """How a curb continues from its end.

    t, u, z : (N,) m, along and uphill from the end, and heights, of points about it
    end : its end

    Returns the course as far as it is seen, None where it is not
    """
    for start in np.arange(0.0, RETURN.max_dropped_length + 0.1, 1.0):
        course, length = None, RETURN.led_length
        arc, *_ = _best_levels(t, u, z, end, start, start + length, (0.0, 0.0, 0.0), RETURN.first_arcs) or (None,)
        while arc is not None and start + length <= RETURN.max_beyond_length:
            longer = _fitted(t, u, z, end, start, start + length, arc, RETURN.finer_arcs if course is None else RETURN.farther_arcs)
            # the first arc must be seen along both halves
            if longer is None or course is None and longer.end < start + 0.5 * RETURN.led_length:
                break
            course, arc, length = longer, longer.arc, length + RETURN.growth
        if course is not None:
            return _surest(t, u, z, end, course, start + length - RETURN.growth)
    return None


def _surest(t, u, z, end, course, stop):
    """The course along the mean of all arcs that explain the points up to `stop`, each with its likelihood, and how far these spread.

    Where the last return on the street and the first one behind the curb lie far apart, any arc between them explains both: the best
    of them is a matter of chance, and how far apart the returns are is how uncertain the place is.
    """
    ground = GroundAboutArc.about(t, u, z, end, course.start, stop, course.arc)
    if ground is None:
        return course
    stations = np.linspace(course.start, course.end, 3)
    # arcs by what they are aside at the beginning, in the middle and at the end
    to_arc = np.linalg.inv(np.stack([np.ones(3), stations, 0.5 * stations * stations], axis=1))
    mean, axes = _aside_of_arcs(np.array([course.arc]), stations)[0], RETURN.spread_step * np.eye(3)
    for _ in range(RETURN.spread_rounds):
        offsets = mean + SPREAD_GRID @ axes.T
        cost = ground.explained(offsets @ to_arc.T)[0]
        weight = np.exp(-0.5 * (cost - cost.min()))
        weight /= weight.sum()
        mean = weight @ offsets
        spread = (offsets - mean).T @ ((offsets - mean) * weight[:, None])
        size, direction = np.linalg.eigh(spread)
        axes = direction * np.maximum(RETURN.spread_step_sigmas * np.sqrt(np.maximum(size, 0.0)), RETURN.least_spread_step)
    shift, turn, bend = (to_arc @ (mean + ground.foot(to_arc @ mean))).tolist()
    mean_course = _fitted(t, u, z, end, course.start, stop, (shift, turn, bend), np.zeros((3, 1)))
    return replace(mean_course or course, spread=to_arc @ spread @ to_arc.T)


def _best_levels(t, u, z, end, start, stop, about, arcs):
    """The arc of those about one that explains the points between two distances best, and what belongs to it; None where there are too few.

    That is: levels, their prior weights, t and z of the points, their design, v across from the arc, and which count.
    """
    ground = GroundAboutArc.about(t, u, z, end, start, stop, about)
    if ground is None:
        return None
    trials = np.stack([v.ravel() + middle for v, middle in zip(np.meshgrid(*arcs, indexing="ij"), about)], axis=1)
    cost, levels, design, v = ground.explained(trials)
    k = int(np.argmin(cost))
    near = np.abs(v[k]) > RETURN.curb_half_width
    return (float(trials[k, 0]), float(trials[k, 1]), float(trials[k, 2])), levels[k], ground.prior, ground.t, ground.z, design[k], v[k], near


def _fitted(t, u, z, end, start, stop, about, arcs):
    """The course between two distances; None where its last RETURN.led_length show no curb."""
    best = _best_levels(t, u, z, end, start, stop, about, arcs)
    if best is None:
        return None
    arc, levels, prior, t, z, design, v, near = best
    last = near & (t >= stop - RETURN.led_length)
    low, high = last & (v < 0), last & (v > 0)
    if min(low.sum(), high.sum()) < RETURN.min_side_points:
        return None
    reach = float(min(t[low].max(), t[high].max()))
    plain = z - design[:, [0, 1, 3]] @ levels[[0, 1, 3]]
    rise = np.median(plain[high]) - np.median(plain[low])
    middle = np.median(plain[low]) + 0.5 * rise
    level_share = min(np.mean(plain[low] < middle), np.mean(plain[high] > middle))
    if not RETURN.min_height_share * end.height <= rise <= RETURN.max_height_share * end.height or level_share < RETURN.min_level_share:
        return None
    # a slope, however steep, must explain the last points worse
    all_points = np.ones((1, last.sum()), bool)
    slope = _cost_of_arcs(_levels_of_arcs(design[None, last][:, :, [0, 1, 3]], z[last], all_points, np.full(3, 1e-6), np.zeros(3))[1])[0]
    step = _cost_of_arcs(_levels_of_arcs(design[None, last], z[last], all_points, prior, levels)[1])[0]
    if slope - step < CURBS.significant_sigmas**2:
        return None
    residual = z[last] - design[last] @ levels
    return _CurbCourse(arc, levels, start, reach, (int(low.sum()), int(high.sum())), float(np.median(np.abs(residual)) / 0.6745))


def _led(course, end, curb, at_tail, survey, road, line):
    """The curb along a course; from the known end on, unless it is dropped there."""
    count = max(int(np.ceil((course.end - course.start) / RETURN.step_spacing)), 1) + 1
    t = np.linspace(course.start, course.end, count)
    shift, turn, bend = course.arc
    u, skew = shift + turn * t + 0.5 * bend * t * t, turn + bend * t
    upx, upy = end.uphill * end.ty, -end.uphill * end.tx
    x, y = end.x + t * end.tx + u * upx, end.y + t * end.ty + u * upy
    nx, ny = (upx - skew * end.tx) / np.hypot(1.0, skew), (upy - skew * end.ty) / np.hypot(1.0, skew)
    z = end.z + course.levels[0] + course.levels[1] * t
    s, d = line.locate(x, y)
    k = -1 if at_tail else 0
    unlocated = ~np.isfinite(s)
    s, d = np.where(unlocated, curb.s[k], s), np.where(unlocated, curb.d[k], d)
    ones = np.ones(count)
    low, high = course.support
    steps = PlanSteps(x, y, nx, ny, z - expected_height(survey, road, s), course.levels[2] * ones, 0.0 * ones, course.scatter * ones,
                      np.full(count, low), np.full(count, high))
    # in order, uphill on the right
    order = np.arange(count) if at_tail else np.arange(count)[::-1]
    return CurbReturn(steps[order], s[order], d[order], curb.side, "side_street", sigma=course.sigma(t)[order])


# The ground about an arc along which a curb may run: how well two levels with the curb's height between them explain its points.

Arc = tuple[float, float, float]


@dataclass
class CurbEnd:
    """The end of a curb: place and height of its bottom (local m), unit vector out of it, its side uphill (1: on the right, else -1), its
    height (m), and (3, N) its steps near the end: metres along and uphill from there, and height."""

    x: float
    y: float
    z: float
    tx: float
    ty: float
    uphill: float
    height: float
    trail: np.ndarray

    def ahead(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places t metres straight on."""
        return self.x + t * self.tx, self.y + t * self.ty

    def beside(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Metres along and uphill."""
        dx, dy = x - self.x, y - self.y
        return dx * self.tx + dy * self.ty, self.uphill * (dx * self.ty - dy * self.tx)


@dataclass
class GroundAboutArc:
    """Points about an arc from the end of a curb: t, u, z in m from there; `prior`: weights of what is known of the levels beforehand.

    All arcs near that one are compared on the same points: one that had more of them than another would seem to explain more.
    """

    t: np.ndarray
    u: np.ndarray
    z: np.ndarray
    end: CurbEnd
    prior: np.ndarray

    @staticmethod
    def about(t: np.ndarray, u: np.ndarray, z: np.ndarray, end: CurbEnd, start: float, stop: float, arc: Arc) -> GroundAboutArc | None:
        """The points between two distances; None where there are too few."""
        inside = np.flatnonzero((t >= start) & (t < stop) & (np.abs(u - _aside_of_arcs(np.array([arc]), t)[0]) < RETURN.ground_half_width))
        if len(inside) < 2 * RETURN.min_side_points:
            return None
        prior = np.array([RETURN.bottom_sigma + 0.01 * start, RETURN.grade_sigma, RETURN.rise_sigma, RETURN.crossfall_sigma])**-2.0
        return GroundAboutArc(t[inside], u[inside], z[inside] - end.z, end, prior)

    def explained(self, arcs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """How well (C, 3) arcs explain points and known curb.

        Returns (C,) sums of squares of what both differ from them, in sigmas, (C, 4) levels, their (C, N, 4) design and (C, N) m across.
        """
        t, z, end = self.t, self.z, self.end
        v = self.u - _aside_of_arcs(arcs, t)
        on_level = np.abs(v) > RETURN.curb_half_width
        design = np.stack([np.ones_like(v), np.broadcast_to(t, v.shape), (v > 0).astype(float), v], axis=2)
        levels, residual = _levels_of_arcs(design, z, on_level, self.prior, np.array([0.0, 0.0, end.height, 0.0]))
        low, height = residual + design[:, :, 2] * levels[:, 2:3] / RETURN.point_height_sigma, levels[:, 2:3] / RETURN.point_height_sigma
        # the curb itself is as high as either level, or anywhere between them
        residual = np.where(on_level, residual, low - np.clip(low, 0.0, np.maximum(height, 0.0)))
        trail_t, trail_u, _ = end.trail
        off = (trail_u - _aside_of_arcs(arcs, trail_t)) / RETURN.place_sigma
        cost = _cost_of_arcs(residual) + (off**2).mean(axis=1) * min(len(trail_t), RETURN.least_steps) + (arcs[:, 2] / RETURN.arc_bend_sigma)**2
        return cost, levels, design, v

    def foot(self, arc: np.ndarray) -> float:
        """How far uphill from an arc, m, the foot of the curb is that leans where the points on it are; 0 where there are few."""
        _, (levels,), (design,), (v,) = self.explained(arc[None])
        rise = self.z - design[:, [0, 1, 3]] @ levels[[0, 1, 3]]
        face = (np.abs(v) <= RETURN.curb_half_width) & (rise > CURBS.face_lower_share * levels[2]) & (rise < CURBS.face_upper_share * levels[2])
        if face.sum() < RETURN.min_side_points:
            return 0.0
        v, rise = v[face], rise[face]
        off = rise - rise.mean()
        return float(v.mean() - (v @ off) / (off @ off + face.sum() * CURBS.face_prior) * rise.mean())


def _aside_of_arcs(arcs: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(C, N) m uphill, of (C, 3) arcs at (N,) m along."""
    return arcs[:, :1] + arcs[:, 1:2] * t + 0.5 * arcs[:, 2:] * t * t


def _levels_of_arcs(design: np.ndarray, z: np.ndarray, used: np.ndarray, prior: np.ndarray,
                   expected: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(C, P) parameters of each of C designs (C, N, P), and (C, N) sigmas that heights differ from them; `used` : (C, N) bool."""
    weight = used.astype(float)
    for _ in range(3):
        normal = np.einsum("ck,cki,ckj->cij", weight, design, design, optimize=True) / RETURN.point_height_sigma**2 + np.diag(prior)
        right = np.einsum("ck,cki,k->ci", weight, design, z, optimize=True) / RETURN.point_height_sigma**2 + prior * expected
        levels = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
        residual = (z - np.einsum("cki,ci->ck", design, levels)) / RETURN.point_height_sigma
        weight = used / (1.0 + (residual / RETURN.max_residual)**2)
    return levels, residual


def _cost_of_arcs(residual: np.ndarray) -> np.ndarray:
    """(C,) sums of squares of (C, N) differences in sigmas, cut off."""
    return np.minimum(residual**2, RETURN.max_residual**2).sum(axis=1)
