"""Columns of a trajectory that the user assigned by hand, and what was understood of a table."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import horizontal_part, parse_crs
from ...io.text_table import NumberTable, read_number_table
from .columns import ROLES, columns_by_role, find_header
from .drive_checks import METRES_PER_DEGREE
from .trajectory import Trajectory
from .unnamed_columns import columns_from_numbers

ASSIGNABLE = (*ROLES, "lon", "lat")
LEFT_OUT = ("-", "", "skip")
FIRST_GPS_SECONDS, LAST_GPS_SECONDS = 0.6e9, 1.7e9     # s since 1980: 1999 to 2033
FIRST_ADJUSTED = -0.4e9                                # s, the same less a billion
WEEK, DAY = 604_800.0, 86_400.0


def assigned_columns(text: str, count: int, path: str | os.PathLike[str]) -> dict[str, int]:
    """Which column of a table has which role, as the user wrote it.

    Parameters
    ----------
    text : one word a column, from the left, separated by commas: a role of ASSIGNABLE, or - for a column that is left out. Columns
        after the last word are left out
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
    words = [word.strip().lower() for word in text.replace(";", ",").split(",")]
    place: dict[str, int] = {}
    for column, word in enumerate(words):
        if word in LEFT_OUT:
            continue
        if word not in ASSIGNABLE:
            raise RoadExtractionError(f"Columns names {word!r}, which is no part of a trajectory; use {', '.join(ASSIGNABLE)}, or - for a column "
                                      "that is left out.")
        if word in place:
            raise RoadExtractionError(f"Columns names {word} twice, for column {place[word] + 1} and column {column + 1}. Name each once.")
        place[word] = column
    if max(place.values(), default=0) >= count:
        raise RoadExtractionError(f"Columns names {max(place.values()) + 1} columns, but {path} has {count}. Name as many as there are.")
    missing = [role for role, other in (("x", "lon"), ("y", "lat"), ("z", "z")) if role not in place and other not in place]
    if missing:
        raise RoadExtractionError(f"Columns names no {' and no '.join(missing)}. A trajectory needs x, y (or lon, lat) and z.")
    return place


@dataclass(frozen=True)
class TableColumns:
    """The columns of a text table.

    titles : what stands above each column, "" where nothing does
    roles : of each column, "" for one that is left out
    rows : the first rows of numbers, (R, K)
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
    table = read_number_table(path)
    count = table.values.shape[1]
    names, _ = find_header(table.preamble, count)
    problem, place = "", {}
    try:
        place = place_of_roles(table, Path(path), columns)
    except RoadExtractionError as refused:
        problem = str(refused)
    role_of = {column: role for role, column in place.items()}
    return TableColumns(tuple(names or [""] * count), tuple(role_of.get(k, "") for k in range(count)), table.values[:rows], problem)


def place_of_roles(table: NumberTable, path: Path, columns: str = "") -> dict[str, int]:
    """{role: column} of a table: as assigned, otherwise by the names above it, otherwise by its numbers."""
    count = table.values.shape[1]
    if columns.strip():
        return assigned_columns(columns, count, path)
    names, _ = find_header(table.preamble, count)
    return {role: names.index(name) for role, name in columns_by_role(names).items()} if names else columns_from_numbers(table.values, path)


def time_system_by_size(time: np.ndarray) -> str:
    """What (N,) times most likely count, by their size alone: gps, adjusted, week or day; "" where that is not clear."""
    first, last = float(np.nanmin(time)), float(np.nanmax(time))
    if FIRST_GPS_SECONDS < first and last < LAST_GPS_SECONDS:
        return "gps"
    if first < 0 and first > FIRST_ADJUSTED or WEEK < first and last < LAST_GPS_SECONDS - 1e9:
        return "adjusted"
    if 0 <= first and DAY < last <= WEEK:
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
    x, y = trajectory.x, trajectory.y
    crs = parse_crs(trajectory.crs)
    if crs is not None and horizontal_part(crs).is_geographic:
        x, y = x * np.cos(np.radians(np.nanmedian(y))) * METRES_PER_DEGREE, y * METRES_PER_DEGREE
    step = np.hypot(np.diff(x), np.diff(y))
    seconds = np.diff(trajectory.time) if trajectory.has_time else np.full(len(step), np.nan)
    moving = np.isfinite(step) & (seconds > 0)
    return TrajectoryFacts(len(trajectory), float(np.nansum(step)), float(np.nanmin(trajectory.z)), float(np.nanmax(trajectory.z)),
                           float(np.nanmax(trajectory.time) - np.nanmin(trajectory.time)) if trajectory.has_time else np.nan,
                           float(np.median(step[moving] / seconds[moving])) if moving.any() else np.nan,
                           time_system_by_size(trajectory.time) if trajectory.has_time else "")
