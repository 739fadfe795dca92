"""Lanes that are cut obliquely keep their corners and heights; edges of the pavement stay what they are."""

import numpy as np
import pytest
from exported_maps import as_roads
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.opendrive.xodr import layers_of_opendrive
from lanewright.products.export.sources import RoadMapSource, border_misses, checked
from made_lanes import CRS, Axis, LaneScene, kinds, parting

TOLERANCE = 0.02   # m


def oblique(scene, line, left, right, first, last, shift, step=1.0, **values):
    """A piece whose cross-sections run obliquely: a border lies `shift` metres behind for every metre to the right."""
    s = np.arange(first, last + step / 2, step)
    scene.piece(*(line.at(s + shift * side, side) for side in (left, right)), **values)


def missed(folder, lanes):
    _, whole = as_roads(folder, checked(RoadMapSource(lanes)))
    across, rise = border_misses(lanes, layers_of_opendrive(whole, CRS).lanes)
    assert across.places > 2 * len(lanes.left)   # and those that were read back
    return whole, across.largest, rise.largest


@pytest.mark.parametrize("shift", [-0.6, -0.2, 0.2, 0.6])
@pytest.mark.parametrize("pieces", [((60.0, 0.0, 0.0),), ((60.0, 1 / 80, 1 / 80),)], ids=["straight", "curve"])
def test_a_road_that_is_cut_oblique_keeps_its_corners(tmp_path, shift, pieces):
    scene, line = LaneScene(), Axis(((5.0, 0.0, 0.0), *pieces, (5.0, 0.0, 0.0)), slope=0.08, crown=0.02)
    oblique(scene, line, 0.0, -3.5, 5.0, 60.0, shift, lane=1, **kinds())
    oblique(scene, line, -3.5, -7.0, 5.0, 60.0, shift, lane=2)
    whole, across, rise = missed(tmp_path, scene.lanes())
    assert across <= TOLERANCE and rise <= TOLERANCE
    assert len(whole.roads) == 1 and whole.roads[0].length == pytest.approx(55.0 + 7.0 * abs(shift), abs=0.5) and not check_opendrive(whole).found


@pytest.mark.parametrize("shift", [-0.5, 0.5])
def test_a_lane_that_begins_and_ends_obliquely_is_whole(tmp_path, shift):
    scene, line = LaneScene(), Axis(((140.0, 0.0, 0.0),), slope=0.06)
    for piece, (first, last) in enumerate(((0, 40), (40, 100), (100, 140)), start=1):
        scene.add(line, 0.0, -3.5, first, last, lane=1, piece=piece)
    s = np.arange(40.0, 100.5)
    # the last 10 m of its outer border at both ends are longer or shorter by 3.5 m times the shift
    outer = np.interp(s, [40.0, 50.0, 90.0, 100.0], [40.0 + 3.5 * shift, 50.0, 90.0, 100.0 - 3.5 * shift])
    scene.piece(line.at(s, -3.5), line.at(outer, -7.0), lane=2)
    _, across, rise = missed(tmp_path, scene.lanes())
    assert across <= TOLERANCE and rise <= TOLERANCE


def test_a_road_and_its_ways_through_a_junction_meet_without_a_gap_where_the_lanes_are_cut_oblique(tmp_path):
    scene, line = LaneScene(), Axis(((80.0, 0.0, 0.0),))
    oblique(scene, line, 0.0, -3.5, 5.0, 40.0, 0.25, lane=1, **kinds())
    oblique(scene, line, 0.0, -3.5, 40.0, 55.0, 0.25, lane=1, piece=2, type="connector", left_kind="none", right_kind="none", left_pattern="",
          right_pattern="")
    oblique(scene, line, 0.0, -3.5, 55.0, 75.0, 0.25, lane=1, piece=3, **kinds())
    whole, across, _ = missed(tmp_path, scene.lanes())
    assert across <= TOLERANCE and len(whole.junctions) == 1
    assert not check_opendrive(whole).found


def test_one_border_that_is_bumpy_between_the_vertices_of_another_keeps_its_heights(tmp_path):
    scene, line = LaneScene(), Axis(((20.0, 0.0, 0.0), (40.0, 1 / 15, 1 / 15)))
    s = np.arange(0.0, 60.0)
    left, right = line.at(s, 0.0), line.at(s, -6.0)
    left[::3, 2] += 0.12
    scene.piece(left, right, lane=1)
    whole, across, rise = missed(tmp_path, scene.lanes())
    assert across <= TOLERANCE and rise <= TOLERANCE and len(whole.roads[0].shape)


