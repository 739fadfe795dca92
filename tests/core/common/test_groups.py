"""What hangs together by links."""

import numpy as np
import pytest
from lanewright.core.common.arrays import linked_groups, members_of


@pytest.mark.parametrize("links,groups", [([], [0, 1, 2, 3]), ([(0, 2)], [0, 1, 0, 2]), ([(3, 1), (1, 2), (1, 2)], [0, 1, 1, 1])])
def test_dashes_linked_over_others_are_one_line_whichever_way_the_links_lead(links, groups):
    first, second = np.array(links, int).reshape(-1, 2).T
    assert linked_groups(first, second, 4).tolist() == groups
    assert linked_groups(second, first, 4).tolist() == groups


@pytest.mark.parametrize("number", [[], [-1, -1], [0], [2, 0, 2, -1, 5, 0, 2]])
def test_the_members_of_all_groups_are_those_that_a_search_for_each_finds(number):
    number = np.array(number, int)
    found = list(members_of(number))
    assert [group for group, _ in found] == sorted(set(number[number >= 0].tolist()))
    for group, members in found:
        np.testing.assert_array_equal(members, np.flatnonzero(number == group))
