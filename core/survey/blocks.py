"""Blocks of points, as they come from files: projected into the road frame, and those near the road chosen, as compact records."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..common.parallel import ScratchBuffers
from .frame.projection import RoadProjection
from .frame.road_frame import RoadFrame
from .las.point_fields import EVER, IntensitySource, LasAxis, flagged, times_by_value, valid_points
from .las.samples import TimeSlots
from .store.columns import Columns
from .store.records import COORDINATE_SCALE, SURVEY_POINT, beside_road, fill_units, point_dtype, road_of, to_units
from .store.section_store import PartitionedPoints, SectionStore
from .trajectory.time_systems import SECONDS_PER_WEEK
from .weights import FRAME

if TYPE_CHECKING:
    import laspy

DECODED_LAYERS = ("z", "intensity", "point_source_id", "gps_time", "flags", "classification")  # LAZ layers that are decoded
KEPT_ABOVE_ROAD, KEPT_BELOW_ROAD = 3.5, 4.0  # m: vehicles that hide a curb above the road, ditches below it
# m stored beyond these limits: the height of the road is rough while reading and exact when points are returned,
# so that the points returned do not depend on the order of the files
INGEST_HEIGHT_MARGIN = 1.5
HEIGHT_CELL_BITS = 12      # of a station in units of 0.1 mm: the height of the road is looked up every 0.41 m
SCANNER_FIELDS = ("point_source_id", "scanner_channel")
LEVEL_HEIGHT = 1.0         # m above or below the road beside the vehicle, and
LEVEL_DISTANCE = 50.0      # m from the vehicle within which ground beyond the corridor is kept: that of side streets


@dataclass
class BlockSummary:
    """What a block contributes to the knowledge of the whole cloud.

    scanners : {LAS field: {value: (first time, last time, count)}}
    darkest, brightest : lowest and highest intensity
    without_time : number of points at a time of no pass
    excluded : number of points that are withheld or classified as noise
    """

    scanners: dict[str, dict[int, tuple[float, float, int]]] = field(default_factory=dict)
    darkest: int = 65535
    brightest: int = 0
    without_time: int = 0
    excluded: int = 0

    def join(self, other: BlockSummary) -> None:
        """Add what another block contributes."""
        self.darkest, self.brightest = min(self.darkest, other.darkest), max(self.brightest, other.brightest)
        self.without_time += other.without_time
        self.excluded += other.excluded
        for name, times in other.scanners.items():
            self._note(name, times)

    def add(self, columns: dict[str, np.ndarray]) -> None:
        """Count points of the block, of which `columns` has (N,) intensity."""
        self.darkest = min(self.darkest, int(columns["intensity"].min()))
        self.brightest = max(self.brightest, int(columns["intensity"].max()))

    def add_scanners(self, columns: dict[str, np.ndarray], names: set[str], at: np.ndarray, span: tuple[float, float] = EVER) -> None:
        """Count points by the fields that may tell scanners apart.

        Parameters
        ----------
        columns : (N,) source and scanner
        names : LAS fields that the file has
        at : (N,) s, their times; m, their stations where there are none
        span : s, (first, last) time of the drive: points at other times say nothing of the scanners
        """
        for name, key in zip(SCANNER_FIELDS, ("source", "scanner")):
            if name in names:
                self._note(name, times_by_value(columns[key], at, span))

    def _note(self, name, times):
        seen = self.scanners.setdefault(name, {})
        for value, (start, end, number) in times.items():
            first, last, count = seen.get(value, (start, end, 0))
            seen[value] = min(first, start), max(last, end), count + number


class HeightFilter:
    """Selects points near the rough height of the road.

    Parameters
    ----------
    drop : metres from the trajectory down to the road
    above : metres above the road up to which points are kept
    """

    def __init__(self, frame: RoadFrame, drop: float, above: float = KEPT_ABOVE_ROAD):
        self._roads = {}
        self._depth = np.uint32((above + KEPT_BELOW_ROAD + 2 * INGEST_HEIGHT_MARGIN) / COORDINATE_SCALE)
        for road in frame.roads:
            first, last = (int(station / COORDINATE_SCALE) >> HEIGHT_CELL_BITS for station in (road.start, road.end))
            stations = ((np.arange(first, last + 1) << HEIGHT_CELL_BITS) + (1 << HEIGHT_CELL_BITS) // 2) * COORDINATE_SCALE
            lowest = frame.track_height(road.number, stations) - drop - KEPT_BELOW_ROAD - INGEST_HEIGHT_MARGIN
            self._roads[road.number] = first, to_units(lowest)

    def near(self, road: int, s: np.ndarray, z: np.ndarray, buffers: Callable[..., np.ndarray]) -> np.ndarray:
        """Which points lie near the height of the road.

        Parameters
        ----------
        road : number
        s, z : (N,) int32 station and local height, units of 0.1 mm
        buffers : of `ScratchBuffers.of` for N values

        Returns
        -------
        (N,) bool
        """
        first, lowest = self._roads[int(road)]
        cell, k = np.right_shift(s, HEIGHT_CELL_BITS, out=buffers("cell", np.int32)), buffers("k", np.intp)
        np.copyto(k, np.subtract(cell, first, out=cell))
        above = np.subtract(z, lowest.take(k, out=cell, mode="clip"), out=cell)
        # a negative difference becomes a large unsigned number
        return above.view(np.uint32) < self._depth

    def level(self, road: int, s: np.ndarray, z: np.ndarray) -> np.ndarray:
        """(N,) bool: which points, seen from stations s, lie about as high as the road there; units of 0.1 mm."""
        first, lowest = self._roads[road]
        height = lowest.take((s >> HEIGHT_CELL_BITS) - first, mode="clip") + int((KEPT_BELOW_ROAD + INGEST_HEIGHT_MARGIN) / COORDINATE_SCALE)
        return np.abs(z - height) < (LEVEL_HEIGHT + INGEST_HEIGHT_MARGIN) / COORDINATE_SCALE


@dataclass(frozen=True)
class PointChoice:
    """Which points of the files are taken, and how.

    corridor : metres either side
    has_time : whether points are assigned to passes by their time; else by the nearest point on a road
    week_ends : whether the GPS week ends during the scan
    above_road : metres above the road up to which points are kept
    intensity : what the intensity of points is read from
    """

    corridor: float
    has_time: bool
    week_ends: bool = False
    above_road: float = KEPT_ABOVE_ROAD
    intensity: IntensitySource = IntensitySource()

    @property
    def layers(self) -> tuple[str, ...]:
        """The LAZ layers that are decoded."""
        return (*DECODED_LAYERS, *self.intensity.layers)


class _BlockProjector:
    """Turns blocks into compact records in the road frame; safe to use in several threads."""

    def __init__(self, frame: RoadFrame, choice: PointChoice):
        self.frame, self.choice, self.corridor, self.has_time = frame, choice, choice.corridor, choice.has_time
        self.dtype = point_dtype(SURVEY_POINT, frame.farthest)
        self.projection = RoadProjection(frame, choice.corridor) if choice.has_time else None
        self._span = (min(p.time[0] for p in frame.passes), max(p.time[-1] for p in frame.passes)) if choice.has_time else EVER
        self.roads = np.array([p.road for p in frame.passes] + [-1])
        self._scratch = ScratchBuffers()

    def read(self, block: laspy.ScaleAwarePointRecord, found: BlockSummary,
             ground: HeightFilter | None = None) -> Iterator[tuple[int, Columns, np.ndarray | None]]:
        """The points of a block near a road, piece by piece; each piece overwrites the Columns of the one before.

        Parameters
        ----------
        block : laspy point record
        found : BlockSummary, which is updated
        ground : HeightFilter; without it points of any height are taken

        Yields
        ------
        road number, Columns of a piece, and (N,) bool of the points to use, None for all; for ground beyond the corridor the number is that
        of `beside_road`, and stations are the vehicle's
        """
        names = set(block.point_format.dimension_names)
        axes = [LasAxis(*axis, self.dtype[axis[0].lower()]) for axis in zip("XYZ", block.scales, block.offsets, self.frame.origin)]
        # small pieces stay in the processor cache
        for first in range(0, len(block), FRAME.points_per_projection):
            yield from self._piece(block[first:first + FRAME.points_per_projection], names, axes, found, ground)

    def _piece(self, piece, names, axes, found, ground):
        buffers = self._scratch.of(len(piece))
        columns = self._columns(piece, names, buffers)
        found.add(columns)
        usable = valid_points(piece)
        if usable is not None:
            found.excluded += len(usable) - int(np.count_nonzero(usable))
        for axis, name in zip(axes, "xyz"):
            columns[name], there = axis.units(piece.array, buffers)
            usable = _both(usable, there)
        columns["s"], columns["d"] = buffers("s", np.int32), buffers("d", np.int32)
        columns["pass_number"], inside, lost = self._placed(columns, usable)
        found.without_time += lost
        self._add_scanners(columns, names, inside, found)
        if inside is not None:
            # points outside get a valid station of this piece
            columns["s"][~inside] = columns["s"][inside.argmax()] if inside.any() else 0
        points = Columns(columns, self.dtype, len(piece))
        if inside is not None and self.has_time:
            yield from self._beyond(columns, points, inside, ground)
            if not inside.any():
                return
        for number, own in self._by_road(columns["pass_number"], inside):
            if ground is not None:
                near = ground.near(number, columns["s"], columns["z"], buffers)
                own = _both(own, None if near.all() else near)
            if own is None or own.any():
                yield number, points, own

    def _add_scanners(self, columns, names, inside, found):
        """Scanners measure together: at the same times, or without times along the same stretches of road."""
        if self.has_time:
            found.add_scanners(columns, names, columns["time"], self._span)
        else:
            own = slice(None) if inside is None else inside
            found.add_scanners({key: columns[key][own] for key in ("source", "scanner")}, names, columns["s"][own] * COORDINATE_SCALE)

    def _beyond(self, columns, points, inside, ground):
        """As `read`, the ground beyond the corridor that the vehicle saw about as high as its road."""
        passes = columns["pass_number"].view(np.int16)
        outside = np.flatnonzero(~inside & (passes >= 0))
        for number in np.unique(passes.take(outside)).tolist():
            driven = self.frame.passes[number]
            rows = outside[passes.take(outside) == number]
            station, x, y = driven.at(columns["time"].take(rows), "s", "x", "y")
            x -= columns["x"].take(rows) * COORDINATE_SCALE
            y -= columns["y"].take(rows) * COORDINATE_SCALE
            near = np.flatnonzero(x * x + y * y < LEVEL_DISTANCE**2)
            rows, station = rows.take(near), to_units(station.take(near))
            if ground is not None:
                level = np.flatnonzero(ground.level(driven.road, station, columns["z"].take(rows)))
                rows, station = rows.take(level), station.take(level)
            if len(rows):
                arrays = {name: column.take(rows) for name, column in columns.items()}
                arrays.update(s=station, d=np.zeros(len(rows), np.int32))
                yield beside_road(driven.road), Columns(arrays, self.dtype, len(rows)), None

    def _by_road(self, pass_number, inside):
        """(road number, (N,) bool of its points or None for all) of every road with points."""
        if len(self.frame.roads) == 1:
            return [(0, inside)]
        road = self.roads[pass_number.view(np.int16)]
        if inside is not None:
            road = np.where(inside, road, -1)
        found = np.unique(road)
        return [(number, None if len(found) == 1 else road == number) for number in found.tolist() if number >= 0]

    def _columns(self, piece, names, buffers):
        """Columns copied from the file: time, intensity, source, returns, scanner."""
        raw = piece.array
        columns = {name: buffers(name, SURVEY_POINT[name]) for name in ("time", "intensity", "source", "returns")}
        columns["time"][:] = raw["gps_time"] if "gps_time" in raw.dtype.names else 0.0
        if self.choice.week_ends:
            columns["time"][:] = unwrap_week(columns["time"])
        columns["intensity"][:] = self.choice.intensity.of(piece)
        columns["source"][:] = raw["point_source_id"]
        columns["scanner"] = np.broadcast_to(np.uint8(0), len(raw))
        if "scanner_channel" in names and flagged(piece):
            columns["scanner"] = np.asarray(piece["scanner_channel"])
        # LAS 1.4 stores both numbers in this way
        columns["returns"][:] = raw["bit_fields"] if "scanner_channel" in names else _returns(piece)
        return columns

    def _placed(self, columns, usable):
        """Fill the columns s and d; (N,) uint16 pass numbers, (N,) bool inside the frame (None for all), and the number of points without a pass."""
        names = ("x", "y", "time", "s", "d")
        if usable is None:
            passes, inside = self._located(*map(columns.get, names))
            return passes.view(np.uint16), inside, self._lost(passes)
        rows = np.flatnonzero(usable)
        some = [columns[name].take(rows) for name in names]
        found, there = self._located(*some)
        passes, inside = np.full(len(usable), -1, np.int16), np.zeros(len(usable), bool)
        passes[rows], inside[rows] = found, True if there is None else there
        for name, values in zip(names[3:], some[3:]):
            columns[name][rows] = values
        return passes.view(np.uint16), inside, self._lost(found)

    def _lost(self, passes):
        if not self.has_time or not len(passes) or passes.strides[0] == 0 and passes[0] >= 0:
            return 0
        return int(np.count_nonzero(passes < 0))

    def _located(self, x, y, time, s, d):
        """Pass numbers and `inside`, as by `RoadProjection.project_units`, with or without times."""
        if self.has_time:
            return self.projection.project_units(x, y, time, s, d)
        road, along, across = self.frame.locate_nearest(x * COORDINATE_SCALE, y * COORDINATE_SCALE, self.corridor)
        fill_units(along, s)
        fill_units(across, d)
        passes = np.full(len(x), -1, np.int16)
        for p in self.frame.passes[::-1]:
            passes[road == p.road] = p.number
        return passes, road >= 0


def unwrap_week(time: np.ndarray) -> np.ndarray:
    """Seconds of the week, continued beyond the end of the week where it ends during the scan; (N,)."""
    return np.where(time < SECONDS_PER_WEEK / 2, time + SECONDS_PER_WEEK, time)


def _returns(block):
    """(N,) return number + 16 * number of returns."""
    return np.asarray(block["return_number"]) | (np.asarray(block["number_of_returns"]) << 4)


def _both(one, other):
    """What two masks have in common, either of which may be None for all."""
    if one is None or other is None:
        return other if one is None else one
    return one & other


@dataclass
class ChosenPoints:
    """What the points that are kept say of the survey.

    histogram : HeightHistogram of those on the vehicle's own track
    sampled : (N,) times and (N, 3) units of 0.1 mm of some points; without times none
    """

    histogram: HeightHistogram
    sampled: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)


class BlockReader:
    """Chooses the points of blocks that lie near the road and partitions them by section; safe to use in several threads.

    Parameters
    ----------
    slots : TimeSlots of the points that are sampled
    """

    def __init__(self, frame: RoadFrame, choice: PointChoice, slots: TimeSlots):
        self.frame, self.choice, self.slots = frame, choice, slots
        self.tracks = VehicleTracks(frame)
        self._blocks = _BlockProjector(frame, choice)

    def ground(self, drop: float) -> HeightFilter:
        """What is near a road that lies `drop` metres below the trajectory."""
        return HeightFilter(self.frame, drop, self.choice.above_road)

    def chosen(self, drop: float) -> ChosenPoints:
        """No points yet, of a road that lies about `drop` metres below the trajectory."""
        return ChosenPoints(HeightHistogram([p.number for p in self.frame.passes], drop))

    def unfiltered(self, block: laspy.ScaleAwarePointRecord, found: BlockSummary) -> list[tuple[int, Columns]]:
        """Road and Columns of the points of a block within the corridor, whatever their height; `found` is updated."""
        return [(road, points.copy() if own is None else points.take(own).load_all()) for road, points, own in self._blocks.read(block, found)]

    def read(self, block: laspy.ScaleAwarePointRecord, found: BlockSummary, ground: HeightFilter, chosen: ChosenPoints,
             store: SectionStore) -> list[PartitionedPoints]:
        """The points of a block near the road, ready for the store; `found` and `chosen` are updated."""
        return [self._partition(road, points, own, chosen, store) for road, points, own in self._blocks.read(block, found, ground)]

    def filtered(self, parts: Iterable[tuple[int, Columns]], ground: HeightFilter, chosen: ChosenPoints,
                 store: SectionStore) -> Iterator[PartitionedPoints]:
        """Yield those of `unfiltered` that lie near the road, as `read` would have given them."""
        for road, points in parts:
            if road < 0:
                near = ground.level(road_of(road), points["s"], points["z"])
            else:
                near = ground.near(road, points["s"], points["z"], ScratchBuffers().of(len(points)))
            if near.any():
                yield self._partition(road, points, near, chosen, store)

    def _partition(self, road, points, own, chosen, store):
        if road < 0:
            return store.partition(road, points, own)
        for number, drops in self.tracks.drops(road, points, own):
            chosen.histogram.add(number, drops)
        if self.choice.has_time:
            kept = self.slots.kept(points["time"]) & ((points["returns"] & 15) <= 1)
            rows = np.flatnonzero(kept if own is None else kept & own)
            if len(rows):
                chosen.sampled.append((points["time"][rows], np.stack([points[name][rows] for name in "xyz"], axis=1)))
        return store.partition(road, points, own)


# The height of the sensor above the road, from the points on the track of the vehicle itself.

OWN_TRACK_HALF_WIDTH = 1.5       # m either side of the own track: road, not sidewalk
DEFAULT_SENSOR_HEIGHT = 2.6   # m, used where too few points lie on the track
MIN_TRACK_POINTS = 50            # points on the track that an estimate needs (more than)
HEIGHT_RESOLUTION = 0.001           # m: resolution of the histogram
_RESOLUTION_UNITS = round(HEIGHT_RESOLUTION / COORDINATE_SCALE)
HEIGHT_RANGE = 20.0           # m either side of the first estimate covered by the histogram
HEIGHT_PEAK_BIN = 0.1             # m: bin width in which the road makes the peak
MAX_SUSPENSION_TRAVEL = 0.15            # m: no suspension lets a vehicle rise and sink more than this for half of its way
TRACK_CELL_BITS = 8          # of a station in units of 0.1 mm: a track is looked up every 26 mm
OWN_TRACK_HALF_WIDTH_UNITS = round(OWN_TRACK_HALF_WIDTH / COORDINATE_SCALE)
HEIGHT_PEAK_REACH = 0.5           # m either side of the peak that belong to the road


class VehicleTracks:
    """The tracks of the vehicle in the road frame, to find the points that lie on them."""

    def __init__(self, frame: RoadFrame):
        self.frame = frame
        # pass number -> first station cell, offsets and heights of the track at the middle of each cell
        self._tracks: dict[int, tuple[int, np.ndarray, np.ndarray]] = {}
        for p in frame.passes:
            first, last = (int(station / COORDINATE_SCALE) >> TRACK_CELL_BITS for station in p.span)
            middles = ((np.arange(first, last + 1) << TRACK_CELL_BITS) + (1 << TRACK_CELL_BITS) // 2) * COORDINATE_SCALE
            offsets, heights = p.at_station(middles)
            self._tracks[p.number] = first, to_units(offsets), to_units(heights)

    def drops(self, road: int, points: Columns, own: np.ndarray | None = None) -> Iterator[tuple[int, np.ndarray]]:
        """Depths below the trajectory of the points on the own track, pass by pass.

        Parameters
        ----------
        road : number
        own : (N,) bool, points to use; all by default

        Yields
        ------
        pass number and (M,) int32 units of 0.1 mm from the trajectory down to the points
        """
        if not len(points):
            return
        number, along, across = points["pass_number"], points["s"], points["d"]
        ends = np.array([along.min(), along.max()]) >> TRACK_CELL_BITS
        only = number.strides[0] == 0 or number.min() == number.max()
        for p in self.frame.passes_of(road):
            if only and p.number != number[0]:
                continue
            first, offsets, heights = self._tracks[p.number]
            low, high = np.clip(ends - first, 0, len(offsets) - 1)
            track = offsets[low:high + 1]
            # most points lie beside the whole track
            beside = _between(across, int(track.min()) - OWN_TRACK_HALF_WIDTH_UNITS, int(track.max()) + OWN_TRACK_HALF_WIDTH_UNITS)
            if own is not None:
                beside &= own
            if not only:
                beside &= number == p.number
            rows = np.flatnonzero(beside)
            cell = (along.take(rows) >> TRACK_CELL_BITS) - np.int32(first)
            off = across.take(rows)
            off -= offsets.take(cell, mode="clip")
            on = np.flatnonzero(_between(off, -OWN_TRACK_HALF_WIDTH_UNITS, OWN_TRACK_HALF_WIDTH_UNITS))
            if len(on):
                drops = heights.take(cell.take(on), mode="clip")
                drops -= points["z"].take(rows.take(on))
                yield p.number, drops


def _between(values, least, most):
    """(N,) bool: which int32 values lie between two limits, both included."""
    above = np.subtract(values, np.int32(least))
    return above.view(np.uint32) <= np.uint32(most - least)


def estimate_sensor_height(drops: np.ndarray) -> float | None:
    """A rough sensor height in metres, accurate to one or two decimetres, of (N,) units of 0.1 mm; None for too few points."""
    return float(np.median(drops)) * COORDINATE_SCALE if len(drops) > MIN_TRACK_POINTS else None


class HeightHistogram:
    """Histogram of the depths below the trajectory of points on the track; independent of the order of adding.

    Parameters
    ----------
    passes : numbers of the passes
    about : first estimate of the sensor height, m
    """

    def __init__(self, passes: Iterable[int], about: float):
        self.origin = np.floor(about) - HEIGHT_RANGE
        self.counts = {number: np.zeros(int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION), np.int64) for number in passes}
        self._lock = threading.Lock()

    def add(self, number: int, drops: np.ndarray) -> None:
        """Count points on the track of a pass; (N,) int32 depths below the trajectory in units of 0.1 mm."""
        size = int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION)
        k = drops - np.int32(round(self.origin / COORDINATE_SCALE) - _RESOLUTION_UNITS // 2)
        k //= _RESOLUTION_UNITS
        if k.min() < 0 or k.max() >= size:
            k = k[(k >= 0) & (k < size)]
        least = int(k.min(initial=size))
        k -= least
        found = np.bincount(k)
        with self._lock:
            self.counts[number][least:least + len(found)] += found

    def join(self, counts: dict[int, np.ndarray]) -> None:
        """Add the counts of another histogram of the same passes and the same first estimate."""
        for number, found in counts.items():
            self.counts[number] += found

    def heights(self) -> dict[int, float]:
        """Height of the trajectory above the road, one per pass.

        The road makes the peak of the histogram, the fullest decimetre. Its height is the median of the points within
        half a metre of the peak, so that bridges and trees above do not count.

        Returns
        -------
        {pass number: metres, rounded to millimetres}; a pass without points on its own track gets the median of the others.
        """
        found = {number: _road_height(counts, self.origin) for number, counts in self.counts.items()}
        known = [height for height in found.values() if height is not None]
        usual = float(np.median(known)) if known else DEFAULT_SENSOR_HEIGHT
        return {number: usual if height is None else height for number, height in found.items()}

    def uneven(self) -> tuple[float, float] | None:
        """Variation of the height of the trajectory above the road, where it is more than a vehicle can cause.

        Points and trajectory share the errors of navigation, so half of the points on the own track lie within a few
        centimetres of one height below it, whatever is parked or grows on the rest.

        Returns
        -------
        (median absolute deviation from the height, height) in metres, of the pass where it is largest; None if no pass
        exceeds MAX_SUSPENSION_TRAVEL.
        """
        heights = self.heights()
        found = [(_half_within(counts, self.origin, heights[number]), heights[number])
                 for number, counts in self.counts.items() if counts.sum() > MIN_TRACK_POINTS]
        off, height = max(found, default=(0.0, 0.0))
        return (off, height) if off > MAX_SUSPENSION_TRAVEL else None


def _half_within(counts, origin, height):
    """Metres from `height` within which half of the counts of a histogram per millimetre lie."""
    off = np.abs(origin + np.arange(len(counts)) * HEIGHT_RESOLUTION - height)
    order = np.argsort(off, kind="stable")
    near = np.cumsum(counts[order])
    return float(off[order[np.searchsorted(near, (near[-1] + 1) // 2)]])


def sensor_height_of(drops: np.ndarray) -> float | None:
    """Sensor height in metres, of (N,) metres from the trajectory down to points on its track; None for too few points."""
    if len(drops) <= MIN_TRACK_POINTS:
        return None
    origin = np.floor(np.median(drops)) - HEIGHT_RANGE
    size = int(2 * HEIGHT_RANGE / HEIGHT_RESOLUTION)
    k = np.rint((drops - origin) / HEIGHT_RESOLUTION).astype(np.int64)
    return _road_height(np.bincount(k[(k >= 0) & (k < size)], minlength=size), origin)


def _road_height(counts, origin):
    """The median about the fullest decimetre of a histogram per millimetre; None for too few points."""
    if counts.sum() <= MIN_TRACK_POINTS:
        return None
    bins = counts.reshape(-1, int(round(HEIGHT_PEAK_BIN / HEIGHT_RESOLUTION))).sum(axis=1)
    # neighbouring bins count too: the road may lie on the border of two bins
    peak = int(np.argmax(np.convolve(bins, np.ones(3), "same")))
    middle, reach = int((peak + 0.5) * HEIGHT_PEAK_BIN / HEIGHT_RESOLUTION), int(HEIGHT_PEAK_REACH / HEIGHT_RESOLUTION)
    first = max(middle - reach, 0)
    near = np.cumsum(counts[first:middle + reach])
    return round(float(origin + (first + np.searchsorted(near, (near[-1] + 1) // 2)) * HEIGHT_RESOLUTION), 3)
