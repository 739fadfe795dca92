"""A look at the numbers in a LAS or LAZ header that say how long things are, before anything trusts them.

The decoder takes a damaged file at its word: a wrong number of chunks makes it ask for memory beyond any
machine's, and it then ends the whole program. Offsets and sizes are those of LAS 1.4 (ASPRS, R15, tables 3 and
6) and of the LASzip VLR.
"""

import os
import struct

LASZIP_USER, LASZIP_RECORD = b"laszip encoded", 22204
VLR_HEADER, EVLR_HEADER = 54, 60  # bytes
COMPRESSED = 0x80      # bit of the point format
VARIABLE_CHUNKS = 0xFFFFFFFF
LARGEST_CHUNK = 50_000_000  # points; LASzip writes 50,000
LAYERED = 3            # the compressor of point formats 6 and above: a chunk holds its values layer by layer
_LAYERS = {10: 9, 11: 1, 12: 2, 13: 1}  # of POINT14, RGB14, RGBNIR14, WAVEPACKET14; BYTE14 has one for each byte


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
            if evlrs and (first_evlr > size or evlrs * EVLR_HEADER > size - first_evlr):
                return f"it is said to have {evlrs:,} further records from byte {first_evlr:,}, of {size:,}"
            if wrong := _beyond_the_end(file, first_evlr, evlrs, size):
                return wrong
        if not point_format & COMPRESSED:
            return ""
        record = _laszip(file, header_size, vlrs, points_at)
        if record is None:
            return "it is compressed, but the record that says how is missing"
        chunk_size, items = _chunk_size(record), _items(record)
        if sum(items) != record_size:
            return f"its points are said to have {record_size} bytes, and {sum(items)} when compressed"
        if chunk_size != VARIABLE_CHUNKS and not 0 < chunk_size <= LARGEST_CHUNK:
            return f"its points are said to be compressed {chunk_size:,} at a time"
        count = struct.unpack_from("<Q", head, 247)[0] if head[25] >= 4 and len(head) >= 255 else struct.unpack_from("<I", head, 107)[0]
        return _chunk_table(file, points_at, size, record, count)


def _beyond_the_end(file, place, evlrs, size):
    """What is wrong with the lengths of the records behind the points; "" where all lie in the file."""
    for number in range(1, evlrs + 1):
        file.seek(place + 20)
        length = file.read(8)
        after = place + EVLR_HEADER + (struct.unpack("<Q", length)[0] if len(length) == 8 else 0)
        if after > size:
            return f"its record {number:,} behind the points is said to end at byte {after:,}, of {size:,}"
        place = after
    return ""


def points_per_chunk(path):
    """Points that are compressed together in an undamaged file: 1 in a LAS file, 0 where the number changes."""
    with open(path, "rb") as file:
        compressed, record, _ = _compression(file)
        size = _chunk_size(record) if compressed else 1
        return 0 if size == VARIABLE_CHUNKS else size


def chunks_of(path):
    """The LASzip record of an undamaged LAZ file, the byte at which its chunks begin, and their [(points, bytes)]."""
    import lazrs

    with open(path, "rb") as file:
        _, record, points_at = _compression(file)
        file.seek(points_at)
        return record, points_at + 8, lazrs.read_chunk_table(file, lazrs.LazVlr(record))


def _compression(file):
    """Whether a file's points are compressed, its LASzip record, and the byte at which its points begin."""
    head = file.read(227)
    header_size, points_at, vlrs = struct.unpack_from("<HII", head, 94)
    return bool(head[104] & COMPRESSED), _laszip(file, header_size, vlrs, points_at), points_at


def _laszip(file, header_size, vlrs, points_at):
    """The LASzip record; None where there is none, or it is too short."""
    at = header_size
    for _ in range(vlrs):
        file.seek(at)
        head = file.read(VLR_HEADER)
        if len(head) < VLR_HEADER or at >= points_at:
            break
        user, record, length = struct.unpack_from("<2x16sHH", head)
        if user.rstrip(b"\0") == LASZIP_USER and record == LASZIP_RECORD:
            data = file.read(length)
            whole = len(data) >= 34 and len(data) >= 34 + 6 * struct.unpack_from("<H", data, 32)[0]
            return data if whole else None
        at += VLR_HEADER + length
    return None


def _chunk_size(record):
    """Points in a chunk."""
    return struct.unpack_from("<I", record, 12)[0]


def _items(record):
    """Bytes of each item of a point."""
    count = struct.unpack_from("<H", record, 32)[0]
    return [struct.unpack_from("<H", record, 36 + 6 * item)[0] for item in range(count)]


def _kinds(record):
    """The kind of each item of a point."""
    count = struct.unpack_from("<H", record, 32)[0]
    return [struct.unpack_from("<H", record, 34 + 6 * item)[0] for item in range(count)]


def _chunk_table(file, points_at, size, record, count):
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
    if chunks > at - points_at:
        return f"it is said to have {chunks:,} chunks in {at - points_at:,} bytes"
    file.seek(at)
    return _chunks(file, points_at + 8, at, record, count)


def _chunks(file, first, end, record, count):
    """What is wrong with the chunks: together they fill the room before their table and hold the points of the header."""
    import lazrs

    try:
        table = lazrs.read_chunk_table_only(file, lazrs.LazVlr(record))
    except BaseException as problem:  # a panic of the decoder is no Exception
        if isinstance(problem, (KeyboardInterrupt, SystemExit, GeneratorExit)):
            raise
        return f"its table of chunks cannot be read ({problem})"
    taken = sum(length for _, length in table)
    if taken > end - first:
        return f"its chunks are said to take {taken:,} bytes, and there are {end - first:,}"
    if _chunk_size(record) == VARIABLE_CHUNKS and sum(points for points, _ in table) != count:
        return f"its header promises {count:,} points, its chunks {sum(points for points, _ in table):,}"
    return _layers(file, first, record, table) if struct.unpack_from("<H", record)[0] == LAYERED else ""


def _layers(file, first, record, table):
    """What is wrong with the lengths of the layers that each chunk begins with, after its first point as it is."""
    raw = sum(_items(record))
    layers = sum(_LAYERS.get(kind, size) for kind, size in zip(_kinds(record), _items(record)))
    head = raw + 4 + 4 * layers  # the number of points, and the lengths
    at = first
    for _, length in table:
        file.seek(at)
        data = file.read(min(head, length))
        taken = sum(struct.unpack_from(f"<{layers}I", data, raw + 4)) if len(data) == head else 0
        if length and head + taken > length:
            return f"a chunk of {length:,} bytes is said to hold layers of {taken:,}"
        at += length
    return ""
