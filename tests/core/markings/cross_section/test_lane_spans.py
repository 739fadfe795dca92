"""Which way a lane of the estimate leads."""

from dataclasses import replace

import numpy as np
from lanewright.core.markings.cross_section.estimate import lane_spans
from lanewright.core.markings.cross_section.roads import estimate_roads
from lanewright.core.markings.cross_section.sections import sections_of_lines
from lanewright.core.markings.cross_section.sequence import lane_strips
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lined_streets import Street


def read_as_one_way():
    """The estimate of a street with a double line between its two lanes, and where two lanes of one way are chosen instead."""
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(-3.5, kind="edge")
    street.paint(0.15, pattern="double-solid").paint(-0.15, pattern="double-solid")
    lines = PaintedLines.from_features(street.lines, street.frame)
    estimate = estimate_roads(sections_of_lines(lines), street.frame, 3.5, "right").roads[0].estimate
    strips, shape = lane_strips(estimate.sections), estimate.sections.cost.shape
    number, first = np.zeros((2, *shape))
    np.add.at(number, (strips.interval, strips.section), strips.number)
    np.add.at(first, (strips.interval, strips.section), strips.first)
    return estimate, np.argmin(np.where((number == 2) & (first == 0), estimate.sections.cost, np.inf), axis=1)


def ways(estimate, choice, unnamed):
    found = [span for span in lane_spans(replace(estimate, choice=choice, unnamed=unnamed)) if 4 <= span.interval < 8]
    return {span.direction for span in found}, min(span.directed for span in found)


def test_a_lane_nobody_drove_leads_the_way_that_is_more_probable():
    estimate, one_way = read_as_one_way()
    found, directed = ways(estimate, one_way, one_way)
    assert found == {1, -1} and directed > 0.5


def test_a_lane_leads_the_way_that_the_names_of_lines_decided():
    estimate, one_way = read_as_one_way()
    assert ways(estimate, one_way, estimate.unnamed)[0] == {1}
