"""Markings that touch taken apart: a stop line that runs into an edge line is two markings.

A cluster joins whatever touches. Where it holds a strip that runs on along the
road and something else beside it, the strip is cut free, so that the line keeps its
width and the rest its shape.
"""

import numpy as np
from scipy.ndimage import binary_closing, binary_dilation, binary_opening
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..survey.points import UNIT
from .shapes import CELL

LEAST_ALONG, LEAST_ACROSS = 5.0, 0.9  # m: arrows, letters and single dashes are smaller and stay whole
RUN = 1.0          # m along the road that a strip does not break off; stop lines and hatching bars are shorter
SCAN_GAP = 0.40    # m between scan lines, closed
CHUNK = 100.0      # m of road looked at together
SMALLEST = 0.05    # m2: smaller left-overs are the frayed rim of the strip


def split_compounds(records, labels):
    """Give the parts of compound clusters labels of their own.

    Parameters
    ----------
    records : (N,) ROAD_POINT of one road
    labels : (N,) int, the cluster of each

    Returns
    -------
    (N,) int labels; those of clusters that are not compound are unchanged
    """
    if not len(labels):
        return labels
    labels = labels.copy()
    order = np.argsort(labels, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(labels[order]) != 0])
    following = int(labels.max()) + 1
    for a, b in zip(starts, np.r_[starts[1:], len(order)]):
        rows = order[a:b]
        s, d = records["s"][rows], records["d"][rows]
        if (s.max() - s.min()) * UNIT < LEAST_ALONG or (d.max() - d.min()) * UNIT < LEAST_ACROSS:
            continue
        cells, member = np.unique(np.c_[s // CELL, d // CELL].astype(np.int64), axis=0, return_inverse=True)
        parts, count = _parts(cells)
        if count > 1:
            labels[rows] = following + parts[member]
            following += count
    return labels


def _parts(cells):
    """(K,) the part of every cell, numbered from 0, and how many parts there are."""
    size = CELL * UNIT
    along = _in_long_runs(cells)
    strips = _linked(cells[along], SCAN_GAP / size, 1.0)
    count = strips.max(initial=-1) + 1
    first, last = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(first, strips, cells[along, 0])
    np.maximum.at(last, strips, cells[along, 0])
    long = (last - first) * size >= LEAST_ALONG
    if not long.any():
        return np.zeros(len(cells), np.int64), 1
    parts = np.full(len(cells), -1)
    number = np.where(long, np.cumsum(long) - 1, -1)
    parts[along] = number[strips]
    rest = np.flatnonzero(parts < 0)
    pieces = _linked(cells[rest], SCAN_GAP / size, 3.0)
    areas = np.bincount(pieces) * size**2 if len(pieces) else np.empty(0)
    kept = areas >= SMALLEST
    later = np.where(kept, long.sum() + np.cumsum(kept) - 1, -1)
    parts[rest] = later[pieces]
    lost = parts < 0
    if lost.any():
        owned = np.flatnonzero(~lost)
        parts[lost] = parts[owned[cKDTree(cells[owned]).query(cells[lost])[1]]]
    return parts, int(long.sum() + kept.sum())


def _in_long_runs(cells):
    """(K,) whether a cell lies in a run of paint along the road of at least RUN."""
    size = CELL * UNIT
    gap, run, chunk = int(SCAN_GAP / size), int(RUN / size), int(CHUNK / size)
    halo = 2 * (gap + run)
    result = np.zeros(len(cells), bool)
    numbers = np.floor_divide(cells[:, 0], chunk)
    for number in np.unique(numbers):
        first, last = number * chunk - halo, (number + 1) * chunk + halo
        rows = np.flatnonzero((cells[:, 0] >= first) & (cells[:, 0] < last))
        column, row = cells[rows, 0] - first, cells[rows, 1] - cells[rows, 1].min() + 1
        mask = np.zeros((row.max() + 2, last - first), bool)
        mask[row, column] = True
        # a line may leave its row of cells by one: the road's frame is not the paint's
        joined = binary_dilation(binary_closing(mask, np.ones((1, gap + 1), bool)), np.ones((3, 1), bool))
        runs = binary_opening(joined, np.ones((1, run), bool))
        own = numbers[rows] == number
        result[rows[own]] = runs[row[own], column[own]]
    return result


def _linked(cells, along, across):
    """Connected components of cells no farther apart than `along` and `across` cells."""
    if not len(cells):
        return np.empty(0, np.int64)
    pairs = cKDTree(cells / [along, across]).query_pairs(1.0, p=np.inf, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(len(cells), len(cells)))
    return connected_components(graph, directed=False)[1].astype(np.int64)
