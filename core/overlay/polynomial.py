"""Polynomials from pixels to the map, fitted to control points by least squares."""

from dataclasses import dataclass

import numpy as np

COLLINEAR_RATIO = 0.01         # extent across over extent along, below which points lie on a line
MIN_INVERSE_CONDITION = 1e-3        # smallest over largest singular value, below which the points do not tell the coefficients
MIN_CONTROL_POINTS = (1, 3, 6, 10)


def term_powers(order):
    """(K, 2) powers of the terms u^a v^b with a + b <= order; K = (order + 1)(order + 2) / 2."""
    return np.array([(total - b, b) for total in range(order + 1) for b in range(total + 1)])


@dataclass(frozen=True)
class ImagePolynomial:
    """From pixel and line to the map.

    Coordinates are centred and turned to their principal axes, then scaled to unit spread,
    so that the terms are of one size: u = (p - centre) @ whiten.

    Attributes
    ----------
    order : of the polynomial; a shift is kept as a polynomial of order 1
    centre : (2,) pixel, line
    whiten : (2, 2)
    origin : (2,) map coordinates subtracted before the fit
    coefficients : (K, 2) of the terms in `term_powers(order)`, for easting and northing
    """

    order: int
    centre: np.ndarray
    whiten: np.ndarray
    origin: np.ndarray
    coefficients: np.ndarray

    def terms(self, pixel, line):
        return _terms(self._scaled(pixel, line), self.order)

    def to_map(self, pixel, line):
        """(easting, northing), (N,) each, of places in the image."""
        places = self.terms(pixel, line) @ self.coefficients + self.origin
        return places[:, 0], places[:, 1]

    def jacobian(self, pixel, line):
        """(N, 2, 2): metres east and north (rows) per pixel and line (columns)."""
        u, powers = self._scaled(pixel, line), term_powers(self.order)
        slopes = []
        for axis in (0, 1):
            lower = powers.copy()
            lower[:, axis] = np.maximum(lower[:, axis] - 1, 0)
            slopes.append(powers[:, axis] * u[:, :1] ** lower[:, 0] * u[:, 1:] ** lower[:, 1])
        inner = np.stack([slope @ self.coefficients for slope in slopes], axis=2)
        return np.einsum("nij,kj->nik", inner, self.whiten)

    def to_pixel(self, easting, northing, steps=30):
        """(pixel, line), (N,) each, of places on the map, by Newton's method from the affine part.

        NaN where it does not settle: the polynomial has no single answer there.
        """
        target = np.column_stack([np.asarray(easting, float), np.asarray(northing, float)])
        affine = self.jacobian(self.centre[:1], self.centre[1:])[0]
        middle = np.column_stack(self.to_map(self.centre[:1], self.centre[1:]))
        place = self.centre + (target - middle) @ np.linalg.inv(affine).T
        moved = np.full(len(place), np.inf)
        for _ in range(steps):
            error = target - np.column_stack(self.to_map(place[:, 0], place[:, 1]))
            slope = self.jacobian(place[:, 0], place[:, 1])
            with np.errstate(all="ignore"):
                step = np.stack([slope[:, 1, 1] * error[:, 0] - slope[:, 0, 1] * error[:, 1],
                                 slope[:, 0, 0] * error[:, 1] - slope[:, 1, 0] * error[:, 0]], axis=1)
                step /= (slope[:, 0, 0] * slope[:, 1, 1] - slope[:, 0, 1] * slope[:, 1, 0])[:, None]
            place, moved = place + step, np.abs(step).max(axis=1)
            if not (moved > 1e-9).any():
                break
        place[~(moved < 1e-6)] = np.nan
        return place[:, 0], place[:, 1]

    def _scaled(self, pixel, line):
        return (np.column_stack([pixel, line]).astype(float) - self.centre) @ self.whiten


