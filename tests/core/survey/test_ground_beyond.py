"""Ground beyond the corridor, which shows how side streets go on."""

from dataclasses import replace

import numpy as np
import pytest
from drives import ahead, chain, drive, surveyed_points, write_cloud
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.survey import blocks
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.store.records import beside_road
from lanewright.core.survey.survey import SurveySettings
from lanewright.core.survey.trajectory.trajectory import Trajectory

CRS = "EPSG:32632"
PATH = chain(ahead(120))


@pytest.fixture
def arm():
    """A street with an arm whose ground is seen to 70 m on its left, a wall 5 m high across it, and what is seen of the street."""
    trajectory = drive(PATH)
    x, y, z, time = surveyed_points(trajectory)
    rng = np.random.default_rng(3)
    k = np.flatnonzero(np.abs(np.hypot(trajectory.x - trajectory.x[0], trajectory.y - trajectory.y[0]) - 60.0) < 8.0)
    k = rng.choice(k, 4000)
    away, high = rng.uniform(8.0, 70.0, len(k)), np.where(np.arange(len(k)) % 8 == 0, rng.uniform(1.5, 5.0, len(k)), 0.0)
    more = trajectory.x[k], trajectory.y[k] + away, trajectory.z[k] - 2.0 + high, trajectory.time[k]
    return trajectory, [np.r_[a, b] for a, b in zip((x, y, z, time), more)], away, high


def ground_beyond(survey):
    number = beside_road(0)
    return np.concatenate([np.array(survey.section(number, k).records) for k in survey.store.sections(number)] or [np.empty(0)])


def cloud(tmp_path, points, name="a.laz", order=slice(None)):
    return write_cloud(tmp_path / name, *(v[order] for v in points), crs=CRS)


def test_level_ground_to_fifty_metres_is_kept_beside_the_road(arm, tmp_path):
    trajectory, points, away, high = arm
    survey = open_survey([cloud(tmp_path, points)], trajectory)
    kept = ground_beyond(survey)
    assert abs(len(kept) - ((away > 25.0) & (away < 50.0) & (high < 1.0)).sum()) <= 3
    assert survey.store.roads() == [0] and survey.store.count == survey.counts["kept"] < len(away) + len(points[0])


def test_it_depends_neither_on_the_order_of_points_nor_on_blocks_and_sections(arm, tmp_path):
    trajectory, points, *_ = arm
    shuffled = np.random.default_rng(1).permutation(len(points[0]))
    one = ground_beyond(open_survey([cloud(tmp_path, points)], trajectory))
    two = ground_beyond(open_survey([cloud(tmp_path, points, "b.laz", shuffled)], trajectory))
    small = SurveySettings(block=1500, section_length=7.0)
    three = ground_beyond(open_survey([cloud(tmp_path, points)], trajectory, small))
    np.testing.assert_array_equal(one, two)
    np.testing.assert_array_equal(np.sort(one, order=["time", "x", "y", "z"]), np.sort(three, order=["time", "x", "y", "z"]))


def test_worker_processes_and_a_work_folder_keep_what_threads_keep(arm, tmp_path, monkeypatch):
    monkeypatch.setattr(blocks, "READING", replace(blocks.READING, part_points=2000))
    trajectory, points, *_ = arm
    path = cloud(tmp_path, points)
    here, settings, work = ground_beyond(open_survey([path], trajectory)), SurveySettings(block=1500), str(tmp_path / "work")
    for execution in (ExecutionSettings(workers=2), ExecutionSettings(work_folder=work), ExecutionSettings(work_folder=work)):
        survey = open_survey([path], trajectory, settings, execution=execution)
        np.testing.assert_array_equal(np.sort(here), np.sort(ground_beyond(survey)))
        survey.store.close()


def test_a_survey_moved_five_hundred_kilometres_keeps_the_same(arm, tmp_path):
    trajectory, points, *_ = arm
    moved = Trajectory(trajectory.time, trajectory.x + 500_000, trajectory.y - 500_000, trajectory.z)
    far = cloud(tmp_path, [points[0] + 500_000, points[1] - 500_000, *points[2:]], "far.laz")
    here, there = ground_beyond(open_survey([cloud(tmp_path, points)], trajectory)), ground_beyond(open_survey([far], moved))
    assert len(here) == len(there)
    assert all(np.abs(here[name].astype(int) - there[name]).max() <= 1 for name in ("z", "s"))


def test_a_street_without_arms_keeps_nothing_beyond(tmp_path):
    trajectory = drive(PATH)
    assert not len(ground_beyond(open_survey([cloud(tmp_path, surveyed_points(trajectory))], trajectory)))
