"""Pieces of curb of either method between what both of them chose."""

import numpy as np
import pytest
from curbed_streets import driven, parked_car, street, survey_of
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.curb_points import curb_points_at
from lanewright.core.road.common.side_curbs import SideChains
from lanewright.core.road.common.sides import expected_height
from lanewright.core.road.common.tracking import StepChain
from lanewright.core.road.detect_boundaries import with_pieces_of_both
from lanewright.core.road.profiles.detect import detect_curbs

FOOT = -0.02   # m, height of the curb's foot above the expected road


@pytest.fixture(scope="module")
def parked():
    """A survey of a street with a parked car between stations 20 and 25, and what was seen beside it."""
    survey, beside = survey_of(parked_car(street(length=60.0), start=20.0), driven(60.0)), {}
    detect_curbs(survey, include_returns=False, beside=beside)
    return survey, beside


def curb(survey, stations, chain):
    """Curb points that a method chose on the left side."""
    z = FOOT + expected_height(survey, 0, stations)
    places = survey.frame.to_map(0, stations, np.full(len(stations), 3.5), z)
    return curb_points_at(survey.frame, 0, places, side="left", part="bottom", kind="main", status="measured", station=stations, offset=3.5,
                          height=0.12, chain=chain)


def chains_of(stations, aside=0.0):
    """A chain of steps at some stations of the left side, which a method did not choose."""
    ones = np.ones(len(stations))
    steps = CurbSteps(profile=np.rint(stations / 0.25).astype(int), s=stations, u=(3.5 + aside) * ones, h=FOOT * ones, skew=0 * ones,
                      height=0.12 * ones, run=0 * ones, noise=0.003 * ones, scanner_noise=0.003 * ones, support=50 * ones,
                      behind=20 * ones)
    return {(0, "left"): SideChains(steps, [StepChain(np.arange(len(stations)), stations[0], stations[-1])], np.array([0.0, 60.0]))}


@pytest.mark.parametrize("first", [True, False], ids=["of the first method", "of the second method"])
def test_a_piece_in_line_with_curbs_of_different_methods_is_the_curb_and_the_car_beside_it_hides_the_rest(parked, first):
    survey, beside = parked
    chosen = [curb(survey, np.arange(1.0, 19.0), 0), curb(survey, np.arange(32.0, 59.0), 100_000)]
    piece, nothing = chains_of(np.arange(26.5, 28.1, 0.25)), {}
    points = type(chosen[0]).join(chosen, survey.crs)
    found = with_pieces_of_both(points, [piece, nothing] if first else [nothing, piece], beside, survey)
    later = found[np.arange(len(points), len(found))]
    seen, hidden = later[later.status == "measured"], later[later.status == "occluded"]
    assert len(seen) and len(set(seen.chain)) == 1 and seen.chain[0] not in points.chain
    assert seen.station == pytest.approx(27.25, abs=0.75) and seen.offset == pytest.approx(3.5, abs=1e-3)
    assert len(hidden) >= 8 and (np.abs(hidden.station - 22.5) < 4.5).all()


def test_a_piece_aside_of_the_curb_and_one_beyond_its_end_are_something_else(parked):
    survey, beside = parked
    points = curb(survey, np.r_[np.arange(1.0, 19.0), np.arange(32.0, 50.0)], 0)
    for other in (chains_of(np.arange(26.5, 28.1, 0.25), aside=0.3), chains_of(np.arange(53.0, 55.0, 0.25))):
        assert len(with_pieces_of_both(points, [other], beside, survey)) == len(points)
