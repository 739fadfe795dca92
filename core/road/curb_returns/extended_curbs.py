"""Faint curbs that lead on from sure ones.

At crossings and drives a curb is dropped to one or two centimetres, less than the noise of a many-beam scanner in any single view.
Averaged over metres along the curb it stands out all the same; but so does every seam between two layers of asphalt. Therefore it
counts only where it continues from the end of a sure curb, in direction and in height.

From a little before such an end, arcs of the next RETURN.led_length metres are compared: the curb's own course, and some that turn and bend a little
more or less. Across each of them the ground is averaged, and that one is taken whose averages two levels and the step between them explain best. The
step must stand CURBS.significant_sigmas above what the same averages show on the road beside it, where nothing rises: their noise, and whatever part
of the errors does not average out. By as many it must explain them better than ground that only bends, as in a gutter. It must rise along both halves
of the arc. Then the next arc begins RETURN.led_step farther on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import Rows
from ..common.corners import RunningSums, SideLines
from ..common.curb_limits import CurbSettings
from ..common.decimation import PointDecimation
from ..common.side_curbs import phase_along
from ..common.sides import ahead_of_vehicle, expected_height
from ..weights import CURBS, RETURN
from .classify import CurbReturn, classify_continuation
from .ground_raster import GroundRaster, averaged, ground_raster
from .main_curbs import KnownPlaces, tips_of
from .steps import PATCH_HALF_WIDTH, PlanSteps, points_about, steps_of_points
from .tracking import LineEnds, PlanStepChain, join_chains, link_plan_steps

LEAD_IN_STEPS = int(round(RETURN.line_direction_length / RETURN.led_step))   # averages that begin on the sure curb, so that the course is its own
# errors of an average that are independent
INDEPENDENT = RETURN.led_length * (CURBS.road_fit_length + CURBS.behind_fit_length) / (RETURN.alike_along * RETURN.alike_across)
SHIFTS = np.array(RETURN.shifts)


@dataclass
class _Arc:
    """An arc of RETURN.led_length metres."""

    x: float   # x, y, h: m, where it begins
    y: float
    h: float
    heading: float   # radians
    bend: float   # 1/m, to the left
    uphill: float   # 1 where uphill is on the left, else -1

    def onward(self, t: float) -> _Arc:
        """The same arc from t metres farther on."""
        middle, chord = self.heading + 0.5 * self.bend * t, t * np.sinc(0.5 * self.bend * t / np.pi)
        return _Arc(self.x + chord * np.cos(middle), self.y + chord * np.sin(middle), self.h, self.heading + self.bend * t, self.bend, self.uphill)

    def beside(self, points: tuple[np.ndarray, np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Metres along it and uphill from it, and heights, of the points (x, y, h) beside it."""
        dx, dy = points[0] - self.x, points[1] - self.y
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        ahead, left = dx * cos + dy * sin, dy * cos - dx * sin
        if abs(self.bend) > 1e-4:
            radius = np.hypot(ahead, 1.0 / self.bend - left)
            ahead, left = np.arctan2(self.bend * ahead, 1.0 - self.bend * left) / self.bend, 1.0 / self.bend - np.sign(self.bend) * radius
        inside = np.flatnonzero((ahead >= 0.0) & (ahead < RETURN.led_length) & (np.abs(left) < RETURN.led_length))
        return ahead.take(inside), self.uphill * left.take(inside), points[2].take(inside)


