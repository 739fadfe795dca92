"""What every fitted curve can do: give points along itself, heading, curvature, and the foot of a point."""

from dataclasses import asdict, dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial import cKDTree

from ..common.parallel import go_on

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


# What a fit of a curve gives back, and the robust least squares that all fits share.

F_SCALE = 0.03        # m: residuals beyond this count less and less (soft L1)
NOISE_FLOOR = 0.004   # m: below it a smaller residual is no reason for a more complex curve


@dataclass(frozen=True)
class Fit:
    """A curve with how well it fits.

    residuals : (N,) signed orthogonal distances of the points, left of the curve positive, metres
    parameters : how many free numbers the curve has (for BIC and AIC)
    """

    curve: object
    residuals: np.ndarray
    parameters: float

    @property
    def rmse(self):
        """Root mean square of the orthogonal residuals, metres; outliers count in full."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @cached_property
    def worst(self):
        """95 % of the residuals are smaller, metres."""
        return percentiles(np.abs(self.residuals), (95.0,))[0]

    @cached_property
    def _information(self):
        n = len(self.residuals)
        spread = 2 * F_SCALE**2 * np.sum(np.sqrt(1 + (self.residuals / F_SCALE) ** 2) - 1) / n
        return n * np.log(max(spread, NOISE_FLOOR**2))

    @property
    def bic(self):
        """n ln(RSS/n) + p ln n with the robust RSS that was minimised."""
        return float(self._information + self.parameters * np.log(len(self.residuals)))

    @property
    def aic(self):
        """n ln(RSS/n) + 2 p."""
        return float(self._information + 2 * self.parameters)


def least_bic(count, parameters):
    """What the BIC of no fit of `count` points with at least so many parameters is below."""
    return count * np.log(NOISE_FLOOR**2) + parameters * np.log(count)


def robust_weights(residuals):
    """(..., N) weights of soft L1: 1 for small residuals, falling as 1/|r| for large ones; each row has its own scale."""
    residuals = np.asarray(residuals)
    scale = np.maximum(F_SCALE, 1.4826 * medians(np.abs(residuals)))
    return 1.0 / np.sqrt(1.0 + (residuals / scale) ** 2)


def median(values):
    """Median of (N,) float, N >= 1, without NaN; np.median takes ten times as long over so few."""
    middle = (len(values) - 1) // 2, len(values) // 2
    ordered = np.partition(values, middle)
    return float(ordered[middle[0]] + ordered[middle[1]]) / 2


def percentiles(values, shares):
    """np.percentile of (N,) float, N >= 1, without NaN, at shares in %, each a float."""
    at = [share / 100 * (len(values) - 1) for share in shares]
    ranks = [(int(rank), min(int(rank) + 1, len(values) - 1)) for rank in at]
    ordered = np.partition(values, sorted({rank for pair in ranks for rank in pair}))
    found = []
    for rank, (low, high) in zip(at, ranks):
        share, low, high = rank - low, float(ordered[low]), float(ordered[high])
        found.append(low + (high - low) * share if share < 0.5 else high - (high - low) * (1 - share))
    return found


def medians(values):
    """(..., 1) median of every row of (..., N) float, N >= 1, without NaN."""
    low, high = (values.shape[-1] - 1) // 2, values.shape[-1] // 2
    ordered = np.partition(values, (low, high), axis=-1)
    return (ordered[..., low:low + 1] + ordered[..., high:high + 1]) / 2


def checked(x, y, least):
    """x, y as float arrays of one length, at least `least` points; ValueError otherwise (a caller's mistake)."""
    go_on()  # every fit begins here, and a long drive has hundreds
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.shape != y.shape or x.ndim != 1 or len(x) < least:
        raise ValueError(f"a curve needs x and y of one length, at least {least} points; got {x.shape} and {y.shape}")
    return x, y
