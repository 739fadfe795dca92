"""Plane curves parametrised by arc length (position, heading, curvature, orthogonal projection), and the result of fitting one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial import cKDTree

from ..common.parallel import check_cancelled
from .robust import percentiles
from .weights import FITS


class Curve:
    """A plane curve as a function of arc length u: 0 at its start, `length` at its end. A subclass is a frozen dataclass.

    `at`, `heading` and `curvature` extrapolate beyond both ends as the curve itself does (an arc stays an arc); a polynomial and a B-spline
    continue straight. Curvature is positive where the curve turns left; offsets are positive to the left.
    """

    kind: str = ""  # one of CURVES but "automatic"
    length: float   # m

    def at(self, u: np.ndarray) -> np.ndarray:
        """(N, 2) positions, metres, at (N,) arc lengths u."""
        raise NotImplementedError

    def heading(self, u: np.ndarray | float) -> np.ndarray:
        """(N,) headings at arc lengths u, radians counter-clockwise from the x axis, continuous along the curve."""
        raise NotImplementedError

    def curvature(self, u: np.ndarray | float) -> np.ndarray:
        """(N,) curvatures at arc lengths u, 1/m."""
        raise NotImplementedError

    @property
    def radius(self) -> float:
        """Radius in metres if the curve is one arc, else NaN."""
        return float("nan")

    def project(self, x: np.ndarray, y: np.ndarray, near: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Orthogonal projection of (N,) points onto the curve, by Newton's method.

        near : (N,) arc lengths near the projections, if known; else the nearest points of the curve are searched

        Returns
            u : (N,) arc lengths of the projections, metres
            e : (N,) distances, metres, positive left of the curve; beyond an end, from the extrapolated curve
        """
        x, y = np.asarray(x, float), np.asarray(y, float)
        if near is None:
            nodes = np.linspace(0.0, self.length, max(3, int(np.ceil(self.length)) + 1))
            near = nodes[cKDTree(self.at(nodes)).query(np.stack([x, y], axis=1))[1]]
        u = near
        for _ in range(FITS.max_projection_steps):
            along, e, curvature = self._separation(x, y, u)
            step = along / np.minimum(np.maximum(1.0 - curvature * e, 0.3), 3.0)
            u = u + np.minimum(np.maximum(step, -2.0), 2.0) if self.length > 2.0 else u + step
            if not len(step) or np.abs(step).max() < FITS.projection_tolerance:
                break
        return u, self._separation(x, y, u)[1]

    def _separation(self, x, y, u):
        """Distances of points ahead and left of the curve at arc lengths u, and the curvature there."""
        points, heading = self.at(u), self.heading(u)
        dx, dy = x - points[:, 0], y - points[:, 1]
        c, s = np.cos(heading), np.sin(heading)
        return dx * c + dy * s, dy * c - dx * s, self.curvature(u)

    def sample(self, step: float = 0.5) -> np.ndarray:
        """(M, 2) points from end to end, evenly spaced by at most `step` metres."""
        return self.at(np.linspace(0.0, self.length, max(2, int(np.ceil(self.length / step - 1e-9)) + 1)))

    def params(self) -> dict[str, Any]:
        """The curve's parameters as a dict for JSON."""
        return {"curve": self.kind, **asdict(self)}  # type: ignore[call-overload]

    def moved(self, dx: float, dy: float) -> Curve:
        """The curve shifted by (dx, dy) metres: from local to map coordinates."""
        return replace(self, x=self.x + dx, y=self.y + dy)  # type: ignore[type-var, attr-defined]


