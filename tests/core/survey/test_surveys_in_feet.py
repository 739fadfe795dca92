"""A survey in feet, read into the road frame."""

from dataclasses import replace

import numpy as np
import pytest
from drives import ahead, bend, chain, contents, drive, surveyed_points, write_cloud
from lanewright.core.survey.open_survey import SurveySettings, open_survey


@pytest.mark.parametrize("crs, given, across, up", [
    ("EPSG:2263", "", 1200 / 3937, 1200 / 3937), ("EPSG:2222", "", 0.3048, 0.3048), ("EPSG:32632+6360", "", 1.0, 1200 / 3937),
    ("EPSG:2263+5703", "", 1200 / 3937, 1.0), ("", "EPSG:2263", 1200 / 3937, 1200 / 3937),
])
def test_a_survey_in_feet_is_the_survey_in_metres(tmp_path, crs, given, across, up):
    trajectory = drive(chain(ahead(80), bend(60, 60), ahead(60)))
    x, y, z, time = surveyed_points(trajectory)
    east, north = (300_000.0 - x.min(), 60_000.0 - y.min()) if across != 1.0 else (0.0, 0.0)   # into the area of the CRS
    stored = np.array([(x + east) / across, (y + north) / across, z / up])
    metric = np.round(stored, 3) * [[across], [across], [up]]      # as the file rounds them
    driven = replace(trajectory, x=trajectory.x + east, y=trajectory.y + north)
    expected = open_survey([write_cloud(tmp_path / "metres.laz", *np.round(metric, 3), time)], driven)
    in_feet = replace(driven, x=driven.x / across, y=driven.y / across, z=driven.z / up)
    found = open_survey([write_cloud(tmp_path / "feet.laz", *stored, time, crs=crs or None)], in_feet, SurveySettings(crs=given))
    assert found.counts == expected.counts and found.sensor_height == pytest.approx(expected.sensor_height, abs=0.002)
    for name in "xyz":
        np.testing.assert_allclose(contents(found)[name], contents(expected)[name], atol=11)   # units of 0.1 mm
