"""The road surface: the points between the road edges, or up to where the ground stops being a road, and their outline.

The height of the road is followed outward from the driven track on a grid of station and offset. Points near that height
and between the limits of the road belong to its surface.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import median_filter

from ...common.arrays import mask_runs
from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.setting import Limited, setting
from ...execution.in_step import in_step
from ...execution.phase import Phase
from ...survey.density import counted_cubes, cube_density
from ...survey.frame.road_frame import RoadFrame
from ...survey.open_survey import Survey
from ...survey.store.road_points import RoadPoints
from ..edges.road_edges import RoadEdges
from ..weights import SURFACE
from .ground_change import followed_road
from .ground_grid import GroundCells, MeasuredGround, windows_of
from .pavement_edge import Carriageway, edge_offsets, grown_limit
from .road_points import surface_about, surface_points
from .road_surface import SurfaceOutlines, outlines, without_overlaps


@dataclass(frozen=True)
class SurfaceSettings(Limited):
    """What counts as road surface.

    max_width : m from the vehicle's track; a surface without an edge ends there at the latest
    height_tolerance : m; points farther above or below the height of the road do not belong to it.
        A smaller tolerance is used where the noise of the scanner allows it
    """

    max_width: float = setting(17.0, 0.5, 100.0, "The farthest surface from the trajectory", "m")
    height_tolerance: float = setting(0.15, 0.01, 1.0, "The height tolerance", "m")


def extract_road_surface(survey: Survey, edges: RoadEdges | None = None, settings: SurfaceSettings = SurfaceSettings(),
                         progress: Progress = Progress(), ground: MeasuredGround | None = None) -> tuple[RoadPoints, SurfaceOutlines]:
    """Select the points of the road surface and draw its outline.

    Between road edges, all points at the height of the road belong to the surface. The height is followed from the track of the vehicle outward;
    parked cars, people and islands are not at this height. Where a side has no edge, the surface ends where the ground stops being a road (a step,
    another slope, rougher or differently bright ground), at most `max_width` from the track. An opening of up to 30 m in an edge is closed by a
    straight line; where a side street joins there, the surface goes on into it as far as its ground was scanned. Where two roads share ground, one of
    them draws it.

    ground : MeasuredGround that an earlier stage kept, or None

    Returns
        road_points : RoadPoints with `half_width` and `covered`; the survey lives as long as they do
        surface : SurfaceOutlines

    Raises RoadExtractionError if no road surface is found.
    """
    road_points = RoadPoints.of_survey(survey)
    stretches, thin, cubes, carriageway_of_road = [], [], [], {}
    for road, carriageway in carriageways(survey, edges, settings, progress.part(0.0, 0.5), ground):
        if carriageway is None:
            progress.warn(f"Road {road}: no ground was measured near the track, so this road has no surface.")
            cubes += [(counted_cubes(survey.section(road, number)), None) for number in survey.store.sections(road)]
        else:
            carriageway_of_road[road] = carriageway
    per_row = _take_points(survey, carriageway_of_road, road_points, cubes, progress.part(0.5, 1.0))
    for road, carriageway in carriageway_of_road.items():
        stretches += outlines(survey.frame, road, carriageway, per_row[road])
        thin += thin_margins(road, carriageway)
    if not len(road_points):
        raise RoadExtractionError("No road surface was found: no points lie under or beside the trajectory at the height "
                                  "of the road. Check that the trajectory belongs to the point cloud.")
    road_points.density = tuple(cube_density(part) for part in zip(*cubes))
    surface = SurfaceOutlines.of_rows(without_overlaps(survey.frame, stretches), survey.crs, said_of_thin(thin))
    if surface.thin:
        progress.warn(surface.thin)
    progress.info(f"Road surface: {len(road_points):,} points, {surface.area.sum():.0f} m², "
                 f"{surface.area[surface.status == 'grown'].sum():.0f} m² of it without a measured edge on both sides.")
    return road_points, surface


def carriageways(survey: Survey, edges: RoadEdges | None, settings: SurfaceSettings, progress: Progress = Progress(),
                 ground: MeasuredGround | None = None) -> Iterator[tuple[int, Carriageway | None]]:
    """Height and limits of every road, row by row; the ground of all roads is measured together.

    ground : MeasuredGround of the survey, or None to measure it here

    Yields the number of a road and its Carriageway, None where no ground was measured near the track
    """
    ground, beside, wanted = ground or MeasuredGround(survey), {}, []
    for road in survey.store.roads():
        windows = windows_of(survey, road)
        stations = (windows[0] + np.arange(SURFACE.window_rows * len(windows)) + 0.5) * SURFACE.row_length
        measured = edge_offsets(edges, road, stations)
        missing = np.isnan(measured["left"][0]) | np.isnan(measured["right"][0])
        profiled = missing.reshape(-1, SURFACE.window_rows).any(axis=1).tolist()
        beside[road] = windows, profiled, stations, measured
        wanted += [(road, row, want) for row, want in zip(windows, profiled)]
    in_step([ground.measured(wanted)], survey.executor, progress.part(0.0, SURFACE.measured_progress))
    for k, (road, of_road) in enumerate(beside.items(), start=1):
        yield road, _carriageway(survey, road, settings, ground, *of_road)
        progress.report(SURFACE.measured_progress + (1.0 - SURFACE.measured_progress) * k / len(beside))


def _carriageway(survey, road, settings, ground, windows, profiled, stations, measured):
    """The Carriageway of one road, beside whose rows at (R,) stations these edges were measured."""
    cells, profiles = ground.windows(road, windows, profiled)
    prior = survey.road_height(road, stations)
    known = followed_road(ground, road, cells, prior)
    if known is None:
        return None
    followed, height = known
    tracks = np.array([p.at_station(stations)[0] for p in survey.frame.passes_of(road)])
    limits, grown, closed = {}, {}, {}
    for side, sign, track in (("left", 1.0, tracks.max(axis=0)), ("right", -1.0, tracks.min(axis=0))):
        offset, bounded = measured[side]
        closed[side] = np.isfinite(offset) & ~bounded
        if profiles is not None and np.isnan(offset).any():
            grown[side] = grown_limit(profiles, cells, height, prior, sign, track, settings.max_width)
            offset = np.where(np.isnan(offset), grown[side].offset - sign * SURFACE.grown_inset, offset)
        limits[side] = offset, bounded
    limits = _with_mouths(limits, closed, tracks, cells, followed.ground, cells_driven(survey.frame, road, cells), settings.max_width)
    near_track = followed.ground[:, np.abs(cells.offsets) < SURFACE.track_reach].any(axis=1)
    # rows within 2.5 m of one that shows ground
    has_road = (np.convolve(near_track, np.ones(11))[5:-5] > 0) & (limits["left"][0] > limits["right"][0] + SURFACE.min_surface_width)
    tolerance = float(np.clip(SURFACE.tolerance_floor + SURFACE.tolerance_sigmas * followed.noise, 0.0, settings.height_tolerance))
    return Carriageway(cells, height, followed.ground, np.where(has_road, limits["right"][0], np.nan),
                       np.where(has_road, limits["left"][0], np.nan), limits["right"][1], limits["left"][1], tolerance,
                       grown)


def _with_mouths(limits, closed, tracks, cells, ground, driven, max_width):
    """The limits of both sides, farther out where a side street joins through an opening of the edge."""
    street = street_ground(cells, ground, limits["right"][0], limits["left"][0])
    result = {}
    for side, sign, track in (("left", 1.0, tracks.max(axis=0)), ("right", -1.0, tracks.min(axis=0))):
        offset, bounded = limits[side]
        outward = slice(None) if sign > 0 else slice(None, None, -1)
        opened = opened_limits(sign * offset, closed[side], cells.height[:, outward], street[:, outward],
                               sign * cells.offsets[outward], sign * track + max_width, driven[:, outward])
        result[side] = sign * opened, bounded
    return result


def _take_points(survey, carriageways, road_points, cubes, progress):
    """Put the surface points into `road_points`, and what is counted of sections into `cubes`; {road: points in each row of cells}.

    `carriageways` : {road: Carriageway}
    """
    per_row = {road: np.zeros(len(carriageway.height), np.int64) for road, carriageway in carriageways.items()}
    executor, length = survey.executor, survey.store.section_length
    phase = Phase(surface_points, road_points, (), **survey.along(lambda item: (item[0][0], item[0][1] * length, item[0][2] * length),
                                                                  in_memory=True))
    items = [(stretch, surface_about(carriageways[stretch[0]], stretch, length)) for stretch in survey.store.stretches(list(carriageways))]
    seen: dict[int, list[Any]] = {}
    for (index, first_row, rows, of_scanners, of_sections, seen_there), ((road, *_), _) in zip(executor.run(phase, items, progress), items):
        road_points.store.adopt(index, executor.folder)
        seen.setdefault(road, []).extend(seen_there)
        cubes += of_sections
        road_points.of_scanners = of_scanners + (0 if road_points.of_scanners is None else road_points.of_scanners)
        first = first_row - carriageways[road].cells.first_row
        per_row[road][first:first + len(rows)] += rows
    road_points.seen = seen
    return per_row


# Side streets: where an edge is open, the road goes on through the opening as far as its ground was scanned.
#
# An opening between two edges is closed by a straight line at first. Behind the mouth of a street lies road with its zebra crossing and its lines:
# ground as level and as smooth as the road, wide and deep enough for a street, and lower than the sidewalks on its sides. Behind a dropped curb
# lies a sidewalk that goes on to both sides at one height. The rules are our own.


def street_ground(cells: GroundCells, ground: np.ndarray, right: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Cells of ground that are no rougher than the road.

    cells : GroundCells, R rows and C columns
    ground : (R, C) bool, cells at the height of the road
    right, left : (R,) m, limits of the road; NaN where unknown

    Returns (R, C) bool
    """
    offsets = cells.offsets
    inside = (offsets > right[:, None]) & (offsets < left[:, None]) & np.isfinite(cells.rough)
    usual = np.median(cells.rough[inside]) if inside.any() else 0.0
    return ground & ~(cells.rough > SURFACE.roughness_factor * usual + SURFACE.roughness_floor)


