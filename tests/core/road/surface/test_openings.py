"""Side streets at the openings of an edge, on grids of ground whose streets are known."""

import numpy as np
import pytest
from lanewright.core.road.surface.extract import opened_limits
from lanewright.core.road.weights import SURFACE

ROWS, OFFSETS = 80, (np.arange(80) + 0.5) * SURFACE.column_width   # 40 m of road, 20 m outward
STATIONS = (np.arange(ROWS) + 0.5) * SURFACE.row_length
CURB = 5.0                                                 # m from the reference line
FARTHEST = np.full(ROWS, 17.0)


def place(street, sidewalk=0.12, island=None, scanned=20.0):
    """Heights and ground of a road with one curb, and a street that opens it between two stations.

    street : (first, last) station; sidewalk : m above the road; island : (first, last station, first, last offset) or None;
    scanned : m outward as far as the ground was measured
    """
    s, d = STATIONS[:, None], OFFSETS[None, :]
    level = (d < CURB) | (s > street[0]) & (s < street[1])
    if island:
        level &= ~((s > island[0]) & (s < island[1]) & (d > island[2]) & (d < island[3]))
    height = np.where(level, 0.0, sidewalk) + np.where(d > scanned, np.nan, 0.0)
    return height, level & np.isfinite(height)


def limits(height, ground, opening, driven=None):
    """(R,) m, of the side, where the edge is open from one station to another."""
    closed = (STATIONS > opening[0]) & (STATIONS < opening[1])
    driven = np.zeros(height.shape, bool) if driven is None else driven
    return opened_limits(np.full(ROWS, CURB), closed, height, ground, OFFSETS, FARTHEST, driven)


@pytest.mark.parametrize("scanned", [12.0, 15.0])
def test_the_road_goes_on_into_a_street_as_far_as_it_was_scanned(scanned):
    found = limits(*place((14, 24), scanned=scanned), (14, 24))
    street = (STATIONS > 15) & (STATIONS < 23)
    np.testing.assert_allclose(found[street], scanned, atol=SURFACE.column_width)
    np.testing.assert_array_equal(found[(STATIONS < 14) | (STATIONS > 24)], CURB)


def test_a_wide_mouth_whose_corners_are_both_dropped_is_a_street():
    height, ground = place((8, 32))
    corner = (np.abs(STATIONS - 20.0) > 12.0)[:, None] & (OFFSETS < CURB + 6.5)
    height, ground = np.where(corner, 0.0, height), ground | corner
    assert limits(height, ground, (8, 32))[(STATIONS > 9) & (STATIONS < 31)].min() > 16.5


def test_no_street_goes_farther_than_the_width_asked_for():
    assert limits(*place((14, 24)), (14, 24)).max() == 17.0


def test_behind_an_island_the_street_goes_on():
    height, ground = place((14, 24), island=(17, 21, 7, 10))
    assert limits(height, ground, (14, 24))[(STATIONS > 18) & (STATIONS < 20)].min() > 16.5


def test_an_opening_as_narrow_as_a_driveway_stays_closed():
    np.testing.assert_array_equal(limits(*place((17, 22)), (17, 22)), CURB)


def test_a_dropped_curb_with_a_level_sidewalk_behind_it_is_no_street():
    # the whole sidewalk lies level with the road
    height, ground = place((14, 24), sidewalk=0.0)
    ground[:] = True
    np.testing.assert_array_equal(limits(height, ground, (14, 24)), CURB)


def test_a_yard_no_deeper_than_a_parking_space_is_no_street():
    height, ground = place((14, 24))
    ground &= OFFSETS < CURB + 4.0
    np.testing.assert_array_equal(limits(height, ground, (14, 24)), CURB)


def test_a_street_that_was_driven_is_left_to_its_own_road():
    height, ground = place((14, 24))
    driven = np.zeros(height.shape, bool)
    driven[38, 30:] = True
    np.testing.assert_array_equal(limits(height, ground, (14, 24), driven), CURB)
