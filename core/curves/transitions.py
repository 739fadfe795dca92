"""A clothoid through points."""

import numpy as np

from .clothoid import Clothoid
from .fit import Fit, checked, chord, median, minimise

FOOT_STEPS = 10   # of Newton's
SETTLED = 1e-5    # m: a step this short leaves 1e-10


def fit_clothoid(x, y):
    """A clothoid by robust orthogonal least squares.

    The start is a parabola through the headings of chords between bins of points
    (theta is a parabola of u on a clothoid); the unknowns are taken at the middle,
    where they disturb each other least.

    Parameters
    ----------
    x, y : (N,) metres, N >= 5, ordered along the line

    Returns
    -------
    Fit with a Clothoid from the first point's foot to the last's.
    """
    x, y = checked(x, y, 5)
    middle, _ = chord(x, y)
    start, size = _start(x - middle[0], y - middle[1])
    dx, dy = x - middle[0], y - middle[1]
    known = {"u": size["u"], "at": None}   # the feet of the last unknowns that were good, and the last that were asked for

    def foot(unknown):
        if known["at"] is None or known["at"][0] is not unknown:
            known["at"] = unknown, *_feet(Clothoid(*unknown, 0.0), dx, dy, known["u"])
        return known["at"][1:]

    def residuals(unknown):
        return foot(unknown)[2]

    def jacobian(unknown):
        # the foot is where the gap is shortest, so that to first order only the curve's own shift counts
        curve, u, _ = foot(unknown)
        known["u"] = u
        turn = curve.heading(u)
        by = curve.derivatives(u)
        return np.sin(turn)[:, None] * by[:, 0] - np.cos(turn)[:, None] * by[:, 1]

    half = size["half"]
    unknown = minimise(residuals, jacobian, start, [1.0, 1.0, 1.0 / half, 2.0 / half**2, 6.0 / half**3])
    curve, u, e = foot(unknown)
    found = curve.cut(float(u[0]), float(u[-1])).moved(*middle)
    return Fit(found, e, 5)


def _feet(curve, x, y, u):
    """The curve, arc lengths of the feet of places near arc lengths u, and their distances."""
    places = curve.at(u)
    for _ in range(FOOT_STEPS):
        along, across = _gap(curve, x, y, u, places)
        step = along / np.minimum(np.maximum(1 - curve.curvature(u) * across, 0.3), 3.0)
        near = np.abs(step).max() < SETTLED
        places = curve.moved_on(places, u, step)
        u = u + step
        if near:
            break
    return curve, u, _gap(curve, x, y, u, places)[1]


def _gap(curve, x, y, u, places):
    turn = curve.heading(u)
    dx, dy = x - places[:, 0], y - places[:, 1]
    c, s = np.cos(turn), np.sin(turn)
    return dx * c + dy * s, dy * c - dx * s


def _start(x, y):
    """Unknowns (x, y, heading, curvature, change) at the middle of the points, and their arc lengths."""
    count = int(np.clip(len(x) // 3, 3, 12))
    bins = [rows for rows in np.array_split(np.arange(len(x)), count)]
    bx, by = (np.array([median(c[rows]) for rows in bins]) for c in (x, y))
    steps = np.hypot(np.diff(bx), np.diff(by))
    at = np.r_[0.0, np.cumsum(steps)]
    heading = np.unwrap(np.arctan2(np.diff(by), np.diff(bx)))
    # arc lengths of the points themselves: their place along the bins' polyline
    along = np.zeros(len(x))
    for k, rows in enumerate(bins):
        j = min(k, len(steps) - 1)
        c, s = np.cos(heading[j]), np.sin(heading[j])
        along[rows] = at[j] + (x[rows] - bx[j]) * c + (y[rows] - by[j]) * s
    centre = (along[0] + along[-1]) / 2
    middles = (at[:-1] + at[1:]) / 2 - centre
    change, bend, direction = np.polyfit(middles, heading, min(2, len(middles) - 1)) if len(middles) > 2 \
        else np.r_[0.0, np.polyfit(middles, heading, len(middles) - 1)]
    u = along - centre
    half = max(float(np.abs(u).max()), 1e-3)
    guess = Clothoid(0.0, 0.0, float(direction), float(bend), float(2 * change), 0.0)
    shift = np.c_[x, y] - guess.at(u)
    return (np.array([*np.median(shift, axis=0), guess.direction, guess.bend, guess.change]), dict(u=u, half=half))
