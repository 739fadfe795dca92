"""Points about a place."""

import os
from pathlib import Path

import numpy as np
import pytest
from drives import write_cloud
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.survey.las.parallel_reader import points_near


@pytest.fixture
def tiles(tmp_path):
    """Points every metre of a square of 100 m, in two files of 50 m."""
    x, y = (grid.ravel().astype(float) for grid in np.meshgrid(np.arange(100), np.arange(100)))
    z = 0.01 * x
    paths = []
    for k, rows in enumerate((x < 50, x >= 50)):
        paths.append(write_cloud(tmp_path / f"tile{k}.laz", x[rows], y[rows], z[rows], np.arange(rows.sum(), dtype=float)))
    return paths


@pytest.mark.parametrize("x, y", [(20.0, 20.0), (50.0, 30.0), (99.0, 99.0)])
def test_all_points_of_the_square_are_found_whichever_files_they_lie_in(tiles, x, y):
    found = points_near(tiles, x, y, 5.0)
    wanted = {(a, b) for a in range(100) for b in range(100) if abs(a - x) <= 5 and abs(b - y) <= 5}
    assert {(round(a), round(b)) for a, b in found[:, :2]} == wanted and len(found) == len(wanted)
    np.testing.assert_allclose(found[:, 2], 0.01 * found[:, 0], atol=0.001)


def test_elsewhere_there_is_none(tiles):
    assert points_near(tiles, 500.0, 500.0, 10.0).shape == (0, 4)


def test_a_file_that_is_gone_is_named(tiles):
    Path(tiles[1]).unlink()
    with pytest.raises(RoadExtractionError, match="tile1.laz"):
        points_near(tiles, 20.0, 20.0, 5.0)


@pytest.fixture
def drive(tmp_path):
    """300,000 points along a road of 3 km, in the order in which they were measured."""
    x = np.linspace(0.0, 3000.0, 300_000)
    return Path(write_cloud(tmp_path / "drive.laz", x, np.zeros_like(x), np.zeros_like(x), x))


def damage_second_half(drive):
    """Spoil the points of the second half, so that who reads them fails; size and time of the file stay."""
    status, data = drive.stat(), bytearray(drive.read_bytes())
    middle = len(data) // 2
    data[middle:-2000] = bytes(len(data) - 2000 - middle)
    drive.write_bytes(data)
    os.utime(drive, ns=(status.st_atime_ns, status.st_mtime_ns))


def test_after_the_first_place_only_what_lies_near_is_read(drive):
    first = points_near([drive], 100.0, 0.0, 30.0)
    damage_second_half(drive)
    np.testing.assert_array_equal(points_near([drive], 100.0, 0.0, 30.0), first)
    assert np.ptp(points_near([drive], 300.0, 0.0, 30.0)[:, 0]) == pytest.approx(60.0, abs=0.05)


def test_a_file_that_was_written_again_is_read_again(drive):
    assert len(points_near([drive], 100.0, 0.0, 30.0))
    x = np.linspace(2000.0, 3000.0, 100_000)
    write_cloud(drive, x, np.zeros_like(x), np.zeros_like(x), x)
    assert not len(points_near([drive], 100.0, 0.0, 30.0)) and len(points_near([drive], 2500.0, 0.0, 30.0))


def test_who_cancels_the_first_place_and_asks_again_gets_all_of_its_points(drive):
    class Impatient(Progress):
        def report(self, fraction):
            if fraction > 0.5:
                raise Cancelled

    with pytest.raises(Cancelled):
        points_near([drive], 2900.0, 0.0, 30.0, Impatient())
    assert np.ptp(points_near([drive], 2900.0, 0.0, 30.0)[:, 0]) == pytest.approx(60.0, abs=0.05)
