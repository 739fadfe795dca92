"""The dialog of our algorithms: QGIS's own, with one place to save everything to, and presets of the settings."""

from __future__ import annotations

import json
import time
from pathlib import Path

from processing.core.ProcessingResults import resultsList
from processing.gui import BatchAlgorithmDialog as qgis_batch
from processing.gui import BatchPanel as qgis_batch_panel
from processing.gui.AlgorithmDialog import AlgorithmDialog
from processing.gui.wrappers import WidgetWrapper
from qgis import utils
from qgis.core import (
    Qgis,
    QgsDataSourceUri,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingAlgRunnerTask,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputHtml,
    QgsProcessingParameterDefinition,
    QgsProcessingUtils,
    QgsProject,
    QgsProviderConnectionException,
    QgsProviderRegistry,
    QgsSettings,
    QgsVectorLayer,
)
from qgis.gui import QgsCollapsibleGroupBox, QgsProviderConnectionComboBox
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QShowEvent
from qgis.PyQt.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFileDialog, QFormLayout, QInputDialog, QLineEdit, QMenu, QTextBrowser, QWidget

from ...algorithms.destinations import package_and_table, table_of
from ...algorithms.survey_input import SUFFIXES, VIRTUAL, cloud_files, survey_name
from ...core.common.errors import RoadExtractionError
from ...processing_provider.results.road_maps import last_run
from ...processing_provider.styling import PROVIDER
from ...processing_provider.texts import tr
from ..background import UNDER_WAY
from ..review.corrections_layer import SURVEY, corrections_layers
from ..survey_widgets import trajectory_beside
from ..widgets import LAST_INPUT, answers, button, column, folder_for_results, tell_result, wrapped
from .stage_inputs import name_by_survey, presets

PRESETS = "lanewright/presets"
SETTINGS = ("number", "enum", "boolean", "string", "crs", "expression", "distance")  # what a preset holds: no data, no destination
FEWEST_OUTPUTS = 3  # that are worth one place for all
MOST_OUTPUTS = 6    # that are shown one below the other; more are folded away, for they have one place for all


class _OnePlaceForAll:
    """What the dialog of a run and that of a batch have in common."""

    def choose_folder(self) -> None:
        folder = folder_for_results(self)
        if folder:
            self.save_everything_to(folder)

    def _button(self, text, tip, what=None):
        push_button = button(text, what, tip)
        self.buttonBox().addButton(push_button, QDialogButtonBox.ButtonRole.ResetRole)
        return push_button

    def _say(self, text):
        self.messageBar().clearWidgets()
        self.messageBar().pushMessage("", text, level=Qgis.MessageLevel.Info)


