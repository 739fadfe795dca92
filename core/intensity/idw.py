"""Inverse distance weighting on the map's lattice of cells: every point weighs on all cells within the search radius."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from ..common.arrays import order_by
from ..common.parallel import ScratchBuffers
from ..common.setting import check_limits, setting
from ..lazy import cv2
from ..survey.store.records import COORDINATE_SCALE, Points

DISTANCE_OFFSET = 1e-3        # m added to a distance, so that a point on a cell's centre has a finite weight
DISTANCES_AT_ONCE = 1 << 19   # distances computed at a time: what fits the processor's cache
# multiplications of a matrix product; OpenBLAS starts threads of its own for more than 2**18, which wait for each other where all cores are busy
PRODUCTS_AT_ONCE = 1 << 18
RADIUS_ROUNDING = 2e-6        # of the weight at the radius: a point exactly on it counts, whatever the rounding


_thread = threading.local()   # the kernels of each thread


@dataclass(frozen=True)
class ImageSettings:
    """How the image is interpolated.

    cell_size : m; paint of 0.15 m survives at 0.04
    power : of the distance
    beta : share of the weight that follows brightness; 0 is plain inverse distance
    radius_cells : search radius, in cells
    """

    cell_size: float = setting(0.04, 0.005, 10.0, "The cell size", "m")
    power: float = setting(2.0, 0.1, 10.0, "The power of the distance")
    beta: float = setting(0.5, 0.0, 1.0, "The weight of brightness")
    radius_cells: float = setting(2.0, 0.71, 10.0, "The search radius", "cells")

    def __post_init__(self) -> None:
        check_limits(self)


@dataclass
class WeightedSums:
    """Sums of weights and of weighted values on a rectangle of cells.

    column, row : of the lattice (eastward, northward) of the north-western cell
    total, weights : (rows, columns) float32, weighted values and weights; both 0 where no point is within the radius
    """

    column: int
    row: int
    total: np.ndarray
    weights: np.ndarray

    def add_to(self, other: WeightedSums) -> None:
        """Add the part that lies in another rectangle to the sums there."""
        height, width = self.total.shape
        down, right = other.row - self.row, self.column - other.column
        r0, r1 = max(-down, 0), min(other.total.shape[0] - down, height)
        c0, c1 = max(-right, 0), min(other.total.shape[1] - right, width)
        if r0 < r1 and c0 < c1:
            place = slice(r0 + down, r1 + down), slice(c0 + right, c1 + right)
            other.total[place] += self.total[r0:r1, c0:c1]
            other.weights[place] += self.weights[r0:r1, c0:c1]


def reach_of(settings: ImageSettings) -> int:
    """Cells that a point reaches beyond its own."""
    return int(np.ceil(settings.radius_cells))


def lattice_cell(units: np.ndarray | int, origin: float, cell_size: float) -> Any:
    """Column or row of the lattice in which coordinates lie.

    Parameters
    ----------
    units : (N,) or one, integers of 0.1 mm from `origin`
    origin : map coordinate, m
    cell_size : m

    Returns
    -------
    whole float64 of the shape of `units`
    """
    return np.floor((units * COORDINATE_SCALE + origin) / cell_size)


def interpolation_sums(points: Points, brightness: Callable[[np.ndarray], np.ndarray], origin: np.ndarray, settings: ImageSettings,
                       step: int = 1) -> WeightedSums:
    """Sums of weights and of weighted values per cell.

    Parameters
    ----------
    points : Points, at least one
    brightness : function of (N,) float32 intensities that returns (N,) float32 factors of the points' weights
    origin : (2,) or more, map coordinates that x and y of the points leave out, m
    settings : ImageSettings
    step : one of `step` points stands for all of them on cells farther than the next

    Returns
    -------
    WeightedSums of a rectangle that holds all cells within reach

    Notes
    -----
    Points are taken in blocks and sorted by cell. What the points of one cell add to
    its neighbours is then one row of a matrix product. Weights and sums are in single
    precision, far finer than intensities are. A cell and a half away or farther, weights are
    so small that a share of the points gives the same result.
    """
    x, y, values = points.records["x"], points.records["y"], points.value
    reach, cell = reach_of(settings), settings.cell_size
    (left, right), (bottom, top) = ([int(lattice_cell(int(end), o, cell)) for end in (c.min(), c.max())]
                                    for c, o in ((x, origin[0]), (y, origin[1])))
    left, top = left - reach, top + reach
    width, height = right + reach + 1 - left, top - (bottom - reach) + 1
    sums = np.zeros(width * height, np.complex64)   # weights and weighted values, which are added to the same cells
    whole, near, far = _kernels(settings)
    at_once = near.at_once if step > 1 else whole.at_once
    for first in range(0, len(x), at_once):
        run = slice(first, first + at_once)
        (column, east), (row, north) = _in_cell(x[run], origin[0], cell), _in_cell(y[run], origin[1], cell)
        number = ((top - row) * width + (column - left)).astype(np.int32)
        rows = order_by(number)
        value = values[run].take(rows)
        number, east, north, weight = number.take(rows), east.take(rows), north.take(rows), brightness(value)
        if step == 1:
            whole.add(sums, width, number, east, north, value, weight)
            continue
        near.add(sums, width, number, east, north, value, weight)
        one_in_step = np.zeros(len(rows), bool)
        one_in_step[-first % step::step] = True
        share = np.flatnonzero(one_in_step.take(rows))
        if len(share) and far.offsets:
            number, east, north, value, weight = (column.take(share) for column in (number, east, north, value, weight))
            far.add(sums, width, number, east, north, value, weight * np.float32(step))
    sums = sums.reshape(height, width)
    return WeightedSums(left, top, sums.imag, sums.real)


def _in_cell(units, origin, cell_size):
    """The cell that coordinates lie in, (N,) whole float64, and how far from its middle, (N,) float32 in cells."""
    place = (units * COORDINATE_SCALE + origin) / cell_size
    cell = np.floor(place)
    # subtracted in double precision
    place -= cell
    place -= 0.5
    return cell, place.astype(np.float32)


def _kernels(settings: ImageSettings) -> list[_Kernel]:
    """The thread's own kernels: of all cells around a point, of the nearest nine, and of those beyond."""
    if getattr(_thread, "settings", None) != settings:
        radius, reach = settings.radius_cells, reach_of(settings)
        offsets = [(right, up) for up in range(-reach, reach + 1) for right in range(-reach, reach + 1)
                   if np.hypot(max(abs(right) - 0.5, 0), max(abs(up) - 0.5, 0)) < radius]
        near = [offset for offset in offsets if max(map(abs, offset)) <= 1]
        _thread.settings = settings
        _thread.kernels = [_Kernel(settings, some) for some in (offsets, near, [offset for offset in offsets if offset not in near])]
    return _thread.kernels


