"""The batch of our algorithms: QGIS's own, with one folder for the results of all surveys; rows that name no place make temporary layers."""

from __future__ import annotations

import time
from pathlib import Path

from processing.core.ProcessingResults import resultsList
from processing.gui import BatchAlgorithmDialog as qgis_batch
from processing.gui import BatchPanel as qgis_batch_panel
from qgis.core import Qgis, QgsProcessing, QgsProcessingAlgorithm, QgsProcessingOutputHtml, QgsProcessingUtils, QgsSettings
from qgis.PyQt.QtWidgets import QDialogButtonBox, QFileDialog, QWidget

from ...algorithms.survey_files import SUFFIXES, VIRTUAL, cloud_files, survey_name
from ...core.common.errors import RoadExtractionError
from ...processing_provider.texts import tr
from ..trajectory_widget import trajectory_beside
from ..widgets import LAST_INPUT, button, folder_for_results
from .database_dialog import destinations, outputs_by_default

CLOUDS = "POINT_CLOUDS"
PATH_WIDTH = 330  # px


def surveys_in(folder: str) -> list[str]:
    """Folders with point clouds, the given one and those below it, and virtual point clouds of other folders: each a survey, by name."""
    paths = [path for path in Path(folder).rglob("*") if path.is_file()]
    folders = {str(path.parent) for path in paths if path.suffix.lower() in SUFFIXES}
    virtual = [str(path) for path in paths if path.suffix.lower() == VIRTUAL]
    return sorted({*folders, *(path for path in virtual if folders.isdisjoint(_folders_of(path)))})


def _folders_of(cloud):
    """The folders of the files of a virtual point cloud; none of one that cannot be used, of which the run says why."""
    try:
        return {str(Path(path).parent) for path in cloud_files([cloud], tr("Point clouds"))}
    except RoadExtractionError:
        return set()


