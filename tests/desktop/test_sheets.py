"""The sheets of a road map: where they lie, what stands on them, and that they are written whole or not at all."""

import base64
import html
import math
import re
import resource

import numpy as np
import pytest
import shapely
from lanewright.algorithms.export import SheetSettings
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CROSS_SECTIONS, DRIVING_LINES, MARKING_LINES, ROAD_EDGES
from lanewright.core.common.progress import Progress
from lanewright.core.common.texts import language
from lanewright.desktop.layout.axes import OVERLAP, accuracy_of, axes_of, lines_of, road_line, road_lines, sheets_along
from lanewright.desktop.layout.drawing import profile_pages, section_pages
from lanewright.desktop.layout.sheets import BY_ITSELF, PAPERS, map_crs, sheet_layout, unused_name, write_pdf
from lanewright.desktop.menu import credit_of, sheet_values, shown_layers
from lanewright.processing_provider.results.road_maps import road_maps
from lanewright.processing_provider.styling import LOOKS, STYLES, apply_style, explain_attributes
from lanewright.processing_provider.texts import speak
from qgis import processing
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
    QgsLayoutItem,
    QgsLayoutItemLabel,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemPage,
    QgsLayoutItemPicture,
    QgsLineSymbol,
    QgsMapLayerLegendUtils,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsRasterLayer,
    QgsRendererCategory,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QImage
from road_map_layers import EAST, NORTH, added

# -- axes and sheets, of numbers alone ------------------------------------------------------------


def axes_of_layers(layers, project):
    """The axes that sheets of these layers follow."""
    return axes_of(road_lines(lines_of(layers, map_crs(list(layers.values()), project), project, 1.0)))


def line_of(course, offset, first, last, rank=0, height=100.0):
    """A line beside a course (function of station -> x, y, heading) from one station to another."""
    stations = np.linspace(first, last, max(int(last - first), 2) + 1)
    places = []
    for station in stations:
        x, y, heading = course(station)
        places.append((x - offset * math.sin(heading), y + offset * math.cos(heading), height + 0.02 * station - 0.025 * abs(offset)))
    return road_line(0, rank, np.array(places), first, last)


def straight(station):
    return 500_000.0 + station, 5_400_000.0, 0.0


def bend(radius):
    return lambda station: (radius * math.sin(station / radius), radius * (1 - math.cos(station / radius)), station / radius)


def winding(station):
    """Hairpins of 15 m between straights of 120 m."""
    leg, along = divmod(station, 120 + 15 * math.pi)
    way = 1 if leg % 2 == 0 else -1
    if along < 120:
        return (along if way > 0 else 120 - along), 30 * leg, 0.0 if way > 0 else math.pi
    angle = (along - 120) / 15
    return (120 if way > 0 else 0) + way * 15 * math.sin(angle), 30 * leg + 15 * (1 - math.cos(angle)), (0 if way > 0 else math.pi) + way * angle


def road(course, length, offsets=(-1.75, 1.75)):
    return axes_of([line_of(course, offset, 0, length) for offset in offsets])


COURSES = [(straight, 1000.0), (bend(300.0), 900.0), (bend(60.0), 330.0), (winding, 640.0)]


@pytest.mark.parametrize("course, length", COURSES)
@pytest.mark.parametrize("width, height", [(135.0, 69.0), (69.0, 110.0)])
def test_every_metre_of_the_road_lies_on_a_sheet_and_on_the_part_of_it_between_its_match_lines(course, length, width, height):
    axes = road(course, length)
    sheets = sheets_along(axes, width, height)
    course = shapely.LineString(axes[0].places[:, :2])
    assert course.difference(shapely.union_all([sheet.outline() for sheet in sheets])).length < 0.01
    assert len(sheets) < 3 * length / width + 2


@pytest.mark.parametrize("course, length", COURSES)
def test_neighbours_overlap_and_their_match_lines_name_each_other(course, length):
    sheets = sheets_along(road(course, length), 135.0, 69.0)
    by_number = {sheet.number: sheet for sheet in sheets}
    assert len(sheets) > 1
    for sheet in sheets:
        for match in sheet.matches:
            other, place = by_number[match.neighbour], shapely.Point(match.x, match.y)
            assert any(back.neighbour == sheet.number and math.hypot(back.x - match.x, back.y - match.y) < 1e-6 for back in other.matches)
            for one in (sheet, other):
                assert one.outline().exterior.distance(place) > 0.9 * OVERLAP / 2 * one.width * 0.5 and one.outline().covers(place)
    for before, after in zip(sheets, sheets[1:]):
        assert after.number in [match.neighbour for match in before.matches]


