"""Inverse distance sums on the map's lattice of cells: every point weighs on all cells within its reach."""

import threading
from dataclasses import dataclass

import cv2
import numpy as np
from scipy import sparse

from ..common.memory import ScratchBuffers
from ..common.order_statistics import order_by
from ..survey.store.records import COORDINATE_SCALE

NEAREST = 1e-3      # m added to a distance, so that a point on a cell's centre has a finite weight
AT_ONCE = 1 << 19   # distances worked at a time: what fits the processor's cache
ROUNDING = 2e-6     # of the weight at the radius: a point right on it counts, whatever rounding makes of it


_own = threading.local()   # what a thread keeps


@dataclass
class Sums:
    """What points weigh on a rectangle of cells.

    column, row : of the lattice (eastward, northward) of the north-western cell
    total, weights : (rows, columns) float32, weighted values and weights; both 0 where no point is within the radius
    """

    column: int
    row: int
    total: np.ndarray
    weights: np.ndarray

    def add_to(self, other):
        """Add what lies in another rectangle to the sums there."""
        height, width = self.total.shape
        down, right = other.row - self.row, self.column - other.column
        r0, r1 = max(-down, 0), min(other.total.shape[0] - down, height)
        c0, c1 = max(-right, 0), min(other.total.shape[1] - right, width)
        if r0 < r1 and c0 < c1:
            place = slice(r0 + down, r1 + down), slice(c0 + right, c1 + right)
            other.total[place] += self.total[r0:r1, c0:c1]
            other.weights[place] += self.weights[r0:r1, c0:c1]


def reach_of(settings):
    """Cells that a point reaches beyond its own."""
    return int(np.ceil(settings.radius_cells))


def lattice_cell(units, origin, cell_size):
    """Column or row of the lattice in which coordinates lie, as whole float64; `units` are 0.1 mm from `origin`, m."""
    return np.floor((units * COORDINATE_SCALE + origin) / cell_size)


def interpolation_sums(points, brightness, origin, settings, step=1):
    """Weighted sums of values and of weights per cell.

    Parameters
    ----------
    points : Points, at least one
    brightness : function of (N,) float32 values, what it makes them weigh
    origin : map coordinates that x and y of the points leave out
    settings : ImageSettings
    step : one of so many points weighs on cells farther than the next, for all of them

    Returns
    -------
    Sums of a rectangle that holds all cells within reach

    Notes
    -----
    Points are taken by the thousand and sorted by cell, so that what those of one cell add to
    all its neighbours is one row of a product of matrices. Weights and sums are in single
    precision, far finer than intensities are. What lies a cell and a half away or more weighs
    so little that a share of it tells as much.
    """
    x, y, values = points.records["x"], points.records["y"], points.value
    reach, cell = reach_of(settings), settings.cell_size
    (left, right), (bottom, top) = ([int(lattice_cell(int(end), o, cell)) for end in (c.min(), c.max())]
                                    for c, o in ((x, origin[0]), (y, origin[1])))
    left, top = left - reach, top + reach
    width, height = right + reach + 1 - left, top - (bottom - reach) + 1
    sums = np.zeros(width * height, np.complex64)   # weights and weighted values, which go the same ways
    whole, near, far = _kernels(settings)
    at_once = near.at_once if step > 1 else whole.at_once
    for first in range(0, len(x), at_once):
        run = slice(first, first + at_once)
        (column, east), (row, north) = _in_cell(x[run], origin[0], cell), _in_cell(y[run], origin[1], cell)
        number = ((top - row) * width + (column - left)).astype(np.int32)
        rows = order_by(number)
        value = values[run].take(rows)
        placed = number.take(rows), east.take(rows), north.take(rows), value, brightness(value)
        if step == 1:
            whole.add(sums, width, *placed)
            continue
        near.add(sums, width, *placed)
        one_in_step = np.zeros(len(rows), bool)
        one_in_step[-first % step::step] = True
        share = np.flatnonzero(one_in_step.take(rows))
        if len(share) and far.offsets:
            *placed, weight = (column.take(share) for column in placed)
            far.add(sums, width, *placed, weight * np.float32(step))
    sums = sums.reshape(height, width)
    return Sums(left, top, sums.imag, sums.real)


