"""Tables that keep each row where it is."""

import numpy as np
import pytest
from lanewright.core.survey.frame.row_table import RowSpans, RowTable, stacked

STATIONS = 300
ROWS = [(10, np.arange(5.0)), (-3, np.arange(8.0)), (290, np.arange(20.0)), (150, np.empty(0)), (0, np.arange(300.0)), (400, np.arange(4.0))]


def full(rows, missing=np.nan):
    """The same as an array of all rows and stations."""
    table = np.full((len(rows), STATIONS), missing)
    for own, (first, values) in zip(table, rows):
        for k, value in enumerate(values, start=first):
            if 0 <= k < STATIONS:
                own[k] = value
    return table


@pytest.mark.parametrize("key", [
    (1, slice(0, 12)), (0, slice(0, 300)), (2, slice(280, 400)), (np.array([0, 1, 4]), slice(5, 20)), (np.array([0, 4, -1]), np.array([12, 299, 3])),
    (np.arange(6)[:, None], np.arange(STATIONS)), (3, np.arange(140, 160)), (5, slice(290, 300))])
def test_a_table_is_indexed_as_the_array_of_all_rows_and_stations(key):
    np.testing.assert_array_equal(RowTable.of_rows(ROWS, STATIONS)[key], full(ROWS)[key])


def test_what_is_missing_may_differ_from_row_to_row():
    table = RowTable.of_rows(ROWS, STATIONS)
    table = table.like(table.values.astype(int), np.arange(6))
    assert table[np.arange(3), 200].tolist() == [0, 1, 2]
    assert table[1, 20:22].tolist() == [1, 1] and table[1, 0] == 3


@pytest.mark.parametrize("first, last", [(0, 0), (9, 9), (10, 14), (64, 128), (289, 290), (-5, 400), (299, 320), (310, 330)])
def test_rows_near_a_stretch_are_those_that_are_kept_there(first, last):
    spans = RowTable.of_rows(ROWS, STATIONS).spans
    kept = np.zeros((len(ROWS), STATIONS), bool)
    kept[spans.owner, spans.station] = True
    there = kept[:, max(first, 0):last + 1].any(1)
    assert spans.near(first, last).tolist() == np.flatnonzero(there).tolist()


def test_rows_are_moved_to_a_grid_that_begins_elsewhere_and_put_one_after_the_other():
    table = RowTable.of_rows(ROWS, STATIONS)
    moved = table.shifted(4, 200)
    expected = np.full((len(ROWS), 200), np.nan)
    expected[:] = full(ROWS)[:, 4:204]
    np.testing.assert_array_equal(moved[np.arange(6), :], expected)
    np.testing.assert_array_equal(stacked([moved, moved])[np.arange(12), :], np.concatenate([expected, expected]))


def test_a_table_of_many_rows_side_by_side_holds_as_many_values_as_they_have():
    rows = 1000
    spans = RowSpans(10 * np.arange(rows), np.full(rows, 12), 10 * rows + 2)
    assert RowTable(spans, np.zeros(spans.size), 0.0).values.size == 12 * rows
    assert max(len(spans.near(k, k)) for k in range(0, 10 * rows, 37)) == 2
