"""Curves fitted to painted lines whose shape is known."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.curves.base import Arc
from lanewright.core.curves.bspline import fit_splines
from lanewright.core.curves.clothoid import Clothoid, fit_clothoids
from lanewright.core.curves.model_selection import fit_curve
from lanewright.core.curves.segmentation import element_ranges
from lanewright.core.curves.simple_curves import Ellipse, fit_circles, fit_ellipse, fit_lines, fit_polynomial

EVERY_CURVE = [
    Arc(12.0, -7.0, 0.7, 0.0, 60.0),
    Arc(12.0, -7.0, 0.7, 1 / 60, 90.0),
    Arc(12.0, -7.0, 0.7, -1 / 140, 90.0),
    Clothoid(5.0, 3.0, 2.0, -1 / 200, 1 / 4800, 80.0),
    Ellipse(20.0, 30.0, 80.0, 50.0, 0.4, 0.2, 2.0),
    Ellipse(20.0, 30.0, 80.0, 50.0, 0.4, 2.0, 0.2),
]


def painted(curve, noise=0.01, step=0.25, seed=1):
    """Points on a line with lateral noise, one per `step` metres."""
    u = np.arange(0.0, curve.length, step)
    heading = curve.heading(u)
    e = np.random.default_rng(seed).normal(0, noise, len(u)) if noise else np.zeros(len(u))
    return (curve.at(u) + e[:, None] * np.c_[-np.sin(heading), np.cos(heading)]).T


def along(elements, noise=0.008, step=0.5):
    """Points along straights (0, 0, L), arcs (k, k, L) and transitions (k0, k1, L) laid end to end."""
    x, y, heading, places = 0.0, 0.0, 0.0, []
    for k, (first, last, length) in enumerate(elements):
        curve = Clothoid(x, y, heading, first, (last - first) / length, length)
        places.append(np.stack(painted(curve, noise, step, seed=k)))
        (x, y), = curve.at(np.array([length])).tolist()
        heading = float(curve.heading(length))
    return np.hstack(places)


def test_a_short_arc_among_outliers_keeps_its_radius():
    """The thesis's own case: R = 140 m over 25.8 m, 3 cm of noise, every tenth point a stray."""
    radii = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        turn = np.linspace(0, 25.8, 600) / 140
        off = rng.normal(0, 0.03, 600)
        off += np.where(rng.random(600) < 0.1, rng.uniform(-0.3, 0.3, 600), 0)
        radii.append(fit_circles([((140 + off) * np.cos(turn) + 500, (140 + off) * np.sin(turn))])[0].curve.radius)
    assert np.mean(radii) == pytest.approx(139.9, abs=2.5)
    assert np.std(radii) < 2.5


def test_the_radius_of_an_exact_arc_is_exact_and_left_turns_bend_positive():
    for bend in (1 / 60, -1 / 60, 1 / 400):
        fit, = fit_circles([painted(Arc(0.0, 0.0, 0.3, bend, 20.0), noise=0)])
        assert fit.curve.bend == pytest.approx(bend, rel=1e-6)
        assert fit.rmse < 1e-7


def test_a_straight_line_is_no_circle_of_a_kilometre():
    fit = fit_curve(*painted(Arc(0.0, 0.0, 0.3, 0.0, 60.0)))
    assert fit.curve.kind == "line"
    assert np.isnan(fit.curve.radius)
    assert fit.curve.length == pytest.approx(59.75, abs=0.02)


def test_a_parabola_is_no_circle():
    """For R = 140 m the parabola's best error grows from millimetres to half a metre."""
    for length, least, most in ((26, 0.0, 0.002), (80, 0.02, 0.05), (160, 0.4, 0.8)):
        x, y = painted(Arc(0.0, 0.0, -length / 280, 1 / 140, float(length)), noise=0)
        assert least <= np.abs(fit_polynomial(x, y, 2).residuals).max() <= most
        assert np.abs(fit_circles([(x, y)])[0].residuals).max() < 1e-6


