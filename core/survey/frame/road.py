"""The reference line of a road: station and offset of any position, and back.

The reference line is the smoothed track of the road's longest pass, stored as nodes 0.1 m apart. Position and heading
are interpolated between nodes. The station of a point is where the normal of the line passes through it.
"""

from __future__ import annotations

import itertools
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from ...common.errors import RoadExtractionError
from ..weights import FRAME


class Road:
    """The reference line of one carriageway in local coordinates.

    Stations increase in the direction of the longest pass, which begins at station 0; offsets are left positive.

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
        self.length = self.end - FRAME.frame_extension

    def __getstate__(self) -> dict:
        return dict(number=self.number, nodes_x=self.x, nodes_y=self.y, start=self.start)

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
               corridor: float = FRAME.corridor) -> tuple[np.ndarray, np.ndarray]:
        """Station and offset of (N,) local positions, by Newton iteration on the along-track component.

        NaN beyond the ends of the frame, outside the corridor, or on the inner side of a bend beyond 0.9 of its radius, where normals cross.

        start : (N,) initial stations near the wanted nearest point (from gps_time); None for the nearest node
        corridor : largest |offset|, metres
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
            nodes = self._at(s[active])
            px, py, c, n = self._line(*nodes)
            ex, ey = x[active] - px, y[active] - py
            along, across = ex * c + ey * n, ey * c - ex * n
            d[active] = across
            step = along / np.minimum(np.maximum(1.0 - self._bend(*nodes) * across, 0.4), 2.5)
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
        low, high = line.min(axis=1) - FRAME.corridor - 1.0, line.max(axis=1) + FRAME.corridor + 1.0
        inside = (x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1])
        s, _ = self.locate(x[inside], y[inside])
        inside[inside] = (s >= start) & (s < end)
        return inside

    def nearest_station(self, x: np.ndarray, y: np.ndarray, corridor: float = FRAME.corridor) -> np.ndarray:
        """Station of the nearest node of the line, (N,) m; NaN where none is within the corridor."""
        distance, index = self._tree.query(np.c_[x, y], distance_upper_bound=corridor * 1.05 + 1.0)
        return np.where(np.isfinite(distance), self.start + 5 * NODE_SPACING * index, np.nan)

    @cached_property
    def _tree(self):
        return cKDTree(np.c_[self.x[::5], self.y[::5]])


# The reference line of a road: the smoothed track of its longest pass, continued by other passes.

NODE_SPACING = 0.1     # derived: m between nodes of the reference line: 0.02 mm of sagitta at R = 60 m


