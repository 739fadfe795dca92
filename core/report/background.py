"""An intensity image made small and grey, to lie below a report's map."""

import numpy as np

from ..gdal_errors import gdal_exceptions
from ..markings.intensity_raster import TILE, filled_tiles

LONGEST = 500_000  # px of a side up to which GDAL averages all, empty ones among them; of longer rasters only tiles that hold data are read


@gdal_exceptions()
def grey_background(path, longest=1800):
    """A stretched grey copy of a raster.

    Returns
    -------
    (H, W) uint8 with 0 where there is no data, and (min x, min y, max x, max y)
    """
    from osgeo import gdal

    dataset = gdal.Open(str(path))
    width, height = dataset.RasterXSize, dataset.RasterYSize
    scale = min(1.0, longest / max(width, height))
    columns, rows = max(int(width * scale), 1), max(int(height * scale), 1)
    band = dataset.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    if max(width, height) > LONGEST:
        values = _averaged(dataset, columns, rows, nodata)
    else:
        data = band.ReadRaster(0, 0, width, height, columns, rows, gdal.GDT_Float32, resample_alg=gdal.GRIORA_Average)
        values = np.frombuffer(data, np.float32).reshape(rows, columns)
    empty = ~np.isfinite(values)
    if nodata is not None and np.isfinite(nodata):
        empty |= values == np.float32(nodata)
    x0, dx, _, y0, _, dy = dataset.GetGeoTransform()
    extent = (x0, y0 + dy * height, x0 + dx * width, y0)
    grey = np.zeros(values.shape, np.uint8)
    if not empty.all():
        low, high = np.percentile(values[~empty], [1, 99.5])
        stretched = 1 + 254 * np.clip((values - low) / max(high - low, 1e-9), 0, 1)
        grey = np.where(empty, 0, np.nan_to_num(stretched)).astype(np.uint8)
    return grey, extent


def _averaged(dataset, columns, rows, nodata):
    """(rows, columns) means of what a raster holds, read tile by tile; NaN where there is nothing."""
    from osgeo import gdal

    band, width, height = dataset.GetRasterBand(1), dataset.RasterXSize, dataset.RasterYSize
    total, count = np.zeros((2, rows, columns))
    for left, top in filled_tiles(dataset):
        size = min(TILE, width - left), min(TILE, height - top)
        values = np.frombuffer(band.ReadRaster(left, top, *size, buf_type=gdal.GDT_Float32), np.float32).reshape(size[::-1])
        known = np.isfinite(values) if nodata is None else np.isfinite(values) & (values != np.float32(nodata))
        column, row = (np.arange(first, first + n) * few // many for first, n, few, many in
                       ((left, size[0], columns, width), (top, size[1], rows, height)))
        place = slice(row[0], row[-1] + 1), slice(column[0], column[-1] + 1)
        cells = total[place].shape
        cell = ((row - row[0])[:, None] * cells[1] + (column - column[0]))[known]
        total[place] += np.bincount(cell, values[known], cells[0] * cells[1]).reshape(cells)
        count[place] += np.bincount(cell, minlength=cells[0] * cells[1]).reshape(cells)
    return np.divide(total, count, out=np.full((rows, columns), np.nan), where=count > 0)
