"""Two methods of finding road boundaries, and how they check each other."""

from contextlib import closing

import numpy as np
import pytest
from curbed_streets import LENGTH, driven, parked_car, street, survey_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.common.curb_points import curb_points_at
from lanewright.core.road.common.decimation import PointDecimation
from lanewright.core.road.common.side_curbs import SideSteps, grids_beside, points_of_side, steps_of_roads
from lanewright.core.road.common.tracking import StepChain
from lanewright.core.road.detect_boundaries import (
    BoundarySettings,
    draw_boundaries,
    find_curb_points,
    measure_agreement,
)
from lanewright.core.road.edges.fit import fit_road_edges
from lanewright.core.road.profiles.detect import profiles_of, steps_of_section

FOOT = -0.02   # m, height of the curb's foot above the expected road


def boundaries(points, method):
    surveyed = survey_of(points)
    return draw_boundaries(find_curb_points(surveyed, BoundarySettings(method)), surveyed.frame)


def curb_points(frame, offset, stations=np.arange(1.0, 59.0), side="left", scatter=0.0, chain=0):
    """Curb points of one side at an offset, a number or a function of station, scattered about it."""
    offsets = np.broadcast_to(offset(stations) if callable(offset) else offset, stations.shape)
    offsets = offsets + scatter * np.where(np.arange(len(stations)) % 2, 1, -1)
    return curb_points_at(frame, 0, frame.to_map(0, stations, offsets, np.zeros(len(stations))), side=side, status="measured",
                          station=stations, offset=offsets, height=0.12, chain=chain, residual=0.0, support=100)


@pytest.fixture(scope="module")
def frame():
    return survey_of(street(length=60.0), driven(60.0)).frame


@pytest.mark.parametrize("method", ["profiles", "scanlines", "both"])
def test_every_method_draws_both_edges_of_a_street(method):
    found = boundaries(street(), method)
    for side, offset in (("left", 3.5), ("right", -3.5)):
        lines = found.edges[found.edges.side == side]
        assert sum(np.ptp(lines.course.s[lines.course.line(k)]) for k in range(len(lines))) > LENGTH - 2
        np.testing.assert_allclose(lines.course.d, offset, atol=0.01)
    assert (found.differences is not None) == (method == "both")


def test_where_both_see_the_curb_they_agree_to_a_centimetre_and_say_so():
    found = boundaries(parked_car(street(), start=25.0), "both")
    assert (found.edges.agree[found.edges.status == "measured"] < 1.0).all()
    assert len(found.differences) == 0
    assert min(found.length_by_method.values()) > 2 * LENGTH - 20


def test_one_method_alone_says_nothing_of_agreement():
    assert np.isnan(boundaries(street(), "scanlines").edges.agree).all()


def test_a_curb_that_only_one_method_finds_is_drawn_without_agreement():
    survey, settings = survey_of(street(curb=0.04, noise=0.002)), BoundarySettings("both", CurbSettings(min_height=0.05))
    found = draw_boundaries(find_curb_points(survey, settings), survey.frame)
    assert found.length_by_method["profiles"] == 0
    assert found.edges.length.sum() > 2 * LENGTH - 10
    assert np.isnan(found.edges.agree).all()


def seen(*stretches):
    """SideSteps of one method on the left, and their chains of 12 cm with the foot at the height of the road: (from, to, offset, scatter)."""
    s = [np.arange(a, b + 0.01, 0.25) for a, b, *_ in stretches]
    u = np.concatenate([offset + scatter * np.where(np.arange(len(part)) % 2, 1, -1) for part, (_, _, offset, scatter) in zip(s, stretches)])
    ends = np.cumsum([0, *map(len, s)])
    ones = np.ones(len(u))
    steps = CurbSteps(profile=np.rint(np.concatenate(s) / 0.25).astype(int), s=np.concatenate(s), u=u, h=FOOT * ones, skew=0 * ones,
                      height=0.12 * ones, run=0 * ones, noise=0.003 * ones, scanner_noise=0.003 * ones, support=50 * ones.astype(int),
                      behind=20 * ones.astype(int), hidden=0 * ones)
    chains = [StepChain(np.arange(a, b), stretch[0], stretch[1], scatter=stretch[3]) for a, b, stretch in zip(ends[:-1], ends[1:], stretches)]
    return SideSteps(steps, 0.25, CurbSettings().limits, np.arange(0.0, 62.0, 2.0), None), chains


@pytest.fixture(scope="module")
def parked():
    """A survey of a street with a parked car between stations 20 and 25, and what was seen on its left."""
    survey, settings = survey_of(parked_car(street(length=60.0), start=20.0), driven(60.0)), CurbSettings()
    with closing(PointDecimation(survey, settings.profile_width, settings.point_spacing)) as decimation:
        steps = steps_of_roads(steps_of_section, decimation, (settings,), {"profiles": profiles_of(decimation, settings)}, Progress())
        return survey, grids_beside(steps["profiles"])[0]["left"]


def drawn(parked, *methods):
    """Points of the left curb from what several methods saw, by station: those that were measured, and those that are hidden."""
    points = points_of_side(parked[0], 0, "left", methods, parked[1])
    return points[points.status == "measured"], points[points.status == "occluded"]


