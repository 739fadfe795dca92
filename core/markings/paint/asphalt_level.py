"""How bright paint must be: multi-thresholds across the road, guarded against bins without paint.

Bins across the road, as wide as the spread of point density, so that each is
scanned alike; one threshold per bin and per 20 m of road after Otsu. Every
brightness is stated in robust z: above the median of asphalt, in units of its
spread below the median, which paint can never inflate.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy import ndimage

from ...common.order_statistics import quantiles
from ...intensity.asphalt_model import asphalt_statistics
from ...survey.store.records import COORDINATE_SCALE
from .gutters import gutter_cells

# The level of asphalt and the threshold above it at any place of a road, between bins and windows.

BRIGHT = 2.5      # spreads: what is brighter is no background


def flatten(brightness, median, spread, rims):
    """Brightness in spreads above the asphalt about each cell, and the cells of gutters.

    rims : distances inwards, from the rim of what was scanned and from the road's edges
    """
    z = (brightness - median) / spread
    gutter = np.logical_or.reduce([gutter_cells(z, rim) for rim in rims])
    with np.errstate(invalid="ignore"):
        even = (z < BRIGHT) & (z > -2 * BRIGHT) & ~gutter
    z = z - background(z, even)
    return z - patch_level(z, BRIGHT), gutter


def asphalt_profile(bins, offsets):
    """Median and spread of asphalt at (N,) offsets, between the middles of one window's bins."""
    middles = [b.middle for b in bins]
    return (np.interp(offsets, middles, [b.median for b in bins]).astype(np.float32),
            np.interp(offsets, middles, [b.spread for b in bins]).astype(np.float32))


class Levels:
    """Asphalt and threshold at any place, between the bins of all windows.

    windows : dict of window number to list of (Bin, Split)
    window_length : m; window k reaches from k to k + 1 times that
    """

    def __init__(self, windows, window_length, settings):
        self.windows, self.window_length = windows, window_length
        self.settings = settings
        self.numbers = np.array(sorted(windows))
        self._limits = {w: self._thresholds(w) for w in windows}

    def _thresholds(self, w):
        """Threshold in z of each bin: Otsu's where there is paint, else the neighbours', else the highest."""
        near = [split for n in (w - 1, w, w + 1) for _, split in self.windows.get(n, ()) if split.accepted]
        limits = []
        for _, split in self.windows[w]:
            value = split.threshold
            if not split.accepted:
                beside = [other.threshold for other in near if abs(other.middle - split.middle) < WIDEST]
                value = float(np.median(beside)) if beside else self.settings.alone
            limits.append(float(np.clip(value, self.settings.lowest, self.settings.highest)))
        return limits

    def at(self, grid):
        """median, spread, scale, threshold as (rows, columns) arrays: a cell is bright beyond threshold * scale."""
        numbers = self.numbers
        position = grid.stations() / self.window_length - 0.5
        before = np.clip(np.searchsorted(numbers, np.floor(position), side="right") - 1, 0, len(numbers) - 1)
        after = np.minimum(before + 1, len(numbers) - 1)
        gap = np.maximum(numbers[after] - numbers[before], 1)
        share = np.clip((position - numbers[before]) / gap, 0.0, 1.0)[:, None].astype(np.float32)
        needed = np.unique(np.r_[before, after])
        profiles = np.stack([self._profile(numbers[k], grid.offsets()) for k in needed])
        a, b = np.searchsorted(needed, before), np.searchsorted(needed, after)
        return [(1 - share) * profiles[a, q] + share * profiles[b, q] for q in range(4)]

    def _profile(self, w, offsets):
        pairs = self.windows[w]
        middles = [b.middle for b, _ in pairs]
        columns = ([b.median for b, _ in pairs], [b.spread for b, _ in pairs], [split.spread for _, split in pairs], self._limits[w])
        return np.stack([np.interp(offsets, middles, column) for column in columns]).astype(np.float32)


# Bright patches of road: repairs and concrete slabs, which are larger either way than any paint is filled.

PATCH_SQUARE = 25       # cells of 4 cm: 1 m
ABOUT = 7         # cells: a spot is bright where most of the 28 cm about it are
RAGGED = 3        # cells: the rim of a patch
TAIL = 3.0        # of its own spreads: how far the brightest of a patch lies above its median