class LanewrightDialog(_OnePlaceForAll, AlgorithmDialog):
    """QGIS's dialog of an algorithm; `title` stands in its frame."""

    def __init__(self, algorithm: QgsProcessingAlgorithm, title: str, parent: QWidget | None = None):
        super().__init__(algorithm, False, parent)
        self.setWindowTitle(title)
        self.algorithmFinished.connect(lambda *result: UNDER_WAY.pop(self, None))
        if len(outputs_by_default(algorithm)) >= FEWEST_OUTPUTS:
            self.save_button = self._button(tr("Save everything to…"), tr("One place for all results: a folder with the layers as tables of one "
                                                                          "GeoPackage, images and reports beside it; or a database"))
            places = QMenu(self)
            places.addAction(tr("Folder…"), self.choose_folder)
            if any(output.type() == "sink" for output in outputs_by_default(algorithm)):
                places.addAction(tr("Database (PostGIS)…"), self.choose_database)
            self.save_button.setMenu(places)
        self.presets_button = self._button(tr("Presets"), tr("Settings that you keep under a name; data and destinations are no part of them"))
        self.presets = QMenu(self, aboutToShow=self._list_presets)
        self.presets_button.setMenu(self.presets)
        self.updateRunButtonVisibility()  # the box shows all of its buttons when it gets another
        self._fold_outputs([definition.name() for definition in algorithm.destinationParameterDefinitions()])
        self.setParameters(presets(algorithm, QgsProject.instance(), utils.iface.activeLayer() if utils.iface is not None else None))
        wrappers = self.mainWidget().wrappers
        if {"CORRECTIONS", "POINT_CLOUDS"} <= set(wrappers):
            clouds = wrappers["POINT_CLOUDS"]
            clouds.widgetValueHasChanged.connect(lambda *changed: self._offer_corrections(clouds.parameterValue()))
        self.named = name_by_survey(self, QgsProject.instance())
        help_shown = self.findChild(QTextBrowser, "textShortHelp")
        if help_shown is not None:
            help_shown.setHtml(help_shown.toHtml().replace(algorithm.displayName(), title, 1))

    def setCurrentTask(self, task: QgsProcessingAlgRunnerTask) -> None:
        """Begin the run, and stay in memory until it ends."""
        UNDER_WAY[self] = task
        super().setCurrentTask(task)

    def _fold_outputs(self, names):
        """Many results go into a group that is closed at first: what is to be chosen stands above it."""
        shown = [self.mainWidget().wrappers[name] for name in names if name in self.mainWidget().wrappers]
        if len(shown) > MOST_OUTPUTS:
            layout = shown[0].wrappedWidget().parentWidget().layout()
            self.folded = QgsCollapsibleGroupBox(tr("Results"))
            parts = [part for wrapper in shown for part in (wrapper.wrappedLabel(), wrapper.wrappedWidget()) if part is not None]
            layout.insertWidget(layout.indexOf(parts[0]), self.folded)
            column(self.folded, *parts)
            self.folded.setCollapsed(True)

    def showEvent(self, event: QShowEvent) -> None:
        """The focus is on the first parameter, not on the tabs."""
        super().showEvent(event)
        first = next(iter(self.mainWidget().wrappers.values()), None)
        whole = None if first is None else first.widget if isinstance(first, WidgetWrapper) else first.wrappedWidget()
        for part in (whole, *whole.findChildren(QWidget)) if whole is not None else ():
            if part.focusPolicy() & Qt.FocusPolicy.TabFocus == Qt.FocusPolicy.TabFocus and part.isEnabled():
                part.setFocus(Qt.FocusReason.OtherFocusReason)
                return

    def runAsBatch(self) -> None:
        """Our own batch in place of QGIS's."""
        self.close()
        self.batch = BatchAlgorithmDialog(self.algorithm().create(), self.windowTitle(), self.parentWidget())
        self.batch.show()

    def finish(self, successful: bool, result: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback, in_place: bool = False) -> None:
        """Load the results as QGIS does, and say in its message bar where they are and what the run warned of."""
        names = list(context.layersToLoadOnCompletion())
        super().finish(successful, result, context, feedback, in_place)
        run = last_run()
        if successful and run is not None and utils.iface is not None:
            layers = [QgsProcessingUtils.mapLayerFromString(name, context, False) for name in names]
            tell_result(utils.iface, run.title, [layer for layer in layers if layer is not None], run.warnings)

    def _offer_corrections(self, clouds):
        """Offer the corrections of the survey whose point clouds are chosen, and none of another."""
        try:
            survey = survey_name(cloud_files(clouds or [], tr("Point clouds")))
        except RoadExtractionError:  # not yet whole
            return
        layer_by_survey = {layer.customProperty(SURVEY): layer.id() for layer in reversed(corrections_layers(QgsProject.instance()))}
        chosen = self.mainWidget().wrappers["CORRECTIONS"].parameterValue()
        if survey in layer_by_survey or chosen in layer_by_survey.values():
            self.setParameters({"CORRECTIONS": layer_by_survey.get(survey)})

    # -- everything to one place ----------------------------------------------------------------

    def save_everything_to(self, folder: str) -> None:
        """Set the destinations of all results that are made by default."""
        places = destinations(self.algorithm(), folder)
        self.setParameters(places)
        self.say_places(folder, places)

    def say_places(self, folder: str, places: dict[str, str]) -> None:
        """Say that results go to a folder, and which GeoPackage of an earlier run has some already."""
        packages = {Path(place[0]) for place in map(package_and_table, places.values()) if place is not None and Path(place[0]).exists()}
        self._say(" ".join([tr("The {count} results go to {folder}.").format(count=len(places), folder=folder),
                            *(tr("Those of the earlier run in {file} will be replaced.").format(file=package.name) for package in sorted(packages))]))

    def choose_database(self) -> None:
        dialog = self.database = DatabaseDialog(self)
        dialog.accepted.connect(lambda: self.save_layers_to(*dialog.choice))
        dialog.open()

    def save_layers_to(self, connection: str, schema: str, prefix: str = "") -> None:
        """Set the destinations of all layers that are made by default to tables of a schema; files keep theirs."""
        places = database_destinations(self.algorithm(), connection, schema, prefix)
        self.setParameters(places)
        self._say(tr("{count} layers go to the schema {schema} of {connection}.").format(count=len(places), schema=schema, connection=connection))

    # -- presets ----------------------------------------------------------------------------------

    def settings(self) -> dict:
        """The values of the settings, as JSON holds them."""
        wrappers = self.mainWidget().wrappers
        return {definition.name(): definition.valueAsJsonObject(wrappers[definition.name()].parameterValue(), self.processingContext())
                for definition in self.algorithm().parameterDefinitions() if definition.type() in SETTINGS and definition.name() in wrappers}

    def save_preset(self, name: str) -> None:
        _keep(self.algorithm().name(), {**presets_of(self.algorithm().name()), name: self.settings()})

    def load_preset(self, name: str) -> None:
        """Set what the preset holds; a setting that the algorithm no longer has is passed over."""
        names = {definition.name() for definition in self.algorithm().parameterDefinitions()}
        values = presets_of(self.algorithm().name())[name]
        self.setParameters({setting: value for setting, value in values.items() if setting in names})
        self._say(tr("Preset {name}: {count} settings.").format(name=name, count=len(values)))

    def remove_preset(self, name: str) -> None:
        _keep(self.algorithm().name(), {kept: values for kept, values in presets_of(self.algorithm().name()).items() if kept != name})

    def _list_presets(self):
        self.presets.clear()
        names = sorted(presets_of(self.algorithm().name()))
        for name in names:
            self.presets.addAction(name, lambda name=name: self.load_preset(name))
        if names:
            self.presets.addSeparator()
        self.presets.addAction(tr("Save as…"), self._ask_for_name)
        self.presets.addAction(tr("Default values"), self._defaults)
        if names:
            removal = self.presets.addMenu(tr("Remove"))
            for name in names:
                removal.addAction(name, lambda name=name: self.remove_preset(name))

    def _ask_for_name(self):
        name, accepted = QInputDialog.getText(self, tr("Presets"), tr("Name of the preset"))
        if accepted and name.strip():
            self.save_preset(name.strip())

    def _defaults(self):
        self.setParameters({definition.name(): definition.defaultValue() for definition in self.algorithm().parameterDefinitions()
                            if definition.type() in SETTINGS})


