"""An algorithm's declaration as QGIS's Processing takes it: dialog, checks, run and failure."""

import os
from contextlib import nullcontext
from datetime import datetime
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsMapLayer,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingOutputNumber,
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
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QIcon

from ..algorithms.algorithm import choice_refused, number_refused
from ..algorithms.call import run
from ..algorithms.catalogue import toolbox_number
from ..algorithms.survey_input import trajectory_path
from ..algorithms.vector_source import KIND_OF, LINE, POINT, POLYGON
from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.parallel import lack_of_memory
from ..core.io.local_files import offline
from .call import FeedbackProgress, QgisCall, asks_servers, check_files
from .dependencies import missing_packages
from .results.road_maps import note_run, road_map_of
from .texts import told, tr

ICONS = Path(__file__).resolve().parents[1] / "resources" / "icons"


class LanewrightAlgorithm(QgsProcessingAlgorithm):
    """One of the algorithms of `algorithms.catalogue` in the toolbox."""

    def __init__(self, declaration):
        super().__init__()
        self.declaration = declaration
        self.group_of_inputs = None  # of the layer tree

    # -- what QGIS asks ---------------------------------------------------------------------

    def createInstance(self):
        return type(self)(type(self.declaration)())

    def initAlgorithm(self, configuration=None):
        for spec in self.declaration.parameters:
            self.addParameter(qgis_parameter(spec))
        for name in self.declaration.RETIRED:
            self.addParameter(retired_parameter(name))
        for number in self.declaration.numbers:
            self.addOutput(QgsProcessingOutputNumber(number.name, number.label))

    def flags(self):
        return super().flags() | Qgis.ProcessingAlgorithmFlag.NoThreading if self.declaration.DRAWS else super().flags()

    def name(self):
        return self.declaration.ID

    def displayName(self):
        """The title with a number by which the toolbox sorts it; the dialog shows it without."""
        return f"{toolbox_number(self.declaration.ID)} {self.declaration.title()}"

    def icon(self):
        path = ICONS / f"{self.declaration.ID}.svg"
        return QIcon(str(path)) if path.exists() else super().icon()

    def createCustomParametersWidget(self, parent=None):
        from ..desktop.dialogs.algorithm_dialog import LanewrightDialog

        return LanewrightDialog(self, self.declaration.title(), parent)

    def group(self):
        return self.declaration.group()

    def groupId(self):
        return self.declaration.GROUP.lower().replace(" ", "")

    def shortDescription(self):
        return self.declaration.summary()

    def helpUrl(self):
        """The page of the manual that the plugin itself shows; in a window only, where it can be shown."""
        return f"lanewright:{self.declaration.ID}"

    def tags(self):
        return self.declaration.tags()

    def shortHelpString(self):
        """The summary and every parameter's own help: written once, on the parameter."""
        lines = [f"<p>{part}</p>" for part in (self.declaration.summary(), *self.declaration.help_paragraphs())]
        lines += [f"<p><b>{spec.label}</b><br>{spec.help}</p>" for spec in self.declaration.parameters if spec.help]
        return "\n".join(lines)

    def canExecute(self):
        lacking = what_is_lacking()
        return (not lacking, lacking)

    def checkParameterValues(self, parameters, context):
        lacking = what_is_lacking()
        if lacking:
            return False, lacking
        try:
            check_files(self, parameters, context)
        except RoadExtractionError as error:
            return False, told(str(error))
        with self._network(parameters, context):
            fine, message = super().checkParameterValues(accept_trajectory_file(self.declaration, parameters, context), context)
        return fine, message if fine else \
            out_of_range(self.parameterDefinitions(), parameters) or no_trajectory(self.declaration, parameters) or message

    def prepareAlgorithm(self, parameters, context, feedback):
        """On the main thread, where the layer tree may be looked at."""
        self.group_of_inputs = group_of_layers(parameters.values(), context.project()) if context.project() is not None else None
        return super().prepareAlgorithm(parameters, context, feedback)

    def processAlgorithm(self, parameters, context, feedback):
        # canExecute is asked by the desktop only
        lacking = what_is_lacking()
        if lacking:
            raise QgsProcessingException(lacking)
        try:
            check_files(self, parameters, context)
        except RoadExtractionError as error:
            raise QgsProcessingException(told(str(error))) from error
        with self._network(parameters, context):
            results, failure = self._attempt(parameters, context, feedback)
        if not failure:
            return results
        # QGIS never lets go of an exception: raised where the work was, it would keep all of the survey in memory
        raise QgsProcessingException(failure)

    def _network(self, parameters, context):
        """A context in which GDAL, and QGIS by it, asks no server for what a file says."""
        with offline():
            return nullcontext() if asks_servers(self, parameters, context) else offline()

    def _attempt(self, parameters, context, feedback):
        """(results, "") of a run, or (None, why there are none); either is noted in the table of runs."""
        began, call = datetime.now(), QgisCall(self, parameters, context, feedback)
        to_load, whole = context.layersToLoadOnCompletion(), False
        try:
            results = run(call, FeedbackProgress(feedback))
            note_run(self.declaration, call.survey, began, results, warnings=[told(text) for text in call.warnings])
            whole = True
            return results, ""
        except RoadExtractionError as error:
            failure = told(str(error))
        except Cancelled:
            failure = tr("Cancelled")
        finally:
            if not whole:  # below the reason QGIS would list the layers that it could not load
                context.setLayersToLoadOnCompletion(to_load)
        note_run(self.declaration, call.survey, began, failure=failure)
        return None, failure


