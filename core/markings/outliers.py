"""Statistical outlier removal: points far from their neighbours, as PCL defines it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..common.arrays import order_by
from ..common.errors import RoadExtractionError
from ..common.parallel import check_cancelled
from ..common.progress import Progress
from ..common.setting import check_limits, setting
from ..survey.store.records import COORDINATE_SCALE, take_rows
from ..survey.store.road_points import RoadPoints
from .weights import OUTLIERS

OUTLIER_SCOPES = ("all", "windows")
QUERIES_PER_BLOCK = 1 << 16       # cost: points asked for at a time: bounds the table of their neighbours


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


def remove_outliers(points: RoadPoints, settings: OutlierSettings = OutlierSettings(), progress: Progress = Progress()) -> RoadPoints:
    """Leave out points that lie apart from the others.

    Returns
    -------
    RoadPoints with the same columns and fewer points

    Notes
    -----
    d_i is the mean distance to the k nearest neighbours besides the point itself; the point goes if d_i > mu + m * sigma [1]_, sigma with n - 1.
    In windows with fewer than 30 points nothing is removed: their deviation is not reliable, and they are the worn and the far paint.

    References
    ----------
    .. [1] PCL 1.13, filters/impl/statistical_outlier_removal.hpp.
    """
    if not len(points):
        return points
    keys = list(points.all_sections())
    sections = [points.section(*key).records for key in keys]
    units = np.concatenate([np.stack([records[name] for name in "xyz"], axis=1) for records in sections])
    neighbours = Neighbours(units, settings.neighbours)
    distance = neighbours.distances(progress)
    windows = settings.scope == "windows"
    group, least = (_windows(keys, sections), OUTLIERS.min_points_per_band) if windows else (np.zeros(len(units), np.intp), 2)
    count = np.maximum(np.bincount(group), least)
    mean = np.bincount(group, distance) / count
    sigma = np.sqrt(np.bincount(group, (distance - mean[group]) ** 2) / (count - 1))
    apart = (distance > (mean + settings.std_ratio * sigma)[group]) & (np.bincount(group) >= least)[group]
    rows = np.flatnonzero(apart)
    if windows and len(rows):  # what stands as far apart as its neighbours do is worn or far paint
        apart[rows] = distance[rows] > OUTLIERS.sparseness_factor * np.median(distance[neighbours.of(rows)[1]], axis=1)
    kept, first = RoadPoints.empty_like(points), 0
    for key, records in zip(keys, sections):
        kept.store.put(*key, take_rows(records, ~apart[first:first + len(records)]))
        first += len(records)
    progress.info(f"Outliers: {len(points) - len(kept):,} of {len(points):,} points lay apart from the others and were left out.")
    return kept


def _windows(keys, sections):
    """(N,) number of the window of each point: 20 m of station and 3 m of offset of a road."""
    number = np.repeat([key[0] for key in keys], [len(records) for records in sections])
    for name, size in (("s", OUTLIERS.window), ("d", OUTLIERS.band)):
        part = np.concatenate([records[name] for records in sections]) // round(size / COORDINATE_SCALE)
        number = number * (np.ptp(part) + 1) + part - part.min()
    return np.unique(number, return_inverse=True)[1]


class Neighbours:
    """The k nearest others of points, exactly; of points at the very same place the tree holds no more than can be among the k nearest.

    A search would otherwise look at all of them, for each of them.

    Parameters
    ----------
    units : (N, 3) int32 of 0.1 mm
    k : neighbours; fewer where there are no more
    """

    def __init__(self, units: np.ndarray, k: int) -> None:
        self._k, self._units = max(min(k, len(units) - 1), 0), units
        self._rows = _in_tree(units, self._k)
        self._tree = cKDTree(units.take(self._rows, axis=0), balanced_tree=False) if self._k else None

    def of(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean distance of some points to their nearest others, and which these are.

        Returns
        -------
        distances : (M,) m; inf where a point has no neighbour at all. The point
            itself is left out, a second point at the very same place is not (as in PCL).
        nearest : (M, k) indices
        """
        if self._tree is None or not len(rows):
            return np.full(len(rows), np.inf), np.empty((len(rows), self._k), np.intp)
        distances, nearest = self._tree.query(self._units.take(rows, axis=0), self._k + 1, workers=-1)
        # each point is the first or, beside another at its place, one of the first of its own neighbours
        return distances.sum(axis=1) * (COORDINATE_SCALE / self._k), self._rows.take(nearest[:, 1:])

    def distances(self, progress: Progress = Progress()) -> np.ndarray:
        """(N,) m, the mean distance of every point to its nearest others."""
        means = np.empty(len(self._units))
        for first in range(0, len(means), QUERIES_PER_BLOCK):
            check_cancelled()
            rows = np.arange(first, min(first + QUERIES_PER_BLOCK, len(means)))
            means[rows] = self.of(rows)[0]
            progress.report(rows[-1] / len(means))
        return means


def _in_tree(units, k):
    """Indices of points, ascending: of each place the first k + 1."""
    order = order_by(*units.T[::-1])
    ordered = units.take(order, axis=0)
    number = np.arange(len(order))
    first = np.maximum.accumulate(np.where(np.r_[True, (ordered[1:] != ordered[:-1]).any(axis=1)][:len(order)], number, 0))
    return np.sort(order[number - first <= k])
