"""Which way the lanes of a street are driven."""

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.countries.traffic_side import side_of_traffic
from lanewright.core.markings.cross_section.roads import usual_side
from lined_streets import EAST, HEIGHT, NORTH, Street, middle
from shapely.geometry import Point, Polygon


def two_lanes(**drive):
    return Street(**drive).paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")


def ways(street, **settings):
    lines, _ = street.lanes(**settings)
    for line, row in lines:
        x = np.asarray(line.coords)[:, 0]
        heads_east = x[-1] > x[0]
        assert heads_east == (row["direction"] > 0)
    return dict(zip(middle(street, lines), [row["direction"] for row in lines.rows]))


def test_a_vehicle_right_of_the_centre_line_means_right_hand_traffic():
    assert ways(two_lanes(vehicle=-1.75)) == {-1.75: 1, 1.75: -1}


def test_a_vehicle_left_of_the_centre_line_means_left_hand_traffic():
    assert ways(two_lanes(vehicle=1.75)) == {-1.75: -1, 1.75: 1}


def test_a_driven_lane_leads_the_way_it_was_driven_whatever_side_of_traffic_is_named():
    street = two_lanes(vehicle=-1.75)
    right, left = ways(street, traffic_side="right"), ways(street, traffic_side="left")
    assert right == {-1.75: 1, 1.75: -1} and left[-1.75] == 1


def test_lanes_that_were_driven_the_other_way_from_another_road_lead_the_other_way():
    """Six lanes with a solid line in the middle; each direction was driven in its outer lane, 17 m apart, so that they are two roads."""
    street = Street(vehicle=-1.75, again=(15.75,)).paint(-3.5, kind="edge").paint(0.0, pattern="dashed").paint(3.5, pattern="dashed").paint(7.0)
    street.paint(10.5, pattern="dashed").paint(14.0, pattern="dashed").paint(17.5, kind="edge")
    assert len(street.frame.roads) == 2
    assert ways(street) == {-1.75: 1, 1.75: 1, 5.25: 1, 8.75: -1, 12.25: -1, 15.75: -1}


@pytest.mark.parametrize("crs, beside, side", [("EPSG:32632", 1, "right"), ("", 1, ""), ("EPSG:32755", -1, "left")])
def test_two_lanes_driven_in_the_one_of_overtaking_lead_the_same_way_in_the_country_whose_side_that_is(crs, beside, side):
    """A carriageway of a motorway in town, driven in its left lane in Bavaria, and in its right lane in Tasmania."""
    street = Street(length=300.0, vehicle=1.75 * beside).paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")
    street.frame.crs = crs
    assert usual_side(street.frame) == side
    lines, _ = street.lanes()
    assert {row["direction"] for row in lines.rows} == ({1} if side else {1, -1})


@pytest.mark.parametrize("place, side", [((2.35, 48.86), "right"), ((-0.1, 51.5), "left"), ((139.7, 35.7), "left"), ((129.0, 35.1), "right"),
                                         ((77.0, 28.6), "left"), ((116.4, 39.9), "right"), ((151.2, -33.9), "left"), ((28.0, -26.2), "left"),
                                         ((-74.0, 40.7), "right"), ((13.2, -8.8), "right"), ((61.3, 28.0), ""), ((np.nan, 0.0), "")])
def test_the_side_of_traffic_of_a_place_is_that_of_its_country(place, side):
    assert side_of_traffic(*place) == side


def test_four_lanes_part_at_the_double_line_even_if_it_is_not_in_the_middle():
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(-3.5, pattern="dashed").paint(-7.0, pattern="dashed")
    street.paint(-10.5, kind="edge").paint(0.15, pattern="double-solid").paint(-0.15, pattern="double-solid")
    lines, _ = street.lanes()
    assert [row["direction"] for row in lines.rows] == [1, 1, 1, -1]


def test_passes_in_both_directions_part_the_lanes_without_a_centre_line():
    street = Street(vehicle=-1.75, again=(1.75,))
    for offset in (7.0, 3.5, 0.0, -3.5):
        street.paint(offset, pattern="dashed" if abs(offset) < 3.5 else "solid")
    assert ways(street) == {-1.75: 1, 1.75: -1, 5.25: -1}


