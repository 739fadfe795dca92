"""Robust smoothing of evenly spaced values, with gaps."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded

ROBUST_ROUNDS = 5
OUTLIER_FACTOR = 3.0   # of the median deviation, at which a value has half its weight


def robustly_smoothed(values: np.ndarray, weight: np.ndarray, stiffness: float) -> np.ndarray:
    """Smooth columns of values by a penalty on their second differences (Whittaker's smoother), outliers weighted down.

    Parameters
    ----------
    values : (N, C), evenly spaced; those of no weight may be anything finite
    weight : (N,) 0 for gaps, which are bridged; ends without weight are extrapolated
    stiffness : weight of a squared second difference against that of a squared deviation

    Returns
    -------
    (N, C) float64
    """
    values = np.asarray(values, float)
    if len(values) < 3:
        return values.copy()
    penalty = np.zeros((3, len(values)))
    for i, one in enumerate((1.0, -2.0, 1.0)):
        for j, other in enumerate((1.0, -2.0, 1.0)[:i + 1]):
            penalty[2 - (i - j), i:len(values) - 2 + i] += stiffness * one * other
    robust = np.ones(len(values))
    found = values
    for _ in range(ROBUST_ROUNDS):
        matrix = penalty.copy()
        matrix[2] += weight * robust + 1e-9
        found = solveh_banded(matrix, (weight * robust)[:, None] * values, check_finite=False)
        off = np.linalg.norm(values - found, axis=1)
        usual = float(np.median(off[weight > 0])) if (weight > 0).any() else 0.0
        robust = 1.0 / (1.0 + (off / (OUTLIER_FACTOR * usual + 1e-9)) ** 2)
    return found
