"""The window of a cross-section: the points that it shows belong to the place that it shows."""

from types import SimpleNamespace

import numpy as np
import pytest
from lanewright.algorithms.survey_input import read_corrections
from lanewright.core.common.features import DRIVING_LINES
from lanewright.core.survey.las import parallel_reader
from lanewright.desktop.review import section_curb, section_dock
from lanewright.desktop.review.corrections_layer import corrections_layers
from lanewright.processing_provider.call import QgisSource
from qgis.core import QgsPointXY, QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, QPoint, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QMainWindow, QPushButton
from road_map_layers import EAST, NORTH, added, run_at


@pytest.fixture
def dock(project, monkeypatch, tmp_path):
    """A window about a road of 400 m, whose points are read at once but for those near its end, which take until `released`."""
    (tmp_path / "a.laz").touch()
    added(project, "DRIVING_LINES", DRIVING_LINES, ("LINESTRING Z (0 0 100, 400 0 100)", dict(lane=1, direction=1, length_m=400.0)),
          run=run_at(8, [str(tmp_path / "a.laz")]))
    waiting = []

    def points_near(clouds, x, y, around, progress):
        clock = QElapsedTimer()
        clock.start()
        while x > EAST + 300 and not waiting and clock.elapsed() < 20_000:
            progress.check_cancelled()
        return np.array([[x, y + across, 100.0, 7.0] for across in (-2.0, 0.0, 2.0)])

    monkeypatch.setattr(parallel_reader, "points_near", points_near)
    main = QMainWindow()
    canvas = QgsMapCanvas(main)
    canvas.setDestinationCrs(next(iter(project.mapLayers().values())).crs())
    dock = section_dock.SectionDock(SimpleNamespace(
        mainWindow=lambda: main, mapCanvas=lambda: canvas, activeLayer=lambda: None, removeDockWidget=main.removeDockWidget,
        addDockWidget=lambda area, dock: main.addDockWidget(area, dock)))
    dock.released = lambda: waiting.append(True)
    yield dock
    dock.released()
    dock.remove()


def settled(dock):
    clock = QElapsedTimer()
    clock.start()
    while (dock.task is not None or clock.elapsed() < 300) and clock.elapsed() < 20_000:
        QCoreApplication.processEvents()


def show(dock, x):
    dock.show_at(QgsPointXY(EAST + x, NORTH), dock.iface.mapCanvas().mapSettings().destinationCrs())


def test_comma_and_full_stop_step_the_section_back_and_ahead(dock):
    show(dock, 100)
    settled(dock)
    by_key, began = {found.shortcut().toString(): found for found in dock.findChildren(QPushButton)}, dock.section.x
    by_key["."].click()
    assert dock.section.x == pytest.approx(began + section_dock.STEP)
    by_key[","].click()
    assert dock.section.x == pytest.approx(began)


def test_who_comes_back_before_the_far_place_is_read_sees_the_points_of_the_near_one(dock):
    show(dock, 10)
    settled(dock)
    assert len(dock.view.points) == 3
    show(dock, 390)
    show(dock, 10)
    dock.released()
    settled(dock)
    assert len(dock.view.points) == 3
    dock.step(1.0)
    dock.step(-1.0)
    settled(dock)
    assert len(dock.view.points) == 3, "the points that are kept are those of the place"


def test_who_is_asked_where_the_point_clouds_are_is_asked_once(dock, tmp_path):
    asked = []
    dock.ask_for_folder = lambda gone: asked.append(gone) or ""
    (tmp_path / "a.laz").rename(tmp_path / "b.laz")
    show(dock, 10)
    show(dock, 20)
    assert asked == [[str(tmp_path / "a.laz")]] and "not there" in dock.view.message
    dock._asked.clear()
    (tmp_path / "archive").mkdir()
    (tmp_path / "b.laz").rename(tmp_path / "archive" / "a.laz")
    dock.ask_for_folder = lambda gone: str(tmp_path / "archive")
    show(dock, 10)
    settled(dock)
    assert len(dock.view.points) == 3


def test_a_project_that_is_closed_leaves_an_empty_section(dock):
    show(dock, 10)
    settled(dock)
    QgsProject.instance().clear()
    dock.step(1.0)
    dock.thickness.setValue(1.0)
    assert len(dock.view.points) == 0 and not dock.view.crossings and "Click on the road" in dock.view.message


# -- a curb that is drawn in sections

@pytest.fixture
def curbs(dock, tmp_path, monkeypatch):
    """The window at 100 m of the road, with a curb of 12 cm at 5 m to the left and one of 8 cm at 5 m to the right."""
    random = np.random.default_rng(1)
    x, y = EAST + random.uniform(60, 160, 160_000), NORTH + random.uniform(-8, 8, 160_000)
    z = 100 + np.where(y > NORTH + 5, 0.12, 0.0) + np.where(y < NORTH - 5, 0.08, 0.0) + random.normal(0, 0.004, len(x))
    points = np.c_[x, y, z, np.full(len(x), 100.0)]
    monkeypatch.setattr(parallel_reader, "points_near", lambda clouds, x, y, radius, progress: points[
        (np.abs(points[:, :2] - (x, y)) <= radius).all(axis=1)])
    dock.ask_for_file = lambda: str(tmp_path / "corrections.gpkg")
    dock.view.resize(800, 300)
    dock.iface.mainWindow().show()
    show(dock, 100)
    settled(dock)
    return dock


