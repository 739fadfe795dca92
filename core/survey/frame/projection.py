"""A road's reference line by node, for the feet of many places at once.

Within one node the foot follows in closed form, as the line between nodes is straight and its direction turns evenly.
Places are whole units, so what lies between a place and a node is exact in whole numbers, and of single precision less
than a hundredth of a millimetre is lost: half the memory of double is moved.
"""

import numpy as np

from ...common.memory import ScratchBuffers
from ..store.records import COORDINATE_SCALE, to_units
from .passes import MAX_TICKS, TIME_TICK
from .reference_line import NODE_SPACING

NODE_UNITS = round(NODE_SPACING / COORDINATE_SCALE)  # units from node to node
NODE_FRACTION_BITS = 4              # bits that places of nodes have beyond the unit
MAX_NODE_STEPS = 3        # from node to node for the few places that one step from the vehicle's node leaves beside their own
MAX_NODE_LEAP = 300.0      # nodes that a step leads on
NODE_TOLERANCE = 1e-3         # of a node beyond its ends: the direction there is that of the next one to 1e-6
CLOSED_FORM_BEND = 0.55          # of a bend's radius to its inner side, as far as the closed form is trusted
BEND_STRETCH = (0.4, 2.5)    # metres that a metre ahead may be along a bend, at the least and the most


