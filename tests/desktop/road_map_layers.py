"""Layers of a road map in a project, as a run leaves them there."""

from datetime import datetime, timezone
from pathlib import Path

from lanewright.algorithms.provenance import Provenance
from lanewright.processing_provider.call import qgis_fields
from lanewright.processing_provider.results.road_maps import Run, place_layer
from lanewright.processing_provider.styling import explain_attributes
from qgis.core import QgsFeature, QgsGeometry, QgsVectorFileWriter, QgsVectorLayer

EAST, NORTH = 500_000.0, 5_400_000.0


CLOUDS = ["/data/B12/a.laz", "/data/B12/b.laz"]


def run_at(hour, clouds=CLOUDS, survey="B12", algorithm="roadmap", **values):
    """A run of a survey that ended at an hour of one day."""
    provenance = Provenance(algorithm, "1.0", {"POINT_CLOUDS": clouds, **values}, datetime(2026, 6, 1, hour, tzinfo=timezone.utc))
    return Run(provenance, survey, f"{survey}, {hour}:00")


def added(project, output, schema, *rows, kind="LineStringZ", run=None, package=""):
    """A layer of a road map, in memory or as a table of a GeoPackage; rows of (WKT about EAST, NORTH, fields)."""
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
    if package:
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.layerName, options.actionOnExistingFile = output.lower(), QgsVectorFileWriter.ActionOnExistingFile.CreateOrOverwriteLayer
        if not Path(package).exists():
            options.actionOnExistingFile = QgsVectorFileWriter.ActionOnExistingFile.CreateOrOverwriteFile
        QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(package), project.transformContext(), options)
        layer = QgsVectorLayer(f"{package}|layername={output.lower()}", output, "ogr")
    explain_attributes(layer, output, schema)
    run = run or run_at(8)
    project.addMapLayer(layer, False)
    root = project.layerTreeRoot()
    group = root.findGroup(run.group) or root.insertGroup(0, run.group) if run.group else root
    group.insertLayer(0, layer)
    place_layer(layer, project, output, run)
    return layer
