"""Lanes, driving lines and curve elements as arrays, and their layers in map coordinates."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ..common.errors import RoadExtractionError
from ..common.features import CURVE_ELEMENTS, DRIVING_LINES, LANES, Features
from ..countries.catalogue import country
from ..countries.neutral import NEUTRAL
from ..curves.base import Arc, Curve
from ..survey.frame.road_frame import RoadFrame
from .alignment import element_row

LANE_TYPES = ("driving", "shoulder", "parking", "bicycle", "hatched", "median", "connector")
LEVEL_ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Lanes:
    """Lanes in P pieces. Left and right are seen in the direction of travel, along the road where nobody drives.

    road, lane : (P,) int; lanes of a road are numbered from 1
    lane_id : (P,) str objects, "road.lane.piece", each once
    type : (P,) str objects, one of LANE_TYPES
    direction : (P,) int, 1 along the road's reference line, -1 against it, 0 where nobody drives
    left_line, right_line : (P,) str objects, what the border is: "line 12" by `line` of the marking lines, "edge 3" by
        `chain` of the road edges, or "none"
    left_kind, right_kind : (P,) str objects, edge, lane, centre, curb, pavement, hatch or none
    left_pattern, right_pattern : (P,) str objects, as in DRIVING_LINES, "" where there is none
    successors : P tuples of lane_ids, what follows in the direction of travel
    status : (P,) str objects, measured, inferred or bridged
    confidence : (P,) float, 0 to 1
    station, end : (P,) metres along the road
    left, right : (V, 3) local metres, the borders in the direction of travel, piece after piece, cut at the same places
    start : (P + 1,) int, first vertex of each piece, and V
    crs : WKT, "" where unknown
    other : (P,) str objects, the second reading as JSON, as of DrivingLines
    """

    road: np.ndarray
    lane: np.ndarray
    lane_id: np.ndarray
    type: np.ndarray
    direction: np.ndarray
    left_line: np.ndarray
    right_line: np.ndarray
    left_kind: np.ndarray
    right_kind: np.ndarray
    left_pattern: np.ndarray
    right_pattern: np.ndarray
    successors: list[tuple[str, ...]]
    status: np.ndarray
    confidence: np.ndarray
    station: np.ndarray
    end: np.ndarray
    left: np.ndarray
    right: np.ndarray
    start: np.ndarray
    crs: str = ""
    other: np.ndarray = None  # type: ignore[assignment]  # filled on construction

    def __post_init__(self) -> None:
        if self.other is None:
            object.__setattr__(self, "other", np.full(len(self.road), "", object))

    def __len__(self) -> int:
        return len(self.road)

    def borders(self, piece: int) -> tuple[np.ndarray, np.ndarray]:
        """(left, right) of one piece, each (n, 3), in the direction of travel."""
        rows = slice(self.start[piece], self.start[piece + 1])
        return self.left[rows], self.right[rows]

    @property
    def width(self) -> np.ndarray:
        """(P,) metres, median in plan between the borders."""
        across = np.hypot(*(self.left - self.right)[:, :2].T)
        return np.array([np.median(across[a:b]) for a, b in zip(self.start[:-1], self.start[1:])])

    @property
    def length(self) -> np.ndarray:
        """(P,) metres in plan along the middle."""
        middle = (self.left + self.right)[:, :2] / 2
        return np.array([np.hypot(*np.diff(middle[a:b], axis=0).T).sum() for a, b in zip(self.start[:-1], self.start[1:])])


def lanes_to_features(lanes: Lanes, origin: Any = LEVEL_ORIGIN) -> Features:
    """The layer LANES in map coordinates.

    Parameters
    ----------
    origin : (3,) metres added to local coordinates, as RoadFrame.origin

    Returns
    -------
    Features LANES, polygons with Z, one row a piece, in the same order. The ring runs along the left border and back along the
    right one, with a vertex of each for every place along the lane
    """
    layer = Features("PolygonZ", LANES, crs=lanes.crs)
    widths, lengths = lanes.width, lanes.length
    for k in range(len(lanes)):
        left, right = lanes.borders(k)
        # closed here, so that a lane that begins in a point keeps the vertices of both borders
        layer.add(
            shapely.Polygon(np.concatenate([left, right[::-1], left[:1]]) + np.asarray(origin)), road=int(lanes.road[k]), lane=int(lanes.lane[k]),
            lane_id=lanes.lane_id[k], type=lanes.type[k], direction=int(lanes.direction[k]), left_line=lanes.left_line[k],
            right_line=lanes.right_line[k], left_kind=lanes.left_kind[k], right_kind=lanes.right_kind[k], left_patt=lanes.left_pattern[k],
            right_patt=lanes.right_pattern[k], successors=",".join(lanes.successors[k]), status=lanes.status[k],
            confidence=float(lanes.confidence[k]), other=lanes.other[k] or None,
            station_m=float(lanes.station[k]), end_m=float(lanes.end[k]), width_m=float(widths[k]),
            length_m=float(lengths[k]))
    return layer


def lanes_from_features(features: Features, origin: Any = LEVEL_ORIGIN) -> Lanes:
    """Read the layer LANES.

    Parameters
    ----------
    features : Features of polygons in map coordinates whose ring runs along the left border and back along the right one. `lane_id` is
        needed; other fields have defaults: a driving lane along the road, borders of no kind, no successors, measured
    origin : (3,) metres taken from map coordinates, as RoadFrame.origin

    Returns
    -------
    Lanes; rows without geometry are left out

    Raises
    ------
    RoadExtractionError
        If a polygon has no two borders of the same number of vertices, a lane_id is missing or there twice, or a type is unknown.
    """
    rows, rings = [], []
    for geometry, row in features:
        if geometry is None or geometry.is_empty:
            continue
        name = str(row.get("lane_id") or "")
        if not name:
            raise RoadExtractionError("A lane has no lane_id. The layer of lanes made by Driving lines or Road map is needed, with all its fields.")
        rows.append(row)
        rings.append(_ring(geometry, name) - np.asarray(origin))
    names = _texts(rows, "lane_id")
    _check_names(names, _texts(rows, "type", "driving"))
    halves = [len(ring) // 2 for ring in rings]
    return Lanes(
        _numbers(rows, "road", int, 1), _numbers(rows, "lane", int, 0), names, _texts(rows, "type", "driving"), _numbers(rows, "direction", int, 1),
        _texts(rows, "left_line", "none"), _texts(rows, "right_line", "none"), _texts(rows, "left_kind", "none"), _texts(rows, "right_kind", "none"),
        _texts(rows, "left_patt"), _texts(rows, "right_patt"),
        [tuple(part.strip() for part in str(row.get("successors") or "").split(",") if part.strip()) for row in rows],
        _texts(rows, "status", "measured"), _numbers(rows, "confidence", float, 1.0), _numbers(rows, "station_m", float, 0.0),
        _numbers(rows, "end_m", float, 0.0), np.concatenate([np.empty((0, 3)), *(ring[:n] for ring, n in zip(rings, halves))]),
        np.concatenate([np.empty((0, 3)), *(ring[n:][::-1] for ring, n in zip(rings, halves))]), np.append(0, np.cumsum(halves, dtype=int)),
        features.crs, _texts(rows, "other"))


def _ring(geometry: Any, name: str) -> np.ndarray:
    """(2n, 3) the vertices of a lane's polygon without the closing one."""
    parts = shapely.get_parts(geometry)
    if len(parts) != 1 or parts[0].geom_type != "Polygon" or len(parts[0].interiors):
        raise RoadExtractionError(f"Lane {name} is no polygon of one part without holes, so it has no two borders. Draw it as one strip.")
    ring = shapely.get_coordinates(parts[0].exterior, include_z=True)[:-1]
    if len(ring) % 2 or len(ring) < 4:
        raise RoadExtractionError(
            f"Lane {name} has {len(ring)} vertices; its two borders need the same number, at least two each. Take the layer of lanes as Driving "
            "lines or Road map made it: simplifying it or adding vertices takes the borders away.")
    return ring


