"""Arms of a junction that were driven are joined by ways, also where nobody drove from the one to the other."""

from dataclasses import replace

import numpy as np
import pytest
from exported_maps import as_lanelets, as_roads
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.lanelet_map import node_places
from lanewright.products.export.shared_borders import UNDRIVEN_CONFIDENCE, with_inferred_ways, with_shared_borders
from lanewright.products.export.sources import RoadMapSource, checked
from made_lanes import CRS, Axis, LaneScene, crossing, hermite, kinds


def without(lanes, rows):
    """Lanes less some rows."""
    keep = [k for k in range(len(lanes)) if k not in rows]
    lost = {lanes.lane_id[k] for k in rows}
    columns = {name: getattr(lanes, name)[keep] for name in (
        "road", "lane", "lane_id", "type", "direction", "left_line", "right_line", "left_kind", "right_kind", "left_pattern", "right_pattern",
        "status", "confidence", "station", "end")}
    pieces = [lanes.borders(k) for k in keep]
    return replace(lanes, **columns, successors=[tuple(name for name in lanes.successors[k] if name not in lost) for k in keep],
                   left=np.concatenate([left for left, _ in pieces]), right=np.concatenate([right for _, right in pieces]),
                   start=np.append(0, np.cumsum([len(left) for left, _ in pieces])))


def led_to(lanes, start):
    """Roads that a lane leads to by one connector."""
    row = {name: k for k, name in enumerate(lanes.lane_id)}
    return {int(lanes.road[row[end]]) for name in lanes.successors[row[start]] for end in lanes.successors[row[name]]}


def two_ways_driven():
    """A crossing where road 1 was driven straight on to road 3, and road 2 left to road 1."""
    lanes = crossing()
    ways = {k: (int(lanes.road[k]), next(int(lanes.road[j]) for j in range(len(lanes)) if lanes.lane_id[j] in lanes.successors[k]))
            for k in range(len(lanes)) if lanes.type[k] == "connector"}
    return lanes, ways


def test_every_arm_that_was_driven_in_leads_to_every_one_that_was_driven_out(tmp_path):
    lanes, ways = two_ways_driven()
    kept = {(1, 3), (2, 4)}   # both straight on: they cross
    source = checked(RoadMapSource(without(lanes, [k for k, way in ways.items() if way not in kept])))
    found = with_inferred_ways(source)
    assert len(found.lanes) == len(source.lanes) + 2 and any("inferred" in note for note in found.notes)
    assert led_to(found.lanes, "1.1.1") == {3, 4} and led_to(found.lanes, "2.1.1") == {3, 4}
    new = slice(len(source.lanes), None)
    assert set(found.lanes.status[new]) == {"inferred"} and (found.lanes.confidence[new] <= UNDRIVEN_CONFIDENCE).all()
    _, whole = as_roads(tmp_path, with_shared_borders(found))
    assert not check_opendrive(whole).found
    assert sum("lanewright:status" in lane.data for road in whole.roads for lane in road.sections[0].lanes.values() if road.junction != "-1") >= 2
    _, read = as_lanelets(tmp_path, with_shared_borders(found))
    assert not check_lanelets(read, *node_places(read, CRS)).found


def test_ways_that_are_there_already_are_not_made_again():
    source = checked(RoadMapSource(crossing()))
    assert with_inferred_ways(source) is source


def test_a_single_way_through_a_junction_tells_of_no_other():
    lanes, ways = two_ways_driven()
    source = checked(RoadMapSource(without(lanes, [k for k, way in ways.items() if way != (1, 3)])))
    assert with_inferred_ways(source) is source


@pytest.mark.parametrize("over", [0.0, 6.0])
def test_on_a_ring_who_came_by_one_way_leaves_by_the_other_unless_it_is_a_bridge(over):
    """A way from the left that leaves to the right, and one from below that goes round to the left: both pass the lower right of a ring."""
    scene, ring = LaneScene(), 15.0
    none = dict(type="connector", left_kind="none", right_kind="none", left_pattern="", right_pattern="", status="inferred", confidence=0.5)
    arms = {}
    for road, angle in ((1, np.pi), (2, -np.pi / 2), (3, 0.0)):
        line = Axis(((40.0, 0.0, 0.0),), *(70.0 * np.array([np.cos(angle), np.sin(angle)])), angle + np.pi)
        arms[road] = line
        scene.add(line, 0.0, -3.5, lane=1, road=road, **kinds())
        scene.add(line, 3.5, 0.0, lane=2, road=road, direction=-1, **kinds())

    def way(road, to, first, last):
        turns = np.linspace(first, last, int((last - first) * ring))
        borders = []
        for side in (1, 0):
            r = ring - 1.75 if side else ring + 1.75
            arc = np.c_[r * np.cos(turns), r * np.sin(turns), np.zeros(len(turns))] + arms[1].at([0.0], [0.0])[0] + [70.0, 0.0, 0.0]
            begin, end = arms[road].at([40.0], [0.0 if side else -3.5])[0], arms[to].at([40.0], [0.0 if side else 3.5])[0]
            headings = arms[road].curves[0].direction, arms[to].curves[0].direction + np.pi
            borders.append(np.concatenate([hermite(begin, arc[0], headings[0], first + np.pi / 2)[:-1], arc,
                                           hermite(arc[-1], end, last + np.pi / 2, headings[1])[1:]]))
        return borders
    scene.piece(*way(1, 3, np.pi + 0.8, 2 * np.pi - 0.8), road=1, lane=11, **none)
    raised = way(2, 1, 1.5 * np.pi + 0.8 - 0.3, 3 * np.pi - 0.8)
    scene.piece(*raised, road=2, lane=12, **none)
    lanes = scene.lanes()
    if over:
        rows = slice(lanes.start[-2], lanes.start[-1])
        lanes.left[rows, 2] += over
        lanes.right[rows, 2] += over
    found = with_inferred_ways(RoadMapSource(lanes))
    assert led_to(found.lanes, "2.1.1") == ({1} if over else {1, 3})
    if not over:
        left, right = found.lanes.borders(len(found.lanes) - 1)
        middle = ((left + right) / 2 - arms[1].at([0.0], [0.0])[0] - [70.0, 0.0, 0.0])[:, :2]
        assert np.hypot(*middle.T).min() == pytest.approx(ring, abs=1.0)   # it goes along the ring, not across the middle
        assert np.ptp(np.hypot(*np.diff(middle, axis=0).T)) < 2.0
