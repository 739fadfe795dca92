"""Checks of the lengths in a LAS or LAZ header before a decoder relies on them.

The decoder does not check them: with a wrong number of chunks it asks for more memory than any machine has,
which ends the whole program. Offsets and sizes are those of LAS 1.4 (ASPRS, R15, tables 3 and 6) and of the
LASzip VLR.
"""

from __future__ import annotations

import os
import struct
from typing import BinaryIO

LASZIP_USER, LASZIP_RECORD = b"laszip encoded", 22204
VLR_HEADER_SIZE, EVLR_HEADER_SIZE = 54, 60  # bytes
COMPRESSED_BIT = 0x80        # of the point format
VARIABLE_CHUNKS = 0xFFFFFFFF
MAX_CHUNK_SIZE = 50_000_000  # points; LASzip writes 50,000
LAYERED_COMPRESSOR = 3       # of point formats 6 and above: a chunk holds its values layer by layer
LAYERS_OF_ITEM = {10: 9, 11: 1, 12: 2, 13: 1}  # POINT14, RGB14, RGBNIR14, WAVEPACKET14; BYTE14 has one layer for each byte


def find_damage(path: str | os.PathLike[str]) -> str:
    """What is wrong with the lengths in a file's header.

    Parameters
    ----------
    path : of a LAS or LAZ file

    Returns
    -------
    The end of a sentence; "" where nothing is wrong, or the file is not a LAS file at all
    """
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        head = file.read(375)
        if len(head) < 227 or head[:4] != b"LASF":
            return ""
        header_size, points_at, vlrs = struct.unpack_from("<HII", head, 94)
        point_format, record_size = struct.unpack_from("<BH", head, 104)
        if not 227 <= header_size <= points_at <= size:
            return f"its header states that the points begin at byte {points_at:,} of {size:,}"
        if vlrs * VLR_HEADER_SIZE > points_at - header_size:
            return f"its header states {vlrs:,} variable length records, more than fit before the points"
        if head[25] >= 4 and len(head) >= 247:
            first_evlr, evlrs = struct.unpack_from("<QI", head, 235)
            if evlrs and (first_evlr > size or evlrs * EVLR_HEADER_SIZE > size - first_evlr):
                return f"its header states {evlrs:,} extended records from byte {first_evlr:,} of {size:,}"
            if wrong := _evlrs_beyond_end(file, first_evlr, evlrs, size):
                return wrong
        if not point_format & COMPRESSED_BIT:
            return ""
        record = _laszip_record(file, header_size, vlrs, points_at)
        if record is None:
            return "it is compressed, but the record that describes the compression is missing"
        chunk_size, items = _chunk_size(record), _item_sizes(record)
        if sum(items) != record_size:
            return f"its header states {record_size} bytes per point, the compressor {sum(items)}"
        if chunk_size != VARIABLE_CHUNKS and not 0 < chunk_size <= MAX_CHUNK_SIZE:
            return f"its compressor states chunks of {chunk_size:,} points"
        count = struct.unpack_from("<Q", head, 247)[0] if head[25] >= 4 and len(head) >= 255 else struct.unpack_from("<I", head, 107)[0]
        return _chunk_table_damage(file, points_at, size, record, count)


def _evlrs_beyond_end(file, place, evlrs, size):
    """What is wrong with the lengths of the records behind the points; "" where all lie in the file."""
    for number in range(1, evlrs + 1):
        file.seek(place + 20)
        length = file.read(8)
        after = place + EVLR_HEADER_SIZE + (struct.unpack("<Q", length)[0] if len(length) == 8 else 0)
        if after > size:
            return f"its extended record {number:,} ends at byte {after:,} of {size:,}"
        place = after
    return ""


def points_per_chunk(path: str | os.PathLike[str]) -> int:
    """Points that are compressed together in an undamaged file: 1 in a LAS file, 0 where the number varies."""
    with open(path, "rb") as file:
        compressed, record, _ = _compression(file)
        size = _chunk_size(record) if compressed else 1
        return 0 if size == VARIABLE_CHUNKS else size


def chunks_of(path: str | os.PathLike[str]) -> tuple[bytes, int, list[tuple[int, int]]]:
    """The chunks of an undamaged LAZ file.

    Returns
    -------
    record : the LASzip record
    begin : byte at which the chunks begin
    table : [(points, bytes)] of each chunk
    """
    import lazrs

    with open(path, "rb") as file:
        _, record, points_at = _compression(file)
        file.seek(points_at)
        return record, points_at + 8, lazrs.read_chunk_table(file, lazrs.LazVlr(record))


