"""What is done for a metre of road does not grow with the road: counts of work on streets of a length and of four times that length."""

import curbed_streets as streets
import numpy as np
import pytest
from curbed_streets import EAST, NORTH
from lanewright.core.execution.phase import Threads
from lanewright.core.road.common import tracking
from lanewright.core.road.common.corners import CurbSteps
from lanewright.core.road.common.pseudo_scanlines import nearest_distance
from lanewright.core.road.common.tracking import StepChain
from lanewright.core.road.curb_returns.main_curbs import KnownPlaces, SearchLimit
from lanewright.core.road.detect_boundaries import draw_boundaries, find_curb_points
from lanewright.core.road.edges import corner_edges, road_edges
from lanewright.core.road.edges.road_edges import EdgePiece, joined_pieces
from lanewright.core.road.surface import ground_grid, pavement_edge
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.road.surface.ground_grid import MeasuredGround
from lanewright.core.road.weights import SURFACE
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory

SHORT, LONG = 12, 48     # pieces of edge, one every 25 m
MOST = 1.3 * LONG / SHORT   # times the work that the long road may take: ends of roads count, too


def straight_road(pieces):
    """The frame of a straight road driven eastward, 25 m for each piece of edge."""
    x = np.arange(0.0, 25.0 * pieces + 20.0, 0.5)
    return build_frame(Trajectory(x / 10, x + EAST, np.full(len(x), NORTH), np.full(len(x), 102.0)))


def edge_pieces(pieces):
    """Edges of 18 m on both sides, one behind the other."""
    found = []
    for k in range(pieces):
        x = np.arange(0.0, 18.5, 0.5) + 25.0 * k + 5.0
        for side, y in (("left", 3.5), ("right", -3.5)):
            vertices = np.c_[x + EAST, np.full(len(x), NORTH + y + 0.01 * (k % 3)), np.full(len(x), 100.0)]
            found.append(EdgePiece(vertices, 0, side, "measured", len(found), x[0], x[-1], 18.0))
    return found


@pytest.fixture
def interpolated(monkeypatch):
    """How many values numpy interpolated."""
    count, plain = [0], np.interp

    def counted(x, *others, **options):
        count[0] += np.size(x)
        return plain(x, *others, **options)

    monkeypatch.setattr(np, "interp", counted)
    return count


def work_of(count, function):
    """The work that a function of the number of pieces does on the short road and on the long one."""
    found = []
    for pieces in (SHORT, LONG):
        count[0] = 0
        function(pieces)
        found.append(count[0])
    assert found[0] > 0
    return found


def test_the_offsets_of_edges_are_asked_for_where_the_edges_are(interpolated):
    def offsets(pieces):
        frame = straight_road(pieces)
        edges = joined_pieces(edge_pieces(pieces), frame)
        stations = np.arange(0.0, 25.0 * pieces, 0.5)
        interpolated[0] = 0
        found = pavement_edge.edge_offsets(edges, 0, stations)
        assert np.isfinite(found["left"][0]).mean() > 0.95

    short, long = work_of(interpolated, offsets)
    assert long <= MOST * short


def test_ends_of_edges_are_compared_with_those_near_them_alone(monkeypatch):
    count, plain = [0], corner_edges._is_corner

    def counted(tail, head):
        count[0] += 1
        return plain(tail, head)

    monkeypatch.setattr(corner_edges, "_is_corner", counted)
    short, long = work_of(count, lambda pieces: corner_edges.dropped_corners(edge_pieces(pieces), straight_road(pieces), 0))
    assert long <= MOST * short


def test_a_corner_finds_the_end_of_the_edge_that_it_begins_at():
    pieces = edge_pieces(SHORT)
    ends = corner_edges._main_ends(pieces, 0)
    assert len(ends) == 4 * SHORT
    near = corner_edges._nearest(ends, corner_edges.cKDTree(ends[:, :2]), ends[7] + [0.6, 0.5, 0.0])
    np.testing.assert_array_equal(near, ends[7:8])
    assert not len(corner_edges._nearest(ends, corner_edges.cKDTree(ends[:, :2]), ends[7] + [0.0, 40.0, 0.0]))


