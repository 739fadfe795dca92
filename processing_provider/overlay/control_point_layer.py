"""Ground control points from a layer: the map coordinates of its points, the rest from its fields."""

from qgis.core import Qgis, QgsWkbTypes

from ...core.common.errors import RoadExtractionError
from ..layers import crs_text
from ..texts import tr


def read_control_point_layer(source, image, label, crs=""):
    """ControlPoints of a feature source.

    Parameters
    ----------
    source : QgsFeatureSource, points with the fields pixel and line, or a table
    image : SourceImage that the points belong to
    label : the parameter's name, for messages
    crs : WKT where the layer carries none

    Raises
    ------
    RoadExtractionError
        If the layer holds lines or polygons, or lacks a field.
    """
    from ...core.overlay.control_points import control_points

    kind = QgsWkbTypes.geometryType(source.wkbType())
    if kind not in (Qgis.GeometryType.Point, Qgis.GeometryType.Null, Qgis.GeometryType.Unknown):
        raise RoadExtractionError(
            tr("{label}: the layer holds {kind} geometries. Control points are points, or a table.").format(
                label=label, kind=QgsWkbTypes.geometryDisplayString(kind)))
    names = [field.name() for field in source.fields()]
    placed = kind == Qgis.GeometryType.Point
    rows = [_row(feature, placed) for feature in source.getFeatures()]
    return control_points(names + ["mapX", "mapY", "mapZ"] * placed, rows, image, label, crs_text(source.sourceCrs()) or crs)


def _row(feature, placed):
    values = [None if hasattr(value, "isNull") and value.isNull() else value for value in feature.attributes()]
    if not placed:
        return values
    point = next(feature.geometry().vertices(), None) if feature.hasGeometry() else None
    if point is None:
        return [*values, None, None, None]
    return [*values, point.x(), point.y(), point.z() if point.is3D() else None]
