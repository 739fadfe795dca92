"""What a marking is by its shape: crossings, stop and give-way lines, arrows, letters, hatching, and covers, which are none."""

import numpy as np
import pytest
from clustered_marks import FRAME, classes, layer_of, markings_of
from painted_streets import between, disc, oblique_bar, paint, painted_by, road_points, strip


def test_a_zebra_crossing_keeps_its_stripes():
    stripes = [strip(20, 24, d, d + 0.45) for d in np.arange(-4.0, 4.0, 1.0)]
    markings = markings_of(stripes)
    assert classes(markings) == ["zebra"] * 8
    assert set(markings.column("use")) == {"other"}
    for area in markings.column("area_m2"):
        assert area == pytest.approx(4 * 0.45, rel=0.08)


@pytest.mark.parametrize("oblique", [-30, -20, 12, 20, 30])
def test_a_zebra_crossing_oblique_to_the_road_keeps_its_stripes(oblique):
    markings = markings_of([oblique_bar(oblique, k, 3.0, 0.5) for k in (-2, -1, 0, 1, 2)], density=2500)
    assert classes(markings) == ["zebra"] * 5
    assert markings.column("area_m2") == pytest.approx([1.5] * 5, rel=0.15)


@pytest.mark.parametrize("way", [90, 70, 55, -60], ids=lambda way: f"{way} degrees")
def test_the_zebra_crossing_of_a_side_street_points_along_that_street(way):
    markings = markings_of([oblique_bar(way, k, 3.2, 0.5) for k in (-2.4, -1.2, 0, 1.2, 2.4)], density=2500)
    assert classes(markings) == ["zebra"] * 5
    assert markings.column("area_m2") == pytest.approx([1.6] * 5, rel=0.15)


def test_bars_of_hatching_along_the_road_are_no_zebra_crossing():
    markings = markings_of([oblique(s, -1.0, 2.2, 0.4, turn=np.radians(60)) for s in np.arange(20, 32, 1.3)], density=2500)
    assert len(markings) > 5 and "zebra" not in classes(markings)


def test_a_stop_line_is_a_stop_line_also_where_it_is_narrow():
    for depth in (0.30, 0.50):
        markings = markings_of([strip(20, 20 + depth, -3.5, -0.2)])
        assert classes(markings) == ["stop"]
        assert markings.rows[0]["use"] == "other"
        assert markings.rows[0]["width_m"] == pytest.approx(depth, abs=0.03)


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
@pytest.mark.parametrize("apart", [0.0, 0.23], ids=["dense", "scan lines 0.23 m apart"])
def test_a_stop_line_and_the_dash_that_touches_it_are_what_they_are(side, apart):
    near, far = sorted((0.15 * side, 3.2 * side))
    records = paint(FRAME, [strip(20, 20.4, near, far), strip(20.4, 24.4, *sorted((-0.02 * side, 0.13 * side)))], density=4000)
    if apart:
        records = records[(records["s"] + records["d"]) * 1e-4 / apart % 1.0 < 0.15]
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert classes(markings) == ["lane", "stop"]


@pytest.mark.parametrize("diameter", [0.40, 0.60, 0.90])
def test_a_manhole_cover_is_no_marking(diameter):
    points = road_points(paint(FRAME, [disc(30, 1.5, diameter), strip(10, 20, 0.0, 0.15)]), FRAME)
    markings, clustered = layer_of(points, FRAME)
    assert len(markings) == 1
    found = clustered.all_points()
    assert (found.cluster[found.s > 25] == 0).all() and (found.cluster[found.s < 25] == 1).all()


def test_a_manhole_cover_is_none_where_scan_lines_lie_apart():
    records = paint(FRAME, [disc(30, 1.5, 0.60), strip(10, 20, 0.0, 0.15)], density=6000)
    records = records[records["s"] * 1e-4 / 0.125 % 1.0 < 0.2]
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert classes(markings) == ["lane"]


def test_a_manhole_cover_beside_a_line_leaves_the_line_a_line():
    markings = markings_of([strip(10, 30, 0.0, 0.15), disc(20, 0.40, 0.60)], density=2500)
    assert classes(markings) == ["centre"]
    assert markings.rows[0]["width_m"] == pytest.approx(0.15, abs=0.03)


def arrow(s0, d0, way=1):
    """A straight arrow of 5 m, its shaft 0.15 m and its head 0.9 m broad."""
    def painted(s, d):
        u, across = (s - s0) * way, np.abs(d - d0)
        return (u >= 0) & (u < 3.2) & (across < 0.075) | (u >= 3.2) & (u < 5.0) & (across < 0.45 * (5.0 - u) / 1.8)
    return between(s0 - 5.0, s0 + 5.0, painted)


