"""Curbs where a profile across the road holds a few points or none (simulated)."""

import curbed_streets as streets
import numpy as np
import pytest
from curbed_streets import measured, street, survey_of
from road_layers import detect_curbs

PER_AREA = 12.0   # points per square metre


def thin(points, seed=1):
    """A few points of each square metre of a street."""
    x = points[0]
    area = np.ptp(x) * np.ptp(points[1])
    kept = np.random.default_rng(seed).random(len(x)) < PER_AREA * area / len(x)
    return tuple(column[kept] for column in points)


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
