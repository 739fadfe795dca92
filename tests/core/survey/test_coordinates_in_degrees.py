"""Clouds in degrees that carry no CRS."""

import laspy
import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.estimation.estimate import estimate_trajectory
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.trajectory.trajectory import Trajectory

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
