"""Points on a road surface of known height and limits, and points under obstacles such as parked cars, tables or bushes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from ...survey.density import CountedCubes, counted_cubes
from ...survey.store.records import COORDINATE_SCALE, Points, Seen, points_of_scanners, seen_in_section
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import StoreIndex, Stretch
from ..weights import SURFACE
from .pavement_edge import Carriageway


def covered_by_obstacles(road_points: Points, above: Points) -> np.ndarray:
    """Road points under or right beside an obstacle.

    road_points : N Points of the road
    above : Points SURFACE.min_obstacle_height to SURFACE.max_obstacle_height above it; both must reach one square farther along the road
        than the points that are asked for

    Returns (N,) bool
    """
    if not len(above) or not len(road_points):
        return np.zeros(len(road_points), bool)
    places, high_places, shape = _squares(road_points.records, above.records)
    road, high = (ndimage.uniform_filter(np.bincount(p, minlength=shape[0] * shape[1]).reshape(shape).astype(float), 3, mode="constant")
                  for p in (places, high_places))
    # counts of nine squares: rounding removes the error of the running mean
    dark = np.rint(9 * high) > SURFACE.min_obstacle_share * np.rint(9 * (road + high))
    return dark.ravel().take(places) if dark.any() else np.zeros(len(road_points), bool)


def _squares(*points):
    """(N,) int32 number of the square of each point, for several sets of points, and the (rows, columns) of all squares."""
    size = np.int32(round(SURFACE.obstacle_square / COORDINATE_SCALE))
    low = [min(int(records[name].min()) for records in points) // size - 1 for name in ("s", "d")]
    shape = tuple(max(int(records[name].max()) for records in points) // size - first + 2 for name, first in zip(("s", "d"), low))
    return *((records["s"] // size - np.int32(low[0])) * np.int32(shape[1]) + (records["d"] // size - np.int32(low[1])) for records in points), shape


def surface_about(carriageway: Carriageway, stretch: Stretch, section_length: float) -> Carriageway:
    """The rows of a carriageway that tell of the points of a stretch of it, what stands beside them, and no more. section_length : m"""
    cells, count = carriageway.cells, len(carriageway.height)
    margin = SURFACE.rows_beside * SURFACE.row_length
    low, high = stretch[1] * section_length - margin, stretch[2] * section_length + margin
    a = int(np.clip(np.floor(low / SURFACE.row_length) - cells.first_row, 0, count - 1))
    b = int(np.clip(np.ceil(high / SURFACE.row_length) - cells.first_row, a + 1, count))
    none = cells.height[:0]
    cells_of_stretch = replace(cells, first_row=cells.first_row + a, height=cells.height[a:b], rough=none, brightness=none, scatter=none, count=none)
    rows = {name: getattr(carriageway, name)[a:b] for name in ("height", "ground", "right", "left", "right_bounded", "left_bounded")}
    return replace(carriageway, cells=cells_of_stretch, grown={}, **rows)


def surface_points(road_points: RoadPoints, item: tuple[Stretch, Carriageway]
                   ) -> tuple[StoreIndex, int, np.ndarray, np.ndarray, list[tuple[CountedCubes, CountedCubes]], list[Seen]]:
    """The phase that selects the points of the road surface, section by section, and puts them into a part of the store of road points.

    item : Stretch of a road, and what `surface_about` says of it

    Returns where the points lie, the number of the first of R rows of cells, (R,) int64 points in each of them, (256,) of each scanner,
    and of each section the CountedCubes of all its points and of those on the road, and `seen_in_section` of the latter.
    """
    stretch, carriageway = item
    per_row, of_scanners, cubes, seen = np.zeros(len(carriageway.height), np.int64), [], [], []
    with road_points.store.part() as part:
        for key in road_points.survey.store.in_stretch(stretch):
            records, of_section = _points_of_section(road_points.survey, key, carriageway)
            part.put(key[0], key[1], records)
            per_row += of_section
            of_scanners.append(points_of_scanners(records))
            cubes.append((counted_cubes(road_points.survey.section(*key)), counted_cubes(Points(records))))
            seen.append(seen_in_section(records))
    return part.index(), carriageway.cells.first_row, per_row, sum(of_scanners, np.zeros(256, np.int64)), cubes, seen


def _points_of_section(survey, key, carriageway):
    """Columns of the points of the road surface in one section, and (R,) how many lie in each row of a carriageway."""
    store, (road, number) = survey.store, key
    start, end = (np.array([number, number + 1]) * store.section_length).tolist()
    # an obstacle beside a point may lie in the next section
    first_square, last_square = np.floor(start / SURFACE.obstacle_square - 1.01), np.ceil(end / SURFACE.obstacle_square + 1.01)
    points = survey.window(road, first_square * SURFACE.obstacle_square, last_square * SURFACE.obstacle_square)
    on_road = points_on_road(points, carriageway)
    beneath = covered_by_obstacles(points[on_road.surface], points[on_road.above])
    # points are sorted by station
    stations = points.records["s"]
    first, last = np.searchsorted(stations, np.array([store.first_unit(number), store.first_unit(number + 1)], stations.dtype))
    of_section = slice(*np.searchsorted(on_road.surface, [first, last]))
    rows, count = on_road.surface[of_section], len(carriageway.height)
    row = np.floor(stations.take(rows) * COORDINATE_SCALE / SURFACE.row_length).astype(np.int64) - carriageway.cells.first_row
    records = points.records.take(rows).with_columns(half_width=on_road.half_width[of_section], covered=beneath[of_section].astype(np.uint8))
    return records, np.bincount(np.clip(row, 0, count - 1), minlength=count)


@dataclass(frozen=True)
class _OnRoad:
    """Points of a window by their index."""

    surface: np.ndarray   # (M,) int, points of the road surface
    half_width: np.ndarray   # (M,) uint16 mm, from the reference line to the limit of the road on the side of each point
    above: np.ndarray   # (K,) int, points SURFACE.min_obstacle_height to SURFACE.max_obstacle_height above the surface


def points_on_road(points: Points, carriageway: Carriageway) -> _OnRoad:
    """The points of a window that lie on the road or stand above it.

    Limits are interpolated linearly between the middles of rows; beside a row without road those of the nearer row are
    used. Heights are bilinear between the middles of cells.

    Returns _OnRoad

    Single precision is enough: lengths are in units of 0.1 mm and count from a corner of each cell, so that the rounding
    is below the resolution of the coordinates. The result does not depend on the window.
    """
    records = points.records
    if not len(records):
        return _OnRoad(np.empty(0, np.intp), np.empty(0, np.uint16), np.empty(0, np.intp))
    tables = _SurfaceTables(carriageway, records["s"], records["d"])
    parts = []
    for first in range(0, len(records), SURFACE.ground_points_per_batch):
        indices = tables.points(*(records[name][first:first + SURFACE.ground_points_per_batch] for name in ("s", "d", "z")))
        parts.append((indices[0] + first, indices[1], indices[2] + first))
    return _OnRoad(*(np.concatenate(part) for part in zip(*parts)))


class _SurfaceTables:
    """Limits of half rows and heights of cells about a window, as tables."""

    def __init__(self, carriageway, s, d):
        cells = carriageway.cells
        # as many rows and columns as the points need; beyond the outermost cells height and limits are constant
        (self.s0, rows), (self.d0, columns) = (
            _middles(values, size, first, count) for values, size, first, count in
            ((s, SURFACE.row_length, cells.first_row, cells.height.shape[0]), (d, SURFACE.column_width, cells.first_column, cells.height.shape[1])))
        height = carriageway.height[np.ix_(rows, columns)].astype(float) / COORDINATE_SCALE
        self.columns = len(columns) - 1
        self.left, self.right = (_half_rows(limit[rows] / COORDINATE_SCALE) for limit in (carriageway.left, carriageway.right))
        across = np.diff(height, axis=1)
        self.corner = np.rint(height[:-1, :-1]).astype(np.int32).ravel()
        # height = corner + rest + across * v + (along + twist * v) * u, with u, v from 0 to 1 in the cell
        self.tables = [table.astype(np.float32).ravel() for table in (height[:-1, :-1] - np.rint(height[:-1, :-1]), across[:-1],
                                                                      np.diff(height, axis=0)[:, :-1], np.diff(across, axis=0))]
        self.tolerance, self.low, self.high = (np.float32(metres / COORDINATE_SCALE) for metres in
                                               (carriageway.tolerance, SURFACE.min_obstacle_height, SURFACE.max_obstacle_height))

    def points(self, s, d, z):
        """Indices of the points on the road, their half widths (mm), and indices of the points above it."""
        row, u = _steps(s, self.s0, SURFACE.row_length)
        half = row + row
        half += u >= np.float32(0.5)
        left, right = (_line(*limit, half, u) for limit in (self.left, self.right))
        across = d.astype(np.float32)
        inside = np.flatnonzero((across < left) & (across > right))
        row, u, d, z = (values.take(inside) for values in (row, u, d, z))
        cell, v = _steps(d, self.d0, SURFACE.column_width)
        row *= np.int32(self.columns)
        cell += row
        surface, across, along, twist = (table.take(cell, mode="clip") for table in self.tables)
        twist *= v
        along += twist
        along *= u
        across *= v
        surface += across
        surface += along
        rise = z - self.corner.take(cell, mode="clip")
        rise = rise - surface
        on_road = np.flatnonzero(np.abs(rise) < self.tolerance)
        rows = inside.take(on_road)
        width = np.where(d.take(on_road) >= 0, left.take(rows), -right.take(rows))
        width *= np.float32(COORDINATE_SCALE * 1e3)
        width += np.float32(0.5)
        np.minimum(width, np.float32(65535), out=width)
        return rows, width.astype(np.uint16), inside[(rise > self.low) & (rise < self.high)]


def _middles(units, size, first, count):
    """First of the middles of cells about some places, in units of 0.1 mm, and the index of the cell of each middle."""
    low, high = (int(np.floor(int(end) * COORDINATE_SCALE / size - 0.5)) for end in (units.min(), units.max()))
    return int(round((low + 0.5) * size / COORDINATE_SCALE)), np.clip(np.arange(low, high + 2) - first, 0, count - 1)


def _steps(units, first, size):
    """Number of the step of `size` metres that each place lies in, from `first`, and the share of it, (N,) int32 and float32."""
    size = np.int32(round(size / COORDINATE_SCALE))
    distance = units - np.int32(first)
    step = distance // size
    distance -= step * size
    return step, distance * np.float32(1.0 / size)


def _line(start, slope, half, u):
    """Values in half rows, (N,) float32."""
    values = slope.take(half, mode="clip")
    values *= u
    values += start.take(half, mode="clip")
    return values


def _half_rows(limit):
    """(start, slope) of a limit in each half row, (2 (R - 1),) float32 each: start + slope * u with u from 0 to 1 between rows."""
    before, after = limit[:-1], limit[1:]
    complete = np.isfinite(before) & np.isfinite(after)
    slope = np.where(complete, after - before, 0.0)
    start = np.stack([before, np.where(complete, before, after)], axis=1)
    return start.ravel().astype(np.float32), np.repeat(slope, 2).astype(np.float32)
