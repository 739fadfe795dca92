"""Smooth functions along a road as piecewise cubics, with no more pieces than the tolerance asks for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solve_banded

from .geometry import Cubics

STIFFNESS = 1e-3      # weight of the bending against the deviations: it decides only where there are too few places
MOST_PIECES = 400     # of one section
SHORTEST_CUBIC = 0.1  # m of a piece
LEAST_STEP = 0.001    # m along the road between places that count
STEP_RUN = 0.005      # m along the road between places that are not of one step
BAND = 3              # unknowns beside each other that one piece joins: levels and slopes at both of its ends


def fit_cubics(s: Sequence[np.ndarray], values: Sequence[np.ndarray], start: float, end: float, tolerance: float,
               slopes: Sequence[tuple[float, float]] = (), broken: bool = False) -> list[Cubics]:
    """Functions with common pieces, whose values and slopes go on from piece to piece, but for corners and steps.

    The places are those of lines, which the functions follow between the places too. Where even the shortest cubics miss them, as at a corner
    or a step, straight pieces lead from place to place.

    Parameters
    ----------
    s, values : for each function (n,) metres, rising, and its values there
    start, end : metres, of the functions; the first and last value are met there
    tolerance : how far a value may be missed
    slopes : for each function those at its start and end, NaN for any; none are given by default
    broken : whether straight pieces lead from place to place everywhere, which are never below what they join

    Returns
    -------
    list of Cubics, `start` counted as 0
    """
    knots, straight = np.array([start, end]), np.array([broken])
    s, values = [np.asarray(one, float) for one in s], [np.asarray(one, float) for one in values]
    while True:
        fitted = [_hermite(one, value, knots, given, straight) for one, value, given in zip(s, values, slopes or [(np.nan, np.nan)] * len(s))]
        bad = (_missed(s, values, fitted, knots) > tolerance) & ~straight
        if not bad.any():
            at = (knots[:-1, None] + np.diff(knots)[:, None] * np.array([0.25, 0.5, 0.75])).ravel()
            bad = (_missed([at] * len(s), [np.interp(at, one, value) for one, value in zip(s, values)], fitted, knots) > tolerance) & ~straight
        if not bad.any():
            return _pieces(s, values, knots, fitted, straight)
        inner = [(knots[k] + knots[k + 1]) / 2 for k in np.flatnonzero(bad) if len(knots) <= MOST_PIECES
                 and _places_within(s, knots[k], knots[k + 1]) and knots[k + 1] - knots[k] > 2 * SHORTEST_CUBIC]
        if not inner:
            straight = straight | bad
            continue
        before, knots = knots, np.sort(np.append(knots, inner))
        straight = straight[np.searchsorted(before, knots[1:]) - 1]


def _missed(s, values, fitted, knots):
    """(pieces,) by how much the functions miss their values at most."""
    worst = np.zeros(len(knots) - 1)
    for one, value, (levels, rates) in zip(s, values, fitted):
        np.maximum.at(worst, _piece_of(one, knots), np.abs(_evaluated(one, knots, levels, rates) - value))
    return worst


def _piece_of(s, knots):
    return np.clip(np.searchsorted(knots, s, side="right") - 1, 0, len(knots) - 2)


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


def risen(s: np.ndarray) -> np.ndarray:
    """(N,) bool: whether each of (N,) metres along the road lies ahead of all before it."""
    return np.append(True, np.diff(np.maximum.accumulate(s)) > LEAST_STEP)


def _places_within(s, first, last):
    return max(int(((one > first) & (one < last)).sum()) for one in s)


def _basis(u: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, ...]:
    """Hermite's functions: (value at start, slope at start, value at end, slope at end)."""
    return 2 * u**3 - 3 * u**2 + 1, h * (u**3 - 2 * u**2 + u), 3 * u**2 - 2 * u**3, h * (u**3 - u**2)


def _hermite(s, values, knots, ends, straight):
    """(K,) levels and slopes at the knots by least squares; both ends are met, and their slopes where they are given.

    straight : (K - 1,) pieces that are led from place to place instead; at their knots the line is met
    """
    count, met = len(knots), np.append(straight, False) | np.append(False, straight)
    known = np.full(2 * count, np.nan)
    known[::2][met] = np.interp(knots[met], s, values)
    known[[0, -2]], known[[1, -1]] = _at_ends(s, values, knots), ends
    known[1::2][np.append(straight, True) & np.append(True, straight)] = 0.0   # no cubic begins or ends there
    if straight.any():
        smooth = ~straight[_piece_of(s, knots)]
        s, values = s[smooth], values[smooth]
    k, h, j = _piece_of(s, knots), np.diff(knots), np.flatnonzero(~straight)
    fit = np.stack(_basis((s - knots[k]) / h[k], h[k]), axis=1)
    # bending of every piece: the integral of the squared second derivative, by its values at both ends
    bending = [np.stack([a / h**2, b / h, c / h**2, d / h], axis=1)[j] for a, b, c, d in ((-6, -4, 6, -2), (6, 2, -6, 4))]
    weights = np.concatenate([fit, *(STIFFNESS * one for one in bending)])
    columns = 2 * np.concatenate([k, j, j])[:, None] + np.arange(4)   # level and slope of a knot lie side by side, so that the system has a band
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
    k = _piece_of(s, knots)
    h = np.diff(knots)[k]
    a, b, c, d = _basis((s - knots[k]) / h, h)
    return a * levels[k] + b * slopes[k] + c * levels[k + 1] + d * slopes[k + 1]


def _pieces(s, values, knots, fitted, straight):
    """Cubics of the functions: a row for each piece, and in a straight one for each of its places."""
    h, rows_of = np.diff(knots), []
    for levels, slopes in fitted:
        rise = np.diff(levels)
        c = (3 * rise / h - 2 * slopes[:-1] - slopes[1:]) / h
        d = (slopes[:-1] + slopes[1:] - 2 * rise / h) / h**2
        rows_of.append(np.c_[knots[:-1] - knots[0], levels[:-1], slopes[:-1], c, d])
    for k in np.flatnonzero(straight)[::-1]:
        places = np.unique(np.concatenate([one[(one > knots[k] + LEAST_STEP) & (one < knots[k + 1] - LEAST_STEP)] for one in s]))
        at = np.concatenate([[knots[k]], places, [knots[k + 1]]])
        there = np.array([[levels[k], *np.interp(places, one, value), levels[k + 1]] for one, value, (levels, _) in zip(s, values, fitted)])
        run, rise = np.diff(at), np.diff(there, axis=1)
        kept = (run > STEP_RUN) | (np.abs(rise) < run).all(0) | (at[:-1] == knots[0])   # up to a step the piece before goes on
        for number, rows in enumerate(rows_of):
            lines = np.c_[at[:-1] - knots[0], there[number, :-1], rise[number] / run, np.zeros((len(run), 2))][kept]
            rows_of[number] = np.concatenate([rows[:k], lines, rows[k + 1:]])
    return [Cubics(rows) for rows in rows_of]
