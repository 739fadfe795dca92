"""Polygons of the painted patches of a raster."""

from __future__ import annotations

import numpy as np
import shapely

from ..common.progress import Progress
from ..io.local_files import gdal_exceptions, open_raster, reading

RASTER_READ_SIZE = 2048  # pixels, side of the pieces in which a raster is read


@gdal_exceptions()
def polygons_of_raster(path: str, progress: Progress = Progress()) -> tuple[list[shapely.Geometry], np.ndarray, str]:
    """The painted patches of a raster: 8-connected cells of the same value, other than 0 and no-data.

    Parameters
    ----------
    path : a raster file; values outside 1 to 65534 and fractions below 1 count as 1
    progress : Progress

    Returns
    -------
    polygons : list in the raster's CRS
    values : (N,) int
    crs : WKT, "" if it has none

    Raises
    ------
    RoadExtractionError
        If GDAL cannot read the file.
    """
    from osgeo import gdal, ogr

    raster = open_raster(path)
    copy = f"/vsimem/lanewright_{id(raster)}.tif"
    try:
        with reading(path):
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
    """GDAL cannot pass an exception through its own code: the one that a cancellation raises is stored and raised again."""
    from osgeo import gdal

    stopped = []

    def report(share, *_):
        try:
            progress.report(share)
        except Exception as reason:
            stopped.append(reason)
            return 0
        return 1

    try:
        gdal.Polygonize(band, band, layer, 0, ["8CONNECTED=8"], callback=report)
    except RuntimeError:
        if not stopped:
            raise
    if stopped:
        raise stopped[0]


def _values(raster, path, progress):
    """A copy of the raster with whole numbers, 0 where nothing is painted."""
    from osgeo import gdal

    width, height = raster.RasterXSize, raster.RasterYSize
    copy = gdal.GetDriverByName("GTiff").Create(path, width, height, 1, gdal.GDT_UInt16, ["TILED=YES", "COMPRESS=LZW", "SPARSE_OK=TRUE"])
    copy.SetGeoTransform(raster.GetGeoTransform())
    band, target = raster.GetRasterBand(1), copy.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    for row in range(0, height, RASTER_READ_SIZE):
        progress.report(row / height)
        for column in range(0, width, RASTER_READ_SIZE):
            wide, high = min(RASTER_READ_SIZE, width - column), min(RASTER_READ_SIZE, height - row)
            data = np.frombuffer(band.ReadRaster(column, row, wide, high, buf_type=gdal.GDT_Float64), np.float64)
            painted = np.isfinite(data) & (data != 0)
            if nodata is not None:
                painted &= data != nodata
            if painted.any():
                value = np.where(painted & (data >= 1) & (data < 65535), np.nan_to_num(data), painted).astype(np.uint16)
                target.WriteRaster(column, row, wide, high, value.tobytes())
    return copy
