"""Hidden curb next to pieces of curb that were found later than the others."""

import numpy as np
import pytest
from lanewright.core.road.common.curb_points import curb_points_at
from lanewright.core.road.common.occlusion import OcclusionGrid
from lanewright.core.road.common.sides import expected_height, hidden_beside, hidden_points
from street_plans import scan, sidewalks, survey_along

OUT = 7.0                                      # m from the reference line to the curb
KNOWN, LATER = (5.0, 12.0), (22.0, 26.0)       # m along the road: pieces of curb known before and found later


@pytest.fixture(scope="module")
def survey():
    return survey_along(scan(sidewalks(7.0)), -1.0)


def piece(survey, start, end, side="left"):
    s = np.arange(start, end + 0.25, 0.5)
    d = np.full(len(s), OUT if side == "left" else -OUT)
    places = survey.frame.to_map(0, s, d, expected_height(survey, 0, s))
    return curb_points_at(survey.frame, 0, places, side=side, status="measured", station=s, offset=d)


def known(start, end, seen=1.0):
    s = np.arange(start, end + 0.25, 0.5)
    return np.c_[s, np.full(len(s), OUT), np.zeros(len(s)), np.full(len(s), seen)]


def beside(ground=np.nan):
    """A row of vehicles 4 m out, and the ground that was seen behind them."""
    grid = OcclusionGrid(0.25, 0, 160, 20.0)
    grid.tall[:, 16] = True
    grid.ground[:] = ground
    return {"left": grid, "right": grid}


def test_the_gap_before_a_piece_that_was_found_later_is_hidden_where_something_stands_in_front(survey):
    main = {"left": known(*KNOWN), "right": np.empty((0, 4))}
    hidden = hidden_beside(piece(survey, *LATER), main, beside(), survey, 0)
    assert set(hidden.status) == {"occluded"} and set(hidden.side) == {"left"} and set(hidden.kind) == {"main"}
    np.testing.assert_allclose(hidden.station, np.arange(12.25, 22.0, 0.5))
    np.testing.assert_allclose(hidden.offset, OUT, atol=1e-6)
    np.testing.assert_allclose(hidden.z, expected_height(survey, 0, hidden.station), atol=1e-3)


def test_where_ground_was_seen_there_the_road_is_open(survey):
    main = {"left": known(*KNOWN), "right": np.empty((0, 4))}
    assert not len(hidden_beside(piece(survey, *LATER), main, beside(ground=0.02), survey, 0))


def test_what_is_known_to_be_hidden_is_not_said_again_and_other_gaps_are_left_alone(survey):
    again = np.concatenate([known(*KNOWN), known(12.5, 21.5, seen=0.0)])
    assert not len(hidden_beside(piece(survey, *LATER), {"left": again, "right": np.empty((0, 4))}, beside(), survey, 0))
    other = np.concatenate([known(2.0, 4.0), known(10.0, 21.5)])
    assert not len(hidden_beside(piece(survey, *LATER), {"left": other, "right": np.empty((0, 4))}, beside(), survey, 0))


@pytest.mark.parametrize("moved", [0.1, 0.2, 0.3, 0.45])
def test_the_share_of_a_gap_that_is_hidden_does_not_depend_on_where_the_stations_begin(moved):
    measured = np.array([[5.0, OUT, 0.0], [13.7, OUT, 0.0]])

    def places(by):
        grid = OcclusionGrid(0.25, 0, 160, 20.0)
        grid.tall[:, 16] = True
        found = hidden_points(measured + (by, 0.0, 0.0), grid, lambda s: np.zeros(len(s)))
        return np.array([row["s"] for row in found]) - by

    np.testing.assert_allclose(places(moved), places(0.0))
    assert len(places(0.0)) == 17, "half a metre each, over the whole gap"


@pytest.mark.parametrize("ground, share", [(np.nan, 1.0), (0.0, 0.0)], ids=["nothing seen behind them", "level road behind them"])
def test_a_curb_is_hidden_behind_the_whole_length_of_a_row_of_parked_cars(ground, share):
    row = np.array([[2.0, OUT, 0.0], [38.0, OUT, 0.0]])
    assert len(hidden_points(row, beside(ground)["left"], lambda s: np.zeros(len(s)))) == share * 72, "half a metre each"


def wet(road, behind):
    """A grid of which the metre before the curb and what lies behind its foot are as given (m above the road), and nothing stands there."""
    grid = OcclusionGrid(0.25, 0, 160, 20.0)
    place = np.arange(grid.cells) * 0.25
    grid.ground[:, place < OUT - 2.0] = 0.0
    grid.ground[:, (place >= OUT - 2.0) & (place < OUT)] = road
    grid.ground[:, (place >= OUT) & (place < OUT + 3.0)] = behind
    return {"left": grid, "right": grid}


def test_a_curb_in_water_goes_on_where_the_ground_behind_it_is_raised(survey):
    main = {"left": known(*KNOWN), "right": np.empty((0, 4))}
    hidden = hidden_beside(piece(survey, *LATER), main, wet(np.nan, 0.12), survey, 0)
    np.testing.assert_allclose(hidden.station, np.arange(12.25, 22.0, 0.5))


@pytest.mark.parametrize("road, behind", [(0.0, 0.12), (np.nan, 0.02), (np.nan, np.nan)],
                         ids=["the road is dry", "a driveway behind the water", "nothing behind the water"])
def test_without_water_or_without_raised_ground_behind_it_the_road_is_open(survey, road, behind):
    main = {"left": known(*KNOWN), "right": np.empty((0, 4))}
    assert not len(hidden_beside(piece(survey, *LATER), main, wet(road, behind), survey, 0))
