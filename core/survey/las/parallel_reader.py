"""Blocks of point cloud files, decoded by several threads at once."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ...common.parallel import ScratchBuffers
from ...lazy import laspy, lazrs
from ..weights import LAS
from .header import chunks_of
from .reader import MAX_INTENSITY, CloudHeader, damage_from, layer_selection, open_cloud, read_blocks, read_points, truncated_file_error


class ParallelCloudReader:
    """Files read by several threads, each of which reuses one buffer for its points; `layers` as in `open_cloud`."""

    def __init__(self, layers: Sequence[str] | None = None):
        self._layers = layers
        self._readers: dict[int, tuple[str, Any]] = {}  # thread -> path, laspy.LasReader
        self._layout, self._buffers = lru_cache(LAS.most_layouts)(self._read_layout), ScratchBuffers()

    def __enter__(self) -> ParallelCloudReader:
        return self

    def __exit__(self, *problem: object) -> None:
        for _, reader in self._readers.values():
            reader.close()

    def ranges(self, files: Sequence[CloudHeader], size: int) -> Iterator[tuple[int, int, int]]:
        """Yield (number of a file, index of the first point, points) of ranges of about `size` points, in the order of the points.

        A range is whole chunks of a file, or the whole file where its chunks are too large to be decoded apart.
        """
        for number, file in enumerate(files):
            if not file.count:
                continue
            if _in_one_piece(file, size):
                yield number, 0, file.count
            elif self._layout(file)[0].are_points_compressed:
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
        header, chunks = self._layout(file)
        if not header.are_points_compressed:
            return self._read_uncompressed(file.path, header, first, count)
        record, start, table = chunks
        points, length = table.T
        ends = np.cumsum(points)
        k, end = np.searchsorted(ends, (first, first + count - 1), side="right")
        run = table[k:end + 1].copy()
        run[-1, 0] -= ends[end] - first - count   # for the last chunk the table may state the capacity
        run = [(count, nbytes) for count, nbytes in run.tolist() if count]
        return self._read_chunks(file.path, header, record, start + int(length[:k].sum()), first, run)

    def _read_layout(self, file):
        """laspy's header of a file and, where it is compressed, its LASzip record, first byte and (C, 2) points and bytes of its chunks."""
        with open_cloud(file.path, self._layers, known=file) as reader:
            header = reader.header
        if not header.are_points_compressed:
            return header, None
        record, start, table = chunks_of(file.path)
        return header, (record, start, np.array(table, np.int64).reshape(-1, 2))

    def times(self, file: CloudHeader) -> Iterator[np.ndarray]:
        """Yield (N,) gps_time in seconds of a few points at several places of a file, its first and last points among them."""
        if file.chunk:
            starts = np.linspace(0, max(file.count - LAS.points_per_sample, 0), LAS.sampled_places).astype(int)
            starts[:-1] -= starts[:-1] % file.chunk   # a chunk is decoded from its start on
            samples = (self._read_points(file, start, LAS.points_per_sample) for start in np.unique(starts).tolist())
        else:
            runs = list(self._chunk_runs(file, 1))
            samples = (self._load(file, *runs[k]) for k in np.unique(np.linspace(0, len(runs) - 1, LAS.sampled_places).astype(int)))
        for points in samples:
            yield np.array(points["gps_time"], float)

    def chunk_start(self, file: CloudHeader, at: int) -> int:
        """Index of the first point of the chunk that holds the point `at`."""
        if file.chunk:
            return at - at % file.chunk
        ends = np.cumsum(self._layout(file)[1][2][:, 0])
        k = int(np.searchsorted(ends, at, side="right"))
        return int(ends[k - 1]) if k else 0

    def following(self, file: CloudHeader, start: int, count: int) -> Iterator[Any]:
        """Yield laspy point records of `count` points, or of chunks where their size varies, from the first point of a chunk on.

        A chunk is decoded no further than its points are asked for; the next record may overwrite one.
        """
        if file.chunk:
            for first in range(start, file.count, count):
                yield self._read_points(file, first, count)
            return
        for run in self._chunk_runs(file, 1):
            if run[0] >= start:
                yield self._load(file, *run)

    def _chunk_runs(self, file, size):
        """Yield (index of the first point, points) of runs of as many chunks as `size` points hold, at least one."""
        first = before = 0
        # for the last chunk the table may state the capacity
        for end in np.minimum(np.cumsum(self._layout(file)[1][2][:, 0]), file.count).tolist():
            if before > first and end - first > size:
                yield first, before - first
                first = before
            before = end
        if before > first:
            yield first, before - first
        if before < file.count:
            raise truncated_file_error(file.path, file.count, before)

    def _read_points(self, file, first, count):
        return read_points(self._reader(file), file.path, first, count)

    def _read_chunks(self, path, header, record, place, first, table):
        """The points of chunks that begin at a byte; `table` has (points, bytes) of each."""
        buffer = self._buffers.of(sum(count for count, _ in table) * header.point_format.size)("points", np.uint8)
        with damage_from(path, header.point_count, first):
            with open(path, "rb") as file:
                file.seek(place)
                compressed = file.read(sum(length for _, length in table))
            lazrs.decompress_points_with_chunk_table(compressed, record, buffer, table, layer_selection(self._layers).to_lazrs())
        return _point_record(buffer, header)

    def _read_uncompressed(self, path, header, first, count):
        """`count` points of a LAS file from index `first` on."""
        buffer = self._buffers.of(count * header.point_format.size)("points", np.uint8)
        left = memoryview(buffer)
        with damage_from(path, header.point_count, first), open(path, "rb", buffering=0) as file:
            file.seek(header.offset_to_point_data + first * header.point_format.size)
            while len(left) and (size := file.readinto(left)):
                left = left[size:]
        if len(left):
            raise truncated_file_error(path, header.point_count, first + (len(buffer) - len(left)) // header.point_format.size)
        return _point_record(buffer, header)

    def _reader(self, file):
        path, thread = file.path, threading.get_ident()
        opened, reader = self._readers.get(thread, ("", None))
        if opened != path:
            if reader is not None:
                reader.close()
            reader = open_cloud(path, self._layers, known=file, sparse=True)
            self._readers[thread] = path, reader
        return reader


def _point_record(buffer, header):
    packed = laspy.PackedPointRecord.from_buffer(buffer, header.point_format)
    return laspy.ScaleAwarePointRecord(packed.array, packed.point_format, header.scales, header.offsets)


def _in_one_piece(file, size):
    """Whether the chunks of a file are too large to be decoded apart."""
    return min(file.chunk, file.count) > LAS.max_blocks_per_chunk * size
