"""Places by squares of the ground tell the same as a look at all places."""

import numpy as np
import pytest
from lanewright.core.execution.phase import read_plain, write_plain
from lanewright.core.survey.frame.placement import PlaceIndex

SIDE = 2.5


def road_of_spots(count, length, seed=3):
    """(N, 2) m, spots strewn over a road that runs north east, far from the origin."""
    random = np.random.default_rng(seed)
    along, across = random.uniform(0, length, count), random.normal(0, 4, count)
    return np.c_[along - across, along + across] * np.sqrt(0.5) - [3000.0, 150.0]


@pytest.mark.parametrize("count", [0, 1, 3, 2000])
def test_the_spots_in_a_box_are_those_that_a_look_at_all_spots_finds(count):
    places = road_of_spots(count, 200.0)
    index = PlaceIndex(places, SIDE)
    random = np.random.default_rng(1)
    for _ in range(50):
        low = road_of_spots(1, 260.0, random.integers(1000))[0] - 5.0
        high = low + random.uniform(0.0, 40.0, 2)
        expected = np.flatnonzero(((places >= low) & (places <= high)).all(axis=1))
        np.testing.assert_array_equal(index.within(low, high), expected)


def test_a_window_is_two_squares_long_and_broad_and_overlaps_its_neighbours_by_half():
    places = road_of_spots(3000, 100.0)
    square = np.floor(places / SIDE).astype(int)
    windows = PlaceIndex(places, SIDE).windows(20)
    found = {tuple(np.sort(rows)) for rows in windows}
    expected = set()
    for corner in {tuple(one) for one in np.concatenate([square - [a, b] for a in (0, 1) for b in (0, 1)])}:
        rows = np.flatnonzero(((square >= corner) & (square <= np.add(corner, 1))).all(axis=1))
        if len(rows) >= 20:
            expected.add(tuple(rows))
    assert found == expected and len(windows) == len(found)


class CountedRows(np.ndarray):
    """Places that count how many of them are looked at."""

    looked_at = 0

    def __getitem__(self, rows):
        if isinstance(rows, np.ndarray):
            CountedRows.looked_at += len(rows)
        return np.asarray(super().__getitem__(rows))


def test_about_a_crossing_as_many_spots_are_looked_at_on_a_road_of_ten_kilometres_as_on_one_of_a_kilometre():
    seen = []
    for length in (1000.0, 10_000.0):
        index = PlaceIndex(road_of_spots(int(5 * length), length), SIDE)
        index.places = index.places.view(CountedRows)
        CountedRows.looked_at = 0
        middle = np.array([500.0, 500.0]) * np.sqrt(0.5) - [3000.0, 150.0]
        assert len(index.within(middle - 5.0, middle + 5.0)) > 10
        seen.append(CountedRows.looked_at)
    assert 0 < seen[1] < 1.5 * seen[0]


def test_another_process_gets_the_same_places(tmp_path):
    index = PlaceIndex(road_of_spots(100, 30.0), SIDE)
    write_plain(tmp_path / "index", index)
    np.testing.assert_array_equal(read_plain(tmp_path / "index").within(np.full(2, -4000.0), np.full(2, 4000.0)), np.arange(100))
