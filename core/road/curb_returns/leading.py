"""Where faint curbs are looked for: beyond the free ends of the curbs that were found, where the scanner is noisy.

Elsewhere averages show no more than single views do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...common.progress import Progress
from ...execution.phase import Phase
from ..common.decimation import PointDecimation
from ..common.sides import MAX_LOOK_ALONG, ahead_of_vehicle, expected_height
from .classify import MIN_RETURN_STEPS, CurbReturn, classify_continuation
from .faint import LED_LENGTH, LED_STEP, MAX_LAYER_HEIGHT, MAX_LED_LENGTH, led_on
from .following import FollowedEnds
from .ground_raster import averaged, ground_raster
from .main_curbs import CurbLines
from .steps import PlanSteps

if TYPE_CHECKING:
    from ..common.curb_limits import CurbSettings
    from .main_curbs import KnownPlaces, SearchLimit

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
    phase = Phase(led_steps_of_section, decimation, (road, ends, settings), lambda section: survey.stretch(road, *(k * width for k in section)),
                  lambda section: survey.store.points_between(road, *(k * width for k in section)), join_led)
    more: list[CurbReturn] = []
    main_ends = CurbLines([(x, y) for _, (x, y, _) in runs])
    extended = {id(curb): curb for curb in curbs}
    for number, own in join_led(list(decimation.executor.run(phase, sections, progress))):
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


def join_led(parts: Sequence[list[tuple[int, PlanSteps]] | None]) -> list[tuple[int, PlanSteps]]:
    """The results of `led_steps_of_section` of several sections as one."""
    return [found for part in parts if part is not None for found in part]


def led_steps_of_section(decimation: PointDecimation, section: tuple[int, int], road: int, ends: FollowedEnds,
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
