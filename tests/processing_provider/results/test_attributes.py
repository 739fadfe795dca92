"""What identify, attribute tables and map tips show of a result."""

import pytest
from lanewright.core.common.features import CURB_POINTS, DRIVING_LINES, LANES, MARKING_LINES, MARKINGS, ROAD_EDGES, ROAD_SURFACE
from lanewright.processing_provider.call import qgis_fields
from lanewright.processing_provider.styling import LOOKS, STYLES, TITLES, Styler, short_alias
from qgis.core import (
    QgsApplication,
    QgsEditorWidgetSetup,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsGeometry,
    QgsProcessingContext,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtWidgets import QTextBrowser

SCHEMAS = {"ROAD_EDGES": ("LineStringZ", ROAD_EDGES), "MARKING_LINES": ("LineStringZ", MARKING_LINES), "LANES": ("PolygonZ", LANES),
           "DRIVING_LINES": ("LineStringZ", DRIVING_LINES), "MARKINGS": ("PolygonZ", MARKINGS), "ROAD_SURFACE": ("PolygonZ", ROAD_SURFACE),
           "CURB_POINTS": ("PointZ", CURB_POINTS)}


def loaded(output, **row):
    """A layer as it comes into the project, with one feature."""
    kind, schema = SCHEMAS[output]
    layer = QgsVectorLayer(f"{kind}?crs=EPSG:32650", "layer", "memory")
    layer.dataProvider().addAttributes(list(qgis_fields(schema, with_aliases=False)))
    layer.updateFields()
    feature = QgsFeature(layer.fields())
    if kind == "LineStringZ":
        feature.setGeometry(QgsGeometry.fromWkt("LINESTRING Z (0 0 0, 84 0 0)"))
    for name, value in row.items():
        feature[name] = value
    layer.dataProvider().addFeature(feature)
    look = LOOKS.get(output, (None, 0))[0]
    Styler(STYLES / f"{look}.qml", schema, output).postProcessLayer(layer, QgsProcessingContext(), None)
    return layer


def evaluated(layer, text):
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    context.setFeature(next(layer.getFeatures()))
    return QgsExpression.replaceExpressionText(text, context)


@pytest.mark.parametrize("output, row, said", [
    ("MARKING_LINES", dict(line=12, kind="edge", pattern="solid", length_m=84.27, status="measured"), "Edge line 12, solid, 84 m, measured"),
    ("DRIVING_LINES", dict(lane=2, direction=-1, length_m=120.4, status="bridged"), "Lane 2, against the road, 120 m, bridged"),
    ("ROAD_EDGES", dict(road=0, side="left", length_m=7.7), "Road edge, left, 8 m"),
    ("MARKINGS", {"class": "zebra crossing", "length_m": 4.0}, "zebra crossing, 4 m"),
])
def test_a_feature_says_what_it_is(qgis_app, output, row, said):
    layer = loaded(output, **row)
    assert evaluated(layer, f"[% {layer.displayExpression()} %]") == said
    assert said in evaluated(layer, layer.mapTipTemplate())


def test_a_feature_of_a_layer_from_abroad_says_what_it_is_in_the_words_of_the_user(qgis_app):
    layer = loaded("ROAD_EDGES", road=0, side="left", length_m=7.7)
    layer.setEditorWidgetSetup(layer.fields().lookupField("side"), QgsEditorWidgetSetup("ValueMap", {"map": [{"links": "left"}]}))
    assert evaluated(layer, f"[% {layer.displayExpression()} %]") == "Road edge, left, 8 m"


def test_columns_of_a_table_are_as_wide_as_their_headings(qgis_app):
    layer = loaded("ROAD_EDGES", road=0, side="left")
    widths = {column.name: column.width for column in layer.attributeTableConfig().columns() if column.name}
    headings = {name: layer.attributeDisplayName(layer.fields().lookupField(name)) for name in widths}
    assert all(widths[name] >= 8 * len(heading) for name, heading in headings.items()) and widths["agree_cm"] > widths["road"]


def test_patterns_are_shown_in_words_where_a_value_holds_one(qgis_app):
    layer = loaded("MARKING_LINES", line=3, kind="centre", pattern="double-solid", length_m=9.0, status="measured")
    assert evaluated(layer, f"[% {layer.displayExpression()} %]") == "Centre line 3, double, solid, 9 m, measured"
    assert evaluated(loaded("DRIVING_LINES", pattern="solid|dashed"), "[% represent_value(\"pattern\") %]") == "solid|dashed"


def test_the_second_reading_is_shown_in_words_in_tables_and_forms(qgis_app):
    reading = '{"nats": 0.4, "lanes": [{"offset_m": 1.9, "width_m": 3.24, "direction": -1}]}'
    layer = loaded("DRIVING_LINES", lane=2, other=reading)
    assert evaluated(layer, "[% represent_value(\"other\") %]") == "a lane of 3.2 m against the road"
    assert "JSON" not in layer.attributeAlias(layer.fields().lookupField("other"))
    assert next(layer.getFeatures())["other"] == reading, "Road map reads it"


@pytest.mark.parametrize("output", sorted(set(TITLES) & set(SCHEMAS)))
def test_every_title_can_be_evaluated(qgis_app, output):
    expression = QgsExpression(loaded(output).displayExpression())
    assert not expression.hasParserError(), expression.parserErrorString()


def shown(layer, name):
    """What the attribute table shows of a field of the first feature."""
    index = layer.fields().lookupField(name)
    setup = layer.editorWidgetSetup(index)
    formatter = QgsApplication.fieldFormatterRegistry().fieldFormatter(setup.type())
    return formatter.representValue(layer, index, setup.config(), None, next(layer.getFeatures())[name])


def test_numbers_are_rounded_to_what_they_mean_and_values_are_words(qgis_app):
    layer = loaded("DRIVING_LINES", station_m=12.3456789, rmse_m=0.0123456, radius_m=251.27, direction=1, status="inferred")
    assert [shown(layer, name) for name in ("station_m", "rmse_m", "radius_m", "direction", "status")] == \
        ["12.35", "0.012", "251.3", "along the road", "inferred"]


@pytest.mark.parametrize("row, label", [(dict(radius_m=251.27, design_kmh=60), "R 251 · 60 km/h"), (dict(radius_m=84.31), "R 84.3")])
def test_a_curve_is_labelled_with_its_radius_and_the_design_speed_that_it_allows(row, label):
    layer = loaded("DRIVING_LINES", **row)
    rule, = layer.labeling().rootRule().children()
    assert evaluated(layer, f"[% {rule.settings().fieldName} %]") == label


@pytest.mark.parametrize("alias, short", [
    ("Side (left/right)", "Side"), ("Station (m)", "Station (m)"), ("Offset, left positive (m)", "Offset, left positive (m)"),
    ("Heading (°, clockwise from grid north)", "Heading (°)"), ("Direction (1 along, -1 against the road)", "Direction"),
    ("Kind (main/corner/side_street/island)", "Kind"), ("D (° per 100 ft)", "D (° per 100 ft)"),
])
def test_a_name_is_short_and_keeps_its_unit(alias, short):
    assert short_alias(alias) == short


def test_between_two_layers_of_a_run_the_window_is_drawn(qgis_app):
    """QGIS loads and styles all layers in one go, which would keep the window still for as long."""
    drawn = []
    QTimer.singleShot(0, lambda: drawn.append(True))
    loaded("DRIVING_LINES", status="measured")
    assert drawn


def test_the_road_plan_is_in_force_and_further_looks_stand_ready(qgis_app):
    layer = loaded("DRIVING_LINES", status="measured", confidence=0.9)
    assert set(layer.styleManager().styles()) == {"Road plan", "By class", "By confidence", "By status", "By uncertainty"}
    assert layer.styleManager().currentStyle() == "Road plan" and layer.hasScaleBasedVisibility()
    layer.styleManager().setCurrentStyle("By class")
    assert not layer.hasScaleBasedVisibility() and not layer.labelsEnabled()
    layer.styleManager().setCurrentStyle("By status")
    assert layer.renderer().classAttribute() == "status"
    layer.styleManager().setCurrentStyle("By uncertainty")
    assert layer.renderer().classAttribute() == "sigma_m"
    assert set(loaded("CURB_POINTS", status="measured").styleManager().styles()) >= {"By class", "By status"}
    assert layer.displayExpression() and layer.attributeAlias(layer.fields().lookupField("direction")) == "Direction"


def tip(layer):
    """The map tip of the first feature, drawn."""
    view = QTextBrowser()
    view.setHtml(evaluated(layer, layer.mapTipTemplate()))
    view.resize(320, 140)
    return view.grab().toImage()


def lowest(image, x):
    """The lowest dark pixel of a column of the picture, which lies below two lines of text."""
    return max((y for y in range(45, image.height() - 6) if image.pixelColor(x, y).lightness() < 120), default=None)


@pytest.mark.parametrize("side, road, walk", [("left", 110, 30), ("right", 30, 110)])
def test_the_tip_of_a_curb_shows_its_step_on_its_side(qgis_app, side, road, walk):
    image = tip(loaded("ROAD_EDGES", road=0, station_m=12.0, side=side, edge="curb", height_m=0.15, length_m=7.7))
    assert 10 < lowest(image, road) - lowest(image, walk) < 25


def test_an_edge_without_a_curb_has_no_picture_and_a_lane_its_width_and_borders(qgis_app):
    edge = loaded("ROAD_EDGES", road=0, side="left", edge="pavement", height_m=0.15, length_m=7.7)
    assert "<img" not in evaluated(edge, edge.mapTipTemplate())
    assert "<img" not in evaluated(loaded("ROAD_EDGES", road=0, side="left", edge="curb"), edge.mapTipTemplate())
    lane = loaded("LANES", road=0, station_m=1.0, lane=1, width_m=3.452, left_patt="dashed", right_patt="solid")
    said = evaluated(lane, lane.mapTipTemplate())
    assert "3.45 m" in said and said.index("'9 6'") < said.index("'none'")
