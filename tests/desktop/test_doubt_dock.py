"""The window of doubtful places, and the corrections that are made in it."""

import re
import sqlite3
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from doubtful_street import corrections
from lanewright.algorithms.survey_input import read_corrections
from lanewright.core.common.features import DRIVING_LINES, LANES, ROAD_EDGES
from lanewright.core.survey.las import parallel_reader
from lanewright.desktop.review import smart_pick
from lanewright.desktop.review.corrections_layer import corrections_layers
from lanewright.desktop.review.doubt_dock import DoubtDock
from lanewright.processing_provider.call import QgisSource
from lanewright.processing_provider.results.road_maps import clouds_lie_in, road_maps
from lanewright.processing_provider.styling import second_reading
from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProject, QgsVectorLayer
from qgis.gui import QgsMapToolPan
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, Qt
from qgis.PyQt.QtGui import QAction, QImage
from road_map_layers import EAST, NORTH, added, run_at


def test_it_says_where_it_is_and_what_is_doubtful_there_and_shows_it(at_first):
    assert "Place 1 of 2" in at_first.where.text() and "station 10 m" in at_first.where.text()
    assert at_first.list.count() == 2 and len(at_first.bands) == 1, "one piece is lit: the one that the buttons are about"
    assert at_first.iface.mapCanvas().extent().contains(QgsPointXY(EAST + 15, NORTH))


def test_a_long_warning_is_cut_in_the_list_and_told_by_pointing_at_it(at_first):
    warning = "Warning: " + "The points are too few to find curbs. " * 12
    place = at_first.places[0]
    at_first.places[0] = replace(place, pieces=(replace(place.pieces[0], text=warning), *place.pieces[1:]))
    at_first._fill()
    assert len(at_first.list.item(0).text()) <= 200 and at_first.list.item(0).toolTip() == warning


def test_of_a_long_place_the_map_and_the_section_show_the_piece_that_is_selected(window):
    piece = lambda at, length, **row: (f"LINESTRING Z ({at} 0 100, {at + length} 0 100)", dict(  # noqa: E731
        road=0, station_m=float(at), length_m=float(length), side="left", **row))
    added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, piece(0, 200, status="bridged"), piece(4, 8, status="bridged"), run=run_at(9))
    shown = []
    window.shown.connect(shown.append)
    window.go(road_maps(QgsProject.instance())[0])
    row = next(row for row, piece in enumerate(window.place.pieces) if piece.line.length() < 10)
    window.list.setCurrentRow(row)
    window.list.itemClicked.emit(window.list.item(row))
    extent = window.iface.mapCanvas().extent()
    assert extent.width() < 80 and extent.contains(QgsPointXY(EAST + 8, NORTH))
    assert shown[-1].middle.x() == pytest.approx(EAST + 8), "the section is that of the piece"


def test_it_goes_forward_and_back_and_begins_again_after_the_last(at_first):
    at_first.go(at_first.road_map)
    assert at_first.place.station == 80
    at_first.go(at_first.road_map, -1)
    assert at_first.place.station == 10
    at_first.go(at_first.road_map, -1)
    assert at_first.place.station == 80


def test_what_is_accepted_is_kept_in_a_layer_that_road_map_reads_and_the_next_place_comes(at_first):
    at_first.note.setText("seen from the image")
    at_first.accept_button.click()
    assert at_first.place.station == 10, "a lane is left to decide"
    at_first.accept_button.click()
    assert corrections() == [("accept", "edge", 0, 10.0, pytest.approx(8.0)), ("accept", "lane", 0, 14.0, pytest.approx(8.0))]
    assert at_first.place.station == 80 and "corrections.gpkg: 2." in at_first.kept.text()


def test_delete_takes_one_piece_and_the_next_piece_waits_to_be_decided(at_first):
    at_first.delete_button.click()
    assert [(action, target) for action, target, *_ in corrections()] == [("delete", "edge")]
    assert at_first.place.station == 10 and "→ delete" in at_first.list.item(0).text() and "→" not in at_first.list.item(1).text()
    assert [piece.target for piece in at_first.chosen] == ["lane"]
    at_first.go(at_first.road_map)
    assert len(at_first.chosen) == 1


def test_several_are_deleted_where_they_were_selected_by_hand(at_first):
    at_first.list.selectAll()
    at_first.delete_button.click()
    assert [(action, target) for action, target, *_ in corrections()] == [("delete", "edge"), ("delete", "lane")]
    assert at_first.place.station == 80


