"""Stages after a road map: their inputs are chosen by what layers are, and a stage is run again with what its run was given."""

from dataclasses import replace

import pytest
from lanewright.core.common.features import CORRECTIONS, DRIVING_LINES, MARKING_LINES, MARKINGS, ROAD_EDGES
from lanewright.desktop.dialogs.stage_inputs import layer_lists, stage_again
from lanewright.desktop.review.corrections_layer import new_corrections_layer
from lanewright.processing_provider.algorithm import group_of_layers
from lanewright.processing_provider.results.road_maps import run_of
from qgis.core import QgsApplication, QgsProcessingContext, QgsVectorLayer
from road_map_layers import added, run_at

LINE = ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0))
AREA = ("POLYGON Z ((0 0 1, 9 0 1, 9 9 1, 0 0 1))", dict(road=0))


@pytest.fixture(autouse=True)
def no_window(provider, monkeypatch):
    """Dialogs take what they can from a window, and pytest-qgis puts one of its own in its place."""
    from processing.gui import ParametersPanel

    monkeypatch.setattr(ParametersPanel, "iface", None)


def layers_of_run(project, run):
    return {output: added(project, output, schema, AREA if kind == "PolygonZ" else LINE, kind=kind, run=run)
            for output, schema, kind in (("DRIVING_LINES", DRIVING_LINES, "LineStringZ"), ("MARKING_LINES", MARKING_LINES, "LineStringZ"),
                                         ("MARKINGS", MARKINGS, "PolygonZ"), ("ROAD_EDGES", ROAD_EDGES, "LineStringZ"))}


@pytest.fixture
def two_runs(project, tmp_path):
    """The layers of two runs of a survey, the older one added last."""
    drive = tmp_path / "drive.csv"
    drive.write_text("time,x,y,z\n1,2,3,4\n")
    values = dict(TRAJECTORY=str(drive), LANE_WIDTH=3.75, TRAFFIC_SIDE="left")
    new = layers_of_run(project, run_at(9, **values))
    return new, layers_of_run(project, run_at(8, **values)), str(drive)


def dialog_of(ID):
    return QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{ID}").createCustomParametersWidget()


def shown(dialog, name):
    value = dialog.mainWidget().wrappers[name].parameterValue()
    return value.source.staticValue() if hasattr(value, "source") else value


def test_inputs_of_a_stage_are_the_layers_that_they_are_called_by_of_the_newest_run(two_runs):
    new, _, drive = two_runs
    dialog = dialog_of("drivinglines")
    for name in ("MARKING_LINES", "MARKINGS", "ROAD_EDGES"):
        assert shown(dialog, name) == new[name].id(), name
    assert shown(dialog, "TRAJECTORY") == drive


def test_layers_in_the_lists_are_called_by_survey_and_time_too(two_runs):
    dialog = dialog_of("drivinglines")
    boxes = [box for box in layer_lists(dialog) if box.currentText().startswith("MARKING_LINES")]
    assert boxes and all("B12, 9:00" in box.currentText() for box in boxes)
    listed = {boxes[0].itemText(row) for row in range(boxes[0].count())}
    assert sum("MARKING_LINES" in text for text in listed) == 2
    older = next(row for row in range(boxes[0].count()) if "MARKING_LINES" in boxes[0].itemText(row) and "8:00" in boxes[0].itemText(row))
    boxes[0].setCurrentIndex(older)
    assert shown(dialog, "MARKING_LINES") == two_runs[1]["MARKING_LINES"].id()


def test_a_stage_is_run_again_with_the_parameters_of_that_run(two_runs, project):
    _, old, drive = two_runs
    algorithm, values = stage_again(old["DRIVING_LINES"], project)
    assert algorithm == "lanewright:drivinglines" and values["MARKING_LINES"] == old["MARKING_LINES"].id()
    assert (values["LANE_WIDTH"], values["TRAFFIC_SIDE"], values["TRAJECTORY"]) == (3.75, "left", drive)
    assert "POINT_CLOUDS" not in values
    mine = QgsVectorLayer("LineString?crs=EPSG:32650", "mine", "memory")
    project.addMapLayer(mine)
    assert stage_again(mine, project) is None


def test_the_result_of_a_stage_goes_beside_its_inputs(two_runs, project):
    _, old, drive = two_runs
    group = group_of_layers([drive, 3.75, None, old["MARKING_LINES"].id()], project)
    assert group == "B12, 8:00"
    assert run_of(run_at(10).provenance, [], False, QgsProcessingContext(), group).group == "B12, 8:00"


def test_the_result_of_a_stage_goes_to_the_root_where_its_inputs_were_dragged_to_and_hides_the_one_it_renews(project):
    old = added(project, "DRIVING_LINES", DRIVING_LINES, LINE, run=replace(run_at(8, algorithm="drivinglines"), group=""))
    context = QgsProcessingContext()
    context.setProject(project)
    group = group_of_layers([old.id()], project)
    run = run_of(run_at(10, algorithm="drivinglines").provenance, [], False, context, group)
    assert run.group == "" and group_of_layers([QgsVectorLayer("Point", "mine", "memory")], project) is None
    new = added(project, "DRIVING_LINES", DRIVING_LINES, LINE, run=run)
    visible = {name: project.layerTreeRoot().findLayer(layer.id()).isVisible() for name, layer in (("old", old), ("new", new))}
    assert visible == {"old": False, "new": True} and not project.layerTreeRoot().findGroups()


def test_corrections_are_offered_for_their_survey_alone(project, tmp_path):
    for survey in ("B12", "B13"):
        (tmp_path / survey).mkdir()
        for tile in ("1.laz", "2.laz"):
            (tmp_path / survey / tile).touch()
    layer = new_corrections_layer(project, str(tmp_path / "corrections.gpkg"), project.crs(), "B12")
    assert len(layer.fields()) >= len(CORRECTIONS)
    dialog = dialog_of("roadmap")
    assert shown(dialog, "CORRECTIONS") is None, "no survey is chosen yet"
    dialog.setParameters({"POINT_CLOUDS": [str(tmp_path / "B12")]})
    assert shown(dialog, "CORRECTIONS") == layer.id()
    dialog.setParameters({"POINT_CLOUDS": [str(tmp_path / "B13")]})
    assert shown(dialog, "CORRECTIONS") is None
