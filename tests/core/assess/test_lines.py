"""Lines beside a reference of known distance."""

import numpy as np
import pytest
from shapely.geometry import LineString, box

from lanewright.core.assess.lines import compare_lines
from lanewright.core.assess.polygons import compare_polygons

REFERENCE = LineString([(0, 0, 10), (100, 0, 10)])


def test_a_line_7_cm_beside_is_right_at_10_cm_and_wrong_at_5():
    accuracy = compare_lines([LineString([(0, 0.07, 10.02), (100, 0.07, 10.02)])], [REFERENCE])
    assert accuracy.completeness[0.10] == 1.0 and accuracy.correctness[0.10] == 1.0
    assert accuracy.completeness[0.05] == 0.0 and accuracy.correctness[0.05] == 0.0
    assert accuracy.rmse == pytest.approx(0.07, abs=1e-9)
    assert accuracy.height_rmse == pytest.approx(0.02, abs=1e-9)


def test_half_a_line_is_half_complete_and_wholly_correct():
    accuracy = compare_lines([LineString([(0, 0, 10), (50, 0, 10)])], [REFERENCE])
    assert accuracy.completeness[0.10] == pytest.approx(0.5, abs=0.01)
    assert accuracy.correctness[0.10] == 1.0


def test_a_line_in_the_next_street_is_miscoded_and_does_not_spoil_the_rmse():
    elsewhere = LineString([(0, 30, 10), (100, 30, 10)])
    accuracy = compare_lines([REFERENCE, elsewhere], [REFERENCE])
    assert accuracy.correctness[0.20] == pytest.approx(0.5, abs=0.01)
    assert accuracy.rmse == 0.0


def test_no_result_is_not_complete():
    accuracy = compare_lines([], [REFERENCE])
    assert accuracy.completeness[0.20] == 0.0 and np.isnan(accuracy.correctness[0.20])


def test_only_what_lies_in_the_area_counts():
    beyond = LineString([(0, 0, 10), (150, 0, 10)])
    assert compare_lines([beyond], [REFERENCE], area=box(0, -5, 100, 5)).correctness[0.05] == 1.0


def test_a_strip_one_cell_too_wide_is_right_within_one_cell():
    strip, wider = box(0, 0, 10, 0.15), box(0, -0.04, 10, 0.19)
    accuracy = compare_polygons([wider], [strip], tolerance=0.041)
    assert accuracy.f1 == pytest.approx(1.0, abs=0.01)
    assert compare_polygons([wider], [strip], tolerance=0.0).precision == pytest.approx(0.15 / 0.23, abs=1e-6)
