"""A known trajectory that is left out comes back from the points alone."""

from dataclasses import replace

import numpy as np
import pytest
from drives import EAST, NORTH, write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.estimation.estimate import estimate_trajectory, refuse_handheld
from lanewright.core.survey.estimation.samples import FirstTrack, rounding_of
from lanewright.core.survey.weights import ESTIMATE
from mirror_drives import START, Mirror, mirror_drive, section, swaying
from scipy.interpolate import PchipInterpolator

BUTTERFLY = (Mirror(-45.0, -20.0, (0.0, 0.32, 0.0)), Mirror(45.0, -20.0, (0.0, -0.32, 0.0), ahead=0.55))
CROSSED = tuple(replace(mirror, pulses=8000.0) for mirror in BUTTERFLY)   # as sparse as keeps a long drive short to compute
OPEN = section(wall=(20.0, 1.0))


def close(drive, found, place=0.03, height=0.02):
    """Whether a trajectory lies on the truth: within `place` to the side and `height` up, but for its ends within a few centimetres."""
    ahead, left, up = drive.errors(found.trajectory)
    time = found.trajectory.time
    inner = (time > time[0] + 0.5) & (time < time[-1] - 0.5)
    assert np.ptp(time) > 5.0
    assert np.sqrt(np.mean(left[inner] ** 2)) < place and np.sqrt(np.mean(up[inner] ** 2)) < height
    assert np.abs(np.stack([left, up])).max() < 0.3 and np.abs(ahead).max() < 0.3


