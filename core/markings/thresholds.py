"""How bright paint must be: multi-thresholds across the road, guarded against bins without paint.

Bins across the road, as wide as the spread of point density, so that each is
scanned alike; one threshold per bin and per 20 m of road after Otsu. Every
brightness is stated in robust z: above the median of asphalt, in units of its
spread below the median, which paint can never inflate.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from ..survey.points import UNIT
from ..survey.sorting import ascending, quantile_in_order, quantiles

NARROWEST, WIDEST = 0.75, 3.0  # m, limits of the bin width
FEWEST = 500          # cells of a bin, below which it joins its neighbour
LEVELS = 256          # histogram levels of Otsu's method
COARSE = 5            # cells: the background is known in squares of 20 cm
AROUND = 11           # squares: and taken from 2.2 m about each
LOWER = 0.5 - 0.3413  # quantile one standard deviation below the median of a normal distribution


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
    first, middle, third = (quantiles(d, [0.25, 0.5, 0.75]) * UNIT).tolist()
    # the Gaussian that has the quartiles of the density: far stray points do not widen it
    width = float(np.clip((third - first) / 1.349, NARROWEST, WIDEST))
    left, right = int(max(high - middle, 0) / width) + 1, int(max(middle - low, 0) / width) + 1
    return middle + width * np.arange(-right, left + 1)


def asphalt(values):
    """Median and lower spread of what is not paint.

    Paint is at the bright end only, so it is cut off, and what is cut off an even
    distribution does not matter to its lower half; three rounds settle it.

    Returns
    -------
    median, spread : spread is the distance from the median to the 15.9 % quantile
    """
    values = ascending(values)
    count = len(values)
    for _ in range(4):
        low, median = quantile_in_order(values, count, LOWER), quantile_in_order(values, count, 0.5)
        spread = max(median - low, 1e-6 * max(abs(median), 1.0))
        kept = int(np.searchsorted(values, median + 3.0 * spread, side="right"))
        if kept == count:
            break
        count = kept
    return median, spread


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
            bins.append(Bin(float(d[rows].mean()), len(rows), *asphalt(values[rows])))
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
    median, spread = asphalt(z)
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