def test_a_lane_alone_on_its_road_is_driven_as_the_vehicle_drove():
    assert ways(Street(vehicle=-1.75).paint(0.0).paint(-3.5)) == {-1.75: 1}


def test_driving_the_street_backwards_gives_the_same_lines():
    there = Street(length=90.0, radius=100.0, vehicle=-1.75)
    back = Street(length=90.0, radius=100.0, vehicle=1.75, backwards=True)
    results = []
    for street in (there, back):
        for offset in (3.5, 0.0, -3.5):
            street.paint(offset, 5, 38).paint(offset, 48, 85)
        results.append(street.lanes())
    # the frame's reference runs the other way, so rows and directions are turned, the map is not
    (lines, elements), (turned, turned_elements) = results
    assert len(lines) == len(turned)
    for line, row in lines:
        same = [(other, r) for other, r in turned if other.distance(line.interpolate(0.5, normalized=True)) < 0.01
                and r["status"] == row["status"]]
        assert len(same) == 1
        (other, other_row), = same
        # ends fall on the half metres of either frame, the lines between them on each other
        near, far = np.asarray(line.coords)[[0, -1], :2], np.asarray(other.coords)[[0, -1], :2]
        assert np.hypot(*(near - far).T).max() < 1.01
        inner = line.segmentize(0.5).coords[3:-3]
        assert max(other.distance(Point(place)) for place in inner) < 0.005
        assert other_row["direction"] == -row["direction"]
    assert sorted(r["radius_m"] for r in elements.rows) == pytest.approx(sorted(r["radius_m"] for r in turned_elements.rows), rel=2e-3)


@pytest.mark.parametrize("mirror", [1, -1])
@pytest.mark.parametrize("two", [1, -1])
def test_lanes_whose_lines_begin_later_lead_the_same_way_before(two, mirror):
    """Three lanes up to a junction, parted by a double and a dashed line on the last stretch alone; two lead ahead or two come towards it."""
    street = Street(vehicle=-3.5 * mirror, again=(3.5 * mirror,)).paint(5.25, kind="edge").paint(-5.25, kind="edge")
    street.paint(1.75 * two * mirror, first=60.0, kind="centre", pattern="double-solid").paint(-1.75 * two * mirror, first=60.0, pattern="dashed")
    lines, _ = street.lanes()
    middle_lane = [(line, row["direction"]) for line, row in lines if abs(street.offsets(line).mean()) < 0.3]
    assert {way for _, way in middle_lane} == {two}
    assert sum(line.length for line, _ in middle_lane) > 100.0


@pytest.mark.parametrize("mirror", [1, -1])
@pytest.mark.parametrize("backwards", [False, True])
def test_two_lanes_towards_a_junction_and_one_back_reach_as_far_on_either_side_of_the_road(backwards, mirror):
    """The lines between the lanes end seven metres before those beside them, as where a stop line was worn away."""
    street = Street(vehicle=0.0, backwards=backwards).paint(-2.0 * mirror, last=100.0, kind="edge").paint(8.4 * mirror, last=100.0, kind="edge")
    street.paint(2.0 * mirror, last=93.0, kind="centre").paint(5.2 * mirror, last=93.0)
    lines, _ = street.lanes()
    found = {}
    for line, row in lines:
        found.setdefault(round(float(np.median(street.offsets(line))) * mirror, 1), []).append(row["direction"])
    assert {lane: set(way) for lane, way in found.items()} == {0.0: {1}, 3.6: {-1}, 6.8: {-1}}
    assert [max(line.bounds[2] for line, _ in lines if abs(np.median(street.offsets(line)) * mirror - lane) < 0.2) - EAST
            for lane in (0.0, 3.6, 6.8)] == pytest.approx([100.0] * 3, abs=1.0)


