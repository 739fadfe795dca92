"""Sorting many integers in linear time, and thinning what is crowded."""

import numpy as np

RADIX_BITS = 16  # numpy sorts integers of so many bits in linear time


def order_by(*keys):
    """Indices that sort by the last of some int32 keys, then by those before it; what is equal keeps its order.

    Keys are taken apart into digits of 16 bits, and sorted digit by digit.
    """
    order = None
    for key in keys:
        if not len(key):
            return np.empty(0, np.intp)
        key = above_least(np.asarray(key, np.int32))
        for shift in range(0, max(int(key.max()).bit_length(), 1), RADIX_BITS):
            digit = (key >> shift).astype(np.uint16)
            order = np.argsort(digit, kind="stable") if order is None else order.take(np.argsort(digit.take(order), kind="stable"))
    return order


def bucket_argsort(cell, count, own=None):
    """Rows bucket_argsort to cells, in linear time where there are less than 2**16 of them.

    Parameters
    ----------
    cell : (N,) whole numbers from 0 to count - 1
    own : (N,) bool, those that are meant; all by default

    Returns
    -------
    rows : (M,) those of the first cell, then those of the next, each in ascending order
    ends : (count,) where the rows of every cell end
    """
    kind = np.min_scalar_type(count)
    cell = cell.astype(kind)
    if own is not None:
        cell[~own] = count
    rows = np.argsort(cell, kind="stable")
    ends = np.searchsorted(cell.take(rows), np.arange(count, dtype=kind), side="right")
    return rows[:ends[-1]], ends


def above_least(values):
    """(N,) uint32 of int32 less the least of them."""
    return (values - values.min()).view(np.uint32)


def decimate_cells(cell, most):
    """Indices of at most about `most` members of every cell, evenly spread over their order; sorted by cell.

    Parameters
    ----------
    cell : (N,) int32, 0 or more
    """
    count = np.bincount(cell)
    step = -(-count // most)
    order = order_by(cell)
    if step.max(initial=0) > 1:
        first = np.cumsum(count) - count
        rank = np.arange(len(order), dtype=np.int32) - np.repeat(first.astype(np.int32), count)
        order = order[rank % np.repeat(step.astype(np.int32), count) == 0]
    return order


def ranked(values, ranks):
    """The values that have some ranks in ascending order, found by counting.

    Parameters
    ----------
    values : (N,) int32 or float32, no NaN
    ranks : (R,) int, 0 to N - 1

    Returns
    -------
    (R,) of the dtype of values
    """
    key = above_least(_ascending(values))
    digit = key >> max(int(key.max()).bit_length() - RADIX_BITS, 0)
    below = np.cumsum(np.bincount(digit))
    found = np.empty(len(ranks), values.dtype)
    places = np.searchsorted(below, ranks, side="right")
    for place in np.unique(places):
        members = np.sort(values[digit == place])
        wanted = places == place
        found[wanted] = members[np.asarray(ranks)[wanted] - (below[place - 1] if place else 0)]
    return found


def ascending(values):
    """(N,) numbers without NaN, sorted; int32 and float32 in linear time."""
    return values[order_by(_ascending(values))] if values.dtype in (np.int32, np.float32) else np.sort(values)


def _ascending(values):
    """(N,) int32 that lie in the order of int32 or float32."""
    bits = values.view(np.int32)
    # the bits of numbers below 0 ascend the other way
    return bits ^ ((bits >> 31) & np.int32(0x7FFFFFFF)) if values.dtype.kind == "f" else bits


def quantiles(values, shares):
    """(S,) float64 quantiles of (N,) int32 or float32, between neighbouring values as `np.quantile` has it."""
    return _between(shares, len(values), lambda ranks: ranked(values, ranks))


def quantile_in_order(values, count, share):
    """The same of the first `count` of values that are sorted, for one share: a float."""
    place = share * (count - 1)
    k = int(place)
    a, b = float(values[k]), float(values[min(k + 1, count - 1)])
    share = place - k
    return a + (b - a) * share if share < 0.5 else b - (b - a) * (1.0 - share)


def _between(shares, count, at_ranks):
    place = np.asarray(shares) * (count - 1)
    before = np.floor(place).astype(np.int64)
    a, b = at_ranks(np.r_[before, np.minimum(before + 1, count - 1)]).astype(float).reshape(2, -1)
    share = place - before
    return np.where(share < 0.5, a + (b - a) * share, b - (b - a) * (1.0 - share))
