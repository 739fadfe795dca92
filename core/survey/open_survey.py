"""Opening a survey: it is read by whoever does the work, or taken from where an earlier run put it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..execution.choice import ExecutionSettings, cluster_for, executor_for
from ..execution.keep import Keep
from ..execution.phase import THREADS, Executor
from ..io.crs import FOOT, US_SURVEY_FOOT, as_in_file, check_projected, crs_name, crs_note, parse_crs, unit_note
from ..lazy import pyproj
from .adjustment.adjust import adjust_passes, compare_carriageways, warnings_of_levels
from .adjustment.scanner_fit import lay_scanners
from .adjustment.trajectory_fit import fitted_trajectory
from .blocks import PointChoice, read_files
from .frame.road_frame import RoadFrame, build_frame, decimate_by_distance, runs_through
from .frame.row_table import SigmaAlong
from .las.point_fields import check_coloured, in_one_scale, intensity_source_of, without_intensity
from .las.reader import CloudHeader, read_headers, states_of
from .las.samples import FileSample, check_measured_once, coarse_coordinates, distinct_rows, may_overlap, sample_files, times_of, without_copies
from .own_track import check_own_track
from .store.records import COORDINATE_SCALE, SURVEY_POINT, point_dtype
from .store.section_store import SectionStore
from .survey import SHIPPED, Survey, SurveySettings, survey_in_file
from .trajectory.meaning import EARTH_RADIUS
from .trajectory.time_systems import SECONDS_PER_WEEK, align_time, unwrap_week, wrapped_week
from .trajectory.trajectory import Trajectory, refuse_standstill, reproject_trajectory
from .weights import FRAME, LAS, READING, STORE, TRAJECTORY, VEHICLE


def open_survey(paths: Sequence[str | Path | CloudHeader], trajectory: Trajectory, settings: SurveySettings = SurveySettings(),
                progress: Progress = Progress(), execution: ExecutionSettings = ExecutionSettings()) -> Survey:
    """Read a survey, or take what an earlier run read from the work folder.

    paths : LAS, LAZ or COPC files in any order, or their headers
    trajectory, settings, progress : as in `read_survey`
    execution : who runs the phases that read from the survey, and the work folder

    Returns Survey; closing its store ends everything that was started for it

    Raises RoadExtractionError as `read_survey`, and if the work folder or the cluster cannot be used.
    """
    cluster = cluster_for(execution, progress)
    executor: Executor = cluster or THREADS
    try:
        files = without_copies(read_headers(paths, progress.warn, settings.crs or trajectory.crs), progress.warn)
        executor = executor_for(sum(file.count for file in files), execution, progress, cluster)
        try:
            survey = _survey_of_run(executor, (files, trajectory, settings), progress)
        except OSError as error:
            raise executor.disk_error(error) from error
    except BaseException:
        executor.close()
        raise
    # what workers keep of reading is of no use to the stages that follow
    executor.forget()
    survey.executor, survey.store.at_close = executor, executor.close
    return survey


def _survey_of_run(executor, read, progress):
    """The survey, whose points lie where the workers of an executor see them, or in memory; from a work folder, where they lie there."""
    def read_here(progress):
        reading = executor
        if not executor.sees([Path(file.path).absolute() for file in read[0]]):
            progress.info("The workers do not see the point clouds where this computer does, which therefore reads them alone.")
            reading = Keep(THREADS, executor.work) if executor.work else THREADS
        return read_survey(*read, progress, reading, executor)

    if executor.work is None:
        return read_here(progress)
    survey = survey_in_file(str(executor.made(states_of(read[0]), read[1:], lambda progress: read_here(progress).contents(), progress)))
    survey.files = read[0]
    facts = {name: getattr(survey, name) for name in SHIPPED if name != "counts"}
    executor.stand_on("what follows", {
        "the lines of the roads": facts.pop("frame"), "the height of the trajectory above the road": facts.pop("sensor_height"),
        "the displacements of the passes": facts.pop("moves"), "its scanners or its density": (facts, survey.store.section_length)}, progress)
    return survey


# Reading a survey: its points are read once and projected into the road frame, and checked against the trajectory.


def read_survey(files: list[CloudHeader], trajectory: Trajectory, settings: SurveySettings = SurveySettings(),
                progress: Progress = Progress(), reading: Executor = THREADS, ordering: Executor = THREADS) -> Survey:
    """Read point clouds once and project every point into the road frame.

    files : headers of LAS, LAZ or COPC files in any order
    trajectory : Trajectory in any CRS and time system
    reading, ordering : who reads the files, and who puts the points in order; the points lie in the folder of who reads

    Raises RoadExtractionError if a file cannot be read, the CRS is geographic or not in metres, or the trajectory does not overlap the cloud in space
    or time.
    """
    check_coloured(files, settings.intensity_from)
    samples = sample_files(files, reading)
    crs = _metric_crs(files, trajectory, settings, progress)
    trajectory = reproject_trajectory(trajectory, crs)
    refuse_standstill(trajectory)
    trajectory, time_note, has_time, week_ends = match_clocks(files, trajectory, settings, progress, samples)
    if time_note:
        some = trajectory.has_time and not has_time and any(np.ptp(one.times) > 0.0 for one in samples if len(one.times))
        (progress.warn if some else progress.info)(time_note)
    fitted = fitted_trajectory(files, trajectory, settings.scanner_field, progress)
    frame = _frame_of(files, fitted.trajectory, crs, has_time, time_note, progress)
    files, one_scale = in_one_scale(files, samples, settings.intensity_from, np.c_[trajectory.x, trajectory.y])
    intensity, rounding = _intensity_source(samples, settings, one_scale, progress)
    folder = reading.folder
    section = settings.section_length or section_length(files, frame)
    store = SectionStore(point_dtype(SURVEY_POINT, frame.farthest), section, folder)
    choice = PointChoice(settings.corridor, has_time, week_ends, settings.above_road, intensity)
    several_passes = settings.fit_passes and has_time and len(frame.passes) > len(frame.roads)
    read_at = READING.read_progress if several_passes else 1.0
    parts_at = read_at if folder is None else READING.parts_progress * read_at
    read = read_files(files, frame, store, choice, settings.block, reading, progress.part(0.0, parts_at))
    _say_left_out(files, frame, read, settings, progress)
    height = float(np.mean(list(read.heights.values())))
    feet = _check_height(height, crs, (fitted.seen, read.moved), progress)
    total, (scanner_field, scanners) = sum(file.count for file in files), read.summary.census.choose(settings.scanner_field)
    survey = Survey(files, frame, read.store, crs, read.heights, scanner_field, scanners, read.summary.brightest > read.summary.darkest, has_time,
                    dict(read=total, kept=read.store.count, outside=total - read.store.count), above_road=settings.above_road,
                    of_colours=intensity.field == "rgb")
    progress.info(f"Points read: {survey.counts['read']:,} from {len(files)} file(s), {store.count:,} near the road kept; {len(frame.roads)} "
                 f"road(s), {len(frame.passes)} pass(es), {len(survey.scanners)} scanner(s); sensor {height:.2f} m above the road.")
    _say_brightness(survey, intensity, settings, samples, progress)
    _tell_scanners_apart(survey, read, progress.part(parts_at, parts_at))
    if folder is not None:
        survey.executor = ordering
        survey.put_in_order(folder, ordering, progress.part(parts_at, read_at))
    left = _lay_scanners_and_passes(survey, several_passes, bool(feet), progress)
    _see_passes(survey, settings.fit_passes, progress)
    # what the user says overrules what lies beside the trajectory; what passes differ by is part of the same error
    if across := max(settings.trajectory_sigma or fitted.trajectory.sigma_across, float(np.hypot(fitted.sigma, rounding)), left):
        known = survey.frame.pass_sigma
        survey.frame.pass_sigma = {road: known.get(road, SigmaAlong.everywhere(0.0)).at_least(across) for road in range(len(frame.roads))}
    return survey


def _intensity_source(samples, settings, one_scale, progress):
    """How intensities are read, and m that coarse coordinates leave open across."""
    intensity, intensity_note = intensity_source_of(samples, settings.intensity_from)
    coarse_note, rounding = coarse_coordinates(samples)
    for note in filter(None, (coarse_note, one_scale, intensity_note)):
        progress.warn(note)
    return intensity, rounding


def _say_brightness(survey, intensity, settings, samples, progress):
    if intensity.field == "rgb":
        progress.info("The brightness of the points' colours is taken as their intensity.")
    if not survey.has_intensity and (note := without_intensity(survey.files, settings.intensity_from, list(samples[0].fields))):
        progress.warn(note)


def _lay_scanners_and_passes(survey, again, feet, progress):
    """Lay scanners on each other and, where they drive `again`, passes; m that clocks and the mounting of scanners leave open."""
    left = 0.0
    if survey.has_time and not feet:   # a scanner that rides three times too high sees three times too far
        read_at = READING.read_progress if again else 1.0
        left = max(check_own_track(survey, progress), lay_scanners(survey, progress.part(read_at, read_at)))
    if again:
        adjust_passes(survey, progress.part(READING.read_progress, 1.0))
    return left


def _metric_crs(files, trajectory, settings, progress):
    """WKT of the survey's CRS in metres, and a word on what is not as the files say."""
    crs = check_projected(files, settings.crs, trajectory.crs)
    if note := crs_note(files, settings.crs, crs):
        progress.warn(note)
    if not (units := as_in_file(crs)[1]).metric:
        progress.info(f"The survey is in {crs_name(crs)}. It is worked on in metres (x and y times {units.across:.9g}, heights times "
                      f"{units.up:.9g}), and the results are written in its own CRS.")
    return crs


