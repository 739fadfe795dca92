"""What every fitted curve can do: give points along itself, heading, curvature, and the foot of a point."""

from dataclasses import asdict, dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial import cKDTree

TABLE_STEP = 0.25  # m between the nodes from which arc length is found where it has no formula


class Curve:
    """A plane curve walked by arc length u, 0 at its start, `length` at its end.

    `at`, `heading` and `curvature` go on beyond both ends in the way of the curve
    (an arc stays an arc), except that a polynomial and a B-spline go on straight.
    Curvature is positive where the curve turns left; offsets are left positive.
    """

    kind = ""

    def at(self, u):
        """(N, 2) places at arc lengths u (N,)."""
        raise NotImplementedError

    def heading(self, u):
        """(N,) radians counter-clockwise from the x axis, continuous along the curve."""
        raise NotImplementedError

    def curvature(self, u):
        """(N,) 1/m."""
        raise NotImplementedError

    @property
    def radius(self):
        """Metres where the curve is one arc, NaN otherwise."""
        return float("nan")

    def foot(self, x, y, near=None):
        """Arc length of the foot and left-positive distance of places.

        Parameters
        ----------
        x, y : (N,) metres
        near : (N,) arc lengths near the feet where they are known; else the nearest foot is looked for

        Returns
        -------
        u, e : (N,) metres; beyond an end, e is measured from the curve gone on.
        """
        x, y = np.asarray(x, float), np.asarray(y, float)
        if near is None:
            nodes = np.linspace(0.0, self.length, max(3, int(np.ceil(self.length)) + 1))
            near = nodes[cKDTree(self.at(nodes)).query(np.stack([x, y], axis=1))[1]]
        u = near
        for _ in range(8):
            along, e, bend = self._gap(x, y, u)
            step = along / np.minimum(np.maximum(1.0 - bend * e, 0.3), 3.0)
            u = u + np.minimum(np.maximum(step, -2.0), 2.0) if self.length > 2.0 else u + step
            if not len(step) or np.abs(step).max() < 1e-9:
                break
        return u, self._gap(x, y, u)[1]

    def _gap(self, x, y, u):
        """How far places lie ahead of arc lengths u and left of them, and the curvature there."""
        places, heading = self.at(u), self.heading(u)
        dx, dy = x - places[:, 0], y - places[:, 1]
        c, s = np.cos(heading), np.sin(heading)
        return dx * c + dy * s, dy * c - dx * s, self.curvature(u)

    def sample(self, step=0.5):
        """(M, 2) places from end to end, evenly spaced by at most `step` metres."""
        return self.at(np.linspace(0.0, self.length, max(2, int(np.ceil(self.length / step - 1e-9)) + 1)))

    def params(self):
        """The curve's numbers as a dict that JSON can hold; `curve_of` makes the curve again."""
        return {"curve": self.kind, **asdict(self)}

    def moved(self, dx, dy):
        """The same curve shifted by (dx, dy): from local to map coordinates."""
        raise NotImplementedError

    def reversed(self):
        """The same curve walked from its other end (only where `walks_back`)."""
        raise NotImplementedError


