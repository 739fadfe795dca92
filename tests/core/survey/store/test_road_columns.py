"""Columns of whole roads: the same points as section by section, and none of them stays in memory."""

import gc
import tracemalloc

import numpy as np
import pytest
from lanewright.core.survey.store.columns import Columns
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.road_points import columns_of_roads
from lanewright.core.survey.store.section_store import SectionStore

PER_METRE = 400
LIMIT = 200_000   # bytes, a few sections of the stores below


def road_of(length):
    """A store of a road so many metres long, whose points are in a file."""
    rng = np.random.default_rng(3)
    store = SectionStore(SURVEY_POINT, section_length=5.0)
    for first in range(0, length, 50):
        made = np.zeros(50 * PER_METRE, SURVEY_POINT)
        made["s"], made["x"] = to_units(rng.uniform(first, first + 50, len(made))), rng.integers(0, 2_000_000, len(made))
        made["time"], made["intensity"] = rng.uniform(0, 1e5, len(made)), rng.integers(0, 65536, len(made))
        store.append(0, made)
    return store


@pytest.fixture(scope="module")
def road():
    return road_of(200)


def test_the_columns_of_a_road_are_those_of_its_sections(road):
    whole = columns_of_roads(road, [0])
    joined = Columns.concatenate([road.section(0, number) for number in road.sections(0)], SURVEY_POINT)
    assert len(whole) == len(joined) == road.count
    for name in ("s", "x", "time", "intensity"):
        np.testing.assert_array_equal(whole[name], joined[name])


@pytest.mark.parametrize("count", [0, 7, 60_000])
def test_rows_of_a_road_come_in_the_order_that_is_asked_for(road, count):
    whole, rows = columns_of_roads(road, [0]), np.random.default_rng(5).integers(0, road.count, count)
    some = whole.take(rows)
    np.testing.assert_array_equal(some["x"], whole["x"][rows])
    np.testing.assert_array_equal(whole[1000:1400]["time"], whole["time"][1000:1400])


def test_several_roads_follow_each_other_and_no_road_has_no_points(road):
    both = SectionStore(SURVEY_POINT, section_length=5.0)
    for number in (0, 2):
        both.append(number, np.asarray(road.section(0, 3 + number)))
    whole = columns_of_roads(both, both.roads())
    np.testing.assert_array_equal(whole["x"], np.r_[road.section(0, 3)["x"], road.section(0, 5)["x"]])
    assert not len(columns_of_roads(both, [])) and not len(columns_of_roads(both, [1])["x"])


def held_after(length, work):
    """Bytes in memory after `work` with the store of a road so many metres long that were not there before the store."""
    tracemalloc.start()
    try:
        store = road_of(length)
        result = work(store)
        gc.collect()
        return tracemalloc.get_traced_memory()[0], store, result
    finally:
        tracemalloc.stop()


def read_all(store):
    """Every column of every section, and two columns of the whole road."""
    whole = columns_of_roads(store, [0])
    for number in store.sections(0):
        for name in SURVEY_POINT.names:
            store.section(0, number)[name]
    assert whole["x"].max() > whole["s"].min()
    return whole


def test_a_store_that_was_read_holds_no_more_memory_for_a_longer_road():
    held_after(200, read_all)   # what a process makes once, such as threads and their work space
    short, long = (held_after(length, read_all)[0] for length in (200, 1000))
    points = (1000 - 200) * PER_METRE * SURVEY_POINT.itemsize
    # where the points lie in the file grows with the road: sections and their columns, not points
    assert long - short < 0.05 * points and long < 4 * LIMIT + 0.05 * points


def test_rows_that_were_read_can_be_asked_for_anew_without_what_was_read(road):
    rows = np.arange(0, road.count, 3)
    some = columns_of_roads(road, [0]).take(rows)
    expected = some["x"].copy()
    again = some.unread()
    assert some._arrays and not again._arrays
    np.testing.assert_array_equal(again["x"], expected)
    # what was set stays where it was set
    changed = again.with_columns(x=expected + 1)
    np.testing.assert_array_equal(changed.unread()["x"], expected + 1)
