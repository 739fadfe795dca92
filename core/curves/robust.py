"""Robust statistics of small arrays, least squares of many curves at once, and smoothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.linalg import solveh_banded

from ..common.arrays import quantile_in_order
from ..common.parallel import check_cancelled
from .weights import FITS

MAD_TO_SIGMA = 1.4826  # derived: standard deviation of a normal distribution / its median absolute deviation


def robust_weights(residuals: np.ndarray) -> np.ndarray:
    """Weights of soft L1, ``1 / sqrt(1 + (r / c)^2)``, of (..., N) residuals in metres.

    The scale c of each row is 1.4826 times the median of ``|r|``, at least `soft_l1_scale`.
    """
    residuals = np.asarray(residuals)
    scale = np.maximum(FITS.soft_l1_scale, MAD_TO_SIGMA * row_medians(np.abs(residuals)))
    return 1.0 / np.sqrt(1.0 + (residuals / scale) ** 2)


def median(values: np.ndarray) -> float:
    """Median of (N,) floats, N >= 1, without NaN. Ten times as fast as `numpy.median` on small arrays."""
    middle = (len(values) - 1) // 2, len(values) // 2
    ordered = np.partition(values, middle)
    return float(ordered[middle[0]] + ordered[middle[1]]) / 2


def percentiles(values: np.ndarray, percents: Sequence[float]) -> list[float]:
    """`numpy.percentile` of (N,) floats, N >= 1, without NaN; faster on small arrays."""
    below = {int(percent / 100 * (len(values) - 1)) for percent in percents}
    ordered = np.partition(values, sorted(below | {min(rank + 1, len(values) - 1) for rank in below}))
    return [quantile_in_order(ordered, len(values), percent / 100) for percent in percents]


def row_medians(values: np.ndarray) -> np.ndarray:
    """(..., 1) medians of the rows of (..., N) floats, N >= 1, without NaN."""
    low, high = (values.shape[-1] - 1) // 2, values.shape[-1] // 2
    ordered = np.partition(values, (low, high), axis=-1)
    return (ordered[..., low:low + 1] + ordered[..., high:high + 1]) / 2


# Robust least squares of many curves at once.
#
# Each curve has a few hundred points only, for which the overhead of a numpy call exceeds its work, so the points of many lines are processed as
# one array.


class PointGroups:
    """Points of L lines in one array, one line after the other.

    counts : (L,) number of points of each line, at least 1
    starts : (L,) index of the first point of each line
    owner : (N,) index of the line of each point
    """

    def __init__(self, counts: Sequence[int] | np.ndarray) -> None:
        self.counts = np.asarray(counts, np.int64)
        self.starts = np.cumsum(self.counts) - self.counts
        self.owner = np.repeat(np.arange(len(self.counts)), self.counts)

    def sums(self, values: np.ndarray) -> np.ndarray:
        """(..., L) sums of (..., N) values over the points of each line."""
        return np.add.reduceat(values, self.starts, axis=-1)

    def medians(self, values: np.ndarray) -> np.ndarray:
        """(L,) medians of (N,) values over the points of each line."""
        ordered = values[np.lexsort((values, self.owner))]
        return (ordered[self.starts + (self.counts - 1) // 2] + ordered[self.starts + self.counts // 2]) / 2

    def maxima(self, values: np.ndarray) -> np.ndarray:
        return np.maximum.reduceat(values, self.starts)

    def subsampled(self, max_points: int) -> np.ndarray:
        """Rows of at most `max_points` points of each line, evenly spread, with the first and the last."""
        if self.counts.max() <= max_points:
            return np.arange(len(self.owner))
        step = np.maximum((self.counts - 1) / (max_points - 1), 1.0)
        sizes = np.minimum(self.counts, max_points)
        within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        return np.repeat(self.starts, sizes) + np.rint(within * np.repeat(step, sizes)).astype(np.int64)


def batches(counts: Sequence[int] | np.ndarray, max_points: int = FITS.fit_points_per_batch) -> list[tuple[int, int]]:
    """[(first, end)] of successive lines with at most `max_points` points together; a single line may have more."""
    ranges, first, size = [], 0, 0
    for k, count in enumerate(counts):
        if k > first and size + count > max_points:
            ranges.append((first, k))
            first, size = k, 0
        size += count
    return [*ranges, (first, len(counts))] if len(counts) else []


def fit_batch(lines: Sequence[tuple[np.ndarray, np.ndarray]], problem_of: Callable[..., Any], max_misfit: float = np.inf) -> list[Any]:
    """Fit curves of one kind to many lines; the result of a line does not depend on the others.

    Each curve is fitted to a subsample of its line first, which takes most of the steps, then to all points, unless its misfit is too large.

    lines : list of (x, y), each (N,) metres, ordered along the line
    problem_of : makes a problem for `_minimise_batch` from PointGroups, x and y; it also has `start()`, (L, P), `scale`,
        `fit(k, unknown, x, y, residuals, state)`, which gives what is returned for line k, and
        `with_points(points, x, y, lines, state)`: the same unknowns for more points of some of its lines
    max_misfit : metres; a curve from which a twentieth of the points lie farther is not refined with all points
    """
    fits = [None] * len(lines)
    counts = np.array([len(x) for x, _ in lines], np.int64)
    for first, end in batches(np.minimum(counts, FITS.coarse_points)):
        numbers = np.arange(first, end)
        whole = PointGroups(counts[numbers])
        x, y = (np.concatenate([lines[k][axis] for k in numbers]) for axis in (0, 1))
        rows = whole.subsampled(FITS.coarse_points)
        problem = problem_of(PointGroups(np.minimum(whole.counts, FITS.coarse_points)), x[rows], y[rows])
        tolerance = np.where(whole.counts <= FITS.coarse_points, FITS.fit_tolerance, FITS.coarse_fit_tolerance)
        solved = _minimise_batch(problem, problem.start(), problem.scale, tolerance, max_misfit)
        _store_fits(fits, numbers, np.flatnonzero(whole.counts <= FITS.coarse_points), problem, lines, *solved)
        long = np.flatnonzero(whole.counts > FITS.coarse_points)
        for a, b in batches(whole.counts[long]):
            indices = np.concatenate([np.arange(whole.starts[k], whole.starts[k] + whole.counts[k]) for k in long[a:b]])
            state = tuple(np.interp(indices, rows, values) for values in solved[2])
            part = problem.with_points(PointGroups(whole.counts[long[a:b]]), x[indices], y[indices], long[a:b], state)
            _refine(fits, numbers[long[a:b]], part, lines, solved[0][long[a:b]], max_misfit)
    return fits


def _refine(found, numbers, problem, lines, unknown, max_misfit):
    """Fit the lines of a problem from unknowns that are nearly right; those with a large misfit stay as they are."""
    residuals, state = problem.evaluate(unknown, problem.state)
    missed = problem.groups.sums((np.abs(residuals) > max_misfit).astype(float)) > FITS.max_misfit_share * problem.groups.counts
    _store_fits(found, numbers, np.flatnonzero(missed), problem, lines, unknown, residuals, state)
    left = np.flatnonzero(~missed)
    if len(left):
        problem = problem.subset(left, np.flatnonzero(~missed[problem.groups.owner]))
        _store_fits(found, numbers[left], np.arange(len(left)), problem, lines, *_minimise_batch(problem, unknown[left], problem.scale))


def _store_fits(found, numbers, which, problem, lines, unknown, residuals, state):
    for k in which.tolist():
        rows = slice(problem.groups.starts[k], problem.groups.starts[k] + problem.groups.counts[k])
        x, y = lines[numbers[k]]
        found[numbers[k]] = problem.fit(k, unknown[k], x, y, residuals[rows], tuple(values[rows] for values in state))


def _minimise_batch(problem: Any, start: np.ndarray, scale: np.ndarray, tolerance: float | np.ndarray = FITS.fit_tolerance,
                    max_misfit: float = np.inf) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, ...]]:
    """Parameters of each line that minimise the soft L1 loss of its residuals, by Levenberg-Marquardt.

    Plain least squares comes first; where the curve cannot follow the points, no residual is an outlier, so the scale of soft L1 grows with that
    misfit. The result of a line does not depend on the other lines.

    Parameters
    ----------
    problem : has `points` (PointGroups of L lines); `evaluate(unknown, state)`, which returns (N,) residuals and the new state, a tuple of (N,)
        arrays; `jacobian(unknown, state)`, (P, N); `subset(lines, rows)`, the problem of some lines, whose points are `rows`; and the initial
        `state`
    start : (L, P) initial parameters
    scale : (L, P) the size of a sensible step in each parameter
    tolerance : (L,) or one; the share of such a step below which the fit has converged
    max_misfit : metres; a line with a larger root mean square residual is given up once steps gain little

    Returns
    -------
    unknown : (L, P) parameters
    residuals : (N,) metres
    state : tuple of (N,) arrays, the state of the residuals
    """
    exact = np.broadcast_to(tolerance, len(start))
    unknown, residuals, state = _levenberg_marquardt(problem, np.array(start, float), scale, np.full(len(start), np.inf), problem.state,
                                                     np.maximum(exact, FITS.coarse_fit_tolerance / 10), max_misfit)
    misfit = MAD_TO_SIGMA * problem.groups.medians(np.abs(residuals))
    return _levenberg_marquardt(problem, unknown, scale, np.maximum(FITS.soft_l1_scale, misfit), state, exact, max_misfit)


def _levenberg_marquardt(problem, found, scale, f_scale, state, exact, max_misfit):
    size = found.shape[1]
    above, below = np.triu_indices(size)
    diagonal = np.arange(size)
    results = None
    lines, rows = np.arange(len(found)), slice(None)
    residuals, state = problem.evaluate(found, state)
    cost, damping, steps = _cost(problem, residuals, f_scale), np.full(len(found), 1e-3), np.zeros(len(found), int)
    while True:
        check_cancelled()
        groups = problem.groups
        owner = groups.owner
        weight = 1.0 / np.sqrt(1.0 + (residuals / f_scale[owner]) ** 2)
        jacobian = problem.jacobian(found, state)
        # by the second derivative of soft L1, which is the weight's cube: the weight itself takes three times the steps
        weighted = jacobian * weight**3
        normal = np.empty((len(found), size, size))
        normal[:, above, below] = normal[:, below, above] = groups.sums(jacobian[above] * weighted[below]).T
        normal *= scale[:, :, None] * scale[:, None, :]
        right = groups.sums(jacobian * (weight * residuals)).T * scale
        normal[:, diagonal, diagonal] += damping[:, None] * (normal[:, diagonal, diagonal] + 1e-12)
        step = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
        proposed = found - scale * step
        tried, new = problem.evaluate(proposed, state)
        new_cost = _cost(problem, tried, f_scale)
        better, small = new_cost <= cost, np.abs(step).max(axis=1) < exact
        steps += better
        gain = cost - new_cost
        given_up = (gain <= FITS.stalled_gain * cost) & (new_cost > groups.counts * max_misfit**2)
        over = np.where(better, (gain <= 1e-4 * exact * cost) & small | given_up | (steps >= FITS.max_steps), (damping > FITS.max_damping) | small)
        damping = np.where(better, np.maximum(damping / 8, 1e-10), damping * 8)
        if better.all():
            found, residuals, state, cost = proposed, tried, new, new_cost
        else:
            members = better[owner]
            found, cost = np.where(better[:, None], proposed, found), np.where(better, new_cost, cost)
            residuals = np.where(members, tried, residuals)
            state = tuple(np.where(members, a, b) for a, b in zip(new, state))
        if not over.any():
            continue
        if results is None:
            if over.all():
                return found, residuals, state
            results = found.copy(), residuals.copy(), tuple(values.copy() for values in state)
            rows = np.arange(len(residuals))
        results[0][lines], results[1][rows] = found, residuals
        for result, values in zip(results[2], state):
            result[rows] = values
        if over.all():
            return results
        left = np.flatnonzero(~over)
        members = np.flatnonzero(~over[owner])
        problem = problem.subset(left, members)
        lines, rows = lines[left], rows[members]
        found, scale, f_scale, exact = found[left], scale[left], f_scale[left], exact[left]
        cost, damping, steps = cost[left], damping[left], steps[left]
        residuals, state = residuals[members], tuple(values[members] for values in state)


def _cost(problem, residuals, f_scale):
    """(L,) sum of squares, or of soft L1 where `f_scale` is finite (of all lines or of none)."""
    if np.isinf(f_scale[0]):
        return problem.groups.sums(residuals * residuals)
    scale = f_scale[problem.groups.owner]
    return problem.groups.sums(2 * scale**2 * (np.sqrt(1 + (residuals / scale) ** 2) - 1))


def minimise(residuals: Callable[[np.ndarray], np.ndarray], jacobian: Callable[[np.ndarray], np.ndarray], start: Sequence[float] | np.ndarray,
             scale: Sequence[float] | np.ndarray, max_misfit: float = np.inf) -> np.ndarray:
    """(P,) parameters of one curve by `_minimise_batch`, from functions of these that give (N,) residuals and their (N, P) derivatives."""
    problem = _SingleCurve(residuals, jacobian, start)
    return _minimise_batch(problem, problem.first[None, :], np.asarray(scale, float)[None, :], max_misfit=max_misfit)[0][0]


class _SingleCurve:
    state = ()

    def __init__(self, residuals, jacobian, start):
        self.residuals, self.by, self.first = residuals, jacobian, np.asarray(start, float)
        self.groups = PointGroups([len(residuals(self.first))])

    def evaluate(self, unknown, state):
        return self.residuals(unknown[0]), ()

    def jacobian(self, unknown, state):
        return self.by(unknown[0]).T


# Robust smoothing of evenly spaced values, with gaps.


def robustly_smoothed(values: np.ndarray, weight: np.ndarray, stiffness: float) -> np.ndarray:
    """Smooth columns of values by a penalty on their second differences (Whittaker's smoother), outliers weighted down.

    values : (N, C), evenly spaced; those of no weight may be anything finite
    weight : (N,) 0 for gaps, which are bridged; ends without weight are extrapolated
    stiffness : weight of a squared second difference against that of a squared deviation

    Returns (N, C) float64.
    """
    values = np.asarray(values, float)
    if len(values) < 3:
        return values.copy()
    penalty = np.zeros((3, len(values)))
    for i, a in enumerate((1.0, -2.0, 1.0)):
        for j, b in enumerate((1.0, -2.0, 1.0)[:i + 1]):
            penalty[2 - (i - j), i:len(values) - 2 + i] += stiffness * a * b
    robust = np.ones(len(values))
    smoothed = values
    for _ in range(FITS.robust_rounds):
        matrix = penalty.copy()
        matrix[2] += weight * robust + 1e-9
        smoothed = solveh_banded(matrix, (weight * robust)[:, None] * values, check_finite=False)
        off = np.linalg.norm(values - smoothed, axis=1)
        usual = float(np.median(off[weight > 0])) if (weight > 0).any() else 0.0
        robust = 1.0 / (1.0 + (off / (FITS.outlier_factor * usual + 1e-9)) ** 2)
    return smoothed
