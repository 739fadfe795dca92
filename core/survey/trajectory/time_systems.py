"""The systems of GPS time, and the conversion of a trajectory's time to that of the point cloud."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np

from ...common.errors import RoadExtractionError
from ..weights import TRAJECTORY

# Times that are written as text: dates and clocks.

_DATE = r"(?P<date>\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{4}|\d{8})"
_CLOCK = r"(?P<hour>\d{1,2}):(?P<minute>\d{2})(?::(?P<second>\d{2}(?:[.,]\d*)?))?\s*(?P<half>[ap]\.?m\.?)?"
_ZONE = r"(?P<zone>Z|UTC|GMT|GPST?|[+-]\d{2}:?\d{2})?"
TIME = re.compile(rf"(?:{_DATE}(?:\s*[T ,]\s*|$))?(?:{_CLOCK})?\s*{_ZONE}$", re.IGNORECASE)
COMPACT = re.compile(r"(\d{4})(\d{2})(\d{2})T(\d{2})(\d{2})(\d{2})(?!\d)")                       # 20211013T234640
MONTH_NAME = re.compile(r"(\d{1,2})[-/. ](jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]*\.?[-/., ]+(\d{4})", re.IGNORECASE)
YEAR_SIGN = re.compile(r"(\d{4}) ?年 ?(\d{1,2}) ?月 ?(\d{1,2}) ?日")               # 2021年10月13日
CLOCK_SIGNS = re.compile(r"(\d{1,2}) ?[时時] ?(\d{1,2}) ?分(?: ?(\d{1,2}(?:[.,]\d*)?) ?秒)?")   # 23时46分40秒
MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
GPS_EPOCH = datetime(1980, 1, 6)   # source: IS-GPS-200
SECONDS_PER_WEEK, SECONDS_PER_DAY = 604800.0, 86400.0   # source: definition
UNIX_EPOCH = (GPS_EPOCH - datetime.fromisoformat("1970-01-01")).total_seconds()   # s from 1970 to the start of GPS time
# Days on which a second was inserted into UTC since GPS time began (IERS Bulletin C); none is announced after the last
LEAP_DAYS = ("1981-07-01", "1982-07-01", "1983-07-01", "1985-07-01", "1988-01-01", "1990-01-01", "1991-01-01", "1992-07-01", "1993-07-01",
             "1994-07-01", "1996-01-01", "1997-07-01", "1999-01-01", "2006-01-01", "2009-01-01", "2012-07-01", "2015-07-01", "2017-01-01")


# Where counts of days begin, in the Gregorian calendar; of several that may be, the first that gives a day of FIRST_SURVEY or later
DAY_COUNTS = {"modified Julian days": "1858-11-17", "days of a spreadsheet": "1899-12-30", "days of MATLAB": "-0001-12-31",
              "days of the Julian date": "-4713-11-24T12"}
FIRST_SURVEY, LAST_SURVEY = "1990-01-01", "2050-01-01"


@dataclass(frozen=True)
class ClockTimes:
    """Clock times that were written as text, or as days."""

    seconds: np.ndarray   # (N,) since 6 January 1980 as the clock counts, or since its midnight where no date is written; NaN where a text is no time
    dated: bool   # dated, order_known: whether dates are written, and whether day and month can be distinguished
    zone: str   # "UTC" or "GPS" where the texts say so, "" otherwise; times with an offset from UTC are brought to UTC
    order_known: bool
    kind: str = "times of a clock"   # kind, first: what was written, and the first of them
    first: str = ""


def hold_times(texts: Sequence[str]) -> bool:
    """Whether most texts of a column are clock times, with dates or without, or dates."""
    return are_mostly(texts, lambda text: (match := _match(text)) and (match["hour"] or match["date"] and not match["date"].isdigit()))


def are_mostly(texts: Sequence[str], say: Callable[[str], Any]) -> bool:
    """Whether most texts of a column that are no blanks are such as a function tells."""
    sample = [text.strip() for text in texts if text.strip()][:TRAJECTORY.texts_looked_at]
    return bool(sample) and sum(map(bool, map(say, sample))) >= TRAJECTORY.most_of_texts * len(sample)


def _match(text):
    """TIME in a text, where months may have English names, ISO 8601 its short form, and the parts their Chinese and Japanese signs."""
    text = COMPACT.sub(r"\1-\2-\3 \4:\5:\6", text.strip())
    text = CLOCK_SIGNS.sub(lambda parts: ":".join(part.zfill(2) for part in parts.groups() if part), YEAR_SIGN.sub(r"\1-\2-\3 ", text))
    return TIME.match(MONTH_NAME.sub(lambda named: f"{named[3]}-{MONTHS.index(named[2].lower()) + 1}-{named[1]}", text))


def clock_times(texts: Sequence[str]) -> ClockTimes | None:
    """Clock times of (N,) texts; None where they are none."""
    if not hold_times(texts):
        return None
    matches = [*map(_match, texts)]
    dates = {match["date"] for match in filter(None, matches)} - {None}
    day_first, order_known = _order(dates)
    # without any date the clock alone counts, and with dates a clock without one is none
    midnight = {date: _midnight(date, day_first) for date in dates} or {None: 0.0}
    seconds = np.array([np.nan if match is None else _clock_seconds(match, midnight) for match in matches])
    zone = _common_zone({(match["zone"] or "").upper() for match, second in zip(matches, seconds) if not np.isnan(second)})
    return ClockTimes(seconds, bool(dates), zone, order_known, first=next(filter(None, texts), ""))


def _common_zone(zones):
    """"GPS" or "UTC" where every time says what it is of, otherwise ""."""
    return "" if "" in zones or not zones else "GPS" if all(name.startswith("GPS") for name in zones) else "UTC"


def _clock_seconds(match, midnight):
    """Seconds of a clock time in UTC, where it says how far off that it is; NaN where it lacks a date that others have, or a clock and a date."""
    if match["date"] not in midnight or not match["hour"] and not match["date"]:
        return np.nan
    zone = match["zone"] or ""
    ahead = (60 * int(zone[1:3]) + int(zone[-2:])) * 60.0 * (1 if zone[0] == "+" else -1) if zone[:1] in ("+", "-") and zone else 0.0
    return midnight[match["date"]] + (_since_midnight(match) if match["hour"] else 0.0) - ahead


def _since_midnight(match):
    hour = int(match["hour"])
    if match["half"]:
        hour = hour % 12 + (12 if match["half"][0] in "pP" else 0)
    return 3600.0 * hour + 60.0 * int(match["minute"]) + float((match["second"] or "0").replace(",", "."))


def _order(dates):
    """(whether the day stands before the month, whether that is beyond doubt) of dates with the year behind."""
    parts = [list(map(int, re.split(r"[-/.]", date))) for date in dates if re.match(r"\d{1,2}[-/.]", date)]
    if any(first > 12 for first, *_ in parts):
        return True, True
    if any(second > 12 for _, second, _ in parts):
        return False, True
    return True, all("." in date or not re.match(r"\d{1,2}[-/]", date) for date in dates)


def _midnight(date, day_first):
    """Seconds from 6 January 1980 to the beginning of a day; NaN for a day that there is not."""
    if date.isdigit():
        parts = [date[:4], date[4:6], date[6:]]
    else:
        parts = re.split(r"[-/.]", date)
        if len(parts[0]) != 4:
            parts = [parts[2], *(parts[1::-1] if day_first else parts[:2])]
    try:
        return (datetime(*map(int, parts)) - GPS_EPOCH).total_seconds()
    except ValueError:
        return np.nan


def counted_days(values: np.ndarray, texts: Callable[[], Sequence[str]], what: str) -> ClockTimes | None:
    """The clock times of (N,) days and their shares, as MJD or spreadsheets count them; None of values that count seconds.

    texts : gives the (N,) texts as they are written; what : the beginning of a message. RoadExtractionError if they go up like days, but are of no
    known count, or have too few decimals.
    """
    steps = np.diff(values)
    steps = steps[steps > 0]
    if not len(steps) or not np.median(steps) < TRAJECTORY.shortest_step:
        return None
    first = values[np.isfinite(values)][0]
    kind = next((kind for kind, begins in DAY_COUNTS.items() if _days_from(begins, FIRST_SURVEY) <= first < _days_from(begins, LAST_SURVEY)), "")
    last_decimal = SECONDS_PER_DAY * 10.0 ** -max(len(re.split("[.,]", text)[-1]) for text in texts()[:TRAJECTORY.texts_looked_at])
    finding = f"{what} goes up by {np.median(steps):.2g} from row to row as if it counted days, "
    if not kind:
        raise RoadExtractionError(f"{finding}but {first:.10g} is no day of a known count (MJD, Julian days, a spreadsheet). GPS seconds are needed: "
                                  "export the trajectory with these.")
    if last_decimal / 2 > TRAJECTORY.shortest_step:   # by half of it times are rounded
        raise RoadExtractionError(f"{finding}and its last decimal is {last_decimal:.2g} s. Export the trajectory with GPS seconds, or with 8 "
                                  "decimals of a day.")
    seconds = (values - _days_from(DAY_COUNTS[kind], GPS_EPOCH)) * SECONDS_PER_DAY
    return ClockTimes(seconds, True, "", True, kind, f"{first:.10g}")


def _days_from(begins, day):
    return (np.datetime64(day) - np.datetime64(begins)) / np.timedelta64(1, "D")


def leap_seconds(seconds: np.ndarray) -> np.ndarray:
    """(N,) seconds by which GPS time is ahead of UTC, at UTC times in seconds since 6 January 1980."""
    days = [(datetime.fromisoformat(day) - GPS_EPOCH).total_seconds() for day in LEAP_DAYS]
    return np.searchsorted(days, seconds, side="right").astype(float)


ADJUSTED_OFFSET = 1e9  # source: s by which adjusted standard GPS time is less than GPS time (ASPRS LAS 1.4)
TIME_SYSTEMS = ("automatic", "gps", "adjusted", "week", "day")
TIME_SYSTEM_NAMES = {"as it is": "the cloud's own seconds", "gps": "GPS seconds since 1980", "adjusted": "adjusted GPS seconds (GPS less 1e9)",
                     "week": "seconds of the week", "day": "seconds of the day"}
TAI_TO_GPS = 19.0     # source: s by which TAI is ahead of GPS time (IS-GPS-200)
LARGEST_SHIFT = TAI_TO_GPS + len(LEAP_DAYS)   # derived: s between two clocks, TAI and UTC


def unwrap_time(time: np.ndarray) -> np.ndarray:
    """(N,) seconds of the week or day in driving order, continued past midnight or the end of the week; the same where neither ends."""
    time = np.asarray(time, float)
    rows = np.flatnonzero(np.isfinite(time))
    if len(rows) < 2:
        return time
    values = time[rows]
    step = np.diff(values)
    for period in (SECONDS_PER_WEEK, SECONDS_PER_DAY):
        # A new start from zero is a single step back by nearly the whole period, while time increases otherwise.
        back = step < -0.9 * period
        if back.any() and back.sum() * 20 < len(step) + 20 and values.max() <= period * 1.001 and values.min() >= 0 \
                and (step[~back] >= 0).mean() > 0.95:
            carried = time.copy()
            carried[rows] = values + period * np.r_[0.0, np.cumsum(back)]
            return carried
    return time


def unwrap_week(time: np.ndarray) -> np.ndarray:
    """Seconds of the week, continued beyond the end of the week where it ends during the scan; (N,)."""
    return np.where(time < SECONDS_PER_WEEK / 2, time + SECONDS_PER_WEEK, time)


def wrapped_week(span: tuple[float, float]) -> bool:
    """Whether a cloud's (first, last) gps_time in seconds shows that a GPS week ended during the drive."""
    return 0 <= span[0] and span[1] <= SECONDS_PER_WEEK * 1.001 and span[1] - span[0] > 0.75 * SECONDS_PER_WEEK


