"""An algorithm run in the background; QGIS's task manager shows its progress and cancels it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from qgis.core import QgsApplication, QgsProcessingAlgRunnerTask, QgsProcessingContext, QgsProcessingFeedback, QgsProject

from ..processing_provider.texts import tr


class BackgroundRun:
    """One run, begun when it is made; keep it until it ends, for QGIS keeps no reference.

    Parameters
    ----------
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
        QgsApplication.taskManager().addTask(self.task)

    def _ended(self, fine, results, ended):
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
