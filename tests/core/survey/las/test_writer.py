"""A new LAS or LAZ file: whole or not at all, whoever else writes it."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.road_points_las import new_laz

laspy = pytest.importorskip("laspy")


def header():
    made = laspy.LasHeader(point_format=6, version="1.4")
    made.scales = [0.001] * 3
    return made


def points(height, count=200):
    record = laspy.ScaleAwarePointRecord.zeros(count, header=header())
    record.x, record.z = np.arange(count) * 0.1, np.full(count, height)
    return record


@pytest.mark.parametrize("suffix", [".laz", ".las"])
@pytest.mark.parametrize("first_to_end", [0, 1])
def test_of_two_runs_that_write_the_same_file_each_ends_well_and_the_last_to_end_is_kept(tmp_path, suffix, first_to_end):
    path = tmp_path / f"road{suffix}"
    runs = [new_laz(path, header()) for _ in range(2)]
    writers = [run.__enter__() for run in runs]
    for _ in range(2):   # in turns
        for height, writer in enumerate(writers):
            writer.write_points(points(height + 1.0))
    for number in (first_to_end, 1 - first_to_end):
        runs[number].__exit__(None, None, None)
        read = laspy.read(path)
        assert len(read.points) == 400
        np.testing.assert_array_equal(read.z, number + 1.0)
    assert list(tmp_path.iterdir()) == [path], "nothing unfinished is left"


def test_a_run_that_fails_leaves_the_last_good_file(tmp_path):
    path = tmp_path / "road.laz"
    with new_laz(path, header()) as writer:
        writer.write_points(points(1.0))
    with pytest.raises(RoadExtractionError, match="cannot be written"), new_laz(path, header()) as writer:
        writer.write_points(points(2.0))
        raise OSError("the disk is full")
    np.testing.assert_array_equal(laspy.read(path).z, 1.0)
    assert list(tmp_path.iterdir()) == [path]
