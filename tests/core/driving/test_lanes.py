"""Streets with painted lines, and where one drives on them."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import MARKING_LINES, MARKINGS, ROAD_EDGES, Features
from lanewright.core.driving.alignment import LanesOfRoad, fitted_lanes
from lanewright.core.driving.driving_lines import DrivingSettings
from lanewright.core.driving.heights import road_heights
from lanewright.core.driving.lane_track import MEASURED, LaneTrack
from lanewright.core.execution.in_step import in_step
from lanewright.core.execution.phase import Threads
from lanewright.core.survey.frame.road import Road, reference_nodes
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore
from lined_streets import EAST, HEIGHT, Street, driving_layers, middle
from shapely import force_2d
from shapely.geometry import LineString, Polygon


@pytest.mark.parametrize("change, pattern", [(30.0, "dashed"), (70.0, "double-solid")])
def test_a_lane_beside_a_double_line_that_goes_on_dashed_is_told_by_what_most_of_it_runs_beside(change, pattern):
    street = Street(vehicle=-1.9).paint(3.65).paint(-3.65)
    for side in (0.15, -0.15):
        street.paint(side, 5.0, change, kind="centre", pattern="double-solid")
    lines, _ = street.paint(0.0, change + 4.0, 95.0, kind="centre", pattern="dashed").lanes()
    driven = [row["pattern"] for row in lines.rows if row["direction"] == 1 and row["status"] == "measured"]
    assert driven and set(driven) == {f"{pattern}|solid"}


def test_two_lines_three_and_a_half_metres_apart_give_one_driving_line_in_their_middle():
    street = Street(vehicle=-1.75).paint(0.0).paint(-3.5)
    lines, _ = street.lanes()
    assert len(lines) == 1
    np.testing.assert_allclose(street.offsets(lines.geometries[0]), -1.75, atol=0.005)
    row = lines.rows[0]
    assert (row["status"], row["source"], row["curve"], row["direction"]) == ("measured", "pair", "line", 1)
    assert row["width_m"] == pytest.approx(3.5, abs=0.01)
    assert row["length_m"] == pytest.approx(110.0, abs=0.6)


def test_a_lane_ends_at_the_nearer_line_of_a_double_line():
    street = Street(vehicle=-1.9).paint(3.65).paint(0.15, kind="centre", pattern="double-solid")
    street.paint(-0.15, kind="centre", pattern="double-solid").paint(-3.65)
    lines, _ = street.lanes()
    assert middle(street, lines) == [pytest.approx(-1.9, abs=0.005), pytest.approx(1.9, abs=0.005)]


@pytest.mark.parametrize("worn", [0.0, 3.0])
@pytest.mark.parametrize("onward", [True, False])
def test_where_a_double_line_goes_on_as_one_behind_a_crossing_the_lane_leads_from_its_nearer_line_to_that_one(onward, worn):
    street = Street(vehicle=-1.9)
    ends = (5.0, 50.0), (58.5, 115.0)
    double, single = ends if onward else ends[::-1]
    for side in (0.2, -0.2):
        # the nearer of the two is worn away before the crossing
        short = worn if side > 0 else 0.0
        first, last = (double[0], double[1] - short) if onward else (double[0] + short, double[1])
        street.paint(side, first, last, kind="centre", pattern="double-solid")
    street.paint(0.0, *single, kind="lane", pattern="dashed")
    for side in (3.6, -3.6):
        for first, last, status in ((5.0, 50.0, "measured"), (50.0, 58.5, "bridged"), (58.5, 115.0, "measured")):
            street.paint(side, first, last, kind="edge", status=status, line=10 + (side > 0))
    driving, _ = street.lanes()
    lane = np.concatenate([np.c_[np.asarray(line.coords)[:, 0] - EAST, street.offsets(line)] for line, _ in driving])
    lane = lane[lane[:, 1] > 0]
    share = np.clip((lane[:, 0] - 50.0) / 8.5, 0.0, 1.0)
    true = np.where(onward, 1.9 - 0.1 * share, 1.8 + 0.1 * share)
    assert np.abs(lane[:, 1] - true).max() < 0.03


def test_a_driving_line_says_which_lines_one_may_not_cross_on_its_left_and_right():
    """Left and right of travel: the lane that is driven the other way has the same dashes on its left."""
    street = Street(vehicle=-1.75, again=(1.75,)).paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")
    lines, _ = street.lanes()
    assert [(row["direction"], row["pattern"]) for row in lines.rows] == [(1, "dashed|solid"), (-1, "dashed|solid")]


def test_where_a_lane_has_one_line_only_the_other_side_is_none():
    lines, _ = Street(vehicle=-1.6).paint(0.0, kind="centre", pattern="dashed").lanes(line_distance=1.6)
    assert lines.rows[0]["pattern"] == "dashed|none"


def test_lines_of_a_bend_give_the_arc_between_them_about_the_same_centre():
    street = Street(length=90.0, radius=100.0, vehicle=-1.75).paint(0.0).paint(-3.5)
    lines, elements = street.lanes()
    assert len(lines) == len(elements) == 1
    np.testing.assert_allclose(street.offsets(lines.geometries[0]), -1.75, atol=0.005)
    assert lines.rows[0]["curve"] == "circle"
    assert lines.rows[0]["radius_m"] == pytest.approx(101.75, rel=1e-3)
    assert elements.rows[0]["radius_m"] == pytest.approx(101.75, rel=1e-3)
    assert elements.rows[0]["turn"] == "left"


def test_outer_lines_seven_metres_apart_give_two_inferred_lanes():
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(-3.5, kind="edge")
    lines, _ = street.lanes()
    assert [row["status"] for row in lines.rows] == ["inferred"] * 2
    assert middle(street, lines) == [pytest.approx(-1.75, abs=0.005), pytest.approx(1.75, abs=0.005)]
    assert [row["direction"] for row in lines.rows] == [1, -1]


@pytest.mark.parametrize("lane_width, lanes", [(3.5, 3), (2.6, 4), (4.9, 2)])
def test_the_number_of_inferred_lanes_follows_from_the_lane_width(lane_width, lanes):
    street = Street(vehicle=-5.0 + 5.0 / lanes).paint(5.0).paint(-5.0)
    lines, _ = street.lanes(lane_width=lane_width)
    assert len(lines) == lanes


def test_a_row_of_parking_places_outside_the_edge_line_is_no_lane_unless_it_is_driven_on():
    def street(vehicle):
        street = Street(vehicle=vehicle).paint(0.0).paint(-3.5, kind="edge").paint(-5.9, kind="edge")
        return middle(street, street.lanes()[0])

    assert street(vehicle=-1.75) == [pytest.approx(-1.75, abs=0.01)]
    assert street(vehicle=-4.7) == [pytest.approx(-4.7, abs=0.01), pytest.approx(-1.75, abs=0.01)]


def test_a_verge_between_two_carriageways_is_no_pair_of_lanes():
    street = Street(vehicle=-1.75).paint(0.0).paint(-3.5).paint(7.0).paint(10.5)
    lines, _ = street.lanes()
    assert middle(street, lines) == [pytest.approx(-1.75, abs=0.01), pytest.approx(8.75, abs=0.01)]


def test_a_zebra_gap_is_bridged_and_flagged_and_the_pieces_touch():
    street = Street(vehicle=-1.75)
    for first, last in ((5, 55), (67, 115)):
        street.paint(0.0, first, last).paint(-3.5, first, last)
    lines, _ = street.lanes()
    assert [row["status"] for row in lines.rows] == ["measured", "bridged", "measured"]
    assert len({row["lane"] for row in lines.rows}) == 1
    for one, two in zip(lines.geometries, lines.geometries[1:]):
        assert one.coords[-1] == two.coords[0]
    np.testing.assert_allclose(street.offsets(lines.geometries[1]), -1.75, atol=0.01)
    assert lines.rows[1]["station_m"] == pytest.approx(55, abs=0.6) and lines.rows[1]["end_m"] == pytest.approx(67, abs=0.6)


def test_a_bridge_through_a_bend_follows_the_bend():
    street = Street(length=90.0, radius=60.0, vehicle=-1.75)
    for first, last in ((5, 38), (54, 85)):
        street.paint(0.0, first, last).paint(-3.5, first, last)
    lines, _ = street.lanes()
    assert [row["status"] for row in lines.rows] == ["measured", "bridged", "measured"]
    np.testing.assert_allclose(street.offsets(lines.geometries[1]), -1.75, atol=0.02)


def test_a_junction_longer_than_a_bridge_stays_open():
    street = Street(length=150.0, vehicle=-1.75)
    for first, last in ((5, 55), (85, 145)):
        street.paint(0.0, first, last).paint(-3.5, first, last)
    lines, _ = street.lanes()
    assert [row["status"] for row in lines.rows] == ["measured", "measured"]
    assert len({row["lane"] for row in lines.rows}) == 2


def test_a_lane_that_splits_behind_a_crossing_is_not_bridged_across():
    street = Street(vehicle=-2.4).paint(0.0, 5, 55).paint(-4.8, 5, 55)
    street.paint(0.0, 67, 115).paint(-2.4, 67, 115).paint(-4.8, 67, 115)
    lines, _ = street.lanes()
    assert [row["status"] for row in lines.rows] == ["measured"] * 3
    assert sorted(middle(street, lines)) == [pytest.approx(d, abs=0.01) for d in (-3.6, -2.4, -1.2)]


@pytest.mark.parametrize("status", ["measured", "bridged"])
def test_outer_lines_that_lead_past_a_split_do_not_lead_the_lane_into_it(status):
    street = Street(vehicle=-2.4).paint(0.0, 5, 55).paint(0.0, 67, 115)
    street.paint(-4.8, 5, 55, line=9).paint(-4.8, 55, 67, line=9, status=status).paint(-4.8, 67, 115, line=9)
    street.paint(-2.4, 67, 115)
    lines, _ = street.lanes()
    before, behind = ([row for row in lines.rows if (row["station_m"] > 66.0) == late] for late in (False, True))
    assert {round(row["offset_m"], 1) for row in behind} == {1.2, -1.2}
    assert len({row["lane"] for row in before}) == 1 and not {row["lane"] for row in before} & {row["lane"] for row in behind}


def test_where_the_centre_line_pauses_the_lanes_go_on_beside_the_edge_lines():
    street = Street(vehicle=-1.75, length=160.0).paint(3.5).paint(-3.5)
    street.paint(0.0, 5, 60).paint(0.0, 100, 155)
    lines, _ = street.lanes()
    by_lane = {}
    for line, row in lines:
        by_lane.setdefault(row["lane"], []).append(row["status"])
        np.testing.assert_allclose(np.abs(street.offsets(line)), 1.75, atol=0.01)
    assert list(by_lane.values()) == [["measured", "inferred", "measured"]] * 2


def test_a_lane_narrows_where_its_line_comes_nearer():
    street = Street(vehicle=-1.75).paint(0.0).paint(lambda s: -4.5 + np.clip((s - 40) / 40, 0, 1))
    lines, _ = street.lanes()
    assert len(lines) == 1
    offsets = street.offsets(lines.geometries[0])
    assert offsets[0] == pytest.approx(-2.25, abs=0.02) and offsets[-1] == pytest.approx(-1.75, abs=0.02)


def test_the_stroke_of_a_symbol_does_not_cut_a_lane_in_two():
    street = Street(vehicle=-1.2).paint(0.0).paint(-3.5).paint(-1.8, 40, 45)
    lines, _ = street.lanes()
    assert len(lines) == 1
    np.testing.assert_allclose(street.offsets(lines.geometries[0]), -1.75, atol=0.01)


def test_beside_a_centre_line_alone_there_is_a_lane_each_way_at_the_distance_asked_for():
    street = Street(vehicle=-1.6).paint(0.0, kind="centre", pattern="dashed")
    lines, _ = street.lanes(line_distance=1.6)
    assert middle(street, lines) == [pytest.approx(-1.6, abs=0.005), pytest.approx(1.6, abs=0.005)]
    assert [row["source"] for row in lines.rows] == ["offset"] * 2
    assert [row["direction"] for row in lines.rows] == [1, -1]


def test_beside_a_centre_line_between_curbs_one_drives_in_the_middle_of_what_the_curb_leaves():
    street = Street(vehicle=-1.5).paint(0.0, kind="centre", pattern="dashed")
    edges = Features("LineStringZ", ROAD_EDGES)
    for side, offset in (("left", 3.0), ("right", -4.4)):
        # a driveway parts the curb
        for s in (np.arange(0.0, 50.0), np.arange(60.0, 120.0)):
            edges.add(LineString(np.c_[street.places(s, offset), np.full(len(s), HEIGHT)]), road=0, side=side)
    lines, _ = street.lanes(edges=edges)
    # a lane is no broader for the parking places beside it
    for line, row in lines:
        np.testing.assert_allclose(street.offsets(line), {1: -1.5, -1: 1.5}[row["direction"]], atol=0.05)
    assert {(row["lane"], row["status"], row["direction"]) for row in lines.rows} == {(1, "inferred", 1), (2, "inferred", -1)}
    for line, row in street.lanes(edges=edges, line_distance=1.6)[0]:
        np.testing.assert_allclose(street.offsets(line), -1.6 * row["direction"], atol=0.01)


def test_lanes_are_no_surer_for_what_their_lines_were_named_since_the_same_evidence_named_them():
    def confidences(kind):
        street = Street(vehicle=-1.75).paint(3.5).paint(0.0, kind=kind, pattern="dashed").paint(-3.5)
        for row in street.lines.rows:
            row["rmse_m"] = 0.01   # as of a line that was fitted
        return [row["confidence"] for row in street.lanes()[0].rows]

    assert confidences("centre") == confidences("lane")


def test_beyond_the_edge_line_nobody_drives():
    street = Street(vehicle=-1.75).paint(0.0, kind="edge").paint(-3.5, kind="edge")
    lines, _ = street.lanes()
    assert len(lines) == 1


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_a_short_strip_outside_an_edge_line_does_not_become_a_long_lane(side):
    """At a lowered curb its bright face may look like one more edge line."""
    street = Street(vehicle=-1.75 * side).paint(0.0, kind="centre", pattern="dashed")
    for away in (3.5, -3.5):
        street.paint(away, kind="edge")
    street.paint(-3.5 * side - 3.2 * side, first=50.0, last=62.0, kind="edge")
    found, _ = street.lanes(traffic_side="right" if side > 0 else "left")
    outside = sum(line.length for line, _ in found if np.median(np.abs(street.offsets(line))) > 3.5)
    assert outside <= 12.5


def test_no_lane_runs_along_a_curb_or_over_a_hatched_area():
    street = Street(vehicle=-1.75).paint(0.0).paint(-3.5).paint(3.5)
    assert len(street.lanes()[0]) == 2
    edges = Features("LineStringZ", ROAD_EDGES)
    edges.add(LineString(np.c_[street.places(np.arange(0.0, 120.0), 1.5), np.full(120, HEIGHT)]), road=0, side="left")
    np.testing.assert_allclose(middle(street, street.lanes(edges=edges)[0]), -1.75, atol=0.01)
    stripes = Features("PolygonZ", MARKINGS)
    for s in range(5, 115, 2):
        corners = street.places([s, s + 1, s + 1, s], [0.3, 0.3, 3.2, 3.2])
        stripes.add(Polygon(np.c_[corners, np.full(4, HEIGHT)]), **{"road": 0, "class": "hatch", "use": "other"})
    assert middle(street, street.lanes(markings=stripes)[0]) == [pytest.approx(-1.75, abs=0.01)]


def test_neither_the_order_of_rows_nor_the_drawing_of_lines_changes_the_result():
    street = Street(length=90.0, radius=100.0, vehicle=-1.75)
    for first, last in ((5, 38), (48, 85)):
        street.paint(3.5, first, last).paint(0.0, first, last, pattern="dashed").paint(-3.5, first, last)
    lines, _ = street.lanes()
    turned = Features("LineStringZ", MARKING_LINES, [line.reverse() for line in street.lines.geometries[::-1]],
                      street.lines.rows[::-1])
    again, _ = driving_layers(turned, street.frame)
    assert [dict(row) for row in again.rows] == [dict(row) for row in lines.rows]
    for one, two in zip(lines.geometries, again.geometries):
        np.testing.assert_allclose(np.asarray(one.coords), np.asarray(two.coords), atol=1e-6)


def test_lines_drawn_by_hand_with_no_fields_at_all_serve_too():
    street = Street(vehicle=-1.75).paint(0.0).paint(-3.5)
    bare = Features("LineStringZ", MARKING_LINES, [LineString([line.coords[0], line.coords[-1]])
                                                   for line in street.lines.geometries], [{}, {}])
    lines, _ = driving_layers(bare, street.frame)
    assert middle(street, lines) == [pytest.approx(-1.75, abs=0.005)]


def test_flat_lines_without_road_points_take_the_trajectory_s_height():
    street = Street(vehicle=-1.75).paint(0.0).paint(-3.5)
    flat = Features("LineStringZ", MARKING_LINES, [force_2d(line) for line in street.lines.geometries], street.lines.rows)
    lines, _ = driving_layers(flat, street.frame)
    np.testing.assert_allclose(np.asarray(lines.geometries[0].coords)[:, 2], HEIGHT + 2.5, atol=1e-6)


def scanned(street, count, section_length=5.0, left=0.5, right=-4.0):
    """Points of a road that rises by 2 %, with 5 mm of noise."""
    rng = np.random.default_rng(3)
    s, d = rng.uniform(0, 120, count), rng.uniform(right, left, count)
    x, y = street.frame.to_local(*street.places(s, d).T)
    records = np.zeros(len(s), ROAD_POINT)
    station, offset = street.frame.roads[0].locate(x, y)
    z = HEIGHT - street.frame.origin[2] + 0.02 * s + rng.normal(0, 0.005, len(s))
    for name, values in zip("xyzsd", (x, y, z, station, offset)):
        records[name] = to_units(values)
    points = RoadPoints(SectionStore(ROAD_POINT, section_length), street.frame.origin)
    points.store.append(0, records)
    return points


def test_height_is_the_road_s_own_where_it_was_scanned():
    street = Street(vehicle=-1.75).paint(0.0, z=HEIGHT + 0.3).paint(-3.5, z=HEIGHT + 0.3)
    lines, _ = street.lanes(road_points=scanned(street, 20_000))
    x, _, z = np.asarray(lines.geometries[0].coords).T
    np.testing.assert_allclose(z, HEIGHT + 0.02 * (x - 500_000.0), atol=0.01)
    lines, _ = street.lanes()
    np.testing.assert_allclose(np.asarray(lines.geometries[0].coords)[:, 2], HEIGHT + 0.3, atol=1e-6)


def test_among_crowded_points_height_is_known_to_the_millimetre_wherever_sections_end():
    street = Street(vehicle=-1.75).paint(0.0).paint(-3.5)
    crowded = [street.lanes(road_points=scanned(street, 600_000, length, -1.25, -2.25))[0].geometries[0] for length in (5.0, 7.3)]
    (x, _, z), (_, _, other) = (np.asarray(line.coords).T for line in crowded)
    np.testing.assert_array_equal(z, other)
    inner = (x > x[0] + 5.0) & (x < x[-1] - 5.0)
    np.testing.assert_allclose(z[inner], HEIGHT + 0.02 * (x[inner] - 500_000.0), atol=0.001)


def test_lanes_of_two_roads_get_their_own_heights_in_one_phase(monkeypatch):
    points, phases, run = scanned(Street(vehicle=-1.75), 100_000), [], Threads.run
    higher = points.all_points().records.copy()
    higher["z"] += to_units(1.0)
    points.store.append(1, higher)
    monkeypatch.setattr(Threads, "run", lambda self, phase, *others: phases.append(phase.function.__name__) or run(self, phase, *others))
    s, count = np.arange(20.0, 100.0, 0.5), 160
    track = LaneTrack(0, np.full(count, -1.75), np.full(count, 3.5), np.full(count, MEASURED), np.zeros(count, bool),
                      *[np.full(count, -1)] * 4, *[np.ones(count)] * 2, 1)
    ((low,), (high,)), = in_step([road_heights(points, [(0, s, [track]), (1, s, [track])])], Threads(1))
    np.testing.assert_allclose(high - low, 1.0, atol=1e-4)
    assert phases == ["heights_of_windows"]


def test_a_street_without_paint_has_no_driving_lines_and_says_so():
    street = Street()
    lines, elements = street.lanes()
    assert len(lines) == len(elements) == 0


@pytest.mark.parametrize("wrong", [dict(lane_width=9.0), dict(line_distance=-1.0), dict(traffic_side="middle"),
                                   dict(max_bridge=-1.0)])
def test_settings_out_of_range_are_refused_in_a_sentence(wrong):
    with pytest.raises(RoadExtractionError, match="must|Choose|are"):
        DrivingSettings(**wrong)


def test_a_lane_ends_where_its_edge_line_ends_though_the_centre_line_goes_on_a_little():
    street = Street(vehicle=-1.75).paint(3.5, 5.0, 43.6, kind="edge").paint(0.0, 5.0, 44.7).paint(-3.5, 5.0, 43.6, kind="edge")
    lines, _ = street.lanes()
    assert max(row["end_m"] for row in lines.rows) == pytest.approx(43.6, abs=0.6)


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("last", [92.5, 93.0])
def test_lanes_of_different_widths_keep_them_where_the_lines_between_them_end(last, backwards):
    street = Street(vehicle=0.0, backwards=backwards).paint(-2.0, last=100.0, kind="edge").paint(8.5, last=100.0, kind="edge")
    street.paint(2.0, first=30.0, last=last, kind="centre").paint(5.25, first=30.0, last=last)
    lines, _ = street.lanes()
    for lane in (0.0, 3.625, 6.875):
        offsets = np.concatenate([street.offsets(line)[np.asarray(line.coords)[:, 0] > EAST + 80.0] for line, _ in lines
                                  if abs(np.median(street.offsets(line)) - lane) < 0.5])
        assert np.abs(offsets - lane).max() < 0.05


def test_a_lane_goes_on_behind_where_its_road_crosses_itself():
    """A ramp leads around three quarters of a circle and over the road that it comes from."""
    bends = (0.0, 80.0), (1 / 25, 37.5 * np.pi), (0.0, 80.0)
    heading = np.cumsum(np.concatenate([np.full(int(length / 0.05), 0.05 * bend) for bend, length in bends]))
    x, y = 0.05 * np.cumsum(np.cos(heading))[::10], 0.05 * np.cumsum(np.sin(heading))[::10]
    road = Road(0, *reference_nodes(np.c_[x, y]), 0.0)
    s = np.arange(20.0, 270.0, 0.5)
    count = len(s)
    track = LaneTrack(0, np.full(count, -1.6), np.full(count, 3.0), np.full(count, MEASURED), np.zeros(count, bool), *[np.full(count, -1)] * 4,
                      *[np.ones(count)] * 2, 1)
    ((courses,), _), = in_step([fitted_lanes([LanesOfRoad([track], s, road)])], Threads(1))[0]
    assert courses.s[[0, -1]] == pytest.approx(s[[0, -1]], abs=0.5) and np.diff(courses.s).max() < 2.0
