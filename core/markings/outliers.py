"""Statistical outlier removal: points far from their neighbours, as PCL defines it.

Neighbours are searched only for candidates: sums over the cells of a grid give an upper bound of
the mean distance to the nearest neighbours, and where it is below the limit a point is no outlier.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..common.arrays import order_by
from ..common.errors import RoadExtractionError
from ..common.parallel import ordered_map
from ..common.progress import Progress
from ..common.setting import check_limits, setting
from ..execution.phase import THREADS, Executor, NoSource, Phase
from ..lazy import cv2
from ..survey.store.columns import Columns
from ..survey.store.records import COORDINATE_SCALE, take_rows
from ..survey.store.road_points import RoadPoints

OUTLIER_SCOPES = ("all", "windows")
OUTLIER_WINDOW = 20.0     # m of station that one limit is taken from
OUTLIER_BAND = 3.0        # m of offset likewise
NEIGHBOUR_HALO = 2.0      # m of station beyond a window where neighbours are still looked for
MAX_LIMIT_SAMPLE = 1500   # points of a band from which its limit is taken; where there are twice as many, of an evenly spaced sample
MIN_POINTS_PER_BAND = 30  # points of a window whose deviation is still reliable
SPARSENESS_FACTOR = 3.0   # times the distance that is usual among a point's own neighbours
# Of the grid that gives the candidates
CELL_SIDE_FACTOR = 1.5     # times the usual distance: cells so large that three by three of them hold three times the neighbours asked for
NO_DISTANCE = 1e9          # m, where no distance is known
USUAL_DISTANCE_WINDOW = 9  # cells about a point: where others are looked at to tell what is usual there
COLUMNS = "s", "d", "x", "y", "z"   # that outliers are told by
TASK_WINDOWS = 5       # windows of 20 m that a worker process is given together
WINDOWS_AT_ONCE = 100      # windows whose columns are held at a time
MAX_CELLS_PER_POINT = 8    # for every point at most about so many, however near to each other rounded or repeated points lie


@dataclass(frozen=True)
class OutlierSettings:
    """How far a point may lie from its neighbours.

    neighbours : k, how many neighbours the mean distance is taken over
    std_ratio : m, a point is removed beyond mean + m * standard deviation
    scope : "all" takes mean and deviation over the whole input (PCL), "windows" per 20 m of station and 3 m of offset, and spares points whose
        neighbours stand as far apart as they do: worn and far paint
    """

    neighbours: int = setting(20, 1, 1000, "The number of neighbours")
    std_ratio: float = setting(1.0, 0.0, 20.0, "The standard deviation ratio")
    scope: str = "windows"

    def __post_init__(self) -> None:
        check_limits(self)
        if self.scope not in OUTLIER_SCOPES:
            raise RoadExtractionError(f"The scope {self.scope!r} is not known; use one of {', '.join(OUTLIER_SCOPES)}.")


def _within_spread(distances: np.ndarray, std_ratio: float) -> np.ndarray:
    """(N,) bool: mean distance at most mu + m * sigma, sigma with n - 1 as in PCL."""
    if len(distances) < 2:
        return np.ones(len(distances), bool)
    return ~(distances > distances.mean() + std_ratio * distances.std(ddof=1))


def remove_outliers(points: RoadPoints, settings: OutlierSettings = OutlierSettings(), progress: Progress = Progress(),
                    executor: Executor = THREADS) -> RoadPoints:
    """Leave out points that lie apart from the others; the columns stay.

    Notes
    -----
    d_i is the mean distance to the k nearest neighbours besides the point itself; the point goes if d_i > mu + m * sigma [1]_. In windows with
    fewer than 30 points nothing is removed: their deviation is not reliable, and they are the worn and the far paint. In windows with thousands of
    points mu and sigma are those of an evenly spaced sample, and neighbours are looked for only for candidates.

    References
    ----------
    .. [1] PCL 1.13, filters/impl/statistical_outlier_removal.hpp.
    """
    kept = RoadPoints.empty_like(points)
    if settings.scope == "all":
        _put(kept, points, _kept_of_all(points, settings, progress))
    else:
        windows = [(road, number) for road in points.roads() for start, end in [points.store.span(road)]
                   for number in range(int(np.floor(start / OUTLIER_WINDOW)), int(np.ceil(end / OUTLIER_WINDOW)))]
        together = TASK_WINDOWS if executor.folder is not None else 1
        phase = Phase(kept_of_windows, NoSource(), (settings,), lambda item: f"markings {item[0][0] * OUTLIER_WINDOW:.0f} m along a road")
        keep = [np.empty(0, bool)]
        for first in range(0, len(windows), WINDOWS_AT_ONCE):
            some = windows[first:first + WINDOWS_AT_ONCE]
            items = [[_columns_of(points, *window) for window in some[k:k + together]] for k in range(0, len(some), together)]
            part = progress.part(first / len(windows), min(first + WINDOWS_AT_ONCE, len(windows)) / len(windows))
            keep += [mask for found in executor.run(phase, items, part) for mask in found]
        _put(kept, points, np.concatenate(keep))
    progress.info(f"Outliers: {len(points) - len(kept):,} of {len(points):,} points lay apart from the others and were left out.")
    return kept


def _put(kept, points, keep):
    """The points of a mask, which goes through them road by road and by station."""
    first = 0
    for road, number in points.all_sections():
        records = points.section(road, number).records
        kept.store.put(road, number, take_rows(records, keep[first:first + len(records)]))
        first += len(records)


def _columns_of(points, road, number):
    """Number of a window, and the columns s, d, x, y, z of its points and those about it."""
    records = points.window(road, number * OUTLIER_WINDOW - NEIGHBOUR_HALO, (number + 1) * OUTLIER_WINDOW + NEIGHBOUR_HALO).records
    return number, [np.asarray(records[name]) for name in COLUMNS]


def kept_of_windows(source: NoSource, windows: Sequence[tuple[int, Sequence[np.ndarray]]], settings: OutlierSettings) -> list[np.ndarray]:
    """The phase that finds outliers.

    Parameters
    ----------
    windows : number of each and the columns s, d, x, y, z (0.1 mm) of its points and those about it

    Returns
    -------
    (N,) bool of each window, its own points that are kept
    """
    return [_kept_of_window(number, Columns(dict(zip(COLUMNS, columns)), [(name, one.dtype) for name, one in zip(COLUMNS, columns)]), settings)
            for number, columns in windows]


def _kept_of_window(number, records, settings):
    """(N,) bool of the points of a window, without those about it."""
    s = records["s"] * COORDINATE_SCALE
    own = np.flatnonzero((s >= number * OUTLIER_WINDOW) & (s < (number + 1) * OUTLIER_WINDOW))
    neighbours = _DistanceCache(Neighbours(_units(records), settings.neighbours))
    band = np.floor(records["d"].take(own) * COORDINATE_SCALE / OUTLIER_BAND)
    outliers = [np.empty(0, np.intp)]
    for value in np.unique(band):
        rows = own[band == value]
        if len(rows) >= MIN_POINTS_PER_BAND:
            outliers.append(_outliers_in_band(records, rows, neighbours, settings))
    outliers = np.concatenate(outliers)
    outliers = outliers[neighbours.distances(outliers) > SPARSENESS_FACTOR * _usual(neighbours, outliers)]
    keep = np.ones(len(own), bool)
    keep[np.searchsorted(own, outliers)] = False
    return keep


def _outliers_in_band(records, rows, neighbours, settings):
    """Those of some rows of a window, ascending, that lie beyond the spread of all of them."""
    sample = np.arange(0, len(rows), max(len(rows) // MAX_LIMIT_SAMPLE, 1))
    distances = neighbours.distances(rows[sample])
    limit = distances.mean() + settings.std_ratio * distances.std(ddof=1)
    if len(sample) < len(rows):
        # beside places of so many points some are far nearer to their neighbours than the evenly spaced ones show
        factor = SPARSENESS_FACTOR if neighbours.neighbours.most_at_place <= max(settings.neighbours // 2, 1) else 0.0
        rows = rows[outlier_candidates(records.take(rows), settings.neighbours, sample, distances, limit, factor)]
    return rows[neighbours.distances(rows) > limit]


class _DistanceCache:
    """Mean distances of rows to their neighbours, each asked for once."""

    def __init__(self, neighbours):
        self.neighbours = neighbours
        self._distances = np.full(len(neighbours), np.nan)

    def distances(self, rows):
        """(M,) metres of (M,) rows."""
        new = rows[np.isnan(self._distances[rows])]
        if len(new):
            self._distances[new] = self.neighbours.distances(new)[0]
        return self._distances[rows]


def _usual(neighbours, rows):
    """(M,) median of the distances of the neighbours of M rows."""
    nearest = neighbours.neighbours.of(rows)[2]
    others = np.unique(nearest)
    neighbours.distances(others)
    return np.median(neighbours.distances(nearest.ravel()).reshape(nearest.shape), axis=1)


def _kept_of_all(points, settings, progress):
    """(N,) bool of all points."""
    sections = [points.section(*key).records for key in points.all_sections()]
    units = np.concatenate([np.empty((0, 3), np.int32), *map(_units, sections)])
    return _within_spread(mean_distances(units, settings.neighbours, progress), settings.std_ratio)


def _units(records):
    return np.stack([records["x"], records["y"], records["z"]], axis=1)


def outlier_candidates(records: Columns, k: int, sample: np.ndarray, distances: np.ndarray, limit: float, factor: float) -> np.ndarray:
    """The points that may lie farther from their k nearest others than a limit, and than is usual about them by a factor.

    Parameters
    ----------
    records : Columns of N points
    k : neighbours
    sample : (M,) indices of points, evenly spaced
    distances : (M,) m, their mean distances to their k nearest others
    limit : m
    factor : times the least of the distances known in the decimetres about a point

    Returns
    -------
    ascending indices; of all other points it is certain that their mean distance is no more than the greater of both

    Notes
    -----
    The mean distance to the k nearest is at most that to any k others or more, and so at most
    the root of the mean square of these, which sums over cells give for every point::

        n |p|² - 2 p · sum(q) + sum(|q|²)

    This holds for cells of any size. They follow the usual distance down to a size that
    leaves no more than `MAX_CELLS_PER_POINT` of them for every point.
    """
    side = max(int(CELL_SIDE_FACTOR * np.median(distances) / COORDINATE_SCALE), _least_side(records["s"], records["d"]))
    (row, rows), (column, columns) = (_cells(records[name], side) for name in "sd")
    cell = row * np.int32(columns) + column
    places = [(records[name] - records[name][0]).astype(float) for name in "xyz"]
    own = sum(place * place for place in places)

    def about(values):
        sums = np.bincount(cell, values, rows * columns).reshape(rows, columns)
        return cv2.boxFilter(sums, -1, (3, 3), normalize=False, borderType=cv2.BORDER_CONSTANT).ravel().take(cell)

    count = about(None)
    squares = count * own + about(own)
    for place in places:
        squares -= 2.0 * place * about(place)
    usual = np.full((rows, columns), NO_DISTANCE, np.float32)
    farthest_first = np.argsort(-distances, kind="stable")
    usual.ravel()[cell[sample[farthest_first]]] = distances[farthest_first]
    window = np.ones((USUAL_DISTANCE_WINDOW, USUAL_DISTANCE_WINDOW), np.uint8)
    usual = cv2.erode(usual, window, borderType=cv2.BORDER_CONSTANT, borderValue=NO_DISTANCE).ravel().take(cell)
    most = np.maximum(np.where(usual < NO_DISTANCE, factor * usual, 0.0), limit) / COORDINATE_SCALE
    return np.flatnonzero((count <= k) | (squares > (count - 1) * most**2))


def _least_side(s, d):
    """The smallest side of cells, in units, of which there are at most about `MAX_CELLS_PER_POINT` for every point."""
    along, across = (int(units.max()) - int(units.min()) for units in (s, d))
    most = MAX_CELLS_PER_POINT * len(s)
    return max(math.ceil(math.sqrt(along * across / most)), math.ceil(max(along, across) / most), 1)


def _cells(units, side):
    """(N,) int32 number of the cell of each coordinate, from 0, and how many cells there are."""
    number = units // np.int32(side)
    number -= number.min()
    return number, int(number.max()) + 1


# The nearest neighbours of points, exactly, and the mean distance to them.

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
    The tree is OpenCV's exact one, which works in float32. Points are integers of 0.1 mm counted from their least, so up to 1.6 km nothing is
    rounded, and beyond it a slower tree in float64 is taken.

    Of points at the very same place the tree holds no more than can be among the k nearest: a search would otherwise look at all of them, for each
    of them.
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