def test_a_polynomial_refuses_a_line_that_turns_back():
    with pytest.raises(RoadExtractionError, match="turns back"):
        fit_polynomial(*painted(Arc(0.0, 0.0, 0.0, 1 / 10, 45.0)))


def test_a_clothoid_is_recovered():
    truth = Clothoid(10.0, 20.0, 0.7, -1 / 200, 1 / 4800, 80.0)
    fit, = fit_clothoids([painted(truth)])
    assert fit.curve.bend == pytest.approx(truth.bend, abs=2e-4)
    assert fit.curve.change == pytest.approx(truth.change, rel=0.03)
    assert np.abs(truth.project(*fit.curve.sample(1.0).T)[1]).max() < 0.01


def test_an_ellipse_is_recovered_whichever_way_it_is_walked():
    truth = EVERY_CURVE[4]
    x, y = painted(truth)
    for fit, turn in ((fit_ellipse(x, y), 1), (fit_ellipse(x[::-1], y[::-1]), -1)):
        assert sorted((fit.curve.a, fit.curve.b)) == pytest.approx([50, 80], rel=0.01)
        assert np.sign(fit.curve.curvature(np.array([30.0]))) == turn


def test_an_ellipse_of_a_short_arc_is_refused():
    with pytest.raises(RoadExtractionError, match="60 degrees"):
        fit_ellipse(*painted(Arc(0.0, 0.0, 0.0, 1 / 80, 60.0), noise=0.0))


@pytest.mark.parametrize("truth, kind", [
    (EVERY_CURVE[0], "line"), (EVERY_CURVE[1], "circle"), (EVERY_CURVE[3], "clothoid"), (EVERY_CURVE[4], "ellipse")])
def test_automatic_names_the_curve_that_was_painted(truth, kind):
    assert fit_curve(*painted(truth)).curve.kind == kind


def test_a_winding_road_becomes_a_spline_that_lies_on_the_paint():
    x, y = along([(0, 0, 60), (1 / 60, 1 / 60, 50), (-1 / 90, -1 / 90, 50), (0, 0, 40)])
    fit = fit_curve(x, y)
    assert fit.curve.kind == "b-spline"
    exact = along([(0, 0, 60), (1 / 60, 1 / 60, 50), (-1 / 90, -1 / 90, 50), (0, 0, 40)], noise=0)
    assert np.sqrt(np.mean(fit.curve.project(*exact)[1] ** 2)) < 0.006


@pytest.mark.parametrize("radius, off", [(9.0, 0.02), (6.0, 0.03)])
def test_the_line_of_a_hairpin_stays_on_its_paint_where_the_bend_begins_and_ends(radius, off):
    course = [(0, 0, 45), (1 / radius, 1 / radius, np.pi * radius), (0, 0, 45)]
    fit = fit_curve(*along(course))
    assert np.abs(fit.curve.project(*along(course, noise=0))[1]).max() < off


def test_a_spline_crosses_the_gaps_of_a_dashed_bend():
    """6 m dashes, 9 m gaps, R = 60 m: between the dashes the line stays on the arc."""
    truth = Arc(0.0, 0.0, 0.0, 1 / 60, 120.0)
    x, y = painted(truth)
    painted_there = np.arange(len(x)) * 0.25 % 15 < 6
    fit, = fit_splines([(x[painted_there], y[painted_there])])
    assert np.abs(truth.project(*fit.curve.sample(0.5).T)[1]).max() < 0.02


def test_an_alignment_is_cut_into_its_elements():
    elements, = element_ranges([along([(0, 0, 60), (0, 1 / 80, 40), (1 / 80, 1 / 80, 60), (1 / 80, 0, 40), (0, 0, 40)])])
    assert [kind for *_, kind in elements] == ["line", "clothoid", "circle", "clothoid", "line"]
    assert [first for first, *_ in elements] == pytest.approx([0, 60, 100, 160, 200], abs=10)
    assert [a[1] == b[0] for a, b in zip(elements, elements[1:])] == [True] * 4


