"""Which lines of steps in plan belong together, and which are like a curb."""

import numpy as np
import pytest
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.curb_returns.classify import is_curb_like
from lanewright.core.road.curb_returns.steps import PlanSteps
from lanewright.core.road.curb_returns.tracking import PlanStepChain, group_lines


def straight(start, end, y=0.0, h=0.0):
    x = np.arange(start, end, 0.3)
    return x, np.full(len(x), y), np.full(len(x), h)


def test_a_curb_that_goes_on_straight_behind_a_crossing_is_the_same_line():
    assert len(set(group_lines([straight(0, 20), straight(30, 40)]))) == 1


def test_a_line_that_begins_beside_the_end_of_a_curb_is_the_same_line():
    assert len(set(group_lines([straight(0, 20), straight(19.3, 30)]))) == 1


@pytest.mark.parametrize("other", [straight(30, 40, y=1.0), straight(40, 50), straight(30, 31), straight(30, 40, h=0.3)],
                         ids=["aside", "too far", "too short for a direction", "higher"])
def test_a_line_elsewhere_is_another(other):
    assert len(set(group_lines([straight(0, 20), other]))) == 2


def test_two_steps_are_no_line():
    x = np.array([0.0, 0.4, 0.8, 1.2])
    ones = np.ones(4)
    steps = PlanSteps(x, 0 * x, 0 * x, ones, 0 * x, 0.12 * ones, 0 * x, 0.003 * ones, 50 * ones, 20 * ones)
    assert is_curb_like(PlanStepChain(np.arange(4)), steps, 0.003 * ones, CurbSettings())
    assert not is_curb_like(PlanStepChain(np.array([0, 3])), steps, 0.003 * ones, CurbSettings())
