"""Offsets between two passes over the same stretch of road: across, along and up.

Navigation drifts by centimetres between two drives, so that every curb and line appears twice. Both passes are rasterised as strips of cells; slow
variations of height and intensity are removed; the strips are correlated at every offset up to 30 cm. The offset of best correlation is the offset
between the passes. Objects that only one pass measured, such as vehicles, do not correlate and have no effect.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.ndimage import gaussian_filter1d, maximum_filter1d, median_filter, minimum_filter1d

from ...common.features import PASS_SIGMA, Features
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...curves.robust import MAD_TO_SIGMA
from ...lazy import laspy
from ..frame.road_frame import Pass
from ..frame.row_table import SigmaAlong
from ..store.columns import Columns
from ..store.records import COORDINATE_SCALE, Points, to_units
from ..weights import REGISTER

# Corrections of passes that were adjusted to each other; stored with the points, so that measured coordinates can be restored.

MovedPoints = tuple[int, np.ndarray, tuple[np.ndarray, ...]]   # number of a pass, (N,) rows of its points, and (N,) metres east, north and up
VLR_USER_ID = "Lanewright"    # of the LAS records, one per pass; the record id is the pass number + 1
_HEAD = np.dtype([("first", "<f8"), ("count", "<u4")])


@dataclass(frozen=True)
class PassCorrections:
    """East, north and up corrections of every pass that was moved, by station."""

    # {pass number: (m of the first node, (3, N) int16 in 0.1 mm)}, nodes `correction_step` apart; constant beyond the first and the last
    by_pass: dict[int, tuple[float, np.ndarray]]

    def metres(self, number: int, s: np.ndarray) -> tuple[np.ndarray, ...]:
        """East, north and up corrections, (N,) metres each, of a pass at (N,) stations."""
        first, values = self.by_pass[number]
        nodes = first + REGISTER.correction_step * np.arange(values.shape[1])
        return tuple(np.interp(s, nodes, row) * COORDINATE_SCALE for row in values)

    def units(self, records: Columns | np.ndarray) -> np.ndarray:
        """(3, N) int32 corrections of x, y and z of moved points (Columns or structured records), in units of 0.1 mm."""
        corrections = np.zeros((3, len(records)), np.int32)
        for _, rows, metres in self.of_points(records):
            corrections[:, rows] = [to_units(v) for v in metres]
        return corrections

    @property
    def reach(self) -> float:
        """m, how far any point is moved in plan at most."""
        return max(float(np.hypot(*np.abs(values[:2]).max(axis=1) * COORDINATE_SCALE)) for _, values in self.by_pass.values())

    def of_points(self, records: Columns | np.ndarray) -> Iterator[MovedPoints]:
        """Yield the corrections of points (Columns or structured records), pass by pass."""
        numbers = records["pass_number"]
        for number in np.unique(numbers).tolist():
            if number in self.by_pass:
                rows = np.flatnonzero(numbers == number)
                yield number, rows, self.metres(number, records["s"].take(rows) * COORDINATE_SCALE)

    def to_records(self) -> list[Any]:
        """The corrections as LAS variable length records, one per pass."""
        return [laspy.VLR(VLR_USER_ID, number + 1, "Move of a pass",
                          np.array([(first, values.shape[1])], _HEAD).tobytes() + np.ascontiguousarray(values, "<i2").tobytes())
                for number, (first, values) in sorted(self.by_pass.items())]

    @classmethod
    def of_records(cls, records: Iterable[Any]) -> PassCorrections | None:
        """Read what `to_records` wrote, from the records of a file; None where there is nothing."""
        by_pass = {}
        for record in records:
            if record.user_id.rstrip("\0") == VLR_USER_ID:
                data = bytes(record.record_data_bytes())
                first, count = np.frombuffer(data, _HEAD, 1)[0].tolist()
                by_pass[record.record_id - 1] = first, np.frombuffer(data, "<i2", 3 * count, _HEAD.itemsize).reshape(3, count)
        return cls(by_pass) if by_pass else None


AXES = "along", "left", "up"
PLAN_AXES = AXES[:2]
CHANNELS = "steps", "paint"
CHANNEL_SCALE = {"steps": 1e4, "paint": 64.0}  # cost: units per m, and per standard deviation of intensity
WINDOW_LENGTH = REGISTER.correction_step          # m of road compared at a time, counted from station 0
LAGS = np.arange(-int(round(REGISTER.max_offset / REGISTER.lag_cell)), int(round(REGISTER.max_offset / REGISTER.lag_cell)) + 1)
_ROUGH_REACH = int(REGISTER.max_rough_offset / REGISTER.lag_cell / 2)
ROUGH_LAGS = 2 * np.arange(-_ROUGH_REACH, _ROUGH_REACH + 1)   # narrower than half of a line


@dataclass(frozen=True)
class PassOffsets:
    """Offsets to be added to pass `other` to match pass `one`, window by window of a road."""

    one: int   # one, other: pass numbers
    other: int
    stations: np.ndarray   # (N,) middles of the windows, m
    along: np.ndarray   # along, left, up: (N,) metres, NaN where unknown
    left: np.ndarray
    up: np.ndarray
    far: np.ndarray   # (K,) middles of the windows in which the offset seems to exceed `max_offset`
    rebuilt: np.ndarray | float = 0.0   # (N,) m across of ground that lies at another height all along the window

    def everywhere(self, axis: str) -> np.ndarray:
        """(N,) metres along an axis, interpolated where unknown; 0 where nothing is known."""
        values = getattr(self, axis)
        measured = np.isfinite(values)
        return np.interp(self.stations, self.stations[measured], values[measured]) if measured.any() else np.zeros(len(values))


@dataclass(frozen=True)
class Strips:
    """One pass, or one scanner of it, in one window: rows of cells of height and intensity without their slow variations."""

    heights: np.ndarray   # heights, steps: (rows, cells) float32, m, NaN where unknown; offsets are measured along a row
    steps: np.ndarray
    paint: np.ndarray   # the same, in units of its robust standard deviation; NaN at faces, of whose brightness each drive sees another side

    @classmethod
    def of(cls, fine: np.ndarray, coarse: np.ndarray, h: np.ndarray, intensity: np.ndarray, shape: tuple[int, int]) -> Strips:
        """The strips of (N,) points, in so many rows and cells of a shape.

        fine, coarse : (N,) m along a row, in whose direction offsets are measured, and across rows
        h : (N,) m above the road
        """
        row, cell = np.trunc(coarse / REGISTER.row_cell), np.trunc(fine / REGISTER.lag_cell)   # NaN beyond a corridor lies in no cell
        inside = (row >= 0) & (row < shape[0]) & (cell >= 0) & (cell < shape[1])
        flat_index = (row * shape[1] + cell)[inside].astype(np.int64)

        count, rises, light = (np.bincount(flat_index, weights, shape[0] * shape[1]).reshape(shape).astype(np.float32)
                               for weights in (None, h[inside], intensity[inside]))

        def means(total, count):
            with np.errstate(invalid="ignore", divide="ignore"):
                return np.where(count > 0.5, total / count, np.float32(np.nan))

        # over neighbouring cells, where points are farther apart than cells
        heights = means(*(_box_sum(part, REGISTER.height_blur_cells) for part in (rises, count)))
        steps = np.clip(_detrended(heights), -REGISTER.max_step, REGISTER.max_step)
        paint = _detrended(np.where(_at_faces(heights), np.float32(np.nan), means(light, count)))
        finite = np.isfinite(paint)
        spread = float(np.median(np.abs(paint[finite]))) / 0.6745 if finite.any() else 0.0
        return cls(heights, steps, np.clip(paint / max(spread, 1e-6), -REGISTER.max_contrast, REGISTER.max_contrast))

    def part(self, rows: slice, cells: slice) -> Strips:
        return Strips(self.heights[rows, cells], self.steps[rows, cells], self.paint[rows, cells])


def strips_of(ahead: np.ndarray, left: np.ndarray, h: np.ndarray, intensity: np.ndarray, length: float) -> list[Strips]:
    """The strips across and along of (N,) points, as of `points_on_strip`, on so many metres of road."""
    wide = 2 * REGISTER.strip_half_width
    return [Strips.of(fine, coarse, h, intensity, (round(width / REGISTER.row_cell), round(size / REGISTER.lag_cell)))
            for fine, coarse, size, width in ((left, ahead, wide, length), (ahead, left, length, wide))]


def points_on_strip(survey: Any, road: int, start: float, length: float, points: Points, driven: Pass | None = None) -> tuple[np.ndarray, ...]:
    """The points about the height of a road: (N,) rows, m ahead of its start, m left of the right end of the strip, and m above the road.

    driven : Pass beside whose track and in whose direction they are looked at; None for the reference line
    """
    s, d = points.s, points.d
    nodes = start + np.arange(int(length / REGISTER.row_cell) + 1) * REGISTER.row_cell
    h = points.z - np.interp(s, nodes, survey.road_height(road, nodes))
    left = d if driven is None else driven.direction * (d - driven.at_station(s)[0])
    near = np.flatnonzero((np.abs(left) < REGISTER.strip_half_width) & (h > REGISTER.min_cell_height) & (h < REGISTER.max_cell_height))
    ahead = s[near] - start if driven is None or driven.direction > 0 else start + length - s[near]
    return near, ahead, left[near] + REGISTER.strip_half_width, h[near]


def _at_faces(heights):
    """(rows, cells) bool, whether heights differ by `face_height` within `face_cells`; unknown ones do not."""
    finite, far = np.isfinite(heights), np.float32(1e3)
    return (maximum_filter1d(np.where(finite, heights, -far), REGISTER.face_cells, axis=1)
            - minimum_filter1d(np.where(finite, heights, far), REGISTER.face_cells, axis=1)) > REGISTER.face_height


def _detrended(values):
    """Values minus their mean over `detrend_cells` cells of the row; NaN stays."""
    finite = np.isfinite(values)
    total, count = (_box_sum(part, REGISTER.detrend_cells) for part in (np.where(finite, values, np.float32(0)), finite.astype(np.float32)))
    return values - total / np.maximum(count, 1)


def _box_sum(values, cells):
    """Moving sums over an odd number of cells of each row, float32."""
    total = np.zeros((len(values), values.shape[1] + cells))
    total[:, cells // 2 + 1:total.shape[1] - cells // 2] = values
    np.cumsum(total, axis=1, out=total)
    return (total[:, cells:] - total[:, :-cells]).astype(np.float32)


def correlation_sums(one: Strips, other: Strips, lags: np.ndarray = LAGS) -> np.ndarray:
    """(2, 4, L) per channel and lag: sums of products, of squares of either strip, and counts, over the cells known in both.

    All lags at once, by Fourier transforms along the rows (the correlation theorem); whole numbers, so that what they leave is rounded away.
    """
    cells = one.heights.shape[1]
    size = next_fast_len(cells + int(np.abs(lags).max()), real=True)
    sums = np.zeros((2, 4, len(lags)))
    for k, name in enumerate(CHANNELS):
        spectra = []
        for strips in (one, other):
            finite = np.isfinite(getattr(strips, name))
            values = np.where(finite, np.rint(getattr(strips, name) * CHANNEL_SCALE[name]), 0.0).astype(float)
            spectra.append([rfft(part, size, axis=1) for part in (values, values * values, finite.astype(float))])
        (a, a2, mask_a), (b, b2, mask_b) = spectra
        for i, (left, right) in enumerate(((a, b), (a2, mask_b), (mask_a, b2), (mask_a, mask_b))):
            sums[k, i] = np.rint(irfft((left * right.conj()).sum(axis=0), size)[lags])
    return sums


def height_offset(one: Strips, other: Strips, lag: int) -> float:
    """Median height of `one` above `other` moved by `lag`, of flat cells, m; NaN for too few cells."""
    a, b = (slice(max(way * lag, 0), one.heights.shape[1] + min(way * lag, 0)) for way in (1, -1))
    off = one.heights[:, a] - other.heights[:, b]
    level = np.maximum(np.abs(one.steps[:, a]), np.abs(other.steps[:, b])) < REGISTER.flat_step
    off = off[level & np.isfinite(off)]
    return float(np.median(off)) if len(off) >= REGISTER.min_shared_cells else np.nan


def _rebuilt_width(one, other, up):
    """m across of ground that lies at another height all along two strips, one `up` above the other, as where curbs were moved; 0 for little."""
    off = one.heights - other.heights - up
    known = np.count_nonzero(np.isfinite(off), axis=0)
    low, high = REGISTER.rebuilt_heights
    share = np.maximum(*(np.count_nonzero((way * off > low) & (way * off < high), axis=0) for way in (1, -1))) / np.maximum(known, 1)
    metres = np.count_nonzero((share > REGISTER.rebuilt_share) & (known > len(off) / 2)) * REGISTER.lag_cell
    return metres if metres > REGISTER.least_rebuilt else 0.0


def pass_offsets(survey: Any, road: int, progress: Progress = Progress()) -> list[PassOffsets]:
    """Offsets between the passes over a road of a Survey with times, each with the next one there.

    Oblique bars, as of hatched areas, look moved along where they were moved across, and the other way round. So where passes lie apart, the
    offsets along one axis are taken out before those along the other are measured, and then the other way round. Lines along the road show what
    is across alone, so offsets along come first only where they are much the larger.
    """
    windows = _windows_of_several(survey, road)
    evidence = _seen(survey, road, windows, {}, progress.part(0.0, 1.0 / 3.0))
    offsets = _combined(evidence)
    rough = {(pair.one, pair.other): places for pair in offsets if (places := _rough_offsets(survey, road, pair))}
    if rough:
        evidence = _seen(survey, road, windows, rough, progress.part(1.0 / 3.0, 1.0 / 3.0))
        offsets = _combined(evidence)
    # m between the passes along and across, of the pair that is farthest apart
    along, left = (max((float(np.mean(np.abs(pair.everywhere(axis)))) for pair in offsets), default=0.0) for axis in PLAN_AXES)
    order = PLAN_AXES if along > REGISTER.much_larger * left else PLAN_AXES[::-1]
    offsets = _uncoupled(survey, road, offsets, evidence, rough, order, progress)
    return [_with_rough(pair, rough.get((pair.one, pair.other), {})) for pair in offsets]


def _uncoupled(survey, road, offsets, seen, rough, order, progress):
    """The PassOffsets, those along each axis of the order measured with those along the other taken out."""
    for k, (taken, measured) in enumerate((order, order[::-1]), start=1):
        moves = {(pair.one, pair.other): _taken_out(pair, taken, rough.get((pair.one, pair.other), {})) for pair in offsets}
        if windows := sorted({number for places in moves.values() for number in places}):
            evidence = _seen(survey, road, windows, moves, progress.part(k / 3.0, (k + 1) / 3.0))
            offsets = _measured_again(offsets, measured, seen, evidence)
    return offsets


def _windows_of_several(survey, road):
    """Numbers of the windows of a road that at least two passes drove through."""
    start, end = survey.store.span(road)
    passes = survey.frame.passes_of(road)
    windows = range(int(np.floor(start / WINDOW_LENGTH)), int(np.ceil(end / WINDOW_LENGTH)))
    return [number for number in windows
            if sum(p.span[0] < (number + 1) * WINDOW_LENGTH and p.span[1] > number * WINDOW_LENGTH for p in passes) > 1]


def _combined(seen):
    """PassOffsets of pairs of passes from what `_seen` gives."""
    return [_combine_windows(pair, evidence) for pair, evidence in sorted(seen.items())]


def _taken_out(pair, axis, rough):
    """{window: (along, left) by which the second of two passes is to be moved} to take out the offsets along one axis; `rough` the same, before."""
    moves = {}
    for number, metres in zip((pair.stations // WINDOW_LENGTH).astype(int).tolist(), pair.everywhere(axis).tolist()):
        if abs(metres) > REGISTER.min_coupled_offset:
            along, left = rough.get(number, (0.0, 0.0))
            moves[number] = (along + metres, left) if axis == "along" else (along, left + metres)
    return moves


def _measured_again(offsets, axis, seen, again):
    """The PassOffsets with offsets along an axis from evidence in which those along the other are taken out, where there is such evidence."""
    of_window = {pair: {row[0]: row for row in rows} for pair, rows in again.items()}
    evidence = {pair: [of_window.get(pair, {}).get(row[0], row) for row in rows] for pair, rows in seen.items()}
    return [replace(before, **{axis: getattr(after, axis)}, rebuilt=np.minimum(before.rebuilt, after.rebuilt))
            for before, after in zip(offsets, _combined(evidence))]


def _with_rough(pair, places):
    """PassOffsets with the rough offsets by which the second pass was moved before."""
    if not places:
        return pair
    along, left = np.array([places[number] for number in (pair.stations // WINDOW_LENGTH).astype(int).tolist()]).T
    # what the second look does not show remains as the rough one found it
    return replace(pair, **{name: np.where(np.isnan(fine) & (rough != 0.0), rough, fine + rough)
                            for name, fine, rough in (("along", pair.along, along), ("left", pair.left, left))})


def _rough_offsets(survey, road, pair):
    """{window: (along, left) by which the second of two passes is to be moved} where they lie farther apart than `max_offset`; {} where they do not.

    Drives of different years, or in different datums, lie apart by as much as a metre. Where hardly any window shows an offset, or large ones,
    and where none shows one along the road, groups of windows are searched up to `max_rough_offset`.
    """
    measured = pair.left[np.isfinite(pair.left)]
    across = len(measured) < REGISTER.min_compared * len(pair.left) or len(pair.far) > 0 or np.median(np.abs(measured)) > REGISTER.max_offset / 2
    if not across and np.isfinite(pair.along).any():
        return {}
    numbers = (pair.stations // WINDOW_LENGTH).astype(int)
    along, left = _of_groups(survey, road, pair, numbers)
    if max(np.abs(along).max(), np.abs(left).max()) <= REGISTER.max_offset:
        return {}
    if not across:
        left = np.zeros(len(numbers))
    return {number: (a, b) for number, a, b in zip(numbers.tolist(), along.tolist(), left.tolist())}


def _of_groups(survey, road, pair, numbers):
    """(N,) m along and (N,) m left at N windows, up to `max_rough_offset`, as groups of them show; 0 along an axis that few groups show."""
    starts = np.unique(np.linspace(0, max(len(numbers) - REGISTER.rough_group, 0), REGISTER.rough_groups).astype(int)).tolist()
    rows = []
    for group in (numbers[start:start + REGISTER.rough_group] for start in starts):
        evidence = [window[pair.one, pair.other]
                    for window in ordered_map(lambda number: _window_evidence(survey, road, number, {}, ROUGH_LAGS), group.tolist())
                    if (pair.one, pair.other) in window]
        if evidence:
            rows.append((np.mean(group), *(_rough_offset(np.sum([window[k] for window in evidence], axis=0)) for k in (1, 0))))
    middles, *columns = np.array(rows).reshape(-1, 3).T
    metres = []
    for column in columns:
        finite = np.isfinite(column)
        # one group alone may be wrong, the median of three neighbours is not
        metres.append(np.interp(numbers, middles[finite], median_filter(column[finite], 3, mode="nearest"))
                      if finite.sum() > len(starts) / 3 else np.zeros(len(numbers)))
    return metres


def _rough_offset(likeness):
    """m of best correlation up to `max_rough_offset` from (2, 4, L) sums, by paint where it shows one."""
    offsets = best_offsets(likeness, ROUGH_LAGS)[0]
    steps, paint = (offsets[CHANNELS.index(name)] for name in CHANNELS)
    return paint if np.isfinite(paint) else steps


def _seen(survey, road, windows, moves, progress):
    """{(one, other): [(window, *evidence)]} of pairs of passes after the second of a pair was moved; `moves` as in `_window_evidence`."""
    by_pair: dict[tuple[int, int], list] = {}
    for number, of_window in zip(windows, ordered_map(lambda number: _window_evidence(survey, road, number, moves), windows, progress)):
        for pair, evidence in of_window.items():
            by_pair.setdefault(pair, []).append((number, *evidence))
    return by_pair


def _window_evidence(survey, road, number, moves, lags=LAGS):
    """{(one, other): (correlation sums across, correlation sums along, height offset, m rebuilt)} of a window, each pass with the next.

    moves : {(one, other): {window: (along, left) by which the other is moved before}}
    """
    points = survey.window(road, number * WINDOW_LENGTH, (number + 1) * WINDOW_LENGTH)
    near, s, d, h = points_on_strip(survey, road, number * WINDOW_LENGTH, WINDOW_LENGTH, points)
    owner, intensity = points.pass_number.take(near), points.intensity.take(near).astype(float)

    def strips(of_pass, along=0.0, left=0.0):
        """Strips across and along of the points of a pass, moved."""
        return strips_of(s[of_pass] + along, d[of_pass] + left, h[of_pass], intensity[of_pass], WINDOW_LENGTH)

    rows = {pass_number: of_pass for pass_number in np.unique(owner).tolist()
            if len(of_pass := np.flatnonzero(owner == pass_number)) > REGISTER.min_shared_cells}
    still, evidence = cache(lambda pass_number: strips(rows[pass_number])), {}
    for pass_number, next_number in zip(list(rows)[:-1], list(rows)[1:]):
        move = moves.get((pass_number, next_number), {}).get(number)
        across, lengthwise = strips(rows[next_number], *move) if move is not None else still(next_number)
        up = height_offset(still(pass_number)[0], across, 0)
        evidence[pass_number, next_number] = (correlation_sums(still(pass_number)[0], across, lags),
                                              correlation_sums(still(pass_number)[1], lengthwise, lags),
                                              up, _rebuilt_width(still(pass_number)[0], across, up))
    return evidence


def _combine_windows(pair, evidence):
    """PassOffsets of two passes from the evidence of their windows, pooled with neighbouring windows."""
    numbers = np.array([row[0] for row in evidence])
    across, lengthwise = (_pool(numbers, np.array([row[k] for row in evidence])) for k in (1, 2))
    (steps, steps_far), (paint, paint_far) = (best_offsets(across[:, k]) for k in range(len(CHANNELS)))
    # a curb face looks different from the other lane, so it is used only where no paint is found
    left, far = np.where(np.isnan(paint), steps, paint), np.where(np.isnan(paint), steps_far | paint_far, False)
    # along the road, regular scan lines hit a curb face in a periodic pattern, so only paint is used
    along, _ = best_offsets(lengthwise[:, CHANNELS.index("paint")])
    rises = np.array([row[3] for row in evidence])
    finite = np.isfinite(rises)
    total = _pool(numbers, finite.astype(float))
    up = np.where(total > 0.5, _pool(numbers, np.nan_to_num(rises)) / np.maximum(total, 1e-9), np.nan)
    stations = (numbers + 0.5) * WINDOW_LENGTH
    return PassOffsets(*pair, stations, along, left, up, stations[far], np.array([row[4] for row in evidence]))


def _pool(numbers, values):
    """(N, ...) sums over each window and its neighbours, with Gaussian weights of `pooling_sigma`."""
    sigma = REGISTER.pooling_sigma / WINDOW_LENGTH
    by_window = np.zeros((numbers[-1] - numbers[0] + 1, *values.shape[1:]))
    by_window[numbers - numbers[0]] = values
    return gaussian_filter1d(by_window, sigma, axis=0, mode="constant")[numbers - numbers[0]] * (sigma * np.sqrt(2 * np.pi))


def best_offsets(likeness: np.ndarray, lags: np.ndarray = LAGS) -> tuple[np.ndarray, np.ndarray]:
    """Offsets of best correlation, (N,) metres or NaN, from (N, 4, L) of `correlation_sums`, and (N,) bool where it is at the limit.

    Correlation, unlike the mean difference, is not affected by noise, however it is distributed over the cells.
    """
    cell = REGISTER.lag_cell * float(lags[1] - lags[0])
    prior = REGISTER.prior_offset_sigma * float(lags[-1]) / float(LAGS[-1])
    products, squares, other_squares, counts = np.moveaxis(likeness, 1, 0)
    shared = counts[:, len(lags) // 2]
    correlation = np.clip(products / np.sqrt(np.maximum(squares * other_squares, 1e-12)), 0.0, REGISTER.max_correlation)
    fit = np.log(1.0 - correlation**2) * (shared / REGISTER.correlated_cells)[:, None]
    unlikely = np.where(shared[:, None] >= REGISTER.min_shared_cells, fit, 0.0) + (REGISTER.lag_cell * lags / prior) ** 2
    best = np.argmin(unlikely, axis=1)
    least = unlikely.min(axis=1)
    clear = (least < -REGISTER.min_likelihood_ratio) & (_second_best(unlikely, best) > REGISTER.max_runner_up * least)
    limit = clear & ((best == 0) | (best == len(lags) - 1))
    # sub-cell position from a parabola through the best lag and its neighbours
    reach = REGISTER.parabola_cells
    k = np.clip(best, reach, len(lags) - 1 - reach)[:, None] + np.arange(-reach, reach + 1)
    bend, slope, _ = np.polyfit(np.arange(-reach, reach + 1.0), np.take_along_axis(unlikely, k, 1).T, 2)
    bend = np.maximum(bend, 1e-12)
    offset = REGISTER.lag_cell * lags[k[:, reach]] + cell * np.clip(-0.5 * slope / bend, -reach, reach)
    return np.where(clear & ~limit & (cell / np.sqrt(bend) < REGISTER.max_offset_sigma * cell / REGISTER.lag_cell), offset, np.nan), limit


def _second_best(unlikely, best):
    """(N,) the smallest local minimum of (N, L) values apart from the best; infinite where there is none.

    Slabs and cobbles correlate again one stone farther.
    """
    dips = np.zeros(unlikely.shape, bool)
    dips[:, 1:-1] = (unlikely[:, 1:-1] <= unlikely[:, :-2]) & (unlikely[:, 1:-1] <= unlikely[:, 2:])
    dips &= np.abs(np.arange(unlikely.shape[1]) - best[:, None]) > REGISTER.peak_cells
    return np.where(dips, unlikely, np.inf).min(axis=1)


# How far the middle of the passes over a road may be off, and how that travels from stage to stage with points and layers.

SIGMA_USER_ID = "LanewrightSigma"   # of the LAS records: FIRST_RECORD and those that follow it, and ROAD_RECORD of earlier versions
ROAD_RECORD, FIRST_RECORD = 1, 2   # derived: numbers that tell them apart
NODES_PER_RECORD = 5000      # derived: a LAS record holds 65,535 bytes
_ROAD = np.dtype([("road", "<u4"), ("sigma", "<f8")])
_NODE = np.dtype([("road", "<u4"), ("station", "<f4"), ("sigma", "<f4")])


def sigma_of_passes(offsets: list[PassOffsets]) -> SigmaAlong | None:
    """How far the middle of the passes over a road may be off across it, from what they differ, place by place; None where no offset was measured.

    Two passes with independent errors of one sigma s differ by s * sqrt(2), and the mean of n of them is off by s / sqrt(n). Single offsets
    that are far off do not count: of the RMS and the median deviation as a sigma the smaller is taken. Passes farther apart than navigation drifts
    are two surveys, of which one may be right, so that either may be off by all that they differ.
    """
    rows = np.concatenate([np.stack([pair.stations, _apart(pair), *np.broadcast_to([[pair.one], [pair.other]], (2, len(pair.stations)))])
                           for pair in offsets] or [np.empty((4, 0))], axis=1)
    rows = rows[:, np.isfinite(rows[1])]
    if not rows.size:
        return None
    stations, metres, first_numbers, second_numbers = rows[:, np.argsort(rows[0], kind="stable")]
    places = np.unique(stations)
    bounds = np.searchsorted(stations, places - REGISTER.sigma_reach), np.searchsorted(stations, places + REGISTER.sigma_reach, side="right")
    sigmas = []
    for first, end in zip(*bounds):
        spread = min(np.sqrt(np.mean(metres[first:end] ** 2)), MAD_TO_SIGMA * np.median(np.abs(metres[first:end])))
        count = len({*first_numbers[first:end].tolist(), *second_numbers[first:end].tolist()})
        sigmas.append(spread if spread > REGISTER.most_drift else spread / np.sqrt(2 * count))
    return SigmaAlong(tuple(places.tolist()), tuple(map(float, sigmas)))


def _apart(pair):
    """(N,) m across that two passes lie apart, NaN where unknown; in any direction where it is more than drift, as of another datum.

    Where the street was rebuilt between them, what is drawn may lie anywhere on the strip that was.
    """
    anywhere = np.linalg.norm(np.nan_to_num([pair.left, pair.along, pair.up]), axis=0)
    return np.fmax(np.where(anywhere > REGISTER.most_drift, anywhere, pair.left), np.where(pair.rebuilt > 0.0, pair.rebuilt, np.nan))


def sigma_to_record(sigma: dict[int, SigmaAlong]) -> list[Any]:
    """{road number: SigmaAlong} as LAS variable length records; none where nothing is known."""
    rows = np.array([(road, *node) for road, along in sorted(sigma.items()) for node in zip(along.stations, along.metres)], _NODE)
    return [laspy.VLR(SIGMA_USER_ID, FIRST_RECORD + k, "Uncertainty that passes leave", rows[first:first + NODES_PER_RECORD].tobytes())
            for k, first in enumerate(range(0, len(rows), NODES_PER_RECORD))]


def sigma_of_records(records: Iterable[Any]) -> dict[int, SigmaAlong]:
    """{road number: SigmaAlong} as `sigma_to_record` wrote it, from the records of a file."""
    data = {record.record_id: bytes(record.record_data_bytes()) for record in records if record.user_id.rstrip("\0") == SIGMA_USER_ID}
    if ROAD_RECORD in data:
        return {road: SigmaAlong.everywhere(metres) for road, metres in np.frombuffer(data[ROAD_RECORD], _ROAD).tolist()}
    rows = np.frombuffer(b"".join(data[number] for number in sorted(data)), _NODE)
    return {road: SigmaAlong(*(tuple(rows[name][rows["road"] == road].tolist()) for name in ("station", "sigma")))
            for road in np.unique(rows["road"]).tolist()}


def sigma_of_layer(features: Features) -> dict[int, SigmaAlong]:
    """{road number: SigmaAlong} that the rows of a layer hold, such as CURB_POINTS and MARKING_LINES."""
    nodes: dict[int, list[tuple[float, float]]] = {}
    for row in features.rows:
        road, metres, start = (row.get(name) for name in ("road", PASS_SIGMA.name, "station_m"))
        if road is not None and metres is not None:
            ends = [station for station in (start, row.get("end_m")) if station is not None]
            nodes.setdefault(int(road), []).append((float(np.mean(ends)) if ends else 0.0, float(metres)))
    return {road: SigmaAlong.through(*np.array(rows).T) for road, rows in nodes.items()}
