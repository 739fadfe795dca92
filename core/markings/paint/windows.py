"""Paint in windows of 20 m along a road: the level of asphalt of each, the cells that are brighter, the points on these, and the mask.

Levels come first, as a window needs those of its neighbours, then paint. The image is resampled in the road frame, so that a bend is straight.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ...curves.robust import median
from ...execution.phase import Recipe
from ...intensity.image import state_about
from ...io.geotiff import IntensityImage, new_geotiff
from ...survey.frame.road import Road
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points, join_columns, take_rows
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import SectionStore, StoreIndex
from ..objects.shape import painted_cells
from ..road_grid import CELL_SIZE, CELL_UNITS, PieceOfRoad, RoadCells, RoadGrid, cell_numbers, cells_of_road
from ..weights import ASPHALT, SHAPES
from .asphalt_level import AsphaltBin, AsphaltLevels, OtsuSplit, asphalt_bins, asphalt_profile, bin_edges, dark_cells, flatten, split_bins
from .noisy import CellAverages, ViewSamples, noisy_paint_cells, views
from .not_paint import RimBands, edge_distance, morphology, raised_cells, rim_distance, track_spacing
from .settings import MarkingSettings

THRESHOLD_WINDOW = 500   # derived: cells: thresholds are taken from 20 m of road
WINDOW_HALO = 100   # derived: cells: 4 m around a window that are read too, for rims and runs that cross its ends
WINDOWS_KEPT = 8   # derived: windows on either side whose data are kept: more than threads work on at once, and than thresholds mostly look at
MAX_HEIGHTS = 30_000   # derived: points of a piece of 5 m whose heights are compared; of twice as many an evenly spread share
MAX_OFFSET_POINTS = 300_000   # derived: points of a window whose offsets are kept; of twice as many an evenly spread share

Paint = tuple[Columns, np.ndarray, np.ndarray]   # points on paint; local x, y of the mask's pixels, if it is asked for
Bins = list[tuple[AsphaltBin, OtsuSplit]]   # of one window; none where there are no data
Windows = tuple[int, int, int]   # number of a road, first and last + 1 number of its windows


def windows_of(road_points: RoadPoints, road: int) -> range:
    """Numbers of the windows of a road."""
    start, end = road_points.store.span(road)
    first, last = (int(np.floor(s / COORDINATE_SCALE / CELL_UNITS / THRESHOLD_WINDOW)) for s in (start, end))
    return range(first, last + 1)


def points_of_rows(road_points: RoadPoints, road: int, first: int, last: int) -> Points:
    """Points of the rows of cells from `first` to before `last`."""
    return road_points.window(road, first * CELL_UNITS * COORDINATE_SCALE, last * CELL_UNITS * COORDINATE_SCALE)


def place_of(road_points: RoadPoints, windows: Windows) -> str:
    """What messages call windows of a road."""
    road, *ends = windows
    return road_points.survey.stretch(road, *(number * THRESHOLD_WINDOW * CELL_UNITS * COORDINATE_SCALE for number in ends))


class PaintSource:
    """What paint is extracted from in one phase, and where it goes.

    road_points, image : RoadPoints, and their image in memory or on disk
    frame : RoadFrame, None for that of the survey
    folder : of the store of paint, see SectionStore
    """

    def __init__(self, road_points: RoadPoints, image: Any, frame: RoadFrame | None = None, folder: str | Path | None = None):
        self.road_points, self.image, self.frame = road_points, image, frame or road_points.survey.frame
        self.paint = SectionStore(road_points.store.dtype, road_points.store.section_length, Path(folder) if folder else None)
        self._extractors: dict[int, WindowExtractor] = {}
        self._lock = threading.Lock()

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open points and image."""
        return Recipe("core.markings.paint.windows:PaintSource", dict(
            road_points=self.road_points.recipe(folder), image=self.image.recipe(folder), folder=str(folder)))

    def state(self, item: tuple[int, int]) -> list[Any]:
        """What paint in a window depends on: the road and its image in the windows that its levels may be taken from, with their halos."""
        road, window = item
        rows = (window - ASPHALT.level_reach) * THRESHOLD_WINDOW - WINDOW_HALO, (window + 1 + ASPHALT.level_reach) * THRESHOLD_WINDOW + WINDOW_HALO
        return state_about(self.image, self.frame, road, *(row * CELL_UNITS * COORDINATE_SCALE for row in rows))

    def extractor(self, road: int, *others: Any) -> WindowExtractor:
        """The one WindowExtractor of a road, whose windows share what they compute; `others` : its further arguments, always the same."""
        with self._lock:
            if road not in self._extractors:
                self._extractors[road] = WindowExtractor(self, road, windows_of(self.road_points, road), *others)
            return self._extractors[road]


