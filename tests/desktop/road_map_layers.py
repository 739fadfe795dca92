"""Layers of a road map in a project, as a run leaves them there."""

from lanewright.processing_provider.layers import qgis_fields
from lanewright.processing_provider.results.attributes import explain_attributes
from lanewright.processing_provider.results.layer_tree import place_layer
from lanewright.processing_provider.results.runs import Run
from qgis.core import QgsFeature, QgsGeometry, QgsVectorLayer

EAST, NORTH = 500_000.0, 5_400_000.0


def added(project, output, schema, *rows, kind="LineStringZ"):
    """A layer of a road map; rows of (WKT about EAST, NORTH, fields)."""
    layer = QgsVectorLayer(f"{kind}?crs=EPSG:32650", output, "memory")
    layer.dataProvider().addAttributes(list(qgis_fields(schema, with_aliases=False)))
    layer.updateFields()
    for wkt, row in rows:
        feature = QgsFeature(layer.fields())
        geometry = QgsGeometry.fromWkt(wkt)
        geometry.translate(EAST, NORTH)
        feature.setGeometry(geometry)
        for name, value in row.items():
            feature[name] = value
        layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    explain_attributes(layer, output, schema)
    run = Run("roadmap", "B12", "B12, 8:00", ("/data/B12/a.laz", "/data/B12/b.laz"))
    project.addMapLayer(layer, False)
    root = project.layerTreeRoot()
    (root.findGroup(run.group) or root.insertGroup(0, run.group)).insertLayer(0, layer)
    place_layer(layer, project, output, run)
    return layer
