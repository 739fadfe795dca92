"""A survey read into the road frame: every point once, on its road, whatever way the files come."""

import re
from dataclasses import replace
from types import SimpleNamespace

import laspy
import numpy as np
import pytest
from drives import EAST, NORTH, ahead, bend, chain, contents, drive, joined, surveyed_points, write_cloud
from heard import Heard
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.progress import RememberedMessages
from lanewright.core.survey.frame.row_table import SigmaAlong
from lanewright.core.survey.open_survey import SurveySettings, open_survey, section_length
from lanewright.core.survey.trajectory.trajectory import Trajectory

CRS = "EPSG:32632"
PATH = chain(ahead(80), bend(60, 60), ahead(60))


@pytest.fixture(scope="module")
def street(tmp_path_factory):
    """(trajectory, points, path of their cloud) of a bend driven once."""
    trajectory = drive(PATH)
    points = surveyed_points(trajectory)
    return trajectory, points, write_cloud(tmp_path_factory.mktemp("street") / "street.laz", *points, crs=CRS)


@pytest.fixture(scope="module")
def surveyed(street):
    """All records of the survey of `street`."""
    return contents(open_survey([street[2]], street[0]))


def test_every_point_gets_the_station_and_offset_it_was_made_with(street, surveyed):
    records = surveyed
    assert len(records) == len(street[1][0])
    offsets = np.unique(np.round(records["d"] * 1e-4 * 2) / 2)
    np.testing.assert_array_equal(offsets, np.arange(-6.0, 6.1, 0.5))
    middle = np.abs(records["s"] * 1e-4 - 110) < 60
    np.testing.assert_allclose(records["d"][middle] * 1e-4, np.round(records["d"][middle] * 2e-4) / 2, atol=0.05)


def test_the_sensor_stands_as_high_above_the_road_as_it_was_mounted(street):
    trajectory, _, path = street
    survey = open_survey([path], trajectory)
    assert survey.sensor_height[0] == pytest.approx(2.0, abs=0.01)
    np.testing.assert_allclose(survey.road_height(0, np.arange(0.0, 190.0)) + survey.frame.origin[2], 100.0, atol=0.01)


def test_the_accuracy_that_the_trajectory_is_told_to_have_is_that_of_every_road(street):
    trajectory, _, path = street
    assert open_survey([path], trajectory).frame.pass_sigma == {}
    assert open_survey([path], trajectory, SurveySettings(trajectory_sigma=0.02)).frame.pass_sigma == {0: SigmaAlong.everywhere(0.02)}
    assert open_survey([path], told := replace(trajectory, sigma_across=0.03)).frame.pass_sigma == {0: SigmaAlong.everywhere(0.03)}
    assert open_survey([path], told, SurveySettings(trajectory_sigma=0.02)).frame.pass_sigma == {0: SigmaAlong.everywhere(0.02)}
    with pytest.raises(RoadExtractionError, match="The accuracy of the trajectory"):
        SurveySettings(trajectory_sigma=-0.02)


@pytest.mark.parametrize("settings", [SurveySettings(block=997, section_length=7.0), SurveySettings(block=3001, section_length=50.0)])
def test_block_size_and_section_length_change_no_point(street, surveyed, settings):
    trajectory, _, path = street
    np.testing.assert_array_equal(contents(open_survey([path], trajectory, settings)), surveyed)


def test_files_and_points_in_any_order_give_the_same_survey(street, surveyed, tmp_path):
    trajectory, points, path = street
    order = np.random.default_rng(8).permutation(len(points[0]))
    parts = [write_cloud(tmp_path / f"part{k}.laz", *(c[rows] for c in points), crs=CRS) for k, rows in enumerate(np.array_split(order, 3))]
    np.testing.assert_array_equal(contents(open_survey(parts, trajectory)), surveyed)
    np.testing.assert_array_equal(contents(open_survey(parts[::-1], trajectory)), surveyed)


def test_a_window_does_not_depend_on_where_sections_are_cut(street):
    trajectory, _, path = street
    windows = [open_survey([path], trajectory, SurveySettings(section_length=length)).window(0, 33.0, 71.5) for length in (20.0, 7.0)]
    for name in ("x", "y", "z", "s", "d"):
        np.testing.assert_array_equal(np.sort(getattr(windows[0], name)), np.sort(getattr(windows[1], name)))
    assert windows[0].s.min() >= 33.0 and windows[0].s.max() < 71.5


