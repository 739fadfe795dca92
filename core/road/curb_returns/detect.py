"""Curbs that do not run along the road: around corners, into side streets, about islands.

They are looked for in plan where the road has no boundary yet: between the main curbs,
and where a main curb ends. A line of steps that continues a main curb is a corner, and
a side street where it continues straight. A line behind which the ground comes down
again is an island. Any other step does not belong to the road.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from ...common.progress import Progress
from ...execution.phase import Phase
from ...survey.frame.road import CORRIDOR
from ..common.curb_points import CurbPoints, curb_points_at
from ..common.decimation import POINTS_PER_LEVEL_CELL_IN_PLAN, PointDecimation
from ..common.hidden_curb import hidden_beside
from ..common.occlusion import OcclusionGrid
from ..common.sides import MAX_LOOK_ALONG, SIDE_SIGNS, ahead_of_vehicle, expected_height, work_sections
from ..common.tracking import MAX_JOINED_GAP
from .classify import CurbReturn, classify_curbs, is_curb_like
from .far_sides import MIN_ISLAND_WIDTH, far_sides
from .following import FollowedEnds, followed_steps
from .island_tops import on_island_tops
from .leading import with_led_on
from .raster import PLAN_CELL, averaged, driven_ground, ground_behind, ground_raster, ground_slopes, step_places
from .steps import PlanSteps, measure_plan_steps
from .tracking import join_chains, link_plan_steps

if TYPE_CHECKING:
    from ..profiles.detect import CurbSettings

KIND_TITLES = {"main": "of the road's own", "corner": "of corners", "side_street": "of side streets", "island": "of islands"}
MIN_OPENING_LENGTH = 6.0      # m without main curb that are an opening and no driveway
OPENING_MARGIN = 6.0          # m of main curb beside an opening behind which corners are looked for
SEARCH_BEHIND_CURB = 0.6      # m behind a main curb that are searched elsewhere
INNER_MARGIN = 0.5            # m from a main curb from which the ground inside is certainly road, if it lies within
MAX_INNER_HEIGHT = 0.3        # m above or below the expected road
LIMIT_NODE_SPACING = 0.05     # m along the road between the stations at which this is decided
SECTION_MARGIN = 2.0          # m of road on either side of a section that its own steps need
NOISY_RASTER_SHARE = 0.12     # share of the least curb height that heights within a cell scatter, above which they are averaged
MIN_AVERAGING_POINTS = 6      # points in a cell, on average, that averaging needs
MAIN_CURB_DISTANCE = 0.25     # m from a main curb within which a step belongs to it
MAX_RUN_JUMP = 0.5            # m across between points of one run of main curb
LED_PROGRESS = 0.9            # share of the work after which faint curbs are looked for
MAX_ISLAND_WIDTH = 8.0        # m within which the ground behind an island's curb comes down again


def with_curb_returns(curb_points: CurbPoints, decimation: PointDecimation, settings: CurbSettings,
                      progress: Progress = Progress(), beside: Mapping[int, Mapping[str, OcclusionGrid]] | None = None) -> CurbPoints:
    """The points of the main curbs, and behind them those of corners, side streets and islands.

    Where a piece of main curb is found here, hidden places are looked for in the gaps next to it.

    Parameters
    ----------
    curb_points : CurbPoints of every road, of kind main
    decimation : PointDecimation of the survey
    settings : CurbSettings
    progress : Progress
    beside : number of the road -> side -> OcclusionGrid, what was seen beside it; without, no hidden place is added
    """
    survey, parts = decimation.survey, [curb_points]
    length = dict.fromkeys(KIND_TITLES, 0.0)
    roads = survey.store.roads()
    mains = {road: _main_curbs(curb_points, survey, road) for road in roads}
    runs = {road: [(x, y) for _, (x, y, _) in _runs(main, survey.frame.road(road))] for road, (main, _) in mains.items()}
    for i, road in enumerate(roads):
        part = progress.part(i / len(roads), (i + 1) / len(roads))
        main, chain = mains[road]
        elsewhere = [run for other in roads if other != road for run in runs[other]]
        later: list[CurbPoints] = []
        for number, curb in enumerate(find_curb_returns(decimation, road, main, settings, part, elsewhere), chain):
            points = _points_of(survey, road, curb, number)
            length[curb.kind] += points.along[-1]
            parts.append(points)
            if curb.kind == "main":
                later.append(points)
        if later and beside is not None:
            parts.append(hidden_beside(CurbPoints.join(later, curb_points.crs), main, beside[road], survey, road))
    found = ", ".join(f"{length[kind]:.0f} m {title}" for kind, title in KIND_TITLES.items() if length[kind])
    progress.info(f"Curbs away from the road's direction: {found or 'none'}.")
    return CurbPoints.join(parts, curb_points.crs)


def _main_curbs(curb_points, survey, road):
    """Main curbs of a road, side -> (N, 4) station, offset, height and whether it was seen, and the first free chain number."""
    main, curbs = {}, curb_points[curb_points.road == road]
    for side in SIDE_SIGNS:
        own = curbs[(curbs.side == side) & (curbs.part == "bottom")]
        rows = np.c_[own.station, own.offset, own.z, own.status == "measured"]
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
        if len(rows):
            rows[:, 2] -= expected_height(survey, road, rows[:, 0])
        main[side] = rows
    return main, int(curbs.chain.max(initial=-1)) + 1


def _points_of(survey, road, curb, chain):
    """The points of one line."""
    steps, frame = curb.steps, survey.frame
    z = steps.h + expected_height(survey, road, curb.s) + frame.origin[2]
    along = np.r_[0.0, np.cumsum(np.hypot(np.diff(steps.x), np.diff(steps.y)))]
    return curb_points_at(frame, road, (steps.x + frame.origin[0], steps.y + frame.origin[1], z), side=curb.side, status="measured",
                          station=curb.s, offset=curb.d, height=np.round(steps.height, 4), kind=curb.kind, chain=chain,
                          along=np.round(along, 3), support=steps.support)


def find_curb_returns(decimation: PointDecimation, road: int, main: Mapping[str, np.ndarray], settings: CurbSettings,
                      progress: Progress = Progress(), elsewhere: Sequence[tuple[np.ndarray, np.ndarray]] = ()) -> list[CurbReturn]:
    """Corners, side streets and islands of one road.

    Parameters
    ----------
    decimation : PointDecimation of the survey
    road : number of the road
    main : side -> (N, 4) points of the main curb, by station: station, offset, height above the expected road in m,
        1 where it was measured and 0 where it is hidden
    settings : CurbSettings
    progress : Progress
    elsewhere : (x, y) of the main curbs of other roads, local m

    Returns
    -------
    list of CurbReturn
    """
    survey = decimation.survey
    limits = {side: SearchLimit(points, SIDE_SIGNS[side]) for side, points in main.items()}
    line = survey.frame.road(road)
    known, barrier = KnownPlaces(_places_along(line, main, MAX_JOINED_GAP)), _places_along(line, main, MIN_OPENING_LENGTH).T
    runs = _runs(main, line)
    tips = FollowedEnds.of([place for _, place in runs], np.full(len(runs), np.nan))
    phase = Phase(plan_steps_of_section, decimation, (road, limits, known, barrier, tips, settings),
                  lambda section: survey.stretch(road, *(k * settings.profile_width for k in section)),
                  lambda section: survey.store.points_between(road, *(k * settings.profile_width for k in section)), _join_parts)
    sections = work_sections(survey, road, settings.profile_width)
    found = _join_parts(decimation.executor.run(phase, sections, progress.part(0.0, LED_PROGRESS)))
    if found is None:
        return []
    steps, falls, scanner_noise = found
    chains = [c for c in join_chains(link_plan_steps(steps), steps) if is_curb_like(c, steps, scanner_noise, settings)]
    curbs = classify_curbs(chains, steps, falls, runs, line, limits, survey.frame.passes_of(road), elsewhere)
    noisy = _noisy_sections(sections, line, steps, scanner_noise, settings)
    return with_led_on(curbs, runs, decimation, road, noisy, known, limits, settings, progress.part(LED_PROGRESS, 1.0))


def _noisy_sections(sections, line, steps, scanner_noise, settings):
    """Sections with steps of which the scanner's noise hides faint ones in any single view."""
    noisy = scanner_noise > NOISY_RASTER_SHARE * settings.limits.clear_height
    if not settings.limits.automatic_height or not noisy.any():
        return []
    number = np.floor(line.locate(steps.x[noisy], steps.y[noisy])[0] / settings.profile_width)
    return [section for section in sections if ((number >= section[0]) & (number < section[1])).any()]


