"""Between QGIS layers and the core's Features."""

from itertools import islice

from osgeo import gdal
from qgis.core import (
    Qgis,
    QgsFeature,
    QgsFeatureRequest,
    QgsFeatureSink,
    QgsField,
    QgsFields,
    QgsGeometry,
    QgsVectorFileWriter,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QMetaType

from ..core.common.errors import Cancelled, RoadExtractionError
from ..core.common.features import Features, Field
from .texts import tr

WKB_TYPES = {
    "PointZ": Qgis.WkbType.PointZ,
    "LineStringZ": Qgis.WkbType.LineStringZ,
    "LineStringZM": Qgis.WkbType.LineStringZM,
    "PolygonZ": Qgis.WkbType.PolygonZ,
    "MultiLineStringZ": Qgis.WkbType.MultiLineStringZ,
    "MultiPolygonZ": Qgis.WkbType.MultiPolygonZ,
    "None": Qgis.WkbType.NoGeometry,
}
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
        feature.setAttributes([_plain(row.get(name)) for name in names])
        yield feature


def _as_wkb(features):
    """(WKB or None, row) of every feature; what is WKB already passes through."""
    import shapely

    if features.geometry_type.endswith("ZM"):
        return iter(features)
    if features.geometry_type == "None" or not len(features):
        return ((None, row) for row in features.rows)
    return zip(shapely.to_wkb(features.geometries, output_dimension=3, flavor="iso"), features.rows)


def _plain(value):
    """A Python value QGIS can store: numpy scalars unpacked, NaN as NULL."""
    if hasattr(value, "item"):
        value = value.item()
    return None if value != value else value


def read_features(source, schema, geometry_type, label):
    """A feature source as Features; fields are matched by name, the layer's further fields are left out.

    Multi-part geometries become one row a part. Raises RoadExtractionError where a
    field is missing, the geometry is of another kind, or carries no heights.
    """
    import shapely

    _check_kind(source, schema, geometry_type, label)
    result = Features(geometry_type, list(schema), crs=crs_text(source.sourceCrs()))
    index = {column.name: source.fields().lookupField(column.name) for column in schema}
    for feature in _features(source, geometry_type):
        row = {column.name: _typed(feature.attribute(index[column.name]), column) for column in schema}
        if geometry_type == "None":
            result.add(None, **row)
            continue
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            continue
        if geometry_type.endswith("ZM"):
            for part in _measured_parts(geometry, label):
                result.add(part, **row)
            continue
        for part in shapely.get_parts(shapely.from_wkb(bytes(geometry.asWkb()))):
            if not part.has_z:
                raise RoadExtractionError(
                    tr("{label} has geometries without heights (Z). Use the layer that Lanewright wrote.").format(
                        label=label
                    )
                )
            result.add(part, **row)
    return result


def _features(source, geometry_type):
    """The rows of a source. Scanlines run straight up a wall, which seen from above is no valid line."""
    if geometry_type.endswith("ZM"):
        return source.getFeatures(QgsFeatureRequest(), Qgis.ProcessingFeatureSourceFlag.SkipGeometryValidityChecks)
    return source.getFeatures()


def _measured_parts(geometry, label):
    """WKB of every part of a geometry with Z and M: shapely before 2.1 would lose the M."""
    for part in geometry.constParts():
        if not (part.is3D() and part.isMeasure()):
            raise RoadExtractionError(
                tr("{label} has geometries without heights (Z) or measures (M). Use the layer that Lanewright wrote.").format(label=label)
            )
        yield bytes(part.asWkb())


def _check_kind(source, schema, geometry_type, label):
    """Refuse a layer that another stage made, or none."""
    fields = source.fields()
    missing = [column.name for column in schema if fields.lookupField(column.name) < 0]
    if missing:
        raise RoadExtractionError(
            tr("{label} lacks the field(s) {fields}. Use the layer that Lanewright wrote.").format(
                label=label, fields=", ".join(missing)
            )
        )
    found, needed = QgsWkbTypes.geometryType(source.wkbType()), QgsWkbTypes.geometryType(WKB_TYPES[geometry_type])
    if geometry_type != "None" and found != needed:
        raise RoadExtractionError(
            tr("{label} holds geometries of the kind {found}; {needed} is needed. Use the layer that Lanewright wrote.").format(
                label=label, found=QgsWkbTypes.geometryDisplayString(found), needed=QgsWkbTypes.geometryDisplayString(needed)
            )
        )


def _typed(value, column: Field):
    if value is None or (hasattr(value, "isNull") and value.isNull()):
        return None
    return column.type(value)


def crs_text(crs):
    """WKT of a QgsCoordinateReferenceSystem, "" where it is unknown.

    GeoPackage has entries of its own for that: "Undefined geographic SRS" is what
    GDAL writes for a layer without CRS, whatever its coordinates are.
    """
    known = crs.isValid() and not crs.description().lower().startswith("undefined ")
    return crs.toWkt(Qgis.CrsWktVariant.Preferred) if known else ""


def write_features(sink, features, fields, feedback=None):
    """All rows, some thousands at a time; raises RoadExtractionError when the sink refuses, Cancelled when the user wishes."""
    rows = qgis_features(features, fields)
    while some := list(islice(rows, AT_ONCE)):
        if feedback is not None and feedback.isCanceled():
            raise Cancelled
        if not sink.addFeatures(some, QgsFeatureSink.Flag.FastInsert):
            raise RoadExtractionError(
                tr("The result could not be written: {reason}. Is the disk full or the file open elsewhere?").format(
                    reason=sink.lastError() or tr("the sink refused the features")
                )
            )
    # Absent on QGIS 3.40, needed from 3.44 on
    if hasattr(sink, "finalize"):
        sink.finalize()
