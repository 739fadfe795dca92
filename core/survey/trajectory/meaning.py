"""What the columns of a table mean: which is which, by names, units and contents, and their values as a trajectory needs them."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.text_table import finite_or_nan, read_number_table
from ...lazy import pyproj
from ..weights import TRAJECTORY
from .columns import ROLES, candidates_by_role, columns_from_numbers, listed, rough_metres
from .table_columns import TableColumn, angle_of, first_row, is_record, titled_columns, with_week
from .time_systems import UNIX_EPOCH, clock_times, counted_days, is_to_come, leap_seconds, time_system_by_size, unix_time_found
from .trajectory import Trajectory

EARTH_RADIUS = 6.33e6, 6.42e6    # source: m (WGS 84: 6.357e6 to 6.378e6) from the centre of the earth to its surface, with mountains
FROM_CENTRE = ("ecef_x", "ecef_y", "ecef_z")   # roles of earth-centred coordinates
SAY_WHICH = "Say which is which in Columns of Import trajectory."
MEAN_SEA_LEVEL = ("ortho", "msl", "sea", "geoid")   # in names of heights
COUNTS_OTHERS = re.compile(r"id\b|\b(no|nr)\b|num|count|index|station|chainage|dist|length|km|frame|image|photo|row|line|record", re.IGNORECASE)
CLOCK_WORDS = {"UTC": "utc|gmt|zulu", "GPS": "gps"}   # in names of times
TOLD_CLOCKS = {"gps": "GPS", "utc": "UTC"}          # words of Columns that say what a clock shows


@dataclass(frozen=True)
class _Meaning:
    """place : {role: index of a column}; notes : sentences for the user; clock : "GPS" or "UTC" where the user said so"""

    place: Mapping[str, int]
    notes: tuple[str, ...] = ()
    clock: str = ""


def meaning_of(columns: Sequence[TableColumn], label: str, given: Sequence[str] = ()) -> _Meaning:
    """The roles of named columns, without those that are `given` from elsewhere, such as x and y from the points of a layer.

    Geodetic coordinates are preferred to earth-centred ones, numbers to clock times, and the usual names to others.
    """
    notes: list[str] = []
    # columns that may be a role by their names and hold something, the likeliest first
    full = {role: [k for k in places if not columns[k].is_empty]
            for role, places in candidates_by_role([column.title for column in columns]).items()}
    _prefer_geodetic(columns, full, label, notes)
    column_of = {role: places[0] for role, places in full.items() if places and role not in given}
    if "minute" in column_of:
        column_of["minute"] = full["minute"][-1]                  # mm may be months too, which come first
        full["time"] = [k for k in full.get("time", ()) if k != column_of.get("hour")]
    times = _time_columns(columns, full, set(column_of.values()))
    if times and "time" not in given:
        column_of["time"] = times[0]
    if "z" in column_of:
        notes += _note_on_heights([columns[k].title for k in full["z"]], label)
    return _Meaning(column_of, tuple(notes))


def _time_columns(columns, candidates, used):
    """Columns that may be the time, the likeliest first: numbers with its name, texts, clocks without a name, days with their share."""
    named = candidates.get("time", [])
    return [k for k in named if not columns[k].is_text] or named \
        or [k for k, column in enumerate(columns) if k not in used and column.holds_clock_times] \
        or [k for k in candidates.get("date", ()) if (columns[k].values % 1 > 0).any()]


def _note_on_heights(titles, label):
    """A sentence where some heights are above mean sea level and others are not."""
    above_sea = {any(word in title.lower() for word in MEAN_SEA_LEVEL) for title in titles}
    return [f"{label} has several heights; {listed(titles[:1])} is used, not {listed(titles[1:])}."] if len(above_sea) > 1 else []


def _prefer_geodetic(columns, places, label, notes):
    """Keep earth-centred X, Y, Z apart from x, y, z on a map, whatever they are called; drop them beside longitude and latitude."""
    axes = [places.get(axis) for axis in "xyz"]
    if all(axes) and _earth_centred(*(columns[axis[0]].values for axis in axes)):
        for role, axis in zip(FROM_CENTRE, axes):
            places.setdefault(role, []).insert(0, axis.pop(0))
    if any(map(places.get, FROM_CENTRE)) and all(map(places.get, ("lon", "lat", "z"))):
        notes.append(f"{label} has earth-centred coordinates beside longitude and latitude; the latter are used, with the heights in "
                     f"{listed([columns[places['z'][0]].title])}.")
        places.update(dict.fromkeys(FROM_CENTRE, []))


def _earth_centred(x, y, z):
    """Whether three columns are coordinates from the centre of the earth."""
    good = np.isfinite(x) & np.isfinite(y) & np.isfinite(z)
    if not good.any():
        return False
    radius = np.median(np.sqrt(x[good]**2 + y[good]**2 + z[good]**2))
    return bool(EARTH_RADIUS[0] < radius < EARTH_RADIUS[1] and np.median(np.abs(z[good])) > TRAJECTORY.highest_road)


def values_by_role(columns: Sequence[TableColumn], meaning: _Meaning, label: str, notes: list[str], doubts: list[str]) -> dict[str, np.ndarray]:
    """{role: (N,) float64} of a trajectory's columns: seconds, metres, degrees; roll, pitch and heading in the unit of their columns.

    Sentences for the user and warnings are added to `notes` and `doubts`. RoadExtractionError if times are clock times of which it is not said what
    they show, or count from 1970.
    """
    column_of = meaning.place
    values = {role: columns[k].in_metres if role in "xyz" else columns[k].values for role, k in column_of.items() if role in ROLES[1:]}
    values.update({role: angle_of(columns, column_of[role], most) for role, most in (("lon", 180.0), ("lat", 90.0)) if role in column_of})
    if not {"lon", "x"} & set(values) and set(FROM_CENTRE) <= set(column_of):
        transformer = pyproj.Transformer.from_crs("EPSG:4978", "EPSG:4979", always_xy=True)
        values.update(zip(("lon", "lat", "z"), map(finite_or_nan, transformer.transform(*(columns[column_of[role]].values for role in FROM_CENTRE)))))
        notes.append(f"{label} gives earth-centred coordinates; they were converted to longitude, latitude and height above the ellipsoid.")
    if "time" in column_of:
        values["time"] = _time(columns, meaning, label, notes, doubts)
    else:
        doubts += _like_time(columns, set(column_of.values()), label)
    return values


def _time(columns, meaning, label, notes, doubts):
    """(N,) seconds of GPS time, or as the column counts."""
    column_of = meaning.place
    column = columns[column_of["time"]]
    times = _written_time(columns, column_of, label)
    if times is not None:
        titles = " ".join(columns[column_of[role]].title for role in ("time", "date", "year", "hour") if role in column_of).lower()
        return _gps_seconds(times, column, titles, meaning.clock, label, notes)
    if column.holds_texts:
        raise RoadExtractionError(f"The column {_named(column)} of {label} should be the time, but holds {column.first[:TRAJECTORY.longest_name]!r}. "
                                  f"The first row reads {first_row(columns)}. {SAY_WHICH}")
    if "utc" in column.title.lower():
        doubts.append(f"The column {_named(column)} of {label} counts seconds of UTC by its name; no leap seconds were added. If lines come out "
                      "shifted along the road, export GPS time.")
    seconds = _counted_seconds(column, label, doubts)
    if "week" in column_of and column_of["week"] != column_of["time"]:
        return with_week(seconds, columns[column_of["week"]].values)
    return _from_1970(seconds, column.title, meaning.clock, label, notes)


def _written_time(columns, place, label):
    """The ClockTimes of a table whose time is a clock, in one column or several, or counts days; None where it counts seconds."""
    column, date = columns[place["time"]], columns[place["date"]] if place.get("date", place["time"]) != place["time"] else None
    days = _days(columns, place, date)
    texts = list(column.written()) if column.is_text else _clock_in_numbers(columns, place, days)
    if texts is None:
        shares_of_days = date is not None and np.nanmax(column.values, initial=0.0) < 1.0
        return counted_days(column.values + (date.values if shares_of_days else 0.0), column.written, f"The column {_named(column)} of {label}")
    times = clock_times(texts)
    if times is not None and not times.dated and days is not None:
        times = clock_times([f"{day} {text}" for day, text in zip(days, texts)]) or times
    return times


def _days(columns, place, date):
    """(N,) dates as texts, of a column of dates or of a year, a month and a day; None where there are none."""
    if date is not None:
        return [day.split(".")[0] if day[:8].isdigit() else day for day in date.written()]
    if not all(role in place for role in ("year", "month", "day")):
        return None
    year, month, day = (columns[place[role]].values for role in ("year", "month", "day"))
    return [f"{y:04.0f}-{m:02.0f}-{d:02.0f}" for y, m, d in zip(np.where(year < 100, year + 2000, year), month, day)]


def _counted_seconds(column, label, doubts):
    """(N,) seconds of a column that counts them, or smaller units."""
    seconds = column.values * column.unit.factor if column.unit.name == "seconds" else column.values
    largest = np.nanmax(np.abs(seconds), initial=0.0)
    if column.unit.name != "seconds" and largest > TRAJECTORY.largest_seconds:
        factor = next((10.0**-power for power in (3, 6, 9) if largest * 10.0**-power < TRAJECTORY.largest_seconds), 1.0)
        seconds = seconds * factor
        doubts.append(f"The times of {label} are so large that they are taken as counts of {factor:g} s.")
    return seconds


def _from_1970(seconds, title, shown, label, notes):
    """(N,) GPS seconds of what counts from 1970 in UTC, where the clock is said to have `shown` UTC; other seconds as they are."""
    first = float(seconds[np.isfinite(seconds)][0]) if np.isfinite(seconds).any() else np.nan
    if shown == "UTC" and first > UNIX_EPOCH:
        return _added_leap_seconds(seconds - UNIX_EPOCH, label, notes)
    if shown == "UTC":
        raise RoadExtractionError(f"Columns says utc of {listed([title or 'a column'])}, but {first:.1f} is no date and no count "
                                  "from 1970, so the leap seconds are not known. Write time in place of utc.")
    if is_to_come(first) or any(word in title.lower() for word in ("unix", "posix")):
        raise RoadExtractionError(unix_time_found(first, f"The times of {label} seem to count"))
    return seconds


def _clock_in_numbers(columns, place, days):
    """(N,) texts of clock times that stand in three columns of numbers, or in one as hhmmss; None for other times."""
    column = columns[place["time"]]
    title, values = column.title.lower(), column.values
    if {"hour", "minute"} <= set(place) and np.nanmax(values, initial=0.0) <= 61.0:
        hour, minute = (columns[place[role]].values for role in ("hour", "minute"))
    elif _are_packed_clocks(values, "hhmmss" in title or days is not None and "utc" in title and not column.unit.name):
        hour, minute, values = values // 10_000, values // 100 % 100, values % 100
    else:
        return None
    return ["" if np.isnan(h + m + s) else f"{h:02.0f}:{m:02.0f}:{s:09.6f}" for h, m, s in zip(hour, minute, values)]


def _are_packed_clocks(values, named):
    """Whether (N,) numbers are clock times hhmmss; `named` where a date or their name says so."""
    clocks = values[np.isfinite(values)]
    step = np.diff(clocks)
    if not len(step) or clocks.min() < 0 or clocks.max() >= 240_000 or (clocks % 100 >= 60).any() or (clocks // 100 % 100 >= 60).any():
        return False
    # from 59 s to the next minute such a number goes up by 40 more than the seconds do, and other times never do
    over = np.diff(np.floor(clocks / 100)) > 0
    return bool((named or over.any() and not over.all()) and (step[over] > 40.0).all() and (step[~over] < 40.0).all())


def _gps_seconds(times, column, titles, clock, label, notes):
    """(N,) GPS seconds of ClockTimes, where it is known what the clock shows."""
    named = next((shown for shown, words in CLOCK_WORDS.items() if re.search(words, titles)), "")
    shows = clock or ("" if {times.zone, named} == {"UTC", "GPS"} else times.zone or named)
    if times.order_known and shows == "GPS":
        return times.seconds
    if times.order_known and shows == "UTC" and times.dated:
        return _added_leap_seconds(times.seconds, label, notes)
    reason, advice = _unknown_clock(times, shows)
    raise RoadExtractionError(f"The column {_named(column)} of {label} holds {times.kind} such as {times.first[:TRAJECTORY.longest_name]!r}. GPS "
                              f"seconds are needed, and {reason}. Export the trajectory with GPS time in seconds; or {advice}.")


def _named(column):
    return listed([column.title or "without a name"])


def _unknown_clock(times, shows):
    """Why the GPS seconds of ClockTimes are not known, and what to do about it."""
    if shows and not times.order_known:
        return "day and month cannot be distinguished", "write dates as year-month-day"
    if shows:
        return f"without a date it is not known by how many seconds {shows} differs from them", "add the date"
    seconds = times.seconds[np.isfinite(times.seconds)]
    difference = f"by {leap_seconds(seconds[:1])[0]:.0f} s on this day" if times.dated and len(seconds) else "by leap seconds"
    return (f"it is not said whether the clock shows GPS time, UTC, which differs {difference}, or local time",
            "call the column GPS time or UTC, or write gps or utc in place of time in Columns of Import trajectory, if you know what it shows")


def _added_leap_seconds(utc, label, notes):
    leap = leap_seconds(utc[np.isfinite(utc)])
    seconds = utc.copy()
    seconds[np.isfinite(utc)] += leap
    if len(leap):
        notes.append(f"The times of {label} are UTC; {leap[0]:.0f} leap seconds were added to make them GPS time.")
    return seconds


def _like_time(columns, used, label):
    """A sentence for columns that increase evenly like time and are not used."""
    likely = [f"{listed([column.title or f'column {k + 1}'])} ({column.values[finite][0]:.10g} to {column.values[finite][-1]:.10g})"
              for k, column in enumerate(columns) if k not in used and _increases_evenly(column.values[(finite := np.isfinite(column.values))])
              and not COUNTS_OTHERS.search(column.title)]
    if not likely:
        return []
    return [f"{label} has a column that increases evenly like time and is not used: {listed(likely)}. If it is the time, name it time, or say so in "
            "Columns of Import trajectory."]


def _increases_evenly(values):
    """Whether (N,) numbers increase in nearly equal steps, and do not count rows."""
    step = np.diff(values)
    if len(step) < 3 or not (step > 0).all() or (step == 1).all() and values[0] in (0, 1):
        return False
    usual = np.median(step)
    return np.mean(np.abs(step - usual) <= 0.2 * usual) > TRAJECTORY.least_even


# Columns of a trajectory that the user assigned by hand, and what was understood of a table.

ASSIGNABLE = (*ROLES, "lon", "lat", *TOLD_CLOCKS, "week", "date")
LEFT_OUT = ("-", "", "skip")


def assigned_columns(text: str, count: int, path: str | os.PathLike[str]) -> dict[str, int]:
    """{role: column} as the user wrote it: one word a column, from the left, separated by commas.

    A word is a role of ASSIGNABLE, or - for a column that is left out, as are those after the last word. gps and utc are times of which it is known
    what the clock shows. RoadExtractionError if a word is no role, a role is there twice, there are more words than columns (`count`), or a place
    or the height is missing.
    """
    column_of: dict[str, int] = {}
    for column, word in enumerate(_words(text)):
        if word in LEFT_OUT:
            continue
        if word not in ASSIGNABLE:
            raise RoadExtractionError(f"Columns names {word!r}, which is no part of a trajectory; use {', '.join(ASSIGNABLE)}, or - for a column "
                                      "that is left out.")
        word = "time" if word in TOLD_CLOCKS else word
        if word in column_of:
            raise RoadExtractionError(f"Columns names {word} twice, for column {column_of[word] + 1} and column {column + 1}. Name each once.")
        column_of[word] = column
    if max(column_of.values(), default=0) >= count:
        raise RoadExtractionError(f"Columns names {max(column_of.values()) + 1} columns, but {path} has {count}. Name as many as there are.")
    missing = [role for role, geographic in (("x", "lon"), ("y", "lat"), ("z", "z")) if role not in column_of and geographic not in column_of]
    if missing:
        raise RoadExtractionError(f"Columns names no {' and no '.join(missing)}. A trajectory needs x, y (or lon, lat) and z.")
    return column_of


def _words(text):
    return [word.strip().lower() for word in text.replace(";", ",").split(",")]


@dataclass(frozen=True)
class TableColumns:
    """The columns of a text table: titles and roles, "" without one, the first rows as (R, K) texts, and why the roles are not known."""

    titles: tuple[str, ...]
    roles: tuple[str, ...]
    rows: np.ndarray
    problem: str = ""


def columns_of_table(path: str | os.PathLike[str], columns: str = "", rows: int = 4) -> TableColumns:
    """What is understood of the columns of a text file, with the first `rows` of them.

    columns : as `assigned_columns` takes them; "" recognises them. RoadExtractionError if the file holds no table of numbers.
    """
    if is_record(Path(path)):
        raise RoadExtractionError(f"{path} is a log or a track, whose columns are known. Leave Columns empty.")
    table, unmatched = titled_columns(read_number_table(path))
    problem, meaning = "", _Meaning({})
    try:
        meaning = meaning_of_table(table, unmatched, Path(path), columns)
    except RoadExtractionError as refused:
        problem = str(refused)
    role_of = {column: role for role, column in meaning.place.items() if role in ASSIGNABLE}
    if meaning.clock:
        role_of[meaning.place["time"]] = meaning.clock.lower()
    shown = [[f"{value:.10g}" for value in column.values[:rows]] if not column.is_text else list(column.written())[:rows] for column in table]
    return TableColumns(tuple(column.title for column in table), tuple(role_of.get(k, "") for k in range(len(table))),
                        np.array(shown, object).T, problem)


def meaning_of_table(columns: Sequence[TableColumn], unmatched: Sequence[str] | None, path: Path, assigned: str = "") -> _Meaning:
    """The _Meaning of the columns of a file: as assigned, otherwise by the names above them, otherwise by their numbers.

    columns, unmatched : as `titled_columns` gives them; assigned : as `assigned_columns` takes it, "" where nothing was assigned.
    RoadExtractionError if the columns are not recognised.
    """
    if assigned.strip():
        clock = next((TOLD_CLOCKS[word] for word in _words(assigned) if word in TOLD_CLOCKS), "")
        return _Meaning(assigned_columns(assigned, len(columns), path), clock=clock)
    if any(column.title for column in columns):
        return meaning_of(columns, path.name)
    return _meaning_by_numbers(columns, unmatched, path)


def _meaning_by_numbers(columns, unmatched, path):
    """The _Meaning of columns without names; `unmatched` are names above them of which there are not as many."""
    clocks = [k for k, column in enumerate(columns) if column.holds_clock_times]
    numbers = np.setdiff1d(np.arange(len(columns)), clocks).tolist()
    try:
        column_of = {role: numbers[k] for role, k in columns_from_numbers(np.stack([columns[k].values for k in numbers], axis=1), path).items()}
    except RoadExtractionError as refused:
        if not unmatched:
            raise RoadExtractionError(f"{refused} The first row reads {first_row(columns)}.") from refused
        column_of = {}
    # small numbers are guessed by their order alone, which names that do not fit contradict
    guessed = "x" in column_of and np.nanmedian(np.abs(columns[column_of["x"]].values)) < TRAJECTORY.min_map_coordinate
    if unmatched and (guessed or not column_of):
        raise RoadExtractionError(
            f"{path} names {len(unmatched)} columns ({listed(unmatched)}), but its rows have {len(columns)}. The first row reads "
            f"{first_row(columns)}. {SAY_WHICH}")
    column_of = {"time": clocks[0], **column_of} if clocks else column_of
    listing = ", ".join(f"{role} in column {column_of[role] + 1}" for role in (*ROLES, "lon", "lat") if role in column_of)
    return _Meaning(column_of, (f"{path.name} has no line of names; recognised by the numbers: {listing}.",))


@dataclass(frozen=True)
class _TrajectoryFacts:
    """positions : number; length, low, high : m; seconds, speed (m/s, median) : NaN without time; system : as `time_system_by_size`"""

    positions: int
    length: float
    low: float
    high: float
    seconds: float
    speed: float
    system: str


def facts_of(trajectory: Trajectory) -> _TrajectoryFacts:
    """Length, duration, speed and heights of a Trajectory, in metres also where it is in degrees."""
    x, y = rough_metres(trajectory.x, trajectory.y, trajectory.crs)
    step = np.hypot(np.diff(x), np.diff(y))
    seconds = np.diff(trajectory.time) if trajectory.has_time else np.full(len(step), np.nan)
    moving = np.isfinite(step) & (seconds > 0)
    return _TrajectoryFacts(len(trajectory), float(np.nansum(step)), float(np.nanmin(trajectory.z)), float(np.nanmax(trajectory.z)),
                           float(np.nanmax(trajectory.time) - np.nanmin(trajectory.time)) if trajectory.has_time else np.nan,
                           float(np.median(step[moving] / seconds[moving])) if moving.any() else np.nan,
                           time_system_by_size(trajectory.time) if trajectory.has_time else "")