class TabulatedCurve(Curve):
    """A curve of a parameter t, with a table of arc lengths.

    Subclasses define `_place`, `_slope` and `_bend` (position and its first and second derivative by t, (N, 2)).
    """

    first: float   # first, last: t at start and end, of those that have no knots
    last: float
    _place: Callable[[np.ndarray], np.ndarray]
    _slope: Callable[[np.ndarray], np.ndarray]
    _bend: Callable[[np.ndarray], np.ndarray]
    tilt: float   # radians, direction of the axis of those that have one

    def _span(self):
        return self.first, self.last

    @cached_property
    def _table(self):
        """(arc lengths (M,), t as a function of arc length, t (M,), headings (M,)) at the nodes."""
        first, last = self._span()
        rough = self._place(np.linspace(first, last, 200))
        length = np.hypot(*np.diff(rough, axis=0).T).sum()
        # Gauss-Legendre between nodes: exact to the micrometre for any road
        t = np.linspace(first, last, max(8, int(np.ceil(length / FITS.arc_length_step))) + 1)
        g, w = np.polynomial.legendre.leggauss(3)
        h = np.diff(t)[:, None]
        speed = np.hypot(*self._slope((t[:-1, None] + h * (g + 1) / 2).ravel()).T).reshape(len(h), 3)
        u = np.r_[0.0, np.cumsum((speed * w * np.abs(h) / 2).sum(1))]
        slope = self._slope(t)
        inverse = CubicHermiteSpline(u, t, np.sign(last - first) / np.hypot(slope[:, 0], slope[:, 1]))
        return u, inverse, t, np.unwrap(np.arctan2(slope[:, 1], slope[:, 0]))

    @property
    def length(self) -> float:  # type: ignore[override]
        return float(self._table[0][-1])

    def _turned(self, along, across):
        """(N, 2) of coordinates along and across the axis."""
        c, s = np.cos(self.tilt), np.sin(self.tilt)
        return np.c_[along * c - across * s, along * s + across * c]

    def _t(self, u):
        """(t, metres beyond an end) at arc lengths u."""
        nodes, inverse, *_ = self._table
        inside = np.clip(np.asarray(u, float), 0.0, nodes[-1])
        return inverse(inside), np.asarray(u, float) - inside

    def _separation(self, x, y, u):
        t, beyond = self._t(u)
        points, (sx, sy), (bx, by) = self._place(t), self._slope(t).T, self._bend(t).T
        speed = np.hypot(sx, sy)
        c, s = sx / speed, sy / speed
        dx, dy = x - points[:, 0] - beyond * c, y - points[:, 1] - beyond * s
        curvature = np.where(np.abs(beyond) < FITS.end_tolerance, (sx * by - sy * bx) / speed**3, 0.0)
        return dx * c + dy * s, dy * c - dx * s, curvature

    def u_of(self, t: np.ndarray) -> np.ndarray:
        """(N,) arc lengths, metres, at parameters t, to a millimetre or so."""
        u, _, nodes, _ = self._table
        return np.interp(t, *_rising(nodes, u))

    def at(self, u: np.ndarray) -> np.ndarray:
        t, beyond = self._t(u)
        slope = self._slope(t)
        return self._place(t) + beyond[:, None] * slope / np.hypot(slope[:, 0], slope[:, 1])[:, None]

    def heading(self, u: np.ndarray | float) -> np.ndarray:
        t, _ = self._t(u)
        slope = self._slope(t)
        heading = np.arctan2(slope[:, 1], slope[:, 0])
        near = np.interp(t, *_rising(*self._table[2:]))
        return heading + 2 * np.pi * np.round((near - heading) / (2 * np.pi))

    def curvature(self, u: np.ndarray | float) -> np.ndarray:
        t, beyond = self._t(u)
        (dx, dy), (ax, ay) = self._slope(t).T, self._bend(t).T
        return np.where(np.abs(beyond) < FITS.end_tolerance, (dx * ay - dy * ax) / (dx * dx + dy * dy) ** 1.5, 0.0)


def _rising(t, values):
    return (t, values) if t[-1] >= t[0] else (t[::-1], values[::-1])


