"""Reading trajectories in the dress they come in."""

import time
import warnings
from dataclasses import replace

import numpy as np
import pytest
from drives import EAST, NORTH, ahead, bend, chain, drive
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.columns import columns_by_role, rough_metres
from lanewright.core.survey.trajectory.reader import read_trajectory, trajectory_from_columns
from lanewright.core.survey.trajectory.trajectory import Trajectory, reproject_trajectory

COLUMNS = ("time", "x", "y", "z", "roll", "pitch", "heading")
FORMAT = {"time": "%.6f", "x": "%.4f", "y": "%.4f", "z": "%.4f", "roll": "%.6f", "pitch": "%.6f", "heading": "%.6f"}


def street():
    """A drive with attitude over a bend: degrees, heading clockwise from north."""
    driven = drive(chain(ahead(120), bend(60, 80), ahead(60)), start=318_204_000.0, rate=20.0)
    heading = np.degrees(np.arctan2(np.gradient(driven.x), np.gradient(driven.y))) % 360
    wave = np.arange(len(driven)) / 40
    return Trajectory(driven.time, driven.x, driven.y, driven.z + 0.3 * np.sin(wave / 7), 1.2 * np.sin(wave), 0.7 * np.cos(wave), heading)


def write(path, trajectory, columns=COLUMNS, delimiter=",", header=None, above="", decimal=".", factor=1.0):
    """A text file of some columns; `factor` multiplies the angles."""
    rows = zip(*(np.char.mod(FORMAT[c], getattr(trajectory, c) * (factor if c in COLUMNS[4:] else 1.0)) for c in columns))
    header = delimiter.join(columns) if header is None else header
    text = above + (header + "\n" if header else "") + "\n".join(delimiter.join(row) for row in rows) + "\n"
    path.write_text(text.replace(".", decimal) if decimal != "." else text, encoding="utf-8")
    return path


def assert_same(found, expected, columns=COLUMNS):
    for name in columns:
        tolerance = 1e-4 if name in ("x", "y", "z", "time") else 1e-3
        difference = getattr(found, name) - getattr(expected, name)
        if name == "heading":
            difference = (difference + 180) % 360 - 180
        np.testing.assert_allclose(difference, 0.0, atol=tolerance, err_msg=name)


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " ", "|", ", ", "   "])
def test_any_delimiter_is_understood(tmp_path, delimiter):
    found = read_trajectory(write(tmp_path / "t.csv", street(), delimiter=delimiter))
    assert_same(found, street())


@pytest.mark.parametrize("columns", [COLUMNS[::-1], ("x", "y", "time", "heading", "z", "pitch", "roll")])
def test_columns_may_stand_in_any_order(tmp_path, columns):
    assert_same(read_trajectory(write(tmp_path / "t.csv", street(), columns)), street())


@pytest.mark.parametrize("header", [
    "GPSTime,Easting,Northing,Ellipsoid Height,Roll,Pitch,Heading",
    "GPS_TIME[s],EASTING (m),NORTHING (m),Height (m),Roll (deg),Pitch (deg),Yaw (deg)",
    "# t,X,Y,Z,roll_deg,pitch_deg,heading_deg",
    '"time","x","y","z","roll","pitch","azimuth"',
    "Zeit,Rechtswert,Hochwert,Höhe,Roll,Pitch,Heading",
])
def test_other_words_for_the_same_columns(tmp_path, header):
    assert_same(read_trajectory(write(tmp_path / "t.csv", street(), header=header)), street())


def test_lines_above_the_table_and_a_line_of_units_are_passed_over(tmp_path):
    above = ("POSPac MMS export    Mission: survey 12    Datum: WGS84    Grid: EPSG:32650\nLever arms: applied\n\n"
             "        TIME, EASTING, NORTHING, ELLIPSOID HEIGHT, ROLL, PITCH, HEADING\n"
             "       (time in Sec, distance in Meters, orientation in Degrees)\n")
    found = read_trajectory(write(tmp_path / "t.txt", street(), delimiter="   ", header="", above=above))
    assert_same(found, street())
    assert "UTM zone 50N" in found.crs


