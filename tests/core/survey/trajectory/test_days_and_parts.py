"""Times that are written as days with their shares, or as a date and a clock in columns of their own."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.trajectory.reader import read_trajectory
from written_drives import GPS, MAP, UTC_CLOCKS, clock, rows

PARTS = ("%Y", "%m", "%d", "%H", "%M", "%S.%f")
UTC, DAY = GPS - 18, 86_400
WRITTEN = {
    "a date and a clock": "Year,Month,Day,Hour,Minute,UTC Second,x,y,z\n" + rows(*(clock(part, UTC_CLOCKS) for part in PARTS), *MAP),
    "their letters": "yyyy mm dd hh mm ss(GPS) x y z\n" + rows(*map(clock, PARTS), *MAP, mark=" "),
    "years of two digits, in German": "UTC Jahr;Monat;Tag;Stunde;Minute;Sekunde;x;y;z\n" + rows(
        *(clock(part, UTC_CLOCKS) for part in ("%y", *PARTS[1:])), *MAP, mark=";"),
    "seconds of the week beside them": "Year,Month,Day,Hour,Minute,Second,GPS time,x,y,z\n" + rows(*map(clock, PARTS), (GPS, "{:.3f}"), *MAP),
    "modified Julian days": "MJD (GPS),x,y,z\n" + rows((44244 + GPS / DAY, "{:.11f}"), *MAP),
    "Julian days": "UTC Julian date;x;y;z\n" + rows((2444244.5 + UTC / DAY, "{:.10f}"), *MAP, mark=";"),
    "days of a spreadsheet": "UTC date,x,y,z\n" + rows((29226 + UTC / DAY, "{:.11f}"), *MAP),
    "a spreadsheet's day and its share": "GPS date,Time,x,y,z\n" + rows((29226 + GPS // DAY, "{:.0f}"), (GPS / DAY % 1, "{:.11f}"), *MAP),
}


def read(tmp_path, text):
    path = tmp_path / "drive.csv"
    path.write_text(text)
    return read_trajectory(path)


@pytest.mark.parametrize("written", WRITTEN)
def test_days_and_parts_of_a_time_are_read_where_it_is_said_what_the_clock_shows(tmp_path, written):
    found = read(tmp_path, WRITTEN[written])
    assert found.has_time
    np.testing.assert_allclose(found.time, GPS, atol=1e-4)   # doubles hold Julian days to 40 µs


@pytest.mark.parametrize("days, decimals, says", [
    (29226 + GPS / DAY, 10, "holds days of a spreadsheet such as '4448.*gps or utc"),
    (44244 + GPS / DAY, 6, "last decimal is 0.086 s"),
    (287 + GPS / DAY % 1, 10, "287.99.* is no day of a known count")])
def test_days_of_which_the_clock_the_decimals_or_the_count_do_not_do_are_refused_and_shown(tmp_path, days, decimals, says):
    with pytest.raises(RoadExtractionError, match=says):
        read(tmp_path, "Time,x,y,z\n" + rows((days, f"{{:.{decimals}f}}"), *MAP))


def test_a_date_and_a_clock_in_columns_that_say_nothing_of_the_clock_are_refused_and_shown(tmp_path):
    with pytest.raises(RoadExtractionError, match="such as '2021-10-1.*it is not said whether the clock shows GPS time, UTC"):
        read(tmp_path, "Year,Month,Day,Hour,Minute,Second,x,y,z\n" + rows(*map(clock, PARTS), *MAP))
