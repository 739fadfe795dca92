"""Cells that belong together are those that a chain of near places joins, whatever the distance."""

import numpy as np
import pytest
from lanewright.core.markings.road_grid import components
from scipy.sparse.csgraph import connected_components
from scipy.spatial.distance import cdist

SIZE = (0.016, 0.08)


def strewn(count, rows, columns, seed=0):
    """Some cells of a grid that begins below zero, sorted, and a place in each."""
    random = np.random.default_rng(seed)
    chosen = np.sort(random.choice(rows * columns, count, replace=False))
    cells = np.stack(np.divmod(chosen, columns), axis=1) - [40, 7]
    return cells, (cells + random.uniform(0, 1, cells.shape)) * SIZE


@pytest.mark.parametrize("distance", [0.03, 0.1, 0.2, 0.7])
@pytest.mark.parametrize("count", [1, 60, 300, 900])
def test_components_are_those_of_all_pairs(count, distance):
    cells, places = strewn(count, 60, 30)
    expected = connected_components(cdist(places, places) <= distance, directed=False)[1]
    np.testing.assert_array_equal(components(cells, places, SIZE, distance), expected)


def test_no_cells_have_no_components():
    assert len(components(np.empty((0, 2), int), np.empty((0, 2)), SIZE, 0.2)) == 0
