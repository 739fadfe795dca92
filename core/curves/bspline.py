"""Penalised cubic B-splines: for lines whose curvature changes in no simple way, and for profiles along a line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpbsv
from scipy.sparse import csc_matrix, csr_matrix

from ..common.parallel import check_cancelled
from .base import CurveFit, TabulatedCurve, bic_lower_bound, checked_points
from .robust import MAD_TO_SIGMA, median, row_medians
from .weights import FITS

SPLINE_DEGREE = 3   # derived: cubic, as the penalty is on the third derivative


def _knot_intervals(length: float, bandwidth: float) -> int:
    """Number of knot intervals of a line of some length, metres: one per bandwidth, at least 1 m long."""
    return max(1, int(np.ceil(length / max(bandwidth, 1.0))))


class _SplineBasis:
    """Uniform cubic B-splines with a roughness penalty, of several lines and bandwidths.

    Each pair of a line and a bandwidth is a block. The equations of all blocks are solved as one banded system in which they are independent: most
    lines have a few hundred points, for which the overhead of a numpy call exceeds its work.

    lines : list of (t, bandwidths): (N,) metres rising from 0, and (B,) metres
    """

    def __init__(self, lines: Sequence[tuple[np.ndarray, Sequence[float]]]) -> None:
        blocks = [(t, b) for t, bandwidths in lines for b in bandwidths]
        lengths = np.array([float(t[-1]) for t, _ in blocks])
        pieces = np.array([_knot_intervals(length, b) for length, (_, b) in zip(lengths.tolist(), blocks)])
        steps = lengths / pieces
        self.knots = [step * np.arange(-SPLINE_DEGREE, count + SPLINE_DEGREE + 1) for step, count in zip(steps, pieces.tolist())]
        self.counts, self.sizes = pieces + SPLINE_DEGREE, np.array([len(t) for t, _ in blocks])
        self.starts, self.rows = np.cumsum(self.counts) - self.counts, np.cumsum(self.sizes) - self.sizes
        whole, size = int(self.counts.sum()), int(self.sizes.sum())
        step, most = np.repeat(steps, self.sizes), np.repeat(pieces, self.sizes)
        inside = np.clip(np.concatenate([t for t, _ in blocks]) / step, 0.0, most)
        piece = np.minimum(inside.astype(np.int32), most - 1)
        f = inside - piece
        g = 1 - f
        values = np.stack([g**3, (3 * f - 6) * f * f + 4, ((3 - 3 * f) * f + 3) * f + 1, f**3], axis=1) / 6
        slopes = np.stack([-g * g, (3 * f - 4) * f, (2 - 3 * f) * f + 1, f * f], axis=1) / (2 * step[:, None])
        columns = (piece + np.repeat(self.starts, self.sizes)).astype(np.int32)[:, None] + np.arange(4, dtype=np.int32)
        four = np.arange(0, 4 * size + 1, 4, dtype=np.int32)
        self._values = csr_matrix((values.ravel(), columns.ravel(), four), (size, whole))
        self._slopes = csr_matrix((slopes.ravel(), columns.ravel(), four), (size, whole))
        self._transposed = self._values.T
        # contribution of each point to the upper banded form of the normal matrix: products of its four values
        first, second = np.triu_indices(SPLINE_DEGREE + 1)
        ten = np.arange(0, 10 * size + 1, 10, dtype=np.int32)
        band = 4 * columns[:, second] + (SPLINE_DEGREE - (second - first)).astype(np.int32)
        self._products = csc_matrix(((values[:, first] * values[:, second]).ravel(), band.ravel(), ten), (4 * whole, size))
        scale = self.sizes / np.maximum(lengths, 1e-6) * np.array([b for _, b in blocks]) ** 6 / steps**5
        self._penalty = np.concatenate([_roughness(count) * factor for count, factor in zip(self.counts.tolist(), scale.tolist())])

    def robustly_solved(self, values: np.ndarray, residuals_of: Callable[[np.ndarray, np.ndarray], np.ndarray], rounds: int) -> list[Any]:
        """(control points (K, C), residuals (N,)) of each block, by least squares whose weights follow the residuals until they change no more.

        values : (N, C) metres of the points of all blocks; residuals_of : gives (N,) m from values and slopes of the splines at these points
        """
        weight = np.ones(len(values))
        solved: list[Any] = [None] * len(self.sizes)
        for turn in range(rounds):
            control = self._solve(weight, values)
            residuals = residuals_of(self._values @ control, self._slopes @ control)
            before, weight = weight, self._weights(residuals)
            settled = np.maximum.reduceat(np.abs(weight - before), self.rows) < FITS.weight_tolerance
            for k in np.flatnonzero(settled | (turn == rounds - 1)).tolist():
                rows, points = slice(self.rows[k], self.rows[k] + self.sizes[k]), slice(self.starts[k], self.starts[k] + self.counts[k])
                solved[k] = solved[k] or (control[points], residuals[rows])
            if None not in solved:
                break
        return solved

    def _solve(self, weight, values):
        """(K, C) control points by penalised least squares with (N,) weights."""
        bands = (self._products @ weight).reshape(-1, 4)
        bands += self._penalty
        # a slight ridge penalty: control points in a gap would be undetermined without it
        bands[:, SPLINE_DEGREE] += np.repeat(1e-9 * np.maximum.reduceat(bands[:, SPLINE_DEGREE], self.starts), self.counts)
        right = self._transposed @ (values * weight[:, None])
        # not scipy's solveh_banded, whose checks take longer than the solution
        _, control, trouble = dpbsv(bands.T, right, overwrite_ab=1)
        if trouble:
            raise LinAlgError(f"The spline's equations cannot be solved ({trouble}).")
        return control

    def _weights(self, residuals):
        """Weights of soft L1, ``1 / sqrt(1 + (r / c)^2)``, of (N,) residuals in metres.

        The scale c of each block is 1.4826 times the median of ``|r|``, at least `soft_l1_scale`.
        """
        weights, size = np.empty(len(residuals)), np.abs(residuals)
        k = 0
        while k < len(self.sizes):
            # successive blocks of one length are rows of a table
            count, alike = self.sizes[k], k + 1
            while alike < len(self.sizes) and self.sizes[alike] == count:
                alike += 1
            rows = slice(self.rows[k], self.rows[k] + count * (alike - k))
            scale = np.maximum(FITS.soft_l1_scale, MAD_TO_SIGMA * row_medians(size[rows].reshape(-1, count)))
            weights[rows] = (size[rows].reshape(-1, count) / scale).ravel()
            k = alike
        weights *= weights
        weights += 1.0
        return 1.0 / np.sqrt(weights, out=weights)


@lru_cache(maxsize=64)
def _roughness(count):
    """(K, 4) transposed upper banded form of D'D, where D takes the third differences of K control points."""
    inner = max(count - 8, 0)
    small = np.zeros((SPLINE_DEGREE + 1, count - inner))
    difference = np.array([-1.0, 3.0, -3.0, 1.0])
    for row in range(4):
        for column in range(row, 4):
            small[SPLINE_DEGREE - (column - row), column:column + count - inner - 3] += difference[row] * difference[column]
    bands = np.repeat(small.T, np.r_[1, 1, 1, 1 + inner, np.ones(max(len(small.T) - 4, 0), int)][:len(small.T)], axis=0)
    bands.flags.writeable = False
    return bands