def time_system_by_size(time: np.ndarray) -> str:
    """What (N,) times most likely count, by their size alone: gps, adjusted, week or day; "" where that is not clear."""
    first, last = float(np.nanmin(time)), float(np.nanmax(time))
    earliest, latest = TRAJECTORY.first_gps_seconds, TRAJECTORY.last_gps_seconds
    if earliest < first and last < latest:
        return "gps"
    if earliest - ADJUSTED_OFFSET < first < 0 or SECONDS_PER_WEEK < first and last < latest - ADJUSTED_OFFSET:
        return "adjusted"
    if 0 <= first and SECONDS_PER_DAY < last <= SECONDS_PER_WEEK:
        return "week"
    return ""


def align_time(time: np.ndarray, cloud_span: tuple[float, float], system: str = "automatic", adjusted: bool = True) -> tuple[float, str]:
    """Seconds to add to a trajectory's time to convert it to the cloud's, and a sentence for the user, "" where nothing is to be told.

    Leap seconds are never guessed: where a shift of 18 s (or 17, 37 ...) would make the two agree, the note or the message says so, and the user
    decides.

    time : (N,) seconds of the trajectory, in driving order where the count starts again from zero
    cloud_span : (first, last) gps_time of the cloud, seconds
    system : "gps" (seconds since 1980), "adjusted" (the same minus 1e9), "week", "day", or "automatic"
    adjusted : whether the header of the cloud states adjusted standard GPS time

    Raises RoadExtractionError if the time system is not known, the trajectory has no times, or cloud and trajectory overlap in no time system.
    """
    if system not in TIME_SYSTEMS:
        raise RoadExtractionError(f"The time system {system!r} is not known; choose one of {', '.join(TIME_SYSTEMS)}.")
    if not np.isfinite(time).any():
        raise RoadExtractionError("The trajectory holds no position with a time. Check the file, or export it again.")
    time = unwrap_time(time)
    first, last = float(np.nanmin(time)), float(np.nanmax(time))
    cloud_first, cloud_last = map(float, cloud_span)
    options = _offsets(first, last, (cloud_first + cloud_last) / 2, system)

    def overlap(offset):
        return min(last + offset, cloud_last) - max(first + offset, cloud_first)

    name, offset = max(options, key=lambda option: (overlap(option[1]) > -TRAJECTORY.time_tolerance and option[0] == "as it is", overlap(option[1])))
    hint = _leap_hint(first + offset, last + offset, cloud_first, cloud_last)
    if overlap(offset) <= -TRAJECTORY.time_tolerance:
        tried = "One of them may use another time system: set the trajectory's time system (gps, adjusted, week or day) and run again." \
            if system == "automatic" else \
            f"The trajectory was taken to count {TIME_SYSTEM_NAMES[system]}: set its time system to automatic and run again."
        hint = hint or _unix_hint(first, last, cloud_first, cloud_last)
        raise RoadExtractionError(
            f"The trajectory does not cover the scan in time. The scan was recorded from {cloud_first:.1f} s to {cloud_last:.1f} s"
            f"{'' if not adjusted or cloud_last > SECONDS_PER_WEEK else ' (adjusted GPS time according to its header)'}, "
            f"the trajectory runs from {first:.1f} s to {last:.1f} s. {hint or tried}")
    if not offset:
        return 0.0, hint
    note = f"The trajectory counts {TIME_SYSTEM_NAMES[name]}; {offset:+.0f} s convert it to the time of the cloud."
    return offset, f"{note} {hint}".strip()


