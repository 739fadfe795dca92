"""Lines of curb in plan, among which those near a place are looked up: a long road has many of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import shapely
from scipy.spatial import cKDTree

Line = tuple[np.ndarray, np.ndarray]


class CurbLines:
    """Lines of curb.

    Parameters
    ----------
    lines : L lines (x, y), each (N,) local m, uphill on the right
    """

    def __init__(self, lines: Sequence[Line]):
        self.lines = lines

    @cached_property
    def segments(self) -> np.ndarray:
        """(S, 4) x, y of the beginning of each segment, and how far it leads in x and y."""
        parts = [np.c_[x[:-1], y[:-1], np.diff(x), np.diff(y)] for x, y in self.lines if len(x) > 1]
        return np.concatenate([np.empty((0, 4)), *parts])

    @cached_property
    def _boxes(self):
        x, y, dx, dy = self.segments.T
        return shapely.STRtree(shapely.box(np.minimum(x, x + dx), np.minimum(y, y + dy), np.maximum(x, x + dx), np.maximum(y, y + dy)))

    def segments_about(self, x: np.ndarray, y: np.ndarray, distance: float) -> np.ndarray:
        """(K, 4) those segments that may come within a distance of (N,) places, in their order."""
        around = shapely.box(x.min() - distance, y.min() - distance, x.max() + distance, y.max() + distance)
        return self.segments[np.sort(self._boxes.query(around))]

    @cached_property
    def ends(self) -> np.ndarray:
        """(2 L, 4) x, y and the direction out of the line of both ends of every line; its last metre gives the direction."""
        return np.array([_end(x, y, at) for x, y in self.lines for at in (0, -1)]).reshape(-1, 4)

    @cached_property
    def _tips(self):
        return cKDTree(self.ends[:, :2])

    def ends_about(self, place: np.ndarray, distance: float) -> np.ndarray:
        """(K, 4) those of the ends that lie within a distance of a place, (2,) m."""
        return self.ends[self._tips.query_ball_point(place, distance)]

    def end_distances(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) m from (N,) places to the nearest end of any line, infinite where there is none."""
        return self._tips.query(np.c_[x, y])[0]

    @cached_property
    def _tree(self):
        return shapely.STRtree([shapely.linestrings(x, y) for x, y in self.lines if len(x) > 1])

    def distances(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) m from (N,) places to the nearest line; there must be one."""
        (place, _), away = self._tree.query_nearest(shapely.points(x, y), return_distance=True, all_matches=False)
        found = np.full(len(x), np.inf)
        found[place] = away
        return found


def _end(x, y, at):
    """x, y and the direction out of the line at its first (0) or last (-1) place."""
    order = 1 if at == 0 else -1
    away = np.hypot(x - x[at], y - y[at])[::order]
    k = int(np.argmax(away >= 1.0)) or len(x) - 1
    back = np.array([x[::order][k], y[::order][k]])
    out = np.array([x[at], y[at]]) - back
    return x[at], y[at], *(out / max(np.hypot(*out), 1e-9))
