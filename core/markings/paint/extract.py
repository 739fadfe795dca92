"""Which road points are paint: thresholds on the intensity image, and back to the points.

The image is resampled in the road frame, station along and offset across,
so that "along the road" is an axis of the array and a bend is straight.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from os import PathLike

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...curves.robust import median
from ...intensity.saturation import saturation_of
from ...intensity.tiled_image import IntensityRaster
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, Points, join_columns, take_rows
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import SectionStore
from ..objects.road_grid import CELL_UNITS, PieceOfRoad, RoadCells, RoadGrid, cell_numbers, cells_of_road
from .asphalt_level import AsphaltLevels, asphalt_profile, dark_cells, flatten
from .fading import without_fading_areas, without_fading_rims
from .faint_lines import faint_lines
from .gutters import RimBands, edge_distance, rim_distance
from .mask import Burn, burn_points, marking_mask, painted_pixels
from .morphology import morphology
from .noisy import CellAverages, ViewSamples, noisy_paint_cells, views
from .peaks import PeakSettings, points_on_peaks
from .point_segments import SegmentSettings, points_in_segments
from .raised import raised_cells
from .scatter import ScannerScatter
from .spacing import track_spacing
from .threshold_bins import MIN_BIN_CELLS, AsphaltBin, OtsuSplit, asphalt_bins, bin_edges, split_bins

RIM_WIDTH = 0.60         # m from the rim of the road: gutters; asphalt is taken from the cells inside
MARKING_METHODS = ("multi-threshold", "intensity-peaks", "point-segments")
THRESHOLD_WINDOW = 500   # cells: thresholds are taken from 20 m of road
WINDOW_HALO = 100        # cells: 4 m around a window that are read too, for rims and runs that cross its ends
MAX_HEIGHTS = 30_000     # points of a piece of 5 m whose heights are compared; of twice as many an evenly spread share
MAX_OFFSET_POINTS = 300_000  # points of a window whose offsets are kept; of twice as many an evenly spread share

Paint = tuple[Columns, np.ndarray, np.ndarray]   # records on paint; local x, y of the mask's pixels, empty where no mask is asked for


@dataclass(frozen=True)
class MarkingSettings:
    """When a spot of road is paint.

    "spreads" are those of asphalt below its median.

    method : "multi-threshold" on the intensity image; "intensity-peaks" of profiles across
        the road; "point-segments", thresholds on the points and their density
    separation : spreads of asphalt between the mean of paint and the mean of
        asphalt, below which a bin has no paint
    lowest, highest : limits of the threshold in spreads above the median of asphalt
    alone : spreads, the threshold where neither a bin nor its neighbours have two materials
    faint : spreads, the threshold on averages of noisy points, where the shape must be that of paint, too
    close : m, gaps along the road that are closed
    shortest : m, shorter runs are removed
    peaks, segments : settings of the other two methods; the settings from `separation` to `shortest` are for multi-threshold
    """

    method: str = "multi-threshold"
    separation: float = setting(4.0, 0.5, 20.0, "The distance of paint from asphalt", "spreads")
    lowest: float = 3.0
    highest: float = 8.0
    alone: float = 5.0
    faint: float = 3.0
    close: float = setting(0.20, 0.0, 2.0, "The gap that is closed along the road", "m")
    shortest: float = setting(0.20, 0.0, 2.0, "The shortest run of paint", "m")
    peaks: PeakSettings = field(default_factory=PeakSettings)
    segments: SegmentSettings = field(default_factory=SegmentSettings)

    def __post_init__(self) -> None:
        check_limits(self)
        if self.method not in MARKING_METHODS:
            raise RoadExtractionError(f"The method {self.method!r} is not known; use one of {', '.join(MARKING_METHODS)}.")
        if not 1.0 <= self.lowest <= self.highest:
            raise RoadExtractionError(
                f"The threshold lies between {self.lowest} and {self.highest} spreads above asphalt; the first must be at "
                "least 1 and not above the second.")


def extract_markings(road_points: RoadPoints, image: IntensityRaster, frame: RoadFrame, settings: MarkingSettings = MarkingSettings(),
                     progress: Progress = Progress(), mask_path: str | PathLike | None = None) -> RoadPoints:
    """Road points that lie on paint.

    Parameters
    ----------
    road_points : RoadPoints, corrected or not
    image : IntensityRaster of the same points, in memory or on disk; the methods on points need it for the mask alone
    frame : RoadFrame
    settings : MarkingSettings
    progress : Progress
    mask_path : where to write the mask of markings as GeoTIFF in the image's own pixels, or None

    Returns
    -------
    RoadPoints

    Raises
    ------
    RoadExtractionError
        If the mask cannot be written.

    Notes
    -----
    Multi-thresholds after Guan et al. (2014) and the driving-line thesis (Waterloo, 2017); our own are the
    local level of asphalt, the treatment of gutters and patches, and the averages for noisy scanners.
    """
    saturated = "" if road_points.has_corrected else saturation_of(road_points).warning
    if saturated:
        progress.warn(saturated)
    with marking_mask(mask_path, image, frame.origin) if mask_path else nullcontext() as burn:
        if settings.method == "multi-threshold":
            paint = _extract_from_image(road_points, image, frame, settings, progress, burn)
        else:
            paint = _extract_from_points(road_points, settings, progress)
            if burn is not None:
                burn_points(burn, paint, image, frame)
    progress.info(f"Paint: {len(paint):,} of {len(road_points):,} road points lie on it.")
    return paint


def _extract_from_points(road_points: RoadPoints, settings: MarkingSettings, progress: Progress) -> RoadPoints:
    """Paint by the methods that use the points and not the image."""
    paint = RoadPoints.empty_like(road_points)
    roads = road_points.roads()
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        if settings.method == "intensity-peaks":
            found = points_on_peaks(road_points, road, settings.peaks, part)
        else:
            found = points_in_segments(road_points, road, settings.segments, part)
        for records in found:
            paint.store.append(road, records)
    return paint


def _extract_from_image(road_points: RoadPoints, image: IntensityRaster, frame: RoadFrame, settings: MarkingSettings, progress: Progress,
                        burn: Burn | None) -> RoadPoints:
    """Paint by multi-thresholds on the image, and from averages where points are noisy."""
    paint = replace(RoadPoints.empty_like(road_points), has_spacing=True)
    roads = road_points.roads()
    windows = [(road, window) for road in roads for window in _windows(road_points, road)]
    scatter = ScannerScatter.of(lambda road, window: _window(road_points, road, window), windows, progress.part(0.0, 0.1))
    progress.info(scatter.summary(THRESHOLD_WINDOW * CELL_UNITS * COORDINATE_SCALE))
    for k, road in enumerate(roads):
        part = progress.part(0.1 + 0.9 * k / len(roads), 0.1 + 0.9 * (k + 1) / len(roads))
        extractor = WindowExtractor(road_points, image, frame, road, settings, burn is not None, scatter.noisy_windows(road))
        painted = ordered_map(extractor.extract, extractor.windows(), part)
        sections = _SectionWriter(paint.store, road)
        for records, x, y in painted:
            sections.add(records)
            if burn is not None:
                burn(x, y)
        sections.finish()
    return paint


def _windows(road_points, road):
    """Numbers of the windows of a road."""
    start, end = road_points.store.span(road)
    first, last = (int(np.floor(s / COORDINATE_SCALE / CELL_UNITS / THRESHOLD_WINDOW)) for s in (start, end))
    return range(first, last + 1)


def _window(road_points, road, window):
    """Points of a window."""
    first, last = window * THRESHOLD_WINDOW, (window + 1) * THRESHOLD_WINDOW
    return road_points.window(road, first * CELL_UNITS * COORDINATE_SCALE, last * CELL_UNITS * COORDINATE_SCALE)


class _SectionWriter:
    """Puts the points of a road, which come in the order of the road, into the sections of a store."""

    def __init__(self, store: SectionStore, road: int):
        self.store, self.road = store, road
        self.number: int | None = None
        self.parts: list[Columns] = []

    def add(self, records: Columns) -> None:
        """Add Columns whose stations follow all those added before."""
        section = np.floor(records["s"] * COORDINATE_SCALE / self.store.section_length).astype(np.int64)
        cuts = np.flatnonzero(np.diff(section)) + 1
        for first, end in zip([0, *cuts], [*cuts, len(section)]):
            if end > first:
                if section[first] != self.number:
                    self.finish()
                    self.number = int(section[first])
                self.parts.append(records[first:end])

    def finish(self) -> None:
        """Put the section that is not complete yet."""
        if self.parts and self.number is not None:
            self.store.put(self.road, self.number, join_columns(self.parts, self.store.dtype))
        self.parts = []


class WindowExtractor:
    """Extracts paint from the windows of one road, in two steps: the level of asphalt, then the cells that are brighter.

    A window is extracted when the level of its neighbours is known; its data are kept until then. Several threads
    may extract windows at once, in the order of the road.

    Parameters
    ----------
    road_points : RoadPoints
    image : IntensityRaster
    frame : RoadFrame
    road : its number
    settings : MarkingSettings
    masked : whether the mask's pixels are asked for
    noisy : windows with noisy points: there paint is searched for in averages, and no other window's threshold depends on them
    """

    def __init__(self, road_points: RoadPoints, image: IntensityRaster, frame: RoadFrame, road: int, settings: MarkingSettings,
                 masked: bool = False, noisy: Iterable[int] = ()):
        self.road_points, self.image, self.frame, self.road, self.settings = road_points, image, frame, road, settings
        self.masked, self.noisy = masked, set(noisy)
        windows = _windows(road_points, road)
        self.first, self.last = windows[0], windows[-1]
        # by window
        self._pieces: dict[int, list[PieceOfRoad]] = {}
        self._bins: dict[int, list[tuple[AsphaltBin, OtsuSplit]]] = {}
        self._views: dict[int, _WindowView | None] = {}
        # data that several threads ask for are computed by one
        self._bin_locks: dict[int, threading.Lock] = {}
        self._piece_locks: dict[int, threading.Lock] = {}

    def windows(self) -> list[int]:
        """Numbers of all windows of the road."""
        return list(range(self.first, self.last + 1))

    def extract(self, window: int) -> Paint:
        """Paint of one window."""
        return self._from_averages(window) if window in self.noisy else self._from_thresholds(window)

    def _points(self, first, last):
        return self.road_points.window(self.road, first * CELL_UNITS * COORDINATE_SCALE, last * CELL_UNITS * COORDINATE_SCALE)

    def _in_cells(self, window):
        """[PieceOfRoad] of a window's own points; kept until the window is extracted, as its neighbours use them too."""
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
        parts = [piece for beside in (window - 1, window, window + 1) for piece in self._in_cells(beside)]
        cells = RoadCells.of(parts, window * THRESHOLD_WINDOW - WINDOW_HALO, (window + 1) * THRESHOLD_WINDOW + WINDOW_HALO)
        brightness = cells.grid.read(self.image, self.frame, self.road)
        distances, scanned = (rim_distance(cells.occupied), edge_distance(cells.half_width, cells.grid.offsets())), np.isfinite(brightness)
        return _WindowView(cells.grid, brightness, [RimBands.of(distance, scanned) for distance in distances], cells.occupied)

    def bins(self, window: int) -> list[tuple[AsphaltBin, OtsuSplit]]:
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
        interior = scanned[rows] & (view.rims[0].distance[rows] > np.float32(RIM_WIDTH))
        if np.count_nonzero(interior) < MIN_BIN_CELLS:
            interior = scanned[rows]
        if not interior.any():
            return []
        # without a correction asphalt itself is darker far from the vehicle
        usual = float(median(brightness[rows][interior])) if self.road_points.has_corrected else np.inf
        if usual < np.inf:
            dark = dark_cells(brightness, usual)
            if np.count_nonzero(interior & ~dark[rows]) >= MIN_BIN_CELLS:
                scanned, interior = scanned & ~dark, interior & ~dark[rows]
        columns = np.flatnonzero(interior.any(axis=0))
        edges = bin_edges(np.concatenate([piece.offsets for piece in self._in_cells(window)]), offsets[columns[0]], offsets[columns[-1]])
        bins = asphalt_bins(brightness[rows], interior, offsets, edges, usual)
        z, gutter = flatten(brightness, *asphalt_profile(bins, offsets), view.rims)
        return list(zip(bins, split_bins(z[rows], (scanned & ~gutter)[rows], offsets, bins, self.settings.separation)))

    def _levels(self, window):
        """AsphaltLevels of the windows around one; their bins are computed if they were not yet."""
        self.bins(min(window + 2, self.last))  # a different window for each thread
        known = {window: self.bins(window)} if self.bins(window) else {}
        for step, end in ((-1, self.first), (1, self.last)):
            beside = next((w for w in range(window + step, end + step, step) if self.bins(w)), None)
            if beside is not None:
                # the thresholds of a window depend on its neighbours
                known.update((w, self.bins(w)) for w in (beside, beside + step) if self.first <= w <= self.last and self.bins(w))
        return AsphaltLevels(known, THRESHOLD_WINDOW * CELL_UNITS * COORDINATE_SCALE, self.settings)

    def _pixels(self, mask, grid):
        """Local x, y of the centres of the image's pixels that lie in painted cells of the window itself."""
        own = mask[WINDOW_HALO:WINDOW_HALO + THRESHOLD_WINDOW]
        return painted_pixels(own, (grid.first + WINDOW_HALO, grid.low), self.image, self.frame.origin, self.frame.road(self.road))

    def _from_thresholds(self, window: int) -> Paint:
        """Paint by thresholds on the image."""
        levels = self._levels(window)
        # the neighbours' data were used for the levels and are not needed again
        view, parts = self._views.pop(window), self._pieces.pop(window)
        if view is None or not len(levels.numbers):
            return self._nothing()
        grid, brightness = view.grid, view.brightness
        median, spread, scale, threshold = levels.at(grid)
        z, gutter = flatten(brightness, median, spread, view.rims)
        with np.errstate(invalid="ignore"):
            bright = morphology((z > threshold * scale) & ~gutter, self.settings)
        mask = without_fading_areas(z, without_fading_rims(z, bright, view.occupied & ~gutter), view.occupied, gutter, grid.offsets())
        # the background that was subtracted from the cell is subtracted from the point as well
        least = (brightness - z * spread) + (threshold - 0.5) * (spread * scale)
        lines, halfway = faint_lines(brightness, view.occupied, view.rims[0].distance, mask, bright & ~mask)
        least = np.where(lines & ~mask, halfway, least)
        mask |= lines
        mask &= ~raised_cells([self._heights(part, grid) for part in parts], mask)
        return self._paint_in(parts, grid, view.occupied, mask, least)

    def _heights(self, part: PieceOfRoad, grid: RoadGrid) -> tuple[np.ndarray, np.ndarray]:
        """Flat numbers in the grid of the cells of an even share of the points of a part, and the heights of these."""
        step = max(len(part.cell) // MAX_HEIGHTS, 1)
        row, column = np.divmod(part.cell[::step], np.int32(part.grid.shape[1]))
        row += np.int32(part.grid.first - grid.first)
        column += np.int32(part.grid.low - grid.low)
        return row * np.int32(grid.shape[1]) + column, self._points(part.grid.first, part.grid.last).records["z"][::step]

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
        """Records of the window's own parts in painted cells, brighter than `least` of their cell, and the mask's pixels.

        occupied, mask, least : (rows, columns) of the grid
        """
        found, on = [], np.zeros(grid.shape, bool)
        spacing = np.rint(track_spacing(occupied) * 1e3).astype(np.uint16)
        for part in parts:
            place = part.within(grid)
            rows, cell = part.points_on(mask[place])
            records = take_rows(self._points(part.grid.first, part.grid.last).records, rows)
            if least is not None:
                bright = np.flatnonzero(Points(records).value > least[place].ravel().take(cell))
                records, cell = take_rows(records, bright), cell.take(bright)
            found.append(records.with_columns(spacing=spacing[place].ravel().take(cell)))
            own = np.zeros(part.grid.shape, bool)
            own.ravel()[cell] = True
            on[place] = own
        records = join_columns(found, self.road_points.store.dtype)
        if not self.masked:
            return records, np.empty(0), np.empty(0)
        # the image spreads a point over neighbouring cells: a cell whose own points are dark is no marking
        for part in parts:
            place = part.within(grid)
            mask[place][part.occupied] = on[place][part.occupied]
        return records, *self._pixels(mask, grid)


@dataclass(frozen=True)
class _WindowView:
    """The image of a window with its halo.

    grid : RoadGrid
    brightness : (rows, columns) float32, NaN where there is no data
    rims : RimBands of the rim of the scanned road and of the road's edges
    occupied : (rows, columns) bool, cells that points lie in
    """

    grid: RoadGrid
    brightness: np.ndarray
    rims: list[RimBands]
    occupied: np.ndarray
