"""The road frame: station and offset of any place, and the way back to the map.

A road's reference line is the smoothed track of its longest pass, kept as nodes
0.1 m apart. Position and heading are interpolated between nodes, and a point's
station is where the normal of the line passes through it: the frame that both
published methods speak, and in which every stage works.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from ..errors import RoadExtractionError
from .passes import moving_rows, split_into_passes, thin_by_distance
from .trajectory import clean_trajectory

NODE = 0.1         # m between nodes of the reference line: 0.02 mm of sagitta at R = 60 m
SMOOTHING = 2.0    # m, sigma: takes jitter out of the heading; d is measured from the result anyway
EXTENSION = 10.0   # m that the frame reaches beyond the driven part: scanners look ahead and behind
CORRIDOR = 25.0    # m either side
JOIN_DISTANCE = 12.0          # m between two passes over one carriageway
JOIN_ANGLE = np.radians(30.0)
JOIN_LENGTH = 20.0            # m that two passes must share


class Road:
    """One carriageway's reference line in local coordinates.

    Station 0 is where the longest pass began; offset is left positive.
    """

    def __init__(self, number, nodes_x, nodes_y, start):
        self.number = number
        self.start = start
        self.x, self.y = nodes_x, nodes_y
        dx, dy = np.gradient(nodes_x, NODE), np.gradient(nodes_y, NODE)
        self._heading = np.unwrap(np.arctan2(dy, dx))
        self._cos, self._sin = np.cos(self._heading), np.sin(self._heading)
        self._curvature = np.gradient(self._heading, NODE)
        self.end = start + NODE * (len(nodes_x) - 1)
        self.length = self.end - EXTENSION
        self._tree = None

    def _at(self, s):
        u = np.clip((np.asarray(s, float) - self.start) / NODE, 0, len(self.x) - 1)
        k = np.minimum(u.astype(np.int64), len(self.x) - 2)
        return k, u - k

    def _line(self, s):
        """Position and unit tangent of the reference line at s."""
        k, f = self._at(s)
        x = self.x[k] + f * (self.x[k + 1] - self.x[k])
        y = self.y[k] + f * (self.y[k + 1] - self.y[k])
        c = self._cos[k] + f * (self._cos[k + 1] - self._cos[k])
        n = self._sin[k] + f * (self._sin[k + 1] - self._sin[k])
        return x, y, c, n

    def heading(self, s):
        """Direction of the reference line, radians counter-clockwise from east."""
        k, f = self._at(s)
        return self._heading[k] + f * (self._heading[k + 1] - self._heading[k])

    def curvature(self, s):
        """1/m, positive where the road turns left."""
        k, f = self._at(s)
        return self._curvature[k] + f * (self._curvature[k + 1] - self._curvature[k])

    def to_map(self, s, d):
        """Local x, y of station s and offset d (straight on beyond the ends)."""
        s, d = np.asarray(s, float), np.asarray(d, float)
        x, y, c, n = self._line(s)
        beyond = s - np.clip(s, self.start, self.end)
        return x + beyond * c - d * n, y + beyond * n + d * c

    def locate(self, x, y, start=None, corridor=CORRIDOR):
        """Station and offset of local places.

        Parameters
        ----------
        x, y : (N,) local metres
        start : (N,) a station near the right foot (from gps_time), or None for the nearest foot
        corridor : largest |offset|, metres

        Returns
        -------
        s, d : (N,) metres; NaN beyond the frame's ends, outside the corridor, or at the
            inner side of a bend beyond 0.9 of its radius, where normals cross.
        """
        x, y = np.asarray(x, float), np.asarray(y, float)
        if start is None:
            start = self.nearest_station(x, y, corridor)
        s = np.array(start, float)
        lost = ~np.isfinite(s)
        s[lost] = self.start
        d = np.empty(len(s))
        active = np.arange(len(s))
        # Newton on the along-track component; most points settle in three steps
        for _ in range(12):
            px, py, c, n = self._line(s[active])
            ex, ey = x[active] - px, y[active] - py
            along, across = ex * c + ey * n, ey * c - ex * n
            d[active] = across
            step = along / np.clip(1.0 - self.curvature(s[active]) * across, 0.4, 2.5)
            s[active] = np.clip(s[active] + np.clip(step, -30, 30), self.start - 1.0, self.end + 1.0)
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

    def nearest_station(self, x, y, corridor=CORRIDOR):
        """Station of the nearest node of the line, NaN where none is within the corridor."""
        if self._tree is None:
            self._tree = cKDTree(np.c_[self.x[::5], self.y[::5]])
        distance, index = self._tree.query(np.c_[x, y], distance_upper_bound=corridor * 1.05 + 1.0)
        return np.where(np.isfinite(distance), self.start + 5 * NODE * index, np.nan)


@dataclass
class Pass:
    """One run of the vehicle along a road.

    time, x, y, z (local), s, d: (N,) the vehicle's own samples in the road's frame.
    direction: +1 along the reference line, -1 against it.
    """

    number: int
    road: int
    direction: int
    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    d: np.ndarray
    _by_station: tuple = field(default=None, repr=False)

    def position(self, time):
        """Local x, y, z of the vehicle at the given times."""
        return tuple(np.interp(time, self.time, c) for c in (self.x, self.y, self.z))

    def station_at(self, time):
        """Road station of the vehicle at the given times."""
        return np.interp(time, self.time, self.s)

    def at_station(self, s):
        """Offset and height of the vehicle's track where it passes station s."""
        if self._by_station is None:
            order = np.argsort(self.s, kind="stable")
            self._by_station = self.s[order], self.d[order], self.z[order]
        stations, d, z = self._by_station
        return np.interp(s, stations, d), np.interp(s, stations, z)

    @property
    def span(self):
        """(first, last) station driven."""
        return float(self.s.min()), float(self.s.max())