def _frame_of(files, trajectory, crs, has_time, time_note, progress):
    """The road frame of a trajectory, which the clouds must lie at."""
    frame = build_frame(trajectory)
    frame.crs = crs
    frame.has_time = has_time
    for note in frame.notes:
        progress.info(note)
    for doubt in trajectory.doubts:
        progress.warn(doubt)
    if not has_time and len(frame.passes) > len(frame.roads):
        progress.warn(f"{time_note} Driven {len(frame.passes)} times over {len(frame.roads)} road(s), the passes are mixed, which blurs the map. "
                      "Export points and trajectory with their time.")
    _check_extent(files, frame, crs, trajectory.crs, progress)
    return frame


def _say_left_out(files, frame, read, settings, progress):
    """Refuse clouds that do not lie at the road, and tell of points that were not taken and of heights that change."""
    total, left = sum(file.count for file in files), read.summary
    if not read.store.count:
        raise RoadExtractionError(_no_overlap(files, frame, read, settings.corridor))
    if left.excluded:
        tell = progress.warn if left.excluded > READING.much_excluded * total else progress.info
        tell(f"{left.excluded:,} of {total:,} points were left out: they are withheld or classified as noise (LAS classes 7 and 18).")
    if left.without_time:
        progress.warn(f"{left.without_time:,} of {total:,} points were left out: the trajectory, which runs {_said_of_times(frame)}, has no position "
                      "at their gps_time. Give the whole trajectory.")
    for doubt in filter(None, (read.moved, read.holes, read.scales)):
        progress.warn(doubt)


