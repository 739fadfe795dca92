"""The true layers of a scene and their fields."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...common.features import Features, Field
from ...common.schemas import CURB_KIND, DRIVING_LINES, END, HEIGHT, LANES, LENGTH, PART, ROAD, SIDE, STATION, WIDTH

VERTEX_STEP = 0.25      # m between vertices

TRUE_BOUNDARIES = [ROAD, SIDE, PART, CURB_KIND, Field("edge", str, "Edge (curb/dropped/pavement)"), STATION, END, HEIGHT, LENGTH]
TRUE_MARKINGS = [ROAD, Field("class", str, "Class"), Field("line", int, "Line"), Field("pattern", str, "Pattern"),
            STATION, END, WIDTH, Field("wear", float, "Share of paint worn away")]
TRUE_DRIVING_LINES = [field for field in DRIVING_LINES if field.name in
           ("road", "lane", "direction", "radius_m", "station_m", "end_m", "length_m")]
TRUE_LANES = [field for field in LANES if field.name in ("road", "lane", "type", "direction", "station_m", "end_m", "width_m", "length_m")]
TRUE_SURFACE = [ROAD, Field("area_m2", float, "Area (m²)")]


class Truth(NamedTuple):
    """The true layers of a scene, Features each, in map coordinates."""

    boundaries: Features
    markings: Features
    driving_lines: Features
    surface: Features
    lanes: Features


def densified(outline: np.ndarray) -> np.ndarray:
    """The closed ring of an outline, (n, 2) m, with vertices at least every quarter of a metre."""
    closed = np.vstack([outline, outline[:1]])
    sides = [a + np.linspace(0, 1, max(1, int(np.ceil(np.hypot(*(b - a)) / VERTEX_STEP))), endpoint=False)[:, None] * (b - a)
             for a, b in zip(closed[:-1], closed[1:])]
    return np.vstack([*sides, outline[:1]])


def add_lane(layer: Features, left: np.ndarray, right: np.ndarray, direction: int, **row: Any) -> None:
    """Add a lane to a layer of TRUE_LANES.

    Parameters
    ----------
    layer : Features
    left, right : (N, 3) m, its borders on the map, left and right of the line that stations run along
    direction : 1 along that line, -1 against it

    The ring begins with the left border in the direction of travel and comes back along the right one.
    """
    from shapely import LineString, Polygon

    if direction < 0:
        left, right = right[::-1], left[::-1]
    layer.add(Polygon(np.concatenate([left, right[::-1]])), type="driving", direction=direction,
              width_m=float(np.median(np.hypot(*(left - right)[:, :2].T))), length_m=float(LineString((left + right) / 2).length), **row)
