"""The true layers of a scene and their fields."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...core.common.features import CURB_KIND, DRIVING_LINES, END, HEIGHT, LANES, LENGTH, PART, ROAD, ROADSIDE, SIDE, STATION, WIDTH, Features, Field

VERTEX_STEP = 0.25      # m between vertices
STRAIGHT = 1e-4         # 1/m: lines that bend less are straight

TRUE_BOUNDARIES = [ROAD, SIDE, PART, CURB_KIND, Field("edge", str, "Edge (curb/dropped/pavement)"), STATION, END, HEIGHT, LENGTH]
TRUE_MARKINGS = [ROAD, Field("class", str, "Class"), Field("line", int, "Line"), Field("pattern", str, "Pattern"),
            STATION, END, WIDTH, Field("wear", float, "Share of paint worn away")]
TRUE_DRIVING_LINES = [field for field in DRIVING_LINES if field.name in
           ("road", "lane", "direction", "radius_m", "station_m", "end_m", "length_m")]
TRUE_LANES = [field for field in LANES if field.name in ("road", "lane", "type", "direction", "station_m", "end_m", "width_m", "length_m")]
TRUE_ROADSIDE = [field for field in ROADSIDE if field.name in ("road", "side", "kind", "station_m", "end_m", "height_m", "foot_m", "length_m")]
TRUE_SURFACE = [ROAD, Field("area_m2", float, "Area (m²)")]


class Truth(NamedTuple):
    """The true layers of a scene, Features each, in map coordinates."""

    boundaries: Features
    markings: Features
    driving_lines: Features
    surface: Features
    lanes: Features
    roadside: Features


class TruePlaces(NamedTuple):
    """Where the true things of a scene lie on the map, (N, 3) m, each with the fields that are known of it.

    lanes : (left border, right border, fields), left and right of the line that stations run along
    """

    boundaries: Iterable[tuple[np.ndarray, dict[str, Any]]]   # (line, fields)
    markings: Iterable[tuple[np.ndarray, dict[str, Any]]]   # (ring, fields)
    driving_lines: Iterable[tuple[np.ndarray, float, dict[str, Any]]]   # (line along the stations, sharpest bend 1/m, fields)
    surface: Iterable[tuple[np.ndarray, list[np.ndarray]]]   # (outer ring, inner rings)
    lanes: Iterable[tuple[np.ndarray, np.ndarray, dict[str, Any]]]
    roadside: Iterable[tuple[np.ndarray, dict[str, Any]]]   # (line on the ground along the face of a thing, fields)

    def layers(self, crs: str) -> Truth:
        """The true layers; driving lines and lanes are drawn in their direction of travel, `radius_m` is that of the sharpest bend."""
        from shapely import LineString, Polygon

        boundaries, driving_lines = Features("LineStringZ", TRUE_BOUNDARIES, crs=crs), Features("LineStringZ", TRUE_DRIVING_LINES, crs=crs)
        markings, surface, lanes = (Features("PolygonZ", schema, crs=crs) for schema in (TRUE_MARKINGS, TRUE_SURFACE, TRUE_LANES))
        for places, fields in self.boundaries:
            line = LineString(places)
            boundaries.add(line, road=1, length_m=line.length, **fields)
        for places, fields in self.markings:
            markings.add(Polygon(places), road=1, **fields)
        for places, bend, fields in self.driving_lines:
            line = LineString(places[::fields["direction"]])
            driving_lines.add(line, radius_m=1.0 / bend if bend > STRAIGHT else None, length_m=line.length, **fields)
        for ring, holes in self.surface:
            polygon = Polygon(ring, holes)
            surface.add(polygon, road=1, area_m2=polygon.area)
        for left, right, fields in self.lanes:
            around = [left, right[::-1]] if fields["direction"] > 0 else [right[::-1], left]
            lanes.add(Polygon(np.concatenate(around)), type="driving", width_m=np.median(np.hypot(*(left - right)[:, :2].T)),
                      length_m=LineString((left + right) / 2).length, **fields)
        roadside = Features("LineStringZ", TRUE_ROADSIDE, crs=crs)
        for places, fields in self.roadside:
            line = LineString(places)
            roadside.add(line, road=1, length_m=line.length, **fields)
        return Truth(boundaries, markings, driving_lines, surface, lanes, roadside)


def densified(outline: np.ndarray) -> np.ndarray:
    """The closed ring of an outline, (n, 2) m, with vertices at least every quarter of a metre."""
    sides = np.roll(outline, -1, axis=0) - outline
    steps = np.maximum(np.ceil(np.hypot(*sides.T) / VERTEX_STEP), 1).astype(int)
    side = np.repeat(np.arange(len(outline)), steps)
    share = (np.arange(len(side)) - (np.cumsum(steps) - steps)[side]) * (1 / steps)[side]
    return np.vstack([outline[side] + share[:, None] * sides[side], outline[:1]])
