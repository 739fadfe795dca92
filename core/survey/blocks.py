"""Blocks of points, as they come from files: projected into the road frame, and those near the road chosen, as compact records in a store."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..common.arrays import mask_runs
from ..common.parallel import ScratchBuffers, check_cancelled
from ..common.progress import Progress
from ..execution.phase import Executor, Phase, Recipe
from .frame.projection import RoadProjection
from .frame.road_frame import RoadFrame
from .las.parallel_reader import ParallelCloudReader
from .las.point_fields import EVER, MAX_INTENSITY, SCANNER_FIELDS, IntensitySource, LasAxis, ScannerCensus, flagged, packed_returns, valid_points
from .las.reader import CloudHeader, states_of
from .las.samples import TimeSlots
from .store.columns import Columns
from .store.records import COORDINATE_SCALE, SURVEY_POINT, beside_road, fill_units, point_dtype, to_units
from .store.section_store import PartitionedPoints, SectionStore, StoreIndex
from .trajectory.time_systems import unwrap_week
from .weights import FRAME, READING, VEHICLE

DECODED_LAYERS = ("z", "intensity", "point_source_id", "gps_time", "flags", "classification")  # LAZ layers that are decoded


@dataclass
class _BlockSummary:
    """What points contribute to the knowledge of the whole cloud."""

    census: ScannerCensus = field(default_factory=ScannerCensus)   # of the fields that may distinguish scanners
    darkest: int = MAX_INTENSITY   # darkest, brightest: lowest and highest intensity
    brightest: int = 0
    without_time: int = 0   # without_time, excluded: numbers of points at a time of no pass, and of those that are withheld or classified as noise
    excluded: int = 0

    def join(self, other: _BlockSummary) -> None:
        self.darkest, self.brightest = min(self.darkest, other.darkest), max(self.brightest, other.brightest)
        self.without_time += other.without_time
        self.excluded += other.excluded
        self.census.join(other.census)


def _cells(start, end, bits):
    """Number of the first cell of so many bits of a station in units of 0.1 mm, and (C,) m at the middles of those from start to end (m)."""
    first, last = (int(station / COORDINATE_SCALE) >> bits for station in (start, end))
    return first, ((np.arange(first, last + 1) << bits) + (1 << bits) // 2) * COORDINATE_SCALE


class _HeightFilter:
    """Selects points near the rough height of the road, `drop` metres below the trajectory, up to `above` metres above it."""

    def __init__(self, frame: RoadFrame, drop: float, above: float = READING.kept_above_road):
        self._roads = {}
        self._depth = np.uint32((above + READING.kept_below_road + 2 * READING.height_margin) / COORDINATE_SCALE)
        for road in frame.roads:
            first, stations = _cells(road.start, road.end, READING.height_cell_bits)
            lowest = frame.track_height(road.number, stations) - drop - READING.kept_below_road - READING.height_margin
            self._roads[road.number] = first, to_units(lowest)

    def near(self, road: int, s: np.ndarray, z: np.ndarray, buffers: Callable[..., np.ndarray]) -> np.ndarray:
        """(N,) bool: which points at (N,) int32 stations s and local heights z, units of 0.1 mm, lie near the height of the road."""
        first, lowest = self._roads[int(road)]
        cell, k = np.right_shift(s, READING.height_cell_bits, out=buffers("cell", np.int32)), buffers("k", np.intp)
        np.copyto(k, np.subtract(cell, first, out=cell))
        above = np.subtract(z, lowest.take(k, out=cell, mode="clip"), out=cell)
        # a negative difference becomes a large unsigned number
        return above.view(np.uint32) < self._depth

    def level(self, road: int, s: np.ndarray, z: np.ndarray) -> np.ndarray:
        """(N,) bool: which points, seen from stations s, lie about as high as the road there; units of 0.1 mm."""
        first, lowest = self._roads[road]
        road_above = int((READING.kept_below_road + READING.height_margin) / COORDINATE_SCALE)   # the lowest height that is kept
        height = lowest.take((s >> READING.height_cell_bits) - first, mode="clip") + road_above
        return np.abs(z - height) < (READING.level_height + READING.height_margin) / COORDINATE_SCALE


@dataclass(frozen=True)
class PointChoice:
    """Which points of the files are taken, and how."""

    corridor: float   # corridor, above_road: metres either side, and metres above the road up to which points are kept
    has_time: bool   # whether points are assigned to passes by their time; else by the nearest point on a road
    week_ends: bool = False   # whether the GPS week ends during the scan
    above_road: float = READING.kept_above_road
    intensity: IntensitySource = IntensitySource()   # what the intensity of points is read from

    @property
    def layers(self) -> tuple[str, ...]:
        """The LAZ layers that are decoded."""
        return (*DECODED_LAYERS, *self.intensity.layers)


@dataclass
class _ChosenPoints:
    """What the points that are kept say of the survey."""

    histogram: HeightHistogram   # histogram, coverage, brightness: of those on the vehicle's own track
    coverage: _Coverage
    brightness: _Brightness
    file: str = ""   # path of the one that points are taken from
    sampled: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)   # (N,) times and (N, 3) units of 0.1 mm of some; without times none


class _BlockReader:
    """Turns blocks into compact records in the road frame, chooses those near the road and partitions them by section.

    Safe to use in several threads. slots : of the points that are sampled
    """

    def __init__(self, frame: RoadFrame, choice: PointChoice, slots: TimeSlots):
        self.frame, self.choice, self.slots = frame, choice, slots
        self.tracks = VehicleTracks(frame)
        self.dtype = point_dtype(SURVEY_POINT, frame.farthest)
        self.projection = RoadProjection(frame, choice.corridor) if choice.has_time else None
        self._span = (min(p.time[0] for p in frame.passes), max(p.time[-1] for p in frame.passes)) if choice.has_time else EVER
        self.roads = np.array([p.road for p in frame.passes] + [-1])
        self._scratch = ScratchBuffers()

    def chosen(self, drop: float) -> _ChosenPoints:
        """No points yet, of a road that lies about `drop` metres below the trajectory."""
        return _ChosenPoints(HeightHistogram([p.number for p in self.frame.passes], drop), _Coverage(self.frame, drop), _Brightness())

    def rough_drop(self, blocks: Iterable[Any], progress: Progress) -> float:
        """m from the trajectory down to the road, accurate to one or two decimetres, by the first blocks of which enough lies on the own track."""
        samples: list[np.ndarray] = []
        looked_at = 0
        for block in blocks:
            progress.check_cancelled()
            for road, points, near in self._near_roads(block, _BlockSummary()):
                looked_at += len(points) if near is None else int(np.count_nonzero(near))
                samples += [drops[::7] for _, _, drops in self.tracks.drops(road, points, near)] if road >= 0 else []
            if sum(map(len, samples)) > READING.height_samples or looked_at > READING.max_waiting_points:
                break
        drops = np.concatenate([np.empty(0, np.int32), *samples])
        under = drops[drops > round(VEHICLE.lowest_sensor / COORDINATE_SCALE)]   # in a tunnel as much lies above
        drops = under if len(under) > READING.least_road_share * len(drops) else drops
        # to decimetres, so that it is the same after a change of some points
        return round(float(np.median(drops)) * COORDINATE_SCALE, 1) if len(drops) > READING.min_track_points else READING.default_sensor_height

    def read(self, block: Any, summary: _BlockSummary, ground: _HeightFilter, chosen: _ChosenPoints,
             store: SectionStore) -> Iterator[PartitionedPoints]:
        """Yield the points of a block near the road, ready for the store, until the next ones are asked for; `summary` and `chosen` are updated."""
        for road, points, near in self._near_roads(block, summary, ground, chosen):
            yield self._partition(road, points, near, chosen, store)

    def _partition(self, road, points, mask, chosen, store):
        if road < 0:
            return store.partition(road, points, mask)
        for number, rows, drops in self.tracks.drops(road, points, mask):
            s = points["s"].take(rows)
            chosen.histogram.add(number, drops)
            chosen.coverage.add(number, s, drops)
            chosen.brightness.add(number, chosen.file, s, points["intensity"].take(rows))
        if self.choice.has_time:
            kept = self.slots.kept(points["time"]) & ((points["returns"] & 15) <= 1)
            rows = np.flatnonzero(kept if mask is None else kept & mask)
            if len(rows):
                chosen.sampled.append((points["time"][rows], np.stack([points[name][rows] for name in "xyz"], axis=1)))
        return store.partition(road, points, mask)

    def _count_far(self, road, points, far, chosen):
        """Count the points of a road on the vehicle's own track, (N,) bool of all, that do not lie near its height."""
        rows = np.flatnonzero(far)
        if len(rows):
            for number, on, drops in self.tracks.drops(road, points.take(rows)):
                chosen.coverage.add(number, points["s"].take(rows.take(on)), drops)

    def _near_roads(self, block, summary, ground=None, chosen=None):
        """Yield the points of a block near a road, piece by piece; each piece overwrites the Columns of the one before.

        summary : _BlockSummary, which is updated; ground : _HeightFilter, without which points of any height are taken; chosen : _ChosenPoints, which
        counts those of other heights. Yields road number, Columns of a piece, and (N,) bool of the points to use, None for all; for ground beyond
        the corridor the number is that of `beside_road`, and stations are the vehicle's.
        """
        names = set(block.point_format.dimension_names)
        axes = [LasAxis(*axis, self.dtype[axis[0].lower()]) for axis in zip("XYZ", block.scales, block.offsets, self.frame.origin)]
        # small pieces stay in the processor cache
        for first in range(0, len(block), FRAME.points_per_projection):
            yield from self._piece(block[first:first + FRAME.points_per_projection], names, axes, summary, ground, chosen)

    def _piece(self, piece, names, axes, summary, ground, chosen):
        buffers = self._scratch.of(len(piece))
        columns = self._columns(piece, names, buffers)
        summary.join(_BlockSummary(darkest=int(columns["intensity"].min()), brightest=int(columns["intensity"].max())))
        usable = self._usable(piece, axes, columns, summary, buffers)
        columns["s"], columns["d"] = buffers("s", np.int32), buffers("d", np.int32)
        columns["pass_number"], inside, lost = self._placed(columns, usable)
        summary.without_time += lost
        self._add_scanners(columns, names, inside, summary)
        if inside is not None:
            columns["s"][~inside] = columns["s"][inside.argmax()] if inside.any() else 0   # a valid station of the piece
        points = Columns(columns, self.dtype, len(piece))
        if inside is not None and self.choice.has_time:
            yield from self._beyond(columns, points, inside, ground)
            if not inside.any():
                return
        for number, of_road in self._by_road(columns["pass_number"], inside):
            if ground is not None:
                near = ground.near(number, columns["s"], columns["z"], buffers)
                self._count_far(number, points, _both(of_road, ~near), chosen)
                of_road = _both(of_road, None if near.all() else near)
            if of_road is None or of_road.any():
                yield number, points, of_road

    def _usable(self, piece, axes, columns, summary, buffers):
        """Fill the columns x, y and z; (N,) bool of the points that are valid and no outliers, None for all."""
        usable = valid_points(piece)
        if usable is not None:
            summary.excluded += len(usable) - int(np.count_nonzero(usable))
        for axis, name in zip(axes, "xyz"):
            columns[name], valid = axis.units(piece.array, buffers)
            usable = _both(usable, valid)
        return usable

    def _add_scanners(self, columns, names, inside, summary):
        """Scanners measure together: at the same times of the drive, or without times along the same stretches of road."""
        rows = slice(None) if self.choice.has_time or inside is None else inside
        measured_at = columns["time"] if self.choice.has_time else columns["s"][rows] * COORDINATE_SCALE
        for name, key in zip(SCANNER_FIELDS, ("source", "scanner")):
            if name in names:
                summary.census.add(name, columns[key][rows], measured_at, self._span)

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
            near = np.flatnonzero(x * x + y * y < READING.level_distance**2)
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
        numbers = np.unique(road)
        return [(number, None if len(numbers) == 1 else road == number) for number in numbers.tolist() if number >= 0]

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
        columns["returns"][:] = raw["bit_fields"] if "scanner_channel" in names else packed_returns(piece)
        return columns

    def _placed(self, columns, usable):
        """Fill the columns s and d; (N,) uint16 pass numbers, (N,) bool inside the frame (None for all), and the number of points without a pass."""
        passes, inside = self._located(*map(columns.get, ("x", "y", "time", "s", "d")))
        lost = 0
        if self.choice.has_time and (passes.strides[0] != 0 or passes[0] < 0):
            lost = int(np.count_nonzero(passes < 0 if usable is None else (passes < 0) & usable))
        if usable is not None:
            passes = np.where(usable, passes, np.int16(-1))
        return passes.view(np.uint16), _both(inside, usable), lost

    def _located(self, x, y, time, s, d):
        """Pass numbers and `inside`, as by `RoadProjection.project_units`, with or without times."""
        if self.choice.has_time:
            return self.projection.project_units(x, y, time, s, d)
        road, along, across = self.frame.locate_nearest(x * COORDINATE_SCALE, y * COORDINATE_SCALE, self.choice.corridor)
        fill_units(along, s)
        fill_units(across, d)
        passes = np.full(len(x), -1, np.int16)
        for p in self.frame.passes[::-1]:
            passes[road == p.road] = p.number
        return passes, road >= 0


