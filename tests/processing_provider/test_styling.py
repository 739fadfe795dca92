"""Layers arrive in the project named, grouped and styled."""

import html
import re
from datetime import datetime, timezone

import numpy as np
import pytest
from lanewright.algorithms.provenance import Provenance
from lanewright.core.common.features import (
    CONTROL_POINTS,
    CROSS_SECTIONS,
    DRIVING_LINES,
    LANES,
    MARKING_LINES,
    MARKINGS,
    PASSES,
    PROPOSED_POINTS,
    RESIDUALS,
    ROAD_EDGES,
    ROAD_SURFACE,
    ROADSIDE,
    ROADSIDE_OBJECTS,
)
from lanewright.core.driving.layers import LANE_TYPES
from lanewright.processing_provider.call import qgis_fields
from lanewright.processing_provider.results.road_maps import OUTPUT, Run
from lanewright.processing_provider.styling import LOOKS, STYLES, Styler, apply_style, embed_style, say_in_users_language, style_on_load
from lanewright.processing_provider.texts import speak
from osgeo import gdal
from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsFillSymbol,
    QgsGeometry,
    QgsPointXY,
    QgsProcessingContext,
    QgsProject,
    QgsRasterLayer,
    QgsRasterMinMaxOrigin,
    QgsRectangle,
    QgsRenderContext,
    QgsSingleSymbolRenderer,
    QgsSymbol,
    QgsSymbolLayerUtils,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

KINDS = {
    "ROAD_EDGES": ("LineStringZ", ROAD_EDGES),
    "MARKINGS": ("PolygonZ", MARKINGS),
    "MARKING_LINES": ("LineStringZ", MARKING_LINES),
    "DRIVING_LINES": ("LineStringZ", DRIVING_LINES),
    "LANES": ("PolygonZ", LANES),
    "RESIDUALS": ("LineStringZ", RESIDUALS),
    "UAV_GCPS": ("PointZ", CONTROL_POINTS),
    "CONTROL_POINTS": ("PointZ", PROPOSED_POINTS),
    "CROSS_SECTIONS": ("LineStringZ", CROSS_SECTIONS),
    "ROADSIDE": ("LineStringZ", ROADSIDE),
    "ROADSIDE_OBJECTS": ("PointZ", ROADSIDE_OBJECTS),
}


def layer_of(kind, schema):
    layer = QgsVectorLayer(kind, "layer", "memory")
    layer.dataProvider().addAttributes(list(qgis_fields(schema)))
    layer.updateFields()
    return layer


@pytest.mark.parametrize("name", [name for name, (look, _) in LOOKS.items() if look])
def test_every_result_has_a_style(name):
    assert (STYLES / f"{LOOKS[name][0]}.qml").exists()


@pytest.mark.parametrize("name", KINDS)
def test_a_style_looks_at_fields_that_the_layer_has(qgis_app, name):
    layer = layer_of(*KINDS[name])
    Styler(STYLES / f"{LOOKS[name][0]}.qml").postProcessLayer(layer, QgsProcessingContext(), None)
    used = {column for name in layer.renderer().usedAttributes(QgsRenderContext()) for column in QgsExpression(name).referencedColumns()}
    assert used and used <= {field.name() for field in layer.fields()}


@pytest.mark.parametrize("name", [name for name in KINDS if name not in ("MARKING_LINES", "MARKINGS")])
def test_every_class_of_a_style_is_drawn_and_in_the_legend(qgis_app, name):
    """QGIS passes over a class whose symbol another has taken."""
    path = STYLES / f"{LOOKS[name][0]}.qml"
    layer = layer_of(*KINDS[name])
    apply_style(layer, path)
    assert len(layer.renderer().categories()) == path.read_text(encoding="utf-8").count("<category ")


@pytest.mark.parametrize("status", ["measured", "bridged", "inferred"])
def test_by_class_curbs_are_told_by_side_and_by_what_was_measured(qgis_app, status):
    layer = layer_of("LineStringZ", ROAD_EDGES)
    apply_style(layer, STYLES / "by_class" / "road_edges.qml")
    left, right = ([drawn.symbol().color().name() for drawn in layer.renderer().categories() if drawn.value() == f"{side} {status}"]
                   for side in ("left", "right"))
    assert len(left) == len(right) == 1 and left != right


