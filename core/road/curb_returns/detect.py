"""Curbs that do not run along the road: around corners, into side streets, about islands.

They are looked for in plan where the road has no boundary yet: between the main curbs, and where a main curb ends. A line of steps that continues a
main curb is a corner, and a side street where it continues straight. A line behind which the ground comes down again is an island. Any other step
does not belong to the road.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...common.progress import Progress
from ...execution.in_step import in_step
from ...survey.frame.placement import PlaceIndex
from ...survey.frame.road import Road
from ...survey.weights import FRAME
from ..common.curb_limits import CurbSettings
from ..common.curb_points import CurbPoints, curb_points_at
from ..common.decimation import PointDecimation
from ..common.occlusion import OcclusionGrid
from ..common.side_curbs import phase_along
from ..common.sides import SIDE_SIGNS, ahead_of_vehicle, expected_height, hidden_beside, work_sections
from ..surface.road_look import RoadLook
from ..weights import CURBS, RETURN
from .classify import CurbReturn, classify_curbs, has_road_before, is_curb_like
from .extended_curbs import FollowedEnds, followed_steps, island_ends, with_led_on
from .ground_raster import averaged, driven_ground, ground_raster, ground_slopes
from .islands import far_sides, ground_behind, on_island_tops, on_main_islands
from .main_curbs import KnownPlaces, SearchLimit, line_tree, main_curbs_of, main_runs, median_distance, places_along, usual_height
from .side_streets import with_curbs_beyond
from .steps import PlanSteps, measure_plan_steps, step_places
from .tracking import join_chains, link_plan_steps

KIND_TITLES = {"main": "of the road's own", "corner": "of corners", "side_street": "of side streets", "island": "of islands"}


def with_curb_returns(curb_points: CurbPoints, decimation: PointDecimation, settings: CurbSettings,
                      progress: Progress = Progress(), beside: Mapping[int, Mapping[str, OcclusionGrid]] | None = None,
                      look_at: Callable[[int], RoadLook] | None = None) -> CurbPoints:
    """The points of the main curbs, and behind them those of corners, side streets and islands.

    Where a piece of main curb is found here, hidden places are looked for in the gaps next to it. A main curb that is the side
    of an island becomes a line about that island.

    curb_points : CurbPoints of every road, of kind main
    beside : number of the road -> side -> OcclusionGrid, what was seen beside it; without, no hidden place is added, and main curbs
        are not looked at for islands
    look_at : gives the RoadLook of a road; without, a curb may lie anywhere
    """
    survey, lines, parts = decimation.survey, [], []
    roads = survey.store.roads()
    on_islands, behind = on_main_islands(curb_points, survey, beside)
    mains = {road: main_curbs_of(curb_points[~on_islands], survey, road) for road in roads}
    runs = {road: main_runs(main, survey.frame.road(road)) for road, (main, _) in mains.items()}
    searches = {road: _PlanSearch.of(main, survey.frame.road(road), runs[road], behind[road]) for road, (main, _) in mains.items()}
    seen = _steps_in_plan(decimation, searches, settings, progress.part(0.0, RETURN.led_progress))
    works = [_returns_of_road(decimation, road, runs, searches[road], seen[road], settings, usual_height(curb_points[curb_points.road == road]),
                               None if look_at is None else look_at(road)) for road in roads]
    for road, curbs in zip(roads, seen_once(list(in_step(works, decimation.executor, progress.part(RETURN.led_progress, 1.0))))):
        points, hidden = _points_of_road(survey, road, curbs, *mains[road][::-1], beside, curb_points.crs)
        lines += points
        parts += points + hidden
    progress.info(f"Curbs away from the road's direction: {_lengths(lines) or 'none'}.")
    return CurbPoints.join([curb_points[~on_islands], *parts], curb_points.crs)


def seen_once(curbs_of_roads: Sequence[Sequence[CurbReturn]]) -> list[list[CurbReturn]]:
    """The lines of each road, without those apart that are lines of another road, too; of two such lines the first is left."""
    result = []
    for k, curbs in enumerate(curbs_of_roads):
        others = line_tree([(curb.steps.x, curb.steps.y) for j, of_other in enumerate(curbs_of_roads) for curb in of_other
                            if j < k or j > k and not curb.apart])
        result.append([curb for curb in curbs if not curb.apart or median_distance(others, curb.steps.x, curb.steps.y) > RETURN.outline_margin])
    return result


def _points_of_road(survey, road, curbs, chain, main, beside, crs):
    """The points of each line, whose chains are numbered from `chain` on, and those hidden next to main curbs among them."""
    lines = [_points_of(survey, road, curb, number) for number, curb in enumerate(curbs, chain)]
    later = [points for points, curb in zip(lines, curbs) if curb.kind == "main"]
    if not later or beside is None:
        return lines, []
    return lines, [hidden_beside(CurbPoints.join(later, crs), main, beside[road], survey, road)]


def _lengths(lines):
    """Metres of each kind, for a message."""
    length = {kind: sum(points.along[-1] for points in lines if points.kind[0] == kind) for kind in KIND_TITLES}
    return ", ".join(f"{length[kind]:.0f} m {title}" for kind, title in KIND_TITLES.items() if length[kind])


def _points_of(survey, road, curb, chain):
    """The points of one line."""
    steps, frame = curb.steps, survey.frame
    z = steps.h + expected_height(survey, road, curb.s) + frame.origin[2]
    along = np.r_[0.0, np.cumsum(np.hypot(np.diff(steps.x), np.diff(steps.y)))]
    return curb_points_at(frame, road, (steps.x + frame.origin[0], steps.y + frame.origin[1], z), side=curb.side, status="measured",
                          station=curb.s, offset=curb.d, height=np.round(steps.height, 4), kind=curb.kind, chain=chain,
                          along=np.round(along, 3), support=steps.support, sigma=np.nan if curb.sigma is None else np.round(curb.sigma, 4))


@dataclass(frozen=True)
class _PlanSearch:
    """Where steps are looked for in plan along one road.

    limits : side -> SearchLimit
    known : places of the main curbs
    barrier : local places that the driven ground does not go beyond
    tips : ends of the main curbs
    behind : (2, K) local m, x and y of places that are road although something stands between them and the track
    """

    limits: dict[str, SearchLimit]
    known: KnownPlaces
    barrier: PlaceIndex
    tips: FollowedEnds
    behind: np.ndarray

    @classmethod
    def of(cls, main: Mapping[str, np.ndarray], line: Road, runs: Sequence[tuple], behind: np.ndarray) -> _PlanSearch:
        """The search beside the main curbs of a road, as of `main_curbs_of` and of `main_runs`."""
        return cls({side: SearchLimit(points, SIDE_SIGNS[side]) for side, points in main.items()},
                   KnownPlaces(places_along(line, main, CURBS.max_joined_gap)),
                   PlaceIndex(places_along(line, main, RETURN.min_opening_length), FRAME.corridor),
                   FollowedEnds.of([coordinates for _, coordinates in runs]), behind)


def _steps_in_plan(decimation, searches, settings, progress):
    """{number of a road: what `plan_steps_of_section` finds on it}; `searches` : {number of a road: _PlanSearch}"""
    sections = [(road, *section) for road in searches for section in work_sections(decimation.survey, road, settings.profile_width)]
    phase = phase_along(plan_steps_of_section, decimation, (searches, settings), settings.profile_width, _join_parts)
    parts: dict[int, list] = {road: [] for road in searches}
    for of_section, (road, *_) in zip(decimation.executor.run(phase, sections, progress), sections):
        parts[road].append(of_section)
    return {road: _join_parts(of_road) for road, of_road in parts.items()}


def _returns_of_road(decimation, road, runs, search, seen, settings, usual, look):
    """Part of a work: corners, side streets and islands of one road, a list of CurbReturn.

    runs : of every road, as of `main_runs`
    search, seen : where steps were looked for on it, and what `plan_steps_of_section` found
    usual : m, height of the road's own curbs
    look : RoadLook of the road; without, a curb may lie anywhere
    """
    if seen is None:
        return []
    line, (steps, falls, scanner_noise) = decimation.survey.frame.road(road), seen
    elsewhere = [(x, y) for other_road, of_other in runs.items() if other_road != road for _, (x, y, _) in of_other]
    chains = [c for c in join_chains(link_plan_steps(steps), steps) if is_curb_like(c, steps, scanner_noise, settings)
              and has_road_before(steps[c.steps], line, look)]
    curbs = classify_curbs(chains, steps, falls, runs[road], line, search.limits, decimation.survey.frame.passes_of(road), usual, elsewhere)
    noisy = _noisy_sections(work_sections(decimation.survey, road, settings.profile_width), line, steps, scanner_noise, settings)
    curbs = with_led_on(curbs, runs[road], decimation, road, noisy, search.known, settings)
    return (yield from with_curbs_beyond(curbs, decimation, road, search.known))


def _noisy_sections(sections, line, steps, scanner_noise, settings):
    """Sections with steps of which the scanner's noise hides faint ones in any single view."""
    noisy = scanner_noise > RETURN.noisy_raster_share * settings.limits.clear_height
    if not settings.limits.automatic_height or not noisy.any():
        return []
    number = np.sort(np.floor(line.locate(steps.x[noisy], steps.y[noisy])[0] / settings.profile_width))
    return [section for section in sections if np.searchsorted(number, section[0]) < np.searchsorted(number, section[1])]