def _join_parts(parts):
    """The results of `plan_steps_of_section` of several sections as one."""
    found = [part for part in parts if part is not None]
    if not found:
        return None
    steps, falls, scanner_noise = zip(*found)
    return PlanSteps.join(steps), np.concatenate(falls), np.concatenate(scanner_noise)


class SearchLimit:
    """How far out one side is searched: to a little behind the main curb, and everywhere at openings.

    Parameters
    ----------
    points : (N, 4) of the main curb, as of `find_curb_returns`
    sign : of the side's offsets
    """

    def __init__(self, points: np.ndarray, sign: int):
        self.sign = sign
        self.s, self.u, self.seen = points[:, 0], sign * points[:, 1], points[points[:, 3] > 0, 0]
        cuts = np.flatnonzero(np.diff(self.s) > MIN_OPENING_LENGTH) + 1
        self.runs = [(part[0], part[-1]) for part in np.split(self.s, cuts) if len(part)]

    def __call__(self, s: np.ndarray, behind: float = SEARCH_BEHIND_CURB, at_opening: float = OPENING_MARGIN) -> np.ndarray:
        """(N,) m, largest outward offset at (N,) stations: `behind` metres behind the curb, except for its last metres beside openings."""
        if not len(self.s):
            return np.full(len(s), CORRIDOR)
        bounded = np.zeros(len(s), bool)
        for a, b in self.runs:
            bounded |= (s > a + at_opening) & (s < b - at_opening)
        return np.where(bounded, np.interp(s, self.s, self.u) + behind, CORRIDOR)

    def outward(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) m from the main curb outward to places at (N,) stations and offsets; at openings from the end of what is searched."""
        return self.sign * d - self(s, 0.0, 0.0)

    def behind(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) bool, do places at (N,) stations and offsets lie behind the main curb? Those of a side street lie beyond its end.

        A side street leaves at 45° or more: what lies as far out from the curb as its end is away may belong to one.
        """
        out = self.outward(s, d)
        end = np.zeros(len(s))
        for a, b in self.runs:
            end = np.maximum(end, np.minimum(s - a, b - s))
        return (out > 0.0) & (out < end)

    def between(self, start: float, end: float) -> bool:
        """Was a point of main curb measured between two stations?"""
        return bool(((self.seen > start) & (self.seen < end)).any())


