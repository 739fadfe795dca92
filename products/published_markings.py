"""Two published methods to compare with: intensity peaks in profiles across the road, and thresholds on the points of segments.

A painted line is a narrow peak of I(d) in a profile across the road, which continues in the profiles before and after. Markings across the road
and broad ones are no narrow peaks and are not found.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from ..core.common.arrays import linked_groups
from ..core.common.parallel import ordered_map
from ..core.common.progress import Progress
from ..core.intensity.asphalt_model import asphalt_statistics
from ..core.markings.paint.asphalt_level import otsu
from ..core.markings.paint.settings import PaintMethod
from ..core.markings.road_grid import occupied
from ..core.survey.store.columns import Columns
from ..core.survey.store.records import COORDINATE_SCALE, Points
from ..core.survey.store.road_points import RoadPoints

PEAK_WINDOW = 20.0     # m of station processed together
PROFILE_CELL = 200        # units of 0.1 mm: a profile has one value every 2 cm
MEDIAN_CELLS = 5        # cells of the running median
MAX_EMPTY_PROFILE_CELLS = 5   # without points that are interpolated; beyond them the profile is taken for asphalt
MIN_DEVIATION = 0.005   # of the profile's level: the deviation of integer intensities can be 0
MIN_CHAIN_SHARE = 0.6   # of the profiles along a chain: must have the peak


@dataclass(frozen=True)
class IntensityPeaks:
    """When a peak of intensity across the road is a painted line."""

    profile_length: float = 0.20   # m of road that one profile is averaged over
    prominence: float = 7.0   # deviations (MAD of the profile) that a peak must rise above both its feet
    narrowest: float = 0.08   # narrowest, widest: m, width of a peak at half its height
    widest: float = 0.35
    jump: float = 0.15   # m across that the peak may move from profile to profile
    gap: float = 0.60   # m along the road without a peak that a chain continues over
    shortest: float = 1.0   # m, least length of a chain

    def paint_of(self, road_points: RoadPoints, road: int, progress: Progress) -> Iterator[Columns]:
        """Yield the records of one road's points that lie on painted lines, window by window; points corrected or not.

        Profile-based after Chen et al. (2009) as summarised in the driving-line thesis: I(d) of each profile is smoothed by a running median of 5;
        peaks of a minimum prominence and of the width of a line are linked along the road. The numbers, and the rule that a chain needs a peak in
        three of five of its profiles, are our own: they leave a road without paint empty.
        """
        profile = int(round(self.profile_length / COORDINATE_SCALE))
        count = max(1, int(round(PEAK_WINDOW / self.profile_length)))
        start, end = road_points.store.span(road)
        windows = list(range(int(np.floor(start / COORDINATE_SCALE / profile / count)), int(np.floor(end / COORDINATE_SCALE / profile / count)) + 1))

        def records_of(window: int) -> tuple[Columns, np.ndarray]:
            records = _records_between(road_points, road, window * count * profile, (window + 1) * count * profile)
            return records, (records["s"] // profile).astype(np.int64)

        peaks = list(ordered_map(lambda window: profile_peaks(*records_of(window), settings=self), windows, progress.part(0.0, 0.6)))
        row, left, right = (np.concatenate([f[k] for f in peaks]) for k in range(3))
        kept = in_chains(row, (left + right) / 2, self)
        row, left, right = row[kept], left[kept], right[kept]
        yield from ordered_map(lambda window: _between(*records_of(window), peak_row=row, left=left, right=right), windows, progress.part(0.6, 1.0))


def _records_between(road_points, road, first, last):
    """Records with first <= s < last, units of 0.1 mm."""
    records = road_points.window(road, (first - 1) * COORDINATE_SCALE, (last + 1) * COORDINATE_SCALE).records
    return records[(records["s"] >= first) & (records["s"] < last)]


def profile_peaks(records: Columns, row: np.ndarray, settings: IntensityPeaks) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Peaks of I(d) in the profiles of one window, from (N,) records of points and the profile that each lies in.

    Returns the profile of each peak and its left and right border at half its height, units of 0.1 mm, (P,) each.
    """
    from scipy.signal import find_peaks  # slow to load, and this method alone uses it

    none = np.empty(0, np.int64)
    if not len(records):
        return none, none, none
    first, low = row.min(), (records["d"] // PROFILE_CELL).min()
    z = _profiles(Points(records).value, row - first, records["d"] // PROFILE_CELL - low)
    reach = int(np.ceil(2 * settings.widest / (PROFILE_CELL * COORDINATE_SCALE)))
    # asphalt's level between the rows: the feet of a peak lie in its own profile
    padded = np.pad(z, ((0, 0), (reach, reach)))
    limits = np.array([settings.narrowest, settings.widest]) / (PROFILE_CELL * COORDINATE_SCALE)
    # a minimum height excludes the many small peaks of asphalt
    _, properties = find_peaks(padded.ravel(), height=1e-9, prominence=settings.prominence, width=limits, wlen=2 * reach + 1)
    feet = np.stack([properties["left_ips"], properties["right_ips"]])
    number = (feet[0] // padded.shape[1]).astype(np.int64)
    borders = np.rint((feet - number * padded.shape[1] - reach + low + 0.5) * PROFILE_CELL).astype(np.int64)
    return number + first, borders[0], borders[1]


def _profiles(value, row, column):
    """(profiles, cells) smoothed I(d) above the profile's median, in deviations; 0 where nothing was scanned."""
    shape = int(row.max()) + 1, int(column.max()) + 1
    cell, size = row * shape[1] + column, shape[0] * shape[1]
    count = np.bincount(cell, minlength=size)
    # in whole 64ths: their sums are exact in any order
    total = np.bincount(cell, np.rint(value.astype(float) * 64), size) / 64
    scanned = np.flatnonzero(count)
    places = np.arange(size)
    after = np.minimum(np.searchsorted(scanned, places), len(scanned) - 1)
    before = np.maximum(np.searchsorted(scanned, places, side="right") - 1, 0)
    level = np.interp(places, scanned, total[scanned] / count[scanned]).reshape(shape)
    unseen = (np.maximum(np.abs(scanned[after] - places), np.abs(places - scanned[before])) > MAX_EMPTY_PROFILE_CELLS).reshape(shape)
    level = ndimage.median_filter(level, (1, MEDIAN_CELLS), mode="nearest")
    level[unseen] = np.nan
    empty = unseen.all(axis=1)
    level[empty] = 0.0
    median = np.nanmedian(level, axis=1, keepdims=True)
    deviation = np.nanmedian(np.abs(level - median), axis=1, keepdims=True)
    z = (level - median) / np.maximum(deviation, np.maximum(MIN_DEVIATION * np.abs(median), 1e-9))
    return np.where(unseen, 0.0, z)


def in_chains(row: np.ndarray, middle: np.ndarray, settings: IntensityPeaks) -> np.ndarray:
    """(P,) bool, the peaks that belong to a chain of sufficient length, from the profile of each and its offset, units of 0.1 mm."""
    if not len(row):
        return np.zeros(0, bool)
    steps = max(1, int(round(settings.gap / settings.profile_length)))
    pairs = cKDTree(np.c_[row / (steps + 0.5), middle * COORDINATE_SCALE / settings.jump]).query_pairs(1.0, p=np.inf, output_type="ndarray")
    pairs = pairs[row[pairs[:, 0]] != row[pairs[:, 1]]]  # two peaks of one profile are two lines
    chain = linked_groups(pairs[:, 0], pairs[:, 1], len(row))
    number = int(chain.max()) + 1
    first, last = np.full(number, np.iinfo(np.int64).max), np.full(number, np.iinfo(np.int64).min)
    np.minimum.at(first, chain, row)
    np.maximum.at(last, chain, row)
    profiles = last - first + 1
    supporting = np.bincount(np.unique(np.c_[chain, row], axis=0)[:, 0], minlength=number)
    good = (profiles * settings.profile_length >= settings.shortest) & (supporting >= MIN_CHAIN_SHARE * profiles)
    return good[chain]


def _between(records, row, peak_row, left, right):
    """The records that lie between the borders of a peak of their own profile."""
    if not len(records) or not len(peak_row):
        return records[:0]
    order = np.lexsort((left, peak_row))
    width = 1 << 32
    keys = peak_row[order] * width + left[order]
    index = np.searchsorted(keys, row * width + records["d"], side="right") - 1
    peak = order[np.maximum(index, 0)]
    return records[(index >= 0) & (peak_row[peak] == row) & (records["d"] <= right[peak])]


# Thresholds on the points of segments across the road, each of one point density and one range (Otsu); bright points with few bright neighbours
# are noise.

MIN_SEGMENT_POINTS = 200    # of a segment, below which it has no threshold and no paint
RIM_NEIGHBOUR_SHARE = 0.5    # of the neighbours usual inside of paint: a point on its rim has half of them
HISTOGRAM_RANGE = 6.0, 60.0     # spreads below and above the median of asphalt: the range of Otsu's histogram


@dataclass(frozen=True)
class PointSegments:
    """How road points are split, and when a bright one is paint."""

    length: float = 10.0   # length, width: m, of a segment along and across the road
    width: float = 1.0
    separation: float = 3.0   # spreads of asphalt between the means of the two classes, below which a segment has no paint
    radius: float = 0.12   # m around a bright point in which its bright neighbours are counted

    def paint_of(self, road_points: RoadPoints, road: int, progress: Progress) -> Iterator[Columns]:
        """Yield the records of one road's points that are paint, segment row by segment row; points corrected or not.

        Point-based after Yu et al. (2015) without its learned part (small markings), as summarised in the driving-line thesis: Otsu's threshold
        per segment across the road, then a threshold after Otsu on the counts of neighbours. Our own are the sizes, the rule that leaves a
        segment without paint empty, and the rule that half of the neighbours usual inside of paint are enough, as its rim has no more.
        """
        length = int(round(self.length / COORDINATE_SCALE))
        start, end = road_points.store.span(road)
        windows = list(range(int(np.floor(start / COORDINATE_SCALE / length)), int(np.floor(end / COORDINATE_SCALE / length)) + 1))

        limits = dict(zip(windows, ordered_map(
            lambda window: segment_thresholds(_records_between(road_points, road, window * length, (window + 1) * length), self), windows,
            progress.part(0.0, 0.5))))
        reach = int(np.ceil(self.radius / COORDINATE_SCALE)) + 1

        def paint_in(window):
            first, last = window * length, (window + 1) * length
            records = _bright(_records_between(road_points, road, first - reach, last + reach), length, limits, self)
            inside = (records["s"] >= first) & (records["s"] < last)
            return records[inside & dense_enough(records, inside, self)]

        yield from ordered_map(paint_in, windows, progress.part(0.5, 1.0))


def _segments(records, settings):
    """(N,) int, the segment across the road that each record lies in."""
    return (records["d"] // int(round(settings.width / COORDINATE_SCALE))).astype(np.int64)


def segment_thresholds(records: Columns, settings: PointSegments) -> dict[int, float]:
    """The least intensity of paint by number of the segment, in one row of segments across the road; infinite where there is no paint."""
    value, segment = Points(records).value, _segments(records, settings)
    order = np.argsort(segment, kind="stable")
    numbers, starts = np.unique(segment[order], return_index=True)
    return {int(number): _threshold(np.sort(value[rows]), settings.separation)
            for number, rows in zip(numbers, np.split(order, starts[1:]))}


def _threshold(values, separation):
    if len(values) < MIN_SEGMENT_POINTS:
        return np.inf
    median, spread = asphalt_statistics(values)
    # a few specular reflections must not stretch the histogram
    below, above = HISTOGRAM_RANGE
    limited = np.clip(values, median - below * spread, median + above * spread)
    threshold, below, above, share = otsu(limited)
    # the larger class is asphalt: on a road without paint Otsu may split off its dark end
    return threshold if above - below > separation * spread and share <= 0.5 else np.inf


def _bright(records, length, limits, settings):
    """Records above the threshold of the segment they lie in."""
    window, segment = records["s"] // length, _segments(records, settings)
    if not len(records):
        return records
    first = int(window.min()), int(segment.min())
    table = np.full((int(window.max()) - first[0] + 1, int(segment.max()) - first[1] + 1), np.inf)
    for number in np.unique(window).tolist():
        for column, value in limits.get(number, {}).items():
            if 0 <= column - first[1] < table.shape[1]:
                table[number - first[0], column - first[1]] = value
    return records[Points(records).value > table[window - first[0], segment - first[1]]]


def dense_enough(records: Columns, mask: np.ndarray, settings: PointSegments) -> np.ndarray:
    """(N,) bool, those of the points `mask`, (N,) bool, that have as many bright neighbours as paint has; the others only count as neighbours."""
    keep = np.zeros(len(records), bool)
    if not mask.any():
        return keep
    places = np.c_[records["s"], records["d"]] * COORDINATE_SCALE
    rows = np.flatnonzero(mask)
    # points at one place have the same neighbours: where a cloud holds points several times, each place is searched once
    distinct, member = occupied(records["s"].take(rows), records["d"].take(rows))
    count = cKDTree(places).query_ball_point(distinct * COORDINATE_SCALE, settings.radius, return_length=True).take(member) - 1
    segment = _segments(records, settings)[rows]
    for number in np.unique(segment):
        members = np.flatnonzero(segment == number)
        # sorted, so that sums do not depend on the order of the points
        counts = np.sort(count[members]).astype(float)
        threshold, _, above, share = otsu(counts)
        keep[rows[members]] = count[members] >= (min(threshold, RIM_NEIGHBOUR_SHARE * above) if share > 0 else 0.0)
    return keep


# What users choose among, as `MarkingSettings.method`; thresholds on the intensity image are our own
METHODS: dict[str, PaintMethod | None] = {"multi-threshold": None, "intensity-peaks": IntensityPeaks(), "point-segments": PointSegments()}