def _offsets(first, last, cloud, system):
    """[(system, offset)]: the offsets that may convert each time system to that of a cloud about a time, to the period nearest to it."""
    absolute = cloud > 1.5 * SECONDS_PER_WEEK   # its count does not start again every week
    shift = -ADJUSTED_OFFSET * (absolute and cloud < ADJUSTED_OFFSET)
    of_a_day = cloud < 1.5 * SECONDS_PER_DAY
    periods, never = (SECONDS_PER_WEEK, SECONDS_PER_DAY), (1e12,)
    since_1980 = absolute | (first > 2 * SECONDS_PER_WEEK) | (first < 0), never if absolute else periods[:1 + of_a_day]
    rows = (("adjusted", ADJUSTED_OFFSET, *since_1980), ("gps", 0.0, *since_1980),
            ("week", 0.0, last <= 2 * SECONDS_PER_WEEK, periods[:1 + (of_a_day & (first >= 1.5 * SECONDS_PER_DAY))]),
            ("day", 0.0, last <= 2 * SECONDS_PER_DAY, periods[1:]))
    options = [(name, float(begins + shift + period * np.rint((cloud - (first + last) / 2 - begins - shift) / period)))
               for name, begins, likely, counts in rows if (system == name) | (system == "automatic") & likely for period in counts]
    return [("as it is", 0.0)] * (system == "automatic") + options


