"""Heights of the road in cells along and across it, apart for every pass and scanner; their errors, and rut depths."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from ...core.common.arrays import order_by
from ...core.road.common.pseudo_scanlines import lowest_layers
from ...core.survey.frame.road_frame import Pass, RoadFrame
from ...core.survey.survey import Survey

SLICE_LENGTH = 1.0        # m along the road over which a transverse profile is averaged
CROSS_CELL = 0.05       # m across the road
ROAD_REACH = 1.5        # m above and below the expected road within which its surface is looked for
ROAD_LAYER_JUMP = 0.05  # m of height between two layers of one cell: the lower one is the road
SCATTER_POINTS = 4        # of a cell, to say how points scatter about its median
SPREAD_SAMPLE = 400       # cells whose scatter tells the noise of a pass and scanner


@dataclass(frozen=True)
class _SurfaceGrid:
    """Heights of a stretch of road in I slices along it and J cells across it, of G groups (pass and scanner)."""

    road: int   # number
    start: float   # start, origin: m, station of the first slice and offset of the first cell
    origin: float
    base: float   # base, slope: m and m/m, the straight line that heights count from: base + slope * (station - start)
    slope: float
    groups: list[tuple[int, int]]   # G pairs (pass number, scanner)
    height: np.ndarray   # (G, I, J) m above the line, median of the lowest layer at the middle of the slice; NaN where there is none
    count: np.ndarray   # (G, I, J) points of the lowest layer
    sigma: np.ndarray   # (G,) m, scatter of a single point about the surface

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


def surface_grid(survey: Survey, road: int, start: float, slices: int, offsets: tuple[float, float]) -> _SurfaceGrid:
    """Read a stretch of a road from a station (m) on, in so many slices of SLICE_LENGTH, between (right, left) offsets (m)."""
    end = start + slices * SLICE_LENGTH
    base, last = survey.road_height(road, np.array([start, end])).tolist()
    slope = (last - base) / (end - start)
    points = survey.window(road, start, end)
    points = points[np.flatnonzero((points.d >= offsets[0]) & (points.d < offsets[1]))]
    columns = max(int(np.ceil((offsets[1] - offsets[0]) / CROSS_CELL)), 1)
    s, d = points.s, points.d
    h = points.z - base - slope * (s - start)
    i = np.floor((s - start) / SLICE_LENGTH).astype(np.int64)
    j = np.floor((d - offsets[0]) / CROSS_CELL).astype(np.int64)
    inside = np.flatnonzero((i >= 0) & (i < slices) & (j >= 0) & (j < columns) & (np.abs(h) < ROAD_REACH))
    cell, h, s = (i * columns + j)[inside], h[inside], s[inside]
    order = order_by(np.rint((h + ROAD_REACH) * 1e4).astype(np.int32), cell)
    cell, h, s, inside = cell[order], h[order], s[order], inside[order]
    ground = np.flatnonzero(lowest_layers(cell, h, ROAD_LAYER_JUMP)[0])
    cell, h, s, inside = cell[ground], h[ground], s[ground], inside[ground]
    key = points.pass_number[inside].astype(np.int64) << 8 | points.scanner[inside]
    values, group = np.unique(key, return_inverse=True)
    groups = [(int(value) >> 8, int(value) & 255) for value in values]
    shape = (len(groups), slices, columns)
    height, count, sigma = np.full(shape, np.nan), np.zeros(shape, np.int32), np.zeros(len(groups))
    ahead = s - start - (cell // columns + 0.5) * SLICE_LENGTH
    group_cell = group.ravel() * (slices * columns) + cell
    h = h - _slope_within(group_cell, ahead, h) * ahead
    order = order_by(np.rint((h + 2 * ROAD_REACH) * 1e4).astype(np.int32), group_cell)
    group_cell, h = group_cell[order], h[order]
    first = np.flatnonzero(np.r_[True, np.diff(group_cell) > 0]) if len(group_cell) else np.empty(0, np.int64)
    n = np.diff(np.r_[first, len(group_cell)])
    middle = 0.5 * (h[first + (n - 1) // 2] + h[first + n // 2])
    owner = group_cell[first]
    count.flat[owner] = n
    height.flat[owner] = middle
    deviation = np.abs(h - np.repeat(middle, n))
    group_number = group_cell // (slices * columns)
    rich = np.repeat(n, n) >= SCATTER_POINTS
    for g in range(len(groups)):
        deviations = deviation[(group_number == g) & rich]
        # mean absolute deviation of a normal distribution: sigma * sqrt(2 / pi), a median's own n costs one degree of freedom
        sigma[g] = np.sqrt(np.pi / 2) * float(np.minimum(deviations, ROAD_LAYER_JUMP).mean()) if len(deviations) else 0.0
    return _SurfaceGrid(road, start, offsets[0], base, slope, groups, height, count, sigma)


def _slope_within(cell, ahead, h):
    """Slope along the road that the points of the cells have in common, beyond that of the line."""
    if len(cell) < SPREAD_SAMPLE:
        return 0.0
    _, owner, n = np.unique(cell, return_inverse=True, return_counts=True)
    owner = owner.ravel()
    x, y = (v - (np.bincount(owner, v) / n)[owner] for v in (ahead, h))
    near = np.abs(y) < ROAD_LAYER_JUMP
    return float((x[near] * y[near]).sum() / max((x[near] ** 2).sum(), 1e-9))


# Errors in height that passes and scanners show against each other, estimated where they overlap.
#
# A scanner that is mounted, or a vehicle that is levelled, a little wrong measures the road too high by a constant and tilted across: ``e = a + b
# (d - t)``, with d the offset of a point and t that of the vehicle. Steps and differences in tilt between two groups (pass and scanner) are
# measured where both saw the road. The tilt has a part that stays with the scanner on its vehicle (boresight): it changes sides with the direction
# of driving, so passes in opposite directions reveal it, and no others do.

MIN_OVERLAP_CELLS = 40         # cells of a window that two groups share, for a step between them
MIN_OVERLAP_POINTS = 3         # of either group in such a cell
MIN_OVERLAP_WIDTH = 1.0        # m across over which they are shared, for a difference in tilt
MAX_STEP = 0.05                # m: what lies farther apart is not the same surface
STEP_SIGMA = 0.0005            # m, of a measured step: texture that the two beams see differently
TILT_SIGMA = 0.0003            # m/m, of a measured difference in tilt over MIN_OVERLAP_WIDTH
STEP_PRIOR, STEP_CHANGE = 0.05, 0.001      # m, the error of a group, and its change from window to window (navigation)
TILT_PRIOR, TILT_CHANGE = 0.0005, 0.0001   # m/m, the same of the tilt: 0.03 degrees of roll, slowly drifting
BORESIGHT_PRIOR = 0.01         # m/m, of a scanner's tilt on its vehicle
STEP_OUTLIER = 0.002           # m of residual at which a step has half its weight (Cauchy)
REWEIGHTINGS = 4
OPPOSITE_WINDOWS = 3           # windows in which opposite passes overlap, before their common tilt counts as known


@dataclass(frozen=True)
class Overlap:
    """What two groups differ by in one window: one less the other."""

    window: int   # number
    one: tuple[int, int]   # one, other: groups (pass number, scanner)
    other: tuple[int, int]
    at: float   # m, offset at which the step counts
    step: float   # m
    tilt: float   # m/m across, NaN where the overlap is too narrow
    width: float   # m across that both saw
    station: float   # m, the middle of the window


@dataclass
class HeightErrors:
    """Errors of every group in every window. step, tilt : (G, W) m and m/m: error = step + tilt * (d - offset of the vehicle)"""

    windows: np.ndarray = field(default_factory=lambda: np.empty(0))   # (W,) m, ascending, middles of the windows
    groups: dict[tuple[int, int], int] = field(default_factory=dict)   # {(pass number, scanner): row}
    step: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))
    tilt: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))
    opposite: bool = False   # whether passes in opposite directions revealed the common tilt
    largest_step: float = 0.0   # m, the median over the windows of the largest step between two groups

    def of(self, group: tuple[int, int], s: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Error of a group, (N,) m, at (N,) stations and `across` m left of its vehicle; 0 where nothing is known of it."""
        row = self.groups.get(group)
        if row is None or not len(self.windows):
            return np.zeros(np.shape(across))
        return np.interp(s, self.windows, self.step[row]) + np.interp(s, self.windows, self.tilt[row]) * across


