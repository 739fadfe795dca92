"""Two images in one map, divided by a line under the mouse."""

import numpy as np
import pytest
from lanewright.core.common.features import ROAD_EDGES
from lanewright.desktop.overlay.swipe import Swipe, images_to_compare
from lanewright.processing_provider.results.road_maps import OUTPUT
from osgeo import gdal
from qgis.core import QgsCoordinateReferenceSystem, QgsProject, QgsRasterLayer, QgsRectangle
from qgis.gui import QgsMapCanvas, QgsMapToolPan
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, Qt
from qgis.PyQt.QtGui import QImage
from qgis.PyQt.QtTest import QTest
from road_map_layers import EAST, NORTH, added


def image(folder, name, grey):
    """A grey image of 40 x 40 m about the road, in the project below all others."""
    path = str(folder / f"{name}.tif")
    data = gdal.GetDriverByName("GTiff").Create(path, 40, 40, 3, gdal.GDT_Byte)
    data.SetGeoTransform((EAST, 1, 0, NORTH + 20, 0, -1))
    data.SetProjection(QgsCoordinateReferenceSystem("EPSG:32650").toWkt())
    data.WriteArray(np.full((3, 40, 40), grey, np.uint8))
    data = None
    layer = QgsRasterLayer(path, name)
    QgsProject.instance().addMapLayer(layer, False)
    QgsProject.instance().layerTreeRoot().addLayer(layer)
    return layer


@pytest.fixture
def canvas(qgis_app, tmp_path):
    project = QgsProject.instance()
    project.clear()
    canvas = QgsMapCanvas()
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:32650"))
    canvas.resize(200, 200)
    canvas.show()
    canvas.setExtent(QgsRectangle(EAST, NORTH - 20, EAST + 40, NORTH + 20))
    yield canvas
    project.clear()


def wait_until(condition):
    clock = QElapsedTimer()
    clock.start()
    while not condition() and clock.elapsed() < 20_000:
        QCoreApplication.processEvents()
    assert condition()


def greys(widget, *places):
    picture = widget.grab().toImage().convertToFormat(QImage.Format.Format_Grayscale8)
    return [picture.pixelColor(x, y).red() for x, y in places]


def test_left_of_the_mouse_lies_the_orthoimage_and_right_of_it_the_intensity_image_with_lines_on_both(canvas, tmp_path):
    intensity, ortho = image(tmp_path, "intensity", 60), image(tmp_path, "ortho", 200)
    intensity.setCustomProperty(OUTPUT, "INTENSITY_IMAGE")
    edge = added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0)))
    canvas.setLayers([edge, intensity, ortho])
    hand = QgsMapToolPan(canvas)
    canvas.setMapTool(hand)
    swipe = Swipe(canvas)
    swipe.begin(images_to_compare(QgsProject.instance()))
    wait_until(swipe.halves.isVisible)
    QTest.mouseMove(canvas.viewport(), canvas.viewport().rect().center())
    swipe.halves.divide(120)
    left, right = greys(swipe.halves, (60, 150), (160, 150))
    assert left > 150 > 100 > right, (left, right)
    for at, ground in ((60, left), (160, right)):
        assert any(value != ground for value in greys(swipe.halves, *((at, y) for y in range(90, 111)))), "the line of the map is on both"
    swipe.halves.divide(30)
    assert greys(swipe.halves, (60, 150))[0] < 100, "the line follows the mouse"
    QTest.keyClick(canvas, Qt.Key.Key_Escape)
    assert not swipe.halves.isVisible() and canvas.mapTool() is hand, "the map can be moved again"


def test_it_ends_with_another_tool_and_where_an_image_leaves_the_project(canvas, tmp_path):
    layers = [image(tmp_path, "a", 60), image(tmp_path, "b", 200)]
    swipe = Swipe(canvas)
    swipe.begin(layers)
    wait_until(swipe.halves.isVisible)
    canvas.setMapTool(QgsMapToolPan(canvas))
    assert not swipe.halves.isVisible()
    swipe.begin(layers)
    QgsProject.instance().removeMapLayer(layers[0].id())
    assert canvas.mapTool() is not swipe and not swipe.images


def test_the_images_are_the_newest_intensity_image_and_the_active_or_uppermost_other_one(canvas, tmp_path):
    project = QgsProject.instance()
    assert images_to_compare(project) == []
    intensity = image(tmp_path, "intensity", 60)
    intensity.setCustomProperty(OUTPUT, "INTENSITY_IMAGE")
    assert images_to_compare(project) == [intensity]
    first, second = image(tmp_path, "first", 90), image(tmp_path, "second", 120)
    assert images_to_compare(project) == [first, intensity]
    assert images_to_compare(project, second) == [second, intensity]
    project.layerTreeRoot().findLayer(first.id()).setItemVisibilityChecked(False)
    assert images_to_compare(project) == [second, intensity], "what is shown comes first"
