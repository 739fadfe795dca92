"""The geo-referenced intensity image: inverse distance, and bright points count more."""

import threading
from collections import OrderedDict
from dataclasses import dataclass

import numpy as np

from ..errors import RoadExtractionError
from ..parallel import in_order
from ..progress import Progress
from ..survey.points import UNIT
from .intensity_raster import NODATA, TILE, IntensityImage, new_geotiff, write_display_image
from .interpolation import InCells, interpolation_sums, reach_of

__all__ = ["ImageSettings", "IntensityImage", "write_intensity_image", "write_display_image"]

WINDOW = 20.0          # m of station over which intensities are ranked for the second rule
LARGEST = 2_000_000    # px, side of an image: beyond it a coordinate is wrong
KEPT = 2_000_000       # points of prepared windows kept: neighbouring tiles ask for them again


@dataclass(frozen=True)
class ImageSettings:
    """How the image is interpolated.

    cell_size : m; paint of 0.15 m survives at 0.04
    power : of the distance
    beta : share of the weight that follows brightness; 0 is plain inverse distance
    radius_cells : how far a point reaches, in cells
    """

    cell_size: float = 0.04
    power: float = 2.0
    beta: float = 0.5
    radius_cells: float = 2.0

    def __post_init__(self):
        if not 0.005 <= self.cell_size <= 10.0:
            raise RoadExtractionError(f"The cell size is {self.cell_size} m; it must be between 0.005 and 10 m.")
        if not 0.0 < self.power <= 10.0:
            raise RoadExtractionError(f"The power of the distance is {self.power}; it must be above 0 and at most 10.")
        if not 0.0 <= self.beta <= 1.0:
            raise RoadExtractionError(f"The weight of brightness is {self.beta}; it must be between 0 and 1.")
        if not 0.71 <= self.radius_cells <= 10.0:
            raise RoadExtractionError(f"The search radius is {self.radius_cells} cells; it must be between 0.71 and 10 cells.")


