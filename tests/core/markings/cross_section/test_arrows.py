"""Which way painted arrows point, by their outlines."""

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.markings.cross_section.candidates import boundary_candidates, gather_boundaries
from lanewright.core.markings.cross_section.evidence import driven_offsets, evidence_of
from lanewright.core.markings.cross_section.roads import arrows_of
from lanewright.core.markings.cross_section.sections import sections_of_lines
from lanewright.core.markings.cross_section.weights import EstimateWeights
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.simulator.parts.paint import left_arrow, straight_arrow, turn_arrow
from lined_streets import HEIGHT, Street
from shapely.geometry import Polygon


def ways(street, *outlines, cluster=None):
    layer = Features("PolygonZ", MARKINGS)
    for outline in outlines:
        places = street.places(*outline.T)
        layer.add(Polygon(np.c_[places, np.full(len(places), HEIGHT)]), road=0, use="other", cluster=cluster, **{"class": "arrow"})
    return arrows_of(MarkingObjects.from_features(layer, street.frame), street.frame, 0)


def turned(outline, angle):
    """An outline turned about its middle, degrees."""
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    middle = outline.mean(axis=0)
    return (outline - middle) @ np.array([[cos, sin], [-sin, cos]]) + middle


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("made", [straight_arrow, turn_arrow, left_arrow])
def test_an_arrow_points_from_its_shaft_to_its_head(made, way):
    found = ways(Street(), made(50.0, 1.5, way))
    assert np.sign(found[0, 2]) == way and abs(found[0, 2]) > 0.8
    assert found[0, 0] == pytest.approx(50.0 + way * 2.25, abs=0.1)


@pytest.mark.parametrize("way", [1, -1])
def test_an_arrow_points_the_same_way_oblique_in_a_bend_and_where_the_street_was_driven_backwards(way):
    for street in (Street(radius=60.0), Street(vehicle=1.75, backwards=True)):
        found = ways(street, *(turned(straight_arrow(60.0, 1.5, way), angle) for angle in (-15.0, 0.0, 15.0)))
        assert (np.sign(found[:, 2]) == way * (-1 if street.radius is None else 1)).all()


def test_what_is_alike_at_both_ends_points_nowhere():
    diamond = np.array([(40.0, 0.0), (41.5, 0.75), (43.0, 0.0), (41.5, -0.75)])
    assert ways(Street(), diamond)[0, 2] == pytest.approx(0.0, abs=0.2)


def test_a_letter_taken_for_an_arrow_points_nowhere():
    """An E without its last bar: a stroke, and as broad at its end as anywhere."""
    letter = np.array([(40.0, 0.0), (43.2, 0.0), (43.2, -0.7), (42.9, -0.7), (42.9, -0.2), (41.7, -0.2), (41.7, -0.7), (41.4, -0.7), (41.4, -0.2),
                       (40.0, -0.2)])
    assert ways(Street(), letter)[0, 2] == 0.0


def test_the_parts_that_wear_left_of_an_arrow_are_one_arrow():
    street, whole = Street(), straight_arrow(50.0, 1.5, 1)
    shaft, head = whole[[0, 1, 5, 6]] - (0.1, 0.0), whole[2:5] + (0.1, 0.0)
    assert len(ways(street, shaft[[0, 1, 2, 3]] * (0.5, 1.0) + (25.0, 0.0), head)) == 0
    found = ways(street, shaft, head, cluster=7)
    assert len(found) == 1 and found[0, 2] == 1.0


def test_an_arrow_shorter_than_a_lane_of_a_road_has_counts_for_no_lane():
    small = (straight_arrow(50.0, 1.5, 1) - (50.0, 1.5)) * (1.5 / 4.5, 0.5) + (50.0, 1.5)
    assert np.ptp(small[:, 0]) < 2.0 and not len(ways(Street(), small))
    assert len(ways(Street(), small, straight_arrow(70.0, 1.5, 1))) == 1


def test_arrows_in_the_middle_of_an_oblique_lane_lie_in_the_middle_of_its_mean_place():
    """Two lines 3 m apart that move aside by one in twenty, and arrows all along."""
    street = Street().paint(lambda s: 1.5 + s / 20).paint(lambda s: -1.5 + s / 20)
    lines = sections_of_lines(PaintedLines.from_features(street.lines, street.frame))[0]
    candidates = boundary_candidates(gather_boundaries(lines), EstimateWeights())
    station = np.arange(10.0, 110.0, 3.0)
    along, aside = street.frame.road(0).locate(*(street.places(station, station / 20) - street.frame.origin[:2]).T, corridor=9.0)
    arrows = np.column_stack([along, aside, np.ones(len(station))])
    found = evidence_of(candidates, lines.s, *driven_offsets(street.frame, 0, lines.s), arrows=arrows).arrows
    middle = [candidates.left[k][candidates.valid[k]][1:-1].mean() for k in found[:, 0].astype(int)]
    assert len(found) == len(station)
    np.testing.assert_allclose(found[:, 1], middle, atol=0.02)