def _check_height(height, crs, explained, progress):
    """Refuse or doubt a trajectory by its height above the road, m; a word where that is in feet, otherwise ""."""
    if abs(height) < VEHICLE.lowest_sensor:
        raise RoadExtractionError(f"The trajectory lies {height:.2f} m above the road; a scanner rides at least {VEHICLE.lowest_sensor} m above it. "
                                  "It seems to be a line on the road: choose the trajectory of the scanner.")
    if feet := unit_note(height, crs):
        progress.warn(feet)
    elif not any(explained) and not 0.0 < height < READING.highest_sensor:
        progress.warn(f"The trajectory lies {abs(height):.1f} m {'above' if height > 0 else 'below'} the road; scanners ride up to "
                      f"{READING.highest_sensor:g} m above it. Export cloud and trajectory with one kind of heights in metres.")
    return feet


def _see_passes(survey, fit_passes, progress):
    """Tell where roads and carriageways do not fit each other."""
    if len(survey.frame.roads) > 1:
        for warning in warnings_of_levels(survey.frame):
            progress.warn(warning)
        if fit_passes and survey.has_time:
            compare_carriageways(survey, progress.part(1.0, 1.0))


def section_length(files: list[CloudHeader], frame: RoadFrame) -> float:
    """Metres of station in a section of the store: the longest that holds no more than `section_points`, or the shortest.

    Threads work section by section, and Python lets several of them work at once only where arrays are large.
    """
    density = sum(file.count for file in files) / max(sum(road.length for road in frame.roads), 1.0)
    lengths = STORE.section_length, *READING.longer_sections
    return max((length for length in lengths if length * density <= READING.section_points), default=STORE.section_length)


