"""LAS and LAZ files as they come, whole and broken."""

import numpy as np
import pytest
from drives import EAST, NORTH, write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.crs import check_projected
from lanewright.core.survey.las.point_fields import ScannerCensus, numbers_by_value, times_by_value
from lanewright.core.survey.las.reader import read_blocks, read_header, read_headers


def places(count=5000):
    rng = np.random.default_rng(2)
    return EAST + rng.uniform(0, 50, count), NORTH + rng.uniform(0, 50, count), 100 + rng.uniform(0, 3, count), np.sort(rng.uniform(10, 20, count))


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize("version, point_format", [("1.2", 0), ("1.2", 1), ("1.2", 2), ("1.2", 3), ("1.3", 1), ("1.4", 6), ("1.4", 7), ("1.4", 8)])
def test_every_version_and_point_format_is_read_whole(tmp_path, suffix, version, point_format):
    path = write_cloud(tmp_path / f"cloud{suffix}", *places(), point_format=point_format, version=version, crs="EPSG:32632")
    header = read_header(path)
    assert (header.version, header.point_format, header.count) == (version, point_format, 5000)
    assert header.has_time == (point_format not in (0, 2))
    assert "UTM zone 32N" in header.crs, "from GeoKeys up to 1.3, from WKT in 1.4"
    x = np.concatenate([np.asarray(block["x"]) for block in read_blocks(path, 777)])
    np.testing.assert_allclose(x, places()[0], atol=6e-4)


@pytest.mark.parametrize("share", [0.3, 0.7, 0.97])
@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_a_file_cut_off_is_refused_and_named(tmp_path, suffix, share):
    path = tmp_path / f"cut{suffix}"
    data = open(write_cloud(tmp_path / f"whole{suffix}", *places(60_000)), "rb").read()
    path.write_bytes(data[:int(len(data) * share)])
    with pytest.raises(RoadExtractionError, match=path.name):
        for _ in read_blocks(path):
            pass


@pytest.mark.parametrize("name, content, says", [
    ("cloud.laz", b"", "cannot be read"), ("cloud.las", b"not a point cloud at all" * 20, "cannot be read"),
    ("cloud.xyz", b"1 2 3", "not a LAS or LAZ file"), ("cloud.las", b"LASF" + bytes(400), "cloud.las"),
])
def test_what_is_no_point_cloud_is_refused_in_one_sentence(tmp_path, name, content, says):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(RoadExtractionError, match=says):
        read_headers([tmp_path / name])


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_too_little_memory_is_not_reported_as_a_damaged_file(tmp_path, monkeypatch, suffix):
    import laspy

    def no_memory(*_):
        raise MemoryError("Unable to allocate 3.2 GiB")

    path = write_cloud(tmp_path / f"cloud{suffix}", *places())
    monkeypatch.setattr(laspy.LasReader, "read_points", no_memory)
    with pytest.raises(MemoryError):
        list(read_blocks(path))


def with_bounds(path, numbers):
    data = bytearray(open(path, "rb").read())
    data[179:227] = np.array(numbers, float).tobytes()  # max x, min x, max y, min y, max z, min z
    open(path, "wb").write(data)
    return path


@pytest.mark.parametrize("numbers", [[0.0] * 6, [np.nan] * 6, [-1e300, 1e300] * 3, [1e300, -1e300] * 3],
                         ids=["never filled in", "no numbers", "the other way round", "the whole universe"])
def test_bounds_that_cannot_be_are_taken_from_the_points(tmp_path, numbers):
    header = read_header(with_bounds(write_cloud(tmp_path / "cloud.laz", *places()), numbers))
    for found, values in zip(zip(header.minimum, header.maximum), places()):
        np.testing.assert_allclose(found, (values.min(), values.max()), atol=6e-4)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e300])
@pytest.mark.parametrize("at", [131, 155], ids=["scales", "offsets"])
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_header_with_which_no_point_has_a_place_is_refused(tmp_path, at, value):
    path = write_cloud(tmp_path / "cloud.laz", *places())
    data = bytearray(open(path, "rb").read())
    data[at:at + 24] = np.full(3, value).tobytes()
    open(path, "wb").write(data)
    with pytest.raises(RoadExtractionError, match="no coordinates: its header says"):
        read_header(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(RoadExtractionError, match="There is no file .*nowhere.laz"):
        read_headers([tmp_path / "nowhere.laz"])


def test_no_file_and_only_empty_files_are_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="No point cloud was given"):
        read_headers([])
    empty = write_cloud(tmp_path / "empty.las", *(np.empty(0) for _ in range(4)))
    with pytest.raises(RoadExtractionError, match="holds? no points"):
        read_headers([empty])


