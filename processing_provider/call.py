"""One run of an algorithm in QGIS: layers read and written, parameters, destinations and progress."""

import os
from itertools import islice
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsDataSourceUri,
    QgsExpression,
    QgsFeature,
    QgsFeatureRequest,
    QgsFeatureSink,
    QgsField,
    QgsFields,
    QgsGeometry,
    QgsMapLayer,
    QgsProcessingException,
    QgsProcessingFeatureSource,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingUtils,
    QgsProperty,
    QgsProviderRegistry,
    QgsRasterLayer,
    QgsVariantUtils,
    QgsVectorFileWriter,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QDate, QDateTime, QMetaType, Qt, QTime

from ..algorithms.call import Call, existing_file, time_left
from ..algorithms.destinations import at_path, destination_path
from ..algorithms.rooms import core
from ..algorithms.vector_source import KIND_OF, LINE, POINT, POLYGON, TABLE, UNKNOWN, VectorSource, crs_to_write, plain_value
from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.progress import Progress, RemainingTime
from ..core.io.local_files import check_local, gdal_exceptions
from ..core.lazy import gdal, shapely
from .results.road_maps import NAMES_ONLY, run_of
from .styling import embed_style, style_on_load
from .texts import told, tr

WKB_TYPES = {name: getattr(Qgis.WkbType, "NoGeometry" if name == "None" else name) for name in KIND_OF}
KINDS = {Qgis.GeometryType.Point: POINT, Qgis.GeometryType.Line: LINE, Qgis.GeometryType.Polygon: POLYGON,
         Qgis.GeometryType.Null: TABLE, Qgis.GeometryType.Unknown: UNKNOWN}
AT_ONCE = 5000  # features handed to a sink together
COLUMN_TYPES = {int: QMetaType.Type.LongLong, float: QMetaType.Type.Double, str: QMetaType.Type.QString}


def qgis_fields(schema, with_aliases=True):
    """The columns as QGIS fields, with aliases where they can be kept: see `keeps_aliases`."""
    fields = QgsFields()
    for column in schema:
        field = QgsField(column.name, COLUMN_TYPES[column.type])
        if with_aliases:
            field.setAlias(column.alias)
        fields.append(field)
    return fields


def keeps_aliases(path):
    """True where the format of a file keeps aliases of fields.

    Of every other (scratch layers with path None, CSV, Shapefile, a GeoPackage before GDAL 3.7) QGIS warns for
    each field, and of comments too wherever there is an alias.
    """
    driver = gdal.GetDriverByName(QgsVectorFileWriter.driverForExtension(path.suffix)) if path else None
    kept = (driver.GetMetadataItem("DMD_CREATION_FIELD_DEFN_FLAGS") or "").split() if driver else ()
    return "AlternativeName" in kept and "Comment" in kept


def qgis_features(features, fields):
    """Every row as a QgsFeature, geometries with Z."""
    names = [column.name for column in features.schema]
    for binary, row in _as_wkb(features):
        feature = QgsFeature(fields)
        if binary is not None:
            geometry = QgsGeometry()
            geometry.fromWkb(binary)
            feature.setGeometry(geometry)
        feature.setAttributes([plain_value(row.get(name)) for name in names])
        yield feature


def _as_wkb(features):
    """(WKB or None, row) of every feature; what is WKB already passes through."""
    if features.geometry_type.endswith("ZM"):
        return iter(features)
    if features.geometry_type == "None" or not len(features):
        return ((None, row) for row in features.rows)
    return zip(shapely.to_wkb(features.geometries, output_dimension=3, flavor="iso"), features.rows)


