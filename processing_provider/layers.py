"""QGIS layers as the algorithms read them, and Features written into them."""

from itertools import islice

from qgis.core import (
    Qgis,
    QgsFeature,
    QgsFeatureRequest,
    QgsFeatureSink,
    QgsField,
    QgsFields,
    QgsGeometry,
    QgsProcessingFeatureSource,
    QgsVectorFileWriter,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QDate, QDateTime, QMetaType, Qt, QTime

from ..algorithms.vector_source import KIND_OF, LINE, POINT, POLYGON, TABLE, UNKNOWN, VectorSource, plain_value
from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.lazy import gdal, shapely
from .texts import tr

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
            raise RoadExtractionError(
                tr("The result could not be written: {reason}. Is the disk full or the file open elsewhere?").format(
                    reason=sink.lastError() or tr("the sink refused the features")))
    # Absent on QGIS 3.40, needed from 3.44 on
    if hasattr(sink, "finalize"):
        sink.finalize()
