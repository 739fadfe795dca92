"""Which lanes streets of other kinds have, and which way they lead."""

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, ROAD_EDGES, Features
from lanewright.core.common.progress import Progress
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.simulator.parts.paint import straight_arrow
from lined_streets import EAST, HEIGHT, Street
from shapely.geometry import LineString, Polygon


def lanes_of(street, **inputs):
    """{offset of the middle: direction} of the lanes, by most of their length."""
    lines, _ = street.lanes(**inputs)
    length, found = {}, {}
    for line, row in lines:
        length.setdefault(row["lane"], []).append((line.length, round(float(np.median(street.offsets(line))), 2), row["direction"]))
    for parts in length.values():
        if sum(part[0] for part in parts) > 25.0:
            _, offset, direction = max(parts)
            found[offset] = direction
    return found


def area(street, first, last, right, left, kind):
    """A marking between stations and offsets, as a row of the layer."""
    corners = street.places([first, last, last, first], [right, right, left, left])
    return Polygon(np.c_[corners, np.full(4, HEIGHT)]), {"road": 0, "class": kind, "use": "other"}


def outlined(street, *shapes):
    """Markings of outlines, (n, 2) m of station and offset, each with its class."""
    layer = Features("PolygonZ", MARKINGS)
    for outline, kind in shapes:
        places = street.places(*outline.T)
        layer.add(Polygon(np.c_[places, np.full(len(places), HEIGHT)]), **{"road": 0, "class": kind, "use": "other"})
    return layer


def painted(street, *areas):
    layer = Features("PolygonZ", MARKINGS)
    for one in areas:
        shape, row = area(street, *one)
        layer.add(shape, **row)
    return layer


def curbs(street, *offsets):
    """The layer of road edges with curbs along the street, each at an offset or a function of station."""
    edges = Features("LineStringZ", list(ROAD_EDGES))
    along = np.arange(5.0, 115.0, 0.5)
    for chain, where in enumerate(offsets):
        offset = where(along) if callable(where) else np.full(len(along), where)
        edges.add(LineString(np.c_[street.places(along, offset), np.full(len(along), HEIGHT)]), road=0, kind="main", edge="curb", status="measured",
                  part="bottom", chain=chain, side="left" if offset[0] > 0 else "right")
    return edges


@pytest.mark.parametrize("width", [5.8, 7.0])
def test_a_broad_lane_driven_in_its_middle_with_arrows_there_is_one_lane(width):
    street = Street(vehicle=0.0).paint(width / 2, kind="edge").paint(-width / 2, kind="edge")
    arrows = painted(street, *((s, s + 5.0, -0.3, 0.3, "arrow") for s in (20.0, 50.0, 80.0)))
    assert lanes_of(street, markings=arrows) == {0.0: 1}


def test_the_same_seven_metres_driven_beside_the_middle_are_two_lanes_against_each_other():
    assert lanes_of(Street(vehicle=-1.75).paint(3.5, kind="edge").paint(-3.5, kind="edge")) == {-1.75: 1, 1.75: -1}


def test_a_centre_line_parts_the_directions_even_with_lanes_painted_on_one_side_only():
    street = Street(vehicle=-1.75).paint(0.15, pattern="double-solid", kind="centre").paint(-0.15, pattern="double-solid", kind="centre")
    street.paint(-3.65, pattern="dashed").paint(-7.15, kind="edge")
    found = lanes_of(street)
    assert sorted(offset for offset in found if offset < 0) == [pytest.approx(-5.4, abs=0.02), pytest.approx(-1.9, abs=0.02)]
    assert all(way == (1 if offset < 0 else -1) for offset, way in found.items())


def test_a_centre_line_worn_away_over_sixty_metres_still_parts_the_lanes():
    street = Street(length=200.0, vehicle=-1.75).paint(3.5, kind="edge").paint(-3.5, kind="edge")
    street.paint(0.0, 5.0, 70.0, kind="centre").paint(0.0, 130.0, 195.0, kind="centre")
    lines, _ = street.lanes()
    assert {row["direction"] for row in lines.rows} == {1, -1}
    for line, row in lines:
        np.testing.assert_allclose(street.offsets(line), -1.75 * row["direction"], atol=0.02)
    assert sum(line.length for line, row in lines) == pytest.approx(2 * 190.0, abs=3.0)


