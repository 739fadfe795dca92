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
HIGHEST_VEHICLE = 4.5     # m: 4.0 to 4.3 m are allowed (EU directive 96/53/EC, Japan, China, United States), and loads lie a little higher
BROADEST_VEHICLE = 3.2    # m: 2.6 m are allowed, and mirrors stand out
VEHICLE_REACH = 25.0      # m along the road over which what drives may be seen, drawn out by its own motion
VEHICLE_CELL = 0.25       # m, of the cells that tell what hangs together
LINKED_CELLS = 2, 1, 1    # cells along, across and up by which the points of one thing may lie apart, on either side


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


def on_vehicles(s: np.ndarray, d: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Which points belong to what stands or drives on the road.

    A vehicle that moves beside the scanner is drawn out, and in places only the upper part of its flank was seen. What hangs together from below
    LOWEST_OVERHEAD and is neither higher nor broader than vehicles may be is taken for one; a deck on a pier is not, for it is broader.

    Parameters
    ----------
    s, d, h : (N,) m, stations, offsets within the carriageway, and heights above its surface, VEHICLE_REACH beyond the stretch that is asked for

    Returns
    -------
    (N,) bool
    """
    from scipy.ndimage import binary_dilation, find_objects, label

    found = np.zeros(len(s), bool)
    standing = np.flatnonzero(h > STANDS_FROM)
    if not len(standing):
        return found
    s, d, h = s[standing], d[standing], h[standing]
    cells = tuple(np.floor((v - v.min()) / VEHICLE_CELL).astype(np.int64) for v in (s, d, h))
    filled = np.zeros([int(c.max()) + 1 for c in cells], bool)
    filled[cells] = True
    groups, count = label(binary_dilation(filled, np.ones([2 * reach + 1 for reach in LINKED_CELLS])), np.ones((3, 3, 3)))
    group = groups[cells]
    lowest, highest = np.full(count + 1, np.inf), np.full(count + 1, -np.inf)
    np.minimum.at(lowest, group, h)
    np.maximum.at(highest, group, h)
    breadth = np.array([0.0, *((across.stop - across.start - 2 * LINKED_CELLS[1]) * VEHICLE_CELL for _, across, _ in find_objects(groups))])
    vehicle = (lowest < LOWEST_OVERHEAD) & (highest < HIGHEST_VEHICLE) & (breadth < BROADEST_VEHICLE)
    found[standing] = vehicle[group]
    return found
