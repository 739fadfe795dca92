"""The order in which a section returns its points, each once: it does not depend on the order of the files, nor on how far these overlap."""

from __future__ import annotations

import numpy as np

from ...common.order_statistics import RADIX_BITS, above_least, bucket_argsort, order_by
from .columns import Columns
from .records import take_rows

SORT_CHUNK = 1 << 15   # points sorted at a time: they fit the processor's cache
STATION_CELL_BITS = 7  # bits of the number of a cell of stations; points are sorted into cells first (fewer than a byte holds)
# Sort keys, the most significant last: the first set differs between nearly all points, the second between all that are not identical.
PLACE_KEYS = "z", "d", "s"
ALL_KEYS = "returns", "source", "y", "x", "intensity", "time", *PLACE_KEYS


def canonical_order(records: np.ndarray | Columns, mask: np.ndarray | None = None) -> np.ndarray:
    """Indices that sort records by station, offset, height, time and the remaining columns.

    A record that is the same as another in all of them is the same point from two files, as where tiles overlap: one of them is taken.

    Parameters
    ----------
    records : (N,) of at least the columns `ALL_KEYS`
    mask : (N,) bool, the records to be sorted; all by default

    Returns
    -------
    (M,) intp, no two of them of equal records
    """
    if not len(records):
        return np.empty(0, np.intp)
    along, across = records["s"], records["d"]
    cell = above_least(along)
    cell >>= max(int(cell.max()).bit_length() - STATION_CELL_BITS, 0)
    order, ends = bucket_argsort(cell, 2**STATION_CELL_BITS, mask)
    tied_parts, first = [np.empty(0, np.intp)], 0
    for end in _chunk_ends(ends):
        rows = order[first:end]
        s, d = above_least(along.take(rows)), above_least(across.take(rows))
        d >>= max(int(d.max()).bit_length() - RADIX_BITS, 0)
        by_place = order_by(d, s)
        order[first:end] = rows.take(by_place)
        tied_parts.append(_same_as_next(s.take(by_place), d.take(by_place)) + first)
        first = end
    # Few points share the station and the leading bits of the offset: only these are sorted by the other columns.
    tied = np.concatenate(tied_parts)
    for names in (PLACE_KEYS, ALL_KEYS):
        if len(tied):
            places = np.union1d(tied, tied + 1)
            some = take_rows(records, order[places])
            keys = [some[name] for name in names]
            by_keys = np.lexsort(keys)
            order[places] = order[places[by_keys]]
            tied = places[_same_as_next(*(key[by_keys] for key in keys))]
    return np.delete(order, tied) if len(tied) else order


def _same_as_next(*keys):
    """Indices of the rows whose keys equal those of the next row."""
    return np.flatnonzero(np.logical_and.reduce([key[1:] == key[:-1] for key in keys]))


def _chunk_ends(ends):
    """Where runs of cells end that hold about SORT_CHUNK points each."""
    last = np.searchsorted(ends, np.arange(SORT_CHUNK, ends[-1] + SORT_CHUNK, SORT_CHUNK))
    return np.unique(ends[last.clip(max=len(ends) - 1)]).tolist()
