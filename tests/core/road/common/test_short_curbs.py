"""Pieces of curb between parked cars: which of them are one."""

import numpy as np
import pytest
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.tracking import StepChain, drop_short_curbs


def kept(*stretches, aside=0.0, heights=None):
    """Numbers of the stretches (from, to) of a curb, of 12 cm or of `heights`, that are kept; the last one lies `aside`."""
    s = np.concatenate([np.arange(a, b + 0.01, 0.25) for a, b in stretches])
    last = s >= stretches[-1][0]
    ones = np.ones(len(s))
    height = 0.12 * ones
    for (a, b), of_stretch in zip(stretches, heights or []):
        height[(s >= a) & (s <= b + 0.01)] = of_stretch
    steps = CurbSteps(profile=np.rint(s / 0.25).astype(int), s=s, u=3.5 + aside * last, h=0 * s, skew=0 * s, height=height, run=0 * s,
                      noise=0.003 * ones, scanner_noise=0.003 * ones, support=50 * ones, behind=20 * ones, hidden=0 * s)
    chains = [StepChain(np.flatnonzero((s >= a) & (s <= b + 0.01)), a, b) for a, b in stretches]
    return [part[0] for part in drop_short_curbs([(k, a, b) for k, (a, b) in enumerate(stretches)], chains, steps)]


def test_short_pieces_near_each_other_make_a_curb():
    assert kept((0.0, 2.5), (8.0, 10.5)) == [0, 1]


@pytest.mark.parametrize("order", [1, -1])
def test_a_short_piece_some_way_from_a_curb_in_its_line_belongs_to_it(order):
    stretches = [(0.0, 6.0), (16.0, 18.5)] if order > 0 else [(0.0, 2.5), (12.0, 18.0)]
    assert kept(*stretches) == [0, 1]


@pytest.mark.parametrize(("stretches", "aside", "left"), [
    (((0.0, 2.5), (12.0, 14.5)), 0.0, []), (((0.0, 6.0), (16.0, 18.5)), 1.0, [0]), (((0.0, 6.0), (24.0, 26.5)), 0.0, [0]), (((0.0, 2.5),), 0.0, [])],
    ids=["neither is a curb", "not in its line", "too far away", "alone"])
def test_other_short_pieces_may_be_anything(stretches, aside, left):
    assert kept(*stretches, aside=aside) == left


def test_a_bollard_at_a_low_curb_is_no_curb_and_the_full_curb_between_two_drives_is_one():
    assert kept((0.0, 6.0), (6.5, 7.5), (8.0, 14.0), heights=[0.04, 0.25, 0.04]) == [0, 2]
    assert kept((0.0, 6.0), (6.5, 9.5), (10.0, 16.0), (16.5, 22.0), heights=[0.04, 0.12, 0.04, 0.12]) == [0, 1, 2, 3]
    assert kept((0.0, 6.0), (6.5, 7.5), heights=[0.04, 0.25]) == [0, 1], "at the end of a curb that is lowered it goes on in full height"
