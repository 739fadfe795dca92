"""A print layout of a road map: intensity image below, lines above, title, legend, scale bar and north arrow."""

from qgis.core import (
    Qgis,
    QgsExpressionContextUtils,
    QgsGeometry,
    QgsLayoutItemLabel,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsPrintLayout,
    QgsRectangle,
    QgsRenderContext,
    QgsTextFormat,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor, QFont

PAGE_WIDTH, HEADING = 400.0, 12.0  # mm
LEGEND, ENTRY = 14.0, 6.6  # mm: titles and margins, each entry below a title
MARGIN = 4.0  # m of ground around the road
ARROW = 16.0  # mm
NORTH_ARROW = ":/images/north_arrows/layout_default_north_arrow.svg"  # of QGIS itself


def road_map_layout(project, layers, title):
    """A layout with the road along the page.

    Parameters
    ----------
    project : QgsProject that will own the layout
    layers : its layers from above
    title : what stands over the map

    Returns
    -------
    QgsPrintLayout, not yet added to the project's layouts.
    """
    centre, angle, length, width = lie_of_the_road(layers)
    # As tall as the road needs, between a strip and a square
    map_height = PAGE_WIDTH * min(max((width + 2 * MARGIN) / (length + 2 * MARGIN), 0.25), 0.8)
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    layout.setName(title)
    page(layout, map_height + HEADING + legend_height(layers))
    chart = add_map(layout, layers, centre, angle, length, map_height)
    add_heading(layout, title, project.crs())
    add_legend(layout, chart, layers, HEADING + map_height)
    add_scale_bar(layout, chart, HEADING + map_height, length)
    add_north_arrow(layout, chart)
    return layout


def lie_of_the_road(layers):
    """Centre, angle to the page (degrees), length and width of the rectangle around the road.

    Of the road's surface where it is among the layers, or of whatever is drawn.
    """
    vectors = [layer for layer in layers if layer.type() == Qgis.LayerType.Vector and layer.isSpatial()]
    surfaces = [layer for layer in vectors if layer.geometryType() == Qgis.GeometryType.Polygon and "surface" in layer.source()]
    hulls = [feature.geometry().convexHull() for layer in surfaces or vectors for feature in layer.getFeatures()]
    whole = QgsGeometry.collectGeometry([hull for hull in hulls if not hull.isEmpty()])
    if whole.isEmpty():
        whole = QgsGeometry.fromRect(layers[-1].extent())
    box, _, angle, width, height = whole.orientedMinimumBoundingBox()
    if height > width:
        width, height, angle = height, width, angle - 90.0
    # Angles are clockwise from north, of the box's shorter or longer side alike: bring them near zero
    return box.centroid().asPoint(), (angle + 90.0) % 180.0 - 90.0, width, height


def legend_height(layers):
    """mm that the longest column of the legend takes, with the classes there are."""
    entries = [1]
    for layer in layers:
        if layer.type() == Qgis.LayerType.Vector and layer.isSpatial():
            context = QgsRenderContext()
            context.expressionContext().appendScopes(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
            renderer = layer.renderer().clone()
            renderer.startRender(context, layer.fields())
            entries.append(len(set().union(*(renderer.legendKeysForFeature(feature, context) for feature in layer.getFeatures()))))
            renderer.stopRender(context)
    return LEGEND + ENTRY * max(entries)


def page(layout, height):
    layout.pageCollection().page(0).setPageSize(QgsLayoutSize(PAGE_WIDTH, height, Qgis.LayoutUnit.Millimeters))


def place(layout, item, x, y, width=None, height=None):
    layout.addLayoutItem(item)
    item.attemptMove(QgsLayoutPoint(x, y, Qgis.LayoutUnit.Millimeters))
    if width:
        item.attemptResize(QgsLayoutSize(width, height, Qgis.LayoutUnit.Millimeters))


def add_map(layout, layers, centre, angle, length, height):
    chart = QgsLayoutItemMap(layout)
    place(layout, chart, 0, HEADING, PAGE_WIDTH, height)
    chart.setLayers(layers)
    span = length + 2 * MARGIN
    chart.zoomToExtent(QgsRectangle.fromCenterAndSize(centre, span, span * height / PAGE_WIDTH))
    chart.setMapRotation(-angle)
    chart.setBackgroundColor(QColor(28, 28, 30))
    return chart


def add_heading(layout, title, crs):
    """The title, and on the right the CRS of the map."""
    for text, size, side in ((title, 15, Qt.AlignmentFlag.AlignLeft), (crs.userFriendlyIdentifier(), 9, Qt.AlignmentFlag.AlignRight)):
        heading = QgsLayoutItemLabel(layout)
        heading.setText(text)
        heading.setHAlign(side)
        heading.setVAlign(Qt.AlignmentFlag.AlignVCenter)
        style = QgsTextFormat()
        style.setFont(QFont("DejaVu Sans"))
        style.setSize(size)
        heading.setTextFormat(style)
        place(layout, heading, 5, 1, PAGE_WIDTH - 10, HEADING - 2)


def add_legend(layout, chart, layers, top):
    legend = QgsLayoutItemLegend(layout)
    legend.setLinkedMap(chart)
    place(layout, legend, 3, top + 2)
    legend.setAutoUpdateModel(False)
    root = legend.model().rootGroup()
    root.clear()
    for layer in layers:
        if layer.type() == Qgis.LayerType.Vector:
            root.addLayer(layer)
    legend.setColumnCount(5)
    legend.setSplitLayer(False)
    legend.setEqualColumnWidth(True)
    legend.setColumnSpace(4)
    # Of all the classes there may be, those that are there
    legend.setLegendFilterByMapEnabled(True)
    legend.adjustBoxSize()


def add_scale_bar(layout, chart, bottom, length):
    """In the lower right corner of the map."""
    bar = QgsLayoutItemScaleBar(layout)
    bar.setStyle("Single Box")
    bar.setLinkedMap(chart)
    bar.setUnits(Qgis.DistanceUnit.Meters)
    bar.setUnitLabel("m")
    bar.setNumberOfSegments(4)
    bar.setNumberOfSegmentsLeft(0)
    # Four segments in an eighth to a quarter of the page
    least = length / 40
    bar.setUnitsPerSegment(next(step * 10**power for power in range(7) for step in (1, 2, 5) if step * 10**power >= least))
    bar.setBackgroundEnabled(True)
    bar.setBackgroundColor(QColor(255, 255, 255, 225))
    bar.update()
    place(layout, bar, PAGE_WIDTH - bar.rect().width() - 4, bottom - bar.rect().height() - 4)


def add_north_arrow(layout, chart):
    """In the upper right corner of the map, which is turned so that the road lies along the page."""
    arrow = QgsLayoutItemPicture(layout)
    arrow.setId("North")
    arrow.setPicturePath(NORTH_ARROW)
    arrow.setSvgFillColor(QColor(255, 255, 255))
    arrow.setSvgStrokeColor(QColor(255, 255, 255))
    arrow.setLinkedMap(chart)
    arrow.setNorthMode(QgsLayoutItemPicture.NorthMode.GridNorth)
    place(layout, arrow, PAGE_WIDTH - ARROW - 4, HEADING + 4, ARROW, ARROW)
