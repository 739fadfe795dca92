"""Shoulders lie between the edge line and the edge of the pavement."""

import numpy as np
import pytest
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.road.edges.road_edges import RoadEdges
from lined_streets import HEIGHT, Street
from shapely.geometry import LineString


def lanes_of(*edges, backwards=False):
    """Lanes of a two-way street with edge lines 3.5 m from its middle; edges are (offset, first, last, what)."""
    street = Street(length=160.0, vehicle=1.75 if backwards else -1.75, backwards=backwards)
    street.paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")
    layer = Features("LineStringZ", ROAD_EDGES)
    for offset, first, last, what in edges:
        s = np.arange(first, last + 0.1, 0.5)
        layer.add(LineString(np.c_[street.places(s, offset), np.full(len(s), HEIGHT - 0.05)]), road=0, side="left" if offset > 0 else "right",
                  status="measured", kind="main", edge=what)
    lines, edges = PaintedLines.from_features(street.lines, street.frame), RoadEdges.from_features(layer, street.frame)
    return make_driving_lines(lines, street.frame, edges=edges)[2]


def shoulders_of(lanes):
    return [k for k in range(len(lanes)) if lanes.type[k] == "shoulder"]


def test_the_strips_outside_the_edge_lines_are_shoulders_where_the_pavement_ends_without_a_curb():
    lanes = lanes_of((5.5, 5.0, 155.0, "pavement"), (-5.0, 5.0, 155.0, "pavement"))
    found = shoulders_of(lanes)
    assert sorted(round(float(width), 2) for width in lanes.width[found]) == [1.5, 2.0]
    assert (lanes.direction[found] == 0).all() and not any(lanes.successors[k] for k in found)
    kinds = {frozenset((lanes.left_kind[k], lanes.right_kind[k])) for k in found}
    assert kinds == {frozenset(("edge", "pavement"))}


def test_a_shoulder_shares_the_vertices_of_the_lane_beside_it():
    lanes = lanes_of((-5.0, 5.0, 155.0, "pavement"))
    k, = shoulders_of(lanes)
    # the lane on the right is driven along the road; its right border is the left one of the shoulder
    lane, = np.flatnonzero((lanes.type == "driving") & (lanes.direction == 1))
    inner, border = lanes.borders(k)[0], lanes.borders(lane)[1]
    assert lanes.left_line[k] == lanes.right_line[lane]
    assert {tuple(place) for place in inner.round(6)} <= {tuple(place) for place in border.round(6)}
    np.testing.assert_allclose(lanes.borders(k)[1][:, 2], inner[:, 2] - 0.05, atol=0.01)


def test_beside_a_curb_the_strip_may_be_anything_and_is_not_named():
    assert not shoulders_of(lanes_of((5.5, 5.0, 155.0, "curb"), (-5.5, 5.0, 155.0, "curb")))


@pytest.mark.parametrize("offset", [-4.2, -12.0])
def test_a_strip_too_narrow_or_too_wide_for_a_shoulder_is_none(offset):
    assert not shoulders_of(lanes_of((offset, 5.0, 155.0, "pavement")))


def test_a_shoulder_is_as_long_as_the_edge_of_the_pavement_is_known():
    lanes = lanes_of((-5.5, 40.0, 100.0, "pavement"))
    k, = shoulders_of(lanes)
    assert lanes.length[k] == pytest.approx(60.0, abs=1.0)


def test_driven_backwards_the_shoulders_are_the_same_areas():
    ahead, back = (lanes_of((5.5, 5.0, 155.0, "pavement"), (-5.0, 5.0, 155.0, "pavement"), backwards=way) for way in (False, True))
    widths = [sorted(lanes.width[shoulders_of(lanes)].round(2).tolist()) for lanes in (ahead, back)]
    assert widths[0] == widths[1]
