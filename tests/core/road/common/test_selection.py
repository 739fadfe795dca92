"""Which chains of steps are the curb along a road."""

import numpy as np
import pytest
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.tracking import StepChain, select_along_road


def selected(*stretches):
    """Numbers of the stretches (from, to, offset) that are selected; the track runs at offset 0."""
    parts = [np.arange(a, b + 0.01, 0.25) for a, b, _ in stretches]
    s, u = np.concatenate(parts), np.concatenate([np.full(len(part), u) for part, (_, _, u) in zip(parts, stretches)])
    ones = np.ones(len(s))
    steps = CurbSteps(profile=np.rint(s / 0.25).astype(int), s=s, u=u, h=0 * s, skew=0 * s, height=0.12 * ones, run=0 * s,
                      noise=0.003 * ones, scanner_noise=0.003 * ones, support=50 * ones, behind=20 * ones, hidden=0 * s)
    ends = np.cumsum([0] + [len(part) for part in parts])
    chains = [StepChain(np.arange(a, b), *stretch[:2]) for a, b, stretch in zip(ends[:-1], ends[1:], stretches)]
    return [part[0] for part in select_along_road(chains, steps, lambda station: 0.0)]


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("length", [2.0, 4.0, 8.0])
def test_a_curb_before_a_platform_is_followed_to_its_end(length, back):
    """The gap to the platform, 4 m nearer, is shorter with the last piece of the curb than without: that does not speak against it."""
    stretches = [(0.0, 10.0, 12.0), (14.0, 14.0 + length, 12.0), (35.0, 75.0, 8.0)]
    if back:
        stretches = [(75.0 - b, 75.0 - a, u) for a, b, u in stretches[::-1]]
    assert selected(*stretches) == [0, 1, 2]


@pytest.mark.parametrize("other", [(12.0, 16.0, 3.0), (12.0, 16.0, 4.6)], ids=["far aside", "aside"])
def test_what_lies_aside_in_a_gap_is_another_thing(other):
    assert selected((0.0, 11.0, 4.0), (11.5, 16.0, 7.0), (16.5, 30.0, 4.0)) == [0, 2]
    assert 1 not in selected((0.0, 30.0, 4.0), other)


@pytest.mark.parametrize("hidden", [30.0, 39.0, 41.0, 90.0])
def test_a_curb_goes_on_behind_parked_cars_however_long_their_row(hidden):
    assert selected((0.0, 20.0, 4.0), (20.0 + hidden, 24.5 + hidden, 4.0)) == [0, 1]