class LineLookup:
    """A road's reference line in tables by node.

    Lengths are in nodes (NODE_SPACING metres) here, and `bend` is a place's metres left of the line over the radius there.
    """

    def __init__(self, road):
        self.road, self.last, self._few = road, len(road.x) - 2, ScratchBuffers()
        self.start = round(road.start / COORDINATE_SCALE)
        self.end = self.start + NODE_UNITS * (len(road.x) - 1)
        # where places have 64 bits, 32 of them tell them apart within the box about the line
        self._box = [(int(v.min() / COORDINATE_SCALE), int(v.max() / COORDINATE_SCALE)) for v in (road.x, road.y)]
        # 32 bits of fine units reach 13 km: what lies nearer to a node is told right wherever both are, for differences wrap as places do
        self.x, self.y = (np.rint(v / COORDINATE_SCALE * 2**NODE_FRACTION_BITS).astype(np.int64).astype(np.int32) for v in (road.x, road.y))
        c, n = road._cos, road._sin
        dx, dy, dc, dn = (np.diff(v, append=v[-1:]) / NODE_SPACING for v in (road.x, road.y, c, n))
        self.cos, self.sin = ((v / (NODE_UNITS * 2**NODE_FRACTION_BITS)).astype(np.float32) for v in (c, n))
        self.turn, self.sag = (c * dn * NODE_SPACING - n * dc * NODE_SPACING).astype(np.float32), (dx * n - dy * c).astype(np.float32)

    def feet(self, x, y, start, corridor, s, d, kept):
        """Put stations and offsets of places near whose foot node `start` lies into s and d.

        Parameters
        ----------
        x, y : (N,) int32 or int64 local units of 0.1 mm
        start : (N,) intp
        corridor : metres either side
        s, d : (N,) int32 units, where there is no foot anything
        kept : of ScratchBuffers, for N

        Returns
        -------
        (N,) bool: which have a foot, as `Road.locate` tells it; None where all have
        """
        seen = [np.left_shift(places.astype(np.int32, copy=False), NODE_FRACTION_BITS, out=kept(name, np.int32))
                for places, name in ((x, "x"), (y, "y"))]
        ahead, _, _, bend = self._seen_from(start, *seen, kept)
        k = self._moved(start, ahead, bend, kept)
        found = share, offset, left, bend, _ = self._foot(k, *seen, kept)
        if not _all_within(share, -NODE_TOLERANCE, 1.0 + NODE_TOLERANCE):
            self._carry_on(k, *seen, found)
        near = None
        if not (_all_within(share, -NODE_TOLERANCE, 1.0 + NODE_TOLERANCE) and _all_within(bend, -CLOSED_FORM_BEND, CLOSED_FORM_BEND)):
            near = _beside(share) & (np.abs(bend) < CLOSED_FORM_BEND)
        with np.errstate(invalid="ignore"):  # of what has no foot
            share *= NODE_UNITS
            np.copyto(s, np.rint(share, out=share), casting="unsafe")
            offset *= NODE_UNITS
            np.copyto(d, np.rint(offset, out=offset), casting="unsafe")
        k *= NODE_UNITS
        k += self.start
        np.add(s, k, out=s, casting="unsafe")
        reach = int(corridor / COORDINATE_SCALE)
        if x.dtype == np.int64:
            about = self._about(x, y, reach)
            if not about.all():
                near = about if near is None else near & about
        if near is None and _all_within(s, self.start, self.end - 1) and _all_within(d, -reach, reach):
            return None
        inside = (s >= self.start) & (s < self.end) & (d >= -reach) & (d <= reach)
        if near is not None:
            inside &= near
            self._follow(x, y, start, np.flatnonzero(~near & (np.abs(left) < (1.5 * corridor + 5.0) / NODE_SPACING)), corridor, s, d, inside)
        return inside

    def _about(self, x, y, reach):
        """(N,) bool: which places lie in the box about the line, `reach` units wider; a road is too short for two that 32 bits do not tell apart."""
        (left, right), (bottom, top) = self._box
        return (x >= left - reach) & (x <= right + reach) & (y >= bottom - reach) & (y <= top + reach)

    def _away(self, places, nodes, k, kept, name):
        """(N,) float32 fine units from nodes to places, along one axis."""
        step = _of_nodes(nodes, k, kept("step", np.int32))
        np.subtract(places, step, out=step)
        away = kept(name, np.float32)
        np.copyto(away, step)
        return away

    def _seen_from(self, k, x, y, kept):
        """How far places lie ahead of node k and to its left, how the line turns from there to the next, and their bend."""
        east, north = self._away(x, self.x, k, kept, "east"), self._away(y, self.y, k, kept, "north")
        c, n = (_of_nodes(table, k, kept(name, np.float32)) for table, name in ((self.cos, "c"), (self.sin, "n")))
        ahead = np.multiply(east, c, out=kept("ahead", np.float32))
        north_n = np.multiply(north, n, out=kept("bend", np.float32))
        ahead += north_n
        left = np.multiply(north, c, out=north)
        left -= np.multiply(east, n, out=east)
        turn = _of_nodes(self.turn, k, c)
        return ahead, left, turn, np.multiply(turn, left, out=north_n)

    def _moved(self, k, ahead, bend, kept):
        """The node beside places that node k sees so far ahead, and with such a bend."""
        on = np.subtract(np.float32(1.0), bend, out=kept("n", np.float32))
        if not _all_within(on, *BEND_STRETCH):
            np.clip(on, *BEND_STRETCH, out=on)
        np.divide(ahead, on, out=on)
        if not _all_within(on, -MAX_NODE_LEAP, MAX_NODE_LEAP):
            np.clip(on, -MAX_NODE_LEAP, MAX_NODE_LEAP, out=on)
        moved = kept("moved", np.intp)
        np.copyto(moved, np.floor(on, out=on), casting="unsafe")
        moved += k
        return moved if _all_within(moved, 0, self.last) else np.clip(moved, 0, self.last, out=moved)

    def _foot(self, k, x, y, kept):
        """Share of node k at which the foot of each place lies, its offset, how far left of the node it lies, its bend, and how far ahead."""
        ahead, left, turn, bend = self._seen_from(k, x, y, kept)
        # (E - f D) . (T + f T') = 0 for the share f of the node; T' is the turn to the left, and D . T' nothing beside D . T
        part = np.subtract(np.float32(1.0), bend, out=kept("n", np.float32))
        with np.errstate(divide="ignore", invalid="ignore"):  # at the centre of the bend
            share = np.divide(ahead, part, out=kept("share", np.float32))
        # (E - f D) . (N + f N'), to the second order of the turn
        offset = np.multiply(turn, bend, out=turn)
        offset *= np.subtract(share, np.float32(0.5), out=part)
        offset += _of_nodes(self.sag, k, part)
        offset *= share
        offset += left
        return share, offset, left, bend, ahead

    def _carry_on(self, k, x, y, found):
        """Step on with the places whose foot lies beyond node k, and put what is found of them in its place."""
        share, _, _, bend, ahead = found
        rows = np.flatnonzero(~_beside(share))
        bend, ahead = bend.take(rows), ahead.take(rows)
        x, y = x.take(rows), y.take(rows)
        for _ in range(MAX_NODE_STEPS):
            if not len(rows):
                break
            few = self._few.of(len(rows))
            moved = self._moved(k.take(rows), ahead, bend, few)
            k[rows] = moved
            again = self._foot(moved, x, y, few)
            for whole, part in zip(found[:4], again):
                whole[rows] = part
            on = np.flatnonzero(~_beside(again[0]))
            rows, x, y, bend, ahead = (values.take(on) for values in (rows, x, y, again[3], again[4]))

    def _follow(self, x, y, start, rows, corridor, s, d, inside):
        """Put down what `Road.locate` finds of some rows, which the closed form does not reach."""
        if not len(rows):
            return
        road, (x, y) = self.road, (places.take(rows) for places in (x, y))
        k = start.take(rows)
        ahead = (x * COORDINATE_SCALE - road.x[k]) * road._cos[k] + (y * COORDINATE_SCALE - road.y[k]) * road._sin[k]
        s_there, d_there = road.locate(x * COORDINATE_SCALE, y * COORDINATE_SCALE, road.start + k * NODE_SPACING + ahead, corridor)
        found = np.isfinite(s_there)
        rows = rows[found]
        s[rows], d[rows] = to_units(s_there[found]), to_units(d_there[found])
        inside[rows] = True


