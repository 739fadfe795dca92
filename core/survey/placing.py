"""Station and offset of many points at once: a lookup along the trajectory, then the foot on the reference line.

The vehicle's station at a point's time says where on the road the foot is sought.
A few steps from node to node of the reference line come within a node of it (one where
the road is straight), and within one node the foot follows in closed form, as the line
between nodes is straight and its direction turns evenly. The few points that this does not reach (in tight bends, far
beside the road) are followed step by step with `Road.locate`.
"""

import numpy as np

from .driven_pass import MOST_TICKS, TICK
from .reference_line import NODE

AT_ONCE = 1 << 15     # points worked at a time: what fits the processor's cache
MOST_STEPS = 3        # from node to node for the few points that one step from the vehicle's node leaves beside their own
BESIDE = 1e-3         # of a node beyond its ends: the direction there is that of the next one to 1e-6
CLOCK_SLACK = 1.0     # s that a cloud may begin before or end after the trajectory


class Placing:
    """Places points of a survey with times in its road frame.

    Parameters
    ----------
    frame : RoadFrame
    corridor : metres either side
    """

    def __init__(self, frame, corridor):
        self.frame, self.corridor = frame, corridor
        self.starts = np.array([p.time[0] for p in frame.passes])
        self.ends = np.array([p.time[-1] for p in frame.passes])
        self._lines = [_Line(road) for road in frame.roads]
        self._ticks = [_Ticks(p, frame.road(p.road)) for p in frame.passes]

    def place(self, x, y, time):
        """Pass, station and offset of local places.

        Parameters
        ----------
        x, y, time : (N,) float64

        Returns
        -------
        pass_number : (N,) int16; -1 where no pass was driven at the point's time
        s, d : (N,) float64; NaN beyond the corridor or the road's ends, as `Road.locate` tells them
        """
        s, d = np.empty(len(x)), np.empty(len(x))
        passes = self._owner(time)
        for first in range(0, len(x), AT_ONCE):
            part = slice(first, first + AT_ONCE)
            owner = passes[part]
            lowest = int(owner.min())
            if lowest == owner.max() and lowest >= 0:
                s[part], d[part] = self._feet(lowest, x[part], y[part], time[part])
                continue
            ps, pd = s[part], d[part]
            ps[:] = np.nan
            pd[:] = np.nan
            for number in np.unique(owner):
                if number >= 0:
                    rows = np.flatnonzero(owner == number)
                    ps[rows], pd[rows] = self._feet(int(number), x[part][rows], y[part][rows], time[part][rows])
        return passes, s, d

    def _owner(self, time):
        """Pass that drove at each time: within it, or within a second of its ends; -1 where none did."""
        if not len(time):
            return np.empty(0, np.int16)
        low, high = time.min(), time.max()
        k = int(np.searchsorted(self.starts, low, side="right")) - 1
        if k >= 0 and high <= self.ends[k] and (k + 1 == len(self.starts) or high < self.starts[k + 1] - CLOCK_SLACK):
            return np.full(len(time), k, np.int16)
        k = np.clip(np.searchsorted(self.starts, time + CLOCK_SLACK, side="right") - 1, 0, None)
        # between two passes that follow on each other the earlier one ends where the later begins
        k = np.where((k > 0) & (time < self.starts[k]) & (time <= self.ends[np.maximum(k - 1, 0)]), k - 1, k)
        inside = (time >= self.starts[k] - CLOCK_SLACK) & (time <= self.ends[k] + CLOCK_SLACK)
        return np.where(inside, k, -1).astype(np.int16)

    def _feet(self, number, x, y, time):
        road = self.frame.passes[number].road
        node = self._ticks[number].node(time)
        return self._lines[road].feet(x, y, node, self.corridor)


