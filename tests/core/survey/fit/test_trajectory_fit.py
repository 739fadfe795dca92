"""A trajectory that is not that of its scanners: told by the rays of their mirrors, moved to where they were, and said in one warning."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
from drives import EAST, NORTH
from heard import Heard
from lanewright.core.survey.adjustment.trajectory_fit import fitted_trajectory, read_places, scanner_mountings
from lanewright.core.survey.las.reader import read_headers
from lanewright.core.survey.open_survey import open_survey
from mirror_drives import Mirror, mirror_drive, section

PAIR = Mirror(turn=-45.0, lever=(-2.4, 0.3, 0.1)), Mirror(turn=45.0, lever=(-2.4, -0.3, 0.1), ahead=0.7)



@pytest.fixture(scope="module")
def straight(tmp_path_factory):
    """A street driven with two scanners, its cloud and true trajectory."""
    measured = mirror_drive(PAIR, seconds=5.0)
    return measured.write(tmp_path_factory.mktemp("street") / "street.laz"), measured.trajectory()


def told(path, trajectory):
    heard = Heard()
    return fitted_trajectory(read_headers([path]), trajectory, progress=heard), heard.warned


def beside(trajectory, metres):
    yaw = np.radians(90.0 - trajectory.heading)
    return replace(trajectory, x=trajectory.x - np.sin(yaw) * metres, y=trajectory.y + np.cos(yaw) * metres)


def across(one, other):
    """(N,) m that the first runs to the left of the second."""
    yaw = np.radians(90.0 - other.heading)
    return (one.y - other.y) * np.cos(yaw) - (one.x - other.x) * np.sin(yaw)


def test_a_trajectory_that_fits_stays_as_it_is_and_nothing_is_said(straight):
    path, trajectory = straight
    found, warned = told(path, trajectory)
    assert found.trajectory is trajectory and found.sigma == 0.0 and found.seen and not warned


def test_the_rays_show_where_the_scanners_were_mounted(straight):
    path, trajectory = straight
    mountings = scanner_mountings(read_places(read_headers([path])), trajectory)
    for one, mirror in zip(mountings, PAIR):
        np.testing.assert_allclose(np.median(one.lever, axis=0), mirror.lever, atol=0.03)
        assert one.ground == pytest.approx(-2.6, abs=0.1)


@pytest.mark.parametrize("metres", [-3.0, -1.7, 2.0])
def test_a_trajectory_beside_its_scanners_is_moved_to_them(straight, metres):
    path, trajectory = straight
    found, warned = told(path, beside(trajectory, metres))
    np.testing.assert_allclose(across(found.trajectory, trajectory), 0.0, atol=0.05)
    assert len(warned) == 1 and f"to the {'left' if metres > 0 else 'right'} of the way" in warned[0]


def test_a_trajectory_in_another_datum_is_moved_by_one_vector_on_the_map(tmp_path):
    measured = mirror_drive((Mirror(lever=(-2.4, 0.0, 0.0)),), seconds=8.0, poses=None)
    path, trajectory = measured.write(tmp_path / "street.laz"), measured.trajectory()
    found, warned = told(path, replace(trajectory, x=trajectory.x + 0.5, y=trajectory.y - 2.5))
    np.testing.assert_allclose(across(found.trajectory, trajectory), 0.0, atol=0.05)
    assert len(warned) == 1 and "another datum" in warned[0]


@pytest.mark.parametrize("up, said", [(48.0, "above"), (-48.0, "below"), (-3.6, "below the road")])
def test_a_trajectory_far_above_its_scanners_or_below_the_road_gets_their_height(straight, up, said):
    path, trajectory = straight
    found, warned = told(path, replace(trajectory, z=trajectory.z + up))
    np.testing.assert_allclose(found.trajectory.z - trajectory.z, 0.1, atol=0.15)
    np.testing.assert_allclose(across(found.trajectory, trajectory), 0.0, atol=0.05)
    assert len(warned) == 1 and said in warned[0] and "ellipsoid" in warned[0]


def raised(measured, path, heights):
    """The cloud and trajectory of a drive, their heights changed."""
    place = measured.place.copy()
    place[:, 2] = heights(place[:, 2] + 100.0) - 100.0
    trajectory = measured.trajectory()
    return replace(measured, place=place).write(path), replace(trajectory, z=heights(trajectory.z))


def test_heights_in_feet_beside_metres_are_named(tmp_path):
    found, warned = told(*raised(mirror_drive(PAIR, seconds=5.0), tmp_path / "feet.laz", lambda z: z / 0.3048))
    assert found.seen and len(warned) == 1 and "in feet where x and y are in metres" in warned[0]
    assert found.sigma > 0.1


def test_heights_of_the_cloud_alone_in_feet_are_named_as_such(tmp_path):
    measured = mirror_drive(PAIR, seconds=5.0)
    path, _ = raised(measured, tmp_path / "feet.laz", lambda z: z / 0.3048)
    _, warned = told(path, measured.trajectory())
    assert len(warned) == 1 and "heights of the cloud alone seem to be in feet" in warned[0]


def test_heights_that_are_upside_down_are_named(tmp_path):
    found, warned = told(*raised(mirror_drive(PAIR, seconds=5.0), tmp_path / "down.laz", lambda z: -z))
    assert len(warned) == 1 and "upside down" in warned[0] and found.sigma > 0.1


@pytest.mark.parametrize("metres, told_of", [((0.0, 0.8, 0.0), True), ((1.2, 0.0, 0.0), True), ((0.1, 0.15, 0.0), True), ((0.0, 0.0, 0.2), True),
                                             ((0.1, 0.0, 0.0), True), ((0.0, 0.03, 0.02), False)])
def test_a_step_between_the_files_of_one_drive_is_told_and_leaves_the_street_as_uncertain(tmp_path, metres, told_of):
    """The second half of a street is in another datum, by less than the half of a vehicle."""
    measured = mirror_drive(PAIR, seconds=20.0)
    late = measured.time > np.median(measured.time)
    place = measured.place.copy()
    place[late] += metres
    found, warned = told(replace(measured, place=place).write(tmp_path / "street.laz"), measured.trajectory())
    assert [bool(re.search("elsewhere beside the trajectory.*two datums", text)) for text in warned] == [True] * told_of
    assert found.sigma == pytest.approx(np.linalg.norm(metres) if told_of else 0.0, abs=0.15)


def test_points_of_which_a_tile_holds_one_side_alone_show_no_step(tmp_path):
    """A tile in the middle of a street is missing: at its ends points lie far ahead or far behind of their scanner."""
    measured = mirror_drive(PAIR, seconds=20.0, corners=section(wall=(14.0, 6.0)))
    kept = np.abs(measured.place[:, 0] - np.median(measured.place[:, 0])) > 30.0
    found, warned = told(measured.write(tmp_path / "street.laz", kept), measured.trajectory())
    assert found.seen and found.sigma == 0.0 and not warned


def test_a_trajectory_that_is_mirrored_is_told_and_moves_nothing(tmp_path):
    measured = mirror_drive(PAIR, seconds=20.0)
    trajectory = measured.trajectory()
    x, y = trajectory.x.mean(), trajectory.y.mean()
    mirrored = replace(trajectory, x=x + trajectory.y - y, y=y + trajectory.x - x)
    found, warned = told(measured.write(tmp_path / "street.laz"), mirrored)
    assert len(warned) == 1 and "Half of the points lie more than" in warned[0] and "mirrored" in warned[0]
    assert found.trajectory is mirrored and found.sigma > 15.0


def test_the_ceiling_of_a_tunnel_is_no_road(tmp_path):
    """It is nearer to the scanners than the road, and more points lie on it."""
    measured = mirror_drive(PAIR, seconds=5.0, corners=[(-5.0, 0.0), (5.0, 0.0), (5.0, 4.6), (-5.0, 4.6), (-5.0, 0.0)])
    heard = Heard()
    survey = open_survey([measured.write(tmp_path / "tunnel.laz")], measured.trajectory(), progress=heard)
    survey.store.close()
    assert survey.sensor_height[0] == pytest.approx(2.5, abs=0.1) and not heard.warned


def test_scanners_of_which_places_show_one_at_a_time_are_two(tmp_path):
    """Programs that write the points of one scanner after those of the other."""
    measured = mirror_drive(PAIR, seconds=20.0)
    first = (np.floor(measured.time) % 4 < 3) == (measured.scanner == measured.scanner.min())
    path = replace(measured, **{name: getattr(measured, name)[first] for name in ("time", "place", "scanner")}).write(tmp_path / "street.laz")
    found, warned = told(path, beside(measured.trajectory(), 2.0))
    assert found.seen and len(warned) == 1 and "to the left of the way" in warned[0]


def test_times_of_broken_points_do_not_disturb_those_of_the_drive(straight):
    """A few points of a file whose times were damaged on the way."""
    path, trajectory = straight
    sample = read_places(read_headers([path]))
    rows = np.r_[0, np.arange(len(sample.time)), 0]
    broken = replace(sample, **{name: getattr(sample, name)[rows] for name in ("place", "scanner", "source")}, time=np.r_[-1e300, sample.time, 1e300])
    with np.errstate(all="raise"), warnings.catch_warnings():
        warnings.simplefilter("error")
        found = scanner_mountings(broken, trajectory)
    for one, mirror in zip(found, PAIR, strict=True):
        np.testing.assert_allclose(np.median(one.lever, axis=0), mirror.lever, atol=0.03)


def test_coordinates_of_32_bits_are_told_once_and_leave_the_street_as_uncertain_as_their_step(tmp_path):
    measured = mirror_drive(PAIR, seconds=3.0)
    origin = np.array([EAST, NORTH])
    rounded = measured.place.copy()
    rounded[:, :2] = (rounded[:, :2] + origin).astype(np.float32) - origin
    heard = Heard()
    survey = open_survey([replace(measured, place=rounded).write(tmp_path / "street.laz")], measured.trajectory(), progress=heard)
    survey.store.close()
    assert [text for text in heard.warned if "steps of" in text] == [text for text in heard.warned if "32-bit numbers" in text] and \
        sum("steps of" in text for text in heard.warned) == 1
    assert survey.frame.pass_sigma[0].metres == pytest.approx((0.5 / np.sqrt(6.0),))
