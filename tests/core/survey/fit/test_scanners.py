"""Scanners of one vehicle that do not see the same street in the same place: laid on each other and said, or left alone where they agree."""

from dataclasses import replace

import numpy as np
import pytest
from heard import Heard
from lanewright.core.survey.adjustment.scanner_fit import lay_scanners
from scanned_streets import driven, scanned, survey_of


def seen_by_two(moved=lambda x, y, z: (x, y, z), lost=0.1, seeds=(1, 2), seconds=8.0):
    """A street driven once with two scanners, of which the points of the second lie elsewhere."""
    drive = driven(seconds)
    first, second = (scanned(drive=drive, pulses=60_000.0, yaw=yaw, clipped=8.0, noise=0.004, lost=lost, seed=seed)
                     for seed, yaw in zip(seeds, (45.0, -45.0)))
    x, y, z = moved(second.x, second.y, second.z)
    return survey_of(first, replace(second, x=x, y=y, z=z), drive=drive)


def records(survey):
    return np.concatenate([np.asarray(survey.store.section(0, number)) for number in survey.store.sections(0)])


def places_of(survey, scanner):
    """Offset of the left curb face and heights of the road on the right and the left, as a scanner sees them."""
    points = records(survey)
    points = points[points["scanner"] == scanner]
    d, h = points["d"] * 1e-4, points["z"] * 1e-4 - (100.0 - survey.frame.origin[2])
    face = (d > 2.5) & (d < 4.5) & (h > 0.04) & (h < 0.09)
    return np.array([np.median(d[face]), *(np.median(h[np.abs(d - at) < 0.5]) for at in (-2.5, 2.5))])


def test_scanners_that_agree_stay_as_they_are():
    survey, heard = seen_by_two(), Heard()
    store = survey.store
    assert lay_scanners(survey, heard) == 0.0 and survey.store is store and not heard.warned


@pytest.mark.parametrize("seed", range(10, 16))
def test_scanners_that_agree_stay_as_they_are_where_points_are_few(seed):
    """Windows of a thinned street differ by more than their mean says: none of it is an error of a mounting."""
    survey, heard = seen_by_two(lost=0.95, seeds=(seed, seed + 100)), Heard()
    assert lay_scanners(survey, heard) == 0.0 and not heard.warned


@pytest.mark.parametrize("seed", [12, 13, 17, 18])
def test_scanners_that_agree_stay_as_they_are_on_a_short_street(seed):
    """What a single window of road shows is no evidence, as nothing tells how far it may be off."""
    survey, heard = seen_by_two(lost=0.85, seeds=(seed, seed + 100), seconds=3.5), Heard()
    assert lay_scanners(survey, heard) == 0.0 and not heard.warned


@pytest.mark.parametrize("seconds", [1.8, 2.5, 3.5])
def test_a_wrong_lever_arm_is_taken_out_on_a_short_street_too(seconds):
    survey, heard = seen_by_two(lambda x, y, z: (x, y + 0.18, z), seconds=seconds), Heard()
    assert lay_scanners(survey, heard) == pytest.approx(0.09, abs=0.01) and len(heard.warned) == 1
    np.testing.assert_allclose(places_of(survey, 0), places_of(survey, 1), atol=0.008)


@pytest.mark.parametrize("metres", [0.18, -0.06])
def test_a_wrong_lever_arm_is_taken_out_by_half_from_either(metres):
    survey, heard = seen_by_two(lambda x, y, z: (x, y + metres, z)), Heard()
    sigma = lay_scanners(survey, heard)
    one, other = places_of(survey, 0), places_of(survey, 1)
    np.testing.assert_allclose(one, other, atol=0.008)
    assert one[0] == pytest.approx(3.5 + metres / 2, abs=0.03)
    assert sigma == pytest.approx(abs(metres) / 2, abs=0.01)
    assert len(heard.warned) == 1 and "Calibrate their mounting" in heard.warned[0] and f"{100 * abs(metres):.0f}." in heard.warned[0]


def test_a_boresight_turned_about_the_way_is_taken_out_on_either_side():
    turned = np.radians(0.6)
    survey, heard = seen_by_two(lambda x, y, z: (x, y, z + turned * y)), Heard()
    lay_scanners(survey, heard)
    np.testing.assert_allclose(places_of(survey, 0)[1:], places_of(survey, 1)[1:], atol=0.006)
    assert len(heard.warned) == 1 and "above" in heard.warned[0] and "below" in heard.warned[0]
