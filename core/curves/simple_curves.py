"""Straight lines, circles, ellipses and polynomials through points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..common.errors import RoadExtractionError
from .base import Arc, CurveFit, TabulatedCurve, checked_points
from .robust import PointGroups, fit_batch, minimise, robust_weights
from .weights import FITS


def fit_lines(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """Fit a straight Arc to each line by orthogonal, robust least squares; arguments as of `fit_batch`, N >= 2."""
    return fit_batch([checked_points(x, y, 2) for x, y in lines], _LineProblem, max_misfit)


def fit_circles(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """Fit an Arc to each line: Taubin's algebraic fit as start, then the geometric distance, robustly.

    The unknowns are heading, offset and curvature at the points' middle, so that a nearly straight line is as easy as a tight bend. Kasa's simpler
    fit is not used: it is biased towards small radii on short arcs.

    lines, max_misfit : as of `fit_batch`, N >= 3

    References
    ----------
    Taubin (1991), IEEE PAMI 13, 1115-1138; Chernov (2010), Circular and linear regression, ch. 5-7.
    """
    return fit_batch([checked_points(x, y, 3) for x, y in lines], _CircleProblem, max_misfit)


def _taubin(groups, x, y):
    """(L,) curvatures of Taubin's circles through the points of several lines."""
    owner, count = groups.owner, groups.counts
    dx, dy = x - (groups.sums(x) / count)[owner], y - (groups.sums(y) / count)[owner]
    size = np.sqrt(groups.sums(dx**2 + dy**2) / count)
    scale = np.where(size > 0, size, 1.0)
    dx, dy = dx / scale[owner], dy / scale[owner]
    q = dx**2 + dy**2
    # Taubin's constraint, reduced to the least eigenvector of a 3 x 3 matrix (Chernov's TaubinSVD)
    design = np.stack([(q - 1.0) / 2.0, dx, dy])
    above, below = np.triu_indices(3)
    normal = np.empty((len(count), 3, 3))
    normal[:, above, below] = normal[:, below, above] = (groups.sums(design[above] * design[below]) / count).T
    a, b, c = np.linalg.eigh(normal)[1][:, :, 0].T
    root = b * b + c * c + a * a
    bend = np.abs(a) / np.sqrt(np.maximum(root, 1e-300)) / scale
    direction = chords(groups, x, y)[2]
    # the centre lies at (-b, -c) / a
    side = np.sign(np.where(a == 0, 0.0, -np.sign(a) * (c * np.cos(direction) - b * np.sin(direction))))
    return np.where((root > 0) & (bend >= 1e-9) & (size > 0), bend * side, 0.0)


