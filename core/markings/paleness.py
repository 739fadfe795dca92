"""What is far paler than the paint about it: sealed seams, joints of bridges, gutters of islands.

Concrete and bitumen that shine a little more than asphalt pass a threshold that worn
paint must pass, too. But worn paint is bright where any of it is left: the best
quarter of a marking comes near to that of its neighbours, that of a seam does not.
"""

import numpy as np

from ..survey.points import UNIT

STRETCH = 100.0        # m of road, with as much before and after it, whose paint is compared
FAINTEST, BRIGHT = 2, 90   # % of the bright points there: what only just was one, and paint
BEST = 75              # % of a marking's points, whose brightness stands for it
PALE, PALE_BAR = 0.20, 0.30  # of the way from one to the other: less is no paint, nor is a bar across the road, a joint as a rule
PALE_EDGE = 0.10       # the same of a line where edge lines lie, which wear most and where seams are rare


def too_pale(share, kind):
    """Whether a cluster of such a contrast is no paint, by the class that its shape has."""
    return share < {"stop": PALE_BAR, "edge": PALE_EDGE}.get(kind, PALE)


def contrast(value, s, starts):
    """How bright clusters are among the bright points of their road.

    Parameters
    ----------
    value : (N,) brightness of points, cluster after cluster
    s : (N,) their stations, units of 0.1 mm
    starts : (K + 1,) where the clusters begin and the last one ends

    Returns
    -------
    (K,) 0 for what only just is brighter than asphalt, 1 for bright paint
    """
    value, stretch = value[:starts[-1]], np.floor_divide(s[:starts[-1]], int(STRETCH / UNIT))
    if not len(value):
        return np.empty(0)
    order = np.argsort(stretch, kind="stable")
    first, last = int(stretch.min()), int(stretch.max())
    bounds = np.searchsorted(stretch[order], np.arange(first - 1, last + 3))
    ends = np.array([np.percentile(value[order[a:b]], [FAINTEST, BRIGHT]) if b > a else (0.0, 1.0)
                     for a, b in zip(bounds[:-3], bounds[3:])])
    low, high = ends[stretch - first].T
    share = (value - low) / np.maximum(high - low, 1e-6)
    return np.array([np.percentile(share[a:b], BEST) for a, b in zip(starts[:-1], starts[1:])])
