"""The models that come along, as the toolbox lists them: their inputs and results explained in the words of their stages."""

from qgis.core import Qgis, QgsProcessingModelAlgorithm

from .texts import tr

MANUAL_PAGE = "lanewright:models"


def read_model(path):
    """The model of a .model3 in the user's language; None where QGIS cannot read it."""
    model = QgsProcessingModelAlgorithm()
    if not model.fromFile(str(path)):
        return None
    explain(model)
    return model


def explain(model):
    """Give a model the labels and the help of the parameters it hands its own on to.

    Those texts are written once, on the parameters of the stages, and are translated there.
    Results keep their names: a model's results are called by them.
    """
    said = model.helpContent()
    said["ALG_DESC"] = tr(said.get("ALG_DESC", ""))
    said["HELP_URL"] = MANUAL_PAGE
    for name, (label, text) in asked_for(model).items():
        said[name] = text
        definition = model.parameterDefinition(name).clone()
        definition.setDescription(label)
        definition.setHelp(text)
        model.updateModelParameter(definition)
    said.update(handed_back(model))
    model.setHelpContent(said)
    model.setGroup(tr("Models"))


def asked_for(model):
    """{input of the model: (label, help) of the parameter it goes to}, of the first stage that takes it."""
    found = {}
    for child in model.childAlgorithms().values():
        algorithm = child.algorithm()
        if algorithm is None:  # before the provider is registered
            continue
        for name, sources in child.parameterSources().items():
            for source in sources:
                if source.source() == Qgis.ProcessingModelChildParameterSource.ModelParameter:
                    definition = algorithm.parameterDefinition(name)
                    found.setdefault(source.parameterName(), (definition.description(), definition.help()))
    return found


def handed_back(model):
    """{result of the model: help of the stage's result}."""
    names = {definition.description(): definition.name() for definition in model.destinationParameterDefinitions()}
    found = {}
    for child in model.childAlgorithms().values():
        algorithm = child.algorithm()
        if algorithm is not None:
            for output in child.modelOutputs().values():
                found[names[output.description()]] = algorithm.parameterDefinition(output.childOutputName()).help()
    return found