def test_no_lane_leads_over_the_hatched_island_between_two_directions():
    street = Street(vehicle=-3.5)
    for offset in (5.25, -5.25):
        street.paint(offset, kind="edge")
    for offset in (1.75, -1.75):
        street.paint(offset)
    bars = painted(street, *((s, s + 0.5, -1.6, 1.6, "hatch") for s in np.arange(6.0, 114.0, 2.0)))
    assert lanes_of(street, markings=bars) == {-3.5: 1, 3.5: -1}


def test_lanes_keep_their_width_past_hatching_half_a_metre_either_side_of_a_line_that_goes_on_behind_it():
    street = Street(vehicle=-1.75, again=(1.75,))
    for number, offset in enumerate((3.5, -3.5, 0.0), start=1):
        for first, last in ((5.0, 115.0),) if offset else ((5.0, 46.0), (74.0, 115.0)):
            street.paint(offset, first, last, kind="edge" if offset else "centre", line=number)
    bars = painted(street, *((s, s + 0.5, -0.5, 0.5, "hatch") for s in np.arange(47.0, 73.0, 1.5)))
    lines = list(street.lanes(markings=bars)[0])
    for way in (1, -1):
        parts = [line for line, row in lines if row["direction"] == way]
        assert sum(line.length for line in parts) == pytest.approx(110.0, abs=1.0)
        assert max(np.abs(street.offsets(line) + 1.75 * way).max() for line in parts) < 0.02


def test_the_exit_lane_of_a_carriageway_goes_the_way_of_the_others():
    street = Street(length=160.0, vehicle=-1.9).paint(3.75, kind="edge").paint(0.0, pattern="dashed")
    street.paint(-3.75, 5.0, 60.0, kind="edge").paint(-3.75, 60.0, 155.0, pattern="dashed").paint(-7.4, 60.0, 155.0, kind="edge")
    found = lanes_of(street)
    assert {offset for offset in found if offset < -5.0} and all(found[offset] == 1 for offset in found if offset < 0)


def test_traffic_is_never_on_the_side_that_the_drive_speaks_against():
    """The vehicle drove east at first right and later, in another pass, west on the other side."""
    for vehicle, ways in ((-1.75, {-1.75: 1, 1.75: -1}), (1.75, {-1.75: -1, 1.75: 1})):
        street = Street(vehicle=vehicle, again=(-vehicle,)).paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")
        assert lanes_of(street) == ways


def test_a_mirrored_street_has_its_lanes_mirrored():
    def street(side):
        made = Street(length=160.0, vehicle=-1.75 * side)
        made.paint(3.5 * side, kind="edge").paint(0.0, pattern="dashed").paint(-3.5 * side, kind="edge")
        return made.paint(-6.5 * side, 60.0, 120.0, kind="edge")

    assert {-offset: -way for offset, way in lanes_of(street(1)).items()} == {offset: -way for offset, way in lanes_of(street(-1)).items()}


def test_a_carriageway_beside_one_that_was_driven_the_other_way_is_one_way():
    """Dashes between two edge lines part the directions of a road alone; here the other direction has a carriageway of its own."""
    def street(**other):
        return Street(vehicle=-1.75, **other).paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")

    assert lanes_of(street()) == {-1.75: 1, 1.75: -1}
    assert lanes_of(street(again=(16.0,))) == {-1.75: 1, 1.75: 1}


@pytest.mark.parametrize("way", [1, -1])
def test_arrows_tell_which_way_a_lane_between_two_solid_lines_leads(way):
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0).paint(-3.5, kind="edge")
    arrows = [(straight_arrow(station, 1.75, way), "arrow") for station in (25.0, 60.0, 95.0)]
    assert lanes_of(street) == {-1.75: 1, 1.75: -1}
    assert lanes_of(street, markings=outlined(street, *arrows)) == {-1.75: 1, 1.75: way}


def test_arrows_that_point_against_the_drive_do_not_turn_it():
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0).paint(-3.5, kind="edge")
    arrows = [(straight_arrow(station, -1.75, -1), "arrow") for station in (25.0, 60.0, 95.0)]
    assert lanes_of(street, markings=outlined(street, *arrows))[-1.75] == 1


