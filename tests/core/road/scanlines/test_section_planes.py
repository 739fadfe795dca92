"""Normalized scanlines of streets of known section."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.road.scanlines.grid import Scanlines
from lanewright.core.road.scanlines.section_planes import ScanlineSettings, all_scanlines, point_scanlines, scanlines_of
from lanewright.core.survey.lattice.scan_lattice import find_lattice
from scanned_streets import CURB, driven, scanned, survey_of


def street_height(d):
    """Height of the street's section above the road."""
    return np.where(np.abs(d) > 3.5, CURB, 0.0)


def on_street(survey, road=0, **settings):
    return Scanlines.join(all_scanlines(survey, road, ScanlineSettings(**settings)))


def heights(survey, lines):
    """Heights of vertices above the road."""
    return lines.z + survey.frame.origin[2] - 100.0


def same_lines(a, b):
    np.testing.assert_array_equal(a.first, b.first)
    for name in ("station", "d", "z", "intensity"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), atol=1e-6, rtol=1e-6)


def complete(lines, interval=0.10, first=15.0, last=45.0, half=6.0):
    """Share of the planes that one line crosses from curb to curb and beyond."""
    wide = (lines.d[lines.first[:-1]] < -half) & (lines.d[lines.first[1:] - 1] > half)
    planes = np.unique(np.rint(lines.station[wide] / interval))
    return np.mean(np.isin(np.arange(round(first / interval), round(last / interval)), planes))


@pytest.mark.parametrize("case", [dict(), dict(yaw=0.0), dict(yaw=-45.0, rotation=-100.0), dict(wander=0.01, rounded=1e-6)],
                         ids=["yawed", "straight across", "the other way", "wandering"])
def test_scanlines_lie_on_the_street(case):
    survey = survey_of(scanned(**case))
    lines = on_street(survey)
    d, h = lines.d, heights(survey, lines)
    # between the last point of a face and the first above it lies a straight piece, as long as points are apart
    off_face = np.abs(np.abs(d) - 3.5) > 0.10
    np.testing.assert_allclose(h[off_face], street_height(d[off_face]), atol=2e-4)
    assert ((h > -2e-4) & (h < CURB + 2e-4)).all()
    stations = np.unique(np.rint(lines.station / 0.10).astype(int))
    middle = stations[(stations > 150) & (stations < 450)]
    np.testing.assert_array_equal(middle, np.arange(151, 450))


def test_a_scanline_crosses_the_whole_street_in_one_piece():
    survey = survey_of(scanned())
    lines = scanlines_of(survey, 0, 30.0, 32.0)
    assert len(lines) == 20
    np.testing.assert_allclose(lines.station, np.arange(300, 320) * 0.10)
    for first, last in zip(lines.first[:-1], lines.first[1:]):
        assert lines.d[first] < -7.0 and lines.d[last - 1] > 7.0
        assert (np.diff(lines.d[first:last]) >= 0).all()


def test_intensity_is_carried_along():
    survey = survey_of(scanned())
    lines = scanlines_of(survey, 0, 30.0, 32.0)
    np.testing.assert_allclose(lines.intensity, 3000 + 100 * lines.d, atol=2.0)


def test_where_a_window_ends_changes_no_scanline():
    cloud = scanned(wander=0.01, noise=0.005, lost=0.1)
    survey = survey_of(cloud)
    lattice = find_lattice(survey)
    whole = scanlines_of(survey, 0, 20.0, 40.0, lattice=lattice)
    parts = [scanlines_of(survey, 0, a, b, lattice=lattice) for a, b in ((20.0, 21.3), (21.3, 33.0), (33.0, 33.05), (33.05, 40.0))]
    same_lines(whole, Scanlines.join(parts))
    same_lines(whole, scanlines_of(survey_of(cloud, section_length=60.0), 0, 20.0, 40.0, lattice=lattice))


def test_lost_points_and_noise_part_no_scanline():
    survey = survey_of(scanned(lost=0.10, noise=0.005, wander=0.01, rounded=1e-6))
    lines = on_street(survey)
    assert complete(lines) > 0.98
    road = np.abs(lines.d) < 3.3
    assert np.sqrt(np.mean(heights(survey, lines)[road] ** 2)) < 0.005


@pytest.mark.parametrize("kept", [2, 4, 8])
def test_of_fewer_lines_every_plane_has_its_scanline_still(kept):
    cloud = scanned()
    survey = survey_of(cloud[cloud.line % kept == 0])
    lines = on_street(survey)
    assert complete(lines) == 1.0
    away = np.abs(np.abs(lines.d) - 3.5) > 0.10
    np.testing.assert_allclose(heights(survey, lines)[away], street_height(lines.d[away]), atol=5e-4)


@pytest.mark.parametrize("speed", [3.0, 25.0])
def test_speed_changes_nothing(speed):
    drive = driven(seconds=60.0 / speed, speed=speed)
    survey = survey_of(scanned(drive=drive), drive=drive)
    lines = on_street(survey)
    assert complete(lines) == 1.0
    away = np.abs(np.abs(lines.d) - 3.5) > 0.10
    np.testing.assert_allclose(heights(survey, lines)[away], street_height(lines.d[away]), atol=5e-4)


def test_a_vehicle_that_waits_draws_every_scanline_once():
    drive = driven(waits=[(3.0, 4.0)])
    survey = survey_of(scanned(drive=drive, noise=0.003), drive=drive)
    lines = on_street(survey)
    assert complete(lines) > 0.98
    onward = lines[lines.station >= 0]
    vertices = np.bincount(np.rint(onward.station / 0.10).astype(int), np.diff(onward.first))
    # where it stood, at station 30, no more vertices than elsewhere
    assert vertices[280:320].max() < 1.5 * np.median(vertices[150:450])


