"""Which places of a road map are doubtful, and in which order they are gone through."""

from dataclasses import replace

import numpy as np
import pytest
from lanewright.core.common.features import DRIVING_LINES, LANES, PASSES, ROAD_EDGES, ROAD_SURFACE
from lanewright.core.common.texts import RoadPlace, places_in
from lanewright.core.corrections.corrections import Correction
from lanewright.core.road.surface.extract import ThinMargin, said_of_thin
from lanewright.desktop.review.doubtful import doubts_of
from lanewright.processing_provider.results.road_maps import Run, road_maps
from lanewright.processing_provider.styling import second_reading
from road_map_layers import EAST, NORTH, added, run_at

WARNING = ("The points are too few to find curbs along 30 m, where none was drawn (road 0, left side, station 60 to 80 m; road 0, right side, "
           "station 65 to 75 m): 55 per m² beside the limit of the road surface, some 14 cm apart.")


def said(place):
    return tuple(piece.text for piece in place.pieces)


def piece(start, end, y=0.0, **row):
    place = dict(road=0, station_m=float(start), end_m=float(end), length_m=float(end - start))
    return f"LINESTRING Z ({start} {y} 100, {end} {y} 100)", {**place, **row}


def street(project, *warnings):
    """A street of 200 m: on the left no edge from 50 to 80 m, on the right a side street of 12 m; one lane ends at 120 m."""
    run = run_at(8)
    run = Run(replace(run.provenance, warnings=warnings), run.survey, run.group)
    edge = dict(status="measured", kind="main")
    added(project, "ROAD_EDGES", ROAD_EDGES, piece(0, 50, 4, side="left", **edge), piece(80, 200, 4, side="left", **edge),
          piece(0, 90, -4, side="right", **edge), piece(102, 200, -4, side="right", **edge),
          piece(90, 92, -5, side="right", status="measured", kind="corner"), run=run)
    ring = "POLYGON Z ((40 -4 100, 90 -4 100, 90 4 100, 40 4 100, 40 -4 100))"
    added(project, "ROAD_SURFACE", ROAD_SURFACE, (ring, dict(road=0, status="grown", station_m=40.0, end_m=90.0)),
          (ring, dict(road=0, status="measured", station_m=0.0, end_m=40.0)), kind="PolygonZ", run=run)
    lane = "POLYGON Z (({0} 0 1, {1} 0 1, {1} -3 1, {0} -3 1, {0} 0 1))"
    area = lambda start, end, **row: (lane.format(start, end), {**piece(start, end)[1], "status": "measured", "type": "driving", **row})  # noqa: E731
    added(project, "LANES", LANES, area(0, 120, lane=1, direction=1, successors=""), area(0, 200, lane=2, direction=-1, successors=""),
          area(0, 196, lane=3, direction=1, successors=""), kind="PolygonZ", run=run)
    added(project, "PASSES", PASSES, (f"LINESTRING Z ({-20} -2 100, {220} -2 100)", dict(road=0, station_m=-20.0, end_m=220.0, direction=1)), run=run)
    return road_maps(project)[0]


def texts(road_map, *kinds):
    return [text for place in doubts_of(road_map, kinds) for text in said(place)]


def test_a_stretch_without_an_edge_is_a_place_and_the_mouth_of_a_side_street_is_none(project):
    places = doubts_of(street(project), ["edge"])
    assert [said(place) for place in places] == [("No road edge on the left for 30 m",)]
    box = places[0].extent
    assert (box.xMinimum() - EAST, box.xMaximum() - EAST) == pytest.approx((50.0, 80.0), abs=0.01)


def test_surface_that_was_grown_is_a_place(project):
    assert texts(street(project), "surface") == ["Road surface, 50 m: grown, no edge was found on one side at least"]


def test_a_lane_that_ends_before_its_road_is_a_place(project):
    places = doubts_of(street(project), ["lane"])
    assert [said(place) for place in places] == [("Lane 1 ends here, 80 m before the end of the road",)]
    assert places[0].middle.x() - EAST == pytest.approx(120.0, abs=0.5) and places[0].middle.y() == pytest.approx(NORTH - 2)


def test_places_that_a_warning_names_are_places(project):
    places = doubts_of(street(project, WARNING, "The trajectory is rough."), ["warning"])
    assert [(place.station, len(place.pieces)) for place in places] == [(60.0, 1)], "both sides of a road, one place: it stands once"
    assert said(places[0])[0].startswith("Warning: The points are too few")


def test_places_are_read_out_of_the_sentences_of_the_core():
    margins = [ThinMargin(0, "left", -10.0, 80.0, 50.0)]
    assert places_in(said_of_thin(margins)) == [RoadPlace(0, -10.0, 80.0, "left")]
    moved = Correction(3, "move", "edge", np.zeros((1, 3)), 2, 12.34, -3.0)
    assert places_in(moved.described()) == [RoadPlace(2, 12.3, 12.3)]
    assert places_in(WARNING) == [RoadPlace(0, 60.0, 80.0, "left"), RoadPlace(0, 65.0, 75.0, "right")]
    assert places_in("Along the road, 12 m from the station, nothing was found.") == []


def test_a_lane_is_listed_once_though_it_is_a_line_and_an_area(project):
    row = dict(lane=1, direction=1, status="inferred", confidence=0.7)
    ring = "POLYGON Z ((10 2 1, 30 2 1, 30 -2 1, 10 -2 1, 10 2 1))"
    added(project, "DRIVING_LINES", DRIVING_LINES, piece(10, 30, **row))
    added(project, "LANES", LANES, (ring, {**piece(10, 30)[1], **row}), kind="PolygonZ")
    assert len(texts(road_maps(project)[0], "lane")) == 1


def test_within_a_place_the_most_doubtful_piece_comes_first(project):
    added(project, "DRIVING_LINES", DRIVING_LINES, piece(10, 30, lane=1, status="bridged", confidence=0.99),
          piece(12, 32, lane=2, status="measured", confidence=0.4))
    place, = doubts_of(road_maps(project)[0])
    assert "Lane 2" in said(place)[0] and place.doubt == pytest.approx(20 * 0.01 + 20 * 0.6)


@pytest.mark.parametrize("other, words", [
    ('{"nats": 2.81, "lanes": [{"offset_m": 1.9, "width_m": 2.48, "direction": 1}]}', "a lane of 2.5 m along the road"),
    ('{"nats": 0.4, "kind": "centre"}', "Centre line"), ('{"kind": "wall"}', "another reading"), ("[1]", "another reading"),
    ("?", "another reading")])
def test_the_second_reading_of_a_piece_is_said_in_words(other, words):
    assert second_reading(other) == words
