"""Rims beside the road that are bright like paint, and fade out on one side."""

import numpy as np
import pytest
from lanewright.core.markings.paint.not_paint import side_fading, without_fading_areas, without_fading_rims

SHAPE = 500, 200     # cells of 4 cm: 20 m along the road, 8 m across it
EVERYWHERE = np.ones(SHAPE, bool)


def road(*profiles, noise=0.6, seed=1):
    """Brightness above asphalt in spreads: each profile is a function of the column."""
    z = np.random.default_rng(seed).normal(0.0, noise, SHAPE)
    for profile in profiles:
        z += np.broadcast_to(profile(np.arange(SHAPE[1])), SHAPE)
    return z


def line(first, last, height=14.0):
    return lambda column: np.where((column >= first) & (column < last), height, 0.0)


def rim(joint, height=7.0, fade=15.0, side=1):
    """Bright at the joint with the asphalt, fading over 60 cm into the ground behind it."""
    behind = (lambda column: side * (column - joint))
    return lambda column: np.where(behind(column) >= 0, height * np.clip(1 - behind(column) / fade, 0, 1), 0.0)


def kept(z, threshold=3.0):
    mask = z > threshold
    return without_fading_rims(z, mask, EVERYWHERE).sum() / max(mask.sum(), 1)


@pytest.mark.parametrize("width", [3, 8], ids=["12 cm", "30 cm"])
def test_an_edge_line_ends_sharply_and_stays(width):
    assert kept(road(line(100, 100 + width))) > 0.99


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_a_granite_rim_that_fades_into_the_ground_behind_it_is_no_paint(side):
    assert kept(road(rim(100, side=side))) < 0.05


def test_an_edge_line_a_metre_from_such_a_rim_stays_while_the_rim_goes():
    z = road(rim(150), line(120, 124))
    left = without_fading_rims(z, z > 3.0, EVERYWHERE)
    assert left[:, 115:130].sum() > 0.99 * (z > 3.0)[:, 115:130].sum()
    assert left[:, 145:].sum() < 0.05 * (z > 3.0)[:, 145:].sum()


def test_the_two_lines_of_a_double_line_do_not_make_each_other_fade():
    assert kept(road(line(100, 103), line(106, 109))) > 0.99


def test_the_side_that_fades_is_known():
    z = road(rim(100), noise=0.1)
    mask = z > 3.0
    below, above = side_fading(z, mask, EVERYWHERE)
    assert np.nanmedian(below) < 0.05 and np.nanmedian(above) > 0.2


def test_beside_what_was_not_scanned_nothing_is_known():
    mask = np.zeros(SHAPE, bool)
    mask[:, 100:104] = True
    assert np.isnan(side_fading(np.where(mask, 10.0, 0.0), mask, mask)[0]).all()


OFFSETS = (np.arange(SHAPE[1]) + 0.5) * 0.04 - 4.0   # m: the reference line is the middle
NOWHERE = np.zeros(SHAPE, bool)


def in_a_gap(z):
    """The same, seen for 1.5 m of road between two parked cars, ragged towards the vehicle as a slanting view leaves it."""
    ragged = np.arange(SHAPE[1]) > 160 + np.random.default_rng(2).integers(-2, 8, SHAPE[0])[:, None]
    return np.where((np.abs(np.arange(SHAPE[0]) - 250) < 19)[:, None] & (ragged | (np.arange(SHAPE[1]) < 160)), z, 0.0)


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_the_sidewalk_that_was_seen_between_two_parked_cars_is_no_paint(side):
    z = in_a_gap(road(rim(160, height=9.0, fade=35.0)))[:, ::side]
    mask = z > 4.0
    assert mask.sum() > 400
    assert without_fading_areas(z, mask, EVERYWHERE, NOWHERE, OFFSETS).sum() < 0.05 * mask.sum()


def test_bright_specks_behind_such_a_sidewalk_do_not_make_it_paint():
    z = in_a_gap(road(rim(160, height=9.0, fade=35.0)))
    mask = z > 4.0
    rest = mask.sum()
    for row in range(230, 270, 5):
        speck = slice(row, row + 5), slice(192 + row % 2 * 4, 195 + row % 2 * 4)
        z[speck], mask[speck] = 9.0, True
    left = without_fading_areas(z, mask, EVERYWHERE, NOWHERE, OFFSETS)
    assert left[:, :190].sum() < 0.05 * rest


def test_a_bar_an_arrow_or_a_line_as_short_stays():
    for width in (4, 15, 80):
        z = in_a_gap(road(line(165 - width, 165)))
        mask = z > 4.0
        assert (without_fading_areas(z, mask, EVERYWHERE, NOWHERE, OFFSETS) == mask).all()


def test_what_leads_on_into_a_gutter_is_of_it_and_paint_beside_a_gutter_is_not():
    gutter = np.broadcast_to(np.arange(SHAPE[1]) >= 170, SHAPE)
    for height, stays in ((8.0, False), (20.0, True)):
        z = in_a_gap(road(line(158, 170, height), line(170, 178, 8.0)))
        mask = (z > 4.0) & ~gutter
        left = without_fading_areas(z, mask, EVERYWHERE, gutter, OFFSETS)
        assert left.sum() > 0.95 * mask.sum() if stays else left.sum() < 0.05 * mask.sum()
