"""The report of a road map: curvature of driving lines cut into pieces by status, and what pieces sum to."""

import numpy as np
import pytest
from lanewright.products.report.road_map import _joined, _totals, curvature_along
from shapely.geometry import LineString


def pieces(direction):
    """A line of 30 m in three pieces along a road, driven along or against it; rows in order of station."""
    found = []
    for first, last in ((0.0, 12.0), (12.0, 15.0), (20.0, 30.0)):
        ends = [(first, 0.0), (last, 0.0)]
        found.append((LineString(ends[::direction]), dict(direction=direction, station_m=100 + first, end_m=100 + last)))
    return found


@pytest.mark.parametrize("direction", [1, -1])
def test_pieces_that_touch_are_one_curve_and_a_gap_stays(direction):
    joined = _joined(pieces(direction))
    assert sorted(round(line.length, 6) for line, _ in joined) == [10.0, 15.0]
    for line, station in joined:
        np.testing.assert_allclose(np.asarray(line.coords)[:, 0], station - 100)


def test_a_road_whose_surface_changes_status_ten_times_has_one_row_a_status():
    assert _totals([70.0] * 10, ["measured", "grown"] * 5) == [("grown", 350.0), ("measured", 350.0)]


@pytest.mark.parametrize("turn", [1, -1])
def test_an_arc_has_the_curvature_of_its_radius_positive_to_the_left(turn):
    angle = np.linspace(0, 0.6, 400)
    arc = LineString(np.c_[100 * np.sin(angle), turn * 100 * (1 - np.cos(angle))])
    station, bend = curvature_along(arc)
    np.testing.assert_allclose(bend, turn / 100, rtol=2e-3)
    assert station[0] == pytest.approx(5.0) and station[-1] <= arc.length - 5 + 1e-6


def test_a_line_shorter_than_its_two_chords_has_no_curvature():
    assert len(curvature_along(LineString([(0, 0), (9, 0)]))[0]) == 0