class _Kernel:
    """Weights of points on the cells around their own.

    offsets : (K) (right, up) of the cells
    at_once : points that are computed at a time
    """

    def __init__(self, settings: ImageSettings, offsets: list[tuple[int, int]]):
        self.settings, self.offsets = settings, offsets
        self.at_once = max(DISTANCES_AT_ONCE // max(len(offsets), 1), 1)
        self.rows_at_once = max(PRODUCTS_AT_ONCE // (4 * max(len(offsets), 1)), 1)
        self._kept = ScratchBuffers()   # reused: new memory costs page faults
        right, up = np.array(offsets, np.float32).reshape(-1, 2).T
        # squared distances as a product: (e - r)^2 + (n - u)^2 = (e^2 + n^2) 1 - 2 e r - 2 n u + 1 (r^2 + u^2)
        self._squares = np.stack([np.ones_like(right), -2 * right, -2 * up, right**2 + up**2])

    def add(self, sums, width, number, east, north, value, weight):
        """Add points to complex sums of a lattice `width` cells wide; `number` are the cells they lie in, ascending."""
        starts = np.flatnonzero(np.r_[True, number[1:] != number[:-1]])
        runs = sparse.csr_matrix((weight, np.arange(len(number), dtype=np.int32), np.append(starts, len(number)).astype(np.int32)),
                                 shape=(len(starts), len(number)))
        weights = self.weights(east, north)
        # by cell of the neighbourhood, weights and weighted values side by side, as they are added
        size, kept = (len(self.offsets), len(starts)), self._kept.of(len(starts) * len(self.offsets))
        sums_of_runs = []
        for name, factor in (("weights", None), ("values", value)):
            if factor is not None:
                runs.data = weight * factor
            sums_of_runs.append(cv2.transpose(runs @ weights, kept(name, np.float32).reshape(size)))
        added = cv2.merge(sums_of_runs, self._kept.of(2 * len(starts) * len(self.offsets))("added", np.float32).reshape(*size, 2))
        target = number[starts].astype(np.intp)
        for (right, up), both in zip(self.offsets, added.view(np.complex64)[:, :, 0]):
            sums[target + (right - up * width)] += both

    def weights(self, east: np.ndarray, north: np.ndarray) -> np.ndarray:
        """(N, K) float32 weights by distance alone, of points at places in their own cells; valid until the next call."""
        own = self._kept.of(4 * len(east))("own", np.float32).reshape(-1, 4)
        own[:, 0] = east * east + north * north
        own[:, 1], own[:, 2], own[:, 3] = east, north, 1.0
        found = self._kept.of(len(east) * len(self.offsets))("found", np.float32).reshape(len(east), -1)
        farthest = self._weight(np.full(1, self.settings.radius_cells * self.settings.cell_size + DISTANCE_OFFSET, np.float32))
        for first in range(0, len(east), self.rows_at_once):
            some = found[first:first + self.rows_at_once]
            cv2.gemm(own[first:first + self.rows_at_once], self._squares, 1.0, None, 0.0, some)
            cv2.sqrt(some, some)
            some *= np.float32(self.settings.cell_size)
            some += np.float32(DISTANCE_OFFSET)
            self._weight(some)
            cv2.threshold(some, float(farthest[0]) * (1 - RADIUS_ROUNDING), 0.0, cv2.THRESH_TOZERO, some)
        return found

    def _weight(self, distance):
        """1 / distance^power, in place."""
        if self.settings.power == 2.0:
            distance *= distance
        else:
            np.power(distance, np.float32(self.settings.power), out=distance)
        return np.divide(np.float32(1.0), distance, out=distance)
