"""Which column of a trajectory is which, by its name."""

from __future__ import annotations

import re
from collections.abc import Sequence

ROLES = ("time", "x", "y", "z", "roll", "pitch", "heading")

# Names without brackets, units, punctuation and capitals; the first that a table has is used.
COLUMN_NAMES = {
    "time": ("gpstime", "adjustedgpstime", "time", "timestamp", "t", "gpsseconds", "gpssec", "gpssow", "sow", "tow", "gpstow",
             "secondsofweek", "secofweek", "weekseconds", "secondsofday", "secofday", "sod", "seconds", "sec",
             "utctime", "utc", "epoch", "stamp", "zeit", "gpszeit"),
    "x": ("easting", "east", "x", "e", "xcoord", "xcoordinate", "utmx", "utmeasting", "utme", "posx", "positionx", "px", "rechtswert",
          "rechts", "ost", "xmap", "mapx", "eastingx"),
    "y": ("northing", "north", "y", "n", "ycoord", "ycoordinate", "utmy", "utmnorthing", "utmn", "posy", "positiony", "py", "hochwert",
          "hoch", "nord", "ymap", "mapy", "northingy"),
    "z": ("z", "ellipsoidheight", "ellipsoidalheight", "ellheight", "hell", "height", "altitude", "alt", "elevation",
          "elev", "orthometricheight", "orthoheight", "hortho", "h", "hgt", "zcoord", "zcoordinate", "posz", "positionz",
          "pz", "up", "u", "hoehe", "höhe"),
    "roll": ("roll", "rollangle"),
    "pitch": ("pitch", "pitchangle"),
    "heading": ("heading", "trueheading", "gridheading", "hdg", "yaw", "azimuth", "platformheading", "head", "headingangle",
                "yawangle", "kurs"),
    "lon": ("longitude", "lon", "long", "lng", "lambda", "laenge", "länge"),
    "lat": ("latitude", "lat", "phi", "breite"),
}
UNIT_NAMES = {"deg": "degrees", "degree": "degrees", "degrees": "degrees", "°": "degrees", "rad": "radians",
         "radian": "radians", "radians": "radians", "ft": "feet", "feet": "feet", "foot": "feet", "usft": "feet",
         "m": "metres", "meter": "metres", "meters": "metres", "metre": "metres", "metres": "metres", "s": "seconds",
         "sec": "seconds", "seconds": "seconds", "ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
MAX_HEADER_LINES = 15   # above a table, in which the names of its columns are sought


def columns_by_role(names: Sequence[str]) -> dict[str, str]:
    """The roles of columns by their names.

    Parameters
    ----------
    names : of the columns; capitals, punctuation and units such as in "roll_deg" or "Easting (m)" do not matter

    Returns
    -------
    {role: name} of the roles that are recognised: time, x, y, z, roll, pitch, heading, lon, lat
    """
    plain: dict[str, str] = {}
    for name in names:
        plain.setdefault(plain_name(name)[0], name)
    roles = {}
    for role, words in COLUMN_NAMES.items():
        found = next((word for word in words if word in plain), None)
        if found is not None:
            roles[role] = plain[found]
    return roles


def plain_name(name: str) -> tuple[str, str]:
    """A column name in small letters without unit and punctuation, and its unit as in UNIT_NAMES or ""."""
    text = str(name).strip().strip("#%").strip().lower()
    unit = ""
    bracket = re.search(r"[\[(<]([^\])>]*)[\])>]", text)
    if bracket:
        unit = UNIT_NAMES.get(bracket.group(1).strip().rstrip("."), "")
        text = text[:bracket.start()] + text[bracket.end():]
    words = [word for word in re.split(r"[^0-9a-zà-ÿ°]+", text) if word]
    if len(words) > 1 and words[-1] in UNIT_NAMES:
        unit = unit or UNIT_NAMES[words[-1]]
        words = words[:-1]
    return "".join(words), unit


def find_header(preamble: Sequence[str], columns: int) -> tuple[list[str] | None, list[str]]:
    """The names and units of columns, from the lines above a table.

    Parameters
    ----------
    preamble : lines, top down
    columns : number of columns

    Returns
    -------
    names : of the line that names the most roles; None where no line names two
    units : a value of `UNIT_NAMES` or "" for each column
    """
    best, names = 0, None
    for line in preamble[-MAX_HEADER_LINES:]:
        for found in _splits(line, columns):
            count = len(columns_by_role(found))
            if count > best:
                best, names = count, found
    if best < 2 or names is None:
        return None, [""] * columns
    units = [plain_name(name)[1] for name in names]
    if not any(units):
        units = _unit_line(preamble, columns) or units
    return names, units


def _splits(line, columns):
    text = line.strip().lstrip("#%/;!*").strip().replace('"', "")
    for pattern in (",", ";", r"\t", r"\|", r"\s{2,}", r"\s+"):
        fields = [field.strip() for field in re.split(pattern, text)]
        fields = fields[:-1] if fields and not fields[-1] else fields
        if len(fields) == columns:
            yield fields


def _unit_line(preamble, columns):
    for line in reversed(preamble):
        for fields in _splits(line, columns):
            units = [UNIT_NAMES.get(field.strip("[]()<> .").lower(), "") for field in fields]
            if sum(map(bool, units)) * 2 > columns:
                return units
    return None


def stated_angle_unit(preamble: Sequence[str]) -> str:
    """The unit of angles, "degrees" or "radians", where the lines above a table state one of them; otherwise ""."""
    text = " ".join(preamble).lower()
    stated = {unit for word, unit in (("radian", "radians"), ("[rad]", "radians"), ("(rad)", "radians"),
                                      ("degree", "degrees"), ("[deg]", "degrees"), ("(deg)", "degrees")) if word in text}
    return stated.pop() if len(stated) == 1 else ""
