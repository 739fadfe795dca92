"""Which of many stretches of a road meet: found in order of station, so that a long survey needs no table of all pairs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

PAIRS_PER_BLOCK = 1 << 18  # about so many are handed out at a time
ROUNDING_TOLERANCE = 1e-6  # m, more than coordinates are rounded by


def overlapping_pairs(first: np.ndarray, last: np.ndarray, other_first: np.ndarray, other_last: np.ndarray,
                      apart: float = 0.0) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Pairs of stretches that overlap, touch or lie no farther apart than a distance.

    Parameters
    ----------
    first, last : (N,) m, first <= last
    other_first, other_last : (M,) m, likewise
    apart : m

    Yields
    ------
    a, b : (P,) int each, indices of the first and the second stretch of each pair. Every pair comes
        once, a stretch with itself too; some that lie a hair farther apart are among them.
    """
    reach = apart + ROUNDING_TOLERANCE
    order, other_order = np.argsort(first, kind="stable"), np.argsort(other_first, kind="stable")
    begins, other_begins = first[order], other_first[other_order]
    # of two that meet, one begins before the other has ended
    ends = np.searchsorted(other_begins, last + reach, side="right")
    for a, b in _ranges(np.searchsorted(other_begins, first, side="left"), ends):
        yield a, other_order[b]
    ends = np.searchsorted(begins, other_last + reach, side="right")
    for b, a in _ranges(np.searchsorted(begins, other_first, side="right"), ends):
        yield order[a], b


def _ranges(starts, ends):
    """Blocks of pairs of each number and all that lie in its range."""
    count = np.maximum(ends - starts, 0)
    total = np.cumsum(count)
    cuts = np.unique(np.searchsorted(total, np.arange(PAIRS_PER_BLOCK, total[-1] if len(total) else 0, PAIRS_PER_BLOCK), side="left"))
    for some in np.split(np.arange(len(count)), cuts):
        size = count[some]
        if size.any():
            within = np.arange(size.sum()) - np.repeat(np.cumsum(size) - size, size)
            yield np.repeat(some, size), np.repeat(starts[some], size) + within
