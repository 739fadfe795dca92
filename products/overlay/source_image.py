"""The image to be georeferenced: any raster that GDAL reads, with or without a position on the map."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.common.errors import RoadExtractionError
from ...core.io.crs import NO_PLACE, place_of_raster
from ...core.io.local_files import gdal_exceptions, open_raster


@dataclass(frozen=True)
class SourceImage:
    """What is known about an image without reading its pixels."""

    path: str   # of the file
    width: int   # width, height: pixels
    height: int
    geotransform: tuple[float, ...] | None = None   # six numbers as in GDAL, or None where the image has no position on the map
    crs: str = ""   # WKT, "" where the image has none
    bands: int = 1   # count, including an alpha band
    has_alpha: bool = False   # whether the last band is an alpha band
    palette: bool = False   # whether the values are indices of a colour table
    kind: str = "byte"   # "byte", "integer" or "real", type of the values
    nodata: float | None = None   # value of pixels without data, or None

    def pixel_of(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixel and line of map coordinates, by the position of the image itself.

        Parameters
        ----------
        x, y : (N,) m

        Returns
        -------
        pixel, line : (N,)

        Raises ValueError if the image has no position.
        """
        if self.geotransform is None:
            raise ValueError("the image has no position")
        x0, xp, xl, y0, yp, yl = self.geotransform
        turn = np.linalg.inv(np.array([[xp, xl], [yp, yl]]))
        pixel, line = turn @ np.stack([np.asarray(x, float) - x0, np.asarray(y, float) - y0])
        return pixel, line

    def holds(self, pixel: np.ndarray, line: np.ndarray, margin: float = 0.0) -> np.ndarray:
        """Whether places lie in the image.

        pixel, line : (N,)
        margin : pixels around the image that count as inside
        Returns (N,) bool
        """
        return ((pixel >= -margin) & (pixel <= self.width + margin) & (line >= -margin) & (line <= self.height + margin))


@gdal_exceptions()
def open_image(path: str | Path) -> SourceImage:
    """Read the description of an image.

    Parameters
    ----------
    path : of a file that GDAL reads

    Raises RoadExtractionError if there is no such file, or it is no raster with bands.
    """
    from osgeo import gdal

    if not Path(path).is_file():
        raise RoadExtractionError(f"There is no file {path}. Give the image itself (TIFF, JPEG or PNG).")
    dataset = open_raster(path)
    if dataset.RasterCount == 0:
        raise RoadExtractionError(f"{path} is a container of several images. Give one of them, or export it as a TIFF.")
    transform, crs = place_of_raster(dataset)
    transform = None if transform == NO_PLACE else transform
    first, last = dataset.GetRasterBand(1), dataset.GetRasterBand(dataset.RasterCount)
    kind = ("byte" if first.DataType == gdal.GDT_Byte else
            "real" if first.DataType in (gdal.GDT_Float32, gdal.GDT_Float64) else "integer")
    return SourceImage(
        str(path), dataset.RasterXSize, dataset.RasterYSize, transform,
        crs, dataset.RasterCount,
        dataset.RasterCount > 1 and last.GetColorInterpretation() == gdal.GCI_AlphaBand,
        first.GetColorTable() is not None and dataset.RasterCount == 1, kind, first.GetNoDataValue())
