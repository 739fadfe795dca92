"""Blocks of point cloud files, decoded by several threads at once, and the points about a place."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...common.parallel import ScratchBuffers, ordered_map
from ...common.progress import Progress
from ...lazy import laspy, lazrs
from ..weights import LAS
from .header import chunks_of
from .reader import MAX_INTENSITY, CloudHeader, damage_from, layer_selection, open_cloud, read_blocks, read_headers, states_of, truncated_file_error


class ParallelCloudReader:
    """Files read by several threads, each of which reuses one buffer for its points; `layers` as in `open_cloud`."""

    def __init__(self, layers: Sequence[str] | None = None):
        self._layers, self._buffers = layers, ScratchBuffers()

    def ranges(self, files: Sequence[CloudHeader], size: int) -> Iterator[tuple[int, int, int]]:
        """Yield (number of a file, index of the first point, points) of ranges of about `size` points, in the order of the points.

        A range is whole chunks of a file, or the whole file where its chunks are too large to be decoded apart.
        """
        for number, file in enumerate(files):
            if not file.count:
                continue
            if _in_one_piece(file, size):
                yield number, 0, file.count
            elif _layout(file).header.are_points_compressed:
                yield from ((number, *run) for run in self._chunk_runs(file, size))
            else:
                yield from ((number, first, min(size, file.count - first)) for first in range(0, file.count, size))

    def points(self, file: CloudHeader, first: int, count: int, size: int) -> Iterator[Any]:
        """Yield the points of a range, as of `ranges` with the same size, as laspy point records; the next may overwrite one."""
        whole = _in_one_piece(file, size)
        for points in read_blocks(file.path, size, self._layers, file.units) if whole else (self._load(file, first, count),):
            if file.brightness > 1:
                points.array["intensity"] = file.brightness * np.minimum(points.array["intensity"], MAX_INTENSITY // file.brightness)
            yield points

    def _load(self, file, first, count):
        """The points of a range of whole chunks, or of any points of a LAS file."""
        header, record, ends, places = _layout(file)
        if not header.are_points_compressed:
            return self._read_uncompressed(file.path, header, first, count)
        buffer = self._buffers.of(count * header.point_format.size)("points", np.uint8)
        k, end = np.searchsorted(ends, (first, first + count))
        table = [(points, nbytes) for points, nbytes in np.diff([ends[k:end + 1], places[k:end + 1]]).T.tolist() if points]
        with damage_from(file.path, header.point_count, first):
            with open(file.path, "rb") as stream:
                stream.seek(places[k])
                compressed = stream.read(places[end] - places[k])
            lazrs.decompress_points_with_chunk_table(compressed, record, buffer, table, layer_selection(self._layers).to_lazrs())
        return _point_record(buffer, header)

    def times(self, file: CloudHeader) -> Iterator[np.ndarray]:
        """Yield (N,) gps_time in seconds of a few points at several places of a file, its first and last points among them."""
        if file.chunk:
            starts = np.linspace(0, max(file.count - LAS.points_per_sample, 0), LAS.sampled_places).astype(int)
            starts[:-1] -= starts[:-1] % file.chunk   # a chunk is decoded from its start on
            samples = self._few(file, np.unique(starts).tolist(), LAS.points_per_sample)
        else:
            runs = list(self._chunk_runs(file, 1))
            samples = (self._load(file, *runs[k]) for k in np.unique(np.linspace(0, len(runs) - 1, LAS.sampled_places).astype(int)))
        for points in samples:
            yield np.array(points["gps_time"], float)

    def chunk_start(self, file: CloudHeader, at: int) -> int:
        """Index of the first point of the chunk that holds the point `at`."""
        if file.chunk:
            return at - at % file.chunk
        ends = _layout(file).ends
        return int(ends[np.searchsorted(ends, at, side="right") - 1])

    def following(self, file: CloudHeader, start: int, count: int) -> Iterator[Any]:
        """Yield laspy point records of `count` points, or of chunks where their size varies, from the first point of a chunk on.

        A chunk is decoded no further than its points are asked for; the next record may overwrite one.
        """
        if file.chunk:
            yield from self._few(file, range(start, file.count, count), count)
            return
        for run in self._chunk_runs(file, 1):
            if run[0] >= start:
                yield self._load(file, *run)

    def _chunk_runs(self, file, size):
        """Yield (index of the first point, points) of runs of as many chunks as `size` points hold, at least one."""
        first = before = 0
        for end in _layout(file).ends.tolist():
            if before > first and end - first > size:
                yield first, before - first
                first = before
            before = end
        if before > first:
            yield first, before - first
        if before < file.count:
            raise truncated_file_error(file.path, file.count, before)

    def _few(self, file, starts, count):
        """Yield the first of so many points of chunks that begin at an index, or those that follow the ones before."""
        header, record, *_ = _layout(file)
        if not header.are_points_compressed:
            yield from (self._read_uncompressed(file.path, header, first, min(count, file.count - first)) for first in starts)
            return
        with open(file.path, "rb") as stream:
            stream.seek(header.offset_to_point_data)
            decoder, at = lazrs.LasZipDecompressor(stream, record, layer_selection(self._layers).to_lazrs()), None
            for first in starts:
                buffer = np.empty(min(count, file.count - first) * header.point_format.size, np.uint8)
                with damage_from(file.path, header.point_count, first):
                    if first != at:
                        decoder.seek(first)
                    decoder.decompress_many(buffer)
                at = first + count
                yield _point_record(buffer, header)

    def _read_uncompressed(self, path, header, first, count):
        """`count` points of a LAS file from index `first` on."""
        buffer = self._buffers.of(count * header.point_format.size)("points", np.uint8)
        with damage_from(path, header.point_count, first), open(path, "rb") as file:
            file.seek(header.offset_to_point_data + first * header.point_format.size)
            read = file.readinto(buffer)
        if read < len(buffer):
            raise truncated_file_error(path, header.point_count, first + read // header.point_format.size)
        return _point_record(buffer, header)


class _Layout(NamedTuple):
    """laspy's header of a file and, of C chunks, its LASzip record, and (C + 1,) points before the bounds of chunks and bytes there."""

    header: Any
    record: bytes = b""
    ends: np.ndarray = np.zeros(1, np.int64)
    places: np.ndarray = np.zeros(1, np.int64)


