"""Damaged lengths in a LAS or LAZ header are told before the decoder believes them and ends the program."""

import os
import struct

import laspy
import numpy as np
import pytest
from copc_files import write_copc
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.las.header import find_damage
from lanewright.core.survey.las.parallel_reader import ParallelCloudReader
from lanewright.core.survey.las.reader import read_blocks, read_header


@pytest.fixture(params=[("1.2", 1, "laz"), ("1.4", 6, "laz"), ("1.4", 6, "las")], ids=lambda kind: " ".join(map(str, kind)))
def cloud(request, tmp_path):
    version, point_format, suffix = request.param
    las = laspy.LasData(laspy.LasHeader(version=version, point_format=point_format))
    las.x, las.y, las.z = np.arange(300.0), np.arange(300.0), np.zeros(300)
    path = tmp_path / f"cloud.{suffix}"
    las.write(str(path))
    return path


def changed(path, at, kind, value):
    data = bytearray(path.read_bytes())
    struct.pack_into(kind, data, at, value)
    path.write_bytes(data)
    return path


def read(path):
    return sum(len(block) for block in read_blocks(path))


def test_a_whole_file_has_no_damage(cloud):
    assert find_damage(cloud) == "" and read(cloud) == 300


@pytest.mark.parametrize("at, kind, value, says", [
    (96, "<I", 0xFFFFFFF0, "points begin at byte"), (96, "<I", 10, "points begin at byte"),
    (100, "<I", 0x7FFFFFFF, "variable length records"), (94, "<H", 60000, "points begin at byte"),
])
def test_wrong_lengths_are_reported_in_one_sentence(cloud, at, kind, value, says):
    if (cloud.suffix, at) == (".las", 96):
        return   # the place of the points follows from their number
    with pytest.raises(RoadExtractionError, match=says):
        read(changed(cloud, at, kind, value))


def test_a_file_that_goes_while_its_survey_is_read_is_named(cloud):
    header = read_header(cloud)
    cloud.unlink()
    with pytest.raises(RoadExtractionError, match=f"{cloud.name} cannot be read any more"):
        list(ParallelCloudReader().times(header))


def test_a_file_that_is_cut_off_while_its_survey_is_read_is_refused_in_one_sentence(cloud):
    header = read_header(cloud)
    os.truncate(cloud, cloud.stat().st_size // 2)
    with pytest.raises(RoadExtractionError, match=f"{cloud.name} is (damaged or )?cut off"):
        list(ParallelCloudReader().times(header))


def test_more_chunks_than_bytes_are_not_believed(cloud):
    """The decoder would ask for memory for every one of them, and end QGIS."""
    if cloud.suffix == ".las":
        return
    data = cloud.read_bytes()
    points_at = struct.unpack_from("<I", data, 96)[0]
    table = struct.unpack_from("<q", data, points_at)[0]
    with pytest.raises(RoadExtractionError, match="chunks in"):
        read(changed(cloud, table + 4, "<I", 1_800_000_000))


def test_a_table_of_chunks_outside_the_file_is_reported(cloud):
    if cloud.suffix == ".las":
        return
    points_at = struct.unpack_from("<I", cloud.read_bytes(), 96)[0]
    with pytest.raises(RoadExtractionError, match="table of chunks"):
        read(changed(cloud, points_at, "<q", 10**15))


@pytest.fixture
def copc(tmp_path):
    las = laspy.LasData(laspy.LasHeader(version="1.4", point_format=6))
    las.x, las.y, las.z = np.arange(300.0), np.arange(300.0), np.zeros(300)
    las.write(str(tmp_path / "cloud.laz"))
    return tmp_path / write_copc(tmp_path / "cloud.laz", tmp_path / "cloud.copc.laz", in_a_node=50)


def first_layer_length(path):
    """Where the first chunk says how long its first layer is: after the chunk's first point and the number of points."""
    return struct.unpack_from("<I", path.read_bytes(), 96)[0] + 8 + 30 + 4


def test_layers_longer_than_their_chunk_are_not_believed(cloud):
    """The decoder would ask for as much memory as they say, gigabytes for each, and end QGIS where there is none."""
    if cloud.suffix == ".laz" and laspy.open(cloud).header.point_format.id == 6:
        with pytest.raises(RoadExtractionError, match="chunk of .* bytes states layers of"):
            read(changed(cloud, first_layer_length(cloud), "<I", 0xFFFFFFF0))


def test_chunks_of_all_sizes_are_no_damage(copc):
    assert find_damage(copc) == "" and read(copc) == 300


def test_a_table_of_chunks_overwritten_is_reported(copc):
    """Read as it stands it asks for thousands of gigabytes."""
    data = copc.read_bytes()
    table = struct.unpack_from("<q", data, struct.unpack_from("<I", data, 96)[0])[0]
    for filling in (b"\xff", b"\x00", b"\x55"):
        copc.write_bytes(data[:table + 8] + filling * 12 + data[table + 20:])
        with pytest.raises(RoadExtractionError, match="is damaged or cut off"):
            read(copc)