def test_the_uncertainty_of_a_piece_follows_from_the_curb_points_about_it(monkeypatch):
    random = np.random.default_rng(5)
    places, residual, support = np.arange(0.0, 4000.0, 0.5), random.normal(0.0, 0.01, 8000), random.integers(0, 60, 8000)
    at = np.linspace(1200.0, 1230.0, 61)
    near = slice(2000, 2900)
    inner = road_edges.edge_sigma(at, places[near], residual[near], support[near])
    summed, plain = [], np.cumsum
    monkeypatch.setattr(np, "cumsum", lambda values: summed.append(len(values)) or plain(values))
    assert road_edges.edge_sigma(at, places, residual, support) == pytest.approx(inner, rel=1e-9)
    # 30 m of the piece and 10 m before and behind it, two points a metre
    assert summed == [101]


def chains_along(pieces):
    """Chains of 4 m of one straight curb, one every 12.5 m, and beside each gap a chain of something else."""
    stretches = [(12.5 * k, 12.5 * k + 4.0, 3.5) for k in range(2 * pieces)] + [(12.5 * k + 5.5, 12.5 * k + 8.0, 3.5) for k in range(2 * pieces)]
    s = [np.arange(a, b, 0.25) for a, b, _ in stretches]
    u = np.concatenate([np.full(len(own), offset) for own, (_, _, offset) in zip(s, stretches)])
    ends = np.cumsum([0, *map(len, s)])
    s = np.concatenate(s)
    zero, one = np.zeros(len(s)), np.ones(len(s))
    steps = CurbSteps(profile=np.rint(s / 0.25).astype(int), s=s, u=u, h=zero, skew=zero, height=0.1 * one, run=zero, noise=0.003 * one,
                      scanner_noise=0.003 * one, support=50 * one.astype(int), behind=20 * one.astype(int), hidden=zero)
    chains = [StepChain(np.arange(a, b), float(s[a]), float(s[b - 1])) for a, b in zip(ends[:-1], ends[1:])]
    return steps, chains, [(k, chains[k].start, chains[k].end) for k in range(2 * pieces)]


def test_between_two_pieces_of_curb_those_steps_are_looked_at_that_lie_there(monkeypatch):
    count, plain = [0], tracking.GapLine.off

    def counted(line, x, y):
        count[0] += len(x)
        return plain(line, x, y)

    monkeypatch.setattr(tracking.GapLine, "off", counted)

    def pieces_in_line(pieces):
        steps, chains, kept = chains_along(pieces)
        assert len(tracking.with_pieces_in_line(kept, chains, steps, lambda s, u: (s, u))) == 4 * pieces - 1

    short, long = work_of(count, pieces_in_line)
    assert long <= MOST * short


def test_a_scattered_piece_is_compared_with_the_chains_that_end_near_it(monkeypatch):
    count, plain = [0], tracking._in_line

    def counted(*arguments):
        count[0] += 1
        return plain(*arguments)

    monkeypatch.setattr(tracking, "_in_line", counted)

    def continued(pieces):
        steps, chains, _ = chains_along(pieces)
        chains, weak = chains[:2 * pieces], chains[2 * pieces:]
        assert len(tracking._continuing(chains, weak, steps)) == len(weak)

    short, long = work_of(count, continued)
    assert long <= MOST * short


def test_the_best_chains_are_the_same_however_many_follow():
    steps, chains, kept = chains_along(SHORT)
    more, others, _ = chains_along(LONG)
    first = tracking.select_along_road(chains, steps, lambda station: 0.0)
    second = tracking.select_along_road(others, more, lambda station: 0.0)
    stations = [part[1:] for part in second if part[2] < 280.0]
    assert [part[1:] for part in first][:len(stations)] == stations and len(stations) > 2 * SHORT
    assert kept


