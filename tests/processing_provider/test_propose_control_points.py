"""Propose control points through Processing: two rasters in, a layer for Georeference image, a report and numbers out."""

import numpy as np
import pytest
from paint_from_above import Ground, Overhead, street
from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProcessingException, QgsRasterLayer, QgsVectorLayer

CAMERA = Overhead(turn=0.2, width=1500, height=500)


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """(path of the photo, path of the intensity image)."""
    folder = tmp_path_factory.mktemp("seen")
    ground = Ground(street())
    return ground.photo(folder / "photo.png", CAMERA).path, ground.intensity_image(folder / "intensity.tif").path


@pytest.fixture
def two_points():
    layer = QgsVectorLayer("Point?crs=EPSG:32650&field=pixel:double&field=line:double", "rough", "memory")
    features = []
    for pixel, line, off in ((100, 250, 1.0), (1400, 260, -0.8)):
        feature = QgsFeature(layer.fields())
        east, north = (float(v[0]) for v in CAMERA.to_map(np.array([pixel]), np.array([line])))
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(east + off, north - off)))
        feature.setAttributes([pixel, line])
        features.append(feature)
    layer.dataProvider().addFeatures(features)
    return layer


def run(seen, tmp_path, **more):
    import processing

    image, intensity = seen
    return processing.run("lanewright:proposecontrolpoints", {
        "IMAGE": image, "INTENSITY_IMAGE": intensity, "CONTROL_POINTS": str(tmp_path / "pairs.gpkg"), **more})


def test_two_rough_points_give_pairs_that_place_the_image(provider, seen, two_points, tmp_path):
    import processing

    results = run(seen, tmp_path, ROUGH_POINTS=two_points, REPORT=str(tmp_path / "report.html"))
    assert results["ACCEPTED"] >= 15 and results["RMSE"] < 0.03
    assert results["GROUND_PIXEL"] == pytest.approx(CAMERA.size, rel=0.01) and results["TURN"] == pytest.approx(np.degrees(CAMERA.turn), abs=0.5)
    pairs = QgsVectorLayer(results["CONTROL_POINTS"], "pairs", "ogr")
    assert pairs.crs().authid() == "EPSG:32650" and pairs.featureCount() == results["PROPOSED"]
    assert {"accepted", "residual", "score", "pixel", "line", "why"} <= {field.name() for field in pairs.fields()}
    assert sum(feature["accepted"] for feature in pairs.getFeatures()) == results["ACCEPTED"]
    assert "Pairs of cut-outs" in (tmp_path / "report.html").read_text(encoding="utf-8")
    placed = processing.run("lanewright:georeferenceimage", {"IMAGE": seen[0], "GCPS": pairs, "ORDER": 1, "OUTPUT": str(tmp_path / "ortho.tif")})
    assert placed["POINTS"] == results["ACCEPTED"] and placed["RMSE"] < 0.02
    assert QgsRasterLayer(placed["OUTPUT"], "ortho").crs().authid() == "EPSG:32650"


def test_a_pair_that_is_refused_by_hand_is_left_out_of_the_image(provider, seen, two_points, tmp_path):
    import processing

    results = run(seen, tmp_path, ROUGH_POINTS=two_points)
    pairs = QgsVectorLayer(results["CONTROL_POINTS"], "pairs", "ogr")
    first = next(feature for feature in pairs.getFeatures() if feature["accepted"])
    pairs.dataProvider().changeAttributeValues({first.id(): {pairs.fields().lookupField("accepted"): 0}})
    placed = processing.run("lanewright:georeferenceimage", {"IMAGE": seen[0], "GCPS": pairs, "ORDER": 1, "OUTPUT": str(tmp_path / "ortho.tif")})
    assert placed["POINTS"] == results["ACCEPTED"] - 1


def test_an_image_that_says_nothing_of_its_place_is_refused_in_one_sentence(provider, seen, tmp_path):
    with pytest.raises(QgsProcessingException, match="neither a position nor position tags. Give the pixel size, or two points"):
        run(seen, tmp_path)
    assert not (tmp_path / "pairs.gpkg").exists()


def test_one_rough_point_is_too_few(provider, seen, two_points, tmp_path):
    two_points.dataProvider().deleteFeatures([next(two_points.getFeatures()).id()])
    with pytest.raises(QgsProcessingException, match="1 rough points; two or more are needed"):
        run(seen, tmp_path, ROUGH_POINTS=two_points)
