"""Charts and maps of the assessment reports."""

import re

import numpy as np
import pytest
from lanewright.products.assess.layers import boundary_layer
from lanewright.products.assess.lines import assess_boundaries
from lanewright.products.report.assessment import bins_of, boundary_report
from lanewright.products.report.page import Chart, ticks
from shapely.geometry import LineString


def test_ticks_are_round_numbers_within_the_range():
    assert list(ticks(0.0, 10.0, 5)) == [0, 2, 4, 6, 8, 10]
    assert list(np.round(ticks(-0.013, 0.012, 5), 6)) == [-0.01, -0.005, 0.0, 0.005, 0.01]


def test_a_bar_is_as_high_as_its_value():
    chart = Chart((0, 10), (0, 4), "m", "cm")
    chart.bars([0, 5], [5, 10], [1.0, 2.0], "#123456")
    heights = [float(h) for h in re.findall(r'height="([\d.]+)" fill="#123456"', chart.svg())]
    assert heights[1] == pytest.approx(2 * heights[0], abs=0.11)


def test_bars_are_stacked_and_empty_ones_left_out():
    chart = Chart((0, 10), (0, 4), "m", "cm")
    top = chart.bars([0, 5], [5, 10], np.array([1.0, 0.0]), "#123456")
    assert list(chart.bars([0, 5], [5, 10], np.array([1.0, 2.0]), "#654321", top)) == [2.0, 2.0]
    assert chart.svg().count("#123456") == 1 and chart.svg().count("#654321") == 2


def test_a_curve_stops_where_nothing_is_known():
    chart = Chart((0, 4), (0, 1), "m", "")
    chart.curve(np.arange(5.0), np.array([0.1, 0.2, np.nan, 0.3, 0.4]), "#123456")
    assert chart.svg().count("<polyline") == 2


def test_a_curve_that_begins_before_the_axis_is_not_drawn_over_its_numbers():
    chart = Chart((10, 20), (0, 1), "m", "")
    chart.curve(np.array([0.0, 15.0]), np.array([0.5, 0.5]), "#123456")
    picture = chart.svg()
    left, width = (float(v) for v in re.search(r'<clipPath id="plot220"><rect x="(\d+)" y="0" width="(\d+)"', picture).groups())
    grid = [float(x) for x in re.findall(r'<line x1="([\d.]+)" x2="\1"', picture)]
    assert (left, left + width) == (min(grid), max(grid))
    assert 'clip-path="url(#plot220)"' in re.search(r'<polyline[^>]*stroke="#123456"[^>]*>', picture).group()


def test_names_in_a_chart_cannot_become_markup():
    assert "<b>" not in Chart((0, 1), (0, 1), "<b>", "<b>").svg()


def test_a_long_road_has_broader_bars_rather_than_more():
    short, _ = bins_of(np.array([3.0, 95.0]))
    long, number = bins_of(np.linspace(0, 20000, 500))
    assert short[1] - short[0] == 10 and len(long) <= 183 and (long[1] - long[0]) % 10 == 0
    assert number.min() == 0 and number.max() == len(long) - 2


def test_a_report_without_any_result_is_still_a_report():
    curb = LineString([(0, 0, 1), (20, 0, 1)])
    accuracy = assess_boundaries([], [curb])
    page = boundary_report(accuracy, boundary_layer(accuracy, ""), ("Mine", "Truth"))
    assert "Mine against Truth" in page and "missed" in page and "data:image/png" in page
