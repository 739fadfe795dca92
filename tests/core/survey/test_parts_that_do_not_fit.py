"""Files and drives of a street that do not fit each other: said in one sentence, and the street is known no better than they fit."""

import re
from dataclasses import replace

import laspy
import numpy as np
import pytest
from heard import Heard
from lanewright.core.survey.open_survey import open_survey
from scipy.spatial import cKDTree


@pytest.fixture(scope="module")
def street(made_survey):
    return surveyed(made_survey, 60.0)


def surveyed(made_survey, length):
    """Points of a street surveyed with two scanners, in order of time, and its trajectory."""
    sample, path = made_survey(length=length, pulse_rate=60_000.0, rotation_rate=100.0)
    cloud = laspy.read(path)
    cloud.points = cloud.points[np.argsort(cloud.gps_time, kind="stable")]
    return cloud, sample.trajectory


def part_of(cloud, folder, name, rows, kind="las", **changed):
    """The file of some points, with columns changed; Z in millimetres."""
    part = laspy.LasData(cloud.header)
    part.points = cloud.points[rows].copy()
    for column, change in changed.items():
        part[column] = change(np.asarray(part[column]))
    part.write(folder / f"{name}.{kind}")
    return folder / f"{name}.{kind}"


def told(paths, trajectory):
    """Warnings, and the least sigma (m) of what passes leave, 0 where nothing is known."""
    heard = Heard()
    survey = open_survey(paths, trajectory, progress=heard)
    survey.store.close()
    return heard.warned, min((min(along.metres) for along in survey.frame.pass_sigma.values()), default=0.0)


def halves(street, tmp_path, kind="las", **changed):
    """Two files of the first and the second half of the drive, columns of the second changed."""
    cloud, _ = street
    late = cloud.gps_time > np.median(cloud.gps_time)
    return [part_of(cloud, tmp_path, "first", ~late, kind), part_of(cloud, tmp_path, "second", late, kind, **changed)]


@pytest.mark.parametrize("factor, brighter", [(3.0, "second"), (0.4, "first"), (1.3, None)])
def test_files_along_one_drive_with_other_scales_of_intensity_are_told(street, tmp_path, factor, brighter):
    paths = halves(street, tmp_path, intensity=lambda counts: np.minimum(factor * counts, 65535).astype(np.uint16))
    warned, _ = told(paths, street[1])
    assert len(warned) == (brighter is not None)
    for text in warned:
        times, named = re.search(r"about (\S+) times brighter in (\S+) than", text).groups()
        assert float(times) == pytest.approx(max(factor, 1 / factor), rel=0.2) and f"{brighter}.las" in named


def test_files_of_scanners_that_measure_together_may_differ_in_brightness(street, tmp_path):
    cloud, trajectory = street
    first = cloud.point_source_id == cloud.point_source_id.min()
    paths = [part_of(cloud, tmp_path, "one", first),
             part_of(cloud, tmp_path, "other", ~first, intensity=lambda counts: np.minimum(2.5 * counts, 65535).astype(np.uint16))]
    assert told(paths, trajectory) == ([], 0.0)


@pytest.mark.parametrize("up, least", [(0.2, 0.18), (0.0, 0.0)])
def test_a_street_is_known_no_better_than_the_heights_of_its_files_fit(made_survey, tmp_path, up, least):
    street = surveyed(made_survey, 100.0)
    warned, sigma = told(halves(street, tmp_path, "laz", Z=lambda units: units + round(1000 * up)), street[1])
    assert len(warned) == (up > 0.0) and all("two datums" in text for text in warned)
    assert sigma >= least


def driven_twice(trajectory, again=100.0):
    return replace(trajectory, **{name: np.tile(getattr(trajectory, name), 2) for name in ("x", "y", "z", "roll", "pitch", "heading")},
                   time=np.concatenate([trajectory.time, trajectory.time + again]))


def aside_of(cloud, trajectory):
    """(N,) m that points lie to the left of the vehicle's way."""
    nearest = cKDTree(np.c_[trajectory.x, trajectory.y]).query(np.c_[cloud.x, cloud.y])[1]
    yaw = np.radians(90.0 - trajectory.heading[nearest])
    return (cloud.y - trajectory.y[nearest]) * np.cos(yaw) - (cloud.x - trajectory.x[nearest]) * np.sin(yaw)


@pytest.mark.parametrize("wide", [0.6, 0.0])
def test_a_street_that_was_rebuilt_between_two_drives_is_told(street, tmp_path, wide):
    """The sidewalk was widened: ground beside the road is 12 cm higher in the second drive."""
    cloud, trajectory = street
    aside = aside_of(cloud, trajectory)
    widened = (aside > 2.0) & (aside < 2.0 + wide)
    paths = [part_of(cloud, tmp_path, "first", slice(None)),
             part_of(cloud, tmp_path, "second", slice(None), gps_time=lambda time: time + 100.0, Z=lambda units: units + 120 * widened)]
    warned, sigma = told(paths, driven_twice(trajectory))
    assert [bool(re.search("other ground at .* rebuilt", text)) for text in warned] == [True] * (wide > 0.0)
    assert sigma == pytest.approx(wide, abs=0.15)


def test_the_clock_of_one_drive_of_two_is_told(street, tmp_path):
    cloud, trajectory = street
    driven, again = driven_twice(trajectory), 100.0
    within = cloud.gps_time < trajectory.time[-1] - 0.7
    paths = [part_of(cloud, tmp_path, "first", within), part_of(cloud, tmp_path, "second", within, gps_time=lambda time: time + again + 0.6)]
    warned, sigma = told(paths, driven)
    assert len(warned) == 1 and "points of 1 of 2 passes do not seem to fit the trajectory" in warned[0]
    assert sigma > 5.0


def test_a_file_without_times_among_others_is_named(street, tmp_path):
    cloud, trajectory = street
    first, second = halves(street, tmp_path)
    timeless = laspy.convert(laspy.read(second), point_format_id=0, file_version="1.2")
    timeless.write(tmp_path / "timeless.laz")
    warned, _ = told([first, tmp_path / "timeless.laz"], trajectory)
    assert any("1 of 2 files" in text and "timeless.laz" in text and "gps_time" in text for text in warned)


def test_a_drive_on_rails_is_no_road(street, tmp_path):
    """A street with ridges either side of the vehicle's own way, as high as rails are."""
    cloud, trajectory = street
    on_rails = np.abs(np.abs(aside_of(cloud, trajectory)) - 0.75) < 0.05
    path = part_of(cloud, tmp_path, "rails", slice(None), Z=lambda units: np.where(on_rails, units + 150, units))
    warned, sigma = told([path], trajectory)
    assert len(warned) == 1 and "rails, 1.5" in warned[0] and "no road" in warned[0]
    assert 0.4 < sigma < 0.8   # that of an edge anywhere between sleepers and formation, not the gauge


def test_a_scanner_without_intensities_beside_another_is_named(street, tmp_path):
    cloud, trajectory = street
    second = cloud.point_source_id == cloud.point_source_id.max()
    warned, _ = told([part_of(cloud, tmp_path, "dark", slice(None), intensity=lambda counts: np.where(second, 0, counts))], trajectory)
    assert len(warned) == 1 and "Scanner 2 of 2 gives one intensity" in warned[0]
