"""Heights of the lanes' borders from the points of the road's surface."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..common.errors import RoadExtractionError
from ..driving.layers import Lanes

if TYPE_CHECKING:
    from ..survey.store.road_points import RoadPoints

SURFACE_REACH = 0.3          # m about a vertex within which the surface is flat enough for a median
FEWEST_POINTS = 5    # about a vertex
MOST_CHANGE = 0.5    # m: a surface farther above or below is another one, such as a bridge's


def with_surface_heights(lanes: Lanes, road_points: RoadPoints) -> tuple[Lanes, float]:
    """Lanes in map coordinates with borders at the median height of the road points about each vertex.

    Parameters
    ----------
    lanes : Lanes in map coordinates
    road_points : RoadPoints of the same survey

    Returns
    -------
    lanes : Lanes; vertices without points are raised or lowered as those before and after them on the border, and keep their heights on a
        border without any
    share : 0 to 1, of the vertices that have points

    Raises
    ------
    RoadExtractionError
        If no vertex has points.
    """
    from scipy.spatial import cKDTree

    vertices = np.concatenate([lanes.left, lanes.right])
    origin = road_points.origin
    tree = cKDTree(vertices[:, :2] - origin[:2])
    owners, heights = [], []
    for key in road_points.all_sections():
        points = road_points.section(*key)
        _, nearest = tree.query(np.c_[points.x, points.y], distance_upper_bound=SURFACE_REACH)
        near = nearest < len(vertices)
        owners.append(nearest[near])
        heights.append(np.asarray(points.z, float)[near])
    owner, height = np.concatenate([np.empty(0, int), *owners]), np.concatenate([np.empty(0), *heights]) + origin[2]
    # vertices of neighbours lie at one place, of which the tree gives the points to one
    same, which = np.unique(np.round(vertices[:, :2], 3), axis=0, return_inverse=True)
    which = which.ravel()
    place = which[owner]
    order = np.lexsort((height, place))
    place, height = place[order], height[order]
    counts = np.bincount(place, minlength=len(same))
    first = np.append(0, np.cumsum(counts))[:-1]
    enough = counts >= FEWEST_POINTS
    if not enough.any():
        raise RoadExtractionError("Road points do not lie where the lanes are: no border has any beside it. Choose the road points of the same "
                                  "survey, or leave them out.")
    median = np.full(len(same), np.nan)
    median[enough] = height[(first + counts // 2)[enough]]
    change = median[which] - vertices[:, 2]
    change[~(np.abs(change) < MOST_CHANGE)] = np.nan
    found = np.c_[vertices[:, :2], vertices[:, 2] + _along_borders(change, vertices, lanes.start)]
    return replace(lanes, left=found[:len(lanes.left)], right=found[len(lanes.left):]), float(enough[which].mean())


def _along_borders(change, vertices, start):
    """(V,) the changes of the vertices of left and right borders; NaN is filled in from those before and after it on its border."""
    filled = np.nan_to_num(change)
    count = len(change) // 2
    for side in (0, count):
        for a, b in zip(start[:-1] + side, start[1:] + side):
            known = np.isfinite(change[a:b])
            if known.any() and not known.all():
                along = np.append(0.0, np.cumsum(np.hypot(*np.diff(vertices[a:b, :2], axis=0).T)))
                filled[a:b] = np.interp(along, along[known], change[a:b][known])
    return filled
