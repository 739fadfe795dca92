"""Boundaries found by worker processes: those that threads find, to the last bit; and what happens when a worker ends."""

import threading
import time
from contextlib import closing
from pathlib import Path

import pytest
from curbed_streets import street, survey_of
from executed_boundaries import boundaries, numbers_of
from heard import Heard
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.execution import choice, processes
from lanewright.core.execution import tasks as interpreter
from lanewright.core.execution.choice import ExecutionSettings, executor_for
from lanewright.core.execution.phase import Items, NoSource, Phase, Threads, read_plain, write_plain
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.markings.objects.figures import figure_of_cells
from lanewright.core.road.surface.ground_grid import ground_of_windows
from lanewright.core.survey.blocks import sensor_height_of
from lanewright.core.survey.store.array_file import SharedArrays


def test_an_item_is_made_when_its_turn_comes_and_not_before():
    made = []

    def make(number):
        made.append(number)
        return number

    results = Threads(2).run(Phase(lambda source, item: 10 * item, NoSource()), Items(100, make))
    assert next(results) == 0 and len(made) < 10
    assert list(results) == list(range(10, 1000, 10)) and made == list(range(100))


@pytest.fixture(scope="module")
def python():
    found = interpreter.find_interpreter()
    assert found, "this Python itself can do the work"
    return found


@pytest.fixture(scope="module")
def by_threads():
    return numbers_of(boundaries(Threads(1)))


def test_three_threads_find_what_one_finds(by_threads):
    assert numbers_of(boundaries(Threads(3))) == by_threads


@pytest.mark.slow
def test_worker_processes_find_what_threads_find_and_leave_nothing(by_threads, python):
    executor = WorkerProcesses(python, 2)
    assert numbers_of(boundaries(executor)) == by_threads
    assert not executor.folder.exists()


def killed_while_it_works(executor, times):
    """Kill workers that have a task, so many of them."""
    def kill():
        for _ in range(times):
            while not (busy := [worker for worker in list(executor._all) if worker.process.poll() is None]):
                time.sleep(0.01)
            time.sleep(0.3)
            busy[0].process.kill()
            time.sleep(0.2)

    threading.Thread(target=kill, daemon=True).start()
    return executor


def test_a_worker_that_is_killed_is_replaced_and_nothing_is_lost(by_threads, python):
    executor = killed_while_it_works(WorkerProcesses(python, 1), 1)
    assert numbers_of(boundaries(executor)) == by_threads
    assert not executor.folder.exists()


@pytest.mark.parametrize(("items", "together"), [(40, 2), (70, 4), (9, 1)])
def test_items_that_share_something_go_to_one_worker_and_come_in_order(monkeypatch, items, together):
    """As many together as the phase wants, where each of two workers still has eight rounds."""
    monkeypatch.setattr(WorkerProcesses, "task", lambda self: tasks_of_a_thread)
    with closing(WorkerProcesses("python", 2)) as executor:
        found = list(executor.run(Phase(figure_of_cells, NoSource(), together=4), list(range(items))))
    assert [item for _, item in found] == list(range(items))
    runs = [found[k:k + together] for k in range(0, items, together)]
    assert all(len({task for task, _ in run}) == 1 for run in runs)


def tasks_of_a_thread(phase, items, results):
    for item, result in zip(read_plain(Path(items)), results):
        write_plain(Path(result), (items, item))
    return {}


def test_workers_that_forget_what_they_read_go_on_with_the_next_phase(python):
    survey = survey_of(street())
    with closing(WorkerProcesses(python, 1)) as executor:
        found, workers = [], []
        for _ in range(2):
            arrays = SharedArrays(executor.folder)
            phase, windows = Phase(ground_of_windows, survey, (arrays,), listed=1), [(0, 0, True, False)] * 2
            found.append([arrays.get(place, (3, 4, 5)).tolist() for place, in executor.run_together(phase, windows)])
            workers.append([worker.process.pid for worker in executor._all])
            executor.forget()
    assert str(found[0]) == str(found[1]) and found[0]
    assert workers[0] == workers[1] and len(workers[0]) == 1


