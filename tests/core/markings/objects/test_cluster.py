"""Paint points become markings: how large, of what kind, and what is none."""

import numpy as np
import pytest
import shapely
import shapely.affinity
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import Features
from lanewright.core.common.schemas import MARKINGS
from lanewright.core.markings.objects.cluster import ClusterSettings, cluster_markings
from lanewright.core.markings.objects.marking_objects import markings_from_features, markings_to_features, with_kinds_of
from painted_streets import assert_same_points, disc, drive, paint, records_at, road_points, shuffled, strip

FRAME = drive()


def layer_of(points, frame):
    """The layer of the markings in some points, and the clustered points."""
    markings, clustered = cluster_markings(points, frame)
    return markings_to_features(markings, frame), clustered


def markings_of(marks, frame=FRAME, **kind):
    return layer_of(road_points(paint(frame, marks, **kind), frame), frame)[0]


def classes(markings):
    return sorted(markings.column("class"))


@pytest.mark.parametrize("width", [0.10, 0.15, 0.30])
@pytest.mark.parametrize("radius", [np.inf, 60.0])
def test_a_line_has_its_width_to_2_cm_and_its_length_to_5_cm_on_straights_and_bends(width, radius):
    frame = drive(radius=radius)
    markings = markings_of([strip(10, 50, 3.0, 3.0 + width)], frame)
    assert len(markings) == 1
    row = markings.rows[0]
    assert row["width_m"] == pytest.approx(width, abs=0.02)
    assert row["length_m"] == pytest.approx(40.0, abs=0.05)
    stretched = 1.0 if np.isinf(radius) else 1 - (3.0 + width / 2) / radius
    assert row["area_m2"] == pytest.approx(40.0 * width * stretched, rel=0.2 if width == 0.10 else 0.1)
    assert (row["use"], row["road"], row["cluster"]) == ("keep", 0, 1)


def test_the_outline_lies_on_the_road_at_the_height_of_its_points():
    markings = markings_of([strip(10, 50, 3.0, 3.15)])
    z = shapely.get_coordinates(markings.geometries[0], include_z=True)[:, 2]
    np.testing.assert_allclose(z, FRAME.origin[2] + 0.02 * 3.07, atol=0.01)


def test_the_outline_covers_the_paint_and_little_else():
    mark = strip(10, 40, -2.0, -1.85)
    shape = markings_of([mark]).geometries[0]
    s, d = (axis.ravel() for axis in np.meshgrid(np.arange(9, 41, 0.02), np.arange(-2.2, -1.6, 0.01)))
    covered = shapely.contains_xy(shape, *FRAME.to_map(0, s, d))
    assert covered[mark(s, d)].mean() > 0.95
    assert mark(s, d)[covered].mean() > 0.95


def test_the_two_lines_of_a_double_line_are_two_markings_and_centre_lines():
    markings = markings_of([strip(10, 50, 0.0, 0.12), strip(10, 50, 0.24, 0.36)])
    assert classes(markings) == ["centre", "centre"]


def test_a_line_near_the_road_edge_is_an_edge_line_and_a_dash_in_the_road_a_lane_line():
    assert classes(markings_of([strip(10, 50, 5.5, 5.65)])) == ["edge"]
    assert classes(markings_of([strip(10, 16, 0.5, 0.65)])) == ["lane"]


def test_dashes_stay_apart_and_a_worn_line_holds_together():
    dashes = [strip(s, s + 4, 0.5, 0.65) for s in (10, 18, 26)]
    assert len(markings_of(dashes)) == 3
    worn = [strip(s, s + 2.3, 0.5, 0.65) for s in np.arange(10, 40, 3.0)]  # 0.7 m worn off every 3 m
    markings = markings_of(worn)
    assert len(markings) == 1
    assert markings.rows[0]["length_m"] == pytest.approx(29.3, abs=0.1)