def test_by_class_edges_of_the_pavement_look_unlike_curbs(qgis_app):
    layer = layer_of("LineStringZ", ROAD_EDGES)
    apply_style(layer, STYLES / "by_class" / "road_edges.qml")
    colours = {drawn.value(): drawn.symbol().color().name() for drawn in layer.renderer().categories()}
    assert colours["pavement measured"] == colours["pavement bridged"] not in {colours["left measured"], colours["right measured"]}


def test_what_was_bridged_beside_the_road_is_paler_than_what_was_measured(qgis_app):
    layer = layer_of("LineStringZ", ROADSIDE)
    apply_style(layer, STYLES / "roadside.qml")
    for drawn in layer.renderer().categories():
        opacity = drawn.symbol().dataDefinedProperties().property(QgsSymbol.Property.Opacity).asExpression()
        shown = [QgsExpression(opacity.replace('"status"', f"'{status}'")).evaluate() for status in ("bridged", "measured")]
        assert 20 <= shown[0] < shown[1] == 100, drawn.label()


@pytest.mark.parametrize("edge, status, part, value", [
    ("curb", "measured", "bottom", "curb measured"), ("curb", "accepted", "bottom", "curb measured"),
    ("dropped", "bridged", "bottom", "dropped bridged"),
    ("pavement", "inferred", "", "pavement bridged"), (None, None, "bottom", "curb measured"), ("curb", "measured", "top", "top")])
def test_a_road_plan_draws_every_edge_of_the_road(qgis_app, edge, status, part, value):
    layer = layer_of("LineStringZ", ROAD_EDGES)
    apply_style(layer, STYLES / "road_edges.qml")
    feature = QgsFeature(layer.fields())
    for name, held in (("edge", edge), ("status", status), ("part", part)):
        feature[name] = held
    context = QgsExpressionContext()
    context.setFeature(feature)
    assert QgsExpression(layer.renderer().classAttribute()).evaluate(context) == value
    assert value in {drawn.value() for drawn in layer.renderer().categories()}


def test_a_road_plan_grows_with_the_scale(qgis_app):
    """From afar the surface and its edges, from nearer the lines, from near all."""
    seen = {}
    for name in ("ROAD_SURFACE", "ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES"):
        layer = layer_of(*KINDS.get(name, ("PolygonZ", ROAD_SURFACE)))
        apply_style(layer, STYLES / f"{LOOKS[name][0]}.qml")
        seen[name] = [scale for scale in (500, 1500, 5000) if layer.isInScaleRange(scale)]
    assert seen.pop("ROAD_SURFACE") == seen.pop("ROAD_EDGES") == [500, 1500, 5000]
    assert all(scales == [500, 1500] for scales in seen.values()), seen


def drawn_by(layer, symbol, geometry, scale, **values):
    """What the geometry generator of a symbol draws of a feature at a scale."""
    feature = QgsFeature(layer.fields())
    feature.setGeometry(geometry)
    for name, value in values.items():
        feature[name] = value
    layer.dataProvider().addFeatures([feature])
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    context.setFeature(next(layer.getFeatures()))
    context.lastScope().setVariable("map_scale", scale)
    expression = QgsExpression(next(part for part in symbol.symbolLayers() if part.layerType() == "GeometryGenerator").geometryExpression())
    result = expression.evaluate(context)
    assert not expression.hasParserError() and not expression.hasEvalError(), expression.parserErrorString() + expression.evalErrorString()
    return result


@pytest.mark.parametrize("turned", [0, 70, 180, 290])
@pytest.mark.parametrize("sign, left, right", [
    ("POLYGON((-0.1 0, 0.1 0, 0.1 3, 0.4 3, 0 4.5, -0.4 3, -0.1 3, -0.1 0))", 0.4, 0.4),
    ("POLYGON((-0.1 0, 0.1 0, 0.1 2.7, -0.4 3.5, 0 4.2, -1 4.5, -0.6 2.8, -0.5 3, -0.1 2.3, -0.1 0))", 1.0, 0.1)])