class _Ticks:
    """The node of the reference line beside the vehicle, tick by tick of a pass."""

    def __init__(self, driven, road):
        self.first, span = driven.time[0], driven.time[-1] - driven.time[0]
        self.tick = max(TICK, span / MOST_TICKS)
        times = self.first + self.tick * np.arange(int(span / self.tick) + 2)
        self.nodes = np.clip((np.interp(times, driven.time, driven.s) - road.start) / NODE, 0, len(road.x) - 2).astype(np.int32)

    def node(self, time):
        """(N,) intp node numbers; the ends serve times before and after the pass."""
        k = ((time - self.first) * (1.0 / self.tick)).astype(np.intp)
        return self.nodes.take(k, mode="clip")


class _Line:
    """A road's reference line in tables by node, for the step from node to node and the foot within one."""

    def __init__(self, road):
        self.road = road
        self.last = len(road.x) - 2
        x, y, c, n = road.x, road.y, road._cos, road._sin
        self.x, self.y, self.c, self.n = x, y, c, n
        self.bend = road._curvature
        dx, dy, dc, dn = (np.diff(v, append=v[-1:]) for v in (x, y, c, n))
        self.dc, self.dn = dc, dn
        self.length, self.sag, self.turn = dx * c + dy * n, dx * n - dy * c, dx * dn - dy * dc

    def _seen_from(self, k, x, y):
        """Metres east and north of a node, its direction, metres ahead of it and to its left, and the bend there."""
        c, n = self.c.take(k), self.n.take(k)
        east, north = self.x.take(k), self.y.take(k)
        np.subtract(x, east, out=east)
        np.subtract(y, north, out=north)
        ahead, left = east * c, north * c
        ahead += north * n
        left -= east * n
        return east, north, c, n, ahead, left, self.bend.take(k)

    @staticmethod
    def _nodes_on(ahead, left, bend):
        """How many nodes on, a whole number, the place lies that a node sees so far ahead and to its left."""
        on = left * bend
        np.subtract(1.0, on, out=on)
        np.clip(on, 0.4, 2.5, out=on)
        np.divide(ahead, on, out=on)
        np.clip(on, -30.0, 30.0, out=on)
        on *= 1.0 / NODE
        return np.floor(on, out=on)

    def _moved(self, k, on):
        k = k + on.astype(np.intp)
        return np.clip(k, 0, self.last, out=k)

    def feet(self, x, y, k, corridor):
        """Station and offset of places near whose foot node k lies; NaN as `Road.locate` has it."""
        start = k
        k = self._moved(start, self._nodes_on(*self._seen_from(start, x, y)[4:]))
        seen = self._seen_from(k, x, y)
        on = self._nodes_on(*seen[4:])
        rows = np.flatnonzero(on != 0)
        on = on.take(rows)
        for _ in range(MOST_STEPS):
            if not len(rows):
                break
            k[rows] = self._moved(k.take(rows), on)
            again = self._seen_from(k.take(rows), x.take(rows), y.take(rows))
            for whole, part in zip(seen, again):
                whole[rows] = part
            on = self._nodes_on(*again[4:])
            left_over = np.flatnonzero(on)
            rows, on = rows.take(left_over), on.take(left_over)
        x0, y0, _, _, ahead, left, bend = seen
        dc, dn = self.dc.take(k), self.dn.take(k)
        # (E - f D) . (T + f T') = 0 for the share f of the node; D . T' is nothing beside D . T
        share = ahead / (self.length.take(k) - x0 * dc - y0 * dn)
        d = left + share * (y0 * dc - x0 * dn + self.sag.take(k) + share * self.turn.take(k))
        s = self.road.start + (k + share) * NODE
        near = (share >= -BESIDE) & (share <= 1.0 + BESIDE) & (np.abs(left * bend) < 0.55)
        inside = near & (s >= self.road.start) & (s < self.road.end) & (np.abs(d) <= corridor)
        if not inside.all():
            s[~inside] = d[~inside] = np.nan
            far = np.flatnonzero(~near & (np.abs(left) < 1.5 * corridor + 5.0))
            if len(far):
                ahead = self._seen_from(start[far], x[far], y[far])[4]
                s[far], d[far] = self.road.locate(x[far], y[far], self.road.start + start[far] * NODE + ahead, corridor)
        return s, d
