"""Heights of the road in cells along and across it, apart for every pass and scanner."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..common.arrays import order_by
from ..road.common.pseudo_scanlines import lowest_layers

if TYPE_CHECKING:
    from ..survey.open_survey import Survey
    from ..survey.store.records import Points

SLICE_LENGTH = 1.0        # m along the road over which a transverse profile is averaged
CROSS_CELL = 0.05       # m across the road
ROAD_REACH = 1.5        # m above and below the expected road within which its surface is looked for
ROAD_LAYER_JUMP = 0.05  # m of height between two layers of one cell: the lower one is the road
SCATTER_POINTS = 4        # of a cell, to say how points scatter about its median
SPREAD_SAMPLE = 400       # cells whose scatter tells the noise of a pass and scanner


@dataclass(frozen=True)
class SurfaceGrid:
    """Heights of a stretch of road in I slices along it and J cells across it, of G groups (pass and scanner).

    road : number
    start, origin : m, station of the first slice and offset of the first cell
    base, slope : m and m/m, the straight line that heights count from: base + slope * (station - start)
    groups : G pairs (pass number, scanner)
    height : (G, I, J) m above the line, median of the lowest layer at the middle of the slice; NaN where there is none
    count : (G, I, J) points of the lowest layer
    sigma : (G,) m, scatter of a single point about the surface
    """

    road: int
    start: float
    origin: float
    base: float
    slope: float
    groups: list[tuple[int, int]]
    height: np.ndarray
    count: np.ndarray
    sigma: np.ndarray

    @property
    def d(self) -> np.ndarray:
        """(J,) offsets of the middles of the cells, m."""
        return self.origin + (np.arange(self.height.shape[2]) + 0.5) * CROSS_CELL

    @property
    def s(self) -> np.ndarray:
        """(I,) stations of the middles of the slices, m."""
        return self.start + (np.arange(self.height.shape[1]) + 0.5) * SLICE_LENGTH

    def line(self, s: np.ndarray) -> np.ndarray:
        """Local z of the line that heights count from, (N,) m at (N,) stations."""
        return self.base + self.slope * (np.asarray(s) - self.start)


def surface_grid(survey: Survey, road: int, start: float, slices: int, offsets: tuple[float, float]) -> SurfaceGrid:
    """Read a stretch of road.

    Parameters
    ----------
    survey : Survey
    road : number
    start : m, station of the first slice
    slices : number of slices, SLICE_LENGTH each
    offsets : (right, left) m between which the road is looked at
    """
    end = start + slices * SLICE_LENGTH
    first, last = survey.road_height(road, np.array([start, end]))
    slope = float(last - first) / (end - start)
    points = survey.window(road, start, end)
    d = points.d
    near = np.flatnonzero((d >= offsets[0]) & (d < offsets[1]))
    return grid_of_points(points[near], road, start, slices, offsets, float(first), slope)


def grid_of_points(points: Points, road: int, start: float, slices: int, offsets: tuple[float, float], base: float,
                   slope: float) -> SurfaceGrid:
    """SurfaceGrid of points.

    Parameters
    ----------
    points : (N,) Points of the stretch
    road, start, slices, offsets : as in `surface_grid`
    base, slope : m and m/m, the line that heights count from
    """
    columns = max(int(np.ceil((offsets[1] - offsets[0]) / CROSS_CELL)), 1)
    s, d = points.s, points.d
    h = points.z - base - slope * (s - start)
    i = np.floor((s - start) / SLICE_LENGTH).astype(np.int64)
    j = np.floor((d - offsets[0]) / CROSS_CELL).astype(np.int64)
    inside = np.flatnonzero((i >= 0) & (i < slices) & (j >= 0) & (j < columns) & (np.abs(h) < ROAD_REACH))
    place, h, s = (i * columns + j)[inside], h[inside], s[inside]
    order = order_by(np.rint((h + ROAD_REACH) * 1e4).astype(np.int32), place)
    place, h, s, inside = place[order], h[order], s[order], inside[order]
    ground = np.flatnonzero(lowest_layers(place, h, ROAD_LAYER_JUMP)[0])
    place, h, s, inside = place[ground], h[ground], s[ground], inside[ground]
    key = points.pass_number[inside].astype(np.int64) << 8 | points.scanner[inside]
    values, group = np.unique(key, return_inverse=True)
    groups = [(int(value) >> 8, int(value) & 255) for value in values]
    shape = (len(groups), slices, columns)
    height, count, sigma = np.full(shape, np.nan), np.zeros(shape, np.int32), np.zeros(len(groups))
    ahead = s - start - (place // columns + 0.5) * SLICE_LENGTH
    cell = group.ravel() * (slices * columns) + place
    h = h - _slope_within(cell, ahead, h) * ahead
    order = order_by(np.rint((h + 2 * ROAD_REACH) * 1e4).astype(np.int32), cell)
    cell, h = cell[order], h[order]
    first = np.flatnonzero(np.r_[True, np.diff(cell) > 0]) if len(cell) else np.empty(0, np.int64)
    n = np.diff(np.r_[first, len(cell)])
    middle = 0.5 * (h[first + (n - 1) // 2] + h[first + n // 2])
    owner = cell[first]
    count.flat[owner] = n
    height.flat[owner] = middle
    off = np.abs(h - np.repeat(middle, n))
    of = cell // (slices * columns)
    rich = np.repeat(n, n) >= SCATTER_POINTS
    for g in range(len(groups)):
        own = off[(of == g) & rich]
        # mean absolute deviation of a normal distribution: sigma * sqrt(2 / pi), a median's own n costs one degree of freedom
        sigma[g] = np.sqrt(np.pi / 2) * float(np.minimum(own, ROAD_LAYER_JUMP).mean()) if len(own) else 0.0
    return SurfaceGrid(road, start, offsets[0], base, slope, groups, height, count, sigma)


def _slope_within(cell, ahead, h):
    """Slope along the road that the points of the cells have in common, beyond that of the line."""
    if len(cell) < SPREAD_SAMPLE:
        return 0.0
    _, of, n = np.unique(cell, return_inverse=True, return_counts=True)
    of = of.ravel()
    x, y = (v - (np.bincount(of, v) / n)[of] for v in (ahead, h))
    near = np.abs(y) < ROAD_LAYER_JUMP
    return float((x[near] * y[near]).sum() / max((x[near] ** 2).sum(), 1e-9))
