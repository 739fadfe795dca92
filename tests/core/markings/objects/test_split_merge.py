"""Paint that touches: what is one marking and what is two."""

import numpy as np
import pytest
from lanewright.core.markings.objects.split_merge import are_compound, parts_of_compound
from lanewright.core.survey.store.records import ROAD_POINT, to_units


def paint(*strips, spacing=0.03):
    """Points on painted rectangles (s0, s1, d0, d1) and the number of the rectangle of each."""
    places, owner = [], []
    for number, (s0, s1, d0, d1) in enumerate(strips):
        s, d = np.meshgrid(np.arange(s0, s1, spacing), np.arange(d0, d1, spacing))
        places.append(np.c_[s.ravel(), d.ravel()])
        owner.append(np.full(s.size, number))
    places = np.vstack(places)
    records = np.zeros(len(places), ROAD_POINT)
    records["s"], records["d"] = to_units(places[:, 0]), to_units(places[:, 1])
    return records, np.concatenate(owner)


def split(records):
    """The part of every point of one cluster."""
    columns = [records[name] for name in ("s", "d", "spacing")]
    compound = are_compound(*columns[:2], np.zeros(1, np.int64))
    return parts_of_compound(*columns) if compound.all() else np.zeros(len(records), np.int64)


def share_together(labels, owner, number):
    """Share of a rectangle's points that carry its most frequent label."""
    return np.bincount(labels[owner == number]).max() / np.count_nonzero(owner == number)


def test_a_stop_line_that_runs_into_an_edge_line_is_two_markings():
    records, owner = paint((0, 30, 3.0, 3.15), (20.0, 20.4, 0.0, 3.0))
    labels = split(records)
    assert len(np.unique(labels)) == 2
    assert share_together(labels, owner, 0) > 0.98 and share_together(labels, owner, 1) > 0.9


def test_an_edge_line_and_a_centre_line_joined_by_a_stop_line_are_three():
    records, owner = paint((0, 30, 3.0, 3.15), (0, 8, -0.15, 0.0), (0.0, 0.4, 0.0, 3.0))
    assert len(np.unique(split(records))) == 3


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
@pytest.mark.parametrize("gap", [0.0, 0.08])
def test_a_stop_line_that_touches_a_dash_is_two_markings(gap, side):
    records, owner = paint((0, 0.4, 0.15, 3.2), (0.4, 4.4, -0.075 - gap, 0.15 - gap))
    records["d"] *= side
    labels = split(records)
    assert len(np.unique(labels)) == 2
    assert share_together(labels, owner, 0) > 0.9 and share_together(labels, owner, 1) > 0.9


def test_a_stop_line_of_scan_lines_far_apart_is_cut_from_its_dash():
    records, owner = paint((0, 0.4, 0.15, 3.2), (0.4, 4.4, -0.075, 0.15))
    # scan lines oblique, as a scanner mounted at 45 degrees draws them, 0.23 m apart
    kept = np.abs((records["s"] + records["d"]) * 1e-4 / 0.23 % 1.0 - 0.5) < 0.08
    records, owner = records[kept], owner[kept]
    labels = split(records)
    assert len(np.unique(labels)) == 2
    assert share_together(labels, owner, 0) > 0.85 and share_together(labels, owner, 1) > 0.9


