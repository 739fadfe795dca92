"""QGIS's 3D view of a road map: curbs with their height, paint and driving lines where they lie."""

from __future__ import annotations

import math

import numpy as np
import shapely
from qgis._3d import QgsColorRampPointCloud3DSymbol, QgsPointCloudLayer3DRenderer  # also, without it QGIS ends where it gives out a 3D view
from qgis.core import (
    QgsColorRampShader,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsFeature,
    QgsFillSymbol,
    QgsGeometry,
    QgsGradientColorRamp,
    QgsMapLayer,
    QgsNullSymbolRenderer,
    QgsPointCloudExtentRenderer,
    QgsPointCloudLayer,
    QgsProcessingUtils,
    QgsProject,
    QgsTask,
    QgsVector3D,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.gui import QgisInterface
from qgis.PyQt import sip
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtXml import QDomDocument

from ..core.lazy import laspy
from ..core.survey.las.copc_writer import write_copc
from ..processing_provider.results.road_maps import RoadMap, clouds_of, output_of
from ..processing_provider.styling import LOOKS, STYLES
from ..processing_provider.texts import tr
from .background import with_points

DARK, BRIGHT = "#3c4045", "#ffffff"
CURB_WIDTH = 0.12     # m
UNKNOWN_HEIGHT = 0.12  # m that a curb is drawn high whose height is not known
POINTS = "lanewright/points"   # custom property of a layer of points about a place; QGIS ends where one goes while a view still loads it
WALLS = "lanewright/walls_of"  # custom property of a layer with curbs for the 3D view: the edges that it shows
SHOWN = ("ROAD_SURFACE", "MARKINGS", "ROAD_EDGES", "DRIVING_LINES")   # results; of dashed lines the dashes are markings
AROUND, MOST = 80.0, 4_000_000   # m about the place from which points come, and how many
TASKS: set[QgsTask] = set()   # that read points; QGIS keeps no reference
DISTANCE, PITCH = 45.0, 60.0  # m from the place to the camera, and degrees from straight down


def give_3d_looks(road_map: RoadMap) -> list[QgsVectorLayer]:
    """The layers that a 3D view shows, each with 3D symbols; those that a user chose stay."""
    shown = []
    for layer in road_map.vectors:
        output = output_of(layer)
        if output not in SHOWN:
            continue
        if layer.renderer3D() is None:
            _give_look(layer, LOOKS[output][0])
        shown += [layer] if output != "ROAD_EDGES" else [layer, _curb_walls(layer)]
    return shown


def _give_look(layer, name):
    """Give a layer the 3D symbols of one of our styles; QGIS itself points them at the layer when it draws them.

    Lines are simple ones: broad ones are buffered by QGIS, which loses their heights. Paint and lines lie some cm above the surface, or they flicker.
    """
    document = QDomDocument()
    document.setContent((STYLES / "in_3d" / f"{name}.qml").read_text(encoding="utf-8"))
    layer.importNamedStyle(document, QgsMapLayer.StyleCategory.Symbology3D)


def _curb_walls(edges):
    """A layer beside the edges with curb stones from their bottom to their top, made anew of edges as they are now; the map shows nothing of it.

    QGIS draws broad lines without their heights: so each piece is a narrow area that is extruded. The 3D view shows layers of the layer tree alone.
    """
    project = QgsProject.instance()
    project.removeMapLayers([layer.id() for layer in project.mapLayers().values() if layer.customProperty(WALLS) == edges.id()])
    made = QgsVectorLayer(f"MultiPolygonZ?crs={edges.crs().authid()}&field=height_m:double", "curbs", "memory")
    for feature in edges.getFeatures():
        if feature["edge"] == "pavement" or feature["part"] == "top":
            continue
        places = shapely.get_coordinates(shapely.from_wkb(bytes(feature.geometry().asWkb())), include_z=True)
        way = np.diff(places[:, :2], axis=0)
        across = np.c_[way[:, 1], -way[:, 0], np.zeros(len(way))] * (CURB_WIDTH / 2 / np.fmax(np.hypot(*way.T), 1e-6))[:, None]
        stones = QgsGeometry()
        stones.fromWkb(shapely.to_wkb(shapely.multipolygons(shapely.polygons(np.stack(
            [places[:-1] + across, places[:-1] - across, places[1:] - across, places[1:] + across], axis=1)))))
        wall = QgsFeature(made.fields())
        wall.setGeometry(stones)
        wall["height_m"] = feature["height_m"] or UNKNOWN_HEIGHT
        made.dataProvider().addFeatures([wall])
    # a file: of layers in memory QGIS 3.40 knows no heights, and shows nothing
    path = QgsProcessingUtils.generateTempFilename("curbs.gpkg")
    QgsVectorFileWriter.writeAsVectorFormatV3(made, path, project.transformContext(), QgsVectorFileWriter.SaveVectorOptions())
    walls = QgsVectorLayer(path, tr("Curbs for the 3D view"), "ogr")
    walls.setCustomProperty(WALLS, edges.id())
    walls.setRenderer(QgsNullSymbolRenderer())
    _give_look(walls, "curbs")
    project.addMapLayer(walls, False)
    node = project.layerTreeRoot().findLayer(edges)
    group = node.parent() if node is not None else project.layerTreeRoot()
    group.insertLayer(group.children().index(node) + 1 if node is not None else -1, walls)
    return walls


def _bring_points(road_map, place, canvas, project):
    """Read the points about a place in the background and show them: as COPC, which every QGIS shows, LAS and LAZ only one with PDAL."""
    def ready(task, made, problem):
        TASKS.discard(task)
        if made is not None and not sip.isdeleted(canvas) and all(project.mapLayer(layer.id()) for layer in road_map.vectors):
            cloud, settings = _cloud(*made, title, road_map.vectors[0].crs()), canvas.mapSettings()
            project.addMapLayer(cloud, False)
            (road_map.group or project.layerTreeRoot()).addLayer(cloud)
            settings.setLayers([cloud, *settings.layers()])

    paths, title = clouds_of(road_map, project)[0], tr("Points of the 3D view")
    if paths:
        TASKS.add(with_points(title, paths, place, AROUND, _as_copc, ready))


def _as_copc(points):
    """(path of a COPC file, a low and a high intensity) of (N, 4) x, y, z and intensity, at most MOST of them; None of none."""
    if not len(points):
        return None
    points = points[::math.ceil(len(points) / MOST)]
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.floor(points[0, :3])
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points[:, :3].T
    cloud.intensity = points[:, 3].astype(np.uint16)
    path = QgsProcessingUtils.generateTempFilename("points.copc.laz")
    write_copc(cloud, path)
    return path, *np.percentile(points[:, 3], (2, 98)).tolist()


def _cloud(path, weak, strong, title, crs):
    """A layer of points, the brighter the stronger their echo; the map shows nothing of it."""
    options = QgsPointCloudLayer.LayerOptions()
    options.skipStatisticsCalculation = True
    cloud = QgsPointCloudLayer(path, title, "copc", options)
    cloud.setCrs(crs)
    cloud.setCustomProperty(POINTS, True)
    cloud.setRenderer(QgsPointCloudExtentRenderer(QgsFillSymbol.createSimple({"style": "no", "outline_style": "no"})))
    shader = QgsColorRampShader(weak, strong, QgsGradientColorRamp(QColor(DARK), QColor(BRIGHT)))
    shader.classifyColorRamp(2)
    symbol, look = QgsColorRampPointCloud3DSymbol(), QgsPointCloudLayer3DRenderer()
    symbol.setAttribute("Intensity")
    symbol.setColorRampShader(shader)
    symbol.setColorRampShaderMinMax(weak, strong)
    symbol.setPointSize(1.0)
    look.setSymbol(symbol)
    look.setLayer(cloud)
    cloud.setRenderer3D(look)
    return cloud


def show_in_3d(iface: QgisInterface, road_map: RoadMap, title: str) -> bool:
    """Open a 3D view of the road map with the camera over the middle of the map window; False where QGIS could not open one.

    Point clouds that the map shows come with it, else the points of the survey about the place, as soon as they are read.
    """
    project = QgsProject.instance()
    layers = give_3d_looks(road_map)
    canvas = iface.createNewMapCanvas3D(title)
    if canvas is None:
        return False
    settings, view = canvas.mapSettings(), iface.mapCanvas()
    place = view.extent().center()
    there = QgsCoordinateTransform(view.mapSettings().destinationCrs(), road_map.vectors[0].crs(), project).transform(place)
    shown = [layer for layer in view.layers() if isinstance(layer, QgsPointCloudLayer)
             and (not layer.customProperty(POINTS) or layer.extent().scaled(0.5).contains(there))]
    settings.setLayers([*shown, *layers])
    settings.setTerrainRenderingEnabled(False)  # a flat one at height 0 would hide the road or hang far below it
    settings.setBackgroundColor(QColor("#e8edf2"))
    x, y, z = place.x(), place.y(), height_at(road_map, QgsGeometry.fromPointXY(place), view.mapSettings().destinationCrs(), project)
    canvas.cameraController().setLookingAtPoint(settings.mapToWorldCoordinates(QgsVector3D(x, y, z)), DISTANCE, PITCH, 0.0)
    if not shown:
        _bring_points(road_map, (there.x(), there.y()), canvas, project)
    return True


def height_at(road_map: RoadMap, place: QgsGeometry, crs: QgsCoordinateReferenceSystem, project: QgsProject) -> float:
    """z of the road map's line that is nearest to a place; 0 where none has a height."""
    nearest, z = float("inf"), 0.0
    for layer in road_map.vectors:
        if output_of(layer) not in ("DRIVING_LINES", "ROAD_EDGES"):
            continue
        there = QgsGeometry(place)
        there.transform(QgsCoordinateTransform(crs, layer.crs(), project))
        for feature in layer.getFeatures():
            distance, _, after, _ = feature.geometry().closestSegmentWithContext(there.asPoint())
            vertex = feature.geometry().vertexAt(after)
            if distance < nearest and vertex.is3D():
                nearest, z = distance, vertex.z()
    return z