def test_specks_that_wear_has_left_lead_a_line_over_and_a_bare_gap_does_not():
    ends = [strip(10, 20, 3.0, 3.15), strip(23.5, 40, 3.0, 3.15)]
    specks = [disc(s, 3.07, 0.04) for s in (20.6, 21.3, 22.0, 22.7)]
    assert markings_of(ends + specks, density=2000).column("length_m") == pytest.approx([30.0], abs=0.05)
    assert markings_of(ends).column("length_m") == pytest.approx([10.0, 16.5], abs=0.05)


def test_a_stop_line_worn_through_is_one_and_the_blocks_of_a_give_way_line_are_not():
    worn = markings_of([strip(20, 20.3, *across) for across in ((-3.4, -2.2), (-2.0, -1.1), (-0.95, -0.2))])
    assert classes(worn) == ["stop"]
    assert worn.rows[0]["length_m"] == pytest.approx(3.2, abs=0.05)
    assert "stop" not in classes(markings_of([strip(20, 20.5, d, d + 0.5) for d in np.arange(-3.5, -0.5, 0.75)]))


def test_a_stripe_of_a_crossing_that_is_worn_through_is_one_and_the_dash_behind_it_is_another_marking():
    whole = [strip(20, 24, d, d + 0.45) for d in (-3.0, -2.0, 0.0, 1.0)]
    worn = [strip(20, 21.2, -1.0, -0.55), strip(21.8, 21.9, -0.9, -0.7), strip(22.5, 24, -1.0, -0.55)]
    markings = markings_of(whole + worn + [strip(24.8, 28, -0.85, -0.7)])
    assert classes(markings) == ["lane"] + ["zebra"] * 5
    assert [row["length_m"] for row in markings.rows if row["class"] == "zebra"] == pytest.approx([4.0] * 5, abs=0.05)


def test_dashes_shorter_than_a_line_must_be_are_a_line_where_they_stand_in_a_row():
    row = markings_of([strip(s, s + 0.95, 0.5, 0.62) for s in np.arange(10, 30, 1.95)])
    assert classes(row) == ["lane"] * 11 and set(row.column("use")) == {"keep"}
    alone = markings_of([strip(s, s + 0.95, d, d + 0.12) for s, d in ((10, 0.5), (14, -1.0), (19, 2.0), (25, -2.5))])
    assert set(alone.column("use")) == {"other"}


def test_the_stones_of_a_curb_in_a_row_are_no_line():
    assert "keep" not in markings_of([strip(s, s + 0.95, 5.7, 5.82) for s in np.arange(10, 30, 1.95)]).column("use")


def test_what_shines_at_the_foot_of_a_parked_car_is_no_marking_and_a_long_line_beside_a_wall_is_one():
    sides = [strip(20, 24.4, 2.0, 2.1), strip(20, 20.1, 2.0, 3.8), strip(24.3, 24.4, 2.0, 3.8)]
    records = paint(FRAME, [*sides, strip(10, 50, -3.0, -2.85), strip(20, 24.4, 0.0, 0.15)], density=4000)
    records["covered"] = (records["d"] > 15000) | (records["d"] < -20000)
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert sorted(markings.column("offset_m")) == pytest.approx([-2.92, 0.07], abs=0.03)


def test_a_zebra_crossing_keeps_its_stripes():
    stripes = [strip(20, 24, d, d + 0.45) for d in np.arange(-4.0, 4.0, 1.0)]
    markings = markings_of(stripes)
    assert classes(markings) == ["zebra"] * 8
    assert set(markings.column("use")) == {"other"}
    for area in markings.column("area_m2"):
        assert area == pytest.approx(4 * 0.45, rel=0.08)


