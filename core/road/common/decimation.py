"""Decimation of dense points before curbs are looked for.

A few points of a cell describe level ground as well as all of them. The face of a curb, a hedge, and all ground seen by a noisy scanner keep their
points. The decision is made once for every point and serves the search along the road and the one in plan.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...common.arrays import decimate_cells
from ...execution.phase import Executor, Recipe
from ...survey.frame.passes import Pass
from ...survey.open_survey import Survey
from ...survey.store.array_file import ArrayFile
from ...survey.store.records import COORDINATE_SCALE, Points, join_columns
from ..weights import CURBS

LEVEL_CELL_LIMITS = CURBS.points_per_level_cell, CURBS.points_per_level_cell_in_plan
PROFILE_BOUND_TOLERANCE = 1e-6   # derived: 0.1 mm; bounds between profiles are whole numbers of it, except for rounding
HASH_FACTORS = tuple(np.uint32(odd) for odd in (2654435761, 2246822519, 3266489917))   # source: Knuth, TAOCP 3, 6.4; odd
MAX_CELL_OFFSET = (1 << 18) - 1   # derived: 18 bits of 0.1 mm from the reference line; points beyond are counted there


class PointDecimation:
    """Which points of a survey are used where they are dense.

    The decision is kept in a temporary file, one bit per point: call `close` at the end.

    width, spacing : m; a cell is one profile long and about `spacing` wide
    min_step : m, the least step for which `level_strip` leaves ground out
    """

    def __init__(self, survey: Survey, width: float, spacing: float, min_step: float = CURBS.min_step_height):
        self.survey, self.width, self.spacing, self.min_step = survey, width, spacing, min_step
        self._stretch = max(int(round(CURBS.stretch_length / width)), 1)   # profiles
        self._selections: dict = {}   # (road, first profile) -> (number of points, {limit: bits in the file, None for all points})
        self._uneven: dict = {}       # (road, profile) -> bool
        self._strips: dict = {}       # (road, first profile) -> {pass number: LevelStrip}
        self._locks = [threading.Lock() for _ in range(CURBS.decimation_locks)]
        self._file: ArrayFile | None = None

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these points."""
        return self.survey.executor

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points; they decide anew, which gives the same selection."""
        return Recipe("core.road.common.decimation:PointDecimation", dict(survey=self.survey.recipe(folder), width=self.width, spacing=self.spacing,
                                                                     min_step=self.min_step))

    def close(self) -> None:
        """Forget the decisions and free the disk space."""
        self._selections.clear()
        self._strips.clear()
        if self._file is not None:
            self._file.close()
            self._file = None

    def decimated_points(self, road: int, profiles: tuple[int, int],
                         points_per_cell: int | None = CURBS.points_per_level_cell) -> Iterator[Points]:
        """The points of profiles, block by block along the road, decimated where cells of level ground are dense.

        profiles : (first, last + 1) numbers of profiles
        points_per_cell : points of one pass in a cell of level ground, one of LEVEL_CELL_LIMITS; None takes all points

        Yields Points of whole profiles in canonical order. The selection in a cell depends on the points of its profile alone.
        """
        waiting: list[Points] = []
        begins = range(profiles[0] // self._stretch * self._stretch, profiles[1], self._stretch)
        for first in begins:
            start, end = max(first, profiles[0]), min(first + self._stretch, profiles[1])
            points = self._window(road, start, end)
            if points_per_cell is not None and len(points):
                rows = self._selected_rows(road, first, points_per_cell)
                before = len(self._window(road, first, start)) if start > first else 0
                if rows is not None:
                    a, b = np.searchsorted(rows, (before, before + len(points)))
                    points = points[rows[a:b] - before]
            # few points are worked on together with the next ones
            waiting.append(points)
            if first == begins[-1] or sum(map(len, waiting)) >= CURBS.joined_points:
                joined = waiting[0] if len(waiting) == 1 else Points(join_columns([part.records for part in waiting], points.records.dtype))
                waiting = []
                yield from _blocks_of_profiles(joined, start * self.width, self.width)

    def mostly_uneven(self, road: int, profile: int) -> bool:
        """Is the ground about a profile uneven nearly everywhere, as a noisy scanner shows it? Decimation would leave little out there."""
        key = road, profile
        if key not in self._uneven:
            self._uneven[key] = _mostly_uneven(self._window(road, profile - 2, profile + 2).records, self.width, self.spacing)
        return self._uneven[key]

    def level_strip(self, road: int, number: int, profiles: tuple[int, int], across: float, along: float) -> LevelStrip:
        """The level strip about the track of a pass.

        road, number : of the road and of the pass
        profiles : (first, last + 1)
        across, along : m that the strip keeps from ground that is not level

        Returns LevelStrip of these profiles
        """
        around = int(np.ceil(along / self.width))
        wide = LevelStrip.empty(profiles[0] - around, profiles[1] - profiles[0] + 2 * around, self.width)
        end = wide.first + len(wide.low)
        for first in range(wide.first // self._stretch * self._stretch, end, self._stretch):
            self._decide(road, first)
            strip = self._strips[road, first].get(number)
            if strip is not None:
                a, b = max(first, wide.first), min(first + self._stretch, end)
                for name in ("low", "high", "height"):
                    getattr(wide, name)[a - wide.first:b - wide.first] = getattr(strip, name)[a - first:b - first]
        return wide.shrunk(across, along)

    def _window(self, road, first, last):
        return self.survey.window(road, first * self.width, last * self.width)

    def _selected_rows(self, road, first, limit):
        """Rows that are used of the stretch which begins with profile `first`; None for all."""
        self._decide(road, first)
        count, selected = self._selections[road, first]
        if selected[limit] is None:
            return None
        bits = self._file.get(selected[limit], (count + 7) // 8, np.uint8)
        return np.flatnonzero(np.unpackbits(bits, count=count).view(bool))

    def _decide(self, road, first):
        """Select the points of the stretch which begins with profile `first`, unless that was done."""
        key = road, first
        with self._locks[hash(key) % (CURBS.decimation_locks - 1)]:
            if key not in self._selections:
                self._strips[key] = {}
                self._selections[key] = self._select(road, first, self._strips[key])

    def _select(self, road, first, strips):
        """Number of points, and for every limit the selected ones: bits in the file, None for all; `strips` are filled in."""
        points = self._window(road, first, first + self._stretch)
        selected, done = {limit: np.ones(len(points), bool) for limit in LEVEL_CELL_LIMITS}, 0
        for block in _blocks_of_profiles(points, first * self.width, self.width):
            for number, rows, columns in _by_pass(block.records):
                cells = _PointCells(*columns, self.width, self.spacing)
                for limit, mask in cells.select().items():
                    of_block = selected[limit][done:done + len(block)]
                    of_block[slice(None) if rows is None else rows] = mask
                if cells.complete and self.width <= CURBS.max_strip_profile_width:
                    strip = strips.setdefault(number, LevelStrip.empty(first, self._stretch, self.width))
                    self._fill_strip(strip, cells, self.survey.frame.passes[number])
            done += len(block)
        return len(points), {limit: None if mask.all() else self._store_bits(np.packbits(mask)) for limit, mask in selected.items()}

    def _fill_strip(self, strip: LevelStrip, cells: _PointCells, driven: Pass) -> None:
        """Fill in those profiles of a strip to which the cells belong."""
        middles = (cells.first + np.arange(cells.profiles) + 0.5) * self.width
        limits = _find_level_strip(np.floor(driven.at_station(middles)[0] / COORDINATE_SCALE), *cells.grids(), cells.size,
                                 self.min_step / COORDINATE_SCALE)
        profiles = slice(cells.first - strip.first, cells.first - strip.first + cells.profiles)
        strip.low[profiles], strip.high[profiles], strip.height[profiles] = limits

    def _store_bits(self, bits):
        with self._locks[-1]:
            if self._file is None:
                self._file = ArrayFile()
        return self._file.put([bits], bits.nbytes)


class LevelGround:
    """Ground about the track of a pass that is left out, since no curb lies in it.

    decimation : PointDecimation that knows it
    across, along : m kept from ground that is not level
    """

    def __init__(self, decimation: PointDecimation, across: float, along: float):
        self.decimation, self.across, self.along = decimation, across, along

    def __call__(self, road: int, number: int, start: float, end: float) -> LevelStrip:
        """The LevelStrip of a road and pass number between two stations, m."""
        profiles = int(np.floor(start / self.decimation.width)), int(np.ceil(end / self.decimation.width))
        return self.decimation.level_strip(road, number, profiles, self.across, self.along)

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open it."""
        return Recipe("core.road.common.decimation:LevelGround",
                      dict(decimation=self.decimation.recipe(folder), across=self.across, along=self.along))


