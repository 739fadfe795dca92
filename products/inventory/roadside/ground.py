"""The ground beside the road: what is left when everything that stands on it is taken away; what the scanners saw of it, and gutters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import grey_opening, median_filter, minimum_filter1d

from ....core.common.arrays import order_by
from ....core.road.common.pseudo_scanlines import lowest_layers
from ....core.survey.weights import READING
from ..surface_grid import CROSS_CELL, SLICE_LENGTH, SurfaceGrid, smoothed, surface_grid
from .uprights import TOP_BINS, UPRIGHT_SLICE, Uprights

if TYPE_CHECKING:
    from collections.abc import Callable

    from ....core.survey.survey import Survey

GROUND_SLICE, GROUND_CELL = 1.0, 0.20   # m along and across
STANDING_WIDTH = 2.5      # m: narrower humps of the lowest layer stand on the ground (parked cars, hedges)
GROUND_SHARE = 0.1        # quantile of the lowest layer: at the foot of a wall it reaches up the face
GROUND_JUMP = 0.10        # m of height between two layers
MIN_GROUND_POINTS = 3     # of a lowest layer, with those as high in the slices before and after it
UNSEEN_REACH = 1.0        # m across a gap in the ground that is bridged
FOOT_REACH = 0.4          # m across from a face, within which the ground lies at its foot
SHADOW_SLICES = 3          # slices along within which the foot of a face is seen that a shadow hides
RIM_STEP = 0.3            # m of height within a cell from which it holds a face; between neighbouring cells, from which the higher one stands on the
#                           ground, where nothing was seen beyond it


@dataclass(frozen=True)
class _LocalGround:
    """Heights of the ground in cells of a stretch of road."""

    start: float   # start, origin: m, station and offset of the corner
    origin: float
    height: np.ndarray   # (I, J) m above the line that the points' heights count from; NaN where the ground is not known

    def at(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) heights of the ground at (N,) stations and offsets; NaN where it is not known."""
        i = np.clip(np.floor((s - self.start) / GROUND_SLICE).astype(np.int64), 0, self.height.shape[0] - 1)
        column = np.clip((d - self.origin) / GROUND_CELL - 0.5, 0.0, self.height.shape[1] - 1.0)
        j = np.minimum(column.astype(np.int64), self.height.shape[1] - 2)
        low, high = self.height[i, j], self.height[i, j + 1]
        between = low + (column - j) * (high - low)
        return np.where(np.isfinite(between), between, np.where(np.isfinite(low), low, high))


def local_ground(s: np.ndarray, d: np.ndarray, h: np.ndarray, start: float, slices: int, offsets: tuple[float, float]) -> _LocalGround:
    """The ground under points.

    s, d, h : (N,) m, stations, offsets and heights above the expected road
    start : m, station of the first slice
    slices : number of slices along the road
    offsets : (right, left) m
    """
    columns = max(int(np.ceil((offsets[1] - offsets[0]) / GROUND_CELL)), 2)
    i, j = np.floor((s - start) / GROUND_SLICE).astype(np.int64), np.floor((d - offsets[0]) / GROUND_CELL).astype(np.int64)
    inside = np.flatnonzero((i >= 0) & (i < slices) & (j >= 0) & (j < columns))
    cell, h = (i * columns + j)[inside], h[inside]
    order = order_by(np.rint((h + 100.0) * 1e3).astype(np.int32), cell)
    cell, h = cell[order], h[order]
    _, first, count = lowest_layers(cell, h, GROUND_JUMP)
    solid = _supported(cell[first], h[first], count, (slices, columns))
    first, count = first[solid], count[solid]
    low, least = np.full((2, slices, columns), np.nan)
    low.flat[cell[first]] = h[first + np.rint(GROUND_SHARE * (count - 1)).astype(np.int64)]
    least.flat[cell[first]] = h[first + np.minimum(count, MIN_GROUND_POINTS) - 1]
    face = np.zeros((slices, columns), bool)
    face.flat[cell[first]] = h[first + count - 1] - h[first] > RIM_STEP
    low = _feet_in_shadow(_feet_beside(low, face), least)
    filled = _filled(low)
    low = _let_down(filled, _rims(low) | _rims(filled))
    finite = np.isfinite(low)
    if not finite.any():
        return _LocalGround(start, offsets[0], low)
    # beyond what is known the ground neither rises nor falls
    level = np.where(finite, low, np.inf)
    cells = int(round(STANDING_WIDTH / GROUND_CELL)) | 1
    smooth = median_filter(np.where(finite, level, 1e3), size=(3, 1), mode="nearest")
    opened = grey_opening(np.where(smooth > 500.0, level.clip(max=1e3), smooth), size=(1, cells), mode="nearest")
    ground = np.where(finite & (opened < 500.0), opened, np.nan)
    return _LocalGround(start, offsets[0], _let_down(ground, smooth - ground > RIM_STEP))


