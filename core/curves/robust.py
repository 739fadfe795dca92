"""Robust statistics of small arrays, least squares of a curve, and smoothing."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

import numpy as np
from scipy.linalg import solveh_banded
from scipy.optimize import least_squares

from ..common.arrays import quantile_in_order
from .weights import FITS

MAD_TO_SIGMA = 1.4826  # derived: standard deviation of a normal distribution / its median absolute deviation


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


# Robust least squares of one curve.


class CurveProblem:
    """A curve of some kind to be fitted to points, in a frame at their centroid; base of all kinds but splines.

    centre : (2,) m, the centroid; x, y : (N,) m from there
    direction : radians, from the centroid of the first half of the points to that of the second. Unlike the principal axis it keeps the order of
        the points, and it does not turn where an arc is nearly half a circle
    """

    def __init__(self, x: np.ndarray, y: np.ndarray) -> None:
        self.centre, half = np.array([x.mean(), y.mean()]), max(len(x) // 2, 1)
        self.x, self.y = x - self.centre[0], y - self.centre[1]
        self.direction = float(np.arctan2(y[-half:].sum() - y[:half].sum(), x[-half:].sum() - x[:half].sum()))

    def start(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(P,) unknowns to begin with, (P,) the size of a sensible step of each, and (N,) where the points lie along the curve, if that is kept."""
        raise NotImplementedError

    def evaluate(self, unknown: np.ndarray, along: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(N,) signed distances of the points, m, (P, N) their derivatives, and the places along the curve that the next step begins from."""
        raise NotImplementedError

    def fitted(self, max_misfit: float = np.inf) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(P,) unknowns at the least soft L1 of the distances, these (N,), m, and the places along the curve.

        An even share of many points comes first. A curve from which a twentieth of all points lie farther than `max_misfit`, m, stays at that.
        """
        rows = np.rint(np.linspace(0, len(self.x) - 1, min(len(self.x), FITS.coarse_points))).astype(np.int64)
        part = copy(self)
        part.x, part.y = self.x[rows], self.y[rows]
        unknown, scale, along = part.start()
        unknown, along = _least_soft_l1(part, unknown, scale, along, FITS.fit_tolerance if len(rows) == len(self.x) else FITS.coarse_fit_tolerance)
        along = np.interp(np.arange(len(self.x)), rows, along)
        if len(rows) < len(self.x) and np.mean(np.abs(self.evaluate(unknown, along)[0]) > max_misfit) <= FITS.max_misfit_share:
            unknown, along = _least_soft_l1(self, unknown, scale, along)
        distances, _, along = self.evaluate(unknown, along)
        return unknown, distances, along


def _least_soft_l1(problem, unknown, scale, along, tolerance=FITS.fit_tolerance):
    """Unknowns at the least soft L1, and the places along the curve there, by the Levenberg-Marquardt of MINPACK.

    Plain least squares comes first; where the curve cannot follow the points, no distance is an outlier: the scale of soft L1 grows with that misfit.
    """
    tried, limit = None, np.inf

    def distances(unknown):
        nonlocal tried
        tried = problem.evaluate(unknown, along)
        # their squares add up to the soft L1 of the distances
        return tried[0] * np.sqrt(2 / (1 + np.sqrt(1 + (tried[0] / limit) ** 2)))

    def derivatives(_):
        # asked for where a step was taken, which is what was tried last
        nonlocal along
        along = tried[2]
        root = np.sqrt(1 + (tried[0] / limit) ** 2)
        return (tried[1] * np.sqrt((1 + root) / 2) / root).T

    for stage_tolerance in (FITS.coarse_fit_tolerance, tolerance):
        unknown = least_squares(distances, unknown, derivatives, x_scale=scale, method="lm", ftol=stage_tolerance, xtol=stage_tolerance).x
        limit = max(FITS.soft_l1_scale, MAD_TO_SIGMA * median(np.abs(problem.evaluate(unknown, along)[0])))
    return unknown, along


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
