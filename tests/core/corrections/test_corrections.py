"""Streets whose road edges, marking lines and lanes an analyst corrects; the run then finds them a little elsewhere."""

import numpy as np
import pytest
import shapely
from clustered_streets import ClusteredStreet
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CORRECTIONS, ROAD_EDGES, Features
from lanewright.core.corrections.apply import correct_edges, correct_lanes, correct_marking_lines, correct_markings
from lanewright.core.corrections.corrections import corrections_from_features
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.core.road.edges.road_edges import RoadEdges
from lined_streets import EAST, HEIGHT, NORTH, Street
from shapely.geometry import LineString, Point

NOTHING = np.empty((0, 3))


def layer_of(*rows, crs=""):
    """A layer of corrections: (action, target, geometry or None, further fields)."""
    layer = Features("any", CORRECTIONS, crs=crs)
    for action, target, geometry, *more in rows:
        layer.add(geometry, action=action, target=target, **(more[0] if more else {}))
    return layer


def along(first, last, offset, count=2):
    """A line along the straight street eastward."""
    return LineString([(EAST + s, NORTH + offset) for s in np.linspace(first, last, count)])


def edges_of(street, *pieces):
    """RoadEdges of (first, last, offset, status)."""
    layer = Features("LineStringZ", list(ROAD_EDGES))
    for chain, (first, last, offset, status) in enumerate(pieces):
        places = street.places(np.arange(first, last + 0.5, 1.0), offset)
        layer.add(LineString(np.c_[places, np.full(len(places), HEIGHT)]), road=0, side="left" if offset > 0 else "right", status=status,
                  station_m=float(first), end_m=float(last), length_m=float(last - first), chain=chain, kind="main", part="bottom")
    return RoadEdges.from_features(layer, street.frame)


def corrected_edges(street, edges, *rows):
    corrections = corrections_from_features(layer_of(*rows), street.frame)
    found = correct_edges(edges, street.frame, corrections).to_features(street.frame)
    return [(row["status"], round(row["station_m"]), round(row["end_m"])) for row in sorted(
        found.rows, key=lambda row: (row["side"], row["station_m"]))], found, corrections


def test_a_bridged_edge_that_is_accepted_stays_where_it_is_and_is_no_longer_bridged():
    street = Street()
    edges = edges_of(street, (10, 40, 4.0, "measured"), (40, 60, 4.0, "bridged"), (60, 100, 4.0, "measured"))
    told, found, corrections = corrected_edges(street, edges, ("accept", "edge", along(40, 60, 4.0)))
    assert told == [("measured", 10, 40), ("accepted", 40, 60), ("measured", 60, 100)]
    assert not corrections.unmatched
    assert all(row["length_m"] == pytest.approx(row["end_m"] - row["station_m"], abs=0.01) for row in found.rows)


@pytest.mark.parametrize("shift", [-0.4, 0.0, 0.4])
def test_a_correction_holds_when_the_run_finds_the_edge_a_little_elsewhere_and_cut_otherwise(shift):
    street = Street()
    edges = edges_of(street, (10, 47, 4.0 + shift, "measured"), (47, 100, 4.0 + shift, "bridged"))
    told, found, corrections = corrected_edges(street, edges, ("delete", "edge", along(40, 60, 4.0)))
    assert told == [("measured", 10, 40), ("bridged", 60, 100)]
    assert not corrections.unmatched
    for line, _ in found:
        np.testing.assert_allclose(shapely.get_coordinates(line)[:, 1], NORTH + 4.0 + shift, atol=1e-4)


def test_what_lies_farther_off_or_crosses_is_left_alone_and_the_correction_is_listed():
    street = Street()
    across = Features("LineStringZ", list(ROAD_EDGES))
    across.add(LineString([(EAST + 50, NORTH - 3, HEIGHT), (EAST + 50, NORTH + 8, HEIGHT)]), road=0, side="left", kind="corner")
    for edges in (edges_of(street, (10, 100, 4.8, "measured")), RoadEdges.from_features(across, street.frame)):
        corrections = corrections_from_features(layer_of(("delete", "edge", along(40, 60, 4.0), {"note": "a parked car"})), street.frame)
        assert correct_edges(edges, street.frame, corrections) is edges
        assert [one.described() for one in corrections.unmatched] == \
            ["row 1, delete edge, road 0, station 50.0 m, offset +5.8 m (a parked car)"]


