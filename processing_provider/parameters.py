"""The parameters of an algorithm's declaration as QGIS's own."""

import os
from functools import singledispatch

from qgis.core import (
    Qgis,
    QgsProcessing,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterEnum,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMapLayer,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
)

from ..algorithms import parameters as specs
from ..algorithms.choice_words import choice_word
from ..algorithms.vector_source import KIND_OF, LINE, POINT, POLYGON

# fileFilter is enforced and case-sensitive, and `extension=` accepts one suffix only
CLOUD_FILTER = "Point clouds (*.las *.laz *.LAS *.LAZ);;All files (*.*)"
# Found by name when a dialog is made, which happens in a window only
WIDGETS = f"{__name__.split('.')[0]}.desktop"
CLOUDS_WIDGET = {"widget_wrapper": {"class": f"{WIDGETS}.cloud_widget.PointCloudsWrapper"}}
TRAJECTORY_WIDGET = {"widget_wrapper": {"class": f"{WIDGETS}.trajectory_widget.TrajectoryWrapper"}}
CHOICE_WIDGET = {"widget_wrapper": {"class": f"{WIDGETS}.choice_widget.ChoiceWrapper"}}  # in other languages than English
COLUMNS_WIDGET = {"widget_wrapper": {"class": f"{WIDGETS}.columns_widget.ColumnsWrapper"}}
LAZ_FILTER = "LAZ (*.laz);;LAS (*.las)"
HTML_FILTER = "HTML (*.html)"
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


def qgis_parameter(spec):
    """The QGIS parameter of a spec, with its help and in its part of the dialog."""
    parameter = _parameter(spec)
    parameter.setHelp(spec.help)
    if spec.advanced:
        parameter.setFlags(parameter.flags() | Qgis.ProcessingParameterFlag.Advanced)
    return parameter


def _source_type(geometry):
    """What QGIS offers for a geometry of Features, or "any"."""
    return SOURCE_TYPES.get(KIND_OF.get(geometry), SourceType.TypeVector)


@singledispatch
def _parameter(spec):
    raise TypeError(f"QGIS has no parameter for {type(spec).__name__}")


@_parameter.register
def _(spec: specs.SettingSpec):
    kind, default = spec.kind(), spec.default
    if kind == "choice":
        return _choice(spec, default)
    if kind == "flag":
        return QgsProcessingParameterBoolean(spec.name, spec.label, default)
    if kind == "text":
        return QgsProcessingParameterString(spec.name, spec.label, default, optional=True)
    number = QgsProcessingParameterNumber.Type.Integer if kind == "whole" else QgsProcessingParameterNumber.Type.Double
    limits = spec.limits()
    parameter = QgsProcessingParameterNumber(
        spec.name, spec.label, number, default, **({} if limits is None else dict(minValue=limits[0], maxValue=limits[1])))
    if kind == "number":
        parameter.setMetadata({"widget_wrapper": {"decimals": DECIMALS}})
    return parameter


def _choice(spec, default):
    parameter = QgsProcessingParameterEnum(spec.name, spec.label, list(spec.choices), defaultValue=default, usesStaticStrings=True)
    if any(choice_word(choice) != choice for choice in spec.choices):
        parameter.setMetadata(CHOICE_WIDGET)
    return parameter


@_parameter.register
def _(spec: specs.FlagSpec):
    return QgsProcessingParameterBoolean(spec.name, spec.label, spec.value)


@_parameter.register
def _(spec: specs.ChoiceSpec):
    return _choice(spec, spec.value)


@_parameter.register
def _(spec: specs.TextSpec):
    return QgsProcessingParameterString(spec.name, spec.label, spec.value, optional=spec.optional)


@_parameter.register
def _(spec: specs.ColumnsSpec):
    parameter = QgsProcessingParameterString(spec.name, spec.label, spec.value, optional=spec.optional)
    parameter.setMetadata(COLUMNS_WIDGET)
    return parameter


@_parameter.register
def _(spec: specs.ExpressionSpec):
    return QgsProcessingParameterExpression(spec.name, spec.label, spec.value, spec.layer, optional=spec.optional)


@_parameter.register
def _(spec: specs.CrsSpec):
    return QgsProcessingParameterCrs(spec.name, spec.label, spec.value, optional=spec.optional)


@_parameter.register
def _(spec: specs.PointCloudsSpec):
    parameter = PointCloudFiles(spec.name, spec.label, SourceType.TypeFile, optional=spec.optional)
    parameter.setMetadata(CLOUDS_WIDGET)
    return parameter


@_parameter.register
def _(spec: specs.CloudSpec):
    return QgsProcessingParameterFile(spec.name, spec.label, fileFilter=CLOUD_FILTER, optional=spec.optional)


@_parameter.register
def _(spec: specs.FileSpec):
    return QgsProcessingParameterFile(spec.name, spec.label, fileFilter=spec.file_filter, optional=spec.optional)


@_parameter.register
def _(spec: specs.FolderSpec):
    return QgsProcessingParameterFile(spec.name, spec.label, Qgis.ProcessingFileParameterBehavior.Folder, optional=spec.optional)


@_parameter.register
def _(spec: specs.TrajectorySpec):
    parameter = QgsProcessingParameterFeatureSource(spec.name, spec.label, [_source_type(spec.geometry)], optional=spec.optional)
    parameter.setMetadata(TRAJECTORY_WIDGET)
    return parameter


@_parameter.register
def _(spec: specs.LayerSpec):
    return QgsProcessingParameterFeatureSource(spec.name, spec.label, [_source_type(spec.geometry)], optional=spec.optional)


@_parameter.register
def _(spec: specs.RasterSpec):
    return QgsProcessingParameterRasterLayer(spec.name, spec.label, optional=spec.optional)


@_parameter.register
def _(spec: specs.PaintedSpec):
    return QgsProcessingParameterMapLayer(spec.name, spec.label, None, spec.optional, PAINTED)


@_parameter.register
def _(spec: specs.LayerOutput):
    return QgsProcessingParameterFeatureSink(spec.name, spec.label, _source_type(spec.geometry), None, spec.optional, spec.by_default)


@_parameter.register
def _(spec: specs.CloudOutput):
    return QgsProcessingParameterFileDestination(spec.name, spec.label, LAZ_FILTER, None, spec.optional, spec.by_default)


@_parameter.register
def _(spec: specs.ReportOutput):
    return QgsProcessingParameterFileDestination(spec.name, spec.label, HTML_FILTER, None, spec.optional, spec.by_default)


@_parameter.register
def _(spec: specs.FileOutput):
    return QgsProcessingParameterFileDestination(spec.name, spec.label, spec.file_filter, None, spec.optional, spec.by_default)


@_parameter.register
def _(spec: specs.RasterOutput):
    return QgsProcessingParameterRasterDestination(spec.name, spec.label, None, spec.optional, spec.by_default)
