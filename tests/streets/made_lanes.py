"""Lanes whose truth is known: borders beside a curve, with successors where their ends meet."""

import numpy as np
from lanewright.core.curves.base import Arc
from lanewright.core.curves.clothoid import Clothoid
from lanewright.core.driving.layers import Lanes

CRS = "EPSG:25832"
ORIGIN = np.array([602000.0, 5792000.0, 70.0])


class Axis:
    """Curves end to end, from (x, y) with a heading: (kind, length, curvature at start, at end)."""

    def __init__(self, pieces, x=0.0, y=0.0, heading=0.0, slope=0.0, crown=0.0, crossfall=0.0):
        self.curves, self.slope, self.crown, self.crossfall = [], slope, crown, crossfall
        for length, first, last in pieces:
            curve = Arc(x, y, heading, first, length) if first == last else Clothoid(x, y, heading, first, (last - first) / length, length)
            self.curves.append(curve)
            (x, y), = curve.at(np.array([length]))
            heading = float(curve.heading(length))
        self.starts = np.append(0.0, np.cumsum([curve.length for curve in self.curves]))

    @property
    def length(self):
        return float(self.starts[-1])

    def at(self, s, t):
        """(N, 3) map coordinates at stations s and offsets t, left positive."""
        s, t = np.broadcast_arrays(np.asarray(s, float), np.asarray(t, float))
        k = np.clip(np.searchsorted(self.starts, s, side="right") - 1, 0, len(self.curves) - 1)
        plan, heading = np.empty((len(s), 2)), np.empty(len(s))
        for j, curve in enumerate(self.curves):
            rows = k == j
            plan[rows], heading[rows] = curve.at(s[rows] - self.starts[j]), curve.heading(s[rows] - self.starts[j])
        z = self.slope * s - self.crown * np.abs(t) + self.crossfall * t
        return np.c_[plan[:, 0] - t * np.sin(heading), plan[:, 1] + t * np.cos(heading), z] + ORIGIN


class LaneScene:
    """Collects pieces of lanes; `lanes()` links those whose ends meet."""

    def __init__(self):
        self.rows = []

    def add(self, axis, left, right, first=0.0, last=None, lane=1, piece=1, road=1, direction=1, step=1.0, **values):
        """A piece between two offsets (numbers or functions of s) of an axis."""
        last = axis.length if last is None else last
        s = np.linspace(first, last, max(int(round((last - first) / step)), 1) + 1)
        borders = [axis.at(s, side(s) if callable(side) else side) for side in (left, right)]
        if direction < 0:
            borders = [border[::-1] for border in borders[::-1]]
        self.piece(*borders, lane=lane, piece=piece, road=road, direction=direction, station=first, end=last, **values)

    def piece(self, left, right, lane=1, piece=1, road=1, direction=1, **values):
        """A piece between two lines in the direction of travel."""
        given = {"left_kind": "lane", "right_kind": "edge", "left_pattern": "dashed", "right_pattern": "solid", "confidence": 0.99, **values}
        self.rows.append(dict(left=left, right=right, road=road, lane=lane, lane_id=f"{road}.{lane}.{piece}", direction=direction, **given))

    def lanes(self):
        for row in self.rows:
            end = np.concatenate([row["left"][-1], row["right"][-1]])
            row["successors"] = [other["lane_id"] for other in self.rows if other is not row and row["direction"] and other["direction"]
                                 and np.abs(np.concatenate([other["left"][0], other["right"][0]]) - end).max() < 1e-6]
        return Lanes.of_pieces(self.rows, CRS)


def street(pieces=((60.0, 0.0, 0.0),), side="right", width=3.5, cut=None, **axis):
    """One lane each way on the axis; in left-hand traffic the one on the left goes along it. `cut`: station at which pieces end."""
    scene, line = LaneScene(), Axis(pieces, **axis)
    along = 1 if side == "right" else -1
    cuts = [0.0, line.length] if cut is None else [0.0, cut, line.length]
    for piece, (first, last) in enumerate(zip(cuts[:-1], cuts[1:]), start=1):
        scene.add(line, 0.0, -width, first, last, lane=1, piece=piece, direction=along, **kinds(side))
        scene.add(line, width, 0.0, first, last, lane=2, piece=piece, direction=-along, **kinds(side))
    return scene.lanes()


