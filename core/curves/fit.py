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
        size, rank = np.abs(self.residuals), 0.95 * (len(self.residuals) - 1)
        low = int(rank)
        high = min(low + 1, len(size) - 1)
        size.partition((low, high))
        return float(size[low] + (rank - low) * (size[high] - size[low]))

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


def medians(values):
    """(..., 1) median of every row of (..., N) float, N >= 1, without NaN."""
    low, high = (values.shape[-1] - 1) // 2, values.shape[-1] // 2
    ordered = np.partition(values, (low, high), axis=-1)
    return (ordered[..., low:low + 1] + ordered[..., high:high + 1]) / 2


def minimise(residuals, jacobian, start, scale):
    """Parameters that minimise soft L1 of the residuals, by Levenberg-Marquardt.

    Plain least squares first; where the curve cannot follow the points no residual
    is an outlier, so the scale of soft L1 grows with that misfit.

    residuals, jacobian : functions of the parameters (P,) giving (N,) and (N, P)
    scale : (P,) the size of a sensible step in each parameter
    """
    scale = np.asarray(scale, float)
    found = _levenberg(residuals, jacobian, np.asarray(start, float), scale, np.inf)
    misfit = 1.4826 * median(np.abs(residuals(found)))
    return _levenberg(residuals, jacobian, found, scale, max(F_SCALE, misfit))


def _levenberg(residuals, jacobian, found, scale, f_scale):
    def cost(r):
        return float(np.sum(r * r if np.isinf(f_scale) else 2 * f_scale**2 * (np.sqrt(1 + (r / f_scale) ** 2) - 1)))

    r = residuals(found)
    now, damping = cost(r), 1e-3
    for _ in range(100):
        weight = 1.0 / np.sqrt(1.0 + (r / f_scale) ** 2)
        j = jacobian(found) * scale
        # by the second derivative of soft L1, which is the weight's cube: the weight itself takes three times the steps
        normal, right = j.T @ (j * (weight**3)[:, None]), j.T @ (weight * r)
        diagonal = np.diagonal(normal) + 1e-12
        while True:
            damped = normal.copy()
            damped.flat[::len(found) + 1] += damping * diagonal
            step = -scale * np.linalg.solve(damped, right)
            further = found + step
            tried = residuals(further)
            then = cost(tried)
            if then <= now or damping > 1e8 or np.abs(step / scale).max() < 1e-9:
                break
            damping *= 8
        if not then <= now:
            return found
        done = now - then <= 1e-13 * now
        found, r, now, damping = further, tried, then, max(damping / 8, 1e-10)
        if done and np.abs(step / scale).max() < 1e-9:
            break
    return found


def checked(x, y, least):
    """x, y as float arrays of one length, at least `least` points; ValueError otherwise (a caller's mistake)."""
    go_on()  # every fit begins here, and a long drive has hundreds
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.shape != y.shape or x.ndim != 1 or len(x) < least:
        raise ValueError(f"a curve needs x and y of one length, at least {least} points; got {x.shape} and {y.shape}")
    return x, y


def chord(x, y):
    """Middle (2,) and direction (radians) of ordered points: the line through the two halves' centres.

    Unlike the principal axis this keeps the order of the points, and it does not
    turn where an arc is nearly half a circle.
    """
    half = max(1, len(x) // 2)
    return (np.array([x.mean(), y.mean()]),
            float(np.arctan2(y[-half:].mean() - y[:half].mean(), x[-half:].mean() - x[:half].mean())))