def _check_names(names: np.ndarray, types: np.ndarray) -> None:
    found, counts = np.unique(names.astype(str), return_counts=True)
    if (counts > 1).any():
        raise RoadExtractionError(f"The lane_id {found[counts > 1][0]} is there {counts.max()} times; each must be there once. "
                                  "Choose the lanes of one survey.")
    unknown = sorted(set(types) - set(LANE_TYPES))
    if unknown:
        raise RoadExtractionError(f"The type {unknown[0]!r} of a lane is not known; it must be one of {', '.join(LANE_TYPES)}.")


def _texts(rows: list[dict[str, Any]], name: str, missing: str = "") -> np.ndarray:
    return np.array([missing if row.get(name) in (None, "") else str(row[name]) for row in rows], object)


def _numbers(rows: list[dict[str, Any]], name: str, kind: type, missing: float) -> np.ndarray:
    return np.array([missing if row.get(name) is None else row[name] for row in rows], kind)


# Driving lines and curve elements as arrays, and their layers in map coordinates.

LONG_LIST = 4   # numbers: longer parameters of splines are written to 0.1 mm


@dataclass(frozen=True)
class DrivingLines:
    """Driving lines in P pieces, each of one lane and status.

    road, lane : (P,) int; lanes of a road are numbered from 1
    pattern : (P,) str objects, the lines to its left and right in the direction of travel, as "dashed|solid"
    direction : (P,) int, 1 along the road's reference line, -1 against it
    source : (P,) str objects, pair or offset: between two lines or beside one
    status : (P,) str objects, measured, inferred, bridged
    confidence : (P,) 0 to 1
    curve : P Curve in local coordinates, along the road: the arc or straight that the piece is on, else the curve of the whole lane
    rmse : (P,) metres, of the lane's places from its curve
    station, end : (P,) metres along the road
    offset, width : (P,) metres, medians along the piece
    sigma : (P,) metres, uncertainty of the place across the line, one sigma, see `driving_lines.py`
    vertices : (V, 3) local metres in the direction of travel, one piece after the other
    start : (P + 1,) int, first vertex of each piece, and V
    crs : WKT, "" where unknown
    other : (P,) str objects, the second reading as JSON, see `LaneTrack.said`; "" where there is none
    """

    road: np.ndarray
    lane: np.ndarray
    pattern: np.ndarray
    direction: np.ndarray
    source: np.ndarray
    status: np.ndarray
    confidence: np.ndarray
    curve: list[Curve]
    rmse: np.ndarray
    station: np.ndarray
    end: np.ndarray
    offset: np.ndarray
    width: np.ndarray
    sigma: np.ndarray
    vertices: np.ndarray
    start: np.ndarray
    crs: str = ""
    other: np.ndarray = None  # type: ignore[assignment]  # filled on construction

    def __post_init__(self) -> None:
        if self.other is None:
            object.__setattr__(self, "other", np.full(len(self.road), "", object))

    def __len__(self) -> int:
        return len(self.road)

    @property
    def length(self) -> np.ndarray:
        """(P,) metres in plan."""
        return np.array([_length(self.vertices[a:b]) for a, b in zip(self.start[:-1], self.start[1:])])