@pytest.mark.parametrize("way", [1, -1])
def test_arrows_against_the_drive_still_tell_which_lanes_lead_alike(way):
    """As where the times of a trajectory run backwards: lanes lead as it says, so the others lead as their arrows say, turned round."""
    street = Street(vehicle=-3.5).paint(5.25, kind="edge").paint(1.75).paint(-1.75).paint(-5.25, kind="edge")
    arrows = outlined(street, *((straight_arrow(station, offset, -1 if offset < -1 else -way), "arrow") for station in (25.0, 60.0, 95.0)
                                for offset in (-3.5, 0.0)))
    assert lanes_of(street, markings=arrows) == {-3.5: 1, 0.0: way, 3.5: -1}
    said, progress = [], Progress()
    progress.warn = said.append
    make_driving_lines(PaintedLines.from_features(street.lines, street.frame), street.frame, progress=progress,
                       markings=MarkingObjects.from_features(arrows, street.frame))
    assert "against the arrows" in " ".join(said)


def test_one_arrow_against_the_drive_is_taken_for_misread():
    street = Street(vehicle=-3.5).paint(5.25, kind="edge").paint(1.75).paint(-1.75).paint(-5.25, kind="edge")
    arrows = outlined(street, (straight_arrow(60.0, -3.5, -1), "arrow"), *((straight_arrow(station, 0.0, -1), "arrow") for station in (25.0, 95.0)))
    assert lanes_of(street, markings=arrows) == {-3.5: 1, 0.0: -1, 3.5: -1}


def test_a_stop_line_across_two_lanes_says_that_they_lead_one_way():
    street = Street(length=40.0, vehicle=-1.75).paint(3.5, kind="edge").paint(0.0).paint(-3.5, kind="edge")
    assert lanes_of(street) == {-1.75: 1, 1.75: -1}
    assert lanes_of(street, markings=painted(street, (34.0, 34.5, -3.4, 3.4, "stop"))) == {-1.75: 1, 1.75: 1}
    # before its own lane alone it says nothing of the other
    assert lanes_of(street, markings=painted(street, (34.0, 34.5, -3.4, -0.1, "stop"))) == {-1.75: 1, 1.75: -1}


@pytest.mark.parametrize("before", [0.5, 8.0])
@pytest.mark.parametrize("mirror", [1, -1])
def test_of_three_lanes_parted_by_dashes_alone_those_that_a_stop_line_crosses_lead_up_to_it_and_no_other(mirror, before):
    """Driven in the middle one. The last dash ends half a metre before the stop line, or as far as a gap is long."""
    street = Street(vehicle=0.0).paint(5.25, kind="edge").paint(-5.25, kind="edge")
    for offset in (1.75, -1.75):
        street.paint(offset, last=108.0 - before, kind="", pattern="dashed")
    side = {"traffic_side": "right" if mirror > 0 else "left"}
    two, three = (painted(street, (108.0, 108.5, *sorted(np.multiply(mirror, ends)), "stop")) for ends in ((-5.1, 1.7), (-5.1, 5.1)))
    assert lanes_of(street, markings=two, **side) == {-3.5 * mirror: 1, 0.0: 1, 3.5 * mirror: -1}
    assert lanes_of(street, markings=three, **side) == {-3.5 * mirror: 1, 0.0: 1, 3.5 * mirror: 1}


@pytest.mark.parametrize("edge", [4.8, 5.6])
def test_the_curbs_of_an_island_bound_the_lanes_beside_it(edge):
    """Two lanes without a line between, and along them an island of 2.6 m whose line goes round it and closes.

    Lanes have all the room beside it, 3.5 m as usual or, as where one enters a roundabout, 4.3 m, and are as sure as between lines.
    """
    street = Street(vehicle=-3.0, again=(3.0,)).paint(edge, kind="edge").paint(-edge, kind="edge")
    along = np.arange(4.0, 116.25, 0.25)
    ring = street.places(np.r_[along, along[::-1], along[0]], np.r_[np.full(len(along), 1.3), np.full(len(along), -1.3), 1.3])
    edges = Features("LineStringZ", list(ROAD_EDGES))
    edges.add(LineString(np.c_[ring, np.full(len(ring), HEIGHT)]), road=0, kind="island", edge="curb", status="measured", part="bottom", chain=1)
    beside = {}
    for line, row in street.lanes(edges=edges)[0]:
        east = np.asarray(line.coords)[:, 0] - EAST
        beside.setdefault(row["direction"], []).extend(street.offsets(line)[(east > 10.0) & (east < 110.0)])
        assert row["confidence"] > 0.9
    for way in (1, -1):
        np.testing.assert_allclose(beside[way], -(edge + 1.3) / 2 * way, atol=0.03)