def test_who_decides_otherwise_has_one_correction_not_two(at_first):
    at_first.delete_button.click()
    at_first.list.setCurrentRow(0)
    at_first.accept_button.click()
    assert [action for action, *_ in corrections()] == ["accept"]


def test_a_drawn_line_is_kept_with_its_target_and_can_be_taken_back(at_first):
    hand = QgsMapToolPan(at_first.iface.mapCanvas())
    at_first.iface.mapCanvas().setMapTool(hand)
    at_first.begin_pick()
    at_first.begin("draw", "edge")
    assert at_first.iface.mapCanvas().mapTool() is at_first.tool
    for x in (20.0, 25.0, 31.0):
        at_first.tool.add(QgsPointXY(EAST + x, NORTH + 4))
    at_first.tool.finish()
    (action, target, *_, length), = corrections()
    assert (action, target, length) == ("draw", "edge", pytest.approx(11.0))
    assert at_first.iface.mapCanvas().mapTool() is hand, "the map can be moved again"
    at_first.undo_button.click()
    assert corrections() == [] and not at_first.undo_button.isEnabled()


def test_a_piece_is_moved_to_a_line_which_takes_two_clicks_and_the_list_says_so(at_first):
    at_first.list.selectAll()
    assert not at_first.move_button.isEnabled()
    at_first.list.setCurrentRow(1)
    at_first.move_button.click()
    at_first.tool.add(QgsPointXY(EAST + 14, NORTH + 1))
    at_first.tool.finish()
    assert corrections() == [] and "two clicks" in at_first.hint.text(), "drawing goes on"
    at_first.tool.add(QgsPointXY(EAST + 22, NORTH + 1))
    at_first.tool.finish()
    assert [(action, target) for action, target, *_ in corrections()] == [("move", "lane")]
    assert "→ move" in at_first.list.item(1).text() and "→" not in at_first.list.item(0).text()
    at_first.list.setCurrentRow(1)
    at_first.accept_button.click()
    assert [(action, target) for action, target, *_ in corrections()] == [("accept", "lane")], "a decision takes the place of another"


def test_what_is_drawn_stays_while_the_hand_moves_the_map_and_nothing_covers_the_map(at_first):
    canvas = at_first.iface.mapCanvas()
    at_first.begin("draw", "edge")
    assert at_first.iface.messageBar().currentItem() is None and at_first.hint.isVisible()
    at_first.tool.add(QgsPointXY(EAST + 20, NORTH + 4))
    canvas.setMapTool(QgsMapToolPan(canvas))
    at_first.begin("draw", "edge")
    at_first.tool.add(QgsPointXY(EAST + 30, NORTH + 4))
    at_first.tool.finish()
    assert [length for *_, length in corrections()] == [pytest.approx(10.0)] and not at_first.hint.isVisible()


def test_who_names_no_file_for_the_corrections_has_drawn_nothing_yet(at_first):
    at_first.ask_for_file = lambda: ""
    at_first.begin("draw", "edge")
    assert at_first.iface.mapCanvas().mapTool() is not at_first.tool


def test_single_keys_go_on_accept_and_delete(at_first):
    keys = {action.shortcut().toString(): action for action in at_first.actions()}
    assert "(A)" in at_first.accept_button.toolTip() and "(D)" in at_first.delete_button.toolTip()
    keys["A"].trigger(), keys["D"].trigger()
    assert [action for action, *_ in corrections()] == ["accept", "delete"] and at_first.place.station == 80
    keys["P"].trigger()
    assert at_first.place.station == 10


def test_the_other_reading_of_a_lane_is_taken_by_one_key_and_goes_into_the_corrections(at_first, tmp_path):
    reading = '{"lanes": [{"offset_m": 1.5, "width_m": 3.5, "direction": 1}, {"offset_m": -1.5, "width_m": 3.5, "direction": -1}]}'
    lane = added(QgsProject.instance(), "DRIVING_LINES", DRIVING_LINES, ("LINESTRING Z (80 0 100, 88 0 100)", dict(
        road=0, station_m=80.0, length_m=8.0, lane=1, direction=1, status="inferred", confidence=0.55, other=reading)))
    assert lane.featureCount() == 1
    at_first.go(road_maps(QgsProject.instance())[0])
    assert "a lane of 3.5 m along the road, a lane of 3.5 m against" in at_first.list.item(0).text() and at_first.other_button.isEnabled()
    {action.shortcut().toString(): action for action in at_first.actions()}["O"].trigger()
    layer, = corrections_layers(QgsProject.instance())
    row, = layer.getFeatures()
    assert (row["action"], row["target"], row["other"]) == ("take", "lane", reading)
    shown = at_first.layer.editorWidgetSetup(at_first.layer.fields().lookupField("other"))
    assert shown.config()["map"] == [{second_reading(reading): reading}], "the table shows it in words"
    at_first.list.setCurrentRow(1)
    assert not at_first.other_button.isEnabled(), "the edge has one reading alone"


