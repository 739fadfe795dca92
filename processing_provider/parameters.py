"""The parameters of an algorithm's declaration as QGIS's own."""

import os

from qgis.core import (
    Qgis,
    QgsProcessing,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDatabaseSchema,
    QgsProcessingParameterEnum,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterMapLayer,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterProviderConnection,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
)

from ..algorithms.vector_source import KIND_OF, LINE, POINT, POLYGON
from .texts import tr

# fileFilter is enforced and case-sensitive, and `extension=` accepts one suffix only
CLOUD_FILTER = "Point clouds (*.las *.laz *.vpc *.LAS *.LAZ *.VPC);;All files (*.*)"
# Found by name when a dialog is made, which happens in a window only
DESKTOP = f"{__name__.split('.')[0]}.desktop"
WIDGETS = {"clouds": "cloud_widget.PointCloudsWrapper", "trajectory": "trajectory_widget.TrajectoryWrapper",
           "columns": "trajectory_widget.ColumnsWrapper", "choice": "dialog_wrapper.ChoiceWrapper"}  # choices in other languages than English
FILE_FILTERS = {"cloud": "LAZ (*.laz);;LAS (*.las)", "report": "HTML (*.html)"}  # of results
DECIMALS = 3  # millimetres; QGIS would show six

SourceType = QgsProcessing.SourceType
SOURCE_TYPES = {POINT: SourceType.TypeVectorPoint, LINE: SourceType.TypeVectorLine, POLYGON: SourceType.TypeVectorPolygon}
PAINTED = [SourceType.TypeVectorPolygon, SourceType.TypeVectorLine, SourceType.TypeRaster]


class PointCloudFiles(QgsProcessingParameterMultipleLayers):
    """Several point clouds, as files."""

    def createFileFilter(self):
        """What the dialogs of a batch list, where QGIS would list everything."""
        return CLOUD_FILTER

    def valueAsJsonObject(self, value, context):
        """The value for the table of runs. A file is its own name; QGIS would open it as a layer of every kind and report an error."""
        files = value if isinstance(value, list) else [value]
        return value if all(isinstance(file, str) and os.path.isfile(file) for file in files) else super().valueAsJsonObject(value, context)


def _number(spec, kind):
    limits = spec.limits()
    return QgsProcessingParameterNumber(
        spec.name, spec.label, kind, spec.default, **({} if limits is None else dict(minValue=limits[0], maxValue=limits[1])))


def _source_type(geometry):
    """What QGIS offers for a geometry of Features, or "any"."""
    return SOURCE_TYPES.get(KIND_OF.get(geometry), SourceType.TypeVector)


# Kind of a parameter -> QGIS's own
INPUTS = {
    "flag": lambda spec: QgsProcessingParameterBoolean(spec.name, spec.label, spec.default),
    "choice": lambda spec: QgsProcessingParameterEnum(spec.name, spec.label, list(spec.choices), defaultValue=spec.default, usesStaticStrings=True),
    "whole": lambda spec: _number(spec, QgsProcessingParameterNumber.Type.Integer),
    "number": lambda spec: _number(spec, QgsProcessingParameterNumber.Type.Double),
    **dict.fromkeys(("text", "columns"), lambda spec: QgsProcessingParameterString(spec.name, spec.label, spec.default)),
    "expression": lambda spec: QgsProcessingParameterExpression(spec.name, spec.label, spec.default, spec.of),
    "crs": lambda spec: QgsProcessingParameterCrs(spec.name, spec.label, spec.default),
    "clouds": lambda spec: PointCloudFiles(spec.name, spec.label, SourceType.TypeFile),
    "cloud": lambda spec: QgsProcessingParameterFile(spec.name, spec.label, fileFilter=CLOUD_FILTER),
    "file": lambda spec: QgsProcessingParameterFile(spec.name, spec.label, fileFilter=spec.file_filter),
    "folder": lambda spec: QgsProcessingParameterFile(spec.name, spec.label, Qgis.ProcessingFileParameterBehavior.Folder),
    **dict.fromkeys(("trajectory", "layer"), lambda spec: QgsProcessingParameterFeatureSource(spec.name, spec.label, [_source_type(spec.geometry)])),
    "raster": lambda spec: QgsProcessingParameterRasterLayer(spec.name, spec.label),
    "connection": lambda spec: QgsProcessingParameterProviderConnection(spec.name, spec.label, "postgres"),
    "schema": lambda spec: QgsProcessingParameterDatabaseSchema(spec.name, spec.label, spec.of),
    "painted": lambda spec: QgsProcessingParameterMapLayer(spec.name, spec.label, None, False, PAINTED),
}
OUTPUTS = {
    "layer": lambda spec: QgsProcessingParameterFeatureSink(spec.name, spec.label, _source_type(spec.geometry)),
    "raster": lambda spec: QgsProcessingParameterRasterDestination(spec.name, spec.label),
    **dict.fromkeys(("cloud", "report", "file"), lambda spec: QgsProcessingParameterFileDestination(
        spec.name, spec.label, FILE_FILTERS.get(spec.kind, spec.file_filter))),
    "folder": lambda spec: QgsProcessingParameterFolderDestination(spec.name, spec.label),
}


def qgis_parameter(spec):
    """The QGIS parameter of a spec, with its help, its widget and its part of the dialog."""
    parameter = (OUTPUTS if spec.is_output else INPUTS)[spec.kind](spec)
    parameter.setHelp(spec.help)
    for chosen, flag in ((spec.optional, Qgis.ProcessingParameterFlag.Optional), (spec.advanced, Qgis.ProcessingParameterFlag.Advanced)):
        if chosen:
            parameter.setFlags(parameter.flags() | flag)
    if spec.is_output:
        parameter.setCreateByDefault(spec.by_default)
    elif spec.kind == "number":
        parameter.setMetadata({"widget_wrapper": {"decimals": DECIMALS}})
    elif spec.kind in WIDGETS and (spec.kind != "choice" or any(tr(choice) != choice for choice in spec.choices)):
        parameter.setMetadata({"widget_wrapper": {"class": f"{DESKTOP}.{WIDGETS[spec.kind]}"}})
    return parameter


def retired_parameter(name):
    """A parameter of an earlier version that commands and models may still give."""
    parameter = QgsProcessingParameterString(name, name, optional=True)
    parameter.setFlags(parameter.flags() | Qgis.ProcessingParameterFlag.Hidden | Qgis.ProcessingParameterFlag.Advanced)
    return parameter
