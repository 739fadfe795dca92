"""The mask of markings as a raster, in the pixels of the intensity image."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from os import PathLike

import numpy as np

from ...intensity.tiled_image import IntensityRaster
from ...io.geotiff import new_geotiff
from ...survey.frame.road import Road
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.records import COORDINATE_SCALE
from ...survey.store.road_points import RoadPoints
from ..objects.shape import CLOSE_ALONG, painted_cells
from ..road_grid import CELL_SIZE

BURN_BLOCK = 2048   # px: pixels are burnt in blocks of the image, so that a window in a bend reads only the blocks it touches
BURN_WINDOW = 500   # cells: 20 m of station burnt at a time

Burn = Callable[[np.ndarray, np.ndarray], None]   # burns (M,) local x, y


@contextmanager
def marking_mask(path: str | PathLike, image: IntensityRaster, origin: np.ndarray) -> Iterator[Burn]:
    """Open a byte GeoTIFF, 1 where a marking is, no data elsewhere; gives a function that burns local x, y into it.

    Parameters
    ----------
    path : of the GeoTIFF; it appears when the block is left without an error
    image : IntensityRaster whose pixels the mask has
    origin : map coordinates that local ones leave out, m
    """
    with new_geotiff(path, image.width, image.height, image.geotransform, image.crs, byte=True, nodata=0) as mask:

        def burn(x, y):
            column, row = (np.floor(c).astype(np.int64) for c in image.pixel_of(x, y, origin))
            inside = (column >= 0) & (row >= 0) & (column < image.width) & (row < image.height)
            column, row = column[inside], row[inside]
            block = row // BURN_BLOCK * (image.width // BURN_BLOCK + 1) + column // BURN_BLOCK
            for number in np.unique(block):
                c, r = column[block == number], row[block == number]
                c0, r0, width, height = int(c.min()), int(r.min()), int(np.ptp(c)) + 1, int(np.ptp(r)) + 1
                pixels = mask.read(c0, r0, width, height)
                pixels[r - r0, c - c0] = 1
                mask.write(c0, r0, pixels)

        yield burn


def pixel_centres(image: IntensityRaster, x: np.ndarray, y: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The pixels that local places lie in.

    Parameters
    ----------
    image : IntensityRaster
    x, y : (N,) local coordinates, m
    origin : map coordinates that local ones leave out, m

    Returns
    -------
    x, y : (M,) local centres of the pixels, each once
    first : (M,) index of a place in each pixel
    """
    column, row = (np.floor(c).astype(np.int64) for c in image.pixel_of(x, y, origin))
    _, first = np.unique(row * (image.width + 1) + column, return_index=True)
    left, size, _, top, _, _ = image.geotransform
    return (left - origin[0]) + (column[first] + 0.5) * size, (top - origin[1]) - (row[first] + 0.5) * size, first


def painted_pixels(cells: np.ndarray, first: tuple[int, int], image: IntensityRaster, origin: np.ndarray,
                   road: Road) -> tuple[np.ndarray, np.ndarray]:
    """The image's pixels whose centres lie in painted cells of a road.

    Parameters
    ----------
    cells : (A, B) bool in (s, d), 4 cm each
    first : cell numbers of cells[0, 0]: it begins at first * 4 cm
    image : IntensityRaster
    origin : map coordinates that local ones leave out, m
    road : Road

    Returns
    -------
    x, y : (M,) local centres of the pixels
    """
    row, column = np.nonzero(cells)
    # four places a cell: pixels may be smaller than cells and rotated against them
    quarter = np.array([[-0.25, -0.25], [-0.25, 0.25], [0.25, -0.25], [0.25, 0.25]]) * CELL_SIZE
    s = ((first[0] + row + 0.5)[:, None] * CELL_SIZE + quarter[:, 0]).ravel()
    d = ((first[1] + column + 0.5)[:, None] * CELL_SIZE + quarter[:, 1]).ravel()
    x, y = road.to_map(s, d)
    x, y, near = pixel_centres(image, x, y, origin)
    s, d = road.locate(x, y, s[near], np.inf)
    known = np.isfinite(s)
    x, y, s, d = x[known], y[known], s[known], d[known]
    row, column = (np.floor(c / CELL_SIZE).astype(np.int64) - f for c, f in ((s, first[0]), (d, first[1])))
    inside = (row >= 0) & (row < cells.shape[0]) & (column >= 0) & (column < cells.shape[1])
    inside[inside] = cells[row[inside], column[inside]]
    return x[inside], y[inside]


def burn_points(burn: Burn, points: RoadPoints, image: IntensityRaster, frame: RoadFrame) -> None:
    """Burn the cells that points lie in, gaps between scan lines closed.

    Parameters
    ----------
    burn : function given by `marking_mask`
    points : RoadPoints on paint
    image : IntensityRaster
    frame : RoadFrame
    """
    halo = int(np.ceil(CLOSE_ALONG / CELL_SIZE)) + 1
    for road in points.roads():
        start, end = points.store.span(road)
        for window in range(int(np.floor(start / CELL_SIZE / BURN_WINDOW)), int(np.ceil(end / CELL_SIZE / BURN_WINDOW))):
            first, last = window * BURN_WINDOW, (window + 1) * BURN_WINDOW
            found = points.window(road, (first - halo) * CELL_SIZE, (last + halo) * CELL_SIZE).records
            if not len(found):
                continue
            cells, corner = painted_cells(found["s"] * COORDINATE_SCALE, found["d"] * COORDINATE_SCALE)
            top, bottom = max(first - corner[0], 0), max(last - corner[0], 0)
            burn(*painted_pixels(cells[top:bottom], (corner[0] + top, corner[1]), image, frame.origin, frame.road(road)))
