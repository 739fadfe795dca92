"""Lanewright in the Processing toolbox: its algorithms and models."""

from pathlib import Path

from qgis.core import Qgis, QgsApplication, QgsProcessingModelAlgorithm, QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from ..algorithms.catalogue import ALGORITHMS
from .algorithm import LanewrightAlgorithm
from .texts import tr

RESOURCES = Path(__file__).resolve().parents[1] / "resources"

# id of a model -> what it was called in version 0.1.0
OLD_NAMES = {"roadmapstages": "Road map stages", "scanlineboundarystages": "Boundaries from scanlines",
             "markingsanddrivinglineswithassessment": "Markings and driving lines with assessment"}


class LanewrightProvider(QgsProcessingProvider):
    def id(self):
        return "lanewright"

    def name(self):
        return "Lanewright"

    def longName(self):
        return "Lanewright: road maps from mobile laser scanning"

    def icon(self):
        return QIcon(str(RESOURCES / "icon.svg"))

    def loadAlgorithms(self):
        for declaration in ALGORITHMS:
            self.addAlgorithm(LanewrightAlgorithm(declaration()))
        for path in sorted((RESOURCES / "models").glob("*.model3")):
            model = read_model(path)
            if model is not None:
                self.addAlgorithm(model)
                # by which scripts and models called it before ids had no spaces
                QgsApplication.processingRegistry().addAlgorithmAlias(f"{self.id()}:{OLD_NAMES.get(model.name(), '')}", f"{self.id()}:{model.name()}")


# The models that come along, as the toolbox lists them: their inputs and results explained in the words of their stages.


class LanewrightModel(QgsProcessingModelAlgorithm):
    """A model of the plugin: its id has no spaces, its title is in the user's language."""

    def createInstance(self):
        model = LanewrightModel()
        model.loadVariant(self.toVariant())
        return model

    def name(self):
        return model_id(super().name())

    def displayName(self):
        return tr(super().name())

    def createCustomParametersWidget(self, parent=None):
        from ..desktop.dialogs.algorithm_dialog import LanewrightDialog

        return LanewrightDialog(self, self.displayName(), parent)


def model_id(title):
    """The id of a model: "Road map stages" -> "roadmapstages"."""
    return "".join(letter for letter in title.lower() if letter.isalnum())


def read_model(path):
    """The model of a .model3; None where QGIS cannot read it."""
    model = LanewrightModel()
    if not model.fromFile(str(path)):
        return None
    explain(model)
    return model


def explain(model):
    """Give a model the labels, the help and the widgets of the parameters it hands its own on to.

    Those texts are written once, on the parameters of the stages, and are translated there.
    Results keep their names: a model's results are called by them.
    """
    texts = model.helpContent()
    texts["ALG_DESC"] = tr(texts.get("ALG_DESC", ""))
    texts["HELP_URL"] = "lanewright:models"   # the page of the manual
    for name, parameter in asked_for(model).items():
        texts[name] = parameter.help()
        definition = model.parameterDefinition(name).clone()
        definition.setDescription(parameter.description())
        definition.setHelp(parameter.help())
        definition.setMetadata(parameter.metadata())  # which names the widget of the dialog
        model.updateModelParameter(definition)
    texts.update(handed_back(model))
    model.setHelpContent(texts)
    for stage in model.childAlgorithms().values():
        stage.setDescription(tr(stage.description()))  # the boxes in the designer, and the lines of the log
        model.setChildAlgorithm(stage)
    model.setGroup(tr("Models"))


def asked_for(model):
    """{input of the model: the parameter it goes to}, of the first stage that takes it."""
    parameters = {}
    for child in model.childAlgorithms().values():
        algorithm = child.algorithm()
        if algorithm is None:  # before the provider is registered
            continue
        for name, sources in child.parameterSources().items():
            for source in sources:
                if source.source() == Qgis.ProcessingModelChildParameterSource.ModelParameter:
                    # a copy: the stage may go before its parameter is asked
                    parameters.setdefault(source.parameterName(), algorithm.parameterDefinition(name).clone())
    return parameters


def handed_back(model):
    """{result of the model: help of the stage's result}."""
    names = {definition.description(): definition.name() for definition in model.destinationParameterDefinitions()}
    help_by_result = {}
    for child in model.childAlgorithms().values():
        algorithm = child.algorithm()
        if algorithm is not None:
            for output in child.modelOutputs().values():
                help_by_result[names[output.description()]] = algorithm.parameterDefinition(output.childOutputName()).help()
    return help_by_result


def keep_task_threads() -> None:
    """Let the threads of QGIS's task manager wait for the next run for as long as QGIS runs; by default one ends after 30 s without work.

    With a thread ends its PROJ context, and every QgsCoordinateReferenceSystem that was first made in it, or that QGIS has cached from it since,
    loses its definition: it still says EPSG:32650 and that it is valid, but its WKT is empty (seen in 3.40.6 and 3.44.15). The layers of a run
    would then be saved and exported without their CRS, and the next run would find none.
    """
    manager = QgsApplication.taskManager()
    if hasattr(manager, "threadPool"):
        manager.threadPool().setExpiryTimeout(-1)
