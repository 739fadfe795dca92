"""What asphalt returns at each distance from a scanner: counted in histograms, so that no order matters."""

from dataclasses import dataclass

import numpy as np

from ..common.order_statistics import ascending, quantile_in_order
from ..survey.store.records import COORDINATE_SCALE
from .vehicle_relative import ACROSS, AWAY, UNKNOWN

BIN = 0.5           # m of distance
REACH = 30.0        # m; farther road counts with the last bin
LEVELS = 1024       # of intensity, 64 to a doubling: 1.1 % each
PER_DOUBLING = 64
FEWEST = 200        # points that make a bin's asphalt known
BINS = int(2 * REACH / BIN)
MIXED = 1.5         # times the spread of its neighbours: a bin of paint and asphalt, left out
PAINT_SIGMA = 3.0   # brighter than asphalt by this many of its lower spread is not asphalt
SHIFT, PLACES = 4, 2**16   # corrections are looked up every 2**4 units of 0.1 mm, 52 m to either side; beyond REACH they are all alike
HALF = PLACES << SHIFT >> 1
LEVEL_OF = np.clip(np.rint(np.log2(np.arange(2**16) + 1.0) * PER_DOUBLING), 0, LEVELS - 1).astype(np.int32)  # of whole numbers
LOWER = 0.5 - 0.3413  # quantile one standard deviation below the median of a normal distribution


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



def distance_bin(places):
    """(N,) int32 bin of signed distances, units of 0.1 mm."""
    number = places + np.int32(REACH / COORDINATE_SCALE)
    number //= np.int32(BIN / COORDINATE_SCALE)
    return np.clip(number, 0, BINS - 1, out=number)


def to_level(intensity):
    """(N,) int32 level of intensities."""
    if intensity.dtype == np.uint16:
        return LEVEL_OF.take(intensity)
    return np.clip(np.rint(np.log2(np.maximum(intensity, 0) + 1.0) * PER_DOUBLING), 0, LEVELS - 1).astype(np.int32)


def to_intensity(level):
    return 2.0 ** (np.asarray(level, float) / PER_DOUBLING) - 1.0


class LevelCounts:
    """How many points have each level, by scanner and distance, by each way of telling the distance.

    counts : (2, scanners, BINS, LEVELS) int64
    """

    def __init__(self, scanners):
        self.counts = np.zeros((2, scanners, BINS, LEVELS), np.int64)

    def of(self, scanner, places, intensity, ways=(ACROSS, AWAY)):
        """What some points count, to be added: (way, first bin, (scanners, bins, LEVELS)) for each way.

        A point whose place or intensity is not known counts nowhere.

        Parameters
        ----------
        scanner : (N,)
        intensity : (N,) NaN where it could not be corrected
        places : for each of `ways` (N,) of `Tracks.places`
        """
        known = places[0] != UNKNOWN
        if intensity.dtype.kind == "f":
            known &= ~np.isnan(intensity)
        if not known.all():
            places, intensity, scanner = [row[known] for row in places], intensity[known], scanner[known]
        if not len(intensity):
            return []
        level, scanners = to_level(intensity), self.counts.shape[1]
        found = []
        for way, row in zip(ways, places):
            number = distance_bin(row)
            first, bins = int(number.min()), int(np.ptp(number)) + 1
            number -= first
            if scanners > 1:
                number += scanner.astype(np.int32) * bins
            number *= LEVELS
            number += level
            found.append((way, first, np.bincount(number, minlength=scanners * bins * LEVELS).reshape(scanners, bins, LEVELS)))
        return found

    def add(self, found, times=1):
        """Add what `of` found, so many times."""
        for way, first, counts in found:
            self.counts[way, :, first:first + counts.shape[1]] += counts if times == 1 else times * counts


def asphalt_of(histograms):
    """Median and lower spread of asphalt in each histogram of levels.

    What is brighter than the median by three lower spreads is taken for paint
    and left out, and the median sought again: paint never raises it.

    Returns
    -------
    median, lower sigma : (...) intensity; NaN where there are fewer than 200 points
    """
    total = histograms.sum(axis=-1)
    known = total >= FEWEST
    median, sigma = np.full(total.shape, np.nan), np.full(total.shape, np.nan)
    counts = histograms[known].astype(float)
    if not len(counts):
        return median, sigma
    limit = np.full(len(counts), LEVELS)
    for _ in range(4):
        kept = np.where(np.arange(LEVELS) <= limit[..., None], counts, 0.0)
        low, middle = _quantile(kept, 0.1587), _quantile(kept, 0.5)
        # a level is 1.1 %: narrower than that no spread can be seen
        limit = middle + PAINT_SIGMA * np.maximum(middle - low, 1.0)
    median[known] = to_intensity(middle)
    sigma[known] = median[known] - to_intensity(low)
    return median, sigma


def _quantile(counts, q):
    """Level (fractional) below which a share q of the counts lies, along the last axis."""
    sums = np.cumsum(counts, axis=-1)
    wanted = q * sums[..., -1:]
    k = np.argmax(sums >= wanted, axis=-1)
    above = np.take_along_axis(sums, k[..., None], -1)[..., 0]
    here = np.take_along_axis(counts, k[..., None], -1)[..., 0]
    return k + 0.5 - (above - wanted[..., 0]) / np.maximum(here, 1e-9)


