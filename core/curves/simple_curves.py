"""Straight lines, circles, ellipses and polynomials through points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..common.errors import RoadExtractionError
from .base import Arc, CurveFit, TabulatedCurve, checked_points
from .robust import CurveProblem
from .weights import FITS


def fit_lines(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """Fit a straight Arc to each line, (x, y) of (N,) metres, N >= 2, ordered along it, by orthogonal, robust least squares.

    max_misfit : as of `CurveProblem.fitted`
    """
    return [_StraightProblem(*checked_points(x, y, 2)).fit(max_misfit) for x, y in lines]


def fit_circles(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """Fit an Arc to each line: Taubin's algebraic fit as start, then the geometric distance, robustly.

    The unknowns are heading, offset and curvature at the points' middle, so that a nearly straight line is as easy as a tight bend. Kasa's simpler
    fit is not used: it is biased towards small radii on short arcs.

    lines, max_misfit : as of `fit_lines`, N >= 3

    Source: Taubin (1991), IEEE PAMI 13, 1115-1138; Chernov (2010), Circular and linear regression, ch. 5-7.
    """
    return [_CircleProblem(*checked_points(x, y, 3)).fit(max_misfit) for x, y in lines]


def _taubin(x, y, direction):
    """Curvature of Taubin's circle through points; positive to the left of a direction."""
    x, y = x - x.mean(), y - y.mean()
    size = float(np.sqrt(np.mean(x**2 + y**2)))
    if not size:
        return 0.0
    # Taubin's constraint, reduced to the least eigenvector of a 3 x 3 matrix (Chernov's TaubinSVD)
    design = np.stack([((x**2 + y**2) / size**2 - 1) / 2, x / size, y / size])
    a, b, c = np.linalg.eigh(np.einsum("in,jn->ij", design, design))[1][:, 0]
    bend = abs(a) / max(np.sqrt(a * a + b * b + c * c), 1e-150) / size
    # the centre lies at (-b, -c) / a
    return bend * np.sign(a) * np.sign(b * np.sin(direction) - c * np.cos(direction)) if bend >= 1e-9 else 0.0


class _CircleProblem(CurveProblem):
    """A circle, by its offset, its turn from the direction of the points, and its curvature."""

    free_bend = True

    def start(self):
        size = max(float(np.sqrt(np.mean(self.x**2 + self.y**2))), 1e-3)
        bend = _taubin(self.x, self.y, self.direction) if self.free_bend else 0.0
        sagitta = np.mean(self.y) * np.cos(self.direction) - np.mean(self.x) * np.sin(self.direction)
        unknown = np.array([sagitta - bend * size**2 / 2, 0.0, bend])
        return unknown[:2 + self.free_bend], size ** -np.arange(2.0 + self.free_bend), np.zeros(len(self.x))

    def evaluate(self, unknown, along):
        turned = self.direction + unknown[1]
        c, s = np.cos(turned), np.sin(turned)
        ahead, across = self.x * c + self.y * s, self.y * c - self.x * s - unknown[0]
        if not self.free_bend:
            return across, np.stack([np.full(len(ahead), -1.0), -ahead]), along
        k, square = unknown[2], ahead**2 + across**2
        lift = 2 * across - k * square
        root = np.sqrt(np.maximum(1 - k * lift, 1e-12))
        e = lift / (1 + root)
        # how the distance changes with `across`, `ahead` and k
        by_across, by_ahead = (1 - k * across) / root, -k * ahead / root
        return e, np.stack([-by_across, by_ahead * (across + unknown[0]) - by_across * ahead, (e**2 - square) / (2 * root)]), along

    def fit(self, max_misfit):
        """The CurveFit, from the first point's projection to the last's."""
        unknown, distances, _ = self.fitted(max_misfit)
        turned = self.direction + unknown[1]
        arc = Arc(float(-unknown[0] * np.sin(turned)), float(unknown[0] * np.cos(turned)), float(turned),
                  float(unknown[2]) if self.free_bend else 0.0, 0.0)
        first, last = arc.project(self.x[[0, -1]], self.y[[0, -1]])[0].tolist()
        (x, y), = (arc.at(np.array([first])) + self.centre).tolist()
        return CurveFit(Arc(x, y, float(arc.heading(first)), arc.bend, last - first), distances, len(unknown))


class _StraightProblem(_CircleProblem):
    """A straight line, by its offset and its turn."""

    free_bend = False


