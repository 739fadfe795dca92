"""Headers that state something else than the file holds: what is there is read, and both numbers are told."""

import struct

import laspy
import numpy as np
import pytest
from copc_files import write_copc
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.las.parallel_reader import ParallelCloudReader, points_near
from lanewright.core.survey.las.reader import read_blocks, read_header, read_headers

COUNT, LONG_COUNT, RECORD_SIZE, POINTS_AT = (107, "<I"), (247, "<Q"), (105, "<H"), (96, "<I")
POINTS = 120_000


def street(point_format, version, count=POINTS, extra=()):
    rng = np.random.default_rng(4)
    header = laspy.LasHeader(version=version, point_format=point_format)
    header.scales, header.offsets = [0.001] * 3, [500_000.0, 5_800_000.0, 0.0]
    header.add_extra_dims([laspy.ExtraBytesParams(name, kind) for name, kind in extra])
    las = laspy.LasData(header)
    las.x, las.y, las.z = 500_000 + np.sort(rng.uniform(0, 200, count)), 5_800_000 + rng.uniform(0, 20, count), 60 + rng.uniform(0, 3, count)
    las.intensity = rng.integers(0, 3000, count)
    for name, _ in extra:
        las[name] = rng.integers(0, 200, count)
    return las


def written(las, path, *changes):
    las.write(str(path))
    data = bytearray(path.read_bytes())
    for (at, kind), value in changes:
        struct.pack_into(kind, data, at, value)
    path.write_bytes(data)
    return path


def x_of(path):
    return np.concatenate([np.asarray(block.x) for block in read_blocks(path)])


def check_all_read(path, las):
    """All points come, in blocks and from several threads, and the header says so."""
    header = read_header(path)
    assert header.count == len(las.points)
    np.testing.assert_allclose(x_of(path), las.x, atol=1e-3)
    reader = ParallelCloudReader()
    found = np.concatenate([np.array(points.x) for part in reader.ranges([header], 30_000)
                            for points in reader.points(header, *part[1:], 30_000)])
    np.testing.assert_allclose(found, las.x, atol=1e-3)
    return header


