"""Rows of narrow lines across the road beside the lanes are parking bays; joints that cross driven lanes are none."""

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.markings.cross_section.evidence import BINS, places_of_bays, rows_of_bays
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lined_streets import HEIGHT, Street
from shapely.geometry import Polygon

S = np.arange(0.0, 120.0, 0.5)
PERPENDICULAR = np.arange(30.0, 80.0, 2.5)


def bays(*rows, width=0.1, driven=-1.5, skew=0.0):
    """What is found of lines at stations between two offsets, (stations, right, left) each, on a street driven at an offset."""
    street = Street(vehicle=0.0)
    layer = Features("PolygonZ", MARKINGS)
    for stations, right, left in rows:
        for s in stations:
            lean = skew * (left - right)
            corners = street.places([s, s + width, s + width + lean, s + lean], [right, right, left, left])
            layer.add(Polygon(np.c_[corners, np.full(4, HEIGHT)]), **{"road": 0, "class": "symbol", "use": "other", "width_m": width})
    track = np.full((1, len(S)), driven)
    places, ends = places_of_bays(rows_of_bays(MarkingObjects.from_features(layer, street.frame), 0, S, track), S, track)
    return places, ends[np.arange(len(ends)), :]


@pytest.mark.parametrize("stations, skew", [(PERPENDICULAR, 0.0), (np.arange(30.0, 80.0, 3.4), 1.0), (np.arange(20.0, 100.0, 6.0), 0.0)],
                         ids=["perpendicular", "oblique", "parallel"])
def test_a_row_of_lines_across_the_road_is_parking_bays(stations, skew):
    places, ends = bays((stations, -7.5, -3.0), skew=skew)
    inside = (S > stations[1] + 3.0) & (S < stations[-2])
    offset = (np.arange(BINS) + 0.5) * 0.2 - 30.0
    assert places[inside][:, (offset > -7.3) & (offset < -3.2)].all()
    assert not places[:, (offset > -2.9) | (offset < -7.6)].any() and not places[(S < stations[0]) | (S > stations[-1] + 4.5)].any()
    assert ends.shape == (1, len(S))
    np.testing.assert_allclose(ends[0][inside], -3.0, atol=0.01)


def test_lines_that_cars_hide_leave_the_row_whole():
    seen = np.delete(PERPENDICULAR, [3, 4, 9, 14])
    places, ends = bays((seen, -7.5, -3.0))
    assert np.isfinite(ends).sum() == pytest.approx(2 * np.ptp(PERPENDICULAR), abs=2)
    assert places.any(axis=1).sum() == np.isfinite(ends).sum()


def test_bays_on_the_left_end_towards_the_vehicle_too():
    _, ends = bays((PERPENDICULAR, 3.0, 5.5))
    np.testing.assert_allclose(ends[np.isfinite(ends)], 3.0, atol=0.01)


@pytest.mark.parametrize("rows, width", [
    (((PERPENDICULAR[:3], -7.5, -3.0),), 0.1), (((np.array([30.0, 33.1, 40.0, 42.2, 49.0, 54.5]), -7.5, -3.0),), 0.1),
    (((PERPENDICULAR, -3.9, -3.0),), 0.1), (((PERPENDICULAR, -7.5, -3.0),), 0.5),
    (((PERPENDICULAR, -3.0, 0.0),), 0.1), (((PERPENDICULAR, -3.0, -0.1), (PERPENDICULAR, 0.1, 3.0)), 0.1),
], ids=["three lines", "an uneven pace", "short strokes", "broad bars", "in the driven lane", "joints of both lanes"])
def test_other_lines_across_the_road_are_no_bays(rows, width):
    places, ends = bays(*rows, width=width)
    assert not places.any() and not len(ends)
