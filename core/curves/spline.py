"""A smoothing cubic B-spline through points: for lines whose curvature changes as the road wants."""

from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import solveh_banded

from .curve import TabledCurve
from .fit import Fit, checked, robust_weights

BANDWIDTHS = (2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0, 40.0, 60.0)  # m; waves shorter than 6 of them are smoothed away
DEGREE = 3


@dataclass(frozen=True)
class Spline(TabledCurve):
    """A cubic B-spline (t -> x, y) with its knots and control points."""

    knots: tuple
    control_x: tuple
    control_y: tuple
    _splines: dict = field(default_factory=dict, repr=False, compare=False)

    kind = "b-spline"

    def _derivative(self, order):
        if order not in self._splines:
            base = BSpline(np.array(self.knots), np.c_[self.control_x, self.control_y], DEGREE)
            self._splines[order] = base.derivative(order) if order else base
        return self._splines[order]

    def _span(self):
        return self.knots[DEGREE], self.knots[-DEGREE - 1]

    def _place(self, t):
        return self._derivative(0)(t)

    def _slope(self, t):
        return self._derivative(1)(t)

    def _bend(self, t):
        return self._derivative(2)(t)

    def params(self):
        return dict(curve=self.kind, degree=DEGREE, knots=list(self.knots), control_x=list(self.control_x),
                    control_y=list(self.control_y))

    def moved(self, dx, dy):
        return Spline(self.knots, tuple(v + dx for v in self.control_x), tuple(v + dy for v in self.control_y))

    def reversed(self):
        turn = self.knots[0] + self.knots[-1]
        return Spline(tuple(turn - k for k in self.knots[::-1]), self.control_x[::-1], self.control_y[::-1])


def fit_spline(x, y, along=None, bandwidth=None):
    """A penalised cubic B-spline by robust least squares.

    The penalty is on the third derivative, so that arcs pass unhindered and what is
    smoothed is change of curvature. How far it smooths is chosen by BIC among
    BANDWIDTHS, with the effective number of parameters of a smoothing spline of
    this order, L / (3 bandwidth) + 3 per coordinate [1]_; one coordinate is counted, since
    only the deviation across the line is an observation.

    Parameters
    ----------
    x, y : (N,) metres, N >= 4, ordered along the line; gaps are allowed
    along : (N,) rising distances along the line, metres, where they are known
        (stations), else chord lengths of the points
    bandwidth : metres, or None to choose it

    Returns
    -------
    Fit with a Spline from the first point to the last.

    References
    ----------
    .. [1] Eilers and Marx (1996), Statistical Science 11, 89-121; the effective
       dimension is the integral of 1 / (1 + (w b)^6).
    """
    x, y = checked(x, y, 4)
    t = _chord_lengths(x, y) if along is None else np.asarray(along, float) - along[0]
    length = float(t[-1])
    best, best_score = None, np.inf
    for b in ([bandwidth] if bandwidth else [b for b in BANDWIDTHS if b < max(length, 2.5)]):
        fit = _penalised(x, y, t, length, b)
        # the larger bandwidth wins unless the smaller one earns its freedom
        if fit.bic <= best_score:
            best, best_score = fit, fit.bic
    return best


def _chord_lengths(x, y):
    # noise makes raw chords too long; medians of five keep the parameter near the true length
    dx, dy = np.gradient(_smoothed(x)), np.gradient(_smoothed(y))
    step = np.hypot(np.diff(x), np.diff(y))
    forward = (np.diff(x) * (dx[:-1] + dx[1:]) + np.diff(y) * (dy[:-1] + dy[1:])) / np.maximum(
        np.hypot(dx[:-1] + dx[1:], dy[:-1] + dy[1:]), 1e-12)
    return np.r_[0.0, np.cumsum(np.maximum(forward, 0.2 * step + 1e-6))]


def _smoothed(values, reach=4):
    padded = np.r_[2 * values[0] - values[reach:0:-1], values, 2 * values[-1] - values[-2:-reach - 2:-1]] \
        if len(values) > reach else values
    if len(padded) == len(values):
        return values
    return np.convolve(padded, np.full(2 * reach + 1, 1 / (2 * reach + 1)), "valid")


