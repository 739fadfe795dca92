"""Whether the result of an earlier stage belongs to the road frame it is given with.

Stations count from where a trajectory's road begins, so with another trajectory,
or another cut of the same one, every station of a file points somewhere else.
"""

import numpy as np

from ..common.errors import RoadExtractionError

STATION_TOLERANCE = 1.0    # m that a station may be off: far more than rounding, far less than another drive
CHECKED_SECTIONS, CHECKED_POINTS_PER_SECTION = 50, 200  # that are looked at, spread over the file


def check_features_on_roads(features, frame, label):
    """Refuse features whose `station_m` is not where they lie on the frame's roads.

    Raises
    ------
    RoadExtractionError
        If that is so for more than half of them.
    """
    import shapely

    agree = [_station_agrees(frame, row["road"], *shapely.get_coordinates(geometry).T[:2], row.get("station_m"))
             for geometry, row in features if row.get("station_m") is not None]
    _refuse_mismatch(agree, label, "features")


def check_road_points_on_roads(road_points, frame, label):
    """The same for road points: a sample of them, spread over their sections."""
    agree = [np.abs(_stations(frame, road, x, y) - s) <= STATION_TOLERANCE for road, x, y, s in sample_road_points(road_points)]
    _refuse_mismatch(np.concatenate(agree) if agree else [], label, "points looked at")


def sample_road_points(road_points):
    """Some points of every few sections, so that a file is judged quickly: yields road, x, y (map coordinates) and station."""
    keys = road_points.all_sections()
    for k in np.unique(np.linspace(0, len(keys) - 1, CHECKED_SECTIONS).astype(int)) if keys else ():
        road, number = keys[k]
        points = road_points.section(road, number)
        rows = np.unique(np.linspace(0, len(points) - 1, CHECKED_POINTS_PER_SECTION).astype(int))
        yield road, points.x[rows] + road_points.origin[0], points.y[rows] + road_points.origin[1], points.s[rows]


def _station_agrees(frame, road, x, y, station):
    """Whether the stations of a feature's vertices reach the one it carries."""
    s = _stations(frame, road, x, y)
    s = s[np.isfinite(s)]
    return len(s) > 0 and s.min() - STATION_TOLERANCE <= station <= s.max() + STATION_TOLERANCE


def _stations(frame, road, x, y):
    """(N,) stations of map coordinates on a road; NaN beside it, and where there is no such road."""
    if road is None or not 0 <= road < len(frame.roads):
        return np.full(len(x), np.nan)
    return frame.road(road).locate(*frame.to_local(x, y))[0]


def _refuse_mismatch(agree, label, what):
    agree = np.asarray(agree, bool)
    if len(agree) and agree.mean() < 0.5:
        raise RoadExtractionError(
            f"{label} and the trajectory do not belong together: only {np.count_nonzero(agree)} of {len(agree)} {what} lie "
            "at the station they carry. Give the trajectory that they were made with, whole.")
