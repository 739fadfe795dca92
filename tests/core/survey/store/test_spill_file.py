"""Columns packed into few bytes, and put into a temporary file."""

import numpy as np
import pytest
from lanewright.core.survey.store.spill_file import SpillFile, pack
from lanewright.core.survey.weights import STORE

RNG = np.random.default_rng(3)
COUNT = 2 * STORE.packing_chunk + 17
COLUMNS = {
    "stations of a section": RNG.integers(5_000_000, 5_050_000, COUNT).astype(np.int32),
    "offsets of either side": RNG.integers(-300_000, 300_000, COUNT).astype(np.int32),
    "all of 32 bits": np.r_[np.int32(-2**31), np.int32(2**31 - 1), np.arange(5, dtype=np.int32)],
    "all of 64 bits": np.array([-2**63, 2**63 - 1, 0]),
    "pass numbers": RNG.integers(0, 3, COUNT).astype(np.uint16),
    "intensity": RNG.integers(0, 65536, COUNT).astype(np.uint16),
    "bytes": RNG.integers(0, 256, COUNT).astype(np.uint8),
    "seconds since 1980": 1.3e9 + RNG.uniform(0, 30, COUNT),
    "seconds of the week": 3e5 + RNG.uniform(0, 30, COUNT),
    "seconds about 0": RNG.uniform(-1, 1, COUNT),
    "float32": RNG.uniform(10_000, 40_000, COUNT).astype(np.float32),
    "not a number": np.where(RNG.random(COUNT) < 0.5, np.nan, 7.0).astype(np.float32),
    "zeros of both signs": np.array([0.0, -0.0, 0.0]),
    "nothing but NaN": np.full(COUNT, np.nan, np.float32),
    "one value": np.array([-3], np.int32),
}


@pytest.mark.parametrize("name", COLUMNS)
def test_a_column_comes_out_of_the_file_as_it_went_in_to_the_bit(name):
    column = COLUMNS[name]
    file = SpillFile()
    stored = file.put(column)
    file.put(np.arange(9.0))
    for found in (file.get(stored), file.get(stored, np.empty_like(column))):
        assert found.dtype == column.dtype and found.tobytes() == column.tobytes()
    for rows in (np.arange(1, len(column), 3), np.flatnonzero(np.arange(len(column)) % 5)):
        assert file.get(stored, rows=rows).tobytes() == column[rows].tobytes()


@pytest.mark.parametrize("name, nbytes", [
    ("stations of a section", 2), ("offsets of either side", 3), ("pass numbers", 1), ("seconds since 1980", 4), ("seconds of the week", 5),
    ("all of 32 bits", 4), ("all of 64 bits", 8), ("nothing but NaN", 0)])
def test_a_value_takes_the_bytes_it_needs(name, nbytes):
    packing, data = pack(COLUMNS[name])
    assert packing.nbytes == len(data) == nbytes * len(COLUMNS[name])


def test_columns_take_the_places_of_those_given_back():
    file = SpillFile()
    columns = [RNG.integers(0, 2**32, 100, dtype=np.uint32) for _ in range(6)]
    stored = [file.put(column) for column in columns]
    end = file.end
    for k in (1, 3, 2):  # they lie side by side
        file.release(stored[k])
    long = RNG.integers(0, 2**32, 300, dtype=np.uint32)
    place = file.put(long)
    assert file.end == end
    np.testing.assert_array_equal(file.get(place), long)
    for k in (0, 4, 5):
        np.testing.assert_array_equal(file.get(stored[k]), columns[k])
    assert file.put(columns[0]).place == end
