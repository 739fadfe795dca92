"""Which column of a trajectory is which, by its name, and in which unit it is: the one table of names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple

from ..weights import TRAJECTORY

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
    longest, most = TRAJECTORY.longest_name, TRAJECTORY.most_names
    cut = [name if len(name) <= longest else name[:longest - 1] + "…" for name in map(str, names[:most])]
    return ", ".join(cut) + (f" and {len(names) - most} more" if len(names) > most else "")
