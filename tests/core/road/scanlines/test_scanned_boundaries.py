"""Boundaries of a street of known section, scanned by a rotating mirror: what must not change them."""

import os

import numpy as np
import pytest
from lanewright.core.road.scanlines.detect import SurveyScanlines
from lanewright.core.road.scanlines.section_planes import ScanlineSettings
from lanewright.core.survey.lattice.scan_lattice import find_lattice
from road_layers import curbs_from_scanlines, fit_road_edges
from scanned_streets import CURB, driven, scanned, survey_of

NOISE = 0.004


def corners(survey, part="bottom", lattice=None, **planes):
    """(N, 4) station, outward offset, height above the road and curb height of the measured corners."""
    found = curbs_from_scanlines(SurveyScanlines(survey, ScanlineSettings(**planes), lattice=lattice))
    return np.array([(r["station_m"], abs(r["offset_m"]), g.z - 100.0, r["height_m"]) for g, r in found
                     if r["part"] == part and r["status"] == "measured"]).reshape(-1, 4)


def on_the_curb(found, tolerance, first=12.0, last=48.0):
    """The corners of both sides run along the whole street and keep to the curb."""
    own = found[(found[:, 0] > first) & (found[:, 0] < last)]
    assert len(np.unique(np.floor(own[:, 0] / 2.0))) >= (last - first) / 2 - 1
    for off in (own[:, 1] - 3.5, own[:, 2]):
        assert np.sqrt(np.mean(off**2)) < tolerance and np.abs(off).max() < 2 * tolerance


def test_without_noise_the_corners_are_right_to_the_millimetre():
    survey = survey_of(scanned(pulses=200_000.0))
    bottoms, tops = corners(survey), corners(survey, "top")
    np.testing.assert_allclose(bottoms[:, 1:3], [(3.5, 0.0)] * len(bottoms), atol=0.001)
    np.testing.assert_allclose(tops[:, 1:3], [(3.5, CURB)] * len(tops), atol=0.001)
    np.testing.assert_allclose(bottoms[:, 3], CURB, atol=0.001)
    assert bottoms[:, 0].min() < 12 and bottoms[:, 0].max() > 48


@pytest.mark.parametrize("mount", [dict(yaw=0.0), dict(yaw=30.0), dict(yaw=-45.0), dict(rotation=-100.0)],
                         ids=["straight across", "turned by 30", "turned the other way", "rotating the other way"])
def test_turning_the_scanner_on_its_mount_moves_the_boundary_by_less_than_the_noise(mount):
    on_the_curb(corners(survey_of(scanned(noise=NOISE, **mount))), NOISE)


@pytest.mark.parametrize("speed", [4.0, 12.5])
def test_the_speed_of_the_drive_moves_the_boundary_by_less_than_the_noise(speed):
    drive = driven(seconds=60.0 / speed, speed=speed)
    on_the_curb(corners(survey_of(scanned(drive=drive, noise=NOISE), drive=drive)), NOISE)


@pytest.mark.parametrize("rates", [dict(rotation=50.0), dict(rotation=200.0, pulses=200_000.0), dict(pulses=300_000.0)],
                         ids=["half the lines", "twice the lines", "three times the points"])
def test_the_rates_of_the_scanner_move_the_boundary_by_less_than_the_noise(rates):
    on_the_curb(corners(survey_of(scanned(noise=NOISE, **rates))), NOISE)


@pytest.mark.parametrize("kept", [2, 4])
def test_with_fewer_scan_lines_the_boundary_moves_by_less_than_the_noise(kept):
    cloud = scanned(noise=NOISE, pulses=200_000.0)
    on_the_curb(corners(survey_of(cloud[cloud.line % kept == 0])), NOISE)


@pytest.mark.parametrize("interval", [0.05, 0.2, 0.4])
def test_the_interval_of_the_planes_moves_the_boundary_by_less_than_the_noise(interval):
    on_the_curb(corners(survey_of(scanned(noise=NOISE)), interval=interval), NOISE)


def test_a_vehicle_that_stops_and_waits_changes_nothing():
    drive = driven(waits=[(3.0, 3.0)])
    on_the_curb(corners(survey_of(scanned(drive=drive, noise=NOISE), drive=drive)), NOISE)


def test_without_times_the_boundary_is_found_among_the_points():
    on_the_curb(corners(survey_of(scanned(noise=NOISE, pulses=200_000.0), has_time=False)), 2 * NOISE)


def test_without_times_no_boundary_is_drawn_where_a_scanner_on_the_sidewalk_saw_no_face():
    cloud = scanned(noise=NOISE, pulses=200_000.0)
    hidden = (cloud.y > 3.35) & (cloud.y < 3.51) & (cloud.z < 0.11)
    found = curbs_from_scanlines(SurveyScanlines(survey_of(cloud[~hidden], has_time=False)))
    assert {row["side"] for row in found.rows if row["status"] == "measured"} == {"right"}


def test_a_single_scan_line_has_no_boundary_and_no_complaint():
    cloud = scanned()
    assert len(corners(survey_of(cloud[cloud.line == 300]))) == 0


def test_two_scanners_draw_one_boundary():
    left, right = scanned(noise=NOISE), scanned(noise=NOISE, yaw=-45.0, seed=8)
    survey = survey_of(left, right)
    found = corners(survey)
    on_the_curb(found, NOISE)
    # one corner a block and side, not one for each scanner
    middle = found[(found[:, 0] > 12) & (found[:, 0] < 48)]
    assert len(middle) <= 2 * 36 / 2.0 + 6


def test_section_length_and_number_of_threads_change_nothing(monkeypatch):
    cloud = scanned(noise=NOISE)
    whole, short = survey_of(cloud), survey_of(cloud, section_length=7.0)
    lattice = find_lattice(whole)
    found = corners(whole, lattice=lattice)
    np.testing.assert_array_equal(corners(short, lattice=lattice), found)
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    np.testing.assert_array_equal(corners(whole, lattice=lattice), found)


def test_the_edges_through_the_corners_keep_to_the_curb():
    survey = survey_of(scanned(noise=NOISE))
    edges = fit_road_edges(curbs_from_scanlines(SurveyScanlines(survey)), survey.frame)
    assert {row["side"] for row in edges.rows} == {"left", "right"}
    for line, _row in edges:
        np.testing.assert_allclose(np.abs(np.array(line.coords)[:, 1] - 2000.0), 3.5, atol=NOISE)
