"""Checks of the lengths in a LAS or LAZ header before a decoder relies on them.

The decoder does not check them: with a wrong number of chunks it asks for more memory than any machine has,
which ends the whole program. Offsets and sizes are those of LAS 1.4 (ASPRS, R15, tables 3 and 6) and of the
LASzip VLR.
"""

from __future__ import annotations

import os
import struct

import numpy as np

from .mending import MendedHeader, count_note, mend, opened, sampled_places
from .records_of_file import VARIABLE_CHUNKS, VLR_HEADER_SIZE, HeaderFields, base_size

MAX_CHUNK_SIZE = 50_000_000  # points; LASzip writes 50,000
CHUNKED_COMPRESSOR = 2       # of the other point formats, where each chunk begins anew
LAYERED_COMPRESSOR = 3       # of point formats 6 and above: a chunk holds its values layer by layer
MAX_DECODED = 400_000        # points of a last chunk that is decoded to count them: larger ones take too much memory
FLUSHED_BYTES = 16           # at most that a coder writes behind its last point: points that need fewer bytes are not all there are
MAX_LOOKS = 1000             # chunks whose first point is looked at
LAYERS_OF_ITEM = {10: 9, 11: 1, 12: 2, 13: 1}  # POINT14, RGB14, RGBNIR14, WAVEPACKET14; BYTE14 has one layer for each byte


def find_damage(path: str | os.PathLike[str], mended: MendedHeader | None = None) -> str:
    """What is wrong with the lengths in a file's header.

    Parameters
    ----------
    path : of a LAS or LAZ file
    mended : what is read in place of some of its bytes; by default as `mend` says

    Returns
    -------
    The end of a sentence; "" where nothing is wrong, or the file is not a LAS file at all
    """
    size = os.path.getsize(path)
    with opened(path, mend(path) if mended is None else mended) as file:
        fields = HeaderFields.read(file)
        if fields is None:
            return ""
        if not 227 <= fields.header_size <= fields.points_at <= size:
            return f"its header states that the points begin at byte {fields.points_at:,} of {size:,}"
        if fields.vlrs * VLR_HEADER_SIZE > fields.points_at - fields.header_size:
            return f"its header states {fields.vlrs:,} variable length records, more than fit before the points"
        least = base_size(fields.point_format)
        if least is not None and fields.record_size < least:
            return f"its header states {fields.record_size} bytes per point, and points of format {fields.point_format} have {least}"
        if not fields.compressed:
            there = (size - fields.points_at) // fields.record_size if fields.record_size else 0
            return f"its header promises {fields.count:,} points, and {there:,} are there" if fields.count > there else ""
        compression = _compression(file)
        if compression is None:
            return "it is compressed, but the record that describes the compression is missing"
        if compression.point_size != fields.record_size:
            return f"its header states {fields.record_size} bytes per point, the compressor {compression.point_size}"
        if compression.chunk_size != VARIABLE_CHUNKS and not 0 < compression.chunk_size <= MAX_CHUNK_SIZE:
            return f"its compressor states chunks of {compression.chunk_size:,} points"
        return _chunk_table_damage(file, fields.points_at, size, compression)


def with_points_of_chunks(path: str | os.PathLike[str], mended: MendedHeader) -> MendedHeader:
    """The header of an undamaged file, with as many points as its chunks hold where it is compressed.

    Chunks of point formats 6 and above, and those of all sizes, state their points. Of the others each but the last is full, and how many
    points the last has shows when it is decoded: points beyond its last need bytes that are not there.
    """
    with opened(path, mended) as file:
        fields = HeaderFields.read(file)
        if fields is None or not fields.compressed:
            return mended
        compression, begin, table = _chunks(file)
        count = _points_of(file, compression, begin, table, fields)
    if count == fields.count:
        return mended
    return mended.with_count(fields, count, "" if count in fields.counts else count_note(fields.count, count))


def places_here_and_there(path: str | os.PathLike[str], mended: MendedHeader) -> np.ndarray:
    """Coordinates of points all over an undamaged file, without decoding it.

    Returns
    -------
    (N, 3) map coordinates: of the first point of every chunk, which is not compressed, or of points evenly spread in a file without chunks
    """
    with opened(path, mended) as file:
        fields = HeaderFields.read(file)
        if fields is None or not fields.count:
            return np.empty((0, 3))
        if not fields.compressed:
            places = sampled_places(file, fields, 0, fields.count)
        else:
            _, begin, table = _chunks(file)
            at = begin + np.cumsum([0] + [length for points, length in table if points and length])[:-1]
            places = np.empty((0, 3), "<i4")
            if len(at):
                places = np.array([_integers_at(file, int(place)) for place in at[np.unique(np.linspace(0, len(at) - 1, MAX_LOOKS).astype(int))]])
        return places * fields.scales + fields.offsets


