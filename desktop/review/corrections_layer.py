"""The layer of an analyst's corrections in the project: found, made, and written to."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    NULL,
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsFeature,
    QgsGeometry,
    QgsProject,
    QgsVectorFileWriter,
    QgsVectorLayer,
)

from ...core.common.errors import RoadExtractionError
from ...core.common.schemas import CORRECTIONS
from ...processing_provider.layers import qgis_fields
from ...processing_provider.results.origin import OUTPUT
from ...processing_provider.styling import STYLES, apply_style
from ...processing_provider.texts import tr

NAME = "CORRECTIONS"
TABLE = "corrections"
SAME_PLACE = 0.1   # m between two lines of which one is taken for the other


def corrections_layers(project: QgsProject) -> list[QgsVectorLayer]:
    """The layers of corrections in a project, newest first."""
    nodes = project.layerTreeRoot().findLayers()
    return [node.layer() for node in nodes if node.layer() is not None and node.layer().customProperty(OUTPUT) == NAME]


def new_corrections_layer(project: QgsProject, path: str, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
    """A layer of corrections above all others, in a GeoPackage; one that is there already is taken up again.

    Raises
    ------
    RoadExtractionError
        If the file cannot be written, or is another layer.
    """
    if not Path(path).exists():
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.driverName, options.layerName = "GPKG", TABLE
        writer = QgsVectorFileWriter.create(path, qgis_fields(CORRECTIONS, with_aliases=False), Qgis.WkbType.LineString, crs,
                                            project.transformContext(), options)
        problem = writer.errorMessage()
        del writer  # writes what it has
        if problem:
            raise RoadExtractionError(
                tr("The corrections cannot be kept in {path}: {problem}. Choose another place.").format(path=path, problem=problem))
    layer = QgsVectorLayer(f"{path}|layername={TABLE}", tr("Corrections"), "ogr")
    names = {field.name() for field in layer.fields()} if layer.isValid() else set()
    if not {"action", "target"} <= names:
        raise RoadExtractionError(tr("{path} holds no layer of corrections. Choose a new name.").format(path=path))
    apply_style(layer, STYLES / "corrections.qml", CORRECTIONS, NAME)
    layer.setCustomProperty(OUTPUT, NAME)
    project.addMapLayer(layer, False)
    project.layerTreeRoot().insertLayer(0, layer)
    return layer


def add_correction(layer: QgsVectorLayer, line: QgsGeometry, crs: QgsCoordinateReferenceSystem, **values: object) -> int:
    """Write one row; an earlier one of the same target at the same place makes room for it.

    Parameters
    ----------
    layer : of corrections
    line, crs : its course, and the CRS of its coordinates
    values : of the fields; those that are None stay empty

    Returns
    -------
    Number of the feature
    """
    placed = QgsGeometry(line)
    placed.transform(QgsCoordinateTransform(crs, layer.crs(), QgsProject.instance()))
    former = correction_at(layer, line, crs, str(values["target"]))
    feature = QgsFeature(layer.fields())
    feature.setGeometry(placed)
    for name, value in values.items():
        feature[name] = NULL if value is None else value
    if former is not None:
        _delete(layer, [former.id()])
    if layer.isEditable():
        layer.addFeature(feature)
    else:
        _, (feature,) = layer.dataProvider().addFeatures([feature])
        layer.updateExtents()
    layer.triggerRepaint()
    return feature.id()


def correction_at(layer: QgsVectorLayer, line: QgsGeometry, crs: QgsCoordinateReferenceSystem, target: str) -> QgsFeature | None:
    """The correction that was made of a piece, None where there is none."""
    placed = QgsGeometry(line)
    placed.transform(QgsCoordinateTransform(crs, layer.crs(), QgsProject.instance()))
    box = placed.boundingBox().buffered(SAME_PLACE)
    for feature in layer.getFeatures(box):
        if feature["target"] == target and feature.geometry().hausdorffDistance(placed) < SAME_PLACE:
            return feature
    return None


def take_back(layer: QgsVectorLayer) -> bool:
    """Delete the correction that was made last; False where there is none."""
    ids = layer.allFeatureIds()
    if not ids:
        return False
    _delete(layer, [max(ids)])
    layer.triggerRepaint()
    return True


def _delete(layer, ids):
    if layer.isEditable():
        layer.deleteFeatures(ids)
    else:
        layer.dataProvider().deleteFeatures(ids)