@pytest.mark.parametrize("mirror", [1, -1])
@pytest.mark.parametrize("pattern", ["solid", "double-solid"])
def test_left_turn_lanes_that_face_each_other_across_a_junction_each_lead_up_to_it(pattern, mirror):
    """In the middle of a street of four lanes: nobody drove in them, and stop lines alone tell which way they lead."""
    street, stops = Street(length=200.0, vehicle=-3.35 * mirror, again=(3.35 * mirror,)), Features("PolygonZ", MARKINGS)
    for first, last, way in ((5.0, 80.0, mirror), (120.0, 195.0, -mirror)):
        for offset in (5.1, -5.1):
            street.paint(offset, first, last, pattern="dashed", kind="").paint(1.7 * offset, first, last, kind="")
        street.paint(1.6 * way, first, last, pattern=pattern, kind="").paint(-1.6 * way, first, last, kind="")
        at = 79.0 if first < 80.0 else 120.5
        corners = street.places([at, at + 0.5, at + 0.5, at], np.array([-8.6, -8.6, 1.6, 1.6]) * way)
        stops.add(Polygon(np.c_[corners, np.full(4, HEIGHT)]), **{"road": 0, "class": "stop", "use": "other"})
    lines, _ = street.lanes(markings=stops)
    found = {(row["lane"], street.offsets(line)[0].round(), line.bounds[2] < EAST + 100.0): row["direction"] for line, row in lines}
    assert sorted((before, way) for (_, offset, before), way in found.items() if abs(offset) < 1.0) == [(False, -1), (True, 1)]


def beside_a_bus_lane(centre, beyond, pattern="solid", width=0.12, mirror=1, vehicle=-1.6):
    """Dashes between the directions and a line before a lane of its own, as seen from the lane between; named as given."""
    street = Street(vehicle=vehicle * mirror).paint(3.25 * mirror, kind="edge", width=0.12).paint(0.0, pattern="dashed", kind=centre, width=0.12)
    return street.paint(-3.25 * mirror, kind=beyond, pattern=pattern, width=width).paint(-6.5 * mirror, kind="edge", width=0.12)


@pytest.mark.parametrize("mirror", (1, -1))
@pytest.mark.parametrize("vehicle, pattern", ((-1.6, "solid"), (-1.6, "dashed"), (-4.9, "solid")))
def test_beyond_a_wide_line_a_lane_leads_the_same_way(pattern, vehicle, mirror):
    lines, _ = beside_a_bus_lane("", "", pattern, 0.25, mirror, vehicle).lanes()
    assert {round(float(np.median(lines.geometries[k].coords.xy[1])) - NORTH, 1) * mirror: row["direction"] for k, row in enumerate(lines.rows)} \
        == {1.6: -1, -1.6: 1, -4.9: 1}


@pytest.mark.parametrize("side, open_lanes", [("automatic", {1.6, -4.9}), ("right", {1.6}), ("left", {-4.9})])
def test_of_three_lanes_parted_by_dashes_alone_and_driven_in_the_middle_the_one_beyond_the_centre_may_come_or_go(side, open_lanes):
    """One way, or with oncoming traffic in the lane on the far side, which is either where the side of traffic is not known."""
    street = beside_a_bus_lane("", "", "dashed")
    found = {round(float(np.median(street.offsets(line))), 1): row for line, row in street.lanes(traffic_side=side)[0]}
    assert sorted(found) == [-4.9, -1.6, 1.6] and found[-1.6]["direction"] == 1
    assert {offset for offset, row in found.items() if row["confidence"] <= 0.6 and row["other"]} == open_lanes
    assert all(found[offset]["confidence"] > 0.9 and found[offset]["direction"] == 1 for offset in set(found) - open_lanes)


@pytest.mark.parametrize("mirror", [1, -1])
@pytest.mark.parametrize("vehicle", [-5.25, -1.75])
def test_of_four_lanes_parted_by_dashes_alone_all_lead_as_one_drove_and_those_beyond_the_middle_may_come(vehicle, mirror):
    """As a carriageway of a motorway: a line, and often two, parts the directions of four lanes."""
    street = Street(length=400.0, vehicle=vehicle * mirror).paint(7.0, kind="edge").paint(-7.0, kind="edge")
    for offset in (3.5, 0.0, -3.5):
        street.paint(offset, kind="", pattern="dashed")
    rows = {round(float(np.median(street.offsets(line))) * mirror, 2): row
            for line, row in street.lanes(traffic_side="right" if mirror > 0 else "left")[0]}
    assert {offset: (row["direction"], row["confidence"] > 0.9) for offset, row in rows.items()} \
        == {-5.25: (1, True), -1.75: (1, True), 1.75: (1, False), 5.25: (1, False)}
    assert all(row["other"] and row["confidence"] > 0.5 for offset, row in rows.items() if offset > 0)


