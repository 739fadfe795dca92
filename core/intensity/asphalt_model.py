"""The intensity of asphalt at each distance from a scanner, from histograms, so that the order of the points does not matter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ..common.arrays import quantile_in_order
from ..survey.frame.road_frame import Pass
from ..survey.store.records import COORDINATE_SCALE, Points
from .weights import ASPHALT

# Where points lie relative to the vehicle at the time they were measured, looked up in small tables.

UNKNOWN_DISTANCE = np.int32(2**30)   # derived: of a point during whose time no pass drove
ACROSS_TRACK, FROM_VEHICLE = 0, 1    # kinds of distance: across the vehicle's track, or horizontally from the vehicle


class VehicleDistances:
    """Distances of points from the vehicle during the time in which the points were measured.

    On a road the place relative to the vehicle stands for range and incidence together: the height of the sensor ties one to the other. A mirror
    scanner, even one yawed by 45 degrees, meets each distance across the road once per turn, at one range. A spinning scanner with many beams meets
    it at many ranges, but there the horizontal distance from the scanner determines the range.

    passes : of the road frame
    time : (N,) s, of all points that will be asked for; the ticks are those of a pass, whatever points are asked for
    """

    def __init__(self, passes: Sequence[Pass], time: np.ndarray):
        self._tables: list[_PassTable] = []
        if len(time):
            first, last = float(time.min()), float(time.max())
            self._tables = [_PassTable(p, max(first, p.time[0] - ASPHALT.pass_margin), min(last, p.time[-1] + ASPHALT.pass_margin)) for p in passes
                            if first <= p.time[-1] + ASPHALT.pass_margin and last >= p.time[0] - ASPHALT.pass_margin]

    def of(self, points: Points, kinds: Sequence[int] = (ACROSS_TRACK, FROM_VEHICLE)) -> list[np.ndarray]:
        """Signed distances of (N) points from the vehicle, (N,) int32 of 0.1 mm for each of the kinds, left of travel positive.

        Across the track, or horizontally from the vehicle with the sign of the side; UNKNOWN_DISTANCE where no pass drove at the point's time.
        """
        time, number = points.time, points.pass_number
        result = [np.full(len(points), UNKNOWN_DISTANCE, np.int32) for _ in kinds]
        for table in self._tables if len(points) else ():
            of_pass = table.rows(time, number)
            if of_pass.any():
                rows = slice(None) if of_pass.all() else np.flatnonzero(of_pass)
                for whole, distances in zip(result, table.distances(points[rows], time[rows], kinds)):
                    whole[rows] = distances
        return result


class _PassTable:
    """Positions of the vehicle during a part of one pass, at every `vehicle_tick`."""

    def __init__(self, driven: Pass, first: float, last: float):
        self.driven, self.begin = driven, driven.time[0]
        self.first = int(np.floor((first - self.begin) / ASPHALT.vehicle_tick))
        self.ticks = self.begin + ASPHALT.vehicle_tick * np.arange(self.first, int(np.floor((last - self.begin) / ASPHALT.vehicle_tick)) + 2)
        self._positions: dict[str, np.ndarray] = {}

    def rows(self, time: np.ndarray, number: np.ndarray) -> np.ndarray:
        """(N,) bool, which points are of this pass."""
        rows = number == self.driven.number
        start, end = self.begin - ASPHALT.pass_margin, self.driven.time[-1] + ASPHALT.pass_margin
        if time.min() < start or time.max() > end:
            rows &= (time >= start) & (time <= end)
        return rows

    def distances(self, points: Points, time: np.ndarray, kinds: Sequence[int]) -> Iterator[np.ndarray]:
        tick = time - self.begin
        tick *= 1.0 / ASPHALT.vehicle_tick
        tick += 0.5
        k = np.floor(tick, out=tick).astype(np.intp)
        k -= self.first
        across = self._relative(points.records["d"], "d", k)
        if self.driven.direction < 0:
            np.negative(across, out=across)
        for kind in kinds:
            yield across if kind == ACROSS_TRACK else self._horizontal(points, k, across)

    def _horizontal(self, points, k, across):
        x, y = (self._relative(points.records[name], name, k).astype(np.float32) for name in "xy")
        x *= x
        y *= y
        x += y
        return np.copysign(np.sqrt(x, out=x), across).astype(np.int32)

    def _relative(self, units, name, k):
        """(N,) int32 units minus the vehicle's at ticks k; of 64-bit coordinates the lower 32 bits suffice, as the difference is small."""
        if name not in self._positions:
            self._positions[name] = np.rint(self.driven.at(self.ticks, name)[0] / COORDINATE_SCALE).astype(np.int64).astype(np.int32)
        vehicle = self._positions[name].take(k, mode="clip")
        return np.subtract(units.astype(np.int32, copy=False), vehicle, out=vehicle)


