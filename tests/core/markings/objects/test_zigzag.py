"""Zigzag lines are told from all other lines, whether flat and broken as in the United Kingdom or steep as in Germany."""

import numpy as np
import pytest
from clustered_marks import FRAME, classes, layer_of, markings_of
from painted_streets import between, paint, road_points, strip


def zigzag(s0, s1, d0, run, depth, width=0.12, gap=0.0):
    """Legs `run` long along the road, `depth` across it from offset d0 on."""
    def painted(s, d):
        middle = d0 + depth * np.abs((s - s0) / run % 2 - 1)
        stroke = np.abs(d - middle) < width / 2 * np.hypot(1, depth / run)
        return stroke & (s > s0) & (s < s1) & ((s - s0) % run >= gap)
    return between(s0, s1, painted)


GERMAN = dict(run=1.5, depth=1.5)                            # 45 degrees, RMS part 2
BRITISH = dict(run=2.129, depth=0.289, width=0.10, gap=0.15)   # marks of 2 m, Traffic Signs Manual chapter 5


@pytest.mark.parametrize("kind", [GERMAN, dict(run=1.0, depth=1.0), dict(run=2.0, depth=2.0), BRITISH], ids=["1.5 m", "1 m", "2 m", "British"])
@pytest.mark.parametrize("length", [6.9, 17.0])
@pytest.mark.parametrize("side", [2.0, -4.5], ids=["left", "right"])
def test_a_zigzag_line_is_one(kind, length, side):
    markings = markings_of([zigzag(20, 20 + length, side, **kind)], density=2500)
    assert classes(markings) == ["zigzag"]
    assert set(markings.column("use")) == {"other"}
    assert markings.rows[0]["area_m2"] == pytest.approx(kind.get("width", 0.12) * length * np.hypot(1, kind["depth"] / kind["run"]), rel=0.55)


@pytest.mark.parametrize("kind", [GERMAN, BRITISH], ids=["German", "British"])
def test_a_zigzag_line_is_one_where_scan_lines_lie_apart(kind):
    records = paint(FRAME, [zigzag(20, 31, 1.0, **kind)], density=6000)
    records = records[(records["s"] + 0.5 * records["d"]) * 1e-4 / 0.12 % 1.0 < 0.15]
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert set(classes(markings)) == {"zigzag"} and set(markings.column("cluster")) == {1}


def test_the_edge_line_beside_a_zigzag_line_stays_one():
    markings = markings_of([strip(5, 60, 4.5, 4.65), zigzag(20, 32, 2.0, **GERMAN)], density=2500)
    assert classes(markings) == ["edge", "zigzag"]


def winding(s, d):
    """A line that swings 0.5 m to and fro every 10 m, as an untidy painter's."""
    return (np.abs(d - 0.25 * np.sin(2 * np.pi * s / 10)) < 0.06) & (s > 10) & (s < 60)


def taper(s, d):
    """An edge line that goes out and comes back once, as along a bay."""
    return (np.abs(d - np.interp(s, [10, 20, 30, 40], [1.0, 3.0, 3.0, 1.0])) < 0.08) & (s > 10) & (s < 40)


def chevrons(s, d):
    """Hatching of bars that meet in a point."""
    return ((s - np.abs(d)) % 2.0 < 0.5) & (np.abs(d) < 1.0) & (s > 20) & (s < 34)


def teeth(s, d):
    """Filled triangles in a row along the road."""
    return (d > 1.0) & (d < 1.0 + np.abs((s - 20) % 2 - 1)) & (s > 20) & (s < 30)


def in_turns(s, d):
    """Dashes of two lines in turns."""
    return (np.abs(d - np.where(s % 6 < 3, 0.0, 0.35)) < 0.06) & (s % 3 < 2.6) & (s > 10) & (s < 40)


@pytest.mark.parametrize("mark", [between(10, 60, winding), between(10, 40, taper), between(20, 34, chevrons), between(20, 30, teeth),
                                  between(10, 40, in_turns), zigzag(20, 22.6, 1.0, 1.5, 1.5)],
                         ids=["winding", "taper", "chevrons", "teeth", "dashes in turns", "two legs"])
@pytest.mark.parametrize("density", [1200, 4000])
def test_what_turns_otherwise_is_no_zigzag_line(mark, density):
    assert "zigzag" not in classes(markings_of([mark], density=density))
