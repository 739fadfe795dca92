"""Lanes beside tapers, and lanes whose lines step aside."""

import json

import numpy as np
import pytest
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.driving.lane_track import MEASURED, LaneTrack
from lanewright.core.driving.lanes import laid_out
from lined_streets import EAST, HEIGHT, Street
from shapely.geometry import LineString

LENGTH = 200.0


def track(first, d, width):
    """A measured lane along the road."""
    count = len(d)
    return LaneTrack(first, d, width, np.full(count, MEASURED), np.zeros(count, bool), *[np.full(count, -1)] * 4, *[np.ones(count)] * 2, 1)


def exit_street(opens):
    """A lane beside which an exit lane opens (or closes) along a taper from 60 to 100 m, whose dashes begin at 75 m."""
    def station(s):
        return s if opens else LENGTH - s

    street = Street(length=LENGTH, vehicle=-1.85).paint(3.7, kind="edge").paint(0.0, pattern="dashed")
    street.paint(lambda s: -3.7 - 3.6 * np.clip((station(s) - 60.0) / 40.0, 0.0, 1.0), kind="edge")
    ends = sorted((station(75.0), station(195.0)))
    return street.paint(-3.7, *ends, pattern="dashed")


def lanes_by_place(street):
    """(N, 2) distance along the street and offset of all driving lines."""
    return np.concatenate([np.c_[np.asarray(line.coords)[:, 0] - EAST, street.offsets(line)] for line, _ in street.lanes()[0]])


@pytest.mark.parametrize("opens", [True, False])
def test_a_lane_beside_which_another_opens_keeps_its_width_along_the_taper(opens):
    places = lanes_by_place(exit_street(opens))
    through = places[(places[:, 1] < 0.0) & (places[:, 1] > -3.3)]
    assert np.ptp(through[:, 0]) == pytest.approx(190.0, abs=1.0)
    np.testing.assert_allclose(through[:, 1], -1.85, atol=0.04)


@pytest.mark.parametrize("opens", [True, False])
def test_a_lane_that_opens_is_driven_from_where_it_is_as_wide_as_farther_on(opens):
    places = lanes_by_place(exit_street(opens))
    other = places[places[:, 1] < -3.7, 0] if opens else LENGTH - places[places[:, 1] < -3.7, 0]
    # nine tenths of it are there at 96 m
    assert other.min() == pytest.approx(96.0, abs=1.5) and other.max() == pytest.approx(195.0, abs=1.0)


@pytest.mark.parametrize("opens", [True, False])
def test_a_lane_is_one_lane_along_the_border_that_it_keeps_where_a_turning_lane_opens_on_its_other_side(opens):
    def station(s):
        return s if opens else LENGTH - s

    def share(s, first, length):
        return np.clip((station(s) - first) / length, 0.0, 1.0)

    street = Street(length=LENGTH, vehicle=-1.8).paint(-3.6, kind="edge").paint(lambda s: 4.0 + 2.2 * share(s, 60.0, 40.0), kind="edge")
    for line, *ends in ((lambda s: 1.6 * share(s, 60.0, 40.0), 5.0, 100.0), (lambda s: 1.6 + 0.6 * share(s, 100.0, 15.0), 100.0, 195.0)):
        street.paint(line, *sorted(map(station, ends)), kind="centre", line=50)
    lines = street.paint(-0.8, *sorted(map(station, (100.0, 195.0))), pattern="dashed").lanes()[0]
    lines = [(line, row) for line, row in lines if row["direction"] == 1]
    length = {lane: sum(line.length for line, row in lines if row["lane"] == lane) for lane in {row["lane"] for _, row in lines}}
    assert max(length.values()) == pytest.approx(190.0, abs=1.0)


