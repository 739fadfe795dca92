"""A drive that was laid on another and goes on alone: moved on as where it left, and named."""

import numpy as np
import pytest
from drives import ahead, bend, chain, drive, joined
from lanewright.core.survey.adjustment.adjust import continued_corrections, places_of_one_drive, warning_of_one_drive
from lanewright.core.survey.adjustment.register import PassCorrections, PassOffsets
from lanewright.core.survey.frame.road_frame import build_frame

EAST, LEFT = 300, 700   # 0.1 mm by which the second drive was moved


def turning_off(compared_to=200.0):
    """A frame of a street driven on to its end, and once more with a turn into a side street; the corrections of their common part."""
    frame = build_frame(joined(drive(chain(ahead(400))), drive(chain(ahead(200), bend(12, 90), ahead(150)), start=2000.0)))
    both, first = {p.number: p for p in frame.passes if p.road == 0}, np.arange(5.0, compared_to, 10.0)
    assert len(both) == 2 and len(frame.roads) == 2
    nothing = np.zeros(len(first))
    moved = np.repeat([[EAST], [LEFT], [0]], 20, axis=1).astype(np.int16)
    return frame, PassCorrections({0: (5.0, -moved), 1: (5.0, moved)}), [PassOffsets(0, 1, first, nothing, nothing + 0.14, nothing, nothing[:0])]


def test_a_drive_that_turns_off_goes_on_as_it_was_moved_on_the_street():
    frame, moves, compared = turning_off()
    alone, = frame.passes_of(1)
    found = continued_corrections(frame, moves, compared)
    east, north, up = found.metres(alone.number, np.linspace(*alone.span, 9))
    np.testing.assert_allclose(east, 0.03)
    np.testing.assert_allclose(north, 0.07)
    assert not up.any()
    assert frame.pass_sigma[1].at(50.0) == pytest.approx(0.03, abs=0.003), "what it is moved by across the side street, which leads north"


def test_a_drive_between_two_streets_changes_evenly_from_one_correction_to_the_other():
    frame, moves, compared = turning_off()
    alone, = frame.passes_of(1)
    after = max(frame.passes, key=lambda p: p.number)
    following = type(after)(after.number + 1, 0, 1, alone.time[-1] + 0.02 + np.arange(50.0), *np.zeros((3, 50)), np.arange(50.0), np.zeros(50))
    frame.passes.append(following)
    moves.by_pass[following.number] = 0.0, np.repeat([[-100], [0], [0]], 9, axis=1).astype(np.int16)
    east = continued_corrections(frame, moves, compared).metres(alone.number, alone.s[[0, len(alone.s) // 2, -1]])[0]
    np.testing.assert_allclose(east, [0.03, 0.01, -0.01], atol=0.002)


def test_another_day_and_passes_that_agree_stay_where_they_were_measured():
    frame, moves, compared = turning_off()
    alone, = frame.passes_of(1)
    alone.time += 10.0
    assert set(continued_corrections(frame, moves, compared).by_pass) == {0, 1}
    alone.time -= 10.0
    agreeing = PassOffsets(alone.number, alone.number, *[np.array([5.0])] * 4, np.empty(0))
    assert set(continued_corrections(frame, moves, [*compared, agreeing]).by_pass) == {0, 1}


def test_what_one_drive_alone_shows_is_named_with_how_far_it_was_moved():
    frame, moves, compared = turning_off()
    whole = continued_corrections(frame, moves, compared)
    (start, end, metres), = places_of_one_drive(frame.passes_of(1), compared, whole)
    assert start <= 0.0 and end >= 140.0 and metres == pytest.approx(np.hypot(0.03, 0.07), abs=1e-4)
    (start, end, _), = places_of_one_drive(frame.passes_of(0), compared, whole)
    assert 200.0 <= start <= 220.0 and end >= 400.0, "the rest of the street, which the second drive left"
    assert "220 to 400 m (by up to 7.6 cm)" in warning_of_one_drive(0, [(220.0, 400.0, 0.0762)])
    assert warning_of_one_drive(0, []) == ""


def test_where_the_drives_lie_beside_each_other_nothing_is_named_but_where_none_can_be_compared():
    frame, moves, compared = turning_off(compared_to=100.0)
    (start, _, _), = places_of_one_drive(frame.passes_of(0), compared, moves)
    assert 110.0 <= start <= 120.0