def kinds(side="right", outer="edge", pattern="solid"):
    """The fields of the borders of a lane beside the middle of a two-way road."""
    found = {"left_kind": "centre", "left_pattern": "dashed", "right_kind": outer, "right_pattern": pattern}
    if side == "left":
        found = {"right_kind": "centre", "right_pattern": "dashed", "left_kind": outer, "left_pattern": pattern}
    return found


def s_curve(**axis):
    """A street along a straight, a spiral, an arc, back by a spiral through a straight into an arc the other way."""
    bend = 1 / 80
    return street(((40.0, 0.0, 0.0), (30.0, 0.0, bend), (40.0, bend, bend), (30.0, bend, 0.0), (20.0, 0.0, 0.0), (30.0, 0.0, -bend),
                   (30.0, -bend, -bend)), **axis)


def widening(length=80.0, pieces=((80.0, 0.0, 0.0),)):
    """A one-way road of one lane whose width grows from 3 to 5 m, with a shoulder nobody drives on."""
    scene, line = LaneScene(), Axis(pieces)

    def right(s):
        share = np.clip((s - 20) / 40, 0, 1)
        return -3.0 - 2.0 * share**2 * (3 - 2 * share)
    scene.add(line, 0.0, right, lane=1)
    scene.add(line, right, lambda s: right(s) - 1.5, lane=2, type="shoulder", direction=0)
    return scene.lanes()


def split():
    """A one-way road on which a second lane begins on the right at 40 m, taking 20 m to reach its width, and ends at 100 m."""
    scene, line = LaneScene(), Axis(((140.0, 0.0, 0.0),))

    def right(s):
        share = np.clip((s - 40) / 20, 0, 1)
        return -3.5 - 3.25 * share**2 * (3 - 2 * share)
    for piece, (first, last) in enumerate(((0, 40), (40, 100), (100, 140)), start=1):
        scene.add(line, 0.0, -3.5, first, last, lane=1, piece=piece)
    scene.add(line, -3.5, right, 40, 100, lane=2)
    return scene.lanes()


def double_line(apart=0.3, patterns=("double-solid", "double-solid"), pieces=((60.0, 0.0, 0.0), (60.0, 1 / 60, 1 / 60))):
    """A street whose two lanes end at a stripe each; from 80 m on the stripes are one line."""
    scene, line = LaneScene(), Axis(pieces)

    def stripe(side):
        return lambda s: side * apart / 2 * np.clip((80.0 - s) / 20.0, 0, 1)
    for lane, (side, direction, pattern) in enumerate(((-1, 1, patterns[0]), (1, -1, patterns[1])), start=1):
        for piece, (first, last) in enumerate(((0.0, 60.0), (60.0, line.length)), start=1):
            borders = (stripe(-1), -3.5) if side < 0 else (3.5, stripe(1))
            scene.add(line, *borders, first, last, lane=lane, piece=piece, direction=direction,
                      **{**kinds(), "left_pattern": pattern, "left_line": f"line {lane}"})
    return scene.lanes()


def parting(island=1.5):
    """Two lanes one way that part at 60 m, on both sides of an island, and go on beside each other from 120 m."""
    scene, line = LaneScene(), Axis(((180.0, 0.0, 0.0),))

    def side(sign):
        def border(s):
            share = np.clip(np.minimum(s - 60, 120 - s) / 20, 0, 1)
            return sign * island * share**2 * (3 - 2 * share)
        return border
    for piece, (first, last) in enumerate(((0, 60), (60, 120), (120, 180)), start=1):
        scene.add(line, side(-1), lambda s: side(-1)(s) - 3.5, first, last, lane=1, piece=piece)
        scene.add(line, lambda s: side(1)(s) + 3.5, side(1), first, last, lane=2, piece=piece)
    return scene.lanes()


