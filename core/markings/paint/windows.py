"""Paint in windows of 20 m along a road: the level of asphalt of each, the cells that are brighter, the points on these, and the mask.

Every window is worked on by itself, with some metres of road before and behind it. The image is resampled in the road frame, so that a bend is
straight.
"""

from __future__ import annotations

from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ...curves.robust import median
from ...execution.phase import Recipe
from ...intensity.image import state_about
from ...intensity.scatter import WINDOW_UNITS, windows_of
from ...io.geotiff import IntensityImage, new_geotiff
from ...survey.frame.road import Road
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import SectionStore, StoreIndex
from ..objects.shape import painted_cells
from ..road_grid import CELL_SIZE, CELL_UNITS, PieceOfRoad, RoadCells, RoadGrid, cell_numbers, cells_of_road
from ..weights import ASPHALT, SHAPES
from .asphalt_level import asphalt_bins, asphalt_profile, bin_edges, dark_cells, flatten, threshold_profile
from .noisy import CellAverages, ViewSamples, noisy_paint_cells, views
from .not_paint import RimBands, clear_pieces, edge_distance, raised_cells, rim_distance, track_spacing, two_sided
from .photographs import bright_spots
from .settings import MarkingSettings

THRESHOLD_WINDOW = WINDOW_UNITS // CELL_UNITS   # derived: cells: thresholds are taken from 20 m of road
WINDOW_HALO = 100   # derived: cells: 4 m around a window that are read too, for asphalt, rims and runs that cross its ends
MAX_HEIGHTS = 30_000   # derived: points of a piece of 5 m whose heights are compared; of twice as many an evenly spread share
MAX_OFFSET_POINTS = 300_000   # derived: points of a window whose offsets are kept; of twice as many an evenly spread share



def points_of_rows(road_points: RoadPoints, road: int, first: int, last: int) -> Points:
    """Points of the rows of cells from `first` to before `last`."""
    return road_points.window(road, first * CELL_UNITS * COORDINATE_SCALE, last * CELL_UNITS * COORDINATE_SCALE)


