"""Where each place of the map lies in the photo, by a polynomial, the photo drawn onto the map by it, and RANSAC."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.lazy import cv2
from ..georeference import (
    COLLINEAR_RATIO,
    MIN_CONTROL_POINTS,
    MIN_INVERSE_CONDITION,
    ImagePolynomial,
    fit_image_polynomial,
    inverse_condition,
    principal_extents,
)
from .photo import Photo, reduced

_NODE = 16  # cells between places whose pixels are computed; between them they are interpolated


@dataclass(frozen=True)
class Placement:
    """From local map coordinates to pixel and line."""

    polynomial: ImagePolynomial   # ImagePolynomial whose input is x and y, m, and whose output is pixel and line
    sign: int = 1   # -1 where paint is darker than the road

    @classmethod
    def fitted(cls, x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray, order: int, sign: int = 1) -> Placement:
        """The least-squares placement of (N,) places; N at least MIN_CONTROL_POINTS[order], not on a line."""
        return cls(fit_image_polynomial(x, y, pixel, line, order).polynomial, sign)

    @classmethod
    def similarity(cls, x: float, y: float, turn: float, size: float, middle: tuple[float, float], sign: int = 1) -> Placement:
        """From a place (m) that lies at a `middle` (pixel and line), the turn (radians) and the size (m) of the pixels."""
        along, up = np.array([-1.0, 1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0, 1.0])
        across, down = middle[0] + along / size, middle[1] - up / size
        cos, sin = np.cos(turn), np.sin(turn)
        return cls.fitted(x + along * cos - up * sin, y + along * sin + up * cos, across, down, 1, sign)

    def pixels(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixel and line, (N,) each, of (N,) places."""
        return self.polynomial.to_map(x, y)

    def metres(self, x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray) -> np.ndarray:
        """How far on the map pixels lie from those of places.

        x, y, pixel, line : (N,)
        Returns (N, 2) m, to first order
        """
        placed = np.column_stack(self.pixels(x, y))
        slope = self.polynomial.jacobian(x, y)
        return np.linalg.solve(slope, (np.column_stack([pixel, line]) - placed)[..., None])[..., 0]

    def drawn(self, values: np.ndarray, photo: Photo, cell: float, shape: tuple[int, ...], corner: tuple[int, int] = (0, 0),
              reduction: int = 1) -> np.ndarray:
        """The photo on cells of the map.

        Parameters
        ----------
        values : (h, w) float32, contrast or luminance of the photo
        photo : Photo that they belong to
        cell : m
        shape : rows and columns of cells
        corner : first column and row, counted from local 0, 0 to the east and to the south
        reduction : pixels of the photo that are averaged first, where cells are larger than they

        Returns (H, W) float32, 0 outside the photo
        """
        height, width = shape
        across = np.linspace(0, width, max(2, -(-width // _NODE) + 1))
        down = np.linspace(0, height, max(2, -(-height // _NODE) + 1))
        x, y = np.meshgrid((corner[0] + across) * cell, -(corner[1] + down) * cell)
        pixel, line = (axis.reshape(x.shape) for axis in self.pixels(x.ravel(), y.ravel()))
        factor = photo.factor * reduction
        nodes = [(position / factor - 0.5).astype(np.float32) for position in (pixel, line)]
        # of the middles of the cells: linear between the nodes
        grid = np.meshgrid((np.arange(width) + 0.5) * (len(across) - 1) / width, (np.arange(height) + 0.5) * (len(down) - 1) / height)
        maps = [cv2.remap(node, *(axis.astype(np.float32) for axis in grid), cv2.INTER_LINEAR) for node in nodes]
        return cv2.remap(reduced(values, reduction), *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0.0)

    def reduction(self, photo: Photo, cell: float) -> int:
        """Pixels of a photo that a cell (m) covers side by side, at least 1."""
        centre = self.polynomial.centre
        per_metre = np.sqrt(abs(np.linalg.det(self.polynomial.jacobian(centre[:1], centre[1:])[0])))
        return max(1, int(cell * per_metre / photo.factor + 0.25))


# A placement that most pairs of places agree on, whatever the others say (RANSAC).

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

    Returns (N,) bool; none where there are too few places
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
        degree = highest_order(x[used], y[used], order)
        fitted = (Placement.fitted(x[used], y[used], pixel[used], line[used], degree, placement.sign) if degree else
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

    x, y, pixel, line : (N,)
    used : (N,) bool, pairs that are fitted
    order : of the polynomial
    Returns (N,) m
    """
    fit = fit_image_polynomial(pixel[used], line[used], x[used], y[used], order)
    residuals = np.column_stack([x, y]) - np.column_stack(fit.polynomial.to_map(pixel, line))
    residuals[used] = fit.left_out
    return np.hypot(*residuals.T)
