"""Islands among the main curbs: what stands nearest to the vehicle may be a platform in the road, with the road's own curb behind it.

A stretch of main curb is the side of an island where the road's curb goes on farther out before it and behind it, and where the ground
beyond the stretch is as low as the road again before it comes to the line between these two. In the mouth of a street the nose of an island lies
farther out than both, is no longer than an island is wide, and has ground behind it that is low again within that width. Such a stretch is left
out of the main curbs, so that the curb behind it and the outline of the island are looked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import stretch_of
from ...survey.open_survey import Survey
from ..common.curb_points import CurbPoints
from ..common.occlusion import OcclusionGrid
from ..common.sides import SIDE_SIGNS, expected_height
from ..weights import CURBS, RETURN
from .ground_raster import GroundRaster
from .steps import PlanSteps, line_directions, points_about


def on_main_islands(points: CurbPoints, survey: Survey,
                    beside: Mapping[int, Mapping[str, OcclusionGrid]] | None) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Which points of main curbs lie on sides of islands, and where is the road behind these?

    points : N CurbPoints of every road, of kind main
    beside : number of the road -> side -> OcclusionGrid; None where that is not known

    Returns (N,) bool, and number of the road -> (2, K) local x and y of places on the road behind
    """
    on_islands, behind = np.zeros(len(points), bool), {road: [np.empty((2, 0))] for road in survey.store.roads()}
    across = np.arange(0.0, RETURN.min_road_behind, RETURN.plan_cell)
    for road, sides in (beside or {}).items():
        for side, sign in SIDE_SIGNS.items():
            of_side = np.flatnonzero((points.road == road) & (points.side == side))
            of_side = of_side[np.argsort(points.station[of_side], kind="stable")]
            bottoms = of_side[(points.part[of_side] == "bottom") & (points.status[of_side] == "measured")]
            s, side_stations = points.station[bottoms], points.station[of_side]
            heights = points.z[bottoms] - expected_height(survey, road, s), points.height[bottoms]
            for part, distance in island_stretches(s, sign * points.offset[bottoms], *heights, sides[side]):
                on_islands[of_side[stretch_of(side_stations, s[part][0], s[part][-1])]] = True
                down = np.flatnonzero(np.isfinite(distance))
                d = points.offset[bottoms][part][down] + sign * (distance[down] + across[:, None])
                behind[road].append(np.array(survey.frame.road(road).to_map(np.broadcast_to(s[part][down], d.shape).ravel(), d.ravel())))
    return on_islands, {road: np.concatenate(places, axis=1) for road, places in behind.items()}


def island_stretches(s: np.ndarray, u: np.ndarray, h: np.ndarray, height: np.ndarray,
                     beside: OcclusionGrid) -> list[tuple[slice, np.ndarray]]:
    """The stretches of a main curb that are sides of islands.

    s, u, h : (N,) m, station, outward offset, and height above the expected road of the curb's measured points, by station
    height : (N,) m, of the steps
    beside : OcclusionGrid of the side

    Returns a list of (slice of the N points, m outward from each of these to where the ground is down again, NaN where that is not seen)
    """
    jump = np.flatnonzero(np.abs(np.diff(u)) > RETURN.min_side_step) + 1
    result = []
    for a, b in zip(jump[:-1], jump[1:]):
        before, after = u[a - 1] - u[a], u[b] - u[b - 1]
        # the nose of an island in the mouth of a street lies farther out than the road's own curbs; a long stretch is a bay
        out, longest = (min(before, after), np.inf) if before > 0.0 else (RETURN.max_island_width, RETURN.max_island_width)
        if before * after > 0.0 and s[b - 1] - s[a] <= longest and max(s[a] - s[a - 1], s[b] - s[b - 1]) <= CURBS.max_hidden_gap:
            down = np.array([_down_behind(*point, out, beside) for point in zip(s[a:b], u[a:b], h[a:b], height[a:b])])
            if np.mean(np.isfinite(down)) >= RETURN.min_island_share:
                result.append((slice(int(a), int(b)), down))
    return result