def test_moving_the_survey_five_hundred_kilometres_changes_no_station(street, surveyed, tmp_path):
    trajectory, (x, y, z, time), path = street
    moved = Trajectory(trajectory.time, trajectory.x + 500_000, trajectory.y - 500_000, trajectory.z)
    far = write_cloud(tmp_path / "far.laz", x + 500_000, y - 500_000, z, time, crs=CRS)
    here, there = surveyed, contents(open_survey([far], moved))
    for name in ("x", "y", "z", "s", "d"):
        assert np.abs(here[name].astype(int) - there[name]).max() <= 1, "0.1 mm of rounding"


def test_driving_the_other_way_swaps_the_sides(street, tmp_path):
    trajectory, (x, y, z, _), path = street
    back = drive(PATH[::-1])
    rows = np.argmin(np.hypot(x[:, None] - back.x[::10], y[:, None] - back.y[::10]), axis=1) * 10
    other = write_cloud(tmp_path / "back.laz", x, y, z, back.time[rows], crs=CRS)
    along, against = open_survey([path], trajectory), open_survey([other], back)
    place = lambda survey: {(a, b): d for a, b, d in zip(*np.rint(np.asarray(survey.window(0, 30, 170).records)[["x", "y", "d"]].tolist()).T)}  # noqa: E731
    first, second = place(along), place(against)
    shared = first.keys() & second.keys()
    assert len(shared) > 10_000
    assert max(abs(first[p] + second[p]) for p in shared) < 200, "2 cm, where the two lines were smoothed from either end"


def test_two_passes_over_a_street_share_its_road_and_keep_their_numbers(tmp_path):
    there, back = drive(PATH), drive(PATH[::-1] + [0.0, 3.0], start=3000.0)
    first, second = surveyed_points(there), surveyed_points(back)
    path = write_cloud(tmp_path / "twice.laz", *(np.r_[a, b] for a, b in zip(first, second)), crs=CRS)
    survey = open_survey([path], joined(there, back))
    records = contents(survey)
    assert survey.store.roads() == [0] and len(survey.sensor_height) == 2
    np.testing.assert_array_equal(np.unique(records["pass_number"]), [0, 1])
    assert (records["time"][records["pass_number"] == 1] >= 3000.0).all()


def test_a_place_seen_from_two_roads_belongs_to_the_pass_that_measured_it(tmp_path):
    """Two carriageways 15 m apart: points between them follow the time, not the nearest line."""
    here, there = drive(chain(ahead(150))), drive(chain(ahead(150)) + [0.0, 15.0], start=3000.0)
    x, y, z, time = surveyed_points(here, half_width=12.0)
    survey = open_survey([write_cloud(tmp_path / "a.laz", x, y, z, time, crs=CRS)], joined(here, there))
    road = next(p.road for p in survey.frame.passes if p.time[0] < 2000)
    assert survey.store.roads() == [road] and len(contents(survey)) == len(x)


def test_without_gps_time_each_point_goes_to_the_nearest_foot(street, surveyed, tmp_path):
    trajectory, (x, y, z, _), _ = street
    survey = open_survey([write_cloud(tmp_path / "plain.las", x, y, z, point_format=0, version="1.2", crs=CRS)], trajectory)
    assert not survey.has_time
    assert len(contents(survey)) == pytest.approx(len(surveyed), rel=0.01)
    assert survey.sensor_height[0] == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize("lacking, said", [("points", "The point cloud has no gps_time that changes"), ("trajectory", "The trajectory has no time")])
def test_several_passes_without_time_are_warned_of_by_the_name_of_what_lacks_it(tmp_path, lacking, said):
    there, back = drive(PATH), drive(PATH[::-1] + [0.0, 3.0], start=3000.0)
    both = [np.r_[a, b] for a, b in zip(surveyed_points(there), surveyed_points(back))]
    driven = replace(joined(there, back), has_time=lacking != "trajectory")
    heard = Heard()
    open_survey([write_cloud(tmp_path / "twice.laz", *both[:3 if lacking == "points" else 4], crs=CRS)], driven, progress=heard)
    assert any(re.search(f"{said}.*Driven 2 times over 1 road.*passes are mixed.*Export points and trajectory", text) for text in heard.warned)


