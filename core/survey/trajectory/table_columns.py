"""The columns of a table, with their names and units: those that stand in a file field by field, and those that take several fields."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...io.text_table import NumberTable, as_number, finite_or_nan
from .columns import MAX_HEADER_LINES, Unit, candidates_by_role, listed, split_header, unit_named, unit_of_name, units_above
from .time_systems import SECONDS_PER_WEEK, degrees_of, hold_times

FIRST_WHOLE_WEEK, LAST_WEEK = 1024.0, 4096.0  # weeks since 1980; smaller ones are those of old receivers, which begin anew after 1024
LEAST_NAMED = 2         # roles in the line of names
CHECKED_ROWS = 200      # by which it is told whether a column takes several fields


@dataclass(frozen=True)
class TableColumn:
    """A column of a table, or several fields of it that are one value.

    title : "" without a name; values : (N,) float64, NaN where no number stands; unit : of the values
    written : gives the (N,) texts as they stand in the table; first : the first of them
    """

    title: str
    values: np.ndarray
    unit: Unit = field(default=Unit())
    written: Callable[[], Sequence[str]] = list
    first: str = ""

    @property
    def is_text(self) -> bool:
        """Whether it holds no number at all."""
        return not np.isfinite(self.values).any()

    @property
    def holds_texts(self) -> bool:
        """Whether it holds something, but no number at all."""
        return bool(self.first) and self.is_text


def titled_columns(table: NumberTable) -> tuple[list[TableColumn], list[str] | None]:
    """The columns of a table with the names above it.

    Returns
    -------
    columns : in the order of the fields; without titles where the names are not known
    unmatched : the names in a line that has another number of them, None otherwise
    """
    fields = _fields(table)
    best: tuple[int, list[str], list[tuple[int, str]]] = (LEAST_NAMED - 1, [], [])
    unmatched: tuple[int, list[str]] = (LEAST_NAMED, [])
    for line in table.preamble[-MAX_HEADER_LINES:]:
        for names in split_header(line):
            named = candidates_by_role(names) if len(names) <= len(fields) + 20 else {}
            if len(named) <= min(best[0], unmatched[0]):
                continue
            spans = _spans(names, named, fields) if len(named) > best[0] else None
            if spans is not None:
                best = len(named), names, spans
            elif len(named) > unmatched[0]:
                unmatched = len(named), names
    _, names, spans = best
    if not names:
        return _together([""] * len(fields), _spans_without_names(fields), [Unit()] * len(fields), fields), unmatched[1] or None
    units = [unit_of_name(name) for name in names]
    if not any(unit.name for unit in units):
        units = units_above(table.preamble, len(names)) or units
    return _together(names, spans, units, fields), None


def columns_of_rows(titles: Sequence[str], rows: Sequence[Sequence[object]]) -> list[TableColumn]:
    """The columns of a layer: a list of values for each row, None where one is missing."""
    found = []
    for k, title in enumerate(titles):
        given = [row[k] for row in rows]
        texts = ["" if value is None else str(value) for value in given]
        numbers = finite_or_nan(np.array([as_number(value) for value in given], float))
        found.append(TableColumn(title, numbers, unit_of_name(title), texts.copy, next((text for text in texts if text), "")))
    return found


def first_row(columns: Sequence[TableColumn]) -> str:
    """The first row as it is read, for messages."""
    return listed([f"{column.title or f'column {k + 1}'} = {column.first}" for k, column in enumerate(columns)])


def _fields(table):
    columns = [TableColumn("", table.values[:, k], unit_named(text.lstrip("+-0123456789.,' ")), lambda k=k: table.texts(k), text)
               for k, text in enumerate(table.first_row)]
    # the first row may be the one that lacks a time
    return [replace(column, first=next(filter(None, column.written()), "")) if column.is_text and not column.first else column for column in columns]


def _spans_without_names(fields):
    """Fields that each column takes where none has a name: a date and the clock behind it are one."""
    spans, k = [], 0
    while k < len(fields):
        spans.append(next(_possible_spans("", fields[k:])))
        k += spans[-1][0]
    return spans


def _spans(names, roles, fields):
    """(number of fields, what they are) of each name, so that all together have the fields of a row; None where that cannot be."""
    if len(names) == len(fields):
        return [(1, "")] * len(names)
    role_of = {place: role for role, places in roles.items() for place in places}

    def following(name, start):
        if name == len(names):
            return [] if start == len(fields) else None
        for span in _possible_spans(role_of.get(name, ""), fields[start:]):
            rest = following(name + 1, start + span[0])
            if rest is not None:
                return [span, *rest]
        return None

    return following(0, 0) if len(names) < len(fields) else None


def _possible_spans(role, fields):
    """(number of fields, "time", "week", "angle" or "") that a column may take, the largest first."""
    if not fields:
        return
    together = _fields_of_a_time(fields)
    if role == "date":
        yield 1, ""   # the clock behind it has a name of its own, unless the names are too few
    if together > 1:
        yield together, "time"
    elif role == "time" and len(fields) > 1 and _week(fields[0].values) and _within(fields[1].values, 0.0, SECONDS_PER_WEEK + 1.0):
        yield 2, "week"
    elif role in ("lon", "lat") and len(fields) > 2:
        degrees, minutes, seconds = (column.values[:CHECKED_ROWS] for column in fields[:3])
        if _whole(degrees) and _within(minutes, 0.0, 60.0):
            if _whole(minutes) and _within(seconds, 0.0, 60.0):
                yield 3, "angle"
            if not _whole(minutes):
                yield 2, "angle"
    yield 1, ""


def _fields_of_a_time(fields):
    """2 for a date with a clock behind it, 3 for one with AM or PM behind that, otherwise 1."""
    if len(fields) < 2 or not (fields[0].is_text or _within(fields[0].values, 19_800_106.0, 21_000_101.0)) or not fields[1].is_text or \
            not (fields[0].first[:1].isdigit() and ":" in fields[1].first):
        return 1
    if ":" in fields[0].first or not hold_times(fields[1].written()[:CHECKED_ROWS]):
        return 1
    return 3 if len(fields) > 2 and fields[2].first.upper() in ("AM", "PM") else 2


def _within(values, low, high):
    values = values[np.isfinite(values)]
    return bool(len(values)) and bool(((values >= low) & (values < high)).all())


def _whole(values):
    values = values[np.isfinite(values)]
    return bool((values == np.floor(values)).all())


def _week(values):
    return _whole(values) and _within(values, 1.0, LAST_WEEK) and np.ptp(values[np.isfinite(values)]) <= 2


def with_week(seconds: np.ndarray, week: np.ndarray) -> np.ndarray:
    """(N,) GPS seconds since 1980 of seconds of the week; the same seconds where weeks are not counted since 1980."""
    if not _week(week) or not _within(week, FIRST_WHOLE_WEEK, LAST_WEEK) or not _within(seconds, 0.0, SECONDS_PER_WEEK + 1.0):
        return seconds
    return seconds + week * SECONDS_PER_WEEK


def _together(names, spans, units, fields):
    """One TableColumn a name."""
    found, start = [], 0
    for name, (count, kind), unit in zip(names, spans, units):
        parts = fields[start:start + count]
        start += count
        unit, values = unit if unit.name else parts[0].unit, parts[0].values
        if kind == "week":
            values = with_week(parts[1].values, values)
        elif kind == "angle":
            values, unit = degrees_of(*(part.values for part in parts), *[np.zeros(len(values))] * (3 - count)), Unit("degrees")
        elif kind == "time":
            values = np.full(len(values), np.nan)
        written = parts[0].written if count == 1 else lambda parts=parts: [" ".join(texts) for texts in zip(*(part.written() for part in parts))]
        found.append(TableColumn(name, values, unit, written, " ".join(part.first for part in parts)))
    return found