def _compression(file):
    """Whether a file's points are compressed, its LASzip record, and the byte at which its points begin."""
    head = file.read(227)
    header_size, points_at, vlrs = struct.unpack_from("<HII", head, 94)
    return bool(head[104] & COMPRESSED_BIT), _laszip_record(file, header_size, vlrs, points_at), points_at


def _laszip_record(file: BinaryIO, header_size: int, vlrs: int, points_at: int) -> bytes | None:
    """The LASzip record; None where there is none, or it is too short."""
    at = header_size
    for _ in range(vlrs):
        file.seek(at)
        head = file.read(VLR_HEADER_SIZE)
        if len(head) < VLR_HEADER_SIZE or at >= points_at:
            break
        user, record, length = struct.unpack_from("<2x16sHH", head)
        if user.rstrip(b"\0") == LASZIP_USER and record == LASZIP_RECORD:
            data = file.read(length)
            whole = len(data) >= 34 and len(data) >= 34 + 6 * struct.unpack_from("<H", data, 32)[0]
            return data if whole else None
        at += VLR_HEADER_SIZE + length
    return None


def _chunk_size(record):
    """Points in a chunk."""
    return struct.unpack_from("<I", record, 12)[0]


def _item_sizes(record):
    """Bytes of each item of a point."""
    count = struct.unpack_from("<H", record, 32)[0]
    return [struct.unpack_from("<H", record, 36 + 6 * item)[0] for item in range(count)]


def _item_types(record):
    """LASzip's type of each item of a point."""
    count = struct.unpack_from("<H", record, 32)[0]
    return [struct.unpack_from("<H", record, 34 + 6 * item)[0] for item in range(count)]


def _chunk_table_damage(file, points_at, size, record, count):
    """What is wrong with the table of chunks, or with the chunks."""
    file.seek(points_at)
    place = file.read(8)
    if len(place) < 8:
        return "it ends where its points should begin"
    at = struct.unpack("<q", place)[0]
    if at == -1:  # written as a stream: the place of the table is at the end of the file
        file.seek(size - 8)
        at = struct.unpack("<q", file.read(8))[0]
    if not points_at <= at <= size - 8:
        return f"its table of chunks should be at byte {at:,} of {size:,}"
    file.seek(at)
    _, chunks = struct.unpack("<II", file.read(8))
    if chunks > at - points_at:  # a chunk has at least one byte
        return f"it states {chunks:,} chunks in {at - points_at:,} bytes"
    file.seek(at)
    return _chunk_damage(file, points_at + 8, at, record, count)


def _chunk_damage(file, first, end, record, count):
    """What is wrong with the chunks: they must fit before their table and hold the points that the header states."""
    import lazrs

    try:
        table = lazrs.read_chunk_table_only(file, lazrs.LazVlr(record))
    except BaseException as problem:  # a panic of the decoder is not an Exception
        if isinstance(problem, (KeyboardInterrupt, SystemExit, GeneratorExit)):
            raise
        return f"its table of chunks cannot be read ({problem})"
    taken = sum(length for _, length in table)
    if taken > end - first:
        return f"its chunks should take {taken:,} bytes, and there are {end - first:,}"
    if _chunk_size(record) == VARIABLE_CHUNKS and sum(points for points, _ in table) != count:
        return f"its header promises {count:,} points, its chunks {sum(points for points, _ in table):,}"
    return _layer_damage(file, first, record, table) if struct.unpack_from("<H", record)[0] == LAYERED_COMPRESSOR else ""


def _layer_damage(file, first, record, table):
    """What is wrong with the lengths of the layers, which each chunk states after its first, uncompressed point."""
    raw = sum(_item_sizes(record))
    layers = sum(LAYERS_OF_ITEM.get(kind, size) for kind, size in zip(_item_types(record), _item_sizes(record)))
    head = raw + 4 + 4 * layers  # the number of points, and the lengths
    at = first
    for _, length in table:
        file.seek(at)
        data = file.read(min(head, length))
        taken = sum(struct.unpack_from(f"<{layers}I", data, raw + 4)) if len(data) == head else 0
        if length and head + taken > length:
            return f"a chunk of {length:,} bytes states layers of {taken:,}"
        at += length
    return ""
