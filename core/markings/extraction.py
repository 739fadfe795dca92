"""Which road points are paint: thresholds on the intensity image, and back to the points.

The image is looked at in the road's own frame, station along and offset across,
so that "along the road" is an axis of the array and a bend is straight.
"""

from contextlib import nullcontext
from dataclasses import dataclass, field

import numpy as np

from ..errors import RoadExtractionError
from ..parallel import in_order
from ..progress import Progress
from ..survey.points import UNIT, Points, chosen
from ..survey.road_points import RoadPoints
from .averages import Averages
from .gutters import edge_distance, rim_distance
from .intensity_peaks import PeakSettings, points_on_peaks
from .levels import Levels, asphalt_profile, flatten
from .mask import burn_points, marking_mask, painted_pixels
from .morphology import morphology
from .point_segments import SegmentSettings, points_in_segments
from .road_grid import CELL, RoadGrid
from .strokes import Witnesses, stroke_cells, views
from .thresholds import FEWEST, asphalt_bins, bin_edges, scatter_of, split_bins

RIM = 0.60        # m from the rim of the road where gutters end and asphalt is asphalt
NOISY = 0.40      # of asphalt's level: single points that scatter more are averaged (multi-beam scanners)
METHODS = ("multi-threshold", "intensity-peaks", "point-segments")
WINDOW = 500      # cells: thresholds are taken from 20 m of road
AT_ONCE = 1 << 15 # points put into cells at a time: what fits the processor's cache
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
    separation: float = 4.0
    lowest: float = 3.0
    highest: float = 8.0
    alone: float = 5.0
    faint: float = 3.0
    close: float = 0.20
    shortest: float = 0.20
    peaks: PeakSettings = field(default_factory=PeakSettings)
    segments: SegmentSettings = field(default_factory=SegmentSettings)

    def __post_init__(self):
        if self.method not in METHODS:
            raise RoadExtractionError(f"The method {self.method!r} is not known; use one of {', '.join(METHODS)}.")
        if not 1.0 <= self.lowest <= self.highest:
            raise RoadExtractionError(
                f"The threshold lies between {self.lowest} and {self.highest} spreads above asphalt; the first must be at "
                "least 1 and not above the second.")
        if min(self.close, self.shortest) < 0:
            raise RoadExtractionError("Lengths along the road must be 0 m or more.")


def extract_markings(road_points, image, frame, settings=MarkingSettings(), progress=Progress(), mask_path=None):
    """Road points that lie on paint.

    Parameters
    ----------
    road_points : RoadPoints, corrected or not
    image : anything with sample(x, y) -> brightness in map coordinates, made from the same points
    frame : RoadFrame
    mask_path : where to write the mask of markings as GeoTIFF in the image's own pixels, or None

    Returns
    -------
    RoadPoints
    """
    with marking_mask(mask_path, image, frame.origin) if mask_path else nullcontext() as burn:
        if settings.method == "multi-threshold":
            kept = _extract(road_points, image, frame, settings, progress, burn)
        else:
            kept = _extract_from_points(road_points, settings, progress)
            if burn is not None:
                burn_points(burn, kept, image, frame)
    progress.say(f"Paint: {len(kept):,} of {len(road_points):,} road points lie on it.")
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
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        look = _Look(road_points, image, frame, road, settings, burn is not None)
        windows = look.windows()
        # a scanner is noisy or it is not: every fourth window tells
        scatter = [value for value in in_order(look.scatter, [w for w in windows if w % 4 == 0] or windows, part.part(0.0, 0.1))
                   if value is not None]
        if scatter and float(np.median(scatter)) > NOISY:
            progress.say(f"Intensities scatter by {100 * np.median(scatter):.0f} % about asphalt: paint is sought in averages "
                         "over a decimetre, as strokes and rows of dashes; other markings are not seen.")
            painted = in_order(look.strokes, windows, part.part(0.1, 1.0))
        else:
            bins = dict(zip(windows, in_order(look.bins, windows, part.part(0.1, 0.5))))
            levels = Levels({w: found for w, found in bins.items() if found}, WINDOW * CELL * UNIT, settings)
            painted = in_order(lambda w, levels=levels: look.paint(w, levels), windows, part.part(0.5, 1.0))
        for records, x, y in painted:
            kept.store.append(road, records)
            if burn is not None:
                burn(x, y)
    return kept


