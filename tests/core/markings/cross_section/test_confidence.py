"""How often a lane is right that the estimate holds for so probable."""

import numpy as np
from lanewright.core.markings.cross_section.weights import EstimateWeights, calibrated, confidence_of


def test_what_is_more_probable_is_said_with_more_confidence_and_nothing_is_certain():
    said = calibrated(np.array([0.0, 0.2, 0.5, 0.9, 0.99, 1.0]))
    assert (np.diff(said) > 0).all()
    assert 0 < said[0] and said[-1] < 1


def test_the_curve_gives_back_the_probability_where_it_is_a_straight_line():
    p = np.array([0.1, 0.5, 0.9])
    np.testing.assert_allclose(calibrated(p, EstimateWeights(calibration=(1.0, 0.0))), p)


def test_a_lane_that_may_lead_either_way_is_right_half_of_the_time():
    there = np.array([0.2, 0.9, 0.999])
    np.testing.assert_allclose(confidence_of(there, np.full(3, 0.5)), calibrated(there) / 2)
    np.testing.assert_allclose(confidence_of(there, np.ones(3)), calibrated(there), rtol=1e-6)
    np.testing.assert_allclose(confidence_of(there, np.full(3, 0.8)) + confidence_of(there, np.full(3, 0.2)), calibrated(there))