# An ellipse through points.


@dataclass(frozen=True)
class Ellipse(TabulatedCurve):
    x: float   # x, y: centre, metres
    y: float
    a: float   # a, b: semi-axes, metres
    b: float
    tilt: float   # direction of axis a, radians
    first: float   # first, last: eccentric angles at start and end, radians; `first` is above `last` where the curve turns right
    last: float

    kind = "ellipse"

    def _place(self, t):
        return self._turned(self.a * np.cos(t), self.b * np.sin(t)) + [self.x, self.y]

    def _slope(self, t):
        # along the walk: t falls where the curve turns right
        return np.sign(self.last - self.first) * self._turned(-self.a * np.sin(t), self.b * np.cos(t))

    def _bend(self, t):
        return self._turned(-self.a * np.cos(t), -self.b * np.sin(t))


def fit_ellipse(x: np.ndarray, y: np.ndarray, max_misfit: float = np.inf) -> CurveFit:
    """Fit an Ellipse: Halir and Flusser's direct fit as start, then robust orthogonal distances.

    x, y : (N,) metres, N >= 6, ordered along the line
    max_misfit : metres; a fit with a larger root mean square residual is given up once steps gain little

    Raises RoadExtractionError if the points turn by less than 60 degrees or do not lie on an ellipse.

    Source: Halir and Flusser (1998), Numerically stable direct least squares fitting of ellipses.
    """
    problem = _EllipseProblem(*checked_points(x, y, 6))
    (cx, cy, a, b, tilt), outside, t = problem.fitted(max_misfit)
    t = np.unwrap(t)
    ellipse = Ellipse(float(cx), float(cy), abs(float(a)), abs(float(b)), float(tilt), float(t[0]), float(t[-1]))
    if abs(ellipse.heading(np.array([ellipse.length]))[0] - ellipse.heading(np.zeros(1))[0]) < FITS.min_ellipse_turn:
        raise RoadExtractionError(
            "The points turn by less than 60 degrees, where an ellipse cannot be distinguished from a circle. Choose curve = automatic or circle.")
    # outside the ellipse is right of a left turn
    return CurveFit(ellipse.moved(*problem.centre), -np.sign(t[-1] - t[0]) * outside, 5)


class _EllipseProblem(CurveProblem):
    """An ellipse, by its centre, its semi-axes and the direction of the first; places along it are eccentric angles."""

    def start(self):
        size = float(np.sqrt(np.mean(self.x**2 + self.y**2)))
        unknown = _direct(self.x / size, self.y / size)
        if unknown is None:
            raise RoadExtractionError("The points do not lie on an ellipse. Choose curve = automatic, circle or b-spline.")
        scale = np.array([size, size, size, size, 1.0])
        return unknown * scale, scale, np.zeros(len(self.x))

    def evaluate(self, unknown, along):
        cx, cy, a, b, tilt = unknown
        t, c, s = _nearest_angle(self.x, self.y, unknown), np.cos(tilt), np.sin(tilt)
        ahead, across = a * np.cos(t), b * np.sin(t)
        normal = np.stack([b * np.cos(t), a * np.sin(t)])
        right, up = normal / np.hypot(*normal)
        distances = ((self.x - cx) * c + (self.y - cy) * s - ahead) * right + ((self.y - cy) * c - (self.x - cx) * s - across) * up
        return distances, -np.stack([right * c - up * s, right * s + up * c, right * np.cos(t), up * np.sin(t), up * ahead - right * across]), t


def _direct(x, y):
    """(centre x, y, a, b, tilt) of the direct least-squares ellipse, or None."""
    squares, rest = np.c_[x * x, x * y, y * y], np.c_[x, y, np.ones_like(x)]
    s1, s2, s3 = (np.einsum("ni,nj->ij", *pair) for pair in ((squares, squares), (squares, rest), (rest, rest)))
    try:
        back = -np.linalg.solve(s3, s2.T)
    except np.linalg.LinAlgError:
        return None
    reduced = s1 + s2 @ back
    reduced = np.array([reduced[2] / 2, -reduced[1], reduced[0] / 2])
    values, vectors = np.linalg.eig(reduced)
    vectors = np.real(vectors)
    good = 4 * vectors[0] * vectors[2] - vectors[1] ** 2 > 0
    if not good.any():
        return None
    first = vectors[:, np.flatnonzero(good)[0]]
    a, b, c = first
    d, e, f = back @ first
    form = np.array([[a, b / 2], [b / 2, c]])
    centre = np.linalg.solve(-2 * form, [d, e])
    level = centre @ form @ centre - f
    values, axes = np.linalg.eigh(form)
    squared = level / values
    if not (squared > 0).all():
        return None
    return np.array([*centre, *np.sqrt(squared), np.arctan2(axes[1, 0], axes[0, 0])])


