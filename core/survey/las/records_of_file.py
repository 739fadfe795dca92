"""The header of a LAS or LAZ file and its variable length records, byte by byte, as laspy can read them."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import BinaryIO

import numpy as np

VLR_HEADER_SIZE, EVLR_HEADER_SIZE = 54, 60  # bytes
LASZIP_USER, LASZIP_RECORD = b"laszip encoded", 22204
COMPRESSED_BIT = 0x80        # of the point format
VARIABLE_CHUNKS = 0xFFFFFFFF  # as the size of chunks: each has its own number of points
EXTRA_BYTES_USER, EXTRA_BYTES_RECORD, EXTRA_BYTES_SIZE = b"LASF_Spec", 4, 192
CRS_USER, CRS_TEXTS = b"LASF_Projection", (2111, 2112, 34737)   # whose records are text: WKT, and names of the GeoKeys
MAX_NAME = 24    # bytes of a name to which a number is added, of the 32 that a name may have
TYPE_SIZES = 1, 1, 2, 2, 4, 4, 8, 8, 4, 8   # bytes of the types 1 to 10 of extra bytes; 11 to 20 are pairs of these, 21 to 30 triples


@dataclass(frozen=True)
class HeaderFields:
    """The numbers of a header, as they stand there.

    head : its first bytes
    counts : those of the counts of points that are not 0, that of 64 bits first
    first_waveform : byte of the first waveform packet, 0 without any in the file
    """

    head: bytes
    version: int
    header_size: int
    points_at: int
    vlrs: int
    point_format: int
    compressed: bool
    record_size: int
    counts: tuple[int, ...]
    first_waveform: int
    first_evlr: int
    evlrs: int

    @classmethod
    def read(cls, file: BinaryIO) -> HeaderFields | None:
        """Those of an open file; None where it is no LAS file or too short for a header."""
        file.seek(0)
        head = file.read(375)
        if len(head) < 227 or head[:4] != b"LASF":
            return None
        header_size, points_at, vlrs, kind, record_size, count = struct.unpack_from("<HIIBHI", head, 94)
        version = head[25]
        waveform, evlr, evlrs, long_count = 0, 0, 0, 0
        if version >= 3 and len(head) >= 235:
            waveform = struct.unpack_from("<Q", head, 227)[0]
        if version >= 4 and len(head) >= 255:
            evlr, evlrs, long_count = struct.unpack_from("<QIQ", head, 235)
        return cls(head, version, header_size, points_at, vlrs, kind & 0x3F, bool(kind & COMPRESSED_BIT), record_size,
                   tuple(number for number in (long_count, count) if number), waveform, evlr, evlrs)

    @property
    def has_long_count(self) -> bool:
        """Whether there is a count of 64 bits."""
        return self.version >= 4 and len(self.head) >= 255

    @property
    def count(self) -> int:
        """The number of points that laspy would take."""
        return struct.unpack_from("<Q", self.head, 247)[0] if self.has_long_count else struct.unpack_from("<I", self.head, 107)[0]

    @property
    def scales(self) -> np.ndarray:
        """(3,) metres."""
        return np.frombuffer(self.head, "<f8", 3, 131)

    @property
    def offsets(self) -> np.ndarray:
        """(3,) map coordinates."""
        return np.frombuffer(self.head, "<f8", 3, 155)

    @property
    def minimum(self) -> np.ndarray:
        """(3,) map coordinates."""
        return np.frombuffer(self.head, "<f8", 6, 179)[1::2]

    @property
    def maximum(self) -> np.ndarray:
        """(3,) map coordinates."""
        return np.frombuffer(self.head, "<f8", 6, 179)[::2]

    def records(self, file: BinaryIO, size: int) -> Iterator[Record]:
        """The variable length records before the points of a file of so many bytes, the last as far as it is there."""
        at = self.header_size
        for _ in range(self.vlrs):
            record = Record.read(file, at, VLR_HEADER_SIZE, size)
            if record is None:
                return
            yield record
            at += VLR_HEADER_SIZE + len(record.data)

    def end_of_points(self, size: int) -> int:
        """The byte before which the points end at the latest, in a file of so many bytes."""
        after = [self.first_waveform] + [self.first_evlr] * bool(self.evlrs)
        return min([size, *(at for at in after if self.points_at <= at <= size)])


@dataclass(frozen=True)
class Compression:
    """How the points of a file are compressed, as the LASzip record says.

    data : the record
    """

    data: bytes

    @property
    def compressor(self) -> int:
        """Number of the kind of chunks."""
        return struct.unpack_from("<H", self.data)[0]

    @property
    def chunk_size(self) -> int:
        """Points of a chunk; VARIABLE_CHUNKS where each has its own number."""
        return struct.unpack_from("<I", self.data, 12)[0]

    @property
    def items(self) -> list[tuple[int, int]]:
        """(type, bytes) of each item of a point."""
        return [struct.unpack_from("<HH", self.data, 34 + 6 * k) for k in range(struct.unpack_from("<H", self.data, 32)[0])]

    @property
    def point_size(self) -> int:
        """Bytes of a point."""
        return sum(size for _, size in self.items)


@dataclass(frozen=True)
class Record:
    """A variable length record.

    at : byte of the file at which it begins
    head : its header
    length : of its data, as it states
    data : as much of it as there is and is looked into
    """

    at: int
    head: bytes
    length: int
    data: bytes

    @classmethod
    def read(cls, file: BinaryIO, at: int, head_size: int, size: int) -> Record | None:
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
    def end(self) -> int:
        """The byte behind it."""
        return self.at + len(self.head) + self.length

    @property
    def whole(self) -> bytes:
        """All of it, with the length that is there."""
        kind = "<H" if len(self.head) == VLR_HEADER_SIZE else "<Q"
        return self.head[:20] + struct.pack(kind, len(self.data)) + self.head[20 + struct.calcsize(kind):] + self.data

    @property
    def describes_extra_bytes(self) -> bool:
        """Whether it names the extra bytes of points."""
        return self.user == EXTRA_BYTES_USER and self.number == EXTRA_BYTES_RECORD

    @property
    def compression(self) -> Compression | None:
        """What it says of compressed points; None where it is another record, or too short."""
        laszip = self.user == LASZIP_USER and self.number == LASZIP_RECORD and len(self.data) >= 34
        return Compression(self.data) if laszip and len(self.data) >= 34 + 6 * struct.unpack_from("<H", self.data, 32)[0] else None

    def mended(self) -> Record:
        """The same with a user and a CRS that laspy can decode; itself where nothing is wrong."""
        head = self.head[:2] + decodable(self.head[2:18]) + self.head[18:]
        data = decodable(self.data) if self.user == CRS_USER and self.number in CRS_TEXTS else self.data
        return self if (head, data) == (self.head, self.data) else replace(self, head=head, data=data)

    def patches(self) -> Iterator[tuple[int, bytes]]:
        """What `mended` changes, where it lies in the file."""
        mended = self.mended()
        if mended is not self:
            yield self.at, mended.head + mended.data


def base_size(point_format: int) -> int | None:
    """Bytes of a point without extra bytes; None for a format that laspy does not know."""
    from laspy import PointFormat, supported_point_formats

    return PointFormat(point_format).size if point_format in supported_point_formats() else None


def extra_bytes_described(records: list[Record]) -> int:
    """Bytes that the records which name extra bytes describe together."""
    return sum(_size(entry) or 0 for record in records if record.describes_extra_bytes for entry in _entries(record))


def readable_extra_bytes(record: Record, point_format: int, room: int) -> Record:
    """A record of extra bytes that describes no more than there is room for, in names that a table can have; itself where nothing is wrong.

    Parameters
    ----------
    record : which describes extra bytes
    point_format : whose own fields have their names already
    room : extra bytes of a point
    """
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
        same = name.encode() == entry[4:36].split(b"\0")[0]
        kept.append(entry[:4] + (entry[4:36] if same else name.encode()[:32].ljust(32, b"\0")) + entry[36:160] + decodable(entry[160:]))
    data = b"".join(kept)
    return record if data == record.data and record.length == len(data) else replace(record, data=data, length=len(data))


def _entries(record):
    """The descriptions of the fields; one that is not whole is none."""
    return [record.data[at:at + EXTRA_BYTES_SIZE] for at in range(0, len(record.data) - EXTRA_BYTES_SIZE + 1, EXTRA_BYTES_SIZE)]


def _size(entry):
    """Bytes of a field; None for a type that nobody defined."""
    kind, options = entry[2], entry[3]
    if kind == 0:
        return options
    return TYPE_SIZES[(kind - 1) % 10] * ((kind - 1) // 10 + 1) if kind <= 30 else None


def _name(text, taken, number):
    """A name in UTF-8 that no other field has."""
    name = decodable(text.split(b"\0")[0]).decode() or "extra"
    unique, again = name, number
    while unique in taken:
        unique, again = f"{name.encode()[:MAX_NAME].decode(errors='ignore')}_{again}", again + 1
    return unique


def decodable(text: bytes) -> bytes:
    """The same bytes where they are UTF-8 up to the first zero, else with question marks for those beyond ASCII."""
    try:
        text.split(b"\0")[0].decode()
    except UnicodeDecodeError:
        return bytes(byte if byte < 128 else ord("?") for byte in text)
    return text