def test_the_road_runs_from_left_to_right_on_every_sheet():
    axis, = road(winding, 640.0)
    for sheet in sheets_along([axis], 135.0, 69.0):
        on = sheet.on_page(axis.places)
        shown = on[(on > 0).all(axis=1) & (on < (135.0, 69.0)).all(axis=1)]
        assert len(shown) > 5
        first, last = (next((m for m in sheet.matches if m.neighbour == sheet.number + step), None) for step in (-1, 1))
        if first and last:
            (x, _), (x2, _) = sheet.on_page(np.array([[first.x, first.y], [last.x, last.y]]))
            assert x < x2


def test_a_road_that_meets_another_has_a_match_line_with_it():
    side = [road_line(1, 0, np.c_[np.full(200, 500.0), np.arange(200.0), np.zeros(200)], 0.0, 199.0)]
    main = [road_line(0, 0, np.c_[np.arange(1000.0), np.zeros(1000), np.zeros(1000)], 0.0, 999.0)]
    sheets = sheets_along(axes_of(main + side), 135.0, 69.0)
    first_of_side = next(sheet for sheet in sheets if sheet.y > 50)
    assert any(sheets[match.neighbour - 1].y < 5 for match in first_of_side.matches)


def test_two_carriageways_side_by_side_are_shown_together():
    carriageways = [road_line(k, 0, np.c_[np.arange(300.0), np.full(300, 18.0 * k), np.zeros(300)], 0.0, 299.0) for k in (0, 1)]
    for sheet in sheets_along(axes_of(carriageways), 135.0, 69.0):
        assert abs(sheet.y - 9.0) < 0.1


def test_the_axis_is_not_moved_by_a_lane_that_begins():
    lanes = [line_of(straight, 1.75, 0, 400), line_of(straight, -1.75, 0, 400), line_of(straight, -5.25, 200, 400)]
    axis, = axes_of(lanes)
    turned = np.abs(np.diff(axis.places[:, 1])) / np.diff(axis.places[:, 0])
    assert turned.max() < 0.02 and abs(axis.places[5, 1] - 5_400_000.0) < 0.3 and abs(axis.places[-5, 1] - 5_399_998.25) < 0.3


@pytest.mark.parametrize("course, length", COURSES)
def test_the_axis_lies_amid_the_lanes_at_their_stations_and_height(course, length):
    axis, = road(course, length)
    for station in np.arange(20.0, length - 20.0, 7.0):
        place = axis.at(np.array([station]))[0]
        x, y, _ = course(station)
        assert math.hypot(place[0] - x, place[1] - y) < 1.0   # stations run evenly along each line, so in a hairpin those of two lines differ
        assert abs(place[2] - (100.0 + 0.02 * station - 0.025 * 1.75)) < 0.02


def test_the_axis_crosses_a_junction_straight_where_edges_turn_around_its_corners():
    corner = [(140, -8), (145, -9), (148, -12), (149, -16), (149.5, -20)]
    lanes = [line_of(straight, offset, *ends) for offset in (-1.75, 1.75) for ends in ((0, 140), (175, 400))]
    edge = road_line(0, 2, np.array([(500_000.0 + x, 5_400_000.0 + y, 100.0) for x, y in corner]), 138.0, 154.0)
    axis, = axes_of(lanes + [edge])
    assert np.abs(axis.places[:, 1] - 5_400_000.0).max() < 0.05 and axis.length > 395


def test_the_axis_does_not_fold_where_a_lane_ends_and_an_edge_comes_around_a_corner():
    lane = line_of(lambda s: (s * math.cos(1.1), -s * math.sin(1.1), -1.1), 0.0, 0, 7)
    corner = [(2.0, -14.5), (2.3, -13.0), (3.5, -11.8), (6.0, -11.6), *((x, -11.6 - 0.35 * (x - 6)) for x in np.arange(8.0, 70.0, 2.0))]
    edge = road_line(0, 2, np.array([(x, y, 100.0) for x, y in corner]), 11.0, 80.0)
    axis, = axes_of([lane, edge])
    turned = np.abs(np.diff([axis.heading(station) for station in axis.stations]))
    assert turned.max() < 1 / 5.0, turned.max()


