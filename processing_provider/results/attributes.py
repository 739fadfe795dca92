"""How the rows of a layer read: short names of fields, rounded numbers, values in the user's words, a line that says what a feature is."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from qgis.core import QgsEditorWidgetSetup, QgsProviderRegistry, QgsVectorLayer

from ...core.common.features import OTHER
from ...core.common.texts import vocabulary
from ...core.lazy import gdal
from ..texts import tr

STYLES = Path(__file__).resolve().parents[2] / "resources" / "styles"
# Unit at the end of a field's name -> decimals that mean something
DECIMALS = {"m": 2, "cm": 1, "m2": 2, "ft": 2, "deg": 2, "pct": 1, "x": 3, "y": 3}
DECIMALS_OF = {"rmse_m": 3, "sigma_m": 3, "sigma_z_m": 3, "pass_sig_m": 3,  # nosec B105: a pass over a road, no password
               "resid_m": 3, "loo_m": 3, "residual_m": 3, "radius_m": 1, "radius_ft": 1, "confidence": 2, "time": 3,
               "roll": 2, "pitch": 2, "heading": 1, "elongation": 1, "pixel": 1, "line_px": 1}
MOST_DECIMALS = 2  # of any other number
MARGIN, LETTER = 40, 8  # pixels of a column of the attribute table: beside its heading, and for each letter of it

# Field -> {value: words}; what is not among them is shown as it is
WORDS = {field: {value: tr(vocabulary().get(f"{field}.{value}") or vocabulary()[value]) for value in values.split()} for field, values in {
    "status": "measured bridged inferred occluded grown accepted drawn", "side": "left right", "part": "bottom top",
    "pattern": "solid dashed double-solid double-dashed solid-dashed dashed-solid", "use": "keep other", "source": "pair offset drawn",
    "turn": "left right", "action": "accept delete move draw take", "target": "edge marking lane", "outcome": "correct missed false excluded",
}.items()}
LINE_KINDS = {"edge": tr("Edge line"), "centre": tr("Centre line"), "lane": tr("Lane line")}
DIRECTIONS = {1: tr("along the road"), -1: tr("against the road"), 0: tr("not driven")}

# Result -> what a feature is, in an expression of QGIS; fields are named in quotes
TITLES = {
    "ROAD_EDGES": '{edge}, {side}, {length}, {status}, {sigma}',
    "BOUNDARIES": '{edge}, {side}, {length}, {status}, {sigma}',
    "MARKING_LINES": '{line}, {pattern}, {length}, {status}',
    "DRIVING_LINES": '{lane}, {direction}, {length}, {status}, {sigma}',
    "LANES": '{lane}, {direction}, {length}, {status}',
    "MARKINGS": '{class}, {length}',
    "ROAD_SURFACE": '{surface}, {status}',
    "PASSES": '{pass}, {direction}, {length}',
    "CORRECTIONS": '{action}, {target}, {note}',
    "CURB_POINTS": '{curb_point}, {side}, {height}, {status}',
}


def _in_words(field):
    """The value of a field in the user's language, also of a layer that was made in another."""
    words = DIRECTIONS if field == "direction" else WORDS[field]
    pairs = ", ".join("'{}', '{}'".format(value, label.replace("'", "''")) for value, label in words.items())
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
        "class": f"coalesce(\"class\", '{tr('Paint')}')",
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
    values = sorted(str(value) for value in _values(layer, index) if value)
    layer.setFieldAlias(index, layer.attributeAlias(index).removesuffix(" (JSON)"))
    layer.setEditorWidgetSetup(index, QgsEditorWidgetSetup("ValueMap", {"map": [{second_reading(value): value} for value in values]}))


def _values(layer, index):
    """Values of a field. Those of a file are read without QGIS, whose connections would keep it open after the run."""
    if layer.providerType() != "ogr":
        return layer.uniqueValues(index)

    uri = QgsProviderRegistry.instance().decodeUri("ogr", layer.source())
    data = gdal.OpenEx(uri["path"], gdal.OF_VECTOR)
    table = data and (data.GetLayerByName(uri["layerName"]) if uri.get("layerName") else data.GetLayer(0))
    return {feature.GetField(layer.fields().at(index).name()) for feature in table} if table else set()


def second_reading(other: str) -> str:
    """A value of the field `other` in words."""
    try:
        reading = json.loads(other)
        lanes = [tr("a lane of {width:.1f} m {direction}").format(width=float(lane["width_m"]), direction=DIRECTIONS[lane["direction"]])
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
