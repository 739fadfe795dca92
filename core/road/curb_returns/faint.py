"""Faint curbs that lead on from sure ones.

At crossings and drives a curb is dropped to one or two centimetres, less than the noise of a many-beam scanner in any single view.
Averaged over metres along the curb it stands out all the same; but so does every seam between two layers of asphalt. Therefore it
counts only where it leads on from the end of a sure curb, in direction and in height.

From a little before such an end, arcs of the next LED_LENGTH metres are compared: the curb's own course, and some that turn and bend
a little more or less. Across each of them the ground is averaged, and that one is taken whose averages two levels and the step between
them explain best. The step must stand SIGNIFICANT_SIGMAS above what the same averages show on the road beside it, where nothing
rises: their noise, and whatever part of the errors does not average out. It must do so along both halves of the arc. Then the next
arc begins LED_STEP farther on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.corners import (
    BEHIND_FIT_LENGTH,
    BLURRED_FACE_HALF_WIDTH,
    MAX_AVERAGED_SCATTER,
    MAX_ROAD_SLOPE,
    MIN_FILLED_SHARE,
    ROAD_FIT_LENGTH,
    STEEP_HALF_WIDTH,
    RunningSums,
    SideLines,
)
from ..common.curb_limits import SIGNIFICANT_SIGMAS, TEXTURE_SIGMA
from ..common.tracking import HEIGHT_TOLERANCE
from .following import FollowedEnds
from .ground_raster import GroundRaster
from .steps import PlanSteps
from .tracking import LINE_DIRECTION_LENGTH, MAX_HEIGHT_GRADE

LED_LENGTH = 4.5              # m along a curb that are averaged: the least length of a faint curb
LED_STEP = 0.5                # m from one average to the next
MAX_LED_LENGTH = 20.0         # m that a curb leads on at most
LEAD_IN_STEPS = int(round(LINE_DIRECTION_LENGTH / LED_STEP))   # averages that begin on the sure curb, so that the course is its own
ACROSS_CELL = 0.025           # m, cells across the curb
LEVEL_ROAD = (-1.5, -0.5)     # m across from the curb of the road beside it, where averages show what is no step
MAX_LAYER_HEIGHT = 0.3        # m above or below the curb's end within which its ground lies
MIN_HALF_SHARE = 0.5          # of the least height, that the step must rise along either half
MIN_SHARP_SHARE = 0.4         # of the height that must lie within STEEP_HALF_WIDTH: a dropped stone is sloped, and drift blurs a long average
# Errors of a many-beam scanner are alike within about half a metre along and 10 cm across: so many of an average are independent.
INDEPENDENT = LED_LENGTH * (ROAD_FIT_LENGTH + BEHIND_FIT_LENGTH) / (0.5 * 0.1)
STEP_SHARE = 0.24             # n1 n2 / (n1 + n2)²: share of a step's squared height in the variance that it explains
# Turns (radians), bends (1/m) and cells across by which the curb may leave the arc so far; sigmas (m) of its place at the beginning of the
# next arc and in the middle, to where the arc before has shown it, and of its bend.
FIRST_TURNS, FIRST_BENDS, FIRST_SIGMAS = np.radians(np.arange(-6.0, 6.1, 1.5)), np.arange(-0.2, 0.201, 0.025), (0.03, 0.04)
NEXT_TURNS, NEXT_BENDS, NEXT_SIGMAS = np.radians(np.arange(-4.0, 4.1, 1.0)), np.arange(-0.08, 0.081, 0.02), (0.015, 0.02)
BEND_SIGMA = 0.1
SHIFTS = np.arange(-2, 3)
LARGEST_BEND = 0.25           # 1/m


@dataclass
class _Arc:
    """An arc of LED_LENGTH metres.

    x, y, h : m, where it begins
    heading : radians; bend : 1/m, to the left
    uphill : 1 where uphill is on the left, else -1
    """

    x: float
    y: float
    h: float
    heading: float
    bend: float
    uphill: float

    def onward(self, t: float) -> _Arc:
        """The same arc from t metres farther on."""
        middle, chord = self.heading + 0.5 * self.bend * t, t * np.sinc(0.5 * self.bend * t / np.pi)
        return _Arc(self.x + chord * np.cos(middle), self.y + chord * np.sin(middle), self.h, self.heading + self.bend * t, self.bend, self.uphill)

    def moved(self, average: _Average) -> _Arc:
        """The arc along which the step was seen."""
        across, up = self.uphill * average.shift, self.uphill
        return _Arc(self.x - across * np.sin(self.heading), self.y + across * np.cos(self.heading), average.bottom,
                    self.heading + up * average.turn, self.bend + up * average.bend, up)

    def step(self, average: _Average) -> PlanSteps:
        """The step in its middle, where its place is surest."""
        middle = self.onward(0.5 * LED_LENGTH)
        values = (middle.x, middle.y, -self.uphill * np.sin(middle.heading), self.uphill * np.cos(middle.heading),
                  self.h + 0.5 * LED_LENGTH * average.grade, average.height, 0.0, average.scatter, average.support, average.behind)
        return PlanSteps(*(np.array([value]) for value in values))

    def beside(self, points: tuple[np.ndarray, np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Metres along it and uphill from it, and heights, of the points (x, y, h) beside it."""
        dx, dy = points[0] - self.x, points[1] - self.y
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        ahead, left = dx * cos + dy * sin, dy * cos - dx * sin
        if abs(self.bend) > 1e-4:
            away = np.hypot(ahead, 1.0 / self.bend - left)
            ahead, left = np.arctan2(self.bend * ahead, 1.0 - self.bend * left) / self.bend, 1.0 / self.bend - np.sign(self.bend) * away
        inside = np.flatnonzero((ahead >= 0.0) & (ahead < LED_LENGTH) & (np.abs(left) < LED_LENGTH))
        return ahead.take(inside), self.uphill * left.take(inside), points[2].take(inside)


