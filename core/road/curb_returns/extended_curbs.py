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

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...common.arrays import Rows
from ...common.progress import Progress
from ...execution.phase import Phase
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
from ..common.decimation import PointDecimation
from ..common.sides import MAX_LOOK_ALONG, ahead_of_vehicle, expected_height
from ..common.tracking import HEIGHT_TOLERANCE, MAX_ROAD_ROUGHNESS
from .classify import MIN_RETURN_STEPS, CurbReturn, classify_continuation
from .ground_raster import PLAN_CELL, GroundRaster, averaged, ground_raster
from .main_curbs import CurbLines
from .steps import LONG_HALF_LENGTH, PATCH_HALF_WIDTH, SHORT_HALF_LENGTH, PlanSteps, points_about, steps_of_points
from .tracking import LINE_DIRECTION_LENGTH, MAX_HEIGHT_GRADE, MAX_PLAN_LINK, LineEnds, PlanStepChain

if TYPE_CHECKING:
    from ..common.curb_limits import CurbSettings
    from .main_curbs import KnownPlaces, SearchLimit

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


# Where faint curbs are looked for: beyond the free ends of the curbs that were found, where the scanner is noisy.
#
# Elsewhere averages show no more than single views do.

LED_KINDS = "main", "corner", "side_street"   # the other curbs have no ends
MEETING_CURB_DISTANCE = 0.25  # m within which a curb that leads on has reached another
LEAVING_LENGTH = 1.0          # m from its beginning in which it is near the curb that it leads on


def with_led_on(curbs: Sequence[CurbReturn], runs: Sequence[tuple], decimation: PointDecimation, road: int, sections: Sequence[tuple[int, int]],
                known: KnownPlaces, limits: Mapping[str, SearchLimit], settings: CurbSettings, progress: Progress) -> list[CurbReturn]:
    """The curbs away from main curbs, and what leads on faintly from them and from main curbs.

    Parameters
    ----------
    curbs : list of CurbReturn
    runs : main curbs in plan, uphill on the right: list of (side, (x, y, h)), local m
    decimation : PointDecimation of the survey
    road : number of the road
    sections : (first, last + 1) profile numbers of those where the scanner is noisy
    known : places of the main curbs
    limits : side -> SearchLimit
    settings : CurbSettings
    progress : Progress

    Returns
    -------
    list of CurbReturn
    """
    if not sections:
        progress.report(1.0)
        return list(curbs)
    survey, width = decimation.survey, settings.profile_width
    line, free = survey.frame.road(road), [curb for curb in curbs if curb.kind in LED_KINDS and not curb.closed]
    lines = [place for _, place in runs] + [(curb.steps.x, curb.steps.y, curb.steps.h) for curb in free]
    ends, owner = FollowedEnds.with_lines(lines)
    met = known.and_places(*(np.concatenate([np.empty(0), *(getattr(curb.steps, axis) for curb in curbs)]) for axis in "xy"))
    open_ones = np.flatnonzero(~met.within(ends.x + LEAVING_LENGTH * ends.tx, ends.y + LEAVING_LENGTH * ends.ty, 0.5 * LEAVING_LENGTH))
    ends, owner = ends[open_ones], owner[open_ones]
    phase = Phase(_led_steps_of_section, decimation, (road, ends, settings), lambda section: survey.stretch(road, *(k * width for k in section)),
                  lambda section: survey.store.points_between(road, *(k * width for k in section)), _join_led)
    more: list[CurbReturn] = []
    main_ends = CurbLines([(x, y) for _, (x, y, _) in runs])
    extended = {id(curb): curb for curb in curbs}
    for number, own in _join_led(list(decimation.executor.run(phase, sections, progress))):
        # inside a tight bend a place may have no station
        own = _until_met(own[np.isfinite(line.locate(own.x, own.y)[0])], met)
        k, at_head = owner[number], ends.uphill[number] < 0
        if len(own) < MIN_RETURN_STEPS:
            continue
        # from the other end of a gap only the rest is led on
        met = met.and_places(own.x, own.y)
        own = own[::-1] if at_head else own
        s, d = line.locate(own.x, own.y)
        if k < len(runs):
            more += classify_continuation(own, s, d, runs[k][0], line, limits[runs[k][0]], main_ends)
        else:
            curb = free[k - len(runs)]
            extended[id(curb)] = _joined(extended[id(curb)], CurbReturn(own, s, d, curb.side, curb.kind), at_head)
    return list(extended.values()) + more


