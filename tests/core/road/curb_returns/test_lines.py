"""Which lines of steps in plan belong together, and which free line is the corner between two dropped crossings."""

import numpy as np
import pytest
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.curb_returns.classify import is_curb_like, is_free_corner
from lanewright.core.road.curb_returns.main_curbs import CurbLines
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


def arc(radius=9.0, first=30.0, last=60.0, uphill_inside=True, wave=0.0):
    """Steps of the corner between a street along x, whose curb is y = 0 up to x = 0, and one along x = radius, with the sidewalk inside.

    first, last : degrees turned since the first curb; wave : m by which it is no circle
    """
    turned = np.radians(np.linspace(first, last, 16))
    off = radius + wave * np.sin(20 * turned)
    x, y = off * np.sin(turned), radius - off * np.cos(turned)
    inward = 1.0 if uphill_inside else -1.0
    nx, ny = -inward * np.sin(turned), inward * np.cos(turned)
    ones = np.ones(len(x))
    return PlanSteps(x, y, nx, ny, 0 * x, 0.12 * ones, 0 * x, 0.003 * ones, 50 * ones, 20 * ones)


def curbs(radius=9.0, gap=0.0):
    """The curbs of both streets, that far from the tangent points of the corner."""
    away = np.arange(gap, gap + 10.0, 0.5)
    return [(-away, 0 * away), (np.full(len(away), radius), radius + away)]


def test_a_corner_between_two_dropped_crossings_bends_from_one_curb_to_the_other():
    assert is_free_corner(arc(), CurbLines(curbs()))
    assert is_free_corner(arc(), CurbLines(curbs(gap=2.0)))


@pytest.mark.parametrize(("line", "ends"), [
    (arc(), curbs()[:1]), (arc(), []), (arc(uphill_inside=False), curbs()), (arc(wave=0.15), curbs()), (arc(), curbs(gap=6.0)),
    (arc(first=44.0, last=48.0), curbs())], ids=["one curb", "no curb", "a basin", "uneven", "too far", "too short to bend"])
def test_what_does_not_bend_evenly_from_curb_to_curb_is_no_corner(line, ends):
    assert not is_free_corner(line, CurbLines(ends))


def test_two_steps_are_no_line():
    x = np.array([0.0, 0.4, 0.8, 1.2])
    ones = np.ones(4)
    steps = PlanSteps(x, 0 * x, 0 * x, ones, 0 * x, 0.12 * ones, 0 * x, 0.003 * ones, 50 * ones, 20 * ones)
    assert is_curb_like(PlanStepChain(np.arange(4)), steps, 0.003 * ones, CurbSettings())
    assert not is_curb_like(PlanStepChain(np.array([0, 3])), steps, 0.003 * ones, CurbSettings())
