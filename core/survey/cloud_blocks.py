"""Blocks of point cloud files, read from anywhere and by several threads.

Points of a LAZ file are compressed some thousand together (a chunk), and can only be
decoded from the first of a chunk on: blocks are whole chunks.
"""

import threading
from functools import partial

import numpy as np

from .laz_check import chunks_of
from .point_cloud import layers, open_cloud, read_blocks, read_points, told

LARGEST = 4      # blocks that a chunk may fill, or its points are read one block after the other
SAMPLES, SAMPLE = 5, 1000  # places in a file that are looked at, points at each


class CloudReaders:
    """Files read by several threads, each with a reader of its own for the file it is at.

    Parameters
    ----------
    wanted : the layers that are decoded, as in `open_cloud`
    """

    def __init__(self, wanted=None):
        self._wanted, self._readers = wanted, {}  # thread -> path, reader

    def __enter__(self):
        return self

    def __exit__(self, *problem):
        for _, reader in self._readers.values():
            reader.close()

    def blocks(self, files, size):
        """Yield functions, in the order of the points, that return a laspy point record of about `size` points.

        Any thread may call them. What cannot be read from anywhere is read here, one block after the other.
        """
        for file in files:
            chunk = min(file.chunk, file.count)
            if not file.count:
                continue
            if not chunk:
                yield from (partial(self._chunks, file.path, *some) for some in _chunks_by(file, size))
            elif chunk <= LARGEST * size:
                step = chunk * max(size // chunk, 1)
                yield from (partial(self._points, file.path, first, step) for first in range(0, file.count, step))
            else:
                for points in read_blocks(file.path, size, self._wanted):
                    yield partial(_as_it_is, points)

    def times(self, file):
        """Yield (N,) gps_time of a few points at several places of a file, the first and the last among them."""
        if file.chunk:
            starts = np.linspace(0, max(file.count - SAMPLE, 0), SAMPLES).astype(int)
            # a chunk is decoded from its start on
            starts[:-1] -= starts[:-1] % file.chunk
            loads = [partial(self._points, file.path, int(start), SAMPLE) for start in np.unique(starts)]
        else:
            loads = [partial(self._chunks, file.path, *some) for some in _chunks_by(file, 1)]
            loads = [loads[k] for k in np.unique(np.linspace(0, len(loads) - 1, SAMPLES).astype(int))]
        for load in loads:
            yield np.array(load()["gps_time"], float)

    def _points(self, path, first, count):
        return read_points(self._reader(path), path, first, count)

    def _chunks(self, path, record, place, first, table):
        """The points of chunks that begin at a byte: (points, bytes) of each."""
        import laspy
        import lazrs

        header = self._reader(path).header

        def read():
            points = np.zeros(sum(count for count, _ in table) * header.point_format.size, np.uint8)
            with open(path, "rb") as file:
                file.seek(place)
                compressed = file.read(sum(length for _, length in table))
            lazrs.decompress_points_with_chunk_table(compressed, record, points, table, layers(self._wanted).to_lazrs())
            return laspy.PackedPointRecord.from_buffer(points, header.point_format)

        packed = told(read, path, header.point_count, first)
        return laspy.ScaleAwarePointRecord(packed.array, packed.point_format, header.scales, header.offsets)

    def _reader(self, path):
        thread = threading.get_ident()
        at, reader = self._readers.get(thread, (None, None))
        if at != path:
            if reader is not None:
                reader.close()
            reader = open_cloud(path, self._wanted, again=True)
            self._readers[thread] = path, reader
        return reader


def _chunks_by(file, size):
    """Runs of chunks of about `size` points: (LASzip record, first byte, number of the first point, [(points, bytes)])."""
    record, place, table = chunks_of(file.path)
    first, some = 0, []
    for count, length in table:
        some.append((count, length))
        if sum(points for points, _ in some) >= size:
            yield record, place, first, some
            place, first, some = place + sum(length for _, length in some), first + sum(points for points, _ in some), []
    if some:
        yield record, place, first, some


def _as_it_is(points):
    return points