CASES = {
    "one scanner straight across": dict(mirrors=[Mirror(0.0, 0.0)]),
    "leaning forward by as much as it is turned": dict(mirrors=[Mirror(30.0, 30.0)]),
    "the other way round": dict(mirrors=[Mirror(45.0, -20.0, rate=-100.0)]),
    "slow and sparse": dict(mirrors=[Mirror(45.0, -20.0, rate=20.0, pulses=6000.0)]),
    "two of different rates": dict(mirrors=[Mirror(-45.0, -20.0, (0.0, 0.4, 0.0), rate=80.0), Mirror(45.0, -20.0, (0.0, -0.4, 0.0), rate=120.0)]),
    "a rotation that swings, over a steep crown": dict(mirrors=BUTTERFLY, wander=0.005, corners=section(crown=0.05), poses=swaying(crossfall=0.05)),
    "no walls": dict(mirrors=BUTTERFLY, corners=OPEN),
    "noisy ranges": dict(mirrors=BUTTERFLY, noise=0.03),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_a_trajectory_left_out_comes_back_within_centimetres(tmp_path, case):
    drive = mirror_drive(**case)
    found = estimate_trajectory([drive.write(tmp_path / "cloud.las")])
    assert found.method == "rays" and len(found.scanners) == len(case["mirrors"])
    close(drive, found)


@pytest.fixture(scope="module")
def street():
    return mirror_drive(BUTTERFLY)


@pytest.fixture(scope="module")
def estimated(street, tmp_path_factory):
    return estimate_trajectory([street.write(tmp_path_factory.mktemp("street") / "cloud.las")])


def test_two_scanners_with_crossed_planes_give_the_trajectory_and_the_mounting(street, estimated):
    assert estimated.method == "rays" and len(estimated.scanners) == 2
    close(street, estimated)
    poses = estimated.adjusted.poses
    np.testing.assert_allclose(np.degrees(poses.turn), [-45.0, 45.0], atol=0.3)
    np.testing.assert_allclose(np.degrees(poses.lean), [-20.0, -20.0], atol=0.3)
    np.testing.assert_allclose(poses.lever, [[0.0, 0.32, 0.0], [0.0, -0.32, 0.0]], atol=0.02)


def test_attitude_follows_the_springs(street, estimated):
    track = estimated.trajectory
    _, _, _, roll, pitch, yaw = street.poses(track.time)
    inner = slice(50, -50)
    for found, true in ((track.roll, np.degrees(roll)), (track.pitch, np.degrees(pitch)), (90.0 - track.heading, np.degrees(yaw))):
        off = (found - true + 180.0) % 360.0 - 180.0
        assert np.std(off[inner]) < 0.1 and np.abs(np.mean(off[inner])) < 1.0


def test_the_uncertainty_grows_where_few_points_are(tmp_path, street):
    time = street.time - START
    kept = (time < 2.0) | (time > 2.9)
    found = estimate_trajectory([street.write(tmp_path / "cloud.las", kept)])
    at = found.trajectory.time - START
    gap, rest = (at > 2.3) & (at < 2.6), (at > 0.5) & (at < 1.7)
    assert found.sigma[gap].max() > 3 * found.sigma[rest].max()
    assert found.sigma.max() <= ESTIMATE.max_sigma
    ahead, left, _ = street.errors(found.trajectory)
    assert np.mean(np.hypot(ahead, left) <= 3 * found.sigma) > 0.9


def test_of_one_point_in_ten_the_trajectory_is_the_same(tmp_path, street):
    chosen = np.random.default_rng(1).random(len(street.time)) < 1 / 10
    close(street, estimate_trajectory([street.write(tmp_path / "thin.las", chosen)]))


def test_rounded_times_do_not_draw_the_scanner_to_what_it_sees_from_far(tmp_path):
    drive = mirror_drive([replace(mirror, rate=200.0) for mirror in BUTTERFLY], seconds=8.0)
    # as at the end of a survey: what lies beyond the street is not in the cloud, and the last seconds see it from ahead of its end
    drive.time, inside = np.round(drive.time * 2**11) / 2**11, drive.place[:, 0] < 65.0
    found = estimate_trajectory([drive.write(tmp_path / "cloud.las", inside)])
    ahead, left, up = drive.errors(found.trajectory)
    assert np.sqrt(np.mean(left**2)) < 0.05 and np.sqrt(np.mean(up**2)) < 0.03
    assert np.abs(np.stack([left, up])).max() < 0.3
    assert np.mean(np.hypot(ahead, left) < 3 * found.sigma + 0.01) > 0.95


def test_times_that_are_not_rounded_are_taken_as_exact():
    rng = np.random.default_rng(1)
    time = np.sort(rng.uniform(0.0, 10.0, 5000))
    assert rounding_of(time, 3e8) == 0.0
    assert rounding_of(np.round(time, 4), 3e8) == 1e-4 and rounding_of(np.round(time * 2**11) / 2**11, 3e8) == 2.0**-11


def test_files_may_come_in_any_order_and_the_points_too(tmp_path, street, estimated):
    whole = estimated.trajectory
    mixed = np.random.default_rng(2).permutation(len(street.time))
    halves = [street.write(tmp_path / f"{name}.las", mixed[k::2]) for k, name in enumerate("ba")]
    parts = estimate_trajectory(halves).trajectory
    np.testing.assert_allclose(parts.time, whole.time, atol=1e-6)
    np.testing.assert_allclose(np.c_[parts.x, parts.y, parts.z][25:-25], np.c_[whole.x, whole.y, whole.z][25:-25], atol=0.002)


def test_points_at_wrong_times_are_no_drive(tmp_path, street):
    """Thousands at one time long before, and at one long after: the drive is as precise as without them."""
    import laspy

    path = street.write(tmp_path / "cloud.las")
    las = laspy.read(path)
    time = np.array(las.gps_time)
    assert len(time) > 40_000
    time[::20], time[1::20] = -5.0, 1e300
    las.gps_time = time
    las.write(path)
    found = estimate_trajectory([path])
    assert found.method == "rays"
    close(street, found)


def test_where_returns_keep_to_no_rays_the_uncertainty_and_a_note_say_so(tmp_path, street):
    place = street.place + np.random.default_rng(1).normal(0.0, 0.1, street.place.shape)
    found = estimate_trajectory([replace(street, place=place).write(tmp_path / "cloud.las")])
    assert found.method == "rays" and any("off the rays" in note for note in found.notes)
    ahead, left, up = street.errors(found.trajectory)
    assert np.mean(np.hypot(ahead, left) <= 3 * found.sigma) > 0.95 and np.mean(np.abs(up) <= 3 * found.sigma_height) > 0.95


def test_a_gap_in_time_makes_two_drives(tmp_path):
    drive = mirror_drive(CROSSED, seconds=14.0)
    since = drive.time - START
    found = estimate_trajectory([drive.write(tmp_path / "cloud.las", (since < 6.0) | (since > 8.0))])
    at = found.trajectory.time - START
    assert not ((at > 6.1) & (at < 7.9)).any()
    close(drive, found)
    assert found.length == pytest.approx(120.0, abs=3.0)


def test_without_time_the_ridge_of_density_is_followed_and_said_to_be_rough(tmp_path):
    drive = mirror_drive(BUTTERFLY, seconds=8.0)
    found = estimate_trajectory([drive.write(tmp_path / "cloud.las", with_time=False)])
    assert found.method == "density" and not found.trajectory.has_time
    assert "rough" in found.notes[0]
    track = found.trajectory
    inner = (track.x - EAST > 5.0) & (track.x - EAST < 75.0)
    assert inner.sum() > 100
    assert np.abs(track.y[inner] - NORTH - -1.5).max() < 0.6
    assert np.abs(track.z[inner] - 100.0 - 2.5).max() < 0.5


def test_without_time_a_street_driven_both_ways_is_followed_however_far_apart_its_tracks_lie(tmp_path):
    x, y, z = mirror_drive(CROSSED, corners=OPEN).place.T
    on_street = np.abs(y) < 14.0
    for apart in (5.5, 10.0):
        there, back = y[on_street], (apart - 3.0 - y)[on_street]
        places = np.tile(x[on_street], 2) + EAST, np.r_[there, back] + NORTH, np.tile(z[on_street], 2) + 100.0
        track = estimate_trajectory([write_cloud(tmp_path / "cloud.las", *places, None)]).trajectory
        inner = (track.x - EAST > 5.0) & (track.x - EAST < 75.0)
        assert inner.sum() > 100
        assert (np.abs(track.y[inner] - NORTH + 1.5 - apart / 2) < apart / 2 + 0.6).all()


def test_points_as_dense_everywhere_show_no_track_without_times(tmp_path):
    x, y = np.random.default_rng(4).uniform([0.0, -15.0], [120.0, 15.0], (60_000, 2)).T
    path = write_cloud(tmp_path / "air.las", x + EAST, y + NORTH, np.full(len(x), 100.0), None)
    with pytest.raises(RoadExtractionError, match="no track shows in their density"):
        estimate_trajectory([path])


def test_a_cloud_in_feet_that_no_crs_tells_of_is_noted(tmp_path):
    drive = mirror_drive(BUTTERFLY, corners=OPEN)
    found = estimate_trajectory([write_cloud(tmp_path / "cloud.las", *drive.place.T / 0.3048, drive.time, source=1 + drive.scanner)])
    assert any("as if cloud and trajectory were in feet" in note for note in found.cloud_notes)


def test_an_airborne_cloud_is_refused_by_name(tmp_path):
    rng = np.random.default_rng(4)
    time = START + np.arange(0.0, 3.0, 1e-4)
    x, y = 60.0 * (time - START), 300.0 * np.tan(np.radians(25.0) * np.sin(2 * np.pi * 50.0 * time))
    path = write_cloud(tmp_path / "air.las", x + EAST, y + NORTH, 100.0 + rng.normal(0, 0.05, len(x)), time)
    with pytest.raises(RoadExtractionError, match="airborne"):
        estimate_trajectory([path])


def along_the_street(seconds, metres):
    """Poses of a vehicle that looks along x and is at `metres` after `seconds`, evenly or not, on springs."""
    place, even = PchipInterpolator(seconds, metres), swaying(sway=0.5)

    def poses(time):
        t = np.asarray(time)
        _, y, z, roll, pitch, _ = even(t)
        return place(np.clip(t - START, 0.0, seconds[-1])), y, z, roll, pitch, np.zeros(len(t))

    return poses


def test_a_vehicle_that_stands_at_a_red_light_most_of_the_time_is_no_tripod(tmp_path):
    poses = along_the_street([0.0, 2.0, 4.0, 20.0, 22.0, 24.0], [0.0, 16.0, 20.0, 20.0, 24.0, 40.0])
    drive = mirror_drive(CROSSED, seconds=24.0, poses=poses)
    close(drive, estimate_trajectory([drive.write(tmp_path / "cloud.las")]))


def test_a_vehicle_that_backs_up_keeps_looking_ahead(tmp_path):
    poses = along_the_street([0.0, 4.0, 6.0, 8.0, 12.0, 14.0, 20.0], [0.0, 30.0, 36.0, 34.0, 20.0, 20.0, 70.0])
    drive = mirror_drive(CROSSED, seconds=20.0, poses=poses)
    found = estimate_trajectory([drive.write(tmp_path / "cloud.las")])
    close(drive, found)
    inner = slice(50, -50)
    np.testing.assert_allclose(found.trajectory.heading[inner], 90.0, atol=3.0)
    _, left, _ = drive.errors(found.trajectory)
    assert np.abs(left[inner]).max() < 0.05 and np.median(found.sigma) < 0.02


def test_a_terrestrial_scan_is_refused_by_name(tmp_path):
    def tripod(time):
        t = np.asarray(time) - START
        zero = np.zeros(len(t))
        return zero, zero - 1.0, zero + 1.8, zero, zero, np.radians(20.0) * t

    drive = mirror_drive([Mirror(0.0, 0.0, rate=50.0)], seconds=9.0, poses=tripod)
    with pytest.raises(RoadExtractionError, match="terrestrial"):
        estimate_trajectory([drive.write(tmp_path / "tripod.las")])


def test_a_handheld_cloud_is_refused_by_name(tmp_path):
    rng = np.random.default_rng(5)
    time = np.sort(START + rng.uniform(0.0, 30.0, 60_000))
    around = rng.uniform(0.0, 2 * np.pi, len(time))
    reach = np.abs(rng.standard_cauchy(len(time)).clip(-8, 8)) + 0.5
    x, y = 1.2 * (time - START) + reach * np.cos(around), reach * np.sin(around)
    path = write_cloud(tmp_path / "walk.las", x + EAST, y + NORTH, 100.0 + rng.normal(0, 0.02, len(x)), time)
    with pytest.raises(RoadExtractionError, match="handheld"):
        estimate_trajectory([path])


def test_walking_pace_is_told_over_seconds_since_the_first_track_swings_from_window_to_window():
    rng = np.random.default_rng(1)
    time = np.arange(0.05, 30.0, 0.1)

    def track(speed):
        foot = np.column_stack([speed * time, 0.2 * rng.standard_normal(len(time)), np.zeros(len(time))])
        return FirstTrack(time, foot, np.zeros(len(time)), np.full(len(time), 100), np.full(len(time), 5.0))

    with pytest.raises(RoadExtractionError, match="handheld"):
        refuse_handheld([track(1.2)], [])
    refuse_handheld([track(5.0)], [])


def test_two_drives_whose_clocks_overlap_are_refused_by_name(tmp_path, street):
    """Seconds of the day, on two days, on streets 150 m apart."""
    paths = [replace(street, place=street.place + [0.0, beside, 0.0]).write(tmp_path / f"{beside}.las") for beside in (0, 150)]
    with pytest.raises(RoadExtractionError, match="two places 150 m apart.*clocks overlap"):
        estimate_trajectory(paths)


def test_a_wet_road_that_is_missing_from_the_cloud_gives_no_track(tmp_path):
    """Facades 9 m away on either side, some of them missing, are seen; of the ground next to nothing is."""
    street = mirror_drive([Mirror(45.0, -20.0), Mirror(-45.0, -20.0)], corners=section(wall=(9.0, 8.0)))
    x, y, z = street.place.T
    facade = (np.abs(y) > 8.9) & ((x // 12 * 7 + (y > 0) * 3) % 5 > 1)
    kept = facade | (np.random.default_rng(1).random(len(x)) < 0.02)
    with pytest.raises(RoadExtractionError, match="density does not show the way"):
        estimate_trajectory([street.write(tmp_path / "cloud.las", kept, merged=True)])


def test_too_few_points_are_refused(tmp_path, street):
    with pytest.raises(RoadExtractionError, match="whole survey"):
        estimate_trajectory([street.write(tmp_path / "few.las", slice(0, 900))])
