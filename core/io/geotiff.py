"""Tiled GeoTIFFs: written whole or not at all, and read in windows; above all the intensity image."""

from __future__ import annotations

import os
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..lazy import gdal
from .crs import place_of_raster, place_raster
from .local_files import gdal_exceptions, open_raster, reading, unfinished_path
from .weights import IO

GEOTIFF_TILE = 512          # source: TIFF 6.0, sides of tiles are multiples of 16; px, of the file and of what is processed at a time
NODATA = -9999.0            # source: usual in GIS; value of pixels without data
MAX_SAMPLED_WINDOW = 4 * GEOTIFF_TILE**2   # derived: px that are read as one window to be sampled
MAX_CACHED_PIXELS = 32 * GEOTIFF_TILE**2   # derived: px that GDAL may cache of what a thread has read


class IntensityImage:
    """An intensity image that several threads may read.

    geotransform : (6,) of GDAL, map coordinates; cell_size : metres; width, height : pixels; crs : WKT, "" where the file carries none
    eight_bit : whether it is the display image, with values 1 to 255
    """

    def __init__(self, path: str | os.PathLike[str], geotransform: tuple[float, ...], width: int, height: int, crs: str, eight_bit: bool = False):
        self.path = str(path)
        self.geotransform = geotransform
        self.cell_size = geotransform[1]
        self.width, self.height = width, height
        self.crs = crs
        self.eight_bit = eight_bit
        self._own = threading.local()  # a GDAL dataset serves one thread only

    @classmethod
    @gdal_exceptions()
    def open(cls, path: str | os.PathLike[str]) -> IntensityImage:
        """Open an image; RoadExtractionError if it is missing, not a raster, rotated, has no square pixels, or is in degrees."""
        dataset = _open_raster(path)
        transform, crs = place_of_raster(dataset)
        if transform is None:
            raise RoadExtractionError(f"{path} is an image without georeferencing. Give the intensity image written by “Intensity image”.")
        if transform[2] or transform[4] or abs(transform[1] + transform[5]) > 1e-6 * abs(transform[1]) or transform[1] <= 0:
            raise RoadExtractionError(f"{path} has pixels of {transform[1]:g} by {-transform[5]:g} map units or is rotated. An intensity image has "
                                      "square pixels and north up: make it again with “Intensity image”.")
        reference = dataset.GetSpatialRef()
        if reference is not None and reference.IsGeographic():
            raise RoadExtractionError(f"{path} is in {reference.GetName()} (degrees). Markings are measured in metres: make the image again from "
                                      "road points in a projected CRS.")
        eight_bit = dataset.GetRasterBand(1).DataType == 1  # GDT_Byte
        return cls(path, transform, dataset.RasterXSize, dataset.RasterYSize, crs, eight_bit)

    def read_pixels(self, column: int, row: int, width: int, height: int) -> np.ndarray:
        """(height, width) float32 pixels from (column, row) on; NaN where there is no data or no image, beyond which the window may reach."""
        values = np.full((height, width), np.nan, np.float32)
        c0, c1 = max(column, 0), min(column + width, self.width)
        r0, r1 = max(row, 0), min(row + height, self.height)
        if c0 < c1 and r0 < r1:
            self._fill(values[r0 - row:r1 - row, c0 - column:c1 - column], c0, r0)
        return values

    @gdal_exceptions()
    def _fill(self, values: np.ndarray, column: int, row: int) -> None:
        """Put the pixels with data from (column, row) on into a window of NaN that lies within the image."""
        band = self._dataset(values.size).GetRasterBand(1)
        with reading(self.path):
            data = np.frombuffer(band.ReadRaster(column, row, *values.shape[::-1], buf_type=gdal.GDT_Float32), np.float32).reshape(values.shape)
        nodata = band.GetNoDataValue()
        np.copyto(values, data, where=np.isfinite(data) if nodata is None else np.isfinite(data) & (data != np.float32(nodata)))

    @gdal_exceptions()
    def tiles(self) -> list[tuple[int, int]]:
        """(column, row) of the first pixel of each tile that may hold data, row by row.

        Empty tiles are missing from the file. They are found by bisection, without reading pixels.
        """
        band, width, height = self._dataset(0).GetRasterBand(1), self.width, self.height
        waiting, tiles = [(0, 0, -(-width // GEOTIFF_TILE), -(-height // GEOTIFF_TILE))], []
        while waiting:
            c0, r0, c1, r1 = waiting.pop()
            column, row = c0 * GEOTIFF_TILE, r0 * GEOTIFF_TILE
            flags, _ = band.GetDataCoverageStatus(column, row, min(c1 * GEOTIFF_TILE, width) - column, min(r1 * GEOTIFF_TILE, height) - row)
            if not flags & gdal.GDAL_DATA_COVERAGE_STATUS_DATA:
                continue
            if c1 - c0 == r1 - r0 == 1:
                tiles.append((row, column))
            elif c1 - c0 >= r1 - r0:
                middle = (c0 + c1) // 2
                waiting += [(c0, r0, middle, r1), (middle, r0, c1, r1)]
            else:
                middle = (r0 + r1) // 2
                waiting += [(c0, r0, c1, middle), (c0, middle, c1, r1)]
        return [(column, row) for row, column in sorted(tiles)]

    def pixel_of(self, x: Any, y: Any, origin: Any = (0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
        """(N,) float64 column and row of places, (N,) metres; pixel 0 extends from 0 to 1.

        origin : map coordinates that were subtracted from x and y, such as RoadFrame.origin
        """
        left, _, _, top, _, _ = self.geotransform
        return (np.asarray(x, float) + (origin[0] - left)) / self.cell_size, \
            ((top - origin[1]) - np.asarray(y, float)) / self.cell_size

    def sample(self, x: Any, y: Any, origin: Any = (0.0, 0.0)) -> np.ndarray:
        """(N,) float32 values of the pixels that contain places, as of `pixel_of`; NaN where there is no data."""
        column, row = (np.floor(place) for place in self.pixel_of(x, y, origin))
        values = np.full(len(column), np.nan, np.float32)
        if not len(values):
            return values
        box = [int(end) for whole in (column, row) for end in (whole.min(), whole.max())]
        if (box[1] - box[0] + 1) * (box[3] - box[2] + 1) <= MAX_SAMPLED_WINDOW:
            pixels = self.read_pixels(box[0], box[2], box[1] - box[0] + 1, box[3] - box[2] + 1)
            row -= box[2]
            row *= pixels.shape[1]
            row += column
            row -= box[0]
            return pixels.ravel().take(row.astype(np.intp))
        column, row = column.astype(np.int64), row.astype(np.int64)
        inside = np.flatnonzero((column >= 0) & (row >= 0) & (column < self.width) & (row < self.height))
        tile = (row[inside] // GEOTIFF_TILE) * (self.width // GEOTIFF_TILE + 1) + column[inside] // GEOTIFF_TILE
        order = inside[np.argsort(tile, kind="stable")]
        for rows in np.split(order, np.flatnonzero(np.diff(np.sort(tile))) + 1) if len(order) else []:
            c, r = column[rows], row[rows]
            c0, r0 = int(c.min()), int(r.min())
            values[rows] = self.read_pixels(c0, r0, int(c.max()) - c0 + 1, int(r.max()) - r0 + 1)[r - r0, c - c0]
        return values

    def _dataset(self, pixels):
        """This thread's dataset, of which so many pixels are to be read; it is reopened now and then to empty GDAL's cache."""
        self._own.read = getattr(self._own, "read", 0) + pixels
        if self._own.read > MAX_CACHED_PIXELS or not hasattr(self._own, "dataset"):
            self._own.dataset = None  # frees the cache of the old dataset before the new one is opened
            self._own.dataset, self._own.read = _open_raster(self.path), pixels
        return self._own.dataset


def _open_raster(path):
    if not Path(path).is_file():
        raise RoadExtractionError(f"There is no file {path}. Give the intensity image written by “Intensity image”.")
    return open_raster(path, "Give the GeoTIFF written by “Intensity image”.")


class _NewGeoTiff:
    """The single band of a GeoTIFF that is being written, of uint8 where `byte` says so, otherwise float32; `nodata` marks pixels without data.

    copied : whether it is there already, as the copy of one like it of which some pixels will change
    """

    @gdal_exceptions()
    def __init__(self, path: str | os.PathLike[str], width: int, height: int, geotransform: Any, crs: str, byte: bool, nodata: float,
                 description: str, copied: bool):
        options = [f"BLOCKXSIZE={GEOTIFF_TILE}", f"BLOCKYSIZE={GEOTIFF_TILE}", "TILED=YES", "COMPRESS=DEFLATE", "SPARSE_OK=TRUE",
                   "BIGTIFF=IF_SAFER", f"NUM_THREADS={IO.compression_threads}"]
        # Intensities are too noisy to be predicted from their neighbours: a predictor costs more time than it saves.
        options += ["PREDICTOR=2"] if byte else ["ZLEVEL=1"]
        self._type = gdal.GDT_Byte if byte else gdal.GDT_Float32
        self._dtype = np.dtype(np.uint8 if byte else np.float32)
        if copied:
            self._dataset = gdal.OpenEx(str(path), gdal.OF_RASTER | gdal.OF_UPDATE | gdal.OF_VERBOSE_ERROR, allowed_drivers=["GTiff"],
                                        open_options=[f"NUM_THREADS={IO.compression_threads}"])
            return
        self._dataset = gdal.GetDriverByName("GTiff").Create(str(path), width, height, 1, self._type, options)
        place_raster(self._dataset, geotransform, crs)
        self._dataset.GetRasterBand(1).SetNoDataValue(nodata)
        self._dataset.GetRasterBand(1).SetDescription(description)

    @gdal_exceptions()
    def write(self, column: int, row: int, values: np.ndarray, whole: bool = False) -> None:
        """Write (H, W) pixels, the first at (column, row); where they are all of a tile, other threads compress it while the work goes on."""
        (height, width), band = values.shape, self._dataset.GetRasterBand(1)
        band.WriteRaster(column, row, width, height, np.ascontiguousarray(values, self._dtype).tobytes(), buf_type=self._type)
        if whole:
            band.FlushCache()

    @gdal_exceptions()
    def read(self, column: int, row: int, width: int, height: int) -> np.ndarray:
        """(height, width) pixels as written so far, a copy."""
        data = self._dataset.GetRasterBand(1).ReadRaster(column, row, width, height, buf_type=self._type)
        return np.frombuffer(data, self._dtype).reshape(height, width).copy()

    @gdal_exceptions()
    def close(self) -> None:
        """Complete and close the file; an open file cannot be renamed on Windows."""
        try:
            self._dataset.FlushCache()
        finally:
            self.drop()

    def drop(self) -> None:
        """Close the file, complete or not."""
        self._dataset = None


def _copy(path, target):
    """Copy a file; RuntimeError, as of GDAL, where that fails."""
    try:
        shutil.copyfile(path, target)
    except OSError as error:
        raise RuntimeError(str(error)) from error


@contextmanager
def new_geotiff(path: str | os.PathLike[str], width: int, height: int, geotransform: Any, crs: str, byte: bool = False,
                nodata: float = NODATA, description: str = "", like: Path | None = None) -> Iterator[_NewGeoTiff]:
    """A new GeoTIFF with one band: tiled, DEFLATE, without empty tiles. It appears at its path only when all is written.

    Of several runs that write the same file each ends well, and the last to end is kept. RoadExtractionError if the file cannot be written.
    geotransform : (6,) of GDAL; crs : WKT, "" for none; byte, nodata : as of _NewGeoTiff; description : what its values are
    like : another one of all this, of which only the pixels that change are written
    """
    target = Path(path)
    unfinished = unfinished_path(target, ".tif")
    image = None
    try:
        if like is not None:
            _copy(like, unfinished)
        image = _NewGeoTiff(unfinished, width, height, geotransform, crs, byte, nodata, description, like is not None)
        yield image
        image.close()
        os.replace(unfinished, target)
        # statistics that a viewer stored beside the previous image do not hold for this one
        target.with_name(target.name + ".aux.xml").unlink(missing_ok=True)
    except RuntimeError as problem:  # of GDAL: the folder is not writable, or the disk is full
        raise RoadExtractionError(f"{path} cannot be written ({problem}). Choose another folder or free some disk space.") from problem
    finally:
        if image is not None:
            image.drop()
        unfinished.unlink(missing_ok=True)


def write_display_image(image_path: str | os.PathLike[str], path: str | os.PathLike[str], progress: Progress = Progress()) -> None:
    """Write an intensity image stretched to bytes 1 to 255, for viewers; 0 is no data. RoadExtractionError if it cannot be read or written.

    The stretch runs from the 1st to the 99.5th percentile of the image.
    """
    image = IntensityImage.open(image_path)
    low, high = _stretch(image)
    with new_geotiff(path, image.width, image.height, image.geotransform, image.crs, byte=True, nodata=0) as picture:
        for column, row in image.tiles():
            width, height = min(GEOTIFF_TILE, image.width - column), min(GEOTIFF_TILE, image.height - row)
            values = image.read_pixels(column, row, width, height)
            filled = np.isfinite(values)
            if filled.any():
                grey = 1 + np.rint(254 * np.clip((values - low) / max(high - low, 1e-9), 0, 1))
                picture.write(column, row, np.where(filled, grey, 0).astype(np.uint8))
            progress.report(row / image.height)
    progress.report(1.0)


def _stretch(image):
    """1st and 99.5th percentile of an image, computed from every n-th pixel."""
    tiles = image.tiles()
    # a large image that is mostly empty gives as many pixels as a small one that is full
    filled = int(np.sqrt(len(tiles))) * GEOTIFF_TILE // IO.display_size
    step = max(1, min(max(image.width, image.height) // IO.display_size, max(filled, IO.max_display_step)))
    parts = [np.empty(0, np.float32)]
    for column, row in tiles:
        values = image.read_pixels(column, row, GEOTIFF_TILE, GEOTIFF_TILE)[::step, ::step]
        parts.append(values[np.isfinite(values)])
    values = np.concatenate(parts)
    return tuple(np.percentile(values, [1.0, 99.5])) if len(values) else (0.0, 1.0)