def led_on(ground: GroundRaster, end: FollowedEnds) -> PlanSteps:
    """The faint curb that continues from one end, with RETURN.line_direction_length of sure curb behind it.

    ground : GroundRaster, averaged

    Returns PlanSteps, RETURN.led_step apart, in order out of the line, about half RETURN.led_length less far than the averages; none where
    nothing continues
    """
    x, y, h, tx, ty = (float(v[0]) for v in (end.x, end.y, end.h, end.tx, end.ty))
    near = np.flatnonzero((np.hypot(ground.x - x, ground.y - y) <= RETURN.max_led_length + RETURN.led_length)
                          & (np.abs(ground.h - h) <= RETURN.max_layer_height))
    points = ground.x.take(near), ground.y.take(near), ground.h.take(near)
    # uphill is on the left of the arc where it is not on the right of the end
    arc = _Arc(x - RETURN.line_direction_length * tx, y - RETURN.line_direction_length * ty, h, float(np.arctan2(ty, tx)), 0.0, -float(end.uphill[0]))
    steps: list[PlanSteps] = []
    trials = RETURN.first_turns, RETURN.first_bends, RETURN.first_sigmas
    while len(steps) * RETURN.led_step < RETURN.line_direction_length + RETURN.max_led_length:
        best = _best_average(arc, points, *trials)
        if best is None:
            break
        seen, step = best
        steps.append(step)
        arc, trials = seen.onward(RETURN.led_step), (RETURN.next_turns, RETURN.next_bends, RETURN.next_sigmas)
    # one average at least begins beyond the end
    if len(steps) <= LEAD_IN_STEPS:
        return PlanSteps.none()
    return PlanSteps.join(steps[1:])


def _best_average(arc, points, turns, bends, sigmas):
    """That arc, of those about one, across which two levels and a step explain the ground best, and the step in its middle, where its place is
    surest; None where it is no step that goes on from the arc, or there is too little ground.

    turns, bends : radians and 1/m by which arcs are tried to leave it, positive uphill
    """
    t, u, z = arc.beside(points)
    gap, fit, short = (int(round(v / RETURN.across_cell)) for v in (CURBS.blurred_face_half_width, CURBS.road_fit_length, CURBS.behind_fit_length))
    road = np.flatnonzero((u > -CURBS.blurred_face_half_width - CURBS.road_fit_length) & (u < -CURBS.blurred_face_half_width))
    if len(road) < INDEPENDENT:
        return None
    turns, bends = (v.ravel() for v in np.meshgrid(turns, bends, indexing="ij"))
    allowed = np.abs(arc.uphill * arc.bend + bends) <= RETURN.largest_bend
    turns, bends = turns[allowed], bends[allowed]
    # the grade along the curb
    plane, *_ = np.linalg.lstsq(np.c_[np.ones(len(road)), u[road], t[road]], z[road], rcond=None)
    z = z - plane[2] * t
    zero = int(round((CURBS.blurred_face_half_width + CURBS.road_fit_length - RETURN.level_road[0]) / RETURN.across_cell))
    cells = zero + SHIFTS[-1] + gap + short + 2
    half = 0.5 * RETURN.led_length
    halves, spread = zip(*(_profiles(*(v[part] for v in (t, u, z)), turns, bends, zero, cells) for part in (t < half, t >= half)))
    averages = 0.5 * (halves[0] + halves[1])
    whole = _Levels(averages)
    cells_of_shifts = zero + SHIFTS
    with np.errstate(invalid="ignore", divide="ignore"):
        level = whole.height[:, slice(*(zero + int(round(end / RETURN.across_cell)) for end in RETURN.level_road))]
        doubt = np.sqrt(np.nansum(level**2, axis=1) / np.maximum(np.isfinite(level).sum(axis=1), 1))
        # what the levels and the step between them do not explain
        along = 0.5 * (spread[0] + spread[1]) + 0.25 * (halves[0] - halves[1])**2
        fitted = np.r_[-gap - fit:-gap + 1, gap:gap + short + 1]
        filled = np.isfinite(along)[:, cells_of_shifts[:, None] + fitted]
        unexplained = np.nansum(along[:, cells_of_shifts[:, None] + fitted], axis=2) / np.maximum(filled.sum(axis=2), 1) \
            + whole.scatter(cells_of_shifts)**2
        height = whole.height[:, cells_of_shifts]
        middle = SHIFTS * RETURN.across_cell + (turns * half + 0.5 * bends * half**2)[:, None]
        gain = 0.5 * INDEPENDENT * np.log1p(RETURN.step_share * height**2 / unexplained) \
            - 0.5 * ((SHIFTS * RETURN.across_cell / sigmas[0])**2 + (middle / sigmas[1])**2 + (bends / RETURN.bend_sigma)[:, None]**2)
    gain = np.where(np.isfinite(gain) & (height > 0.0), gain, -np.inf)
    k, shift = np.unravel_index(int(np.argmax(gain)), gain.shape)
    if not np.isfinite(gain[k, shift]):
        return None
    cell, height, least = cells_of_shifts[shift], float(height[k, shift]), CURBS.significant_sigmas * max(float(doubt[k]), CURBS.texture_sigma)
    lower_half = min(_Levels(profiles[k:k + 1]).height[0, cell] for profiles in halves)
    slopes = whole.before.slope[k, cell], whole.behind.slope[k, cell]
    scatter = float(whole.scatter(cells_of_shifts)[k, shift])
    bottom, up = float(whole.before.level[k, cell]), arc.uphill
    good = height >= least and lower_half >= RETURN.min_half_share * least \
        and scatter <= CURBS.max_averaged_scatter and max(map(abs, slopes)) <= CURBS.max_road_slope \
        and _gain_over_bend(averages[k, cell - gap - fit:cell + gap + short + 1], gap + fit) >= 0.5 * CURBS.significant_sigmas**2
    if not good or abs(bottom - arc.h) > CURBS.height_tolerance + RETURN.max_height_grade * RETURN.led_step:
        return None
    across = up * float(SHIFTS[shift] * RETURN.across_cell)
    seen = _Arc(arc.x - across * np.sin(arc.heading), arc.y + across * np.cos(arc.heading), bottom, arc.heading + up * float(turns[k]),
                arc.bend + up * float(bends[k]), up)
    middle = seen.onward(half)
    values = (middle.x, middle.y, -up * np.sin(middle.heading), up * np.cos(middle.heading), bottom + half * float(plane[2]), height, 0.0, scatter,
              int(whole.before.n[k, cell]), int(whole.behind.n[k, cell]))
    return seen, PlanSteps(*(np.array([value]) for value in values))


