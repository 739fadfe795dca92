"""Finished work in a folder: taken from there by the next run, never where anything it was made from has changed."""

import os
import shutil

import pytest
from heard import Heard
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.execution import keep, phase
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from lanewright.core.survey import open_survey as opening
from lanewright.core.survey.open_survey import SurveySettings, open_survey

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def sample(made_survey):
    return made_survey(length=24.0, pulse_rate=40_000.0)


def boundaries(sample, folder, curbs=CurbSettings(), progress=None, workers=0):
    made, path = sample
    execution = ExecutionSettings(workers, str(folder) if folder else "")
    survey = open_survey([path], made.trajectory, SurveySettings(), progress or Progress(), execution)
    try:
        return draw_boundaries(find_curb_points(survey, BoundarySettings("both", curbs), progress or Progress()), survey.frame)
    finally:
        survey.store.close()


def numbers_of(found):
    course, points = found.edges.course, found.curb_points
    return [values.tobytes() for values in (course.x, course.y, course.z, course.d, found.edges.agree, points.station, points.height, points.along)]


@pytest.fixture(scope="module")
def without(sample):
    return numbers_of(boundaries(sample, ""))


@pytest.fixture(scope="module")
def first_work(sample, tmp_path_factory, without):
    """A work folder after a run."""
    folder = tmp_path_factory.mktemp("first") / "work"
    assert numbers_of(boundaries(sample, folder)) == without
    return folder


@pytest.fixture
def work(first_work, tmp_path):
    """Another one like it, for it may be moved."""
    return shutil.copytree(first_work, tmp_path / "work")


def never(*_, **__):
    raise AssertionError("This was done before.")


@pytest.mark.parametrize("workers", [0, 2])
def test_a_second_run_in_a_folder_that_was_moved_reads_nothing_again_and_gives_the_same(sample, work, without, monkeypatch, workers):
    monkeypatch.setattr(opening, "read_survey", never)
    before, heard = sorted(os.listdir(work)), Heard()
    assert numbers_of(boundaries(sample, work, progress=heard, workers=workers)) == without
    assert heard.says("read by an earlier run") and heard.says("Points read:") and heard.says("finished by an earlier run")
    assert sorted(os.listdir(work)) == before


def test_a_cancelled_run_goes_on_where_it_was(sample, tmp_path, without):
    class Stop(Heard):
        def report(self, fraction):
            if len(list(tmp_path.glob("work/kept-*.plain"))) > 5:
                raise Cancelled

    with pytest.raises(Cancelled):
        boundaries(sample, tmp_path / "work", progress=Stop())
    done = {path: path.stat().st_ino for path in tmp_path.glob("work/kept-*.plain")}
    heard = Heard()
    assert numbers_of(boundaries(sample, tmp_path / "work", progress=heard)) == without
    assert len(done) > 5 and all(path.stat().st_ino == file for path, file in done.items()) and heard.says("finished by an earlier run")


def test_other_curb_settings_find_curbs_anew_from_points_that_were_read(sample, work, monkeypatch):
    curbs = CurbSettings(min_height=0.03)
    expected = numbers_of(boundaries(sample, "", curbs))
    monkeypatch.setattr(opening, "read_survey", never)
    assert numbers_of(boundaries(sample, work, curbs)) == expected


def test_another_file_of_the_same_name_other_settings_and_other_code_are_read_anew(sample, work, tmp_path, monkeypatch):
    made, path = sample
    cloud = tmp_path / "survey.laz"
    for change in ("file", "file again", "settings", "code", "packages"):
        settings, heard = SurveySettings(corridor=20.0) if change == "settings" else SurveySettings(), Heard()
        if "file" in change:
            shutil.copyfile(path, cloud)
        if change == "code":
            monkeypatch.setattr(keep, "code_digest", lambda: "another")
        if change == "packages":
            monkeypatch.setattr(keep, "versions", lambda: {"python": "3.11", "numpy": "9.9"})
        open_survey([cloud], made.trajectory, settings, heard, ExecutionSettings(0, str(work))).store.close()
        assert not heard.says("read by an earlier run"), change


@pytest.mark.skipif(os.name == "nt", reason="a full disk is made of /dev/full")
@pytest.mark.parametrize("cut, left", [("kept-*.plain", 0), ("kept-*.plain", 100), ("points*", 100), ("points*", 0)])
def test_what_a_power_failure_has_cut_off_is_made_again(sample, work, without, monkeypatch, cut, left):
    for path in sorted(work.glob(cut)):
        os.truncate(path, left)
    assert numbers_of(boundaries(sample, work)) == without
    monkeypatch.setattr(opening, "read_survey", never)
    assert numbers_of(boundaries(sample, work)) == without


def test_a_folder_that_cannot_be_used_is_named_before_anything_is_read(sample, tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setattr(opening, "read_survey", never)
    for folder in (tmp_path / "file", tmp_path / "no" / "such", "/dev/full"):
        with pytest.raises(RoadExtractionError, match="work folder .* cannot be used"):
            boundaries(sample, folder)


def test_a_disk_that_fills_up_is_named(sample, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(phase, "write_plain", full)
    with pytest.raises(RoadExtractionError, match="work folder .*No space left on device"):
        boundaries(sample, tmp_path / "work")