def test_what_is_done_is_counted_and_passed_over_on_wish(at_first):
    at_first.list.selectAll()
    at_first.accept_button.click()
    assert "1 done" in at_first.where.text() and at_first.place.station == 80
    at_first.undecided.setChecked(True)
    at_first.go(at_first.road_map)
    assert at_first.place.station == 80


def test_one_kind_alone_is_gone_through(at_first):
    at_first.kinds.setCurrentIndex(at_first.kinds.findData("lane"))
    assert [place.station for place in at_first.places] == [14.0] and at_first.list.count() == 1


def test_corrections_of_another_survey_are_left_alone(at_first, tmp_path):
    at_first.accept_button.click()
    mine, = corrections_layers(QgsProject.instance())
    added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (0 900 100, 20 900 100)", dict(
        road=0, station_m=0.0, length_m=20.0, side="left", status="bridged")), run=run_at(9, ["/data/B13/a.laz"], "B13"))
    at_first.ask_for_file = lambda: str(tmp_path / "corrections of B13.gpkg")
    at_first.go(road_maps(QgsProject.instance())[0])
    assert at_first.layer is None and "No corrections" in at_first.kept.text()
    at_first.accept_button.click()
    assert at_first.layer != mine and mine.featureCount() == at_first.layer.featureCount() == 1


def test_who_names_no_file_changes_nothing(at_first):
    at_first.ask_for_file = lambda: ""
    at_first.accept_button.click()
    assert corrections_layers(QgsProject.instance()) == [] and at_first.place.station == 10


def test_a_file_that_holds_something_else_is_refused(at_first, tmp_path):
    other = tmp_path / "other.gpkg"
    other.write_bytes(b"no database")
    at_first.ask_for_file = lambda: str(other)
    at_first.accept_button.click()
    assert "holds no layer of corrections" in at_first.iface.messageBar().currentItem().text()


def test_of_a_lane_the_middle_between_its_borders_is_kept(window):
    ring = "POLYGON Z ((0 2 1, 10 2 1, 20 2 1, 20 -2 1, 10 -2 1, 0 -2 1, 0 2 1))"
    layer = added(QgsProject.instance(), "LANES", LANES, (ring, dict(road=0, station_m=0.0, length_m=20.0, status="inferred", lane_id="0.1.1")),
                  kind="PolygonZ")
    from lanewright.desktop.review.doubtful import course_of

    line = course_of(next(layer.getFeatures()).geometry())
    assert line.length() == pytest.approx(20.0) and line.boundingBox().height() == pytest.approx(0.0, abs=1e-6)


def test_a_project_that_is_closed_takes_its_doubtful_places_along(at_first):
    at_first.accept_button.click()
    QgsProject.instance().clear()
    assert at_first.place is None and at_first.list.count() == 0 and at_first.where.text() == "" and not at_first.bands
    assert not any(button.isEnabled() for button in (at_first.accept_button, at_first.draw_button, at_first.undo_button, at_first.run_button))
    at_first.kinds.setCurrentIndex(1)  # nothing left to begin again with


def test_after_a_move_the_next_piece_waits_to_be_decided_and_keys_work(at_first):
    at_first.move_button.click()
    main = at_first.iface.mainWindow()
    assert main.focusWidget() is at_first.iface.mapCanvas(), "Backspace and Esc are for the line"
    for x in (10, 18):
        at_first.tool.add(QgsPointXY(EAST + x, NORTH + 1))
    at_first.tool.finish()
    assert at_first.list.currentRow() == 1 and at_first.place.station == 10 and main.focusWidget() is at_first.list


