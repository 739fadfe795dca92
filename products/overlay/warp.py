"""The georeferenced image, resampled by GDAL into a GeoTIFF."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import shapely

from ...core.common.errors import Cancelled, RoadExtractionError
from ...core.common.progress import Progress
from ...core.io.crs import as_in_file
from ...core.io.geotiff import GEOTIFF_TILE
from ...core.io.local_files import gdal_exceptions, open_raster, unfinished_path
from .georeference import Georeferencing, node_grid, own_pixel_size

GDAL_CACHE = 128_000_000  # bytes: a larger cache delays the writing of blocks to the end of the work
MAX_RESULT_PIXELS = 4e9  # a larger result means that the polynomial or the pixel size is wrong
_APPROXIMATION = 0.05    # pixels, error of the interpolation along a row by GDAL
_NODES = 21              # per side, of the grid of points that replaces the polynomial in GDAL
_MARGINS = (0.2, 0.1, 0.04, 0.0)  # of the size of the area, by which the grid exceeds it
_SMALLEST_OVERVIEW = 256  # pixels
_ALGORITHMS = {"nearest": "near", "bilinear": "bilinear", "cubic": "cubic"}


def drawn_area(found: Georeferencing) -> shapely.Geometry:
    """The part of the image that is drawn.

    Returns shapely polygon in pixel and line
    """
    frame = shapely.box(0, 0, found.image.width, found.image.height)
    return found.hull.intersection(frame) if found.cut and found.hull is not None else frame


def output_grid(found: Georeferencing) -> tuple[tuple[float, float, float, float], int, int]:
    """Bounds and size of the result.

    Bounds are whole multiples of the pixel size. A shift at the pixel size of the image keeps the bounds of the image, so that no pixel is resampled.

    Returns
    -------
    bounds : (min x, min y, max x, max y), m
    width, height : pixels

    Raises RoadExtractionError if the result would have more than MAX_RESULT_PIXELS.
    """
    outline = drawn_area(found).exterior
    outline = shapely.get_coordinates(outline.segmentize(max(outline.length / 400, 1e-6)))
    easting, northing = found.fit.polynomial.to_map(outline[:, 0], outline[:, 1])
    size = found.pixel_size
    x0, y0, x1, y1 = easting.min(), northing.min(), easting.max(), northing.max()
    if not _keeps_its_pixels(found):
        x0, y0 = np.floor(x0 / size + 1e-6) * size, np.floor(y0 / size + 1e-6) * size
    width, height = (max(int(np.ceil((b - a) / size - 1e-6)), 1) for a, b in ((x0, x1), (y0, y1)))
    if width * height > MAX_RESULT_PIXELS:
        raise RoadExtractionError(f"The result would have {width} by {height} pixels of {size:g} m. Give a larger pixel size, choose a lower order, "
                                  "or check the control points.")
    y1 = y0 + height * size if not _keeps_its_pixels(found) else y1
    return (float(x0), float(y1 - height * size), float(x0 + width * size), float(y1)), width, height


def _keeps_its_pixels(found):
    """Whether the image is only shifted, at its own pixel size."""
    slope = found.fit.polynomial.jacobian(np.zeros(1), np.zeros(1))[0]
    return found.settings.order == 0 and np.allclose(slope, found.pixel_size * np.array([[1, 0], [0, -1]]), rtol=1e-9, atol=1e-12)


@gdal_exceptions()
def draw_image(found: Georeferencing, path: str | Path, progress: Progress | None = None) -> float:
    """Write the image as a tiled GeoTIFF with lossless compression and overviews; the file appears when it is complete.

    Images of bytes get an alpha band. Images of larger integers get 0, and those of real numbers NaN, as no-data value, unless the image has its own.

    Parameters
    ----------
    path : of the GeoTIFF

    Returns pixels, greatest distance between the places where GDAL and the polynomial put a pixel

    Raises RoadExtractionError if the result would be too large, the image cannot be read, or the file cannot be written.
    """
    from osgeo import gdal

    progress = progress or Progress()
    bounds, width, height = output_grid(found)
    unfinished, tiled = (unfinished_path(path, suffix) for suffix in (".tif", ".source.tif"))
    source = view = result = None
    cancelled: list[bool] = []
    failure = ""
    cache = gdal.GetCacheMax()
    gdal.SetCacheMax(min(cache, GDAL_CACHE))
    try:
        source = _with_point_grid(gdal, found, _tiled(gdal, found.image, tiled, _callback(progress, 0.0, 0.1, cancelled)))
        departure = _departure(gdal, source, found) + _APPROXIMATION
        # Blocks are resampled while they are written: every tile is compressed once, and Cancel takes effect in between
        view = gdal.Warp("", source, **_warp_options(found, bounds))
        result = gdal.GetDriverByName("GTiff").CreateCopy(str(unfinished), view, options=_file_options(found.image),
                                                          callback=_callback(progress, 0.1, 0.8, cancelled))
        levels = [2**k for k in range(1, 16) if max(width, height) / 2**k >= _SMALLEST_OVERVIEW]
        result = None  # GDAL 3.6 may deadlock where it reads what its own threads still write
        if levels and not cancelled:
            result = gdal.Open(str(unfinished), gdal.GA_Update)
            result.BuildOverviews("AVERAGE", levels, callback=_callback(progress, 0.8, 1.0, cancelled))
        result = None  # closes the file
        if not cancelled:
            os.replace(unfinished, path)
            Path(f"{path}.aux.xml").unlink(missing_ok=True)
    except RuntimeError as problem:
        failure = str(problem)
    finally:
        source = view = result = None
        gdal.SetCacheMax(cache)
        for leftover in (unfinished, Path(f"{unfinished}.aux.xml"), tiled):
            leftover.unlink(missing_ok=True)
    # Raised here, because the error of GDAL would keep its datasets alive until after GDAL itself is unloaded
    if cancelled:
        raise Cancelled
    if failure:
        raise RoadExtractionError(f"The image could not be drawn to {path} ({failure}). Is {found.image.path} whole, and is there room on the disk?")
    progress.report(1.0)
    return departure


def _callback(progress, start, end, cancelled):
    """GDAL's progress as ours; Cancel is noted in `cancelled`, because GDAL has no exception for it."""
    part = progress.part(start, end)

    def tell(fraction, *_):
        try:
            part.report(fraction)
            return 1
        except Cancelled:
            cancelled.append(True)
            return 0

    return tell


