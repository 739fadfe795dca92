"""Curbs that do not run along the road: corners, side streets, islands, and what is none of them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely
import shapely.affinity
import street_plans
from curbed_streets import EAST, NORTH, parked_car
from lanewright.core.road.curb_returns import detect as curbs
from lanewright.core.road.curb_returns.steps import measure_plan_steps
from lanewright.core.road.edges.road_edges import RoadEdges
from lanewright.core.road.surface.pavement_edge import edge_offsets
from road_layers import detect_curbs, fit_road_edges
from street_plans import LENGTH, scan, side_street, sidewalks, survey_along, with_points


def edges_of(points, offset=0.0):
    survey = survey_along(points, offset)
    return fit_road_edges(detect_curbs(survey), survey.frame)


@cache
def edges_of_a_side_street(radius=5.0):
    return edges_of(scan(side_street(radius=radius)))


def in_plan(edges, *kinds):
    """Lines of some kinds about the street's start."""
    return [shapely.affinity.translate(shapely.force_2d(g), -EAST, -NORTH) for g, row in edges if row["kind"] in kinds]


def curb_returns(edges):
    return in_plan(edges, "corner", "side_street", "island")


def farthest(lines, truth):
    """Largest distance of the lines from the true curb."""
    places = shapely.points(shapely.get_coordinates(shapely.segmentize(shapely.union_all(lines), 0.05)))
    return float(shapely.distance(truth, places).max())


@pytest.mark.parametrize("radius", [3.0, 6.0])
def test_the_curb_goes_around_the_corner_into_the_side_street(radius):
    ground = side_street(radius=radius)
    edges = edges_of_a_side_street(radius)
    truth = shapely.boundary(ground)
    lines = in_plan(edges, "corner", "side_street")
    assert farthest(lines, truth) < 0.04
    # both curbs of the side street, as far out as the street was scanned
    wanted = shapely.intersection(truth, shapely.box(8, 4.0, 32, 12.0))
    assert shapely.intersection(wanted, shapely.buffer(shapely.union_all(in_plan(edges, "main", "corner", "side_street")), 0.05)).length \
        > 0.95 * wanted.length
    assert {row["side"] for row in edges.rows if row["kind"] != "main"} == {"left"}


@pytest.mark.slow
def test_a_dense_scan_with_centimetres_of_noise_shows_the_corner():
    ground = side_street()
    edges = edges_of(scan(ground, noise=0.02, spacing=0.035))
    lines = in_plan(edges, "corner", "side_street")
    assert farthest(lines, shapely.boundary(ground)) < 0.06
    assert shapely.union_all(lines).length > 10.0
    assert not in_plan(edges, "island")


def test_a_street_whose_corner_is_hidden_is_drawn_where_it_is_seen():
    ground = side_street(start=14.0, end=24.0)
    edges = edges_of(scan(ground, hidden=shapely.box(5, 3.2, 14.3, 6.0)))
    lines = [line for line in in_plan(edges, "side_street") if line.bounds[0] < 15]
    assert shapely.union_all(lines).length > 4.0
    assert farthest(lines, shapely.boundary(ground)) < 0.04


def test_a_corner_begins_where_the_main_edge_ends():
    edges = edges_of_a_side_street()
    ends = {g.coords[k] for g, row in edges if row["kind"] == "main" for k in (0, -1)}
    corners = [geometry for geometry, row in edges if row["kind"] == "corner"]
    assert len(corners) == 2
    assert all(corner.coords[0] in ends or corner.coords[-1] in ends for corner in corners)


ROUND, SQUARE = shapely.buffer(shapely.LineString([(12, 2.2), (26, 2.2)]), 0.75), shapely.box(12, 1.6, 26, 2.8)


@cache
def survey_and_edges_of(island):
    survey = survey_along(scan(shapely.union_all([sidewalks(7.0), island])), offset=-1.0)
    return survey, fit_road_edges(detect_curbs(survey), survey.frame)


@pytest.mark.parametrize(("island", "within"), [(ROUND, 0.05), (SQUARE, 0.3)])
def test_an_island_is_surrounded(island, within):
    edges = survey_and_edges_of(island)[1]
    lines = in_plan(edges, "island")
    around = shapely.boundary(island)
    assert farthest(lines, around) < within
    assert shapely.intersection(around, shapely.buffer(shapely.union_all(lines), 0.05)).length > 0.85 * around.length
    assert not in_plan(edges, "corner", "side_street")