def test_a_move_that_was_only_begun_ends_at_the_next_place(at_first):
    at_first.move_button.click()
    at_first.go(at_first.road_map)
    assert not at_first.hint.isVisible() and at_first.iface.mapCanvas().mapTool() is not at_first.tool


def test_corrections_are_seen_on_a_map_that_was_made_again(at_first):
    project = QgsProject.instance()
    at_first.accept_button.click()
    again = added(project, "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (10 0 100, 18 0 100)", dict(road=0, station_m=10.0, length_m=8.0, side="left",
                                                                                                 status="bridged")), run=run_at(12))
    project.layerTreeRoot().insertLayer(0, again)
    at_first.go(road_maps(project, again)[0])
    at_first.accept_button.click()
    assert project.layerTreeRoot().layerOrder()[0] is corrections_layers(project)[0]


@pytest.fixture
def over_points(at_first, tmp_path, monkeypatch):
    """The window over a street with a curb of 12 cm at 5 m to the left, which the map has on its first 20 m alone."""
    project, cloud = QgsProject.instance(), tmp_path / "street.laz"
    cloud.touch()
    clouds_lie_in(at_first.road_map, str(tmp_path), project)
    monkeypatch.setattr(smart_pick, "clouds_of", lambda road_map, project: ([str(cloud)], []))
    random = np.random.default_rng(1)
    x, y = EAST + random.uniform(0, 60, 60_000), NORTH + random.uniform(0, 8, 60_000)
    points = np.c_[x, y, 100 + np.where(y > NORTH + 5, 0.12, 0.0) + random.normal(0, 0.004, len(x)), np.full(len(x), 100.0)]
    monkeypatch.setattr(parallel_reader, "points_near", lambda clouds, x, y, radius, progress: points[
        (np.abs(points[:, :2] - (x, y)) <= radius).all(axis=1)])
    added(project, "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (0 5 100, 20 5 100)", dict(road=0, side="left", status="measured", length_m=20.0)))
    at_first.go(road_maps(project)[0])
    return at_first


def looked(window):
    clock = QElapsedTimer()
    clock.start()
    while window.looks and clock.elapsed() < 60_000:
        QCoreApplication.processEvents()


def corrected_lines():
    layer, = corrections_layers(QgsProject.instance())
    return [(row["target"], row["note"], geometry) for geometry, row in read_corrections(QgisSource(layer, "Corrections"))]


def test_one_click_beside_a_missed_curb_adds_what_the_map_lacks_of_it_with_the_evidence_and_undo_takes_it_back(over_points):
    over_points.pick_button.click()
    assert over_points.iface.mapCanvas().mapTool() is over_points.pick_tool
    over_points.pick_tool.canvasClicked.emit(QgsPointXY(EAST + 35, NORTH + 5.4), Qt.MouseButton.LeftButton)
    looked(over_points)
    (target, note, line), = corrected_lines()
    assert target == "edge" and "12 cm" in note and note in over_points.hint.text()
    x, y = np.array(line.xy)
    assert x.min() == pytest.approx(EAST + 20.3, abs=0.6) and x.max() > EAST + 55, "the first 20 m stand in the map already"
    np.testing.assert_allclose(y, NORTH + 5, atol=0.05)
    over_points.undo_button.click()
    assert corrected_lines() == []


def test_a_click_on_what_the_map_has_or_where_nothing_is_adds_nothing_and_says_so(over_points):
    over_points.pick_button.click()
    for place, words in ((QgsPointXY(EAST + 8, NORTH + 5.2), "has this line"), (QgsPointXY(EAST + 35, NORTH + 2), "No step")):
        over_points.pick_at(place)
        looked(over_points)
        assert words in over_points.hint.text() and corrected_lines() == []


def test_a_second_click_on_a_curb_that_was_found_adds_nothing(over_points):
    over_points.pick_button.click()
    for x in (35, 45):
        over_points.pick_at(QgsPointXY(EAST + x, NORTH + 5.2))
        looked(over_points)
    assert len(corrected_lines()) == 1 and "has this line" in over_points.hint.text()


def test_a_line_drawn_beside_the_curb_is_laid_onto_it_unless_that_is_switched_off(over_points):
    for on, beside in ((True, 0.05), (False, 0.3)):
        over_points.snap.setChecked(on)
        over_points.begin("draw", "edge")
        for x in (30, 45):
            over_points.tool.add(QgsPointXY(EAST + x, NORTH + 5.25))
        over_points.tool.finish()
        looked(over_points)
        *_, (_, _, line) = corrected_lines()
        assert np.abs(np.array(line.xy)[1] - NORTH - 5).max() == pytest.approx(0.25 if not on else 0.0, abs=beside)
        over_points.undo()


