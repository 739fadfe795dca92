"""The cross-section of a road, and the doubtful places along it."""

import numpy as np
import pytest
from lanewright.core.common.features import CURB_POINTS, DRIVING_LINES, ROAD_EDGES
from lanewright.core.road.scanlines.section_planes import slice_lines
from lanewright.desktop.review import section_dock
from lanewright.desktop.review.doubtful import doubts_of, reason
from lanewright.desktop.review.section import Crossing, Section, corners, crossings, middle_of, section_at
from lanewright.desktop.review.section_dock import SectionView
from lanewright.processing_provider.results.road_maps import road_maps
from qgis.PyQt.QtGui import QFontMetricsF
from road_map_layers import EAST, NORTH, added


def road(project):
    """A road to the north-east: a lane in its middle, an edge 4 m to the left, at a height of 100 m."""
    lane = added(project, "DRIVING_LINES", DRIVING_LINES, ("LINESTRING Z (0 0 100, 70.7107 70.7107 100)", dict(lane=1, direction=1, length_m=100.0)))
    edge = added(project, "ROAD_EDGES", ROAD_EDGES,
                 ("LINESTRING Z (-2.8284 2.8284 100.12, 67.8823 73.5391 100.12)", dict(road=0, side="left", length_m=100.0, status="measured")))
    return [lane, edge]


def test_the_section_lies_across_the_road_and_left_is_positive(project):
    section = section_at(EAST + 30, NORTH + 30, road(project))
    assert section.azimuth == pytest.approx(45.0, abs=0.1)
    west, east = section.line().asPolyline()
    assert west.x() < east.x() and west.y() > east.y()
    assert section.offset(west.x(), west.y()) == pytest.approx(20.0)
    assert section.moved(10.0) == pytest.approx((EAST + 30 + 7.071, NORTH + 30 + 7.071), abs=0.02)


def test_left_is_left_of_the_road_on_a_lane_against_it_too(project):
    lane = added(project, "DRIVING_LINES", DRIVING_LINES, ("LINESTRING Z (70.7107 70.7107 100, 0 0 100)", dict(lane=2, direction=-1, length_m=100.0)))
    section = section_at(EAST + 30, NORTH + 30, [lane])
    assert section.azimuth == pytest.approx(45.0, abs=0.1) and section.offset(EAST + 20, NORTH + 40) > 0


def test_lines_cross_it_at_their_offset_and_height_and_say_what_they_are(project):
    layers = road(project)
    left, middle = crossings(section_at(EAST + 30, NORTH + 30, layers), layers)
    assert (left.offset, left.z) == pytest.approx((4.0, 100.12), abs=0.01) and left.title.startswith("Road edge, left")
    assert (middle.offset, middle.z) == pytest.approx((0.0, 100.0), abs=0.01) and middle.title.startswith("Lane 1")


@pytest.mark.parametrize("azimuth", [0.0, 33.0, 71.0])
def test_a_line_that_was_drawn_up_to_the_section_crosses_it(project, azimuth):
    section = Section(EAST, NORTH, azimuth)
    (x, y), (ahead, north) = 5 * np.array(section.left), section.ahead
    line = f"LINESTRING Z ({x - 4 * ahead} {y - 4 * north} 100, {x - 1e-4 * ahead} {y - 1e-4 * north} 101)"
    edges = added(project, "ROAD_EDGES", ROAD_EDGES, (line, dict(road=0, side="left", status="drawn")))
    crossing, = crossings(section, [edges])
    assert (crossing.offset, crossing.z) == pytest.approx((5.0, 101.0), abs=0.01)


def test_far_from_any_road_there_is_no_section(project):
    assert section_at(EAST + 900, NORTH, road(project)) is None


def test_only_points_of_the_slice_are_shown(qgis_app):
    section = Section(EAST, NORTH, 0.0)
    points = np.array([[EAST - 3, NORTH, 100.0, 7], [EAST - 3, NORTH + 0.4, 100.0, 7], [EAST + 50, NORTH, 100.0, 7]])
    np.testing.assert_allclose(section.cut(points, 0.3), [[3.0, 100.0, 7.0]])
    assert len(section.cut(points, 1.0)) == 2


def test_the_picture_shows_points_on_their_side(qgis_app):
    """Points 3 m to the left, and none to the right."""
    view = SectionView()
    view.resize(600, 300)
    z = np.linspace(100.0, 100.5, 400)
    view.show_section(np.c_[np.full(400, 3.0), z, np.zeros(400)], [])
    image = view.grab().toImage()
    dark = [x for x in range(60, 580) for y in range(25, 250, 3) if image.pixelColor(x, y).lightness() < 100]
    assert dark and max(dark) < 300


def test_a_curb_has_a_bottom_and_a_top_and_an_edge_of_the_pavement_none(project):
    row = dict(road=0, part="bottom", height_m=0.12, length_m=20.0)
    edges = added(project, "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (-3 -10 100, -3 10 100)", {**row, "side": "left", "edge": "curb"}),
                  ("LINESTRING Z (3 -10 100, 3 10 100)", {**row, "side": "right", "edge": "pavement"}))
    curb, pavement = crossings(Section(EAST, NORTH, 0.0), [edges])
    assert curb.top == pytest.approx(100.12) and np.isnan(pavement.top)
    assert middle_of([curb, pavement]) == pytest.approx(0.0)


