"""Markings as arrays, and their conversion from and to the layer MARKINGS."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import shapely

from ...common.features import MARKINGS, Features
from ...survey.frame.placement import located
from ...survey.frame.road_frame import RoadFrame


@dataclass(frozen=True)
class Outlines:
    """Outlines of M markings: polygons, stored vertex by vertex.

    vertices : (V, 3) local metres (map coordinates less the origin of the frame); z is NaN where there is none
    ring_start : (R + 1,) int, first vertex of each ring, and V. Rings are closed
    polygon_start : (P + 1,) int, first ring of each polygon, and R. The first ring is the outer one
    marking_start : (M + 1,) int, first polygon of each marking, and P
    """

    vertices: np.ndarray
    ring_start: np.ndarray
    polygon_start: np.ndarray
    marking_start: np.ndarray

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
class MarkingObjects:
    """M markings in the road frame. A marking that wear or a shadow cut into parts has several elements of one `cluster`.

    road : (M,) int, number of the road; -1 where unknown
    cluster : (M,) int, number of the marking; -1 where unknown
    kind : (M,) str objects, the class: edge, lane, centre, zebra, stop, hatch, ...
    keep : (M,) bool, True for what may be part of a marking line (`use` is keep)
    station, offset : (M,) metres, where it begins and its median offset; NaN where unknown, like all numbers below
    length, width : (M,) metres
    elongation : (M,) length by width
    scan_distance : (M,) metres across the road from the track that scanned it
    points : (M,) float, number of paint points
    extent : (M, 4) metres, first and last station, least and greatest offset of the outline; NaN off the road
    outlines : Outlines of the M markings
    crs : WKT, "" where unknown
    """

    road: np.ndarray
    cluster: np.ndarray
    kind: np.ndarray
    keep: np.ndarray
    station: np.ndarray
    offset: np.ndarray
    length: np.ndarray
    width: np.ndarray
    elongation: np.ndarray
    scan_distance: np.ndarray
    points: np.ndarray
    extent: np.ndarray
    outlines: Outlines
    crs: str = ""

    def __len__(self) -> int:
        return len(self.road)

    def with_kinds(self, kind: np.ndarray) -> MarkingObjects:
        """The same markings with other classes, (M,) str objects."""
        return replace(self, kind=kind)

    def take(self, rows: np.ndarray) -> MarkingObjects:
        """Some of the markings, by their numbers."""
        own = [one.name for one in fields(self) if one.name not in ("outlines", "crs")]
        return replace(self, **{name: getattr(self, name)[rows] for name in own}, outlines=Outlines.of(self.outlines.polygons()[rows]))


# Fields of the layer that hold one number each, by the attribute of MarkingObjects
NUMBER_FIELDS = dict(station="station_m", offset="offset_m", length="length_m", width="width_m", elongation="elongation",
               scan_distance="scan_m", points="points")


def make_marking_objects(rows: Sequence[dict[str, Any]], polygons: Sequence[Any], frame: RoadFrame, crs: str = "") -> MarkingObjects:
    """MarkingObjects of rows with the fields of MARKINGS and of their outlines.

    Parameters
    ----------
    rows : M dicts of field name to value; `road` -1, `cluster` -1, `class` "" and NaN stand for what is missing
    polygons : M shapely polygons or multipolygons in local coordinates, None where there is none
    crs : WKT
    """
    def column(name: str, missing: Any, kind: Any) -> np.ndarray:
        return np.array([missing if row.get(name) is None else row[name] for row in rows], kind)

    road, outlines = column("road", -1, int), Outlines.of(polygons)
    numbers = {attribute: column(name, np.nan, float) for attribute, name in NUMBER_FIELDS.items()}
    return MarkingObjects(road=road, cluster=column("cluster", -1, int), kind=column("class", "", object),
                          keep=column("use", "", object) == "keep", extent=_extents(outlines, road, frame), outlines=outlines, crs=crs, **numbers)


def _extents(outlines: Outlines, road: np.ndarray, frame: RoadFrame) -> np.ndarray:
    """(M, 4) first and last station, least and greatest offset of each outline."""
    owner = outlines.owner
    s, d = located(frame, road[owner], outlines.vertices[:, 0], outlines.vertices[:, 1])
    known = np.isfinite(s)
    s, d, owner = s[known], d[known], owner[known]
    found = np.full((len(outlines), 4), np.nan)
    if len(owner):
        starts = np.flatnonzero(np.r_[True, np.diff(owner) != 0])
        found[owner[starts]] = np.stack([end.reduceat(values, starts) for values in (s, d) for end in (np.minimum, np.maximum)], axis=1)
    return found


def markings_to_features(markings: MarkingObjects, frame: RoadFrame) -> Features:
    """The layer MARKINGS: polygons in map coordinates with their fields.

    Parameters
    ----------
    frame : RoadFrame, whose origin is added to local coordinates

    Returns
    -------
    Features MARKINGS, one row an element, in the same order
    """
    shapes = markings.outlines.polygons(frame.origin)
    return Features("PolygonZ", MARKINGS, list(shapes), _rows(markings, shapes), markings.crs)


def _rows(markings, shapes):
    """The fields of markings, of which the polygons are given, too."""
    numbers = {name: getattr(markings, attribute).tolist() for attribute, name in NUMBER_FIELDS.items()}
    rows = [dict(road=road, cluster=cluster, use="keep" if keep else "other", area_m2=area, **{"class": kind})
            for road, cluster, keep, kind, area in zip(markings.road.tolist(), markings.cluster.tolist(), markings.keep.tolist(),
                                                       markings.kind.tolist(), shapely.area(shapes).tolist())]
    for k, row in enumerate(rows):
        row.update((name, None if np.isnan(values[k]) else values[k]) for name, values in numbers.items())
        row["points"] = None if row["points"] is None else int(row["points"])
    return rows


def markings_from_features(features: Features, frame: RoadFrame) -> MarkingObjects:
    """Read the layer MARKINGS.

    Parameters
    ----------
    features : Features with polygons in map coordinates; fields may be missing

    Returns
    -------
    MarkingObjects, one element a row, in the same order
    """
    local = [None if shape is None else shapely.transform(shape, lambda places: places - frame.origin[:places.shape[1]], include_z=shape.has_z)
             for shape in features.geometries]
    return make_marking_objects(features.rows, local, frame, features.crs)


def with_kinds_of(features: Features, markings: MarkingObjects) -> Features:
    """A layer MARKINGS with the classes of the MarkingObjects read from it; geometries and all other fields stay as they are.

    Markings behind those that were read, which their lines have added, come behind them.
    """
    rows = [row if (row.get("class") or "") == kind else {**row, "class": kind} for row, kind in zip(features.rows, markings.kind.tolist())]
    shapes = list(features.geometries)
    if len(markings) > len(rows):
        more = markings.take(np.arange(len(rows), len(markings)))
        added = more.outlines.polygons(_origin(shapes, markings.outlines))
        shapes, rows = shapes + list(added), rows + _rows(more, added)
    return Features(features.geometry_type, features.schema, shapes, rows, features.crs)


def _origin(shapes, outlines):
    """What lies between the outlines of markings and the map that they were read from: whole metres."""
    k = int(np.flatnonzero(np.diff(outlines.marking_start))[0])
    vertex = outlines.vertices[outlines.ring_start[outlines.polygon_start[outlines.marking_start[k]]]]
    return np.rint(shapely.get_coordinates(shapes[k], include_z=True)[0] - vertex)
