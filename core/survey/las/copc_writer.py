"""COPC files: an octree of chunks in a LAZ 1.4 file, of which a viewer reads the part and the density that it shows (specification 1.0, copc.io)."""

from __future__ import annotations

import io
import os
import struct

import numpy as np

from ...lazy import laspy, lazrs

HEADER, INFORMATION, LONG_RECORD = 375, 214, 60   # source: LAS 1.4 and COPC 1.0; bytes of the header, the record with its own head, a late head


def write_copc(cloud: laspy.LasData, path: str | os.PathLike[str], in_a_node: int = 30_000) -> None:
    """Write points of point format 6, 7 or 8 as COPC, with the records of their header.

    On the deepest level lie three points of four, on the one above three of four of the rest, and so on up to the root; of points in the order
    of the scan each level so holds an even sample. There are as many levels as give `in_a_node` points a node where they cover an area evenly.
    """
    key = _keys(cloud, in_a_node)
    order = np.argsort(key, kind="stable")
    nodes = np.split(order, 1 + np.flatnonzero(np.diff(key[order])))
    laszip = lazrs.LazVlr.new_for_compression(cloud.point_format.id, cloud.point_format.num_extra_bytes, True)
    cloud.update_header()
    plain = io.BytesIO()
    cloud.header.write_to(plain)
    late = list(cloud.header.evlrs or [])
    records = b"".join(_record(record) for record in cloud.header.vlrs)
    records += struct.pack("<H16sHH32s", 0, b"laszip encoded", 22204, len(laszip.record_data()), b"") + bytes(laszip.record_data())
    points_at = HEADER + INFORMATION + len(records)
    with open(path, "w+b") as file:
        file.write(bytes(points_at))
        compressor = lazrs.LasZipCompressor(file, laszip)
        for rows in nodes:
            compressor.compress_many(np.asarray(cloud.points.array[rows]).tobytes())
            compressor.finish_current_chunk()
        compressor.done()
        hierarchy_at = file.seek(0, io.SEEK_END)
        file.seek(points_at)
        entries, at = b"", points_at + 8
        for number, (count, size) in zip(key[[rows[0] for rows in nodes]].tolist(), lazrs.read_chunk_table(file, laszip)):
            entries += struct.pack("<4iQii", number >> 57, *(number >> 19 * axis & (1 << 19) - 1 for axis in range(3)), at, size, count)
            at += size
        file.seek(hierarchy_at)
        file.write(struct.pack("<H16sHQ32s", 0, b"copc", 1000, len(entries), b"hierarchy") + entries)
        for record in late:
            file.write(_record(record, "<H16sHQ32s"))
        header = bytearray(plain.getvalue()[:HEADER])
        struct.pack_into("<II", header, 96, points_at, len(cloud.header.vlrs) + 2)
        header[104] |= 0x80   # compressed
        struct.pack_into("<QI", header, 235, hierarchy_at, 1 + len(late))
        corner, edge = _cube(cloud)
        times = np.asarray(cloud.gps_time)
        file.seek(0)
        file.write(header + struct.pack("<H16sHH32s", 0, b"copc", 1, 160, b"") + struct.pack(
            "<5dQQ2d88x", *corner + edge / 2, edge / 2, edge / 128, hierarchy_at + LONG_RECORD, len(entries), times.min(), times.max()) + records)


def _cube(cloud):
    """The corner and the edge of the cube about all points, in units of the file."""
    low, high = (np.array([pick(cloud[name]) for name in "XYZ"]) * cloud.header.scales + cloud.header.offsets for pick in (np.min, np.max))
    edge = (high - low).max() + 2e-3
    return (low + high - edge) / 2, edge


def _keys(cloud, in_a_node):
    """(N,) int64 the level of the node of each point in the upper bits, and its numbers along z, y and x in 19 bits each."""
    corner, edge = _cube(cloud)
    deepest = min(max(int(np.ceil(np.log2(len(cloud.points) / in_a_node) / 2)), 0), 18)
    level = np.full(len(cloud.points), deepest, np.int64)
    for above in range(deepest - 1, -1, -1):
        level[:: 4 ** (deepest - above)] = above
    key = level << 57
    for axis, name in enumerate("xyz"):
        share = (np.asarray(cloud[name], float) - corner[axis]) / edge
        key |= np.clip(share * (1 << level), 0, (1 << level) - 1).astype(np.int64) << 19 * axis
    return key


def _record(record, head="<H16sHH32s"):
    content = record.record_data_bytes()
    return struct.pack(head, 0, record.user_id.encode(), record.record_id, len(content), record.description.encode()[:32]) + content
