"""Profiles across the road, and the pseudo scan-lines made of them.

The road is cut into profiles: slices across it, one profile width long, at fixed stations counted from 0. A profile is cut into cells one point
spacing wide. Within a cell the points are separated into layers where the height jumps, so that branches, cars and ghost points lie in layers of
their own. The lowest layer gives the cell's principal point, and the principal points of a profile are its pseudo scan-line.

Source: Guan et al. (2014), ISPRS Journal 87, and the driving-line thesis after it, section 3.3. The thesis takes the highest point of the lowest
layer. Here it is a high quantile, less what noise alone would give: the highest of many noisy points would lift a dense road above its sparser
neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from ...common.arrays import order_by
from ..weights import CURBS

TOP_QUANTILE_SIGMAS = 1.2816   # derived: CURBS.top_quantile of a normal distribution, in sigmas
SIGMA_PER_MEAN_DEVIATION = 1.2533   # derived: sqrt(pi / 2), of a normal distribution


def lowest_layers(place: np.ndarray, h: np.ndarray, layer_jump: float, least_share: float = CURBS.min_ground_layer_share,
                  least_points: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The lowest layer of every cell: from one layer to the next the height jumps, and what lies above is no ground.

    place : (N,) cell of every point, ascending
    h : (N,) m, heights, ascending within a cell
    layer_jump : m of height between two layers
    least_share, least_points : share of the points of its cell, and points, of a layer; a smaller one is no ground

    Returns
        ground : (N,) bool, the points of the lowest layers
        first, count : (C,) index of the first point and number of points of the lowest layer of every occupied cell
    """
    if not len(place):
        empty = np.empty(0, np.int64)
        return np.empty(0, bool), empty, empty
    new_cell, new_layer = np.ones(len(place), bool), np.ones(len(place), bool)
    np.not_equal(place[1:], place[:-1], out=new_cell[1:])
    np.greater(h[1:] - h[:-1], layer_jump, out=new_layer[1:])
    new_layer |= new_cell
    layer_start = np.flatnonzero(new_layer)
    layer_count = np.diff(layer_start, append=len(place))
    first_of_cell = new_cell[layer_start]
    ground = np.ones(len(place), bool)
    if first_of_cell.all() and least_points == 1:
        return ground, layer_start, layer_count
    layer_cell = np.cumsum(first_of_cell) - 1
    cell_count = np.bincount(layer_cell, layer_count)
    real = layer_count >= np.maximum(least_points, least_share * cell_count[layer_cell])
    lowest = np.flatnonzero(real)
    lowest = lowest[np.diff(layer_cell[lowest], prepend=-1) > 0]
    upper = np.ones(len(layer_start), bool)
    upper[lowest] = False
    ground[expand_ranges(layer_start[upper], layer_start[upper] + layer_count[upper])[1]] = False
    return ground, layer_start[lowest], layer_count[lowest]