def test_where_workers_keep_ending_the_road_is_named(python, monkeypatch):
    monkeypatch.setattr(processes._Worker, "answer_to", lambda worker, task: worker.process.kill())
    executor = WorkerProcesses(python, 1)
    with pytest.raises(RoadExtractionError, match=r"road 0, -?\d+ to \d+ m.*fewer workers"):
        boundaries(executor)
    assert not executor.folder.exists()


def test_cancel_ends_the_workers_within_two_seconds(python):
    class Impatient(Progress):
        at = None

        def report(self, fraction):
            if executor._all:
                self.at = self.at or time.monotonic()
                raise Cancelled

    executor, impatient = WorkerProcesses(python, 2), Impatient()
    workers = executor._all
    with pytest.raises(Cancelled):
        boundaries(executor, progress=impatient)
    assert time.monotonic() - impatient.at < 2.0
    assert not executor.folder.exists() and all(worker.process.poll() is not None for worker in workers)


def test_a_bug_in_a_worker_keeps_its_traceback(python):
    executor = WorkerProcesses(python, 1)
    with pytest.raises(RuntimeError, match="TypeError.*sensor_height_of"):
        list(executor.run(Phase(sensor_height_of, survey_of(street()), ("more", "arguments", "than it takes")), [0]))
    executor.close()


def test_a_full_or_missing_folder_for_temporary_files_is_named(python):
    executor = WorkerProcesses(python, 1)
    executor.folder.rmdir()
    with pytest.raises(RoadExtractionError, match="folder for temporary files"):
        boundaries(executor, "profiles")


def test_threads_do_small_surveys_and_worker_processes_those_that_ask_for_them(python):
    assert isinstance(executor_for(1_000_000), Threads)
    heard = Heard()
    executor = executor_for(1_000_000, ExecutionSettings(workers=2), heard)
    assert isinstance(executor, WorkerProcesses) and executor.workers == 2 and "2 worker process" in heard.said[0]
    executor.close()


@pytest.mark.parametrize(("points", "cores", "gibibytes", "workers"), [
    (9_000_000, 4, 16, 0), (10**9, 1, 16, 0), (10_000_000, 2, 16, 2), (17_000_000, 4, 16, 3), (50_000_000, 4, 16, 4), (50_000_000, 16, 64, 10),
    (10**9, 16, 64, 16), (10**9, 16, 4, 4), (10**9, 16, 1, 0)])
def test_a_large_survey_has_as_many_worker_processes_as_it_and_the_computer_can_use(monkeypatch, points, cores, gibibytes, workers):
    monkeypatch.setattr(choice.os, "sched_getaffinity", lambda _: set(range(cores)), raising=False)
    monkeypatch.setattr(choice, "_memory", lambda: gibibytes * 2**30)
    assert choice.automatic_workers(points) == workers


def test_an_interpreter_that_cannot_import_a_package_is_not_taken_for_another_program(python, monkeypatch):
    assert interpreter._can_work(python)
    monkeypatch.setattr(interpreter, "IMPORTED", ("no_such_package",))
    monkeypatch.setattr(interpreter, "_runs_this", lambda path: False)
    assert not interpreter._can_work(python)


def test_where_no_interpreter_can_do_the_work_one_line_says_so_and_threads_do_it(monkeypatch):
    monkeypatch.setattr(interpreter, "candidates", lambda: iter(["/bin/false", "/no/such/python"]))
    interpreter.find_interpreter.cache_clear()
    heard = Heard()
    assert isinstance(executor_for(1_000_000, ExecutionSettings(workers=2), heard), Threads)
    assert len(heard.said) == 1 and "No Python interpreter" in heard.said[0]
    interpreter.find_interpreter.cache_clear()


def test_a_negative_number_of_workers_is_refused():
    with pytest.raises(RoadExtractionError, match="number of workers"):
        ExecutionSettings(workers=-1)


def test_nothing_of_qgis_is_mistaken_for_python(monkeypatch):
    monkeypatch.setattr(interpreter.sys, "executable", "/usr/bin/qgis")
    assert all("qgis" not in path for path in interpreter.candidates())


def test_no_interpreter_of_the_current_folder_is_taken(tmp_path, monkeypatch):
    """Python inside another program may not know where it lies."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python3").write_text("#!/bin/sh\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(interpreter.sys, "executable", "")
    assert all(Path(path).is_absolute() for path in interpreter.candidates())