DISTANCE_BINS = int(2 * ASPHALT.max_distance / ASPHALT.distance_bin)   # derived: both sides of the vehicle
INTENSITY_LEVELS = 1024     # derived: logarithmic, 64 to a doubling: 1.1 % each
LEVELS_PER_DOUBLING = 64   # cost: finer ones take more memory and change nothing
LOWER_QUANTILE = 0.5 - 0.3413  # derived: one standard deviation below the median of a normal distribution
INNER_QUANTILE, INNER_SIGMAS = 0.30, 0.5244    # source: of a normal distribution: so many standard deviations below the median
# cost: corrections are looked up in steps of 2**4 units of 0.1 mm, 52 m to either side; beyond `max_distance` they are all alike
LOOKUP_SHIFT, LOOKUP_STEPS = 4, 2**16
LOOKUP_HALF = LOOKUP_STEPS << LOOKUP_SHIFT >> 1
# derived: of intensities of 16 bits
LEVEL_OF_COUNT = np.clip(np.rint(np.log2(np.arange(2**16) + 1.0) * LEVELS_PER_DOUBLING), 0, INTENSITY_LEVELS - 1).astype(np.int32)


def asphalt_statistics(values: np.ndarray) -> tuple[float, float]:
    """Median and lower spread (down to the 15.9 % quantile) of asphalt, among (N,) values of asphalt and paint without NaN, N > 0.

    Paint is at the bright end, so values brighter than three spreads above the median are left out; so are those four standard deviations below it,
    of dark repairs and water. How much that is, the 30 % quantile tells, which they move less than the lower spread. Three rounds are enough.
    """
    values = np.sort(values)
    for _ in range(ASPHALT.cleaning_rounds):
        count = len(values)
        low, inner, median = (quantile_in_order(values, count, q) for q in (LOWER_QUANTILE, INNER_QUANTILE, 0.5))
        least = 1e-6 * max(abs(median), 1.0)
        spread = max(median - low, least)
        first = int(np.searchsorted(values, median - ASPHALT.dark_sigmas * max((median - inner) / INNER_SIGMAS, least)))
        last = int(np.searchsorted(values, median + ASPHALT.paint_sigmas * spread, side="right"))
        if last - first == count:
            break
        values = values[first:last]
    return median, spread


def to_level(intensity: np.ndarray) -> np.ndarray:
    """(N,) int32 level of (N,) intensities."""
    if intensity.dtype == np.uint16:
        return LEVEL_OF_COUNT.take(intensity)
    return np.clip(np.rint(np.log2(np.maximum(intensity, 0) + 1.0) * LEVELS_PER_DOUBLING), 0, INTENSITY_LEVELS - 1).astype(np.int32)


def to_intensity(level: np.ndarray) -> np.ndarray:
    """Intensity of (fractional) levels, float64 of the same shape."""
    return 2.0 ** (np.asarray(level, float) / LEVELS_PER_DOUBLING) - 1.0


@dataclass(frozen=True)
class BinCounts:
    """Counts of some points for one kind of distance: (scanners, bins, INTENSITY_LEVELS) from bin `first` on."""

    kind: int
    first: int
    counts: np.ndarray