def test_a_ragged_arrow_is_drawn_as_the_sign_it_is(qgis_app, sign, left, right, turned):
    """It points where the paint points, and lies on it; the corners of the cells that the outline came from are gone."""
    layer = layer_of("Polygon", MARKINGS)
    apply_style(layer, STYLES / "markings.qml")
    clean = QgsGeometry.fromWkt(sign)
    ragged = QgsGeometry.unaryUnion([QgsGeometry.fromRect(QgsRectangle(x, y, x + 0.05, y + 0.05)) for x in np.arange(-1.2, 1.2, 0.05)
                                     for y in np.arange(-0.2, 4.8, 0.05) if clean.contains(QgsPointXY(x + 0.025, y + 0.025))])
    ragged.rotate(turned, QgsPointXY(0, 0))
    shape = drawn_by(layer, layer.renderer().symbol().clone(), ragged, 500, **{"class": "arrow"})
    shape.rotate(-turned, QgsPointXY(0, 0))
    assert shape.intersection(clean).area() > 0.6 * shape.combine(clean).area()
    box = shape.boundingBox()
    np.testing.assert_allclose((-box.xMinimum(), box.xMaximum(), box.yMinimum(), box.yMaximum()), (left, right, 0, 4.5), atol=0.15)
    assert len(list(shape.vertices())) < 15 < len(list(ragged.vertices()))


def test_paint_that_is_no_whole_arrow_keeps_its_outline(qgis_app):
    layer = layer_of("Polygon", MARKINGS)
    apply_style(layer, STYLES / "markings.qml")
    rest = QgsGeometry.fromWkt("POLYGON((0 0, 0.1 0, 0.1 2, 1 2, 1 0, 1.1 0, 1.1 2.1, 0 2.1, 0 0))")
    arrow, symbol = (drawn_by(layer_of("Polygon", MARKINGS), layer.renderer().symbol().clone(), rest, 500, **{"class": name})
                     for name in ("arrow", "symbol"))
    assert arrow.equals(symbol)


@pytest.mark.parametrize("direction", [1, -1])
def test_stations_stand_where_they_are_along_the_road(qgis_app, direction):
    """At 1 : 250 every ten metres from the first round one on, across the pass that the stations were counted along."""
    layer = layer_of("LineString", PASSES)
    apply_style(layer, STYLES / "passes.qml")
    line = QgsGeometry.fromWkt("LINESTRING(0 0, 0 64)" if direction == 1 else "LINESTRING(0 64, 0 0)")
    ticks = drawn_by(layer, layer.renderer().symbol().clone(), line, 250, road=0, direction=direction, station_m=13.0, end_m=77.0)
    assert sorted(round(tick.centroid().asPoint().y() + 13) for tick in ticks.asGeometryCollection()) == [20, 30, 40, 50, 60, 70]


@pytest.mark.parametrize("scale, values, text", [
    (500, dict(width_m=3.4, length_m=40.0), "3.40"), (1000, dict(width_m=3.4, length_m=40.0), ""), (500, dict(width_m=3.4, length_m=5.0), ""),
    (500, dict(width_m=3.4, length_m=40.0, radius_m=84.8, design_kmh=50), "3.40 · R 84.8 · 50 km/h"),
    (1000, dict(width_m=3.4, length_m=40.0, radius_m=240.2), "R 240")])
def test_a_driving_line_says_how_wide_its_lane_is_and_how_tight_its_curve(qgis_app, scale, values, text):
    layer = layer_of("LineStringZ", DRIVING_LINES)
    apply_style(layer, STYLES / "driving_lines.qml")
    feature = QgsFeature(layer.fields())
    for name, value in values.items():
        feature[name] = value
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    context.setFeature(feature)
    context.lastScope().setVariable("map_scale", scale)
    label = QgsExpression(layer.labeling().rootRule().children()[0].settings().fieldName)
    assert (label.evaluate(context) or "") == text and not label.hasEvalError()


