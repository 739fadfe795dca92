"""An image and its control points: the polynomial between them, its residuals, warnings about its reliability, and the image drawn by it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.features import RESIDUALS, Features
from ...core.common.progress import Progress
from ...core.common.setting import Limited, choice, setting
from ...core.io.crs import as_in_file, check_metric, horizontal_part, parse_crs, same_crs
from ...core.io.geotiff import GEOTIFF_TILE
from ...core.io.local_files import gdal_exceptions, gdal_work, open_raster, unfinished_path
from ...core.lazy import gdal, pyproj
from .control_points import CONTROL, REQUIRED_COLUMNS, ControlPoints, SourceImage

_SUFFICIENT_RATIO = 1.5  # times the smallest number of points: with fewer, residuals are much smaller than the errors
_MISFIT_RESIDUAL = 5.0   # studentised residual from which a point is reported
_NOTED_OUTSIDE_SHARE = 0.05  # of the image outside the hull of the control points, from which it is reported
_OUTLINE_PLACES = 200    # places along the outline of the image
_MIN_POINT_ERROR = 0.1   # pixels: no control point is more accurate
_MAX_MISFITS = 3         # points reported as misfits
_MAX_SCALE_ERROR = 0.01  # of the scale of the map projection, above which it is reported


@dataclass(frozen=True)
class GeoreferenceSettings(Limited):
    """How the image is georeferenced and drawn.

    pixel_size : m, of the result (and of the image, for a shift of an image without position); 0 = as the image
    extrapolation : what is drawn of the image outside the hull of the control points: "draw", "leave-out" or
        "automatic", which leaves it out at order 3
    """

    order: int = setting(2, 0, 3, "The order of the polynomial")   # of the polynomial, 1 to 3; 0 is a shift
    pixel_size: float = setting(0.0, 0.0, 999.0, "The pixel size", "m")
    extrapolation: str = choice("automatic", ("automatic", "draw", "leave-out"), "The extrapolation")
    resampling: str = choice("bilinear", ("bilinear", "nearest", "cubic"), "The resampling")
    check_disabled: bool = False   # whether disabled points are used as check points


@dataclass(frozen=True)
class Georeferencing:
    """The result of `georeference` for N points."""

    image: SourceImage   # image, points, settings: as given; disabled points used as check points have the role "check"
    points: ControlPoints
    settings: GeoreferenceSettings
    fit: _ControlPointFit   # _ControlPointFit of the control points
    pixel_size: float   # m, of the image to be drawn
    hull: shapely.Geometry | None   # shapely polygon around the control points in pixel and line; None for a shift
    outside: float   # 0 to 1, share of the area of the image outside the hull
    cut: bool   # whether only the hull is drawn
    errors: np.ndarray   # (N, 2) m, map coordinates of every point minus those of the polynomial
    left_out: np.ndarray   # (N, 2) m, the same where the point is left out of the fit; NaN where the other points are not enough
    notes: list[str] = field(default_factory=list)   # warnings for the user, one sentence each

    def rmse(self, role: str = CONTROL) -> float:
        """Root mean square of the lengths of the residuals of a role, m: sqrt(sum(dx^2 + dy^2) / n); NaN without points."""
        return _rmse(self.errors[self.points.having(role)])

    @property
    def left_out_rmse(self) -> float:
        """The same of the leave-one-out residuals of the control points, m; NaN where one of them cannot be computed."""
        return _rmse(self.left_out[self.points.having(CONTROL)])


def _rmse(vectors):
    """Root mean square of the lengths of vectors, NaN without any."""
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1)))) if len(vectors) else float("nan")


def georeference(image: SourceImage, points: ControlPoints, settings: GeoreferenceSettings = GeoreferenceSettings()) -> Georeferencing:
    """Fit a polynomial to control points, in a projected CRS in metres or in local metres, and assess it.

    Raises RoadExtractionError if there are fewer than 1, 3, 6, 10 control points for order 0, 1, 2, 3; if they lie on a line or do not determine the
    polynomial; if the polynomial mirrors or folds the image; if the CRS is not in metres; or if the image of a shift has no position.
    """
    if settings.check_disabled:
        points = points.with_disabled_as_checks()
    if points.crs:
        check_metric(parse_crs(points.crs), "The set of control points")
    used = points.having(CONTROL)
    pixel, line, easting, northing = (getattr(points, name)[used] for name in REQUIRED_COLUMNS)
    _enough(len(used), len(points), settings.order)
    if settings.order == 0:
        fit = fit_shift(pixel, line, easting, northing, _rough_position(image, points, settings))
    else:
        _well_spread(pixel, line, easting, northing, settings.order)
        fit = fit_image_polynomial(pixel, line, easting, northing, settings.order)
    hull = shapely.convex_hull(shapely.multipoints(np.column_stack([pixel, line]))) if settings.order else None
    frame = shapely.box(0, 0, image.width, image.height)
    outside = 1.0 - hull.intersection(frame).area / frame.area if hull is not None else 0.0
    cut = settings.order > 0 and (settings.extrapolation == "leave-out"
                                  or (settings.extrapolation == "automatic" and settings.order == 3))
    _unfolded(fit, frame if hull is None or not cut else hull.intersection(frame), hull, points, used, settings.order)
    easting, northing = fit.polynomial.to_map(points.pixel, points.line)
    errors = np.column_stack([points.easting - easting, points.northing - northing])
    left_out = errors.copy()
    left_out[used] = fit.left_out
    size = settings.pixel_size or float(f"{_own_pixel_size(fit, hull or frame):.2g}")
    result = Georeferencing(image, points, settings, fit, size, hull, outside, cut, errors, left_out)
    result.notes.extend(_notes(result))
    return result


def residual_vectors(result: Georeferencing) -> Features:
    """Features RESIDUALS of the control and check points: LineStringZ from the place of each by the polynomial to its measured place."""
    points, errors = result.points, result.errors
    leverage = np.full(len(points), np.nan)
    leverage[points.having(CONTROL)] = result.fit.leverage
    layer = Features("LineStringZ", RESIDUALS, crs=points.crs)
    heights = np.nan_to_num(points.height)
    for k in range(len(points)):
        end = np.array([points.easting[k], points.northing[k]])
        start = end - errors[k]
        layer.add(shapely.LineString([(*start, heights[k]), (*end, heights[k])]), point=points.names[k], role=points.roles[k],
                  pixel=points.pixel[k], line=points.line[k], dx_m=errors[k, 0], dy_m=errors[k, 1], resid_m=np.hypot(*errors[k]),
                  loo_m=np.hypot(*result.left_out[k]), leverage=leverage[k])
    return layer


def _enough(count, rows, order):
    """Refuse too few control points for an order."""
    if count >= MIN_CONTROL_POINTS[order]:
        return
    kind = "a shift" if order == 0 else f"a polynomial of order {order}"
    apart = f" ({rows - count} more are disabled or check points)" if rows > count else ""
    lower = [k for k in range(1, order) if MIN_CONTROL_POINTS[k] <= count]
    way = f"Measure more points, or choose order {lower[-1]}." if lower else "Measure more points."
    raise RoadExtractionError(f"There are {count} control points{apart}; {kind} needs {MIN_CONTROL_POINTS[order]} or more. {way}")


def _rough_position(image, points, settings):
    """Geotransform of the approximate position of the image before a shift."""
    if image.geotransform is not None:
        image_crs, points_crs = parse_crs(image.crs), parse_crs(points.crs)
        if image_crs is not None and points_crs is not None and not same_crs(image_crs, points_crs):
            raise RoadExtractionError(
                f"The image lies in {horizontal_part(image_crs).name}, the control points in {horizontal_part(points_crs).name}. A shift (order 0) "
                "needs both in one CRS: reproject the image or the points, or choose order 1.")
        return image.geotransform
    if settings.pixel_size <= 0:
        raise RoadExtractionError("The image has no position of its own, so there is nothing to shift (order 0). Give its pixel size, if north is up "
                                  "in the image, or choose order 1 with three or more control points.")
    return (0.0, settings.pixel_size, 0.0, 0.0, 0.0, -settings.pixel_size)


def _well_spread(pixel, line, easting, northing, order):
    """Refuse control points on a line, in the image or on the map, and those that do not determine a higher order."""
    for places, unit, digits in ((np.column_stack([pixel, line]), "pixels", 0), (np.column_stack([easting, northing]), "m", 2)):
        along, across = _principal_extents(places)
        if across <= COLLINEAR_RATIO * along:
            raise RoadExtractionError(f"The {len(pixel)} control points lie in a line: they spread {along:.{digits}f} {unit} along it and "
                                      f"{across:.{digits}f} {unit} across. Measure points on both sides of it, spread over the image.")
    if order > 1 and inverse_condition(pixel, line, order) < MIN_INVERSE_CONDITION:
        raise RoadExtractionError(f"The {len(pixel)} control points lie so (in few rows, on one curve, or several in one place) that a polynomial of "
                                  f"order {order} is not determined between them. Add points away from the others, or choose order {order - 1}.")


def _unfolded(fit, area, hull, points, used, order):
    """Refuse a polynomial that mirrors or folds the image where it is drawn."""
    pixel, line = _node_grid(area.bounds, 25)
    inside = shapely.contains_xy(area.buffer(1e-6), pixel, line)
    turn = np.linalg.det(fit.polynomial.jacobian(pixel[inside], line[inside]))
    if (turn < 0).all():
        return
    if (turn > 0).all():
        raise RoadExtractionError("The control points turn the image into its mirror image. Are pixel and line, or easting and northing, swapped?")
    within = hull is not None and shapely.contains_xy(hull, pixel[inside], line[inside])[turn >= 0].any()
    if within:
        worst = int(np.argmax(_burden(fit)))
        raise RoadExtractionError(f"Between the control points the polynomial of order {order} folds the image over itself. A point is wrong (check "
                                  f"{points.names[used[worst]]} first), or the order is too high: choose a lower one.")
    raise RoadExtractionError(f"Outside the control points the polynomial of order {order} folds the image over itself. Choose a lower order, "
                              "measure points nearer to the image's corners, or leave out what lies outside the points (extrapolation).")


def _node_grid(bounds: tuple[float, float, float, float], count: int) -> tuple[np.ndarray, np.ndarray]:
    """Pixel and line, (count ** 2,) each, of a regular grid within bounds: smallest pixel and line, largest pixel and line."""
    across, down = np.meshgrid(np.linspace(bounds[0], bounds[2], count), np.linspace(bounds[1], bounds[3], count))
    return across.ravel(), down.ravel()


def _own_pixel_size(fit: _ControlPointFit, area: shapely.Geometry) -> float:
    """m, the size of the image's pixels on the map: median over an area, a polygon in pixel and line."""
    pixel, line = _node_grid(area.bounds, 9)
    inside = shapely.contains_xy(area, pixel, line)
    return float(np.sqrt(np.median(np.abs(np.linalg.det(fit.polynomial.jacobian(pixel[inside], line[inside]))))))


