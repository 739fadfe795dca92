"""Borders moved within the tolerance of the map, so that the middles of its lanes are the driving lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely

from .shared_borders import numbered
from .sources import RoadMapSource, is_stated

NEAR_LINE = 0.15   # m from the middle of a lane within which a driving line is its own
ROUNDS = 50        # of moving borders: neighbours share them


def with_driven_middles(source: RoadMapSource, most: float) -> RoadMapSource:
    """A road map whose lanes have their driving lines in their middle, as far as it takes to move no border by more than `most` metres.

    Driving lines are smooth, borders are as they were measured; a map of borders alone tells where to drive by the middle between them. Of two
    lanes that share a border each asks for its own move; the least squares of what is missed are looked for, within the limit.

    Parameters
    ----------
    source : RoadMapSource with common borders
    most : metres
    """
    lanes = source.lanes
    if not source.driving_lines or most <= 0 or is_stated(lanes):   # a map from elsewhere has its driving lines from its borders
        return source
    across = (lanes.left - lanes.right)[:, :2]
    across = across / np.maximum(np.hypot(*across.T), 1e-9)[:, None]
    middles = source.middles if source.middles is not None else (lanes.left + lanes.right) / 2
    wanted = _beside(source, middles[:, :2], across)
    known = np.flatnonzero(np.isfinite(wanted))
    if not len(known):
        return source
    nodes, first = numbered(np.concatenate([lanes.left, lanes.right]))
    left, right = nodes[:len(lanes.left)], nodes[len(lanes.left):]
    sides, lateral = np.concatenate([left[known], right[known]]), np.tile(across[known], (2, 1))
    way = np.zeros((len(first), 2))
    way[sides] = lateral
    turned = np.sign((lateral * way[sides]).sum(1))   # neighbours may be driven against each other
    asked, move = np.maximum(np.bincount(sides, minlength=len(first)), 1), np.zeros(len(first))
    for _ in range(ROUNDS):
        own = (turned * move[sides]).reshape(2, -1).mean(0)
        change = np.bincount(sides, turned * np.tile(wanted[known] - own, 2), minlength=len(first))
        move = np.clip(move + change / asked, -most, most)
    way = way * move[:, None]
    moved = [np.c_[side[:, :2] + way[of], side[:, 2]] for side, of in ((lanes.left, left), (lanes.right, right))]
    return replace(source, lanes=replace(lanes, left=moved[0], right=moved[1]))


def _beside(source, middles, across):
    """(V,) metres by which the driving line lies left of the middle of its lane, NaN where none lies near."""
    lanes, found = source.lanes, np.full(len(middles), np.nan)
    lines = [geometry for geometry, row in source.driving_lines if geometry is not None and row.get("status") in (None, "measured")]
    driven = np.flatnonzero(np.repeat(lanes.type == "driving", np.diff(lanes.start)))
    if not lines or not len(driven):
        return found
    lines, points = shapely.force_2d(np.array(lines, object)), shapely.points(middles[driven])
    which, line = shapely.STRtree(lines).query_nearest(points, max_distance=NEAR_LINE, all_matches=False)
    foot = shapely.get_coordinates(shapely.line_interpolate_point(lines[line], shapely.line_locate_point(lines[line], points[which])))
    rows = driven[which]
    away = foot - middles[rows]
    beside = np.abs(away[:, 0] * across[rows, 1] - away[:, 1] * across[rows, 0]) < np.abs((away * across[rows]).sum(1)) + 1e-3
    found[rows[beside]] = (away * across[rows]).sum(1)[beside]
    return found
