"""Intensities of several scanners and passes brought to one level.

Two scanners that see one place return different intensities: their gains differ, and so do the ranges and angles at which they see it.
A cell that both have measured then seems to scatter by half of its brightness, in which gravel beside asphalt drowns; and where
only one of them sees the ground, the road seems to change. What they differ by where both see the same ground does not depend
on what that ground is.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded

LEVEL_WIDTH = 1.0        # m across the road in which the levels of views differ by one factor
POINT_SIGMA = 0.2        # of the logarithm of the intensity of a point about that of its cell: texture, speckle, paint
CHANGE_SIGMA = 0.1       # of the logarithm of a factor from one LEVEL_WIDTH to the next: range and angle change evenly
LEVEL_SIGMA = 2.0        # of the logarithm of a factor itself: it is unknown


def at_one_level(intensity: np.ndarray, view: np.ndarray, cell: np.ndarray, shape: tuple[int, int], column_size: float) -> np.ndarray:
    """Intensities as they would be if all views were the mean of them.

    The logarithm of an intensity is that of its cell plus that of its view, which changes evenly across the road; both are
    estimated by least squares from the cells that several views have measured.

    Parameters
    ----------
    intensity : (N,) raw counts
    view : (N,) number of the view of each point, a scanner on a pass, from 0
    cell : (N,) number of the cell of each point, row by row
    shape : rows and columns of the cells
    column_size : m across the road

    Returns
    -------
    (N,) float32 counts; the intensities themselves where there is one view
    """
    views = int(view.max(initial=0)) + 1
    value = intensity.astype(np.float32)
    if views == 1:
        return value
    logarithm = np.log(np.maximum(value, 1.0))
    place = cell.astype(np.int64) * views + view
    count = np.bincount(place, minlength=shape[0] * shape[1] * views).reshape(*shape, views)
    mean = np.bincount(place, logarithm, count.size).reshape(count.shape) / np.maximum(count, 1)
    level = _levels(count, mean, column_size)
    return value * np.exp(-level.astype(np.float32))[view, cell % shape[1]]


def _levels(count, mean, column_size):
    """(V, C) logarithms of the factors of V views in C columns, from points and means of logarithms, (R, C, V)."""
    columns, views = count.shape[1:]
    total = np.maximum(count.sum(2, keepdims=True), 1)
    off = count * (mean - (count * mean).sum(2, keepdims=True) / total)
    # normal equations without the unknown brightness of each cell
    both = -np.einsum("rcv,rcw->cvw", count / total, count)
    both[:, np.arange(views), np.arange(views)] += count.sum(0)
    bin_of = (np.arange(columns) * column_size / LEVEL_WIDTH).astype(np.int64)
    bins = int(bin_of[-1]) + 1
    first = np.searchsorted(bin_of, np.arange(bins))
    both, off = np.add.reduceat(both, first, axis=0), np.add.reduceat(off.sum(0), first, axis=0)
    smooth = (POINT_SIGMA / CHANGE_SIGMA) ** 2
    neighbours = np.full(bins, 2.0)
    neighbours[[0, -1]] -= 1.0
    both[:, np.arange(views), np.arange(views)] += (neighbours * smooth)[:, None] + (POINT_SIGMA / LEVEL_SIGMA) ** 2
    # bins are coupled to the next ones alone: a band of one value per view
    band = np.zeros((views + 1, bins * views))
    for k in range(views):
        band[views - k].reshape(bins, views)[:, k:] = np.diagonal(both, k, 1, 2)
    band[0, views:] = -smooth if bins > 1 else 0.0
    found = solveh_banded(band, off.ravel()).reshape(bins, views)
    middles = (np.arange(bins) + 0.5) * LEVEL_WIDTH
    return np.array([np.interp((np.arange(columns) + 0.5) * column_size, middles, found[:, k]) for k in range(views)])