def cells_driven(frame: RoadFrame, road: int, cells: GroundCells) -> np.ndarray:
    """Cells of one road that the reference lines of the other roads run through.

    cells : GroundCells of it, R rows and C columns

    Returns (R, C) bool
    """
    driven = np.zeros(cells.height.shape, bool)
    for other_road in frame.roads:
        if other_road.number == road:
            continue
        row, column, inside = cells.at(*frame.road(road).locate(*other_road.to_map(np.arange(0.0, other_road.length, cells.column_size), 0.0)))
        driven[row[inside], column[inside]] = True
    return driven


def opened_limits(limit: np.ndarray, closed: np.ndarray, height: np.ndarray, ground: np.ndarray, offsets: np.ndarray,
                  farthest: np.ndarray, driven: np.ndarray) -> np.ndarray:
    """Limits of one side that follow the ground through the mouths of side streets.

    A street that was driven itself is another road of the survey, and is left to it.

    limit : (R,) m outward from the reference line, of every row
    closed : (R,) bool, rows in which the limit only closes an opening
    height : (R, C) m, of the ground in cells; NaN where none was measured
    ground : (R, C) bool, cells of `street_ground`
    offsets : (C,) m outward, ascending
    farthest : (R,) m outward, beyond which nothing belongs to the road
    driven : (R, C) bool, cells of `cells_driven`

    Returns (R,) m, `limit` or farther
    """
    result = limit.copy()
    for first, end in mask_runs(closed):
        rows = slice(first, end)
        if (end - first) * SURFACE.row_length < SURFACE.min_mouth_width and not _goes_on_wider(limit, first, end):
            continue
        beyond = (offsets > limit[rows, None]) & (offsets < farthest[rows, None])
        street = _street(beyond, np.isfinite(height[rows]), ground[rows])
        # between the two sides of the street an island may stand in it
        between = np.logical_or.accumulate(street, axis=0) & np.logical_or.accumulate(street[::-1], axis=0)[::-1]
        if (between & driven[rows]).any():
            continue
        deep = between & (offsets > limit[rows, None] + SURFACE.min_mouth_depth)
        if deep.sum(axis=0).max() * SURFACE.row_length < SURFACE.min_street_width \
                or _level_flanks(between, first, height, limit, offsets) > SURFACE.max_level_flanks * (end - first) * SURFACE.row_length:
            continue
        outermost = np.where(between & ground[rows], offsets + SURFACE.column_width / 2, -np.inf).max(axis=1)
        reach = median_filter(outermost, SURFACE.smoothed_rows, mode="nearest")
        result[rows] = np.fmax(limit[rows], np.minimum(reach, farthest[rows]))
    return result


