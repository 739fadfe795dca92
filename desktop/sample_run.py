"""The sample survey through the whole chain, in the background, into the project."""

import tempfile
import time
from functools import partial
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsProcessingAlgRunnerTask,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
)

from ..algorithms.destinations import table_of
from ..processing_provider.texts import tr

LENGTH = 120.0  # m of street: seconds to make, and long enough for every kind of marking
LAYERS = ("PASSES", "ROAD_SURFACE", "ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "CURVE_ELEMENTS")


class SampleRun:
    """One run at a time; QGIS's task manager shows its progress and cancels it."""

    def __init__(self, iface):
        self.iface = iface
        self.running = False
        self.context = self.feedback = self.folder = None

    def start(self):
        if self.running:
            self._say(tr("The sample survey is already running."), Qgis.MessageLevel.Info)
            return
        self.running = True
        folder = tempfile.TemporaryDirectory(prefix="lanewright-sample-")
        self.folder = Path(folder.name) / "sample"  # by which its group is called
        self.folder.mkdir()
        # its layers stay in the project until then
        QgsApplication.instance().aboutToQuit.connect(partial(_remove, folder))
        self._run("samplesurvey", dict(
            LENGTH=LENGTH, POINT_CLOUD=str(self.folder / "sample.laz"), TRAJECTORY=str(self.folder / "trajectory.gpkg")
        ), self._survey_made)
        self._say(tr("The sample survey is being made and mapped; its layers appear when they are ready."), Qgis.MessageLevel.Info)

    def _run(self, name, parameters, then):
        algorithm = QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{name}")
        self.context, self.feedback = QgsProcessingContext(), QgsProcessingFeedback(False)
        self.context.setProject(QgsProject.instance())
        self.context.setFeedback(self.feedback)
        # The task takes no ownership of these two
        task = QgsProcessingAlgRunnerTask(algorithm, parameters, self.context, self.feedback)
        task.executed.connect(lambda ok, results: then(algorithm, parameters) if ok else self._failed())
        QgsApplication.taskManager().addTask(task)

    def _survey_made(self, algorithm, parameters):
        wanted = {name: _loaded(self.folder / "road_map.gpkg", name.lower()) for name in LAYERS}
        self._run("roadmap", dict(
            POINT_CLOUDS=[parameters["POINT_CLOUD"]], TRAJECTORY=parameters["TRAJECTORY"],
            INTENSITY_IMAGE=_loaded(self.folder / "intensity.tif"), REPORT=str(self.folder / "report.html"), **wanted
        ), self._mapped)

    def _mapped(self, algorithm, parameters):
        from processing.core.ProcessingResults import resultsList
        from processing.gui.Postprocessing import handleAlgorithmResults

        self.running = False
        handleAlgorithmResults(algorithm, self.context, self.feedback, parameters)
        resultsList.addResult(algorithm.icon(), algorithm.declaration.title(), time.localtime(), parameters["REPORT"])
        self._say(tr("The road map of the sample survey is in the project, its report in the Results Viewer. Its files in {folder} "
                     "are deleted when QGIS is closed: save the layers you want to keep.").format(folder=self.folder),
                  Qgis.MessageLevel.Success)

    def _failed(self):
        self.running = False
        said = self.feedback.textLog().strip().splitlines()
        self._say(tr("The sample survey was not mapped: {reason}").format(reason=said[-1] if said else tr("cancelled")),
                  Qgis.MessageLevel.Warning)

    def _say(self, text, level):
        self.iface.messageBar().pushMessage("Lanewright", text, level=level)


def _loaded(path, table=""):
    """An output that is put into the project when it is ready."""
    from qgis.core import QgsProcessingOutputLayerDefinition

    return QgsProcessingOutputLayerDefinition(table_of(path, table) if table else str(path), QgsProject.instance())


def _remove(folder):
    try:
        folder.cleanup()
    except OSError:
        pass  # a file that is still open on Windows; the system empties its folder for temporary files
