"""Surveys as long as a country: towns 1,000 km apart, and a road of 600 km."""

import numpy as np
import pytest
from drives import EAST, NORTH, ahead, bend, chain, drive, joined, surveyed_points, write_cloud
from lanewright.core.survey.density import counted_cubes, cube_density
from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.core.survey.road_points_las import read_road_points, scale_for, write_road_points
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.trajectory.trajectory import Trajectory
from road_layers import extract_road_surface

CRS = "EPSG:32632"
PATH = chain(ahead(80), bend(60, 60), ahead(60))
FAR = 1_000_000.0, 1_500_000.0   # m east and north
TURN = 2**32 * 1e-4              # m after which 32 bits of 0.1 mm begin anew


def moved(trajectory, east, north, later):
    return Trajectory(trajectory.time + later, trajectory.x + east, trajectory.y + north, trajectory.z)


@pytest.fixture(scope="module")
def towns(tmp_path_factory):
    """(trajectory, clouds) of one bend driven in two towns, 1,000 km farther east and 1,500 km farther north an hour later."""
    folder = tmp_path_factory.mktemp("towns")
    here = drive(PATH)
    x, y, z, time = surveyed_points(here)
    clouds = [write_cloud(folder / "here.laz", x, y, z, time, crs=CRS),
              write_cloud(folder / "there.laz", x + FAR[0], y + FAR[1], z, time + 3600.0, crs=CRS)]
    return joined(here, moved(here, *FAR, 3600.0)), clouds, len(x)


@pytest.fixture(scope="module")
def survey(towns):
    trajectory, clouds, _ = towns
    return open_survey(clouds, trajectory)


def points_of(survey, road):
    parts = [survey.section(road, number) for number in survey.store.sections(road)]
    return {name: np.concatenate([getattr(part, name) for part in parts]) for name in ("x", "y", "z", "s", "d", "time")}


def test_every_point_of_both_towns_is_kept(survey, towns):
    _, _, count = towns
    assert survey.counts == dict(read=2 * count, kept=2 * count, outside=0)


def test_the_same_street_a_thousand_kilometres_on_has_the_same_stations_and_coordinates(survey):
    here, there = points_of(survey, 0), points_of(survey, 1)
    for name, apart in (("time", 3600.0), ("x", FAR[0]), ("y", FAR[1]), ("z", 0.0), ("s", 0.0), ("d", 0.0)):
        np.testing.assert_allclose(there[name] - here[name], apart, rtol=0, atol=2e-4, err_msg=name)


def test_blocks_and_sections_change_no_point_of_either_town(survey, towns):
    trajectory, clouds, _ = towns
    other = open_survey(clouds, trajectory, SurveySettings(block=997, section_length=50.0))
    for road in (0, 1):
        one, again = points_of(survey, road), points_of(other, road)
        for name in one:
            np.testing.assert_array_equal(again[name], one[name], err_msg=name)


def test_both_towns_are_kept_where_points_have_no_time(tmp_path):
    here = drive(PATH)
    x, y, z, _ = surveyed_points(here)
    clouds = [write_cloud(tmp_path / f"{k}.laz", x + k * FAR[0], y + k * FAR[1], z, crs=CRS) for k in (0, 1)]
    survey = open_survey(clouds, joined(here, moved(here, *FAR, 3600.0)))
    assert survey.counts["kept"] == 2 * len(x)
    np.testing.assert_allclose(points_of(survey, 1)["x"].mean() - points_of(survey, 0)["x"].mean(), FAR[0], atol=0.01)


def test_what_32_bits_cannot_tell_from_a_street_is_not_on_it(towns, tmp_path):
    trajectory, clouds, count = towns
    x, y, z, time = surveyed_points(drive(PATH))
    some = slice(500)
    x, y, z, time = np.r_[x[some], x[some] + TURN], np.tile(y[some], 2), np.tile(z[some], 2), np.tile(time[some], 2)
    survey = open_survey([*clouds, write_cloud(tmp_path / "astray.laz", x, y, z, time, crs=CRS)], trajectory)
    assert survey.counts == dict(read=2 * count + 1000, kept=2 * count + 500, outside=500)