def reference_nodes(line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes x, y (M,) of the reference line along a track, (N, 2) or (N, 3) m: NODE_SPACING apart, extended at both ends.

    A track that does not move is refused.
    """
    x, y = line[:, 0], line[:, 1]
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    unique = np.r_[True, np.diff(driven) > 0]
    driven, x, y = driven[unique], x[unique], y[unique]
    if driven[-1] < 1.0:
        raise RoadExtractionError("The trajectory does not move: at least 1 m of driving is needed to define a road.")
    u = np.arange(0.0, driven[-1] + NODE_SPACING / 2, NODE_SPACING)
    if np.median(np.diff(driven)) > FRAME.sparse_track_spacing and len(driven) > 3:
        x, y = CubicSpline(driven, x)(u), CubicSpline(driven, y)(u)
    else:
        x, y = np.interp(u, driven, x), np.interp(u, driven, y)
    x, y = _extend(_smooth(x), _smooth(y))
    along = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    u = np.arange(0.0, along[-1], NODE_SPACING)
    return np.interp(u, along, x), np.interp(u, along, y)


def _smooth(values):
    """Gaussian smoothing along the line, point-reflected at the end points so that these stay."""
    pad = min(int(4 * FRAME.line_smoothing / NODE_SPACING), len(values) - 1)
    padded = np.pad(values, pad, "reflect", reflect_type="odd")
    return gaussian_filter1d(padded, FRAME.line_smoothing / NODE_SPACING)[pad:pad + len(values)]


def _extend(x, y):
    reach = min(int(3.0 / NODE_SPACING), len(x) - 1)
    steps = np.arange(1, int(round(FRAME.frame_extension / NODE_SPACING)) + 1) * NODE_SPACING

    def beyond(tip, inner):
        direction = np.array([x[tip] - x[inner], y[tip] - y[inner]])
        direction /= np.hypot(*direction)
        return x[tip] + steps * direction[0], y[tip] + steps * direction[1]

    hx, hy = beyond(0, reach)
    tx, ty = beyond(-1, len(x) - 1 - reach)
    return np.r_[hx[::-1], x, tx], np.r_[hy[::-1], y, ty]


def continue_line(line: np.ndarray, track: np.ndarray) -> np.ndarray | None:
    """A line lengthened by a track that continues it at either end, driven in either direction; None if it does not.

    Both are (N, 3) positions at least half a metre apart; the result has the direction of `line`.
    """
    for way, direction in itertools.product((track, track[::-1]), (1, -1)):
        longer = _append_track(line[::direction], way)
        if longer is not None:
            return longer[::direction]
    return None


def continue_straight(line: np.ndarray, track: np.ndarray) -> np.ndarray:
    """A line that goes on straight up to the farthest of a track, where its extension would not reach that; both are (N, 3) positions."""
    direction = -_direction(line[::-1])
    ahead = (track[:, :2] - line[-1, :2]) @ direction
    if ahead.max(initial=0.0) <= FRAME.frame_extension:
        return line
    return np.concatenate([line, [[*(line[-1, :2] + ahead.max() * direction), track[np.argmax(ahead), 2]]]])


def _append_track(line, track):
    direction = _direction(line[::-1]) * -1.0
    ahead = (track[:, :2] - line[-1, :2]) @ direction
    aside = (track[:, :2] - line[-1, :2]) @ np.array([-direction[1], direction[0]])
    if not (abs(ahead[0]) < FRAME.junction_gap and abs(aside[0]) < FRAME.max_lateral_jump
            and abs(track[0, 2] - line[-1, 2]) < FRAME.level_separation):
        return None
    if np.arccos(np.clip(_direction(track) @ direction, -1, 1)) > FRAME.parallel_angle:
        return None
    beyond = track[int(np.argmax(ahead > 1.0)):] if (ahead > 1.0).any() else track[:0]
    if len(beyond) < 3:
        return None
    driven = np.r_[0.0, np.cumsum(np.hypot(*np.diff(beyond[:, :2], axis=0).T))]
    if _comes_back(line, beyond, driven):
        return None
    step = np.gradient(beyond[:, :2], axis=0)
    left = np.c_[-step[:, 1], step[:, 0]] / np.maximum(np.hypot(*step.T), 1e-9)[:, None]
    share = np.clip(1.0 - driven / FRAME.lane_blend_length, 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    beyond = beyond.copy()
    beyond[:, :2] -= left * (aside[0] * share)[:, None]
    return np.concatenate([line, beyond])


def _comes_back(line, beyond, driven):
    """Whether a continuation approaches the line anywhere but at its end: a position would have two stations."""
    left = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[::-1, :2], axis=0).T))][::-1]
    for old, new in ((line[left > 3 * FRAME.same_carriageway], beyond), (line, beyond[driven > 3 * FRAME.same_carriageway])):
        if len(old) and len(new) and cKDTree(old[:, :2]).query(new[:, :2])[0].min() < FRAME.same_carriageway:
            return True
    return False


def _direction(line):
    """Unit vector of the first five metres of a line."""
    far = np.hypot(*(line[:, :2] - line[0, :2]).T) > 5.0
    step = line[int(np.argmax(far)) if far.any() else -1, :2] - line[0, :2]
    return step / max(np.hypot(*step), 1e-9)
