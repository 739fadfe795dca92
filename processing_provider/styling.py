"""Names, order, group and styles of the layers a run puts into the project or into files, and how their rows read."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCategorizedSymbolRenderer,
    QgsContrastEnhancement,
    QgsDataSourceUri,
    QgsEditorWidgetSetup,
    QgsFillSymbolLayer,
    QgsGeometry,
    QgsGeometryGeneratorSymbolLayer,
    QgsGraduatedSymbolRenderer,
    QgsMapLayer,
    QgsMapLayerStyle,
    QgsPalLayerSettings,
    QgsProcessingLayerPostProcessorInterface,
    QgsProperty,
    QgsProviderConnectionException,
    QgsProviderRegistry,
    QgsRasterLayer,
    QgsRasterMinMaxOrigin,
    QgsRenderContext,
    QgsRendererCategory,
    QgsRendererRange,
    QgsRuleBasedLabeling,
    QgsRuleBasedRenderer,
    QgsSingleBandGrayRenderer,
    QgsSingleSymbolRenderer,
    QgsSymbol,
    QgsUnitTypes,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QCoreApplication, QEventLoop
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtXml import QDomDocument

from ..algorithms.algorithm import MAP_LAYERS
from ..algorithms.destinations import destination_path
from ..core.common.features import COLOUR, OTHER
from ..core.common.texts import language, vocabulary
from .results.road_maps import GROUP, describe_origin, output_of, place_layer
from .texts import retold, tr

STYLES = Path(__file__).resolve().parents[1] / "resources" / "styles"
# Decimals that mean something, what a feature is, in expressions of QGIS whose fields stand in quotes, and the colours of its values
DECIMALS, DECIMALS_OF, TITLES, STATUS, RANGES = json.loads((STYLES / "fields.json").read_text(encoding="utf-8")).values()
MOST_DECIMALS = 2  # of any other number
MARGIN, LETTER = 40, 8  # pixels of a column of the attribute table: beside its heading, and for each letter of it

# Field -> {value: words}; what is not among them is shown as it is
WORDS = {field: {value: tr(vocabulary().get(f"{field}.{value}") or vocabulary()[value]) for value in values.split()} for field, values in {
    "status": "measured bridged inferred occluded grown accepted drawn", "side": "left right", "part": "bottom top",
    "pattern": "solid dashed double-solid double-dashed solid-dashed dashed-solid", "use": "keep other", "source": "pair offset drawn",
    "turn": "left right", "action": "accept delete move draw take seen",
    "class": "edge lane centre zebra stop give_way zigzag arrow symbol hatch bicycle bus",
    "target": "edge marking lane surface warning", "outcome": "correct missed false excluded",
}.items()}
LINE_KINDS = {"edge": tr("Edge line"), "centre": tr("Centre line"), "lane": tr("Lane line")}
DIRECTIONS = {1: tr("along the road"), -1: tr("against the road"), 0: tr("not driven")}


def _in_words(field):
    """The value of a field in the user's language, also of a layer that was made in another."""
    words = DIRECTIONS if field == "direction" else WORDS[field]
    pairs = ", ".join("'{}', '{}'".format(value, retold(label).replace("'", "''")) for value, label in words.items())
    return f'coalesce(map_get(map({pairs}), to_string("{field}")), to_string("{field}"))'


def _parts():
    """The pieces of the titles, in the user's language: expressions, which need the fields that they name in double quotes, or else a road."""
    return {
        **{field: _in_words(field) for field in ("side", "status", "pattern", "direction", "action", "target")},
        "edge": f"'{tr('Road edge')}'",
        "length": 'format_number("length_m", 0) || \' m\'',
        "height": f"'{tr('height')} ' || format_number(\"height_m\", 2) || ' m'",
        "sigma": "'± ' || CASE WHEN \"sigma_m\" < 0.1 THEN format_number(\"sigma_m\" * 1000, 0) || ' mm' ELSE "
                 "format_number(\"sigma_m\" * 100, 0) || ' cm' END",
        "line": f"CASE WHEN \"kind\" = 'edge' THEN '{tr('Edge line')}' WHEN \"kind\" = 'centre' THEN '{tr('Centre line')}' "
                f"ELSE '{tr('Lane line')}' END || ' ' || \"line\"",
        "lane": f"'{tr('Lane')} ' || \"lane\"",
        "class": f"coalesce({_in_words('class')}, '{tr('Paint')}')",
        "surface": f"'{tr('Road surface')}'",
        "pass": f"'{tr('Pass')} ' || \"pass\"",
        "note": '"note"',
        "curb_point": f"'{tr('Curb point')}'",
    }