def _notes(result: Georeferencing) -> Iterator[str]:
    """Warnings for the user, one sentence each."""
    fit, points, order = result.fit, result.points, result.settings.order
    used = points.having(CONTROL)
    if not points.crs:
        yield ("The control points have no CRS, so the result has none either: it lies in their coordinates. If these are "
               "map coordinates, give their CRS.")
    yield from _map_metres(points)
    if points.left_out:
        yield f"{points.left_out} rows of the table of control points hold no numbers and were left out."
    if order and fit.free == 0:
        yield (f"{len(used)} control points are the fewest for order {order}: the polynomial passes through all of them, and the "
               "residuals are 0 whatever their errors. Measure more points, or choose a lower order.")
    elif order and len(used) < _SUFFICIENT_RATIO * MIN_CONTROL_POINTS[order]:
        yield (f"{len(used)} control points are few for order {order} ({MIN_CONTROL_POINTS[order]} at least): the residuals are smaller than "
               "the errors. Use the leave-one-out error instead.")
    if order and result.outside > _NOTED_OUTSIDE_SHARE:
        ring = shapely.line_interpolate_point(shapely.box(0, 0, result.image.width, result.image.height).exterior,
                                              np.linspace(0, 1, _OUTLINE_PLACES), normalized=True)
        times = float(np.sqrt(fit.leverage_at(*shapely.get_coordinates(ring).T).max()))
        share = f"{100 * result.outside:.0f} % of the image lies outside the hull of the control points"
        if result.cut:
            yield f"{share} and is left out, because a polynomial of order {order} is not reliable there."
        elif order > 1 or times > 1.0:
            yield (f"{share}; there the polynomial extrapolates, and at the worst place on the border its error is {times:.1f} times "
                   "that of a single point.")
    for index in _misfits(result):
        yield (f"Point {points.names[index]} does not fit the others: it lies {np.hypot(*result.left_out[index]):.2f} m from where "
               "they place it. Check its coordinates.")


