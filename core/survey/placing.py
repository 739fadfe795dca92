"""Station and offset of many points at once: a lookup along the trajectory, then the foot on the reference line.

The vehicle's station at a point's time says where on the road the foot is sought.
A few steps from node to node of the reference line come within a node of it (one where
the road is straight), and within one node the foot follows in closed form, as the line
between nodes is straight and its direction turns evenly. The few points that this does not reach (in tight bends, far
beside the road) are followed step by step with `Road.locate`.
"""

import numpy as np

from .driven_pass import MOST_TICKS, TICK
from .kept_arrays import KeptArrays
from .reference_line import NODE

AT_ONCE = 100_000     # points worked at a time: of fewer more time goes into waiting for Python's lock, of many more into waiting for memory
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
        self._kept = KeptArrays()
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
        return self.put(x, y, time, s, d), s, d

    def put(self, x, y, time, s, d):
        """The same: put stations and offsets into s and d, and return the passes."""
        passes = self._owner(time)
        for first in range(0, len(x), AT_ONCE):
            part = slice(first, first + AT_ONCE)
            owner = passes[part]
            lowest = int(owner[0]) if owner.strides[0] == 0 else int(owner.min())
            if lowest >= 0 and (owner.strides[0] == 0 or lowest == owner.max()):
                self._feet(lowest, x[part], y[part], time[part], s[part], d[part])
                continue
            ps, pd = s[part], d[part]
            ps[:] = np.nan
            pd[:] = np.nan
            for number in np.unique(owner):
                if number >= 0:
                    rows = np.flatnonzero(owner == number)
                    own_s, own_d = np.empty((2, len(rows)))
                    self._feet(int(number), x[part][rows], y[part][rows], time[part][rows], own_s, own_d)
                    ps[rows], pd[rows] = own_s, own_d
        return passes

    def _owner(self, time):
        """Pass that drove at each time: within it, or within a second of its ends; -1 where none did."""
        if not len(time):
            return np.empty(0, np.int16)
        low, high = time.min(), time.max()
        k = int(np.searchsorted(self.starts, low, side="right")) - 1
        if k >= 0 and high <= self.ends[k] and (k + 1 == len(self.starts) or high < self.starts[k + 1] - CLOCK_SLACK):
            return np.broadcast_to(np.int16(k), len(time))
        k = np.clip(np.searchsorted(self.starts, time + CLOCK_SLACK, side="right") - 1, 0, None)
        # between two passes that follow on each other the earlier one ends where the later begins
        k = np.where((k > 0) & (time < self.starts[k]) & (time <= self.ends[np.maximum(k - 1, 0)]), k - 1, k)
        inside = (time >= self.starts[k] - CLOCK_SLACK) & (time <= self.ends[k] + CLOCK_SLACK)
        return np.where(inside, k, -1).astype(np.int16)

    def _feet(self, number, x, y, time, s, d):
        kept = self._kept.of(len(x))
        road = self.frame.passes[number].road
        self._lines[road].feet(x, y, self._ticks[number].node(time, kept), self.corridor, s, d, kept)


class _Ticks:
    """The node of the reference line beside the vehicle, tick by tick of a pass."""

    def __init__(self, driven, road):
        self.first, span = driven.time[0], driven.time[-1] - driven.time[0]
        self.tick = max(TICK, span / MOST_TICKS)
        times = self.first + self.tick * np.arange(int(span / self.tick) + 2)
        self.nodes = np.clip((np.interp(times, driven.time, driven.s) - road.start) / NODE, 0, len(road.x) - 2).astype(np.int32)

    def node(self, time, kept):
        """(N,) intp node numbers; the ends serve times before and after the pass."""
        at = np.subtract(time, self.first, out=kept("at"))
        at *= 1.0 / self.tick
        k = kept("tick", np.intp)
        np.copyto(k, at, casting="unsafe")
        node = kept("start", np.intp)
        np.copyto(node, self.nodes.take(k, out=kept("node", np.int32), mode="clip"))
        return node