def explain_attributes(layer: QgsVectorLayer, output: str, schema: Sequence[Any]) -> None:
    """Set names, formats and titles of the fields of a layer that is a result, such as ROAD_EDGES, whose columns have aliases."""
    for column in schema:
        index = layer.fields().lookupField(column.name)
        if index < 0:
            continue
        # A scratch layer's own fields cannot carry them
        layer.setFieldAlias(index, short_alias(tr(column.alias)))
        if column.name == OTHER.name:
            explain_readings(layer)
        setup = widget_of(column)
        if setup is not None:
            layer.setEditorWidgetSetup(index, setup)
    table = layer.attributeTableConfig()
    table.update(layer.fields())
    for place, column in enumerate(table.columns()):
        table.setColumnWidth(place, MARGIN + LETTER * len(layer.attributeDisplayName(layer.fields().lookupField(column.name))))
    layer.setAttributeTableConfig(table)
    title = title_of(output, {field.name() for field in layer.fields()})
    if title:
        layer.setDisplayExpression(title)
        layer.setMapTipTemplate(map_tip(layer))


def explain_readings(layer: QgsVectorLayer) -> None:
    """Show the values of the field `other`, which are JSON, in words: by a map of those that the layer has now, which needs no plugin."""
    index = layer.fields().lookupField(OTHER.name)
    values = sorted(str(value) for value in layer.uniqueValues(index) if value)
    layer.dataProvider().reloadData()   # or QGIS's connection would keep a file open after the run
    layer.setFieldAlias(index, layer.attributeAlias(index).removesuffix(" (JSON)"))
    layer.setEditorWidgetSetup(index, QgsEditorWidgetSetup("ValueMap", {"map": [{second_reading(value): value} for value in values]}))


def second_reading(other: str) -> str:
    """A value of the field `other` in words."""
    try:
        reading = json.loads(other)
        lanes = [tr("a lane of {width:.1f} m {direction}", width=float(lane["width_m"]), direction=DIRECTIONS[lane["direction"]])
                 for lane in reading.get("lanes", ())]
        if lanes:
            return ", ".join(lanes)
        return LINE_KINDS[reading["kind"]]
    except (ValueError, TypeError, KeyError, AttributeError):  # the field can be edited
        return tr("another reading")


def short_alias(alias: str) -> str:
    """A field's name without the values it may have, which the table shows anyway: "Side (left/right)" -> "Side"."""
    match = re.fullmatch(r"(.*) \(([^)]*)\)", alias)
    if match is None or not re.search(r"[/,|]", match[2]):
        return alias
    unit = match[2].split(",")[0]
    return f"{match[1]} ({unit})" if len(unit) <= 2 and not unit.lstrip("-").isdigit() else match[1]


def widget_of(column: Any) -> QgsEditorWidgetSetup | None:
    """How the values of a column are shown; None for those that are shown as they are."""
    if column.type is float:
        decimals = DECIMALS_OF.get(column.name, DECIMALS.get(column.name.rsplit("_", 1)[-1], MOST_DECIMALS))
        return QgsEditorWidgetSetup("Range", {"Precision": decimals, "AllowNull": True, "Style": "SpinBox"})
    words = DIRECTIONS if column.name == "direction" else WORDS.get(column.name)
    if words is None or "|" in column.alias:   # two in one value
        return None
    return QgsEditorWidgetSetup("ValueMap", {"map": [{label: str(value)} for value, label in words.items()]})


def title_of(output: str, fields: set[str]) -> str:
    """The display expression of a result, of the pieces whose fields the layer has; "" where there is none."""
    parts = _parts()
    names = re.findall(r"{(\w+)}", TITLES.get(output, ""))
    pieces = [parts[name] for name in names if set(re.findall(r'"(\w+)"', parts[name]) or ["road"]) <= fields]
    # pieces without a value are left out together with their comma
    return f"array_to_string(array_filter(array({', '.join(pieces)}), @element IS NOT NULL AND @element <> ''), ', ')" if pieces else ""


