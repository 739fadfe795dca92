"""A survey opened for work: its points read once and placed in the road frame."""

from dataclasses import dataclass, field

import numpy as np

from ..errors import RoadExtractionError
from ..progress import Progress
from .crs import check_projected, crs_note, parse_crs, reproject_trajectory
from .point_cloud import BLOCK, read_blocks, read_headers
from .points import SURVEY_POINT, UNIT, Points, chosen, to_units
from .road_frame import CORRIDOR, build_frame
from .scanners import ScannerCensus
from .section_store import MEMORY_LIMIT, SECTION_LENGTH, SectionStore
from .sensor_height import DEFAULT_HEIGHT, drops_on_track, first_estimate, sensor_heights
from .time_systems import WEEK, align_time, wrapped_week

ABOVE, BELOW = 3.5, 4.0  # m about the road kept: vehicles that hide a curb above, ditches below
# m more that are stored: the height of the road is rough while reading, and exact when points are handed out,
# so that what is handed out does not depend on which file came first
MARGIN = 1.5
WAITING = 4_000_000    # points kept back at most until that height is known
CLOCK_SLACK = 1.0      # s that a cloud may begin before or end after the trajectory


@dataclass(frozen=True)
class SurveySettings:
    """How a survey is read.

    corridor : m either side of the road's reference line
    scanner_field : "automatic", "scanner_channel" or "point_source_id"
    time : how the trajectory counts time: automatic, gps, adjusted, week or day
    crs : WKT for clouds that carry none
    """

    corridor: float = CORRIDOR
    scanner_field: str = "automatic"
    time: str = "automatic"
    crs: str = ""
    section_length: float = SECTION_LENGTH
    memory_limit: int = MEMORY_LIMIT
    block: int = BLOCK

    def __post_init__(self):
        if not 5.0 <= self.corridor <= 100.0:
            raise RoadExtractionError(f"The corridor is {self.corridor} m; it must be between 5 and 100 m either side of the trajectory.")


@dataclass
class Survey:
    """Points in their sections, the road frame, and what was found out on the way.

    `sensor_height` is metres from the trajectory down to the road, one value per pass.
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

    def window(self, road, start, end):
        """Points of a road with start <= station < end and near its height, scanners numbered from 0."""
        return self._handed_out(road, self.store.window(road, start, end).records)

    def section(self, road, number):
        """Points of one section near the road's height."""
        return self._handed_out(road, self.store.section(road, number))

    def _handed_out(self, road, records):
        h = records["z"] * UNIT - self.road_height(road, records["s"] * UNIT)
        records = chosen(records, (h > -BELOW) & (h < ABOVE))
        if self.scanner_field is None:
            records["scanner"] = 0
        elif self.scanner_field == "point_source_id":
            records["scanner"] = np.searchsorted(self.scanners, records["source"])
        else:
            records["scanner"] = np.searchsorted(self.scanners, records["scanner"])
        return Points(records)

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
        progress.say(time_note)
    frame = build_frame(trajectory)
    frame.crs = crs
    frame.has_time = has_time
    for note in frame.notes:
        progress.say(note)
    _check_extent(files, frame, crs, trajectory.crs)
    store = SectionStore(SURVEY_POINT, settings.section_length, settings.memory_limit)
    reader = _Reader(frame, store, settings, has_time, week_ends)
    total, done = sum(file.count for file in files), 0
    for file in files:
        for block in read_blocks(file.path, settings.block):
            reader.take(block, file)
            done += len(block)
            progress.at(done / total)
    reader.finish()
    if not store.count:
        raise RoadExtractionError(_no_overlap(files, frame, reader))
    if reader.unplaced_time:
        progress.warn(f"{reader.unplaced_time:,} of {total:,} points were left out: their gps_time is missing or lies outside the "
                      "trajectory's.")
    scanner_field, scanners = reader.census.choose(settings.scanner_field)
    heights = sensor_heights(frame, store, reader.drop)
    survey = Survey(files, frame, store, crs, heights, scanner_field, scanners,
                    reader.brightest > 0, has_time,
                    dict(read=total, kept=store.count, outside=total - store.count))
    progress.say(f"{total:,} points read from {len(files)} file(s), {store.count:,} near the road kept; "
                 f"{len(frame.roads)} road(s), {len(frame.passes)} pass(es), {len(scanners)} scanner(s); "
                 f"sensor {np.mean(list(heights.values())):.2f} m above the road.")
    return survey