def test_a_lane_keeps_its_width_where_it_was_taken_to_reach_over_the_beginning_of_the_one_that_opens():
    count = 200
    widening = np.clip((np.arange(count) - 60) / 15.0, 0.0, 2.0) * (np.arange(count) < 88)
    through = track(0, -1.6 - widening / 2, 3.2 + widening)
    opening = track(85, np.full(count - 85, -4.8), np.full(count - 85, 3.2))
    kept, _ = laid_out([through, opening])
    np.testing.assert_allclose(kept.d, -1.6)
    np.testing.assert_allclose(kept.width, 3.2)


def street_whose_left_lines_part(again=()):
    """From 70 to 87 m the edge line leads 1.7 m away from a lane of 3.5 m on the left of the centre line."""
    street = Street(length=120.0, vehicle=-1.75, again=again).paint(-3.5, kind="edge").paint(0.0, kind="centre")
    return street.paint(lambda s: 3.5 + np.clip((s - 70.0) / 10.0, 0.0, 1.7), kind="edge")


def test_where_lines_part_farther_than_lanes_are_built_wide_one_that_nobody_drove_lies_beside_either_of_them_and_both_are_said():
    last = max((row for row in street_whose_left_lines_part().lanes()[0].rows if row["direction"] < 0), key=lambda row: row["end_m"])
    assert last["end_m"] == pytest.approx(114.5, abs=0.6)
    lane, = json.loads(last["other"])["lanes"]
    assert last["confidence"] <= 0.6 and lane["offset_m"] - 1.75 == pytest.approx(5.2 - lane["width_m"] / 2, abs=0.02)


def test_where_lines_part_farther_than_lanes_are_built_wide_a_lane_lies_where_it_was_driven():
    places = lanes_by_place(street_whose_left_lines_part(again=(1.75,)))
    driven = places[places[:, 1] > 0.0]
    assert np.ptp(driven[:, 0]) > 105.0
    np.testing.assert_allclose(driven[:, 1], 1.75, atol=0.2)
    np.testing.assert_allclose(driven[driven[:, 0] > 90.0, 1], 1.75, atol=0.1)


def test_a_broad_lane_that_divides_into_two_is_driven_in_its_middle_up_to_there():
    street = Street(length=LENGTH, vehicle=-1.85, again=(1.85,)).paint(3.7, kind="edge").paint(0.0, kind="centre")
    street.paint(-4.8, kind="edge").paint(-2.4, 100.0, 195.0, pattern="dashed")
    places = lanes_by_place(street)
    before = places[(places[:, 0] > 10.0) & (places[:, 0] < 88.0) & (places[:, 1] < 0.0), 1]
    np.testing.assert_allclose(before, -2.4, atol=0.03)


def test_where_a_line_steps_aside_the_lanes_between_it_and_the_other_edge_follow_it_there_and_nowhere_else():
    """Two lanes without a line between them; behind a gap the left edge line lies 0.2 m farther out."""
    street = Street(length=LENGTH, vehicle=-1.45).paint(-2.9, kind="edge")
    street.paint(2.9, 5.0, 80.0, kind="edge").paint(3.1, 84.0, 195.0, kind="edge")
    places = lanes_by_place(street)
    for first, last, left in ((10.0, 65.0, 2.9), (100.0, 190.0, 3.1)):
        here = places[(places[:, 0] > first) & (places[:, 0] < last), 1]
        np.testing.assert_allclose(here[here < 0], -2.9 + (2.9 + left) / 4, atol=0.01)
        np.testing.assert_allclose(here[here > 0], left - (2.9 + left) / 4, atol=0.01)


def test_beside_a_line_that_moves_aside_a_lane_stays_where_it_was_driven_beside_its_curb():
    """Before a turning lane opens in the middle, the dashes on the left lead away from the lane."""
    street = Street(length=LENGTH, vehicle=-1.75)
    street.paint(lambda s: np.clip((s - 100.0) / 25.0, 0.0, 1.1), 5.0, 127.0, pattern="dashed")
    edges = Features("LineStringZ", ROAD_EDGES)
    along = np.arange(0.0, LENGTH + 0.1, 0.5)
    edges.add(LineString(np.c_[street.places(along, -3.5), np.full(len(along), HEIGHT)]), road=0, kind="main", side="right")
    driven = [line for line, row in street.lanes(edges=edges)[0] if row["direction"] == 1]
    assert max(np.abs(street.offsets(line) + 1.75).max() for line in driven) < 0.15


