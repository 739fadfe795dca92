"""Which column of a trajectory is which: by its name, and by the numbers where there is none."""

import re

import numpy as np

from ...common.errors import RoadExtractionError
from .trajectory import FASTEST

ROLES = ("time", "x", "y", "z", "roll", "pitch", "heading")

# Names as they read once brackets, units, signs and capitals are gone; the first that is there wins.
NAMES = {
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
UNITS = {"deg": "degrees", "degree": "degrees", "degrees": "degrees", "°": "degrees", "rad": "radians",
         "radian": "radians", "radians": "radians", "ft": "feet", "feet": "feet", "foot": "feet", "usft": "feet",
         "m": "metres", "meter": "metres", "meters": "metres", "metre": "metres", "metres": "metres", "s": "seconds",
         "sec": "seconds", "seconds": "seconds", "ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}

METRES_PER_DEGREE = 111_000.0
AGREES = 10.0            # degrees between a heading column and the driven course, median


def columns_by_role(names):
    """Role to name, for the roles that the names tell: time, x, y, z, roll, pitch, heading, lon, lat.

    `names` is a sequence of column names; capitals, signs and units such as
    "roll_deg" or "Easting (m)" do not matter.
    """
    plain = {}
    for name in names:
        plain.setdefault(plain_name(name)[0], name)
    roles = {}
    for role, words in NAMES.items():
        found = next((word for word in words if word in plain), None)
        if found is not None:
            roles[role] = plain[found]
    return roles


def plain_name(name):
    """(name in small letters without unit and signs, unit or "")."""
    text = str(name).strip().strip("#%").strip().lower()
    unit = ""
    bracket = re.search(r"[\[(<]([^\])>]*)[\])>]", text)
    if bracket:
        unit = UNITS.get(bracket.group(1).strip().rstrip("."), "")
        text = text[:bracket.start()] + text[bracket.end():]
    words = [word for word in re.split(r"[^0-9a-zà-ÿ°]+", text) if word]
    if len(words) > 1 and words[-1] in UNITS:
        unit = unit or UNITS[words[-1]]
        words = words[:-1]
    return "".join(words), unit


def find_header(preamble, columns):
    """The names and units of `columns` columns in the lines above a table.

    Returns
    -------
    (names or None, units): the line, and the way to split it, that names the
    most roles; units is one word of `UNITS` or "" per column.
    """
    best, names = 0, None
    for line in preamble[-15:]:
        for found in _splits(line, columns):
            count = len(columns_by_role(found))
            if count > best:
                best, names = count, found
    if best < 2:
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
            units = [UNITS.get(field.strip("[]()<> .").lower(), "") for field in fields]
            if sum(map(bool, units)) * 2 > columns:
                return units
    return None


def angle_unit_said(preamble):
    """"degrees" or "radians" where the lines above a table say one of them about the angles, else ""."""
    text = " ".join(preamble).lower()
    said = {unit for word, unit in (("radian", "radians"), ("[rad]", "radians"), ("(rad)", "radians"),
                                    ("degree", "degrees"), ("[deg]", "degrees"), ("(deg)", "degrees")) if word in text}
    return said.pop() if len(said) == 1 else ""


def driven_course(x, y):
    """(rows, degrees clockwise from north) of the rows at which at least a metre had been driven since the last."""
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
    # Steps of a metre at least: the jitter of a standing vehicle has a course of its own
    spacing = max(1.0, driven[-1] / 5000)
    cell = np.floor(driven / spacing)
    rows = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    if len(rows) < 3:
        return np.empty(0, int), np.empty(0)
    course = np.degrees(np.arctan2(x[rows[2:]] - x[rows[:-2]], y[rows[2:]] - y[rows[:-2]]))
    return rows[1:-1], course


def angle_between(a, b):
    """Degrees between directions, 0 to 180."""
    return np.abs((np.asarray(a) - b + 180.0) % 360.0 - 180.0)


def columns_from_numbers(values, path):
    """Role to column index of a table without names.

    Time is what grows evenly; x and y are large and move no faster than a car;
    z follows them; heading runs with the course driven. What cannot be told
    apart is not guessed.

    Raises
    ------
    RoadExtractionError
        If time, x, y and z cannot be told apart.
    """
    values = values[np.isfinite(values).sum(axis=1) >= 3]
    sample = values[:20000]
    count = sample.shape[1]
    if not len(sample):
        raise _not_told_apart(path, count)
    time = _time_column(sample) if count > 3 else None
    others = [k for k in range(count) if k != time and not _is_counter(sample[:, k]) and np.isfinite(sample[:, k]).mean() > 0.9]
    plane, heading = _plane(sample, time, others)
    if plane is None:
        raise _not_told_apart(path, count)
    roles = dict(zip(("x", "y") if plane[2] == "metres" else ("lon", "lat"), plane[:2]))
    z = _height_column(sample, time, others, plane[:2], heading)
    if z is None:
        raise _not_told_apart(path, count)
    roles["z"] = z
    if time is not None:
        roles["time"] = time
    if heading is not None:
        roles["heading"] = heading
        # roll, pitch, heading is the usual order; in any other the two cannot be told apart
        if heading - z == 3:
            roles["roll"], roles["pitch"] = z + 1, z + 2
    elif max(plane[:2]) < z <= count - 4:
        following = [z + 1, z + 2, z + 3]
        # a heading that does not follow the course (driven backwards, another zero) still reaches beyond 45 degrees
        if time not in following and np.nanmax(np.abs(sample[:, z + 3])) > 45 >= np.nanmax(np.abs(sample[:, [z + 1, z + 2]])):
            roles["roll"], roles["pitch"], roles["heading"] = following
    return roles


def _not_told_apart(path, count):
    return RoadExtractionError(
        f"{path} has {count} columns without names, and time, x, y and z cannot be told apart by their numbers. "
        "Put a line of names above them, such as time,x,y,z,roll,pitch,heading.")


def _is_counter(column):
    step = np.diff(column)
    return len(step) > 3 and column[0] in (0, 1) and (step == 1).all()


def _time_column(sample):
    """The column that grows most evenly; a row number only where nothing else grows."""
    best, chosen = np.inf, None
    for k in range(sample.shape[1]):
        step = np.diff(sample[:, k])
        step = step[np.isfinite(step)]
        if not len(step) or np.mean(step > 0) < 0.995:
            continue
        usual = np.median(step)
        uneven = np.mean(np.abs(step - usual) > 0.2 * usual) + (1.0 if _is_counter(sample[:, k]) else 0.0)
        # A coordinate grows evenly too on a straight road, but never by one and the same step
        uneven += 0.1 * min(np.median(np.abs(step - usual)) / usual, 1.0)
        if uneven < best - 1e-6:
            best, chosen = uneven, k
    return chosen


def _pace(sample, time, k, percent):
    """Change of a column per second, or per row where there is no time: a percentile, NaN where there is no step."""
    step = np.abs(np.diff(sample[:, k]))
    if time is not None:
        seconds = np.diff(sample[:, time])
        step = step / np.where(seconds > 0, seconds, np.nan)
    step = step[np.isfinite(step)]
    return np.percentile(step, percent) if len(step) else np.nan


def _plane(sample, time, others):
    """((x column, y column, unit) or None, heading column or None)."""
    fast = {k: _pace(sample, time, k, 98) for k in others}
    size = {k: np.nanmedian(np.abs(sample[:, k])) for k in others}
    map_like = [k for k in others if size[k] > 9000 and fast[k] < FASTEST]
    if len(map_like) > 2:
        return None, None
    if len(map_like) == 2:
        pairs = [(map_like[0], map_like[1], "metres"), (map_like[1], map_like[0], "metres")]
    else:
        pairs = _geographic_pairs(sample, time, others) or _local_pairs(sample, time, others, size, fast)
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
            if wrong is not None:
                # roll and pitch agree with a drive due north, so a wide angle counts more than a close fit
                agreeing.append((np.nanmax(np.abs(sample[:, h])) < 15.0, a > b, wrong, (a, b, unit), h))
    if agreeing:
        return min(agreeing)[3:]
    if len(map_like) == 2:
        return _usual_order(pairs[0], size), None
    if pairs and pairs[0][2] != "metres":
        return _longitude_first(pairs, sample), None
    return (pairs[0] if pairs else None), None


def heading_disagreement(x, y, heading):
    """Median degrees between a column and the course driven, in degrees or radians; None beyond 10 degrees."""
    good = np.isfinite(x) & np.isfinite(y) & np.isfinite(heading)
    rows, course = driven_course(x[good], y[good])
    # A straight drive agrees with many a constant column: the angle must be one, not a coordinate
    if len(rows) < 3 or np.abs(heading[good]).max() > 361.0:
        return None
    found = min(np.median(angle_between(heading[good][rows] * factor, course)) for factor in (1.0, np.degrees(1.0)))
    return found if found < AGREES else None


def _local_pairs(sample, time, others, size, fast):
    """x, y of coordinates too small to stand out: only the plain order x, y, z with time before or after it."""
    first = next((k for k in range(sample.shape[1]) if k != time and not _is_counter(sample[:, k])), 0)
    in_order = all(k in others for k in range(first, first + 3)) and (time is None or time < first or time == first + 3)
    unexplained = [k for k in others if k >= first + 3 and size[k] > 360.0]
    if not in_order or unexplained or not 0.1 < np.hypot(fast[first], fast[first + 1]) < FASTEST:
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


def geographic_unit(lon, lat, time=None):
    """"degrees" or "radians" where two columns can be longitude and latitude of a drive, else "".

    They can when they are in range and so slow that the vehicle would crawl a
    hand's breadth in metres, but drives at a vehicle's pace in angles.
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
        pace = None
    else:
        seconds = np.diff(np.asarray(time)[good])
        pace = np.percentile(step[seconds > 0] / seconds[seconds > 0], 95) if (seconds > 0).any() else 0.0
        if not 0 < pace * METRES_PER_DEGREE < 2 * FASTEST:
            return ""
        # a constant, or the noise of a standard deviation, wanders to and fro but does not travel
        if np.hypot(*(np.diff(column).sum() for column in (lon, lat))) < 0.02 * step.sum():
            return ""
    if np.abs(lon).max() > np.pi or np.abs(lat).max() > np.pi / 2:
        return "degrees"
    in_radians = None if pace is None else pace * METRES_PER_DEGREE * np.degrees(1.0)
    return "radians" if in_radians is not None and in_radians < FASTEST else "degrees" if pace is not None else ""


def _usual_order(pair, size):
    """x first, unless the sizes say that the first is the northing of a zone (easting 100 to 900 km)."""
    a, b, unit = pair
    a, b = min(a, b), max(a, b)
    return (b, a, unit) if size[a] > 1e6 and 1e5 <= size[b] < 9e5 else (a, b, unit)


def _longitude_first(pairs, sample):
    """The pair whose second column must be the latitude, None where either could be."""
    clear = [pair for pair in pairs if (pair[1], pair[0], pair[2]) not in pairs]
    if len(clear) == 1:
        return clear[0]
    return None


def _height_column(sample, time, others, plane, heading):
    """The slow column that follows x and y, else the only one left."""
    left = [k for k in others if k not in plane and k != heading and np.nanmax(np.abs(sample[:, k])) < 9000]
    slow = [k for k in left if _pace(sample, time, k, 90) < 20.0]
    following = [k for k in slow if k == max(plane) + 1]
    if following:
        return following[0]
    # roll and pitch stay near zero, a height seldom does
    high = [k for k in slow if abs(np.nanmedian(sample[:, k])) > 8.0]
    return slow[0] if len(slow) == 1 else high[0] if len(high) == 1 else None
