"""Curvature of paint whose curvature is known."""

import numpy as np
import pytest
from lanewright.core.survey.store.columns import Columns
from lanewright.core.survey.store.records import Points, to_units
from lanewright.products.report.curvature import CURVATURE_KERNEL, _quadrics, marking_curvature
from scipy.spatial import cKDTree
from shapely.geometry import LineString


def strip(length=20.0, width=0.15, spacing=0.02):
    x, y = np.meshgrid(np.arange(0, length, spacing), np.arange(-width / 2, width / 2 + 1e-9, spacing))
    return x.ravel(), y.ravel()


def inner(x, y):
    """Rows away from the ends: at a corner a kernel is a quarter full."""
    return np.flatnonzero((x > x.min() + 0.2) & (x < x.max() - 0.2))[::40]


def paint(x, y, z):
    return Points(Columns({name: to_units(values) for name, values in zip("xyz", (x, y, z))}, [(name, "i4") for name in "xyz"]))


def mean_curvature(xyz, which):
    around = cKDTree(xyz).query_ball_point(xyz[which], CURVATURE_KERNEL)
    return _quadrics(np.concatenate([xyz[members] - xyz[k] for members, k in zip(around, which)]), np.array(list(map(len, around))))


def test_a_plane_has_no_curvature_however_it_slopes():
    x, y = strip()
    found = mean_curvature(np.c_[x, y, 0.05 * x - 0.02 * y], inner(x, y))
    np.testing.assert_allclose(found, 0.0, atol=1e-5)


@pytest.mark.parametrize("radius", [5.0, 50.0])
def test_a_ball_curves_by_one_over_its_radius_and_a_cylinder_by_half_of_that(radius):
    x, y = strip(1.0, 1.0)
    x = x - 0.5
    ball = mean_curvature(np.c_[x, y, np.sqrt(radius**2 - x**2 - y**2)], inner(x, y))
    cylinder = mean_curvature(np.c_[x, y, np.sqrt(radius**2 - x**2)], inner(x, y))
    np.testing.assert_allclose(np.abs(ball), 1 / radius, rtol=0.02)
    np.testing.assert_allclose(np.abs(cylinder), 0.5 / radius, rtol=0.02)


def test_points_on_a_single_line_have_no_surface():
    x = np.arange(0, 5, 0.01)
    assert np.isnan(mean_curvature(np.c_[x, 0 * x, 0 * x], np.arange(0, 500, 10))).all()


def test_fitting_takes_the_roughness_out_of_paint():
    x, y = strip()
    z = 100.0 + np.random.default_rng(3).normal(0, 0.004, len(x))
    origin = np.array([500000.0, 5400000.0, 90.0])
    line = LineString([(500000.0, 5400000.0, 190.0), (500020.0, 5400000.0, 190.0)])
    found = marking_curvature(paint(x, y, z), [line], origin)
    assert found.before > 0.05 and found.after < 1e-4


def test_paint_beside_no_line_has_no_figure():
    x, y = strip()
    assert marking_curvature(paint(x, y + 3, 0 * x), [LineString([(0, 0, 0), (20, 0, 0)])], np.zeros(3)) is None
    assert marking_curvature(paint(x, y, 0 * x), [], np.zeros(3)) is None
