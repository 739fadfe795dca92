"""Rows of parking bays: narrow lines across the road, one beside the other at an even pace.

The lines between bays are as narrow as other lines and run across or askew, from the lane to the edge of the road (RMS part 1, parking
bays of 2.3 to 2.7 m, parallel ones of 5 to 7 m; MUTCD 3B.19). Joints of a road of concrete and bars that shake a driver lie across the lanes
that are driven, too. Rows are found by our own rule.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...common.arrays import linked_groups

if TYPE_CHECKING:
    from ..objects.marking_objects import MarkingObjects

WIDEST_BAY_LINE = 0.20   # m, of lines of usual breadth in all countries of the catalogue
LEAST_REACH = 1.2        # m across the road that is seen of a line: a parked car hides the rest
MAX_SKEW = 1.3           # m along the road for each metre across
BAY_PITCH = 2.0, 8.0     # m along the road from line to line
MAX_BAYS_HIDDEN = 3      # bays without a line between them, which cars hide
EVEN_PITCH = 0.12        # of the pitch, by which a line may lie off an even row
MIN_BAY_LINES = 4        # of a row
MIN_EVEN = 0.75          # of the steps of a row that are even
PIECES_OF_LINE = 0.5     # m along the road between pieces of one line at most
SHARED_REACH = 0.5       # of the shorter of two neighbours that lies beside the other


def rows_of_bays(markings: MarkingObjects, road: int, s: np.ndarray, driven: np.ndarray) -> list[np.ndarray]:
    """Rows of parking bays on one road.

    Parameters
    ----------
    markings : MarkingObjects
    road : number of the road
    s : (K,) metres, stations, increasing
    driven : (P, K) metres, offset of every pass at these, NaN where it did not drive

    Returns
    -------
    list of (n, 3) metres: station of the middle, least and greatest offset of the lines of each row, by station
    """
    rows = _rows(_lines_across(markings, road))
    crossed = [_driven_over(row, s, driven) for row in rows]
    return [row for row, over in zip(rows, crossed) if not over
            and not any(_beside(row, other) for other, driven_over in zip(rows, crossed) if driven_over)]


def _lines_across(markings, road):
    """(N, 3) station of the middle, least and greatest offset of narrow lines across the road; the parts of one marking are one."""
    here = np.flatnonzero((markings.road == road) & ~markings.keep & (markings.width <= WIDEST_BAY_LINE) & np.isfinite(markings.extent[:, 0]))
    if not len(here):
        return np.empty((0, 3))
    cluster = markings.cluster[here]
    _, of = np.unique(np.where(cluster >= 0, cluster, -2 - np.arange(len(here))), return_inverse=True)
    first, last, low, high = (pick(markings.extent[here, k], of) for k, pick in enumerate((_least, _greatest, _least, _greatest)))
    across = (high - low >= LEAST_REACH) & (last - first <= MAX_SKEW * (high - low) + WIDEST_BAY_LINE)
    lines = np.column_stack([(first + last) / 2, low, high])[across]
    return lines[np.argsort(lines[:, 0], kind="stable")]


def _least(values, of):
    found = np.full(of.max() + 1, np.inf)
    np.minimum.at(found, of, values)
    return found


def _greatest(values, of):
    return -_least(-values, of)


def _rows(lines):
    """Rows of lines that follow each other at an even pace: list of (n, 3), each by station."""
    station = lines[:, 0]
    low, high = np.searchsorted(station, station + BAY_PITCH[0]), np.searchsorted(station, station + BAY_PITCH[1], side="right")
    a = np.repeat(np.arange(len(lines)), high - low)
    b = np.arange(len(a)) - np.repeat(np.cumsum(high - low) - (high - low), high - low) + low[a]
    shared = np.minimum(lines[a, 2], lines[b, 2]) - np.maximum(lines[a, 1], lines[b, 1])
    linked = shared >= SHARED_REACH * np.minimum(lines[a, 2] - lines[a, 1], lines[b, 2] - lines[b, 1])
    group = linked_groups(a[linked], b[linked], len(lines))
    found = [_whole(lines[group == number]) for number in np.flatnonzero(np.bincount(group) >= MIN_BAY_LINES)]
    return [row for row in found if _even(row)]


def _whole(row):
    """The row with the pieces of each line, which lie at one station, put together."""
    start = np.flatnonzero(np.r_[True, np.diff(row[:, 0]) > PIECES_OF_LINE])
    return np.column_stack([np.add.reduceat(row[:, 0], start) / np.diff(np.r_[start, len(row)]), np.minimum.reduceat(row[:, 1], start),
                            np.maximum.reduceat(row[:, 2], start)])


def _even(row):
    if len(row) < MIN_BAY_LINES:
        return False
    steps = np.diff(row[:, 0])
    pitch = float(np.median(steps))
    times = np.clip(np.round(steps / pitch), 1, MAX_BAYS_HIDDEN)
    return np.mean(np.abs(steps - times * pitch) <= EVEN_PITCH * pitch) >= MIN_EVEN


def _driven_over(row, s, driven):
    """Whether a pass drove across the lines of a row."""
    at = np.clip(np.searchsorted(s, row[:, 0]), 0, len(s) - 1)
    with np.errstate(invalid="ignore"):
        return bool((((driven[:, at] > row[:, 1]) & (driven[:, at] < row[:, 2])).mean(axis=1) > 0.5).any())


def _beside(row, other):
    """Whether two rows lie at the same stations."""
    return min(row[-1, 0], other[-1, 0]) > max(row[0, 0], other[0, 0])
