"""The print layout of a road map."""

import html
import math

import numpy as np
import pytest
from lanewright.core.common.features import DRIVING_LINES, ROAD_EDGES
from lanewright.desktop.layout.layout_dialog import LayoutDialog, credit_of, shown_layers
from lanewright.desktop.layout.map_layout import MARGIN, SCALES, road_map_layout
from lanewright.desktop.menu import unused_name
from lanewright.processing_provider.results.attributes import explain_attributes
from lanewright.processing_provider.results.road_maps import road_maps
from qgis.core import (
    Qgis,
    QgsCategorizedSymbolRenderer,
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsGeometry,
    QgsLayoutExporter,
    QgsLayoutItemLabel,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsLineSymbol,
    QgsRasterLayer,
    QgsRendererCategory,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QImage
from road_map_layers import added


def street(project, angle=0.0):
    """Two edges of a street of 100 x 10 m, turned clockwise by so many degrees."""
    layer = QgsVectorLayer("LineString?crs=EPSG:32650", "Road edges", "memory")
    for y in (0, 10):
        feature = QgsFeature()
        geometry = QgsGeometry.fromWkt(f"LINESTRING(0 {y}, 100 {y})")
        geometry.rotate(angle, QgsGeometry.fromWkt("POINT(0 0)").asPoint())
        feature.setGeometry(geometry)
        layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    project.addMapLayer(layer)
    return layer


def item(layout, kind):
    return next(found for found in layout.items() if isinstance(found, kind))


@pytest.mark.parametrize("angle", [0, 30, 90, 145])
def test_the_road_lies_along_the_page_whichever_way_it_runs(project, angle):
    layout = road_map_layout(project, [street(project, angle)], "A street")
    chart = item(layout, QgsLayoutItemMap)
    assert abs((chart.mapRotation() + angle + 90) % 180 - 90) < 1
    assert 100 + 2 * MARGIN < chart.extent().width() < 2.6 * (100 + 2 * MARGIN)


@pytest.mark.parametrize("angle", [0, 30, 145])
def test_the_north_arrow_points_north_on_the_turned_map(project, angle):
    layout = road_map_layout(project, [street(project, angle)], "A street")
    arrow, chart = item(layout, QgsLayoutItemPicture), item(layout, QgsLayoutItemMap)
    assert not arrow.isMissingImage()
    assert abs((arrow.pictureRotation() - chart.mapRotation() + 180) % 360 - 180) < 0.01


@pytest.mark.parametrize("paper, size", [("A4", (210, 297)), ("A3", (297, 420))])
def test_the_page_is_a_sheet_of_paper_and_the_scale_a_round_number(project, paper, size):
    layout = road_map_layout(project, [street(project)], "A street", paper)
    page = layout.pageCollection().page(0).pageSize()
    assert sorted((round(page.width()), round(page.height()))) == list(size)
    assert page.width() > page.height()  # the street is long
    assert round(item(layout, QgsLayoutItemMap).scale(), 3) in SCALES


def inked(layout, page=0):
    """Share of the map's pixels that are not white, where layers were drawn."""
    image = QgsLayoutExporter(layout).renderPageToImage(page, dpi=60)
    chart = item(layout, QgsLayoutItemMap)
    per_mm = image.width() / layout.pageCollection().page(page).pageSize().width()
    left, top = chart.pos().x() * per_mm, chart.pos().y() * per_mm
    width, height = chart.rect().width() * per_mm, chart.rect().height() * per_mm
    bits = image.convertToFormat(QImage.Format.Format_Grayscale8)
    grey = np.frombuffer(bits.constBits().asstring(bits.sizeInBytes()), np.uint8).reshape(bits.height(), bits.bytesPerLine())
    # without its rim, north arrow and scale bar
    inside = grey[int(top + 0.2 * height):int(top + 0.75 * height), int(left + 0.03 * width):int(left + 0.75 * width)]
    return (inside < 230).mean()


@pytest.mark.parametrize("shown_in", ["EPSG:32650", "EPSG:3857", "EPSG:4326"])
def test_the_map_shows_the_road_whatever_crs_the_project_has(project, shown_in):
    project.setCrs(QgsCoordinateReferenceSystem(shown_in))
    layout = road_map_layout(project, [street(project)], "A street")
    assert item(layout, QgsLayoutItemMap).crs().authid() == "EPSG:32650"
    assert inked(layout) > 0.001


def test_a_road_of_three_kilometres_becomes_an_atlas_that_shows_all_of_it(project):
    """A straight of 2 km and a bend of a quarter circle: every metre lies on some page, along the page."""
    layer = QgsVectorLayer("LineString?crs=EPSG:32650", "Driving lines", "memory")
    bend = [f"{2000 + 640 * math.sin(k / 50)} {640 * (1 - math.cos(k / 50))}" for k in range(79)]
    road = QgsGeometry.fromWkt("LINESTRING(0 0, " + ", ".join(bend) + ")")
    feature = QgsFeature()
    feature.setGeometry(road)
    layer.dataProvider().addFeature(feature)
    project.addMapLayer(layer)
    layout = road_map_layout(project, [layer], "A long road")
    atlas, chart = layout.atlas(), item(layout, QgsLayoutItemMap)
    assert atlas.enabled() and 15 < atlas.count() < 40
    outlines = QgsGeometry.unaryUnion([feature.geometry() for feature in atlas.coverageLayer().getFeatures()])
    assert road.difference(outlines).length() < 1.0
    for number in (0, atlas.count() - 1):
        assert atlas.seekTo(number)
        assert chart.scale() == pytest.approx(500, rel=1e-3)
        assert inked(layout) > 0.001


def test_a_chosen_scale_too_large_for_the_road_divides_it_into_pages(project):
    layout = road_map_layout(project, [street(project)], "A street", scale=100)
    assert layout.atlas().enabled() and layout.atlas().count() >= 4
    assert item(layout, QgsLayoutItemMap).scale() == pytest.approx(100, rel=1e-3)


def test_a_layer_below_is_drawn_last_and_is_not_in_the_legend(project):
    road, below = street(project), street(project)
    layout = road_map_layout(project, [road], "A street", below=[below])
    assert item(layout, QgsLayoutItemMap).layers() == [road, below]
    assert len(item(layout, QgsLayoutItemLegend).model().rootGroup().findLayers()) == 1


def lines_of_a_map(project):
    return [added(project, output, schema, ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0)))
            for output, schema in (("ROAD_EDGES", ROAD_EDGES), ("DRIVING_LINES", DRIVING_LINES))]


