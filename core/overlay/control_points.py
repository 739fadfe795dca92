"""Ground control points: places known both in the image and on the map, from a table in any usual form.

Pixel and line count from the outer corner of the first pixel, whose middle is
0.5, 0.5. QGIS's georeferencer counts lines upwards, so that they are negative;
that is recognised and turned.
"""

import csv
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..common.errors import RoadExtractionError

# Which column of a table of control points is which, by their names or, without names, by the image's size.

COLUMN_ALIASES = {
    "pixel": "pixel pixelx sourcex srcx column col sample px imagex imgx imx xpixel ximage xsource u".split(),
    "line": "line pixely sourcey srcy row py imagey imgy imy ypixel yimage ysource v".split(),
    "easting": "mapx easting east e geox worldx utme xmap xworld rechtswert rw".split(),
    "northing": "mapy northing north n geoy worldy utmn ymap yworld hochwert hw".split(),
    "height": "mapz z h geoz height elevation elev altitude alt".split(),
    "name": "name point id pointid label gcp gcpname gcpid number no nr".split(),
    "enable": "enable enabled active use used".split(),
    "role": "role type".split(),
    "check": "check ischeck checkpoint".split(),
}
REQUIRED_COLUMNS = ("pixel", "line", "easting", "northing")


def find_columns(names, what):
    """{meaning: index} of the columns of a table with a header.

    Bare `x`, `y` are map coordinates, unless those have names of their own.

    Raises
    ------
    RoadExtractionError
        If one of pixel, line, easting, northing has no column.
    """
    plain = [re.sub(r"[^a-z]", "", re.sub(r"\(.*?\)|\[.*?\]", "", str(name).lower())) for name in names]
    found = {}
    for key, aliases in COLUMN_ALIASES.items():
        places = [plain.index(alias) for alias in aliases if alias in plain]
        if places:
            found[key] = places[0]
    for bare, keys in (("x", ("easting", "pixel")), ("y", ("northing", "line"))):
        free = [key for key in keys if key not in found]
        if bare in plain and free:
            found[free[0]] = plain.index(bare)
    missing = [key for key in REQUIRED_COLUMNS if key not in found]
    if missing:
        raise RoadExtractionError(
            f"{what} has the columns {', '.join(map(str, names))}; {' and '.join(missing)} cannot be told among them. "
            "Name the columns pixel, line, easting, northing.")
    return found


def guess_columns(rows, image, what):
    """{meaning: index} of a table without names: two columns lie in the image, two beside them on the map.

    Raises
    ------
    RoadExtractionError
        If both orders, or none, would do.
    """
    width = min(len(row) for row in rows)
    values = np.array([[as_number(field) for field in row[:width]] for row in rows])
    fits = []
    for start in (0, 1):  # a point's name may come first
        if start + 4 > width or not np.isfinite(values[:, start:start + 4]).all():
            continue
        first, second = values[:, start:start + 2], values[:, start + 2:start + 4]
        for order, pair, other in ((("pixel", "line", "easting", "northing"), first, second),
                                   (("easting", "northing", "pixel", "line"), second, first)):
            inside, elsewhere = (image.holds(p[:, 0], np.abs(p[:, 1]), 1.0).all() for p in (pair, other))
            if inside and not elsewhere:
                fits.append({**{key: start + k for k, key in enumerate(order)}, **({"name": 0} if start else {}),
                             **_enable(values, start + 4)})
    if len(fits) != 1:
        raise RoadExtractionError(
            f"The columns of {what} have no names, and their numbers do not tell which are pixel and line in an image of "
            f"{image.width} by {image.height}. Put a line above them: pixel,line,easting,northing.")
    return fits[0]


def _enable(values, column):
    """The georeferencer's fifth column where there is one, of zeros and ones."""
    return {"enable": column} if column < values.shape[1] and np.isin(values[:, column], (0, 1)).all() else {}


def as_number(value):
    """The number that a field holds, NaN where it is none."""
    try:
        return float(str(value).strip().replace(",", "."))
    except ValueError:
        return np.nan


