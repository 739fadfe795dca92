"""A survey opened for work: its points read once and placed in the road frame."""

from dataclasses import dataclass, field

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..common.setting import check_limits, setting
from ..io.crs import check_projected, crs_note, parse_crs
from .adjustment.adjust import adjust_passes
from .clock_check import check_clock
from .frame.road_frame import CORRIDOR, build_frame
from .ingest import KEPT_ABOVE_ROAD, KEPT_BELOW_ROAD, SurveyReader, unwrap_week
from .las.parallel_reader import ParallelCloudReader
from .las.reader import POINTS_PER_BLOCK, read_headers
from .scanners import numbers_by_value
from .store.records import COORDINATE_SCALE, SURVEY_POINT, Points, point_dtype
from .store.section_store import MEMORY_LIMIT, SECTION_LENGTH, SectionStore
from .trajectory.reprojection import reproject_trajectory
from .trajectory.time_systems import align_time, wrapped_week

ROAD_HEIGHT_STEP = 0.25     # m between the stations at which the height of the road is taken to choose points by
INGEST_PROGRESS = 0.7          # of the work where passes are laid on each other afterwards
SUSPICIOUS_SENSOR_HEIGHT = 5.0, 15.0       # m above the road: higher than survey vehicles carry a sensor, and what 1.5 to 4.5 m are in feet


@dataclass(frozen=True)
class SurveySettings:
    """How a survey is read.

    corridor : m either side of the road's reference line
    scanner_field : "automatic", "scanner_channel" or "point_source_id"
    time : how the trajectory counts time: automatic, gps, adjusted, week or day
    crs : WKT for clouds that carry none
    fit_passes : whether passes over one road that lie apart are laid on each other
    """

    corridor: float = setting(CORRIDOR, 5.0, 100.0, "The corridor", "m")
    scanner_field: str = "automatic"
    time: str = "automatic"
    crs: str = ""
    fit_passes: bool = True
    section_length: float = SECTION_LENGTH
    memory_limit: int = MEMORY_LIMIT
    block: int = POINTS_PER_BLOCK

    def __post_init__(self):
        check_limits(self)


@dataclass
class Survey:
    """Points in their sections, the road frame, and what was found out on the way.

    `sensor_height` is metres from the trajectory down to the road, one value per pass. `moves` are the PassMoves by which
    points and tracks were laid on those of other passes, None where they are as they were measured.
    """

    files: list
    frame: object
    store: SectionStore
    crs: str
    sensor_height: dict
    scanner_field: str
    scanners: list
    has_intensity: bool
    has_time: bool
    counts: dict = field(default_factory=dict)
    moves: object = None

    def __post_init__(self):
        self.store.finish = self._finished

    def window(self, road, start, end):
        """Points of a road with start <= station < end and near its height, scanners numbered from 0."""
        return self.store.window(road, start, end)

    def section(self, road, number):
        """Points of one section near the road's height."""
        return Points(self.store.section(road, number))

    def _finished(self, road, records):
        """Number the scanners of a section's records from 0; tells which lie near the road's height, None where all do."""
        if self.scanner_field is None:
            records["scanner"] = 0
        else:
            numbers = records["source" if self.scanner_field == "point_source_id" else "scanner"]
            records["scanner"] = numbers_by_value(self.scanners, int(numbers.max()) + 1).take(numbers)
        # most are near beyond doubt: the others are looked at one by one
        z = records["z"]
        first, nodes = self._heights(road, records["s"].min() * COORDINATE_SCALE, records["s"].max() * COORDINATE_SCALE)
        doubtful = np.flatnonzero((z < (nodes.max() - KEPT_BELOW_ROAD) / COORDINATE_SCALE + 1)
                                  | (z > (nodes.min() + KEPT_ABOVE_ROAD) / COORDINATE_SCALE - 1))
        at = records["s"][doubtful] * COORDINATE_SCALE / ROAD_HEIGHT_STEP - first
        k = at.astype(np.int64)
        h = z[doubtful] * COORDINATE_SCALE - (nodes[k] + (at - k) * (nodes[k + 1] - nodes[k]))
        near = np.ones(len(records), bool)
        near[doubtful] = (h > -KEPT_BELOW_ROAD) & (h < KEPT_ABOVE_ROAD)
        return None if near[doubtful].all() else near

    def _heights(self, road, start, end):
        """`road_height` at fixed stations about a stretch, so that many points cost little: number of the first, heights."""
        first = int(np.floor(start / ROAD_HEIGHT_STEP))
        return first, self.road_height(road, np.arange(first, int(np.floor(end / ROAD_HEIGHT_STEP)) + 2) * ROAD_HEIGHT_STEP)

    def road_height(self, road, s):
        """(N,) local z of the road under the vehicle's track at stations of a road: a prior, good to decimetres."""
        return self.frame.track_height(road, s, self.sensor_height)


