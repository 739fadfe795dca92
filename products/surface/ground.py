"""The ground of a road in cells along and across it, joined of all passes and scanners, and the profiles across its edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from scipy.ndimage import map_coordinates, maximum_filter, minimum_filter
from scipy.spatial import cKDTree

from ...core.common.parallel import ordered_map
from ...core.common.progress import Progress
from ...core.road.common.pseudo_scanlines import lowest_layers
from ...core.survey.frame.placement import FrameLines
from ...core.survey.frame.road_frame import RoadFrame
from ...core.survey.survey import Survey
from ..inventory.borders import RoadBorders
from ..inventory.surface_grid import CROSS_CELL, ROAD_LAYER_JUMP, SLICE_LENGTH, HeightErrors, height_errors, joined_heights, overlaps_of, surface_grid

READ_SLICES = 20        # cost: slices of ground that are read at once
STANDING_WIDTH = 4.0    # m across: what rises from the ground and is narrower stands on it: vehicles, bins, trunks
STANDING_HEIGHT = 0.25  # m above the ground from which on something stands on it: more than curbs and islands
STEEPEST_GROUND = 0.7   # m/m by which the ground beside the carriageway may rise from its edge: the slope of a bank is 1 : 1.5
SPIKE = 0.05            # m from the median of the cells about it beyond which a cell is no ground: a pole, a foot of a wall
ABOUT_SPIKE = 1, 6      # slices and cells on either side that are about a cell
PROFILE_REACH = 0.6     # m on either side of an edge that its profile shows: gutter, curb and the ground behind it


@dataclass(frozen=True)
class RoadGround:
    """The ground of one road in I slices along it and J cells across it."""

    road: int   # number
    s: np.ndarray   # (I,) m, stations of the middles of the slices, SLICE_LENGTH apart
    d: np.ndarray   # (J,) m, offsets of the middles of the cells, CROSS_CELL apart
    level: np.ndarray   # (I,) local m, the road under the track
    z: np.ndarray   # (I, J) local m; NaN where the ground was not seen, or does not belong to this road
    sigma: np.ndarray   # (I, J) m, of z
    highest: np.ndarray   # (I, J) local z up to which something belongs to the ground
    right: np.ndarray   # right, left: (I,) m, offsets of the edges of the carriageway, between known ones along straight lines
    left: np.ndarray
    points: int   # number of points of the ground
    errors: HeightErrors   # of its passes and scanners, which are taken off

    def at(self, s: np.ndarray, d: np.ndarray, values: np.ndarray | None = None) -> np.ndarray:
        """(N,) local z, or other (I, J) values, at (N,) stations and offsets; NaN where one of the four cells about a place was not seen."""
        rows, columns = (s - self.s[0]) / SLICE_LENGTH, (d - self.d[0]) / CROSS_CELL
        return map_coordinates(self.z if values is None else values, [rows, columns], order=1, cval=np.nan)

    def cells(self, frame: RoadFrame) -> np.ndarray:
        """(N, 3) local places of the cells that were seen, slice by slice."""
        i, j = np.nonzero(np.isfinite(self.z))
        x, y = frame.road(self.road).to_map(self.s[i], self.d[j])
        return np.stack([x, y, self.z[i, j]], axis=1)

    def outline(self, frame: RoadFrame, longest_gap: float) -> shapely.Geometry:
        """Where the ground was seen: a polygon in local coordinates, with gaps along the road up to a length in m closed."""
        seen = np.isfinite(self.z)
        rows = np.flatnonzero(seen.sum(axis=1) > 1)
        low, high = self.d[seen[rows].argmax(axis=1)], self.d[seen.shape[1] - 1 - seen[rows, ::-1].argmax(axis=1)]
        cuts = np.flatnonzero(np.diff(self.s[rows]) > longest_gap) + 1
        rings = []
        for part in np.split(np.arange(len(rows)), cuts):
            if len(part) > 1:
                s, d = np.r_[self.s[rows[part]], self.s[rows[part]][::-1]], np.r_[low[part], high[part][::-1]]
                rings.append(shapely.Polygon(np.stack(frame.road(self.road).to_map(s, d), axis=1)).buffer(0))
        return shapely.union_all(rings)


def road_ground(survey: Survey, road: int, borders: RoadBorders, reach: float, progress: Progress = Progress()) -> RoadGround | None:
    """The ground of a road up to `reach` m beyond the edges of its carriageway; None where no layer says where these are.

    Passes and scanners are freed of the steps and tilts that they show against each other.
    """
    start, end = survey.store.span(road)
    first, last = int(np.ceil(start / SLICE_LENGTH)), int(np.floor(end / SLICE_LENGTH)) - 1
    s = (np.arange(first, last + 1) + 0.5) * SLICE_LENGTH
    if not len(s):
        return None
    right, left = np.array([borders.outer(road, station) for station in s]).T
    if not (np.isfinite(right).any() and np.isfinite(left).any()):
        return None
    right, left = (np.interp(s, s[np.isfinite(edge)], edge[np.isfinite(edge)]) for edge in (right, left))
    offsets = float(np.floor(right.min() - reach)), float(np.ceil(left.max() + reach))

    def read(start):
        grid = surface_grid(survey, road, start, READ_SLICES, offsets)
        # half the memory: heights count from the road and are less than metres
        return replace(grid, height=grid.height.astype(np.float32), count=grid.count.astype(np.uint16)), overlaps_of(grid, int(start))

    read_grids = list(ordered_map(read, np.arange(first, last + 1, READ_SLICES) * SLICE_LENGTH, progress))
    errors = height_errors([overlap for _, overlaps in read_grids for overlap in overlaps], survey.frame.passes)
    z, sigma = [], []
    for grid, _ in read_grids:
        heights, accuracy = joined_heights(grid, errors, survey.frame)
        z.append(heights + grid.line(grid.s)[:, None])
        sigma.append(accuracy)
    d = read_grids[0][0].d
    z, sigma = np.concatenate(z)[:len(s)], np.concatenate(sigma)[:len(s)]
    beyond, level = np.maximum(right[:, None] - d, d - left[:, None]), survey.road_height(road, s)
    # the highest surface below the heights on which nothing narrower stands
    size = 3, int(round(STANDING_WIDTH / CROSS_CELL)) + 1
    lowest = minimum_filter(np.where(np.isfinite(z), z - level[:, None], np.inf), size, mode="nearest")
    envelope = maximum_filter(np.where(np.isfinite(lowest), lowest, -np.inf), size, mode="nearest")
    highest = level[:, None] + envelope + STANDING_HEIGHT + STEEPEST_GROUND * np.maximum(beyond, 0.0)
    z[(beyond > reach) | (z > highest)] = np.nan
    z[np.abs(z - _medians_about(z)) > SPIKE + STEEPEST_GROUND * CROSS_CELL] = np.nan
    points = sum(int(grid.count.sum()) for grid, _ in read_grids)
    return RoadGround(road, s, d, level, z, sigma, highest, right, left, points, errors)


def _medians_about(z):
    """(I, J) medians of the cells about every cell, without NaN."""
    rows, columns = ABOUT_SPIKE
    padded = np.pad(z, ((rows, rows), (columns, columns)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(padded, (2 * rows + 1, 2 * columns + 1))
    # a part at a time: all windows together take many times the memory of the ground
    return np.concatenate([medians(part.reshape(*part.shape[:2], -1))
                           for part in np.array_split(windows, range(READ_SLICES, len(z), READ_SLICES))])


def medians(values: np.ndarray) -> np.ndarray:
    """(...) lower medians along the last axis of (..., N) values, without NaN; NaN where all are."""
    middle = np.maximum((np.isfinite(values).sum(axis=-1) - 1) // 2, 0)
    return np.take_along_axis(np.sort(values, axis=-1), middle[..., None], axis=-1)[..., 0]   # NaN last


def edge_profiles(survey: Survey, ground: RoadGround, lines: FrameLines,
                  progress: Progress = Progress()) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Heights of the ground across edges, at every vertex of their lines.

    lines : of ground.road, with (V,) vertices about a slice apart
    Returns
        u : (K,) m, places of the cells across, left of the line positive
        z : (V, K) local m, medians of the lowest layer about a vertex; NaN where nothing was seen
        normal : (V, 2) unit vectors to the left of the line
    """
    cells = int(round(PROFILE_REACH / CROSS_CELL))
    u = (np.arange(-cells, cells) + 0.5) * CROSS_CELL
    places = np.stack([lines.x, lines.y], axis=1)
    along = np.concatenate([np.empty((0, 2)), *(np.gradient(places[lines.line(k)], axis=0) for k in range(len(lines)))])
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(np.hypot(*along.T), 1e-9)[:, None]
    tree = cKDTree(places)
    span = survey.store.span(ground.road)

    def look(start):
        points = survey.window(ground.road, start, start + READ_SLICES)
        distance, vertex = tree.query(np.stack([points.x, points.y], axis=1), distance_upper_bound=PROFILE_REACH + SLICE_LENGTH / 2)
        near = np.flatnonzero(np.isfinite(distance))
        vertex, points = vertex[near], points[near]
        x, y, z, s, d = points.x, points.y, points.z.copy(), points.s, points.d
        groups = np.stack([points.pass_number, points.scanner], axis=1)
        for number, scanner in np.unique(groups, axis=0).tolist():
            rows = np.flatnonzero((groups == (number, scanner)).all(axis=1))
            track = survey.frame.passes[number].at_station(s[rows])[0]
            z[rows] -= ground.errors.of((number, scanner), s[rows], d[rows] - track)
        across = (x - places[vertex, 0]) * normal[vertex, 0] + (y - places[vertex, 1]) * normal[vertex, 1]
        # as high as it would be at the vertex, where the road climbs
        rise = np.interp(s, ground.s, ground.level) - np.interp(lines.s[vertex], ground.s, ground.level)
        cell = np.floor(across / CROSS_CELL).astype(np.int64) + cells
        i, j = (np.clip(np.rint((values - first) / step).astype(np.int64), 0, count - 1) for values, first, step, count in (
            (s, ground.s[0], SLICE_LENGTH, len(ground.s)), (d, ground.d[0], CROSS_CELL, len(ground.d))))
        inside = (cell >= 0) & (cell < 2 * cells) & (z <= ground.highest[i, j])
        return (vertex * 2 * cells + cell)[inside], (z - rise)[inside].astype(np.float32)

    parts = list(ordered_map(look, np.arange(span[0], span[1], READ_SLICES), progress)) if len(places) else []
    key, z = (np.concatenate([np.empty(0, dtype), *(part[k] for part in parts)]) for k, dtype in ((0, np.int64), (1, np.float32)))
    order = np.lexsort((z, key))
    key, z = key[order], z[order]
    _, first, count = lowest_layers(key, z, ROAD_LAYER_JUMP)
    heights = np.full(len(places) * 2 * cells, np.nan)
    heights[key[first]] = 0.5 * (z[first + (count - 1) // 2] + z[first + count // 2])
    return u, heights.reshape(-1, 2 * cells), normal