def test_further_columns_do_no_harm(tmp_path):
    trajectory = street()
    path = write(tmp_path / "t.csv", trajectory)
    lines = path.read_text().splitlines()
    path.write_text("\n".join([lines[0] + ",E-SD,quality,EAST VELOCITY"] + [line + ",0.012,fixed,3.1" for line in lines[1:]]))
    assert_same(read_trajectory(path), trajectory)


@pytest.mark.parametrize("delimiter", [";", "\t", " "])
def test_a_decimal_comma_is_understood(tmp_path, delimiter):
    assert_same(read_trajectory(write(tmp_path / "t.csv", street(), delimiter=delimiter, decimal=",")), street())


def test_a_comma_for_columns_and_decimals_alike_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="between columns and as the decimal sign"):
        read_trajectory(write(tmp_path / "t.csv", street(), decimal=","))


@pytest.mark.parametrize("columns", [
    COLUMNS, ("time", "x", "y", "z"), ("x", "y", "z", "time"), ("time", "x", "y", "z", "heading"),
    ("heading", "time", "y", "x", "z"),
])
def test_without_names_the_numbers_tell_the_columns(tmp_path, columns):
    found = read_trajectory(write(tmp_path / "t.txt", street(), columns, header=""))
    assert_same(found, street(), columns)
    assert "recognised by the numbers" in " ".join(found.notes)


def test_empty_columns_behind_the_heights_are_no_attitude(tmp_path):
    path = write(tmp_path / "t.csv", street(), ("time", "x", "y", "z"), header="")
    path.write_text("".join(f"{line},nan,nan,nan\n" for line in path.read_text().splitlines()))
    assert_same(read_trajectory(path), street(), ("time", "x", "y", "z"))


def lane_at(course, height, turn):
    """A drive that starts on a course (degrees) and turns by so many, at a height of about as many metres."""
    here = street()
    angle = np.radians(course - 90.0)
    turned = drive(chain(ahead(120), bend(300, turn) if turn else ahead(50), ahead(60)), start=318_204_000.0, rate=20.0)
    x, y = turned.x - EAST, turned.y - NORTH
    x, y = EAST + x * np.cos(angle) + y * np.sin(angle), NORTH - x * np.sin(angle) + y * np.cos(angle)
    wave = np.arange(len(x)) / 40
    heading = np.degrees(np.arctan2(np.gradient(x), np.gradient(y))) % 360
    return replace(here, time=turned.time, x=x, y=y, z=height + 0.3 * np.sin(wave / 7), roll=1.2 * np.sin(wave),
                   pitch=0.7 * np.cos(wave), heading=heading)


@pytest.mark.parametrize("columns", [
    ("time", "x", "y", "roll", "pitch", "heading", "z"), ("time", "x", "y", "z"), ("x", "y", "z"), COLUMNS,
    ("time", "roll", "pitch", "heading", "x", "y", "z"),
])
@pytest.mark.parametrize("height", [24.0, 412.0])
@pytest.mark.parametrize("turn", [0, 20])
def test_a_height_of_as_many_metres_as_the_course_has_degrees_is_no_heading(tmp_path, columns, height, turn):
    driven = lane_at(24.0, height, turn)
    found = read_trajectory(write(tmp_path / "t.txt", driven, columns, header=""))
    assert_same(found, driven, columns)


def test_without_names_and_time_the_order_is_the_drive(tmp_path):
    found = read_trajectory(write(tmp_path / "t.xyz", street(), ("x", "y", "z"), header="", delimiter=" "))
    assert_same(found, street(), ("x", "y", "z"))
    assert not found.has_time and (np.diff(found.time) == 1).all()


def test_a_row_number_is_not_taken_for_time(tmp_path):
    trajectory = street()
    path = write(tmp_path / "t.csv", trajectory, header="")
    path.write_text("\n".join(f"{k},{line}" for k, line in enumerate(path.read_text().splitlines())))
    assert_same(read_trajectory(path), trajectory)


