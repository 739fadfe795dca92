"""What passes differ by goes with the layers of one step to the next."""

import numpy as np
import pytest
from lanewright.core.common.features import CURB_POINTS, MARKING_LINES
from lanewright.core.road.common.curb_points import curb_points_at
from lanewright.core.survey.adjustment.register import PassOffsets, sigma_of_layer, sigma_of_passes, sigma_of_records, sigma_to_record
from lanewright.core.survey.frame.row_table import SigmaAlong
from lined_streets import Street


def curb_layer(sigma):
    street = Street()
    street.frame.pass_sigma.update(sigma)
    s = np.arange(10.0, 60.0)
    points = curb_points_at(street.frame, 0, np.array([s, 3.5 + 0 * s, 0 * s]) + street.frame.origin[:, None], station=s, offset=3.5 + 0 * s,
                            status="measured", part="bottom", side="left", kind="main")
    return points.to_features(street.frame)


@pytest.mark.parametrize("sigma", [{}, {0: SigmaAlong.everywhere(0.012)}])
def test_curb_points_carry_it_where_it_is_known(sigma):
    assert sigma_of_layer(curb_layer(sigma)) == sigma


def test_layers_of_an_earlier_version_know_nothing_of_it():
    layer = curb_layer({0: SigmaAlong.everywhere(0.012)})
    for row in layer.rows:
        del row["pass_sig_m"]
    assert sigma_of_layer(layer) == {}
    assert all(any(field.name == "pass_sig_m" and not field.needed for field in schema) for schema in (CURB_POINTS, MARKING_LINES))


def jumping(by, at=200.0, end=400.0):
    """PassOffsets of two drives that lie on each other up to a station and so many metres apart from there on."""
    stations = np.arange(5.0, end, 10.0)
    left, nothing = np.where(stations > at, by, 0.0), np.zeros(len(stations))
    return PassOffsets(0, 1, stations, nothing, left, nothing, nothing[:0])


def test_where_drives_lie_on_each_other_it_is_nothing_and_behind_a_jump_half_of_it():
    found = sigma_of_passes([jumping(0.12)])
    np.testing.assert_allclose(found.at(np.array([0.0, 100.0, 150.0])), 0.0, atol=1e-6)
    np.testing.assert_allclose(found.at(np.array([250.0, 300.0, 450.0])), 0.06, atol=1e-6)


def test_one_offset_that_is_far_off_does_not_count():
    pair = jumping(0.0)
    pair.left[20] = 0.20
    assert max(sigma_of_passes([pair]).metres) == pytest.approx(0.0, abs=1e-6)


def test_three_drives_meet_better_than_two():
    pairs = [jumping(0.10, at=0.0), PassOffsets(1, 2, *(getattr(jumping(0.10, at=0.0), name) for name in ("stations", "along", "left", "up", "far")))]
    assert sigma_of_passes(pairs).at(200.0) == pytest.approx(0.10 / np.sqrt(6.0), abs=1e-4)


def test_points_and_curb_points_carry_where_along_the_road_it_is_how_much():
    sigma = {0: SigmaAlong((10.0, 30.0, 60.0), (0.01, 0.05, 0.02)), 2: SigmaAlong.everywhere(0.03)}
    read = sigma_of_records(sigma_to_record(sigma))
    assert list(read) == [0, 2]
    for road, along in sigma.items():
        np.testing.assert_allclose(read[road].at(np.arange(0.0, 80.0)), along.at(np.arange(0.0, 80.0)), atol=1e-6)
    found = sigma_of_layer(curb_layer({0: sigma[0]}))[0]
    np.testing.assert_allclose(found.at(np.array([15.0, 25.0, 45.0])), sigma[0].at(np.array([15.0, 25.0, 45.0])), atol=0.005)


def test_points_of_an_earlier_version_say_one_sigma_of_the_road():
    import laspy

    rows = np.array([(3, 0.0125)], [("road", "<u4"), ("sigma", "<f8")])
    assert sigma_of_records([laspy.VLR("LanewrightSigma", 1, "", rows.tobytes())]) == {3: SigmaAlong.everywhere(0.0125)}
