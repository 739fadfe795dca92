"""Short pieces of curb between parked cars: in line with the curb before and after them, or something else."""

import numpy as np
import pytest
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.tracking import StepChain, with_pieces_in_line

RADIUS = 120.0   # m, of the bend of the street


def street_with_a_piece(aside=0.0, above=0.0, height=0.04, piece=(30.0, 31.5)):
    """Steps of a curb seen to station 20 and from station 45 on, and of a piece between; their chains."""
    stretches = [(0.0, 20.0), piece, (45.0, 60.0)]
    s = np.concatenate([np.arange(a, b, 0.25) for a, b in stretches])
    between = (s >= piece[0]) & (s < piece[1])
    count = len(s)
    steps = CurbSteps(profile=np.rint(s / 0.25).astype(int), s=s, u=3.5 + aside * between, h=-0.07 + above * between, skew=np.zeros(count),
                      height=np.where(between, height, 0.04), run=np.zeros(count), noise=np.full(count, 0.003),
                      scanner_noise=np.full(count, 0.003), support=np.full(count, 50), behind=np.full(count, 20), hidden=np.zeros(count))
    chains = [StepChain(np.flatnonzero((s >= a) & (s < b)), a, s[s < b].max()) for a, b in stretches]
    return steps, chains


def on_a_bend(s, u):
    return (RADIUS + u) * np.sin(s / RADIUS), RADIUS - (RADIUS + u) * np.cos(s / RADIUS)


def chosen(steps, chains):
    """(first, last station) of the stretches that are curb where the two longer ones were chosen."""
    found = with_pieces_in_line([(0, 0.0, 19.75), (len(chains) - 1, 45.0, 59.75)], chains, steps, on_a_bend)
    return [(float(steps.s[members[0]]), float(steps.s[members[-1]])) for members in found]


ENDS = [(0.0, 19.75), (45.0, 59.75)]


def with_piece(start, end):
    return [ENDS[0], (start, end), ENDS[1]]


def test_a_piece_between_parked_cars_in_line_with_the_curb_is_the_curb():
    assert chosen(*street_with_a_piece()) == with_piece(30.0, 31.25)


@pytest.mark.parametrize("other", [dict(aside=-0.3), dict(above=0.25), dict(height=0.20), dict(piece=(30.0, 30.3))],
                         ids=["the foot of a wheel", "a bumper", "a high step", "two profiles"])
def test_what_is_not_in_line_with_the_curb_is_something_else(other):
    assert chosen(*street_with_a_piece(**other)) == ENDS


def test_a_piece_is_the_curb_whether_its_steps_were_linked_to_a_chain_or_not():
    steps, chains = street_with_a_piece()
    assert chosen(steps, [chains[0], chains[2]]) == with_piece(30.0, 31.25)


def test_near_the_end_of_a_gap_a_piece_keeps_to_the_line_more_closely_than_far_from_it():
    # 6 cm aside
    assert chosen(*street_with_a_piece(aside=0.06, piece=(30.0, 31.5))) == with_piece(30.0, 31.25)
    assert chosen(*street_with_a_piece(aside=0.06, piece=(20.5, 22.0))) == ENDS


def test_a_step_that_leads_across_the_line_is_no_piece_of_it():
    steps, chains = street_with_a_piece(piece=(30.0, 34.0))
    own = chains[1].steps
    steps.u[own] += 0.06 * (steps.s[own] - 32.0)
    assert chosen(steps, chains) == ENDS


def test_nothing_is_looked_for_where_points_are_joined_anyway():
    steps, chains = street_with_a_piece()
    kept = [(0, 0.0, 19.75), (1, 22.0, 31.25)]
    assert len(with_pieces_in_line(kept, chains, steps, on_a_bend)) == 2


def test_nothing_is_added_before_the_first_or_behind_the_last_stretch():
    steps, chains = street_with_a_piece()
    assert [len(members) for members in with_pieces_in_line([(0, 0.0, 19.75)], chains, steps, on_a_bend)] == [80]
    assert with_pieces_in_line([], chains, steps, on_a_bend) == []
