"""The photo and the part of the intensity image about it, read at the same fineness and turned into contrast."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.common.errors import RoadExtractionError
from ....core.io.geotiff import GEOTIFF_TILE, IntensityImage
from ....core.io.local_files import gdal_exceptions, open_raster
from ....core.lazy import cv2
from ..source_image import SourceImage

FINEST_CELL = 0.04        # m: smaller cells show the gaps between laser points rather than paint
MOST_PIXELS = 60_000_000  # of either image in memory, 240 MB
_LUMINANCE = (0.299, 0.587, 0.114)  # of red, green and blue (ITU-R BT.601)


@dataclass(frozen=True)
class SurveyedPaint:
    """Contrast of a part of the intensity image, north up."""

    contrast: np.ndarray   # (H, W) float32, 0 where unknown
    values: np.ndarray   # (H, W) float32 intensity, NaN where unknown
    cell: float   # m
    left: float   # left, top: map coordinates of its outer corner, the origin of local coordinates
    top: float

    @property
    def known(self) -> np.ndarray:
        """(H, W) bool."""
        return np.isfinite(self.values)


@dataclass(frozen=True)
class Photo:
    """Contrast of the photo."""

    contrast: np.ndarray   # (H, W) float32
    luminance: np.ndarray   # (H, W) float32, NaN where there is none
    factor: int   # pixels of the image side by side in a pixel here


def read_paint(image: IntensityImage, box: tuple[float, float, float, float] | None = None) -> SurveyedPaint:
    """The part of an intensity image within a box of map coordinates, its cells made no finer than FINEST_CELL.

    box : west, south, east, north, m; None: the whole image
    Returns SurveyedPaint; empty where the box lies outside the image
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
    return SurveyedPaint(_paint_contrast(values, cell * step), values, cell * step, left, top)


def _means(pixels, step):
    """Means of step x step pixels over those that are known."""
    blocks = pixels.reshape(len(pixels) // step, step, pixels.shape[1] // step, step)
    finite = np.isfinite(blocks)
    count = finite.sum(axis=(1, 3))
    total = np.where(finite, blocks, 0.0).sum(axis=(1, 3))
    return np.divide(total, count, out=np.full(count.shape, np.nan, np.float32), where=count > 0)


@gdal_exceptions()
def read_photo(image: SourceImage, size: float, cell: float) -> Photo:
    """The luminance and contrast of an image, in pixels about as large as a cell of the intensity image or as they are.

    Parameters
    ----------
    size : m of a pixel, roughly
    cell : m of a cell of the intensity image

    Raises RoadExtractionError if the image cannot be read.
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
        mask = read(dataset.GetRasterBand(1).GetMaskBand(), gdal.GRIORA_NearestNeighbour, gdal.GDT_Byte, np.uint8)
    except RuntimeError as problem:
        raise RoadExtractionError(f"{image.path} cannot be read as an image ({problem}). Export it anew as a TIFF or JPEG.") from problem
    luminance[(mask < 128) | ~np.isfinite(luminance)] = np.nan
    return Photo(_paint_contrast(luminance, size * factor), luminance, factor)


# Paint against its surroundings, made comparable between a photo and an intensity image.

SURROUNDINGS = 1.0   # m, standard deviation of the Gaussian window of the local mean; paint is at most half a metre wide
FULL_CONTRAST = 0.6  # difference of logarithms between fresh paint and asphalt that counts as 1
_DARKEST = 0.1       # of the range of values, added before the logarithm: black is not infinitely dark
_RANGE = (1.0, 99.5)  # percentiles of the values taken for black and white


def _paint_contrast(values: np.ndarray, pixel_size: float) -> np.ndarray:
    """How much brighter each pixel is than its surroundings, -1 to 1, as a logarithm, so that sun and shadow look alike; 0 where unknown."""
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros(values.shape, np.float32)
    low, high = np.percentile(values[finite][:: max(1, int(finite.sum()) // 1_000_000)], _RANGE)
    share = (np.where(finite, values, low) - low) / max(float(high - low), 1e-9)
    logarithm = np.log(np.clip(share, 0.0, 1.0) + _DARKEST).astype(np.float32)
    weight = finite.astype(np.float32)
    around = SURROUNDINGS / pixel_size
    mean = _smooth(logarithm * weight, around) / np.maximum(_smooth(weight, around), 1e-3)
    return np.clip((logarithm - mean) / FULL_CONTRAST, -1.0, 1.0) * weight


def _smooth(values, deviation):
    """Gaussian smoothing; a wide window works on a reduced copy, which is as exact as the smoothing needs."""
    step = max(1, int(deviation // 6))
    if step == 1:
        return cv2.GaussianBlur(values, (0, 0), deviation, borderType=cv2.BORDER_REPLICATE)
    height, width = values.shape
    small = cv2.resize(values, (max(1, width // step), max(1, height // step)), interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), deviation / step, borderType=cv2.BORDER_REPLICATE)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)


def reduced(contrast: np.ndarray, factor: int) -> np.ndarray:
    """The contrast in pixels that are `factor` times as wide, each the mean of those it covers.

    contrast : (H, W)
    factor : at least 1; the last columns and rows that fill no pixel are left out
    Returns (H // factor, W // factor) float32
    """
    if factor == 1:
        return contrast
    height, width = (n // factor for n in contrast.shape)
    if not height or not width:
        return contrast[:1, :1]
    return cv2.resize(contrast[:height * factor, :width * factor], (width, height), interpolation=cv2.INTER_AREA)
