"""Lanes become lanelets that share their borders and lead on as the lanes do."""

import numpy as np
import pytest
import shapely
from exported_maps import as_lanelets
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import MARKING_LINES, MARKINGS, ROAD_EDGES, Features
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.lanelet_export import LaneletSettings, to_degrees
from lanewright.products.export.lanelet_map import layers_of_lanelets, node_places
from lanewright.products.export.sources import RoadMapSource, checked
from made_lanes import CRS, ORIGIN, Axis, LaneScene, crossing, kinds, roundabout, s_curve, split, street, widening

SCENES = {"street": lambda: street(cut=30.0), "left-hand street": lambda: street(side="left", cut=30.0),
          "curves": lambda: s_curve(slope=0.02, crown=0.025), "widening": widening, "split": split, "crossing": crossing, "roundabout": roundabout}


def exported(folder, lanes, local=False, settings=LaneletSettings(), **layers):
    return as_lanelets(folder, checked(RoadMapSource(lanes, **layers)), settings, local)


@pytest.mark.parametrize("scene", SCENES)
def test_the_borders_come_back_within_a_millimetre_and_nothing_is_found(tmp_path, scene):
    lanes = SCENES[scene]()
    draft, whole = exported(tmp_path, lanes)
    found = check_lanelets(whole, *node_places(whole, CRS))
    assert not found.found, found.found
    again = layers_of_lanelets(whole, CRS).lanes
    for k in range(len(lanes)):
        parts = [j for j, made in enumerate(draft.lanelets) if made.name == lanes.lane_id[k]]
        for side in (0, 1):
            line = shapely.linestrings(np.concatenate([again.borders(j)[side] for j in parts])[:, :2])
            assert shapely.distance(shapely.points(lanes.borders(k)[side][:, :2]), line).max() < 1e-3
    middle = again.left[:, 2]
    assert np.abs(np.sort(middle)[[0, -1]] - np.sort(lanes.left[:, 2])[[0, -1]]).max() < 1e-3


@pytest.mark.parametrize("scene", SCENES)
def test_every_lane_leads_to_the_lanes_that_follow_it(tmp_path, scene):
    lanes = SCENES[scene]()
    draft, whole = exported(tmp_path, lanes)
    again = layers_of_lanelets(whole, CRS).lanes
    name = dict(zip(again.lane_id, (made.name for made in draft.lanelets)))
    led = {(name[id], name[other]) for id, names in zip(again.lane_id, again.successors) for other in names if name[id] != name[other]}
    assert led == {(id, other) for id, names in zip(lanes.lane_id, lanes.successors) for other in names}


def test_from_every_arm_of_a_crossing_a_route_leads_to_every_other(tmp_path):
    lanes = crossing()
    draft, whole = exported(tmp_path, lanes)
    again = layers_of_lanelets(whole, CRS).lanes
    name, follows = dict(zip(again.lane_id, (made.name for made in draft.lanelets))), dict(zip(again.lane_id, again.successors))
    for id in (id for id in again.lane_id if name[id].endswith(".1.1")):
        reached = {name[last] for middle in follows[id] for last in follows[middle]}
        assert reached == {f"{road}.2.1" for road in range(1, 5)} - {f"{name[id][0]}.2.1"}


def test_neighbours_share_the_way_between_them_and_a_lane_is_cut_where_another_begins_beside_it(tmp_path):
    draft, _ = exported(tmp_path, split())
    beside = [made for made in draft.lanelets if made.name in ("1.1.2", "1.2.1")]
    assert len(beside) == 2 and beside[0].way("right") == beside[1].way("left")
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5)
    scene.add(line, -3.5, -7.0, 20.0, 40.0, lane=2)
    draft, _ = exported(tmp_path, scene.lanes())
    assert [made.name for made in draft.lanelets] == ["1.1.1", "1.1.1", "1.1.1", "1.2.1"]
    assert draft.lanelets[1].way("right") == draft.lanelets[3].way("left")