class QgisSource(VectorSource):
    """A QgsVectorLayer, or the source that Processing makes of one, as the algorithms read it."""

    def __init__(self, layer, label):
        self.layer, self.label = layer, label
        self.names = [field.name() for field in layer.fields()]
        kind = layer.wkbType()
        self.kind = KINDS[QgsWkbTypes.geometryType(kind)]
        self.has_z, self.has_m = QgsWkbTypes.hasZ(kind), QgsWkbTypes.hasM(kind)
        self.stored_crs = crs_text(layer.sourceCrs() if hasattr(layer, "sourceCrs") else layer.crs())

    def stored_rows(self, measures=False, check_validity=True):
        features = self.layer.getFeatures() if check_validity or not isinstance(self.layer, QgsProcessingFeatureSource) else \
            self.layer.getFeatures(QgsFeatureRequest(), Qgis.ProcessingFeatureSourceFlag.SkipGeometryValidityChecks)
        for feature in features:
            self.feature_id, geometry = feature.id(), feature.geometry()
            wkb = None if geometry.isNull() or geometry.isEmpty() else _wkb(geometry, measures)
            yield wkb, [_value(value) for value in feature.attributes()]

    def kind_label(self, kind):
        return QgsWkbTypes.geometryDisplayString(next(geometry_type for geometry_type, name in KINDS.items() if name == kind))


def _wkb(geometry, measures):
    """WKB without curves, which the core does not know."""
    kind = geometry.wkbType()
    if QgsWkbTypes.isCurvedType(kind):
        geometry = QgsGeometry(geometry.constGet().segmentize())
    if not measures and QgsWkbTypes.hasM(kind):
        geometry.get().dropMValue()
    return bytes(geometry.asWkb())


def _value(value):
    if value is None or (hasattr(value, "isNull") and value.isNull()):
        return None
    return value.toString(Qt.DateFormat.ISODateWithMs) if isinstance(value, (QDate, QTime, QDateTime)) else value


def crs_text(crs):
    """WKT of a QgsCoordinateReferenceSystem, "" where it is unknown.

    GeoPackage has entries of its own for that: "Undefined geographic SRS" is what GDAL writes for a layer without CRS, whatever its coordinates are.
    """
    defined = crs.isValid() and not crs.description().lower().startswith("undefined ")
    return crs.toWkt(Qgis.CrsWktVariant.Preferred) if defined else ""


def write_features(sink, features, fields, feedback=None):
    """All rows, some thousands at a time; raises RoadExtractionError when the sink refuses, Cancelled when the user wishes."""
    rows = qgis_features(features, fields)
    while batch := list(islice(rows, AT_ONCE)):
        if feedback is not None and feedback.isCanceled():
            raise Cancelled
        if not sink.addFeatures(batch, QgsFeatureSink.Flag.FastInsert):
            raise RoadExtractionError(tr("The result could not be written: {reason}. Is the disk full or the file open elsewhere?",
                                         reason=sink.lastError() or tr("the sink refused the features")))
    # Absent on QGIS 3.40, needed from 3.44 on
    if hasattr(sink, "finalize"):
        sink.finalize()


READERS = {"number": "parameterAsDouble", "whole": "parameterAsInt", "flag": "parameterAsBool", "choice": "parameterAsEnumString"}


