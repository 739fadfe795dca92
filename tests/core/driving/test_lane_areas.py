"""The areas of lanes: what bounds them and what follows them."""

import numpy as np
import pytest
from lanewright.core.driving.driving_lines import DrivingSettings, make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lined_streets import Street


def lanes_of(street, **settings):
    return make_driving_lines(PaintedLines.from_features(street.lines, street.frame), street.frame, DrivingSettings(**settings))[2]


def two_way(length=120.0, gap=None):
    street = Street(length=length, vehicle=-1.75)
    for first, last in ((5.0, length - 5.0),) if gap is None else ((5.0, gap[0]), (gap[1], length - 5.0)):
        street.paint(3.5, first, last, kind="edge").paint(0.0, first, last, pattern="dashed").paint(-3.5, first, last, kind="edge")
    return street


def test_two_neighbouring_lanes_share_the_vertices_of_the_line_between_them():
    lanes = lanes_of(two_way())
    (left, _), (other, _) = lanes.borders(0), lanes.borders(1)
    assert len(lanes) == 2 and set(lanes.direction) == {1, -1}
    # the line between the directions lies on the left of both
    np.testing.assert_array_equal(left, other[::-1])
    assert lanes.left_line[0] == lanes.left_line[1] == "line 2"
    assert lanes.left_kind.tolist() == ["centre"] * 2 and lanes.right_kind.tolist() == ["edge"] * 2
    assert lanes.left_pattern.tolist() == ["dashed"] * 2
    np.testing.assert_allclose(lanes.width, 3.5, atol=0.01)


def test_left_is_left_in_the_direction_of_travel():
    lanes = lanes_of(two_way())
    for k in range(len(lanes)):
        left, right = lanes.borders(k)
        ahead, across = left[-1, :2] - left[0, :2], left[0, :2] - right[0, :2]
        assert ahead[0] * across[1] - ahead[1] * across[0] > 0


def test_the_pieces_of_a_lane_follow_each_other_in_the_direction_of_travel():
    lanes = lanes_of(two_way(gap=(50.0, 60.0)))
    for k in range(len(lanes)):
        for name in lanes.successors[k]:
            after = lanes.lane_id.tolist().index(name)
            assert lanes.direction[after] == lanes.direction[k]
            for before, behind in zip(lanes.borders(k), lanes.borders(after)):
                np.testing.assert_allclose(before[-1], behind[0], atol=1e-9)
    ends = [k for k in range(len(lanes)) if not lanes.successors[k]]
    assert len(ends) == 2


def test_over_a_junction_that_was_driven_a_connector_leads_from_lane_to_lane():
    lanes = lanes_of(two_way(length=200.0, gap=(70.0, 110.0)))
    kinds = lanes.type.tolist()
    assert kinds.count("connector") == 1
    k = kinds.index("connector")
    assert lanes.status[k] == "inferred" and lanes.direction[k] == 1
    assert [lanes.type[lanes.lane_id.tolist().index(name)] for name in lanes.successors[k]] == ["driving"]
    before = [j for j in range(len(lanes)) if lanes.lane_id[k] in lanes.successors[j]]
    assert len(before) == 1 and lanes.end[before[0]] == pytest.approx(70.0, abs=1.0)


def test_lane_ids_are_each_there_once():
    lanes = lanes_of(two_way(length=200.0, gap=(70.0, 110.0)))
    assert len(set(lanes.lane_id)) == len(lanes)
