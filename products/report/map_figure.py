"""A small map as a picture: a grey raster with lines and polygons over it.

For reports only; a map to print is made by QGIS. Drawn by OpenCV, which the core needs anyway: matplotlib takes three times as long
for such a picture and seconds to load. Colours are blue, green, red, as OpenCV takes them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from ...core.io.crs import NO_PLACE, place_of_raster
from ...core.io.geotiff import GEOTIFF_TILE, filled_tiles
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.lazy import cv2

MAP_LONGEST_SIDE = 1800      # px
MAX_AVERAGED_SIDE = 500_000  # px; GDAL averages rasters up to this size, empty tiles included; larger ones are read by tile
MAP_MARGIN = 3.0             # m around the layers

# What is drawn, from the bottom up: layer, condition (field, value) or None, colour, width (px), filled
MAP_STYLE = (
    ("markings", None, (80, 220, 255), 1, True),
    ("edges", ("status", "measured"), (60, 60, 230), 3, False),
    ("edges", ("status", "bridged"), (60, 150, 255), 3, False),
    ("differences", None, (255, 60, 230), 7, False),
    ("marking_lines", None, (230, 200, 60), 2, False),
    ("driving_lines", ("status", "measured"), (90, 220, 60), 3, False),
    ("driving_lines", ("status", "bridged"), (60, 255, 190), 3, False),
    ("driving_lines", ("status", "inferred"), (220, 120, 200), 3, False),
)


@gdal_exceptions()
def grey_background(path: str, longest: int = MAP_LONGEST_SIDE) -> tuple[np.ndarray, tuple[float, float, float, float]]:
    """((H, W) uint8 grey, 0 where there is no data; its (min x, min y, max x, max y)) of a raster file, small, with stretched contrast."""
    from osgeo import gdal

    dataset = open_raster(path)
    width, height = dataset.RasterXSize, dataset.RasterYSize
    scale = min(1.0, longest / max(width, height))
    columns, rows = max(int(width * scale), 1), max(int(height * scale), 1)
    band = dataset.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    if max(width, height) > MAX_AVERAGED_SIDE:
        values = _averaged(dataset, columns, rows, nodata)
    else:
        data = band.ReadRaster(0, 0, width, height, columns, rows, gdal.GDT_Float32, resample_alg=gdal.GRIORA_Average)
        values = np.frombuffer(data, np.float32).reshape(rows, columns)
    empty = ~np.isfinite(values)
    if nodata is not None and np.isfinite(nodata):
        empty |= values == np.float32(nodata)
    x0, dx, _, y0, _, dy = place_of_raster(dataset)[0] or NO_PLACE
    extent = (x0, y0 + dy * height, x0 + dx * width, y0)
    grey = np.zeros(values.shape, np.uint8)
    if not empty.all():
        low, high = np.percentile(values[~empty], [1, 99.5])
        stretched = 1 + 254 * np.clip((values - low) / max(high - low, 1e-9), 0, 1)
        grey = np.where(empty, 0, np.nan_to_num(stretched)).astype(np.uint8)
    return grey, extent


def _averaged(dataset, columns, rows, nodata):
    """(rows, columns) means of the values of a raster, read tile by tile; NaN where there are none."""
    from osgeo import gdal

    band, width, height = dataset.GetRasterBand(1), dataset.RasterXSize, dataset.RasterYSize
    total, count = np.zeros((2, rows, columns))
    for left, top in filled_tiles(dataset):
        size = min(GEOTIFF_TILE, width - left), min(GEOTIFF_TILE, height - top)
        values = np.frombuffer(band.ReadRaster(left, top, *size, buf_type=gdal.GDT_Float32), np.float32).reshape(size[::-1])
        filled = np.isfinite(values) if nodata is None else np.isfinite(values) & (values != np.float32(nodata))
        column, row = (np.arange(first, first + n) * few // many for first, n, few, many in
                       ((left, size[0], columns, width), (top, size[1], rows, height)))
        window = slice(row[0], row[-1] + 1), slice(column[0], column[-1] + 1)
        cells = total[window].shape
        cell = ((row - row[0])[:, None] * cells[1] + (column - column[0]))[filled]
        total[window] += np.bincount(cell, values[filled], cells[0] * cells[1]).reshape(cells)
        count[window] += np.bincount(cell, minlength=cells[0] * cells[1]).reshape(cells)
    return np.divide(total, count, out=np.full((rows, columns), np.nan), where=count > 0)


def draw_map(layers: Mapping[str, Any], background: tuple[np.ndarray, Sequence[float]] | None = None, bounds: Sequence[float] | None = None,
             longest: int = MAP_LONGEST_SIDE, style: Sequence[tuple[Any, ...]] = MAP_STYLE, paper: int = 28) -> np.ndarray | None:
    """(H, W, 3) uint8 picture of layers over an image, None if there is nothing to draw.

    layers : Features by the names in `style`, which is like MAP_STYLE; missing ones are left out
    background : (grey image (H, W) uint8 with 0 where empty, (min x, min y, max x, max y)) or None
    bounds : (min x, min y, max x, max y); by default those of the layers with a margin of 3 m
    longest : pixels of the longer side
    paper : grey level where neither a layer nor the image covers the map
    """
    shapes = [g for features in layers.values() if features is not None for g in features.geometries if g is not None]
    if bounds is None:
        if not shapes:
            return None
        bounds = shapely.total_bounds(np.array(shapes, object)) + MAP_MARGIN * np.array([-1, -1, 1, 1])
    scale = longest / max(bounds[2] - bounds[0], bounds[3] - bounds[1])
    width, height = (max(int(np.ceil(side * scale)), 2) for side in (bounds[2] - bounds[0], bounds[3] - bounds[1]))
    canvas = np.full((height, width, 3), paper, np.uint8)
    if background is not None:
        _paste(canvas, *background, bounds, scale)
    for name, rule, colour, thickness, filled in style:
        for geometry, row in layers.get(name) or ():
            if geometry is not None and (rule is None or row.get(rule[0]) == rule[1]):
                _draw(canvas, geometry, bounds, scale, colour, thickness, filled)
    return canvas


def _paste(canvas, grey, extent, bounds, scale):
    """Put an image where it belongs on the canvas."""
    height, width = canvas.shape[:2]
    column = (bounds[0] + (np.arange(width) + 0.5) / scale - extent[0]) / (extent[2] - extent[0]) * grey.shape[1]
    row = (extent[3] - bounds[3] + (np.arange(height) + 0.5) / scale) / (extent[3] - extent[1]) * grey.shape[0]
    column_inside, row_inside = (column >= 0) & (column < grey.shape[1]), (row >= 0) & (row < grey.shape[0])
    part = grey[np.ix_(row[row_inside].astype(int), column[column_inside].astype(int))]
    target = canvas[np.ix_(row_inside, column_inside)]
    canvas[np.ix_(row_inside, column_inside)] = np.where(part[..., None] > 0, part[..., None], target)


def _draw(canvas, geometry, bounds, scale, colour, thickness, filled):
    shift = 4  # bits of sub-pixel position
    for part in getattr(geometry, "geoms", [geometry]):
        rings = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
        drawn = []
        for ring in rings:
            xy = shapely.get_coordinates(ring)
            xy = np.c_[(xy[:, 0] - bounds[0]) * scale, (bounds[3] - xy[:, 1]) * scale]
            drawn.append(np.rint(xy * 2**shift).astype(np.int32))
        if filled:
            cv2.fillPoly(canvas, drawn, colour, cv2.LINE_AA, shift)
        else:
            cv2.polylines(canvas, drawn, part.geom_type == "Polygon", colour, thickness, cv2.LINE_AA, shift)
