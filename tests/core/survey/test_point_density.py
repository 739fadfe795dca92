"""Points per cubic metre."""

import numpy as np
import pytest
from lanewright.core.survey.density import counted_cubes, cube_density
from lanewright.core.survey.store.records import SURVEY_POINT, Points, to_units


def cloud(x, y, z):
    records = np.zeros(len(x), SURVEY_POINT)
    for name, axis in zip("xyz", (x, y, z)):
        records[name] = to_units(axis)
    return counted_cubes(Points(records))


def test_a_cube_of_three_points_and_one_of_one():
    found = cube_density([cloud([0.1, 0.9, 0.5, 5.5], [0.1, 0.2, 0.3, -3.5], [0.5, 0.5, 0.5, 0.5])])
    assert found.points == 4 and found.mean == 2.0 and found.of_a_point == pytest.approx((9 + 1) / 4)


def test_how_the_road_is_cut_into_sections_does_not_matter():
    x, y, z = np.random.default_rng(1).uniform(-20, 20, (3, 5000))
    whole = cube_density([cloud(x, y, z)])
    parts = cube_density([cloud(x[k::7], y[k::7], z[k::7]) for k in range(7)])
    assert whole == parts and whole.points == 5000


def test_no_points_have_no_density():
    assert np.isnan(cube_density([]).mean) and cube_density([cloud([], [], [])]).points == 0
