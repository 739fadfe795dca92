"""Points far from their fellows: statistical outlier removal, exactly as PCL defines it.

A point's mean distance to its k nearest neighbours is compared with the mean
and spread of that distance over all points, as PCL does. Point density falls
with the distance from the scanner and paint is worn in places, and one limit for
a whole survey eats both: by windows, a point must also be lonelier than its own
neighbours are.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import RoadExtractionError
from ..parallel import in_order
from ..progress import Progress
from ..survey.points import UNIT, canonical_order, chosen
from ..survey.road_points import RoadPoints

SCOPES = ("all", "windows")
WINDOW = 20.0   # m of station that one limit is taken from
BAND = 3.0      # m of offset likewise
HALO = 2.0      # m of station beyond a window where neighbours are still looked for
AT_ONCE = 50_000  # points asked for their neighbours at a time
FEWEST = 30     # points of a window that still have a spread worth the name
LONELIER = 3.0  # times the distance that is usual among a point's own neighbours


@dataclass(frozen=True)
class OutlierSettings:
    """How lonely a point may be.

    neighbours : k, how many neighbours the mean distance is taken over
    std_ratio : m, a point is removed beyond mean + m * standard deviation
    scope : "all" takes mean and deviation over the whole input (PCL),
        "windows" per 20 m of station and 3 m of offset, and spares points whose
        neighbours stand as far apart as they do: worn and far paint
    """

    neighbours: int = 20
    std_ratio: float = 1.0
    scope: str = "windows"

    def __post_init__(self):
        if self.neighbours < 1:
            raise RoadExtractionError(f"Outliers are judged by {self.neighbours} neighbours; at least 1 is needed.")
        if self.std_ratio < 0:
            raise RoadExtractionError(f"The standard deviation ratio is {self.std_ratio}; it must be 0 or more.")
        if self.scope not in SCOPES:
            raise RoadExtractionError(f"The scope {self.scope!r} is not known; use one of {', '.join(SCOPES)}.")


def neighbour_distances(places, neighbours):
    """Mean distance of each place to its nearest others, and who these are.

    Parameters
    ----------
    places : (N, 3) metres
    neighbours : k; fewer are used where there are no more

    Returns
    -------
    distances : (N,) metres; inf where a place has no neighbour at all. The place
        itself is left out, a second point at the very same place is not (as in PCL).
    nearest : (N, k) int
    """
    k = min(neighbours, len(places) - 1)
    if k < 1:
        return np.full(len(places), np.inf), np.empty((len(places), 0), np.int64)
    distances, nearest = _tree(places).query(places, k + 1)
    return distances[:, 1:].mean(axis=1), nearest[:, 1:]


def within_spread(distances, std_ratio):
    """(N,) bool: mean distance at most mu + m * sigma, sigma with n - 1 as in PCL."""
    if len(distances) < 2:
        return np.ones(len(distances), bool)
    return ~(distances > distances.mean() + std_ratio * distances.std(ddof=1))


def remove_outliers(points, settings=OutlierSettings(), progress=Progress()):
    """Leave out points that lie apart from the others.

    Parameters
    ----------
    points : RoadPoints

    Returns
    -------
    RoadPoints with the same columns and fewer points

    Notes
    -----
    d_i is the mean distance to the k nearest neighbours besides the point
    itself; the point goes if d_i > mu + m * sigma [1]_. In windows with fewer
    than 30 points nothing is removed: their spread says nothing, and they are
    the worn and the far paint.

    References
    ----------
    .. [1] PCL 1.13, filters/impl/statistical_outlier_removal.hpp.
    """
    kept = RoadPoints.empty_like(points)
    if settings.scope == "all":
        _clean_all(points, kept, settings, progress)
    else:
        windows = [(road, number) for road in points.roads() for number in _windows(*points.store.span(road))]
        cleaned = in_order(lambda window: _clean_window(points, *window, settings), windows, progress)
        for (road, _), records in zip(windows, cleaned):
            kept.store.append(road, records)
    progress.say(f"Outliers: {len(points) - len(kept):,} of {len(points):,} points lay apart from the others and were left out.")
    return kept


def _windows(start, end):
    return range(int(np.floor(start / WINDOW)), int(np.ceil(end / WINDOW)))


def _clean_window(points, road, number, settings):
    records = points.window(road, number * WINDOW - HALO, (number + 1) * WINDOW + HALO).records
    s = records["s"] * UNIT
    own = (s >= number * WINDOW) & (s < (number + 1) * WINDOW)
    if not own.any():
        return records[own]
    distances, nearest = neighbour_distances(_places(records), settings.neighbours)
    usual = np.median(distances[nearest], axis=1) if nearest.shape[1] else np.zeros(len(records))
    band = np.floor(records["d"] * UNIT / BAND)
    keep = own.copy()
    for value in np.unique(band[own]):
        rows = np.flatnonzero(own & (band == value))
        if len(rows) >= FEWEST:
            keep[rows] = within_spread(distances[rows], settings.std_ratio) | (distances[rows] <= LONELIER * usual[rows])
    return chosen(records, keep)


def _clean_all(points, kept, settings, progress):
    records, roads = points.all_points().records, points.point_roads()
    order = canonical_order(records)
    records, roads = records[order], roads[order]
    keep = within_spread(_all_distances(_places(records), settings.neighbours, progress), settings.std_ratio)
    for road in np.unique(roads[keep]):
        kept.store.append(int(road), records[keep & (roads == road)])
    progress.at(1.0)


def _all_distances(places, neighbours, progress):
    """The distances of `neighbour_distances`, some points at a time, so that a cancel is heard."""
    k = min(neighbours, len(places) - 1)
    if k < 1:
        return np.full(len(places), np.inf)
    tree = _tree(places)
    progress.at(0.1)
    parts = [places[first:first + AT_ONCE] for first in range(0, len(places), AT_ONCE)]
    found = in_order(lambda part: tree.query(part, k + 1)[0][:, 1:].mean(axis=1), parts, progress.part(0.1, 1.0))
    return np.concatenate(list(found))


def _tree(places):
    # splits in the middle of a cell are made quicker than splits at the median, and found as quickly
    return cKDTree(places, balanced_tree=False, compact_nodes=False)


def _places(records):
    return np.c_[records["x"], records["y"], records["z"]] * UNIT
