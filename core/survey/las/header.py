"""The header of a LAS or LAZ file and its variable length records, byte by byte, as laspy can read them."""

from __future__ import annotations

import io
import os
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product, takewhile
from typing import BinaryIO

import numpy as np

from ...lazy import lazrs
from ..weights import LAS

VLR_HEADER_SIZE, EVLR_HEADER_SIZE = 54, 60  # source: bytes (LAS 1.4 R15, tables 6 and 7)
LASZIP_USER, LASZIP_RECORD = b"laszip encoded", 22204   # source: LASzip, as the next two
COMPRESSED_BIT = 0x80        # source: of the point format
VARIABLE_CHUNKS = 0xFFFFFFFF  # source: as the size of chunks: each has its own number of points
EXTRA_BYTES_USER, EXTRA_BYTES_RECORD, EXTRA_BYTES_SIZE = b"LASF_Spec", 4, 192   # source: LAS 1.4 R15, table 24
CRS_USER, CRS_TEXTS = b"LASF_Projection", (2111, 2112, 34737)   # source: LAS 1.4 R15; its records of text: WKT, and names of the GeoKeys
MAX_NAME = 24    # derived: bytes of a name to which a number is added, of the 32 that a name may have
TYPE_SIZES = 1, 1, 2, 2, 4, 4, 8, 8, 4, 8   # source: bytes (LAS 1.4 R15, table 25) of types 1 to 10; 11 to 20 are pairs of these, 21 to 30 triples


@dataclass(frozen=True)
class _HeaderFields:
    """The numbers of a header as they stand there."""

    header_size: int
    points_at: int
    vlrs: int
    point_format: int
    compressed: bool
    record_size: int
    count: int   # of points that laspy would take
    counts: tuple[int, ...]   # its counts of points that are not 0, that of 64 bits first
    has_long_count: bool   # whether there is one of 64 bits
    first_waveform: int   # byte of the first waveform packet, 0 without any in the file
    first_evlr: int
    evlrs: int
    scales: np.ndarray   # (3,) metres
    offsets: np.ndarray   # offsets, minimum, maximum: (3,) map coordinates
    minimum: np.ndarray
    maximum: np.ndarray

    @classmethod
    def read(cls, file: BinaryIO) -> _HeaderFields | None:
        """Those of an open file; None where it is no LAS file or too short for a header."""
        file.seek(0)
        head = file.read(375)
        if len(head) < 227 or head[:4] != b"LASF":
            return None
        header_size, points_at, vlrs, kind, record_size, count = struct.unpack_from("<HIIBHI", head, 94)
        version, numbers = head[25], np.frombuffer(head, "<f8", 12, 131)
        waveform = struct.unpack_from("<Q", head, 227)[0] if version >= 3 and len(head) >= 235 else 0
        has_long_count = version >= 4 and len(head) >= 255
        evlr, evlrs, long_count = struct.unpack_from("<QIQ", head, 235) if has_long_count else (0, 0, 0)
        return cls(header_size, points_at, vlrs, kind & 0x3F, bool(kind & COMPRESSED_BIT), record_size, long_count if has_long_count else count,
                   tuple(number for number in (long_count, count) if number), has_long_count, waveform, evlr, evlrs,
                   numbers[:3], numbers[3:6], numbers[7::2], numbers[6::2])

    def records(self, file: BinaryIO, size: int) -> Iterator[_Record]:
        """The variable length records before the points of a file of so many bytes, the last as far as it is there."""
        return _records(file, self.header_size, self.vlrs, VLR_HEADER_SIZE, size)

    def extended(self, file: BinaryIO, size: int) -> list[_Record]:
        """The extended records behind the points that lie in the file."""
        records = _records(file, self.first_evlr, self.evlrs if self.first_evlr >= self.header_size else 0, EVLR_HEADER_SIZE, size)
        return list(takewhile(lambda record: record.at + EVLR_HEADER_SIZE + record.length <= size, records))

    def end_of_points(self, size: int) -> int:
        """The byte before which the points end at the latest, in a file of so many bytes."""
        after = [self.first_waveform] + [self.first_evlr] * bool(self.evlrs)
        return min([size, *(position for position in after if self.points_at <= position <= size)])