def test_of_two_edges_beside_each_other_the_nearer_one_is_meant():
    street = Street()
    edges = edges_of(street, (10, 100, 4.0, "measured"), (10, 100, 4.3, "measured"))
    told, found, _ = corrected_edges(street, edges, ("delete", "edge", along(10, 100, 4.28)))
    assert told == [("measured", 10, 100)]
    np.testing.assert_allclose(shapely.get_coordinates(found.geometries[0])[:, 1], NORTH + 4.0, atol=1e-4)


def test_a_point_is_about_the_whole_of_the_nearest_piece():
    street = Street()
    edges = edges_of(street, (10, 40, 4.0, "measured"), (40, 60, 4.0, "bridged"))
    told, *_ = corrected_edges(street, edges, ("delete", "edge", Point(EAST + 50, NORTH + 4.2)))
    assert told == [("measured", 10, 40)]


def test_a_row_without_geometry_lies_at_its_station_and_offset():
    street = Street()
    edges = edges_of(street, (10, 40, 4.0, "measured"), (10, 40, -4.0, "measured"))
    told, found, _ = corrected_edges(street, edges, ("delete", "edge", None, {"road": 0, "station_m": 20.0, "offset_m": -2.25}))
    assert [row["side"] for row in found.rows] == ["left"]


def test_an_edge_that_is_drawn_has_the_side_of_its_place_and_the_heights_of_the_map():
    street = Street()
    edges = edges_of(street, (10, 40, 4.0, "measured"), (10, 100, -4.0, "measured"))
    told, found, corrections = corrected_edges(street, edges, ("draw", "edge", along(45, 90, 4.1)))
    assert told == [("measured", 10, 40), ("drawn", 45, 90), ("measured", 10, 100)] and not corrections.unmatched
    drawn = next(line for line, row in found if row["status"] == "drawn")
    np.testing.assert_allclose(shapely.get_coordinates(drawn, include_z=True)[:, 2], HEIGHT, atol=0.01)


def test_a_curb_that_is_drawn_has_the_heights_that_it_brings():
    street = Street()
    line = shapely.force_3d(along(45, 90, 4.1), HEIGHT + 0.5)
    _, found, _ = corrected_edges(street, edges_of(street, (10, 40, 4.0, "measured")), ("draw", "edge", line, {"height_m": 0.12}))
    drawn, row = next((line, row) for line, row in found if row["status"] == "drawn")
    assert row["height_m"] == pytest.approx(0.12)
    np.testing.assert_allclose(shapely.get_coordinates(drawn, include_z=True)[:, 2], HEIGHT + 0.5, atol=0.001)
    rows = layer_of(("draw", "edge", line))
    rows.rows[0]["height_m"] = "a foot"   # of a table that was made elsewhere
    with pytest.raises(RoadExtractionError, match="Row 1 .* height 'a foot'"):
        corrections_from_features(rows, street.frame)


def test_an_edge_that_is_moved_leaves_its_old_place_and_keeps_its_side_and_kind():
    street = Street()
    edges = edges_of(street, (10, 100, 4.0, "measured"))
    told, found, _ = corrected_edges(street, edges, ("move", "edge", along(40, 60, 5.2)))
    assert told == [("measured", 10, 40), ("drawn", 40, 60), ("measured", 60, 100)]
    moved = next(line for line, row in found if row["status"] == "drawn")
    np.testing.assert_allclose(shapely.get_coordinates(moved)[:, 1], NORTH + 5.2, atol=1e-4)
    assert {row["kind"] for row in found.rows} == {"main"}


def test_what_is_drawn_where_the_run_now_finds_it_itself_replaces_what_it_found():
    street = Street()
    edges = edges_of(street, (10, 100, 4.1, "measured"))
    told, *_ = corrected_edges(street, edges, ("draw", "edge", along(45, 90, 4.0)))
    assert told == [("measured", 10, 45), ("drawn", 45, 90), ("measured", 90, 100)]


def test_a_line_off_the_roads_of_the_survey_is_not_drawn():
    street = Street()
    told, _, corrections = corrected_edges(street, edges_of(street, (10, 40, 4.0, "measured")), ("draw", "edge", along(10, 20, 900.0)))
    assert told == [("measured", 10, 40)] and "off the roads" in corrections.unmatched[0].described()


