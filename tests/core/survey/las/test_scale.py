"""Whole numbers of a LAS file become units of 0.1 mm, whatever the file's scale and offset."""

import numpy as np
import pytest
from lanewright.core.common.parallel import ScratchBuffers
from lanewright.core.survey.las.point_fields import LasAxis
from lanewright.core.survey.store.records import COORDINATE_SCALE

RAW = np.dtype([("X", "i4"), ("Y", "i4"), ("Z", "i4"), ("intensity", "u2")])


def units(axis, numbers):
    raw = np.zeros(len(numbers), RAW)
    raw[axis.name] = numbers
    return axis.units(raw, ScratchBuffers().of(len(raw)))


@pytest.mark.parametrize("scale, offset", [(0.001, 610_400.0), (0.0001, 0.0), (0.00025, 610_399.12345), (1 / 3000, 610_400.05), (-0.01, 610_500.0)])
def test_units_are_the_nearest_to_the_metres_of_the_header(scale, offset):
    origin = 610_000.0
    places = np.linspace(origin - 900.0, origin + 900.0, 5001)
    numbers = np.rint((places - offset) / scale)
    numbers = numbers[np.abs(numbers) < 2**31].astype(np.int32)
    found, there = units(LasAxis("X", scale, offset, origin), numbers)
    assert there is None
    np.testing.assert_array_less(np.abs(found * COORDINATE_SCALE - (numbers * scale + offset - origin)), 0.5001 * COORDINATE_SCALE)


@pytest.mark.parametrize("scale", [0.01, 0.0123])
def test_places_that_are_not_on_earth_are_named(scale):
    numbers = np.array([-2**31, -25_000_000, 0, 10_000_000, 2**31 - 1], np.int32)
    found, there = units(LasAxis("Y", scale, 0.0, 0.0), numbers)
    assert there.tolist() == [False, False, True, True, False]
    np.testing.assert_array_equal(found[2:4], np.rint(numbers[2:4] * scale / COORDINATE_SCALE))
    assert not units(LasAxis("Z", scale, 0.0, 0.0), numbers[3:4])[1].any()