def click(dock, offset, z=100.0):
    x, y = dock.view._at(offset, z)
    QTest.mouseClick(dock.view, Qt.MouseButton.LeftButton, pos=QPoint(round(x), round(y)))


def drawn():
    return [(row["action"], row["target"], row["note"], np.array(geometry.coords)) for layer in corrections_layers(QgsProject.instance())
            for geometry, row in read_corrections(QgisSource(layer, "Corrections"))]


def test_a_missed_curb_is_added_in_three_clicks_with_the_height_of_its_bottom_as_one_line(curbs):
    click(curbs, 5.2)
    assert drawn() == [] and "Curb of 12." in curbs.said.text() and "foot ±" in curbs.said.text(), "it is shown first"
    (foot, bottom), (_, top) = curbs.view.face
    assert (foot, bottom, top) == pytest.approx((5.0, 100.0, 100.12), abs=0.03)
    click(curbs, 5.1)
    (action, target, _, line), = drawn()
    height = next(corrections_layers(QgsProject.instance())[0].getFeatures())["height_m"]
    assert (action, target, height) == ("draw", "edge", pytest.approx(0.12, abs=0.01))
    assert np.ptp(line[:, 0]) == pytest.approx(1.0, abs=0.02), "one section stands for a metre"
    for _ in range(6):
        curbs.step(1.0)
    click(curbs, 4.9)
    (_, _, note, line), = drawn()
    assert line == pytest.approx(np.array([[EAST + 100, NORTH + 5, 100.0], [EAST + 106, NORTH + 5, 100.0]]), abs=0.03) and "in 2 sections" in note
    assert [crossing.z for crossing in curbs.view.crossings if crossing.offset > 4] == [pytest.approx(100.0, abs=0.02)], "the section shows it"


def test_a_click_behind_the_line_goes_on_at_its_other_end_and_undo_takes_one_click_after_the_other_back(curbs):
    click(curbs, 5.0), QTest.keyClick(curbs.view, Qt.Key.Key_Return)
    for metres in (4.0, -7.0):
        curbs.step(metres)
        click(curbs, 5.0)
    (_, _, _, line), = drawn()
    assert line[:, 0] == pytest.approx([EAST + 97, EAST + 100, EAST + 104], abs=0.01)
    counts = []
    for _ in range(4):
        QTest.keyClick(curbs.view, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        counts.append([len(line) for *_, line in drawn()])
    assert counts == [[2], [2], [], []]


def test_the_curb_of_the_other_side_is_a_line_of_its_own(curbs):
    click(curbs, 5.0), click(curbs, 5.0)
    curbs.step(1.0)
    click(curbs, -5.0)
    assert len(drawn()) == 1 and "Curb of 8." in curbs.said.text(), "shown, and not added"
    click(curbs, -5.0)
    assert [line[0, 1] for *_, line in drawn()] == pytest.approx([NORTH + 5, NORTH - 5], abs=0.03)


def test_esc_drops_what_was_found_and_then_ends_the_line(curbs):
    click(curbs, 5.0), QTest.keyClick(curbs.view, Qt.Key.Key_Escape)
    assert not curbs.view.face and drawn() == []
    click(curbs, 5.0), click(curbs, 5.0), QTest.keyClick(curbs.view, Qt.Key.Key_Escape)
    curbs.step(2.0)
    click(curbs, 5.0)
    assert curbs.view.face and len(drawn()) == 1, "the next click begins another line"


def test_a_click_where_no_step_is_or_on_what_is_drawn_adds_nothing_and_says_so(curbs):
    click(curbs, 1.0)
    assert curbs.said.text().startswith("No step of 2 cm within 0.3 m of the click") and not curbs.view.face
    click(curbs, 5.0), click(curbs, 5.0), click(curbs, 5.1)
    assert "has this place already" in curbs.said.text() and len(drawn()) == 1


def test_dragging_the_picture_is_no_click(curbs):
    x, y = curbs.view._at(5.0, 100.0)
    QTest.mousePress(curbs.view, Qt.MouseButton.LeftButton, pos=QPoint(round(x), round(y)))
    QTest.mouseMove(curbs.view, QPoint(round(x) + 40, round(y)))
    QTest.mouseRelease(curbs.view, Qt.MouseButton.LeftButton, pos=QPoint(round(x) + 40, round(y)))
    assert not curbs.view.face and curbs.said.text() == ""


def test_a_curb_that_was_found_goes_with_its_map(curbs):
    click(curbs, 5.0)
    QgsProject.instance().clear()
    QTest.keyClick(curbs.view, Qt.Key.Key_Return)
    assert curbs.curb.face is None and not curbs.view.face and curbs.said.text() == ""


def test_one_section_stands_for_a_metre_on_a_map_in_feet_too(curbs, monkeypatch):
    monkeypatch.setattr(section_curb, "metres_of", lambda road_map: 0.3048)
    click(curbs, 5.0), click(curbs, 5.0)
    (*_, line), = drawn()
    assert np.ptp(line[:, 0]) == pytest.approx(1 / 0.3048, abs=0.05)
    for _ in range(50):
        curbs.step(1.0)
    settled(curbs)
    click(curbs, 5.0)
    (*_, line), = drawn()
    assert np.ptp(line[:, 0]) == pytest.approx(50.0, abs=0.1), "15 m on"
