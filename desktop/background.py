"""What runs in the background, shown and cancelled by QGIS's task manager: an algorithm, a look at points, the sample survey."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsProcessingAlgRunnerTask,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputLayerDefinition,
    QgsProject,
    QgsTask,
)
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer

from ..algorithms.destinations import table_of
from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.parallel import cancellation_scope
from ..core.common.progress import RemainingTime
from ..processing_provider.call import FeedbackProgress
from ..processing_provider.texts import told, tr
from .widgets import say

# whoever holds context and feedback of a run -> its task: QGIS keeps no reference, and goes on reading and writing them until the run has ended
UNDER_WAY: dict[object, QgsTask] = {}
LONGEST_END = 10_000   # ms that a cancelled run is waited for; it ends within two seconds


def end_runs() -> None:
    """Cancel every run and wait for it, before the plugin goes and with it the provider: a run asks for it until its end."""
    for task in [*UNDER_WAY.values()]:
        if not sip.isdeleted(task):
            task.cancel()
    clock = QElapsedTimer()
    clock.start()
    while not all(map(sip.isdeleted, UNDER_WAY.values())) and clock.elapsed() < LONGEST_END:
        QCoreApplication.processEvents()


class BackgroundRun:
    """One run, begun when it is made, and kept until it ends, whoever forgets it.

    name : of one of our algorithms
    parameters : of the run
    ended : called with the run and whether it went well, on the main thread
    """

    def __init__(self, name: str, parameters: dict[str, Any], ended: Callable[[BackgroundRun, bool], None]):
        self.algorithm = QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{name}")
        self.parameters, self.results = parameters, {}
        self.context, self.feedback = QgsProcessingContext(), QgsProcessingFeedback(False)
        self.context.setProject(QgsProject.instance())
        self.context.setFeedback(self.feedback)
        self.task = QgsProcessingAlgRunnerTask(self.algorithm, parameters, self.context, self.feedback)
        self.task.executed.connect(lambda fine, results: self._ended(fine, results, ended))
        UNDER_WAY[self] = self.task
        QgsApplication.taskManager().addTask(self.task)

    def _ended(self, fine, results, ended):
        UNDER_WAY.pop(self, None)
        self.results = results
        ended(self, fine)

    def load_results(self) -> None:
        """Put the layers into the project, as QGIS does."""
        from processing.gui.Postprocessing import handleAlgorithmResults

        handleAlgorithmResults(self.algorithm, self.context, self.feedback, self.parameters)

    @property
    def reason(self) -> str:
        """What the log said last: why the run failed."""
        return (self.feedback.textLog().strip().splitlines() or [tr("cancelled")])[-1]


def loaded(destination: str) -> QgsProcessingOutputLayerDefinition:
    """An output that is put into the project when it is ready."""
    return QgsProcessingOutputLayerDefinition(destination, QgsProject.instance())


def with_points(title: str, clouds: Sequence[str], place: Sequence[float], radius: float, work: Callable[[Any], object],
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


def _worked(task, clouds, place, radius, work):
    """What the background does: the result of the work, None where it is no longer wanted."""
    from ..core.survey.las.parallel_reader import points_near

    progress = FeedbackProgress(task, RemainingTime(lambda: 0.0))   # a clock that stands: a task does not say how long it will take
    try:
        with cancellation_scope(progress):
            return {"result": work(points_near(clouds, *place, radius, progress))}  # QGIS asks whether it is empty, which an array refuses to say
    except Cancelled:
        return None


# The sample survey through the whole chain, in the background, into the project.

LENGTH = 120.0  # m of street: seconds to make, and long enough for every kind of marking
LAYERS = ("PASSES", "ROAD_SURFACE", "ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "CURVE_ELEMENTS")


class SampleRun:
    """One run at a time."""

    def __init__(self, iface):
        self.iface = iface
        self.running = self.folder = None

    def start(self):
        if self.running is not None:
            say(self.iface, tr("The sample survey is already running."))
            return
        folder = tempfile.TemporaryDirectory(prefix="lanewright-sample-")
        self.folder = Path(folder.name) / "sample"  # by which its group is called
        self.folder.mkdir()
        # its layers stay in the project until then
        QgsApplication.instance().aboutToQuit.connect(partial(_remove, folder))
        self.running = BackgroundRun("samplesurvey", dict(
            LENGTH=LENGTH, POINT_CLOUD=str(self.folder / "sample.laz"), TRAJECTORY=str(self.folder / "trajectory.gpkg")), self._survey_made)
        say(self.iface, tr("The sample survey is being made and mapped; its layers appear when they are ready."))

    def _survey_made(self, made, fine):
        if not fine:
            self._failed(made)
            return
        layers = {name: loaded(table_of(self.folder / "road_map.gpkg", name.lower())) for name in LAYERS}
        self.running = BackgroundRun("roadmap", dict(
            POINT_CLOUDS=[made.parameters["POINT_CLOUD"]], TRAJECTORY=made.parameters["TRAJECTORY"],
            INTENSITY_IMAGE=loaded(str(self.folder / "intensity.tif")), REPORT=str(self.folder / "report.html"), **layers), self._mapped)

    def _mapped(self, mapped, fine):
        from processing.core.ProcessingResults import resultsList

        if not fine:
            self._failed(mapped)
            return
        self.running = None
        mapped.load_results()
        resultsList.addResult(mapped.algorithm.icon(), mapped.algorithm.declaration.title(), time.localtime(), mapped.parameters["REPORT"])
        say(self.iface, tr("The road map of the sample survey is in the project, its report in the Results Viewer. Its files in {folder} "
                           "are deleted when QGIS is closed: save the layers you want to keep.").format(folder=self.folder),
            Qgis.MessageLevel.Success)

    def _failed(self, run):
        self.running = None
        say(self.iface, tr("The sample survey was not mapped: {reason}").format(reason=run.reason), Qgis.MessageLevel.Warning)


def _remove(folder):
    try:
        folder.cleanup()
    except OSError:
        pass  # a file that is still open on Windows; the system empties its folder for temporary files
