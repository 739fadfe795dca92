"""A road's reference line by node, for the feet of many places at once.

Within one node the foot follows in closed form, as the line between nodes is straight and its direction turns evenly.
Places are whole units, so what lies between a place and a node is exact in whole numbers, and of single precision less
than a hundredth of a millimetre is lost: half the memory of double is moved.
"""

import numpy as np

from .kept_arrays import KeptArrays
from .points import UNIT, to_units
from .reference_line import NODE

STEP = round(NODE / UNIT)  # units from node to node
FINE = 4              # bits that places of nodes have beyond the unit
MOST_STEPS = 3        # from node to node for the few places that one step from the vehicle's node leaves beside their own
FARTHEST = 300.0      # nodes that a step leads on
BESIDE = 1e-3         # of a node beyond its ends: the direction there is that of the next one to 1e-6
CLEAR = 0.55          # of a bend's radius to its inner side, as far as the closed form is trusted
AHEAD = (0.4, 2.5)    # metres that a metre ahead may be along a bend, at the least and the most


class LineTable:
    """A road's reference line in tables by node.

    Lengths are in nodes (NODE metres) here, and `bend` is a place's metres left of the line over the radius there.
    """

    def __init__(self, road):
        self.road, self.last, self._few = road, len(road.x) - 2, KeptArrays()
        self.start = round(road.start / UNIT)
        self.end = self.start + STEP * (len(road.x) - 1)
        # where places have 64 bits, 32 of them tell them apart within the box about the line
        self._box = [(int(v.min() / UNIT), int(v.max() / UNIT)) for v in (road.x, road.y)]
        # 32 bits of fine units reach 13 km: what lies nearer to a node is told right wherever both are, for differences wrap as places do
        self.x, self.y = (np.rint(v / UNIT * 2**FINE).astype(np.int64).astype(np.int32) for v in (road.x, road.y))
        c, n = road._cos, road._sin
        dx, dy, dc, dn = (np.diff(v, append=v[-1:]) / NODE for v in (road.x, road.y, c, n))
        self.cos, self.sin = ((v / (STEP * 2**FINE)).astype(np.float32) for v in (c, n))
        self.turn, self.sag = (c * dn * NODE - n * dc * NODE).astype(np.float32), (dx * n - dy * c).astype(np.float32)

    def feet(self, x, y, start, corridor, s, d, kept):
        """Put stations and offsets of places near whose foot node `start` lies into s and d.

        Parameters
        ----------
        x, y : (N,) int32 or int64 local units of 0.1 mm
        start : (N,) intp
        corridor : metres either side
        s, d : (N,) int32 units, where there is no foot anything
        kept : of KeptArrays, for N

        Returns
        -------
        (N,) bool: which have a foot, as `Road.locate` tells it; None where all have
        """
        seen = [np.left_shift(places.astype(np.int32, copy=False), FINE, out=kept(name, np.int32)) for places, name in ((x, "x"), (y, "y"))]
        ahead, _, _, bend = self._seen_from(start, *seen, kept)
        k = self._moved(start, ahead, bend, kept)
        found = share, offset, left, bend, _ = self._foot(k, *seen, kept)
        if not _all_within(share, -BESIDE, 1.0 + BESIDE):
            self._carry_on(k, *seen, found)
        near = None
        if not (_all_within(share, -BESIDE, 1.0 + BESIDE) and _all_within(bend, -CLEAR, CLEAR)):
            near = _beside(share) & (np.abs(bend) < CLEAR)
        with np.errstate(invalid="ignore"):  # of what has no foot
            share *= STEP
            np.copyto(s, np.rint(share, out=share), casting="unsafe")
            offset *= STEP
            np.copyto(d, np.rint(offset, out=offset), casting="unsafe")
        k *= STEP
        k += self.start
        np.add(s, k, out=s, casting="unsafe")
        reach = int(corridor / UNIT)
        if x.dtype == np.int64:
            about = self._about(x, y, reach)
            if not about.all():
                near = about if near is None else near & about
        if near is None and _all_within(s, self.start, self.end - 1) and _all_within(d, -reach, reach):
            return None
        inside = (s >= self.start) & (s < self.end) & (d >= -reach) & (d <= reach)
        if near is not None:
            inside &= near
            self._follow(x, y, start, np.flatnonzero(~near & (np.abs(left) < (1.5 * corridor + 5.0) / NODE)), corridor, s, d, inside)
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
        if not _all_within(on, *AHEAD):
            np.clip(on, *AHEAD, out=on)
        np.divide(ahead, on, out=on)
        if not _all_within(on, -FARTHEST, FARTHEST):
            np.clip(on, -FARTHEST, FARTHEST, out=on)
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
        for _ in range(MOST_STEPS):
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
        ahead = (x * UNIT - road.x[k]) * road._cos[k] + (y * UNIT - road.y[k]) * road._sin[k]
        s_there, d_there = road.locate(x * UNIT, y * UNIT, road.start + k * NODE + ahead, corridor)
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
    return (share >= -BESIDE) & (share <= 1.0 + BESIDE)
