"""Two drives over one street whose positions drifted: laid on each other, and left alone where they agree."""

from dataclasses import replace

import numpy as np
import pytest
from heard import Heard
from lanewright.core.survey.adjustment.adjust import adjust_passes, solve_corrections
from lanewright.core.survey.adjustment.register import PassOffsets, Strips, pass_offsets
from scanned_streets import driven, scanned, survey_of

FLAT = ((-20.0, 0.0), (20.0, 0.0))


def twice(east=0.0, left=0.0, up=0.0, paint=lambda x, y: 0.0 * x, section_length=20.0, **scan):
    """A street driven twice, the second drive's points and track off by so many metres."""
    time, x = driven(8.0)
    drives = [(time, x, 0.0), (time + 100.0, x, left if np.isscalar(left) else 0.0)]
    clouds = [scanned(drive=drive[:2], pulses=pulses, clipped=8.0, noise=0.004, lost=0.1, seed=seed, **scan)
              for seed, (drive, pulses) in enumerate(zip(drives, (60_000.0, 57_000.0)))]
    rng = np.random.default_rng(3)
    painted = [3000.0 + 2000.0 * paint(cloud.x, cloud.y) + 200.0 * rng.standard_normal(len(cloud)) for cloud in clouds]
    second = clouds[1]
    beside = left if np.isscalar(left) else left(second.x)
    clouds[1] = replace(second, x=second.x + east, y=second.y + beside, z=second.z + up)
    survey = survey_of(*clouds, drives=drives, section_length=section_length)
    whole = records(survey)
    assert len(whole) == sum(map(len, clouds))
    # brightness as painted, whatever the helper gave: points are known by their time
    store = type(survey.store)(survey.store.dtype, section_length)
    whole["intensity"] = np.concatenate(painted)[np.argsort(np.concatenate([cloud.time for cloud in clouds]))]
    store.append(0, whole)
    survey.store = store
    return survey


def records(survey):
    """All points, by their time."""
    found = np.concatenate([np.asarray(survey.store.section(0, number)) for number in survey.store.sections(0)])
    return found[np.argsort(found["time"])]


def face_of(survey, number):
    """Offset of the left curb face in the points of one drive, metre by metre along the street."""
    points = records(survey)
    h = points["z"] * 1e-4 - (100.0 - survey.frame.origin[2])
    face = (points["pass_number"] == number) & (points["d"] > 20_000) & (points["d"] < 45_000) & (h > 0.04) & (h < 0.09)
    metre = np.floor(points["s"][face] * 1e-4 / 10.0).astype(int)
    known = np.bincount(metre) > 10
    return (np.bincount(metre, points["d"][face] * 1e-4) / np.maximum(np.bincount(metre), 1))[known]


@pytest.fixture(scope="module")
def laid_on_each_other():
    """Two drives 5 cm apart and 2 cm one above the other; the survey, what was heard, and where the tracks lay before."""
    survey, heard = twice(left=0.05, up=0.02), Heard()
    before = [p.d.mean() for p in survey.frame.passes]
    adjust_passes(survey, heard)
    return survey, heard, before


def test_two_drives_five_centimetres_apart_meet_in_their_middle(laid_on_each_other):
    survey, heard, _ = laid_on_each_other
    one, other = face_of(survey, 0), face_of(survey, 1)
    np.testing.assert_allclose(one, other, atol=0.006)
    np.testing.assert_allclose(np.r_[one, other], 3.525, atol=0.008)
    points = records(survey)
    road = (np.abs(points["d"]) < 20_000) & (points["s"] > 100_000) & (points["s"] < 700_000)
    heights = [np.median(points["z"][road & (points["pass_number"] == number)]) * 1e-4 for number in (0, 1)]
    assert heights[0] == pytest.approx(heights[1], abs=0.002)
    assert "5." in heard.said[0] or "4.9" in heard.said[0]
    assert not heard.warned


def test_a_track_goes_with_its_points(laid_on_each_other):
    survey, _, before = laid_on_each_other
    moved = [p.d.mean() - d for p, d in zip(survey.frame.passes, before)]
    np.testing.assert_allclose(moved, [0.025, -0.025], atol=0.006)
    half = np.array(survey.frame.pass_sigma[0].metres)
    np.testing.assert_allclose(half, 0.025, atol=0.010)
    assert half.mean() == pytest.approx(0.025, abs=0.004), "half of what two drives differ by is the sigma of their middle"


def test_drives_that_agree_stay_as_they_were_measured():
    survey, heard = twice(), Heard()
    store, frame = survey.store, survey.frame
    adjust_passes(survey, heard)
    assert survey.store is store and survey.frame is frame
    assert max(frame.pass_sigma[0].metres) < 0.010, "offsets are accepted as none below two centimetres"
    assert "stay as they were measured" in heard.said[0]


def test_drift_that_grows_along_the_street_is_followed():
    survey = twice(left=lambda x: 0.0006 * x)
    adjust_passes(survey)
    one, other = face_of(survey, 0), face_of(survey, 1)
    np.testing.assert_allclose(one, other, atol=0.012)


def test_stop_lines_tell_how_far_drives_lie_apart_along_the_street():
    survey = twice(east=0.06, paint=lambda x, y: (np.mod(x, 20.0) < 0.4) & (np.abs(y) < 3.0), section=FLAT)
    offsets, = pass_offsets(survey, 0)
    known = np.isfinite(offsets.along)
    assert known.sum() >= 4
    np.testing.assert_allclose(offsets.along[known], -0.06, atol=0.02)


