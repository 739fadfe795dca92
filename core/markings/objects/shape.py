"""Length, width, direction and outline of a cluster, measured in the road frame from its points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy import ndimage
from scipy.spatial import cKDTree

from ...common.arrays import order_by
from ...curves.robust import median, percentiles, row_medians
from ...lazy import cv2
from ...survey.frame.road import Road
from ...survey.store.records import COORDINATE_SCALE
from ..road_grid import CELL_SIZE, CELL_UNITS, closed_mask, fill_gaps, filled_between_tracks, occupied, track_reach
from ..weights import SHAPES, ZIGZAG


@dataclass(frozen=True)
class Shape:
    """What a cluster looks like in (s, d); metres, radians."""

    s0: float   # bounds
    s1: float
    d0: float
    d1: float
    offset: float   # median offset
    length: float
    width: float
    direction: float   # 0 along the road, pi/2 across it, within (-pi/2, pi/2]
    area: float   # of its 4 cm cells
    points: int
    begin: float   # offsets of its middle line at s0 and s1 (the median for what is not along the road)
    finish: float
    closed_area: float   # with the gaps between scan lines, of what runs across the road or is small (`area` of the rest)
    stems: tuple   # shares of its length, from s0 on and from s1 back, over which it is a single stroke
    spacing: float = 0.0   # distance between the tracks of the scan that it was seen on, where these are farther apart than cells, else 0
    oblique: tuple[float, float] = (0.0, 0.0)   # how fast these cross it at s0 and at s1, metres across per metre along, 0 where it is not known
    legs: int = 0   # of a zigzag line, 0 of anything else
    sides: tuple[float, float] = (0.0, 0.0)   # of the smallest rectangle about what is small, however it lies, else length and width
    # in local coordinates the sides of the smallest rectangle about what is small, and the middle of its extent; 0 where they are not known
    rectangle: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)

    @property
    def elongation(self) -> float:
        return self.length / max(self.width, 1e-3)

    @property
    def along(self) -> bool:
        return abs(self.direction) <= SHAPES.max_angle_along

    @property
    def across(self) -> bool:
        return abs(self.direction) > SHAPES.min_angle_across


def measure(s: np.ndarray, d: np.ndarray, spacing: np.ndarray | None = None) -> Shape:
    """The Shape of a cluster of N points.

    Width is the 95 % range across the local tangent, scaled to the full range of evenly spread points: a principal axis would call every bend wide.
    `s`, `d` : int, units of 0.1 mm, so that the order of points does not matter. `spacing` : int, mm across the road between the tracks of the scan;
    None where it is not known.
    """
    cells, member = occupied(s // CELL_UNITS, d // CELL_UNITS)
    apart = 0.0
    if spacing is not None and (reach := track_reach(spacing)).any():
        reach_of_cell = np.zeros(len(cells))
        reach_of_cell[member] = reach
        mask, first = filled_between_tracks(cells, reach_of_cell)
        cells, apart = np.argwhere(mask) + first, median(spacing) * 1e-3
    # of the principal axis of the cells
    x, y = (cells - cells[0]).T.astype(float)
    x, y = x - x.mean(), y - y.mean()
    direction = float(0.5 * np.arctan2(2 * (x * y).sum(), (x * x).sum() - (y * y).sum()))
    s0, s1, d0, d1 = s.min(), s.max(), d.min(), d.max()
    if abs(direction) <= SHAPES.max_angle_along and s1 - s0 > 2 * SHAPES.middle_line_step_units:
        length = (s1 - s0) * COORDINATE_SCALE
        nodes, offsets = middle_line(s, d, apart)
        across = d - np.interp(s, nodes, offsets)
        begin, finish = offsets[0] * COORDINATE_SCALE, offsets[-1] * COORDINATE_SCALE
    else:
        c, n = np.cos(direction), np.sin(direction)
        along = s * c + d * n
        length = np.ptp(along) * COORDINATE_SCALE
        across = d * c - s * n
        begin = finish = median(d) * COORDINATE_SCALE
    low, high = percentiles(across, ((100 - SHAPES.width_percent) / 2, (100 + SHAPES.width_percent) / 2))
    width = (high - low) / (SHAPES.width_percent / 100) * COORDINATE_SCALE
    sides = float(length), width
    if max(s1 - s0, d1 - d0) * COORDINATE_SCALE <= SHAPES.small_marking_size:
        sides = smallest_rectangle(cells)
        closed = np.count_nonzero(closed_mask(cells, SHAPES.scan_gaps_of_small)[0])
    else:
        closed = np.count_nonzero(closed_mask(cells, SHAPES.scan_gaps_of_bars)[0]) if abs(direction) > SHAPES.min_angle_across else len(cells)
    area, closed_area = (count * (CELL_UNITS * COORDINATE_SCALE) ** 2 for count in (len(cells), closed))
    return Shape(s0 * COORDINATE_SCALE, s1 * COORDINATE_SCALE, d0 * COORDINATE_SCALE, d1 * COORDINATE_SCALE, median(d) * COORDINATE_SCALE,
                 float(length), width, direction, area, len(s), float(begin), float(finish), closed_area,
                 _stems(cells), apart, _oblique(s, d) if apart else (0.0, 0.0), 0 if apart else zigzag_legs(cells), sides)


def smallest_rectangle(cells: np.ndarray) -> tuple[float, float]:
    """Sides of the smallest rectangle about (K, 2) cells, m."""
    sides = cv2.minAreaRect(cells.astype(np.float32))[1]
    return float((sides[0] + 1.0) * CELL_SIZE), float((sides[1] + 1.0) * CELL_SIZE)


def _stems(cells):
    """Shares of the length, from either end, over which cells reach no farther across than a stroke; wear parts none."""
    step = (cells[:, 0] - cells[:, 0].min()) // SHAPES.stem_step_cells
    count = int(step.max()) + 1
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, step, cells[:, 1])
    np.maximum.at(high, step, cells[:, 1])
    broad = np.flatnonzero(high - low >= SHAPES.stem_breadth_cells)
    return (float(broad[0]) / count, 1.0 - float(broad[-1] + 1) / count) if len(broad) else (1.0, 1.0)


def _oblique(s, d):
    """How fast the tracks cross a cluster at its begin and at its end, from the points there."""
    slopes = []
    for end in (s - s.min() <= SHAPES.end_units, s.max() - s <= SHAPES.end_units):
        along, across = s[end] - s[end].mean(), d[end] - d[end].mean()
        clear = len(along) >= SHAPES.min_end_points and np.ptp(along) >= SHAPES.min_end_units
        slopes.append(abs(float((along * across).sum() / (along * along).sum())) if clear else 0.0)
    return slopes[0], slopes[1]


def middle_line(s: np.ndarray, d: np.ndarray, spacing: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Stations and offsets of the middle line of an elongated cluster, (K,) float each: nodes every 0.5 m, smoothed over 2.5 m.

    Of a line seen on few tracks, each of which shows it at one place of its width, nodes lie ten track spacings apart.
    `s`, `d` : (N,) int, along and across it, units of 0.1 mm; `spacing` : m between the tracks of the scan.
    """
    step = max(SHAPES.middle_line_step_units, int(round(SHAPES.tracks_per_step * spacing / COORDINATE_SCALE)))
    bins = (s - s.min()) // step
    order = order_by(d, bins)
    sorted_bins = bins[order]
    starts = np.flatnonzero(np.append(True, sorted_bins[1:] != sorted_bins[:-1]))
    ends = np.append(starts[1:], len(s))
    count = ends - starts
    # the middle between the outer eighths is steadier than a median where paint is worn on one side
    low, high = d[order[starts + count // 8]], d[order[ends - 1 - count // 8]]
    nodes = s.min() + (sorted_bins[starts] + 0.5) * step
    weight = np.minimum(count, 30).astype(float)
    return nodes, _smooth(nodes, (low + high) / 2, weight, step)


def _smooth(nodes, values, weight, step):
    """A straight line fitted to the five nodes about each, so that ends and slopes stay."""
    if len(values) < 3:
        return np.full(len(values), np.average(values, weights=weight))
    reach = np.arange(-2, 3)
    rows = np.arange(len(values))[:, None] + reach
    inside = (rows >= 0) & (rows < len(values))
    rows = np.clip(rows, 0, len(values) - 1)
    x = nodes[rows] - nodes[:, None]
    w = weight[rows] * inside * (np.abs(x) <= 2.6 * step)
    y = values[rows]
    sw, sx, sy = w.sum(1), (w * x).sum(1), (w * y).sum(1)
    sxx, sxy = (w * x * x).sum(1), (w * x * y).sum(1)
    spread_x = sw * sxx - sx * sx
    steady = spread_x > 1e-6 * sw * sw * step**2
    return np.where(steady, (sxx * sy - sx * sxy) / np.where(steady, spread_x, 1.0), sy / sw)


# Zigzag lines, no stopping before a pedestrian crossing or at a bus stop: straight legs of one length and slope, to the left and to the right in
# turns. Germany, Zeichen 299: at 50 gon (45 degrees) to the road, 1 to 2 m from side to side (RMS part 2, chapter 4.2.1). United Kingdom, diagram
# 1001.3: marks of 2 m, at least 1 m, gaps of 150 mm, 1.979 m along the road and 0.29 m across it, up to 18 (Traffic Signs Manual, chapter 5, 15.17).


def zigzag_legs(cells: np.ndarray) -> int:
    """How many legs a zigzag line has; 0 where cells, (K, 2) int along the road and across it, are no such line."""
    step = (cells[:, 0] - cells[:, 0].min()) // ZIGZAG.step_cells
    length, breadth = (np.ptp(cells, axis=0) + 1) * CELL_SIZE
    if not (ZIGZAG.zigzag_length[0] <= length <= ZIGZAG.zigzag_length[1] and ZIGZAG.zigzag_breadth[0] <= breadth <= ZIGZAG.zigzag_breadth[1]):
        return 0
    count = np.bincount(step)
    painted = count > 0
    if painted.mean() < ZIGZAG.min_steps_seen:
        return 0
    low, high = np.full(len(count), np.inf), np.full(len(count), -np.inf)
    np.minimum.at(low, step, cells[:, 1])
    np.maximum.at(high, step, cells[:, 1])
    thin = painted & (high - low < ZIGZAG.max_stroke / CELL_SIZE)
    if np.count_nonzero(thin) < ZIGZAG.min_thin * np.count_nonzero(painted):
        return 0
    rows = np.flatnonzero(thin)
    along, across = (rows + 0.5) * ZIGZAG.step_cells * CELL_SIZE, (low[rows] + high[rows]) / 2 * CELL_SIZE
    return _legs(along, across)


def _legs(along, across):
    ends = _turns(across)
    if len(ends) <= ZIGZAG.min_legs:
        return 0
    runs, rises, scatter = [], [], []
    for first, last in zip(ends[:-1], ends[1:]):
        u, v = along[first:last + 1], across[first:last + 1]
        if len(u) < 3:
            return 0
        slope, middle = np.polyfit(u - u.mean(), v, 1)
        runs.append(u[-1] - u[0])
        rises.append(slope)
        scatter.append(np.sqrt(np.mean((v - middle - slope * (u - u.mean())) ** 2)))
    runs, rises, scatter = np.array(runs), np.array(rises), np.array(scatter)
    # what is left of a leg at either end may be short
    complete = np.r_[runs[0] >= ZIGZAG.leg_along[0], np.ones(max(len(runs) - 2, 0), bool), runs[-1] >= ZIGZAG.leg_along[0]]
    if np.count_nonzero(complete) < ZIGZAG.min_legs or (np.sign(rises[:-1]) == np.sign(rises[1:])).any():
        return 0
    inner, slopes = runs[1:-1], np.abs(rises[complete])
    even = inner.min() >= ZIGZAG.leg_along[0] and runs.max() <= ZIGZAG.leg_along[1] and inner.max() <= ZIGZAG.max_length_ratio * inner.min() \
        and runs.max() <= ZIGZAG.max_length_ratio * inner.max()
    steep = ZIGZAG.leg_slope[0] <= slopes.min() and slopes.max() <= ZIGZAG.leg_slope[1] and slopes.max() <= ZIGZAG.max_slope_ratio * slopes.min()
    straight = (scatter[complete] <= np.maximum(ZIGZAG.max_off_straight * slopes * runs[complete], ZIGZAG.least_off_straight)).all()
    return int(np.count_nonzero(complete)) if even and steep and straight else 0


def _turns(across):
    """Places where a run turns back by at least `LEAST_TURN`, and its extremes before the first turn and after the last."""
    turns, best, way = [], 0, 0
    lowest = highest = 0
    for k, value in enumerate(across.tolist()):
        if way == 0:
            lowest = k if value < across[lowest] else lowest
            highest = k if value > across[highest] else highest
            if across[highest] - across[lowest] >= ZIGZAG.least_turn:
                way, best = (1, k) if highest > lowest else (-1, k)
                turns.append(lowest if way > 0 else highest)
        elif way * (value - across[best]) >= 0:
            best = k
        elif way * (across[best] - value) >= ZIGZAG.least_turn:
            turns.append(best)
            best, way = k, -way
    return [*turns, best]


# Outlines: the cells that a cluster's points lie in, closed along the road, where scan lines lie apart, and much less across it, where the next
# stripe may begin.


def band(s: np.ndarray, d: np.ndarray, shape: Shape) -> shapely.Polygon:
    """Outline of a strip in (s, d): its middle line, as wide as the whole of it is.

    `s`, `d` : (N,) int, units of 0.1 mm; `shape` : of an elongated cluster along the road, or in any straight direction.
    """
    c, n = (1.0, 0.0) if shape.along else (np.cos(shape.direction), np.sin(shape.direction))
    u, v = (s, d) if shape.along else (np.rint(s * c + d * n).astype(np.int64), np.rint(d * c - s * n).astype(np.int64))
    nodes, offsets = middle_line(u, v, shape.spacing)
    # the last node lies in the middle of a step that the strip may fill to a small part
    along = np.sort(u)
    first, last = along[0] - _beyond_the_last(along), along[-1] + _beyond_the_last(-along[::-1])
    all_nodes = np.concatenate([[first], nodes[nodes < last], [last]])
    offsets, nodes = np.interp(all_nodes, nodes, offsets) * COORDINATE_SCALE, all_nodes * COORDINATE_SCALE
    keep = np.append(True, np.diff(nodes) > 1e-6)
    nodes, offsets = nodes[keep], offsets[keep]
    ring = np.stack([np.concatenate([nodes, nodes[::-1]]),
                     np.concatenate([offsets - shape.width / 2, offsets[::-1] + shape.width / 2])], axis=1)
    return shapely.simplify(shapely.Polygon(ring @ np.array([[c, n], [-n, c]])), SHAPES.strip_tolerance)


def _beyond_the_last(along):
    """How far a strip goes on beyond its first point on average, from (N,) ascending places along it: half the gap that any place of it falls into.

    A gap of length g is met by a share of places that grows with g, and half of it lies beyond.
    """
    gaps = np.diff(along[:np.searchsorted(along, along[0] + SHAPES.end_stretch)])
    gaps = gaps[gaps <= SHAPES.max_end_gap].astype(float)
    return int(round((gaps * gaps).sum() / (2.0 * gaps.sum()))) if gaps.any() else 0


def painted_cells(s: np.ndarray, d: np.ndarray, spacing: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Cells covered by a cluster: (A, B) bool, first axis along the road, and the (2,) int cell number of mask[0, 0].

    `s`, `d` : (N,) metres; `spacing` : (N,) int, mm across the road between the tracks of the scan, None where it is not known.
    """
    cells = np.floor(np.c_[s, d] / CELL_SIZE).astype(np.int64)
    mask, first = filled_between_tracks(cells, track_reach(spacing if spacing is not None else np.zeros(len(cells))))
    mask = fill_gaps(mask, int(round(SHAPES.close_along / CELL_SIZE)), 0)
    mask = fill_gaps(mask, int(round(SHAPES.close_across / CELL_SIZE)), 1)
    return _without_small_holes(mask), first


def _without_small_holes(mask):
    holes, count = ndimage.label(~mask)
    if count > 1:
        sizes = np.bincount(holes.ravel())
        small = sizes * CELL_SIZE**2 < SHAPES.min_hole_area
        small[0] = False
        mask = mask | small[holes]
    return mask


def _cell_outline(mask: np.ndarray, first: np.ndarray) -> shapely.Geometry:
    """Shapely polygon or multipolygon in (s, d) of the cells that are on, its staircase smoothed."""
    edges = np.diff(np.pad(mask, ((1, 1), (0, 0))).astype(np.int8), axis=0)
    column, start = np.nonzero(edges.T == 1)
    _, end = np.nonzero(edges.T == -1)
    boxes = shapely.box((first[0] + start) * CELL_SIZE, (first[1] + column) * CELL_SIZE,
                        (first[0] + end) * CELL_SIZE, (first[1] + column + 1) * CELL_SIZE)
    # cells that touch at a corner only make one polygon after a hair of widening
    shape = shapely.union_all(boxes, grid_size=0.001)
    return shape.simplify(SHAPES.outline_tolerance, preserve_topology=True)


def drawn_outline(columns: Sequence[np.ndarray], look: Shape | np.ndarray | None, road: Road) -> list[shapely.Polygon]:
    """The polygons of one marking in local coordinates, from the road's start on.

    `columns` : s, d, x, y, z, units of 0.1 mm, and spacing, mm between the tracks of the scan: (N,) int each of its points; `look` : the Shape of
    what is drawn as an even strip, (K, 2) m the corners of what has some, None for what is drawn cell by cell.
    """
    s, d, x, y, z, spacing = columns
    points = np.stack([x, y, z], axis=1) * COORDINATE_SCALE
    if isinstance(look, np.ndarray):
        return [lifted(shapely.Polygon(look), points)]
    drawn = band(s, d, look) if look is not None else _cell_outline(*painted_cells(s * COORDINATE_SCALE, d * COORDINATE_SCALE, spacing))
    large = [part for part in getattr(drawn, "geoms", [drawn]) if part.area >= SHAPES.min_part_area]
    return [_to_local(part, road, points) for part in sorted(large, key=lambda part: part.bounds)]


def _to_local(shape: shapely.Polygon, road: Road, places: np.ndarray) -> shapely.Polygon:
    """A polygon in (s, d) in local coordinates, each vertex at the median height of the nearest of the cluster's `places`, (N, 3) m."""
    shape = shapely.segmentize(shape, SHAPES.outline_vertex_spacing)
    vertices = shapely.get_coordinates(shape)
    return lifted(shapely.set_coordinates(shape, np.column_stack(road.to_map(vertices[:, 0], vertices[:, 1]))), places)


def lifted(shape: shapely.Polygon, places: np.ndarray) -> shapely.Polygon:
    """An outline in local coordinates, each vertex at the median height of the points (N, 3) nearest to it."""
    k = min(SHAPES.outline_height_neighbours, len(places))
    vertices = shapely.get_coordinates(shape)
    _, nearest = cKDTree(places[:, :2], balanced_tree=False, compact_nodes=False).query(vertices, k)
    z = row_medians(places[:, 2][nearest.reshape(len(vertices), k)])[:, 0]
    return shapely.set_coordinates(shapely.force_3d(shape), np.c_[vertices, z])
