"""Zigzag lines: no stopping before a pedestrian crossing or at a bus stop.

A zigzag line runs along the road and turns back again and again: straight legs of one length and one slope, to the left and to the
right in turns. Nothing else on a road does so three times. Dimensions:

- Germany, Zeichen 299: narrow lines at 50 gon (45 degrees) to the road, 1 to 2 m from side to side (RMS part 2, chapter 4.2.1).
- United Kingdom, diagram 1001.3: marks of 2 m, at least 1 m, gaps of 150 mm, 1.979 m along the road and so 0.29 m across it, up to 18
  of them (Traffic Signs Manual, chapter 5, 15.17, 2003).
"""

from __future__ import annotations

import numpy as np

from ..road_grid import CELL_SIZE

STEP_CELLS = 3              # cells along the road whose middle is one place: 12 cm
ZIGZAG_LENGTH = 2.0, 45.0     # m along the road: three legs of the shortest, and "school keep clear"
ZIGZAG_BREADTH = 0.25, 2.6         # m across it
MAX_STROKE = 0.50           # m across the road of a leg within a step: a line of 0.12 m at 45 degrees takes up 0.29 m
MIN_STEPS_SEEN = 0.7        # of the steps, for the run to be known: gaps between marks are 150 mm
MIN_THIN = 0.85             # of the steps that were seen, where there is one stroke alone; a bar may end the line
LEAST_TURN = 0.15           # m that a line goes back for its turn to count: half the depth of the flattest zigzag
MIN_LEGS = 3
LEG_ALONG = 0.7, 2.6        # m along the road of a whole leg
LEG_SLOPE = 0.10, 1.4       # m across per m along
MAX_SLOPE_RATIO = 1.6       # times: one leg to another
MAX_LENGTH_RATIO = 1.5      # times, of those between turns
MAX_OFF_STRAIGHT = 0.12     # of a leg's depth that its places lie off it at most, root mean square, or
LEAST_OFF_STRAIGHT = 0.05   # m


def zigzag_legs(cells: np.ndarray) -> int:
    """How many legs a zigzag line has.

    Parameters
    ----------
    cells : (K, 2) int, painted cells along the road and across it

    Returns
    -------
    int, 0 where the cells are no zigzag line
    """
    step = (cells[:, 0] - cells[:, 0].min()) // STEP_CELLS
    length, breadth = (np.ptp(cells, axis=0) + 1) * CELL_SIZE
    if not (ZIGZAG_LENGTH[0] <= length <= ZIGZAG_LENGTH[1] and ZIGZAG_BREADTH[0] <= breadth <= ZIGZAG_BREADTH[1]):
        return 0
    count = np.bincount(step)
    seen = count > 0
    if seen.mean() < MIN_STEPS_SEEN:
        return 0
    low, high = np.full(len(count), np.inf), np.full(len(count), -np.inf)
    np.minimum.at(low, step, cells[:, 1])
    np.maximum.at(high, step, cells[:, 1])
    thin = seen & (high - low < MAX_STROKE / CELL_SIZE)
    if np.count_nonzero(thin) < MIN_THIN * np.count_nonzero(seen):
        return 0
    rows = np.flatnonzero(thin)
    along, across = (rows + 0.5) * STEP_CELLS * CELL_SIZE, (low[rows] + high[rows]) / 2 * CELL_SIZE
    return _legs(along, across)


def _legs(along, across):
    ends = _turns(across)
    if len(ends) <= MIN_LEGS:
        return 0
    runs, rises, off = [], [], []
    for first, last in zip(ends[:-1], ends[1:]):
        u, v = along[first:last + 1], across[first:last + 1]
        if len(u) < 3:
            return 0
        slope, middle = np.polyfit(u - u.mean(), v, 1)
        runs.append(u[-1] - u[0])
        rises.append(slope)
        off.append(np.sqrt(np.mean((v - middle - slope * (u - u.mean())) ** 2)))
    runs, rises, off = np.array(runs), np.array(rises), np.array(off)
    # what is left of a leg at either end may be short
    whole = np.r_[runs[0] >= LEG_ALONG[0], np.ones(max(len(runs) - 2, 0), bool), runs[-1] >= LEG_ALONG[0]]
    if np.count_nonzero(whole) < MIN_LEGS or (np.sign(rises[:-1]) == np.sign(rises[1:])).any():
        return 0
    inner, slopes = runs[1:-1], np.abs(rises[whole])
    even = inner.min() >= LEG_ALONG[0] and runs.max() <= LEG_ALONG[1] and inner.max() <= MAX_LENGTH_RATIO * inner.min() \
        and runs.max() <= MAX_LENGTH_RATIO * inner.max()
    steep = LEG_SLOPE[0] <= slopes.min() and slopes.max() <= LEG_SLOPE[1] and slopes.max() <= MAX_SLOPE_RATIO * slopes.min()
    straight = (off[whole] <= np.maximum(MAX_OFF_STRAIGHT * slopes * runs[whole], LEAST_OFF_STRAIGHT)).all()
    return int(np.count_nonzero(whole)) if even and steep and straight else 0


def _turns(across):
    """Places where a run turns back by at least `LEAST_TURN`, and its extremes before the first turn and after the last."""
    found, best, way = [], 0, 0
    lowest = highest = 0
    for k, value in enumerate(across.tolist()):
        if way == 0:
            lowest = k if value < across[lowest] else lowest
            highest = k if value > across[highest] else highest
            if across[highest] - across[lowest] >= LEAST_TURN:
                way, best = (1, k) if highest > lowest else (-1, k)
                found.append(lowest if way > 0 else highest)
        elif way * (value - across[best]) >= 0:
            best = k
        elif way * (across[best] - value) >= LEAST_TURN:
            found.append(best)
            best, way = k, -way
    return [*found, best]