class PaintSource:
    """What paint is extracted from in one phase, and where it goes.

    road_points, image : RoadPoints, and their image in memory or on disk
    frame : RoadFrame, None for that of the survey
    folder : of the store of paint, see SectionStore
    """

    def __init__(self, road_points: RoadPoints, image: Any, frame: RoadFrame | None = None, folder: str | Path | None = None):
        self.road_points, self.image, self.frame = road_points, image, frame or road_points.survey.frame
        self.paint = SectionStore(road_points.store.dtype, road_points.store.section_length, Path(folder) if folder else None)

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open points and image."""
        return Recipe("core.markings.paint.windows:PaintSource", dict(
            road_points=self.road_points.recipe(folder), image=self.image.recipe(folder), folder=str(self.paint.folder)))

    def state(self, item: tuple[int, int]) -> list[Any]:
        """What paint in a window depends on: the road and its image there, and in the halo."""
        road, window = item
        rows = window * THRESHOLD_WINDOW - WINDOW_HALO, (window + 1) * THRESHOLD_WINDOW + WINDOW_HALO
        return state_about(self.image, self.frame, road, *(row * CELL_UNITS * COORDINATE_SCALE for row in rows))


def paint_of_window(source: PaintSource, item: tuple[int, int], settings: MarkingSettings,
                    noisy: dict[int, list[int]], photographed: bool) -> StoreIndex:
    """The phase that extracts paint; returns where its points lie in a part of the store of paint.

    `item` : number of a road and of a window; `noisy` : {road: windows with noisy points, in which paint is searched for in averages};
    `photographed` : whether brightness is that of photographs.
    """
    road, window = item
    records = _Window(source, road, window).extract(settings, window in noisy.get(road, ()), photographed)
    with source.paint.part() as part:
        part.append(road, records)
    return part.index()


class _Window:
    """One window of a road and its halo, in cells."""

    def __init__(self, source: PaintSource, road: int, number: int) -> None:
        self.source, self.road = source, road
        self.begin, self.end = number * THRESHOLD_WINDOW, (number + 1) * THRESHOLD_WINDOW
        self.first, self.last = self.begin - WINDOW_HALO, self.end + WINDOW_HALO

    def _points(self, first, last):
        return points_of_rows(self.source.road_points, self.road, first, last)

    def extract(self, settings: MarkingSettings, noisy: bool, photographed: bool) -> Columns:
        """Paint of the window itself."""
        step = max(len(self._points(self.first, self.last)) // MAX_OFFSET_POINTS, 1)
        parts = cells_of_road(self.source.road_points, self.road, self.first, self.last, step)
        parts_within = [part for part in parts if self.begin <= part.grid.first and part.grid.last <= self.end]
        cells = RoadCells.of(parts, self.first, self.last)
        if cells is None or not parts_within:
            return Columns.concatenate([], self.source.road_points.store.dtype)
        mask, least = self._from_averages(cells) if noisy else self._from_image(parts, cells, settings, photographed)
        return self._paint_in(parts_within, cells, mask, least)

    def _from_image(self, parts, cells, settings, photographed):
        """Cells of paint by thresholds on the image, and the brightness that points on them have at least."""
        brightness = cells.grid.read(self.source.image, self.source.frame, self.road)
        scanned, from_rim = np.isfinite(brightness), rim_distance(cells.occupied)
        if not scanned[WINDOW_HALO:WINDOW_HALO + THRESHOLD_WINDOW].any():
            return np.zeros(cells.grid.shape, bool), None
        rims = [RimBands.of(distance, scanned) for distance in (from_rim, edge_distance(cells.half_width, cells.grid.offsets()))]
        with np.errstate(invalid="ignore"):
            if photographed:
                z, bright, are_paint, least = bright_spots(brightness, rims)
            else:
                z, bright, are_paint, least = self._brighter_than_strips(parts, cells.grid.offsets(), brightness, from_rim, rims, settings)
            mask = clear_pieces(z, bright, scanned, are_paint)
        return mask & ~raised_cells([self._heights(part, cells.grid) for part in parts], mask), least

    def _brighter_than_strips(self, parts, offsets, brightness, from_rim, rims, settings):
        """As `bright_spots`, by the asphalt of strips along the road."""
        scanned, rows = np.isfinite(brightness), slice(WINDOW_HALO, WINDOW_HALO + THRESHOLD_WINDOW)
        interior = scanned[rows] & (from_rim[rows] > np.float32(ASPHALT.rim_width))
        if np.count_nonzero(interior) < ASPHALT.min_bin_cells:
            interior = scanned[rows]
        seen, usual = scanned, np.inf
        if self.source.road_points.has_corrected:   # without a correction asphalt itself is darker far from the vehicle
            usual = float(median(brightness[rows][interior]))
            dark = dark_cells(brightness, usual)
            if np.count_nonzero(interior & ~dark[rows]) >= ASPHALT.min_bin_cells:
                seen, interior = scanned & ~dark, interior & ~dark[rows]
        columns = np.flatnonzero(interior.any(axis=0))
        edges = bin_edges(np.concatenate([part.offsets for part in parts]), offsets[columns[0]], offsets[columns[-1]])
        bins = asphalt_bins(brightness[rows], interior, offsets, edges, usual)
        asphalt, spread = asphalt_profile(bins, offsets)
        z, gutter = flatten(brightness, asphalt, spread, rims)
        scale, threshold = threshold_profile(z[rows], (seen & ~gutter)[rows], offsets, bins, settings.separation)
        # the background that was subtracted from the cell is subtracted from the point as well
        least = (brightness - z * spread) + (threshold - 0.5) * (spread * scale)
        bright = z > threshold * scale
        return z / scale, bright, partial(two_sided, (brightness - asphalt) / (spread * scale), bright, ASPHALT.lowest), least

    def _heights(self, part: PieceOfRoad, grid: RoadGrid) -> tuple[np.ndarray, np.ndarray]:
        """Flat numbers in the grid of the cells of an even share of the points of a part, and the heights of these."""
        step = max(len(part.cell) // MAX_HEIGHTS, 1)
        return part.numbers_in(grid, part.cell[::step]), self._points(part.grid.first, part.grid.last).records["z"][::step]

    def _from_averages(self, cells):
        """Cells of paint where single points are noisy: bright pieces must have the shape of paint, too."""
        points = self._points(self.first, self.last)
        cell = cell_numbers(points.records, cells.grid)
        averages = CellAverages.of(cell, points.value, points.records["z"], cells.grid.shape, ASPHALT.lowest)
        samples = ViewSamples(cell, points.value, points.covered > 0, views(points, self.source.frame))
        return noisy_paint_cells(averages, rim_distance(cells.occupied), samples, ASPHALT.lowest), None

    def _paint_in(self, parts: list[PieceOfRoad], cells: RoadCells, mask: np.ndarray, least: np.ndarray | None) -> Columns:
        """Points of the window's own parts in painted cells, brighter than `least` of their cell; arrays as the grid."""
        grid, rows, numbers, before = cells.grid, [], [], 0
        for part in parts:
            row, cell = part.points_on(mask[part.within(grid)])
            rows.append(row + before)
            numbers.append(part.numbers_in(grid, cell))
            before += len(part.cell)
        # the columns of all parts are read together
        records = self._points(parts[0].grid.first, parts[-1].grid.last).records[np.concatenate(rows)]
        cell = np.concatenate(numbers)
        if least is not None:
            bright = np.flatnonzero(Points(records).value > least.ravel().take(cell))
            records, cell = records[bright], cell.take(bright)
        spacing = np.rint(track_spacing(cells.occupied).ravel().take(cell) * 1e3).astype(np.uint16)
        return records.with_columns(spacing=spacing)


