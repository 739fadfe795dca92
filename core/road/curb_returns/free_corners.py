"""Corners between two dropped crossings: nothing joins them to a curb, but they bend evenly from one curb end to another."""

from __future__ import annotations

import numpy as np

from .main_curbs import CurbLines
from .steps import PlanSteps

MAX_CROSSING_GAP = 8.0        # m of dropped curb between a corner and the curb that goes on
END_MARGIN = 0.01             # m, more than distances are rounded by
CORNER_RADII = (1.0, 25.0)    # m
MIN_CORNER_ANGLE = np.radians(15.0)   # that the seen part of a corner must turn
MAX_BEND_DEVIATION = 0.04     # m from its circle
POINTING_TOLERANCE = np.radians(12.0)   # by which a corner and a curb end may miss each other, besides the turn of the gap between them


def is_free_corner(own: PlanSteps, curbs: CurbLines) -> bool:
    """Does a line bend evenly about its uphill side, and point at the end of a curb both ways?

    Parameters
    ----------
    own : N PlanSteps in order
    curbs : CurbLines, the other curbs
    """
    if len(own) < 4 or not curbs.lines:
        return False
    # the circle of least squares (Kåsa)
    mx, my = own.x.mean(), own.y.mean()
    x, y = own.x - mx, own.y - my
    (cx, cy, c), *_ = np.linalg.lstsq(np.c_[2 * x, 2 * y, np.ones(len(x))], x * x + y * y, rcond=None)
    radius = float(np.sqrt(max(c + cx * cx + cy * cy, 0.0)))
    if not CORNER_RADII[0] <= radius <= CORNER_RADII[1]:
        return False
    off = np.abs(np.hypot(x - cx, y - cy) - radius)
    about = np.unwrap(np.arctan2(y - cy, x - cx))
    uphill = np.median((cx - x) * own.nx + (cy - y) * own.ny) > 0
    if off.max() > MAX_BEND_DEVIATION or abs(about[-1] - about[0]) < MIN_CORNER_ANGLE or not uphill:
        return False
    way = np.sign(about[-1] - about[0])
    for k, out in ((0, -way), (-1, way)):
        tip = np.array([own.x[k], own.y[k]])
        # along the circle, out of the line
        direction = out * np.array([-np.sin(about[k]), np.cos(about[k])])
        if not any(_points_at(tip, direction, end, radius, out) for end in curbs.ends_about(tip, MAX_CROSSING_GAP + END_MARGIN)):
            return False
    return True


def _points_at(tip, direction, end, radius, way):
    """Does a circle that leaves `tip` along `direction` lead to a curb's end, between straight on and bending on as before?"""
    gap = end[:2] - tip
    length = np.hypot(*gap)
    if not 1e-3 < length <= MAX_CROSSING_GAP:
        return False
    chord = np.arctan2(direction[0] * gap[1] - direction[1] * gap[0], direction @ gap)
    half = 0.5 * length / radius
    if not -POINTING_TOLERANCE <= way * chord <= half + POINTING_TOLERANCE:
        return False
    # seen from the curb's end, the corner lies ahead or to the side to which the corner bends
    back = np.arctan2(end[2] * -gap[1] - end[3] * -gap[0], end[2:] @ -gap)
    return bool(-POINTING_TOLERANCE <= -way * back <= half + POINTING_TOLERANCE)
