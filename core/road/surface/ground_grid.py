"""The ground in cells of station and offset: height, roughness and brightness of the lowest layer of points.

Parked cars, branches and signs lie above the lowest layer. The cells are the input of the road's height
(`region_growing`) and of its limits (`pavement_edge`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import compress, islice
from typing import Any

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import uniform_filter1d

from ...common.arrays import order_by
from ...execution.in_step import Asked, Work, in_step
from ...execution.phase import Phase
from ...survey.open_survey import Survey
from ...survey.store.array_file import ArrayPlace, SharedArrays
from ...survey.store.records import COORDINATE_SCALE, Points
from ...survey.weights import FRAME
from ..common.pseudo_scanlines import lowest_layers
from ..common.sides import ahead_of_vehicle
from ..weights import CURBS, SURFACE

GOLDEN_RATIO_32 = 0x9E3779B9   # source: golden ratio times 2^32; its multiples, modulo 2^32, are evenly distributed (Knuth, TAOCP 3, 6.4)


@dataclass
class SurfaceProfiles:
    """The ground across the road: P rows of 1 m length with K cells of 0.1 m."""

    stations: np.ndarray   # (P,) m, middles of the rows
    offsets: np.ndarray   # (K,) m, middles of the cells, ascending
    height: np.ndarray   # (P, K) m above the expected height of the road under the vehicle
    rough: np.ndarray   # (P, K) m, of few points, too: see `roughness_of_rows`
    brightness: np.ndarray   # brightness, scatter: (P, K) counts, as in GroundCells; NaN where nothing was measured
    scatter: np.ndarray
    count: np.ndarray   # count, freedom: (P, K), as in GroundCells
    freedom: np.ndarray

    NAMES = ("height", "rough", "brightness", "scatter", "count", "freedom")

    def side(self, sign: int | float) -> SurfaceProfiles:
        """The cells of one side, 1 left or -1 right, outward from the reference line, as views; offsets count outward."""
        middle = int(np.searchsorted(self.offsets, 0.0))
        outward = slice(middle, None) if sign > 0 else slice(middle - 1, None, -1)
        return SurfaceProfiles(self.stations, sign * self.offsets[outward], *(getattr(self, name)[:, outward] for name in self.NAMES))


@dataclass
class GroundCells:
    """Ground on a grid of R rows of station and C columns of offset.

    Row k begins at station row_size * (first_row + k), column j at offset column_size * (first_column + j).

    rough : (R, C) float32 m, standard deviation about the plane of the cell, each view (a scanner on a pass) at its own level; NaN where it has
        no plane
    brightness : (R, C) float32 counts, median intensity, all scanners and passes at one level; NaN where there is no ground or it was not asked for
    """

    first_row: int   # first_row, first_column: numbers of the first row and column
    first_column: int
    row_size: float   # row_size, column_size: m
    column_size: float
    height: np.ndarray   # (R, C) float32 m, local z at the middle of a cell; NaN where there is no ground
    rough: np.ndarray
    brightness: np.ndarray
    scatter: np.ndarray   # (R, C) float32 counts, standard deviation of those intensities, estimated from the lower quartile
    count: np.ndarray   # (R, C) float32, points of the lowest layer
    freedom: np.ndarray   # (R, C) float32, degrees of freedom of the roughness, 0 where it is NaN

    @property
    def stations(self) -> np.ndarray:
        """(R,) m, stations of the middles of the rows."""
        return (self.first_row + np.arange(len(self.height)) + 0.5) * self.row_size

    @property
    def offsets(self) -> np.ndarray:
        """(C,) m, offsets of the middles of the columns."""
        return (self.first_column + np.arange(self.height.shape[1]) + 0.5) * self.column_size

    def at(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rows and columns at stations and offsets, m, 0 beyond the cells; and whether they lie within. All of the shape of `s` with `d`."""
        row, column = np.floor(s / self.row_size) - self.first_row, np.floor(d / self.column_size) - self.first_column
        inside = (row >= 0) & (row < self.height.shape[0]) & (column >= 0) & (column < self.height.shape[1])   # NaN is not inside
        return *(np.where(inside, number, 0).astype(np.int64) for number in (row, column)), inside


