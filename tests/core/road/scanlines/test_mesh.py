"""Vertices of section planes chained into lines."""

import numpy as np
from lanewright.core.road.scanlines.mesh import PlaneVertices, ScannerLines, increasing, plane_order, slanting_edges
from lanewright.core.survey.lattice.scan_lattice import MirrorPhase

PULSE = 0.001


def vertices(d, z, phase=None, plane=None, height=2.5):
    """Vertices as a track 2.5 m above offset 0 sees them."""
    d, z = np.asarray(d, float), np.asarray(z, float)
    phase = np.arange(len(d)) * PULSE if phase is None else np.asarray(phase, float)
    plane = np.zeros(len(d), int) if plane is None else np.asarray(plane)
    return PlaneVertices(plane, phase, d, z, d, z - height, 4.5 * PULSE)


def chained(v):
    """The vertices of every line."""
    order, first = v.lines()
    order = np.arange(len(v.d)) if order is None else order
    return [order[a:b].tolist() for a, b in zip(first[:-1], first[1:])]


def test_a_level_road_is_one_line_and_every_plane_has_its_own():
    assert chained(vertices(np.arange(10) * 0.05, np.zeros(10))) == [list(range(10))]
    assert chained(vertices(np.arange(10) * 0.05, np.zeros(10), plane=np.repeat([3, 4], 5))) == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]]


def test_some_points_may_be_missing_and_more_of_them_where_points_are_dense():
    assert len(chained(vertices([5.0, 5.3, 6.2, 6.5], np.zeros(4), phase=[0, 0.001, 0.005, 0.006]))) == 1
    assert len(chained(vertices([5.0, 5.3, 6.2, 6.5], np.zeros(4), phase=[0, 0.001, 0.008, 0.009]))) == 2
    assert len(chained(vertices([0.5, 0.51, 0.60, 0.61], np.zeros(4), phase=[0, 0.001, 0.010, 0.011]))) == 1


def test_a_car_and_the_ground_beside_it_seen_in_turn_are_a_line_each():
    ground, roof = np.arange(12) * 0.10 + 4.0, np.arange(6) * 0.10 + 2.0
    d, z = np.empty(18), np.zeros(18)
    car = np.arange(18) % 3 == 2
    d[~car], d[car], z[car] = ground, roof, 1.4
    assert chained(vertices(d, z, phase=np.arange(18) * PULSE / 3)) == [np.flatnonzero(~car).tolist(), np.flatnonzero(car).tolist()]


def test_a_point_in_the_air_parts_no_road():
    d, z = np.arange(9) * 0.05 + 1.0, np.zeros(9)
    d[4], z[4] = 0.6, 1.25  # half way down to the road
    assert chained(vertices(d, z)) == [[0, 1, 2, 3, 5, 6, 7, 8], [4]]


def test_from_the_edge_of_a_roof_no_line_goes_to_the_ground_behind():
    assert chained(vertices([2.6, 2.7, 2.8, 6.1, 6.2], [1.4, 1.4, 1.4, 0.0, 0.0])) == [[0, 1, 2], [3, 4]]
    # but road seen at a grazing angle is far apart too, and is one
    assert len(chained(vertices([13.0, 13.4, 13.8, 14.2], np.zeros(4)))) == 1


def test_noise_on_a_face_leaves_offsets_in_order():
    d = np.array([1.0, 1.02, 1.01, 1.03, 1.0, 2.0, 1.99])
    found = increasing(d, np.array([0, 4, 7]))
    assert (np.diff(found[:4]) >= 0).all() and (np.diff(found[4:]) >= 0).all()
    np.testing.assert_allclose(found, d, atol=0.011)


def test_vertices_are_put_in_order_by_plane_then_phase():
    rng = np.random.default_rng(2)
    plane, phase = rng.integers(0, 50, 2000), rng.random(2000)
    order = plane_order(plane, phase)
    np.testing.assert_array_equal(plane[order], np.sort(plane))
    assert (np.diff(plane[order] + 0.999 * phase[order]) > -1e-4).all()


def test_an_edge_that_runs_far_along_the_road_is_one_where_a_plane_lies_between_its_ends_and_its_points_are_joined():
    stations = np.array([1.02, 1.08, 1.13, 1.07, 1.03, 1.105, 1.12, 1.21])
    joined = np.array([True, True, True, True, False, True, True, False])
    none = np.zeros(len(stations))
    lines = ScannerLines(np.zeros(len(stations), np.int32), none, stations, none, none, None, none, joined, np.array([0.04]))
    found = slanting_edges(lines, MirrorPhase(100.0, np.array([0.0, 1.0]), np.array([0.0, 100.0])), 0.1)
    # of a turn of 4 cm an edge is 2 cm long at least; there and back over 1.10 m, and on over 1.20 m
    np.testing.assert_array_equal(found.point, [1, 2, 6])
    np.testing.assert_array_equal(found.ahead, found.point)
    np.testing.assert_allclose(found.near, [10.8, 11.3, 11.2])
    np.testing.assert_allclose(found.far, [11.3, 10.7, 12.1])
