"""Zebra crossings by the pitch of their stripes: near the vehicle, and far from it, where the scan shows a few tracks and wear leaves half."""

import numpy as np
import pytest
from clustered_marks import FRAME, classes, layer_of
from lanewright.core.markings.objects.repeating import comb_of_window, crossings_of, spots_by_place, stripes_of_crossings
from painted_streets import paint, road_points, strip

STRIPES = [strip(-2.0, 2.0, d, d + 0.5) for d in np.arange(-3.0, 3.0, 1.0)]   # 4 m long, a metre apart


def spots(marks, turned=0.0, tracks=0.35, kept=0.6, seed=4):
    """(N, 2) spots of paint on tracks of the scan across the stripes, turned about the middle by some degrees."""
    u, v = np.meshgrid(np.arange(-6.0, 6.0, tracks), np.arange(-6.5, 6.5, 0.06), indexing="ij")
    rng = np.random.default_rng(seed)
    u, v = u.ravel() + rng.normal(0, 0.01, u.size), v.ravel()
    shown = np.any([mark(u, v) for mark in marks], axis=0) & (rng.random(u.size) < kept)
    c, n = np.cos(np.radians(turned)), np.sin(np.radians(turned))
    return np.stack([u, v], axis=1)[shown] @ np.array([[c, n], [-n, c]]), (c, n)


def crossings_in(places):
    way, (by_place, windows) = np.zeros(len(places)), spots_by_place(places)
    crossings = crossings_of(by_place, windows, [comb_of_window(places[members]) for members in windows])
    return [stripe for rows, together in crossings for stripe in stripes_of_crossings(places[rows], way[rows], together)]


@pytest.mark.parametrize("turned", [0, 17, 45, 90, 128])
def test_stripes_are_found_whichever_way_they_point(turned):
    places, (c, n) = spots(STRIPES, turned)
    found = crossings_in(places)
    assert len(found) == 6
    assert len(np.concatenate([stripe.spots for stripe in found])) > 0.9 * len(places)
    corners = np.stack([stripe.corners for stripe in found]) @ np.array([[c, -n], [n, c]])
    np.testing.assert_allclose(np.sort(corners.mean(axis=1)[:, 1]), np.arange(-2.75, 3.0, 1.0), atol=0.05)
    np.testing.assert_allclose([corners[:, :, 0].min(axis=1), corners[:, :, 0].max(axis=1)], [[-2.0] * 6, [2.0] * 6], atol=0.35)
    np.testing.assert_allclose(np.ptp(corners[:, :, 1], axis=1), 0.5, atol=0.1)


def test_a_stop_line_beside_a_crossing_is_none_of_it():
    places, _ = spots([*STRIPES, strip(3.2, 3.7, -3.0, 3.0)])
    found = crossings_in(places)
    assert len(found) == 6
    assert max(stripe.corners[:, 0].max() for stripe in found) < 2.5


def test_an_edge_line_that_leads_on_from_the_outermost_stripe_is_none_of_it():
    edge = strip(2.2, 6.0, 1.19, 1.31)
    places, _ = spots([*STRIPES[1:5], edge], tracks=0.06, kept=0.9)
    found = crossings_in(places)
    assert len(found) == 4
    assert max(stripe.corners[:, 0].max() for stripe in found) < 2.5


@pytest.mark.parametrize("length", [4.0, 4.05, 4.2])
def test_a_stripe_has_all_its_paint_whatever_its_length(length):
    places, _ = spots([strip(-2.0, length - 2.0, d, d + 0.5) for d in np.arange(-3.0, 3.0, 1.0)], tracks=0.04, kept=0.95)
    assert len(np.concatenate([stripe.spots for stripe in crossings_in(places)])) > 0.995 * len(places)


def test_most_stripes_of_a_few_spots_each_are_found():
    found = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        places = np.concatenate([np.column_stack([rng.uniform(0, 4, 15), k + rng.uniform(-0.25, 0.25, 15)]) for k in range(6)])
        found.append(len(crossings_in(places)))
    assert np.mean(found) > 4.8


def test_lines_that_end_at_a_crossing_do_not_turn_its_stripes():
    left = [strip(2.2, 6.0, 2.02, 2.14), strip(2.2, 6.0, 0.2, 0.35), strip(2.2, 6.0, 0.55, 0.70)]
    right = [strip(-6.0, -2.2, -2.95, -2.83), strip(-3.0, -2.5, -3.0, 0.3)]
    places, _ = spots([*STRIPES, *left, *right], tracks=0.06, kept=0.9)
    corners = np.stack([stripe.corners for stripe in crossings_in(places)])
    assert len(corners) == 6
    np.testing.assert_allclose(np.sort(corners[:, :, 1].min(axis=1)), np.arange(-3.0, 3.0, 1.0), atol=0.025)
    np.testing.assert_allclose(np.sort(corners[:, :, 1].max(axis=1)), np.arange(-2.5, 3.5, 1.0), atol=0.025)