def test_road_points_of_both_towns_come_back_from_a_file(survey, tmp_path):
    road_points = RoadPoints.of_survey(survey)
    for road in survey.store.roads():
        for number in survey.store.sections(road):
            records = survey.section(road, number).records
            limits = dict(half_width=np.full(len(records), 3500, "u2"), covered=np.zeros(len(records), "u1"))
            road_points.store.put(road, number, records.with_columns(**limits))
    write_road_points(road_points, tmp_path / "road.laz")
    read = read_road_points(tmp_path / "road.laz")
    assert read.roads() == road_points.roads() and len(read) == len(road_points)
    one, whole = road_points.all_points(), read.all_points()
    for name, off in (("x", 5.1e-4), ("y", 5.1e-4), ("z", 5.1e-4), ("s", 0.0), ("d", 0.0)):
        np.testing.assert_allclose(getattr(whole, name), getattr(one, name), rtol=0, atol=off, err_msg=name)
    np.testing.assert_allclose([np.ptp(whole.x) - FAR[0], np.ptp(whole.y) - FAR[1]],
                               [np.ptp(points_of(survey, 0)[name]) for name in "xy"], atol=1e-3)


def test_a_file_has_the_finest_scale_in_which_its_points_fit():
    assert [scale_for(metres) for metres in (0.0, 214_000.0, 215_000.0, 2_000_000.0, 3_000_000.0)] == [1e-4, 1e-4, 1e-3, 1e-3, 1e-2]


def test_cubes_of_two_towns_are_counted_apart(survey):
    towns = [[counted_cubes(survey.section(road, number)) for number in survey.store.sections(road)] for road in (0, 1)]
    both, one = cube_density(towns[0] + towns[1]), cube_density(towns[0])
    assert both.points == 2 * one.points
    assert both.mean == pytest.approx(one.mean, rel=0.05)


def test_the_road_surface_of_both_towns_is_the_same(survey):
    road_points, surface = extract_road_surface(survey)[:2]
    assert len(surface.geometries) > 1
    areas = [sum(g.area for g, row in surface if row["road"] == road) for road in (0, 1)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-3) and areas[0] > 800.0


@pytest.mark.slow
def test_a_road_of_six_hundred_kilometres_keeps_the_points_at_both_its_ends(tmp_path):
    """One drive without a pause, straight on; what is longer than 200 km goes on as another road."""
    length, speed = 600_000.0, 25.0
    time = np.arange(0.0, length / speed, 0.4)
    heading = np.radians(40.0)
    east, north = np.cos(heading), np.sin(heading)
    trajectory = Trajectory(time, EAST + speed * time * east, NORTH + speed * time * north, np.full(len(time), 102.0))
    along = np.concatenate([np.arange(first, first + 100.0, 0.5) for first in (50.0, 399_950.0, length - 150.0)])
    s, d = (c.ravel() for c in np.meshgrid(along, np.arange(-6.0, 6.1, 0.5), indexing="ij"))
    z = 100.0 + 0.12 * (np.abs(d) > 4.0)
    cloud = write_cloud(tmp_path / "road.laz", EAST + s * east - d * north, NORTH + s * north + d * east, z, s / speed, crs=CRS)
    survey = open_survey([cloud], trajectory)
    assert survey.counts["outside"] == 0
    assert len(survey.frame.roads) == 3 and all(road.length < 201_000.0 for road in survey.frame.roads)
    found = np.concatenate([np.c_[points.s + road * 200_000.0, points.d, points.x, points.y] for road, points in
                            ((road, survey.section(road, number)) for road in survey.store.roads() for number in survey.store.sections(road))])
    assert len(found) == len(s)
    true = np.c_[s, d, s * east - d * north, s * north + d * east]
    found, true = (rows[np.lexsort((np.round(rows[:, 1] * 2), np.round(rows[:, 0] * 2)))] for rows in (found, true))
    np.testing.assert_allclose(found[:, 1:], true[:, 1:], rtol=0, atol=2e-3)
    np.testing.assert_allclose(found[:, 0], true[:, 0], rtol=0, atol=0.2)
