"""Point cloud files read block by block, by any number of threads."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from copc_files import write_copc
from drives import ahead, bend, chain, contents, drive, surveyed_points, write_cloud
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.survey import blocks as reading
from lanewright.core.survey.las.parallel_reader import ParallelCloudReader
from lanewright.core.survey.las.reader import read_blocks, read_header
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.survey import SurveySettings

CRS = "EPSG:32632"


@pytest.fixture(scope="module")
def street(tmp_path_factory):
    """(trajectory, LAS file, the same points as LAZ) of a bend; some points lie far beside the road."""
    folder = tmp_path_factory.mktemp("street")
    trajectory = drive(chain(ahead(80), bend(60, 60), ahead(60)))
    x, y, z, time = surveyed_points(trajectory)
    x, y, z, time = (np.r_[values, values[::9]] for values in (x, y, z, time))
    x[-len(x) // 20:] += 300.0  # beside the road
    return trajectory, *(write_cloud(folder / f"street.{kind}", x, y, z, time, crs=CRS) for kind in ("las", "laz"))


@pytest.fixture(scope="module")
def thousands(tmp_path_factory):
    """{suffix: header of a file of 120,000 points}."""
    folder, count = tmp_path_factory.mktemp("thousands"), 120_000
    x, y, z = np.random.default_rng(3).uniform(0, 60, (3, count))
    paths = {suffix: write_cloud(folder / f"many.{suffix}", x, y, z, np.arange(count) * 1e-4, crs=CRS) for suffix in ("las", "laz")}
    paths["copc.laz"] = write_copc(paths["las"], folder / "many.copc.laz")
    return {suffix: read_header(path) for suffix, path in paths.items()}


@pytest.mark.parametrize("suffix", ["las", "laz", "copc.laz"])
@pytest.mark.parametrize("size", [1000, 70_000, 10**6])
def test_blocks_asked_for_in_any_order_by_several_threads_are_the_file(thousands, suffix, size):
    file = thousands[suffix]
    whole = np.concatenate([block.array for block in read_blocks(file.path, 33_333)])
    readers = ParallelCloudReader()
    with ThreadPoolExecutor(3) as pool:
        ranges = list(readers.ranges([file, file], size))
        order = np.random.default_rng(size).permutation(len(ranges))
        found = dict(zip(order.tolist(), pool.map(lambda k: [points.array.copy() for points in readers.points(file, *ranges[k][1:], size)], order)))
    read = np.concatenate([part for k in range(len(ranges)) for part in found[k]])
    for name in ("X", "Y", "Z", "gps_time"):
        np.testing.assert_array_equal(read[name], np.tile(whole[name], 2))


@pytest.mark.parametrize("suffix, size, lengths", [
    ("las", 60_000, [60_000, 60_000]), ("laz", 60_000, [50_000, 50_000, 20_000]), ("laz", 1000, [1000] * 120)])
def test_blocks_are_whole_chunks_where_these_are_not_far_larger(thousands, suffix, size, lengths):
    readers, file = ParallelCloudReader(), thousands[suffix]
    assert [len(points) for part in readers.ranges([file], size) for points in readers.points(file, *part[1:], size)] == lengths


@pytest.mark.parametrize("suffix", ["las", "laz", "copc.laz"])
def test_the_times_looked_at_span_the_file(thousands, suffix):
    times = np.concatenate(list(ParallelCloudReader(("gps_time",)).times(thousands[suffix])))
    # the points of an octree lie in no order of time
    assert times.min() == 0.0 if suffix != "copc.laz" else 0.0 <= times.min() < 0.1
    assert times.max() == pytest.approx(12.0, abs=1e-3 if suffix != "copc.laz" else 0.1)


@pytest.mark.parametrize("threads, block", [(1, 5000), (2, 700), (4, 5000)])
def test_neither_threads_nor_blocks_nor_compression_change_a_point(street, monkeypatch, threads, block):
    trajectory, las, laz = street
    monkeypatch.setattr(reading.os, "cpu_count", lambda: threads)
    one, other = open_survey([las], trajectory, SurveySettings(block=block)), open_survey([laz], trajectory)
    np.testing.assert_array_equal(contents(one), contents(other))
    assert (one.sensor_height, one.scanner_field, one.scanners) == (other.sensor_height, other.scanner_field, other.scanners)


def test_a_file_that_ends_early_is_named_by_whichever_thread_meets_its_end(street, tmp_path):
    trajectory, las, _ = street
    data = open(las, "rb").read()
    cut = tmp_path / "cut.las"
    cut.write_bytes(data[:int(0.6 * len(data))])
    with pytest.raises(RoadExtractionError, match="cut.las is (cut off|damaged)"):
        open_survey([cut], trajectory, SurveySettings(block=1000))


def test_a_cancel_ends_the_reading_at_once(street):
    trajectory, las, _ = street

    class Impatient(Progress):
        asked = 0

        def report(self, fraction):
            self.asked += 1
            if self.asked > 3:
                raise Cancelled

    impatient = Impatient()
    with pytest.raises(Cancelled):
        open_survey([las], trajectory, SurveySettings(block=700), impatient)
    assert impatient.asked == 4