def _join_parts(parts):
    """The results of `plan_steps_of_section` of several sections as one."""
    results = [part for part in parts if part is not None]
    if not results:
        return None
    steps, falls, scanner_noise = zip(*results)
    return PlanSteps.join(steps), np.concatenate(falls), np.concatenate(scanner_noise)


def plan_steps_of_section(decimation: PointDecimation, item: tuple[int, int, int], searches: Mapping[int, _PlanSearch], settings: CurbSettings,
                          points_per_cell: int | None = CURBS.points_per_level_cell_in_plan) -> tuple[PlanSteps, np.ndarray, np.ndarray] | None:
    """The phase of curb returns: steps in plan in one section of a road.

    item : number of the road, and (first, last + 1) profile numbers
    searches : {number of a road: _PlanSearch}
    points_per_cell : as in `decimated_points`, where the ground is not uneven nearly everywhere

    Returns PlanSteps, (N,) m behind each at which the raised ground ends, and (N,) m the scanner's noise; None where there are no steps
    """
    (road, *section), survey, width, clear = item, decimation.survey, decimation.width, settings.limits.clear_height
    limits, known, barrier, tips, behind = (getattr(searches[road], name) for name in ("limits", "known", "barrier", "tips", "behind"))
    margin = int(np.ceil(RETURN.section_margin / width))
    profiles = section[0] - margin, section[1] + margin
    limit = None if points_per_cell is None or decimation.mostly_uneven(road, sum(section) // 2) else points_per_cell
    x, y, h, along = _beside_vehicle(decimation, road, profiles, limits, limit)
    raster = ground_raster(x, y, h, settings.layer_jump)
    if raster is None:
        return None
    noisy = raster.noise > RETURN.noisy_raster_share * clear
    if noisy and limit is not None:
        # averages need every point
        return plan_steps_of_section(decimation, item, searches, settings, points_per_cell=None)
    line, slopes = survey.frame.road(road), ground_slopes(raster.low)
    bounds = barrier.places[barrier.within(*raster.box)].T
    track = _track(survey, road, *(k * width for k in profiles))
    driven, stepped = driven_ground(raster, slopes, track[0], track[1], behind, bounds[0], bounds[1], clear)
    views = _averaged_views(raster, (x, y, h), along, settings.layer_jump) if noisy else [raster]
    wanted = partial(_is_wanted, line=line, limits=limits, known=known, start=section[0] * width, end=section[1] * width)
    x, y, nx, ny = step_places(raster, slopes, driven, stepped, clear, settings.max_height, wanted)
    steps = measure_plan_steps(views, x, y, nx, ny, 0.5 * clear, settings.max_height)
    tips = tips[line.within(tips.x, tips.y, section[0] * width, section[1] * width)]
    ends = FollowedEnds.join([tips, FollowedEnds.of_chains(link_plan_steps(steps), steps)])
    followed = followed_steps(views[0], ends, 0.5 * clear, settings.max_height, settings.limits.clear_slope, partial(wanted, before_curbs=True))
    steps = PlanSteps.join([steps, followed])
    if not len(steps):
        return None
    # inside a tight bend a step may be measured outside the range of stations
    steps = steps[np.isfinite(line.locate(steps.x, steps.y)[0])]
    steps = steps[~on_island_tops(steps, _behind(raster, slopes, steps))]
    ground = _behind(raster, slopes, steps)
    hidden = far_sides(raster, steps, ground)
    hidden = hidden[wanted(hidden.x, hidden.y)]
    if settings.limits.automatic_height:
        ends_of_islands = island_ends(views[0], PlanSteps.join([steps, hidden]))
        hidden = PlanSteps.join([hidden, ends_of_islands[np.isfinite(line.locate(ends_of_islands.x, ends_of_islands.y)[0])]])
    # its near side is the far side of a far side; an island ends where its top does, not where the ground comes out of its shadow
    falls = np.r_[np.where(np.isfinite(ground.edge), ground.edge, ground.falls), np.full(len(hidden), RETURN.min_island_width)]
    # averaging leaves the errors of single beams and the drift of positions
    return PlanSteps.join([steps, hidden]), falls, np.full(len(falls), raster.noise)


def _is_wanted(x, y, line, limits, known, start, end, before_curbs=False):
    """(N,) bool: do local places lie between two stations and beside no main curb, or also before these?"""
    s, d = line.locate(x, y)
    wanted = (s >= start) & (s < end)
    if before_curbs:
        wanted &= np.all([limit.outward(s, d) <= 0.0 for limit in limits.values()], axis=0)
    indices = np.flatnonzero(wanted)
    wanted[indices] = ~known.within(x.take(indices), y.take(indices), RETURN.main_curb_distance)
    return wanted


def _behind(raster, slopes, steps):
    return ground_behind(raster, slopes, steps.x, steps.y, steps.nx, steps.ny, steps.h, steps.height, RETURN.max_island_width)


def _beside_vehicle(decimation, road, profiles, limits, points_per_cell):
    """Points of profiles within reach and near the vehicle: local x, y, height above the expected road, metres ahead of the vehicle."""
    survey, columns = decimation.survey, [np.empty((4, 0))]
    # how far out either side is searched, tabulated along the road
    start, end = (k * decimation.width / RETURN.limit_node_spacing for k in profiles)
    first = int(np.floor(start))
    nodes = np.arange(first, int(np.ceil(end)) + 2) * RETURN.limit_node_spacing
    left, right = (sign * np.minimum(limits[side](nodes), FRAME.corridor) for side, sign in SIDE_SIGNS.items())
    for points in decimation.decimated_points(road, profiles, points_per_cell):
        s, d = points.s, points.d
        node = np.rint(s * (1.0 / RETURN.limit_node_spacing)).astype(np.intp) - first
        indices = np.flatnonzero((d >= right.take(node)) & (d <= left.take(node)))
        along = ahead_of_vehicle(survey, points[indices], s.take(indices))
        near = np.flatnonzero(np.abs(along) < CURBS.max_look_along + np.abs(d.take(indices)))
        indices, along = indices.take(near), along.take(near)
        points = points[indices]
        h = points.z - expected_height(survey, road, s.take(indices))
        columns.append((points.x, points.y, h, along))
    return [np.concatenate(column) for column in zip(*columns)]


def _averaged_views(raster, place, along, layer_jump):
    """Averages of all points, and of those seen far or near, ahead of the vehicle or behind it: a drift of positions in between blurs a curb."""
    quarter = np.digitize(along, (-RETURN.view_length, 0.0, RETURN.view_length))
    seen = quarter > 1, quarter < 2, *(quarter == k for k in range(4))
    parts = (ground_raster(*(v[part] for v in place), layer_jump) for part in seen)
    return [averaged(view, layer_jump) for view in (raster, *parts) if view is not None]


def _track(survey, road, first, last):
    """Local places along the tracks of all passes between two stations."""
    line, xs, ys = survey.frame.road(road), [], []
    for p in survey.frame.passes_of(road):
        s = np.arange(max(first, p.span[0]), min(last, p.span[1]), 0.8 * RETURN.plan_cell)
        x, y = line.to_map(s, p.at_station(s)[0])
        xs.append(x)
        ys.append(y)
    return np.concatenate(xs), np.concatenate(ys)
