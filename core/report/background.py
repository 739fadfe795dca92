"""An intensity image made small and grey, to lie below a report's map."""

import numpy as np

from ..gdal_errors import gdal_exceptions


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
    data = band.ReadRaster(0, 0, width, height, columns, rows, gdal.GDT_Float32, resample_alg=gdal.GRIORA_Average)
    values = np.frombuffer(data, np.float32).reshape(rows, columns)
    empty = ~np.isfinite(values)
    nodata = band.GetNoDataValue()
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
