"""The scan lattice on streets whose every line is known."""

import numpy as np
import pytest
from heard import Heard
from lanewright.core.survey.lattice.scan_lattice import COARSE_TIMES, DISORDER, find_lattice
from scanned_streets import START, TUNNEL, Cloud, driven, scanned, survey_of


def lines_found(cloud, lattice, key=(0, 0)):
    """Share of a cloud's points whose line is right but for a constant."""
    mirror = lattice.mirror_phases[key]
    share = np.sign(mirror.frequency) * cloud.angle / (2 * np.pi)   # of a turn, from the zenith: exact, whatever the error of the phase
    line = np.round(mirror.turns_at(cloud.time) - np.where(share < 0, share + 1.0, share)).astype(int)
    apart = line - cloud.line
    return np.mean(apart == np.median(apart))


CASES = {
    "slow": dict(rotation=20.0), "usual": dict(rotation=100.0), "fast": dict(rotation=200.0, pulses=200_000.0),
    "the other way round": dict(rotation=-100.0), "straight across": dict(yaw=0.0), "turned the other way": dict(yaw=-45.0),
    "wandering": dict(wander=0.01), "rounded times": dict(rounded=1e-6, pulses=400_000.0), "lost points": dict(lost=0.10),
    "tunnel": dict(section=TUNNEL), "narrow": dict(clipped=4.0),
    "all at once": dict(wander=0.01, rounded=1e-6, lost=0.10, clipped=4.0, noise=0.01),
    "all at once in a tunnel": dict(wander=0.01, rounded=1e-6, lost=0.10, section=TUNNEL, noise=0.01),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_every_point_gets_its_line(case):
    cloud = scanned(**case)
    lattice = find_lattice(survey_of(cloud))
    assert lattice.mirror_phases[0, 0].frequency == pytest.approx(case.get("rotation", 100.0), rel=0.005)
    assert lines_found(cloud, lattice) >= 0.9999


def test_two_scanners_and_two_passes_each_have_a_mirror_phase():
    time, x = driven(seconds=4.0)
    back = time + 100.0, x[::-1]
    left, right = scanned(drive=(time, x), rotation=120.0), scanned(drive=(time, x), rotation=120.0, yaw=-45.0)
    lattice = find_lattice(survey_of(left, right, drive=(time, x)))
    assert sorted(lattice.mirror_phases) == [(0, 0), (0, 1)]
    lattice = find_lattice(survey_of(left, scanned(drive=back, rotation=80.0), drives=[(time, x), back]))
    assert lattice.mirror_phases[0, 0].frequency == pytest.approx(120.0, rel=1e-3)
    assert lattice.mirror_phases[1, 0].frequency == pytest.approx(80.0, rel=1e-3)


def test_the_order_of_sections_and_their_length_change_no_line():
    cloud = scanned(wander=0.01, lost=0.1)
    short, long = find_lattice(survey_of(cloud, section_length=5.0)), find_lattice(survey_of(cloud, section_length=60.0))
    for number in (0, 1):
        a, b = (lattice.mirror_phases[0, 0].lines_and_phase(cloud.time)[number] for lattice in (short, long))
        np.testing.assert_allclose(a, b, atol=5e-4)


def test_a_vehicle_that_waits_keeps_its_lines():
    drive = driven(waits=[(2.0, 3.0)])
    cloud = scanned(drive=drive)
    lattice = find_lattice(survey_of(cloud, drive=drive))
    assert lines_found(cloud, lattice) >= 0.9999


def test_a_frequency_that_is_given_is_taken():
    cloud = scanned(rotation=100.0)
    assert find_lattice(survey_of(cloud), rotation_frequency=100.0).mirror_phases[0, 0].frequency == pytest.approx(100.0, rel=1e-4)
    assert find_lattice(survey_of(cloud), rotation_frequency=63.0).mirror_phases == {}


def test_lines_left_out_of_the_cloud_leave_the_others_where_they_are():
    cloud = scanned()
    cloud = cloud[cloud.line % 8 == 0]
    lattice = find_lattice(survey_of(cloud))
    clock = lattice.mirror_phases[0, 0]
    # of one line in eight nobody can say whether it took the mirror seven turns or eight
    assert abs(clock.spacing - 8) <= 1 and clock.frequency / clock.spacing == pytest.approx(12.5, rel=1e-4)
    line, _ = clock.lines_and_phase(cloud.time)
    np.testing.assert_array_equal(np.unique(line, return_inverse=True)[1], np.unique(cloud.line, return_inverse=True)[1])


def test_where_angles_say_nothing_the_sky_between_the_lines_does():
    # the trajectory is that of another lane, so that all points are seen in nearly one direction
    cloud = scanned(offset=0.0, clipped=8.0)
    time, x = driven()
    lattice = find_lattice(survey_of(cloud, drives=[(time, x, 18.0)]))
    clock = lattice.mirror_phases[0, 0]
    assert clock.origin == "gap"
    assert clock.frequency == pytest.approx(100.0, rel=1e-3) and not clock.leftward
    line, _ = clock.lines_and_phase(cloud.time)
    # which turn a point of the unseen half belongs to, below and above, is for the sky to say
    assert np.mean(line - cloud.line == np.median(line - cloud.line)) >= 0.9999


def spinning(rate=10.0, beams=16, seconds=6.0):
    """(time, x, y, z) of a head of many beams that spins about the vertical above a level street."""
    t = np.arange(0.0, seconds, 1.0 / (rate * 900))
    down = np.radians(np.linspace(3.0, 25.0, beams))
    turn = 2 * np.pi * rate * t
    reach = 2.5 / np.tan(down)
    x = 10.0 * t[:, None] + reach * np.cos(turn)[:, None]
    y = reach * np.sin(turn)[:, None]
    near = np.abs(y) < 20.0
    return np.broadcast_to(START + t[:, None], x.shape)[near], x[near], y[near], np.zeros(int(near.sum()))


def test_a_spinning_scanner_with_many_beams_has_no_scan_lines():
    time, x, y, z = spinning()
    heard = Heard()
    lattice = find_lattice(survey_of(Cloud(time, x, y, z, np.zeros(len(x)), np.zeros(len(x)))), progress=heard)
    assert lattice.mirror_phases == {} and list(lattice.without) == [(0, 0)]
    assert len(heard.warned) == 1 and "no regular scan lines" in heard.warned[0] and "many beams" in heard.warned[0]


def test_times_too_coarse_for_the_order_of_points_are_no_lattice():
    assert find_lattice(survey_of(scanned(rounded=2e-5))).without == {(0, 0): COARSE_TIMES}
    assert find_lattice(survey_of(scanned(rounded=1e-5))).without == {}


def test_times_that_mix_up_the_points_of_a_line_are_named_and_no_head_of_many_beams_is():
    cloud = scanned()
    cloud.time += np.random.default_rng(1).normal(0.0, 3e-5, len(cloud.time))
    assert find_lattice(survey_of(cloud)).without == {(0, 0): DISORDER}


def test_without_times_there_are_no_lines_to_tell():
    lattice = find_lattice(survey_of(scanned(), has_time=False))
    assert lattice.mirror_phases == {} and "Without gps_time in the cloud" in lattice.notes[0]


def test_one_line_is_too_little():
    cloud = scanned()
    cloud = cloud[cloud.line == 200][:150]
    lattice = find_lattice(survey_of(cloud))
    assert lattice.mirror_phases == {} and "too few points" in lattice.notes[0]
