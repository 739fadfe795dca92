"""White or yellow: the colour of painted areas, from coloured points or the pixels of an orthoimage in and about them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.features import Features
from ...core.common.parallel import check_cancelled
from ...core.common.progress import Progress
from ...core.common.setting import Limited, setting
from ...core.io.geotiff import GEOTIFF_TILE
from ...core.io.local_files import gdal_exceptions, open_raster, reading
from ...core.lazy import gdal
from ...core.survey.las.point_fields import valid_points
from ...core.survey.las.reader import CloudHeader, read_blocks
from .classify import Areas

WHITE, YELLOW = "white", "yellow"


@dataclass(frozen=True)
class ColourSettings(Limited):
    """How the colour of paint is told. Blue is set against the mean of red and green, in the paint and in the asphalt about it."""

    around: float = setting(0.25, 0.05, 1.0, "The width of asphalt about a marking", "m")
    # Of that ratio on asphalt, below which paint is yellow: halfway between the corners of yellow (0.43) and of white (0.82) that lie nearest each
    # other in 23 CFR 655, appendix to subpart F (daytime colours of pavement markings), as sRGB (IEC 61966-2-1)
    yellow: float = 0.63
    doubt: float = 3.0   # standard errors from there within which a colour stays open


class PaintColours:
    """Sums of colours in and about the M markings of a layer, block by block; memory does not grow with the blocks.

    markings : Features of polygons in map coordinates, none of them None
    """

    def __init__(self, markings: Features, settings: ColourSettings = ColourSettings()):
        self.settings, self.count = settings, len(markings)
        self.origin = np.floor(shapely.total_bounds(np.array(markings.geometries, object))[:2])
        self._paint, self._about = (Areas(markings, self.origin, wider) for wider in (0.0, settings.around))
        # count, blue, mean of red and green, and of the logarithm of their ratio the sum and the sum of squares, in paint and about it
        self._sums = np.zeros((2, 5, self.count))

    def add(self, places: np.ndarray, colours: np.ndarray) -> None:
        """Add N places, (N, 2) map coordinates, with their red, green and blue, (N, 3); black stands for no colour."""
        x, y = (places - self.origin).T
        seen = (colours > 0).all(axis=1)
        owner = self._about.owner(x, y, seen)
        near = np.flatnonzero(owner >= 0)
        inside = self._paint.owner(x[near], y[near], np.ones(len(near), bool))
        blue, other = colours[near, 2].astype(float), colours[near, :2].mean(axis=1)
        ratio = np.log(blue / other)
        for sums, of in ((self._sums[0], inside), (self._sums[1], np.where(inside < 0, owner[near], -1))):
            chosen = of >= 0
            for row, values in zip(sums, (np.ones(len(near)), blue, other, ratio, ratio**2)):
                row += np.bincount(of[chosen], values[chosen], self.count)

    @property
    def seen(self) -> np.ndarray:
        """(M,) int, coloured places in each marking."""
        return self._sums[0, 0].astype(int)

    def colours(self) -> np.ndarray:
        """(M,) str objects: WHITE, YELLOW, or "" where too little was seen, or the ratio is too near the limit of both."""
        (count, blue, other, ratio, square), about = self._sums
        with np.errstate(divide="ignore", invalid="ignore"):
            neutral = np.where(about[0] > 0, about[1] / about[2], about[1].sum() / about[2].sum())
            beyond = np.log(blue / other / neutral / self.settings.yellow)
            error = np.sqrt(np.maximum(square / count - (ratio / count) ** 2, 0.0) / (count - 1))
        clear = (count > 1) & (np.abs(beyond) > self.settings.doubt * error)
        return np.where(clear, np.where(beyond < 0, YELLOW, WHITE), "").astype(object)


def colours_of_lines(lines: Features, markings: Features, colours: np.ndarray) -> np.ndarray:
    """(L,) str objects: the colour in which most of the length of each line is painted, "" where its markings have none.

    lines, markings : Features of L lines and M polygons in map coordinates; colours : (M,) as `PaintColours.colours`
    """
    shapes, polygons = (shapely.force_2d(np.array(layer.geometries, object)) for layer in (lines, markings))
    line, polygon = shapely.STRtree(polygons).query(shapes, predicate="intersects")
    length = shapely.length(shapely.intersection(shapes[line], polygons[polygon]))
    painted = {colour: np.bincount(line, np.where(colours[polygon] == colour, length, 0.0), len(lines)) for colour in (WHITE, YELLOW)}
    named = np.where(painted[YELLOW] > painted[WHITE], YELLOW, WHITE)
    return np.where(painted[YELLOW] + painted[WHITE] > 0, named, "").astype(object)


def add_points(colours: PaintColours, files: list[CloudHeader], progress: Progress = Progress()) -> None:
    """Add the valid points of coloured files. RoadExtractionError where a file has no colours, or cannot be read."""
    grey = next((file for file in files if file.count and not file.has_colour), None)
    if grey is not None:
        raise RoadExtractionError(f"The points of {grey.path} have no colours (point format {grey.point_format}). Export them with red, green and "
                                  "blue, or give an orthoimage.")
    done, total = 0, sum(file.count for file in files)
    for file in files:
        for points in read_blocks(file.path, layers=("rgb", "flags", "classification"), units=file.units):
            valid = valid_points(points)
            rows = slice(None) if valid is None else valid
            places, seen = (np.stack([np.asarray(points[name]) for name in names], axis=1)[rows] for names in (("x", "y"), ("red", "green", "blue")))
            colours.add(places, seen)
            done += len(points)
            progress.report(done / total)


def add_pixels(colours: PaintColours, path: str, markings: Features, progress: Progress = Progress()) -> None:
    """Add the pixels of an orthoimage in the CRS of the markings. RoadExtractionError where it has no position, or fewer than three bands."""
    boxes = shapely.STRtree(shapely.box(*shapely.bounds(np.array(markings.geometries, object)).T))
    tiles = _tiles(path)
    for k, (window, box) in enumerate(tiles):
        check_cancelled()
        if len(boxes.query(box)):
            colours.add(*_pixels(path, window))
        progress.report((k + 1) / len(tiles))


@gdal_exceptions()
def _tiles(path):
    """[(window, box)] of an image: column, row, width and height in pixels, and the shapely polygon that they cover on the map."""
    image = open_raster(path)
    transform = image.GetGeoTransform(can_return_null=True)
    if transform is None or image.RasterCount < 3:
        raise RoadExtractionError(f"{path} has no position or fewer than three bands, so it shows no colours on the map. Give an orthoimage with "
                                  "red, green and blue; Georeference image places one.")
    result = []
    for row in range(0, image.RasterYSize, GEOTIFF_TILE):
        for column in range(0, image.RasterXSize, GEOTIFF_TILE):
            window = column, row, min(GEOTIFF_TILE, image.RasterXSize - column), min(GEOTIFF_TILE, image.RasterYSize - row)
            corners = [gdal.ApplyGeoTransform(transform, column + u * window[2], row + v * window[3]) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
            result.append((window, shapely.Polygon(corners)))
    return result


@gdal_exceptions()
def _pixels(path, window):
    """Middles of the pixels of a window on the map, (N, 2), and their colours, (N, 3); those that the image leaves out are left out."""
    image = open_raster(path)
    with reading(path):
        bands = [image.GetRasterBand(number).ReadAsArray(*window) for number in (1, 2, 3)]
        shown = image.GetRasterBand(1).GetMaskBand().ReadAsArray(*window) > 0
    row, column = np.nonzero(shown)
    x0, xc, xr, y0, yc, yr = image.GetGeoTransform()
    u, v = window[0] + column + 0.5, window[1] + row + 0.5
    return np.stack([x0 + xc * u + xr * v, y0 + yc * u + yr * v], axis=1), np.stack([band[shown] for band in bands], axis=1)
