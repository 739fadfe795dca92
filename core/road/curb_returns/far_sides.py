"""Far sides of islands: an island hides the foot of its own far curb, but the edge of its top is seen.

Behind a step, the raised ground of an island ends where nothing is seen for a few decimetres, and what is seen then is as low as the
road. The curb stands upright beneath the outermost points of the top.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .ground.behind import GroundBehind
from .ground_raster import GroundRaster
from .steps import PlanSteps, line_directions, points_about

EDGE_REACH = 0.25             # m either way of the last raised cell within which the edge of the top lies
EDGE_HALF_LENGTH = 0.15       # m either way along the edge of the points that show it
MIN_EDGE_POINTS = 4           # of the top
MAX_EDGE_SPACING = 0.15       # m across between points of the top: the edge lies up to that much beyond the outermost
SPACING_DEPTH = 0.40          # m of the top from its edge inward in which that is looked for
MIN_TOP_SHARE = 0.6           # share of the height of the island's near side that its top has
SEEN_STEP_DISTANCE = 0.4      # m from a step that was seen, within which nothing is hidden
MIN_ISLAND_WIDTH = 0.4        # m


def far_sides(raster: GroundRaster, steps: PlanSteps, behind: GroundBehind) -> PlanSteps:
    """Steps of the far sides of islands that are hidden by the islands themselves.

    Parameters
    ----------
    raster : GroundRaster
    steps : M PlanSteps, among them those of the near sides
    behind : GroundBehind of the M steps

    Returns
    -------
    PlanSteps, at most one for each of the M; the bottom is where the plane of the road before the near side goes on
    """
    near = np.flatnonzero(behind.edge >= MIN_ISLAND_WIDTH)
    if not len(near):
        return PlanSteps.none()
    own, out = steps[near], behind.edge[near]
    bottom = own.h + behind.slope[near] * out
    x, y = own.x + out * own.nx, own.y + out * own.ny
    seen = cKDTree(np.c_[steps.x, steps.y]).query(np.c_[x, y])[0] <= SEEN_STEP_DISTANCE
    own, x, y, bottom = own[~seen], x[~seen], y[~seen], bottom[~seen]
    if not len(x):
        return PlanSteps.none()
    nx, ny, in_line = line_directions(x, y, -own.nx, -own.ny)
    owner, u, _, h = points_about(raster, raster.by_cell, x, y, nx, ny, EDGE_HALF_LENGTH)
    top = np.flatnonzero((h - bottom.take(owner) >= MIN_TOP_SHARE * own.height.take(owner)) & (np.abs(u) <= EDGE_REACH))
    edge = np.full(len(x), np.inf)
    np.minimum.at(edge, owner.take(top), u.take(top))
    count = np.bincount(owner.take(top), minlength=len(x))
    good = in_line & (count >= MIN_EDGE_POINTS) & (_largest_gap(owner, u - edge.take(owner), h - bottom.take(owner), own.height) <= MAX_EDGE_SPACING)
    edge = np.where(good, edge, 0.0)
    found = PlanSteps(x + edge * nx, y + edge * ny, nx, ny, bottom, own.height, np.zeros(len(x)), np.zeros(len(x)), count, count)
    return found[good]


def _largest_gap(owner, inward, above, height):
    """(K,) m, the largest gap across between points of the tops of K islands, from the outermost inward; `height` : (K,) m of their near sides."""
    top = np.flatnonzero((above >= MIN_TOP_SHARE * height.take(owner)) & (inward >= 0.0) & (inward < SPACING_DEPTH))
    owner, inward = np.r_[owner.take(top), np.arange(len(height))], np.r_[inward.take(top), np.full(len(height), SPACING_DEPTH)]
    order = np.lexsort((inward, owner))
    owner, inward = owner[order], inward[order]
    gap = np.zeros(len(height))
    np.maximum.at(gap, owner[1:], np.where(np.diff(owner) == 0, np.diff(inward), 0.0))
    return gap
