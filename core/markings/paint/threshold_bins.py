"""Bins across the road and Otsu's threshold in each of them.

Bins are as wide as the spread of point density, so that the points of one bin were
measured from nearly one distance. Every brightness is stated in robust z: above the median of asphalt, in
units of its spread below the median, which paint does not increase.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.arrays import quantiles
from ...intensity.asphalt_model import asphalt_statistics
from ...survey.store.records import COORDINATE_SCALE

MIN_BIN_WIDTH, MAX_BIN_WIDTH = 0.75, 3.0  # m
MIN_BIN_CELLS = 500     # below which a bin joins its neighbour
MIN_ASPHALT_SHARE = 0.25   # of a bin that asphalt covers at least, among letters too: with less it is brighter ground that fills it
PAINT_LEVEL = 2.0       # times the usual brightness of asphalt: a bin whose median is beyond that is one of paint
OTSU_LEVELS = 256       # of the histogram
HISTOGRAM_LIMITS = -6.0, 60.0   # z: the range of Otsu's histogram; a few specular reflections must not stretch it


@dataclass(frozen=True)
class AsphaltBin:
    """One bin across the road in one window along it.

    middle : m, its offset
    count : cells of asphalt with data
    median, spread : of asphalt's brightness
    """

    middle: float
    count: int
    median: float
    spread: float


@dataclass(frozen=True)
class OtsuSplit:
    """Otsu's two classes of one bin in robust z.

    middle : m, offset of the bin
    spread : of asphalt's z, 1 where the background was even
    threshold : Otsu's
    below, above : means of the classes
    share : of the bright class
    accepted : whether the classes are two materials and not one cut in half
    """

    middle: float
    spread: float
    threshold: float
    below: float
    above: float
    share: float
    accepted: bool


def bin_edges(d: np.ndarray, low: float, high: float) -> np.ndarray:
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
    width = float(np.clip((third - first) / 1.349, MIN_BIN_WIDTH, MAX_BIN_WIDTH))
    left, right = int(max(high - middle, 0) / width) + 1, int(max(middle - low, 0) / width) + 1
    return middle + width * np.arange(-right, left + 1)


def otsu(values: np.ndarray) -> tuple[float, float, float, float]:
    """Otsu's threshold: the split with the greatest variance between its two classes (Otsu 1979).

    Parameters
    ----------
    values : (N,) float, at least one

    Returns
    -------
    threshold, mean below, mean above, share above
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


def asphalt_bins(values: np.ndarray, counted: np.ndarray, offsets: np.ndarray, edges: np.ndarray, usual: float = np.inf) -> list[AsphaltBin]:
    """Asphalt in the bins of one window.

    Half of a zebra crossing is stripes, and of the cells of a bin that lie on one most may be. Where the median of a bin
    tells that, what is so bright is left out of all of them.

    Parameters
    ----------
    values : (rows, columns) brightness
    counted : (rows, columns) bool, cells away from the road's rim, where `values` has no NaN
    offsets : (columns,) m, ascending
    edges : (B + 1,) of `bin_edges`
    usual : brightness of asphalt in the window, where that is the same at all distances from the vehicle

    Returns
    -------
    list of AsphaltBin from right to left; a bin with fewer than 500 cells is joined to its neighbour
    """
    bins = _bins(values, counted, offsets, edges)
    if max((b.median for b in bins), default=0.0) > PAINT_LEVEL * usual:
        dim = counted & (values < np.float32(PAINT_LEVEL * usual))
        if np.count_nonzero(dim) >= MIN_BIN_CELLS:
            return _bins(values, dim, offsets, edges)
    return bins


def _bins(values, counted, offsets, edges):
    """[AsphaltBin] of the cells that are counted."""
    number = np.clip(np.searchsorted(edges, offsets, side="right") - 1, 0, len(edges) - 2)
    bounds = np.searchsorted(number, np.arange(len(edges)))
    cells = np.count_nonzero(counted, axis=0)
    before = np.append(0, np.cumsum(cells))
    bins = []
    for first, last in _joined(np.diff(before[bounds])):
        own = slice(bounds[first], bounds[last])
        count = int(cells[own].sum())
        if count:
            bins.append(AsphaltBin(float(offsets[own] @ cells[own]) / count, count, *asphalt_statistics(values[:, own][counted[:, own]])))
    return bins


def _joined(counts):
    """(first, last) of runs of bins with enough cells each; too few cells at the end join the run before."""
    runs, first, total = [], 0, 0
    for k, count in enumerate(counts):
        total += count
        if total >= MIN_BIN_CELLS:
            runs.append((first, k + 1))
            first, total = k + 1, 0
    if first < len(counts):
        runs = runs[:-1] + [(runs[-1][0] if runs else 0, len(counts))]
    return runs


def split_bins(z: np.ndarray, counted: np.ndarray, offsets: np.ndarray, bins: list[AsphaltBin], separation: float,
               highest: float = np.inf) -> list[OtsuSplit]:
    """Otsu's split of every bin of one window.

    Parameters
    ----------
    z : (rows, columns) brightness in spreads above asphalt
    counted : (rows, columns) bool, cells that are no gutter, where z has no NaN
    offsets : (columns,) m, ascending
    bins : list of AsphaltBin of the same window
    separation : how many spreads the bright class must lie above the dark one
    highest : spreads, what is brighter is paint wherever the threshold lies: on a zebra crossing that may be half of a bin

    Returns
    -------
    list of OtsuSplit, one per bin
    """
    middles = np.array([b.middle for b in bins])
    bounds = [0, *np.searchsorted(offsets, (middles[:-1] + middles[1:]) / 2, side="right").tolist(), len(offsets)]
    return [_split(z[:, first:last][counted[:, first:last]], b.middle, separation, highest)
            for b, first, last in zip(bins, bounds[:-1], bounds[1:])]


def _split(z, middle, separation, highest):
    if len(z) < MIN_BIN_CELLS:
        return OtsuSplit(middle, 1.0, 0.0, 0.0, 0.0, 0.0, False)
    dim = z[z <= highest]
    median, spread = asphalt_statistics(dim if len(dim) >= MIN_ASPHALT_SHARE * len(z) else z)
    z = np.clip((z - median) / spread, *HISTOGRAM_LIMITS)
    threshold, below, above, share = otsu(z)
    accepted = above - below > separation and threshold > 1.0 and share <= 0.5
    return OtsuSplit(middle, spread, threshold, below, above, share, accepted)