class QgisCall(Call):
    """`Call` for QGIS Processing: `processing` is the QgsProcessingAlgorithm, `algorithm` its declaration."""

    VECTOR_SUFFIXES = tuple(QgsVectorFileWriter.supportedFormatExtensions())

    def __init__(self, processing, parameters, context, feedback):
        super().__init__(processing.declaration, parameters)
        self.processing, self.context, self.feedback = processing, context, feedback
        # (path, table or "", label) of every file that the inputs name and that is there
        self._inputs = [(path, table, definition.description()) for definition in _inputs(processing, READ)
                        for path, table in map(_file_of, _sources(parameters.get(definition.name()), context)) if path is not None]

    @property
    def names_only(self):
        return NAMES_ONLY.holds() or super().names_only

    # -- in ---------------------------------------------------------------------------------

    def files(self, name):
        names = self.parameters.get(name)
        if not isinstance(names, (list, tuple)) and not hasattr(names, "source"):
            names = self.processing.parameterAsFileList(self.parameters, name, self.context)
        # each a path, or a layer, its name or its id in the project
        return [next(iter(_sources(name, self.context)), str(name)) for name in (names if isinstance(names, (list, tuple)) else [names])]

    def file(self, name):
        return self.processing.parameterAsFile(self.parameters, name, self.context)

    def value(self, name):
        read = READERS.get(self.algorithm.parameter(name).kind, "parameterAsString")
        return getattr(self.processing, read)(self.parameters, name, self.context)

    def crs(self, name="CRS"):
        """WKT, or "" where none was chosen; refuses a CRS that QGIS does not know, which it would pass over."""
        crs = self.processing.parameterAsCrs(self.parameters, name, self.context)
        text = self.parameters.get(name)
        if isinstance(text, str) and text and not crs.isValid():
            raise RoadExtractionError(tr("{label}: the CRS {given} is not known. Give it as EPSG:number.", label=self.label(name), given=text))
        return core.io.crs.in_metres(crs_text(crs))[0]

    def connection(self, name):
        kept, chosen = QgsProviderRegistry.instance().providerMetadata("postgres").dbConnections(False), self.value(name)
        if chosen not in kept:
            raise RoadExtractionError(tr("{label}: QGIS keeps no connection {name} to PostgreSQL. It keeps: {known}.", label=self.label(name),
                                         name=chosen, known=", ".join(sorted(kept)) or "-"))
        return QgsDataSourceUri(kept[chosen].uri()).connectionInfo(True)

    def raster(self, name):
        path = self.parameters.get(name)
        if isinstance(path, str) and Path(path).is_file():
            return path  # loaded as a layer, QGIS would write statistics beside it
        layer = self.processing.parameterAsRasterLayer(self.parameters, name, self.context)
        if layer is None:
            raise QgsProcessingException(self.processing.invalidRasterError(self.parameters, name))
        return existing_file(layer.source(), self.label(name))

    def source(self, name):
        if self.parameters.get(name) in (None, ""):
            return None
        source = self.processing.parameterAsSource(self.parameters, name, self.context)
        if source is None:
            raise QgsProcessingException(self.processing.invalidSourceError(self.parameters, name))
        return QgisSource(source, self.label(name))

    def painted(self, name):
        layer = self.processing.parameterAsLayer(self.parameters, name, self.context)
        if layer is None:
            raise QgsProcessingException(tr("{label}: {value} cannot be opened as a layer. Check the name and the folder.", label=self.label(name),
                                            value=self.parameters.get(name)))
        if isinstance(layer, QgsRasterLayer):
            return None, existing_file(layer.source(), self.label(name)), crs_text(layer.crs())
        return QgisSource(layer, self.label(name)), "", ""

    def rows_where(self, name, source):
        text = self.value(name)  # parameterAsExpression hides a faulty one
        if not text:
            return None
        expression, holds = QgsExpression(text), []
        scope = self.processing.createExpressionContext(self.parameters, self.context, source.layer)
        usable = not expression.hasParserError() and expression.prepare(scope)
        for feature in source.layer.getFeatures() if usable else ():
            scope.setFeature(feature)
            # of a row without geometry nothing is asked
            empty = feature.geometry().isNull() or feature.geometry().isEmpty()
            holds.append(not empty and bool(expression.evaluate(scope)))
        if not usable or expression.hasEvalError():
            raise RoadExtractionError(tr("{label} cannot be used: {problem}", label=self.label(name),
                                         problem=expression.parserErrorString() or expression.evalErrorString()))
        return holds

    def layer_name(self, name):
        layer = self.processing.parameterAsLayer(self.parameters, name, self.context)
        value = layer.name() if layer is not None else str(self.parameters.get(name))
        return value or self.label(name)

    # -- out --------------------------------------------------------------------------------

    def print_sheets(self, settings, progress):
        from ..desktop.layout.sheets import print_sheets

        return print_sheets(self, settings, progress)

    def destination(self, name):
        value = self.parameters.get(name)
        if isinstance(value, QgsProcessingOutputLayerDefinition):
            value = value.sink.valueAsString(self.context.expressionContext())[0]
        elif value is not None and not isinstance(value, str):
            value = str(value)
        return value

    def output_path(self, name):
        if self.algorithm.parameter(name).kind == "raster":
            return self.processing.parameterAsOutputLayer(self.parameters, name, self.context)
        return self.processing.parameterAsFileOutput(self.parameters, name, self.context)

    def read_as(self, value, path):
        table = QgsDataSourceUri(value.removeprefix("ogr:")).table() if value.startswith("ogr:") else ""
        return next((label for source, read, label in self._inputs if path.exists() and os.path.samefile(path, source)
                     and (not table or table == (read or _first_table(source)))), "")

    def finish(self, numbers):
        """Write the layers, name the files, and return the dictionary QGIS wants."""
        for name, features in self._layers:
            self._results[name] = self._write(name, features)
        for name, _ in self._layers:
            close_database(self.destination(name), self.context)
        provenance = self.sign_files()
        added_to = {destination_path(self.destination(name)).absolute() for name, _ in self._layers
                    if self.destination(name).startswith("ogr:")}
        self._unfinished.commit(added_to, add_tables)
        schemas = {name: features.schema for name, features in self._layers}
        run = run_of(provenance, self.surveyed(), self.algorithm.WHOLE_MAP, self.context, self.processing.group_of_inputs)
        for name, dest in self._results.items():
            look = self.algorithm.parameter(name).look or name
            embed_style(look, dest, self.label(name), schemas.get(name, ()), provenance)
            style_on_load(look, dest, self.label(name), self.context, schemas.get(name, ()), run)
        return {**self._results, **numbers}

    def values(self):
        value_of = {definition: self.parameters.get(definition.name(), definition.defaultValue())
                    for definition in self.processing.parameterDefinitions() if not definition.isDestination()}
        # a batch gives a NULL of QGIS for what was left empty
        return {definition.name(): None if QgsVariantUtils.isNull(value) else definition.valueAsJsonObject(value, self.context)
                for definition, value in value_of.items()}

    def _write(self, name, features):
        """Write a layer, a file beside its destination at first; where it will be."""
        value = self.destination(name)
        path = destination_path(value)
        fields = qgis_fields(features.schema, with_aliases=keeps_aliases(path))
        wkt = crs_to_write(features, QgsVectorFileWriter.driverForExtension(path.suffix) if path else "")
        crs = QgsCoordinateReferenceSystem.fromWkt(wkt) if wkt else QgsCoordinateReferenceSystem()
        parameters, unfinished, file = self.parameters, "", ""
        if path is not None:
            unfinished = str(self._unfinished.begin(path))
            interim, file = at_path(value, unfinished)
            output = self.parameters.get(name)
            redirected = interim
            if isinstance(output, QgsProcessingOutputLayerDefinition):
                redirected = QgsProcessingOutputLayerDefinition(output)
                redirected.sink = QgsProperty.fromValue(interim)
            parameters = {**parameters, name: redirected}
        sink, dest = self.processing.parameterAsSink(parameters, name, self.context, fields, WKB_TYPES[features.geometry_type], crs)
        if sink is None:
            raise QgsProcessingException(self.processing.invalidSinkError(self.parameters, name))
        write_features(sink, features, fields, self.feedback)
        # The file is complete only once the sink is gone
        del sink
        if path is None:
            return dest
        final = dest.replace(unfinished, file)
        self.context.setLayersToLoadOnCompletion(
            {final if key == dest else key: details for key, details in self.context.layersToLoadOnCompletion().items()})
        return final


