"""Which column of a trajectory is which, by its name, and in which unit it is; the names stand in column_names.txt."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

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
