"""The true parallel of a curve or of a traced line."""

import numpy as np


def parallel_places(curve, distance, step=0.5):
    """Places at a constant distance beside a curve.

    The parallel of a line is a line and of a circle a circle (`Arc.parallel` gives
    it); that of any other curve is no curve of its kind, so the exact parallel
    p + n d is sampled.

    Parameters
    ----------
    curve : Curve
    distance : metres, left positive
    step : largest distance between places along the curve, metres

    Returns
    -------
    (M, 2) places in the curve's direction; where the curve is tighter than the
    distance on its inner side the parallel would turn back, and those are left out.
    """
    u = np.linspace(0.0, curve.length, max(2, int(np.ceil(curve.length / step - 1e-9)) + 1))
    heading = curve.heading(u)
    places = curve.at(u) + distance * np.c_[-np.sin(heading), np.cos(heading)]
    return places[curve.curvature(u) * distance < 1.0 - 1e-9]


def parallel_of_line(x, y, distance):
    """The same for a line given by places: each moved along the normal of the polyline.

    Parameters
    ----------
    x, y : (N,) metres, N >= 2, ordered
    distance : metres, left positive; a number or (N,)

    Returns
    -------
    (N, 2) places; those that would turn back on the inner side of a bend are NaN.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    u = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    if len(x) < 2 or u[-1] == 0:
        raise ValueError("a parallel needs at least two different places")
    dx, dy = (np.gradient(v, u) if len(x) > 2 else np.diff(v).repeat(2) for v in (x, y))
    size = np.hypot(dx, dy)
    distance = np.broadcast_to(np.asarray(distance, float), x.shape)
    moved = np.c_[x - distance * dy / size, y + distance * dx / size]
    back = (np.gradient(moved[:, 0]) * dx + np.gradient(moved[:, 1]) * dy) <= 0
    if len(x) > 2:
        # an end knows its normal from one side only; it goes with its neighbour
        back[0], back[-1] = back[0] or back[1], back[-1] or back[-2]
    moved[back] = np.nan
    return moved
