"""What frames a hatched area is no part of the line that leads up to it."""

import numpy as np
import pytest
from lanewright.core.markings.lines.selection import hatching_borders
from lanewright.core.markings.lines.strands import LinkedLine, Strand

BARS = np.array([(s, s + 0.4, 0.5, 1.4) for s in np.arange(24.5, 40.0, 1.5)])


def strand(first, last, begin, end):
    s = np.arange(first, last, 0.25)
    return Strand(first, last, s, np.interp(s, [first, last], [begin, end]), np.zeros(len(s)), np.full(len(s), 20.0), 0.12, {"centre": last - first})


def leading_up(aside):
    """A line, a short piece `aside` of it, and the line behind; the outline of the hatched area, which begins where the piece ends."""
    piece = strand(21.5, 23.0, aside, aside + 0.1)
    return piece, [LinkedLine([strand(5.0, 20.0, 0.0, 0.0), piece, strand(46.0, 80.0, 0.0, 0.0)]), LinkedLine([strand(23.5, 41.0, 0.5, 0.5)])]


def test_a_piece_too_short_for_bars_between_the_line_and_the_outline_is_of_the_outline():
    piece, lines = leading_up(0.2)
    assert hatching_borders(lines, BARS, []) == [piece]
    assert hatching_borders(lines[:1], BARS, [*lines[1].strands]) == [piece]


def test_a_piece_in_line_with_the_line_and_one_that_no_outline_goes_on_from_stay():
    assert hatching_borders(leading_up(0.0)[1], BARS, []) == []
    assert hatching_borders(leading_up(0.2)[1][:1], BARS, []) == []


@pytest.mark.parametrize("bars, found", [(BARS, True), (BARS + [0, 0, 4, 4], False), (BARS[:3], False), (BARS[:8], False)],
                         ids=["the tip", "an area elsewhere", "three bars", "an area that ends long before"])
def test_a_piece_of_border_behind_the_last_bar_is_none_of_the_line_that_goes_on_behind_the_area(bars, found):
    piece = strand(39.5, 42.0, 0.75, 0.45)
    line = LinkedLine([strand(5.0, 20.0, 0.0, 0.0), piece, strand(45.0, 80.0, 0.0, 0.0)])
    assert hatching_borders([line], bars, []) == ([piece] if found else [])


def test_without_hatching_no_strand_is_a_border():
    assert hatching_borders(leading_up(0.4)[1], np.empty((0, 4)), []) == []