def _gain_over_bend(averages, middle):
    """Nats by which a step in the cell `middle` of (C,) averages explains them better than ground that bends once and has none: two planes meet in
    a gutter or at the foot of a ramp, and lines fitted beside the bend lie above each other, too."""
    u = (np.arange(len(averages)) - middle) * RETURN.across_cell
    seen = np.isfinite(averages)
    u, face = u[seen], np.clip(u[seen] / CURBS.blurred_face_half_width, -1.0, 1.0)

    def unexplained(*step):
        bent = (np.stack([np.ones(len(u)), u, np.maximum(u - bend, 0.0), *step], axis=1) for bend in u[2:-2])
        return min(float(np.square(averages[seen] - ground @ np.linalg.lstsq(ground, averages[seen], rcond=None)[0]).sum()) for ground in bent)
    return 0.5 * INDEPENDENT * np.log(unexplained() / unexplained(face))


def _profiles(t, u, z, turns, bends, zero, cells):
    """(P, C) m and m², mean and variance of heights in cells across each of P arcs, which pass through the middle of the cell `zero`."""
    mean, variance = np.full((2, len(turns), cells), np.nan)
    for k, (turn, bend) in enumerate(zip(turns, bends)):
        cell = np.floor((u - turn * t - 0.5 * bend * t * t) / RETURN.across_cell + 0.5).astype(np.intp) + zero
        inside = np.flatnonzero((cell >= 0) & (cell < cells))
        cell, h = cell.take(inside), z.take(inside)
        count = np.bincount(cell, minlength=cells)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean[k] = np.bincount(cell, h, cells) / count
            variance[k] = np.bincount(cell, h * h, cells) / count - mean[k]**2
    return mean, variance


