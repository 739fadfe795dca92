"""Steps on top of an island: a ramp that is lowered for a crossing has edges in it, whose foot is not on the road."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..common.tracking import HEIGHT_TOLERANCE
from .ground.behind import GroundBehind
from .steps import PlanSteps

RAY_SPACING = 0.2             # m between places along a ray
RAY_REACH = 0.3               # m from such a place within which a step lies on it: the steps of a line are up to twice that apart
MIN_FOOT_SHARE = 0.25         # share of the height of an island's curb by which the foot of a step on its top lies above the road


def on_island_tops(steps: PlanSteps, behind: GroundBehind) -> np.ndarray:
    """Which steps lie on raised ground that a higher step bounds, and that comes down again behind them?

    Parameters
    ----------
    steps : M PlanSteps
    behind : GroundBehind of each

    Returns
    -------
    (M,) bool
    """
    on_top = np.zeros(len(steps), bool)
    end = np.where(np.isfinite(behind.edge), behind.edge, behind.falls)
    out = np.arange(RAY_SPACING, np.nanmax(end, initial=0.0), RAY_SPACING)
    ray, place = np.nonzero(out < end[:, None])
    if not len(ray):
        return on_top
    away = out[place]
    places = np.c_[steps.x[ray] + away * steps.nx[ray], steps.y[ray] + away * steps.ny[ray]]
    near = cKDTree(np.c_[steps.x, steps.y]).sparse_distance_matrix(cKDTree(places), RAY_REACH, output_type="ndarray")
    own, of = near["i"], ray[near["j"]]
    foot = steps.h[own] - steps.h[of] - behind.slope[of] * away[near["j"]]
    above = (foot > np.maximum(MIN_FOOT_SHARE * steps.height[of], HEIGHT_TOLERANCE)) & (steps.height[own] < steps.height[of])
    on_top[own[above]] = True
    return on_top
