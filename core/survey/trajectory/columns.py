"""Which column of a trajectory is which, by its name, and in which unit it is: the one table of names."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import horizontal_part, parse_crs
from .trajectory import MAX_VEHICLE_SPEED

ROLES = ("time", "x", "y", "z", "roll", "pitch", "heading")

# {role: (whole names, of which the first that a table has is used; words of which a longer name holds one, such as "time" of "GPS Time of Week";
# words that may stand with these)}, without brackets, units, punctuation and capitals. Single letters count as words of their own, the others
# also where they are written together.
_PLATFORM = "gps gnss ins imu sensor antenna scanner vehicle platform position pos coord coordinate"
_ON_MAP, _DATE = f"{_PLATFORM} utm grid map coordinates local projected world", "gps utc local"
_ON_EARTH = f"{_PLATFORM} wgs84 wgs geodetic geographic geographische decimal dd"
_TURNS = "angle true grid ins imu sensor vehicle platform euler"
_NAMES = {
    "time": ("gpstime adjustedgpstime time timestamp t gpsseconds gpssec gpssow sow tow gpstow secondsofweek secofweek weekseconds secondsofday "
             "secofday sod seconds sec utctime utc epoch stamp zeit gpszeit",
             "time times timestamp timetag seconds second secs sec ss sow tow itow sod gpst utc clock epoch stamp datetime zeit uhrzeit zeitpunkt "
             "zeitstempel temps sekunde sekunden seconde secondes segundo segundos mjd jd julian datenum heure tiempo hora tempo tijd время 时间 "
             "时刻 時刻 時間 日時 日期时间",
             "gps gnss of week day the in adjusted adj standard offset unix posix local system receiver since start elapsed date log ins imu sensor "
             "measurement relative absolute mean gpszeit von woche tag modified excel serial matlab days number"),
    "x": ("easting east x e xcoord xcoordinate utmx utmeasting utme posx positionx px rechtswert rechts ost xmap mapx eastingx",
          "easting east eastings x e este est ost rechtswert oost 东坐标 東座標", _ON_MAP),
    "y": ("northing north y n ycoord ycoordinate utmy utmnorthing utmn posy positiony py hochwert hoch nord ymap mapy northingy",
          "northing north northings y n norte nord hochwert noord 北坐标 北座標", _ON_MAP),
    "z": ("z ellipsoidheight ellipsoidalheight ellheight hell height altitude alt elevation elev orthometricheight orthoheight hortho h hgt zcoord "
          "zcoordinate posz positionz pz up u hoehe höhe",
          "height heights altitude alt elevation elev ele hgt ht z h hell ellh hae msl hmsl hoehe höhe hauteur altura altezza quota cota hoogte "
          "высота 高程 高度 標高 楕円体高 大地高",
          f"{_PLATFORM} ellipsoid ellipsoidal ell ellipsoidische ellipsoïdale ellipsoidale wgs84 wgs orthometric "
          "ortho orth above sea level mean up local geodetic map"),
    "roll": ("roll rollangle", "roll rollwinkel rolio roulis rollio 横滚 横滚角 ロール", _TURNS),
    "pitch": ("pitch pitchangle", "pitch nickwinkel tangage beccheggio cabeceo 俯仰 俯仰角 ピッチ", _TURNS),
    "heading": ("heading trueheading gridheading hdg yaw azimuth platformheading head headingangle yawangle kurs",
                "heading yaw hdg azimuth kurs cap rumbo rotta 航向 航向角 方位角 方位", _TURNS),
    "lon": ("longitude lon long lng lambda laenge länge",
            "longitude lon lng longitud longitudine laenge länge longitudinal 经度 経度 долгота", f"{_ON_EARTH} e"),
    "lat": ("latitude lat phi breite", "latitude lat latitud latitudine breite 纬度 緯度 широта", f"{_ON_EARTH} n"),
    "week": ("gpsweek week weekno weeknumber gpsweeknumber wn wnc gpswoche", "week wn wnc woche", "gps gnss number no nr"),
    "date": ("date gpsdate utcdate datum calendardate fecha 日期 日付", "date datum", "gps gnss utc calendar local"),
    "year": ("year yyyy yr", "year jahr année año anno ano 年", _DATE),
    "month": ("month mon mm", "month monat mois mes mese mês 月", _DATE),
    "day": ("day dd", "day tag jour día dia giorno 日", f"{_DATE} of month"),
    "hour": ("hour hours hh gpshour utchour", "hour hours stunde heure hora ora 时 時", _DATE),
    "minute": ("minute minutes min gpsminute utcminute mm", "minute minutes minuto 分", _DATE),
    **{f"ecef_{axis}": ("", axis, "ecef earth centred centered geocentric cartesian wgs84 itrf xyz coord coordinate position pos") for axis in "xyz"},
}
ROLE_NAMES = {role: tuple(tuple(words.split()) for words in names) for role, names in _NAMES.items()}
EARTH_CENTRED = {"ecef", "geocentric", "centred", "centered"}   # one of these tells a coordinate from one on a map
# Behind a name in brackets these say what a column is of; other words there change nothing.
QUALIFYING = EARTH_CENTRED | {"sd", "std", "stdev", "sigma", "rms", "rmse", "error", "accuracy", "velocity", "speed", "rate", "bias", "gps", "gpst",
                              "utc", "unix", "orthometric", "ellipsoidal", "ellipsoid", "msl", "geoid", "week", "day"}


class Unit(NamedTuple):
    """What a column counts, "" where that is not said, and what one of its units is of that."""

    name: str = ""
    factor: float = 1.0


_UNITS = {
    ("degrees", 1.0): "deg degree degrees ° dd", ("radians", 1.0): "rad radian radians", ("degrees", 0.9): "gon grads",
    ("feet", 1.0): "ft feet foot usft", ("metres", 1.0): "m meter meters metre metres", ("metres", 1e3): "km", ("metres", 0.01): "cm",
    ("metres", 1e-3): "mm", ("seconds", 1.0): "s sec secs seconds", ("seconds", 1e-3): "ms msec milliseconds millisec millis",
    ("seconds", 1e-6): "us µs μs usec microseconds", ("seconds", 1e-9): "ns nsec nanoseconds", ("sexagesimal", 1.0): "d m s|dms|d:m:s|ddd mm ss",
}
UNIT_NAMES = {word: Unit(*unit) for unit, words in _UNITS.items() for word in (words.split("|") if "|" in words else words.split())}
# Degrees, minutes and seconds in one number: DDMMSS.ss, DD.MMSSss of pocket calculators, DDMM.mmmm of receivers
PACKED_ANGLES = ((re.compile(r"d{2,3}m{2}s{2}(\.s+)?"), Unit("packed seconds")), (re.compile(r"d{1,3}\.m{2}s{2,}"), Unit("packed seconds", 1e4)),
                 (re.compile(r"d{2,3}m{2}(\.m+)?"), Unit("packed minutes")))
MAX_HEADER_LINES = 15   # above a table, in which the names of its columns are sought
LONGEST_NAME, MOST_NAMES = 40, 25   # of names of columns in a message
SEPARATORS = (",", ";", r"\t", r"\|", r"\s{2,}", r"\s+")


def columns_by_role(names: Sequence[str]) -> dict[str, str]:
    """The roles of columns by their names.

    Parameters
    ----------
    names : of the columns; capitals, punctuation and units such as in "roll_deg" or "Easting (m)" do not matter

    Returns
    -------
    {role: name} of the roles that are recognised: time, x, y, z, roll, pitch, heading, lon, lat, and parts of these
    """
    return {role: names[places[0]] for role, places in candidates_by_role(names).items()}


def candidates_by_role(names: Sequence[str]) -> dict[str, list[int]]:
    """{role: places of the columns that may be it by their names, the likeliest first}."""
    found: dict[str, list[tuple[int, int]]] = {}
    for place, name in enumerate(names):
        for role, rank in _roles_of_name(str(name)).items():
            found.setdefault(role, []).append((rank, place))
    return {role: [place for _, place in sorted(found[role])] for role in ROLE_NAMES if role in found}


@cache
def _roles_of_name(name):
    """{role: rank, 0 for the usual name} of one name."""
    words, within, _ = _taken_apart(name)
    plain, every = "".join(words), [*words, *within]
    earth = bool(EARTH_CENTRED & set(every))
    roles = {}
    for role, (usual, *_) in ROLE_NAMES.items():
        whole = _is_of(role, every) or _is_of(role, [plain, *within])
        if role.startswith("ecef") != earth:
            continue
        if plain in usual and (whole or not within):
            roles[role] = usual.index(plain)
        elif whole:
            roles[role] = len(usual)
    return roles


@cache
def _grammar(role):
    _, core, further = ROLE_NAMES[role]
    whole = "|".join(sorted((re.escape(word) for word in core if len(word) > 1), key=len, reverse=True)) or "(?!)"
    every = "|".join(sorted((re.escape(word) for word in (*core, *further) if len(word) > 1), key=len, reverse=True))
    return re.compile(f"(?:{every})*(?:{whole})(?:{every})*"), re.compile(f"(?:{every})+|[{''.join(word for word in further if len(word) == 1)}-]"), \
        {word for word in core if len(word) == 1}


def _is_of(role, words):
    """Whether all words of a name belong to a role, and one of them says so."""
    core, further, letters = _grammar(role)
    says = [word in letters or bool(core.fullmatch(word)) for word in words]
    return any(says) and all(said or further.fullmatch(word) for said, word in zip(says, words))


def unit_of_name(name: str) -> Unit:
    """The unit in the name of a column, such as "roll_deg", "Easting [m]" or "TOW [0.001 s]"."""
    return _taken_apart(str(name))[2]


@cache
def _taken_apart(name):
    """(words, words in brackets that say what it is of, Unit) of a name, in small letters."""
    text, unit, within = name.strip().strip("#%").strip(), Unit(), []
    for bracket in re.findall(r"[\[(<]([^\])>]*)[\])>]", text):
        inside = unit_named(bracket)
        unit = unit if unit.name else inside
        within += [word for word in _split(bracket) if word in QUALIFYING] if not inside.name else []
    words = _split(re.sub(r"[\[(<][^\])>]*[\])>]?", " ", text))
    # "gps_week_seconds" is a time and no week in seconds
    if len(words) > 1 and words[-1] in UNIT_NAMES and not _is_of("time", words) and any(_is_of(role, words[:-1]) or "".join(words[:-1]) in usual
                                                          for role, (usual, *_) in ROLE_NAMES.items()):
        unit = unit if unit.name else UNIT_NAMES[words[-1]]
        words = words[:-1]
    if "".join(words) == "itow" and not unit.name:
        unit = UNIT_NAMES["ms"]   # u-blox counts the time of week in milliseconds
    return words, within, unit


def _split(text):
    """Words in small letters; a capital within a word begins another one."""
    text = re.sub(r"(?<=[a-zà-ÿ])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", text) if not text.isupper() else text
    words = [word for word in re.split(r"[^\w°]+|_", text.lower()) if word]
    return ["utm" if re.fullmatch(r"utm\d*[ns]?", word) else word for word in words]


def unit_named(text: str) -> Unit:
    """The Unit that a text names, maybe with a number before it, such as "0.001 s" or "1e-7 deg"; Unit() where it names none."""
    words = " ".join(text.lower().strip("[]()<> .").split())
    behind = re.fullmatch(r"(\D+?)\s*[*x]\s*(\d[\d.]*(?:e-?\d+)?|10\^?-\d+)", words)
    words = f"{behind[2]} {behind[1]}" if behind else words
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
    cut = [name if len(name) <= LONGEST_NAME else name[:LONGEST_NAME - 1] + "…" for name in map(str, names[:MOST_NAMES])]
    return ", ".join(cut) + (f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else "")


# Which column of a trajectory is which, by its numbers, where the columns have no names.

MAX_SAMPLE_ROWS = 20_000      # rows from which the columns are recognised
MAX_LEAN = 20.0               # degrees: no vehicle on a road rolls or pitches by more
LEAST_SWING = 0.05            # of the rows on either side of zero
MIN_MAP_COORDINATE = 9000.0   # m: x and y of map coordinates are larger, heights are smaller


def columns_from_numbers(values: np.ndarray, path: str | os.PathLike[str]) -> dict[str, int]:
    """The roles of the columns of a table without names.

    Time increases evenly; x and y are large and change no faster than a vehicle drives; z follows
    them; the heading agrees with the course driven. Nothing is guessed where several columns qualify.

    Parameters
    ----------
    values : (N, K) numbers, in driving order
    path : of the file, for messages

    Returns
    -------
    {role: index of the column}, with x, y or lon, lat

    Raises
    ------
    RoadExtractionError
        If time, x, y and z cannot be recognised.
    """
    values = values[np.isfinite(values).sum(axis=1) >= 3]
    sample = values[:MAX_SAMPLE_ROWS]
    count = sample.shape[1]
    if not len(sample):
        raise _unrecognised_columns(path, count)
    time = _time_column(sample) if count > 3 else None
    others = [k for k in range(count) if k != time and not _is_counter(sample[:, k]) and np.isfinite(sample[:, k]).mean() > 0.9]
    plane, heading = _plane(sample, time, others)
    if plane is None:
        raise _unrecognised_columns(path, count)
    roles = dict(zip(("x", "y") if plane[2] == "metres" else ("lon", "lat"), plane[:2]))
    z = _height_column(sample, time, others, plane[:2], heading)
    if z is None:
        raise _unrecognised_columns(path, count)
    roles["z"] = z
    if time is not None:
        roles["time"] = time
    if heading is not None:
        roles["heading"] = heading
        # roll, pitch, heading is the usual order; in another, roll and pitch cannot be distinguished
        if heading - z == 3 or (_after_roll_and_pitch(sample, heading) and not {heading - 1, heading - 2} & set(roles.values())):
            roles["roll"], roles["pitch"] = heading - 2, heading - 1
    elif max(plane[:2]) < z <= count - 4:
        following = [z + 1, z + 2, z + 3]
        # a heading that disagrees with the course (driven backwards, another zero direction) still exceeds 45 degrees
        if time not in following and np.nanmax(np.abs(sample[:, z + 3])) > 45 >= np.nanmax(np.abs(sample[:, [z + 1, z + 2]])):
            roles["roll"], roles["pitch"], roles["heading"] = following
    return roles


def _unrecognised_columns(path, count):
    return RoadExtractionError(
        f"{path} has {count} columns without names, and time, x, y and z cannot be recognised from their numbers. "
        "Put a line of names above them, such as time,x,y,z,roll,pitch,heading.")


def _is_counter(column):
    step = np.diff(column)
    return len(step) > 3 and column[0] in (0, 1) and (step == 1).all()


def _time_column(sample):
    """The column that increases most evenly; a row number only where nothing else increases."""
    best, found = np.inf, None
    for k in range(sample.shape[1]):
        step = np.diff(sample[:, k])
        step = step[np.isfinite(step)]
        if not len(step) or np.mean(step > 0) < 0.995:
            continue
        usual = np.median(step)
        uneven = np.mean(np.abs(step - usual) > 0.2 * usual) + (1.0 if _is_counter(sample[:, k]) else 0.0)
        # a coordinate increases evenly on a straight road, but never in equal steps
        uneven += 0.1 * min(np.median(np.abs(step - usual)) / usual, 1.0)
        if uneven < best - 1e-6:
            best, found = uneven, k
    return found


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
    rate = {k: _rate(sample, time, k, 98) for k in others}
    size = {k: np.nanmedian(np.abs(sample[:, k])) for k in others}
    map_like = [k for k in others if size[k] > MIN_MAP_COORDINATE and rate[k] < MAX_VEHICLE_SPEED]
    if len(map_like) > 2:
        return None, None
    if len(map_like) == 2:
        pairs = [(map_like[0], map_like[1], "metres"), (map_like[1], map_like[0], "metres")]
    else:
        pairs = _geographic_pairs(sample, time, others) or _local_pairs(sample, time, others, size, rate)
    agreeing = _agreeing_headings(sample, time, others, pairs)
    if agreeing:
        return min(agreeing)[4:]
    if len(map_like) == 2:
        return _usual_order(pairs[0], size), None
    if pairs and pairs[0][2] != "metres":
        return _longitude_first(pairs, sample), None
    return (pairs[0] if pairs else None), None


def _agreeing_headings(sample, time, others, pairs):
    """[(by what the likeliest is the least, ..., pair, heading column)]: pairs of coordinates with the headings that confirm them."""
    agreeing = []
    for a, b, unit in pairs:
        x, y = sample[:, a].copy(), sample[:, b].copy()
        if unit != "metres":
            scale = METRES_PER_DEGREE * (np.degrees(1.0) if unit == "radians" else 1.0)
            middle = np.nanmedian(y) * (1.0 if unit == "radians" else np.pi / 180)
            x, y = x * scale * np.cos(middle), y * scale
        for h in others:
            if h in (a, b):
                continue
            wrong = heading_disagreement(x, y, sample[:, h])
            # every trajectory has heights and not every one headings: of a single column that may be either it is the height
            if wrong is not None and _height_column(sample, time, others, (a, b), h) is not None:
                # roll and pitch agree with the course of a drive due north, so a wide range of values counts more than a close fit,
                # and so does a height of 24 m with a course of 24 degrees: roll and pitch stand before the heading
                agreeing.append((np.nanmax(np.abs(sample[:, h])) < 15.0, a > b, not _after_roll_and_pitch(sample, h), wrong, (a, b, unit), h))
    return agreeing


def _local_pairs(sample, time, others, size, rate):
    """x and y of local coordinates, whose values are too small to be recognised: only in the order x, y, z with time before or after it."""
    first = next((k for k in range(sample.shape[1]) if k != time and not _is_counter(sample[:, k])), 0)
    in_order = all(k in others for k in range(first, first + 3)) and (time is None or time < first or time == first + 3)
    unexplained = [k for k in others if k >= first + 3 and size[k] > 360.0]
    if not in_order or unexplained or not 0.1 < np.hypot(rate[first], rate[first + 1]) < MAX_VEHICLE_SPEED:
        return []
    return [(first, first + 1, "metres")]


def _geographic_pairs(sample, time, others):
    pairs = []
    for a in others:
        for b in others:
            if abs(a - b) != 1 or np.nanmax(np.abs(sample[:, a])) > 180 or np.nanmax(np.abs(sample[:, b])) > 90:
                continue
            unit = geographic_unit(sample[:, a], sample[:, b], None if time is None else sample[:, time])
            if unit:
                pairs.append((a, b, unit))
    return pairs


def _usual_order(pair, size):
    """x first, unless the values show that the first is the northing of a zone (easting 100 to 900 km)."""
    a, b, unit = pair
    a, b = min(a, b), max(a, b)
    return (b, a, unit) if size[a] > 1e6 and 1e5 <= size[b] < 9e5 else (a, b, unit)


def _longitude_first(pairs, sample):
    """The pair whose second column must be the latitude, None where either may be."""
    clear = [pair for pair in pairs if (pair[1], pair[0], pair[2]) not in pairs]
    if len(clear) == 1:
        return clear[0]
    return None


def _height_column(sample, time, others, plane, heading):
    """The slowly changing column that follows x and y, otherwise the only one left."""
    left = [k for k in others if k not in plane and k != heading and np.nanmax(np.abs(sample[:, k])) < MIN_MAP_COORDINATE]
    slow = [k for k in left if _rate(sample, time, k, 90) < 20.0]
    following = [k for k in slow if k == max(plane) + 1]
    if heading == max(plane) + 3 and _after_roll_and_pitch(sample, heading):
        slow = [k for k in slow if k not in (heading - 1, heading - 2)] or slow  # x, y, roll, pitch, heading, height
    if following and following[0] in slow:
        return following[0]
    # roll and pitch stay near zero, heights seldom do
    high = [k for k in slow if abs(np.nanmedian(sample[:, k])) > 8.0]
    return slow[0] if len(slow) == 1 else high[0] if len(high) == 1 else None


def _after_roll_and_pitch(sample, k):
    """Whether two columns before column k swing about zero within what a vehicle leans, in degrees."""
    if k is None or k < 2:
        return False
    before = sample[:, [k - 2, k - 1]]
    swings = (np.nanmean(before > 0, axis=0) > LEAST_SWING) & (np.nanmean(before < 0, axis=0) > LEAST_SWING)
    return bool(swings.all() and np.nanmax(np.abs(before)) < MAX_LEAN)


# Whether numbers can be the headings and coordinates of a drive.

METRES_PER_DEGREE = 111_000.0   # of latitude, rounded
HEADING_TOLERANCE = 10.0        # degrees between the heading and the course driven, median
MIN_COURSE_STEP = 1.0           # m of driving between two courses: the positions of a standing vehicle scatter in all directions
MAX_COURSE_ROWS = 5000          # courses of a drive


def rough_metres(x: np.ndarray, y: np.ndarray, crs: str) -> tuple[np.ndarray, np.ndarray]:
    """(N,) x and y in metres, of longitude and latitude as far as speeds and courses need it.

    Parameters
    ----------
    x, y : (N,) in the CRS
    crs : WKT or "EPSG:n"; "" where unknown, which is taken to be metric
    """
    if crs and horizontal_part(parse_crs(crs)).is_geographic:
        return x * np.cos(np.radians(np.nanmedian(y))) * METRES_PER_DEGREE, y * METRES_PER_DEGREE
    return x, y


def driven_course(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The course of a drive.

    Parameters
    ----------
    x, y : (N,) metres, in driving order

    Returns
    -------
    rows : (K,) indices of positions, at least MIN_COURSE_STEP of driving apart
    course : (K,) degrees clockwise from north at these
    """
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    spacing = max(MIN_COURSE_STEP, driven[-1] / MAX_COURSE_ROWS)
    cell = np.floor(driven / spacing)
    rows = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    if len(rows) < 3:
        return np.empty(0, int), np.empty(0)
    course = np.degrees(np.arctan2(x[rows[2:]] - x[rows[:-2]], y[rows[2:]] - y[rows[:-2]]))
    return rows[1:-1], course


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(N,) degrees between (N,) directions in degrees, 0 to 180."""
    return np.abs((np.asarray(a) - b + 180.0) % 360.0 - 180.0)


def heading_disagreement(x: np.ndarray, y: np.ndarray, heading: np.ndarray) -> float | None:
    """How far a column that may be the heading differs from the course driven.

    Parameters
    ----------
    x, y : (N,) metres
    heading : (N,) degrees or radians

    Returns
    -------
    Median difference in degrees; None beyond HEADING_TOLERANCE or where the column cannot be an angle
    """
    good = np.isfinite(x) & np.isfinite(y) & np.isfinite(heading)
    rows, course = driven_course(x[good], y[good])
    # The course of a straight drive equals many a constant column: values beyond an angle's range exclude it.
    if len(rows) < 3 or np.abs(heading[good]).max() > 361.0:
        return None
    found = min(float(np.median(angle_between(heading[good][rows] * factor, course))) for factor in (1.0, np.degrees(1.0)))
    return found if found < HEADING_TOLERANCE else None


def geographic_unit(lon: np.ndarray, lat: np.ndarray, time: np.ndarray | None = None) -> str:
    """The unit of two columns that may be the longitude and latitude of a drive.

    They are if their values are in range and change at the speed of a vehicle when taken as angles.

    Parameters
    ----------
    lon, lat : (N,) numbers
    time : (N,) seconds; None where unknown

    Returns
    -------
    "degrees" or "radians"; "" where they are not longitude and latitude
    """
    good = np.isfinite(lon) & np.isfinite(lat)
    lon, lat = lon[good], lat[good]
    if len(lon) < 2 or np.abs(lon).max() > 360 or np.abs(lat).max() > 90:
        return ""
    step = np.hypot(np.diff(lon) * np.cos(np.radians(np.median(lat))), np.diff(lat))
    if time is None:
        extent = max(np.ptp(lon), np.ptp(lat))
        if not 0 < extent < 0.5:
            return ""
        speed = None
    else:
        seconds = np.diff(np.asarray(time)[good])
        speed = np.percentile(step[seconds > 0] / seconds[seconds > 0], 95) if (seconds > 0).any() else 0.0
        if not 0 < speed < 2 * MAX_VEHICLE_SPEED / METRES_PER_DEGREE:
            return ""
        # a constant, or the noise of a standard deviation, varies but does not travel
        if np.hypot(*(np.diff(column).sum() for column in (lon, lat))) < 0.02 * step.sum():
            return ""
    if np.abs(lon).max() > np.pi or np.abs(lat).max() > np.pi / 2:
        return "degrees"
    in_radians = None if speed is None else speed * METRES_PER_DEGREE * np.degrees(1.0)
    return "radians" if in_radians is not None and in_radians < MAX_VEHICLE_SPEED else "degrees" if speed is not None else ""