def test_no_match_line_runs_through_a_junction():
    arm = [road_line(1, 0, np.c_[np.full(60, 100.0 + offset), np.arange(8.0, 68.0), np.zeros(60)], 0.0, 59.0) for offset in (-3.0, 3.0)]
    main = [road_line(0, 0, np.c_[np.arange(201.0), np.full(201, offset), np.zeros(201)], 0.0, 200.0) for offset in (-3.0, 3.0)]
    sheets = sheets_along(axes_of(main + arm), 120.0, 69.0)
    along = [match.x for sheet in sheets for match in sheet.matches if abs(match.y) < 1]
    assert along and all(abs(x - 100) > 8 for x in along)
    assert len([sheet for sheet in sheets if abs(sheet.y) < 20]) == 2


def test_pieces_of_a_line_that_know_no_road_lead_one_axis_along_all_of_them(project):
    """Lines that were divided by outcome: each has stations of its own."""
    pieces = [(f"LINESTRING Z ({first} 0 100, {last} 0 100)", dict(lane=1)) for first, last in ((0, 24), (24, 30), (30, 118))]
    axis, = axes_of_layers({"BY_OUTCOME": added(project, "BY_OUTCOME", DRIVING_LINES, *pieces)}, project)
    assert axis.length == pytest.approx(118.0, abs=1.0)


def test_lines_against_or_across_the_road_do_not_lead_its_axis(project):
    against = "LINESTRING Z (200 2 100, 0 2 100)", dict(road=0, direction=-1, station_m=0.0, end_m=200.0)
    across = "LINESTRING Z (100 -30 100, 100 30 100)", dict(road=0, direction=1, station_m=95.0, end_m=105.0)
    axis, = axes_of_layers({"DRIVING_LINES": added(project, "DRIVING_LINES", DRIVING_LINES, against, across)}, project)
    assert axis.places[-1, 0] > axis.places[0, 0] and np.ptp(axis.places[:, 1]) < 1e-6


# -- the pages ------------------------------------------------------------------------------------


def street(project, angle=0.0, length=100):
    """Two edges of a street of 10 m width, turned clockwise by so many degrees."""
    rows = []
    for y, side in ((10, "left"), (0, "right")):
        geometry = QgsGeometry.fromWkt(f"LINESTRING Z (0 {y} 100, {length} {y} {100 + 0.02 * length})")
        geometry.rotate(angle, QgsGeometry.fromWkt("POINT(0 0)").asPoint())
        rows.append((geometry.asWkt(6), dict(road=0, side=side, station_m=0.0, end_m=float(length), height_m=0.12, sigma_m=0.014)))
    return added(project, "ROAD_EDGES", ROAD_EDGES, *rows)


def made(project, layer, below=None, **chosen):
    """The layout of a street, and its numbers."""
    settings = SheetSettings(**{"title": "A street", "profile": False, "section_interval": 0.0, **chosen})
    return sheet_layout(project, {"ROAD_EDGES": layer}, settings, below)


def items(layout, kind):
    return [found for found in layout.items() if isinstance(found, kind)]


def item(layout, kind, name=""):
    return next(found for found in items(layout, kind) if not name or found.id() == name)


def texts(layout):
    return [label.currentText() for label in items(layout, QgsLayoutItemLabel)]


@pytest.mark.parametrize("angle", [0, 30, 90, 145])
def test_the_road_lies_along_the_page_and_north_is_shown_turned_with_it_and_off_the_map(project, angle):
    layout, _ = made(project, street(project, angle))
    chart, arrow = item(layout, QgsLayoutItemMap), item(layout, QgsLayoutItemPicture, "North")
    assert abs((chart.mapRotation() + angle + 180) % 360 - 180) < 1
    assert not arrow.isMissingImage() and abs((arrow.pictureRotation() - chart.mapRotation() + 180) % 360 - 180) < 0.01
    assert not arrow.sceneBoundingRect().intersects(chart.sceneBoundingRect())


