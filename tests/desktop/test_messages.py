"""What is said when a run has ended, and the table of the runs."""

from datetime import datetime
from types import SimpleNamespace

import pytest
from lanewright.desktop import widgets as messages
from lanewright.desktop.menu import RunsWindow
from lanewright.desktop.widgets import tell_result
from lanewright.processing_provider.results import road_maps as run_table
from qgis.core import QgsCoordinateReferenceSystem, QgsFeature, QgsGeometry, QgsRectangle, QgsVectorLayer
from qgis.gui import QgsMapCanvas, QgsMessageBar, QgsMessageViewer
from qgis.PyQt.QtWidgets import QMainWindow, QPushButton, QTextEdit


@pytest.fixture
def window(qgis_app):
    main = QMainWindow()
    canvas, bar = QgsMapCanvas(main), QgsMessageBar(main)
    canvas.resize(400, 300)
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:32650"))
    canvas.setExtent(QgsRectangle(0, 0, 100, 100))
    return SimpleNamespace(mainWindow=lambda: main, mapCanvas=lambda: canvas, messageBar=lambda: bar)


def road(east):
    layer = QgsVectorLayer("LineString?crs=EPSG:32650", "edges", "memory")
    feature = QgsFeature()
    feature.setGeometry(QgsGeometry.fromWkt(f"LINESTRING({east} 20, {east + 50} 60)"))
    layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    return layer


def buttons(window):
    return {button.text(): button for button in window.messageBar().currentItem().findChildren(QPushButton)}


def test_the_map_goes_to_a_result_that_is_out_of_sight(window):
    layer = road(9000)
    tell_result(window, "Road map", [layer], [])
    assert window.mapCanvas().extent().contains(layer.extent())
    assert "Road map is done, 1 layers" in window.messageBar().currentItem().text()


def test_the_map_stays_at_a_result_that_is_seen_and_a_button_shows_all_of_it(window):
    layer = road(60)
    before = window.mapCanvas().extent()
    tell_result(window, "Road map", [layer], [])
    assert window.mapCanvas().extent() == before
    buttons(window)["Show it"].click()
    assert window.mapCanvas().extent().contains(layer.extent())


def test_warnings_are_said_by_number_and_can_be_read(window):
    tell_result(window, "Road map", [road(60)], ["The trajectory is rough.", "No paint was found."])
    buttons(window)["2 warnings…"].click()
    shown, = window.mainWindow().findChildren(QgsMessageViewer)
    assert shown.windowTitle() == "Road map"
    assert shown.findChild(QTextEdit).toPlainText() == "The trajectory is rough.\n\nNo paint was found."


def test_how_a_missing_package_is_installed_can_be_read(window, monkeypatch):
    monkeypatch.setattr(messages, "missing_in_short", lambda: "Missing Python package(s): laspy.")
    monkeypatch.setattr(messages, "how_to_install", lambda: "pip install laspy")
    assert not messages.all_is_there(window)
    buttons(window)["How to install…"].click()
    shown, = window.mainWindow().findChildren(QgsMessageViewer)
    assert "pip install laspy" in shown.findChild(QTextEdit).toPlainText()


def test_the_last_report_is_that_of_the_last_run_that_wrote_one_and_is_there(qgis_app, monkeypatch, tmp_path):
    monkeypatch.setattr(run_table, "_runs", [])
    assert run_table.last_report() == ""
    report, declaration = tmp_path / "r.HTML", SimpleNamespace(title=lambda: "Road map", numbers=[])
    report.touch()
    for results in ({"LANES": "memory:x", "REPORT": str(report)}, {"LANES": "lanes.gpkg"}, None):
        run_table.note_run(declaration, "B12", datetime(2026, 6, 1, 8), results)
    assert run_table.last_report() == str(report)
    report.unlink()
    assert run_table.last_report() == ""


def test_the_table_of_the_runs_opens_in_qgis(qgis_app, monkeypatch):
    monkeypatch.setattr(run_table, "_runs", [])
    declaration = SimpleNamespace(title=lambda: "Road map", numbers=[SimpleNamespace(name="L", label="Length (m)")])
    for survey, length in (("B12", 90.5), ("B13", 1000.0)):
        run_table.note_run(declaration, survey, datetime(2026, 6, 1, 8), {"L": length})
    shown = RunsWindow()
    table = shown.tabs.widget(0)
    assert shown.tabs.tabText(0) == "Road map" and [table.item(row, 1).text() for row in range(2)] == ["B12", "B13"]
    table.sortItems(2)
    assert [table.item(row, 1).text() for row in range(2)] == ["B12", "B13"], "numbers are sorted as numbers"