@dataclass(frozen=True)
class Arc(Curve):
    """A circular arc, or a straight line where `bend` is 0. This form has no parameter that becomes infinite as the curve straightens."""

    x: float   # x, y: start, metres
    y: float
    direction: float   # heading at the start, radians
    bend: float   # curvature, 1/m, positive to the left
    length: float   # metres

    @property
    def kind(self) -> str:  # type: ignore[override]
        return "circle" if self.bend else "line"

    @property
    def radius(self) -> float:
        return abs(1.0 / self.bend) if self.bend else float("nan")

    def at(self, u: np.ndarray) -> np.ndarray:
        u = np.asarray(u, float)
        turn = self.bend * u
        small = np.abs(turn) < 1e-5
        safe = np.where(small, 1.0, turn)
        along = np.where(small, 1.0 - turn**2 / 6, np.sin(safe) / safe) * u
        across = np.where(small, turn / 2, (1 - np.cos(safe)) / safe) * u
        c, s = np.cos(self.direction), np.sin(self.direction)
        return np.column_stack([self.x + along * c - across * s, self.y + along * s + across * c])

    def heading(self, u: np.ndarray | float) -> np.ndarray:
        return self.direction + self.bend * np.asarray(u, float)

    def curvature(self, u: np.ndarray | float) -> np.ndarray:
        return np.full(np.shape(u), float(self.bend))

    def project(self, x: np.ndarray, y: np.ndarray, near: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
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

    def params(self) -> dict[str, Any]:
        numbers = super().params()
        if self.bend:
            centre = self.x - np.sin(self.direction) / self.bend, self.y + np.cos(self.direction) / self.bend
            numbers["centre"], numbers["radius"] = [float(c) for c in centre], self.radius
        return numbers

    def reversed(self) -> Arc:
        (x, y), = self.at(np.array([self.length]))
        return Arc(float(x), float(y), float(self.heading(self.length)) + np.pi, -self.bend, self.length)

    def parallel(self, distance: float) -> Arc:
        """The exact parallel curve at a distance in metres, positive to the left: an arc about the same centre."""
        scale = 1.0 - self.bend * distance
        return Arc(self.x - distance * np.sin(self.direction), self.y + distance * np.cos(self.direction),
                   self.direction, self.bend / scale, self.length * scale)


# The result of a fit: a curve with its residuals and information criteria.


@dataclass(frozen=True)
class CurveFit:
    """A curve and how well it fits."""

    curve: Any   # Curve, as a rule; the fits of splines put their unfinished curve here
    residuals: np.ndarray   # (N,) signed orthogonal distances of the points, metres, positive left of the curve
    parameters: float   # number of free parameters of the curve (for BIC and AIC); a smoothing spline has an effective number

    @property
    def rmse(self) -> float:
        """Root mean square of the orthogonal residuals, metres; outliers count in full."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @cached_property
    def residual_p95(self) -> float:
        """95th percentile of the absolute residuals, metres."""
        return percentiles(np.abs(self.residuals), (95.0,))[0]

    @cached_property
    def bic(self) -> float:
        """Bayesian information criterion ``n ln(RSS/n) + p ln n``, with the soft L1 loss that was minimised as RSS."""
        n = len(self.residuals)
        mean_loss = 2 * FITS.soft_l1_scale**2 * np.sum(np.sqrt(1 + (self.residuals / FITS.soft_l1_scale) ** 2) - 1) / n
        return float(n * np.log(max(mean_loss, FITS.noise_floor**2)) + self.parameters * np.log(n))


def bic_lower_bound(points: int, parameters: float) -> float:
    """Lower bound of the BIC of every fit to so many points with at least so many parameters."""
    return points * np.log(FITS.noise_floor**2) + parameters * np.log(points)


def checked_points(x: np.ndarray, y: np.ndarray, min_points: int) -> tuple[np.ndarray, np.ndarray]:
    """The points of a line, x and y (N,) metres, as float64; `min_points` is how many the curve needs.

    Raises ValueError if the arrays differ in shape or are too short: a mistake of the caller, not of the data.
    """
    check_cancelled()  # every fit begins here, and a long drive has hundreds
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.shape != y.shape or x.ndim != 1 or len(x) < min_points:
        raise ValueError(f"a curve needs x and y of one length, at least {min_points} points; got {x.shape} and {y.shape}")
    return x, y