def is_to_come(seconds: float) -> bool:
    """Whether GPS seconds lie in the future: then they count from 1970, ten years before GPS time."""
    return seconds > time.time() - UNIX_EPOCH + SECONDS_PER_DAY


def unix_time_found(seconds: float, what: str) -> str:
    """The sentence on a time that counts from 1970; `what` is its beginning, on who counts."""
    utc = seconds - UNIX_EPOCH
    leap = float(leap_seconds(np.array([utc]))[0])
    return (f"{what} Unix time: {seconds:.0f} s since 1970 are GPS {utc + leap:.0f} s in UTC, which is behind by {leap:.0f} s. Export GPS time, or "
            "write utc in place of time in Columns of Import trajectory.")


def _unix_hint(first, last, cloud_first, cloud_last):
    """A sentence where the trajectory would cover the scan if it counted from 1970; otherwise ""."""
    for shift in (0.0, -ADJUSTED_OFFSET):
        if min(last - UNIX_EPOCH + shift, cloud_last) - max(first - UNIX_EPOCH + shift, cloud_first) > -LARGEST_SHIFT:
            return unix_time_found(first, "Its times seem to count")
    return ""


def _leap_hint(first, last, cloud_first, cloud_last):
    """A sentence where a shift by leap seconds would cover a scan that is not covered now; otherwise ""."""
    early, late = first - cloud_first, cloud_last - last
    if max(early, late) <= TRAJECTORY.time_tolerance or max(early, late) > LARGEST_SHIFT + TRAJECTORY.time_tolerance:
        return ""
    gps_to_utc = [float(len(LEAP_DAYS) - years) for years in range(5)]   # since the last leap second, and before each of the last four
    for leap in (*gps_to_utc, *(TAI_TO_GPS + shift for shift in gps_to_utc[:3]), TAI_TO_GPS):
        for shift in (leap, -leap):
            if first + shift - cloud_first <= 0.1 and cloud_last - last - shift <= 0.1:
                gap = f"The scan begins {early:.1f} s before the trajectory" if early > late else f"The scan ends {late:.1f} s after the trajectory"
                return f"{gap}, and {leap:.0f} s would make them agree, as leap seconds do: if the trajectory is in UTC, export it in GPS time."
    return ""