def _supported(place, height, count, shape):
    """(L,) bool, which lowest layers have enough points together with those of the slices before and after at their height."""
    number, lowest = np.zeros(shape), np.full(shape, np.nan)
    number.flat[place], lowest.flat[place] = count, height
    number, lowest = np.pad(number, ((1, 1), (0, 0))), np.pad(lowest, ((1, 1), (0, 0)), constant_values=np.nan)
    support = number[1:-1].copy()
    for neighbour in (slice(None, -2), slice(2, None)):
        support += np.where(np.abs(lowest[neighbour] - lowest[1:-1]) < GROUND_JUMP, number[neighbour], 0.0)
    return support.flat[place] >= MIN_GROUND_POINTS


def _feet_beside(low, face):
    """Heights where the foot of a face is no higher than the ground beside it."""
    return np.where(face, np.fmin(low, _continued(np.where(face, np.nan, low), FOOT_REACH)), low)


def _feet_in_shadow(low, least):
    """Heights where the foot of a face that a shadow hides, as of a parked car, is the least that nearby slices see of it."""
    padded = np.pad(low, ((0, 0), (1, 1)), constant_values=np.nan)
    right, left = padded[:, :-2], padded[:, 2:]
    with np.errstate(invalid="ignore"):
        shadowed = np.isnan(right) & ~(left - low < RIM_STEP) | np.isnan(left) & ~(right - low < RIM_STEP)
    lowest = np.where(np.isnan(low), np.inf, np.where(shadowed, least, low))
    foot = minimum_filter1d(lowest, 2 * SHADOW_SLICES + 1, axis=0, mode="constant", cval=np.inf)
    return np.where(shadowed & (low - foot > GROUND_JUMP), foot, low)


def _filled(low):
    """Gaps across of up to UNSEEN_REACH to either side take the lower of their two ends."""
    left, right = low.copy(), low.copy()
    for _ in range(int(round(UNSEEN_REACH / GROUND_CELL))):
        left[:, 1:] = np.where(np.isnan(left[:, 1:]), left[:, :-1], left[:, 1:])
        right[:, :-1] = np.where(np.isnan(right[:, :-1]), right[:, 1:], right[:, :-1])
    return np.where(np.isnan(low), np.fmin(left, right), low)


def _let_down(low, standing):
    """Heights where what stands has that of the ground beside it; the cells beside it may hold the foot of its face, and are let down too."""
    padded = np.pad(standing, ((0, 0), (1, 1)))
    standing = (standing | padded[:, :-2] | padded[:, 2:]) & np.isfinite(low)
    return np.where(standing, _continued(np.where(standing, np.nan, low), STANDING_WIDTH), low)


def _continued(low, reach):
    """Gaps across take the height of the nearest cell within `reach` (m), of two as near the lower one."""
    low = low.copy()
    for _ in range(int(round(reach / GROUND_CELL))):
        padded = np.pad(low, ((0, 0), (1, 1)), constant_values=np.nan)
        low = np.where(np.isnan(low), np.fmin(padded[:, :-2], padded[:, 2:]), low)
    return low


