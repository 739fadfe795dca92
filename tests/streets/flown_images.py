"""Images whose place on the map is known: a chequered ground, seen by a tilted camera."""

import numpy as np
from lanewright.products.overlay.control_points import SourceImage, control_points
from osgeo import gdal

gdal.UseExceptions()
WIDTH, HEIGHT = 600, 400
EAST, NORTH = 610_400.0, 5_710_200.0
CRS = "EPSG:32650"


def ground(pixel, line, bend=0.03, twist=0.0, size=0.05, turn=0.6):
    """Map coordinates of places in the image: turned, `bend` of order 2, `twist` of order 3."""
    u, v = (np.asarray(pixel) - WIDTH / 2) / 300, (np.asarray(line) - HEIGHT / 2) / 300
    along = 300 * size * (u + bend * u * u - 0.5 * bend * u * v + twist * u * (u * u + v * v))
    across = -300 * size * (v + 0.7 * bend * u * v - 0.3 * bend * v * v + twist * v * (u * u + v * v))
    return EAST + along * np.cos(turn) - across * np.sin(turn), NORTH + along * np.sin(turn) + across * np.cos(turn)


def image(**more):
    return SourceImage("flown.tif", WIDTH, HEIGHT, **more)


def measured(count=24, noise=0.0, seed=1, roles=None, crs=CRS, seen=None, places=None, **distortion):
    """ControlPoints scattered over the image, map coordinates measured with `noise` metres."""
    random = np.random.default_rng(seed)
    pixel, line = random.uniform(0.02, 0.98, (2, count)) * [[WIDTH], [HEIGHT]] if places is None else np.transpose(places)
    east, north = ground(pixel, line, **distortion)
    east, north = east + noise * random.standard_normal(len(pixel)), north + noise * random.standard_normal(len(pixel))
    rows = [list(row) for row in zip(pixel, line, east, north, roles or ["control"] * len(pixel))]
    return control_points(["pixel", "line", "easting", "northing", "role"], rows, seen or image(), "The table", crs)


def chequered(path, bands=3, kind=gdal.GDT_Byte, driver="GTiff", field=20, **more):
    """A raster of light and dark fields of 20 pixels; returns its values."""
    down, across = np.mgrid[:HEIGHT, :WIDTH]
    top = {gdal.GDT_Byte: 200, gdal.GDT_UInt16: 40_000, gdal.GDT_Float32: 21.5}[kind]
    values = np.where((across // field + down // field) % 2, top, 0.15 * top)
    memory = gdal.GetDriverByName("MEM").Create("", WIDTH, HEIGHT, bands, kind)
    for number in range(1, bands + 1):
        memory.GetRasterBand(number).WriteArray(values)
    if more.get("alpha"):
        memory.GetRasterBand(bands).SetColorInterpretation(gdal.GCI_AlphaBand)
        memory.GetRasterBand(bands).WriteArray(np.where(across < 100, 0, 255))
    gdal.GetDriverByName(driver).CreateCopy(str(path), memory)
    return values
