"""Islands among the main curbs: what stands nearest to the vehicle may be a platform in the road, with the road's own curb behind it.

A stretch of main curb is the side of an island where the road's curb goes on farther out before it and behind it, and where the ground
beyond the stretch is as low as the road again before it comes to the line between these two. It is left out of the main curbs, so that
the curb behind it and the outline of the island are looked for; where these are not found, it stays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import stretch_of
from ..common.curb_points import CurbPoints
from ..common.hidden_curb import MAX_HIDDEN_GAP
from ..common.occlusion import OCCLUSION_CELL, OcclusionGrid
from ..common.sides import SIDE_SIGNS, expected_height
from .classify import MIN_ISLAND_SHARE, CurbReturn
from .ground.behind import ISLAND_DROP_SHARE, MIN_EDGE_SHARE
from .ground.level_ground import MAX_GROUND_SLOPE
from .ground.raster import PLAN_CELL

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

MIN_SIDE_STEP = 1.0           # m across by which the road's curb lies farther out than an island's
AVERAGED_LENGTH = 1.0         # m along the road either way whose ground is taken together
SLOPE_LENGTH = 3.0            # m before a curb, where the slope of the road is taken
MIN_SLOPE_CELLS = 4           # cells with ground that this needs
MIN_ROAD_BEHIND = 2.0         # m of ground as low as the road that lie behind an island
ISLAND_LINE_DISTANCE = 0.25   # m from a line about an island within which a point lies on it


def on_main_islands(points: CurbPoints, survey: Survey,
                    beside: Mapping[int, Mapping[str, OcclusionGrid]] | None) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Which points of main curbs lie on sides of islands, and where is the road behind these?

    Parameters
    ----------
    points : N CurbPoints of every road, of kind main
    survey : Survey
    beside : number of the road -> side -> OcclusionGrid; None where that is not known

    Returns
    -------
    (N,) bool, and number of the road -> (2, K) local x and y of places on the road behind
    """
    found, behind = np.zeros(len(points), bool), {road: [np.empty((2, 0))] for road in survey.store.roads()}
    across = np.arange(0.0, MIN_ROAD_BEHIND, PLAN_CELL)
    for road, sides in (beside or {}).items():
        for side, sign in SIDE_SIGNS.items():
            whole = np.flatnonzero((points.road == road) & (points.side == side))
            whole = whole[np.argsort(points.station[whole], kind="stable")]
            own = whole[(points.part[whole] == "bottom") & (points.status[whole] == "measured")]
            s, of_whole = points.station[own], points.station[whole]
            heights = points.z[own] - expected_height(survey, road, s), points.height[own]
            for part, away in island_stretches(s, sign * points.offset[own], *heights, sides[side]):
                found[whole[stretch_of(of_whole, s[part][0], s[part][-1])]] = True
                down = np.flatnonzero(np.isfinite(away))
                d = points.offset[own][part][down] + sign * (away[down] + across[:, None])
                behind[road].append(np.array(survey.frame.road(road).to_map(np.broadcast_to(s[part][down], d.shape).ravel(), d.ravel())))
    return found, {road: np.concatenate(places, axis=1) for road, places in behind.items()}


def are_replaced(points: CurbPoints, curbs: Sequence[CurbReturn]) -> bool:
    """Were lines about the islands found again in plan, and main curbs behind them?

    Parameters
    ----------
    points : CurbPoints on sides of islands, of one road
    curbs : list of CurbReturn, found without these points
    """
    own = points[(points.part == "bottom") & (points.status == "measured")]
    if not len(own):
        return True
    about = [np.c_[curb.steps.x, curb.steps.y] for curb in curbs if curb.kind == "island"]
    behind = np.zeros(len(own), bool)
    for curb in curbs:
        if curb.kind == "main":
            behind |= (own.side == curb.side) & (own.station >= np.min(curb.s)) & (own.station <= np.max(curb.s))
    if not about or np.mean(behind) < MIN_ISLAND_SHARE:
        return False
    away = cKDTree(np.concatenate(about)).query(np.c_[own.x, own.y])[0]
    return bool(np.mean(away <= ISLAND_LINE_DISTANCE) >= MIN_ISLAND_SHARE)


def island_stretches(s: np.ndarray, u: np.ndarray, h: np.ndarray, height: np.ndarray,
                     beside: OcclusionGrid) -> list[tuple[slice, np.ndarray]]:
    """The stretches of a main curb that are sides of islands.

    Parameters
    ----------
    s, u, h : (N,) m, station, outward offset, and height above the expected road of the curb's measured points, by station
    height : (N,) m, of the steps
    beside : OcclusionGrid of the side

    Returns
    -------
    list of (slice of the N points, m outward from each of these to where the ground is down again, NaN where that is not seen)
    """
    jump = np.flatnonzero(np.abs(np.diff(u)) > MIN_SIDE_STEP) + 1
    found = []
    for a, b in zip(jump[:-1], jump[1:]):
        out = min(u[a - 1] - u[a], u[b] - u[b - 1])
        if out > MIN_SIDE_STEP and max(s[a] - s[a - 1], s[b] - s[b - 1]) <= MAX_HIDDEN_GAP:
            down = np.array([_down_behind(*place, out, beside) for place in zip(s[a:b], u[a:b], h[a:b], height[a:b])])
            if np.mean(np.isfinite(down)) >= MIN_ISLAND_SHARE:
                found.append((slice(int(a), int(b)), down))
    return found


def _down_behind(s, u, h, height, out, beside):
    """m outward from one point of a curb to where the ground behind it, raised at first, is down again; NaN where it is not within `out`."""
    around, row = int(round(AVERAGED_LENGTH / beside.width)), int(np.floor(s / beside.width)) - beside.first
    rows = beside.ground[max(row - around, 0):row + around + 1]
    seen = np.flatnonzero(np.isfinite(rows).any(axis=0))
    ground, away = np.nanmedian(rows[:, seen], axis=0), (seen + 0.5) * OCCLUSION_CELL - u
    before = (away > -SLOPE_LENGTH) & (away < -OCCLUSION_CELL)
    if np.count_nonzero(before) < MIN_SLOPE_CELLS:
        return np.nan
    slope = np.clip(np.polyfit(away[before], ground[before], 1)[0], -MAX_GROUND_SLOPE, MAX_GROUND_SLOPE)
    share = (ground - h - slope * away) / height
    behind = away > OCCLUSION_CELL
    low = np.flatnonzero(behind & (share < ISLAND_DROP_SHARE))
    if not len(low) or away[low[0]] >= out or not (share[:low[0]][behind[:low[0]]] >= MIN_EDGE_SHARE).any():
        return np.nan
    road = (away >= away[low[0]]) & (away <= min(away[low[0]] + MIN_ROAD_BEHIND, out))
    return away[low[0]] if (share[road] < ISLAND_DROP_SHARE).mean() > 0.5 else np.nan
