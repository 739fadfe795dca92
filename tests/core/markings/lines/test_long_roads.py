"""Lines of a long road are compared with what lies beside them, not with all lines of the road."""

from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from counted_calls import calls
from lanewright.core.markings.lines import fit
from lanewright.core.markings.lines.linking import CommonTrend, StretchLookup, link_lines, link_over_long_gaps
from lanewright.core.markings.lines.selection import same_dash_pattern, select_lines
from lanewright.core.markings.lines.strands import EdgesBeside, LinkedLine, Strand

BLOCK = 100.0   # m from one junction to the next
FEW, MANY = 10, 40


def strand(first, last, d, kind="lane"):
    s = np.arange(first + 0.1, last, 0.25)
    return Strand(first, last, s, np.full(len(s), d), np.zeros(len(s)), np.full(len(s), 20.0), 0.12, {kind: last - first})


def strands_of(blocks):
    """Edge lines with a worn hole, dashes, a double line before the junction and the border of a hatched area, in every block."""
    found = []
    for at in (BLOCK * np.arange(blocks)).tolist():
        for side in (-1, 1):
            found += [strand(at + 5, at + 30, 3.5 * side, "edge"), strand(at + 42, at + 80, 3.5 * side, "edge")]
            found.append(strand(at + 60, at + 80, 0.15 * side))
        found += [strand(at + first, at + first + 3, 0.0) for first in range(6, 54, 9)]
        found += [strand(at + 60, at + 78, -2.0), strand(at + 20, at + 23, 1.2)]
    return sorted(found, key=lambda one: (one.first, one.d[0]))


def found_in(blocks):
    strands = strands_of(blocks)
    edges = EdgesBeside([], hatched=[shapely.get_coordinates(shapely.box(at + 60.0, -3.4, at + 78.0, -2.1)) for at in BLOCK * np.arange(blocks)])
    trend = CommonTrend(strands)
    lines = link_over_long_gaps(link_lines([LinkedLine([one]) for one in strands], trend, edges, 13.0), trend, edges, 13.0, 30.0, same_dash_pattern)
    return select_lines(lines, trend, 4.0, edges)


def test_two_streets_end_to_end_give_the_lines_of_each():
    def stretches(blocks):
        return np.array(sorted((*one.span, np.median(one.line.places[1]), "double" in one.pieces[0].pattern) for one in found_in(blocks)))

    one, two = stretches(1), stretches(2)
    assert len(one) == 5 and one[:, 3].sum() == 2   # without the border of the hatched area and the single dash
    np.testing.assert_allclose(two, np.concatenate([one, one + [BLOCK, BLOCK, 0, 0]]), atol=1e-6)


def test_four_times_the_road_takes_four_times_the_calls():
    few, many = (calls(partial(found_in, blocks)) for blocks in (FEW, MANY))
    assert many < 1.15 * MANY / FEW * few


@pytest.mark.parametrize("first, last", [(0.0, 0.0), (35.2, 36.0), (-50.0, 500.0), (99.9, 100.0), (700.0, 800.0)])
def test_what_reaches_into_a_stretch_of_road_is_looked_up(first, last):
    rng = np.random.default_rng(3)
    begin = rng.uniform(-20.0, 300.0, 200)
    end = begin + rng.choice([0.5, 3.0, 120.0], 200)
    assert StretchLookup(begin, end).between(first, last).tolist() == np.flatnonzero((begin <= last) & (end >= first)).tolist()
    assert StretchLookup(begin[:0], end[:0]).between(first, last).tolist() == []


def test_a_line_of_a_long_road_among_many_lines_is_named_by_what_it_separates(monkeypatch):
    """60,000 stretches of a road with the 40,000th line of a survey; before, it had no name."""
    intervals, number = 60_000, 40_000
    monkeypatch.setattr(fit, "separated_kinds", lambda sections: np.full((intervals, 1, 1), fit.LANE_LINE))
    boundaries = SimpleNamespace(painted=np.ones((intervals, 1), bool), rows=np.zeros((intervals, 1, 2), int),
                                 first=np.arange(intervals), last=np.arange(intervals))
    estimate = SimpleNamespace(candidates=boundaries, sections=None, choice=np.zeros(intervals, int), second=np.zeros((intervals, 1)))
    road = SimpleNamespace(estimate=estimate, lines=SimpleNamespace(number=np.full((1, intervals), number, np.int32)))
    assert fit._kinds_of_lines(SimpleNamespace(roads={0: road})) == ({number: "lane"}, {})
