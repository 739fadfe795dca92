"""Points far from their fellows: statistical outlier removal, exactly as PCL defines it.

A point's mean distance to its k nearest neighbours is compared with the mean
and spread of that distance over all points, as PCL does. Point density falls
with the distance from the scanner and paint is worn in places, and one limit for
a whole survey eats both: by windows, a point must also be lonelier than its own
neighbours are.
"""

from dataclasses import dataclass

import numpy as np

from ..errors import RoadExtractionError
from ..parallel import in_order
from ..progress import Progress
from ..setting import check_limits, setting
from ..survey.points import UNIT, chosen
from ..survey.road_points import RoadPoints
from .crowds import may_be_lonely
from .neighbours import Neighbours, mean_distances

SCOPES = ("all", "windows")
WINDOW = 20.0   # m of station that one limit is taken from
BAND = 3.0      # m of offset likewise
HALO = 2.0      # m of station beyond a window where neighbours are still looked for
MOST = 1500     # points of a band from which its limit is taken; where there are twice as many, of evenly strewn ones
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

    neighbours: int = setting(20, 1, 1000, "The number of neighbours")
    std_ratio: float = setting(1.0, 0.0, 20.0, "The standard deviation ratio")
    scope: str = "windows"

    def __post_init__(self):
        check_limits(self)
        if self.scope not in SCOPES:
            raise RoadExtractionError(f"The scope {self.scope!r} is not known; use one of {', '.join(SCOPES)}.")


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
    the worn and the far paint. In windows with thousands of points mu and sigma are those of
    an evenly strewn share, and neighbours are looked for only where cells do not tell
    that a point has enough of them near by.

    References
    ----------
    .. [1] PCL 1.13, filters/impl/statistical_outlier_removal.hpp.
    """
    kept = RoadPoints.empty_like(points)
    if settings.scope == "all":
        _put(kept, points, _kept_of_all(points, settings, progress))
    else:
        windows = [(road, number) for road in points.roads() for number in _windows(*points.store.span(road))]
        keep = list(in_order(lambda window: _kept_of_window(points, *window, settings), windows, progress))
        _put(kept, points, np.concatenate([np.empty(0, bool), *keep]))
    progress.say(f"Outliers: {len(points) - len(kept):,} of {len(points):,} points lay apart from the others and were left out.")
    return kept


def _windows(start, end):
    return range(int(np.floor(start / WINDOW)), int(np.ceil(end / WINDOW)))


def _put(kept, points, keep):
    """The points of a mask, which goes through them road by road and by station."""
    first = 0
    for road, number in points.all_sections():
        records = points.section(road, number).records
        kept.store.put(road, number, chosen(records, keep[first:first + len(records)]))
        first += len(records)


def _kept_of_window(points, road, number, settings):
    """(N,) bool of the points of a window, without those about it."""
    records = points.window(road, number * WINDOW - HALO, (number + 1) * WINDOW + HALO).records
    s = records["s"] * UNIT
    own = np.flatnonzero((s >= number * WINDOW) & (s < (number + 1) * WINDOW))
    neighbours = _Known(Neighbours(_units(records), settings.neighbours))
    band = np.floor(records["d"].take(own) * UNIT / BAND)
    lonely = [np.empty(0, np.intp)]
    for value in np.unique(band):
        rows = own[band == value]
        if len(rows) >= FEWEST:
            lonely.append(_lonely(records, rows, neighbours, settings))
    lonely = np.concatenate(lonely)
    lonely = lonely[neighbours.distances(lonely) > LONELIER * _usual(neighbours, lonely)]
    keep = np.ones(len(own), bool)
    keep[np.searchsorted(own, lonely)] = False
    return keep


def _lonely(records, rows, neighbours, settings):
    """Those of some rows of a window, ascending, that lie beyond the spread of all of them."""
    looked = np.arange(0, len(rows), max(len(rows) // MOST, 1))
    distances = neighbours.distances(rows[looked])
    limit = distances.mean() + settings.std_ratio * distances.std(ddof=1)
    if len(looked) < len(rows):
        # beside places of so many points some are far nearer to their neighbours than the evenly strewn ones show
        lonelier = LONELIER if neighbours.neighbours.most_at_place <= max(settings.neighbours // 2, 1) else 0.0
        rows = rows[may_be_lonely(records.take(rows), settings.neighbours, looked, distances, limit, lonelier)]
    return rows[neighbours.distances(rows) > limit]


class _Known:
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
