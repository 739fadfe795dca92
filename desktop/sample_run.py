"""The sample survey through the whole chain, in the background, into the project."""

import tempfile
import time
from functools import partial
from pathlib import Path

from qgis.core import Qgis, QgsApplication, QgsProcessingOutputLayerDefinition, QgsProject

from ..algorithms.destinations import table_of
from ..processing_provider.texts import tr
from .background import BackgroundRun
from .widgets import say

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
        layers = {name: _loaded(self.folder / "road_map.gpkg", name.lower()) for name in LAYERS}
        self.running = BackgroundRun("roadmap", dict(
            POINT_CLOUDS=[made.parameters["POINT_CLOUD"]], TRAJECTORY=made.parameters["TRAJECTORY"],
            INTENSITY_IMAGE=_loaded(self.folder / "intensity.tif"), REPORT=str(self.folder / "report.html"), **layers), self._mapped)

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


def _loaded(path, table=""):
    """An output that is put into the project when it is ready."""
    return QgsProcessingOutputLayerDefinition(table_of(path, table) if table else str(path), QgsProject.instance())


def _remove(folder):
    try:
        folder.cleanup()
    except OSError:
        pass  # a file that is still open on Windows; the system empties its folder for temporary files