def test_small_local_coordinates_without_names_keep_their_order(tmp_path):
    trajectory = street()
    local = Trajectory(trajectory.time - 318_204_000, trajectory.x - EAST, trajectory.y - NORTH, trajectory.z,
                       trajectory.roll, trajectory.pitch, trajectory.heading)
    assert_same(read_trajectory(write(tmp_path / "t.csv", local, header="")), local)


def test_columns_that_are_not_recognised_are_refused_in_one_sentence(tmp_path):
    trajectory = street()
    local = Trajectory(trajectory.time, trajectory.x - EAST, trajectory.y - NORTH, trajectory.z, trajectory.roll, trajectory.pitch)
    with pytest.raises(RoadExtractionError, match="Put a line of names above them"):
        read_trajectory(write(tmp_path / "t.csv", local, ("roll", "y", "z", "pitch", "time", "x"), header=""))


@pytest.mark.parametrize("header, factor", [(None, np.pi / 180), ("time,x,y,z,roll_rad,pitch_rad,heading_rad", np.pi / 180),
                                            ("time,x,y,z,roll (deg),pitch (deg),heading (deg)", 1.0)])
def test_radians_become_degrees(tmp_path, header, factor):
    assert_same(read_trajectory(write(tmp_path / "t.csv", street(), header=header, factor=factor)), street())


def test_a_heading_counted_from_east_becomes_one_from_north(tmp_path):
    trajectory = street()
    turned = Trajectory(trajectory.time, trajectory.x, trajectory.y, trajectory.z, trajectory.roll, trajectory.pitch, (90 - trajectory.heading) % 360)
    found = read_trajectory(write(tmp_path / "t.csv", turned))
    assert_same(found, trajectory)
    assert "from east" in " ".join(found.notes)


@pytest.mark.parametrize("off", [90.0, 180.0, 25.0])
def test_a_heading_that_is_not_that_of_the_drive_is_told_and_not_used(tmp_path, off):
    trajectory = street()
    turned = replace(trajectory, heading=(trajectory.heading + off) % 360)
    found = read_trajectory(write(tmp_path / "t.csv", turned))
    assert [f"by {off:.0f}°" in doubt for doubt in found.doubts] == [True] * (off > 30.0)
    assert np.isnan(found.heading).all() == (off > 30.0)


def geographic(trajectory, epsg=32632):
    from pyproj import Transformer

    return Transformer.from_crs(epsg, 4326, always_xy=True).transform(trajectory.x, trajectory.y)


@pytest.mark.parametrize("header, factor", [("time,longitude,latitude,height", 1.0), ("time,lon_deg,lat_deg,alt", 1.0),
                                            ("time,lon,lat,h", np.pi / 180), ("time,x,y,z", 1.0)])
def test_longitude_and_latitude_reach_the_target_crs(tmp_path, header, factor):
    trajectory = street()
    lon, lat = geographic(trajectory)
    rows = np.c_[trajectory.time, lon * factor, lat * factor, trajectory.z]
    np.savetxt(tmp_path / "t.csv", rows, "%.12f", ",", header=header, comments="")
    found = reproject_trajectory(read_trajectory(tmp_path / "t.csv"), "EPSG:32632")
    assert_same(found, trajectory, ("time", "z"))
    np.testing.assert_allclose(found.x, trajectory.x, atol=1e-3)
    np.testing.assert_allclose(found.y, trajectory.y, atol=1e-3)


def write_sbet(path, trajectory, wander=0.0):
    from pyproj import Proj

    lon, lat = geographic(trajectory)
    convergence = Proj(32632).get_factors(lon, lat).meridian_convergence
    rows = np.zeros((len(trajectory), 17))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = trajectory.time, np.radians(lat), np.radians(lon), trajectory.z
    rows[:, 7], rows[:, 8] = np.radians(trajectory.roll), np.radians(trajectory.pitch)
    rows[:, 9], rows[:, 10] = np.radians(trajectory.heading + convergence) + wander, wander
    rows.astype("<f8").tofile(path)
    return path


