"""Names, order, group and styles of the layers a run puts into the project or into files."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCategorizedSymbolRenderer,
    QgsContrastEnhancement,
    QgsDataSourceUri,
    QgsFillSymbolLayer,
    QgsGraduatedSymbolRenderer,
    QgsMapLayerStyle,
    QgsProcessingLayerPostProcessorInterface,
    QgsProperty,
    QgsProviderConnectionException,
    QgsProviderRegistry,
    QgsRasterLayer,
    QgsRasterMinMaxOrigin,
    QgsRenderContext,
    QgsRendererCategory,
    QgsRendererRange,
    QgsRuleBasedRenderer,
    QgsSingleBandGrayRenderer,
    QgsSymbol,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QCoreApplication, QEventLoop
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtXml import QDomDocument

from ..algorithms.destinations import destination_path
from ..core.common.features import COLOUR
from .results.attributes import STYLES, WORDS, explain_attributes
from .results.road_maps import GROUP, describe_origin, place_layer
from .texts import tr

# Output name -> (style, place in the group: small is drawn below)
LOOKS = json.loads((STYLES / "looks.json").read_text(encoding="utf-8"))
TABLES = 5  # tables lie below what is drawn


class Styler(QgsProcessingLayerPostProcessorInterface):
    """Applies a QML once QGIS has loaded the layer (never in qgis_process, which loads none)."""

    _kept = []  # QGIS keeps no reference, and Python would collect it before the layer is loaded

    def __init__(self, qml, schema=(), output="", run=None):
        super().__init__()
        self.qml, self.schema, self.output, self.run = str(qml), schema, output, run
        Styler._kept = Styler._kept[-50:] + [self]

    def postProcessLayer(self, layer, context, feedback):
        apply_style(layer, self.qml, self.schema, self.output)
        if isinstance(layer, QgsVectorLayer):
            add_ready_styles(layer, self.qml)
        if self.run is not None and context.project() is not None:
            place_layer(layer, context.project(), self.output, self.run)
        layer.triggerRepaint()
        # QGIS loads all layers of a run in one go: between two of them the window is drawn
        QCoreApplication.processEvents(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)


def apply_style(layer, qml, schema=(), output=""):
    """Give the layer of a result the look of a QML file, its fields names and formats, an image its stretch."""
    if Path(qml).exists():
        load_look(layer, qml)
    if isinstance(layer, QgsVectorLayer):
        explain_attributes(layer, output, schema)
        if layer.fields().indexOf(COLOUR.name) >= 0 and layer.renderer() is not None:
            _paint_yellow(layer.renderer().symbols(QgsRenderContext()))
    if isinstance(layer, QgsRasterLayer) and isinstance(layer.renderer(), QgsSingleBandGrayRenderer):
        # Intensities have no common scale: every image is stretched to its own values
        layer.setContrastEnhancement(
            QgsContrastEnhancement.ContrastEnhancementAlgorithm.StretchToMinimumMaximum,
            QgsRasterMinMaxOrigin.Limits.CumulativeCut)
        stretch = layer.renderer().contrastEnhancement()
        if stretch.maximumValue() - stretch.minimumValue() > 100:  # in the legend six decimals say nothing
            stretch.setMinimumValue(round(stretch.minimumValue()))
            stretch.setMaximumValue(round(stretch.maximumValue()))
            layer.rendererChanged.emit()


YELLOW_PAINT = "#e8a800"


def _paint_yellow(symbols):
    """Let the white of symbols be yellow where the paint of a feature is."""
    for drawn in (drawn for symbol in symbols for drawn in symbol.symbolLayers()):
        if drawn.subSymbol() is not None:
            _paint_yellow([drawn.subSymbol()])
        if drawn.color() == QColor("white"):
            fill = isinstance(drawn, QgsFillSymbolLayer)
            drawn.setDataDefinedProperty(drawn.Property.FillColor if fill else drawn.Property.StrokeColor, QgsProperty.fromExpression(
                f"if(\"{COLOUR.name}\" = 'yellow', '{YELLOW_PAINT}', 'white')"))


def style_on_load(name, dest, title, context, schema=(), run=None):
    """Name, group and style the layer `dest` of a Run where QGIS is going to load it."""
    if not dest or not context.willLoadLayerOnCompletion(dest):
        return
    details = context.layerToLoadOnCompletionDetails(dest)
    details.name, details.forceName, details.groupName = title, True, run.group if run else GROUP
    look, order = LOOKS.get(name, (None, TABLES))
    details.layerSortKey = order
    qml = STYLES / f"{look}.qml"
    details.setPostProcessor(Styler(qml, schema, name, run))


# Looks of a layer: the road plan at first; by class, by status, by confidence and by uncertainty to switch to.

STATUS = (("measured", "#1a9850"), ("bridged", "#fdae61"), ("inferred", "#d73027"), ("occluded", "#7b3294"), ("grown", "#b8860b"),
          ("accepted", "#4393c3"), ("drawn", "#2166ac"))
RANGES = {"confidence": [(low, high, colour, f"{low:g} – {high:g}") for low, high, colour in (
              (0.0, 0.5, "#d73027"), (0.5, 0.8, "#fdae61"), (0.8, 1.0, "#1a9850"))],
          "sigma_m": [(low, high, colour, f"{100 * low:g} – {100 * high:g} cm" if high < 100 else f"> {100 * low:g} cm") for low, high, colour in (
              (0.0, 0.02, "#1a9850"), (0.02, 0.05, "#a6d96a"), (0.05, 0.15, "#fdae61"), (0.15, 100.0, "#d73027"))]}   # m, one sigma
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
    """Further styles beside that of a QML file, which stays in force: by class where the folder by_class has one, and by the layer's fields."""
    names = {field.name() for field in layer.fields()}
    looks = (("status", tr("By status"), _by_status), ("confidence", tr("By confidence"), _by_ranges), ("sigma_m", tr("By uncertainty"), _by_ranges))
    further = [(title, partial(renderer, layer, field)) for field, title, renderer in looks if field in names]
    by_class = Path(qml).parent / "by_class" / Path(qml).name
    manager = layer.styleManager()
    if not further and not by_class.exists() or len(manager.styles()) > 1 or not layer.isSpatial():
        return
    in_force = tr("Road plan") if by_class.exists() else tr("By class")
    manager.renameStyle(manager.currentStyle(), in_force)
    other = layer.clone()   # the layer itself would be drawn and listed anew with every style
    if by_class.exists():
        other.setScaleBasedVisibility(False)
        other.setLabelsEnabled(False)
        load_look(other, by_class)
        _keep_style(manager, tr("By class"), other)
    for name, renderer in further:
        other.setRenderer(renderer())
        _keep_style(manager, name, other)