@pytest.mark.parametrize("station", [0, 1, 4, 98765])
def test_scan_lines_as_far_apart_as_paint_may_be_make_one_line_wherever_on_the_road(station):
    records, owner = paint((0, 30, 3.0, 3.15), (20.0, 20.4, 0.0, 3.0))
    kept = (owner == 1) | (records["s"] // 400 % 10 == 0)   # the edge line on every tenth cell of 4 cm alone
    records["s"] += 400 * station
    assert len(np.unique(split(records[kept])[owner[kept] == 0])) == 1


@pytest.mark.parametrize("breadth", [0.9, 1.4])
def test_what_wear_left_of_a_stop_line_is_cut_from_the_dash_before_it(breadth):
    records, owner = paint((0, 0.4, 0.0, breadth), (-4.0, 0.0, -0.075, 0.075))
    labels = split(records)
    assert len(np.unique(labels)) == 2
    assert share_together(labels, owner, 0) > 0.98 and share_together(labels, owner, 1) > 0.98


def test_a_stop_line_takes_what_wear_left_between_its_front_and_its_rear():
    """Its rear is worn through beside a piece that is no run of its own."""
    records, owner = paint((0, 0.5, 0.15, 3.6), (0.5, 4.5, -0.075, 0.15))
    left = (owner == 1) | (np.abs(records["d"] - 11000) > 2000) | (records["s"] < 1500)
    records, owner = records[left], owner[left]
    labels = split(records)
    assert len(np.unique(labels)) == 2
    assert share_together(labels, owner, 0) > 0.95 and share_together(labels, owner, 1) > 0.95


def test_a_stop_line_that_a_line_crosses_is_cut_from_both_its_ends():
    records, owner = paint((0, 0.5, -0.6, 0.6), (0.5, 3.5, -0.06, 0.06), (-3.0, 0.0, -0.06, 0.06))
    labels = split(records)
    assert len(np.unique(labels)) == 3
    assert min(share_together(labels, owner, number) for number in range(3)) > 0.98


@pytest.mark.parametrize("gap", [0.0, 0.08])
def test_a_line_that_touches_a_zebra_stripe_stays_a_line(gap):
    records, owner = paint((0, 33, 0.0, 0.15), (30, 34, 0.15 + gap, 0.65 + gap))
    labels = split(records)
    assert len(np.unique(labels)) == 2
    assert share_together(labels, owner, 0) > 0.95 and share_together(labels, owner, 1) > 0.8


def test_hatching_is_cut_from_the_line_that_borders_it():
    records, owner = paint((0, 30, 3.0, 3.15), *((s, s + 1.3, 3.15, 5.0) for s in np.arange(2.0, 28.0, 3.0)))
    labels = split(records)
    assert share_together(labels, owner, 0) > 0.98
    bars = labels[(owner > 0) & (records["d"] > 34000)]
    assert np.bincount(labels[owner == 0]).argmax() not in bars and len(np.unique(bars)) == 9


def test_the_lines_before_and_behind_the_outline_of_an_island_are_two():
    records, owner = paint((0, 20, -0.06, 0.06), (40, 70, -0.06, 0.06), (20, 40, -0.06, 0.06), (20, 40, -0.06, 0.06))
    bulge = to_units(0.6 * np.sin(np.pi * (records["s"] * 1e-4 - 20.0) / 20.0))
    records["d"] += (owner == 2) * bulge - (owner == 3) * bulge
    labels = split(records)
    assert share_together(labels, owner, 0) > 0.95 and share_together(labels, owner, 1) > 0.95
    assert np.bincount(labels[owner == 0]).argmax() != np.bincount(labels[owner == 1]).argmax()


def test_a_stop_line_alone_stays_whole():
    assert len(np.unique(split(paint((0, 0.5, 0.0, 3.2))[0]))) == 1


def test_a_zebra_crossing_is_not_cut_across_its_stripes():
    stripes = [(0, 4, d, d + 0.5) for d in np.arange(-4.0, 4.0, 0.9)]
    assert len(np.unique(split(paint(*stripes)[0]))) == 1


def test_a_long_line_that_drifts_across_the_road_stays_one():
    s = np.arange(0, 200, 0.02)
    records = np.zeros(len(s) * 4, ROAD_POINT)
    records["s"] = to_units(np.tile(s, 4))
    records["d"] = to_units(np.tile(2.0 * np.sin(s / 60), 4) + np.repeat([0.0, 0.04, 0.08, 0.12], len(s)))
    assert len(np.unique(split(records))) == 1


@pytest.mark.parametrize("figure", [
    ((0, 3.2, -0.08, 0.08), (3.2, 4.5, -0.5, 0.5)),                      # an arrow
    ((0, 4, 0.0, 0.2), (0, 4, 0.9, 1.1), (1.9, 2.1, 0.2, 0.9)),          # a letter
    ((0, 1.8, -0.08, 0.08), *((1.8 + k * 0.03, 1.83 + k * 0.03, -0.45 + k * 0.018, 0.45 - k * 0.018) for k in range(25))),  # a small arrow with a tip
    ((0, 3.6, -0.1, 0.1), (3.6, 4.0, -0.375, 0.375)),                    # a T
], ids=["arrow", "letter", "small arrow", "T"])
def test_figures_stay_whole(figure):
    assert len(np.unique(split(paint(*figure)[0]))) == 1


def test_the_order_of_the_points_does_not_matter():
    records, _ = paint((0, 30, 3.0, 3.15), (20.0, 20.4, 0.0, 3.0))
    shuffle = np.random.default_rng(1).permutation(len(records))
    assert np.array_equal(split(records[shuffle]), split(records)[shuffle])


def test_where_there_are_no_clusters_none_is_compound():
    assert len(are_compound(*np.zeros((2, 0), np.int32), np.empty(0, np.int64))) == 0