def test_a_road_plan_has_one_grey_and_yellow_is_paint_alone(qgis_app):
    """What was measured and what not is told by the style By status: on a plan patches of another grey, and yellow dashes, mean something else."""
    surface, lines = layer_of("PolygonZ", ROAD_SURFACE), layer_of("LineStringZ", MARKING_LINES)
    apply_style(surface, STYLES / "road_surface.qml")
    apply_style(lines, STYLES / "marking_lines.qml")
    assert len(surface.renderer().symbols(QgsRenderContext())) == 1
    assert {part.color().hsvSaturation() < 30 for symbol in lines.renderer().symbols(QgsRenderContext()) for part in symbol.symbolLayers()} == {True}


def test_by_class_every_type_of_lane_has_a_look_of_its_own(qgis_app):
    layer = layer_of("PolygonZ", LANES)
    apply_style(layer, STYLES / "by_class" / "lanes.qml")
    colours = {drawn.value(): drawn.symbol().color().name() for drawn in layer.renderer().categories()}
    assert set(colours) == set(LANE_TYPES) and len(set(colours.values())) == len(LANE_TYPES)


def test_the_legend_speaks_the_language_of_the_user(qgis_app):
    speak("de")
    try:
        layer, lines = layer_of("LineStringZ", ROAD_EDGES), layer_of("LineStringZ", MARKING_LINES)
        apply_style(layer, STYLES / "road_edges.qml")
        apply_style(lines, STYLES / "marking_lines.qml")
    finally:
        speak("en")
    assert layer.renderer().categories()[0].label() == "Bordstein"
    assert {rule.label() for rule in lines.renderer().rootRule().descendants()} >= {"Überbrückt"}


def test_the_icon_of_markings_shows_their_paint_on_asphalt(qgis_app):
    layer = layer_of("PolygonZ", MARKINGS)
    apply_style(layer, STYLES / "markings.qml")
    icon = QgsSymbolLayerUtils.symbolPreviewPixmap(layer.renderer().symbol(), QSize(16, 16)).toImage()
    assert {QColor(icon.pixel(x, y)).name() for x in range(16) for y in range(16)} >= {"#ffffff", "#8d9299"}


def test_heights_are_shown_as_a_hillshade_below_the_intensity_image(qgis_app, tmp_path):
    path = str(tmp_path / "heights.tif")
    dataset = gdal.GetDriverByName("GTiff").Create(path, 10, 10, 1, gdal.GDT_Float32)
    dataset.GetRasterBand(1).WriteRaster(0, 0, 10, 10, np.arange(100, dtype=np.float32).tobytes())
    del dataset
    layer, (look, order) = QgsRasterLayer(path, "heights"), LOOKS["DEM"]
    Styler(STYLES / f"{look}.qml", (), "DEM").postProcessLayer(layer, QgsProcessingContext(), None)
    assert layer.renderer().type() == "hillshade" and order < LOOKS["INTENSITY_IMAGE"][1]


def test_an_image_is_stretched_to_its_own_values(qgis_app, tmp_path):
    path = str(tmp_path / "image.tif")
    values = np.linspace(3000.0, 9000.0, 10000, dtype=np.float32)
    dataset = gdal.GetDriverByName("GTiff").Create(path, 100, 100, 1, gdal.GDT_Float32)
    dataset.GetRasterBand(1).WriteRaster(0, 0, 100, 100, values.tobytes())
    del dataset
    layer = QgsRasterLayer(path, "image")
    Styler(STYLES / "intensity_image.qml").postProcessLayer(layer, QgsProcessingContext(), None)
    stretch = layer.renderer().contrastEnhancement()
    assert 3000 <= stretch.minimumValue() < 3300 and 8700 < stretch.maximumValue() <= 9000
    assert stretch.minimumValue() % 1 == stretch.maximumValue() % 1 == 0, "the legend is read by people"
    assert layer.renderer().minMaxOrigin().extent() == QgsRasterMinMaxOrigin.Extent.WholeRaster, "one tone means one intensity, wherever one looks"