def _rims(low):
    """(I, J) narrow tops beyond which nothing was seen, as of a wall that hides what lies behind it."""
    rows, columns = low.shape
    cells = np.column_stack([np.full(rows, np.nan), low]).ravel()   # a gap between the rows
    finite = np.isfinite(cells)
    step = np.diff(cells, append=np.nan)
    with np.errstate(invalid="ignore"):
        breaks = ~(np.abs(step) < RIM_STEP)          # after a cell: a step, or nothing known on one side
        up, down = step >= RIM_STEP, step <= -RIM_STEP
    group = np.cumsum(np.r_[True, breaks[:-1]]) - 1
    first = np.flatnonzero(np.r_[True, breaks[:-1]])
    last = np.r_[first[1:] - 1, len(cells) - 1]
    unseen = ~finite
    before, after = np.maximum(first - 1, 0), np.minimum(last + 1, len(cells) - 1)
    rim = up[before] & unseen[after] | down[last] & unseen[before]
    standing = rim & finite[first] & ((last - first + 1) * GROUND_CELL < STANDING_WIDTH)
    return standing[group].reshape(rows, columns + 1)[:, 1:]


# What the scanners could see: lines of sight, and whether their view ends a little above and below the horizon, as that of a many-beam head does.

VIEW_SAMPLE_LENGTH, VIEW_SAMPLES = 4.0, 25   # m of road, and number, of the windows of each road in which the highest view is looked for
LEAST_RANGE = 3.0          # m from the scanner: nearer, a centimetre turns the line of sight too much
HIGHEST_SHARE = 0.999      # of the lines of sight by their slope: single points astray lie above, and as few below the steepest
LEVEL_VIEW = 0.10          # m per m: heads of many beams see up to 0.03 (+2 degrees, Velodyne HDL-64E), and the vehicle tilts; mirrors see all round
STEEPEST_VIEW = 0.70       # m per m down: such heads see 0.46 (-25 degrees) or 0.58 (-30), mirrors 0.9 and more beside the vehicle


