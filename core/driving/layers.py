"""Lanes as areas between two borders with what follows each, driving lines and curve elements, which stages hand each other, and their layers."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from ..common.errors import RoadExtractionError
from ..common.features import CURVE_ELEMENTS, DRIVING_LINES, LANES, Features
from ..common.layer_rows import LayerRows, column
from ..countries.catalogue import NEUTRAL, country
from ..curves.base import Arc, Curve
from ..curves.robust import median
from ..survey.frame.road_frame import RoadFrame
from .alignment import element_row

LANE_TYPES = ("driving", "shoulder", "parking", "bicycle", "hatched", "median", "connector")


@dataclass(frozen=True)
class Lanes(LayerRows):
    """Lanes in P pieces. Left and right are seen in the direction of travel, along the road where nobody drives.

    left_line, right_line : (P,) str objects, what the border is: "line 12" by `line` of the marking lines, "edge 3" by `chain` of the road edges, or
        "none"
    """

    GEOMETRY_TYPE, SCHEMA = "PolygonZ", LANES

    road: np.ndarray = field(metadata=column(unknown=1))   # (P,) int; lanes of a road are numbered from 1
    lane: np.ndarray = field(metadata=column(unknown=0))
    lane_id: np.ndarray = field(metadata=column(unknown=""))   # (P,) str objects, "road.lane.piece", each once
    type: np.ndarray = field(metadata=column(unknown="driving"))   # (P,) str objects, one of LANE_TYPES
    direction: np.ndarray = field(metadata=column(unknown=1))   # (P,) int, 1 along the road's reference line, -1 against it, 0 where nobody drives
    left_line: np.ndarray = field(metadata=column(unknown="none"))
    right_line: np.ndarray = field(metadata=column(unknown="none"))
    left_kind: np.ndarray = field(metadata=column(unknown="none"))   # (P,) str objects, edge, lane, centre, curb, pavement, hatch or none
    right_kind: np.ndarray = field(metadata=column(unknown="none"))
    left_pattern: np.ndarray = field(metadata=column("left_patt", unknown=""))   # (P,) str objects, as in DRIVING_LINES, "" where there is none
    right_pattern: np.ndarray = field(metadata=column("right_patt", unknown=""))
    successors: list[tuple[str, ...]]   # P tuples of lane_ids, what follows in the direction of travel
    status: np.ndarray = field(metadata=column(unknown="measured"))   # (P,) str objects, measured, inferred or bridged
    confidence: np.ndarray = field(metadata=column(unknown=1.0))   # (P,) float, 0 to 1
    station: np.ndarray = field(metadata=column("station_m", unknown=0.0))   # (P,) metres along the road
    end: np.ndarray = field(metadata=column("end_m", unknown=0.0))
    other: np.ndarray = field(metadata=column())   # (P,) str objects, the second reading as JSON, as of DrivingLines
    left: np.ndarray   # (V, 3) local metres, the borders in the direction of travel, piece after piece, cut at the same places
    right: np.ndarray
    start: np.ndarray   # (P + 1,) int, first vertex of each piece, and V
    crs: str = ""   # WKT, "" where unknown

    @staticmethod
    def of_pieces(pieces: Sequence[Mapping[str, Any]], crs: str = "") -> Lanes:
        """Lanes of one dict a piece: its values by attribute, `left` and `right` (n, 3) in the direction of travel; what is missing has the
        default of the layer: a driving lane along the road, borders of no kind, no successors, measured."""
        left, right = (np.concatenate([np.empty((0, 3)), *(piece[side] for piece in pieces)]) for side in ("left", "right"))
        return Lanes(**Lanes.gathered(pieces), successors=[tuple(piece.get("successors", ())) for piece in pieces], left=left, right=right,
                     start=np.append(0, np.cumsum([len(piece["left"]) for piece in pieces], dtype=int)), crs=crs)

    def borders(self, piece: int) -> tuple[np.ndarray, np.ndarray]:
        """(left, right) of one piece, each (n, 3), in the direction of travel."""
        rows = slice(self.start[piece], self.start[piece + 1])
        return self.left[rows], self.right[rows]

    @property
    def width(self) -> np.ndarray:
        """(P,) metres, median in plan between the borders."""
        widths = np.hypot(*(self.left - self.right)[:, :2].T)
        return np.array([median(widths[a:b]) for a, b in zip(self.start[:-1], self.start[1:])])

    @property
    def length(self) -> np.ndarray:
        """(P,) metres in plan along the middle."""
        middle = (self.left + self.right)[:, :2] / 2
        return np.array([np.hypot(*np.diff(middle[a:b], axis=0).T).sum() for a, b in zip(self.start[:-1], self.start[1:])])

    def on_map(self, frame: RoadFrame | None) -> list[Any]:
        """P polygons with Z in map coordinates, in which lanes are where there is no frame. The ring runs along the left border and back along
        the right one, with a vertex of each for every place along the lane."""
        origin = np.zeros(3) if frame is None else np.asarray(frame.origin)
        # closed here, so that a lane that begins in a point keeps the vertices of both borders
        return [shapely.Polygon(np.concatenate([left, right[::-1], left[:1]]) + origin) for left, right in map(self.borders, range(len(self)))]

    def derived(self, frame: RoadFrame | None) -> dict[str, Any]:
        """The successors as one text, the width and the length."""
        return dict(successors=map(",".join, self.successors), width_m=self.width, length_m=self.length)

    @staticmethod
    def from_features(features: Features, frame: RoadFrame | None = None) -> Lanes:
        """Read the layer LANES: polygons in map coordinates whose ring runs along the left border and back along the right one.

        `lane_id` is needed; other fields have the defaults of `of_pieces`; rows without geometry are left out. Without a frame lanes stay in map
        coordinates.

        Raises RoadExtractionError if a polygon has no two borders of the same number of vertices, a lane_id is missing or there twice, or a type is
        unknown.
        """
        origin, rows, borders = np.zeros(3) if frame is None else np.asarray(frame.origin), [], []
        for geometry, row in features:
            if geometry is None or geometry.is_empty:
                continue
            name = str(row.get("lane_id") or "")
            if not name:
                raise RoadExtractionError(
                    "A lane has no lane_id. The layer of lanes made by Driving lines or Road map is needed, with all its fields.")
            ring = _ring(geometry, name) - origin
            rows.append(row)
            borders.append(dict(left=ring[:len(ring) // 2], right=ring[len(ring) // 2:][::-1],
                                successors=[part.strip() for part in str(row.get("successors") or "").split(",") if part.strip()]))
        columns = Lanes.read_columns(rows)
        _check_names(columns["lane_id"], columns["type"])
        return replace(Lanes.of_pieces(borders, features.crs), **columns)


def _ring(geometry: Any, name: str) -> np.ndarray:
    """(2n, 3) the vertices of a lane's polygon without the closing one."""
    parts = shapely.get_parts(geometry)
    if len(parts) != 1 or parts[0].geom_type != "Polygon" or len(parts[0].interiors):
        raise RoadExtractionError(f"Lane {name} is no polygon of one part without holes, so it has no two borders. Draw it as one strip.")
    ring = shapely.get_coordinates(parts[0].exterior, include_z=True)[:-1]
    if len(ring) % 2 or len(ring) < 4:
        raise RoadExtractionError(f"Lane {name} has {len(ring)} vertices; its two borders need the same number, at least two each. Take the layer of "
                                  "lanes as Driving lines or Road map made it: simplifying it or adding vertices takes the borders away.")
    return ring