def letter(s0, d0):
    """An E of 2.4 m by 1 m."""
    bars = [strip(s0, s0 + 2.4, d0, d0 + 0.2), *(strip(u, u + 0.3, d0, d0 + 1.0) for u in (s0, s0 + 1.05, s0 + 2.1))]
    return between(s0, s0 + 2.4, lambda s, d: painted_by(bars, s, d))


@pytest.mark.parametrize("way", [1, -1])
def test_an_arrow_has_a_shaft_and_a_letter_none(way):
    assert classes(markings_of([arrow(30, 1.5, way), letter(40, -2.0)], density=3000)) == ["arrow", "symbol"]


def test_an_arrow_of_6_m_keeps_its_shaft():
    def painted(s, d):
        u, across = s - 30, np.abs(d - 1.5)
        return (u >= 0) & (u < 3.6) & (across < 0.10) | (u >= 3.6) & (u < 6.0) & (across < 0.55 * (6.0 - u) / 2.4)
    assert classes(markings_of([between(30, 36, painted)], density=3000)) == ["arrow"]


def slanting(s0, d0, length=1.2, width=0.3):
    """A bar at 45 degrees to the road, to the left of its place."""
    return between(s0 - width, s0 + length + width,
                   lambda s, d: (np.abs(s - s0 - (d - d0)) < width * np.sqrt(0.5)) & (d > d0) & (d < d0 + length * np.sqrt(0.5)))


def test_bars_side_by_side_are_hatching_one_alone_is_not_and_at_the_edge_it_is_the_curb_of_a_corner():
    assert classes(markings_of([slanting(s, 0.5) for s in (20, 21.5, 23)], density=3000)) == ["hatch"] * 3
    assert classes(markings_of([slanting(20, 0.5)], density=3000)) == ["symbol"]
    assert len(markings_of([slanting(20, 5.5, 0.7)], density=3000)) == 0


def oblique(s0, d0, length, width, turn=0.75):
    """A stroke from s0, d0 on, turned to the left of the road."""
    def painted(s, d):
        along, across = (s - s0) * np.cos(turn) + (d - d0) * np.sin(turn), (d - d0) * np.cos(turn) - (s - s0) * np.sin(turn)
        return (along >= 0) & (along < length) & (np.abs(across) < width / 2)
    return painted


def test_a_short_dash_oblique_to_the_road_is_no_manhole_cover():
    assert len(markings_of([oblique(20, 1, 0.7, 0.15)])) == 1
    assert len(markings_of([disc(20, 1, 0.7)])) == 0


def test_the_outline_of_hatching_across_the_road_is_hatching_and_no_stop_line():
    outline = [strip(20, 20.15, -3, 0), strip(20.15, 20.6, -3, -2.8)]
    bar = oblique(20.3, 0.2, 1.6, 0.3)
    assert classes(markings_of(outline + [bar])) == ["hatch", "hatch"]
    assert "stop" not in classes(markings_of(outline))
    assert classes(markings_of([strip(20, 20.4, -3, 0)])) == ["stop"]


def blocks(count, pitch=1.0, side=0.5, s0=30.0, d0=-3.0):
    """Squares in a row across the road, as before a roundabout."""
    return [strip(s0, s0 + side, d0 + k * pitch, d0 + k * pitch + side) for k in range(count)]


@pytest.mark.parametrize("count", [3, 5])
def test_a_row_of_equal_squares_across_the_road_is_a_give_way_line(count):
    assert classes(markings_of(blocks(count), density=2500)) == ["give_way"] * count


@pytest.mark.parametrize("oblique", [20, 35, -60], ids=lambda way: f"{way} degrees")
def test_a_give_way_line_may_lie_oblique_to_the_road(oblique):
    blocks_across = [oblique_bar(oblique, k, 0.5, 0.5) for k in (-1.7, -0.85, 0, 0.85, 1.7)]
    assert classes(markings_of(blocks_across, density=2500)) == ["give_way"] * 5


@pytest.mark.parametrize("marks", [
    blocks(1), blocks(2), [*blocks(2), *blocks(1, d0=1.5)], [*blocks(1), *blocks(1, side=0.8, d0=-2.0), *blocks(1, side=0.35, d0=-1.0)],
], ids=["one", "two", "uneven pitch", "uneven size"])
def test_squares_that_make_no_row_are_covers(marks):
    assert len(markings_of(marks, density=2500)) == 0


def test_a_give_way_line_beside_a_manhole_cover_does_not_make_it_paint():
    markings = markings_of([*blocks(4), disc(36, 0.0, 0.6)], density=2500)
    assert classes(markings) == ["give_way"] * 4
