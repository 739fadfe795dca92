"""What a fit of a curve gives back, and the robust least squares that all fits share."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..parallel import go_on

F_SCALE = 0.03        # m: residuals beyond this count less and less (soft L1)
NOISE_FLOOR = 0.004   # m: below it a smaller residual is no reason for a more complex curve


@dataclass(frozen=True)
class Fit:
    """A curve with how well it fits.

    residuals : (N,) signed orthogonal distances of the points, left of the curve positive, metres
    parameters : how many free numbers the curve has (for BIC and AIC)
    """

    curve: object
    residuals: np.ndarray
    parameters: float

    @property
    def rmse(self):
        """Root mean square of the orthogonal residuals, metres; outliers count in full."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @cached_property
    def worst(self):
        """95 % of the residuals are smaller, metres."""
        return percentiles(np.abs(self.residuals), (95.0,))[0]

    @cached_property
    def _information(self):
        n = len(self.residuals)
        spread = 2 * F_SCALE**2 * np.sum(np.sqrt(1 + (self.residuals / F_SCALE) ** 2) - 1) / n
        return n * np.log(max(spread, NOISE_FLOOR**2))

    @property
    def bic(self):
        """n ln(RSS/n) + p ln n with the robust RSS that was minimised."""
        return float(self._information + self.parameters * np.log(len(self.residuals)))

    @property
    def aic(self):
        """n ln(RSS/n) + 2 p."""
        return float(self._information + 2 * self.parameters)


def least_bic(count, parameters):
    """What the BIC of no fit of `count` points with at least so many parameters is below."""
    return count * np.log(NOISE_FLOOR**2) + parameters * np.log(count)


def robust_weights(residuals):
    """(..., N) weights of soft L1: 1 for small residuals, falling as 1/|r| for large ones; each row has its own scale."""
    residuals = np.asarray(residuals)
    scale = np.maximum(F_SCALE, 1.4826 * medians(np.abs(residuals)))
    return 1.0 / np.sqrt(1.0 + (residuals / scale) ** 2)


def median(values):
    """Median of (N,) float, N >= 1, without NaN; np.median takes ten times as long over so few."""
    middle = (len(values) - 1) // 2, len(values) // 2
    ordered = np.partition(values, middle)
    return float(ordered[middle[0]] + ordered[middle[1]]) / 2


def percentiles(values, shares):
    """np.percentile of (N,) float, N >= 1, without NaN, at shares in %, each a float."""
    at = [share / 100 * (len(values) - 1) for share in shares]
    ranks = [(int(rank), min(int(rank) + 1, len(values) - 1)) for rank in at]
    ordered = np.partition(values, sorted({rank for pair in ranks for rank in pair}))
    found = []
    for rank, (low, high) in zip(at, ranks):
        share, low, high = rank - low, float(ordered[low]), float(ordered[high])
        found.append(low + (high - low) * share if share < 0.5 else high - (high - low) * (1 - share))
    return found


def medians(values):
    """(..., 1) median of every row of (..., N) float, N >= 1, without NaN."""
    low, high = (values.shape[-1] - 1) // 2, values.shape[-1] // 2
    ordered = np.partition(values, (low, high), axis=-1)
    return (ordered[..., low:low + 1] + ordered[..., high:high + 1]) / 2


def checked(x, y, least):
    """x, y as float arrays of one length, at least `least` points; ValueError otherwise (a caller's mistake)."""
    go_on()  # every fit begins here, and a long drive has hundreds
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.shape != y.shape or x.ndim != 1 or len(x) < least:
        raise ValueError(f"a curve needs x and y of one length, at least {least} points; got {x.shape} and {y.shape}")
    return x, y
