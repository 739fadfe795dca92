"""The road surface: the points between the road edges, or up to where the ground stops being a road, and their outline.

The height of the road is followed outward from the driven track on a grid of station and offset. Points near that height
and between the limits of the road belong to its surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...execution.phase import Phase
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import STRETCH_POINTS
from .ground_change import follow_road, smooth_road
from .ground_grid import ROW_LENGTH, WINDOW_ROWS, MeasuredGround
from .openings import cells_driven, opened_limits, street_ground
from .outline import outlines
from .pavement_edge import Carriageway, edge_offsets, grown_limit, rows_with_edge
from .point_spacing import Margins, said_of_thin
from .road_points import surface_about, surface_points
from .road_surface import SurfaceOutlines

if TYPE_CHECKING:
    from ...survey.open_survey import Survey
    from ..edges.road_edges import RoadEdges

TOLERANCE_FLOOR = 0.03        # m, height tolerance of a scanner without noise
TOLERANCE_SIGMAS = 4.0        # times the noise of the heights, added to it
TRACK_REACH = 1.5             # m either side of the reference line where ground must be measured
GROWN_INSET = 0.05            # m off a limit that is no edge: on a road that is too wide, verge is extracted as paint
MIN_SURFACE_WIDTH = 0.5       # m between the limits of a row with road
MEASURED_PROGRESS = 0.9       # share of the work on a carriageway at which its ground is measured


@dataclass(frozen=True)
class SurfaceSettings:
    """What counts as road surface.

    Attributes
    ----------
    max_width : m from the vehicle's track; a surface without an edge ends there at the latest
    height_tolerance : m; points farther above or below the height of the road do not belong to it.
        A smaller tolerance is used where the noise of the scanner allows it
    """

    max_width: float = setting(17.0, 0.5, 100.0, "The farthest surface from the trajectory", "m")
    height_tolerance: float = setting(0.15, 0.01, 1.0, "The height tolerance", "m")

    def __post_init__(self):
        """Check the limits of all settings."""
        check_limits(self)


def extract_road_surface(survey: Survey, edges: RoadEdges | None = None, settings: SurfaceSettings = SurfaceSettings(),
                         progress: Progress = Progress(), ground: MeasuredGround | None = None) -> tuple[RoadPoints, SurfaceOutlines]:
    """Select the points of the road surface and draw its outline.

    Between road edges, all points at the height of the road belong to the surface. The height is followed from the
    track of the vehicle outward; parked cars, people and islands are not at this height. Where a side has no
    edge, the surface ends where the ground stops being a road (a step, another slope, rougher or differently
    bright ground), at most `max_width` from the track. An opening of up to 30 m in an edge is closed by a
    straight line; where a side street joins there, the surface goes on into it as far as its ground was scanned.

    Parameters
    ----------
    survey : Survey
    edges : RoadEdges or None
    settings : SurfaceSettings
    progress : Progress
    ground : MeasuredGround that an earlier stage kept, or None

    Returns
    -------
    road_points : RoadPoints with `half_width` and `covered`; they stay in the survey's store
    surface : SurfaceOutlines

    Raises
    ------
    RoadExtractionError
        If no road surface is found.
    """
    road_points = RoadPoints.subset_of(survey)
    stretches, margins = [], Margins()
    roads = survey.store.roads()
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        carriageway = find_carriageway(survey, road, edges, settings, part.part(0.0, 0.5), ground)
        if carriageway is None:
            progress.warn(f"Road {road}: no ground was measured near the track, so this road has no surface.")
            continue
        per_row = _take_points(survey, road, carriageway, road_points, part.part(0.5, 1.0))
        stretches += outlines(survey.frame, road, carriageway, per_row)
        margins.add(road, carriageway, *(rows_with_edge(edges, road, carriageway.cells.stations, curb) for curb in (True, False)))
    if not len(road_points):
        raise RoadExtractionError("No road surface was found: no points lie under or beside the trajectory at the height "
                                  "of the road. Check that the trajectory belongs to the point cloud.")
    surface = SurfaceOutlines.of_rows(stretches, survey.crs, said_of_thin(margins.unknown))
    if surface.thin:
        progress.warn(surface.thin)
    progress.info(f"Road surface: {len(road_points):,} points, {surface.area.sum():.0f} m², "
                 f"{surface.area[surface.status == 'grown'].sum():.0f} m² of it without a measured edge on both sides.")
    return road_points, surface


def find_carriageway(survey: Survey, road: int, edges: RoadEdges | None, settings: SurfaceSettings,
                     progress: Progress = Progress(), ground: MeasuredGround | None = None) -> Carriageway | None:
    """Height and limits of one road, row by row.

    Parameters
    ----------
    survey : Survey
    road : number of the road
    edges : RoadEdges or None
    settings : SurfaceSettings
    progress : Progress
    ground : MeasuredGround of the survey, or None to measure it here

    Returns
    -------
    Carriageway, or None where no ground was measured near the track
    """
    start, end = survey.store.span(road)
    windows = [WINDOW_ROWS * k for k in range(int(np.floor(start / ROW_LENGTH / WINDOW_ROWS)), int(np.ceil(end / ROW_LENGTH / WINDOW_ROWS)))]

    stations = (windows[0] + np.arange(WINDOW_ROWS * len(windows)) + 0.5) * ROW_LENGTH
    measured = edge_offsets(edges, road, stations)
    missing = np.isnan(measured["left"][0]) | np.isnan(measured["right"][0])

    per_window = missing.reshape(-1, WINDOW_ROWS).any(axis=1)
    cells, profiles = (ground or MeasuredGround(survey)).windows(road, windows, per_window.tolist(), progress.part(0.0, MEASURED_PROGRESS))
    prior = survey.road_height(road, stations)
    followed = follow_road(cells, prior)
    if followed is None:
        return None
    height = smooth_road(followed, cells)
    tracks = np.array([p.at_station(stations)[0] for p in survey.frame.passes_of(road)])
    limits, grown, closed = {}, {}, {}
    for side, sign, track in (("left", 1.0, tracks.max(axis=0)), ("right", -1.0, tracks.min(axis=0))):
        offset, known = measured[side]
        closed[side] = np.isfinite(offset) & ~known
        if profiles is not None and np.isnan(offset).any():
            grown[side] = grown_limit(profiles, cells, height, prior, sign, track, settings.max_width)
            offset = np.where(np.isnan(offset), grown[side].offset - sign * GROWN_INSET, offset)
        limits[side] = offset, known
        progress.report(MEASURED_PROGRESS + (1.0 - MEASURED_PROGRESS) * (0.6 if side == "left" else 0.9))
    limits = _with_mouths(limits, closed, tracks, cells, followed.ground, cells_driven(survey.frame, road, cells), settings.max_width)
    there = _has_road(followed.ground, cells.offsets) & (limits["left"][0] > limits["right"][0] + MIN_SURFACE_WIDTH)
    tolerance = float(np.clip(TOLERANCE_FLOOR + TOLERANCE_SIGMAS * followed.noise, 0.0, settings.height_tolerance))
    return Carriageway(cells, height, followed.ground, np.where(there, limits["right"][0], np.nan),
                       np.where(there, limits["left"][0], np.nan), limits["right"][1], limits["left"][1], tolerance,
                       grown)


def _with_mouths(limits, closed, tracks, cells, ground, driven, max_width):
    """The limits of both sides, farther out where a side street joins through an opening of the edge."""
    street = street_ground(cells, ground, limits["right"][0], limits["left"][0])
    found = {}
    for side, sign, track in (("left", 1.0, tracks.max(axis=0)), ("right", -1.0, tracks.min(axis=0))):
        offset, bounded = limits[side]
        outward = slice(None) if sign > 0 else slice(None, None, -1)
        opened = opened_limits(sign * offset, closed[side], cells.height[:, outward], street[:, outward],
                               sign * cells.offsets[outward], sign * track + max_width, driven[:, outward])
        found[side] = sign * opened, bounded
    return found


def _has_road(ground, offsets):
    """Rows that show ground near the reference line, or lie within 2.5 m of such a row."""
    measured = ground[:, np.abs(offsets) < TRACK_REACH].any(axis=1)
    return np.convolve(measured, np.ones(11), "same") > 0


def _take_points(survey, road, carriageway, road_points, progress):
    """Put the surface points of one road into `road_points`; returns the number of points in each row of cells."""
    per_row = np.zeros(len(carriageway.height), np.int64)
    executor, length = survey.executor.passing(), survey.store.section_length
    stretches = [stretch for stretch in survey.store.stretches(STRETCH_POINTS if executor.folder else 0) if stretch[0] == road]
    phase = Phase(surface_points, survey, (), lambda item: survey.stretch(road, item[0][1] * length, item[0][2] * length),
                  lambda item: survey.store.points_between(road, item[0][1] * length, item[0][2] * length))
    for sections in executor.run(phase, [(stretch, surface_about(carriageway, stretch, length)) for stretch in stretches], progress):
        for found in sections:
            road_points.store.put_mask(road, found.number, found.bits, half_width=found.half_width, covered=found.covered)
            first = found.first_row - carriageway.cells.first_row
            per_row[first:first + len(found.per_row)] += found.per_row
    return per_row
