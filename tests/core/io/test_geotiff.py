"""A GeoTIFF is whole or not there, whoever else writes it."""

import os
import time

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.geotiff import IntensityImage, new_geotiff
from lanewright.core.io.weights import IO

SIDE = 600   # px, more than one tile
PLACE = (500_000.0, 0.04, 0.0, 5_500_000.0, 0.0, -0.04)


def writer(path):
    return new_geotiff(path, SIDE, SIDE, PLACE, "")


def pixels(path):
    return IntensityImage.open(path).read_pixels(0, 0, SIDE, SIDE)


@pytest.mark.parametrize("first_to_end", [0, 1])
def test_two_runs_that_write_one_file_at_once_both_end_well_and_the_last_to_end_is_kept_whole(tmp_path, first_to_end):
    path = tmp_path / "i.tif"
    runs = [writer(path), writer(path)]
    images = [run.__enter__() for run in runs]
    half = SIDE // 2
    for rows in (0, half):   # in turns
        for value, image in enumerate(images):
            image.write(0, rows, np.full((half, SIDE), 10.0 + value, np.float32), whole=True)
    for number in (first_to_end, 1 - first_to_end):
        runs[number].__exit__(None, None, None)
        np.testing.assert_array_equal(pixels(path), 10.0 + number)
    assert list(tmp_path.iterdir()) == [path], "nothing unfinished is left"


def test_a_run_that_fails_leaves_the_file_of_another_that_is_at_work(tmp_path):
    path = tmp_path / "i.tif"
    with writer(path) as image:
        with pytest.raises(RoadExtractionError), writer(path):
            raise RuntimeError("the disk is full")
        image.write(0, 0, np.full((SIDE, SIDE), 7.0, np.float32))
    np.testing.assert_array_equal(pixels(path), 7.0)
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_killed_run_left_is_removed_a_day_later_and_what_others_write_stays(tmp_path):
    path, other = tmp_path / "street [1].tif", tmp_path / "street 1.tif"
    left = []
    for target, age in ((path, IO.abandoned_time + 60), (path, IO.abandoned_time - 60), (other, IO.abandoned_time + 60)):
        with writer(target):
            left.append(next(file for file in tmp_path.iterdir() if file.name not in {path.name, other.name} and file not in left))
        left[-1].write_bytes(b"half an image")
        os.utime(left[-1], (time.time() - age,) * 2)
    with writer(path):
        pass
    assert [file.exists() for file in left] == [False, True, True]
    assert all(file.name.startswith(".") for file in left), "no list of files shows them"
