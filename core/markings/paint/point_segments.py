"""Paint by thresholds on the points of segments across the road, and by density.

No image is used: road points are split across the direction of travel, so that a
segment has one point density and one range; Otsu's threshold is taken for each, and
bright points with few bright neighbours are noise.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...intensity.asphalt_model import asphalt_statistics
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points, take_rows
from ...survey.store.road_points import RoadPoints
from ..road_grid import occupied
from .asphalt_level import otsu

MIN_SEGMENT_POINTS = 200    # of a segment, below which it has no threshold and no paint
RIM_NEIGHBOUR_SHARE = 0.5    # of the neighbours usual inside of paint: a point on its rim has half of them
HISTOGRAM_RANGE = 6.0, 60.0     # spreads below and above the median of asphalt: the range of Otsu's histogram


@dataclass(frozen=True)
class SegmentSettings:
    """How road points are split, and when a bright one is paint.

    length, width : m, of a segment along and across the road
    separation : spreads of asphalt between the means of the two classes, below which a segment has no paint
    radius : m around a bright point in which its bright neighbours are counted
    """

    length: float = setting(10.0, 0.5, 200.0, "The length of a segment", "m")
    width: float = setting(1.0, 0.1, 50.0, "The width of a segment", "m")
    separation: float = setting(3.0, 0.0, 50.0, "The distance of paint from asphalt", "spreads")
    radius: float = setting(0.12, 0.01, 1.0, "The radius in which neighbours are counted", "m")

    def __post_init__(self) -> None:
        check_limits(self)


def points_in_segments(road_points: RoadPoints, road: int, settings: SegmentSettings, progress: Progress) -> Iterator[Columns]:
    """Yield the records of one road's points that are paint, segment row by segment row.

    Parameters
    ----------
    road_points : RoadPoints, corrected or not
    road : its number
    settings : SegmentSettings
    progress : Progress

    Notes
    -----
    Point-based after Yu et al. (2015) without its learned part (small
    markings), as summarised in the driving-line thesis: Otsu's threshold per segment
    across the road, then a threshold after Otsu on the counts of neighbours. Our own
    are the sizes, the rule that leaves a segment without paint empty, and the rule
    that half of the neighbours usual inside of paint are enough, as its rim has no more.
    """
    length = int(round(settings.length / COORDINATE_SCALE))
    start, end = road_points.store.span(road)
    windows = list(range(int(np.floor(start / COORDINATE_SCALE / length)), int(np.floor(end / COORDINATE_SCALE / length)) + 1))

    def limits_of(window):
        records = _window(road_points, road, window * length, (window + 1) * length)
        return segment_thresholds(records, settings)

    limits = dict(zip(windows, ordered_map(limits_of, windows, progress.part(0.0, 0.5))))
    reach = int(np.ceil(settings.radius / COORDINATE_SCALE)) + 1

    def paint_of(window):
        first, last = window * length, (window + 1) * length
        records = _bright(_window(road_points, road, first - reach, last + reach), length, limits, settings)
        own = (records["s"] >= first) & (records["s"] < last)
        return take_rows(records, own & dense_enough(records, own, settings))

    yield from ordered_map(paint_of, windows, progress.part(0.5, 1.0))


def _window(road_points, road, first, last):
    """Records with first <= s < last, units of 0.1 mm."""
    records = road_points.window(road, (first - 1) * COORDINATE_SCALE, (last + 1) * COORDINATE_SCALE).records
    return take_rows(records, (records["s"] >= first) & (records["s"] < last))


def _segments(records, settings):
    """(N,) int, the segment across the road that each record lies in."""
    return (records["d"] // int(round(settings.width / COORDINATE_SCALE))).astype(np.int64)


def segment_thresholds(records: Columns, settings: SegmentSettings) -> dict[int, float]:
    """The least intensity of paint in the segments of one row across the road.

    Parameters
    ----------
    records : (N,) columns of road points
    settings : SegmentSettings

    Returns
    -------
    threshold by number of the segment, infinite where there is no paint
    """
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
        for place, value in limits.get(number, {}).items():
            if 0 <= place - first[1] < table.shape[1]:
                table[number - first[0], place - first[1]] = value
    return take_rows(records, Points(records).value > table[window - first[0], segment - first[1]])


def dense_enough(records: Columns, own: np.ndarray, settings: SegmentSettings) -> np.ndarray:
    """Points with as many bright neighbours as paint has.

    Parameters
    ----------
    records : (N,) columns of bright road points
    own : (N,) bool, the points to decide on; the others only count as neighbours
    settings : SegmentSettings

    Returns
    -------
    (N,) bool, a subset of `own`
    """
    keep = np.zeros(len(records), bool)
    if not own.any():
        return keep
    places = np.c_[records["s"], records["d"]] * COORDINATE_SCALE
    rows = np.flatnonzero(own)
    # points at one place have the same neighbours: where a cloud holds points several times, each place is searched once
    asked, member = occupied(records["s"].take(rows), records["d"].take(rows))
    count = cKDTree(places).query_ball_point(asked * COORDINATE_SCALE, settings.radius, return_length=True).take(member) - 1
    segment = _segments(records, settings)[rows]
    for number in np.unique(segment):
        here = np.flatnonzero(segment == number)
        # sorted, so that sums do not depend on the order of the points
        counts = np.sort(count[here]).astype(float)
        threshold, _, above, share = otsu(counts)
        keep[rows[here]] = count[here] >= (min(threshold, RIM_NEIGHBOUR_SHARE * above) if share > 0 else 0.0)
    return keep