@pytest.mark.parametrize("paper, orientation", [("A4", "landscape"), ("A4", "portrait"), ("A3", "portrait"), ("A0", "landscape")])
def test_every_page_is_a_sheet_of_the_paper_and_the_scale_a_round_number(project, paper, orientation):
    layout, numbers = made(project, street(project, length=300), paper=paper, orientation=orientation)
    sizes = {(round(page.pageSize().width()), round(page.pageSize().height())) for page in layout.pageCollection().pages()}
    assert sizes == {PAPERS[paper] if orientation == "landscape" else PAPERS[paper][::-1]}
    assert numbers["SCALE_NUMBER"] in BY_ITSELF and numbers["SHEETS"] <= 20
    sheets = [chart for chart in items(layout, QgsLayoutItemMap) if round(chart.scale(), 3) == numbers["SCALE_NUMBER"]]
    assert len(sheets) >= numbers["SHEETS"]
    for found in layout.items():   # nothing stands beyond its page
        if isinstance(found, QgsLayoutItem) and not isinstance(found, QgsLayoutItemPage):
            page = layout.pageCollection().page(found.page()).sceneBoundingRect()
            assert page.adjusted(-0.5, -0.5, 0.5, 0.5).contains(found.sceneBoundingRect()), found.displayName()


def test_a_chosen_scale_is_kept_and_one_that_gives_too_many_sheets_refused(project):
    _, numbers = made(project, street(project, length=100), scale="1:100", paper="A4")
    assert numbers["SCALE_NUMBER"] == 100 and numbers["SHEETS"] == 5
    with pytest.raises(RoadExtractionError, match="more than 500 sheets"):
        made(project, street(project, length=14_000), scale="1:100", paper="A4")


def inked(layout, chart):
    """Share of the pixels of a map that are not white."""
    image = QgsLayoutExporter(layout).renderPageToImage(chart.page(), dpi=60).convertToFormat(QImage.Format.Format_Grayscale8)
    per_mm = image.width() / layout.pageCollection().page(chart.page()).pageSize().width()
    grey = np.frombuffer(image.constBits().asstring(image.sizeInBytes()), np.uint8).reshape(image.height(), image.bytesPerLine())
    left, top = chart.pagePos().x() * per_mm, chart.pagePos().y() * per_mm
    width, height = chart.rect().width() * per_mm, chart.rect().height() * per_mm
    return (grey[int(top + 0.2 * height):int(top + 0.8 * height), int(left + 0.1 * width):int(left + 0.9 * width)] < 230).mean()


@pytest.mark.parametrize("shown_in", ["EPSG:32650", "EPSG:3857", "EPSG:4326"])
def test_the_map_shows_the_road_whatever_crs_the_project_has(project, shown_in):
    project.setCrs(QgsCoordinateReferenceSystem(shown_in))
    layout, _ = made(project, street(project))
    chart = item(layout, QgsLayoutItemMap)
    assert chart.crs().authid() == "EPSG:32650" and inked(layout, chart) > 0.001


def test_the_title_block_says_what_was_chosen_and_what_the_layers_know(project):
    edges = street(project, length=300)
    layout, numbers = made(project, edges, title="Umfahrung", office="Amt", author="E. Muster", heights="DHHN2016", scale="1:250", paper="A4")
    printed = texts(layout)
    for text in ("Umfahrung", "Amt", "E. Muster", "DHHN2016", "1 : 250", "EPSG:32650 - WGS 84 / UTM zone 50N", "A4", "road edges 1.4 cm"):
        assert text in printed, text
    count = int(numbers["SHEETS"])
    assert [f"{number} of {count}" for number in range(1, count + 1)] == sorted(text for text in printed if " of " in text)
    assert accuracy_of({"ROAD_EDGES": edges}) == "road edges 1.4 cm"


def test_profile_and_cross_sections_are_further_pages(project):
    plan, numbers = made(project, street(project))
    layout, more = made(project, street(project), profile=True, section_interval=20.0)
    assert more["PAGES"] == numbers["PAGES"] + 2 and more["SHEETS"] == numbers["SHEETS"]
    assert {"Longitudinal profile", "Cross-sections"} <= set(texts(layout)) and "Cross-sections" not in texts(plan)