def test_layers_that_are_switched_off_are_not_printed(project):
    edges, lanes = lines_of_a_map(project)
    project.layerTreeRoot().findLayer(lanes.id()).setItemVisibilityChecked(False)
    road_map, = road_maps(project)
    assert shown_layers(road_map, project) == [edges] and shown_layers(road_map, project, hidden=True) == [lanes, edges]


def test_the_scale_bar_is_a_part_of_the_page(project):
    layout = road_map_layout(project, [street(project)], "A street")
    bar, chart = item(layout, QgsLayoutItemScaleBar), item(layout, QgsLayoutItemMap)
    assert 0.05 < bar.rect().width() / chart.rect().width() < 0.35


def test_the_legend_lists_what_is_drawn_as_lines_and_areas(project):
    layout = road_map_layout(project, [street(project)], "A street")
    assert [node.name() for node in item(layout, QgsLayoutItemLegend).model().rootGroup().findLayers()] == ["Road edges"]


def test_white_paint_is_seen_in_the_legend(project):
    layout = road_map_layout(project, [street(project)], "A street")
    legend = item(layout, QgsLayoutItemLegend)
    assert legend.hasBackground() and legend.backgroundColor().lightness() < 220


def test_a_second_layout_gets_a_name_of_its_own(project):
    for expected in ("Lanewright – B12", "Lanewright – B12 2", "Lanewright – B12 3"):
        name = unused_name(project, "Lanewright – B12")
        assert name == expected
        layout = road_map_layout(project, [street(project)], name)
        assert project.layoutManager().addLayout(layout)


def web_map(project, source="type=xyz&url=http://127.0.0.1:9/{z}/{x}/{y}.png&zmax=19", name="Web map"):
    layer = QgsRasterLayer(source, name, "wms")
    project.addMapLayer(layer)
    return layer


def test_the_web_map_that_is_seen_is_offered_first_with_its_credit(project):
    lines_of_a_map(project)
    hidden, seen = web_map(project, name="Hidden"), web_map(project)
    project.layerTreeRoot().findLayer(hidden.id()).setItemVisibilityChecked(False)
    metadata = seen.metadata()
    metadata.setRights(["© The survey office"])
    seen.setMetadata(metadata)
    dialog = LayoutDialog(project, road_maps(project))
    assert [dialog.below.itemText(row) for row in range(1, dialog.below.count())] == ["Web map", "Hidden"]
    assert dialog.choice["below"] == [seen] and dialog.choice["credit"] == "© The survey office"
    dialog.below.setCurrentIndex(0)
    assert dialog.choice["below"] == [] and dialog.choice["credit"] == ""


def test_a_layer_that_says_nothing_has_no_credit_and_one_of_openstreetmap_that_of_qgis(project):
    layer = web_map(project, "type=xyz&url=https://tile.openstreetmap.org/{z}/{x}/{y}.png&zmax=19")
    assert "OpenStreetMap" in credit_of(layer) and credit_of(web_map(project)) == ""