def test_one_bend_is_one_element():
    (_, _, kind), = element_ranges([along([(1 / 60, 1 / 60, 150)])])[0]
    assert kind == "circle"


@pytest.mark.parametrize("curve", EVERY_CURVE, ids=lambda c: f"{c.kind}{c.length:.0f}")
def test_arc_length_heading_and_curvature_belong_together(curve):
    u = np.linspace(0, curve.length, 4001)
    places = curve.at(u)
    steps = np.diff(places, axis=0)
    assert np.hypot(*steps.T) == pytest.approx(curve.length / 4000, rel=1e-4)
    middle = curve.heading((u[1:] + u[:-1]) / 2)
    assert np.abs(np.angle(np.exp(1j * (np.arctan2(steps[:, 1], steps[:, 0]) - middle)))).max() < 1e-4
    assert np.gradient(curve.heading(u), u)[5:-5] == pytest.approx(curve.curvature(u)[5:-5], abs=1e-5)


@pytest.mark.parametrize("curve", EVERY_CURVE, ids=lambda c: f"{c.kind}{c.length:.0f}")
def test_a_curve_survives_shifting_and_an_arc_walking_back(curve):
    again = curve.moved(1000.0, -2000.0)
    u = np.linspace(0, curve.length, 50)
    np.testing.assert_allclose(again.at(u), curve.at(u) + [1000.0, -2000.0], atol=1e-8)
    if isinstance(curve, Arc):
        back = curve.reversed()
        np.testing.assert_allclose(back.at(u), curve.at(curve.length - u), atol=1e-6)
        np.testing.assert_allclose(back.curvature(u), -curve.curvature(curve.length - u), atol=1e-6)


def test_the_foot_of_a_point_gives_back_where_it_was_put():
    for curve in EVERY_CURVE:
        u = np.linspace(2, curve.length - 2, 40)
        heading = curve.heading(u)
        x, y = (curve.at(u) + 3.0 * np.c_[-np.sin(heading), np.cos(heading)]).T
        found_u, found_e = curve.project(x, y)
        np.testing.assert_allclose(found_u, u, atol=1e-5)
        np.testing.assert_allclose(found_e, 3.0, atol=1e-6)


@pytest.mark.parametrize("kind", ["line", "circle", "clothoid", "b-spline"])
def test_where_on_earth_the_line_lies_changes_nothing(kind):
    x, y = painted(EVERY_CURVE[3])
    here, there = fit_curve(x, y, kind), fit_curve(x + 400000.0, y + 500000.0, kind)
    np.testing.assert_allclose(there.curve.moved(-400000.0, -500000.0).sample(2.0), here.curve.sample(2.0), atol=1e-4)


@pytest.mark.parametrize("kind", ["line", "circle", "clothoid", "polynomial", "b-spline"])
def test_a_line_traced_backwards_is_the_same_line(kind):
    x, y = painted(EVERY_CURVE[2])
    there, back = fit_curve(x, y, kind), fit_curve(x[::-1], y[::-1], kind)
    np.testing.assert_allclose(back.curve.sample(2.0)[::-1], there.curve.sample(2.0), atol=2e-3)


def test_an_unknown_curve_and_too_few_places_are_named():
    x, y = painted(EVERY_CURVE[0])
    with pytest.raises(RoadExtractionError, match="sinusoid"):
        fit_curve(x, y, "sinusoid")
    with pytest.raises(RoadExtractionError, match="at least 5 places"):
        fit_curve(x[:3], y[:3], "clothoid")
    assert fit_curve(x[:2], y[:2]).curve.kind == "line"


def test_the_residual_is_positive_left_of_the_line():
    fit, = fit_lines([(np.array([0.0, 10.0, 20.0, 30.0, 40.0]), np.array([0.0, 0.0, 0.02, 0.0, 0.0]))])
    assert fit.residuals[2] > 0.01
