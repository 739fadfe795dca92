"""What all lines of a road may be off by together goes into the confidence of its lanes."""

import numpy as np
from lanewright.core.markings.cross_section.weights import share_within


def test_lines_of_drives_that_differ_much_are_seldom_within_fifteen_centimetres():
    np.testing.assert_array_equal(share_within(np.array([0.0, 0.02, 0.15, 0.29])), [1.0, 1.0, 0.683, 0.395])
