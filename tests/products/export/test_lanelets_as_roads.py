"""Lanelets become roads with the lanes of both directions, and every lane leads where it led."""

import made_lanes
import numpy as np
import pytest
from exported_maps import as_lanelets, as_roads
from lanewright.products.export.lanelet_map import layers_of_lanelets, read_lanelet2
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, read_opendrive
from lanewright.products.export.shared_borders import with_shared_borders
from lanewright.products.export.sources import RoadMapSource, border_misses, checked
from map_files import geometry, lane, lanelet_street, opendrive, road, written

CRS = "EPSG:25832"
SPIRAL = geometry(0, 0, 0, 0, 60, '<spiral curvStart="0" curvEnd="0.04"/>')


def section(right, left=""):
    return f'<laneSection s="0"><left>{left}</left><center>{lane(0, "none", mark="broken")}</center><right>{right}</right></laneSection>'


def lanelets_of(folder, lanes, strip=""):
    """(draft, layers that are read of its file without the tag `strip`)."""
    source = with_shared_borders(checked(RoadMapSource(lanes)))
    draft, whole = as_lanelets(folder, source, changed=lambda text: text.replace(strip, "note") if strip else text)
    return draft, layers_of_lanelets(whole, CRS)


def roads_of(folder, layers):
    """(map that is written, its lanes)."""
    _, whole = as_roads(folder, with_shared_borders(checked(layers)))
    return whole, layers_of_opendrive(whole, CRS).lanes


def links(lanes, name=str):
    """{(lane, lane that follows it)} by names, without those from one part of a lane to the next."""
    return {(name(id), name(other)) for id, names in zip(lanes.lane_id, lanes.successors) for other in names if name(id) != name(other)}


def test_lanes_of_both_directions_are_one_road_that_keeps_right(tmp_path):
    whole, _ = roads_of(tmp_path, layers_of_lanelets(read_lanelet2(written(tmp_path, lanelet_street(), "map.osm")), CRS))
    assert len(whole.roads) == 1 and whole.roads[0].rule == "RHT"
    assert all({id for id, lane in part.lanes.items() if lane.type == "driving"} == {1, -1} for part in whole.roads[0].sections)


def test_a_road_that_bends_stays_one_road_and_its_borders_stay_where_they_are(tmp_path):
    lanes = section(lane(-1) + lane(-2) + lane(-3, "shoulder", 2.0), lane(2, "shoulder", 2.0) + lane(1))
    given = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive([road(SPIRAL, 60, lanes=lanes)]))), CRS).lanes
    _, layers = lanelets_of(tmp_path, given)
    whole, back = roads_of(tmp_path, layers)
    assert len(whole.roads) == 1 and sorted(whole.roads[0].sections[0].lanes) == [-3, -2, -1, 0, 1, 2]
    assert border_misses(given, back)[0].largest < 0.02 and sorted(layers.lanes.direction) == [-1, 0, 0, 1, 1]


@pytest.mark.parametrize("strip", ["", "turn_direction"], ids=["with the tag", "without"])
def test_ways_through_a_crossing_lead_from_every_arm_to_the_same_arms(tmp_path, strip):
    lanes = made_lanes.crossing()
    draft, layers = lanelets_of(tmp_path, lanes, strip)
    name = dict(zip(layers.lanes.lane_id, (lanelet.name for lanelet in draft.lanelets)))
    assert links(layers.lanes, name.get) == links(lanes)
    assert sum(layers.lanes.type == "connector") == sum(lanes.type == "connector")
    whole, back = roads_of(tmp_path, layers)
    known = {f"{one.id}.{id}.{k}": name[lane.data["lanewright:lane_id"]] for one in whole.roads for k, part in enumerate(one.sections)
             for id, lane in part.lanes.items() if "lanewright:lane_id" in lane.data}
    assert links(back, known.get) == links(lanes) and len(whole.junctions) == 1


def test_linked_lanes_that_miss_each_other_by_a_hand_are_linked_and_stay_where_they_are(tmp_path):
    both = '<predecessor id="-1"/><successor id="-1"/>'
    first = road(geometry(0, 0, 0, 0, 40), 40, "1", lanes=section(lane(-1, link=both)),
                 link='<successor elementType="road" elementId="2" contactPoint="start"/>')
    second = road(geometry(0, 40, 0, 0, 40), 40, "2", lanes=section(lane(-1, width=3.7, link=both)),
                  link='<predecessor elementType="road" elementId="1" contactPoint="end"/>')
    given = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive([first, second]))), CRS).lanes
    draft, layers = lanelets_of(tmp_path, given)
    name = dict(zip(layers.lanes.lane_id, (lanelet.name for lanelet in draft.lanelets)))
    assert links(layers.lanes, name.get) == {("1.-1.0", "2.-1.0")} and draft.unmet == 0
    assert border_misses(given, layers.lanes)[0].largest < 1e-3
    assert np.isclose(sorted(layers.lanes.width), [3.5, 3.7], atol=0.01).all()


def test_lanes_that_part_and_miss_their_lane_by_different_widths_are_all_linked(tmp_path):
    both = '<predecessor id="-1"/><successor id="-1"/>'
    roads = [road(geometry(0, x, 0, 0, 40), 40, id, lanes=section(lane(-1, width=width, link=both)),
                  link='<predecessor elementType="road" elementId="1" contactPoint="end"/>' * (id != "1"))
             for id, x, width in (("1", 0, 3.5), ("2", 40, 3.7), ("3", 40, 3.8))]
    given = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive(roads))), CRS).lanes
    draft, layers = lanelets_of(tmp_path, given)
    name = dict(zip(layers.lanes.lane_id, (lanelet.name for lanelet in draft.lanelets)))
    assert links(layers.lanes, name.get) == {("1.-1.0", "2.-1.0"), ("1.-1.0", "3.-1.0")} and draft.unmet == 0


def test_what_cannot_be_said_of_links_is_counted(tmp_path):
    apart = [road(geometry(0, x, 0, 0, 40), 40, id, lanes=section(lane(-1, link='<predecessor id="-1"/><successor id="-1"/>')), link=link)
             for id, x, link in (("1", 0, '<successor elementType="road" elementId="2" contactPoint="start"/>'),
                                 ("2", 42, '<predecessor elementType="road" elementId="1" contactPoint="end"/>'), ("3", 82, ""))]
    given = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive(apart))), CRS).lanes
    draft, _ = lanelets_of(tmp_path, given)
    assert draft.unmet == 1 and draft.added == 1
