"""Fit a curve of a given kind, or the simplest kind that describes the points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

import numpy as np

from ..common.errors import RoadExtractionError
from .base import CurveFit, bic_lower_bound
from .bspline import fit_splines
from .clothoid import fit_clothoids
from .simple_curves import fit_circles, fit_ellipse, fit_lines, fit_polynomial
from .weights import FITS

CURVES = ("automatic", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline")
MIN_CURVE_PARAMETERS = 3  # derived: of any curve but a straight line
MAX_MISFIT = 10 * FITS.max_residual_p95  # derived: m; a curve farther off is not fitted to the millimetre


def fit_curve(x: np.ndarray, y: np.ndarray, curve: str = "automatic", degree: int = 2) -> CurveFit:
    """Fit a curve of one kind, or select the simplest acceptable kind.

    "automatic" fits line, circle, clothoid, ellipse and B-spline and selects the simplest whose BIC is within 6 of the best and whose 95th
    percentile of the residuals is below 5 cm. It never selects a polynomial, which is not an element of road design.

    x, y : (N,) metres, about one point per 0.25 m, ordered along the line
    curve : one of CURVES
    degree : of the polynomial

    Raises RoadExtractionError if the kind is unknown or these points do not allow it.
    """
    if curve not in CURVES:
        raise RoadExtractionError(f"There is no curve called {curve!r}. Choose one of {', '.join(CURVES)}.")
    if curve == "automatic":
        return fit_curves([(x, y)])[0]
    least = {"line": 2, "circle": 3, "ellipse": 6, "clothoid": 5, "polynomial": degree + 1, "b-spline": 4}[curve]
    if len(x) < least:
        raise RoadExtractionError(f"A {curve} needs at least {least} places along the line, there are {len(x)}. Choose curve = automatic.")
    if curve == "polynomial":
        return fit_polynomial(x, y, degree)
    if curve == "ellipse":
        return fit_ellipse(x, y)
    fits: dict[str, Callable[..., list[CurveFit]]] = {"line": fit_lines, "circle": fit_circles, "clothoid": fit_clothoids, "b-spline": fit_splines}
    return fits[curve]([(x, y)])[0]


def fit_curves(lines: Sequence[tuple[np.ndarray, np.ndarray]], elements: bool = False) -> list[CurveFit]:
    """The simplest acceptable curve of each of many lines, (x, y) of (N,) metres, selected as `fit_curve` does.

    If no kind is acceptable, it is the one with the smallest 95th percentile of the residuals. What it is does not depend on the other lines.

    elements : whether the lines are elements of an alignment: straight lines, circles or clothoids, however far off
    """
    choices = [_ModelSelection(np.inf if elements else FITS.max_residual_p95) for _ in lines]
    kinds: Sequence[tuple[str, int, Callable[..., list[CurveFit]]]] = ALIGNMENT_CURVES
    for name, fewest, fit_all in kinds if elements else (*kinds, ("ellipse", 12, _ellipses), ("b-spline", 6, fit_splines)):
        # kinds that cannot change a selection are not fitted
        open_ones = [k for k, choice in enumerate(choices) if not choice.decided and len(lines[k][0]) >= fewest
                     and (name != "ellipse" or choice.turn > FITS.min_ellipse_turn)]
        for k, fit in zip(open_ones, fit_all([lines[k] for k in open_ones])):
            if fit is not None:
                choices[k].add(fit)
    return [choice.best or min(choice.found, key=lambda fit: fit.residual_p95) for choice in choices]


def _ellipses(lines):
    """Fits, None where the points are not on an ellipse or miss it by more than MAX_MISFIT."""
    fits: list[CurveFit | None] = [None] * len(lines)
    for k, line in enumerate(lines):
        with suppress(RoadExtractionError):
            fit = fit_ellipse(*line, MAX_MISFIT)
            fits[k] = fit if fit.residual_p95 <= MAX_MISFIT else None
    return fits


# (name, minimum number of points, function of a list of lines) of the elements of a road alignment, simplest first
ALIGNMENT_CURVES = tuple((name, fewest, partial(fit_all, max_misfit=MAX_MISFIT))
                         for name, fewest, fit_all in (("line", 2, fit_lines), ("circle", 4, fit_circles), ("clothoid", 8, fit_clothoids)))


class _ModelSelection:
    """Selects among fits that are added, simplest first.

    The first fit whose BIC is within 6 of the best and whose 95th percentile of the residuals is below `max_residual` metres is `best`.

    found : list of CurveFit added so far
    decided : whether no further fit can change the selection
    """

    def __init__(self, max_residual: float = np.inf) -> None:
        self.found: list[CurveFit] = []
        self.decided = False
        self._max_residual = max_residual

    def add(self, fit: CurveFit) -> None:
        """Add the fit of the next kind."""
        self.found.append(fit)
        least = bic_lower_bound(len(fit.residuals), MIN_CURVE_PARAMETERS)
        for candidate in self._acceptable():
            if candidate.bic <= least + FITS.bic_margin:
                self.decided = True  # whatever may follow
            if candidate.bic <= self._best_bic() + FITS.bic_margin:
                break                # what follows decides

    def _acceptable(self):
        return [fit for fit in self.found if fit.residual_p95 < self._max_residual]

    def _best_bic(self):
        return min(fit.bic for fit in self.found)

    @property
    def best(self) -> CurveFit | None:
        """The selected fit, or None if none is acceptable."""
        return next((fit for fit in self._acceptable() if fit.bic <= self._best_bic() + FITS.bic_margin), None)

    @property
    def turn(self) -> float:
        """Angle by which the fitted circle turns, radians; 0 without one."""
        return max((abs(fit.curve.bend) * fit.curve.length for fit in self.found if fit.curve.kind == "circle"), default=0.0)


