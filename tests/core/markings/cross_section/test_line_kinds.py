"""Whether a line bounds the road, parts lanes of one direction or parts the directions."""

import pytest
from clustered_streets import ClusteredStreet, told


def test_the_dashed_part_of_a_centre_line_is_centre_line_too():
    """Beyond a junction, 35 m on, the only line between the edges goes on solid."""
    street = ClusteredStreet(length=200.0).dashes(5.0, 5.0, 0.0, last=90.0).paint(125, 200, 0.0, kind="centre")
    assert set(told(street.lines(), "line", "kind", "pattern")) == {(1, "centre", "dashed"), (2, "centre", "solid")}


def test_dashes_alone_between_two_curbs_are_the_centre_line():
    assert told(ClusteredStreet().dashes(3.0, 6.0, 0.2).lines(), "kind") == [("centre",)]


def test_dashes_alone_that_leave_no_lane_beyond_are_no_centre_line():
    assert "centre" not in told(ClusteredStreet().dashes(3.0, 6.0, 3.2).lines(), "kind")[0]


@pytest.mark.parametrize("way, kind", [(1, "lane"), (-1, "centre")])
def test_dashes_between_edge_lines_part_lanes_of_one_direction_where_it_was_driven_on_both_sides(way, kind):
    street = ClusteredStreet().dashes(3.0, 6.0, 0.0).paint(0, 120, 3.5, kind="edge").paint(0, 120, -3.5, kind="edge")
    street.drive_again(1.8, way)
    assert sorted(told(street.lines(), "kind")) == sorted([("edge",), ("edge",), (kind,)])


@pytest.mark.parametrize("way, kind", [(1, "lane"), (-1, "centre")])
def test_dashes_alone_part_the_directions_unless_one_of_them_was_driven_on_both_sides(way, kind):
    street = ClusteredStreet().dashes(3.0, 6.0, 0.0)
    street.drive_again(1.8, way)
    assert told(street.lines(), "kind") == [(kind,)]


def test_two_solid_lines_with_two_lanes_between_are_edge_lines_however_wide_the_verge():
    """The verge is smooth, so that the carriageway seems to go on for metres beyond either line."""
    outer = ClusteredStreet(half_width=9.0).paint(0, 120, 2.8, kind="centre").paint(0, 120, -2.8, kind="centre")
    assert told(outer.lines(), "kind") == [("edge",)] * 2


def test_solid_lane_lines_beside_a_double_line_are_no_centre_lines():
    street = ClusteredStreet(half_width=7.0).paint(0, 120, 0.15, kind="centre").paint(0, 120, -0.15, kind="centre")
    street.paint(80, 110, -3.4, kind="centre")
    assert sorted(line for line in told(street.lines(), "kind", "pattern") if line[0] == "centre") == [("centre", "double-solid")] * 2


def test_dashes_behind_a_double_line_part_the_directions_as_it_did():
    """Up to a crossing the centre line is double, behind it there are dashes: first alone, then with a turning lane beside."""
    street = ClusteredStreet(half_width=7.0).paint(0, 40, 0.15, kind="centre").paint(0, 40, -0.15, kind="centre")
    street.dashes(4.0, 6.0, 0.0, first=50.0, last=120.0).dashes(4.0, 6.0, -3.2, first=70.0, last=120.0)
    assert sorted(set(told(street.lines(), "kind", "pattern"))) == [("centre", "dashed"), ("centre", "double-solid"), ("lane", "dashed")]
    beside = ClusteredStreet(half_width=7.0).paint(0, 40, 0.15, kind="centre").paint(0, 40, -0.15, kind="centre")
    beside.dashes(4.0, 6.0, 3.2, first=50.0, last=120.0)
    assert ("lane", "dashed") in told(beside.lines(), "kind", "pattern")