def test_a_lane_beside_a_curb_is_in_doubt_where_the_vehicle_drives_along_its_line_and_not_in_its_middle():
    def inward(s):
        return 0.7 * np.clip((90.0 - s) / 25.0, 0.0, 1.0)

    street = Street(length=LENGTH, vehicle=-1.2).paint(lambda s: -inward(s), kind="centre")
    edges, along = Features("LineStringZ", ROAD_EDGES), np.arange(0.0, LENGTH + 0.1, 0.5)
    curb = street.places(along, -4.4 - inward(along))
    edges.add(LineString(np.c_[curb, np.full(len(along), HEIGHT)]), road=0, kind="main", side="right")
    driven = [row for line, row in street.lanes(edges=edges)[0] if row["direction"] == 1 and line.coords[0][0] < EAST + 60.0]
    assert driven and max(row["confidence"] for row in driven) < 0.7


def test_a_lane_in_a_bend_is_even_where_its_edge_line_and_curb_stop_at_the_mouth_of_a_side_street():
    street = Street(length=110.0, radius=55.0, vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, pattern="dashed")
    street.paint(-3.5, 5.0, 45.0, kind="edge").paint(-3.5, 70.0, 105.0, kind="edge")
    edges = Features("LineStringZ", list(ROAD_EDGES))
    for first, last in ((5.0, 48.0), (67.0, 105.0)):
        along = np.arange(first, last, 0.5)
        edges.add(LineString(np.c_[street.places(along, -4.0), np.full(len(along), HEIGHT)]), road=0, kind="main", edge="curb", status="measured",
                  part="bottom", chain=1, side="right")
    lines = street.lanes(edges=edges, road_points=_scanned(street))[0]
    lane = np.concatenate([street.offsets(line) for line, row in lines if row["direction"] == 1])
    np.testing.assert_allclose(lane, -1.75, atol=0.04)


def _scanned(street):
    """Points of a road whose right end is the curb, and in the mouth of the side street wherever something stood."""
    s = np.random.default_rng(3).uniform(0, 110, 60_000)
    return _points(street, np.where((s > 48.0) & (s < 67.0), np.where(np.sin(s) > 0, -7.5, -4.7), -4.0), 4.0, s)


def _points(street, right, left, s=None):
    """Points of a road between a left end and the right ends at (N,) stations, m."""
    from lanewright.core.survey.store.records import ROAD_POINT, to_units
    from lanewright.core.survey.store.road_points import RoadPoints
    from lanewright.core.survey.store.section_store import SectionStore

    rng = np.random.default_rng(4)
    s = rng.uniform(0, 110, len(right)) if s is None else s
    d = rng.uniform(-8.0, left, len(right))
    s, d, right = (values[d > right] for values in (s, d, right))
    x, y = street.frame.to_local(*street.places(s, d).T)
    station, offset = street.frame.roads[0].locate(x, y)
    records = np.zeros(len(s), ROAD_POINT)
    for name, values in zip("xyzsd", (x, y, np.full(len(s), HEIGHT - street.frame.origin[2]), station, offset)):
        records[name] = to_units(values)
    records["half_width"] = np.rint(1000 * np.where(offset < 0, np.abs(offset + right - d), np.abs(offset + left - d)))
    points = RoadPoints(SectionStore(ROAD_POINT), street.frame.origin)
    points.store.append(0, records)
    return points


def test_lanes_of_unequal_width_go_on_as_they_are_where_the_line_between_them_is_not_painted():
    street = Street(length=LENGTH, vehicle=-1.85, again=(1.85,)).paint(3.3, kind="edge").paint(-3.9, kind="edge")
    street.paint(0.0, 60.0, 195.0, kind="centre")
    for line, row in street.lanes()[0]:
        np.testing.assert_allclose(street.offsets(line), -1.95 if row["direction"] > 0 else 1.65, atol=0.03)


