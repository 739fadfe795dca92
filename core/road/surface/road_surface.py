"""The outline of the road surface as polygons in the road frame, and its conversion to the layer ROAD_SURFACE."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from ...common.features import ROAD_SURFACE, Features
from ...survey.frame.placement import COORDINATE_DECIMALS

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame


@dataclass(frozen=True)
class SurfaceOutlines:
    """S stretches of road surface, each of one status.

    road : (S,) int
    status : (S,) str objects: measured where both sides have a measured or bridged edge, else grown
    station, end : (S,) metres along the road
    area : (S,) square metres
    points : (S,) int, road points
    outline : (S,) shapely polygons with Z in local metres, as the layer holds them; consecutive ones share two vertices
    crs : WKT, "" where unknown
    thin : where no curb was found and the points are too few for one, as a user is told; "" where there is no such place
    """

    road: np.ndarray
    status: np.ndarray
    station: np.ndarray
    end: np.ndarray
    area: np.ndarray
    points: np.ndarray
    outline: np.ndarray
    crs: str = ""
    thin: str = ""

    def __len__(self) -> int:
        return len(self.road)

    @staticmethod
    def of_rows(rows: Sequence[Sequence[Any]], crs: str = "", thin: str = "") -> SurfaceOutlines:
        """Stretches from their values in the order of the attributes."""
        # each column apart: numpy would make one text type of a mixed table
        kinds = dict(road=int, status=object, station=float, end=float, area=float, points=int, outline=object)
        columns = zip(*rows) if rows else [()] * len(kinds)
        return SurfaceOutlines(**{name: np.array(column, kinds[name]) for name, column in zip(kinds, columns)}, crs=crs, thin=thin)

    def map_outlines(self, frame: RoadFrame) -> np.ndarray:
        """(S,) shapely polygons with Z in map coordinates."""
        return shapely.transform(self.outline, lambda places: np.round(places + frame.origin, COORDINATE_DECIMALS), include_z=True)


def surface_to_features(surface: SurfaceOutlines, frame: RoadFrame) -> Features:
    """The layer ROAD_SURFACE in map coordinates.

    Parameters
    ----------
    surface : SurfaceOutlines
    frame : RoadFrame, whose origin is added to local coordinates

    Returns
    -------
    Features ROAD_SURFACE: PolygonZ, in the same order
    """
    columns = dict(road=surface.road, status=surface.status, station_m=surface.station, end_m=surface.end, area_m2=surface.area,
                   points=surface.points)
    rows = [dict(zip(columns, row)) for row in zip(*(values.tolist() for values in columns.values()))]
    return Features("PolygonZ", list(ROAD_SURFACE), list(surface.map_outlines(frame)), rows, surface.crs)
