"""Opening a survey: its points are read once and projected into the road frame."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..common.setting import check_limits, setting
from ..execution.choice import ExecutionSettings, cluster_for, executor_for
from ..execution.phase import Executor, Recipe
from ..execution.plain import digest, read_plain, write_plain
from ..execution.threads import THREADS
from ..execution.work_folder import Heard, code_digest
from ..io.crs import check_projected, crs_note, parse_crs
from .adjustment.adjust import adjust_passes
from .clock_check import check_clock
from .frame.build import build_frame
from .frame.road import CORRIDOR
from .ingest import KEPT_ABOVE_ROAD, KEPT_BELOW_ROAD, SurveyReader, unwrap_week
from .las.luminance import INTENSITY_SOURCES, check_coloured, without_intensity
from .las.parallel_reader import ParallelCloudReader
from .las.reader import POINTS_PER_BLOCK, CloudHeader, read_headers
from .las.scanners import numbers_by_value
from .store.records import COORDINATE_SCALE, SURVEY_POINT, Points, point_dtype
from .store.section_store import MEMORY_LIMIT, SECTION_LENGTH, SectionStore
from .trajectory.reprojection import reproject_trajectory
from .trajectory.time_systems import align_time, wrapped_week

if TYPE_CHECKING:
    from .adjustment.corrections import PassCorrections
    from .estimation.interleaved import ScannerSplitter
    from .frame.road_frame import RoadFrame
    from .trajectory.trajectory import Trajectory

ROAD_HEIGHT_STEP = 0.25      # m between the stations at which points are compared with the height of the road
INGEST_PROGRESS = 0.7        # of the work, where the passes are adjusted afterwards
SURVEY_FOLDER, SURVEY_FILE = "survey", "survey.npz"   # of a survey that other processes open
SHIPPED = ("frame", "crs", "sensor_height", "scanner_field", "scanners", "has_intensity", "has_time", "counts", "moves", "above_road")
LOWEST_SENSOR = 0.5          # m above the road: no scanner rides lower, but lines and places drawn on the road lie within
TOLD_APART = "The points are of two scanners that no field tells apart; they were told apart by where their scan lines lead."
SUSPICIOUS_SENSOR_HEIGHT = 5.0, 15.0  # m: higher than any survey vehicle; 1.5 to 4.5 m expressed in feet


@dataclass(frozen=True)
class SurveySettings:
    """Settings of reading a survey.

    corridor : m either side of the reference line of a road
    scanner_field : "automatic", "scanner_channel" or "point_source_id"
    time : time system of the trajectory: automatic, gps, adjusted, week or day
    crs : WKT for clouds that carry none
    intensity_from : "intensity", or "rgb" for the luminance of the colours
    fit_passes : whether passes over one road are adjusted to each other
    above_road : m above the road up to which points are kept; the map needs what hides a curb, an inventory what hangs over the road
    section_length : m of station in a section of the store
    memory_limit : bytes of points in memory; more go to a temporary file
    block : points decoded at a time
    """

    corridor: float = setting(CORRIDOR, 5.0, 100.0, "The corridor", "m")
    scanner_field: str = "automatic"
    time: str = "automatic"
    crs: str = ""
    intensity_from: str = INTENSITY_SOURCES[0]
    fit_passes: bool = True
    above_road: float = setting(KEPT_ABOVE_ROAD, 1.0, 100.0, "The height above the road", "m")
    section_length: float = SECTION_LENGTH
    memory_limit: int = MEMORY_LIMIT
    block: int = POINTS_PER_BLOCK

    def __post_init__(self) -> None:
        check_limits(self)
        if self.intensity_from not in INTENSITY_SOURCES:
            raise RoadExtractionError(f"Intensity cannot be taken from “{self.intensity_from}”; choose one of {', '.join(INTENSITY_SOURCES)}.")


@dataclass
class Survey:
    """An open survey: points by section, the road frame and statistics of the whole survey.

    files : headers of the point clouds
    frame : RoadFrame
    store : SectionStore of the points
    crs : WKT, "" where unknown
    sensor_height : {pass number: metres from the trajectory down to the road}
    scanner_field : LAS field that identifies the scanners, None if there is one
    scanners : values of that field, see `ScannerCensus.choose`
    has_intensity : whether intensities differ
    has_time : whether points are assigned to passes by their time
    counts : numbers of points read, kept and outside
    moves : PassCorrections by which points and tracks were moved, None where they are as measured
    above_road : metres above the road up to which points are returned
    executor : Executor of the phases that read from this survey
    folder : where the points lie for other processes, None where they are this one's alone
    splitter : tells two scanners apart that no field distinguishes; None where there is no need
    """

    files: list[CloudHeader]
    frame: RoadFrame
    store: SectionStore
    crs: str
    sensor_height: dict[int, float]
    scanner_field: str | None
    scanners: list[Any]
    has_intensity: bool
    has_time: bool
    counts: dict[str, int] = field(default_factory=dict)
    moves: PassCorrections | None = None
    above_road: float = KEPT_ABOVE_ROAD
    executor: Executor = THREADS
    folder: Path | None = None
    splitter: ScannerSplitter | None = None

    def __post_init__(self) -> None:
        self.store.finish = self._finished

    def recipe(self, folder: Path) -> Recipe:
        """Move the points to a folder, unless they are there, and say how other processes open the survey."""
        if self.folder is None:
            own = folder / SURVEY_FOLDER
            own.mkdir()
            self.move_to(own)
        return Recipe("survey.open_survey:survey_in_folder", dict(folder=str(self.folder)))

    def move_to(self, folder: Path) -> None:
        """Keep the points in an empty folder from now on, from where `survey_in_folder` opens the survey, here and elsewhere."""
        self.store.move_to(folder)
        write_plain(folder / SURVEY_FILE, {name: getattr(self, name) for name in SHIPPED})
        self.folder = folder

    def stretch(self, road: int, start: float, end: float) -> str:
        """What messages call the road between two stations (m), with the files whose points may lie there."""
        s = np.linspace(start, end, 5)
        x, y = self.frame.to_map(road, s, 0.0)
        near = [Path(file.path).name for file in self.files if file.count and file.minimum[0] - CORRIDOR <= x.max() and x.min() <= file.maximum[0]
                + CORRIDOR and file.minimum[1] - CORRIDOR <= y.max() and y.min() <= file.maximum[1] + CORRIDOR]
        return f"road {road}, {start:.0f} to {end:.0f} m" + (f" ({', '.join(near)})" if near else "")

    def window(self, road: int, start: float, end: float) -> Points:
        """Points of a road with start <= station < end (m) near its height, scanners numbered from 0."""
        return self.store.window(road, start, end)

    def section(self, road: int, number: int) -> Points:
        """Points of one section near the height of the road."""
        return Points(self.store.section(road, number))

    def _finished(self, road, records):
        """Number the scanners of the records of a section from 0; (N,) bool of those near the height of the road, None for all."""
        if self.splitter is not None:
            records["scanner"] = self.splitter.numbers(records["time"], np.stack([records[name] for name in "xyz"], axis=1) * COORDINATE_SCALE)
        elif self.scanner_field is None:
            records["scanner"] = 0
        else:
            numbers = records["source" if self.scanner_field == "point_source_id" else "scanner"]
            records["scanner"] = numbers_by_value(self.scanners, int(numbers.max()) + 1).take(numbers)
        # only records near the limits are compared with the height at their own station
        z = records["z"]
        first, nodes = self._heights(road, records["s"].min() * COORDINATE_SCALE, records["s"].max() * COORDINATE_SCALE)
        doubtful = np.flatnonzero((z < (nodes.max() - KEPT_BELOW_ROAD) / COORDINATE_SCALE + 1)
                                  | (z > (nodes.min() + self.above_road) / COORDINATE_SCALE - 1))
        at = records["s"][doubtful] * COORDINATE_SCALE / ROAD_HEIGHT_STEP - first
        k = at.astype(np.int64)
        h = z[doubtful] * COORDINATE_SCALE - (nodes[k] + (at - k) * (nodes[k + 1] - nodes[k]))
        near = np.ones(len(records), bool)
        near[doubtful] = (h > -KEPT_BELOW_ROAD) & (h < self.above_road)
        return None if near[doubtful].all() else near

    def _heights(self, road, start, end):
        """`road_height` at fixed stations from start to end: number of the first, heights."""
        first = int(np.floor(start / ROAD_HEIGHT_STEP))
        return first, self.road_height(road, np.arange(first, int(np.floor(end / ROAD_HEIGHT_STEP)) + 2) * ROAD_HEIGHT_STEP)

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """(N,) local z of the road under the track at (N,) stations, accurate to decimetres."""
        return self.frame.track_height(road, s, self.sensor_height)


def survey_in_folder(folder: str) -> Survey:
    """The survey that `Survey.recipe` put into a folder, without the files that it was read from."""
    return Survey(files=[], store=SectionStore.opened(Path(folder)), folder=Path(folder), **read_plain(Path(folder) / SURVEY_FILE))


def open_survey(paths: Sequence[str | Path], trajectory: Trajectory, settings: SurveySettings = SurveySettings(),
                progress: Progress = Progress(), execution: ExecutionSettings = ExecutionSettings()) -> Survey:
    """Read a survey, or take what an earlier run read from the work folder.

    Parameters
    ----------
    paths, trajectory, settings, progress : as in `read_survey`
    execution : who runs the phases that read from the survey, and the work folder

    Returns
    -------
    Survey; closing its store ends everything that was started for it

    Raises
    ------
    RoadExtractionError
        As `read_survey`, and if the work folder or the cluster cannot be used.
    """
    work, cluster = execution.work, cluster_for(execution, progress)
    try:
        survey = _kept_survey(work, paths, trajectory, settings, progress) if work else read_survey(paths, trajectory, settings, progress)
    except BaseException:
        if cluster is not None:
            cluster.close()
        raise
    survey.executor = executor_for(survey.store.count, execution, progress, cluster)
    survey.store.at_close = survey.executor.close
    return survey


def _kept_survey(work, paths, trajectory, settings, progress):
    """The survey of a work folder; it is read into it where it is not there."""
    files = read_headers(paths)
    states = [(os.path.abspath(file.path), os.path.getsize(file.path), os.stat(file.path).st_mtime_ns) for file in files]
    name = f"survey-{digest((code_digest(), states, trajectory, settings))}"
    try:
        found = work.finished(name)
        if found is not None:
            folder, messages = found
            survey = survey_in_folder(str(folder))
            survey.files = files
            progress.info("The points were read by an earlier run and are taken from the work folder. It said:")
            for kind, text in messages:
                (progress.warn if kind == "warn" else progress.info)(text)
            progress.report(1.0)
            return survey
        heard = Heard(progress)
        survey = read_survey(paths, trajectory, settings, heard)
        survey.move_to(work.begin(name))
        work.finish(name, survey.folder, heard.messages)
        return survey
    except OSError as error:
        raise work.error(error) from error


def read_survey(paths: Sequence[str | Path], trajectory: Trajectory, settings: SurveySettings = SurveySettings(),
                progress: Progress = Progress()) -> Survey:
    """Read point clouds once and project every point into the road frame.

    Parameters
    ----------
    paths : LAS, LAZ or COPC files in any order
    trajectory : Trajectory in any CRS and time system
    settings : SurveySettings
    progress : Progress

    Returns
    -------
    Survey

    Raises
    ------
    RoadExtractionError
        If a file cannot be read, the CRS is geographic or not in metres, or the
        trajectory does not overlap the cloud in space or time.
    """
    files, coloured = read_headers(paths), settings.intensity_from == "rgb"
    if coloured:
        check_coloured(files)
    crs = check_projected(files, settings.crs, trajectory.crs)
    if note := crs_note(files, settings.crs, crs):
        progress.warn(note)
    trajectory = reproject_trajectory(trajectory, crs)
    trajectory, time_note, has_time, week_ends = match_clocks(files, trajectory, settings, progress)
    if time_note:
        progress.info(time_note)
    frame = build_frame(trajectory)
    frame.crs = crs
    frame.has_time = has_time
    for note in frame.notes:
        progress.info(note)
    if not has_time and len(frame.passes) > len(frame.roads):
        progress.warn(f"The trajectory drives {len(frame.passes)} times over {len(frame.roads)} road(s), and as {_without_time(files, trajectory)} "
                      "the passes are mixed: whatever they differ by blurs the map. Export points and trajectory with their time, or process "
                      "the files of each drive with its own part of the trajectory.")
    _check_extent(files, frame, crs, trajectory.crs)
    store = SectionStore(point_dtype(SURVEY_POINT, frame.farthest), settings.section_length, settings.memory_limit)
    reader = SurveyReader(frame, store, settings.corridor, has_time, week_ends, settings.above_road, coloured)
    again = settings.fit_passes and has_time and len(frame.passes) > len(frame.roads)
    reader.read(files, settings.block, progress.part(0.0, INGEST_PROGRESS) if again else progress)
    total = sum(file.count for file in files)
    if not store.count:
        raise RoadExtractionError(_no_overlap(files, frame, reader, settings.corridor))
    if reader.unplaced_time:
        progress.warn(f"{reader.unplaced_time:,} of {total:,} points were left out: their gps_time is missing or lies outside the "
                      "trajectory's.")
    if reader.uneven:
        progress.warn("The trajectory does not keep to one height above the road: half of the points under the vehicle lie more than "
                      f"{reader.uneven[0]:.2f} m off {reader.uneven[1]:.2f} m below it, and curbs are missed for that. Its heights may be in feet "
                      "where the cloud's are in metres, or not be those that the cloud was made with: export both anew from one solution.")
    height = float(np.mean(list(reader.heights.values())))
    if abs(height) < LOWEST_SENSOR:
        raise RoadExtractionError(
            f"The trajectory lies {height:.2f} m above the road; a scanner rides at least {LOWEST_SENSOR} m above it. "
            "It seems to be a line on the road, such as a driving line of a map, and not where the scanner was: choose the "
            "trajectory that the navigation system recorded. If it is that of the vehicle's wheels, add the height of the scanner to its heights.")
    if not crs and SUSPICIOUS_SENSOR_HEIGHT[0] < height < SUSPICIOUS_SENSOR_HEIGHT[1]:
        progress.warn(f"The sensor seems to ride {height:.1f} m above the road, as if cloud and trajectory were in feet, and no CRS tells their "
                      "unit: everything is measured in metres, so curbs and markings would be missed. If they are in feet, convert both to metres "
                      "(in a metric CRS); if they are not, set CRS.")
    scanner_field, scanners = reader.census.choose(settings.scanner_field)
    survey = Survey(files, frame, store, crs, reader.heights, scanner_field, scanners,
                    reader.brightest > reader.darkest, has_time,
                    dict(read=total, kept=store.count, outside=total - store.count), above_road=settings.above_road)
    progress.info(f"Points read: {total:,} from {len(files)} file(s), {store.count:,} near the road kept; "
                 f"{len(frame.roads)} road(s), {len(frame.passes)} pass(es), {len(scanners)} scanner(s); "
                 f"sensor {height:.2f} m above the road.")
    if coloured:
        progress.info("The brightness of the points' colours is taken as their intensity.")
    if not survey.has_intensity and (note := without_intensity(files, settings.intensity_from)):
        progress.warn(note)
    if has_time and len(scanners) == 1:
        at = INGEST_PROGRESS if again else 1.0
        _tell_scanners_apart(survey, reader, progress.part(at, at))
    if has_time:
        check_clock(survey, progress)
    if again:
        adjust_passes(survey, progress.part(INGEST_PROGRESS, 1.0))
    return survey


def _tell_scanners_apart(survey, reader, progress):
    """Where the points of one scanner, as it seems, are those of two by their scan lines, let the survey tell them apart."""
    from .estimation.estimate import splitter_of
    from .estimation.samples import samples_of

    time, place = (np.concatenate(column) for column in zip(*reader.sampled))
    if time.min() == time.max():
        return
    samples = samples_of(time, place * COORDINATE_SCALE, np.zeros(len(time), np.uint8), np.zeros(3), reader.slots.stride)
    survey.splitter = splitter_of(samples, progress)
    if survey.splitter is not None:
        survey.scanners = [0, 1]
        progress.info(TOLD_APART)


def match_clocks(files: list[CloudHeader], trajectory: Trajectory, settings: SurveySettings,
                 progress: Progress) -> tuple[Trajectory, str, bool, bool]:
    """Convert the trajectory to the time system of the cloud.

    Parameters
    ----------
    files : headers of the clouds
    trajectory : Trajectory
    settings : SurveySettings, of which `time` is used
    progress : Progress

    Returns
    -------
    trajectory : in the time system of the cloud
    note : for the log, "" without one
    has_time : whether points can be assigned to passes by their time
    week_ends : whether the GPS week ends during the scan

    Raises
    ------
    RoadExtractionError
        If the times of cloud and trajectory do not overlap.
    """
    if not trajectory.has_time:
        return trajectory, "The trajectory has no time; each point is assigned to the nearest position on it.", False, False
    if not all(file.has_time for file in files):
        return trajectory, "The point cloud has no gps_time; each point is assigned to the nearest position on the trajectory.", False, False
    span = _time_span(files)
    if span is None:
        return trajectory, "All gps_time values are equal; each point is assigned to the nearest position on the trajectory.", False, False
    span, week_ends = span
    offset, note = align_time(trajectory.time, span, settings.time, files[0].adjusted_time)
    return trajectory.shifted(offset), note, True, week_ends


def _without_time(files, trajectory):
    """What lacks the time that would tell the passes apart."""
    if not trajectory.has_time:
        return "the trajectory has no time"
    if not all(file.has_time for file in files):
        return "the points have no gps_time"
    return "all points have the same gps_time"


def _time_span(files):
    """((first, last) gps_time, whether the week ends in between), of samples of every file; None if all times are equal.

    The samples include the last points of each file.
    """
    with ParallelCloudReader(("gps_time",)) as readers:
        samples = [time[np.isfinite(time)] for file in files if file.count for time in readers.times(file)]
    times = np.concatenate(samples)
    if not len(times) or times.max() <= times.min():
        return None
    week_ends = wrapped_week((times.min(), times.max()))
    times = unwrap_week(times) if week_ends else times
    return (float(times.min()), float(times.max())), week_ends


def _check_extent(files, frame, crs, trajectory_crs):
    low = np.min([file.minimum for file in files if file.count], axis=0)
    high = np.max([file.maximum for file in files if file.count], axis=0)
    x = np.concatenate([p.x for p in frame.passes]) + frame.origin[0]
    y = np.concatenate([p.y for p in frame.passes]) + frame.origin[1]
    reach = CORRIDOR
    if not ((x > low[0] - reach) & (x < high[0] + reach) & (y > low[1] - reach) & (y < high[1] + reach)).any():
        raise RoadExtractionError(
            f"The trajectory does not run through the point cloud. The cloud covers x {low[0]:.1f} to {high[0]:.1f}, "
            f"y {low[1]:.1f} to {high[1]:.1f}; the trajectory runs over x {x.min():.1f} to {x.max():.1f}, "
            f"y {y.min():.1f} to {y.max():.1f}. {_what_to_try(low, high, x, y, crs, trajectory_crs, reach)}")


def _what_to_try(low, high, x, y, crs, trajectory_crs, reach):
    """The advice of the error message, where cloud and trajectory do not overlap."""
    if ((y > low[0] - reach) & (y < high[0] + reach) & (x > low[1] - reach) & (x < high[1] + reach)).any():
        return "The trajectory's x and y are exchanged: name its columns the other way round, or swap them."
    if (np.abs(high[:2]) <= 180).all() and (np.abs(low[:2]) <= 180).all() and (high - low)[:2].max() < 1.0:
        return "The cloud's coordinates look like degrees: reproject it to a projected CRS, such as the UTM zone of the survey."
    if trajectory_crs:
        return f"Both were taken to be in {parse_crs(crs).name}. Check that they belong to one survey, and the CRS of the trajectory."
    cloud = f"The cloud is in {parse_crs(crs).name}, the trajectory" if crs else "The trajectory"
    return f"{cloud} carries no CRS. Give it the one its coordinates are in (Import trajectory does), and check that both belong to one survey."


def _no_overlap(files, frame, reader, corridor):
    if reader.unplaced_time:
        starts, ends = [p.time[0] for p in frame.passes], [p.time[-1] for p in frame.passes]
        times = f"{min(starts):.1f} s to {max(ends):.1f} s"
        return (f"No point was measured while the trajectory was driven: {reader.unplaced_time} points lie outside "
                f"its time, {times}. Set the trajectory's time system, or check that both belong to one survey.")
    return (f"No point lies within {corridor:.0f} m of the trajectory and near its height. Check that "
            "cloud and trajectory belong to one survey and use one CRS.")
