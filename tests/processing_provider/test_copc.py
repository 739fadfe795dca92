"""A COPC file through Processing, and in the eyes of QGIS itself."""

import os

import pytest
from lanewright.algorithms.survey_input import cloud_files
from qgis.core import QgsPointCloudLayer, QgsProviderRegistry, QgsVectorLayer


@pytest.fixture(scope="module")
def survey(sample_survey, tmp_path_factory):
    """A sample street as LAZ and as COPC: (LAZ, COPC, trajectory)."""
    from copc_files import write_copc

    folder = tmp_path_factory.mktemp("copc")
    made = sample_survey(LENGTH=30, PULSE_RATE=60000, ROTATION_RATE=100)
    return made["POINT_CLOUD"], write_copc(made["POINT_CLOUD"], folder / "street.copc.laz", in_a_node=20_000), made["TRAJECTORY"]


@pytest.mark.skipif("copc" not in QgsProviderRegistry.instance().providerList(), reason="this QGIS shows no COPC")
def test_qgis_itself_shows_it(survey):
    import laspy

    options = QgsPointCloudLayer.LayerOptions()
    options.skipStatisticsCalculation = True  # taken in the background, and the layer would be gone before
    layer = QgsPointCloudLayer(survey[1], "street", "copc", options)
    assert layer.isValid() and layer.crs().isValid()
    assert layer.pointCount() == laspy.open(survey[0]).header.point_count


@pytest.mark.skipif("vpc" not in QgsProviderRegistry.instance().providerList(), reason="this QGIS knows no virtual point clouds")
def test_a_virtual_point_cloud_as_the_tests_write_it_is_one_for_qgis(survey, tmp_path):
    from copc_files import write_vpc

    path = write_vpc(tmp_path / "all.vpc", [f"./{os.path.relpath(survey[1], tmp_path)}", survey[0]])
    layer = QgsPointCloudLayer(path, "all", "vpc")
    assert layer.isValid() and layer.pointCount() == 2 * 1000, "as it says; each of its files is named with 1000"
    assert cloud_files([layer.source()], "") == [os.path.normpath(survey[1]), survey[0]]


def test_curb_points_and_road_points_are_those_of_the_laz(survey, tmp_path):
    import laspy
    import processing

    curbs, points = [], []
    for number, cloud in enumerate(survey[:2]):
        drive = {"POINT_CLOUDS": [cloud], "TRAJECTORY": survey[2]}
        made = processing.run("lanewright:detectcurbs", {**drive, "CURB_POINTS": str(tmp_path / f"{number}.gpkg")})["CURB_POINTS"]
        curbs.append([(bytes(f.geometry().asWkb()), f.attributes()[1:]) for f in QgsVectorLayer(made).getFeatures()])
        road = processing.run("lanewright:extractroadsurface", {**drive, "ROAD_POINTS": str(tmp_path / f"{number}.laz")})["ROAD_POINTS"]
        points.append(laspy.read(road).points.array)
    assert len(curbs[0]) > 20 and curbs[0] == curbs[1]
    assert len(points[0]) > 10_000 and points[0].tobytes() == points[1].tobytes()
