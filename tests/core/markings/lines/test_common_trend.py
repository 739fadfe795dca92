"""How all lines of a road change their offset together."""

import numpy as np
import pytest
from lanewright.core.markings.lines.linking import CommonTrend
from lanewright.core.markings.lines.strands import Strand


def strand(first, last, course):
    s = np.arange(first + 0.125, last, 0.25)
    return Strand(first, last, s, course(s), np.zeros(len(s)), np.full(len(s), 20.0), 0.15, {"edge": last - first})


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_a_line_along_a_taper_does_not_lead_the_others_aside_where_only_one_of_them_is_seen_with_it(side):
    """An edge line, the dashes of a lane line, and an edge line that makes room for an exit lane; the vehicle weaves."""
    def weaving(s):
        return 0.15 * np.sin(s / 20.0)

    def taper(s):
        return side * (-3.75 - 0.1 * np.clip(s - 40.0, 0.0, 35.0)) + weaving(s)

    strands = [strand(0.0, 150.0, lambda s: side * 3.75 + weaving(s)), strand(0.0, 150.0, taper)]
    strands += [strand(first, first + 6.0, weaving) for first in np.arange(0.0, 140.0, 18.0)]
    s = np.arange(2.0, 148.0)
    left_over = CommonTrend(strands).at(s) - weaving(s)
    assert np.ptp(left_over) < 0.05
