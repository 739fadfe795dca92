"""What asphalt returns at each distance from a scanner: counted in histograms, so that no order matters."""

import warnings
from dataclasses import dataclass

import numpy as np

BIN = 0.5           # m of distance
REACH = 30.0        # m; farther road counts with the last bin
LEVELS = 1024       # of intensity, 64 to a doubling: 1.1 % each
PER_DOUBLING = 64
FEWEST = 200        # points that make a bin's asphalt known
BINS = int(2 * REACH / BIN)
MIXED = 1.5         # times the spread of its neighbours: a bin of paint and asphalt, left out
PAINT_SIGMA = 3.0   # brighter than asphalt by this many of its lower spread is not asphalt
ACROSS, AWAY = 0, 1  # how distance is told
LEVEL_OF = np.clip(np.rint(np.log2(np.arange(2**16) + 1.0) * PER_DOUBLING), 0, LEVELS - 1).astype(np.int32)  # of whole numbers


def distances_from_vehicle(points, passes, away=True):
    """Where each point lies as seen from the vehicle at the time it was measured.

    On a road the place relative to the vehicle stands for range and incidence
    together: the height of the sensor ties one to the other. A mirror scanner,
    even one yawed by 45 degrees, meets each distance across the road once per
    turn, at one range; a spinning one with many beams meets it at many, but
    there the distance away from it tells the range.

    Parameters
    ----------
    points : (N) road points
    passes : the passes of the frame
    away : whether the second distance is asked for

    Returns
    -------
    (2, N) metres, left of travel positive: across the track, and horizontally
    away with the sign of the side; NaN where no pass drove at the point's time, or where it is not asked for
    """
    distance = np.full((2, len(points)), np.nan)
    time, number = points.time, points.pass_number
    for p in passes:
        rows = (number == p.number) & (time >= p.time[0] - 1.0) & (time <= p.time[-1] + 1.0)
        whole = rows.all()
        if not whole and not rows.any():
            continue
        rows = slice(None) if whole else np.flatnonzero(rows)
        here = points[rows]
        across = here.d
        across -= p.at(time[rows], "d")[0]
        across *= p.direction
        distance[ACROSS, rows] = across
        if away:
            px, py = p.at(time[rows], "x", "y")
            px -= here.x
            py -= here.y
            px *= px
            py *= py
            px += py
            distance[AWAY, rows] = np.copysign(np.sqrt(px, out=px), across)
    return distance


def distance_bin(distance):
    """(N,) int32 bin of a signed distance."""
    return np.clip((distance + REACH) * (1.0 / BIN), 0, BINS - 1).astype(np.int32)


def to_level(intensity):
    """(N,) int32 level of intensities."""
    if intensity.dtype == np.uint16:
        return LEVEL_OF.take(intensity)
    return np.clip(np.rint(np.log2(np.maximum(intensity, 0) + 1.0) * PER_DOUBLING), 0, LEVELS - 1).astype(np.int32)


def to_intensity(level):
    return 2.0 ** (np.asarray(level, float) / PER_DOUBLING) - 1.0


def count_levels(scanner, distances, intensity, scanners):
    """(2, scanners, BINS, LEVELS) int64: how many points have each level, by each way of telling the distance."""
    known = np.isfinite(distances[ACROSS])
    if not known.all():
        distances, intensity, scanner = distances[:, known], intensity[known], scanner[known]
    place = scanner.astype(np.int32) * (BINS * LEVELS) + to_level(intensity)
    return np.stack([np.bincount(distance_bin(row) * np.int32(LEVELS) + place,
                                 minlength=scanners * BINS * LEVELS).reshape(scanners, BINS, LEVELS) for row in distances])


def asphalt_of(histograms):
    """Median and lower spread of asphalt in each histogram of levels.

    What is brighter than the median by three lower spreads is taken for paint
    and left out, and the median sought again: paint never raises it.

    Returns
    -------
    median, lower sigma : (...) intensity; NaN where there are fewer than 200 points
    """
    counts = histograms.astype(float)
    total = counts.sum(axis=-1)
    limit = np.full(total.shape, LEVELS)
    for _ in range(4):
        kept = np.where(np.arange(LEVELS) <= limit[..., None], counts, 0.0)
        low, middle = _quantile(kept, 0.1587), _quantile(kept, 0.5)
        # a level is 1.1 %: narrower than that no spread can be seen
        limit = middle + PAINT_SIGMA * np.maximum(middle - low, 1.0)
    known = total >= FEWEST
    median, lower = to_intensity(middle), to_intensity(low)
    return np.where(known, median, np.nan), np.where(known, median - lower, np.nan)


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
        """The table of `count_levels`; None where no scanner saw enough road."""
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

    def correct(self, intensity, scanner, distances):
        """Corrected intensities, (N,) float32; NaN where asphalt is unknown."""
        told_by = self.told_by[np.flatnonzero(np.bincount(scanner))]
        alike = len(told_by) and (told_by == told_by[0]).all()
        distance = distances[told_by[0]] if alike else np.where(self.told_by[scanner] == ACROSS, *distances)
        position = np.clip((distance + REACH) * (1.0 / BIN) - 0.5, 0, BINS - 1)
        k = np.nan_to_num(position).astype(np.intp)
        position -= k
        k += scanner.astype(np.intp) * BINS
        asphalt = self.asphalt.ravel().take(k)
        after = np.append(self.asphalt, self.asphalt[:, -1:], axis=1)[:, 1:].ravel().take(k)
        after -= asphalt
        asphalt += after * position
        if self.logarithmic:
            return (intensity + (self.reference - asphalt)).astype(np.float32)
        return (intensity * (self.reference / np.maximum(asphalt, 1e-6))).astype(np.float32)


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
    with np.errstate(invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # bins with nothing around them
        return spread > MIXED * np.nanmedian(around, axis=0)


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