def _goes_on_wider(limit, first, end):
    """Whether the road before or after some rows is known to be as much wider as a mouth is deep."""
    neighbours = limit[[k for k in (first - 1, end) if 0 <= k < len(limit)]]
    return bool((neighbours > limit[first:end].max() + SURFACE.min_mouth_depth).any())


def _street(beyond, seen, ground):
    """(N, C) bool, ground that goes on from the limit of each row without a step and without a long gap."""
    street = np.zeros(beyond.shape, bool)
    unseen_columns, stepped_columns = np.zeros((2, len(beyond)), np.int64)
    going = np.ones(len(beyond), bool)
    for column in np.flatnonzero(beyond.any(axis=0)):
        reached = beyond[:, column] & going
        unseen_columns = np.where(reached, np.where(seen[:, column], 0, unseen_columns + 1), unseen_columns)
        stepped_columns = np.where(reached & seen[:, column], np.where(ground[:, column], 0, stepped_columns + 1), stepped_columns)
        going &= (unseen_columns <= SURFACE.max_unseen_columns) & (stepped_columns < SURFACE.step_columns)
        street[:, column] = reached & going & ground[:, column]
    return street


def _level_flanks(street, first, height, limit, offsets):
    """m along both sides of a street, (N, C) cells from row `first` on, where the ground beside it is level with it; infinite where most of it is.

    What was not seen is taken to be as the rest.
    """
    level = []
    for column in np.flatnonzero(street.any(axis=0)):
        rows = first + np.flatnonzero(street[:, column])[[0, -1]]
        flanks = rows + [-SURFACE.flank_rows, SURFACE.flank_rows]
        usable = (flanks >= 0) & (flanks < len(height))
        usable[usable] = (offsets[column] > limit[flanks[usable]]) & (offsets[column] > limit[rows[usable]] + SURFACE.flank_depth)
        level.append(height[rows[usable], column] - height[flanks[usable], column])
    differences = np.abs(np.concatenate(level)) if level else np.empty(0)
    differences = differences[np.isfinite(differences)]
    share = float((differences < SURFACE.min_flank_step).mean()) if len(differences) else 0.0
    return share * sum(map(len, level)) * SURFACE.column_width if share <= 0.5 else np.inf


