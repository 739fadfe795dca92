"""The uncertainty that driving lines carry, lane by lane."""

from __future__ import annotations

import numpy as np

from ..common.features import Features
from ..driving.layers import Lanes

MIN_SHARED = 0.5   # m along the road that a lane and its driving line must share


def sigma_of_lanes(lanes: Lanes, driving_lines: Features | None) -> np.ndarray:
    """One sigma across each piece of a lane, the RMS over the driving lines along it.

    Parameters
    ----------
    lanes : Lanes
    driving_lines : Features DRIVING_LINES with `sigma_m`, or None

    Returns
    -------
    (P,) m, NaN where no driving line of the same road and lane says it
    """
    square, length = np.zeros(len(lanes)), np.zeros(len(lanes))
    for row in driving_lines.rows if driving_lines is not None else ():
        if any(row.get(name) is None for name in ("sigma_m", "road", "lane", "station_m", "end_m")):
            continue
        own = (lanes.road == int(row["road"])) & (lanes.lane == int(row["lane"]))
        shared = np.minimum(lanes.end, float(row["end_m"])) - np.maximum(lanes.station, float(row["station_m"]))
        shared = np.where(own & (shared > MIN_SHARED), shared, 0.0)
        square += shared * float(row["sigma_m"]) ** 2
        length += shared
    return np.sqrt(np.divide(square, length, out=np.full(len(lanes), np.nan), where=length > 0))