@pytest.mark.parametrize("name, wander", [("sbet_mission.out", 0.0), ("mission.sbet", 0.8)])
def test_applanix_sbet_reaches_the_target_crs_with_headings_from_grid_north(tmp_path, name, wander):
    trajectory = drive(chain(ahead(120), bend(60, 80), ahead(60)), east=EAST + 150_000)
    heading = np.degrees(np.arctan2(np.gradient(trajectory.x), np.gradient(trajectory.y)))
    trajectory = Trajectory(trajectory.time, trajectory.x, trajectory.y, trajectory.z, 0 * heading + 1.0, 0 * heading - 0.5, heading)
    found = reproject_trajectory(read_trajectory(write_sbet(tmp_path / name, trajectory, wander)), "EPSG:32632")
    assert_same(found, trajectory, ("time", "z", "roll", "pitch"))
    np.testing.assert_allclose(np.c_[found.x, found.y], np.c_[trajectory.x, trajectory.y], atol=1e-3)
    # grid north and true north differ by 1.5 degrees there
    np.testing.assert_allclose((found.heading - heading + 180) % 360 - 180, 0.0, atol=0.01)


def test_an_sbet_file_cut_within_a_record_loses_that_record_and_says_so(tmp_path):
    path = write_sbet(tmp_path / "t.out", street())
    path.write_bytes(path.read_bytes()[:-40])
    found = read_trajectory(path)
    assert len(found) == len(street()) - 1 and "incomplete" in " ".join(found.notes)


def test_reprojection_turns_the_heading_with_the_grid():
    trajectory = street()
    crs = "EPSG:32632"
    here = Trajectory(trajectory.time, trajectory.x, trajectory.y, trajectory.z, heading=trajectory.heading, crs=crs)
    there = reproject_trajectory(here, "EPSG:25833")
    course = np.degrees(np.arctan2(np.gradient(there.x), np.gradient(there.y)))
    inner = slice(3, -3)
    np.testing.assert_allclose((there.heading - course + 180)[inner] % 360 - 180, 0.0, atol=0.6)
    back = reproject_trajectory(there, crs)
    np.testing.assert_allclose(back.x, trajectory.x, atol=1e-3)
    np.testing.assert_allclose((back.heading - trajectory.heading + 180) % 360 - 180, 0.0, atol=1e-3)


def test_one_crs_in_two_spellings_changes_no_coordinate():
    from pyproj import CRS

    trajectory = street()
    written = CRS.from_epsg(32632).to_wkt("WKT1_GDAL")
    same = reproject_trajectory(Trajectory(trajectory.time, trajectory.x, trajectory.y, trajectory.z, crs=written), "EPSG:32632")
    np.testing.assert_array_equal(same.x, trajectory.x)


def test_degrees_given_as_metres_are_refused_by_name(tmp_path):
    trajectory = street()
    lon, lat = geographic(trajectory)
    np.savetxt(tmp_path / "t.csv", np.c_[trajectory.time, lon, lat, trajectory.z], "%.10f", ",", header="time,x,y,z", comments="")
    with pytest.raises(RoadExtractionError, match="look like longitude and latitude"):
        read_trajectory(tmp_path / "t.csv", crs="EPSG:32632")


FEET = "time,x (ft),y (ft),z (ft),roll,pitch,heading"


@pytest.mark.parametrize("crs, target", [("", ""), ("", "EPSG:32632"), ("EPSG:32632", "")])
def test_feet_without_a_crs_in_feet_are_refused_by_name(tmp_path, crs, target):
    with pytest.raises(RoadExtractionError, match="feet"):
        reproject_trajectory(read_trajectory(write(tmp_path / "t.csv", street(), header=FEET), crs), target)


