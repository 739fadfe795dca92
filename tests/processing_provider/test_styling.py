"""Layers arrive in the project named, grouped and styled."""

import numpy as np
import pytest
from lanewright.core.schemas import DRIVING_LINES, MARKING_LINES, MARKINGS, ROAD_EDGES
from lanewright.processing_provider.layers import qgis_fields
from lanewright.processing_provider.styling import LOOKS, STYLES, Styler, style_on_load
from osgeo import gdal
from qgis.core import QgsProcessingContext, QgsProject, QgsRasterLayer, QgsRenderContext, QgsVectorLayer

KINDS = {
    "ROAD_EDGES": ("LineStringZ", ROAD_EDGES),
    "MARKINGS": ("PolygonZ", MARKINGS),
    "MARKING_LINES": ("LineStringZ", MARKING_LINES),
    "DRIVING_LINES": ("LineStringZ", DRIVING_LINES),
}


def layer_of(kind, schema):
    layer = QgsVectorLayer(kind, "layer", "memory")
    layer.dataProvider().addAttributes(list(qgis_fields(schema)))
    layer.updateFields()
    return layer


@pytest.mark.parametrize("name", LOOKS)
def test_every_result_has_a_style(name):
    assert (STYLES / f"{LOOKS[name][0]}.qml").exists()


@pytest.mark.parametrize("name", KINDS)
def test_a_style_looks_at_fields_that_the_layer_has(qgis_app, name):
    layer = layer_of(*KINDS[name])
    Styler.make(STYLES / f"{LOOKS[name][0]}.qml").postProcessLayer(layer, QgsProcessingContext(), None)
    used = layer.renderer().usedAttributes(QgsRenderContext())
    assert used and used <= {field.name() for field in layer.fields()}


def test_an_image_is_stretched_to_its_own_values(qgis_app, tmp_path):
    path = str(tmp_path / "image.tif")
    values = np.linspace(3000.0, 9000.0, 10000, dtype=np.float32)
    dataset = gdal.GetDriverByName("GTiff").Create(path, 100, 100, 1, gdal.GDT_Float32)
    dataset.GetRasterBand(1).WriteRaster(0, 0, 100, 100, values.tobytes())
    del dataset
    layer = QgsRasterLayer(path, "image")
    Styler.make(STYLES / "intensity_image.qml").postProcessLayer(layer, QgsProcessingContext(), None)
    stretch = layer.renderer().contrastEnhancement()
    assert 3000 <= stretch.minimumValue() < 3300 and 8700 < stretch.maximumValue() <= 9000


def test_what_is_loaded_comes_named_and_grouped(qgis_app):
    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    details = QgsProcessingContext.LayerDetails("x", context.project(), "x")
    context.addLayerToLoadOnCompletion("/data/edges.gpkg", details)
    style_on_load("ROAD_EDGES", "/data/edges.gpkg", "Road edges", context)
    loaded = context.layerToLoadOnCompletionDetails("/data/edges.gpkg")
    assert (loaded.name, loaded.groupName, loaded.forceName) == ("Road edges", "Road map", True)
    assert loaded.postProcessor() is not None


def test_what_is_not_loaded_is_left_alone(qgis_app):
    context = QgsProcessingContext()
    style_on_load("ROAD_EDGES", "/data/edges.gpkg", "Road edges", context)
    assert not context.layersToLoadOnCompletion()