def _map_metres(points):
    """A warning where a metre on the map is not a metre on the ground, as in web maps."""
    crs = horizontal_part(parse_crs(points.crs))
    if crs is None or not crs.is_projected:
        return
    try:
        projection = pyproj.Proj(crs)
        longitude, latitude = projection(float(points.easting.mean()), float(points.northing.mean()), inverse=True)
        scale = float(np.sqrt(projection.get_factors(longitude, latitude).areal_scale))   # metres on the map per metre on the ground
    except (pyproj.exceptions.CRSError, pyproj.exceptions.ProjError):   # a local CRS
        return
    if np.isfinite(scale) and abs(scale - 1.0) > _MAX_SCALE_ERROR:
        yield (f"In {crs.name} a metre of the map is {1.0 / scale:.2f} m on the ground here, and all errors are in metres of the map. "
               "For measuring, use control points in the CRS of the survey.")


def _burden(fit):
    """Decrease of the sum of squares, m², without each point; largest for a single wrong point."""
    return np.sum(fit.residuals**2, axis=1) / np.maximum(1.0 - fit.leverage, 1e-6)


def _misfits(result):
    """Control points with an extreme residual (externally studentised, two coordinates)."""
    fit, used = result.fit, result.points.having(CONTROL)
    freedom = 2 * fit.free - 2
    if freedom < 2:
        return []
    burden = _burden(fit)
    rest = np.maximum(np.sum(fit.residuals**2) - burden, 0.0) / freedom
    floor = (_MIN_POINT_ERROR * result.pixel_size) ** 2
    extreme = burden / 2 > _MISFIT_RESIDUAL**2 * np.maximum(rest, floor)
    return used[extreme][np.argsort(-burden[extreme])][:_MAX_MISFITS]