def _sampled(survey, read, progress):
    """Times and places of the points sampled, each once, and a word on those that files have in common."""
    time, place = (np.concatenate(column) for column in zip((np.empty(0), np.empty((0, 3), np.int32)), *read.sampled))
    if len(survey.files) == 1 or not may_overlap(survey.files):
        return time, place
    rows = distinct_rows(time, place)
    if len(rows) < len(time):
        progress.info(f"About {100 * (1 - len(rows) / len(time)):.2g} % of the points that were read are copies of points in another file, as where "
                      "tiles overlap. Each point is used once.")
    return time[rows], place[rows]


def _tell_scanners_apart(survey, read, progress):
    """Where the points of one scanner, as it seems, are those of several by their scan lines, let the survey distinguish them."""
    from .estimation.adjustment import told_apart
    from .estimation.estimate import splitter_of
    from .estimation.samples import samples_of

    if not survey.has_time:
        return
    time, place = _sampled(survey, read, progress)
    if len(survey.files) > 1:
        check_measured_once(time, place * COORDINATE_SCALE)
    if len(survey.scanners) > 1 or not len(time) or time.min() == time.max():
        return
    samples = samples_of(time, place * COORDINATE_SCALE, np.zeros(len(time), np.uint8), np.zeros(3), read.slots.stride)
    survey.splitter = splitter_of(samples, progress)
    if survey.splitter is not None:
        survey.scanners = list(range(survey.splitter.poses.scanners))
        progress.info(told_apart(len(survey.scanners)))


def match_clocks(files: list[CloudHeader], trajectory: Trajectory, settings: SurveySettings,
                 progress: Progress, samples: Sequence[FileSample] | None = None) -> tuple[Trajectory, str, bool, bool]:
    """The trajectory in the time system of the cloud, and a note for the log, "" without one; RoadExtractionError if their times do not overlap.

    samples : of the files, where these were looked at before; None to look at their times here
    The last two say whether points can be assigned to passes by their time, and whether the GPS week ends during the scan.
    """
    if not trajectory.has_time:
        return trajectory, "The trajectory has no time; each point is assigned to the nearest position on it.", False, False
    looked_at = [(file, times_of(file)) for file in files if file.count] if samples is None else [(one.file, one.times) for one in samples]
    times = np.concatenate([np.empty(0), *(time for _, time in looked_at)])
    changes = [len(time) > 0 and time.max() > time.min() for _, time in looked_at]
    # of many points one time at least is another, if times were measured; where none of the files has two, each may be a frame with a time of its own
    missing = [file.path for (file, time), changing in zip(looked_at, changes) if not len(time) or not changing and (
        file.count >= LAS.values_for_step if any(changes) else times.max() == times.min())]
    if missing or not looked_at:
        which = "The point cloud has" if len(missing) == len(looked_at) else f"{len(missing)} of {len(looked_at)} files, such as {missing[0]}, have"
        return trajectory, f"{which} no gps_time that changes; each point is assigned to the nearest position on the trajectory.", False, False
    sampled = [(file.path, time) for file, time in looked_at]
    week_ends = wrapped_week((times.min(), times.max()))
    if week_ends:
        sampled = [(path, unwrap_week(time)) for path, time in sampled]
    spans = [(path, float(time.min()), float(time.max())) for path, time in sampled if len(time)]
    span = min(first for _, first, _ in spans), max(last for *_, last in spans)
    offset, note = align_time(trajectory.time, span, settings.time, files[0].adjusted_time)
    shifted = trajectory.shifted(offset)
    _refuse_other_clocks(spans, trajectory.time, offset, settings.time)
    return shifted, note, True, week_ends


