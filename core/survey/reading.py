"""Point cloud files into the section store: blocks are decoded while those before them are placed."""

import os
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from .columns import Columns
from .placing import Placing
from .point_cloud import read_blocks
from .points import SURVEY_POINT, UNIT, to_units
from .scanners import ScannerCensus
from .sensor_height import DEFAULT_HEIGHT, HeightTally, Tracks, first_estimate
from .time_systems import WEEK

ABOVE, BELOW = 3.5, 4.0  # m about the road kept: vehicles that hide a curb above, ditches below
# m more that are stored: the height of the road is rough while reading, and exact when points are handed out,
# so that what is handed out does not depend on which file came first
MARGIN = 1.5
WAITING = 4_000_000    # points kept back at most until that height is known
SAMPLES = 20_000       # points on the track that tell it
GROUND_STEP = 0.5      # m between the places at which it is looked up
LAYERS = ("z", "intensity", "point_source_id", "gps_time", "flags")  # what is decoded of a LAZ file
THREADS = 2            # that place points beside the one that decodes


@dataclass
class _Placed:
    """One block: its points in the corridor, [(road, Columns)]; where they lie in the store, once they were chosen by height."""

    parts: list
    parted: list
    brightest: int
    without_time: int


class SurveyReader:
    """Reads files into a store and learns on the way what must be known of the whole survey.

    Attributes, complete after `finish`
    ----------
    census : ScannerCensus
    darkest, brightest : the lowest and the highest intensity
    unplaced_time : points whose time no pass has
    heights : {pass number: metres from the trajectory down to the road}
    """

    def __init__(self, frame, store, corridor, has_time, week_ends=False):
        self.frame, self.store, self.corridor, self.has_time, self.week_ends = frame, store, corridor, has_time, week_ends
        self.census, self.darkest, self.brightest, self.unplaced_time = ScannerCensus(), 65535, 0, 0
        self.placing = Placing(frame, corridor) if has_time else None
        self.tracks = Tracks(frame)
        self.tally = None          # of heights; made when the rough height of the road is known
        self._drop = None          # metres from track to road, rough
        self._ground = {}          # road -> first station, height of the track every GROUND_STEP
        self._waiting, self._samples = [], []  # blocks until it is known

    def read(self, files, block, progress):
        """Read all files; a block is decoded while the two before it are placed."""
        total, done, first = sum(file.count for file in files), 0, True
        with ThreadPoolExecutor(min(THREADS, os.cpu_count() or 1)) as pool:
            waiting = deque()
            try:
                for file in files:
                    for points in read_blocks(file.path, block, LAYERS):
                        time = self._look(points)
                        waiting.append((pool.submit(self._placed, points, time), len(points)))
                        # the first block tells the road's height, which the others are chosen by
                        while len(waiting) > (0 if first else THREADS):
                            placed, count = waiting.popleft()
                            self._take(placed.result())
                            done += count
                            progress.at(done / total)
                        first = self._drop is None
                while waiting:
                    placed, count = waiting.popleft()
                    self._take(placed.result())
                    done += count
                    progress.at(done / total)
            finally:
                for placed, _ in waiting:
                    placed.cancel()
        self._settle()
        self.heights = self.tally.heights()

    def _look(self, block):
        """Take note of what a block says of scanners and brightness; returns its times."""
        names = set(block.point_format.dimension_names)
        time = self._time(block)
        if not len(time):
            return time
        self.darkest = min(self.darkest, int(block.array["intensity"].min()))
        self.brightest = max(self.brightest, int(block.array["intensity"].max()))
        self.census.add("point_source_id", block.array["point_source_id"], time)
        if "scanner_channel" in names:
            self.census.add("scanner_channel", np.asarray(block["scanner_channel"]), time)
        return time

    def _time(self, block):
        if "gps_time" not in block.array.dtype.names:
            return np.zeros(len(block))
        time = np.array(block.array["gps_time"], float)
        return carried_on(time) if self.week_ends else time

    def _placed(self, block, time):
        """A block's points in the road frame; chosen by height where the road's is known."""
        raw, names = block.array, set(block.point_format.dimension_names)
        x, y, z = (raw[name] * scale + (offset - origin)
                   for name, scale, offset, origin in zip("XYZ", block.scales, block.offsets, self.frame.origin))
        good = _usable(x, y, z, np.asarray(block["withheld"]) if "withheld" in names else None)
        pass_number, road, s, d, without_time = self._place(x, y, time, good)
        returns = raw["bit_fields"] if "scanner_channel" in names else \
            np.asarray(block["return_number"]) | (np.asarray(block["number_of_returns"]) << 4)
        channel = np.asarray(block["scanner_channel"]) if "scanner_channel" in names else np.zeros(len(raw), np.uint8)
        everything = dict(time=time, x=x, y=y, z=z, s=s, d=d, intensity=raw["intensity"], source=raw["point_source_id"],
                          pass_number=pass_number, scanner=channel, returns=returns)
        placed = _Placed([], [], 0, without_time)
        inside = np.isfinite(d)
        single = len(self.frame.roads) == 1
        for number in [0] if single else np.flatnonzero(np.bincount(road[inside])):
            own = inside if single else inside & (road == number)
            if self._drop is not None:
                own[own] = self._near_ground(number, s[own], z[own])
            records = _compact(everything, np.flatnonzero(own))
            placed.parts.append((int(number), records))
        if self._drop is not None:
            self._finish(placed)
        return placed

    def _place(self, x, y, time, good):
        """Pass, road, station and offset of local places (NaN where there is none), and how many have a time of no pass."""
        if good is not None:
            rows = np.flatnonzero(good)
            x, y, time = x[rows], y[rows], time[rows]
        if self.has_time:
            pass_number, s, d = self.placing.place(x, y, time)
            road = np.array([p.road for p in self.frame.passes] + [-1])[pass_number]
            lost = int(np.count_nonzero(pass_number < 0))
        else:
            road, s, d = self.frame.locate_nearest(x, y, self.corridor)
            pass_number, lost = np.zeros(len(x), np.int16), 0
            for p in self.frame.passes[::-1]:
                pass_number[road == p.road] = p.number
        if good is None:
            return pass_number, road, s, d, lost
        found = [np.zeros(len(good), np.int16), np.full(len(good), -1), np.full(len(good), np.nan), np.full(len(good), np.nan)]
        for whole, part in zip(found, (pass_number, road, s, d)):
            whole[rows] = part
        return *found, lost

    def _take(self, placed):
        """One block, in the order of the files."""
        self.unplaced_time += placed.without_time
        if placed.parted:
            self.store.add(placed.parted)
        elif placed.parts and self._drop is None:
            self._waiting.append(placed)
            self._samples += [drops[::7] for road, records in placed.parts for _, drops in self.tracks.drops(road, records)]
            if sum(map(len, self._samples)) > SAMPLES or \
                    sum(len(records) for waiting in self._waiting for _, records in waiting.parts) > WAITING:
                self._settle()
        elif placed.parts:
            self._choose(placed)

    def _settle(self):
        """Settle the rough height of the road and store what waited for it."""
        if self._drop is not None:
            return
        drop = first_estimate(np.concatenate(self._samples)) if self._samples else None
        drop = DEFAULT_HEIGHT if drop is None else drop
        for road in self.frame.roads:
            stations = np.arange(road.start, road.end + GROUND_STEP, GROUND_STEP)
            self._ground[road.number] = road.start, self.frame.track_height(road.number, stations) - drop
        self.tally = HeightTally([p.number for p in self.frame.passes], drop)
        self._drop = drop
        waiting, self._waiting, self._samples = self._waiting, [], []
        for placed in waiting:
            self._choose(placed)

    def _choose(self, placed):
        """Choose a block's points by height, if that was not known when it was placed, and store them."""
        placed.parts = [(road, records.take(self._near_ground(road, records["s"] * UNIT, records["z"] * UNIT)))
                        for road, records in placed.parts]
        self._finish(placed)
        self.store.add(placed.parted)

    def _near_ground(self, road, s, z):
        first, ground = self._ground[int(road)]
        h = z - ground.take(((s - first) * (1.0 / GROUND_STEP) + 0.5).astype(np.intp), mode="clip")
        return (h > -BELOW - MARGIN) & (h < ABOVE + MARGIN)

    def _finish(self, placed):
        """Count the points on the track and part them by section."""
        for road, records in placed.parts:
            if len(records):
                placed.parted += self.store.parted(road, records)
                for number, drops in self.tracks.drops(road, records):
                    self.tally.add(number, drops)


def _usable(x, y, z, withheld):
    """(N,) bool of the points that may be used, None where all may."""
    bounds = [(x, 2e5), (y, 2e5), (z, 2e4)]
    # absurd coordinates would overflow the 0.1 mm integers
    fine = all(len(v) == 0 or (v.min() > -most and v.max() < most) for v, most in bounds)
    if fine and (withheld is None or not withheld.any()):
        return None
    good = np.ones(len(x), bool)
    for v, most in bounds:
        good &= np.abs(v) < most  # False for NaN
    return good if withheld is None else good & (withheld == 0)


def _compact(columns, rows):
    """The compact records of some rows of a block's columns, each made when it is asked for."""

    def make(name):
        values = columns[name] if len(rows) == len(columns[name]) else columns[name].take(rows)
        if name in ("x", "y", "z", "s", "d"):
            return to_units(values)
        return np.ascontiguousarray(values, SURVEY_POINT[name])

    return Columns({}, SURVEY_POINT, len(rows), make)


def carried_on(time):
    """Seconds of the week, those after the week's end carried on."""
    return np.where(time < WEEK / 2, time + WEEK, time)
