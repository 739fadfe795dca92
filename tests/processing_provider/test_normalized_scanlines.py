"""Normalized scanlines through Processing: a layer with heights and measures, and a cloud."""

import laspy
import numpy as np
import pytest
from lanewright.algorithms.survey_input import read_trajectory_source
from lanewright.algorithms.vector_source import read_features
from lanewright.core.common.features import SCANLINES
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.processing_provider.call import QgisSource
from lanewright.products.scanline_layer import scanlines_from_features
from osgeo import ogr
from qgis.core import QgsProcessingContext, QgsProcessingFeatureSource, QgsVectorLayer

ogr.UseExceptions()


@pytest.fixture(scope="module")
def made(sample_survey, tmp_path_factory):
    import processing

    folder = tmp_path_factory.mktemp("scanlines")
    survey = sample_survey(LENGTH=30, PULSE_RATE=60000)
    return processing.run("lanewright:normalizedscanlines", {
        "POINT_CLOUDS": [survey["POINT_CLOUD"]], "TRAJECTORY": survey["TRAJECTORY"], "INTERVAL": 0.5, "CRS": "EPSG:32650",
        "SCANLINES": str(folder / "lines.gpkg"), "RESAMPLED_POINTS": str(folder / "even.laz"),
    }), survey


def test_the_layer_has_heights_measures_and_its_fields(made):
    source = ogr.Open(made[0]["SCANLINES"])  # a layer does not keep it
    layer = source.GetLayer(0)
    assert layer.GetGeomType() == ogr.wkbLineStringZM
    assert layer.GetSpatialRef().GetAuthorityCode(None) == "32650"
    rows = []
    for feature in layer:
        line = feature.GetGeometryRef()
        rows.append(([line.GetPointZM(k) for k in range(line.GetPointCount())], feature.items()))
    assert {tuple(sorted(row)) for _, row in rows} == {tuple(sorted(field.name for field in SCANLINES))}
    assert {row["scanner"] for _, row in rows} == {0, 1}
    points = np.concatenate([points for points, _ in rows])
    assert points.shape[1] == 4 and (points[:, 3] > 0).all()
    # the vertical reference of the sample survey is 20 m
    assert 15.0 < points[:, 2].min() and points[:, 2].max() < 30.0


def test_the_layer_is_read_back_as_scanlines(made):
    layer = QgsVectorLayer(made[0]["SCANLINES"], "lines", "ogr")
    context = QgsProcessingContext()
    features = read_features(QgisSource(QgsProcessingFeatureSource(layer, context), "Scanlines"), SCANLINES, "LineStringZM")
    drive = QgsVectorLayer(made[1]["TRAJECTORY"], "drive", "ogr")
    lines, interval = scanlines_from_features(features, build_frame(read_trajectory_source(QgisSource(drive, "Trajectory"))))
    assert interval == 0.5
    assert len(lines[0]) == len(features)
    longest = np.diff(lines[0].first).argmax()
    d = lines[0].d[lines[0].first[longest]:lines[0].first[longest + 1]]
    assert d[0] < -4.0 and d[-1] > 4.0


def test_the_cloud_carries_crs_and_places_on_the_road(made):
    cloud = laspy.read(made[0]["RESAMPLED_POINTS"])
    assert cloud.header.parse_crs().to_epsg() == 32650
    assert np.abs(cloud["offset_m"]).max() <= 15.0
    np.testing.assert_allclose(np.asarray(cloud["station_m"]) % 0.5 % 0.5, 0.0, atol=1e-6)
