"""Inverse distance sums on a grid of cells: every point weighs on all cells within its reach."""

import numpy as np

from ..survey.points import order_by

NEAREST = 1e-3      # m added to a distance, so that a point on a cell's centre has a finite weight
AT_ONCE = 1 << 15   # points worked at a time: what fits the processor's cache


def interpolation_sums(u, v, value, weight, width, height, settings):
    """Weighted sums of values and of weights per cell.

    Parameters
    ----------
    u, v : (N,) column and row of the points in cells, cell 0 from 0 to 1, at most the radius outside the grid
    value, weight : (N,) intensity and brightness weight
    settings : ImageSettings

    Returns
    -------
    two (height, width) float64 arrays; both 0 where no point is within the radius

    Notes
    -----
    Points are sorted by cell, so that what they add to a neighbour of their cell
    is the sum of a run; weights are taken in single precision, far finer than intensities are.
    """
    reach = int(np.ceil(settings.radius_cells))
    margin = 2 * reach
    columns, rows = width + 2 * margin, height + 2 * margin
    column, row = np.floor(u), np.floor(v)
    cell = ((row + margin) * columns + (column + margin)).astype(np.int32)
    order = order_by(cell)
    cell = cell[order]
    # metres to the cell's centre, subtracted before the precision is
    east, south = ((at - whole - 0.5).astype(np.float32)[order] for at, whole in ((u, column), (v, row)))
    value, weight = (np.asarray(values, np.float32)[order] for values in (value, weight))
    total, weights = np.zeros(rows * columns), np.zeros(rows * columns)
    starts = np.flatnonzero(np.r_[True, cell[1:] != cell[:-1]][:len(cell)])
    first = 0
    while first < len(starts):
        end = max(int(np.searchsorted(starts, starts[first] + AT_ONCE)), first + 1)
        a, b = starts[first], starts[end] if end < len(starts) else len(cell)
        _add(total, weights, cell[starts[first:end]], starts[first:end] - a, columns,
             east[a:b], south[a:b], value[a:b], weight[a:b], settings)
        first = end
    kept = slice(margin, margin + height), slice(margin, margin + width)
    return total.reshape(rows, columns)[kept], weights.reshape(rows, columns)[kept]


def _add(total, weights, targets, starts, columns, east, south, value, weight, settings):
    """Add what runs of points weigh on the cells about their own."""
    radius, reach = settings.radius_cells, int(np.ceil(settings.radius_cells))
    squares = [[(offset - k) ** 2 for k in range(-reach, reach + 1)] for offset in (east, south)]
    share, inside = np.empty(len(east), np.float32), np.empty(len(east), bool)
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
