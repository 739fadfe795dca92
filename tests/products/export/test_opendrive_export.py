"""Lanes become OpenDRIVE roads whose borders come back where they were, with the links of the lanes."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from exported_maps import as_roads
from lanewright.core.common.features import DRIVING_LINES, MARKING_LINES, MARKINGS, ROAD_EDGES, Features
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.opendrive.exporter import OpenDriveSettings
from lanewright.products.export.opendrive.geometry import LineBundle, fit_cubics
from lanewright.products.export.opendrive.reference_line import fit_reference, polynomial_reference
from lanewright.products.export.opendrive.xodr import layers_of_opendrive
from lanewright.products.export.sources import RoadMapSource, border_misses, checked, crs_of_reference, driving_line_misses, reference_of_crs
from made_lanes import CRS, Axis, LaneScene, crossing, kinds, roundabout, s_curve, split, street, widening

SCENES = {"street": lambda: street(cut=30.0), "left-hand street": lambda: street(side="left", cut=30.0),
          "crowned curves": lambda: s_curve(slope=0.02, crown=0.025), "tilted curves": lambda: s_curve(slope=0.02, crossfall=0.02),
          "widening": widening, "split": split, "crossing": crossing, "roundabout": roundabout}


def exported(folder, lanes, settings=OpenDriveSettings(), **layers):
    return as_roads(folder, checked(RoadMapSource(lanes, **layers)), settings)


def lane_names(draft):
    """(road, section, lane) -> lane_id of the lane it was made from."""
    return {(road.id, number, id): lane.data["lanewright:lane_id"] for road in draft.map.roads for number, section in enumerate(road.sections)
            for id, lane in section.lanes.items() if "lanewright:lane_id" in lane.data}


@pytest.mark.parametrize("tolerance", [0.02, 0.005])
@pytest.mark.parametrize("scene", SCENES)
def test_borders_come_back_within_the_tolerance(tmp_path, scene, tolerance):
    lanes = SCENES[scene]()
    _, whole = exported(tmp_path, lanes, OpenDriveSettings(tolerance))
    across, rise = border_misses(lanes, layers_of_opendrive(whole, CRS).lanes)
    chords = 0.0005   # m by which lines that are read miss a curve
    assert across.places > 2 * len(lanes.left) and across.largest <= tolerance + chords and rise.largest <= tolerance


@pytest.mark.parametrize("scene", SCENES)
def test_a_good_export_has_no_findings_and_the_links_of_the_lanes(tmp_path, scene):
    lanes = SCENES[scene]()
    draft, whole = exported(tmp_path, lanes)
    found = check_opendrive(whole)
    assert set(found.counts()) <= ({"dead end"} if scene == "split" else set()), found.found   # its second lane ends at full width
    names = {f"{road}.{lane}.{section}": name for (road, section, lane), name in lane_names(draft).items()}
    again = layers_of_opendrive(whole).lanes
    led = {(names[id], names[other]) for id, others in zip(again.lane_id, again.successors) for other in others if names[id] != names[other]}
    assert led == {(id, other) for id, others in zip(lanes.lane_id, lanes.successors) for other in others}


def test_from_every_arm_of_a_crossing_a_route_leads_to_every_other(tmp_path):
    draft, whole = exported(tmp_path, crossing())
    names = {f"{road}.{lane}.{section}": name for (road, section, lane), name in lane_names(draft).items()}
    lanes = layers_of_opendrive(whole).lanes
    follows = dict(zip(lanes.lane_id, lanes.successors))
    assert len(whole.junctions) == 1
    for id in (id for id in lanes.lane_id if names[id].endswith(".1.1")):
        reached = {names[last] for middle in follows[id] for last in follows[middle]}
        assert reached == {f"{road}.2.1" for road in range(1, 5)} - {f"{names[id][0]}.2.1"}


@pytest.mark.parametrize("arms", [3, 4])
def test_from_every_arm_of_a_roundabout_a_route_leads_to_every_arm(tmp_path, arms):
    lanes = roundabout(arms)
    draft, whole = exported(tmp_path, lanes)
    assert not check_opendrive(whole).found
    names = {f"{road}.{lane}.{section}": name for (road, section, lane), name in lane_names(draft).items()}
    again = layers_of_opendrive(whole).lanes
    follows = dict(zip(again.lane_id, again.successors))
    for id in (id for id in again.lane_id if names[id] in {f"{road}.1.1" for road in range(2, arms + 2)}):
        reached, open_ends = {id}, [id]
        while open_ends:
            more = set(follows[open_ends.pop()]) - reached
            reached |= more
            open_ends += more
        assert {names[one] for one in reached} >= {f"{road}.2.1" for road in range(2, arms + 2)}


def test_a_road_that_goes_straight_on_past_a_side_road_has_a_way_through_the_junction(tmp_path):
    scene, line = LaneScene(), Axis(((100.0, 0.0, 0.0),))
    for piece, (first, last) in enumerate(((0, 40), (40, 60), (60, 100)), start=1):
        scene.add(line, 0.0, -3.5, first, last, lane=1, piece=piece, **kinds())
        scene.add(line, 3.5, 0.0, first, last, lane=2, piece=piece, direction=-1, **kinds())
    side = Axis(((40.0, 0.0, 0.0),), 50.0, -12.0, -np.pi / 2)
    scene.add(side, 0.0, -3.5, road=2, **kinds())
    from made_lanes import hermite
    borders = [hermite(line.at([40], [t])[0], side.at([0], [t])[0], 0.0, -np.pi / 2) for t in (0.0, -3.5)]
    scene.piece(*borders, road=1, lane=9, type="connector", left_kind="none", right_kind="none", left_pattern="", right_pattern="")
    lanes = scene.lanes()
    draft, whole = exported(tmp_path, lanes)
    assert not check_opendrive(whole).found
    assert len(whole.junctions) == 1 and sum(road.junction != "-1" for road in whole.roads) == 3
    names = {f"{road}.{lane}.{section}": name for (road, section, lane), name in lane_names(draft).items()}
    again = layers_of_opendrive(whole).lanes
    led = {(names[id], names[other]) for id, others in zip(again.lane_id, again.successors) for other in others if names[id] != names[other]}
    assert led == {(id, other) for id, others in zip(lanes.lane_id, lanes.successors) for other in others}


def test_a_shoulder_within_a_junction_apart_from_its_ways_is_a_road_of_its_own(tmp_path):
    scene, line = LaneScene(), Axis(((100.0, 0.0, 0.0),))
    for piece, (first, last) in enumerate(((0, 40), (40, 60), (60, 100)), start=1):
        scene.add(line, 0.0, -3.5, first, last, lane=1, piece=piece, **kinds())
        scene.add(line, 3.5, 0.0, first, last, lane=2, piece=piece, direction=-1, **kinds())
        if piece != 2:
            scene.add(line, -3.5, -5.0, first, last, lane=3, piece=piece, type="shoulder", direction=0, **kinds())
    unmarked = dict(left_kind="none", right_kind="none", left_pattern="", right_pattern="")
    from made_lanes import hermite
    apart = [hermite(line.at([40], [t])[0], line.at([60], [t])[0], -0.1, 0.1) for t in (-3.5, -5.0)]
    scene.piece(*apart, road=1, lane=3, piece=2, type="shoulder", direction=0, **unmarked)
    turns = (40, -3.5, 0.0, -12.0, -np.pi / 2), (60, 3.5, np.pi, 12.0, np.pi / 2)
    for number, (at, outer, heading, place, way) in enumerate(turns):
        side = Axis(((40.0, 0.0, 0.0),), 50.0, place, way)
        scene.add(side, 0.0, -3.5, road=2 + number, **kinds())
        turn = [hermite(line.at([at], [t])[0], side.at([0], [u])[0], heading, way) for t, u in ((0.0, 0.0), (outer, -3.5))]
        scene.piece(*turn, road=1, lane=8 + number, type="connector", **unmarked)
    lanes = scene.lanes()
    draft, whole = exported(tmp_path, lanes)
    assert not check_opendrive(whole).found and sorted(lane_names(draft).values()) == sorted(lanes.lane_id)
    assert border_misses(lanes, layers_of_opendrive(whole).lanes)[0].largest < OpenDriveSettings().tolerance


def test_in_left_hand_traffic_lanes_along_the_road_are_left_of_its_line(tmp_path):
    _, whole = exported(tmp_path, street(side="left"))
    assert whole.roads[0].rule == "LHT"
    _, whole = exported(tmp_path, widening(), OpenDriveSettings(traffic_side="left"))
    assert set(whole.roads[0].sections[0].lanes) == {0, 1, -1} and whole.roads[0].sections[0].lanes[1].type == "driving"


def test_the_elements_are_lines_arcs_and_spirals_that_join_without_gap_or_kink(tmp_path):
    _, whole = exported(tmp_path, s_curve())
    elements = whole.roads[0].plan.elements
    assert {element.kind for element in elements} == {"line", "arc", "spiral"} and len(elements) < 20
    _, whole = exported(tmp_path, street(((100.0, 1 / 40, 1 / 40),)))
    assert [element.kind for element in whole.roads[0].plan.elements] == ["arc"]
    assert whole.roads[0].plan.elements[0].values[0] == pytest.approx(1 / 40, rel=1e-3)


def test_a_line_that_no_short_element_follows_is_drawn_by_cubics():
    x = np.arange(0.0, 12.0, 0.5)
    points = np.c_[x, np.where(np.arange(len(x)) % 2, 0.3, 0.0)]
    assert fit_reference(points, 0.01) is None
    plan = polynomial_reference(points)
    np.testing.assert_allclose([element.end()[:2] for element in plan.elements], points[1:], atol=2e-3)
    turns = [second.heading - first.end()[2] for first, second in zip(plan.elements[:-1], plan.elements[1:])]
    assert np.abs((np.array(turns) + np.pi) % (2 * np.pi) - np.pi).max() < 1e-3


def test_a_curve_that_turns_at_its_end_to_meet_another_road_has_no_kink():
    along = np.arange(0.0, 40.5)
    plan = fit_reference(60.0 * np.c_[np.sin(along / 60.0), 1 - np.cos(along / 60.0)], 0.02, (None, 40.0 / 60.0 + 0.05))
    assert plan.elements[-1].end()[2] == pytest.approx(40.0 / 60.0 + 0.05) and not plan.jumps(1e-9, 1e-9)


def test_noise_of_the_survey_makes_no_more_elements_than_the_road_has():
    points = s_curve().borders(0)[0][:, :2]
    points = points - points[0] + np.random.default_rng(3).normal(0, 0.003, points.shape)
    plan = fit_reference(points, 0.02)
    assert len(plan.elements) < 20


def test_widths_never_fall_below_zero_where_a_lane_tapers_in(tmp_path):
    _, whole = exported(tmp_path, split())
    widths = [lane.width.least(whole.roads[0].section_end(k) - section.s)[0] for k, section in enumerate(whole.roads[0].sections)
              for id, lane in section.lanes.items() if id]
    assert min(widths) > -1e-9
    s = np.linspace(0, 10, 11)
    (line,), = fit_cubics([LineBundle([s], [np.maximum(s - 5, 0)], 0.0, 10.0, 0.01, broken=True)])
    assert line.least(10.0)[0] == 0.0 and line.at(7.5) == pytest.approx(2.5)


def test_a_cubic_is_fitted_by_one_piece_and_a_step_by_many():
    s = np.linspace(0, 40, 41)
    (one,), = fit_cubics([LineBundle([s], [3 + 0.1 * s - 0.01 * s**2 + 0.0002 * s**3], 0.0, 40.0, 0.001)])
    assert len(one) == 1
    (many,), = fit_cubics([LineBundle([s], [np.where(s < 20, 3.0, 4.0)], 0.0, 40.0, 0.01)])
    assert len(many) > 2 and np.abs(many.at(s) - np.where(s < 20, 3.0, 4.0)).max() < 0.02


def test_curbs_paint_and_what_was_inferred_are_said(tmp_path):
    scene, line = LaneScene(), Axis(((40.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5, **kinds(outer="curb", pattern="") | {"left_line": "line 4"}, status="bridged", confidence=0.4)
    scene.add(line, 3.5, 0.0, lane=2, direction=-1, **kinds(pattern="double-solid"))
    edges, painted = Features("LineStringZ", ROAD_EDGES), Features("LineStringZ", MARKING_LINES)
    edges.add(shapely.linestrings(line.at([0, 40], [-3.5, -3.5])), height_m=0.13)
    painted.add(shapely.linestrings(line.at([0, 40], [0, 0])), line=4, width_m=0.15, colour="yellow")
    driven = Features("LineStringZ", DRIVING_LINES)
    for station, end, sigma in ((0.0, 20.0, 0.003), (20.0, 40.0, 0.004)):
        driven.add(shapely.linestrings(line.at([station, end], [1.75, 1.75])), road=1, lane=2, station_m=station, end_m=end, sigma_m=sigma)
    _, whole = exported(tmp_path, scene.lanes(), road_edges=edges, marking_lines=painted, driving_lines=driven)
    lanes = whole.roads[0].sections[0].lanes
    assert lanes[-2].type == "curb" and lanes[-2].heights[0, 2] == 0.13 and lanes[-1].marks[0].type == "curb"
    assert (lanes[0].marks[0].type, lanes[0].marks[0].width, lanes[0].marks[0].dash) == ("broken", 0.15, 3.0)
    assert lanes[1].marks[0].type == "solid solid"
    assert [lanes[id].marks[0].colour for id in (0, 1)] == ["yellow", "standard"], "a colour that nobody saw is not said"
    assert lanes[-1].data["lanewright:status"] == "bridged" and "lanewright:status" not in lanes[1].data
    assert lanes[1].data["lanewright:sigma_m"] == "0.004" and "lanewright:sigma_m" not in lanes[-1].data, "RMS of 3 and 4 mm is 3.5"


def test_crossings_and_stop_lines_are_objects_where_they_lie(tmp_path):
    markings, line = Features("PolygonZ", MARKINGS), Axis(((60.0, 0.0, 0.0),))
    for t in np.arange(-3.0, 3.1, 1.0):
        markings.add(shapely.polygons(line.at([20, 24, 24, 20], [t - 0.25, t - 0.25, t + 0.25, t + 0.25])), **{"class": "zebra"})
    markings.add(shapely.polygons(line.at([15, 15.5, 15.5, 15], [-3.4, -3.4, -0.1, -0.1])), **{"class": "stop"})
    _, whole = exported(tmp_path, street(), markings=markings)
    crosswalk, stop = whole.roads[0].objects
    assert (crosswalk["type"], stop["name"]) == ("crosswalk", "stop line")
    np.testing.assert_allclose([crosswalk["s"], crosswalk["t"], stop["s"], stop["t"]], [22, 0, 15.25, -1.75], atol=0.01)
    np.testing.assert_allclose(np.ptp(crosswalk["corners"][:, :2], axis=0), [4, 6.5], atol=0.01)


@pytest.mark.parametrize("version", ["1.7", "1.8"])
def test_a_crossing_beyond_the_end_of_its_road_keeps_its_size_and_place(tmp_path, version):
    markings, line = Features("PolygonZ", MARKINGS), Axis(((60.0, 0.0, 0.0),), 0.0, 0.0, 0.4)
    for t in np.arange(-3.0, 3.1, 1.0):
        markings.add(shapely.polygons(line.at([-5, -1, -1, -5], [t - 0.25, t - 0.25, t + 0.25, t + 0.25])), **{"class": "zebra"})
    scene = LaneScene()
    scene.add(line, 0.0, -3.5, **kinds())
    scene.add(line, 3.5, 0.0, lane=2, direction=-1, **kinds())
    _, whole = exported(tmp_path, scene.lanes(), OpenDriveSettings(version=version), markings=markings)
    assert not check_opendrive(whole).found
    crosswalk, = whole.roads[0].objects
    assert crosswalk["local"] and crosswalk["s"] == 0
    np.testing.assert_allclose(np.ptp(crosswalk["corners"][:, :2], axis=0), [4, 6.5], atol=0.01)
    np.testing.assert_allclose(crosswalk["corners"][:, 0].mean(), -3.0, atol=0.01)
    assert (crosswalk["length"], crosswalk["width"]) == pytest.approx((4, 6.5), abs=0.01)


def test_the_false_origin_and_the_reference_bring_the_map_back_to_its_place(tmp_path):
    draft, whole = exported(tmp_path, street())
    assert np.abs(whole.roads[0].plan.at(np.array([0.0]))[0]).max() < 200 and whole.offset[0] % 100 == 0
    text = reference_of_crs(CRS)
    assert text.startswith("+proj=utm") and crs_of_reference(text, "")[0]


def test_the_driving_line_is_held_against_the_middle_of_the_lane(tmp_path):
    lanes = s_curve()
    _, whole = exported(tmp_path, lanes)
    layer = Features("LineStringZ", DRIVING_LINES)
    for k in range(len(lanes)):
        layer.add(shapely.linestrings(sum(lanes.borders(k)) / 2), status="measured")
    assert driving_line_misses(layer, layers_of_opendrive(whole).lanes).p95 < 0.01


def test_driving_lines_are_held_against_nothing_where_a_map_has_no_lanes_for_cars():
    layer = Features("LineStringZ", DRIVING_LINES)
    layer.add(shapely.LineString([(0, 0, 0), (10, 0, 0)]), status="measured")
    for_bicycles = replace(s_curve(), type=np.array(["bicycle"] * len(s_curve())))
    assert driving_line_misses(layer, for_bicycles).places == 0


def test_moving_the_survey_moves_the_map_and_changes_nothing_else(tmp_path):
    lanes = s_curve()
    away = np.array([500_000.0, -300_000.0, 100.0])
    first, second = (exported(tmp_path, one)[1].roads[0] for one in (lanes, replace(lanes, left=lanes.left + away, right=lanes.right + away)))
    assert [element.kind for element in first.plan.elements] == [element.kind for element in second.plan.elements]
    np.testing.assert_allclose([element.length for element in first.plan.elements], [element.length for element in second.plan.elements], atol=1e-4)


def test_a_border_with_a_corner_is_kept_beside_a_smooth_reference_line(tmp_path):
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))

    def left(s):
        return np.where(s < 1.0, 0.15 * (1.0 - s), 0.0)   # the first metre leads aside by 9 degrees
    scene.add(line, left, -3.5, step=0.5)
    scene.add(line, 3.5, left, lane=2, direction=-1, step=0.5)
    lanes = scene.lanes()
    _, whole = exported(tmp_path, lanes)
    assert len(whole.roads[0].plan.elements) < 10 and not check_opendrive(whole).found
    across, _ = border_misses(lanes, layers_of_opendrive(whole).lanes)
    assert across.largest <= 0.02


def test_an_uneven_cross_section_comes_back_within_the_tolerance_in_height(tmp_path):
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5)
    scene.add(line, 3.5, 0.0, lane=2, direction=-1)
    lanes = scene.lanes()
    x = np.concatenate([lanes.left, lanes.right])[:, :2] @ np.array([1.0, 0.0])
    bumps = 0.05 * np.sin(x / 4) * np.linspace(-1, 1, len(x)).round()
    lanes = replace(lanes, left=lanes.left + np.c_[0 * x, 0 * x, bumps][:len(lanes.left)])
    lanes = replace(lanes, left=np.c_[lanes.left[:, :2], lanes.left[:, 2].round(4)])
    lanes.left[61:, 2] = lanes.left[60::-1, 2]   # the middle is shared by both lanes
    _, whole = exported(tmp_path, lanes)
    _, rise = border_misses(lanes, layers_of_opendrive(whole).lanes)
    assert len(whole.roads[0].shape) and rise.largest <= 0.02
