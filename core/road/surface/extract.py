"""The road surface: the points between the road edges, or as far as the ground stays a road, and their outline."""

from dataclasses import dataclass

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.features import Features
from ...common.parallel import in_order
from ...common.progress import Progress
from ...common.schemas import ROAD_SURFACE
from ...common.setting import check_limits, setting
from ...survey.frame.road_frame import CORRIDOR
from ...survey.store.records import COORDINATE_SCALE
from ...survey.store.road_points import RoadPoints
from .ground_grid import ROW_LENGTH, GroundCells, ground_cells
from .limits import edge_offsets
from .outline import add_outlines
from .pavement_edge import SurfaceProfiles, grown_offsets
from .region_growing import follow_road, smooth_road
from .road_points import OBSTACLE_SQUARE, covered_by_obstacles, points_on_road

WINDOW_ROWS = 10      # rows of cells made at a time: 5 m
TOLERANCE_FLOOR = 0.03  # m
TOLERANCE_SIGMAS = 4.0


@dataclass(frozen=True)
class SurfaceSettings:
    """What counts as road surface.

    max_width : m from the vehicle's track that a surface without an edge grows at most
    height_tolerance : m about the road's own height that a point may lie at most;
        where the scanner's noise allows, less is taken
    """

    max_width: float = setting(17.0, 0.5, 100.0, "The farthest surface from the trajectory", "m")
    height_tolerance: float = setting(0.15, 0.01, 1.0, "The height tolerance", "m")

    def __post_init__(self):
        check_limits(self)


@dataclass
class Carriageway:
    """One road's surface in rows of stations.

    cells, height : the grid (height is the smoothed road's, (rows, columns))
    right, left : (rows,) offsets of its limits; NaN in rows without road
    right_bounded, left_bounded : (rows,) whether an edge bounds it there
    tolerance : m about the height
    """

    cells: GroundCells
    height: np.ndarray
    ground: np.ndarray
    right: np.ndarray
    left: np.ndarray
    right_bounded: np.ndarray
    left_bounded: np.ndarray
    tolerance: float


def extract_road_surface(survey, edges=None, settings=SurfaceSettings(), progress=Progress()):
    """Keep the points of the road surface.

    Between road edges everything belongs that lies on the road's own height,
    which is followed from under the vehicle outward: parked cars, people and
    islands do not. On a side, or a stretch of it, without an edge the surface
    ends where the ground stops being a road (a step, another slope, rough or
    differently bright ground), at most `max_width` from the track. Across an
    opening up to 30 m long the line from edge to edge bounds it.

    Parameters
    ----------
    survey : Survey
    edges : Features ROAD_EDGES in map coordinates, or None

    Returns
    -------
    RoadPoints with `half_width`, which stay in the survey's store, and Features
    ROAD_SURFACE: PolygonZ, `status` measured where both sides have an edge
    (measured or bridged), grown elsewhere.

    Raises
    ------
    RoadExtractionError
        If no road surface is found.
    """
    road_points = RoadPoints.subset_of(survey)
    surface = Features("PolygonZ", list(ROAD_SURFACE), crs=survey.crs)
    roads = survey.store.roads()
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        carriageway = find_carriageway(survey, road, edges, settings, part.part(0.0, 0.5))
        if carriageway is None:
            progress.warn(f"Road {road}: nothing was scanned near the track, so it has no surface.")
            continue
        per_row = _take_points(survey, road, carriageway, road_points, part.part(0.5, 1.0))
        add_outlines(surface, survey.frame, road, carriageway, per_row)
    if not len(road_points):
        raise RoadExtractionError("No road surface was found: nothing was scanned under or beside the trajectory at the height "
                                  "of the road. Check that the trajectory belongs to the point cloud.")
    grown = sum(g.area for g, r in surface if r["status"] == "grown")
    progress.say(f"Road surface: {len(road_points):,} points, {sum(g.area for g in surface.geometries):.0f} m², "
                 f"{grown:.0f} m² of it grown without an edge.")
    return road_points, surface