def _check_names(names: np.ndarray, types: np.ndarray) -> None:
    unique_names, counts = np.unique(names.astype(str), return_counts=True)
    if (counts > 1).any():
        raise RoadExtractionError(f"The lane_id {unique_names[counts > 1][0]} is there {counts.max()} times; each must be there once. "
                                  "Choose the lanes of one survey.")
    unknown = sorted(set(types) - set(LANE_TYPES))
    if unknown:
        raise RoadExtractionError(f"The type {unknown[0]!r} of a lane is not known; it must be one of {', '.join(LANE_TYPES)}.")


LONG_LIST = 4   # derived: numbers: longer parameters of splines are written to 0.1 mm


@dataclass(frozen=True)
class DrivingLines(LayerRows):
    """Driving lines in P pieces, each of one lane and status.

    pattern : (P,) str objects, the lines to its left and right in the direction of travel, as "dashed|solid"
    """

    GEOMETRY_TYPE, SCHEMA = "LineStringZ", DRIVING_LINES

    road: np.ndarray = field(metadata=column(unknown=-1))   # (P,) int; lanes of a road are numbered from 1
    lane: np.ndarray = field(metadata=column(unknown=-1))
    pattern: np.ndarray = field(metadata=column(unknown=""))
    direction: np.ndarray = field(metadata=column(unknown=1))   # (P,) int, 1 along the road's reference line, -1 against it
    source: np.ndarray = field(metadata=column(unknown=""))   # (P,) str objects, pair or offset: between two lines or beside one
    status: np.ndarray = field(metadata=column(unknown=""))   # (P,) str objects, measured, inferred, bridged
    confidence: np.ndarray = field(metadata=column())   # (P,) 0 to 1
    curve: list[Curve]   # P Curve in local coordinates, along the road: the arc or straight that the piece is on, else the curve of the whole lane
    rmse: np.ndarray = field(metadata=column("rmse_m"))   # (P,) metres, of the lane's places from its curve
    station: np.ndarray = field(metadata=column("station_m"))   # (P,) metres along the road
    end: np.ndarray = field(metadata=column("end_m"))
    offset: np.ndarray = field(metadata=column("offset_m"))   # (P,) metres, medians along the piece
    width: np.ndarray = field(metadata=column("width_m"))
    sigma: np.ndarray = field(metadata=column("sigma_m"))   # (P,) metres, uncertainty of the place across the line, one sigma, see `driving_lines.py`
    other: np.ndarray = field(metadata=column())   # (P,) str objects, the second reading as JSON, see `LaneTrack.said`; "" where there is none
    design_speed: np.ndarray = field(metadata=column("design_kmh"))   # (P,) int km/h that the curve it is on allows, -1 where it is on none
    vertices: np.ndarray   # (V, 3) local metres in the direction of travel, one piece after the other
    start: np.ndarray   # (P + 1,) int, first vertex of each piece, and V
    crs: str = ""   # WKT, "" where unknown

    @staticmethod
    def of_pieces(pieces: Sequence[Mapping[str, Any]], crs: str) -> DrivingLines:
        """DrivingLines of one dict a piece: its values by attribute, and `places` (n, 3) in the direction of travel."""
        places = [piece["places"] for piece in pieces]
        return DrivingLines(
            **DrivingLines.gathered(pieces), curve=[piece["curve"] for piece in pieces], vertices=np.concatenate([*places, np.empty((0, 3))]),
            start=np.append(0, np.cumsum([len(vertices) for vertices in places], dtype=int)), crs=crs)

    def on_map(self, frame: RoadFrame) -> list[Any]:
        """P lines with Z in map coordinates."""
        return [shapely.linestrings(vertices) for vertices in self._map_places(frame)]

    def _map_places(self, frame: RoadFrame) -> list[np.ndarray]:
        return [self.vertices[a:b] + frame.origin for a, b in zip(self.start[:-1], self.start[1:])]

    def derived(self, frame: RoadFrame) -> dict[str, Any]:
        """What the curve says, its numbers in map coordinates as JSON in `params`; the length; and the uncertainty to 0.1 mm."""
        functions: dict[int, str] = {}   # of curves by identity: those of long splines are long, and many pieces share one
        for curve in self.curve:
            if id(curve) not in functions:
                functions[id(curve)] = _function(curve.moved(*frame.origin[:2]))
        return dict(kind=["lane"] * len(self), curve=[curve.kind for curve in self.curve], radius_m=[curve.radius for curve in self.curve],
                    sigma_m=[round(sigma, 4) for sigma in self.sigma.tolist()], length_m=map(_length, self._map_places(frame)),
                    params=[functions[id(curve)] for curve in self.curve])

    @property
    def length(self) -> np.ndarray:
        """(P,) metres in plan."""
        return np.array([_length(self.vertices[a:b]) for a, b in zip(self.start[:-1], self.start[1:])])