# Polynomials from pixels to the map, fitted to ground control points by least squares.

COLLINEAR_RATIO = 0.01         # extent across over extent along, below which points lie on a line
MIN_INVERSE_CONDITION = 1e-3   # smallest over largest singular value, below which the points do not determine the coefficients
MIN_CONTROL_POINTS = (1, 3, 6, 10)  # by order: a shift needs one point, order t needs (t + 1)(t + 2) / 2


def term_powers(order: int) -> np.ndarray:
    """(K, 2) int powers a, b of the terms u^a v^b with a + b <= order, K = (order + 1)(order + 2) / 2."""
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
class _ControlPointFit:
    """A polynomial fitted to N control points, with the quality of the fit."""

    polynomial: ImagePolynomial
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


def _principal_extents(places: np.ndarray) -> tuple[float, float]:
    """Extents of (N, 2) places along their principal axes, the longer one first."""
    _, _, turned = np.linalg.svd(places - places.mean(axis=0), full_matrices=False)
    along, across = np.ptp((places - places.mean(axis=0)) @ turned.T, axis=0)
    return float(along), float(across)


def lie_on_a_line(places: np.ndarray) -> bool:
    """Whether (N, 2) places lie on a line, nearly."""
    along, across = _principal_extents(places)
    return across <= COLLINEAR_RATIO * along


def inverse_condition(pixel: np.ndarray, line: np.ndarray, order: int) -> float:
    """Smallest over largest singular value of the terms of an order at (N,) places, 0 to 1; 0 where these do not determine it."""
    centre, whiten = _frame(np.column_stack([pixel, line]))
    singular = np.linalg.svd(_terms((np.column_stack([pixel, line]) - centre) @ whiten, order), compute_uv=False)
    return float(singular[-1] / singular[0])


