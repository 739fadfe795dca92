"""The dialog of our algorithms: QGIS's own, with one place to save everything to, and presets of the settings."""

from __future__ import annotations

import json
from pathlib import Path

from processing.gui.AlgorithmDialog import AlgorithmDialog
from qgis import utils
from qgis.core import Qgis, QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingUtils, QgsProject, QgsSettings
from qgis.PyQt.QtWidgets import QDialogButtonBox, QInputDialog, QMenu, QTextBrowser, QWidget

from ...algorithms.destinations import package_and_table
from ...algorithms.survey_files import cloud_files, survey_name
from ...core.common.errors import RoadExtractionError
from ...processing_provider.results.runs import last_run
from ...processing_provider.texts import tr
from ..review.corrections_layer import SURVEY, corrections_layers
from ..widgets import button, folder_for_results, tell_result
from .batch_dialog import BatchAlgorithmDialog
from .database_dialog import DatabaseDialog, database_destinations, destinations, outputs_by_default
from .stage_inputs import name_by_survey, presets

PRESETS = "lanewright/presets"
SETTINGS = ("number", "enum", "boolean", "string", "crs", "expression", "distance")  # what a preset holds: no data, no destination
FEWEST_OUTPUTS = 3  # that are worth one place for all


class LanewrightDialog(AlgorithmDialog):
    """QGIS's dialog of an algorithm; `title` stands in its frame."""

    def __init__(self, algorithm: QgsProcessingAlgorithm, title: str, parent: QWidget | None = None):
        super().__init__(algorithm, False, parent)
        self.setWindowTitle(title)
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
        self.setParameters(presets(algorithm, QgsProject.instance(), utils.iface.activeLayer() if utils.iface is not None else None))
        wrappers = self.mainWidget().wrappers
        if {"CORRECTIONS", "POINT_CLOUDS"} <= set(wrappers):
            clouds = wrappers["POINT_CLOUDS"]
            clouds.widgetValueHasChanged.connect(lambda *changed: self._offer_corrections(clouds.parameterValue()))
        self.named = name_by_survey(self, QgsProject.instance())
        help_shown = self.findChild(QTextBrowser, "textShortHelp")
        if help_shown is not None:
            help_shown.setHtml(help_shown.toHtml().replace(algorithm.displayName(), title, 1))

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

    def _button(self, text, tip):
        push_button = button(text, tip=tip)
        self.buttonBox().addButton(push_button, QDialogButtonBox.ButtonRole.ResetRole)
        return push_button

    # -- everything to one place ----------------------------------------------------------------

    def choose_folder(self) -> None:
        folder = folder_for_results(self)
        if folder:
            self.save_everything_to(folder)

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

    def _say(self, text):
        self.messageBar().clearWidgets()
        self.messageBar().pushMessage("", text, level=Qgis.MessageLevel.Info)

    # -- presets ----------------------------------------------------------------------------------

    def settings(self) -> dict:
        """The values of the settings, as JSON holds them."""
        wrappers = self.mainWidget().wrappers
        return {definition.name(): definition.valueAsJsonObject(wrappers[definition.name()].parameterValue(), self.processingContext())
                for definition in self.algorithm().parameterDefinitions() if definition.type() in SETTINGS and definition.name() in wrappers}

    def save_preset(self, name: str) -> None:
        kept = presets_of(self.algorithm().name())
        _keep(self.algorithm().name(), {**kept, name: self.settings()})

    def load_preset(self, name: str) -> None:
        """Set what the preset holds; a setting that the algorithm no longer has is passed over."""
        names = {definition.name() for definition in self.algorithm().parameterDefinitions()}
        values = presets_of(self.algorithm().name())[name]
        self.setParameters({setting: value for setting, value in values.items() if setting in names})
        self._say(tr("Preset {name}: {count} settings.").format(name=name, count=len(values)))

    def remove_preset(self, name: str) -> None:
        kept = presets_of(self.algorithm().name())
        kept.pop(name, None)
        _keep(self.algorithm().name(), kept)

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
