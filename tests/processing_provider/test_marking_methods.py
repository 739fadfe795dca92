"""The methods of finding paint through Processing: points, mask and markings from each, and from the road map."""

import laspy
import numpy as np
import pytest
from osgeo import gdal, ogr

pytestmark = pytest.mark.slow

gdal.UseExceptions()
ogr.UseExceptions()


def extracted(given, folder, **values):
    """Number of marking points, and of pixels in the mask."""
    import processing

    points, mask = folder / "points.laz", folder / "mask.tif"
    processing.run("lanewright:extractmarkings", {**given, "MARKING_POINTS": str(points), "MARKING_MASK": str(mask), **values})
    source = gdal.Open(str(mask))
    pixels = np.frombuffer(source.ReadRaster(), np.uint8)
    with laspy.open(points) as reader:
        return reader.header.point_count, int(pixels.sum())


def test_every_method_gives_points_and_a_mask_and_they_differ(street, street_map, tmp_path):
    found, given = {}, {"TRAJECTORY": street["TRAJECTORY"], **{name: street_map[name] for name in ("ROAD_POINTS", "INTENSITY_IMAGE")}}
    for method in ("multi-threshold", "intensity-peaks", "point-segments"):
        found[method] = extracted(given, tmp_path, METHOD=method)
        assert min(found[method]) > 1000, method
    assert len(set(found.values())) == 3


def test_the_road_map_takes_the_method_too(street, street_map, tmp_path):
    import processing

    other = processing.run("lanewright:roadmap", {"POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"],
                                                  "METHOD": "intensity-peaks", "MARKINGS": str(tmp_path / "markings.gpkg")})
    classes = {}
    for method, made in (("multi-threshold", street_map), ("intensity-peaks", other)):
        source = ogr.Open(made["MARKINGS"])
        classes[method] = {feature["class"] for feature in source.GetLayer(0)}
    assert "stop" in classes["multi-threshold"] and "stop" not in classes["intensity-peaks"]
