"""Builds resources/models/road_map.model3: the stages of the road map, chained as a graphical model.

Run with QGIS's Python after a stage gained or lost a parameter: tools/make_model.sh
"""

import sys

from plugin_package import ROOT, load

TARGET = ROOT / "resources" / "models" / "road_map.model3"
NAME, GROUP = "Road map stages", "Models"
STEP_X, STEP_Y = 300, 130

# child -> (its inputs, the outputs that are the model's). "@NAME" is a model input,
# "child.NAME" another stage's output; what is not named keeps its default.
SURVEY = {"POINT_CLOUDS": "@POINT_CLOUDS", "TRAJECTORY": "@TRAJECTORY", "CRS": "@CRS"}
DRIVE = {"TRAJECTORY": "@TRAJECTORY"}
STAGES = {
    "detectboundaries": ({**SURVEY, "BOUNDARY_METHOD": "@BOUNDARY_METHOD"}, ("ROAD_EDGES",)),
    "extractroadsurface": ({**SURVEY, "ROAD_EDGES": "detectboundaries.ROAD_EDGES"}, ("ROAD_SURFACE",)),
    "correctintensity": ({"ROAD_POINTS": "extractroadsurface.ROAD_POINTS", **DRIVE}, (("OUTPUT", "ROAD_POINTS"),)),
    "intensityimage": ({"ROAD_POINTS": "correctintensity.OUTPUT"}, ("INTENSITY_IMAGE",)),
    "extractmarkings": (
        {"ROAD_POINTS": "correctintensity.OUTPUT", "INTENSITY_IMAGE": "intensityimage.INTENSITY_IMAGE", **DRIVE}, ()),
    "removeoutliers": ({"INPUT": "extractmarkings.MARKING_POINTS"}, ()),
    "clustermarkings": ({"MARKING_POINTS": "removeoutliers.OUTPUT", **DRIVE}, ("MARKINGS",)),
    "fitmarkinglines": (
        {"CLUSTERED_POINTS": "clustermarkings.CLUSTERED_POINTS", "MARKINGS": "clustermarkings.MARKINGS", **DRIVE},
        ("MARKING_LINES",)),
    "drivinglines": (
        {"MARKING_LINES": "fitmarkinglines.MARKING_LINES", "MARKINGS": "clustermarkings.MARKINGS",
         "ROAD_EDGES": "detectboundaries.ROAD_EDGES", "ROAD_POINTS": "correctintensity.OUTPUT", **DRIVE},
        ("DRIVING_LINES", "CURVE_ELEMENTS")),
}


OUTPUT_ORDER = [
    "detectboundaries:Road edges", "extractroadsurface:Road surface", "correctintensity:Road points",
    "intensityimage:Intensity image", "clustermarkings:Markings", "fitmarkinglines:Marking lines",
    "drivinglines:Driving lines", "drivinglines:Curve elements",
]


def add_inputs(model):
    from qgis.core import (QgsProcessing, QgsProcessingModelParameter, QgsProcessingParameterCrs,
                           QgsProcessingParameterFeatureSource, QgsProcessingParameterMultipleLayers)
    from qgis.PyQt.QtCore import QPointF
    from lanewright.processing_provider.road.detect_boundaries import METHOD_KNOB

    inputs = (
        QgsProcessingParameterMultipleLayers("POINT_CLOUDS", "Point clouds", QgsProcessing.SourceType.TypeFile),
        QgsProcessingParameterFeatureSource("TRAJECTORY", "Trajectory", [QgsProcessing.SourceType.TypeVector]),
        METHOD_KNOB.parameter(),
        QgsProcessingParameterCrs("CRS", "CRS of the point clouds, where they carry none", optional=True),
    )
    for row, definition in enumerate(inputs):
        component = QgsProcessingModelParameter(definition.name())
        component.setPosition(QPointF(150, 80 + STEP_Y * row))
        model.addModelParameter(definition, component)
    model.setParameterOrder([definition.name() for definition in inputs])


def source(text):
    from qgis.core import QgsProcessingModelChildParameterSource as Source

    if text.startswith("@"):
        return Source.fromModelParameter(text[1:])
    child, output = text.split(".")
    return Source.fromChildOutput(child, output)


def add_stages(model):
    from qgis.core import QgsApplication, QgsProcessingModelChildAlgorithm, QgsProcessingModelOutput
    from qgis.PyQt.QtCore import QPointF

    registry = QgsApplication.processingRegistry()
    for number, (stage, (inputs, results)) in enumerate(STAGES.items()):
        child = QgsProcessingModelChildAlgorithm(f"lanewright:{stage}")
        child.setChildId(stage)
        child.setDescription(registry.algorithmById(f"lanewright:{stage}").displayName())
        child.setPosition(QPointF(150 + STEP_X * (1 + number % 5), 80 + 2 * STEP_Y * (number // 5)))
        for name, text in inputs.items():
            child.addParameterSources(name, [source(text)])
        outputs = {}
        for result in results:
            name, title = result if isinstance(result, tuple) else (result, result)
            title = title.replace("_", " ").capitalize()
            output = QgsProcessingModelOutput(title)
            output.setChildId(stage)
            output.setChildOutputName(name)
            output.setDescription(title)
            output.setPosition(QPointF(child.position().x() + 60, child.position().y() + STEP_Y))
            outputs[title] = output
        child.setModelOutputs(outputs)
        model.addChildAlgorithm(child)


def main():
    from qgis.core import QgsApplication, QgsProcessingModelAlgorithm

    application = QgsApplication([], False)
    application.initQgis()
    load()
    from lanewright import classFactory

    plugin = classFactory(None)
    plugin.initProcessing()
    model = QgsProcessingModelAlgorithm(NAME, GROUP)
    add_inputs(model)
    add_stages(model)
    model.setHelpContent({
        "ALG_DESC": "The stages of the road map, one by one, with their results handed on through files: the same result as "
                    "Road map. Copy it and change a stage to your needs.",
        "ALG_VERSION": "1",
    })
    model.setOutputOrder(OUTPUT_ORDER)
    model.updateDestinationParameters()
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    if not model.toFile(str(TARGET)):
        sys.exit(f"{TARGET} could not be written.")
    print(TARGET, *(p.name() for p in model.parameterDefinitions()))
    plugin.unload()


if __name__ == "__main__":
    main()
