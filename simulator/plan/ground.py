"""The ground of a plan: a terrain of gentle slopes, and the strips that rise or fall from it beyond the edges of the carriageway."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ..parts.materials import LABEL
from ..parts.sides import LOWERED_CURB_HEIGHT, Side

EDGE_SPACING = 0.25  # m between vertices of an edge
_LOOKUP = 0.125      # m, cells of the table of nearest vertices: with this spacing the nearest segment ends in the vertex found
_RAMP = 1.0          # m from full to lowered curb


class _Terrain:
    """Heights on a grid, bilinear between its nodes.

    corner : m, local x and y of the first node
    cell : m between nodes
    heights : (R, C) m, rows to the north
    """

    def __init__(self, corner: tuple[float, float], cell: float, heights: np.ndarray):
        self.corner, self.cell, self._shape = corner, cell, heights.shape
        self._heights = np.ascontiguousarray(heights, dtype=float).ravel()
        self.steepest = float(max(np.abs(np.diff(heights, axis=0)).max(), np.abs(np.diff(heights, axis=1)).max()) / cell * np.sqrt(2))

    def at(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Height (m) and slope to the east and to the north (m per m) at (N,) places."""
        rows, columns = self._shape
        u = np.clip((x - self.corner[0]) / self.cell, 0, columns - 1.000001)
        v = np.clip((y - self.corner[1]) / self.cell, 0, rows - 1.000001)
        column, row = u.astype(np.intp), v.astype(np.intp)
        u, v = u - column, v - row
        k = row * columns + column
        a, b = self._heights[k], self._heights[k + 1]
        c, e = self._heights[k + columns], self._heights[k + columns + 1]
        south, north = b - a, e - c
        low, high = a + south * u, c + north * u
        return low + (high - low) * v, (south + (north - south) * v) / self.cell, (high - low) / self.cell


def rings_of(carriageway: shapely.Polygon) -> list[np.ndarray]:
    """Edges of the carriageway as closed rings of evenly spaced vertices, (K, 2) each, the carriageway on their left."""
    area = shapely.geometry.polygon.orient(carriageway, 1.0)
    rings = []
    for ring in (area.exterior, *area.interiors):
        count = max(8, int(round(ring.length / EDGE_SPACING)))
        rings.append(shapely.get_coordinates(shapely.line_interpolate_point(ring, np.arange(count) * ring.length / count)))
    return rings


def curb_heights(places: np.ndarray, height: float, lowered: Sequence[shapely.Polygon]) -> np.ndarray:
    """Heights of a curb at (K, 2) places: lowered within some areas, with a ramp of a metre to them."""
    heights = np.full(len(places), height)
    if len(lowered):
        far = shapely.distance(shapely.points(places), shapely.union_all(list(lowered)))
        way = np.clip(far / _RAMP, 0.0, 1.0)
        heights = np.minimum(heights, LOWERED_CURB_HEIGHT + (height - LOWERED_CURB_HEIGHT) * way * way * (3 - 2 * way))
    return heights


@dataclass
class Surface:
    """The ground at (N,) places."""

    z: np.ndarray   # m
    slope_x: np.ndarray   # slope_x, slope_y: m per m
    slope_y: np.ndarray
    away: np.ndarray   # m beyond the edge of the carriageway, negative on it
    strip: np.ndarray   # int16, 0 on the carriageway, else the number of the strip among those of all profiles, from 1


