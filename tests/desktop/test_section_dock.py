"""The window of a cross-section: the points that it shows belong to the place that it shows."""

from types import SimpleNamespace

import numpy as np
import pytest
from lanewright.core.common.features import DRIVING_LINES
from lanewright.core.survey.las import parallel_reader
from lanewright.desktop.review import section_dock
from qgis.core import QgsPointXY, QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer
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
