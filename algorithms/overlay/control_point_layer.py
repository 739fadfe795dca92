"""Ground control points from a layer: the map coordinates of its points, the rest from its fields."""

from ...core.common.errors import RoadExtractionError
from ..texts import tr
from ..vector_source import LINE, POINT, POLYGON, vertices_of


def read_control_point_layer(source, image, crs=""):
    """ControlPoints of a layer.

    Parameters
    ----------
    source : VectorSource, points with the fields pixel and line, or a table
    image : SourceImage that the points belong to
    crs : WKT where the layer carries none

    Raises RoadExtractionError if the layer holds lines or polygons, or lacks a field.
    """
    from ...products.overlay.control_points import control_points

    if source.kind in (LINE, POLYGON):
        raise RoadExtractionError(
            tr("{label}: the layer holds {kind} geometries. Control points are points, or a table.").format(
                label=source.label, kind=source.kind_label(source.kind)))
    placed = source.kind == POINT
    rows = [_row(wkb, values, placed) for wkb, values in source.stored_rows()]
    return control_points([*source.names, *["mapX", "mapY", "mapZ"] * placed], rows, image, source.label, source.stored_crs or crs)


def _row(wkb, values, placed):
    if not placed:
        return list(values)
    vertices = vertices_of(wkb) if wkb else []
    if not len(vertices):
        return [*values, None, None, None]
    x, y, z, _ = vertices[0].tolist()
    return [*values, x, y, z if z == z else None]