@dataclass
class _Average:
    """What the ground across an arc shows.

    turn, bend, shift : radians, 1/m, and m uphill, by which the curb leaves the arc; positive uphill
    height : m, of the step
    bottom, grade : m, and m per m along, level of the road at the step where the arc begins
    scatter : m, of averages about the levels
    support, behind : cells with ground before and behind
    good : is it a step?
    """

    turn: float
    bend: float
    shift: float
    height: float
    bottom: float
    grade: float
    scatter: float
    support: int
    behind: int
    good: bool


def led_on(ground: GroundRaster, ends: FollowedEnds) -> list[PlanSteps]:
    """The faint curb that leads on from each end.

    Parameters
    ----------
    ground : GroundRaster, averaged
    ends : K FollowedEnds, LINE_DIRECTION_LENGTH of sure curb behind each

    Returns
    -------
    list of K PlanSteps, LED_STEP apart, in order out of the line, about half LED_LENGTH less far than the averages; empty ones where nothing leads on
    """
    return [_led_on(ground, ends[k:k + 1]) for k in range(len(ends))]


def _led_on(ground, end):
    x, y, h, tx, ty = (float(v[0]) for v in (end.x, end.y, end.h, end.tx, end.ty))
    near = np.flatnonzero((np.hypot(ground.x - x, ground.y - y) <= MAX_LED_LENGTH + LED_LENGTH) & (np.abs(ground.h - h) <= MAX_LAYER_HEIGHT))
    points = ground.x.take(near), ground.y.take(near), ground.h.take(near)
    # uphill is on the left of the arc where it is not on the right of the end
    arc = _Arc(x - LINE_DIRECTION_LENGTH * tx, y - LINE_DIRECTION_LENGTH * ty, h, float(np.arctan2(ty, tx)), 0.0, -float(end.uphill[0]))
    steps: list[PlanSteps] = []
    tried = FIRST_TURNS, FIRST_BENDS, FIRST_SIGMAS
    while len(steps) * LED_STEP < LINE_DIRECTION_LENGTH + MAX_LED_LENGTH:
        average = _best_average(*arc.beside(points), arc.uphill * arc.bend, *tried)
        if average is None or not average.good or abs(average.bottom - arc.h) > HEIGHT_TOLERANCE + MAX_HEIGHT_GRADE * LED_STEP:
            break
        arc = arc.moved(average)
        steps.append(arc.step(average))
        arc, tried = arc.onward(LED_STEP), (NEXT_TURNS, NEXT_BENDS, NEXT_SIGMAS)
    # one average at least begins beyond the end
    if len(steps) <= LEAD_IN_STEPS:
        return PlanSteps.none()
    return PlanSteps.join(steps[1:])


