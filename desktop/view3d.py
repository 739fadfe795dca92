"""QGIS's 3D view of a road map: curbs with their height, paint and driving lines where they lie."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import shapely
from qgis.core import (
    Qgis,
    QgsColorRampShader,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsFeature,
    QgsFillSymbol,
    QgsGeometry,
    QgsGradientColorRamp,
    QgsNullSymbolRenderer,
    QgsPointCloudExtentRenderer,
    QgsPointCloudLayer,
    QgsProcessingUtils,
    QgsProject,
    QgsProperty,
    QgsPropertyCollection,
    QgsProviderRegistry,
    QgsVector3D,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.gui import QgisInterface
from qgis.PyQt.QtGui import QColor

from ..core.common.errors import RoadExtractionError
from ..core.survey.las.reader import read_blocks
from ..processing_provider.results.road_maps import RoadMap, clouds_of, output_of
from ..processing_provider.texts import tr

STONE, DARK, BRIGHT = "#d8d2c4", "#3c4045", "#ffffff"
SAMPLE = 50_000       # points by which the brightness of a cloud is set
LINE_WIDTH = 2.0       # pixels of driving lines and edges without a curb
CURB_WIDTH = 0.12     # m
UNKNOWN_HEIGHT = 0.12  # m that a curb is drawn high whose height is not known
WALLS = "lanewright/walls_of"  # custom property of a layer with curbs for the 3D view: the edges that it shows
# colour, and m above the surface, or the two would flicker; of dashed lines the dashes are markings
LOOKS = {"ROAD_SURFACE": ("#8d9299", 0.0), "MARKINGS": ("#ffffff", 0.02), "ROAD_EDGES": ("#26282b", 0.02), "DRIVING_LINES": ("#1554b0", 0.05)}
DISTANCE, PITCH = 45.0, 60.0  # m from the place to the camera, and degrees from straight down


def give_3d_looks(road_map: RoadMap) -> list[QgsVectorLayer]:
    """The layers that a 3D view shows, each with 3D symbols; those that a user chose stay."""
    shown = []
    for layer in road_map.vectors:
        output = output_of(layer)
        if output not in LOOKS:
            continue
        colour, above = LOOKS[output]
        if layer.renderer3D() is None:
            _give(layer, _area(colour, above) if layer.geometryType() == Qgis.GeometryType.Polygon else _line(colour, above))
        shown += [layer] if output != "ROAD_EDGES" else [layer, _curb_walls(layer)]
    return shown


def _give(layer, symbol):
    from qgis._3d import QgsVectorLayer3DRenderer

    renderer = QgsVectorLayer3DRenderer(symbol)
    renderer.setLayer(layer)
    layer.setRenderer3D(renderer)


def _area(colour, above):
    from qgis._3d import QgsPhongMaterialSettings, QgsPolygon3DSymbol

    material = QgsPhongMaterialSettings()
    material.setDiffuse(QColor(colour).darker(500))
    material.setSpecular(QColor("#000000"))
    return _at_its_height(QgsPolygon3DSymbol(), material, colour, above)


def _line(colour, above):
    """Simple lines: broad ones are buffered by QGIS, which loses their heights."""
    from qgis._3d import QgsLine3DSymbol, QgsSimpleLineMaterialSettings

    symbol = QgsLine3DSymbol()
    symbol.setRenderAsSimpleLines(True)
    symbol.setWidth(LINE_WIDTH)
    return _at_its_height(symbol, QgsSimpleLineMaterialSettings(), colour, above)


def _at_its_height(symbol, material, colour, above):
    material.setAmbient(QColor(colour))  # the same from all sides: outlines run either way round
    symbol.setMaterialSettings(material)
    symbol.setAltitudeClamping(Qgis.AltitudeClamping.Absolute)
    symbol.setAltitudeBinding(Qgis.AltitudeBinding.Vertex)
    symbol.setOffset(above)
    return symbol


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
    symbol = _area(STONE, 0.0)
    extruded = QgsPropertyCollection()
    extruded.setProperty(symbol.Property.ExtrusionHeight, QgsProperty.fromField("height_m"))
    symbol.setDataDefinedProperties(extruded)
    _give(walls, symbol)
    project.addMapLayer(walls, False)
    node = project.layerTreeRoot().findLayer(edges)
    group = node.parent() if node is not None else project.layerTreeRoot()
    group.insertLayer(group.children().index(node) + 1 if node is not None else -1, walls)
    return walls


def _clouds(road_map, project):
    """The survey's point clouds as layers of the project, the brighter the stronger their echo; the map shows nothing of them."""
    from qgis._3d import QgsColorRampPointCloud3DSymbol, QgsPointCloudLayer3DRenderer

    known = {layer.source(): layer for layer in project.mapLayers().values() if isinstance(layer, QgsPointCloudLayer)}
    options = QgsPointCloudLayer.LayerOptions()
    options.skipStatisticsCalculation = True
    clouds = []
    for path in clouds_of(road_map, project)[0]:
        providers = QgsProviderRegistry.instance().preferredProvidersForUri(path)
        if path not in known and providers:
            cloud = known[path] = QgsPointCloudLayer(path, Path(path).name, providers[0].metadata().key(), options)
            cloud.setRenderer(QgsPointCloudExtentRenderer(QgsFillSymbol.createSimple({"style": "no", "outline_style": "no"})))
            weak, strong = _intensities(path)
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
            project.addMapLayer(cloud, False)
            (road_map.group or project.layerTreeRoot()).addLayer(cloud)
        clouds += [known[path]] if path in known else []
    return clouds


def _intensities(path):
    """A low and a high one of a cloud's first points."""
    try:
        return np.percentile(next(read_blocks(path, SAMPLE, layers=("intensity",))).intensity, (2, 98)).tolist()
    except (RoadExtractionError, StopIteration):   # damaged, or without points
        return 0.0, 65535.0


def show_in_3d(iface: QgisInterface, road_map: RoadMap, title: str) -> bool:
    """Open a 3D view of the road map with the camera over the middle of the map window; False where QGIS could not open one.

    Point clouds that the project shows come with it, else those of the survey where QGIS can show them: COPC, and with PDAL LAS and LAZ too.
    """
    project = QgsProject.instance()
    layers = give_3d_looks(road_map)
    canvas = iface.createNewMapCanvas3D(title)
    if canvas is None:
        return False
    settings, view = canvas.mapSettings(), iface.mapCanvas()
    shown = [layer for layer in view.layers() if isinstance(layer, QgsPointCloudLayer)]
    settings.setLayers([*(shown or _clouds(road_map, project)), *layers])
    settings.setTerrainRenderingEnabled(False)  # a flat one at height 0 would hide the road or hang far below it
    settings.setBackgroundColor(QColor("#e8edf2"))
    place = view.extent().center()
    x, y, z = place.x(), place.y(), height_at(road_map, QgsGeometry.fromPointXY(place), view.mapSettings().destinationCrs(), project)
    canvas.cameraController().setLookingAtPoint(settings.mapToWorldCoordinates(QgsVector3D(x, y, z)), DISTANCE, PITCH, 0.0)
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