@pytest.mark.parametrize("askew", [-30, -20, 12, 20, 30])
def test_a_zebra_crossing_askew_to_the_road_keeps_its_stripes(askew):
    c, n = np.cos(np.radians(askew)), np.sin(np.radians(askew))

    def stripe(k):
        return lambda s, d: (np.abs((s - 30) * c + d * n) < 1.5) & (np.abs(d * c - (s - 30) * n - k) < 0.25)

    markings = markings_of([stripe(k) for k in (-2, -1, 0, 1, 2)], density=2500)
    assert classes(markings) == ["zebra"] * 5
    assert markings.column("area_m2") == pytest.approx([1.5] * 5, rel=0.15)


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
    return painted


def letter(s0, d0):
    """An E of 2.4 m by 1 m."""
    return lambda s, d: np.any([strip(s0, s0 + 2.4, d0, d0 + 0.2)(s, d)]
                               + [strip(u, u + 0.3, d0, d0 + 1.0)(s, d) for u in (s0, s0 + 1.05, s0 + 2.1)], axis=0)


@pytest.mark.parametrize("way", [1, -1])
def test_an_arrow_has_a_shaft_and_a_letter_none(way):
    assert classes(markings_of([arrow(30, 1.5, way), letter(40, -2.0)], density=3000)) == ["arrow", "symbol"]


def test_an_arrow_of_6_m_keeps_its_shaft():
    def painted(s, d):
        u, across = s - 30, np.abs(d - 1.5)
        return (u >= 0) & (u < 3.6) & (across < 0.10) | (u >= 3.6) & (u < 6.0) & (across < 0.55 * (6.0 - u) / 2.4)
    assert classes(markings_of([painted], density=3000)) == ["arrow"]


def slanting(s0, d0, length=1.2, width=0.3):
    """A bar at 45 degrees to the road, to the left of its place."""
    return lambda s, d: (np.abs(s - s0 - (d - d0)) < width * np.sqrt(0.5)) & (d > d0) & (d < d0 + length * np.sqrt(0.5))


def test_bars_side_by_side_are_hatching_one_alone_is_not_and_at_the_edge_it_is_the_curb_of_a_corner():
    assert classes(markings_of([slanting(s, 0.5) for s in (20, 21.5, 23)], density=3000)) == ["hatch"] * 3
    assert classes(markings_of([slanting(20, 0.5)], density=3000)) == ["symbol"]
    assert len(markings_of([slanting(20, 5.5, 0.7)], density=3000)) == 0


def test_specks_are_no_markings():
    specks = [disc(s, d, 0.15) for s, d in ((12, 1.0), (30, -2.0), (47, 0.3))]
    assert len(markings_of(specks)) == 0


def test_a_line_that_every_scan_line_meets_once_is_a_line():
    rng = np.random.default_rng(4)
    s = np.arange(10.0, 30.0, 0.28)
    records = records_at(FRAME, s, rng.uniform(-3.15, -3.0, len(s)), np.full(len(s), 4000.0), 6.0)
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert set(classes(markings)) <= {"lane", "centre"}
    assert sum(markings.column("length_m")) > 15.0


def test_a_long_line_so_far_off_that_its_width_cannot_be_told_is_a_line():
    s = np.arange(5.0, 60.0, 0.1)
    records = records_at(FRAME, s, 5.5 + 0.02 * np.sin(7 * s), np.full(len(s), 4000.0), 6.0)
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert set(classes(markings)) == {"edge"}
    assert markings.rows[0]["width_m"] < 0.06


def test_bright_concrete_along_the_road_edge_is_no_marking():
    assert len(markings_of([strip(10, 60, 5.55, 6.0)])) == 0


def test_the_bright_top_of_a_curb_is_no_edge_line():
    inner = strip(5, 70, 3.6, 3.72)
    assert len(markings_of([strip(30, 60, 5.93, 6.0)])) == 0
    assert len(markings_of([inner, strip(30, 60, 5.93, 6.0)])) == 1
    assert len(markings_of([inner, strip(30, 36, 5.85, 6.0)])) == 1, "a parking strip lies between the two"
    assert len(markings_of([strip(30, 60, 5.88, 6.0)])) == 0, "it reaches the very edge"
    assert len(markings_of([strip(5, 70, 3.2, 3.32), strip(30, 60, 5.84, 6.0)])) == 1


