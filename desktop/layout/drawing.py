"""A drawing in millimetres, as a picture of a layout: lines, areas and texts that nothing evaluates; and the legend of a sheet."""

from __future__ import annotations

import base64
import math
from html import escape

import numpy as np
import shapely
from qgis.core import (
    Qgis,
    QgsExpressionContextUtils,
    QgsFillSymbol,
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
    QgsSimpleLineSymbolLayer,
    QgsSymbolLegendNode,
    QgsTextFormat,
)
from qgis.PyQt.QtCore import QRectF, QSizeF
from qgis.PyQt.QtGui import QColor, QFont, QFontMetricsF

LETTER = 0.353   # mm of a point
FINEST = 0.01    # mm by which a line may be drawn beside its places
GREY, DARK = "#8a8a8a", "#202020"


class Drawing:
    """Lines and texts on a rectangle of so many millimetres, y downwards."""

    def __init__(self, width: float, height: float):
        self.width, self.height = width, height
        self._parts: list[str] = []
        self._taken: list[QRectF] = []   # where texts stand

    def line(self, places: np.ndarray | list, colour: str = DARK, width: float = 0.2, dash: str = "", fill: str = "none",
             closed: bool = False) -> None:
        """A polyline through (N, 2) places; what is not finite interrupts it."""
        places = np.asarray(places, float)
        for part in np.split(places, np.flatnonzero(~np.isfinite(places).all(axis=1))):
            part = part[np.isfinite(part).all(axis=1)]
            if len(part) > 1:
                if not closed:
                    part = shapely.get_coordinates(shapely.simplify(shapely.linestrings(part), FINEST))
                path = "M" + "L".join(f"{x:.3f} {y:.3f}" for x, y in part) + "Z" * closed
                dashed = f' stroke-dasharray="{dash}"' if dash else ""
                faint = f' fill-opacity="{int(fill[7:], 16) / 255:.2f}"' if len(fill) == 9 else ""
                self._parts.append(f'<path d="{path}" fill="{fill[:7]}"{faint} stroke="{colour}" stroke-width="{width}"{dashed} '
                                   'stroke-linejoin="round"/>')

    def text(self, x: float, y: float, text: str, size: float = 7.0, anchor: str = "middle", turned: float = 0.0, colour: str = DARK,
             boxed: bool = False, yields: bool = False) -> bool:
        """A text whose middle line passes through a place, `turned` clockwise by degrees; False where it `yields` to texts already there."""
        wide, high = text_width(text, size), size * LETTER
        shift = {"start": wide / 2, "middle": 0.0, "end": -wide / 2}[anchor]
        angle = math.radians(turned)
        cx, cy = x + shift * math.cos(angle), y + shift * math.sin(angle)
        w = abs(wide * math.cos(angle)) + abs(high * math.sin(angle))
        h = abs(wide * math.sin(angle)) + abs(high * math.cos(angle))
        room = QRectF(cx - w / 2 - 0.4, cy - h / 2 - 0.3, w + 0.8, h + 0.6)
        if yields and (any(room.intersects(other) for other in self._taken) or not QRectF(0, 0, self.width, self.height).contains(room)):
            return False
        self._taken.append(room)
        turn = f' transform="rotate({turned:.2f} {cx:.3f} {cy:.3f})"' if turned else ""
        if boxed:
            self._parts.append(f'<rect x="{cx - wide / 2 - 0.5:.3f}" y="{cy - high * 0.62:.3f}" width="{wide + 1:.3f}" height="{high * 1.24:.3f}" '
                               f'fill="#ffffff" fill-opacity="0.85"{turn}/>')
        self._parts.append(f'<text x="{cx:.3f}" y="{cy + 0.36 * high:.3f}" font-family="{FONT}" font-size="{high:.3f}" text-anchor="middle" '
                           f'fill="{colour}"{turn}>{escape(text)}</text>')
        return True

    def path(self) -> str:
        """As QGIS takes a picture that lies in no file."""
        text = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}mm" height="{self.height}mm" '
                f'viewBox="0 0 {self.width} {self.height}">{"".join(self._parts)}</svg>')
        return "base64:" + base64.b64encode(text.encode()).decode()


def text_width(text: str, size: float) -> float:
    """mm that a text takes, letters of `size` points."""
    font = QFont(FONT)
    font.setPixelSize(100)
    return QFontMetricsF(font).horizontalAdvance(text) / 100 * size * LETTER


def station_text(station: float) -> str:
    """0+125 for 125 m, as on plans."""
    whole, rest = divmod(round(abs(station), 2), 1000)
    sign = "-" if station < 0 else ""
    return f"{sign}{int(whole)}+{rest:03.0f}" if rest == round(rest) else f"{sign}{int(whole)}+{rest:06.2f}"


# The legend of a sheet: the classes that a road map has, in as many columns as fit; and the letters of all that is printed.

TITLES, ENTRY = 12.0, 6.5        # mm: titles and margins of the legend, and each entry below a title
SIZES = ((8.0, 7.0, 4.0), (7.0, 6.0, 3.0), (6.0, 5.0, 2.0))  # letters of titles and entries, points, and symbols, mm: the first that fits
FONT = "DejaVu Sans"
DPI = 300.0                      # of the measurement; any would do
ASPHALT, WHITE, GROUND = QColor("#8d9299"), 200, 3.0   # of the road plan; lightness of paint; mm of asphalt below a painted line
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
        _add_classes(legend, root.addLayer(layer), layer, keys)
    legend.setResizeToContents(False)  # by its own measure the last letters would stand beside its ground
    legend.setSplitLayer(False)
    legend.setEqualColumnWidth(False)
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


def _add_classes(legend, node, layer, keys):
    """List the classes with these keys; no expression in the names of a layer and of its classes is evaluated."""
    if "[%" in layer.name():
        node.setCustomProperty("legend/title-label", as_it_stands(layer.name()))
    key = QgsLayerTreeModelLegendNode.LegendNodeRoles.RuleKeyRole
    order = []
    for row, entry in enumerate(legend.model().layerOriginalLegendNodes(node)):
        if str(entry.data(key)) in keys:
            order.append(row)
        if isinstance(entry, QgsSymbolLegendNode):
            if "[%" in entry.symbolLabel():
                QgsMapLayerLegendUtils.setLegendNodeUserLabel(node, row, as_it_stands(entry.symbolLabel()))
            QgsMapLayerLegendUtils.setLegendNodeCustomSymbol(node, row, _on_asphalt(entry.symbol()))
    if order:
        QgsMapLayerLegendUtils.setLegendNodeOrder(node, order)
    legend.model().refreshLayerLegend(node)


def _on_asphalt(symbol):
    """The symbol of a class; that of white paint on the grey it lies on, for on white paper it would not be seen."""
    shown = symbol.clone()
    tones = [part.color().lightness() for part in shown.symbolLayers()]
    if max(tones) < WHITE or min(tones) < ASPHALT.lightness() - 10:
        return shown
    if symbol.type() == Qgis.SymbolType.Line:
        shown.insertSymbolLayer(0, QgsSimpleLineSymbolLayer(ASPHALT, GROUND))
        return shown
    return QgsFillSymbol.createSimple({"color": "white", "outline_color": ASPHALT.name(), "outline_width": "1"})
