"""The nearest neighbours of points, exactly, and the mean distance to them."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import order_by
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE

QUERY_PATCH_BITS = 11  # bits: points of one 0.2 m patch are asked for one after the other, in the processor's cache
TREE_LEAF_POINTS = 20  # points in a leaf of the tree
MAX_FLOAT32_UNITS = 1 << 24       # units (1.6 km): up to here float32 holds every integer
NEIGHBOUR_TILE_BITS = 18                 # bits: 26 m of map worked at together
NEIGHBOUR_TILE_MARGIN = 10_000           # units: 1 m about a tile where neighbours are looked for
MIN_COPIES_IN_TREE = 32                  # of points at one place are in a tree at least: more are left out where they cannot change a distance
QUERIES_PER_BLOCK = 1 << 16              # points asked for at a time where only their distances are wanted
HASH_MULTIPLIER = np.uint32(2654435761)  # an odd number that scatters places over a table


class Neighbours:
    """Asks some points for the k nearest others.

    Parameters
    ----------
    units : (N, 3) int32 of 0.1 mm
    k : neighbours; fewer where there are no more

    Attributes
    ----------
    most_at_place : int, the most points at one and the same place

    Notes
    -----
    The tree is OpenCV's exact one, which works in float32. Points are integers
    of 0.1 mm counted from their least, so up to 1.6 km nothing is rounded, and
    beyond it a slower tree in float64 is taken.

    Of points at the very same place the tree holds no more than can be among the k
    nearest: a search would otherwise look at all of them, for each of them.
    """

    def __init__(self, units: np.ndarray, k: int) -> None:
        self.k = max(min(k, len(units) - 1), 0)
        least = units.min(axis=0) if len(units) else 0
        self._units = units - least
        at_place = points_at_place(self._units)
        self.most_at_place = int(at_place[0].max(initial=0))
        self._rows = _without_needless(self._units, self.k, at_place)
        if self.k and self._units.max() < MAX_FLOAT32_UNITS:
            places = self._units if self._rows is None else self._units.take(self._rows, axis=0)
            self._places = places.astype(np.float32)  # the tree does not keep it alive
            self._tree = cv2.flann_Index(self._places, dict(algorithm=4, leaf_max_size=TREE_LEAF_POINTS))  # 4: one exact kd-tree

    def __len__(self):
        return len(self._units)

    def of(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Mean distance of some points to their nearest others, and who these are.

        Returns
        -------
        distances : (M,) metres; inf where a point has no neighbour at all. The point
            itself is left out, a second point at the very same place is not (as in PCL).
        farthest : (M,) metres, the distance to the last of them
        nearest : (M, k) int32
        """
        if not self.k:
            return np.full(len(rows), np.inf), np.full(len(rows), np.inf), np.empty((len(rows), 0), np.int32)
        if not len(rows):
            return np.empty(0), np.empty(0), np.empty((0, self.k), np.int32)
        x, y = (self._units[:, axis].take(rows) >> QUERY_PATCH_BITS for axis in (0, 1))
        order = order_by(y, x)
        nearest, distances = self._ask(rows.take(order))
        back = np.empty_like(order)
        back[order] = np.arange(len(order))
        # each point is the first or, beside another at its place, one of the first of its own neighbours
        means = distances.sum(axis=1, dtype=np.float64) * (COORDINATE_SCALE / self.k)
        return means.take(back), distances[:, -1].take(back) * COORDINATE_SCALE, nearest[:, 1:].take(back, axis=0)

    def distances(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean distance of some points to their nearest others, and the distance to the last of these, as in `of`: (M,) metres each."""
        means, farthest = np.empty(len(rows)), np.empty(len(rows))
        for first in range(0, len(rows), QUERIES_PER_BLOCK):
            some = slice(first, first + QUERIES_PER_BLOCK)
            means[some], farthest[some], _ = self.of(rows[some])
        return means, farthest

    def _ask(self, rows):
        asked = self._units.take(rows, axis=0)
        if self._units.max() < MAX_FLOAT32_UNITS:
            nearest, squares = self._tree.knnSearch(asked.astype(np.float32), self.k + 1, params={})
            distances = np.sqrt(squares, out=squares)
        else:
            places = self._units if self._rows is None else self._units.take(self._rows, axis=0)
            distances, nearest = cKDTree(places).query(asked, self.k + 1)
        nearest = nearest if self._rows is None else self._rows.take(nearest)
        return nearest.astype(np.int32, copy=False), distances


def points_at_place(units: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many points lie at the very place of each.

    Parameters
    ----------
    units : (N, 3) int32

    Returns
    -------
    count : (N,) int32
    rank : (N,) int32, how many of them come before the point
    """
    count, rank = np.ones(len(units), np.int32), np.zeros(len(units), np.int32)
    if not len(units):
        return count, rank
    cell = np.zeros(len(units), np.uint32)
    for axis in range(units.shape[1]):
        cell ^= units[:, axis].astype(np.uint32)
        cell *= HASH_MULTIPLIER
        cell ^= cell >> np.uint32(15)
    cell >>= np.uint32(max(32 - len(units).bit_length() - 2, 8))
    # only what shares a cell of the table can share a place
    rows = np.flatnonzero(np.bincount(cell).take(cell) > 1)
    if not len(rows):
        return count, rank
    order = rows.take(order_by(*(units[:, axis].take(rows) for axis in (2, 1, 0))))
    ordered = units.take(order, axis=0)
    first = np.flatnonzero(np.r_[True, (ordered[1:] != ordered[:-1]).any(axis=1)])
    size = np.diff(np.r_[first, len(order)])
    count[order] = np.repeat(size, size)
    rank[order] = np.arange(len(order)) - np.repeat(first, size)
    return count, rank


def _without_needless(units, k, at_place=None):
    """Indices of points, ascending: of each place the first k + 1, or a few more; None where these are all of them."""
    most = max(k + 1, MIN_COPIES_IN_TREE)
    count, rank = points_at_place(units) if at_place is None else at_place
    return np.flatnonzero(rank < most) if count.max(initial=0) > most else None


def mean_distances(units: np.ndarray, k: int, progress: Progress = Progress()) -> np.ndarray:
    """Mean distance of every point to its k nearest others, over any extent.

    Parameters
    ----------
    units : (N, 3) int32 of 0.1 mm
    k : neighbours, at least 1
    progress : Progress

    Returns
    -------
    (N,) metres; inf where there is no other point
    """
    k = min(k, len(units) - 1)
    if k < 1:
        return np.full(len(units), np.inf)
    means, unsettled = np.empty(len(units)), []
    tiles = list(_tiles(units))
    asked = ordered_map(lambda tile: Neighbours(units.take(tile[1], axis=0), k).distances(np.arange(tile[0])), tiles, progress)
    for (own, rows), (distances, farthest) in zip(tiles, asked):
        means[rows[:own]] = distances
        # beyond the margin there may be nearer ones
        unsettled.append(rows[:own][~(farthest <= NEIGHBOUR_TILE_MARGIN * COORDINATE_SCALE) | (len(rows) <= k)])
    unsettled = np.concatenate(unsettled)
    if len(unsettled):
        rows = _without_needless(units, k)
        tree = cKDTree(units if rows is None else units.take(rows, axis=0))
        means[unsettled] = tree.query(units[unsettled], k + 1)[0][:, 1:].mean(axis=1) * COORDINATE_SCALE
    return means


def _tiles(units):
    """Of each tile of the map, how many points it has, and the rows of these and of those within the margin about it."""
    x, y = (units[:, axis] - units[:, axis].min() for axis in (0, 1))
    column, row = x >> NEIGHBOUR_TILE_BITS, y >> NEIGHBOUR_TILE_BITS
    order = order_by(row, column)
    column, row = column[order], row[order]
    starts = np.flatnonzero(np.r_[True, (column[1:] != column[:-1]) | (row[1:] != row[:-1])])
    members = {(c, r): order[a:b] for c, r, a, b in zip(column[starts].tolist(), row[starts].tolist(), starts, [*starts[1:], len(order)])}
    for (c, r), own in members.items():
        parts = [own]
        for beside in ((c + i, r + j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j):
            rows = members.get(beside)
            if rows is not None:
                near = _within(x.take(rows), c) & _within(y.take(rows), r)
                parts.append(rows[near])
        yield len(own), np.concatenate(parts)


def _within(values, tile):
    return (values >= (tile << NEIGHBOUR_TILE_BITS) - NEIGHBOUR_TILE_MARGIN) & (values < (tile + 1 << NEIGHBOUR_TILE_BITS) + NEIGHBOUR_TILE_MARGIN)