def test_painted_lanes_are_sure():
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, pattern="double-solid", kind="centre").paint(-3.5, kind="edge")
    assert min(row["confidence"] for row in street.lanes()[0].rows) > 0.9


def test_a_middle_lane_that_may_lead_either_way_is_said_to_do_so_with_a_confidence_of_one_half():
    """Dashes on both of its sides, and the lanes beside it driven one way each: where it lies is sure, where it leads is not."""
    street = Street(vehicle=-3.5, again=(3.5,)).paint(5.25, kind="edge").paint(-5.25, kind="edge")
    for border in (1.75, -1.75):
        street.paint(border, pattern="dashed")
    outer, middle = [], []
    for line, row in street.lanes()[0]:
        (middle if abs(np.median(street.offsets(line))) < 1.0 else outer).append(row["confidence"])
    assert len(outer) == 2 and min(outer) > 0.9
    assert middle and 0.3 < min(middle) and max(middle) < 0.6


def test_a_lane_is_no_less_sure_for_the_ways_to_read_what_lies_beside_the_road():
    """A centre line between two curbs: with one lane less there is one strip more that nobody drives on, which can be told in two ways."""
    street = Street(vehicle=-1.75, again=(1.75,)).paint(0.0, pattern="dashed", kind="centre")
    said = {row["direction"]: row["confidence"] for row in street.lanes(edges=curbs(street, 3.2, -3.2))[0].rows}
    assert said[1] > 0.93 and said[-1] > 0.93


@pytest.mark.parametrize("half, vehicle, lanes", [(2.25, 0.0, {0.0: 1}), (1.6, 0.0, {0.0: 1}), (3.2, -1.6, {-1.6: 1, 1.6: -1})])
def test_a_street_that_was_driven_between_two_curbs_has_lanes_without_any_paint(half, vehicle, lanes):
    street = Street(vehicle=vehicle)
    assert lanes_of(street, edges=curbs(street, half, -half)) == lanes
    rows = street.lanes(edges=curbs(street, half, -half))[0].rows
    assert all(row["confidence"] <= 0.6 for row in rows) == (half > 2.2), "where two lanes have no room it is one for sure"


@pytest.mark.parametrize("way", [1, -1])
def test_without_paint_lanes_lie_where_they_were_driven_and_not_where_a_street_that_widens_would_share_its_room_evenly(way):
    street = Street(vehicle=-1.75, again=(1.75,))
    edges = curbs(street, *(lambda s, side=side: side * (3.5 + (side == way) * 2.0 * np.clip((s - 40.0) / 30.0, 0.0, 1.0)) for side in (1, -1)))
    lines = list(street.lanes(edges=edges)[0])
    for side in (1, -1):
        parts = [line for line, row in lines if row["direction"] == -side]
        assert sum(line.length for line in parts) == pytest.approx(110.0, abs=2.0)
        assert max(np.abs(street.offsets(line) - 1.75 * side).max() for line in parts) < 0.15


@pytest.mark.parametrize("left", [0.75, 1.65])
def test_without_paint_a_street_is_shared_evenly_unless_it_was_driven_far_from_that(left):
    street = Street(vehicle=-1.65, again=(left,))
    places = [(row["direction"], np.abs(street.offsets(line) - (left if row["direction"] < 0 else -1.65)).max())
              for line, row in street.lanes(edges=curbs(street, 3.3, -3.3))[0]]
    assert {way for way, _ in places} == {1, -1} and max(off for _, off in places) < 0.1


def test_one_lane_between_two_curbs_lies_in_their_middle_though_the_drive_was_not_quite_there():
    street = Street(vehicle=0.12)
    lines = list(street.lanes(edges=curbs(street, 2.2, -2.2))[0])
    assert lines and max(np.abs(street.offsets(line)).max() for line, _ in lines) < 0.02


def test_lanes_go_on_between_the_curbs_where_the_paint_stops():
    street = Street(vehicle=-1.75).paint(0.0, 5.0, 60.0, pattern="dashed")
    lines, _ = street.lanes(edges=curbs(street, 3.5, -3.5))
    for way in (1, -1):
        parts = [line for line, row in lines if row["direction"] == way]
        assert sum(line.length for line in parts) == pytest.approx(110.0, abs=2.0)
        assert max(np.abs(street.offsets(line) + 1.75 * way).max() for line in parts) < 0.05