def overlaps_of(grid: _SurfaceGrid, window: int) -> list[Overlap]:
    """Steps and differences in tilt between the groups of a grid."""
    overlaps = []
    station = float(grid.s.mean())
    for a in range(len(grid.groups)):
        for b in range(a + 1, len(grid.groups)):
            apart = grid.height[a] - grid.height[b]
            _, j = shared = np.nonzero((np.abs(apart) < MAX_STEP) & (np.minimum(grid.count[a], grid.count[b]) >= MIN_OVERLAP_POINTS))
            if len(j) < MIN_OVERLAP_CELLS:
                continue
            values, d = apart[shared], grid.d[j]
            centre, width = float(d.mean()), float(np.ptp(d)) + CROSS_CELL
            step, tilt = _line(d - centre, values)
            overlaps.append(Overlap(window, grid.groups[a], grid.groups[b], centre, step,
                                    tilt if width >= MIN_OVERLAP_WIDTH else np.nan, width, station))
    return overlaps


def _line(x, y):
    """Height at 0 and slope of the line through (N,) values, robust against what only one group saw."""
    weight = np.ones(len(x))
    for _ in range(REWEIGHTINGS):
        mean = np.average(x, weights=weight), np.average(y, weights=weight)
        slope = (weight * (x - mean[0]) * (y - mean[1])).sum() / max((weight * (x - mean[0]) ** 2).sum(), 1e-9)
        level = mean[1] - slope * mean[0]
        residual = y - level - slope * x
        weight = 1.0 / (1.0 + (residual / max(2.0 * float(np.median(np.abs(residual))), STEP_SIGMA)) ** 2)
    return float(level), float(slope)


