"""Points kept by section of road."""

import gc
import threading
import warnings
import weakref

import numpy as np
import pytest
from lanewright.core.survey.store.columns import Columns
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.section_store import SectionStore, canonical_order, opened_store


def records(count=4000, seed=4, length=200.0):
    rng = np.random.default_rng(seed)
    made = np.zeros(count, SURVEY_POINT)
    made["s"], made["d"] = to_units(rng.uniform(-10, length, count)), to_units(rng.uniform(-8, 8, count))
    made["time"] = rng.integers(0, 500, count)  # many points share a time
    made["x"], made["y"], made["z"] = (rng.integers(0, 2_000_000, count) for _ in range(3))
    made["intensity"] = rng.integers(0, 65536, count)
    return made


def filled(parts, **settings):
    store = SectionStore(SURVEY_POINT, **settings)
    for part in parts:
        store.append(0, part)
    return store


def test_what_went_in_comes_out_sorted_along_the_road():
    made = records()
    store = filled(np.array_split(made, 7), section_length=20.0)
    read = np.asarray(Columns.concatenate([store.section(0, number) for number in store.sections(0)], SURVEY_POINT))
    assert store.count == len(read) == len(made)
    assert (np.diff(read["s"]) >= 0).all()
    np.testing.assert_array_equal(np.sort(read, order=["time", "x"]), np.sort(made, order=["time", "x"]))
    for number in store.sections(0):
        section = store.section(0, number)
        assert ((section["s"] >= to_units(20.0 * number)) & (section["s"] < to_units(20.0 * (number + 1)))).all()


@pytest.mark.parametrize("more", [False, True])
def test_points_that_come_to_sections_in_order_are_put_in_order_with_them(more):
    """Sections that are put in order already; more points may come to them later."""
    made = records()
    made["pass_number"], made["source"] = 3, 7
    sections = filled([made])
    store = SectionStore(SURVEY_POINT)
    for number in sections.sections(0):
        store.put(0, number, sections.section(0, number))
    if more:
        late = made[::5].copy()
        late["source"] = 8
        store.append(0, late)
        sections = filled([made, late])
    for number in sections.sections(0):
        np.testing.assert_array_equal(np.asarray(store.section(0, number)), np.asarray(sections.section(0, number)))
    np.testing.assert_array_equal(np.asarray(store.window(0, 0, 200).records), np.asarray(sections.window(0, 0, 200).records))


def test_what_a_section_is_finished_with_is_seen_and_nothing_else():
    made = records()
    store = filled(np.array_split(made, 3))
    store.finish = lambda road, section: section["d"] > 0
    for _ in range(2):  # the second time as it was put back
        assert len(store.window(0, -20.0, 220.0)) == np.count_nonzero(made["d"] > 0)
        assert (store.window(0, -20.0, 220.0).d > 0).all()


def test_the_order_of_appending_leaves_no_trace():
    made = records()
    mixed = made[np.random.default_rng(1).permutation(len(made))]
    one, other = filled([made]), filled(np.array_split(mixed, 13))
    for number in one.sections(0):
        np.testing.assert_array_equal(one.section(0, number), other.section(0, number))


def test_a_window_holds_its_start_but_not_its_end():
    made = records(3)
    made["s"] = to_units([20.0, 39.9999, 40.0])
    assert len(filled([made]).window(0, 20.0, 40.0)) == 2


def test_windows_side_by_side_hold_every_point_once():
    store = filled([records()])
    edges = np.arange(-13.0, 214.0, 3.3)
    assert sum(len(store.window(0, a, b)) for a, b in zip(edges[:-1], edges[1:])) == 4000


def test_points_added_after_reading_are_seen():
    store = filled([records(100)])
    before = len(store.window(0, -20, 220))
    store.append(0, records(50, seed=9))
    assert (before, len(store.window(0, -20, 220))) == (100, 150)


def test_an_empty_store_has_no_roads_and_empty_windows():
    store = SectionStore(SURVEY_POINT)
    store.append(0, records(0))
    assert store.roads() == [] and store.sections(0) == [] and len(store.window(0, 0.0, 100.0)) == 0
    assert store.span(0) == (0.0, 0.0)