@dataclass(frozen=True)
class CurveElements:
    """C circular curves of lanes.

    road, lane : (C,) int
    station, end : (C,) metres along the road
    arc : C Arc in local coordinates, in the direction of travel
    complete : (C,) bool, False where the arc runs on beyond the lane
    rmse : (C,) metres, of the lane's places from the arc
    crs : WKT, "" where unknown
    country : whose design code they are checked against
    """

    road: np.ndarray
    lane: np.ndarray
    station: np.ndarray
    end: np.ndarray
    arc: list[Arc]
    complete: np.ndarray
    rmse: np.ndarray
    crs: str = ""
    country: str = NEUTRAL.name

    def __len__(self) -> int:
        return len(self.road)


def driving_lines_to_features(lines: DrivingLines, frame: RoadFrame) -> Features:
    """The layer DRIVING_LINES in map coordinates.

    Parameters
    ----------
    frame : RoadFrame, whose origin is added to local coordinates

    Returns
    -------
    Features DRIVING_LINES, one row a piece, in the same order; `params` holds the curve in map coordinates as JSON
    """
    layer = Features("LineStringZ", DRIVING_LINES, crs=lines.crs)
    functions: dict[int, str] = {}   # of curves by identity: those of long splines are long, and many pieces share one
    for k, curve in enumerate(lines.curve):
        if id(curve) not in functions:
            functions[id(curve)] = _function(curve.moved(*frame.origin[:2]))
        places = lines.vertices[lines.start[k]:lines.start[k + 1]] + frame.origin
        layer.add(shapely.linestrings(places), road=int(lines.road[k]), lane=int(lines.lane[k]), kind="lane", pattern=lines.pattern[k],
                  direction=int(lines.direction[k]), source=lines.source[k], status=lines.status[k], confidence=float(lines.confidence[k]),
                  other=lines.other[k] or None, curve=curve.kind,
                  radius_m=float(curve.radius) if np.isfinite(curve.radius) else None, rmse_m=float(lines.rmse[k]),
                  sigma_m=round(float(lines.sigma[k]), 4), station_m=float(lines.station[k]), end_m=float(lines.end[k]),
                  offset_m=float(lines.offset[k]), length_m=_length(places), width_m=float(lines.width[k]), params=functions[id(curve)])
    return layer


def _length(places: np.ndarray) -> float:
    return float(np.hypot(*np.diff(places[:, :2], axis=0).T).sum())


def _function(curve: Curve) -> str:
    """The numbers of a curve as JSON, those of long splines to 0.1 mm."""
    return json.dumps({name: [round(v, 4) for v in value] if isinstance(value, list) and len(value) > LONG_LIST else value
                       for name, value in curve.params().items()})


def curve_elements_to_features(elements: CurveElements, frame: RoadFrame) -> Features:
    """The table CURVE_ELEMENTS; PC, PI and PT are in map coordinates.

    Parameters
    ----------
    frame : RoadFrame, whose origin is added to local coordinates

    Returns
    -------
    Features CURVE_ELEMENTS without geometry, one row a curve
    """
    table = Features("None", CURVE_ELEMENTS, crs=elements.crs)
    for k, arc in enumerate(elements.arc):
        table.add(None, road=int(elements.road[k]), lane=int(elements.lane[k]), station_m=float(elements.station[k]),
                  end_m=float(elements.end[k]), **element_row(arc, bool(elements.complete[k]), float(elements.rmse[k]), frame.origin,
                                                        country(elements.country)))
    return table
