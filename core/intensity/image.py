"""The geo-referenced intensity image: inverse distance, and bright points count more."""

from dataclasses import dataclass

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.order_statistics import quantiles
from ..common.parallel import ordered_map
from ..common.progress import Progress
from ..common.setting import check_limits, setting
from ..io.geotiff import GEOTIFF_TILE, NODATA, IntensityImage, new_geotiff, write_display_image
from ..survey.store.records import COORDINATE_SCALE
from .idw import Sums, interpolation_sums, lattice_cell, reach_of

__all__ = ["ImageSettings", "IntensityImage", "write_intensity_image", "write_display_image"]

WINDOW = 20.0          # m of station over which intensities are ranked for the second rule
MOST_TILES = 2**24     # of an image, most of them empty: GDAL keeps 16 bytes of each
PIECES = 4             # pieces of a window, each interpolated at a time
MOST = 3               # points of a cell: where there are twice as many, an even share of them weighs on cells farther than the next
WIDTH_TOLD = 16        # points, of which one tells how wide they lie
RANKED = 50_000        # points of a piece whose intensities are ranked: where there are twice as many, evenly strewn ones
AHEAD = 16             # tiles for which a piece is kept


@dataclass(frozen=True)
class ImageSettings:
    """How the image is interpolated.

    cell_size : m; paint of 0.15 m survives at 0.04
    power : of the distance
    beta : share of the weight that follows brightness; 0 is plain inverse distance
    radius_cells : how far a point reaches, in cells
    """

    cell_size: float = setting(0.04, 0.005, 10.0, "The cell size", "m")
    power: float = setting(2.0, 0.1, 10.0, "The power of the distance")
    beta: float = setting(0.5, 0.0, 1.0, "The weight of brightness")
    radius_cells: float = setting(2.0, 0.71, 10.0, "The search radius", "cells")

    def __post_init__(self):
        check_limits(self)