@dataclass(frozen=True)
class Spline(TabulatedCurve):
    """A cubic B-spline t -> (x, y)."""

    knots: tuple   # (K + 4,) metres
    control_x: tuple   # control_x, control_y: (K,) control points, metres
    control_y: tuple

    kind = "b-spline"

    @cached_property
    def _derivatives(self):
        base = BSpline(np.array(self.knots), np.c_[self.control_x, self.control_y], SPLINE_DEGREE)
        return base, base.derivative(1), base.derivative(2)

    def _span(self):
        return self.knots[SPLINE_DEGREE], self.knots[-SPLINE_DEGREE - 1]

    def _place(self, t):
        return self._derivatives[0](t)

    def _slope(self, t):
        return self._derivatives[1](t)

    def _bend(self, t):
        return self._derivatives[2](t)

    def params(self) -> dict[str, Any]:
        return dict(curve=self.kind, degree=SPLINE_DEGREE, knots=list(self.knots), control_x=list(self.control_x),
                    control_y=list(self.control_y))

    def moved(self, dx: float, dy: float) -> Spline:
        return Spline(self.knots, tuple(v + dx for v in self.control_x), tuple(v + dy for v in self.control_y))


def fit_splines(lines: Sequence[tuple[np.ndarray, np.ndarray]], along: Sequence[np.ndarray | None] | None = None) -> list[CurveFit]:
    """Fit a penalised cubic B-spline to each line, from its first point to its last, by robust least squares.

    The penalty is on the third derivative: arcs are not affected, only changes of curvature are smoothed. The bandwidth is selected by BIC among
    those of FITS, with the effective number of parameters of a smoothing spline of this order, L / (3 bandwidth) + 3 per coordinate [1]_; one
    coordinate is counted, since only the deviation across the line is an observation.

    lines : list of (x, y), each (N,) metres, N >= 4, ordered along the line; gaps are allowed
    along : for each line its (N,) rising distances, metres, such as stations, or None for the chord lengths of its points

    .. [1] Eilers and Marx (1996), Statistical Science 11, 89-121; the effective dimension is the integral of 1 / (1 + (w b)^6).
    """
    selections = [_SplineSelection(*checked_points(x, y, 4), distances) for (x, y), distances in zip(lines, along or [None] * len(lines))]
    waiting = [line for line in selections if line.waiting]
    while waiting:
        check_cancelled()
        batch = _next_batch(waiting)
        fitted = iter(_penalised([(line.x, line.y, line.t, line.waiting[:count]) for line, count in batch]))
        for line, count in batch:
            line.take([next(fitted) for _ in range(count)])
        waiting = [line for line in waiting if line.waiting]
    return [line.fit() for line in selections]