def _places_along(line, main, gap):
    """(N, 2) local places along the main curbs, with gaps of up to `gap` metres between their points closed."""
    places = [np.empty((0, 2))]
    for points in main.values():
        for run in _split(points, gap):
            s = np.arange(run[0, 0], run[-1, 0] + PLAN_CELL, PLAN_CELL)
            places.append(np.c_[line.to_map(s, np.interp(s, run[:, 0], run[:, 1]))])
    return np.concatenate(places)


def _split(points, gap=MAX_JOINED_GAP):
    if not len(points):
        return []
    apart = (np.diff(points[:, 0]) > gap) | (np.abs(np.diff(points[:, 1])) > MAX_RUN_JUMP + np.diff(points[:, 0]))
    return np.split(points, np.flatnonzero(apart) + 1)


def _runs(main, line):
    """Main curbs as polylines in plan with uphill on the right: list of (side, (x, y, h))."""
    found = []
    for side, points in main.items():
        for run in _split(points):
            if len(run) > 1:
                run = run[::-1] if side == "left" else run
                found.append((side, (*line.to_map(run[:, 0], run[:, 1]), run[:, 2])))
    return found


class KnownPlaces:
    """Places along main curbs, where no other curb is looked for.

    Parameters
    ----------
    places : (N, 2) local metres
    """

    def __init__(self, places: np.ndarray):
        self.places = places
        self._tree = cKDTree(places)

    def __getstate__(self) -> dict:
        return dict(places=self.places)

    def __setstate__(self, state: dict) -> None:
        KnownPlaces.__init__(self, **state)

    def within(self, x: np.ndarray, y: np.ndarray, distance: float) -> np.ndarray:
        """(N,) bool, is one of the places within a distance of (N,) local places?"""
        if not self._tree.n or not len(x):
            return np.zeros(len(x), bool)
        # the tree finds what is nearer than its bound
        return self._tree.query(np.c_[x, y], distance_upper_bound=np.nextafter(distance, np.inf))[0] <= distance


