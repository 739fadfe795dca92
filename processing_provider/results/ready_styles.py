"""Looks of a layer: the road plan at first; by class, by status, by confidence and by uncertainty to switch to."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    Qgis,
    QgsCategorizedSymbolRenderer,
    QgsGraduatedSymbolRenderer,
    QgsRendererCategory,
    QgsRendererRange,
    QgsRuleBasedRenderer,
    QgsSymbol,
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtXml import QDomDocument

from ..texts import tr
from .attributes import WORDS

STATUS = (("measured", "#1a9850"), ("bridged", "#fdae61"), ("inferred", "#d73027"), ("occluded", "#7b3294"), ("grown", "#b8860b"),
          ("accepted", "#4393c3"), ("drawn", "#2166ac"))
CONFIDENCE = ((0.0, 0.5, "#d73027"), (0.5, 0.8, "#fdae61"), (0.8, 1.0, "#1a9850"))
UNCERTAINTY = ((0.0, 0.02, "#1a9850"), (0.02, 0.05, "#a6d96a"), (0.05, 0.15, "#fdae61"), (0.15, 100.0, "#d73027"))   # m, one sigma
LINE_WIDTH = 0.7  # mm


def load_look(layer, qml):
    """Give a layer the look of a QML file, with its legend in the user's language: the styles are written in English."""
    # loadNamedStyle would look into the layer's database first and bring yesterday's style back
    document = QDomDocument()
    document.setContent(Path(qml).read_text(encoding="utf-8"))
    layer.importNamedStyle(document)
    if not isinstance(layer, QgsVectorLayer):
        return
    renderer = layer.renderer()
    if isinstance(renderer, QgsCategorizedSymbolRenderer):
        for number, category in enumerate(renderer.categories()):
            renderer.updateCategoryLabel(number, tr(category.label()))
    elif isinstance(renderer, QgsRuleBasedRenderer):
        for rule in renderer.rootRule().descendants():
            rule.setLabel(tr(rule.label()))
    layer.rendererChanged.emit()  # a layer tree that shows the layer already reads its legend again


def add_ready_styles(layer: QgsVectorLayer, qml: str) -> None:
    """Further styles beside the one that a layer has, which stays in force: by class where that one is the road plan, and by fields it has.

    qml : file of the style in force; the folder `by_class` beside it holds the same layer by class
    """
    names = {field.name() for field in layer.fields()}
    looks = (("status", tr("By status"), _by_status), ("confidence", tr("By confidence"), _by_confidence),
             ("sigma_m", tr("By uncertainty"), _by_uncertainty))
    further = [(title, renderer) for field, title, renderer in looks if field in names]
    by_class = Path(qml).parent / "by_class" / Path(qml).name
    manager = layer.styleManager()
    if not further and not by_class.exists() or len(manager.styles()) > 1 or not layer.isSpatial():
        return
    in_force = tr("Road plan") if by_class.exists() else tr("By class")
    manager.renameStyle(manager.currentStyle(), in_force)
    if by_class.exists():
        manager.addStyleFromLayer(tr("By class"))
        manager.setCurrentStyle(tr("By class"))
        layer.setScaleBasedVisibility(False)
        layer.setLabelsEnabled(False)
        load_look(layer, by_class)
    for name, renderer in further:
        manager.addStyleFromLayer(name)
        manager.setCurrentStyle(name)
        layer.setRenderer(renderer(layer))
    manager.setCurrentStyle(in_force)


def _by_status(layer):
    statuses = layer.uniqueValues(layer.fields().lookupField("status"))
    return QgsCategorizedSymbolRenderer("status", [QgsRendererCategory(value, _symbol(layer, colour), WORDS["status"][value])
                                                   for value, colour in STATUS if value in statuses or not statuses])


def _by_confidence(layer):
    return QgsGraduatedSymbolRenderer("confidence", [QgsRendererRange(low, high, _symbol(layer, colour), f"{low:g} – {high:g}")
                                                     for low, high, colour in CONFIDENCE])


def _by_uncertainty(layer):
    return QgsGraduatedSymbolRenderer("sigma_m", [
        QgsRendererRange(low, high, _symbol(layer, colour), f"{100 * low:g} – {100 * high:g} cm" if high < 100 else f"> {100 * low:g} cm")
        for low, high, colour in UNCERTAINTY])


def _symbol(layer, colour):
    symbol = QgsSymbol.defaultSymbol(layer.geometryType())
    symbol.setColor(QColor(colour))
    if layer.geometryType() == Qgis.GeometryType.Line:
        symbol.setWidth(LINE_WIDTH)
    return symbol