def height_errors(overlaps: Iterable[Overlap], passes: list[Pass]) -> HeightErrors:
    """The errors that explain the overlaps of one road best: least squares with the priors above, robust against single windows.

    passes : all passes of the survey, by number
    """
    overlaps = list(overlaps)
    if not overlaps:
        return HeightErrors()
    groups = sorted({group for overlap in overlaps for group in (overlap.one, overlap.other)})
    scanners = sorted({scanner for _, scanner in groups})
    numbers, window = np.unique([overlap.window for overlap in overlaps], return_inverse=True)
    stations = np.zeros(len(numbers))
    stations[window.ravel()] = [overlap.station for overlap in overlaps]
    G, W = len(groups), len(numbers)
    direction = np.array([passes[number].direction for number, _ in groups])
    track = np.array([passes[number].at_station(stations)[0] for number, _ in groups])
    steps, tilts, boresight = 0, G * W, 2 * G * W   # where the unknowns of each kind begin
    rows: list[tuple[list[int], list[float], float, float]] = []  # columns, factors, value, sigma
    for overlap, w in zip(overlaps, window.ravel().tolist()):
        a, b = groups.index(overlap.one), groups.index(overlap.other)
        level: tuple[list[int], list[float]] = ([], [])
        tilt: tuple[list[int], list[float]] = ([], [])
        for g, sign in ((a, 1.0), (b, -1.0)):
            arm = overlap.at - track[g, w]
            columns = [steps + g * W + w, tilts + g * W + w, boresight + scanners.index(groups[g][1])]
            level[0].extend(columns)
            level[1].extend([sign, sign * arm, sign * arm * direction[g]])
            tilt[0].extend(columns[1:])
            tilt[1].extend([sign, sign * direction[g]])
        rows.append((*level, overlap.step, STEP_SIGMA))
        if np.isfinite(overlap.tilt):
            rows.append((*tilt, overlap.tilt, TILT_SIGMA * max(MIN_OVERLAP_WIDTH / overlap.width, 0.2)))
    size = 2 * G * W + len(scanners)
    equation = np.repeat(np.arange(len(rows)), [len(row[0]) for row in rows])
    design = sparse.csr_matrix((np.concatenate([row[1] for row in rows]), (equation, np.concatenate([row[0] for row in rows]))), (len(rows), size))
    value, sigma = (np.array([row[k] for row in rows]) for k in (2, 3))
    # what is known beforehand: errors are small, and change little from window to window
    change = sparse.diags([-np.ones(W), np.ones(W)], [0, 1], shape=(max(W - 1, 0), W))
    priors = [sparse.kron(sparse.identity(G), sparse.identity(W) / prior**2 + change.T @ change / drift**2)
              for prior, drift in ((STEP_PRIOR, STEP_CHANGE), (TILT_PRIOR, TILT_CHANGE))]
    known = sparse.block_diag([*priors, sparse.identity(len(scanners)) / BORESIGHT_PRIOR**2])
    weight, x = np.ones(len(rows)), np.zeros(size)
    for _ in range(REWEIGHTINGS):
        precision = sparse.diags(weight / sigma**2)
        x = spsolve((design.T @ precision @ design + known).tocsc(), design.T @ (precision @ value))
        weight = 1.0 / (1.0 + ((design @ x - value) / (STEP_OUTLIER / STEP_SIGMA * sigma)) ** 2)
    boresights = x[boresight + np.searchsorted(scanners, [scanner for _, scanner in groups])]
    tilt_of = x[tilts:boresight].reshape(G, W) + (direction * boresights)[:, None]
    opposite = {overlap.window for overlap in overlaps
                if passes[overlap.one[0]].direction != passes[overlap.other[0]].direction and np.isfinite(overlap.tilt)}
    largest = np.zeros(W)
    np.maximum.at(largest, window.ravel(), np.abs([overlap.step for overlap in overlaps]))
    return HeightErrors(stations, {group: g for g, group in enumerate(groups)}, x[:tilts].reshape(G, W), tilt_of,
                        len(opposite) >= OPPOSITE_WINDOWS, float(np.median(largest)))


