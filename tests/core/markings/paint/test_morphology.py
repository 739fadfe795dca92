"""Bright cells in runs as long as paint; where points lie far apart, what was not seen between two of them is no gap."""

import numpy as np
import pytest
from lanewright.core.markings.paint.not_paint import morphology
from lanewright.core.markings.paint.settings import MarkingSettings

SPOT = np.array([(row, column) for row in range(3) for column in range(3)])   # cells that one point brightens


def spots(step, axis, count=6):
    """(160, 160) bool, cells that a row of points brightens, so many cells apart along an axis."""
    mask = np.zeros((160, 160), bool)
    for k in range(count):
        rows, columns = (SPOT + [40 + k * step * (axis == 0), 40 + k * step * (axis == 1)]).T
        mask[rows, columns] = True
    return mask


@pytest.mark.parametrize("axis", [0, 1])
def test_points_of_a_line_a_third_of_a_metre_apart_are_paint_where_nothing_was_seen_between_them(axis):
    mask = spots(10, axis)
    np.testing.assert_array_equal(morphology(mask, mask, MarkingSettings()), mask)


@pytest.mark.parametrize("axis", [0, 1])
def test_bright_specks_with_dark_asphalt_between_them_are_none(axis):
    mask = spots(10, axis)
    assert not morphology(mask, np.ones(mask.shape, bool), MarkingSettings()).any()


def test_a_bright_speck_with_nothing_about_it_is_none():
    mask = spots(10, 0, count=1)
    assert not morphology(mask, mask, MarkingSettings()).any()


def test_specks_farther_apart_than_points_of_one_track_are_none():
    mask = spots(16, 0, 4)
    assert not morphology(mask, mask, MarkingSettings()).any()


@pytest.mark.parametrize("specks, kept", [([55, 70, 85], True), ([55, 85], False), ([55, 70], False), ([], True)])
def test_specks_of_a_worn_line_are_paint_where_they_lead_from_one_clear_piece_to_the_next(specks, kept):
    mask = np.zeros((160, 160), bool)
    mask[20:40, 80:83] = mask[100:120, 80:83] = True
    mask[specks, 81] = True
    found = morphology(mask, np.ones(mask.shape, bool), MarkingSettings())
    assert found[20:40, 80:83].all() and found[100:120, 80:83].all()
    # no gap may be longer than 0.80 m, 20 cells
    assert (found[specks, 81] == kept).all()
