"""Polynomials from pixels to the map, fitted to ground control points by least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

COLLINEAR_RATIO = 0.01         # extent across over extent along, below which points lie on a line
MIN_INVERSE_CONDITION = 1e-3   # smallest over largest singular value, below which the points do not determine the coefficients
MIN_CONTROL_POINTS = (1, 3, 6, 10)  # by order: a shift needs one point, order t needs (t + 1)(t + 2) / 2


def term_powers(order: int) -> np.ndarray:
    """Powers of the terms u^a v^b with a + b <= order.

    order : of the polynomial
    Returns (K, 2) int, K = (order + 1)(order + 2) / 2
    """
    return np.array([(total - b, b) for total in range(order + 1) for b in range(total + 1)])


@dataclass(frozen=True)
class ImagePolynomial:
    """A polynomial from pixel and line to the map.

    Coordinates are centred, rotated to their principal axes and scaled to unit spread, so that all terms are of
    similar size: u = (p - centre) @ whiten.
    """

    order: int   # of the polynomial; a shift is stored as a polynomial of order 1
    centre: np.ndarray   # (2,) pixel and line
    whiten: np.ndarray   # (2, 2)
    origin: np.ndarray   # (2,) m, map coordinates subtracted before the fit
    coefficients: np.ndarray   # (K, 2) m of the terms in `term_powers(order)`, for easting and northing

    def terms(self, pixel: np.ndarray, line: np.ndarray) -> np.ndarray:
        """(N, K) values of the terms at N places in the image."""
        return _terms(self._scaled(pixel, line), self.order)

    def to_map(self, pixel: np.ndarray, line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Easting and northing, (N,) m each, of (N,) places in the image."""
        places = self.terms(pixel, line) @ self.coefficients + self.origin
        return places[:, 0], places[:, 1]

    def jacobian(self, pixel: np.ndarray, line: np.ndarray) -> np.ndarray:
        """(N, 2, 2) m east and north (rows) per pixel and line (columns), at N places in the image."""
        u, powers = self._scaled(pixel, line), term_powers(self.order)
        slopes = []
        for axis in (0, 1):
            lower = powers.copy()
            lower[:, axis] = np.maximum(lower[:, axis] - 1, 0)
            slopes.append(powers[:, axis] * u[:, :1] ** lower[:, 0] * u[:, 1:] ** lower[:, 1])
        inner = np.stack([slope @ self.coefficients for slope in slopes], axis=2)
        return np.einsum("nij,kj->nik", inner, self.whiten)

    def _scaled(self, pixel, line):
        return (np.column_stack([pixel, line]).astype(float) - self.centre) @ self.whiten


def _terms(u, order):
    powers = term_powers(order)
    return u[:, :1] ** powers[:, 0] * u[:, 1:] ** powers[:, 1]


@dataclass(frozen=True)
class ControlPointFit:
    """A polynomial fitted to N control points, with the quality of the fit."""

    polynomial: ImagePolynomial   # ImagePolynomial
    residuals: np.ndarray   # (N, 2) m, map coordinates of the points minus those of the polynomial
    leverage: np.ndarray   # (N,) 0 to 1, influence of each point on its own residual
    triangle: np.ndarray   # (K, K) matrix R of the QR decomposition of the terms
    order: int   # 0 for a shift

    @property
    def free(self) -> int:
        """Redundant points: those beyond the smallest number."""
        return len(self.residuals) - MIN_CONTROL_POINTS[self.order]

    @property
    def left_out(self) -> np.ndarray:
        """(N, 2) m, leave-one-out residuals r / (1 - h); NaN where the other points do not determine the polynomial."""
        rest = 1.0 - self.leverage
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where((rest > 1e-6)[:, None], self.residuals / rest[:, None], np.nan)

    def leverage_at(self, pixel: np.ndarray, line: np.ndarray) -> np.ndarray:
        """(M,) leverage of any places in the image; the polynomial extrapolates where it exceeds 1."""
        terms = self.polynomial.terms(pixel, line) if self.order else np.ones((len(pixel), 1))
        return np.sum(np.linalg.solve(self.triangle.T, terms.T) ** 2, axis=0)