class _Reader:
    """Places blocks of points; the coarse height limits come from the first points on the track."""

    def __init__(self, frame, store, settings, has_time, week_ends=False):
        self.frame, self.store, self.settings, self.has_time = frame, store, settings, has_time
        self.week_ends = week_ends
        self.census = ScannerCensus()
        self.brightest = 0
        self.drop = None          # metres from track to road, rough
        self.waiting = []         # (road, records) until it is known
        self.samples = []
        self.unplaced_time = 0
        self.starts = np.array([p.time[0] for p in frame.passes])
        self.ends = np.array([p.time[-1] for p in frame.passes])

    def take(self, block, file):
        x, y, z = (np.asarray(block[c], float) for c in ("x", "y", "z"))
        names = set(block.point_format.dimension_names)
        good = np.isfinite(x) & np.isfinite(y) & np.isfinite(z)
        if "withheld" in names:
            good &= np.asarray(block["withheld"]) == 0
        lx, ly, lz = self.frame.to_local(x, y, z)
        # Absurd coordinates would overflow the 0.1 mm integers
        good &= (np.abs(lx) < 2e5) & (np.abs(ly) < 2e5) & (np.abs(lz) < 2e4)
        intensity = np.asarray(block["intensity"])
        self.brightest = max(self.brightest, int(intensity.max(initial=0)))
        source = np.asarray(block["point_source_id"])
        time = np.asarray(block["gps_time"], float) if "gps_time" in names else np.zeros(len(x))
        time = _carried_on(time) if self.week_ends else time
        channel = np.asarray(block["scanner_channel"]) if "scanner_channel" in names else np.zeros(len(x), np.uint8)
        if len(x):
            self.census.add("point_source_id", source, time)
            if "scanner_channel" in names:
                self.census.add("scanner_channel", channel, time)
        pass_number, road, s, d = self._place(lx, ly, time, good)
        for number in np.unique(road[road >= 0]):
            m = np.flatnonzero(road == number)
            records = np.empty(len(m), SURVEY_POINT)
            records["time"] = time[m]
            records["x"], records["y"], records["z"] = to_units(lx[m]), to_units(ly[m]), to_units(lz[m])
            records["s"], records["d"] = to_units(s[m]), to_units(d[m])
            records["intensity"], records["source"] = intensity[m], source[m]
            records["pass_number"], records["scanner"] = pass_number[m], channel[m]
            records["returns"] = np.asarray(block["return_number"])[m] | (np.asarray(block["number_of_returns"])[m] << 4)
            self._keep(int(number), records)

    def _place(self, x, y, time, good):
        """Pass, road, station and offset of local places; road -1 where there is none."""
        count = len(x)
        pass_number, road = np.zeros(count, np.uint16), np.full(count, -1)
        s, d = np.full(count, np.nan), np.full(count, np.nan)
        if not self.has_time:
            rows = np.flatnonzero(good)
            road[rows], s[rows], d[rows] = self.frame.locate_nearest(x[rows], y[rows], self.settings.corridor)
            for p in self.frame.passes[::-1]:
                pass_number[road == p.road] = p.number
            return pass_number, road, s, d
        owner = self._owner(time)
        self.unplaced_time += int(np.count_nonzero(good & (owner < 0)))
        for p in self.frame.passes:
            rows = np.flatnonzero(good & (owner == p.number))
            if not len(rows):
                continue
            line = self.frame.road(p.road)
            # far points are dropped before the exact foot is sought
            px, py, _ = p.position(time[rows])
            reach = 2.0 * self.settings.corridor
            rows = rows[np.hypot(x[rows] - px, y[rows] - py) < reach]
            s0 = p.station_at(time[rows])
            px, py, _ = p.position(time[rows])
            h = line.heading(s0)
            s0 = s0 + (x[rows] - px) * np.cos(h) + (y[rows] - py) * np.sin(h)
            s[rows], d[rows] = line.locate(x[rows], y[rows], s0, self.settings.corridor)
            found = rows[np.isfinite(s[rows])]
            road[found], pass_number[found] = p.road, p.number
        return pass_number, road, s, d

    def _owner(self, time):
        """Pass that drove at each time: within it, or within a second of its ends; -1 where none did."""
        k = np.clip(np.searchsorted(self.starts, time + CLOCK_SLACK, side="right") - 1, 0, None)
        # between two passes that follow on each other the earlier one ends where the later begins
        k = np.where((k > 0) & (time < self.starts[k]) & (time <= self.ends[np.maximum(k - 1, 0)]), k - 1, k)
        inside = (time >= self.starts[k] - CLOCK_SLACK) & (time <= self.ends[k] + CLOCK_SLACK)
        return np.where(inside, k, -1)

    def _keep(self, road, records):
        if self.drop is not None:
            self._store(road, records)
            return
        self.waiting.append((road, records))
        self.samples += [drops[::7] for _, drops in drops_on_track(self.frame, road, records)]
        if sum(map(len, self.samples)) > 20000 or sum(len(kept) for _, kept in self.waiting) > WAITING:
            self.finish()

    def _store(self, road, records):
        ground = self.frame.track_height(road, records["s"] * UNIT) - self.drop
        h = records["z"] * UNIT - ground
        self.store.append(road, chosen(records, (h > -BELOW - MARGIN) & (h < ABOVE + MARGIN)))

    def finish(self):
        """Settle the rough height of the road and store what waited for it."""
        if self.drop is None:
            drop = first_estimate(np.concatenate(self.samples)) if self.samples else None
            self.drop = DEFAULT_HEIGHT if drop is None else drop
            waiting, self.waiting, self.samples = self.waiting, [], []
            for road, records in waiting:
                self._store(road, records)


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


