"""Fit a named curve, or the simplest that the points allow."""

import numpy as np

from ..errors import RoadExtractionError
from .arcs import fit_circle, fit_line
from .clothoid import Clothoid
from .curve import Arc
from .ellipse import Ellipse, fit_ellipse
from .fit import least_bic
from .polynomial import Polynomial, fit_polynomial
from .spline import Spline, fit_spline
from .transitions import fit_clothoid

CURVES = ("automatic", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline")
WORST_RESIDUAL = 0.05  # m: 95 % of the points must be nearer than this to a simpler curve
FEWEST_NUMBERS = 3     # that any curve but a straight line has
BIC_MARGIN = 6.0       # a simpler curve is taken while its BIC is within this of the best


def fit_curve(x, y, curve="automatic", degree=2, along=None):
    """The curve of one kind, or the simplest acceptable one.

    Automatic fits line, circle, clothoid, ellipse and B-spline and takes the
    simplest whose BIC is within 6 of the best and whose 95 % residual is below
    5 cm. A polynomial is never chosen: it is no shape of a road.

    Parameters
    ----------
    x, y : (N,) metres, thinned (one place per 0.25 m or so), ordered along the line
    curve : one of CURVES
    degree : of the polynomial
    along : (N,) distances along the line where they are known, metres (B-spline only)

    Returns
    -------
    Fit

    Raises
    ------
    RoadExtractionError
        If the kind is unknown or these points cannot carry it.
    """
    if curve not in CURVES:
        raise RoadExtractionError(f"There is no curve called {curve!r}. Choose one of {', '.join(CURVES)}.")
    if curve == "automatic":
        return choose(candidates(x, y, along))
    least = {"line": 2, "circle": 3, "ellipse": 6, "clothoid": 5, "polynomial": degree + 1, "b-spline": 4}[curve]
    if len(x) < least:
        raise RoadExtractionError(
            f"A {curve} needs at least {least} places along the line, there are {len(x)}. Choose curve = automatic.")
    fits = {"line": fit_line, "circle": fit_circle, "ellipse": fit_ellipse, "clothoid": fit_clothoid}
    if curve == "polynomial":
        return fit_polynomial(x, y, degree)
    if curve == "b-spline":
        return fit_spline(x, y, along)
    return fits[curve](x, y)


def candidates(x, y, along=None):
    """Yields fits of line, circle, clothoid, ellipse and B-spline, simplest first, without those the points cannot carry."""
    yield fit_line(x, y)
    turn = 0.0
    if len(x) >= 4:
        circle = fit_circle(x, y)
        turn = abs(circle.curve.bend) * circle.curve.length
        yield circle
    if len(x) >= 8:
        yield fit_clothoid(x, y)
    if len(x) >= 12 and turn > np.radians(60.0):
        try:
            yield fit_ellipse(x, y)
        except RoadExtractionError:
            pass
    if len(x) >= 6:
        yield fit_spline(x, y, along)


def choose(fits):
    """The first (simplest) fit whose BIC is within 6 of the best and whose 95 % residual is below 5 cm.

    Where none is that close, the one of the least 95 % residual.
    """
    seen = []
    return simplest((seen.append(fit) or fit for fit in fits), WORST_RESIDUAL) or min(seen, key=lambda fit: fit.worst)


def simplest(fits, worst=np.inf):
    """The first fit whose BIC is within 6 of the best and whose 95 % residual is below `worst`; None where there is none.

    fits : an iterable of Fit, simplest first; no more are made than are needed to know
    """
    found = []
    for fit in fits:
        found.append(fit)
        least = least_bic(len(fit.residuals), FEWEST_NUMBERS)
        for one in found:
            if one.worst < worst and one.bic <= least + BIC_MARGIN:
                return one  # whatever may follow
            if one.worst < worst and one.bic <= min(other.bic for other in found) + BIC_MARGIN:
                break       # what follows decides
    best = min(fit.bic for fit in found)
    return next((fit for fit in found if fit.worst < worst and fit.bic <= best + BIC_MARGIN), None)


_NUMBERS = {
    "clothoid": (Clothoid, ("x", "y", "direction", "bend", "change", "length")),
    "ellipse": (Ellipse, ("x", "y", "a", "b", "tilt", "first", "last")),
    "polynomial": (Polynomial, ("x", "y", "tilt", "scale", "coefficients", "first", "last")),
    "b-spline": (Spline, ("knots", "control_x", "control_y")),
    "line": (Arc, ("x", "y", "direction", "bend", "length")),
    "circle": (Arc, ("x", "y", "direction", "bend", "length")),
}


def curve_of(params):
    """The curve of a dict that `Curve.params` made (or of its JSON, loaded); other entries are ignored."""
    kind = params["curve"]
    if kind not in _NUMBERS:
        raise RoadExtractionError(f"There is no curve called {kind!r}. Choose one of {', '.join(CURVES[1:])}.")
    maker, names = _NUMBERS[kind]
    return maker(*(tuple(params[name]) if isinstance(params[name], list) else params[name] for name in names))
