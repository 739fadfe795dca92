"""Where the road about the track is level beyond doubt, and what may be left out there."""

import numpy as np
import pytest
from curbed_streets import driven, survey_of
from lanewright.core.road.common.decimation import LevelStrip, PointDecimation
from lanewright.core.road.common.occlusion import OcclusionGrid
from lanewright.core.road.detect_boundaries import BoundarySettings, find_curb_points
from lanewright.core.road.scanlines.detect import SurveyScanlines
from lanewright.core.survey.store.records import COORDINATE_SCALE
from road_layers import curbs_from_scanlines
from scanned_streets import scanned
from scanned_streets import survey_of as survey_of_scan

WIDTH, SPACING = 0.25, 0.025
LEFT, RIGHT, ACROSS, ALONG = 3.2, 2.6, 0.7, 0.9


def crowded(height=0.03, noise=0.003, strays=0, skew=0.0, seed=5):
    """(x, y, z, time) of 8 m of a road with a camber between two curbs; `skew` is m outward per m along of the left one."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(8.0, 16.0, 160_000), rng.uniform(-4.0, 4.0, 160_000)
    z = np.where((y > LEFT + skew * (x - 12.0)) | (y < -RIGHT), height, 0.0) - 0.02 * np.abs(y)
    z += rng.normal(0.0, noise, len(z))
    z[rng.choice(len(z), strays, replace=False)] += 0.4
    return x, y, z, 1000.0 + x / 10


def strip(points, profiles=(38, 58), **survey):
    """The LevelStrip of 5 m in the middle, and its offsets in metres."""
    found = PointDecimation(survey_of(points, driven(20.0), **survey), WIDTH, SPACING).level_strip(0, 0, profiles, ACROSS, ALONG)
    return found, found.low * COORDINATE_SCALE, found.high * COORDINATE_SCALE


def test_a_point_lies_in_the_strip_where_its_own_profile_is_level_so_far_out():
    level = LevelStrip(40, WIDTH, np.array([-20_000, -5_000, 1 << 28], np.int32), np.array([10_000, 30_000, -1 << 28], np.int32), np.zeros(3))
    s, d = (np.array(metres) for metres in ([9.0, 10.1, 10.1, 10.2, 10.3, 10.4, 10.4, 10.6, 12.0], [0.5, 0.9, 1.1, -1.9, -1.9, 2.9, 3.1, 0.0, 0.0]))
    # before the first profile and after the last one these are meant
    expected = [True, True, False, True, False, True, False, False, False]
    np.testing.assert_array_equal(level.contains(*(np.rint(v / COORDINATE_SCALE).astype(np.int32) for v in (s, d))), expected)


@pytest.mark.parametrize("height", [0.03, 0.12])
def test_the_level_strip_keeps_its_distance_from_both_curbs(height):
    _, low, high = strip(crowded(height))
    assert (high < LEFT - ACROSS + 0.01).all() and (low > -RIGHT + ACROSS - 0.01).all()
    assert (high > LEFT - ACROSS - 0.2).all() and (low < -RIGHT + ACROSS + 0.2).all()


def test_a_low_curb_that_runs_oblique_ends_the_strip():
    _, low, high = strip(crowded(0.03, skew=1.0), profiles=(44, 54))
    stations = (np.arange(44, 54) + 0.5) * WIDTH
    there = high > low
    assert (high[there] < LEFT + (stations - 12.0 - ALONG)[there] - ACROSS + 0.15).all()


def test_birds_and_ghosts_do_not_end_it():
    _, low, high = strip(crowded(strays=100))
    _, clear_low, clear_high = strip(crowded())
    assert np.mean(high - low > clear_high - clear_low - 0.2) > 0.9


@pytest.mark.parametrize("noise", [0.02, 0.04])
def test_to_a_noisy_scanner_no_ground_is_level_beyond_doubt(noise):
    found, low, high = strip(crowded(noise=noise))
    assert (low > high).all()
    assert not found.contains(np.array([100_000, 120_000], np.int32), np.array([0, 0], np.int32)).any()


def test_profiles_so_long_that_a_curb_may_look_like_a_slope_tell_of_no_strip():
    found = PointDecimation(survey_of(crowded(), driven(20.0)), 0.5, SPACING).level_strip(0, 0, (20, 28), ACROSS, ALONG)
    assert (found.low > found.high).all()


def test_where_nothing_was_scanned_there_is_none():
    _, low, high = strip(crowded(), profiles=(400, 420))
    assert (low > high).all()


def test_the_strip_does_not_depend_on_sections_on_the_order_of_points_or_on_the_stretch_asked_for():
    whole, _, _ = strip(crowded(strays=50))
    for other, _, _ in (strip(crowded(strays=50), section_length=1.7), strip(crowded(strays=50), shuffled=2),
                        strip(crowded(strays=50), profiles=(43, 51))):
        own = slice(other.first - whole.first, other.first - whole.first + len(other.low))
        np.testing.assert_array_equal(other.low, whole.low[own])
        np.testing.assert_array_equal(other.high, whole.high[own])


def test_points_are_held_profile_by_profile():
    found, low, high = strip(crowded())
    found.high[:10] -= 5000
    s = np.sort(np.random.default_rng(1).uniform(9.5, 14.5, 2000))
    d = np.random.default_rng(2).uniform(-3.0, 3.0, 2000)
    profile = np.floor(s / WIDTH).astype(int) - found.first
    expected = (d > found.low[profile] * COORDINATE_SCALE) & (d < found.high[profile] * COORDINATE_SCALE)
    clear = np.abs(s / WIDTH - np.rint(s / WIDTH)) > 0.01
    held = found.contains(np.rint(s / COORDINATE_SCALE).astype(np.int32), np.rint(d / COORDINATE_SCALE).astype(np.int32))
    np.testing.assert_array_equal(held[clear], expected[clear])


@pytest.mark.slow
def test_corners_are_the_same_to_a_millimetre_with_the_level_strip_left_out():
    survey = survey_of_scan(scanned(pulses=400_000.0, noise=0.002))
    whole = curbs_from_scanlines(SurveyScanlines(survey))
    left_out = find_curb_points(survey, BoundarySettings(method="scanlines"))["scanlines"].to_features(survey.frame)
    places = []
    for found in (whole, left_out):
        places.append(np.array([(r["side"] == "left", r["part"] == "top", r["station_m"], r["offset_m"], g.z) for g, r in found
                                if r["status"] == "measured" and r["kind"] == "main"]))
    assert len(places[0]) > 60
    np.testing.assert_allclose(places[1], places[0], atol=0.001)


def test_most_of_a_dense_street_is_left_out():
    survey, seen = survey_of_scan(scanned(pulses=400_000.0, noise=0.002)), []

    def level(road, number, start, end):
        seen.append(decimation.level_strip(road, number, (int(start / WIDTH), int(end / WIDTH)), ACROSS, ALONG))
        return seen[-1]

    decimation = PointDecimation(survey, WIDTH, SPACING)
    SurveyScanlines(survey, level=level).runs(0, 20.0, 30.0)
    width = np.concatenate([(found.high - found.low) * COORDINATE_SCALE for found in seen])
    assert np.median(width) > 4.0


def test_level_ground_that_was_left_out_is_not_called_hidden():
    s = np.arange(2.0, 8.0, 0.5)
    occlusion = OcclusionGrid(WIDTH, 0, 40, 20.0)
    occlusion.tall[:, 4] = True  # a row of posts 1 m from the track
    ends = np.zeros(40), np.full(40, 3.0), np.full(40, -0.02)
    assert occlusion.hidden(s, np.full(len(s), 2.5), np.zeros(len(s)), np.zeros(len(s))).all()
    occlusion.add_level_ground((0, 40), *ends)
    assert not occlusion.hidden(s, np.full(len(s), 2.5), np.zeros(len(s)), np.zeros(len(s))).any()
    assert occlusion.hidden(s, np.full(len(s), 4.5), np.zeros(len(s)), np.zeros(len(s))).all()