def _blocks_of_profiles(points: Points, start: float, width: float) -> list[Points]:
    """Points along the road cut into blocks of whole profiles, about CURBS.decimation_block_points each.

    points : Points, sorted by station
    start : m, station from which profiles are counted
    width : m of road per profile
    """
    cuts = np.arange(0, len(points), CURBS.decimation_block_points)
    if len(cuts) > 1:
        edges = np.unique(np.floor((points.records["s"][cuts[1:]] * COORDINATE_SCALE - start) / width)) * width + start
        cuts = np.unique(np.r_[0, np.searchsorted(points.records["s"], np.ceil(edges / COORDINATE_SCALE - 0.01).astype(np.int32))])
    return [points[a:b] for a, b in zip(cuts, np.r_[cuts[1:], len(points)]) if b > a]


def limit_points_per_cell(cell: np.ndarray) -> np.ndarray | slice:
    """Indices of the points with (N,) cell indices, at most about CURBS.points_per_uneven_cell of a cell, evenly spread over their order."""
    if len(cell) <= CURBS.points_per_uneven_cell:
        return slice(None)
    cell = cell - cell.min()
    return slice(None) if np.bincount(cell).max() <= CURBS.points_per_uneven_cell else decimate_cells(cell, CURBS.points_per_uneven_cell)


