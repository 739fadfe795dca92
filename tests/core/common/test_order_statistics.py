"""Points dealt to cells."""

import numpy as np
import pytest
from lanewright.core.common.arrays import bucket_argsort

RNG = np.random.default_rng(7)


@pytest.mark.parametrize("count", [1, 255, 256, 70_000])
def test_rows_are_dealt_to_their_cells_and_lie_there_in_the_order_they_came_in(count):
    cell, own = RNG.integers(0, count, 5000), RNG.random(5000) < 0.7
    rows, ends = bucket_argsort(cell, count, own)
    mine = np.flatnonzero(own)
    np.testing.assert_array_equal(rows, mine[np.argsort(cell[mine], kind="stable")])
    np.testing.assert_array_equal(ends, np.cumsum(np.bincount(cell[mine], minlength=count)))
    assert len(bucket_argsort(cell, count)[0]) == 5000
