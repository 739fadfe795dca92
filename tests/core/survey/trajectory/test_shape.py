"""Trajectories that no vehicle drove so: noisy, or with vertices too far apart for their bends."""

from dataclasses import replace

import numpy as np
import pytest
from drives import ahead, bend, chain, drive
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.trajectory import Trajectory, clean_trajectory, shaped_trajectory

BENT = chain(ahead(80), bend(250, 60), ahead(60))


def off(one, other):
    """(N,) m from each position of the second to the first."""
    return np.hypot(*(np.interp(other.time, one.time, getattr(one, name)) - getattr(other, name) for name in "xy"))


@pytest.mark.parametrize("rate", [10.0, 50.0, 200.0])
def test_a_drive_as_vehicles_drive_stays_as_it_is(rate):
    driven = drive(chain(ahead(40), bend(12, 90), ahead(40), bend(250, -40)), rate=rate)
    shape = shaped_trajectory(driven)
    assert shape.trajectory is driven and shape.sigma == 0.0 and not shape.said


@pytest.mark.parametrize("rate, sigma", [(200.0, 0.2), (200.0, 0.05), (20.0, 0.1)])
def test_noise_that_nobody_filtered_is_smoothed_and_told_by_its_size(rate, sigma):
    driven = drive(BENT, rate=rate)
    rng = np.random.default_rng(4)
    noisy = replace(driven, **{name: getattr(driven, name) + rng.normal(0.0, sigma, len(driven)) for name in "xyz"})
    shape = shaped_trajectory(noisy)
    assert np.sqrt(np.mean(off(shape.trajectory, driven) ** 2)) < 0.6 * sigma
    assert len(shape.said) == 1 and f"scatter by {100 * sigma:.0f} cm" in shape.said[0]


@pytest.mark.parametrize("headings", [True, False])
def test_vertices_far_apart_in_a_bend_get_a_curve_through_them(headings):
    driven = drive(BENT)
    if headings:
        driven = replace(driven, heading=np.degrees(np.arctan2(np.gradient(driven.x), np.gradient(driven.y))) % 360.0)
    rows = driven.rows(np.unique(np.r_[np.arange(0, len(driven), 350), len(driven) - 1]))   # 70 m
    shape = shaped_trajectory(rows)
    assert off(rows, driven).max() > 2.0 and off(shape.trajectory, driven).max() < (0.35 if headings else 0.6)
    assert off(shape.trajectory, driven).max() < 3 * shape.sigma
    assert len(shape.said) == 1 and "70 m apart in bends" in shape.said[0]


def test_a_gap_between_two_drives_is_no_bend():
    first = drive(chain(ahead(80)))
    second = drive(chain(bend(30, 80), ahead(20)), start=2000.0)
    columns = "time", "x", "y", "z", "roll", "pitch", "heading"
    both = replace(first, **{name: np.r_[getattr(first, name), getattr(second, name)] for name in columns})
    assert not shaped_trajectory(both).said


@pytest.mark.parametrize("axis, metres, told", [("y", 0.5, "0.50 m"), ("z", -0.2, "0.20 m"), ("z", 0.03, None), ("x", 0.1, None)])
def test_a_jump_to_the_side_or_up_is_no_bend_and_told_by_its_size(axis, metres, told):
    """Along the way a jump may be that of a time."""
    driven = drive(chain(ahead(100)))
    shape = shaped_trajectory(replace(driven, **{axis: getattr(driven, axis) + np.where(driven.time > driven.time[200], metres, 0.0)}))
    assert len(shape.said) == (told is not None) and all(f"jumps by {told}" in text for text in shape.said)
    assert shape.sigma == pytest.approx(abs(metres) if told else 0.0, abs=1e-6)


@pytest.mark.parametrize("stray", [0, 5, 9])
def test_a_vertex_of_a_drawn_drive_on_another_continent_is_left_out(stray):
    x = 500_000.0 + 10.0 * np.arange(10)
    x[stray] += 9e6
    cleaned = clean_trajectory(Trajectory(np.arange(10.0), x, np.full(10, 5.4e6), np.full(10, 20.0), has_time=False))
    assert len(cleaned) == 9 and np.ptp(cleaned.x) <= 90.0 and "farther from the drive" in cleaned.notes[-1]


def test_a_drawn_drive_on_two_continents_is_refused():
    x = np.r_[500_000.0 + np.arange(10.0), 9_500_000.0 + np.arange(10.0)]
    with pytest.raises(RoadExtractionError, match="leaps 9,000 km"):
        clean_trajectory(Trajectory(np.arange(20.0), x, np.full(20, 5.4e6), np.full(20, 20.0), has_time=False))
