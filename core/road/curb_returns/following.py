"""Curbs followed beyond the places where they were found.

Far from the vehicle, or behind a gap, points are too sparse for a curb to stand out by itself. Where a line of curb is known it says
where its next piece must lie, which way it runs and how high it is; a step measured there, from points farther along the curb, needs
no other sign. A line ends where no such step was found for the length that a link may span.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...common.arrays import Rows
from ..common.tracking import HEIGHT_TOLERANCE, MAX_ROAD_ROUGHNESS
from .ground.raster import PLAN_CELL, GroundRaster
from .steps import LONG_HALF_LENGTH, PATCH_HALF_WIDTH, SHORT_HALF_LENGTH, PlanSteps, points_about, steps_of_points
from .tracking import LINE_DIRECTION_LENGTH, MAX_HEIGHT_GRADE, MAX_PLAN_LINK, LineEnds, PlanStepChain

FOLLOWING_STEP = 0.4          # m along a curb from one measurement to the next
FOLLOWED_LENGTH = 16.0        # m that a line is followed at most within a section
FOLLOWED_HALF_LENGTHS = SHORT_HALF_LENGTH, LONG_HALF_LENGTH, 2.0   # m either way along a curb of the points that measure it
MIN_QUARTER_POINTS = 2        # points on either side of a step, before it and behind it: none is measured beyond what was seen
MAX_FOLLOWED_POINTS = 1.0     # points for each cell of the raster: where there are more, a curb that goes on was found already
FOLLOWED_STEPS = 4            # steps of FOLLOWING_STEP over which the direction is taken from then on
FOLLOWED_ACROSS = 0.06        # m from the line within which the curb goes on, and
FOLLOWED_SKEW = 0.15          # m across per m along, that its face may turn from it
FOLLOWED_HEIGHT_RATIO = 1.6   # of its height over that of the line, or the other way


@dataclass
class FollowedEnds(Rows):
    """Ends of K lines of curb from which they are followed.

    Attributes
    ----------
    x, y, h : (K,) m, local place and height of the bottom
    tx, ty : (K,) unit vector out of the line
    uphill : (K,) 1 where uphill is on the right of that vector, else -1
    height : (K,) m, of the step; NaN where it is not known
    """

    x: np.ndarray
    y: np.ndarray
    h: np.ndarray
    tx: np.ndarray
    ty: np.ndarray
    uphill: np.ndarray
    height: np.ndarray

    @classmethod
    def of(cls, lines: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]], heights: np.ndarray) -> FollowedEnds:
        """Both ends of lines (x, y, h), uphill on the right, that are long enough for a direction.

        Parameters
        ----------
        lines : list of K (x, y, h), each (N,) m
        heights : (K,) m, of the steps
        """
        ends, owner = cls.with_lines(lines)
        return replace(ends, height=np.asarray(heights, float)[owner])

    @classmethod
    def with_lines(cls, lines: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> tuple[FollowedEnds, np.ndarray]:
        """The same ends, of unknown height, and (2 K,) number of the line to which each belongs."""
        long = np.flatnonzero([np.hypot(x[-1] - x[0], y[-1] - y[0]) >= LINE_DIRECTION_LENGTH for x, y, _ in lines])
        ends = LineEnds.of([lines[k] for k in long], LINE_DIRECTION_LENGTH)
        both = np.concatenate([ends.tails, ends.heads])
        uphill = np.repeat([1.0, -1.0], len(ends.tails))
        return cls(both[:, 0], both[:, 1], both[:, 2], both[:, 3], both[:, 4], uphill, np.full(len(both), np.nan)), np.tile(long, 2)

    @classmethod
    def of_chains(cls, chains: Sequence[PlanStepChain], steps: PlanSteps) -> FollowedEnds:
        """The ends of open chains of steps."""
        own = [steps[chain.steps] for chain in chains if not chain.closed and len(chain.steps) > 2]
        return cls.of([(line.x, line.y, line.h) for line in own], np.array([np.median(line.height) for line in own]))


def followed_steps(raster: GroundRaster, ends: FollowedEnds, min_height: float, max_height: float, least_slope: float,
                   wanted: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> PlanSteps:
    """Steps in the continuation of lines.

    Parameters
    ----------
    raster : GroundRaster
    ends : FollowedEnds of the lines
    min_height, max_height : m, of a step
    least_slope : radians, of its face
    wanted : function, local x, y -> (N,) bool: where curbs are looked for; a line is not followed beyond

    Returns
    -------
    PlanSteps
    """
    # the places behind an end, from which its direction follows
    back = FOLLOWING_STEP * np.arange(FOLLOWED_STEPS, 0, -1)
    trail_x, trail_y = ends.x[:, None] - back * ends.tx[:, None], ends.y[:, None] - back * ends.ty[:, None]
    away, left, found = np.full(len(ends), FOLLOWING_STEP), np.full(len(ends), FOLLOWED_LENGTH), []
    while len(ends):
        x, y = ends.x + away * ends.tx, ends.y + away * ends.ty
        on = wanted(x, y) & (left > 0)
        ends = ends[on]
        x, y, away, left, trail_x, trail_y = (v[on] for v in (x, y, away, left, trail_x, trail_y))
        if not len(x):
            break
        nx, ny = ends.uphill * ends.ty, -ends.uphill * ends.tx
        steps, good = _measured_across(raster, x, y, nx, ny, min_height, max_height)
        with np.errstate(invalid="ignore"):
            ratio = steps.height / ends.height
            good &= ~((ratio > FOLLOWED_HEIGHT_RATIO) | (ratio < 1 / FOLLOWED_HEIGHT_RATIO))
        good &= (np.abs(steps.h - ends.h) <= HEIGHT_TOLERANCE + MAX_HEIGHT_GRADE * away) & (steps.behind >= 2) \
            & (steps.noise <= max(MAX_ROAD_ROUGHNESS, 2 * raster.noise)) \
            & (np.arctan2(steps.height, np.maximum(steps.run - 2 * raster.noise, 0.0)) >= least_slope)
        found.append(steps[good])
        trail_x[good] = np.c_[trail_x[good, 1:], ends.x[good]]
        trail_y[good] = np.c_[trail_y[good, 1:], ends.y[good]]
        dx, dy = steps.x - trail_x[:, 0], steps.y - trail_y[:, 0]
        size = np.maximum(np.hypot(dx, dy), 1e-9)
        x, y, h, tx, ty = (np.where(good, new, old) for new, old in (
            (steps.x, ends.x), (steps.y, ends.y), (steps.h, ends.h), (dx / size, ends.tx), (dy / size, ends.ty)))
        ends = FollowedEnds(x, y, h, tx, ty, ends.uphill, np.where(good & np.isnan(ends.height), steps.height, ends.height))
        away, left = np.where(good, FOLLOWING_STEP, away + FOLLOWING_STEP), left - FOLLOWING_STEP
        left[away > MAX_PLAN_LINK] = 0.0
    return PlanSteps.join(found) if found else PlanSteps.none()


def _measured_across(raster, x, y, nx, ny, min_height, max_height):
    """A step across each place, from near points where they show it, else from points farther along; and (M,) bool: is it one, there?"""
    good = np.zeros(len(x), bool)
    steps = PlanSteps(*(np.zeros(len(x), column.dtype) for column in PlanSteps.none().columns()))
    for half in FOLLOWED_HALF_LENGTHS:
        left = np.flatnonzero(~good)
        about = points_about(raster, raster.by_cell, *(v.take(left) for v in (x, y, nx, ny)), half)
        # points on all sides, and few, are what most places lack
        few, about = _few_all_around(about, len(left), half)
        left = left[few]
        if not len(left):
            continue
        own = tuple(v.take(left) for v in (x, y, nx, ny))
        seen, those = steps_of_points(about, *own, raster.noise, min_height, max_height, graded=True)
        # the line says where along the curb the step is measured, and the face how far across
        across = seen["u"] - seen["skew"] * seen["s"]
        those.x, those.y = own[0] + across * own[2], own[1] + across * own[3]
        there = seen["good"] & (np.abs(across) <= FOLLOWED_ACROSS) & (np.abs(seen["skew"]) <= FOLLOWED_SKEW)
        for column, values in zip(steps.columns(), those.columns()):
            column[left] = values
        good[left] = there
    return steps, good


def _few_all_around(about, count, half):
    """(K,) indices of those of `count` places that have points on both sides of the curb, before and behind, but not too many; their points."""
    owner, u, v, h = about
    quarter = np.bincount(4 * owner + 2 * (u > 0) + (v > 0), minlength=4 * count).reshape(-1, 4)
    density = quarter.sum(axis=1) * PLAN_CELL**2 / (4 * PATCH_HALF_WIDTH * half)
    there = (quarter.min(axis=1) >= MIN_QUARTER_POINTS) & (density <= MAX_FOLLOWED_POINTS)
    own = np.flatnonzero(there.take(owner))
    number = np.cumsum(there) - 1
    return np.flatnonzero(there), (number.take(owner.take(own)), u.take(own), v.take(own), h.take(own))