@pytest.mark.parametrize("swapped", [False, True])
def test_of_two_lines_along_one_curb_the_one_with_less_scatter_is_drawn(parked, swapped):
    methods = seen((1.0, 59.0, 3.50, 0.0)), seen((0.5, 59.5, 3.53, 0.02))
    points, _ = drawn(parked, *methods[::-1 if swapped else 1])
    np.testing.assert_allclose(points.offset, 3.50, atol=1e-6)


def test_where_one_curb_ends_the_path_goes_on_along_the_one_that_another_method_sees(parked):
    points, _ = drawn(parked, seen((1.0, 40.0, 3.5, 0.0)), seen((20.0, 59.0, 5.0, 0.0)))
    np.testing.assert_allclose(points.offset[points.station < 39], 3.5)
    np.testing.assert_allclose(points.offset[points.station > 41], 5.0)


def test_a_step_aside_that_one_method_alone_sees_is_not_worth_the_way_there_and_one_that_both_see_is(parked):
    curb, aside = [(1.0, 20.0, 3.5, 0.0), (46.0, 59.0, 3.5, 0.0)], (21.0, 45.0, 5.0, 0.0)
    alone, _ = drawn(parked, seen(*curb, aside), seen(*curb))
    both, _ = drawn(parked, seen(*curb, aside), seen(*curb, aside))
    assert alone.offset.max() < 3.6 and both.offset.max() > 4.9


@pytest.mark.parametrize("first", [True, False], ids=["of the first method", "of the second method"])
def test_a_piece_in_line_with_curbs_of_different_methods_is_the_curb_and_the_car_beside_it_hides_the_rest(parked, first):
    piece, other = seen((1.0, 19.0, 3.5, 0.0), (26.5, 28.0, 3.5, 0.0)), seen((32.0, 59.0, 3.5, 0.0))
    points, hidden = drawn(parked, *((piece, other) if first else (other, piece)))
    assert ((points.station > 26) & (points.station < 28.5)).any() and np.abs(points.offset - 3.5).max() < 1e-3
    assert len(hidden) >= 8 and (np.abs(hidden.station - 22.5) < 4.5).all()


def test_a_stretch_where_the_two_lie_eight_centimetres_apart_is_reported(frame):
    one, other = curb_points(frame, 3.5), curb_points(frame, lambda s: 3.5 + 0.08 * np.exp(-((s - 30) / 6) ** 4))
    drawn = fit_road_edges(one, frame)
    drawn, reported = measure_agreement(drawn, one, other, frame)
    assert len(reported) == 1 and 23 < reported.station[0] < 27 and 33 < reported.end[0] < 37
    assert reported.agree[0] == pytest.approx(8.0, abs=0.5)
    assert drawn.agree[0] == pytest.approx(8.0, abs=1.0)
    np.testing.assert_allclose(reported.course.d, 3.5, atol=0.001)


def test_a_method_that_is_not_known_is_refused():
    with pytest.raises(RoadExtractionError, match="boundary method"):
        BoundarySettings("both ways")


def with_step(length, rough, height=0.06, noise=0.002):
    """A street without curbs, and 2 m beside its asphalt a step as long as that, before which the ground scatters so much."""
    x, y, z, time = street(curb=0.0, noise=noise)
    rng = np.random.default_rng(3)
    verge = np.abs(y) > 3.5
    z[verge] += rng.normal(0.0, rough, verge.sum())
    step, face = np.abs(x - 0.5 * LENGTH) < 0.5 * length, np.abs(y - 5.5) < 0.03
    z[step & (y > 5.53)] += height
    y[step & face] = 5.5
    z[step & face] += rng.uniform(0.0, height, (step & face).sum())
    return x, y, z, time


@pytest.mark.parametrize("length, rough, drawn", [(4.6, 0.006, 0.0), (4.6, 0.0, 4.6), (12.0, 0.006, 12.0)],
                         ids=["in grass", "on pavement", "long in grass"])
def test_a_short_step_is_a_curb_where_road_lies_before_it_and_none_in_grass(length, rough, drawn):
    found = boundaries(with_step(length, rough), "both").edges
    assert found.length.sum() == pytest.approx(drawn, abs=1.5)


def wider_behind_a_side_street():
    """A street with a crossfall of 5.4 % whose left curb lies 3.5 m beside the track up to station 18, and 6.1 m from 29.5 to 37."""
    before, behind = (np.array(street(left=left, length=60.0, camber=0.054, open_left=flush, seed=seed)) for left, flush, seed in
                      ((3.5, (), 3), (6.1, ((-5.0, 29.5), (37.0, 70.0)), 4)))
    return tuple(np.concatenate([before[:, before[0] < 18.0], behind[:, behind[0] >= 18.0]], axis=1))


@pytest.mark.parametrize("method", ["profiles", "scanlines"])
def test_behind_a_side_street_the_curb_of_the_wider_road_is_drawn_as_far_as_it_was_measured(method):
    survey = survey_of(wider_behind_a_side_street(), driven(60.0))
    points = find_curb_points(survey, BoundarySettings(method))[method]
    behind = points[(points.side == "left") & (points.part == "bottom") & (points.height > 0.1) & (points.station > 18.0)]
    assert behind.of_main_curb.all() and np.ptp(behind.station) == pytest.approx(7.0, abs=0.7)
    np.testing.assert_allclose(behind.offset, 6.1, atol=0.02)