@pytest.mark.parametrize(("east", "left"), [(0.12, 0.0), (0.0, 0.20)])
def test_oblique_bars_of_a_hatched_area_do_not_turn_an_offset_across_into_one_along(east, left):
    hatched = lambda x, y: (np.mod(x - 1.5 * y, 3.0) < 0.6) & (np.abs(y) < 1.2) | (np.abs(np.abs(y) - 2.8) < 0.08)  # noqa: E731
    survey = twice(east=east, left=left, paint=hatched, section=FLAT)
    offsets, = pass_offsets(survey, 0)
    for found, true in ((offsets.along, -east), (offsets.left, -left)):
        assert np.isfinite(found).sum() >= 4
        np.testing.assert_allclose(found[np.isfinite(found)], true, atol=0.015)


def test_where_a_drive_jumps_aside_before_a_hatched_area_its_bars_make_it_none_along():
    """Less than half of the road is driven apart, and half of that is hatched."""
    hatched = lambda x, y: (x > 60.0) & (np.mod(x - 1.5 * y, 3.0) < 0.6) & (np.abs(y) < 1.2) | (np.abs(np.abs(y) - 2.8) < 0.08)  # noqa: E731
    survey = twice(left=lambda x: np.where(x > 50.0, 0.16, 0.0), paint=hatched, section=FLAT)
    offsets, = pass_offsets(survey, 0)
    beyond = offsets.stations > 60.0
    np.testing.assert_allclose(offsets.left[beyond], -0.16, atol=0.015)
    assert np.isfinite(offsets.along[beyond]).any() and np.nanmax(np.abs(offsets.along)) < 0.02


def test_the_brightness_of_a_curb_face_is_no_paint_and_a_line_half_a_metre_beside_it_is():
    across = np.tile(np.arange(0.005, 6.0, 0.01), 20)
    along = np.repeat(np.arange(20) * 0.25 + 0.1, 600)
    height, light = np.where(across > 3.0, 0.12, 0.0), np.where(np.abs(across - 3.0) < 0.04, 9000.0, 3000.0) + np.where(
        np.abs(across - 2.5) < 0.06, 5000.0, 0.0) + 100.0 * np.random.default_rng(1).standard_normal(len(across))
    paint = Strips.of(across, along, height, light, (20, 300)).paint
    assert np.isnan(paint[:, 148:152]).all() and np.isfinite(paint[:, 100:140]).all() and np.isfinite(paint[:, 160:]).all()
    assert paint[:, 123:127].min() > 2.0


def test_a_bare_plain_tells_nothing_of_the_place():
    survey = twice(left=0.05, section=FLAT)
    offsets, = pass_offsets(survey, 0)
    assert np.isnan(offsets.left).all() and np.isnan(offsets.along).all()


def test_cobbles_fit_again_one_stone_farther_and_move_nothing():
    survey = twice(left=0.06, section=FLAT, paint=lambda x, y: np.mod(y, 0.12) < 0.06)
    offsets, = pass_offsets(survey, 0)
    assert np.isnan(offsets.left).all()


@pytest.mark.slow
def test_the_fit_does_not_depend_on_where_sections_are_cut(laid_on_each_other):
    other = twice(left=0.05, up=0.02, section_length=7.0)
    adjust_passes(other)
    np.testing.assert_array_equal(records(laid_on_each_other[0]), records(other))


def test_of_three_drives_each_is_moved_by_its_share():
    stations = np.arange(5.0, 200.0, 10.0)
    nothing = np.zeros(len(stations))
    offsets = [PassOffsets(*pair, stations, nothing, nothing + 0.03, nothing, nothing[:0]) for pair in ((0, 1), (1, 2))]
    moved = solve_corrections(offsets)
    for number, left in ((0, -0.03), (1, 0.0), (2, 0.03)):
        np.testing.assert_allclose(moved[number][1][1], left, atol=0.001)


def test_one_offset_out_of_line_moves_nothing_by_much():
    stations = np.arange(5.0, 200.0, 10.0)
    nothing = np.zeros(len(stations))
    left = nothing + 0.02
    left[9] = 0.28
    moved = solve_corrections([PassOffsets(0, 1, stations, nothing, left, nothing, nothing[:0])])
    np.testing.assert_allclose(moved[1][1][1] - moved[0][1][1], 0.02, atol=0.012)


def test_drives_with_heights_of_two_kinds_are_laid_on_each_other_and_said():
    survey, heard = twice(up=0.2), Heard()
    adjust_passes(survey, heard)
    assert min(survey.frame.pass_sigma[0].metres) >= 0.19
    assert sum("more than navigation drifts" in text for text in heard.warned) == 1


def test_drives_of_different_years_are_laid_on_each_other_and_said():
    survey, heard = twice(left=-1.0, paint=lambda x, y: np.abs(y) < 0.06), Heard()
    adjust_passes(survey, heard)
    one, other = face_of(survey, 0), face_of(survey, 1)
    np.testing.assert_allclose(one, other, atol=0.01)
    # either year may be the right one
    assert np.median(survey.frame.pass_sigma[0].metres) == pytest.approx(1.0, abs=0.02)
    assert sum("more than navigation drifts" in text for text in heard.warned) == 1
