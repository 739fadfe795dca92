"""A file that holds the points of another one of the survey is left out."""

import numpy as np
import pytest
from drives import write_cloud
from lanewright.core.survey.las.copies import without_copies
from lanewright.core.survey.las.reader import read_headers


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
