"""Further looks of a layer to switch to: what was measured and what was not, and how sure it is."""

from __future__ import annotations

from qgis.core import Qgis, QgsCategorizedSymbolRenderer, QgsGraduatedSymbolRenderer, QgsRendererCategory, QgsRendererRange, QgsSymbol, QgsVectorLayer
from qgis.PyQt.QtGui import QColor

from ..texts import tr
from .attributes import WORDS

STATUS = (("measured", "#1a9850"), ("bridged", "#fdae61"), ("inferred", "#d73027"), ("occluded", "#7b3294"), ("grown", "#b8860b"),
          ("accepted", "#4393c3"), ("drawn", "#2166ac"))
CONFIDENCE = ((0.0, 0.5, "#d73027"), (0.5, 0.8, "#fdae61"), (0.8, 1.0, "#1a9850"))
LINE_WIDTH = 0.7  # mm


def add_ready_styles(layer: QgsVectorLayer) -> None:
    """Styles "by status" and "by confidence" beside the one that a layer has, which stays in force; only for fields it has."""
    names = {field.name() for field in layer.fields()}
    looks = (("status", tr("By status"), _by_status), ("confidence", tr("By confidence"), _by_confidence))
    further = [(title, renderer) for field, title, renderer in looks if field in names]
    manager = layer.styleManager()
    if not further or len(manager.styles()) > 1 or not layer.isSpatial():
        return
    class_style = tr("By class")
    manager.renameStyle(manager.currentStyle(), class_style)
    for name, renderer in further:
        manager.addStyleFromLayer(name)
        manager.setCurrentStyle(name)
        layer.setRenderer(renderer(layer))
    manager.setCurrentStyle(class_style)


def _by_status(layer):
    statuses = layer.uniqueValues(layer.fields().lookupField("status"))
    return QgsCategorizedSymbolRenderer("status", [QgsRendererCategory(value, _symbol(layer, colour), WORDS["status"][value])
                                                   for value, colour in STATUS if value in statuses or not statuses])


def _by_confidence(layer):
    return QgsGraduatedSymbolRenderer("confidence", [QgsRendererRange(low, high, _symbol(layer, colour), f"{low:g} – {high:g}")
                                                     for low, high, colour in CONFIDENCE])


def _symbol(layer, colour):
    symbol = QgsSymbol.defaultSymbol(layer.geometryType())
    symbol.setColor(QColor(colour))
    if layer.geometryType() == Qgis.GeometryType.Line:
        symbol.setWidth(LINE_WIDTH)
    return symbol