def _basis(t, length, bandwidth):
    """Knots, design matrix and banded penalty for places t in [0, length]."""
    pieces = max(1, int(np.ceil(length / max(bandwidth, 1.0))))
    step = length / pieces
    knots = step * np.arange(-DEGREE, pieces + DEGREE + 1)
    inside = np.clip(t, knots[DEGREE], knots[-DEGREE - 1])
    design = BSpline.design_matrix(inside, knots, DEGREE, extrapolate=False)
    if len(t) < 400:
        design = design.toarray()
    density = len(t) / max(length, 1e-6)
    return knots, design, _roughness(pieces + DEGREE) * density * bandwidth**6 / step**5


def _penalised(x, y, t, length, bandwidth):
    knots, design, penalty = _basis(t, length, bandwidth)
    inside = np.clip(t, knots[DEGREE], knots[-DEGREE - 1])
    weight = np.ones(len(t))
    middle = np.array([x.mean(), y.mean()])
    places = np.c_[x, y] - middle
    for _ in range(8):
        control = _solve(design, weight, places, penalty)
        gap = places - design @ control
        slope = BSpline(knots, control, DEGREE).derivative()(inside)
        slope /= np.maximum(np.hypot(slope[:, 0], slope[:, 1]), 1e-12)[:, None]
        across = gap[:, 1] * slope[:, 0] - gap[:, 0] * slope[:, 1]
        weight = robust_weights(across)
    control = control + middle
    curve = Spline(tuple(knots.tolist()), tuple(control[:, 0].tolist()), tuple(control[:, 1].tolist()))
    return Fit(curve, across, min(3 + length / (3 * bandwidth), len(knots) - 4))


def _roughness(count):
    """Upper banded form (4, K) of D'D with D the third differences of K control points."""
    bands = np.zeros((DEGREE + 1, count))
    difference = np.array([-1.0, 3.0, -3.0, 1.0])
    for row in range(4):
        for column in range(row, 4):
            bands[DEGREE - (column - row), column:column + count - 3] += difference[row] * difference[column]
    return bands


def smooth_profile(t, values, bandwidth):
    """A function of t that follows values smoothly, strays counting little; held constant beyond the ends.

    t : (N,) rising; values : (N,) metres, as a height or an offset along a line.
    """
    t, values = np.asarray(t, float), np.asarray(values, float)
    length = float(t[-1] - t[0])
    if len(t) < 4 or length < 1.0:
        level = float(np.median(values))
        return lambda at: np.full(np.shape(at), level)
    knots, design, penalty = _basis(t - t[0], length, bandwidth)
    level = float(np.median(values))
    weight = np.ones(len(t))
    for _ in range(6):
        control = _solve(design, weight, values[:, None] - level, penalty)[:, 0]
        weight = robust_weights(values - level - design @ control)
    spline = BSpline(knots, control, DEGREE)
    return lambda at: level + spline(np.clip(np.asarray(at, float) - t[0], 0.0, knots[-DEGREE - 1]))


def _bands(matrix):
    """Upper banded form (4, K) of a symmetric matrix with half-width 3."""
    bands = np.zeros((DEGREE + 1, len(matrix)))
    for k in range(min(DEGREE, len(matrix) - 1) + 1):
        bands[DEGREE - k, k:] = np.diagonal(matrix, k)
    return bands


def _solve(design, weight, values, penalty):
    weighted = design.multiply(weight[:, None]).tocsr() if hasattr(design, "multiply") else design * weight[:, None]
    normal = weighted.T @ design
    if hasattr(normal, "toarray"):
        bands = np.zeros_like(penalty)
        for k in range(DEGREE + 1):
            bands[DEGREE - k, k:] = normal.diagonal(k)
    else:
        bands = _bands(normal)
    # a breath of ridge keeps control points in a gap from being undetermined
    bands = bands + penalty
    bands[DEGREE] += 1e-9 * bands[DEGREE].max()
    return solveh_banded(bands, weighted.T @ values)
