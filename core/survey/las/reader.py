"""Point cloud files: what their headers say, and their points in blocks."""

import os
import threading
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from ...common.errors import Cancelled, RoadExtractionError
from ...common.parallel import go_on
from .guard import chunks_of, damage, points_per_chunk

POINTS_PER_BLOCK = 400_000  # points decoded at a time
SUFFIXES = (".las", ".laz")
MOST_SCALE, MOST_OFFSET = 1e3, 1e12  # m, of coordinates kept as integers; beyond them nothing on earth lies
NOT_THE_FILE = (KeyboardInterrupt, SystemExit, GeneratorExit, Cancelled, MemoryError)  # reasons that say nothing about the file


@dataclass(frozen=True)
class CloudHeader:
    """What the header of one LAS/LAZ/COPC file says.

    `minimum` and `maximum` are (3,) map coordinates; `crs` is WKT or "";
    `adjusted_time` tells whether gps_time is adjusted standard GPS time
    (global encoding bit 0) or seconds of the GPS week. `chunk` is the number of
    points that are compressed together: 1 in a LAS file, 0 where it changes.
    """

    path: str
    version: str
    point_format: int
    count: int
    minimum: tuple
    maximum: tuple
    scales: tuple
    crs: str
    has_time: bool
    has_channel: bool
    adjusted_time: bool
    chunk: int = 0


def open_cloud(path, wanted=None, again=False, few=False):
    """Open a LAS/LAZ/COPC file for reading with laspy, or say in one sentence why it cannot be read.

    `wanted` names the layers of a LAZ 1.4 file that are decoded beside place and
    return numbers ("z", "intensity" ...), all by default. A file that is opened `again`
    is not looked over for damage once more. Where `few` points are read here and there a
    chunk of a LAZ file is decoded no further than they lie in it, by one thread.
    """
    import laspy

    path = str(path)
    if not Path(path).exists():
        raise RoadExtractionError(f"There is no file {path}. Check the path of the point cloud.")
    if not path.lower().endswith(SUFFIXES):
        raise RoadExtractionError(f"{path} is not a LAS or LAZ file. Lanewright reads .las, .laz and .copc.laz; convert other formats first.")
    if not again and (wrong := damage(path)):
        raise RoadExtractionError(f"{path} is damaged or cut off: {wrong}. Copy or export the file again.")
    try:
        return laspy.open(path, decompression_selection=layers(wanted), laz_backend=laspy.LazBackend.Lazrs if few else None)
    except BaseException as problem:  # laspy and its backends raise many kinds for a damaged file, no Exceptions among them
        if isinstance(problem, NOT_THE_FILE):
            raise
        raise RoadExtractionError(
            f"{path} cannot be read as a LAS/LAZ file ({problem}). It may be damaged or cut off; copy or export it again.") from problem


def layers(wanted):
    """laspy's selection of the layers with these names, of all where they are None."""
    import laspy

    if wanted is None:
        return laspy.DecompressionSelection.all()
    selection = laspy.DecompressionSelection.base()
    for name in wanted:
        selection = getattr(selection, f"decompress_{name}")()
    return selection


def read_header(path):
    """The CloudHeader of a path.

    Raises
    ------
    RoadExtractionError
        If the file is missing, is not LAS/LAZ, or cannot be read.
    """
    with open_cloud(path) as reader:
        header = reader.header
        names = set(header.point_format.dimension_names)
        if not ((np.abs(header.scales) < MOST_SCALE).all() and (np.abs(header.offsets) < MOST_OFFSET).all() and np.all(header.scales)):
            raise RoadExtractionError(
                f"{path} is damaged: its header says scales of {_listed(header.scales)} and offsets of {_listed(header.offsets)}, with which "
                "no point has a place. Export the file again.")
        count, low, high = int(header.point_count), header.mins, header.maxs
        reach = 2.0**31 * np.abs(header.scales)  # of coordinates kept as 32-bit integers
        there = (header.offsets - reach <= low) & (low <= high) & (high <= header.offsets + reach)
        if count > 1 and not (there.all() and (low < high).any()):
            low, high = _bounds(path)  # a program that never filled them in
        return CloudHeader(
            str(path), str(header.version), header.point_format.id, count,
            tuple(map(float, low)), tuple(map(float, high)), tuple(map(float, header.scales)),
            _crs_of(header), "gps_time" in names, "scanner_channel" in names,
            bool(header.global_encoding.gps_time_type.value), points_per_chunk(path))


def _listed(numbers):
    return ", ".join(f"{number:g}" for number in numbers)


def _bounds(path):
    """Least and largest coordinates of the points themselves, (3,) each."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for block in read_blocks(path):
        places = np.stack([np.asarray(block[name], float) for name in "xyz"])
        low, high = np.minimum(low, places.min(axis=1)), np.maximum(high, places.max(axis=1))
    return low, high


def _crs_of(header):
    """WKT of the file's CRS from WKT or GeoKeys records; "" where there is none or it cannot be understood."""
    try:
        crs = header.parse_crs()
    except MemoryError:
        raise
    except Exception:  # an unreadable CRS record counts as no CRS: the user is then asked for one
        return ""
    return "" if crs is None else crs.to_wkt()


def read_blocks(path, size=POINTS_PER_BLOCK, wanted=None):
    """Yield laspy point records of a file, `size` at a time; `wanted` as in `open_cloud`.

    Raises
    ------
    RoadExtractionError
        If the file ends early or is damaged.
    """
    with open_cloud(path, wanted) as reader:
        promised, read = reader.header.point_count, 0
        while read < promised:
            go_on()
            points = read_points(reader, path, read, size)
            read += len(points)
            yield points


def read_points(reader, path, first, count):
    """`count` points of an open file from number `first` on, or what is left of them.

    Raises
    ------
    RoadExtractionError
        If they cannot be read, or the file ends before.
    """
    promised = reader.header.point_count

    def read():
        if reader.points_read != first:
            reader.seek(first)
        return reader.read_points(count)

    points = told(read, path, promised, first)
    if len(points) < min(count, promised - first):
        raise cut_off(path, promised, first + len(points))
    return points


def cut_off(path, promised, found):
    """The error of a file that ends before its last point."""
    return RoadExtractionError(f"{path} is cut off: its header promises {promised} points, {found} are there. Copy or export the file again.")


def told(read, path, promised, first):
    """What a function reads from number `first` on, or in one sentence why it cannot."""
    try:
        return read()
    except BaseException as problem:
        if isinstance(problem, NOT_THE_FILE):
            raise
        raise RoadExtractionError(
            f"{path} is damaged: its header promises {promised} points, and from number {first + 1} on they cannot be read ({problem}). "
            "Copy or export the file again.") from problem


def read_headers(paths):
    """CloudHeader of every path, in the order given; a file given twice, by whatever path, is read once.

    Raises
    ------
    RoadExtractionError
        If there is no file, all files are empty, or the files disagree about their CRS.
    """
    unique = {}
    for path in paths:
        unique.setdefault(os.path.realpath(path), str(Path(path)))
    unique = list(unique.values())
    if not unique:
        raise RoadExtractionError("No point cloud was given. Choose one or more LAS, LAZ or COPC files.")
    files = [read_header(path) for path in unique]
    if not sum(file.count for file in files):
        named = f"The file {unique[0]} holds" if len(files) == 1 else f"The files {', '.join(unique[:3])} hold"
        raise RoadExtractionError(f"{named} no points. Check the export of the survey.")
    return files


# Blocks of point cloud files, read from anywhere and by several threads.

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
