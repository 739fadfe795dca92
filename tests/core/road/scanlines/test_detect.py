"""Boundaries from normalized scanlines on streets whose curbs are known."""

import curbed_streets as streets
import numpy as np
import pytest
from curbed_streets import GROUND, NORTH, driven, parked_car, street, survey_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.road.scanlines.candidates import ScanlineBoundarySettings
from lanewright.core.road.scanlines.detect import SurveyScanlines
from lanewright.core.road.scanlines.section_planes import ScanlineSettings
from road_layers import curbs_from_scanlines, fit_road_edges


def found(points, settings=ScanlineBoundarySettings(), interval=0.10, **survey):
    return curbs_from_scanlines(SurveyScanlines(survey_of(points, **survey), ScanlineSettings(interval=interval)), settings)


def corners(features, side, part="bottom", status="measured"):
    """(N, 5) x, y about the street's start, z, station and curb height."""
    rows = [(g.x - streets.EAST, g.y - NORTH, g.z - GROUND, r["station_m"], r.get("height_m") or 0.0) for g, r in features
            if r["side"] == side and r["part"] == part and r["status"] == status]
    return np.array(rows).reshape(-1, 5)


def as_rows(features):
    return [(g.x, g.y, g.z, *sorted(r.items())) for g, r in features]


@pytest.mark.parametrize("curb", [0.04, 0.20])
def test_without_noise_the_corners_are_right_to_the_millimetre(curb):
    curbs = found(street(curb=curb, noise=0.0))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        bottoms, tops = corners(curbs, side), corners(curbs, side, "top")
        assert bottoms[:, 3].min() < 1.0 and bottoms[:, 3].max() > streets.LENGTH - 1.0
        np.testing.assert_allclose(bottoms[:, 1:3], [(offset, -0.07)] * len(bottoms), atol=0.001)
        np.testing.assert_allclose(tops[:, 1:3], [(offset, curb - 0.07)] * len(tops), atol=0.001)
        np.testing.assert_allclose(bottoms[:, 4], curb, atol=0.0015)


def test_noise_moves_the_corners_by_less_than_itself():
    curbs = found(street(noise=0.004))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        bottoms = corners(curbs, side)
        assert len(bottoms) > 25
        assert np.sqrt(np.mean((bottoms[:, 1] - offset) ** 2)) < 0.004
        assert np.sqrt(np.mean((bottoms[:, 2] + 0.07) ** 2)) < 0.004


def test_a_leaning_face_has_its_bottom_before_its_top():
    curbs = found(street(curb=0.16, face=0.06, noise=0.001))
    np.testing.assert_allclose(corners(curbs, "left")[:, 1], 3.5, atol=0.003)
    np.testing.assert_allclose(corners(curbs, "left", "top")[:, 1], 3.56, atol=0.003)


def test_a_bevelled_curb_is_found_unless_an_upright_face_is_asked_for():
    bevelled = street(curb=0.10, face=0.10)
    assert len(found(bevelled, ScanlineBoundarySettings(vertical_angle=60.0))) == 0
    curbs = found(bevelled, ScanlineBoundarySettings(vertical_angle=40.0))
    np.testing.assert_allclose(corners(curbs, "left")[:, 1], 3.5, atol=0.005)
    np.testing.assert_allclose(corners(curbs, "left", "top")[1:-1, 1], 3.6, atol=0.005)


def test_in_a_gutter_the_corner_lies_at_its_bottom():
    x, y, z, time = street(curb=0.12, camber=0.0, noise=0.001)
    gutter = (y > 3.1) & (z < 0.06) & (y < 3.5)
    z[gutter] -= 0.04 * (y[gutter] - 3.1) / 0.4
    # the face goes down to the bottom of the gutter
    rng = np.random.default_rng(5)
    s = rng.uniform(-2, 62, 6000)
    x, y, z, time = (np.r_[a, b] for a, b in zip((x, y, z, time), (s, np.full(6000, 3.5), rng.uniform(-0.04, 0.0, 6000),
                                                                   1000 + np.clip(s, 0, 60) / 10)))
    bottoms = corners(found((x, y, z, time)), "left")
    np.testing.assert_allclose(bottoms[:, 1], 3.5, atol=0.005)
    np.testing.assert_allclose(bottoms[:, 2], -0.04, atol=0.005)


@pytest.mark.parametrize("ground", [dict(curb=0.0), dict(curb=0.12, face=0.5), dict(curb=0.015)], ids=["level", "ramp", "seam"])
def test_where_there_is_no_curb_none_is_invented(ground):
    assert len(found(street(**ground))) == 0


def test_a_rough_verge_is_not_a_curb():
    rng = np.random.default_rng(8)
    x, y, z, time = street(curb=0.0)
    verge = np.abs(y) > 3.0
    z[verge] += rng.uniform(0.0, 0.12, verge.sum())
    assert len(found((x, y, z, time))) == 0


def test_a_bend_is_followed():
    radius = 40.0
    curbs = found(street(radius=radius), drive=driven(radius=radius))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        bottoms = corners(curbs, side)
        np.testing.assert_allclose(np.hypot(bottoms[:, 0], bottoms[:, 1] - radius), radius - offset, atol=0.01)