def _nearest_angle(x, y, unknown):
    """Eccentric angles of the nearest points of the ellipse, by Newton's method from the affine approximation."""
    cx, cy, a, b, tilt = unknown
    c, s = np.cos(tilt), np.sin(tilt)
    p, q = (x - cx) * c + (y - cy) * s, (y - cy) * c - (x - cx) * s
    t = np.arctan2(q * a, p * b)
    for _ in range(12):
        gap = (b * b - a * a) * np.cos(t) * np.sin(t) + p * a * np.sin(t) - q * b * np.cos(t)
        slope = (b * b - a * a) * np.cos(2 * t) + p * a * np.cos(t) + q * b * np.sin(t)
        step = gap / np.where(np.abs(slope) < 1e-9, 1e-9, slope)
        t = t - np.clip(step, -0.3, 0.3)
        if np.abs(step).max() < 1e-12:
            break
    return t


# A polynomial of degree k across the chord of the points.


@dataclass(frozen=True)
class Polynomial(TabulatedCurve):
    """``across = sum c_k (along / scale)^k`` in a frame at (x, y) whose axis has the direction `tilt`."""

    x: float   # x, y: origin of the frame, metres
    y: float
    tilt: float   # direction of its axis, radians
    scale: float   # metres
    coefficients: tuple   # metres, constant first
    first: float   # first, last: range of `along`, metres
    last: float

    kind = "polynomial"

    def _value(self, t, order):
        series = np.polynomial.Polynomial(self.coefficients)
        return series.deriv(order)(t / self.scale) / self.scale**order if order else series(t / self.scale)

    def _place(self, t):
        return self._turned(t, self._value(t, 0)) + [self.x, self.y]

    def _slope(self, t):
        return self._turned(np.ones_like(t), self._value(t, 1))

    def _bend(self, t):
        return self._turned(np.zeros_like(t), self._value(t, 2))


def fit_polynomial(x: np.ndarray, y: np.ndarray, degree: int = 2) -> CurveFit:
    """Fit a Polynomial to the distances across the chord, by robust linear least squares.

    The residual minimised is measured across the chord, as in the driving-line thesis (its Eq. 3.17 with the normal equations put right); the one
    reported is orthogonal. A parabola is not a circle: for R = 140 m it misses by 3 cm over 80 m and by 57 cm over 160 m.

    x, y : (N,) metres, N >= degree + 1, ordered along the line
    degree : int, 0 to 9

    Raises RoadExtractionError if the points turn back along their chord, which no polynomial can follow.
    """
    problem = _PolynomialProblem(*checked_points(x, y, degree + 1), degree)
    ahead = problem.ahead
    if not ahead[0] < ahead[-1] or np.abs(ahead).max() > 1.02 * max(-ahead[0], ahead[-1]) + 0.5:
        raise RoadExtractionError("A polynomial cannot follow a line that turns back on itself. Choose curve = automatic or b-spline.")
    coefficients, *_ = problem.fitted()
    middle_x, middle_y = problem.centre.tolist()
    curve = Polynomial(middle_x, middle_y, problem.direction, problem.size, tuple(coefficients.tolist()), float(ahead[0]), float(ahead[-1]))
    return CurveFit(curve, curve.project(x, y)[1], degree + 1)


class _PolynomialProblem(CurveProblem):
    """A polynomial, by its coefficients across the chord of the points."""

    def __init__(self, x, y, degree):
        super().__init__(x, y)
        self.degree = degree
        self.size = max(float(np.abs(self.ahead).max()), 1e-3)

    @property
    def ahead(self):
        return self.x * np.cos(self.direction) + self.y * np.sin(self.direction)

    def start(self):
        return np.zeros(self.degree + 1), np.ones(self.degree + 1), np.zeros(len(self.x))

    def evaluate(self, unknown, along):
        design = np.vander(self.ahead / self.size, self.degree + 1, increasing=True)
        return self.y * np.cos(self.direction) - self.x * np.sin(self.direction) - np.einsum("nk,k->n", design, unknown), -design.T, along
