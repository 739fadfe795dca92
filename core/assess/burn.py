"""Polygons rasterised in tiles of small cells, on one grid through the map's origin, and the raster of outcomes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import shapely

from ..io.crs import NO_PLACE, place_of_raster, place_raster
from ..io.local_files import gdal_exceptions, open_raster

BURN_TILE = 2048  # cells, side of a tile


class PolygonRasteriser:
    """Rasterises numbered polygons tile by tile: a cell belongs to a polygon if its centre does."""

    @gdal_exceptions()
    def __init__(self, polygons: Sequence[Any]) -> None:
        from osgeo import ogr

        self._source = ogr.GetDriverByName("Memory").CreateDataSource("polygons")
        self._layer = self._source.CreateLayer("polygons", None, ogr.wkbUnknown)
        self._layer.CreateField(ogr.FieldDefn("number", ogr.OFTInteger))
        definition = self._layer.GetLayerDefn()
        for number, wkb in enumerate(shapely.to_wkb(np.asarray(polygons, object), output_dimension=2), start=1):
            feature = ogr.Feature(definition)
            feature.SetField(0, number)
            feature.SetGeometryDirectly(ogr.CreateGeometryFromWkb(wkb))
            self._layer.CreateFeature(feature)

    @gdal_exceptions()
    def burn(self, bounds: tuple[float, float, float, float], shape: tuple[int, int]) -> np.ndarray:
        """Rasterise the polygons.

        Parameters
        ----------
        bounds : (min x, min y, max x, max y), metres
        shape : (rows, columns)

        Returns
        -------
        (rows, columns) int32 numbers of polygons, from 1 on; 0 elsewhere. The later of two overlapping polygons wins.
        """
        from osgeo import gdal

        rows, columns = shape
        raster = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Int32)
        size = (bounds[2] - bounds[0]) / columns
        raster.SetGeoTransform((bounds[0], size, 0.0, bounds[3], 0.0, -size))
        self._layer.SetSpatialFilterRect(*bounds)
        # GDAL warns, tile by tile, that two layers without CRS match
        gdal.PushErrorHandler("CPLQuietErrorHandler")
        try:
            gdal.RasterizeLayer(raster, [1], self._layer, options=["ATTRIBUTE=number"])
        finally:
            gdal.PopErrorHandler()
        return np.frombuffer(raster.ReadRaster(), np.int32).reshape(shape)


class DataMask:
    """The cells in which a raster has data: where nothing was scanned, nothing can be judged."""

    @gdal_exceptions()
    def __init__(self, path: str) -> None:
        from osgeo import gdal

        self._raster = open_raster(path)
        self._inverse = gdal.InvGeoTransform(place_of_raster(self._raster)[0] or NO_PLACE)

    @gdal_exceptions()
    def burn(self, bounds: tuple[float, float, float, float], shape: tuple[int, int]) -> np.ndarray:
        """(rows, columns) bool: whether the raster has a value at the centre of each cell. Parameters as of `PolygonRasteriser.burn`."""
        from osgeo import gdal

        size = (bounds[2] - bounds[0]) / shape[1]
        x = bounds[0] + (np.arange(shape[1]) + 0.5) * size
        y = bounds[3] - (np.arange(shape[0]) + 0.5) * size
        column = np.floor(self._inverse[0] + self._inverse[1] * x).astype(int)
        row = np.floor(self._inverse[3] + self._inverse[5] * y).astype(int)
        column_inside = (column >= 0) & (column < self._raster.RasterXSize)
        row_inside = (row >= 0) & (row < self._raster.RasterYSize)
        found = np.zeros(shape, bool)
        if not column_inside.any() or not row_inside.any():
            return found
        column, row = column[column_inside], row[row_inside]
        first, above = int(column.min()), int(row.min())
        wide, high = int(column.max()) - first + 1, int(row.max()) - above + 1
        band = self._raster.GetRasterBand(1)
        data = np.frombuffer(band.ReadRaster(first, above, wide, high, buf_type=gdal.GDT_Float64), np.float64).reshape(high, wide)
        known = np.isfinite(data)
        if band.GetNoDataValue() is not None:
            known &= data != band.GetNoDataValue()
        found[np.ix_(row_inside, column_inside)] = known[np.ix_(row - above, column - first)]
        return found


def covering_tiles(polygons: Sequence[Any], cell_size: float, margin: int) -> list[tuple[int, int]]:
    """Sorted (column, row) of the tiles, counted from the map's origin, that polygons widened by `margin` cells touch."""
    side = BURN_TILE * cell_size
    low, high = np.full((0, 2), 0), np.full((0, 2), 0)
    if len(polygons):
        bounds = shapely.bounds(np.asarray(polygons, object)) + margin * cell_size * np.array([-1, -1, 1, 1])
        low, high = np.floor(bounds[:, :2] / side).astype(int), np.floor(bounds[:, 2:] / side).astype(int)
    found: set[tuple[int, int]] = set()
    for (a, b), (c, d) in zip(low.tolist(), high.tolist()):
        found.update((column, row) for column in range(a, c + 1) for row in range(b, d + 1))
    return sorted(found)


def tile_bounds(tile: tuple[int, int], cell_size: float, margin: int = 0) -> tuple[float, float, float, float]:
    """(min x, min y, max x, max y) of a tile with `margin` cells around it."""
    side, more = BURN_TILE * cell_size, margin * cell_size
    return tile[0] * side - more, tile[1] * side - more, (tile[0] + 1) * side + more, (tile[1] + 1) * side + more


class OutcomeRaster:
    """A GeoTIFF of the outcomes of `assess_markings`: HIT and so on, 0 where neither side is painted.

    Parameters
    ----------
    path : of the .tif
    polygons : of result and reference together; the raster covers their extent
    cell_size : metres
    crs : WKT, "" if unknown
    margin : cells by which polygons are widened
    """

    @gdal_exceptions()
    def __init__(self, path: str, polygons: Iterable[Any], cell_size: float, crs: str, margin: int = 0) -> None:
        from osgeo import gdal

        tiles = np.array(covering_tiles(list(polygons), cell_size, margin) or [(0, 0)])
        (self._west, south), (east, self._north) = tiles.min(axis=0), tiles.max(axis=0)
        columns, rows = (east - self._west + 1) * BURN_TILE, (self._north - south + 1) * BURN_TILE
        self._raster = gdal.GetDriverByName("GTiff").Create(
            str(path), int(columns), int(rows), 1, gdal.GDT_Byte, ["TILED=YES", "COMPRESS=DEFLATE", "SPARSE_OK=TRUE", "BIGTIFF=IF_SAFER"])
        x0, _, _, y1 = tile_bounds((self._west, self._north), cell_size)
        place_raster(self._raster, (x0, cell_size, 0.0, y1, 0.0, -cell_size), crs)
        band = self._raster.GetRasterBand(1)
        band.SetNoDataValue(0)
        band.SetDescription("1 hit, 2 missed, 3 false, 4 missed beside a hit, 5 false beside paint")

    @gdal_exceptions()
    def write(self, tile: tuple[int, int], values: np.ndarray) -> None:
        """Write one tile of (BURN_TILE, BURN_TILE) values."""
        column, row = (tile[0] - self._west) * BURN_TILE, (self._north - tile[1]) * BURN_TILE
        self._raster.GetRasterBand(1).WriteRaster(int(column), int(row), BURN_TILE, BURN_TILE, np.ascontiguousarray(values, np.uint8).tobytes())

    @gdal_exceptions()
    def close(self) -> None:
        """Finish the file."""
        self._raster = None
