"""The passes of a road frame as lines on the map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from ...common.features import PASSES, Features
from .passes import STANDSTILL_RADIUS, decimate_by_distance
from .placement import COORDINATE_DECIMALS

if TYPE_CHECKING:
    from .road_frame import RoadFrame


def passes_to_features(frame: RoadFrame, crs: str) -> Features:
    """The layer PASSES in map coordinates: where the vehicle drove, as the run used it.

    Parameters
    ----------
    frame : RoadFrame
    crs : WKT, "" where unknown

    Returns
    -------
    Features, LineStringZ, one row a pass in order of time, drawn as it was driven with a vertex every half metre
    """
    layer = Features("LineStringZ", list(PASSES), crs=crs)
    for one in frame.passes:
        rows = decimate_by_distance(one.x, one.y, STANDSTILL_RADIUS)
        if len(rows) < 2:
            continue
        line = shapely.linestrings(np.round(np.c_[one.x, one.y, one.z][rows] + frame.origin, COORDINATE_DECIMALS))
        timed = frame.has_time
        layer.add(line, **{"pass": one.number}, road=one.road, direction=one.direction, station_m=float(one.s.min()), end_m=float(one.s.max()),
                  length_m=float(line.length), begin_s=float(one.time[0]) if timed else None, finish_s=float(one.time[-1]) if timed else None)
    return layer