@pytest.mark.parametrize("credit", ["© The survey office", "© The survey office and its partners, " * 8])
def test_the_credit_stands_in_the_corner_of_the_map(project, credit):
    layout = road_map_layout(project, [street(project)], "A street", credit=credit)
    label, chart = layout.itemById("Credit"), item(layout, QgsLayoutItemMap)
    assert label.text() == credit and chart.sceneBoundingRect().contains(label.sceneBoundingRect())
    assert road_map_layout(project, [street(project)], "Without").itemById("Credit") is None


@pytest.mark.parametrize("text", ["[% env('HOME') %]", "[%env('HOME')%] [% '%' || 1 + 1 %]", "a [% b", "100 [%]", "[[%%]] %]"])
def test_names_of_others_are_printed_as_they_stand(project, tmp_path, text):
    """The name of a survey, a CRS or a layer may hold what QGIS would take for an expression."""
    edges = street(project)
    edges.setName(text)
    edges.setRenderer(QgsCategorizedSymbolRenderer("''", [QgsRendererCategory("", QgsLineSymbol.createSimple({}), text)]))
    wkt = edges.crs().toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT2_2019)
    edges.setCrs(QgsCoordinateReferenceSystem.fromWkt(wkt.replace("WGS 84 / UTM zone 50N", text).replace(",117,", ",117.25,")
                                                      .replace(',ID["EPSG",32650]', "").replace(',ID["EPSG",16050]', "")))
    layout = road_map_layout(project, [edges], text, credit=text)
    printed = [label.currentText() for label in layout.items() if isinstance(label, QgsLayoutItemLabel)]
    assert printed.count(text) == 3, "title, CRS and credit"
    settings = QgsLayoutExporter.SvgExportSettings()
    settings.textRenderFormat = Qgis.TextRenderFormat.AlwaysText
    QgsLayoutExporter(layout).exportToSvg(str(tmp_path / "page.svg"), settings)
    drawn = html.unescape((tmp_path / "page.svg").read_text(encoding="utf-8"))
    assert drawn.count(f">{text}<") == 5, "the names of the layer and of its class in the legend too"


def test_markup_in_a_field_is_shown_as_it_stands_in_a_map_tip(project):
    layer = QgsVectorLayer("LineString?crs=EPSG:32650&field=class:string&field=length_m:double", "Markings", "memory")
    explain_attributes(layer, "MARKINGS", ())
    feature = QgsFeature(layer.fields())
    feature["class"] = "<img src='http://localhost/'> & more"
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    context.setFeature(feature)
    said = QgsExpression.replaceExpressionText(layer.mapTipTemplate(), context)
    assert "<img" not in said and "&lt;img" in said and "&amp; more" in said


def classes(project, name, values, width=14, attribute="kind"):
    """A layer with a class for each of these values, of which the first two thirds have a feature."""
    layer = QgsVectorLayer("LineString?crs=EPSG:32650&field=kind:string", name, "memory")
    for y, value in enumerate(values[:2 * len(values) // 3]):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromWkt(f"LINESTRING(0 {y}, 100 {y})"))
        feature["kind"] = value
        layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    layer.setRenderer(QgsCategorizedSymbolRenderer(attribute, [
        QgsRendererCategory(value, QgsLineSymbol.createSimple({}), f"{value}, {'m' * width}") for value in values]))
    project.addMapLayer(layer)
    return layer


@pytest.mark.parametrize("attribute", ["kind", "concat(\"kind\", '')"])
def test_the_legend_lists_the_classes_that_there_are(project, attribute):
    layout = road_map_layout(project, [classes(project, "Lines", ["solid", "dashed", "none"], attribute=attribute)], "A street")
    model = item(layout, QgsLayoutItemLegend).model()
    nodes = model.layerLegendNodes(model.rootGroup().findLayers()[0])
    assert [str(node.data(Qt.ItemDataRole.DisplayRole)).partition(",")[0] for node in nodes] == ["solid", "dashed"]


@pytest.mark.parametrize("angle", [0, 45])
def test_a_legend_of_many_layers_stays_on_the_page(project, angle):
    layers = [street(project, angle)] + [classes(project, f"Layer {number}", [f"class {row}" for row in range(9)]) for number in range(6)]
    layout = road_map_layout(project, layers, "A street")
    legend, page = item(layout, QgsLayoutItemLegend), layout.pageCollection().page(0)
    QgsLayoutExporter(layout).renderPageToImage(0, dpi=60)  # QGIS sizes it anew when it is drawn
    x, y, width, height = legend.pos().x(), legend.pos().y(), legend.rect().width(), legend.rect().height()
    assert width > 100 and height > 20
    assert x + width <= page.pageSize().width() and y + height <= page.pageSize().height()
