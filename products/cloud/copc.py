"""COPC files: an octree of chunks in a LAZ 1.4 file, of which a viewer reads the part and the density that it shows (specification 1.0, copc.io)."""

from __future__ import annotations

import io
import os
import struct

import numpy as np

from ...core.lazy import laspy, lazrs


def write_copc(cloud: laspy.LasData, path: str | os.PathLike[str], deepest: int = 3, in_a_node: int = 2000) -> str:
    """Write points of point format 6, 7 or 8 as COPC; returns the path.

    `in_a_node` points, spread over the node, stay in it, the others go to its eight parts, down to level `deepest`, which takes all that come.
    """
    places = np.stack([np.asarray(cloud[name], float) for name in "xyz"], axis=1)
    middle, half = (places.max(axis=0) + places.min(axis=0)) / 2, np.ptp(places, axis=0).max() / 2 + 1e-3
    nodes = _nodes(places, middle - half, 2 * half, deepest, in_a_node)
    laszip = lazrs.LazVlr.new_for_compression(cloud.point_format.id, cloud.point_format.num_extra_bytes, True)
    plain = io.BytesIO()
    cloud.write(plain)
    records = b"".join(_record(record.user_id.encode(), record.record_id, record.record_data_bytes()) for record in cloud.header.vlrs)
    records += _record(b"laszip encoded", 22204, bytes(laszip.record_data()))
    header_size, info_size, long_record = 375, 214, 60   # bytes; the information of COPC with its own head
    points_at = header_size + info_size + len(records)
    with open(path, "w+b") as file:
        file.write(bytes(points_at))
        compressor = lazrs.LasZipCompressor(file, laszip)
        for rows in nodes.values():
            compressor.compress_many(cloud.points.array[rows].tobytes())
            compressor.finish_current_chunk()
        compressor.done()
        hierarchy_at = file.seek(0, io.SEEK_END)
        file.seek(points_at)
        entries, at = b"", points_at + 8
        for key, (count, size) in zip(nodes, lazrs.read_chunk_table(file, laszip)):
            entries += struct.pack("<4iQii", *map(int, key), at, size, count)
            at += size
        file.seek(hierarchy_at)
        file.write(struct.pack("<H16sHQ32s", 0, b"copc", 1000, len(entries), b"hierarchy") + entries)
        header = bytearray(plain.getvalue()[:header_size])
        struct.pack_into("<II", header, 96, points_at, len(cloud.header.vlrs) + 2)
        header[104] |= 0x80   # compressed
        struct.pack_into("<QI", header, 235, hierarchy_at, 1)
        times = np.asarray(cloud.gps_time)
        info = struct.pack("<5dQQ2d88x", *middle, half, 2 * half / 128, hierarchy_at + long_record, len(entries), times.min(), times.max())
        file.seek(0)
        file.write(header + _record(b"copc", 1, info) + records)
    return str(path)


def _nodes(places, corner, edge, deepest, most):
    """{(level, x, y, z): rows} of an octree, every row once, level by level."""
    nodes, left = {}, np.arange(len(places))
    for level in range(deepest + 1):
        cells = np.clip(((places[left] - corner) / edge * 2**level).astype(np.int64), 0, 2**level - 1)
        numbers, of = np.unique(cells @ (1 << level * np.arange(3)), return_inverse=True)
        order = np.argsort(of, kind="stable")
        stays = np.zeros(len(left), bool)
        for number, rows in zip(numbers.tolist(), np.split(order, np.cumsum(np.bincount(of))[:-1])):
            taken = rows if level == deepest else rows[:: -(-len(rows) // most)]
            stays[taken] = True
            nodes[(level, *(number >> level * axis & (1 << level) - 1 for axis in range(3)))] = left[taken]
        left = left[~stays]
        if not len(left):
            break
    return nodes


def _record(user, number, content):
    return struct.pack("<H16sHH32s", 0, user, number, len(content), b"") + content