class _Line:
    """A road's reference line in tables by node, for the step from node to node and the foot within one."""

    def __init__(self, road):
        self.road = road
        self.last, self._few = len(road.x) - 2, KeptArrays()
        x, y, c, n = road.x, road.y, road._cos, road._sin
        self.x, self.y, self.c, self.n = x, y, c, n
        self.bend = road._curvature
        dx, dy, dc, dn = (np.diff(v, append=v[-1:]) for v in (x, y, c, n))
        self.dc, self.dn = dc, dn
        self.length, self.sag, self.turn = dx * c + dy * n, dx * n - dy * c, dx * dn - dy * dc

    def _seen_from(self, k, x, y, kept):
        """Metres east and north of a node, its direction, metres ahead of it and to its left, and these times the bend there."""
        c, n, bent = (table.take(k, out=kept(name), mode="clip") for name, table in (("c", self.c), ("n", self.n), ("bent", self.bend)))
        east, north = self.x.take(k, out=kept("east"), mode="clip"), self.y.take(k, out=kept("north"), mode="clip")
        np.subtract(x, east, out=east)
        np.subtract(y, north, out=north)
        ahead, left, part = np.multiply(east, c, out=kept("ahead")), np.multiply(north, c, out=kept("left")), kept("part")
        ahead += np.multiply(north, n, out=part)
        left -= np.multiply(east, n, out=part)
        bent *= left
        return east, north, c, n, ahead, left, bent

    def _moved(self, k, ahead, bent, kept):
        """The node beside places that node k sees so far ahead and beside a line so far bent."""
        on = np.subtract(1.0, bent, out=kept("part"))
        np.clip(on, 0.4, 2.5, out=on)
        np.divide(ahead, on, out=on)
        np.clip(on, -30.0, 30.0, out=on)
        on *= 1.0 / NODE
        moved = kept("moved", np.intp)
        np.copyto(moved, np.floor(on, out=on), casting="unsafe")
        moved += k
        return np.clip(moved, 0, self.last, out=moved)

    def _foot(self, k, x, y, kept):
        """Share of node k at which the foot of each place lies, its offset, metres left and ahead of the node, and how far the line is bent."""
        east, north, c, n, ahead, left, bent = self._seen_from(k, x, y, kept)
        # (E - f D) . (T + f T') = 0 for the share f of the node; D . T' is nothing beside D . T
        dc, dn = self.dc.take(k, out=c, mode="clip"), self.dn.take(k, out=n, mode="clip")
        part, share = kept("part"), self.length.take(k, out=kept("share"), mode="clip")
        share -= np.multiply(east, dc, out=part)
        share -= np.multiply(north, dn, out=part)
        np.divide(ahead, share, out=share)
        d = np.multiply(north, dc, out=north)
        d -= np.multiply(east, dn, out=part)
        d += self.sag.take(k, out=part, mode="clip")
        turn = self.turn.take(k, out=part, mode="clip")
        turn *= share
        d += turn
        d *= share
        d += left
        return share, d, left, ahead, bent

    def feet(self, x, y, start, corridor, s, d, kept):
        """Put station and offset of places near whose foot node `start` lies into s and d; NaN as `Road.locate` has it."""
        k = self._moved(start, *self._seen_from(start, x, y, kept)[4::2], kept)
        found = self._foot(k, x, y, kept)
        share, offset, left, ahead, bent = found
        rows = np.flatnonzero(~_beside(share))
        ahead = ahead.take(rows)
        for _ in range(MOST_STEPS):
            if not len(rows):
                break
            few = self._few.of(len(rows))
            moved = self._moved(k.take(rows), ahead, bent.take(rows), few)
            k[rows] = moved
            again = self._foot(moved, x.take(rows), y.take(rows), few)
            for whole, part in zip((share, offset, left, bent), (*again[:3], again[4])):
                whole[rows] = part
            left_over = np.flatnonzero(~_beside(again[0]))
            rows, ahead = rows.take(left_over), again[3].take(left_over)
        np.add(k, share, out=s)
        s *= NODE
        s += self.road.start
        d[:] = offset
        near = _beside(share) & (np.abs(bent, out=bent) < 0.55)
        inside = near & (s >= self.road.start) & (s < self.road.end) & (np.abs(d, out=offset) <= corridor)
        if not inside.all():
            s[~inside] = d[~inside] = np.nan
            far = np.flatnonzero(~near & (np.abs(left) < 1.5 * corridor + 5.0))
            if len(far):
                ahead = self._seen_from(start[far], x[far], y[far], self._few.of(len(far)))[4]
                s[far], d[far] = self.road.locate(x[far], y[far], self.road.start + start[far] * NODE + ahead, corridor)


def _beside(share):
    """Whether feet lie within their node, or so little beyond that it serves them too."""
    return (share >= -BESIDE) & (share <= 1.0 + BESIDE)