def what_is_lacking():
    """One sentence on the memory or the packages without which no algorithm can begin; "" where all is there."""
    return told(lack_of_memory()) or missing_packages()  # without memory, packages seem to be missing


def group_of_layers(values, project):
    """The group in which the first of these layers stands that is of one of our runs, "" where it stands in none; None without such a layer."""
    for value in values:
        if isinstance(value, QgsProcessingFeatureSourceDefinition):
            value = value.source.staticValue()
        layer = project.mapLayer(value) if isinstance(value, str) else value if isinstance(value, QgsMapLayer) else None
        run = None if layer is None else road_map_of(layer, project)
        if run is not None:
            return "" if run.group is None else run.group.name()
    return None


def out_of_range(definitions, parameters):
    """What may be given, for the first number or choice that may not be; QGIS itself says only that it is incorrect."""
    for parameter in definitions:
        value = parameters.get(parameter.name())
        if value is None or parameter.checkValueIsAcceptable(value):
            continue
        if parameter.type() == "number":
            return number_refused(parameter.description(), parameter.name(), value, parameter.minimum(), parameter.maximum())
        if parameter.type() == "enum":
            return choice_refused(parameter.description(), parameter.name(), value, parameter.options())
    return ""


def no_trajectory(declaration, parameters):
    """What may be given where a file is there and no trajectory; QGIS itself says that it is not found."""
    for spec in declaration.inputs():
        value = parameters.get(spec.name)
        if spec.kind == "trajectory" and isinstance(value, str) and os.path.isfile(value) and trajectory_path(value) is None \
                and not QgsVectorLayer(value).isValid():
            return tr("{label}: {file} holds neither a layer nor a table of positions. Choose the layer or the CSV, TXT or SBET file of the drive.",
                      label=spec.label, file=value)
    return ""


def accept_trajectory_file(declaration, parameters, context):
    """Parameters for QGIS's own check, which knows no SBET and no table without a header.

    Such a file passes as an empty stand-in layer; whether it is there and can be read is said by the reader, in its own words.
    """
    accepted = dict(parameters)
    for spec in declaration.inputs():
        if spec.kind == "trajectory" and trajectory_path(parameters.get(spec.name)) is not None:
            stand_in = QgsVectorLayer("Point", "trajectory", "memory")
            context.temporaryLayerStore().addMapLayer(stand_in)
            accepted[spec.name] = stand_in.id()
    return accepted


# The parameters of an algorithm's declaration as QGIS's own.

# fileFilter is enforced and case-sensitive, and `extension=` accepts one suffix only
CLOUD_FILTER = "Point clouds (*.las *.laz *.vpc *.LAS *.LAZ *.VPC);;All files (*.*)"
# Found by name when a dialog is made, which happens in a window only
WIDGETS_IN = f"{__name__.split('.')[0]}.desktop.survey_widgets"
WIDGETS = {"clouds": "PointCloudsWrapper", "trajectory": "TrajectoryWrapper", "columns": "ColumnsWrapper",
           "choice": "ChoiceWrapper"}  # choices in other languages than English
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
        parameter.setMetadata({"widget_wrapper": {"class": f"{WIDGETS_IN}.{WIDGETS[spec.kind]}"}})
    return parameter


def retired_parameter(name):
    """A parameter of an earlier version that commands and models may still give."""
    parameter = QgsProcessingParameterString(name, name, optional=True)
    parameter.setFlags(parameter.flags() | Qgis.ProcessingParameterFlag.Hidden | Qgis.ProcessingParameterFlag.Advanced)
    return parameter