def test_several_threads_read_what_one_reads():
    store = filled(np.array_split(records(20_000), 9), section_length=20.0)
    expected = {number: np.asarray(store.section(0, number)).tobytes() for number in store.sections(0)}
    wrong = []

    def read(seed):
        for number in np.random.default_rng(seed).permutation(list(expected)):
            if np.asarray(store.section(0, int(number))).tobytes() != expected[int(number)]:
                wrong.append(number)

    threads = [threading.Thread(target=read, args=(seed,)) for seed in range(8)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert not wrong


@pytest.mark.parametrize("length", [0.01, 3.0, 200.0])
def test_points_are_ordered_by_station_then_offset_then_height(length):
    made = records(5000, length=length)
    made["d"] -= made["d"] % 20_000  # many share an offset, and some a station
    expected = np.lexsort((made["x"], made["intensity"], made["time"], made["z"], made["d"], made["s"]))
    np.testing.assert_array_equal(canonical_order(made), expected)


@pytest.mark.parametrize("count", [1, 500, 90_000])
def test_points_at_one_place_are_ordered_by_time_intensity_and_the_rest(count):
    made = records(count, length=3.0)
    for name, step in (("s", 2000), ("d", 20_000), ("z", 200_000), ("time", 50), ("x", 500_000), ("intensity", 30_000)):
        made[name] -= (made[name] % step).astype(made[name].dtype)
    made["source"], made["returns"] = np.arange(count) % 7, np.arange(count) % 5
    expected = np.lexsort([made[name] for name in ("returns", "source", "y", "x", "intensity", "time", "z", "d", "s")])
    np.testing.assert_array_equal(canonical_order(made), expected)


def test_points_that_are_removed_do_not_change_the_order_of_the_others():
    made = records(90_000, length=3.0)
    order, stay = canonical_order(made), made["d"] % 3 > 0
    np.testing.assert_array_equal(canonical_order(made, stay), order[stay[order]])
    assert len(canonical_order(made, np.zeros(len(made), bool))) == 0


def test_a_tenth_of_a_millimetre_survives():
    np.testing.assert_array_equal(to_units([0.0001, -0.0001, 123.45674]), [1, -1, 1234567])


def test_a_section_read_before_its_last_points_came_is_in_order_all_the_same():
    made = records()
    store = SectionStore(SURVEY_POINT)
    for part in np.array_split(made, 5):
        store.append(0, part)
        store.section(0, 3)
        store.window(0, 90.0, 150.0)
    at_once = filled([made])
    for _ in range(2):  # the second time as it was put back
        for number in at_once.sections(0):
            np.testing.assert_array_equal(store.section(0, number), at_once.section(0, number))


def test_a_section_that_was_handed_out_cannot_be_spoilt_for_the_next_reader():
    section = filled([records()]).section(0, 2)
    with pytest.raises(ValueError, match="read-only"):
        section["time"] = 0.0


@pytest.mark.parametrize("length", [5.0, 7.0, 0.3])
def test_the_first_unit_of_a_section_is_the_least_that_lies_in_it(length):
    for number in (-4, 0, 1, 3, 1000):
        unit = SectionStore(SURVEY_POINT, section_length=length).first_unit(number)
        assert [int(np.floor(u * 1e-4 / length)) for u in (unit - 1, unit)] == [number - 1, number]


def test_the_temporary_file_goes_with_the_store_and_nobody_is_warned():
    """Python would write of an unclosed file into the log that the user reads."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        store = filled([records()])
        store.section(0, 3)
        del store
        gc.collect()
    assert not [one for one in said if issubclass(one.category, ResourceWarning)]


def bright_of(store, folder=None):
    """The store with half the intensity, and a column that is the same everywhere."""
    bright = store.with_column("intensity", folder)
    with bright.part() as part:
        for number in store.sections(0):
            part.put(0, number, store.section(0, number).with_columns(intensity=store.section(0, number)["intensity"] // 2))
    bright.adopt(part.index(), folder)
    return bright


@pytest.mark.parametrize("named", [False, True])
def test_a_column_beside_a_store_replaces_its_own_and_no_other(tmp_path, named):
    folder = tmp_path if named else None
    store = filled(np.array_split(records(), 3), folder=folder)
    for found in [bright := bright_of(store, folder), *([opened_store(tmp_path, **bright.contents())] if named else [])]:
        assert (found.count, found.roads(), found.sections(0)) == (store.count, [0], store.sections(0))
        whole, halved = (np.asarray(one.window(0, -20.0, 220.0).records) for one in (store, found))
        np.testing.assert_array_equal(halved["intensity"], whole["intensity"] // 2)
        for name in SURVEY_POINT.names:
            assert name == "intensity" or (halved[name] == whole[name]).all()
        few = np.array([5, 2, 2])
        np.testing.assert_array_equal(found.section(0, 4).take(few)["intensity"], store.section(0, 4)["intensity"][few] // 2)
    bright.close()
    assert not store.roads()


def test_a_column_with_one_value_for_all_points_is_not_stored():
    made, store = records(), SectionStore(SURVEY_POINT, constants=dict(scanner=3, time=np.nan))
    store.append(0, made)
    read = store.window(0, -20.0, 220.0).records
    assert len(read) == len(made) and (read["scanner"] == 3).all() and np.isnan(read["time"]).all()
    assert store._row_bytes == SURVEY_POINT.itemsize - 9


def test_the_disk_space_of_points_in_no_order_is_given_back_with_the_last_section_that_is_put_in_order():
    store = filled(np.array_split(records(), 3))
    waiting = weakref.ref(store._files[False])
    for number in store.sections(0):
        assert waiting() is not None
        store.section(0, number)
    gc.collect()
    assert waiting() is None


def test_points_that_are_written_again_have_the_same_state_and_others_another():
    made = records()

    def states(points):
        put, appended = SectionStore(SURVEY_POINT), SectionStore(SURVEY_POINT)
        put.put(0, 0, points)
        appended.append(0, points)
        return [store.state((0, -10, 1000)) for store in (put, appended)]

    moved = made.copy()
    moved["z"][len(moved) // 2] += 1
    assert states(made) == states(made.copy())
    for other in (moved, made[:-1]):
        assert all(before != after for before, after in zip(states(made), states(other)))