def test_one_key_takes_up_the_vertex_tool_on_the_corrections_and_once_more_keeps_what_was_dragged(at_first):
    iface, chosen, triggered = at_first.iface, [], []
    iface.setActiveLayer = chosen.append
    for name in ("actionVertexToolActiveLayer", "actionPan"):
        setattr(iface, name, lambda action=QAction(name, at_first, triggered=lambda checked, name=name: triggered.append(name)): action)
    key = {action.shortcut().toString(): action for action in at_first.actions()}["V"]
    assert not at_first.vertex_button.isEnabled()
    at_first.accept_button.click()
    key.trigger()
    layer = at_first.layer
    assert chosen == [layer] and layer.isEditable() and triggered == ["actionVertexToolActiveLayer"] and "Ctrl+Z" in at_first.hint.text()
    row = next(layer.getFeatures())
    layer.beginEditCommand("drag"), layer.moveVertex(EAST + 19, NORTH + 1, row.id(), 1), layer.endEditCommand()
    layer.beginEditCommand("drag"), layer.moveVertex(EAST + 30, NORTH + 1, row.id(), 1), layer.endEditCommand()
    layer.undoStack().undo()
    key.trigger()
    assert len(layer.customProperty("lanewright/changes")) == 2, "the steps from there are stale"
    assert not layer.isEditable() and triggered[-1] == "actionPan" and not at_first.hint.isVisible()
    assert [length for *_, length in corrections()] == [pytest.approx(np.hypot(9, 1))]


def test_take_back_while_vertices_are_dragged_takes_the_last_one(at_first):
    at_first.accept_button.click()
    at_first.layer.startEditing()
    at_first.accept_button.click()
    at_first.undo_button.click()
    at_first.layer.commitChanges()
    assert [(action, target) for action, target, *_ in corrections()] == [("accept", "edge")]


def photos(folder, *rows):
    """A layer of the places of photos; rows of (name, m east and north, direction or None)."""
    layer = QgsVectorLayer("Point?crs=EPSG:32650&field=photo:string&field=direction:double", "Photos", "memory")
    for name, east, north, direction in rows:
        picture = QImage(4000, 3000, QImage.Format.Format_RGB32)
        picture.fill(Qt.GlobalColor.gray)
        assert picture.save(str(folder / name))
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(EAST + east, NORTH + north)))
        feature.setAttributes([str(folder / name), direction])
        layer.dataProvider().addFeature(feature)
    return QgsProject.instance().addMapLayer(layer)


def test_a_doubtful_place_shows_the_photo_that_looks_at_it(window, tmp_path):
    photos(tmp_path, ("away.jpg", 12, -2, 270.0), ("ahead.jpg", 4, 0, 95.0), ("far.jpg", 75, 0, None))
    window.go(road_maps(QgsProject.instance())[0])   # at 10 to 22 m
    assert window.photo.photo.path.name == "ahead.jpg" and window.photo.isVisible()
    assert window.photo.iconSize().width() <= 320, "read no larger than it is shown"
    window.go(window.road_map)   # at 80 m, where the photo's direction is not known
    assert window.photo.photo.path.name == "far.jpg"
    (tmp_path / "far.jpg").unlink()
    window.go(window.road_map)
    window.go(window.road_map)
    assert window.photo.photo is None and not window.photo.isVisible(), "a file that is gone is not shown"


def test_a_list_of_photos_with_names_beside_it_is_enough(window, tmp_path):
    photos(tmp_path, ("a.jpg", 500, 500, None))
    (tmp_path / "list.csv").write_text(f"name,x,y\n/{tmp_path}/a.jpg,{EAST + 14},{NORTH}\na.jpg,{EAST + 8},{NORTH + 1}\n", encoding="utf-8")
    QgsProject.instance().addMapLayer(QgsVectorLayer(
        f"file://{tmp_path}/list.csv?type=csv&xField=x&yField=y&crs=EPSG:32650", "list", "delimitedtext"))
    window.go(road_maps(QgsProject.instance())[0])
    assert window.photo.photo.path == tmp_path / "a.jpg" and window.photo.photo.distance > 5, "the nearer one lies on another computer"