def test_a_short_profile_and_few_sections_share_a_page(project):
    plan, numbers = made(project, street(project), paper="A2")
    layout, more = made(project, street(project), paper="A2", profile=True, section_interval=50.0)
    assert more["PAGES"] == numbers["PAGES"] + 1 and "Longitudinal profile, Cross-sections" in texts(layout)


def printed(layout):
    """All that is drawn on the pages, as text."""
    pictures = [picture.picturePath() for picture in items(layout, QgsLayoutItemPicture)]
    return "".join(base64.b64decode(path.partition(":")[2]).decode() for path in pictures if path.startswith("base64:"))


@pytest.mark.parametrize("height, scale, told", [(0.12, "1:250", True), (0.12, "1:1000", False), (0.0, "1:250", False)])
def test_the_sheet_explains_the_figures_that_stand_on_it_alone(project, height, scale, told):
    rows = [("LINESTRING Z (0 0 100, 100 0 100)", dict(road=0, side="left", station_m=0.0, end_m=100.0, length_m=100.0, height_m=height,
                                                         edge="curb"))]
    layer = added(project, "ROAD_EDGES", ROAD_EDGES, *rows)
    apply_style(layer, STYLES / "road_edges.qml", ROAD_EDGES, "ROAD_EDGES")
    said = printed(made(project, layer, scale=scale)[0])
    assert ("Height of the curb" in said) == told and "Axis with stations" in said and "Radius" not in said


@pytest.mark.parametrize("length, on, told", [(60, True, True), (60, False, False), (6, True, False)])
def test_figures_that_are_switched_off_or_find_no_room_are_not_explained(project, length, on, told):
    layer = added(project, "DRIVING_LINES", DRIVING_LINES, *[(f"LINESTRING Z (0 {aside} 100, {length} {aside} 100)", dict(
        road=0, lane=1, direction=1, status="measured", station_m=0.0, end_m=length, length_m=length, radius_m=85.0)) for aside in (0, 1)])
    apply_style(layer, STYLES / "driving_lines.qml", DRIVING_LINES, "DRIVING_LINES")
    layer.setLabelsEnabled(on)
    settings = SheetSettings(title="A street", profile=False, section_interval=0.0, scale="1:1000")
    assert ("Radius" in printed(sheet_layout(project, {"DRIVING_LINES": layer}, settings)[0])) == told


def test_the_rest_of_an_arm_lies_at_the_side_of_its_sheet_which_shows_the_junction():
    main = [road_line(0, 0, np.c_[np.arange(201.0), np.full(201, offset), np.zeros(201)], 0.0, 200.0) for offset in (-3.0, 3.0)]
    arm = [road_line(1, 0, np.c_[np.full(60, 100.0 + offset), np.arange(8.0, 68.0), np.zeros(60)], 0.0, 59.0) for offset in (-3.0, 3.0)]
    sheets = sheets_along(axes_of(main + arm), 120.0, 69.0)
    rest = next(sheet for sheet in sheets if abs(sheet.heading - math.pi / 2) < 0.1)
    assert rest.outline().buffer(1.0).covers(shapely.box(90, 0, 110, 67)), "from the road that it leaves to its end"
    assert all(sheet.outline().area == pytest.approx(120 * 69) for sheet in sheets)


def test_numbers_on_a_german_sheet_have_a_comma(project):
    speak("de")
    try:
        layout, _ = made(project, street(project), scale="1:500", profile=True)
    finally:
        speak("en")
    assert ">101,00<" in printed(layout) and ">+2,00 % / 100 m<" in printed(layout) and any("1,4 cm" in text for text in texts(layout))


def said(drawing):
    """What a drawing says, and how often it draws a line of each colour."""
    return base64.b64decode(drawing.path().partition(":")[2]).decode()


def test_heights_and_gradient_stand_at_their_stations_in_the_profile(project):
    axes = axes_of_layers({"ROAD_EDGES": street(project)}, project)
    (drawing, scale), = profile_pages(axes, 271.0, 130.0, 250, 1)
    assert all(f">{text}<" in said(drawing) for text in ("+2.00 % / 100 m", "101.00", "0+050", "0+000 – 0+100"))
    assert scale == "lengths 1 : 500, heights 1 : 50"