@dataclass(frozen=True)
class _Compression:
    """How the points of a file are compressed."""

    data: bytes   # of the LASzip record
    compressor: int   # number of the kind of chunks
    chunk_size: int   # points of a chunk; VARIABLE_CHUNKS where each has its own number
    items: list[tuple[int, int]]   # (type, bytes) of each item of a point

    @classmethod
    def of(cls, record: _Record) -> _Compression | None:
        """What a record says of compressed points; None where it is another one, or too short."""
        data = record.data
        if (record.user, record.number) != (LASZIP_USER, LASZIP_RECORD) or len(data) < 34:
            return None
        compressor, chunk_size, items = struct.unpack_from("<H10xI16xH", data)
        return cls(data, compressor, chunk_size, list(struct.iter_unpack("<HH2x", data[34:34 + 6 * items]))) if len(data) >= 34 + 6 * items else None

    @property
    def point_size(self) -> int:
        """Bytes of a point."""
        return sum(size for _, size in self.items)


@dataclass(frozen=True)
class _Record:
    """A variable length record: where it begins, its header, the length that it states, and as much of its data as is there and looked into."""

    at: int
    head: bytes
    length: int
    data: bytes

    @classmethod
    def read(cls, file: BinaryIO, at: int, head_size: int, size: int) -> _Record | None:
        """That at a byte of a file of so many bytes; None where there is none."""
        if at + head_size > size:
            return None
        file.seek(at)
        head = file.read(head_size)
        length = struct.unpack_from("<H" if head_size == VLR_HEADER_SIZE else "<Q", head, 20)[0]
        # behind the points, where waveforms take gigabytes, only a CRS is looked into, which has less than those before them may have
        looked_into = head_size == VLR_HEADER_SIZE or head[2:18].startswith(CRS_USER) and length < 2**16
        return cls(at, head, length, file.read(length) if looked_into else b"")

    @property
    def user(self) -> bytes:
        """Who defined what it holds."""
        return self.head[2:18].split(b"\0")[0]

    @property
    def number(self) -> int:
        """Of the record, among those of its user."""
        return struct.unpack_from("<H", self.head, 18)[0]

    @property
    def whole(self) -> bytes:
        """All of it, with the length that is there."""
        kind = "<H" if len(self.head) == VLR_HEADER_SIZE else "<Q"
        return self.head[:20] + struct.pack(kind, len(self.data)) + self.head[20 + struct.calcsize(kind):] + self.data

    @property
    def describes_extra_bytes(self) -> bool:
        """Whether it names the extra bytes of points."""
        return self.user == EXTRA_BYTES_USER and self.number == EXTRA_BYTES_RECORD

    def mended(self) -> _Record:
        """The same with a user and a CRS that laspy can decode; itself where nothing is wrong."""
        head = self.head[:2] + _decodable(self.head[2:18]) + self.head[18:]
        data = _decodable(self.data) if self.user == CRS_USER and self.number in CRS_TEXTS else self.data
        return self if (head, data) == (self.head, self.data) else replace(self, head=head, data=data)


def _records(file, position, count, head_size, size):
    """Yield variable length records that follow each other from a byte of a file of so many bytes on."""
    for _ in range(count):
        record = _Record.read(file, position, head_size, size)
        if record is None:
            return
        yield record
        position += head_size + record.length


@cache
def _base_size(point_format: int) -> int | None:
    """Bytes of a point without extra bytes; None for a format that laspy does not know."""
    from laspy import PointFormat, supported_point_formats

    return PointFormat(point_format).size if point_format in supported_point_formats() else None


