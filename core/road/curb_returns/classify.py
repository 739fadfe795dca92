"""What a line of steps in plan is: a corner, the curb of a side street, an island, or no curb of the road."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...common.arrays import mask_runs
from ...survey.frame.road import Road
from ...survey.frame.road_frame import Pass
from ..common.curb_limits import CurbSettings
from ..common.sides import SIDE_SIGNS
from ..common.tracking import is_clean, is_road
from ..surface.road_look import RoadLook
from ..weights import CURBS, RETURN
from .main_curbs import SearchLimit, line_tree, median_distance, tips_of
from .steps import PlanSteps
from .tracking import PlanStepChain, group_lines


@dataclass
class CurbReturn:
    """One line of curb away from the road's own.

    sigma : (N,) m, one sigma across that the steps share, of a line that was fitted as a whole; None of steps that were seen one by one
    """

    steps: PlanSteps   # N PlanSteps in order, uphill on the right
    s: np.ndarray   # s, d: (N,) m, station and offset of each
    d: np.ndarray
    side: str   # "left" or "right"
    kind: str   # "main" (a piece of main curb that profiles missed), "corner", "side_street" or "island"
    closed: bool = False   # does it go all around an island?
    apart: bool = False   # does nothing but its height tell that it is one?
    sigma: np.ndarray | None = None


def is_curb_like(chain: PlanStepChain, steps: PlanSteps, scanner_noise: np.ndarray, settings: CurbSettings) -> bool:
    """Is a line long, dense, steep and smooth enough for a curb?

    steps : M PlanSteps to which it refers
    scanner_noise : (M,) m
    """
    line_steps = steps[chain.steps]
    length = _length(line_steps.x, line_steps.y)
    if length < RETURN.min_return_length or len(line_steps) < RETURN.min_return_steps or length > RETURN.max_step_spacing * len(line_steps):
        return False
    if _seen_behind(line_steps) < RETURN.least_behind:
        return False
    height, noise = np.median(line_steps.height), np.median(scanner_noise[chain.steps])
    sharp = max(np.quantile(line_steps.run, 0.3) - 2 * noise, 0.0)
    limits, slope, rough, scatter = settings.limits, np.arctan2(height, sharp), np.median(line_steps.noise), _chain_scatter(line_steps)
    if height < limits.clear_height or slope < limits.clear_slope \
            and not (limits.automatic and length >= CURBS.min_faint_length and limits.faint(height, slope, rough, len(line_steps), scatter)):
        return False
    return is_clean(rough, noise, line_steps.behind, scatter)


def _seen_behind(steps):
    """Points of raised ground for each one before a line of steps and on it: behind the foot of a wall there are hardly any."""
    return np.median(steps.behind / np.maximum(steps.support, 1))


def has_road_before(line_steps: PlanSteps, line: Road, look: RoadLook | None) -> bool:
    """Does road lie before a line of steps, as far as its RoadLook tells? What goes on for long enough is a curb whatever is before it."""
    if look is None or _length(line_steps.x, line_steps.y) >= CURBS.min_faint_length:
        return True
    before = np.array(CURBS.road_before_curb)[:, None]
    return is_road(look.roughness(*line.locate(*((place - before * uphill).ravel() for place, uphill in
                                                 ((line_steps.x, line_steps.nx), (line_steps.y, line_steps.ny))))))


def _length(x, y):
    return float(np.hypot(np.diff(x), np.diff(y)).sum())


def _chain_scatter(curb):
    """Median distance of the steps of a line from the chord of their neighbours, m."""
    if len(curb) < 3:
        return 0.0
    cx, cy = curb.x[2:] - curb.x[:-2], curb.y[2:] - curb.y[:-2]
    off = np.abs(cx * (curb.y[1:-1] - curb.y[:-2]) - cy * (curb.x[1:-1] - curb.x[:-2])) / np.maximum(np.hypot(cx, cy), 1e-6)
    return float(np.median(off))


def classify_curbs(chains: Sequence[PlanStepChain], steps: PlanSteps, falls: np.ndarray, runs: Sequence[tuple], line: Road,
                   limits: Mapping[str, SearchLimit], passes: Sequence[Pass], usual: float = np.nan,
                   elsewhere: Sequence[tuple[np.ndarray, np.ndarray]] = ()) -> list[CurbReturn]:
    """The lines that are curbs, each with its kind and side.

    steps : M PlanSteps to which they refer
    falls : (M,) m uphill of each step at which the ground is down again, NaN where it stays up
    runs : main curbs in plan, uphill on the right: list of (side, (x, y, h)), local m
    limits : side -> SearchLimit
    passes : of the road
    usual : m, height of the road's own curbs, NaN where there are none
    elsewhere : (x, y) of the main curbs of other roads, local m
    """
    if not chains:
        return []
    other_lines = line_tree(elsewhere)
    mains = {k: curb for k, chain in enumerate(chains) if (curb := _own_curb(chain, steps, falls, line, limits, passes, other_lines)) is not None}
    runs = [*runs, *((curb.side, (curb.steps.x, curb.steps.y, curb.steps.h)) for curb in mains.values())]
    chains = [chain for k, chain in enumerate(chains) if k not in mains]
    tips, linked = tips_of(runs), PlanSteps.join([PlanSteps.none(), *(steps[chain.steps] for chain in chains)])
    result, separate = list(mains.values()), list[CurbReturn]()
    for side, chain in zip(_sides_continued(runs, chains, steps), chains):
        line_steps = steps[chain.steps]
        if side:
            result += classify_continuation(line_steps, *line.locate(line_steps.x, line_steps.y), side, line, tips)
        else:
            curb = _curb_apart(line_steps, falls[chain.steps], chain.closed, line, limits, passes, linked)
            (result if curb.kind == "side_street" else separate).append(curb)
    return result + _of_the_road(separate, result, runs, elsewhere, usual)


def _sides_continued(runs, chains, steps):
    """Of each chain the side of the main curb that it continues, "" where there is none."""
    group = group_lines([coordinates for _, coordinates in runs] + [(steps.x[c.steps], steps.y[c.steps], steps.h[c.steps]) for c in chains])
    sides: dict[int, str] = {}
    for number, (side, _) in zip(group, runs):
        sides.setdefault(number, side)
    return ["" if chain.closed else sides.get(number, "") for number, chain in zip(group[len(runs):], chains)]


def _curb_apart(curb, falls, closed, line, limits, passes, linked):
    """A line that continues no main curb, as an island, as a side street whose corner is hidden, or else as a corner or of no kind.

    linked : PlanSteps of all lines that continue none
    """
    s, d = line.locate(curb.x, curb.y)
    behind = np.any([limit.behind(s, d) for limit in limits.values()], axis=0)
    side = _side(s, d, passes)
    if np.mean(np.isfinite(falls) & ~behind) >= RETURN.min_island_share:
        return CurbReturn(curb, s, d, side, "island", closed)
    # nothing joins it to the main curb
    if _length(curb.x, curb.y) >= RETURN.min_isolated_length and np.mean(behind) <= RETURN.max_behind_share \
            and np.median(_road_cosine(curb, s, line)) < RETURN.min_road_cosine and _has_opposite_curb(curb, linked):
        straight = _straight_part(curb)
        return CurbReturn(curb[straight], s[straight], d[straight], side, "side_street")
    is_corner = np.mean(behind) <= RETURN.max_behind_share and _seen_behind(curb) >= RETURN.least_behind_apart
    return CurbReturn(curb, s, d, side, "corner" if is_corner else "", apart=True)


def _of_the_road(apart, continued, runs, elsewhere, usual):
    """Of lines apart those that are curbs of this road: its curbs are of one height; an island that goes on for long may have another.

    continued, runs, elsewhere : the curbs that are known; usual : m, height of the road's own ones, NaN where there are none
    """
    known = line_tree([*((x, y) for _, (x, y, _) in runs), *((curb.steps.x, curb.steps.y) for curb in continued), *elsewhere])
    off = {id(curb): abs(np.log(np.median(curb.steps.height) / usual)) for curb in apart}
    islands = [curb for curb in apart if curb.kind == "island"]
    corners = [curb for curb in apart if curb.kind == "corner" and off[id(curb)] <= RETURN.max_height_step
               and median_distance(known, curb.steps.x, curb.steps.y) > RETURN.outline_margin]
    least = [CURBS.min_faint_length if off[id(curb)] > RETURN.max_height_step else RETURN.min_island_length for curb in islands]
    return corners + _long_islands(islands, np.array(least))


def _own_curb(chain, steps, falls, line, limits, passes, elsewhere):
    """A line along the road, uphill outward, where far and wide no main curb is known: its points lie too sparse for profiles. Else None."""
    line_steps = steps[chain.steps]
    s, d = line.locate(line_steps.x, line_steps.y)
    side = _side(s, d, passes)
    free = limits[side].far_from(s, RETURN.opening_margin)
    out = SIDE_SIGNS[side] * (line_steps.ny * np.cos(line.heading(s)) - line_steps.nx * np.sin(line.heading(s)))
    if chain.closed or not free.any() or np.ptp(s[free]) < CURBS.min_curb_length or np.median(out) < RETURN.min_parallel_cosine \
            or np.mean(np.isfinite(falls[chain.steps])) >= RETURN.min_island_share \
            or median_distance(elsewhere, line_steps.x, line_steps.y) <= RETURN.outline_margin:
        return None
    return CurbReturn(line_steps, s, d, side, "main")


def _side(s, d, passes):
    """The side of the driven tracks on which a line mostly lies."""
    return "left" if np.nanmedian(d - np.mean([p.at_station(s)[0] for p in passes], axis=0)) > 0 else "right"


def _straight_part(curb):
    """The longest run of steps, as a slice, in the line's own direction: at its ends it may have caught a wall, or the back of a sidewalk."""
    along = np.arctan2(*_chords(curb)[::-1])
    turn = np.abs((along - np.arctan2(np.median(np.sin(along)), np.median(np.cos(along))) + np.pi) % (2 * np.pi) - np.pi)
    runs = mask_runs(turn <= RETURN.max_side_street_turn)
    return slice(*max(runs, key=lambda run: run[1] - run[0])) if runs else slice(0, len(curb))