def _integers_at(file, place):
    """The stored x, y and z of a point that is not compressed."""
    file.seek(place)
    return np.frombuffer(file.read(12), "<i4")


def _points_of(file, compression, begin, table, fields):
    """The points in the chunks of a file; the header's number where they do not tell."""
    size, compressor = compression.chunk_size, compression.compressor
    if size == VARIABLE_CHUNKS:
        return sum(points for points, _ in table)
    if not table or compressor not in (CHUNKED_COMPRESSOR, LAYERED_COMPRESSOR):
        return fields.count
    full, length = size * (len(table) - 1), table[-1][1]
    file.seek(begin + sum(nbytes for _, nbytes in table[:-1]))
    chunk = file.read(length)
    if compressor == LAYERED_COMPRESSOR:
        raw = compression.point_size
        return full + struct.unpack_from("<I", chunk, raw)[0] if len(chunk) >= raw + 4 else fields.count
    stated = next((count for count in fields.counts if full < count <= full + size), 0)
    if min(size, stated - full if stated else size) > MAX_DECODED:
        return stated or fields.count
    if stated and not _holds(compression, chunk[:length - max(FLUSHED_BYTES, length // 100)], stated - full):
        return stated
    low, high = max(stated - full, 1), size + 1   # points that can be decoded, and that cannot
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if _holds(compression, chunk, middle) else (low, middle)
    return full + low


def _holds(compression, chunk, points):
    """Whether so many points can be decoded from the bytes of a chunk."""
    import lazrs

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
    """The chunks of an undamaged LAZ file.

    Returns
    -------
    record : the LASzip record
    begin : byte at which the chunks begin
    table : [(points, bytes)] of each chunk
    """
    with open(path, "rb") as file:
        compression, begin, table = _chunks(file)
        return compression.data, begin, table


def _chunks(file):
    """(Compression, first byte, [(points, bytes)] of each chunk) of an open file."""
    import lazrs

    compression, points_at = _compression(file), HeaderFields.read(file).points_at
    file.seek(points_at)
    return compression, points_at + 8, lazrs.read_chunk_table(file, lazrs.LazVlr(compression.data))


def _compression(file):
    """The Compression of the points of an open LAS or LAZ file; None where they are not compressed, or the record of it is missing."""
    fields = HeaderFields.read(file)
    records = fields.records(file, os.fstat(file.fileno()).st_size) if fields.compressed else ()
    return next((record.compression for record in records if record.at < fields.points_at and record.compression is not None), None)


def _chunk_table_damage(file, points_at, size, compression):
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
    return _chunk_damage(file, points_at + 8, at, compression)


def _chunk_damage(file, first, end, compression):
    """What is wrong with the chunks: they must fit before their table."""
    import lazrs

    try:
        table = lazrs.read_chunk_table_only(file, lazrs.LazVlr(compression.data))
    except BaseException as problem:  # a panic of the decoder is not an Exception
        if isinstance(problem, (KeyboardInterrupt, SystemExit, GeneratorExit)):
            raise
        return f"its table of chunks cannot be read ({problem})"
    taken = sum(length for _, length in table)
    if taken > end - first:
        return f"its chunks should take {taken:,} bytes, and there are {end - first:,}"
    if end > first and not taken:
        return f"its table of chunks is empty, and there are {end - first:,} bytes of points"
    return _layer_damage(file, first, compression, table) if compression.compressor == LAYERED_COMPRESSOR else ""


def _layer_damage(file, first, compression, table):
    """What is wrong with the lengths of the layers, which each chunk states after its first, uncompressed point, or with its points."""
    raw = compression.point_size
    layers = sum(LAYERS_OF_ITEM.get(kind, size) for kind, size in compression.items)
    head = raw + 4 + 4 * layers  # the number of points, and the lengths
    counted = compression.chunk_size == VARIABLE_CHUNKS
    at = first
    for points, length in table:
        file.seek(at)
        data = file.read(min(head, length))
        count, *lengths = struct.unpack_from(f"<{1 + layers}I", data, raw) if len(data) == head else (points,)
        if length and head + sum(lengths) > length:
            return f"a chunk of {length:,} bytes states layers of {sum(lengths):,}"
        if counted and count != points:
            return f"its table of chunks states {points:,} points in a chunk that holds {count:,}"
        at += length
    return ""
