"""Results appear whole or not at all."""

import os
import sqlite3
import time
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from drives import write_cloud
from lanewright.algorithms import destinations
from lanewright.algorithms.destinations import Unfinished, check_suffix, check_writable, destination_path, table_of
from lanewright.algorithms.driving import RoadMap
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.weights import IO
from lanewright.processing_provider.call import QgisCall
from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputLayerDefinition, QgsProject, QgsVectorLayer


def test_yesterdays_result_stands_until_todays_is_complete(tmp_path):
    result = tmp_path / "road.laz"
    result.write_text("yesterday")
    files = Unfinished()
    with open(files.begin(result), "w") as stream:
        stream.write("today")
    assert result.read_text() == "yesterday"
    files.commit()
    assert result.read_text() == "today" and os.listdir(tmp_path) == ["road.laz"]


def test_a_run_that_fails_leaves_no_half_file(tmp_path):
    files = Unfinished()
    with open(files.begin(tmp_path / "road.laz"), "w") as stream:
        stream.write("half")
    files.discard()
    assert os.listdir(tmp_path) == []


def test_a_message_names_the_file_as_the_user_does(tmp_path):
    files = Unfinished()
    said = files.in_users_names(f"{files.begin(tmp_path / 'road.laz')} cannot be written.")
    files.discard()
    assert said == f"{tmp_path / 'road.laz'} cannot be written."


def test_statistics_beside_an_image_go_with_it(tmp_path):
    files = Unfinished()
    name = files.begin(tmp_path / "image.tif")
    name.touch()
    Path(f"{name}.aux.xml").touch()
    files.commit()
    assert sorted(os.listdir(tmp_path)) == ["image.tif", "image.tif.aux.xml"]


def test_a_drawing_whose_name_ends_as_statistics_do_replaces_yesterdays(tmp_path):
    (tmp_path / "road.xml").write_text("yesterday")
    files = Unfinished()
    files.begin(tmp_path / "road.xml").write_text("today")
    files.commit()
    assert (tmp_path / "road.xml").read_text() == "today" and os.listdir(tmp_path) == ["road.xml"]


