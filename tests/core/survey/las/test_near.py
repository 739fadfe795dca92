"""Points about a place."""

from pathlib import Path

import numpy as np
import pytest
from drives import write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.las.samples import points_near


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
