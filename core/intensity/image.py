"""The geo-referenced intensity image: inverse distance weighting in which bright points weigh more."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import nullcontext
from os import PathLike

import numpy as np

from ..common.arrays import quantiles
from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..execution.phase import Phase
from ..io.geotiff import GEOTIFF_TILE, NODATA, new_geotiff
from ..survey.store.records import COORDINATE_SCALE, Points
from ..survey.store.road_points import RoadPoints
from .idw import ImageSettings, WeightedSums, interpolation_sums, lattice_cell, reach_of
from .tiled_image import TILE_MEMORY, TiledImage

RANKING_WINDOW = 20.0   # m of station over which intensities are ranked for the brightness rule
PIECES_PER_WINDOW = 4   # pieces of a window, each interpolated at once: 5 m of road
LOOKED_WINDOWS = 8      # windows of 20 m that a worker process looks at together: a tenth of a second of its time
PIECES_PER_TASK = 8     # pieces that a worker process is given together: at everyday density a tenth of a second of its time
MAX_TILES = 2**24       # of an image, most of them empty: GDAL keeps 16 bytes of each
FAR_POINTS_PER_CELL = 3     # with twice as many, an evenly spread share of the points weighs on cells farther than the next
WIDTH_SAMPLE_STEP = 16      # the width of a piece is taken from every 16th point
MAX_RANKED_POINTS = 50_000  # points of a piece whose intensities are ranked; of twice as many an evenly spread share
TILES_AHEAD = 16        # the sums of a piece are kept while they are needed again within so many tiles

PieceKey = tuple[int, int]      # road, number of the piece along it
Extent = tuple[int, int, int, int]   # first and last column, first and last row of the lattice


def make_intensity_image(road_points: RoadPoints, settings: ImageSettings = ImageSettings(), progress: Progress = Progress(),
                         path: str | PathLike | None = None, memory_limit: int = TILE_MEMORY) -> TiledImage:
    """Interpolate the intensity of road points into an image that can be read at once, and into a GeoTIFF where a path is given.

    Parameters
    ----------
    road_points : RoadPoints
    settings : ImageSettings
    progress : Progress
    path : of the GeoTIFF, the same pixels as `write_intensity_image` writes; None for no file
    memory_limit : bytes of pixels kept in memory; the others go to a temporary file, and all where other processes work on the points

    Returns
    -------
    TiledImage, which `extract_markings` reads like an IntensityImage

    Raises
    ------
    RoadExtractionError
        If there are no points, the image has too many tiles, or the file cannot be written.
    """
    grid, tiles = _interpolate(road_points, settings, progress)
    image = TiledImage(grid.geotransform, grid.width, grid.height, road_points.crs, memory_limit, road_points.executor.folder)
    with new_geotiff(path, grid.width, grid.height, grid.geotransform, road_points.crs) if path else nullcontext() as file:
        for column, row, values in tiles:
            image.put(column, row, values)
            if file is not None:
                file.write(column, row, values)
                file.flush()
    progress.info(grid.summary)
    return image


def write_intensity_image(road_points: RoadPoints, path: str | PathLike, settings: ImageSettings = ImageSettings(),
                          progress: Progress = Progress()) -> None:
    """Interpolate the intensity of road points into a float32 GeoTIFF.

    The value G of a cell follows two rules [1]_: a nearer point weighs more, and a brighter one::

        G = sum(w I) / sum(w),  w = (1 - beta + beta * b) / (distance + 1 mm)**power
        b = clip((I - P1) / (P99 - P1), 0, 1)

    P1 and P99 are percentiles over 20 m of road. Where a cell holds six points or more, an evenly
    spread share of at least three per cell stands for all of them on cells farther than the next.
    The corrected intensity is used where there is one. Cells are multiples of the cell size in map
    coordinates, so images of one place lie cell on cell. A cell without a point within the
    radius has no data.

    Parameters
    ----------
    road_points : RoadPoints
    path : of the GeoTIFF; it appears when it is complete
    settings : ImageSettings
    progress : Progress

    Raises
    ------
    RoadExtractionError
        If there are no points, the image has too many tiles, or the file cannot be written.

    Notes
    -----
    With `beta` above 0 bright edges grow by up to half a cell: take widths and
    centre lines from the points.

    References
    ----------
    .. [1] Guan et al. (2014), ISPRS J. Photogramm. Remote Sens. 87, 93-107: the two rules.
    """
    grid, tiles = _interpolate(road_points, settings, progress)
    with new_geotiff(path, grid.width, grid.height, grid.geotransform, road_points.crs) as file:
        for column, row, values in tiles:
            file.write(column, row, values)
            # compressed by another thread while the next tiles are made
            file.flush()
    progress.info(grid.summary)


def check_fits(width: float, height: float, settings: ImageSettings) -> None:
    """Refuse an image that would have too many tiles for one file.

    Parameters
    ----------
    width, height : m, east and north
    settings : ImageSettings

    Raises
    ------
    RoadExtractionError
        If it has more than 2**24 tiles.
    """
    side = GEOTIFF_TILE * settings.cell_size
    if np.ceil(width / side) * np.ceil(height / side) > MAX_TILES:
        raise RoadExtractionError(
            f"The road points span {width / 1000:.1f} by {height / 1000:.1f} km, "
            f"too far for an image with {settings.cell_size} m cells. Use a larger cell size, or split the survey.")


def _interpolate(road_points: RoadPoints, settings: ImageSettings, progress: Progress) -> tuple[_Grid, Iterator[tuple[int, int, np.ndarray]]]:
    """The grid of the image, and a generator of (column, row, (H, W) float32) of every tile with data, in the order of the road."""
    if not len(road_points):
        raise RoadExtractionError("There are no road points to make an intensity image of. Check the road surface first.")
    windows = [(road, k) for road in road_points.roads() for k in _window_numbers(road_points, road)]
    together = LOOKED_WINDOWS if road_points.executor.folder else 1
    phase = Phase(windows_of_image, road_points, (settings,), lambda some: _place(road_points, some[0], RANKING_WINDOW))
    tasks = [windows[k:k + together] for k in range(0, len(windows), together)]
    found = [one for some in road_points.executor.run(phase, tasks, progress.part(0.0, 0.3)) for one in some]
    extents = {piece: extent for _, window_extents, _ in found for piece, extent in window_extents.items()}
    steps = {piece: step for *_, window_steps in found for piece, step in window_steps.items()}
    # the grid is fixed in the map: pixel column = column of the map's lattice minus the first one
    c0, c1 = min(e[0] for e in extents.values()), max(e[1] for e in extents.values()) + 1
    r0, r1 = min(e[2] for e in extents.values()), max(e[3] for e in extents.values()) + 1
    check_fits((c1 - c0) * settings.cell_size, (r1 - r0) * settings.cell_size, settings)
    grid = _Grid(settings, c0, r1 - 1, c1 - c0, r1 - r0)
    limits = {window: limits for window, (limits, *_) in zip(windows, found)}
    pieces_of_tile: dict[tuple[int, int], list[PieceKey]] = {}
    for piece, extent in sorted(extents.items()):
        for tile in grid.tiles_of(extent):
            pieces_of_tile.setdefault(tile, []).append(piece)
    # in the order of the road, so that a tile finds most of its pieces still there
    work = sorted(pieces_of_tile.items(), key=lambda item: (item[1][0], item[0]))

    def sums(pieces: list[PieceKey]) -> Iterator[WeightedSums]:
        executor = road_points.executor
        items = [(piece, steps[piece], limits[piece[0], piece[1] // PIECES_PER_WINDOW]) for piece in pieces]
        together = PIECES_PER_TASK if executor.folder else 1
        phase = Phase(sums_of_pieces, road_points, (settings,), lambda some: _place(road_points, some[0][0], RANKING_WINDOW / PIECES_PER_WINDOW))
        tasks = [items[k:k + together] for k in range(0, len(items), together)]
        return (found for some in executor.run(phase, tasks, progress.part(0.3, 1.0)) for found in some)

    def tiles() -> Iterator[tuple[int, int, np.ndarray]]:
        for (column, row), parts in _with_pieces(work, sums):
            values = grid.tile(column, row, parts)
            if values is not None:
                yield column * GEOTIFF_TILE, row * GEOTIFF_TILE, values

    return grid, tiles()


def _window_numbers(road_points, road):
    start, end = road_points.store.span(road)
    return range(int(np.floor(start / RANKING_WINDOW)), int(np.ceil(end / RANKING_WINDOW)))


def _place(road_points, key, length):
    """What messages call a window or piece."""
    road, number = key
    return road_points.survey.stretch(road, number * length, (number + 1) * length)


def windows_of_image(road_points: RoadPoints, windows: Sequence[tuple[int, int]],
                     settings: ImageSettings) -> list[tuple[tuple[float, ...], dict[PieceKey, Extent], dict[PieceKey, int]]]:
    """The phase that looks what there is to interpolate in some windows.

    Parameters
    ----------
    road_points : RoadPoints
    windows : road and number along it of each
    settings : ImageSettings

    Returns
    -------
    of each window:
    limits : 1 % and 99 % of its intensities
    extents : {piece: Extent} of its pieces
    steps : {piece: n}, one of n points of a piece weighs on farther cells
    """
    return [_look_at(road_points, *window, settings) for window in windows]


def _look_at(road_points, road, number, settings):
    """What `windows_of_image` returns of one window."""
    reach = reach_of(settings)
    extents: dict[PieceKey, Extent] = {}
    steps: dict[PieceKey, int] = {}
    values = []
    for piece in range(number * PIECES_PER_WINDOW, (number + 1) * PIECES_PER_WINDOW):
        points = _points_of(road_points, (road, piece))
        if len(points):
            steps[road, piece] = _sampling_step(points, settings)
            (c0, c1), (r0, r1) = ([int(lattice_cell(int(end), o, settings.cell_size)) for end in (c.min(), c.max())]
                                  for c, o in ((points.records[name], o) for name, o in zip("xy", road_points.origin)))
            extents[road, piece] = c0 - reach, c1 + reach, r0 - reach, r1 + reach
            values.append(points[::max(steps[road, piece], len(points) // MAX_RANKED_POINTS)].value)
    return tuple(quantiles(np.concatenate(values), [0.01, 0.99]).tolist()) if values else (0.0, 1.0), extents, steps


def _points_of(road_points, piece):
    """The points of one piece, 5 m of road."""
    road, number = piece
    length = RANKING_WINDOW / PIECES_PER_WINDOW
    return road_points.window(road, number * length, (number + 1) * length)


def _sampling_step(points: Points, settings: ImageSettings) -> int:
    """n, where one of n points of a piece weighs on cells farther than the next, for all n.

    Points in the order of station and offset are evenly spread: one of n leaves FAR_POINTS_PER_CELL in a cell.
    """
    d = points[::WIDTH_SAMPLE_STEP].records["d"]
    width = max((int(d.max()) - int(d.min())) * COORDINATE_SCALE, settings.cell_size)
    return max(int(len(points) * settings.cell_size**2 / (RANKING_WINDOW / PIECES_PER_WINDOW * width) / FAR_POINTS_PER_CELL), 1)


def sums_of_pieces(road_points: RoadPoints, items: list[tuple[PieceKey, int, tuple[float, float]]], settings: ImageSettings) -> list[WeightedSums]:
    """The phase that interpolates pieces.

    Parameters
    ----------
    road_points : RoadPoints
    items : of each the piece, one of how many of its points weighs on farther cells, and 1 % and 99 % of the intensities about it
    settings : ImageSettings
    """
    return [_sums_of_piece(road_points, *item, settings) for item in items]


def _sums_of_piece(road_points, piece, step, limits, settings):
    low, high = limits

    def brightness(value):
        found = value - np.float32(low)
        found /= np.float32(max(high - low, 1e-9))
        np.maximum(found, np.float32(0.0), out=found)
        np.minimum(found, np.float32(1.0), out=found)
        found *= np.float32(settings.beta)
        found += np.float32(1.0 - settings.beta)
        return found

    return interpolation_sums(_points_of(road_points, piece), brightness, road_points.origin, settings, step)


def _with_pieces(work: list[tuple[tuple[int, int], list[PieceKey]]],
                 sums: Callable[[list[PieceKey]], Iterator[WeightedSums]]) -> Iterator[tuple[tuple[int, int], list[WeightedSums]]]:
    """Yield (tile, WeightedSums of its pieces) in order; `sums` are those of pieces, in their order.

    A piece is kept for the tiles that follow soon, and computed again for those that
    follow late, such as the ones that another road crosses.
    """
    uses: dict[PieceKey, list[int]] = {}
    for k, (_, pieces) in enumerate(work):
        for piece in pieces:
            uses.setdefault(piece, []).append(k)
    made: list[list[PieceKey]] = [[] for _ in work]
    done: list[list[PieceKey]] = [[] for _ in work]
    for piece, tiles in uses.items():
        cuts = np.flatnonzero(np.diff(tiles) > TILES_AHEAD)
        for first, last in zip(np.r_[0, cuts + 1], np.r_[cuts, len(tiles) - 1]):
            made[tiles[first]].append(piece)
            done[tiles[last]].append(piece)
    results = sums([piece for pieces in made for piece in pieces])
    kept: dict[PieceKey, WeightedSums] = {}
    for k, (tile, pieces) in enumerate(work):
        kept.update((piece, next(results)) for piece in made[k])
        yield tile, [kept[piece] for piece in pieces]
        for piece in done[k]:
            del kept[piece]


class _Grid:
    """The image's place in the map's lattice: `column` is its westernmost, `row` its northernmost one."""

    def __init__(self, settings: ImageSettings, column: int, row: int, width: int, height: int):
        self.cell = settings.cell_size
        self.column, self.row, self.width, self.height = column, row, width, height

    @property
    def geotransform(self) -> tuple[float, ...]:
        return self.column * self.cell, self.cell, 0.0, (self.row + 1) * self.cell, 0.0, -self.cell

    @property
    def summary(self) -> str:
        return f"Intensity image: {self.width:,} x {self.height:,} cells of {self.cell:g} m."

    def tiles_of(self, extent: Extent) -> list[tuple[int, int]]:
        """(column, row) of every tile that an extent touches."""
        c0, c1, r0, r1 = extent
        return [(column, row) for column in range((c0 - self.column) // GEOTIFF_TILE, (c1 - self.column) // GEOTIFF_TILE + 1)
                for row in range((self.row - r1) // GEOTIFF_TILE, (self.row - r0) // GEOTIFF_TILE + 1)]

    def tile(self, column: int, row: int, parts: Iterable[WeightedSums]) -> np.ndarray | None:
        """(height, width) float32 of one tile, from the sums that touch it; None where it has no data."""
        shape = min(GEOTIFF_TILE, self.height - row * GEOTIFF_TILE), min(GEOTIFF_TILE, self.width - column * GEOTIFF_TILE)
        whole = WeightedSums(self.column + column * GEOTIFF_TILE, self.row - row * GEOTIFF_TILE, *np.zeros((2, *shape), np.float32))
        for part in parts:
            part.add_to(whole)
        seen = whole.weights > 0
        return np.divide(whole.total, whole.weights, out=np.full(shape, np.float32(NODATA)), where=seen) if seen.any() else None
