"""The methods of finding paint through Processing: points, mask and markings from each, and from the road map."""

import laspy
import numpy as np
import pytest
from osgeo import gdal, ogr

pytestmark = pytest.mark.slow

gdal.UseExceptions()
ogr.UseExceptions()


@pytest.fixture(scope="module")
def road(sample_survey, tmp_path_factory):
    """Road points, image and trajectory of a street of 40 m."""
    import processing

    folder = tmp_path_factory.mktemp("road")
    survey = sample_survey(LENGTH=40, PULSE_RATE=60000, ROTATION_RATE=100)
    given = {"ROAD_POINTS": str(folder / "road.laz"), "INTENSITY_IMAGE": str(folder / "image.tif"), "TRAJECTORY": survey["TRAJECTORY"]}
    processing.run("lanewright:roadmap", {
        "POINT_CLOUDS": [survey["POINT_CLOUD"]], "TRAJECTORY": survey["TRAJECTORY"],
        "ROAD_POINTS": given["ROAD_POINTS"], "INTENSITY_IMAGE": given["INTENSITY_IMAGE"]})
    return survey, given


def extracted(given, folder, **values):
    """Number of marking points, and of pixels in the mask."""
    import processing

    points, mask = folder / "points.laz", folder / "mask.tif"
    processing.run("lanewright:extractmarkings", {**given, "MARKING_POINTS": str(points), "MARKING_MASK": str(mask), **values})
    source = gdal.Open(str(mask))
    pixels = np.frombuffer(source.ReadRaster(), np.uint8)
    with laspy.open(points) as reader:
        return reader.header.point_count, int(pixels.sum())


def test_every_method_gives_points_and_a_mask_and_they_differ(road, tmp_path):
    found = {}
    for method in ("multi-threshold", "intensity-peaks", "point-segments"):
        found[method] = extracted(road[1], tmp_path, METHOD=method)
        assert min(found[method]) > 1000, method
    assert len(set(found.values())) == 3


def test_the_road_map_takes_the_method_too(road, tmp_path):
    import processing

    survey, _ = road
    classes = {}
    for method in ("multi-threshold", "intensity-peaks"):
        path = tmp_path / f"{method}.gpkg"
        processing.run("lanewright:roadmap", {
            "POINT_CLOUDS": [survey["POINT_CLOUD"]], "TRAJECTORY": survey["TRAJECTORY"], "METHOD": method, "MARKINGS": str(path)})
        source = ogr.Open(str(path))
        classes[method] = {feature["class"] for feature in source.GetLayer(0)}
    assert "stop" in classes["multi-threshold"] and "stop" not in classes["intensity-peaks"]