def open_survey(paths, trajectory, settings=SurveySettings(), progress=Progress()):
    """Read point clouds once and place every point in the road frame.

    Parameters
    ----------
    paths : LAS, LAZ or COPC files in any order
    trajectory : Trajectory in the clouds' CRS (any time system)

    Raises
    ------
    RoadExtractionError
        If a file cannot be read, the CRS is geographic or not in metres, or the
        trajectory does not overlap the cloud in space or time.
    """
    files = read_headers(paths)
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
        progress.warn(f"The trajectory drives {len(frame.passes)} times over {len(frame.roads)} road(s), and without time in the points and the "
                      "trajectory the passes are mixed: whatever they differ by blurs the map. Export both with gps_time, or process "
                      "the files of each drive with its own part of the trajectory.")
    _check_extent(files, frame, crs, trajectory.crs)
    store = SectionStore(point_dtype(SURVEY_POINT, frame.farthest), settings.section_length, settings.memory_limit)
    reader = SurveyReader(frame, store, settings.corridor, has_time, week_ends)
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
    if not crs and SUSPICIOUS_SENSOR_HEIGHT[0] < height < SUSPICIOUS_SENSOR_HEIGHT[1]:
        progress.warn(f"The sensor seems to ride {height:.1f} m above the road, as if cloud and trajectory were in feet, and no CRS tells their "
                      "unit: everything is measured in metres, so curbs and markings would be missed. If they are in feet, convert both to metres "
                      "(in a metric CRS); if they are not, set CRS.")
    scanner_field, scanners = reader.census.choose(settings.scanner_field)
    survey = Survey(files, frame, store, crs, reader.heights, scanner_field, scanners,
                    reader.brightest > reader.darkest, has_time,
                    dict(read=total, kept=store.count, outside=total - store.count))
    progress.info(f"Points read: {total:,} from {len(files)} file(s), {store.count:,} near the road kept; "
                 f"{len(frame.roads)} road(s), {len(frame.passes)} pass(es), {len(scanners)} scanner(s); "
                 f"sensor {height:.2f} m above the road.")
    if has_time:
        check_clock(survey, progress)
    if again:
        adjust_passes(survey, progress.part(INGEST_PROGRESS, 1.0))
    return survey


def match_clocks(files, trajectory, settings, progress):
    """The trajectory in the cloud's time system, a note, whether time can be used, whether the GPS week ends during the scan."""
    if not trajectory.has_time:
        return trajectory, "The trajectory has no time; each point is placed at the nearest foot on it.", False, False
    if not all(file.has_time for file in files):
        return trajectory, "The point cloud has no gps_time; each point is placed at the nearest foot on the trajectory.", False, False
    span = _time_span(files)
    if span is None:
        return trajectory, "All gps_time values are equal; each point is placed at the nearest foot on the trajectory.", False, False
    span, week_ends = span
    offset, note = align_time(trajectory.time, span, settings.time, files[0].adjusted_time)
    return trajectory.shifted(offset), note, True, week_ends


def _time_span(files):
    """((first, last) gps_time in samples of every file, whether the week ends between), or None where time stands still.

    Whole files are not read for it: points at several places of each, its last
    among them, give the span to within the overlap test's needs.
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
    """What to try where cloud and trajectory lie apart."""
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
