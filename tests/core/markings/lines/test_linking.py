"""Which painted line goes on as which other is decided for all lines together."""

import numpy as np
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


def test_a_line_that_leads_aside_stays_one_line_where_wear_left_pieces_shorter_than_a_metre_of_it():
    """The outer line of a hairpin, which runs aside by one in seven: of such pieces none shows by itself which way it leads."""
    def strand(first, last):
        s = np.arange(first + 0.125, last, 0.25)
        return Strand(first, last, s, 5.0 + s / 7, np.zeros(len(s)), np.full(len(s), 9.0), 0.1, {"edge": last - first})

    strands = [strand(*ends) for ends in [(0.0, 0.9), (1.5, 2.4), (3.0, 3.9)]]
    assert len(link_lines([LinkedLine([one]) for one in strands], CommonTrend(strands), EdgesBeside([]), MarkingLineSettings().max_gap)) == 1
