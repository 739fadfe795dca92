"""Statistical outlier removal: points far from their neighbours, as PCL defines it.

Neighbours are searched only for candidates: sums over the cells of a grid give an upper bound of
the mean distance to the nearest neighbours, and where it is below the limit a point is no outlier.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...execution.phase import THREADS, NoSource, Phase
from ...lazy import cv2
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, take_rows
from ...survey.store.road_points import RoadPoints
from .nearest_neighbours import Neighbours, mean_distances

if TYPE_CHECKING:
    from ...execution.phase import Executor

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
    scope : "all" takes mean and deviation over the whole input (PCL),
        "windows" per 20 m of station and 3 m of offset, and spares points whose
        neighbours stand as far apart as they do: worn and far paint
    """

    neighbours: int = setting(20, 1, 1000, "The number of neighbours")
    std_ratio: float = setting(1.0, 0.0, 20.0, "The standard deviation ratio")
    scope: str = "windows"

    def __post_init__(self) -> None:
        check_limits(self)
        if self.scope not in OUTLIER_SCOPES:
            raise RoadExtractionError(f"The scope {self.scope!r} is not known; use one of {', '.join(OUTLIER_SCOPES)}.")


def within_spread(distances: np.ndarray, std_ratio: float) -> np.ndarray:
    """(N,) bool: mean distance at most mu + m * sigma, sigma with n - 1 as in PCL."""
    if len(distances) < 2:
        return np.ones(len(distances), bool)
    return ~(distances > distances.mean() + std_ratio * distances.std(ddof=1))


def remove_outliers(points: RoadPoints, settings: OutlierSettings = OutlierSettings(), progress: Progress = Progress(),
                    executor: Executor = THREADS) -> RoadPoints:
    """Leave out points that lie apart from the others.

    Parameters
    ----------
    points : RoadPoints
    settings : OutlierSettings
    progress : Progress
    executor : who looks at windows

    Returns
    -------
    RoadPoints with the same columns and fewer points

    Notes
    -----
    d_i is the mean distance to the k nearest neighbours besides the point
    itself; the point goes if d_i > mu + m * sigma [1]_. In windows with fewer
    than 30 points nothing is removed: their deviation is not reliable, and they are
    the worn and the far paint. In windows with thousands of points mu and sigma are those of
    an evenly spaced sample, and neighbours are looked for only for candidates.

    References
    ----------
    .. [1] PCL 1.13, filters/impl/statistical_outlier_removal.hpp.
    """
    kept = RoadPoints.empty_like(points)
    if settings.scope == "all":
        _put(kept, points, _kept_of_all(points, settings, progress))
    else:
        windows = [(road, number) for road in points.roads() for number in _windows(*points.store.span(road))]
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


def _windows(start, end):
    return range(int(np.floor(start / OUTLIER_WINDOW)), int(np.ceil(end / OUTLIER_WINDOW)))


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
    source : NoSource
    windows : number of each and the columns s, d, x, y, z (0.1 mm) of its points and those about it
    settings : OutlierSettings

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
    return within_spread(mean_distances(units, settings.neighbours, progress), settings.std_ratio)


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
