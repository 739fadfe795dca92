"""Road beneath something that stands on it or hangs over it: parked cars, tables, bushes.

Laser pulses reach some of the road beneath and beside a parked car, where metal
shines on it and its shadow falls. Such points are of the road, but what they
look like is not the road's own.
"""

import numpy as np
from scipy import ndimage

from ...survey.points import UNIT

LOW, HIGH = 0.25, 2.0   # m above the road: curbs and stray points end below, signs and branches begin above
SQUARE = 0.20           # m
AT_ONCE = 1 << 15       # points worked at a time: what fits the processor's cache
SHARE = 1 / 3           # of all points within a square and those about it


def covered(road_points, above):
    """Which road points lie beneath or right beside something.

    Parameters
    ----------
    road_points, above : Points of the road and of what is LOW to HIGH above it,
        a square farther along the road either way than is asked about

    Returns
    -------
    (N,) bool, one for each road point
    """
    if not len(above) or not len(road_points):
        return np.zeros(len(road_points), bool)
    places, high_places, shape = _squares(road_points.records, above.records)
    road, high = (ndimage.uniform_filter(np.bincount(p, minlength=shape[0] * shape[1]).reshape(shape).astype(float), 3, mode="constant")
                  for p in (places, high_places))
    # means of whole numbers over nine squares: exact enough to be compared
    dark = np.rint(9 * high) > SHARE * np.rint(9 * (road + high))
    return dark.ravel().take(places) if dark.any() else np.zeros(len(road_points), bool)


def _squares(*points):
    """(N,) int32 number of the square that each point of several sets lies in, and the (rows, columns) of all squares."""
    size = np.int32(round(SQUARE / UNIT))
    low = [min(int(records[name].min()) for records in points) // size - 1 for name in ("s", "d")]
    shape = tuple(max(int(records[name].max()) for records in points) // size - first + 2 for name, first in zip(("s", "d"), low))
    found = []
    for records in points:
        place = np.empty(len(records), np.int32)
        for first in range(0, len(place), AT_ONCE):
            run = place[first:first + AT_ONCE]
            np.floor_divide(records["s"][first:first + AT_ONCE], size, out=run)
            run -= np.int32(low[0])
            run *= np.int32(shape[1])
            run += records["d"][first:first + AT_ONCE] // size
            run -= np.int32(low[1])
        found.append(place)
    return *found, shape
