"""Curbs on streets whose curbs are known."""

from functools import cache

import curbed_streets as streets
import numpy as np
import pytest
from curbed_streets import driven, measured, parked_car, ringed_street, street, survey_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.common.curb_points import CurbPoints
from lanewright.core.road.common.side_curbs import block_bounds
from lanewright.core.road.edges.fit import fit_road_edges
from lanewright.core.road.profiles import detect
from lanewright.core.road.weights import CURBS
from road_layers import detect_curbs


def found(points, settings=CurbSettings(), **survey):
    return detect_curbs(survey_of(points, **survey), settings)


@cache
def found_on(**ground):
    """Curbs of a street as it is, for several tests."""
    return found(street(**ground))


def as_rows(features):
    return [(g.x, g.y, g.z, *sorted(r.items())) for g, r in features]


@pytest.mark.parametrize("curb", [0.06, 0.20])
def test_both_curbs_are_found_to_a_centimetre(curb):
    curbs = found_on(curb=curb)
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        assert points[:, 3].min() < 1.0 and points[:, 3].max() > streets.LENGTH - 1.0
        np.testing.assert_allclose(points[:, 1], offset, atol=0.01)
        np.testing.assert_allclose(points[:, 2], -0.07, atol=0.01)
        np.testing.assert_allclose(points[:, 4], curb, atol=0.015)


def test_the_bottom_of_a_leaning_face_is_found_and_not_its_middle():
    points = measured(found(street(curb=0.16, face=0.06)), "left")
    assert len(points) > 20
    np.testing.assert_allclose(points[:, 1], 3.5, atol=0.015)


def test_a_granite_curb_sloped_by_45_degrees_is_found_along_its_bottom():
    curbs = found(street(curb=0.10, face=0.10))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        assert points[:, 3].min() < 1.5 and points[:, 3].max() > streets.LENGTH - 1.5
        np.testing.assert_allclose(points[:, 1], offset, atol=0.03)


def test_a_slope_that_the_user_asks_for_is_kept():
    assert len(found(street(curb=0.10, face=0.10), CurbSettings(slope=60.0))) == 0


def test_without_times_a_curb_whose_face_looks_away_from_a_scanner_on_the_sidewalk_is_found_beneath_the_edge_of_its_top():
    cloud = street()
    hidden = (cloud[1] > 3.4) & (cloud[1] < 3.51)
    survey = survey_of(tuple(column[~hidden] for column in cloud))
    assert not len(measured(detect_curbs(survey), "left"))   # from the road every face is seen
    survey.has_time = False
    curbs = detect_curbs(survey)
    points = measured(curbs, "left")
    assert points[:, 3].min() < 1.5 and points[:, 3].max() > streets.LENGTH - 1.5
    np.testing.assert_allclose(points[:, 1], 3.5, atol=0.04)
    # its foot is a guess, that of a curb which is seen is none
    left, right = ([row["sigma_m"] or 0.0 for _, row in curbs if (row["side"], row["status"]) == (side, "measured")] for side in ("left", "right"))
    assert np.mean(np.array(left) > 0.04) > 0.9 and np.mean(np.array(right) > 0.04) < 0.1
    edges = fit_road_edges(CurbPoints.from_features(curbs, survey.frame), survey.frame)
    assert edges.sigma[edges.side == "left"].min() > 0.04 > 0.01 > edges.sigma[edges.side == "right"].max()


def test_a_curb_lower_than_five_centimetres_is_found_where_it_continues():
    curbs = found(street(curb=0.03))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        assert points[:, 3].min() < 1.5 and points[:, 3].max() > streets.LENGTH - 1.5
        np.testing.assert_allclose(points[:, 1], offset, atol=0.03)
    assert len(found(street(curb=0.04), CurbSettings(min_height=0.05))) == 0


def test_a_road_with_nothing_but_noise_has_no_curb():
    assert len(found(street(length=24.0, curb=0.0, noise=0.020), drive=driven(24.0))) == 0


@pytest.mark.parametrize("ground", [dict(curb=0.12, face=0.5), dict(curb=0.01)], ids=["ramp", "seam"])
def test_where_there_is_no_curb_none_is_invented(ground):
    assert len(found(street(**ground))) == 0


@pytest.mark.slow
def test_a_rough_verge_is_not_a_curb():
    rng = np.random.default_rng(8)
    x, y, z, time = street(length=24.0, curb=0.0)
    verge = np.abs(y) > 3.0
    z[verge] += rng.uniform(0.0, 0.12, verge.sum())
    assert len(found((x, y, z, time), drive=driven(24.0))) == 0