@dataclass
class AsphaltTable:
    """Asphalt's intensity by scanner and distance.

    asphalt : (scanners, BINS) smoothed; NaN for a scanner whose asphalt is unknown
    known : (scanners, BINS) where asphalt was seen and not interpolated
    told_by : (scanners,) ACROSS or AWAY, the distance that explains the scanner's intensity better
    reference : what the whole road's asphalt is brought to
    logarithmic : a correction is added, not multiplied
    """

    asphalt: np.ndarray
    known: np.ndarray
    told_by: np.ndarray
    reference: float
    logarithmic: bool

    @classmethod
    def of(cls, histograms):
        """The table of `LevelCounts`; None where no scanner saw enough road."""
        median, sigma = asphalt_of(histograms)
        weight = histograms.sum(axis=-1)
        if not np.isfinite(median).any():
            return None
        with np.errstate(invalid="ignore"):
            spread = np.where(np.isfinite(median), weight * (sigma / np.maximum(median, 1e-9)), 0.0).sum(axis=-1)
            spread /= np.maximum(np.where(np.isfinite(median), weight, 0).sum(axis=-1), 1)
        told_by = np.where(spread[AWAY] < 0.9 * spread[ACROSS], AWAY, ACROSS)
        rows = told_by, np.arange(len(told_by))
        median, sigma, weight = median[rows], sigma[rows], weight[rows]
        known = np.isfinite(median) & ~_mixed(sigma / np.maximum(median, 1e-9))
        reference = weighted_median(median[known], weight[known])
        median = np.where(known, median, np.nan)
        asphalt = np.stack([_smooth(row, count) for row, count in zip(median, weight)])
        return cls(asphalt, known, told_by, reference, is_logarithmic(median, sigma, weight))

    def lookup(self):
        """What corrects an intensity at each place: (scanners, PLACES + 1) float32 factors, or what is added.

        Asphalt farther away than REACH is taken for that at REACH, on either side. NaN for a scanner whose asphalt
        is unknown, and in the last column, which is that of points whose place is UNKNOWN.
        """
        distance = (((np.arange(PLACES) << SHIFT) - HALF) + (1 << SHIFT) / 2) * COORDINATE_SCALE
        position = np.clip((distance + REACH) / BIN - 0.5, 0, BINS - 1)
        asphalt = np.stack([np.interp(position, np.arange(BINS), row) for row in self.asphalt])
        found = self.reference - asphalt if self.logarithmic else self.reference / np.maximum(asphalt, 1e-6)
        return np.pad(found.astype(np.float32), ((0, 0), (0, 1)), constant_values=np.nan)

    @staticmethod
    def looked_up(lookup, scanner, place):
        """What corrects points: (N,) float32 of `lookup`.

        Parameters
        ----------
        lookup : of the method of that name
        scanner : (N,)
        place : (N,) int32 of `Tracks.places`
        """
        index = place + np.int32(HALF)
        index >>= SHIFT
        np.clip(index, 0, PLACES - 1, out=index)
        index[place == UNKNOWN] = PLACES
        if len(lookup) > 1:
            index += scanner.astype(np.int32) * np.int32(PLACES + 1)
        return lookup.ravel().take(index)


def is_logarithmic(median, sigma, weight):
    """Whether asphalt's spread stays while its level falls with distance.

    On a linear scale the spread falls with the level, on a logarithmic one it
    does not: the slope of log(spread) over log(level) is 1 or 0. A scale whose
    level hardly falls is taken as linear; either correction does the same there.
    """
    use = np.isfinite(median) & np.isfinite(sigma) & (sigma > 0) & (median > 0)
    if not use.any():
        return False
    level, spread = np.log(median[use]), np.log(sigma[use])
    w = np.minimum(weight[use], 10 * FEWEST).astype(float)
    w /= w.sum()
    level = level - (w * level).sum()
    variance = (w * level * level).sum()
    return bool(variance > 0.03**2 and (w * level * spread).sum() < 0.5 * variance)


def weighted_median(values, weights):
    """The value below which half of the weight lies."""
    order = np.argsort(values, kind="stable")
    sums = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(sums, 0.5 * sums[-1])])


def _mixed(spread):
    """Bins whose relative spread stands out from those around: a line painted at one distance fills much of them."""
    around = np.stack([np.roll(np.pad(spread, ((0, 0), (4, 4)), constant_values=np.nan), k, axis=1)[:, 4:-4]
                       for k in range(-4, 5)])
    known = np.isfinite(spread)  # so that each has something around it: itself
    found = np.zeros(spread.shape, bool)
    found[known] = spread[known] > MIXED * np.nanmedian(around[:, known], axis=0)
    return found


def _smooth(values, weight, sigma=0.7):
    """A row of the table, smoothed over its neighbours; between known bins interpolated, ends carried outward."""
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return values
    # intensity falls by a share per metre: its logarithm is the straighter line
    found = np.log(np.maximum(values[known], 1e-3))
    u = (known - known[:, None]).astype(float)
    w = np.exp(-0.5 * (u / sigma) ** 2) * np.minimum(weight[known], 20 * FEWEST)
    s0, s1, s2 = w.sum(axis=1), (w * u).sum(axis=1), (w * u * u).sum(axis=1)
    t0, t1 = (w * found).sum(axis=1), (w * u * found).sum(axis=1)
    spread = s0 * s2 - s1 * s1
    with np.errstate(invalid="ignore", divide="ignore"):
        fitted = np.where(spread > 1e-3 * s0 * s0, (s2 * t0 - s1 * t1) / spread, t0 / s0)
    return np.exp(np.interp(np.arange(len(values)), known, fitted))
