"""No input is written over, by whatever name it is called."""

import os
import shutil
import sqlite3

import pytest
from copc_files import write_vpc
from qgis.core import QgsProcessingException, QgsProcessingFeatureSourceDefinition, QgsProject, QgsVectorLayer


@pytest.fixture(scope="module")
def made(provider, tmp_path_factory):
    """A folder with s.laz and drive.gpkg."""
    import processing

    folder = tmp_path_factory.mktemp("survey")
    processing.run("lanewright:samplesurvey", {"LENGTH": 20, "PULSE_RATE": 20000, "POINT_CLOUD": str(folder / "s.laz"),
                                               "TRAJECTORY": str(folder / "drive.gpkg")})
    return folder


@pytest.fixture
def survey(made, tmp_path):
    for name in ("s.laz", "drive.gpkg"):
        shutil.copy(made / name, tmp_path / name)
    return tmp_path


def import_trajectory(source, destination):
    import processing

    return processing.run("lanewright:importtrajectory", {"INPUT": source, "OUTPUT": destination})


def rows(path):
    """What the table holds; QGIS itself changes bytes of a GeoPackage that it opens."""
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as database:
        return database.execute("SELECT * FROM drive").fetchall()


def loaded(path):
    layer = QgsVectorLayer(path, "drive", "ogr")
    QgsProject.instance().addMapLayer(layer)
    return layer


@pytest.mark.parametrize("called", [
    str, lambda path: f"{path}|layername=drive", lambda path: loaded(str(path)), lambda path: loaded(f"{path}|layername=drive").id(),
    lambda path: QgsProcessingFeatureSourceDefinition(str(path)),
], ids=["path", "table", "layer", "layer id", "selection"])
@pytest.mark.parametrize("destination", ["{path}", "ogr:dbname='{path}' table=\"drive\" (geom)"], ids=["file", "table"])
def test_a_layer_that_is_read_is_not_written_over(survey, called, destination):
    path = survey / "drive.gpkg"
    before = rows(path)
    with pytest.raises(QgsProcessingException, match="would be written over .*drive.gpkg, which is read as Trajectory file or layer"):
        import_trajectory(called(path), destination.format(path=path))
    QgsProject.instance().clear()
    assert rows(path) == before


def test_a_link_to_an_input_is_that_input(survey):
    os.symlink(survey / "drive.gpkg", survey / "other.gpkg")
    with pytest.raises(QgsProcessingException, match="would be written over"):
        import_trajectory(str(survey / "drive.gpkg"), str(survey / "other.gpkg"))


@pytest.mark.parametrize("called", [str, lambda path: loaded(str(path))], ids=["path", "layer"])
def test_another_table_of_the_database_that_is_read_may_be_written(survey, called):
    path = survey / "drive.gpkg"
    for _ in range(2):
        import_trajectory(called(path), f"ogr:dbname='{path}' table=\"imported\" (geom)")
    QgsProject.instance().clear()
    counts = [QgsVectorLayer(f"{path}|layername={table}", "x", "ogr").featureCount() for table in ("drive", "imported")]
    assert counts[0] == counts[1] > 100


def test_a_point_cloud_that_is_read_is_not_written_over(survey):
    import processing

    before = (survey / "s.laz").read_bytes()
    with pytest.raises(QgsProcessingException, match="Road points would be written over .*s.laz, which is read as Point clouds"):
        processing.run("lanewright:extractroadsurface", {"POINT_CLOUDS": [str(survey / "s.laz")], "TRAJECTORY": str(survey / "drive.gpkg"),
                                                         "ROAD_POINTS": str(survey / "s.laz")})
    assert (survey / "s.laz").read_bytes() == before


@pytest.mark.parametrize("named", ["*.laz", "all.vpc"])
def test_a_run_on_a_folder_wildcard_or_virtual_point_cloud_reads_its_clouds_and_writes_over_none(survey, named):
    import processing

    write_vpc(survey / "all.vpc", ["./s.laz"])

    report = survey / "report.html"
    processing.run("lanewright:inspectsurvey", {"POINT_CLOUDS": str(survey), "REPORT": str(report)})
    assert "s.laz" in report.read_text()
    before = (survey / "s.laz").read_bytes()
    with pytest.raises(QgsProcessingException, match="s.laz, which is read as Point clouds"):
        processing.run("lanewright:extractroadsurface", {"POINT_CLOUDS": [str(survey / named)], "TRAJECTORY": str(survey / "drive.gpkg"),
                                                         "ROAD_POINTS": str(survey / "s.laz")})
    assert (survey / "s.laz").read_bytes() == before