@dataclass(frozen=True)
class CurveElements(LayerRows):
    """C circular curves of lanes."""

    GEOMETRY_TYPE, SCHEMA = "None", CURVE_ELEMENTS

    road: np.ndarray = field(metadata=column(unknown=-1))   # (C,) int
    lane: np.ndarray = field(metadata=column(unknown=-1))
    station: np.ndarray = field(metadata=column("station_m"))   # (C,) metres along the road
    end: np.ndarray = field(metadata=column("end_m"))
    arc: list[Arc]   # C Arc in local coordinates, in the direction of travel
    complete: np.ndarray   # (C,) bool, False where the arc runs on beyond the lane
    rmse: np.ndarray = field(metadata=column("rmse_m"))   # (C,) metres, of the lane's places from the arc
    crs: str = ""   # WKT, "" where unknown
    country: str = NEUTRAL.name   # whose design code they are checked against

    def on_map(self, frame: RoadFrame) -> list[None]:
        """A table has no geometries."""
        return [None] * len(self)

    def derived(self, frame: RoadFrame) -> dict[str, Any]:
        """The elements of each curve; PC, PI and PT are in map coordinates."""
        rows = [element_row(arc, complete, rmse, frame.origin, country(self.country))
                for arc, complete, rmse in zip(self.arc, self.complete.tolist(), self.rmse.tolist())]
        return {name: [row[name] for row in rows] for name in (rows[0] if rows else ())}


def _length(places: np.ndarray) -> float:
    return float(np.hypot(*np.diff(places[:, :2], axis=0).T).sum())


def _function(curve: Curve) -> str:
    """The numbers of a curve as JSON, those of long splines to 0.1 mm."""
    return json.dumps({name: [round(v, 4) for v in value] if isinstance(value, list) and len(value) > LONG_LIST else value
                       for name, value in curve.params().items()})