def _layout(file):
    return _read_layout(file, states_of([file])[0])


@lru_cache(LAS.most_layouts)
def _read_layout(file, state):
    with open_cloud(file.path, known=file) as reader:
        header = reader.header
    header.evlrs = None   # they may be large, as the hierarchy of a COPC file is
    if not header.are_points_compressed:
        return _Layout(header)
    record, start, table = chunks_of(file.path)
    ends, places = np.cumsum([(0, start), *table], axis=0).T
    return _Layout(header, record, np.minimum(ends, file.count), places)   # for the last chunk the table may state the capacity


def _point_record(buffer, header):
    packed = laspy.PackedPointRecord.from_buffer(buffer, header.point_format)
    return laspy.ScaleAwarePointRecord(packed.array, packed.point_format, header.scales, header.offsets)


def _in_one_piece(file, size):
    """Whether the chunks of a file are too large to be decoded apart."""
    return min(file.chunk, file.count) > LAS.max_blocks_per_chunk * size


# Points about a place. What lies where in a file is noted when it is read first, so that later places take only the ranges that lie there.

State = tuple[str, int, int]   # path of a file, its bytes, and when it was written: a file with another one is another file


def points_near(paths: Iterable[str | os.PathLike[str]], x: float, y: float, radius: float, progress: Progress = Progress()) -> np.ndarray:
    """The points within a square about a place, (N, 4) x, y, z in map coordinates and intensity, in file order.

    Files whose bounds lie elsewhere are not opened beyond their header. A file is read as a whole for its first place alone; who cancels that and
    asks again goes on from there. Only these points, the blocks being read and those of the last places are held in memory.

    paths : of point clouds
    x, y : map coordinates of the middle
    radius : m, half the side of the square

    Raises RoadExtractionError if a file is missing or cannot be read.
    """
    files = _opened(tuple(map(_state, paths)))
    units = files[0].header.units   # of the map, in which the results of these clouds are
    place = units.in_metres((x, y))
    reader = ParallelCloudReader(("z", "intensity"))
    ranges = [(file, number) for file in files for number in file.numbers(reader, place, radius)]
    parts = ordered_map(lambda item: item[0].within(item[1], place, radius), ranges, progress)
    points = np.concatenate([np.empty((0, 4)), *parts])
    if not units.metric:
        points[:, :3] = units.in_file(points[:, :3].T).T
    return points