def test_borders_have_the_types_and_subtypes_of_the_format(tmp_path):
    scene, line = LaneScene(), Axis(((40.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5, **kinds(outer="curb", pattern="") | {"left_line": "line 4"})
    scene.add(line, 3.5, 0.0, lane=2, direction=-1, **kinds(outer="edge", pattern="solid"))
    scene.add(line, -20.0, -23.0, lane=3, road=2, left_kind="pavement", left_pattern="", right_kind="none", right_pattern="")
    edges = Features("LineStringZ", ROAD_EDGES)
    edges.add(shapely.linestrings(line.at([0, 40], [-3.5, -3.5])), height_m=0.04)
    painted = Features("LineStringZ", MARKING_LINES)
    painted.add(shapely.linestrings(line.at([0, 40], [0, 0])), line=4, width_m=0.25, colour="yellow")
    draft, _ = exported(tmp_path, scene.lanes(), road_edges=edges, marking_lines=painted)
    tags = [{key: way.tags.get(key) for key in ("type", "subtype")} for way in draft.ways if way.tags["type"] != "centerline"]
    assert [way.tags.get("color") for way in draft.ways if way.tags["type"] in ("line_thick", "line_thin")] == ["yellow", None]
    assert tags == [{"type": "line_thick", "subtype": "dashed"}, {"type": "curbstone", "subtype": "low"}, {"type": "line_thin", "subtype": "solid"},
                    {"type": "road_border", "subtype": None}, {"type": "virtual", "subtype": None}]


def test_a_speed_limit_is_written_only_where_it_was_given_and_what_was_inferred_is_said(tmp_path):
    lanes = crossing()
    draft, _ = exported(tmp_path, lanes)
    assert not any("speed_limit" in made.tags for made in draft.lanelets)
    draft, whole = exported(tmp_path, lanes, settings=LaneletSettings(30, "nonurban"), local=True)
    tags = whole.lanelets[max(whole.lanelets)].tags
    assert tags["speed_limit"] == "30" and tags["location"] == "nonurban" and tags["lanewright:status"] == "inferred"
    assert tags["turn_direction"] in ("left", "right", "straight")
    assert (whole.local >= 0).all() and np.ptp(whole.local[:, 0]) == pytest.approx(np.ptp(draft.nodes[:, 0]), abs=1e-3)
    assert {made.tags["turn_direction"] for made in draft.lanelets if made.name.split(".")[1] in ("11", "12", "13")} == {"left", "right", "straight"}


def test_crossings_and_stop_lines_come_from_the_markings(tmp_path):
    markings, line = Features("PolygonZ", MARKINGS), Axis(((60.0, 0.0, 0.0),))
    for t in np.arange(-3.0, 3.1, 1.0):
        markings.add(shapely.polygons(line.at([20, 24, 24, 20], [t - 0.25, t - 0.25, t + 0.25, t + 0.25])), **{"class": "zebra"})
    markings.add(shapely.polygons(line.at([15, 15.5, 15.5, 15], [-3.4, -3.4, -0.1, -0.1])), **{"class": "stop"})
    draft, whole = exported(tmp_path, street(), markings=markings)
    walked = draft.lanelets[-1]
    assert walked.tags["subtype"] == "crosswalk" and not check_lanelets(whole, *node_places(whole, CRS)).found
    left, right = (draft.nodes[list(draft.ways[number].nodes)] - ORIGIN for number in (walked.way("left"), walked.way("right")))
    assert np.ptp(left[:, 1]) == pytest.approx(6.5, abs=1e-6) and np.abs(left[:, 0] - right[:, 0]).max() == pytest.approx(4.0, abs=1e-6)
    stop = next(draft.nodes[list(way.nodes)] - ORIGIN for way in draft.ways if way.tags["type"] == "stop_line")
    np.testing.assert_allclose(np.sort(stop[:, 1]), [-3.4, -0.1], atol=1e-6)


def spoilt(change):
    lanes = street()
    change(lanes)
    return lanes


def far_edges():
    layer = Features("LineStringZ", ROAD_EDGES)
    layer.add(shapely.linestrings([[0, 0, 0], [10, 0, 0]]))
    return layer


def two_roads_at_one_place():
    scene, line = LaneScene(), Axis(((40.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5)
    scene.add(line, 0.5, -3.0, road=2)
    return scene.lanes()


@pytest.mark.parametrize("lanes, layers, said", [
    (lambda: LaneScene().lanes(), {}, "layer of lanes is empty"),
    (lambda: spoilt(lambda lanes: lanes.left.__setitem__((3, 2), np.nan)), {}, "have no heights"),
    (lambda: spoilt(lambda lanes: lanes.left.__setitem__((5, slice(0, 2)), lanes.left[20, :2])), {}, "crosses itself"),
    (lambda: spoilt(lambda lanes: lanes.left.__setitem__(slice(0, 61), lanes.right[:61])), {}, "has no two borders"),
    (lambda: spoilt(lambda lanes: lanes.left.__setitem__((slice(30, 61), 1), lanes.right[30:61, 1] - 2)), {}, "cross each other"),
    (lambda: spoilt(lambda lanes: lanes.left.__setitem__((3, 0), 1e18)), {}, "reach to 1e.18 m .* not on this world"),
    (two_roads_at_one_place, {}, "Roads 1 and 2 lie at one place"),
    (street, {"road_edges": far_edges()}, "do not lie where the lanes are")])
def test_what_cannot_be_a_map_is_refused_in_one_sentence(lanes, layers, said):
    with pytest.raises(RoadExtractionError, match=said):
        checked(RoadMapSource(lanes(), **layers))


def test_a_lane_that_names_itself_as_its_successor_is_taken_without_the_link():
    lanes = street(cut=30.0)
    source = checked(RoadMapSource(spoilt(lambda lanes: [lanes.successors.__setitem__(k, (name,)) for k, name in enumerate(lanes.lane_id)])))
    assert not any(source.lanes.successors) and "name themselves" in source.notes[0] and any(lanes.successors)


@pytest.mark.parametrize("crs, said", [("EPSG:4326", "geographic"), ("", "has no CRS")])
def test_lanes_without_a_crs_in_metres_have_no_latitude(crs, said):
    from dataclasses import replace

    with pytest.raises(RoadExtractionError, match=said):
        lanes = checked(RoadMapSource(replace(street(), crs=crs))).lanes
        to_degrees(lanes.left, lanes.crs)