class TabledCurve(Curve):
    """A curve with a parameter t whose arc length is known from a table; needs `_span`, `_place`, `_slope`, `_bend`."""

    def _table(self):
        found = self.__dict__.get("_nodes")
        if found is None:
            first, last = self._span()
            rough = self._place(np.linspace(first, last, 200))
            length = np.hypot(*np.diff(rough, axis=0).T).sum()
            # Gauss-Legendre between nodes: exact to the micrometre for any road
            t = np.linspace(first, last, max(8, int(np.ceil(length / TABLE_STEP))) + 1)
            g, w = np.polynomial.legendre.leggauss(3)
            h = np.diff(t)[:, None]
            speed = np.hypot(*self._slope((t[:-1, None] + h * (g + 1) / 2).ravel()).T).reshape(len(h), 3)
            u = np.r_[0.0, np.cumsum((speed * w * np.abs(h) / 2).sum(1))]
            slope = self._slope(t)
            inverse = CubicHermiteSpline(u, t, np.sign(last - first) / np.hypot(slope[:, 0], slope[:, 1]))
            found = u, inverse, t, np.unwrap(np.arctan2(slope[:, 1], slope[:, 0]))
            object.__setattr__(self, "_nodes", found)
        return found

    @property
    def length(self):
        return float(self._table()[0][-1])

    def _t(self, u):
        nodes, inverse, *_ = self._table()
        inside = np.clip(np.asarray(u, float), 0.0, nodes[-1])
        return inverse(inside), np.asarray(u, float) - inside

    def u_of(self, t):
        """(N,) arc lengths at parameters t, to a millimetre or so."""
        u, _, nodes, _ = self._table()
        return np.interp(t, *_rising(nodes, u))

    def _gap(self, x, y, u):
        t, beyond = self._t(u)
        places, (sx, sy), (bx, by) = self._place(t), self._slope(t).T, self._bend(t).T
        speed = np.hypot(sx, sy)
        c, s = sx / speed, sy / speed
        dx, dy = x - places[:, 0] - beyond * c, y - places[:, 1] - beyond * s
        bend = np.where(np.abs(beyond) < 1e-6, (sx * by - sy * bx) / speed**3, 0.0)
        return dx * c + dy * s, dy * c - dx * s, bend

    def at(self, u):
        t, beyond = self._t(u)
        slope = self._slope(t)
        return self._place(t) + beyond[:, None] * slope / np.hypot(slope[:, 0], slope[:, 1])[:, None]

    def heading(self, u):
        t, _ = self._t(u)
        slope = self._slope(t)
        turn = np.arctan2(slope[:, 1], slope[:, 0])
        near = np.interp(t, *_rising(*self._table()[2:]))
        return turn + 2 * np.pi * np.round((near - turn) / (2 * np.pi))

    def curvature(self, u):
        t, beyond = self._t(u)
        (dx, dy), (ax, ay) = self._slope(t).T, self._bend(t).T
        return np.where(np.abs(beyond) < 1e-6, (dx * ay - dy * ax) / (dx * dx + dy * dy) ** 1.5, 0.0)


def _rising(t, values):
    return (t, values) if t[-1] >= t[0] else (t[::-1], values[::-1])


def _arc_step(turn):
    """sin(a)/a and (1 - cos(a))/a, also at a = 0."""
    small = np.abs(turn) < 1e-5
    safe = np.where(small, 1.0, turn)
    return np.where(small, 1.0 - turn**2 / 6, np.sin(safe) / safe), np.where(small, turn / 2, (1 - np.cos(safe)) / safe)


@dataclass(frozen=True)
class Arc(Curve):
    """A circular arc, and with curvature 0 a straight line, from (x, y) in direction `direction`.

    In this form nothing becomes infinite as a curve straightens.
    """

    x: float
    y: float
    direction: float  # radians
    bend: float       # curvature, 1/m
    length: float

    @property
    def kind(self):
        return "circle" if self.bend else "line"

    @property
    def radius(self):
        return abs(1.0 / self.bend) if self.bend else float("nan")

    @property
    def centre(self):
        """(x, y) of the circle's centre; only where `bend` is not 0."""
        return self.x - np.sin(self.direction) / self.bend, self.y + np.cos(self.direction) / self.bend

    def at(self, u):
        u = np.asarray(u, float)
        along, across = (f * u for f in _arc_step(self.bend * u))
        c, s = np.cos(self.direction), np.sin(self.direction)
        return np.c_[self.x + along * c - across * s, self.y + along * s + across * c]

    def heading(self, u):
        return self.direction + self.bend * np.asarray(u, float)

    def curvature(self, u):
        return np.full(np.shape(u), float(self.bend))

    def foot(self, x, y, near=None):
        dx, dy = np.asarray(x, float) - self.x, np.asarray(y, float) - self.y
        c, s, k = np.cos(self.direction), np.sin(self.direction), self.bend
        along, across = dx * c + dy * s, dy * c - dx * s
        if not k:
            return along, across
        # |p - centre| in a form that keeps its digits when k goes to 0
        lift = 2 * across - k * (along**2 + across**2)
        e = lift / (1 + np.sqrt(np.maximum(1 - k * lift, 0.0)))
        u = np.arctan2(k * along, 1 - k * across) / k
        turn = 2 * np.pi / abs(k)
        return u + turn * np.round((self.length / 2 - u) / turn), e

    def params(self):
        numbers = super().params()
        if self.bend:
            numbers["centre"], numbers["radius"] = [float(c) for c in self.centre], self.radius
        return numbers

    def moved(self, dx, dy):
        return Arc(self.x + dx, self.y + dy, self.direction, self.bend, self.length)

    def reversed(self):
        (x, y), = self.at(np.array([self.length]))
        return Arc(float(x), float(y), float(self.heading(self.length)) + np.pi, -self.bend, self.length)

    def parallel(self, distance):
        """The exact parallel curve, left positive: again an arc about the same centre."""
        scale = 1.0 - self.bend * distance
        return Arc(self.x - distance * np.sin(self.direction), self.y + distance * np.cos(self.direction),
                   self.direction, self.bend / scale, self.length * scale)