def _state(path):
    try:
        status = os.stat(path)
    except OSError:   # which `read_headers` tells
        return str(path), -1, -1
    return str(path), status.st_size, status.st_mtime_ns


@lru_cache(maxsize=LAS.remembered_surveys)
def _opened(states):
    return [_RangesOfFile(header) for header in read_headers([path for path, _, _ in states])]


@dataclass(frozen=True)
class _Stored:
    """Points as a file stores them, in less memory than their coordinates take."""

    raw: list[np.ndarray]   # 3 of (N,) int32
    intensity: np.ndarray   # (N,) uint16
    scale: np.ndarray   # scale, offset: (3,) m
    offset: np.ndarray

    @classmethod
    def of(cls, blocks):
        """Of laspy point records."""
        *raw, intensity = (np.concatenate([block.array[name] for block in blocks]) for name in ("X", "Y", "Z", "intensity"))
        return cls(raw, intensity, blocks[0].scales, blocks[0].offsets)

    def places(self, rows):
        """(3, M) coordinates of some points, m."""
        return np.stack([numbers[rows] * scale + offset for numbers, scale, offset in zip(self.raw, self.scale, self.offset)])

    def within(self, place, radius):
        """(M, 4) x, y, z, m, and intensity of those in a square."""
        near = np.ones(len(self.intensity), bool)
        for numbers, middle, scale, offset in zip(self.raw, place, self.scale, self.offset):
            near &= np.abs(numbers - (middle - offset) / scale) <= radius / abs(scale)
        return np.c_[self.places(near).T, self.intensity[near]]


@dataclass(eq=False)
class _RangesOfFile:
    """The ranges of points of a file, and of those that were read the bounds in which points lie."""

    header: CloudHeader
    ranges: list[tuple[int, int]] = field(default_factory=list)   # (first, count)
    bounds: dict[int, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)   # {number of a range: (2,) m, the lowest, and the highest}

    def within(self, number, place, radius):
        """(N, 4) x, y, z, m, and intensity of those points of a range that lie in a square; none where no point of the range lies near it."""
        if not self.may_hold(number, place, radius):   # another thread has read it meanwhile
            return np.empty((0, 4))
        stored = (_remembered if self.ranges[number][1] <= 2 * LAS.points_per_range else _RangesOfFile.stored)(self, number)
        return stored.within(place, radius)

    def stored(self, number):
        """The points of a range, whose bounds are known from then on."""
        stored = _Stored.of(list(ParallelCloudReader(("z", "intensity")).points(self.header, *self.ranges[number], LAS.points_per_range)))
        places = stored.places(slice(None))[:2]
        self.bounds[number] = places.min(axis=1), places.max(axis=1)
        return stored

    def numbers(self, reader, place, radius):
        """Numbers of the ranges in which points of a square may lie."""
        if not self.may_hold(None, place, radius):
            return []
        if not self.ranges:
            self.ranges = [(first, count) for _, first, count in reader.ranges([self.header], LAS.points_per_range)]
        return [number for number in range(len(self.ranges)) if self.may_hold(number, place, radius)]

    def may_hold(self, number, place, radius):
        """Whether points of a range may lie in a square, by its bounds or, where these are not known, by those of the file."""
        low, high = self.bounds.get(number, (self.header.minimum[:2], self.header.maximum[:2]))
        reach = radius + LAS.bounds_tolerance
        return bool(((low <= place + reach) & (place - reach <= high)).all())


_remembered = lru_cache(LAS.remembered_points // LAS.points_per_range)(_RangesOfFile.stored)   # the next place mostly lies where the last one did
