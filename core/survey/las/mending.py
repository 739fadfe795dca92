"""Headers of LAS and LAZ files as the points behind them show that they should be.

Exporters leave numbers and texts in a header that do not fit the points: a count from before the last points, lengths of other records, names
in the encoding of their country. laspy believes all of them. Here such bytes are replaced in memory before laspy reads them, and what may
matter to the survey is told. Offsets are those of LAS 1.4 (ASPRS, R15, tables 3, 6 and 7) and of its extra bytes (table 25).
"""

from __future__ import annotations

import io
import os
import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import BinaryIO

import numpy as np

from .records_of_file import EVLR_HEADER_SIZE, HeaderFields, Record, base_size, extra_bytes_described, readable_extra_bytes

MAX_RECORD_SIZE = 65535     # bytes of a point
SAMPLED_RECORDS = 1000     # of those behind the last point that a header states, to see whether they are points too
# derived: whole numbers of 32 bits within which points lie about those stated: the road goes on, but what is read as places and is none lies
# anywhere, or, as text and floating-point numbers, near the upper end; one in eight of it in each axis lies as near by chance
NEAR_STATED = 2**31 // 8
COUNT_AT, LONG_COUNT_AT, RECORD_SIZE_AT, POINTS_AT, EVLR_COUNT_AT = 107, 247, 105, 96, 243


@dataclass(frozen=True)
class MendedHeader:
    """What is read in place of some bytes of a file, and what to tell of it.

    patches : (first byte, bytes)
    notes : the ends of sentences about the file
    """

    patches: tuple[tuple[int, bytes], ...] = ()
    notes: tuple[str, ...] = ()

    def with_count(self, fields: HeaderFields, count: int, note: str = "") -> MendedHeader:
        """The same with another number of points."""
        patches = [(COUNT_AT, struct.pack("<I", count if count < 2**32 else 0))]
        if fields.has_long_count:
            patches.append((LONG_COUNT_AT, struct.pack("<Q", count)))
        return MendedHeader((*self.patches, *patches), (*self.notes, *([note] if note else [])))


class MendedFile(io.FileIO):
    """A file that is read with some bytes replaced."""

    def __init__(self, path: str | os.PathLike[str], patches: Sequence[tuple[int, bytes]]):
        super().__init__(path, "rb")
        self._patches = patches

    def readinto(self, buffer: bytearray | memoryview) -> int:   # type: ignore[override]
        """As that of a file."""
        first = self.tell()
        count = super().readinto(buffer) or 0
        view = memoryview(buffer).cast("B")
        for at, data in self._patches:
            low, high = max(at, first), min(at + len(data), first + count)
            if low < high:
                view[low - first:high - first] = data[low - at:high - at]
        return count


def opened(path: str | os.PathLike[str], mended: MendedHeader) -> io.BufferedReader:
    """A file open for reading as it was mended."""
    return io.BufferedReader(MendedFile(path, mended.patches)) if mended.patches else open(path, "rb")  # noqa: SIM115


def mend(path: str | os.PathLike[str]) -> MendedHeader:
    """What a file says of itself against what is in it; the points in compressed chunks are not counted here.

    Parameters
    ----------
    path : of a LAS or LAZ file

    Returns
    -------
    MendedHeader; without patches where nothing is wrong, or nothing is sure
    """
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        stated = HeaderFields.read(file)
        if stated is None or not stated.header_size <= size:
            return MendedHeader()
        patches: list[tuple[int, bytes]] = []
        notes: list[str] = []
        records, extended = list(stated.records(file, size)), list(_extended(file, stated, size))
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
        patches += _mended_records(records, fields) + [patch for record in extended for patch in record.patches()]
        found = MendedHeader(tuple(patches), tuple(notes))
        if fields.compressed:
            return found
        count = _points_in_las(file, fields, size)
        if count == fields.count:
            return found
        return found.with_count(fields, count, "" if count in fields.counts else count_note(fields.count, count))


def count_note(stated: int, there: int) -> str:
    """The end of a sentence about a file whose header states another number of points than there are."""
    return f"its header states {stated:,} points, and {there:,} are there: those were read" + (
        ". If it was copied or downloaded, compare its length with the original's" if there < stated else "")


def _extended(file, fields, size):
    """The extended records behind the points that lie in the file."""
    at = fields.first_evlr
    for _ in range(fields.evlrs):
        record = Record.read(file, at, EVLR_HEADER_SIZE, size) if at >= fields.header_size else None
        if record is None or at + EVLR_HEADER_SIZE + record.length > size:
            return
        yield record
        at += EVLR_HEADER_SIZE + record.length


def _lengths(fields, records, size):
    """The fields with the place and the length of the points by which they fill the file."""
    base = base_size(fields.point_format)
    if base is None:
        return fields
    described = base + extra_bytes_described(records)
    if fields.compressed:
        # the decoder cannot do without the record that says of what its points consist
        point_size = next((record.compression.point_size for record in records if record.compression is not None), 0)
        return replace(fields, record_size=point_size) if base <= point_size <= MAX_RECORD_SIZE else fields
    behind = records[-1].end if records else fields.header_size
    end = fields.end_of_points(size)

    def fits(points_at, record_size):
        return points_at <= size and base <= record_size <= MAX_RECORD_SIZE and any(points_at + count * record_size == end for count in fields.counts)

    if fits(fields.points_at, fields.record_size):
        return fields
    for points_at in (fields.points_at, behind):
        for record_size in (fields.record_size, described, base):
            if fits(points_at, record_size):
                return replace(fields, points_at=points_at, record_size=record_size)
    return fields


def _mended_records(records, fields):
    """The patch of the records before the points, where any cannot be read as it is."""
    base = base_size(fields.point_format)
    mended = [record.mended() for record in records]
    if base is not None:
        mended = [readable_extra_bytes(record, fields.point_format, fields.record_size - base) if record.describes_extra_bytes else record
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
    there, rest = divmod(fields.end_of_points(size) - fields.points_at, fields.record_size)
    if there in fields.counts:
        return there
    fitting = max((count for count in fields.counts if count <= there), default=0)
    if fields.counts and not fitting:
        return there if there and not rest else fields.count   # a file cut off ends within a record
    return there if _are_points(file, fields, fitting, there, rest) else fitting


def _are_points(file, fields, first, end, rest):
    """Whether the records from `first` to before `end`, behind those that the header states, are points of the same survey."""
    behind = sampled_places(file, fields, first, end)
    if not len(behind) or not behind.any(axis=1).mean() > 0.5:   # zeros that fill up a block
        return False
    if first:
        inside = np.abs(behind - np.median(sampled_places(file, fields, 0, first), axis=0)) <= NEAR_STATED
    else:
        low, high = fields.minimum, fields.maximum
        if not (np.isfinite([low, high]).all() and (low < high).any()):
            return not rest
        places = behind * fields.scales + fields.offsets
        inside = (places >= low) & (places <= high)
    return bool(inside.all(axis=1).mean() > 0.5)


def sampled_places(file: BinaryIO, fields: HeaderFields, first: int, end: int) -> np.ndarray:
    """(N, 3) coordinates, as they are stored, of up to SAMPLED_RECORDS points of an uncompressed file from `first` to before `end`."""
    found = []
    for row in np.unique(np.linspace(first, end - 1, min(SAMPLED_RECORDS, max(end - first, 0))).astype(np.int64)).tolist():
        file.seek(fields.points_at + row * fields.record_size)
        place = file.read(12)
        if len(place) < 12:   # of a file cut off
            break
        found.append(np.frombuffer(place, "<i4"))
    return np.array(found, float).reshape(-1, 3)
