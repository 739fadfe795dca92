"""Builds the graphical models of resources/models from the recipes in models.py.

Run with QGIS's Python after an algorithm gained or lost a parameter: tools/make_model.sh
"""

import sys

from models import RECIPES
from plugin_package import ROOT, load

FOLDER = ROOT / "resources" / "models"
GROUP = "Models"
STEP_X, STEP_Y = 300, 130


def definitions():
    """Every input a model may have, by name; its help is that of the stage it goes to."""
    from lanewright.algorithms.road import DetectBoundaries
    from lanewright.processing_provider.algorithm import qgis_parameter
    from qgis.core import (
        QgsProcessing,
        QgsProcessingParameterCrs,
        QgsProcessingParameterFeatureSource,
        QgsProcessingParameterMultipleLayers,
    )

    source = QgsProcessing.SourceType
    made = (
        QgsProcessingParameterMultipleLayers("POINT_CLOUDS", "Point clouds", source.TypeFile),
        QgsProcessingParameterFeatureSource("TRAJECTORY", "Trajectory", [source.TypeVector]),
        QgsProcessingParameterFeatureSource("REFERENCE_MARKINGS", "Reference markings", [source.TypeVectorPolygon]),
        QgsProcessingParameterFeatureSource("REFERENCE_LINES", "Reference lines", [source.TypeVectorLine]),
        qgis_parameter(DetectBoundaries().parameter("BOUNDARY_METHOD")),
        QgsProcessingParameterCrs("CRS", "CRS of the point clouds", optional=True),
    )
    return {definition.name(): definition for definition in made}


def add_inputs(model, names):
    from qgis.core import QgsProcessingModelParameter
    from qgis.PyQt.QtCore import QPointF

    known = definitions()
    for row, name in enumerate(names):
        component = QgsProcessingModelParameter(name)
        component.setPosition(QPointF(150, 80 + STEP_Y * row))
        model.addModelParameter(known[name], component)
    model.setParameterOrder(list(names))


def child_id(stages, stage):
    """Numbered, as QGIS lists results in the order of the names of their stages."""
    return f"{list(stages).index(stage) + 1:02d}_{stage}"


def source(text, stages):
    from qgis.core import QgsProcessingModelChildParameterSource as Source

    if text.startswith("@"):
        return Source.fromModelParameter(text[1:])
    child, output = text.split(".")
    return Source.fromChildOutput(child_id(stages, child), output)


def add_stages(model, stages):
    from qgis.core import QgsApplication, QgsProcessingModelChildAlgorithm, QgsProcessingModelOutput
    from qgis.PyQt.QtCore import QPointF

    registry = QgsApplication.processingRegistry()
    read = {text for inputs, _ in stages.values() for text in inputs.values()}
    for number, (stage, (inputs, results)) in enumerate(stages.items()):
        child = QgsProcessingModelChildAlgorithm(f"lanewright:{stage}")
        child.setChildId(child_id(stages, stage))
        child.setDescription(registry.algorithmById(f"lanewright:{stage}").declaration.title())
        child.setPosition(QPointF(150 + STEP_X * (1 + number % 5), 80 + 2 * STEP_Y * (number // 5)))
        for name, text in inputs.items():
            child.addParameterSources(name, [source(text, stages)])
        outputs = {}
        for result in results:
            name, title = result if isinstance(result, tuple) else (result, result)
            title = title.replace("_", " ").capitalize()
            output = QgsProcessingModelOutput(title)
            output.setChildId(child.childId())
            output.setChildOutputName(name)
            output.setDescription(title)
            # Left out, it would be missing to the stage that reads it
            output.setMandatory(f"{stage}.{name}" in read)
            output.setPosition(QPointF(child.position().x() + 60, child.position().y() + STEP_Y))
            outputs[title] = output
        child.setModelOutputs(outputs)
        model.addChildAlgorithm(child)


def build(recipe):
    """Write one model; its inputs and results by name."""
    from lanewright.processing_provider.provider import explain
    from qgis.core import QgsProcessingModelAlgorithm

    model = QgsProcessingModelAlgorithm(recipe.name, GROUP)
    add_inputs(model, recipe.inputs)
    add_stages(model, recipe.stages)
    model.setHelpContent({"ALG_DESC": recipe.description, "ALG_VERSION": "1"})
    results = {output.description(): f"{child.childId()}:{output.childOutputName()}"
               for child in model.childAlgorithms().values() for output in child.modelOutputs().values()}
    model.setOutputOrder([results[title] for title in recipe.results])
    model.updateDestinationParameters()
    explain(model)
    path = FOLDER / f"{recipe.file}.model3"
    if not model.toFile(str(path)):
        sys.exit(f"{path} could not be written.")
    return [definition.name() for definition in model.parameterDefinitions()]


def main():
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    application.initQgis()
    load()
    from lanewright import classFactory

    plugin = classFactory(None)
    plugin.initProcessing()
    FOLDER.mkdir(parents=True, exist_ok=True)
    for recipe in RECIPES:
        print(recipe.file, *build(recipe))
    plugin.unload()


if __name__ == "__main__":
    main()