def test_ghosts_below_the_road_do_not_matter():
    rng = np.random.default_rng(9)
    x, y, z, time = street()
    clean = measured(found_on(), "left")
    some = rng.random(len(x)) < 0.003
    ghosts = x[some], y[some], z[some] - rng.uniform(0.1, 1.0, some.sum()), time[some]
    points = measured(found(tuple(np.r_[a, b] for a, b in zip((x, y, z, time), ghosts))), "left")
    assert len(points) == len(clean)
    np.testing.assert_allclose(points[:, 1], 3.5, atol=0.01)


@pytest.mark.slow
def test_a_scanner_with_two_centimetres_of_noise_finds_the_curb_and_nothing_else():
    curbs = found(street(length=28.0, curb=0.12, noise=0.02, lines=0.03), drive=driven(28.0))
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        assert len(points) > 12
        np.testing.assert_allclose(points[:, 1], offset, atol=0.03)


@pytest.mark.slow
def test_a_low_curb_among_the_rings_of_a_spinning_scanner_is_found_and_nothing_else():
    curbs = found(ringed_street(), drive=driven(36.0))
    for side, offset in (("left", 4.5), ("right", -4.5)):
        points = measured(curbs, side)
        assert len(np.unique(np.floor(points[(points[:, 3] > 2) & (points[:, 3] < 34), 3] / 2))) >= 14
        np.testing.assert_allclose(points[:, 1], offset, atol=0.06)
        np.testing.assert_allclose(np.median(points[:, 4]), 0.08, atol=0.015)


@pytest.mark.slow
def test_a_curb_with_plants_right_behind_it_is_found_by_a_spinning_scanner():
    curbs = found(ringed_street(curb=0.10, bed=0.6), drive=driven(36.0))
    points = measured(curbs, "left")
    points = points[(points[:, 3] > 2) & (points[:, 3] < 34)]
    assert len(np.unique(np.floor(points[:, 3] / 2))) >= 14
    np.testing.assert_allclose(points[:, 1], 4.5, atol=0.08)


@pytest.mark.slow
@pytest.mark.parametrize("ground", [dict(curb=0.02), dict(curb=0.10, ramp=0.8), dict(curb=0.0, bed=0.35)],
                         ids=["seam", "ramp", "bank"])
def test_rings_of_a_spinning_scanner_are_no_curbs(ground):
    assert len(found(ringed_street(length=24.0, **ground), drive=driven(24.0))) == 0


def test_where_few_profiles_are_noisy_they_alone_are_averaged_as_in_averages_of_all(monkeypatch):
    """Ground that scatters in two places, as where plants grow."""
    x, y, z, time = street(length=24.0)
    rough = ((x > 6) & (x < 8)) | (x > 22)
    z = z + np.random.default_rng(2).normal(0.0, 0.02, len(z)) * rough
    by_noise, averages, asked, sections = detect._steps_by_noise, detect.find_averaged_steps, [], []

    def averaged(lines, *limits):
        asked.append((len(lines.low), limits))
        return averages(lines, *limits)

    def noted(lines, section, *others):
        sections.append((lines, section, by_noise(lines, section, *others)))
        return sections[-1][2]

    monkeypatch.setattr(detect, "find_averaged_steps", averaged)
    monkeypatch.setattr(detect, "_steps_by_noise", noted)
    found((x, y, z, time), drive=driven(24.0))
    assert 0 < sum(rows for rows, _ in asked) < 0.6 * sum(len(lines.low) for lines, *_ in sections)
    for lines, section, steps in sections[:2]:
        part = lines.part(*section)
        noisy = section[0] + np.flatnonzero(part.spread > CURBS.noisy_share * CurbSettings().limits.clear_height)
        of_all = averages(lines, *asked[0][1])
        of_all, of_noisy = (steps[np.isin(steps.profile, noisy)] for steps in (of_all, steps))
        for name in ("profile", "u", "h", "height", "skew", "support", "noise"):
            np.testing.assert_array_equal(getattr(of_noisy, name), getattr(of_all, name), err_msg=name)


def test_a_bend_is_followed_with_shorter_blocks():
    radius = 40.0
    surveyed = survey_of(street(radius=radius), drive=streets.driven(radius=radius))
    curbs = detect_curbs(surveyed)
    for side, offset in (("left", 3.5), ("right", -3.5)):
        points = measured(curbs, side)
        distance = np.hypot(points[:, 0], points[:, 1] - radius)
        np.testing.assert_allclose(distance, radius - offset, atol=0.015)
    straight = survey_of(street()).frame.road(0)
    assert np.diff(block_bounds(straight, 0, 60, 0.0)).max() == 2.0
    assert np.diff(block_bounds(surveyed.frame.road(0), 0, 60, 0.0)).max() < 1.0
    assert np.diff(block_bounds(straight, 0, 60, 1.5)) == pytest.approx(1.5)


