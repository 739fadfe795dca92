"""Curbs of a straight street, judged in intervals of 2 m."""

from collections import Counter

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory
from lanewright.products.assess.lines import BoundaryAccuracySettings, assess_boundaries, interval_lines
from shapely import MultiLineString, reverse
from shapely.affinity import translate
from shapely.geometry import LineString, box

LENGTH = 100.0


def curb(offset, first=0.0, last=LENGTH, height=10.0):
    return LineString([(first, offset, height), (last, offset, height)])


STREET = [curb(3.5), curb(-3.5)]


@pytest.fixture(scope="module")
def drive():
    x = np.arange(-4.0, LENGTH + 5.0, 0.5)
    zero = np.zeros(len(x))
    return build_frame(Trajectory(x / 10, x, zero - 1.5, zero + 12.0, zero, zero, zero))


@pytest.fixture(params=["along the trajectory", "along the reference"])
def frame(request, drive):
    return drive if request.param == "along the trajectory" else None


def counts(accuracy, side=None, tolerance=0.10):
    rates = (accuracy.total if side is None else accuracy.by_side[side])[tolerance].rates
    return rates.right, rates.false, rates.missed


def test_a_street_agrees_with_itself(frame):
    found = assess_boundaries(STREET, STREET, frame=frame)
    assert counts(found, tolerance=0.05) == (100, 0, 0)
    assert set(found.by_side) == {"left", "right"}
    assert found.total[0.05].lateral.maximum == pytest.approx(0.0, abs=1e-9)


def test_a_curb_7_cm_outside_is_wrong_at_5_cm_only(frame):
    found = assess_boundaries([curb(3.57), curb(-3.5, height=10.02)], STREET, frame=frame)
    assert counts(found, "left", 0.05) == (0, 50, 50)
    assert counts(found, "left", 0.10) == (50, 0, 0) and counts(found, "right", 0.05) == (50, 0, 0)
    assert found.by_side["left"][0.10].lateral.mean == pytest.approx(0.07, abs=1e-6)
    assert found.by_side["right"][0.10].height.rmse == pytest.approx(0.02, abs=1e-9)


def test_a_curb_that_was_not_found_is_missed_and_not_false(frame):
    found = assess_boundaries([curb(3.5), curb(-3.5, 40.0, LENGTH)], STREET, frame=frame)
    assert counts(found, "left") == (50, 0, 0) and counts(found, "right") == (30, 0, 20)


def test_a_line_where_there_is_no_curb_is_false(frame):
    found = assess_boundaries(STREET + [curb(12.0, 20.0, 40.0)], [curb(3.5, 60.0, LENGTH), curb(-3.5)], frame=frame)
    assert counts(found, "left")[0] == 20 and counts(found, "left")[2] == 0
    # along the trajectory an interval of a side is false once, however many lines are
    assert counts(found)[1] == pytest.approx(30 if frame else 40, abs=1)


def test_dropped_curbs_are_not_judged_found_or_not(frame):
    reference, dropped = [curb(3.5, 0.0, 40.0), curb(3.5, 60.0, LENGTH), curb(-3.5)], [curb(3.5, 40.0, 60.0)]
    for result in (STREET, [*reference]):
        found = assess_boundaries(result, reference, frame=frame, excluded=dropped, reasons=["dropped"])
        assert counts(found) == (90, 0, 0)
    why = Counter(found.intervals.excluded)
    assert why["excluded in the reference (dropped)"] >= 9


def test_outside_the_area_nothing_is_judged(frame):
    beyond = STREET + [curb(20.0)]
    found = assess_boundaries(beyond, STREET, frame=frame, area=box(-1, -5, 50.0, 5))
    assert counts(found) == (50, 0, 0)


def test_how_lines_are_drawn_does_not_matter(frame):
    other_software = [MultiLineString([curb(3.52, 0, 30), curb(3.52, 30, LENGTH)]), reverse(curb(-3.48))]
    flat = [LineString(np.asarray(part.coords)[:, :2]) for line in other_software for part in getattr(line, "geoms", [line])]
    found, plain = (assess_boundaries(result, STREET, frame=frame) for result in (other_software, flat))
    assert counts(found) == counts(plain) == (100, 0, 0)
    assert plain.total[0.10].height.count == 0 and found.total[0.10].height.count > 900


def test_where_the_survey_lies_does_not_matter(drive):
    found = assess_boundaries([curb(3.57), curb(-3.5, 40.0)], STREET)
    moved = [[translate(line, 500000.0, 5400000.0) for line in lines] for lines in ([curb(3.57), curb(-3.5, 40.0)], STREET)]
    assert counts(assess_boundaries(*moved)) == counts(found)


def test_the_sides_of_the_layer_count_where_there_is_no_trajectory():
    found = assess_boundaries([curb(3.5)], STREET, sides=["right", "left"])
    assert counts(found, "right") == (50, 0, 0) and counts(found, "left") == (0, 0, 50)


def test_a_single_line_has_no_side():
    assert set(assess_boundaries([curb(3.5)], [curb(3.5)]).by_side) == {""}


@pytest.mark.parametrize("result", [[], [curb(3.5, 0, 50)], [curb(3.6), curb(5.0, 10, 30)]])
def test_the_layer_shows_what_the_table_counts(frame, result):
    found = assess_boundaries(result, STREET, frame=frame)
    shown = Counter(outcome for outcome, _, _ in interval_lines(found, 0.05))
    assert (shown["correct"], shown["false"], shown["missed"]) == counts(found, tolerance=0.05)
    lines = [geometry for outcome, _, geometry in interval_lines(found, 0.05) if outcome in ("correct", "missed")]
    assert sum(line.length for line in lines) == pytest.approx(2 * LENGTH, abs=0.3)


def test_tolerances_that_cannot_be_meant_are_refused():
    with pytest.raises(RoadExtractionError, match="tolerances are 0.1, 5, 10; give .* from 0.001 to 2, such as 0.05"):
        BoundaryAccuracySettings(tolerances=(5, 10))
