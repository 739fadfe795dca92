"""Every result says what made it, from what, how and when."""

import json
from datetime import datetime, timezone

import laspy
import pytest
from lanewright.algorithms.provenance import Provenance, own_version
from osgeo import gdal
from qgis.core import QgsVectorLayer


@pytest.fixture(scope="module")
def made(provider, tmp_path_factory):
    """The folder of a survey and of what was made from it."""
    import processing

    folder = tmp_path_factory.mktemp("survey")
    cloud, drive = str(folder / "s.laz"), str(folder / "drive.gpkg")
    processing.run("lanewright:samplesurvey", {"LENGTH": 20, "PULSE_RATE": 20000, "POINT_CLOUD": cloud, "TRAJECTORY": drive})
    processing.run("lanewright:extractroadsurface", {"POINT_CLOUDS": [cloud], "TRAJECTORY": drive, "MAX_WIDTH": 12.0,
                                                     "ROAD_POINTS": str(folder / "road.laz"), "ROAD_SURFACE": str(folder / "surface.gpkg")})
    processing.run("lanewright:intensityimage", {"ROAD_POINTS": str(folder / "road.laz"), "INTENSITY_IMAGE": str(folder / "image.tif")})
    return folder


def test_an_image_carries_version_algorithm_parameters_and_time(made):
    tags = gdal.Open(str(made / "image.tif")).GetMetadata()
    assert tags["TIFFTAG_SOFTWARE"] == f"Lanewright {own_version()}" and tags["LANEWRIGHT_ALGORITHM"] == "intensityimage"
    given = json.loads(tags["LANEWRIGHT_PARAMETERS"])
    assert given["ROAD_POINTS"].endswith("road.laz") and given["CELL_SIZE"] == 0.04, "defaults too"
    age = datetime.now(timezone.utc) - datetime.strptime(tags["LANEWRIGHT_TIME"], "%Y-%m-%dT%H:%M:%SZ").replace(tzinfo=timezone.utc)
    assert abs(age.total_seconds()) < 600


def test_a_cloud_names_program_and_algorithm_and_a_simulated_one_says_so(made):
    road, simulated = laspy.open(made / "road.laz").header, laspy.open(made / "s.laz").header
    assert (road.system_identifier, road.generating_software) == ("Lanewright extractroadsurface", f"Lanewright {own_version()}")
    assert simulated.system_identifier == "simulated survey"


def test_a_geopackage_brings_its_history_into_any_project(made):
    layer = QgsVectorLayer(f"{made}/surface.gpkg|layername=surface", "surface", "ogr")
    history = " ".join(layer.metadata().history())
    assert f"Lanewright {own_version()}, extractroadsurface" in history and '"MAX_WIDTH": 12.0' in history


@pytest.mark.parametrize("source", [
    "postgres://dbname='roads' host=db password='se cret' user=me table=x",  # pragma: allowlist secret
    "https://me:secret@host/x",  # pragma: allowlist secret
    'dbname=\\"a\\" password=secret',  # pragma: allowlist secret
])
def test_no_password_is_written(source):
    said = Provenance("roadmap", "1", {"TRAJECTORY": source}, datetime.now(timezone.utc)).parameters
    assert "secret" not in said and "se cret" not in said and "TRAJECTORY" in said


def test_an_intensity_image_is_known_whatever_its_file_is_called(made):
    from lanewright.processing_provider.results.road_maps import output_of
    from qgis.core import QgsRasterLayer

    assert output_of(QgsRasterLayer(str(made / "image.tif"), "mine")) == "INTENSITY_IMAGE"
