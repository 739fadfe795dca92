"""What peers are given: made once by our own chain, in forms they read.

    strip.laz, strip.fgb        road points of 50 m of the dense survey, as LAZ and as the FlatGeobuf that gdal_grid reads
    strip.tif                   our image of them, whose cells gdal_grid is to fill
    paint.laz, paint.npy        a million points on and about paint of the long survey; (N, 5) x, y, z, station, offset
                                in metres, in the order of the LAZ's times, which count from 0
"""

import os

import numpy as np

from .surveys import SURVEYS, clouds_of, trajectory_of

STRIP = 10.0, 60.0  # m of station
PAINT = dict(full=1_000_000, quick=100_000)  # points


def prepared(name, size):
    return SURVEYS / size / "prepared" / name


def prepare(size):
    """Make the files."""
    from lanewright.core.intensity.image import make_intensity_image
    from lanewright.core.survey.road_points_las import write_road_points

    folder = prepared("", size)
    folder.mkdir(parents=True, exist_ok=True)
    road_points = _road_points("dense", size)
    strip = _part(road_points, road_points.window(road_points.roads()[0], *STRIP).records)
    write_road_points(strip, folder / "strip.laz")
    _write_layer(strip, folder / "strip.fgb")
    make_intensity_image(strip, path=folder / "strip.tif").close()
    paint = _brightest(_road_points("long", size), PAINT[size])
    write_road_points(paint, folder / "paint.laz")
    points = paint.all_points()[np.argsort(paint.all_points().time)]
    np.save(folder / "paint.unfinished.npy", np.c_[points.x, points.y, points.z, points.s, points.d])
    os.replace(folder / "paint.unfinished.npy", folder / "paint.npy")  # last: it says that all is there


def _road_points(name, size):
    """The road surface's points, intensity corrected."""
    from lanewright.core.intensity.correction import correct_intensity
    from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
    from lanewright.core.road.surface.extract import extract_road_surface
    from lanewright.core.survey.open_survey import open_survey
    from lanewright.core.survey.trajectory.reader import read_trajectory

    survey = open_survey(clouds_of(name, size), read_trajectory(trajectory_of(name, size)))
    edges = draw_boundaries(find_curb_points(survey, BoundarySettings(method="profiles")), survey.frame).edges
    road_points, _ = extract_road_surface(survey, edges)
    return correct_intensity(road_points, survey.frame)[0]


def _part(road_points, records):
    from lanewright.core.survey.store.road_points import RoadPoints

    part = RoadPoints.empty_like(road_points)
    part.store.append(road_points.roads()[0], records)
    return part


def _brightest(road_points, count):
    """The brightest points of the first road, to about `count`: paint, its rims and specks, worn and far ones among them."""
    points = road_points.all_points()
    value = points.value
    if len(value) > count:
        points = points[np.sort(np.argpartition(-value, count)[:count])]
    records = np.array(points.records)
    records["time"] = np.arange(len(records))
    return _part(road_points, records)


def _write_layer(road_points, path):
    """Points with their intensity as a FlatGeobuf without index, the quickest that OGR reads in order."""
    from osgeo import ogr, osr

    ogr.UseExceptions()
    source = ogr.GetDriverByName("FlatGeobuf").CreateDataSource(str(path))
    layer = source.CreateLayer("strip", osr.SpatialReference(road_points.crs) if road_points.crs else None, ogr.wkbPoint25D,
                               ["SPATIAL_INDEX=NO"])
    points = road_points.all_points()
    places = np.c_[points.x, points.y, points.value] + np.array([*road_points.origin[:2], 0.0])
    for place in places.tolist():
        feature = ogr.Feature(layer.GetLayerDefn())
        point = ogr.Geometry(ogr.wkbPoint25D)
        point.AddPoint(*place)
        feature.SetGeometryDirectly(point)
        layer.CreateFeature(feature)
