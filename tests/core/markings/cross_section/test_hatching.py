"""The borders of hatched areas bound the lanes beside them."""

import tracemalloc

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.markings.cross_section.candidates import gather_boundaries
from lanewright.core.markings.cross_section.evidence import borders_of_hatching, hatched_areas
from lanewright.core.markings.cross_section.sections import sections_of_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lined_streets import HEIGHT, Street
from shapely.geometry import Polygon

S = np.arange(0.0, 120.0, 0.5)


def painted(street, areas):
    """MarkingObjects of what is painted as (first, last, right, left, class)."""
    layer = Features("PolygonZ", MARKINGS)
    for first, last, right, left, kind in areas:
        corners = street.places([first, last, last, first], [right, right, left, left])
        layer.add(Polygon(np.c_[corners, np.full(4, HEIGHT)]), **{"road": 0, "class": kind, "use": "other" if kind == "hatch" else "keep"})
    return MarkingObjects.from_features(layer, street.frame)


def borders(*areas):
    """(2, K) borders of the one hatched area of a street, painted as of `painted`."""
    street = Street(vehicle=0.0)
    found = borders_of_hatching(painted(street, areas), street.frame, 0, S)
    rows = found[np.arange(len(found)), :]
    # the borders beside the bars and those of the tips follow each other
    assert len(rows) % 2 == 0 and (np.isfinite(rows[::2]).sum(0) <= 1).all()
    return np.fmax.reduce(rows[::2]), np.fmax.reduce(rows[1::2])


def bars(right, left):
    return [(s, s + 0.5, right, left, "hatch") for s in np.arange(40.0, 80.0, 2.0)]


def test_the_border_is_the_middle_of_the_line_painted_along_the_bars():
    # bars end 15 cm before a border line of 12 cm on the left, and on the right reach into the middle of one of 30 cm
    left, right = borders(*bars(-1.0, 0.85), (35.0, 85.0, 0.94, 1.06, "edge"), (35.0, 85.0, -1.15, -0.85, "edge"))
    inside = (S > 42.0) & (S < 78.0)
    np.testing.assert_allclose(left[inside], 1.0, atol=0.01)
    np.testing.assert_allclose(right[inside], -1.0, atol=0.01)


def test_without_a_line_the_ends_of_the_bars_are_the_border():
    """Outlines of bars are of whole cells of 4 cm, so they lie 2 cm outside the paint."""
    left, right = borders(*bars(-1.02, 1.02))
    inside = (S > 42.0) & (S < 78.0)
    assert left[inside] == pytest.approx(0.94, abs=0.01) and right[inside] == pytest.approx(-0.94, abs=0.01)


def test_a_lane_line_farther_away_is_no_border():
    left, _ = borders(*bars(-1.0, 1.0), (35.0, 85.0, 1.9, 2.02, "lane"))
    assert np.nanmax(left) < 1.0


def test_outlines_of_the_areas_of_a_road_twice_as_long_take_twice_the_memory():
    most = []
    for length in (1500.0, 3000.0):
        street = Street(length=length, vehicle=0.0)
        markings = painted(street, [(s + step, s + step + 0.5, -1.0, 1.0, "hatch") for s in np.arange(20.0, length - 20.0, 40.0)
                                    for step in np.arange(0.0, 14.0, 1.5)])
        tracemalloc.start()
        areas = hatched_areas(markings, street.frame, 0)
        most.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert len(areas) == len(np.arange(20.0, length - 20.0, 40.0)) and all(np.ptp(area[:, 0]) < 15.0 for area in areas)
    assert most[1] < 2.5 * most[0]


@pytest.mark.parametrize("offset, leads", [(-0.5, True), (0.1, True), (4.5, False)])
def test_a_line_leads_over_an_area_that_lies_on_it_and_not_past_one_that_lies_aside(offset, leads):
    street = Street(vehicle=0.0).paint(3.5, kind="edge").paint(-3.5, kind="edge")
    for ends in ((5.0, 46.0), (74.0, 115.0)):
        street.paint(0.0, *ends, kind="centre", line=9)
    lines = sections_of_lines(PaintedLines.from_features(street.lines, street.frame))[0]
    markings = painted(street, [(s, s + 0.5, offset, offset + 1.0, "hatch") for s in np.arange(47.0, 73.0, 1.5)])
    found = gather_boundaries(lines, hatching=borders_of_hatching(markings, street.frame, 0, lines.s)).d
    gap = (lines.s > 48.0) & (lines.s < 72.0)
    centre, = (row for row in range(3) if abs(np.nanmedian(found[row, :])) < 0.1)
    assert np.isfinite(found[centre, :][gap]).all() == leads


def test_a_dashed_line_does_not_go_on_by_a_gap_over_the_hatched_area_that_it_ends_at():
    street = Street(vehicle=0.0).paint(3.5, kind="edge").paint(-3.5, kind="edge").paint(0.0, 5.0, 46.0, kind="centre", pattern="dashed")
    lines = sections_of_lines(PaintedLines.from_features(street.lines, street.frame))[0]
    centre, = (row for row in range(3) if abs(np.nanmedian(lines.d[row, :])) < 0.1)
    markings = painted(street, [(s, s + 0.5, -0.5, 0.5, "hatch") for s in np.arange(47.0, 73.0, 1.5)])
    ends = [np.nanmax(np.where(np.isfinite(gather_boundaries(lines, hatching=area).d[centre, :]), lines.s, np.nan))
            for area in (None, borders_of_hatching(markings, street.frame, 0, lines.s))]
    assert ends[0] > 53.0 and ends[1] < 48.0