def write_intensity_image(road_points, path, settings=ImageSettings(), progress=Progress()):
    """Interpolate the intensity of road points into a float32 GeoTIFF.

    A cell's value follows two rules [1]_: a nearer point counts more, and a brighter one::

        G = sum(w I) / sum(w),  w = (1 - beta + beta * b) / (distance + 1 mm)**power
        b = clip((I - P1) / (P99 - P1), 0, 1)

    with P1 and P99 of 20 m of road. Where points crowd, with six or more to a cell, an evenly strewn
    share of them stands for all on cells farther away than the next: three or more a cell. The corrected intensity is used where there
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
    if not len(road_points):
        raise RoadExtractionError("There are no road points to make an intensity image of. Check the road surface first.")
    # The grid is fixed in the map: pixel column = column of the map's lattice minus the first one
    windows = [(road, k) for road in road_points.roads() for k in _window_numbers(road_points, road)]
    found = list(ordered_map(lambda window: _survey_window(road_points, window, settings), windows, progress.part(0.0, 0.3)))
    pieces = {piece: extent for _, extents, _ in found for piece, extent in extents.items()}
    steps = {piece: step for *_, steps in found for piece, step in steps.items()}
    c0, c1 = min(e[0] for e in pieces.values()), max(e[1] for e in pieces.values()) + 1
    r0, r1 = min(e[2] for e in pieces.values()), max(e[3] for e in pieces.values()) + 1
    check_fits((c1 - c0) * settings.cell_size, (r1 - r0) * settings.cell_size, settings)
    grid = _Grid(settings, c0, r1 - 1, c1 - c0, r1 - r0)
    limits = {window: limits for window, (limits, *_) in zip(windows, found)}
    tiles = {}
    for piece, extent in sorted(pieces.items()):
        for tile in grid.tiles_of(extent):
            tiles.setdefault(tile, []).append(piece)
    # in the order of the road, so that a tile finds most of its pieces still there
    work = sorted(tiles.items(), key=lambda item: (item[1][0], item[0]))

    def sums(piece):
        return _piece_sums(road_points, piece, steps[piece], limits[piece[0], piece[1] // PIECES], settings)

    with new_geotiff(path, grid.width, grid.height, grid.transform, road_points.crs) as image:
        for (column, row), parts in _with_pieces(work, sums, progress.part(0.3, 1.0)):
            values = grid.tile(column, row, parts)
            if values is not None:
                image.write(column * GEOTIFF_TILE, row * GEOTIFF_TILE, values)
                # compressed by another thread while the next tiles are made
                image.flush()
    progress.info(f"Intensity image: {grid.width:,} x {grid.height:,} cells of {settings.cell_size:g} m.")


def check_fits(width, height, settings):
    """Refuse an image of so many metres east and north that has too many tiles for one file.

    Raises
    ------
    RoadExtractionError
    """
    side = GEOTIFF_TILE * settings.cell_size
    if np.ceil(width / side) * np.ceil(height / side) > MOST_TILES:
        raise RoadExtractionError(
            f"The road points span {width / 1000:.1f} by {height / 1000:.1f} km, "
            f"too far for an image with {settings.cell_size} m cells. Use a larger cell size, or split the survey.")


def _window_numbers(road_points, road):
    start, end = road_points.store.span(road)
    return range(int(np.floor(start / WINDOW)), int(np.ceil(end / WINDOW)))


def _survey_window(road_points, window, settings):
    """(P1, P99) of a window's points; of each of its pieces the extent (first and last column, first and last row), and `_step`."""
    road, number = window
    reach, extents, steps, values = reach_of(settings), {}, {}, []
    for piece in range(number * PIECES, (number + 1) * PIECES):
        points = _points_of(road_points, (road, piece))
        if len(points):
            steps[road, piece] = _step(points, settings)
            (c0, c1), (r0, r1) = ([int(lattice_cell(int(end), o, settings.cell_size)) for end in (c.min(), c.max())]
                                  for c, o in ((points.records[name], o) for name, o in zip("xy", road_points.origin)))
            extents[road, piece] = c0 - reach, c1 + reach, r0 - reach, r1 + reach
            values.append(points[::max(steps[road, piece], len(points) // RANKED)].value)
    return tuple(quantiles(np.concatenate(values), [0.01, 0.99])) if values else (0.0, 1.0), extents, steps


def _points_of(road_points, piece):
    """The points of one piece, 5 m of road."""
    road, number = piece
    length = WINDOW / PIECES
    return road_points.window(road, number * length, (number + 1) * length)


def _step(points, settings):
    """Of how many points of a piece one weighs on cells farther than the next, and stands for the others there.

    Where they crowd these are evenly strewn: one of so many in the order of station and offset that a cell has MOST of them.
    """
    d = points[::WIDTH_TOLD].records["d"]
    width = max((int(d.max()) - int(d.min())) * COORDINATE_SCALE, settings.cell_size)
    return max(int(len(points) * settings.cell_size**2 / (WINDOW / PIECES * width) / MOST), 1)


def _piece_sums(road_points, piece, step, limits, settings):
    """Sums of one piece, with its `_step`."""
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


def _with_pieces(work, sums, progress):
    """Yield (tile, list of the Sums of its pieces) in order; pieces are computed by several threads.

    A piece is kept for the tiles that follow soon, and computed again for those that
    follow late, such as the ones that another road crosses.
    """
    uses = {}
    for k, (_, pieces) in enumerate(work):
        for piece in pieces:
            uses.setdefault(piece, []).append(k)
    made, done = [[] for _ in work], [[] for _ in work]
    for piece, tiles in uses.items():
        cuts = np.flatnonzero(np.diff(tiles) > AHEAD)
        for first, last in zip(np.r_[0, cuts + 1], np.r_[cuts, len(tiles) - 1]):
            made[tiles[first]].append(piece)
            done[tiles[last]].append(piece)
    results = ordered_map(sums, [piece for pieces in made for piece in pieces], progress)
    kept = {}
    for k, (tile, pieces) in enumerate(work):
        kept.update((piece, next(results)) for piece in made[k])
        yield tile, [kept[piece] for piece in pieces]
        for piece in done[k]:
            del kept[piece]


class _Grid:
    """The image's place in the map's lattice; `row` is the northernmost row of it."""

    def __init__(self, settings, column, row, width, height):
        self.cell = settings.cell_size
        self.column, self.row, self.width, self.height = column, row, width, height

    @property
    def transform(self):
        return self.column * self.cell, self.cell, 0.0, (self.row + 1) * self.cell, 0.0, -self.cell

    def tiles_of(self, extent):
        """(column, row) of every tile that an extent touches."""
        c0, c1, r0, r1 = extent
        return [(column, row) for column in range((c0 - self.column) // GEOTIFF_TILE, (c1 - self.column) // GEOTIFF_TILE + 1)
                for row in range((self.row - r1) // GEOTIFF_TILE, (self.row - r0) // GEOTIFF_TILE + 1)]

    def tile(self, column, row, parts):
        """(height, width) float32 of one tile, from the Sums that touch it; None where nothing is."""
        shape = min(GEOTIFF_TILE, self.height - row * GEOTIFF_TILE), min(GEOTIFF_TILE, self.width - column * GEOTIFF_TILE)
        whole = Sums(self.column + column * GEOTIFF_TILE, self.row - row * GEOTIFF_TILE, np.zeros(shape, np.float32), np.zeros(shape, np.float32))
        for part in parts:
            part.add_to(whole)
        seen = whole.weights > 0
        return np.divide(whole.total, whole.weights, out=np.full(shape, np.float32(NODATA)), where=seen) if seen.any() else None
