"""Driving lines and curve elements as arrays, and their layers in map coordinates."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from ..common.features import CURVE_ELEMENTS, DRIVING_LINES, Features
from ..countries.catalogue import country
from ..countries.neutral import NEUTRAL
from ..curves.base import Arc, Curve
from .curve_elements import element_row

if TYPE_CHECKING:
    from ..survey.frame.road_frame import RoadFrame

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
    sigma : (P,) metres, uncertainty of the place across the line, one sigma, see `uncertainty.py`
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
    lines : DrivingLines
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
    elements : CurveElements
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
