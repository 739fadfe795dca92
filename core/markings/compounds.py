"""Markings that touch taken apart: a stop line that runs into an edge line is two markings.

A cluster joins whatever touches. Where it holds a strip that runs on along the
road, or a bar that runs on across it, and something else beside it, the two are cut
free, so that the line keeps its width and the rest its shape.
"""

import cv2
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..survey.points import UNIT
from ..survey.sorting import order_by
from .cells import occupied
from .shapes import CELL

LEAST_ALONG = 5.0  # m of a strip
LONG, BROADER = 9.0, 0.5  # m: no arrow or letter is so long; a line that is broader somewhere has something beside it
RUN = 1.0          # m along the road that a strip does not break off; stop lines and hatching bars are shorter
BAR = 2.0          # m across the road that a bar does not break off; no arrow or letter is as broad
LEAST_BESIDE = 1.0  # m along the road: what is shorter is nothing but a bar
PAINT_GAP = 0.24   # m across the road, closed; the stripes of a zebra crossing leave more
SCAN_GAP = 0.40    # m between scan lines, closed
CHUNK = 100.0      # m of road looked at together
SMALLEST = 0.05    # m2: smaller left-overs are the frayed rim of the strip


def split_compounds(records, labels):
    """Give the parts of compound clusters labels of their own.

    Parameters
    ----------
    records : N points of one road
    labels : (N,) int, the cluster of each

    Returns
    -------
    (N,) int labels; those of clusters that are not compound are unchanged
    """
    if not len(labels):
        return labels
    labels = labels.copy()
    order = order_by(labels)
    starts = np.flatnonzero(np.r_[True, np.diff(labels[order]) != 0])
    following = int(labels.max()) + 1
    along, across = records["s"].take(order), records["d"].take(order)
    ranges = [np.maximum.reduceat(values, starts).astype(np.int64) - np.minimum.reduceat(values, starts) for values in (along, across)]
    large = (ranges[0] * UNIT >= LONG) & (ranges[1] * UNIT >= BROADER) \
        | (ranges[0] * UNIT >= LEAST_BESIDE) & (ranges[1] * UNIT >= BAR)
    for a, b in zip(starts[large], np.r_[starts[1:], len(order)][large]):
        rows = order[a:b]
        cells, member = occupied(along[a:b] // CELL, across[a:b] // CELL)
        parts, count = _parts(cells)
        if count > 1:
            labels[rows] = following + parts[member]
            following += count
    return labels


def _parts(cells):
    """(K,) the part of every cell, numbered from 0, and how many parts there are."""
    size = CELL * UNIT
    parts, every = np.full(len(cells), -1), np.arange(len(cells))
    count = _number_strips(parts, 0, cells, every[_in_runs(cells, SCAN_GAP, RUN)], SCAN_GAP, size, LEAST_ALONG)
    rest, turned = np.flatnonzero(parts < 0), cells[:, ::-1]
    # scan lines lie apart within a bar
    count = _number_strips(parts, count, turned, rest[_in_runs(turned[rest], PAINT_GAP, BAR)], PAINT_GAP, SCAN_GAP, BAR)
    if not count:
        return np.zeros(len(cells), np.int64), 1
    rest = np.flatnonzero(parts < 0)
    pieces = _linked(cells[rest], SCAN_GAP / size, 3.0)
    areas = np.bincount(pieces) * size**2 if len(pieces) else np.empty(0)
    kept = areas >= SMALLEST
    later = np.where(kept, count + np.cumsum(kept) - 1, -1)
    parts[rest] = later[pieces]
    lost = parts < 0
    if lost.any():
        owned = np.flatnonzero(~lost)
        parts[lost] = parts[owned[cKDTree(cells[owned]).query(cells[lost])[1]]]
    return parts, int(count + kept.sum())


def _number_strips(parts, count, cells, rows, gap, gap_across, least):
    """Number in `parts` the strips that the cells `rows` make, from `count` on; returns the next number.

    cells : (K, 2) along the strips and across them; gap, gap_across : m between cells of one; least : m, its length
    """
    size = CELL * UNIT
    strips = _linked(cells[rows], gap / size, gap_across / size)
    number = strips.max(initial=-1) + 1
    first, last = np.full(number, np.inf), np.full(number, -np.inf)
    np.minimum.at(first, strips, cells[rows, 0])
    np.maximum.at(last, strips, cells[rows, 0])
    long = (last - first) * size >= least
    parts[rows] = np.where(long, count + np.cumsum(long) - 1, -1)[strips]
    return count + int(long.sum())


def _in_runs(cells, longest_gap, shortest_run):
    """(K,) whether a cell lies in a run of paint along the first axis; gaps are closed."""
    if not len(cells):
        return np.zeros(0, bool)
    size = CELL * UNIT
    # OpenCV moves what an even number of cells closes or opens
    gap, run, chunk = round(longest_gap / size) // 2 * 2, round(shortest_run / size) | 1, int(CHUNK / size)
    halo = 2 * (gap + run)
    result = np.zeros(len(cells), bool)
    numbers = np.floor_divide(cells[:, 0], chunk)
    for number in np.unique(numbers):
        first, last = number * chunk - halo, (number + 1) * chunk + halo
        rows = np.flatnonzero((cells[:, 0] >= first) & (cells[:, 0] < last))
        column, row = cells[rows, 0] - first, cells[rows, 1] - cells[rows, 1].min() + 1
        mask = np.zeros((row.max() + 2, last - first), np.uint8)
        mask[row, column] = 1
        # a line may leave its row of cells by one: the road's frame is not the paint's
        joined = cv2.dilate(cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((1, gap + 1), np.uint8)), np.ones((3, 1), np.uint8))
        runs = cv2.morphologyEx(joined, cv2.MORPH_OPEN, np.ones((1, run), np.uint8))
        own = numbers[rows] == number
        result[rows[own]] = runs[row[own], column[own]] > 0
    return result


def _linked(cells, along, across):
    """Connected components of cells no farther apart than `along` and `across` cells."""
    if not len(cells):
        return np.empty(0, np.int64)
    pairs = cKDTree(cells / [along, across]).query_pairs(1.0, p=np.inf, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(len(cells), len(cells)))
    return connected_components(graph, directed=False)[1].astype(np.int64)
