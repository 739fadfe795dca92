"""Polygons of whatever paint is given as: lines with a width, or a raster of cells."""

import numpy as np
import shapely

from ..errors import RoadExtractionError
from ..gdal_errors import gdal_exceptions
from ..progress import Progress
from .common_ground import AssessedLayer, check_kind

BLOCK = 2048  # pixels


def strips(lines, widths):
    """Lines widened to polygons: (N,) metres from side to side, square ends that do not stick out."""
    return list(shapely.buffer(np.asarray(lines, object), np.asarray(widths, float) / 2, cap_style="flat", join_style="mitre"))


@gdal_exceptions()
def polygons_of_raster(path, progress=Progress()):
    """The painted patches of a raster: cells that touch, corners included, and have the same value other than 0 and no-data.

    Parameters
    ----------
    path : a raster file; values beyond 1 to 65534 and broken ones count as 1

    Returns
    -------
    polygons : list in the raster's CRS
    values : (N,) int
    crs : WKT, "" where it says none
    """
    from osgeo import gdal, ogr

    try:
        raster = gdal.Open(str(path))
    except RuntimeError as problem:
        raise RoadExtractionError(f"{path} cannot be read as a raster ({problem}).") from problem
    copy = f"/vsimem/lanewright_{id(raster)}.tif"
    try:
        values = _values(raster, copy, progress.part(0.0, 0.7))
        source = ogr.GetDriverByName("Memory").CreateDataSource("painted")
        layer = source.CreateLayer("painted", None, ogr.wkbPolygon)
        layer.CreateField(ogr.FieldDefn("value", ogr.OFTInteger))
        band = values.GetRasterBand(1)
        _polygonize(band, layer, progress.part(0.7, 1.0))
        found, kinds = [], []
        for feature in layer:
            found.append(shapely.from_wkb(bytes(feature.GetGeometryRef().ExportToWkb())))
            kinds.append(feature.GetField(0))
        values = band = None
    finally:
        gdal.Unlink(copy)
    crs = raster.GetProjection()
    # patches that touch themselves at a corner are no valid polygons
    return list(shapely.make_valid(np.asarray(found, object))) if found else [], np.array(kinds, int), crs


def _polygonize(band, layer, progress):
    """GDAL cannot pass an exception through its own code: what Cancel raises is kept and raised again."""
    from osgeo import gdal

    stopped = []

    def tell(share, *_):
        try:
            progress.at(share)
        except Exception as reason:
            stopped.append(reason)
            return 0
        return 1

    try:
        gdal.Polygonize(band, band, layer, 0, ["8CONNECTED=8"], callback=tell)
    except RuntimeError:
        if not stopped:
            raise
    if stopped:
        raise stopped[0]


def _values(raster, path, progress):
    """A copy with whole numbers: 0 where nothing is painted."""
    from osgeo import gdal

    width, height = raster.RasterXSize, raster.RasterYSize
    copy = gdal.GetDriverByName("GTiff").Create(path, width, height, 1, gdal.GDT_UInt16, ["TILED=YES", "COMPRESS=LZW", "SPARSE_OK=TRUE"])
    copy.SetGeoTransform(raster.GetGeoTransform())
    band, target = raster.GetRasterBand(1), copy.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    for row in range(0, height, BLOCK):
        progress.at(row / height)
        for column in range(0, width, BLOCK):
            wide, high = min(BLOCK, width - column), min(BLOCK, height - row)
            data = np.frombuffer(band.ReadRaster(column, row, wide, high, buf_type=gdal.GDT_Float64), np.float64)
            painted = np.isfinite(data) & (data != 0)
            if nodata is not None:
                painted &= data != nodata
            if painted.any():
                value = np.where(painted & (data >= 1) & (data < 65535), np.nan_to_num(data), painted).astype(np.uint16)
                target.WriteRaster(column, row, wide, high, value.tobytes())
    return copy


def painted_polygons(layer, line_width):
    """The AssessedLayer with its lines widened to `width_m` or `width` of their row, or to `line_width` metres.

    Raises
    ------
    RoadExtractionError
        If it holds points.
    """
    check_kind(layer, ("LineString", "Polygon", "GeometryCollection"), "polygons, lines or a mask")
    shapes = list(layer.geometries)
    lines = [k for k, shape in enumerate(shapes) if "LineString" in shape.geom_type]
    named, plain = layer.column("width_m"), layer.column("width")
    widths = [_width(named[k], plain[k], line_width) for k in lines]
    for k, strip in zip(lines, strips([shapes[k] for k in lines], widths)):
        shapes[k] = strip
    valid = shapely.make_valid(shapely.force_2d(np.asarray(shapes, object))) if shapes else []
    return AssessedLayer(layer.label, list(valid), layer.rows, layer.crs)


def _width(*candidates):
    for value in candidates:
        try:
            if value is not None and 0.01 <= float(value) <= 10:
                return float(value)
        except (TypeError, ValueError):
            continue
    return candidates[-1]


def classes_of(layer, name):
    """The class of every row by the field of this name, or mark_class, or kind; None where the layer has none."""
    for field in (name, "mark_class", "kind"):
        found = layer.column(field) if field else []
        if any(value is not None for value in found):
            return found
    return None