def _frame(places):
    """Centre and whitening matrix of places (N, 2) that do not lie on a line."""
    centre = places.mean(axis=0)
    _, singular, turned = np.linalg.svd(places - centre, full_matrices=False)
    return centre, turned.T / (singular / np.sqrt(len(places)))


def fit_image_polynomial(pixel: np.ndarray, line: np.ndarray, easting: np.ndarray, northing: np.ndarray, order: int) -> _ControlPointFit:
    """Fit a polynomial of order 1 to 3, X = sum a_ij u^i v^j and Y likewise, to (N,) places in the image and on the map, m.

    N is at least MIN_CONTROL_POINTS[order], and the places in the image lie on no line. The terms are those of the polynomials of ArcGIS and
    GDAL. They are centred and scaled, and solved by QR. With R of the QR, h_i = |R^-T t_i|^2 is the leverage, and r_i / (1 - h_i) the
    residual of a point that is left out (Belsley, Kuh and Welsch 1980, Regression Diagnostics).
    """
    places, target = np.column_stack([pixel, line]).astype(float), np.column_stack([easting, northing]).astype(float)
    centre, whiten = _frame(places)
    terms = _terms((places - centre) @ whiten, order)
    origin = target.mean(axis=0)
    basis, triangle = np.linalg.qr(terms)
    coefficients = np.linalg.solve(triangle, basis.T @ (target - origin))
    residuals = target - origin - terms @ coefficients
    return _ControlPointFit(ImagePolynomial(order, centre, whiten, origin, coefficients), residuals, np.sum(basis**2, axis=1), triangle, order)


def fit_shift(pixel: np.ndarray, line: np.ndarray, easting: np.ndarray, northing: np.ndarray,
              geotransform: tuple[float, ...]) -> _ControlPointFit:
    """Fit of order 0 to (N,) places in the image and on the map, m: a shift from an approximate position, six numbers as in GDAL."""
    x0, xp, xl, y0, yp, yl = geotransform
    places, target = np.column_stack([pixel, line]).astype(float), np.column_stack([easting, northing]).astype(float)
    slope = np.array([[xp, xl], [yp, yl]])
    centre, count = places.mean(axis=0), len(places)
    origin = target.mean(axis=0)
    coefficients = np.vstack([np.zeros(2), slope.T])
    residuals = target - origin - (places - centre) @ slope.T
    return _ControlPointFit(ImagePolynomial(1, centre, np.eye(2), origin, coefficients), residuals,
               np.full(count, 1.0 / count), np.array([[np.sqrt(count)]]), 0)


# The georeferenced image, resampled by GDAL into a GeoTIFF.

GDAL_CACHE = 128_000_000  # bytes: a larger cache delays the writing of blocks to the end of the work
MAX_RESULT_PIXELS = 4e9  # a larger result means that the polynomial or the pixel size is wrong
_APPROXIMATION = 0.05    # pixels, error of the interpolation along a row by GDAL
_NODES = 21              # per side, of the grid of points that replaces the polynomial in GDAL
_MARGINS = (0.2, 0.1, 0.04, 0.0)  # of the size of the area, by which the grid exceeds it
_SMALLEST_OVERVIEW = 256  # pixels
_ALGORITHMS = {"nearest": "near", "bilinear": "bilinear", "cubic": "cubic"}


def drawn_area(result: Georeferencing) -> shapely.Geometry:
    """The part of the image that is drawn, a polygon in pixel and line."""
    frame = shapely.box(0, 0, result.image.width, result.image.height)
    return result.hull.intersection(frame) if result.cut and result.hull is not None else frame