def expand_ranges(start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All indices of ranges of different lengths.

    start, end : (M,) first index of each range, and the one after its last

    Returns owner, index: (N,) number of the range, and the index
    """
    length = np.maximum(end - start, 0)
    owner = np.repeat(np.arange(len(start)), length)
    index = np.arange(len(owner))
    index += (start - (np.cumsum(length) - length)).take(owner)
    return owner, index


def nearest_distance(wanted: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """(M,) distance of each number from the nearest of (K,) keys, infinite where there is none."""
    if not len(keys):
        return np.full(len(wanted), np.inf)
    keys = np.sort(keys)
    right = np.searchsorted(keys, wanted)
    return np.minimum(*(np.abs(keys[np.clip(k, 0, len(keys) - 1)] - wanted) for k in (right - 1, right)))


@dataclass
class PseudoScanLines:
    """Profiles of one side of the road; offsets count outward from the reference line.

    spread : (P,) m, the same with the points of all layers near the ground, in the smoother cells over a few
        metres of road: near `noise` for a scanner with millimetre noise, far above it for any other
    """

    first: int   # number of the first of P profiles; station of profile k's middle is (k + 1/2) * width
    width: float   # width, spacing: m of road per profile, and m across per cell
    spacing: float
    origin: float   # m, outward offset at which the first of C cells begins
    point: np.ndarray   # (N,) the points, sorted by profile, cell and height, by their rows in the next three
    u: np.ndarray   # u, s: (N,) m, outward offset and station
    s: np.ndarray
    along: np.ndarray   # (N,) m along the road from the vehicle to the point when it was measured
    h: np.ndarray   # (N,) m, height of the sorted points above the expected road, which removes the grade
    ground: np.ndarray   # (N,) bool, sorted points of the lowest layer
    starts: np.ndarray   # (P * C + 1,) index of the first sorted point of every cell
    low: np.ndarray   # low, high: (P, C) m, median and high quantile of the lowest layer, NaN where there is no point
    high: np.ndarray
    noise: np.ndarray   # (P,) m, spread of heights within a cell of level road
    spread: np.ndarray

    @property
    def shape(self) -> tuple[int, ...]:
        """(P, C)"""
        return self.low.shape

    @property
    def count(self) -> np.ndarray:
        """(P, C) points of the lowest layers."""
        return np.diff(np.append(0, np.cumsum(self.ground))[self.starts]).reshape(self.shape)

    def offset(self, cell: np.ndarray) -> np.ndarray:
        """Outward offset of the middle of cells, m."""
        return self.origin + (np.asarray(cell) + 0.5) * self.spacing

    def part(self, first: int, last: int) -> PseudoScanLines:
        """The profiles from `first` to before `last`; the points are shared."""
        a, b, cells = first - self.first, last - self.first, self.shape[1]
        starts = self.starts[a * cells:b * cells + 1]
        of_rows = {name: getattr(self, name)[a:b] for name in ("low", "high", "noise", "spread")}
        of_points = {name: getattr(self, name)[starts[0]:starts[-1]] for name in ("point", "h", "ground")}
        return replace(self, first=first, starts=starts - starts[0], **of_rows, **of_points)


def seen_from(lines: PseudoScanLines, nearest: float, farthest: float, layer_jump: float) -> PseudoScanLines:
    """The same profiles from the points alone that lay `nearest` <= distance < `farthest` metres ahead when they were measured."""
    along = lines.along.take(lines.point)
    indices = np.flatnonzero((along >= nearest) & (along < farthest))
    return replace(_of_points(lines, indices, _places(lines)[indices], layer_jump), spread=lines.spread)


def widened(lines: PseudoScanLines, reach: int, layer_jump: float, cells: np.ndarray) -> PseudoScanLines:
    """The same profiles, each with the points of as many more, `reach`, on either side of it, in the cells that (P, C) bool names."""
    place, steps = _places(lines), np.arange(-reach, reach + 1)
    kept = np.flatnonzero(maximum_filter1d(cells, 2 * reach + 1, axis=0, mode="constant").take(place))
    place = (place.take(kept) + steps[:, None] * cells.shape[1]).ravel()
    inside = np.flatnonzero((place >= 0) & (place < cells.size))
    inside = inside[cells.take(place.take(inside))]
    indices = np.tile(kept, len(steps))[inside]
    return replace(_of_points(lines, indices, place[inside], layer_jump), noise=lines.noise, spread=lines.spread)


def _places(lines):
    """(N,) cell of every sorted point."""
    return np.repeat(np.arange(lines.low.size), np.diff(lines.starts))


def _of_points(lines, indices, place, layer_jump):
    """Profiles like others of some of their sorted points, in cells `place`."""
    point, (rows, cells) = lines.point.take(indices), lines.shape
    return profiles_of_cells((lines.u.take(point), lines.s.take(point), lines.h.take(indices), lines.along.take(point)), place,
                             (lines.first, lines.first + rows), cells, lines.width, lines.spacing, layer_jump, lines.origin)


def pseudo_scan_lines(u: np.ndarray, s: np.ndarray, h: np.ndarray, along: np.ndarray, profiles: tuple[int, int], width: float,
                      spacing: float, layer_jump: float, origin: float, reach: float) -> PseudoScanLines:
    """Cut points of one side into profiles and cells and find the ground in each.

    u, s, h : (N,) m, outward offset, station, and height above the expected road
    along : (N,) m along the road from the vehicle to the point when it was measured
    profiles : (first, last + 1) numbers of the profiles
    width, spacing : m of road per profile, m across per cell
    layer_jump : m of height between two layers
    origin, reach : m, nearest and farthest outward offset
    """
    cells = max(int(np.ceil((reach - origin) / spacing)), 1)
    inside, place = cells_of_points(u, s, h, np.arange(len(u)), profiles, cells, width, spacing, origin)
    return profiles_of_cells(tuple(v.take(inside) for v in (u, s, h, along)), place, profiles, cells, width, spacing, layer_jump, origin)


def profiles_of_cells(points: Sequence[np.ndarray], place: np.ndarray, profiles: tuple[int, int], cells: int, width: float, spacing: float,
                      layer_jump: float, origin: float) -> PseudoScanLines:
    """The profiles of points of which the cell is known, and the ground in each of their cells.

    points : (u, s, h, along), each (N,) m
    place : (N,) cells of the points (`cells_of_points`), `cells` of them a profile
    """
    rows, (u, s, h, along) = profiles[1] - profiles[0], points
    height = h + CURBS.ground_depth
    height *= 1e4
    order = order_by(np.rint(height, out=height).astype(np.int32), place)
    place, h = place.take(order), h.take(order)
    ground, first_of, count = lowest_layers(place, h, layer_jump)
    low, high = (np.full((rows, cells), np.nan) for _ in range(2))
    owner = place[first_of]
    middle = 0.5 * (h[first_of + (count - 1) // 2] + h[first_of + count // 2])
    top = h[first_of + np.rint(CURBS.top_quantile * (count - 1)).astype(np.int64)]
    low.flat[owner], high.flat[owner] = middle, top
    dense = np.flatnonzero(count >= CURBS.profile_noise_points)
    noise = _profile_noise(owner.take(dense) // cells, (top.take(dense) - middle.take(dense)) / TOP_QUANTILE_SIGMAS, rows)
    held = np.bincount(place, minlength=rows * cells)
    return PseudoScanLines(profiles[0], width, spacing, origin, order, u, s, along, h, ground, np.r_[0, np.cumsum(held)], low, high, noise,
                           _spread(_smooth(h, held, low)))


def cells_of_points(u: np.ndarray, s: np.ndarray, h: np.ndarray, rows: np.ndarray, profiles: tuple[int, int], cells: int,
                    width: float, spacing: float, origin: float) -> tuple[np.ndarray, np.ndarray]:
    """Which of the points `rows` lie within the profiles and cells, and in which.

    u, s, h : (K,) m, outward offset, station, and height above the expected road
    rows : (M,) indices of points
    profiles : (first, last + 1)
    cells : number of cells of a profile
    width, spacing : m of road per profile, m across per cell
    origin : m, outward offset at which the first cell begins

    Returns
        inside : (N,) indices of the points within
        place : (N,) (profile - first) * cells + cell
    """
    u, s, h = u.take(rows), s.take(rows), h.take(rows)
    profile = np.floor(s / width).astype(np.int32)
    profile -= profiles[0]
    cell = np.floor((u - origin) / spacing).astype(np.int32)
    within = ((profile >= 0) & (profile < profiles[1] - profiles[0]) & (cell >= 0) & (cell < cells)
              & (h > -CURBS.ground_depth) & (h < CURBS.ground_height))
    place = profile * np.int32(cells) + cell
    return (rows, place) if within.all() else (rows[within], place[within])


def _profile_noise(profile, spread, count):
    """(count,) median spread of each profile's cells; (M,) the profile, ascending, and the spread of cells."""
    ordered, n = _sorted_rows(profile, spread, count)
    k, index = np.maximum(n - 1, 0), np.arange(count)
    median = 0.5 * (ordered[index, k // 2] + ordered[index, (k + 1) // 2])
    return np.where(n >= CURBS.profile_noise_cells, np.fmax(median, CURBS.min_scanner_noise), CURBS.default_scanner_noise)


def _smooth(h, held, low):
    """(P,) spread of heights about the ground of their cells, in the smoother cells of every profile; NaN where there are too few."""
    (rows, cells), low = low.shape, low.ravel()
    crowded = np.flatnonzero(held >= CURBS.min_spread_points)
    if not len(crowded):
        return np.full(rows, np.nan)
    size = held.take(crowded)
    start = (np.cumsum(held) - held).take(crowded)
    owner, index = expand_ranges(start, start + size)
    first = np.cumsum(size) - size
    off = np.abs(h.take(index) - low.take(crowded).take(owner))
    near, count = off < CURBS.max_ground_deviation, size
    if not near.all():
        off = np.where(near, off, 0.0)
        count = np.add.reduceat(near, first, dtype=np.int64)
    mean = SIGMA_PER_MEAN_DEVIATION * np.add.reduceat(off, first) / np.maximum(count, 1)
    enough = np.flatnonzero(count >= CURBS.min_spread_points)
    # grass is rough to any scanner, so the smoother cells give the estimate
    ordered, n = _sorted_rows(crowded.take(enough) // cells, mean.take(enough), rows)
    return np.where(n >= CURBS.min_spread_cells, ordered[np.arange(rows), np.maximum(n - 1, 0) * 3 // 10], np.nan)


def _spread(smooth):
    """(P,) spread of heights about the ground, in the smoother cells of profiles and their neighbours."""
    # a single profile beside a bush is no measure of the scanner
    padded = np.pad(smooth, CURBS.spread_profiles, constant_values=np.nan)
    around = np.sort(np.lib.stride_tricks.sliding_window_view(padded, 2 * CURBS.spread_profiles + 1), axis=1)
    count = np.isfinite(around).sum(1)
    middle = around[np.arange(len(smooth)), np.maximum(count - 1, 0) // 2]
    return np.where(count > 0, middle, CURBS.min_scanner_noise)


def _sorted_rows(row, values, rows):
    """The (M,) values of every row, (M,) ascending, sorted and padded with NaN to the longest; and the number of values of each."""
    count = np.bincount(row, minlength=rows)
    padded = np.full((rows, max(int(count.max(initial=0)), 1)), np.nan)
    padded[np.arange(padded.shape[1]) < count[:, None]] = values
    padded.sort(axis=1)
    return padded, count