def _keep_style(manager, name, layer):
    """Add the style of another layer under a name."""
    style = QgsMapLayerStyle()
    style.readFromLayer(layer)
    manager.addStyle(name, style)


def _by_status(layer, field):
    statuses = layer.uniqueValues(layer.fields().lookupField(field))
    return QgsCategorizedSymbolRenderer(field, [QgsRendererCategory(value, _symbol(layer, colour), WORDS[field][value])
                                                for value, colour in STATUS if value in statuses or not statuses])


def _by_ranges(layer, field):
    return QgsGraduatedSymbolRenderer(field, [QgsRendererRange(low, high, _symbol(layer, colour), title)
                                              for low, high, colour, title in RANGES[field]])


def _symbol(layer, colour):
    symbol = QgsSymbol.defaultSymbol(layer.geometryType())
    symbol.setColor(QColor(colour))
    if layer.geometryType() == Qgis.GeometryType.Line:
        symbol.setWidth(LINE_WIDTH)
    return symbol


# Styles that travel with a result, so that a file made without a window opens styled anywhere.

NAME = "default"
POSTGIS = "postgres://"


def embed_style(name, dest, title, schema=(), provenance=None):
    """Give the result `dest` of the output `name` its style, and the note of where it comes from: in the database, or beside the raster.

    Other formats have no room for one. A style that cannot be kept costs a look, not the result, so nothing is raised.
    """
    path = destination_path(dest)
    look, _ = LOOKS.get(name, (None, None))
    qml = STYLES / f"{look}.qml"
    if dest.startswith(POSTGIS):
        _in_the_database(QgsVectorLayer(dest.removeprefix(POSTGIS), title, "postgres"), title, qml, schema, name, provenance)
    if path is None or look is None or not qml.exists():
        return
    if path.suffix.lower() in (".tif", ".tiff") and (layer := QgsRasterLayer(str(path), path.stem)).isValid():
        apply_style(layer, qml)
        layer.saveNamedStyle(str(path.with_suffix(".qml")))  # QGIS looks for it under this name
    elif path.suffix.lower() == ".gpkg":
        _in_the_database(QgsVectorLayer(_layer_uri(dest, path), title, "ogr"), title, qml, schema, name, provenance)


def _in_the_database(layer, title, qml, schema, output, provenance):
    if not layer.isValid():
        return
    if provenance is not None and layer.providerType() == "postgres":
        _comment_on_table(layer, "\n".join(provenance.history(output)))
    elif provenance is not None:
        describe_origin(layer, provenance, output)
        layer.saveDefaultMetadata()  # into the package
    apply_style(layer, qml, schema, output)
    # The style of an earlier run into the same table would win
    count, ids, names, _, _ = layer.listStylesInDatabase()
    for number in range(max(count, 0)):
        if names[number] == NAME:
            layer.deleteStyleFromDatabase(ids[number])
    save = getattr(layer, "saveStyleToDatabaseV2", None) or layer.saveStyleToDatabase
    save(NAME, title, True, "")


def _comment_on_table(layer, text):
    """What PostgreSQL keeps of a table, and QGIS shows as its abstract. QGIS's own way makes a table of its own in every schema."""
    uri = QgsDataSourceUri(layer.source())
    name, quoted = uri.quotedTablename(), text.replace("'", "''")
    try:
        connection = QgsProviderRegistry.instance().providerMetadata("postgres").createConnection(uri.connectionInfo(True), {})
        connection.executeSql(f"COMMENT ON TABLE {name} IS '{quoted}'")
    except QgsProviderConnectionException as problem:
        QgsApplication.messageLog().logMessage(str(problem), "Lanewright", Qgis.MessageLevel.Warning, False)


def _layer_uri(dest, path):
    """The layer of a destination as the OGR provider opens it."""
    if dest.startswith("ogr:"):
        return f"{path}|layername={QgsDataSourceUri(dest.removeprefix('ogr:')).table()}"
    return dest if "|" in dest else f"{path}|layername={Path(path).stem}"