@pytest.mark.parametrize("room", [2.75, 4.4])
def test_beside_a_centre_line_alone_lanes_reach_as_far_as_the_edge_of_the_pavement_that_is_driven_in_the_middle(room):
    """A country road without edge lines: its asphalt ends at a verge, and the edge was seen but for a stretch."""
    street = Street(length=110.0, vehicle=-room / 2).paint(0.0, kind="centre", pattern="dashed")
    edges = Features("LineStringZ", list(ROAD_EDGES))
    for chain, (side, first, last) in enumerate((("left", 5.0, 105.0), ("right", 5.0, 45.0), ("right", 60.0, 105.0))):
        along = np.arange(first, last, 0.5)
        course = street.places(along, room if side == "left" else -room)
        edges.add(LineString(np.c_[course, np.full(len(along), HEIGHT)]), road=0, kind="main", edge="pavement", status="measured", part="bottom",
                  chain=chain, side=side)
    lines = street.lanes(edges=edges, road_points=_points(street, np.full(60_000, -room), room))[0]
    assert sorted({row["direction"] for row in lines.rows}) == [-1, 1]
    for line, row in lines:
        np.testing.assert_allclose(street.offsets(line), -row["direction"] * room / 2, atol=0.05)


def test_a_lane_goes_on_where_it_is_driven_while_the_line_beside_it_moves_aside_for_a_turning_lane():
    street = Street(length=LENGTH, vehicle=-2.2).paint(0.0, 5.0, 110.0, pattern="dashed").paint(0.0, 130.0, 195.0)
    street.paint(lambda s: 3.0 * np.clip((s - 110.0) / 20.0, 0.0, 1.0), 110.0, 195.0)
    edges, along = Features("LineStringZ", list(ROAD_EDGES)), np.arange(5.0, 195.0, 0.5)
    for chain, left in enumerate((4.4 + 1.6 * np.clip((along - 110.0) / 20.0, 0.0, 1.0), np.full(len(along), -4.4))):
        edges.add(LineString(np.c_[street.places(along, left), np.full(len(along), HEIGHT)]), road=0, kind="main", edge="curb", status="measured",
                  part="bottom", chain=chain, side="right" if chain else "left")
    places = np.concatenate([np.c_[np.asarray(line.coords)[:, 0] - EAST, street.offsets(line)] for line, row in street.lanes(edges=edges)[0]
                             if row["direction"] == 1])
    opening = places[(places[:, 0] > 110.0) & (places[:, 0] < 119.0) & (places[:, 1] < 0.9)]
    assert len(opening) and np.abs(opening[:, 1] + 2.2).max() < 0.15


def test_a_lane_driven_apart_from_its_line_lies_where_it_was_driven_where_the_curb_across_was_not_seen_too():
    street = Street(length=110.0, vehicle=-3.4).paint(0.0)
    edges = Features("LineStringZ", list(ROAD_EDGES))
    for chain, (side, first, last) in enumerate((("left", 5.0, 105.0), ("right", 5.0, 45.0), ("right", 65.0, 105.0))):
        along = np.arange(first, last, 0.5)
        places = street.places(along, 3.6 if side == "left" else -5.2)
        edges.add(LineString(np.c_[places, np.full(len(along), HEIGHT)]), road=0, kind="main", edge="curb", status="measured", part="bottom",
                  chain=chain, side=side)
    ragged = -5.2 + np.random.default_rng(5).uniform(-0.2, 0.2, 60_000)
    driven = [line for line, row in street.lanes(edges=edges, road_points=_points(street, ragged, 3.6))[0] if row["direction"] > 0]
    assert sum(line.length for line in driven) > 95.0
    assert max(np.abs(street.offsets(line) + 3.4).max() for line in driven) < 0.1
