"""Station and offset of many points at once: a lookup along the trajectory, then the foot on the reference line.

The vehicle's station at a point's time says where on the road the foot is sought.
A few steps from node to node of the reference line come within a node of it (one where
the road is straight), and there the foot follows in closed form (`LineTable`). The few points that this does not reach
(in tight bends, far beside the road) are followed step by step with `Road.locate`.
"""

import numpy as np

from .driven_pass import MOST_TICKS, TICK
from .kept_arrays import KeptArrays
from .line_table import LineTable
from .points import UNIT
from .reference_line import NODE

AT_ONCE = 100_000     # points worked at a time: of fewer more time goes into waiting for Python's lock, of many more into waiting for memory
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
        self._lines = [LineTable(road) for road in frame.roads]
        self._kept = KeptArrays()
        self._ticks = [_Ticks(p, frame.road(p.road)) for p in frame.passes]

    def place(self, x, y, time):
        """Pass, station and offset of local places, to the unit of 0.1 mm in which points are kept.

        Parameters
        ----------
        x, y, time : (N,) float64

        Returns
        -------
        pass_number : (N,) int16; -1 where no pass was driven at the point's time
        s, d : (N,) float64; NaN beyond the corridor or the road's ends, as `Road.locate` tells them
        """
        s, d = np.empty((2, len(x)), np.int32)
        passes, inside = self.put(*(np.rint(np.asarray(v) / UNIT).astype(np.int64) for v in (x, y)), time, s, d)
        s, d = s * UNIT, d * UNIT
        if inside is not None:
            s[~inside] = d[~inside] = np.nan
        return passes, s, d

    def put(self, x, y, time, s, d):
        """Put stations and offsets of local places into s and d, (N,) int32 in units of 0.1 mm; places are int32 or int64.

        Returns
        -------
        pass_number : (N,) int16; -1 where no pass was driven at the point's time
        inside : (N,) bool: which have a place; None where all have. Stations and offsets of the others mean nothing.
        """
        passes, inside = self._owner(time), None
        for first in range(0, len(x), AT_ONCE):
            part = slice(first, first + AT_ONCE)
            here = self._part(passes[part], x[part], y[part], time[part], s[part], d[part])
            if here is not None:
                inside = np.ones(len(x), bool) if inside is None else inside
                inside[part] = here
        return passes, inside

    def _part(self, owner, x, y, time, s, d):
        lowest = int(owner[0]) if owner.strides[0] == 0 else int(owner.min())
        if lowest >= 0 and (owner.strides[0] == 0 or lowest == owner.max()):
            return self._feet(lowest, x, y, time, s, d)
        inside = np.zeros(len(x), bool)
        for number in np.unique(owner[owner >= 0]).tolist():
            rows = np.flatnonzero(owner == number)
            own_s, own_d = np.empty((2, len(rows)), np.int32)
            there = self._feet(number, x[rows], y[rows], time[rows], own_s, own_d)
            s[rows], d[rows] = own_s, own_d
            inside[rows] = True if there is None else there
        return inside

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
        line = self._lines[self.frame.passes[number].road]
        return line.feet(x, y, self._ticks[number].node(time, kept), self.corridor, s, d, kept)


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
        k = kept("start", np.intp)
        np.copyto(k, at, casting="unsafe")
        np.copyto(k, self.nodes.take(k, out=kept("node", np.int32), mode="clip"))
        return k
