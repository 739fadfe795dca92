"""Road beneath something that stands on it or hangs over it: parked cars, tables, bushes.

Laser pulses reach some of the road beneath and beside a parked car, where metal
shines on it and its shadow falls. Such points are of the road, but what they
look like is not the road's own.
"""

import numpy as np
from scipy import ndimage

from ..survey.points import UNIT

LOW, HIGH = 0.25, 2.0   # m above the road: curbs and stray points end below, signs and branches begin above
SQUARE = 0.20           # m
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
    size = int(round(SQUARE / UNIT))
    (row, column), (high_row, high_column) = ((points.records["s"] // size, points.records["d"] // size) for points in (road_points, above))
    first = min(row.min(), high_row.min()) - 1, min(column.min(), high_column.min()) - 1
    shape = max(row.max(), high_row.max()) - first[0] + 2, max(column.max(), high_column.max()) - first[1] + 2
    place, high_place = ((r - first[0]) * shape[1] + (c - first[1]) for r, c in ((row, column), (high_row, high_column)))
    road, high = (ndimage.uniform_filter(np.bincount(p, minlength=shape[0] * shape[1]).reshape(shape).astype(float), 3, mode="constant")
                  for p in (place, high_place))
    # means of whole numbers over nine squares: exact enough to be compared
    return np.rint(9 * high).ravel()[place] > SHARE * np.rint(9 * (road + high)).ravel()[place]
