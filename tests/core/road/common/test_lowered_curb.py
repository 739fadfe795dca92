"""Curbs lowered for drives and crossings go on along their line, and nothing goes on across mouths of streets and behind bulb-outs."""

from functools import partial

import numpy as np
import pytest
import shapely
from curbed_streets import EAST, LENGTH, NORTH, driven, street, survey_of
from lanewright.core.road.common.lowered_curb import lowered_points
from lanewright.core.road.surface.ground_grid import MeasuredGround
from lanewright.core.road.surface.road_look import RoadLook
from road_layers import detect_curbs, fit_road_edges

HEIGHT, RAMP, OFFSET = 0.12, 1.0, 3.5   # m: of the full curb, along the road down to the lowered one, from the track to the left curb
STRETCH = 18.0, 27.0                    # m along the road, without the ramps


def lowered(points, low, stretch=STRETCH):
    """The street with its left curb lowered to `low` m; behind it the ground rises to the sidewalk by 10 %."""
    x, y, z, time = (np.array(values) for values in points)
    beside = np.clip(np.maximum(stretch[0] - x, x - stretch[1]) / RAMP, 0.0, 1.0)
    curb = low + (HEIGHT - low) * beside**2 * (3.0 - 2.0 * beside)
    up = y > OFFSET + 0.012
    z[up] -= np.maximum(HEIGHT - curb - 0.1 * (y - OFFSET), 0.0)[up]
    seen = (np.abs(y - OFFSET) > 0.012) | (z + 0.02 * OFFSET < curb + 0.003)
    return x[seen], y[seen], z[seen], time[seen]


def with_bulb_out(points, depth, stretch=STRETCH):
    """The street with the sidewalk `depth` m farther into the road on the left."""
    x, y, z, time = (np.array(values) for values in points)
    out = (y > OFFSET - depth) & (y < OFFSET + 0.01) & (x > stretch[0]) & (x < stretch[1])
    z[out] = HEIGHT - 0.02 * OFFSET + np.random.default_rng(1).normal(0.0, 0.003, out.sum())
    return x, y, z, time


def turned_away(x, end=STRETCH[1], radius=12.0):
    """m by which a curb that bends away from the road before a station, m, lies farther out, on an arc of that radius, m."""
    return np.clip(end - x, 0.0, None)**2 / (2.0 * radius)


def edges_of(points, backwards=False, bend=np.zeros_like):
    """Pieces of the left edge, seen along the first drive: (from, to, largest distance from the curb's line in m, kind), by station.

    bend : function, m along the road -> m by which the curb lies farther out than OFFSET
    """
    if backwards:
        x, y, z, time = points
        points = x, y, z, 2000.0 + (LENGTH - np.clip(x, 0, LENGTH)) / 10
    survey = survey_of(points, driven(backwards=backwards, start=2000.0 if backwards else 1000.0))
    pieces = []
    for line, row in fit_road_edges(detect_curbs(survey), survey.frame):
        x, y = (shapely.get_coordinates(line) - [EAST, NORTH]).T
        if y.mean() > 0 and row["kind"] == "main":
            pieces.append((float(x.min()), float(x.max()), float(np.abs(y - OFFSET - bend(x)).max()), row["edge"]))
    return sorted(pieces)


def length(pieces, kind):
    return sum(end - start for start, end, _, what in pieces if what == kind)


@pytest.mark.parametrize("low, seed", [(0.02, 0), (0.02, 1), (0.03, 2)])
def test_a_lowered_curb_goes_on_as_a_dropped_edge_whichever_way_it_is_driven(low, seed):
    points = lowered(street(seed=seed), low)
    there, back = edges_of(points), edges_of(points, backwards=True)
    for pieces in (there, back):
        assert length(pieces, "dropped") > 3.0
        assert length(pieces, "dropped") + length(pieces, "curb") == pytest.approx(pieces[-1][1] - pieces[0][0], abs=0.01), "without a gap"
        assert max(off for *_, off, _ in pieces) < 0.05


def test_a_side_without_curb_has_no_lowered_one():
    survey = survey_of(street())
    assert not lowered_points([], survey.frame.road(0), RoadLook(MeasuredGround(survey), 0).side(1))


def test_across_level_ground_nothing_goes_on():
    pieces = edges_of(street(open_left=[STRETCH]))
    assert {kind for *_, kind in pieces} == {"curb"}
    assert not any(start < 22.0 < end for start, end, *_ in pieces)


@pytest.mark.parametrize("depth", [0.5, 1.2, 2.0])
def test_behind_a_bulb_out_nothing_goes_on_although_the_curb_sinks_beside_it(depth):
    beside = STRETCH[1], STRETCH[1] + 5.0
    pieces = edges_of(with_bulb_out(lowered(street(right=5.0), 0.025, beside), depth))
    assert not any(start < 22.0 < end and off < 0.3 for start, end, off, _ in pieces)
    assert length(pieces, "dropped") > 3.0, "beside the bulb-out the lowered curb goes on"


@pytest.mark.parametrize("seed", range(3))
def test_around_a_corner_of_which_only_a_metre_is_seen_behind_it_a_lowered_curb_is_not_led_past_its_place(seed):
    x, y, z, time = lowered(street(open_left=[(-10.0, STRETCH[0] - 1.5)], seed=seed), 0.025)
    around = x, y + turned_away(x) * np.clip(y / OFFSET, 0.0, 1.0), z, time
    assert max(off for *_, off, _ in edges_of(around, bend=turned_away)) < 0.1


@pytest.mark.parametrize("low, seed", [(0.02, 0), (0.02, 1), (0.03, 2)])
def test_a_lowered_curb_goes_straight_on_to_the_place_where_a_corner_begins_of_which_little_is_seen(low, seed):
    begin = STRETCH[0] - RAMP / 2
    corner = partial(turned_away, end=begin, radius=3.0)
    x, y, z, time = lowered(street(open_left=[(-10.0, begin - 2.0)], seed=seed), low)
    around = x, y + corner(x) * np.clip(y / OFFSET, 0.0, 1.0), z, time
    pieces = edges_of(around, bend=corner)
    assert length(pieces, "dropped") > 5.0
    assert max(off for *_, off, what in pieces if what == "dropped") < 0.05


@pytest.mark.parametrize("noise", [0.003, 0.008])
def test_on_rough_ground_a_step_is_measured_against_what_the_road_beside_it_shows(noise):
    pieces = edges_of(street(open_left=[STRETCH], noise=noise, seed=5))
    assert length(pieces, "dropped") == 0.0
