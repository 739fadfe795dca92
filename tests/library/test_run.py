"""Algorithms from Python and from the command line: results whole or not at all."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import fiona
import pytest
from lanewright.algorithms.catalogue import ALGORITHMS
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.library import Progress, algorithms, call, command_line, layer_files, run

ROOT = Path(__file__).resolve().parents[2]
SMALL = {"LENGTH": 20, "PULSE_RATE": 20000}


@pytest.fixture(scope="module")
def survey(made_once):
    return made_once("library_survey", lambda folder: run("samplesurvey", **SMALL, POINT_CLOUD=folder / "s.laz", TRAJECTORY=folder / "drive.gpkg",
                                                          TRUTH_BOUNDARIES=folder / "truth.gpkg"))


def files(folder):
    return {name: (folder / name).read_bytes() for name in os.listdir(folder)}


def test_a_sample_survey_is_written_and_reported(tmp_path):
    results = run("samplesurvey", **SMALL, POINT_CLOUD=tmp_path / "s.laz", TRAJECTORY=f"ogr:dbname='{tmp_path}/s.gpkg' table=\"drive\" (geom)")
    assert results["POINT_CLOUD"] == str(tmp_path / "s.laz") and results["POINTS"] > 1000
    assert results["TRAJECTORY"] == f"{tmp_path}/s.gpkg|layername=drive" and sorted(os.listdir(tmp_path)) == ["s.gpkg", "s.laz"]
    with fiona.open(tmp_path / "s.gpkg", layer="drive") as layer:
        assert len(layer) > 100 and layer.schema["geometry"] == "3D Point"


def test_a_result_of_one_step_is_read_by_the_next(survey, tmp_path):
    results = run("lanewright:importtrajectory", INPUT=survey / "drive.gpkg", POINT_CLOUDS=[survey / "s.laz"],
                  OUTPUT=f"{tmp_path}/all.gpkg|layername=trajectory")
    assert run("importtrajectory", INPUT=results["OUTPUT"], OUTPUT=tmp_path / "again.gpkg")["ROWS"] == results["ROWS"]


def test_a_run_that_is_cancelled_leaves_what_was_there(tmp_path):
    class Stop(Progress):
        def report(self, fraction):
            if fraction > 0.5:
                raise Cancelled

    (tmp_path / "s.laz").write_text("previous")
    before = files(tmp_path)
    with pytest.raises(Cancelled):
        run("samplesurvey", Stop(), **SMALL, POINT_CLOUD=tmp_path / "s.laz", TRAJECTORY=tmp_path / "drive.gpkg")
    assert files(tmp_path) == before


def test_a_layer_that_cannot_be_written_leaves_what_was_there(survey, tmp_path, monkeypatch):
    """The first layer is whole when the second fails; neither appears, nor does the cloud."""
    output = {"POINT_CLOUD": tmp_path / "s.laz", "TRAJECTORY": f"{tmp_path}/s.gpkg|layername=drive", "TRUTH_SURFACE": tmp_path / "surface.gpkg"}
    run("samplesurvey", **SMALL, **output)
    before, write = files(tmp_path), call.write_layer

    def full_disk(path, table, features, check_cancelled):
        if path.endswith("surface.gpkg"):
            raise OSError(28, "No space left on device", path)
        write(path, table, features, check_cancelled)

    monkeypatch.setattr(call, "write_layer", full_disk)
    with pytest.raises(RoadExtractionError, match=f"No space left on device: {tmp_path}/surface.gpkg"):
        run("samplesurvey", **{**SMALL, "LENGTH": 25}, **output)
    assert files(tmp_path) == before


def test_a_new_table_leaves_the_others_of_its_geopackage(survey, tmp_path):
    for table in ("first", "second"):
        run("importtrajectory", INPUT=survey / "drive.gpkg", OUTPUT=f"{tmp_path}/map.gpkg|layername={table}")
    assert fiona.listlayers(tmp_path / "map.gpkg") == ["first", "second"] and os.listdir(tmp_path) == ["map.gpkg"]


def test_a_shapefile_goes_with_all_its_files(survey, tmp_path):
    (tmp_path / "drive.qix").write_text("an index of what was there")
    (tmp_path / "drive.shp").write_text("what was there")
    run("importtrajectory", INPUT=survey / "drive.gpkg", OUTPUT=tmp_path / "drive.shp")
    assert {"drive.shp", "drive.shx", "drive.dbf", "drive.prj"} <= set(os.listdir(tmp_path)) and "drive.qix" not in os.listdir(tmp_path)


@pytest.mark.parametrize("name, given, says", [
    ("importtrajectory", {"INPUT": "drive.gpkg", "OUTPUT": "drive.gpkg"}, "would be written over .*drive.gpkg, which is read as"),
    ("importtrajectory", {"INPUT": "nothing.csv", "OUTPUT": "o.gpkg"}, "there is no file .*nothing.csv"),
    ("importtrajectory", {"INPUT": "drive.gpkg", "OUTPUT": "o.dxf"}, "a DXF has no fields"),
    ("importtrajectory", {"INPUT": "drive.gpkg", "OUTPUT": "o.xyz"}, "Use .gpkg, .fgb or .shp"),
    ("importtrajectory", {"INPUT": "drive.gpkg", "OUTPUT": "nowhere/o.gpkg"}, "there is no folder"),
    ("importtrajectory", {"INPUT": "drive.gpkg", "OUTPUT": "o.gpkg", "TARGET_CRS": "EPSG:0"}, "CRS to bring it to: the CRS EPSG:0 is not known"),
    ("detectcurbs", {"POINT_CLOUDS": ["nothing.laz"], "TRAJECTORY": "drive.gpkg", "CURB_POINTS": "c.gpkg"}, "Point clouds: there is no file"),
    ("roadmaps", {}, "There is no algorithm roadmaps"),
])
def test_what_cannot_work_is_said_in_one_sentence(survey, tmp_path, monkeypatch, name, given, says):
    for file in ("drive.gpkg", "s.laz"):
        (tmp_path / file).write_bytes((survey / file).read_bytes())
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RoadExtractionError, match=says):
        run(name, **given)
    assert sorted(os.listdir(tmp_path)) == ["drive.gpkg", "s.laz"]


def test_a_database_that_is_not_there_is_said_and_no_file_needs_to_be_named(survey, tmp_path, monkeypatch):
    """Outside QGIS a connection is a service of PostgreSQL, so that no password stands in a command."""
    gdal = pytest.importorskip("osgeo.gdal")
    monkeypatch.setenv("PGSERVICEFILE", str(tmp_path / "services.conf"))
    (tmp_path / "client.csv").write_text("from;layer\nROAD_EDGES;A")
    given = dict(TEMPLATE=tmp_path / "client.csv", ROAD_EDGES=survey / "truth.gpkg")
    (tmp_path / "services.conf").touch()
    says = '"b12" not found' if gdal.GetDriverByName("PostgreSQL") else "built without PostgreSQL"
    for further, said in ((dict(CONNECTION="b12", SCHEMA="roads"), f"b12, schema roads could not be read .*{says}"),
                          (dict(CONNECTION="b12"), "Nothing says where the map goes"), ({}, "Nothing says where the map goes")):
        with pytest.raises(RoadExtractionError, match=said):
            run("exporttemplate", **given, **further)


def test_without_gdal_rasters_are_refused_with_what_to_install(survey, tmp_path, monkeypatch):
    find = layer_files.find_spec
    monkeypatch.setattr(layer_files, "find_spec", lambda name: None if name == "osgeo" else find(name))
    for name, outputs in (("roadmap", {"INTENSITY_IMAGE": tmp_path / "i.tif"}), ("inspectsurvey", {"REPORT": tmp_path / "r.html",
                                                                                            "DENSITY": tmp_path / "d.tif"})):
        with pytest.raises(RoadExtractionError, match=r"raster, which needs GDAL's Python module.*lanewright\[gdal\].*python3-gdal"):
            run(name, POINT_CLOUDS=[survey / "s.laz"], TRAJECTORY=survey / "drive.gpkg", **outputs)


@pytest.mark.slow
def test_without_gdal_the_road_map_and_its_report_are_those_with_it(survey, tmp_path, monkeypatch):
    layers = ("ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES")
    rows = {}
    for gdal in ("with", "without"):
        if gdal == "without":
            monkeypatch.setitem(sys.modules, "osgeo", None)
        run("roadmap", POINT_CLOUDS=[survey / "s.laz"], TRAJECTORY=survey / "drive.gpkg", REPORT=tmp_path / f"{gdal}.html",
            **{name: f"{tmp_path / gdal}.gpkg|layername={name}" for name in layers})
        rows[gdal] = {name: [(row.geometry.coordinates, dict(row.properties)) for row in fiona.open(tmp_path / f"{gdal}.gpkg", layer=name)]
                      for name in layers}
    assert rows["with"] == rows["without"] and all(rows["with"].values())
    assert all("<img" in (tmp_path / f"{gdal}.html").read_text() for gdal in rows)


@pytest.mark.slow
def test_the_demo_makes_a_survey_its_map_and_how_good_it_is(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "osgeo", None)  # as pip installs it
    monkeypatch.setattr(command_line, "DEMO", {"LENGTH": 40, "PULSE_RATE": 60000})
    assert command_line.main(["demo", str(tmp_path / "here")]) == 0
    printed = capsys.readouterr().out
    assert {"street.laz", "trajectory.gpkg", "truth.gpkg", "road_map.gpkg", "report.html", "accuracy.gpkg", "accuracy.html"} == set(
        os.listdir(tmp_path / "here"))
    assert "driving_lines" in fiona.listlayers(tmp_path / "here" / "road_map.gpkg") and "COMPLETENESS" in printed
    (tmp_path / "file").touch()
    assert command_line.main(["demo", str(tmp_path / "file")]) == 1 and "there is no folder" in capsys.readouterr().err


def test_scanlines_are_refused_before_the_work_where_they_cannot_be_written(survey, tmp_path, monkeypatch):
    inputs = {"POINT_CLOUDS": [survey / "s.laz"], "TRAJECTORY": survey / "drive.gpkg"}
    with pytest.raises(RoadExtractionError, match="lines with measures. Write a GeoPackage"):
        run("normalizedscanlines", **inputs, SCANLINES=tmp_path / "s.fgb")
    find = layer_files.find_spec
    monkeypatch.setattr(layer_files, "find_spec", lambda name: None if name == "osgeo" else find(name))
    with pytest.raises(RoadExtractionError, match="Normalized scanlines are lines with measures, which needs GDAL's"):
        run("normalizedscanlines", **inputs, SCANLINES=tmp_path / "s.gpkg")


def test_rows_of_a_reference_are_excluded_by_a_condition(survey, tmp_path):
    numbers = [run("assessboundaries", INPUT=survey / "truth.gpkg", REFERENCE=survey / "truth.gpkg", OUTPUT=tmp_path / "o.gpkg", **more)
               for more in ({}, {"EXCLUDED": "\"side\" = 'left'"})]
    assert numbers[0]["F1"] == numbers[1]["F1"] == pytest.approx(100.0)
    assert numbers[1]["EXCLUDED_INTERVALS"] > numbers[0]["EXCLUDED_INTERVALS"]


def test_the_command_prints_results_on_lines_and_says_the_rest_on_stderr(survey, tmp_path, capsys):
    code = command_line.main(["importtrajectory", f"--INPUT={survey}/drive.gpkg", f"--OUTPUT={tmp_path}/o.gpkg"])
    printed = capsys.readouterr()
    assert code == 0 and re.fullmatch(rf"OUTPUT: {re.escape(str(tmp_path))}/o.gpkg\nROWS: \d+\nWARNINGS: 0\n", printed.out)
    assert "Trajectory: " in printed.err


def test_json_holds_the_results_or_the_reason_of_a_failure(survey, tmp_path, capsys):
    assert command_line.main(["importtrajectory", "--json", f"--INPUT={survey}/drive.gpkg", f"--OUTPUT={tmp_path}/o.gpkg"]) == 0
    assert json.loads(capsys.readouterr().out)["results"]["OUTPUT"] == f"{tmp_path}/o.gpkg"
    assert command_line.main(["importtrajectory", f"--INPUT={tmp_path}/none.csv", f"--OUTPUT={tmp_path}/o.gpkg", "--json"]) == 1
    printed = capsys.readouterr()
    assert "none.csv" in json.loads(printed.out)["error"] and printed.err.count("\n") == 1


@pytest.mark.parametrize("arguments, says", [
    (["roadmaps"], "There is no algorithm roadmaps"), (["list", "--json=1"], "Argument --json: ignored explicit argument"),
    (["roadmap", "--NO=1"], "Unrecognized arguments: --NO=1. Try: lanewright roadmap --help"),
    (["fitroadedges"], "was not given and fitroadedges needs it"), (["samplesurvey", "--LENGTH=x", "--POINT_CLOUD=a.laz", "--TRAJECTORY=b.gpkg"],
                                                                    "must be a number from"),
])
def test_what_was_typed_wrong_is_one_line_on_stderr(capsys, arguments, says):
    assert command_line.main(arguments) == 1
    printed = capsys.readouterr()
    assert not printed.out and says in printed.err and printed.err.count("\n") == 1


@pytest.mark.parametrize("declared", ALGORITHMS, ids=lambda declared: declared.ID)
def test_the_help_of_every_algorithm_explains_every_parameter(capsys, declared):
    with pytest.raises(SystemExit) as ended:
        command_line.main([declared.ID, "--help"])
    text = re.sub(r"\s+", "", capsys.readouterr().out)
    algorithm = declared()
    assert ended.value.code == 0 and re.sub(r"\s+", "", algorithm.summary()) in text
    for spec in algorithm.parameters:
        assert f"--{spec.name}" in text and re.sub(r"\s+", "", f"{spec.label}. {spec.help}") in text, spec.name


def test_every_algorithm_is_listed(capsys):
    for word in ("list", "--help"):
        assert command_line.main([word]) == 0
        text = capsys.readouterr().out
        assert all(re.search(rf"^ *{name} ", text, re.M) for name in algorithms())
    assert command_line.main(["--version"]) == 0 and re.fullmatch(r"lanewright \d+\.\d+.*\n", capsys.readouterr().out)


@pytest.mark.slow
def test_ctrl_c_ends_a_run_and_leaves_nothing(tmp_path):
    code = ("import importlib.util as u, sys; s = u.spec_from_file_location('lanewright', sys.argv[1], submodule_search_locations=[sys.argv[2]]); "
            "m = u.module_from_spec(s); sys.modules['lanewright'] = m; s.loader.exec_module(m); "
            "from lanewright.library.command_line import main; sys.exit(main(sys.argv[3:]))")
    program = subprocess.Popen([sys.executable, "-c", code, str(ROOT / "__init__.py"), str(ROOT), "samplesurvey", "--LENGTH=2000",
                                f"--POINT_CLOUD={tmp_path}/s.laz", f"--TRAJECTORY={tmp_path}/d.gpkg"], stderr=subprocess.PIPE, text=True)
    while not os.listdir(tmp_path) and program.poll() is None:
        time.sleep(0.1)
    program.send_signal(signal.SIGINT)
    _, said = program.communicate(timeout=60)
    assert program.returncode == 130 and said.endswith("Cancelled\n") and not os.listdir(tmp_path)
