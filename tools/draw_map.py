"""Embeds the layer styles in a road map GeoPackage and draws it as a map: draw_map.py PACKAGE IMAGE PICTURE.

The map has the intensity image below, edges, markings and driving lines above, a title, a
legend and a scale bar.
"""

import sys
from pathlib import Path

from plugin_package import ROOT

# from above
LAYERS = (("driving_lines", "Driving lines"), ("road_edges", "Road edges"), ("marking_lines", "Marking lines"),
          ("markings", "Markings"), ("road_surface", "Road surface"))
IMAGE_TITLE = "Intensity image"
PAGE_WIDTH, HEADING, LEGEND = 400.0, 12.0, 34.0  # mm
MARGIN = 4.0  # m of ground around the road


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
    """Lay the map out with the road along the page, the legend below it, and save it."""
    from qgis.core import QgsPrintLayout, QgsProject, QgsLayoutExporter
    from osgeo import gdal
    from qgis.PyQt.QtCore import QCoreApplication

    project = QgsProject.instance()
    project.setCrs(layers[0].crs())
    for layer in layers:
        project.addMapLayer(layer)
    centre, angle, length, width = lie_of_the_road(layers[-2])
    # As tall as the road needs, between a strip and a square
    map_height = PAGE_WIDTH * min(max((width + 2 * MARGIN) / (length + 2 * MARGIN), 0.25), 0.8)
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    page(layout, map_height + HEADING + LEGEND)
    chart = add_map(layout, layers, centre, angle, length, map_height)
    add_heading(layout, title)
    add_legend(layout, chart, HEADING + map_height)
    add_scale_bar(layout, chart, HEADING + map_height)
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


def lie_of_the_road(surface):
    """Centre, angle to the page (degrees), length and width of the rectangle around the road surface."""
    from qgis.core import QgsGeometry

    whole = QgsGeometry.unaryUnion([feature.geometry() for feature in surface.getFeatures()])
    box, _, angle, width, height = whole.orientedMinimumBoundingBox()
    if height > width:
        width, height, angle = height, width, angle - 90.0
    # Angles are clockwise from north, of the box's shorter or longer side alike: bring them near zero
    return box.centroid().asPoint(), (angle + 90.0) % 180.0 - 90.0, width, height


def page(layout, height):
    from qgis.core import QgsLayoutSize, Qgis

    layout.pageCollection().page(0).setPageSize(QgsLayoutSize(PAGE_WIDTH, height, Qgis.LayoutUnit.Millimeters))


def place(layout, item, x, y, width=None, height=None):
    from qgis.core import QgsLayoutPoint, QgsLayoutSize, Qgis

    layout.addLayoutItem(item)
    item.attemptMove(QgsLayoutPoint(x, y, Qgis.LayoutUnit.Millimeters))
    if width:
        item.attemptResize(QgsLayoutSize(width, height, Qgis.LayoutUnit.Millimeters))


def add_map(layout, layers, centre, angle, length, height):
    from qgis.core import QgsLayoutItemMap, QgsRectangle
    from qgis.PyQt.QtGui import QColor

    chart = QgsLayoutItemMap(layout)
    place(layout, chart, 0, HEADING, PAGE_WIDTH, height)
    chart.setLayers(layers)
    span = length + 2 * MARGIN
    chart.zoomToExtent(QgsRectangle.fromCenterAndSize(centre, span, span * height / PAGE_WIDTH))
    chart.setMapRotation(-angle)
    chart.setBackgroundColor(QColor(28, 28, 30))
    return chart


def add_heading(layout, title):
    from qgis.core import QgsLayoutItemLabel, QgsTextFormat
    from qgis.PyQt.QtGui import QFont

    heading = QgsLayoutItemLabel(layout)
    heading.setText(title)
    style = QgsTextFormat()
    style.setFont(QFont("DejaVu Sans"))
    style.setSize(15)
    heading.setTextFormat(style)
    place(layout, heading, 5, 3, PAGE_WIDTH - 10, HEADING - 3)


def add_legend(layout, chart, top):
    from qgis.core import QgsLayoutItemLegend

    legend = QgsLayoutItemLegend(layout)
    legend.setLinkedMap(chart)
    place(layout, legend, 3, top + 2)
    legend.setAutoUpdateModel(False)
    root = legend.model().rootGroup()
    for node in root.findLayers():
        if node.name() == IMAGE_TITLE:
            root.removeChildNode(node)
    legend.setColumnCount(5)
    legend.setSplitLayer(False)
    legend.setEqualColumnWidth(True)
    legend.setColumnSpace(4)
    legend.adjustBoxSize()


def add_scale_bar(layout, chart, bottom):
    """In the lower right corner of the map."""
    from qgis.core import QgsLayoutItemScaleBar, Qgis
    from qgis.PyQt.QtGui import QColor

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
    place(layout, bar, PAGE_WIDTH - bar.rect().width() - 4, bottom - bar.rect().height() - 4)


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
