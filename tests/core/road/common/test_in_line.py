"""Short pieces of curb between parked cars: in line with the curb before and after them, or something else."""

import numpy as np
import pytest
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.in_line import with_pieces_in_line
from lanewright.core.road.common.tracking import StepChain, select_along_road

RADIUS = 120.0   # m, of the bend of the street


def street_with_a_piece(aside=0.0, above=0.0, height=0.04, piece=(30.0, 31.5)):
    """Steps of a curb seen to station 20 and from station 45 on, and of a piece between; their chains."""
    stretches = [(0.0, 20.0), piece, (45.0, 60.0)]
    s = np.concatenate([np.arange(a, b, 0.25) for a, b in stretches])
    between = (s >= piece[0]) & (s < piece[1])
    count = len(s)
    steps = CurbSteps(profile=np.rint(s / 0.25).astype(int), s=s, u=3.5 + aside * between, h=-0.07 + above * between, skew=np.zeros(count),
                      height=np.where(between, height, 0.04), run=np.zeros(count), noise=np.full(count, 0.003),
                      scanner_noise=np.full(count, 0.003), support=np.full(count, 50), behind=np.full(count, 20))
    chains = [StepChain(np.flatnonzero((s >= a) & (s < b)), a, s[s < b].max()) for a, b in stretches]
    return steps, chains


def on_a_bend(s, u):
    return (RADIUS + u) * np.sin(s / RADIUS), RADIUS - (RADIUS + u) * np.cos(s / RADIUS)


def chosen(steps, chains):
    return with_pieces_in_line([(0, 0.0, 19.75), (2, 45.0, 59.75)], chains, steps, on_a_bend)


def test_a_piece_between_parked_cars_in_line_with_the_curb_is_the_curb():
    assert [part[0] for part in chosen(*street_with_a_piece())] == [0, 1, 2]


@pytest.mark.parametrize("other", [dict(aside=-0.3), dict(above=0.25), dict(height=0.20), dict(piece=(30.0, 30.3))],
                         ids=["the foot of a wheel", "a bumper", "a high step", "two profiles"])
def test_what_is_not_in_line_with_the_curb_is_something_else(other):
    assert [part[0] for part in chosen(*street_with_a_piece(**other))] == [0, 2]


def test_a_piece_that_scatters_too_much_by_itself_is_the_curb_where_it_lies_in_line():
    steps, chains = street_with_a_piece()
    chains[1].weak = True
    assert [part[0] for part in chosen(steps, chains)] == [0, 1, 2]
    assert 1 not in [part[0] for part in select_along_road(chains, steps, lambda s: 0 * s)]


def test_nothing_is_added_before_the_first_or_behind_the_last_stretch():
    steps, chains = street_with_a_piece()
    assert with_pieces_in_line([(0, 0.0, 19.75)], chains, steps, on_a_bend) == [(0, 0.0, 19.75)]
    assert with_pieces_in_line([], chains, steps, on_a_bend) == []