def test_a_cross_section_shows_the_edges_the_step_of_the_curb_and_the_ground_between(project):
    layers = {"ROAD_EDGES": street(project)}
    axes = axes_of_layers(layers, project)
    x, y = EAST + 50.0, NORTH
    ground = np.array([(x + along, y + across, 101.0 + 0.03 * across) for along in (-0.1, 0.0, 0.1) for across in np.arange(0.3, 9.7, 0.02)])
    (drawing, scale), = section_pages(axes, lines_of(layers, layers["ROAD_EDGES"].crs(), project, 1.0), [ground], 50.0, 271.0, 130.0)
    assert said(drawing).count(">101.00<") == 2 and said(drawing).count('stroke="#e31a1c" stroke-width="0.5"') == 6, "two edges at three stations"
    slope = max(re.findall(r'd="M([^"]*)" fill="none" stroke="#202020"', said(drawing)), key=len)
    places = np.array([place.split() for place in slope.split("L")], float)
    assert scale == "offsets 1 : 100, heights 1 : 20"
    assert np.polyfit(*places.T, 1)[0] == pytest.approx(0.03 * 5, rel=0.02), "left of the road, which is higher, is on the left of the page"


def test_the_pages_of_sections_show_those_of_a_layer_with_the_limits_that_are_not_kept(project):
    sections = [(f"LINESTRING Z ({at} 10 101, {at} 5 100.9, {at} 0 101)", dict(road=0, section=at, station_m=float(at), part="carriageway", why=why))
                for at, why in ((12, None), (25, "grade 9.1 > 8 % [RAL 2012]; clearance 3.10 < 4.5 m [RAL 2012]"), (40, None), (52, None))]
    layers = {"ROAD_EDGES": street(project), "CROSS_SECTIONS": added(project, "CROSS_SECTIONS", CROSS_SECTIONS, *sections)}
    axes = axes_of_layers({"ROAD_EDGES": layers["ROAD_EDGES"]}, project)
    (drawing, _), = section_pages(axes, lines_of(layers, layers["ROAD_EDGES"].crs(), project, 1.0), [], 20.0, 271.0, 200.0)
    shown = re.findall(r">(0\+\d+)<", said(drawing))
    assert shown == ["0+012", "0+025", "0+052"], "20 m apart, and where a limit is not kept"
    assert ">carriageway: grade 9.1 &gt; 8 % [RAL 2012]<" in said(drawing) and "clearance 3.10 &lt; 4.5 m" in said(drawing)


def test_a_layer_below_is_drawn_last_and_is_not_in_the_legend(project):
    edges, below = street(project), street(project)
    layout, _ = made(project, edges, below)
    assert item(layout, QgsLayoutItemMap).layers() == [edges, below]
    assert len(item(layout, QgsLayoutItemLegend).model().rootGroup().findLayers()) == 1


def lines_of_a_map(project):
    return [added(project, output, schema, ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0)))
            for output, schema in (("ROAD_EDGES", ROAD_EDGES), ("DRIVING_LINES", DRIVING_LINES))]


def web_map(project, source="type=xyz&url=http://127.0.0.1:9/{z}/{x}/{y}.png&zmax=19", name="Web map"):
    layer = QgsRasterLayer(source, name, "wms")
    project.addMapLayer(layer)
    return layer


def test_layers_that_are_switched_off_are_not_printed_and_the_web_map_that_is_seen_lies_below_with_its_credit(project):
    edges, lanes = lines_of_a_map(project)
    project.layerTreeRoot().findLayer(lanes.id()).setItemVisibilityChecked(False)
    hidden, seen = web_map(project, name="Hidden"), web_map(project)
    project.layerTreeRoot().findLayer(hidden.id()).setItemVisibilityChecked(False)
    metadata = seen.metadata()
    metadata.setRights(["© The survey office"])
    seen.setMetadata(metadata)
    maps = road_maps(project)
    values = sheet_values(maps[0], maps, project)
    assert values["ROAD_EDGES"] == edges.id() and values["DRIVING_LINES"] is None and values["TITLE"].startswith("B12")
    assert values["BELOW"] == seen.id() and values["CREDIT"] == "© The survey office"
    assert shown_layers(maps[0], project, hidden=True) == [lanes, edges]


def test_a_layer_that_says_nothing_has_no_credit_and_one_of_openstreetmap_that_of_qgis(project):
    layer = web_map(project, "type=xyz&url=https://tile.openstreetmap.org/{z}/{x}/{y}.png&zmax=19")
    assert "OpenStreetMap" in credit_of(layer) and credit_of(web_map(project)) == ""


