"""The outline of the road surface as polygons in the road frame, which the layer ROAD_SURFACE holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ...common.arrays import mask_runs
from ...common.features import ROAD_SURFACE
from ...common.layer_rows import LayerRows, column
from ...common.parallel import check_cancelled
from ...survey.frame.placement import COORDINATE_DECIMALS
from ...survey.frame.road_frame import RoadFrame
from ...survey.weights import FRAME
from ..weights import SURFACE
from .pavement_edge import Carriageway


@dataclass(frozen=True)
class SurfaceOutlines(LayerRows):
    """S stretches of road surface, each of one status."""

    GEOMETRY_TYPE, SCHEMA = "PolygonZ", ROAD_SURFACE

    road: np.ndarray = field(metadata=column())   # (S,) int
    status: np.ndarray = field(metadata=column())   # (S,) str objects: measured where both sides have a measured or bridged edge, else grown
    station: np.ndarray = field(metadata=column("station_m"))   # station, end: (S,) metres along the road
    end: np.ndarray = field(metadata=column("end_m"))
    area: np.ndarray = field(metadata=column("area_m2"))   # (S,) square metres
    points: np.ndarray = field(metadata=column())   # (S,) int, road points
    outline: np.ndarray   # (S,) shapely polygons with Z in local metres, as the layer holds them; consecutive ones share two vertices
    crs: str = ""   # WKT, "" where unknown
    thin: str = ""   # where no curb was found and the points are too few for one, as a user is told; "" where there is no such place

    @staticmethod
    def of_rows(rows: Sequence[Sequence[Any]], crs: str = "", thin: str = "") -> SurfaceOutlines:
        """Stretches from their values in the order of the attributes."""
        names = SurfaceOutlines.names()
        columns: dict[str, Any] = dict(zip(names, map(SurfaceOutlines.array_of, names, zip(*rows) if rows else [()] * len(names))))
        return SurfaceOutlines(**columns, crs=crs, thin=thin)

    def on_map(self, frame: RoadFrame) -> np.ndarray:
        """(S,) shapely polygons with Z in map coordinates."""
        return shapely.transform(self.outline, lambda places: np.round(places + frame.origin, COORDINATE_DECIMALS), include_z=True)


# Outlines of the road surface: one polygon for each stretch of one status.


def outlines(frame: RoadFrame, road: int, carriageway: Carriageway, points_per_row: np.ndarray) -> list[tuple]:
    """The stretches of one road; consecutive ones share two vertices.

    carriageway : Carriageway with R rows
    points_per_row : (R,) int, points of the surface in each row

    Returns a list of rows of a SurfaceOutlines: road, status, station, end, area, points and outline
    """
    result = []
    cells = carriageway.cells
    has_road = _as_far_as_measured(np.isfinite(carriageway.left) & np.isfinite(carriageway.right), points_per_row)
    measured = _without_short_runs(carriageway.left_bounded & carriageway.right_bounded, int(SURFACE.min_surface_status_length / SURFACE.row_length))
    kind = np.where(has_road, np.where(measured, 2, 1), 0)
    cuts = np.r_[0, np.flatnonzero(np.diff(kind)) + 1, len(kind)]
    for a, b in zip(cuts[:-1], cuts[1:]):
        if not kind[a]:
            continue
        # the next stretch begins with the last vertices of this one
        rows = np.arange(a, b + 1 if b < len(kind) and kind[b] else b)
        polygon = max(_polygons(_outline(frame, road, carriageway, rows)), key=shapely.area, default=None) if len(rows) > 1 else None
        if polygon is None:
            continue
        local = shapely.transform(polygon, lambda places: places - frame.origin, include_z=True)
        station, end = (round(float(cells.stations[row]), 3) for row in rows[[0, -1]])
        status, area = "measured" if kind[a] == 2 else "grown", round(float(polygon.area), 3)
        result.append((road, status, station, end, area, int(points_per_row[a:b].sum()), local))
    return result


def without_overlaps(frame: RoadFrame, stretches: Sequence[tuple]) -> list[tuple]:
    """The stretches of all roads, as `outlines` gives them, where each place of the ground is in one of them.

    What two roads share on one level is of the stretch with edges on both sides, else of the road that was driven nearer. A stretch may fall into
    parts; its points divide as its area does. What is narrower than SURFACE.min_surface_width is left out.
    """
    whole = np.array([row[-1] for row in stretches], object)
    rest = whole.copy()
    for i, j in sorted(zip(*shapely.STRtree(whole).query(whole, predicate="intersects").tolist())):
        check_cancelled()
        if i >= j or stretches[i][0] == stretches[j][0]:
            continue
        for part in _polygons(shapely.intersection(rest[i], rest[j])):
            (height, *claim), (other_height, *other_claim) = _claim(frame, stretches[i], part), _claim(frame, stretches[j], part)
            if abs(height - other_height) < FRAME.level_separation:
                loser = i if claim > other_claim else j
                rest[loser] = shapely.MultiPolygon(_polygons(shapely.difference(rest[loser], part)))   # without lines that remain of a rim
    return [row for stretch, left in zip(stretches, rest) for row in _parts(frame, stretch, left)]


def _claim(frame, stretch, part):
    """Height of the track beside a part of a stretch, m, and what puts the stretch behind another one: whether it is grown, m to its drive."""
    (s,), (d,) = frame.road(stretch[0]).locate(*shapely.get_coordinates(part.representative_point()).T)
    return frame.track_height(stretch[0], np.array([s]))[0], stretch[1] == "grown", abs(d)


def _parts(frame, stretch, left):
    """A row for each part that is left of a stretch."""
    road, status, start, end, area, points, whole = stretch
    if left is whole:
        return [stretch]
    places, half = shapely.get_coordinates(left, include_z=True), SURFACE.min_surface_width / 2
    vertices, result = cKDTree(places[:, :2]), []
    wide = shapely.buffer(shapely.buffer(left, -half), 2 * half)
    # on the grid of the layer, so that its rounding leaves the parts valid
    for part in _polygons(shapely.intersection(left, wide, grid_size=10.0 ** -COORDINATE_DECIMALS)):
        if shapely.buffer(part, -half).is_empty:
            continue
        part = shapely.transform(part, lambda xyz: np.c_[xyz[:, :2], places[vertices.query(xyz[:, :2])[1], 2]], include_z=True)
        s, _ = frame.road(road).locate(*shapely.get_coordinates(part).T)
        first, last = np.round([np.fmax(np.fmin.reduce(s), start), np.fmin(np.fmax.reduce(s), end)], 3).tolist()
        result.append((road, status, first, last, round(part.area, 3), round(points * part.area / area), part))
    return result


def _outline(frame, road, carriageway, rows):
    """The outline of some rows in map coordinates, in parts where it crosses itself."""
    cells, sides = carriageway.cells, []
    for offset in (carriageway.left[rows], carriageway.right[rows]):
        column = np.clip(np.floor(offset / SURFACE.column_width).astype(int) - cells.first_column, 0, cells.height.shape[1] - 1)
        sides.append(np.c_[frame.to_map(road, cells.stations[rows], offset, carriageway.height[rows, column].astype(float))])
    polygon = shapely.Polygon(np.round(np.concatenate([sides[0], sides[1][::-1]]), COORDINATE_DECIMALS))
    return polygon if polygon.is_valid else shapely.make_valid(polygon)


def _as_far_as_measured(there, points):
    """The rows of road from the first to the last one with points: the limits of a few rows before and behind them are known as well."""
    measured = np.zeros(len(there), bool)
    for a, b in mask_runs(there):
        filled = a + np.flatnonzero(points[a:b])
        measured[filled.min(initial=b):filled.max(initial=a - 1) + 1] = True
    return measured


def _without_short_runs(mask, shortest):
    """The mask with runs of fewer than `shortest` rows changed to the value around them, True runs first."""
    mask = mask.copy()
    for value in (True, False):
        for a, b in mask_runs(mask == value):
            if b - a < shortest and (a > 0 or b < len(mask)):
                mask[a:b] = not value
    return mask


def _polygons(geometry):
    """The polygons that a geometry consists of."""
    return [part for part in shapely.get_parts(shapely.get_parts(geometry)) if part.area]