def _best_average(t, u, z, bend, turns, bends, sigmas):
    """The average across that arc, of those about one, whose levels and step explain the ground best; None where there is too little ground.

    t, u, z : (N,) m along and uphill from the arc, and heights; bend : 1/m, of the arc, positive uphill
    """
    gap, fit, short, near = (int(round(v / ACROSS_CELL)) for v in (BLURRED_FACE_HALF_WIDTH, ROAD_FIT_LENGTH, BEHIND_FIT_LENGTH, STEEP_HALF_WIDTH))
    road = np.flatnonzero((u > -BLURRED_FACE_HALF_WIDTH - ROAD_FIT_LENGTH) & (u < -BLURRED_FACE_HALF_WIDTH))
    if len(road) < INDEPENDENT:
        return None
    turns, bends = (v.ravel() for v in np.meshgrid(turns, bends, indexing="ij"))
    few = np.abs(bend + bends) <= LARGEST_BEND
    turns, bends = turns[few], bends[few]
    # the grade along the curb
    plane, *_ = np.linalg.lstsq(np.c_[np.ones(len(road)), u[road], t[road]], z[road], rcond=None)
    z = z - plane[2] * t
    zero = int(round((BLURRED_FACE_HALF_WIDTH + ROAD_FIT_LENGTH - LEVEL_ROAD[0]) / ACROSS_CELL))
    cells = zero + SHIFTS[-1] + gap + short + 2
    half = 0.5 * LED_LENGTH
    halves, spread = zip(*(_profiles(*(v[part] for v in (t, u, z)), turns, bends, zero, cells) for part in (t < half, t >= half)))
    whole = _Levels(0.5 * (halves[0] + halves[1]))
    own = zero + SHIFTS
    with np.errstate(invalid="ignore", divide="ignore"):
        level = whole.height[:, zero + int(round(LEVEL_ROAD[0] / ACROSS_CELL)):zero + int(round(LEVEL_ROAD[1] / ACROSS_CELL))]
        doubt = np.sqrt(np.nansum(level**2, axis=1) / np.maximum(np.isfinite(level).sum(axis=1), 1))
        # what the levels and the step between them do not explain
        along = 0.5 * (spread[0] + spread[1]) + 0.25 * (halves[0] - halves[1])**2
        beside = np.r_[-gap - fit:-gap + 1, gap:gap + short + 1]
        there = np.isfinite(along)[:, own[:, None] + beside]
        unexplained = np.nansum(along[:, own[:, None] + beside], axis=2) / np.maximum(there.sum(axis=2), 1) + whole.scatter(own)**2
        height = whole.height[:, own]
        middle = SHIFTS * ACROSS_CELL + (turns * half + 0.5 * bends * half**2)[:, None]
        gain = 0.5 * INDEPENDENT * np.log1p(STEP_SHARE * height**2 / unexplained) \
            - 0.5 * ((SHIFTS * ACROSS_CELL / sigmas[0])**2 + (middle / sigmas[1])**2 + (bends / BEND_SIGMA)[:, None]**2)
    gain = np.where(np.isfinite(gain) & (height > 0.0), gain, -np.inf)
    k, shift = np.unravel_index(int(np.argmax(gain)), gain.shape)
    if not np.isfinite(gain[k, shift]):
        return None
    cell, height, least = own[shift], float(height[k, shift]), SIGNIFICANT_SIGMAS * max(float(doubt[k]), TEXTURE_SIGMA)
    both = min(_Levels(profiles[k:k + 1]).height[0, cell] for profiles in halves)
    slopes = whole.before.slope[k, cell], whole.behind.slope[k, cell]
    sharp = whole.smooth[k, cell + near] - whole.smooth[k, cell - near] - near * ACROSS_CELL * sum(slopes)
    scatter = float(whole.scatter(own)[k, shift])
    good = height >= least and both >= MIN_HALF_SHARE * least and sharp >= MIN_SHARP_SHARE * height and scatter <= MAX_AVERAGED_SCATTER \
        and max(map(abs, slopes)) <= MAX_ROAD_SLOPE
    return _Average(float(turns[k]), float(bends[k]), float(SHIFTS[shift] * ACROSS_CELL), height, float(whole.before.level[k, cell]),
                    float(plane[2]), scatter, int(whole.before.n[k, cell]), int(whole.behind.n[k, cell]), bool(good))


def _profiles(t, u, z, turns, bends, zero, cells):
    """(P, C) m and m², mean and variance of heights in cells across each of P arcs, which pass through the middle of the cell `zero`."""
    mean, variance = np.full((2, len(turns), cells), np.nan)
    for k, (turn, bend) in enumerate(zip(turns, bends)):
        cell = np.floor((u - turn * t - 0.5 * bend * t * t) / ACROSS_CELL + 0.5).astype(np.intp) + zero
        inside = np.flatnonzero((cell >= 0) & (cell < cells))
        cell, h = cell.take(inside), z.take(inside)
        count = np.bincount(cell, minlength=cells)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean[k] = np.bincount(cell, h, cells) / count
            variance[k] = np.bincount(cell, h * h, cells) / count - mean[k]**2
    return mean, variance


class _Levels:
    """Lines through the ground before and behind every cell of (P, C) averages, and `height` between them, NaN where too little was seen."""

    before: SideLines
    behind: SideLines

    def __init__(self, averages):
        gap, fit, short = (int(round(v / ACROSS_CELL)) for v in (BLURRED_FACE_HALF_WIDTH, ROAD_FIT_LENGTH, BEHIND_FIT_LENGTH))
        sums = RunningSums(averages.shape, ACROSS_CELL)
        sums.add(averages)
        self.before, self.behind, self.smooth = sums.line(-gap - fit, -gap), sums.line(gap, gap + short), sums.mean(-1, 1)
        known = (self.before.n >= MIN_FILLED_SHARE * (fit + 1)) & (self.behind.n >= MIN_FILLED_SHARE * (short + 1))
        self.height = np.where(known, self.behind.level - self.before.level, np.nan)

    def scatter(self, cells: np.ndarray) -> np.ndarray:
        """(P, K) m, scatter of averages about the rougher of both lines at some cells of every profile."""
        places = (np.arange(len(self.height))[:, None] * self.height.shape[1] + cells).ravel()
        return np.maximum(self.before.scatter(places), self.behind.scatter(places)).reshape(len(self.height), -1)
