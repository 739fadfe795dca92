"""Points about a place of the map, read and looked at in the background."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from qgis.core import QgsApplication, QgsTask

from ...core.common.errors import Cancelled, RoadExtractionError
from ...core.common.parallel import cancellation_scope
from ...core.common.progress import Progress
from ...core.survey.las.near import points_near
from ...processing_provider.texts import told, tr


def with_points(title: str, clouds: Sequence[str], place: Sequence[float], radius: float, work: Callable[[np.ndarray], object],
                ready: Callable[[QgsTask, object, str], None]) -> QgsTask:
    """Read the points about a place and work on them; keep the task, for QGIS keeps no reference, and cancel it when it is no longer wanted.

    place, radius : x, y in map coordinates, and m either side
    work : from (N, 4) x, y, z and intensity to a result
    ready : called on the main thread with the task, the result and ""; with None and a sentence where the points were not read
    """
    def ended(error, result=None):
        problem = told(str(error)) if isinstance(error, RoadExtractionError) else tr("No points were read.") if result is None else ""
        ready(task, None if result is None else result["result"], problem)

    # silent: a message about its end would lie on the map where the next click goes
    task = QgsTask.fromFunction(title, _worked, clouds, place, radius, work, on_finished=ended, flags=QgsTask.Flag.CanCancel | QgsTask.Flag.Silent)
    QgsApplication.taskManager().addTask(task)
    return task


class _TaskProgress(Progress):
    def __init__(self, task):
        self.task = task

    def report(self, fraction):
        self.check_cancelled()
        self.task.setProgress(100.0 * fraction)

    def check_cancelled(self):
        if self.task.isCanceled():
            raise Cancelled


def _worked(task, clouds, place, radius, work):
    """What the background does: the result of the work, None where it is no longer wanted."""
    progress = _TaskProgress(task)
    try:
        with cancellation_scope(progress):
            return {"result": work(points_near(clouds, *place, radius, progress))}  # QGIS asks whether it is empty, which an array refuses to say
    except Cancelled:
        return None
