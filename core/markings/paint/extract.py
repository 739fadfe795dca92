"""Which road points are paint: thresholds on the intensity image, and back to the points.

The image is looked at in the road's own frame, station along and offset across,
so that "along the road" is an axis of the array and a bend is straight.
"""

import threading
from contextlib import nullcontext
from dataclasses import dataclass, field

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...common.setting import check_limits, setting
from ...intensity.saturation import saturation_of
from ...survey.store.records import COORDINATE_SCALE, Points, join_columns, take_rows
from ...survey.store.road_points import RoadPoints
from ..objects.road_grid import CELL_UNITS, RoadCells, RoadGrid, cell_numbers, cells_of_road
from .asphalt_level import FEWEST, Levels, asphalt_bins, asphalt_profile, bin_edges, flatten, split_bins
from .gutters import edge_distance, rim_distance
from .mask import burn_points, marking_mask, painted_pixels
from .morphology import morphology
from .noisy import Averages, Witnesses, stroke_cells, views
from .peaks import PeakSettings, points_on_peaks
from .point_segments import SegmentSettings, points_in_segments
from .scatter import Scatter

RIM = 0.60        # m from the rim of the road where gutters end and asphalt is asphalt
METHODS = ("multi-threshold", "intensity-peaks", "point-segments")
WINDOW = 500      # cells: thresholds are taken from 20 m of road
MOST = 300_000    # points of a window: where there are twice as many, evenly strewn ones tell how they lie
HALO = 100        # cells: 4 m about a window in which rims and runs are still looked at