def output_grid(result: Georeferencing) -> tuple[tuple[float, float, float, float], int, int]:
    """((min x, min y, max x, max y) m, width, height in pixels) of the result.

    Bounds are whole multiples of the pixel size. A shift at the pixel size of the image keeps the bounds of the image, so that no pixel is resampled.
    Raises RoadExtractionError if the result would have more than MAX_RESULT_PIXELS.
    """
    outline = drawn_area(result).exterior
    outline = shapely.get_coordinates(outline.segmentize(max(outline.length / 400, 1e-6)))
    easting, northing = result.fit.polynomial.to_map(outline[:, 0], outline[:, 1])
    size = result.pixel_size
    x0, y0, x1, y1 = easting.min(), northing.min(), easting.max(), northing.max()
    if not _keeps_its_pixels(result):
        x0, y0 = np.floor(x0 / size + 1e-6) * size, np.floor(y0 / size + 1e-6) * size
    width, height = (max(int(np.ceil((b - a) / size - 1e-6)), 1) for a, b in ((x0, x1), (y0, y1)))
    if width * height > MAX_RESULT_PIXELS:
        raise RoadExtractionError(f"The result would have {width} by {height} pixels of {size:g} m. Give a larger pixel size, choose a lower order, "
                                  "or check the control points.")
    y1 = y0 + height * size if not _keeps_its_pixels(result) else y1
    return (float(x0), float(y1 - height * size), float(x0 + width * size), float(y1)), width, height


def _keeps_its_pixels(result):
    """Whether the image is only shifted, at its own pixel size."""
    slope = result.fit.polynomial.jacobian(np.zeros(1), np.zeros(1))[0]
    return result.settings.order == 0 and np.allclose(slope, result.pixel_size * np.array([[1, 0], [0, -1]]), rtol=1e-9, atol=1e-12)


@gdal_exceptions()
def draw_image(result: Georeferencing, path: str | Path, progress: Progress = Progress()) -> float:
    """Write the image as a tiled GeoTIFF with lossless compression and overviews; the file appears when it is complete.

    Images of bytes get an alpha band. Images of larger integers get 0, and those of real numbers NaN, as no-data value, unless the image has its own.
    Returns pixels, the greatest distance between the places where GDAL and the polynomial put a pixel.
    Raises RoadExtractionError if the result would be too large, the image cannot be read, or the file cannot be written.
    """
    bounds, width, height = output_grid(result)
    unfinished, tiled = (unfinished_path(path, suffix) for suffix in (".tif", ".source.tif"))
    source = view = None
    failure = ""
    cache = gdal.GetCacheMax()
    gdal.SetCacheMax(min(cache, GDAL_CACHE))
    try:
        source = _with_point_grid(result, gdal_work(partial(_tiled, result.image, tiled), progress.part(0.0, 0.1)))
        departure = _departure(source, result) + _APPROXIMATION
        # Blocks are resampled while they are written: every tile is compressed once, and Cancel takes effect in between
        view = gdal.Warp("", source, **_warp_options(result, bounds))
        gdal_work(partial(_write, view, unfinished, result.image), progress.part(0.1, 0.8))
        # closed and opened again: GDAL 3.6 may deadlock where it reads what its own threads still write
        if levels := [2**k for k in range(1, 16) if max(width, height) / 2**k >= _SMALLEST_OVERVIEW]:
            gdal_work(lambda report: gdal.Open(str(unfinished), gdal.GA_Update).BuildOverviews("AVERAGE", levels, callback=report),
                      progress.part(0.8, 1.0))
        os.replace(unfinished, path)
        Path(f"{path}.aux.xml").unlink(missing_ok=True)
    except RuntimeError as problem:
        failure = str(problem)
    finally:
        source = view = None
        gdal.SetCacheMax(cache)
        for leftover in (unfinished, Path(f"{unfinished}.aux.xml"), tiled):
            leftover.unlink(missing_ok=True)
    if failure:   # raised here: the error of GDAL would keep its datasets alive until after GDAL itself is unloaded
        raise RoadExtractionError(f"The image could not be drawn to {path} ({failure}). Is {result.image.path} whole, and is there room on the disk?")
    progress.report(1.0)
    return departure


def _tiled(image, path, callback):
    """The path of the image, or of a copy in tiles where it is large and stored line by line (JPEG, PNG).

    A rotated image is read across its lines, and each such read would decompress the file from its beginning.
    """
    dataset = open_raster(image.path)
    band = dataset.GetRasterBand(1)
    size = image.width * image.height * image.bands * gdal.GetDataTypeSize(band.DataType) // 8
    if size < GDAL_CACHE // 2 or band.GetBlockSize()[0] < image.width:
        return image.path
    gdal.Translate(str(path), dataset, format="GTiff", creationOptions=["TILED=YES", "BIGTIFF=IF_SAFER", "COMPRESS=LZW"], callback=callback)
    return str(path)