# Control points from a file: QGIS's `.points` in its old and new forms, or CSV with any delimiter.

MAX_TABLE_BYTES = 20_000_000  # bytes; a table of control points is a few thousand


def read_control_points(path, image, crs=""):
    """ControlPoints of a file.

    Parameters
    ----------
    path : `.points` of QGIS's georeferencer (a line "#CRS: ..." or none; mapX, mapY, sourceX,
        sourceY or pixelX, pixelY; commas or, from QGIS 1, tabs), or a CSV or TXT table
    image : SourceImage that the points belong to
    crs : WKT of the map coordinates where the file names none

    Raises
    ------
    RoadExtractionError
        If the file cannot be read or its columns cannot be told.
    """
    lines, named = _lines(path)
    delimiter = _delimiter(lines)
    rows = [[field.strip() for field in row] for row in csv.reader(lines, delimiter=delimiter, skipinitialspace=True)]
    rows = [[field for field in row if field] if delimiter == " " else row for row in rows]
    rows = [row for row in rows if any(row)]
    header = None
    if rows and sum(as_number(field) == as_number(field) for field in rows[0]) < 2:
        header, rows = rows[0], rows[1:]
    return control_points(header, rows, image, str(path), _wkt(named, path) or crs)


def _lines(path):
    """The lines of the table, and the CRS named above it."""
    try:
        if Path(path).stat().st_size > MAX_TABLE_BYTES:
            raise RoadExtractionError(f"{path} is too large for a table of control points. Was the image chosen in its place?")
        data = Path(path).read_bytes()
    except OSError as problem:
        raise RoadExtractionError(
            f"{path} cannot be read ({problem.strerror or problem}). Check the path and the rights to read it.") from problem
    if b"\0" in data and data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        raise RoadExtractionError(f"{path} is no text. Control points are read from a .points or CSV file.")
    text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "replace")
    named, lines = "", []
    for line in text.splitlines():
        bare = line.strip()
        if bare.startswith("#"):
            words = bare.lstrip("# ")
            if words.lower().startswith("crs:"):
                named = words[4:].strip()
                continue
            # A header may be written as a comment
            if _delimiter([words]) == " " or not any(word.strip().lower().replace("_", "") in COLUMN_ALIASES["easting"] + COLUMN_ALIASES["pixel"]
                                                     for word in words.split(_delimiter([words]))):
                continue
            bare = words
        if bare:
            lines.append(bare)
    return lines, named


def _delimiter(lines):
    """Of the first line that has one; a comma beside semicolons or tabs is a decimal sign."""
    first = next(iter(lines), "")
    return next((mark for mark in (";", "\t", ",") if mark in first), " ")


def _wkt(named, path):
    from ..io.crs import parse_crs

    if not named:
        return ""
    try:
        return parse_crs(named).to_wkt()
    except RoadExtractionError as problem:
        raise RoadExtractionError(f"{path} names a CRS that is not understood: {named[:60]!r}. "
                                  "Correct its first line (#CRS: EPSG:number) or remove it and give the CRS.") from problem

CONTROL, CHECK, DISABLED = "control", "check", "disabled"
_FALSE_TEXTS = ("0", "false", "no", "off", "n", "f")
_CHECK_TEXTS = ("check", "checkpoint", "check point", "chk", "cp", "test")


@dataclass(frozen=True)
class ControlPoints:
    """N points.

    Attributes
    ----------
    pixel, line : (N,) in the image, lines counted downwards
    easting, northing, height : (N,) on the map, m; height NaN where it is not known
    names : N texts
    roles : (N,) of "control" (they place the image), "check" (they only judge it), "disabled"
    crs : WKT of the map coordinates, "" where unknown
    left_out : rows of the table that held no numbers
    """

    pixel: np.ndarray
    line: np.ndarray
    easting: np.ndarray
    northing: np.ndarray
    height: np.ndarray
    names: tuple
    roles: np.ndarray
    crs: str = ""
    left_out: int = 0

    def __len__(self):
        return len(self.pixel)

    def having(self, role):
        """Indices of the points of one role."""
        return np.flatnonzero(self.roles == role)

    def with_disabled_as_checks(self):
        return replace(self, roles=np.where(self.roles == DISABLED, CHECK, self.roles))