def _of_nodes(table, k, out):
    # nodes are within bounds here; numpy makes sure of it faster so than with "clip", and needs no buffer as with "raise"
    return table.take(k, out=out, mode="wrap")


def _all_within(values, least, most):
    """Whether all numbers lie between two others; NaN does not."""
    return values.min() >= least and values.max() <= most


def _beside(share):
    """Whether feet lie within their node, or so little beyond that it serves them too."""
    return (share >= -NODE_TOLERANCE) & (share <= 1.0 + NODE_TOLERANCE)


# Station and offset of many points at once: a lookup along the trajectory, then the foot on the reference line.

POINTS_PER_PROJECTION = 100_000   # fewer points spend more time on Python's interpreter lock, many more on memory access
CLOCK_SLACK = 1.0     # s that a cloud may begin before or end after the trajectory


class RoadProjection:
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
        self._lines = [LineLookup(road) for road in frame.roads]
        self._kept = ScratchBuffers()
        self._ticks = [_PassClock(p, frame.road(p.road)) for p in frame.passes]

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
        passes, inside = self.put(*(np.rint(np.asarray(v) / COORDINATE_SCALE).astype(np.int64) for v in (x, y)), time, s, d)
        s, d = s * COORDINATE_SCALE, d * COORDINATE_SCALE
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
        for first in range(0, len(x), POINTS_PER_PROJECTION):
            part = slice(first, first + POINTS_PER_PROJECTION)
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


class _PassClock:
    """The node of the reference line beside the vehicle, tick by tick of a pass."""

    def __init__(self, driven, road):
        self.first, span = driven.time[0], driven.time[-1] - driven.time[0]
        self.tick = max(TIME_TICK, span / MAX_TICKS)
        times = self.first + self.tick * np.arange(int(span / self.tick) + 2)
        self.nodes = np.clip((np.interp(times, driven.time, driven.s) - road.start) / NODE_SPACING, 0, len(road.x) - 2).astype(np.int32)

    def node(self, time, kept):
        """(N,) intp node numbers; the ends serve times before and after the pass."""
        at = np.subtract(time, self.first, out=kept("at"))
        at *= 1.0 / self.tick
        k = kept("start", np.intp)
        np.copyto(k, at, casting="unsafe")
        np.copyto(k, self.nodes.take(k, out=kept("node", np.int32), mode="clip"))
        return k