# Ends of islands: for a crossing an island is dropped to a few centimetres at its end, which no single view of a noisy scanner shows.
#
# Between the ends of two sides that lie side by side the island ends somewhere. Averaged across it, the end stands out as the curbs do that lead on.


def island_ends(ground: GroundRaster, steps: PlanSteps) -> PlanSteps:
    """Steps of the ends of islands beyond both of their sides, where none was seen. steps : PlanSteps, among them those of the sides"""
    chains = [chain.steps for chain in join_chains(link_plan_steps(steps), steps) if not chain.closed and len(chain.steps) > 2]
    sides = LineEnds.of([(steps.x[chain], steps.y[chain], steps.h[chain]) for chain in chains], RETURN.line_direction_length)
    tail, head = (ends[k] for ends, k in zip((sides.tails, sides.heads), np.indices((len(chains), len(chains))).reshape(2, -1)))
    out, gap = tail[:, 3:] + head[:, 3:], head[:, :2] - tail[:, :2]
    parallel = np.hypot(*out.T)
    out = out / np.maximum(parallel, 1e-9)[:, None]
    # uphill is on the right of the way out of a tail
    width, offset = gap[:, 0] * out[:, 1] - gap[:, 1] * out[:, 0], (gap * out).sum(axis=1)
    beside = (parallel >= 2 * np.cos(0.5 * RETURN.max_join_turn)) & (width >= RETURN.min_island_width) & (width <= RETURN.max_island_gap) \
        & (np.abs(offset) <= RETURN.max_nose_gap)
    ends = PlanSteps.join([PlanSteps.none(), *(_end_between(ground, tail[k, :2] + 0.5 * gap[k], out[k], float(width[k]))
                                               for k in np.flatnonzero(beside))])
    return ends[cKDTree(np.c_[steps.x, steps.y]).query(np.c_[ends.x, ends.y])[0] > RETURN.seen_step_distance] if len(ends) else ends


def _end_between(ground, middle, out, width):
    """The steps of the end of one island, from its one side to the other; none where no step is seen.

    middle : (2,) local m, between the ends of its sides
    out : (2,) unit vector in which they lead; width : m
    """
    across, reach, core = np.array([out[1], -out[0]]), CURBS.max_joined_gap, RETURN.core_share * width
    places = np.stack([ground.x, ground.y], axis=1) - middle
    t, u = places @ across, -(places @ out)
    halves = [np.flatnonzero((side * t >= 0.0) & (side * t <= 0.5 * core) & (np.abs(u) <= reach)) for side in (-1, 1)]
    gap, fit, short, zero = (int(round(v / RETURN.across_cell)) for v in (CURBS.blurred_face_half_width, CURBS.road_fit_length,
                                                                          CURBS.behind_fit_length, reach))
    turns = np.tan(RETURN.end_turns)
    seen = [_profiles(*(v.take(half) for v in (t, u, ground.h)), turns, 0.0 * turns, zero, 2 * zero)[0] for half in halves]
    averages, cells = 0.5 * (seen[0] + seen[1]), np.arange(gap + fit, 2 * zero - gap - short - 1)
    levels = _Levels(averages)
    height, scatter = levels.height[:, cells], levels.scatter(cells)
    with np.errstate(invalid="ignore"):
        steep = np.maximum(*(np.abs(line.slope[:, cells]) for line in (levels.before, levels.behind))) > CURBS.max_road_slope
        sureness = np.where(steep | ~(scatter <= CURBS.max_averaged_scatter), 0.0, np.nan_to_num(height / np.hypot(scatter, CURBS.texture_sigma)))
    k, place = np.unravel_index(int(np.argmax(sureness)), sureness.shape)
    cell, height = int(cells[place]), float(height[k, place])
    if sureness[k, place] < CURBS.significant_sigmas \
            or not min(_Levels(half[k:k + 1]).height[0, cell] for half in seen) >= RETURN.min_half_share * height \
            or _gain_over_bend(averages[k, cell - gap - fit:cell + gap + short + 1], gap + fit) < 0.5 * CURBS.significant_sigmas**2:
        return PlanSteps.none()
    bottom = float(levels.before.level[k, cell])
    # where the raised ground begins in either half: what is hidden lies below it
    raised = [np.nan_to_num(np.clip((half[k, cell - gap:cell + gap + 1] - bottom) / height, 0.0, 1.0)).sum() for half in seen]
    begins = RETURN.across_cell * (cell + gap + 0.5 - zero - np.array(raised))
    skew = float(turns[k] + 2.0 * (begins[1] - begins[0]) / core)
    along = np.linspace(-0.5, 0.5, int(np.ceil(width / RETURN.following_step)) + 1) * (width - 2 * RETURN.plan_cell)
    x, y = middle[:, None] + across[:, None] * along - out[:, None] * (begins.mean() + skew * along)
    uphill, count = -(out + skew * across) / np.hypot(1.0, skew), np.ones(len(along))
    return PlanSteps(x, y, uphill[0] * count, uphill[1] * count, bottom * count, height * count, 0.0 * count, scatter[k, place] * count,
                     *(np.full(len(along), int(line.n[k, cell])) for line in (levels.before, levels.behind)))


