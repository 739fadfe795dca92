"""Finished work in a folder: taken from there by the next run, never where anything it was made from has changed."""

import os
import shutil

import laspy
import numpy as np
import pytest
from heard import Heard
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.execution import keep, phase
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.phase import Threads
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from lanewright.core.road.scanlines.section_planes import ScanlineSettings
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.road.surface.ground_grid import MeasuredGround
from lanewright.core.survey import open_survey as opening
from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.core.survey.store.section_store import SectionStore

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def sample(made_survey):
    return made_survey(length=24.0, pulse_rate=40_000.0)


def boundaries(sample, folder, curbs=CurbSettings(), progress=None, clouds=(), workers=0):
    made, path = sample
    execution = ExecutionSettings(workers, str(folder) if folder else "")
    survey = open_survey(clouds or [path], made.trajectory, SurveySettings(), progress or Progress(), execution)
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


class Watched(Threads):
    """Has each item done by itself, and notes which sections it reads that its state does not name: {function: (road, section)}."""

    def __init__(self, folder):
        super().__init__(1)
        self.folder, self.read, self.unnamed, self.functions = folder, set(), {}, set()

    def run(self, phase, items, progress=Progress(), keep=()):
        recipe = phase.source.recipe(self.folder)
        for item in items:
            self.read.clear()
            result = phase.function(recipe.open({}), item, *phase.arguments)
            if phase.state is not None:
                named = {tuple(part[:2]) for part in parts_in(phase.state(item))}
                self.functions |= {phase.function.__name__}
                self.unnamed.setdefault(phase.function.__name__, set()).update(self.read - named)
            yield result


def parts_in(state):
    """The parts of sections, as of `SectionStore.state`, that a state names anywhere."""
    if isinstance(state, (list, tuple)):
        if len(state) == 6 and isinstance(state[2], str):
            yield state
        else:
            for part in state:
                yield from parts_in(part)


@pytest.mark.parametrize("planes", [ScanlineSettings(), ScanlineSettings(interval=10.0)])
def test_a_task_reads_no_points_but_those_that_its_result_is_kept_by(made_survey, tmp_path, monkeypatch, planes):
    made, path = made_survey(length=90.0, pulse_rate=15_000.0)
    watched, section = Watched(tmp_path), SectionStore.section

    def noted(store, road, number):
        points = section(store, road, number)
        watched.read |= {(road, number)} if len(points) and store.base is None and "cluster" not in points.names else set()
        return points

    monkeypatch.setattr(SectionStore, "section", noted)
    monkeypatch.setattr(opening, "executor_for", lambda *_: watched)
    survey = open_survey([path], made.trajectory, SurveySettings(section_length=5.0))
    ground, settings = MeasuredGround(survey), BoundarySettings("both", planes=planes)
    edges = draw_boundaries(find_curb_points(survey, settings, ground=ground), survey.frame, survey=survey, ground=ground).edges
    extract_road_surface(survey, edges, ground=ground)
    survey.store.close()
    assert watched.functions > {"_steps_of_methods", "items_of_phases", "plan_steps_of_section", "surface_points"}
    assert not any(watched.unnamed.values()), watched.unnamed


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


def write_tiles(path, folder, left_out=0.0):
    """Four tiles of a cloud along the road; of the last of them a share of the points is left out."""
    cloud = laspy.read(path)
    tile = np.searchsorted(np.quantile(cloud.gps_time, [0.25, 0.5, 0.75]), cloud.gps_time)
    paths = [folder / f"tile_{number}.laz" for number in range(4)]
    for number, target in enumerate(paths):
        kept = (tile == number) & (np.random.default_rng(1).random(len(tile)) >= left_out * (number == 3))
        if left_out == 0.0 or number == 3:
            part = laspy.LasData(cloud.header)
            part.points = cloud.points[kept]
            part.write(str(target))
    return paths


def test_of_four_tiles_one_that_changed_is_read_again_and_the_curbs_far_from_it_stay(made_survey, tmp_path):
    """Worker processes go on from what threads have left, and threads from what those have left."""
    sample, heard, far_heard = made_survey(length=80.0, pulse_rate=20_000.0), Heard(), Heard()
    tiles = write_tiles(sample[1], tmp_path)
    boundaries(sample, tmp_path / "work", clouds=tiles)
    write_tiles(sample[1], tmp_path, 0.1)
    changed = numbers_of(boundaries(sample, tmp_path / "work", clouds=tiles[::-1], workers=2, progress=heard))
    assert changed == numbers_of(boundaries(sample, "", clouds=tiles))
    assert heard.says("3 of 4 parts of the work were finished by an earlier run") and not heard.says("made anew")
    boundaries(sample, tmp_path / "work", clouds=tiles[:3], progress=far_heard)
    assert far_heard.says("3 of 3 parts")


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
