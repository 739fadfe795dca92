"""The whole chain in one call: from a survey to a road map.

The stages are the same functions that the single algorithms call, handed on in
memory; nothing but the intensity image, which is one of the results, goes to disk.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..common.features import Features
from ..common.layer_rows import LayerRows
from ..common.parallel import trim_heap
from ..common.progress import Progress
from ..corrections.apply import correct_edges, correct_lanes, correct_marking_lines, correct_markings
from ..corrections.corrections import Corrections, corrections_from_features
from ..driving.driving_lines import DrivingSettings, estimate_lanes, make_driving_lines
from ..execution.choice import ExecutionSettings
from ..execution.in_step import in_step
from ..execution.keep import Keep
from ..execution.kept_run import WINDOW, KeptRun
from ..execution.phase import digest
from ..execution.tasks import code_digest
from ..intensity.correction import AsphaltLook, IntensitySettings, intensity_corrected
from ..intensity.image import ImageSettings, check_fits, make_intensity_image, pieces_of_image
from ..io.crs import check_projected
from ..markings.cross_section.sections import EdgeSections
from ..markings.lines.fit import MarkingLineSettings, named_by_estimate, named_by_lines, traced_lines
from ..markings.objects.cluster import ClusterSettings, cluster_markings
from ..markings.outliers import OutlierSettings, remove_outliers
from ..markings.paint.extract import extract_markings
from ..markings.paint.settings import MarkingSettings
from ..road.common.curb_limits import CurbSettings
from ..road.common.curb_points import CurbPoints
from ..road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from ..road.edges.fit import EdgeSettings
from ..road.edges.road_edges import RoadEdges
from ..road.scanlines.candidates import ScanlineBoundarySettings
from ..road.scanlines.section_planes import ScanlineSettings
from ..road.surface.extract import SurfaceSettings, extract_road_surface
from ..road.surface.ground_grid import MeasuredGround
from ..road.surface.road_surface import SurfaceOutlines
from ..survey.density import CubeDensity
from ..survey.frame.road_frame import RoadFrame
from ..survey.las.reader import CloudHeader, read_headers, states_of
from ..survey.open_survey import SurveySettings, open_survey
from ..survey.store.records import ROAD_POINT, SURVEY_POINT
from ..survey.trajectory.trajectory import Trajectory, reproject_trajectory
from ..survey.weights import FRAME


@dataclass(frozen=True)
class RoadMapSettings:
    """The settings of every stage, and whether intensity is corrected first."""

    survey: SurveySettings = SurveySettings()
    execution: ExecutionSettings = ExecutionSettings()
    boundary_method: str = BoundarySettings.method
    curbs: CurbSettings = CurbSettings()
    planes: ScanlineSettings = ScanlineSettings()
    scanlines: ScanlineBoundarySettings = ScanlineBoundarySettings()
    edges: EdgeSettings = EdgeSettings()
    surface: SurfaceSettings = SurfaceSettings()
    correct: bool = True
    intensity: IntensitySettings = IntensitySettings()
    image: ImageSettings = ImageSettings()
    markings: MarkingSettings = MarkingSettings()
    outliers: OutlierSettings = OutlierSettings()
    clusters: ClusterSettings = ClusterSettings()
    lines: MarkingLineSettings = MarkingLineSettings()
    driving: DrivingSettings = DrivingSettings()

    @property
    def boundaries(self) -> BoundarySettings:
        """The settings of boundary detection."""
        return BoundarySettings(self.boundary_method, self.curbs, self.scanlines, self.planes)


@dataclass
class RoadMap:
    """All results of the chain."""

    frame: RoadFrame
    crs: str   # WKT, "" where unknown
    curb_points: CurbPoints
    edges: RoadEdges
    surface: SurfaceOutlines
    road_points: Any   # RoadPoints, there until `free` is called
    boundary_differences: RoadEdges | None = None   # RoadEdges, where the two boundary methods disagree; None if one method was used
    length_by_method: dict = field(default_factory=dict)   # {method: metres of measured curb}
    intensity_report: Any = None   # of the correction, None without it
    markings: Features | None = None   # layers; None where not made
    marking_lines: Features | None = None
    driving_lines: Features | None = None
    lanes: Features | None = None
    curve_elements: Features | None = None
    without_paint: str = ""   # the reason why there are no markings, "" where there are
    seconds: dict = field(default_factory=dict)   # {stage: run time in s}
    counts: dict = field(default_factory=dict)   # numbers of curb points, road points and marking points
    survey_facts: dict = field(default_factory=dict)   # numbers of files, scanners, passes, roads and points, and the sensor heights
    density: tuple[CubeDensity, ...] = ()   # CubeDensity of the points near the road and of the road points
    paint: Any = None   # RoadPoints with clusters, there until `free` is called; None where there are no markings
    country: str = DrivingSettings.country   # whose design code the curves are checked against
    corrections: Corrections = field(default_factory=Corrections)   # of an analyst, and which of them something was found for
    free: Callable[[], None] = lambda: None   # frees the disk space of the points, where no later run wants them

    def layer(self, name: str) -> Features | None:
        """The result of a name, such as "edges", as a layer in map coordinates; None where it was not made."""
        result = getattr(self, name)
        return result.to_features(self.frame) if isinstance(result, LayerRows) else result


def make_road_map(paths: Sequence[str | Path], trajectory: Trajectory, image_path: str | Path | None,
                  settings: RoadMapSettings = RoadMapSettings(), progress: Progress = Progress(), corrections: Features | None = None,
                  kept: KeptRun = WINDOW) -> RoadMap:
    """Run the chain.

    paths : point cloud files
    image_path : where the intensity image is written (.tif), by GDAL; None for no file, which the chain does without
    settings : RoadMapSettings, those of every stage
    corrections : the layer CORRECTIONS of an analyst, or None; each is made where its kind of line was found, so that what follows builds on it
    kept : what the last run gave, if it is wanted; stages that would give the same are not run again

    Raises RoadExtractionError if a stage cannot use its input. A cloud without intensity still yields edges and surface; `without_paint` then
        gives the reason why markings are missing.
    """
    files = read_headers(paths, given=settings.survey.crs or trajectory.crs)
    stages = Stages(progress, Extent.expected(files, trajectory, settings.survey.crs), settings.boundary_method,
                    () if settings.correct else ("asphalt", "intensity"))
    if kept.wanted and _may_be_kept(files, settings.execution) and kept.take():
        stages.kept = kept
    survey, ground = None, None
    try:
        survey, ground = stages.run("survey", "Reading the survey …", _open, files, trajectory, settings.survey, settings.execution,
                                    stages.kept is not None,
                                    depends=lambda: (code_digest(), states_of(files), trajectory, settings.survey, settings.execution))
        if stages.kept is not None:
            stages.kept.phases, stages.kept.free = survey.executor, survey.store.close
        return _map_of(survey, ground, image_path, settings, stages, corrections)
    except BaseException:
        if stages.kept is not None:
            if survey is not None:
                survey.executor.release()
            stages.kept.phases = None   # what it asked for does not tell how much a whole run asks for
            stages.kept.give_back()
        elif survey is not None:
            survey.store.close()
        raise


def _open(files, trajectory, settings, execution, remembers, progress):
    """The survey, whose executor `remembers` results or not, and its ground, which is measured where it is asked for."""
    survey = open_survey(files, trajectory, settings, progress, execution)
    if remembers:
        survey.executor = Keep(survey.executor)
    return survey, MeasuredGround(survey)


def _may_be_kept(files, execution):
    """Whether a run may be kept: where no work folder does so, no workers of others are held, and as much disk space is left as it takes."""
    taken = sum(file.count for file in files) * (SURVEY_POINT.itemsize + ROAD_POINT.itemsize)
    return not execution.work_folder and not execution.scheduler and shutil.disk_usage(tempfile.gettempdir()).free > 2 * taken


def _map_of(survey, ground, image_path, settings, stages, corrections):
    """The map of an open survey, whose store the road points keep."""
    map_corrections = Corrections() if corrections is None else corrections_from_features(corrections, survey.frame, survey.crs)
    extent = Extent(survey.store.count / 1e6, sum(road.length for road in survey.frame.roads) / 1e3)
    stages.plan(extent, () if survey.has_intensity else INTENSITY_STAGES)
    if survey.has_intensity:
        # before hours of work, not after
        check_fits(*_span(survey), settings.image)
    curbs = stages.run("curbs", "Detecting curbs …", find_curb_points, survey, settings.boundaries, ground=ground, depends=settings.boundaries)
    # what workers keep of the curbs is of no use to the stages that follow
    survey.executor.forget()
    boundaries = stages.run("edges", "Fitting road edges …", draw_boundaries, curbs, survey.frame, settings.edges,
                            survey=survey, ground=ground, depends=settings.edges)
    surface_between = partial(extract_road_surface, settings=settings.surface, ground=ground)
    made = stages.run("surface", "Extracting the road surface …", surface_between, survey, boundaries.edges, depends=settings.surface)
    asphalt = None
    if survey.has_intensity and settings.correct:
        # of the edges as detected, so that a corrected one changes no intensity elsewhere
        asphalt = stages.run("asphalt", "Looking at the asphalt …", AsphaltLook.of, made[0], survey.frame, settings.intensity,
                             depends=settings.intensity)
    edges = correct_edges(boundaries.edges, survey.frame, map_corrections)
    changed = edges is not boundaries.edges
    road_points, surface = stages.run("corrected", "Extracting the road surface between corrected edges …" if changed else "",
                                      partial(surface_between, survey, edges) if changed else lambda progress: made,
                                      depends=map_corrections.asked("edge"))
    del ground, surface_between
    facts = dict(files=len(survey.files), scanners=len(survey.scanners), passes=len(survey.frame.passes),
                 roads=len(survey.frame.roads), sensor_height=survey.sensor_height, **survey.counts)
    result = RoadMap(survey.frame, survey.crs, boundaries.curb_points, edges, surface, road_points,
                     boundaries.differences, boundaries.length_by_method, seconds=stages.seconds, survey_facts=facts,
                     density=road_points.density, country=settings.driving.country, corrections=map_corrections)
    result.free = stages.kept.give_back if stages.kept is not None else lambda: result.road_points.close()
    result.counts.update(curb_points=len(boundaries.curb_points), road_points=len(road_points))
    if survey.has_intensity:
        _paint(result, image_path, settings, stages, survey.executor, asphalt)
    else:
        result.without_paint = ("The point cloud has no intensity (all values are the same), so paint cannot be told from "
                                "asphalt: no markings, marking lines or driving lines were made.")
        stages.progress.warn(result.without_paint)
    lost = map_corrections.unmatched
    if len(map_corrections):
        stages.progress.info(f"Corrections: {len(map_corrections)}, of which {len(map_corrections) - len(lost)} were made.")
    if lost:
        stages.progress.warn(f"Corrections that match nothing in this run any more ({len(lost)}): "
                             + "; ".join(correction.described() for correction in lost) + ".")
    return result


def _span(survey):
    """Metres east and north over which the sections lie that have points."""
    places = [survey.frame.road(road).to_map(np.array(survey.store.sections(road)) * survey.store.section_length, 0.0)
              for road in survey.store.roads()]
    return tuple(float(np.ptp(np.concatenate(axis))) for axis in zip(*places))


def _paint(result, image_path, settings, stages, executor, asphalt):
    """Intensity, markings and lines, added to the result."""
    frame = result.frame
    pieces = scatter = None
    if settings.correct:
        scatter = asphalt.scatter
        (result.road_points, result.intensity_report), pieces = stages.run(
            "intensity", "Correcting intensity …", _corrected, result.road_points, frame, settings.image, asphalt, depends=settings.image)
    # without what they keep of the intensities they take a quarter less memory for the image
    executor.forget()
    image = stages.run("image", "Making the intensity image …", make_intensity_image,
                       result.road_points, settings.image, path=image_path, pieces=pieces, depends=(settings.correct, settings.image),
                       renewed=True, again=lambda image: image.write(image_path) if image_path else None)
    executor.forget()
    # the file is a result; markings are extracted from the image in memory
    points = stages.run("markings", "Extracting markings …", extract_markings,
                        result.road_points, image, frame, settings.markings, scatter=scatter, depends=settings.markings)
    executor.forget()
    if stages.kept is None:
        image.close()
    result.counts["marking_points"] = len(points)
    if len(points):
        points = stages.run("outliers", "Removing outliers …", remove_outliers, points, settings.outliers,
                            executor=executor, depends=settings.outliers)
    result.counts["marking_points_kept"] = len(points)
    markings, clustered = stages.run("clusters", "Clustering markings …", cluster_markings, points, frame, settings.clusters,
                                     executor=executor, depends=settings.clusters)
    result.paint = clustered
    executor.forget()
    markings = correct_markings(markings, result.corrections)
    beside, edge_places = stages.follows("beside", partial(_beside, result.edges, frame))
    readings = result.corrections.taken(frame)

    def named(lines, progress=Progress()):
        """Lines with the names that their estimate gives them, and that."""
        estimates = estimate_lanes(lines, frame, settings.driving, progress, markings, beside, result.road_points, readings)
        return named_by_estimate(lines, estimates), estimates

    traced = stages.run("lines", "Fitting marking lines …", traced_lines, clustered, markings, frame, settings.lines, edges=beside,
                        road_points=result.road_points, depends=(result.corrections.asked("marking", ["delete"]), settings.lines))
    lines, estimates = stages.run("lanes", "Estimating lanes …", named, traced, depends=(readings, settings.driving))
    drawn = correct_marking_lines(lines, frame, result.corrections, edge_places)

    def corrected():
        """Those of the lines as an analyst corrected them, and the layers of lines and of the markings that they name."""
        of_lines, of_lanes = (lines, estimates) if drawn is lines else named(drawn)
        return of_lines, of_lanes, of_lines.to_features(frame), named_by_lines(markings, of_lines).to_features(frame)

    lines, estimates, result.marking_lines, result.markings = stages.follows("named", corrected, result.corrections.asked("marking"))
    driving, elements, lanes = stages.run("driving", "Making driving lines …", make_driving_lines, lines, frame, settings.driving,
                                          edges=beside, road_points=result.road_points, estimates=estimates, depends=settings.driving)
    executor.release()
    driving, elements, lanes = correct_lanes(driving, elements, lanes, frame, result.corrections, settings.driving.usual_width, edge_places)
    result.driving_lines, result.curve_elements = driving.to_features(frame), elements.to_features(frame)
    result.lanes = lanes.to_features(frame)
    if not len(result.markings):
        result.without_paint = "No paint was found on this road, so there are no marking lines" \
            + (": driving lines lead between its borders." if len(driving) else " and no driving lines.")
        stages.progress.warn(result.without_paint)


def _beside(edges, frame):
    """EdgeSections of road edges, and (V, 3) local places along these."""
    edges = edges.densified(frame)
    return EdgeSections.of(edges), np.c_[edges.course.x, edges.course.y, edges.course.z]


def _corrected(road_points, frame, settings, asphalt, progress):
    """What `correct_intensity` gives, and the pieces of image that are looked for in the same points, in one phase."""
    works = [intensity_corrected(road_points, frame, asphalt, progress), pieces_of_image(road_points, settings)]
    return in_step(works, road_points.executor, progress)


# The stages of the road map, run one after the other: their shares of the progress bar and their run times.

# source: `make bench`: relative run time of each stage (per million points, per kilometre of road)
STAGE_COSTS = dict(survey=(0.31, 0.1), profiles=(0.105, 4.6), scanlines=(0.2, 8.0), edges=(0.0, 0.04), surface=(0.05, 1.5), asphalt=(0.02, 0.35),
                   corrected=(0.0, 0.0), intensity=(0.017, 0.35), image=(0.047, 1.1), markings=(0.017, 2.4), outliers=(0.018, 0.26),
                   clusters=(0.019, 1.1), lines=(0.0045, 0.39), lanes=(0.0025, 0.21), driving=(0.0025, 0.4))
MIN_STAGE_COST = 0.01   # derived: of a stage without work
LAZ_READ_COST, LAS_READ_COST = 1.0, 0.42   # source: relative run time of reading a point of a LAZ and of a LAS file


@dataclass(frozen=True)
class Extent:
    """The amount of work, as far as it is known."""

    points: float   # millions of points
    length: float   # kilometres of road
    plain: float = 0.0   # share of the points in uncompressed files

    @classmethod
    def expected(cls, files: Sequence[CloudHeader], trajectory: Trajectory, crs: str = "") -> Extent:
        """The extent by file headers and trajectory, before any point is read; `crs` is that of clouds that carry none.

        Raises RoadExtractionError if the CRS is unsuitable, as in `open_survey`.
        """
        trajectory = reproject_trajectory(trajectory, check_projected(files, crs, trajectory.crs))
        filled = [file for file in files if file.count]
        points = sum(file.count for file in filled)
        places = np.column_stack([trajectory.x, trajectory.y])
        low, high = (np.array([getattr(file, name)[:2] for file in filled]).reshape(-1, 2) for name in ("minimum", "maximum"))
        south_west, north_east = low.min(axis=0, initial=np.inf) - FRAME.corridor, high.max(axis=0, initial=-np.inf) + FRAME.corridor
        within = ((places > south_west) & (places < north_east)).all(axis=1)
        driven = np.hypot(*np.diff(places, axis=0).T)[within[1:]].sum()
        return cls(points / 1e6, float(driven) / 1e3, sum(file.count for file in filled if file.chunk == 1) / max(points, 1))

    def cost(self, name: str, method: str) -> float:
        """Relative run time of a stage, with the given method of boundary detection."""
        if name == "curbs":
            return sum(self.cost(detection, method) for detection in ("profiles", "scanlines") if method in (detection, "both"))
        of_points, of_length = STAGE_COSTS[name]
        if name == "survey":
            of_points *= LAZ_READ_COST + self.plain * (LAS_READ_COST - LAZ_READ_COST)
        return MIN_STAGE_COST + of_points * self.points + of_length * self.length


INTENSITY_STAGES = ("asphalt", "intensity", "image", "markings", "outliers", "clusters", "lines", "lanes", "driving")   # need it
STAGE_NAMES = ("survey", "curbs", "edges", "surface", "corrected", *INTENSITY_STAGES)


class Stages:
    """Runs the stages of a road map one after the other, measures their run times, s, and moves the bar, of which the fraction `done` is done.

    `method` : of boundary detection; `left_out` : stages that will not run.
    """

    def __init__(self, progress: Progress, extent: Extent, method: str, left_out: Sequence[str] = ()):
        self.progress, self.done, self.method = progress, 0.0, method
        self.kept: KeptRun | None = None   # what the last run gave
        self._digest = ""   # of all that the stages so far depend on
        self.seconds: dict[str, float] = {}
        self.waiting = list(STAGE_NAMES)
        self.plan(extent, left_out)

    def plan(self, extent: Extent, left_out: Sequence[str] = ()) -> None:
        """Divide the rest of the bar among the remaining stages by a better known extent; some will not run."""
        self.waiting = [name for name in self.waiting if name not in left_out]
        costs = {name: extent.cost(name, self.method) for name in self.waiting}
        self.shares = {name: (1.0 - self.done) * cost / max(sum(costs.values()), 1e-9) for name, cost in costs.items()}

    def run(self, name: str, title: str, function: Callable[..., Any], *arguments: Any, depends: Any = None,
            again: Callable[[Any], None] = lambda result: None, renewed: bool = False, **options: Any) -> Any:
        """Run a stage: log its title, if any, call the function with its part of the progress, and return its result, or that of the last run.

        depends : plain values that the result depends on beside the stages before, or a function that gives them; None for a result that is not kept
        again : what is done with a result that is used again
        renewed : whether the function takes what the last run gave as `before`, where that is another
        """
        share = self.shares[name]
        if title:
            self.progress.info(title)
        began = time.perf_counter()
        kept = None if depends is None else self.kept
        if kept is not None:
            self._digest = digest((self._digest, name, depends() if callable(depends) else depends))
        if kept is not None and kept.known(name, self._digest):
            self.progress.info("The result of the last run is used again.")
            result = kept.result(name)
            again(result)
        else:
            if renewed and kept is not None:
                options["before"] = kept.before(name)
            result = function(*arguments, progress=self.progress.part(self.done, self.done + share), **options)
            if kept is not None:
                kept.keep(name, self._digest, result)
        trim_heap()
        self.seconds[name] = time.perf_counter() - began
        self.done += share
        self.waiting.remove(name)
        self.progress.report(self.done)
        return result

    def follows(self, name: str, function: Callable[[], Any], depends: Any = ()) -> Any:
        """What follows soon from the results of the stages so far and from plain values that it `depends` on, or what did so in the last run."""
        if self.kept is None:
            return function()
        self._digest = digest((self._digest, name, depends))
        if not self.kept.known(name, self._digest):
            self.kept.keep(name, self._digest, function())
        return self.kept.result(name)
