"""Stages of the road map that worker processes do: road points, image, paint and markings of threads, to the last bit."""

import threading
import time

import pytest
from executed_stages import PHASES, found_by, functions_of
from lanewright.core.common.errors import Cancelled
from lanewright.core.common.progress import Progress
from lanewright.core.execution.keep import work_folder
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.execution.tasks import find_interpreter

pytestmark = pytest.mark.slow

KILLED_IN = ("surface_points", "corrected_of_stretch", "tiles_of_image", "paint_of_window", "links_of_windows",
             "combs_of_windows", "pieces_of_clusters", "heights_of_windows")


@pytest.fixture(scope="module")
def sample(made_survey):
    return made_survey(length=30.0, pulse_rate=40_000.0)


class Noting(WorkerProcesses):
    """Notes which phases it was given, and kills a worker the first time it is given some of them."""

    def __init__(self, workers, killed_in=()):
        super().__init__(find_interpreter(), workers)
        self.tasks, self.killed_in = {}, set(killed_in)

    def run(self, phase, items, *others):
        items = list(items)
        names = set(functions_of(phase, items))
        self.tasks.update({name: max(len(items), self.tasks.get(name, 0)) for name in names})
        killer = threading.Thread(target=self.kill_one, daemon=True)
        if killed := self.killed_in & names:
            self.killed_in -= names
            if any(worker.process.poll() is not None for worker in self._all):
                self.release()   # it had no task when it was killed; no item may lose two workers
            killer.start()
        yield from super().run(phase, items, *others)
        if killed:
            killer.join()

    def kill_one(self):
        until = time.monotonic() + 20.0
        while time.monotonic() < until:
            for worker in list(self._all):
                if worker.process.poll() is None:
                    worker.process.kill()
                    return
            time.sleep(0.005)


@pytest.fixture(scope="module")
def by_threads(sample):
    return found_by(sample)


def test_worker_processes_that_are_killed_in_one_phase_after_another_find_what_threads_find(sample, by_threads):
    """They are replaced, and nothing is lost."""
    executor = Noting(1, KILLED_IN)
    assert found_by(sample, executor) == by_threads
    assert all(executor.tasks[name] > 1 for name in PHASES) and not executor.killed_in and not executor.folder.exists()


def test_worker_processes_find_what_threads_find_and_in_a_work_folder_do_nothing_again(sample, by_threads, tmp_path):
    work, first, again = work_folder(str(tmp_path / "work")), Noting(2), Noting(2)
    assert found_by(sample, first, work) == by_threads
    assert all(first.tasks[name] > 1 for name in PHASES)
    kept = files_of(work)
    assert found_by(sample, again, work) == by_threads
    assert not any(again.tasks.values()) and files_of(work) == kept and not any("part" in name for name in kept)


def files_of(work):
    return {path.name: path.stat().st_size for path in work.rglob("*") if path.is_file()}


def test_cancel_while_paint_is_extracted_ends_the_workers_and_leaves_nothing(sample):
    class Impatient(Progress):
        at = None

        def report(self, fraction):
            self.at = self.at or time.monotonic()
            raise Cancelled

    executor, impatient = Noting(2), Impatient()
    with pytest.raises(Cancelled):
        found_by(sample, executor, progress=impatient)
    assert time.monotonic() - impatient.at < 2.0 and not executor.folder.exists()
