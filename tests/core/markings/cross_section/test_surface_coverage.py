"""Where the road surface was scanned and where it ends, from road points."""

from dataclasses import replace

import curbed_streets as streets
import numpy as np
import pytest
from lanewright.core.markings.cross_section.evidence import Evidence, beside_median, surface_coverage
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.survey.store.records import BIN, BINS, COORDINATE_SCALE, FAR, STATION_STEP
from lanewright.core.survey.store.road_points import RoadPoints

STATIONS = 10.0 + STATION_STEP * np.arange(40)   # m: 10 to 29.5


def road_points(*places):
    """Points at (station, offset, half width of the road), m."""
    points = RoadPoints.empty_like(origin=np.zeros(3))
    add(points, *places)
    return points


def add(points, *places):
    records = np.zeros(len(places), points.store.dtype)
    s, d, half_width = np.array(places).T
    records["s"], records["d"] = np.rint(s / COORDINATE_SCALE), np.rint(d / COORDINATE_SCALE)
    records["half_width"] = np.rint(1000 * half_width)
    points.store.append(0, records)


def bin_of(d):
    return int((d + FAR) // BIN)


def test_cells_with_points_are_covered_and_half_widths_tell_the_ends_of_both_sides():
    covered, ends = surface_coverage(road_points((12.0, 1.05, 4.0), (12.1, 1.35, 4.2), (12.2, -2.5, 3.5), (28.0, 0.1, 4.5)), 0, STATIONS)
    assert np.argwhere(covered).tolist() == [[4, bin_of(-2.5)], [4, bin_of(1.05)], [4, bin_of(1.35)], [36, bin_of(0.1)]]
    assert np.allclose(ends[:, 4], [4.1, -3.5]) and np.isclose(ends[0, 36], 4.5)
    assert np.isnan(ends[1, 36]) and np.isnan(np.delete(ends, [4, 36], axis=1)).all()


def test_points_beyond_the_stations_or_far_aside_do_not_count():
    covered, ends = surface_coverage(road_points((9.7, 1.0, 4.0), (29.8, 1.0, 4.0), (15.0, 30.0, 4.0), (15.0, -31.0, 4.0)), 0, STATIONS)
    assert not covered.any() and np.isnan(ends).all()


def test_points_are_looked_at_once_until_some_are_added(monkeypatch):
    points, asked, seen = road_points((12.0, 1.05, 4.0)), [], RoadPoints.seen_surface
    monkeypatch.setattr(RoadPoints, "seen_surface", lambda self: asked.append(self) or seen(self))
    first = surface_coverage(points, 0, STATIONS)
    assert surface_coverage(points, 0, STATIONS[:20])[0].shape == (20, first[0].shape[1]) and len(asked) == 1
    add(points, (20.0, -1.05, 4.0))
    assert surface_coverage(points, 0, STATIONS)[0].sum() == first[0].sum() + 1 and len(asked) == 2


def test_what_was_seen_when_the_surface_was_extracted_is_what_its_points_show():
    survey = streets.survey_of(streets.street())
    points, _ = extract_road_surface(survey, None)
    assert points.seen and replace(points, seen=None).seen_surface().keys() == points.seen.keys()
    for road, sections in replace(points, seen=None).seen_surface().items():
        for here, there in zip(sections, points.seen[road]):
            assert here[0] == there[0] and all(np.array_equal(*pair) for pair in zip(here[1:], there[1:]))
        assert len(sections) == len(points.seen[road])


@pytest.mark.parametrize("asphalt_to, oncoming, way, divided", [
    (6.3, 16.5, -1, True), (8.3, 16.5, -1, False), (6.3, 16.5, 1, False), (6.3, -16.5, -1, False), (6.3, np.nan, -1, False), (0.5, 4.0, -1, False)])
def test_asphalt_that_ends_before_the_middle_to_an_oncoming_drive_makes_one_carriageway_of_two(asphalt_to, oncoming, way, divided):
    """Each road has the asphalt up to the middle between both drives; a median of grass on one level has no edge that is drawn."""
    middles = (np.arange(BINS) + 0.5) * BIN - FAR
    asphalt = ((middles > -9.0) & (middles < asphalt_to)).astype(float)[None]
    evidence = Evidence(np.array([[0.0], [oncoming]]), np.array([1, way]), asphalt, None, np.empty((0, 3)), np.empty((0, 4)), np.zeros(1, bool),
                        np.zeros(1, bool), 1)
    assert beside_median(evidence, 1).tolist() == [divided]