class IntensityHistograms:
    """How many points have each level, by kind of distance, scanner and distance. counts : (2, scanners, DISTANCE_BINS, INTENSITY_LEVELS) int64"""

    def __init__(self, scanners: int):
        self.counts = np.zeros((2, scanners, DISTANCE_BINS, INTENSITY_LEVELS), np.int64)

    def count(self, scanner: np.ndarray, distances: Sequence[np.ndarray], intensity: np.ndarray,
              kinds: Sequence[int] = (ACROSS_TRACK, FROM_VEHICLE)) -> list[BinCounts]:
        """Counts of some points, to be added with `add`; a point whose distance or intensity is not known counts nowhere.

        scanner : (N,) int
        distances : for each of `kinds` (N,) int32 of `VehicleDistances.of`
        intensity : (N,) NaN where it could not be corrected
        """
        usable = distances[0] != UNKNOWN_DISTANCE
        if intensity.dtype.kind == "f":
            usable &= ~np.isnan(intensity)
        if not usable.all():
            distances, intensity, scanner = [row[usable] for row in distances], intensity[usable], scanner[usable]
        if not len(intensity):
            return []
        level, scanners = to_level(intensity), self.counts.shape[1]
        result = []
        for kind, row in zip(kinds, distances):
            number = row + np.int32(ASPHALT.max_distance / COORDINATE_SCALE)
            number //= np.int32(ASPHALT.distance_bin / COORDINATE_SCALE)
            np.clip(number, 0, DISTANCE_BINS - 1, out=number)
            first, bins = int(number.min()), int(np.ptp(number)) + 1
            number -= first
            if scanners > 1:
                number += scanner.astype(np.int32) * bins
            number *= INTENSITY_LEVELS
            number += level
            counts = np.bincount(number, minlength=scanners * bins * INTENSITY_LEVELS).reshape(scanners, bins, INTENSITY_LEVELS)
            result.append(BinCounts(kind, first, counts))
        return result

    def add(self, counts: Sequence[BinCounts], times: int = 1) -> None:
        """Add results of `count`; each counted point stands for some `times` of them."""
        for part in counts:
            bins = slice(part.first, part.first + part.counts.shape[1])
            self.counts[part.kind, :, bins] += part.counts if times == 1 else times * part.counts

    @classmethod
    def together(cls, results: Sequence[Sequence[BinCounts]]) -> list[BinCounts]:
        """Results of `count` as one, which takes no more room than the largest."""
        parts = [part for counts in results for part in counts]
        if len(results) < 2 or not parts:
            return parts
        whole = cls(parts[0].counts.shape[0])
        whole.add(parts)
        joined = []
        for kind in sorted({part.kind for part in parts}):
            first = min(part.first for part in parts if part.kind == kind)
            end = max(part.first + part.counts.shape[1] for part in parts if part.kind == kind)
            joined.append(BinCounts(kind, first, whole.counts[kind, :, first:end]))
        return joined


