"""One block of a point cloud: its points near the road as compact records."""

from dataclasses import dataclass, field

import numpy as np

from .placing import AT_ONCE, Placing
from .points import SURVEY_POINT, UNIT
from .scanners import times_by_value
from .time_systems import WEEK

ABOVE, BELOW = 3.5, 4.0  # m about the road kept: vehicles that hide a curb above, ditches below
# m more that are stored: the height of the road is rough while reading, and exact when points are handed out,
# so that what is handed out does not depend on which file came first
MARGIN = 1.5
GROUND_STEP = 0.5      # m between the places at which the height of the road is looked up
SCANNER_FIELDS = ("point_source_id", "scanner_channel")


@dataclass
class BlockPoints:
    """What a block holds: [(road, records, indices of those in the road's corridor)], and what it says of the whole cloud.

    scanners : {LAS field: {value: (first time, last time, count)}}
    darkest, brightest : intensity
    without_time : points whose time no pass has
    """

    parts: list = field(default_factory=list)
    scanners: dict = field(default_factory=dict)
    darkest: int = 65535
    brightest: int = 0
    without_time: int = 0


class Ground:
    """The rough height of the roads, for choosing points by height.

    Parameters
    ----------
    drop : metres from the tracks down to the road
    """

    def __init__(self, frame, drop):
        self._roads = {}
        for road in frame.roads:
            stations = np.arange(road.start, road.end + GROUND_STEP, GROUND_STEP)
            self._roads[road.number] = road.start, frame.track_height(road.number, stations) - drop

    def near(self, road, s, z):
        """(N,) bool: which places of a road are near its height; any answer where s is NaN."""
        first, ground = self._roads[int(road)]
        at = s - first
        at *= 1.0 / GROUND_STEP
        at += 0.5
        with np.errstate(invalid="ignore"):
            at = at.astype(np.intp)
        h = z - ground.take(at, mode="clip")
        near = h > -BELOW - MARGIN
        near &= h < ABOVE + MARGIN
        return near


class BlockReading:
    """Turns blocks into compact records; may be called by several threads.

    Parameters
    ----------
    frame : RoadFrame
    corridor : metres either side
    has_time : whether points are placed by their time; else at the nearest foot
    week_ends : whether the GPS week ends during the scan
    """

    def __init__(self, frame, corridor, has_time, week_ends=False):
        self.frame, self.corridor, self.has_time, self.week_ends = frame, corridor, has_time, week_ends
        self.placing = Placing(frame, corridor) if has_time else None
        self.roads = np.array([p.road for p in frame.passes] + [-1])

    def read(self, block, ground=None):
        """BlockPoints of a laspy point record; those near the road's height, where a Ground is given."""
        found, raw, names = BlockPoints(), block.array, set(block.point_format.dimension_names)
        if not len(raw):
            return found
        time = self._time(raw)
        columns = dict(time=time, intensity=np.ascontiguousarray(raw["intensity"]), source=np.ascontiguousarray(raw["point_source_id"]),
                       returns=_returns(block, names))
        if "scanner_channel" in names:
            columns["scanner"] = np.asarray(block["scanner_channel"])
        found.darkest, found.brightest = int(columns["intensity"].min()), int(columns["intensity"].max())
        found.scanners = {name: times_by_value(columns[key], time) for name, key in zip(SCANNER_FIELDS, ("source", "scanner")) if key in columns}
        withheld = np.asarray(block["withheld"]) if "withheld" in names else None
        withheld = withheld if withheld is not None and withheld.any() else None
        # piece by piece, so that what is worked on stays in the processor's cache
        for first in range(0, len(raw), AT_ONCE):
            rows = slice(first, first + AT_ONCE)
            place = [raw[name][rows] * scale + (offset - origin)
                     for name, scale, offset, origin in zip("XYZ", block.scales, block.offsets, self.frame.origin)]
            self._piece(found, place, {name: values[rows] for name, values in columns.items()},
                        None if withheld is None else withheld[rows], ground)
        return found

    def _time(self, raw):
        if "gps_time" not in raw.dtype.names:
            return np.zeros(len(raw))
        time = np.array(raw["gps_time"], float)
        return carried_on(time) if self.week_ends else time

    def _piece(self, found, place, columns, withheld, ground):
        """Add the records of a piece of a block."""
        x, y, z = place
        pass_number, s, d, lost = self._placed(x, y, columns["time"], _usable(x, y, z, withheld))
        found.without_time += lost
        inside = np.isfinite(d)
        single = len(self.frame.roads) == 1
        road = None if single else np.where(inside, self.roads[pass_number], -1)
        records = np.zeros(len(x), SURVEY_POINT)
        for name, values in dict(x=x, y=y, z=z, s=s, d=d).items():
            with np.errstate(invalid="ignore"):
                records[name] = np.rint(values / UNIT)
        for name, values in dict(columns, pass_number=pass_number).items():
            records[name] = values
        for number in [0] if single else np.unique(road[inside]).tolist():
            own = inside if single else road == number
            if ground is not None:
                own &= ground.near(number, s, z)
            rows = np.flatnonzero(own)
            if len(rows):
                found.parts.append((number, records, rows))

    def _placed(self, x, y, time, good):
        """Pass, station and offset of local places (NaN where there is none), and how many have a time of no pass."""
        if good is not None:
            x, y, time = x[good], y[good], time[good]
        if self.has_time:
            pass_number, s, d = self.placing.place(x, y, time)
            lost = int(np.count_nonzero(pass_number < 0))
        else:
            road, s, d = self.frame.locate_nearest(x, y, self.corridor)
            pass_number, lost = np.full(len(x), -1, np.int16), 0
            for p in self.frame.passes[::-1]:
                pass_number[road == p.road] = p.number
        if good is None:
            return pass_number, s, d, lost
        found = np.full(len(good), -1, np.int16), np.full(len(good), np.nan), np.full(len(good), np.nan)
        for whole, part in zip(found, (pass_number, s, d)):
            whole[good] = part
        return *found, lost


def carried_on(time):
    """Seconds of the week, those after the week's end carried on."""
    return np.where(time < WEEK / 2, time + WEEK, time)


def _returns(block, names):
    """(N,) return number + 16 * number of returns."""
    if "scanner_channel" in names:  # LAS 1.4 keeps them so
        return np.ascontiguousarray(block.array["bit_fields"])
    return np.asarray(block["return_number"]) | (np.asarray(block["number_of_returns"]) << 4)


def _usable(x, y, z, withheld):
    """(N,) bool of the points that may be used, None where all may."""
    bounds = [(x, 2e5), (y, 2e5), (z, 2e4)]
    # absurd coordinates would overflow the 0.1 mm integers
    if withheld is None and all(v.min() > -most and v.max() < most for v, most in bounds):
        return None
    good = np.ones(len(x), bool)
    for v, most in bounds:
        good &= np.abs(v) < most  # False for NaN
    return good if withheld is None else good & (withheld == 0)