def test_short_pieces_are_passed_over_and_the_choice_is_kept(at_first):
    at_first.kinds.setCurrentIndex(at_first.kinds.findData("edge"))
    at_first.shortest.setValue(8.0)
    assert [place.station for place in at_first.places] == [10.0, 80.0]
    at_first.shortest.setValue(9.0)
    assert at_first.places == [] and at_first.list.count() == 0
    again = DoubtDock(at_first.iface)
    assert (again.kinds.currentData(), again.shortest.value()) == ("edge", 9.0)
    again.remove()


def test_what_no_correction_could_be_about_is_done_once_it_was_seen_and_asks_nothing_of_the_map(window, tmp_path):
    project = QgsProject.instance()
    whole, half = ((f"LINESTRING Z (0 {y} 100, {end} {y} 100)", dict(
        road=0, side=side, status="measured", kind="along", station_m=0.0, end_m=end, length_m=end)) for side, y, end in (
            ("left", 4, 100.0), ("right", -4, 50.0)))
    added(project, "ROAD_EDGES", ROAD_EDGES, whole, half, run=run_at(9))
    window.ask_for_file = lambda: str(tmp_path / "corrections.gpkg")
    window.go(road_maps(project)[0])
    assert "No road edge on the right for 50 m" in window.list.item(0).text() and not window.delete_button.isEnabled()
    window.accept_button.click()
    assert "1 done" in window.where.text() and "→ seen" in window.list.item(0).text()
    assert [(action, target) for action, target, *_ in corrections()] == [("seen", "edge")]


def test_the_report_says_how_many_places_are_done_corrected_and_left_and_how_long_they_are(at_first, tmp_path, monkeypatch):
    page, opened = tmp_path / "review.html", []
    monkeypatch.setattr("lanewright.desktop.review.doubt_dock.ask_for_file", lambda *names: str(page))
    monkeypatch.setattr("lanewright.desktop.review.doubt_dock.open_file", lambda iface, path: opened.append(path))
    at_first.accept_button.click()
    at_first.delete_button.click()
    at_first.report_button.click()
    cells = re.sub(r"(\s*<[^>]*>\s*)+", "|", page.read_text(encoding="utf-8"))
    assert opened == [str(page)]
    assert "|lane|0|0|1|8|0|0|0|0|0|" in cells and "|edge|1|8|0|0|0|0|1|8|1|" in cells and "|Together|1|8|1|8|0|0|1|8|1|" in cells
    assert "|0|80.0|8.0|1.2|Road edge" in cells, cells


def test_corrections_without_road_and_station_do_as_well(at_first):
    layer = QgsVectorLayer("LineString?crs=EPSG:32650&field=action:string&field=target:string", "By hand", "memory")
    row = QgsFeature(layer.fields())
    row.setAttributes(["move", "edge"])
    row.setGeometry(QgsGeometry.fromPolylineXY([QgsPointXY(EAST + 10, NORTH - 1), QgsPointXY(EAST + 18, NORTH + 1)]))
    layer.dataProvider().addFeatures([row])
    layer.updateExtents()
    QgsProject.instance().addMapLayer(layer)
    at_first.go(at_first.road_map, -1)
    assert at_first.layer.name() == "By hand" and at_first.place.station == 80


def test_vertices_that_cannot_be_kept_are_not_lost_without_a_word(at_first, tmp_path):
    at_first.accept_button.click()
    with closing(sqlite3.connect(tmp_path / "corrections.gpkg")) as table:
        table.execute("CREATE TRIGGER locked BEFORE UPDATE ON corrections BEGIN SELECT RAISE(ABORT, 'locked'); END")
        table.commit()
    layer = at_first.layer
    layer.startEditing()
    layer.moveVertex(EAST + 19, NORTH + 1, next(layer.getFeatures()).id(), 1)
    at_first.vertex_button.click()
    assert layer.isEditable() and "not kept" in at_first.iface.messageBar().currentItem().text()
    layer.rollBack()


def test_a_report_that_cannot_be_written_says_so(at_first, tmp_path, monkeypatch):
    monkeypatch.setattr("lanewright.desktop.review.doubt_dock.ask_for_file", lambda *names: str(tmp_path / "gone" / "review.html"))
    at_first.write_report()
    assert "review.html" in at_first.iface.messageBar().currentItem().text()
