"""Statistical outlier removal: points far from their neighbours, as PCL defines it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ..common.arrays import order_by
from ..common.parallel import check_cancelled
from ..common.progress import Progress
from ..common.setting import Limited, choice, setting
from ..execution.phase import THREADS, Executor, Phase
from ..lazy import cv2
from ..survey.store.records import COORDINATE_SCALE
from ..survey.store.road_points import RoadPoints
from ..survey.store.section_store import SectionStore, StoreIndex, Stretch
from .weights import OUTLIERS

NEIGHBOUR_HALO = 2.0      # cost: m of station beyond a window where neighbours are still looked for
MAX_LIMIT_SAMPLE = 1500   # cost: points of a band from which its limit is taken; where there are twice as many, of an evenly spaced sample
TASK_WINDOWS = 5       # cost: windows of 20 m that are looked at together
TREE_LEAF_POINTS = 20      # cost: points in a leaf of the tree
MAX_FLOAT32_UNITS = 1 << 24       # derived: units (1.6 km): up to here float32 holds every integer
QUERIES_PER_BLOCK = 1 << 16       # cost: points asked for at a time: bounds the table of their neighbours


@dataclass(frozen=True)
class OutlierSettings(Limited):
    """How far a point may lie from its neighbours.

    neighbours : k, how many neighbours the mean distance is taken over
    std_ratio : m, a point is removed beyond mean + m * standard deviation
    scope : "all" takes mean and deviation over the whole input (PCL), "windows" per 20 m of station and 3 m of offset, and spares points whose
        neighbours stand as far apart as they do: worn and far paint
    """

    neighbours: int = setting(20, 1, 1000, "The number of neighbours")
    std_ratio: float = setting(1.0, 0.0, 20.0, "The standard deviation ratio")
    scope: str = choice("windows", ("all", "windows"), "The scope of outliers")


def remove_outliers(points: RoadPoints, settings: OutlierSettings = OutlierSettings(), progress: Progress = Progress(),
                    executor: Executor = THREADS) -> RoadPoints:
    """Leave out points that lie apart from the others.

    executor : who looks at windows

    Returns RoadPoints with the same columns and fewer points

    d_i is the mean distance to the k nearest neighbours besides the point itself; the point goes if d_i > mu + m * sigma [1]_. In windows with fewer
    than 30 points nothing is removed: their deviation is not reliable, and they are the worn and the far paint. In windows with thousands of points
    mu and sigma are those of an evenly spaced sample.

    .. [1] PCL 1.13, filters/impl/statistical_outlier_removal.hpp.
    """
    executor = points.store.readers(executor)
    store = points.store
    kept = replace(RoadPoints.empty_like(points), store=SectionStore(store.dtype, store.section_length, store.folder, store.constants))
    if settings.scope == "all":
        sections = {key: points.section(*key).records for key in points.all_sections()}
        keep = np.split(_kept_of_all([*sections.values()], settings), np.cumsum([*map(len, sections.values())])[:-1])
        for (key, records), mask in zip(sections.items(), keep):
            kept.store.put(*key, records[mask])
    else:
        size, length = max(int(TASK_WINDOWS * OUTLIERS.window / points.store.section_length), 1), points.store.section_length
        stretches = [(road, list(numbers)) for road in points.roads() for _, numbers in groupby(sorted(points.sections(road)), lambda n: n // size)]
        items = [(road, numbers[0], numbers[-1] + 1) for road, numbers in stretches]

        def state(item):
            windows = _windows(item[1] * length, item[2] * length)
            return points.state(item[0], windows[0] * OUTLIERS.window - NEIGHBOUR_HALO, (windows[-1] + 1) * OUTLIERS.window + NEIGHBOUR_HALO)

        phase = Phase(kept_of_windows, points.store, (settings,), lambda item: f"markings {item[1] * length:.0f} m along road {item[0]}", state=state)
        for index in executor.run(phase, items, progress):
            kept.store.adopt(index, store.folder)
    progress.info(f"Outliers: {len(points) - len(kept):,} of {len(points):,} points lay apart from the others and were left out.")
    return kept


def _windows(start, end):
    return range(int(np.floor(start / OUTLIERS.window)), int(np.ceil(end / OUTLIERS.window)))


def kept_of_windows(store: SectionStore, item: Stretch, settings: OutlierSettings) -> StoreIndex:
    """The phase that finds outliers, window by window; returns where the points of the sections of a stretch lie that stay."""
    road, *ends = item
    windows = _windows(*(end * store.section_length for end in ends))
    keep = np.concatenate([_kept_of_window(store, road, number, settings) for number in windows])
    s = store.window(road, windows[0] * OUTLIERS.window, (windows[-1] + 1) * OUTLIERS.window).records["s"]
    with store.part() as part:
        for key in store.in_stretch(item):
            first, end = np.searchsorted(s, [store.first_unit(key[1]), store.first_unit(key[1] + 1)])
            part.put(*key, store.section(*key)[keep[first:end]])
    return part.index()


def _kept_of_window(store, road, number, settings):
    """(N,) bool of the points of a window, without those about it."""
    records = store.window(road, number * OUTLIERS.window - NEIGHBOUR_HALO, (number + 1) * OUTLIERS.window + NEIGHBOUR_HALO).records
    s = records["s"] * COORDINATE_SCALE
    inner = np.flatnonzero((s >= number * OUTLIERS.window) & (s < (number + 1) * OUTLIERS.window))
    neighbours = Neighbours(_units(records), settings.neighbours)
    band = np.floor(records["d"].take(inner) * COORDINATE_SCALE / OUTLIERS.band)
    outliers = [np.empty(0, np.intp)]
    for value in np.unique(band):
        rows = inner[band == value]
        if len(rows) >= OUTLIERS.min_points_per_band:
            distance = neighbours.distances(rows)
            sample = distance[::max(len(rows) // MAX_LIMIT_SAMPLE, 1)]
            outliers.append(rows[distance > sample.mean() + settings.std_ratio * sample.std(ddof=1)])
    outliers = np.concatenate(outliers)
    if len(outliers):  # what stands as far apart as its neighbours do is worn or far paint
        usual = np.median(neighbours.distances(neighbours.nearest(outliers)), axis=1)
        outliers = outliers[neighbours.distances(outliers) > OUTLIERS.sparseness_factor * usual]
    keep = np.ones(len(inner), bool)
    keep[np.searchsorted(inner, outliers)] = False
    return keep


def _kept_of_all(sections, settings):
    """(N,) bool of the records of all sections: mean distance at most mu + m * sigma, sigma with n - 1 as in PCL."""
    units = np.concatenate([np.empty((0, 3), np.int32), *map(_units, sections)])
    if len(units) < 2:
        return np.ones(len(units), bool)
    distance = Neighbours(units, settings.neighbours).distances(np.arange(len(units)))
    return ~(distance > distance.mean() + settings.std_ratio * distance.std(ddof=1))


def _units(records):
    return np.stack([records["x"], records["y"], records["z"]], axis=1)


class Neighbours:
    """The k nearest others of points, exactly.

    units : (N, 3) int32 of 0.1 mm
    k : neighbours; fewer where there are no more

    The tree is OpenCV's exact one, which works in float32. Points are integers of 0.1 mm counted from their
    least, so up to 1.6 km nothing is rounded, and beyond it a slower tree in float64 is taken. Of points at the very same place
    the tree holds no more than can be among the k nearest: a search would otherwise look at all of them, for each of them.
    """

    def __init__(self, units: np.ndarray, k: int) -> None:
        self._k = max(min(k, len(units) - 1), 0)
        self._units = units - (units.min(axis=0) if len(units) else 0)
        self._rows = _in_tree(self._units, self._k)
        self._means = np.full(len(units), np.nan if self._k else np.inf)   # NaN where they are not known yet
        self._tree: Any = None
        if self._k:
            coordinates = self._units.take(self._rows, axis=0)
            if self._units.max() < MAX_FLOAT32_UNITS:
                self._places = coordinates.astype(np.float32)  # the tree does not keep it alive
                self._tree = cv2.flann_Index(self._places, dict(algorithm=4, leaf_max_size=TREE_LEAF_POINTS))  # 4: one exact kd-tree
            else:
                self._tree = cKDTree(coordinates)

    def _search(self, rows):
        """Distances, in units, of some points to the nearest in the tree and rows of these there, (M, k + 1) each.

        Each point is the first or, beside another at its place, one of the first of its own neighbours.
        """
        queries = self._units.take(rows, axis=0)
        if isinstance(self._tree, cKDTree):
            return self._tree.query(queries, self._k + 1)
        nearest, squares = self._tree.knnSearch(queries.astype(np.float32), self._k + 1, params={})
        return np.sqrt(squares), nearest

    def nearest(self, rows: np.ndarray) -> np.ndarray:
        """(M, k) indices of the nearest others of some points."""
        return self._rows.take(self._search(rows)[1][:, 1:]) if self._k and len(rows) else np.empty((len(rows), self._k), np.intp)

    def distances(self, rows: np.ndarray) -> np.ndarray:
        """m, the mean distance of some points to their nearest others, which is looked for once; of the shape of `rows`.

        It is inf where a point has no neighbour at all. The point itself is left out, a second point at the very same place is not (as in PCL).
        """
        unknown = np.zeros(len(self._means), bool)
        unknown[rows] = True
        unknown = np.flatnonzero(unknown & np.isnan(self._means))
        for first in range(0, len(unknown), QUERIES_PER_BLOCK):
            check_cancelled()
            asked = unknown[first:first + QUERIES_PER_BLOCK]
            self._means[asked] = self._search(asked)[0].sum(axis=1, dtype=np.float64) * (COORDINATE_SCALE / self._k)
        return self._means.take(rows)


def _in_tree(units, k):
    """Indices of points, ascending: of each place the first k + 1."""
    order = order_by(*units.T[::-1])
    ordered = units.take(order, axis=0)
    number = np.arange(len(order))
    first = np.maximum.accumulate(np.where(np.r_[True, (ordered[1:] != ordered[:-1]).any(axis=1)][:len(order)], number, 0))
    return np.sort(order[number - first <= k])