def test_a_parked_car_hides_the_curb_and_its_foot_is_none():
    curbs = found(parked_car(street(), start=25.0))
    points = measured(curbs, "left")
    np.testing.assert_allclose(points[:, 1], 3.5, atol=0.02)
    assert not ((points[:, 0] > 25.5) & (points[:, 0] < 29.0)).any()
    hidden = [r["station_m"] for r in curbs.rows if r["status"] == "occluded"]
    assert min(hidden) < 26.5 and max(hidden) > 28.0


def test_an_open_driveway_is_not_hidden():
    curbs = found(street(open_left=[(25.0, 31.0)]))
    assert all(r["status"] == "measured" for r in curbs.rows)
    points = measured(curbs, "left")
    assert len(points) and not ((points[:, 0] > 25.5) & (points[:, 0] < 30.5)).any()


def test_the_back_of_the_sidewalk_does_not_stand_in_for_a_curb_that_opens():
    points = measured(found(street(open_left=[(25.0, 31.0)], wall=(5.5, 0.15))), "left")
    np.testing.assert_allclose(points[:, 1], 3.5, atol=0.05)


def test_an_island_between_two_passes_is_not_the_edge_of_the_road():
    x, y, z, time = street(left=9.0, right=3.5)
    island = (y > 2.2) & (y < 3.2)
    z[island] += 0.15
    there, back = streets.driven(), streets.driven(offset=5.5, start=1100.0, backwards=True)
    cloud = x, y, z, 1000 + np.clip(x, 0, 60) / 10
    again = x, y, z, 1106 - np.clip(x, 0, 60) / 10
    curbs = detect_curbs(survey_of(cloud, there, second=(again, back)))
    np.testing.assert_allclose(measured(curbs, "left")[:, 1], 9.0, atol=0.02)
    np.testing.assert_allclose(measured(curbs, "right")[:, 1], -3.5, atol=0.02)


def test_two_passes_that_drifted_apart_give_one_curb_between_them():
    points = street()
    again = street(seed=4)
    shifted = again[0], again[1] + 0.04, again[2] + 0.03, again[3] + 100
    drive = streets.driven()
    second = drive[0] + 100, drive[1], drive[2] + 0.04, drive[3] + 0.03
    curbs = detect_curbs(survey_of(points, drive, second=(shifted, second)))
    alone = measured(found_on(), "left")
    both = measured(curbs, "left")
    assert len(both) == len(alone)
    np.testing.assert_allclose(both[:, 1], 3.52, atol=0.015)


def test_mirroring_the_street_mirrors_the_curbs():
    x, y, z, time = street(left=4.5, right=3.0)
    plain, mirrored = found_on(left=4.5, right=3.0), found((x, -y, z, time))
    for side, other in (("left", "right"), ("right", "left")):
        a, b = measured(plain, side), measured(mirrored, other)
        assert len(a) == len(b)
        np.testing.assert_allclose(a[:, :3] * [1, -1, 1], b[:, :3], atol=0.005)


def test_the_order_of_points_and_sections_of_the_store_change_nothing():
    points = parked_car(street(), start=25.0)
    assert as_rows(found(points)) == as_rows(found(points, shuffled=1, section_length=7.0))


def test_500_km_further_east_the_curbs_are_500_km_further_east():
    here, there = found_on(), found(street(), east=streets.EAST + 500_000)
    assert len(here) == len(there) > 0
    np.testing.assert_allclose([g.x + 500_000 for g, _ in here], [g.x for g, _ in there], atol=1e-3)
    assert [r["side"] for r in here.rows] == [r["side"] for r in there.rows]


def test_driven_backwards_the_sides_swap_and_the_curbs_stay():
    x, y, z, time = street(left=4.5, right=3.0)
    there = found_on(left=4.5, right=3.0)
    back = found((x, y, z, 1006 - (time - 1000)), drive=streets.driven(backwards=True))
    for side, other, offset in (("left", "right", 4.5), ("right", "left", -3.0)):
        a, b = measured(there, side), measured(back, other)
        np.testing.assert_allclose(a[:, 1], offset, atol=0.01)
        np.testing.assert_allclose(b[:, 1], offset, atol=0.01)


@pytest.mark.parametrize("wrong, word", [
    (dict(profile_width=0.0), "profile width"), (dict(min_height=0.4), "minimum"), (dict(slope=95.0), "slope"),
    (dict(point_spacing=0.5), "point spacing"), (dict(layer_jump=0.0), "layer jump"), (dict(block_length=0.1), "block length"),
])
def test_settings_that_make_no_sense_are_refused(wrong, word):
    with pytest.raises(RoadExtractionError, match=word):
        CurbSettings(**wrong)
