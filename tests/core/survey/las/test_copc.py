"""COPC: the octree is read as the points in it, whatever its hierarchy claims."""

import gc
import struct

import laspy
import numpy as np
import pytest
from copc_files import ENTRY, write_copc
from drives import ahead, bend, chain, contents, drive, surveyed_points, write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.las.parallel_reader import ParallelCloudReader
from lanewright.core.survey.las.reader import read_header
from lanewright.core.survey.open_survey import open_survey

CRS = "EPSG:32632"


@pytest.fixture(scope="module")
def street(tmp_path_factory):
    """(trajectory, LAZ file, COPC file) of a bend with curbs."""
    folder = tmp_path_factory.mktemp("Straße")
    trajectory = drive(chain(ahead(60), bend(60, 40)))
    cloud = write_cloud(folder / "street.laz", *surveyed_points(trajectory), crs=CRS)
    return trajectory, cloud, write_copc(cloud, folder / "street.copc.laz")


def test_what_is_read_here_is_copc(street):
    """laspy's own reader walks the hierarchy and finds every point, and the octree is one of many chunks."""
    with laspy.CopcReader.open(street[2]) as reader:
        assert len(reader.query()) == laspy.open(street[1]).header.point_count
        assert len(reader.query(level=range(1))) <= 2000 < len(reader.query(level=range(3)))


def test_its_header_says_what_that_of_the_laz_says(street):
    laz, copc = (read_header(path) for path in street[1:])
    for name in ("version", "point_format", "count", "minimum", "maximum", "crs", "has_time"):
        assert getattr(copc, name) == getattr(laz, name), name


def test_when_some_of_its_points_were_read_no_hierarchy_of_it_is_held_any_more(street):
    def held():
        return {id(header) for header in gc.get_objects() if isinstance(header, laspy.LasHeader) and header.evlrs}

    header, before = read_header(street[2]), held()
    list(ParallelCloudReader().times(header))
    assert held() <= before


def test_the_survey_is_that_of_the_laz(street):
    trajectory, laz, copc = street
    np.testing.assert_array_equal(contents(open_survey([copc], trajectory)), contents(open_survey([laz], trajectory)))


def test_its_times_are_found_out_as_those_of_the_laz(street, tmp_path):
    trajectory, laz, _ = street
    start = 318_204_000.0
    cloud = laspy.read(laz)
    cloud.gps_time = np.asarray(cloud.gps_time) - 1000.0 + start
    cloud.write(str(tmp_path / "adjusted.laz"))
    copc = write_copc(tmp_path / "adjusted.laz", tmp_path / "adjusted.copc.laz")
    survey = open_survey([copc], trajectory.shifted((start + 1e9) % 604800 - 1000.0))
    assert survey.counts["kept"] == len(cloud.points)


def lying(path, folder, change):
    """The file with its hierarchy entries changed: (N, 32) bytes in, the same out."""
    data = bytearray(open(path, "rb").read())
    start = struct.unpack_from("<Q", data, 235)[0] + 60
    entries = [list(entry) for entry in struct.iter_unpack("<4iQii", data[start:])]
    change(entries, start)
    data[start:] = b"".join(struct.pack("<4iQii", *entry) for entry in entries)
    lied = folder / "lying.copc.laz"
    lied.write_bytes(data)
    return lied


def beyond_the_file(entries, start):
    for entry in entries:
        entry[4] += 2**40


def a_page_that_is_itself(entries, start):
    """A reader that follows pages would follow this one for ever."""
    entries[0][4:] = start, ENTRY * len(entries), -1


def absurd_counts(entries, start):
    for entry in entries:
        entry[5:] = 2**31 - 1, 2**31 - 1


def all_one_chunk(entries, start):
    for entry in entries:
        entry[4:] = entries[0][4:]


def nonsense_keys(entries, start):
    for entry in entries:
        entry[:4] = -1, 2**31 - 1, -2**31, 7


@pytest.mark.parametrize("lie", [beyond_the_file, a_page_that_is_itself, absurd_counts, all_one_chunk, nonsense_keys])
def test_a_hierarchy_that_lies_does_no_harm(street, tmp_path, lie):
    """The chunks of the file count, not what the hierarchy says of them."""
    trajectory, laz, copc = street
    np.testing.assert_array_equal(contents(open_survey([lying(copc, tmp_path, lie)], trajectory)), contents(open_survey([laz], trajectory)))


@pytest.mark.parametrize("place, kind, value", [(375 + 54 + 40, "<Q", 2**60), (375 + 54 + 48, "<Q", 2**60), (375 + 54, "<d", float("nan"))])
def test_an_info_record_that_lies_does_no_harm(street, tmp_path, place, kind, value):
    trajectory, laz, copc = street
    data = bytearray(open(copc, "rb").read())
    struct.pack_into(kind, data, place, value)
    (tmp_path / "lying.copc.laz").write_bytes(data)
    np.testing.assert_array_equal(contents(open_survey([tmp_path / "lying.copc.laz"], trajectory)), contents(open_survey([laz], trajectory)))


@pytest.mark.parametrize("share", [0.2, 0.6, 0.99])
def test_a_copc_file_cut_off_is_refused_in_one_sentence(street, tmp_path, share):
    data = open(street[2], "rb").read()
    before_hierarchy = struct.unpack_from("<Q", data, 235)[0]   # without it every point can still be read
    (tmp_path / "cut.copc.laz").write_bytes(data[:int(share * before_hierarchy)])
    with pytest.raises(RoadExtractionError, match="cut.copc.laz is damaged or cut off"):
        open_survey([tmp_path / "cut.copc.laz"], street[0])
