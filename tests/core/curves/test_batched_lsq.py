"""Many curves fitted at once: each as if it were alone."""

from contextlib import closing

import numpy as np
import pytest
from lanewright.core.curves.base import Arc
from lanewright.core.curves.bspline import fit_splines, smooth_profiles
from lanewright.core.curves.clothoid import Clothoid
from lanewright.core.curves.model_selection import fit_curves
from lanewright.core.curves.robust import percentiles
from lanewright.core.curves.segmentation import element_ranges
from lanewright.core.curves.simple_curves import fit_circles
from lanewright.core.driving.alignment import curves_of_lanes
from lanewright.core.execution.phase import NoSource, Phase
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.execution.tasks import find_interpreter


def painted(curve, step=0.25, seed=1):
    u = np.arange(0.0, curve.length, step)
    e = np.random.default_rng(seed).normal(0, 0.01, len(u))
    return (curve.at(u) + e[:, None] * np.c_[-np.sin(curve.heading(u)), np.cos(curve.heading(u))]).T


def winding(length=220.0):
    u = np.arange(0.0, length, 0.25)
    return u, 6.0 * np.sin(u / 25.0) + np.random.default_rng(5).normal(0, 0.01, len(u))


STREET = [painted(Arc(0.0, 0.0, 0.3, 0.0, 60.0)), painted(Arc(5.0, 2.0, 0.3, 1 / 140, 25.0)), winding(),
          painted(Clothoid(0.0, 0.0, 0.0, 0.0, 1 / 4000, 80.0)), painted(Arc(0.0, 0.0, 0.0, 0.0, 3.0)),
          painted(Arc(100.0, -20.0, 2.0, -1 / 60, 120.0))]
LONG = [Clothoid(0.0, 0.0, 0.0, 0.0, 2e-7, 1500.0), Arc(0.0, 0.0, 0.0, 1 / 900, 1500.0)]


def test_lines_fitted_together_have_the_curves_they_have_alone():
    together = fit_curves(STREET)
    assert [fit.curve.kind for fit in together] == ["line", "circle", "b-spline", "clothoid", "line", "circle"]
    for fit, line in zip(together, STREET):
        alone, = fit_curves([line])
        assert alone.curve.params() == fit.curve.params() and fit.residuals.tobytes() == alone.residuals.tobytes()


def test_splines_and_profiles_do_not_depend_on_what_is_fitted_beside_them():
    for fit, line in zip(fit_splines(STREET), STREET):
        assert fit.residuals.tobytes() == fit_splines([line])[0].residuals.tobytes()
    profiles = [(line[0] - line[0][0], line[1]) for line in STREET if (np.diff(line[0]) > 0).all()]
    for profile, smooth in zip(profiles, smooth_profiles(profiles, 3.0)):
        assert smooth(profile[0]).tobytes() == smooth_profiles([profile], 3.0)[0](profile[0]).tobytes()


def test_a_curve_is_the_same_to_the_last_digit_whoever_fits_it():
    """A worker process has one thread for sums over many places, this process one for each core."""
    ellipse = (np.stack([90.0 * np.cos(t), 40.0 * np.sin(t)]) for t in [np.linspace(0.0, 3.0, 900)])
    lines = [(*line, kind) for line in [*map(painted, LONG), *ellipse] for kind in ("whole", "element")]
    with closing(WorkerProcesses(find_interpreter(), 1)) as worker:
        phase = Phase(curves_of_lanes, NoSource(), listed=1)
        for fit, here in zip(worker.run_together(phase, lines), curves_of_lanes(NoSource(), lines)):
            assert fit.curve.params() == here.curve.params() and fit.residuals.tobytes() == here.residuals.tobytes()


def test_what_is_left_unrefined_is_hopeless_all_the_same():
    refined, left = (fit_circles([winding()], max_misfit)[0] for max_misfit in (np.inf, 0.5))
    assert refined.residual_p95 > 0.5 and left.residual_p95 > 0.5 and len(left.residuals) == len(refined.residuals)


def test_a_circle_worth_refining_is_refined():
    refined, anyway = (fit_circles([STREET[5]], max_misfit)[0] for max_misfit in (np.inf, 0.5))
    np.testing.assert_allclose(refined.residuals, anyway.residuals, atol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 3, 20, 41])
def test_percentiles_are_numpy_s(count):
    values = np.random.default_rng(count).normal(size=count)
    np.testing.assert_array_equal(percentiles(values, (2.5, 50.0, 97.5)), np.percentile(values, [2.5, 50.0, 97.5]))


def test_a_road_ten_times_as_long_is_divided_where_its_tenth_is():
    rng = np.random.default_rng(4)
    curvature = np.tile(np.repeat([0.0, 1 / 120, 0.0, -1 / 80], 60), 10)
    heading = np.cumsum(curvature)
    x, y = np.cumsum(np.cos(heading)) + rng.normal(0, 0.01, 2400), np.cumsum(np.sin(heading)) + rng.normal(0, 0.01, 2400)
    long, short = element_ranges([(x, y), (x[:480], y[:480])])
    assert len(long) >= 36
    for (first, last, kind), (a, b, other_kind) in zip(long[:6], short[:6]):
        assert kind == other_kind and first == pytest.approx(a, abs=5.0) and last == pytest.approx(b, abs=5.0)
    # the order in which a processor's library sums depends on how many lines are solved together
    alone, = element_ranges([(x[:480], y[:480])])
    np.testing.assert_allclose([element[:2] for element in alone], [element[:2] for element in short], rtol=0, atol=1e-9)
