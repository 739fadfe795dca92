"""Hits, misses and false alarms as a GeoTIFF."""

import numpy as np

from ..gdal_errors import gdal_exceptions
from .cells import TILE, tile_bounds, tiles_of


class OutcomeRaster:
    """Takes the tiles that `assess_markings` gives and writes them; values are those of `markings`, 0 is no paint in either.

    Parameters
    ----------
    path : of the .tif
    polygons : result and reference together, whose extent the raster covers
    """

    @gdal_exceptions()
    def __init__(self, path, polygons, cell_size, crs, margin=0):
        from osgeo import gdal, osr

        tiles = np.array(tiles_of(list(polygons), cell_size, margin) or [(0, 0)])
        (self._west, south), (east, self._north) = tiles.min(axis=0), tiles.max(axis=0)
        columns, rows = (east - self._west + 1) * TILE, (self._north - south + 1) * TILE
        self._raster = gdal.GetDriverByName("GTiff").Create(
            str(path), int(columns), int(rows), 1, gdal.GDT_Byte, ["TILED=YES", "COMPRESS=DEFLATE", "SPARSE_OK=TRUE", "BIGTIFF=IF_SAFER"])
        x0, _, _, y1 = tile_bounds((self._west, self._north), cell_size)
        self._raster.SetGeoTransform((x0, cell_size, 0.0, y1, 0.0, -cell_size))
        if crs:
            reference = osr.SpatialReference()
            reference.ImportFromWkt(crs)
            self._raster.SetProjection(reference.ExportToWkt())
        band = self._raster.GetRasterBand(1)
        band.SetNoDataValue(0)
        band.SetDescription("1 hit, 2 missed, 3 false, 4 missed beside a hit, 5 false beside paint")

    @gdal_exceptions()
    def write(self, tile, values):
        column, row = (tile[0] - self._west) * TILE, (self._north - tile[1]) * TILE
        self._raster.GetRasterBand(1).WriteRaster(int(column), int(row), TILE, TILE, np.ascontiguousarray(values, np.uint8).tobytes())

    @gdal_exceptions()
    def close(self):
        self._raster = None
