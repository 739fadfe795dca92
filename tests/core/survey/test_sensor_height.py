"""How high the sensor rides is told by the points on the vehicle's own track."""

from dataclasses import replace

import numpy as np
import pytest
from drives import ahead, bend, chain, drive
from lanewright.core.survey.blocks import HeightHistogram, VehicleTracks
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.columns import Columns
from lanewright.core.survey.store.records import SURVEY_POINT, to_units

RIDES = 2.314  # m above the road


def climbing(grade):
    trajectory = drive(chain(ahead(80), bend(60, 40), ahead(60)))
    return build_frame(replace(trajectory, z=trajectory.z + grade * 10.0 * (trajectory.time - trajectory.time[0])))


def road_below(frame, reach=4.0, count=40_000):
    """Points up to `reach` metres beside the track, on a road that climbs along with it."""
    rng = np.random.default_rng(3)
    p = frame.passes[0]
    s = rng.uniform(*p.span, count)
    track_d, track_z = p.at_station(s)
    off = rng.uniform(-reach, reach, count)
    points = np.zeros(count, SURVEY_POINT)
    points["s"], points["d"], points["z"] = to_units(s), to_units(track_d + off), to_units(track_z - RIDES)
    return Columns.from_records(points), off


@pytest.mark.parametrize("grade", [0.0, 0.12, -0.12])
def test_the_height_is_told_to_the_millimetre_on_a_steep_road_too(grade):
    frame = climbing(grade)
    points, _ = road_below(frame)
    (number, _, drops), = VehicleTracks(frame).drops(0, points)
    tally = HeightHistogram([number], 2.0)
    for some in np.array_split(drops, 7):
        tally.add(number, some)
    assert tally.heights()[number] == pytest.approx(RIDES, abs=1.1e-3)


def test_points_on_the_track_are_those_within_a_metre_and_a_half_of_it():
    frame = climbing(0.0)
    points, off = road_below(frame)
    (_, _, drops), = VehicleTracks(frame).drops(0, points)
    assert len(drops) == pytest.approx(np.count_nonzero(np.abs(off) < 1.5), abs=20)
    own = np.abs(off) > 1.0
    (_, _, some), = VehicleTracks(frame).drops(0, points, own)
    assert len(some) == pytest.approx(np.count_nonzero((np.abs(off) < 1.5) & own), abs=20)
    assert not list(VehicleTracks(frame).drops(0, points, np.abs(off) > 1.6))


def test_what_lies_far_below_or_above_is_not_counted():
    tally = HeightHistogram([0], 2.0)
    tally.add(0, to_units(np.r_[np.full(60, 2.5), np.full(500, 90.0), np.full(500, -90.0)]))
    assert tally.heights() == {0: 2.5}