def beside_lines_and_curbs(last, left, right):
    """Lanes of a street with dashes up to station `last` between two curbs: {direction: [(offset and station of its vertices)]}."""
    street = Street(vehicle=-1.75).paint(0.0, 5.0, last, pattern="dashed")
    found = {}
    for line, row in street.lanes(edges=curbs(street, left, right))[0]:
        found.setdefault(row["direction"], []).append(np.c_[street.offsets(line), np.asarray(line.coords)[:, 0] - EAST])
    return {way: np.concatenate(places) for way, places in found.items()}


@pytest.mark.parametrize("last", [98.0, 104.0, 108.0])
def test_where_the_paint_stops_some_metres_before_the_curbs_do_its_lanes_go_on_between_these(last):
    lanes = beside_lines_and_curbs(last, 3.5, -3.5)
    assert {way: places[:, 1].max() for way, places in lanes.items()} == {1: pytest.approx(114.5, abs=0.6), -1: pytest.approx(114.5, abs=0.6)}
    assert all(np.abs(places[:, 0] + 1.75 * way).max() < 0.05 for way, places in lanes.items())


@pytest.mark.parametrize("side", [1, -1])
def test_beyond_a_stop_line_lanes_lead_up_to_where_the_curb_bends_into_the_side_street(side):
    bent, straight = lambda s: side * (3.5 + np.where(s > 106.0, 6.0 - np.sqrt(np.maximum(36.0 - (s - 106.0) ** 2, 0.0)), 0.0)), -3.5 * side
    lanes = beside_lines_and_curbs(100.0, *((bent, straight) if side > 0 else (straight, bent)))
    assert all(106.0 < places[:, 1].max() < 109.0 for places in lanes.values()) and len(lanes) == 2


@pytest.mark.parametrize("borders", [(-3.5,), (lambda station: 7.0 - 0.15 * np.clip(station - 95.0, 0.0, 20.0), -3.5)])
def test_beyond_the_last_dash_a_lane_goes_on_as_it_was_driven(borders):
    """There is a curb on its side alone, or the one beyond the other lane comes nearer: the vehicle went straight on."""
    street = Street(vehicle=-1.75).paint(0.0, 5.0, 98.0, pattern="dashed")
    driven = [line for line, row in street.lanes(edges=curbs(street, *borders))[0] if row["direction"] == 1]
    assert max(line.bounds[2] for line in driven) - EAST == pytest.approx(114.5, abs=0.6)
    assert all(np.abs(street.offsets(line) + 1.75).max() < 0.05 for line in driven)


def test_beyond_its_paint_a_lane_is_no_surer_than_such_lanes_are_right():
    street = Street(vehicle=-1.75).paint(0.0, 5.0, 98.0, pattern="dashed")
    sure = {line.bounds[2] - EAST > 99.0: row["confidence"] for line, row in street.lanes(edges=curbs(street, -3.5))[0] if row["direction"] == 1}
    assert sure[True] < 0.81 and sure[True] < 0.9 * sure[False]


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(("begins", "ends_at"), [(106.0, 105.5), (101.0, 97.5)])
def test_beyond_its_paint_a_lane_leads_no_farther_than_an_island_on_it_and_three_metres_to_one_are_not_worth_it(begins, ends_at, side):
    street = Street(vehicle=-1.75).paint(0.0, 5.0, 98.0, pattern="dashed")
    edges, along = curbs(street, 3.5, -3.5), np.arange(begins, 114.0, 0.5)
    for chain, offset in enumerate((side * 0.2, side * 1.0), start=2):
        edges.add(LineString(np.c_[street.places(along, offset), np.full(len(along), HEIGHT)]), road=0, kind="island", edge="curb", status="measured",
                  part="bottom", chain=chain, side="left")
    ends = [line.bounds[2] for line, row in street.lanes(edges=edges)[0] if row["direction"] == -side]
    assert max(ends) - EAST == pytest.approx(ends_at, abs=0.6)


