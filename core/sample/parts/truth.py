"""The true layers of a scene and their fields."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...common.features import Features, Field
from ...common.schemas import CURB_KIND, DRIVING_LINES, END, HEIGHT, LENGTH, PART, ROAD, SIDE, STATION, WIDTH

VERTEX_STEP = 0.25      # m between vertices

TRUE_BOUNDARIES = [ROAD, SIDE, PART, CURB_KIND, Field("edge", str, "Edge (curb/dropped/pavement)"), STATION, END, HEIGHT, LENGTH]
TRUE_MARKINGS = [ROAD, Field("class", str, "Class"), Field("line", int, "Line"), Field("pattern", str, "Pattern"),
            STATION, END, WIDTH, Field("wear", float, "Share of paint worn away")]
TRUE_DRIVING_LINES = [field for field in DRIVING_LINES if field.name in
           ("road", "lane", "direction", "radius_m", "station_m", "end_m", "length_m")]
TRUE_SURFACE = [ROAD, Field("area_m2", float, "Area (m²)")]


class Truth(NamedTuple):
    """The true layers of a scene, Features each, in map coordinates."""

    boundaries: Features
    markings: Features
    driving_lines: Features
    surface: Features


def densified(outline: np.ndarray) -> np.ndarray:
    """The closed ring of an outline, (n, 2) m, with vertices at least every quarter of a metre."""
    closed = np.vstack([outline, outline[:1]])
    sides = [a + np.linspace(0, 1, max(1, int(np.ceil(np.hypot(*(b - a)) / VERTEX_STEP))), endpoint=False)[:, None] * (b - a)
             for a, b in zip(closed[:-1], closed[1:])]
    return np.vstack([*sides, outline[:1]])
