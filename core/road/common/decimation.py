"""Decimation of dense points before curbs are looked for.

A few points of a cell describe level ground as well as all of them. The face of a curb, a hedge, and all ground seen by a noisy scanner keep their
points. The decision is made once for every point and serves the search along the road and the one in plan.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...common.arrays import decimate_cells
from ...execution.phase import Executor, Recipe
from ...survey.open_survey import Survey
from ...survey.store.array_file import ArrayFile
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points
from ..weights import CURBS

LEVEL_CELL_LIMITS = CURBS.points_per_level_cell, CURBS.points_per_level_cell_in_plan
PROFILE_BOUND_TOLERANCE = 1e-6   # derived: 0.1 mm; bounds between profiles are whole numbers of it, except for rounding
HASH_FACTORS = tuple(np.uint32(odd) for odd in (2654435761, 2246822519, 3266489917))   # source: Knuth, TAOCP 3, 6.4; odd
MAX_CELL_OFFSET = (1 << 18) - 1   # derived: 18 bits of 0.1 mm from the reference line; points beyond are counted there


class PointDecimation:
    """Which points of a survey are used where they are dense.

    The decision is kept in a temporary file, one bit per point: call `close` at the end.

    width, spacing : m; a cell is one profile long and about `spacing` wide
    """

    reach = 0.0   # as of `Survey.along`

    def __init__(self, survey: Survey, width: float, spacing: float):
        self.survey, self.width, self.spacing, self.known = survey, width, spacing, (width, spacing)
        self._stretch = max(int(round(CURBS.stretch_length / width)), 1)   # profiles
        self._selections: dict = {}   # (road, first profile) -> (number of points, {limit: bits in the file, None for all points})
        self._uneven: dict = {}       # (road, profile) -> bool
        self._locks = [threading.Lock() for _ in range(CURBS.decimation_locks)]
        self._file = ArrayFile()

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these points."""
        return self.survey.executor

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points; they decide anew, which gives the same selection."""
        return Recipe("core.road.common.decimation:PointDecimation", dict(survey=self.survey.recipe(folder), width=self.width, spacing=self.spacing))

    def close(self) -> None:
        """Forget the decisions and free the disk space."""
        self._selections.clear()
        self._file.close()

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
                joined = waiting[0] if len(waiting) == 1 else Points(Columns.concatenate([part.records for part in waiting], points.records.dtype))
                waiting = []
                yield from _blocks_of_profiles(joined, start * self.width, self.width)

    def mostly_uneven(self, road: int, profile: int) -> bool:
        """Is the ground about a profile uneven nearly everywhere, as a noisy scanner shows it? Decimation would leave little out there."""
        key = road, profile
        if key not in self._uneven:
            self._uneven[key] = _mostly_uneven(self._window(road, profile - 2, profile + 2).records, self.width, self.spacing)
        return self._uneven[key]

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
        with self._locks[hash(key) % CURBS.decimation_locks]:
            if key not in self._selections:
                self._selections[key] = self._select(road, first)

    def _select(self, road, first):
        """Number of points, and for every limit the selected ones: bits in the file, None for all."""
        points = self._window(road, first, first + self._stretch)
        selected, done = {limit: np.ones(len(points), bool) for limit in LEVEL_CELL_LIMITS}, 0
        for block in _blocks_of_profiles(points, first * self.width, self.width):
            for rows, columns in _by_pass(block.records):
                for limit, mask in _PointCells(*columns, self.width, self.spacing).select().items():
                    of_block = selected[limit][done:done + len(block)]
                    of_block[slice(None) if rows is None else rows] = mask
            done += len(block)
        bits = {limit: None if mask.all() else np.packbits(mask) for limit, mask in selected.items()}
        return len(points), {limit: of_points if of_points is None else self._file.put([of_points], of_points.nbytes)
                             for limit, of_points in bits.items()}


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
    """[(indices of the records of a pass, None for all, their columns s, d, z)]"""
    columns, numbers = [records[name] for name in ("s", "d", "z")], records["pass_number"]
    if numbers.min() == numbers.max():
        return [(None, columns)]
    passes = [np.flatnonzero(numbers == number) for number in np.flatnonzero(np.bincount(numbers))]
    return [(rows, [column.take(rows) for column in columns]) for rows in passes]


class _PointCells:
    """Points by cell: one profile long, about `spacing` wide, on one side of the road.

    s, d, z : (N,) stations (ascending), offsets and heights, 0.1 mm
    count : (C,) points of every cell
    """

    def __init__(self, s: np.ndarray, d: np.ndarray, z: np.ndarray, width: float, spacing: float):
        self.s, self.d, self.z = s, d, z
        bits = int(np.rint(np.log2(spacing / COORDINATE_SCALE)))
        half = (MAX_CELL_OFFSET >> bits) + 1
        # stations ascend, so a profile is a range of points; its bounds lie between whole units
        first, last = (int(np.floor((int(end) + 0.5) * COORDINATE_SCALE / width)) for end in (s[0], s[-1]))
        bounds = np.arange(first + 1, last + 1) * (width / COORDINATE_SCALE) - 0.5 - PROFILE_BOUND_TOLERANCE
        cuts = np.searchsorted(s, np.ceil(bounds).astype(np.int32)).tolist()
        # both sides of a road have the same cells
        cell = np.abs(d)
        np.minimum(cell, MAX_CELL_OFFSET, out=cell)
        cell >>= bits
        side = d >> 31
        side &= half
        cell += side
        for k, (start, end) in enumerate(zip([0, *cuts], [*cuts, len(s)])):
            cell[start:end] += np.int32(2 * half * k)
        self.cell = cell.astype(np.intp)
        self.count = np.bincount(self.cell, minlength=2 * half * (last - first + 1))

    def select(self) -> dict[int, Any]:
        """For every one of LEVEL_CELL_LIMITS (N,) bool, the points that are used, or True for all."""
        if self.count.max(initial=0) <= min(LEVEL_CELL_LIMITS):
            return dict.fromkeys(LEVEL_CELL_LIMITS, True)
        rank, per_point, level = _hash_of_place(self.s, np.abs(self.d)), 65536.0 / np.maximum(self.count, 1), self.is_level()
        return {limit: rank <= np.minimum(np.where(level, limit, CURBS.points_per_uneven_cell) * per_point, 65535.0).astype(np.uint16).take(self.cell)
                for limit in LEVEL_CELL_LIMITS}

    def is_level(self) -> np.ndarray:
        """(C,) bool: do the heights of each cell deviate little from their mean?"""
        z = self.z.astype(float)
        total = np.bincount(self.cell, z, len(self.count))
        z *= z
        squares = np.bincount(self.cell, z, len(self.count)) - total * total / np.maximum(self.count, 1)
        return squares <= self.count * (CURBS.level_cell_std / COORDINATE_SCALE) ** 2


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