class _Levels:
    """Lines through the ground before and behind every cell of (P, C) averages, and `height` between them, NaN where too little was seen."""

    before: SideLines
    behind: SideLines

    def __init__(self, averages):
        gap, fit, short = (int(round(v / RETURN.across_cell)) for v in (CURBS.blurred_face_half_width, CURBS.road_fit_length,
                                                                        CURBS.behind_fit_length))
        sums = RunningSums(averages.shape, RETURN.across_cell)
        sums.add(averages)
        self.before, self.behind = SideLines(sums, -gap - fit, -gap), SideLines(sums, gap, gap + short)
        filled = (self.before.n >= CURBS.min_filled_share * (fit + 1)) & (self.behind.n >= CURBS.min_filled_share * (short + 1))
        self.height = np.where(filled, self.behind.level - self.before.level, np.nan)

    def scatter(self, cells: np.ndarray) -> np.ndarray:
        """(P, K) m, scatter of averages about the rougher of both lines at some cells of every profile."""
        places = (np.arange(len(self.height))[:, None] * self.height.shape[1] + cells).ravel()
        return np.maximum(self.before.scatter(places), self.behind.scatter(places)).reshape(len(self.height), -1)


# Where faint curbs are looked for: beyond the free ends of the curbs that were found, where the scanner is noisy.
#
# Elsewhere averages show no more than single views do.

LED_KINDS = "main", "corner", "side_street"   # the other curbs have no ends


