"""Draws a road map GeoPackage as a map: draw_map.py PACKAGE IMAGE PICTURE.

The map has the intensity image below, edges, markings and driving lines above, a title, a
legend and a scale bar. Every layer is drawn in the style it carries.
"""

import sys
from pathlib import Path

from plugin_package import load

# from above
LAYERS = (("driving_lines", "Driving lines"), ("road_edges", "Road edges"), ("marking_lines", "Marking lines"),
          ("markings", "Markings"), ("road_surface", "Road surface"))
IMAGE_TITLE = "Intensity image"


def styled_layers(package, image):
    """The layers of the package from above, in the styles they carry."""
    from qgis.core import QgsRasterLayer, QgsVectorLayer

    layers = []
    for table, title in LAYERS:
        layer = QgsVectorLayer(f"{package}|layername={table}", title, "ogr")
        if not layer.isValid() or not layer.featureCount():
            sys.exit(f"Layer {table} of {package} is missing or empty.")
        if not layer.loadDefaultStyle()[1]:
            sys.exit(f"Layer {table} of {package} has no style of its own.")
        layers.append(layer)
    raster = QgsRasterLayer(str(image), IMAGE_TITLE)
    return [*layers, raster]


def draw(layers, picture, title):
    """Lay the map out and save it."""
    from osgeo import gdal
    from qgis.core import QgsLayoutExporter, QgsProject
    from qgis.PyQt.QtCore import QCoreApplication

    from lanewright.desktop.map_layout import road_map_layout

    project = QgsProject.instance()
    project.setCrs(layers[0].crs())
    for layer in layers:
        project.addMapLayer(layer)
    layout = road_map_layout(project, layers, title)
    QCoreApplication.processEvents()
    # QGIS tries to write the map's place into the picture, which a PNG cannot hold
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    settings = QgsLayoutExporter.ImageExportSettings()
    settings.dpi = 150
    settings.generateWorldFile = False
    result = QgsLayoutExporter(layout).exportToImage(str(picture), settings)
    gdal.PopErrorHandler()
    if result != QgsLayoutExporter.ExportResult.Success:
        sys.exit(f"The map could not be written to {picture}.")


def main():
    package, image, picture = map(Path, sys.argv[1:4])
    from qgis.core import QgsApplication

    load()
    application = QgsApplication([], False)
    application.initQgis()
    try:
        draw(styled_layers(package, image), picture, "Lanewright: road map of the sample survey")
    finally:
        from qgis.core import QgsProject

        QgsProject.instance().clear()
        application.exitQgis()


if __name__ == "__main__":
    main()
