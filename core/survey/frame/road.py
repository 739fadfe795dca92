"""The reference line of a road: station and offset of any position, and back.

The reference line is the smoothed track of the road's longest pass, stored as nodes 0.1 m apart. Position and heading
are interpolated between nodes. The station of a point is where the normal of the line passes through it.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .reference_line import FRAME_EXTENSION, NODE_SPACING

CORRIDOR = 25.0               # m either side of the reference line


class Road:
    """The reference line of one carriageway in local coordinates.

    Stations increase in the direction of the longest pass, which begins at station 0; offsets are left positive.

    Parameters
    ----------
    number : of the road
    nodes_x, nodes_y : (N,) m, NODE_SPACING apart
    start : station of the first node, m
    """

    def __init__(self, number: int, nodes_x: np.ndarray, nodes_y: np.ndarray, start: float):
        self.number = number
        self.start = start
        self.x, self.y = nodes_x, nodes_y
        dx, dy = np.gradient(nodes_x, NODE_SPACING), np.gradient(nodes_y, NODE_SPACING)
        self._heading = np.unwrap(np.arctan2(dy, dx))
        self._cos, self._sin = np.cos(self._heading), np.sin(self._heading)
        self._curvature = np.gradient(self._heading, NODE_SPACING)
        self.end = start + NODE_SPACING * (len(nodes_x) - 1)
        self.length = self.end - FRAME_EXTENSION
        self._tree: cKDTree | None = None

    def __getstate__(self) -> dict:
        """What the reference line is made of; the rest follows from it."""
        return dict(number=self.number, nodes_x=self.x, nodes_y=self.y, start=self.start)

    def __setstate__(self, state: dict) -> None:
        Road.__init__(self, **state)

    def _at(self, s):
        # np.clip takes five times as long on few values
        u = np.minimum(np.maximum((np.asarray(s, float) - self.start) / NODE_SPACING, 0), len(self.x) - 1)
        k = np.minimum(u.astype(np.int64), len(self.x) - 2)
        return k, u - k

    def _line(self, k, f):
        """Position and unit tangent of the reference line at the nodes k and a share f of the way to the next."""
        x = self.x[k] + f * (self.x[k + 1] - self.x[k])
        y = self.y[k] + f * (self.y[k + 1] - self.y[k])
        c = self._cos[k] + f * (self._cos[k + 1] - self._cos[k])
        n = self._sin[k] + f * (self._sin[k + 1] - self._sin[k])
        return x, y, c, n

    def heading(self, s: np.ndarray) -> np.ndarray:
        """Direction of the reference line at (N,) stations, radians counter-clockwise from east."""
        k, f = self._at(s)
        return self._heading[k] + f * (self._heading[k + 1] - self._heading[k])

    def curvature(self, s: np.ndarray) -> np.ndarray:
        """Curvature at (N,) stations, 1/m, positive in a left bend."""
        return self._bend(*self._at(s))

    def _bend(self, k, f):
        return self._curvature[k] + f * (self._curvature[k + 1] - self._curvature[k])

    def to_map(self, s: np.ndarray, d: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Local x, y of stations s and offsets d, metres; straight on beyond the ends."""
        s, d = np.asarray(s, float), np.asarray(d, float)
        x, y, c, n = self._line(*self._at(s))
        beyond = s - np.minimum(np.maximum(s, self.start), self.end)
        return x + beyond * c - d * n, y + beyond * n + d * c

    def locate(self, x: np.ndarray, y: np.ndarray, start: np.ndarray | None = None,
               corridor: float = CORRIDOR) -> tuple[np.ndarray, np.ndarray]:
        """Station and offset of local positions, by Newton iteration on the along-track component.

        Parameters
        ----------
        x, y : (N,) local metres
        start : (N,) initial stations near the wanted nearest point (from gps_time); None for the nearest node
        corridor : largest |offset|, metres

        Returns
        -------
        s, d : (N,) metres; NaN beyond the ends of the frame, outside the corridor, or on the inner side of a bend beyond
            0.9 of its radius, where normals cross
        """
        x, y = np.asarray(x, float), np.asarray(y, float)
        if start is None:
            start = self.nearest_station(x, y, corridor)
        s = np.array(start, float)
        lost = ~np.isfinite(s)
        s[lost] = self.start
        d = np.empty(len(s))
        active = np.arange(len(s))
        # most points converge in three steps
        for _ in range(12):
            at = self._at(s[active])
            px, py, c, n = self._line(*at)
            ex, ey = x[active] - px, y[active] - py
            along, across = ex * c + ey * n, ey * c - ex * n
            d[active] = across
            step = along / np.minimum(np.maximum(1.0 - self._bend(*at) * across, 0.4), 2.5)
            step = np.minimum(np.maximum(step, -30), 30)
            s[active] = np.minimum(np.maximum(s[active] + step, self.start - 1.0), self.end + 1.0)
            active = active[np.abs(along) > 2e-5]
            if not len(active):
                break
        settled = np.ones(len(s), bool)
        settled[active] = False
        inside = settled & ~lost & (s >= self.start) & (s < self.end) & (np.abs(d) <= corridor) \
            & (self.curvature(s) * d < 0.9)
        s[~inside] = np.nan
        d[~inside] = np.nan
        return s, d

    def within(self, x: np.ndarray, y: np.ndarray, start: float, end: float) -> np.ndarray:
        """(N,) bool, whether the stations of (N,) local places, as of `locate`, lie from `start` to before `end`; places far away cost little."""
        line = np.stack(self.to_map(np.arange(start, end + NODE_SPACING, NODE_SPACING), 0.0))
        low, high = line.min(axis=1) - CORRIDOR - 1.0, line.max(axis=1) + CORRIDOR + 1.0
        found = (x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1])
        s, _ = self.locate(x[found], y[found])
        found[found] = (s >= start) & (s < end)
        return found

    def nearest_station(self, x: np.ndarray, y: np.ndarray, corridor: float = CORRIDOR) -> np.ndarray:
        """Station of the nearest node of the line, (N,) m; NaN where none is within the corridor."""
        if self._tree is None:
            self._tree = cKDTree(np.c_[self.x[::5], self.y[::5]])
        distance, index = self._tree.query(np.c_[x, y], distance_upper_bound=corridor * 1.05 + 1.0)
        return np.where(np.isfinite(distance), self.start + 5 * NODE_SPACING * index, np.nan)