def asphalt_of_histograms(histograms: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Median and lower spread of asphalt in each of (..., INTENSITY_LEVELS) histograms of levels, NaN where there are fewer than 200 points.

    Levels brighter than three lower spreads above the median are taken for paint and left out, and the median is taken again: paint never raises it.
    """
    total = histograms.sum(axis=-1)
    dense = total >= ASPHALT.min_asphalt_points
    median, sigma = np.full(total.shape, np.nan), np.full(total.shape, np.nan)
    counts = histograms[dense].astype(float)
    limit = np.full(len(counts), INTENSITY_LEVELS)
    for _ in range(ASPHALT.cleaning_rounds):
        remaining = np.where(np.arange(INTENSITY_LEVELS) <= limit[..., None], counts, 0.0)
        low, middle = _histogram_quantile(remaining, LOWER_QUANTILE), _histogram_quantile(remaining, 0.5)
        # a level is 1.1 %: no smaller spread can be resolved
        limit = middle + ASPHALT.paint_sigmas * np.maximum(middle - low, 1.0)
    median[dense] = to_intensity(middle)
    sigma[dense] = median[dense] - to_intensity(low)
    return median, sigma


def _histogram_quantile(counts, q):
    """Level (fractional) below which a share q of the counts lies, along the last axis."""
    sums = np.cumsum(counts, axis=-1)
    target = q * sums[..., -1:]
    k = np.argmax(sums >= target, axis=-1)
    above = np.take_along_axis(sums, k[..., None], -1)[..., 0]
    level_counts = np.take_along_axis(counts, k[..., None], -1)[..., 0]
    return k + 0.5 - (above - target[..., 0]) / np.maximum(level_counts, 1e-9)


@dataclass
class AsphaltTable:
    """Asphalt's intensity by scanner and distance."""

    asphalt: np.ndarray   # (scanners, DISTANCE_BINS) smoothed; NaN for a scanner whose asphalt is unknown
    known: np.ndarray   # (scanners, DISTANCE_BINS) bool, where asphalt was measured and not interpolated
    distance_kind: np.ndarray   # (scanners,) ACROSS_TRACK or FROM_VEHICLE, the distance that explains the scanner's intensity better
    reference: float   # intensity that the asphalt of the whole road is brought to
    logarithmic: bool   # a correction is added, not multiplied

    @classmethod
    def from_counts(cls, histograms: np.ndarray) -> AsphaltTable | None:
        """The table of the counts of IntensityHistograms; None where no scanner measured enough road."""
        median, sigma = asphalt_of_histograms(histograms)
        weight = histograms.sum(axis=-1)
        if not np.isfinite(median).any():
            return None
        with np.errstate(invalid="ignore"):
            spread = np.where(np.isfinite(median), weight * (sigma / np.maximum(median, 1e-9)), 0.0).sum(axis=-1)
            spread /= np.maximum(np.where(np.isfinite(median), weight, 0).sum(axis=-1), 1)
        kind = np.where(spread[FROM_VEHICLE] < 0.9 * spread[ACROSS_TRACK], FROM_VEHICLE, ACROSS_TRACK)
        rows = kind, np.arange(len(kind))
        median, sigma, weight = median[rows], sigma[rows], weight[rows]
        usable = np.isfinite(median) & ~_mixed(median, sigma / np.maximum(median, 1e-9))
        reference = weighted_median(median[usable], weight[usable])
        # beyond the last level nothing tells how asphalt goes on: how far that is must not turn on the density of the points
        joined = _sparse_bins_joined(histograms[rows])
        levels = np.where(usable, median, asphalt_of_histograms(joined)[0])
        asphalt = np.stack([_smoothed(row, count) for row, count in zip(levels, np.where(usable, weight, joined.sum(axis=-1)))])
        return cls(asphalt, usable, kind, reference, is_logarithmic(median, sigma, weight))

    def lookup(self) -> np.ndarray:
        """Corrections at each distance: (scanners, LOOKUP_STEPS + 1) float32 factors, or summands where `logarithmic`.

        Asphalt farther away than `max_distance` is taken for that there, on either side. NaN for a scanner whose
        asphalt is unknown, and in the last column, which is that of UNKNOWN_DISTANCE.
        """
        distance = (((np.arange(LOOKUP_STEPS) << LOOKUP_SHIFT) - LOOKUP_HALF) + (1 << LOOKUP_SHIFT) / 2) * COORDINATE_SCALE
        position = np.clip((distance + ASPHALT.max_distance) / ASPHALT.distance_bin - 0.5, 0, DISTANCE_BINS - 1)
        asphalt = np.stack([np.interp(position, np.arange(DISTANCE_BINS), row) for row in self.asphalt])
        corrections = self.reference - asphalt if self.logarithmic else self.reference / np.maximum(asphalt, 1e-6)
        return np.pad(corrections.astype(np.float32), ((0, 0), (0, 1)), constant_values=np.nan)

    @staticmethod
    def corrections(lookup: np.ndarray, scanner: np.ndarray, distance: np.ndarray) -> np.ndarray:
        """(N,) float32 corrections of points by the array of `lookup`, their scanners (N,) and the distances (N,) int32 of `VehicleDistances.of`."""
        index = distance + np.int32(LOOKUP_HALF)
        index >>= LOOKUP_SHIFT
        np.clip(index, 0, LOOKUP_STEPS - 1, out=index)
        index[distance == UNKNOWN_DISTANCE] = LOOKUP_STEPS
        if len(lookup) > 1:
            index += scanner.astype(np.int32) * np.int32(LOOKUP_STEPS + 1)
        return lookup.ravel().take(index)


def is_logarithmic(median: np.ndarray, sigma: np.ndarray, weight: np.ndarray) -> bool:
    """Whether intensities are on a logarithmic scale: asphalt's spread stays the same while its level falls with distance.

    On a linear scale the spread falls with the level, on a logarithmic one it does not: the slope of log(spread) over log(level) is 1 or 0. A scale
    whose level hardly falls is taken as linear; there both corrections do the same. Our own rule.

    median, sigma, weight : arrays of one shape: asphalt and number of points by distance; NaN where unknown
    """
    use = np.isfinite(median) & np.isfinite(sigma) & (sigma > 0) & (median > 0)
    if not use.any():
        return False
    level, spread = np.log(median[use]), np.log(sigma[use])
    w = np.minimum(weight[use], 10 * ASPHALT.min_asphalt_points).astype(float)
    w /= w.sum()
    level = level - (w * level).sum()
    variance = (w * level * level).sum()
    return bool(variance > 0.03**2 and (w * level * spread).sum() < 0.5 * variance)


def weighted_median(values: np.ndarray, weights: np.ndarray) -> float:
    """The value below which half of the weight lies, of (N,) values, N > 0, with (N,) weights of 0 or more."""
    order = np.argsort(values, kind="stable")
    sums = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(sums, 0.5 * sums[-1])])