def write_intensity_image(road_points, path, settings=ImageSettings(), progress=Progress()):
    """Interpolate the intensity of road points into a float32 GeoTIFF.

    A cell's value follows two rules [1]_: a nearer point counts more, and a brighter one::

        G = sum(w I) / sum(w),  w = (1 - beta + beta * b) / (distance + 1 mm)**power
        b = clip((I - P1) / (P99 - P1), 0, 1)

    with P1 and P99 of 20 m of road. The corrected intensity is used where there
    is one. Cells are multiples of the cell size in map coordinates, so images
    of one place lie cell on cell; a cell with no point in the radius is no data.

    Parameters
    ----------
    road_points : RoadPoints
    path : of the GeoTIFF; it appears when it is complete

    Raises
    ------
    RoadExtractionError
        If there are no points, or the file cannot be written.

    Notes
    -----
    With `beta` above 0 bright edges grow by up to half a cell: take widths and
    centre lines from the points.

    References
    ----------
    .. [1] Guan et al. (2014), ISPRS J. Photogramm. Remote Sens. 87, 93-107: the two rules.
    """
    from osgeo import gdal

    if not len(road_points):
        raise RoadExtractionError("There are no road points to make an intensity image of. Check the road surface first.")
    # The grid is fixed in the map: pixel column = column of the map's lattice minus the first one
    windows = [(road, k) for road in road_points.roads() for k in _window_numbers(road_points, road)]
    found = list(in_order(lambda window: _survey_window(road_points, window, settings), windows, progress.part(0.0, 0.3)))
    extents = [extent for _, extent, _ in found if extent is not None]
    c0, c1 = min(e[0] for e in extents), max(e[1] for e in extents) + 1
    r0, r1 = min(e[2] for e in extents), max(e[3] for e in extents) + 1
    if max(c1 - c0, r1 - r0) > LARGEST:
        raise RoadExtractionError(
            f"The road points span {(c1 - c0) * settings.cell_size / 1000:.1f} by {(r1 - r0) * settings.cell_size / 1000:.1f} km, "
            f"too far for an image with {settings.cell_size} m cells. Use a larger cell size, or split the survey.")
    grid = _Grid(settings, road_points.origin, c0, r1 - 1, c1 - c0, r1 - r0)
    ranks = {window: limits for window, (limits, _, _) in zip(windows, found)}
    tiles = {}
    for window, (_, _, touched) in zip(windows, found):
        for tile in np.unique(np.c_[(touched[:, 0] - grid.column) // TILE, (grid.row - touched[:, 1]) // TILE], axis=0).tolist() \
                if len(touched) else []:
            tiles.setdefault(tuple(tile), []).append(window)
    reader = _Windows(road_points, ranks)
    # in the order of the road, so that a tile finds its windows still prepared
    work = sorted(tiles.items(), key=lambda item: (item[1][0], item[0]))
    transform = (grid.column * settings.cell_size, settings.cell_size, 0.0,
                 (grid.row + 1) * settings.cell_size, 0.0, -settings.cell_size)
    with new_geotiff(path, grid.width, grid.height, transform, road_points.crs) as dataset:
        band = dataset.GetRasterBand(1)
        done = in_order(lambda item: (item[0], grid.tile(item[0], reader, item[1])), work, progress.part(0.3, 1.0))
        for (column, row), values in done:
            height, width = values.shape
            if (values != np.float32(NODATA)).any():
                band.WriteRaster(column * TILE, row * TILE, width, height, values.tobytes(), buf_type=gdal.GDT_Float32)
    progress.say(f"Intensity image: {grid.width:,} x {grid.height:,} cells of {settings.cell_size:g} m.")


def _window_numbers(road_points, road):
    start, end = road_points.store.span(road)
    return range(int(np.floor(start / WINDOW)), int(np.ceil(end / WINDOW)))


def _window_points(road_points, window):
    road, number = window
    return road_points.window(road, number * WINDOW, (number + 1) * WINDOW)


def _survey_window(road_points, window, settings):
    """(P1, P99), the extent in map cells and one map cell per (64 px)² touched, of a window's points."""
    points = _window_points(road_points, window)
    if not len(points):
        return (0.0, 1.0), None, np.empty((0, 2), np.int64)
    reach = reach_of(settings)
    column, row = _map_cells(points, road_points.origin, settings.cell_size)
    corners = 64 * _each_once(column >> 6, row >> 6)
    # a block of 64 px, widened by the reach, can touch the tiles its corners lie in
    touched = np.concatenate([corners + np.array([dx, dy]) for dx in (-reach, 63 + reach) for dy in (-reach, 63 + reach)])
    extent = (int(column.min()) - reach, int(column.max()) + reach, int(row.min()) - reach, int(row.max()) + reach)
    touched = np.clip(touched, [extent[0], extent[2]], [extent[1], extent[3]])
    return tuple(np.percentile(points.value, [1.0, 99.0])), extent, np.unique(touched, axis=0)


def _each_once(column, row):
    """(M, 2) the different pairs of column and row, in order."""
    low = np.array([column.min(), row.min()])
    shape = column.max() - low[0] + 1, row.max() - low[1] + 1
    seen = np.zeros(shape, bool)
    seen[column - low[0], row - low[1]] = True
    return np.argwhere(seen) + low


def _map_cells(points, origin, cell):
    """Column (eastward) and row (northward) of the map's lattice of cells."""
    return (np.floor((points.x + origin[0]) / cell).astype(np.int64),
            np.floor((points.y + origin[1]) / cell).astype(np.int64))


class _Windows:
    """Windows made ready for weighting: x, y (0.1 mm), value and brightness weight; the last used are kept."""

    def __init__(self, road_points, ranks):
        self.road_points, self.ranks = road_points, ranks
        self._kept, self._count, self._lock = OrderedDict(), 0, threading.Lock()
        self._turns = [threading.Lock() for _ in range(16)]  # a window is made ready by one thread while others wait

    def get(self, window, beta):
        with self._turns[hash(window) % len(self._turns)]:
            with self._lock:
                if window in self._kept:
                    self._kept.move_to_end(window)
                    return self._kept[window]
            return self._made_ready(window, beta)

    def _made_ready(self, window, beta):
        points = _window_points(self.road_points, window)
        value = points.value
        low, high = self.ranks[window]
        brightness = np.clip((value - np.float32(low)) / np.float32(max(high - low, 1e-9)), 0.0, 1.0)
        ready = points.records["x"], points.records["y"], value, np.float32(1.0 - beta) + np.float32(beta) * brightness
        with self._lock:
            self._kept[window] = ready
            self._count += len(value)
            while self._count > KEPT and len(self._kept) > 1:
                self._count -= len(self._kept.popitem(last=False)[1][2])
        return ready


class _Grid:
    """The image's place in the map's lattice; `row` is the northernmost row of it."""

    def __init__(self, settings, origin, column, row, width, height):
        self.settings, self.origin = settings, origin
        self.column, self.row, self.width, self.height = column, row, width, height

    def tile(self, tile, reader, windows):
        """(height, width) float32 of one tile, interpolated from the windows that touch it."""
        cell, reach = self.settings.cell_size, reach_of(self.settings)
        first_column, first_row = tile[0] * TILE, tile[1] * TILE
        width, height = min(TILE, self.width - first_column), min(TILE, self.height - first_row)
        left = (self.column + first_column) * cell - self.origin[0]
        top = (self.row + 1 - first_row) * cell - self.origin[1]
        parts = []
        for window in windows:
            x, y, value, weight = reader.get(window, self.settings.beta)
            low = np.floor((np.array([left, top]) - np.array([reach, height + reach]) * cell) / UNIT) - 1
            high = np.ceil((np.array([left, top]) + np.array([width + reach, reach]) * cell) / UNIT) + 1
            near = np.flatnonzero((x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1]))
            u, v = (x[near] * UNIT - left) / cell, (top - y[near] * UNIT) / cell
            inside = (u >= -reach) & (v >= -reach) & (u < width + reach) & (v < height + reach)
            if not inside.all():
                near, u, v = near[inside], u[inside], v[inside]
            parts.append((InCells.of(u, v, width, self.settings), value[near], weight[near]))
        points, value, weight = zip(*parts)
        total, weights = interpolation_sums(InCells.joined(points), np.concatenate(value), np.concatenate(weight),
                                            width, height, self.settings)
        with np.errstate(invalid="ignore"):
            return np.where(weights > 0, total / weights, NODATA).astype(np.float32)
