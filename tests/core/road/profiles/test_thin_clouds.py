"""Curbs where a profile across the road holds a few points or none (simulated)."""

import curbed_streets as streets
import numpy as np
import pytest
from curbed_streets import measured, street, survey_of
from road_layers import detect_curbs

PER_AREA = 12.0   # points per square metre


def thin(points, seed=1, whole=0.0, per_area=PER_AREA):
    """A few points of each square metre of a street, and all of those within `whole` metres of the driven line."""
    x, y = points[:2]
    area = np.ptp(x) * np.ptp(y)
    kept = (np.abs(y) < whole) | (np.random.default_rng(seed).random(len(x)) < per_area * area / len(x))
    return tuple(column[kept] for column in points)


def rough_verge(points, seed=2):
    """Ground that scatters by two centimetres beyond the edges of a road."""
    x, y, z, time = points
    return x, y, z + np.where(np.abs(y) > 3.5, np.random.default_rng(seed).normal(0.0, 0.02, len(z)), 0.0), time


def test_a_dozen_points_per_square_metre_show_both_curbs_to_their_ends():
    curbs = detect_curbs(survey_of(thin(street(curb=0.10))))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        assert points[:, 3].min() < 2.0 and points[:, 3].max() > streets.LENGTH - 2.0
        assert len(np.unique(np.floor(points[:, 3] / 2))) >= 0.8 * streets.LENGTH / 2
        np.testing.assert_allclose(np.median(points[:, 1]), offset, atol=0.02)
        np.testing.assert_allclose(points[:, 1], offset, atol=0.10)


def test_where_the_curb_is_open_a_thin_cloud_shows_none():
    points = measured(detect_curbs(survey_of(thin(street(open_left=[(25.0, 35.0)])))), "left")
    assert len(points) and not ((points[:, 0] > 25.5) & (points[:, 0] < 34.5)).any()


@pytest.mark.parametrize("ground", [dict(curb=0.12, face=0.5), dict(curb=0.01), dict(curb=0.0)], ids=["ramp", "seam", "level"])
def test_where_there_is_no_curb_a_thin_cloud_shows_none(ground):
    assert len(detect_curbs(survey_of(thin(street(**ground))))) == 0


def test_a_curb_in_few_points_is_found_where_the_cloud_is_dense_beside_the_track():
    curbs = detect_curbs(survey_of(thin(street(curb=0.10, lines=0.04), whole=2.0, per_area=25.0)))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        assert len(np.unique(np.floor(points[:, 3] / 2))) >= 0.9 * streets.LENGTH / 2
        np.testing.assert_allclose(points[:, 1], offset, atol=0.05)


@pytest.mark.parametrize("per_area", [12.0, 50.0])
def test_a_rough_verge_in_few_points_is_no_curb(per_area):
    assert len(detect_curbs(survey_of(thin(rough_verge(street(curb=0.03, face=0.3, lines=0.04)), whole=2.0, per_area=per_area)))) == 0


def test_curbs_in_few_points_are_found_just_behind_a_dense_stretch():
    points = street(curb=0.10, lines=0.02)
    x, y = points[:2]
    kept = np.random.default_rng(5).random(len(x)) < np.where(x < 24.0, 1000.0, PER_AREA) * np.ptp(x) * np.ptp(y) / len(x)
    curbs = detect_curbs(survey_of(tuple(column[kept] for column in points)))
    for side in ("left", "right"):
        station = measured(curbs, side)[:, 0]
        assert len(np.unique(np.floor(station[(station > 32.0) & (station < 40.0)] / 2))) == 4, side
