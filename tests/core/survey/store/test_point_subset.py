"""Some of the points of a store, told by their rows."""

import numpy as np
import pytest
from lanewright.core.survey.store.records import ROAD_POINT, SURVEY_POINT, to_units
from lanewright.core.survey.store.road_points import PointSubset
from lanewright.core.survey.store.section_store import SectionStore


def survey_store(limit, count=6000):
    rng = np.random.default_rng(8)
    made = np.zeros(count, SURVEY_POINT)
    made["s"], made["d"] = to_units(rng.uniform(0, 40, count)), to_units(rng.uniform(-8, 8, count))
    for name in ("time", "x", "y", "z", "intensity"):
        made[name] = rng.integers(0, 60_000, count)
    store = SectionStore(SURVEY_POINT, memory_limit=limit)
    for part in np.array_split(made, 5):
        store.append(0, part)
    return store


def road_of(store):
    """The points within 3 m of the reference line; none of section 2."""
    road = PointSubset(store, ROAD_POINT, ("half_width", "covered"), dict(corrected=np.nan, cluster=0, spacing=0))
    for number in store.sections(0):
        records = store.section(0, number)
        rows = np.flatnonzero((np.abs(records["d"]) < to_units(3.0)) & (number != 2))
        road.put(0, number, rows, half_width=np.full(len(rows), 3000 + number, np.uint16), covered=(rows % 2).astype(np.uint8))
    return road


@pytest.mark.parametrize("limit", [0, 60_000, 10**9])
def test_a_subset_has_the_points_of_the_store_and_columns_of_its_own(limit):
    store = survey_store(limit)
    road = road_of(store)
    assert road.sections(0) == [0, 1, 3, 4, 5, 6, 7] and road.roads() == [0] and not len(road.section(0, 2))
    total = 0
    for number in road.sections(0):
        whole, found = store.section(0, number), road.section(0, number)
        rows = np.flatnonzero(np.abs(whole["d"]) < to_units(3.0))
        for name in SURVEY_POINT.names:
            np.testing.assert_array_equal(found[name], whole[name][rows])
        assert (found["half_width"] == 3000 + number).all() and (found["covered"] == rows % 2).all()
        assert np.isnan(found["corrected"]).all() and (found["cluster"] == 0).all()
        total += len(found)
    assert road.count == total == len(road.window(0, 0.0, 40.0))


def test_a_window_of_a_subset_is_a_range_of_stations():
    road = road_of(survey_store(0))
    window = road.window(0, 3.3, 21.7)
    assert window.s.min() >= 3.3 and window.s.max() < 21.7 and (np.diff(window.records["s"]) >= 0).all()


def test_a_replaced_column_does_not_change_the_other_columns_of_a_subset():
    road = road_of(survey_store(0))
    bright = road.with_column("corrected")
    for number in road.sections(0):
        bright.put(0, number, road.section(0, number)["intensity"].astype(np.float32) / 2)
    for number in road.sections(0):
        found = bright.section(0, number)
        np.testing.assert_array_equal(found["corrected"], found["intensity"] / 2)
        np.testing.assert_array_equal(found["x"], road.section(0, number)["x"])


@pytest.mark.parametrize("limit", [0, 10**9])
def test_points_with_a_replaced_column_are_the_same_after_their_cache_is_cleared(limit):
    store = survey_store(limit)
    bright = store.with_column("intensity")
    for number in store.sections(0):
        bright.put(0, number, store.section(0, number)["intensity"] // 2)
    before = np.asarray(bright.section(0, 4))
    bright.clear_cache()
    np.testing.assert_array_equal(np.asarray(bright.section(0, 4)), before)
    for name in ("intensity", "x"):
        np.testing.assert_array_equal(bright.column(0, 4, name, np.array([5, 2])), before[name][[5, 2]])
    if limit == 0:
        assert store._cache  # the section was read from the file again
        bright.clear_cache()
        assert not store._cache
    bright.close()
    assert not store.roads()


@pytest.mark.parametrize("limit", [0, 10**9])
@pytest.mark.parametrize("rows", [[3], [200, 201, 204], range(-9, 0), range(90, 5, -7), []])
def test_few_rows_of_a_section_are_those_of_the_whole_whatever_was_read_of_it_before(limit, rows):
    road = road_of(survey_store(limit))
    bright = road.with_column("corrected")
    for number in road.sections(0):
        bright.put(0, number, road.section(0, number)["intensity"].astype(np.float32) / 2)
    whole = np.asarray(bright.section(0, 4))
    road.clear_cache()
    rows = np.array(rows, np.intp)
    for _ in range(3):
        few = bright.section(0, 4).take(rows)
        for name in ROAD_POINT.names:
            np.testing.assert_array_equal(few[name], whole[name][rows])


def test_a_window_is_the_same_where_it_cuts_a_section_and_where_it_ends_with_one():
    road = road_of(survey_store(0))
    everything = np.asarray(road.window(0, 0.0, 40.0).records)
    for start, end in ((4.9, 5.1), (5.0, 10.0), (14.999, 20.0), (15.0, 20.0001), (16.0, 16.2), (-3.0, 50.0)):
        inside = (everything["s"] * 1e-4 >= start) & (everything["s"] * 1e-4 < end)
        road.clear_cache()
        found = np.asarray(road.window(0, start, end).records)
        assert len(found) and found.tobytes() == everything[inside].tobytes()


def test_a_subset_refuses_further_points_and_closes_its_store():
    store = survey_store(0)
    road = road_of(store)
    with pytest.raises(TypeError, match="points cannot be added"):
        road.append(0, np.zeros(1, ROAD_POINT))
    road.close()
    assert road.sections(0) == store.sections(0) == []