def test_pockets_that_face_each_other_over_a_junction_are_two_lanes_and_the_median_before_them_is_none():
    """Left-turn lanes of 35 m on both sides of a junction of 18 m, each with two arrows, where the painted median of double lines makes room."""
    street = Street(length=200.0, vehicle=-3.35, again=(3.35,))
    for side, (first, last) in ((1, (5.0, 91.0)), (-1, (109.0, 195.0))):
        pocket = (56.0, 91.0) if side > 0 else (109.0, 144.0)
        median = (5.0, 56.0) if side > 0 else (144.0, 195.0)
        for offset in (1.65, -1.65):
            street.paint(2.75 * offset + np.sign(offset) * 0.5, first, last, kind="edge").paint(offset, *pocket, kind="")
            for double in (offset - 0.12, offset + 0.12):
                street.paint(double, *median, kind="", pattern="double-solid")
    arrows = [(straight_arrow(station, 0.0, way), "arrow") for way, stations in ((1, (66.0, 80.0)), (-1, (115.0, 129.0))) for station in stations]
    middle = [(row["direction"], line.bounds[0] - EAST, line.bounds[2] - EAST) for line, row in street.lanes(markings=outlined(street, *arrows))[0]
              if abs(np.median(street.offsets(line))) < 1.0]
    assert sorted(middle) == [(-1, pytest.approx(109.0, abs=2.0), pytest.approx(144.0, abs=2.0)),
                              (1, pytest.approx(56.0, abs=2.0), pytest.approx(91.0, abs=2.0))]


def test_two_double_lines_with_room_between_them_are_a_painted_median_and_no_lane():
    street = Street(vehicle=-3.4).paint(5.15, kind="edge").paint(-5.15, kind="edge")
    for offset in (1.77, 1.53, -1.53, -1.77):
        street.paint(offset, kind="", pattern="double-solid")
    assert lanes_of(street) == {-3.46: 1, 3.46: -1}


@pytest.mark.parametrize("borders", [(-3.9,), (-3.9, 13.4)])
def test_what_nobody_drove_between_the_solid_lines_of_two_opposite_lanes_is_a_median_though_as_wide_as_a_lane(borders):
    street = Street(vehicle=-1.75)
    for offset in (-3.5, 0.0, 3.0, 6.4):
        street.paint(offset, kind="")
    lanes = street.lanes(edges=curbs(street, *borders))[0]
    assert {round(float(np.median(street.offsets(line)))): row["direction"] for line, row in lanes} == {-2: 1, 5: -1}


@pytest.mark.parametrize("left_edge", ["line", "curb"])
@pytest.mark.parametrize("median", [2.8, 3.3])
def test_on_either_side_of_a_median_without_paint_there_is_a_lane_where_it_was_driven(median, left_edge):
    """Two lanes of 3.4 m each way, dashes between those of a direction, and bare asphalt between the directions."""
    inner, outer = median / 2 + 1.7, median / 2 + 5.1
    street = Street(vehicle=-inner, again=(outer,) if left_edge == "curb" else ()).paint(-outer - 1.7, kind="edge")
    for side in (1, -1):
        street.paint(side * (inner + 1.7), kind="", pattern="dashed")
    if left_edge == "line":
        found = lanes_of(street.paint(outer + 1.7, kind="edge"))
    else:
        found = lanes_of(street, edges=curbs(street, outer + 1.7))
    assert sorted(found.items()) == [(pytest.approx(-outer, abs=0.02), 1), (pytest.approx(-inner, abs=0.02), 1),
                                     (pytest.approx(inner, abs=0.02), -1), (pytest.approx(outer, abs=0.02), -1)]


def test_between_dashes_and_a_curb_that_is_a_lane_away_there_is_one_though_nobody_drove_there():
    street = Street(length=80.0, vehicle=0.0, again=(3.6,)).paint(1.85, kind="", pattern="dashed").paint(-1.9, kind="", pattern="dashed")
    assert {round(offset): way for offset, way in lanes_of(street, edges=curbs(street, 5.6, -5.6)).items()} == {-4: 1, 0: 1, 4: -1}


def test_two_arrows_show_a_turning_lane_beyond_a_solid_line_beside_the_curb():
    street = Street(length=80.0, vehicle=0.0, again=(7.3,)).paint(5.3, kind="").paint(1.85, kind="").paint(-1.9, kind="")
    arrows = [(straight_arrow(station, -3.75, 1), "arrow") for station in (20.0, 65.0)]
    lines, _ = street.lanes(edges=curbs(street, 9.2, -5.6), markings=outlined(street, *arrows))
    assert max(line.length for line, row in lines if row["direction"] == 1 and np.median(street.offsets(line)) < -3.0) > 50.0


