"""Lanes that two roads of a survey see on the same asphalt are drawn once."""

import numpy as np
import pytest
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lined_streets import EAST, NORTH, Street
from shapely import get_coordinates, linestrings


def six_lanes(first=0.0, last=120.0, **shape):
    """Three lanes each way with a solid line between, driven in the outer lanes, 17 m apart, so that they are two roads.

    The first road sees all lines, the second one those from `first` to `last` m east.
    """
    street = Street(vehicle=-1.75, again=(15.75,), **shape).paint(-3.5, kind="edge").paint(17.5, kind="edge").paint(7.0)
    for offset in (0.0, 3.5, 10.5, 14.0):
        street.paint(offset, pattern="dashed")
    assert len(street.frame.roads) == 2
    for line, row in list(street.lines):
        places = get_coordinates(line, include_z=True)
        inside = (places[:, 0] >= EAST + first) & (places[:, 0] <= EAST + last)
        street.lines.add(linestrings(places[inside]), **{**row, "road": 1, "line": row["line"] + 100})
    return street


@pytest.mark.parametrize("shape", [{}, {"radius": 200.0}, {"backwards": True}])
def test_two_carriageways_side_by_side_have_every_lane_once_and_each_leads_the_way_it_was_driven(shape):
    street = six_lanes(**shape)
    lines, _ = street.lanes()
    offsets = [float(np.median(street.offsets(line))) for line, _ in lines]
    assert np.array(sorted(offsets)) == pytest.approx([-1.75, 1.75, 5.25, 8.75, 12.25, 15.75], abs=0.02)
    ways = [np.sign(line.coords[-1][0] - line.coords[0][0]) for line, _ in lines]
    ahead_of = -1 if shape.get("backwards") else 1
    assert [way for _, way in sorted(zip(offsets, ways))] == [ahead_of] * 3 + [-ahead_of] * 3
    # each road has the lanes on its side, which its pass drove or drove nearer
    assert [row["road"] for _, row in sorted(zip(offsets, lines.rows), key=lambda pair: pair[0])] == [0, 0, 0, 1, 1, 1]


def test_a_road_that_sees_part_of_the_lanes_has_there_the_one_it_drove_and_no_lane_is_doubled_or_lost():
    """The second carriageway was seen from its own road from 40 to 80 m only."""
    street = six_lanes(first=40.0, last=80.0)
    lines, _ = street.lanes()
    for offset in (-1.75, 1.75, 5.25, 8.75, 12.25, 15.75):
        pieces = sorted((min(line.coords[0][0], line.coords[-1][0]) - EAST, line.length, row["road"]) for line, row in lines
                        if abs(np.median(street.offsets(line)) - offset) < 0.1)
        assert sum(length for _, length, _ in pieces) == pytest.approx(110.0, abs=2.0), offset
        # a lane that goes on is not cut for one that only passes beside
        assert {road for *_, road in pieces} == ({0, 1} if offset == 15.75 else {0})


def test_where_a_lane_goes_on_as_that_of_another_road_this_follows_it():
    street = six_lanes(first=40.0, last=80.0)
    *_, lanes = make_driving_lines(PaintedLines.from_features(street.lines, street.frame), street.frame)
    middle = [float(np.median(np.concatenate(lanes.borders(k))[:, 1])) - NORTH + street.frame.origin[1] for k in range(len(lanes))]
    pieces = [k for k in range(len(lanes)) if lanes.type[k] == "driving" and abs(middle[k] - 15.75) < 0.1]
    after = {lanes.lane_id[k]: lanes.successors[k] for k in pieces}
    assert len(pieces) >= 3 and sum(len(names) == 1 for names in after.values()) == len(pieces) - 1
    assert {name for names in after.values() for name in names} < set(after)


def test_the_lanes_of_a_road_on_another_level_are_lanes_of_their_own():
    street = six_lanes()
    street.frame.passes[1].z += 6.0
    lines, _ = street.lanes()
    assert len({(row["road"], row["lane"]) for row in lines.rows}) == 12
