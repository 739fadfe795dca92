"""The choice of an executor for a run."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path

from ..common.progress import Progress
from ..common.setting import check_limits, setting
from .cluster import Cluster, check_address, cluster_of
from .keep import Keep, work_folder
from .phase import Executor, Threads
from .processes import WorkerProcesses
from .tasks import find_interpreter
from .weights import EXECUTION


@dataclass(frozen=True)
class ExecutionSettings:
    """Who does the work. workers : worker processes; 0 for threads of this process or, for a large survey, up to one process per processor core"""

    workers: int = setting(0, 0, 256, "The number of workers", "", "for the automatic choice")
    work_folder: str = ""   # folder in which results are kept for later runs; "" for none
    scheduler: str = ""   # address of a running Dask scheduler whose workers do the work instead; "" for none
    insecure: bool = False   # whether the connection to it may go unencrypted beyond this computer

    def __post_init__(self) -> None:
        check_limits(self)
        if self.scheduler:
            check_address(self.scheduler, self.insecure)

    @property
    def work(self) -> Path | None:
        """The work folder, if there is one; refused where nothing can be written there."""
        return work_folder(self.work_folder) if self.work_folder else None


def cluster_for(settings: ExecutionSettings, progress: Progress = Progress()) -> Cluster | None:
    """The Dask cluster of a run, None where there is none; asked for before the survey is read, as there is much that it may lack."""
    return cluster_of(settings.scheduler, settings.insecure, settings.work, progress) if settings.scheduler else None


def executor_for(points: int, settings: ExecutionSettings = ExecutionSettings(), progress: Progress = Progress(),
                 cluster: Cluster | None = None) -> Executor:
    """The executor of a run over files with so many points; close it at the end. `cluster` is the result of `cluster_for`."""
    executor: Executor = cluster or _executor_for(points, settings, progress)
    work = settings.work
    return Keep(executor, work) if work else executor


def automatic_workers(points: int) -> int:
    """How many worker processes are started for so many points where the user leaves that open; 0 for threads.

    Threads wait for each other in Python, and no more than four are started. Processes take a second to start, and each needs memory.
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    workers = min(cores, int(points / EXECUTION.worker_points), int(_memory() / EXECUTION.least_memory))
    return workers if workers > 1 else 0


def _memory():
    """Bytes of memory of this computer; no limit where the system does not tell."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return math.inf


def _executor_for(points, settings, progress):
    workers = settings.workers or automatic_workers(points)
    if not workers:
        return Threads()
    interpreter = find_interpreter()
    if not interpreter:
        progress.info("No Python interpreter was found that worker processes can be started with, so threads of this program do their work.")
        return Threads()
    progress.info(f"The work is shared among {workers} worker process(es), {interpreter}.")
    return WorkerProcesses(interpreter, workers, settings.work)
