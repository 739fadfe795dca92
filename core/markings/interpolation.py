"""Inverse distance sums on a grid of cells: every point weighs on all cells within its reach."""

from dataclasses import dataclass

import numpy as np

from ..survey.sorting import order_by

NEAREST = 1e-3      # m added to a distance, so that a point on a cell's centre has a finite weight
AT_ONCE = 1 << 15   # points worked at a time: what fits the processor's cache


@dataclass
class InCells:
    """Points in the cells of a grid with a margin of twice the reach about it.

    cell : (N,) int32; east, south : (N,) float32, cells from the middle of the point's own
    """

    cell: np.ndarray
    east: np.ndarray
    south: np.ndarray

    @classmethod
    def of(cls, u, v, width, settings):
        """Points at columns u and rows v, (N,) float64 in cells, at most the reach outside the grid; cell 0 from 0 to 1."""
        margin = 2 * reach_of(settings)
        column, row = np.floor(u), np.floor(v)
        cell = ((row + margin) * (width + 2 * margin) + (column + margin)).astype(np.int32)
        # taken off before the precision is
        return cls(cell, (u - column - 0.5).astype(np.float32), (v - row - 0.5).astype(np.float32))

    @classmethod
    def joined(cls, parts):
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("cell", "east", "south")))

    def __getitem__(self, which):
        return InCells(self.cell[which], self.east[which], self.south[which])


def reach_of(settings):
    """Cells that a point reaches beyond its own."""
    return int(np.ceil(settings.radius_cells))


def interpolation_sums(points, value, weight, width, height, settings):
    """Weighted sums of values and of weights per cell.

    Parameters
    ----------
    points : InCells
    value, weight : (N,) float32, intensity and brightness weight
    settings : ImageSettings

    Returns
    -------
    two (height, width) float64 arrays; both 0 where no point is within the radius

    Notes
    -----
    Points are sorted by cell, so that what they add to a neighbour of their cell
    is the sum of a run; weights are taken in single precision, far finer than intensities are.
    """
    margin = 2 * reach_of(settings)
    columns, rows = width + 2 * margin, height + 2 * margin
    order = order_by(points.cell)
    points, value, weight = points[order], value[order], weight[order]
    total, weights = np.zeros(rows * columns), np.zeros(rows * columns)
    starts = np.flatnonzero(np.r_[True, points.cell[1:] != points.cell[:-1]][:len(value)])
    first = 0
    while first < len(starts):
        end = max(int(np.searchsorted(starts, starts[first] + AT_ONCE)), first + 1)
        run = slice(starts[first], starts[end] if end < len(starts) else len(value))
        _add(total, weights, points.cell[starts[first:end]], starts[first:end] - starts[first], columns,
             points[run], value[run], weight[run], settings)
        first = end
    kept = slice(margin, margin + height), slice(margin, margin + width)
    return total.reshape(rows, columns)[kept], weights.reshape(rows, columns)[kept]


def _add(total, weights, targets, starts, columns, points, value, weight, settings):
    """Add what runs of points weigh on the cells about their own."""
    radius, reach = settings.radius_cells, reach_of(settings)
    squares = [[(offset - k) ** 2 for k in range(-reach, reach + 1)] for offset in (points.east, points.south)]
    share, inside = np.empty(len(value), np.float32), np.empty(len(value), bool)
    for dv in range(-reach, reach + 1):
        for du in range(-reach, reach + 1):
            if np.hypot(max(abs(du) - 0.5, 0), max(abs(dv) - 0.5, 0)) >= radius:
                continue
            np.add(squares[0][du + reach], squares[1][dv + reach], out=share)
            cut = np.hypot(abs(du) + 0.5, abs(dv) + 0.5) > radius
            if cut:
                # a point right on the radius counts, whatever rounding makes of it
                np.less_equal(share, np.float32(radius * radius * (1.0 + 2e-6)), out=inside)
            np.sqrt(share, out=share)
            share *= np.float32(settings.cell_size)
            share += np.float32(NEAREST)
            if settings.power == 2.0:
                share *= share
            else:
                np.power(share, np.float32(settings.power), out=share)
            np.divide(weight, share, out=share)
            if cut:
                share *= inside
            cells = targets + (dv * columns + du)
            weights[cells] += np.add.reduceat(share, starts)
            share *= value
            total[cells] += np.add.reduceat(share, starts)
