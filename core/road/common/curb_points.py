"""Curb points as arrays, which stages hand each other and which the layer CURB_POINTS holds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely

from ...common.features import CURB_POINTS, NEAREST_PASS, PASS_SIGMA, SIGMA, Features
from ...common.layer_rows import LayerRows, column
from ...survey.frame.placement import COORDINATE_DECIMALS, as_written
from ...survey.frame.road_frame import RoadFrame


@dataclass(frozen=True)
class CurbPoints(LayerRows):
    """N corners of curbs, and places at which something hides the curb.

    kind : (N,) str objects: main for the road's own curbs; corner, side_street and island for others
    sigma : (N,) metres, one sigma across that neighbouring points share, of a line fitted as a whole or a foot that no point shows; else NaN
    """

    GEOMETRY_TYPE, SCHEMA = "PointZ", CURB_POINTS

    road: np.ndarray = field(metadata=column())   # road, nearest_pass: (N,) int, number of the road and of the pass that drove nearest
    nearest_pass: np.ndarray = field(metadata=column(NEAREST_PASS.name))
    side: np.ndarray = field(metadata=column())   # (N,) str objects, left or right
    status: np.ndarray = field(metadata=column())   # (N,) str objects: measured; bridged, on the line across a lowered curb; or occluded
    part: np.ndarray = field(metadata=column(unknown="bottom"))   # (N,) str objects, bottom or top
    kind: np.ndarray = field(metadata=column(unknown="main"))
    station: np.ndarray = field(metadata=column("station_m"))   # station, offset: (N,) metres
    offset: np.ndarray = field(metadata=column("offset_m"))
    height: np.ndarray = field(metadata=column("height_m"))   # (N,) metres of the step; NaN where unknown
    chain: np.ndarray = field(metadata=column())   # (N,) int, the points of one curb share it; -1 where unknown
    along: np.ndarray = field(metadata=column("along_m"))   # (N,) metres along the chain, of points that are not of a main curb; else NaN
    residual: np.ndarray = field(metadata=column("residual_m"))   # (N,) metres, scatter of the measurements about the curb; NaN where unknown
    sigma: np.ndarray = field(metadata=column(SIGMA.name))
    support: np.ndarray = field(metadata=column())   # (N,) int, number of laser points; -1 where unknown
    x: np.ndarray   # x, y, z: (N,) local metres, as the layer holds them
    y: np.ndarray
    z: np.ndarray
    crs: str = ""   # WKT, "" where unknown

    @property
    def of_main_curb(self) -> np.ndarray:
        """(N,) bool: does the point belong to a curb along the road?"""
        return self.kind == "main"

    def map_places(self, frame: RoadFrame) -> np.ndarray:
        """(N, 3) map coordinates, as the layer holds them."""
        return np.round(np.c_[self.x, self.y, self.z] + frame.origin, COORDINATE_DECIMALS)

    def on_map(self, frame: RoadFrame) -> Iterable[Any]:
        """(N,) points with Z in map coordinates."""
        return shapely.points(self.map_places(frame))

    def derived(self, frame: RoadFrame) -> dict[str, np.ndarray]:
        """The part of the uncertainty that all lines of a road share."""
        sigma = np.full(len(self), np.nan)
        for road in frame.pass_sigma:
            of_road = self.road == road
            sigma[of_road] = frame.passes_sigma(road, self.station[of_road], np.nan)
        return {PASS_SIGMA.name: sigma}

    @staticmethod
    def from_features(features: Features, frame: RoadFrame) -> CurbPoints:
        """The points of a layer CURB_POINTS in map coordinates, one a row; fields may be missing."""
        places = shapely.get_coordinates(features.geometries, include_z=True)
        return CurbPoints(**CurbPoints.read_columns(features.rows), **dict(zip("xyz", frame.to_local(*places.T))), crs=features.crs)


def curb_points_at(frame: RoadFrame, road: int, places: Sequence[np.ndarray], rows: Sequence[Mapping[str, Any]] = (), crs: str = "",
                   **columns: Any) -> CurbPoints:
    """N points of one road; the pass that drove nearest is found for them.

    places : (N,) x, y and z in map coordinates
    rows : N dicts, what is known of each point beside `columns`: name of an attribute of CurbPoints to value
    columns : attributes of CurbPoints: (N,) arrays, or a value that all points share

    Returns CurbPoints; places, stations and offsets to 0.1 mm, as the layer holds them
    """
    count = len(places[0])
    values = {**(CurbPoints.gathered(rows) if len(rows) else {}), **columns, "road": road}
    values.update({name: np.round(np.asarray(values[name], float), COORDINATE_DECIMALS) for name in ("station", "offset")})
    values["nearest_pass"] = frame.nearest_pass(road, values["station"], values["offset"]) if count else -1
    values.update(zip("xyz", as_written(frame, *places)))
    return CurbPoints.filled(count, crs, **values)