def lines_of_sight(survey: Survey, road: int, number: int, s: np.ndarray, d: np.ndarray, h: np.ndarray,
                   time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal vectors from points of a pass to the scanner, and how much higher the scanner is.

    road, number : of the road and of the pass
    s, d, h : (N,) m, station, offset, and height above the road
    time : (N,) s
    Returns (2, N) m ahead and left along the road, and (N,) m
    """
    driven, line = survey.frame.passes[number], survey.frame.road(road)
    x, y = line.to_map(s, d)
    eye_x, eye_y = driven.at(time, "x", "y") if survey.frame.has_time else line.to_map(s, driven.at_station(s)[0])
    heading = line.heading(s)
    ahead, left = np.cos(heading), np.sin(heading)
    dx, dy = eye_x - x, eye_y - y
    return np.stack([dx * ahead + dy * left, dy * ahead - dx * left]), survey.sensor_height.get(number, READING.default_sensor_height) - h


def level_views(survey: Survey) -> dict[int, float]:
    """The passes whose scanner sees hardly higher than it rides, so that it does not show how high anything is that is as high.

    In open country nothing stands that a mirror could see above it. That its view ends is told by the ground beside the vehicle, which only a
    mirror sees; without times, which tell where the scanner was, nothing high is taken for a view that ends.

    Returns {number of the pass: m above the road, height of its scanner}
    """
    slopes: dict[int, list[np.ndarray]] = {}
    far: dict[int, list[np.ndarray]] = {}
    for road in survey.store.roads():
        first, last = survey.store.span(road)
        for start in np.linspace(first, max(last - VIEW_SAMPLE_LENGTH, first), VIEW_SAMPLES):
            points = survey.window(road, start, start + VIEW_SAMPLE_LENGTH)
            h = points.z - survey.road_height(road, points.s)
            for number in np.unique(points.pass_number).tolist():
                rows = points.pass_number == number
                across, up = lines_of_sight(survey, road, number, points.s[rows], points.d[rows], h[rows], points.time[rows])
                distance = np.hypot(*across)
                slope = -up / np.maximum(distance, 1e-3)
                slopes.setdefault(number, []).append(slope)
                far.setdefault(number, []).append(slope[distance > LEAST_RANGE])
    return {number: float(survey.sensor_height.get(number, READING.default_sensor_height)) for number in slopes if _is_level(
        np.concatenate(far[number]), np.concatenate(slopes[number]), survey.frame.has_time)}


def _is_level(far, all_slopes, has_time):
    """Whether slopes of lines of sight to what is far, and to everything, end a little above and below the horizon."""
    if not len(far) or np.quantile(far, HIGHEST_SHARE) >= LEVEL_VIEW:
        return False
    return not has_time or np.quantile(all_slopes, 1.0 - HIGHEST_SHARE) > -STEEPEST_VIEW


# Gutters: the lines of lowest points beside the carriageway's edge, where water runs.

GUTTER_INSIDE, GUTTER_OUTSIDE = 0.80, 0.15  # m from the edge, within which the lowest point is looked for
OUTER_RISE, OUTER_REACH = 0.02, 0.40        # m that the ground rises outward of a gutter, and within how many
INNER_RISE, INNER_REACH = 0.008, 0.50       # m that the road rises inward of it: 1.6 % fall towards the gutter
READ_BEYOND = 0.60                          # m beyond the edge that are read


def find_gutters(survey: Survey, road: int, start: float, slices: int, side: int, edge: Callable[[np.ndarray], np.ndarray]) -> Uprights:
    """The lowest points of one side of a stretch of road, where water runs along its edge.

    Parameters
    ----------
    survey, road : where
    start, slices : m, station of the first slice, and their number
    side : 1 left, -1 right
    edge : function of stations that gives the offset of the edge of that side

    Returns Uprights whose `top` is how deep the gutter lies below its outer side; one for each UPRIGHT_SLICE
    """
    s = start + (np.arange(slices) + 0.5) * SLICE_LENGTH
    edges = edge(s)
    ends = np.array([edges - side * (GUTTER_INSIDE + INNER_REACH), edges + side * READ_BEYOND])
    grid = surface_grid(survey, road, start, slices, (float(np.floor(ends.min() / CROSS_CELL) * CROSS_CELL), float(ends.max())))
    if not len(grid.groups):
        return Uprights.none()
    profile = smoothed(_mean(grid))
    u = side * (grid.d - edges[:, None])
    searched = (u > -GUTTER_INSIDE) & (u < GUTTER_OUTSIDE) & np.isfinite(profile)
    lowest = np.where(searched, profile, np.inf)
    j = np.argmin(lowest, axis=1)
    rows = np.arange(slices)
    low, offset = lowest[rows, j], u[rows, j]
    beyond = u - offset[:, None]
    outer, inner = (np.where((beyond * way > 0) & (beyond * way < reach) & np.isfinite(profile), profile, -np.inf).max(axis=1)
                    for way, reach in ((1, OUTER_REACH), (-1, INNER_REACH)))
    # water stays where the ground rises outward from the lowest point on: a verge that falls on is none
    falls_on = np.where((beyond > 0) & (beyond < OUTER_REACH) & np.isfinite(profile), profile, np.inf).min(axis=1) < low
    gutters = np.flatnonzero(np.isfinite(low) & (outer - low > OUTER_RISE) & (inner - low > INNER_RISE) & ~falls_on)
    # a slice of the surface holds several of those along which lines are followed
    times = int(round(SLICE_LENGTH / UPRIGHT_SLICE))
    gutters = np.repeat(gutters, times)
    number = np.floor(s[gutters] / SLICE_LENGTH).astype(np.int64) * times + np.tile(np.arange(times), len(gutters) // times)
    zero = np.zeros(len(gutters))
    return Uprights(number, grid.d[j[gutters]], low[gutters] + grid.line(s[gutters]), (outer - low)[gutters], zero,
                    np.zeros((len(gutters), TOP_BINS)), zero, zero, zero + 1.0, zero, zero > 0, zero)


def _mean(grid: SurfaceGrid) -> np.ndarray:
    """(I, J) heights of all passes and scanners together, by their numbers of points; NaN where there are none."""
    count = np.where(np.isfinite(grid.height), grid.count, 0)
    total = (np.nan_to_num(grid.height) * count).sum(axis=0)
    n = count.sum(axis=0)
    return np.where(n > 0, total / np.maximum(n, 1), np.nan)