@pytest.mark.parametrize(("row", "said"), [
    (("remove", "edge", along(10, 20, 4.0)), "one of accept, delete, move, draw"),
    (("delete", "curb", along(10, 20, 4.0)), "one of edge, marking, lane"),
    (("draw", "edge", Point(EAST + 20, NORTH + 4)), "takes a line"),
    (("delete", "edge", None), "neither a geometry nor a road"),
    (("delete", "edge", Point(EAST + 20, NORTH + 4).buffer(1)), "a point or a line is needed"),
])
def test_a_correction_that_cannot_be_understood_is_refused_by_its_row(row, said):
    with pytest.raises(RoadExtractionError, match=said) as refused:
        corrections_from_features(layer_of(row), Street().frame)
    assert "Row 1" in str(refused.value)


def test_corrections_in_degrees_are_brought_to_the_survey():
    from pyproj import Transformer

    street = Street()
    to_degrees = Transformer.from_crs("EPSG:32632", "EPSG:4326", always_xy=True)
    line = shapely.transform(along(40, 60, 4.0), lambda places: np.column_stack(to_degrees.transform(*places.T)))
    corrections = corrections_from_features(layer_of(("delete", "edge", line), crs="EPSG:4326"), street.frame, "EPSG:32632")
    assert corrections.rows[0].station == pytest.approx(50.0, abs=0.3) and corrections.rows[0].on_a_road


# -- markings ---------------------------------------------------------------------------------------------


def painted():
    """A bend with two edge lines, and dashes of which three are worn away."""
    street = ClusteredStreet(radius=None)
    street.dashes(3.0, 6.0, 0.0, missing=(5, 6, 7), kind="lane").paint(1.0, 118.0, -3.4, kind="edge").paint(1.0, 118.0, 3.4, kind="edge")
    return street, street.painted_lines()


def corrected_lines(street, lines, *rows):
    corrections = corrections_from_features(layer_of(*rows), street.frame)
    found = correct_marking_lines(lines, street.frame, corrections, NOTHING)
    return found.to_features(street.frame), corrections


def on_street(street, first, last, offset):
    return LineString(street.place(np.array([first, last]), offset))


def test_a_deleted_line_is_gone_along_the_correction_and_its_rest_lies_on_the_same_curve():
    street, lines = painted()
    before = lines.to_features(street.frame)
    found, corrections = corrected_lines(street, lines, ("delete", "marking", on_street(street, 40.0, 70.0, 3.4)))
    pieces = [(round(row["station_m"]), round(row["end_m"])) for row in found.rows if row["offset_m"] > 4]
    assert sorted(pieces) == [(1, 40), (70, 118)] and not corrections.unmatched
    assert len(found) == len(before) + 1
    for line, row in found:
        assert row["length_m"] == pytest.approx(row["end_m"] - row["station_m"], abs=0.05)
        assert street.distance(line, row["offset_m"] - 1.6).max() < 0.03


def test_a_drawn_line_has_the_pattern_that_is_said_and_a_curve():
    street, lines = painted()
    rows = ("draw", "marking", on_street(street, 20.0, 60.0, 1.7), {"pattern": "dashed", "kind": "lane"})
    found, _ = corrected_lines(street, lines, rows)
    row, = (row for row in found.rows if row["status"] == "drawn")
    assert (row["kind"], row["pattern"], row["curve"]) == ("lane", "dashed", "line")
    assert row["line"] not in [other["line"] for other in found.rows if other is not row]


def test_markings_that_are_deleted_make_no_lines():
    street = Street()
    layer = Features("PolygonZ", [])
    for number, offset in enumerate((0.0, 3.0)):
        layer.add(shapely.force_3d(along(20, 23, offset).buffer(0.08), HEIGHT), road=0, cluster=number, use="keep", **{"class": "lane"})
    markings = MarkingObjects.from_features(layer, street.frame)
    corrections = corrections_from_features(layer_of(("delete", "marking", along(10, 40, 0.1)), ("accept", "marking", along(10, 40, 3.0))),
                                            street.frame)
    assert correct_markings(markings, corrections).cluster.tolist() == [1]
    assert not corrections.unmatched