def test_a_file_whose_points_all_have_one_time_is_read_as_one_without_times(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    half, heard = np.arange(len(x)) % 2 == 0, Heard()
    survey = open_survey([write_cloud(tmp_path / f"{name}.laz", x[part], y[part], z[part], times, crs=CRS) for name, part, times in
                          (("timed", half, time[half]), ("stopped", ~half, np.full((~half).sum(), time.mean())))], trajectory, progress=heard)
    assert not survey.has_time and len(contents(survey)) == pytest.approx(len(x), rel=0.01)
    assert any(re.search("1 of 2 files, such as .*stopped.laz, have no gps_time that changes", text) for text in heard.warned)


@pytest.mark.parametrize("files, time_of, has_time", [(8, np.mean, True), (30, lambda times: 0.0, False)])
def test_frames_with_a_time_each_have_times_and_small_tiles_that_share_one_have_none(street, tmp_path, files, time_of, has_time):
    trajectory, (x, y, z, time), _ = street
    parts = enumerate(np.array_split(np.argsort(time, kind="stable"), files))
    clouds = [write_cloud(tmp_path / f"{k}.laz", x[part], y[part], z[part], np.full(len(part), time_of(time[part])), crs=CRS) for k, part in parts]
    assert open_survey(clouds, trajectory).has_time == has_time


@pytest.mark.parametrize("height", [0.0, 0.45, -0.3])
def test_a_line_on_the_road_is_refused_as_a_trajectory_with_a_way_on(street, height):
    trajectory, _, path = street
    with pytest.raises(RoadExtractionError, match="above the road.*a line on the road.*choose the trajectory"):
        open_survey([path], replace(trajectory, z=trajectory.z - 2.0 + height))


def test_a_scanner_channel_tells_the_scanners_apart(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    channel = np.arange(len(x)) % 2 + 1
    survey = open_survey([write_cloud(tmp_path / "two.laz", x, y, z, time, crs=CRS, channel=channel)], trajectory)
    assert (survey.scanner_field, survey.scanners) == ("scanner_channel", [1, 2])
    np.testing.assert_array_equal(np.unique(contents(survey)["scanner"]), [0, 1])


def test_a_cloud_in_degrees_is_refused(street, tmp_path):
    trajectory, points, _ = street
    with pytest.raises(RoadExtractionError, match="geographic"):
        open_survey([write_cloud(tmp_path / "bad.laz", *points, crs="EPSG:4326")], trajectory)


@pytest.mark.parametrize("other_crs", [25833, 31467], ids=["the next zone", "an old datum, a hundred metres off"])
def test_a_trajectory_in_another_crs_is_brought_to_the_cloud(street, surveyed, other_crs):
    from pyproj import Transformer

    trajectory, points, path = street
    x, y = Transformer.from_crs(32632, other_crs, always_xy=True).transform(trajectory.x, trajectory.y)
    other = Trajectory(trajectory.time, x, y, trajectory.z, crs=f"EPSG:{other_crs}")
    survey = open_survey([path], other)
    assert len(contents(survey)) == len(points[0])
    np.testing.assert_allclose(contents(survey)["d"], surveyed["d"], atol=50)


def test_a_trajectory_elsewhere_is_refused_with_both_extents(street):
    trajectory, _, path = street
    away = Trajectory(trajectory.time, trajectory.x + 5_000, trajectory.y, trajectory.z)
    with pytest.raises(RoadExtractionError, match="does not run through the point cloud.*carries no CRS"):
        open_survey([path], away)


def test_a_trajectory_of_another_hour_is_refused_with_both_spans(street):
    trajectory, _, path = street
    with pytest.raises(RoadExtractionError, match="does not cover the scan in time"):
        open_survey([path], trajectory.shifted(7200.0))


def test_a_trajectory_of_seconds_of_the_week_is_brought_to_adjusted_time(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    start = 318_204_000.0
    cloud = write_cloud(tmp_path / "adjusted.laz", x, y, z, time - 1000 + start, crs=CRS)
    survey = open_survey([cloud], trajectory.shifted((start + 1e9) % 604800 - 1000))
    assert len(contents(survey)) == len(x)


def test_a_scan_past_the_end_of_the_gps_week_is_one_drive(street, surveyed, tmp_path):
    trajectory, (x, y, z, time), path = street
    week = lambda t: (t - 1000.0 + 604_790.0) % 604_800.0  # noqa: E731
    cloud = write_cloud(tmp_path / "week.laz", x, y, z, week(time), crs=CRS, adjusted=False)
    survey = open_survey([cloud], Trajectory(week(trajectory.time), trajectory.x, trajectory.y, trajectory.z))
    np.testing.assert_array_equal(contents(survey)[["s", "d"]], surveyed[["s", "d"]])


def test_points_far_above_and_below_the_road_are_left_out(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    high = np.r_[z, z[::50] + 9.0, z[::50] - 9.0]
    x, y, time = (np.r_[column, column[::50], column[::50]] for column in (x, y, time))
    cloud = write_cloud(tmp_path / "ghosts.laz", x, y, high, time, crs=CRS)
    survey = open_survey([cloud], trajectory)
    assert survey.counts["kept"] == len(z) and survey.counts["outside"] == 2 * len(z[::50])


def test_a_corridor_that_makes_no_sense_is_refused():
    with pytest.raises(RoadExtractionError, match="corridor is 2.0 m"):
        SurveySettings(corridor=2.0)


def test_the_cloud_covers_only_part_of_a_long_drive(tmp_path):
    long_drive = drive(chain(ahead(2000)))
    part = long_drive.rows((long_drive.time > 1080) & (long_drive.time < 1100))
    points = surveyed_points(part)
    survey = open_survey([write_cloud(tmp_path / "part.laz", *points, crs=CRS)], long_drive)
    s = contents(survey)["s"] * 1e-4
    assert len(s) == len(points[0]) and 795 < s.min() and s.max() < 1005
    assert (EAST, NORTH) == tuple(np.floor([long_drive.x.min(), long_drive.y.min()]))


def wooded(points, seed=6):
    """The points with scatter from 8 m below to 8 m above the street, as of ditches, trees and ghosts."""
    x, y, z, time = points
    up = np.random.default_rng(seed).uniform(-8.0, 8.0, len(x) // 2)
    rows = np.arange(len(up))
    return np.r_[x, x[rows]], np.r_[y, y[rows]], np.r_[z, z[rows] + up], np.r_[time, time[rows]]


def test_what_is_kept_near_the_limits_of_height_does_not_depend_on_which_file_came_first(street, tmp_path):
    trajectory, points, _ = street
    scattered = wooded(points)
    order = np.argsort(scattered[2] + 0.01 * np.arange(len(scattered[2])) % 7)  # the lowest first
    halves = [write_cloud(tmp_path / f"half{k}.laz", *(c[rows] for c in scattered), crs=CRS) for k, rows in enumerate(np.array_split(order, 2))]
    one, other = open_survey(halves, trajectory), open_survey(halves[::-1], trajectory, SurveySettings(block=500, section_length=7.0))
    assert one.sensor_height == other.sensor_height
    np.testing.assert_array_equal(contents(one), contents(other))


def test_trees_and_a_bridge_above_the_track_do_not_lift_the_road(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    deck = np.flatnonzero(time < np.quantile(time, 0.45))
    cloud = write_cloud(tmp_path / "bridge.laz", np.r_[x, np.repeat(x[deck], 2)], np.r_[y, np.repeat(y[deck], 2)],
                        np.r_[z, np.repeat(z[deck], 2) + np.random.default_rng(1).uniform(4.6, 6.5, 2 * len(deck))],
                        np.r_[time, np.repeat(time[deck], 2)], crs=CRS)
    assert open_survey([cloud], trajectory).sensor_height[0] == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize("undulation", [0.0, 46.3, -38.0])
def test_ellipsoidal_and_orthometric_heights_may_be_mixed(street, tmp_path, undulation):
    trajectory, (x, y, z, time), _ = street
    survey = open_survey([write_cloud(tmp_path / "levelled.laz", x, y, z - undulation, time, crs=CRS)], trajectory)
    assert survey.sensor_height[0] == pytest.approx(2.0 + undulation, abs=0.01)
    assert len(contents(survey)) == len(x)


def test_two_vehicles_of_different_height_agree_on_the_road(tmp_path):
    van, car = drive(PATH, height=2.6), drive(PATH, height=1.7, start=3000.0)
    both = [np.r_[a, b] for a, b in zip(surveyed_points(van), surveyed_points(car))]
    survey = open_survey([write_cloud(tmp_path / "two.laz", *both, crs=CRS)], joined(van, car.rows(slice(0, 800))))
    np.testing.assert_allclose([survey.sensor_height[0], survey.sensor_height[1]], [2.6, 1.7], atol=0.01)
    np.testing.assert_allclose(survey.road_height(0, np.linspace(-5, 190, 99)) + survey.frame.origin[2], 100.0, atol=0.01)




@pytest.mark.parametrize("unit, warned", [(1.0, False), (0.3048, True)])
def test_heights_of_a_trajectory_in_feet_are_warned_of_where_the_road_climbs(tmp_path, unit, warned):
    """A level road in another datum would hide it and do no harm: the sensor's height above the road is found out."""
    driven = drive(PATH)
    hill = 3.0 * np.sin(np.linspace(0.0, np.pi, len(driven)))
    driven = replace(driven, z=driven.z + hill)
    x, y, z, time = surveyed_points(driven)
    points = x, y, z + np.interp(time, driven.time, hill), time
    heard = Heard()
    open_survey([write_cloud(tmp_path / "hill.laz", *points, crs=CRS)], replace(driven, z=driven.z / unit), progress=heard)
    assert [bool(re.search("does not keep to one height above the road.*may be in feet", text)) for text in heard.warned] == [True] * warned


@pytest.mark.parametrize("unit, crs, warned", [(0.3048, None, True), (0.3048, CRS, False), (1.0, None, False)])
def test_a_street_all_in_feet_that_no_crs_tells_of_is_warned_of(street, tmp_path, unit, crs, warned):
    trajectory, (x, y, z, time), _ = street
    around = x[0], y[0]
    feet = [(around[0] + (x - around[0]) / unit), (around[1] + (y - around[1]) / unit), z / unit, time]
    driven = replace(trajectory, x=around[0] + (trajectory.x - around[0]) / unit, y=around[1] + (trajectory.y - around[1]) / unit,
                     z=trajectory.z / unit)
    heard = Heard()
    open_survey([write_cloud(tmp_path / "feet.laz", *feet, crs=crs)], driven, progress=heard)
    assert any(re.search("as if cloud and trajectory were in feet.*Set the parameter CRS", text) for text in heard.warned) == warned
    assert not any("The times of the points" in text for text in heard.warned)


@pytest.mark.parametrize("late, warned", [
    (0.0, None), (0.3, None), (2.0, "20 m before that place, about 2.0 s"), (-1.5, "15 m past that place, about 1.5 s"),
])
def test_times_that_run_against_the_trajectory_are_warned_of_once(street, late, warned):
    trajectory, _, path = street
    heard = Heard()
    open_survey([path], replace(trajectory, time=trajectory.time + late), progress=heard)
    said = [text for text in heard.warned if "do not seem to fit" in text]
    assert len(said) == (warned is not None) and all(warned in text for text in said)


def test_a_scanner_that_sees_far_ahead_and_behind_in_every_turn_keeps_time(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    seen = time + np.random.default_rng(2).uniform(-2.5, 2.5, len(time))
    heard = Heard()
    seen = np.clip(seen, trajectory.time[0], trajectory.time[-1])
    open_survey([write_cloud(tmp_path / "spinning.laz", x, y, z, seen, crs=CRS)], trajectory, progress=heard)
    assert not [text for text in heard.warned if "do not seem to fit" in text]


@pytest.mark.parametrize("own, given, says", [
    (None, "", "carries no CRS.*parameter CRS"), (None, CRS, None), (CRS, "", None), (CRS, CRS, None),
    (CRS, "EPSG:25833", "zone 32N.*zone 33N.*not used"),
])
def test_the_user_hears_what_became_of_the_crs(street, tmp_path, own, given, says):
    trajectory, points, _ = street
    heard = Heard()
    open_survey([write_cloud(tmp_path / "c.laz", *points, crs=own)], trajectory, SurveySettings(crs=given), heard)
    assert len(heard.warned) == (says is not None) and all(re.search(says, text) for text in heard.warned)


def test_degrees_and_a_cloud_without_crs_cannot_be_brought_together(street, tmp_path):
    from pyproj import Transformer

    trajectory, points, _ = street
    lon, lat = Transformer.from_crs(32632, 4326, always_xy=True).transform(trajectory.x, trajectory.y)
    cloud = write_cloud(tmp_path / "bare.laz", *points)
    degrees = Trajectory(trajectory.time, lon, lat, trajectory.z, crs="EPSG:4326")
    with pytest.raises(RoadExtractionError, match="carries no CRS, and the trajectory is in WGS 84.*parameter CRS"):
        open_survey([cloud], degrees)
    assert open_survey([cloud], degrees, SurveySettings(crs=CRS)).counts["kept"] == len(points[0])


def test_exchanged_coordinates_are_recognised(street):
    trajectory, _, path = street
    with pytest.raises(RoadExtractionError, match="x and y are exchanged.*export the cloud"):
        open_survey([path], Trajectory(trajectory.time, trajectory.y, trajectory.x, trajectory.z))


@pytest.mark.parametrize("foot", [0.3048, 1200 / 3937])
def test_one_in_feet_and_the_other_in_metres_is_recognised(street, tmp_path, foot):
    trajectory, (x, y, z, time), _ = street
    in_feet = write_cloud(tmp_path / "feet.laz", x / foot, y / foot, z / foot, time)
    with pytest.raises(RoadExtractionError, match="The cloud's coordinates are the trajectory's in feet"):
        open_survey([in_feet], trajectory)
    in_metres = write_cloud(tmp_path / "metres.laz", x, y, z, time)
    with pytest.raises(RoadExtractionError, match="The trajectory's coordinates are the cloud's in feet"):
        open_survey([in_metres], Trajectory(trajectory.time, trajectory.x / foot, trajectory.y / foot, trajectory.z / foot))


@pytest.mark.parametrize(("rows", "said"), [(slice(5, 6), 1), (slice(0, 0), 0)])
def test_a_trajectory_of_one_position_is_told_as_that(street, rows, said):
    trajectory, _, path = street
    with pytest.raises(RoadExtractionError, match=rf"has {said} usable position\(s\) over 0.0 m"):
        open_survey([path], trajectory.rows(rows))


def test_a_copy_among_the_files_counts_once(street, surveyed, tmp_path):
    trajectory, points, path = street
    heard = Heard()
    survey = open_survey([path, write_cloud(tmp_path / "copy.laz", *points, crs=CRS)], trajectory, progress=heard)
    np.testing.assert_array_equal(contents(survey), surveyed)
    assert ["copy.laz holds the same points as" in text for text in heard.warned] == [True]


def test_points_without_a_time_are_counted_aloud(street, tmp_path):
    trajectory, (x, y, z, time), _ = street
    heard, time = Heard(), np.where(np.arange(len(time)) % 4 == 0, np.nan, time)
    survey = open_survey([write_cloud(tmp_path / "nan.laz", x, y, z, time, crs=CRS)], trajectory, progress=heard)
    lost = np.count_nonzero(np.isnan(time))
    assert survey.counts["kept"] == len(x) - lost and f"{lost:,} of {len(x):,} points were left out" in heard.warned[0]


@pytest.mark.parametrize("points, metres", [(80_000, 5.0), (20_000, 10.0), (8_400, 25.0), (100, 25.0)])
def test_sections_are_as_long_as_hold_some_hundred_thousand_points(points, metres):
    roads = [SimpleNamespace(length=1500.0), SimpleNamespace(length=500.0)]
    files = [SimpleNamespace(count=points * 500), SimpleNamespace(count=points * 1500)]
    assert section_length(files, SimpleNamespace(roads=roads)) == metres


WEEK_OF_ADJUSTED = 604800.0 * 2179 - 1e9   # adjusted GPS seconds at which a week begins


@pytest.mark.parametrize("shift", [WEEK_OF_ADJUSTED, 1e9], ids=["seconds of the week", "GPS seconds"])
def test_files_of_one_drive_that_count_time_in_two_ways_are_refused_by_name(tmp_path, shift):
    at = WEEK_OF_ADJUSTED + 200_000.0
    trajectory = drive(PATH, start=at)
    x, y, z, time = surveyed_points(trajectory)
    late = time > at + 8
    first = write_cloud(tmp_path / "early.laz", *(c[~late] for c in (x, y, z, time)), crs=CRS)
    other_time = time + 1e9 if shift == 1e9 else time - shift
    second = write_cloud(tmp_path / "late.laz", *(c[late] for c in (x, y, z, other_time)), crs=CRS, adjusted=False)
    with pytest.raises(RoadExtractionError, match="early.laz runs from .*late.laz, of the same drive.*one kind of gps_time"):
        open_survey([first, second], trajectory)


def test_a_file_of_another_day_is_left_out_and_the_gaps_of_the_trajectory_are_told(street, tmp_path):
    trajectory, (x, y, z, time), path = street
    tomorrow = write_cloud(tmp_path / "tomorrow.laz", x, y, z, time + 86_400.0, crs=CRS)
    listener = RememberedMessages()
    survey = open_survey([path, tomorrow], trajectory, progress=listener)
    assert survey.counts["kept"] == len(x)
    said, = listener.warnings
    assert f"{len(x):,} of {2 * len(x):,} points were left out" in said and "runs from 1000.0 s to 10" in said and "not from" not in said


def test_a_gap_in_the_trajectory_is_told_with_its_times(street):
    trajectory, _, path = street
    away = (trajectory.time > 1006) & (trajectory.time < 1012)
    listener = RememberedMessages()
    open_survey([path], Trajectory(*(getattr(trajectory, name)[~away] for name in ("time", "x", "y", "z"))), progress=listener)
    assert any("not from 1006.0 s to 1012.0 s" in warning for warning in listener.warnings)


@pytest.mark.parametrize("kind, says", [("feet", "in feet"), ("exchanged", "x and y are exchanged"), ("degrees", "look like degrees"),
                                        ("zone", "two zones")])
def test_a_file_with_coordinates_of_another_kind_than_the_others_is_refused_by_name(tmp_path, kind, says):
    trajectory = drive(PATH)
    x, y, z, time = surveyed_points(trajectory)
    late = time > 1010
    first = write_cloud(tmp_path / "early.laz", *(c[~late] for c in (x, y, z, time)), crs=CRS)
    places = {"feet": (x / 0.3048, y / 0.3048, z / 0.3048), "exchanged": (y, x, z), "degrees": (9 + x * 1e-9, 48 + y * 1e-9, z),
              "zone": (x - 430_000.0, y + 20_000.0, z)}[kind]
    second = write_cloud(tmp_path / "late.laz", *(c[late] for c in (*places, time)))
    with pytest.raises(RoadExtractionError, match=f"late.laz are of another kind.*{says}"):
        open_survey([first, second], trajectory)


def test_a_file_beside_the_drive_is_no_mistake(street, surveyed, tmp_path):
    trajectory, (x, y, z, time), path = street
    listener = RememberedMessages()
    beside = write_cloud(tmp_path / "beside.laz", x + 3000.0, y, z, time, crs=CRS)
    np.testing.assert_array_equal(contents(open_survey([path, beside], trajectory, progress=listener)), surveyed)
    assert listener.warnings == [] and any("1 of 2 files lie beside" in text for _, text in listener.messages)


@pytest.mark.parametrize("crss", [("EPSG:32632+3855", "EPSG:32632+5773"), ("EPSG:32632", "EPSG:32632+3855", "EPSG:32632+5773")])
def test_files_that_say_heights_of_two_kinds_are_refused(street, tmp_path, crss):
    trajectory, points, _ = street
    paths = [write_cloud(tmp_path / f"{k}.laz", *(c[k::len(crss)] for c in points), crs=crs) for k, crs in enumerate(crss)]
    with pytest.raises(RoadExtractionError, match="heights of different kinds: EGM2008 height and, in .*EGM96 height"):
        open_survey(paths, trajectory)
    assert open_survey(paths[:-1], trajectory).store.count


@pytest.mark.parametrize("share, warned", [(0.1, False), (0.6, True)])
def test_a_cloud_of_which_much_is_withheld_or_noise_is_warned_of(street, tmp_path, share, warned):
    trajectory, points, _ = street
    cloud = laspy.read(write_cloud(tmp_path / "street.laz", *points, crs=CRS))
    cloud.withheld = np.arange(len(points[0])) < share * len(points[0])
    cloud.write(tmp_path / "street.laz")
    listener = RememberedMessages()
    open_survey([tmp_path / "street.laz"], trajectory, progress=listener)
    assert [("withheld" in text, kind) for kind, text in listener.messages if "noise" in text] == [(True, "warn" if warned else "info")]
