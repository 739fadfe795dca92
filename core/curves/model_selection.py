"""Fit a named curve, or the simplest that the points allow."""

import numpy as np

from ..common.errors import RoadExtractionError
from .base import Arc, least_bic
from .batched_lsq import FEW, Places
from .bspline import Spline, fit_spline, fit_splines
from .clothoid import Clothoid, fit_clothoid, fit_clothoids
from .ellipse import Ellipse, fit_ellipse
from .line_circle import fit_circle, fit_circles, fit_line, fit_lines
from .polynomial import Polynomial, fit_polynomial

CURVES = ("automatic", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline")
WORST_RESIDUAL = 0.05  # m: 95 % of the points must be nearer than this to a simpler curve
FEWEST_NUMBERS = 3     # that any curve but a straight line has
HOPELESS = 10 * WORST_RESIDUAL  # what is farther off is not fitted to the millimetre
LEAST_TURN = np.radians(60.0)  # of a circle that may be an ellipse
BIC_MARGIN = 6.0       # a simpler curve is taken while its BIC is within this of the best


def fit_curve(x, y, curve="automatic", degree=2):
    """The curve of one kind, or the simplest acceptable one.

    Automatic fits line, circle, clothoid, ellipse and B-spline and takes the
    simplest whose BIC is within 6 of the best and whose 95 % residual is below
    5 cm. A polynomial is never chosen: it is no shape of a road.

    Parameters
    ----------
    x, y : (N,) metres, thinned (one place per 0.25 m or so), ordered along the line
    curve : one of CURVES
    degree : of the polynomial

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
        return fit_curves([(x, y)])[0]
    least = {"line": 2, "circle": 3, "ellipse": 6, "clothoid": 5, "polynomial": degree + 1, "b-spline": 4}[curve]
    if len(x) < least:
        raise RoadExtractionError(
            f"A {curve} needs at least {least} places along the line, there are {len(x)}. Choose curve = automatic.")
    fits = {"line": fit_line, "circle": fit_circle, "ellipse": fit_ellipse, "clothoid": fit_clothoid, "b-spline": fit_spline}
    return fit_polynomial(x, y, degree) if curve == "polynomial" else fits[curve](x, y)


def fit_curves(places):
    """The simplest acceptable curve of each of many lines, as `fit_curve` takes it, all fitted together: a list of (x, y) to a list of Fit.

    Where no curve is near enough, the one of the least 95 % residual.
    """
    choices = choose_each(places, (*ALIGNMENT, ("ellipse", 12, _ellipses), ("b-spline", 6, fit_splines)), WORST_RESIDUAL)
    return [choice.best or min(choice.found, key=lambda fit: fit.worst) for choice in choices]


def _lines(places):
    return fit_lines(places, HOPELESS)


def _circles(places):
    return fit_circles(places, HOPELESS)


def _clothoids(places):
    return fit_clothoids(places, HOPELESS)


def _ellipses(places):
    """Fits, None of what is no ellipse or misses by more than HOPELESS."""
    return [_ellipse(x, y) for x, y in places]


def _ellipse(x, y):
    rows = Places([len(x)]).thinned(FEW)
    try:
        few = fit_ellipse(x[rows], y[rows], HOPELESS)
        if len(rows) == len(x):
            return few
        return fit_ellipse(x, y) if few.worst <= HOPELESS else None
    except RoadExtractionError:
        return None


# name, fewest places, function of a list of (x, y): what roads are made of, simplest first
ALIGNMENT = ("line", 2, _lines), ("circle", 4, _circles), ("clothoid", 8, _clothoids)


def choose_each(places, kinds=ALIGNMENT, worst=np.inf):
    """The Choice of each of many lines, of curves of some kinds, simplest first; no more are fitted than are needed to know.

    places : list of (x, y)
    kinds : as ALIGNMENT
    worst : metres, the 95 % residual of a curve that is taken
    """
    choices = [Choice(worst) for _ in places]
    for name, fewest, fit_all in kinds:
        open_ones = [k for k, choice in enumerate(choices) if not choice.decided and len(places[k][0]) >= fewest
                     and (name != "ellipse" or choice.turn > LEAST_TURN)]
        for k, fit in zip(open_ones, fit_all([places[k] for k in open_ones])):
            if fit is not None:
                choices[k].add(fit)
    return choices


class Choice:
    """The simplest of fits that are added, simplest first: the first whose BIC is within 6 of the best and whose 95 % residual is below `worst`."""

    def __init__(self, worst=np.inf):
        self.found, self.decided, self._worst = [], False, worst

    def add(self, fit):
        self.found.append(fit)
        least = least_bic(len(fit.residuals), FEWEST_NUMBERS)
        for one in self._near_enough():
            if one.bic <= least + BIC_MARGIN:
                self.decided = True  # whatever may follow
            if one.bic <= self._best_bic() + BIC_MARGIN:
                break                # what follows decides

    def _near_enough(self):
        return [fit for fit in self.found if fit.worst < self._worst]

    def _best_bic(self):
        return min(fit.bic for fit in self.found)

    @property
    def best(self):
        """A Fit, or None where none is near enough."""
        return next((fit for fit in self._near_enough() if fit.bic <= self._best_bic() + BIC_MARGIN), None)

    @property
    def turn(self):
        """Radians by which the circle turns."""
        return max((abs(fit.curve.bend) * fit.curve.length for fit in self.found if fit.curve.kind == "circle"), default=0.0)


def simplest(fits, worst=np.inf):
    """The best of a Choice among an iterable of Fit, simplest first; no more are made than are needed to know."""
    choice = Choice(worst)
    for fit in fits:
        choice.add(fit)
        if choice.decided:
            break
    return choice.best


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
