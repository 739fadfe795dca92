"""Curbs where points are few: far out along a line that is known, behind an island, and on a road that tilts."""

import numpy as np
import pytest
import shapely
import shapely.affinity
from curbed_streets import EAST, NORTH
from lanewright.core.road.curb_returns import detect
from lanewright.core.road.curb_returns.extended_curbs import FollowedEnds, followed_steps, island_ends
from lanewright.core.road.curb_returns.ground_raster import ground_raster, ground_slopes
from lanewright.core.road.curb_returns.islands import far_sides, ground_behind
from lanewright.core.road.curb_returns.steps import PlanSteps
from lanewright.core.road.weights import RETURN
from road_layers import detect_curbs, fit_road_edges
from street_plans import scan, side_street, sidewalks, survey_along

LEFT_CURB = 16.0   # x of the one curb of the side street


def lines_of(edges, *kinds):
    return [shapely.affinity.translate(shapely.force_2d(g), -EAST, -NORTH) for g, row in edges if row["kind"] in kinds]


def thinned(points, where, keep, seed=3):
    """A scan of which a share of the points in a polygon is left."""
    lost = shapely.contains_xy(where, points[0], points[1]) & (np.random.default_rng(seed).uniform(size=len(points[0])) > keep)
    return tuple(v[~lost] for v in points)


def a_raster(raised, keep=0.3, grade=0.0, seed=8):
    x, y, z, _ = thinned(scan(raised, seed=seed), shapely.box(-50, 4.5, 50, 50), keep)
    return ground_raster(x, y, z + grade * y, 0.05)


def followed(raster, height=0.12, across=0.0, grade=0.0):
    """Steps in the continuation of the left curb of the side street, from y = 5.5 outward."""
    ends = FollowedEnds(*np.array([[LEFT_CURB + across, 5.5, 5.5 * grade, 0.0, 1.0, -1.0, height, 0]]).T)
    return followed_steps(raster, ends, 0.025, 0.35, np.radians(60.0), lambda x, y: y < 12.5)


def test_a_curb_is_followed_into_ground_of_few_points():
    street = side_street(radius=0.1)
    found = followed(a_raster(street, keep=0.12))
    assert len(found) > 10 and found.y.max() > 10.5
    np.testing.assert_allclose(found.x, LEFT_CURB, atol=0.05)
    np.testing.assert_allclose(found.height, 0.12, atol=0.02)


def test_a_grade_along_a_followed_curb_is_no_roughness():
    assert followed(a_raster(side_street(radius=0.1), keep=0.3, grade=0.05), grade=0.05).y.max(initial=0.0) > 11.0


def test_a_line_ends_where_the_curb_does():
    end = shapely.box(0, 8.0, 40, 50)   # level ground from there on
    found = followed(a_raster(shapely.difference(side_street(radius=0.1), end)))
    assert len(found) and found.y.max() <= 8.3


def test_where_points_are_dense_nothing_is_added():
    """What goes on there was found already."""
    assert not len(followed(a_raster(side_street(radius=0.1), keep=1.0)))


def test_what_is_higher_than_the_line_or_beside_it_is_something_else():
    raster = a_raster(side_street(radius=0.1))
    assert len(followed(raster))
    assert not len(followed(raster, height=0.05)) and not len(followed(raster, across=0.15))


def test_an_island_that_hides_its_own_far_side_is_surrounded():
    island = shapely.buffer(shapely.box(12.4, 1.4, 25.6, 2.8), 0.4)
    shadow = shapely.difference(shapely.box(11, 3.0, 27, 3.7), island)   # of its far side, with the face
    face = shapely.intersection(shapely.buffer(shapely.boundary(island), 0.02), shapely.box(11, 3.0, 27, 4.0))
    street = shapely.union_all([sidewalks(7.0), island])
    survey = survey_along(scan(street, hidden=shapely.union_all([shadow, face])), -1.0)
    edges = fit_road_edges(detect_curbs(survey), survey.frame)
    far = shapely.LineString([(13.5, 3.2), (24.5, 3.2)])
    lines = shapely.union_all(lines_of(edges, "island"))
    assert shapely.intersection(far, shapely.buffer(lines, 0.08)).length > 0.8 * far.length