def test_an_edge_line_beside_the_bright_hair_of_a_curb_is_no_double_line():
    assert classes(markings_of([strip(10, 30, 5.6, 5.75), strip(8, 40, 5.97, 6.0)], density=3000)) == ["edge"]


def with_values(marks, value):
    """Markings of paint at 4000 but for what `value(s, d)` says, in corrected intensities."""
    records = paint(FRAME, marks, density=3000)
    s, d = records["s"] * 1e-4, records["d"] * 1e-4
    records["corrected"] = value(s, d) * np.random.default_rng(3).normal(1.0, 0.05, len(s))
    points = road_points(records, FRAME)
    points.has_corrected = True
    return layer_of(points, FRAME)[0]


def test_a_seam_and_the_joint_of_a_bridge_that_are_far_paler_than_the_paint_about_are_no_markings():
    dashes = [strip(s, s + 3, -0.06, 0.06) for s in (10, 19, 28, 37, 46, 55)]
    seam, joint = strip(5, 65, 1.4, 1.5), strip(44, 44.25, -5.5, 5.5)
    found = with_values([*dashes, seam, joint], lambda s, d: np.where(np.any([dash(s, d) for dash in dashes], axis=0), 4000, 1900))
    assert classes(found) == ["lane"] * 6
    assert classes(with_values([seam], lambda s, d: np.full(len(s), 1900.0))) == ["centre"]


def test_a_pale_edge_line_beside_bright_dashes_is_one():
    """Wheels and gutters wear it most: it is paler than all paint about it, and yet no seam."""
    dashes = [strip(s, s + 3, -0.06, 0.06) for s in (10, 19, 28, 37, 46, 55)]
    edge = strip(5, 65, 5.3, 5.42)
    found = with_values([*dashes, edge], lambda s, d: np.where(np.any([dash(s, d) for dash in dashes], axis=0), 4000, 2300))
    assert sorted(set(classes(found))) == ["edge", "lane"]


def test_worn_paint_is_a_marking_beside_fresh_paint_since_what_is_left_of_it_is_bright():
    fresh, worn = strip(5, 65, 3.0, 3.15), strip(10, 60, -1.0, -0.85)

    def value(s, d):
        faint = worn(s, d) & (np.random.default_rng(5).random(len(s)) < 0.6)
        return np.where(faint, 1700, np.where(worn(s, d), 2800, 4000))

    assert classes(with_values([fresh, worn], value)) == ["centre", "centre"]


def test_an_edge_line_a_hand_from_the_edge_is_one():
    assert classes(markings_of([strip(10, 60, 5.65, 5.80)])) == ["edge"]


def test_a_strip_of_verge_outside_an_edge_line_is_no_marking():
    edge = strip(5, 70, 5.3, 5.42)
    assert classes(markings_of([edge, strip(30, 36, 5.75, 5.95)])) == ["edge"]
    assert len(markings_of([strip(30, 36, 5.75, 5.95)])) == 1, "alone it may be the edge line itself"


def test_neither_the_order_of_points_nor_the_length_of_sections_matters():
    marks = [strip(5, 70, 3.0, 3.15), strip(38, 42, 0, 0.45), strip(38, 42, 1, 1.45), strip(38, 42, -1, -0.55)]
    records = paint(FRAME, marks)
    plain, points = layer_of(road_points(records, FRAME), FRAME)
    other, others = layer_of(road_points(shuffled(records), FRAME, section_length=7.0), FRAME)
    assert plain.rows == other.rows
    assert all(a.equals_exact(b, 0.0) for a, b in zip(plain.geometries, other.geometries))
    assert_same_points(points.all_points().records, others.all_points().records)