def chords(groups: PointGroups, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centroids x and y (L,) of the ordered points of L lines, and the direction (L,) from that of their first half to that of the second, radians.

    Unlike the principal axis it keeps the order of the points, and it does not turn where an arc is nearly half a circle.
    """
    half = np.maximum(groups.counts // 2, 1)
    within = np.arange(len(groups.owner)) - groups.starts[groups.owner]
    tail = within >= (groups.counts - half)[groups.owner]
    head = within < half[groups.owner]
    step = [(groups.sums(np.where(tail, v, 0.0)) - groups.sums(np.where(head, v, 0.0))) / half for v in (x, y)]
    return groups.sums(x) / groups.counts, groups.sums(y) / groups.counts, np.arctan2(step[1], step[0])


class _CircleProblem:
    """Circles through the points of several lines, in the form of offset, heading and curvature: a problem for `fit_batch`."""

    free_bend = True
    state = ()

    def __init__(self, groups, x, y, about=None):
        self.groups = groups
        self.about = chords(groups, x, y) if about is None else about
        owner, (middle_x, middle_y, self.direction) = groups.owner, self.about
        self.dx, self.dy = x - middle_x[owner], y - middle_y[owner]
        size = np.maximum(np.sqrt(groups.sums(self.dx**2 + self.dy**2) / groups.counts), 1e-3)
        self.scale = size[:, None] ** -np.arange(2.0 + self.free_bend)

    def start(self):
        """(L, P) unknowns to begin with."""
        groups, size = self.groups, 1.0 / self.scale[:, 1]
        bend = _taubin(groups, self.dx, self.dy) if self.free_bend else np.zeros(len(size))
        c, s = np.cos(self.direction)[groups.owner], np.sin(self.direction)[groups.owner]
        sagitta = groups.sums(self.dy * c - self.dx * s) / groups.counts
        return np.stack([sagitta - bend * size**2 / 2, np.zeros(len(bend)), bend][:2 + self.free_bend], axis=1)

    def with_points(self, groups, x, y, lines, state):
        """The same unknowns for other points of some of the lines."""
        return type(self)(groups, x, y, tuple(values[lines] for values in self.about))

    def subset(self, lines, rows):
        """Some of the lines, whose points are `rows`."""
        part = object.__new__(type(self))
        part.groups, part.about = PointGroups(self.groups.counts[lines]), tuple(values[lines] for values in self.about)
        part.direction, part.dx, part.dy, part.scale = part.about[2], self.dx[rows], self.dy[rows], self.scale[lines]
        return part

    def evaluate(self, unknown, state):
        owner = self.groups.owner
        turned = self.direction + unknown[:, 1]
        c, s = np.cos(turned)[owner], np.sin(turned)[owner]
        along, across = self.dx * c + self.dy * s, self.dy * c - self.dx * s - unknown[:, 0][owner]
        if not self.free_bend:
            return across, (along,)
        k, square = unknown[:, 2][owner], along**2 + across**2
        lift = 2 * across - k * square
        root = np.sqrt(np.maximum(1 - k * lift, 1e-12))
        e = lift / (1 + root)
        # how the distance changes with `across`, `along` and k
        by_across, by_along = (1 - k * across) / root, -k * along / root
        return e, (by_across, by_along * (across + unknown[:, 0][owner]) - by_across * along, (e**2 - square) / (2 * root))

    def jacobian(self, unknown, state):
        by_across, by_heading, by_bend = state
        return np.stack([-by_across, by_heading, by_bend])

    def fit(self, line, unknown, x, y, residuals, state):
        middle_x, middle_y, direction = (values[line] for values in self.about)
        turned = direction + unknown[1]
        arc = Arc(float(middle_x - unknown[0] * np.sin(turned)), float(middle_y + unknown[0] * np.cos(turned)), float(turned),
                  float(unknown[2]) if self.free_bend else 0.0, 0.0)
        u, _ = arc.project(x[[0, -1]], y[[0, -1]])
        first, last = float(u[0]), float(u[1])
        (x0, y0), = arc.at(u[:1])
        return CurveFit(Arc(float(x0), float(y0), float(arc.heading(first)), arc.bend, last - first), residuals.copy(), len(unknown))


class _LineProblem(_CircleProblem):
    """Straight lines through the points of several lines."""

    free_bend = False

    def jacobian(self, unknown, state):
        return np.stack([np.full(len(state[0]), -1.0), -state[0]])


# An ellipse through points.


@dataclass(frozen=True)
class Ellipse(TabulatedCurve):
    """An elliptic arc."""

    x: float   # x, y: centre, metres
    y: float
    a: float   # a, b: semi-axes, metres
    b: float
    tilt: float   # direction of axis a, radians
    first: float   # first, last: eccentric angles at start and end, radians; `first` is above `last` where the curve turns right
    last: float

    kind = "ellipse"

    def _span(self):
        return self.first, self.last

    def _place(self, t):
        return self._turned(self.a * np.cos(t), self.b * np.sin(t)) + [self.x, self.y]

    def _slope(self, t):
        # along the walk: t falls where the curve turns right
        return np.sign(self.last - self.first) * self._turned(-self.a * np.sin(t), self.b * np.cos(t))

    def _bend(self, t):
        return self._turned(-self.a * np.cos(t), -self.b * np.sin(t))

    def reversed(self) -> Ellipse:
        return replace(self, first=self.last, last=self.first)


def fit_ellipse(x: np.ndarray, y: np.ndarray, max_misfit: float = np.inf) -> CurveFit:
    """Fit an Ellipse: Halir and Flusser's direct fit as start, then robust orthogonal distances.

    Parameters
    ----------
    x, y : (N,) metres, N >= 6, ordered along the line
    max_misfit : metres; a fit with a larger root mean square residual is given up once steps gain little

    Raises RoadExtractionError if the points turn by less than 60 degrees or do not lie on an ellipse.

    References
    ----------
    Halir and Flusser (1998), Numerically stable direct least squares fitting of ellipses.
    """
    x, y = checked_points(x, y, 6)
    middle = np.array([x.mean(), y.mean()])
    dx, dy = x - middle[0], y - middle[1]
    size = float(np.sqrt(np.mean(dx**2 + dy**2)))
    start = _direct(dx / size, dy / size)
    if start is None:
        raise RoadExtractionError("The points do not lie on an ellipse. Choose curve = automatic, circle or b-spline.")
    start = start * [size, size, size, size, 1.0]

    def nearest(unknown):
        t = _nearest_angle(dx, dy, unknown)
        cx, cy, a, b, tilt = unknown
        c, s = np.cos(tilt), np.sin(tilt)
        along, across = a * np.cos(t), b * np.sin(t)
        normal = np.c_[b * np.cos(t), a * np.sin(t)]
        normal /= np.hypot(normal[:, 0], normal[:, 1])[:, None]
        gap_along, gap_across = (dx - cx) * c + (dy - cy) * s - along, (dy - cy) * c - (dx - cx) * s - across
        return t, normal, gap_along * normal[:, 0] + gap_across * normal[:, 1]

    def residuals(unknown):
        return nearest(unknown)[2]

    def jacobian(unknown):
        t, normal, _ = nearest(unknown)
        _, _, a, b, tilt = unknown
        c, s = np.cos(tilt), np.sin(tilt)
        return -np.stack([normal[:, 0] * c - normal[:, 1] * s, normal[:, 0] * s + normal[:, 1] * c,
                          normal[:, 0] * np.cos(t), normal[:, 1] * np.sin(t),
                          normal[:, 1] * a * np.cos(t) - normal[:, 0] * b * np.sin(t)], 1)

    unknown = minimise(residuals, jacobian, start, [size, size, size, size, 1.0], max_misfit)
    t, _, e = nearest(unknown)
    cx, cy, a, b, tilt = unknown
    t = np.unwrap(t)
    ellipse = Ellipse(float(cx), float(cy), abs(float(a)), abs(float(b)), float(tilt), float(t[0]), float(t[-1]))
    if abs(ellipse.heading(np.array([ellipse.length]))[0] - ellipse.heading(np.zeros(1))[0]) < FITS.min_ellipse_turn:
        raise RoadExtractionError(
            "The points turn by less than 60 degrees, where an ellipse cannot be distinguished from a circle. "
            "Choose curve = automatic or circle.")
    # outside the ellipse is right of a left turn
    return CurveFit(ellipse.moved(*middle), -np.sign(t[-1] - t[0]) * e, 5)


def _direct(x, y):
    """(centre x, y, a, b, tilt) of the direct least-squares ellipse, or None."""
    squares, rest = np.c_[x * x, x * y, y * y], np.c_[x, y, np.ones_like(x)]
    s1, s2, s3 = squares.T @ squares, squares.T @ rest, rest.T @ rest
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

    def _span(self):
        return self.first, self.last

    def _value(self, t, order):
        series = np.polynomial.Polynomial(self.coefficients)
        return series.deriv(order)(t / self.scale) / self.scale**order if order else series(t / self.scale)

    def _place(self, t):
        return self._turned(t, self._value(t, 0)) + [self.x, self.y]

    def _slope(self, t):
        return self._turned(np.ones_like(t), self._value(t, 1))

    def _bend(self, t):
        return self._turned(np.zeros_like(t), self._value(t, 2))

    def reversed(self) -> Polynomial:
        turned = tuple(-c * (-1) ** k for k, c in enumerate(self.coefficients))
        return Polynomial(self.x, self.y, self.tilt + np.pi, self.scale, turned, -self.last, -self.first)


def fit_polynomial(x: np.ndarray, y: np.ndarray, degree: int = 2) -> CurveFit:
    """Fit a Polynomial to the distances across the chord, by robust linear least squares.

    The residual minimised is measured across the chord, as in the driving-line thesis (its Eq. 3.17 with the normal equations put right); the one
    reported is orthogonal. A parabola is not a circle: for R = 140 m it misses by 3 cm over 80 m and by 57 cm over 160 m.

    Parameters
    ----------
    x, y : (N,) metres, N >= degree + 1, ordered along the line
    degree : int, 0 to 9

    Raises RoadExtractionError if the points turn back along their chord, which no polynomial can follow.
    """
    x, y = checked_points(x, y, degree + 1)
    middle_x, middle_y, tilt = (float(values[0]) for values in chords(PointGroups([len(x)]), x, y))
    c, s = np.cos(tilt), np.sin(tilt)
    along = (x - middle_x) * c + (y - middle_y) * s
    across = (y - middle_y) * c - (x - middle_x) * s
    if not along[0] < along[-1] or np.abs(along).max() > 1.02 * max(-along[0], along[-1]) + 0.5:
        raise RoadExtractionError(
            "A polynomial cannot follow a line that turns back on itself. Choose curve = automatic or b-spline.")
    scale = max(float(np.abs(along).max()), 1e-3)
    design = np.vander(along / scale, degree + 1, increasing=True)
    weight = np.ones(len(x))
    for _ in range(FITS.polynomial_reweightings):
        root = np.sqrt(weight)
        coefficients = np.linalg.lstsq(design * root[:, None], across * root, rcond=None)[0]
        weight = robust_weights(across - design @ coefficients)
    curve = Polynomial(middle_x, middle_y, tilt, scale, tuple(coefficients.tolist()), float(along[0]), float(along[-1]))
    return CurveFit(curve, curve.project(x, y)[1], degree + 1)