def _down_behind(s, u, h, height, out, beside):
    """m outward from one point of a curb to where the ground behind it, raised at first, is down again; NaN where it is not within `out`."""
    around, row = int(round(RETURN.averaged_length / beside.width)), int(np.floor(s / beside.width)) - beside.first
    rows = beside.ground[max(row - around, 0):row + around + 1]
    columns = np.flatnonzero(np.isfinite(rows).any(axis=0))
    ground, distance = np.nanmedian(rows[:, columns], axis=0), (columns + 0.5) * CURBS.occlusion_cell - u
    before = (distance > -RETURN.slope_length) & (distance < -CURBS.occlusion_cell)
    if np.count_nonzero(before) < RETURN.min_slope_cells:
        return np.nan
    slope = np.clip(np.polyfit(distance[before], ground[before], 1)[0], -RETURN.max_ground_slope, RETURN.max_ground_slope)
    share = (ground - h - slope * distance) / height
    behind = distance > CURBS.occlusion_cell
    low = np.flatnonzero(behind & (share < RETURN.island_drop_share))
    if not len(low) or distance[low[0]] >= out or not (share[:low[0]][behind[:low[0]]] >= RETURN.min_edge_share).any():
        return np.nan
    road = (distance >= distance[low[0]]) & (distance <= min(distance[low[0]] + RETURN.min_road_behind, out))
    return distance[low[0]] if (share[road] < RETURN.island_drop_share).mean() > 0.5 else np.nan


# Far sides of islands: an island hides the foot of its own far curb, but the edge of its top is seen.
#
# Behind a step, the raised ground of an island ends, and what is seen next is as low as the road. The curb stands upright beneath the outermost
# points of the top.


def far_sides(raster: GroundRaster, steps: PlanSteps, behind: GroundBehind) -> PlanSteps:
    """Steps of the far sides of islands that are hidden by the islands themselves.

    steps : M PlanSteps, among them those of the near sides
    behind : GroundBehind of the M steps

    Returns PlanSteps, at most one for each of the M; the bottom is where the plane of the road before the near side goes on
    """
    near = np.flatnonzero(behind.edge >= RETURN.min_island_width)
    if not len(near):
        return PlanSteps.none()
    near_steps, out = steps[near], behind.edge[near]
    bottom = near_steps.h + behind.slope[near] * out
    x, y = near_steps.x + out * near_steps.nx, near_steps.y + out * near_steps.ny
    measured = cKDTree(np.c_[steps.x, steps.y]).query(np.c_[x, y])[0] <= RETURN.seen_step_distance
    near_steps, x, y, bottom = near_steps[~measured], x[~measured], y[~measured], bottom[~measured]
    if not len(x):
        return PlanSteps.none()
    nx, ny, in_line = line_directions(x, y, -near_steps.nx, -near_steps.ny)
    owner, u, _, h = points_about(raster, raster.by_cell, x, y, nx, ny, RETURN.edge_half_length)
    top = np.flatnonzero((h - bottom.take(owner) >= RETURN.min_top_share * near_steps.height.take(owner)) & (np.abs(u) <= RETURN.edge_reach))
    edge = np.full(len(x), np.inf)
    np.minimum.at(edge, owner.take(top), u.take(top))
    count = np.bincount(owner.take(top), minlength=len(x))
    gap = _largest_gap(owner, u - edge.take(owner), h - bottom.take(owner), near_steps.height)
    good = in_line & (count >= RETURN.min_edge_points) & (gap <= RETURN.max_edge_spacing)
    edge = np.where(good, edge, 0.0)
    result = PlanSteps(x + edge * nx, y + edge * ny, nx, ny, bottom, near_steps.height, np.zeros(len(x)), np.zeros(len(x)), count, count)
    return result[good]


def _largest_gap(owner, inward, above, height):
    """(K,) m, the largest gap across between points of the tops of K islands, from the outermost inward; `height` : (K,) m of their near sides."""
    top = np.flatnonzero((above >= RETURN.min_top_share * height.take(owner)) & (inward >= 0.0) & (inward < RETURN.spacing_depth))
    owner, inward = np.r_[owner.take(top), np.arange(len(height))], np.r_[inward.take(top), np.full(len(height), RETURN.spacing_depth)]
    order = np.lexsort((inward, owner))
    owner, inward = owner[order], inward[order]
    gap = np.zeros(len(height))
    np.maximum.at(gap, owner[1:], np.where(np.diff(owner) == 0, np.diff(inward), 0.0))
    return gap