def test_what_is_loaded_comes_named_and_grouped(qgis_app):
    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    details = QgsProcessingContext.LayerDetails("x", context.project(), "x")
    context.addLayerToLoadOnCompletion("/data/edges.gpkg", details)
    style_on_load("ROAD_EDGES", "/data/edges.gpkg", "Road edges", context, run=Run(None, "B12", "Lanewright – B12"))
    loaded = context.layerToLoadOnCompletionDetails("/data/edges.gpkg")
    assert (loaded.name, loaded.groupName, loaded.forceName) == ("Road edges", "Lanewright – B12", True)
    assert loaded.postProcessor() is not None


def test_what_is_not_loaded_is_left_alone(qgis_app):
    context = QgsProcessingContext()
    style_on_load("ROAD_EDGES", "/data/edges.gpkg", "Road edges", context)
    assert not context.layersToLoadOnCompletion()


def written(tmp_path, dest):
    from qgis.core import QgsCoordinateTransformContext, QgsVectorFileWriter

    layer = layer_of(*KINDS["ROAD_EDGES"])
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.layerName = "edges"
    QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(tmp_path / "map.gpkg"), QgsCoordinateTransformContext(), options)
    return dest


def test_a_geopackage_made_without_a_window_opens_styled_and_with_aliases(qgis_app, tmp_path):
    path = tmp_path / "map.gpkg"
    dest = written(tmp_path, f"ogr:dbname='{path}' table=\"edges\" (geom)")
    for output in ("CURB_POINTS", "ROAD_EDGES"):  # a second run into the same table replaces the style
        embed_style(output, dest, "Road edges", ROAD_EDGES)
    layer = QgsVectorLayer(f"{path}|layername=edges", "edges", "ogr")
    assert layer.listStylesInDatabase()[2] == ["default"]
    assert "pavement bridged" in {drawn.value() for drawn in layer.renderer().categories()}
    assert layer.attributeAlias(layer.fields().lookupField("station_m")) == "Station (m)"


def test_an_image_made_without_a_window_opens_stretched(qgis_app, tmp_path):
    path = str(tmp_path / "image.tif")
    values = np.linspace(3000.0, 9000.0, 10000, dtype=np.float32)
    dataset = gdal.GetDriverByName("GTiff").Create(path, 100, 100, 1, gdal.GDT_Float32)
    dataset.GetRasterBand(1).WriteRaster(0, 0, 100, 100, values.tobytes())
    del dataset
    embed_style("INTENSITY_IMAGE", path, "Intensity image")
    image = QgsRasterLayer(path, "image")  # whose stretch goes with it
    stretch = image.renderer().contrastEnhancement()
    assert 3000 <= stretch.minimumValue() < 3300 and 8700 < stretch.maximumValue() <= 9000


@pytest.mark.parametrize("path", sorted(STYLES.rglob("*.qml")), ids=lambda path: path.stem)
def test_no_style_makes_the_window_wait(path):
    """Where functions stand within each other, QGIS copies the inner ones twice at every level: for twenty levels that takes seconds."""
    for value in re.findall(r'"([^"]*\([^"]*)"', path.read_text(encoding="utf-8")):
        depth, deepest = 0, 0
        for letter in re.sub(r"'[^']*'", "", html.unescape(value).replace("''", "")):
            depth += {"(": 1, ")": -1}.get(letter, 0)
            deepest = max(deepest, depth)
        assert deepest <= 12, value


def named_by(layer):
    """{cluster: what stands beside it} of the markings of a layer."""
    rule = layer.labeling().rootRule().children()[0]
    text, texts = QgsExpression(rule.settings().fieldName), {}
    assert not text.hasParserError(), text.parserErrorString()
    for row in layer.getFeatures(rule.filterExpression()):
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
        context.setFeature(row)
        texts[row["cluster"]] = text.evaluate(context)
    return texts