def _refuse_other_clocks(spans, time, offset, system):
    """Refuse files, (path, first and last gps_time), that a trajectory covers only by another shift of its (N,) times than the offset of the others.

    Of files whose times are less than a week apart one may well be of another day.
    """
    start, end = np.nanmin(time) + offset - FRAME.clock_slack, np.nanmax(time) + offset + FRAME.clock_slack
    path, *ends = next((span for span in spans if span[1] <= end and span[2] >= start), spans[0])
    for other, first, last in spans:
        if first <= end and last >= start or first == last or abs(first - ends[0]) < SECONDS_PER_WEEK:
            continue
        try:
            align_time(time, (first, last), system)
        except RoadExtractionError:
            continue   # of a drive that the trajectory does not hold
        raise RoadExtractionError(f"The point clouds count time in two ways: {path} runs from {ends[0]:.1f} s to {ends[1]:.1f} s, and {other}, of "
                                  f"the same drive, from {first:.1f} s to {last:.1f} s. Export all of them with one kind of gps_time.")


def _said_of_times(frame):
    """From when to when a trajectory runs, and the longest of its gaps."""
    spans = sorted((p.time[0], p.time[-1]) for p in frame.passes)
    gaps = [(last, first) for (_, last), (first, _) in zip(spans[:-1], spans[1:]) if first - last > FRAME.clock_slack]
    gaps.sort(key=lambda gap: gap[0] - gap[1])
    named = "".join(f", not from {last:.1f} s to {first:.1f} s" for last, first in gaps[:READING.told_stretches])
    return f"from {spans[0][0]:.1f} s to {spans[-1][1]:.1f} s{named}{', …' if len(gaps) > READING.told_stretches else ''}"


def _check_extent(files, frame, crs, trajectory_crs, progress):
    """Refuse clouds, or a file of them, with coordinates of another kind than those of the trajectory, and tell of files beside it."""
    filled = [file for file in files if file.count]
    low, high = np.min([file.minimum for file in filled], axis=0), np.max([file.maximum for file in filled], axis=0)
    ways = [np.c_[p.x, p.y][decimate_by_distance(p.x, p.y, FRAME.track_step)] for p in frame.passes]
    x, y = (np.concatenate(ways) + frame.origin[:2]).T
    reach = FRAME.corridor
    away = [file for file in filled if not runs_through(file.minimum, file.maximum, x, y, reach)]
    if len(away) == len(filled):
        raise RoadExtractionError(f"The trajectory does not run through the point cloud: it covers x {x.min():.1f} to {x.max():.1f}, y {y.min():.1f} "
                                  f"to {y.max():.1f}, the cloud x {low[0]:.1f} to {high[0]:.1f}, y {low[1]:.1f} to {high[1]:.1f}. "
                                  f"{_other_coordinates(low, high, x, y, crs, reach) or _other_crs(crs, trajectory_crs)}")
    for file in away:
        if advice := _other_coordinates(np.array(file.minimum), np.array(file.maximum), x, y, crs, reach):
            raise RoadExtractionError(f"The coordinates of {file.path} are of another kind than those of the other point clouds, through which the "
                                      f"trajectory runs. {advice}")
    if away:
        progress.info(f"{len(away)} of {len(filled)} files lie beside the trajectory and give no points, such as {away[0].path}.")


