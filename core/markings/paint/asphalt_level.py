"""The level of asphalt, and the threshold of paint above it, at any place of a road.

Asphalt is interpolated between bins across the road and windows along it. Gutters, the local background (wheel tracks, seams) and bright
patches are removed before a threshold is applied.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...intensity.asphalt_model import asphalt_statistics
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE
from ..weights import ASPHALT, RIMS
from .not_paint import RimBands, gutter_level


def flatten(brightness: np.ndarray, median: np.ndarray, spread: np.ndarray, rims: Sequence[RimBands]) -> tuple[np.ndarray, np.ndarray]:
    """Brightness above the asphalt around each cell, (rows, columns) spreads, and which cells are gutters, (rows, columns) bool.

    `brightness` : (rows, columns), NaN where nothing was scanned. `median`, `spread` : of asphalt, (columns,) or (rows, columns).
    `rims` : of the rim of the scanned road and of the road's edges.
    """
    z = (brightness - median) / spread
    level = np.maximum.reduce([gutter_level(z, rim) for rim in rims])
    gutter = level > 0
    # concrete scatters by as much of its brightness as asphalt
    z = z - level * (1.0 + ASPHALT.patch_tail * spread / np.maximum(median, spread))
    with np.errstate(invalid="ignore"):
        even = (z < ASPHALT.background_limit) & (z > -2 * ASPHALT.background_limit) & ~gutter
    z = z - background(z, even)
    return z - patch_level(z, ASPHALT.background_limit), gutter


def dark_cells(brightness: np.ndarray, usual: float) -> np.ndarray:
    """(rows, columns) bool, cells of water, tar and other dark ground, with their rim.

    `brightness` : (rows, columns), NaN where nothing was scanned; `usual` : brightness of asphalt about there.
    """
    with np.errstate(invalid="ignore"):
        dark = (brightness < np.float32(ASPHALT.dark_share * usual)).astype(np.uint8)
    return cv2.dilate(dark, np.ones((2 * ASPHALT.dark_rim + 1, 2 * ASPHALT.dark_rim + 1), np.uint8)).astype(bool)


def asphalt_profile(bins: list[_AsphaltBin], offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Median and spread of asphalt, (N,) float32 each, at `offsets`, (N,) m, between the middles of one window's `bins`, at least one."""
    middles = [b.middle for b in bins]
    return (np.interp(offsets, middles, [b.median for b in bins]).astype(np.float32),
            np.interp(offsets, middles, [b.spread for b in bins]).astype(np.float32))


def threshold_profile(z: np.ndarray, counted: np.ndarray, offsets: np.ndarray, bins: list[_AsphaltBin],
                      separation: float) -> tuple[np.ndarray, np.ndarray]:
    """Scale and threshold, (columns,) float32 each, at `offsets`: a cell is bright beyond threshold * scale; arguments as in `split_bins`.

    The threshold is Otsu's where a bin has paint, else that of the bins beside it, else the lowest.
    """
    splits = split_bins(z, counted, offsets, bins, separation, ASPHALT.highest)
    limits = []
    for split in splits:
        near = [other.threshold for other in splits if other.accepted and abs(other.middle - split.middle) < ASPHALT.max_bin_width]
        value = split.threshold if split.accepted else np.median(near) if near else ASPHALT.lowest
        limits.append(np.clip(value, ASPHALT.lowest, ASPHALT.highest))
    middles = [split.middle for split in splits]
    return (np.interp(offsets, middles, [split.spread for split in splits]).astype(np.float32),
            np.interp(offsets, middles, limits).astype(np.float32))


def background(z: np.ndarray, counted: np.ndarray) -> np.ndarray:
    """Wheel tracks, seams and patches: the level of asphalt around each cell, (rows, columns) float32 spreads; 0 where hardly any asphalt is near.

    `z` : (rows, columns) brightness in spreads above asphalt. `counted` : (rows, columns) bool, asphalt with data, neither paint nor gutter.
    """
    count, total = _coarse_sums(counted.view(np.uint8)), _coarse_sums(np.where(counted, z, z.dtype.type(0)))
    around = ASPHALT.background_squares, ASPHALT.background_squares
    count, total = (cv2.boxFilter(a, -1, around, borderType=cv2.BORDER_CONSTANT) for a in (count, total))
    level = np.where(count > 0.1 * RIMS.coarse_cells**2, total / np.maximum(count, 1e-9), 0.0).astype(np.float32)
    size = level.shape[1] * RIMS.coarse_cells, level.shape[0] * RIMS.coarse_cells
    return cv2.resize(level, size, interpolation=cv2.INTER_NEAREST)[:z.shape[0], :z.shape[1]]