def presets_of(algorithm: str) -> dict[str, dict]:
    """{name: {setting: value}} of the presets of an algorithm."""
    try:
        return json.loads(QgsSettings().value(f"{PRESETS}/{algorithm}", "{}"))
    except ValueError:
        return {}


def _keep(algorithm, presets):
    QgsSettings().setValue(f"{PRESETS}/{algorithm}", json.dumps(presets))


# The batch of our algorithms: QGIS's own, with one folder for the results of all surveys; rows that name no place make temporary layers.

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


class BatchAlgorithmDialog(_OnePlaceForAll, qgis_batch.BatchAlgorithmDialog):
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
            self._button(tr("Add the surveys of a folder…"), tr(
                "One row for each folder with point clouds, and the trajectory that lies beside them"), self.choose_surveys)
        for fill in self.findChildren(qgis_batch_panel.BatchPanelFillWidget):
            if fill.parameterDefinition.name() == CLOUDS:  # QGIS would make a row of every file of whatever kind
                fill.showDirectorySelectionDialog = self.choose_surveys
        self._button(tr("Save everything to…"), tr(
            "One folder for all surveys: of each the layers in one GeoPackage called like the survey, images and reports beside it"),
            self.choose_folder)
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
        self._say(tr("{count} surveys in {folder}.").format(count=len(surveys), folder=folder))

    def save_everything_to(self, folder: str) -> None:
        """Set the destinations of the rows that have an input."""
        names = self.surveys()
        for row, name in enumerate(names):
            for output, path in destinations(self.algorithm(), folder, name).items():
                self._place(row, output).setValue(path)
        self._say(tr("The results of {count} rows go to {folder}: {names}.").format(count=len(names), folder=folder, names=", ".join(names)))

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


# Where the results of an algorithm go when they all go to one place: a folder, or PostGIS, whose connection and schema a dialog asks for.

GEOMETRY = "geom"
WITH_GEOMETRY = (Qgis.ProcessingSourceType.VectorPoint, Qgis.ProcessingSourceType.VectorLine, Qgis.ProcessingSourceType.VectorPolygon)


