"""Crossings and stop lines of the layer MARKINGS, as lines across and along the road."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from ..common.features import Features

STRIPE_GAP = 1.5     # m between stripes of one crossing: a gap of one stripe, worn on both sides
LEAST_CROSSING = 3   # stripes


def stop_lines(markings: Features | None) -> list[np.ndarray]:
    """(2, 3) the middle line of every stop line."""
    found = [_corners(shape) for shape in _shapes(markings, ("stop", "stop_line"))]
    return [(corners[[0, 1]] + corners[[3, 2]]) / 2 for corners in found if len(corners)]


def walked_crossings(markings: Features | None) -> list[tuple[np.ndarray, np.ndarray]]:
    """((2, 3) left, (2, 3) right) sides of every zebra crossing, along the way of those who cross: over the row of its stripes."""
    stripes = _shapes(markings, ("zebra", "crosswalk", "zebra_crossing"))
    found = []
    for group in _groups(stripes):
        corners = _corners(shapely.unary_union(group)) if len(group) > 1 else _corners(group[0])
        if not len(corners) or len(group) < LEAST_CROSSING and len(stripes) >= LEAST_CROSSING:
            continue
        across = np.mean([_long_side(stripe) for stripe in group], axis=0)
        along = corners[1] - corners[0]
        if len(group) > 1 and abs(along[:2] @ across) > abs((corners[2] - corners[1])[:2] @ across):
            corners = corners[[1, 2, 3, 0]]   # walkers go from stripe to stripe, which lie along the road
        found.append((corners[[3, 2]], corners[[0, 1]]))
    return found


def _shapes(markings: Features | None, classes: tuple[str, ...]) -> list[Any]:
    if markings is None:
        return []
    return [geometry for geometry, row in markings if geometry is not None and not geometry.is_empty and row.get("class") in classes]


def _groups(shapes: list[Any]) -> list[list[Any]]:
    """Shapes that lie together."""
    if not shapes:
        return []
    joined = shapely.get_parts(shapely.union_all(shapely.buffer(shapely.force_2d(np.array(shapes, object)), STRIPE_GAP / 2)))
    found: list[list[Any]] = [[] for _ in joined]
    tree = shapely.STRtree(joined)
    for shape in shapes:
        found[int(tree.query(shapely.force_2d(shape).representative_point(), predicate="intersects")[0])].append(shape)
    return [group for group in found if group]


def _corners(shape: Any) -> np.ndarray:
    """(4, 3) corners of the rectangle about a shape, its long side first, counter-clockwise; heights are those of the nearest vertices."""
    rectangle = shapely.force_2d(shape).minimum_rotated_rectangle
    if rectangle.geom_type != "Polygon":
        return np.empty((0, 3))
    corners = shapely.get_coordinates(shapely.orient_polygons(rectangle).exterior)[:4] if hasattr(shapely, "orient_polygons") else \
        shapely.get_coordinates(shapely.geometry.polygon.orient(rectangle).exterior)[:4]
    if np.hypot(*(corners[1] - corners[0])) < np.hypot(*(corners[2] - corners[1])):
        corners = corners[[1, 2, 3, 0]]
    vertices = shapely.get_coordinates(shape, include_z=True)
    nearest = np.argmin(np.hypot(*(corners[:, None] - vertices[None, :, :2]).transpose(2, 0, 1)), axis=1)
    return np.c_[corners, np.nan_to_num(vertices[nearest, 2])]


def _long_side(shape):
    corners = _corners(shape)
    if not len(corners):
        return np.zeros(2)
    side = (corners[1] - corners[0])[:2]
    return side * (1 if side[0] > 0 or side[0] == 0 and side[1] > 0 else -1)