@pytest.mark.parametrize("first", [True, False], ids=["at the start", "at the end"])
def test_lane_0_goes_straight_on_beside_lanes_that_lie_away_from_it(tmp_path, first):
    scene, line = LaneScene(), Axis(((80.0, 0.0, 0.0),))
    both, alone = ((10.0, 80.0), (0.0, 10.0)) if first else ((0.0, 70.0), (70.0, 80.0))
    scene.add(line, 0.0, -3.5, *both, lane=1)
    for piece, (a, b) in enumerate(sorted((both, alone)), start=1):
        scene.add(line, -3.5, -7.0, a, b, lane=2, piece=piece)
    whole, across, _ = missed(tmp_path, scene.lanes())
    road, = whole.roads
    assert across <= TOLERANCE and set(check_opendrive(whole).counts()) <= {"no way in", "dead end"}   # the other lane begins at full width
    assert np.abs(road.lane_offset.at(np.linspace(0, road.length, 400))).max() < TOLERANCE
    section = road.sections[0 if first else -1]
    assert [(id, section.lanes[id].type) for id in section.order] == [(0, "none"), (-1, "none"), (-2, "driving")]


def test_a_straight_road_that_is_cut_oblique_is_one_line(tmp_path):
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))
    oblique(scene, line, 0.0, -3.5, 5.0, 55.0, 0.4)
    whole, _, _ = missed(tmp_path, scene.lanes())
    element, = whole.roads[0].plan.elements
    assert element.kind == "line" and element.length == pytest.approx(50.0 + 3.5 * 0.4, abs=1e-3)


def test_a_shoulder_goes_on_beside_the_ways_through_a_junction(tmp_path):
    lanes, scene = parting(), LaneScene()
    outer = np.concatenate([lanes.borders(list(lanes.lane_id).index(f"1.1.{piece}"))[1][0 if piece == 1 else 1:] for piece in (1, 2, 3)])
    for k in range(len(lanes)):
        scene.piece(*lanes.borders(k), lane=int(lanes.lane[k]), piece=int(lanes.lane_id[k][-1]))
    scene.piece(outer, outer - [0.0, 2.0, 0.0], lane=3, type="shoulder", direction=0)
    lanes = scene.lanes()
    whole, across, _ = missed(tmp_path, lanes)
    assert across <= TOLERANCE and whole.junctions
    inside = [section for road in whole.roads if road.junction != "-1" for section in road.sections]
    assert any("shoulder" in [lane.type for lane in section.lanes.values()] for section in inside)


def test_noise_of_the_survey_makes_no_kinks_where_a_road_is_cut_into_sections(tmp_path):
    scene, line = LaneScene(), Axis(((80.0, 1 / 200, 1 / 200),))
    noise = np.random.default_rng(5).normal(0, 0.015, (3, 161))

    def border(row, offset):
        return lambda s: offset + np.interp(s, np.arange(161) / 2, noise[row])
    for piece in range(8):
        scene.add(line, border(0, 0.0), border(1, -3.5), 10.0 * piece, 10.0 * piece + 10, piece=piece + 1, step=0.5)
    whole, across, _ = missed(tmp_path, scene.lanes())
    assert len(whole.roads[0].sections) == 8 and across <= TOLERANCE
    assert not check_opendrive(whole).found


def test_noise_at_the_last_vertices_of_a_lane_makes_no_kink_where_a_way_through_a_junction_begins(tmp_path):
    scene, line = LaneScene(), Axis(((80.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5, 5.0, 40.0, lane=1, **kinds())
    scene.add(line, 0.0, -3.5, 40.0, 55.0, lane=1, piece=2, type="connector", left_kind="none", right_kind="none", left_pattern="", right_pattern="")
    scene.add(line, 0.0, -3.5, 55.0, 75.0, lane=1, piece=3, **kinds())
    lanes = scene.lanes()
    last = lanes.start[1] - 1
    # the last metre of both borders of the lane, and the first of the connector, turn aside by 0.04 m a metre
    for border in (lanes.left, lanes.right):
        border[last - 1, 1] -= 0.04
        border[last + 2, 1] -= 0.04
    whole, across, _ = missed(tmp_path, lanes)
    assert not check_opendrive(whole).found and across <= TOLERANCE
