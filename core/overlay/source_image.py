"""The image to be georeferenced, as it comes: any raster that GDAL reads, with a place on the map or none."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..common.errors import RoadExtractionError
from ..io.gdal_errors import gdal_exceptions

_NO_GEOTRANSFORM = (0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class SourceImage:
    """What is known about the image without reading its pixels.

    Attributes
    ----------
    path : of the file
    width, height : pixels
    geotransform : as GDAL has it, or None where the image has no place on the map
    crs : WKT, "" where the image says none
    bands : their number, an alpha band included
    has_alpha : whether the last band is one
    palette : whether the values are places in a colour table
    kind : "byte", "integer" or "real", what the values are
    nodata : value of pixels without data, or None
    """

    path: str
    width: int
    height: int
    geotransform: tuple = None
    crs: str = ""
    bands: int = 1
    has_alpha: bool = False
    palette: bool = False
    kind: str = "byte"
    nodata: float = None

    def pixel_of(self, x, y):
        """Pixel and line, (N,) each, of places given in the position that the image came with."""
        x0, xp, xl, y0, yp, yl = self.geotransform
        turn = np.linalg.inv(np.array([[xp, xl], [yp, yl]]))
        return tuple(turn @ np.stack([np.asarray(x, float) - x0, np.asarray(y, float) - y0]))

    def holds(self, pixel, line, margin=0.0):
        """Which of some places, (N,), lie in the image or within `margin` pixels of it."""
        return ((pixel >= -margin) & (pixel <= self.width + margin)
                & (line >= -margin) & (line <= self.height + margin))


@gdal_exceptions()
def open_image(path):
    """SourceImage of a file; refuses what GDAL cannot read and images that are too small to hold anything.

    Raises
    ------
    RoadExtractionError
        If there is no such file, or it is no raster.
    """
    from osgeo import gdal

    if not Path(path).is_file():
        raise RoadExtractionError(f"There is no file {path}. Give the image itself (TIFF, JPEG or PNG).")
    try:
        dataset = gdal.Open(str(path))
    except RuntimeError as problem:
        raise RoadExtractionError(f"{path} cannot be read as an image ({problem}). Give a TIFF, JPEG or PNG.") from problem
    if dataset.RasterCount == 0:
        raise RoadExtractionError(f"{path} holds several images and none of its own. Name one of them, or export it as a TIFF.")
    transform = dataset.GetGeoTransform(can_return_null=True)
    placed = transform is not None and tuple(transform) != _NO_GEOTRANSFORM
    first, last = dataset.GetRasterBand(1), dataset.GetRasterBand(dataset.RasterCount)
    kind = ("byte" if first.DataType == gdal.GDT_Byte else
            "real" if first.DataType in (gdal.GDT_Float32, gdal.GDT_Float64) else "integer")
    return SourceImage(
        str(path), dataset.RasterXSize, dataset.RasterYSize, tuple(transform) if placed else None,
        dataset.GetProjection() or "", dataset.RasterCount,
        dataset.RasterCount > 1 and last.GetColorInterpretation() == gdal.GCI_AlphaBand,
        first.GetColorTable() is not None and dataset.RasterCount == 1, kind, first.GetNoDataValue())