def patch_level(z, bright):
    """What bright patches are brighter than the asphalt about them, so much as they scatter more included.

    Parameters
    ----------
    z : (rows, columns) brightness in spreads above asphalt, NaN where nothing was scanned
    bright : spreads, what is brighter is not the asphalt about

    Returns
    -------
    (rows, columns) float32 spreads, 0 outside patches
    """
    level = np.zeros(z.shape, np.float32)
    seen = np.isfinite(z)
    with np.errstate(invalid="ignore"):
        above = z > bright
    if np.count_nonzero(above) < PATCH_SQUARE**2 // 2:
        return level
    share, known = (cv2.boxFilter(a.astype(np.float32), -1, (ABOUT, ABOUT), normalize=False, borderType=cv2.BORDER_CONSTANT)
                    for a in (above, seen))
    filled = (share > 0.5 * known) & (known > 0.1 * ABOUT**2)
    core = _morphed(cv2.erode, filled, PATCH_SQUARE)
    if not core.any():
        return level
    whole = _morphed(cv2.dilate, core, PATCH_SQUARE + 2 * RAGGED) & (filled | above)
    labels, count = ndimage.label(whole)
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        piece = labels[box] == number
        values = z[box][piece & seen[box]]
        if len(values):
            median, spread = asphalt_statistics(values)
            level[box][piece] = median + TAIL * max(spread - 1.0, 0.0)
    return level


def _morphed(operation, mask, side):
    """A mask worn off or grown by squares; off beyond its rim."""
    square = np.ones((side, side), np.uint8)
    return operation(mask.astype(np.uint8), square, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)

NARROWEST, WIDEST = 0.75, 3.0  # m, limits of the bin width
FEWEST = 500          # cells of a bin, below which it joins its neighbour
LEVELS = 256          # histogram levels of Otsu's method
COARSE = 5            # cells: the background is known in squares of 20 cm
AROUND = 11           # squares: and taken from 2.2 m about each


@dataclass(frozen=True)
class Bin:
    """One bin across the road in one window along it.

    middle : m, its offset; count : cells of asphalt seen; median, spread : of asphalt's brightness
    """

    middle: float
    count: int
    median: float
    spread: float


@dataclass(frozen=True)
class Split:
    """Otsu's two classes of one bin in robust z.

    spread : of asphalt's z, 1 where the background was even
    threshold : Otsu's; below, above : means of the classes; share : of the bright one
    accepted : whether the classes are two materials and not one cut in half
    """

    middle: float
    spread: float
    threshold: float
    below: float
    above: float
    share: float
    accepted: bool


def bin_edges(d, low, high):
    """Edges of the bins across the road from the Gaussian of point density.

    Parameters
    ----------
    d : (N,) int32 offsets of the window's points, units of 0.1 mm
    low, high : extent of the road, metres

    Returns
    -------
    (B + 1,) ascending edges; bins are counted from the middle of the density outwards

    Notes
    -----
    sigma of the density is the bin width r, clamped to 0.75-3 m; there are
    INT(W_L / r) + 1 bins to the left and INT(W_R / r) + 1 to the right [1]_.

    References
    ----------
    .. [1] Driving-line thesis (Waterloo, 2017), Eq. 3.8-3.9, after Guan (2014).
    """
    if not len(d):
        return np.array([low, high])
    first, middle, third = (quantiles(d, [0.25, 0.5, 0.75]) * COORDINATE_SCALE).tolist()
    # the Gaussian that has the quartiles of the density: far stray points do not widen it
    width = float(np.clip((third - first) / 1.349, NARROWEST, WIDEST))
    left, right = int(max(high - middle, 0) / width) + 1, int(max(middle - low, 0) / width) + 1
    return middle + width * np.arange(-right, left + 1)


