"""How well an exported map keeps what it was made from."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree

from ..common.features import Features
from ..driving.layers import Lanes

NEAR_MIDDLE = 1.0     # m from the middle of a lane within which a driving line is held against it
LEFT_OUT_NEAR = 0.5   # m between a driving line and a place that is left out: lanes have vertices twice as near
SAME_BORDER = 0.05    # m across within which heights are compared


class Misses(NamedTuple):
    """Metres: mean, 95th percentile, largest; and at how many places."""

    mean: float
    p95: float
    largest: float
    places: int


def border_misses(source: Lanes, exported: Lanes) -> tuple[Misses, Misses]:
    """(across, in height) of the source's border vertices against the borders that are read back."""
    vertices = np.concatenate([source.left, source.right])
    pieces = []
    for k in range(len(exported)):
        for border in exported.borders(k):
            pieces.append(np.concatenate([border[:-1], border[1:]], axis=1))
    segments = np.concatenate(pieces) if pieces else np.empty((0, 6))
    return _misses(vertices, segments, np.inf)


def driving_line_misses(driving_lines: Features | None, exported: Lanes, measured_only: bool = True,
                        apart_from: np.ndarray | None = None) -> Misses:
    """Across, of driving lines against the middles of the lanes that are read back.

    apart_from : (N, 2) places; what lies within LEFT_OUT_NEAR of one is left out
    """
    middles = [(left + right) / 2 for left, right in (exported.borders(k) for k in range(len(exported))
                                                      if exported.type[k] in ("driving", "connector"))]
    rows = [shapely.get_coordinates(geometry, include_z=True) for geometry, row in driving_lines or ()
            if geometry is not None and (not measured_only or row.get("status") in (None, "measured"))]
    places = np.concatenate([np.empty((0, 3)), *rows])
    if apart_from is not None and len(apart_from) and len(places):
        places = places[cKDTree(apart_from).query(places[:, :2])[0] > LEFT_OUT_NEAR]
    if not len(places) or not middles:
        return _summary(np.empty(0))
    return _misses(places, np.concatenate([np.concatenate([line[:-1], line[1:]], axis=1) for line in middles]), NEAR_MIDDLE)[0]


def _misses(places, segments, farthest):
    """(across, in height) of (N, 3) places against (M, 6) segments from end to end, where one lies nearer than `farthest` metres."""
    lines = shapely.linestrings(segments.reshape(-1, 2, 3)[:, :, :2])
    points, tree = shapely.points(places[:, :2]), shapely.STRtree(lines)
    which, near = tree.query(points, predicate="dwithin", distance=SAME_BORDER)
    first, last = segments[near, :3], segments[near, 3:]
    run = (last - first)[:, :2]
    share = np.clip(((places[which, :2] - first[:, :2]) * run).sum(1) / np.maximum((run**2).sum(1), 1e-12), 0.0, 1.0)
    across = np.full(len(places), np.inf)
    np.minimum.at(across, which, np.hypot(*(places[which] - first - share[:, None] * (last - first)).T[:2]))
    far = np.flatnonzero(np.isinf(across))   # the nearest of all segments is looked for only where none lies near
    found, away = tree.query_nearest(points[far], max_distance=None if np.isinf(farthest) else farthest, return_distance=True, all_matches=False)
    across[far[found[0]]] = away
    # where borders of several roads lie on each other, the one at the place's own height is its own
    rise = np.full(len(places), np.inf)
    np.minimum.at(rise, which, np.abs(places[which, 2] - first[:, 2] - share * (last - first)[:, 2]))
    return _summary(across[np.isfinite(across)]), _summary(rise[np.isfinite(rise)])


def _summary(values):
    if not len(values):
        return Misses(np.nan, np.nan, np.nan, 0)
    return Misses(float(values.mean()), float(np.percentile(values, 95)), float(values.max()), len(values))