@pytest.mark.parametrize("crs, target", [("EPSG:2263", ""), ("", "EPSG:2263"), ("EPSG:2263", "EPSG:2263+6360"), ("", "EPSG:2263+6360")])
@pytest.mark.parametrize("header", [FEET, "time,x,y,z,roll,pitch,heading", "time,x (ft),y (ft),z (m),roll,pitch,heading"])
def test_a_trajectory_in_a_crs_in_feet_is_in_metres_once_it_is_read(tmp_path, crs, target, header):
    driven, foot = street(), 1200 / 3937
    up = 1.0 if "z (m)" in header else foot
    stored = replace(driven, x=driven.x / foot, y=driven.y / foot, z=driven.z / up)
    found = reproject_trajectory(read_trajectory(write(tmp_path / "t.csv", stored, header=header), crs), target)
    np.testing.assert_allclose([found.x, found.y, found.z], [driven.x, driven.y, driven.z], atol=1e-3)
    assert "metre" in found.crs and "New York" in found.crs


def test_heights_in_feet_beside_longitude_and_latitude_are_converted(tmp_path):
    trajectory = street()
    lon, lat = geographic(trajectory)
    np.savetxt(tmp_path / "t.csv", np.c_[trajectory.time, lon, lat, trajectory.z / 0.3048], "%.10f", ",",
               header="time,longitude,latitude,height (ft)", comments="")
    np.testing.assert_allclose(read_trajectory(tmp_path / "t.csv").z, trajectory.z, atol=1e-6)


@pytest.mark.parametrize("content, says", [
    ("", "is empty"), ("no numbers here\nnor here\n", "no table of numbers"), ("time,x,y\n" + "1.0,500000.0,5400000.0\n" * 5, "z cannot be found"),
    ("clock,x,y,z\nutc,x,y,z\n", "no table of numbers"),
    ("time,x,y,z\n" + "12:00:01.5,500000.0,5400000.0,100.0\n" * 5, "GPS seconds are needed"),
])
def test_what_cannot_be_read_is_refused_in_one_sentence(tmp_path, content, says):
    (tmp_path / "t.csv").write_text(content)
    with pytest.raises(RoadExtractionError, match=says):
        read_trajectory(tmp_path / "t.csv")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(RoadExtractionError, match="There is no file"):
        read_trajectory(tmp_path / "nowhere.csv")


def test_an_image_is_not_a_trajectory(tmp_path):
    (tmp_path / "t.csv").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(500))
    with pytest.raises(RoadExtractionError, match="binary"):
        read_trajectory(tmp_path / "t.csv")


def test_broken_rows_are_left_out_and_counted(tmp_path):
    path = write(tmp_path / "t.csv", street())
    lines = path.read_text().splitlines()
    lines[5:7] = ["318204000.3,5000", "--- log restarted ---"]
    lines[9] = "318204000.4,,,,0.1,0.1,90.0"
    path.write_text("\n".join(lines) + "\nEND OF FILE\n")
    found = read_trajectory(path)
    assert len(found) == len(street()) - 2
    assert np.isnan(found.x).sum() == 1
    assert "3 lines" in " ".join(found.notes)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_any_encoding_and_line_ending(tmp_path, encoding, ending):
    path = write(tmp_path / "t.csv", street())
    path.write_bytes(path.read_text().replace("\n", ending).encode(encoding))
    assert_same(read_trajectory(path), street())


@pytest.mark.slow
def test_two_hundred_thousand_rows_cost_a_few_times_what_cutting_them_costs(tmp_path):
    """Not a Python loop over rows; in processor seconds, beside the same machine's own."""
    row = "318204000.123456,500123.4567,5400123.4567,101.2345,0.012345,0.012345,91.234567\n"
    (tmp_path / "t.csv").write_text("time,x,y,z,roll,pitch,heading\n" + row * 200_000)
    begun = time.process_time()
    assert len([line.split(",") for line in open(tmp_path / "t.csv", encoding="utf-8")]) == 200_001
    cut = time.process_time() - begun
    assert len(read_trajectory(tmp_path / "t.csv")) == 200_000
    assert time.process_time() - begun - cut < 10 * cut


