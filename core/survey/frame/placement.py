"""Places as a layer holds them: station and offset of map coordinates, coordinates to 0.1 mm, and what is unknown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .road_frame import RoadFrame

COORDINATE_DECIMALS = 4  # of coordinates in layers: 0.1 mm


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


def as_written(frame: RoadFrame, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, ...]:
    """Local x, y and z, (V,) metres each, of map coordinates that are rounded as in a layer.

    What is computed from them is therefore the same whether a stage got its input in memory or from a file.
    """
    return frame.to_local(*(np.round(values, COORDINATE_DECIMALS) for values in (x, y, z)))


def known(value: Any) -> Any:
    """A value for the field of a layer: None (NULL) for what arrays hold as unknown, which is NaN, "" and whole numbers below 0."""
    return None if value == "" or value != value or isinstance(value, int) and value < 0 else value
