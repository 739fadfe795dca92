"""The road map in numbers."""

import pytest
from lanewright.algorithms.driving import NUMBERS, road_map_numbers
from lanewright.core.common.features import DRIVING_LINES, MARKING_LINES, MARKINGS, ROAD_EDGES, Features
from lanewright.core.corrections.corrections import Correction, Corrections

shapely = pytest.importorskip("shapely")


def lines(schema, *pieces):
    """Lines of so many metres with a status."""
    layer = Features("LineStringZ", schema)
    for lane, (length, status) in enumerate(pieces):
        layer.add(shapely.LineString([(0, 0, 0), (length, 0, 0)]), road=0, lane=lane // 2, status=status)
    return layer


def test_lengths_and_shares_are_those_of_the_lines_drawn():
    found = road_map_numbers([120.0, 30.0], lines(ROAD_EDGES, (90, "measured"), (30, "bridged")), lines(MARKING_LINES, (50, "measured")),
                             lines(DRIVING_LINES, (40, "measured"), (40, "inferred"), (20, "measured")), Features("PolygonZ", MARKINGS))
    assert found == {"ROADS": 2, "ROAD_LENGTH": 150, "EDGE_LENGTH": 120, "EDGES_MEASURED": 75, "LINE_LENGTH": 50, "LINES_MEASURED": 100,
                     "LANE_COUNT": 2, "LANE_LENGTH": 100, "LANES_MEASURED": 60, "MARKING_COUNT": 0, "CORRECTIONS_MADE": 0,
                     "CORRECTIONS_UNMATCHED": 0}
    assert set(found) | {"TRUST"} == set(NUMBERS)


def test_trust_is_the_mean_confidence_by_length():
    layer = lines(DRIVING_LINES, (90, "measured"), (10, "inferred"))
    layer.rows[0]["confidence"], layer.rows[1]["confidence"] = 1.0, 0.5
    assert road_map_numbers([100.0], None, None, layer, None)["TRUST"] == pytest.approx(0.95)


def test_corrections_are_counted_by_row():
    corrections = Corrections([Correction(row, "delete", "edge", None) for row in (1, 1, 2, 3)], {1, 2})
    found = road_map_numbers([100.0], None, None, None, None, corrections)
    assert (found["CORRECTIONS_MADE"], found["CORRECTIONS_UNMATCHED"]) == (2, 1)


def test_of_what_is_not_there_no_share_is_told():
    found = road_map_numbers([10.0], lines(ROAD_EDGES), None, None, None)
    assert found["EDGE_LENGTH"] == found["LANE_COUNT"] == 0 and not any(name.endswith("_MEASURED") for name in found)
