"""The legend of a sheet: the classes that a road map has, in as many columns as fit; and the letters of all that is printed."""

from __future__ import annotations

from qgis.core import (
    Qgis,
    QgsExpressionContextUtils,
    QgsLayerTreeModelLegendNode,
    QgsLayoutItemLegend,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsLayoutUtils,
    QgsLegendRenderer,
    QgsLegendSettings,
    QgsLegendStyle,
    QgsMapLayer,
    QgsMapLayerLegendUtils,
    QgsPrintLayout,
    QgsRenderContext,
    QgsSymbolLegendNode,
    QgsTextFormat,
)
from qgis.PyQt.QtCore import QRectF, QSizeF
from qgis.PyQt.QtGui import QColor, QFont

TITLES, ENTRY = 12.0, 6.5        # mm: titles and margins of the legend, and each entry below a title
SIZES = ((8.0, 7.0, 4.0), (7.0, 6.0, 3.0), (6.0, 5.0, 2.0))  # letters of titles and entries, points, and symbols, mm: the first that fits
FONT = "DejaVu Sans"
DPI = 300.0                      # of the measurement; any would do
STYLES = (QgsLegendStyle.Style.Title, QgsLegendStyle.Style.Group, QgsLegendStyle.Style.Subgroup, QgsLegendStyle.Style.Symbol,
          QgsLegendStyle.Style.SymbolLabel)


def text_format(size: float) -> QgsTextFormat:
    """The letters of a layout, in points."""
    style = QgsTextFormat()
    style.setFont(QFont(FONT))
    style.setSize(size)
    return style


def as_it_stands(text: str) -> str:
    """A text of others, such as the name of a survey or a CRS, for a layout, which would evaluate expressions between [% and %] in it."""
    return text.replace("[%", "[% '[%' %]")


def classes_by_layer(layers: list[QgsMapLayer]) -> dict[QgsMapLayer, set[str]]:
    """The layers of which a legend says something, lines, points and areas, with the keys of those classes of their style that some feature has."""
    return {layer: _classes_of(layer) for layer in layers
            if layer.type() == Qgis.LayerType.Vector and layer.isSpatial() and layer.featureCount() != 0}


def _classes_of(layer):
    context = QgsRenderContext()
    context.expressionContext().appendScopes(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    renderer = layer.renderer().clone()
    renderer.startRender(context, layer.fields())
    keys: set[str] = set()
    for feature in layer.getFeatures():
        context.expressionContext().setFeature(feature)  # classes may be distinguished by an expression
        keys |= set(renderer.legendKeysForFeature(feature, context))
    renderer.stopRender(context)
    return keys


def legend_height(classes: dict[QgsMapLayer, set[str]]) -> float:
    """mm that the longest layer takes in the legend, with the classes there are."""
    return TITLES + ENTRY * max([1, *map(len, classes.values())])


def add_legend(layout: QgsPrintLayout, classes: dict[QgsMapLayer, set[str]], room: QRectF, page: int = 0) -> QgsLayoutItemLegend | None:
    """A legend in the upper left corner of `room` (mm) of a page; None, and nothing is added, where it does not fit.

    It lists the classes that there are, of `classes_by_layer`. QGIS's own filter by the map is not used for that: it looks through the layers
    in the background and has timers, which may outlive the layers, and how large the legend becomes is not known before.
    """
    legend = QgsLayoutItemLegend(layout)
    layout.addLayoutItem(legend)
    legend.attemptMove(QgsLayoutPoint(room.x(), room.y(), Qgis.LayoutUnit.Millimeters), page=page)
    legend.setAutoUpdateModel(False)
    root = legend.model().rootGroup()
    root.clear()
    for layer, keys in classes.items():
        node = root.addLayer(layer)
        _leave_out_empty_classes(legend, node, keys)
        _print_as_it_stands(legend, node, layer)
    legend.setResizeToContents(False)  # by its own measure the last letters would stand beside its ground
    legend.setSplitLayer(False)
    legend.setEqualColumnWidth(False)
    legend.setBackgroundColor(QColor(186, 191, 196))  # white paint is seen on it, and letters can be read
    legend.setColumnSpace(3)
    for title, entry, symbol in SIZES:
        legend.setSymbolHeight(symbol)
        for style in STYLES:
            legend_style = legend.style(style)
            legend_style.setTextFormat(text_format(entry if style == QgsLegendStyle.Style.SymbolLabel else title))
            legend.setStyle(style, legend_style)
        for columns in range(1, max(1, len(classes)) + 1):
            legend.setColumnCount(columns)
            size = _size(layout, legend)
            if size.height() <= room.height() and size.width() <= room.width():
                legend.attemptResize(QgsLayoutSize(size, Qgis.LayoutUnit.Millimeters))
                return legend
    layout.removeLayoutItem(legend)
    return None


def _size(layout, legend):
    """mm that a legend will take; it knows by itself only once it is drawn."""
    settings = QgsLegendSettings()
    for style in STYLES:
        settings.setStyle(style, legend.style(style))
    settings.setColumnCount(legend.columnCount())
    settings.setColumnSpace(legend.columnSpace())
    settings.setBoxSpace(legend.boxSpace())
    settings.setSymbolSize(QSizeF(legend.symbolWidth(), legend.symbolHeight()))
    return QgsLegendRenderer(legend.model(), settings).minimumSize(QgsLayoutUtils.createRenderContextForLayout(layout, None, DPI))


def _leave_out_empty_classes(legend, node, classes):
    key = QgsLayerTreeModelLegendNode.LegendNodeRoles.RuleKeyRole
    order = [row for row, entry in enumerate(legend.model().layerOriginalLegendNodes(node)) if str(entry.data(key)) in classes]
    if order:
        QgsMapLayerLegendUtils.setLegendNodeOrder(node, order)
        legend.model().refreshLayerLegend(node)


def _print_as_it_stands(legend, node, layer):
    """Let no expression in the names of a layer and of its classes be evaluated."""
    if "[%" in layer.name():
        node.setCustomProperty("legend/title-label", as_it_stands(layer.name()))
    for row, entry in enumerate(legend.model().layerOriginalLegendNodes(node)):
        label = entry.symbolLabel() if isinstance(entry, QgsSymbolLegendNode) else ""
        if "[%" in label:
            QgsMapLayerLegendUtils.setLegendNodeUserLabel(node, row, as_it_stands(label))
            legend.model().refreshLayerLegend(node)
