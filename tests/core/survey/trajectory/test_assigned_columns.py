"""Tables whose columns the user assigns, and what is told of a table."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.meaning import columns_of_table, facts_of
from lanewright.core.survey.trajectory.reader import read_trajectory
from lanewright.core.survey.trajectory.time_systems import time_system_by_size


@pytest.fixture
def swapped(tmp_path):
    """20 s eastward at 10 m/s: northing, easting, two heights, time; nothing tells which height is meant."""
    second = np.arange(0.0, 20.05, 0.1)
    rows = np.c_[5_400_000.0 + 0 * second, 500_000.0 + 10 * second, 30.0 + 0 * second, 78.5 + 0.01 * second, 318_204_000.0 + second]
    path = tmp_path / "drive.txt"
    np.savetxt(path, rows, fmt="%.3f", header="N E h1 h2 clock", comments="")
    return path


def test_columns_are_those_that_were_assigned_whatever_their_names_say(swapped):
    found = read_trajectory(swapped, columns="y, x, -, z, time")
    np.testing.assert_allclose([found.x[-1], found.y[-1], found.z[-1]], [500_200.0, 5_400_000.0, 78.7], atol=1e-3)
    assert found.has_time and found.time[0] == 318_204_000.0


def test_length_speed_heights_and_time_system_tell_what_was_understood(swapped):
    facts = facts_of(read_trajectory(swapped, columns="y,x,-,z,time"))
    assert (facts.positions, facts.system) == (201, "adjusted")
    assert (facts.length, facts.seconds, facts.speed) == pytest.approx((200.0, 20.0, 10.0), abs=0.01)
    assert (facts.low, facts.high) == pytest.approx((78.5, 78.7), abs=0.01)


def test_of_degrees_the_length_is_told_in_metres(tmp_path):
    path = tmp_path / "drive.csv"
    rows = np.c_[np.arange(100.0), np.full(100, 8.0), 50.0 + np.arange(100) * 1e-4, np.full(100, 120.0)]
    np.savetxt(path, rows, fmt="%.6f", delimiter=",", header="time,lon,lat,z", comments="")
    assert facts_of(read_trajectory(path)).length == pytest.approx(99 * 11.1, rel=0.01)


def test_a_table_shows_its_names_its_first_rows_and_the_roles(swapped):
    recognised, assigned = columns_of_table(swapped, rows=2), columns_of_table(swapped, "y,x,-,z,time")
    assert recognised.titles == ("N", "E", "h1", "h2", "clock") and recognised.roles[:2] == ("y", "x") and recognised.rows.shape == (2, 5)
    assert assigned.roles == ("y", "x", "", "z", "time") and not assigned.problem


@pytest.mark.parametrize(("columns", "said"), [
    ("y,x,-,depth", "'depth', which is no part"), ("x,x,z", "names x twice"), ("time,x,y", "names no z"), ("x,y,z,-,-,time", "has 5"),
])
def test_columns_that_cannot_be_are_refused_in_a_sentence(swapped, columns, said):
    with pytest.raises(RoadExtractionError, match=said):
        read_trajectory(swapped, columns=columns)
    assert said.split("'")[-1] in columns_of_table(swapped, columns).problem


@pytest.mark.parametrize(("first", "system"), [(1.31e9, "gps"), (3.1e8, "adjusted"), (300_000.0, "week"), (40_000.0, "")])
def test_the_time_system_is_told_by_size_where_that_is_clear(first, system):
    assert time_system_by_size(first + np.arange(100.0)) == system
