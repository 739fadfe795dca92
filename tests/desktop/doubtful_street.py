"""A window of doubtful places beside the map of a road that has two of them."""

from contextlib import contextmanager
from types import SimpleNamespace

from lanewright.algorithms.survey_input import read_corrections
from lanewright.core.common.features import DRIVING_LINES, ROAD_EDGES
from lanewright.desktop.review.corrections_layer import corrections_layers
from lanewright.desktop.review.doubt_dock import DoubtDock
from lanewright.processing_provider.call import QgisSource
from lanewright.processing_provider.results.road_maps import road_maps
from qgis.core import QgsProject, QgsRectangle, QgsSettings
from qgis.gui import QgsMapCanvas, QgsMessageBar
from qgis.PyQt.QtWidgets import QMainWindow
from road_map_layers import EAST, NORTH, added


@contextmanager
def doubtful_window():
    """A dock beside a map of a road with two doubtful places; of the first, an edge was bridged and a lane inferred."""
    QgsSettings().remove("lanewright/doubts")
    project = QgsProject.instance()
    project.clear()
    piece = lambda at, **row: (f"LINESTRING Z ({at} 0 100, {at + 8} 0 100)", dict(road=0, station_m=float(at), length_m=8.0, **row))  # noqa: E731
    added(project, "ROAD_EDGES", ROAD_EDGES, piece(80, side="left", status="bridged"), piece(10, side="left", status="bridged"),
          piece(40, side="left", status="measured"), piece(60, side="left", status="accepted", agree_cm=9.0))
    added(project, "DRIVING_LINES", DRIVING_LINES, piece(14, lane=1, direction=1, status="inferred", offset_m=1.5))
    main = QMainWindow()
    canvas, bar = QgsMapCanvas(main), QgsMessageBar(main)
    canvas.resize(400, 300)
    canvas.setDestinationCrs(project.mapLayers()[next(iter(project.mapLayers()))].crs())
    canvas.setExtent(QgsRectangle(EAST - 10, NORTH - 40, EAST + 110, NORTH + 50))
    iface = SimpleNamespace(mainWindow=lambda: main, mapCanvas=lambda: canvas, messageBar=lambda: bar, removeDockWidget=main.removeDockWidget,
                            addTabifiedDockWidget=lambda area, dock, beside, in_front: main.addDockWidget(area, dock))
    dock = DoubtDock(iface)
    main.show()
    yield dock
    dock.remove()
    project.clear()


def go_to_first(window, path):
    window.ask_for_file = lambda: str(path)
    window.go(road_maps(QgsProject.instance())[0])


def corrections():
    layer, = corrections_layers(QgsProject.instance())
    return [(row["action"], row["target"], row["road"], row["station_m"], geometry.length)
            for geometry, row in read_corrections(QgisSource(layer, "Corrections"))]
