"""Normalized scanlines of the sample survey, whose ground is known: mount, speed, rate and density change nothing but the noise."""

import numpy as np
import pytest
from lanewright.core.road.scanlines.grid import Scanlines
from lanewright.core.road.scanlines.section_planes import ScanlineSettings, all_scanlines
from lanewright.core.survey.open_survey import open_survey

pytestmark = pytest.mark.slow

USUAL = dict(length=40.0, pulse_rate=100_000.0, rotation_rate=100.0, speed_kmh=30.0)


@pytest.mark.parametrize("changed", [dict(), dict(mount_yaw=0.0, speed_kmh=60.0), dict(rotation_rate=50.0, pulse_rate=40_000.0)],
                         ids=["usual", "straight mount at twice the speed", "half the rotation of fewer pulses"])
def test_scanlines_lie_on_the_ground_within_the_noise(made_survey, changed):
    sample, cloud = made_survey(**{**USUAL, **changed})
    survey = open_survey([str(cloud)], sample.trajectory)
    lines = Scanlines.join(all_scanlines(survey, 0, ScanlineSettings(interval=0.25)))
    x, y, z = survey.frame.to_map(0, np.repeat(lines.station, np.diff(lines.first)), lines.d, lines.z)
    x, y, z = (values - origin for values, origin in zip((x, y, z), sample.settings.origin))
    s, d, *_ = sample.scene.axis.locate(x, y, np.clip(lines.station[lines.line_of_vertex()] - 15.0, 0, 40.0))
    above = z - sample.scene.height(s, d)
    road = (s > 5.0) & (s < 35.0) & (np.abs(d) < 3.0) & (np.abs(above) < 0.1)
    assert np.sqrt(np.mean(above[road] ** 2)) < 0.005
    # every plane is crossed by lines of each scanner and pass
    keys = lines.pass_number * 10 + lines.scanner
    # stations are counted from where the vehicle set out, 15 m before the surveyed stretch
    inside = (lines.station > 25.0) & (lines.station < 45.0) & (np.diff(lines.first) > 20)
    for key in np.unique(keys):
        assert len(np.unique(lines.station[inside & (keys == key)])) == 79
