"""The columns of a table, with their names and units: those that stand in a file field by field, and those that take several fields."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree.ElementTree import ParseError, iterparse  # nosec B405

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.text_table import NumberTable, as_number, finite_or_nan
from ..weights import TRAJECTORY
from .columns import Unit, candidates_by_role, listed, split_header, unit_named, unit_of_name, units_above
from .time_systems import SECONDS_PER_WEEK, are_mostly, hold_times

FIRST_WHOLE_WEEK, LAST_WEEK = 1024.0, 4096.0  # source: weeks since 1980 (IS-GPS-200); smaller ones begin anew after 1024, as old receivers do


@dataclass(frozen=True)
class TableColumn:
    """A column of a table, or several fields of it that are one value: (N,) float64, NaN where no number stands."""

    title: str   # "" without a name
    values: np.ndarray
    unit: Unit = field(default=Unit())
    written: Callable[[], Sequence[str]] = list   # gives the (N,) texts as they stand in the table
    first: str = ""   # the first of them

    @classmethod
    def of(cls, title: str, texts: Sequence[str], unit: Unit = Unit(), values: np.ndarray | None = None) -> TableColumn:
        """Of (N,) texts; their values are by default the numbers that they hold."""
        return cls(title, np.array([as_number(text) for text in texts]) if values is None else values, unit, lambda: texts,
                   next(filter(None, texts), ""))

    @property
    def is_text(self) -> bool:
        """Whether it holds no number at all."""
        return not np.isfinite(self.values).any()

    @property
    def is_empty(self) -> bool:
        """Whether it holds neither texts nor numbers."""
        return not self.first and self.is_text

    @property
    def in_metres(self) -> np.ndarray:
        """(N,) lengths in metres where they are given in these or in parts of them, otherwise as they stand."""
        return self.values * (self.unit.factor if self.unit.name == "metres" else 1.0)

    @property
    def holds_texts(self) -> bool:
        """Whether it holds something, but no number at all."""
        return bool(self.first) and self.is_text

    @property
    def holds_clock_times(self) -> bool:
        """Whether it holds clock times or dates as texts, by its first rows."""
        return self.holds_texts and hold_times(self.written()[:TRAJECTORY.checked_rows])


def titled_columns(table: NumberTable) -> tuple[list[TableColumn], list[str] | None]:
    """The columns of a table in the order of its fields, with the names above it, and those names where their number is another one."""
    fields = _fields(table)
    names, spans, unmatched = _names_above(table, fields)
    if not names:
        return _together([""] * len(fields), _spans_without_names(fields), [Unit()] * len(fields), fields), unmatched or None
    units = [unit_of_name(name) for name in names]
    if not any(unit.name for unit in units):
        units = units_above(table.preamble, len(names)) or units
    return _together(names, spans, units, fields), None


def _names_above(table, fields):
    """The names in the lines above a table that give the most roles, with their spans, and those of another number that give even more."""
    most, names, spans = TRAJECTORY.least_named - 1, [], []
    most_unmatched, unmatched = TRAJECTORY.least_named, []
    for line in table.preamble[-TRAJECTORY.max_header_lines:]:
        for words in split_header(line):
            named = candidates_by_role(words) if len(words) <= len(fields) + 20 else {}
            fitting = _spans(words, named, fields) if len(named) > most else None
            if fitting is not None:
                most, names, spans = len(named), words, fitting
            elif len(named) > most_unmatched:
                most_unmatched, unmatched = len(named), words
    return names, spans, unmatched


def columns_of_rows(titles: Sequence[str], rows: Sequence[Sequence[object]]) -> list[TableColumn]:
    """The columns of a layer: a list of values for each row, None where one is missing."""
    columns = []
    for k, title in enumerate(titles):
        cells = [row[k] for row in rows]
        numbers = finite_or_nan(np.array([as_number(value) for value in cells], float))
        columns.append(TableColumn.of(title, ["" if value is None else str(value) for value in cells], unit_of_name(title), numbers))
    return columns


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
    role_of = {column: role for role, places in roles.items() for column in places}

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
    time_fields = _fields_of_a_time(fields)
    if role == "date":
        yield 1, ""   # the clock behind it has a name of its own, unless the names are too few
    if time_fields > 1:
        yield time_fields, "time"
    elif role == "time" and len(fields) > 1 and _week(fields[0].values) and _within(fields[1].values, 0.0, SECONDS_PER_WEEK + 1.0):
        yield 2, "week"
    elif role in ("lon", "lat"):
        yield from ((count, "angle") for count in _fields_of_an_angle(fields))
    yield 1, ""


def _fields_of_an_angle(fields):
    """The numbers of fields in which degrees with minutes, and with seconds, may stand."""
    parts = [column.values[:TRAJECTORY.checked_rows] for column in fields[:3]]
    if len(parts) < 3 or not _whole(parts[0]) or not _within(parts[1], 0.0, 60.0):
        return []
    return ([3] if _within(parts[2], 0.0, 60.0) else []) if _whole(parts[1]) else [2]


def _fields_of_a_time(fields):
    """2 for a date with a clock behind it, 3 for one with AM or PM behind that, otherwise 1."""
    first, second, third = (*fields, None, None)[:3]
    if second is None or ":" not in second.first or not second.holds_clock_times or not re.match(r"\d[^:]*$", first.first):
        return 1
    if not first.is_text and not _within(first.values, 19_800_106.0, 21_000_101.0):
        return 1
    return 3 if third is not None and third.first.upper() in ("AM", "PM") else 2


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
    ends = np.cumsum([count for count, _ in spans])
    return [_joined(name, fields[end - count:end], kind, unit) for name, (count, kind), unit, end in zip(names, spans, units, ends.tolist())]


def _joined(name, parts, kind, unit):
    """The TableColumn of fields that are one value together."""
    values, unit = parts[0].values, unit if unit.name else parts[0].unit
    if kind == "week":
        values = with_week(parts[1].values, values)
    elif kind == "angle":
        values, unit = _degrees_of(*(part.values for part in parts), *[np.zeros(len(values))] * (3 - len(parts))), Unit("degrees")
    elif kind == "time":
        values = np.full(len(values), np.nan)
    written = parts[0].written if len(parts) == 1 else lambda: [" ".join(texts) for texts in zip(*(part.written() for part in parts))]
    return TableColumn(name, values, unit, written, " ".join(part.first for part in parts))


# Angles that are written as text or packed into one number: degrees with minutes and seconds, hemispheres.

ANGLE = re.compile(r"(?P<before>[NSEW])?\s*(?P<sign>[+-])?\s*(?P<degrees>\d{1,3}(?:[.,]\d*)?)\s*[°ºd:\s]?\s*"
                   r"(?:(?P<minutes>\d{1,2}(?:[.,]\d*)?)\s*['′’m:\s]?\s*)?(?:(?P<seconds>\d{1,2}(?:[.,]\d*)?)\s*(?:''|[\"″”s])?\s*)?"
                   r"(?P<after>[NSEW])?$", re.IGNORECASE)


def _angles_of(texts: Sequence[str]) -> np.ndarray:
    """(N,) degrees of texts such as 48°12'30.5"N, 48 12 30.5, N 48° 12.5' or 48.2085°; south and west negative, NaN where a text is none."""
    degrees = np.full(len(texts), np.nan)
    for row, text in enumerate(texts):
        match = ANGLE.match(text.strip())
        if match:
            parts = [float((match[name] or "0").replace(",", ".")) for name in ("degrees", "minutes", "seconds")]
            negative = match["sign"] == "-" or (match["before"] or match["after"] or "").upper() in ("S", "W")
            degrees[row] = _degrees_of(*parts) * (-1.0 if negative else 1.0)
    return degrees


def _degrees_of(degrees: Any, minutes: Any, seconds: Any) -> np.ndarray:
    """(N,) degrees of degrees, minutes and seconds; the sign is that of the degrees, also where these are -0."""
    return np.copysign(np.abs(degrees) + np.asarray(minutes) / 60.0 + np.asarray(seconds) / 3600.0, degrees)


def _hemisphere_signs(texts: Sequence[str]) -> np.ndarray | None:
    """(N,) 1 or -1 of a column of N, S, E and W; None for other texts."""
    letters = [text.strip().upper() for text in texts]
    if not any(letters) or not set(letters) <= {"N", "S", "E", "W", ""}:
        return None
    return np.array([-1.0 if letter in ("S", "W") else 1.0 for letter in letters])


def _unpacked(values: np.ndarray, parts: int = 1) -> np.ndarray:
    """(N,) degrees of numbers in which degrees and minutes are written together, ddmm.mmmm (NMEA 0183), or seconds as a second part, ddmmss.ss."""
    # 1e-7 s are 3 µm on the ground, and more than what doubles lose in 1800000
    size = np.where(np.isfinite(values), np.abs(values) if parts == 1 else np.round(np.abs(values), 7), np.nan)
    for _ in range(parts):
        size = np.floor(size / 100.0) + size % 100.0 / 60.0
    return np.copysign(size, values)


def angle_of(columns: Sequence[TableColumn], k: int, most: float) -> np.ndarray:
    """(N,) degrees of a column of longitudes or latitudes, with the hemisphere in the column behind it or before it."""
    column = columns[k]
    packed_parts = {"packed minutes": 1, "packed seconds": 2}.get(column.unit.name, 0)
    if packed_parts and not column.holds_texts:
        return _unpacked(column.values * column.unit.factor, packed_parts)
    values = _degrees(column)
    sides = [_hemisphere_signs(column.written()) for column in (*columns[k + 1:k + 2], *columns[max(k - 1, 0):k]) if column.holds_texts]
    signs = next((signs for signs in sides if signs is not None), None)
    if signs is None:
        return values
    packed = most < np.nanmax(np.abs(values), initial=0.0) < 100 * most
    return np.where(signs < 0, -1.0, 1.0) * np.abs(_unpacked(values) if packed else values)


def _degrees(column):
    """(N,) degrees of a column of angles, without the hemisphere beside it."""
    unit, values = column.unit, column.values
    if column.holds_texts:   # angles have minutes, or a hemisphere
        texts = column.written()
        has_parts = lambda text: (match := ANGLE.match(text)) and (match["minutes"] or match["before"] or match["after"] or "°" in text)  # noqa: E731
        return _angles_of(texts) if are_mostly(texts, has_parts) else values
    if unit.name == "radians":
        # np.degrees gives the last bit that a product would not
        return np.degrees(values) if unit.factor == 1.0 else values * np.degrees(unit.factor)
    return values * unit.factor if unit.name == "degrees" else values


# What receivers and telephones keep: sentences of NMEA 0183 and NovAtel's ASCII logs, and tracks in GPX and KML.

KINDS_OF_POSITIONS = ("trkpt", "coord", "rtept", "coordinates", "wpt", "point")   # in GPX and KML, the likeliest drive first
TRACK_ENDINGS = (".gpx", ".kml")
PREFIX = re.compile(rb"(</?)[\w.-]+:")   # of an element of XML: some programs write gx: without declaring it


class _Sentence(NamedTuple):
    """Where a sentence has its values: {what: place among its fields}; rank: which is used where a log has several, the least first."""

    rank: int
    fields: Mapping[str, int]


# NMEA 0183: fields behind the name of the sentence. NovAtel (OEM7 Commands and Logs Reference): fields behind the semicolon, and of
# the header before it the week and the seconds. Heights of NMEA and BESTPOS are above mean sea level; "geoid" leads to the ellipsoid.
SENTENCES = {   # source: as above
    "GGA": _Sentence(0, {"clock": 1, "lat": 2, "lat_side": 3, "lon": 4, "lon_side": 5, "quality": 6, "z": 9, "geoid": 11}),
    "GNS": _Sentence(1, {"clock": 1, "lat": 2, "lat_side": 3, "lon": 4, "lon_side": 5, "z": 9, "geoid": 10}),
    **{name: _Sentence(0, {"week": 0, "seconds": 1, "lat": 2, "lon": 3, "z": 4, "roll": 8, "pitch": 9, "heading": 10})
       for name in ("INSPVAA", "INSPVASA")},
    "INSPVAXA": _Sentence(0, {"status": 0, "lat": 2, "lon": 3, "z": 4, "geoid": 5, "roll": 9, "pitch": 10, "heading": 11}),
    **{name: _Sentence(1, {"status": 0, "lat": 2, "lon": 3, "z": 4, "geoid": 5}) for name in ("BESTPOSA", "BESTGNSSPOSA", "INSPOSA")},
}
NO_SOLUTION = ("INSUFFICIENT_OBS", "NO_CONVERGENCE", "INS_INACTIVE", "INS_ALIGNING", "COLD_START")
NMEA = re.compile(r"\$(?:G[A-Z]|BD|QZ)(?P<name>GGA|GNS|RMC|ZDA),(?P<rest>[^*\s]*)")
NOVATEL = re.compile(r"[#%](?P<name>[A-Z]+A),(?P<head>[^;\n]*);(?P<rest>[^*\n]*)")


def _read_log(path: Path) -> list[TableColumn]:
    """The positions in a log of sentences, as columns with names; RoadExtractionError where there are none."""
    kept: dict[str, list[list[str]]] = {}
    day = ""
    for line in path.read_text(encoding="latin-1").split("\n"):
        nmea = NMEA.search(line)
        if nmea:
            fields = [nmea["name"], *nmea["rest"].split(",")]
            if nmea["name"] in ("RMC", "ZDA"):
                day = _day_of(fields) or day
            else:
                kept.setdefault(nmea["name"], []).append([day, *fields])
            continue
        novatel = NOVATEL.search(line)
        if novatel and novatel["name"] in SENTENCES:
            head = novatel["head"].split(",")
            # the short header of logs that end with SA has the week and seconds at its end, the long one within
            week_at = 0 if line.lstrip().startswith("%") else 4
            kept.setdefault(novatel["name"], []).append([*(head[week_at:week_at + 2] + ["", ""])[:2], *novatel["rest"].split(",")])
    named = sorted(kept, key=lambda name: (SENTENCES[name].rank, name))
    if not named:
        raise RoadExtractionError(f"{path} is a log of a receiver, but has no sentence with positions and heights. Log GGA with RMC (NMEA) or "
                                  "INSPVAA (NovAtel), or export the trajectory as a table.")
    return _columns_of_log(kept[named[0]], SENTENCES[named[0]].fields)


def _day_of(fields):
    """YYYY-MM-DD of an RMC (ddmmyy) or ZDA sentence."""
    if fields[0] == "ZDA" and len(fields) > 4:
        return f"{fields[4]}-{fields[3]}-{fields[2]}" if all(part.isdigit() for part in fields[2:5]) else ""
    day = fields[9] if len(fields) > 9 else ""
    return f"20{day[4:6]}-{day[2:4]}-{day[:2]}" if re.fullmatch(r"\d{6}", day) else ""


def _columns_of_log(rows, fields):
    """TableColumns with the names that the table of names knows."""
    offset = 1 if "clock" in fields else 2   # what stands in a row before the fields of its sentence
    text = {role: [row[k + offset] if len(row) > k + offset else "" for row in rows] for role, k in fields.items()}
    number = {role: np.array([as_number(value) for value in values]) for role, values in text.items()}
    time = _clock_column([row[0] for row in rows], text["clock"]) if "clock" in fields else _gps_column(rows, number)
    return [time, *_place_columns(text, number)]


def _place_columns(text, number):
    """Latitude, longitude, height and angles; without a place where the receiver had no solution."""
    rows = len(text["lat"])
    bad = np.array([value in NO_SOLUTION for value in text.get("status", [""] * rows)]) | (number.get("quality", np.ones(rows)) == 0)
    for axis in ("lat", "lon"):
        if f"{axis}_side" in text:
            signs = _hemisphere_signs(text[f"{axis}_side"])
            number[axis] = _unpacked(number[axis]) * (1.0 if signs is None else signs)
        number[axis] = np.where(bad, np.nan, number[axis])
    if "geoid" in number and np.isfinite(number["geoid"]).any():
        number["z"] = number["z"] + number["geoid"]
    return [TableColumn.of(title, text[what], Unit("metres" if what == "z" else "degrees"), number[what])
            for what, title in (("lat", "latitude"), ("lon", "longitude"), ("z", "ellipsoidal height" if "geoid" in number else "height"),
                                ("roll", "roll"), ("pitch", "pitch"), ("heading", "heading")) if what in number]


def _clock_column(days, clocks):
    """The time of sentences with hhmmss.ss of UTC; those before the first date are of the same day, or of no known one."""
    first = next((day for day in days if day), "")
    times = [f"{day or first} {clock[:2]}:{clock[2:4]}:{clock[4:]}".strip() if re.match(r"\d{6}", clock) else "" for day, clock in zip(days, clocks)]
    return TableColumn.of("UTC", times, values=np.full(len(times), np.nan))


def _gps_column(rows, number):
    """The time of logs with the week and its seconds among their fields, otherwise in their headers."""
    if "seconds" in number:
        week, seconds = number["week"], number["seconds"]
    else:
        week, seconds = (np.array([as_number(row[k]) for row in rows]) for k in (0, 1))
    return TableColumn("GPS time", with_week(seconds, week), Unit("seconds"), first=str(seconds[0]))


def _read_track(path: Path) -> list[TableColumn]:
    """The positions of a GPX or KML file, as columns with names; RoadExtractionError if it is no XML, or holds none.

    Of GPX the points of tracks are taken, otherwise those of its route, otherwise its waypoints; of KML the tracks (gx:Track), otherwise the
    lines, otherwise the points.
    """
    try:
        rows, whens = _positions(path)
    except ParseError as problem:
        raise RoadExtractionError(f"{path} cannot be read as XML ({problem}). Save the track again.") from problem
    except (LookupError, ValueError) as problem:
        raise RoadExtractionError(f"{path} cannot be read ({problem}). Save the track again, as UTF-8.") from problem
    kind = next((kind for kind in KINDS_OF_POSITIONS if rows[kind]), None)
    if kind is None:
        raise RoadExtractionError(f"{path} holds no track. A drive is a track (layer track_points): save it with its track, or choose the layer of "
                                  "positions.")
    drive = rows[kind]
    if kind == "coord" and len(whens) == len(drive):
        drive = [[*row[:3], time] for row, time in zip(drive, whens)]
    columns = [TableColumn.of(title, texts, Unit(unit)) for (title, unit), texts in zip(
        (("longitude", "degrees"), ("latitude", "degrees"), ("height", "metres"), ("UTC", "")), zip(*drive))]
    return columns if columns[3].first else columns[:3]


def _positions(path):
    """{element: rows of [longitude, latitude, height, time], as texts} of a file, and the times of a track that has them by themselves."""
    rows: dict[str, list[list[str]]] = {kind: [] for kind in KINDS_OF_POSITIONS}
    whens = []
    content = path.read_bytes()
    if b"<!ENTITY" in content:   # a few bytes of which may stand for gigabytes
        raise ValueError("it declares entities of its own")
    for _, element in iterparse(BytesIO(PREFIX.sub(rb"\1", content))):  # nosec B314
        name, text = element.tag.rpartition("}")[2], "".join(element.itertext()).strip()
        if name in ("trkpt", "rtept", "wpt"):
            rows[name].append([element.get("lon", ""), element.get("lat", ""), element.findtext("{*}ele", ""), element.findtext("{*}time", "")])
        elif name == "when":
            whens.append(text)
        elif name == "coord":
            rows[name].append([*text.split(), "", "", ""][:4])
        elif name == "coordinates":   # those of a line are one text
            rows[("point", name)[len(text.split()) > 1]] += [[*place.split(","), "", "", ""][:3] + [""] for place in text.split()]
        if name not in ("ele", "time"):
            element.clear()
    return rows, whens


def is_record(path: Path) -> bool:
    """Whether a file is a track or a log of sentences, by its ending and its beginning."""
    with open(path, "rb") as file:
        head = file.read(TRAJECTORY.head_bytes)
    text = head.decode("latin-1")
    return path.suffix.lower() in TRACK_ENDINGS or bool(NMEA.search(text) or NOVATEL.search(text))


def columns_of_record(path: Path) -> list[TableColumn]:
    """The positions of a track or of a log of sentences, as columns with names; RoadExtractionError where it holds none."""
    return _read_track(path) if path.suffix.lower() in TRACK_ENDINGS else _read_log(path)
