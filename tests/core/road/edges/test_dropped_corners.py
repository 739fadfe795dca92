"""Corners of streets where the curb is dropped for a crossing."""

from dataclasses import replace

import curbed_streets as streets
import numpy as np
import pytest
from curbed_streets import EAST, NORTH
from lanewright.core.road.edges.corner_edges import dropped_corners
from lanewright.core.road.edges.road_edges import EdgePiece
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory

RADIUS = 8.0


def straight_frame():
    time, x, y, z = streets.driven()
    return build_frame(Trajectory(time, x + EAST, y + NORTH, z + 100))


def corner(turned):
    """Places on the corner from the right curb of the road, y = -3.5, into a side street, at degrees turned; it begins at x = 20."""
    turned = np.radians(turned)
    return np.c_[20 + RADIUS * np.sin(turned), -3.5 - RADIUS + RADIUS * np.cos(turned)]


def edge(places, kind="main", number=0, lift=0.0):
    vertices = np.c_[places + [EAST, NORTH], np.full(len(places), 100.0 + lift)]
    return EdgePiece(vertices, 0, "right", "measured", number, float(places[0, 0]), float(places[-1, 0]), 1.0, kind=kind)


def along(first, last, y=-3.5, count=20):
    x = np.linspace(first, last, count)
    return np.c_[x, np.full(len(x), y)]


def into_side_street(behind_corner=2.0):
    """The side street's curb from so many metres behind the corner."""
    return np.c_[np.full(80, 20 + RADIUS), np.linspace(-3.5 - RADIUS - behind_corner, -3.5 - RADIUS - 12.0, 80)]


def arcs(*pieces):
    return dropped_corners(pieces, straight_frame(), 7)


def test_the_edge_goes_on_around_a_corner_across_two_dropped_crossings():
    seen = edge(corner(np.linspace(35, 60, 10)), "corner", 1)
    found = arcs(edge(along(2, 17.0)), seen, edge(into_side_street(), "side_street", 2))
    assert [(piece.status, piece.kind) for piece in found] == [("bridged", "corner")] * 2
    truth = np.concatenate([along(15, 20, count=100), corner(np.linspace(0, 90, 400)), into_side_street(0.0)])
    for piece in found:
        away = np.hypot(*(piece.vertices[:, None, :2] - [EAST, NORTH] - truth).transpose(2, 0, 1)).min(1)
        assert away.max() < 0.10
    # each begins and ends where an edge does
    assert {tuple(np.round(piece.vertices[0, :2] - [EAST, NORTH], 2)) for piece in found} >= {(17.0, -3.5)}


def test_an_arc_across_a_dropped_crossing_is_less_certain_than_the_edges_it_joins_and_the_longer_the_less():
    seen, after = edge(corner(np.linspace(35, 60, 10)), "corner", 1), edge(into_side_street(), "side_street", 2)
    sure, doubtful = replace(seen, sigma=0.004), replace(seen, sigma=np.full(10, 0.09))
    before, shorter = (replace(edge(along(2, end)), sigma=0.004) for end in (17.0, 19.0))
    assert all(0.09 < piece.sigma < 0.15 for piece in arcs(before, doubtful, after))
    assert 0.004 < arcs(shorter, sure)[0].sigma < arcs(before, sure)[0].sigma


@pytest.mark.parametrize("first", [14.0, 18.0, 22.0])
@pytest.mark.parametrize("end", [16.5, 17.5])
def test_a_crossing_that_begins_well_before_the_corner_is_a_line_and_an_arc(first, end):
    arc, = arcs(edge(along(2, end)), edge(corner(np.linspace(first, 90, 20)), "corner", 1))
    truth = np.concatenate([along(15, 20, count=100), corner(np.linspace(0, 90, 400))])
    assert np.hypot(*(arc.vertices[:, None, :2] - [EAST, NORTH] - truth).transpose(2, 0, 1)).min(1).max() < 0.05


def test_the_curb_of_a_side_street_goes_straight_on_across_a_dropped_crossing():
    down = into_side_street()
    arc, = arcs(edge(down[:20], "side_street"), edge(down[50:], "side_street", 1))
    assert arc.length == pytest.approx(down[19, 1] - down[50, 1]) and np.abs(arc.vertices[:, 0] - EAST - 28.0).max() < 1e-3
    assert arcs(edge(down[:20], "side_street"), edge(down[50:] + [1.0, 0.0], "side_street", 1)) == []


def test_no_edge_leads_straight_across_the_road_from_one_street_into_the_one_opposite():
    before, behind = edge(np.c_[np.full(20, 28.0), np.linspace(-12, -3.6, 20)], "side_street"), \
        replace(edge(np.c_[np.full(20, 28.0), np.linspace(3.6, 12, 20)], "side_street", 1), side="left")
    assert arcs(edge(along(2, 17)), before, behind) == []


@pytest.mark.parametrize("pieces", [
    (edge(along(2, 17)), edge(along(23, 40), number=1)),
    (edge(along(2, 9)), edge(np.concatenate([along(16, 19.7), corner(np.linspace(0, 60, 10))]), "corner", 1)),
    (edge(along(2, 17)), edge(into_side_street(), "side_street", 1)),
    (edge(along(2, 8)), edge(corner(np.linspace(35, 60, 10)), "corner", 1)),
    (edge(along(2, 17)), edge(corner(np.linspace(35, 60, 10)) + [0.0, 3.0], "corner", 1)),
    (edge(along(2, 17)), edge(corner(np.linspace(35, 60, 10)), "corner", 1, lift=1.5)),
    (edge(along(2, 17)), edge(corner(np.linspace(35, 60, 10)), "island", 1))],
    ids=["a street's mouth", "a mouth before a short block of which the corner was found",
         "a corner of which nothing was seen", "too far away", "the other side of the way", "another level", "an island"])
def test_an_opening_stays_open(pieces):
    assert arcs(*pieces) == []


def test_a_street_without_edges_has_no_corners():
    assert arcs() == []