def _tiled(gdal, image, path, callback):
    """The path of the image, or of a copy in tiles where it is large and stored line by line (JPEG, PNG).

    A rotated image is read across its lines, and each such read would decompress the file from its beginning.
    """
    dataset = open_raster(image.path)
    band = dataset.GetRasterBand(1)
    size = image.width * image.height * image.bands * gdal.GetDataTypeSize(band.DataType) // 8
    if size < GDAL_CACHE // 2 or band.GetBlockSize()[0] < image.width:
        return image.path
    gdal.Translate(str(path), dataset, format="GTiff", creationOptions=["TILED=YES", "BIGTIFF=IF_SAFER", "COMPRESS=LZW"], callback=callback)
    return str(path)


def _with_point_grid(gdal, found, path):
    """The image with a grid of ground control points in place of a position, as an open GDAL dataset.

    GDAL would fit its own polynomial from the map to the image, which is not the inverse of ours: in an oblique image it is
    off by tens of pixels. A dense grid of points that follow our polynomial makes it interpolate by thin-plate splines
    instead (an affine transformation needs any three of them).
    """
    area, polynomial = drawn_area(found), found.fit.polynomial
    x0, y0, x1, y1 = area.bounds
    for margin in _MARGINS:
        reach = margin * max(x1 - x0, y1 - y0)
        pixel, line = node_grid((x0 - reach, y0 - reach, x1 + reach, y1 + reach), _NODES)
        if (np.linalg.det(polynomial.jacobian(pixel, line)) < 0).all():
            break
    wkt, units = as_in_file(found.points.crs)
    easting, northing = units.in_file(np.column_stack(polynomial.to_map(pixel, line))).T
    points = [gdal.GCP(*map(float, point)) for point in zip(easting, northing, np.zeros(len(pixel)), pixel, line)]
    options = {"rgbExpand": "rgb"} if found.image.palette else {}
    return gdal.Translate("", path, format="VRT", GCPs=points, outputSRS=wkt or None, **options)


def _method(found):
    return "GCP_TPS" if found.fit.polynomial.order > 1 else "GCP_POLYNOMIAL"


def _departure(gdal, source, found):
    """Pixels between the places where GDAL's transformer and the inverse of the polynomial look for the result."""
    area = drawn_area(found)
    pixel, line = node_grid(area.bounds, 33)
    inside = shapely.contains_xy(area, pixel, line)
    pixel, line = pixel[inside], line[inside]
    easting, northing = as_in_file(found.points.crs)[1].in_file(np.column_stack(found.fit.polynomial.to_map(pixel, line))).T
    transformer = gdal.Transformer(source, None, [f"METHOD={_method(found)}"] + ["MAX_GCP_ORDER=1"] * (_method(found) != "GCP_TPS"))
    places, _ = transformer.TransformPoints(1, np.column_stack([easting, northing, np.zeros(len(pixel))]).tolist())
    return float(np.hypot(*(np.array(places)[:, :2] - np.column_stack([pixel, line])).T).max())


def _warp_options(found, bounds):
    image, size, (wkt, units) = found.image, found.pixel_size, as_in_file(found.points.crs)
    transform = {"tps": True} if _method(found) == "GCP_TPS" else {"polynomialOrder": 1}
    ends = {}
    if not image.has_alpha:
        if image.nodata is not None:
            ends = {"dstNodata": image.nodata}
        elif image.kind == "byte":
            ends = {"dstAlpha": True}
        else:
            ends = {"dstNodata": 0 if image.kind == "integer" else "nan"}
    # By default GDAL estimates the scale from the extent of each window, and blurs rotated images at their borders
    scale = min(1.0, own_pixel_size(found.fit, drawn_area(found)) / size)
    options = [f"XSCALE={scale}", f"YSCALE={scale}"]
    if found.cut:
        options.append(f"CUTLINE={shapely.to_wkt(drawn_area(found), rounding_precision=3)}")
    return {
        "format": "VRT", "outputBounds": units.geotransform(bounds, to_file=True), "xRes": size / units.across, "yRes": size / units.across,
        "resampleAlg": _ALGORITHMS[found.settings.resampling],
        "dstSRS": wkt or None, "errorThreshold": _APPROXIMATION, "warpOptions": options, **transform, **ends}


def _file_options(image):
    return ["TILED=YES", f"BLOCKXSIZE={GEOTIFF_TILE}", f"BLOCKYSIZE={GEOTIFF_TILE}", "COMPRESS=DEFLATE", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS",
            f"PREDICTOR={3 if image.kind == 'real' else 2}"]
