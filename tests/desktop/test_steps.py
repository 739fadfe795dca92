"""The steps of a road map: which of them still hold, their settings, and running them again."""

from types import SimpleNamespace

import pytest
from lanewright.core.common.features import DRIVING_LINES, LANES, MARKING_LINES, MARKINGS, ROAD_EDGES
from lanewright.desktop.review.corrections_layer import add_correction, new_corrections_layer, take_back
from lanewright.desktop.review.doubt_dock import ARRIVED
from lanewright.desktop.review.steps import steps_of, values_again
from lanewright.processing_provider.results.road_maps import place_layer, road_maps
from qgis import utils
from qgis.core import QgsGeometry, QgsProject
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDockWidget
from road_map_layers import EAST, NORTH, added, run_at

LINE = ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0))
AREA = ("POLYGON Z ((0 0 1, 9 0 1, 9 9 1, 0 0 1))", dict(road=0))
OUTPUTS = (("LANES", LANES, "PolygonZ"), ("DRIVING_LINES", DRIVING_LINES, "LineStringZ"), ("MARKING_LINES", MARKING_LINES, "LineStringZ"),
           ("MARKINGS", MARKINGS, "PolygonZ"), ("ROAD_EDGES", ROAD_EDGES, "LineStringZ"))


def a_map(project, run, *outputs):
    for output, schema, kind in OUTPUTS:
        if not outputs or output in outputs:
            added(project, output, schema, AREA if kind == "PolygonZ" else LINE, kind=kind, run=run)


@pytest.fixture
def corrected(provider, project, tmp_path):
    """A function that makes a correction of a target, into the layer of the survey, which it returns."""
    layer = new_corrections_layer(project, str(tmp_path / "corrections.gpkg"), project.crs(), "B12")

    def correct(target):
        line = QgsGeometry.fromWkt(f"LINESTRING({EAST} {NORTH}, {EAST + 5} {NORTH})")
        add_correction(layer, line, layer.crs(), action="accept", target=target)
        return layer

    return correct


def states(project, corrections=None):
    return [(step.title, step.state) for step in steps_of(road_maps(project)[0], corrections)]


EDGES, MARKED, LINES, DRIVEN = "Detect road boundaries", "Cluster markings", "Fit marking lines", "Driving lines"


def test_the_steps_of_a_run_stand_in_the_order_of_the_work_and_are_fresh(provider, project):
    a_map(project, run_at(8))
    assert states(project) == [(title, "fresh") for title in (EDGES, MARKED, LINES, DRIVEN)]


def test_a_correction_makes_its_step_and_all_after_it_stale_until_it_is_taken_back_or_made(project, corrected):
    a_map(project, run_at(8))
    layer = corrected("marking")
    assert [state for _, state in states(project, layer)] == ["fresh", "stale", "stale", "stale"]
    take_back(layer)
    layer.removeCustomProperty("lanewright/changes")   # as of a layer that comes from elsewhere
    assert {state for _, state in states(project, layer)} == {"fresh"}


def test_a_map_made_with_corrections_is_corrected_and_becomes_stale_with_the_next_one(project, corrected):
    layer = corrected("lane")
    a_map(project, run_at(8, CORRECTIONS="corrections.gpkg"))
    assert states(project, layer)[-2:] == [(LINES, "corrected"), (DRIVEN, "stale")]
    layer.setCustomProperty("lanewright/changes", ["2026-05-31T00:00:00+00:00 lane 0 0 1 1"])   # before the run
    assert {state for _, state in states(project, layer)} == {"corrected"}


def test_a_step_that_was_run_again_alone_makes_those_after_it_stale_and_its_settings_are_those_of_that_run(provider, project):
    a_map(project, run_at(8, LANE_WIDTH=0.0, TRAFFIC_SIDE="automatic", CURVE="automatic"))
    again = run_at(9, algorithm="fitmarkinglines", CURVE="spline")
    again = type(again)(again.provenance, again.survey, "B12, 8:00")
    a_map(project, again, "MARKING_LINES")
    assert states(project) == [(EDGES, "fresh"), (MARKED, "fresh"), (LINES, "fresh"), (DRIVEN, "stale")]
    road_map = road_maps(project)[0]
    curve = next(setting for setting in steps_of(road_map, None)[2].settings if setting[1] == "spline")
    assert curve[2], "it is not the default"
    assert values_again(road_map)["CURVE"] == "spline" and values_again(road_map)["TRAFFIC_SIDE"] == "automatic"


