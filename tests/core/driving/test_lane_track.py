"""Borders of lanes have no steps where they go on as another line."""

import numpy as np
import pytest
from lanewright.core.driving.lane_track import INFERRED, MEASURED, LaneTrack, led_over
from lanewright.core.driving.lanes import _without_steps

S = np.arange(0.0, 60.0, 0.5)


@pytest.mark.parametrize("jump", [-0.4, 0.05, 0.3])
def test_a_jump_from_line_to_line_is_spread_and_the_lines_stay_elsewhere(jump):
    offset = np.where(S < 30.0, 1.75, 1.75 + jump)
    led = led_over(S, offset, np.where(S < 30.0, 4, 7))
    assert np.abs(np.diff(led)).max() / 0.5 < 0.052
    far = np.abs(S - 29.75) > 15 * abs(jump) + 0.5
    assert led[far] == pytest.approx(offset[far])
    assert np.abs(led - offset).max() <= abs(jump) / 2 + 1e-9


@pytest.mark.parametrize("step", [0.02, 0.025, 0.03, 0.034, 0.05, 0.3])
def test_a_step_of_any_size_moves_the_border_beside_it_alone(step):
    offset = np.where(S < 30.0, 1.75, 1.75 + step)
    led = led_over(S, offset, np.where(S < 30.0, 4, 7))
    far = np.abs(S - 30.0) > 15.0
    assert far.sum() > 50
    np.testing.assert_array_equal(led[far], offset[far])
    assert np.abs(led - offset).max() < 0.6 * step


def test_a_step_within_a_line_is_led_over_too_and_a_taper_is_kept():
    taper = np.interp(S, [20.0, 35.0], [1.75, 5.25])
    assert led_over(S, taper, np.full(len(S), 4)) == pytest.approx(taper)
    step = np.where(S < 30.0, 1.75, 2.15)
    assert np.abs(np.diff(led_over(S, step, np.full(len(S), 4)))).max() < 0.05


def test_near_the_end_of_a_lane_there_is_less_room_and_the_end_stays():
    offset = np.where(S < 58.0, 1.75, 2.05)
    led = led_over(S, offset, np.where(S < 58.0, 4, 7))
    assert led[-1] == pytest.approx(2.05) and led[0] == pytest.approx(1.75) and np.abs(np.diff(led)).max() < 0.2


@pytest.mark.parametrize("last", [0, -1])
def test_a_place_aside_at_the_very_end_is_led_on_with_the_others(last):
    offset = np.full(len(S), 1.75)
    offset[last] += 0.3
    assert led_over(S, offset, np.full(len(S), 4)) == pytest.approx(np.full(len(S), 1.75))


def test_a_border_without_jumps_stays_as_it_is():
    wave = 1.75 + 0.02 * np.sin(S)
    assert led_over(S, wave, np.zeros(len(S), int)) is not wave and led_over(S, wave, np.zeros(len(S), int)) == pytest.approx(wave)


def lane(d, status, beside_one, rows=-1):
    """A lane from a grid station on, beside one line or between the two of `rows`."""
    count, sure = len(d), np.ones(len(d))
    return LaneTrack(0, np.array(d, float), np.full(count, 3.5), np.full(count, status), np.full(count, beside_one), *[np.full(count, rows)] * 4,
                     sure, sure, 1)


@pytest.mark.parametrize("metres", [3.0, 5.0])
def test_a_false_piece_of_line_moves_the_lane_behind_it_for_a_few_metres_alone(metres):
    piece, behind = lane([0.4] * int(metres / 0.5), MEASURED, False, 1), lane([0.0] * 120, INFERRED, True)
    track = _without_steps([piece, behind])
    assert track.d[:len(piece)] == pytest.approx(0.4, abs=0.01) and 0.2 < track.d[len(piece)] < 0.4
    assert track.d[len(piece) + 20:] == pytest.approx(0.0, abs=0.01) and track.aside == pytest.approx(track.d - np.r_[piece.d, behind.d])


def test_of_two_stretches_that_are_as_sure_as_each_other_both_give_way():
    track = _without_steps([lane([0.2] * 40, INFERRED, True), lane([-0.2] * 40, INFERRED, True)])
    assert track.d == pytest.approx(-track.d[::-1]) and np.abs(track.d[39:41]).max() < 0.15
    assert track.d[:20] == pytest.approx(0.2, abs=0.01)


def test_between_lines_that_are_seen_on_both_sides_of_a_joint_nothing_is_moved():
    parts = [lane([0.4] * 40, MEASURED, False, 1), lane([0.0] * 40, MEASURED, False, 1)]
    assert _without_steps(parts).d.tolist() == [0.4] * 40 + [0.0] * 40


def test_what_parts_two_lanes_goes_on_far_beyond_the_end_of_its_paint():
    track = _without_steps([lane([0.4] * 40, MEASURED, False, 1), lane([0.0] * 120, INFERRED, False)])
    assert track.d[40:80] == pytest.approx(0.38, abs=0.02) and (np.diff(track.d[40:]) < 0).all()


@pytest.mark.parametrize("beside_one, left", [(True, 80), (False, 120)])
def test_a_lane_beside_one_line_ends_where_it_is_less_probable_than_four_in_five(beside_one, left):
    count = len(S)
    unsure = np.arange(count) >= 80
    track = LaneTrack(0, np.zeros(count), np.full(count, 3.5), np.full(count, INFERRED), unsure & beside_one, np.full(count, 1), np.full(count, 2),
                      np.full(count, -1), np.full(count, -1), np.where(unsure, 0.7, 0.99), np.full(count, 0.5), 1)
    assert len(track.without_doubtful_ends()) == left


def test_a_short_piece_between_two_doubtful_stretches_is_in_doubt_and_has_no_second_reading_of_its_own():
    doubtful = lane(np.zeros(30), MEASURED, False)
    doubtful.aside[:10] = doubtful.aside[12:] = 0.5
    assert doubtful.in_doubt.all()
    assert doubtful.said(slice(10, 12))["other"] == "" and doubtful.said(slice(0, 10))["other"]
