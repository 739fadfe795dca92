"""Edge lines follow the edge of the road where it widens."""

import numpy as np
import pytest
import shapely
from clustered_streets import ClusteredStreet
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.execution.phase import digest
from lanewright.core.markings.lines.strands import edges_beside
from lanewright.core.road.edges.road_edges import RoadEdges


def widening(s):
    """Offset of an edge line along a road that widens by 1.8 m within 12 m, as before a hairpin."""
    return 3.0 + 1.8 * np.clip((s - 40.0) / 12.0, 0.0, 1.0)


def worn_street():
    """The line is worn away but for a metre here and there where the road widens; the other edge line runs straight on."""
    street = ClusteredStreet(radius=None).paint(0, 120, -3.0, kind="edge").paint(0, 40.5, 3.0, kind="edge").paint(54, 120, 4.8, kind="edge")
    for first in (42.0, 46.0, 49.5):
        street.paint(first, first + 1.0, float(widening(first + 0.5)), width=0.15, kind="edge")
    return street


def test_a_worn_edge_line_is_one_line_along_the_edge_of_a_road_that_widens():
    street = worn_street()
    found = street.lines(edges=street.pavement(lambda s: widening(s) + 0.3))
    assert len({row["line"] for row in found.rows}) == 2
    left = [line for line, row in found if np.mean(np.asarray(line.coords)[:, 1]) > 5_400_000.0]
    x, y = np.concatenate([shapely.get_coordinates(line) for line in left]).T
    np.testing.assert_allclose(y - 5_400_000.0, widening(x - 500_000.0), atol=0.12)


def bending(s):
    """Offset of an edge line that bends out and back in again along a taper of 18 m."""
    share = np.clip((s - 36.0) / 18.0, 0.0, 1.0)
    return 3.0 + 1.8 * share**2 * (3 - 2 * share)


@pytest.mark.parametrize("side", [1, -1])
def test_a_line_that_bends_away_along_a_taper_goes_on_where_it_is_seen_next_at_the_same_distance_from_the_edge(side):
    """Where its tip points says less: it was straight until 5 m before. What wear left of it is a metre of paint in the taper."""
    street = ClusteredStreet(radius=None).paint(0, 120, -3.0 * side, kind="edge").paint(0, 38, 3.0 * side, kind="edge")
    for first in np.r_[np.arange(38.0, 42.5, 0.5), 46.0, 46.5]:
        street.paint(first, first + 0.5, float(bending(first + 0.25)) * side, width=0.15, kind="edge")
    street.paint(54, 120, 4.8 * side, kind="edge")
    found = street.lines(edges=street.pavement(lambda s: side * (bending(s) + 0.3)))
    assert len({row["line"] for row in found.rows}) == 2


@pytest.mark.parametrize("side", [1, -1])
def test_a_gap_of_a_line_is_not_led_into_a_bay_of_the_edge_that_lies_beside_it_only_there(side):
    """Line and edge are 2 cm farther out behind the gap, so its ends alone say that it runs along the edge."""
    street = ClusteredStreet(radius=None).paint(0, 120, -3.0 * side, kind="edge")
    street.paint(0, 40, 1.5 * side, kind="lane").paint(64, 120, 1.52 * side, kind="lane")

    def edge(s):
        return side * (4.5 + 0.02 * (s > 52.0) + np.clip(np.minimum(s - 46.0, 58.0 - s) / 2.0, 0.0, 1.0))

    found = street.lines(edges=street.pavement(edge))
    assert len({row["line"] for row in found.rows}) == 2
    x, y = np.concatenate([shapely.get_coordinates(line) for line, _ in found]).T
    off = side * (y - 5_400_000.0)
    gap = (off > 0) & (x > 500_041.0) & (x < 500_063.0)
    assert gap.sum() > 20 and np.abs(off[gap] - 1.51).max() < 0.05


def test_without_an_edge_the_two_ends_of_it_are_lines_of_their_own():
    assert len({row["line"] for row in worn_street().lines().rows}) > 2


def test_an_edge_leads_between_two_places_that_it_passes_and_between_no_others():
    street = ClusteredStreet(radius=None)
    beside = edges_beside(street.pavement(lambda s: 3.3 + 0.0 * s), {0: [], 1: []})
    course = beside[0].between((10.0, 4.6), (50.0, 4.6))
    assert course is not None and abs(course(np.array([30.0]))[0] - (3.3 + 1.6)) < 0.02
    assert beside[0].between((10.0, 4.6), (50.0, -3.0)) is None
    assert beside[1].between((10.0, 4.6), (50.0, 4.6)) is None
    assert edges_beside(None, {0: []})[0].between((10.0, 4.6), (50.0, 4.6)) is None


def test_what_is_known_of_islands_bars_the_way_and_can_be_sent_to_another_process():
    street, edges = ClusteredStreet(radius=None), Features("LineStringZ", list(ROAD_EDGES))
    station = np.arange(20.0, 30.0, 0.5)
    for side, offset in (("left", 2.0), ("right", -2.0)):
        places = np.c_[street.place(station, np.full(len(station), offset)), np.full(len(station), 50.0)]
        edges.add(shapely.linestrings(places), road=0, kind="island", edge="curb", status="measured", part="bottom", chain=1, side=side)
    beside = edges_beside(RoadEdges.from_features(edges, street.frame), {0: []})[0]
    assert beside.bars(np.array([[15.0, 35.0]] * 2), np.array([[0.0, 0.0], [6.0, 6.0]])).tolist() == [True, False]
    assert digest(beside) == digest(edges_beside(RoadEdges.from_features(edges, street.frame), {0: []})[0])