def map_tip(layer: QgsVectorLayer) -> str:
    """What a map tip shows: the title, where along the road, and a picture where the fields give one."""
    names = {field.name() for field in layer.fields()}
    location = ""
    if {"road", "station_m"} <= names:
        end = "|| coalesce(' – ' || format_number(\"end_m\", 1), '')" if "end_m" in names else ""
        road = _in_html('"road"')
        location = f"<br>{tr('Road')} [% {road} %], {tr('station')} [% format_number(\"station_m\", 1) {end} %] m"
    return f"<b>[% {_in_html(layer.displayExpression())} %]</b>{location}{tip_picture(names)}"


def _in_html(expression):
    """An expression whose text is shown as it stands in a page: what a field holds may be markup."""
    return f"replace(replace(to_string({expression}), '&', '&amp;'), '<', '&lt;')"


# Small pictures in map tips: the step of a curb (road, face and sidewalk, which lies left of a left edge), and the width of a lane between its
# borders, dashed where their paint is; in files, with expressions of QGIS in brackets.

def tip_picture(names: set[str]) -> str:
    """The expression, in [% %], of the picture that features with fields of these names have in their map tip; "" where they give none."""
    if {"height_m", "side", "edge"} <= names:
        return _shown("curb", '"height_m" IS NOT NULL AND coalesce("edge", \'\') <> \'pavement\'')
    if {"width_m", "left_patt", "right_patt"} <= names:
        return _shown("lane", '"width_m" IS NOT NULL')
    return ""


def _shown(name, condition):
    """The expression that gives the picture: what stands in brackets is put in as its value."""
    pieces, drawn = [], "".join((STYLES / f"tip_{name}.svg").read_text(encoding="utf-8").splitlines())
    for number, part in enumerate(drawn.replace("]", "[").split("[")):
        pieces.append(part if number % 2 else "'" + part.replace("'", "''") + "'")
    picture = " || ".join(f"({piece})" if number % 2 else piece for number, piece in enumerate(pieces))
    return f"[% CASE WHEN {condition} THEN '<br><img src=\"data:image/svg+xml;utf8,' || {picture} || '\"/>' ELSE '' END %]"


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
        if output == "MARKINGS":
            _name_figures(layer)
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


# Where the signs point that the style of markings lays onto arrows, in its order
WAYS = tr("Straight"), tr("Left"), tr("Right"), tr("Straight or left"), tr("Straight or right"), tr("Straight, left or right")
LAID = "THEN @laid["      # there it takes the sign that fits best
ONE_FIGURE = 4.0          # m between bars or letters of one figure
LEAST_FIGURE = 0.3        # m² of paint that is named
ONE_OF = "$id in "        # with these, the rule is ours


def _name_figures(layer):
    """Name what is no line, once for all bars or letters of a figure; of arrows that are whole, where they point."""
    rule = layer.labeling().rootRule().children()[0] if isinstance(layer.labeling(), QgsRuleBasedLabeling) else None
    if rule is None or layer.fields().lookupField("class") < 0 or rule.filterExpression().partition("(")[0] not in ("", ONE_OF):
        return
    metres = QgsUnitTypes.fromUnitToUnitFactor(layer.crs().mapUnits(), Qgis.DistanceUnit.Meters)
    rows = defaultdict(list)
    for row in layer.getFeatures("\"class\" not in ('edge', 'lane', 'centre')"):
        rows[row["class"]].append(row)
    layer.dataProvider().reloadData()   # as above
    named = []
    for kind, members in rows.items():
        around = 0.0 if kind == "arrow" else ONE_FIGURE / 2 / metres   # arrows side by side may point to different sides
        for figure in QgsGeometry.unaryUnion([row.geometry().buffer(around, 4) for row in members]).asGeometryCollection():
            box, middle = figure.boundingBox(), figure.centroid()
            inside = [row for row in members if box.contains(row.geometry().boundingBox())]
            if sum(row.geometry().area() for row in inside) > LEAST_FIGURE / metres**2:
                named.append(max(inside, key=lambda row: row.geometry().distance(middle)).id())
    settings, words = rule.settings(), _in_words("class")
    drawn = layer.renderer().symbol().symbolLayer(0) if isinstance(layer.renderer(), QgsSingleSymbolRenderer) else None
    sign, laid, _ = (drawn.geometryExpression() if isinstance(drawn, QgsGeometryGeneratorSymbolLayer) else "").partition(LAID)
    ways = ", ".join(f"'{retold(way)}'" for way in WAYS)
    settings.fieldName = f"if(\"class\" = 'arrow', {sign}THEN array({ways})[array_find(@fits, array_max(@fits)) % {len(WAYS)}] " \
                         f"ELSE '' END))))) END, {words})" if laid else words
    rule.setSettings(QgsPalLayerSettings(settings))
    rule.setFilterExpression(f"{ONE_OF}({', '.join(map(str, named)) or 'NULL'})")


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