def _both(one, other):
    """What two masks have in common, either of which may be None for all."""
    if one is None or other is None:
        return other if one is None else one
    return one & other


# The height of the sensor above the road, from the points on the track of the vehicle itself, and whether it is one all along the way.

_RESOLUTION_UNITS = round(READING.height_resolution / COORDINATE_SCALE)
OWN_TRACK_HALF_WIDTH_UNITS = round(READING.own_track_half_width / COORDINATE_SCALE)


class VehicleTracks:
    """The tracks of the vehicle in the road frame, to find the points that lie on them."""

    def __init__(self, frame: RoadFrame):
        self.frame = frame
        # pass number -> first station cell, offsets and heights of the track at the middle of each cell
        self._tracks: dict[int, tuple[int, np.ndarray, np.ndarray]] = {}
        for p in frame.passes:
            first, middles = _cells(*p.span, READING.track_cell_bits)
            offsets, heights = p.at_station(middles)
            self._tracks[p.number] = first, to_units(offsets), to_units(heights)

    def drops(self, road: int, points: Columns, mask: np.ndarray | None = None) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
        """Yield pass number, (M,) rows and depths below the trajectory, units of 0.1 mm, of the points of a road on the pass's own track.

        mask : (N,) bool, points to use; all by default
        """
        if not len(points):
            return
        number, along, across = points["pass_number"], points["s"], points["d"]
        ends = np.array([along.min(), along.max()]) >> READING.track_cell_bits
        only = number.strides[0] == 0 or number.min() == number.max()
        for p in self.frame.passes_of(road):
            if only and p.number != number[0]:
                continue
            first, offsets, heights = self._tracks[p.number]
            low, high = np.clip(ends - first, 0, len(offsets) - 1)
            track = offsets[low:high + 1]
            # most points lie beside the whole track
            near_track = _between(across, int(track.min()) - OWN_TRACK_HALF_WIDTH_UNITS, int(track.max()) + OWN_TRACK_HALF_WIDTH_UNITS)
            if mask is not None:
                near_track &= mask
            if not only:
                near_track &= number == p.number
            rows = np.flatnonzero(near_track)
            cell = (along.take(rows) >> READING.track_cell_bits) - np.int32(first)
            off = across.take(rows)
            off -= offsets.take(cell, mode="clip")
            on = np.flatnonzero(_between(off, -OWN_TRACK_HALF_WIDTH_UNITS, OWN_TRACK_HALF_WIDTH_UNITS))
            if len(on):
                drops = heights.take(cell.take(on), mode="clip")
                rows = rows.take(on)
                drops -= points["z"].take(rows)
                yield p.number, rows, drops


