"""`make accuracy`: how right the confidence of lanes is."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from shapely import LineString

pytest.importorskip("osgeo.gdal")

from accuracy.confidence import confidence_figures  # noqa: E402
from accuracy.results import results  # noqa: E402
from accuracy.streets import driving_figures  # noqa: E402

TRUE_LANE = LineString([(0, 0), (100, 0)])
CASE = SimpleNamespace(truth=SimpleNamespace(driving=[TRUE_LANE], area=None))
TRACK = np.array([[0.0, -20.0], [100.0, -20.0]])


def test_the_confidence_of_a_lane_is_compared_with_the_share_of_it_that_is_right():
    # 20 of 100 m lie half a metre off
    drawn = LineString([(0, 0.05), (80, 0.05), (80, 0.5), (100, 0.5)])
    (right, count, said), = confidence_figures(CASE, TRACK, [(drawn, {"confidence": 0.8})]).values()
    assert right / count == pytest.approx(0.8, abs=0.01) and said / count == pytest.approx(0.8)


def test_what_is_drawn_on_the_track_where_the_truth_has_no_lane_counts_neither_way():
    drawn = LineString([(10, -20), (60, -20)])
    (right, count, _), = confidence_figures(CASE, TRACK, [(drawn, {"confidence": 0.9})]).values()
    assert right == count == 0


def test_figures_of_driving_lines_can_be_saved():
    found = driving_figures(CASE.truth, TRACK, [LineString([(0, 0.05), (100, 0.05)])])
    assert json.loads(json.dumps(found))["lanes"] == [1000.0, 1000.0]
    # no pass drove in the lane
    assert "driven" not in found


def test_the_results_say_how_often_sure_lanes_are_right():
    table = results([dict(name="a street", kind="simulated", text="", points=1, streets={"as surveyed": dict(lanes=(95.0, 100.0))},
                          confidence={"4": (970.0, 1000.0, 990.0)})])
    assert [table.get("confidence", "all", "0.95 to 1.00", name) for name in ("said", "right", "m")] == [0.99, 0.97, 100.0]
