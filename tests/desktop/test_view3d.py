"""A road map in QGIS's 3D view: everything lies at its height, and the camera looks at the place that the map window shows."""

from types import SimpleNamespace

import laspy
import numpy as np
import pytest
from lanewright.core.common.features import DRIVING_LINES, MARKINGS, ROAD_EDGES
from lanewright.desktop.view3d import TASKS, give_3d_looks, show_in_3d
from lanewright.processing_provider.results.road_maps import road_maps
from qgis._3d import Qgs3D, Qgs3DMapSettings, QgsLine3DSymbol, QgsVectorLayer3DRenderer
from qgis.core import Qgis, QgsMapLayer, QgsProject, QgsProviderRegistry, QgsReadWriteContext, QgsRectangle
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtXml import QDomDocument
from road_map_layers import EAST, NORTH, added, run_at


@pytest.fixture
def road_map(project):
    Qgs3D.initialize()   # as a QGIS window does when it starts
    added(project, "DRIVING_LINES", DRIVING_LINES, ("LINESTRING Z (0 0 100, 400 0 104)", dict(lane=1, direction=1)))
    added(project, "MARKINGS", MARKINGS, ("POLYGON Z ((0 1 100, 9 1 100, 9 2 100, 0 1 100))", {}), kind="PolygonZ")
    added(project, "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (0 5 100, 20 5 100.2)", dict(edge="curb", part="bottom", height_m=0.14)),
          ("LINESTRING Z (0 -5 100, 20 -5 100)", dict(edge="pavement", part="bottom", height_m=0.0)))
    return road_maps(project)[0]


def look_of(layer):
    """The 3D symbols of a layer as QGIS writes them."""
    document = QDomDocument()
    layer.exportNamedStyle(document, QgsReadWriteContext(), QgsMapLayer.StyleCategory.Symbology3D)
    return document.toString()


def test_all_layers_lie_at_their_heights_and_curbs_are_stones_as_high_as_measured(road_map):
    shown = give_3d_looks(road_map)
    assert {layer.name() for layer in shown} == {"DRIVING_LINES", "MARKINGS", "ROAD_EDGES", "Curbs for the 3D view"}
    assert all('alt-clamping="absolute"' in look_of(layer) for layer in shown)
    assert 'value="height_m"' in look_of(next(layer for layer in shown if layer.name().startswith("Curbs")))
    stones, = (layer for layer in shown if layer.name().startswith("Curbs"))
    stone, = stones.getFeatures()
    assert stone["height_m"] == 0.14, "an edge of the pavement has no stone"
    heights = [vertex.z() for vertex in stone.geometry().vertices()]
    assert (min(heights), max(heights)) == (100.0, 100.2)
    assert stones.extent3D().zMinimum() == 100.0, "QGIS shows nothing of a layer whose heights it does not know"
    assert QgsProject.instance().layerTreeRoot().findLayer(stones) is not None, "the 3D view shows layers of the layer tree alone"


def test_who_opens_the_view_again_has_the_curbs_once_and_keeps_a_look_of_ones_own(road_map):
    give_3d_looks(road_map)
    lines = next(layer for layer in road_map.vectors if layer.name() == "DRIVING_LINES")
    chosen = QgsLine3DSymbol()
    chosen.setAltitudeClamping(Qgis.AltitudeClamping.Terrain)
    lines.setRenderer3D(QgsVectorLayer3DRenderer(chosen))
    count = len(QgsProject.instance().mapLayers())
    give_3d_looks(road_map)
    assert len(QgsProject.instance().mapLayers()) == count and lines.renderer3D().symbol().altitudeClamping() == chosen.altitudeClamping()
    assert len(road_maps(QgsProject.instance())) == 1 and len(road_maps(QgsProject.instance())[0].vectors) == 3


def test_the_camera_looks_at_the_road_in_the_middle_of_the_map_window(road_map):
    canvas, settings, seen = QgsMapCanvas(), Qgs3DMapSettings(), []
    canvas.setDestinationCrs(road_map.vectors[0].crs())
    canvas.setExtent(QgsRectangle(EAST + 190, NORTH - 10, EAST + 210, NORTH + 10))
    camera = SimpleNamespace(setLookingAtPoint=lambda *values: seen.append(values))
    view = SimpleNamespace(mapSettings=lambda: settings, cameraController=lambda: camera)
    iface = SimpleNamespace(mapCanvas=lambda: canvas, createNewMapCanvas3D=lambda name: view)
    assert show_in_3d(iface, road_map, "road")
    place = settings.worldToMapCoordinates(seen[0][0])
    np.testing.assert_allclose((place.x(), place.y(), place.z()), (EAST + 200, NORTH, 102), atol=2.1)
    assert len(settings.layers()) == 4 and not settings.terrainRenderingEnabled()
    iface.createNewMapCanvas3D = lambda name: None
    assert not show_in_3d(iface, road_map, "road")


@pytest.mark.skipif("copc" not in QgsProviderRegistry.instance().providerList(), reason="this QGIS shows no COPC")
@pytest.mark.parametrize("far", [0.0, 1000.0])
def test_points_about_the_place_come_as_soon_as_they_are_read_and_once(project, tmp_path, far):
    cloud = laspy.create(point_format=1, file_version="1.2")
    cloud.x, cloud.y, cloud.z = EAST + far + np.arange(1000) / 5, NORTH + np.zeros(1000), np.full(1000, 100.0)
    cloud.intensity = np.arange(1000)
    cloud.write(tmp_path / "street.laz")
    added(project, "DRIVING_LINES", DRIVING_LINES, ("LINESTRING Z (0 0 100, 200 0 100)", dict(lane=1, direction=1)),
          run=run_at(8, POINT_CLOUDS=[str(tmp_path / "street.laz")]))
    crs = project.mapLayersByName("DRIVING_LINES")[0].crs()
    for x, count, layers in ((0.0, 401, 1), (100.0, 801, 2), (120.0, 801, 2)):
        canvas, settings = QgsMapCanvas(), Qgs3DMapSettings()
        canvas.setDestinationCrs(crs)
        canvas.setLayers(list(project.mapLayers().values()))
        canvas.setExtent(QgsRectangle(EAST + x - 10, NORTH - 10, EAST + x + 10, NORTH + 10))
        view = QObject()
        view.mapSettings, view.cameraController = lambda: settings, lambda: SimpleNamespace(setLookingAtPoint=lambda *values: None)
        assert show_in_3d(SimpleNamespace(mapCanvas=lambda: canvas, createNewMapCanvas3D=lambda name: view), road_maps(project)[0], "road")
        for _ in range(1500):
            QTest.qWait(20)
            if not TASKS:
                break
        points = [layer for layer in settings.layers() if layer.type() == Qgis.LayerType.PointCloud]
        assert [(layer.isValid(), layer.pointCount(), layer.crs()) for layer in points] == ([(True, count, crs)] if not far else [])
        clouds = [layer for layer in project.mapLayers().values() if layer.type() == Qgis.LayerType.PointCloud]
        assert len(clouds) == (0 if far else layers)
        for layer in points:
            symbol = layer.renderer3D().symbol()
            assert symbol.attribute() == "Intensity" and 0 < symbol.colorRampShaderMin() < symbol.colorRampShaderMax() < 1000
            assert layer.renderer().type() == "extent", "the map shows nothing of them"