def bars(turn):
    """Bars of hatching half a metre broad in a strip along the first axis, oblique to it."""
    c, n = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return [lambda s, d, k=k: (np.abs(d) < 1.5) & (np.abs((s - 1.4 * k) * n - d * c) < 0.25) for k in range(-4, 5)]


@pytest.mark.parametrize("marks", [
    [strip(-6, 6, d, d + 0.12) for d in (-1.6, 0.0, 1.6)],
    [strip(s, s + 1.0, 0.0, 0.12) for s in range(-6, 6, 2)],
    [strip(-0.5, 0.0, d, d + 0.5) for d in np.arange(-3, 3, 1.0)],
    [strip(-2.0, 2.0, 0.0, 3.0)],
    bars(45), bars(60),
], ids=["three lines", "a dashed line", "a give-way line", "a field", "hatching", "steep hatching"])
def test_other_paint_is_no_crossing(marks):
    assert not crossings_in(spots(marks)[0])


@pytest.mark.parametrize("share, count", [(0.0, 5), (0.2, 0)])
def test_bars_with_other_paint_between_them_as_of_letters_are_no_crossing(share, count):
    bars = [strip(-1.5, 1.5, d, d + 0.29) for d in 0.85 * np.arange(-2, 3)]
    between = spots([strip(-1.5, 1.5, -1.7, 1.99)], tracks=0.1, kept=share, seed=5)[0]
    assert len(crossings_in(np.concatenate([spots(bars, tracks=0.1, kept=1.0)[0], between]))) == count


def test_the_crossing_of_a_side_street_seen_on_few_tracks_is_a_crossing():
    """The road runs along s: its tracks cross the stripes, and spots on one track look like a dashed line."""
    records = paint(FRAME, [strip(s, s + 0.5, 1.0, 5.0) for s in np.arange(30.0, 36.0)], density=6000)
    d = records["d"] * 1e-4
    records = records[d % 0.35 < 0.05]
    records["spacing"] = 350
    points = road_points(records, FRAME)
    points.has_spacing = True
    markings, clustered = layer_of(points, FRAME)
    assert classes(markings) == ["zebra"] * 6
    assert markings.column("length_m") == pytest.approx([4.0] * 6, abs=0.5)
    assert (clustered.all_points().cluster > 0).mean() > 0.95


def test_all_stripes_end_on_one_line_however_few_tracks_met_their_ends():
    """Each ends where a track last met it, up to 0.35 m before its end: the line that most of them reach is drawn."""
    oblique = [lambda s, d, k=k: (np.abs(d - k) < 0.25) & (np.abs(s - 0.1 * k) < 2.0) for k in range(-4, 5)]
    places, _ = spots(oblique, tracks=0.35, kept=0.5)
    rng = np.random.default_rng(1)
    places[:, 0] += rng.normal(0, 0.02, len(places))
    stripes = crossings_in(places)
    assert len(stripes) == len(oblique)
    for stripe in stripes:
        middle = stripe.corners[:, 1].mean()
        assert stripe.corners[:, 0].max() - 0.1 * middle == pytest.approx(2.0, abs=0.2)


def test_a_crossing_seen_densely_on_one_side_and_on_few_tracks_on_the_other_is_one():
    places, _ = spots([strip(-2.0, 2.0, d, d + 0.5) for d in np.arange(-6.0, 6.0, 1.0)], tracks=0.05, kept=1.0)
    rng = np.random.default_rng(2)
    far = (places[:, 1] > 0) & (np.abs(places[:, 0] / 0.4 - np.rint(places[:, 0] / 0.4)) > 0.1)
    found = crossings_in(places[~far | (rng.random(len(places)) < 0.05)])
    assert len(found) == 12
    assert [np.ptp(stripe.corners[:, 0]) for stripe in found] == pytest.approx([4.0] * 12, abs=0.2)


@pytest.mark.parametrize("pitch", [0.97, 1.02])
def test_the_pitch_of_a_broad_crossing_is_that_of_all_its_stripes(pitch):
    middles = pitch * np.arange(12)
    places, _ = spots([strip(-2.0, 2.0, d - 6.25, d - 5.75) for d in middles], tracks=0.05)
    found = np.sort([stripe.corners[:, 1].mean() for stripe in crossings_in(places)])
    np.testing.assert_allclose(found, middles - 6.0, atol=0.04)


def test_strips_that_would_be_drawn_longer_than_any_crossing_are_none():
    """Each is 9 m long, as lines between lanes that few tracks met, but they begin up to 3 m apart and would all be drawn to the same ends."""
    rng = np.random.default_rng(6)
    u, v = (rng.uniform(-reach, reach, 30_000)[:12_000] for reach in (12.0, 3.5))
    begin = np.array([-5.5, -2.6, -5.6, -3.5, -3.1, -5.2, -5.0])[np.floor(v + 3.5).astype(int)]
    strips = ((v + 3.5) % 1.0 < 0.5) & (u > begin) & (u < begin + 9.0)
    assert not crossings_in(np.stack([u, v], axis=1)[strips])


def test_two_stripes_are_no_crossing():
    assert not crossings_in(spots(STRIPES[:2], tracks=0.05)[0])