def test_a_vehicle_beside_an_island_sees_where_its_far_side_ends():
    """It hides 8 cm of the road behind it, so that no cell of the raster is empty there."""
    island = shapely.box(10, 1.0, 30, 3.24)
    raster = ground_raster(*scan(island, hidden=shapely.box(5, 3.22, 35, 3.32), seed=5)[:3], 0.05)
    x = np.arange(12.0, 28.0, 0.25)
    level = np.zeros(len(x))
    near = PlanSteps(x, level + 1.0, level, level + 1.0, level, level + 0.12, level, level + 0.003, level + 20, level + 20)
    far = far_sides(raster, near, ground_behind(raster, ground_slopes(raster.low), *near.columns()[:6], RETURN.max_island_width))
    assert len(far) > 0.9 * len(x)
    assert np.abs(far.y - 3.22).max() < 0.1 and np.median(np.abs(far.y - 3.22)) < 0.02


@pytest.mark.parametrize("dropped, ends", [(0.035, True), (0.0, False)])
def test_an_island_that_is_dropped_for_a_crossing_ends_where_its_step_of_centimetres_is(dropped, ends):
    """One that comes down to the road in a ramp has no curb there."""
    x, y, z, _ = scan(shapely.box(10, 1.0, 26, 3.0), noise=0.004, hidden=shapely.box(25, 0.95, 27, 3.05), spacing=0.03)
    grid = np.random.default_rng(4).uniform((25, 0.95), (27, 3.05), (4000, 2))
    top = np.where((grid[:, 0] < 26) & (grid[:, 1] > 1.0) & (grid[:, 1] < 3.0), dropped + (26 - grid[:, 0]) * (0.12 - dropped), 0.0)
    raster = ground_raster(np.r_[x, grid[:, 0]], np.r_[y, grid[:, 1]], np.r_[z, top + np.random.default_rng(5).normal(0.0, 0.004, len(top))], 0.05)
    along = np.arange(14.0, 25.0, 0.3)
    level = np.zeros(2 * len(along))
    sides = PlanSteps(np.r_[along, along], np.repeat([1.0, 3.0], len(along)), level, np.repeat([1.0, -1.0], len(along)), level, level + 0.12,
                      level, level + 0.004, level + 20, level + 20)
    end = island_ends(raster, sides)
    assert bool(len(end)) == ends
    np.testing.assert_allclose(end.x, 26.0, atol=0.03)
    np.testing.assert_allclose(end.height, dropped, atol=0.008)


def test_an_end_of_an_island_where_the_road_has_no_station_ends_no_run(monkeypatch):
    """As in the middle of a tight ring, or beyond the end of the drive."""
    survey, across = survey_along(scan(sidewalks(7.0)), -1.0), np.arange(-1.8, 1.8, 0.3)
    level = np.zeros(len(across))
    beyond = PlanSteps(level + survey.frame.roads[0].start - 6.0, across, level + 1.0, level, level, level + 0.1, level, level + 0.003,
                       level + 20, level + 20)
    monkeypatch.setattr(detect, "island_ends", lambda ground, steps: beyond)
    assert not (np.array([row["kind"] for row in detect_curbs(survey).rows]) == "island").any()


def test_an_island_on_a_road_that_tilts_where_it_stands_is_one():
    """The road is level before it and behind it: the slope of the stretch is not that of the place."""
    island = shapely.box(16, 1.6, 20, 3.2)
    x, y, z, time = scan(shapely.union_all([sidewalks(7.0), island]))
    tilt = 0.05 * np.clip(1.0 - np.abs(x - 18.0) / 8.0, 0.0, 1.0)
    survey = survey_along((x, y, z + tilt * y, time), -1.0)
    edges = fit_road_edges(detect_curbs(survey), survey.frame)
    assert shapely.union_all(lines_of(edges, "island")).length > 0.65 * island.length