def find_carriageway(survey, road, edges, settings, progress=Progress()):
    """Height and limits of one road, row by row; None where nothing lies near its track."""
    start, end = survey.store.span(road)
    windows = [WINDOW_ROWS * k for k in range(int(np.floor(start / ROW_LENGTH / WINDOW_ROWS)), int(np.ceil(end / ROW_LENGTH / WINDOW_ROWS)))]

    stations = (windows[0] + np.arange(WINDOW_ROWS * len(windows)) + 0.5) * ROW_LENGTH
    measured = edge_offsets(edges, survey.frame, road, stations)
    missing = np.isnan(measured["left"][0]) | np.isnan(measured["right"][0])

    def look(row):
        points = survey.window(road, row * ROW_LENGTH, (row + WINDOW_ROWS) * ROW_LENGTH)
        profiles = None
        if missing[row - windows[0]:row - windows[0] + WINDOW_ROWS].any():
            profiles = SurfaceProfiles.of(points, row * ROW_LENGTH, WINDOW_ROWS * ROW_LENGTH, CORRIDOR, road_height)
        return ground_cells(points, row, WINDOW_ROWS, CORRIDOR, road_height), profiles

    def road_height(s):
        return survey.road_height(road, s)

    seen = list(in_order(look, windows, progress))
    cells = GroundCells.joined([part for part, _ in seen])
    profiles = [part for _, part in seen if part is not None]
    prior = road_height(stations)
    followed = follow_road(cells, prior)
    if followed is None:
        return None
    height = smooth_road(followed, cells)
    tracks = np.array([p.at_station(stations)[0] for p in survey.frame.passes_of(road)])
    limits = {}
    for side, sign, track in (("left", 1.0, tracks.max(axis=0)), ("right", -1.0, tracks.min(axis=0))):
        offset, known = measured[side]
        if np.isnan(offset).any():
            grown = grown_offsets(SurfaceProfiles.joined(profiles), cells, height - prior[:, None], sign, track, settings.max_width)
            offset = np.where(np.isnan(offset), grown, offset)
        limits[side] = offset, known
    there = _has_road(followed.ground, cells.offsets) & (limits["left"][0] > limits["right"][0] + 0.5)
    tolerance = float(np.clip(TOLERANCE_FLOOR + TOLERANCE_SIGMAS * followed.noise, 0.0, settings.height_tolerance))
    return Carriageway(cells, height, followed.ground, np.where(there, limits["right"][0], np.nan),
                       np.where(there, limits["left"][0], np.nan), limits["right"][1], limits["left"][1], tolerance)


def _has_road(ground, offsets):
    """Rows that show ground near the reference line, or lie within 2.5 m of such."""
    seen = ground[:, np.abs(offsets) < 1.5].any(axis=1)
    return np.convolve(seen, np.ones(11), "same") > 0


def _take_points(survey, road, carriageway, road_points, progress):
    """Choose one road's points; returns how many lie in each row of cells."""
    per_row = np.zeros(len(carriageway.height), np.int64)
    store = survey.store

    def take(number):
        start, end = (np.array([number, number + 1]) * store.section_length).tolist()
        # what stands beside a point may stand in the next section
        first_square, last_square = np.floor(start / OBSTACLE_SQUARE - 1.01), np.ceil(end / OBSTACLE_SQUARE + 1.01)
        points = survey.window(road, first_square * OBSTACLE_SQUARE, last_square * OBSTACLE_SQUARE)
        found = points_on_road(points, carriageway)
        beneath = covered_by_obstacles(points[found.surface], points[found.above])
        # points come in order of station
        stations = points.records["s"]
        first, last = np.searchsorted(stations, np.array([store.first_unit(number), store.first_unit(number + 1)], stations.dtype))
        own = slice(*np.searchsorted(found.surface, [first, last]))
        rows = found.surface[own]
        row = np.floor(stations.take(rows) * COORDINATE_SCALE / ROW_LENGTH).astype(np.int64) - carriageway.cells.first_row
        counts = np.bincount(np.clip(row, 0, len(per_row) - 1), minlength=len(per_row))
        return number, rows - first, dict(half_width=found.half_width[own], covered=beneath[own].astype(np.uint8)), counts

    for number, rows, columns, counts in in_order(take, store.sections(road), progress):
        road_points.store.put(road, number, rows, **columns)
        per_row += counts
    return per_row
