"""Which column of a trajectory is which, by its name, and in which unit it is; the names stand in column_names.txt."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import horizontal_part, parse_crs
from ..weights import TRAJECTORY

ROLES = ("time", "x", "y", "z", "roll", "pitch", "heading")

EARTH_CENTRED = {"ecef", "geocentric", "centred", "centered"}   # one of these tells a coordinate from one on a map
# Behind a name in brackets these say what a column is of; other words there change nothing.
QUALIFYING = EARTH_CENTRED | {"sd", "std", "stdev", "sigma", "rms", "rmse", "error", "accuracy", "velocity", "speed", "rate", "bias", "gps", "gpst",
                              "utc", "unix", "orthometric", "ellipsoidal", "ellipsoid", "msl", "geoid", "week", "day"}


class Unit(NamedTuple):
    """What a column counts, "" where that is not said, and what one of its units is of that."""

    name: str = ""
    factor: float = 1.0


_UNITS = {   # source: definitions of the units
    ("degrees", 1.0): "deg degree degrees ° dd", ("radians", 1.0): "rad radian radians", ("degrees", 0.9): "gon grads",
    ("feet", 1.0): "ft feet foot usft", ("metres", 1.0): "m meter meters metre metres", ("metres", 1e3): "km", ("metres", 0.01): "cm",
    ("metres", 1e-3): "mm", ("seconds", 1.0): "s sec secs seconds", ("seconds", 1e-3): "ms msec milliseconds millisec millis",
    ("seconds", 1e-6): "us µs μs usec microseconds", ("seconds", 1e-9): "ns nsec nanoseconds", ("sexagesimal", 1.0): "d m s|dms|d:m:s|ddd mm ss",
}
UNIT_NAMES = {word: Unit(*unit) for unit, words in _UNITS.items() for word in (words.split("|") if "|" in words else words.split())}
# source: degrees, minutes and seconds in one number: DDMMSS.ss, DD.MMSSss of pocket calculators, DDMM.mmmm of receivers
PACKED_ANGLES = ((re.compile(r"d{2,3}m{2}s{2}(\.s+)?"), Unit("packed seconds")), (re.compile(r"d{1,3}\.m{2}s{2,}"), Unit("packed seconds", 1e4)),
                 (re.compile(r"d{2,3}m{2}(\.m+)?"), Unit("packed minutes")))
SEPARATORS = (",", ";", r"\t", r"\|", r"\s{2,}", r"\s+")


def columns_by_role(names: Sequence[str]) -> dict[str, str]:
    """{role: name} of the columns whose role their names tell: time, x, y, z, roll, pitch, heading, lon, lat, and parts of these.

    Capitals, punctuation and units such as in "roll_deg" or "Easting (m)" do not matter.
    """
    return {role: names[places[0]] for role, places in candidates_by_role(names).items()}


def candidates_by_role(names: Sequence[str]) -> dict[str, list[int]]:
    """{role: places of the columns that may be it by their names, the likeliest first}."""
    ranks = [_roles_of_name(str(name)) for name in names]
    candidates = {role: sorted((roles[role], column) for column, roles in enumerate(ranks) if role in roles) for role in _names_by_role()}
    return {role: [column for _, column in places] for role, places in candidates.items() if places}


@cache
def _names_by_role():
    """{role: {"name", "word" or "with": words}} of column_names.txt, in its order."""
    names: dict[str, dict[str, tuple[str, ...]]] = {}
    for line in Path(__file__).with_name("column_names.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            role, use, _, *words = line.split()
            listed_words = [word for listed in words for word in (names[listed]["with"] if listed.startswith("*") else (listed,))]
            names.setdefault(role, {"name": (), "word": (), "with": ()})[use] += (*listed_words,)
    return {role: uses for role, uses in names.items() if not role.startswith("*")}


@cache
def _roles_of_name(name):
    """{role: rank, 0 for the usual name} of one name."""
    words, within, _ = _taken_apart(name)
    plain, every = "".join(words), [*words, *within]
    earth = bool(EARTH_CENTRED & set(every))
    roles = {}
    for role, uses in _names_by_role().items():
        matches, usual = _is_of(role, every) or _is_of(role, [plain, *within]), plain in uses["name"]
        if role.startswith("ecef") == earth and (matches or usual and not within):
            roles[role] = uses["name"].index(plain) if usual else len(uses["name"])
    return roles


@cache
def _grammar(role):
    """(pattern of what one of its words is in, pattern of what may stand with it, its words of a single letter)."""
    core, further = _names_by_role()[role]["word"], _names_by_role()[role]["with"]
    cores = "|".join(re.escape(word) for word in core if len(word) > 1) or "(?!)"
    every = "|".join(re.escape(word) for word in (*core, *further) if len(word) > 1)
    letters = "".join(word for word in further if len(word) == 1)
    return re.compile(f"(?:{every})*(?:{cores})(?:{every})*"), re.compile(f"(?:{every})+|[{letters}-]"), {word for word in core if len(word) == 1}


def _is_of(role, words):
    """Whether all words of a name belong to a role, and one of them says so."""
    core, further, letters = _grammar(role)
    says = [word in letters or bool(core.fullmatch(word)) for word in words]
    return any(says) and all(names_it or further.fullmatch(word) for names_it, word in zip(says, words))


def unit_of_name(name: str) -> Unit:
    """The unit in the name of a column, such as "roll_deg", "Easting [m]" or "TOW [0.001 s]"."""
    return _taken_apart(str(name))[2]


@cache
def _taken_apart(name):
    """(words, words in brackets that say what it is of, Unit) of a name, in small letters."""
    text = name.strip().strip("#%").strip()
    brackets = {bracket: unit_named(bracket) for bracket in re.findall(r"[\[(<]([^\])>]*)[\])>]", text)}
    within = [word for bracket, unit in brackets.items() if not unit.name for word in _split(bracket) if word in QUALIFYING]
    words, units = _split(re.sub(r"[\[(<][^\])>]*[\])>]?", " ", text)), [unit for unit in brackets.values() if unit.name]
    # "gps_week_seconds" is a time and no week in seconds
    if len(words) > 1 and words[-1] in UNIT_NAMES and not _is_of("time", words) and _name_a_role(words[:-1]):
        units.append(UNIT_NAMES[words.pop()])
    if "".join(words) == "itow":
        units.append(UNIT_NAMES["ms"])   # u-blox counts the time of week in milliseconds
    return words, within, next(iter(units), Unit())


def _name_a_role(words):
    return any(_is_of(role, words) or "".join(words) in uses["name"] for role, uses in _names_by_role().items())


def _split(text):
    """Words in small letters; a capital within a word begins another one."""
    text = re.sub(r"(?<=[a-zà-ÿ])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", text) if not text.isupper() else text
    words = [word for word in re.split(r"[^\w°]+|_", text.lower()) if word]
    return ["utm" if re.fullmatch(r"utm\d*[ns]?", word) else word for word in words]


def unit_named(text: str) -> Unit:
    """The Unit that a text names, maybe with a number before it, such as "0.001 s" or "1e-7 deg"; Unit() where it names none."""
    words = " ".join(text.lower().strip("[]()<> .").split())
    factor_last = re.fullmatch(r"(\D+?)\s*[*x]\s*(\d[\d.]*(?:e-?\d+)?|10\^?-\d+)", words)
    words = f"{factor_last[2]} {factor_last[1]}" if factor_last else words
    number = re.match(r"(\d[\d.]*(?:e-?\d+)?|10\^?-\d+)\s*\*?\s*(?=\D)", words)
    packed = next((unit for form, unit in PACKED_ANGLES if form.fullmatch(words)), None)
    unit = packed or UNIT_NAMES.get(words[number.end():] if number else words)
    if unit is None:
        return Unit()
    factor = 1.0
    if number:
        factor = 10.0 ** float(number[1].replace("10", "", 1).lstrip("^")) if number[1].startswith(("10^", "10-")) else float(number[1])
    return Unit(unit.name, unit.factor * factor)


def split_header(line: str) -> Iterator[list[str]]:
    """The ways in which a line may name columns, with any separator."""
    text = line.strip().lstrip("#%/;!*").strip().replace('"', "")
    for pattern in SEPARATORS:
        fields = [field.strip() for field in re.split(pattern, text)]
        yield fields[:-1] if len(fields) > 1 and not fields[-1] else fields


def units_above(preamble: Sequence[str], columns: int) -> list[Unit] | None:
    """The units of columns where a line above a table holds nothing else; None where none does."""
    for line in reversed(preamble):
        bracketed = re.findall(r"\([^)]*\)|\[[^\]]*\]", line)
        for fields in (*split_header(line), bracketed):
            if len(fields) == columns or (fields is bracketed and columns - 2 <= len(fields) < columns):
                units = [unit_named(field) for field in fields]
                if sum(bool(unit.name) for unit in units) * 2 > columns:
                    return units + [Unit()] * (columns - len(units))
    return None


def stated_angle_unit(preamble: Sequence[str]) -> str:
    """The unit of angles, "degrees" or "radians", where the lines above a table state one of them; otherwise ""."""
    text = " ".join(preamble).lower()
    stated = {unit for word, unit in (("radian", "radians"), ("[rad]", "radians"), ("(rad)", "radians"),
                                      ("degree", "degrees"), ("[deg]", "degrees"), ("(deg)", "degrees")) if word in text}
    return stated.pop() if len(stated) == 1 else ""


def listed(names: Sequence[str]) -> str:
    """Names of columns for a message, long ones and long lists cut."""
    longest, most = TRAJECTORY.longest_name, TRAJECTORY.most_names
    cut = [name if len(name) <= longest else name[:longest - 1] + "…" for name in map(str, names[:most])]
    return ", ".join(cut) + (f" and {len(names) - most} more" if len(names) > most else "")


# Which column of a trajectory is which, by its numbers, where the columns have no names.

def columns_from_numbers(values: np.ndarray, path: str | os.PathLike[str]) -> dict[str, int]:
    """{role: index of the column} of a table without names, (N, K) numbers in driving order, with x, y or lon, lat.

    Time increases evenly; x and y are large and change no faster than a vehicle drives; z follows them; the heading agrees with the course driven.
    Nothing is guessed where several columns qualify. RoadExtractionError, which names `path`, if time, x, y and z cannot be recognised.
    """
    sample = values[np.isfinite(values).sum(axis=1) >= 3][:TRAJECTORY.max_sample_rows]
    count = sample.shape[1]
    time = _time_column(sample) if count > 3 else None
    candidates = [k for k in range(count) if k != time and not _is_counter(sample[:, k]) and np.isfinite(sample[:, k]).sum() > 0.9 * len(sample)]
    plane, heading = _plane(sample, time, candidates)
    z = None if plane is None else _height_column(sample, time, candidates, plane[:2], heading)
    if plane is None or z is None:
        raise RoadExtractionError(f"{path} has {count} columns without names, and time, x, y and z cannot be recognised from their numbers. Put a "
                                  "line of names above them, such as time,x,y,z,roll,pitch,heading.")
    roles = {**dict(zip(("x", "y") if plane[2] == "metres" else ("lon", "lat"), plane[:2])), "z": z}
    roles.update({} if time is None else {"time": time})
    return {**roles, **_attitude_columns(sample, set(roles.values()), max(plane[:2]), z, heading)}


def _attitude_columns(sample, used, plane_end, z, heading):
    """{role: column} of roll, pitch and heading as far as they are known, beside the columns in use."""
    if heading is not None:
        # roll, pitch, heading is the usual order; in another, roll and pitch cannot be distinguished
        ordered = heading - z == 3 or _after_roll_and_pitch(sample, heading) and not {heading - 1, heading - 2} & used
        return {"heading": heading, **({"roll": heading - 2, "pitch": heading - 1} if ordered else {})}
    following = range(z + 1, z + 4)
    if not plane_end < z <= sample.shape[1] - 4 or used & set(following) or np.isnan(sample[:, following]).all(axis=0).any():
        return {}
    # a heading that disagrees with the course (driven backwards, another zero direction) still exceeds 45 degrees
    leans, turns = (np.nanmax(np.abs(sample[:, columns])) for columns in (following[:2], following[2:]))
    return dict(zip(("roll", "pitch", "heading"), following)) if turns > 45 >= leans else {}


def _is_counter(column):
    step = np.diff(column)
    return len(step) > 3 and column[0] in (0, 1) and (step == 1).all()


def _time_column(sample):
    """The column that increases most evenly; a row number only where nothing else increases."""
    uneven = np.full(sample.shape[1], np.inf)
    for k, column in enumerate(sample.T):
        step = np.diff(column)[np.isfinite(np.diff(column))]
        if len(step) and np.mean(step > 0) >= 0.995:
            off = np.abs(step / np.median(step) - 1.0)
            # a coordinate increases evenly on a straight road, but never in equal steps
            uneven[k] = np.mean(off > 0.2) + _is_counter(column) + 0.1 * min(np.median(off), 1.0)
    return int(np.argmin(np.round(uneven, 6))) if np.isfinite(uneven).any() else None


def _rate(sample, time, k, percent):
    """Change of a column per second, or per row where there is no time: a percentile, NaN where there is no step."""
    step = np.abs(np.diff(sample[:, k]))
    if time is not None:
        seconds = np.diff(sample[:, time])
        step = step / np.where(seconds > 0, seconds, np.nan)
    step = step[np.isfinite(step)]
    return np.percentile(step, percent) if len(step) else np.nan


def _plane(sample, time, others):
    """((x column, y column, unit) or None, heading column or None): coordinates that a heading confirms are preferred."""
    on_map = [k for k in others if _size(sample, k) > TRAJECTORY.min_map_coordinate and _rate(sample, time, k, 98) < TRAJECTORY.max_vehicle_speed]
    if len(on_map) > 2:
        return None, None
    if len(on_map) == 2:
        pairs = [(*on_map, "metres"), (*on_map[::-1], "metres")]
    else:
        pairs = _geographic_pairs(sample, time, others) or _local_pairs(sample, time, others)
    agreeing = _agreeing_headings(sample, time, others, pairs)
    if agreeing:
        return min(agreeing)[4:]
    if not pairs:
        return None, None
    if pairs[0][2] != "metres":
        # the second must be the latitude; no pair is known where either may be
        clear = [pair for pair in pairs if (pair[1], pair[0], pair[2]) not in pairs]
        return (clear[0] if len(clear) == 1 else None), None
    # x first, unless the values show that the first is the northing of a zone (easting 100 to 900 km)
    northing_first = len(on_map) == 2 and _size(sample, on_map[0]) > 1e6 and 1e5 <= _size(sample, on_map[1]) < 9e5
    return pairs[int(northing_first)], None


def _size(sample, k):
    return np.nanmedian(np.abs(sample[:, k]))


def _agreeing_headings(sample, time, others, pairs):
    """[(by what the likeliest is the least, ..., pair, heading column)]: pairs of coordinates with the headings that confirm them."""
    agreeing = []
    for a, b, unit in pairs:
        per_unit = np.degrees(1.0) if unit == "radians" else 1.0
        x, y = rough_metres(sample[:, a] * per_unit, sample[:, b] * per_unit, "" if unit == "metres" else "EPSG:4326")
        for h in others:
            if h in (a, b):
                continue
            disagreement = _heading_disagreement(x, y, sample[:, h])
            # every trajectory has heights and not every one headings: of a single column that may be either it is the height
            if disagreement is not None and _height_column(sample, time, others, (a, b), h) is not None:
                # roll and pitch agree with the course of a drive due north, so a wide range of values counts more than a close fit,
                # and so does a height of 24 m with a course of 24 degrees: roll and pitch stand before the heading
                agreeing.append((np.nanmax(np.abs(sample[:, h])) < 15.0, a > b, not _after_roll_and_pitch(sample, h), disagreement, (a, b, unit), h))
    return agreeing


def _local_pairs(sample, time, others):
    """x and y of local coordinates, whose values are too small to be recognised: only in the order x, y, z with time before or after it."""
    first = next((k for k in range(sample.shape[1]) if k != time and not _is_counter(sample[:, k])), 0)
    if not set(range(first, first + 3)) <= set(others) or (time or 0) > first + 3:
        return []
    unexplained = [k for k in others if k >= first + 3 and _size(sample, k) > 360.0]
    speed = np.hypot(*(_rate(sample, time, k, 98) for k in (first, first + 1)))
    return [(first, first + 1, "metres")] if not unexplained and 0.1 < speed < TRAJECTORY.max_vehicle_speed else []


def _geographic_pairs(sample, time, others):
    seconds = None if time is None else sample[:, time]
    pairs = [(a, b, geographic_unit(sample[:, a], sample[:, b], seconds)) for a in others for b in (a - 1, a + 1)
             if b in others and np.nanmax(np.abs(sample[:, a])) <= 180]
    return [pair for pair in pairs if pair[2]]


def _height_column(sample, time, others, plane, heading):
    """The slowly changing column that follows x and y, otherwise the only one left."""
    slow = [k for k in others if k not in (*plane, heading) and np.nanmax(np.abs(sample[:, k])) < TRAJECTORY.min_map_coordinate
            and _rate(sample, time, k, 90) < 20.0]
    next_column = max(plane) + 1
    if heading == next_column + 2 and _after_roll_and_pitch(sample, heading):
        slow = [k for k in slow if k not in (heading - 1, heading - 2)] or slow  # x, y, roll, pitch, heading, height
    if next_column in slow:
        return next_column
    # roll and pitch stay near zero, heights seldom do
    high = [k for k in slow if abs(np.nanmedian(sample[:, k])) > 8.0]
    return next((columns[0] for columns in (slow, high) if len(columns) == 1), None)


def _after_roll_and_pitch(sample, k):
    """Whether two columns before column k swing about zero within what a vehicle leans, in degrees."""
    if k is None or k < 2:
        return False
    before = sample[:, [k - 2, k - 1]]
    swings = (np.nanmean(before > 0, axis=0) > TRAJECTORY.least_swing) & (np.nanmean(before < 0, axis=0) > TRAJECTORY.least_swing)
    return bool(swings.all() and np.nanmax(np.abs(before)) < TRAJECTORY.max_lean)


# Whether numbers can be the headings and coordinates of a drive.


def rough_metres(x: np.ndarray, y: np.ndarray, crs: str) -> tuple[np.ndarray, np.ndarray]:
    """(N,) x and y in metres, of longitude and latitude as far as speeds and courses need it; an unknown CRS is taken to be metric."""
    if crs and horizontal_part(parse_crs(crs)).is_geographic:
        latitudes = y[np.isfinite(y)]
        middle = np.median(latitudes) if len(latitudes) else 0.0
        return x * np.cos(np.radians(middle)) * TRAJECTORY.metres_per_degree, y * TRAJECTORY.metres_per_degree
    return x, y


def driven_course(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(K,) indices of positions, at least `min_course_step` of driving apart, and (K,) courses there, degrees clockwise from north.

    x, y : (N,) metres, in driving order
    """
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    spacing = max(TRAJECTORY.min_course_step, driven[-1] / TRAJECTORY.max_course_rows)
    cell = np.floor(driven / spacing)
    rows = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    if len(rows) < 3:
        return np.empty(0, int), np.empty(0)
    course = np.degrees(np.arctan2(x[rows[2:]] - x[rows[:-2]], y[rows[2:]] - y[rows[:-2]]))
    return rows[1:-1], course


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(N,) degrees between (N,) directions in degrees, 0 to 180."""
    return np.abs((np.asarray(a) - b + 180.0) % 360.0 - 180.0)


def _heading_disagreement(x: np.ndarray, y: np.ndarray, heading: np.ndarray) -> float | None:
    """Median difference, degrees, of a column that may be the heading from the course driven; None beyond the tolerance, or where it is no angle."""
    good = np.isfinite(x) & np.isfinite(y) & np.isfinite(heading)
    rows, course = driven_course(x[good], y[good])
    # The course of a straight drive equals many a constant column: values beyond an angle's range exclude it.
    if len(rows) < 3 or np.abs(heading[good]).max() > 361.0:
        return None
    difference = min(float(np.median(angle_between(heading[good][rows] * factor, course))) for factor in (1.0, np.degrees(1.0)))
    return difference if difference < TRAJECTORY.heading_tolerance else None


def geographic_unit(lon: np.ndarray, lat: np.ndarray, time: np.ndarray | None = None) -> str:
    """The unit, "degrees" or "radians", of two columns that may be the longitude and latitude of a drive; "" where they are not.

    They are if their values are in range and change at the speed of a vehicle when taken as angles. time : (N,) seconds; None where unknown
    """
    good = np.isfinite(lon) & np.isfinite(lat)
    lon, lat = lon[good], lat[good]
    if len(lon) < 2 or np.abs(lon).max() > 360 or np.abs(lat).max() > 90:
        return ""
    if time is None:
        speed, drives = np.nan, 0 < max(np.ptp(lon), np.ptp(lat)) < 0.5
    else:
        speed, drives = _angular_speed(lon, lat, np.asarray(time)[good])
    if not drives:
        return ""
    if np.abs(lon).max() > np.pi or np.abs(lat).max() > np.pi / 2:
        return "degrees"
    if time is None:
        return ""
    return "radians" if speed * TRAJECTORY.metres_per_degree * np.degrees(1.0) < TRAJECTORY.max_vehicle_speed else "degrees"


def _angular_speed(lon, lat, time):
    """Degrees per second that nearly all steps keep below, and whether a vehicle can have travelled so."""
    step, seconds = np.hypot(np.diff(lon) * np.cos(np.radians(np.median(lat))), np.diff(lat)), np.diff(time)
    speed = np.percentile(step[seconds > 0] / seconds[seconds > 0], 95) if (seconds > 0).any() else 0.0
    # a constant, or the noise of a standard deviation, varies but does not travel
    travelled = np.hypot(*(np.diff(column).sum() for column in (lon, lat))) >= 0.02 * step.sum()
    return speed, travelled and 0 < speed < 2 * TRAJECTORY.max_vehicle_speed / TRAJECTORY.metres_per_degree
