"""A file that holds the points of another one of the survey is left out, and points that files share count once."""

import numpy as np
import pytest
from drives import write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.las.reader import read_headers
from lanewright.core.survey.las.samples import check_measured_once, distinct_rows, may_overlap, without_copies


def cloud(path, order=slice(None), moved=0.0, later=0.0, **other):
    """A cloud of 500 places with times."""
    rng = np.random.default_rng(4)
    x, y, z = rng.uniform(0.0, 10.0, (3, 500))
    middle = slice(200, 300)   # where a cloud may differ and keep its bounds
    x[middle] = np.clip(x[middle] + moved, 0.01, 9.9)
    time = np.linspace(1000.0, 1010.0, 500) + later
    return write_cloud(path, *(v[order] for v in (x + 600_000.0, y + 2_700_000.0, z, time)), **other)


def kept(*paths):
    """Which of the paths are kept, and what is said of the others."""
    said = []
    files = without_copies(read_headers(paths), said.append)
    return [paths.index(file.path) for file in files], said


@pytest.mark.parametrize("copied", [{}, {"order": slice(None, None, -1)}, {"point_format": 1, "version": "1.2"}],
                         ids=["as it is", "in another order", "in another format"])
def test_a_copy_is_left_out_and_named(tmp_path, copied):
    first, other, copy = cloud(tmp_path / "a.laz"), cloud(tmp_path / "b.laz", moved=1.0), cloud(tmp_path / "copy.las", **copied)
    numbers, said = kept(first, other, copy)
    assert numbers == [0, 1] and len(said) == 1 and "copy.las holds the same points as" in said[0] and "a.laz" in said[0]


@pytest.mark.parametrize("differing", [{"moved": 0.001}, {"later": 60.0}, {"intensity": 900}], ids=["place", "time", "intensity"])
def test_points_that_differ_in_anything_are_others(tmp_path, differing):
    assert kept(cloud(tmp_path / "a.laz"), cloud(tmp_path / "b.laz", **differing)) == ([0, 1], [])


def test_of_points_that_come_again_the_first_are_taken():
    time = np.array([5.0, 3.0, 5.0, 5.0, 3.0])
    place = np.array([[1, 2, 3], [4, 5, 6], [1, 2, 3], [1, 2, 4], [4, 5, 6]], np.int32)
    assert distinct_rows(time, place).tolist() == [0, 1, 3]
    assert distinct_rows(time[:0], place[:0]).tolist() == []


@pytest.mark.parametrize(("east", "share"), [(0.0, True), (9.0, True), (12.0, False)])
def test_files_may_overlap_where_their_bounds_do(tmp_path, east, share):
    a = write_cloud(tmp_path / "a.laz", *np.array([[0.0, 10.0], [0.0, 10.0], [0.0, 1.0], [1.0, 2.0]]))
    b = write_cloud(tmp_path / "b.laz", *np.array([[east, east + 10.0], [0.0, 10.0], [0.0, 1.0], [1.0, 2.0]]))
    assert may_overlap(read_headers([a, b])) is share
    assert not may_overlap(read_headers([a]))


def beams(count, of_turn=64, seed=4):
    """(N,) times and (N, 3) places of a head whose 64 beams measure at one time."""
    rng = np.random.default_rng(seed)
    return np.repeat(np.arange(count // of_turn) * 5e-5, of_turn), rng.uniform(-20.0, 20.0, (count // of_turn * of_turn, 3))


@pytest.mark.parametrize("moved", [(0.5, 0.0, 0.0), (-0.3, 0.4, 0.0), (0.0, 0.1, 1.2)])
@pytest.mark.parametrize("share", [1.0, 0.1], ids=["all", "where tiles overlap"])
def test_one_drive_that_was_exported_in_two_datums_is_refused(moved, share):
    rng = np.random.default_rng(5)
    time, place = np.arange(20_000) * 1e-5, rng.uniform(-20.0, 20.0, (20_000, 3))
    again = rng.permutation(len(time))[:int(share * len(time))]
    order = rng.permutation(len(time) + len(again))
    both = np.r_[time, time[again]][order], np.concatenate([place, place[again] + moved + rng.normal(0.0, 0.002, (len(again), 3))])[order]
    with pytest.raises(RoadExtractionError, match="given twice.*two datums"):
        check_measured_once(*both)


def test_points_that_share_their_time_with_others_were_not_given_twice():
    check_measured_once(*beams(20_000))
    time, place = beams(20_000, of_turn=2)
    check_measured_once(time, place)
    with pytest.raises(RoadExtractionError, match="100 % of the points were given twice"):
        check_measured_once(np.r_[time, time], np.concatenate([place, place + [0.0, 0.5, 0.0]]))
    # a copy whose coordinates were rounded in another way lies where it is
    check_measured_once(np.r_[time, time], np.concatenate([place, np.round(place, 2)]))