def control_points(names, rows, image, what, crs=""):
    """The control points of a table.

    Parameters
    ----------
    names : list of column names, or None where the table has no header
    rows : list of rows, of texts or numbers
    image : SourceImage that the points belong to
    what : the table's name for messages
    crs : WKT of its map coordinates

    Raises
    ------
    RoadExtractionError
        If a needed column is missing, no row holds numbers, or the points lie outside the image.
    """
    if not rows:
        raise RoadExtractionError(f"{what} holds no control points. It needs a row for each: pixel, line, easting, northing.")
    where = guess_columns(rows, image, what) if names is None else find_columns(names, what)
    table = {key: _numbers(rows, where.get(key)) for key in ("pixel", "line", "easting", "northing", "height")}
    known = np.isfinite([table[key] for key in ("pixel", "line", "easting", "northing")]).all(axis=0)
    if not known.any():
        raise RoadExtractionError(
            f"{what} holds no row with numbers for pixel, line, easting and northing. "
            "Write numbers with a decimal point (a comma only where semicolons part the columns).")
    kept = [row for row, good in zip(rows, known) if good]
    roles = _roles(kept, where)
    pixel, line = _in_the_image(table["pixel"][known], table["line"][known], roles != DISABLED, image, what)
    return ControlPoints(pixel, line, *(table[key][known] for key in ("easting", "northing", "height")),
                         _names(kept, where.get("name")), roles, crs, int((~known).sum()))


def _numbers(rows, column):
    return np.array([np.nan if column is None else as_number(row[column] if column < len(row) else None) for row in rows])


def _in_the_image(pixel, line, used, image, what):
    """Pixel and line, lines downwards; source coordinates of an image that had a place become pixels.

    Where disabled points lie is their own affair, unless there are no others.
    """
    used = used if used.any() else np.ones(len(pixel), dtype=bool)
    margin = 1.0 + 0.02 * max(image.width, image.height)
    forms = [(pixel, -line) if np.median(line[used]) < 0 else (pixel, line)]
    if image.geotransform is not None:
        # QGIS writes these where the image it worked on had a place on the map
        forms.append(image.pixel_of(pixel, line))
    for columns, lines in forms:
        if image.holds(columns, lines, margin)[used].all():
            return columns, lines
    columns, lines = (axis[used] for axis in max(forms, key=lambda form: image.holds(*form, margin)[used].sum()))
    outside = int((~image.holds(columns, lines, margin)).sum())
    raise RoadExtractionError(
        f"{outside} of {len(columns)} points of {what} lie outside the image: pixels run from {columns.min():.0f} to {columns.max():.0f} "
        f"and lines from {lines.min():.0f} to {lines.max():.0f}, the image has {image.width} by {image.height}. "
        "Are they of another image, of one in another size, or are pixel and line swapped?")


def _names(rows, column):
    if column is None:
        return tuple(str(number) for number in range(1, len(rows) + 1))
    return tuple(_text(row, column) or str(number) for number, row in enumerate(rows, 1))


def _text(row, column):
    value = row[column] if column < len(row) else None
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return "" if value is None else str(value).strip()


def _roles(rows, where):
    roles = np.full(len(rows), CONTROL, dtype="U8")
    for number, row in enumerate(rows):
        role = _text(row, where["role"]).lower() if "role" in where else ""
        check = _text(row, where["check"]).lower() if "check" in where else ""
        if role in _CHECK_TEXTS or (check and check not in _FALSE_TEXTS):
            roles[number] = CHECK
        if role.startswith(("disab", "off", "unused")) or ("enable" in where and _text(row, where["enable"]).lower() in _FALSE_TEXTS):
            roles[number] = DISABLED
    return roles