@pytest.mark.parametrize("credit", ["© The survey office", "© The survey office and its partners, " * 8])
def test_the_credit_stands_in_the_corner_of_the_map(project, credit):
    layout, _ = made(project, street(project), credit=credit)
    label, chart = layout.itemById("Credit"), item(layout, QgsLayoutItemMap)
    assert label.text() == credit and chart.sceneBoundingRect().contains(label.sceneBoundingRect())
    assert made(project, street(project))[0].itemById("Credit") is None


@pytest.mark.parametrize("text", ["[% env('HOME') %]", "[%env('HOME')%] [% '%' || 1 + 1 %]", "a [% b", "100 [%]", "[[%%]] %]", "<b>&amp;</b>"])
def test_texts_of_others_are_printed_as_they_stand(project, tmp_path, text):
    """The title, a CRS or the name of a layer may hold what QGIS would take for an expression."""
    edges = street(project)
    edges.setName(text)
    edges.setRenderer(QgsCategorizedSymbolRenderer("''", [QgsRendererCategory("", QgsLineSymbol.createSimple({}), text)]))
    wkt = edges.crs().toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT2_2019)
    edges.setCrs(QgsCoordinateReferenceSystem.fromWkt(wkt.replace("WGS 84 / UTM zone 50N", text).replace(",117,", ",117.25,")
                                                      .replace(',ID["EPSG",32650]', "").replace(',ID["EPSG",16050]', "")))
    layout, _ = made(project, edges, title=text, office=text, author=text, heights=text, credit=text)
    printed = [label.currentText() for label in items(layout, QgsLayoutItemLabel) if label.page() == 0]
    assert printed.count(text) == 6, "project, office, author, heights, CRS and credit"
    settings = QgsLayoutExporter.SvgExportSettings()
    settings.textRenderFormat = Qgis.TextRenderFormat.AlwaysText
    QgsLayoutExporter(layout).exportToSvg(str(tmp_path / "page.svg"), settings)
    drawn = html.unescape((tmp_path / "page.svg").read_text(encoding="utf-8"))
    assert drawn.count(f">{text}<") == 8, "the names of the layer and of its class in the legend too"


# -- the run --------------------------------------------------------------------------------------


def run(layer, path, feedback=None, **values):
    context = QgsProcessingContext()
    return processing.run("lanewright:printsheets", {"ROAD_EDGES": layer, "OUTPUT": str(path), "PAPER": "A4", **values}, context=context,
                          feedback=feedback or QgsProcessingFeedback())


def test_a_run_writes_one_pdf_of_all_pages_and_speaks_the_chosen_language(project, provider, tmp_path):
    results = run(street(project), tmp_path / "plan.pdf", TITLE="Plan", LANGUAGE="de")
    data = (tmp_path / "plan.pdf").read_bytes()
    assert data.startswith(b"%PDF") and data.count(b"/Type /Page\n") == results["PAGES"] >= 3
    assert language() == "en"


def test_a_run_that_is_cancelled_leaves_the_pdf_of_before(project, provider, tmp_path):
    (tmp_path / "plan.pdf").write_bytes(b"of before")
    feedback = QgsProcessingFeedback()
    feedback.progressChanged.connect(lambda progress: feedback.cancel() if progress > 30 else None)
    with pytest.raises(QgsProcessingException, match="Cancelled"):
        run(street(project, length=300), tmp_path / "plan.pdf", feedback)
    assert [path.name for path in tmp_path.iterdir()] == ["plan.pdf"] and (tmp_path / "plan.pdf").read_bytes() == b"of before"


def test_without_lines_along_a_road_one_sentence_says_what_to_give(project, provider, tmp_path):
    with pytest.raises(QgsProcessingException, match="No line of the layers runs along a road"):
        run(added(project, "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (0 0 1, 2 0 1)", dict(road=0))), tmp_path / "plan.pdf")
    assert not list(tmp_path.iterdir())


def test_a_second_layout_gets_a_name_of_its_own(project):
    for expected in ("Lanewright – B12", "Lanewright – B12 2", "Lanewright – B12 3"):
        name = unused_name(project, "Lanewright – B12")
        assert name == expected
        layout, _ = made(project, street(project), title=name)
        assert project.layoutManager().addLayout(layout)


