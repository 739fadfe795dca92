"""Two methods of finding road boundaries, and how they check each other."""


import numpy as np
import pytest
from curbed_streets import LENGTH, driven, parked_car, street, survey_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.common.curb_points import curb_points_at
from lanewright.core.road.common.occlusion import OcclusionGrid
from lanewright.core.road.common.side_curbs import SideChains
from lanewright.core.road.detect_boundaries import (
    BoundarySettings,
    CurbEvidence,
    draw_boundaries,
    find_curb_points,
    measure_agreement,
    select_curb_points,
)
from lanewright.core.road.edges.fit import fit_road_edges


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


def test_of_two_lines_along_one_curb_the_one_with_less_scatter_is_drawn(frame):
    calm, rough = curb_points(frame, 3.50), curb_points(frame, 3.53, scatter=0.03)
    for first, second in ((calm, rough), (rough, calm)):
        drawn = select_curb_points(first, second, fit_road_edges(first, frame), fit_road_edges(second, frame), frame)
        np.testing.assert_allclose(drawn.offset, 3.50, atol=1e-6)


def test_of_two_curbs_that_of_the_first_method_is_drawn_and_its_gaps_are_filled_by_the_other(frame):
    sure, other = curb_points(frame, 3.5, np.arange(1.0, 40.0)), curb_points(frame, 5.0, np.arange(20.0, 55.0))
    drawn = select_curb_points(sure, other, fit_road_edges(sure, frame), fit_road_edges(other, frame), frame)
    s, d = drawn.station, drawn.offset
    np.testing.assert_allclose(d[s < 39], 3.5)
    np.testing.assert_allclose(d[s > 41], 5.0)


def ground(rise):
    """What a method saw of 60 m of road on the left: ground that rises at 3.5 m, by as much as a function of the station says; nowhere where NaN."""
    grid = OcclusionGrid(0.25, 0, 240, 20.0)
    grid.ground[:] = np.where(np.arange(grid.cells) * 0.25 >= 3.5, rise((np.arange(240) + 0.5) * 0.25)[:, None], 0.0)
    return CurbEvidence(beside={0: {"left": grid}})


def shown_by(points_per_step):
    """Chains of a method whose profiles, 25 cm apart, show a step at 3.5 m on the left, each by so many points."""
    s = np.arange(0.125, 60.0, 0.25)
    ones = np.ones(len(s))
    steps = CurbSteps(profile=np.arange(len(s)), s=s, u=3.5 * ones, h=0 * ones, skew=0 * ones, height=0.03 * ones, run=0 * ones, noise=0.003 * ones,
                      scanner_noise=0.003 * ones, support=points_per_step * ones.astype(int), behind=5 * ones.astype(int))
    return CurbEvidence(chains={(0, "left"): SideChains(steps, [], np.empty(0))})


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("rise, points, end", [(0.0, 8, 30), (0.01, 8, 30), (0.03, 8, 55), (np.nan, 8, 55), (0.01, 50, 55)],
                         ids=["level", "nearly level", "raised", "not seen", "shown by many points"])
def test_a_curb_that_one_method_leads_on_ends_where_the_other_saw_level_ground(frame, rise, points, end, swapped):
    short, long = curb_points(frame, 3.5, np.arange(1.0, 30.5, 0.5)), curb_points(frame, 3.5, np.arange(1.0, 55.5, 0.5))
    methods = [(short, ground(lambda s: np.where(s < 30, 0.12, rise))), (long, shown_by(points))]
    (first, seen), (second, others_seen) = methods[::-1 if swapped else 1]
    drawn = select_curb_points(first, second, fit_road_edges(first, frame), fit_road_edges(second, frame), frame, seen, others_seen)
    assert drawn.station.max() == pytest.approx(end, abs=1.0)



def test_a_stretch_where_the_two_lie_eight_centimetres_apart_is_reported(frame):
    one = fit_road_edges(curb_points(frame, 3.5), frame)
    other = fit_road_edges(curb_points(frame, lambda s: 3.5 + 0.08 * np.exp(-((s - 30) / 6) ** 4)), frame)
    drawn = fit_road_edges(curb_points(frame, 3.5), frame)
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
