"""The choice of an executor for a run."""

from __future__ import annotations

import os
from dataclasses import dataclass

from ..common.progress import Progress
from ..common.setting import check_limits, setting
from .interpreter import find_interpreter
from .phase import Executor
from .processes import WorkerProcesses
from .threads import Threads
from .work_folder import KeptResults, WorkFolder

PROCESS_POINTS = 100_000_000   # points near the road from which workers pay: they start in seconds, and the points are copied once for them
MOST_AUTOMATIC_WORKERS = 8     # each takes some hundred MB


@dataclass(frozen=True)
class ExecutionSettings:
    """Who does the work.

    Attributes
    ----------
    workers : worker processes; 0 for threads of this process or, for a large survey, one process per processor core
    work_folder : folder in which the points that were read and the results of phases are kept for later runs; "" for none
    """

    workers: int = setting(0, 0, 256, "The number of workers", "", "for the automatic choice")
    work_folder: str = ""

    def __post_init__(self) -> None:
        check_limits(self)


def executor_for(points: int, settings: ExecutionSettings = ExecutionSettings(), progress: Progress = Progress()) -> Executor:
    """The executor of a run; close it at the end.

    Parameters
    ----------
    points : of the survey
    settings : ExecutionSettings
    progress : is told who does the work, where that are not threads as usual
    """
    executor = _executor_for(points, settings, progress)
    return KeptResults(executor, WorkFolder(settings.work_folder)) if settings.work_folder else executor


def _executor_for(points, settings, progress):
    automatic = min(os.cpu_count() or 1, MOST_AUTOMATIC_WORKERS) if points >= PROCESS_POINTS else 0
    workers = settings.workers or automatic
    if not workers:
        return Threads()
    interpreter = find_interpreter()
    if not interpreter:
        progress.info("No Python interpreter was found that worker processes can be started with, so threads of this program do their work.")
        return Threads()
    progress.info(f"Curbs and scanlines are found by {workers} worker process(es), {interpreter}.")
    return WorkerProcesses(interpreter, workers)
