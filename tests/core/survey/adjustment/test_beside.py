"""Two carriageways driven one by one: what is said of how their drives fit."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from heard import Heard
from lanewright.core.survey.adjustment.adjust import compare_carriageways, roads_beside, warnings_of_levels
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory

LENGTH = 200.0


def carriageways(apart=17.0, rise=lambda x: 0.0 * x, level=0.0, height=102.5):
    """A plain driven along and, so many metres beside, back again; the second drive's points and track lie higher by `rise`."""
    x = np.arange(0.0, LENGTH, 0.2)
    xs, ys = np.r_[x, x[::-1]], np.r_[0.0 * x, 0.0 * x + apart]
    z = np.r_[0.0 * x, rise(x[::-1]) + level] + height
    frame = build_frame(Trajectory(np.r_[np.arange(len(x)) * 0.02, 100.0 + np.arange(len(x)) * 0.02], xs + 5000.0, ys + 7000.0, z))
    rng = np.random.default_rng(4)
    points = {}
    for road in frame.roads:
        number = road.number
        away = np.round(road.locate(*frame.to_local([5100.0], [7000.0]), corridor=60.0)[1][0]) != 0.0
        east, north = rng.uniform(0.0, LENGTH, 60_000), rng.uniform(-5.0, apart + 5.0, 60_000)
        up = (rise(east) + level if away else 0.0) + 100.0 + 0.003 * rng.standard_normal(60_000)
        place = frame.to_local(east + 5000.0, north + 7000.0, up)
        points[number] = (*place, *road.locate(*place[:2], corridor=60.0))

    def window(road, start, end):
        own = (points[road][3] >= start) & (points[road][3] < end)
        return SimpleNamespace(**{name: values[own] for name, values in zip("xyzsd", points[road])})

    return SimpleNamespace(frame=frame, window=window)


def heard(survey):
    progress = Heard()
    compare_carriageways(survey, progress)
    return progress


def test_drives_that_agree_in_height_are_told_of_and_not_warned_of():
    found = heard(carriageways())
    assert not found.warned and len(found.said) == 1
    assert "in height they agree within 0." in found.said[0] and "across is not known" in found.said[0]


def test_where_their_heights_part_is_named_place_by_place():
    survey = carriageways(rise=lambda x: np.where(x < 100.0, 0.0, 0.08))
    (pair,) = roads_beside(survey.frame)
    assert np.abs(pair.apart) == pytest.approx(np.full(len(pair.apart), 17.0), abs=0.1)
    (warned,) = heard(survey).warned
    assert re.search(r"\(by up to (7.9|8.[01]) cm\)", warned) and "Road 1 runs beside road 0" in warned
    assert any(f"at {start} to {end} m" in warned for start, end in ((100, 200), (0, 100), (90, 200), (0, 110))), warned


@pytest.mark.parametrize("second", [dict(apart=45.0), dict(level=6.0)], ids=["another street", "a bridge above"])
def test_roads_far_off_or_on_another_level_are_not_compared(second):
    survey = carriageways(**second)
    assert len(survey.frame.roads) == 2 and not roads_beside(survey.frame)


def test_a_street_driven_again_with_heights_of_another_kind_is_named_as_one_road():
    (warned,) = warnings_of_levels(carriageways(apart=0.4, level=48.0).frame)
    assert "48.00 m above" in warned and "heights of two kinds" in warned


@pytest.mark.parametrize("second", [dict(apart=0.4, level=6.0, rise=lambda x: 0.02 * x), dict(level=6.0)],
                         ids=["a ramp above", "a carriageway higher up the slope"])
def test_what_climbs_above_a_road_or_runs_beside_it_is_another_road(second):
    survey = carriageways(**second)
    assert len(survey.frame.roads) == 2 and not warnings_of_levels(survey.frame)