# Where no edge was drawn and the points lie too far apart to say that there is no curb.


class ThinMargin(NamedTuple):
    """A stretch of one side of a road without an edge."""

    road: int   # road, side: number of the road; left or right
    side: str
    start: float   # start, end: stations, m
    end: float
    density: float   # points per m² there


def thin_margins(road: int, carriageway: Carriageway) -> list[ThinMargin]:
    """The stretches of a road beside which no edge was found and that hold fewer points than curbs need."""
    cells, result = carriageway.cells, []
    start, length = cells.first_row * cells.row_size, SURFACE.stretch_rows * cells.row_size
    for side, sign, limit, bounded in (("left", 1.0, carriageway.left, carriageway.left_bounded),
                                       ("right", -1.0, carriageway.right, carriageway.right_bounded)):
        density = _densities(cells, carriageway.ground, sign, np.where(bounded, np.nan, limit))
        result += [ThinMargin(road, side, start + a * length, start + b * length, float(np.median(density[a:b])))
                   for a, b in mask_runs(density < SURFACE.min_curb_density)]
    return result


def _densities(cells: GroundCells, ground: np.ndarray, sign: float, limit: np.ndarray) -> np.ndarray:
    """(K,) points per m² along one margin, of stretches of SURFACE.stretch_rows; NaN where it was hardly seen."""
    densities = []
    for first in range(0, len(limit), SURFACE.stretch_rows):
        rows = slice(first, first + SURFACE.stretch_rows)
        inside = sign * (limit[rows, None] - cells.offsets)   # NaN is not inside
        margin = (inside > 0) & (inside < SURFACE.margin)
        count = cells.count[rows]
        count = count[margin & ground[rows] & (count > 0)]
        enough = 2 * np.isfinite(limit[rows]).sum() >= SURFACE.stretch_rows and len(count) >= max(SURFACE.seen_share * margin.sum(), 1)
        densities.append(float(np.median(count)) / (cells.row_size * cells.column_size) if enough else np.nan)
    return np.array(densities)


def said_of_thin(margins: Sequence[ThinMargin]) -> str:
    """What a user is told of them, one sentence after the other; "" where there is little to tell."""
    total = sum(margin.end - margin.start for margin in margins)
    if total < SURFACE.shortest_told:
        return ""
    longest = sorted(margins, key=lambda margin: margin.start - margin.end)[:SURFACE.told_stretches]
    density = float(np.average([margin.density for margin in margins], weights=[margin.end - margin.start for margin in margins]))
    stretches = "; ".join(f"road {m.road}, {m.side} side, station {m.start:.0f} to {m.end:.0f} m" for m in longest)
    stretches += "; …" if len(margins) > len(longest) else ""
    return (f"The points are too few to find curbs along {total:.0f} m, where none was drawn ({stretches}): {density:.0f} per m² beside the limit of "
            f"the road surface, some {100 / np.sqrt(density):.0f} cm apart. A curb of 10 cm needs about {SURFACE.min_curb_density:.0f}, a lower one "
            "more; whether there is one is not known. Give the whole cloud if this one was thinned, or drive slower or nearer to that side.")
