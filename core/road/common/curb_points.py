"""Curb points as arrays, and their conversion from and to the layer CURB_POINTS.

Stages hand each other `CurbPoints`. Map coordinates are made in one place, `curb_points_to_features`, and read in one
place, `curb_points_from_features`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from ...common.features import CURB_POINTS, NEAREST_PASS, PASS_SIGMA, SIGMA, Features
from ...survey.frame.placement import COORDINATE_DECIMALS, as_written, known

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame

UNKNOWN_OF_CURB = dict(road=-1, nearest_pass=-1, side="", status="", part="bottom", kind="main", station=np.nan, offset=np.nan, height=np.nan,
               chain=-1, along=np.nan, residual=np.nan, sigma=np.nan, support=-1)
CURB_POINT_FIELDS = dict(road="road", nearest_pass=NEAREST_PASS.name, side="side", status="status", station="station_m", offset="offset_m",
                         height="height_m", part="part", kind="kind", chain="chain", along="along_m", residual="residual_m",
                         sigma=SIGMA.name, support="support")


@dataclass(frozen=True)
class CurbPoints:
    """N corners of curbs, and places at which something hides the curb.

    road, nearest_pass : (N,) int, number of the road and of the pass that drove nearest
    side : (N,) str objects, left or right
    status : (N,) str objects, measured or occluded
    part : (N,) str objects, bottom or top
    kind : (N,) str objects: main for the road's own curbs; corner, side_street and island for others
    station, offset : (N,) metres
    height : (N,) metres of the step; NaN where unknown
    chain : (N,) int, the points of one curb share it; -1 where unknown
    along : (N,) metres along the chain, of points that are not of a main curb; else NaN
    residual : (N,) metres, scatter of the measurements about the curb; NaN where unknown
    sigma : (N,) metres, one sigma across that the points of a line fitted as a whole share; NaN where each was seen by itself
    support : (N,) int, number of laser points; -1 where unknown
    x, y, z : (N,) local metres, as the layer holds them
    crs : WKT, "" where unknown
    """

    road: np.ndarray
    nearest_pass: np.ndarray
    side: np.ndarray
    status: np.ndarray
    part: np.ndarray
    kind: np.ndarray
    station: np.ndarray
    offset: np.ndarray
    height: np.ndarray
    chain: np.ndarray
    along: np.ndarray
    residual: np.ndarray
    sigma: np.ndarray
    support: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    crs: str = ""

    def __len__(self) -> int:
        return len(self.road)

    def __getitem__(self, which: np.ndarray) -> CurbPoints:
        """Some of the points, by a mask or their numbers."""
        return replace(self, **{name: getattr(self, name)[which] for name in CURB_POINT_COLUMNS})

    @property
    def of_main_curb(self) -> np.ndarray:
        """(N,) bool: does the point belong to a curb along the road?"""
        return self.kind == "main"

    def map_places(self, frame: RoadFrame) -> np.ndarray:
        """(N, 3) map coordinates, as the layer holds them."""
        return np.round(np.c_[self.x, self.y, self.z] + frame.origin, COORDINATE_DECIMALS)

    @staticmethod
    def none(crs: str = "") -> CurbPoints:
        """No point at all."""
        return CurbPoints(**{name: np.empty(0, CURB_POINT_TYPES[name]) for name in CURB_POINT_COLUMNS}, crs=crs)

    @staticmethod
    def join(parts: Iterable[CurbPoints], crs: str = "") -> CurbPoints:
        """The points of all parts, one after the other."""
        parts = [CurbPoints.none(crs), *parts]
        return CurbPoints(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in CURB_POINT_COLUMNS}, crs=crs)


CURB_POINT_COLUMNS = tuple(field.name for field in fields(CurbPoints) if field.name != "crs")
CURB_POINT_TYPES: dict[str, type] = {**dict.fromkeys(CURB_POINT_COLUMNS, float), **dict.fromkeys(("road", "nearest_pass", "chain", "support"), int),
                          **dict.fromkeys(("side", "status", "part", "kind"), object)}


def curb_points_at(frame: RoadFrame, road: int, places: Sequence[np.ndarray], rows: Sequence[Mapping[str, Any]] = (), crs: str = "",
                   **columns: Any) -> CurbPoints:
    """N points of one road; the pass that drove nearest is found for them.

    Parameters
    ----------
    frame : RoadFrame
    road : number of the road
    places : (N,) x, y and z in map coordinates
    rows : N dicts, what is known of each point beside `columns`: name of an attribute of CurbPoints to value
    crs : WKT
    columns : attributes of CurbPoints: (N,) arrays, or a value that all points share

    Returns
    -------
    CurbPoints; places, stations and offsets to 0.1 mm, as the layer holds them
    """
    count = len(places[0])
    given: dict[str, Any] = {name: np.array([row.get(name, UNKNOWN_OF_CURB[name]) for row in rows], CURB_POINT_TYPES[name])
                             for name in {key for row in rows for key in row}}
    given.update({**columns, "road": road})
    given.update({name: np.round(given[name], COORDINATE_DECIMALS) for name in ("station", "offset")})
    given["nearest_pass"] = frame.nearest_pass(road, given["station"], given["offset"]) if count else -1
    given.update(zip("xyz", as_written(frame, *places)))
    return CurbPoints(**{name: np.array(np.broadcast_to(np.asarray(given.get(name, UNKNOWN_OF_CURB.get(name)), CURB_POINT_TYPES[name]), count))
                         for name in CURB_POINT_COLUMNS}, crs=crs)


def curb_points_to_features(points: CurbPoints, frame: RoadFrame) -> Features:
    """The layer CURB_POINTS in map coordinates.

    Parameters
    ----------
    points : CurbPoints
    frame : RoadFrame, whose origin is added to local coordinates

    Returns
    -------
    Features CURB_POINTS: PointZ, in the same order
    """
    places = shapely.points(points.map_places(frame))
    columns = {name: getattr(points, attribute).tolist() for attribute, name in CURB_POINT_FIELDS.items()}
    sigma = np.full(len(points), np.nan)
    for road in frame.pass_sigma:
        own = points.road == road
        sigma[own] = frame.passes_sigma(road, points.station[own], np.nan)
    columns[PASS_SIGMA.name] = sigma.tolist()
    rows = [{name: known(value) for name, value in zip(columns, row)} for row in zip(*columns.values())]
    return Features("PointZ", list(CURB_POINTS), list(places), rows, points.crs)


def curb_points_from_features(features: Features, frame: RoadFrame) -> CurbPoints:
    """Read the layer CURB_POINTS.

    Parameters
    ----------
    features : Features CURB_POINTS in map coordinates; fields may be missing
    frame : RoadFrame

    Returns
    -------
    CurbPoints, one a row
    """
    columns: dict[str, Any] = {attribute: np.array(features.column(name, UNKNOWN_OF_CURB[attribute]), CURB_POINT_TYPES[attribute])
                               for attribute, name in CURB_POINT_FIELDS.items()}
    places = shapely.get_coordinates(features.geometries, include_z=True)
    return CurbPoints(**columns, **dict(zip("xyz", frame.to_local(*places.T))), crs=features.crs)
