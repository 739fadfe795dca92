"""Blocks of point cloud files, read from anywhere and by several threads.

Points of a LAZ file are compressed some thousand together (a chunk), and can only be
decoded from the first of a chunk on: blocks are whole chunks.
"""

import threading
from functools import partial

import numpy as np

from .laz_check import chunks_of
from .point_cloud import cut_off, layers, open_cloud, read_blocks, read_points, told

LARGEST = 4      # blocks that a chunk may fill, or its points are read one block after the other
SAMPLES, SAMPLE = 5, 1000  # places in a file that are looked at, points at each


class CloudReaders:
    """Files read by several threads, each with a room of its own for the points it is at.

    Parameters
    ----------
    wanted : the layers that are decoded, as in `open_cloud`
    """

    def __init__(self, wanted=None):
        self._wanted, self._readers = wanted, {}  # thread -> path, reader
        self._rooms = threading.local()

    def __enter__(self):
        return self

    def __exit__(self, *problem):
        for _, reader in self._readers.values():
            reader.close()

    def blocks(self, files, size):
        """Yield functions, in the order of the points, that return a laspy point record of about `size` points.

        Any thread may call them; its next call may write over the record. What cannot be
        read from anywhere is read here, one block after the other.
        """
        for file in files:
            if not file.count:
                continue
            if min(file.chunk, file.count) > LARGEST * size:
                for points in read_blocks(file.path, size, self._wanted):
                    yield partial(_as_it_is, points)
                continue
            with open_cloud(file.path, self._wanted, again=True) as reader:
                header = reader.header
            if header.are_points_compressed:
                yield from (partial(self._chunks, file.path, header, *some) for some in _chunks_by(file, size))
            else:
                yield from (partial(self._bytes, file.path, header, first, min(size, file.count - first)) for first in range(0, file.count, size))

    def times(self, file):
        """Yield (N,) gps_time of a few points at several places of a file, the first and the last among them."""
        if file.chunk:
            starts = np.linspace(0, max(file.count - SAMPLE, 0), SAMPLES).astype(int)
            # a chunk is decoded from its start on
            starts[:-1] -= starts[:-1] % file.chunk
            loads = [partial(self._points, file.path, int(start), SAMPLE) for start in np.unique(starts)]
        else:
            with open_cloud(file.path, self._wanted, again=True) as reader:
                loads = [partial(self._chunks, file.path, reader.header, *some) for some in _chunks_by(file, 1)]
            loads = [loads[k] for k in np.unique(np.linspace(0, len(loads) - 1, SAMPLES).astype(int))]
        for load in loads:
            yield np.array(load()["gps_time"], float)

    def _points(self, path, first, count):
        return read_points(self._reader(path), path, first, count)

    def _chunks(self, path, header, record, place, first, table):
        """The points of chunks that begin at a byte: (points, bytes) of each."""
        import lazrs

        room = self._room(header, sum(count for count, _ in table))

        def read():
            with open(path, "rb") as file:
                file.seek(place)
                compressed = file.read(sum(length for _, length in table))
            lazrs.decompress_points_with_chunk_table(compressed, record, room, table, layers(self._wanted).to_lazrs())

        told(read, path, header.point_count, first)
        return _record(room, header)

    def _bytes(self, path, header, first, count):
        """`count` points of a file that is not compressed, from number `first` on."""
        room = self._room(header, count)

        def read():
            with open(path, "rb", buffering=0) as file:
                file.seek(header.offset_to_point_data + first * header.point_format.size)
                left = memoryview(room)
                while len(left) and (some := file.readinto(left)):
                    left = left[some:]
                return (len(room) - len(left)) // header.point_format.size

        found = told(read, path, header.point_count, first)
        if found < count:
            raise cut_off(path, header.point_count, first + found)
        return _record(room, header)

    def _room(self, header, count):
        """Bytes for points: those that this thread had before where they are enough, for memory touched first is dear."""
        size, room = count * header.point_format.size, getattr(self._rooms, "bytes", None)
        if room is None or len(room) < size:
            room = self._rooms.bytes = np.empty(size, np.uint8)
        return room[:size]

    def _reader(self, path):
        thread = threading.get_ident()
        at, reader = self._readers.get(thread, (None, None))
        if at != path:
            if reader is not None:
                reader.close()
            reader = open_cloud(path, self._wanted, again=True, few=True)
            self._readers[thread] = path, reader
        return reader


def _record(room, header):
    import laspy

    packed = laspy.PackedPointRecord.from_buffer(room, header.point_format)
    return laspy.ScaleAwarePointRecord(packed.array, packed.point_format, header.scales, header.offsets)


def _chunks_by(file, size):
    """Runs of as many chunks as `size` points hold, one at least: (LASzip record, first byte, number of the first point, [(points, bytes)])."""
    record, place, table = chunks_of(file.path)
    first, held, some = 0, 0, []
    for count, length in table:
        # the table says of the last chunk what it has room for
        count = min(count, file.count - first - held)
        if some and held + count > size:
            yield record, place, first, some
            place, first, held, some = place + sum(length for _, length in some), first + held, 0, []
        if count > 0:
            some.append((count, length))
            held += count
    if some:
        yield record, place, first, some
    if first + held < file.count:
        raise cut_off(file.path, file.count, first + held)


def _as_it_is(points):
    return points