def _by_pass(records):
    """[(pass number, indices of its records, None for all, their columns s, d, z)]"""
    columns, numbers = [records[name] for name in ("s", "d", "z")], records["pass_number"]
    if numbers.min() == numbers.max():
        return [(int(numbers[0]), None, columns)]
    passes = [(int(number), np.flatnonzero(numbers == number)) for number in np.flatnonzero(np.bincount(numbers))]
    return [(number, rows, [column.take(rows) for column in columns]) for number, rows in passes]


class _PointCells:
    """Points by cell: one profile long, about `spacing` wide, on one side of the road.

    s, d, z : (N,) stations (ascending), offsets and heights, 0.1 mm
    first, profiles, size : number of the first profile, count of profiles, width of a cell in 0.1 mm
    count : (C,) points of every cell
    total, squares : (C,) sum of heights and of their squared deviations from the mean; known after `is_level`
    complete : whether these two hold all points, which `grids` needs
    """

    def __init__(self, s: np.ndarray, d: np.ndarray, z: np.ndarray, width: float, spacing: float):
        self.s, self.d, self.z = s, d, z
        bits = int(np.rint(np.log2(spacing / COORDINATE_SCALE)))
        self.size, self.half, self.complete = 1 << bits, (MAX_CELL_OFFSET >> bits) + 1, False
        # stations ascend, so a profile is a range of points; its bounds lie between whole units
        self.first, last = (int(np.floor((int(end) + 0.5) * COORDINATE_SCALE / width)) for end in (s[0], s[-1]))
        self.profiles = last - self.first + 1
        bounds = np.arange(self.first + 1, last + 1) * (width / COORDINATE_SCALE) - 0.5 - PROFILE_BOUND_TOLERANCE
        cuts = np.searchsorted(s, np.ceil(bounds).astype(np.int32)).tolist()
        # both sides of a road have the same cells
        cell = np.abs(d)
        np.minimum(cell, MAX_CELL_OFFSET, out=cell)
        cell >>= bits
        side = d >> 31
        side &= self.half
        cell += side
        for k, (start, end) in enumerate(zip([0, *cuts], [*cuts, len(s)])):
            cell[start:end] += np.int32(2 * self.half * k)
        self.cell = cell.astype(np.intp)
        self.count = np.bincount(self.cell, minlength=2 * self.half * self.profiles)
        self.total: np.ndarray = np.empty(0)
        self.squares: np.ndarray = np.empty(0)

    def select(self) -> dict[int, Any]:
        """For every one of LEVEL_CELL_LIMITS (N,) bool, the points that are used, or True for all."""
        dense = np.flatnonzero(self.count > min(LEVEL_CELL_LIMITS))
        count = self.count.take(dense)
        in_dense = count.sum()
        if not in_dense:
            return dict.fromkeys(LEVEL_CELL_LIMITS, True)
        if in_dense < CURBS.min_dense_share * len(self.s):
            # of the other cells all points are used
            number = np.full(len(self.count), -1)
            number[dense] = np.arange(len(dense))
            cell = number.take(self.cell)
            rows = np.flatnonzero(cell >= 0)
            s, d, cell = self.s.take(rows), self.d.take(rows), cell.take(rows)
            level = _is_level(_sums(cell, self.z.take(rows), count)[1], count)
        else:
            rows, s, d, cell, count, level = None, self.s, self.d, self.cell, self.count, self.is_level()
        rank, per_point = _hash_of_place(s, np.abs(d)), 65536.0 / np.maximum(count, 1)
        result = {}
        for limit in LEVEL_CELL_LIMITS:
            used = rank <= np.minimum(np.where(level, limit, CURBS.points_per_uneven_cell) * per_point, 65535.0).astype(np.uint16).take(cell)
            if rows is not None:
                used_of_dense, used = used, np.ones(len(self.s), bool)
                used[rows] = used_of_dense
            result[limit] = used
        return result

    def is_level(self) -> np.ndarray:
        """(C,) bool: is the ground of each cell level?"""
        self.total, self.squares = _sums(self.cell, self.z, self.count)
        self.complete = True
        return _is_level(self.squares, self.count)

    def grids(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """count, total and squares as (profiles, 2 sides, cells outward)."""
        shape = self.profiles, 2, self.half
        return self.count.reshape(shape), self.total.reshape(shape), self.squares.reshape(shape)


def _sums(cell, z, count):
    """Of every cell, with (C,) count points, the sum of heights and of their squared deviations from the mean."""
    z = z.astype(float)
    total = np.bincount(cell, z, len(count))
    z *= z
    return total, np.bincount(cell, z, len(count)) - total * total / np.maximum(count, 1)


def _is_level(squares, count):
    return squares <= count * (CURBS.level_cell_std / COORDINATE_SCALE) ** 2


def _mostly_uneven(records, width, spacing):
    if not len(records):
        return False
    cells = _PointCells(*(records[name] for name in ("s", "d", "z")), width, spacing)
    count = np.where(cells.count >= CURBS.min_level_points, cells.count, 0)
    return count[~cells.is_level()].sum() > CURBS.mostly_uneven_share * count.sum()


def _hash_of_place(s, out):
    """(N,) uint16 that depend on the place of a point alone, without a spatial pattern."""
    value = s.view(np.uint32) * HASH_FACTORS[0]
    value += out.view(np.uint32) * HASH_FACTORS[1]
    value ^= value >> np.uint32(15)
    value *= HASH_FACTORS[2]
    value >>= np.uint32(16)
    return value.astype(np.uint16)


# The strip about a driven track in which the ground is level beyond doubt: no curb lies in it, and nothing that hides one.

NO_OFFSET = 1 << 28   # derived: 0.1 mm, farther than any offset


@dataclass
class LevelStrip:
    """Offsets between which the ground of profiles is level; low > high where it is not."""

    first: int   # number of the first profile
    width: float   # m of road per profile
    low: np.ndarray   # low, high: (P,) int32, offsets in 0.1 mm
    high: np.ndarray
    height: np.ndarray   # (P,) m, mean local z of the ground in the strip

    @classmethod
    def empty(cls, first: int, count: int, width: float) -> LevelStrip:
        """A strip without level ground over `count` profiles."""
        return cls(first, width, np.full(count, NO_OFFSET, np.int32), np.full(count, -NO_OFFSET, np.int32), np.zeros(count))

    def shrunk(self, across: float, along: float) -> LevelStrip:
        """The part that keeps a distance from ground that is not level.

        across : m from both ends of every profile
        along : m along the road; the result is shorter by as many profiles at both ends
        """
        around = int(np.ceil(along / self.width))

        def widest(values: np.ndarray) -> np.ndarray:
            return np.lib.stride_tricks.sliding_window_view(values, 2 * around + 1).max(axis=1)

        margin = int(round(across / COORDINATE_SCALE))
        low, high = widest(self.low) + margin, -widest(-self.high) - margin
        narrow = high - low < CURBS.min_strip_width / COORDINATE_SCALE
        inner = slice(around, len(self.height) - around)
        return LevelStrip(self.first + around, self.width, np.where(narrow, NO_OFFSET, low).astype(np.int32),
                          np.where(narrow, -NO_OFFSET, high).astype(np.int32), self.height[inner])

    def contains(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) bool: does a point lie in the strip? s : (N,) stations, ascending; d : (N,) offsets; both in 0.1 mm."""
        edges = np.ceil((self.first + np.arange(1, len(self.low))) * (self.width / COORDINATE_SCALE) - 0.5).astype(np.int32)
        cuts = [0, *np.searchsorted(s, edges).tolist(), len(s)]
        inside = np.empty(len(d), bool)
        # stations ascend, so a profile is a range of points
        for low, high, first, end in zip(self.low, self.high, cuts[:-1], cuts[1:]):
            offsets = d[first:end]
            np.logical_and(offsets > low, offsets < high, out=inside[first:end])
        return inside

    def at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Low and high offset and height, m, each (N,), at stations s, (N,) m."""
        k = np.clip(np.floor(np.asarray(s) / self.width).astype(np.int64) - self.first, 0, len(self.low) - 1)
        return self.low[k] * COORDINATE_SCALE, self.high[k] * COORDINATE_SCALE, self.height[k]


def _find_level_strip(track: np.ndarray, count: np.ndarray, total: np.ndarray, squares: np.ndarray, size: int,
                     min_height: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How far the ground about a track is level, profile by profile.

    track : (P,) offset of the vehicle's track, 0.1 mm
    count : (P, 2, C) points of every cell of the left and of the right side, from the reference line outward
    total : (P, 2, C) sum of their heights, 0.1 mm
    squares : (P, 2, C) sum of the squared deviations from their mean height, (0.1 mm)²
    size : width of a cell, 0.1 mm
    min_height : the least step, 0.1 mm

    Returns low, high, height: as of LevelStrip
    """
    half = min(int(CURBS.max_strip_offset / COORDINATE_SCALE) // size, count.shape[2])
    count, total, squares = (np.concatenate([v[:, 1, :half][:, ::-1], v[:, 0, :half]], axis=1) for v in (count, total, squares))
    measured = count > 0
    mean = np.where(measured, total / np.maximum(count, 1), np.nan)
    uneven = measured & ((count < CURBS.min_level_points) | (squares > count * (CURBS.max_strip_std / COORDINATE_SCALE) ** 2))
    half_step = max(int(round(CURBS.max_step_width * 0.5 / COORDINATE_SCALE / size)), 1)
    with np.errstate(invalid="ignore"):
        uneven[:, half_step:-half_step] |= np.abs(mean[:, 2 * half_step:] - mean[:, :-2 * half_step]) > CURBS.level_step_share * min_height
    uneven &= _count_about(uneven) >= CURBS.min_uneven_neighbours
    track_cell = np.clip(track // size + half, 0, 2 * half - 1).astype(np.int64)
    left, right = (_level_cells_from(track_cell, sign, uneven, measured, size) for sign in (1, -1))
    column = np.arange(2 * half)
    inside = (column > (track_cell - right)[:, None]) & (column < (track_cell + left)[:, None])
    points = (count * inside).sum(axis=1)
    bounded = (left > 0) & (right > 0) & (points > 0)
    low = np.where(bounded, (track_cell - right + 1 - half) * size, NO_OFFSET)
    high = np.where(bounded, (track_cell + left - half) * size, -NO_OFFSET)
    return low, high, (total * inside).sum(axis=1) / np.maximum(points, 1) * COORDINATE_SCALE


def _count_about(mask):
    """(P, C) how many of 3 profiles by 5 cells about each cell are set; the outermost cells stand for what lies beyond them."""
    wide = np.pad(mask, ((1, 1), (2, 2)), mode="edge").astype(np.uint8)
    rows = wide[:-2] + wide[1:-1] + wide[2:]
    return sum(rows[:, k:k + mask.shape[1]] for k in range(5))


def _level_cells_from(own, sign, uneven, seen, size):
    """(P,) number of cells from the track's own up to the first in which the ground is not level or was not seen."""
    last = uneven.shape[1] - 1
    distance = np.arange(last + 1)
    column = own[:, None] + sign * distance
    on = (column >= 0) & (column <= last)
    column = np.clip(column, 0, last)
    measured = np.take_along_axis(seen, column, axis=1)
    ends = ~on | np.take_along_axis(uneven, column, axis=1) \
        | ~measured & (np.logical_or.accumulate(measured, axis=1) | (distance * size * COORDINATE_SCALE > CURBS.blind_half_width))
    return np.argmax(ends, axis=1)
