"""The photo and the part of the intensity image about it, read at the same fineness and turned into contrast."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.geotiff import GEOTIFF_TILE, IntensityImage
from ...io.local_files import gdal_exceptions, open_raster
from ..source_image import SourceImage
from .contrast import paint_contrast

FINEST_CELL = 0.04        # m: smaller cells show the gaps between laser points rather than paint
MOST_PIXELS = 60_000_000  # of either image in memory, 240 MB
_LUMINANCE = (0.299, 0.587, 0.114)  # of red, green and blue (ITU-R BT.601)


@dataclass(frozen=True)
class SurveyedPaint:
    """Contrast of a part of the intensity image, north up.

    Attributes
    ----------
    contrast : (H, W) float32, 0 where unknown
    values : (H, W) float32 intensity, NaN where unknown
    cell : m
    left, top : map coordinates of its outer corner, the origin of local coordinates
    """

    contrast: np.ndarray
    values: np.ndarray
    cell: float
    left: float
    top: float

    @property
    def known(self) -> np.ndarray:
        """(H, W) bool."""
        return np.isfinite(self.values)


@dataclass(frozen=True)
class Photo:
    """Contrast of the photo.

    Attributes
    ----------
    contrast : (H, W) float32
    luminance : (H, W) float32, NaN where there is none
    factor : pixels of the image side by side in a pixel here
    """

    contrast: np.ndarray
    luminance: np.ndarray
    factor: int


def read_paint(image: IntensityImage, box: tuple[float, float, float, float] | None = None) -> SurveyedPaint:
    """The part of an intensity image within a box of map coordinates, its cells made no finer than FINEST_CELL.

    Parameters
    ----------
    image : IntensityImage
    box : west, south, east, north, m; None: the whole image

    Returns
    -------
    SurveyedPaint; empty where the box lies outside the image
    """
    cell = image.cell_size
    first, last = (0, 0), (image.width, image.height)
    if box is not None:
        (c0, c1), (r0, r1) = image.pixel_of(np.array([box[0], box[2]]), np.array([box[3], box[1]]))
        first = max(0, int(np.floor(c0))), max(0, int(np.floor(r0)))
        last = min(image.width, int(np.ceil(c1))), min(image.height, int(np.ceil(r1)))
    width, height = max(0, last[0] - first[0]), max(0, last[1] - first[1])
    step = max(1, round(FINEST_CELL / cell), int(np.ceil(np.sqrt(width * height / MOST_PIXELS))))
    values = np.full((height // step, width // step), np.nan, np.float32)
    strip = max(1, GEOTIFF_TILE // step)
    for row in range(0, len(values), strip):
        count = min(strip, len(values) - row)
        pixels = image.read_pixels(first[0], first[1] + row * step, values.shape[1] * step, count * step)
        values[row:row + count] = pixels if step == 1 else _means(pixels, step)
    left, top = image.geotransform[0] + first[0] * cell, image.geotransform[3] - first[1] * cell
    return SurveyedPaint(paint_contrast(values, cell * step)[0], values, cell * step, left, top)


def _means(pixels, step):
    """Means of step x step pixels over those that are known."""
    blocks = pixels.reshape(len(pixels) // step, step, pixels.shape[1] // step, step)
    known = np.isfinite(blocks)
    count = known.sum(axis=(1, 3))
    total = np.where(known, blocks, 0.0).sum(axis=(1, 3))
    return np.divide(total, count, out=np.full(count.shape, np.nan, np.float32), where=count > 0)


@gdal_exceptions()
def read_photo(image: SourceImage, size: float, cell: float) -> Photo:
    """The luminance and contrast of an image, in pixels about as large as a cell of the intensity image or as they are.

    Parameters
    ----------
    image : SourceImage
    size : m of a pixel, roughly
    cell : m of a cell of the intensity image

    Returns
    -------
    Photo

    Raises
    ------
    RoadExtractionError
        If the image cannot be read.
    """
    from osgeo import gdal

    width, height = image.width, image.height
    factor = max(1, int(cell / size + 0.25), int(np.ceil(np.sqrt(width * height / MOST_PIXELS))))
    columns, rows = max(1, width // factor), max(1, height // factor)
    try:
        dataset = open_raster(image.path)
        if image.palette:
            dataset = gdal.Translate("", dataset, format="VRT", rgbExpand="rgb")
        colours = (1, 2, 3) if dataset.RasterCount - image.has_alpha >= 3 else (1,)
        weights = _LUMINANCE if len(colours) == 3 else (1.0,)

        def read(band, resampling, kind=gdal.GDT_Float32, dtype=np.float32):
            data = band.ReadRaster(0, 0, columns * factor, rows * factor, columns, rows, kind, resample_alg=resampling)
            return np.frombuffer(data, dtype).reshape(rows, columns)

        luminance = np.zeros((rows, columns), np.float32)
        for number, weight in zip(colours, weights):
            luminance += np.float32(weight) * read(dataset.GetRasterBand(number), gdal.GRIORA_Average)
        seen = read(dataset.GetRasterBand(1).GetMaskBand(), gdal.GRIORA_NearestNeighbour, gdal.GDT_Byte, np.uint8)
    except RuntimeError as problem:
        raise RoadExtractionError(f"{image.path} cannot be read as an image ({problem}). Export it anew as a TIFF or JPEG.") from problem
    luminance[(seen < 128) | ~np.isfinite(luminance)] = np.nan
    return Photo(paint_contrast(luminance, size * factor)[0], luminance, factor)
