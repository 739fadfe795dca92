"""Which points lie on a road whose height and limits are known, and which stand on it."""

from dataclasses import dataclass

import numpy as np

from ..survey.points import UNIT
from .cover import HIGH, LOW
from .surface_cells import AT_ONCE, COLUMN, ROW


@dataclass(frozen=True)
class OnRoad:
    """Points of a window by index.

    surface : (M,) those of the road itself; half_width : (M,) uint16 mm from the reference line to the limit of each one's side
    above : (K,) what is LOW to HIGH above it
    """

    surface: np.ndarray
    half_width: np.ndarray
    above: np.ndarray


def points_on_road(points, carriageway):
    """The points of a window that lie on the road or stand above it.

    Between the middles of rows the limits are straight; beside a row without road the nearer row counts.
    Between the middles of cells the height is bilinear.

    Parameters
    ----------
    points : Points
    carriageway : Carriageway

    Returns
    -------
    OnRoad

    Notes
    -----
    It is reckoned in units of 0.1 mm from a corner of each cell in single precision, which
    is finer than coordinates are, and the same from whichever window a point is looked at.
    """
    records = points.records
    if not len(records):
        return OnRoad(np.empty(0, np.intp), np.empty(0, np.uint16), np.empty(0, np.intp))
    here = _Window(carriageway, records["s"])
    parts = []
    for first in range(0, len(records), AT_ONCE):
        found = here.points(*(records[name][first:first + AT_ONCE] for name in ("s", "d", "z")))
        parts.append((found[0] + first, found[1], found[2] + first))
    return OnRoad(*(np.concatenate(part) for part in zip(*parts)))


class _Window:
    """Limits and height of the rows about a window, as tables of half rows and of cells."""

    def __init__(self, carriageway, s):
        cells = carriageway.cells
        last = len(cells.height) - 1
        low, high = (int(np.clip(np.floor(end * UNIT / ROW - cells.first_row - 0.5), 0, last)) for end in (s.min(), s.max()))
        rows = slice(min(low, max(last - 1, 0)), min(high + 2, last + 1))
        if last == 0:
            rows = np.zeros(2, int)   # one row is as wide and high everywhere
        height = carriageway.height[rows].astype(float)
        first_row = cells.first_row + (rows.start if last else 0)
        self.count, self.columns = height.shape
        self.s0, self.d0 = (int(round((first + 0.5) * size / UNIT)) for first, size in ((first_row, ROW), (cells.first_column, COLUMN)))
        self.left, self.right = (_half_rows(limit[rows] / UNIT) for limit in (carriageway.left, carriageway.right))
        height = height / UNIT
        across = np.diff(height, axis=1)
        self.corner = np.rint(height[:-1, :-1]).astype(np.int32).ravel()
        # height = corner + rest + across * v + (along + twist * v) * u, with u, v from 0 to 1 in the cell
        self.tables = [table.astype(np.float32).ravel() for table in (height[:-1, :-1] - np.rint(height[:-1, :-1]), across[:-1],
                                                                      np.diff(height, axis=0)[:, :-1], np.diff(across, axis=0))]
        self.tolerance, self.low, self.high = (np.float32(metres / UNIT) for metres in (carriageway.tolerance, LOW, HIGH))

    def points(self, s, d, z):
        """Indices of points of the road, their half widths (mm), and indices of points above it."""
        row, u = _steps(s, self.s0, ROW, self.count)
        half = 2 * row
        half += u >= np.float32(0.5)
        left, right = (start.take(half) + slope.take(half) * u for start, slope in (self.left, self.right))
        inside = np.flatnonzero((d < left) & (d > right))
        u, cell, d = u.take(inside), row.take(inside), d.take(inside)
        column, v = _steps(d, self.d0, COLUMN, self.columns)
        cell *= self.columns - 1
        cell += column
        rest, across, along, twist = (table.take(cell) for table in self.tables)
        twist *= v
        along += twist
        along *= u
        across *= v
        rest += across
        rest += along
        rise = z.take(inside)
        rise -= self.corner.take(cell)
        rise = rise - rest
        on_road = np.flatnonzero(np.abs(rise) < self.tolerance)
        kept, d = inside.take(on_road), d.take(on_road)
        width = np.where(d >= 0, left.take(kept), -right.take(kept))
        width = np.maximum(width, np.abs(d)) * np.float32(UNIT * 1e3)
        return kept, np.clip(np.rint(width), 0, 65535).astype(np.uint16), inside[(rise > self.low) & (rise < self.high)]


def _steps(units, first, size, count):
    """The step that places lie in and the share of it behind them, (N,) int32 and float32, of `count` places `size` metres apart."""
    size = int(round(size / UNIT))
    place = np.clip(units - np.int32(first), 0, (count - 1) * size)
    step = place // np.int32(size)
    np.minimum(step, count - 2, out=step)
    place -= step * np.int32(size)
    return step, place * np.float32(1.0 / size)


def _half_rows(limit):
    """(start, slope) of a limit, (2 (R - 1),) float32 each: what it is, of u from 0 to 1 between rows, in each half row."""
    before, after = limit[:-1], limit[1:]
    whole = np.isfinite(before) & np.isfinite(after)
    slope = np.where(whole, after - before, 0.0)
    start = np.stack([before, np.where(whole, before, after)], axis=1)
    return start.ravel().astype(np.float32), np.repeat(slope, 2).astype(np.float32)
