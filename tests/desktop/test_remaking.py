"""A map that is made again with its corrections in the background, while one goes on in the window."""


import pytest
from doubtful_street import corrections
from lanewright.core.common.features import ROAD_EDGES
from lanewright.desktop.review import remaking
from lanewright.desktop.review.corrections_layer import add_correction, changes_of, new_corrections_layer
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, QObject, pyqtSignal
from qgis.PyQt.QtWidgets import QPushButton
from road_map_layers import EAST, NORTH, added, run_at


class Task(QObject):
    progressChanged = pyqtSignal(float)
    canceled = False

    def cancel(self):
        self.canceled = True

    def isCanceled(self):
        return self.canceled


@pytest.fixture
def runs(at_first, monkeypatch):
    """The runs that the window began: none of them does anything until it is ended by its function `ended(fine)`."""
    begun = []

    class Run:
        reason = "The disk is full."

        def __init__(self, name, parameters, ended):
            self.parameters, self.task, self.loaded = parameters, Task(), []
            self.ended = lambda fine: ended(self, fine)
            begun.append(self)

        def load_results(self):
            self.loaded.append(True)

    monkeypatch.setattr(remaking, "BackgroundRun", Run)
    at_first.iface.mainWindow().show()
    return begun


def test_the_corrected_stretch_is_made_again_while_one_goes_on_and_what_is_corrected_meanwhile_is_next(at_first, runs):
    at_first.list.setCurrentRow(1)
    at_first.delete_button.click()   # a lane from 14 to 22 m
    at_first.run_button.click()
    line = at_first.remaking
    assert line.isVisible() and line.said.text() == "road 0, 14–22 m is being made again."
    assert runs[0].parameters["CORRECTIONS"] == at_first.layer.id() and {"ROAD_EDGES", "DRIVING_LINES"} <= set(runs[0].parameters)
    runs[0].task.progressChanged.emit(40.0)
    assert line.bar.value() == 40
    at_first.list.setCurrentRow(0)
    at_first.accept_button.click()
    at_first.run_button.click()
    at_first.run_button.click()
    assert len(runs) == 1 and "corrected meanwhile is next" in line.said.text() and at_first.place.station == 80, "one goes on"
    runs[0].ended(True)
    assert runs[0].loaded and len(runs) == 2 and line.said.text() == "road 0, 10–18 m is being made again."
    runs[1].ended(True)
    assert len(runs) == 2 and not line.isVisible()


def test_cancel_ends_the_run_and_those_that_wait_and_what_failed_says_why(at_first, runs):
    at_first.accept_button.click()
    at_first.run_button.click(), at_first.run_button.click()
    at_first.remaking.findChild(QPushButton).click()
    assert runs[0].task.canceled
    runs[0].ended(False)
    assert len(runs) == 1 and not at_first.remaking.isVisible() and at_first.iface.messageBar().currentItem() is None
    at_first.run_button.click()
    assert "road 0, 10–18 m" in at_first.remaking.said.text(), "it is still to be made"
    runs[1].ended(False)
    assert "The disk is full" in at_first.iface.messageBar().currentItem().text() and not runs[1].loaded


def test_a_run_without_its_point_clouds_says_that_they_are_not_there(at_first):
    at_first.accept_button.click()
    at_first.run_button.click()
    clock = QElapsedTimer()
    clock.start()
    while at_first.remaking.run is not None and clock.elapsed() < 60_000:
        QCoreApplication.processEvents()
    assert "The map was not made again" in at_first.iface.messageBar().currentItem().text()
    assert "a.laz" in at_first.iface.messageBar().currentItem().text() and not at_first.remaking.isVisible()


def test_on_wish_every_correction_is_made_at_once(at_first, runs):
    at_first.at_once.setChecked(True)
    try:
        at_first.accept_button.click()
        assert len(runs) == 1
        runs[0].ended(True)
        at_first.undo_button.click()
        assert len(runs) == 2, "a map without the correction"
    finally:
        at_first.at_once.setChecked(False)


def test_a_run_of_a_project_that_was_closed_brings_nothing_into_the_next(at_first, runs):
    at_first.accept_button.click()
    at_first.run_button.click()
    QgsProject.instance().clear()
    runs[0].ended(True)
    assert not runs[0].loaded


def test_what_is_corrected_during_a_run_stays_to_be_made_after_it(at_first, runs):
    at_first.accept_button.click()
    at_first.run_button.click()
    changed = lambda: at_first.layer.customProperty("lanewright/changes")[-1].split()[0]  # noqa: E731
    before = changed()
    at_first.list.setCurrentRow(0)
    at_first.delete_button.click()
    during = changed()
    runs[0].ended(True)
    assert before < during < changed() and len(at_first.layer.customProperty("lanewright/changes")) == 1, "later than the run, which does not have it"


def test_what_is_being_drawn_stays_when_the_map_comes_that_was_made_meanwhile(at_first):
    at_first.begin("draw", "edge")
    at_first.tool.add(QgsPointXY(EAST + 20, NORTH + 4))
    shown, again = [], []
    at_first.shown.connect(shown.append), at_first.made_again.connect(again.append)
    newer = added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, ("LINESTRING Z (10 0 100, 18 0 100)", dict(
        road=0, station_m=10.0, length_m=8.0, side="left", status="bridged")), run=run_at(12))
    at_first._follow()
    assert again[0].layers == (newer,) and not shown, "map and section stay where one is"
    at_first.tool.add(QgsPointXY(EAST + 30, NORTH + 4))
    at_first.tool.finish()
    assert [length for *_, length in corrections()] == [pytest.approx(10.0)]


def test_a_map_that_was_removed_while_it_waited_is_not_made_again(at_first, runs):
    at_first.accept_button.click()
    at_first.run_button.click(), at_first.run_button.click()
    project = QgsProject.instance()
    project.removeMapLayers([layer.id() for layer in at_first.road_map.layers])
    runs[0].ended(False)
    assert len(runs) == 1 and not at_first.remaking.isVisible()


def test_stations_of_what_is_made_again_are_metres_on_a_map_in_feet(at_first, runs):
    at_first.list.setCurrentRow(1)
    at_first.delete_button.click()
    for layer in (*at_first.road_map.vectors, at_first.layer):
        layer.setCrs(QgsCoordinateReferenceSystem("EPSG:2263"))   # of 8 feet of lane from 14 m on
    assert remaking.stretches(at_first.road_map, changes_of(at_first.layer), at_first.layer.crs()) == ["road 0, 14–16 m"]


def test_what_a_colleague_corrects_during_a_run_stays_to_be_made_after_it(at_first, runs, tmp_path):
    at_first.accept_button.click()
    at_first.run_button.click()
    other = QgsProject()
    theirs = new_corrections_layer(other, str(tmp_path / "corrections.gpkg"), at_first.layer.crs(), "B12")
    add_correction(theirs, at_first.places[1].pieces[0].line, theirs.crs(), action="delete", target="edge")
    runs[0].ended(True)
    (change,) = changes_of(at_first.layer)
    assert change.split()[1] == "edge" and float(change.split()[2]) > EAST + 70, "later than the run, which does not have it"