def with_led_on(curbs: Sequence[CurbReturn], runs: Sequence[tuple], decimation: PointDecimation, road: int, sections: Sequence[tuple[int, int]],
                known: KnownPlaces, settings: CurbSettings) -> list[CurbReturn]:
    """The curbs away from main curbs, and what continues faintly from them and from main curbs.

    runs : main curbs in plan, uphill on the right: list of (side, (x, y, h)), local m
    sections : (first, last + 1) profile numbers of those where the scanner is noisy
    known : places of the main curbs
    """
    if not sections:
        return list(curbs)
    line, free = decimation.survey.frame.road(road), [curb for curb in curbs if curb.kind in LED_KINDS and not curb.closed]
    lines = [coordinates for _, coordinates in runs] + [(curb.steps.x, curb.steps.y, curb.steps.h) for curb in free]
    ends = FollowedEnds.of(lines)
    met = known.and_steps([curb.steps for curb in curbs])
    ends = ends[~met.within(ends.x + RETURN.leaving_length * ends.tx, ends.y + RETURN.leaving_length * ends.ty, 0.5 * RETURN.leaving_length)]
    phase = phase_along(_led_steps_of_section, decimation, (ends, settings), settings.profile_width, _join_led)
    continuations: list[CurbReturn] = []
    main_ends = tips_of(runs)
    extended = {id(curb): curb for curb in curbs}
    for number, line_steps in _join_led(list(decimation.executor.run(phase, [(road, *section) for section in sections]))):
        # inside a tight bend a place may have no station
        line_steps = line_steps[np.isfinite(line.locate(line_steps.x, line_steps.y)[0])]
        near = met.within(line_steps.x, line_steps.y, RETURN.meeting_curb_distance)
        near[:int(RETURN.leaving_length / RETURN.led_step)] = False
        line_steps = line_steps[:int(np.argmax(near))] if near.any() else line_steps
        k, at_head = ends.line[number], ends.uphill[number] < 0
        if len(line_steps) < RETURN.min_return_steps:
            continue
        # from the other end of a gap only the rest is continued
        met = met.and_places(line_steps.x, line_steps.y)
        line_steps = line_steps[::-1] if at_head else line_steps
        s, d = line.locate(line_steps.x, line_steps.y)
        if k < len(runs):
            continuations += classify_continuation(line_steps, s, d, runs[k][0], line, main_ends)
        else:
            curb = free[k - len(runs)]
            extended[id(curb)] = _joined(extended[id(curb)], CurbReturn(line_steps, s, d, curb.side, curb.kind), at_head)
    return list(extended.values()) + continuations


def _joined(curb, more, before):
    """A curb with what continues from its beginning, or from its end."""
    parts = (more, curb) if before else (curb, more)
    return CurbReturn(PlanSteps.join([part.steps for part in parts]), *(np.concatenate([getattr(part, name) for part in parts]) for name in "sd"),
                      curb.side, curb.kind)


def _join_led(parts: Sequence[list[tuple[int, PlanSteps]] | None]) -> list[tuple[int, PlanSteps]]:
    """The results of `_led_steps_of_section` of several sections as one."""
    return [led for part in parts if part is not None for led in part]


def _led_steps_of_section(decimation: PointDecimation, section: tuple[int, int, int], ends: FollowedEnds,
                         settings: CurbSettings) -> list[tuple[int, PlanSteps]]:
    """The phase of faint curbs: what continues from the ends in one section of a road.

    section : number of the road, and (first, last + 1) profile numbers
    ends : FollowedEnds of the curbs

    Returns a list of (number of the end, PlanSteps)
    """
    road, first, last = section
    width, line, reach = decimation.width, decimation.survey.frame.road(road), RETURN.max_led_length + RETURN.led_length
    stations, _ = line.locate(ends.x, ends.y)
    members = np.flatnonzero((stations >= first * width) & (stations < last * width))
    if not len(members):
        return []
    profiles = int(np.floor((stations[members].min() - reach) / width)), int(np.ceil((stations[members].max() + reach) / width))
    parts = [_near_ends(decimation.survey, road, part, ends[members]) for part in decimation.decimated_points(road, profiles, None)]
    if not parts:
        return []
    x, y, h = (np.concatenate(column) for column in zip(*parts))
    raster = ground_raster(x, y, h, settings.layer_jump)
    ground = averaged(raster, settings.layer_jump)
    if ground is None:
        return []
    return [(int(k), steps) for k in members if len(steps := led_on(ground, ends[k:k + 1]))]