LINE_WIDTH = 0.7  # mm
LANGUAGE = "lanewright/language"  # custom property of a layer, kept with its style: the language of legend and columns


def load_look(layer, qml):
    """Give a layer the look of a QML file, with its legend in the user's language: the styles are written in English."""
    # loadNamedStyle would look into the layer's database first and bring yesterday's style back
    document = QDomDocument()
    document.setContent(Path(qml).read_text(encoding="utf-8"))
    layer.importNamedStyle(document)
    _say_legend(layer)


def _say_legend(layer):
    renderer = layer.renderer()
    if isinstance(renderer, QgsCategorizedSymbolRenderer):
        for number, category in enumerate(renderer.categories()):
            renderer.updateCategoryLabel(number, retold(category.label()))
    elif isinstance(renderer, QgsRuleBasedRenderer):
        for rule in renderer.rootRule().descendants():
            rule.setLabel(retold(rule.label()))
    layer.setCustomProperty(LANGUAGE, language())
    layer.rendererChanged.emit()  # a layer tree that shows the layer already reads its legend again


def say_in_users_language(layers: Sequence[QgsMapLayer]) -> None:
    """Let legends, columns and titles of those layers that are ours speak the user's language, whoever made them; symbols stay as they are."""
    for layer in layers:
        output = output_of(layer) if isinstance(layer, QgsVectorLayer) and layer.customProperty(LANGUAGE) != language() else ""
        if output in LOOKS:
            _say_legend(layer)
            explain_attributes(layer, output, MAP_LAYERS[output].schema if output in MAP_LAYERS else ())
            if output == "MARKINGS":
                _name_figures(layer)
            add_ready_styles(layer, STYLES / f"{LOOKS[output][0]}.qml")


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
                                                for value, colour in STATUS.items() if value in statuses or not statuses])


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
PROVIDER = "postgres"   # of QGIS, for tables of PostGIS
POSTGIS = f"{PROVIDER}://"


def embed_style(name, dest, title, schema=(), provenance=None):
    """Give the result `dest` of the output `name` its style, and the note of where it comes from: in the database, or beside the raster.

    Other formats have no room for one. A style that cannot be kept costs a look, not the result, so nothing is raised.
    """
    path = destination_path(dest)
    look, _ = LOOKS.get(name, (None, None))
    qml = STYLES / f"{look}.qml"
    if dest.startswith(POSTGIS):
        _in_the_database(QgsVectorLayer(dest.removeprefix(POSTGIS), title, PROVIDER), title, qml, schema, name, provenance)
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
    if provenance is not None and layer.providerType() == PROVIDER:
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
        connection = QgsProviderRegistry.instance().providerMetadata(PROVIDER).createConnection(uri.connectionInfo(True), {})
        connection.executeSql(f"COMMENT ON TABLE {name} IS '{quoted}'")
    except QgsProviderConnectionException as problem:
        QgsApplication.messageLog().logMessage(str(problem), "Lanewright", Qgis.MessageLevel.Warning, False)


def _layer_uri(dest, path):
    """The layer of a destination as the OGR provider opens it."""
    if dest.startswith("ogr:"):
        return f"{path}|layername={QgsDataSourceUri(dest.removeprefix('ogr:')).table()}"
    return dest if "|" in dest else f"{path}|layername={Path(path).stem}"