def test_500_km_to_the_east_the_markings_are_the_same():
    marks = [strip(5, 60, 3.0, 3.15), strip(30, 30.4, -3, 0)]
    here = markings_of(marks)
    there = markings_of(marks, drive(east=1_000_000.0))
    for a, b in zip(here.geometries, there.geometries):
        moved = shapely.transform(a, lambda xyz: xyz + np.array([500_000.0, 0.0, 0.0]), include_z=True)
        assert moved.equals_exact(b, 1e-6)
    assert here.rows == [dict(row, area_m2=pytest.approx(row["area_m2"])) for row in there.rows]


def test_where_there_is_no_paint_there_are_no_markings():
    points = road_points(paint(FRAME, [strip(10, 20, 0, 0.15)])[:0], FRAME)
    markings, clustered = layer_of(points, FRAME)
    assert len(markings) == 0 and len(clustered) == 0


@pytest.mark.parametrize("wrong", [dict(distance=0.0), dict(distance=5.0), dict(min_points=0)])
def test_settings_without_sense_are_refused(wrong):
    with pytest.raises(RoadExtractionError):
        ClusterSettings(**wrong)


def askew(s0, d0, length, width, turn=0.75):
    """A stroke from s0, d0 on, turned to the left of the road."""
    def painted(s, d):
        along, across = (s - s0) * np.cos(turn) + (d - d0) * np.sin(turn), (d - d0) * np.cos(turn) - (s - s0) * np.sin(turn)
        return (along >= 0) & (along < length) & (np.abs(across) < width / 2)
    return painted


def test_a_short_dash_askew_to_the_road_is_no_manhole_cover():
    assert len(markings_of([askew(20, 1, 0.7, 0.15)])) == 1
    assert len(markings_of([disc(20, 1, 0.7)])) == 0


def test_the_outline_of_hatching_across_the_road_is_hatching_and_no_stop_line():
    outline = [strip(20, 20.15, -3, 0), strip(20.15, 20.6, -3, -2.8)]
    bar = askew(20.3, 0.2, 1.6, 0.3)
    assert classes(markings_of(outline + [bar])) == ["hatch", "hatch"]
    assert "stop" not in classes(markings_of(outline))
    assert classes(markings_of([strip(20, 20.4, -3, 0)])) == ["stop"]


def test_a_layer_of_markings_that_is_read_again_gives_the_same_objects_and_with_other_names_the_same_polygons():
    askew_crossing = [lambda s, d, k=k: (np.abs((s - 30) * 0.87 + d * 0.5) < 1.5) & (np.abs(d * 0.87 - (s - 30) * 0.5 - k) < 0.25)
                      for k in (-1, 0, 1)]
    points = road_points(paint(FRAME, [strip(5, 20, 3.0, 3.15), *askew_crossing], density=2500), FRAME)
    objects, _ = cluster_markings(points, FRAME)
    layer = markings_to_features(objects, FRAME)
    again = markings_from_features(layer, FRAME)
    for name in ("road", "cluster", "kind", "keep", "length", "extent"):
        np.testing.assert_array_equal(getattr(again, name), getattr(objects, name))
    np.testing.assert_allclose(again.outlines.vertices, objects.outlines.vertices, rtol=0, atol=1e-8)
    renamed = with_kinds_of(layer, again.with_kinds(np.where(again.kind == "zebra", "hatch", again.kind)))
    assert "zebra" in classes(layer) and classes(renamed) == sorted(name.replace("zebra", "hatch") for name in classes(layer))
    assert renamed.geometries == layer.geometries


def test_a_layer_drawn_by_hand_without_fields_or_with_an_empty_polygon_is_read():
    pole = shapely.box(*np.r_[FRAME.to_map(0, 10.0, 1.0), FRAME.to_map(0, 12.0, 1.2)].tolist())
    drawn = Features("PolygonZ", MARKINGS, [pole, None, shapely.union_all([pole, shapely.affinity.translate(pole, 5.0)])], [{}, {}, {}])
    found = markings_from_features(drawn, FRAME)
    assert found.road.tolist() == [-1] * 3 and not found.keep.any()
    shapes = found.outlines.polygons(FRAME.origin)
    assert [shape.area for shape in shapes] == pytest.approx([pole.area, 0.0, 2 * pole.area])


