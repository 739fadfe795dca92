"""Nearest points on lines, and places along them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely

from ..common.arrays import Rows
from ..common.parallel import check_cancelled
from ..common.progress import Progress
from .weights import FITS

QUERY_BATCH = 20_000       # cost: points queried at a time: each may have many neighbours


def single_lines(geometries: Sequence[Any]) -> tuple[list[shapely.LineString], np.ndarray]:
    """The lines of any mix of geometries: parts of multi-lines and outlines of polygons, without those of no length.

    Returns
        lines : list of LineString
        owner : (N,) index of the geometry each line comes from
    """
    shapes = np.asarray(geometries, object)
    parts, owner = shapely.get_parts(shapes, return_index=True) if len(shapes) else (shapes, np.empty(0, int))
    is_area = shapely.get_type_id(parts) == shapely.GeometryType.POLYGON
    parts[is_area] = shapely.get_exterior_ring(parts[is_area])
    is_line = np.isin(shapely.get_type_id(parts), (shapely.GeometryType.LINESTRING, shapely.GeometryType.LINEARRING))
    valid = is_line & (shapely.length(parts) > 0)
    return list(parts[valid]), owner[valid]


@dataclass(frozen=True)
class NearestPoints(Rows):
    """The nearest points on some lines of N points; distance inf and the rest NaN or -1 if there is none."""

    distance: np.ndarray   # (N,) metres
    side: np.ndarray   # (N,) +1 if the point lies left of the line as drawn, -1 right of it
    xy: np.ndarray   # (N, 2) the nearest point, metres
    z: np.ndarray   # (N,) its height, metres
    line: np.ndarray   # (N,) index of its line
    station: np.ndarray   # (N,) metres along that line


class SegmentIndex:
    """Spatial index of the straight segments of LineStrings."""

    def __init__(self, lines: Sequence[shapely.LineString]) -> None:
        points, owner = shapely.get_coordinates(np.asarray(lines, object), include_z=True, return_index=True)
        run = np.hypot(*np.diff(points[:, :2], axis=0).T)
        along = np.r_[0.0, np.cumsum(run)]
        segments = np.flatnonzero((owner[1:] == owner[:-1]) & (run > 0))
        begins, ends = (np.searchsorted(owner, np.arange(len(lines)), side=side) for side in ("left", "right"))
        self.a, self.b, self.line = points[segments], points[segments + 1], owner[segments]
        self.length = run[segments]
        self.start = along[segments] - along[begins[self.line]]
        self._along, self._line_start = along[segments], along[begins]
        self._line_length = along[ends - 1] - self._line_start

    @cached_property
    def _tree(self):
        return shapely.STRtree(shapely.linestrings(np.stack([self.a[:, :2], self.b[:, :2]], axis=1)))

    @cached_property
    def _heading(self):
        return self.heading_at(self.line, self.start + self.length / 2)

    def at(self, line: np.ndarray, station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(xy (N, 2), z (N,)) at stations, metres, along the lines of these indices."""
        k = np.clip(np.searchsorted(self._along, self._line_start[line] + station, side="right") - 1, 0, len(self.a) - 1)
        share = np.clip((station - self.start[k]) / self.length[k], 0.0, 1.0)[:, None]
        spot = self.a[k] + share * (self.b[k] - self.a[k])
        return spot[:, :2], spot[:, 2]

    def heading_at(self, line: np.ndarray, station: np.ndarray) -> np.ndarray:
        """(N,) directions of the lines there, radians, over `FITS.heading_base` metres behind and ahead."""
        behind, ahead = np.maximum(station - FITS.heading_base, 0.0), np.minimum(station + FITS.heading_base, self._line_length[line])
        step = self.at(line, ahead)[0] - self.at(line, behind)[0]
        return np.arctan2(step[:, 1], step[:, 0])

    def nearest(self, xy: np.ndarray, heading: np.ndarray | None = None, max_angle: float | None = None, reach: float = np.inf,
                progress: Progress = Progress()) -> NearestPoints:
        """Nearest points on the lines.

        xy : (N, 2) metres
        heading : (N,) radians; only with `max_angle`
        max_angle : radians; only segments within this angle of `heading`, in either direction, count; None: all
        reach : metres; only with `max_angle`

        Returns NearestPoints
        """
        if not len(self.a) or not len(xy):
            return _no_nearest_points(len(xy))
        parts = []
        for k in range(0, len(xy), QUERY_BATCH):
            progress.report(k / len(xy))
            check_cancelled()
            rows = slice(k, k + QUERY_BATCH)
            if max_angle is None:
                pairs = self._tree.query_nearest(shapely.points(xy[rows]), all_matches=False)
            else:
                pairs = self._parallel(xy[rows], np.asarray(heading)[rows], max_angle, reach)
            parts.append(self._nearest_points(xy[rows], *pairs))
        return NearestPoints.join(parts)

    def _parallel(self, xy, heading, max_angle, reach):
        """(point, segment) pairs: of the segments within reach that run the same way, the nearest."""
        point, segment = self._tree.query(shapely.points(xy), predicate="dwithin", distance=reach)
        turned = np.abs((heading[point] - self._heading[segment] + np.pi / 2) % np.pi - np.pi / 2)
        point, segment = point[turned <= max_angle], segment[turned <= max_angle]
        order = np.lexsort((segment, self._project(xy[point], segment)[2], point))
        first = order[np.unique(point[order], return_index=True)[1]]
        return point[first], segment[first]

    def _project(self, xy, segment):
        a, b = self.a[segment], self.b[segment]
        step = b - a
        share = np.clip(((xy - a[:, :2]) * step[:, :2]).sum(axis=1) / self.length[segment]**2, 0.0, 1.0)
        nearest_xyz = a + share[:, None] * step
        off = xy - nearest_xyz[:, :2]
        return nearest_xyz, share, np.hypot(off[:, 0], off[:, 1])

    def _nearest_points(self, xy, point, segment):
        result = _no_nearest_points(len(xy))
        nearest_xyz, share, distance = self._project(xy[point], segment)
        step, off = (self.b - self.a)[segment], xy[point] - self.a[segment, :2]
        result.distance[point] = distance
        result.side[point] = np.where(step[:, 0] * off[:, 1] - step[:, 1] * off[:, 0] >= 0, 1.0, -1.0)
        result.xy[point], result.z[point] = nearest_xyz[:, :2], nearest_xyz[:, 2]
        result.line[point] = self.line[segment]
        result.station[point] = self.start[segment] + share * self.length[segment]
        return result


def _no_nearest_points(count):
    return NearestPoints(np.full(count, np.inf), np.full(count, np.nan), np.full((count, 2), np.nan), np.full(count, np.nan),
                np.full(count, -1), np.full(count, np.nan))
