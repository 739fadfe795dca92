"""A placement that most pairs of places agree on, whatever the others say (RANSAC)."""

from __future__ import annotations

import numpy as np

from ..polynomial import COLLINEAR_RATIO, MIN_CONTROL_POINTS, MIN_INVERSE_CONDITION, fit_image_polynomial, inverse_condition, principal_extents
from .placement import Placement

_DRAWS = 500          # of three pairs: with half of them false, all three are true in one of eight draws
_ROUNDS = 10          # of fitting to the pairs that agree and looking again which these are
_SMALLEST_FRAME = 0.02  # of the largest triangle or distance drawn
_PAIRS_PER_TERM = 2   # an order is fitted to at least so many times the pairs that it needs


def agreeing(x: np.ndarray, y: np.ndarray, moved: np.ndarray, tolerance: float, weights: np.ndarray) -> np.ndarray:
    """The pairs whose displacements one affine transformation explains, as many as can be found together.

    Where the places lie on a line, as large patches of a straight road do, the transformation is a similarity.

    Parameters
    ----------
    x, y : (N,) m, places on the map
    moved : (N, 2) m, their displacements
    tolerance : m, from the displacement that the transformation gives
    weights : (N,) what each pair counts

    Returns
    -------
    (N,) bool; none where there are too few places
    """
    if len(x) < MIN_CONTROL_POINTS[1]:
        return np.zeros(len(x), dtype=bool)
    order = np.random.default_rng(1).random((_DRAWS, len(x))).argsort(axis=1)
    if _lie_on_a_line(x, y):
        # as complex numbers a similarity is linear: d = a + b z, from two places
        terms, target, drawn = np.column_stack([np.ones(len(x)), x + 1j * y]), (moved[:, 0] + 1j * moved[:, 1])[:, None], order[:, :2]
    else:
        terms, target, drawn = np.column_stack([np.ones(len(x)), x - x.mean(), y - y.mean()]), moved, order[:, :3]
    frames = terms[drawn]
    # distance of the two places, or twice the area of the triangle: near ones say nothing about what lies beside them
    extent = np.abs(np.linalg.det(frames))
    usable = extent > _SMALLEST_FRAME * extent.max()
    if not usable.any():
        return np.zeros(len(x), dtype=bool)
    solved = np.linalg.solve(frames[usable], target[drawn[usable]])
    misfit = np.sqrt((np.abs(np.einsum("nk,dkc->dnc", terms, solved) - target) ** 2).sum(axis=2))
    within = misfit <= tolerance
    # a smooth count: the best of many draws is the one whose pairs lie near it
    votes = (np.where(within, 1.0 - 0.5 * (misfit / tolerance) ** 2, 0.0) * weights).sum(axis=1)
    return within[int(votes.argmax())]


def _lie_on_a_line(x, y):
    along, across = principal_extents(np.column_stack([x, y]))
    return across <= COLLINEAR_RATIO * along


def robust_placement(placement: Placement, x: np.ndarray, y: np.ndarray, moved: np.ndarray, tolerance: float, weights: np.ndarray,
                     order: int) -> tuple[Placement, np.ndarray] | None:
    """A new placement from places of the map that were found displaced in the photo as drawn by an old one.

    Parameters
    ----------
    placement : Placement by which the photo was drawn
    x, y : (N,) m, places on the map
    moved : (N, 2) m, from there to where the drawn photo has them
    tolerance : m, largest residual of a pair that is used
    weights : (N,) what each pair counts
    order : of the polynomial, 1 or 2; lowered where there are too few pairs for it

    Returns
    -------
    placement, used : Placement and (N,) bool; None where no three pairs agree
    """
    pixel, line = placement.pixels(x + moved[:, 0], y + moved[:, 1])
    used = agreeing(x, y, moved, tolerance * 1.5, weights)
    fitted = placement
    for _ in range(_ROUNDS):
        if used.sum() < MIN_CONTROL_POINTS[1]:
            return None
        now = highest_order(x[used], y[used], order)
        fitted = (Placement.fitted(x[used], y[used], pixel[used], line[used], now, placement.sign) if now else
                  _turned(placement, x[used], y[used], moved[used]))
        before, used = used, np.hypot(*fitted.metres(x, y, pixel, line).T) <= tolerance
        if (used == before).all():
            break
    return (fitted, used) if used.sum() >= MIN_CONTROL_POINTS[1] else None


def _turned(placement, x, y, moved):
    """The placement after the similarity that fits the displacements best: places on a line say no more."""
    terms = np.column_stack([np.ones(len(x)), x + 1j * y])
    a, b = np.linalg.lstsq(terms, moved[:, 0] + 1j * moved[:, 1], rcond=None)[0]
    reach = max(np.ptp(x), np.ptp(y), 1.0) / 2
    across, down = (axis.ravel() for axis in np.meshgrid(*np.array([[-1.0], [1.0]]).T.repeat(2, 0) * reach))
    at_x, at_y = x.mean() + across, y.mean() + down
    shift = a + b * (at_x + 1j * at_y)
    return Placement.fitted(at_x, at_y, *placement.pixels(at_x + shift.real, at_y + shift.imag), 1, placement.sign)


def highest_order(x: np.ndarray, y: np.ndarray, most: int) -> int:
    """The highest order up to `most` that (N,) places determine well; 0 where they lie on a line or are too few."""
    for order in range(most, 0, -1):
        if len(x) >= _PAIRS_PER_TERM * MIN_CONTROL_POINTS[order] or (order == 1 and len(x) > MIN_CONTROL_POINTS[1]):
            if not _lie_on_a_line(x, y) and (order == 1 or inverse_condition(x, y, order) > 10 * MIN_INVERSE_CONDITION):
                return order
    return 0


def left_out_residuals(x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray, used: np.ndarray, order: int) -> np.ndarray:
    """Residuals of pairs on the map against a polynomial from pixel and line to the map that was fitted without each.

    Parameters
    ----------
    x, y, pixel, line : (N,)
    used : (N,) bool, pairs that are fitted
    order : of the polynomial

    Returns
    -------
    (N,) m
    """
    fit = fit_image_polynomial(pixel[used], line[used], x[used], y[used], order)
    away = np.column_stack([x, y]) - np.column_stack(fit.polynomial.to_map(pixel, line))
    away[used] = fit.left_out
    return np.hypot(*away.T)