def test_a_pdf_that_cannot_be_written_is_one_sentence(project, tmp_path):
    layout, _ = made(project, street(project))
    with pytest.raises(RoadExtractionError, match="cannot be written"):
        write_pdf(layout, str(tmp_path / "nowhere" / "plan.pdf"), Progress())


def test_a_pdf_for_which_the_disk_has_no_room_is_one_sentence(project, tmp_path):
    layout, _ = made(project, street(project))
    allowed = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, allowed[1]))
    try:
        with pytest.raises(RoadExtractionError, match="free some space"):
            write_pdf(layout, str(tmp_path / "plan.pdf"), Progress())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, allowed)


def test_markup_in_a_field_is_shown_as_it_stands_in_a_map_tip(project):
    layer = QgsVectorLayer("LineString?crs=EPSG:32650&field=class:string&field=length_m:double", "Markings", "memory")
    explain_attributes(layer, "MARKINGS", ())
    feature = QgsFeature(layer.fields())
    feature["class"] = "<img src='http://localhost/'> & more"
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    context.setFeature(feature)
    said = QgsExpression.replaceExpressionText(layer.mapTipTemplate(), context)
    assert "<img" not in said and "&lt;img" in said and "&amp; more" in said


PLAN = SheetSettings("A street", profile=False, section_interval=0.0)


def test_white_paint_lies_on_asphalt_in_the_legend_and_other_symbols_on_paper(project):
    paint = ("LINESTRING Z (0 5 100, 100 5 102)", dict(road=0, pattern="solid", status="measured", width_m=0.12))
    layers = {"ROAD_EDGES": street(project), "MARKING_LINES": added(project, "MARKING_LINES", MARKING_LINES, paint)}
    for name, layer in layers.items():
        apply_style(layer, STYLES / f"{LOOKS[name][0]}.qml")
    layout, _ = sheet_layout(project, layers, PLAN)
    model = item(layout, QgsLayoutItemLegend).model()
    grounds = {}
    for node in model.rootGroup().findLayers():
        shown = [QgsMapLayerLegendUtils.legendNodeCustomSymbol(node, row) for row, _ in enumerate(model.layerOriginalLegendNodes(node))]
        grounds[node.layer().name()] = {symbol.symbolLayer(0).color().name() for symbol in shown}
    assert grounds["MARKING_LINES"] == {"#8d9299"} and "#8d9299" not in grounds["ROAD_EDGES"], grounds


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
    layout, _ = sheet_layout(project, {"LINES": classes(project, "Lines", ["solid", "dashed", "none"], attribute=attribute)}, PLAN)
    model = item(layout, QgsLayoutItemLegend).model()
    nodes = model.layerLegendNodes(model.rootGroup().findLayers()[0])
    assert [str(node.data(Qt.ItemDataRole.DisplayRole)).partition(",")[0] for node in nodes] == ["solid", "dashed"]


def test_the_legend_says_nothing_of_a_layer_without_features(project):
    empty = added(project, "MARKING_LINES", MARKING_LINES)
    layout, _ = sheet_layout(project, {"ROAD_EDGES": street(project), "MARKING_LINES": empty}, PLAN)
    model = item(layout, QgsLayoutItemLegend).model()
    assert empty.name() not in [node.layer().name() for node in model.rootGroup().findLayers()]


@pytest.mark.parametrize("angle", [0, 45])
def test_a_legend_of_many_layers_stays_on_the_page(project, angle):
    layers = [street(project, angle)] + [classes(project, f"Layer {number}", [f"class {row}" for row in range(9)]) for number in range(6)]
    layout, _ = sheet_layout(project, {("ROAD_EDGES" if not k else f"L{k}"): layer for k, layer in enumerate(layers)}, PLAN)
    legend, page = item(layout, QgsLayoutItemLegend), layout.pageCollection().page(0)
    QgsLayoutExporter(layout).renderPageToImage(0, dpi=60)  # QGIS sizes it anew when it is drawn
    x, y, width, height = legend.pos().x(), legend.pos().y(), legend.rect().width(), legend.rect().height()
    assert width > 100 and height > 20
    assert x + width <= page.pageSize().width() and y + height <= page.pageSize().height()
