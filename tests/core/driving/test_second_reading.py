"""Streets that can be read in two ways: what is drawn says so."""

import json

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, ROAD_EDGES, Features
from lanewright.simulator.parts.paint import straight_arrow
from lined_streets import HEIGHT, Street
from shapely.geometry import LineString, Polygon


def curbs(street, *offsets):
    """Road edges with curbs along the street."""
    edges, along = Features("LineStringZ", list(ROAD_EDGES)), np.arange(5.0, 115.0, 0.5)
    for chain, offset in enumerate(offsets):
        edges.add(LineString(np.c_[street.places(along, offset), np.full(len(along), HEIGHT)]), road=0, kind="main", edge="curb", status="measured",
                  part="bottom", chain=chain, side="left" if offset > 0 else "right")
    return edges


def readings(street, **inputs):
    """Rows of the driving lines by the offset of their middle, the longest piece of each lane."""
    found = {}
    for line, row in sorted(zip(*(lambda layer: (layer.geometries, layer.rows))(street.lanes(**inputs)[0])), key=lambda pair: pair[0].length):
        found[round(float(np.median(street.offsets(line))), 2)] = row
    return found


def other_lanes(row, vehicle):
    """(offset, width, direction) of the lanes of its second reading; the road's own offsets begin where the vehicle drove."""
    return [(pytest.approx(lane["offset_m"] + vehicle, abs=0.02), pytest.approx(lane["width_m"], abs=0.02), lane["direction"])
            for lane in json.loads(row["other"])["lanes"]]


@pytest.mark.parametrize("length", [120.0, 400.0])
def test_seven_metres_without_arrows_driven_half_a_metre_beside_their_middle_may_be_one_lane_or_two(length):
    found = readings(Street(length=length, vehicle=-0.5).paint(3.5, kind="edge").paint(-3.5, kind="edge"))
    assert sorted(found) == [-1.75, 1.75]
    for row in found.values():
        assert row["confidence"] <= 0.6
        assert other_lanes(row, -0.5) == [(0.0, 7.0, 1)]


def test_what_is_seen_again_and_again_along_a_road_is_no_surer():
    """On three kilometres as on 400 m."""
    for length in (400.0, 3000.0):
        said = readings(Street(length=length, vehicle=-0.5).paint(3.5, kind="edge").paint(-3.5, kind="edge"))
        assert max(row["confidence"] for row in said.values()) <= 0.6


def test_driven_in_its_middle_it_is_one_lane_without_a_second_reading():
    row, = readings(Street(vehicle=0.0).paint(3.5, kind="edge").paint(-3.5, kind="edge")).values()
    assert row["other"] is None and row["confidence"] > 0.85


def test_behind_a_solid_centre_line_an_oncoming_lane_that_nobody_drove_is_sure():
    found = readings(Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, kind="").paint(-3.5, kind="edge"))
    assert {offset: row["direction"] for offset, row in found.items()} == {-1.75: 1, 1.75: -1}
    assert all(row["other"] is None and row["confidence"] > 0.9 for row in found.values())


def test_beyond_dashes_on_a_short_street_traffic_may_come_or_go():
    found = readings(Street(length=100.0, vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, kind="", pattern="dashed").paint(-3.5, kind="edge"))
    assert found[-1.75]["other"] is None, "where one drove it is known"
    oncoming = found[1.75]
    assert oncoming["confidence"] <= 0.6 and other_lanes(oncoming, -1.75) == [(1.75, 3.5, 1)]


@pytest.mark.parametrize("crs, across", [("", {1, -1}), ("EPSG:32632", {1})])
@pytest.mark.parametrize("length", [150.0, 400.0, 3000.0])
def test_left_of_dashes_one_drives_on_the_left_or_overtakes_on_a_one_way_road(length, crs, across):
    """Where the country is not known both are said; where traffic is on the right there, the lane on the right leads the same way."""
    street = Street(length=length, vehicle=1.75).paint(3.5, kind="edge").paint(0.0, kind="", pattern="dashed").paint(-3.5, kind="edge")
    street.frame.crs = crs
    found = readings(street)
    beside, way = found[-1.75], found[-1.75]["direction"]
    assert way in across and beside["confidence"] <= 0.6 and other_lanes(beside, 1.75) == [(-1.75, 3.5, -way)]
    assert found[1.75]["direction"] == 1 and found[1.75]["other"] is None and found[1.75]["confidence"] > 0.9


@pytest.mark.parametrize("crs, vehicle", [("", -1.75), ("EPSG:32632", -1.75), ("EPSG:32755", 1.75)])
def test_dashes_with_the_drive_on_the_usual_side_surely_part_the_directions(crs, vehicle):
    street = Street(length=400.0, vehicle=vehicle).paint(3.5, kind="edge").paint(0.0, kind="", pattern="dashed").paint(-3.5, kind="edge")
    street.frame.crs = crs
    found = readings(street)
    assert {offset: row["direction"] for offset, row in found.items()} == {vehicle: 1, -vehicle: -1}
    assert all(row["other"] is None and row["confidence"] > 0.9 for row in found.values())


def test_a_road_that_was_driven_twice_and_never_back_may_be_one_way():
    """As a carriageway with two lanes, of which the right one was driven."""
    once, twice = (readings(Street(length=400.0, vehicle=-1.75, along=along).paint(3.5, kind="edge").paint(0.0, kind="", pattern="dashed")
                            .paint(-3.5, kind="edge")) for along in ((), (-1.6,)))
    assert once[1.75]["confidence"] > 0.9 and once[1.75]["other"] is None
    assert twice[1.75]["confidence"] <= 0.6 and other_lanes(twice[1.75], -1.75) == [(1.75, 3.5, -twice[1.75]["direction"])]


