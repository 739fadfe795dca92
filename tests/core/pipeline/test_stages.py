"""The bar of a road map moves with the time that stages take: by points and by length of road."""

import numpy as np
import pytest
from lanewright.core.common.progress import Progress
from lanewright.core.pipeline.road_map import INTENSITY_STAGES, STAGE_NAMES, Extent, Stages
from lanewright.core.survey.las.reader import read_headers
from lanewright.core.survey.trajectory.trajectory import Trajectory
from lanewright.simulator.survey import SampleSettings, make_sample_survey

DENSE, LONG = Extent(18.4, 0.23), Extent(18.4, 2.03)


class Bar(Progress):
    def __init__(self):
        self.places = []

    def report(self, fraction):
        self.places.append(fraction)


def nothing(progress):
    progress.report(1.0)


def test_many_points_on_a_short_road_are_mostly_reading_and_as_many_on_a_long_one_mostly_paint():
    dense, long = (Stages(Progress(), extent, "profiles").shares for extent in (DENSE, LONG))
    assert max(dense, key=dense.get) == "survey" and dense["survey"] > 1.5 * long["survey"]
    assert long["markings"] > 2 * dense["markings"]


def test_a_packed_survey_takes_longer_to_read_than_a_plain_one():
    packed, plain = (Stages(Progress(), Extent(18.4, 0.23, share), "profiles").shares["survey"] for share in (0.0, 1.0))
    assert packed > 1.3 * plain


@pytest.mark.parametrize("method", ["profiles", "scanlines", "both"])
@pytest.mark.parametrize("known", [DENSE, LONG, Extent(0.0, 0.0)])
def test_the_bar_never_goes_back_and_ends_full_whatever_is_learnt_on_the_way(method, known):
    bar = Bar()
    stages = Stages(bar, DENSE, method)
    for name in STAGE_NAMES:
        stages.run(name, name, nothing)
        if name == "survey":
            stages.plan(known)
    assert (np.diff(bar.places) >= 0).all()
    assert bar.places[-1] == pytest.approx(1.0)
    assert set(stages.seconds) == set(STAGE_NAMES)


def test_stages_that_are_left_out_take_no_share():
    bar = Bar()
    stages = Stages(bar, DENSE, "profiles")
    stages.run("survey", "", nothing)
    stages.plan(DENSE, INTENSITY_STAGES)
    for name in ("curbs", "edges", "surface", "corrected"):
        stages.run(name, "", nothing)
    assert bar.places[-1] == pytest.approx(1.0)


def test_a_trajectory_counts_where_it_runs_by_the_cloud(tmp_path):
    """The file of the whole day's drive comes with one street's cloud: its other kilometres are not this road's."""
    sample = make_sample_survey(SampleSettings(length=60.0, pulse_rate=20_000.0, rotation_rate=50.0))
    sample.write_cloud(tmp_path / "street.laz")
    sample.write_cloud(tmp_path / "street.las")
    drive = sample.trajectory
    further = np.arange(1.0, 5000.0)
    day = Trajectory(*(np.r_[getattr(drive, name), getattr(drive, name)[-1] + further * step]
                       for name, step in (("x", 1.0), ("y", 1.0), ("z", 0.0), ("time", 0.1))), crs=drive.crs)
    street, whole = (Extent.expected(read_headers([tmp_path / "street.laz"]), one) for one in (drive, day))
    assert whole.length < street.length + 0.1
    assert street.length == pytest.approx(0.06, abs=0.05)
    assert street.plain == 0.0
    both = Extent.expected(read_headers([tmp_path / "street.laz", tmp_path / "street.las"]), drive)
    assert both.plain == pytest.approx(0.5)
    assert both.points == pytest.approx(2 * street.points)