# Steps on top of an island: a ramp that is lowered for a crossing has edges in it, whose foot is not on the road.


def on_island_tops(steps: PlanSteps, behind: GroundBehind) -> np.ndarray:
    """Which steps lie on raised ground that a higher step bounds, and that comes down again behind them?

    steps : M PlanSteps
    behind : GroundBehind of each

    Returns (M,) bool
    """
    on_top = np.zeros(len(steps), bool)
    end = np.where(np.isfinite(behind.edge), behind.edge, behind.falls)
    out = np.arange(RETURN.ray_spacing, np.nanmax(end, initial=0.0), RETURN.ray_spacing)
    ray, cell = np.nonzero(out < end[:, None])
    if not len(ray):
        return on_top
    distance = out[cell]
    places = np.c_[steps.x[ray] + distance * steps.nx[ray], steps.y[ray] + distance * steps.ny[ray]]
    near = cKDTree(np.c_[steps.x, steps.y]).sparse_distance_matrix(cKDTree(places), RETURN.ray_reach, output_type="ndarray")
    foot_of, bounding = near["i"], ray[near["j"]]
    foot = steps.h[foot_of] - steps.h[bounding] - behind.slope[bounding] * distance[near["j"]]
    above = (foot > np.maximum(RETURN.min_foot_share * steps.height[bounding], CURBS.height_tolerance)) \
        & (steps.height[foot_of] < steps.height[bounding])
    on_top[foot_of[above]] = True
    return on_top


# What the ground behind a step does: back at the bottom of the step, as behind an island, or up.


@dataclass
class GroundBehind:
    """What the ground behind M steps does, along a ray uphill from each.

    edge : (M,) m uphill of the last raised ground, if it ends at once, as where it hides its own side; NaN where it comes down little by little
    """

    falls: np.ndarray   # (M,) m uphill at which the ground is back at the step's bottom, NaN where it stays up
    edge: np.ndarray
    slope: np.ndarray   # (M,) m per m uphill, of the road before the step


def ground_behind(raster: GroundRaster, slopes: Sequence[np.ndarray], x: np.ndarray, y: np.ndarray, nx: np.ndarray, ny: np.ndarray,
                  bottom: np.ndarray, height: np.ndarray, farthest: float) -> GroundBehind:
    """Where the ground behind steps is down again.

    slopes : result of `ground_slopes`
    x, y : (M,) local m, places of the steps
    nx, ny : (M,) unit vectors uphill
    bottom, height : (M,) m, of the steps
    farthest : m uphill that are searched
    """
    # the ground behind is down where the plane of the road before the step goes on
    before = raster.nearest_cells(x - RETURN.road_before * nx, y - RETURN.road_before * ny)
    slope = nx * slopes[0][before] + ny * slopes[1][before]
    out = (np.arange(int(round(farthest / RETURN.plan_cell))) + 2) * RETURN.plan_cell
    row, column = raster.cells_at(x[:, None] + out * nx[:, None], y[:, None] + out * ny[:, None])
    on = (row >= 0) & (column >= 0) & (row < raster.low.shape[0]) & (column < raster.low.shape[1])
    heights = np.where(on, raster.low[np.where(on, row, 0), np.where(on, column, 0)], np.nan)
    with np.errstate(invalid="ignore"):
        share = (heights - bottom[:, None] - slope[:, None] * out) / height[:, None]
        down, up = share < RETURN.island_drop_share, share >= RETURN.island_drop_share
    first = np.where(down.any(1), np.argmax(down, axis=1), len(out))
    last = np.where(up, np.arange(len(out)), -1)
    last[np.arange(len(out)) >= first[:, None]] = -1
    last = last.max(axis=1)
    index = np.arange(len(x))
    # a ramp comes down little by little; an upright side hides a few centimetres from a vehicle near by, and decimetres from one far away
    upright = (first < len(out)) & (last >= 0) & (share[index, last] >= RETURN.min_edge_share)
    return GroundBehind(np.where(first < len(out), out[np.minimum(first, len(out) - 1)], np.nan), np.where(upright, out[last], np.nan), slope)
