"""Intensities of several scanners and passes at one level: what the scanners differ by goes, what the ground differs by stays."""

import numpy as np
import pytest
from lanewright.core.road.surface.ground_grid import at_one_level

SHAPE, COLUMN = (5, 80), 0.1   # cells of 5 m of road, 8 m across


def ground(column):
    """Returned intensity of asphalt that darkens outward, and of gravel from 5 m on."""
    return 2000.0 * np.exp(-0.02 * column) * np.where(column < 50, 1.0, 1.5)


def measured(gains, seen=None, per_cell=12, seed=3):
    """Intensity, view and cell of points on every cell; `gains` : functions of the column, one per view; `seen` : of view and column."""
    rng = np.random.default_rng(seed)
    cell = np.repeat(np.arange(SHAPE[0] * SHAPE[1]), per_cell * len(gains))
    view = np.tile(np.arange(len(gains)), len(cell) // len(gains))
    column = cell % SHAPE[1]
    kept = np.ones(len(cell), bool) if seen is None else seen(view, column)
    cell, view, column = cell[kept], view[kept], column[kept]
    gain = np.choose(view, [one(column) for one in gains])
    return ground(column) * gain * rng.lognormal(0.0, 0.1, len(cell)), view, cell


def by_column(intensity, cell):
    """(C,) means of the logarithm."""
    column = cell % SHAPE[1]
    return np.bincount(column, np.log(intensity)) / np.bincount(column)


@pytest.mark.parametrize("gains", [
    [lambda c: 1.0 + 0 * c, lambda c: 1.8 + 0 * c],
    [lambda c: 1.0 + 0 * c, lambda c: 0.6 + 0.01 * c],
    [lambda c: 1.0 + 0 * c, lambda c: 2.5 + 0 * c, lambda c: 0.4 + 0 * c, lambda c: 1.2 - 0.005 * c]])
def test_scanners_agree_afterwards_and_gravel_is_as_much_brighter_as_it_was(gains):
    intensity, view, cell = measured(gains)
    level = at_one_level(intensity, view, cell, SHAPE, COLUMN)
    apart = [by_column(level[view == k], cell[view == k]) for k in range(len(gains))]
    assert np.ptp(apart, axis=0).max() < 0.12 and np.abs(np.mean(np.ptp(apart, axis=0))) < 0.08
    step = by_column(level, cell)
    assert step[52:60].mean() - step[40:48].mean() == pytest.approx(np.log(1.5) - 0.02 * 12 + np.mean(
        [np.log(np.mean(one(np.arange(52, 60))) / np.mean(one(np.arange(40, 48)))) for one in gains]), abs=0.03)


def test_where_one_scanner_alone_sees_the_ground_its_level_goes_on():
    gains = [lambda c: 1.0 + 0 * c, lambda c: 2.0 + 0 * c]
    intensity, view, cell = measured(gains, seen=lambda view, column: (view == 0) | (column < 30))
    level = by_column(at_one_level(intensity, view, cell, SHAPE, COLUMN), cell)
    assert level[31:36].mean() - level[24:29].mean() == pytest.approx(-0.02 * 7, abs=0.04)
    raw = by_column(intensity, cell)
    assert abs(raw[31:36].mean() - raw[24:29].mean()) > 0.3


def test_one_scanner_keeps_its_intensities_and_no_points_are_none():
    intensity, view, cell = measured([lambda c: 1.0 + 0 * c])
    np.testing.assert_array_equal(at_one_level(intensity, view, cell, SHAPE, COLUMN), intensity.astype(np.float32))
    empty = np.zeros(0, int)
    assert len(at_one_level(empty, empty, empty, SHAPE, COLUMN)) == 0
