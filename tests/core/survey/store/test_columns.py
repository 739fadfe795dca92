"""Points kept column by column, and sorted and thinned in linear time."""

import numpy as np
import pytest
from lanewright.core.common.arrays import decimate_cells, order_by
from lanewright.core.survey.store.columns import Columns


def some(count=100):
    records = np.zeros(count, [("s", "i4"), ("time", "f8")])
    records["s"], records["time"] = np.arange(count), np.arange(count) / 7
    return records


def test_rows_are_taken_as_from_a_structured_array():
    records = some()
    columns = Columns.from_records(records)
    for which in (slice(5, 20), slice(None, None, 7), np.arange(100) % 3 == 0, np.array([7, 7, 2]), np.empty(0, int)):
        np.testing.assert_array_equal(columns[which], records[which])
    np.testing.assert_array_equal(columns[10:90][np.arange(80) % 3 == 0], records[10:90][np.arange(80) % 3 == 0])


def test_rows_taken_from_rows_taken_before_are_the_right_ones():
    columns = Columns.from_records(some())
    np.testing.assert_array_equal(columns[np.array([9, 5, 3])][np.array([2, 0])]["s"], [3, 9])


def test_a_mask_of_another_length_is_refused():
    with pytest.raises(IndexError, match="does not fit"):
        Columns.from_records(some())[np.ones(99, bool)]


def test_rows_that_were_taken_may_be_changed_without_changing_their_source():
    columns = Columns.from_records(some()).read_only()
    chosen = columns[np.array([1, 2])]
    chosen["s"] = 0
    assert chosen["s"].tolist() == [0, 0] and columns["s"].tolist() == list(range(100))


@pytest.mark.parametrize("which", [np.array([3, 30, 30, 99]), np.array([40, 41]), np.array([99, 0, 50]), np.array([-1, 5]), np.empty(0, int),
                                   slice(20, 80), slice(33, 34), slice(None), slice(90, 10), slice(0, 100, 9), slice(-30, -2)], ids=str)
def test_rows_of_joined_parts_are_those_of_the_whole(which):
    records = some()
    parts = [Columns.from_records(records[a:b]) for a, b in ((0, 33), (33, 34), (34, 70), (70, 100))]
    joined = Columns.concatenate(parts, records.dtype)
    np.testing.assert_array_equal(joined[which], records[which])
    np.testing.assert_array_equal(joined[10:95][:80][1::3], records[10:95][:80][1::3])
    few = joined[10:95][np.array([0, 23, 24, 60])]
    np.testing.assert_array_equal(few["s"], [10, 33, 34, 70])
    joined["s"] = 7
    assert (joined[which]["s"] == 7).all() and (joined[which]["time"] == records[which]["time"]).all()


def test_a_marking_asks_those_parts_of_a_long_road_alone_that_it_lies_in(monkeypatch):
    records, asked = some(400), []
    joined = Columns.concatenate([Columns.from_records(records[k:k + 4]) for k in range(0, 400, 4)], records.dtype)
    plain = Columns.__len__
    monkeypatch.setattr(Columns, "__len__", lambda columns: asked.append(columns) or plain(columns))
    for rows in ([201, 202], [198, 203, 204], [0], [399]):
        asked.clear()
        np.testing.assert_array_equal(joined.take(np.array(rows))["time"], records["time"][rows])
    assert len(asked) < 10


def test_a_row_beyond_joined_parts_is_refused():
    joined = Columns.concatenate([Columns.from_records(some(5)), Columns.from_records(some(5))], some().dtype)
    with pytest.raises(IndexError):
        joined[np.array([3, 10])]["s"]


def test_only_those_parts_are_read_that_the_rows_lie_in():
    def unread(name):
        raise AssertionError(f"{name} was read")

    parts = [Columns({}, some().dtype, 100, unread), Columns.from_records(some())]
    joined = Columns.concatenate(parts, some().dtype)
    assert joined[np.array([100, 150])]["s"].tolist() == [0, 50]
    assert joined[120:130][np.array([1])]["s"].tolist() == [21]


def test_parts_are_joined_in_order_and_none_are_none():
    records = some()
    halves = [Columns.from_records(records[:30]), Columns.from_records(records[30:])]
    np.testing.assert_array_equal(Columns.concatenate(halves, records.dtype), records)
    assert len(Columns.concatenate([], records.dtype)) == len(Columns.concatenate([], records.dtype)["time"]) == 0


@pytest.mark.parametrize("count", [0, 1, 5000])
def test_integers_of_any_sign_and_size_are_sorted_by_the_last_key_first(count):
    rng = np.random.default_rng(3)
    minor, major = rng.integers(-2**31, 2**31, count).astype(np.int32), rng.integers(-4, 4, count).astype(np.int32)
    np.testing.assert_array_equal(order_by(minor, major), np.lexsort((minor, major)))


def test_crowded_cells_are_thinned_evenly_and_others_left_alone():
    cell = np.repeat([0, 1, 5], [3, 1000, 10]).astype(np.int32)
    kept = decimate_cells(cell, 10)
    assert np.bincount(cell[kept]).tolist() == [3, 10, 0, 0, 0, 10]
    assert (np.diff(kept[3:13]) == 100).all()