def principal_extents(places: np.ndarray) -> tuple[float, float]:
    """Extents of places along their principal axes.

    places : (N, 2)
    Returns along, across: in the unit of the places
    """
    _, _, turned = np.linalg.svd(places - places.mean(axis=0), full_matrices=False)
    along, across = np.ptp((places - places.mean(axis=0)) @ turned.T, axis=0)
    return float(along), float(across)


def inverse_condition(pixel: np.ndarray, line: np.ndarray, order: int) -> float:
    """Smallest over largest singular value of the terms at control points.

    pixel, line : (N,)
    order : of the polynomial
    Returns 0 to 1; 0 where the points do not determine the coefficients
    """
    centre, whiten = _frame(np.column_stack([pixel, line]))
    singular = np.linalg.svd(_terms((np.column_stack([pixel, line]) - centre) @ whiten, order), compute_uv=False)
    return float(singular[-1] / singular[0])


def _frame(places):
    """Centre and whitening matrix of places (N, 2) that do not lie on a line."""
    centre = places.mean(axis=0)
    _, singular, turned = np.linalg.svd(places - centre, full_matrices=False)
    return centre, turned.T / (singular / np.sqrt(len(places)))


def fit_image_polynomial(pixel: np.ndarray, line: np.ndarray, easting: np.ndarray, northing: np.ndarray, order: int) -> ControlPointFit:
    """Fit a polynomial of order 1 to 3: X = sum a_ij u^i v^j, and Y likewise.

    Parameters
    ----------
    pixel, line : (N,) in the image; N at least MIN_CONTROL_POINTS[order], not on a line
    easting, northing : (N,) m
    order : 1, 2 or 3

    Notes
    -----
    The terms are those of the polynomials of ArcGIS and GDAL. They are centred and scaled, and solved by QR. With R of the QR,
    h_i = |R^-T t_i|^2 is the leverage, and r_i / (1 - h_i) the residual of a point that is left out (Belsley, Kuh
    and Welsch 1980, Regression Diagnostics).
    """
    places, target = np.column_stack([pixel, line]).astype(float), np.column_stack([easting, northing]).astype(float)
    centre, whiten = _frame(places)
    terms = _terms((places - centre) @ whiten, order)
    origin = target.mean(axis=0)
    basis, triangle = np.linalg.qr(terms)
    coefficients = np.linalg.solve(triangle, basis.T @ (target - origin))
    residuals = target - origin - terms @ coefficients
    return ControlPointFit(ImagePolynomial(order, centre, whiten, origin, coefficients), residuals, np.sum(basis**2, axis=1), triangle, order)


def fit_shift(pixel: np.ndarray, line: np.ndarray, easting: np.ndarray, northing: np.ndarray,
              geotransform: tuple[float, ...]) -> ControlPointFit:
    """Fit of order 0: the image keeps the scale and rotation of its approximate position and is only shifted.

    pixel, line : (N,) in the image
    easting, northing : (N,) m
    geotransform : approximate position of the image, six numbers as in GDAL
    """
    x0, xp, xl, y0, yp, yl = geotransform
    places, target = np.column_stack([pixel, line]).astype(float), np.column_stack([easting, northing]).astype(float)
    slope = np.array([[xp, xl], [yp, yl]])
    centre, count = places.mean(axis=0), len(places)
    origin = target.mean(axis=0)
    coefficients = np.vstack([np.zeros(2), slope.T])
    residuals = target - origin - (places - centre) @ slope.T
    return ControlPointFit(ImagePolynomial(1, centre, np.eye(2), origin, coefficients), residuals,
               np.full(count, 1.0 / count), np.array([[np.sqrt(count)]]), 0)
