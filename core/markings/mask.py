"""The mask of markings as a raster, in the pixels of the intensity image."""

from contextlib import contextmanager

import numpy as np

from .intensity_raster import new_geotiff

BLOCK = 2048  # px: cells are burnt in blocks of the image, so that a window in a bend takes no more than it touches


@contextmanager
def marking_mask(path, image, origin):
    """A function that burns local places into a byte GeoTIFF: 1 where a marking is, no data elsewhere.

    Parameters
    ----------
    path : of the GeoTIFF; it appears when the block is left without an error
    image : IntensityImage whose pixels the mask has
    origin : what local coordinates leave out
    """
    from osgeo import gdal

    with new_geotiff(path, image.width, image.height, image.geotransform, image.crs, byte=True, nodata=0) as dataset:
        band = dataset.GetRasterBand(1)

        def burn(x, y):
            column, row = (np.floor(c).astype(np.int64) for c in image.pixel_of(x, y, origin))
            inside = (column >= 0) & (row >= 0) & (column < image.width) & (row < image.height)
            column, row = column[inside], row[inside]
            block = row // BLOCK * (image.width // BLOCK + 1) + column // BLOCK
            for number in np.unique(block):
                c, r = column[block == number], row[block == number]
                c0, r0, width, height = int(c.min()), int(r.min()), int(np.ptp(c)) + 1, int(np.ptp(r)) + 1
                pixels = np.frombuffer(band.ReadRaster(c0, r0, width, height, buf_type=gdal.GDT_Byte), np.uint8)
                pixels = pixels.reshape(height, width).copy()
                pixels[r - r0, c - c0] = 1
                band.WriteRaster(c0, r0, width, height, pixels.tobytes(), buf_type=gdal.GDT_Byte)

        yield burn


def pixel_centres(image, x, y, origin):
    """The pixels that local places lie in.

    Returns
    -------
    x, y : (M,) local centres of the pixels, each once
    first : (M,) index of a place in each
    """
    column, row = (np.floor(c).astype(np.int64) for c in image.pixel_of(x, y, origin))
    _, first = np.unique(row * (image.width + 1) + column, return_index=True)
    left, size, _, top, _, _ = image.geotransform
    return (left - origin[0]) + (column[first] + 0.5) * size, (top - origin[1]) - (row[first] + 0.5) * size, first