class _Look:
    """One road's windows, looked at twice: for the level of asphalt, and for what is brighter."""

    def __init__(self, road_points, image, frame, road, settings, masked=False):
        self.road_points, self.image, self.frame, self.road, self.settings = road_points, image, frame, road, settings
        self.masked = masked

    def windows(self):
        start, end = self.road_points.store.span(self.road)
        return list(range(int(np.floor(start / UNIT / CELL / WINDOW)), int(np.floor(end / UNIT / CELL / WINDOW)) + 1))

    def scatter(self, window):
        """Spread of the intensity of single points about asphalt in a window, as a share of its level; None without asphalt.

        It is taken of the intensities as measured, scanner by scanner, in squares
        that each scanner sees from one distance.
        """
        points = self.road_points.window(self.road, window * WINDOW * CELL * UNIT, (window + 1) * WINDOW * CELL * UNIT)
        if len(points) < FEWEST:
            return None
        return scatter_of(points)

    def _grid(self, window):
        """_Cells of a window with its halo; None where it has no points of its own."""
        first, last = window * WINDOW - HALO, (window + 1) * WINDOW + HALO
        records = self.road_points.window(self.road, (first - 1) * CELL * UNIT, (last + 1) * CELL * UNIT).records
        # they come in order of station
        begin, own, behind, end = np.searchsorted(records["s"], np.array([first, first + HALO, last - HALO, last]) * CELL)
        if own == behind:
            return None
        records = records[begin:end]
        low, high = int(records["d"].min()) // CELL - 1, int(records["d"].max()) // CELL + 2
        grid = RoadGrid(first, last, low, high)
        occupied, cells = np.zeros(grid.shape, bool), np.empty(len(records), np.int32)
        for k in range(0, len(records), AT_ONCE):
            cell = cells[k:k + AT_ONCE]
            np.floor_divide(records["s"][k:k + AT_ONCE], CELL, out=cell)
            cell -= first
            cell *= high - low
            cell += records["d"][k:k + AT_ONCE] // CELL
            cell -= low
            occupied.ravel()[cell] = True
        rows = np.searchsorted(records["s"], np.arange(first, last + 1) * CELL)
        edge = edge_distance(records["half_width"], records["d"], rows, grid.offsets())
        return _Cells(grid, records, cells, slice(own - begin, behind - begin), rim_distance(occupied), edge)

    def bins(self, window):
        """Bins of asphalt and Otsu's splits of one window; an empty list where there is nothing to see."""
        found = self._grid(window)
        if found is None:
            return []
        grid, rim = found.grid, found.rim
        brightness = grid.read(self.image, self.frame, self.road)
        rows = slice(HALO, HALO + WINDOW)
        offsets = np.broadcast_to(grid.offsets(), grid.shape)
        seen = np.isfinite(brightness)
        interior = seen & (rim > RIM)
        interior[:HALO] = interior[HALO + WINDOW:] = False
        if np.count_nonzero(interior) < FEWEST:
            interior = seen.copy()
            interior[:HALO] = interior[HALO + WINDOW:] = False
        if not interior.any():
            return []
        edges = bin_edges(found.records["d"][found.own], offsets[interior].min(), offsets[interior].max())
        bins = asphalt_bins(brightness[interior], offsets[interior], edges)
        z, gutter = flatten(brightness, *asphalt_profile(bins, grid.offsets()), (rim, found.edge))
        counted = (seen & ~gutter)[rows]
        return list(zip(bins, split_bins(z[rows][counted], offsets[rows][counted], bins, self.settings.separation)))

    def _pixels(self, mask, grid):
        """Local x, y of the centres of the image's pixels that lie in painted cells of the window itself."""
        own = mask[HALO:HALO + WINDOW]
        return painted_pixels(own, (grid.first + HALO, grid.low), self.image, self.frame.origin, self.frame.road(self.road))

    def paint(self, window, levels):
        """Records of one window that lie on paint; local x, y of the mask's pixels where one is asked for."""
        found = self._grid(window)
        if found is None or not len(levels.numbers):
            return self._nothing()
        grid = found.grid
        brightness = grid.read(self.image, self.frame, self.road)
        median, spread, scale, threshold = levels.at(grid)
        z, gutter = flatten(brightness, median, spread, (found.rim, found.edge))
        with np.errstate(invalid="ignore"):
            mask = morphology((z > threshold * scale) & ~gutter, self.settings)
        # what was taken from the cell as background is taken from the point as well
        least = (brightness - z * spread) + (threshold - 0.5) * (spread * scale)
        return self._handed_out(found, mask, least)

    def strokes(self, window):
        """The same where single points are noisy: what is as bright as paint must have its shape too."""
        found = self._grid(window)
        if found is None:
            return self._nothing()
        cell, points = found.cell, Points(found.records)
        averages = Averages.of(cell, points.value, found.records["z"], found.grid.shape)
        witnesses = Witnesses(cell, points.value, points.covered > 0, views(points, self.frame))
        return self._handed_out(found, stroke_cells(averages, found.rim, witnesses, self.settings.faint))

    def _nothing(self):
        return self.road_points.window(self.road, 0, 0).records, np.empty(0), np.empty(0)

    def _handed_out(self, found, mask, least=None):
        """Records of the window itself in painted cells, brighter than `least` of their cell, and the mask's pixels."""
        records, cell = found.records[found.own], found.cell[found.own]
        kept = np.flatnonzero(mask.ravel().take(cell))
        if least is not None:
            kept = kept[Points(chosen(records, kept)).value > least.ravel().take(cell.take(kept))]
        if not self.masked:
            return chosen(records, kept), np.empty(0), np.empty(0)
        # the image spreads a point over its neighbours: a cell whose own points are dark is no marking
        mask.ravel()[cell] = False
        mask.ravel()[cell[kept]] = True
        return chosen(records, kept), *self._pixels(mask, found.grid)


@dataclass(frozen=True)
class _Cells:
    """A window with its halo in cells.

    grid : RoadGrid; records : of the points in it; cell : (N,) flat number of each point's cell
    own : slice, the records of the window itself; rim, edge : (rows, columns) m inwards from the rim of what was scanned, and from the road's edge
    """

    grid: RoadGrid
    records: object
    cell: np.ndarray
    own: slice
    rim: np.ndarray
    edge: np.ndarray