def test_of_three_lanes_parted_by_dashes_alone_the_one_beyond_the_middle_remains_open_along_a_long_road():
    """A short stretch that is read otherwise costs less than all of the road, and says nothing about it."""
    street = Street(length=1600.0, vehicle=-3.5).paint(5.25, kind="edge").paint(-5.25, kind="edge")
    for offset in (1.75, -1.75):
        street.paint(offset, kind="", pattern="dashed")
    pieces = [(float(np.median(street.offsets(line))), line.length, row) for line, row in street.lanes(traffic_side="right")[0]]
    far = [(length, row) for offset, length, row in pieces if offset > 2]
    assert sum(length for length, _ in far) > 1500 and all(row["confidence"] <= 0.6 and row["other"] for _, row in far)
    assert all(row["confidence"] > 0.9 and row["direction"] == 1 for offset, _, row in pieces if offset < -2)


@pytest.mark.parametrize("vehicle", [-5.25, -1.75])
def test_of_four_lanes_parted_by_dashes_alone_those_where_one_drove_are_as_sure_along_a_long_road_as_along_a_short_one(vehicle):
    """That the other two may lead the other way along all of it does not say that a lane may be missing on a short way."""
    street = Street(length=1600.0, vehicle=vehicle).paint(7.0, kind="edge").paint(-7.0, kind="edge")
    for offset in (3.5, 0.0, -3.5):
        street.paint(offset, kind="", pattern="dashed")
    pieces = [(float(np.median(street.offsets(line))), row) for line, row in street.lanes(traffic_side="right")[0]]
    assert all(row["confidence"] > 0.9 and row["other"] is None for offset, row in pieces if offset < 0)
    assert all(row["confidence"] <= 0.6 and row["other"] for offset, row in pieces if offset > 0)


@pytest.mark.parametrize("half", [0.1, 0.15])
def test_a_double_line_parts_the_directions_of_a_broad_street_that_was_driven_in_its_outermost_lanes(half):
    """As in the United States, where both lines are 10 cm wide and as far apart. Between the drives there is no end of the road."""
    street = Street(vehicle=-8.25, again=(12.0,)).paint(-9.9, kind="edge").paint(-6.6, pattern="dashed").paint(-3.3, pattern="dashed")
    street.paint(half, pattern="double-solid").paint(-half, pattern="double-solid").paint(3.3, pattern="dashed")
    assert len(street.frame.roads) == 2
    assert {round(offset): way for offset, way in ways(street).items()} == {-8: 1, -5: 1, -2: 1, 2: -1, 5: -1}


@pytest.mark.parametrize("median", [1.0, 2.0])
def test_a_lane_beyond_a_median_leads_the_other_way_and_one_on_this_side_of_it_as_it_was_driven(median):
    """Two lanes, of which the right one was driven, a strip between two lines that is too narrow for a lane, and one lane more."""
    street = Street(vehicle=-3.5).paint(-5.25, kind="").paint(-1.75, kind="", pattern="dashed").paint(1.75, kind="")
    street.paint(1.75 + median, kind="").paint(5.25 + median, kind="")
    ways = {round(float(np.median(street.offsets(line))), 1): (row["direction"], row["confidence"] > 0.9) for line, row in street.lanes()[0]}
    assert ways == {-3.5: (1, True), 0.0: (1, True), 3.5 + median: (-1, True)}


@pytest.mark.parametrize("lanes, median", [(2, 3.5), (3, 4.0)])
def test_a_strip_between_solid_lines_that_no_lane_could_be_entered_through_parts_the_directions_of_several_lanes(lanes, median):
    """As wide as a lane; before, one was drawn there."""
    street, middle = Street(length=300.0, vehicle=-median / 2 - 1.8, again=(median / 2 + 1.8,)), median / 2
    for side in (1, -1):
        street.paint(side * middle, kind="").paint(side * (middle + 3.6 * lanes), kind="")
        for number in range(1, lanes):
            street.paint(side * (middle + 3.6 * number), kind="", pattern="dashed")
    assert {round(offset, 1): way for offset, way in ways(street).items()} == {
        round(side * (middle + 3.6 * (number + 0.5)), 1): -side for side in (1, -1) for number in range(lanes)}
