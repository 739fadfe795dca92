"""Stages of the road map that worker processes do: road points and image of threads, to the last bit."""

import threading
import time

import numpy as np
import pytest
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.interpreter import find_interpreter
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.execution.work_folder import KeptResults, WorkFolder
from lanewright.core.intensity import correction
from lanewright.core.intensity import image as imaging
from lanewright.core.intensity.correction import correct_intensity
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from lanewright.core.road.surface import extract
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.survey import open_survey as opening
from lanewright.core.survey import point_density
from lanewright.core.survey.point_density import cube_densities

pytestmark = pytest.mark.slow
PHASES = ["cubes_of_stretch", "surface_points", "levels_of_stretch", "corrected_of_stretch", "window_of_image", "sums_of_pieces"]


@pytest.fixture(autouse=True)
def small_tasks(monkeypatch):
    for module in (extract, correction, point_density):
        monkeypatch.setattr(module, "STRETCH_POINTS", 40_000)
    monkeypatch.setattr(imaging, "PIECES_PER_TASK", 3)


@pytest.fixture(scope="module")
def sample(made_survey):
    return made_survey(length=40.0, pulse_rate=40_000.0)


class Noting(WorkerProcesses):
    """Notes which phases it was given, and kills a worker in one of them."""

    def __init__(self, workers, killed_in=""):
        super().__init__(find_interpreter(), workers)
        self.tasks, self.killed_in = {}, killed_in

    def run(self, phase, items, *others):
        items, name = list(items), phase.function.__name__
        self.tasks[name] = len(items)
        if name == self.killed_in:
            threading.Thread(target=self.kill_one, daemon=True).start()
        return super().run(phase, items, *others)

    def kill_one(self):
        until = time.monotonic() + 20.0
        while time.monotonic() < until:
            for worker in list(self._all):
                if worker._process.poll() is None:
                    worker._process.kill()
                    return
            time.sleep(0.005)


def found_by(sample, executor=None, work=None):
    """All numbers of road points, outline and image."""
    made, path = sample
    with pytest.MonkeyPatch.context() as patch:
        if executor is not None:
            patch.setattr(opening, "executor_for", lambda *_: KeptResults(executor, work) if work else executor)
        survey = opening.open_survey([path], made.trajectory, execution=ExecutionSettings(work_folder=str(work.path) if work else ""))
    try:
        edges = draw_boundaries(find_curb_points(survey, BoundarySettings("profiles")), survey.frame).edges
        road_points, surface = extract_road_surface(survey, edges)
        density = cube_densities(road_points)
        selected = [np.array(road_points.section(*key).records).tobytes() for key in road_points.all_sections()]
        road_points, report = correct_intensity(road_points, survey.frame)
        image = make_intensity_image(road_points)
        pixels = image.read_pixels(0, 0, image.width, image.height).tobytes()
        image.close()
        corrected = [road_points.section(*key).corrected.tobytes() for key in road_points.all_sections()]
        return selected, corrected, surface.area.tobytes(), surface.status.tolist(), density, report, pixels
    finally:
        survey.store.close()


@pytest.fixture(scope="module")
def by_threads(sample):
    return found_by(sample)


@pytest.mark.parametrize("workers", [1, 2])
def test_worker_processes_select_and_interpolate_what_threads_do_and_leave_nothing(sample, by_threads, workers):
    executor = Noting(workers)
    assert found_by(sample, executor) == by_threads
    assert all(executor.tasks[name] > 1 for name in PHASES) and not executor.folder.exists()


@pytest.mark.parametrize("phase", ["surface_points", "corrected_of_stretch", "sums_of_pieces"])
def test_a_worker_that_is_killed_is_replaced_and_nothing_is_lost(sample, by_threads, phase):
    executor = Noting(1, phase)
    assert found_by(sample, executor) == by_threads
    assert not executor.folder.exists()


def test_a_work_folder_keeps_nothing_of_these_stages(sample, by_threads, tmp_path):
    work = WorkFolder(str(tmp_path / "work"))
    assert found_by(sample, Noting(2), work) == by_threads
    kept = sorted(path.name for path in work.path.rglob("*") if path.is_file())
    assert found_by(sample, Noting(2), work) == by_threads
    assert sorted(path.name for path in work.path.rglob("*") if path.is_file()) == kept and not any("part" in name for name in kept)
