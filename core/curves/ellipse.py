"""An ellipse through points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.errors import RoadExtractionError
from .base import CurveFit, TabulatedCurve, checked_points
from .robust import minimise

MIN_ELLIPSE_TURN = np.radians(60.0)  # on a shorter arc an ellipse cannot be distinguished from a circle


@dataclass(frozen=True)
class Ellipse(TabulatedCurve):
    """An elliptic arc.

    x, y : centre, metres
    a, b : semi-axes, metres
    tilt : direction of axis a, radians
    first, last : eccentric angles at start and end, radians; `first` is above `last` where the curve turns right
    """

    x: float
    y: float
    a: float
    b: float
    tilt: float
    first: float
    last: float

    kind = "ellipse"

    def _span(self):
        return self.first, self.last

    def _turned(self, along, across):
        c, s = np.cos(self.tilt), np.sin(self.tilt)
        return np.c_[along * c - across * s, along * s + across * c]

    def _place(self, t):
        return self._turned(self.a * np.cos(t), self.b * np.sin(t)) + [self.x, self.y]

    def _slope(self, t):
        # along the walk: t falls where the curve turns right
        return np.sign(self.last - self.first) * self._turned(-self.a * np.sin(t), self.b * np.cos(t))

    def _bend(self, t):
        return self._turned(-self.a * np.cos(t), -self.b * np.sin(t))

    def moved(self, dx: float, dy: float) -> Ellipse:
        return Ellipse(self.x + dx, self.y + dy, self.a, self.b, self.tilt, self.first, self.last)

    def reversed(self) -> Ellipse:
        return Ellipse(self.x, self.y, self.a, self.b, self.tilt, self.last, self.first)


def fit_ellipse(x: np.ndarray, y: np.ndarray, max_misfit: float = np.inf) -> CurveFit:
    """Fit an ellipse: Halir and Flusser's direct fit as start, then robust orthogonal distances.

    Parameters
    ----------
    x, y : (N,) metres, N >= 6, ordered along the line
    max_misfit : metres; a fit with a larger root mean square residual is given up once steps gain little

    Returns
    -------
    CurveFit with an Ellipse from the first point's projection to the last's.

    Raises
    ------
    RoadExtractionError
        If the points turn by less than 60 degrees or do not lie on an ellipse.

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
    found = Ellipse(float(cx), float(cy), abs(float(a)), abs(float(b)), float(tilt), float(t[0]), float(t[-1]))
    if abs(found.heading(np.array([found.length]))[0] - found.heading(np.zeros(1))[0]) < MIN_ELLIPSE_TURN:
        raise RoadExtractionError(
            "The points turn by less than 60 degrees, where an ellipse cannot be distinguished from a circle. "
            "Choose curve = automatic or circle.")
    # outside the ellipse is right of a left turn
    return CurveFit(found.moved(*middle), -np.sign(t[-1] - t[0]) * e, 5)


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
