"""Station and offset of any place on a road, and the way back."""

import numpy as np
import pytest
from drives import ahead, bend, chain, drive
from lanewright.core.survey.frame.road_frame import build_frame


def curved_road(radius=60.0, turn=120.0):
    return build_frame(drive(chain(ahead(80), bend(radius, turn), ahead(80)))).roads[0]


@pytest.mark.parametrize("turn", [-120.0, 0.001, 120.0])
def test_there_and_back_again_ends_within_a_tenth_of_a_millimetre(turn):
    road = curved_road(turn=turn)
    s, d = (a.ravel() for a in np.meshgrid(np.arange(-5.0, road.length + 5, 1.7), np.arange(-20.0, 20.1, 2.5)))
    found_s, found_d = road.locate(*road.to_map(s, d))
    np.testing.assert_allclose(found_s, s, atol=1e-4)
    np.testing.assert_allclose(found_d, d, atol=1e-4)


def test_left_of_travel_is_positive():
    road = build_frame(drive(chain(ahead(100)))).roads[0]
    s, d = road.locate(np.array([50.0, 50.0]), np.array([3.0, -3.0]))
    np.testing.assert_allclose(d, [3.0, -3.0], atol=1e-6)
    np.testing.assert_allclose(s, 50.0, atol=0.01)


def test_station_counts_metres_along_the_bend():
    road = curved_road(radius=60.0, turn=120.0)
    x, y = road.to_map(np.arange(0.0, road.length, 0.5), 0.0)
    np.testing.assert_allclose(np.hypot(np.diff(x), np.diff(y)), 0.5, atol=2e-4)


def test_the_bend_has_the_curvature_of_its_radius():
    road = curved_road(radius=60.0)
    np.testing.assert_allclose(road.curvature(np.arange(95.0, 190.0)), 1 / 60, rtol=0.01)
    np.testing.assert_allclose(road.curvature(np.arange(5.0, 70.0)), 0.0, atol=1e-4)


def test_places_beyond_the_centre_of_a_sharp_bend_have_no_station():
    road = curved_road(radius=15.0, turn=180.0)
    s, d = road.to_map(np.array([100.0]), np.array([14.5])), None
    found, d = road.locate(*s)
    assert np.isnan(found).all() and np.isnan(d).all()


def test_places_outside_the_corridor_have_no_station():
    road = curved_road()
    s, _ = road.locate(*road.to_map(np.array([40.0, 40.0]), np.array([-24.0, -26.0])))
    assert np.isfinite(s[0]) and np.isnan(s[1])


def test_no_places_have_no_stations():
    s, d = curved_road().locate(np.empty(0), np.empty(0))
    assert s.size == d.size == 0


def test_the_frame_reaches_ten_metres_beyond_the_drive():
    road = build_frame(drive(chain(ahead(100)))).roads[0]
    s, _ = road.locate(np.array([-9.5, -10.5, 109.0, 111.0]), np.zeros(4))
    np.testing.assert_array_equal(np.isfinite(s), [True, False, True, False])


def test_the_foot_found_by_time_and_the_nearest_foot_agree_on_an_open_road():
    road = curved_road()
    s, d = (a.ravel() for a in np.meshgrid(np.arange(0.0, road.length, 2.1), np.arange(-10.0, 10.1, 2.5)))
    x, y = road.to_map(s, d)
    np.testing.assert_allclose(road.locate(x, y, s + 4.0), road.locate(x, y), atol=1e-4)
