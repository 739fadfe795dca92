"""What is looked at of crowded points."""

import numpy as np
import pytest
from curbed_streets import driven, survey_of
from lanewright.core.road.common.decimation import PointDecimation
from lanewright.core.road.weights import CURBS
from lanewright.core.survey.store.records import COORDINATE_SCALE

WIDTH, SPACING = 0.25, 0.025
CURB, HEIGHT = 1.004, 0.12


def crowded(noise=0.003, seed=5):
    """(x, y, z, time) of 4 m of road and sidewalk with some 60 points in every cell, and the upright face between them."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(10.0, 14.0, 80_000), rng.uniform(-0.5, 1.6, 80_000)
    z = np.where(y > CURB, HEIGHT, 0.0)
    up = rng.uniform(0.0, HEIGHT, 300)
    x, y, z = np.r_[x, rng.uniform(10.0, 14.0, len(up))], np.r_[y, np.full(len(up), CURB)], np.r_[z, up]
    return x, y, z + rng.normal(0.0, noise, len(z)), 1000.0 + x / 10


def taken(survey, profiles=(36, 60), **options):
    """(N, 3) station, offset and height of the points taken, in units."""
    parts = [PointDecimation(survey, WIDTH, SPACING).decimated_points(0, profiles, **options)]
    return np.concatenate([np.c_[part.records["s"], part.records["d"], part.records["z"]] for runs in parts for part in runs])


def in_cells(points):
    """How many points lie in every occupied cell of level ground, well inside the scan and away from the face."""
    s, d = points[:, 0] * COORDINATE_SCALE, points[:, 1]
    own = (s > 10.5) & (s < 13.5) & (np.abs(d * COORDINATE_SCALE - CURB) > 0.05) & (np.abs(d * COORDINATE_SCALE) < 1.4)
    return np.unique(np.c_[np.floor(s[own] / WIDTH), d[own] // 256], axis=0, return_counts=True)[1]


def test_of_level_ground_a_few_points_of_every_cell_are_taken():
    survey = survey_of(crowded(), driven(20.0))
    assert np.median(in_cells(taken(survey, points_per_cell=None))) > 4 * CURBS.points_per_level_cell
    assert abs(np.mean(in_cells(taken(survey))) - CURBS.points_per_level_cell) < 0.1 * CURBS.points_per_level_cell
    assert in_cells(taken(survey)).min() > 0


def test_a_curbs_face_keeps_its_points():
    survey = survey_of(crowded(), driven(20.0))
    faces = []
    for points in (taken(survey, points_per_cell=None), taken(survey)):
        d, h = points[:, 1] * COORDINATE_SCALE, (points[:, 2] - points[:, 2].min()) * COORDINATE_SCALE
        faces.append(np.count_nonzero((np.abs(d - CURB) < 0.01) & (h > 0.04) & (h < 0.10)))
    assert faces[0] > 100
    assert faces[1] > 0.7 * faces[0]


def test_what_a_noisy_scanner_saw_is_taken_as_far_as_it_tells():
    survey = survey_of(crowded(noise=2.5 * CURBS.level_cell_std), driven(20.0))
    assert np.mean(in_cells(taken(survey))) > 0.9 * np.mean(np.minimum(in_cells(taken(survey, points_per_cell=None)), 60))


@pytest.mark.parametrize("profiles", [(41, 50), (40, 60), (44, 45)])
def test_what_is_taken_does_not_depend_on_where_reading_begins_or_on_sections(profiles):
    points = crowded()
    whole = taken(survey_of(points, driven(20.0)))
    there = np.floor(whole[:, 0] * COORDINATE_SCALE / WIDTH)
    wanted = whole[(there >= profiles[0]) & (there < profiles[1])]
    for length in (20.0, 1.7):
        np.testing.assert_array_equal(taken(survey_of(points, driven(20.0), section_length=length), profiles), wanted)


def test_points_in_another_order_are_the_same_points():
    points = crowded()
    np.testing.assert_array_equal(taken(survey_of(points, driven(20.0))), taken(survey_of(points, driven(20.0), shuffled=2)))


def test_a_second_pass_takes_nothing_from_the_first():
    points, again = crowded(), crowded(seed=6)
    later = again[0], again[1], again[2], again[3] + 100
    alone = survey_of(points, driven(20.0))
    both = survey_of(points, driven(20.0), second=(later, driven(20.0, start=1100.0)))
    assert abs(len(taken(both)) / (2 * len(taken(alone))) - 1) < 0.05


@pytest.mark.parametrize("noise, uneven", [(0.003, False), (0.02, True)])
def test_only_to_a_noisy_scanner_level_ground_looks_uneven(noise, uneven):
    assert PointDecimation(survey_of(crowded(noise), driven(20.0)), WIDTH, SPACING).mostly_uneven(0, 48) == uneven


def test_where_nothing_was_scanned_nothing_is_uneven():
    assert not PointDecimation(survey_of(crowded(), driven(20.0)), WIDTH, SPACING).mostly_uneven(0, 400)