def _with_point_grid(result, path):
    """The image with a grid of ground control points in place of a position, as an open GDAL dataset.

    GDAL would fit its own polynomial from the map to the image, which is not the inverse of ours: in an oblique image it is
    off by tens of pixels. A dense grid of points that follow our polynomial makes it interpolate by thin-plate splines
    instead (an affine transformation needs any three of them).
    """
    area, polynomial = drawn_area(result), result.fit.polynomial
    x0, y0, x1, y1 = area.bounds
    for margin in _MARGINS:
        reach = margin * max(x1 - x0, y1 - y0)
        pixel, line = _node_grid((x0 - reach, y0 - reach, x1 + reach, y1 + reach), _NODES)
        if (np.linalg.det(polynomial.jacobian(pixel, line)) < 0).all():
            break
    wkt, units = as_in_file(result.points.crs)
    easting, northing = units.in_file(np.column_stack(polynomial.to_map(pixel, line))).T
    points = [gdal.GCP(*map(float, point)) for point in zip(easting, northing, np.zeros(len(pixel)), pixel, line)]
    options = {"rgbExpand": "rgb"} if result.image.palette else {}
    return gdal.Translate("", path, format="VRT", GCPs=points, outputSRS=wkt or None, **options)


def _method(result):
    return "GCP_TPS" if result.fit.polynomial.order > 1 else "GCP_POLYNOMIAL"


def _departure(source, result):
    """Pixels between the places where GDAL's transformer and the inverse of the polynomial look for the result."""
    area = drawn_area(result)
    pixel, line = _node_grid(area.bounds, 33)
    inside = shapely.contains_xy(area, pixel, line)
    pixel, line = pixel[inside], line[inside]
    easting, northing = as_in_file(result.points.crs)[1].in_file(np.column_stack(result.fit.polynomial.to_map(pixel, line))).T
    transformer = gdal.Transformer(source, None, [f"METHOD={_method(result)}"] + ["MAX_GCP_ORDER=1"] * (_method(result) != "GCP_TPS"))
    places, _ = transformer.TransformPoints(1, np.column_stack([easting, northing, np.zeros(len(pixel))]).tolist())
    return float(np.hypot(*(np.array(places)[:, :2] - np.column_stack([pixel, line])).T).max())


def _warp_options(result, bounds):
    image, size, (wkt, units) = result.image, result.pixel_size, as_in_file(result.points.crs)
    transform = {"tps": True} if _method(result) == "GCP_TPS" else {"polynomialOrder": 1}
    ends = {}
    if not image.has_alpha:
        if image.nodata is not None:
            ends = {"dstNodata": image.nodata}
        elif image.kind == "byte":
            ends = {"dstAlpha": True}
        else:
            ends = {"dstNodata": 0 if image.kind == "integer" else "nan"}
    # By default GDAL estimates the scale from the extent of each window, and blurs rotated images at their borders
    scale = min(1.0, _own_pixel_size(result.fit, drawn_area(result)) / size)
    options = [f"XSCALE={scale}", f"YSCALE={scale}"]
    if result.cut:
        options.append(f"CUTLINE={shapely.to_wkt(drawn_area(result), rounding_precision=3)}")
    return {
        "format": "VRT", "outputBounds": units.geotransform(bounds, to_file=True), "xRes": size / units.across, "yRes": size / units.across,
        "resampleAlg": _ALGORITHMS[result.settings.resampling],
        "dstSRS": wkt or None, "errorThreshold": _APPROXIMATION, "warpOptions": options, **transform, **ends}


def _write(view, path, image, report):
    options = ["TILED=YES", f"BLOCKXSIZE={GEOTIFF_TILE}", f"BLOCKYSIZE={GEOTIFF_TILE}", "COMPRESS=DEFLATE", "BIGTIFF=IF_SAFER",
               "NUM_THREADS=ALL_CPUS", f"PREDICTOR={3 if image.kind == 'real' else 2}"]
    gdal.GetDriverByName("GTiff").CreateCopy(str(path), view, options=options, callback=report)
