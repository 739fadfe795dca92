"""Markings that lie beside each other are found in order of station, as a table of all pairs would tell."""

import tracemalloc

import numpy as np
import pytest
from lanewright.core.common.arrays import overlapping_pairs
from lanewright.core.markings.objects import classify as classes
from lanewright.core.markings.objects.classify import classify_markings
from lanewright.core.markings.objects.repeating import give_way_blocks
from lanewright.core.markings.objects.shape import Shape
from lanewright.core.markings.objects.split_merge import join_fragments
from lanewright.core.markings.weights import CLASSES, GROUPS


def pieces(count, length, longest, seed=0):
    """dict of columns of markings strewn over a road."""
    random = np.random.default_rng(seed)
    s0, d0 = random.uniform(0, length, count), random.uniform(-4, 4, count).round(1)
    along, across = random.uniform(0.0, longest, count) * random.random(count), random.uniform(0.1, 0.8, count)
    return {"s0": s0, "s1": s0 + along, "d0": d0, "d1": d0 + across, "offset": d0 + across / 2, "length": along, "width": across,
            "elongation": along / across, "direction": random.normal(0.0, 0.1, count), "along": random.random(count) < 0.8}


@pytest.mark.parametrize("apart", [0.0, 3.0])
@pytest.mark.parametrize("counts", [(60, 90), (1, 5), (0, 4), (4, 0), (0, 0)])
def test_every_pair_that_meets_comes_once(apart, counts):
    one, other = (pieces(count, 50.0, 8.0, seed) for seed, count in enumerate(counts))
    # whole metres: many begin where others end
    bounds = [np.rint(column[name]) for column in (one, other) for name in ("s0", "s1")]
    found = np.column_stack(overlapping_pairs(*bounds, apart))
    s0, s1, t0, t1 = bounds
    expected = np.argwhere((s0[:, None] <= t1 + apart) & (s1[:, None] >= t0 - apart))
    np.testing.assert_array_equal(found, expected)


def partners_among_all(column, line):
    rows = np.flatnonzero(line)
    s0, s1, d = (column[name][rows] for name in ("s0", "s1", "offset"))
    overlap = np.minimum(s1[:, None], s1) - np.maximum(s0[:, None], s0)
    near = (np.abs(d[:, None] - d) <= CLASSES.max_double_line_spacing) & (overlap > 0.5 * (s1 - s0)[:, None])
    np.fill_diagonal(near, False)
    result = np.zeros(len(line), bool)
    result[rows] = near.any(axis=1)
    return result


@pytest.mark.parametrize("count", [0, 1, 2, 400])
def test_lines_of_a_double_line_are_those_among_all_pairs(count):
    column = pieces(count, 300.0, 30.0)
    line = column["along"]
    found = classes._has_partner(column, line)
    np.testing.assert_array_equal(found, partners_among_all(column, line))
    assert count < 400 or 0.1 < found[line].mean() < 0.9


def strips_beyond_lines_among_all(column, line, room):
    s0, s1, d, length = (column[name] for name in ("s0", "s1", "offset", "length"))
    short = column["along"] & (s1 - s0 > column["d1"] - column["d0"]) & (room < CLASSES.rim_clearance)
    found = np.zeros(len(line), bool)
    for k in np.flatnonzero(short):
        outward = np.sign(d[k]) * (d[k] - d)
        times = 1.0 if room[k] < column["width"][k] / 2 + CLASSES.edge_contact else CLASSES.edge_line_length_ratio
        reach = CLASSES.strip_reach_at_road_edge if room[k] < GROUPS.road_edge_clearance else CLASSES.strip_reach_beyond_edge_line
        beside = (outward > 0.1) & (outward < reach) & (np.minimum(s1, s1[k]) - np.maximum(s0, s0[k]) > 0)
        found[k] = (line & beside & (length > times * length[k])).any()
    return found


def test_strips_beyond_an_edge_line_are_those_among_all_pairs():
    column = pieces(500, 300.0, 20.0)
    line, room = column["along"] & (column["length"] > 2.0), 4.0 - np.abs(column["offset"])
    found = classes._beyond_the_edge_line(column, line, room)
    np.testing.assert_array_equal(found, strips_beyond_lines_among_all(column, line, room))
    assert 5 < found.sum() < (room < CLASSES.rim_clearance).sum()


def away(column, k):
    """(N,) m from the box of a marking to the box of each."""
    gaps = [np.maximum(column[low], column[low][k]) - np.minimum(column[high], column[high][k]) for low, high in (("s0", "s1"), ("d0", "d1"))]
    return np.max(gaps, axis=0)


def test_bars_of_hatching_and_their_outlines_are_those_among_all_pairs():
    column = pieces(300, 900.0, 8.0)
    kinds = np.where(np.arange(300) % 3 > 0, "hatch", "symbol")
    bars, symbols = kinds == "hatch", np.flatnonzero(kinds == "symbol")
    outlines = [k for k in symbols if (bars & (away(column, k) < CLASSES.max_bar_to_outline)).any()]
    np.testing.assert_array_equal(classes._outlines(column, kinds.tolist()), outlines)
    others = [bars & (away(column, k) < CLASSES.max_hatching_pitch) & (np.arange(300) != k) for k in range(300)]
    lone = [k for k in np.flatnonzero(bars) if not others[k].any() and (column["s1"] - column["s0"])[k] < CLASSES.min_hatching_length]
    np.testing.assert_array_equal(classes._single_bars(column, kinds.tolist()), lone)
    assert 5 < len(outlines) < len(symbols) and 5 < len(lone) < bars.sum()


def dash(s, d, width):
    return Shape(s0=s, s1=s + 3.0, d0=d, d1=d + width, offset=d + width / 2, length=3.0, width=width, direction=0.0, area=3.0 * width,
                 points=100, begin=d + width / 2, finish=d + width / 2, closed_area=3.0 * width, stems=(1.0, 1.0))


@pytest.mark.parametrize("width", [0.12, 0.5], ids=["dashes", "stripes"])
def test_memory_grows_with_the_number_of_dashes_and_not_with_its_square(width):
    shapes = [dash(12.0 * k, d, width) for k in range(5000) for d in (-3.5, -1.5, 1.5, 3.5)]
    tracemalloc.start()
    try:
        blocks = give_way_blocks(classes.filled(shapes), np.array([shape.sides for shape in shapes]),
                                 np.array([((shape.s0 + shape.s1) / 2, shape.offset) for shape in shapes]))
        found = classify_markings(shapes, np.full(len(shapes), 6.0), blocks=blocks)
        joined = join_fragments(shapes, 0.35)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(found) == len(np.unique(joined)) == 20_000
    assert peak < 5_000 * len(shapes)
