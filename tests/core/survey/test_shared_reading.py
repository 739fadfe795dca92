"""A survey read part by part by workers: the points that threads of one process read, to the last bit; and what happens when a worker ends."""

import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drives import ahead, bend, chain, contents, drive, joined, surveyed_points, write_cloud
from heard import Heard
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.execution import processes
from lanewright.core.execution import tasks as interpreter
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.phase import Threads
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.survey import blocks
from lanewright.core.survey import open_survey as opening
from lanewright.core.survey.adjustment import trajectory_fit
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.store import section_store
from lanewright.core.survey.survey import SurveySettings, survey_in_file

SETTINGS = SurveySettings(block=700)   # points


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    few_samples(monkeypatch)
    monkeypatch.setattr(blocks, "READING", replace(blocks.READING, part_points=2000))
    monkeypatch.setattr(section_store, "STRETCH_POINTS", 2000)


def few_samples(patch):
    """Only the first blocks are looked at by the caller for the height, and one place for what does not fit."""
    patch.setattr(blocks, "READING", replace(blocks.READING, height_samples=20))
    patch.setattr(trajectory_fit, "PLACES_READ", 1)


@pytest.fixture(scope="module")
def street(tmp_path_factory):
    """(trajectory, paths) of a bend that is driven twice, the second time 6 cm aside, in a LAS and a LAZ file."""
    folder = tmp_path_factory.mktemp("street")
    path = chain(ahead(30), bend(30, 60), ahead(30))
    drives = [drive(path, start=1000.0), drive(path, start=2000.0)]
    clouds = []
    for k, (trajectory, kind) in enumerate(zip(drives, ("las", "laz"))):
        x, y, z, measured = surveyed_points(trajectory, lines=4)
        clouds.append(write_cloud(folder / f"drive{k}.{kind}", x, y, z + 0.06 * k, measured, crs="EPSG:32632",
                                  intensity=np.arange(len(x)) % 997, channel=np.arange(len(x)) % 2))
    return joined(*drives), clouds


def opened(street, executor=None, progress=None, settings=SETTINGS, **execution):
    """(contents, what is known of all) of the survey, read by an executor or as settings have it."""
    trajectory, clouds = street
    with pytest.MonkeyPatch.context() as patch:
        if executor is not None:
            patch.setattr(opening, "executor_for", lambda *_: executor)
        survey = open_survey(clouds, trajectory, settings, progress or Progress(), ExecutionSettings(**execution))
    found = contents(survey).tobytes(), known(survey)
    if survey.file is not None:
        again = survey_in_file(str(survey.file))
        assert (contents(again).tobytes(), known(again)) == found
        again.store.close()
    survey.store.close()
    return found


def known(survey):
    tracks = [(p.x.tobytes(), p.y.tobytes(), p.z.tobytes()) for p in survey.frame.passes]
    return survey.sensor_height, survey.scanner_field, survey.scanners, survey.has_intensity, survey.counts, tracks


@pytest.fixture(scope="module")
def by_threads(street):
    with pytest.MonkeyPatch.context() as patch:
        few_samples(patch)
        return opened(street)


@pytest.fixture(scope="module")
def python():
    return interpreter.find_interpreter()


def test_worker_processes_read_what_threads_read_and_leave_nothing(street, by_threads, python):
    executor = WorkerProcesses(python, 2)
    assert opened(street, executor) == by_threads
    assert not executor.folder.exists()


def test_files_that_workers_hold_open_and_that_windows_does_not_remove_go_with_the_folder(street, by_threads, python, monkeypatch):
    unlink, refused = Path.unlink, []

    def unless_points(path, missing_ok=False):
        if path.name.startswith("points-") and path.suffix == ".bin":
            refused.append(path)
            raise PermissionError(13, "another process uses it", str(path))
        unlink(path, missing_ok)

    monkeypatch.setattr(Path, "unlink", unless_points)
    executor = WorkerProcesses(python, 1)
    assert opened(street, executor) == by_threads
    assert refused and not executor.folder.exists()


@pytest.mark.parametrize("block, points", [(10**6, 1), (40, 500)])
def test_neither_blocks_nor_parts_change_a_point(street, by_threads, python, monkeypatch, block, points):
    monkeypatch.setattr(blocks, "READING", replace(blocks.READING, part_points=points))
    assert opened(street, WorkerProcesses(python, 1), settings=SurveySettings(block=block)) == by_threads


def test_a_survey_without_times_is_read_alike(street, python):
    trajectory, clouds = street
    alone = replace(trajectory, has_time=False), clouds
    assert opened(alone, WorkerProcesses(python, 1)) == opened(alone)


def killed_while_it_reads(executor):
    """Kill a worker that has begun to read."""
    def kill():
        while not (list(executor.folder.glob("points-*")) and executor._all):
            time.sleep(0.005)
        next(iter(executor._all)).process.kill()

    threading.Thread(target=kill, daemon=True).start()
    return executor


def test_a_worker_that_is_killed_while_it_reads_is_replaced_and_nothing_is_lost(street, by_threads, python):
    executor = killed_while_it_reads(WorkerProcesses(python, 1))
    assert opened(street, executor) == by_threads
    assert not executor.folder.exists()


def test_where_workers_keep_ending_the_file_is_named(street, python, monkeypatch):
    monkeypatch.setattr(processes._Worker, "answer_to", lambda worker, task: worker.process.kill())
    executor = WorkerProcesses(python, 1)
    with pytest.raises(RoadExtractionError, match=r"drive\d.la[sz].*fewer workers"):
        opened(street, executor)
    assert not executor.folder.exists()


