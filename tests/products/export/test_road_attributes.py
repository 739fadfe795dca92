"""Lanes get the name and speed limit of the way that they lie along, and of no other."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.driving.layers import Lanes
from lanewright.products.export.road_attributes import AttributeSettings, attributes_along, read_osm_ways, ways_in
from map_files import written
from osm_files import osm_text

CRS = "EPSG:25832"
EAST, NORTH = 600000.0, 5800000.0


def lane(name, y, heads=1, x=(0.0, 100.0), across=False, **more):
    """A lane of 3.5 m whose middle runs east (1) or west (-1) at y, or north at x."""
    along = np.linspace(*x, 11)[::heads]
    left, right = (np.c_[along, np.full(11, y + side * heads * 1.75), np.zeros(11)] for side in (1, -1))
    if across:
        left, right = left[:, [1, 0, 2]] * [-1, 1, 1], right[:, [1, 0, 2]] * [-1, 1, 1]
    return {"lane_id": name, "left": left + [EAST, NORTH, 0], "right": right + [EAST, NORTH, 0], "direction": heads, **more}


def way(x, y, **tags):
    return [(EAST + a, NORTH + b) for a, b in zip(x, y)], {key.replace("_", ":"): value for key, value in tags.items()}


def known(folder, lanes, *ways, **settings):
    roads = read_osm_ways(written(folder, osm_text(*ways), "streets.osm"), CRS)
    return attributes_along(Lanes.of_pieces(lanes, CRS), roads, AttributeSettings(**settings))


def test_lanes_beside_a_way_get_what_it_says_and_a_street_across_says_nothing(tmp_path):
    found = known(tmp_path, [lane("a", -1.75), lane("b", 1.75, -1), lane("c", -50, across=True)],
                  way((-20, 120), (0, 0), name="High Street", maxspeed="50", lanes="2", surface="asphalt", ref="B 1", oneway="no"),
                  way((50, 50), (-40, 60), name="Mill Lane", maxspeed="30 mph"))
    street = {"name": "High Street", "ref": "B 1", "speed_kmh": 50.0, "lanes": 2, "surface": "asphalt", "oneway": "no"}
    assert found == {"a": street, "b": street, "c": {"name": "Mill Lane", "speed_kmh": pytest.approx(48.28, abs=0.01)}}


def test_a_one_way_road_counts_for_lanes_in_its_direction_alone(tmp_path):
    ways = (way((0, 100), (-2, -2), name="Eastbound", oneway="yes"), way((0, 100), (2, 2), name="Westbound", oneway="-1"))
    found = known(tmp_path, [lane("east", 2), lane("west", -2, -1)], *ways)
    assert {name: row["name"] for name, row in found.items()} == {"east": "Eastbound", "west": "Westbound"}


def test_limits_of_both_directions_are_told_apart(tmp_path):
    found = known(tmp_path, [lane("east", -1.75), lane("west", 1.75, -1)],
                  way((0, 100), (0, 0), maxspeed="60", maxspeed_forward="70", maxspeed_backward="40"))
    assert {name: row["speed_kmh"] for name, row in found.items()} == {"east": 70, "west": 40}


@pytest.mark.parametrize("limit", ["DE:urban", "none", "walk", "signals", "50;30", ""])
def test_a_limit_that_is_no_number_is_none(tmp_path, limit):
    assert "speed_kmh" not in known(tmp_path, [lane("a", 0)], way((0, 100), (0, 0), name="x", maxspeed=limit))["a"]


def test_a_value_holds_where_it_holds_along_most_of_the_lane(tmp_path):
    ways = (way((0, 40), (0, 0), name="One", maxspeed="30"), way((40, 100), (0, 0), name="One", maxspeed="50"))
    assert known(tmp_path, [lane("a", 0)], *ways)["a"] == {"name": "One", "speed_kmh": 50.0}
    assert known(tmp_path, [lane("a", 0, x=(-120, 80))], *ways) == {}
    assert known(tmp_path, [lane("a", 13)], *ways) == {} != known(tmp_path, [lane("a", 13)], *ways, corridor=14.0)


def test_ways_for_walking_are_no_roads_and_a_layer_may_hold_its_tags_in_one_field():
    line = np.array([[EAST, NORTH], [EAST + 100, NORTH]])
    ways = ways_in([(line, {"highway": "footway", "name": "Path"}),
                    (line, {"NAME": "Street", "maxspeed": None, "other_tags": '"maxspeed"=>"30","surface"=>"sett"'})], CRS, CRS)
    assert attributes_along(Lanes.of_pieces([lane("a", 0)], CRS), ways) == {"a": {"name": "Street", "speed_kmh": 30.0, "surface": "sett"}}


def test_a_file_without_roads_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="no way with a tag highway"):
        read_osm_ways(written(tmp_path, "<osm><node id='1' lat='10' lon='10'/></osm>", "empty.osm"), CRS)
