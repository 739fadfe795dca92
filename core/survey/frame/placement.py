"""Station and offset of places that are known by their map coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .road_frame import RoadFrame


def located(frame: RoadFrame, road: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stations and offsets of local places on given roads.

    The places are taken as their map coordinates hold them. A layer that was written
    and read again therefore gives the same stations and offsets, and the stages give
    the same results in one call and one by one.

    Parameters
    ----------
    frame : RoadFrame
    road : (V,) int, number of the road of each place; numbers that the frame does not have are allowed
    x, y : (V,) local metres

    Returns
    -------
    s, d : (V,) metres; NaN where a place has no foot on its road, see `Road.locate`
    """
    s, d = np.full((2, len(x)), np.nan)
    x, y = frame.to_local(x + frame.origin[0], y + frame.origin[1])
    for number in np.unique(road[(road >= 0) & (road < len(frame.roads))]).tolist():
        there = np.flatnonzero(road == number)
        s[there], d[there] = frame.roads[number].locate(x[there], y[there])
    return s, d