class Ground:
    """_Terrain, edges of the carriageway and what lies beyond them.

    rings : (K, 2) m, local vertices of each edge, closed, the carriageway on the left
    heights : (K,) m, of the curb at the vertices of each ring
    profiles : strips beyond the edges, each a Side whose first border is 0
    profile_at : (K,) number of the profile at the vertices of each ring
    area : polygon, m, outside of which the ground is the terrain, more or less
    """

    def __init__(self, terrain: _Terrain, rings: Sequence[np.ndarray], heights: Sequence[np.ndarray], profiles: Sequence[Side],
                 profile_at: Sequence[np.ndarray], area: shapely.Polygon):
        self.terrain, self.rings, self.heights, self.profiles, self.profile_at = terrain, rings, heights, profiles, profile_at
        self._from = np.concatenate(rings)
        self._to = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
        self._low = np.concatenate(heights)
        self._rise = np.concatenate([np.roll(height, -1) - height for height in heights])
        self._profile = np.concatenate(profile_at).astype(np.int16)
        starts = np.cumsum([0] + [len(ring) for ring in rings])
        self._before = np.concatenate([start + np.roll(np.arange(len(ring)), 1) for start, ring in zip(starts, rings)])
        self._way = self._to - self._from
        self._length = np.hypot(self._way[:, 0], self._way[:, 1])
        self._first_strip = np.cumsum([1] + [len(profile.strips) for profile in profiles])
        self.labels = np.array([LABEL["road"]] + [LABEL[name] for profile in profiles for name in profile.strips], dtype=np.uint8)
        self._table(area)

    def _table(self, area):
        """The nearest vertex to the middle of each cell in the area."""
        terrain = self.terrain
        rows, columns = (int(np.ceil((count - 1) * terrain.cell / _LOOKUP)) for count in terrain._shape)
        self._shape = rows, columns
        tree = cKDTree(self._from, balanced_tree=False, compact_nodes=False)   # for evenly spaced vertices, found sooner
        x = terrain.corner[0] + (np.arange(columns) + 0.5) * _LOOKUP
        self._nearest = np.zeros(rows * columns, dtype=np.int32)
        shapely.prepare(area)
        for first in range(0, rows, 256):
            y = terrain.corner[1] + (np.arange(first, min(first + 256, rows)) + 0.5) * _LOOKUP
            middles = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
            inside = np.flatnonzero(shapely.contains_xy(area, middles))
            self._nearest[first * columns + inside] = tree.query(middles[inside])[1]

    @property
    def highest(self) -> float:
        """m, the most that anything beyond the edges rises above the terrain."""
        curb = max(float(height.max()) for height in self.heights)
        return max(0.0, *(float((profile.rises + profile.on_curb * curb).max()) for profile in self.profiles)) + 0.01

    def beyond_edge(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """(m beyond the nearest edge, negative on the carriageway; (2, N) direction of their growth; m of its curb; its profile) at (N,) places."""
        rows, columns = self._shape
        column = np.clip(((x - self.terrain.corner[0]) / _LOOKUP).astype(np.intp), 0, columns - 1)
        row = np.clip(((y - self.terrain.corner[1]) / _LOOKUP).astype(np.intp), 0, rows - 1)
        nearest = self._nearest[row * columns + column]
        best = self._to_segment(nearest, x, y)
        previous = self._to_segment(self._before[nearest], x, y)
        nearer = previous[0] < best[0]
        square, dx, dy, along = (np.where(nearer, b, a) for a, b in zip(best, previous))
        segment = np.where(nearer, self._before[nearest], nearest)
        way_x, way_y = self._way[segment, 0], self._way[segment, 1]
        # right of the segment is beyond the edge
        aside = way_y * dx - way_x * dy
        sign = np.where(aside > 0, 1.0, -1.0)
        distance = np.sqrt(square)
        touching = distance < 1e-9
        scale = sign / np.where(touching, 1.0, distance)
        length = self._length[segment]
        outward = np.stack([np.where(touching, way_y / length, dx * scale), np.where(touching, -way_x / length, dy * scale)])
        return sign * distance, outward, self._low[segment] + along * self._rise[segment], self._profile[segment]

    def _to_segment(self, segment, x, y):
        """Square of the distance, vector from the foot, and share along segments."""
        dx, dy = x - self._from[segment, 0], y - self._from[segment, 1]
        way_x, way_y = self._way[segment, 0], self._way[segment, 1]
        along = np.clip((dx * way_x + dy * way_y) / self._length[segment] ** 2, 0.0, 1.0)
        dx, dy = dx - along * way_x, dy - along * way_y
        return dx * dx + dy * dy, dx, dy, along

    def at(self, x: np.ndarray, y: np.ndarray) -> Surface:
        """The ground at (N,) places."""
        z, slope_x, slope_y = self.terrain.at(x, y)
        distance, outward, curb, profile = self.beyond_edge(x, y)
        strip = np.zeros(len(x), dtype=np.int16)
        off_road = np.flatnonzero(distance > 0)
        for number, side in enumerate(self.profiles):
            rows = off_road[profile[off_road] == number] if len(self.profiles) > 1 else off_road
            if len(rows) == 0:
                continue
            far = np.minimum(distance[rows], side.borders[-1])
            k = np.clip(np.searchsorted(side.borders, far, side="right") - 1, 0, len(side.strips) - 1)
            inner = side.rises[k] + side.on_curb[k] * curb[rows]
            steep = (side.rises[k + 1] + side.on_curb[k + 1] * curb[rows] - inner) / (side.borders[k + 1] - side.borders[k])
            z[rows] += inner + steep * (far - side.borders[k])
            slope_x[rows] += steep * outward[0, rows]
            slope_y[rows] += steep * outward[1, rows]
            strip[rows] = self._first_strip[number] + k
        return Surface(z, slope_x, slope_y, distance, strip)

    def height(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Height at (N,) places, m."""
        return self.at(x, y).z


def terrain_over(bounds: tuple[float, float, float, float], height: Callable[[np.ndarray], np.ndarray], cell: float = 0.5) -> _Terrain:
    """The _Terrain of a function of (N, 2) places within (west, south, east, north), m."""
    west, south, east, north = bounds
    x, y = np.arange(west, east + cell, cell), np.arange(south, north + cell, cell)
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return _Terrain((west, south), cell, height(places).reshape(len(y), len(x)))
