"""Two scanners in one stream of points, without a field that distinguishes them."""

from dataclasses import replace

import numpy as np
import pytest
from drives import write_cloud
from heard import Heard
from lanewright.core.survey.estimation.adjustment import told_apart
from lanewright.core.survey.estimation.estimate import estimate_trajectory
from lanewright.core.survey.open_survey import open_survey
from mirror_drives import Mirror, mirror_drive

BUTTERFLY = (Mirror(-45.0, -20.0, (0.0, 0.32, 0.0)), Mirror(45.0, -20.0, (0.0, -0.32, 0.0), ahead=0.55))
UNEQUAL = (Mirror(-45.0, -20.0, (0.0, 0.32, 0.0), pulses=40_000.0), Mirror(45.0, -20.0, (0.0, -0.32, 0.0), pulses=10_000.0, ahead=0.55))
SPARSE = tuple(replace(mirror, pulses=10_000.0) for mirror in BUTTERFLY)
THREE = (*SPARSE, Mirror(0.0, 10.0, (-1.0, 0.0, -0.4), pulses=10_000.0, ahead=0.1))


@pytest.fixture(scope="module")
def street():
    return mirror_drive(BUTTERFLY)


def test_their_trajectory_is_that_of_both(tmp_path, street):
    found = estimate_trajectory([street.write(tmp_path / "cloud.las", merged=True)])
    assert len(found.scanners) == 2 and any("no field" in note for note in found.notes)
    _, left, up = street.errors(found.trajectory)
    assert np.sqrt(np.mean(left**2)) < 0.03 and np.sqrt(np.mean(up**2)) < 0.02
    np.testing.assert_allclose(np.sort(np.degrees(found.adjusted.poses.turn)), [-45.0, 45.0], atol=0.3)


@pytest.mark.parametrize("mirrors", [UNEQUAL, tuple(Mirror(turn, -25.0, (0.0, -turn / 100.0, 0.0), rate, 10_000.0) for turn, rate in
                                                  ((-50.0, 100.0), (0.0, 60.0), (50.0, 100.0)))],
                         ids=["one of few pulses", "a fan of which one turns more slowly"])
def test_as_many_scanners_as_there_are_directions_of_scan_lines_are_told_apart(tmp_path, mirrors):
    street = mirror_drive(mirrors)
    found = estimate_trajectory([street.write(tmp_path / "cloud.las", merged=True)])
    assert told_apart(len(mirrors)) in found.notes
    on_map(street, mirrors, found)


def on_map(street, mirrors, found):
    """Whether the trajectory is that of the middle of the mirrors, within centimetres."""
    ahead, left, up = street.errors(found.trajectory)
    middle = np.mean([mirror.lever for mirror in mirrors], axis=0)
    for off, arm in zip((ahead, left, up), middle):
        assert np.sqrt(np.mean((off - arm) ** 2)) < 0.03


@pytest.mark.parametrize("ids", ["tiles", "nothing", "two of three scanners"])
def test_a_field_that_does_not_number_the_scanners_is_not_believed(tmp_path, ids):
    mirrors = THREE if ids == "two of three scanners" else SPARSE
    street = mirror_drive(mirrors)
    number = {"tiles": (street.place[:, 0] // 8).astype(int) % 20, "nothing": np.random.default_rng(1).integers(0, 4, len(street.time)),
              "two of three scanners": street.scanner // 2}[ids]
    path = write_cloud(tmp_path / "cloud.las", *(street.place + [500_000.0, 5_400_000.0, 100.0]).T, street.time, source=1 + number)
    found = estimate_trajectory([path])
    assert told_apart(len(mirrors)) in found.notes and not any("in feet" in note for note in found.cloud_notes)
    on_map(street, mirrors, found)


def test_a_survey_counts_three_scanners(tmp_path):
    street = mirror_drive(THREE)
    survey = open_survey([street.write(tmp_path / "cloud.las", merged=True)], street.trajectory())
    assert survey.scanners == [0, 1, 2]


@pytest.mark.parametrize("order", ["one scanner after the other", "by time"])
def test_a_survey_tells_them_apart_and_says_so(tmp_path, street, order):
    which = np.argsort(street.time, kind="stable") if order == "by time" else slice(None)
    heard = Heard()
    survey = open_survey([street.write(tmp_path / "cloud.las", which, merged=True)], street.trajectory(), progress=heard)
    assert survey.scanners == [0, 1] and told_apart(2) in heard.said
    rows = np.random.default_rng(1).choice(len(street.time), 5000, replace=False)
    place = np.stack(survey.frame.to_local(*(street.place[rows] + [500_000.0, 5_400_000.0, 100.0]).T), axis=1)
    same = np.mean(survey.splitter.numbers(street.time[rows], place) == street.scanner[rows])
    assert max(same, 1 - same) > 0.999
    numbers = [survey.section(0, number).scanner for number in survey.store.sections(0)]
    assert 0.3 < np.mean(np.concatenate(numbers)) < 0.7


def test_one_scanner_stays_one(tmp_path):
    drive = mirror_drive([Mirror(-40.0, -12.0)])
    survey = open_survey([drive.write(tmp_path / "cloud.las")], drive.trajectory())
    assert survey.splitter is None and len(survey.scanners) == 1


def test_points_without_scan_lines_stay_one_scanner(tmp_path, street):
    rng = np.random.default_rng(3)
    x, y = rng.uniform(0, 60, 60_000), rng.uniform(-6, 4, 60_000)
    time = np.sort(rng.uniform(5000.0, 5006.0, 60_000))
    path = write_cloud(tmp_path / "cloud.las", x + 500_000, y + 5_400_000, 100.0 + rng.normal(0, 0.01, len(x)), time, crs="EPSG:32632")
    assert open_survey([path], street.trajectory()).splitter is None