def _other_crs(crs, trajectory_crs):
    """The advice where cloud and trajectory do not overlap, and nothing shows why."""
    if trajectory_crs:
        return f"Both were taken to be in {crs_name(crs)}. Check that they belong to one survey, and the CRS of the trajectory."
    cloud = f"The cloud is in {crs_name(crs)}, the trajectory" if crs else "The trajectory"
    return f"{cloud} carries no CRS. Give it the one its coordinates are in (Import trajectory does), and check that both belong to one survey."


def _other_coordinates(low, high, x, y, crs, reach):
    """The advice where cloud or trajectory seem to be exchanged, in feet or degrees, counted from the centre of the earth, or of another zone."""
    apart, feet = not runs_through(low, high, x, y, TRAJECTORY.longest_step), (FOOT, US_SURVEY_FOOT)
    in_feet = ("The cloud's coordinates are the trajectory's in feet: give each the CRS that it is in, or convert the cloud to metres."
               if as_in_file(crs)[1].metric else
               "The trajectory was taken to be in feet like the cloud, and seems to be in metres: give it its own CRS, as Import trajectory does.")
    to_map = "reproject it to a projected CRS, such as the UTM zone of the survey."
    checks = (
        (lambda: runs_through(low, high, y, x, reach),
         "In one of them x and y are exchanged: export the cloud with the easting as x, or name the trajectory's columns the other way round."),
        (lambda: any(runs_through(low * foot, high * foot, x, y, reach) for foot in feet), in_feet),
        (lambda: any(runs_through(low, high, x * foot, y * foot, reach) for foot in feet),
         "The trajectory's coordinates are the cloud's in feet: give it its CRS, as Import trajectory does, or convert it to metres."),
        (lambda: np.abs([low[:2], high[:2]]).max() <= 180 and (high - low)[:2].max() < 1.0, f"The cloud's coordinates look like degrees: {to_map}"),
        (lambda: EARTH_RADIUS[0] < np.linalg.norm((low + high) / 2) < EARTH_RADIUS[1], f"The cloud's coordinates are earth-centred: {to_map}"),
        (lambda: apart and crs and runs_through(low, high, *_angles_exchanged(x, y, crs), reach),
         "The trajectory's longitude and latitude are exchanged: name its columns the other way round, and run again."),
        (lambda: apart,
         f"They lie more than {TRAJECTORY.longest_step / 1000:.0f} km apart, as in two zones of a projection: reproject them to one CRS."))
    return next((advice for check, advice in checks if check()), "")


def _angles_exchanged(x, y, crs):
    """x and y of a trajectory, had its longitude and latitude been exchanged."""
    to_degrees = pyproj.Transformer.from_crs(crs, parse_crs(crs).geodetic_crs, always_xy=True)
    lon, lat = to_degrees.transform(x, y)
    return to_degrees.transform(lat, lon, direction="INVERSE")


def _no_overlap(files, frame, read, corridor):
    if read.summary.excluded == sum(file.count for file in files):
        return "All points are withheld or classified as noise (LAS classes 7 and 18). Give the cloud as it was before its classification."
    if read.summary.without_time:
        return (f"No point was measured while the trajectory was driven: {read.summary.without_time} points lie outside its time, "
                f"{_said_of_times(frame)}. Set the trajectory's time system, or check that both belong to one survey.")
    return (f"No point lies within {corridor:.0f} m of the trajectory and near its height. Check that cloud and trajectory belong to one survey and "
            "use one CRS.")