# -- lanes ------------------------------------------------------------------------------------------------


def two_way():
    street = Street(length=120.0, vehicle=-1.75)
    street.paint(3.5, kind="edge").paint(0.0, pattern="dashed").paint(-3.5, kind="edge")
    return street, make_driving_lines(PaintedLines.from_features(street.lines, street.frame), street.frame)


def corrected_lanes(street, made, *rows):
    corrections = corrections_from_features(layer_of(*rows), street.frame)
    return (*correct_lanes(*made, street.frame, corrections, 3.5, NOTHING), corrections)


def test_a_lane_that_is_deleted_along_a_stretch_is_gone_from_both_layers_and_leads_nowhere_there():
    street, made = two_way()
    lines, _, lanes, corrections = corrected_lanes(street, made, ("delete", "lane", along(40, 70, 1.75)))
    assert not corrections.unmatched
    for layer in (lines, lanes):
        against = layer.direction == -1
        np.testing.assert_allclose(sorted(zip(layer.station[against], layer.end[against])), [(5, 40), (70, 115)], atol=0.6)
    assert len(set(lanes.lane_id)) == len(lanes) == 3
    assert all(not followers for followers in lanes.successors)


def test_pieces_of_an_accepted_lane_still_follow_each_other():
    street, made = two_way()
    lines, _, lanes, _ = corrected_lanes(street, made, ("accept", "lane", along(40, 70, 1.75)))
    against = [k for k in range(len(lanes)) if lanes.direction[k] == -1]
    order = sorted(against, key=lambda k: -lanes.station[k])
    assert [lanes.status[k] for k in order] == ["measured", "accepted", "measured"]
    assert [lanes.successors[k] for k in order] == [(lanes.lane_id[order[1]],), (lanes.lane_id[order[2]],), ()]
    assert lines.confidence[lines.status == "accepted"].tolist() == [1.0]
    for before, after in zip(order[:-1], order[1:]):
        np.testing.assert_allclose(lanes.borders(before)[0][-1], lanes.borders(after)[0][0], atol=1e-6)


@pytest.mark.parametrize("way", [1, -1])
def test_a_lane_is_drawn_as_it_is_driven_and_has_the_width_of_the_others(way):
    street, made = two_way()
    line = along(20, 90, 5.3)
    lines, _, lanes, _ = corrected_lanes(street, made, ("draw", "lane", line if way > 0 else line.reverse()))
    k, = np.flatnonzero(lanes.status == "drawn")
    assert lanes.direction[k] == lines.direction[lines.status == "drawn"][0] == way
    left, right = lanes.borders(k)
    # left in the direction of travel
    assert np.sign((left - right)[:, 1]).tolist() == [way] * len(left)
    np.testing.assert_allclose(np.abs(left - right)[:, 1], 3.5, atol=0.01)
    assert lanes.lane[k] == 3 and lanes.lane_id[k] == "0.3.1"


def test_a_lane_that_was_drawn_can_be_moved_and_deleted_by_later_rows():
    street, made = two_way()
    drawn, moved, gone = ("draw", "lane", along(20, 90, 5.3)), ("move", "lane", along(20, 90, 5.9)), ("delete", "lane", along(20, 90, 5.9))
    lines, _, lanes, corrections = corrected_lanes(street, made, drawn, moved)
    _, _, at_once, _ = corrected_lanes(street, made, ("draw", "lane", along(20, 90, 5.9)))
    assert not corrections.unmatched and np.count_nonzero(lines.status == "drawn") == 1
    np.testing.assert_allclose(*(layer.borders(int(np.flatnonzero(layer.status == "drawn")[0])) for layer in (lanes, at_once)), atol=1e-6)
    lines, _, lanes, corrections = corrected_lanes(street, made, drawn, moved, gone)
    assert not corrections.unmatched and "drawn" not in [*lines.status, *lanes.status] and len(lines) == len(lanes) == 2


def test_a_row_that_says_that_something_was_seen_asks_for_nothing():
    rows = corrections_from_features(layer_of(("seen", "surface", along(0, 20, 0)), ("delete", "edge", along(0, 20, 3))), Street().frame).rows
    assert [(row.row, row.action) for row in rows] == [(2, "delete")], "rows keep their numbers"
