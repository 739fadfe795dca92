"""Paint points become markings: how large, which of the lines, and what is none."""

import numpy as np
import pytest
import shapely
from clustered_marks import FRAME, classes, layer_of, markings_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.markings.objects.cluster import ClusterSettings
from painted_streets import assert_same_points, disc, drive, paint, road_points, shuffled, strip


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
    shape = markings_of([mark], seed=2).geometries[0]
    s, d = (axis.ravel() for axis in np.meshgrid(np.arange(9, 41, 0.02), np.arange(-2.2, -1.6, 0.01)))
    covered = shapely.contains_xy(shape, *FRAME.to_map(0, s, d))
    assert covered[mark(s, d)].mean() > 0.95
    assert mark(s, d)[covered].mean() > 0.95


@pytest.mark.parametrize("length", [4.0, 4.1, 4.3, 4.45])
def test_outlines_of_dashes_and_stop_lines_end_where_their_paint_ends_whatever_their_length(length):
    beyond = length + np.array([-0.08, 0.08])
    dash = markings_of([strip(15, 15 + length, 1.0, 1.15)]).geometries[0]
    np.testing.assert_array_equal(shapely.contains_xy(dash, *FRAME.to_map(0, 15 + beyond, np.full(2, 1.075))), [True, False])
    stop = markings_of([strip(20, 20.4, -2, -2 + length)]).geometries[0]
    np.testing.assert_array_equal(shapely.contains_xy(stop, *FRAME.to_map(0, np.full(2, 20.2), -2 + beyond)), [True, False])


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
    specks = [disc(s, 3.07, 0.06) for s in (20.6, 21.3, 22.0, 22.7)]
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


def test_specks_are_no_markings():
    specks = [disc(s, d, 0.15) for s, d in ((12, 1.0), (30, -2.0), (47, 0.3))]
    assert len(markings_of(specks)) == 0


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