@pytest.mark.parametrize("stated", [POINTS // 3, 110_000, 1, 0, POINTS + 77_777])
@pytest.mark.parametrize("version, point_format, suffix", [("1.2", 1, ".las"), ("1.2", 3, ".laz"), ("1.4", 6, ".las"), ("1.4", 7, ".laz")])
def test_a_header_that_states_other_points_than_there_are_is_told_and_all_are_read(tmp_path, version, point_format, suffix, stated):
    las = street(point_format, version)
    path = written(las, tmp_path / f"cloud{suffix}", (COUNT, stated), *[(LONG_COUNT, stated)] * (version == "1.4"))
    header = check_all_read(path, las)
    (note,) = header.notes
    assert f"{stated:,} points" in note and f"{POINTS:,} are there" in note and path.name in note


def test_points_of_a_second_drive_far_away_behind_those_stated_are_read_too(tmp_path):
    las = street(1, "1.2")
    x = np.array(las.x)
    x[POINTS // 3:] += 30_000.0
    las.x = x
    check_all_read(written(las, tmp_path / "cloud.las", (COUNT, POINTS // 3)), las)


def test_of_several_files_each_warning_names_its_own(tmp_path):
    paths = [written(street(1, "1.2", 5000), tmp_path / f"{name}.laz", (COUNT, 1000)) for name in "ab"]
    told = []
    read_headers(paths, told.append)
    assert ["a.laz" in told[0], "b.laz" in told[1], len(told)] == [True, True, 2]


@pytest.mark.parametrize("legacy, long", [(POINTS, 0), (0, POINTS), (POINTS, 5), (5, POINTS)])
@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_of_two_counts_the_right_one_is_taken_without_a_word(tmp_path, suffix, legacy, long):
    las = street(6, "1.4")
    path = written(las, tmp_path / f"cloud{suffix}", (COUNT, legacy), (LONG_COUNT, long))
    assert check_all_read(path, las).notes == ()


def test_chunks_of_all_sizes_are_counted_too(tmp_path):
    las = street(6, "1.4", 3000)
    las.write(str(tmp_path / "cloud.laz"))
    path = tmp_path / write_copc(tmp_path / "cloud.laz", tmp_path / "cloud.copc.laz", in_a_node=500)
    data = bytearray(path.read_bytes())
    struct.pack_into("<Q", data, 247, 900)
    path.write_bytes(data)
    assert len(x_of(path)) == 3000 and "3,000 are there" in read_header(path).notes[0]


@pytest.mark.parametrize("behind", [b"\0" * 4096, b"made by a program that signs its files" * 3, np.random.default_rng(1).bytes(28 * 40)])
def test_what_a_program_writes_behind_the_points_is_no_point(tmp_path, behind):
    las = street(1, "1.2", 5000)
    path = written(las, tmp_path / "cloud.las")
    path.write_bytes(path.read_bytes() + behind)
    assert check_all_read(path, las).notes == ()


def test_waveforms_behind_the_points_are_no_points(tmp_path):
    las = street(4, "1.3", 5000)
    path = written(las, tmp_path / "cloud.las")
    whole = path.read_bytes()
    path.write_bytes(whole[:227] + struct.pack("<Q", len(whole)) + whole[235:] + whole[-57 * 3000:])
    assert check_all_read(path, las).notes == ()


def test_a_cloud_of_equal_points_holds_as_many_as_its_header_states(tmp_path):
    las = laspy.LasData(laspy.LasHeader(version="1.2", point_format=1))
    las.x = las.y = las.z = np.zeros(4000)
    assert read_header(written(las, tmp_path / "cloud.laz")).count == 4000


def test_lengths_of_a_point_and_the_place_of_the_first_follow_from_the_points(tmp_path):
    las = street(1, "1.2", 5000, [("echo", "u1"), ("range", "u2")])
    for number, changes in enumerate([[(RECORD_SIZE, 28)], [(RECORD_SIZE, 40)], [(POINTS_AT, 227)]]):
        path = written(las, tmp_path / f"cloud{number}.las", *changes)
        header = check_all_read(path, las)
        assert "bytes per point" in header.notes[0] or "begin at byte" in header.notes[0]
    path = written(las, tmp_path / "cloud.laz", (RECORD_SIZE, 28))
    assert "28 bytes per point, and there are 31" in check_all_read(path, las).notes[0]


def test_points_shorter_than_their_format_are_refused_with_the_true_cause(tmp_path):
    path = written(street(1, "1.2", 5000), tmp_path / "cloud.las", ((104, "<B"), 3))
    with pytest.raises(RoadExtractionError, match="28 bytes per point, and points of format 3 have 34"):
        read_header(path)


NAMES = {"GBK": "移动测量系统".encode("gbk"), "Latin-1": "Straßenbefahrung".encode("latin-1"), "full": b"x" * 32}


@pytest.mark.parametrize("text", NAMES.values(), ids=NAMES)
@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_names_of_makers_are_read_in_any_encoding(tmp_path, suffix, text):
    las = street(6, "1.4", 3000, [("quality", "u1")])
    las.header.vlrs.append(laspy.VLR("maker", 7, "text", b"\x80\x81"))
    las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("maker", 8, "text", b"\x80\x81")])
    path = written(las, tmp_path / f"cloud{suffix}")
    data = bytearray(path.read_bytes())
    vlr, evlr, field = data.find(b"maker\0"), data.rfind(b"maker\0"), data.find(b"quality\0")
    for at, size in [(26, 32), (58, 32), (vlr, 16), (vlr + 20, 32), (evlr, 16), (evlr + 26, 32), (field, 32), (field + 156, 32)]:
        data[at:at + size] = text[:size].ljust(size, b"\0")
    path.write_bytes(data)
    assert check_all_read(path, las).notes == ()


def described(name, kind=1, options=0, description=b""):
    return struct.pack("<2xBB32s124x32s", kind, options, name, description)


FIELDS = {
    "two of one name": [described(b"echo"), described(b"echo")],
    "no name": [described(b""), described(b"", 2)],
    "the name of a field of the format": [described(b"intensity"), described(b"X")],
    "spaces": [described(b"echo width"), described(b" ")],
    "bytes of no type": [described(b"raw", 0, 2)],
    "no bytes of no type": [described(b"raw", 0, 0), described(b"echo", 3)],
    "a pair, as until 2013": [described(b"beam", 11)],
    "a type that nobody defined": [described(b"echo", 99)],
    "more bytes than there are": [described(b"echo", 10), described(b"width", 10)],
    "fewer bytes than there are": [described(b"echo")],
    "a name and a text that are none": [described(b"\xd2\xc6\xb6\xaf" * 8, 1, 0, b"\xff" * 32), described(b"echo", 1, 255)],
}


@pytest.mark.parametrize("fields", FIELDS.values(), ids=FIELDS)
@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_extra_fields_are_read_as_exporters_describe_them(tmp_path, suffix, fields):
    las = street(1, "1.2", 3000, [("first", "u1"), ("second", "u1")])
    path = written(las, tmp_path / f"cloud{suffix}")
    data = path.read_bytes()
    at = data.find(b"LASF_Spec") - 2
    described_there = struct.unpack_from("<H", data, at + 20)[0]
    new = b"".join(fields)
    head = data[at:at + 20] + struct.pack("<H", len(new)) + data[at + 22:at + 54]
    grown = len(new) - described_there
    data = bytearray(data[:at] + head + new + data[at + 54 + described_there:])
    points_at = struct.unpack_from("<I", data, 96)[0] + grown
    struct.pack_into("<I", data, 96, points_at)
    if suffix == ".laz":
        struct.pack_into("<q", data, points_at, struct.unpack_from("<q", data, points_at)[0] + grown)
    path.write_bytes(data)
    assert check_all_read(path, las).notes == ()


def test_extra_bytes_that_nobody_describes_are_read_over(tmp_path):
    las = street(1, "1.2", 3000, [("first", "u1")])
    path = written(las, tmp_path / "cloud.las")
    data = path.read_bytes().replace(b"LASF_Spec", b"somebody\0")
    path.write_bytes(data)
    assert check_all_read(path, las).notes == ()


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_records_that_lie_beyond_the_end_are_told_and_left_out(tmp_path, suffix):
    las = street(6, "1.4", 3000)
    las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("maker", 8, "text", bytes(2000))])
    path = written(las, tmp_path / f"cloud{suffix}")
    data = path.read_bytes()
    first = struct.unpack_from("<Q", data, 235)[0]
    for number, changed in enumerate([data[:-500], data[:235] + struct.pack("<Q", 2**40) + data[243:],
                                      data[:first + 20] + struct.pack("<Q", 2**50) + data[first + 28:]]):
        path = tmp_path / f"{number}{suffix}"
        path.write_bytes(changed)
        assert "1 of its 1 extended records lie beyond its end" in check_all_read(path, las).notes[0]


def with_bounds(path, low, high):
    data = bytearray(path.read_bytes())
    struct.pack_into("<6d", data, 179, *np.c_[high, low].ravel())
    path.write_bytes(data)
    return path


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_bounds_that_do_not_hold_the_points_hide_none_of_them(tmp_path, suffix):
    las = street(1, "1.2")
    path = with_bounds(written(las, tmp_path / f"cloud{suffix}"), [499_000, 5_799_000, 0], [500_080, 5_801_000, 100])
    header = read_header(path)
    np.testing.assert_allclose([header.minimum[0], header.maximum[0]], [las.x.min(), las.x.max()], atol=2e-3)
    assert len(points_near([path], 500_150.0, 5_800_010.0, 5.0)) > 1000


def test_bounds_of_a_whole_project_are_no_reason_to_look_at_the_points(tmp_path):
    low, high = [400_000, 5_700_000, 0], [600_000, 5_900_000, 500]
    header = read_header(with_bounds(written(street(1, "1.2"), tmp_path / "cloud.laz"), low, high))
    assert (list(header.minimum), list(header.maximum)) == (low, high)


def test_a_point_format_that_nobody_knows_is_refused_in_one_sentence(tmp_path):
    path = written(street(1, "1.2"), tmp_path / "cloud.las")
    content = bytearray(path.read_bytes())
    content[104], content[107] = 35, 9   # of the point format and the count
    path.write_bytes(content)
    with pytest.raises(RoadExtractionError):
        read_header(path)


def test_coordinates_that_overflowed_the_integers_of_their_file_are_told(tmp_path):
    """A scale of a ten-millionth from an offset of 0 ends at 215 m."""
    path = written(street(1, "1.2"), tmp_path / "cloud.laz", *(((at + 8 * axis, "<d"), value) for at, value in ((131, 1e-7), (155, 0.0))
                                                               for axis in range(3)))
    (note,) = read_header(path).notes
    assert "y runs from 5800000" in note or "x runs from 500000" in note


def test_an_intensity_elsewhere_is_named_by_its_fields(tmp_path):
    from lanewright.core.survey.las.point_fields import without_intensity

    path = written(street(1, "1.2", 3000, [("echo width", "u2")]), tmp_path / "cloud.laz")
    assert "(echo width)" in without_intensity(read_headers([path]), "intensity", ["echo width"])


def test_a_point_format_that_nobody_defined_is_refused_in_one_sentence(tmp_path):
    for suffix in (".las", ".laz"):
        with pytest.raises(RoadExtractionError, match="cloud"):
            read_header(written(street(1, "1.2", 100), tmp_path / f"cloud{suffix}", ((104, "<B"), 63)))