def joined_heights(grid: _SurfaceGrid, errors: HeightErrors, frame: RoadFrame) -> tuple[np.ndarray, np.ndarray]:
    """(I, J) heights without the errors of their groups, m above the line of the grid, and their sigmas, m; NaN where nothing was seen."""
    weight = np.zeros(grid.height.shape[1:])
    total = np.zeros_like(weight)
    for g, group in enumerate(grid.groups):
        track = frame.passes[group[0]].at_station(grid.s)[0]
        heights = grid.height[g] - errors.of(group, grid.s[:, None], grid.d - track[:, None])
        precision = np.where(np.isfinite(heights), grid.count[g] / max(grid.sigma[g], 1e-3) ** 2, 0.0)
        total += np.where(precision > 0, heights, 0.0) * precision
        weight += precision
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(weight > 0, total / weight, np.nan), np.where(weight > 0, 1.2533 / np.sqrt(weight), np.nan)


# Rut depth under a straight edge.

EDGE_LENGTH = 2.0           # m of the straight edge (EN 13036-7)
EDGE_STEP = 0.10            # m between the places where it is laid
SMOOTHING_CELLS = 3         # cells of the profile that are averaged: less than the width of a tyre
# slopes against the profile's own of the lines that make its upper hull, m/m: fine where most lie, 0.5 mm of depth at most; coarse up to those of
# the steepest ridges, where a road falls to both sides by as much as it may anywhere (8 %), since there an edge laid oblique would show a rut
FINE_SLOPE, FINE_STEP = 0.03, 0.001
STEEPEST, COARSE_STEP = 0.18, 0.005
MAX_STEP_PER_CELL = 0.02    # m from one cell to the next: more is a curb or an island, on which no edge is laid
MAX_GAP_CELLS = 3           # unseen cells that the edge may bridge
MIN_SEEN = 0.8              # share of the cells under the edge that must be measured
WHEEL_REACH = 0.3           # m that the edge may reach beyond the lane, where the carriageway goes on


def rut_depths(d: np.ndarray, profiles: np.ndarray, lane: tuple[float, float], carriageway: tuple[float, float],
               sigma: np.ndarray) -> np.ndarray:
    """Rut depth of the two wheel paths of a lane: the greatest distance of the profile below the straight edge, less what noise adds.

    The edge is laid over the profile everywhere within the lane. It rests on the upper convex hull of what is under it. Noise lifts the
    largest of n distances by about ``sigma sqrt(2 ln n)``, with sigma that of a smoothed cell, which is subtracted.

    d : (J,) m, offsets of the cells, CROSS_CELL apart, ascending
    profiles : (I, J) m, heights of I profiles; NaN where the road was not seen
    lane, carriageway : (right, left) m, between whose borders the edge is laid
    sigma : (I,) m, of the height of one cell
    Returns (2, I) m, >= 0, of the right and the left wheel path, seen along the road; NaN where the profile has gaps

    Sources: EN 13036-7 (straight edge). Largest of n normal deviates: sigma sqrt(2 ln n), an upper bound of its expectation.
    """
    count = int(round(EDGE_LENGTH / CROSS_CELL)) + 1
    low = max(lane[0] - WHEEL_REACH, carriageway[0])
    high = min(lane[1] + WHEEL_REACH, carriageway[1])
    smooth = smoothed(profiles)
    depths = np.full((2, len(profiles)), np.nan)
    first, last = int(np.searchsorted(d, low)), int(np.searchsorted(d, high)) - count
    if last < first:
        return depths
    middle = 0.5 * (lane[0] + lane[1])
    broken = _breaks(profiles)
    for start in range(first, last + 1, max(int(round(EDGE_STEP / CROSS_CELL)), 1)):
        under, heights = d[start:start + count], smooth[:, start:start + count]
        finite = np.isfinite(heights)
        depth = _hull_height(under, heights) - heights
        depth[(finite.mean(axis=1) < MIN_SEEN) | broken[:, start:start + count].any(axis=1)] = np.nan
        for half, columns in enumerate((under < middle, under >= middle)):
            if columns.any():
                depths[half] = np.fmax(depths[half], np.where(finite[:, columns], depth[:, columns], -np.inf).max(axis=1) + np.where(
                    np.isfinite(depth).any(axis=1), 0.0, np.nan))
    depths[~np.isfinite(depths)] = np.nan
    return np.maximum(depths - largest_noise(sigma), 0.0)