# QGIS's progress bar and log as the listener that the core speaks to.

class FeedbackProgress(Progress):
    """Moves the bar, prints, tells how long it will still take, and raises Cancelled once the user pressed Cancel."""

    def __init__(self, feedback, remaining=None):
        self.feedback = feedback
        self._remaining = remaining or RemainingTime()

    def check_cancelled(self):
        if self.feedback.isCanceled():
            raise Cancelled

    def report(self, fraction):
        self.check_cancelled()
        self.feedback.setProgress(100.0 * fraction)
        left = self._remaining.after(fraction)
        if left is not None:
            self.feedback.setProgressText(time_left(left))

    def info(self, text):
        self.feedback.pushInfo(told(text))

    def warn(self, text):
        self.feedback.pushWarning(told(text))


# Which files a run reads, so that none of them is written over; and tables put into a database that programs have open.

OPENED_BY_QGIS = ("source", "vector", "raster", "layer")
READ = ("source", "vector", "raster", "layer", "multilayer", "file", "pointcloud")


def _inputs(algorithm, kinds):
    return [definition for definition in algorithm.parameterDefinitions() if definition.type() in kinds and not definition.isDestination()]


def check_files(algorithm, parameters, context):
    """Raise RoadExtractionError where an input names a file that describes data elsewhere, which QGIS would fetch."""
    for definition in _inputs(algorithm, OPENED_BY_QGIS):
        value = _static(parameters.get(definition.name()), context)
        file = value.partition("|")[0] if isinstance(value, str) else ""
        if file and os.path.isfile(file):
            check_local(file)


