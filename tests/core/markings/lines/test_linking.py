"""Which painted line goes on as which other is decided for all lines together."""

import numpy as np
import pytest
import shapely
from lanewright.core.markings.lines.fit import MarkingLineSettings
from lanewright.core.markings.lines.linking import CommonTrend, assigned_links, link_lines
from lanewright.core.markings.lines.strands import EdgesBeside, LinkedLine, Strand


def test_a_good_link_gives_way_where_two_lines_would_else_lose_theirs():
    # line 0 fits best to line 2, but line 1 fits to nothing else
    assert assigned_links([(0.1, 0, 2), (0.5, 0, 3), (0.4, 1, 2)]) == {0: 3, 1: 2}


def test_of_two_that_compete_for_one_the_nearer_is_linked():
    assert assigned_links([(0.3, 0, 5), (0.2, 1, 5)]) == {1: 5}


def test_links_do_not_depend_on_the_order_of_the_lines():
    pairs = [(0.1, 0, 4), (0.6, 0, 5), (0.9, 1, 4), (0.2, 2, 6), (0.7, 3, 6), (1.5, 3, 7)]
    assert assigned_links(pairs) == assigned_links(pairs[::-1]) == {0: 5, 1: 4, 2: 6, 3: 7}


def test_without_pairs_there_are_no_links():
    assert assigned_links([]) == {}


def strand(first, last, course):
    """A piece of line along a course d(s)."""
    s = np.arange(first + 0.125, last, 0.25)
    return Strand(first, last, s, course(s), np.zeros(len(s)), np.full(len(s), 9.0), 0.1, {"edge": last - first})


def linked(strands, edges=EdgesBeside([])):
    return link_lines([LinkedLine([one]) for one in strands], CommonTrend(strands), edges, MarkingLineSettings().max_gap)


def test_a_line_that_leads_aside_stays_one_line_where_wear_left_pieces_shorter_than_a_metre_of_it():
    """The outer line of a hairpin, which runs aside by one in seven: of such pieces none shows by itself which way it leads."""
    assert len(linked([strand(*ends, lambda s: 5.0 + s / 7) for ends in [(0.0, 0.9), (1.5, 2.4), (3.0, 3.9)]])) == 1


def test_the_last_dash_is_of_its_line_where_the_lines_of_the_other_carriageway_lead_away():
    """Four dashes 9 m apart; beyond a median without paint, five lines turn away by one in fourteen, and are painted between the dashes too."""
    dashes = [strand(first, first + 3.0, lambda s: 1.5 + 0.0 * s) for first in (0.0, 12.0, 24.0, 36.0)]
    others = [strand(*ends, lambda s, far=far: far - 0.07 * s) for far in (12.0, 15.0, 18.0, 21.0, 24.0) for ends in ((0.0, 28.0), (33.0, 36.0))]
    assert max(len(line.strands) for line in linked([*dashes, *others]) if line.strands[0] in dashes) == len(dashes)


@pytest.mark.parametrize("aside, lines", [(0.0, 2), (2.0, 1)])
def test_a_line_ends_at_an_island_and_goes_on_past_one_that_lies_beside_it(aside, lines):
    island = EdgesBeside([], [shapely.get_coordinates(shapely.box(13.0, aside - 0.8, 19.0, aside + 0.8))])
    assert len(linked([strand(0.0, 12.0, np.zeros_like), strand(20.0, 40.0, np.zeros_like)], island)) == lines
