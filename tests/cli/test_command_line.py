"""The command line as a user has it, called from any folder: the real qgis_process where it matters that it is (see `words`)."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import laspy
import numpy as np
import pytest
from copc_files import write_vpc
from spoken import complaints
from words import OPEN_ELSEWHERE

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
QGIS_PROCESS = str(ROOT / "tools" / "qgis_process")


def qgis_process(*arguments, folder, **options):
    return subprocess.run([QGIS_PROCESS, *arguments], cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL, **options)


@pytest.fixture(scope="session")
def survey(sample_survey, tmp_path_factory):
    """A folder with a small sample survey: s.laz, drive.gpkg and drive.csv."""
    folder = tmp_path_factory.mktemp("survey")
    shutil.copytree(sample_survey(LENGTH=30, PULSE_RATE=60000, ROTATION_RATE=100), folder, dirs_exist_ok=True, ignore=OPEN_ELSEWHERE)
    subprocess.run(
        ["ogr2ogr", "-f", "CSV", "-sql", "SELECT time, ST_X(geom) x, ST_Y(geom) y, ST_Z(geom) z FROM drive", "drive.csv", "drive.gpkg"],
        cwd=folder, check=True, capture_output=True,
    )
    return folder


def one_sentence(run):
    """What went wrong; we say nothing besides."""
    assert run.returncode == 1, run.stdout + run.stderr
    said = complaints(run.stderr)
    assert len(said) == 1, run.stderr
    return said.pop()


def test_a_failure_is_said_once_and_in_json_where_that_is_asked_for(tmp_path):
    """By - here, which reads the values in JSON too; a whole run by --json below."""
    given = json.dumps({"inputs": {"POINT_CLOUDS": ["none.laz"], "TRAJECTORY": "none.csv", "REPORT": "r.html"}})
    run = subprocess.run([QGIS_PROCESS, "run", "lanewright:inspectsurvey", "-"], cwd=tmp_path, input=given, capture_output=True, text=True)
    assert run.returncode == 1 and run.stderr.count("there is no file none.laz") == 1, run.stderr
    assert "there is no file none.laz" in json.loads(run.stdout)["error"]


def test_all_algorithms_and_the_model_are_listed_and_another_python_first_on_the_path_is_not_taken_for_that_of_qgis(tmp_path):
    """As under pyenv or conda: a python3 with a library of its own, in which there is no QGIS."""
    version = subprocess.run(["/usr/bin/python3", "-c", "import sys; print('python%d.%d' % sys.version_info[:2])"],
                             capture_output=True, text=True, check=True).stdout.strip()
    program, landmark = tmp_path / "bin" / "python3", tmp_path / "lib" / version / "os.py"
    for file in (program, landmark):
        file.parent.mkdir(parents=True)
        file.write_text("")
    program.chmod(0o755)
    run = qgis_process("list", folder=tmp_path, env=dict(os.environ, PATH=f"{program.parent}:{os.environ['PATH']}"))
    assert "lanewright:roadmap\t" in run.stdout and "lanewright:roadmapstages" in run.stdout, run.stderr


def test_a_trajectory_comes_from_a_csv_as_from_its_layer(survey, called, tmp_path):
    stage = ("run", "lanewright:importtrajectory", "--TARGET_CRS=EPSG:32650", "--OUTPUT=out.gpkg")
    layer = called(*stage, f"--INPUT={survey / 'drive.gpkg'}", folder=tmp_path)
    rows = layer.results["ROWS"]
    table = called(*stage, f"--INPUT={survey / 'drive.csv'}", folder=tmp_path)
    assert layer.returncode == table.returncode == 0, layer.stderr + table.stderr
    assert rows == table.results["ROWS"] > 100


def test_a_trajectory_without_crs_is_taken_with_a_warning(survey, called, tmp_path):
    run = called("run", "lanewright:importtrajectory", f"--INPUT={survey / 'drive.csv'}", "--OUTPUT=out.gpkg", folder=tmp_path)
    assert run.returncode == 0 and "names no CRS and none was given" in run.stdout + run.stderr
    run = called("run", "lanewright:importtrajectory", f"--INPUT={survey / 'drive.csv'}", "--INPUT_CRS=EPSG:32650", "--OUTPUT=out.gpkg",
                       folder=tmp_path)
    assert run.returncode == 0 and "CRS" not in (run.stdout + run.stderr).replace("INPUT_CRS", "")


def test_an_image_without_a_position_is_georeferenced_and_the_false_alarm_explained(called, tmp_path):
    made = called("run", "lanewright:samplesurvey", "--LENGTH=30", "--PULSE_RATE=20000", "--POINT_CLOUD=s.laz", "--TRAJECTORY=drive.gpkg",
                  "--UAV_IMAGE=uav.tif", "--UAV_GCPS=gcps.gpkg", folder=tmp_path)
    assert made.returncode == 0, made.stderr
    run = qgis_process("run", "lanewright:georeferenceimage", "--IMAGE=uav.tif", "--GCPS=gcps.gpkg", "--ORDER=2", "--OUTPUT=map.tif", folder=tmp_path)
    assert run.returncode == 0 and (tmp_path / "map.tif").stat().st_size > 10_000
    assert "GDAL ERROR 1: Unable to compute a transformation, is QGIS saying the same and harmless" in run.stdout


def test_a_survey_of_a_virtual_point_cloud_is_inspected_with_numbers_and_a_report(survey, tmp_path):
    write_vpc(tmp_path / "all.vpc", [f"./{os.path.relpath(survey / 's.laz', tmp_path)}"])
    run = qgis_process(
        "run", "lanewright:inspectsurvey", "--POINT_CLOUDS=all.vpc", f"--TRAJECTORY={survey / 'drive.csv'}",
        "--REPORT=report.html", "--DENSITY=density.tif", "--json", folder=tmp_path,
    )
    assert run.returncode == 0, run.stderr
    assert not complaints(run.stderr), "QGIS tries no cloud as a layer of its own"
    results = json.loads(run.stdout)["results"]
    assert results["SCANNERS"] == 2 and results["TIME_COVERED"] == 100 and results["NEAR_TRAJECTORY"] > 99
    assert "Survey: " in json.dumps(json.loads(run.stdout)["log"]) and "of the points lie within 25 m of it" in run.stdout
    report = (tmp_path / "report.html").read_text()
    assert "s.laz" in report and "Points per m" in report and (tmp_path / "density.tif").stat().st_size > 300


def changed_cloud(survey, path, change):
    cloud = laspy.read(survey / "s.laz")
    change(cloud)
    cloud.write(str(path))


def empty(survey, folder):
    def none(cloud):
        cloud.points = cloud.points[:0]

    changed_cloud(survey, folder / "bad.laz", none)


def cut_off(survey, folder):
    whole = (survey / "s.laz").read_bytes()
    (folder / "bad.laz").write_bytes(whole[: len(whole) // 2])


def far_away(survey, folder):
    def move(cloud):
        cloud.x = np.asarray(cloud.x) + 5000.0

    changed_cloud(survey, folder / "bad.laz", move)


def another_day(survey, folder):
    def later(cloud):
        cloud.gps_time = np.asarray(cloud.gps_time) + 5 * 86400.0 + 777.0

    changed_cloud(survey, folder / "bad.laz", later)


def in_degrees(survey, folder):
    def degrees(cloud):
        from pyproj import CRS

        cloud.header.vlrs.clear()
        cloud.header.add_crs(CRS.from_epsg(4326))

    changed_cloud(survey, folder / "bad.laz", degrees)


def not_a_cloud(survey, folder):
    (folder / "bad.laz").write_text("x,y,z\n1,2,3\n")


def a_zip(survey, folder):
    """Nothing of it is unpacked."""
    import zipfile

    with zipfile.ZipFile(folder / "bad.laz", "w") as archive:
        archive.write(survey / "s.laz", "s.laz")


def without_scale(survey, folder):
    """Every coordinate is no number then."""
    whole = bytearray((survey / "s.laz").read_bytes())
    whole[131:155] = np.full(3, np.nan).tobytes()
    (folder / "bad.laz").write_bytes(whole)


def nothing(survey, folder):
    pass


@pytest.mark.parametrize("cloud, says", [
    (nothing, "no file bad.laz"),
    (not_a_cloud, "cannot be read as a LAS/LAZ file"),
    (empty, "holds? no points"),
    (cut_off, "damaged|cut off|cannot be read"),
    (far_away, "does not run through the point cloud|not near"),
    (another_day, "does not cover the scan in time"),
    (in_degrees, "geographic CRS"),
    (a_zip, "cannot be read as a LAS/LAZ file"),
    (without_scale, "bad.laz gives its points no coordinates: its header says scales of nan"),
], ids=lambda value: getattr(value, "__name__", ""))
def test_a_cloud_that_cannot_be_worked_with_is_told_in_one_sentence(survey, called, tmp_path, cloud, says):
    cloud(survey, tmp_path)
    before = set(os.listdir(tmp_path))
    run = called(
        "run", "lanewright:detectcurbs", "--POINT_CLOUDS=bad.laz", f"--TRAJECTORY={survey / 'drive.csv'}",
        "--CURB_POINTS=curbs.gpkg", folder=tmp_path,
    )
    assert re.search(says, one_sentence(run)), run.stderr
    assert set(os.listdir(tmp_path)) == before


def test_yesterdays_layer_stands_when_todays_run_fails(survey, called, tmp_path):
    good = ("run", "lanewright:importtrajectory", "--OUTPUT=out.gpkg")
    assert called(*good, f"--INPUT={survey / 'drive.gpkg'}", folder=tmp_path).returncode == 0
    yesterday = (tmp_path / "out.gpkg").read_bytes()
    (tmp_path / "bad.csv").write_text("time,x,y,z\n1,2,3,4\n")
    one_sentence(called(*good, "--INPUT=bad.csv", folder=tmp_path))
    assert (tmp_path / "out.gpkg").read_bytes() == yesterday


def test_a_setting_beyond_reason_is_refused(survey, called, tmp_path):
    run = called(
        "run", "lanewright:detectcurbs", f"--POINT_CLOUDS={survey / 's.laz'}", f"--TRAJECTORY={survey / 'drive.csv'}",
        "--MIN_HEIGHT=0.3", "--MAX_HEIGHT=0.1", "--CURB_POINTS=curbs.gpkg", folder=tmp_path,
    )
    assert "curb" in one_sentence(run).lower()


@pytest.mark.parametrize("outputs, says", [
    (("--ROAD_EDGES=a.gpkg", "--MARKINGS=a.gpkg"), "Road edges and Markings would both be written to a.gpkg"),
    (("--INTENSITY_IMAGE=i.png",), "written as .tif or .tiff only"),
    (("--CRS=EPSG:999999",), "the CRS EPSG:999999 is not known"),
    (("--CELL_SIZE=-0.04",), "CELL_SIZE) is -0.04; it must be a number from"),
    (("--BOUNDARY_METHOD=magic",), "BOUNDARY_METHOD) is magic; it must be one of profiles, scanlines, both"),
])
def test_what_cannot_be_meant_is_told_before_the_work(survey, called, tmp_path, outputs, says):
    run = called(
        "run", "lanewright:roadmap", f"--POINT_CLOUDS={survey / 's.laz'}", f"--TRAJECTORY={survey / 'drive.csv'}", *outputs, folder=tmp_path,
    )
    assert run.returncode == 1 and says in run.stderr and "Points read" not in run.stdout
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("words, says", [
    (("lanewright:detectcurbs", "--POINT_CLOUDS=bad.laz", "--CURB_POINTS=curbs.gpkg"), "damaged|cut off|cannot be read"),
    (("lanewright:roadmap", "--POINT_CLOUDS={survey}/s.laz", "--CELL_SIZE=-0.04"), r"CELL_SIZE\) is -0.04; it must be a number from"),
], ids=["in the work", "by QGIS before the work"])
def test_the_real_program_fails_with_that_sentence_and_leaves_nothing(survey, tmp_path, words, says):
    """What the other tests of refusals ask in a QGIS that has already started. What we refuse before the work is above, in JSON."""
    cut_off(survey, tmp_path)
    run = qgis_process("run", *(word.format(survey=survey) for word in words), f"--TRAJECTORY={survey / 'drive.csv'}", folder=tmp_path)
    assert run.returncode == 1 and sum(bool(re.search(says, line)) for line in complaints(run.stderr)) == 1, run.stderr
    assert "Points read" not in run.stdout and os.listdir(tmp_path) == ["bad.laz"]


def test_files_of_another_stage_or_drive_are_refused_by_name(survey, called, tmp_path):
    cloud, drive = survey / "s.laz", f"--TRAJECTORY={survey / 'drive.csv'}"
    curbs = called("run", "lanewright:detectcurbs", f"--POINT_CLOUDS={cloud}", drive, "--CURB_POINTS=curbs.gpkg", folder=tmp_path)
    assert curbs.returncode == 0, curbs.stderr
    rows = (survey / "drive.csv").read_text().splitlines()
    (tmp_path / "later.csv").write_text("\n".join([rows[0], *rows[len(rows) // 4:]]))
    for says, stage in {
        "lacks the extra field": ("intensityimage", f"--ROAD_POINTS={cloud}", "--INTENSITY_IMAGE=i.tif"),
        "Marking lines lacks the field": ("drivinglines", "--MARKING_LINES=curbs.gpkg", drive, "--DRIVING_LINES=d.gpkg"),
        "Road edges lacks the field": ("extractroadsurface", f"--POINT_CLOUDS={cloud}", drive, "--ROAD_EDGES=curbs.gpkg", "--ROAD_POINTS=r.laz"),
        "do not belong together": ("fitroadedges", "--CURB_POINTS=curbs.gpkg", "--TRAJECTORY=later.csv", "--ROAD_EDGES=e.gpkg"),
    }.items():
        assert re.search(says, one_sentence(called("run", f"lanewright:{stage[0]}", *stage[1:], folder=tmp_path))), stage
    assert sorted(os.listdir(tmp_path)) == ["curbs.gpkg", "later.csv"]


def test_a_trajectory_file_that_is_not_there_is_named(survey, called, tmp_path):
    run = called("run", "lanewright:detectcurbs", f"--POINT_CLOUDS={survey / 's.laz'}", "--TRAJECTORY=no.csv", "--CURB_POINTS=c.gpkg",
                       folder=tmp_path)
    assert "Trajectory: there is no file no.csv" in one_sentence(run)


@pytest.fixture(scope="session")
def street(survey):
    """The survey, its cloud in two files too."""
    for name, first in (("odd.laz", 1), ("even.laz", 0)):
        cloud = laspy.read(survey / "s.laz")
        cloud.points = cloud.points[np.arange(first, len(cloud.points), 2)]
        cloud.write(str(survey / name))
    return survey


def test_the_readme_command_makes_driving_lines_and_nothing_else(street, tmp_path):
    run = qgis_process(
        "run", "lanewright:roadmap", f"--POINT_CLOUDS={street / 'odd.laz'}", f"--POINT_CLOUDS={street / 'even.laz'}",
        f"--TRAJECTORY={street / 'drive.gpkg'}", "--DRIVING_LINES=lines.gpkg", folder=tmp_path,
    )
    assert run.returncode == 0, run.stderr
    assert feature_count(tmp_path / "lines.gpkg") > 0 and os.listdir(tmp_path) == ["lines.gpkg"]


def test_the_model_file_runs_without_a_desktop(street, tmp_path):
    results = ("road_edges", "road_surface", "markings", "marking_lines", "driving_lines", "curve_elements")
    run = qgis_process(
        "run", str(ROOT / "resources" / "models" / "road_map.model3"), f"--POINT_CLOUDS={street / 's.laz'}",
        f"--TRAJECTORY={street / 'drive.gpkg'}", "--road_points=road.laz", "--intensity_image=image.tif",
        *(f"--{name}={name}.gpkg" for name in results), folder=tmp_path,
    )
    assert run.returncode == 0, run.stderr
    for name in results[:-1]:
        assert feature_count(tmp_path / f"{name}.gpkg") > 0, name
    assert laspy.read(tmp_path / "road.laz").header.point_count > 10000


def feature_count(path):
    from osgeo import ogr

    source = ogr.Open(str(path))
    return source.GetLayer(0).GetFeatureCount()


def test_without_intensity_edges_are_drawn_and_markings_say_why_not(street, called, tmp_path):
    cloud = laspy.read(street / "s.laz")
    cloud.intensity = np.zeros(len(cloud.points), np.uint16)
    cloud.write(str(tmp_path / "dark.laz"))
    run = called(
        "run", "lanewright:roadmap", "--POINT_CLOUDS=dark.laz", f"--TRAJECTORY={street / 'drive.gpkg'}", "--ROAD_EDGES=edges.gpkg",
        "--ROAD_POINTS=road.laz", "--MARKINGS=markings.gpkg", "--INTENSITY_IMAGE=image.tif", folder=tmp_path,
    )
    assert run.returncode == 0, run.stderr
    assert "no intensity" in run.stdout + run.stderr
    assert feature_count(tmp_path / "edges.gpkg") > 0 and feature_count(tmp_path / "markings.gpkg") == 0
    assert not (tmp_path / "image.tif").exists()
    for stage in (
        ("correctintensity", "--ROAD_POINTS=road.laz", f"--TRAJECTORY={street / 'drive.gpkg'}", "--OUTPUT=bright.laz"),
        ("intensityimage", "--ROAD_POINTS=road.laz", "--INTENSITY_IMAGE=image.tif"),
    ):
        assert "no intensity" in one_sentence(called("run", f"lanewright:{stage[0]}", *stage[1:], folder=tmp_path))


def test_a_road_without_paint_gives_empty_layers_stage_by_stage(street, called, tmp_path):
    road = called(
        "run", "lanewright:roadmap", f"--POINT_CLOUDS={street / 's.laz'}", f"--TRAJECTORY={street / 'drive.gpkg'}",
        "--ROAD_POINTS=road.laz", folder=tmp_path,
    )
    assert road.returncode == 0, road.stderr
    paint = laspy.read(tmp_path / "road.laz")
    paint.points = paint.points[:0]
    paint.write(str(tmp_path / "paint.laz"))
    drive = f"--TRAJECTORY={street / 'drive.gpkg'}"
    for stage in (
        ("removeoutliers", "--INPUT=paint.laz", "--OUTPUT=kept.laz"),
        ("clustermarkings", "--MARKING_POINTS=kept.laz", drive, "--MARKINGS=markings.gpkg", "--CLUSTERED_POINTS=clusters.laz"),
        ("fitmarkinglines", "--CLUSTERED_POINTS=clusters.laz", "--MARKINGS=markings.gpkg", drive, "--MARKING_LINES=lines.gpkg"),
        ("drivinglines", "--MARKING_LINES=lines.gpkg", drive, "--DRIVING_LINES=driving.gpkg", "--CURVE_ELEMENTS=curves.gpkg"),
    ):
        run = called("run", f"lanewright:{stage[0]}", *stage[1:], folder=tmp_path)
        assert run.returncode == 0, run.stderr
    assert feature_count(tmp_path / "driving.gpkg") == feature_count(tmp_path / "lines.gpkg") == 0


def test_clouds_are_given_back_into_a_folder_and_a_clients_map_by_a_template(survey, called, tmp_path):
    given = called("run", "lanewright:classifycloud", f"--POINT_CLOUDS={survey / 's.laz'}", f"--TRAJECTORY={survey / 'drive.gpkg'}",
                   "--OUTPUT=given_back", folder=tmp_path)
    assert given.returncode == 0, given.stderr
    assert laspy.open(tmp_path / "given_back" / "s.laz").header.point_count == laspy.open(survey / "s.laz").header.point_count
    template = tmp_path / "office.csv"
    template.write_text("from;where;layer;CODE\nMARKINGS;class=zebras;AREA;1\n", encoding="utf-8")
    export = ["run", "lanewright:exporttemplate", "--TEMPLATE=office.csv", f"--ROAD_EDGES={survey / 'drive.gpkg'}", "--OUTPUT=client.gpkg"]
    assert "office.csv, line 2: zebras is no class that Lanewright writes (is zebra meant?)." in one_sentence(called(*export, folder=tmp_path))
    assert not (tmp_path / "client.gpkg").exists()
