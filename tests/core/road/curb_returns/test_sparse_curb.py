"""Lines of steps along the road where points lie too sparse for profiles, on made steps (simulated)."""

import numpy as np
import pytest
from lanewright.core.road.curb_returns.classify import CurbReturn, classify_curbs
from lanewright.core.road.curb_returns.detect import seen_once
from lanewright.core.road.curb_returns.main_curbs import SearchLimit
from lanewright.core.road.curb_returns.steps import PlanSteps
from lanewright.core.road.curb_returns.tracking import PlanStepChain
from lanewright.core.survey.frame.road import Road

LINE = Road(0, np.arange(0.0, 100.0, 0.1), np.zeros(1000), 0.0)


class Driven:
    """A pass along the reference line."""

    def at_station(self, s):
        return 0 * s, 0 * s


def kinds(first=40.0, last=60.0, y=14.0, uphill=1.0, known=(), falls=np.nan, elsewhere=(), usual=np.nan):
    """Kinds of what is found of a line of steps along x, with main curbs on its side at stations `known` (first, last)."""
    x = np.arange(first, last, 0.4)
    ones = np.ones(len(x))
    steps = PlanSteps(x, y * ones, 0 * x, uphill * ones, 0 * x, 0.15 * ones, 0 * x, 0.002 * ones, 12 * ones, 6 * ones)
    at = np.concatenate([np.arange(a, b, 1.0) for a, b in known] or [np.empty(0)])
    limits = {"left": SearchLimit(np.c_[at, np.full(len(at), 9.0), 0 * at, 0 * at + 1], 1), "right": SearchLimit(np.empty((0, 4)), -1)}
    runs = [("left", (np.arange(b, a, -1.0), np.full(len(np.arange(b, a, -1.0)), 9.0), np.zeros(len(np.arange(b, a, -1.0))))) for a, b in known]
    chain = PlanStepChain(np.arange(len(x))[::-1] if uphill > 0 else np.arange(len(x)))
    return [(curb.kind, curb.side) for curb in classify_curbs([chain], steps, falls * ones, runs, LINE, limits, [Driven()], usual, elsewhere)]


def test_where_far_and_wide_no_curb_is_known_it_is_the_roads_own():
    assert kinds() == [("main", "left")]
    assert kinds(y=-14.0, uphill=-1.0) == [("main", "right")]
    assert kinds(known=[(0.0, 30.0)]) == [("main", "left")]


@pytest.mark.parametrize("other", [
    dict(known=[(30.0, 70.0)]), dict(known=[(0.0, 44.0), (57.0, 90.0)], first=45.0, last=56.0, y=13.0), dict(last=43.0), dict(uphill=-1.0),
    dict(elsewhere=[(np.arange(30.0, 70.0), np.full(40, 14.1))])],
    ids=["behind a curb", "at a street's mouth", "too short", "it rises towards the road", "known already"])
def test_elsewhere_it_is_not(other):
    assert kinds(**other) == []


def test_where_the_ground_comes_down_again_it_is_an_island():
    assert kinds(falls=2.0) == [("island", "left")]


MOUTH = dict(known=[(0.0, 44.0), (57.0, 90.0)], first=45.0, last=56.0, y=13.0)


def test_what_is_as_high_as_the_curbs_of_the_road_is_one_of_them_and_the_edge_of_a_ramp_is_not():
    assert kinds(usual=0.15, **MOUTH) == kinds(usual=0.12, **MOUTH) == [("corner", "left")]
    assert kinds(usual=0.30, **MOUTH) == kinds(usual=0.08, **MOUTH) == kinds(**MOUTH) == []


def test_a_short_island_is_as_high_as_the_curbs_and_a_long_one_may_have_any_height():
    assert kinds(falls=2.0, last=43.0, usual=0.15) == kinds(falls=2.0, usual=0.30) == [("island", "left")]
    assert kinds(falls=2.0, last=43.0, usual=0.30) == []


def test_a_second_line_of_a_known_curb_is_no_corner():
    assert kinds(usual=0.15, elsewhere=[(np.arange(30.0, 70.0), np.full(40, 13.1))], **MOUTH) == []


@pytest.mark.parametrize("apart, left", [((True, True), [1, 0]), ((True, False), [0, 1]), ((False, True), [1, 0]), ((False, False), [1, 1])])
def test_a_piece_of_corner_that_two_roads_see_is_drawn_once(apart, left):
    x, ones = np.arange(0.0, 4.0, 0.4), np.ones(10)
    steps = PlanSteps(x, 0 * x, 0 * x, ones, 0 * x, 0.15 * ones, 0 * x, 0.002 * ones, 12 * ones, 6 * ones)
    roads = [[CurbReturn(steps, x, 0 * x, "left", "corner", apart=of_one)] for of_one in apart]
    assert [len(curbs) for curbs in seen_once(roads)] == left