def otsu(values):
    """Otsu's threshold: the split with the greatest variance between its two classes.

    Parameters
    ----------
    values : (N,) float

    Returns
    -------
    threshold, mean below, mean above, share above
    """
    low, high = values.min(), values.max()
    if not high > low:
        return float(high), float(low), float(high), 0.0
    counts, edges = np.histogram(values, LEVELS, (low, high))
    centres = (edges[:-1] + edges[1:]) / 2
    weight = np.cumsum(counts)[:-1] / len(values)
    moment = np.cumsum(counts * centres)[:-1] / len(values)
    total = (counts * centres).sum() / len(values)
    with np.errstate(divide="ignore", invalid="ignore"):
        between = (total * weight - moment) ** 2 / (weight * (1 - weight))
    between[~np.isfinite(between)] = 0.0
    # a plateau of equal splits (empty levels) is cut in its middle
    best = np.flatnonzero(between >= between.max() * (1 - 1e-9))
    k = int(best[(len(best) - 1) // 2])
    below, above = moment[k] / weight[k], (total - moment[k]) / (1 - weight[k])
    return float(edges[k + 1]), float(below), float(above), float(1 - weight[k])


def asphalt_bins(values, d, edges):
    """Asphalt in the bins of one window.

    Parameters
    ----------
    values : (N,) brightness of cells away from the road's rim, no NaN
    d : (N,) their offsets, metres
    edges : (B + 1,) of `bin_edges`

    Returns
    -------
    list of Bin from right to left; a bin with fewer than 500 cells is joined to its neighbour
    """
    number = np.clip(np.searchsorted(edges, d, side="right") - 1, 0, len(edges) - 2).astype(np.uint16)
    order = np.argsort(number, kind="stable")
    bounds = np.searchsorted(number[order], np.arange(len(edges)))
    bins = []
    for first, last in _joined(np.diff(bounds)):
        rows = order[bounds[first]:bounds[last]]
        if len(rows):
            bins.append(Bin(float(d[rows].mean()), len(rows), *asphalt_statistics(values[rows])))
    return bins


def _joined(counts):
    """(first, last) of runs of bins with enough cells each; a poor rest joins the run before it."""
    runs, first, total = [], 0, 0
    for k, count in enumerate(counts):
        total += count
        if total >= FEWEST:
            runs.append((first, k + 1))
            first, total = k + 1, 0
    if first < len(counts):
        runs = runs[:-1] + [(runs[-1][0] if runs else 0, len(counts))]
    return runs


def split_bins(z, d, bins, separation):
    """Otsu's split of every bin of one window.

    Parameters
    ----------
    z : (N,) brightness in spreads above asphalt, gutters left out, no NaN
    d : (N,) offsets, metres
    bins : list of Bin of the same window
    separation : how many spreads the bright class must lie above the dark one

    Returns
    -------
    list of Split, one per bin
    """
    middles = np.array([b.middle for b in bins])
    number = np.searchsorted((middles[:-1] + middles[1:]) / 2, d).astype(np.uint16)
    order = np.argsort(number, kind="stable")
    bounds = np.searchsorted(number[order], np.arange(len(bins) + 1))
    return [_split(z[order[first:last]], b.middle, separation) for b, first, last in zip(bins, bounds[:-1], bounds[1:])]


def _split(z, middle, separation):
    if len(z) < FEWEST:
        return Split(middle, 1.0, 0.0, 0.0, 0.0, 0.0, False)
    median, spread = asphalt_statistics(z)
    z = np.clip((z - median) / spread, -6.0, 60.0)
    threshold, below, above, share = otsu(z)
    accepted = above - below > separation and threshold > 1.0 and share <= 0.5
    return Split(middle, spread, threshold, below, above, share, accepted)


def background(z, counted):
    """Patches, seams and wheel tracks: the level of asphalt about each cell, in spreads.

    Parameters
    ----------
    z : (rows, columns) brightness in spreads above asphalt
    counted : (rows, columns) bool, cells that are asphalt: neither paint nor gutter nor unseen

    Returns
    -------
    (rows, columns) float32; 0 where hardly any asphalt is about
    """
    count, total = (_coarse_sums(a) for a in (counted, np.where(counted, z, 0.0)))
    count, total = (cv2.boxFilter(a, -1, (AROUND, AROUND), borderType=cv2.BORDER_CONSTANT) for a in (count, total))
    level = np.where(count > 0.1 * COARSE**2, total / np.maximum(count, 1e-9), 0.0).astype(np.float32)
    return np.repeat(np.repeat(level, COARSE, axis=0), COARSE, axis=1)[:z.shape[0], :z.shape[1]]


def _coarse_sums(values):
    """(K, L) float64 sums over squares of 20 cm; those at the end may be smaller."""
    rows, columns = (np.arange(0, n, COARSE) for n in values.shape)
    return np.add.reduceat(np.add.reduceat(values, rows, axis=0, dtype=float), columns, axis=1)