def _coarse_sums(values):
    """(K, L) float64 sums over squares of 20 cm; those at the end may be smaller. values : uint8, float32 or float64"""
    corners = cv2.integral(values)
    for axis, size in enumerate(values.shape):
        corners = np.diff(corners.take(np.append(np.arange(0, size, RIMS.coarse_cells), size), axis=axis), axis=axis)
    return corners.astype(float, copy=False)


def of_squares(values: np.ndarray, shares: Sequence[float], measures: Callable[..., Sequence[np.ndarray]]) -> list[np.ndarray]:
    """Measures of asphalt about each cell, (rows, columns) float32 each, from quantiles of squares of 1 m; NaN where nothing is known.

    A measure is the median of the squares around, and interpolated between the middles of squares.

    values : (rows, columns), NaN where unknown; shares : of the quantiles; measures : of the quantiles, (squares along, squares across) each
    """
    side, reach = ASPHALT.local_square, ASPHALT.local_squares // 2
    rows, columns = (-(-n // side) for n in values.shape)
    padded = np.full((rows * side, columns * side), np.nan, np.float32)
    padded[:values.shape[0], :values.shape[1]] = values
    squares = np.sort(padded.reshape(rows, side, columns, side).transpose(0, 2, 1, 3).reshape(rows, columns, -1), axis=2)
    count = np.isfinite(squares).sum(axis=2, keepdims=True)
    quantiles = (np.take_along_axis(squares, (share * np.maximum(count - 1, 0)).astype(np.int64), 2)[..., 0] for share in shares)
    positions = np.meshgrid(*(np.clip((np.arange(n) + 0.5) / side - 0.5, 0, m - 1) for n, m in zip(values.shape, (rows, columns))), indexing="ij")
    result = []
    for measure in measures(*quantiles):
        known = np.where(count[..., 0] >= ASPHALT.min_local_cells, measure, np.nan)
        around = np.lib.stride_tricks.sliding_window_view(np.pad(known, reach, constant_values=np.nan), (2 * reach + 1, 2 * reach + 1))
        ordered = np.sort(around.reshape(rows, columns, -1), axis=2)
        near = np.isfinite(ordered).sum(axis=2, keepdims=True)
        middle = np.take_along_axis(ordered, np.maximum(near - 1, 0) // 2, 2)[..., 0]
        usual = np.median(known[np.isfinite(known)]) if near.any() else np.nan
        result.append(ndimage.map_coordinates(np.where(near[..., 0] > 0, middle, usual), positions, order=1).astype(np.float32))
    return result


def patch_level(z: np.ndarray, bright: float) -> np.ndarray:
    """How much brighter bright patches are than the asphalt around them, plus their additional scatter; 0 outside patches. Our own rule.

    Repairs and concrete slabs are larger in either direction than any painted area. Words and symbols may be as large, but are no patches: between
    their strokes is the asphalt of the road. `z` : (rows, columns) spreads above asphalt, NaN where nothing was scanned; beyond `bright` spreads a
    cell is not asphalt of the surroundings.
    """
    level = np.zeros(z.shape, np.float32)
    finite = np.isfinite(z)
    with np.errstate(invalid="ignore"):
        above = z > bright
    if np.count_nonzero(above) < ASPHALT.patch_side**2 // 2:
        return level
    size = ASPHALT.patch_neighbourhood, ASPHALT.patch_neighbourhood
    share, scanned = (cv2.boxFilter(a.view(np.uint8), -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT) for a in (above, finite))
    filled = (share > scanned // 2) & (scanned > 0.1 * ASPHALT.patch_neighbourhood**2)
    core = _morphed(cv2.erode, filled, ASPHALT.patch_side)
    patches = _morphed(cv2.dilate, core, ASPHALT.patch_side + 2 * ASPHALT.patch_rim) & (filled | above)
    labels, count = ndimage.label(patches)
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        piece = labels[box] == number
        values = z[box][piece & finite[box]]
        if len(values) and not _letters(values, bright):
            median, spread = asphalt_statistics(values)
            level[box][piece] = median + ASPHALT.patch_tail * max(spread - 1.0, 0.0)
    return level


def _letters(z, bright):
    """Whether the cells of a piece are strokes of paint and the road's own asphalt between them, by the criterion of Otsu (1979)."""
    z = np.clip(z, *ASPHALT.histogram_limits)
    threshold, below, above, share = otsu(z)
    apart = share * (1.0 - share) * (above - below) ** 2 > ASPHALT.letters_separation * float(z.var())
    return apart and share <= ASPHALT.most_of_letters and np.count_nonzero(z < bright) >= ASPHALT.letters_asphalt * np.count_nonzero(z < threshold)


def _morphed(operation, mask, side):
    """A mask eroded or dilated by squares; off outside the window."""
    square = np.ones((side, side), np.uint8)
    return operation(mask.astype(np.uint8), square, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)


# Bins across the road and Otsu's threshold in each. A bin is as wide as the spread of point density, so its points were measured from nearly one
# distance. Brightness is in robust z: above the median of asphalt, in units of its spread below the median, which paint does not increase.

OTSU_LEVELS = 256   # derived: of the histogram


@dataclass(frozen=True)
class _AsphaltBin:
    """One bin across the road in one window: offset of its middle, m, cells of asphalt with data, and median and spread of their brightness."""

    middle: float
    count: int
    median: float
    spread: float


@dataclass(frozen=True)
class _OtsuSplit:
    """Otsu's two classes of one bin in robust z."""

    middle: float   # m, offset of the bin
    spread: float   # of asphalt's z, 1 where the background was even
    threshold: float
    accepted: bool   # whether the classes are two materials and not one cut in half


def bin_edges(d: np.ndarray, low: float, high: float) -> np.ndarray:
    """(B + 1,) ascending edges of bins across the road, from the middle of the point density outwards.

    The width r of a bin is the sigma of the density, clamped to 0.75 to 3 m; INT(W_L / r) + 1 bins lie to the left and INT(W_R / r) + 1 to the right
    (driving-line thesis, Waterloo 2017, Eq. 3.8-3.9, after Guan 2014). `d` : (N,) int32 offsets of the window's points, units of 0.1 mm;
    `low`, `high` : extent of the road, m.
    """
    if not len(d):
        return np.array([low, high])
    first, middle, third = (np.quantile(d, [0.25, 0.5, 0.75]) * COORDINATE_SCALE).tolist()
    # the Gaussian that has the quartiles of the density: far stray points do not widen it
    width = float(np.clip((third - first) / 1.349, ASPHALT.min_bin_width, ASPHALT.max_bin_width))
    left, right = int(max(high - middle, 0) / width) + 1, int(max(middle - low, 0) / width) + 1
    return middle + width * np.arange(-right, left + 1)


def otsu(values: np.ndarray) -> tuple[float, float, float, float]:
    """Otsu's threshold (1979), the split of (N,) values, at least one, with the greatest variance between its two classes.

    Returns the threshold, the means below and above it, and the share above it.
    """
    low, high = values.min(), values.max()
    if not high > low:
        return float(high), float(low), float(high), 0.0
    counts, edges = np.histogram(values, OTSU_LEVELS, (low, high))
    centres = (edges[:-1] + edges[1:]) / 2
    weight = np.cumsum(counts)[:-1] / len(values)
    moment = np.cumsum(counts * centres)[:-1] / len(values)
    total = (counts * centres).sum() / len(values)
    with np.errstate(divide="ignore", invalid="ignore"):
        between = (total * weight - moment) ** 2 / (weight * (1 - weight))
    between[~np.isfinite(between)] = 0.0
    # of several equal splits (empty levels) the middle one
    best = np.flatnonzero(between >= between.max() * (1 - 1e-9))
    k = int(best[(len(best) - 1) // 2])
    below, above = moment[k] / weight[k], (total - moment[k]) / (1 - weight[k])
    return float(edges[k + 1]), float(below), float(above), float(1 - weight[k])


def asphalt_bins(values: np.ndarray, counted: np.ndarray, offsets: np.ndarray, edges: np.ndarray, usual: float = np.inf) -> list[_AsphaltBin]:
    """Asphalt in the bins of one window, from right to left; a bin with fewer than 500 cells is joined to its neighbour.

    Half of a zebra crossing is stripes, and of the cells of a bin that lies on one most may be. Where the median of a bin tells that, what is so
    bright is left out of all of them.

    values : (rows, columns) brightness
    counted : (rows, columns) bool, cells away from the road's rim, where `values` has no NaN
    offsets : (columns,) m, ascending; edges : (B + 1,) of `bin_edges`
    usual : brightness of asphalt in the window, where that is the same at all distances from the vehicle
    """
    bins = _bins(values, counted, offsets, edges)
    if max((b.median for b in bins), default=0.0) > ASPHALT.paint_level * usual:
        dim = counted & (values < np.float32(ASPHALT.paint_level * usual))
        if np.count_nonzero(dim) >= ASPHALT.min_bin_cells:
            return _bins(values, dim, offsets, edges)
    return bins


def _bins(values, counted, offsets, edges):
    """[_AsphaltBin] of the cells that are counted."""
    number = np.clip(np.searchsorted(edges, offsets, side="right") - 1, 0, len(edges) - 2)
    bounds = np.searchsorted(number, np.arange(len(edges)))
    cells = np.count_nonzero(counted, axis=0)
    before = np.append(0, np.cumsum(cells))
    bins = []
    for first, last in _joined(np.diff(before[bounds])):
        span = slice(bounds[first], bounds[last])
        count = int(cells[span].sum())
        if count:
            bins.append(_AsphaltBin(float(offsets[span] @ cells[span]) / count, count, *asphalt_statistics(values[:, span][counted[:, span]])))
    return bins


def _joined(counts):
    """(first, last) of runs of bins with enough cells each; too few cells at the end join the run before."""
    runs, first, total = [], 0, 0
    for k, count in enumerate(counts):
        total += count
        if total >= ASPHALT.min_bin_cells:
            runs.append((first, k + 1))
            first, total = k + 1, 0
    if first < len(counts):
        runs = runs[:-1] + [(runs[-1][0] if runs else 0, len(counts))]
    return runs


def split_bins(z: np.ndarray, counted: np.ndarray, offsets: np.ndarray, bins: list[_AsphaltBin], separation: float,
               highest: float = np.inf) -> list[_OtsuSplit]:
    """Otsu's split of each of the `bins` of one window.

    z : (rows, columns) spreads above asphalt; counted : (rows, columns) bool, cells that are no gutter, where z has no NaN
    offsets : (columns,) m, ascending
    separation : spreads that the bright class must lie above the dark one
    highest : spreads; what is brighter is paint wherever the threshold lies: on a zebra crossing that may be half of a bin
    """
    middles = np.array([b.middle for b in bins])
    bounds = [0, *np.searchsorted(offsets, (middles[:-1] + middles[1:]) / 2, side="right").tolist(), len(offsets)]
    return [_split(z[:, first:last][counted[:, first:last]], b.middle, separation, highest)
            for b, first, last in zip(bins, bounds[:-1], bounds[1:])]


def _split(z, middle, separation, highest):
    if len(z) < ASPHALT.min_bin_cells:
        return _OtsuSplit(middle, 1.0, 0.0, False)
    dim = z[z <= highest]
    median, spread = asphalt_statistics(dim if len(dim) >= ASPHALT.min_asphalt_share * len(z) else z)
    z = np.clip((z - median) / spread, *ASPHALT.histogram_limits)
    threshold, below, above, share = otsu(z)
    return _OtsuSplit(middle, spread, threshold, above - below > separation and threshold > 1.0 and share <= 0.5)