def _in_cell(units, origin, cell_size):
    """The cell that coordinates lie in, (N,) whole float64, and how far from its middle, (N,) float32 in cells."""
    place = (units * COORDINATE_SCALE + origin) / cell_size
    cell = np.floor(place)
    # taken off before the precision is
    place -= cell
    place -= 0.5
    return cell, place.astype(np.float32)


def _kernels(settings):
    """The thread's own _Kernel of all cells about a point, of the nine next, and of those beyond."""
    if getattr(_own, "settings", None) != settings:
        radius, reach = settings.radius_cells, reach_of(settings)
        offsets = [(right, up) for up in range(-reach, reach + 1) for right in range(-reach, reach + 1)
                   if np.hypot(max(abs(right) - 0.5, 0), max(abs(up) - 0.5, 0)) < radius]
        near = [offset for offset in offsets if max(map(abs, offset)) <= 1]
        _own.settings = settings
        _own.kernels = [_Kernel(settings, some) for some in (offsets, near, [offset for offset in offsets if offset not in near])]
    return _own.kernels


class _Kernel:
    """What points weigh on cells about their own.

    offsets : (K) (right, up) of the cells
    at_once : points that are worked at a time
    """

    def __init__(self, settings, offsets):
        self.settings, self.offsets = settings, offsets
        self.at_once = max(AT_ONCE // max(len(offsets), 1), 1)
        self._kept = ScratchBuffers()   # used again and again: memory is dear when it is new
        right, up = np.array(offsets, np.float32).reshape(-1, 2).T
        # squared distances as a product: (e - r)^2 + (n - u)^2 = (e^2 + n^2) 1 - 2 e r - 2 n u + 1 (r^2 + u^2)
        self._squares = np.stack([np.ones_like(right), -2 * right, -2 * up, right**2 + up**2])

    def add(self, sums, width, number, east, north, value, weight):
        """Add what points weigh to complex sums of a lattice so wide, in which they lie in cells of ascending numbers."""
        starts = np.flatnonzero(np.r_[True, number[1:] != number[:-1]])
        runs = sparse.csr_matrix((weight, np.arange(len(number), dtype=np.int32), np.append(starts, len(number)).astype(np.int32)),
                                 shape=(len(starts), len(number)))
        shares = self.shares(east, north)
        added = self._kept.of(len(starts) * len(self.offsets))("added", np.complex64).reshape(len(starts), -1)
        added.real = runs @ shares
        runs.data = weight * value
        added.imag = runs @ shares
        target = number[starts].astype(np.intp)
        for (right, up), both in zip(self.offsets, added.T):
            sums[target + (right - up * width)] += both

    def shares(self, east, north):
        """(N, K) float32, till it is called again: weights of points on cells by distance alone, from the points' places in their own cells."""
        own = self._kept.of(4 * len(east))("own", np.float32).reshape(-1, 4)
        own[:, 0] = east * east + north * north
        own[:, 1], own[:, 2], own[:, 3] = east, north, 1.0
        found = cv2.gemm(own, self._squares, 1.0, None, 0.0, self._kept.of(len(east) * len(self.offsets))("found", np.float32).reshape(len(east), -1))
        cv2.sqrt(found, found)
        found *= np.float32(self.settings.cell_size)
        found += np.float32(NEAREST)
        found = self._weight(found)
        farthest = self._weight(np.full(1, self.settings.radius_cells * self.settings.cell_size + NEAREST, np.float32))
        return cv2.threshold(found, float(farthest[0]) * (1 - ROUNDING), 0.0, cv2.THRESH_TOZERO, found)[1]

    def _weight(self, distance):
        """1 / distance^power, in place."""
        if self.settings.power == 2.0:
            distance *= distance
        else:
            np.power(distance, np.float32(self.settings.power), out=distance)
        return np.divide(np.float32(1.0), distance, out=distance)
