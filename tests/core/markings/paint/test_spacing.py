"""How far apart the tracks of a scan lie across the road."""

import numpy as np
import pytest
from lanewright.core.markings.paint.not_paint import rim_distance, track_spacing

DENSE, SPARSE = 50, slice(60, 200)   # columns of cells: the middle of the dense half, the sparse half


def tracks(step, along=3):
    """(100, 200) cells: every cell scanned up to column 60, then one track every `step` cells, one point every `along` cells on it."""
    occupied = np.zeros((100, 200), bool)
    occupied[:, :60] = True
    occupied[::along, 60::step] = True
    return occupied


@pytest.mark.parametrize("step", [3, 5, 8])
def test_the_spacing_is_the_distance_to_the_next_track(step):
    spacing = track_spacing(tracks(step))
    assert (spacing[:, DENSE] <= 0.04).all()
    np.testing.assert_allclose(spacing[50, 70:180][tracks(step)[48, 70:180]], 0.04 * step, atol=0.001)


def test_of_two_gaps_beside_a_track_the_wider_counts():
    occupied = np.zeros((50, 60), bool)
    occupied[:, [20, 23, 30]] = True
    assert track_spacing(occupied)[25, 23] == pytest.approx(0.28)


def test_a_shadow_is_no_spacing():
    occupied = np.ones((50, 100), bool)
    occupied[:, 40:70] = False
    assert track_spacing(occupied).max() <= 0.04


def test_points_half_a_metre_apart_along_a_track_leave_it_a_track():
    assert track_spacing(tracks(5, along=12))[50, 100] == pytest.approx(0.20)


@pytest.mark.parametrize("step", [8, 12])
def test_tracks_far_apart_are_one_road_and_no_rim_lies_between_them(step):
    """Points of neighbouring tracks lie at different stations."""
    occupied = tracks(step)
    occupied[:, 60 + step::2 * step] = np.roll(occupied[:, 60 + step::2 * step], 1, axis=0)
    rim = rim_distance(occupied)[50]
    assert rim[70:130].min() > 1.5
    assert rim[190] < 0.5
