"""Pairs of cut-outs about control points: what the image and the intensity image show at the same place, north up."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core.io.geotiff import IntensityImage
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.lazy import cv2
from .rough_place import similarity
from .source_image import SourceImage

_STRETCH = (1.0, 99.5)  # percentiles of a cut-out's values shown as black and white


@gdal_exceptions()
def pair_cutouts(image: SourceImage, intensity: IntensityImage, pixel: np.ndarray, line: np.ndarray, easting: np.ndarray,
                 northing: np.ndarray, half: float = 1.6, side: int = 120) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The two cut-outs of each pair, its place in their middle.

    Parameters
    ----------
    pixel, line : (N,) in the image; N at least 2
    easting, northing : (N,) m, in the intensity image
    half : m, half the side of a cut-out
    side : pixels of a cut-out

    Returns iterator of two (side, side, 3) uint8, red, green, blue; black where there is nothing
    """
    from osgeo import gdal

    dataset = open_raster(image.path)
    if image.palette:
        dataset = gdal.Translate("", dataset, format="VRT", rgbExpand="rgb")
    bands = (1, 2, 3) if dataset.RasterCount - image.has_alpha >= 3 else (1, 1, 1)
    factor, _ = similarity(pixel, line, easting, northing)
    per_cell = 2.0 * half / side
    for pair in zip(pixel, line, easting, northing):
        yield _photo(dataset, bands, image, pair[:2], 1.0 / factor, per_cell, side), _intensity(intensity, pair[2:], half, side)


def _photo(dataset, bands, image, place, factor, per_cell, side):
    """A part of the image, turned as the map is; `factor`: pixels per metre, as a complex number."""
    reach = int(np.ceil(0.75 * side * per_cell * abs(factor))) + 2
    column, row = int(place[0]) - reach, int(place[1]) - reach
    c0, c1 = max(0, column), min(image.width, column + 2 * reach)
    r0, r1 = max(0, row), min(image.height, row + 2 * reach)
    if c0 >= c1 or r0 >= r1:
        return np.zeros((side, side, 3), np.uint8)
    from osgeo import gdal

    window = np.zeros((2 * reach, 2 * reach, 3), np.float32)
    for number, band in enumerate(bands):
        data = np.frombuffer(dataset.GetRasterBand(band).ReadRaster(c0, r0, c1 - c0, r1 - r0, buf_type=gdal.GDT_Float32), np.float32)
        window[r0 - row:r1 - row, c0 - column:c1 - column, number] = data.reshape(r1 - r0, c1 - c0)
    # from pixels of the cut-out, right and down, to those of the window
    a, b = factor.real * per_cell, factor.imag * per_cell
    matrix = np.array([[a, b, 0.0], [-b, a, 0.0]])
    matrix[:, 2] = np.array([place[0] - column - 0.5, place[1] - row - 0.5]) - matrix[:, :2] @ [side / 2 - 0.5, side / 2 - 0.5]
    shrink = per_cell * abs(factor)
    smooth = cv2.GaussianBlur(window, (0, 0), 0.4 * shrink) if shrink > 1.5 else window
    cut = cv2.warpAffine(smooth, matrix, (side, side), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
    return np.clip(np.rint(cut), 0, 255).astype(np.uint8) if image.kind == "byte" else _stretched(cut)


def _intensity(intensity, place, half, side):
    """A part of the intensity image."""
    column, row = (float(v[0]) for v in intensity.pixel_of(np.array([place[0]]), np.array([place[1]])))
    reach = int(np.ceil(half / intensity.cell_size)) + 2
    first = int(column) - reach, int(row) - reach
    values = intensity.read_pixels(*first, 2 * reach, 2 * reach)
    step = 2.0 * half / side / intensity.cell_size
    matrix = np.array([[step, 0.0, 0.0], [0.0, step, 0.0]])
    matrix[:, 2] = np.array([column - first[0] - 0.5, row - first[1] - 0.5]) - step * (side / 2 - 0.5)
    cut = cv2.warpAffine(values, matrix, (side, side), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP, borderValue=float("nan"))
    return np.repeat(_stretched(cut[..., None]), 3, axis=2)


def _stretched(values):
    """(H, W, C) values as bytes, dark to light; black where there are none."""
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros(values.shape, np.uint8)
    low, high = np.percentile(values[finite], _STRETCH)
    share = np.clip((np.where(finite, values, low) - low) / max(float(high - low), 1e-9), 0.0, 1.0)
    return np.where(finite, np.rint(30 + 225 * share), 0).astype(np.uint8)
