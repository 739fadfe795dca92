"""The geo-referenced intensity image: inverse distance weighting in which bright points weigh more."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import lru_cache
from os import PathLike
from typing import Any

import numpy as np
from scipy import sparse

from ..common.arrays import order_by
from ..common.errors import RoadExtractionError
from ..common.parallel import ScratchBuffers, check_cancelled
from ..common.progress import Progress
from ..common.setting import Limited, setting
from ..curves.robust import percentiles
from ..execution.in_step import Asked, Work, in_step
from ..execution.phase import THREADS, Phase, digest
from ..io.geotiff import GEOTIFF_TILE, NODATA, IntensityImage
from ..lazy import cv2
from ..survey.consistency import sample_road_points
from ..survey.frame.road_frame import RoadFrame
from ..survey.store.array_file import SharedArrays
from ..survey.store.records import COORDINATE_SCALE, Points
from ..survey.store.road_points import RoadPoints
from .tiled_image import StoredTile, TiledImage, stored_tiles
from .weights import IMAGE

# Inverse distance weighting on the map's lattice of cells: every point weighs on all cells within the search radius.

# cost: multiplications of a matrix product; OpenBLAS starts threads for more than 2**18, which wait for each other where all cores are busy
PRODUCTS_AT_ONCE = 1 << 18


Extent = tuple[int, int, int, int]   # first and last column, first and last row of the lattice


@dataclass(frozen=True)
class ImageSettings(Limited):
    cell_size: float = setting(0.04, 0.005, 10.0, "The cell size", "m")   # m; paint of 0.15 m survives at 0.04
    power: float = setting(2.0, 0.1, 10.0, "The power of the distance")   # of the distance
    beta: float = setting(0.5, 0.0, 1.0, "The weight of brightness")   # share of the weight that follows brightness; 0 is plain inverse distance
    radius_cells: float = setting(2.0, 0.71, 10.0, "The search radius", "cells")   # search radius, in cells


@dataclass
class _WeightedSums:
    """Sums of weights and of weighted values on a rectangle of cells."""

    column: int   # column, row: of the lattice (eastward, northward) of the north-western cell
    row: int
    total: np.ndarray   # total, weights: (rows, columns) float32, weighted values and weights; both 0 where no point is within the radius
    weights: np.ndarray

    def add_to(self, other: _WeightedSums) -> None:
        height, width = self.total.shape
        down, right = other.row - self.row, self.column - other.column
        r0, r1 = max(-down, 0), min(other.total.shape[0] - down, height)
        c0, c1 = max(-right, 0), min(other.total.shape[1] - right, width)
        if r0 < r1 and c0 < c1:
            window = slice(r0 + down, r1 + down), slice(c0 + right, c1 + right)
            other.total[window] += self.total[r0:r1, c0:c1]
            other.weights[window] += self.weights[r0:r1, c0:c1]


def _extent_of(points: Points, origin: np.ndarray, settings: ImageSettings) -> Extent:
    """The Extent of the cells that points reach; origin : as of `_interpolation_sums`."""
    reach = int(np.ceil(settings.radius_cells))
    (left, right), (bottom, top) = ([int(np.floor((int(end) * COORDINATE_SCALE + o) / settings.cell_size)) for end in (c.min(), c.max())]
                                    for c, o in ((points.records[name], o) for name, o in zip("xy", origin)))
    return left - reach, right + reach, bottom - reach, top + reach


def _interpolation_sums(points: Points, brightness: Callable[[np.ndarray], np.ndarray], origin: np.ndarray, settings: ImageSettings,
                        step: int = 1) -> _WeightedSums:
    """Sums of weights and of weighted values per cell of a rectangle that holds all cells within reach.

    Points are taken in blocks and sorted by cell. What the points of one cell add to its neighbours is then one row of a matrix product. Weights
    and sums are in single precision, far finer than intensities are. A cell and a half away or farther, weights are so small that a share of the
    points gives the same result.

    points : Points, at least one
    brightness : function of (N,) float32 intensities that returns (N,) float32 factors of the points' weights
    origin : (2,) or more, map coordinates that x and y of the points leave out, m
    step : one of `step` points stands for all of them on cells farther than the next
    """
    x, y, values, cell = points.records["x"], points.records["y"], points.value, settings.cell_size
    left, right, bottom, top = _extent_of(points, origin, settings)
    width, height = right + 1 - left, top + 1 - bottom
    sums = np.zeros(width * height, np.complex64)   # weights and weighted values, which are added to the same cells
    whole, near, far = _kernels(settings)
    at_once = near.at_once if step > 1 else whole.at_once
    for first in range(0, len(x), at_once):
        run = slice(first, first + at_once)
        (column, east), (row, north) = _in_cell(x[run], origin[0], cell), _in_cell(y[run], origin[1], cell)
        number = ((top - row) * width + (column - left)).astype(np.int32)
        rows = order_by(number)
        value = values[run].take(rows)
        number, east, north, weight = number.take(rows), east.take(rows), north.take(rows), brightness(value)
        if step == 1:
            whole.add(sums, width, number, east, north, value, weight)
            continue
        near.add(sums, width, number, east, north, value, weight)
        one_in_step = np.zeros(len(rows), bool)
        one_in_step[-first % step::step] = True
        share = np.flatnonzero(one_in_step.take(rows))
        if len(share) and far.offsets:
            number, east, north, value, weight = (column.take(share) for column in (number, east, north, value, weight))
            far.add(sums, width, number, east, north, value, weight * np.float32(step))
    sums = sums.reshape(height, width)
    return _WeightedSums(left, top, sums.imag, sums.real)


def _in_cell(units, origin, cell_size):
    """The cell that coordinates lie in, (N,) whole float64, and how far from its middle, (N,) float32 in cells."""
    position = (units * COORDINATE_SCALE + origin) / cell_size
    cell = np.floor(position)
    # subtracted in double precision
    position -= cell
    position -= 0.5
    return cell, position.astype(np.float32)


@lru_cache(maxsize=1)
def _kernels(settings: ImageSettings) -> list[_Kernel]:
    """The kernels of all cells around a point, of the nearest nine, and of those beyond; several threads may use them."""
    reach = int(np.ceil(settings.radius_cells))
    offsets = [(right, up) for up in range(-reach, reach + 1) for right in range(-reach, reach + 1)
               if np.hypot(max(abs(right) - 0.5, 0), max(abs(up) - 0.5, 0)) < settings.radius_cells]
    near = [offset for offset in offsets if max(map(abs, offset)) <= 1]
    return [_Kernel(settings, cells) for cells in (offsets, near, [offset for offset in offsets if offset not in near])]


class _Kernel:
    """Weights of points on the cells around their own.

    offsets : (K) (right, up) of the cells
    at_once : points that are computed at a time
    """

    def __init__(self, settings: ImageSettings, offsets: list[tuple[int, int]]):
        self.settings, self.offsets = settings, offsets
        self.at_once = max(IMAGE.distances_at_once // max(len(offsets), 1), 1)
        self.rows_at_once = max(PRODUCTS_AT_ONCE // (4 * max(len(offsets), 1)), 1)
        self._kept = ScratchBuffers()   # reused: new memory costs page faults
        right, up = np.array(offsets, np.float32).reshape(-1, 2).T
        # squared distances as a product: (e - r)^2 + (n - u)^2 = (e^2 + n^2) 1 - 2 e r - 2 n u + 1 (r^2 + u^2)
        self._squares = np.stack([np.ones_like(right), -2 * right, -2 * up, right**2 + up**2])

    def add(self, sums, width, number, east, north, value, weight):
        """Add points to complex sums of a lattice `width` cells wide; `number` are the cells they lie in, ascending."""
        starts = np.flatnonzero(np.r_[True, number[1:] != number[:-1]])
        runs = sparse.csr_matrix((weight, np.arange(len(number), dtype=np.int32), np.append(starts, len(number)).astype(np.int32)),
                                 shape=(len(starts), len(number)))
        weights = self.weights(east, north)
        # by cell of the neighbourhood, weights and weighted values side by side, as they are added
        size, kept = (len(self.offsets), len(starts)), self._kept.of(len(starts) * len(self.offsets))
        sums_of_runs = []
        for name, factor in (("weights", None), ("values", value)):
            if factor is not None:
                runs.data = weight * factor
            sums_of_runs.append(cv2.transpose(runs @ weights, kept(name, np.float32).reshape(size)))
        added = cv2.merge(sums_of_runs, self._kept.of(2 * len(starts) * len(self.offsets))("added", np.float32).reshape(*size, 2))
        target = number[starts].astype(np.intp)
        for (right, up), contribution in zip(self.offsets, added.view(np.complex64)[:, :, 0]):
            sums[target + (right - up * width)] += contribution

    def weights(self, east: np.ndarray, north: np.ndarray) -> np.ndarray:
        """(N, K) float32 weights by distance alone, of points at places in their own cells; valid until the next call."""
        coordinates = self._kept.of(4 * len(east))("own", np.float32).reshape(-1, 4)
        coordinates[:, 0] = east * east + north * north
        coordinates[:, 1], coordinates[:, 2], coordinates[:, 3] = east, north, 1.0
        weights = self._kept.of(len(east) * len(self.offsets))("found", np.float32).reshape(len(east), -1)
        farthest = self._weight(np.full(1, self.settings.radius_cells * self.settings.cell_size + IMAGE.distance_offset, np.float32))
        for first in range(0, len(east), self.rows_at_once):
            rows = weights[first:first + self.rows_at_once]
            cv2.gemm(coordinates[first:first + self.rows_at_once], self._squares, 1.0, None, 0.0, rows)
            cv2.sqrt(rows, rows)
            rows *= np.float32(self.settings.cell_size)
            rows += np.float32(IMAGE.distance_offset)
            self._weight(rows)
            cv2.threshold(rows, float(farthest[0]) * (1 - IMAGE.radius_rounding), 0.0, cv2.THRESH_TOZERO, rows)
        return weights

    def _weight(self, distance):
        """1 / distance^power, in place."""
        if self.settings.power == 2.0:
            distance *= distance
        else:
            np.power(distance, np.float32(self.settings.power), out=distance)
        return np.divide(np.float32(1.0), distance, out=distance)


MAX_TILES = 2**24       # source: of an image, most of them empty: GDAL keeps 16 bytes of each

PIECE_LENGTH = IMAGE.ranking_window / IMAGE.pieces_per_window
Tile = tuple[int, int]   # column and row of tiles


@dataclass(frozen=True)
class _Piece:
    """A piece of road that is interpolated at once."""

    road: int   # road, number: of the road, and of the piece along it
    number: int
    extent: Extent   # Extent of the cells that its points reach
    across: tuple[int, int]   # least and greatest offset of its points, units of 0.1 mm
    step: int   # one of so many points weighs on farther cells

    @property
    def window(self) -> tuple[int, int]:
        """The road and the number along it of the window whose intensities it is compared with."""
        return self.road, self.number // IMAGE.pieces_per_window


def make_intensity_image(road_points: RoadPoints, settings: ImageSettings = ImageSettings(), progress: Progress = Progress(),
                         path: str | PathLike | None = None, before: TiledImage | None = None,
                         pieces: Sequence[_Piece] | None = None) -> TiledImage:
    """Interpolate the intensity of road points into an image, to be read at once like an IntensityImage.

    The value G of a cell follows two rules [1]_: a nearer point weighs more, and a brighter one::

        G = sum(w I) / sum(w),  w = (1 - beta + beta * b) / (distance + 1 mm)**power
        b = clip((I - P1) / (P99 - P1), 0, 1)

    P1 and P99 are percentiles over 20 m of road. Where a cell holds six points or more, an evenly spread share of at least three per cell stands for
    all of them on cells farther than the next. The corrected intensity is used where there is one. Cells are multiples of the cell size in map
    coordinates, so images of one place lie cell on cell. A cell without a point within the radius has no data.

    path : of a float32 GeoTIFF that is written too, and appears when it is complete; None for none
    before : image of other points of the survey, whose tiles are taken over where they are the same; it is of no use any more
    pieces : result of `pieces_of_image`, which an earlier stage looked for; None to look here

    Raises RoadExtractionError if there are no points, the image has too many tiles, or the file cannot be written.

    With `beta` above 0 bright edges grow by up to half a cell: take widths and centre lines from the points.

    .. [1] Guan et al. (2014), ISPRS J. Photogramm. Remote Sens. 87, 93-107: the two rules.
    """
    if pieces is None:
        pieces, = in_step([pieces_of_image(road_points, settings)], road_points.executor, progress.part(0.0, 0.3))
    grid, work = _grid_of(pieces, settings)
    image = TiledImage(grid.geotransform, grid.width, grid.height, road_points.crs, SharedArrays(road_points.executor.folder))
    states = {window: road_points.state(*_span(IMAGE.ranking_window, *window)) for window in dict.fromkeys(piece.window for piece in pieces)}
    image.pieces = {piece: digest((settings, piece, states[piece.window])) for piece in pieces}   # most touch several tiles
    image.places = np.array([(piece.road, piece.number, *piece.extent, *piece.across) for piece in image.pieces], np.int64)
    image.states = {tile: digest((grid.shape_of(*tile), [image.pieces[piece] for piece in pieces])) for tile, pieces in work}
    if before is not None:
        image.take_over(before)
    new = [(tile, pieces) for tile, pieces in work if before is None or before.states.get(tile) != image.states[tile]]
    with image.new_file(path, before) if path else nullcontext() as file:
        # a few are made before workers would have started
        executor = THREADS if 2 * len(new) < len(work) else road_points.executor
        tasks = [new[k:k + IMAGE.tiles_per_task] for k in range(0, len(new), IMAGE.tiles_per_task)]
        phase = Phase(tiles_of_image, road_points, (settings, grid, image.arrays), lambda task: road_points.survey.stretch(
            *_span(PIECE_LENGTH, task[0][1][0].road, task[0][1][0].number)),
                      state=(lambda task: [image.states[tile] for tile, _ in task]) if executor.folder else None)   # in memory lie the pixels already
        for tiles in executor.run(phase, tasks, progress.part(0.3, 1.0)):
            image.add(tiles)
            if file is not None:
                for column, row, height, width, place in tiles:
                    pixels = image.arrays.get(place, (height, width))
                    file.write(column, row, np.where(np.isnan(pixels), np.float32(NODATA), pixels), whole=True)
    progress.info(f"Intensity image: {grid.width:,} x {grid.height:,} cells of {grid.cell:g} m.")
    return image


def check_fits(width: float, height: float, settings: ImageSettings) -> None:
    """Refuse an image of so many metres east and north that would have too many tiles for one file (2**24)."""
    side = GEOTIFF_TILE * settings.cell_size
    if np.ceil(width / side) * np.ceil(height / side) > MAX_TILES:
        raise RoadExtractionError(f"The road points span {width / 1000:.1f} by {height / 1000:.1f} km, too far for an image with "
                                  f"{settings.cell_size} m cells. Use a larger cell size, or split the survey.")


def pieces_of_image(road_points: RoadPoints, settings: ImageSettings) -> Work:
    """The work that looks what there is to interpolate: the pieces of road with points. Intensities may be corrected later."""
    spans = [(road, *(end / IMAGE.ranking_window for end in road_points.store.span(road))) for road in road_points.roads()]
    windows = [(road, k) for road, start, end in spans for k in range(int(np.floor(start)), int(np.ceil(end)))]
    phase = Phase(windows_of_image, road_points, (settings,), lambda task: road_points.survey.stretch(*_span(IMAGE.ranking_window, *task[0])),
                  state=lambda task: [road_points.state(*_span(IMAGE.ranking_window, *window)) for window in task], listed=IMAGE.looked_windows)
    return (yield Asked(phase, windows, 1.0, list))


def _grid_of(pieces: Sequence[_Piece], settings: ImageSettings) -> tuple[_Grid, list[tuple[Tile, list[_Piece]]]]:
    """The grid of the image, and the pieces of road that touch each tile."""
    if not pieces:
        raise RoadExtractionError("There are no road points to make an intensity image of. Check the road surface first.")
    # the grid is fixed in the map: pixel column = column of the map's lattice minus the first one
    extents = np.array([piece.extent for piece in pieces], np.int64)
    (c0, r0), (c1, r1) = extents[:, ::2].min(axis=0).tolist(), (extents[:, 1::2].max(axis=0) + 1).tolist()
    check_fits((c1 - c0) * settings.cell_size, (r1 - r0) * settings.cell_size, settings)
    grid = _Grid(settings, c0, r1 - 1, c1 - c0, r1 - r0)
    pieces_of_tile: dict[Tile, list[_Piece]] = {}
    for piece in sorted(pieces, key=lambda piece: (piece.road, piece.number)):
        for tile in grid.tiles_of(piece.extent):
            pieces_of_tile.setdefault(tile, []).append(piece)
    # in the order of the road, so that a tile finds most of its pieces still there
    return grid, sorted(pieces_of_tile.items(), key=lambda item: (item[1][0].road, item[1][0].number, item[0]))


def _span(length, road, number):
    """A road, and the stations between which a window or a piece lies by its number."""
    return road, number * length, (number + 1) * length


def windows_of_image(road_points: RoadPoints, windows: Sequence[tuple[int, int]], settings: ImageSettings) -> list[list[_Piece]]:
    """The phase that looks what there is to interpolate in some windows, each a road and a number along it: the pieces with points of each."""
    result = []
    for road, number in windows:
        pieces = []
        for piece, points in _filled_pieces(road_points, road, number):
            d = points.records["d"]
            pieces.append(_Piece(road, piece, _extent_of(points, road_points.origin, settings), (int(d.min()), int(d.max())),
                                 _sampling_step(points, settings)))
        result.append(pieces)
    return result


def _limits_of_window(road_points, road, number, settings):
    """1 % and 99 % of the intensities of a window with points."""
    values = [points[::max(_sampling_step(points, settings), len(points) // IMAGE.max_ranked_points)].value
              for _, points in _filled_pieces(road_points, road, number)]
    return percentiles(np.concatenate(values), (1, 99))


def _filled_pieces(road_points, road, number):
    """(number, Points) of the pieces of a window that have points."""
    pieces = range(number * IMAGE.pieces_per_window, (number + 1) * IMAGE.pieces_per_window)
    return ((piece, points) for piece in pieces if len(points := road_points.window(*_span(PIECE_LENGTH, road, piece))))


def _sampling_step(points: Points, settings: ImageSettings) -> int:
    """n, where one of n points of a piece weighs on cells farther than the next, for all n.

    Points in the order of station and offset are evenly spread: one of n leaves `far_points_per_cell` in a cell.
    """
    d = points[::IMAGE.width_sample_step].records["d"]
    width = max((int(d.max()) - int(d.min())) * COORDINATE_SCALE, settings.cell_size)
    return max(int(len(points) * settings.cell_size**2 / (PIECE_LENGTH * width) / IMAGE.far_points_per_cell), 1)


def tiles_of_image(road_points: RoadPoints, tiles: list[tuple[Tile, list[_Piece]]], settings: ImageSettings, grid: _Grid,
                   arrays: SharedArrays) -> list[StoredTile]:
    """The phase that makes tiles and writes those with data; a piece that some of them share is interpolated once."""
    sums: dict[_Piece, _WeightedSums] = {}
    limits: dict[tuple[int, int], list[float]] = {}
    result = []
    for tile, pieces in tiles:
        check_cancelled()
        for piece in pieces:
            if piece.window not in limits:
                limits[piece.window] = _limits_of_window(road_points, *piece.window, settings)
            if piece not in sums:
                sums[piece] = _sums_of_piece(road_points, piece, settings, *limits[piece.window])
        result.append(grid.tile(*tile, [sums[piece] for piece in pieces]))
    return stored_tiles(arrays, result)


def _sums_of_piece(road_points, piece, settings, low, high):
    def brightness(value):
        share = np.clip((value - np.float32(low)) / np.float32(max(high - low, 1e-9)), np.float32(0.0), np.float32(1.0))
        return share * np.float32(settings.beta) + np.float32(1.0 - settings.beta)

    points = road_points.window(*_span(PIECE_LENGTH, piece.road, piece.number))
    return _interpolation_sums(points, brightness, road_points.origin, settings, piece.step)


class _Grid:
    """The image's place in the map's lattice: `column` is its westernmost, `row` its northernmost one."""

    def __init__(self, settings: ImageSettings, column: int, row: int, width: int, height: int):
        self.cell = settings.cell_size
        self.column, self.row, self.width, self.height = column, row, width, height

    @property
    def geotransform(self) -> tuple[float, ...]:
        return self.column * self.cell, self.cell, 0.0, (self.row + 1) * self.cell, 0.0, -self.cell

    def tiles_of(self, extent: Extent) -> list[Tile]:
        """(column, row) of every tile that an extent touches."""
        c0, c1, r0, r1 = extent
        return [(column, row) for column in range((c0 - self.column) // GEOTIFF_TILE, (c1 - self.column) // GEOTIFF_TILE + 1)
                for row in range((self.row - r1) // GEOTIFF_TILE, (self.row - r0) // GEOTIFF_TILE + 1)]

    def shape_of(self, column: int, row: int) -> tuple[int, int]:
        """Height and width of one tile."""
        return min(GEOTIFF_TILE, self.height - row * GEOTIFF_TILE), min(GEOTIFF_TILE, self.width - column * GEOTIFF_TILE)

    def tile(self, column: int, row: int, parts: Iterable[_WeightedSums]) -> tuple[int, int, np.ndarray]:
        """First column and row of one tile, and its pixels from the sums that touch it."""
        shape = self.shape_of(column, row)
        whole = _WeightedSums(self.column + column * GEOTIFF_TILE, self.row - row * GEOTIFF_TILE, *np.zeros((2, *shape), np.float32))
        for part in parts:
            part.add_to(whole)
        return column * GEOTIFF_TILE, row * GEOTIFF_TILE, np.divide(
            whole.total, whole.weights, out=np.full(shape, np.float32(NODATA)), where=whole.weights > 0)


def state_about(image: TiledImage, frame: RoadFrame, road: int, start: float, end: float) -> list[Any]:
    """Plain values that differ where the points of a road between two stations (m), or the image of `make_intensity_image` about them, are others."""
    roads, numbers, c_first, c_last, r_first, r_last, low, high = image.places.T
    inside = (roads == road) & (start < (numbers + 1) * PIECE_LENGTH) & (numbers * PIECE_LENGTH < end)
    if not inside.any():
        return []
    s, margin = np.arange(start, end + IMAGE.state_margin, IMAGE.state_margin), int(np.ceil(IMAGE.state_margin / image.cell_size))
    sides = [frame.road(road).to_map(s, d * COORDINATE_SCALE) for d in (low[inside].min(), high[inside].max())]
    (c0, c1), (r0, r1) = ([int(np.floor((end + o) / image.cell_size)) for end in (np.min(c), np.max(c))] for c, o in zip(zip(*sides), frame.origin))
    about = (c_first <= c1 + margin) & (c_last >= c0 - margin) & (r_first <= r1 + margin) & (r_last >= r0 - margin)
    digests = list(image.pieces.values())
    return [list(image.geotransform), *(digests[k] for k in np.flatnonzero(inside | about).tolist())]


# Whether an intensity image shows the road points it is used with.


def check_image_shows(image: IntensityImage, road_points: RoadPoints) -> None:
    """Refuse an image of another road, and the 8-bit picture for viewing.

    Raises RoadExtractionError if fewer than half of the sample_road_points road points lie on pixels with a value, or the image is of 8 bits.
    """
    if image.eight_bit:
        raise RoadExtractionError(
            f"{image.path} is the 8-bit picture for viewing; its grey values are stretched and cut off. Give the intensity image itself.")
    places = [(x, y) for _, x, y, *_ in sample_road_points(road_points)]
    if not places:
        return
    x, y = (np.concatenate(part) for part in zip(*places))
    share = np.isfinite(image.sample(x, y)).mean()
    if share < IMAGE.min_shown_share:
        left, size, _, top, _, _ = image.geotransform
        raise RoadExtractionError(
            f"{image.path} does not show these road points, of which {100 * share:.0f} % lie on it. It covers x {left:.1f} to "
            f"{left + size * image.width:.1f} and y {top - size * image.height:.1f} to {top:.1f}. Give the image made from these points.")
