"""Two roads beside each other: what stands between them is told once."""

import numpy as np
import pytest
from drives import drive, joined, straight
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.products.inventory.borders import RoadsideSettings
from lanewright.products.inventory.roadside.chains import Chain
from lanewright.products.inventory.roadside.find import Roadside, SideEdges, SideLine, told_once
from lanewright.products.inventory.roadside.uprights import LOW_BINS, UPRIGHT_SLICE, Pole, Uprights

APART, HALF, LENGTH = 20.0, 4.0, 100.0   # m between the tracks, from each to its edges


def rail(road, left, first=0.0, last=LENGTH, kind="guard_rail"):
    """A line so many metres left of a road's track."""
    number = np.arange(int(first / UPRIGHT_SLICE), int(last / UPRIGHT_SLICE))
    same = np.ones(len(number))
    members = Uprights(number, left * same, 0 * same, 0.75 * same, 0.4 * same, np.ones((len(number), LOW_BINS), bool), *[same] * 4, same < 0, same)
    return SideLine(kind, Chain(road, 1 if left > 0 else -1, members, left * same, 0 * same, 0.75 * same, 0 * number), 0.4)


def seen(*lines, poles=None):
    """A Roadside of two roads side by side, the second left of the first."""
    frame = build_frame(joined(drive(straight(LENGTH)), drive(straight(LENGTH, (0.0, APART)), start=2000.0)))
    assert len(frame.roads) == 2
    first = min(frame.roads, key=lambda road: road.to_map(np.array([50.0]), 0.0)[1][0]).number
    order = [first, 1 - first]
    s = np.array([0.0, LENGTH])
    edges = {road: SideEdges(s, np.full(2, -HALF), np.full(2, HALF), True) for road in (0, 1)}
    lines = [rail(order[road], *about) for road, *about in lines]
    found = Roadside(lines, {order[road]: here for road, here in (poles or {0: [], 1: []}).items()}, edges, frame, "", RoadsideSettings())
    return found, order, told_once(found)


@pytest.mark.parametrize("swapped", [False, True])
def test_the_rails_of_a_median_belong_each_to_the_road_it_stands_nearer_to(swapped):
    four = [(0, 5.0), (0, 15.0), (1, -5.0), (1, -15.0)]
    _, order, (kept, _) = seen(*four[::-1 if swapped else 1])
    assert {(order.index(line.chain.road), float(line.chain.d[0])) for line in kept} == {(0, 5.0), (1, -5.0)}


def test_what_one_road_alone_sees_stays_and_so_does_what_is_of_another_kind():
    _, _, (kept, _) = seen((0, 5.0), (1, 6.0), (0, 15.0), (1, -5.0, 0.0, LENGTH, "fence"))
    assert len(kept) == 4


def test_of_a_line_that_is_partly_seen_from_the_nearer_road_the_rest_stays():
    _, order, (kept, _) = seen((0, 15.0), (1, -5.0, 0.0, 40.0))
    spans = {order.index(line.chain.road): (line.chain.s[0], line.chain.s[-1]) for line in kept}
    assert spans[1] == pytest.approx((0.25, 39.75)) and spans[0] == pytest.approx((40.25, 99.75), abs=1.0)


def test_a_pole_between_two_roads_is_one_pole():
    def pole(d):
        return Pole("pole", 50.0, d, 0.0, 0.1, 4.0)

    _, order, (_, kept) = seen(poles={0: [pole(6.0), pole(-6.0)], 1: [pole(-14.0), pole(9.0)]})
    assert [[each.d for each in kept[order[road]]] for road in (0, 1)] == [[6.0, -6.0], [9.0]]