class DatabaseDialog(QDialog):
    """The dialog; `choice` is what was chosen."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent, windowTitle=tr("Save the layers to a database"))
        self.connection = QgsProviderConnectionComboBox(PROVIDER)
        self.schema = QComboBox()
        self.connection.connectionChanged.connect(self._other_connection)
        self.prefix = QLineEdit(placeholderText=tr("such as b12_, where one schema holds several surveys"))
        self.problem = wrapped()
        form = QFormLayout(self)
        form.addRow(self.problem)
        form.addRow(tr("Connection"), self.connection)
        form.addRow(tr("Schema"), self.schema)
        form.addRow(tr("Names of the tables begin with"), self.prefix)
        form.addRow(wrapped(tr("One table for each layer; a table of the same name is replaced. The intensity image and the report are files: choose "
                               "a folder for them too.")))
        self.buttons = answers(self, button(tr("New connection…"), self._make_connection))
        form.addRow(self.buttons)
        self.resize(520, self.sizeHint().height())
        self._other_connection(self.connection.currentConnection())

    def _other_connection(self, name):
        """List the schemas of a connection, or say why there are none."""
        self.schema.clear()
        if not name:
            self._say(tr("QGIS knows no connection to a PostgreSQL database yet. <i>New connection…</i> opens the window where one is made."))
            return
        try:
            schemas = [schema for schema in _connection(name).schemas() if schema != "information_schema" and not schema.startswith("pg_")]
        except QgsProviderConnectionException as problem:
            self._say(str(problem))
            return
        self.schema.addItems(sorted(schemas))
        self._say("" if schemas else tr("The database {name} has no schema.").format(name=name))

    def _say(self, text):
        self.problem.setText(text)
        self.problem.setVisible(bool(text))
        self.buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(not text)

    def _make_connection(self):
        from qgis.utils import iface

        self.reject()  # QGIS's window would stay behind this one
        iface.openDataSourceManagerPage(PROVIDER)

    @property
    def choice(self) -> tuple[str, str, str]:
        """Connection, schema, and what the names of the tables begin with."""
        return self.connection.currentConnection(), self.schema.currentText(), self.prefix.text().strip()


def database_destinations(algorithm: QgsProcessingAlgorithm, connection: str, schema: str, prefix: str = "") -> dict[str, str]:
    """Where each layer goes: a table of a schema, with the connection as QGIS knows it."""
    database, result = _connection(connection), {}
    for definition in outputs_by_default(algorithm):
        if definition.type() == "sink":
            uri = QgsDataSourceUri(database.uri())
            uri.setDataSource(schema, prefix + table_name(definition), GEOMETRY if definition.dataType() in WITH_GEOMETRY else "")
            # a password that QGIS keeps apart stays there
            result[definition.name()] = f"{PROVIDER}://{uri.uri(False)}"
    return result


def table_of_database(layer: QgsVectorLayer) -> str:
    """The destination that is the table of a layer."""
    table = QgsDataSourceUri(layer.source())
    uri = QgsDataSourceUri(table.connectionInfo(False))
    uri.setDataSource(table.schema(), table.table(), table.geometryColumn())
    return f"{PROVIDER}://{uri.uri(False)}"


def _connection(name):
    return QgsProviderRegistry.instance().providerMetadata(PROVIDER).createConnection(name)


def outputs_by_default(algorithm: QgsProcessingAlgorithm) -> list[QgsProcessingParameterDefinition]:
    """The results that are made unless one is left out."""
    return [definition for definition in algorithm.destinationParameterDefinitions() if definition.createByDefault()]


def table_name(definition: QgsProcessingParameterDefinition) -> str:
    """What a result is called in a database, and as a file."""
    return definition.name().split(":")[-1].lower()


def destinations(algorithm: QgsProcessingAlgorithm, folder: str, survey: str = "") -> dict[str, str]:
    """Where each result goes: layers into one GeoPackage called like the algorithm, other files under their own names.

    Where several surveys share the folder, the GeoPackage is called like the survey, and names of other files begin with that.
    """
    result = {}
    for definition in outputs_by_default(algorithm):
        table = table_name(definition)
        if definition.type() == "sink":
            result[definition.name()] = table_of(Path(folder) / f"{survey or algorithm.name()}.gpkg", table)
        else:
            name = f"{survey}_{table}" if survey else table
            result[definition.name()] = str(Path(folder) / f"{name}.{definition.defaultFileExtension()}")
    return result
