"""Results appear whole or not at all."""

import os
from pathlib import Path

import numpy as np
import pytest
from drives import write_cloud
from lanewright.algorithms.destinations import ReplacedFiles, UnfinishedFiles, check_suffix, check_writable, destination_path
from lanewright.algorithms.driving.road_map import RoadMap
from lanewright.core.common.errors import RoadExtractionError
from lanewright.processing_provider.call import QgisCall
from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputLayerDefinition, QgsProject


def test_yesterdays_result_stands_until_todays_is_complete(tmp_path):
    result = tmp_path / "road.laz"
    result.write_text("yesterday")
    files = UnfinishedFiles()
    with open(files.begin(result), "w") as stream:
        stream.write("today")
    assert result.read_text() == "yesterday"
    files.commit()
    assert result.read_text() == "today" and os.listdir(tmp_path) == ["road.laz"]


def test_a_run_that_fails_leaves_no_half_file(tmp_path):
    files = UnfinishedFiles()
    with open(files.begin(tmp_path / "road.laz"), "w") as stream:
        stream.write("half")
    files.discard()
    assert os.listdir(tmp_path) == []


def test_a_message_names_the_file_as_the_user_does(tmp_path):
    files = UnfinishedFiles()
    said = files.in_users_names(f"{files.begin(tmp_path / 'road.laz')} cannot be written.")
    files.discard()
    assert said == f"{tmp_path / 'road.laz'} cannot be written."


def test_statistics_beside_an_image_go_with_it(tmp_path):
    files = UnfinishedFiles()
    name = files.begin(tmp_path / "image.tif")
    open(f"{name}.aux.xml", "w").close()
    files.commit()
    assert sorted(os.listdir(tmp_path)) == ["image.tif", "image.tif.aux.xml"]


def test_the_temporary_name_ends_as_the_file_does_since_drivers_go_by_it(tmp_path):
    files = UnfinishedFiles()
    assert files.begin(tmp_path / "a.tif").endswith(".tif")
    assert files.begin(tmp_path / "b.copc.laz").endswith(".copc.laz")
    assert files.begin(tmp_path / "v1.2.laz").endswith(".laz")


@pytest.mark.parametrize("value, path", [
    ("lines.gpkg", "lines.gpkg"),
    ("ogr:dbname='/data/all.gpkg' table=\"lanes\" (geom)", "/data/all.gpkg"),
    ("/data/all.gpkg|layername=lanes", "/data/all.gpkg"),
    ("TEMPORARY_OUTPUT", None),
    ("memory:", None),
    ("postgres://dbname='gis'", None),
    ("", None),
    (None, None),
])
def test_the_file_behind_a_destination(value, path):
    found = destination_path(value)
    assert (str(found) if found else None) == path


def test_a_missing_folder_is_named_before_any_work(tmp_path):
    with pytest.raises(RoadExtractionError, match="there is no folder .*nowhere"):
        check_writable(tmp_path / "nowhere" / "road.laz", "Road points")


def test_a_folder_given_for_a_file_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="which is a folder"):
        check_writable(tmp_path, "Road points")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission_is_refused(tmp_path):
    tmp_path.chmod(0o555)
    try:
        with pytest.raises(RoadExtractionError, match="cannot be written"):
            check_writable(tmp_path / "road.laz", "Road points")
    finally:
        tmp_path.chmod(0o755)


@pytest.mark.parametrize("name, path, writes", [
    ("ROAD_POINTS", "road.txt", r"\.laz or \.las"), ("ROAD_POINTS", "road.copc.laz", r"\.laz or \.las"),
    ("INTENSITY_IMAGE", "image.png", r"\.tif or \.tiff"), ("REPORT", "report.pdf", r"\.html or \.htm"),
])
def test_a_name_that_promises_another_kind_of_file_is_refused(provider, name, path, writes):
    with pytest.raises(RoadExtractionError, match=writes):
        check_suffix(Path(path), RoadMap().parameter(name), QgisCall.VECTOR_SUFFIXES)


@pytest.mark.parametrize("name, path", [
    ("ROAD_POINTS", "Road.LAZ"), ("ROAD_POINTS", "road.las"), ("INTENSITY_IMAGE", "image.tiff"), ("REPORT", "r.html"), ("MARKINGS", "m.fgb"),
])
def test_a_name_that_fits_is_taken(provider, name, path):
    check_suffix(Path(path), RoadMap().parameter(name), QgisCall.VECTOR_SUFFIXES)


@pytest.mark.parametrize("files", [["map.gpkg"], ["edges.shp", "edges.dbf", "edges.shx"], ["edges.fgb"]])
def test_a_layer_that_cannot_be_written_leaves_yesterdays(tmp_path, files):
    for name in files:
        (tmp_path / name).write_text("yesterday")
    replaced = ReplacedFiles()
    replaced.set_aside(str(tmp_path / files[0]))
    replaced.set_aside(str(tmp_path / "new.gpkg"))
    assert all(name.endswith(".previous") for name in os.listdir(tmp_path)), "room is made"
    for name in (files[0], "new.gpkg", "new.gpkg-journal"):
        (tmp_path / name).write_text("half")
    replaced.put_back()
    assert sorted(os.listdir(tmp_path)) == sorted(files)
    assert all((tmp_path / name).read_text() == "yesterday" for name in files)


def test_a_layer_that_was_written_is_todays(tmp_path):
    (tmp_path / "map.gpkg").write_text("yesterday")
    replaced = ReplacedFiles()
    replaced.set_aside(str(tmp_path / "map.gpkg"))
    (tmp_path / "map.gpkg").write_text("today")
    replaced.forget()
    assert os.listdir(tmp_path) == ["map.gpkg"] and (tmp_path / "map.gpkg").read_text() == "today"


def test_a_new_layer_of_a_geopackage_leaves_the_others_alone(tmp_path):
    (tmp_path / "map.gpkg").write_text("the others")
    replaced = ReplacedFiles()
    replaced.set_aside(f"ogr:dbname='{tmp_path}/map.gpkg' table=\"road_edges\" (geom)")
    replaced.put_back()
    assert (tmp_path / "map.gpkg").read_text() == "the others"


def test_a_run_that_fails_asks_for_no_layer_to_be_loaded(provider, tmp_path):
    """QGIS lists what it could not load in red, below the one sentence that matters."""
    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    write_cloud(tmp_path / "points.laz", *np.random.default_rng(1).uniform(0.0, 0.001, (3, 100)), crs="EPSG:4326")
    (tmp_path / "drive.csv").write_text("x,y,z\n0,0,0\n1,1,0\n")
    wanted = QgsProcessingOutputLayerDefinition(str(tmp_path / "intensity.tif"), QgsProject.instance())
    algorithm = provider.algorithm("roadmap").create()
    given = {"POINT_CLOUDS": [str(tmp_path / "points.laz")], "TRAJECTORY": str(tmp_path / "drive.csv"), "INTENSITY_IMAGE": wanted}
    _, done = algorithm.run(given, context, QgsProcessingFeedback())
    assert not done and not context.layersToLoadOnCompletion()
