"""Which painted line goes on as which other is decided for all lines together."""

from lanewright.core.markings.lines.linking import assigned_links


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
