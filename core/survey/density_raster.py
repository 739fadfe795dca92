"""Point density as a GeoTIFF."""

import numpy as np

from ..gdal_errors import gdal_exceptions


@gdal_exceptions()
def write_density(found, path):
    """Write the density of an Inspection: float32 points per m², NaN where no point lies.

    Parameters
    ----------
    found : Inspection
    path : of the .tif
    """
    from osgeo import gdal, osr

    density, (west, north) = found.density
    height, width = density.shape
    cell = found.settings.cell_size
    dataset = gdal.GetDriverByName("GTiff").Create(
        str(path), width, height, 1, gdal.GDT_Float32, ["COMPRESS=DEFLATE", "TILED=YES", "PREDICTOR=3"])
    dataset.SetGeoTransform((west, cell, 0.0, north, 0.0, -cell))
    if found.crs:
        reference = osr.SpatialReference()
        reference.ImportFromWkt(found.crs)
        dataset.SetProjection(reference.ExportToWkt())
    band = dataset.GetRasterBand(1)
    band.SetNoDataValue(float("nan"))
    band.SetDescription("Points per m²")
    # bytes, not an array: osgeo's numpy bridge breaks wherever numpy is not the one it was built with
    band.WriteRaster(0, 0, width, height, np.ascontiguousarray(density, np.float32).tobytes())
    band.FlushCache()
    del band, dataset