def paint_of_window(source: PaintSource, item: tuple[int, int], settings: MarkingSettings, noisy: dict[int, list[int]],
                    masked: bool) -> tuple[StoreIndex, np.ndarray, np.ndarray]:
    """The phase that extracts paint; returns where its points lie in a part of the store of paint, and x, y of the mask.

    `item` : number of a road and of a window; `noisy` : {road: windows with noisy points}; `masked` : whether the mask's pixels are asked for.
    """
    road, window = item
    records, x, y = source.extractor(road, settings, noisy.get(road, ()), masked).extract(window)
    with source.paint.part() as part:
        part.append(road, records)
    return part.index(), x, y


class WindowExtractor:
    """Extracts paint from the windows of one road, in two steps: the level of asphalt, then the cells that are brighter.

    A window is extracted when the level of its neighbours is known; its data are kept until then. Several threads may extract windows at once, about
    in the order of the road.

    Parameters
    ----------
    windows : numbers of all windows of the road
    noisy : windows with noisy points: there paint is searched for in averages, and no other window's threshold depends on them
    masked : whether the mask's pixels are asked for
    """

    def __init__(self, source: PaintSource, road: int, windows: range, settings: MarkingSettings, noisy: Collection[int] = (), masked: bool = False):
        self.road_points, self.image, self.frame, self.road, self.settings = source.road_points, source.image, source.frame, road, settings
        self.masked, self.noisy = masked, set(noisy)
        self.first, self.last = windows[0], windows[-1]
        # by window
        self._pieces: dict[int, list[PieceOfRoad]] = {}
        self._bins: dict[int, Bins] = {}
        self._views: dict[int, _WindowView | None] = {}
        # data that several threads ask for are computed by one
        self._bin_locks: dict[int, threading.Lock] = {}
        self._piece_locks: dict[int, threading.Lock] = {}

    def extract(self, window: int) -> Paint:
        """Paint of one window."""
        for kept in (self._pieces, self._views):
            for other in [other for other in list(kept) if abs(other - window) > WINDOWS_KEPT]:
                kept.pop(other, None)
        return self._from_averages(window) if window in self.noisy else self._from_thresholds(window)

    def _points(self, first, last):
        return points_of_rows(self.road_points, self.road, first, last)

    def _in_cells(self, window):
        """[PieceOfRoad] of a window's own points, kept for its neighbours until it is extracted."""
        with self._piece_locks.setdefault(window, threading.Lock()):
            if window not in self._pieces:
                first, last = window * THRESHOLD_WINDOW, (window + 1) * THRESHOLD_WINDOW
                step = max(len(self._points(first, last)) // MAX_OFFSET_POINTS, 1)
                self._pieces[window] = cells_of_road(self.road_points, self.road, first, last, step)
            return self._pieces[window]

    def _view(self, window):
        """_WindowView of a window with its halo; None where it has no points of its own."""
        if not self._in_cells(window):
            return None
        parts = [piece for number in (window - 1, window, window + 1) for piece in self._in_cells(number)]
        cells = RoadCells.of(parts, window * THRESHOLD_WINDOW - WINDOW_HALO, (window + 1) * THRESHOLD_WINDOW + WINDOW_HALO)
        brightness = cells.grid.read(self.image, self.frame, self.road)
        distances, scanned = (rim_distance(cells.occupied), edge_distance(cells.half_width, cells.grid.offsets())), np.isfinite(brightness)
        return _WindowView(cells.grid, brightness, [RimBands.of(distance, scanned) for distance in distances], cells.occupied)

    def bins(self, window: int) -> Bins:
        """Bins of asphalt and Otsu's splits of one window; an empty list where there are no data."""
        with self._bin_locks.setdefault(window, threading.Lock()):
            if window not in self._bins:
                view = None if window in self.noisy else self._view(window)
                self._bins[window] = [] if view is None else self._bins_of(window, view)
                self._views[window] = view
            return self._bins[window]

    def _bins_of(self, window, view):
        brightness, offsets, rows = view.brightness, view.grid.offsets(), slice(WINDOW_HALO, WINDOW_HALO + THRESHOLD_WINDOW)
        scanned = np.isfinite(brightness)
        interior = scanned[rows] & (view.rims[0].distance[rows] > np.float32(ASPHALT.rim_width))
        if np.count_nonzero(interior) < ASPHALT.min_bin_cells:
            interior = scanned[rows]
        if not interior.any():
            return []
        # without a correction asphalt itself is darker far from the vehicle
        usual = float(median(brightness[rows][interior])) if self.road_points.has_corrected else np.inf
        if usual < np.inf:
            dark = dark_cells(brightness, usual)
            if np.count_nonzero(interior & ~dark[rows]) >= ASPHALT.min_bin_cells:
                scanned, interior = scanned & ~dark, interior & ~dark[rows]
        columns = np.flatnonzero(interior.any(axis=0))
        edges = bin_edges(np.concatenate([piece.offsets for piece in self._in_cells(window)]), offsets[columns[0]], offsets[columns[-1]])
        bins = asphalt_bins(brightness[rows], interior, offsets, edges, usual)
        z, gutter = flatten(brightness, *asphalt_profile(bins, offsets), view.rims)
        return list(zip(bins, split_bins(z[rows], (scanned & ~gutter)[rows], offsets, bins, self.settings.separation, self.settings.highest)))

    def _levels(self, window):
        """AsphaltLevels of the windows around one; their bins are computed if they were not yet."""
        self.bins(min(window + 2, self.last))  # a different window for each thread
        bins = {window: self.bins(window)} if self.bins(window) else {}
        for step in (-1, 1):
            # the thresholds of a window depend on its neighbours
            bins.update((w, self.bins(w)) for w in range(window + step, window + (ASPHALT.level_reach + 1) * step, step)
                        if self.first <= w <= self.last and self.bins(w))
        return AsphaltLevels(bins, THRESHOLD_WINDOW * CELL_UNITS * COORDINATE_SCALE, self.settings)

    def _pixels(self, mask, grid):
        """Local x, y of the centres of the image's pixels that lie in painted cells of the window itself."""
        inner = mask[WINDOW_HALO:WINDOW_HALO + THRESHOLD_WINDOW]
        return _painted_pixels(inner, (grid.first + WINDOW_HALO, grid.low), self.image, self.frame.origin, self.frame.road(self.road))

    def _from_thresholds(self, window: int) -> Paint:
        """Paint by thresholds on the image."""
        levels = self._levels(window)
        # the neighbours' data were used for the levels and are not needed again
        view = self._views.pop(window) if window in self._views else self._view(window)
        parts = self._pieces.pop(window)
        if view is None or not len(levels.numbers):
            return self._nothing()
        grid, brightness = view.grid, view.brightness
        median, spread, scale, threshold = levels.at(grid)
        z, gutter = flatten(brightness, median, spread, view.rims)
        with np.errstate(invalid="ignore"):
            mask = morphology((z > threshold * scale) & ~gutter, np.isfinite(brightness), self.settings)
        # the background that was subtracted from the cell is subtracted from the point as well
        min_brightness = (brightness - z * spread) + (threshold - 0.5) * (spread * scale)
        mask &= ~raised_cells([self._heights(part, grid) for part in parts], mask)
        return self._paint_in(parts, grid, view.occupied, mask, min_brightness)

    def _heights(self, part: PieceOfRoad, grid: RoadGrid) -> tuple[np.ndarray, np.ndarray]:
        """Flat numbers in the grid of the cells of an even share of the points of a part, and the heights of these."""
        step = max(len(part.cell) // MAX_HEIGHTS, 1)
        return part.numbers_in(grid, part.cell[::step]), self._points(part.grid.first, part.grid.last).records["z"][::step]

    def _from_averages(self, window: int) -> Paint:
        """Paint where single points are noisy: bright pieces must have the shape of paint, too."""
        first, last = window * THRESHOLD_WINDOW, (window + 1) * THRESHOLD_WINDOW
        if not len(self._points(first, last)):
            return self._nothing()
        parts = cells_of_road(self.road_points, self.road, first - WINDOW_HALO, last + WINDOW_HALO)
        cells = RoadCells.of(parts, first - WINDOW_HALO, last + WINDOW_HALO)
        if cells is None:
            return self._nothing()
        points = self._points(first - WINDOW_HALO, last + WINDOW_HALO)
        cell = np.concatenate([cell for _, cell in cell_numbers(points.records, cells.grid)])
        averages = CellAverages.of(cell, points.value, points.records["z"], cells.grid.shape, self.settings.faint)
        samples = ViewSamples(cell, points.value, points.covered > 0, views(points, self.frame))
        mask = noisy_paint_cells(averages, rim_distance(cells.occupied), samples, self.settings.faint)
        return self._paint_in([part for part in parts if part.grid.first >= first and part.grid.last <= last], cells.grid, cells.occupied, mask)

    def _nothing(self) -> Paint:
        return join_columns([], self.road_points.store.dtype), np.empty(0), np.empty(0)

    def _paint_in(self, parts: list[PieceOfRoad], grid: RoadGrid, occupied: np.ndarray, mask: np.ndarray,
                  least: np.ndarray | None = None) -> Paint:
        """Points of the window's own parts in painted cells, brighter than `least` of their cell, and the mask's pixels; arrays as the grid."""
        if not parts:
            return self._nothing()
        rows, cells, before = [], [], 0
        for part in parts:
            row, cell = part.points_on(mask[part.within(grid)])
            rows.append(row + before)
            cells.append(part.numbers_in(grid, cell))
            before += len(part.cell)
        # the columns of all parts are read together
        records = take_rows(self._points(parts[0].grid.first, parts[-1].grid.last).records, np.concatenate(rows))
        cell = np.concatenate(cells)
        if least is not None:
            bright = np.flatnonzero(Points(records).value > least.ravel().take(cell))
            records, cell = take_rows(records, bright), cell.take(bright)
        spacing = np.rint(track_spacing(occupied).ravel().take(cell) * 1e3).astype(np.uint16)
        records = records.with_columns(spacing=spacing)
        if not self.masked:
            return records, np.empty(0), np.empty(0)
        with_points = np.zeros(grid.shape, bool)
        with_points.ravel()[cell] = True
        # the image spreads a point over neighbouring cells: a cell whose own points are dark is no marking
        for part in parts:
            box = part.within(grid)
            mask[box][part.occupied] = with_points[box][part.occupied]
        return records, *self._pixels(mask, grid)


@dataclass(frozen=True)
class _WindowView:
    """The image of a window with its halo: brightness is NaN where there is no data, `rims` are those of the scanned road and of the road's edges."""

    grid: RoadGrid
    brightness: np.ndarray
    rims: list[RimBands]
    occupied: np.ndarray


# The mask of markings as a raster, in the pixels of the intensity image.

BURN_BLOCK = 2048   # derived: px: pixels are burnt in blocks of the image, so that a window in a bend reads only the blocks it touches
BURN_WINDOW = 500   # derived: cells: 20 m of station burnt at a time

Burn = Callable[[np.ndarray, np.ndarray], None]   # burns (M,) local x, y


@contextmanager
def marking_mask(path: str | PathLike, image: IntensityImage, origin: np.ndarray) -> Iterator[Burn]:
    """Open a byte GeoTIFF, 1 where a marking is, no data elsewhere; gives a function that burns local x, y into it.

    `path` : of the GeoTIFF, which appears when the block is left without an error; it has the pixels of `image`. `origin` : of local coordinates, m.
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


def _pixel_centres(image: IntensityImage, x: np.ndarray, y: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Local x, y (M,) of the centres of the pixels that places lie in, each once, and the (M,) index of a place in each pixel."""
    column, row = (np.floor(c).astype(np.int64) for c in image.pixel_of(x, y, origin))
    _, first = np.unique(row * (image.width + 1) + column, return_index=True)
    left, size, _, top, _, _ = image.geotransform
    return (left - origin[0]) + (column[first] + 0.5) * size, (top - origin[1]) - (row[first] + 0.5) * size, first


def _painted_pixels(cells: np.ndarray, first: tuple[int, int], image: IntensityImage, origin: np.ndarray,
                    road: Road) -> tuple[np.ndarray, np.ndarray]:
    """Local x, y (M,) of the image's pixels whose centres lie in painted cells of a road, of which the first begins at `first` * 4 cm."""
    row, column = np.nonzero(cells)
    # four places a cell: pixels may be smaller than cells and rotated against them
    quarter = np.array([[-0.25, -0.25], [-0.25, 0.25], [0.25, -0.25], [0.25, 0.25]]) * CELL_SIZE
    s = ((first[0] + row + 0.5)[:, None] * CELL_SIZE + quarter[:, 0]).ravel()
    d = ((first[1] + column + 0.5)[:, None] * CELL_SIZE + quarter[:, 1]).ravel()
    x, y = road.to_map(s, d)
    x, y, nearest = _pixel_centres(image, x, y, origin)
    s, d = road.locate(x, y, s[nearest], np.inf)
    finite = np.isfinite(s)
    x, y, s, d = x[finite], y[finite], s[finite], d[finite]
    row, column = (np.floor(c / CELL_SIZE).astype(np.int64) - f for c, f in ((s, first[0]), (d, first[1])))
    inside = (row >= 0) & (row < cells.shape[0]) & (column >= 0) & (column < cells.shape[1])
    inside[inside] = cells[row[inside], column[inside]]
    return x[inside], y[inside]


def burn_points(burn: Burn, points: RoadPoints, image: IntensityImage, frame: RoadFrame) -> None:
    """Burn the cells that points on paint lie in, gaps between scan lines closed; `burn` is given by `marking_mask`."""
    halo = int(np.ceil(SHAPES.close_along / CELL_SIZE)) + 1
    for road in points.roads():
        start, end = points.store.span(road)
        for window in range(int(np.floor(start / CELL_SIZE / BURN_WINDOW)), int(np.ceil(end / CELL_SIZE / BURN_WINDOW))):
            first, last = window * BURN_WINDOW, (window + 1) * BURN_WINDOW
            records = points.window(road, (first - halo) * CELL_SIZE, (last + halo) * CELL_SIZE).records
            if not len(records):
                continue
            cells, corner = painted_cells(records["s"] * COORDINATE_SCALE, records["d"] * COORDINATE_SCALE)
            top, bottom = max(first - corner[0], 0), max(last - corner[0], 0)
            burn(*_painted_pixels(cells[top:bottom], (corner[0] + top, corner[1]), image, frame.origin, frame.road(road)))
