"""Polynomials through control points: exact where they should be, honest where they cannot be."""

import numpy as np
import pytest
from flown_images import HEIGHT, WIDTH, ground, measured
from lanewright.products.overlay.georeference import MIN_CONTROL_POINTS, fit_image_polynomial, fit_shift, term_powers
from osgeo import gdal

ORDERS = [1, 2, 3]


def fitted(order, count=24, noise=0.02, seed=1, **distortion):
    points = measured(count, noise, seed, **distortion)
    return points, fit_image_polynomial(points.pixel, points.line, points.easting, points.northing, order)


def by_hand(points, order):
    """The same fit by normal equations in monomials of u, v in longdouble, and its residuals."""
    u, v = ((points.pixel - WIDTH / 2) / 300).astype(np.longdouble), ((points.line - HEIGHT / 2) / 300).astype(np.longdouble)
    a = np.column_stack([u**i * v**j for i in range(order + 1) for j in range(order + 1 - i)]).astype(float)
    target = np.column_stack([points.easting - points.easting.mean(), points.northing - points.northing.mean()])
    return target - a @ np.linalg.solve(a.T @ a, a.T @ target)


@pytest.mark.parametrize("order", range(4))
def test_the_fewest_points_are_the_coefficients_of_an_axis(order):
    assert len(term_powers(order)) == MIN_CONTROL_POINTS[order] == (order + 1) * (order + 2) // 2


@pytest.mark.parametrize("order", ORDERS)
def test_a_distortion_of_the_order_is_found_exactly(order):
    distortion = {"bend": 0.03 if order > 1 else 0.0, "twist": 0.01 if order > 2 else 0.0}
    _, fit = fitted(order, noise=0.0, **distortion)
    pixel, line = np.array([0.0, WIDTH, 77.7]), np.array([0.0, HEIGHT, 300.3])
    np.testing.assert_allclose(fit.polynomial.to_map(pixel, line), ground(pixel, line, **distortion), atol=1e-7)


@pytest.mark.parametrize("order", ORDERS)
def test_residuals_are_those_of_normal_equations_solved_apart(order):
    points, fit = fitted(order, twist=0.01)
    np.testing.assert_allclose(fit.residuals, by_hand(points, order), atol=1e-8)


@pytest.mark.parametrize("order", ORDERS)
def test_gdals_own_polynomial_puts_pixels_in_the_same_place(order):
    points, fit = fitted(order, twist=0.01)
    dataset = gdal.GetDriverByName("MEM").Create("", WIDTH, HEIGHT, 1)
    dataset.SetGCPs([gdal.GCP(float(x), float(y), 0, float(p), float(q)) for x, y, p, q in zip(
        points.easting, points.northing, points.pixel, points.line)], "")
    transformer = gdal.Transformer(dataset, None, ["METHOD=GCP_POLYNOMIAL", f"MAX_GCP_ORDER={order}"])
    places, _ = transformer.TransformPoints(0, np.column_stack([points.pixel, points.line, np.zeros(len(points))]).tolist())
    np.testing.assert_allclose(np.array(places)[:, :2].T, fit.polynomial.to_map(points.pixel, points.line), atol=1e-4)


@pytest.mark.parametrize("order", ORDERS)
def test_the_error_without_a_point_is_that_of_a_fit_without_it(order):
    points, fit = fitted(order)
    for k in (0, 7):
        rest = np.delete(np.arange(len(points)), k)
        without = fit_image_polynomial(points.pixel[rest], points.line[rest], points.easting[rest], points.northing[rest], order)
        east, north = without.polynomial.to_map(points.pixel[[k]], points.line[[k]])
        np.testing.assert_allclose(fit.left_out[k], [points.easting[k] - east[0], points.northing[k] - north[0]], atol=1e-7)


def test_at_the_fewest_points_residuals_vanish_and_the_error_without_each_is_not_told():
    _, fit = fitted(2, count=6, noise=0.5)
    assert np.abs(fit.residuals).max() < 1e-6
    assert fit.free == 0 and np.isnan(fit.left_out).all()


def test_leverage_sums_to_the_coefficients_and_grows_outside_the_points():
    points, fit = fitted(2)
    assert fit.leverage.sum() == pytest.approx(6.0)
    np.testing.assert_allclose(fit.leverage_at(points.pixel, points.line), fit.leverage, atol=1e-9)
    assert fit.leverage_at(np.array([-300.0]), np.array([-300.0]))[0] > 5 * fit.leverage.max()


def test_moving_the_survey_moves_the_map_and_nothing_else():
    points, fit = fitted(3)
    moved = fit_image_polynomial(points.pixel, points.line, points.easting + 5e5, points.northing - 3e6, 3)
    np.testing.assert_allclose(moved.residuals, fit.residuals, atol=1e-7)


def test_slopes_are_those_of_small_steps():
    _, fit = fitted(3, twist=0.01)
    here = np.array([[100.0, 350.0, 580.0], [20.0, 200.0, 390.0]])
    for axis in (0, 1):
        step = np.zeros((2, 1))
        step[axis] = 0.01
        rise = np.subtract(fit.polynomial.to_map(*(here + step)), fit.polynomial.to_map(*(here - step))) / 0.02
        np.testing.assert_allclose(fit.polynomial.jacobian(*here)[:, :, axis].T, rise, atol=1e-6)


def test_a_shift_keeps_scale_and_direction():
    position = (EAST_OFF := 1000.0, 0.05, 0.01, 2000.0, 0.01, -0.05)
    pixel, line = np.array([10.0, 500.0, 300.0]), np.array([20.0, 80.0, 390.0])
    east = position[0] + 0.05 * pixel + 0.01 * line + 3.0
    north = position[3] + 0.01 * pixel - 0.05 * line - 4.0
    fit = fit_shift(pixel, line, east + [0.02, -0.02, 0.0], north, position)
    np.testing.assert_allclose(fit.polynomial.to_map(np.zeros(1), np.zeros(1)), [[EAST_OFF + 3.0], [1996.0]], atol=1e-9)
    np.testing.assert_allclose(fit.residuals[:, 0], [0.02, -0.02, 0.0], atol=1e-9)
    np.testing.assert_allclose(fit.left_out[0, 0], 0.03, atol=1e-9)  # against the mean of the other two
