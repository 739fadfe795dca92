"""A look at the numbers in a LAS or LAZ header that say how long things are, before anything trusts them.

The decoder takes a damaged file at its word: a wrong number of chunks makes it ask for memory beyond any
machine's, and it then ends the whole program. Offsets and sizes are those of LAS 1.4 (ASPRS, R15, tables 3 and
6) and of the LASzip VLR.
"""

import os
import struct

LASZIP_USER, LASZIP_RECORD = b"laszip encoded", 22204
VLR_HEADER = 54        # bytes
COMPRESSED = 0x80      # bit of the point format
VARIABLE_CHUNKS = 0xFFFFFFFF
LARGEST_CHUNK = 50_000_000  # points; LASzip writes 50,000


def damage(path):
    """What is wrong with the lengths in the file's header; "" where nothing is, or it is no LAS file at all."""
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        head = file.read(375)
        if len(head) < 227 or head[:4] != b"LASF":
            return ""
        header_size, points_at, vlrs = struct.unpack_from("<HII", head, 94)
        point_format, record_size = struct.unpack_from("<BH", head, 104)
        if not 227 <= header_size <= points_at <= size:
            return f"its points are said to begin at byte {points_at:,}, of {size:,}"
        if vlrs * VLR_HEADER > points_at - header_size:
            return f"it is said to have {vlrs:,} header records, more than fit before its points"
        if head[25] >= 4 and len(head) >= 247:
            first_evlr, evlrs = struct.unpack_from("<QI", head, 235)
            if evlrs and (first_evlr > size or evlrs * 60 > size - first_evlr):
                return f"it is said to have {evlrs:,} further records from byte {first_evlr:,}, of {size:,}"
        if not point_format & COMPRESSED:
            return ""
        chunk_size, items = _laszip(file, header_size, vlrs, points_at)
        if chunk_size is None:
            return "it is compressed, but the record that says how is missing"
        if sum(items) != record_size:
            return f"its points are said to have {record_size} bytes, and {sum(items)} when compressed"
        if chunk_size != VARIABLE_CHUNKS and not 0 < chunk_size <= LARGEST_CHUNK:
            return f"its points are said to be compressed {chunk_size:,} at a time"
        return _chunk_table(file, points_at, size)


def _laszip(file, header_size, vlrs, points_at):
    """Points per chunk and the bytes of each item of a point, of the LASzip record; (None, ()) where there is none."""
    at = header_size
    for _ in range(vlrs):
        file.seek(at)
        head = file.read(VLR_HEADER)
        if len(head) < VLR_HEADER or at >= points_at:
            break
        user, record, length = struct.unpack_from("<2x16sHH", head)
        if user.rstrip(b"\0") == LASZIP_USER and record == LASZIP_RECORD:
            data = file.read(length)
            if len(data) < 34:
                break
            chunk_size, count = struct.unpack_from("<I", data, 12)[0], struct.unpack_from("<H", data, 32)[0]
            if len(data) < 34 + 6 * count:
                break
            return chunk_size, [struct.unpack_from("<H", data, 36 + 6 * item)[0] for item in range(count)]
        at += VLR_HEADER + length
    return None, ()


def _chunk_table(file, points_at, size):
    """What is wrong with the table of chunks."""
    file.seek(points_at)
    place = file.read(8)
    if len(place) < 8:
        return "it ends where its points should begin"
    at = struct.unpack("<q", place)[0]
    if at == -1:  # written by a program that could not go back: the place stands at the end
        file.seek(size - 8)
        at = struct.unpack("<q", file.read(8))[0]
    if not points_at <= at <= size - 8:
        return f"its table of chunks is said to be at byte {at:,}, of {size:,}"
    file.seek(at)
    _, chunks = struct.unpack("<II", file.read(8))
    # A chunk has a byte at least
    return f"it is said to have {chunks:,} chunks in {at - points_at:,} bytes" if chunks > at - points_at else ""