def _between(values, least, most):
    """(N,) bool: which int32 values lie between two limits, both included."""
    above = np.subtract(values, np.int32(least))
    return above.view(np.uint32) <= np.uint32(most - least)


class HeightHistogram:
    """Histogram of the depths below the trajectory of points on the track, by pass; independent of the order of adding.

    about : first estimate of the sensor height, m
    """

    def __init__(self, passes: Iterable[int], about: float):
        self.origin = np.floor(about) - READING.height_range
        self.counts = {number: np.zeros(int(2 * READING.height_range / READING.height_resolution), np.int64) for number in passes}

    def add(self, number: int, drops: np.ndarray) -> None:
        """Count points on the track of a pass; (N,) int32 depths below the trajectory in units of 0.1 mm."""
        k = (drops - np.int32(round(self.origin / COORDINATE_SCALE) - _RESOLUTION_UNITS // 2)) // _RESOLUTION_UNITS
        size = len(self.counts[number])
        self.counts[number] += np.bincount(k[(k >= 0) & (k < size)], minlength=size)

    def join(self, counts: dict[int, np.ndarray]) -> None:
        """Add the counts of another histogram of the same passes and the same first estimate."""
        for number, counted in counts.items():
            self.counts[number] += counted

    def heights(self) -> dict[int, float]:
        """{pass number: metres of the trajectory above the road, to millimetres}; a pass without points on its track gets the median of others.

        The road makes the peak of the histogram, the fullest decimetre. Its height is the median of the points within half a metre of the peak, so
        that bridges and trees above do not count.
        """
        heights = {number: _road_height(counts, self.origin) for number, counts in self.counts.items()}
        measured = [height for height in heights.values() if height is not None]
        usual = float(np.median(measured)) if measured else READING.default_sensor_height
        return {number: usual if height is None else height for number, height in heights.items()}


def sensor_height_of(drops: np.ndarray) -> float | None:
    """Sensor height in metres, of (N,) metres from the trajectory down to points on its track; None for too few points."""
    if len(drops) <= READING.min_track_points:
        return None
    origin = np.floor(np.median(drops)) - READING.height_range
    size = int(2 * READING.height_range / READING.height_resolution)
    k = np.rint((drops - origin) / READING.height_resolution).astype(np.int64)
    return _road_height(np.bincount(k[(k >= 0) & (k < size)], minlength=size), origin)


def _road_height(counts, origin):
    """The median about the fullest decimetre of a histogram per millimetre, of those under a scanner if many are; None for too few points."""
    if counts.sum() <= READING.min_track_points:
        return None
    under = np.arange(len(counts)) * READING.height_resolution + origin > VEHICLE.lowest_sensor
    if counts[under].sum() > READING.least_road_share * counts.sum():   # the ceiling of a tunnel is nearer than the road
        counts = np.where(under, counts, 0)
    bins = counts.reshape(-1, int(round(READING.height_peak_bin / READING.height_resolution))).sum(axis=1)
    # neighbouring bins count too: the road may lie on the border of two bins
    peak = int(np.argmax(np.convolve(bins, np.ones(3), "same")))
    middle = int((peak + 0.5) * READING.height_peak_bin / READING.height_resolution)
    reach = int(READING.height_peak_reach / READING.height_resolution)
    first = max(middle - reach, 0)
    near = np.cumsum(counts[first:middle + reach])
    return round(float(origin + (first + np.searchsorted(near, (near[-1] + 1) // 2)) * READING.height_resolution), 3)


CountsByCell = dict[Any, dict[int, np.ndarray]]   # {key: {cell of station: counts}}


class _TrackCounts:
    """Counts of the points on the vehicle's own track by cell of station, whatever the order of adding."""

    def __init__(self) -> None:
        self.counts: CountsByCell = {}

    def join(self, others: CountsByCell) -> None:
        for key, rows in others.items():
            of_key = self.counts.setdefault(key, {})
            for cell, row in rows.items():
                of_key[cell] = of_key.get(cell, 0) + row

    def _count(self, key, cell, k, bins, far=slice(0), sums=0):
        """Count (N,) points in so many bins k of cells; the last bin gets the sum of (M,) numbers of `far` points instead."""
        first, row = int(cell.min()), cell - cell.min()
        held = np.bincount(row)
        counted = np.bincount(row * bins + k, minlength=len(held) * bins).reshape(-1, bins)
        np.add.at(counted[:, -1], row[far], sums)
        self.join({key: {first + number: counted[number] for number in np.flatnonzero(held).tolist()}})


class _Coverage(_TrackCounts):
    """Counts by pass, cell and depth below the trajectory; the last two are those of points beyond all bins, and the sum of their depths (0.1 mm).

    about : m, first estimate of the height of the trajectory above the road
    """

    def __init__(self, frame: RoadFrame, about: float):
        super().__init__()
        self.frame, self._about = frame, float(to_units(np.array([about]))[0])
        self._ends = {p.number: (to_units(np.array(p.span)) >> READING.coverage_cell_bits).tolist() for p in frame.passes}

    def add(self, number: int, s: np.ndarray, drops: np.ndarray) -> None:
        """Count points of a pass: (N,) int32 stations and depths below the trajectory, units of 0.1 mm."""
        bins = READING.coverage_bins
        k = np.floor((drops - self._about) * (COORDINATE_SCALE / READING.coverage_step)).astype(np.int64) + bins // 2
        far = (k < 0) | (k >= bins)
        self._count(number, np.clip(s >> READING.coverage_cell_bits, *self._ends[number]), np.where(far, bins, k), bins + 2, far, drops[far])

    def _of(self, number):
        """(C, bins + 2) counts of all cells of a pass."""
        first, last = self._ends[number]
        counts = np.zeros((last - first + 1, READING.coverage_bins + 2), np.int64)
        for cell, row in self.counts.get(number, {}).items():
            counts[cell - first] = row
        return counts

    def warnings(self) -> tuple[str, str]:
        """What to tell of stretches that were driven and show a road at another height, and of those that show none; "" for nothing."""
        moved: list[tuple[int, float, float]] = []
        holes: list[tuple[int, float, float]] = []
        metres: list[float] = []
        for road in self.frame.roads:
            passes = self.frame.passes_of(road.number)
            first = min(self._ends[p.number][0] for p in passes)
            driven, seen = np.zeros((2, max(self._ends[p.number][1] for p in passes) - first + 1), bool)
            for p in passes:
                at, counts = self._ends[p.number][0] - first, self._of(p.number)
                higher = self._levels(counts.sum(axis=0, keepdims=True)) - self._levels(counts)
                for start, end in _runs(np.abs(higher) > READING.other_level, first + at, READING.least_moved):
                    moved.append((road.number, *_stations(start, end)))
                    metres += higher[start - first - at:end - first - at].tolist()
                seen[at:at + len(counts)] |= counts[:, :-2].any(axis=1) | np.isfinite(higher)
                driven[at + 1:at + len(counts) - 1] = True
            where = np.flatnonzero(seen)
            hole = driven & ~seen
            hole[:where.min(initial=len(hole))] = hole[where.max(initial=0):] = False
            # two surveys along one trajectory have more between them than a file that is missing
            if hole.sum() < len(where):
                holes += [(road.number, *_stations(start, end)) for start, end in _runs(hole, first, READING.least_hole)]
        return (f"The trajectory does not keep to one height above the road: along {_named(moved)} the road lies {np.median(metres):+.2g} m from its "
                "usual height. Heights may be in feet in one file, or of two kinds: export all from one solution." if moved else "",
                f"No point was kept under the vehicle along {_named(holes)} of the drive, though there are some before and behind. Give all files: "
                "one may be missing." if holes else "")

    def _levels(self, counts):
        """m down from the trajectory, less `about`, to where most points of cells lie, of (C, bins + 2) counts; NaN for too few points."""
        near, far = counts[:, :-2], counts[:, -2]
        padded = np.pad(near, ((0, 0), (1, 1)))
        windows = np.stack([padded[:, k:k + near.shape[1]] for k in range(3)])   # each bin with its neighbours
        peak, rows = windows.sum(axis=0).argmax(axis=1), np.arange(len(counts))
        weights = windows[:, rows, peak]
        level = (peak + (weights[2] - weights[0]) / np.maximum(weights.sum(axis=0), 1) + 0.5 - near.shape[1] // 2) * READING.coverage_step
        beyond = near.sum(axis=1) < READING.least_near_share * far
        level[beyond] = COORDINATE_SCALE * (counts[beyond, -1] / far[beyond] - self._about)
        return np.where(counts[:, :-1].sum(axis=1) > READING.min_track_points, level, np.nan)


class _Brightness(_TrackCounts):
    """Counts by pass and file, cell and brightness of the road."""

    def add(self, number: int, file: str, s: np.ndarray, intensity: np.ndarray) -> None:
        """Count points of a pass and a file: (N,) int32 stations, units of 0.1 mm, and intensities."""
        k = (np.log2(np.maximum(intensity, 1)) * READING.brightness_steps).astype(int)
        self._count((number, file), s >> READING.brightness_cell_bits, k, 16 * READING.brightness_steps)

    def warning(self) -> str:
        """What to tell of files along one drive of which one goes on where the other ends, the same road with another brightness; "" for nothing."""
        steps: dict[tuple[str, str], list[float]] = {}
        for pair, octaves in self._seams():
            steps.setdefault(pair, []).extend(octaves)
        usual = {pair: float(np.median(octaves)) for pair, octaves in steps.items() if octaves and np.ptp(octaves) < READING.least_brightness_step}
        pair, octaves = max(usual.items(), key=lambda step: abs(step[1]), default=(("", ""), 0.0))
        if abs(octaves) < READING.least_brightness_step:
            return ""
        dark, bright = pair[::int(np.sign(octaves))]
        return (f"The road is about {2 ** abs(octaves):.2g} times brighter in {bright} than in {dark}, though one goes on from the other. Paint may "
                "be missed in either: export both with one scale of intensities.")

    def _seams(self):
        """Yield pairs of files along a pass, and the octaves by which the second is brighter in cells that both have or that touch."""
        levels = {key: self._levels(rows) for key, rows in self.counts.items()}
        for (number, before), (other, after) in combinations(sorted(levels), 2):
            here, there = levels[number, before], levels[other, after]
            # those that measure together, as two scanners, may differ
            if number == other and 2 * len(here.keys() & there.keys()) <= min(len(here), len(there)):
                yield (before, after), [there[cell + by] - here[cell] for cell in here for by in (-1, 0, 1) if cell + by in there]

    def _levels(self, rows):
        """{cell: octaves of the median brightness} of cells that have enough points."""
        summed = {cell: np.cumsum(row) for cell, row in rows.items() if row.sum() > READING.min_track_points}
        return {cell: float(np.interp(row[-1] / 2, row, np.arange(1, len(row) + 1))) / READING.brightness_steps for cell, row in summed.items()}


def _runs(chosen: np.ndarray, first: int, least: float) -> Iterator[tuple[int, int]]:
    """(first, last + 1) of the runs of (C,) chosen cells that are longer than so many metres; `first` is the number of the first cell."""
    return ((first + a, first + b) for a, b in mask_runs(chosen) if np.subtract(*_stations(b, a)) > least)


def _stations(*cells):
    """m of the starts of cells."""
    return tuple(COORDINATE_SCALE * (cell << READING.coverage_cell_bits) for cell in cells)


def _named(stretches):
    longest = sorted(stretches, key=lambda stretch: stretch[1] - stretch[2])[:READING.told_stretches]
    places = "; ".join(f"road {road}, station {start:.0f} to {end:.0f} m" for road, start, end in longest)
    return f"{sum(end - start for _, start, end in stretches):.0f} m ({places}{'; …' if len(stretches) > len(longest) else ''})"


# Files are read into the section store part by part, by whoever runs phases. The height of the road is estimated from a look at the first blocks.


@dataclass(frozen=True)
class _PointsRead:
    """Points in a section store, and what they say of the whole survey."""

    store: SectionStore
    summary: _BlockSummary   # of all points
    slots: TimeSlots   # of the points by which scanners are distinguished that no field distinguishes
    sampled: list[tuple[np.ndarray, np.ndarray]]   # their (N,) times and (N, 3) units of 0.1 mm, in no order; without times none
    heights: dict[int, float]   # {pass number: metres from the trajectory down to the road}
    moved: str   # moved, holes: as of `_Coverage.warnings`
    holes: str
    scales: str   # as of `_Brightness.warning`


def read_files(files: list[CloudHeader], frame: RoadFrame, store: SectionStore, choice: PointChoice, block: int, executor: Executor,
                progress: Progress) -> _PointsRead:
    """Read all files into a store as a phase, `block` points at a time, after a look at the first of them."""
    slots = TimeSlots.for_points(sum(file.count for file in files), READING.max_split_samples)
    blocks, summary, sampled, readers = _BlockReader(frame, choice, slots), _BlockSummary(), [], ParallelCloudReader(choice.layers)
    ranges = list(readers.ranges(files, block))
    drop = blocks.rough_drop((points for number, first, count in ranges for points in readers.points(files[number], first, count, block)), progress)
    facts = {"the lines of the roads": frame, "the height of the trajectory above the road": drop,
             "its number of points, their times or their intensities": (choice, block, slots, store.section_length)}
    executor.stand_on("reading", facts, progress)
    by_path, rows = [replace(file, path=os.path.abspath(file.path), crs="") for file in files], np.array(ranges, np.int64).reshape(-1, 3)
    chosen, source = blocks.chosen(drop), _PartsOfFiles({file.path: file for file in by_path}, store, blocks, drop, {
        file.path: rows[rows[:, 0] == number, 1:] for number, file in enumerate(by_path)}, block)
    phase = Phase(_read_part, source, (), source.place, _join_parts, state=source.state)
    points = block if store.folder is None else READING.part_points   # threads read block by block
    for part in executor.run(phase, source.items(points), progress):
        summary.join(part.summary)
        chosen.histogram.join(part.drops)
        chosen.coverage.join(part.coverage)
        chosen.brightness.join(part.brightness)
        sampled.append((part.times, part.places))
        store.adopt(part.index, store.folder)
    return _PointsRead(store, summary, slots, sampled, chosen.histogram.heights(), *chosen.coverage.warnings(),
                       chosen.brightness.warning())


# The phase of reading: ranges of points of the files, each decoded, placed and written to the store's folder by whoever is given it.


@dataclass(frozen=True)
class _PartOfFiles:
    """What a range of points shows: where those lie that were kept, and what all contribute to the knowledge of the cloud."""

    index: StoreIndex
    summary: _BlockSummary
    drops: dict[int, np.ndarray]   # {pass number: counts of its HeightHistogram}
    coverage: CountsByCell   # coverage, brightness: of its _Coverage and _Brightness
    brightness: CountsByCell
    times: np.ndarray   # times, places: (N,) s and (N, 3) units of 0.1 mm of the sampled points
    places: np.ndarray


class _PartsOfFiles:
    """Files whose points are read part by part into the folder of a store; several threads may do so.

    files : by path; store : of which dtype, section length and folder count; drop : m from the trajectory down to the road, about
    ranges : {path: (B, 2) index of the first point and points of every block, which has about `block` points}
    """

    def __init__(self, files: Mapping[str, CloudHeader], store: SectionStore, reader: _BlockReader, drop: float, ranges: Mapping[str, np.ndarray],
                 block: int):
        self.files, self.store, self.reader = files, store, reader
        self.ground = _HeightFilter(reader.frame, drop, reader.choice.above_road)
        self.drop, self.ranges, self.block = drop, ranges, block
        self.clouds = ParallelCloudReader(reader.choice.layers)

    def recipe(self, folder: Path) -> Recipe:
        """How other processes read the same."""
        reader = Recipe("core.survey.blocks:_BlockReader", dict(frame=self.reader.frame, choice=self.reader.choice, slots=self.reader.slots))
        return Recipe("core.survey.blocks:_PartsOfFiles", dict(
            files=self.files, store=self.store.recipe(folder), reader=reader, drop=self.drop, ranges=self.ranges, block=self.block))

    def items(self, points: int) -> list[tuple[str, int, int]]:
        """Path of a file, and (first, last + 1) numbers of blocks of it that have about so many points together."""
        items: list[tuple[str, int, int]] = []
        for path, blocks in self.ranges.items():
            begins = np.unique(blocks[:, 0] // points, return_index=True)[1].tolist()
            items += [(path, first, end) for first, end in zip(begins, [*begins[1:], len(blocks)])]
        return items

    def state(self, item: tuple[str, int, int]) -> Any:
        """By which a later run knows what was read of a file; one that was written again may have the same header."""
        return states_of([self.files[item[0]]]), self.files[item[0]]

    def place(self, item: tuple[str, int, int]) -> str:
        """What messages call blocks."""
        path, first, end = item
        (first, _), (begin, count) = self.ranges[path][[first, end - 1]].tolist()
        return f"{Path(path).name}, points {first + 1:,} to {begin + count:,}"


def _read_part(source: _PartsOfFiles, item: tuple[str, int, int]) -> _PartOfFiles:
    """The phase of reading: the points of some blocks of a file, as of `items`, that lie near the road."""
    chosen, summary, (path, begin, end) = source.reader.chosen(source.drop), _BlockSummary(), item
    chosen.file = path
    with source.store.part() as store:
        for first, count in source.ranges[path][begin:end].tolist():
            for points in source.clouds.points(source.files[path], first, count, source.block):
                check_cancelled()
                for part in source.reader.read(points, summary, source.ground, chosen, store):
                    store.add(part)
    index = store.index()
    sampled = list(zip(*chosen.sampled)) or [[np.empty(0)], [np.empty((0, 3), np.int32)]]
    return _PartOfFiles(index, summary, chosen.histogram.counts, chosen.coverage.counts, chosen.brightness.counts,
                        *(np.concatenate(column) for column in sampled))


def _join_parts(parts: list[_PartOfFiles]) -> _PartOfFiles:
    """One part of several that follow each other."""
    summary, coverage, brightness = _BlockSummary(), _TrackCounts(), _TrackCounts()
    drops: dict[int, np.ndarray] = {}
    for part in parts:
        summary.join(part.summary)
        coverage.join(part.coverage)
        brightness.join(part.brightness)
        drops = {number: counts + drops.get(number, 0) for number, counts in part.drops.items()}
    return _PartOfFiles(StoreIndex.join([part.index for part in parts]), summary, drops, coverage.counts, brightness.counts,
                        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("times", "places")))
