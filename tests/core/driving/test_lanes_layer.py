"""Lanes keep their borders, links and order through their layer."""

from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import LANES, Features
from lanewright.core.driving.layers import Lanes

ORIGIN = np.array([500000.0, 5800000.0, 40.0])
FRAME = SimpleNamespace(origin=ORIGIN)


def texts(*values):
    return np.array(values, object)


def two_way_street(length=40.0, half_width=3.5):
    """A straight street to the east: lane 1 along it in two pieces, lane 2 against it, a shoulder nobody drives on."""
    def strip(first, last, left, right, step=5.0):
        x = np.linspace(first, last, int(abs(last - first) / step) + 1)
        return np.c_[x, np.full_like(x, left), 0.02 * x], np.c_[x, np.full_like(x, right), 0.02 * x]

    strips = [strip(0, 20, 0, -half_width), strip(20, length, 0, -half_width), strip(length, 0, 0, half_width),
              strip(0, length, -half_width, -half_width - 1.5)]
    counts = [len(left) for left, _ in strips]
    return Lanes(
        np.ones(4, int), np.array([1, 1, 2, 3]), texts("1.1.1", "1.1.2", "1.2.1", "1.3.1"), texts("driving", "driving", "driving", "shoulder"),
        np.array([1, 1, -1, 0]), texts("line 1", "line 1", "line 1", "line 2"), texts("line 2", "line 2", "edge 1", "edge 2"),
        texts("centre", "centre", "centre", "edge"), texts("edge", "edge", "curb", "curb"), texts("dashed", "dashed", "dashed", "solid"),
        texts("solid", "solid", "", ""), [("1.1.2",), (), (), ()], texts("measured", "bridged", "inferred", "measured"),
        np.array([0.9, 0.5, 0.8, 1.0]), np.array([0.0, 20.0, 0.0, 0.0]), np.array([20.0, length, length, length]), texts("", "", "", ""),
        np.concatenate([left for left, _ in strips]), np.concatenate([right for _, right in strips]), np.append(0, np.cumsum(counts)),
        "EPSG:25832")


def test_lanes_come_back_from_their_layer_as_they_were():
    lanes = two_way_street()
    again = Lanes.from_features(lanes.to_features(FRAME), FRAME)
    for name in ("left", "right", "confidence", "station", "end"):
        np.testing.assert_allclose(getattr(again, name), getattr(lanes, name), atol=1e-8)
    for name in ("road", "lane", "lane_id", "type", "direction", "left_line", "right_line", "left_kind", "right_kind", "left_pattern",
                 "right_pattern", "status", "start"):
        assert getattr(again, name).tolist() == getattr(lanes, name).tolist()
    assert again.successors == lanes.successors and again.crs == lanes.crs


def test_the_ring_begins_at_the_left_border_in_the_direction_of_travel():
    layer = two_way_street().to_features(FRAME)
    against = layer.geometries[2]
    first = np.array(against.exterior.coords[0]) - ORIGIN
    np.testing.assert_allclose(first, [40.0, 0.0, 0.8], atol=1e-8)   # driven to the west, the centre line lies to its left
    assert len(against.exterior.coords) % 2 == 1 and against.is_valid


def test_the_layer_tells_width_and_length_in_its_fields():
    layer = two_way_street().to_features(FRAME)
    assert layer.column("width_m") == pytest.approx([3.5, 3.5, 3.5, 1.5])
    assert layer.column("length_m") == pytest.approx([20.0, 20.0, 40.0, 40.0])
    assert set(layer.rows[0]) == {field.name for field in LANES}
    assert all(len(field.name) <= 10 for field in LANES)


def test_no_lanes_make_an_empty_layer_and_back():
    empty = Lanes.from_features(Features("PolygonZ", LANES))
    assert len(empty) == 0 and len(empty.width) == 0 and len(empty.to_features()) == 0


def test_a_lane_with_a_border_too_few_is_refused_by_name():
    layer = two_way_street().to_features()
    layer.geometries[2] = shapely.Polygon([(0, 0, 0), (5, 0, 0), (0, 3, 0)])
    with pytest.raises(RoadExtractionError, match=r"Lane 1\.2\.1 has 3 vertices"):
        Lanes.from_features(layer)


@pytest.mark.parametrize("field, value, said", [
    ("lane_id", None, "no lane_id"), ("lane_id", "1.1.2", "1.1.2 is there 2 times"), ("type", "motorway", "'motorway'")])
def test_what_lanes_cannot_be_is_said(field, value, said):
    layer = two_way_street().to_features()
    layer.rows[0][field] = value
    with pytest.raises(RoadExtractionError, match=said):
        Lanes.from_features(layer)
