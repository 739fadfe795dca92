"""The stripes of zebra crossings: bars of one width side by side at an even pitch, in whatever direction they point.

Those of the driven road point along it. Those of a side street point along that street, which may be any way. Bars of
hatching are parallel, too, but they lie askew to their row, which runs along the road.
"""

from __future__ import annotations

import numpy as np

from ...common.groups import linked_groups
from .near_pairs import overlapping_pairs
from .shape import MAX_ANGLE_ALONG

STRIPE_WIDTH = (0.25, 0.80)  # m
STRIPE_LENGTH = (1.5, 10.0)  # m
STRIPE_PITCH = (0.5, 1.6)    # m from stripe to stripe
MIN_STRIPES = 3
MAX_STRIPE_SKEW, MAX_STRIPE_TURN = np.radians((35.0, 8.0))  # of stripes along the road to it, and of stripes to each other
MAX_ROW_SKEW = np.radians(15.0)   # of stripes in any direction to the square of their row: bars of hatching are more askew
MAX_STRIPE_WIDTH_RATIO = 1.6      # times: one stripe to the next, of those in any direction


def zebra_stripes(column: dict[str, np.ndarray], shortest: float = STRIPE_LENGTH[0]) -> np.ndarray:
    """Bars side by side at an even pitch, at least three of them.

    Parameters
    ----------
    column : dict of (N,) of the Shapes
    shortest : m

    Returns
    -------
    (N,) bool
    """
    stripe = (column["width"] >= STRIPE_WIDTH[0]) & (column["width"] <= STRIPE_WIDTH[1]) \
        & (column["length"] >= shortest) & (column["length"] <= STRIPE_LENGTH[1])
    rows = np.flatnonzero(stripe)
    result = np.zeros(len(stripe), bool)
    if len(rows) < MIN_STRIPES:
        return result
    s, d = ((column[low][rows] + column[high][rows]) / 2 for low, high in (("s0", "s1"), ("d0", "d1")))
    heading, length, width = (column[name][rows] for name in ("direction", "length", "width"))
    beside = [np.empty((0, 2), np.intp)]
    for a, b in overlapping_pairs(s, s, s, s, np.hypot(STRIPE_LENGTH[1], STRIPE_PITCH[1])):
        ds, dd = s[b] - s[a], d[b] - d[a]
        # a bar points either way
        turn = (heading[b] - heading[a] + np.pi / 2) % np.pi - np.pi / 2
        middle = (heading[a] + turn / 2 + np.pi / 2) % np.pi - np.pi / 2
        # on a crossing askew each stripe begins somewhat farther than the one before
        ahead, pitch = np.abs(ds * np.cos(middle) + dd * np.sin(middle)), np.abs(dd * np.cos(middle) - ds * np.sin(middle))
        shared = (length[b] + length[a]) / 2 - ahead > 0.5 * np.minimum(length[b], length[a])
        # the bars of hatching follow each other along the road
        along = (np.maximum(np.abs(heading[a]), np.abs(heading[b])) <= MAX_STRIPE_SKEW) \
            & ((np.abs(dd) > np.abs(ds)) | (np.abs(middle) <= MAX_ANGLE_ALONG))
        square = (ahead <= np.tan(MAX_ROW_SKEW) * pitch) \
            & (np.maximum(width[a], width[b]) <= MAX_STRIPE_WIDTH_RATIO * np.minimum(width[a], width[b]))
        found = shared & (along | square) & (np.abs(turn) <= MAX_STRIPE_TURN) & (pitch >= STRIPE_PITCH[0]) & (pitch <= STRIPE_PITCH[1])
        beside.append(np.column_stack([a, b])[found])
    pairs = np.concatenate(beside)
    group = linked_groups(pairs[:, 0], pairs[:, 1], len(rows))
    result[rows] = np.bincount(group)[group] >= MIN_STRIPES
    return result