def classify_continuation(curb: PlanSteps, s: np.ndarray, d: np.ndarray, side: str, line: Road, tips: cKDTree) -> list[CurbReturn]:
    """A line that continues a main curb: a piece of that curb, or a corner with the straight curb of a side street behind it.

    curb : N PlanSteps in order, uphill on the right
    s, d : (N,) m, their stations and offsets
    side : of the main curb
    tips : ends of the main curbs
    """
    along = _road_cosine(curb, s, line)
    if np.median(along) > RETURN.min_road_cosine:
        return [CurbReturn(curb, s, d, side, "main")]
    near = tips.query(np.c_[curb.x, curb.y][[0, -1]])[0]
    # in order from the main curb outward
    order = np.arange(len(curb)) if near[0] <= near[1] else np.arange(len(curb))[::-1]
    cut = len(curb) if max(near) <= CURBS.max_joined_gap else _where_straight(curb, order, along)
    parts = [(order[:cut + 1], "corner"), (order[cut:], "side_street")]
    return [CurbReturn(curb[np.sort(part)], s[np.sort(part)], d[np.sort(part)], side, kind) for part, kind in parts if len(part) > 1]


def _has_opposite_curb(curb, steps):
    """Do any of the steps of all lines lie along the opposite side of the street that this one bounds?"""
    k = len(curb) // 2
    dx, dy = steps.x - curb.x[k], steps.y - curb.y[k]
    out, shift = -(dx * curb.nx[k] + dy * curb.ny[k]), np.abs(dx * curb.ny[k] - dy * curb.nx[k])
    opposite = steps.nx * curb.nx[k] + steps.ny * curb.ny[k] < -0.7
    return bool(np.any((out > RETURN.side_street_widths[0]) & (out < RETURN.side_street_widths[1]) & (shift < RETURN.max_opposite_shift) & opposite))


