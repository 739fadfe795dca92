"""Which steps lie on top of an island, on made steps (simulated)."""

import numpy as np
import pytest
from lanewright.core.road.curb_returns.islands import GroundBehind, on_island_tops
from lanewright.core.road.curb_returns.steps import PlanSteps

NEAR = np.arange(0.0, 4.0, 0.4)   # x of the curb that is seen, at y = 0, of an island 3 m wide


def island_with(x, y, foot, height, grade=0.0):
    """Of steps at places, with feet above a road that rises by `grade` towards +y, whether each lies on the island."""
    many = len(NEAR) + len(x)
    columns = (np.r_[NEAR, x], np.r_[0.0 * NEAR, y], np.zeros(many), np.ones(many), np.r_[0.0 * NEAR, foot + grade * np.asarray(y)],
               np.r_[0.0 * NEAR + 0.12, height], *np.zeros((2, many)), *np.ones((2, many), np.int64))
    falls = np.r_[0.0 * NEAR + 3.0, np.full(len(x), np.nan)]
    found = on_island_tops(PlanSteps(*columns), GroundBehind(falls, np.full(many, np.nan), np.full(many, grade)))
    assert not found[:len(NEAR)].any()
    return found[len(NEAR):]


@pytest.mark.parametrize("grade", [-0.1, 0.0, 0.1])
def test_the_edges_of_a_ramp_in_an_island_lie_on_its_top(grade):
    x, y = [1.0, 1.3, 1.6], [1.2, 1.5, 1.8]
    assert island_with(x, y, np.full(3, 0.06), np.full(3, 0.06), grade).all()


def test_the_far_side_stands_on_the_road():
    assert not island_with([1.0, 2.0, 3.0], [2.9, 2.9, 2.9], np.zeros(3), np.full(3, 0.1)).any()


def test_a_curb_that_is_higher_than_what_lies_before_it_is_none_of_its_edges():
    assert not island_with([1.0, 2.0], [1.5, 1.5], np.full(2, 0.06), np.full(2, 0.15)).any()


def test_what_lies_beyond_the_island_or_beside_it_is_kept():
    assert not island_with([1.0, 8.0], [4.0, 1.5], np.full(2, 0.06), np.full(2, 0.06)).any()


def test_ground_that_stays_up_is_no_island():
    none = PlanSteps(*np.zeros((8, 3)), *np.ones((2, 3), np.int64))
    assert not on_island_tops(none, GroundBehind(*np.full((2, 3), np.nan), np.zeros(3))).any()
    assert not len(on_island_tops(PlanSteps.none(), GroundBehind(*np.empty((3, 0)))))
