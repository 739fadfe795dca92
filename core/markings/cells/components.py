"""Which occupied cells of a grid belong together: those that touch, and those whose points lie near enough."""

from __future__ import annotations

import numpy as np

from ...common.arrays import linked_groups, order_by
from ...lazy import cv2


def occupied(row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The cells that points lie in.

    Parameters
    ----------
    row, column : (N,) int32

    Returns
    -------
    cells : (K, 2) int64, different ones, sorted
    member : (N,) int, the cell of each point
    """
    if not len(row):
        return np.empty((0, 2), np.int64), np.empty(0, np.int64)
    order = order_by(column, row)
    row, column = row.take(order), column.take(order)
    new = np.r_[True, (row[1:] != row[:-1]) | (column[1:] != column[:-1])]
    member = np.empty(len(row), np.int64)
    member[order] = np.cumsum(new) - 1
    return np.stack([row[new], column[new]], axis=1).astype(np.int64), member


def components(cells: np.ndarray, places: np.ndarray, size: tuple[float, float], distance: float) -> np.ndarray:
    """Connected components of cells whose places lie within a distance.

    Parameters
    ----------
    cells : (K, 2) int, row and column, different ones, sorted
    places : (K, 2) m, a place in each cell
    size : (2,) m, of a cell in the units of the places
    distance : m between places that belong together

    Returns
    -------
    (K,) int32 component of each cell, numbered in the order of the cells

    Notes
    -----
    Exact, and without measuring every pair: where places of cells that touch are
    near enough wherever they lie, an image of the cells gives the patches that
    are connected, and pairs are measured between patches only.
    """
    if not len(cells):
        return np.empty(0, np.int32)
    rows, columns = (int(distance / length) + 1 for length in size)
    low = cells.min(axis=0)
    height, width = (cells.max(axis=0) - low + 1 + [rows, 2 * columns]).tolist()
    at = (cells[:, 0] - low[0]) * width + cells[:, 1] - low[1] + columns
    touching = 2 * np.hypot(*size) <= distance
    patch = _patches(at, (height, width)) if touching else np.arange(len(at), dtype=np.int32)
    image = np.full(height * width + width, -1, np.int32)
    image[at] = patch
    count = int(patch.max()) + 1
    linked = [np.empty(0, np.int64)]
    for row in range(rows + 1):
        for column in range(-columns if row else 1, columns + 1):
            step = row * width + column
            if touching and row <= 1 and abs(column) <= 1:
                continue
            other = image.take(at + step)
            apart = np.flatnonzero((other >= 0) & (other != patch))
            if len(apart):
                beside = np.searchsorted(at, at[apart] + step)
                apart = apart[((places[apart] - places[beside]) ** 2).sum(axis=1) <= distance**2]
                linked.append(patch[apart].astype(np.int64) * count + image[at[apart] + step])
    first, second = np.divmod(np.unique(np.concatenate(linked)), count)
    return linked_groups(first, second, count)[patch]


def _patches(at, shape):
    """(K,) int32, the patch of touching cells that each of some cells of an image belongs to, numbered in their order."""
    image = np.zeros(shape, np.uint8)
    image.ravel()[at] = 1
    count, labels = cv2.connectedComponents(image, connectivity=8, ltype=cv2.CV_32S)
    labels = labels.ravel()[at]
    first = np.full(count, len(at))
    first[labels[::-1]] = np.arange(len(at))[::-1]
    number = np.empty(count, np.int32)
    number[np.argsort(first, kind="stable")] = np.arange(count)
    return number[labels]