def plan_steps_of_section(decimation: PointDecimation, section: tuple[int, int], road: int, limits: Mapping[str, SearchLimit],
                          known: KnownPlaces, barrier: np.ndarray, tips: FollowedEnds, settings: CurbSettings,
                          points_per_cell: int | None = POINTS_PER_LEVEL_CELL_IN_PLAN) -> tuple[PlanSteps, np.ndarray, np.ndarray] | None:
    """The phase of curb returns: steps in plan in one section of a road.

    Parameters
    ----------
    decimation : PointDecimation of the survey
    section : (first, last + 1) profile numbers
    road : number of the road
    limits : side -> SearchLimit
    known : places of the main curbs
    barrier : (2, M) local x and y of places that the driven ground does not go beyond
    tips : ends of the main curbs
    settings : CurbSettings
    points_per_cell : as in `decimated_points`, where the ground is not uneven nearly everywhere

    Returns
    -------
    PlanSteps, (N,) bool where the raised ground behind each ends, and (N,) m the scanner's noise; None where there are no steps
    """
    survey, width = decimation.survey, decimation.width
    margin = int(np.ceil(SECTION_MARGIN / width))
    profiles = section[0] - margin, section[1] + margin
    start, end, first, last = (k * width for k in (*section, *profiles))
    reach = _Reach(limits, first, last)
    limit = None if points_per_cell is None or decimation.mostly_uneven(road, sum(section) // 2) else points_per_cell
    seen = [_beside_vehicle(survey, road, part, reach) for part in decimation.decimated_points(road, profiles, limit)]
    if not seen:
        return None
    *place, along, inner = (np.concatenate(column) for column in zip(*seen))
    raster = ground_raster(place[0], place[1], place[2], settings.layer_jump)
    if raster is None:
        return None
    dense = len(raster.x) >= MIN_AVERAGING_POINTS * np.isfinite(raster.low).sum()
    noisy = dense and raster.noise > NOISY_RASTER_SHARE * settings.limits.clear_height
    if noisy and limit is not None:
        # averages need every point
        return plan_steps_of_section(decimation, section, road, limits, known, barrier, tips, settings, points_per_cell=None)
    line = survey.frame.road(road)
    slopes = ground_slopes(raster.low)
    track = _track(survey, road, first, last)
    clear = settings.limits.clear_height
    driven, stepped = driven_ground(raster, slopes, track[0], track[1], [v[inner] for v in place[:2]], barrier[0], barrier[1], clear)

    def wanted(x, y, before_curbs=False):
        own, d = line.locate(x, y)
        fresh = (own >= start) & (own < end)
        if before_curbs:
            fresh &= np.all([limit.outward(own, d) <= 0.0 for limit in limits.values()], axis=0)
        which = np.flatnonzero(fresh)
        fresh[which] = ~known.within(x.take(which), y.take(which), MAIN_CURB_DISTANCE)
        return fresh

    x, y, nx, ny = step_places(raster, slopes, driven, stepped, clear, settings.max_height, wanted)
    at, _ = line.locate(tips.x, tips.y)
    tips = tips[(at >= start) & (at < end)]
    if not len(x) and not len(tips):
        return None
    views = _averaged_views(raster, place, along, settings.layer_jump) if noisy else [raster]
    steps = measure_plan_steps(views, x, y, nx, ny, 0.5 * clear, settings.max_height)
    ends = FollowedEnds.join([tips, FollowedEnds.of_chains(link_plan_steps(steps), steps)])

    further = followed_steps(views[0], ends, 0.5 * clear, settings.max_height, settings.limits.clear_slope,
                             lambda x, y: wanted(x, y, before_curbs=True))
    steps = PlanSteps.join([steps, further])
    if not len(steps):
        return None
    # inside a tight bend a step may be measured outside the range of stations
    steps = steps[np.isfinite(line.locate(steps.x, steps.y)[0])]
    steps = steps[~on_island_tops(steps, _behind(raster, slopes, steps))]
    behind = _behind(raster, slopes, steps)
    hidden = far_sides(raster, steps, behind)
    hidden = hidden[wanted(hidden.x, hidden.y)]
    # its near side is the far side of a far side; an island ends where its top does, not where the ground comes out of its shadow
    falls = np.r_[np.where(np.isfinite(behind.edge), behind.edge, behind.falls), np.full(len(hidden), MIN_ISLAND_WIDTH)]
    # averaging leaves the errors of single beams and the drift of positions
    return PlanSteps.join([steps, hidden]), falls, np.full(len(falls), raster.noise)


def _behind(raster, slopes, steps):
    return ground_behind(raster, slopes, steps.x, steps.y, steps.nx, steps.ny, steps.h, steps.height, MAX_ISLAND_WIDTH)


def _beside_vehicle(survey, road, points, reach):
    """Points within reach and near the vehicle: local x, y, height above the expected road, metres ahead of the vehicle,
    and whether each lies between the road's own curbs. The far side of a long island is road, too, but it may not be
    connected with the track within a section."""
    s, d = points.s, points.d
    inside, inner = reach(s, d)
    own = np.flatnonzero(inside)
    s, d, inner, points = s.take(own), d.take(own), inner.take(own), points[own]
    along = ahead_of_vehicle(survey, points, s)
    near = np.flatnonzero(np.abs(along) < MAX_LOOK_ALONG + np.abs(d))
    if len(near) < len(s):
        s, inner, along, points = s.take(near), inner.take(near), along.take(near), points[near]
    h = points.z - expected_height(survey, road, s)
    return points.x, points.y, h, along, inner & (np.abs(h) < MAX_INNER_HEIGHT)


class _Reach:
    """How far out both sides are searched between two stations, tabulated at nodes LIMIT_NODE_SPACING apart."""

    def __init__(self, limits, first, last):
        self.first = int(np.floor(first / LIMIT_NODE_SPACING))
        nodes = np.arange(self.first, int(np.ceil(last / LIMIT_NODE_SPACING)) + 2) * LIMIT_NODE_SPACING
        left, right = (np.minimum(limits[side](nodes), CORRIDOR) for side in SIDE_SIGNS)
        self.inside = -right, left
        self.inner = [sign * np.where(limit < CORRIDOR, np.maximum(limit - SEARCH_BEHIND_CURB - INNER_MARGIN, 0.0), 0.0)
                      for sign, limit in ((-1, right), (1, left))]

    def __call__(self, s, d):
        """(N,) bool, within the limits, and (N,) bool, certainly between the road's own curbs."""
        k = np.rint(s * (1.0 / LIMIT_NODE_SPACING)).astype(np.intp)
        k -= self.first
        return tuple((d >= low.take(k)) & (d <= high.take(k)) for low, high in (self.inside, self.inner))


def _averaged_views(raster, place, along, layer_jump):
    """Averages of all points, of those seen ahead and of those seen behind the vehicle: a drift of positions in between blurs a curb."""
    halves = (ground_raster(*(v[half] for v in place), layer_jump) for half in (along > 0, along <= 0))
    return [averaged(view, layer_jump) for view in (raster, *halves) if view is not None]


def _track(survey, road, first, last):
    """Local places along the tracks of all passes between two stations."""
    line, xs, ys = survey.frame.road(road), [], []
    for p in survey.frame.passes_of(road):
        s = np.arange(max(first, p.span[0]), min(last, p.span[1]), 0.8 * PLAN_CELL)
        x, y = line.to_map(s, p.at_station(s)[0])
        xs.append(x)
        ys.append(y)
    return np.concatenate(xs), np.concatenate(ys)
