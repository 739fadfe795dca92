"""The points from which a trajectory is estimated: an even sample of the first returns of a survey, in order of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..las.parallel_reader import ParallelCloudReader
from ..las.point_fields import ScannerCensus, numbers_by_value, times_by_value, valid_points
from ..las.reader import POINTS_PER_BLOCK, CloudHeader
from ..las.samples import TimeSlots
from ..trajectory.time_systems import SECONDS_PER_WEEK, wrapped_week

SAMPLED_LAYERS = ("z", "point_source_id", "gps_time", "flags", "classification")  # LAZ layers that are decoded
MAX_SAMPLES = 6_000_000   # points held in memory: 250 MB while they are sorted
MAX_GAP_IN_DRIVE = 1.0    # s without points end a drive
UNKNOWN_SCANNER = 255     # number of a point whose scanner is not known
MIN_DRIVE_SAMPLES = 2000  # a drive with fewer is not estimated
MIN_DRIVE_TIME = 1.0      # s: points at one wrong time, however many, are no drive
ROUNDINGS = tuple(sorted((*(10.0**-k for k in range(2, 7)), *(2.0**-k for k in range(6, 20))), reverse=True))   # s, of decimals and of bits
MIN_ROUNDED_SHARE = 0.99  # of the times are multiples of what they are rounded to
ROUNDED_TOLERANCE = 0.25 # of it, which the precision of large times may leave
MAX_ROUNDING_SAMPLES = 100_000
COLUMN_OF_FIELD = {"point_source_id": 0, "scanner_channel": 1}


@dataclass
class Samples:
    """Points in order of time.

    Attributes
    ----------
    time : (N,) seconds since `start`, of the drives; zeros without time
    place : (N, 3) metres from `origin`
    scanner : (N,) numbers of the scanners from 0
    start : s, the gps_time of the first drive's first point
    origin : (3,) map coordinates
    has_time : whether the points' times differ
    drives : slices of the rows between gaps in time
    left_out : points of drives too short to be estimated
    """

    time: np.ndarray
    place: np.ndarray
    scanner: np.ndarray
    start: float
    origin: np.ndarray
    has_time: bool
    drives: list[slice]
    left_out: int = 0

    def __len__(self) -> int:
        return len(self.time)

    @property
    def scanners(self) -> int:
        """The number of scanners."""
        known = self.scanner[self.scanner != UNKNOWN_SCANNER]
        return int(known.max()) + 1 if len(known) else 0


def read_samples(files: Sequence[CloudHeader], scanner_field: str = "automatic", progress: Progress = Progress()) -> Samples:
    """First returns of the files in an even sample of at most MAX_SAMPLES.

    Parameters
    ----------
    files : headers of the clouds
    scanner_field : "automatic", "scanner_channel" or "point_source_id"
    progress : Progress

    Raises
    ------
    RoadExtractionError
        If a file cannot be read, or too few points are left.
    """
    slots = TimeSlots.for_points(sum(file.count for file in files), MAX_SAMPLES)
    origin = np.floor(np.min([file.minimum for file in files if file.count], axis=0))
    census, parts = ScannerCensus(), []

    with ParallelCloudReader(SAMPLED_LAYERS) as readers:
        for found in ordered_map(lambda load: _sample(load(), slots, origin), readers.blocks(files, POINTS_PER_BLOCK), progress):
            time, place, numbers = found
            for name, column in COLUMN_OF_FIELD.items():
                census.take(name, times_by_value(numbers[:, column], time))
            parts.append(found)
    time, place, numbers = (np.concatenate(column) for column in zip(*parts))
    del parts
    if len(time) < MIN_DRIVE_SAMPLES:
        raise RoadExtractionError(
            f"The point clouds have {len(time)} usable points; a trajectory is estimated from {MIN_DRIVE_SAMPLES} and more. Give the whole survey.")
    field, values = census.choose(scanner_field)
    scanner = np.zeros(len(time), np.uint8)
    if field is not None:
        column = numbers[:, COLUMN_OF_FIELD[field]]
        scanner = numbers_by_value(values, int(column.max()) + 1)[column]
    span = float(time.min()), float(time.max())
    if span[0] == span[1]:
        return Samples(np.zeros(len(time)), place, scanner, span[0], origin, False, [slice(0, len(time))])
    if wrapped_week(span):
        time = np.where(time < SECONDS_PER_WEEK / 2, time + SECONDS_PER_WEEK, time)
    return samples_of(time, place, scanner, origin, slots.stride)


def samples_of(time: np.ndarray, place: np.ndarray, scanner: np.ndarray, origin: np.ndarray, stride: int = 1) -> Samples:
    """Points in any order as Samples.

    Parameters
    ----------
    time : (N,) s, not all the same
    place : (N, 3) m from the origin
    scanner : (N,) uint8
    origin : (3,) map coordinates
    stride : every how many points of the survey are among them one is
    """
    order = np.argsort(time, kind="stable")
    time, place, scanner = time[order], place[order], scanner[order]
    cuts = np.flatnonzero(np.diff(time) > MAX_GAP_IN_DRIVE) + 1
    pieces = zip(np.r_[0, cuts].tolist(), np.r_[cuts, len(time)].tolist())
    long = [(a, b) for a, b in pieces if b - a >= MIN_DRIVE_SAMPLES and time[b - 1] - time[a] >= MIN_DRIVE_TIME]
    # from the first drive on: times long before it, which are wrong, would cost the precision of all others
    start = float(time[long[0][0]]) if long else float(time[0])
    ends = np.cumsum([0] + [b - a for a, b in long]).tolist()
    total = len(time)
    if ends[-1] < total and long:
        kept = np.concatenate([np.arange(a, b) for a, b in long])
        time, place, scanner = time[kept], place[kept], scanner[kept]
    return Samples(time - start, place, scanner, start, origin, True, [slice(a, b) for a, b in zip(ends[:-1], ends[1:])],
                   (total - ends[-1]) * stride)


def rounding_of(time: np.ndarray, start: float) -> float:
    """What times are rounded to, s; 0 where that is no power of ten or two.

    Parameters
    ----------
    time : (N,) s since `start`
    start : s
    """
    some = time[::max(len(time) // MAX_ROUNDING_SAMPLES, 1)] + start
    for tick in ROUNDINGS:
        steps = some / tick
        if np.mean(np.abs(steps - np.rint(steps)) <= ROUNDED_TOLERANCE) >= MIN_ROUNDED_SHARE:
            return tick
    return 0.0


def _sample(block, slots, origin):
    """(N,) gps_time, (N, 3) local places and (N, 2) source and channel of the first returns of a block that are in the sample."""
    raw, names = block.array, set(block.point_format.dimension_names)
    time = raw["gps_time"].astype(float) if "gps_time" in raw.dtype.names else np.zeros(len(raw))
    first = np.flatnonzero(np.asarray(block["return_number"]) <= 1)
    # without times neighbours in the file stay together no better than others
    first = first[slots.kept(time[first])] if len(time) and time.min() < time.max() else first[::slots.stride]
    valid = valid_points(block)
    if valid is not None:
        first = first[valid[first]]
    place = np.stack([raw[name][first] * scale + (offset - start)
                      for name, scale, offset, start in zip("XYZ", block.scales, block.offsets, origin)], axis=1)
    time = time[first]
    channel = np.asarray(block["scanner_channel"])[first] if "scanner_channel" in names else np.zeros(len(first), np.int64)
    usable = np.isfinite(time)
    return time[usable], place[usable], np.stack([raw["point_source_id"][first], channel], axis=1).astype(np.int64)[usable]