@pytest.mark.parametrize("value, path", [
    ("lines.gpkg", "lines.gpkg"),
    ("ogr:dbname='/data/all.gpkg' table=\"lanes\" (geom)", "/data/all.gpkg"),
    ("ogr:dbname='/home/O\\'Neil/all.gpkg' table=\"lanes\" (geom)", "/home/O'Neil/all.gpkg"),
    ("ogr:dbname='/home/O'Neil/all.gpkg' table=\"lanes\" (geom)", "/home/O'Neil/all.gpkg"),
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


LAYERS = [["map.gpkg"], ["edges.dbf", "edges.shp", "edges.shx"], ["edges.fgb"]]


def write(folder, names, text):
    for name in names:
        (folder / name).write_text(text)


@pytest.mark.parametrize("files", LAYERS)
def test_a_layer_that_cannot_be_written_leaves_yesterdays(tmp_path, files):
    write(tmp_path, files, "yesterday")
    layers = Unfinished()
    main = next(name for name in files if name != "edges.dbf" and name != "edges.shx")
    write(layers.begin(tmp_path / main).parent, files[:1], "half")
    assert all((tmp_path / name).read_text() == "yesterday" for name in files)
    layers.discard()
    assert sorted(os.listdir(tmp_path)) == files


@pytest.mark.parametrize("files", LAYERS)
def test_a_layer_that_was_written_is_todays_in_all_its_parts(tmp_path, files):
    write(tmp_path, files, "yesterday")
    layers = Unfinished()
    main = next(name for name in files if name != "edges.dbf" and name != "edges.shx")
    write(layers.begin(tmp_path / main).parent, files, "today")
    layers.commit()
    assert sorted(os.listdir(tmp_path)) == files
    assert all((tmp_path / name).read_text() == "today" for name in files)


def test_of_a_shapefile_no_parts_of_two_layers_are_ever_read_as_one(tmp_path, monkeypatch):
    write(tmp_path, LAYERS[1], "yesterday")
    layers, seen = Unfinished(), []
    write(layers.begin(tmp_path / "edges.shp").parent, LAYERS[1], "today")

    def looked(unfinished, path, finish=destinations.finish_file):
        seen.append((tmp_path / "edges.shp").exists())
        finish(unfinished, path)

    monkeypatch.setattr(destinations, "finish_file", looked)
    layers.commit()
    assert seen == [False, False, False] and (tmp_path / "edges.shp").read_text() == "today"


def test_what_a_journal_holds_is_not_played_into_the_next_database_of_that_name(tmp_path):
    """As after a crash of QGIS: rows that were written lie in the journal alone."""
    def database(path, rows, leave_journal):
        made = sqlite3.connect(path, isolation_level=None)
        made.execute("PRAGMA journal_mode=WAL")
        made.execute("CREATE TABLE lanes (id INTEGER)")
        made.executemany("INSERT INTO lanes VALUES (?)", [(k,) for k in range(rows)])
        if leave_journal:
            copies = {suffix: Path(f"{path}{suffix}").read_bytes() for suffix in ("", "-wal")}
        made.close()
        for suffix, content in copies.items() if leave_journal else ():
            Path(f"{path}{suffix}").write_bytes(content)

    database(tmp_path / "map.gpkg", 500, leave_journal=True)
    layers = Unfinished()
    copied = layers.begin_copy(tmp_path / "map.gpkg")
    with closing(sqlite3.connect(copied)) as copy:
        assert copy.execute("SELECT count(*) FROM lanes").fetchone() == (500,), "the table to which another is added is whole"
        copy.execute("CREATE TABLE edges (id INTEGER)")
    layers.commit()
    assert os.listdir(tmp_path) == ["map.gpkg"]
    with closing(sqlite3.connect(tmp_path / "map.gpkg")) as whole:
        assert whole.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert whole.execute("SELECT count(*) FROM edges").fetchone() == (0,)


def test_what_killed_runs_left_goes_after_a_day_and_what_a_run_of_today_writes_stays(tmp_path):
    left = [Unfinished().begin(tmp_path / "map.gpkg") for _ in range(2)]
    for path in left:
        path.write_text("half")
    long_ago = time.time() - 2 * IO.abandoned_time
    for path in (left[0], left[0].parent):
        os.utime(path, (long_ago, long_ago))
    Unfinished().begin(tmp_path / "map.gpkg")
    assert not left[0].parent.exists() and left[1].exists()


def test_a_layer_is_written_into_a_folder_with_an_apostrophe_in_its_name(provider, tmp_path):
    folder = tmp_path / "O'Neil's roads"
    folder.mkdir()
    (folder / "drive.csv").write_text("time,x,y,z\n" + "".join(f"{k},{500000 + k},4000000,10\n" for k in range(20)))
    algorithm, feedback = provider.algorithm("importtrajectory").create(), QgsProcessingFeedback()
    for _ in range(2):  # the second time the table is there
        results, done = algorithm.run({"INPUT": str(folder / "drive.csv"), "INPUT_CRS": "EPSG:32650",
                                       "OUTPUT": table_of(folder / "map.gpkg", "drive")}, QgsProcessingContext(), feedback)
        assert done, feedback.textLog()
        assert QgsVectorLayer(results["OUTPUT"], "drive", "ogr").featureCount() == 20
    assert sorted(os.listdir(folder)) == ["drive.csv", "map.gpkg"] and os.listdir(tmp_path) == [folder.name]


def made_table(path, table, rows):
    with closing(sqlite3.connect(path)) as database:
        return database.execute(f'SELECT count(*) FROM "{table}"').fetchone()[0] == rows


def test_a_table_is_replaced_in_its_geopackage_while_qgis_has_it_open_and_the_users_own_table_is_edited(provider, tmp_path):
    """Edits of another table of the database that are not saved yet are not lost, and the new rows are seen by the open layer."""
    (tmp_path / "short.csv").write_text("time,x,y,z\n" + "".join(f"{k},{500000 + k},4000000,10\n" for k in range(20)))
    (tmp_path / "long.csv").write_text("time,x,y,z\n" + "".join(f"{k},{500000 + k},4000000,10\n" for k in range(30)))

    def written(name, table):
        algorithm, feedback = provider.algorithm("importtrajectory").create(), QgsProcessingFeedback()
        results, done = algorithm.run({"INPUT": str(tmp_path / f"{name}.csv"), "INPUT_CRS": "EPSG:32650",
                                       "OUTPUT": f"ogr:dbname='{tmp_path}/map.gpkg' table=\"{table}\" (geom)"}, QgsProcessingContext(), feedback)
        assert done, feedback.textLog()
        return results["OUTPUT"]

    layers = {table: QgsVectorLayer(written("short", table), table, "ogr") for table in ("lines", "own")}
    layers["own"].startEditing()
    layers["lines"].startEditing()
    assert layers["own"].deleteFeature(1)
    written("long", "lines")
    assert layers["own"].commitChanges(), layers["own"].commitErrors()
    layers["lines"].rollBack()
    layers["lines"].reload()
    assert len(list(layers["lines"].getFeatures())) == 30
    layers.clear()
    assert made_table(tmp_path / "map.gpkg", "lines", 30) and made_table(tmp_path / "map.gpkg", "own", 19)
    assert [name for name in os.listdir(tmp_path) if name.startswith(".")] == []


def test_what_is_loaded_is_the_layer_at_its_place(provider, tmp_path):
    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    (tmp_path / "drive.csv").write_text("time,x,y,z\n" + "".join(f"{k},{500000 + k},4000000,10\n" for k in range(20)))
    wanted = QgsProcessingOutputLayerDefinition(str(tmp_path / "lines.gpkg"), QgsProject.instance())
    results, done = provider.algorithm("importtrajectory").create().run(
        {"INPUT": str(tmp_path / "drive.csv"), "INPUT_CRS": "EPSG:32650", "OUTPUT": wanted}, context, QgsProcessingFeedback())
    assert done and list(context.layersToLoadOnCompletion()) == [results["OUTPUT"]] == [str(tmp_path / "lines.gpkg")]


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
