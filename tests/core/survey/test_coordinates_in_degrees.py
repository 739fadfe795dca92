"""Coordinates that are none on a map: degrees, also exchanged, and those counted from the centre of the earth."""

import laspy
import numpy as np
import pytest
from drives import ahead, bend, chain, drive, surveyed_points, write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.estimation.estimate import estimate_trajectory
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.trajectory.trajectory import Trajectory
from pyproj import Transformer

ALONG = np.arange(3000) * 1e-7   # degrees, of a street of 30 m


@pytest.fixture
def degrees(tmp_path):
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [1e-8, 1e-8, 1e-3], [8.4, 49.0, 0.0]
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z, cloud.gps_time = 8.4 + ALONG, 49.0 + ALONG, np.full(len(ALONG), 110.0), 1000.0 + 1e4 * ALONG
    cloud.write(str(tmp_path / "degrees.laz"))
    return tmp_path / "degrees.laz"


def test_they_are_refused_by_name_beside_a_trajectory(degrees):
    trajectory = Trajectory(1000.0 + 1e4 * ALONG, 8.4 + ALONG, 49.0 + ALONG, np.full(len(ALONG), 112.0))
    with pytest.raises(RoadExtractionError, match="look like longitude and latitude in degrees"):
        open_survey([degrees], trajectory)


def test_they_are_no_terrestrial_scan(degrees):
    with pytest.raises(RoadExtractionError, match="look like longitude and latitude in degrees"):
        estimate_trajectory([degrees])


@pytest.fixture
def street():
    """(trajectory, points) of a bend driven once in UTM zone 32."""
    trajectory = drive(chain(ahead(80), bend(60, 60), ahead(60)))
    return trajectory, surveyed_points(trajectory)


def test_longitude_and_latitude_exchanged_are_recognised(street, tmp_path):
    trajectory, points = street
    lon, lat = Transformer.from_crs(32632, 4326, always_xy=True).transform(trajectory.x, trajectory.y)
    cloud = write_cloud(tmp_path / "c.laz", *points, crs="EPSG:32632")
    with pytest.raises(RoadExtractionError, match="longitude and latitude are exchanged"):
        open_survey([cloud], Trajectory(trajectory.time, lat, lon, trajectory.z, crs="EPSG:4326"))


def test_a_cloud_counted_from_the_centre_of_the_earth_is_recognised(street, tmp_path):
    trajectory, (x, y, z, time) = street
    lon, lat = Transformer.from_crs(32632, 4979, always_xy=True).transform(x, y)
    cloud = write_cloud(tmp_path / "c.laz", *Transformer.from_crs(4979, 4978, always_xy=True).transform(lon, lat, z), time)
    with pytest.raises(RoadExtractionError, match="earth-centred: reproject"):
        open_survey([cloud], trajectory)
