"""Every so many slots of time are sampled, whatever the time counts from."""

import numpy as np
import pytest
from lanewright.core.survey.las.samples import TimeSlots
from lanewright.core.survey.weights import LAS


@pytest.mark.parametrize("begin", [-5e5, 0.0, 3e5, 1.4e9], ids=["before zero", "zero", "week", "adjusted"])
@pytest.mark.parametrize("stride", [3, 13, 1001])
def test_points_are_kept_whose_slot_is_a_multiple_of_the_stride(begin, stride):
    times = begin + np.r_[np.random.default_rng(1).uniform(0, 400, 20_000), np.arange(5000) * LAS.slot]
    np.testing.assert_array_equal(TimeSlots(stride).kept(times), np.floor(times / LAS.slot) % stride == 0)


def test_points_without_a_time_are_not_kept():
    assert not TimeSlots(3).kept(np.array([np.nan, np.inf, -np.inf])).any()
