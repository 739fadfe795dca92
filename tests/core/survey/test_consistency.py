"""Results of earlier stages are told from those of another drive."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from drives import EAST, NORTH, ahead, bend, chain, drive
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CURB_POINTS, ROAD_EDGES, Features
from lanewright.core.survey.consistency import check_features_on_roads, check_road_points_on_roads, keep_near_roads
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints

PATH = chain(ahead(80), bend(60, 60), ahead(60))
STATIONS = np.arange(10.0, 180.0, 2.0)


@pytest.fixture
def street():
    return build_frame(drive(PATH))


def another_drive(change):
    return build_frame(drive(*change))


def curbs_along(frame):
    curbs = Features("PointZ", CURB_POINTS)
    for s, x, y in zip(STATIONS, *frame.to_map(0, STATIONS, np.full(len(STATIONS), 4.0))):
        curbs.add(shapely.Point(x, y, 100.0), road=0, station_m=s, offset_m=4.0)
    return curbs


def points_along(frame):
    records = np.zeros(len(STATIONS), ROAD_POINT)
    x, y = frame.road(0).to_map(STATIONS, np.full(len(STATIONS), -2.0))
    records["x"], records["y"], records["s"], records["d"] = to_units(x), to_units(y), to_units(STATIONS), to_units(-2.0)
    records["z"] = to_units(100.0 - frame.origin[2])
    points = RoadPoints.empty_like(origin=frame.origin)
    points.store.append(0, records)
    return points


def test_what_was_made_with_a_trajectory_is_taken(street):
    check_features_on_roads(curbs_along(street), street, "Curb points")
    check_road_points_on_roads(points_along(street), street, "The points")


def test_a_line_is_taken_from_wherever_its_station_is_counted(street):
    edges = Features("LineStringZ", ROAD_EDGES)
    x, y = street.to_map(0, STATIONS, np.full(len(STATIONS), 4.0))
    line = shapely.LineString(np.c_[x, y, np.full(len(x), 100.0)])
    edges.add(line, road=0, station_m=STATIONS[0])
    edges.add(line.reverse(), road=0, station_m=STATIONS[0])
    check_features_on_roads(edges, street, "Road edges")


@pytest.mark.parametrize("other", [
    (PATH[::-1],), (PATH[100:],), (PATH, 10.0, 50.0, 1000.0, 2.0, EAST + 3000, NORTH),
], ids=["driven the other way", "begun later", "elsewhere"])
def test_with_another_drive_they_are_refused(street, other):
    stranger = another_drive(other)
    with pytest.raises(RoadExtractionError, match="Curb points and the trajectory do not belong together"):
        check_features_on_roads(curbs_along(street), stranger, "Curb points")
    with pytest.raises(RoadExtractionError, match="Give the trajectory that they were made with"):
        check_road_points_on_roads(points_along(street), stranger, "The points")


@pytest.mark.parametrize("metres", [3.0, -1.4])
def test_what_was_made_with_a_trajectory_moved_to_its_scanners_is_refused_with_the_one_given(metres):
    given, moved = build_frame(drive(chain(ahead(180)))), build_frame(drive(chain(ahead(180)), 10.0, 50.0, 1000.0, 2.0, EAST, NORTH + metres))
    with pytest.raises(RoadExtractionError, match=f"Curb points lie {abs(metres):.2f} m beside the offsets"):
        check_features_on_roads(curbs_along(moved), given, "Curb points")
    with pytest.raises(RoadExtractionError, match="Run Road map, which makes all layers with the moved trajectory"):
        check_road_points_on_roads(points_along(moved), given, "The points")


@pytest.mark.parametrize("metres, where", [(48.0, "50.00 m below"), (-48.0, "46.00 m above"), (-3.6, "1.60 m above")])
def test_what_was_made_with_a_trajectory_moved_to_the_height_of_its_scanners_is_refused_with_the_one_given(metres, where):
    """The heights of the trajectory are of another kind than those of the cloud, on whose road all layers lie."""
    moved, given = drive(chain(ahead(180))), drive(chain(ahead(180)))
    moved, given = build_frame(moved), build_frame(replace(given, z=given.z + metres))
    with pytest.raises(RoadExtractionError, match=f"Curb points lie {where} the trajectory"):
        check_features_on_roads(curbs_along(moved), given, "Curb points")
    with pytest.raises(RoadExtractionError, match="moved to the scanners"):
        check_road_points_on_roads(points_along(moved), given, "The points")


def test_layers_without_heights_are_taken(street):
    curbs = curbs_along(street)
    for flat in (shapely.force_2d(curbs.geometries), shapely.force_3d(shapely.force_2d(curbs.geometries))):
        curbs.geometries[:] = list(flat)
        check_features_on_roads(curbs, street, "Curb points")


def test_a_road_that_is_not_there_is_another_drive_s(street):
    curbs = curbs_along(street)
    for row in curbs.rows:
        row["road"] = 3
    with pytest.raises(RoadExtractionError, match="0 of 85 features"):
        check_features_on_roads(curbs, street, "Curb points")


def test_nothing_is_nobody_s(street):
    check_features_on_roads(Features("PointZ", CURB_POINTS), street, "Curb points")
    check_road_points_on_roads(RoadPoints.empty_like(origin=street.origin), street, "The points")


def test_points_drawn_far_away_by_mistake_are_left_out_and_counted(street):
    curbs = curbs_along(street)
    assert keep_near_roads(curbs, street, "Curb points") == "" and len(curbs) == len(STATIONS)
    curbs.add(shapely.Point(0.0, NORTH, 100.0), road=0, station_m=30.0)
    curbs.add(shapely.Point(EAST + 90.0, NORTH + 400.0, 100.0), road=0, station_m=40.0)
    note = keep_near_roads(curbs, street, "Curb points")
    assert note.startswith("Curb points: 2 of 87 vertices lie more than 200 m from the trajectory, the first at 0.0") and "2 of 87 features" in note
    assert len(curbs) == len(curbs.rows) == len(STATIONS)


def test_of_a_line_the_vertex_drawn_far_away_goes_and_of_polygons_the_whole(street):
    x, y = street.to_map(0, STATIONS, np.full(len(STATIONS), 4.0))
    along = np.c_[x, y, np.full(len(x), 100.0)]
    astray = np.insert(along, 7, [0.0, 0.0, 100.0], axis=0)
    edges, marks = Features("LineStringZ", ROAD_EDGES), Features("PolygonZ", ROAD_EDGES)
    edges.add(shapely.LineString(astray), road=0)
    edges.add(shapely.LineString(astray[6:8]), road=0)
    marks.add(shapely.Polygon(astray[5:10]), road=0)
    assert "1 of 2 features" in keep_near_roads(edges, street, "Road edges") and "1 of 1 features" in keep_near_roads(marks, street, "Markings")
    np.testing.assert_array_equal(shapely.get_coordinates(edges.geometries, include_z=True), along)
    assert len(edges.rows) == 1 and not len(marks)
    assert keep_near_roads(edges, street, "Road edges") == ""
