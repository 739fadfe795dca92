"""Bright pieces that are neither noise nor rims; where points lie far apart, what was not seen between two of them is no gap."""

from functools import partial

import numpy as np
import pytest
from lanewright.core.markings.paint.not_paint import clear_pieces, two_sided

SPOT = np.array([(row, column) for row in range(3) for column in range(3)])   # cells that one point brightens


def spots(step, axis, count=6):
    """(160, 160) bool, cells that a row of points brightens, so many cells apart along an axis."""
    mask = np.zeros((160, 160), bool)
    for k in range(count):
        rows, columns = (SPOT + [40 + k * step * (axis == 0), 40 + k * step * (axis == 1)]).T
        mask[rows, columns] = True
    return mask


def pieces(mask, seen, brightness=20.0):
    return clear_pieces(np.full(mask.shape, brightness), mask, seen)


@pytest.mark.parametrize("axis", [0, 1])
def test_points_of_a_line_a_third_of_a_metre_apart_are_paint_where_nothing_was_seen_between_them(axis):
    mask = spots(10, axis)
    np.testing.assert_array_equal(pieces(mask, mask), mask)


@pytest.mark.parametrize("axis", [0, 1])
def test_bright_specks_with_dark_asphalt_between_them_are_none(axis):
    mask = spots(10, axis)
    assert not pieces(mask, np.ones(mask.shape, bool)).any()


def test_a_bright_speck_with_nothing_about_it_is_none():
    mask = spots(10, 0, count=1)
    assert not pieces(mask, mask).any()


def test_specks_farther_apart_than_points_of_one_track_are_none():
    mask = spots(16, 0, 4)
    assert not pieces(mask, mask).any()


@pytest.mark.parametrize("specks, kept", [([55, 70, 85], True), ([55, 85], False), ([55, 70], False), ([], True)])
def test_specks_of_a_worn_line_are_paint_where_they_lead_from_one_clear_piece_to_the_next(specks, kept):
    mask = np.zeros((160, 160), bool)
    mask[20:40, 80:83] = mask[100:120, 80:83] = True
    mask[specks, 81] = True
    found = pieces(mask, np.ones(mask.shape, bool))
    assert found[20:40, 80:83].all() and found[100:120, 80:83].all()
    # no gap may be longer than 0.80 m, 20 cells
    assert (found[specks, 81] == kept).all()


@pytest.mark.parametrize("cells, brightness, kept", [(30, 5.0, True), (30, 3.5, False), (12, 20.0, False)])
def test_a_faint_line_of_some_length_is_paint_and_a_short_faint_one_or_a_bright_speck_is_noise(cells, brightness, kept):
    mask = np.zeros((160, 160), bool)
    mask[20:20 + cells // 2, 80:82] = True
    np.testing.assert_array_equal(pieces(mask, np.ones(mask.shape, bool), brightness), mask & kept)


@pytest.mark.parametrize("beside, kept", [(0.5, True), (1.3, True), (2.0, False), (4.5, False)])
@pytest.mark.parametrize("length", [40, 100])
def test_a_worn_line_beside_somewhat_brighter_ground_is_paint_and_a_rim_that_fades_into_a_repair_is_none(beside, kept, length):
    above = np.zeros((160, 160), np.float32)
    above[:, 83:] = beside
    mask = np.zeros((160, 160), bool)
    mask[20:20 + length, 80:83] = True
    above[mask] = 4.0
    found = clear_pieces(np.where(mask, 4.0, 0.0), mask, np.ones(mask.shape, bool), partial(two_sided, above, mask, 3.0))
    np.testing.assert_array_equal(found, mask & kept)