@dataclass
class RoadFrame:
    """All roads and passes of a survey; `origin` is what local coordinates leave out."""

    origin: np.ndarray
    roads: list
    passes: list
    crs: str = ""
    has_time: bool = True
    notes: tuple = ()

    def road(self, number):
        return self.roads[number]

    def passes_of(self, road):
        return [p for p in self.passes if p.road == road]

    def to_local(self, x, y, z=None):
        """Map coordinates to local ones."""
        local = np.asarray(x, float) - self.origin[0], np.asarray(y, float) - self.origin[1]
        return local if z is None else local + (np.asarray(z, float) - self.origin[2],)

    def to_map(self, road, s, d, z=None):
        """Map coordinates of station and offset on a road (number)."""
        x, y = self.roads[road].to_map(s, d)
        found = x + self.origin[0], y + self.origin[1]
        return found if z is None else found + (np.asarray(z, float) + self.origin[2],)

    def track_height(self, road, s):
        """(N,) local z of the trajectory at stations of a road: the mean of the passes that were there."""
        s = np.asarray(s, float)
        total, count = np.zeros(s.shape), np.zeros(s.shape)
        passes = self.passes_of(road)
        for p in passes:
            first, last = p.span
            there = (s >= first) & (s <= last)
            total += np.where(there, p.at_station(s)[1], 0.0)
            count += there
        longest = max(passes, key=lambda p: p.span[1] - p.span[0])
        return np.where(count > 0, total / np.maximum(count, 1), longest.at_station(s)[1])

    def locate_nearest(self, x, y, corridor=CORRIDOR):
        """Road number, s and d of local places by the nearest foot; road is -1 where there is none."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        best_road = np.full(len(x), -1)
        best_s, best_d = np.full(len(x), np.nan), np.full(len(x), np.nan)
        for road in self.roads:
            s, d = road.locate(x, y, corridor=corridor)
            better = np.isfinite(d) & ~(np.abs(d) >= np.abs(np.where(np.isnan(best_d), np.inf, best_d)))
            best_road[better], best_s[better], best_d[better] = road.number, s[better], d[better]
        return best_road, best_s, best_d


def build_frame(trajectory):
    """Roads and passes of a trajectory.

    The drive is cut into passes; the longest becomes the reference of the first
    road; what runs within 12 m of it and parallel, either way, is a further pass
    over the same road; what is left makes the next road.
    """
    trajectory = clean_trajectory(trajectory)
    origin = np.floor([trajectory.x.min(), trajectory.y.min(), trajectory.z.min()])
    x, y, z = trajectory.x - origin[0], trajectory.y - origin[1], trajectory.z - origin[2]
    waiting = [(piece.first, piece.last) for piece in split_into_passes(trajectory)]
    roads, passes = [], []
    while waiting:
        waiting.sort(key=lambda rows: (-_driven(x, y, rows), rows))
        first, last = waiting.pop(0)
        if roads and _driven(x, y, (first, last)) < JOIN_LENGTH:
            continue
        road = _reference_line(len(roads), x[first:last], y[first:last])
        roads.append(road)
        members, rest = [(first, last)], []
        for rows in waiting:
            shared, left = _shared_with(road, x, y, rows)
            members += shared
            rest += left
        waiting = rest
        for a, b in sorted(members):
            passes.append(_make_pass(road, trajectory.time[a:b], x[a:b], y[a:b], z[a:b]))
    passes.sort(key=lambda p: p.time[0])
    for number, p in enumerate(passes):
        p.number = number
    return RoadFrame(origin, roads, passes, trajectory.crs, trajectory.has_time, trajectory.notes)


def _driven(x, y, rows):
    a, b = rows
    kept = a + thin_by_distance(x[a:b], y[a:b], 1.0)
    return float(np.hypot(np.diff(x[kept]), np.diff(y[kept])).sum())


def _reference_line(number, x, y):
    rows = moving_rows(x, y)
    x, y = x[rows], y[rows]
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    unique = np.r_[True, np.diff(driven) > 0]
    driven, x, y = driven[unique], x[unique], y[unique]
    if len(driven) < 2:
        raise RoadExtractionError("The trajectory does not move: at least 1 m of driving is needed to define a road.")
    u = np.arange(0.0, driven[-1] + NODE / 2, NODE)
    x, y = _smooth(np.interp(u, driven, x)), _smooth(np.interp(u, driven, y))
    x, y = _extend(x, y)
    along = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    u = np.arange(0.0, along[-1], NODE)
    return Road(number, np.interp(u, along, x), np.interp(u, along, y), -EXTENSION)


def _smooth(values):
    """Gaussian along the line, mirrored through its end points so that these stay."""
    pad = min(int(4 * SMOOTHING / NODE), len(values) - 1)
    head = 2 * values[0] - values[1:pad + 1][::-1]
    tail = 2 * values[-1] - values[-pad - 1:-1][::-1]
    return gaussian_filter1d(np.r_[head, values, tail], SMOOTHING / NODE)[pad:pad + len(values)]


def _extend(x, y):
    reach = min(int(3.0 / NODE), len(x) - 1)
    steps = np.arange(1, int(round(EXTENSION / NODE)) + 1) * NODE

    def beyond(tip, inner):
        direction = np.array([x[tip] - x[inner], y[tip] - y[inner]])
        direction /= np.hypot(*direction)
        return x[tip] + steps * direction[0], y[tip] + steps * direction[1]

    hx, hy = beyond(0, reach)
    tx, ty = beyond(-1, len(x) - 1 - reach)
    return np.r_[hx[::-1], x, tx], np.r_[hy[::-1], y, ty]


def _shared_with(road, x, y, rows):
    """The parts of a driven piece that run along a road, and the parts that do not."""
    a, b = rows
    kept = a + thin_by_distance(x[a:b], y[a:b], 2.0)
    s, d = road.locate(x[kept], y[kept], corridor=JOIN_DISTANCE)
    direction = np.arctan2(np.gradient(y[kept]), np.gradient(x[kept])) if len(kept) > 1 else np.zeros(len(kept))
    turned = np.abs((direction - road.heading(np.where(np.isnan(s), 0, s)) + np.pi / 2) % np.pi - np.pi / 2)
    along = np.isfinite(d) & (turned < JOIN_ANGLE)
    along = _fill_runs(along, int(JOIN_LENGTH / 2))
    along = ~_fill_runs(~along, int(JOIN_LENGTH / 2))
    if along.all():
        return [rows], []
    if not along.any():
        return [], [rows]
    cuts = np.r_[0, np.flatnonzero(np.diff(along.astype(int))) + 1, len(kept)]
    shared, left = [], []
    for i, j in zip(cuts[:-1], cuts[1:]):
        piece = (int(kept[i]), int(kept[j]) if j < len(kept) else b)
        (shared if along[i] else left).append(piece)
    return shared, left


def _fill_runs(mask, shortest):
    """Turn runs of False shorter than `shortest` into True."""
    mask = mask.copy()
    cuts = np.r_[0, np.flatnonzero(np.diff(mask.astype(int))) + 1, len(mask)]
    for i, j in zip(cuts[:-1], cuts[1:]):
        if not mask[i] and j - i < shortest:
            mask[i:j] = True
    return mask


def _make_pass(road, time, x, y, z):
    # The vehicle's own foot is found by walking: each sample starts from the nearest node.
    s, d = road.locate(x, y, corridor=2 * JOIN_DISTANCE)
    good = np.isfinite(s)
    if not good.any():
        s = np.clip(road.nearest_station(x, y, np.inf), road.start, road.end)
        d = np.zeros(len(x))
    else:
        rows = np.arange(len(x))
        s, d = np.interp(rows, rows[good], s[good]), np.interp(rows, rows[good], d[good])
    direction = 1 if s[-1] >= s[0] else -1
    return Pass(0, road.number, direction, time, x, y, z, s, d)
