"""A road must be measured under the vehicle all along its way: what lacks, or lies at another height, is told with its stations."""

import re

import numpy as np
import pytest
from drives import ahead, bend, chain, drive, surveyed_points, write_cloud
from lanewright.core.common.progress import RememberedMessages
from lanewright.core.survey.open_survey import SurveySettings, open_survey

CRS = "EPSG:32632"
TRAJECTORY = drive(chain(ahead(80), bend(60, 60), ahead(60)))   # 203 m, of which 10 m are driven in a second
POINTS = np.array(surveyed_points(TRAJECTORY))
METRES = 10.0 * (POINTS[3] - TRAJECTORY.time[0])
DOUBTS = re.compile("under the vehicle|one height above the road")


def told(tmp_path, *parts, trajectory=TRAJECTORY, settings=SurveySettings()):
    """What is said of the way under the vehicle, where each part of the points is a file."""
    paths = [write_cloud(tmp_path / f"{k}.laz", *points, crs=CRS) for k, points in enumerate(parts)]
    listener = RememberedMessages()
    open_survey(paths, trajectory, settings, listener)
    return [warning for warning in listener.warnings if DOUBTS.search(warning)]


def raised(points, metres):
    return points + np.array([[0.0], [0.0], [metres], [0.0]])


def test_a_street_that_was_measured_all_along_is_not_spoken_of(tmp_path):
    assert told(tmp_path, POINTS) == []


@pytest.mark.parametrize("metres, where", [(18.3, "+18 m from"), (-18.3, "-18 m from"), (1.8, "+1.8 m from"), (-0.5, "-0.5 m from")])
@pytest.mark.parametrize("block", [700, 400_000])
def test_a_file_with_heights_of_another_kind_is_told(tmp_path, metres, where, block):
    other = METRES > 140
    said, = told(tmp_path, POINTS[:, ~other], raised(POINTS[:, other], metres), settings=SurveySettings(block=block))
    assert f"station 141 to 203 m) the road lies {where}" in said and "two kinds" in said


def test_a_vehicle_that_gives_way_on_its_springs_is_not_spoken_of(tmp_path):
    assert told(tmp_path, POINTS + np.array([[0.0], [0.0], [1.0], [0.0]]) * 0.12 * np.sin(METRES / 15.0)) == []


def test_a_car_that_stands_behind_is_no_road(tmp_path):
    behind = (METRES > 100) & (METRES < 104)
    assert told(tmp_path, POINTS, *(raised(POINTS[:, behind], height) for height in (1.40, 1.41, 1.42))) == []


def test_a_file_that_is_missing_in_the_middle_is_told(tmp_path):
    said, = told(tmp_path, POINTS[:, METRES < 60], POINTS[:, METRES > 90])
    assert "No point was kept" in said and "station 62 to 88 m" in said


def test_a_drive_that_goes_on_where_nothing_was_scanned_is_not_spoken_of(tmp_path):
    assert told(tmp_path, POINTS[:, (METRES > 50) & (METRES < 150)]) == []


def test_two_surveys_far_apart_on_one_drive_lack_no_file(tmp_path):
    assert told(tmp_path, POINTS[:, METRES < 50], POINTS[:, METRES > 170]) == []


def test_a_road_under_a_bridge_is_the_road(tmp_path):
    under = (METRES > 100) & (METRES < 130)
    assert told(tmp_path, POINTS, raised(POINTS[:, under], 7.0)) == []