def _near_ends(survey, road, points, ends):
    """Local x, y and height above the expected road of the points that may belong to what continues."""
    near = np.zeros(len(points.x), bool)
    for x, y in zip(ends.x, ends.y):
        near |= (points.x - x)**2 + (points.y - y)**2 < (RETURN.max_led_length + RETURN.led_length)**2
    indices = np.flatnonzero(near)
    points = points[indices]
    s = points.s
    h = points.z - expected_height(survey, road, s)
    near_vehicle = np.abs(ahead_of_vehicle(survey, points, s)) < CURBS.max_look_along + np.abs(points.d)
    indices = np.flatnonzero(near_vehicle & (h > ends.h.min() - RETURN.max_layer_height) & (h < ends.h.max() + RETURN.max_layer_height))
    return points.x.take(indices), points.y.take(indices), h.take(indices)


# Curbs followed beyond the places where they were found.
#
# Far from the vehicle, or behind a gap, points are too sparse for a curb to stand out by itself. Where a line of curb is known it says where its
# next piece must lie, which way it runs and how high it is; a step measured there, from points farther along the curb, needs no other sign. A line
# ends where no such step was found for the length that a link may span.


@dataclass
class FollowedEnds(Rows):
    """Ends of K lines of curb from which they are followed."""

    x: np.ndarray   # x, y, h: (K,) m, local place and height of the bottom
    y: np.ndarray
    h: np.ndarray
    tx: np.ndarray   # tx, ty: (K,) unit vector out of the line
    ty: np.ndarray
    uphill: np.ndarray   # (K,) 1 where uphill is on the right of that vector, else -1
    height: np.ndarray   # (K,) m, of the step; NaN where it is not known
    line: np.ndarray   # (K,) int, number of the line

    @classmethod
    def of(cls, lines: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]], heights: Sequence[float] | None = None) -> FollowedEnds:
        """Both ends of lines, uphill on the right, that are long enough for a direction.

        lines : list of L (x, y, h), each (N,) m
        heights : (L,) m, of the steps; None where they are not known
        """
        long = np.flatnonzero([np.hypot(x[-1] - x[0], y[-1] - y[0]) >= RETURN.line_direction_length for x, y, _ in lines])
        ends, line = LineEnds.of([lines[k] for k in long], RETURN.line_direction_length), np.tile(long, 2)
        x, y, h, tx, ty = np.concatenate([ends.tails, ends.heads]).T
        height = np.full(len(line), np.nan) if heights is None else np.asarray(heights, float)[line]
        return cls(x, y, h, tx, ty, np.repeat([1.0, -1.0], len(long)), height, line)

    @classmethod
    def of_chains(cls, chains: Sequence[PlanStepChain], steps: PlanSteps) -> FollowedEnds:
        """The ends of open chains of steps."""
        lines = [steps[chain.steps] for chain in chains if not chain.closed and len(chain.steps) > 2]
        return cls.of([(line.x, line.y, line.h) for line in lines], [float(np.median(line.height)) for line in lines])


