"""One drive, whatever wrote it down: receivers, their software, offices in many countries."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.meaning import columns_of_table
from lanewright.core.survey.trajectory.reader import read_trajectory, trajectory_from_rows
from lanewright.core.survey.trajectory.time_systems import align_time
from lanewright.core.survey.trajectory.trajectory import clean_trajectory, reproject_trajectory
from written_drives import (
    ECEF,
    GEO,
    GPS,
    HEADING,
    LAT,
    LON,
    MAP,
    OF_DAY,
    OF_WEEK,
    PITCH,
    ROLL,
    ROWS,
    UTC_CLOCKS,
    WEEK,
    X,
    Y,
    Z,
    clock,
    dms,
    nmea_angle,
    rows,
)

S3, S2 = "{:.3f}", "{:.2f}"
WEEKS = [WEEK] * ROWS
LAT_DMS, LON_DMS = dms(LAT), dms(LON)
COMMA = lambda text: text.replace(".", ",")


def grouped(values, mark, decimal="."):
    return [f"{value:,.4f}".replace(",", "_").replace(".", decimal).replace("_", mark) for value in values]


# what is written: (text, time that is read, None for none)
TIMES = {
    **{title: (f"{title},Easting,Northing,Height\n" + rows((OF_WEEK, S3), *MAP), OF_WEEK) for title in (
        "gps_seconds[s]", "GPS Seconds", "gps_week_seconds", "GPS Time of Week (s)", "TOW", "SOW (sec)", "Time (GPS)", "GNSS time [s]", "sec_of_week",
        "Time, GPS", "GPS week seconds (sec)", "timeOfWeek", "time_tag", "Week Seconds", "tow_s", "GPSTimeOfWeek", "Temps GPS (s)", "时间")},
    "offset": ("timeOffset,Easting,Northing,Height\n" + rows((GPS - 1e9, S3), *MAP), GPS - 1e9),
    "milliseconds by name": ("gps_time_ms,x,y,z\n" + rows((OF_WEEK * 1000, "{:.0f}"), *MAP), OF_WEEK),
    "milliseconds in brackets": ("TOW [ms],x,y,z\n" + rows((OF_WEEK * 1000, "{:.0f}"), *MAP), OF_WEEK),
    "thousandths of a second": ("TOW [0.001 s],WNc [w],x [m],y [m],z [m]\n" + rows((OF_WEEK * 1000, "{:.0f}"), WEEKS, *MAP), GPS),
    "u-blox": ("iTOW,x,y,z\n" + rows((OF_WEEK * 1000, "{:.0f}"), *MAP), OF_WEEK),
    "milliseconds that nobody names": ("TOW,x,y,z\n" + rows((OF_WEEK * 1000, "{:.0f}"), *MAP), OF_WEEK),
    "microseconds": ("time (µs),x,y,z\n" + rows((GPS * 1e6, "{:.0f}"), *MAP), GPS),
    "nanoseconds that nobody names": ("timestamp,x,y,z\n" + rows((GPS * 1e9, "{:.0f}"), *MAP), GPS),
    "week and seconds": ("Week,Seconds,x,y,z\n" + rows(WEEKS, (OF_WEEK, S3), *MAP), GPS),
    "week and seconds of an old receiver": ("GPS Week,SOW,x,y,z\n" + rows([WEEK - 2048] * ROWS, (OF_WEEK, S3), *MAP), OF_WEEK),
    "GPS clock": ("GPS time,x,y,z\n" + rows(clock("%Y-%m-%d %H:%M:%S.%f"), *MAP), GPS),
    "GPS clock, slashes": ("GPST;x;y;z\n" + rows(clock("%Y/%m/%d %H:%M:%S.%f"), *MAP, mark=";"), GPS),
    "GPS clock, AM and PM": ("Time (GPS),x,y,z\n" + rows(clock("%m/%d/%Y %I:%M:%S.%f %p"), *MAP), GPS),
    "GPS clock without date": ("GPS time,x,y,z\n" + rows(clock("%H:%M:%S.%f"), *MAP), OF_DAY),
    "GPS date and clock apart": ("GPS date,GPS clock,x,y,z\n" + rows(clock("%d.%m.%Y"), clock("%H:%M:%S.%f"), *MAP), GPS),
    "UTC": ("UTC,x,y,z\n" + rows(clock("%Y-%m-%dT%H:%M:%S.%f", UTC_CLOCKS), *MAP), GPS),
    "UTC by its letter": ("time,x,y,z\n" + rows(clock("%Y-%m-%dT%H:%M:%S.%fZ", UTC_CLOCKS), *MAP), GPS),
    "UTC and a zone": ("time,x,y,z\n" + rows(clock("%Y-%m-%dT%H:%M:%S.%f+00:00", UTC_CLOCKS), *MAP), GPS),
    "clock in three columns": ("GPS hour,GPS minute,GPS second,x,y,z\n" + rows(clock("%H"), clock("%M"), clock("%S.%f"), *MAP), OF_DAY),
    "first time missing": ("GPS time,x,y,z\n,0,0,0\n" + rows(clock("%Y-%m-%d %H:%M:%S.%f"), *MAP), np.r_[np.nan, GPS]),
    "GPS clock, short form": ("GPS time,x,y,z\n" + rows(clock("%Y%m%dT%H%M%S.%f"), *MAP), GPS),
    "GPS clock, names of months": ("GPS time,x,y,z\n" + rows(clock("%d-%b-%Y %H:%M:%S.%f"), *MAP), GPS),
    "date and clock of two names among angles of three fields": (
        "  UTCDate  UTCTime  Latitude  Longitude  H-Ell  Q\n  (MDY)  (HMS)  (D M S)  (D M S)  (m)\n" + rows(
            clock("%m/%d/%Y", UTC_CLOCKS), clock("%H:%M:%S.%f", UTC_CLOCKS), LAT_DMS, LON_DMS, GEO[2], [1] * ROWS, mark="  "), GPS),
    "seconds of the day beside a date": ("Date,Time[s],x,y,z\n" + rows(clock("%Y-%m-%d"), (OF_DAY, S3), *MAP), OF_DAY),
    "both clock and seconds": ("UTC Time,SOW,x,y,z\n" + rows(clock("%H:%M:%S.%f", UTC_CLOCKS), (OF_WEEK, S3), *MAP), OF_WEEK),
    "UTC with the signs of China, in the encoding of China": (("UTC时间,东坐标,北坐标,高程\n" + rows(
        clock("%Y年%m月%d日 %H时%M分%S.%f秒", UTC_CLOCKS), *MAP)).encode("gb18030"), GPS),
    "RTKLIB": ("% program : x\n%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns\n"
               + rows(clock("%Y/%m/%d %H:%M:%S.%f"), *GEO, [1] * ROWS, [12] * ROWS, mark="   "), GPS),
    "RTKLIB, UTC": ("%  UTC                   latitude(deg) longitude(deg)  height(m)   Q  ns\n"
                    + rows(clock("%Y/%m/%d %H:%M:%S.%f", UTC_CLOCKS), *GEO, [1] * ROWS, [12] * ROWS, mark="   "), GPS),
    "RTKLIB, week": ("%  GPST       latitude(deg) longitude(deg)  height(m)   Q  ns\n"
                     + rows(WEEKS, (OF_WEEK, S3), *GEO, [1] * ROWS, [12] * ROWS, mark="   "), GPS),
    "RTKLIB, degrees and minutes": ("%  GPST                latitude(d'\")   longitude(d'\")  height(m)   Q  ns\n"
                                    + rows(clock("%Y/%m/%d %H:%M:%S.%f"), LAT_DMS, LON_DMS, GEO[2], [1] * ROWS, [12] * ROWS, mark="   "), GPS),
    "RTKLIB, earth-centred": ("%  GPST                 x-ecef(m)      y-ecef(m)      z-ecef(m)   Q  ns\n"
                              + rows(clock("%Y/%m/%d %H:%M:%S.%f"), *((axis, "{:.4f}") for axis in ECEF), [1] * ROWS, [12] * ROWS, mark="   "), GPS),
}


def check(found, time, tolerance=0.003):
    if time is not None and len(time) > ROWS:
        found, time = found.rows(np.arange(1, len(time))), time[1:]
    np.testing.assert_allclose(np.c_[found.x, found.y, found.z], np.c_[X, Y, Z], atol=tolerance)
    if time is None:
        assert not found.has_time
    else:
        np.testing.assert_allclose(found.time, time, atol=1e-5)


def read(tmp_path, text, name="drive.csv", **more):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return reproject_trajectory(read_trajectory(path, **more), "EPSG:32650")


@pytest.mark.parametrize("written", TIMES)
def test_times_under_their_usual_names_and_units_are_read(tmp_path, written):
    text, time = TIMES[written]
    check(read(tmp_path, text), time)


PLACES = {
    "ellipsoidal": "gps_seconds[s]\tlatitude[deg]\tlongitude[deg]\taltitude_ellipsoidal[m]\tnorth_rms[m]\n" + rows(
        (GPS, S3), *GEO, [0.02] * ROWS, mark="\t"),
    "H-Ell": "Time,Latitude,Longitude,H-Ell,SDHoriz\n" + rows((GPS, S3), *GEO, [0.02] * ROWS),
    "both heights": "Time,Latitude,Longitude,Orthometric Height,Ellipsoidal Height\n" + rows((GPS, S3), *GEO[:2], (Z - 12, "{:.4f}"), GEO[2]),
    "earth-centred beside geodetic": "Time (s),X (ECEF),Y (ECEF),Z (ECEF),Latitude (deg),Longitude (deg),H-Ell (m)\n" + rows(
        (GPS, S3), *((axis, "{:.4f}") for axis in ECEF), *GEO),
    "earth-centred under plain names": "Time,X,Y,Z,Lat,Lon,Ellipsoidal height\n" + rows((GPS, S3), *((axis, "{:.4f}") for axis in ECEF), *GEO),
    "earth-centred alone": "time,x,y,z\n" + rows((GPS, S3), *((axis, "{:.4f}") for axis in ECEF)),
    "earth-centred alone, named": "GPSTime ECEF-X(m) ECEF-Y(m) ECEF-Z(m)\n" + rows((GPS, S3), *((axis, "{:.4f}") for axis in ECEF), mark=" "),
    "three fields an angle": "     GPSTime      Latitude       Longitude     H-Ell    Q\n       (sec)     (D M S)         (D M S)       (m)\n" + rows(
        (GPS, S3), LAT_DMS, LON_DMS, GEO[2], [1] * ROWS, mark="  "),
    "two fields an angle": "GPSTime Lat Lon Height Q\n" + rows(
        (GPS, S3), [f"{int(v)} {v % 1 * 60:.8f}" for v in LAT], [f"{int(v)} {v % 1 * 60:.8f}" for v in LON], GEO[2], [1] * ROWS, mark=" "),
    "signs of degrees": "time;lat;lon;h\n" + rows(
        (GPS, S3), dms(LAT, "{0}°{1:02d}'{2:.5f}\"", "NS"), dms(LON, "{0}°{1:02d}'{2:.5f}\"", "EW"), GEO[2], mark=";"),
    "hemisphere first": "time,lat,lon,h\n" + rows((GPS, S3), dms(LAT, "N {0} {1:02d} {2:.5f}"), dms(LON, "E {0} {1:02d} {2:.5f}"), GEO[2]),
    "colons": "time,lat,lon,h\n" + rows((GPS, S3), dms(LAT, "{0}:{1:02d}:{2:.5f}"), dms(LON, "{0}:{1:02d}:{2:.5f}"), GEO[2]),
    "minutes alone": "time,lat,lon,h\n" + rows(
        (GPS, S3), [f"{int(v)}° {v % 1 * 60:.7f}'" for v in LAT], [f"{int(v)}° {v % 1 * 60:.7f}'" for v in LON], GEO[2]),
    "letters in the names": "time,Latitude N,Longitude E,Height\n" + rows((GPS, S3), *GEO),
    "height of the geoid first": "time,lat,lon,Geoid height,Altitude MSL\n" + rows((GPS, S3), *GEO[:2], [12.0] * ROWS, GEO[2]),
    "letters behind": "time,lat,NS,lon,EW,h\n" + rows((GPS, S3), GEO[0], ["N"] * ROWS, GEO[1], ["E"] * ROWS, GEO[2]),
    "degrees and minutes of a receiver": "time,lat,NS,lon,EW,h\n" + rows(
        (GPS, S3), nmea_angle(LAT, 2), ["N"] * ROWS, nmea_angle(LON, 3), ["E"] * ROWS, GEO[2]),
    "ten millionths behind the unit": "time,lat (deg*1e-7),lon (deg*1e-7),height (mm),hMSL (mm)\n" + rows(
        (GPS, S3), (LAT * 1e7, "{:.0f}"), (LON * 1e7, "{:.0f}"), (Z * 1000, "{:.0f}"), (Z * 1000 - 12000, "{:.0f}")),
    "French": "Temps GPS (s);Est (m);Nord (m);Altitude ellipsoïdale (m)\n" + COMMA(rows((GPS, S3), *MAP, mark=";")),
    "ten millionths of a degree": "time,lat [1e-7 deg],lon [1e-7 deg],height [mm]\n" + rows(
        (GPS, S3), (LAT * 1e7, "{:.0f}"), (LON * 1e7, "{:.0f}"), (Z * 1000, "{:.0f}")),
    "radians": "Time[s];Latitude[rad];Longitude[rad];Height[m]\n" + rows(
        (GPS, S3), (np.radians(LAT), "{:.13f}"), (np.radians(LON), "{:.13f}"), GEO[2], mark=";"),
    "decimal commas": "Zeit;Rechtswert;Hochwert;Höhe\n" + COMMA(rows((GPS, S3), *MAP, mark=";")),
    "decimal commas in quotes": "Zeit,Ost,Nord,Höhe\n" + "".join(",".join(f'"{v}"' for v in line.split(";")) + "\n" for line in COMMA(
        rows((GPS, S3), *MAP, mark=";")).splitlines()),
    "groups of three, apostrophe": "Zeit;E;N;H\n" + rows((GPS, S3), grouped(X, "'"), grouped(Y, "'"), MAP[2], mark=";"),
    "groups of three, typographic": "Zeit;E;N;H\n" + rows((GPS, S3), grouped(X, "’"), grouped(Y, "’"), MAP[2], mark=";"),
    "groups of three, blank": "Zeit;E;N;H\n" + rows((GPS, S3), grouped(X, " "), grouped(Y, " "), MAP[2], mark=";"),
    "groups of three, narrow blank": "Temps;Est;Nord;Altitude\n" + COMMA(rows(
        (GPS, S3), grouped(X, "\u202f"), grouped(Y, "\u202f"), MAP[2], mark=";")),
    "groups of three, dot": "Zeit;E;N;H;Roll;Pitch\n" + rows(
        [f"{v:.3f}".replace(".", ",") for v in GPS], grouped(X, ".", ","), grouped(Y, ".", ","), [COMMA(f"{v:.4f}") for v in Z],
        [COMMA(f"{v:.3f}") for v in ROLL], [COMMA(f"{v:.3f}") for v in PITCH], mark=";"),
    "groups of three, comma": "time\tE\tN\tH\n" + rows((GPS, S3), grouped(X, ","), grouped(Y, ","), MAP[2], mark="\t"),
    "groups of three, blank, between tabs": "Temps\tEst\tNord\tAltitude\n" + COMMA(rows(
        (GPS, S3), grouped(X, " "), grouped(Y, " "), MAP[2], mark="\t")),
    "commas between columns filled up with blanks": "    TIME,    EASTING,   NORTHING,  HEIGHT\n   (sec),        (m),        (m),     (m)\n\n" + rows(
        (GPS, "  {:14.5f}"), *((values, "{:13.4f}") for values in (X, Y, Z))),
    "degrees, minutes and seconds in one number": "time,Latitude(ddmmss.ssss),Longitude(dddmmss.ssss),Height\n" + rows(
        (GPS, S3), dms(LAT, "{0}{1:02d}{2:09.6f}"), dms(LON, "{0}{1:02d}{2:09.6f}"), GEO[2]),
    "degrees as pocket calculators show them": "time,lat [DD.MMSSSS],lon [DDD.MMSSSS],h\n" + rows(
        (GPS, S3), *([f"{whole}.{part[:2]}{part[2:].replace('.', '')}" for whole, part in (text.split("|") for text in dms(
            angle, "{0}|{1:02d}{2:09.6f}"))] for angle in (LAT, LON)), GEO[2]),
    "degrees and minutes by name": "time,lat [ddmm.mmmm],lon [dddmm.mmmm],h\n" + rows((GPS, S3), nmea_angle(LAT, 2), nmea_angle(LON, 3), GEO[2]),
    "exponents": "time x y z\n" + rows((GPS, S3), *((values, "{:.12E}") for values in (X, Y, Z)), mark=" ").replace("E", "D"),
    "units behind numbers": "time;x;y;z\n" + rows((GPS, "{:.3f} s"), (X, "{:.4f} m"), (Y, "{:.4f} m"), (Z, "{:.4f} m"), mark=";"),
    "signs before numbers": "time,x,y,z\n" + rows((GPS, "{:+.3f}"), *((values, "{:+.4f}") for values in (X, Y, Z))),
    "several marks": "time x y z\n" + "".join(line.replace("|", ", ", 1).replace("|", " ", 1).replace("|", "; ") + "\n" for line in rows(
        (GPS, S3), *MAP, mark="|").splitlines()),
    "marks at the end": "time;x;y;z;\n" + rows((GPS, S3), *MAP, [""] * ROWS, mark=";"),
    "units below the names": "time,x,y,z\n[s],[m],[m],[m]\n\n" + rows((GPS, S3), *MAP),
    "remarks": "# made on Monday\n% by hand\n; with care\ntime,x,y,z\n" + rows((GPS, S3), *MAP) + "# end of file\n40 rows\n",
    "mark of UTF-8": "\ufefftime,x,y,z\n" + rows((GPS, S3), *MAP),
    "UTF-16": ("time,x,y,z\n" + rows((GPS, S3), *MAP)).encode("utf-16"),
    "GB 18030": ("GPS时间,东坐标,北坐标,高程\n" + rows((GPS, S3), *MAP)).encode("gb18030"),
    "Shift-JIS": ("GPS時刻,東座標,北座標,標高\n" + rows((GPS, S3), *MAP)).encode("cp932"),
    "Windows-1251": ("Время;X;Y;Высота\n" + rows((GPS, S3), *MAP, mark=";")).encode("cp1251"),
    "Latin-1": ("Zeit;Ost;Nord;Höhe\n" + rows((GPS, S3), *MAP, mark=";")).encode("latin-1"),
}


@pytest.mark.parametrize("written", PLACES)
def test_places_are_read_however_they_are_written(tmp_path, written):
    check(read(tmp_path, PLACES[written]), GPS)


@pytest.mark.parametrize("names, says", [("time,Latitude,Longitude,Height", "none beyond 90°.*are exchanged"),
                                         ("time,y,x,z", "look like latitude and longitude.*in this order")])
def test_longitudes_and_latitudes_that_are_exchanged_are_named(tmp_path, names, says):
    with pytest.raises(RoadExtractionError, match=says):
        read(tmp_path, names + "\n" + rows((GPS, S3), GEO[1], GEO[0], GEO[2]))


def test_rows_of_dashes_and_stars_cost_themselves_alone(tmp_path):
    lines = rows((GPS, S3), *MAP).splitlines()
    lines[5:5] = ["-,-,-,-", "*,*,*,*", ",,,", "", "time,x,y,z"]
    check(clean_trajectory(read(tmp_path, "time,x,y,z\n" + "\n".join(lines))), GPS)


@pytest.mark.parametrize("column", [clock("%Y-%m-%dT%H:%M:%S.%f"), clock("%d/%m/%Y %H:%M:%S.%f"), clock("%d.%m.%Y %H:%M:%S"),
                                    clock("%m/%d/%Y %I:%M:%S %p"), clock("%H:%M:%S.%f")])
@pytest.mark.parametrize("title", ["Time", "Zeit", "Local time", "when"])
def test_a_clock_of_which_nobody_says_what_it_shows_is_refused_and_shown(tmp_path, title, column):
    with pytest.raises(RoadExtractionError, match="GPS seconds are needed") as refused:
        read(tmp_path, f"{title};x;y;z\n" + rows(column, *MAP, mark=";"))
    assert repr(column[0]) in str(refused.value) and title in str(refused.value) and "gps or utc" in str(refused.value)


def test_hours_minutes_and_seconds_in_one_number_are_a_clock_time(tmp_path):
    times = 234_655.0 + 0.25 * np.arange(ROWS)
    times[20:] += 40.0   # from 23:46:59.75 to 23:47:00
    with pytest.raises(RoadExtractionError, match="GPS seconds are needed"):
        read(tmp_path, "Time,x,y,z\n" + rows((times, S2), *MAP))


def test_numbers_beside_a_date_are_hours_minutes_and_seconds(tmp_path):
    found = read(tmp_path, "UTC,Date,x,y,z\n" + rows(clock("%H%M%S.%f", UTC_CLOCKS), clock("%Y-%m-%d", UTC_CLOCKS), *MAP))
    check(found, GPS)


@pytest.mark.parametrize("title", ["fid", "chainage", "Distance (m)", "image_no"])
def test_what_counts_something_else_is_not_named_as_time(tmp_path, title):
    assert not read(tmp_path, f"{title},x,y,z\n" + rows((3.1 * np.arange(ROWS), S3), *MAP)).doubts


def test_a_clock_that_contradicts_its_name_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="it is not said whether"):
        read(tmp_path, "GPS time,x,y,z\n" + rows(clock("%Y-%m-%dT%H:%M:%S.%fZ"), *MAP))


def test_seconds_of_utc_are_warned_of(tmp_path):
    assert "seconds of UTC by its name" in read(tmp_path, "UTCTime (sec),x,y,z\n" + rows((OF_WEEK, S3), *MAP)).doubts[0]


def test_what_a_clock_shows_is_said_in_columns(tmp_path):
    text = "Time;x;y;z\n" + rows(clock("%d/%m/%Y %H:%M:%S.%f"), *MAP, mark=";")
    check(read(tmp_path, text, columns="gps,x,y,z"), GPS)
    check(read(tmp_path, text, columns="utc,x,y,z"), GPS + 18)
    assert columns_of_table(tmp_path / "drive.csv", "utc,x,y,z").roles == ("utc", "x", "y", "z")


@pytest.mark.parametrize("title", ["timestamp", "unix_time", "Time (Unix)", "time"])
@pytest.mark.parametrize("count", [1.0, 1e3, 1e9])
def test_seconds_since_1970_are_refused_with_both_numbers(tmp_path, title, count):
    text = f"{title},x,y,z\n" + rows(((GPS + 315_964_800 - 18) * count, "{:.0f}"), *MAP)
    with pytest.raises(RoadExtractionError, match="1634168782 s since 1970 are GPS 1318204000 s .* 18 s"):
        read(tmp_path, text)
    found = read(tmp_path, text, columns="utc,x,y,z")
    np.testing.assert_allclose(found.time, GPS, atol=1.0)


def test_seconds_since_1970_that_could_be_gps_seconds_are_told_by_the_cloud():
    unix = GPS - 3e8 + 315_964_800 - 15   # 2012
    with pytest.raises(RoadExtractionError, match=r"since 1970 are GPS 1018204001 s .* 16 s|since 1970 are GPS 1018204000 s .* 15 s"):
        align_time(unix, (float(GPS[0] - 3e8), float(GPS[-1] - 3e8)))


def test_a_column_that_looks_like_time_and_is_not_used_is_named(tmp_path):
    found = read(tmp_path, "stamp_of_imu_card,x,y,z\n" + rows((OF_WEEK, S3), *MAP))
    assert not found.has_time and "stamp_of_imu_card (344800 to 344809.75)" in " ".join((*found.notes, *found.doubts))


def test_of_two_heights_the_one_that_is_used_is_named(tmp_path):
    assert "Ellipsoidal Height is used, not Orthometric Height" in " ".join(read(tmp_path, PLACES["both heights"]).notes)


def test_a_header_that_does_not_fit_its_rows_shows_the_first_of_them(tmp_path):
    with pytest.raises(RoadExtractionError, match=r"names 5 columns .*, but its rows have 7.*column 3 = "):
        read(tmp_path, "time lat lon h q\n" + rows((GPS, S3), *[(values, S3) for values in (ROLL, PITCH, -ROLL, PITCH, ROLL, PITCH)], mark=" "))


def test_names_of_any_length_leave_a_message_short(tmp_path):
    with pytest.raises(RoadExtractionError, match="cannot be found") as refused:
        read(tmp_path, "time,x," + "w" * 5000 + ",v" * 60 + "\n" + rows(*[[1, 2, 3]] * 63))
    assert len(str(refused.value)) < 2500


def test_a_table_whose_rows_all_have_another_number_of_fields_is_refused(tmp_path):
    with pytest.raises(RoadExtractionError, match="holds no rows of numbers"):
        read(tmp_path, "1;2;3;4\t5\n")


# -- logs and tracks ---------------------------------------------------------------------------------------------------


def nmea(day="131021"):
    lines = []
    for when, lat, lon, z in zip(UTC_CLOCKS, nmea_angle(LAT, 2), nmea_angle(LON, 3), Z):
        time = when.strftime("%H%M%S.") + f"{when.microsecond // 1000:03d}"
        lines.append(f"$GNGGA,{time},{lat},N,{lon},E,4,12,0.9,{z - 12.0:.4f},M,12.0,M,1.0,0000*5E")
        lines += [f"$GNRMC,{time},A,{lat},N,{lon},E,12.0,110.0,{day},,,R*7C"] if day else []
        lines.append("$GNGST,1,2,3*00")
    return "\n".join(lines) + "\n"


def novatel(name, fields):
    return "".join(f"#{name},COM1,0,31.0,FINESTEERING,{WEEK},{s:.3f},00040000,5615,1541;{body}*af719fd9\n" for s, body in zip(OF_WEEK, fields))


LOGS = {
    "drive.nmea": nmea(),
    "drive.log": "noise\x07 in the line\n" + nmea(),
    "drive.txt": nmea().replace("GN", "GP"),
    "inspva.asc": novatel("INSPVAA", rows(WEEKS, (OF_WEEK, "{:.6f}"), *GEO, [1] * ROWS, [2] * ROWS, [0] * ROWS, (ROLL, S3), (PITCH, S3),
                                          (HEADING, S3),
                                          ["INS_SOLUTION_GOOD"] * ROWS).splitlines()),
    "bestpos.asc": novatel("BESTPOSA", rows(["SOL_COMPUTED"] * ROWS, ["NARROW_INT"] * ROWS, *GEO[:2], (Z - 12, "{:.4f}"), [12] * ROWS,
                                            ["WGS84"] * ROWS).splitlines()),
    "track.gpx": '<?xml version="1.0"?><gpx xmlns="http://www.topografix.com/GPX/1/1"><wpt lat="1" lon="2"/><trk><trkseg>' + "".join(
        f'<trkpt lat="{a:.10f}" lon="{b:.10f}"><ele>{c:.4f}</ele><time>{t}</time></trkpt>' for a, b, c, t in zip(
            LAT, LON, Z, clock("%Y-%m-%dT%H:%M:%S.%fZ", UTC_CLOCKS))) + "</trkseg></trk></gpx>",
    "track.kml": '<kml xmlns:gx="g"><Placemark><gx:Track>' + "".join(
        f"<when>{t}</when>" for t in clock("%Y-%m-%dT%H:%M:%S.%fZ", UTC_CLOCKS)) + "".join(
        f"<gx:coord>{b:.10f} {a:.10f} {c:.4f}</gx:coord>" for a, b, c in zip(LAT, LON, Z)) + "</gx:Track></Placemark></kml>",
}
LOGS["undeclared.kml"] = LOGS["track.kml"].replace(' xmlns:gx="g"', "")   # as some telephones write it


@pytest.mark.parametrize("name", LOGS)
def test_logs_of_receivers_and_tracks_are_read(tmp_path, name):
    found = read(tmp_path, LOGS[name], name)
    check(found, GPS)
    assert ("UTC" in " ".join(found.notes)) == (name.endswith(("nmea", "log", "txt", "gpx", "kml")))
    if name == "inspva.asc":
        np.testing.assert_allclose(found.roll, ROLL, atol=1e-3)


@pytest.mark.parametrize("name", ["points.gpx", "line.kml", "points.kml"])
def test_without_a_track_the_points_and_lines_are_the_drive(tmp_path, name):
    places = [f"{b:.10f},{a:.10f},{c:.4f}" for a, b, c in zip(LAT, LON, Z)]
    text = {"points.gpx": "".join(f'<wpt lat="{a:.10f}" lon="{b:.10f}"><ele>{c:.4f}</ele></wpt>' for a, b, c in zip(LAT, LON, Z)),
            "line.kml": f"<LineString><coordinates>{' '.join(places)}</coordinates></LineString>",
            "points.kml": "".join(f"<Point><coordinates>{place}</coordinates></Point>" for place in places)}[name]
    check(read(tmp_path, f"<file>{text}</file>", name), None)


def test_a_log_without_a_date_is_refused_with_a_way_out(tmp_path):
    with pytest.raises(RoadExtractionError, match="without a date"):
        read(tmp_path, nmea(day=""), "drive.nmea")


@pytest.mark.parametrize(("name", "text", "says"), [
    ("route.gpx", "<gpx><rte/></gpx>", "holds no track"), ("broken.gpx", "<gpx><trk>", "cannot be read as XML"),
    ("odd.gpx", '<?xml version="1.0" encoding="klingon"?><gpx/>', "cannot be read"),
    ("bomb.kml", '<!DOCTYPE kml [<!ENTITY a "aaaa">]><kml>&a;</kml>', "entities of its own"), ("empty.kml", "<kml/>", "holds no track"),
    ("gst.nmea", "$GNGST,1,2,3*00\n$GPRMC,1,2,3*00\n" * 5, "no sentence with positions"),
])
def test_files_of_receivers_without_a_drive_are_refused_in_one_sentence(tmp_path, name, text, says):
    with pytest.raises(RoadExtractionError, match=says):
        read(tmp_path, text, name)


# -- layers ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("written", ["gps_seconds[s]", "milliseconds by name", "UTC", "GPS date and clock apart", "week and seconds"])
def test_the_same_columns_of_a_layer_give_the_same_drive(written):
    titles, *lines = [line.split(",") for line in TIMES[written][0].splitlines()]
    check(trajectory_from_rows(titles, lines, {}, label="Layer"), TIMES[written][1])
    values = [[float(text) if text.replace(".", "", 1).isdigit() else text for text in line] for line in lines]
    given = {"x": X, "y": Y, "z": Z}
    check(trajectory_from_rows(titles[:-3], [row[:-3] for row in values], given, label="Layer"), TIMES[written][1])


def test_a_layer_with_clock_times_is_refused_like_a_file():
    with pytest.raises(RoadExtractionError, match="GPS seconds are needed"):
        trajectory_from_rows(["Time"], [[text] for text in clock("%d/%m/%Y %H:%M:%S.%f")], {"x": X, "y": Y, "z": Z}, label="Layer")


# -- drives that do not fit together -----------------------------------------------------------------------------------


def both(other_x, other_time):
    first = rows((GPS, S3), *MAP).splitlines()
    return first, rows((other_time, S3), (other_x, "{:.4f}"), *MAP[1:]).splitlines()


@pytest.mark.parametrize("later", [0.0, 0.1, 3.0])
@pytest.mark.parametrize("interleaved", [False, True])
def test_two_drives_at_the_same_time_are_refused_with_their_rows(tmp_path, later, interleaved):
    first, second = both(X + 35.0, GPS + later)
    lines = [line for pair in zip(first, second) for line in pair] if interleaved else first + second
    with pytest.raises(RoadExtractionError, match=r"at two places at once: row \d+ .* row \d+ .* m apart"):
        clean_trajectory(read(tmp_path, "time,x,y,z\n" + "\n".join(lines)))


def test_rows_that_are_there_twice_or_in_another_order_are_one_drive(tmp_path):
    first, second = both(X, GPS)
    for lines in (first + second, first[::-1], first[20:] + first[:20]):
        found = clean_trajectory(read(tmp_path, "time,x,y,z\n" + "\n".join(lines)))
        check(found, GPS)


def test_two_drives_one_after_the_other_are_one_trajectory(tmp_path):
    first, second = both(X + 35.0, GPS + 3600.0)
    assert len(clean_trajectory(read(tmp_path, "time,x,y,z\n" + "\n".join(second + first)))) == 2 * ROWS
