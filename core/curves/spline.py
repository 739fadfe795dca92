"""A smoothing cubic B-spline through points: for lines whose curvature changes as the road wants."""

from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpbsv

from .curve import TabledCurve
from .fit import Fit, checked, least_bic, robust_weights

BANDWIDTHS = (2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0, 40.0, 60.0)  # m; waves shorter than 6 of them are smoothed away
DEGREE = 3
TOGETHER = 4096  # places of a line times bandwidths that are fitted at a time: what fits the processor's cache
SETTLED = 1e-6  # of a weight: its next change moves the curve by less than a micrometre


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
    waiting = [bandwidth] if bandwidth else [b for b in BANDWIDTHS[::-1] if b < max(length, 2.5)]
    while waiting:
        some = waiting[:max(TOGETHER // len(t), 1)]
        for b, fitted in zip(some, _penalised(x, y, t, length, some)):
            fit = Fit(fitted, fitted[2], _freedom(length, b))
            # the larger bandwidth wins unless the smaller one earns its freedom
            if fit.bic < best_score:
                best, best_score = fit, fit.bic
        # for which it may be too dear however well it fits
        waiting = [b for b in waiting[len(some):] if least_bic(len(t), _freedom(length, b)) < best_score]
    knots, control, across = best.curve
    curve = Spline(tuple(knots.tolist()), tuple(control[:, 0].tolist()), tuple(control[:, 1].tolist()))
    return Fit(curve, across, best.parameters)


def _freedom(length, bandwidth):
    """The effective number of parameters of a coordinate."""
    return min(3 + length / (3 * bandwidth), _pieces(length, bandwidth) + DEGREE)


def _pieces(length, bandwidth):
    return max(1, int(np.ceil(length / max(bandwidth, 1.0))))


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


class _Bases:
    """The cubic B-splines on even knots that places t in [0, length] lie in, four a place, with their penalty, for B bandwidths.

    The equations of the bandwidths are solved as one system in which they do not touch: most
    lines have a few hundred places, and numpy takes longer to be called than to compute.
    """

    def __init__(self, t, length, bandwidths):
        pieces = np.array([_pieces(length, b) for b in bandwidths])
        steps = length / pieces
        self.knots = [step * np.arange(-DEGREE, count + DEGREE + 1) for step, count in zip(steps, pieces.tolist())]
        self.counts = pieces + DEGREE
        self.starts = np.cumsum(self.counts) - self.counts
        whole, shape = int(self.counts.sum()), (len(pieces) * len(t), 4)
        step, pieces = steps[:, None], pieces[:, None]
        inside = np.clip(t / step, 0.0, pieces)
        piece = np.minimum(inside.astype(np.int64), pieces - 1)
        f = inside - piece
        self.values = np.stack([(1 - f) ** 3, (3 * f - 6) * f * f + 4, ((3 - 3 * f) * f + 3) * f + 1, f**3], axis=2).reshape(shape) / 6
        self.slopes = (np.stack([-(1 - f) ** 2, (3 * f - 4) * f, (2 - 3 * f) * f + 1, f * f], axis=2) / (2 * step[:, :, None])).reshape(shape)
        self.at = ((piece + self.starts[:, None])[:, :, None] + np.arange(4)).reshape(shape)
        # what each place adds to the upper banded form of the normal matrix, wherever two of its four meet
        first, second = np.triu_indices(4)
        self._products = self.values[:, first] * self.values[:, second]
        self._band = ((DEGREE - (second - first)) * whole + self.at[:, second]).ravel()
        self._penalty = np.concatenate([_roughness(count) * (len(t) / max(length, 1e-6)) * b**6 / step**5
                                        for count, b, step in zip(self.counts.tolist(), bandwidths, steps)], axis=1)

    def solve(self, weight, values):
        """(K, C) control points of all bandwidths, one after the other, that follow (N, C) values with (B, N) weights, smoothly."""
        weight = weight.reshape(-1, 1)
        whole = int(self.counts.sum())
        bands = np.bincount(self._band, (self._products * weight).ravel(), 4 * whole).reshape(4, -1)
        bands += self._penalty
        # a breath of ridge keeps control points in a gap from being undetermined
        bands[DEGREE] += np.repeat(1e-9 * np.maximum.reduceat(bands[DEGREE], self.starts), self.counts)
        weighted, at = (self.values * weight).reshape(len(self.counts), -1, 4), self.at.ravel()
        right = np.stack([np.bincount(at, (weighted * column[:, None]).ravel(), whole) for column in values.T], axis=1)
        # solveh_banded checks more than it computes
        _, control, trouble = dpbsv(bands, right)
        if trouble:
            raise LinAlgError(f"The spline's equations cannot be solved ({trouble}).")
        return control

    def of(self, control):
        """(B, N, C) what control points (K, C) give at the places, and the slopes there."""
        around = control[self.at]
        return tuple(np.einsum("na,nac->nc", by, around).reshape(len(self.counts), -1, control.shape[1]) for by in (self.values, self.slopes))

    def part(self, control, k):
        """The control points of one bandwidth."""
        return control[self.starts[k]:self.starts[k] + self.counts[k]]


def _penalised(x, y, t, length, bandwidths):
    """[(knots, control points (K, 2), distances (N,) across the curve)], one for each bandwidth."""
    bases = _Bases(t, length, bandwidths)
    weight = np.ones((len(bandwidths), len(t)))
    middle = np.array([x.mean(), y.mean()])
    places = np.stack([x, y], axis=1) - middle
    found = [None] * len(bandwidths)
    for turn in range(8):
        control = bases.solve(weight, places)
        at, slope = bases.of(control)
        gap = places - at
        size = np.maximum(np.hypot(slope[..., 0], slope[..., 1]), 1e-12)
        across = (gap[..., 1] * slope[..., 0] - gap[..., 0] * slope[..., 1]) / size
        before, weight = weight, robust_weights(across)
        settled = np.abs(weight - before).max(axis=1) < SETTLED
        for k in range(len(found)):
            if found[k] is None and (settled[k] or turn == 7):
                found[k] = bases.knots[k], bases.part(control, k) + middle, across[k]
        if None not in found:
            break
    return found


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
    bases = _Bases(t - t[0], length, [bandwidth])
    level = float(np.median(values))
    weight = np.ones((1, len(t)))
    for _ in range(6):
        control = bases.solve(weight, values[:, None] - level)
        before, weight = weight, robust_weights(values - level - bases.of(control)[0][..., 0])
        if np.abs(weight - before).max() < SETTLED:
            break
    knots = bases.knots[0]
    spline = BSpline(knots, control[:, 0], DEGREE)
    return lambda at: level + spline(np.clip(np.asarray(at, float) - t[0], 0.0, knots[-DEGREE - 1]))
