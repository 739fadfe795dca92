"""What lies behind a curb is no island: a sidewalk between two ramps is raised on both sides as an island is."""

from __future__ import annotations

import numpy as np

from .main_curbs import CurbLines
from .steps import PlanSteps

ROAD_WIDTH = 16.0     # m down from a step within which the first curb is looked for: two carriageways and a side street are no wider
PLACES = 5            # of a line from which it is looked for
OWN_CURB = 0.3        # m within which the line itself, or a double of it, is met


def lies_behind(line: PlanSteps, curbs: CurbLines) -> bool:
    """Does one who goes straight down from a line step off another curb before stepping up one?

    Parameters
    ----------
    line : N PlanSteps in order
    curbs : CurbLines

    Returns
    -------
    whether that holds at most places that meet a curb at all
    """
    ax, ay, sx, sy = curbs.segments_about(line.x, line.y, 2 * ROAD_WIDTH).T
    if not len(ax):
        return False
    off = []
    for k in np.unique(np.linspace(0, len(line) - 1, PLACES).round().astype(int)):
        rx, ry = -line.nx[k], -line.ny[k]
        dx, dy = ax - line.x[k], ay - line.y[k]
        # on the right of a segment is uphill, so where the cross product is negative the way across it leads down
        cross = rx * sy - ry * sx
        with np.errstate(divide="ignore", invalid="ignore"):
            away, share = (dx * sy - dy * sx) / cross, (dx * ry - dy * rx) / cross
        met = np.flatnonzero((away > OWN_CURB) & (away < ROAD_WIDTH) & (share >= 0.0) & (share <= 1.0))
        if len(met):
            off.append(cross[met[np.argmin(away[met])]] < 0.0)
    return bool(off) and float(np.mean(off)) > 0.5
