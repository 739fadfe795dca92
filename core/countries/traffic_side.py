"""On which side traffic drives, by place on earth."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import shapely


@cache
def _outlines():
    """{"left" or "mixed": area} of traffic_sides.txt."""
    lines = Path(__file__).with_name("traffic_sides.txt").read_text(encoding="utf-8").splitlines()
    return {name: shapely.from_wkt(text) for name, text in (line.split(": ", 1) for line in lines if not line.startswith("#"))}


@cache
def side_of_traffic(longitude: float, latitude: float) -> str:
    """"right" or "left", the side of traffic at a place in degrees; "" where it is not known, as within 30 km of a border between the two."""
    place, left = shapely.Point(longitude, latitude), _outlines()["left"]
    if not np.isfinite([longitude, latitude]).all() or left.boundary.distance(place) < 0.3:
        return ""
    if left.contains(place):
        return "left"
    return "" if _outlines()["mixed"].contains(place) else "right"