def test_the_window_says_whether_the_corrections_are_in_the_map(window, provider, tmp_path):
    window.ask_for_file = lambda: str(tmp_path / "corrections.gpkg")
    window.go(road_maps(QgsProject.instance())[0])
    window.accept_button.click()
    assert "when it is made again" in window.kept.text()
    window.layer.setCustomProperty("lanewright/changes", [f"2026-06-01T08:30:00+00:00 {target} 0 0 1 1" for target in ("edge", "lane")])
    added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, LINE, run=run_at(9, CORRECTIONS="corrections.gpkg"))
    window.show_steps(road_maps(QgsProject.instance())[0])
    assert "1. They are in this map" in window.kept.text()


def test_the_window_asks_for_a_run_from_a_step_or_for_the_step_alone(window, provider):  # noqa: F811
    window.show_steps(road_maps(QgsProject.instance())[0])
    panel, asked = window.steps, []
    assert window.tabs.currentWidget() is panel and [step.title for step in panel.steps] == [EDGES, DRIVEN]
    panel.run_wanted.connect(lambda: asked.append("run"))
    panel.stage_wanted.connect(lambda *what: asked.append(what))
    panel.again.click()
    panel.tree.setCurrentItem(panel.tree.topLevelItem(1).child(0))   # one of its settings
    panel.alone.click()
    run, (algorithm, values) = asked
    assert run == "run" and algorithm == "lanewright:drivinglines" and "ROAD_EDGES" in values


def test_the_window_goes_on_in_the_map_that_is_made_again_before_the_results_viewer(window, monkeypatch):  # noqa: F811
    results, main = QDockWidget(window.iface.mainWindow()), window.iface.mainWindow()
    main.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, results)
    monkeypatch.setitem(utils.plugins, "processing", SimpleNamespace(resultsDock=results))
    results.hide()
    window.go(road_maps(QgsProject.instance())[0])
    old = window.road_map
    piece = lambda at: (f"LINESTRING Z ({at} 0 100, {at + 8} 0 100)", dict(road=0, side="left", status="bridged", station_m=float(at), length_m=8.0))  # noqa: E731
    results.show()
    added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, piece(10), run=run_at(9))
    QTest.qWait(ARRIVED + 300)
    assert window.road_map.layers != old.layers and "Place 1 of 1" in window.where.text()
    assert results in main.tabifiedDockWidgets(window), "it is not squeezed below the report"
    window.go(window.road_map)
    assert "Place 1 of 1" in window.where.text()
    added(QgsProject.instance(), "ROAD_EDGES", ROAD_EDGES, piece(20), run=run_at(10, survey="B13", clouds=["/data/B13/a.laz"]))
    QTest.qWait(ARRIVED + 300)
    assert window.places[0].station == 10.0, "another survey is another matter"


def test_a_map_that_was_saved_is_made_again_in_its_place_and_the_window_goes_on_where_it_was(window, provider, tmp_path):
    project, package = QgsProject.instance(), tmp_path / "roadmap.gpkg"
    piece = lambda at: (f"LINESTRING Z ({at} 0 100, {at + 8} 0 100)", dict(  # noqa: E731
        road=0, side="left", status="bridged", station_m=float(at), length_m=8.0, kind="along"))
    added(project, "ROAD_EDGES", ROAD_EDGES, piece(10), piece(50), piece(90), run=run_at(9, survey="B14"), package=package)
    (tmp_path / "report.html").touch()
    first = road_maps(project)[0]
    values = values_again(first)
    assert values["ROAD_EDGES"] == f"ogr:dbname='{package}' table=\"road_edges\" (geom)" and values["REPORT"] == str(tmp_path / "report.html")
    assert "REPORT" not in values_again(road_maps(project)[1]), "its layers are in memory"
    window.order.setCurrentIndex(1)
    for _ in range(3):
        window.go(first)
    assert window.place.station == 90
    layer, run = first.layers[0], run_at(10, survey="B14")
    layer.dataProvider().deleteFeatures([feature.id() for feature in layer.getFeatures() if feature["station_m"] == 50])
    project.layerTreeRoot().insertGroup(0, run.group)   # as QGIS does, which then leaves the layer where it is
    place_layer(layer, project, "ROAD_EDGES", run)
    QTest.qWait(ARRIVED + 300)
    assert [group.name() for group in project.layerTreeRoot().findGroups()] == ["B14, 10:00", "B12, 8:00"]
    assert "Place 2 of 2" in window.where.text() and window.place.station == 90