def test_corners_of_curbs_near_the_section_are_shown(project):
    points = added(project, "CURB_POINTS", CURB_POINTS, ("POINT Z (-3 0.2 100)", dict(part="bottom")),
                   ("POINT Z (-3.02 0.2 100.12)", dict(part="top")),
                   ("POINT Z (-3 4 100)", dict(part="bottom")), kind="PointZ")
    found = corners(Section(EAST, NORTH, 0.0), [points])
    assert sorted((round(offset, 2), round(z, 2), part) for offset, z, part in found) == [(3.0, 100.0, "bottom"), (3.02, 100.12, "top")]


def test_the_scanline_follows_road_face_and_sidewalk_and_is_cut_behind_a_car():
    """A curb of 12 cm at 3 m; nothing seen between -2 and -1 m; a branch above."""
    d = np.arange(-5, 5, 0.004)
    d = d[(d < -2) | (d > -1)]
    z = np.where(d > 3, 100.12, 100.0) + np.random.default_rng(1).normal(0, 0.002, len(d))
    lines = slice_lines(np.r_[d, 1.0], np.r_[z, 102.0], 20.0)
    assert len(lines) == 2 and lines[0][-1, 0] < -1.9 and lines[1][0, 0] > -1.1
    across, height = lines[1].T
    assert (np.diff(across) > 0).all() and height.max() < 100.2
    np.testing.assert_allclose(height[across < 2.9], 100.0, atol=0.01)
    np.testing.assert_allclose(height[across > 3.1], 100.12, atol=0.01)
    assert slice_lines(np.empty(0), np.empty(0), 20.0) == []


@pytest.mark.parametrize("height", [200, 250, 400])
def test_titles_of_many_lines_stay_above_the_road_and_are_short_where_room_is_scarce(qgis_app, height):
    view = SectionView()
    view.resize(620, height)
    shown = [Crossing(offset, 100.0, "Fahrstreifen 2, gegen die Straße, 88 m, gemessen, ± 13 mm", "#e31a1c") for offset in np.linspace(2.2, -7.8, 9)]
    view.show_section(np.empty((0, 3)), shown)
    boxes = view._label_boxes(view._shown(), view._frame(), QFontMetricsF(view._small(), view))
    assert max(box.bottom() for box in boxes) <= view._at(0.0, 100.0)[1] + 1.0
    assert {crossing.title for crossing in view._shown()} == {shown[0].title if height == 400 else "Fahrstreifen 2"}


def test_titles_of_lines_cover_neither_each_other_nor_the_rim(qgis_app):
    view = SectionView()
    view.resize(500, 300)
    shown = [Crossing(offset, 100.0, f"Road edge, left, {offset} m, measured", "#e31a1c") for offset in (7.9, 7.5, 0.1, 0.0, -7.9)]
    frame = view._frame()
    boxes = view._label_boxes(shown, frame, QFontMetricsF(view.font(), view))
    assert all(frame.left() <= box.left() and box.right() <= frame.right() for box in boxes)
    assert not any(one.intersects(other) for number, one in enumerate(boxes) for other in boxes[:number])


@pytest.mark.parametrize("width", [340, 600, 1200])
def test_what_the_axes_mean_is_read_whole_however_narrow_the_window(qgis_app, width):
    view = SectionView()
    view.resize(width, 300)
    place = view._caption()
    words = QFontMetricsF(view._small(), view).boundingRect(place, section_dock.CAPTION, section_dock.caption())
    assert place.contains(words) and view._frame().bottom() < place.top() and view._frame().height() > 100


@pytest.mark.parametrize("row, why", [
    (dict(length_m=12.0, status="bridged"), "not measured"), (dict(length_m=12.0, status="inferred"), "not measured"),
    (dict(length_m=12.0, status="measured"), ""), (dict(length_m=1.0, status="bridged"), ""),
    (dict(length_m=12.0, status="measured", agree_cm=8.2), "the two boundary methods lie 8 cm apart"),
    (dict(length_m=12.0, status="measured", confidence=0.31), "confidence 0.31"),
])
def test_what_was_not_measured_disagrees_or_is_unsure_is_doubtful(qgis_app, row, why):
    assert reason(row)[0] == why


def test_doubts_come_along_the_road_and_those_of_one_place_together(project):
    piece = lambda at, **row: (f"LINESTRING Z ({at} 0 100, {at + 8} 0 100)", dict(road=0, station_m=float(at), length_m=8.0, **row))  # noqa: E731
    added(project, "ROAD_EDGES", ROAD_EDGES, piece(80, side="left", status="bridged"), piece(10, side="left", status="bridged"),
          piece(40, side="left", status="measured"))
    added(project, "DRIVING_LINES", DRIVING_LINES, piece(14, lane=1, direction=1, status="inferred"))
    places = doubts_of(road_maps(project)[0])
    assert [place.station for place in places] == [10.0, 80.0]
    first = places[0]
    assert len(first.pieces) == 2 and "Lane 1" in "".join(piece.text for piece in first.pieces) and first.extent.width() == pytest.approx(12.0)
