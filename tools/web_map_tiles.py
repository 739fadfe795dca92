"""A web map for the pictures of the manual, where there may be no internet: tiles about the sample street, served by this computer."""

import socket
import subprocess
import tempfile
import time
from pathlib import Path

from qgis import processing
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsFeature,
    QgsFillSymbol,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsSingleSymbolRenderer,
    QgsVectorLayer,
)

WEB = QgsCoordinateReferenceSystem("EPSG:3857")
ROAD, PAVEMENT = 6.5, 9.5      # m from the driven line to the edge of the road, and of the sidewalk
BEYOND = 60.0                  # m that the street goes on at either end
HOUSES = 14.0                  # m from the driven line to the houses
LOOKS = {"land": ("#eef0e4", "#eef0e4"), "garden": ("#d7e6c4", "#c9dab3"), "pavement": ("#dcd8d2", "#c6c1ba"),
         "road": ("#ffffff", "#cfcac2"), "house": ("#d9c9b8", "#b9a590")}


def served_tiles(survey):
    """The address of tiles in EPSG:3857 about a survey with a trajectory.csv, and the process that serves them."""
    folder = Path(tempfile.mkdtemp())
    layers = _layers(_track(survey / "trajectory.csv"))
    project = QgsProject.instance()
    project.setCrs(WEB)
    project.addMapLayers(layers)
    extent = layers[-1].extent()
    processing.run("native:tilesxyzdirectory", {
        "EXTENT": f"{extent.xMinimum()},{extent.xMaximum()},{extent.yMinimum()},{extent.yMaximum()} [EPSG:3857]", "ZOOM_MIN": 14, "ZOOM_MAX": 19,
        "DPI": 96, "TILE_FORMAT": 0, "OUTPUT_DIRECTORY": str(folder)})
    project.clear()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen(["/usr/bin/python3", "-m", "http.server", str(port), "--bind", "127.0.0.1", "--directory", str(folder)],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(300):  # until it answers
        with socket.socket() as call:
            if call.connect_ex(("127.0.0.1", port)) == 0:
                break
        time.sleep(0.1)
    return f"http://127.0.0.1:{port}/{{z}}/{{x}}/{{y}}.png", server


def _track(path):
    """The driven line."""
    rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    return QgsGeometry.fromPolylineXY([QgsPointXY(float(row[1]), float(row[2])) for row in rows[::20]])


def _layers(track):
    """What the map shows, from above; offsets in metres of the survey's CRS, before it is brought to that of the web."""
    along, length = [], track.length()
    track = track.extendLine(BEYOND, BEYOND)
    for side in (1, -1):
        row = track.offsetCurve(side * HOUSES, 4, Qgis.JoinStyle.Round, 2.0)
        at = 4.0
        while at + 11 < row.length():
            front = QgsGeometry.fromPolylineXY([row.interpolate(at + k).asPoint() for k in range(12)])
            along.append(front.singleSidedBuffer(9, 4, Qgis.BufferSide.Left if side > 0 else Qgis.BufferSide.Right))
            at += 18.0
    shapes = {"house": along, "road": [track.buffer(ROAD, 8)], "pavement": [track.buffer(PAVEMENT, 8)],
              "garden": [track.buffer(HOUSES + 12, 8)], "land": [QgsGeometry.fromRect(track.boundingBox().buffered(length))]}
    return [_layer(name, found) for name, found in shapes.items()]


def _layer(name, shapes):
    to_web = QgsCoordinateTransform(QgsCoordinateReferenceSystem("EPSG:32650"), WEB, QgsProject.instance())
    layer = QgsVectorLayer("Polygon?crs=EPSG:3857", name, "memory")
    for shape in shapes:
        feature = QgsFeature()
        shape.transform(to_web)
        feature.setGeometry(shape)
        layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    fill, outline = LOOKS[name]
    layer.setRenderer(QgsSingleSymbolRenderer(QgsFillSymbol.createSimple({"color": fill, "outline_color": outline, "outline_width": "0.3"})))
    return layer