def _until_met(own, met):
    """A curb as far as another one."""
    near = met.within(own.x, own.y, MEETING_CURB_DISTANCE)
    near[:int(LEAVING_LENGTH / LED_STEP)] = False
    return own[:int(np.argmax(near))] if near.any() else own


def _joined(curb, more, before):
    """A curb with what leads on from its beginning, or from its end."""
    parts = (more, curb) if before else (curb, more)
    return CurbReturn(PlanSteps.join([part.steps for part in parts]), *(np.concatenate([getattr(part, name) for part in parts]) for name in "sd"),
                      curb.side, curb.kind)


def _join_led(parts: Sequence[list[tuple[int, PlanSteps]] | None]) -> list[tuple[int, PlanSteps]]:
    """The results of `_led_steps_of_section` of several sections as one."""
    return [found for part in parts if part is not None for found in part]


def _led_steps_of_section(decimation: PointDecimation, section: tuple[int, int], road: int, ends: FollowedEnds,
                         settings: CurbSettings) -> list[tuple[int, PlanSteps]]:
    """The phase of faint curbs: what leads on from the ends in one section of a road.

    Parameters
    ----------
    decimation : PointDecimation of the survey
    section : (first, last + 1) profile numbers
    road : number of the road
    ends : FollowedEnds of the curbs
    settings : CurbSettings

    Returns
    -------
    list of (number of the end, PlanSteps)
    """
    width, line, reach = decimation.width, decimation.survey.frame.road(road), MAX_LED_LENGTH + LED_LENGTH
    at, _ = line.locate(ends.x, ends.y)
    own = np.flatnonzero((at >= section[0] * width) & (at < section[1] * width))
    if not len(own):
        return []
    profiles = int(np.floor((at[own].min() - reach) / width)), int(np.ceil((at[own].max() + reach) / width))
    parts = [_near_ends(decimation.survey, road, part, ends[own]) for part in decimation.decimated_points(road, profiles, None)]
    if not parts:
        return []
    x, y, h = (np.concatenate(column) for column in zip(*parts))
    raster = ground_raster(x, y, h, settings.layer_jump)
    ground = averaged(raster, settings.layer_jump)
    if ground is None:
        return []
    return [(int(k), steps) for k, steps in zip(own, led_on(ground, ends[own])) if len(steps)]


def _near_ends(survey, road, points, ends):
    """Local x, y and height above the expected road of the points that may belong to what leads on."""
    near = np.zeros(len(points.x), bool)
    for x, y in zip(ends.x, ends.y):
        near |= (points.x - x)**2 + (points.y - y)**2 < (MAX_LED_LENGTH + LED_LENGTH)**2
    own = np.flatnonzero(near)
    points = points[own]
    s = points.s
    h = points.z - expected_height(survey, road, s)
    seen = np.abs(ahead_of_vehicle(survey, points, s)) < MAX_LOOK_ALONG + np.abs(points.d)
    own = np.flatnonzero(seen & (h > ends.h.min() - MAX_LAYER_HEIGHT) & (h < ends.h.max() + MAX_LAYER_HEIGHT))
    return points.x.take(own), points.y.take(own), h.take(own)


# Curbs followed beyond the places where they were found.
#
# Far from the vehicle, or behind a gap, points are too sparse for a curb to stand out by itself. Where a line of curb is known it says where its
# next piece must lie, which way it runs and how high it is; a step measured there, from points farther along the curb, needs no other sign. A line
# ends where no such step was found for the length that a link may span.

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
