"""The result of a fit: a curve with its residuals and information criteria."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..common.parallel import check_cancelled
from .robust import SOFT_L1_SCALE, percentiles

NOISE_FLOOR = 0.004  # m; a residual below it does not justify a more complex curve


@dataclass(frozen=True)
class CurveFit:
    """A curve and how well it fits.

    curve : Curve, as a rule; the fits of splines put their unfinished curve here
    residuals : (N,) signed orthogonal distances of the points, metres, positive left of the curve
    parameters : number of free parameters of the curve (for BIC and AIC); a smoothing spline has an effective number
    """

    curve: Any
    residuals: np.ndarray
    parameters: float

    @property
    def rmse(self) -> float:
        """Root mean square of the orthogonal residuals, metres; outliers count in full."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @cached_property
    def residual_p95(self) -> float:
        """95th percentile of the absolute residuals, metres."""
        return percentiles(np.abs(self.residuals), (95.0,))[0]

    @cached_property
    def _information(self) -> float:
        n = len(self.residuals)
        mean_loss = 2 * SOFT_L1_SCALE**2 * np.sum(np.sqrt(1 + (self.residuals / SOFT_L1_SCALE) ** 2) - 1) / n
        return n * np.log(max(mean_loss, NOISE_FLOOR**2))

    @property
    def bic(self) -> float:
        """Bayesian information criterion ``n ln(RSS/n) + p ln n``, with the soft L1 loss that was minimised as RSS."""
        return float(self._information + self.parameters * np.log(len(self.residuals)))


def bic_lower_bound(points: int, parameters: float) -> float:
    """Lower bound of the BIC of every fit to so many points with at least so many parameters."""
    return points * np.log(NOISE_FLOOR**2) + parameters * np.log(points)


def checked_points(x: np.ndarray, y: np.ndarray, min_points: int) -> tuple[np.ndarray, np.ndarray]:
    """The points of a line as float arrays.

    Parameters
    ----------
    x, y : (N,) metres
    min_points : how many the curve needs

    Returns
    -------
    x, y : (N,) float64

    Raises
    ------
    ValueError
        If the arrays differ in shape or are too short: a mistake of the caller, not of the data.
    """
    check_cancelled()  # every fit begins here, and a long drive has hundreds
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.shape != y.shape or x.ndim != 1 or len(x) < min_points:
        raise ValueError(f"a curve needs x and y of one length, at least {min_points} points; got {x.shape} and {y.shape}")
    return x, y
