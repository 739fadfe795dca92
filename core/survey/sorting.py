"""Sorting many integers in linear time, and thinning what is crowded."""

import numpy as np

BITS = 16  # numpy sorts integers of so many bits in linear time


def order_by(*keys):
    """Indices that sort by the last of some int32 keys, then by those before it; what is equal keeps its order.

    Keys are taken apart into digits of 16 bits, and sorted digit by digit.
    """
    order = None
    for key in keys:
        if not len(key):
            return np.empty(0, np.intp)
        key = above_least(np.asarray(key, np.int32))
        for shift in range(0, max(int(key.max()).bit_length(), 1), BITS):
            digit = (key >> shift).astype(np.uint16)
            order = np.argsort(digit, kind="stable") if order is None else order[np.argsort(digit[order], kind="stable")]
    return order


def above_least(values):
    """(N,) uint32 of int32 less the least of them."""
    return (values - values.min()).view(np.uint32)


def thinned(cell, most):
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
