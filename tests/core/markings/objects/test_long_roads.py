"""What is done for a metre of paint does not grow with the road: counts of work, and memory, on roads of a length and of four times that length."""

import tracemalloc

import numpy as np
import pytest
from lanewright.core.markings import road_grid as scan_tracks
from lanewright.core.markings.objects import repeating as dash_rows
from lanewright.core.markings.objects import split_merge
from lanewright.core.markings.objects import split_merge as bars
from lanewright.core.markings.objects.repeating import Comb, _alike
from lanewright.core.markings.road_grid import filled_between_tracks

SHORT, LONG = 2, 8


def lines_joined_by_bars(bars_of_road):
    """Cells of an edge line and a centre line that a stop line joins every 25 m: one cluster, sorted along the road."""
    length = 625 * bars_of_road
    along = np.arange(length)
    parts = [np.stack(np.meshgrid(along, np.arange(first, first + 4)), -1).reshape(-1, 2) for first in (0, 80)]
    parts += [np.stack(np.meshgrid(np.arange(k, k + 10), np.arange(0, 84)), -1).reshape(-1, 2) for k in range(300, length, 625)]
    return np.unique(np.concatenate(parts), axis=0)


def test_a_cluster_as_long_as_the_road_is_divided_stretch_by_stretch(monkeypatch):
    count, plain, whole = [0], bars.even_strip, split_merge.complete_bar

    def counted(cells):
        count[0] += len(cells)
        return plain(cells)

    def completed(parts, bar, turned, along):
        before = count[0]
        whole(parts, bar, turned, along)
        # a bar is looked at with what lies beside it
        assert count[0] - before < 3000

    for module in (bars, split_merge):
        monkeypatch.setattr(module, "even_strip", counted)
    monkeypatch.setattr(split_merge, "complete_bar", completed)
    found = []
    for length in (SHORT, LONG):
        count[0] = 0
        parts = split_merge._parts(lines_joined_by_bars(length))
        assert len(np.unique(parts)) == 2 + length   # two lines, and as many stop lines
        found.append(count[0])
    assert found[1] <= 1.1 * LONG / SHORT * found[0]


@pytest.mark.parametrize("chunk", [40, 700])
def test_where_paint_is_looked_at_in_pieces_does_not_show(monkeypatch, chunk):
    random = np.random.default_rng(chunk)
    cells = np.unique(np.c_[random.integers(0, 900, 3000), random.integers(0, 40, 3000)], axis=0)
    reach = np.where(random.random(len(cells)) < 0.5, random.uniform(0.1, 0.4, len(cells)), 0.0)
    whole, first = filled_between_tracks(cells, reach)
    monkeypatch.setattr(scan_tracks, "ROWS_AT_ONCE", chunk)
    parts, again = filled_between_tracks(cells, reach)
    np.testing.assert_array_equal(first, again)
    np.testing.assert_array_equal(whole, parts)
    assert whole.sum() > len(cells)


def test_filling_between_tracks_takes_little_memory_beside_the_cells_of_a_line_of_two_kilometres():
    cells = np.stack(np.meshgrid(np.arange(0, 50_000, 3), np.array([0, 8, 100])), -1).reshape(-1, 2)
    tracemalloc.start()
    mask, _ = filled_between_tracks(cells, np.full(len(cells), 0.35))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 4 * mask.nbytes + 10 * cells.nbytes


def test_windows_of_one_crossing_are_those_near_each_other_with_the_same_stripes():
    combs = [Comb(0.1, 1.0, 0.0, np.array([x, 0.0]), 0.8) for x in (0.0, 2.5, 5.0, 400.0, 402.5, 900.0)] \
        + [Comb(0.6, 1.0, 0.0, np.array([401.0, 0.0]), 0.8), Comb(0.1, 1.3, 0.0, np.array([401.0, 0.0]), 0.8)]
    assert _alike(combs) == [[0, 1, 2], [3, 4], [5], [6], [7]]
    assert _alike([]) == []


def test_a_give_way_line_goes_on_with_the_pieces_beyond_its_own_ends_however_many_lines_there_are(monkeypatch):
    count, plain = [0], dash_rows._led_on

    def led_on(row, middle, likely):
        def counted(place, reach):
            near = likely(place, reach)
            count[0] += len(near)
            return near
        return plain(row, middle, counted)

    monkeypatch.setattr(dash_rows, "_led_on", led_on)
    found = []
    for lines in (SHORT, LONG):
        # four squares in a row, and beyond them one that wear has left too narrow for a square
        middle = np.array([(60.0 * k, 1.0 * j) for k in range(lines) for j in range(5)])
        sides = np.tile([[0.5, 0.5]] * 4 + [[0.5, 0.3]], (lines, 1))
        filled = np.tile([True] * 4 + [False], lines)
        count[0] = 0
        assert dash_rows.give_way_blocks(filled, sides, middle).all()
        found.append(count[0])
    assert found == [SHORT, LONG]
