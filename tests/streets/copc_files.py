"""COPC files for the tests, as the specification 1.0 (copc.io) has them: an octree of chunks in a LAZ 1.4 file; and virtual point clouds.

Nothing that Lanewright needs at work writes them; here a LAS file is parted
into nodes, each a chunk of its own size, with the hierarchy in a record after
the points.
"""

import io
import json
import struct
from pathlib import Path

import laspy
import lazrs
import numpy as np

HEADER, VLR, EVLR, ENTRY = 375, 54, 60, 32  # bytes
COMPRESSED = 0x80


def write_copc(source, path, deepest=3, in_a_node=2000):
    """Write the points of a LAS or LAZ file (point format 6 to 8) as COPC; returns the path.

    `in_a_node` points, spread over the node, stay in it, the others go to its
    eight parts, down to level `deepest`, which takes all that come.
    """
    cloud = laspy.read(source)
    assert cloud.point_format.id in (6, 7, 8), "COPC allows no other point format"
    places = np.stack([np.asarray(cloud[name], float) for name in "xyz"], axis=1)
    middle, half = (places.max(axis=0) + places.min(axis=0)) / 2, np.ptp(places, axis=0).max() / 2 + 1e-3
    nodes = _nodes(places, middle - half, 2 * half, deepest, in_a_node)
    laszip = lazrs.LazVlr.new_for_compression(cloud.point_format.id, cloud.point_format.num_extra_bytes, True)
    plain = io.BytesIO()
    cloud.write(plain)
    plain = plain.getvalue()
    records = _records(plain) + [(b"laszip encoded", 22204, bytes(laszip.record_data()))]
    points_at = HEADER + VLR + 160 + sum(VLR + len(data) for _, _, data in records)

    raw = cloud.points.array
    with open(path, "wb") as file:
        file.write(bytes(points_at))
        compressor = lazrs.LasZipCompressor(file, laszip)
        for rows in nodes.values():
            compressor.compress_many(raw[rows].tobytes())
            compressor.finish_current_chunk()
        compressor.done()
        hierarchy_at = file.seek(0, io.SEEK_END)
        entries = _entries(path, laszip, points_at, nodes)
        file.write(struct.pack("<H16sHQ32s", 0, b"copc", 1000, len(entries), b"hierarchy") + entries)
        header = bytearray(plain[:HEADER])
        struct.pack_into("<I", header, 96, points_at)
        struct.pack_into("<I", header, 100, len(records) + 1)
        header[104] |= COMPRESSED
        struct.pack_into("<QI", header, 235, hierarchy_at, 1)
        times = np.asarray(cloud.gps_time)
        info = struct.pack("<5dQQ2d88x", *middle, half, 2 * half / 128, hierarchy_at + EVLR, len(entries), times.min(), times.max())
        file.seek(0)
        file.write(header + _record(b"copc", 1, info) + b"".join(_record(*record) for record in records))
    return str(path)


def write_vpc(path, names, overview="", corner=(500000.0, 5400000.0, 0.0), edge=100.0, crs=""):
    """Write a virtual point cloud that names these files, as pdal_wrench and with it QGIS write it; returns the path."""
    (x, y, z), (far, deep, high) = corner, (value + edge for value in corner)
    outline = {"type": "Polygon", "coordinates": [[[x, y, z], [x, deep, z], [far, deep, high], [far, y, high], [x, y, z]]]}
    box = [x, y, z, far, deep, high]
    shown = {"overview": {"href": overview, "roles": ["overview"]}} if overview else {}
    features = [{
        "type": "Feature", "stac_version": "1.0.0", "stac_extensions": [
            "https://stac-extensions.github.io/pointcloud/v1.0.0/schema.json", "https://stac-extensions.github.io/projection/v1.1.0/schema.json"],
        "id": Path(name).stem, "geometry": outline, "bbox": box, "properties": {
            "datetime": "2024-05-17T00:00:00Z", "pc:count": 1000, "pc:encoding": "?", "pc:type": "lidar",
            "pc:schemas": [{"name": axis, "size": 8, "type": "floating"} for axis in "XYZ"],
            "proj:bbox": box, "proj:geometry": outline, "proj:wkt2": crs},
        "links": [], "assets": {"data": {"href": name, "roles": ["data"]}, **shown}} for name in names]
    Path(path).write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    return str(path)


def _nodes(places, corner, edge, deepest, most):
    """{(level, x, y, z): rows} of an octree, every row once, level by level."""
    found, left = {}, np.arange(len(places))
    for level in range(deepest + 1):
        cells = np.clip(((places[left] - corner) / edge * 2**level).astype(int), 0, 2**level - 1)
        keys, of = np.unique(cells, axis=0, return_inverse=True)
        order = np.argsort(of.ravel(), kind="stable")
        stays = np.zeros(len(left), bool)
        for key, rows in zip(keys, np.split(order, np.cumsum(np.bincount(of.ravel()))[:-1])):
            taken = rows if level == deepest else rows[:: -(-len(rows) // most)]
            stays[taken] = True
            found[(level, *key)] = left[taken]
        left = left[~stays]
        if not len(left):
            break
    return found


def _entries(path, laszip, points_at, nodes):
    """The hierarchy: where each node's chunk lies in the file."""
    with open(path, "rb") as file:
        file.seek(points_at)
        table = lazrs.read_chunk_table(file, laszip)
    entries, at = b"", points_at + 8
    for key, rows, (count, size) in zip(nodes, nodes.values(), table):
        assert count == len(rows)
        entries += struct.pack("<4iQii", *map(int, key), at, size, count)
        at += size
    return entries


def _records(las):
    """(user, number, content) of the records in a LAS file's header."""
    size, _, count = struct.unpack_from("<HII", las, 94)
    found, at = [], size
    for _ in range(count):
        user, number, length = struct.unpack_from("<2x16sHH", las, at)
        found.append((user, number, las[at + VLR:at + VLR + length]))
        at += VLR + length
    return found


def _record(user, number, content):
    return struct.pack("<H16sHH32s", 0, user, number, len(content), b"") + content
