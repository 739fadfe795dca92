"""Which road points are paint: thresholds on the intensity image, and back to the points; averages where a scanner is noisy."""

from __future__ import annotations

from dataclasses import replace
from os import PathLike

from ...common.progress import Progress
from ...execution.in_step import in_step
from ...execution.phase import THREADS, Executor, Phase
from ...intensity.correction import saturation_of
from ...intensity.scatter import WINDOW_UNITS, WINDOWS_PER_TASK, ScannerScatter, place_of, scanner_scatter, windows_of
from ...intensity.tiled_image import TiledImage
from ...io.geotiff import IntensityImage
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.records import COORDINATE_SCALE
from ...survey.store.road_points import RoadPoints
from .settings import MarkingSettings, PaintMethod
from .windows import PaintSource, paint_of_window, write_mask


def extract_markings(road_points: RoadPoints, image: IntensityImage, frame: RoadFrame, settings: MarkingSettings = MarkingSettings(),
                     progress: Progress = Progress(), mask_path: str | PathLike | None = None,
                     scatter: ScannerScatter | None = None) -> RoadPoints:
    """Road points, corrected or not, that lie on paint.

    Multi-thresholds after Guan et al. (2014) and the driving-line thesis (Waterloo, 2017); our own are the local level of asphalt, the treatment of
    gutters and patches, and the averages for noisy scanners.

    image : of the same points, in memory or on disk; a method on points needs it for the mask alone
    mask_path : where to write the mask of markings as GeoTIFF in the image's own pixels, or None
    scatter : result of `scanner_scatter` for these points, which an earlier stage looked for; None to look here

    Raises RoadExtractionError if the mask cannot be written.
    """
    if not road_points.has_corrected and (saturated := saturation_of(road_points).warning):
        progress.warn(saturated)
    if settings.method is None:
        paint = _extract_from_image(road_points, image, frame, settings, progress, scatter)
    else:
        paint = _extract_from_points(road_points, settings.method, progress)
    if mask_path:
        write_mask(mask_path, paint, image, frame)
    progress.info(f"Paint: {len(paint):,} of {len(road_points):,} road points lie on it.")
    return paint


def _extract_from_points(road_points: RoadPoints, method: PaintMethod, progress: Progress) -> RoadPoints:
    """Paint by a method that uses the points and not the image."""
    paint = RoadPoints.empty_like(road_points)
    roads = road_points.roads()
    for k, road in enumerate(roads):
        for records in method.paint_of(road_points, road, progress.part(k / len(roads), (k + 1) / len(roads))):
            paint.store.append(road, records)
    return paint


def _extract_from_image(road_points: RoadPoints, image: IntensityImage, frame: RoadFrame, settings: MarkingSettings, progress: Progress,
                        scatter: ScannerScatter | None) -> RoadPoints:
    """Paint by multi-thresholds on the image, and from averages where points are noisy."""
    executor: Executor = road_points.executor if isinstance(image, TiledImage) else THREADS
    source = PaintSource(road_points, image, frame, executor.folder)
    paint = replace(RoadPoints.empty_like(road_points), store=source.paint, has_spacing=True)
    if scatter is None:
        scatter, = in_step([scanner_scatter(road_points)], executor, progress.part(0.0, 0.1))
    length = WINDOW_UNITS * COORDINATE_SCALE
    progress.info(scatter.summary(length))
    if doubt := scatter.doubt(length):
        progress.warn(doubt)
    noisy = {road: sorted(scatter.noisy_windows(road)) for road in road_points.roads()}
    phase = Phase(paint_of_window, source, (settings, noisy, scatter.photographed > 0.0), lambda item: place_of(road_points, (*item, item[1] + 1)),
                  together=WINDOWS_PER_TASK, state=source.state)
    for index in executor.run(phase, windows_of(road_points), progress.part(0.1, 1.0)):
        paint.store.adopt(index, executor.folder)
    return paint