def crossing(arm=40.0, half=12.0, width=3.5):
    """Four arms of two lanes meet; straight on and both turns are connectors."""
    scene = LaneScene()
    arms = [Axis(((arm, 0.0, 0.0),), *(-(half + arm) * np.array([np.cos(a), np.sin(a)])), a) for a in np.arange(4) * np.pi / 2]
    for road, line in enumerate(arms, start=1):
        scene.add(line, 0.0, -width, lane=1, road=road, **kinds())
        scene.add(line, width, 0.0, lane=2, road=road, direction=-1, **kinds())
    number = 0
    for road, line in enumerate(arms, start=1):
        for other, away in enumerate(arms, start=1):
            if other == road:
                continue
            number += 1
            starts = [line.at([arm], [t])[0] for t in (0.0, -width)]
            ends = [away.at([arm], [t])[0] for t in (0.0, width)]
            way_in, way_out = line.curves[0].direction, away.curves[0].direction + np.pi
            borders = [hermite(a, b, way_in, way_out) for a, b in zip(starts, ends)]
            scene.piece(*borders, road=road, lane=number + 10, type="connector", left_kind="none", right_kind="none", left_pattern="",
                        right_pattern="", station=arm, end=arm, status="inferred", confidence=0.6)
    return scene.lanes()


def roundabout(arms=4, radius=16.0, width=4.5, arm=40.0, mouth=0.45):
    """Arms of two lanes meet a ring driven anticlockwise; connectors lead into it, out of it, and past every arm."""
    scene, number = LaneScene(), 10
    angles = 2 * np.pi * np.arange(arms) / arms
    inner, outer = radius - width / 2, radius + width / 2

    def ring(first, last):
        steps = np.linspace(first, last, max(int(round((last - first) * radius)), 8) + 1)
        return [np.c_[r * np.cos(steps), r * np.sin(steps), np.zeros(len(steps))] + ORIGIN for r in (inner, outer)]
    none = dict(type="connector", left_kind="none", right_kind="none", left_pattern="", right_pattern="", status="inferred", confidence=0.6)
    lines = []
    for road, angle in enumerate(angles, start=2):
        x, y = (outer + 12.0 + arm) * np.array([np.cos(angle), np.sin(angle)])
        line = Axis(((arm, 0.0, 0.0),), x, y, angle + np.pi)
        lines.append(line)
        scene.add(line, 0.0, -3.5, lane=1, road=road, **kinds())
        scene.add(line, 3.5, 0.0, lane=2, road=road, direction=-1, **kinds())
        scene.piece(*ring(angle + mouth, angle + 2 * np.pi / arms - mouth), road=1, lane=1, piece=road - 1)
    for road, (angle, line) in enumerate(zip(angles, lines), start=2):
        scene.piece(*ring(angle - mouth, angle + mouth), road=1, lane=number, **none)
        before, after = ([side[at] for side in ring(*way)] for at, way in ((-1, (angle - 1.0, angle - mouth)), (0, (angle + mouth, angle + 1.0))))
        ends = [line.at([arm], [t])[0] for t in (0.0, -3.5)]
        scene.piece(*(hermite(a, b, angle + np.pi, angle + mouth + np.pi / 2) for a, b in zip(ends, after)), road=road, lane=number + 1, **none)
        ends = [line.at([arm], [t])[0] for t in (0.0, 3.5)]
        scene.piece(*(hermite(a, b, angle - mouth + np.pi / 2, angle) for a, b in zip(before, ends)), road=1, lane=number + 2, **none)
        number += 3
    return scene.lanes()


def hermite(first, last, way_in, way_out, count=25):
    """A smooth line from place to place with given headings."""
    u = np.linspace(0, 1, count)[:, None]
    pull = np.hypot(*(last - first)[:2])
    m0, m1 = (pull * np.array([np.cos(a), np.sin(a), 0.0]) for a in (way_in, way_out))
    return ((2 * u**3 - 3 * u**2 + 1) * first + (u**3 - 2 * u**2 + u) * m0 + (-2 * u**3 + 3 * u**2) * last + (u**3 - u**2) * m1)