def test_the_kind_of_a_line_follows_from_where_it_leads():
    edges = edges_of_a_side_street()
    for line in in_plan(edges, "side_street"):
        # its curbs run along x = 16 and x = 23, beyond the corners
        assert line.bounds[2] - line.bounds[0] < 0.1
        assert line.bounds[1] > 7.5
    assert sum(line.length for line in in_plan(edges, "side_street")) > 6.0


def test_a_straight_street_has_no_other_curbs():
    assert not curb_returns(edges_of(scan(sidewalks())))


def test_a_garden_step_behind_a_driveway_is_no_curb():
    lot = shapely.box(15, 3.0, 21, 30)
    street = shapely.difference(sidewalks(), lot)
    garden = shapely.box(15, 7.0, 21, 30)
    edges = edges_of(scan(shapely.union_all([street, garden])))
    assert not in_plan(edges, "island")
    step = shapely.LineString([(15.6, 7), (20.4, 7)])
    assert all(line.distance(step) > 0.3 for line in curb_returns(edges))


def test_a_parked_car_is_no_island():
    points = parked_car(scan(sidewalks(5.0)), 12.0, near=2.0, far=3.8)
    assert not curb_returns(edges_of(points))


def test_a_wall_across_an_opening_is_no_curb():
    rng = np.random.default_rng(1)
    street = shapely.difference(sidewalks(), shapely.box(14, 3.0, 24, 30))
    wall = rng.uniform(14.0, 24.0, 6000), 9.0 + rng.normal(0, 0.003, 6000), rng.uniform(0.0, 1.5, 6000)
    points = with_points(scan(street, hidden=shapely.box(10, 9.02, 28, 30)), *wall)
    for line in curb_returns(edges_of(points)):
        assert line.distance(shapely.LineString([(15, 9), (23, 9)])) > 0.3


def test_a_speed_hump_is_no_island():
    x, y, z, time = scan(sidewalks())
    z = z + np.where(np.abs(y) < 3.5, np.clip(0.10 - 0.15 * np.abs(x - 20.0), 0.0, 0.06), 0.0)
    assert not curb_returns(edges_of((x, y, z, time)))


@pytest.mark.parametrize("grade", [-0.06, 0.06])
def test_a_superelevated_road_does_not_hide_its_island(grade):
    edges = edges_of(scan(shapely.union_all([sidewalks(7.0), SQUARE]), grade=grade), offset=-1.0)
    assert shapely.union_all(in_plan(edges, "island")).length > 0.8 * SQUARE.length


def test_the_order_of_the_points_does_not_matter():
    points = scan(side_street())
    order = np.random.default_rng(2).permutation(len(points[0]))
    first, second = edges_of_a_side_street(), edges_of(tuple(v[order] for v in points))
    assert [g.wkb for g in first.geometries] == [g.wkb for g in second.geometries]
    assert first.rows == second.rows


def test_the_width_of_the_road_follows_from_its_own_curbs_alone():
    survey, edges = survey_and_edges_of(SQUARE)
    assert in_plan(edges, "island")
    stations = np.arange(2.0, LENGTH - 2.0, 1.0)
    left, seen = edge_offsets(RoadEdges.from_features(edges, survey.frame), 0, stations)["left"]
    assert seen.all()
    np.testing.assert_allclose(left, 8.0, atol=0.03)


def test_steps_measured_just_beyond_the_corridor_are_left_out(monkeypatch):
    """They are sought within it; here all are found a little farther out than that."""
    def farther_out(*arguments):
        steps = measure_plan_steps(*arguments)
        return replace(steps, y=steps.y + 0.3)

    monkeypatch.setattr(street_plans, "WIDTH", 28.0)
    monkeypatch.setattr(curbs, "measure_plan_steps", farther_out)
    edges = edges_of(scan(side_street(radius=4.0), spacing=0.1))
    assert np.isfinite(np.concatenate([shapely.get_coordinates(line, include_z=True) for line in edges.geometries])).all()
    assert 23.0 < shapely.union_all(curb_returns(edges)).bounds[3] <= 25.0
