"""A file that holds the points of another one of the survey is left out, and points that files share count once."""

import numpy as np
import pytest
from drives import write_cloud
from lanewright.core.survey.las.reader import read_headers
from lanewright.core.survey.las.samples import distinct_rows, may_overlap, without_copies


def cloud(path, order=slice(None), moved=0.0, later=0.0, **other):
    """A cloud of 500 places with times."""
    rng = np.random.default_rng(4)
    x, y, z = rng.uniform(0.0, 10.0, (3, 500))
    middle = slice(200, 300)   # where a cloud may differ and keep its bounds
    x[middle] = np.clip(x[middle] + moved, 0.01, 9.9)
    time = np.linspace(1000.0, 1010.0, 500) + later
    return write_cloud(path, *(v[order] for v in (x + 600_000.0, y + 2_700_000.0, z, time)), **other)


def kept(*paths):
    """Which of the paths are kept, and what is said of the others."""
    said = []
    files = without_copies(read_headers(paths), said.append)
    return [paths.index(file.path) for file in files], said


@pytest.mark.parametrize("copied", [{}, {"order": slice(None, None, -1)}, {"point_format": 1, "version": "1.2"}],
                         ids=["as it is", "in another order", "in another format"])
def test_a_copy_is_left_out_and_named(tmp_path, copied):
    first, other, copy = cloud(tmp_path / "a.laz"), cloud(tmp_path / "b.laz", moved=1.0), cloud(tmp_path / "copy.las", **copied)
    numbers, said = kept(first, other, copy)
    assert numbers == [0, 1] and len(said) == 1 and "copy.las holds the same points as" in said[0] and "a.laz" in said[0]


@pytest.mark.parametrize("differing", [{"moved": 0.001}, {"later": 60.0}, {"intensity": 900}], ids=["place", "time", "intensity"])
def test_points_that_differ_in_anything_are_others(tmp_path, differing):
    assert kept(cloud(tmp_path / "a.laz"), cloud(tmp_path / "b.laz", **differing)) == ([0, 1], [])


def test_of_points_that_come_again_the_first_are_taken():
    time = np.array([5.0, 3.0, 5.0, 5.0, 3.0])
    place = np.array([[1, 2, 3], [4, 5, 6], [1, 2, 3], [1, 2, 4], [4, 5, 6]], np.int32)
    assert distinct_rows(time, place).tolist() == [0, 1, 3]
    assert distinct_rows(time[:0], place[:0]).tolist() == []


@pytest.mark.parametrize(("east", "share"), [(0.0, True), (9.0, True), (12.0, False)])
def test_files_may_overlap_where_their_bounds_do(tmp_path, east, share):
    a = write_cloud(tmp_path / "a.laz", *np.array([[0.0, 10.0], [0.0, 10.0], [0.0, 1.0], [1.0, 2.0]]))
    b = write_cloud(tmp_path / "b.laz", *np.array([[east, east + 10.0], [0.0, 10.0], [0.0, 1.0], [1.0, 2.0]]))
    assert may_overlap(read_headers([a, b])) is share
    assert not may_overlap(read_headers([a]))
