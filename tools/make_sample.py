"""Write a made survey with its truth into a folder, to look at while developing.

    python tools/make_sample.py build/sample --scene street --length 120 --seed 1

Leaves cloud.laz, trajectory.csv and truth.gpkg (boundaries, markings, driving lines, surface, lanes, roadside).
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from plugin_package import load


def write_layers(path, layers):
    """Features into the layers of one GeoPackage, beside those it has."""
    from osgeo import ogr, osr

    ogr.UseExceptions()
    kinds = {"LineStringZ": ogr.wkbLineString25D, "PolygonZ": ogr.wkbPolygon25D}
    types = {int: ogr.OFTInteger, float: ogr.OFTReal, str: ogr.OFTString}
    source = ogr.Open(str(path), update=1) if Path(path).exists() else ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    for name, features in layers.items():
        layer = source.CreateLayer(name, osr.SpatialReference(features.crs) if features.crs else None, kinds[features.geometry_type])
        for column in features.schema:
            layer.CreateField(ogr.FieldDefn(column.name, types[column.type]))
        layer.StartTransaction()
        for geometry, row in features:
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkb(geometry.wkb))
            for key, value in row.items():
                if value is not None:
                    feature.SetField(key, value)
            layer.CreateFeature(feature)
        layer.CommitTransaction()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    load()
    from lanewright.core.common.errors import RoadExtractionError
    from lanewright.simulator.scenes import SCENES
    from lanewright.simulator.survey import SampleSettings, make_sample_survey

    default = SampleSettings()
    parser.add_argument("--scene", choices=SCENES, default=default.scene)
    parser.add_argument("--seed", type=int, default=default.seed)
    for name, unit in (("length", "m, 0 as usual for the scene"), ("speed_kmh", "km/h"), ("pulse_rate", "Hz, each scanner"), ("gutter", "m")):
        parser.add_argument("--" + name.replace("_", "-"), type=float, default=SampleSettings.__dataclass_fields__[name].default,
                            help=f"{unit}, default %(default)s")
    arguments = vars(parser.parse_args())
    folder = arguments.pop("folder")
    folder.mkdir(parents=True, exist_ok=True)
    try:
        sample = make_sample_survey(SampleSettings(**arguments))
        started = time.monotonic()
        count = sample.write_cloud(folder / "cloud.laz")
    except RoadExtractionError as problem:
        sys.exit(str(problem))
    spent = time.monotonic() - started
    t = sample.trajectory
    np.savetxt(folder / "trajectory.csv", np.column_stack([t.time, t.x, t.y, t.z, t.roll, t.pitch, t.heading]),
               fmt=["%.6f"] + ["%.4f"] * 3 + ["%.5f"] * 3, delimiter=",", header="time,x,y,z,roll,pitch,heading", comments="")
    (folder / "truth.gpkg").unlink(missing_ok=True)
    write_layers(folder / "truth.gpkg", {"boundaries": sample.truth_boundaries, "markings": sample.truth_markings,
                                         "driving_lines": sample.truth_driving_lines, "surface": sample.truth_surface,
                                         "lanes": sample.truth_lanes, "roadside": sample.truth_roadside})
    print(f"{count} points in {spent:.1f} s ({count / spent:.0f} per second) in {folder}")


if __name__ == "__main__":
    main()
