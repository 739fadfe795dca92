"""What hangs together by links."""

import numpy as np
import pytest
from lanewright.core.common.groups import linked_groups


@pytest.mark.parametrize("links,groups", [([], [0, 1, 2, 3]), ([(0, 2)], [0, 1, 0, 2]), ([(3, 1), (1, 2), (1, 2)], [0, 1, 1, 1])])
def test_dashes_linked_over_others_are_one_line_whichever_way_the_links_lead(links, groups):
    first, second = np.array(links, int).reshape(-1, 2).T
    assert linked_groups(first, second, 4).tolist() == groups
    assert linked_groups(second, first, 4).tolist() == groups
