"""COPC files and virtual point clouds for the tests."""

import json
from pathlib import Path

import laspy
from lanewright.core.survey.las import copc_writer

ENTRY = 32  # bytes of an entry of the hierarchy


def write_copc(source, path, in_a_node=2_000):
    """Write the points of a LAS or LAZ file (point format 6 to 8) as COPC; returns the path."""
    copc_writer.write_copc(laspy.read(source), path, in_a_node)
    return str(path)


def write_vpc(path, names, overview="", corner=(500000.0, 5400000.0, 0.0), edge=100.0, crs=""):
    """Write a virtual point cloud that names these files, as pdal_wrench and with it QGIS write it; returns the path."""
    (x, y, z), (far, deep, high) = corner, (value + edge for value in corner)
    outline = {"type": "Polygon", "coordinates": [[[x, y, z], [x, deep, z], [far, deep, high], [far, y, high], [x, y, z]]]}
    box = [x, y, z, far, deep, high]
    shown = {"overview": {"href": overview, "roles": ["overview"]}} if overview else {}
    features = [{
        "type": "Feature", "stac_version": "1.0.0", "stac_extensions": [
            "https://stac-extensions.github.io/pointcloud/v1.0.0/schema.json", "https://stac-extensions.github.io/projection/v1.1.0/schema.json"],
        "id": Path(name).stem, "geometry": outline, "bbox": box, "properties": {
            "datetime": "2024-05-17T00:00:00Z", "pc:count": 1000, "pc:encoding": "?", "pc:type": "lidar",
            "pc:schemas": [{"name": axis, "size": 8, "type": "floating"} for axis in "XYZ"],
            "proj:bbox": box, "proj:geometry": outline, "proj:wkt2": crs},
        "links": [], "assets": {"data": {"href": name, "roles": ["data"]}, **shown}} for name in names]
    Path(path).write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    return str(path)
