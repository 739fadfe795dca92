"""Lanes that face each other across a double line, or a few centimetres, get one border."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from exported_maps import as_roads
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, opendrive_text
from lanewright.products.export.shared_borders import SHARED_FADE, meet_lanes, share_borders, with_shared_borders
from lanewright.products.export.sources import RoadMapSource, border_misses, checked, with_surface_heights
from made_lanes import CRS, Axis, LaneScene, crossing, double_line, kinds, parting, street


def exported(folder, lanes):
    source = with_shared_borders(checked(RoadMapSource(lanes)))
    return source, *as_roads(folder, source)


def test_facing_borders_of_a_double_line_meet_in_its_middle():
    lanes = double_line(apart=0.3)
    found = share_borders(lanes)
    first, second = (found.lanes.borders(list(lanes.lane_id).index(name))[0] for name in ("1.1.1", "1.2.1"))
    np.testing.assert_array_equal(first, second[::-1])
    middle = (lanes.borders(0)[0] + lanes.borders(list(lanes.lane_id).index("1.2.1"))[0][::-1]) / 2
    np.testing.assert_allclose(first, middle, atol=1e-9)
    assert found.moved == pytest.approx(0.15) and found.gaps[0] == pytest.approx([0.3, 0.0])
    np.testing.assert_array_equal(found.lanes.right, lanes.right)


@pytest.mark.parametrize("apart, roads", [(0.1, 1), (0.3, 1), (0.45, 1), (0.8, 2)])
def test_lanes_on_both_sides_of_a_double_line_are_one_road_and_of_a_median_two(tmp_path, apart, roads):
    def side(sign):
        return sign * apart / 2
    scene, line = LaneScene(), Axis(((80.0, 0.0, 1 / 80),))
    scene.add(line, side(-1), -3.5, lane=1, **{**kinds(), "left_pattern": "double-solid"})
    scene.add(line, 3.5, side(1), lane=2, direction=-1, **{**kinds(), "left_pattern": "double-solid"})
    source, _, whole = exported(tmp_path, scene.lanes())
    assert len(whole.roads) == roads and not check_opendrive(whole).found
    assert set(whole.roads[0].sections[0].lanes) == ({-1, 0, 1} if roads == 1 else {-1, 0})
    across, _ = border_misses(source.lanes, layers_of_opendrive(whole, CRS).lanes)
    assert across.largest < 0.02


@pytest.mark.parametrize("patterns, mark", [(("double-solid", "double-solid"), "solid solid"), (("solid", "solid"), "solid solid"),
                                            (("solid", "dashed"), "broken solid"), (("dashed", "solid"), "solid broken")])
def test_the_mark_of_the_middle_has_both_stripes_where_they_are(tmp_path, patterns, mark):
    _, draft, whole = exported(tmp_path, double_line(0.3, patterns))
    assert len(whole.roads) == 1 and not check_opendrive(whole).found
    found = whole.roads[0].sections[0].lanes[0].marks[0]
    assert found.type == mark and found.apart == pytest.approx(0.3, abs=0.01)
    text = opendrive_text(draft.map)
    assert 'tOffset="0.15"' in text and 'tOffset="-0.15"' in text


def test_beyond_a_common_border_lanes_come_back_to_their_own():
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))
    scene.add(line, -0.15, -3.5, 0, 60, lane=1, **kinds())
    scene.add(line, 3.5, 0.15, 0, 20, lane=2, direction=-1, **kinds())
    lanes = scene.lanes()
    left = share_borders(lanes).lanes.borders(0)[0]
    along = left[:, 0] - left[0, 0]
    moved = left[:, 1] - lanes.borders(0)[0][:, 1]
    assert moved[along <= 20] == pytest.approx(0.15, abs=1e-9) and np.abs(moved[along > 20 + SHARED_FADE]).max() == 0
    assert np.abs(np.diff(moved)).max() < 0.03   # no step of the border


@pytest.mark.parametrize("aside", [0.02, 0.1, -0.06])
def test_a_lane_placed_beside_or_on_a_measured_one_shares_its_border(tmp_path, aside):
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5, lane=1, **kinds())
    scene.add(line, 3.5, aside, lane=2, direction=-1, status="inferred", confidence=0.5, **kinds())
    _, _, whole = exported(tmp_path, scene.lanes())
    assert len(whole.roads) == 1 and whole.roads[0].sections[0].lanes[0].marks[0].type == "broken"


def test_lanes_that_share_their_borders_stay_as_they_are():
    lanes = street(((60.0, 1 / 50, 1 / 50),), cut=30.0)
    found = share_borders(lanes)
    assert found.moved == 0 and not found.gaps.any()
    np.testing.assert_array_equal(found.lanes.left, lanes.left)


def test_lanes_farther_apart_in_height_than_a_curb_are_of_two_roads():
    lanes = double_line(0.3)
    above = np.repeat(lanes.lane == 2, np.diff(lanes.start))[:, None] * np.array([0.0, 0.0, 5.0])
    assert share_borders(replace(lanes, left=lanes.left + above, right=lanes.right + above)).moved == 0


def test_where_lanes_part_there_is_a_junction_with_a_way_for_each(tmp_path):
    lanes = parting()
    _, draft, whole = exported(tmp_path, lanes)
    assert not check_opendrive(whole).found
    assert len(whole.junctions) == 1 and sum(road.junction != "-1" for road in whole.roads) == 2 and len(whole.roads) == 4
    names = {f"{road.id}.{id}.{number}": lane.data.get("lanewright:lane_id") for road in draft.map.roads
             for number, section in enumerate(road.sections) for id, lane in section.lanes.items()}
    again = layers_of_opendrive(whole).lanes
    led = {(names[id], names[other]) for id, others in zip(again.lane_id, again.successors) for other in others if names[id] != names[other]}
    assert led == {(id, other) for id, others in zip(lanes.lane_id, lanes.successors) for other in others}


@pytest.mark.parametrize("off", [0.05, 0.3])
def test_a_connector_begins_and_ends_where_its_lanes_do(tmp_path, off):
    lanes = crossing()
    aside = np.repeat(lanes.type == "connector", np.diff(lanes.start))[:, None] * np.array([off, off / 2, 0.0])
    missed = replace(lanes, left=lanes.left + aside, right=lanes.right + aside)
    met = meet_lanes(missed)
    np.testing.assert_allclose(met.left[lanes.start[:-1]], lanes.left[lanes.start[:-1]], atol=1e-9)
    np.testing.assert_allclose(met.right[lanes.start[1:] - 1], lanes.right[lanes.start[1:] - 1], atol=1e-9)
    _, _, whole = exported(tmp_path, missed)
    assert "gap at a link" in check_opendrive(as_roads(tmp_path, RoadMapSource(missed))[1]).counts()
    assert "gap at a link" not in check_opendrive(whole).counts()


def test_a_corner_in_the_middle_line_folds_no_lane(tmp_path):
    scene, line = LaneScene(), Axis(((60.0, 0.0, 0.0),))

    def jog(s):
        return np.where(s > 30.0, 0.3, 0.0)
    scene.add(line, jog, -6.5, lane=1, step=0.5, **kinds())
    scene.add(line, 6.5, jog, lane=2, direction=-1, step=0.5, **kinds())
    lanes = scene.lanes()
    source, _, whole = exported(tmp_path, lanes)
    assert not check_opendrive(whole).found
    across, _ = border_misses(source.lanes, layers_of_opendrive(whole, CRS).lanes)
    assert across.largest < 0.05


def test_a_border_has_one_height_for_all_lanes_beside_it():
    lanes = street()
    left = lanes.left.copy()
    left[lanes.start[1]:, 2] += 0.2     # the border between both lanes as the second one has it
    found = share_borders(replace(lanes, left=left)).lanes
    first, second = (found.borders(k)[0] for k in (0, 1))
    np.testing.assert_array_equal(first, second[::-1])
    np.testing.assert_allclose(first[:, 2], lanes.left[0, 2] + 0.1)
    np.testing.assert_array_equal(found.right, lanes.right)


def test_borders_follow_the_surface_across_a_gap_of_its_points():
    lanes = street()
    x, y, z = lanes.left[:lanes.start[1]].T
    there = (x - x[0] < 20) | (x - x[0] > 30)
    points = [np.repeat(values[there], 9) for values in (x, y, z + 0.2)]
    section = SimpleNamespace(**dict(zip("xyz", points)))
    found, share = with_surface_heights(lanes, SimpleNamespace(origin=np.zeros(3), all_sections=lambda: [(1, 0)], section=lambda *key: section))
    np.testing.assert_allclose(found.left[:, 2], lanes.left[:, 2] + 0.2, atol=1e-9)
    np.testing.assert_array_equal(found.right, lanes.right)
    assert 0.3 < share < 0.5


def test_road_points_of_another_survey_are_refused():
    section = SimpleNamespace(x=np.arange(9.0), y=np.zeros(9), z=np.zeros(9))
    with pytest.raises(RoadExtractionError, match="do not lie where the lanes are"):
        with_surface_heights(street(), SimpleNamespace(origin=np.zeros(3), all_sections=lambda: [(1, 0)], section=lambda *key: section))