def test_the_order_of_points_and_sections_of_the_store_change_nothing():
    points = parked_car(street(), start=25.0)
    assert as_rows(found(points)) == as_rows(found(points, shuffled=1, section_length=7.0))


def test_driven_backwards_the_sides_swap_and_the_corners_stay():
    x, y, z, time = street(left=4.5, right=3.0)
    there = found((x, y, z, time))
    back = found((x, y, z, 1006 - (time - 1000)), drive=driven(backwards=True))
    for side, other, offset in (("left", "right", 4.5), ("right", "left", -3.0)):
        np.testing.assert_allclose(corners(there, side)[:, 1], offset, atol=0.004)
        np.testing.assert_allclose(corners(back, other)[:, 1], offset, atol=0.004)


# -- the five cases in which the paper's own results failed ---------------------------------------------------------------

def test_a_parked_car_hides_the_curb_and_its_foot_is_none():
    curbs = found(parked_car(street(), start=25.0))
    bottoms, hidden = corners(curbs, "left"), corners(curbs, "left", status="occluded")
    np.testing.assert_allclose(bottoms[:, 1], 3.5, atol=0.02)
    assert not ((bottoms[:, 0] > 25.5) & (bottoms[:, 0] < 29.0)).any()
    assert hidden[:, 3].min() < 26.5 and hidden[:, 3].max() > 28.0


def test_a_car_that_drives_alongside_leaves_the_curb_open_or_bridged_and_is_not_drawn():
    points = parked_car(street(left=6.0), start=10.0, length=30.0, near=2.0, far=4.6)
    x, y, z, time = points
    surveyed = survey_of((x, y, z, time))
    edges = fit_road_edges(curbs_from_scanlines(SurveyScanlines(surveyed)), surveyed.frame)
    for line, row in edges:
        offsets = np.abs(np.array(line.coords)[:, 1] - NORTH)
        if row["side"] == "left":
            np.testing.assert_allclose(offsets, 6.0, atol=0.03)
            assert row["status"] == "bridged" or row["end_m"] < 12.0 or row["station_m"] > 38.0


def test_what_a_turn_leaves_unseen_is_left_open():
    x, y, z, time = street()
    seen = (y < 2.8) | (x < 20.0) | (x > 40.0)
    bottoms = corners(found(tuple(a[seen] for a in (x, y, z, time))), "left")
    np.testing.assert_allclose(bottoms[:, 1], 3.5, atol=0.01)
    assert not ((bottoms[:, 0] > 20.5) & (bottoms[:, 0] < 39.5)).any()


def test_a_step_of_four_centimetres_is_found_and_one_of_two_is_not():
    bottoms = corners(found(street(curb=0.04, noise=0.002)), "left")
    assert len(bottoms) > 25
    np.testing.assert_allclose(bottoms[:, 4], 0.04, atol=0.006)
    assert len(found(street(curb=0.02, noise=0.002))) == 0


def test_steps_of_private_land_do_not_draw_the_boundary_off_the_curb():
    rng = np.random.default_rng(11)
    x, y, z, time = street(left=4.0, behind=4.0)
    # planters: short steps nearer the road than the curb, and porches behind it
    for start in (12.0, 30.0, 47.0):
        on = (x > start) & (x < start + 0.8) & (y > 3.0 + rng.uniform(0, 0.3)) & (y < 3.6)
        z[on] += 0.25
        porch = (x > start + 4) & (x < start + 8) & (y > 5.5)
        z[porch] += 0.15
    bottoms = corners(found((x, y, z, time)), "left")
    np.testing.assert_allclose(bottoms[:, 1], 4.0, atol=0.02)
    assert len(np.unique(np.floor(bottoms[:, 0] / 4))) >= 14


def test_the_back_of_the_sidewalk_does_not_stand_in_for_a_curb_that_opens():
    bottoms = corners(found(street(open_left=[(25.0, 31.0)], wall=(5.5, 0.15))), "left")
    np.testing.assert_allclose(bottoms[:, 1], 3.5, atol=0.02)


def test_two_passes_that_drifted_apart_give_one_curb_between_them():
    points, again, drive = street(), street(seed=4), driven()
    shifted = again[0], again[1] + 0.04, again[2] + 0.03, again[3] + 100
    second = drive[0] + 100, drive[1], drive[2] + 0.04, drive[3] + 0.03
    both = corners(found(points, drive=drive, second=(shifted, second)), "left")
    assert len(both) == len(corners(found(points), "left"))
    np.testing.assert_allclose(both[:, 1], 3.52, atol=0.01)


@pytest.mark.parametrize("wrong, word", [
    (dict(search_width=0.0), "search width"), (dict(min_height=-0.01), "minimum height"), (dict(clipping_height=0.02), "clipping height"),
    (dict(clipping_height=0.2, min_height=0.3), "above the minimum"), (dict(distance_across=0.0), "across"),
    (dict(distance_along=9.0), "along"), (dict(ransac_distance=0.0), "RANSAC"), (dict(vertical_angle=95.0), "vertical angle"),
    (dict(horizontal_angle=45.0, vertical_angle=40.0), "above the horizontal"), (dict(sensor_height=-1.0), "sensor height"),
    (dict(max_gap=-1.0), "gap"),
])
def test_settings_that_make_no_sense_are_refused(wrong, word):
    with pytest.raises(RoadExtractionError, match=word):
        ScanlineBoundarySettings(**wrong)
