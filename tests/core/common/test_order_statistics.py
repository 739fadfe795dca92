"""Order statistics of many points by counting."""

import numpy as np
import pytest
from lanewright.core.common.arrays import bucket_argsort, quantiles, ranked

RNG = np.random.default_rng(7)
COLUMNS = {
    "offsets": RNG.integers(-150_000, 150_000, 10_001).astype(np.int32),
    "few different values": RNG.integers(0, 5, 1000).astype(np.int32),
    "the widest range there is": np.array([-2**31, 2**31 - 1, 0, -1, 5], np.int32),
    "intensities": RNG.lognormal(7, 1, 20_000).astype(np.float32),
    "brightness on both sides of 0": RNG.normal(0, 30, 5000).astype(np.float32),
    "one value": np.full(9, 3.5, np.float32),
    "a single point": np.array([4], np.int32),
}


@pytest.mark.parametrize("values", COLUMNS.values(), ids=COLUMNS)
def test_a_rank_is_that_of_the_sorted_column(values):
    ranks = np.unique(np.linspace(0, len(values) - 1, 7).astype(int))[::-1]
    np.testing.assert_array_equal(ranked(values, ranks), np.sort(values)[ranks])


@pytest.mark.parametrize("values", COLUMNS.values(), ids=COLUMNS)
def test_quantiles_are_those_of_numpy(values):
    shares = [0.01, 0.25, 0.5, 0.99, 1.0, 0.0]
    np.testing.assert_allclose(quantiles(values, shares), np.quantile(values.astype(float), shares), rtol=1e-12)


@pytest.mark.parametrize("count", [1, 255, 256, 70_000])
def test_rows_are_dealt_to_their_cells_and_lie_there_in_the_order_they_came_in(count):
    cell, own = RNG.integers(0, count, 5000), RNG.random(5000) < 0.7
    rows, ends = bucket_argsort(cell, count, own)
    mine = np.flatnonzero(own)
    np.testing.assert_array_equal(rows, mine[np.argsort(cell[mine], kind="stable")])
    np.testing.assert_array_equal(ends, np.cumsum(np.bincount(cell[mine], minlength=count)))
    assert len(bucket_argsort(cell, count)[0]) == 5000