def test_a_cancel_ends_the_reading_workers_within_two_seconds(street, python):
    class Impatient(Progress):
        at = None

        def report(self, fraction):
            if list(executor.folder.glob("points-*")):
                self.at = self.at or time.monotonic()
                raise Cancelled

    executor, impatient = WorkerProcesses(python, 2), Impatient()
    workers = executor._all
    with pytest.raises(Cancelled):
        opened(street, executor, impatient)
    assert time.monotonic() - impatient.at < 2.0
    assert not executor.folder.exists() and all(worker.process.poll() is not None for worker in workers)


def test_a_folder_that_cannot_be_used_is_named(street, python):
    executor = WorkerProcesses(python, 1)
    executor.folder.rmdir()
    with pytest.raises(RoadExtractionError, match="cannot use the disk.*without worker processes.*folder for temporary files"):
        opened(street, executor)


def test_a_damaged_file_is_named_by_the_worker_that_meets_it(street, python, tmp_path):
    trajectory, (las, _) = street
    cut = tmp_path / "cut.las"
    cut.write_bytes(open(las, "rb").read()[:-60_001])
    with pytest.raises(RoadExtractionError, match="cut.las is (cut off|damaged)"):
        opened((trajectory, [cut]), WorkerProcesses(python, 1))


class StopsReading(Heard):
    """Cancels when so many parts are read."""

    def __init__(self, work, parts):
        super().__init__()
        self.work, self.parts = work, parts

    def report(self, fraction):
        if len(read_parts(self.work)) >= self.parts:
            raise Cancelled


def read_parts(work):
    """{result of a part that was read: number of the file}."""
    return {path: path.stat().st_ino for path in work.glob("kept-*.plain")}


@pytest.mark.parametrize("workers", [0, 2])
def test_a_run_that_was_ended_while_it_read_goes_on_where_it_was(street, by_threads, tmp_path, workers):
    work = tmp_path / "work"
    with pytest.raises(Cancelled):
        opened(street, progress=StopsReading(work, 5), work_folder=str(work), workers=workers)
    done = read_parts(work)
    heard = Heard()
    assert opened(street, progress=heard, work_folder=str(work), workers=workers) == by_threads
    now = read_parts(work)
    assert len(done) >= 5 and len(now) > len(done) and all(now[path] == file for path, file in done.items())
    assert heard.says(f"{len(done) - 3} of ")   # the other files hold what all parts depend on, and what two clouds showed at a look


def test_a_work_folder_keeps_the_points_and_nothing_unfinished(street, by_threads, tmp_path):
    assert opened(street, work_folder=str(tmp_path / "work")) == by_threads
    assert not list(tmp_path.rglob("*.part"))
    heard = Heard()
    assert opened(street, progress=heard, work_folder=str(tmp_path / "work")) == by_threads
    assert heard.says("read by an earlier run")


def zeros(path):
    """A power failure: what was written last has not come to the disk."""
    content = path.read_bytes()
    path.write_bytes(content[:-64] + bytes(64))


@pytest.mark.parametrize("pattern", ["kept-*.plain", "points-*.bin"])
def test_points_that_a_power_failure_damaged_are_read_again(street, by_threads, tmp_path, pattern):
    work = tmp_path / "work"
    assert opened(street, work_folder=str(work)) == by_threads
    for path in work.glob(pattern):
        zeros(path)
    assert opened(street, work_folder=str(work)) == by_threads


def test_of_a_reading_that_a_power_failure_ended_damaged_parts_are_not_used(street, by_threads, tmp_path):
    work = tmp_path / "work"
    with pytest.raises(Cancelled):
        opened(street, progress=StopsReading(work, 3), work_folder=str(work))
    for path in work.glob("points-*.bin"):
        zeros(path)
    assert opened(street, work_folder=str(work)) == by_threads


class Blind(Threads):
    """Workers who do not see the files."""

    def __init__(self, folder):
        super().__init__(1)
        self.folder = folder

    def sees(self, paths):
        return False


def test_what_the_workers_do_not_see_is_read_here(street, by_threads, tmp_path):
    heard = Heard()
    assert opened(street, Blind(tmp_path), heard) == by_threads
    assert heard.says("do not see the point clouds") and not list(tmp_path.iterdir())


class Halving(Threads):
    """Has every item that can be halved done in two."""

    def __init__(self, folder):
        super().__init__(1)
        self.folder, self.halved = folder, 0

    def run(self, phase, items, progress=Progress(), keep=()):
        for item in items:
            *place, first, end = item if phase.join else (0, 0)
            if end - first < 2:
                yield phase.result(item)
                continue
            self.halved += 1
            middle = (first + end) // 2
            yield phase.join([phase.result((*place, first, middle)), phase.result((*place, middle, end))])


def test_halves_of_a_part_are_the_part(street, by_threads, tmp_path):
    executor = Halving(tmp_path)
    assert opened(street, executor) == by_threads
    assert executor.halved > 2


def test_a_file_that_was_written_again_with_other_intensities_is_read_again(street, tmp_path):
    trajectory, clouds = street
    x, y, z, measured = surveyed_points(drive(chain(ahead(30), bend(30, 60), ahead(30)), start=1000.0), lines=4)
    again = write_cloud(tmp_path / "again.las", x, y, z, measured, crs="EPSG:32632", intensity=np.arange(len(x)) % 997)
    one, work = (trajectory, [again]), str(tmp_path / "work")
    before = opened(one, work_folder=work)
    write_cloud(tmp_path / "again.las", x, y, z, measured, crs="EPSG:32632", intensity=np.arange(len(x))[::-1] % 997)
    assert before != opened(one, work_folder=work) == opened(one)
