"""Lines beside a reference of known distance."""

import numpy as np
import pytest
from lanewright.products.assess.lines import compare_lines, match_lines
from shapely import reverse
from shapely.geometry import LineString, MultiLineString, box

REFERENCE = LineString([(0, 0, 10), (100, 0, 10)])


def test_a_line_7_cm_beside_is_right_at_10_cm_and_wrong_at_5():
    accuracy = compare_lines([LineString([(0, 0.07, 10.02), (100, 0.07, 10.02)])], [REFERENCE])
    assert accuracy.completeness[0.10] == 1.0 and accuracy.correctness[0.10] == 1.0
    assert accuracy.completeness[0.05] == 0.0 and accuracy.correctness[0.05] == 0.0
    assert accuracy.lateral.rmse == pytest.approx(0.07, abs=1e-9)
    assert accuracy.height.rmse == pytest.approx(0.02, abs=1e-9)


def test_half_a_line_is_half_complete_and_wholly_correct():
    accuracy = compare_lines([LineString([(0, 0, 10), (50, 0, 10)])], [REFERENCE])
    assert accuracy.completeness[0.10] == pytest.approx(0.5, abs=0.01)
    assert accuracy.correctness[0.10] == 1.0


def test_a_line_in_the_next_street_is_miscoded_and_does_not_spoil_the_rmse():
    elsewhere = LineString([(0, 30, 10), (100, 30, 10)])
    accuracy = compare_lines([REFERENCE, elsewhere], [REFERENCE])
    assert accuracy.correctness[0.20] == pytest.approx(0.5, abs=0.01)
    assert accuracy.lateral.rmse == pytest.approx(0.0, abs=1e-9)


def test_no_result_is_not_complete():
    accuracy = compare_lines([], [REFERENCE])
    assert accuracy.completeness[0.20] == 0.0 and np.isnan(accuracy.correctness[0.20])


def test_only_what_lies_in_the_area_counts():
    beyond = LineString([(0, 0, 10), (150, 0, 10)])
    assert compare_lines([beyond], [REFERENCE], area=box(0, -5, 100, 5)).correctness[0.05] == 1.0


def test_two_lines_that_cross_match_only_where_any_direction_will_do():
    across = LineString([(50, -50, 10), (50, 50, 10)])
    assert compare_lines([across], [REFERENCE], max_angle=15).correctness[0.20] == 0.0
    assert compare_lines([across], [REFERENCE]).correctness[0.20] == pytest.approx(0.004, abs=1e-3)


def test_a_line_drawn_the_other_way_matches():
    accuracy = compare_lines([reverse(REFERENCE)], [REFERENCE], max_angle=15)
    assert accuracy.correctness[0.05] == 1.0 and accuracy.completeness[0.05] == 1.0


def test_miscoding_is_the_share_of_the_result_outside_the_buffer_of_the_reference():
    astray = LineString([(0, 0, 10), (75, 0, 10), (75, 0.3, 10), (100, 0.3, 10)])
    accuracy = compare_lines([astray], [REFERENCE])
    assert accuracy.miscoding[0.10] == pytest.approx(0.25, abs=0.01)
    assert accuracy.miscoding[0.10] == pytest.approx(1 - accuracy.correctness[0.10])
    assert accuracy.quality[0.10] == pytest.approx(0.75 / 1.25, abs=0.02)


def test_two_gaps_in_a_hundred_metres_are_twenty_a_kilometre():
    parts = MultiLineString([[(0, 0), (20, 0)], [(24, 0), (60, 0)], [(66, 0), (100, 0)]])
    accuracy = compare_lines([parts], [REFERENCE])
    assert accuracy.gaps_per_km[0.10] == pytest.approx(20.0)
    assert accuracy.mean_gap[0.10] == pytest.approx(5.0, abs=0.2)


def test_the_pieces_together_are_the_lines():
    astray = LineString([(0, 0, 10), (50, 0, 10), (51, 0.5, 10), (100, 0.5, 10)])
    pieces = list(match_lines([astray], [REFERENCE]).pieces(0.10))
    length = {outcome: sum(g.length for o, _, g, _, _ in pieces if o == outcome) for outcome in ("correct", "false", "missed")}
    assert length["correct"] + length["false"] == pytest.approx(astray.length)
    assert length["false"] == pytest.approx(49.8, abs=0.5) and length["missed"] == pytest.approx(49.8, abs=0.5)


def test_each_reference_line_has_its_own_figures():
    second = LineString([(0, 3, 10), (100, 3, 10)])
    one, other = match_lines([LineString([(0, 0.02, 10), (100, 0.02, 10)])], [REFERENCE, second]).per_reference_line((0.05,))
    assert one.completeness[0.05] == 1.0 and one.correctness[0.05] == 1.0
    assert other.completeness[0.05] == 0.0 and np.isnan(other.correctness[0.05])


def test_the_outline_of_a_polygon_is_a_line_too():
    assert compare_lines([box(0, 0, 10, 10)], [box(0, 0, 10, 10).exterior]).correctness[0.05] == 1.0
