"""Pieces of one marking that wear has parted: lines along the road, stop lines across it, the stripes of a crossing.

No gap within a marking is painted shorter than these are, so that what lies so near and in
line was one. Pieces are measured in the road frame; joining looks at where they begin and end.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .classes import STRIPE_WIDTH, columns_of, zebra_stripes
from .near_pairs import near_pairs

WORN_GAP, OVERLAP, SAME_LINE = 0.9, 0.2, 0.08  # m along, along, across
BAR_THICK = 0.18, 0.90   # m along the road of a stop line's pieces
BAR_PIECE, BAR_GAP = 0.8, 0.30  # m across: a row of shorter blocks is a give-way line, and its gaps are painted
STRIPE_PIECE, STRIPE_GAP = 0.8, 0.7  # m along the road: what a stripe of a crossing has left at least, and what wear takes of it
SAME_SIDES = 0.10        # m by which wear has moved an edge that two pieces share


def join_fragments(shapes, max_width):
    """Which pieces continue each other over a worn spot.

    Parameters
    ----------
    shapes : list of N Shape
    max_width : m, a line's

    Returns
    -------
    (N,) int, the same number for pieces of one marking

    Notes
    -----
    Narrow pieces along the road are joined where one begins up to 0.9 m after the end of
    another on the same line; pieces of a bar across the road over 0.3 m where their
    front and rear are the same; what is left of the stripes of a
    crossing over 0.7 m within their sides.
    """
    if len(shapes) < 2:
        return np.arange(len(shapes))
    column = columns_of(shapes)
    pairs = np.concatenate([_along(shapes, max_width), _bars(column), _stripes(column)])
    graph = coo_matrix((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(len(shapes),) * 2)
    return connected_components(graph, directed=False)[1]


def _along(shapes, max_width):
    """(P, 2) narrow pieces, the second of which goes on where the first ends."""
    narrow = np.array([k for k, shape in enumerate(shapes) if _narrow(shape, max_width)], np.int64)
    if len(narrow) < 2:
        return np.empty((0, 2), np.int64)
    begins = np.array([(shapes[k].s0, shapes[k].begin) for k in narrow])
    ends = np.array([(shapes[k].s1, shapes[k].finish) for k in narrow])
    # a box of -0.2 to 0.9 m along and 8 cm either way across about each end
    scale = np.array([(WORN_GAP + OVERLAP) / 2, SAME_LINE])
    about = (ends + np.array([(WORN_GAP - OVERLAP) / 2, 0.0])) / scale
    near = cKDTree(begins / scale).query_ball_point(about, 1.0, p=np.inf)
    pairs = np.array([(a, b) for a, found in enumerate(near) for b in found if a != b], np.int64).reshape(-1, 2)
    return narrow[pairs]


def _narrow(shape, max_width):
    return shape.width <= max_width and shape.along or shape.d1 - shape.d0 <= max_width


def _bars(column):
    """(P, 2) neighbouring pieces of bars across the road."""
    s0, s1, d0, d1 = (column[name] for name in ("s0", "s1", "d0", "d1"))
    thick, broad = s1 - s0, d1 - d0
    rows = np.flatnonzero((thick >= BAR_THICK[0]) & (thick <= BAR_THICK[1]) & (broad >= BAR_GAP))
    if len(rows) < 2:
        return np.empty((0, 2), np.int64)
    # nearly the same front and rear
    pairs = cKDTree(np.column_stack([s0, s1])[rows]).query_pairs(SAME_SIDES, p=np.inf, output_type="ndarray").reshape(-1, 2)
    a, b = rows[pairs].T
    gap = np.maximum(d0[a], d0[b]) - np.minimum(d1[a], d1[b])
    return np.column_stack([a, b])[(gap <= BAR_GAP) & (np.maximum(broad[a], broad[b]) >= BAR_PIECE)]


def _stripes(column):
    """(P, 2) the stripes of a crossing, and what lies before or after them between their sides."""
    s0, s1, d0, d1 = (column[name] for name in ("s0", "s1", "d0", "d1"))
    # of a stripe askew the sides are not those of its box
    stripes = np.flatnonzero(zebra_stripes(column, STRIPE_PIECE) & (d1 - d0 <= STRIPE_WIDTH[1]))
    found = [np.empty((0, 2), np.int64)]
    for a, b in near_pairs(s0[stripes], s1[stripes], s0, s1, STRIPE_GAP):
        a = stripes[a]
        inside = (b != a) & (s1[b] >= s0[a] - STRIPE_GAP) & (s0[b] < s1[a] + STRIPE_GAP) \
            & (d0[b] >= d0[a] - SAME_SIDES / 2) & (d1[b] <= d1[a] + SAME_SIDES / 2)
        found.append(np.column_stack([a, b])[inside])
    return np.concatenate(found)