def known_median(values: np.ndarray, axis: int) -> np.ndarray:
    """Median along an axis without the NaN; NaN where all values are NaN.

    Unlike `numpy.nanmedian` it raises no warning, so it can run in worker threads.

    values : array of floats
    axis : to be reduced

    Returns array of floats without that axis
    """
    ordered = np.sort(values, axis=axis)
    count = np.isfinite(ordered).sum(axis=axis, keepdims=True)
    low = np.take_along_axis(ordered, np.maximum(count - 1, 0) // 2, axis)
    high = np.take_along_axis(ordered, count // 2 * (count > 0) - (count // 2 >= ordered.shape[axis]), axis)
    return np.squeeze(0.5 * (low + high), axis)


def is_thin(count: np.ndarray, row_size: float, column_size: float, density: float) -> bool:
    """Do even the densest CURBS.thin_width metres across, as beside the track, hold few points in most of the rows that hold any?

    count : (R, C) points of cells that are `row_size` m along and `column_size` m across the road
    density : points per m² that are not few
    """
    rows = uniform_filter1d(count[count.any(axis=1)].astype(float), round(CURBS.thin_width / column_size), axis=1, mode="constant")
    return not len(rows) or np.quantile(rows, 0.75, axis=0).max() < density * row_size * column_size


def median_about(values: np.ndarray, reach: int) -> np.ndarray:
    """`known_median` of the rows from `reach` before to `reach` behind each one; of one shape with `values`, (R, ...) floats."""
    padded = np.pad(values, [(reach, reach), *[(0, 0)] * (values.ndim - 1)], constant_values=np.nan)
    return known_median(np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=0), -1)


def sum_about(values: np.ndarray, reach: int) -> np.ndarray:
    """Sum of the rows from `reach` before to `reach` behind each one; of one shape with `values`, (R, ...)."""
    return uniform_filter1d(values.astype(float), 2 * reach + 1, axis=0, mode="constant") * (2 * reach + 1)


def roughness_of_rows(rough: np.ndarray, freedom: np.ndarray, median: Callable[[np.ndarray], np.ndarray],
                      total: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Roughness of several rows of cells: the median of those with enough points for one of their own, else that of all their points together.

    rough, freedom : (P, K), as in SurfaceProfiles
    median, total : give median and sum of such values over those rows; NaN counts for nothing in the median

    Returns (Q, K) m, NaN where even all points are too few
    """
    freedom = np.nan_to_num(freedom)
    of_rows, together = median(np.where(freedom >= SURFACE.min_freedom, rough, np.nan)), total(freedom)
    pooled = np.sqrt(np.maximum(total(np.nan_to_num(rough)**2 * freedom), 0.0) / np.maximum(together, SURFACE.min_freedom))
    return np.where(np.isfinite(of_rows) | (together < SURFACE.min_freedom - 0.5), of_rows, pooled)


def _ground_columns(column_size: float) -> int:
    """Columns of ground cells on either side of the reference line."""
    return int(np.ceil(FRAME.corridor / column_size))


def _ground_cells(points: Points, first_row: int, rows: int, road_height: Callable[[np.ndarray], np.ndarray],
                 row_size: float = SURFACE.row_length, column_size: float = SURFACE.column_width,
                 bright: Callable[[Points], np.ndarray] | None = None, least: int = SURFACE.min_freedom) -> GroundCells:
    """The ground cells of a window of the road.

    points : Points of the window
    first_row, rows : number of the first row, and count of rows
    road_height : function of (N,) stations in m; (N,) local z of the road under the vehicle, accurate to decimetres
    row_size, column_size : m along and across the road
    bright : function of N Points; (N,) bool of those whose intensity counts. None where brightness and scatter are not wanted
    least : degrees of freedom of a roughness that is given
    """
    half = _ground_columns(column_size)
    columns = 2 * half
    prior = road_height((first_row + np.arange(rows) + 0.5) * row_size)
    index, cell = _near_ground(points.records, first_row, rows, half, prior, row_size, column_size)
    z = points.records["z"].take(index)
    order = order_by(z, cell)
    index, cell, z = index[order], cell[order], z[order] * COORDINATE_SCALE
    lowest, first, size = lowest_layers(cell, z, SURFACE.ground_layer_jump, SURFACE.min_layer_share, SURFACE.min_layer_points)
    # a wall is one layer up to its top
    low = np.flatnonzero(lowest)[z[lowest] - np.repeat(z[first], size) < SURFACE.ground_layer_depth]
    index, owner, z = index[low], cell[low].astype(np.intp), z[low]
    count = np.bincount(owner, minlength=rows * columns)
    row, column = np.divmod(np.arange(rows * columns), columns)
    u, v = (points.records[name].take(index) * COORDINATE_SCALE - middle.take(owner) for name, middle in
            (("d", (column - half + 0.5) * column_size), ("s", (row + first_row + 0.5) * row_size)))
    ground, shape = points[index], (rows, columns)
    # few points tell no slope: their mean height is that of the middle of the cell only without the grade of the road
    grade = np.diff(road_height((first_row + np.arange(rows + 1)) * row_size)) / row_size
    z -= v * grade.take(row.take(owner))
    height, rough, freedom = _planes(owner, count, u, v, z, _views(ground), least)
    brightness, scatter = np.full((2, len(count)), np.nan) if bright is None else _looks(ground, owner, shape, column_size, bright)
    return GroundCells(first_row, -half, row_size, column_size,
                 *(values.reshape(shape).astype(np.float32) for values in (height, rough, brightness, scatter, count, freedom)))


def _near_ground(records, first_row, rows, half, prior, row_size, column_size):
    """Indices of the records near the height of the road, at most SURFACE.max_points_per_cell per cell, and the cell of each."""
    prior = np.rint(prior / COORDINATE_SCALE).astype(np.int32)
    along, across = (np.int32(round(size / COORDINATE_SCALE)) for size in (row_size, column_size))
    nowhere = rows * 2 * half
    cell, count = np.empty(len(records), np.int32), np.zeros(nowhere + 1, np.int64)
    for first in range(0, len(records), SURFACE.ground_points_per_batch):
        s, d, z = (records[name][first:first + SURFACE.ground_points_per_batch] for name in ("s", "d", "z"))
        row = s // along
        row -= np.int32(first_row)
        column = d // across
        column += np.int32(half)
        # a negative number is very large without its sign
        inside = row.view(np.uint32) < np.uint32(rows)
        inside &= column.view(np.uint32) < np.uint32(2 * half)
        above = z - prior.take(row, mode="clip")
        reach = np.abs(d * np.float32(SURFACE.ground_reach_per_metre))
        reach += np.float32(SURFACE.ground_reach / COORDINATE_SCALE)
        inside &= np.abs(above) < reach
        row *= np.int32(2 * half)
        row += column
        row[~inside] = nowhere
        cell[first:first + SURFACE.ground_points_per_batch] = row
        count += np.bincount(row, minlength=nowhere + 1)
    # multiples of the golden ratio: an even subset whichever points of a cell come one after the other
    share = np.floor(0xFFFFFFFF * np.minimum(SURFACE.max_points_per_cell / np.maximum(count, 1), 1.0)).astype(np.uint32)
    share[nowhere] = 0
    turn = np.arange(1, SURFACE.ground_points_per_batch + 1, dtype=np.uint32) * np.uint32(GOLDEN_RATIO_32)
    indices = [np.empty(0, np.intp)]
    for first in range(0, len(cell), SURFACE.ground_points_per_batch):
        limit = share.take(cell[first:first + SURFACE.ground_points_per_batch])
        selected = np.flatnonzero(turn[:len(limit)] + np.uint32(first * GOLDEN_RATIO_32 % 2**32) < limit)
        selected += first
        indices.append(selected)
    indices = np.concatenate(indices)
    return indices, cell.take(indices)


def _views(points):
    """(N,) number of the view of each point, a scanner on a pass, from 0."""
    views = points.pass_number.astype(np.intp)
    views <<= 8
    views |= points.scanner
    return (np.cumsum(np.bincount(views) > 0) - 1)[views] if len(views) else views


def _planes(at, count, u, v, z, view, least):
    """Height at the middle of each cell, roughness, and its degrees of freedom, from a least-squares plane; points are sorted by cell, `at`.

    Two views of one place differ in height by what positions and mounting angles are off. That is no roughness of the ground: it is taken out.
    """
    n = np.maximum(count, 1).astype(float)
    filled = np.flatnonzero(count)
    starts = (np.cumsum(count) - count)[filled]

    def mean(values):
        sums = np.zeros(len(count))
        if len(starts):
            sums[filled] = np.add.reduceat(values, starts)
        return sums / n

    mu, mv, mz = mean(u), mean(v), mean(z)
    du, dv, dz = (values - middle.take(at) for values, middle in ((u, mu), (v, mv), (z, mz)))
    uu, uv, vv, uz, vz, zz = mean(du * du), mean(du * dv), mean(dv * dv), mean(du * dz), mean(dv * dz), mean(dz * dz)
    # ridge: the plane of points on one line stays level across that line
    uu, vv = uu + 1e-4, vv + 1e-4
    determinant = uu * vv - uv * uv
    across, along = (uz * vv - vz * uv) / determinant, (vz * uu - uz * uv) / determinant
    squares, freedom = np.maximum(zz - across * uz - along * vz, 0.0) * n, n - 3
    views = int(view.max(initial=0)) + 1
    if views > 1:
        of_view = at * views + view
        points_of_view = np.bincount(of_view, minlength=len(count) * views).reshape(-1, views)
        off = np.bincount(of_view, dz - across.take(at) * du - along.take(at) * dv, points_of_view.size).reshape(-1, views)
        squares = np.maximum(squares - (off**2 / np.maximum(points_of_view, 1)).sum(1), 0.0)
        freedom = n - 2 - np.maximum((points_of_view > 0).sum(1), 1)
    enough, any_ground = count >= SURFACE.min_freedom + 3, count >= SURFACE.min_layer_points
    rough, known = np.sqrt(squares / np.maximum(freedom, 1)), freedom >= least
    height = np.where(enough, mz - across * mu - along * mv, mz)
    return np.where(any_ground, height, np.nan), np.where(known, rough, np.nan), np.where(known, freedom, 0)


def _looks(points, at, shape, column_size, bright):
    """Median of the intensities of points in the cells `at`, and their standard deviation from the lower quartile."""
    kept = np.flatnonzero(bright(points))
    points, at = points[kept], at[kept]
    intensity = at_one_level(points.intensity, _views(points), at, shape, column_size)
    # numbers that are not negative have the order of their bits
    values = intensity[order_by(intensity.view(np.int32), at)].astype(float)
    count = np.bincount(at, minlength=shape[0] * shape[1])
    start = np.cumsum(count) - count
    filled = count >= SURFACE.min_layer_points
    median, spread = np.full(len(count), np.nan), np.full(len(count), np.nan)
    median[filled] = values[(start + count // 2)[filled]]
    spread[filled] = (median[filled] - values[(start + count // 4)[filled]]) / 0.6745
    return median, spread


# Intensities of several scanners and passes brought to one level.
#
# Two scanners that see one place return different intensities: their gains differ, and so do the ranges and angles at which they see it. A cell
# that both have measured then seems to scatter by half of its brightness, in which gravel beside asphalt drowns; and where only one of them sees
# the ground, the road seems to change. What they differ by where both see the same ground does not depend on what that ground is.


def at_one_level(intensity: np.ndarray, view: np.ndarray, cell: np.ndarray, shape: tuple[int, int], column_size: float) -> np.ndarray:
    """Intensities as they would be if all views were the mean of them.

    The logarithm of an intensity is that of its cell plus that of its view, which changes evenly across the road; both are
    estimated by least squares from the cells that several views have measured.

    intensity : (N,) raw counts
    view : (N,) number of the view of each point, a scanner on a pass, from 0
    cell : (N,) number of the cell of each point, row by row
    shape : rows and columns of the cells
    column_size : m across the road

    Returns (N,) float32 counts; the intensities themselves where there is one view
    """
    views = int(view.max(initial=0)) + 1
    value = intensity.astype(np.float32)
    if views == 1:
        return value
    logarithm = np.log(np.maximum(value, 1.0))
    group = cell.astype(np.int64) * views + view
    count = np.bincount(group, minlength=shape[0] * shape[1] * views).reshape(*shape, views)
    mean = np.bincount(group, logarithm, count.size).reshape(count.shape) / np.maximum(count, 1)
    level = _levels(count, mean, column_size)
    return value * np.exp(-level.astype(np.float32))[view, cell % shape[1]]


def _levels(count, mean, column_size):
    """(V, C) logarithms of the factors of V views in C columns, from points and means of logarithms, (R, C, V)."""
    columns, views = count.shape[1:]
    total = np.maximum(count.sum(2, keepdims=True), 1)
    off = count * (mean - (count * mean).sum(2, keepdims=True) / total)
    # normal equations without the unknown brightness of each cell
    normal = -np.einsum("rcv,rcw->cvw", count / total, count)
    normal[:, np.arange(views), np.arange(views)] += count.sum(0)
    bin_of = (np.arange(columns) * column_size / SURFACE.level_width).astype(np.int64)
    bins = int(bin_of[-1]) + 1
    first = np.searchsorted(bin_of, np.arange(bins))
    normal, off = np.add.reduceat(normal, first, axis=0), np.add.reduceat(off.sum(0), first, axis=0)
    smooth = (SURFACE.point_sigma / SURFACE.change_sigma) ** 2
    neighbours = np.full(bins, 2.0)
    neighbours[[0, -1]] -= 1.0
    normal[:, np.arange(views), np.arange(views)] += (neighbours * smooth)[:, None] + (SURFACE.point_sigma / SURFACE.level_sigma) ** 2
    # bins are coupled to the next ones alone: a band of one value per view
    band = np.zeros((views + 1, bins * views))
    for k in range(views):
        band[views - k].reshape(bins, views)[:, k:] = np.diagonal(normal, k, 1, 2)
    band[0, views:] = -smooth if bins > 1 else 0.0
    levels = solveh_banded(band, off.ravel()).reshape(bins, views)
    middles = (np.arange(bins) + 0.5) * SURFACE.level_width
    return np.array([np.interp((np.arange(columns) + 0.5) * column_size, middles, levels[:, k]) for k in range(views)])


# The ground beside the roads of a survey, measured in windows and kept from one stage to the next.
#
# The edges of the pavement and the surface are found in the same ground, which takes longer to measure than to look at.

PROFILES_PER_WINDOW = round(SURFACE.window_rows * SURFACE.row_length / SURFACE.profile_row)
CELL_NAMES = ("height", "rough", "count")   # what is known of the cells: the brightness of ground is that of its profiles

Wanted = tuple[int, int, bool, bool]   # road and first row of a window, and whether its cells and its profiles are to be measured


def windows_of(survey: Survey, road: int) -> list[int]:
    """First rows of the windows that cover a road."""
    first, end = (station / SURFACE.row_length / SURFACE.window_rows for station in survey.store.span(road))
    return [SURFACE.window_rows * k for k in range(int(np.floor(first)), int(np.ceil(end)))]


class MeasuredGround:
    """Ground cells and surface profiles of windows of SURFACE.window_rows rows, kept in a temporary file, however long the road is."""

    def __init__(self, survey: Survey):
        self.survey = survey
        self._arrays: SharedArrays | None = None
        self._kept: tuple[dict[tuple[int, int], ArrayPlace], ...] = {}, {}   # of cells and of profiles, by road and first row
        self.followed: dict[int, Any] = {}   # by road: the height of the road in its cells as it was followed, and smoothed; None where there is none

    def cells(self, road: int) -> GroundCells:
        """The GroundCells of a whole road; those of all roads are measured together."""
        in_step([self.measured_all(False)], self.survey.executor)
        rows = windows_of(self.survey, road)
        return self.windows(road, rows, [False] * len(rows))[0]

    def windows(self, road: int, rows: Sequence[int], profiled: Sequence[bool]) -> tuple[GroundCells, SurfaceProfiles | None]:
        """The ground of consecutive windows of a road.

        rows : first row of each window
        profiled : whether the profiles of each window are wanted

        Returns
            cells : GroundCells of all windows
            profiles : SurfaceProfiles of the windows where they are wanted; None where they are wanted nowhere
        """
        in_step([self.measured([(road, row, wanted) for row, wanted in zip(rows, profiled)])], self.survey.executor)
        half = _ground_columns(SURFACE.column_width)
        cells = self._kept_of(0, road, rows, (len(CELL_NAMES), SURFACE.window_rows, 2 * half))
        unknown = np.broadcast_to(np.float32(np.nan), cells.shape[1:])
        values = dict(zip(CELL_NAMES, cells), brightness=unknown, scatter=unknown, freedom=unknown)
        ground = GroundCells(rows[0], -half, SURFACE.row_length, SURFACE.column_width, **values)
        wanted = [row for row, want in zip(rows, profiled) if want]
        if not wanted:
            return ground, None
        half = _ground_columns(SURFACE.profile_column)
        profiles = self._kept_of(1, road, wanted, (len(SurfaceProfiles.NAMES), PROFILES_PER_WINDOW, 2 * half))
        first = np.array(wanted)[:, None] // round(SURFACE.profile_row / SURFACE.row_length) + np.arange(PROFILES_PER_WINDOW)
        return ground, SurfaceProfiles((first.ravel() + 0.5) * SURFACE.profile_row, (np.arange(-half, half) + 0.5) * SURFACE.profile_column,
                                       *profiles)

    def measured_all(self, profiled: bool) -> Work:
        """The work of `measured` on all windows of all roads."""
        return self.measured([(road, row, profiled) for road in self.survey.store.roads() for row in windows_of(self.survey, road)])

    def measured(self, wanted: Sequence[tuple[int, int, bool]]) -> Work:
        """The work that keeps what is not known yet of windows of any roads: number of the road, first row, and whether the profiles are wanted."""
        kept_cells, kept_profiles = self._kept
        windows = [(road, row, (road, row) not in kept_cells, profiled and (road, row) not in kept_profiles) for road, row, profiled in wanted]
        windows = [window for window in windows if any(window[2:])]
        self._arrays = self._arrays or SharedArrays(self.survey.executor.folder)
        phase = Phase(ground_of_windows, self.survey, (self._arrays,), listed=SURFACE.measured_windows, **self.survey.along(
            lambda item: (item[0][0], item[0][1] * SURFACE.row_length, (item[-1][1] + SURFACE.window_rows) * SURFACE.row_length)))
        for places, (road, row, *measured) in zip((yield Asked(phase, windows, 1.0)), windows):
            for kept, place in zip(compress(self._kept, measured), places):
                kept[road, row] = place

    def _kept_of(self, kind, road, rows, shape):
        """What is kept of windows, arrays of one shape one after the other: 0 their cells, 1 their profiles."""
        return np.concatenate([self._arrays.get(self._kept[kind][road, row], shape) for row in rows], axis=1)


def ground_of_windows(survey: Survey, windows: Sequence[Wanted], arrays: SharedArrays) -> list[list[ArrayPlace]]:
    """The phase that measures the ground and writes it.

    windows : what is wanted of each window

    Returns
        for each window where those that are wanted lie of:
        cells : (3, R, C) float32, the attributes CELL_NAMES of its GroundCells
        profiles : (6, P, K) float32, the attributes NAMES of its SurfaceProfiles
    """
    measured = []
    for road, row, with_cells, with_profiles in windows:
        height = partial(survey.road_height, road)
        points = survey.window(road, row * SURFACE.row_length, (row + SURFACE.window_rows) * SURFACE.row_length)
        if with_cells:
            cells = _ground_cells(points, row, SURFACE.window_rows, height)
            measured.append(np.array([getattr(cells, name) for name in CELL_NAMES], np.float32))
        if with_profiles:
            profiles = _profiles_of_window(survey, points, road, row)
            measured.append(np.array([getattr(profiles, name) for name in SurfaceProfiles.NAMES], np.float32))
    places = iter(arrays.put(measured))
    return [[*islice(places, with_cells + with_profiles)] for _, _, with_cells, with_profiles in windows]


def _profiles_of_window(survey, points, road, row):
    """The profiles of a window; where it and the road about it have few points, it is measured as one profile, which stands for each."""
    first, height, about = round(row * SURFACE.row_length / SURFACE.profile_row), partial(survey.road_height, road), SURFACE.rows_about_thin

    def measured(points, first, rows, length, least=1):
        result = _ground_cells(points, first, rows, height, length, SURFACE.profile_column,
                               lambda seen: np.abs(ahead_of_vehicle(survey, seen, seen.s)) <= SURFACE.farthest_ahead, least)
        result.height -= height(result.stations)[:, None]
        return result, is_thin(result.count, length, SURFACE.profile_column, SURFACE.thin_density)

    single, thin = measured(points, first, PROFILES_PER_WINDOW, SURFACE.profile_row)
    # a road has few points where it ends, too
    start, rows = first - about, PROFILES_PER_WINDOW + 2 * about
    if not thin or not measured(survey.window(road, start * SURFACE.profile_row, (start + rows) * SURFACE.profile_row), start, rows,
                                SURFACE.profile_row)[1]:
        return single
    joined, _ = measured(points, first // PROFILES_PER_WINDOW, 1, SURFACE.profile_row * PROFILES_PER_WINDOW, SURFACE.min_freedom)
    joined.count /= PROFILES_PER_WINDOW
    return replace(joined, **{name: np.repeat(getattr(joined, name), PROFILES_PER_WINDOW, axis=0) for name in SurfaceProfiles.NAMES})
