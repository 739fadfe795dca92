"""The accuracy file that POSPac writes beside an SBET tells how far the trajectory may lie beside its true way."""

import numpy as np
import pytest
from lanewright.core.survey.trajectory.reader import read_trajectory
from lanewright.core.survey.trajectory.trajectory import clean_trajectory, reproject_trajectory

TIME = np.arange(0.0, 60.0, 0.1) + 300_000.0


def drive_north(path, waits=0):
    """An SBET of a drive to the north at 10 m/s, after `waits` records at rest."""
    rows = np.zeros((len(TIME), 17))
    rows[:, 0], rows[:, 2], rows[:, 3] = TIME, np.radians(11.5), 500.0
    rows[:, 1] = np.radians(48.1 + np.maximum(np.arange(len(TIME)) - waits, 0) / 111_200.0)
    rows.astype("<f8").tofile(path)
    return path


def accuracy(path, north=0.05, east=0.02, time=TIME):
    rows = np.zeros((len(time), 10))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = time, north, east, 0.06
    rows.astype("<f8").tofile(path)


@pytest.mark.parametrize(("sbet", "beside"), [("sbet_Mission 1.out", "smrmsg_Mission 1.out"), ("SBET_B12.OUT", "smrmsg_b12.out")])
def test_a_drive_to_the_north_is_as_accurate_across_as_its_easting(tmp_path, sbet, beside):
    accuracy(tmp_path / beside)
    found = read_trajectory(drive_north(tmp_path / sbet))
    assert found.sigma_across == pytest.approx(0.02)
    assert f"{beside} gives the accuracy of the trajectory: 0.020 m across, over the way driven." in found.notes


def test_the_accuracy_stays_with_a_trajectory_that_is_reprojected_and_cleaned(tmp_path):
    accuracy(tmp_path / "smrmsg_a.out")
    found = clean_trajectory(reproject_trajectory(read_trajectory(drive_north(tmp_path / "sbet_a.out")), "EPSG:25832")).shifted(18.0)
    assert found.sigma_across == pytest.approx(0.02)


def test_poor_positions_while_the_vehicle_waits_do_not_count(tmp_path):
    accuracy(tmp_path / "smrmsg_a.out", east=np.where(np.arange(len(TIME)) < 290, 3.0, 0.02))
    assert read_trajectory(drive_north(tmp_path / "sbet_a.out", waits=300)).sigma_across == pytest.approx(0.02)


@pytest.mark.parametrize("other", [dict(time=TIME + 90_000.0), dict(east=-1.0), dict(east=np.nan), dict(time=TIME[::-1]), dict(east=5000.0)],
                         ids=["another day", "negative", "no number", "backwards", "kilometres"])
def test_a_file_that_cannot_be_the_accuracy_of_this_drive_is_named_and_not_used(tmp_path, other):
    accuracy(tmp_path / "smrmsg_a.out", **other)
    found = read_trajectory(drive_north(tmp_path / "sbet_a.out"))
    assert found.sigma_across == 0.0 and "smrmsg_a.out is no accuracy file of sbet_a.out and is not used." in found.notes


@pytest.mark.parametrize("beside", ["smrmsg_b.out", "smrmsg_a.txt", "accuracy.out"])
def test_files_of_other_names_are_left_alone(tmp_path, beside):
    accuracy(tmp_path / beside)
    found = read_trajectory(drive_north(tmp_path / "sbet_a.out"))
    assert found.sigma_across == 0.0 and not [note for note in found.notes if "accuracy" in note]


def test_an_accuracy_file_that_is_cut_off_is_not_used(tmp_path):
    accuracy(tmp_path / "smrmsg_a.out")
    (tmp_path / "smrmsg_a.out").write_bytes((tmp_path / "smrmsg_a.out").read_bytes()[:-12])
    assert read_trajectory(drive_north(tmp_path / "sbet_a.out")).sigma_across == 0.0
