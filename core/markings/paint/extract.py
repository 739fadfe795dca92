"""Which road points are paint: thresholds on the intensity image, and back to the points."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from os import PathLike

import numpy as np

from ...common.progress import Progress
from ...execution.phase import Executor, Phase
from ...execution.threads import THREADS
from ...intensity.correction import saturation_of
from ...intensity.tiled_image import IntensityRaster, TiledImage
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.columns import Columns
from ...survey.store.records import COORDINATE_SCALE, join_columns
from ...survey.store.road_points import RoadPoints
from ...survey.store.section_store import SectionStore
from ..road_grid import CELL_UNITS
from .mask import Burn, burn_points, marking_mask
from .peaks import points_on_peaks
from .point_segments import points_in_segments
from .scatter import ScannerScatter
from .settings import MarkingSettings
from .windows import THRESHOLD_WINDOW, Bins, PaintSource, WindowExtractor, bins_about, levels_of_windows, paint_of_windows, place_of, windows_of

WINDOWS_PER_TASK = 4     # windows of 20 m that a worker process is given together: at everyday density a fifth of a second of its time


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
    source = PaintSource(road_points, image, frame)
    executor: Executor = road_points.executor if isinstance(image, TiledImage) and image.folder is not None else THREADS
    alone = executor.folder is None   # the threads of this process share what neighbouring windows need
    paint = replace(RoadPoints.empty_like(road_points), has_spacing=True)
    windows = [(road, windows_of(road_points, road)) for road in road_points.roads()]
    scatter = ScannerScatter.of(road_points, [(road, window) for road, some in windows for window in some], executor, progress.part(0.0, 0.1))
    progress.info(scatter.summary(THRESHOLD_WINDOW * CELL_UNITS * COORDINATE_SCALE))
    noisy = {road: sorted(scatter.noisy_windows(road)) for road, _ in windows}
    masked, size = burn is not None, 1 if alone else WINDOWS_PER_TASK
    stretches = [(road, first, min(first + size, some[-1] + 1)) for road, some in windows for first in some[::size]]
    known: dict[int, dict[int, Bins]] = {road: {} for road, _ in windows}
    if alone:
        source.kept = {road: WindowExtractor(source, (road, some[0], some[-1] + 1), settings, noisy[road], masked) for road, some in windows}
    else:
        phase = Phase(levels_of_windows, source, (settings, noisy), lambda item: place_of(road_points, item))
        for (road, first, _), found in zip(stretches, executor.run(phase, stretches, progress.part(0.1, 0.4))):
            known[road].update(enumerate(found, first))
    phase = Phase(paint_of_windows, source, (settings, noisy, masked), lambda item: place_of(road_points, item[0]))
    items = [(stretch, {} if alone else bins_about(stretch, known[stretch[0]])) for stretch in stretches]
    sections = _SectionWriter(paint.store)
    for (road, *_), painted in zip(stretches, executor.run(phase, items, progress.part(0.1 if alone else 0.4, 1.0))):
        for columns, x, y in painted:
            sections.add(road, Columns(columns, road_points.store.dtype))
            if burn is not None:
                burn(x, y)
    sections.finish()
    return paint


class _SectionWriter:
    """Puts points, which come road by road and in the order of the road, into the sections of a store."""

    def __init__(self, store: SectionStore):
        self.store = store
        self.key: tuple[int, int] | None = None
        self.parts: list[Columns] = []

    def add(self, road: int, records: Columns) -> None:
        """Add Columns that follow all those added before."""
        section = np.floor(records["s"] * COORDINATE_SCALE / self.store.section_length).astype(np.int64)
        cuts = np.flatnonzero(np.diff(section)) + 1
        for first, end in zip([0, *cuts], [*cuts, len(section)]):
            if end > first:
                if (road, section[first]) != self.key:
                    self.finish()
                    self.key = road, int(section[first])
                self.parts.append(records[first:end])

    def finish(self) -> None:
        """Put the section that is not complete yet."""
        if self.parts and self.key is not None:
            self.store.put(*self.key, join_columns(self.parts, self.store.dtype))
        self.parts = []