def _breaks(profiles):
    """(I, J) whether the road breaks off beside a cell: at a step up or down, or where too many cells are unseen."""
    breaks = np.zeros(profiles.shape, bool)
    for lag in range(1, MAX_GAP_CELLS + 2):
        apart = np.abs(profiles[:, lag:] - profiles[:, :-lag])
        breaks[:, :profiles.shape[1] - lag] |= apart > MAX_STEP_PER_CELL * lag
    unseen = np.cumsum(np.pad(np.isnan(profiles), ((0, 0), (1, MAX_GAP_CELLS + 1)), constant_values=False), axis=1)
    return breaks | (unseen[:, MAX_GAP_CELLS + 1:-1] - unseen[:, :-MAX_GAP_CELLS - 2] > MAX_GAP_CELLS)


def largest_noise(sigma: np.ndarray) -> np.ndarray:
    """(I,) m that noise of (I,) m in every cell adds to the largest distance below the edge."""
    independent = EDGE_LENGTH / (SMOOTHING_CELLS * CROSS_CELL)
    return np.asarray(sigma) / np.sqrt(SMOOTHING_CELLS) * np.sqrt(2.0 * np.log(independent))


def smoothed(profiles: np.ndarray) -> np.ndarray:
    """(I, J) means over SMOOTHING_CELLS neighbours, across gaps of up to MAX_GAP_CELLS; NaN at wider ones."""
    filled = _bridged(profiles)
    reach = SMOOTHING_CELLS // 2
    padded = np.pad(filled, ((0, 0), (reach, reach)), constant_values=np.nan)
    means = np.lib.stride_tricks.sliding_window_view(padded, SMOOTHING_CELLS, axis=1).mean(axis=2)
    return np.where(np.isnan(means), filled, means)


def _bridged(profiles):
    """Profiles whose short gaps are filled along straight lines."""
    columns = np.arange(profiles.shape[1])
    finite = np.isfinite(profiles)
    before = np.maximum.accumulate(np.where(finite, columns, -1), axis=1)
    after = np.minimum.accumulate(np.where(finite, columns, profiles.shape[1])[:, ::-1], axis=1)[:, ::-1]
    gap = ~finite & (before >= 0) & (after < profiles.shape[1]) & (after - before <= MAX_GAP_CELLS + 1)
    i, j = np.nonzero(gap)
    low, high = before[i, j], after[i, j]
    filled = profiles.copy()
    filled[i, j] = profiles[i, low] + (j - low) / (high - low) * (profiles[i, high] - profiles[i, low])
    return filled


def _hull_height(x: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """(I, K) upper convex hull of I profiles at (K,) x: the lowest of the lines of all slopes that lie on top of a profile.

    NaN heights carry nothing. A profile without heights gives -inf.
    """
    finite = np.isfinite(heights)
    centred = x - x.mean()
    level = np.where(finite, heights, 0.0)
    n = np.maximum(finite.sum(axis=1), 1)
    mean_x, mean_z = (finite * centred).sum(axis=1) / n, level.sum(axis=1) / n
    offset = np.where(finite, centred - mean_x[:, None], 0.0)
    slope = (offset * level).sum(axis=1) / np.maximum((offset**2).sum(axis=1), 1e-9)
    flat = np.where(finite, heights - mean_z[:, None] - slope[:, None] * (centred - mean_x[:, None]), -np.inf)
    steep = np.arange(FINE_SLOPE + COARSE_STEP, STEEPEST + COARSE_STEP / 2, COARSE_STEP)
    slopes = np.r_[-steep, np.arange(-FINE_SLOPE, FINE_SLOPE + FINE_STEP / 2, FINE_STEP), steep]
    top = (flat[:, None, :] - slopes[:, None] * centred).max(axis=2)
    hull = (top[:, :, None] + slopes[:, None] * centred).min(axis=1)
    return hull + mean_z[:, None] + slope[:, None] * (centred - mean_x[:, None])
