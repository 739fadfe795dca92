"""Robust statistics of small arrays: soft L1 weights, medians and percentiles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

SOFT_L1_SCALE = 0.03  # m; the weight of larger residuals falls off (soft L1)
MAD_TO_SIGMA = 1.4826  # standard deviation of a normal distribution / its median absolute deviation


def robust_weights(residuals: np.ndarray) -> np.ndarray:
    """Weights of soft L1, ``1 / sqrt(1 + (r / c)^2)``.

    The scale c of each row is 1.4826 times the median of ``|r|``, at least `SOFT_L1_SCALE`.

    Parameters
    ----------
    residuals : (..., N) array, metres

    Returns
    -------
    (..., N) array: 1 for small residuals, falling as ``1 / |r|`` for large ones.
    """
    residuals = np.asarray(residuals)
    scale = np.maximum(SOFT_L1_SCALE, MAD_TO_SIGMA * row_medians(np.abs(residuals)))
    return 1.0 / np.sqrt(1.0 + (residuals / scale) ** 2)


def median(values: np.ndarray) -> float:
    """Median of (N,) floats, N >= 1, without NaN. Ten times as fast as `numpy.median` on small arrays."""
    middle = (len(values) - 1) // 2, len(values) // 2
    ordered = np.partition(values, middle)
    return float(ordered[middle[0]] + ordered[middle[1]]) / 2


def percentiles(values: np.ndarray, percents: Sequence[float]) -> list[float]:
    """`numpy.percentile` of (N,) floats, N >= 1, without NaN; faster on small arrays.

    Parameters
    ----------
    values : (N,) array
    percents : 0 to 100

    Returns
    -------
    list of float, one for each of `percents`.
    """
    positions = [percent / 100 * (len(values) - 1) for percent in percents]
    ranks = [(int(position), min(int(position) + 1, len(values) - 1)) for position in positions]
    ordered = np.partition(values, sorted({rank for pair in ranks for rank in pair}))
    found = []
    for position, (below, above) in zip(positions, ranks):
        share, low, high = position - below, float(ordered[below]), float(ordered[above])
        found.append(low + (high - low) * share if share < 0.5 else high - (high - low) * (1 - share))
    return found


def row_medians(values: np.ndarray) -> np.ndarray:
    """(..., 1) medians of the rows of (..., N) floats, N >= 1, without NaN."""
    low, high = (values.shape[-1] - 1) // 2, values.shape[-1] // 2
    ordered = np.partition(values, (low, high), axis=-1)
    return (ordered[..., low:low + 1] + ordered[..., high:high + 1]) / 2
