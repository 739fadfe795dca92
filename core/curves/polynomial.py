"""A polynomial of degree k across the chord of the points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.errors import RoadExtractionError
from .base import CurveFit, TabulatedCurve, checked_points
from .line_circle import chord
from .robust import robust_weights

POLYNOMIAL_REWEIGHTINGS = 15


@dataclass(frozen=True)
class Polynomial(TabulatedCurve):
    """``across = sum c_k (along / scale)^k`` in a frame at (x, y) whose axis has the direction `tilt`.

    x, y : origin of the frame, metres
    tilt : direction of its axis, radians
    scale : metres
    coefficients : metres, constant first
    first, last : range of `along`, metres
    """

    x: float
    y: float
    tilt: float
    scale: float
    coefficients: tuple
    first: float
    last: float

    kind = "polynomial"

    def _span(self):
        return self.first, self.last

    def _turned(self, along, across):
        c, s = np.cos(self.tilt), np.sin(self.tilt)
        return np.c_[along * c - across * s, along * s + across * c]

    def _value(self, t, order):
        series = np.polynomial.Polynomial(self.coefficients)
        return series.deriv(order)(t / self.scale) / self.scale**order if order else series(t / self.scale)

    def _place(self, t):
        return self._turned(t, self._value(t, 0)) + [self.x, self.y]

    def _slope(self, t):
        return self._turned(np.ones_like(t), self._value(t, 1))

    def _bend(self, t):
        return self._turned(np.zeros_like(t), self._value(t, 2))

    def moved(self, dx: float, dy: float) -> Polynomial:
        return Polynomial(self.x + dx, self.y + dy, self.tilt, self.scale, self.coefficients, self.first, self.last)

    def reversed(self) -> Polynomial:
        turned = tuple(-c * (-1) ** k for k, c in enumerate(self.coefficients))
        return Polynomial(self.x, self.y, self.tilt + np.pi, self.scale, turned, -self.last, -self.first)


def fit_polynomial(x: np.ndarray, y: np.ndarray, degree: int = 2) -> CurveFit:
    """Fit a polynomial to the distances across the chord, by robust linear least squares.

    The residual minimised is measured across the chord, as in the driving-line
    thesis (its Eq. 3.17 with the normal equations put right); the one reported is
    orthogonal. A parabola is not a circle: for R = 140 m it misses by 3 cm over
    80 m and by 57 cm over 160 m.

    Parameters
    ----------
    x, y : (N,) metres, N >= degree + 1, ordered along the line
    degree : int, 0 to 9

    Returns
    -------
    CurveFit with a Polynomial from the first point to the last.

    Raises
    ------
    RoadExtractionError
        If the points turn back along their chord, which no polynomial can follow.
    """
    x, y = checked_points(x, y, degree + 1)
    middle, tilt = chord(x, y)
    c, s = np.cos(tilt), np.sin(tilt)
    along = (x - middle[0]) * c + (y - middle[1]) * s
    across = (y - middle[1]) * c - (x - middle[0]) * s
    if not along[0] < along[-1] or np.abs(along).max() > 1.02 * max(-along[0], along[-1]) + 0.5:
        raise RoadExtractionError(
            "A polynomial cannot follow a line that turns back on itself. Choose curve = automatic or b-spline.")
    scale = max(float(np.abs(along).max()), 1e-3)
    design = np.vander(along / scale, degree + 1, increasing=True)
    weight = np.ones(len(x))
    for _ in range(POLYNOMIAL_REWEIGHTINGS):
        root = np.sqrt(weight)
        found = np.linalg.lstsq(design * root[:, None], across * root, rcond=None)[0]
        weight = robust_weights(across - design @ found)
    curve = Polynomial(float(middle[0]), float(middle[1]), tilt, scale, tuple(float(v) for v in found),
                       float(along[0]), float(along[-1]))
    return CurveFit(curve, curve.project(x, y)[1], degree + 1)
