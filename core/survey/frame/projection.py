"""Station and offset of many points at once: a lookup by time along the trajectory, then the nearest point on the reference line.

Between two nodes the reference line is straight and its direction turns evenly, so the nearest point follows in closed
form. Coordinates are integers in units of 0.1 mm, so differences to a node are exact; single precision then loses less
than 0.01 mm and needs half the memory bandwidth of double precision.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...common.parallel import ScratchBuffers
from ..store.records import COORDINATE_SCALE, to_units
from ..weights import FRAME
from .road import NODE_SPACING, Road
from .road_frame import Pass, RoadFrame

Buffers = Callable[..., np.ndarray]   # what `ScratchBuffers.of` returns

NODE_UNITS = round(NODE_SPACING / COORDINATE_SCALE)  # derived: units of 0.1 mm from node to node
NODE_FRACTION_BITS = 4              # derived: bits by which coordinates of nodes are finer than the unit
NODE_TOLERANCE = 1e-3         # derived: of a node spacing beyond the ends: the direction differs from that of the next node by less than 1e-6


class _LineLookup:
    """The reference line of a road in tables by node.

    Lengths are in nodes (NODE_SPACING metres). `bend` is the offset of a point times the curvature of the line.
    """

    def __init__(self, road: Road):
        self.road, self.last, self._scratch = road, len(road.x) - 2, ScratchBuffers()
        self.start = round(road.start / COORDINATE_SCALE)
        self.end = self.start + NODE_UNITS * (len(road.x) - 1)
        # coordinates of 64 bits are cut to 32, which is unique within the bounding box of the line
        self._box = [(int(v.min() / COORDINATE_SCALE), int(v.max() / COORDINATE_SCALE)) for v in (road.x, road.y)]
        # 32 bits of fine units span 13 km; shorter differences are exact, because they wrap around as the coordinates do
        self.x, self.y = (np.rint(v / COORDINATE_SCALE * 2**NODE_FRACTION_BITS).astype(np.int64).astype(np.int32) for v in (road.x, road.y))
        c, n = road._cos, road._sin
        dx, dy, dc, dn = (np.diff(v, append=v[-1:]) / NODE_SPACING for v in (road.x, road.y, c, n))
        self.cos, self.sin = ((v / (NODE_UNITS * 2**NODE_FRACTION_BITS)).astype(np.float32) for v in (c, n))
        self.turn, self.sag = (c * dn * NODE_SPACING - n * dc * NODE_SPACING).astype(np.float32), (dx * n - dy * c).astype(np.float32)

    def project(self, x: np.ndarray, y: np.ndarray, start: np.ndarray, corridor: float, s: np.ndarray, d: np.ndarray,
                buffers: Buffers) -> np.ndarray | None:
        """Write stations and offsets of points into s and d, starting the search at node `start`.

        x, y : (N,) int32 or int64 local units of 0.1 mm
        start : (N,) intp, node near the wanted point on the line
        corridor : metres either side
        s, d : (N,) int32 units of 0.1 mm, overwritten; undefined outside the frame
        buffers : of `ScratchBuffers.of` for N values

        Returns (N,) bool: which points lie in the frame, as by `Road.locate`; None if all do.
        """
        fine_x, fine_y = (np.left_shift(values.astype(np.int32, copy=False), NODE_FRACTION_BITS, out=buffers(name, np.int32))
                          for values, name in ((x, "x"), (y, "y")))
        ahead, _, _, bend = self._seen_from(start, fine_x, fine_y, buffers)
        k = self._moved(start, ahead, bend, buffers)
        nearest = share, offset, left, bend, _ = self._nearest_point(k, fine_x, fine_y, buffers)
        if not _all_within(share, -NODE_TOLERANCE, 1.0 + NODE_TOLERANCE):
            self._carry_on(k, fine_x, fine_y, nearest)
        near = None
        if not (_all_within(share, -NODE_TOLERANCE, 1.0 + NODE_TOLERANCE) and _all_within(bend, -FRAME.closed_form_bend, FRAME.closed_form_bend)):
            near = _beside(share) & (np.abs(bend) < FRAME.closed_form_bend)
        with np.errstate(invalid="ignore"):  # points outside the frame
            for nodes, units in ((share, s), (offset, d)):
                nodes *= NODE_UNITS
                np.copyto(units, np.rint(nodes, out=nodes), casting="unsafe")
        k *= NODE_UNITS
        k += self.start
        np.add(s, k, out=s, casting="unsafe")
        reach = int(corridor / COORDINATE_SCALE)
        if x.dtype == np.int64:
            (west, east), (south, north) = self._box
            around = (x >= west - reach) & (x <= east + reach) & (y >= south - reach) & (y <= north + reach)
            if not around.all():
                near = around if near is None else near & around
        inside = self._inside(s, d, reach)
        if near is not None:
            inside = near if inside is None else inside & near
            self._follow(x, y, start, np.flatnonzero(~near & (np.abs(left) < (1.5 * corridor + 5.0) / NODE_SPACING)), corridor, s, d, inside)
        return inside

    def _inside(self, s, d, reach):
        """(N,) bool, which stations and offsets lie in the frame; None if all do."""
        if _all_within(s, self.start, self.end - 1) and _all_within(d, -reach, reach):
            return None
        return (s >= self.start) & (s < self.end) & (d >= -reach) & (d <= reach)

    def _away(self, values, nodes, k, buffers, name):
        """(N,) float32 fine units from nodes to points along one axis."""
        step = _of_nodes(nodes, k, buffers("step", np.int32))
        np.subtract(values, step, out=step)
        offset = buffers(name, np.float32)
        np.copyto(offset, step)
        return offset

    def _seen_from(self, k, x, y, buffers):
        """Distances ahead of node k and to its left, the turn of the line to the next node, and the bend; (N,) each."""
        east, north = self._away(x, self.x, k, buffers, "east"), self._away(y, self.y, k, buffers, "north")
        c, n = (_of_nodes(table, k, buffers(name, np.float32)) for table, name in ((self.cos, "c"), (self.sin, "n")))
        ahead = np.multiply(east, c, out=buffers("ahead", np.float32))
        north_n = np.multiply(north, n, out=buffers("bend", np.float32))
        ahead += north_n
        left = np.multiply(north, c, out=north)
        left -= np.multiply(east, n, out=east)
        turn = _of_nodes(self.turn, k, c)
        return ahead, left, turn, np.multiply(turn, left, out=north_n)

    def _moved(self, k, ahead, bend, buffers):
        on = np.subtract(np.float32(1.0), bend, out=buffers("n", np.float32))
        if not _all_within(on, *FRAME.bend_stretch):
            np.clip(on, *FRAME.bend_stretch, out=on)
        np.divide(ahead, on, out=on)
        if not _all_within(on, -FRAME.max_node_leap, FRAME.max_node_leap):
            np.clip(on, -FRAME.max_node_leap, FRAME.max_node_leap, out=on)
        moved = buffers("moved", np.intp)
        np.copyto(moved, np.floor(on, out=on), casting="unsafe")
        moved += k
        return moved if _all_within(moved, 0, self.last) else np.clip(moved, 0, self.last, out=moved)

    def _nearest_point(self, k, x, y, buffers):
        """Fraction from node k to the next of the nearest point, its offset, and `left`, `bend` and `ahead` as seen from node k."""
        ahead, left, turn, bend = self._seen_from(k, x, y, buffers)
        # (E - f D) . (T + f T') = 0 for the share f of the node; T' is the turn to the left, and D . T' nothing beside D . T
        part = np.subtract(np.float32(1.0), bend, out=buffers("n", np.float32))
        with np.errstate(divide="ignore", invalid="ignore"):  # at the centre of the bend
            share = np.divide(ahead, part, out=buffers("share", np.float32))
        # (E - f D) . (N + f N'), to the second order of the turn
        offset = np.multiply(turn, bend, out=turn)
        offset *= np.subtract(share, np.float32(0.5), out=part)
        offset += _of_nodes(self.sag, k, part)
        offset *= share
        offset += left
        return share, offset, left, bend, ahead

    def _carry_on(self, k, x, y, so_far):
        """Step to further nodes with the points whose nearest point lies beyond node k, and update `so_far`."""
        share, _, _, bend, ahead = so_far
        rows = np.flatnonzero(~_beside(share))
        bend, ahead = bend.take(rows), ahead.take(rows)
        x, y = x.take(rows), y.take(rows)
        for _ in range(FRAME.max_node_steps):
            if not len(rows):
                break
            buffers = self._scratch.of(len(rows))
            moved = self._moved(k.take(rows), ahead, bend, buffers)
            k[rows] = moved
            nearest = self._nearest_point(moved, x, y, buffers)
            for values, moved_values in zip(so_far[:4], nearest):
                values[rows] = moved_values
            on = np.flatnonzero(~_beside(nearest[0]))
            rows, x, y, bend, ahead = (column.take(on) for column in (rows, x, y, nearest[3], nearest[4]))

    def _follow(self, x, y, start, rows, corridor, s, d, inside):
        """Use `Road.locate` for rows outside the validity of the closed form."""
        if not len(rows):
            return
        road, (x, y) = self.road, (values.take(rows) for values in (x, y))
        k = start.take(rows)
        ahead = (x * COORDINATE_SCALE - road.x[k]) * road._cos[k] + (y * COORDINATE_SCALE - road.y[k]) * road._sin[k]
        s_there, d_there = road.locate(x * COORDINATE_SCALE, y * COORDINATE_SCALE, road.start + k * NODE_SPACING + ahead, corridor)
        inside_road = np.isfinite(s_there)
        rows = rows[inside_road]
        s[rows], d[rows] = to_units(s_there[inside_road]), to_units(d_there[inside_road])
        inside[rows] = True


def _of_nodes(table, k, out):
    # nodes are within bounds; "wrap" is faster than "clip" and needs no buffer as "raise" does
    return table.take(k, out=out, mode="wrap")


def _all_within(values, least, most):
    """Whether all values lie between two limits; False with NaN."""
    return values.min() >= least and values.max() <= most


def _beside(share):
    """Whether nearest points lie between their node and the next, within a tolerance."""
    return (share >= -NODE_TOLERANCE) & (share <= 1.0 + NODE_TOLERANCE)


class RoadProjection:
    """Station and offset of points with times, in a corridor of some metres either side."""

    def __init__(self, frame: RoadFrame, corridor: float):
        self.frame, self.corridor = frame, corridor
        self.starts = np.array([p.time[0] for p in frame.passes])
        self.ends = np.array([p.time[-1] for p in frame.passes])
        self._lines = [_LineLookup(road) for road in frame.roads]
        self._scratch = ScratchBuffers()
        self._ticks = [_PassClock(p, frame.road(p.road)) for p in frame.passes]

    def project(self, x: np.ndarray, y: np.ndarray, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pass, station and offset of (N,) local positions in metres at (N,) times, rounded to 0.1 mm.

        The pass is -1 where none was driven at the point's time; station and offset are NaN beyond the corridor or the ends of the road.
        """
        s, d = np.empty((2, len(x)), np.int32)
        units_x, units_y = (np.rint(np.asarray(v) / COORDINATE_SCALE).astype(np.int64) for v in (x, y))
        passes, inside = self.project_units(units_x, units_y, time, s, d)
        s, d = s * COORDINATE_SCALE, d * COORDINATE_SCALE
        if inside is not None:
            s[~inside] = d[~inside] = np.nan
        return passes, s, d

    def project_units(self, x: np.ndarray, y: np.ndarray, time: np.ndarray, s: np.ndarray,
                      d: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        """Write stations and offsets of local positions into s and d, all in units of 0.1 mm.

        x, y : (N,) int32 or int64
        time : (N,) s
        s, d : (N,) int32, overwritten; undefined where `inside` is False

        Returns
            pass_number : (N,) int16; -1 where no pass was driven at the time of the point
            inside : (N,) bool, which points lie in the road frame; None if all do
        """
        passes, inside = self._owner(time), None
        for first in range(0, len(x), FRAME.points_per_projection):
            part = slice(first, first + FRAME.points_per_projection)
            part_inside = self._part(passes[part], x[part], y[part], time[part], s[part], d[part])
            if part_inside is not None:
                inside = np.ones(len(x), bool) if inside is None else inside
                inside[part] = part_inside
        return passes, inside

    def _part(self, owner, x, y, time, s, d):
        lowest = int(owner[0]) if owner.strides[0] == 0 else int(owner.min())
        if lowest >= 0 and (owner.strides[0] == 0 or lowest == owner.max()):
            return self._project_pass(lowest, x, y, time, s, d)
        inside = np.zeros(len(x), bool)
        for number in np.unique(owner[owner >= 0]).tolist():
            rows = np.flatnonzero(owner == number)
            own_s, own_d = np.empty((2, len(rows)), np.int32)
            pass_inside = self._project_pass(number, x[rows], y[rows], time[rows], own_s, own_d)
            s[rows], d[rows] = own_s, own_d
            inside[rows] = True if pass_inside is None else pass_inside
        return inside

    def _owner(self, time):
        """Pass driven at each time, or within `clock_slack` of it; -1 where none was."""
        if not len(time):
            return np.empty(0, np.int16)
        low, high = time.min(), time.max()
        k = int(np.searchsorted(self.starts, low, side="right")) - 1
        if k >= 0 and high <= self.ends[k] and (k + 1 == len(self.starts) or high < self.starts[k + 1] - FRAME.clock_slack):
            return np.broadcast_to(np.int16(k), len(time))
        k = np.clip(np.searchsorted(self.starts, time + FRAME.clock_slack, side="right") - 1, 0, None)
        # within the slack of two passes, the time of the earlier one takes precedence
        k = np.where((k > 0) & (time < self.starts[k]) & (time <= self.ends[np.maximum(k - 1, 0)]), k - 1, k)
        inside = (time >= self.starts[k] - FRAME.clock_slack) & (time <= self.ends[k] + FRAME.clock_slack)
        return np.where(inside, k, -1).astype(np.int16)

    def _project_pass(self, number, x, y, time, s, d):
        buffers = self._scratch.of(len(x))
        line = self._lines[self.frame.passes[number].road]
        return line.project(x, y, self._ticks[number].node(time, buffers), self.corridor, s, d, buffers)


class _PassClock:
    """Lookup table by time of the node of the reference line beside the vehicle."""

    def __init__(self, driven: Pass, road: Road):
        self.first, span = driven.time[0], driven.time[-1] - driven.time[0]
        self.tick = max(FRAME.time_tick, span / FRAME.max_ticks)
        times = self.first + self.tick * np.arange(int(span / self.tick) + 2)
        self.nodes = np.clip((np.interp(times, driven.time, driven.s) - road.start) / NODE_SPACING, 0, len(road.x) - 2).astype(np.int32)

    def node(self, time, buffers):
        """(N,) intp node numbers; those of the ends before and after the pass."""
        ticks = np.subtract(time, self.first, out=buffers("at"))
        ticks *= 1.0 / self.tick
        k = buffers("start", np.intp)
        np.copyto(k, ticks, casting="unsafe")
        np.copyto(k, self.nodes.take(k, out=buffers("node", np.int32), mode="clip"))
        return k
