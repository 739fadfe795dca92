"""Georeference image through Processing: layer or file in, image, residuals, report and numbers out."""

import numpy as np
import pytest
from osgeo import gdal
from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProcessingException, QgsRasterLayer, QgsVectorLayer

WIDTH, HEIGHT = 300, 200
PLACES = [(10, 10), (290, 15), (280, 190), (12, 180), (150, 100), (90, 40), (220, 130), (60, 150), (200, 30)]


def on_map(pixel, line):
    return 610_400 + 0.05 * pixel + 0.002 * line, 5_710_200 - 0.05 * line + 0.002 * pixel + 1e-5 * pixel * line


@pytest.fixture
def flown(tmp_path):
    path = tmp_path / "flown.png"
    memory = gdal.GetDriverByName("MEM").Create("", WIDTH, HEIGHT, 3)
    memory.WriteRaster(0, 0, WIDTH, HEIGHT, np.full((3, HEIGHT, WIDTH), 90, np.uint8).tobytes())
    gdal.GetDriverByName("PNG").CreateCopy(str(path), memory)
    return str(path)


@pytest.fixture
def layer():
    layer = QgsVectorLayer("Point?crs=EPSG:32650&field=name:string&field=pixel:double&field=line:double&field=role:string", "gcps", "memory")
    features = []
    for number, (pixel, line) in enumerate(PLACES):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(*on_map(pixel, line))))
        feature.setAttributes([f"P{number}", pixel, line, "check" if number == 4 else "control"])
        features.append(feature)
    layer.dataProvider().addFeatures(features)
    return layer


@pytest.fixture
def points_file(tmp_path):
    path = tmp_path / "flown.png.points"
    path.write_text("#CRS: EPSG:32650\nmapX,mapY,sourceX,sourceY,enable,dX,dY,residual\n" + "".join(
        "{},{},{},{},{},0,0,0\n".format(*on_map(pixel, line), pixel, -line, int(number != 4)) for number, (pixel, line) in enumerate(PLACES)))
    return str(path)


def run(image, tmp_path, **more):
    import processing

    return processing.run("lanewright:georeferenceimage", {"IMAGE": image, "OUTPUT": str(tmp_path / "ortho.tif"), **more})


def test_a_layer_places_the_image_and_tells_how_well(provider, flown, layer, tmp_path):
    results = run(flown, tmp_path, GCPS=layer, RESIDUALS=str(tmp_path / "residuals.gpkg"), REPORT=str(tmp_path / "report.html"))
    drawn = QgsRasterLayer(results["OUTPUT"], "ortho")
    assert drawn.isValid() and drawn.crs().authid() == "EPSG:32650" and drawn.bandCount() == 4
    assert results["POINTS"] == 8 and results["CHECK_POINTS"] == 1
    assert results["RMSE"] < 1e-5 and results["CHECK_RMSE"] < 1e-5 and results["OUTSIDE"] > 0
    vectors = QgsVectorLayer(results["RESIDUALS"], "residuals", "ogr")
    assert vectors.featureCount() == 9 and vectors.crs().authid() == "EPSG:32650"
    assert vectors.renderer().type() == "categorizedSymbol"
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "P4" in report and "data:image/png" in report and "ortho.tif" not in report.split("data:image")[0]


def test_the_georeferencers_file_gives_the_same_and_its_disabled_point_may_judge(provider, flown, layer, points_file, tmp_path):
    by_layer = run(flown, tmp_path, GCPS=layer)
    by_file = run(flown, tmp_path, GCP_FILE=points_file)
    assert by_file["POINTS"] == 8 and by_file["CHECK_POINTS"] == 0 and "CHECK_RMSE" not in by_file
    assert by_file["LEFT_OUT_RMSE"] == pytest.approx(by_layer["LEFT_OUT_RMSE"], abs=1e-6)
    assert run(flown, tmp_path, GCP_FILE=points_file, CHECK_DISABLED=True)["CHECK_POINTS"] == 1


def test_a_layer_opened_in_qgis_will_do_as_the_image(provider, flown, points_file, tmp_path):
    assert run(QgsRasterLayer(flown, "flown"), tmp_path, GCP_FILE=points_file, ORDER=1)["POINTS"] == 8


def test_a_table_of_texts_will_do_as_the_layer(provider, flown, tmp_path):
    path = tmp_path / "gcps.csv"
    path.write_text("pixel,line,easting,northing\n" + "".join("{},{},{},{}\n".format(p, q, *on_map(p, q)) for p, q in PLACES))
    results = run(flown, tmp_path, GCPS=str(path), CRS="EPSG:32650")
    assert results["POINTS"] == 9
    assert QgsRasterLayer(results["OUTPUT"], "ortho").crs().authid() == "EPSG:32650"


def refusal(*arguments, **more):
    with pytest.raises(QgsProcessingException) as refused:
        run(*arguments, **more)
    return str(refused.value)


def test_points_given_twice_or_not_at_all_are_refused(provider, flown, layer, points_file, tmp_path):
    assert "given twice" in refusal(flown, tmp_path, GCPS=layer, GCP_FILE=points_file)
    assert "no control points" in refusal(flown, tmp_path)


def test_a_refusal_leaves_yesterdays_image(provider, flown, layer, tmp_path):
    (tmp_path / "ortho.tif").write_text("yesterday")
    assert "needs 10 or more" in refusal(flown, tmp_path, GCPS=layer, ORDER=3)
    assert (tmp_path / "ortho.tif").read_text() == "yesterday"
    assert not list(tmp_path.glob(".ortho*")) and not list(tmp_path.glob("*.unfinished.tif"))


def test_lines_are_no_control_points(provider, flown, tmp_path):
    lines = QgsVectorLayer("LineString?crs=EPSG:32650&field=pixel:double&field=line:double", "lines", "memory")
    assert "Control points are points" in refusal(flown, tmp_path, GCPS=lines)


def test_the_sample_survey_brings_an_image_and_its_points(provider, tmp_path):
    import processing

    sample = processing.run("lanewright:samplesurvey", {
        "LENGTH": 40, "PULSE_RATE": 20000, "POINT_CLOUD": str(tmp_path / "s.laz"), "TRAJECTORY": "TEMPORARY_OUTPUT",
        "UAV_IMAGE": str(tmp_path / "uav.tif"), "UAV_GCPS": str(tmp_path / "gcps.gpkg"),
    })
    results = run(sample["UAV_IMAGE"], tmp_path, GCPS=sample["UAV_GCPS"])
    assert results["CHECK_RMSE"] < 0.08 and results["RMSE"] < 0.04