def test_a_file_given_twice_is_read_once(tmp_path):
    path = write_cloud(tmp_path / "cloud.laz", *places())
    assert len(read_headers([path, path])) == 1


def test_a_file_given_by_two_paths_is_read_once_too(tmp_path):
    path = write_cloud(tmp_path / "tile.laz", *places())
    (tmp_path / "link.laz").symlink_to(path)
    other = write_cloud(tmp_path / "other.laz", *places())
    files = read_headers([path, tmp_path / "link.laz", other, tmp_path / ".." / tmp_path.name / "tile.laz"])
    assert [file.path for file in files] == [path, other]


def test_clouds_of_two_zones_are_refused_with_both_names(tmp_path):
    paths = [write_cloud(tmp_path / f"{zone}.laz", *places(100), crs=f"EPSG:{zone}") for zone in (32632, 32633)]
    with pytest.raises(RoadExtractionError, match="zone 32N.*zone 33N"):
        check_projected(read_headers(paths))


def test_the_cloud_s_own_crs_counts_before_the_one_given(tmp_path):
    files = read_headers([write_cloud(tmp_path / "cloud.laz", *places(100), crs="EPSG:32632")])
    assert "zone 32N" in check_projected(files, given="EPSG:32633")
    bare = read_headers([write_cloud(tmp_path / "bare.laz", *places(100))])
    assert "zone 33N" in check_projected(bare, given="EPSG:32633")
    assert check_projected(bare) == ""


def test_a_crs_nobody_knows_is_refused(tmp_path):
    bare = read_headers([write_cloud(tmp_path / "bare.laz", *places(100))])
    with pytest.raises(RoadExtractionError, match="not understood"):
        check_projected(bare, given="EPSG:999999")


def census(**fields):
    found = ScannerCensus()
    for name, (values, time) in fields.items():
        found.add(name, np.asarray(values), np.asarray(time, float))
    return found


TIME = np.arange(1000.0)


def test_two_scanners_that_measure_at_the_same_time_are_distinguished():
    assert census(point_source_id=(np.arange(1000) % 2 + 1, TIME)).choose() == ("point_source_id", [1, 2])


@pytest.mark.parametrize("wrong", [np.nan, 1e300, -5.0])
def test_scanners_are_told_apart_whatever_some_times_are(wrong):
    time = TIME.copy()
    time[::7] = wrong
    found = ScannerCensus()
    found.take("point_source_id", times_by_value(np.arange(1000) % 2 + 1, time, (0.0, 999.0)))
    assert found.choose() == ("point_source_id", [1, 2])


def test_flight_lines_stay_one_scanner_where_single_times_are_wrong():
    time = TIME.copy()
    time[::7] = 1e300
    found = ScannerCensus()
    found.take("point_source_id", times_by_value(np.arange(1000) // 500, time, (0.0, 999.0)))
    assert found.choose() == (None, [0])
    assert times_by_value(np.arange(3), np.full(3, np.nan)) == {}


def test_flight_lines_one_after_the_other_are_one_scanner():
    assert census(point_source_id=(np.arange(1000) // 500, TIME)).choose() == (None, [0])


def test_frame_numbers_are_not_scanners():
    assert census(point_source_id=(np.arange(1000) // 10, TIME)).choose() == (None, [0])


@pytest.mark.parametrize("number", [lambda strip, scanner: 2 * strip + scanner + 1, lambda strip, scanner: strip + 6 * scanner + 1])
def test_recordings_of_two_scanners_numbered_one_by_one_are_two_scanners(number):
    """Six recordings; at the first the second scanner saw the road for its last third only."""
    scanner, strip = np.arange(1000) % 2, np.arange(1000) * 6 // 1000
    seen = (scanner == 0) | (TIME > 110)
    field, scanners = census(point_source_id=(number(strip, scanner)[seen], TIME[seen])).choose()
    assert (field, len(scanners)) == ("point_source_id", 2)
    np.testing.assert_array_equal(numbers_by_value(scanners, 13)[number(strip, scanner)], scanner)


def test_the_scanner_channel_counts_first():
    mixed = census(point_source_id=(np.arange(1000) % 3, TIME), scanner_channel=(np.arange(1000) % 2, TIME))
    assert mixed.choose()[0] == "scanner_channel"


def test_a_field_that_was_named_is_taken_and_an_unknown_one_refused():
    found = census(point_source_id=(np.arange(1000) // 500, TIME))
    assert found.choose("point_source_id") == ("point_source_id", [0, 1])
    with pytest.raises(RoadExtractionError, match="not known"):
        found.choose("user_data")