def sparse(records, across=0.20, along=0.13):
    """The records that a scanner far off would leave: tracks 20 cm apart across the road, a point every 13 cm on each."""
    on_track = (records["d"] * 1e-4 / across % 1.0 < 0.06) & (records["s"] * 1e-4 / along % 1.0 < 0.15)
    records = records[on_track]
    records["spacing"] = int(across * 1000)
    return records


def bars(count, turn=1.0):
    """Bars of hatching, 1 m by 3 m and 2.5 m apart, askew to the road."""
    def on(s, d):
        phase = s + turn * (d - 2.0) - 20.0
        return (d >= 2.0) & (d < 5.0) & (phase % 2.5 < 1.0) & (phase >= 0) & (phase < 2.5 * count)
    return on


def test_hatching_far_off_keeps_its_bars():
    records = sparse(paint(FRAME, [bars(6)], density=20000))
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert classes(markings) == ["hatch"] * 6
    assert sum(markings.column("area_m2")) == pytest.approx(6 * 3.0, rel=0.3)


def test_a_broad_line_far_off_is_one_line_as_wide_as_it_is():
    # the line leaves the tracks slowly, as every road does, so that each shows it at another place of its width
    def line(s, d):
        return (s >= 10) & (s < 70) & (d >= 3.0 + 0.02 * s) & (d < 3.3 + 0.02 * s)

    markings, _ = layer_of(road_points(sparse(paint(FRAME, [line], density=20000)), FRAME), FRAME)
    longest = max(markings.rows, key=lambda row: row["length_m"])
    assert longest["length_m"] == pytest.approx(60.0, abs=3.0)
    assert longest["width_m"] == pytest.approx(0.30, abs=0.08)
    assert longest["area_m2"] > 0.95 * sum(markings.column("area_m2"))


def test_points_as_far_apart_that_were_scanned_densely_are_not_joined():
    records = sparse(paint(FRAME, [bars(6)], density=20000))
    records["spacing"] = 0
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert "hatch" not in classes(markings)


def blocks(count, pitch=1.0, side=0.5, s0=30.0, d0=-3.0):
    """Squares in a row across the road, as before a roundabout."""
    return [strip(s0, s0 + side, d0 + k * pitch, d0 + k * pitch + side) for k in range(count)]


@pytest.mark.parametrize("count", [3, 5])
def test_a_row_of_equal_squares_across_the_road_is_a_give_way_line(count):
    assert classes(markings_of(blocks(count), density=2500)) == ["give_way"] * count


@pytest.mark.parametrize("marks", [
    blocks(1), blocks(2), [*blocks(2), *blocks(1, d0=1.5)], [*blocks(1), *blocks(1, side=0.8, d0=-2.0), *blocks(1, side=0.35, d0=-1.0)],
], ids=["one", "two", "uneven pitch", "uneven size"])
def test_squares_that_make_no_row_are_covers(marks):
    assert len(markings_of(marks, density=2500)) == 0


def test_a_give_way_line_beside_a_manhole_cover_does_not_make_it_paint():
    markings = markings_of([*blocks(4), disc(36, 0.0, 0.6)], density=2500)
    assert classes(markings) == ["give_way"] * 4


def test_the_bright_face_of_a_curb_far_off_is_no_edge_line():
    face = paint(FRAME, [strip(10, 70, 5.93, 6.0)], density=20000, reach=6.0)
    face = face[face["s"] * 1e-4 / 0.13 % 1.0 < 0.15]
    # two tracks of the scan meet it in turns
    face["d"] -= np.where(face["s"] * 1e-4 % 8.0 < 4.0, 0, 800).astype(np.int32)
    face["spacing"] = 200
    markings, _ = layer_of(road_points(face, FRAME), FRAME)
    assert len(markings) == 0