def _terms(u, order):
    powers = term_powers(order)
    return u[:, :1] ** powers[:, 0] * u[:, 1:] ** powers[:, 1]


@dataclass(frozen=True)
class ControlPointFit:
    """A polynomial with what the control points say about it.

    Attributes
    ----------
    polynomial : ImagePolynomial
    residuals : (N, 2) m, map coordinates of the points minus the polynomial's
    leverage : (N,) how much each point pulls the polynomial to itself, 0 to 1
    triangle : (K, K) R of the fit's QR, for the leverage of other places
    order : 0 for a shift
    free : points beyond the smallest number
    """

    polynomial: ImagePolynomial
    residuals: np.ndarray
    leverage: np.ndarray
    triangle: np.ndarray
    order: int

    @property
    def free(self):
        return len(self.residuals) - MIN_CONTROL_POINTS[self.order]

    @property
    def left_out(self):
        """(N, 2) m, where each point would be off had it not been used: r / (1 - h); NaN where the rest would not do."""
        rest = 1.0 - self.leverage
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where((rest > 1e-6)[:, None], self.residuals / rest[:, None], np.nan)

    def leverage_at(self, pixel, line):
        """The same measure, (M,), of any places; above 1 the polynomial extrapolates."""
        terms = self.polynomial.terms(pixel, line) if self.order else np.ones((len(pixel), 1))
        return np.sum(np.linalg.solve(self.triangle.T, terms.T) ** 2, axis=0)


def principal_extents(places):
    """(along, across): how far places, (N, 2), reach along their principal axes."""
    _, _, turned = np.linalg.svd(places - places.mean(axis=0), full_matrices=False)
    along, across = np.ptp((places - places.mean(axis=0)) @ turned.T, axis=0)
    return float(along), float(across)


def inverse_condition(pixel, line, order):
    """Smallest over largest singular value of the terms at control points; 0 where they are no full set."""
    centre, whiten = _frame(np.column_stack([pixel, line]))
    singular = np.linalg.svd(_terms((np.column_stack([pixel, line]) - centre) @ whiten, order), compute_uv=False)
    return float(singular[-1] / singular[0])


def _frame(places):
    """Centre and whitening matrix of places (N, 2), which do not lie in a line."""
    centre = places.mean(axis=0)
    _, singular, turned = np.linalg.svd(places - centre, full_matrices=False)
    return centre, turned.T / (singular / np.sqrt(len(places)))


def fit_image_polynomial(pixel, line, easting, northing, order):
    """Fit of order 1 to 3: X = sum a_ij u^i v^j, Y likewise, by QR of the centred and scaled terms.

    Parameters
    ----------
    pixel, line, easting, northing : (N,), N at least MIN_CONTROL_POINTS[order], neither in a line nor weak

    Notes
    -----
    The number of terms is that of ArcGIS's and GDAL's polynomials, (t + 1)(t + 2) / 2. With R of the
    QR, h_i = |R^-T t_i|^2 is the leverage, and the residual that a point would have
    without being used is r_i / (1 - h_i) (Belsley, Kuh and Welsch 1980, Regression Diagnostics).
    """
    places, target = np.column_stack([pixel, line]).astype(float), np.column_stack([easting, northing]).astype(float)
    centre, whiten = _frame(places)
    terms = _terms((places - centre) @ whiten, order)
    origin = target.mean(axis=0)
    basis, triangle = np.linalg.qr(terms)
    coefficients = np.linalg.solve(triangle, basis.T @ (target - origin))
    residuals = target - origin - terms @ coefficients
    return ControlPointFit(ImagePolynomial(order, centre, whiten, origin, coefficients), residuals, np.sum(basis**2, axis=1), triangle, order)


def fit_shift(pixel, line, easting, northing, geotransform):
    """Fit of order 0: the image keeps the scale and direction of its rough position and is only moved.

    Parameters
    ----------
    geotransform : rough position of the image, as GDAL has it
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