def test_a_lane_that_fills_the_room_between_its_line_and_a_curb_is_drawn_though_a_second_reading_has_none():
    street = Street(length=58.0, vehicle=0.0).paint(-1.6, 5.0, 55.0, kind="").paint(-3.9, 5.0, 55.0, kind="")
    beside = [row for line, row in street.lanes(edges=curbs(street, 1.87, -7.43))[0] if abs(np.median(street.offsets(line)) + 5.67) < 0.1]
    assert beside and all(row["confidence"] <= 0.6 for row in beside)


def test_before_a_stop_line_the_solid_lines_under_it_part_lanes_that_lead_to_it():
    """Three lanes between two curbs, of which the middle one was driven; the solid lines beside it could be the edges of the road, too."""
    street = Street(length=60.0, vehicle=0.0).paint(1.75, kind="").paint(-1.75, kind="")
    borders, stop = curbs(street, 5.2, -5.2), painted(street, (54.0, 54.5, -5.0, 5.0, "stop"))
    assert lanes_of(street, edges=borders) == {0.0: 1}
    assert {round(offset) for offset in lanes_of(street, edges=borders, markings=stop)} == {-3, 0, 3}
    assert set(lanes_of(street, edges=borders, markings=stop).values()) == {1}
    # before the driven lane alone it says nothing of the strips beside
    assert lanes_of(street, edges=borders, markings=painted(street, (54.0, 54.5, -1.6, 1.6, "stop"))) == {0.0: 1}


def test_a_drive_on_another_road_far_beside_a_lane_says_nothing_against_it():
    """Beyond the solid line left of the driven lane lies a turning lane, then asphalt without paint up to another road, driven the other way."""
    def street(again):
        return Street(length=80.0, vehicle=0.0, again=again).paint(1.75, kind="").paint(-1.75, kind="edge")

    def lanes(made):
        arrows = [(straight_arrow(station, 3.4, 1), "arrow") for station in (10.0, 25.0, 40.0, 55.0, 70.0)]
        return lanes_of(made, edges=curbs(made, 18.0, -4.0), markings=outlined(made, *arrows))

    other = street(again=(15.0,))
    assert len(other.frame.roads) == 2
    assert lanes(other) == lanes(street(again=())) == {0.0: 1, 3.5: 1}


def test_a_lane_that_moves_aside_for_a_turning_lane_may_keep_its_direction():
    """Before a stop line a lane opens between solid lines where the oncoming one lay, which nobody drove in and which a curb leads aside."""
    def aside(station):
        return 3.3 * np.clip((station - 60.0) / 10.0, 0.0, 1.0)

    street = Street().paint(0.0, 5.0, 63.0, kind="", pattern="dashed").paint(0.0, 63.0, 112.0, kind="").paint(aside, 67.0, 112.0, kind="")
    stop = painted(street, (112.0, 112.5, -3.4, 3.2, "stop"))
    lines, _ = street.lanes(edges=curbs(street, lambda station: 3.5 + aside(station), -3.5), markings=stop)
    before = [row for line, row in lines if line.bounds[2] < EAST + 65.0 and np.median(street.offsets(line)) > 0]
    assert before and all(row["confidence"] <= 0.6 and '"direction": -1' in row["other"] for row in before if row["direction"] == 1)


def test_beside_a_curb_lanes_are_like_those_between_lines_there_and_not_like_those_of_the_next_block():
    """Lanes of the next block are narrower, where another 3 m beside the last line would leave half a metre up to the curb."""
    street = Street(length=300.0, vehicle=0.0)
    for first, last, width in ((5.0, 115.0, 3.5), (150.0, 295.0, 3.0)):
        street.paint(width / 2, first, last, kind="edge")
        for line in (-width / 2, -1.5 * width):
            street.paint(line, first, last, pattern="dashed")
    street.paint(-7.5, 150.0, 295.0, kind="edge")
    lines, _ = street.lanes(edges=curbs(street, 3.0, -9.0))
    beside = [street.offsets(line) for line, _ in lines if line.bounds[2] < EAST + 120.0 and np.median(street.offsets(line)) < -5.25]
    assert beside and np.abs(np.concatenate(beside) + 5.25 + 3.75 / 2).max() < 0.1