def _next_batch(waiting):
    """[(line, number of its bandwidths)] that are fitted together: `spline_points_per_batch`, but at least one bandwidth of the first line."""
    batch, size = [], 0
    for line in waiting:
        count = min(max((FITS.spline_points_per_batch - size) // len(line.t), 0 if batch else 1), len(line.waiting))
        if not count:
            break
        batch.append((line, count))
        size += count * len(line.t)
    return batch


class _SplineSelection:
    """A line to which a spline is fitted: the bandwidths still to be tried, and the best fit so far."""

    def __init__(self, x, y, along):
        self.x, self.y = x, y
        self.t = _chord_lengths(x, y) if along is None else np.asarray(along, float) - along[0]
        self.length = float(self.t[-1])
        self.waiting = [b for b in FITS.bandwidths[::-1] if b < max(self.length, 2.5)]
        self.best = None

    def take(self, fitted):
        """Compare what was fitted with the first of the waiting bandwidths."""
        for b, spline in zip(self.waiting, fitted):
            fit = CurveFit(spline, spline[2], _effective_parameters(self.length, b))
            # the larger bandwidth wins unless the BIC of the smaller one is lower
            if self.best is None or fit.bic < self.best.bic:
                self.best = fit
        # skip bandwidths whose BIC could not be lower even with a perfect fit
        self.waiting = [b for b in self.waiting[len(fitted):]
                        if bic_lower_bound(len(self.t), _effective_parameters(self.length, b)) < self.best.bic]

    def fit(self):
        knots, control, across = self.best.curve
        curve = Spline(tuple(knots.tolist()), tuple(control[:, 0].tolist()), tuple(control[:, 1].tolist()))
        return CurveFit(curve, across, self.best.parameters)


def _effective_parameters(length, bandwidth):
    """The effective number of parameters of a coordinate."""
    return min(3 + length / (3 * bandwidth), _knot_intervals(length, bandwidth) + SPLINE_DEGREE)


def _chord_lengths(x, y):
    # noise makes raw chords too long; medians of five keep the parameter near the true length
    dx, dy = np.gradient(_smoothed(x)), np.gradient(_smoothed(y))
    step = np.hypot(np.diff(x), np.diff(y))
    forward = (np.diff(x) * (dx[:-1] + dx[1:]) + np.diff(y) * (dy[:-1] + dy[1:])) / np.maximum(
        np.hypot(dx[:-1] + dx[1:], dy[:-1] + dy[1:]), 1e-12)
    return np.r_[0.0, np.cumsum(np.maximum(forward, 0.2 * step + 1e-6))]


def _smoothed(values, reach=4):
    if len(values) <= reach:
        return values
    padded = np.r_[2 * values[0] - values[reach:0:-1], values, 2 * values[-1] - values[-2:-reach - 2:-1]]
    return np.convolve(padded, np.full(2 * reach + 1, 1 / (2 * reach + 1)), "valid")


def _penalised(lines):
    """[(knots, control points (K, 2), distances (N,) across the curve)] of (x, y, t, bandwidths), line by line, for each bandwidth."""
    basis = _SplineBasis([(t, bandwidths) for _, _, t, bandwidths in lines])
    middles = [np.array([x.mean(), y.mean()]) for x, y, _, bandwidths in lines for _ in bandwidths]
    places = np.concatenate([np.stack([x, y], axis=1) for x, y, _, bandwidths in lines for _ in bandwidths])
    places -= np.repeat(middles, basis.sizes, axis=0)

    def across(at, slope):
        gap = places - at
        return (gap[:, 1] * slope[:, 0] - gap[:, 0] * slope[:, 1]) / np.maximum(np.hypot(slope[:, 0], slope[:, 1]), 1e-12)

    return [(knots, control + middle, residuals)
            for knots, middle, (control, residuals) in zip(basis.knots, middles, basis.robustly_solved(places, across, FITS.max_reweightings))]


@dataclass(frozen=True)
class Profile:
    """A smooth function of (M,) t, metres, that gives (M,) metres, constant beyond both ends."""

    knots: np.ndarray   # (K + 4,) metres from `start`; none where it is `level` everywhere
    control: np.ndarray   # (K,) control points, metres above `level`
    level: float
    start: float   # t of the first place

    def __call__(self, at: np.ndarray) -> np.ndarray:
        if not len(self.knots):
            return np.full(np.shape(at), self.level)
        spline = BSpline(self.knots, self.control, SPLINE_DEGREE)
        return self.level + spline(np.clip(np.asarray(at, float) - self.start, 0.0, self.knots[-SPLINE_DEGREE - 1]))


def smooth_profiles(profiles: Sequence[tuple[np.ndarray, np.ndarray]], bandwidth: float) -> list[Profile]:
    """Robust smoothing splines of profiles, such as heights along lines, (t, values) with (N,) metres and t rising; `bandwidth` in metres."""
    functions = [Profile(np.empty(0), np.empty(0), median(values), 0.0) for _, values in profiles]
    smoothable = [k for k, (t, _) in enumerate(profiles) if len(t) >= 4 and t[-1] - t[0] >= 1.0]
    if smoothable:
        basis = _SplineBasis([(profiles[k][0] - profiles[k][0][0], [bandwidth]) for k in smoothable])
        places = np.concatenate([profiles[k][1] - functions[k].level for k in smoothable])
        solved = basis.robustly_solved(places[:, None], lambda at, slope: places - at[:, 0], FITS.max_profile_reweightings)
        for k, knots, (control, _) in zip(smoothable, basis.knots, solved):
            functions[k] = replace(functions[k], knots=knots, control=control[:, 0], start=float(profiles[k][0][0]))
    return functions