def followed_steps(raster: GroundRaster, ends: FollowedEnds, min_height: float, max_height: float, least_slope: float,
                   wanted: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> PlanSteps:
    """Steps in the continuation of lines.

    ends : FollowedEnds of the lines
    min_height, max_height : m, of a step
    least_slope : radians, of its face
    wanted : function, local x, y -> (N,) bool: where curbs are looked for; a line is not followed beyond
    """
    # the places behind an end, from which its direction follows
    back = RETURN.following_step * np.arange(RETURN.followed_steps, 0, -1)
    trail_x, trail_y = ends.x[:, None] - back * ends.tx[:, None], ends.y[:, None] - back * ends.ty[:, None]
    distance, left, result = np.full(len(ends), RETURN.following_step), np.full(len(ends), RETURN.followed_length), []
    while len(ends):
        x, y = ends.x + distance * ends.tx, ends.y + distance * ends.ty
        on = wanted(x, y) & (left > 0)
        ends = ends[on]
        x, y, distance, left, trail_x, trail_y = (v[on] for v in (x, y, distance, left, trail_x, trail_y))
        if not len(x):
            break
        nx, ny = ends.uphill * ends.ty, -ends.uphill * ends.tx
        steps, good = _measured_across(raster, x, y, nx, ny, min_height, max_height)
        with np.errstate(invalid="ignore"):
            ratio = steps.height / ends.height
            good &= ~((ratio > RETURN.followed_height_ratio) | (ratio < 1 / RETURN.followed_height_ratio))
        good &= (np.abs(steps.h - ends.h) <= CURBS.height_tolerance + RETURN.max_height_grade * distance) & (steps.behind >= 2) \
            & (steps.noise <= max(CURBS.max_road_roughness, 2 * raster.noise)) \
            & (np.arctan2(steps.height, np.maximum(steps.run - 2 * raster.noise, 0.0)) >= least_slope)
        result.append(steps[good])
        trail_x[good] = np.c_[trail_x[good, 1:], ends.x[good]]
        trail_y[good] = np.c_[trail_y[good, 1:], ends.y[good]]
        dx, dy = steps.x - trail_x[:, 0], steps.y - trail_y[:, 0]
        size = np.maximum(np.hypot(dx, dy), 1e-9)
        x, y, h, tx, ty = (np.where(good, new, old) for new, old in (
            (steps.x, ends.x), (steps.y, ends.y), (steps.h, ends.h), (dx / size, ends.tx), (dy / size, ends.ty)))
        ends = replace(ends, x=x, y=y, h=h, tx=tx, ty=ty, height=np.where(good & np.isnan(ends.height), steps.height, ends.height))
        distance, left = np.where(good, RETURN.following_step, distance + RETURN.following_step), left - RETURN.following_step
        left[distance > RETURN.max_plan_link] = 0.0
    return PlanSteps.join(result) if result else PlanSteps.none()


def _measured_across(raster, x, y, nx, ny, min_height, max_height):
    """A step across each place, from near points where they show it, else from points farther along; and (M,) bool: is it one, there?"""
    good = np.zeros(len(x), bool)
    steps = PlanSteps(*(np.zeros(len(x), column.dtype) for column in PlanSteps.none().columns()))
    for half in RETURN.short_half_length, RETURN.long_half_length, RETURN.followed_half_length:
        left = np.flatnonzero(~good)
        points = points_about(raster, raster.by_cell, *(v.take(left) for v in (x, y, nx, ny)), half)
        # points on all sides, and few, are what most places lack
        suitable, points = _few_all_around(points, len(left), half)
        left = left[suitable]
        if not len(left):
            continue
        place = tuple(v.take(left) for v in (x, y, nx, ny))
        corners, measured = steps_of_points(points, *place, raster.noise, min_height, max_height, graded=True)
        # the line says where along the curb the step is measured, and the face how far across
        across = corners["u"] - corners["skew"] * corners["s"]
        measured.x, measured.y = place[0] + across * place[2], place[1] + across * place[3]
        proved = corners["good"] & (np.abs(across) <= RETURN.followed_across) & (np.abs(corners["skew"]) <= RETURN.followed_skew)
        for column, values in zip(steps.columns(), measured.columns()):
            column[left] = values
        good[left] = proved
    return steps, good


def _few_all_around(about, count, half):
    """(K,) indices of those of `count` places that have points on both sides of the curb, before and behind, but not too many; their points."""
    owner, u, v, h = about
    quarter = np.bincount(4 * owner + 2 * (u > 0) + (v > 0), minlength=4 * count).reshape(-1, 4)
    density = quarter.sum(axis=1) * RETURN.plan_cell**2 / (4 * PATCH_HALF_WIDTH * half)
    chosen = (quarter.min(axis=1) >= RETURN.min_quarter_points) & (density <= RETURN.max_followed_points)
    indices = np.flatnonzero(chosen.take(owner))
    number = np.cumsum(chosen) - 1
    return np.flatnonzero(chosen), (number.take(owner.take(indices)), u.take(indices), v.take(indices), h.take(indices))