class BatchAlgorithmDialog(qgis_batch.BatchAlgorithmDialog):
    """QGIS's batch of an algorithm; `title` stands in its frame.

    It has the name of QGIS's own, by which widgets know that they stand in the table of a batch.
    """

    def __init__(self, algorithm: QgsProcessingAlgorithm, title: str, parent: QWidget | None = None):
        super().__init__(algorithm, parent)
        self.setWindowTitle(tr("Batch: {title}").format(title=title))
        self.mainWidget().checkLoadLayersOnCompletion.setChecked(True)
        for name in (CLOUDS, "TRAJECTORY"):  # QGIS shows the last ten letters of a path
            if name in self.mainWidget().parameter_to_column:
                self.mainWidget().tblParameters.setColumnWidth(self.mainWidget().parameter_to_column[name], PATH_WIDTH)
        if {CLOUDS, "TRAJECTORY"} <= set(self.mainWidget().parameter_to_column):
            self.buttonBox().addButton(button(tr("Add the surveys of a folder…"), self.choose_surveys, tr(
                "One row for each folder with point clouds, and the trajectory that lies beside them")), QDialogButtonBox.ButtonRole.ResetRole)
        for fill in self.findChildren(qgis_batch_panel.BatchPanelFillWidget):
            if fill.parameterDefinition.name() == CLOUDS:  # QGIS would make a row of every file of whatever kind
                fill.showDirectorySelectionDialog = self.choose_surveys
        self.buttonBox().addButton(button(tr("Save everything to…"), self.choose_folder, tr(
            "One folder for all surveys: of each the layers in one GeoPackage called like the survey, images and reports beside it")),
            QDialogButtonBox.ButtonRole.ResetRole)
        self.updateRunButtonVisibility()  # the box shows all of its buttons when it gets another

    def choose_surveys(self) -> None:
        folder = QFileDialog.getExistingDirectory(self, tr("Folder of the surveys"), QgsSettings().value(LAST_INPUT, ""))
        if folder:
            QgsSettings().setValue(LAST_INPUT, folder)
            self.add_surveys(folder)

    def add_surveys(self, folder: str) -> None:
        """A row for each survey in a folder and below, with its trajectory where one lies beside it."""
        surveys, panel = surveys_in(folder), self.mainWidget()
        row = panel.batchRowCount()
        while row > 0 and not panel.wrappers[row - 1][panel.parameter_to_column[CLOUDS]].parameterValue():
            row -= 1  # rows that are empty are filled first
        for clouds in surveys:
            if row >= panel.batchRowCount():
                panel.addRow(1)
            panel.wrappers[row][panel.parameter_to_column[CLOUDS]].setParameterValue(clouds, self.processingContext())
            drive = trajectory_beside([clouds])
            if drive:
                panel.wrappers[row][panel.parameter_to_column["TRAJECTORY"]].setParameterValue(drive, self.processingContext())
            row += 1
        self.messageBar().clearWidgets()
        self.messageBar().pushMessage("", tr("{count} surveys in {folder}.").format(count=len(surveys), folder=folder), level=Qgis.MessageLevel.Info)

    def choose_folder(self) -> None:
        folder = folder_for_results(self)
        if folder:
            self.save_everything_to(folder)

    def save_everything_to(self, folder: str) -> None:
        """Set the destinations of the rows that have an input."""
        names = self.surveys()
        for row, name in enumerate(names):
            for output, path in destinations(self.algorithm(), folder, name).items():
                self._place(row, output).setValue(path)
        self.messageBar().clearWidgets()
        self.messageBar().pushMessage("", tr("The results of {count} rows go to {folder}: {names}.").format(
            count=len(names), folder=folder, names=", ".join(names)), level=Qgis.MessageLevel.Info)

    def surveys(self) -> list[str]:
        """What the survey of each row is called, as a name of files, no two alike."""
        panel, names = self.mainWidget(), []
        for row in range(panel.batchRowCount()):
            name = self._survey(row).replace("/", "_") or f"{self.algorithm().name()}_{row + 1}"
            alike = sum(earlier == name or earlier.rsplit("_", 1)[0] == name and earlier.rsplit("_", 1)[1].isdigit() for earlier in names)
            names.append(f"{name}_{alike + 1}" if alike else name)
        return names

    def _survey(self, row):
        column = self.mainWidget().parameter_to_column.get(CLOUDS)
        if column is None:
            return ""
        clouds = self.mainWidget().wrappers[row][column].parameterValue() or []
        try:
            return survey_name(cloud_files([clouds] if isinstance(clouds, str) else list(clouds), tr("Point clouds")))
        except RoadExtractionError:
            return ""

    def _place(self, row, output):
        """The cell where a result of a row is named."""
        panel = self.mainWidget()
        return panel.tblParameters.cellWidget(row + 1, panel.parameter_to_column[output])

    def loadHtmlResults(self, results: dict, num: int) -> None:
        """The report of a run into the Results Viewer, by its file. That of QGIS 3.40 forgets the time, and the batch would end with an error."""
        for output in self.algorithm().outputDefinitions():
            if isinstance(output, QgsProcessingOutputHtml) and results.get(output.name()):
                file = Path(results[output.name()])
                temporary = file.is_relative_to(QgsProcessingUtils.tempFolder())
                title = num + 1 if temporary else f"{file.parent.name}/{file.stem}"
                resultsList.addResult(self.algorithm().icon(), f"{output.description()} [{title}]", time.localtime(), str(file))

    def runAlgorithm(self) -> None:
        """Run all rows; one that names no destination makes temporary layers, as in the dialog of a single run."""
        outputs = [definition.name() for definition in self.algorithm().destinationParameterDefinitions()]
        names = [definition.name() for definition in outputs_by_default(self.algorithm())]
        for row in range(self.mainWidget().batchRowCount()):
            if not any(self._place(row, output).getValue() for output in outputs):
                for output in names:
                    self._place(row, output).setValue(QgsProcessing.TEMPORARY_OUTPUT)
        super().runAlgorithm()
