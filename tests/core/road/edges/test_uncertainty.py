"""How uncertain an edge is said to be grows with what makes it so."""

import numpy as np
import pytest
from lanewright.core.road.edges.road_edges import EdgePiece, edge_sigma
from lanewright.core.road.weights import EDGE

PLACES = np.arange(0.0, 100.5, 0.5)
MIDDLE = np.arange(40.0, 60.0, 0.5)
EXACT = np.zeros(len(PLACES))


def test_a_regular_curb_seen_without_scatter_is_as_good_as_its_foot_is_found():
    many = np.full(len(PLACES), 100)
    np.testing.assert_allclose(edge_sigma(MIDDLE, PLACES, EXACT, many), EDGE.point_sigma / 10.0, rtol=0.02)
    np.testing.assert_allclose(edge_sigma(MIDDLE, PLACES, EXACT, foot=EDGE.faint_foot), EDGE.faint_foot, rtol=0.02)


def test_a_tenth_of_the_points_makes_it_three_times_as_uncertain():
    many, few = (edge_sigma(MIDDLE, PLACES, EXACT, np.full(len(PLACES), count)).mean() for count in (200, 20))
    assert few**2 == pytest.approx(10.0 * many**2, rel=0.01)
    unknown = edge_sigma(MIDDLE, PLACES, EXACT, np.full(len(PLACES), -1))
    np.testing.assert_array_equal(unknown, edge_sigma(MIDDLE, PLACES, EXACT), "unknown counts add nothing")


def test_a_line_is_off_as_far_as_its_curb_points_scatter_about_it():
    np.testing.assert_allclose(edge_sigma(MIDDLE, PLACES, np.full(len(PLACES), 0.006)), 0.006, rtol=0.02)


def test_curb_points_that_scatter_make_it_uncertain_there_and_not_fifty_metres_on():
    rough = np.where(PLACES < 30.0, 0.020, 0.0)
    assert edge_sigma(np.arange(5.0, 20.0), PLACES, rough).mean() > 0.009
    assert edge_sigma(np.arange(80.0, 90.0), PLACES, rough).mean() < 0.003


def test_the_middle_of_a_long_gap_is_worse_than_its_ends():
    gappy = PLACES[(PLACES < 40.0) | (PLACES > 60.0)]
    at = [edge_sigma(np.array([station]), gappy, np.zeros(len(gappy))) for station in (40.0, 45.0, 50.0)]
    assert at[0] < at[1] < at[2]


def test_the_end_of_an_edge_is_worse_than_its_middle():
    end, middle = (edge_sigma(np.array([at]), PLACES, EXACT, np.full(len(PLACES), 50)) for at in (0.0, 50.0))
    assert end == pytest.approx(2.0 * middle, rel=0.02), "as of a straight line through places along it"


def test_passes_that_differ_add_as_squares():
    alone = edge_sigma(MIDDLE, PLACES, EXACT)
    np.testing.assert_allclose(edge_sigma(MIDDLE, PLACES, EXACT, passes=0.04), np.hypot(alone, 0.04))


def piece(sigma):
    """An edge of a hundred metres with this sigma at every vertex."""
    vertices = np.c_[PLACES, np.zeros(len(PLACES)), np.zeros(len(PLACES))]
    return EdgePiece(vertices, 0, "left", "measured", 0, 1000.0, 1000.0 + PLACES[-1], PLACES[-1], sigma=sigma)


def test_a_few_bad_places_do_not_speak_for_the_whole_edge():
    each = edge_sigma(PLACES, PLACES, np.where(np.abs(PLACES - 50.0) < 2.0, 0.012, 0.001))
    (whole,) = piece(each).cut_by_sigma()
    assert whole.sigma == pytest.approx(np.mean(each)) and whole.sigma < np.sqrt(np.mean(np.square(each)))


def test_an_edge_is_cut_where_passes_begin_to_differ_by_centimetres_and_its_pieces_touch():
    first, second = piece(np.where(PLACES < 63.0, 0.003, 0.057)).cut_by_sigma()
    assert (first.sigma, second.sigma) == pytest.approx((0.003, 0.057), abs=0.006)
    assert first.end == second.station == pytest.approx(1063.0, abs=5.0) and second.end == 1100.0
    np.testing.assert_array_equal(first.vertices[-1], second.vertices[0])
    assert first.length + second.length == pytest.approx(100.0)


def test_an_edge_that_is_uncertain_by_millimetres_more_or_less_is_one_piece():
    (whole,) = piece(np.where(PLACES < 63.0, 0.001, 0.009)).cut_by_sigma()
    assert whole.length == 100.0


def test_a_bridge_is_as_uncertain_as_what_the_curb_may_do_in_it_and_that_grows_with_the_third_power_of_its_length():
    def middle_of(gap):
        places = np.r_[np.arange(0.0, 30.0, 0.5), np.arange(30.0 + gap, 60.0 + gap, 0.5)]
        ends = places[np.searchsorted(places, 30.0) - 1], 30.0 + gap
        return float(edge_sigma(np.array([sum(ends) / 2]), places, np.zeros(len(places)))[0])

    assert middle_of(1.0) < 0.001, "no bridge: points are joined so far"
    assert middle_of(5.5) < 0.0035 and 0.007 < middle_of(9.5) < 0.0125
    assert middle_of(19.5) / middle_of(9.5) > 7.0


def test_a_bridge_makes_what_was_measured_beside_it_no_less_sure():
    places = np.r_[np.arange(0.0, 30.0, 0.5), np.arange(45.0, 75.0, 0.5)]
    at, whole = np.array([15.0, 60.0]), np.arange(0.0, 75.0, 0.5)
    np.testing.assert_allclose(edge_sigma(at, places, np.zeros(len(places))), edge_sigma(at, whole, np.zeros(len(whole))), rtol=0.05)
