"""Places at which passes still differ are named with how much."""

import numpy as np
from lanewright.core.survey.adjustment.adjust import remaining_places, solve_corrections, warning_of_places
from lanewright.core.survey.adjustment.register import PassOffsets

STATIONS = np.arange(5.0, 300.0, 10.0)
NOTHING = np.zeros(len(STATIONS))


def apart(left, far=()):
    return [PassOffsets(0, 1, STATIONS, NOTHING, left, NOTHING, np.array(far, float))]


def test_passes_that_the_corrections_bring_together_leave_no_place():
    offsets = apart(0.08 + 0.0002 * STATIONS)
    assert remaining_places(offsets, solve_corrections(offsets)) == []
    assert warning_of_places(0, []) == ""


def test_an_offset_that_jumps_is_named_where_it_jumps():
    left = NOTHING + 0.02
    left[9:11] = 0.25
    offsets = apart(left)
    (start, end, metres), = remaining_places(offsets, solve_corrections(offsets))
    assert 80.0 <= start <= 90.0 and 110.0 <= end <= 120.0 and 0.1 < metres < 0.24
    said = warning_of_places(2, [(90.0, 110.0, 0.213)])
    assert "90 to 110 m (up to 21.3 cm remain)" in said and "Road 2" in said


def test_a_jump_that_the_corrections_follow_is_named_where_it_is_as_it_is_evened_out_over_ten_metres():
    offsets = apart(np.where(STATIONS > 150.0, 0.16, 0.0))
    (start, end, metres), = remaining_places(offsets, solve_corrections(offsets))
    assert (start, end) == (140.0, 160.0) and 0.05 < metres < 0.09
    slow = apart(0.0015 * STATIONS)
    assert remaining_places(slow, solve_corrections(slow)) == [], "a drift of 15 mm in 10 m is none"


def test_where_they_lie_too_far_apart_is_said_by_place():
    places = remaining_places(apart(NOTHING, far=(25.0, 35.0, 105.0)), {})
    assert places == [(20.0, 40.0, np.inf), (100.0, 110.0, np.inf)]
    assert "20 to 40 m (more than 30 cm apart" in warning_of_places(0, places)


def test_unknown_offsets_are_no_place_and_many_places_are_counted():
    assert remaining_places(apart(np.full(len(STATIONS), np.nan)), {}) == []
    places = remaining_places(apart(np.where(np.arange(len(STATIONS)) % 2, 0.1, 0.0)), {})
    assert "at 3 further places" in warning_of_places(0, places)
