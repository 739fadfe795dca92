"""Streets that can be read in two ways, of which an analyst takes the second."""

import json
from dataclasses import replace

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CORRECTIONS, Features
from lanewright.core.corrections.apply import correct_lanes, correct_marking_lines
from lanewright.core.corrections.corrections import corrections_from_features, taken_reading
from lanewright.core.curves.model_selection import fit_curve
from lanewright.core.driving.driving_lines import estimate_lanes, make_driving_lines
from lanewright.core.markings.lines.fit import named_by_estimate
from lanewright.core.markings.lines.painted_lines import PaintedLines, painted_lines_of
from lined_streets import Street

NOTHING = np.empty((0, 3))


def run(street, corrections=None):
    """The layers of driving lines and lanes, and the corrections, of a run."""
    wanted = corrections_from_features(Features("any", CORRECTIONS) if corrections is None else corrections, street.frame)
    painted = PaintedLines.from_features(street.lines, street.frame)
    estimates = estimate_lanes(painted, street.frame, taken=wanted.taken(street.frame))
    lines, elements, lanes = make_driving_lines(painted, street.frame, estimates=estimates)
    lines, _, lanes = correct_lanes(lines, elements, lanes, street.frame, wanted, 3.5, NOTHING)
    return lines.to_features(street.frame), lanes.to_features(street.frame), wanted


def take(lines, which):
    """The layer of a correction that takes the second reading of a driving line."""
    layer = Features("any", CORRECTIONS)
    line, row = next((line, row) for line, row in lines if which(row))
    layer.add(line, **taken_reading(row, "lane"), note="looked at on the photograph")
    return layer


def lanes_of(street, lines):
    return sorted((round(float(np.median(street.offsets(line))), 2), row["direction"], row["status"], row["confidence"]) for line, row in lines)


def test_one_lane_of_seven_metres_is_taken_in_place_of_two():
    street = Street(vehicle=-0.5).paint(3.5, kind="edge").paint(-3.5, kind="edge")
    lines, _, _ = run(street)
    assert len(lines) == 2
    lines, lanes, corrections = run(street, take(lines, lambda row: row["direction"] < 0))
    assert lanes_of(street, lines) == [(pytest.approx(0.0, abs=0.02), 1, "accepted", 1.0)]
    assert not corrections.unmatched and lines.rows[0]["other"] is None
    row, = lanes.rows
    assert (row["left_line"], row["right_line"], row["status"]) == ("line 1", "line 2", "accepted"), "the estimate made it, between its lines"


def test_the_other_direction_is_taken_for_a_lane_that_nobody_drove():
    street = Street(length=100.0, vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, kind="", pattern="dashed").paint(-3.5, kind="edge")
    lines, _, _ = run(street)
    lines, lanes, corrections = run(street, take(lines, lambda row: row["direction"] < 0))
    assert [lane[:3] for lane in lanes_of(street, lines)] == [(-1.75, 1, "measured"), (1.75, 1, "accepted")]
    assert {row["direction"] for row in lanes.rows} == {1} and not corrections.unmatched
    assert {row["left_kind"] for row in lanes.rows} == {"lane", "edge"}, "the dashes part lanes of one direction now"


def test_a_reading_that_the_estimate_cannot_make_any_more_is_drawn():
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, kind="centre").paint(-3.5, kind="edge")
    lines, _, _ = run(street)
    oncoming = next(row for row in lines.rows if row["direction"] < 0)
    oncoming["other"] = json.dumps({"nats": 1.0, "lanes": [{"offset_m": 5.9, "width_m": 2.8, "direction": -1}]})
    lines, lanes, corrections = run(street, take(lines, lambda row: row["direction"] < 0))
    assert lanes_of(street, lines)[1] == (pytest.approx(5.9 - 1.75, abs=0.02), -1, "drawn", 1.0)
    assert len(lines) == 2 and not corrections.unmatched
    assert next(row["width_m"] for row in lanes.rows if row["direction"] < 0) == pytest.approx(2.8, abs=0.01)


def test_where_the_second_reading_is_no_lane_the_lane_goes():
    street = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, kind="centre").paint(-3.5, kind="edge")
    lines, _, _ = run(street)
    next(row for row in lines.rows if row["direction"] < 0)["other"] = json.dumps({"nats": 1.0, "lanes": []})
    lines, _, corrections = run(street, take(lines, lambda row: row["direction"] < 0))
    assert {row["direction"] for row in lines.rows} == {1} and not corrections.unmatched


@pytest.mark.parametrize("other", [
    None, "", "[]", '{"lanes": [{"offset_m": 1.0}]}', '{"lanes": [{"offset_m": 1, "width_m": -3, "direction": 1}]}', "{"])
def test_a_row_that_takes_nothing_is_refused_by_its_number(other):
    layer = Features("any", CORRECTIONS)
    layer.add(None, action="take", target="lane", road=0, station_m=50.0, offset_m=0.0, other=other)
    with pytest.raises(RoadExtractionError, match="Row 1 of the corrections is to take a second reading of a lane"):
        corrections_from_features(layer, Street().frame)


