"""Trajectory clocks and cloud clocks."""

import numpy as np
import pytest
from drives import STREET_TIME, drive, joined, straight
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.time_systems import SECONDS_PER_DAY, SECONDS_PER_WEEK, align_time, unwrap_time
from lanewright.core.survey.trajectory.trajectory import clean_trajectory

GPS = 1_318_204_000.0  # a Wednesday in 2021, seconds since 1980
TIMES = {"gps": GPS, "adjusted": GPS - 1e9, "week": GPS % SECONDS_PER_WEEK, "day": GPS % SECONDS_PER_DAY}


@pytest.mark.parametrize("system", ["automatic", "named"])
@pytest.mark.parametrize("cloud", TIMES)
@pytest.mark.parametrize("trajectory", TIMES)
def test_every_time_system_is_converted_to_every_other(trajectory, cloud, system):
    time = TIMES[trajectory] - 5.0 + STREET_TIME
    offset, note = align_time(time, (TIMES[cloud], TIMES[cloud] + 40.0), "automatic" if system == "automatic" else trajectory)
    assert TIMES[trajectory] + offset == pytest.approx(TIMES[cloud], abs=1e-6)
    assert bool(note) == bool(offset), "the choice is reported where something was changed"


@pytest.mark.parametrize("period, system", [(SECONDS_PER_WEEK, "week"), (SECONDS_PER_DAY, "day")])
def test_a_drive_past_midnight_or_the_week_s_end_goes_on(period, system):
    time = (period - 30.0 + STREET_TIME) % period
    unwrapped = unwrap_time(time)
    np.testing.assert_allclose(np.diff(unwrapped), np.diff(STREET_TIME), atol=1e-6)
    start = np.floor(GPS / period) * period - 1e9 + period - 20.0
    offset, note = align_time(time, (start, start + 40.0))
    assert unwrapped[0] + offset == pytest.approx(start - 10.0)
    assert system in note


def test_time_that_does_not_start_again_stays_as_it_is():
    np.testing.assert_array_equal(unwrap_time(STREET_TIME + 1e5), STREET_TIME + 1e5)
    np.testing.assert_array_equal(unwrap_time(STREET_TIME[::-1]), STREET_TIME[::-1])


def test_two_drives_in_the_wrong_order_are_sorted_not_carried_on():
    morning, evening = drive(straight(100), start=30_000.0), drive(straight(100), start=80_000.0)
    cleaned = clean_trajectory(joined(evening, morning))
    assert cleaned.time[0] == 30_000.0 and cleaned.time[-1] < SECONDS_PER_DAY


def test_no_overlap_is_one_sentence_with_both_spans():
    with pytest.raises(RoadExtractionError) as refused:
        align_time(8.0 + STREET_TIME, (312410.2, 312655.8))
    text = str(refused.value)
    assert "from 312410.2 s to 312655.8 s" in text and "from 8.0 s to 67.9 s" in text and "run again" in text


@pytest.mark.parametrize("leap", [18.0, -18.0, 17.0, 37.0])
def test_leap_seconds_are_named_but_never_applied(leap):
    offset, note = align_time(1000.0 + leap + STREET_TIME, (1000.05, 1059.85))
    assert offset == 0.0
    assert f"{abs(leap):.0f} s would make them agree" in note


def test_a_scan_that_ends_well_after_the_trajectory_is_no_matter_of_leap_seconds():
    offset, note = align_time(1000.0 + STREET_TIME, (1010.0, 1300.0))
    assert (offset, note) == (0.0, "")


def test_a_system_that_is_named_is_not_overruled():
    with pytest.raises(RoadExtractionError, match="taken to count seconds of the day"):
        align_time(GPS - 1e9 + STREET_TIME, (GPS - 1e9, GPS - 1e9 + 40.0), "day")


def test_an_unknown_system_is_refused():
    with pytest.raises(RoadExtractionError, match="not known"):
        align_time(STREET_TIME, (0.0, 10.0), "julian")
