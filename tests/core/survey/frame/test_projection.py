"""Many points placed at once lie where the exact foot on the reference line puts them."""

import numpy as np
import pytest
from drives import ahead, bend, chain, drive
from lanewright.core.survey.frame.projection import RoadProjection
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import COORDINATE_SCALE, to_units

CORRIDOR = 25.0


def around(frame, count=20_000, seed=1):
    """Places up to 30 m about the vehicle, and the times it was there."""
    rng = np.random.default_rng(seed)
    p = frame.passes[0]
    time = rng.uniform(p.time[0], p.time[-1], count)
    x, y, _ = p.position(time)
    # as points are kept
    return to_units(x + rng.uniform(-30, 30, count)) * COORDINATE_SCALE, to_units(y + rng.uniform(-30, 30, count)) * COORDINATE_SCALE, time


def exactly(frame, x, y, time):
    p = frame.passes[0]
    line, s = frame.road(p.road), p.station_at(time)
    px, py, _ = p.position(time)
    heading = line.heading(s)
    return line.locate(x, y, s + (x - px) * np.cos(heading) + (y - py) * np.sin(heading), CORRIDOR)


@pytest.mark.parametrize("radius", [None, 300.0, 60.0, 25.0, 12.0])
def test_places_are_those_of_the_exact_foot_in_bends_of_any_radius(radius):
    path = chain(ahead(60), *([] if radius is None else [bend(radius, 70)]), ahead(60))
    frame = build_frame(drive(path))
    places = around(frame)
    passes, s, d = RoadProjection(frame, CORRIDOR).project(*places)
    expected_s, expected_d = exactly(frame, *places)
    both = np.isfinite(s) & np.isfinite(expected_s)
    assert (passes == 0).all()
    assert np.count_nonzero(np.isfinite(s) != np.isfinite(expected_s)) < 0.002 * len(s)
    assert np.count_nonzero(both) > 0.5 * len(s)
    # inside a bend as tight as the corridor is wide a place has more than one foot
    apart = np.maximum(np.abs(s - expected_s), np.abs(d - expected_d))[both]
    # half a unit in which points are kept, and a tenth of one
    assert np.quantile(apart, 1.0 if radius is None or radius >= 60 else 0.99) < 0.6 * COORDINATE_SCALE


def test_how_points_are_grouped_does_not_show():
    frame = build_frame(drive(chain(ahead(60), bend(40, 80), ahead(60))))
    x, y, time = around(frame)
    placing = RoadProjection(frame, CORRIDOR)
    _, s, d = placing.project(x, y, time)
    for rows in np.array_split(np.random.default_rng(2).permutation(len(x)), 7):
        _, some_s, some_d = placing.project(x[rows], y[rows], time[rows])
        np.testing.assert_array_equal(some_s, s[rows])
        np.testing.assert_array_equal(some_d, d[rows])


def test_a_time_of_no_pass_and_no_time_at_all_have_no_place():
    frame = build_frame(drive(chain(ahead(100))))
    x, y, time = around(frame, 6)
    time[:3] = np.nan, time[0] - 500.0, time[0] + 500.0
    passes, s, d = RoadProjection(frame, CORRIDOR).project(x, y, time)
    assert passes.tolist() == [-1, -1, -1, 0, 0, 0]
    assert np.isnan(s[:3]).all() and np.isnan(d[:3]).all()


def test_no_points_have_no_places():
    frame = build_frame(drive(chain(ahead(100))))
    assert [len(found) for found in RoadProjection(frame, CORRIDOR).project(*np.empty((3, 0)))] == [0, 0, 0]