@dataclass(frozen=True)
class MarkingSettings:
    """When a spot of road is paint.

    method : "multi-threshold" on the intensity image; "intensity-peaks" of profiles across
        the road; "point-segments", thresholds on the points and their density
    separation : spreads of asphalt between the mean of paint and the mean of
        asphalt, below which a bin has no paint
    lowest, highest : limits of the threshold in spreads above the median of asphalt
    alone : spreads, the threshold where neither a bin nor its neighbours show two materials
    faint : spreads, the threshold on averages of noisy points, where shape must speak too
    close, shortest : m, gaps along the road that are closed, and pieces shorter than that are dropped
    peaks, segments : what the other two methods go by; all between is the multi-threshold's
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

    def __post_init__(self):
        check_limits(self)
        if self.method not in METHODS:
            raise RoadExtractionError(f"The method {self.method!r} is not known; use one of {', '.join(METHODS)}.")
        if not 1.0 <= self.lowest <= self.highest:
            raise RoadExtractionError(
                f"The threshold lies between {self.lowest} and {self.highest} spreads above asphalt; the first must be at "
                "least 1 and not above the second.")


def extract_markings(road_points, image, frame, settings=MarkingSettings(), progress=Progress(), mask_path=None):
    """Road points that lie on paint.

    Parameters
    ----------
    road_points : RoadPoints, corrected or not
    image : IntensityRaster of the same points, in memory or on disk; the methods on points need it for the mask alone
    frame : RoadFrame
    mask_path : where to write the mask of markings as GeoTIFF in the image's own pixels, or None

    Returns
    -------
    RoadPoints
    """
    saturated = "" if road_points.has_corrected else saturation_of(road_points).warning
    if saturated:
        progress.warn(saturated)
    with marking_mask(mask_path, image, frame.origin) if mask_path else nullcontext() as burn:
        if settings.method == "multi-threshold":
            kept = _extract(road_points, image, frame, settings, progress, burn)
        else:
            kept = _extract_from_points(road_points, settings, progress)
            if burn is not None:
                burn_points(burn, kept, image, frame)
    progress.info(f"Paint: {len(kept):,} of {len(road_points):,} road points lie on it.")
    return kept


def _extract_from_points(road_points, settings, progress):
    """What the methods find that look at the points and not at the image."""
    kept = RoadPoints.empty_like(road_points)
    roads = road_points.roads()
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        if settings.method == "intensity-peaks":
            found = points_on_peaks(road_points, road, settings.peaks, part)
        else:
            found = points_in_segments(road_points, road, settings.segments, part)
        for records in found:
            kept.store.append(road, records)
    return kept


def _extract(road_points, image, frame, settings, progress, burn):
    kept = RoadPoints.empty_like(road_points)
    roads = road_points.roads()
    windows = [(road, window) for road in roads for window in _windows(road_points, road)]
    scatter = Scatter.of(lambda road, window: _window(road_points, road, window), windows, progress.part(0.0, 0.1))
    progress.info(scatter.line(WINDOW * CELL_UNITS * COORDINATE_SCALE))
    for k, road in enumerate(roads):
        part = progress.part(0.1 + 0.9 * k / len(roads), 0.1 + 0.9 * (k + 1) / len(roads))
        look = _Look(road_points, image, frame, road, settings, burn is not None, scatter.averaged(road))
        painted = ordered_map(look.find, look.windows(), part)
        sections = _Sections(kept.store, road)
        for records, x, y in painted:
            sections.add(records)
            if burn is not None:
                burn(x, y)
        sections.finish()
    return kept


def _windows(road_points, road):
    """Numbers of the windows of a road."""
    start, end = road_points.store.span(road)
    first, last = (int(np.floor(s / COORDINATE_SCALE / CELL_UNITS / WINDOW)) for s in (start, end))
    return range(first, last + 1)


def _window(road_points, road, window):
    """Points of a window."""
    return road_points.window(road, window * WINDOW * CELL_UNITS * COORDINATE_SCALE, (window + 1) * WINDOW * CELL_UNITS * COORDINATE_SCALE)


class _Sections:
    """Puts the points of a road, which come in the order of the road, into the sections of a store."""

    def __init__(self, store, road):
        self.store, self.road = store, road
        self.number, self.parts = None, []

    def add(self, records):
        """Add Columns that lie behind all that came before."""
        section = np.floor(records["s"] * COORDINATE_SCALE / self.store.section_length).astype(np.int64)
        cuts = np.flatnonzero(np.diff(section)) + 1
        for first, end in zip([0, *cuts], [*cuts, len(section)]):
            if end > first:
                if section[first] != self.number:
                    self.finish()
                    self.number = int(section[first])
                self.parts.append(records[first:end])

    def finish(self):
        """Put what waits for more of its section."""
        if self.parts:
            self.store.put(self.road, self.number, join_columns(self.parts, self.store.dtype))
        self.parts = []


class _Look:
    """One road's windows, looked at twice: for the level of asphalt, and for what is brighter.

    A window is painted when the level of those beside it is known; till then what was seen of it is kept.
    """

    def __init__(self, road_points, image, frame, road, settings, masked=False, averaged=()):
        """`averaged` are the windows whose points are noisy: paint is sought in averages there, and they tell no other window's thresholds."""
        self.road_points, self.image, self.frame, self.road, self.settings = road_points, image, frame, road, settings
        self.masked, self.averaged = masked, averaged
        windows = _windows(road_points, road)
        self.first, self.last = windows[0], windows[-1]
        # by window; what several threads ask for is looked at by one
        self._pieces, self._bins, self._seen, self._turns, self._piece_turns = {}, {}, {}, {}, {}

    def windows(self):
        return list(range(self.first, self.last + 1))

    def find(self, window):
        """Records of one window that lie on paint; local x, y of the mask's pixels where one is asked for."""
        return self.strokes(window) if window in self.averaged else self.paint(window)

    def _points(self, first, last):
        return self.road_points.window(self.road, first * CELL_UNITS * COORDINATE_SCALE, last * CELL_UNITS * COORDINATE_SCALE)

    def _in_cells(self, window):
        """[PieceOfRoad] of a window's own points; they are kept until it is painted, for windows beside it look at them too."""
        with self._piece_turns.setdefault(window, threading.Lock()):
            if window not in self._pieces:
                first, last = window * WINDOW, (window + 1) * WINDOW
                step = max(len(self._points(first, last)) // MOST, 1)
                self._pieces[window] = cells_of_road(self.road_points, self.road, first, last, step)
            return self._pieces[window]

    def _look(self, window):
        """_Seen of a window with its halo; None where it has no points of its own."""
        if not self._in_cells(window):
            return None
        parts = [piece for beside in (window - 1, window, window + 1) for piece in self._in_cells(beside)]
        cells = RoadCells.of(parts, window * WINDOW - HALO, (window + 1) * WINDOW + HALO)
        rims = rim_distance(cells.occupied), edge_distance(cells.half_width, cells.grid.offsets())
        return _Seen(cells.grid, cells.grid.read(self.image, self.frame, self.road), rims)

    def bins(self, window):
        """Bins of asphalt and Otsu's splits of one window; an empty list where there is nothing to see."""
        with self._turns.setdefault(window, threading.Lock()):
            if window not in self._bins:
                seen = None if window in self.averaged else self._look(window)
                self._bins[window] = [] if seen is None else self._bins_of(window, seen)
                self._seen[window] = seen
            return self._bins[window]

    def _bins_of(self, window, seen):
        brightness, offsets, rows = seen.brightness, seen.grid.offsets(), slice(HALO, HALO + WINDOW)
        scanned = np.isfinite(brightness)
        interior = scanned[rows] & (seen.rims[0][rows] > np.float32(RIM))
        if np.count_nonzero(interior) < FEWEST:
            interior = scanned[rows]
        if not interior.any():
            return []
        columns = np.flatnonzero(interior.any(axis=0))
        edges = bin_edges(np.concatenate([piece.offsets for piece in self._in_cells(window)]), offsets[columns[0]], offsets[columns[-1]])
        across = np.broadcast_to(offsets, interior.shape)
        bins = asphalt_bins(brightness[rows][interior], across[interior], edges)
        z, gutter = flatten(brightness, *asphalt_profile(bins, offsets), seen.rims)
        counted = (scanned & ~gutter)[rows]
        return list(zip(bins, split_bins(z[rows][counted], across[counted], bins, self.settings.separation)))

    def _levels(self, window):
        """Levels between the windows about one, which are looked at if they were not yet."""
        self.bins(min(window + 2, self.last))  # its own share of the work, while other threads look at those between
        known = {window: self.bins(window)} if self.bins(window) else {}
        for step, end in ((-1, self.first), (1, self.last)):
            beside = next((w for w in range(window + step, end + step, step) if self.bins(w)), None)
            if beside is not None:
                # the thresholds of a window look at those beside it
                known.update((w, self.bins(w)) for w in (beside, beside + step) if self.first <= w <= self.last and self.bins(w))
        return Levels(known, WINDOW * CELL_UNITS * COORDINATE_SCALE, self.settings)

    def _pixels(self, mask, grid):
        """Local x, y of the centres of the image's pixels that lie in painted cells of the window itself."""
        own = mask[HALO:HALO + WINDOW]
        return painted_pixels(own, (grid.first + HALO, grid.low), self.image, self.frame.origin, self.frame.road(self.road))

    def paint(self, window):
        """What `find` gives, by thresholds on the image."""
        levels = self._levels(window)
        # those beside have been looked at for the levels
        seen, parts = self._seen.pop(window), self._pieces.pop(window)
        if seen is None or not len(levels.numbers):
            return self._nothing()
        grid, brightness = seen.grid, seen.brightness
        median, spread, scale, threshold = levels.at(grid)
        z, gutter = flatten(brightness, median, spread, seen.rims)
        with np.errstate(invalid="ignore"):
            mask = morphology((z > threshold * scale) & ~gutter, self.settings)
        # what was taken from the cell as background is taken from the point as well
        least = (brightness - z * spread) + (threshold - 0.5) * (spread * scale)
        return self._handed_out(parts, grid, mask, least)

    def strokes(self, window):
        """What `find` gives where single points are noisy: what is as bright as paint must have its shape too."""
        first, last = window * WINDOW, (window + 1) * WINDOW
        if not len(self._points(first, last)):
            return self._nothing()
        parts = cells_of_road(self.road_points, self.road, first - HALO, last + HALO)
        cells = RoadCells.of(parts, first - HALO, last + HALO)
        points = self._points(first - HALO, last + HALO)
        cell = np.concatenate([cell for _, cell in cell_numbers(points.records, cells.grid)])
        averages = Averages.of(cell, points.value, points.records["z"], cells.grid.shape)
        witnesses = Witnesses(cell, points.value, points.covered > 0, views(points, self.frame))
        mask = stroke_cells(averages, rim_distance(cells.occupied), witnesses, self.settings.faint)
        return self._handed_out([part for part in parts if part.grid.first >= first and part.grid.last <= last], cells.grid, mask)

    def _nothing(self):
        return self.road_points.window(self.road, 0, 0).records, np.empty(0), np.empty(0)

    def _handed_out(self, parts, grid, mask, least=None):
        """Records of the window's own parts in painted cells, brighter than `least` of their cell, and the mask's pixels."""
        found, on = [], np.zeros(grid.shape, bool)
        for part in parts:
            place = part.within(grid)
            rows, cell = part.points_on(mask[place])
            records = take_rows(self._points(part.grid.first, part.grid.last).records, rows)
            if least is not None:
                bright = np.flatnonzero(Points(records).value > least[place].ravel().take(cell))
                records, cell = take_rows(records, bright), cell.take(bright)
            found.append(records)
            own = np.zeros(part.grid.shape, bool)
            own.ravel()[cell] = True
            on[place] = own
        records = join_columns(found, self.road_points.store.dtype)
        if not self.masked:
            return records, np.empty(0), np.empty(0)
        # the image spreads a point over its neighbours: a cell whose own points are dark is no marking
        for part in parts:
            place = part.within(grid)
            mask[place][part.occupied] = on[place][part.occupied]
        return records, *self._pixels(mask, grid)


@dataclass(frozen=True)
class _Seen:
    """A window with its halo: RoadGrid, (rows, columns) brightness, and m inwards from the rim of what was scanned and from the road's edge."""

    grid: RoadGrid
    brightness: np.ndarray
    rims: tuple
