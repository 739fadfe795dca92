"""Points far from their fellows: statistical outlier removal, exactly as PCL defines it.

A point's mean distance to its k nearest neighbours is compared with the mean
and spread of that distance over all points, or over a window of the road: point
density falls with the distance from the scanner, and one limit for a whole
survey would eat the far paint.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import RoadExtractionError
from ..parallel import in_order
from ..progress import Progress
from ..survey.points import canonical_order
from ..survey.road_points import RoadPoints

SCOPES = ("all", "windows")
WINDOW = 20.0   # m of station that one limit is taken from
BAND = 3.0      # m of offset likewise
HALO = 2.0      # m of station beyond a window where neighbours are still looked for
FEWEST = 30     # points of a window that still have a spread worth the name


@dataclass(frozen=True)
class OutlierSettings:
    """How lonely a point may be.

    neighbours : k, how many neighbours the mean distance is taken over
    std_ratio : m, a point is removed beyond mean + m * standard deviation
    scope : "all" takes mean and deviation over the whole input (PCL),
        "windows" per 20 m of station and 3 m of offset
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


def mean_neighbour_distance(places, among, neighbours):
    """Mean distance of each place to its nearest others.

    Parameters
    ----------
    places : (N, 3) metres; every one is also in `among`
    among : (M, 3) metres, M >= N
    neighbours : k; fewer are used where `among` has no more

    Returns
    -------
    (N,) metres; inf where a place has no neighbour at all. The place itself is
    left out, a second point at the very same place is not (as in PCL).
    """
    k = min(neighbours, len(among) - 1)
    if k < 1 or not len(places):
        return np.full(len(places), np.inf)
    distances, _ = cKDTree(among).query(places, k + 1)
    return distances[:, 1:].mean(axis=1)


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
    for road in points.roads():
        if settings.scope == "all":
            continue
        start, end = points.store.span(road)
        windows = range(int(np.floor(start / WINDOW)), int(np.ceil(end / WINDOW)))
        for records in in_order(lambda k: _clean_window(points, road, k, settings), windows, progress):
            kept.store.append(road, records)
    if settings.scope == "all":
        _clean_all(points, kept, settings, progress)
    progress.say(f"{len(points) - len(kept):,} of {len(points):,} points lay apart from the others and were left out.")
    return kept


def _clean_window(points, road, number, settings):
    found = points.window(road, number * WINDOW - HALO, (number + 1) * WINDOW + HALO)
    s = found.s
    own = (s >= number * WINDOW) & (s < (number + 1) * WINDOW)
    if not own.any():
        return found.records[own]
    # Distances are summed in one order whatever the sections were
    records = found.records[canonical_order(found.records)]
    s = records["s"] * 1e-4
    own = (s >= number * WINDOW) & (s < (number + 1) * WINDOW)
    places = np.c_[records["x"], records["y"], records["z"]] * 1e-4
    distances = mean_neighbour_distance(places[own], places, settings.neighbours)
    records = records[own]
    band = np.floor(records["d"] * 1e-4 / BAND)
    keep = np.ones(len(records), bool)
    for value in np.unique(band):
        rows = np.flatnonzero(band == value)
        if len(rows) >= FEWEST:
            keep[rows] = within_spread(distances[rows], settings.std_ratio)
    return records[keep]


def _clean_all(points, kept, settings, progress):
    everything = points.all_points()
    roads = points.point_roads()
    order = canonical_order(everything.records)
    records, roads = everything.records[order], roads[order]
    places = np.c_[records["x"], records["y"], records["z"]] * 1e-4
    progress.at(0.1)
    keep = within_spread(mean_neighbour_distance(places, places, settings.neighbours), settings.std_ratio)
    for road in np.unique(roads[keep]):
        kept.store.append(int(road), records[keep & (roads == road)])
    progress.at(1.0)
