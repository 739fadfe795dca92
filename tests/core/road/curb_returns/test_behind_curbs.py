"""Which lines lie behind a curb, on made steps (simulated)."""

import numpy as np
import pytest
from lanewright.core.road.curb_returns.classify import lies_behind
from lanewright.core.road.curb_returns.main_curbs import CurbLines
from lanewright.core.road.curb_returns.steps import PlanSteps

X = np.arange(0.0, 5.0, 0.25)
CURB = np.arange(-10.0, 20.0, 1.0)


def line(y, uphill):
    """Steps along x at a y, with the raised ground towards +y (1) or -y (-1)."""
    n = len(X)
    return PlanSteps(X, np.full(n, y), np.zeros(n), np.full(n, float(uphill)), *np.zeros((4, n)), *np.ones((2, n), np.int64))


def curb(y, uphill):
    """A curb along x; uphill is on the right of its direction."""
    x = CURB if uphill < 0 else CURB[::-1]
    return x, np.full(len(x), y)


@pytest.mark.parametrize("uphill", [1, -1])
def test_an_island_has_road_before_it_and_then_a_curb_that_rises(uphill):
    across_the_road = curb(-6.0 * uphill, -uphill)
    assert not lies_behind(line(0.0, uphill), CurbLines([across_the_road]))


@pytest.mark.parametrize("uphill", [1, -1])
def test_the_edge_of_a_ramp_on_a_sidewalk_lies_behind_the_curb_of_the_road(uphill):
    of_the_road, across_the_road = curb(-3.0 * uphill, uphill), curb(-10.0 * uphill, -uphill)
    assert lies_behind(line(0.0, uphill), CurbLines([across_the_road, of_the_road]))


def test_a_line_from_which_no_curb_is_seen_is_kept():
    assert not lies_behind(line(0.0, 1), CurbLines([]))
    assert not lies_behind(line(0.0, 1), CurbLines([curb(-40.0, 1)]))
    assert not lies_behind(line(0.0, 1), CurbLines([curb(3.0, 1)]))


def test_a_double_of_the_line_itself_hides_nothing():
    assert not lies_behind(line(0.0, 1), CurbLines([curb(-0.1, 1), curb(-6.0, -1)]))