def _static(value, context):
    """A value without what QGIS may put about it: whether the selected features alone are meant, for example."""
    return value.source.valueAsString(context.expressionContext())[0] if isinstance(value, QgsProcessingFeatureSourceDefinition) else value


def asks_servers(algorithm, parameters, context):
    """Whether an input is a layer that the user has from a server, which is then asked; for files, nothing is fetched."""
    sources = [source for definition in _inputs(algorithm, READ) for source in _sources(parameters.get(definition.name()), context)]
    return any("://" in source or "/vsi" in source.lower() for source in sources if not os.path.exists(source))


def close_database(destination, context):
    """Let go of the layers that were read, for this run alone, from the database that a table is about to be added to.

    QGIS would look for the new table in the connection it has open, and not find it there.
    """
    path = destination_path(destination)
    if path is None or not destination.startswith("ogr:") or not path.exists():
        return
    store = context.temporaryLayerStore()
    for layer in list(store.mapLayers().values()):
        read, _ = _file_of(layer.source())
        if read is not None and os.path.samefile(read, path):
            store.removeMapLayer(layer.id())


def _sources(value, context):
    """The sources of the layers and files that a parameter's value names."""
    if isinstance(value, (list, tuple)):
        return [source for item in value for source in _sources(item, context)]
    value = _static(value, context)
    if isinstance(value, QgsMapLayer):
        return [value.source()]
    if not isinstance(value, str) or not value:
        return []
    layer = None if os.path.exists(value) else QgsProcessingUtils.mapLayerFromString(value, context, False)
    return [value if layer is None else layer.source()]


def _file_of(source):
    """(Path, table) of a source that is a file, or (None, "")."""
    parts = QgsProviderRegistry.instance().decodeUri("ogr", source)
    path = Path(parts.get("path") or source)
    try:
        return (path, parts.get("layerName") or "") if path.is_file() else (None, "")
    except OSError:  # a name too long to be one
        return None, ""


def _first_table(path):
    """The table that is read where a database is named alone."""
    tables = QgsProviderRegistry.instance().querySublayers(str(path))
    return tables[0].name() if tables else ""


# Tables of one GeoPackage put into another that stays where it is, since programs have it open.

def add_tables(written, path):
    """Put all tables of a database into another, in one transaction: whatever ends the program leaves those of before or these.

    Tables of the same names are replaced. Programs that have the database open, this QGIS too, read the new tables from then on.

    written, path : Path
    Raises RoadExtractionError if another program keeps the database locked, or there is no room; then the tables of before stand.
    """
    try:
        with gdal_exceptions():
            target = gdal.OpenEx(str(path), gdal.OF_VECTOR | gdal.OF_UPDATE)
            # one transaction from the first table to the last, and none in between
            gdal.VectorTranslate(target, str(written), accessMode="overwrite", options=["-preserve_fid", "-gt", "unlimited"])
            target = None
    except RuntimeError as problem:
        raise RoadExtractionError(tr("The result could not be written: {reason}. Is the disk full or the file open elsewhere?",
                                     reason=problem)) from problem
