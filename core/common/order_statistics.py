"""Sorting, ranks and quantiles of many 32-bit numbers in linear time, and decimation of crowded cells."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

FEW = 500        # numbers that numpy's lexsort takes less time for
RADIX_BITS = 16  # numpy sorts integers of up to 16 bits in linear time (radix sort)


def order_by(*keys: np.ndarray) -> np.ndarray:
    """Indices that sort by several keys, like `numpy.lexsort`: stable, in linear time.

    Each key is split into digits of 16 bits and sorted digit by digit, the least significant first (radix sort), where there are many.

    Parameters
    ----------
    keys : (N,) int32 each; the last is the primary key

    Returns
    -------
    (N,) intp
    """
    if keys and len(keys[0]) < FEW:
        return np.lexsort(keys)
    order = None
    for key in keys:
        key = above_least(np.asarray(key, np.int32))
        for shift in range(0, max(int(key.max()).bit_length(), 1), RADIX_BITS):
            digit = (key >> shift).astype(np.uint16)
            order = np.argsort(digit, kind="stable") if order is None else order.take(np.argsort(digit.take(order), kind="stable"))
    if order is None:
        raise ValueError("at least one key is needed")
    return order


def bucket_argsort(cell: np.ndarray, count: int, own: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Rows sorted by cell, stable; in linear time for fewer than 2**16 cells.

    Parameters
    ----------
    cell : (N,) cell numbers, 0 to count - 1
    count : number of cells
    own : (N,) bool, rows to use; all by default

    Returns
    -------
    rows : (M,) row numbers, ascending within each cell
    ends : (count,) index in `rows` at which each cell ends
    """
    kind = np.min_scalar_type(count)
    cell = cell.astype(kind)
    if own is not None:
        cell[~own] = count
    rows = np.argsort(cell, kind="stable")
    ends = np.searchsorted(cell.take(rows), np.arange(count, dtype=kind), side="right")
    return rows[:ends[-1]], ends


def above_least(values: np.ndarray) -> np.ndarray:
    """(N,) uint32: int32 values minus their minimum."""
    return (values - values.min()).view(np.uint32)


def decimate_cells(cell: np.ndarray, most: int) -> np.ndarray:
    """Indices of at most about `most` members of every cell, evenly spaced in their order; sorted by cell.

    Parameters
    ----------
    cell : (N,) int32 cell numbers, 0 or more
    most : members kept per cell

    Returns
    -------
    (M,) intp
    """
    count = np.bincount(cell)
    step = -(-count // most)
    order = order_by(cell)
    if step.max(initial=0) > 1:
        first = np.cumsum(count) - count
        rank = np.arange(len(order), dtype=np.int32) - np.repeat(first.astype(np.int32), count)
        order = order[rank % np.repeat(step.astype(np.int32), count) == 0]
    return order


def ranked(values: np.ndarray, ranks: np.ndarray | Sequence[int]) -> np.ndarray:
    """The values at given ranks of the ascending order, found by counting.

    Parameters
    ----------
    values : (N,) int32 or float32 without NaN
    ranks : (R,) int, 0 to N - 1

    Returns
    -------
    (R,) of the dtype of `values`
    """
    key = above_least(_sortable_bits(values))
    digit = key >> max(int(key.max()).bit_length() - RADIX_BITS, 0)
    below = np.cumsum(np.bincount(digit))
    found = np.empty(len(ranks), values.dtype)
    places = np.searchsorted(below, ranks, side="right")
    for place in np.unique(places):
        members = np.sort(values[digit == place])
        wanted = places == place
        found[wanted] = members[np.asarray(ranks)[wanted] - (below[place - 1] if place else 0)]
    return found


def ascending(values: np.ndarray) -> np.ndarray:
    """(N,) sorted values without NaN; int32 and float32 in linear time."""
    return values[order_by(_sortable_bits(values))] if values.dtype in (np.int32, np.float32) else np.sort(values)


def _sortable_bits(values: np.ndarray) -> np.ndarray:
    """(N,) int32 in the same order as the int32 or float32 values."""
    bits = values.view(np.int32)
    # the bit patterns of negative floats ascend in reverse order
    return bits ^ ((bits >> 31) & np.int32(0x7FFFFFFF)) if values.dtype.kind == "f" else bits


def quantiles(values: np.ndarray, shares: np.ndarray | Sequence[float]) -> np.ndarray:
    """Quantiles in linear time, interpolated as by `numpy.quantile`.

    Parameters
    ----------
    values : (N,) int32 or float32 without NaN, N > 0
    shares : (S,) 0 to 1

    Returns
    -------
    (S,) float64
    """
    return _interpolated(shares, len(values), lambda ranks: ranked(values, ranks))


def quantile_in_order(values: np.ndarray, count: int, share: float) -> float:
    """One quantile of the first `count` of sorted values, interpolated as by `numpy.quantile`."""
    place = share * (count - 1)
    k = int(place)
    a, b = float(values[k]), float(values[min(k + 1, count - 1)])
    share = place - k
    return a + (b - a) * share if share < 0.5 else b - (b - a) * (1.0 - share)


def _interpolated(shares: np.ndarray | Sequence[float], count: int, at_ranks: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    place = np.asarray(shares) * (count - 1)
    before = np.floor(place).astype(np.int64)
    a, b = at_ranks(np.r_[before, np.minimum(before + 1, count - 1)]).astype(float).reshape(2, -1)
    share = place - before
    return np.where(share < 0.5, a + (b - a) * share, b - (b - a) * (1.0 - share))