# The mask of markings as a raster, in the pixels of the intensity image.

BURN_BLOCK = 2048   # derived: px: pixels are burnt in blocks of the image, so that a window in a bend reads only the blocks it touches


def write_mask(path: str | PathLike, points: RoadPoints, image: IntensityImage, frame: RoadFrame) -> None:
    """Write a byte GeoTIFF in the pixels of an image, 1 where points on paint lie, gaps between scan lines closed, and no data elsewhere."""
    halo = int(np.ceil(SHAPES.close_along / CELL_SIZE)) + 1
    with new_geotiff(path, image.width, image.height, image.geotransform, image.crs, byte=True, nodata=0) as mask:
        for number, window in windows_of(points):
            first, last = window * THRESHOLD_WINDOW, (window + 1) * THRESHOLD_WINDOW
            records = points_of_rows(points, number, first - halo, last + halo).records
            if not len(records):
                continue
            cells, corner = painted_cells(records["s"] * COORDINATE_SCALE, records["d"] * COORDINATE_SCALE)
            top, bottom = max(first - corner[0], 0), max(last - corner[0], 0)
            column, row = _painted_pixels(cells[top:bottom], (corner[0] + top, corner[1]), image, frame.origin, frame.road(number))
            block = row // BURN_BLOCK * (image.width // BURN_BLOCK + 1) + column // BURN_BLOCK
            for part in np.unique(block):
                c, r = column[block == part], row[block == part]
                c0, r0, width, height = int(c.min()), int(r.min()), int(np.ptp(c)) + 1, int(np.ptp(r)) + 1
                pixels = mask.read(c0, r0, width, height)
                pixels[r - r0, c - c0] = 1
                mask.write(c0, r0, pixels)


def _painted_pixels(cells: np.ndarray, first: tuple[int, int], image: IntensityImage, origin: np.ndarray,
                    road: Road) -> tuple[np.ndarray, np.ndarray]:
    """Columns and rows (M,) of the image's pixels whose centres lie in painted cells of a road, of which the first begins at `first` * 4 cm."""
    row, column = np.nonzero(cells)
    # four places a cell: pixels may be smaller than cells and rotated against them
    quarter = np.array([[-0.25, -0.25], [-0.25, 0.25], [0.25, -0.25], [0.25, 0.25]]) * CELL_SIZE
    s = ((first[0] + row + 0.5)[:, None] * CELL_SIZE + quarter[:, 0]).ravel()
    d = ((first[1] + column + 0.5)[:, None] * CELL_SIZE + quarter[:, 1]).ravel()
    pixels = np.floor(image.pixel_of(*road.to_map(s, d), origin)).astype(np.int64)
    inside = np.flatnonzero(((pixels >= 0) & (pixels < [[image.width], [image.height]])).all(axis=0))
    # each pixel once, by one of the places in it
    nearest = inside[np.unique(pixels[0, inside] * image.height + pixels[1, inside], return_index=True)[1]]
    left, size, _, top, _, _ = image.geotransform
    x, y = (left - origin[0]) + (pixels[0, nearest] + 0.5) * size, (top - origin[1]) - (pixels[1, nearest] + 0.5) * size
    places = np.array(road.locate(x, y, s[nearest], np.inf))
    row, column = np.floor(np.nan_to_num(places, nan=-np.inf) / CELL_SIZE) - np.array(first)[:, None]
    painted = (row >= 0) & (row < cells.shape[0]) & (column >= 0) & (column < cells.shape[1])
    painted[painted] = cells[row[painted].astype(int), column[painted].astype(int)]
    return pixels[0, nearest[painted]], pixels[1, nearest[painted]]