def _road_cosine(curb, s, line):
    """(N,) cosine of the angle between a line and the road at its steps."""
    dx, dy = _chords(curb)
    return np.abs(dx * np.cos(line.heading(s)) + dy * np.sin(line.heading(s))) / np.maximum(np.hypot(dx, dy), 1e-9)


def _chords(curb):
    """(N,) m, x and y from the second step before each one to the second behind it: the course of a line is surer than its single faces."""
    k = np.arange(len(curb))
    a, b = np.maximum(k - 2, 0), np.minimum(k + 2, len(curb) - 1)
    return curb.x[b] - curb.x[a], curb.y[b] - curb.y[a]


def _where_straight(curb, order, along):
    """Position in `order` from which a line runs straight to its end, away from the road; its length where it does not."""
    x, y = curb.x[order], curb.y[order]
    for k in range(len(x) - 2):
        chord = np.hypot(x[-1] - x[k], y[-1] - y[k])
        if chord < RETURN.min_straight_length:
            break
        off = np.abs((x[-1] - x[k]) * (y[k:] - y[k]) - (y[-1] - y[k]) * (x[k:] - x[k])) / chord
        if off.max() <= RETURN.max_straight_deviation and np.median(along[order[k:]]) < RETURN.min_road_cosine:
            return k
    return len(x)


def _long_islands(lines, least):
    """Lines about islands that are long enough, together with those nearby; `least` : (N,) m that each needs."""
    if not lines:
        return []
    length = np.array([_length(line.steps.x, line.steps.y) for line in lines])
    places = [shapely.MultiPoint(np.c_[line.steps.x, line.steps.y]) for line in lines]
    line, near = shapely.STRtree(places).query(places, predicate="dwithin", distance=RETURN.max_island_gap)
    return [lines[k] for k in np.flatnonzero(np.bincount(line, length[near]) >= least)]