def test_names_without_a_role_are_ignored_and_units_do_not_matter():
    names = ["fid", "GPSTime (s)", "Easting [m]", "NORTHING", "h", "roll_deg", "E-SD", "EAST VELOCITY"]
    assert columns_by_role(names) == {"time": "GPSTime (s)", "x": "Easting [m]", "y": "NORTHING", "z": "h", "roll": "roll_deg"}


def test_a_layer_without_heights_is_refused():
    with pytest.raises(RoadExtractionError, match="has no heights"):
        trajectory_from_columns({"x": np.arange(5.0), "y": np.arange(5.0)}, label="Layer drive")


def test_vertices_of_a_line_are_driven_in_their_order():
    found = trajectory_from_columns({"x": EAST + np.arange(50.0), "y": np.full(50, NORTH), "z": np.full(50, 100.0)}, crs="EPSG:32632")
    assert not found.has_time and (np.diff(found.time) > 0).all() and np.isnan(found.heading).all()


def test_a_vertical_tab_in_a_field_costs_that_field_only(tmp_path):
    path = tmp_path / "drive.csv"
    rows = [f"{t},{500000 + 2 * t},{5000000 + t},100" for t in range(50)]
    rows[20] = rows[20].replace(",100", ",1\x0b00")
    path.write_text("time,x,y,z\n" + "\n".join(rows))
    found = read_trajectory(path)
    assert len(found) == 50 and np.isnan(found.z[20]) and found.x[21] == 500042


@pytest.mark.parametrize("words", [("inf", "inf"), ("1e999", "-inf"), ("9" * 200, "-1e300")])
@pytest.mark.parametrize("header", [None, ""], ids=["with header", "without"])
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_numbers_beyond_reason_count_as_none(tmp_path, words, header):
    """No sum survives them, and what numpy says then is no sentence for anybody."""
    path = write(tmp_path / "t.csv", street(), header=header)
    lines = path.read_text().splitlines()
    first = 0 if header == "" else 1
    for at, word in zip((1, 5, 6), words * 2):  # x, pitch, heading
        fields = lines[first + 40 + at].split(",")
        lines[first + 40 + at] = ",".join(fields[:at] + [word] + fields[at + 1:])
    path.write_text("\n".join(lines))
    found = read_trajectory(path)
    assert len(found) == len(street()) and np.isnan(found.x).sum() == 1
    assert np.isnan(found.heading).sum() == 1 == np.isnan(found.pitch).sum()


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_one_row_without_names_is_refused_in_one_sentence(tmp_path):
    path = tmp_path / "one.csv"
    path.write_text("318204000.0,500000.0,5400000.0,102.0,0.1,0.2,90.0\n")
    with pytest.raises(RoadExtractionError, match="one.csv"):
        read_trajectory(path)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_rows_that_hold_no_numbers_at_all_are_refused_in_one_sentence(tmp_path):
    path = tmp_path / "none.csv"
    path.write_text("1e999,nan,inf,nan\n" * 5)
    with pytest.raises(RoadExtractionError, match="none.csv"):
        read_trajectory(path)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_headings_of_rows_without_a_place_say_nothing_of_their_unit(tmp_path):
    """Three rows are whole in their heading, and none of them in its place."""
    path = tmp_path / "drive.txt"
    path.write_text("GPSTime\tEasting\tNorthing\tHeight\tRoll\tPitch\tYaw\n"
                    "100.0\t500000.0\t50003\x820.0\t100.0\t0.1\t0.2\t90.0\n"
                    "101.0\t}00015.2\t5000299.6\t100.0\t0.1\t0.2\t92.9\n"
                    "102.0\t50m022.8\t5\xca00299.1\t100.0\t0.1\t0.2\t94.3\n", encoding="latin-1")
    found = read_trajectory(path)
    assert len(found) == 3 and np.isnan(found.x + found.y).all()
    np.testing.assert_array_equal(found.heading, [90.0, 92.9, 94.3])


def test_places_of_which_no_latitude_is_a_number_have_no_length_in_metres():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _, north = rough_metres(np.array([8.4, 8.5]), np.array([np.nan, np.nan]), "EPSG:4326")
    assert np.isnan(north).all()
