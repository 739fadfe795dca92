"""Columns of a trajectory that the user assigned by hand, and what was understood of a table."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.text_table import read_number_table
from .columns import MIN_MAP_COORDINATE, ROLES, columns_from_numbers, listed, rough_metres
from .meaning import TOLD_CLOCKS, Meaning, meaning_of
from .receiver_logs import is_record
from .table_columns import CHECKED_ROWS, TableColumn, first_row, titled_columns
from .time_systems import ADJUSTED_OFFSET, SECONDS_PER_DAY, SECONDS_PER_WEEK, hold_times
from .trajectory import Trajectory

ASSIGNABLE = (*ROLES, "lon", "lat", *TOLD_CLOCKS, "week", "date")
LEFT_OUT = ("-", "", "skip")
FIRST_GPS_SECONDS, LAST_GPS_SECONDS = 0.6e9, 1.7e9     # s since 1980: 1999 to 2033


def assigned_columns(text: str, count: int, path: str | os.PathLike[str]) -> dict[str, int]:
    """Which column of a table has which role, as the user wrote it.

    Parameters
    ----------
    text : one word a column, from the left, separated by commas: a role of ASSIGNABLE, or - for a column that is left out. Columns
        after the last word are left out. gps and utc are times of which it is known what the clock shows
    count : columns of the table
    path : of the file, for messages

    Returns
    -------
    {role: column}

    Raises
    ------
    RoadExtractionError
        If a word is no role, a role is there twice, there are more words than columns, or a place or the height is missing.
    """
    place: dict[str, int] = {}
    for column, word in enumerate(_words(text)):
        if word in LEFT_OUT:
            continue
        if word not in ASSIGNABLE:
            raise RoadExtractionError(f"Columns names {word!r}, which is no part of a trajectory; use {', '.join(ASSIGNABLE)}, or - for a column "
                                      "that is left out.")
        word = "time" if word in TOLD_CLOCKS else word
        if word in place:
            raise RoadExtractionError(f"Columns names {word} twice, for column {place[word] + 1} and column {column + 1}. Name each once.")
        place[word] = column
    if max(place.values(), default=0) >= count:
        raise RoadExtractionError(f"Columns names {max(place.values()) + 1} columns, but {path} has {count}. Name as many as there are.")
    missing = [role for role, other in (("x", "lon"), ("y", "lat"), ("z", "z")) if role not in place and other not in place]
    if missing:
        raise RoadExtractionError(f"Columns names no {' and no '.join(missing)}. A trajectory needs x, y (or lon, lat) and z.")
    return place


def _words(text):
    return [word.strip().lower() for word in text.replace(";", ",").split(",")]


@dataclass(frozen=True)
class TableColumns:
    """The columns of a text table.

    titles : what stands above each column, "" where nothing does
    roles : of each column, "" for one that is left out
    rows : the first rows as texts, (R, K)
    problem : why the roles are not known, "" where they are
    """

    titles: tuple[str, ...]
    roles: tuple[str, ...]
    rows: np.ndarray
    problem: str = ""


def columns_of_table(path: str | os.PathLike[str], columns: str = "", rows: int = 4) -> TableColumns:
    """What is understood of the columns of a text file.

    Parameters
    ----------
    path : of the file
    columns : as `assigned_columns` takes them; "" recognises them
    rows : how many are given back at most

    Raises
    ------
    RoadExtractionError
        If the file holds no table of numbers.
    """
    if is_record(Path(path)):
        raise RoadExtractionError(f"{path} is a log or a track, whose columns are known. Leave Columns empty.")
    found, unmatched = titled_columns(read_number_table(path))
    problem, meaning = "", Meaning({})
    try:
        meaning = meaning_of_table(found, unmatched, Path(path), columns)
    except RoadExtractionError as refused:
        problem = str(refused)
    role_of = {column: role for role, column in meaning.place.items() if role in ASSIGNABLE}
    if meaning.clock:
        role_of[meaning.place["time"]] = meaning.clock.lower()
    shown = [[f"{value:.10g}" for value in column.values[:rows]] if not column.is_text else list(column.written())[:rows] for column in found]
    return TableColumns(tuple(column.title for column in found), tuple(role_of.get(k, "") for k in range(len(found))),
                        np.array(shown, object).T, problem)


def meaning_of_table(columns: Sequence[TableColumn], unmatched: Sequence[str] | None, path: Path, assigned: str = "") -> Meaning:
    """The Meaning of the columns of a file: as assigned, otherwise by the names above them, otherwise by their numbers.

    Parameters
    ----------
    columns, unmatched : as `titled_columns` gives them
    path : of the file
    assigned : as `assigned_columns` takes it; "" where nothing was assigned

    Raises
    ------
    RoadExtractionError
        If the columns are not recognised.
    """
    if assigned.strip():
        clock = next((TOLD_CLOCKS[word] for word in _words(assigned) if word in TOLD_CLOCKS), "")
        return Meaning(assigned_columns(assigned, len(columns), path), clock=clock)
    if any(column.title for column in columns):
        return meaning_of(columns, path.name)
    clocks = [k for k, column in enumerate(columns) if column.holds_texts and hold_times(column.written()[:CHECKED_ROWS])]
    numbers = [k for k in range(len(columns)) if k not in clocks]
    try:
        place = {role: numbers[k] for role, k in columns_from_numbers(np.stack([columns[k].values for k in numbers], axis=1), path).items()}
    except RoadExtractionError as refused:
        if not unmatched:
            raise RoadExtractionError(f"{refused} The first row reads {first_row(columns)}.") from refused
        place = {}
    # small numbers are guessed by their order alone, which names that do not fit contradict
    if unmatched and (not place or "x" in place and np.nanmedian(np.abs(columns[place["x"]].values)) < MIN_MAP_COORDINATE):
        raise RoadExtractionError(
            f"{path} names {len(unmatched)} columns ({listed(unmatched)}), but its rows have {len(columns)}, and the numbers do not show which "
            f"is which. The first row reads {first_row(columns)}. Say which is which in Columns of Import trajectory.")
    if clocks and "time" not in place:
        place["time"] = clocks[0]
    listing = ", ".join(f"{role} in column {place[role] + 1}" for role in (*ROLES, "lon", "lat") if role in place)
    return Meaning(place, (f"{path.name} has no line of names; recognised by the numbers: {listing}.",))


def time_system_by_size(time: np.ndarray) -> str:
    """What (N,) times most likely count, by their size alone: gps, adjusted, week or day; "" where that is not clear."""
    first, last = float(np.nanmin(time)), float(np.nanmax(time))
    if FIRST_GPS_SECONDS < first and last < LAST_GPS_SECONDS:
        return "gps"
    if first < 0 and first > FIRST_GPS_SECONDS - ADJUSTED_OFFSET or SECONDS_PER_WEEK < first and last < LAST_GPS_SECONDS - ADJUSTED_OFFSET:
        return "adjusted"
    if 0 <= first and SECONDS_PER_DAY < last <= SECONDS_PER_WEEK:
        return "week"
    return ""


@dataclass(frozen=True)
class TrajectoryFacts:
    """positions : number; length, low, high : m; seconds, speed (m/s, median) : NaN without time; system : as `time_system_by_size`"""

    positions: int
    length: float
    low: float
    high: float
    seconds: float
    speed: float
    system: str


def facts_of(trajectory: Trajectory) -> TrajectoryFacts:
    """Length, duration, speed and heights of a Trajectory, in metres also where it is in degrees."""
    x, y = rough_metres(trajectory.x, trajectory.y, trajectory.crs)
    step = np.hypot(np.diff(x), np.diff(y))
    seconds = np.diff(trajectory.time) if trajectory.has_time else np.full(len(step), np.nan)
    moving = np.isfinite(step) & (seconds > 0)
    return TrajectoryFacts(len(trajectory), float(np.nansum(step)), float(np.nanmin(trajectory.z)), float(np.nanmax(trajectory.z)),
                           float(np.nanmax(trajectory.time) - np.nanmin(trajectory.time)) if trajectory.has_time else np.nan,
                           float(np.median(step[moving] / seconds[moving])) if moving.any() else np.nan,
                           time_system_by_size(trajectory.time) if trajectory.has_time else "")
