"""Results of earlier stages are told from those of another drive."""

import numpy as np
import pytest
import shapely
from drives import EAST, NORTH, ahead, bend, chain, drive
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import Features
from lanewright.core.common.schemas import CURB_POINTS, ROAD_EDGES
from lanewright.core.survey.consistency import check_features_on_roads, check_road_points_on_roads
from lanewright.core.survey.frame.build import build_frame
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
        curbs.add(shapely.Point(x, y, 100.0), road=0, station_m=s)
    return curbs


def points_along(frame):
    records = np.zeros(len(STATIONS), ROAD_POINT)
    x, y = frame.road(0).to_map(STATIONS, np.full(len(STATIONS), -2.0))
    records["x"], records["y"], records["s"], records["d"] = to_units(x), to_units(y), to_units(STATIONS), to_units(-2.0)
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


def test_a_road_that_is_not_there_is_another_drive_s(street):
    curbs = curbs_along(street)
    for row in curbs.rows:
        row["road"] = 3
    with pytest.raises(RoadExtractionError, match="0 of 85 features"):
        check_features_on_roads(curbs, street, "Curb points")


def test_nothing_is_nobody_s(street):
    check_features_on_roads(Features("PointZ", CURB_POINTS), street, "Curb points")
    check_road_points_on_roads(RoadPoints.empty_like(origin=street.origin), street, "The points")
