"""The height that is free above a strip of road."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..survey.store.records import Points

LOWEST_OVERHEAD = 2.3     # m: nothing hangs lower over a carriageway, and most vehicles end below it
CLEARANCE_CELL = 0.25     # m, of the columns that are looked through
STANDS_FROM = 0.35        # m above the road: a column with points from here to LOWEST_OVERHEAD stands on the road
STANDING_REACH = 4        # columns about a standing one that belong to the same thing, as a lorry's roof to its flank
MIN_OVERHEAD_POINTS = 4   # of a column within OVERHEAD_DEPTH of its lowest point, so that ghosts and birds do not count
OVERHEAD_DEPTH = 0.15     # m
MIN_OVERHEAD_COLUMNS = 2  # that must agree
OVERHEAD_INSIDE = 0.15             # m by which the strip is narrowed: a pole beside the road is not above it


def clear_height(points: Points, h: np.ndarray, right: float, left: float) -> float | None:
    """Height of the lowest thing above a strip.

    Parameters
    ----------
    points : (N,) Points of a stretch of road
    h : (N,) m, heights above the surface
    right, left : m, offsets of the strip's borders

    Returns
    -------
    m; None where nothing was seen above it
    """
    d = points.d
    near = np.flatnonzero((d > right + OVERHEAD_INSIDE) & (d < left - OVERHEAD_INSIDE) & (h > STANDS_FROM))
    if not len(near):
        return None
    s, d, h = points.s[near], d[near], h[near]
    i, j = (np.floor(v / CLEARANCE_CELL).astype(np.int64) for v in (s - s.min(), d - right))
    shape = int(i.max()) + 1, int(j.max()) + 1
    standing = np.zeros(shape, bool)
    low = h < LOWEST_OVERHEAD
    standing[i[low], j[low]] = True
    reach = np.ones((2 * STANDING_REACH + 1,) * 2)
    if standing.any():
        from scipy.ndimage import binary_dilation

        standing = binary_dilation(standing, reach)
    free = ~low & ~standing[i, j]
    if not free.any():
        return None
    place, h = (i * shape[1] + j)[free], h[free]
    order = np.lexsort((h, place))
    place, h = place[order], h[order]
    first = np.flatnonzero(np.r_[True, np.diff(place) > 0])
    last = np.r_[first[1:], len(place)] - 1
    needed = first + MIN_OVERHEAD_POINTS - 1
    lowest = h[first]
    solid = needed <= last
    solid[solid] = h[needed[solid]] - lowest[solid] < OVERHEAD_DEPTH
    lowest = np.sort(lowest[solid])
    return float(lowest[MIN_OVERHEAD_COLUMNS - 1]) if len(lowest) >= MIN_OVERHEAD_COLUMNS else None
