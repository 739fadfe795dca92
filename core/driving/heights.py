"""Heights of driving lines: the road's own.

A height is the median of the road points near the line. Where the road was not scanned, the marking lines beside it give the height, moved up
or down to what the road says nearby. Then stray heights are taken out, and the others are smoothed along the lane.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d, median_filter

from ..common.arrays import order_by
from ..common.parallel import check_cancelled
from ..execution.in_step import Asked, Work
from ..execution.phase import Phase
from ..markings.cross_section.sections import STATION_STEP, CrossSections
from ..survey.store.records import COORDINATE_SCALE
from ..survey.store.road_points import RoadPoints
from .lane_track import LaneTrack, spans_of
from .weights import HEIGHTS

OFFSET_GRAIN_BITS = 4   # derived: bits: points are sorted by offset to 1.6 mm
HEIGHT_WINDOW = 20.0   # derived: m of road points in memory at a time
HEIGHT_POINTS = 500_000   # derived: road points that a worker process looks at, about: 30 ms of its time


def road_heights(road_points: RoadPoints | None, roads: Sequence[tuple[int, np.ndarray, list[LaneTrack]]]) -> Work:
    """The work that measures heights along lanes: (N,) z for each track of each road, the median of road points within 0.3 m of the places.

    It is NaN where there are fewer than 3; None of each track without road points.

    roads : number of each, (K,) m its stations, and its lanes
    """
    if road_points is None:
        return [[None] * len(tracks) for _, _, tracks in roads]
    result = [[np.full(len(track), np.nan) for track in tracks] for _, _, tracks in roads]
    size, length = int(HEIGHT_WINDOW / STATION_STEP), road_points.store.section_length
    windows, places, points = [], [], 0
    for of_road, (road, s, tracks) in zip(result, roads):
        spans = spans_of(tracks)
        points += sum(road_points.store.size(road, number) for number in road_points.sections(road))
        # a grid that begins elsewhere has the same windows
        for end in range(size - int(np.rint(s[0] / STATION_STEP)) % size, len(s) + size, size):
            first, last = max(end - size, 0), min(end, len(s)) - 1
            inside = [(k, max(first, tracks[k].first), min(last, tracks[k].last)) for k in spans.near(first, last).tolist()]
            if inside:
                sections = [int(np.floor((s[k] + side * STATION_STEP / 2) / length)) for k, side in ((first, -1), (last, 1))]
                lanes = [(np.arange(a, b + 1) - first, tracks[k].d[a - tracks[k].first:b - tracks[k].first + 1]) for k, a, b in inside]
                windows.append((road, *sections, s[first:last + 1], lanes))
                places.append([of_road[k][a - tracks[k].first:b + 1 - tracks[k].first] for k, a, b in inside])
    phase = Phase(heights_of_windows, road_points, (), lambda item: road_points.survey.stretch(item[0][0], item[0][3][0], item[0][3][-1]),
                  state=lambda item: [road_points.store.state((road, first, last + 1)) for road, first, last, *_ in item],
                  listed=max(HEIGHT_POINTS * len(windows) // max(points, 1), 1))
    for lanes_of_window, heights in zip(places, (yield Asked(phase, windows, 1.0))):
        for place, z in zip(lanes_of_window, heights):
            place[:] = z
    return result


def heights_of_windows(road_points: RoadPoints, item: list[tuple[Any, ...]]) -> list[list[np.ndarray]]:
    """The phase that measures heights along lanes: of each window the (M,) heights of each lane.

    `item` : of each window its road, the first and the last section that it lies in, (K,) m its stations, and of each lane (M,) int those that it
    has, and (M,) m its offsets there.
    """
    result = []
    for road, first, last, s, lanes in item:
        check_cancelled()
        sections = [road_points.section(road, number).records for number in range(first, last + 1)]
        result.append(_heights([records for records in sections if len(records)], s, lanes))
    return result


def _heights(sections, s, lanes):
    """Median heights along lanes, each (cells, offsets), of sections of road points about grid stations s."""
    # where points are dense, those right beside the grid stations are enough
    close = _Near(sections, s, np.arange(len(s)), HEIGHTS.dense_slice, lanes)
    medians = close.medians(lanes) if close.most >= HEIGHTS.dense_count else [(np.full(len(d), np.nan), np.zeros(len(d), int)) for _, d in lanes]
    few = [np.flatnonzero(count < HEIGHTS.dense_count) for _, count in medians]
    lacking = [(cells[rows], d[rows]) for (cells, d), rows in zip(lanes, few)]
    cells = np.unique(np.concatenate([cells for cells, _ in lacking]))
    if len(cells):
        for (z, _), rows, (more, count) in zip(medians, few, _Near(sections, s, cells, STATION_STEP / 2, lacking).medians(lacking)):
            z[rows] = np.where(count >= HEIGHTS.min_points_per_height, more, np.nan)
    return [z for z, _ in medians]


def _beside(lanes):
    """A table by offset, in grains, of what lies within reach of lanes (offsets in metres): its first grain, and the table."""
    spans = np.array([(d.min() - HEIGHTS.height_reach, d.max() + HEIGHTS.height_reach) for d in lanes]) / COORDINATE_SCALE
    spans = np.stack([np.floor(spans[:, 0]), np.ceil(spans[:, 1])], axis=1).astype(np.int32) >> OFFSET_GRAIN_BITS
    first = np.int32(spans[:, 0].min() - 1)
    table = np.zeros(spans[:, 1].max() - first + 2, bool)
    for low, high in (spans - first).tolist():
        table[low:high + 1] = True
    return first, table


class _Near:
    """Road points at most `reach` metres of station from some cells of a grid and near lanes; `most` of them in a cell."""

    def __init__(self, sections, s, cells, reach, lanes):
        # of the points' own kind, or all stations would be copied to compare them
        bounds = np.ceil((s[cells] + reach * np.array([[-1], [1]])) / COORDINATE_SCALE).astype(np.int32)
        first, near_lanes = _beside([d for _, d in lanes if len(d)])
        parts = [(np.empty(0, int), *np.empty((2, 0), np.int32))]
        for records in sections:
            # points lie by station
            low, high = np.searchsorted(records["s"], bounds)
            count = high - low
            end = np.cumsum(count)
            even = np.array_equal(low[1:], high[:-1])   # one cell begins where the last one ends
            rows = low[:1] if even else np.arange(end[-1]) + np.repeat(low - (end - count), count)
            offset = (records[int(low[0]):int(high[-1])] if even else records.take(rows))["d"]
            kept = np.flatnonzero(near_lanes.take((offset >> OFFSET_GRAIN_BITS) - first, mode="clip"))
            parts.append((np.repeat(cells, np.diff(np.searchsorted(kept, end), prepend=0)), offset.take(kept),
                          records.take(kept + rows if even else rows.take(kept))["z"]))
        self.cell, self.offset, self.height = (np.concatenate(columns) for columns in zip(*parts))
        self.most = int(np.bincount(self.cell).max(initial=0))

    def medians(self, lanes):
        """[((M,) median heights, (M,) number of points)] within reach of each lane: (M,) cells, ascending, and (M,) offsets there."""
        order = order_by(self.offset >> OFFSET_GRAIN_BITS)
        self.offset, self.cell, self.height = (values.take(order) for values in (self.offset, self.cell, self.height))
        self.across = self.offset >> OFFSET_GRAIN_BITS
        return [self._medians(*lane) if len(lane[0]) else (np.empty(0), np.empty(0, int)) for lane in lanes]

    def _medians(self, cells, d):
        middle, reach = np.rint(d / COORDINATE_SCALE).astype(np.int32), int(HEIGHTS.height_reach / COORDINATE_SCALE)
        low, high = np.array([middle.min() - reach, middle.max() + reach], np.int32) >> OFFSET_GRAIN_BITS
        window = slice(np.searchsorted(self.across, low), np.searchsorted(self.across, high, side="right"))
        number_of_cell = np.full(int(cells[-1]) + 2, -1)
        number_of_cell[cells] = np.arange(len(cells))
        cell = number_of_cell.take(self.cell[window], mode="clip")
        inside = np.flatnonzero((cell >= 0) & (np.abs(self.offset[window] - middle.take(cell, mode="clip")) <= reach))
        cell, height = cell[inside], self.height[window][inside]
        height = height[order_by(height, cell)] * COORDINATE_SCALE
        count = np.bincount(cell, minlength=len(cells))
        begin = np.cumsum(count) - count
        medians, filled = np.full(len(cells), np.nan), np.flatnonzero(count)
        lower, upper = begin + (count - 1) // 2, begin + count // 2
        medians[filled] = (height[lower[filled]] + height[upper[filled]]) / 2
        return medians, count


def _line_heights(lines: CrossSections, first: int, d: np.ndarray) -> np.ndarray:
    """(N,) height between the marking lines (or beside them) at offsets d from grid station `first` on."""
    spans, end = lines.d.spans, first + len(d)
    # the nearest line on either side, and its height
    a, b, za, zb = np.repeat([[np.inf], [np.inf], [np.nan], [np.nan]], len(d), axis=1)
    for row in spans.near(first, end - 1).tolist():
        window = spans.values_of(row, first, end)
        begin = max(int(spans.first[row]) - first, 0)
        inside = slice(begin, begin + window.stop - window.start)
        offset, z = lines.d.values[window], lines.z.values[window]
        for sign, smallest, height in ((1, a[inside], za[inside]), (-1, b[inside], zb[inside])):
            apart = sign * (offset - d[inside])
            nearer = np.isfinite(z) & (apart < smallest) & ((apart >= 0) if sign > 0 else (apart > 0))
            smallest[nearer], height[nearer] = apart[nearer], z[nearer]
    with np.errstate(invalid="ignore"):
        between = (za * b + zb * a) / (a + b)
    return np.where(np.isfinite(a) & np.isfinite(b), between, np.where(np.isfinite(a), za, np.where(np.isfinite(b), zb, np.nan)))


def _smooth_heights(z: np.ndarray) -> np.ndarray:
    """Gaps closed along the lane, stray medians taken out, the rest smoothed; NaN only if all is."""
    finite = np.isfinite(z)
    if not finite.any():
        return z
    rows = np.arange(len(z))
    z = np.interp(rows, rows[finite], z[finite])
    z = median_filter(z, size=min(7, len(z)), mode="nearest")
    # slopes go on beyond the ends
    pad = min(int(4 * HEIGHTS.height_smoothing_sigma / STATION_STEP), len(z) - 1)
    if pad < 1:
        return z
    head, tail = 2 * z[0] - z[1:pad + 1][::-1], 2 * z[-1] - z[-pad - 1:-1][::-1]
    return gaussian_filter1d(np.r_[head, z, tail], HEIGHTS.height_smoothing_sigma / STATION_STEP)[pad:pad + len(z)]


def lane_heights(lines: CrossSections, tracks: list[LaneTrack], measured: Sequence[np.ndarray | None]) -> list[np.ndarray]:
    """Local z along every lane, (N,) each: that of `road_heights` where it is known, else from the marking lines beside it."""
    result = []
    for track, of_road in zip(tracks, measured):
        z = _line_heights(lines, track.first, track.d)
        if of_road is not None and (shared := np.isfinite(of_road) & np.isfinite(z)).any():
            # where the road was not scanned the lines' height serves, shifted to what the road says nearby
            rows = np.arange(len(z))
            z = z + np.interp(rows, rows[shared], (of_road - z)[shared])
        result.append(_smooth_heights(z if of_road is None else np.where(np.isfinite(of_road), of_road, z)))
    return result