def _mixed(level, spread):
    """Bins that stand out from their neighbours: a line painted at one distance fills much of them and scatters, or a gutter fills them, which is
    brighter than the lines through pairs of neighbours by as much as paint is."""
    reach = ASPHALT.mixed_bin_neighbours

    def around(values):
        padded = np.pad(values, ((0, 0), (reach, reach)), constant_values=np.nan)
        return {k: np.roll(padded, -k, axis=1)[:, reach:-reach] for k in range(-reach, reach + 1)}

    logarithm, usual = around(np.log(np.maximum(level, 1e-9))), np.full((2, *level.shape), np.nan)
    lines = [(logarithm[i] * j - logarithm[j] * i) / (j - i) for i, j in combinations(sorted(logarithm), 2) if i and j]
    for values, result, method in zip((list(around(spread).values()), lines), usual, ("linear", "lower")):
        some = np.isfinite(values).any(axis=0)
        result[some] = np.nanquantile(np.stack(values)[:, some], 0.5, axis=0, method=method)
    return (spread > ASPHALT.mixed_bin_spread * usual[0]) | (level > (1.0 + ASPHALT.paint_sigmas * usual[0]) * np.exp(usual[1]))


def _sparse_bins_joined(histograms):
    """(scanners, DISTANCE_BINS, INTENSITY_LEVELS) counts of neighbouring bins that have too few points each, as soon as they have enough
    together, in the bin at their middle; from the vehicle outwards on either side."""
    joined, counts = np.zeros_like(histograms), histograms.sum(axis=-1)
    for scanner in np.flatnonzero(counts.any(axis=-1)).tolist():
        for side in (range(DISTANCE_BINS // 2, DISTANCE_BINS), range(DISTANCE_BINS // 2 - 1, -1, -1)):
            group: list[int] = []
            for k in side:
                group = [*group[1 - ASPHALT.max_joined_bins:], k] if 0 < counts[scanner, k] < ASPHALT.min_asphalt_points else []
                group_counts = counts[scanner, group]
                if group_counts.sum() >= ASPHALT.min_asphalt_points:
                    joined[scanner, int(np.rint((group_counts * group).sum() / group_counts.sum()))] = histograms[scanner, group].sum(axis=0)
                    group = []
    return joined


def _smoothed(values, weight, sigma=0.7):
    """A row of the table, smoothed by a local line; between known bins interpolated, at the ends extended."""
    bins = np.flatnonzero(np.isfinite(values))
    if not len(bins):
        return values
    # intensity falls by a share per metre: its logarithm is closer to a line
    logarithm = np.log(np.maximum(values[bins], 1e-3))
    u = (bins - bins[:, None]).astype(float)
    w = np.exp(-0.5 * (u / sigma) ** 2) * np.minimum(weight[bins], 20 * ASPHALT.min_asphalt_points)
    s0, s1, s2 = w.sum(axis=1), (w * u).sum(axis=1), (w * u * u).sum(axis=1)
    t0, t1 = (w * logarithm).sum(axis=1), (w * u * logarithm).sum(axis=1)
    determinant = s0 * s2 - s1 * s1
    with np.errstate(invalid="ignore", divide="ignore"):
        fitted = np.where(determinant > 1e-3 * s0 * s0, (s2 * t0 - s1 * t1) / determinant, t0 / s0)
    return np.exp(np.interp(np.arange(len(values)), bins, fitted))
