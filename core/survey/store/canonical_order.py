"""The order in which the points of a section are handed out: the same whatever order files came in."""

import numpy as np

from ...common.order_statistics import BITS, above_least, dealt, order_by
from .records import take_rows

AT_ONCE = 1 << 15      # points sorted at a time: what fits the processor's cache
CELLS = 7              # bits of a cell of stations, to which points are dealt first: of fewer than a byte holds
ALMOST = "z", "d", "s"                                    # what nearly all points differ by, the last first
KEYS = "returns", "source", "y", "x", "intensity", "time", *ALMOST


def canonical_order(records, stay=None):
    """Indices that sort records by station, offset, height and time.

    `stay` is a mask of those that are meant, all by default.
    """
    if not len(records):
        return np.empty(0, np.intp)
    along, across = records["s"], records["d"]
    cell = above_least(along)
    cell >>= max(int(cell.max()).bit_length() - CELLS, 0)
    order, ends = dealt(cell, 2**CELLS, stay)
    repeated, first = [np.empty(0, np.intp)], 0
    for end in _pieces(ends):
        rows = order[first:end]
        s, d = above_least(along.take(rows)), above_least(across.take(rows))
        d >>= max(int(d.max()).bit_length() - BITS, 0)
        by_place = order_by(d, s)
        order[first:end] = rows.take(by_place)
        repeated.append(_repeated(s.take(by_place), d.take(by_place)) + first)
        first = end
    # the few that share a station to the last digit and an offset nearly are left to sort
    repeated = np.concatenate(repeated)
    for names in (ALMOST, KEYS):
        if len(repeated):
            tied = np.union1d(repeated, repeated + 1)
            some = take_rows(records, order[tied])
            keys = [some[name] for name in names]
            by_keys = np.lexsort(keys)
            order[tied] = order[tied[by_keys]]
            repeated = tied[_repeated(*(key[by_keys] for key in keys))]
    return order


def _repeated(*keys):
    """Indices of those that have the same keys as the next one."""
    return np.flatnonzero(np.logical_and.reduce([key[1:] == key[:-1] for key in keys]))


def _pieces(ends):
    """Where runs of cells end that hold about as many points as are sorted at a time."""
    last = np.searchsorted(ends, np.arange(AT_ONCE, ends[-1] + AT_ONCE, AT_ONCE))
    return np.unique(ends[last.clip(max=len(ends) - 1)]).tolist()
