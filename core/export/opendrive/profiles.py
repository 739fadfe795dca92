"""Smooth functions along a road as piecewise cubics, with no more pieces than the tolerance asks for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solve_banded

from .geometry import Cubics

STIFFNESS = 1e-3      # weight of the bending against the deviations: it decides only where there are too few places
MOST_PIECES = 400     # of one section
SHORTEST_CUBIC = 0.1  # m of a piece
BAND = 3              # unknowns beside each other that one piece joins: levels and slopes at both of its ends


def fit_cubics(s: Sequence[np.ndarray], values: Sequence[np.ndarray], start: float, end: float, tolerance: float,
               slopes: Sequence[tuple[float, float]] = ()) -> list[Cubics]:
    """Functions with common pieces, whose values and slopes go on from piece to piece.

    Parameters
    ----------
    s, values : for each function (n,) metres, rising, and its values there
    start, end : metres, of the functions; the first and last value are met there
    tolerance : how far a value may be missed
    slopes : for each function those at its start and end, NaN for any; none are given by default

    Returns
    -------
    list of Cubics, `start` counted as 0
    """
    knots = np.array([start, end])
    s = [np.asarray(one, float) for one in s]
    while True:
        fitted = [_hermite(one, value, knots, given) for one, value, given in zip(s, values, slopes or [(np.nan, np.nan)] * len(s))]
        worst = np.zeros(len(knots) - 1)
        for one, value, (levels, rates) in zip(s, values, fitted):
            missed = np.abs(_evaluated(one, knots, levels, rates) - value)
            np.maximum.at(worst, np.clip(np.searchsorted(knots, one, side="right") - 1, 0, len(worst) - 1), missed)
        bad = np.flatnonzero(worst > tolerance)
        inner = [(knots[k] + knots[k + 1]) / 2 for k in bad
                 if _places_within(s, knots[k], knots[k + 1]) and knots[k + 1] - knots[k] > 2 * SHORTEST_CUBIC]
        if not inner or len(knots) > MOST_PIECES:
            return [_pieces(knots, levels, rates) for levels, rates in fitted]
        knots = np.sort(np.append(knots, inner))


def broken_lines(s: Sequence[np.ndarray], values: Sequence[np.ndarray], start: float, end: float) -> list[Cubics]:
    """The same functions by straight pieces from place to place of the first one: never below what they join."""
    knots = np.unique(np.concatenate([[start], s[0][(s[0] > start + 1e-3) & (s[0] < end - 1e-3)], [end]]))
    found = []
    for one, value in zip(s, values):
        levels = np.interp(knots, one, value)
        found.append(Cubics(np.c_[knots[:-1] - start, levels[:-1], np.diff(levels) / np.diff(knots), np.zeros((len(knots) - 1, 2))]))
    return found


def difference(first: Cubics, second: Cubics) -> Cubics:
    """first less second, which have the same pieces."""
    return Cubics(np.c_[first.rows[:, 0], first.rows[:, 1:] - second.rows[:, 1:]])


def simplified(cubics: Cubics) -> Cubics:
    """Without pieces that only repeat the one before: constant and straight functions have one row."""
    rows = cubics.rows
    keep = [0]
    for k in range(1, len(rows)):
        ds = rows[k, 0] - rows[keep[-1], 0]
        _, a, b, c, d = rows[keep[-1]]
        moved = np.array([a + ds * (b + ds * (c + ds * d)), b + ds * (2 * c + ds * 3 * d), c + 3 * d * ds, d])
        if np.abs(moved - rows[k, 1:]).max() > 1e-9:
            keep.append(k)
    tiny = rows[keep].copy()
    tiny[:, 1:][np.abs(tiny[:, 1:]) < 1e-12] = 0.0
    return Cubics(tiny)


def _places_within(s, first, last):
    return max(int(((one > first) & (one < last)).sum()) for one in s)


def _basis(u: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, ...]:
    """Hermite's functions: (value at start, slope at start, value at end, slope at end)."""
    return 2 * u**3 - 3 * u**2 + 1, h * (u**3 - 2 * u**2 + u), 3 * u**2 - 2 * u**3, h * (u**3 - u**2)


def _hermite(s, values, knots, ends):
    """(K,) levels and slopes at the knots by least squares; both ends are met, and their slopes where they are given."""
    count = len(knots)
    k = np.clip(np.searchsorted(knots, s, side="right") - 1, 0, count - 2)
    h, j = np.diff(knots), np.arange(count - 1)
    fit = np.stack(_basis((s - knots[k]) / h[k], h[k]), axis=1)
    # bending of every piece: the integral of the squared second derivative, by its values at both ends
    bending = [np.stack([a / h**2, b / h, c / h**2, d / h], axis=1) for a, b, c, d in ((-6, -4, 6, -2), (6, 2, -6, 4))]
    weights = np.concatenate([fit, *(STIFFNESS * one for one in bending)])
    columns = 2 * np.concatenate([k, j, j])[:, None] + np.arange(4)   # level and slope of a knot lie side by side, so that the system has a band
    known = np.full(2 * count, np.nan)
    known[[0, -2]], known[[1, -1]] = _at_ends(s, values, knots), ends
    fixed = np.isfinite(known)
    target = np.append(values, np.zeros(2 * len(j))) - (weights * np.where(fixed, known, 0.0)[columns]).sum(1)
    weights = np.where(fixed[columns], 0.0, weights)
    size, side = 2 * count, np.arange(4)
    place = (BAND + side[:, None] - side) * size + columns[:, None, :]   # of each product of two weights in the band
    products = weights[:, :, None] * weights[:, None, :]
    band = np.bincount(place.ravel(), products.ravel(), (2 * BAND + 1) * size).reshape(-1, size)
    right = np.where(fixed, known, 0.0) + np.bincount(columns.ravel(), (weights * target[:, None]).ravel(), size)
    band[BAND, fixed] = 1.0
    found = solve_banded((BAND, BAND), band, right)
    return found[::2], found[1::2]


def _at_ends(s, values, knots):
    """Values at the first and last knot, by the straight line through the outermost two places."""
    found = []
    for at, (i, j) in ((knots[0], (0, 1)), (knots[-1], (-1, -2))):
        run = s[i] - s[j]
        found.append(float(values[i] + ((values[i] - values[j]) / run * (at - s[i]) if abs(run) > 1e-6 else 0.0)))
    return found


def _evaluated(s, knots, levels, slopes):
    k = np.clip(np.searchsorted(knots, s, side="right") - 1, 0, len(knots) - 2)
    h = np.diff(knots)[k]
    a, b, c, d = _basis((s - knots[k]) / h, h)
    return a * levels[k] + b * slopes[k] + c * levels[k + 1] + d * slopes[k + 1]


def _pieces(knots, levels, slopes):
    h, rise = np.diff(knots), np.diff(levels)
    c = (3 * rise / h - 2 * slopes[:-1] - slopes[1:]) / h
    d = (slopes[:-1] + slopes[1:] - 2 * rise / h) / h**2
    return Cubics(np.c_[knots[:-1] - knots[0], levels[:-1], slopes[:-1], c, d])
