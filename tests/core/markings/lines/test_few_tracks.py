"""Lines far off, of which each track of the scan shows one place of the width."""

import numpy as np
import pytest
from lanewright.core.markings.lines.fit import MarkingLineSettings
from lanewright.core.markings.lines.linking import CommonTrend, link_lines
from lanewright.core.markings.lines.strands import EdgesBeside, LinkedLine, painted_strands
from lanewright.core.survey.store.columns import Columns
from lanewright.core.survey.store.records import ROAD_POINT

EDGE = 0


def scanned(course, first, last, spacing, width=0.3, seed=1):
    """Points on a line whose middle is a function of station, on tracks along the road `spacing` m apart, 12 cm apart along them."""
    random, s, d = np.random.default_rng(seed), [], []
    for track in np.arange(-20.0, 0.0, spacing):
        at = np.arange(first, last, 0.12) + random.uniform(0, 0.12)
        on = np.abs(track + random.normal(0, 0.005, len(at)) - course(at)) < width / 2
        s, d = np.append(s, at[on]), np.append(d, np.full(on.sum(), track))
    records = np.zeros(len(s), ROAD_POINT)
    records["s"], records["d"], records["z"] = np.rint(s * 1e4), np.rint(d * 1e4), 15_000
    records["cluster"], records["spacing"] = 7, int(spacing * 1e3)
    return Columns.from_records(records)


def strands_of(records):
    return painted_strands(records, np.full(len(records), EDGE))


@pytest.mark.parametrize("spacing", [0.22, 0.28])
def test_a_slanting_line_far_off_is_one_strand_along_its_middle(spacing):
    course = lambda s: -8.0 - 0.03 * s    # noqa: E731
    strand, = strands_of(scanned(course, 0.0, 40.0, spacing))
    assert strand.length > 38.0 and strand.classes == {"edge": pytest.approx(strand.length)}
    inner = (strand.s > 3.0) & (strand.s < 37.0)
    assert np.abs(strand.d - course(strand.s))[inner].max() < 0.10
    assert np.polyfit(strand.s, strand.d, 1)[0] == pytest.approx(-0.03, abs=0.004)


def test_a_slanting_line_that_shows_on_one_track_after_the_other_is_one_line():
    """The edge line of an exit: each track enters it at one border and leaves it at the other."""
    strands = strands_of(scanned(lambda s: -8.0 - 0.065 * s, 0.0, 40.0, 0.4, width=0.27))
    assert len(strands) > 4
    assert len(link_lines([LinkedLine([strand]) for strand in strands], CommonTrend(strands), EdgesBeside([]), MarkingLineSettings().max_gap)) == 1


def test_a_worn_line_far_off_is_parted_where_a_stretch_is_gone():
    course = lambda s: np.full(np.shape(s), -8.1)    # noqa: E731
    records = scanned(course, 0.0, 40.0, 0.25)
    worn = (records["s"] > 180_000) & (records["s"] < 220_000)
    assert [round(strand.length) for strand in strands_of(records[~worn])] == [18, 18]


def test_a_line_scanned_closely_is_traced_place_by_place():
    """It swings by half a metre within 12 m, which no stiff middle line follows."""
    course = lambda s: -8.0 + 0.25 * np.sin(2 * np.pi * s / 12.0)    # noqa: E731
    records = scanned(course, 0.0, 40.0, 0.02, width=0.12)
    found = strands_of(records)
    assert max(np.abs(strand.d - course(strand.s)).max() for strand in found) < 0.04