def test_a_piece_without_a_second_reading_has_none_to_take():
    assert taken_reading({"other": None}, "lane") is None and taken_reading({}, "lane") is None


def named(street, lines=None):
    """The marking lines of a street with the kinds that its estimate gives them, as a run fits and names them."""
    if lines is None:
        read = PaintedLines.from_features(street.lines, street.frame)
        lines = painted_lines_of([
            dict(road=0, line=int(read.line[k]), kind="", pattern=read.pattern[k], status="measured", curve=fit.curve,
                 arc=np.ravel(fit.curve.project(places[[0, -1], 0], places[[0, -1], 1])[0]), places=places, station=5.0, end=95.0, offset=0.0,
                 width=0.12, rmse=0.005)
            for k in range(len(read)) for places in [np.c_[read.course.x, read.course.y, read.course.z][read.course.line(k)]]
            for fit in [fit_curve(places[:, 0], places[:, 1])]], street.frame, "")
    return named_by_estimate(lines, estimate_lanes(lines, street.frame))


def test_dashes_may_part_lanes_of_one_direction_and_that_is_taken():
    street = Street(length=100.0, vehicle=-1.75).paint(3.5, kind="").paint(0.0, kind="", pattern="dashed").paint(-3.5, kind="")
    lines = named(street)
    assert lines.kind.tolist() == ["edge", "centre", "edge"]
    layer = lines.to_features(street.frame)
    assert [row["other"] is None for row in layer.rows] == [True, False, True]
    assert json.loads(layer.rows[1]["other"])["kind"] == "lane"
    corrections = Features("any", CORRECTIONS)
    corrections.add(layer.geometries[1], **taken_reading(layer.rows[1], "marking"))
    wanted = corrections_from_features(corrections, street.frame)
    again = named(street, correct_marking_lines(lines, street.frame, wanted, NOTHING))
    assert again.kind.tolist() == ["edge", "lane", "edge"] and again.status.tolist() == ["measured", "accepted", "measured"]
    assert not wanted.unmatched and not any(again.other)


def test_what_a_solid_line_between_two_lanes_parts_is_sure():
    lines = named(Street(length=100.0, vehicle=-1.75).paint(3.5, kind="").paint(0.0, kind="").paint(-3.5, kind=""))
    assert lines.kind.tolist() == ["edge", "centre", "edge"] and not any(lines.other)


def test_the_name_of_a_line_tells_directions_where_an_analyst_confirmed_it_and_not_where_the_fit_gave_it():
    street = Street(length=100.0, vehicle=-1.75).paint(3.5, kind="").paint(0.0, kind="", pattern="dashed").paint(-3.5, kind="")
    lines = named(street)

    def oncoming(lines):
        found, *_ = make_driving_lines(lines, street.frame)
        return next(row for _, row in found.to_features(street.frame) if row["direction"] < 0)

    unnamed = oncoming(replace(lines, kind=np.full(3, "", object)))
    assert json.loads(unnamed["other"])["lanes"] and oncoming(lines) == unnamed
    sure = oncoming(replace(lines, status=np.array(["measured", "accepted", "measured"], object)))
    assert sure["other"] is None and sure["confidence"] > unnamed["confidence"]


@pytest.mark.parametrize("confirmed", [(5.0, 30.0), (70.0, 95.0)])
@pytest.mark.parametrize("gap", [0.0, 3.0])
def test_the_name_that_an_analyst_gave_part_of_a_line_counts_at_whichever_end_that_lies(confirmed, gap):
    """The parts are pieces of one line, or lines that go on as the next."""
    street = Street(length=100.0, vehicle=-1.75).paint(3.5, kind="").paint(-3.5, kind="")
    for first, last in ((5.0, 30.0), (30.0 + gap, 70.0 - gap), (70.0, 95.0)):
        kind = "centre" if (first, last) == confirmed else ""
        street.paint(0.0, first, last, kind=kind, pattern="dashed", line=None if gap else 3)
    oncoming = max((row for row in street.lanes()[0].rows if row["direction"] < 0), key=lambda row: row["end_m"] - row["station_m"])
    assert oncoming["other"] is None and oncoming["confidence"] > 0.9


@pytest.mark.parametrize("status, told", [("bridged", ""), ("drawn", "centre"), ("accepted", "centre")])
def test_a_piece_that_a_fitted_line_bridges_was_not_named_by_hand(status, told):
    lines = named(Street(length=100.0).paint(3.5, kind="").paint(0.0, kind="").paint(-3.5, kind=""))
    lines = replace(lines, kind=np.full(3, "centre", object), line=np.array([1, 2, 2]), rmse=np.array([0.01, 0.01, np.nan]),
                    status=np.array(["measured", "measured", status], object))
    assert lines.told.tolist() == ["", "", told]