def test_classes_of_paint_are_named_once_for_a_figure_and_arrows_by_where_they_point(qgis_app):
    layer = layer_of("Polygon", MARKINGS)
    layer.setCrs(QgsCoordinateReferenceSystem("EPSG:32650"))
    bar = "POLYGON(({0} {1}, {2} {1}, {2} {3}, {0} {3}, {0} {1}))"
    left = "POLYGON((-0.1 0, 0.1 0, 0.1 2.7, -0.4 3.5, 0 4.2, -1 4.5, -0.6 2.8, -0.5 3, -0.1 2.3, -0.1 0))"
    shapes = [("zebra", bar.format(x, 20, x + 0.5, 24)) for x in range(6)] + [("zebra", bar.format(40, 20, 40.5, 24)), ("arrow", left)]
    shapes += [("arrow", "POLYGON((3 0, 3.2 0, 3.2 2, 3.3 2, 3.1 3, 2.9 2, 3 2, 3 0))"), ("stop", bar.format(0, 30, 3, 30.5)),
               ("symbol", bar.format(60, 0, 60.3, 0.5)), ("lane", bar.format(0, 50, 0.12, 53))]
    for cluster, (kind, shape) in enumerate(shapes):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromWkt(shape))
        feature["cluster"], feature["class"] = cluster, kind
        layer.dataProvider().addFeature(feature)
    apply_style(layer, STYLES / "markings.qml", MARKINGS, "MARKINGS")
    texts = named_by(layer)
    assert sorted(texts.values()) == ["Left", "Stop line", "Straight", "Zebra crossing", "Zebra crossing"], texts
    assert texts[6] == "Zebra crossing" and texts[7] == "Left", "a lane line, and a fleck of paint, have no name"


@pytest.mark.parametrize("made_in, opened_in, legend", [("en", "de", "Bordstein"), ("de", "en", "Curb")])
def test_layers_of_a_colleague_speak_the_language_of_who_opens_them_and_keep_their_colours(tmp_path, provider, qgis_app, made_in, opened_in, legend):
    path = str(tmp_path / "theirs.gpkg")
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.layerName = "road_edges"
    QgsVectorFileWriter.writeAsVectorFormatV3(layer_of("LineString", ROAD_EDGES), path, QgsProject.instance().transformContext(), options)
    provenance = Provenance("roadmap", "1.0", {}, datetime(2026, 6, 1, 8, tzinfo=timezone.utc))
    try:
        speak(made_in)
        embed_style("ROAD_EDGES", f"ogr:dbname='{path}' table=\"road_edges\" (geom)", "Road edges", ROAD_EDGES, provenance)
        speak(opened_in)
        layer = QgsVectorLayer(f"{path}|layername=road_edges", "roadmap", "ogr")
        before = layer.renderer().symbols(QgsRenderContext())[0].dump()
        say_in_users_language([layer, layer_of("LineString", ROAD_EDGES)])
        titles = [category.label() for category in layer.renderer().categories()]
        alias = layer.attributeAlias(layer.fields().lookupField("side"))
        assert legend in titles and alias == {"de": "Seite", "en": "Side"}[opened_in], (titles, alias)
        assert layer.renderer().symbols(QgsRenderContext())[0].dump() == before and len(layer.styleManager().styles()) > 1
        layer.setFieldAlias(0, "Mine")
        say_in_users_language([layer])
        assert layer.attributeAlias(0) == "Mine", "once"
    finally:
        speak("en")


@pytest.mark.parametrize("renderer", [QgsCategorizedSymbolRenderer("class", []), QgsSingleSymbolRenderer(QgsFillSymbol.createSimple({}))],
                         ids=["by a field", "one colour"])
def test_markings_that_a_colleague_has_drawn_otherwise_are_named_in_the_users_language(qgis_app, renderer):
    layer = layer_of("Polygon", MARKINGS)
    apply_style(layer, STYLES / "markings.qml", MARKINGS, "MARKINGS")
    layer.setRenderer(renderer.clone())
    layer.setCustomProperty(OUTPUT, "MARKINGS")
    layer.setCustomProperty("lanewright/language", "de")
    say_in_users_language([layer])
    assert layer.customProperty("lanewright/language") == "en" and type(layer.renderer()) is type(renderer)
    assert "Zebra crossing" in layer.labeling().rootRule().children()[0].settings().fieldName