@pytest.mark.parametrize("again", [True, False])
@pytest.mark.parametrize("curb, driven, middle", [(3.9, 1.95, 1.95), (4.3, 2.15, 2.15), (5.0, 2.5, 2.5), (4.0, 1.7, 1.75), (5.6, 1.65, 1.7)])
def test_beside_a_curb_a_lane_has_the_room_in_whose_middle_one_drives_and_so_has_the_one_across(curb, driven, middle, again):
    """All of it, or all but a gutter or a row of parked cars."""
    street = Street(vehicle=-driven, again=(driven,) if again else ()).paint(0.0, kind="centre")
    found = readings(street, edges=curbs(street, curb, -curb))
    assert sorted(found) == pytest.approx([-middle, middle], abs=0.1)


def test_where_one_drives_between_the_middle_of_the_room_and_that_of_a_usual_lane_the_lane_lies_there():
    """Within 15 cm of both: with and without a gutter it is right."""
    street = Street(vehicle=-1.9, again=(1.9,)).paint(0.0, kind="centre")
    assert sorted(readings(street, edges=curbs(street, 4.1, -4.1))) == pytest.approx([-1.9, 1.9], abs=0.06)


def test_two_drives_that_keep_away_from_both_curbs_show_that_something_is_left_over_beside_them():
    """Each of them alone may have kept to one side of a lane that has all the room."""
    street = Street(vehicle=-1.75, again=(1.75,)).paint(0.0, kind="centre")
    found = readings(street, edges=curbs(street, 3.8, -3.8))
    assert sorted(found) == pytest.approx([-1.75, 1.75], abs=0.08)
    assert all(row["other"] is None for row in found.values())


def test_a_lane_beside_a_curb_is_as_sure_as_the_room_and_the_drive_show_its_width():
    """Driven in the middle of the room it has all of that; driven a little nearer to the line there may be a narrow gutter."""
    middle, nearer = (Street(vehicle=-driven, again=(driven,)).paint(0.0, kind="centre") for driven in (1.8, 1.65))
    sure, less_sure = (readings(street, edges=curbs(street, 3.6, -3.6)).values() for street in (middle, nearer))
    assert all(row["confidence"] > 0.97 for row in sure) and all(row["confidence"] < 0.9 for row in less_sure)


def test_a_row_of_parked_cars_between_lane_and_curb_is_no_second_reading_where_one_drove_beside_it():
    street = Street(vehicle=-1.75, again=(1.75,)).paint(0.0, kind="centre")
    assert all(row["other"] is None for row in readings(street, edges=curbs(street, 5.7, -5.7)).values())


def test_the_uncertainty_of_a_lane_reaches_to_the_lanes_of_the_second_reading():
    doubtful, sure = (min(row["sigma_m"] for row in readings(Street(vehicle=vehicle).paint(3.5, kind="edge").paint(-3.5, kind="edge")).values())
                      for vehicle in (-0.5, -1.75))
    assert doubtful > 0.5 and sure < 0.01


def estimated(street):
    """The street with a drive that was estimated from points without times: where it led is known, which way is not."""
    street.frame.way_known = False
    return street


def arrows(street, *places):
    """Markings of arrows: (station, offset, way)."""
    layer = Features("PolygonZ", MARKINGS)
    for station, offset, way in places:
        corners = street.places(*straight_arrow(station, offset, way).T)
        layer.add(Polygon(np.c_[corners, np.full(len(corners), HEIGHT)]), **{"road": 0, "class": "arrow", "use": "other"})
    return layer


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("stations", [(60.0,), (30.0, 60.0, 90.0)])
def test_which_way_an_estimated_drive_led_says_nothing_against_arrows(way, stations):
    street = estimated(Street(vehicle=0.0).paint(1.75, kind="edge").paint(-1.75, kind="edge"))
    row, = readings(street, markings=arrows(street, *((station, 0.0, way) for station in stations))).values()
    assert row["direction"] == way and row["other"] is None and row["confidence"] > 0.7


def test_a_lane_of_which_nothing_shows_which_way_it_leads_says_both():
    row, = readings(estimated(Street(vehicle=0.0).paint(1.75, kind="edge").paint(-1.75, kind="edge"))).values()
    assert row["confidence"] <= 0.6 and other_lanes(row, 0.0) == [(0.0, 3.5, -row["direction"])]


def test_on_an_estimated_drive_lanes_lead_on_the_side_that_is_usual_and_may_lead_the_other_way():
    street = estimated(Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, pattern="double-solid", kind="centre").paint(-3.5, kind="edge"))
    found = readings(street)
    assert {offset: row["direction"] for offset, row in found.items()} == {-1.75: 1, 1.75: -1}
    assert all(row["confidence"] <= 0.6 and [lane[2] for lane in other_lanes(row, -1.75)] == [-row["direction"]] for row in found.values())


@pytest.mark.parametrize("median", [2.0, 3.0])
def test_a_median_without_paint_between_lane_lines_leaves_driven_lanes_where_they_were_driven_and_others_in_doubt(median):
    inner, half = median / 2 + 1.75, median / 2 + 7.0
    for again in ((), (inner,)):
        street = Street(vehicle=-inner, again=again)
        for side in (1, -1):
            street.paint(side * (median / 2 + 3.5), pattern="dashed")
        lanes = {round(float(np.median(street.offsets(line))), 3): row for line, row in street.lanes(edges=curbs(street, half, -half))[0]}
        for offset, row in lanes.items():
            right = min(abs(abs(offset) - place) for place in (inner, inner + 3.5)) < 0.15
            assert right or row["confidence"] <= 0.6
        assert min(abs(offset + inner) for offset in lanes) < 0.15