CAR = ((-20.0, CURB), (-3.5, CURB), (-3.5, 0.0), (1.5, 0.0), (1.5, 1.4), (2.8, 1.4), (2.8, 0.0), (3.5, 0.0), (3.5, CURB), (20.0, CURB))


def test_no_scanline_leaps_from_a_car_to_what_lies_behind():
    survey = survey_of(scanned(section=CAR, noise=0.002))
    lines = on_street(survey)
    h = heights(survey, lines)
    behind, car = lines.d > 4.0, (np.abs(lines.d - 2.15) < 0.7) & (h > 0.2)
    assert behind.any() and car.any()
    line = lines.line_of_vertex()
    assert not set(line[behind]) & set(line[car])
    # the shadow of its roof ends 6.06 m out, and nothing is drawn in it
    hidden = (lines.d > 3.0) & (lines.d < 6.0)
    assert not hidden.any()


def bent(radius):
    """Where a street that bends left from its beginning lies."""
    return lambda x, y: ((radius - y) * np.sin(x / radius), radius - (radius - y) * np.cos(x / radius))


def test_in_a_sharp_bend_scanlines_do_not_cross_within_the_road():
    survey = survey_of(scanned(clipped=14.0), place=bent(20.0))
    lines = on_street(survey)
    assert complete(lines, half=5.0) == 1.0
    x, y = survey.frame.road(0).to_map(np.repeat(lines.station, np.diff(lines.first)), lines.d)
    x, y = x + survey.frame.origin[0] - 1000.0, y + survey.frame.origin[1] - 2000.0
    inside = (x > 2.0) & (lines.station[lines.line_of_vertex()] < 55.0)
    across = 20.0 - np.hypot(x, y - 20.0)
    away = inside & (np.abs(np.abs(across) - 3.5) > 0.10)
    np.testing.assert_allclose(heights(survey, lines)[away], street_height(across[away]), atol=3e-3)
    # towards the centre the stations stay in order, and all of a line lies on this side of it
    assert lines.d.max() < 18.0
    turned = np.unwrap(np.arctan2(x, 20.0 - y))
    first = np.repeat(turned[lines.first[:-1]], np.diff(lines.first))
    np.testing.assert_allclose(((turned - first + np.pi) % (2 * np.pi) - np.pi)[inside], 0.0, atol=0.02)


def test_passes_and_scanners_are_kept_apart():
    time, x = driven()
    back = time + 100.0, x[::-1]
    survey = survey_of(scanned(), scanned(drive=back, yaw=-45.0, seed=8), drives=[(time, x), back])
    lines = scanlines_of(survey, 0, 30.0, 31.0)
    np.testing.assert_array_equal(lines.station, np.repeat(np.arange(300, 310) * 0.10, 2))
    np.testing.assert_array_equal(lines.pass_number, np.tile([0, 1], 10))
    lines = scanlines_of(survey_of(scanned(), scanned(yaw=-45.0)), 0, 30.0, 31.0)
    np.testing.assert_array_equal(lines.scanner, np.tile([0, 1], 10))


def test_driven_backwards_the_street_is_the_same():
    time, x = driven()
    survey = survey_of(scanned(drive=(time, x[::-1])), drive=(time, x[::-1]))
    lines = on_street(survey)
    assert complete(lines) == 1.0
    away = np.abs(np.abs(lines.d) - 3.5) > 0.10
    np.testing.assert_allclose(heights(survey, lines)[away], street_height(lines.d[away]), atol=5e-4)


def test_without_times_the_points_near_the_planes_make_the_scanlines():
    survey = survey_of(scanned(pulses=200_000.0), has_time=False)
    lines = scanlines_of(survey, 0, 20.0, 40.0)
    same_lines(lines, point_scanlines(survey, 0, 20.0, 40.0, 0.10, 15.0))
    assert len(np.unique(lines.station)) == 200
    road = np.abs(lines.d) < 3.3
    np.testing.assert_allclose(heights(survey, lines)[road], 0.0, atol=0.01)


@pytest.mark.parametrize("interval", [0.05, 0.10, 0.37, 1.0])
def test_where_a_window_ends_changes_no_scanline_of_points_by_a_hair(interval):
    """Rough faces bring points out of order, and how they are put in order must not tell of the lines before."""
    survey = survey_of(scanned(pulses=200_000.0, noise=0.008), has_time=False)
    whole = point_scanlines(survey, 0, 20.0, 40.0, interval, 15.0)
    for cuts in ((20.0, 29.97, 40.0), (20.0, 20.8, 33.0, 33.4, 40.0)):
        parts = Scanlines.join([point_scanlines(survey, 0, a, b, interval, 15.0) for a, b in zip(cuts[:-1], cuts[1:])])
        for name in ("first", "station", "pass_number", "scanner", "d", "z", "intensity"):
            np.testing.assert_array_equal(getattr(whole, name), getattr(parts, name))


def test_a_single_line_makes_no_scanline_and_no_complaint():
    cloud = scanned()
    survey = survey_of(cloud[cloud.line == 200])
    assert len(np.unique(np.rint(on_street(survey).station * 10))) < 5


@pytest.mark.parametrize("wrong", [dict(interval=0.0), dict(corridor=1.0), dict(rotation_frequency=3.0)])
def test_settings_that_make_no_sense_are_refused(wrong):
    with pytest.raises(RoadExtractionError, match="it must be"):
        ScanlineSettings(**wrong)
