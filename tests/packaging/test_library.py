"""The package that pip installs: it gives what Processing gives, without QGIS."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from osgeo import gdal

ROOT = Path(__file__).resolve().parents[2]
LAYERS = ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "CURVE_ELEMENTS", "CURB_POINTS")
SAMPLE = {"LENGTH": 40, "PULSE_RATE": 40000, "SEED": 2}


@pytest.fixture(scope="module")
def lanewright(tmp_path_factory):
    """`lanewright(arguments, folder)` runs the program of a fresh installation; its stdout."""
    folder = tmp_path_factory.mktemp("installed")
    source = folder / "source"  # building leaves files where it builds
    for name in ("core", "products", "simulator", "algorithms", "library"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "resources" / "i18n", source / "resources" / "i18n")
    for name in ("__init__.py", "plugin.py", "setup.py", "pyproject.toml", "metadata.txt", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    # the pip of these tests installs into it: to install a pip there first takes as long as all the rest
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", str(folder / "venv")], check=True)
    subprocess.run([sys.executable, "-m", "pip", f"--python={folder / 'venv'}", "install", "--quiet", "--no-deps", "--no-build-isolation",
                    str(source)], check=True)
    # laspy and shapely as these tests have them
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path.endswith("site-packages"))}

    def call(*arguments, cwd):
        done = subprocess.run([str(folder / "venv/bin/lanewright"), *arguments], cwd=cwd, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    call.folder = folder
    return call


@pytest.fixture(scope="module")
def survey(provider, tmp_path_factory):
    """Cloud and trajectory of a street, as Processing makes them."""
    import processing

    folder = tmp_path_factory.mktemp("survey")
    places = {"POINT_CLOUD": str(folder / "q_s.laz"), "TRAJECTORY": str(folder / "q_drive.gpkg")}
    processing.run("lanewright:samplesurvey", {**SAMPLE, **places})
    return places


@pytest.mark.slow
def test_the_package_holds_what_works_without_qgis(lanewright, tmp_path):
    packages = list((lanewright.folder / "venv/lib").glob("python*/site-packages/lanewright"))
    assert len(packages) == 1
    assert {path.name for path in packages[0].iterdir()} - {"__pycache__"} == {
        "__init__.py", "core", "products", "simulator", "algorithms", "library", "resources"}
    assert {path.suffix for path in packages[0].glob("resources/*/*")} == {".json"}
    version = next(line.partition("=")[2] for line in (ROOT / "metadata.txt").read_text().splitlines() if line.startswith("version="))
    assert lanewright("--version", cwd=tmp_path) == f"lanewright {version}\n"
    assert "Punktwolken" in lanewright("roadmap", "--help", "--lang=de", cwd=tmp_path)


@pytest.mark.slow
def test_a_road_map_is_that_of_processing(survey, lanewright, tmp_path):
    import processing

    def outputs(name):
        return {**{layer: f"ogr:dbname='{tmp_path}/{name}.gpkg' table=\"{layer.lower()}\" (geom)" for layer in LAYERS},
                "ROAD_POINTS": str(tmp_path / f"{name}.laz"), "INTENSITY_IMAGE": str(tmp_path / f"{name}.tif")}

    def program(algorithm, **values):
        return lanewright(algorithm, *(f"--{name}={value}" for name, value in values.items()), cwd=tmp_path)

    cloud, drive = survey["POINT_CLOUD"], survey["TRAJECTORY"]
    said = program("samplesurvey", **SAMPLE, POINT_CLOUD="l_s.laz", TRAJECTORY="l_drive.gpkg")
    assert "TRAJECTORY: l_drive.gpkg\n" in said and (tmp_path / "l_s.laz").read_bytes() == Path(cloud).read_bytes()
    assert rows(tmp_path / "l_drive.gpkg", "l_drive") == rows(drive, "q_drive")

    processing.run("lanewright:roadmap", {"POINT_CLOUDS": [cloud], "TRAJECTORY": drive, **outputs("q")})
    program("roadmap", POINT_CLOUDS=cloud, TRAJECTORY=drive, **outputs("l"))
    for layer in LAYERS:
        found, expected = (rows(tmp_path / f"{name}.gpkg", layer.lower()) for name in "lq")
        assert found == expected, layer
        assert layer == "CURVE_ELEMENTS" or len(found[2]) > 0, layer
    assert (tmp_path / "l.laz").read_bytes() == (tmp_path / "q.laz").read_bytes()
    images = [gdal.Open(str(tmp_path / f"{name}.tif")) for name in "lq"]  # which also say when they were made
    assert images[0].GetGeoTransform() == images[1].GetGeoTransform()
    assert images[0].ReadRaster() == images[1].ReadRaster()


@pytest.mark.slow
def test_scanlines_keep_their_intensity_between_two_steps(survey, lanewright, tmp_path):
    import processing

    cloud, drive = survey["POINT_CLOUD"], survey["TRAJECTORY"]
    processing.run("lanewright:normalizedscanlines", {"POINT_CLOUDS": [cloud], "TRAJECTORY": drive, "SCANLINES": str(tmp_path / "q.gpkg")})
    lanewright("normalizedscanlines", "--POINT_CLOUDS", cloud, f"--TRAJECTORY={drive}", "--SCANLINES=l.gpkg", cwd=tmp_path)
    assert rows(tmp_path / "l.gpkg", "l") == rows(tmp_path / "q.gpkg", "q")
    lanewright("boundariesfromscanlines", "--SCANLINES=l.gpkg", f"--TRAJECTORY={drive}", "--BOUNDARIES=b.gpkg", cwd=tmp_path)
    assert rows(tmp_path / "b.gpkg", "b")[2]


def rows(path, table):
    """(fields with their types, CRS, [(WKB, values)]) of a layer."""
    from osgeo import gdal, ogr

    dataset = gdal.OpenEx(str(path), gdal.OF_VECTOR)
    layer = dataset.GetLayerByName(table)
    definition, crs = layer.GetLayerDefn(), layer.GetSpatialRef()
    fields = [(definition.GetFieldDefn(k).GetName(), definition.GetFieldDefn(k).GetType()) for k in range(definition.GetFieldCount())]
    found = []
    for feature in layer:
        geometry = feature.GetGeometryRef()
        found.append((None if geometry is None else bytes(geometry.ExportToIsoWkb(ogr.wkbNDR)), [feature.GetField(name) for name, _ in fields]))
    return fields, "" if crs is None else f"{crs.GetAuthorityName(None)}:{crs.GetAuthorityCode(None)}", found