def test_how_far_out_is_searched_is_what_a_look_at_all_curbs_tells():
    random = np.random.default_rng(2)
    s = np.sort(np.concatenate([np.arange(a, a + random.uniform(1.0, 60.0), 0.8) for a in np.arange(0.0, 2000.0, 90.0)]))
    points = np.c_[s, 3.5 + 0.2 * np.sin(s / 9), np.zeros(len(s)), random.random(len(s)) < 0.8]
    limit = SearchLimit(points, 1)
    runs = [(part[0], part[-1]) for part in np.split(s, np.flatnonzero(np.diff(s) > 6.0) + 1)]
    at, d = random.uniform(-20.0, 2100.0, 5000), random.uniform(0.0, 30.0, 5000)
    bounded = np.any([(at > a + 6.0) & (at < b - 6.0) for a, b in runs], axis=0)
    np.testing.assert_array_equal(limit(at), np.where(bounded, np.interp(at, s, points[:, 1]) + 0.6, 25.0))
    end = np.max([np.zeros(len(at)), *(np.minimum(at - a, b - at) for a, b in runs)], axis=0)
    out = limit.outward(at, d)
    np.testing.assert_array_equal(limit.behind(at, d), (out > 0) & (out < end))
    np.testing.assert_array_equal(limit.far_from(at, 7.0), np.all([(at < a - 7.0) | (at > b + 7.0) for a, b in runs], axis=0))


def test_places_that_become_known_later_are_known_like_the_first():
    random = np.random.default_rng(4)
    known, all_places = KnownPlaces(np.empty((0, 2))), np.empty((0, 2))
    for count in (3, 40, 1, 1, 5, 200, 2):
        more = random.uniform(0.0, 50.0, (count, 2))
        known, all_places = known.and_places(*more.T), np.concatenate([all_places, more])
        x, y = random.uniform(0.0, 50.0, (2, 300))
        away = np.hypot(x[:, None] - all_places[:, 0], y[:, None] - all_places[:, 1]).min(axis=1)
        np.testing.assert_array_equal(known.within(x, y, 1.5), away <= 1.5)
    assert len(known._trees) < 6


def test_the_nearest_of_some_places_is_found_and_without_any_none_is_near():
    places = np.arange(0.0, 40.0, 0.5)
    np.testing.assert_array_equal(nearest_distance(places, np.array([30.0, 7.0])), np.minimum(np.abs(places - 7.0), np.abs(places - 30.0)))
    assert np.isinf(nearest_distance(places, np.empty(0))).all()


class Counting(Threads):
    """Threads that note the phases they are given."""

    def __init__(self):
        super().__init__(2)
        self.phases = []

    def run(self, phase, *others):
        self.phases.append(phase.function.__name__)
        return super().run(phase, *others)


def phases_of(second):
    """The phases of curbs and road surface, and how many roads there are."""
    survey = streets.survey_of(streets.street(), second=second)
    survey.executor, ground = Counting(), MeasuredGround(survey)
    edges = draw_boundaries(find_curb_points(survey, ground=ground), survey.frame, survey=survey, ground=ground).edges
    extract_road_surface(survey, edges, ground=ground)
    # who drove where is looked at pass by pass, since its samples would take too much memory together
    return [name for name in survey.executor.phases if name not in ("_windows_at", "_phasors_of_stretches")], len(survey.frame.roads)


def test_two_roads_wait_for_their_workers_no_more_often_than_one():
    beside = [np.array(streets.street(seed=4)), np.array(streets.driven(start=1100.0))]
    for rows, north in zip(beside, (1, 2)):
        rows[north] += 60.0
    beside[0][3] += 100.0
    alone, together = phases_of(None), phases_of([tuple(rows) for rows in beside])
    assert (alone[1], together[1]) == (1, 2) and sorted(alone[0]) == sorted(together[0])


def test_the_ground_is_measured_once_for_edges_and_surface(monkeypatch):
    survey = streets.survey_of(streets.street())
    count, plain = [0], ground_grid.ground_of_windows

    def counted(source, windows, arrays):
        count[0] += len(windows)
        return plain(source, windows, arrays)

    monkeypatch.setattr(ground_grid, "ground_of_windows", counted)
    ground, rows = MeasuredGround(survey), [SURFACE.window_rows * k for k in range(5)]
    cells, none = ground.windows(0, rows, [False] * 5)
    assert none is None and count[0] == 5 and np.isfinite(cells.height).any()
    _, profiles = ground.windows(0, rows, [True, False, True, True, False])
    assert count[0] == 8 and len(profiles.stations) == 15
    again, more = ground.windows(0, rows[1:], [False, True, True, False])
    assert count[0] == 8
    np.testing.assert_array_equal(again.height, cells.height[SURFACE.window_rows:])
    np.testing.assert_array_equal(more.height, profiles.height[5:])
    np.testing.assert_array_equal(more.stations, profiles.stations[5:])