def _readable_extra_bytes(record: _Record, point_format: int, room: int) -> _Record:
    """A record of extra bytes that describes at most `room` bytes, in names that the point format leaves free; itself where nothing is wrong."""
    from laspy import PointFormat

    taken, left, kept = {*PointFormat(point_format).dimension_names, *PointFormat(point_format).dtype().names, "ExtraBytes"}, room, []
    for number, entry in enumerate(_entries(record), 1):
        size = _size(entry)
        if size == 0:
            continue
        if size is None or size > left:
            break
        left -= size
        name = _name(entry[4:36], taken, number)
        taken.add(name)
        unchanged = name.encode() == entry[4:36].split(b"\0")[0]
        kept.append(entry[:4] + (entry[4:36] if unchanged else name.encode()[:32].ljust(32, b"\0")) + entry[36:160] + _decodable(entry[160:]))
    data = b"".join(kept)
    return record if data == record.data and record.length == len(data) else replace(record, data=data, length=len(data))


def _entries(record):
    """The descriptions of the fields; one that is not whole is none."""
    return [record.data[start:start + EXTRA_BYTES_SIZE] for start in range(0, len(record.data) - EXTRA_BYTES_SIZE + 1, EXTRA_BYTES_SIZE)]


def _size(entry):
    """Bytes of a field; None for a type that nobody defined."""
    kind, options = entry[2], entry[3]
    if kind == 0:
        return options
    return TYPE_SIZES[(kind - 1) % 10] * ((kind - 1) // 10 + 1) if kind <= 30 else None


def _name(text, taken, number):
    """A name in UTF-8 that no other field has."""
    name = _decodable(text.split(b"\0")[0]).decode() or "extra"
    unique, suffix = name, number
    while unique in taken:
        unique, suffix = f"{name.encode()[:MAX_NAME].decode(errors='ignore')}_{suffix}", suffix + 1
    return unique


def _decodable(text: bytes) -> bytes:
    """The same bytes where they are UTF-8 up to the first zero, else with question marks for those beyond ASCII."""
    try:
        text.split(b"\0")[0].decode()
    except UnicodeDecodeError:
        return bytes(byte if byte < 128 else ord("?") for byte in text)
    return text


# Headers of LAS and LAZ files as the points behind them show that they should be.
#
# Exporters leave numbers and texts in a header that do not fit the points: a count from before the last points, lengths of other records, names in
# the encoding of their country. laspy believes all of them. Here such bytes are replaced in memory before laspy reads them, and what may matter to
# the survey is told. Offsets are those of LAS 1.4 (ASPRS, R15, tables 3, 6 and 7) and of its extra bytes (table 25).

MAX_RECORD_SIZE = 65535     # derived: bytes of a point, as 16 bits state them
# derived: whole numbers of 32 bits within which points lie about those stated: the road goes on, but what is read as places and is none lies
# anywhere, or, as text and floating-point numbers, near the upper end; one in eight of it in each axis lies as near by chance
NEAR_STATED = 2**31 // 8
COUNT_AT, LONG_COUNT_AT, RECORD_SIZE_AT, POINTS_AT, EVLR_COUNT_AT = 107, 247, 105, 96, 243   # source: bytes (LAS 1.4 R15, table 3)


@dataclass(frozen=True)
class _MendedHeader:
    """A header, None of no LAS file, with what is read in place of some bytes, (first byte, bytes) each, and the ends of sentences about that."""

    fields: _HeaderFields | None = None
    patches: tuple[tuple[int, bytes], ...] = ()
    notes: tuple[str, ...] = ()

    def with_count(self, count: int) -> _MendedHeader:
        """The same with as many points as there are."""
        fields = self.fields
        if fields is None or count == fields.count:
            return self
        patches = [(COUNT_AT, struct.pack("<I", count if count < 2**32 else 0))]
        if fields.has_long_count:
            patches.append((LONG_COUNT_AT, struct.pack("<Q", count)))
        note = f"its header states {fields.count:,} points, and {count:,} are there: those were read" + (
            ". If it was copied or downloaded, compare its length with the original's" if count < fields.count else "")
        return _MendedHeader(replace(fields, count=count, counts=(count,)), (*self.patches, *patches),
                             self.notes if count in fields.counts else (*self.notes, note))


class _MendedFile(io.FileIO):
    """A file that is read with some bytes replaced."""

    def __init__(self, path: str | os.PathLike[str], patches: Sequence[tuple[int, bytes]]):
        super().__init__(path, "rb")
        self._patches = patches

    def readinto(self, buffer: bytearray | memoryview) -> int:   # type: ignore[override]
        """As that of a file."""
        first = self.tell()
        count = super().readinto(buffer) or 0
        view = memoryview(buffer).cast("B")
        for start, data in self._patches:
            low, high = max(start, first), min(start + len(data), first + count)
            if low < high:
                view[low - first:high - first] = data[low - start:high - start]
        return count


def opened(path: str | os.PathLike[str], mended: _MendedHeader) -> io.BufferedReader:
    """A file open for reading as it was mended."""
    return io.BufferedReader(_MendedFile(path, mended.patches)) if mended.patches else open(path, "rb")  # noqa: SIM115


def mend(path: str | os.PathLike[str]) -> _MendedHeader:
    """What a LAS or LAZ file says of itself against what is in it; points in compressed chunks are not counted here."""
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        stated = _HeaderFields.read(file)
        if stated is None or not stated.header_size <= size:
            return _MendedHeader(stated)
        patches: list[tuple[int, bytes]] = []
        notes: list[str] = []
        records, extended = list(stated.records(file, size)), stated.extended(file, size)
        if len(extended) < stated.evlrs:
            patches.append((EVLR_COUNT_AT, struct.pack("<I", len(extended))))
            notes.append(f"{stated.evlrs - len(extended):,} of its {stated.evlrs:,} extended records lie beyond its end and are left out")
            stated = replace(stated, evlrs=len(extended))
        fields = _lengths(stated, records, size)
        if fields.points_at != stated.points_at:
            patches.append((POINTS_AT, struct.pack("<I", fields.points_at)))
            notes.append(f"its header states that the points begin at byte {stated.points_at:,}, and they begin at {fields.points_at:,}")
        if fields.record_size != stated.record_size:
            patches.append((RECORD_SIZE_AT, struct.pack("<H", fields.record_size)))
            notes.append(f"its header states {stated.record_size} bytes per point, and there are {fields.record_size}")
        patches += _mended_records(records, fields)
        patches += [(before.at, record.head + record.data) for before in extended if (record := before.mended()) is not before]
        mended = _MendedHeader(fields, tuple(patches), tuple(notes))
        return mended if fields.compressed else mended.with_count(_points_in_las(file, fields, size))


def _lengths(fields, records, size):
    """The fields with the place and the length of the points by which they fill the file."""
    base = _base_size(fields.point_format)
    if base is None:
        return fields
    if fields.compressed:
        # the decoder cannot do without the record that says of what its points consist
        point_size = next((compression.point_size for record in records if (compression := _Compression.of(record))), 0)
        return replace(fields, record_size=point_size) if base <= point_size <= MAX_RECORD_SIZE else fields
    places = fields.points_at, records[-1].at + len(records[-1].head) + records[-1].length if records else fields.header_size
    described = sum(_size(entry) or 0 for record in records if record.describes_extra_bytes for entry in _entries(record))
    for points_at, record_size in product(places, (fields.record_size, base + described, base)):
        # as many points as are stated, of so many bytes each, end where the points of the file end
        if base <= record_size <= MAX_RECORD_SIZE and points_at <= size \
                and fields.end_of_points(size) in [points_at + count * record_size for count in fields.counts]:
            return replace(fields, points_at=points_at, record_size=record_size)
    return fields


def _mended_records(records, fields):
    """The patch of the records before the points, where any cannot be read as it is."""
    base = _base_size(fields.point_format)
    mended = [record.mended() for record in records]
    if base is not None:
        mended = [_readable_extra_bytes(record, fields.point_format, fields.record_size - base) if record.describes_extra_bytes else record
                  for record in mended]
    if all(record is before for record, before in zip(mended, records)):
        return []
    data = b"".join(record.whole for record in mended)
    room = fields.points_at - fields.header_size
    return [(fields.header_size, data.ljust(room, b"\0"))] if len(data) <= room else []


def _points_in_las(file, fields, size):
    """The points of an uncompressed file by its length; what its header states where nothing is sure."""
    if fields.record_size < 20 or not fields.header_size <= fields.points_at <= size:
        return fields.count
    points, rest = divmod(fields.end_of_points(size) - fields.points_at, fields.record_size)
    if points in fields.counts:
        return points
    fitting = max((count for count in fields.counts if count <= points), default=0)
    if fields.counts and not fitting:
        return points if points and not rest else fields.count   # a file cut off ends within a record
    return points if _are_points(file, fields, fitting, points, rest) else fitting


def _are_points(file, fields, first, end, rest):
    """Whether the records from `first` to before `end`, behind those that the header states, are points of the same survey."""
    stored = _sampled_places(file, fields, first, end)
    if not len(stored) or not stored.any(axis=1).mean() > 0.5:   # zeros that fill up a block
        return False
    if first:
        inside = np.abs(stored - np.median(_sampled_places(file, fields, 0, first), axis=0)) <= NEAR_STATED
    else:
        low, high = fields.minimum, fields.maximum
        if not (np.isfinite([low, high]).all() and (low < high).any()):
            return not rest
        places = stored * fields.scales + fields.offsets
        inside = (places >= low) & (places <= high)
    return bool(inside.all(axis=1).mean() > 0.5)


def _sampled_places(file: BinaryIO, fields: _HeaderFields, first: int, end: int) -> np.ndarray:
    """(N, 3) coordinates, as they are stored, of some points of an uncompressed file from `first` to before `end`."""
    rows = np.unique(np.linspace(first, end - 1, min(LAS.points_looked_at, max(end - first, 0))).astype(np.int64))
    return _stored_places(file, (fields.points_at + rows * fields.record_size).tolist())


def _stored_places(file, positions):
    """(N, 3) coordinates, as they are stored, of points that are not compressed, at positions in a file."""
    places = []
    for position in positions:
        file.seek(position)
        stored = file.read(12)
        if len(stored) < 12:   # of a file cut off
            break
        places.append(np.frombuffer(stored, "<i4"))
    return np.array(places, float).reshape(-1, 3)


# Checks of the lengths in a LAS or LAZ header before a decoder relies on them.
#
# The decoder does not check them: with a wrong number of chunks it asks for more memory than any machine has, which ends the whole program. Offsets
# and sizes are those of LAS 1.4 (ASPRS, R15, tables 3 and 6) and of the LASzip VLR.

CHUNKED_COMPRESSOR = 2       # source: LASzip; of point formats 0 to 5, where each chunk begins anew
LAYERED_COMPRESSOR = 3       # source: LASzip; of point formats 6 and above: a chunk holds its values layer by layer
LAYERS_OF_ITEM = {10: 9, 11: 1, 12: 2, 13: 1}  # source: LASzip; POINT14, RGB14, RGBNIR14, WAVEPACKET14; BYTE14 has one layer for each byte


def find_damage(path: str | os.PathLike[str], mended: _MendedHeader | None = None) -> str:
    """What is wrong with the lengths in a file's header, as the end of a sentence; "" where nothing is, or the file is no LAS file."""
    size, mended = os.path.getsize(path), mended or mend(path)
    if (fields := mended.fields) is None:
        return ""
    with opened(path, mended) as file:
        if not 227 <= fields.header_size <= fields.points_at <= size:
            return f"its header states that the points begin at byte {fields.points_at:,} of {size:,}"
        if fields.vlrs * VLR_HEADER_SIZE > fields.points_at - fields.header_size:
            return f"its header states {fields.vlrs:,} variable length records, more than fit before the points"
        least = _base_size(fields.point_format)
        if least is not None and fields.record_size < least:
            return f"its header states {fields.record_size} bytes per point, and points of format {fields.point_format} have {least}"
        if fields.compressed:
            return _damage_of_chunks(file, fields, size)
        points = (size - fields.points_at) // fields.record_size if fields.record_size else 0
        return f"its header promises {fields.count:,} points, and {points:,} are there" if fields.count > points else ""


def _damage_of_chunks(file, fields, size):
    """What is wrong with the compression of an open file."""
    compression = _compression(file)
    if compression is None:
        return "it is compressed, but the record that describes the compression is missing"
    if compression.point_size != fields.record_size:
        return f"its header states {fields.record_size} bytes per point, the compressor {compression.point_size}"
    if compression.chunk_size != VARIABLE_CHUNKS and not 0 < compression.chunk_size <= LAS.max_chunk_size:
        return f"its compressor states chunks of {compression.chunk_size:,} points"
    return _chunk_table_damage(file, fields.points_at, size, compression)


def with_points_of_chunks(path: str | os.PathLike[str], mended: _MendedHeader) -> _MendedHeader:
    """The header of an undamaged file, with as many points as its chunks hold where it is compressed.

    Chunks of point formats 6 and above, and those of varying size, state their points. Of the others only the last may not be full: it is decoded,
    since points beyond its last need bytes that are not there.
    """
    if (fields := mended.fields) is None or not fields.compressed:
        return mended
    with opened(path, mended) as file:
        compression, begin, table = _chunks(file)
        return mended.with_count(_points_of(file, compression, begin, table, fields))


def places_here_and_there(path: str | os.PathLike[str], mended: _MendedHeader) -> np.ndarray:
    """(N, 3) map coordinates of points all over an undamaged file: evenly spread, or the first of each chunk, which is not compressed."""
    if (fields := mended.fields) is None or not fields.count:
        return np.empty((0, 3))
    with opened(path, mended) as file:
        if not fields.compressed:
            places = _sampled_places(file, fields, 0, fields.count)
        else:
            _, begin, table = _chunks(file)
            starts = begin + np.cumsum([0] + [length for points, length in table if points and length])[:-1]
            looked_at = np.unique(np.linspace(0, max(len(starts) - 1, 0), LAS.points_looked_at).astype(int))
            places = _stored_places(file, starts[looked_at[:len(starts)]].tolist())
        return places * fields.scales + fields.offsets


def _points_of(file, compression, begin, table, fields):
    """The points in the chunks of a file; the header's number where they do not tell."""
    size, compressor = compression.chunk_size, compression.compressor
    if size == VARIABLE_CHUNKS:
        return sum(points for points, _ in table)
    if not table or compressor not in (CHUNKED_COMPRESSOR, LAYERED_COMPRESSOR):
        return fields.count
    full = size * (len(table) - 1)
    file.seek(begin + sum(nbytes for _, nbytes in table[:-1]))
    chunk = file.read(table[-1][1])
    if compressor == CHUNKED_COMPRESSOR:
        stated = next((count - full for count in fields.counts if full < count <= full + size), 0)
        last = _points_decoded(compression, chunk, size, stated)
        return full + last if last else fields.count
    raw = compression.point_size
    return full + struct.unpack_from("<I", chunk, raw)[0] if len(chunk) >= raw + 4 else fields.count


def _points_decoded(compression, chunk, size, stated):
    """The points of a chunk that holds up to `size` of them, by decoding it; those stated, 0 for none, where that takes too much or agrees."""
    if min(size, stated or size) > LAS.max_decoded:
        return stated
    if stated and not _holds(compression, chunk[:len(chunk) - max(LAS.flushed_bytes, len(chunk) // 100)], stated):
        return stated
    low, high = max(stated, 1), size + 1   # points that can be decoded, and that cannot
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if _holds(compression, chunk, middle) else (low, middle)
    return low


def _holds(compression, chunk, points):
    """Whether so many points can be decoded from the bytes of a chunk."""
    buffer = np.empty(points * compression.point_size, np.uint8)
    try:
        lazrs.decompress_points_with_chunk_table(chunk, compression.data, buffer, [(points, len(chunk))])
    except lazrs.LazrsError:
        return False
    return True


def points_per_chunk(path: str | os.PathLike[str]) -> int:
    """Points that are compressed together in an undamaged file: 1 in a LAS file, 0 where the number varies."""
    with open(path, "rb") as file:
        compression = _compression(file)
    return 1 if compression is None else 0 if compression.chunk_size == VARIABLE_CHUNKS else compression.chunk_size


def chunks_of(path: str | os.PathLike[str]) -> tuple[bytes, int, list[tuple[int, int]]]:
    """The LASzip record of an undamaged LAZ file, the byte at which its chunks begin, and (points, bytes) of each."""
    with open(path, "rb") as file:
        compression, begin, table = _chunks(file)
        return compression.data, begin, table


def _chunks(file):
    """(_Compression, first byte, [(points, bytes)] of each chunk) of an open file."""
    compression, points_at = _compression(file), _HeaderFields.read(file).points_at
    file.seek(points_at)
    return compression, points_at + 8, lazrs.read_chunk_table(file, lazrs.LazVlr(compression.data))


def _compression(file):
    """The _Compression of the points of an open LAS or LAZ file; None where they are not compressed, or the record of it is missing."""
    fields = _HeaderFields.read(file)
    records = fields.records(file, os.fstat(file.fileno()).st_size) if fields.compressed else ()
    return next((compression for record in records if record.at < fields.points_at and (compression := _Compression.of(record))), None)


def _chunk_table_damage(file, points_at, size, compression):
    """What is wrong with the table of chunks, or with the chunks."""
    file.seek(points_at)
    stored = file.read(8)
    if len(stored) < 8:
        return "it ends where its points should begin"
    table_at = struct.unpack("<q", stored)[0]
    if table_at == -1:  # written as a stream: the place of the table is at the end of the file
        file.seek(size - 8)
        table_at = struct.unpack("<q", file.read(8))[0]
    if not points_at <= table_at <= size - 8:
        return f"its table of chunks should be at byte {table_at:,} of {size:,}"
    file.seek(table_at)
    _, chunks = struct.unpack("<II", file.read(8))
    if chunks > table_at - points_at:  # a chunk has at least one byte
        return f"it states {chunks:,} chunks in {table_at - points_at:,} bytes"
    file.seek(table_at)
    return _chunk_damage(file, points_at + 8, table_at, compression)


def _chunk_damage(file, first, end, compression):
    """What is wrong with the chunks: they must fit before their table."""
    try:
        table = lazrs.read_chunk_table_only(file, lazrs.LazVlr(compression.data))
    except BaseException as problem:  # a panic of the decoder is not an Exception
        if isinstance(problem, (KeyboardInterrupt, SystemExit, GeneratorExit)):
            raise
        return f"its table of chunks cannot be read ({problem})"
    total = sum(length for _, length in table)
    if total > end - first:
        return f"its chunks should take {total:,} bytes, and there are {end - first:,}"
    if end > first and not total:
        return f"its table of chunks is empty, and there are {end - first:,} bytes of points"
    return _layer_damage(file, first, compression, table) if compression.compressor == LAYERED_COMPRESSOR else ""


def _layer_damage(file, first, compression, table):
    """What is wrong with the lengths of the layers, which each chunk states after its first, uncompressed point, or with its points."""
    raw = compression.point_size
    layers = sum(LAYERS_OF_ITEM.get(kind, size) for kind, size in compression.items)
    head = raw + 4 + 4 * layers  # the number of points, and the lengths
    counted = compression.chunk_size == VARIABLE_CHUNKS
    position = first
    for points, length in table:
        file.seek(position)
        data = file.read(min(head, length))
        count, *lengths = struct.unpack_from(f"<{1 + layers}I", data, raw) if len(data) == head else (points,)
        if length and head + sum(lengths) > length:
            return f"a chunk of {length:,} bytes states layers of {sum(lengths):,}"
        if counted and count != points:
            return f"its table of chunks states {points:,} points in a chunk that holds {count:,}"
        position += length
    return ""