def _carried_on(time):
    """Seconds of the week, those after the week's end carried on."""
    return np.where(time < WEEK / 2, time + WEEK, time)


def _time_span(files):
    """((first, last) gps_time in samples of every file, whether the week ends between), or None where time stands still.

    Whole files are not read for it: blocks at the start of each file, and the
    last block, give the span to within the overlap test's needs.
    """
    from .point_cloud import open_cloud

    samples = []
    for file in files:
        if not file.count:
            continue
        with open_cloud(file.path) as reader:
            starts = np.unique(np.linspace(0, max(file.count - 1000, 0), 5).astype(int))
            for start in starts:
                try:
                    reader.seek(int(start))
                    time = np.asarray(reader.read_points(1000)["gps_time"], float)
                except Exception as problem:
                    raise RoadExtractionError(
                        f"{file.path} is damaged: its header promises {file.count} points, but those from "
                        f"{start} on cannot be read ({problem}). Copy or export the file again.") from problem
                time = time[np.isfinite(time)]
                samples.append(time)
    times = np.concatenate(samples)
    if not len(times) or times.max() <= times.min():
        return None
    week_ends = wrapped_week((times.min(), times.max()))
    times = _carried_on(times) if week_ends else times
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


def _no_overlap(files, frame, reader):
    if reader.unplaced_time:
        times = f"{reader.starts.min():.1f} s to {reader.ends.max():.1f} s"
        return (f"No point was measured while the trajectory was driven: {reader.unplaced_time} points lie outside "
                f"its time, {times}. Set the trajectory's time system, or check that both belong to one survey.")
    return (f"No point lies within {reader.settings.corridor:.0f} m of the trajectory and near its height. Check that "
            "cloud and trajectory belong to one survey and use one CRS.")
