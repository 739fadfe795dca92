"""Every run has a group of its own, may take the place of the last one, and an image lies below the lines of its map."""

import re
from datetime import datetime, timezone

import pytest
from lanewright.algorithms.provenance import Provenance
from lanewright.processing_provider.results.road_maps import REPLACES_LAST_RUN, Run, place_layer, run_of, runs_of, survey_name
from qgis.core import QgsFeature, QgsGeometry, QgsProcessingContext, QgsVectorLayer


@pytest.fixture(autouse=True)
def runs_stay_beside_each_other(qgis_app):
    yield
    REPLACES_LAST_RUN.keep(False)


def added(project, run, output, name="layer", at=0.0):
    """A layer as QGIS adds it to the top of its group."""
    layer = QgsVectorLayer("LineString?crs=EPSG:32650", name, "memory")
    feature = QgsFeature()
    feature.setGeometry(QgsGeometry.fromWkt(f"LINESTRING({at} 0, {at + 100} 50)"))
    layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    project.addMapLayer(layer, False)
    root = project.layerTreeRoot()
    (root.findGroup(run.group) or root.insertGroup(0, run.group)).insertLayer(0, layer)
    place_layer(layer, project, output, run)
    return layer


def run_in(group, survey="B12", hour=8, algorithm="roadmap"):
    """A run of a survey whose results go into a group, and that ended at an hour of one day."""
    values = {"POINT_CLOUDS": [f"/data/{survey}/cloud.laz"]} if survey else {}
    return Run(Provenance(algorithm, "1.0", values, datetime(2026, 6, 1, hour, tzinfo=timezone.utc)), survey, group)


def names(project):
    return {group.name(): [node.name() for node in group.findLayers()] for group in project.layerTreeRoot().findGroups()}


@pytest.mark.parametrize("clouds, name", [
    (["/data/B12/main_street.laz"], "B12/main_street"),
    (["/data/B12/tile_001.laz", "/data/B12/tile_002.laz"], "B12/tile"),
    (["/data/B12/1.laz", "/data/B12/2.laz"], "B12"),
    (["/data/monday/cloud.laz"], "monday/cloud"),
    (["/data/sample/sample.laz"], "sample"),
    (["/a/1/drive_1.laz", "/a/2/drive_2.laz"], "drive"),
    (["/data/B12/drive.copc.laz"], "B12/drive"),
    ([], ""),
])
def test_a_survey_is_called_by_its_folder_and_its_files(clouds, name):
    assert survey_name(clouds) == name


def test_a_map_made_in_one_call_has_a_group_named_by_time_and_survey(qgis_app):
    group = run_of(run_in("").provenance, ["/data/B12/cloud.laz"], True, QgsProcessingContext()).group
    assert re.fullmatch(r"\d\d-\d\d \d\d:\d\d:\d\d B12/cloud", group)


@pytest.mark.parametrize("name, title", [("11-28 15:21:19 B12/survey", "B12/survey"), ("Bypass, south", "Bypass, south")])
def test_in_print_a_map_is_called_by_its_survey_or_as_the_user_named_its_group(project, name, title):
    added(project, run_in(name), "ROAD_EDGES")
    assert [road_map.title for road_map in runs_of(project)] == [title]


def test_stages_of_a_survey_share_a_group_and_those_of_a_model_know_the_survey(qgis_app):
    context = QgsProcessingContext()
    provenance = run_in("").provenance
    assert run_of(provenance, ["/data/B12/cloud.laz"], False, context).group == "B12/cloud"
    assert run_of(provenance, [], False, context).group == "B12/cloud"
    assert run_of(provenance, [], False, QgsProcessingContext()).group == "Lanewright"


def test_runs_stay_beside_each_other_unless_the_last_is_to_be_replaced(project):
    runs = [run_in(f"Lanewright – B12, {hour}", hour=hour) for hour in (8, 9, 10)]
    for run in runs[:2]:
        added(project, run, "ROAD_EDGES"), added(project, run, "DRIVING_LINES")
    assert len(names(project)) == 2
    REPLACES_LAST_RUN.keep(True)
    assert REPLACES_LAST_RUN.holds()
    added(project, runs[2], "ROAD_EDGES", "edges"), added(project, runs[2], "DRIVING_LINES", "lanes")
    assert names(project) == {"Lanewright – B12, 10": ["lanes", "edges"], "Lanewright – B12, 8": ["layer", "layer"]}


def test_only_results_of_the_same_survey_and_algorithm_are_replaced_and_never_the_users_layers(project):
    REPLACES_LAST_RUN.keep(True)
    monday, tuesday = (run_in(f"Lanewright – {day}", day) for day in ("monday", "tuesday"))
    mine = QgsVectorLayer("Point?crs=EPSG:32650", "mine", "memory")
    added(project, monday, "ROAD_EDGES")
    project.addMapLayer(mine, False)
    project.layerTreeRoot().findGroup(monday.group).addLayer(mine)
    added(project, tuesday, "ROAD_EDGES")
    added(project, run_in("Lanewright – edges of monday", "monday", algorithm="detectboundaries"), "ROAD_EDGES")
    assert len(names(project)) == 3
    added(project, run_in("Lanewright – monday again", "monday", hour=9), "ROAD_EDGES", "new")
    assert names(project)["Lanewright – monday"] == ["mine"]
    assert names(project)["Lanewright – monday again"] == ["new"]


def test_an_image_goes_below_the_lines_of_the_map_it_lies_under(project):
    far, here = run_in("Lanewright – far", "far"), run_in("Lanewright – here", "here")
    for output in ("INTENSITY_IMAGE", "ROAD_SURFACE", "DRIVING_LINES"):
        added(project, here, output, output)
        added(project, far, output, output, at=5000.0)
    added(project, run_in("Lanewright", "", algorithm="georeferenceimage"), "ORTHOIMAGE", "image")
    assert names(project)["Lanewright – here"] == ["DRIVING_LINES", "ROAD_SURFACE", "image", "INTENSITY_IMAGE"]
    assert "Lanewright" not in names(project), "its group is empty"


def test_an_image_of_elsewhere_stays_in_its_group(project):
    added(project, run_in("Lanewright – here", "here"), "DRIVING_LINES", "lanes")
    added(project, run_in("Lanewright", "", algorithm="georeferenceimage"), "ORTHOIMAGE", "image", at=9000.0)
    assert names(project) == {"Lanewright": ["image"], "Lanewright – here": ["lanes"]}
