"""Embeds the layer styles in a road map GeoPackage and draws it as a map: draw_map.py PACKAGE IMAGE PICTURE.

The map has the intensity image below, edges, markings and driving lines above, a title, a
legend and a scale bar.
"""

import sys
from pathlib import Path

from plugin_package import ROOT

STYLES = ROOT / "resources" / "styles"
# from above
LAYERS = (("driving_lines", "Driving lines"), ("road_edges", "Road edges"), ("marking_lines", "Marking lines"),
          ("markings", "Markings"), ("road_surface", "Road surface"))


def styled_layers(package, image):
    """The layers of the package from above, styled, and the style saved with each."""
    from qgis.core import QgsRasterLayer, QgsVectorLayer

    layers = []
    for table, title in LAYERS:
        layer = QgsVectorLayer(f"{package}|layername={table}", title, "ogr")
        if not layer.isValid() or not layer.featureCount():
            sys.exit(f"Layer {table} of {package} is missing or empty.")
        _, loaded = layer.loadNamedStyle(str(STYLES / f"{table}.qml"))
        if not loaded:
            sys.exit(f"There is no style for {table} in {STYLES}.")
        save = getattr(layer, "saveStyleToDatabaseV2", None) or layer.saveStyleToDatabase
        save("default", "", True, "")
        layers.append(layer)
    raster = QgsRasterLayer(str(image), "Intensity image")
    raster.loadNamedStyle(str(STYLES / "intensity_image.qml"))
    raster.saveNamedStyle(str(Path(image).with_suffix(".qml")))  # QGIS looks for it beside the raster
    return [*layers, raster]


def draw(layers, picture, title):
    """Lay the map out on an A4 page and save it."""
    from qgis.core import (QgsLayoutExporter, QgsLayoutItemLabel, QgsLayoutItemLegend, QgsLayoutItemMap,
                           QgsLayoutItemScaleBar, QgsLayoutPoint, QgsLayoutSize, QgsPrintLayout, QgsProject, Qgis)
    from qgis.PyQt.QtGui import QColor, QFont

    project = QgsProject.instance()
    project.setCrs(layers[0].crs())
    for layer in layers:
        project.addMapLayer(layer)
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    millimetres = Qgis.LayoutUnit.Millimeters
    extent = layers[-2].extent()
    extent.grow(4.0)

    def place(item, x, y, width=None, height=None):
        layout.addLayoutItem(item)
        item.attemptMove(QgsLayoutPoint(x, y, millimetres))
        if width:
            item.attemptResize(QgsLayoutSize(width, height, millimetres))

    chart = QgsLayoutItemMap(layout)
    place(chart, 8, 20, 281, 182)
    chart.setLayers(layers)
    # The road's long side along the page's long side
    if extent.height() > extent.width():
        chart.setMapRotation(90)
        centre = extent.center()
        extent.setXMinimum(centre.x() - extent.height() / 2)
        extent.setXMaximum(centre.x() + extent.height() / 2)
    chart.zoomToExtent(extent)
    chart.setBackgroundColor(QColor(28, 28, 30))
    chart.setFrameEnabled(True)

    heading = QgsLayoutItemLabel(layout)
    heading.setText(title)
    heading.setFont(QFont("DejaVu Sans", 16))
    place(heading, 8, 7, 281, 10)

    legend = QgsLayoutItemLegend(layout)
    legend.setLinkedMap(chart)
    legend.setBackgroundColor(QColor(255, 255, 255, 225))
    place(legend, 11, 23)
    legend.setAutoUpdateModel(True)
    legend.adjustBoxSize()

    bar = QgsLayoutItemScaleBar(layout)
    bar.setStyle("Single Box")
    bar.setLinkedMap(chart)
    bar.setUnits(Qgis.DistanceUnit.Meters)
    bar.setUnitLabel("m")
    bar.setNumberOfSegments(4)
    bar.setNumberOfSegmentsLeft(0)
    bar.setUnitsPerSegment(5)
    bar.setBackgroundEnabled(True)
    bar.setBackgroundColor(QColor(255, 255, 255, 225))
    bar.update()
    place(bar, 200, 184)

    settings = QgsLayoutExporter.ImageExportSettings()
    settings.dpi = 150
    result = QgsLayoutExporter(layout).exportToImage(str(picture), settings)
    if result != QgsLayoutExporter.ExportResult.Success:
        sys.exit(f"The map could not be written to {picture}.")


def main():
    package, image, picture = map(Path, sys.argv[1:4])
    from qgis.core import QgsApplication

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
