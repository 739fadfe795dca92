"""Markings as arrays, which stages hand each other and which the layer MARKINGS holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely

from ...common.features import MARKINGS, Features
from ...common.layer_rows import LayerRows, column
from ...survey.frame.placement import located
from ...survey.frame.road_frame import RoadFrame


@dataclass(frozen=True)
class Outlines:
    """Outlines of M markings: polygons, stored vertex by vertex."""

    vertices: np.ndarray   # (V, 3) local metres (map coordinates less the origin of the frame); z is NaN where there is none
    ring_start: np.ndarray   # (R + 1,) int, first vertex of each ring, and V. Rings are closed
    polygon_start: np.ndarray   # (P + 1,) int, first ring of each polygon, and R. The first ring is the outer one
    marking_start: np.ndarray   # (M + 1,) int, first polygon of each marking, and P

    @classmethod
    def of(cls, polygons: Sequence[Any]) -> Outlines:
        """Outlines of shapely polygons or multipolygons in local coordinates; None stands for an empty one."""
        parts, owner = shapely.get_parts(np.array(polygons, object), return_index=True)
        drawn = ~shapely.is_empty(parts)
        parts, owner = parts[drawn], owner[drawn]
        marking_start = np.append(0, np.cumsum(np.bincount(owner, minlength=len(polygons))))
        if not len(parts):
            return cls(np.empty((0, 3)), np.zeros(1, np.int64), np.zeros(1, np.int64), marking_start)
        _, vertices, (ring_start, polygon_start) = shapely.to_ragged_array(parts, include_z=True)
        return cls(vertices, ring_start.astype(np.int64), polygon_start.astype(np.int64), marking_start)

    def __len__(self) -> int:
        return len(self.marking_start) - 1

    def __getitem__(self, rows: np.ndarray) -> Outlines:
        """Those of some of the markings, by a mask or their numbers."""
        return Outlines.of(self.polygons()[rows])

    @property
    def owner(self) -> np.ndarray:
        """(V,) int, the marking of each vertex."""
        first = self.ring_start[self.polygon_start[self.marking_start]]
        return np.repeat(np.arange(len(self)), np.diff(first))

    def polygons(self, origin: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0)) -> np.ndarray:
        """(M,) shapely polygons, multipolygons where a marking has several parts, empty where it has none; `origin` is added to the coordinates."""
        shapes = np.full(len(self), shapely.Polygon(), object)
        if not len(self.vertices):
            return shapes
        parts = shapely.from_ragged_array(shapely.GeometryType.POLYGON, self.vertices + np.asarray(origin), (self.ring_start, self.polygon_start))
        count = np.diff(self.marking_start)
        shapes[count == 1] = parts[self.marking_start[:-1][count == 1]]
        for k in np.flatnonzero(count > 1).tolist():
            shapes[k] = shapely.multipolygons(parts[self.marking_start[k]:self.marking_start[k + 1]])
        return shapes


@dataclass(frozen=True)
class MarkingObjects(LayerRows):
    """M markings in the road frame. A marking that wear or a shadow cut into parts has several elements of one `cluster`.

    station, offset : (M,) metres, where it begins and its median offset; NaN where unknown, like all numbers below
    """

    GEOMETRY_TYPE, SCHEMA = "PolygonZ", MARKINGS

    road: np.ndarray = field(metadata=column(unknown=-1))   # (M,) int, number of the road; -1 where unknown
    cluster: np.ndarray = field(metadata=column(unknown=-1))   # (M,) int, number of the marking; -1 where unknown
    kind: np.ndarray = field(metadata=column("class", unknown=""))   # (M,) str objects, the class: edge, lane, centre, zebra, stop, hatch and more
    keep: np.ndarray   # (M,) bool, True for what may be part of a marking line (`use` is keep)
    station: np.ndarray = field(metadata=column("station_m"))
    offset: np.ndarray = field(metadata=column("offset_m"))
    length: np.ndarray = field(metadata=column("length_m"))   # (M,) metres
    width: np.ndarray = field(metadata=column("width_m"))
    elongation: np.ndarray = field(metadata=column())   # (M,) length by width
    scan_distance: np.ndarray = field(metadata=column("scan_m"))   # (M,) metres across the road from the track that scanned it
    points: np.ndarray = field(metadata=column(unknown=np.nan))   # (M,) float, number of paint points
    extent: np.ndarray   # (M, 4) metres, first and last station, least and greatest offset of the outline; NaN off the road
    outlines: Outlines   # Outlines of the M markings
    crs: str = ""   # WKT, "" where unknown

    def on_map(self, frame: RoadFrame) -> np.ndarray:
        """(M,) polygons with Z in map coordinates."""
        return self.outlines.polygons(frame.origin)

    def derived(self, frame: RoadFrame) -> dict[str, Any]:
        """What it may be part of, and its area."""
        return dict(use=np.where(self.keep, "keep", "other"), area_m2=shapely.area(self.on_map(frame)))

    @staticmethod
    def from_features(features: Features, frame: RoadFrame) -> MarkingObjects:
        """The markings of a layer MARKINGS, polygons in map coordinates, one element a row in the same order; fields may be missing."""
        local = [None if shape is None else shapely.transform(shape, lambda places: places - frame.origin[:places.shape[1]], include_z=shape.has_z)
                 for shape in features.geometries]
        return make_marking_objects(features.rows, local, frame, features.crs)


def make_marking_objects(rows: Sequence[dict[str, Any]], polygons: Sequence[Any], frame: RoadFrame, crs: str = "") -> MarkingObjects:
    """MarkingObjects of M rows with the fields of MARKINGS, and of their outlines in local coordinates, polygons or None.

    `road` -1, `cluster` -1, `class` "" and NaN stand for what is missing in a row.
    """
    columns, outlines = MarkingObjects.read_columns(rows), Outlines.of(polygons)
    keep = np.array([row.get("use") == "keep" for row in rows], bool)
    return MarkingObjects(**columns, keep=keep, extent=_extents(outlines, columns["road"], frame), outlines=outlines, crs=crs)


def _extents(outlines: Outlines, road: np.ndarray, frame: RoadFrame) -> np.ndarray:
    """(M, 4) first and last station, least and greatest offset of each outline."""
    owner = outlines.owner
    s, d = located(frame, road[owner], outlines.vertices[:, 0], outlines.vertices[:, 1])
    finite = np.isfinite(s)
    s, d, owner = s[finite], d[finite], owner[finite]
    extents = np.full((len(outlines), 4), np.nan)
    if len(owner):
        starts = np.flatnonzero(np.r_[True, np.diff(owner) != 0])
        extents[owner[starts]] = np.stack([end.reduceat(values, starts) for values in (s, d) for end in (np.minimum, np.maximum)], axis=1)
    return extents


def with_kinds_of(features: Features, markings: MarkingObjects, frame: RoadFrame) -> Features:
    """A layer MARKINGS with the classes of the MarkingObjects read from it; geometries and all other fields stay as they are.

    Markings behind those that were read, which their lines have added, come behind them.
    """
    rows = [row if (row.get("class") or "") == kind else {**row, "class": kind} for row, kind in zip(features.rows, markings.kind.tolist())]
    more = markings[len(rows):].to_features(frame)
    return Features(features.geometry_type, features.schema, [*features.geometries, *more.geometries], rows + more.rows, features.crs)
