"""One block of a point cloud: its points near the road as compact records."""

from dataclasses import dataclass, field

import numpy as np

from .columns import Columns
from .kept_arrays import KeptArrays
from .las_axis import LasAxis
from .placing import AT_ONCE, Placing
from .points import SURVEY_POINT, in_units
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
    """What a block says of the whole cloud.

    scanners : {LAS field: {value: (first time, last time, count)}}
    darkest, brightest : intensity
    without_time : points whose time no pass has
    """

    scanners: dict = field(default_factory=dict)
    darkest: int = 65535
    brightest: int = 0
    without_time: int = 0

    def add(self, columns, names):
        """Take note of some points of the block."""
        self.darkest = min(self.darkest, int(columns["intensity"].min()))
        self.brightest = max(self.brightest, int(columns["intensity"].max()))
        for name, key in zip(SCANNER_FIELDS, ("source", "scanner")):
            if name in names:
                seen = self.scanners.setdefault(name, {})
                for value, (start, end, number) in times_by_value(columns[key], columns["time"]).items():
                    first, last, count = seen.get(value, (start, end, 0))
                    seen[value] = min(first, start), max(last, end), count + number


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

    def near(self, road, s, z, kept):
        """(N,) bool: which places of a road are near its height; any answer where s is NaN. `kept` as of KeptArrays."""
        first, ground = self._roads[int(road)]
        at, k = np.subtract(s, first, out=kept("at")), kept("k", np.intp)
        at *= 1.0 / GROUND_STEP
        at += 0.5
        with np.errstate(invalid="ignore"):
            np.copyto(k, at, casting="unsafe")
        h = np.subtract(z, ground.take(k, out=at, mode="clip"), out=at)
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
        self._kept = KeptArrays()

    def read(self, block, found, ground=None):
        """Yield the points of a laspy point record near a road, those near its height where a Ground is given.

        Each time a road's number, the Columns of a piece of the block, and (N,) bool which of them are meant. The
        next piece is written over these Columns; what is said of the whole cloud is added to `found`, BlockPoints.
        """
        names = set(block.point_format.dimension_names)
        axes = [LasAxis(*axis) for axis in zip("XYZ", block.scales, block.offsets, self.frame.origin)]
        # piece by piece, so that what is worked on stays in the processor's cache
        for first in range(0, len(block), AT_ONCE):
            yield from self._piece(block[first:first + AT_ONCE], names, axes, found, ground)

    def _piece(self, piece, names, axes, found, ground):
        kept = self._kept.of(len(piece))
        columns = self._columns(piece, names, kept)
        found.add(columns, names)
        x, y, z = (axis.metres(piece.array, kept) for axis in axes)
        good = _usable(x, y, z, _withheld(piece, names))
        s, d = kept("station"), kept("offset")
        pass_number, lost = self._placed(x, y, columns["time"], good, s, d)
        found.without_time += lost
        inside = np.isfinite(d)
        if not inside.any():
            return
        single = len(self.frame.roads) == 1
        road = None if single else np.where(inside, self.roads[pass_number], -1)
        parts = []
        for number in [0] if single else np.unique(road[inside]).tolist():
            own = inside if single else road == number
            if ground is not None:
                own = own & ground.near(number, s, z, kept)
            parts.append((number, own))
        for name, metres in (("s", s), ("d", d)):
            if not inside.all():
                metres[~inside] = metres[inside.argmax()]  # so that they are numbers at all
            columns[name] = in_units(metres, kept(name, np.int32))
        for axis, name, metres in zip(axes, "xyz", (x, y, z)):
            columns[name] = axis.units(metres, kept)
        columns["pass_number"] = pass_number.view(np.uint16)
        points = Columns(columns, SURVEY_POINT, len(piece))
        for number, own in parts:
            if own.any():
                yield number, points, own

    def _columns(self, piece, names, kept):
        """What is kept of a piece as it is: time, intensity, source, returns, scanner."""
        raw = piece.array
        columns = {name: kept(name, SURVEY_POINT[name]) for name in ("time", "intensity", "source", "returns")}
        columns["time"][:] = raw["gps_time"] if "gps_time" in raw.dtype.names else 0.0
        if self.week_ends:
            columns["time"][:] = carried_on(columns["time"])
        columns["intensity"][:] = raw["intensity"]
        columns["source"][:] = raw["point_source_id"]
        columns["scanner"] = np.broadcast_to(np.uint8(0), len(raw))
        if "scanner_channel" in names and _flagged(piece):
            columns["scanner"] = np.asarray(piece["scanner_channel"])
        columns["returns"][:] = _returns(piece, names)
        return columns

    def _placed(self, x, y, time, good, s, d):
        """Put station and offset of local places into s and d (NaN where there is none); pass, and how many have a time of no pass."""
        if good is None:
            return self._located(x, y, time, s, d)
        count = int(np.count_nonzero(good))
        some_s, some_d = np.empty((2, count))
        pass_number = np.full(len(good), -1, np.int16)
        s[:] = d[:] = np.nan
        pass_number[good], lost = self._located(x[good], y[good], time[good], some_s, some_d)
        s[good], d[good] = some_s, some_d
        return pass_number, lost

    def _located(self, x, y, time, s, d):
        if self.has_time:
            pass_number = self.placing.put(x, y, time, s, d)
            return pass_number, int(np.count_nonzero(pass_number < 0))
        road, s[:], d[:] = self.frame.locate_nearest(x, y, self.corridor)
        pass_number = np.full(len(x), -1, np.int16)
        for p in self.frame.passes[::-1]:
            pass_number[road == p.road] = p.number
        return pass_number, 0


def carried_on(time):
    """Seconds of the week, those after the week's end carried on."""
    return np.where(time < WEEK / 2, time + WEEK, time)


def _returns(block, names):
    """(N,) return number + 16 * number of returns."""
    if "scanner_channel" in names:  # LAS 1.4 keeps them so
        return np.ascontiguousarray(block.array["bit_fields"])
    return np.asarray(block["return_number"]) | (np.asarray(block["number_of_returns"]) << 4)


def _flagged(piece):
    """Whether any point has a flag or a scanner channel: LAS 1.4 keeps them in one byte, and most clouds have none."""
    raw = piece.array
    return "classification_flags" not in raw.dtype.names or bool(raw["classification_flags"].max())


def _withheld(piece, names):
    """(N,) of the points that are withheld, None where none is."""
    if "withheld" not in names or not _flagged(piece):
        return None
    withheld = np.asarray(piece["withheld"])
    return withheld if withheld.any() else None


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
